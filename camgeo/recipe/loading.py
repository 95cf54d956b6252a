"""From a recipe's file to a `Recipe`, or to all of its faults."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.recipe.recipe import RECIPE, build, read_values
from camgeo.recipe.schema.errors import RecipeError, RecipeErrors
from camgeo.recipe.schema.file_bytes import bytes_of
from camgeo.recipe.schema.reader import Reader
from camgeo.recipe.schema.readers import READERS
from camgeo.recipe.schema.scalars import NAME_RULE, Complaint, read_name
from camgeo.recipe.schema.yaml_source import MAX_BYTES, read_source

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.recipe.recipe import Recipe


def load(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file; raises RecipeErrors with all its faults, also where there is no such file."""
    try:
        data = bytes_of(path, MAX_BYTES, "recipe")
    except Complaint as complaint:
        raise RecipeErrors([RecipeError(str(path), 0, 0, "", complaint.problem, None, complaint.remedy)]) from None
    return read(data, path)


def read(data: bytes, path: str | PathLike[str]) -> Recipe:
    """Read a recipe from bytes; `path` names it in errors and gives its default name. Raises RecipeErrors."""
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
    return build(values, Path(path), reader.marks, source.text)


def load_text(text: str, path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a text, as `read` does from bytes. Raises RecipeErrors."""
    return read(text.encode("utf-8", "surrogatepass"), path)
