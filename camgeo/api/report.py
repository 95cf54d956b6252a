"""The report on a cam's files as an object with types: verdict, checks, files, remarks."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from camgeo.api.check import Check
from camgeo.api.json_value import JSON
from camgeo.common.arguments import demand_type
from camgeo.common.errors import CallError
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from camgeo.api.check import Figures
    from camgeo.api.designing import Designed
    from camgeo.recipe.recipe import Order


@dataclass(frozen=True)
class Remark:
    """A figure beyond a rule of thumb, which no check limits: value and `rule` in `unit`, and a sentence on it.

    `at` is the input at its place in `at_unit`, such as the shaft angle, None without one.
    """

    name: str
    value: float | None
    rule: float | None
    unit: str
    at: float | None
    sentence: str
    at_unit: str = "deg"

    @property
    def at_deg(self) -> float | None:
        """Shaft angle of its place, degrees; None without one, or where the input is no angle."""
        return self.at if self.at_unit == "deg" else None


@dataclass(frozen=True)
class Motion:
    """A follower's motion error over its whole input, measured less intended, in `unit`: greatest and rms.

    `at` is the input of the greatest error in `at_unit`, such as the shaft angle. `dwell_flatness` is the range of the
    measured position over a dwell, None where the motion has none. Figures that are not finite are None.
    """

    max: float | None
    rms: float | None
    unit: str
    at: float | None
    dwell_flatness: float | None
    at_unit: str = "deg"

    @property
    def at_deg(self) -> float | None:
        """Shaft angle of the greatest error, degrees; None without one, or where the input is no angle."""
        return self.at if self.at_unit == "deg" else None


@dataclass(frozen=True)
class File:
    """One file of a report, lengths in the recipe's unit; None where a figure does not apply to its kind.

    `geometry_error` is the proved error of the fit, `measured_error` the error measured in the written file.
    `measured_error`, `motion`, `perimeter` and `area` are those of its one contour, None for a file of several
    surfaces. `path` is the path of the file, None where it was not kept.
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
    """The report on a recipe and its files; as a mapping it has the keys of report.json: `report["ok"]`.

    Values are in the recipe's units. `path` is the folder of the files, `<name>.rejected` where a check failed; None
    where files were judged and none kept. `page` is the HTML of `verify(..., page=True)`, else None.
    """

    recipe: Order
    _document: dict[str, Any] = field(repr=False)
    path: Path | None = None
    _paths: tuple[Path, ...] = field(default=(), repr=False)
    page: str | None = field(default=None, repr=False)

    def __getstate__(self) -> dict[str, object]:
        """Fields for a pickle, without cached values."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return bool(self._document["ok"])

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Every check, of the design and of the files."""
        return tuple(Check(**_fields_of(Check, check)) for check in self._document["checks"])

    @cached_property
    def remarks(self) -> tuple[Remark, ...]:
        """Figures beyond a rule of thumb, which no check limits."""
        return tuple(Remark(**_fields_of(Remark, remark)) for remark in self._document["remarks"])

    @cached_property
    def files(self) -> tuple[File, ...]:
        """Files that the run made or judged, in the order of the recipe or the call; without files that it left."""
        entries = [entry for entry in self._document["files"] if not entry.get("stale")]
        return tuple(self._file(entry, i) for i, entry in enumerate(entries))

    @property
    def missing(self) -> Mapping[str, str]:
        """Reasons why files were left out, by the names of the files: the package that each of them needs."""
        return {entry["what"]: entry["why"] for entry in self._document["skipped"] if entry.get("missing")}

    def _file(self, entry: dict[str, Any], index: int) -> File:
        name = entry["path"]
        path = self._paths[index] if self._paths else None if self.path is None else self.path / name
        motion = entry.get("motion")
        names = ("kind", "pieces", "tolerance", "geometry_error", "measured_error", "perimeter", "area")
        motion_error = None if motion is None else Motion(**_fields_of(Motion, {"dwell_flatness": None, **motion}))
        return File(name, path, **{name: entry.get(name) for name in names}, motion=motion_error)

    @cached_property
    def design(self) -> Designed:
        """Exact design of the recipe, computed at first use; no file is made.

        Raises RecipeErrors where there is no such motion or curve, SurroundingsError where a package is missing.
        """
        from camgeo.api.designing import design

        return design(self.recipe)

    @property
    def figures(self) -> Figures:
        """Figures of the design by name, such as `radius-of-curvature`.

        Raises RecipeErrors where there is no such motion or curve.
        """
        figures: Figures = self.design.figures
        return figures

    def explain(self, check: Check) -> str:
        """Explain a check of this report in several lines: figure, limit, place, field of the recipe, remedy.

        Raises CallError for a check that is not among `checks`, TypeError for what is no Check.
        """
        demand_type("check", check, Check, "a Check")
        if check not in self.checks:
            raise CallError(f"{self.recipe.name}: {check.name} is none of this report's checks; give one of .checks")
        return explanation(self._document["checks"][self.checks.index(check)], self._document, self.recipe)

    def to_json(self) -> str:
        """JSON text of the report, as in report.json."""
        from camgeo.report.document import as_json

        return as_json(self._document)

    def table(self) -> str:
        """Aligned text of every check and file, as `camgeo export -v` prints it."""
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
        """Text of a line with the verdict and the files, and a line for each failed check."""
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


def _fields_of(kind: type[Check | Remark | Motion], entry: dict[str, Any]) -> dict[str, Any]:
    """Values of an entry of the report for the fields of its class."""
    place = {"at": entry["at_deg"]} if "at_deg" in entry else {}
    return place | {name: entry[name] for name in kind.__dataclass_fields__ if name in entry}


def explanation(check: dict[str, Any], report: dict[str, Any], recipe: Order, file_name: str | None = None) -> str:
    """Text of several lines on a check of a report; `check` and `report` are plain data.

    `file_name` replaces the path of the recipe's file in the text.
    """
    from camgeo.api.root import root_of

    return root_of(recipe).explain(check, report, recipe, file_name)
