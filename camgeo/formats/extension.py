"""What formats of files ask of capabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.registry.formats import Form
from camgeo.registry.slot import EMPTY, Slot
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest


@dataclass(frozen=True, kw_only=True)
class Table(Form):
    """Form of CSV; `make` writes and judges the file."""

    make: Callable[[Job, FileRequest, Path], MadeFiles]


@dataclass(frozen=True, kw_only=True)
class Tables:
    """Answers of a capability with tables of its own: forms of CSV by their words."""

    tables: Mapping[str, Table] = EMPTY


TABLES = Slot("formats", Tables())
