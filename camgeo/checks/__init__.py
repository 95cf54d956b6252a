"""Checks of a run: each declared once, the limits that a recipe sets, and remarks that fail nothing."""
