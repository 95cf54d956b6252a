"""A curve moved outwards by a distance that varies, as to correct a machine's deviations.

With f over the curve's parameter, T and N the tangent and the outward normal, sigma and omega speed and turn, it is

- along its normals ``c + f N``, with the derivative ``(sigma + f omega) T + f' N``: its speed is the length of that,
  and its tangent turns as T does, less the angle by which it leaves T. That angle jumps where sigma does: so this is
  for pitch curves, of which omega alone may jump;
- by its support function ``c + f N + (f'/omega) T``, with the derivative ``(sigma + f omega + (f'/omega)') T``: its
  tangent is T, even where sigma jumps. So this is for contours under a flat face, where omega is above 0 and may not
  jump.

Both are f farther outside, to first order of f.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import Bounds, Frame, Shape
from camgeo.curve.rates import bounds_of, cut
from kin.numeric import elementary
from kin.numeric.angles import TURN
from kin.numeric.distinct import distinct
from kin.numeric.feet import equal_steps
from kin.numeric.jet import Jet, horner
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from kin.numeric.arrays import Array
    from kin.numeric.jet import Series

NEAR = 1e-9  # rad: a parameter so near a knot counts as the knot


@dataclass(frozen=True, eq=False)
class PeriodicPolynomials:
    """A periodic function over a turn, mm: on each of N equal spans a polynomial.

    `pieces` (k, N) has the coefficients of each span, lowest first, by the place in it, which runs from 0 to 1.
    """

    pieces: Array

    @property
    def knots(self) -> Array:
        """Beginnings of the spans (N,), rad."""
        return equal_steps(self.pieces.shape[1])

    def on(self, tau: Series, side: Side = 1) -> Series:
        """The function, mm, at jets or ball jets of the parameter, each point or interval of which lies in one span.

        At a knot it is the limit from above (side 1) or from below (side -1).
        """
        count = self.pieces.shape[1]
        width = TURN / count
        middle = tau.c[0] if isinstance(tau, Jet) else tau.mid[0]
        begin = np.floor((middle + NEAR * np.asarray(side)) / width)
        place = (tau - begin * width) * (1.0 / width)
        value: Series = horner(self.pieces[:, np.mod(begin, count).astype(np.intp)], place)
        return value


@dataclass(frozen=True, eq=False)
class Moved(ABC):
    """Curve outside `base` by a distance `by`, mm, that varies with the parameter."""

    base: Shape
    by: PeriodicPolynomials

    @property
    def period(self) -> float:
        """Period of the parameter, rad."""
        return self.base.period

    @cached_property
    def breaks(self) -> Array:
        """Breaks of the base and knots of the distance (m,), rad, rising; a knot at a break is left out."""
        breaks, knots = np.asarray(self.base.breaks, dtype=np.float64), self.by.knots
        if len(breaks):
            apart = np.abs(np.mod(knots[:, None] - breaks + np.pi, TURN) - np.pi).min(axis=1)
            knots = knots[apart > NEAR]
        return distinct(np.concatenate([breaks, knots]))

    @property
    def repeats(self) -> int:
        """Number of equal parts of the curve per turn: always 1, since the displacement need not repeat."""
        return 1

    @property
    def steady(self) -> Array:
        """Constant speed and turn of each stretch, (m, 2): nan, as neither is constant."""
        return np.full((len(self.breaks), 2), np.nan)

    @property
    def radii(self) -> Array:
        """Radius of each stretch that is a circular arc, (m,): nan, as no stretch is."""
        return np.full(len(self.breaks), np.nan)

    @abstractmethod
    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,), rad; at a break the limit from above (side 1) or from below (side -1)."""

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn at parameters t (n,)."""
        speed, turn = self.rates(Jet.variable(t, order + 3), side)
        return speed.c[: order + 1], turn.c[: order + 1]

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds of speed and turn, and of their derivatives, over parameter intervals [low, high] (n,)."""
        return bounds_of(self._figures, low, high, self._rates)

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, as series at jets or ball jets `tau`, of up to an order fewer than the base's."""
        return self._rates(self._figures(tau, side))

    def _figures(self, tau: Series, side: Side = 1) -> tuple[Series, ...]:
        """Speed and turn of the base, and the distance, as series."""
        speed, turn = self.base.rates(tau, side)
        return speed, turn, self.by.on(tau, side)

    @abstractmethod
    def _rates(self, figures: tuple[Series, ...]) -> tuple[Series, Series]:
        """Speed and turn from the figures: the base's speed and turn, and the distance."""


@dataclass(frozen=True, eq=False)
class AlongNormals(Moved):
    """Curve outside `base` by the distance `by`, mm, measured along the normals of `base`."""

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,)."""
        frame = self.base.sample(t, side)
        off, slope = self.by.on(Jet.variable(t, 1), side).c
        along = frame.speed + off * frame.turn
        tangent = along[:, None] * frame.tangent + slope[:, None] * frame.normal
        speed, turn = self.series(t, 1, side)
        point = frame.point + off[:, None] * frame.normal
        return Frame(point, tangent / speed[0][:, None], speed[0], turn[0], speed[1], turn[1])

    def _rates(self, figures: tuple[Series, ...]) -> tuple[Series, Series]:
        # with x = sigma + f omega the speed is hypot(x, f'), the turn omega - (f'' x - f' x')/(x^2 + f'^2)
        speed, turn, off = figures
        out = off.derivative()
        order = min(speed.order, turn.order, out.order)
        turn, out = cut(turn, order), cut(out, order)
        along = cut(speed, order) + cut(off, order) * turn
        square = along**2 + out**2
        away = out.derivative() * cut(along, order - 1) - cut(out, order - 1) * along.derivative()
        return elementary.sqrt(square), cut(turn, order - 1) - away * cut(square, order - 1) ** -1


@dataclass(frozen=True, eq=False)
class BySupport(Moved):
    """Curve with the support function of `base` plus `by`, mm: it has the same normals."""

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,)."""
        frame = self.base.sample(t, side)
        off, slope = self.by.on(Jet.variable(t, 1), side).c
        speed, turn = self.series(t, 1, side)
        point = frame.point + off[:, None] * frame.normal + (slope / frame.turn)[:, None] * frame.tangent
        return Frame(point, frame.tangent, speed[0], turn[0], speed[1], turn[1])

    def _rates(self, figures: tuple[Series, ...]) -> tuple[Series, Series]:
        # the speed is sigma + f omega + (f'/omega)', the turn omega
        speed, turn, off = figures
        out = off.derivative()
        order = min(turn.order, out.order)
        along = (cut(out, order) * cut(turn, order) ** -1).derivative()
        order = min(speed.order, along.order)
        turn = cut(turn, order)
        return cut(speed, order) + cut(off, order) * turn + cut(along, order), turn
