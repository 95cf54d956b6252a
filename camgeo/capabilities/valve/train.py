"""The lift of a valve by the lift of its tappet: ratio times lift, less the lash, at least 0."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.monotone import between, cells, extremes
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

ORDER = 2  # derivatives of a valve's lift that are computed: its velocity and its acceleration
_HALVINGS = 100
_WITHIN = 1e-9  # of the greatest lift: so far a table may end before it


@dataclass(frozen=True)
class Valve:
    """Valve train: `ratios` are rows of the tappet's lift, mm, and the rocker's ratio there.

    One row is a constant ratio. Between rows the ratio is a natural cubic spline. `lash` is the clearance at the valve,
    mm.
    """

    ratios: tuple[tuple[float, float], ...]
    lash: float = 0.0
    name: str = "valve"

    def travel(self, lift: Array) -> Array:
        """Travel of the valve, mm, by the tappet's lift (n,), mm, without lash, and its two derivatives, (3, n)."""
        ratio = _ratio(self.ratios, lift)
        return np.array([ratio[0] * lift, ratio[1] * lift + ratio[0], ratio[2] * lift + 2.0 * ratio[1]])

    def rows(self, tappet: Array) -> Array:
        """Lift of the valve, mm, velocity and acceleration (3, n), by the tappet's (3, n), by the same variable.

        All are 0 where the valve is on its seat.
        """
        travel = self.travel(tappet[0])
        lift = travel[0] - self.lash
        velocity = travel[1] * tappet[1]
        acceleration = travel[2] * tappet[1] ** 2 + travel[1] * tappet[2]
        return np.where(lift > 0.0, np.array([lift, velocity, acceleration]), 0.0)

    def follower_lift(self, lift: float) -> float:
        """Lift of the tappet, mm, at which the valve has `lift`, mm, 0 or more.

        With a table it is found by bisection, as the travel rises; beyond the table it is the last row's lift.
        """
        wanted = lift + self.lash
        if len(self.ratios) == 1:
            return wanted / self.ratios[0][1]
        low, high = 0.0, self.ratios[-1][0]
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.travel(np.array([middle]))[0, 0] >= wanted else (middle, high)
        return high


def valve_of(recipe: Recipe, design: Design) -> Valve | None:
    """The valve of a recipe, None without one.

    Raises RecipeErrors for a table of ratios that ends below the tappet's greatest lift, or by which the valve falls
    while the tappet rises, EventError for a table with a motion too rough to follow.
    """
    valve = recipe.of(Valve)
    if valve is None or len(valve.ratios) == 1:
        return valve
    most = tappet_lift(design)
    last = valve.ratios[-1][0]
    where = "valve.ratio.table"
    if last < most * (1.0 - _WITHIN):
        problem = f"the table ends at a tappet lift of {last / recipe.mm:.6g}, the tappet lifts {most / recipe.mm:.6g}"
        raise recipe.error(where, problem, None, f"give rows up to {most / recipe.mm:.6g} or more")
    rows = between(0.0, min(most, last), [lift for lift, _ in valve.ratios])
    (slope, _), _ = extremes(cells(lambda lift: valve.travel(lift)[1:2], rows))
    if slope <= 0.0:
        raise recipe.error(where, "the valve falls while the tappet rises", None, "give ratios that fall less steeply")
    return valve


def tappet_lift(design: Design) -> float:
    """Greatest lift of the tappet, mm, above its lowest place; raises EventError for a motion too rough to follow."""
    from camgeo.measures.lobe import lift_pieces

    lift = lift_pieces(design.exact)
    return lift.greatest()[0] - lift.least()[0]


@lru_cache(maxsize=8)
def _spline(rows: tuple[tuple[float, float], ...]) -> tuple[Array, Array]:
    """Places (m + 1,) and coefficients (4, m) of a natural cubic spline about each place, the constant first."""
    x, y = np.array(rows).T
    width, count = np.diff(x), len(x)
    # second derivatives `bend` at the rows, 0 at both ends, from the continuity of the slope
    matrix, right = np.eye(count), np.zeros(count)
    for i in range(1, count - 1):
        matrix[i, i - 1 : i + 2] = width[i - 1], 2.0 * (width[i - 1] + width[i]), width[i]
        right[i] = 6.0 * ((y[i + 1] - y[i]) / width[i] - (y[i] - y[i - 1]) / width[i - 1])
    bend = np.linalg.solve(matrix, right)
    slope = np.diff(y) / width - width * (2.0 * bend[:-1] + bend[1:]) / 6.0
    return x, np.array([y[:-1], slope, 0.5 * bend[:-1], np.diff(bend) / (6.0 * width)])


def _ratio(rows: tuple[tuple[float, float], ...], lift: Array) -> Array:
    """Ratio with two derivatives by the tappet's lift, (3, n); the spline's end pieces go on beyond the table."""
    if len(rows) == 1:
        return np.array([np.full_like(lift, rows[0][1]), np.zeros_like(lift), np.zeros_like(lift)])
    places, (a, b, c, d) = _spline(rows)
    part = np.clip(np.searchsorted(places, lift, side="right") - 1, 0, len(places) - 2)
    t = lift - places[part]
    a, b, c, d = a[part], b[part], c[part], d[part]
    return np.array([a + t * (b + t * (c + t * d)), b + t * (2.0 * c + 3.0 * t * d), 2.0 * c + 6.0 * t * d])
