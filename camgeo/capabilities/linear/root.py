"""Functions of recipes of linear cams, for commands and the library."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.api.own_kind import root_of_kind
from camgeo.registry.root import Reading

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.api.own_kind import Library
    from camgeo.capabilities.linear.keys import LinearRecipe
    from camgeo.output.own_kind import OwnKind
    from camgeo.schema.fields import FieldTable
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Source


def _table() -> FieldTable:
    from camgeo.capabilities.linear.keys import RECIPE

    return RECIPE


def _read(source: Source, path: Path) -> LinearRecipe:
    from camgeo.capabilities.linear.reading import read_linear

    return read_linear(source, path)


def _reader(source: Source) -> Reader:
    from camgeo.capabilities.linear.reading import reader_of

    return reader_of(source)[0]


def _run() -> OwnKind[Any, Any]:
    from camgeo.capabilities.linear.pipeline import PLATES

    return PLATES


def _library() -> Library:
    from camgeo.capabilities.linear import library

    return library


READING = Reading(table=_table, read=_read, reader=_reader, noun="linear cam", instead="the recipe of a disc cam")
ROOT = root_of_kind(_run, _library, "linear", "a drawing or a solid of the plate")
