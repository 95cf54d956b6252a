"""STEP solids as upright prisms."""
