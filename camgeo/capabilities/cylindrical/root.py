"""Functions of recipes of cylindrical cams, for commands and the library."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.api.own_kind import root_of_kind
from camgeo.registry.root import Reading

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.api.own_kind import Library
    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe
    from camgeo.output.extension import FileCall
    from camgeo.output.own_kind import OwnKind
    from camgeo.schema.fields import FieldTable
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Source


def _table() -> FieldTable:
    from camgeo.capabilities.cylindrical.keys import RECIPE

    return RECIPE


def _read(source: Source, path: Path) -> DrumRecipe:
    from camgeo.capabilities.cylindrical.reading import read_cylindrical

    return read_cylindrical(source, path)


def _reader(source: Source) -> Reader:
    from camgeo.capabilities.cylindrical.reading import reader_of

    return reader_of(source)[0]


def _run() -> OwnKind[Any, Any]:
    from camgeo.capabilities.cylindrical.pipeline import DRUMS

    return DRUMS


def _library() -> Library:
    from camgeo.capabilities.cylindrical import library

    return library


def _points(recipe: DrumRecipe, call: FileCall) -> dict[str, Any]:
    from camgeo.capabilities.cylindrical.made_points import demand_one_turn, judge

    demand_one_turn(recipe, call)
    return _run().claimed(recipe, lambda design, clock: judge(design, call, clock))


READING = Reading(table=_table, read=_read, reader=_reader, noun="cylindrical cam", instead="the recipe of a disc cam")
ROOT = root_of_kind(_run, _library, "cylindrical", "a solid or a development of the drum", _points)
