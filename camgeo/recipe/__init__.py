"""The recipe: its schema, its reading from YAML, its errors."""

from camgeo.recipe.errors import RecipeError, RecipeErrors
from camgeo.recipe.load import load, load_text, read
from camgeo.recipe.model import Recipe

__all__ = ["Recipe", "RecipeError", "RecipeErrors", "load", "load_text", "read"]
