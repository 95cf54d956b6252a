"""What stands beside the core: each folder one capability, which registers itself by a record."""
