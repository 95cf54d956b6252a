"""What came of a cam's files: a verdict, checks, files, remarks; report.json as an object with types."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from camgeo.api.check import Check
from camgeo.api.errors import CallError
from camgeo.api.json_value import JSON
from camgeo.common.arguments import is_a
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from camgeo.api.check import Figures
    from camgeo.api.designing import Designed
    from camgeo.recipe.recipe import Order


@dataclass(frozen=True)
class Remark:
    """A figure past what is usual, `rule`, which no check holds it against: `sentence` says it in words."""

    name: str
    value: float | None
    rule: float | None
    unit: str
    at_deg: float | None
    sentence: str


@dataclass(frozen=True)
class Motion:
    """A follower's motion error over one turn, measured less intended, in `unit`: its greatest value and its mean."""

    max: float | None
    rms: float | None
    unit: str
    at_deg: float | None
    dwell_flatness: float | None


@dataclass(frozen=True)
class File:
    """One file of a report, lengths in the recipe's unit; None where a figure does not apply to its kind.

    `tolerance` is what was asked, `geometry_error` what was proved of the fit, `measured_error` what was measured in
    the file as it lies there, `perimeter` and `area` are those of its outer contour. `path` leads to it, where it was
    kept.
    """

    name: str
    path: Path | None
    kind: str | None
    pieces: int | None
    tolerance: float | None
    geometry_error: float | None
    measured_error: float | None
    motion: Motion | None
    perimeter: float | None = None
    area: float | None = None


@dataclass(frozen=True, eq=False)
class Report(Mapping[str, JSON]):
    """The report on a recipe and its files; as a mapping it is what report.json holds: `dict(report)`, `report["ok"]`.

    Values are in the recipe's units. `path` is the folder of the files, `<name>.rejected` where a check failed; None
    where files were judged and none kept. `page` is the HTML page of files that `verify` was asked to show.
    """

    recipe: Order
    _document: dict[str, Any] = field(repr=False)
    path: Path | None = None
    _paths: tuple[Path, ...] = field(default=(), repr=False)
    page: str | None = field(default=None, repr=False)

    def __getstate__(self) -> dict[str, object]:
        """Leave out of a pickle what can be made again."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return bool(self._document["ok"])

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Every check, of the design and of the files."""
        return tuple(Check(**_known(Check, check)) for check in self._document["checks"])

    @cached_property
    def remarks(self) -> tuple[Remark, ...]:
        """Figures beyond a rule of thumb, which is no check."""
        return tuple(Remark(**_known(Remark, remark)) for remark in self._document["remarks"])

    @cached_property
    def files(self) -> tuple[File, ...]:
        """The files that were judged, in the recipe's order or that of the call; without those left as they were."""
        entries = [entry for entry in self._document["files"] if not entry.get("stale")]
        return tuple(self._file(entry, i) for i, entry in enumerate(entries))

    @property
    def missing(self) -> Mapping[str, str]:
        """Why each file that a missing package would make was left out, by its name."""
        return {entry["what"]: entry["why"] for entry in self._document["skipped"] if entry.get("missing")}

    def _file(self, entry: dict[str, Any], index: int) -> File:
        name = entry["path"]
        path = self._paths[index] if self._paths else None if self.path is None else self.path / name
        motion = entry.get("motion")
        names = ("kind", "pieces", "tolerance", "geometry_error", "measured_error", "perimeter", "area")
        motion_error = None if motion is None else Motion(*(motion[name] for name in Motion.__dataclass_fields__))
        return File(name, path, **{name: entry.get(name) for name in names}, motion=motion_error)

    @cached_property
    def design(self) -> Designed:
        """The design, made anew from the recipe, as `camgeo.design` gives it."""
        from camgeo.api.designing import design

        return design(self.recipe)

    @property
    def figures(self) -> Figures:
        """The figures of the design by name, such as `radius-of-curvature`."""
        figures: Figures = self.design.figures
        return figures

    def explain(self, check: Check) -> str:
        """Tell of a check that fails over several lines: figure, limit, place, the recipe's field, what would do."""
        is_a("check", check, Check, "a Check")
        if check not in self.checks:
            raise CallError(f"{self.recipe.name}: {check.name} is none of this report's checks; give one of .checks")
        return explanation(self._document["checks"][self.checks.index(check)], self._document, self.recipe)

    def to_json(self) -> str:
        """Write the report as report.json has it."""
        from camgeo.report.document import as_json

        return as_json(self._document)

    def table(self) -> str:
        """Every check and file as aligned text, as `camgeo export -v` prints it."""
        from camgeo.report.document import table

        return table(self._document)

    # --- as a mapping -------------------------------------------------------------------------------------------------

    def __getitem__(self, key: str) -> JSON:
        value: JSON = copy.deepcopy(self._document[key])
        return value

    def __iter__(self) -> Iterator[str]:
        return iter(self._document)

    def __len__(self) -> int:
        return len(self._document)

    # --- to look at ---------------------------------------------------------------------------------------------------

    def __repr__(self) -> str:
        folder = "" if self.path is None else f", {str(self.path)!r}"
        return f"{type(self).__name__}({self.recipe.name!r}, {'ok' if self.ok else 'FAILED'}{folder})"

    def __str__(self) -> str:
        """Write the verdict's line, and each check that fails on one more."""
        from camgeo.report.document import summary

        return summary(self._document)

    def _repr_svg_(self) -> str:
        picture: str = self.design._repr_svg_()
        return picture

    def _repr_html_(self) -> str:
        from camgeo.api import notebook

        lines = [f"remark: {remark.sentence}" for remark in self.remarks]
        rows = [
            (
                file.name,
                "" if file.pieces is None else str(file.pieces),
                *("" if v is None else f"{v:.3g}" for v in (file.tolerance, file.geometry_error, file.measured_error)),
            )
            for file in self.files
        ]
        head = ("file", "pieces", "tolerance", "proved", "measured")
        more = [notebook.table(head, rows)] if rows else []
        return notebook.notebook_html(
            self._repr_svg_(), self.recipe.name, self.checks, *more, *map(notebook.line, lines)
        )


def _known(kind: type[Check | Remark], entry: dict[str, Any]) -> dict[str, Any]:
    """Leave out what an entry of the report has beyond the fields of its class."""
    return {name: entry[name] for name in kind.__dataclass_fields__ if name in entry}


def explanation(check: dict[str, Any], report: dict[str, Any], recipe: Order, file_name: str | None = None) -> str:
    """Tell of a check that fails over several lines; `shown` names the recipe's file in place of its path."""
    from camgeo.registry.root import root_of

    return root_of(recipe).explain(check, report, recipe, file_name)
