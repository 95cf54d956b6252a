"""From a recipe's cam to the exact curve of its profile."""
