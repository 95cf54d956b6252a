"""The machinery of recipes: YAML source, fields, readers, errors, JSON schema."""
