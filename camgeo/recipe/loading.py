"""From a recipe's file to a `Recipe`, or to all of its faults."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.recipe.recipe import RECIPE, build, read_values
from camgeo.schema.errors import DeprecatedKeyWarning, RecipeError, RecipeErrors
from camgeo.schema.file_bytes import bytes_of
from camgeo.schema.reader import Reader
from camgeo.schema.readers import READERS
from camgeo.schema.scalars import NAME_RULE, Complaint, read_name
from camgeo.schema.yaml_source import MAX_BYTES, read_source

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.recipe.recipe import Recipe


def load(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file, and warn of former names in it, which `load_silent` does not.

    Raises RecipeErrors with all its faults, also where the file does not exist; warns by DeprecatedKeyWarning.
    """
    return announced(load_silent(path))


def announced(recipe: Recipe) -> Recipe:
    """Warn of the former names in a recipe, a DeprecatedKeyWarning for each, and give the recipe back."""
    for notice in recipe.notices:
        warnings.warn(str(notice), DeprecatedKeyWarning, stacklevel=3)
    return recipe


def load_silent(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file, whose `notices` are left to the caller; raises RecipeErrors as `load` does."""
    if not str(path):
        raise RecipeErrors([RecipeError("''", 0, 0, "", "an empty name of a file", None, "give the path of a recipe")])
    try:
        data = bytes_of(path, MAX_BYTES, "recipe")
    except Complaint as complaint:
        raise RecipeErrors([RecipeError(str(path), 0, 0, "", complaint.problem, None, complaint.remedy)]) from None
    return read(data, path)


def read(data: bytes, path: str | PathLike[str], unplaced: str = "") -> Recipe:
    """Read a recipe from bytes; `path` names it in errors and gives its default name. Raises RecipeErrors.

    Bytes that no file has, and nobody has seen, have no lines to speak of: `unplaced` names them in errors.
    """
    if unplaced:
        try:
            recipe = read(data, path)
        except RecipeErrors as errors:
            raise RecipeErrors(error.without_place(unplaced) for error in errors.errors) from None
        notices = tuple(notice.without_place(unplaced) for notice in recipe.notices)
        return replace(recipe, notices=notices, unplaced=unplaced)
    source = read_source(data, str(path))
    reader = Reader(source, READERS, RECIPE)
    values = read_values(reader)
    if "name" not in reader.marks:
        stem = Path(path).stem
        try:
            values["name"] = read_name(stem)
        except Complaint as complaint:
            remedy = f"give `name:` with {NAME_RULE}"
            reader.fault(source.root.mark, "name", f"the file's stem is {complaint.problem}", repr(stem), remedy)
    if reader.errors:
        raise RecipeErrors(reader.errors)
    return replace(
        build(values, Path(path), reader.marks, source.text),
        renamed=reader.renamed,
        notices=tuple(reader.notices),
    )


def load_text(text: str, path: str | PathLike[str], unplaced: str = "") -> Recipe:
    """Read a recipe from a text, as `read` does from bytes. Raises RecipeErrors."""
    return read(text.encode("utf-8", "surrogatepass"), path, unplaced)
