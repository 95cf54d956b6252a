"""The recipe: its schema, its reading from YAML, its errors."""

from camgeo.recipe.load import load, load_text, read
from camgeo.recipe.recipe import Recipe
from camgeo.recipe.schema.errors import RecipeError, RecipeErrors

__all__ = ["Recipe", "RecipeError", "RecipeErrors", "load", "load_text", "read"]
