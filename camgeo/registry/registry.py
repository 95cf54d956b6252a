"""Which capabilities there are, and their records: each is imported when it is first looked at."""

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
    """Label of each capability by the name of its folder, in the order of their ranks."""
    (folder,) = camgeo.capabilities.__path__
    names = [path.name for path in Path(folder).iterdir() if (path / "__init__.py").is_file()]
    found: dict[str, Label] = {name: import_module(f"{PACKAGE}.{name}").LABEL for name in names}
    return dict(sorted(found.items(), key=lambda item: (item[1].rank, item[0])))


_RECORDS: dict[str, Capability] = {}


def capability(name: str) -> Capability:
    """Record of a capability that has one; raises KeyError for a name that no folder has."""
    if name not in _RECORDS:
        if name not in labels():
            raise KeyError(name)
        record: Capability = import_module(f"{PACKAGE}.{name}.record").CAPABILITY
        _RECORDS[name] = record
    return _RECORDS[name]


def recorded() -> tuple[str, ...]:
    """Names of all capabilities that have a record."""
    return tuple(name for name, label in labels().items() if label.record)


def loaded() -> tuple[str, ...]:
    """Names of those whose record was read already."""
    return tuple(name for name in recorded() if name in _RECORDS)


def in_order(names: Iterable[str]) -> list[Capability]:
    """Records of these capabilities, in the order of their ranks."""
    chosen = set(names)
    return [capability(name) for name in recorded() if name in chosen]


def options() -> dict[str, str]:
    """Help of each option by which a call uses a capability, by the capability's name."""
    return {name: label.option for name, label in labels().items() if label.option}


def judges() -> dict[str, FileJudge]:
    """What judges files of their own for each capability that has such, by its name."""
    found = {name: capability(name).judges for name, label in labels().items() if label.suffixes}
    return {name: judge for name, judge in found.items() if judge is not None}


def judge_of(path: Path, options: Mapping[str, object]) -> str:
    """Name of the capability that claims a file by its suffix and heading; empty for none. Raises OSError."""
    suffix = path.suffix.lower()
    named = [name for name, label in labels().items() if suffix in label.suffixes]
    return next((name for name in named if judges()[name].claims(path, options)), "")


def names() -> dict[str, str]:
    """Module of each name that capabilities add to the library."""
    return {
        name: f"{PACKAGE}.{folder}.{module}"
        for folder, label in labels().items()
        for name, module in label.names.items()
    }


def formats() -> dict[str, str]:
    """Module of each format of files that capabilities add."""
    return {
        name: f"{PACKAGE}.{folder}.{module}"
        for folder, label in labels().items()
        for name, module in label.formats.items()
    }


def by_words(words: Collection[str]) -> tuple[str, ...]:
    """Names of the recorded capabilities that a recipe with these words uses, see `Label.words`."""
    return tuple(name for name in recorded() if not set(labels()[name].words).isdisjoint(words))
