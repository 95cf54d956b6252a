"""From a recipe's file to a `Recipe`, or to all of its faults."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.recipe.recipe import file_bytes, is_meant_as_a_camshaft, load_text, of_source, read, without_places
from camgeo.schema.yaml_source import read_source
from kin.numeric.records import replace

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.recipe.camshaft import CamshaftRecipe
    from camgeo.recipe.recipe import Recipe

__all__ = ["load", "load_order", "load_order_text", "load_text", "read"]


def load(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file; raises RecipeErrors with all its faults, also where the file does not exist."""
    return read(file_bytes(path), path)


def load_order(path: str | PathLike[str]) -> Recipe | CamshaftRecipe:
    """Read the recipe of a cam or of a camshaft, whichever the file holds; raises RecipeErrors as `load` does."""
    return _order(file_bytes(path), path)


def load_order_text(text: str, path: str, unplaced: str = "") -> Recipe | CamshaftRecipe:
    """Read the recipe of a cam or of a camshaft from a text, as `load_text` does; lobes are found from this folder."""
    with without_places(unplaced):
        return replace(_order(text.encode("utf-8", "surrogatepass"), path), unplaced=unplaced)


def _order(data: bytes, path: str | PathLike[str]) -> Recipe | CamshaftRecipe:
    source = read_source(data, str(path))
    if is_meant_as_a_camshaft(source):
        from camgeo.recipe.camshaft import read_camshaft

        return read_camshaft(source, Path(path))
    return of_source(source, path)
