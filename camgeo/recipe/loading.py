"""Reading of a recipe's file, into a `Recipe` or an error with all its faults."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.recipe.recipe import file_bytes, intended_root, load_text, of_source, read, without_places
from camgeo.registry.root import CAM, reading
from camgeo.schema.yaml_source import read_source
from kin.numeric.records import replace

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.recipe.recipe import Order, Recipe

__all__ = ["load", "load_order", "load_order_text", "load_text", "read"]


def load(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file; raises RecipeErrors with all its faults, also where the file does not exist."""
    return read(file_bytes(path), path)


def load_order(path: str | PathLike[str]) -> Order:
    """Read a recipe from a file: of one cam, or of another kind that a capability reads.

    Raises RecipeErrors with all its faults, also where the file does not exist.
    """
    return _order(file_bytes(path), path)


def load_order_text(text: str, path: str, unplaced: str = "") -> Order:
    """Read a recipe of any kind from a text. Raises RecipeErrors with all its faults.

    `path` names the recipe in errors, and files that the recipe names are in the folder of `path`. `unplaced` names in
    errors a text that stands in no file and so has no lines to refer to.
    """
    with without_places(unplaced):
        return replace(_order(text.encode("utf-8", "surrogatepass"), path), unplaced=unplaced)


def _order(data: bytes, path: str | PathLike[str]) -> Order:
    source = read_source(data, str(path))
    key = intended_root(source)
    if key == CAM:
        return of_source(source, path)
    order: Order = reading(key).read(source, Path(path))
    return order
