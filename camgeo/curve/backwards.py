"""A curve run through the other way: its hollows are convex there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Bounds, Curve, Frame, Shape, SmoothRun
from camgeo.curve.parallel import Parallel
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from camgeo.curve.curve import Side
    from kin.numeric.arrays import Array
    from kin.numeric.jet import Series


@dataclass(frozen=True)
class Backwards:
    """A shape run through the other way, with its parameter negated: its outside becomes its inside."""

    base: Shape

    @property
    def period(self) -> float:
        """Period of the parameter, in its own unit."""
        return self.base.period

    @property
    def breaks(self) -> Array:
        """Breaks (m,) of the base in the negated parameter, from 0 to less than the period, rising."""
        return np.sort(np.mod(-np.asarray(self.base.breaks, dtype=np.float64), self.period))

    @property
    def repeats(self) -> int:
        """Number of equal parts of the base."""
        return self.base.repeats

    def _stretches(self) -> NDArray[np.intp]:
        """Index of each stretch in the base (m,)."""
        count = max(len(self.base.breaks), 1)
        order = np.arange(count)[::-1]
        at_zero = len(self.base.breaks) > 0 and float(self.base.breaks[0]) == 0.0
        # a break at 0 stays the first one, any other first break becomes the last
        return order if at_zero or count == 1 else np.roll(order, -1)

    @property
    def steady(self) -> Array:
        """Speed, mm, and turn, rad, per unit of the parameter on each stretch, (m, 2); nan unless both are constant."""
        table: Array = self.base.steady[self._stretches()] * np.array([1.0, -1.0])
        return table

    @property
    def radii(self) -> Array:
        """Signed radii of the stretches that are circular arcs, mm, nan of the others, (m,)."""
        radii: Array = -self.base.radii[self._stretches()]
        return radii

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,); at a break the limit from above (side 1) or from below (side -1)."""
        frame = self.base.sample(-t, -side)
        return Frame(frame.point, -frame.tangent, frame.speed, -frame.turn, -frame.speed_slope, frame.turn_slope)

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn at parameters t (n,)."""
        speed, turn = self.base.series(-t, order, -side)
        sign = (-1.0) ** np.arange(order + 1)[:, None]
        return sign * speed, -sign * turn

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, as series at jets or ball jets of the parameter."""
        speed, turn = self.base.rates(-tau, -side)
        return speed, -turn

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds of speed, turn and their derivatives over parameter intervals [low, high] (n,)."""
        b = self.base.bounds(-high, -low)
        return replace(b, turn_low=-b.turn_high, turn_high=-b.turn_low)


def backwards(curve: Curve) -> Curve:
    """Curve run through the other way; a `Parallel` outside its base is then inside it, as a roller's contour is."""
    shape = curve.shape
    turned = Parallel(Backwards(shape.base), -shape.distance) if isinstance(shape, Parallel) else Backwards(shape)
    return Curve(turned, runs_backwards(curve.runs), curve)


def runs_backwards(runs: Sequence[SmoothRun]) -> tuple[SmoothRun, ...]:
    """Runs of a curve for the curve run through the other way: in reverse order, their parameters negated."""
    return tuple(
        SmoothRun(-run.high, -run.low, tuple(-b for b in reversed(run.breaks)), run.closed) for run in reversed(runs)
    )


def least_hollow(contour: Curve) -> tuple[float, float]:
    """Least radius of the hollow stretches of a contour, mm, and its parameter; infinite without a hollow.

    The radius is counted above 0 in a hollow. Raises CurveError where the proof does not end.
    """
    radius, place = least_radius(backwards(contour))
    return radius, -place
