"""The exact cam of a recipe, and the checks that need no file."""
