"""The recipe: its schema, its reading from YAML, its errors.

Names are looked up when they are asked for: the families of cams read `camgeo.recipe.schema`, and the recipe them.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from camgeo.recipe.loading import load, load_text, read
    from camgeo.recipe.recipe import Recipe
    from camgeo.recipe.schema.errors import RecipeError, RecipeErrors

__all__ = ["Recipe", "RecipeError", "RecipeErrors", "load", "load_text", "read"]
_WHERE = {
    **dict.fromkeys(("load", "load_text", "read"), "loading"),
    "Recipe": "recipe",
    **dict.fromkeys(("RecipeError", "RecipeErrors"), "schema.errors"),
}


def __getattr__(name: str) -> object:
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
