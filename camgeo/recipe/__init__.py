"""The recipe: its schema, its reading from YAML, its errors."""
