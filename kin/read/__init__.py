"""Files as numbers, of any origin."""
