"""Figures of a kind of cam with its own figures, each with its place, and their checks and limits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camgeo.checks.declared import LIMIT
from camgeo.measures.units import in_pounds, in_units
from camgeo.recipe.figures import LEAST_WALL
from kin.numeric.check import Check

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.recipe.figure_bounds import Bound
    from camgeo.recipe.recipe import Order
    from kin.numeric.arrays import Array
    from kin.numeric.check import Sense

ROUNDING = 1e-9  # share of a limit by which a figure that just reaches it may miss it
SEEK = 2880  # places of a motion among which a greatest figure without a proof is sought
ZOOMS = 7  # about the greatest one found
SENSES: tuple[Sense, Sense] = ("at_least", "at_most")


class Figure(NamedTuple):
    """A figure in mm, N, seconds and degrees, at an input `at`, mm or degrees; `at` is None where it has no place."""

    name: str
    value: float
    unit: str
    at: float | None = None


def figure_check(
    name: str, figure: Figure, limit: float | None, sense: Sense, at_unit: str, *, slack: float = 0.0
) -> Check:
    """Check of a figure by a limit in its unit, None for a figure that is only reported; a place is in `at_unit`."""
    finite = math.isfinite(figure.value)
    ok = limit is None or (figure.value >= limit - slack if sense == "at_least" else figure.value <= limit + slack)
    return Check(
        name,
        bool(ok),
        figure.value if finite else None,
        limit,
        figure.unit,
        figure.at if finite else None,
        sense,
        detail="" if finite else "nowhere",
        at_unit=at_unit,
    )


def limit_checks(
    bounds: Sequence[Bound], figures: Sequence[Figure], at_unit: str, surfaces: Sequence[str] = ("",)
) -> list[Check]:
    """Checks of the figures that a recipe limits, one for each bound: `limit:<figure>`.

    A figure of one of the `surfaces` has the surface's name behind its own.
    """
    known = {figure.name: figure for figure in figures}
    found = []
    for bound in bounds:
        for sense, limit in zip(SENSES, (bound.at_least, bound.at_most), strict=True):
            for surface in surfaces:
                figure = known.get(f"{bound.figure}-{surface}" if surface else bound.figure)
                if figure is None or limit is None:
                    continue
                # bounds are mm or rad as read, figures have degrees
                inside = math.degrees(limit) if figure.unit.startswith("deg") else limit
                check = figure_check(
                    f"{LIMIT}{bound.figure}", figure, inside, sense, at_unit, slack=ROUNDING * abs(inside)
                )
                found.append(Check(**{**vars(check), "surface": surface}))
    return found


def limits_and_wall(
    bounds: Sequence[Bound], figures: Sequence[Figure], checks: Sequence[Check], at_unit: str
) -> list[Check]:
    """Checks of the figures that a recipe limits, and of the least wall, which is measured by one of `checks`."""
    measured = (check.value for check in checks if check.name == LEAST_WALL)
    walls = [Figure(LEAST_WALL, value, "mm") for value in measured if value is not None]
    return limit_checks(bounds, [*figures, *walls[:1]], at_unit)


def figure_entry(recipe: Order, figure: Figure, per: float) -> dict[str, Any]:
    """Entry of a report for a figure, in the recipe's unit; `per` is the unit of its place, mm or degrees."""
    value, unit = in_units(recipe, figure.value, figure.unit)
    value, unit = in_pounds(recipe.units, value, unit)
    entry: dict[str, Any] = {"name": figure.name, "value": value, "unit": unit}
    if figure.at is not None:
        entry["at"] = figure.at / per
    return entry


def greatest_of(figure: Callable[[Array], Array], total: float) -> tuple[float, float]:
    """Greatest value of a figure over inputs (n,) from 0 to `total`, mm or rad, and its place: sampled and narrowed."""
    low, high, best, place = 0.0, total, -math.inf, 0.0
    for zoom in range(ZOOMS):
        u = np.linspace(low, high, SEEK + 1 if zoom == 0 else 65)
        value = figure(u)
        i = int(np.argmax(value))
        if value[i] > best:
            best, place = float(value[i]), float(u[i])
        step = u[1] - u[0]
        low, high = max(0.0, place - step), min(total, place + step)
    return best, place
