"""Functions of recipes of indexing cams, for commands and the library."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.api.own_kind import root_of_kind
from camgeo.registry.root import Reading

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.api.own_kind import Library
    from camgeo.capabilities.indexing.index_recipe import IndexRecipe
    from camgeo.output.own_kind import OwnKind
    from camgeo.schema.fields import FieldTable
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Source


def _table() -> FieldTable:
    from camgeo.capabilities.indexing.keys import RECIPE

    return RECIPE


def _read(source: Source, path: Path) -> IndexRecipe:
    from camgeo.capabilities.indexing.reading import read_indexing

    return read_indexing(source, path)


def _reader(source: Source) -> Reader:
    from camgeo.capabilities.indexing.reading import reader_of

    return reader_of(source)[0]


def _run() -> OwnKind[Any, Any]:
    from camgeo.capabilities.indexing.pipeline import INDEXERS

    return INDEXERS


def _library() -> Library:
    from camgeo.capabilities.indexing import library

    return library


READING = Reading(
    table=_table, read=_read, reader=_reader, noun="cam of kind indexing", instead="the recipe of a disc cam"
)
ROOT = root_of_kind(_run, _library, "indexing", "a solid or a development of the cam")
