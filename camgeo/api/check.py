"""Checks and figures of the library, in the recipe's units, as objects, text and HTML."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from camgeo.measures.units import in_units
from camgeo.report.document import BELOW, value_text
from camgeo.report.limit_words import sign, title, words
from kin.numeric import check as judge
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from camgeo.measures.measured import Measured
    from camgeo.measures.placed import Figure as Placed
    from camgeo.recipe.recipe import Order, Recipe


@dataclass(frozen=True)
class Check(judge.Check):
    """A figure held against its limit, both in `unit`: a length in the recipe's unit, an angle in degrees.

    `sense` is whether the value has to be `at_least` or `at_most` the limit. `value` is None where nothing could be
    measured, as `detail` explains; such a check does not hold. `at` is the input at the worst place in `at_unit`, such
    as the shaft angle, None where there is none; `file` is the name of the checked file, None for a check of the
    design. `surface` names the surface of a cam with several.
    """

    @staticmethod
    def of(recipe: Order, check: judge.Check) -> Check:
        """Check in the recipe's units, made from a check in mm."""
        value, unit = in_units(recipe, check.value, check.unit)
        limit, _ = in_units(recipe, check.limit, check.unit)
        at, at_unit = in_units(recipe, check.at, check.at_unit)
        return Check(**vars(check) | {"value": value, "limit": limit, "unit": unit, "at": at, "at_unit": at_unit})

    @property
    def title(self) -> str:
        """Name of the check, with its surface where a cam has several."""
        return title(self._entry())

    @property
    def bound(self) -> str:
        """Limit with its sign, such as `<= 0.001`; empty where there is none."""
        return "" if self.limit is None else f"{sign(self._entry())} {self.limit:.6g}"

    @property
    def figure(self) -> str:
        """Text of the value with its unit, `below rounding` for an error of rounding alone; empty without a value."""
        text = value_text(self._entry())
        return text if text in {"", BELOW} else f"{text} {self.unit}".rstrip()

    def _entry(self) -> dict[str, Any]:
        """Entry of the check in a report."""
        return {key: value for key, value in asdict(self).items() if key != "file" or value is not None}

    def __str__(self) -> str:
        """Text of the check on one line."""
        text = f"{self.title} of {self.file}" if self.file else self.title
        text += ": ok" if self.ok else ": FAILED"
        if self.value is not None:
            text += f", {self.figure}"
        if self.limit is not None:
            text += f", {words(self._entry())} {self.limit:.6g}"
        if self.at is not None:
            text += f", at {self.at:.2f} {self.at_unit}"
        return f"{text}: {self.detail}" if self.detail else text

    def _repr_html_(self) -> str:
        from html import escape

        return f'<p style="color:{"inherit" if self.ok else "#b00020"}">{escape(str(self))}</p>'


@dataclass(frozen=True)
class Figure:
    """A figure of a design in `unit`; `value` is None where it has none, as `detail` explains.

    `at` is the input at its place in `at_unit`, such as the shaft angle, None without one.
    """

    value: float | None
    unit: str
    at: float | None = None
    detail: str = ""
    at_unit: str = "deg"

    @property
    def at_deg(self) -> float | None:
        """Shaft angle of its place, degrees; None without one, or where the input is no angle."""
        return self.at if self.at_unit == "deg" else None

    @staticmethod
    def of(recipe: Recipe, measured: Measured) -> Figure:
        """Figure in the recipe's units, made from a figure in mm."""
        value, unit = in_units(recipe, measured.value, measured.unit)
        at, at_unit = in_units(recipe, measured.at, measured.at_unit)
        return Figure(value, unit, at, measured.detail, at_unit)

    def __str__(self) -> str:
        """Text of the figure with its unit and its place; `none` and the reason without a value."""
        if self.value is None:
            return f"none: {self.detail}" if self.detail else "none"
        place = "" if self.at is None else f" at {self.at:.2f} {self.at_unit}"
        return f"{self.value:.6g} {self.unit}".rstrip() + place


@dataclass(frozen=True, eq=False)
class Figures(Mapping[str, Figure]):
    """Figures of a design by name: a read-only mapping that can be pickled."""

    _by_name: dict[str, Figure]

    @staticmethod
    def placed(recipe: Order, figures: Iterable[Placed], at_unit: str) -> Figures:
        """Figures in the recipe's units, of places in `at_unit`, mm or deg, too; one without a value is `nowhere`."""
        found = {}
        for figure in figures:
            value, unit = in_units(recipe, figure.value, figure.unit)
            finite = value is not None and math.isfinite(value)
            at, over = in_units(recipe, figure.at, at_unit)
            detail, over = "" if finite else "nowhere", "" if at is None else over
            found[figure.name] = Figure(value if finite else None, unit, at, detail, over)
        return Figures(found)

    def __getitem__(self, name: str) -> Figure:
        return self._by_name[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_name)

    def __len__(self) -> int:
        return len(self._by_name)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(self)})"

    def __str__(self) -> str:
        """Text with a line for each figure."""
        return "\n".join(f"{name}: {figure}" for name, figure in self.items())
