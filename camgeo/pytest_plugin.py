"""Pytest plugin: each check of each recipe a project names becomes a test item."""
