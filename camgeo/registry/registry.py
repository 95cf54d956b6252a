"""Capabilities by their labels, which are read at every start."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection

    from camgeo.registry.label import Label

PACKAGE = "camgeo.capabilities"


def folder() -> Path:
    """Folder of the capabilities."""
    (path,) = import_module(PACKAGE).__path__
    return Path(path)


@cache
def labels() -> dict[str, Label]:
    """Label of each capability by the name of its folder, in order of rank."""
    names = [path.name for path in folder().iterdir() if (path / "__init__.py").is_file()]
    by_folder: dict[str, Label] = {name: import_module(f"{PACKAGE}.{name}").LABEL for name in names}
    return dict(sorted(by_folder.items(), key=lambda item: (item[1].rank, item[0])))


def options() -> dict[str, str]:
    """Help of each option by which a call uses a capability, by the capability's name."""
    return {name: label.option for name, label in labels().items() if label.option}


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
    """Names of the capabilities whose label has one of these words of a recipe, in order of rank."""
    return tuple(name for name, label in labels().items() if not set(label.words).isdisjoint(words))
