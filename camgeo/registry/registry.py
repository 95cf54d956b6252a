"""Capabilities and their records, each of which is imported at its first use."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import camgeo.capabilities

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from camgeo.registry.capability import Capability, FileJudge
    from camgeo.registry.label import Label

PACKAGE = camgeo.capabilities.__name__


@cache
def labels() -> dict[str, Label]:
    """Label of each capability by the name of its folder, in order of rank."""
    (folder,) = camgeo.capabilities.__path__
    names = [path.name for path in Path(folder).iterdir() if (path / "__init__.py").is_file()]
    by_folder: dict[str, Label] = {name: import_module(f"{PACKAGE}.{name}").LABEL for name in names}
    return dict(sorted(by_folder.items(), key=lambda item: (item[1].rank, item[0])))


_RECORDS: dict[str, Capability] = {}


def capability(name: str) -> Capability:
    """Record of a capability; raises KeyError for an unknown name, ModuleNotFoundError for one without a record."""
    if name not in _RECORDS:
        if name not in labels():
            raise KeyError(name)
        record: Capability = import_module(f"{PACKAGE}.{name}.record").CAPABILITY
        _RECORDS[name] = record
    return _RECORDS[name]


def names_with_record() -> tuple[str, ...]:
    """Names of all capabilities that have a record, in order of rank."""
    return tuple(name for name, label in labels().items() if label.record)


def names_loaded() -> tuple[str, ...]:
    """Names of the capabilities whose records were imported so far, in order of rank."""
    return tuple(name for name in names_with_record() if name in _RECORDS)


def in_order(names: Iterable[str]) -> list[Capability]:
    """Records of the capabilities with these names, in order of rank; other names are left out."""
    chosen = set(names)
    return [capability(name) for name in names_with_record() if name in chosen]


def options() -> dict[str, str]:
    """Help of each option by which a call uses a capability, by the capability's name."""
    return {name: label.option for name, label in labels().items() if label.option}


def judges() -> dict[str, FileJudge]:
    """Judge of its own files for each capability that has one, by the capability's name."""
    candidates = {name: capability(name).judges for name, label in labels().items() if label.suffixes}
    return {name: judge for name, judge in candidates.items() if judge is not None}


def judge_of(path: Path, options: Mapping[str, object]) -> str:
    """Name of the capability that claims a file by suffix and heading, or by options of the call; empty for none.

    Raises OSError where the file cannot be read.
    """
    suffix = path.suffix.lower()
    named = [name for name, label in labels().items() if suffix in label.suffixes]
    return next((name for name in named if judges()[name].claims(path, options)), "")


def library_names() -> dict[str, str]:
    """Full name of the module of each name that capabilities add to the library."""
    return {
        name: f"{PACKAGE}.{folder}.{module}"
        for folder, label in labels().items()
        for name, module in label.names.items()
    }


def formats() -> dict[str, str]:
    """Full name of the module of each format of files that capabilities add."""
    return {
        name: f"{PACKAGE}.{folder}.{module}"
        for folder, label in labels().items()
        for name, module in label.formats.items()
    }


def by_words(words: Collection[str]) -> tuple[str, ...]:
    """Names of the capabilities with a record whose label has one of these words of a recipe, in order of rank."""
    return tuple(name for name in names_with_record() if not set(labels()[name].words).isdisjoint(words))
