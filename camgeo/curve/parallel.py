"""Parallel curves: the contour a roller of given radius rolls on, or a cutter's centre follows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import Bounds, Frame, Shape
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from kin.numeric.arrays import Array
    from kin.numeric.jet import Series


@dataclass(frozen=True)
class Parallel:
    """Parallel curve of `base` at `distance` inside it (negative: outside), along the normal (docs/theory.md 7).

    The tangent turns as on the base, so the speed is ``sigma - distance * omega`` exactly: it changes sign where the
    curve undercuts, which `camgeo.curve.undercut.undercut` reports.
    """

    base: Shape
    distance: float

    @property
    def period(self) -> float:
        """Period of the parameter, in its own unit."""
        return self.base.period

    @property
    def breaks(self) -> Array:
        """Breaks of the base curve (m,), rising."""
        return self.base.breaks

    @property
    def repeats(self) -> int:
        """Number of equal parts of the base curve."""
        return self.base.repeats

    @property
    def steady(self) -> Array:
        """Speed, mm, and turn, rad, per unit of the parameter on each stretch, (m, 2); nan unless both are constant."""
        table = self.base.steady
        return np.column_stack([table[:, 0] - self.distance * table[:, 1], table[:, 1]])

    @property
    def radii(self) -> Array:
        """Signed radii of the stretches that are circular arcs, mm, nan of the others, (m,)."""
        return self.base.radii - self.distance

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,); at a break the limit from above (side 1) or from below (side -1)."""
        frame = self.base.sample(t, side)
        return Frame(
            frame.point - self.distance * frame.normal,
            frame.tangent,
            frame.speed - self.distance * frame.turn,
            frame.turn,
            frame.speed_slope - self.distance * frame.turn_slope,
            frame.turn_slope,
        )

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn at parameters t (n,)."""
        speed, turn = self.base.series(t, order, side)
        return speed - self.distance * turn, turn

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, as series at jets or ball jets of the parameter."""
        speed, turn = self.base.rates(tau, side)
        return speed - turn * self.distance, turn

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds of speed, turn and their derivatives over parameter intervals [low, high] (n,)."""
        b, d = self.base.bounds(low, high), self.distance
        if d == 0.0:
            return b  # a bound that is infinite stays one
        near, far = (b.turn_low, b.turn_high) if d >= 0 else (b.turn_high, b.turn_low)
        return Bounds(
            b.speed_low - d * far,
            b.speed_high - d * near,
            b.turn_low,
            b.turn_high,
            b.speed_slope + abs(d) * b.turn_slope,
            b.turn_slope,
            b.speed_bend + abs(d) * b.turn_bend,
            b.turn_bend,
        )
