"""Reading of a recipe that is none of a disc cam: its text by a table of keys, and its end in a value or in errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from camgeo.part import bore
from camgeo.part.features import built
from camgeo.part.part import Part
from camgeo.recipe.document import Document
from camgeo.recipe.figure_bounds import build_bounds
from camgeo.recipe.keys import read_units
from camgeo.recipe.recipe import Verify, name_by_stem, reader_of_kind
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.fields import Kind
from camgeo.schema.yaml_source import Mapping, entries
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections import abc
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.schema.errors import RecipeError
    from camgeo.schema.fields import FieldTable
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node, Source

RecipeT = TypeVar("RecipeT")
ANGLES = 1  # of `Verify`, at which a disc is judged: these kinds are judged at all places


class NotYet(NamedTuple):
    """Keys and formats that other kinds of cam have, and one kind, `noun`, does not have yet.

    `keys` are paths, each with the remedy. `instead` names formats to give in place of those in `formats`.
    """

    noun: str
    keys: abc.Mapping[str, str]
    formats: tuple[str, ...]
    instead: str

    def told(self, error: RecipeError) -> RecipeError:
        """The fault of such a key or format, which says that it is not made yet; any other fault as it is."""
        unknown = error.problem == "unknown key" or error.problem.endswith(f" takes no {error.path}")
        if unknown and error.path in self.keys:
            return replace(error, problem="not made yet", remedy=f"leave it out: {self.keys[error.path]}")
        for word in self.formats:
            if error.problem.endswith(f" takes no {word}"):
                return replace(error, problem=f"{word} is not made yet of {self.noun}", remedy=f"give {self.instead}")
        return error


def entry_at(root: Node, *keys: str) -> Node | None:
    """The node at the end of a chain of keys; None where the text does not go so far."""
    node: Node | None = root
    for key in keys:
        node = entries(node).get(key) if isinstance(node, Mapping) else None
    return node


def begin(source: Source, root: str, table: FieldTable, *, swings: bool) -> tuple[Reader, Values]:
    """Reader of a kind that has read a text by its table, and the values; its motion is an angle where it `swings`."""
    reader = reader_of_kind(source, root)
    read_units(reader)
    if swings:
        reader.angular |= {Kind.STROKE, Kind.ERROR, Kind.MOTION}
    return reader, reader.table(table, source.root, "") if isinstance(source.root, Mapping) else {}


def finish(
    reader: Reader,
    values: Values,
    path: Path,
    check: Callable[[Values, Reader], None],
    build: Callable[[Values, Document, Reader], RecipeT],
) -> RecipeT:
    """Recipe of the values in a file, after the faults between its keys; raises RecipeErrors with all faults."""
    name_by_stem(values, reader, path)
    if not reader.errors:
        check(values, reader)
    if reader.errors:
        raise RecipeErrors(reader.errors)
    document = Document(path=path, text=reader.source.text, marks=reader.marks, kinds=reader.kinds)
    return build(values, document, reader)


def common_values(values: Values, document: Document, reader: Reader) -> dict[str, Any]:
    """Arguments of a recipe that every kind has: its names, its unit, how its files are judged, limits and source."""
    return {
        "name": values["name"],
        "about": values.get("about", ""),
        "units": values.get("units", "mm"),
        "mm": reader.mm,
        "verify": Verify(angles=ANGLES, **values.get("verify", {})),
        "limits": build_bounds(values.get("limits", {})),
        **vars(document),
    }


def round_part(part: Values) -> Part:
    """Part of a cam whose blank is a body of revolution: length, wall, density, bore and what is cut beside it."""
    return Part(
        thickness=part["length"],
        wall=part.get("wall"),
        density=part.get("density"),
        features=built(part),
        **bore.build_bore(part),
    )
