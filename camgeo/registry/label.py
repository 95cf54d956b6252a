"""Label of a capability: its words, commands and formats, read before its answers."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

NONE: Mapping[str, str] = MappingProxyType({})


class Label(NamedTuple):
    """`LABEL` of a capability's folder, read at every start: ten lines that import nothing else.

    rank      order wherever capabilities follow one another
    words     keys of a recipe's top level, formats, or options of files such as `key: value`, by which a recipe uses it
    formats   words of its formats of files, each with the module of the folder that has its `FORMAT`
    commands  names of its commands, each with its help; the module `command` of the folder has them
    reports   names of files of the output folder that list other files, as `report.json` does
    absent    why a run leaves the capability out, for the report's `skipped`; empty where that needs no words
    option    help of the option of the folder's name, by which a call uses it on files of one cam; empty: none
    roots     keys of the top level that make a text a recipe of another kind, which the folder reads
    kinds     values of `cam.kind` that do so too, each with what such cams are made for, as the error of an unknown
              kind lists it
    slips     words that some write in place of one of these kinds, each with the kind
    kin       packages of kin that judge for it alone, and are deleted with it
    suffixes  suffixes of files that `verify` leaves to it, where it claims them by their heading
    names     names that it adds to the library, each with the module of the folder that has it
    sources   options of `camgeo new` by which it makes a recipe out of files, each with its help
    """

    rank: int
    words: tuple[str, ...] = ()
    formats: Mapping[str, str] = NONE
    commands: Mapping[str, str] = NONE
    reports: tuple[str, ...] = ()
    absent: str = ""
    option: str = ""
    roots: tuple[str, ...] = ()
    kinds: Mapping[str, str] = NONE
    slips: Mapping[str, str] = NONE
    kin: tuple[str, ...] = ()
    suffixes: tuple[str, ...] = ()
    names: Mapping[str, str] = NONE
    sources: Mapping[str, str] = NONE
