"""Wunderlich's cams: the pitch curve of a double roller and the profile of a flat-faced pair (W sections 4, 5).

Both follow from the transmission law alone. With the half angle ``h = (psi + alpha)/2`` and the polar angle
``t = phi - h`` (W eq. 4.10), ``r = 2 l cos h`` is the polar radius of the pitch curve, or the support function of the
flat pair's cam.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np

from camgeo.curve.curve import Bounds, Frame, columns
from kin.numeric import elementary
from kin.numeric.elementary import BallJet, Jet
from kin.numeric.interval import Ball
from kin.numeric.taylor import factorials

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

Series = TypeVar("Series", Jet, BallJet)


class _Figures(Protocol):
    """Two figures of a law as jets of its parameter: phi and psi, or r and t; the side decides at breaks."""

    def __call__(self, tau: Series, side: Side = 1, /) -> tuple[Series, Series]: ...


class _Rates(Protocol):
    """Speed and turn of a shape from jets of those two."""

    def __call__(self, first: Series, second: Series, /) -> tuple[Series, Series]: ...


ROUNDING = 1e-10  # relative: what the rounding of a few dozen operations is far below
ORDER = 5  # of the series that bounds come from
NARROW = 0.01  # rad: intervals narrower to either side were halved, at a fold; there a higher order saves most of them
FINE_ORDER = 9


@dataclass(frozen=True)
class _OfLaw:
    """What a curve has of the transmission law alone, whose parameter it shares."""

    law: Transmission

    @property
    def period(self) -> float:
        """A full turn."""
        return 2.0 * np.pi

    @property
    def breaks(self) -> Array:
        """Breaks of the transmission law."""
        return self.law.breaks

    @property
    def repeats(self) -> int:
        """The law has period 2 pi/lam, and so has the curve but for a turn."""
        return self.law.lam


@dataclass(frozen=True)
class PitchShape(_OfLaw):
    """Path of a roller's centre round the standing cam.

    In the complex plane the centre is ``c = l (exp(i phi) + exp(i chi))``, ``chi = phi - psi - alpha``: the pivot and
    the arm. That form keeps every digit and gives, with a = phi', b = chi' = a - psi', h = (psi + alpha)/2,

        (sigma/l)^2 = psi'^2 + 4 a b cos^2 h,
        omega = (a + b)/2 (1 + psi'^2 l^2/sigma^2) + (a psi'' - a' psi') sin 2h l^2/sigma^2,

    sums in which nothing cancels: a and b are positive where the cam can be turned through.
    """

    @property
    def steady(self) -> Array:
        """Speed and turn (m, 2) where the follower rests and the pitch curve is a circle about the shaft."""
        return _steady(self, self.law)

    @property
    def radii(self) -> Array:
        """Radii of the stretches that are circular arcs (m,): dwells, and the arcs of a law made from an arc."""
        return self.law.pitch_arcs[:, 2]

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,) of the law."""
        rows_phi, rows_psi = self.law.at(t, 3, side)
        phi, chi = rows_phi[0], rows_phi[0] - rows_psi[0] - self.law.alpha
        arm = self.law.arm
        pivot, end = (np.cos(phi), np.sin(phi)), (np.cos(chi), np.sin(chi))
        point = arm * columns(pivot[0] + end[0], pivot[1] + end[1])
        a, b = rows_phi[1], rows_phi[1] - rows_psi[1]
        velocity = columns(-a * pivot[1] - b * end[1], a * pivot[0] + b * end[0])
        length = np.hypot(velocity[:, 0], velocity[:, 1])
        return Frame(point, velocity / length[:, None], *self._rates_at(rows_phi, rows_psi))

    def _rates_at(self, phi: Array, psi: Array) -> tuple[Array, Array, Array, Array]:
        """Speed, turn and their slopes (n,) from derivatives (4, n) of phi and psi: `_rates` by hand."""
        (a, a1, a2), (s, s1, s2) = phi[1:], psi[1:]
        b, b1 = a - s, a1 - s1
        half = 0.5 * (psi[0] + self.law.alpha)
        cosine, sine = np.cos(half), np.sin(half)
        double, square = 2.0 * sine * cosine, 4.0 * cosine**2
        lean, cross = s * s, a * s1 - a1 * s
        # with q = (sigma/l)^2: omega = (a + b)/2 + part/q
        q = lean + a * b * square
        q1 = 2.0 * s * s1 + (a1 * b + a * b1) * square - 2.0 * a * b * s * double
        part = 0.5 * (a + b) * lean + cross * double
        part1 = 0.5 * (a1 + b1) * lean + (a + b) * s * s1 + (a * s2 - a2 * s) * double
        part1 += cross * s * (0.5 * square - 1.0)
        root, share = np.sqrt(q), part / q
        turn_slope = 0.5 * (a1 + b1) + (part1 - share * q1) / q
        return self.law.arm * root, 0.5 * (a + b) + share, 0.5 * self.law.arm * q1 / root, turn_slope

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn at parameters t (n,) of the law."""
        return _series(self.law.jets, t, order, side, self._rates)

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds over intervals (n,)."""
        return _bounds(self.law.jets, low, high, self._rates)

    def _rates(self, phi: Series, psi: Series) -> tuple[Series, Series]:
        """Speed and turn from phi and psi: two orders fewer."""
        a, slope = phi.derivative(), psi.derivative()
        a_slope, bend = a.derivative(), slope.derivative()
        order = bend.order
        a, slope, half = _cut(a, order), _cut(slope, order), (_cut(psi, order) + self.law.alpha) * 0.5
        cosine, sine = elementary.cos(half), elementary.sin(half)
        b = a - slope
        lean = slope**2
        square = lean + a * b * cosine**2 * 4.0
        inverse = square**-1
        turn = (a + b) * (lean * inverse + 1.0) * 0.5 + (a * bend - a_slope * slope) * sine * cosine * inverse * 2.0
        return elementary.sqrt(square) * self.law.arm, turn


@dataclass(frozen=True)
class FlatPairShape(_OfLaw):
    """Curve with an isoptic circle: r as the support function (W section 5).

    The parameter is the law's; the normal turns as ``t = phi - h`` does, and ``sigma = (r + d2r/dt2) t'``.
    """

    @property
    def steady(self) -> Array:
        """Speed and turn (m, 2) where the follower rests."""
        return _steady(self, self.law)

    @property
    def radii(self) -> Array:
        """Radii of the stretches that are circular arcs (m,): dwells."""
        steady = self.steady
        return steady[:, 0] / steady[:, 1]

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,) of the law."""
        r, normal = self.law.pitch(t, 3, side)
        turn, turn1, turn2 = normal[1:]
        # `_rates` by hand
        slope = r[1] / turn
        slope1 = (r[2] - slope * turn1) / turn
        slope2 = (r[3] - slope * turn2 - 2.0 * slope1 * turn1) / turn
        cosine, sine = np.cos(normal[0]), np.sin(normal[0])
        point = columns(r[0] * cosine - slope * sine, r[0] * sine + slope * cosine)
        return Frame(
            point, columns(-sine, cosine), r[0] * turn + slope1, turn, r[1] * turn + r[0] * turn1 + slope2, turn1
        )

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn at parameters t (n,) of the law."""
        return _series(self.law.polar, t, order, side, self._rates)

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds over intervals (n,)."""
        return _bounds(self.law.polar, low, high, self._rates)

    def _rates(self, r: Series, normal: Series) -> tuple[Series, Series]:
        """Speed and turn from the support function and the normal's angle: ``r t' + (r'/t')'``."""
        turn = normal.derivative()
        bend = (r.derivative() / turn).derivative()
        turn = _cut(turn, bend.order)
        return _cut(r, bend.order) * turn + bend, turn


def _steady(shape: PitchShape | FlatPairShape, law: Transmission) -> Array:
    """Speed and turn (m, 2) on the stretches where the follower rests; nan on the others."""
    rests = law.steady
    out = np.full((rests.size, 2), np.nan)
    if rests.any():
        middle = np.array([0.5 * (low + high) for low, high in _stretches(law)])[rests]
        at = shape.sample(middle)
        out[rests] = np.column_stack([at.speed, at.turn])
    return out


def _stretches(law: Transmission) -> list[tuple[float, float]]:
    """List the ends of the stretches between breaks; the whole turn where there is none."""
    breaks = [float(b) for b in law.breaks]
    if not breaks:
        return [(0.0, 2.0 * math.pi)]
    return list(zip(breaks, [*breaks[1:], breaks[0] + 2.0 * math.pi], strict=True))


def _cut(series: Series, order: int) -> Series:
    """Cut a series to a lower order."""
    if isinstance(series, Jet):
        return Jet(series.c[: order + 1])
    return BallJet(series.mid[: order + 1], series.rad[: order + 1])


def _series(figures: _Figures, t: Array, order: int, side: Side, rates: _Rates) -> tuple[Array, Array]:
    """Taylor coefficients of speed and turn (order + 1, n) from those of the law, two orders more."""
    speed, turn = rates(*figures(Jet.variable(t, order + 2), side))
    return speed.c, turn.c


def _bounds(figures: _Figures, low: Array, high: Array, rates: _Rates) -> Bounds:
    """Bounds over intervals (n,) from the law's two figures, and from speed and turn as functions of them.

    Interval arithmetic alone loses how its operands hang together. So each derivative, of the law as of speed and
    turn, is taken from the middle of the interval, plus half the width times what bounds the next derivative; only the
    last comes from the arithmetic. In the middle too it is balls, of no width: so rounding is known for each interval.
    """
    middle = low + 0.5 * (high - low)
    reach = np.maximum(high - middle, middle - low)
    order = ORDER if reach.max(initial=0.0) > NARROW else FINE_ORDER
    # One call for both: intervals first, then their middles.
    both = BallJet.variable(np.concatenate([low, middle]), np.concatenate([high, middle]), order)
    first, second = (_over_sharpened(ball, reach) for ball in figures(both))
    speed, turn = (_sharpened(ball, reach) for ball in rates(first, second))
    speed_size, turn_size = np.abs(speed).max(axis=0), np.abs(turn).max(axis=0)
    return Bounds(
        speed[0][0], speed[1][0], turn[0][0], turn[1][0], speed_size[1], turn_size[1], speed_size[2], turn_size[2]
    )  # fmt: skip


def _sharpened(ball: BallJet, reach: Array) -> tuple[Array, Array]:
    """Lower and upper bounds (order + 1, n) of the derivatives over intervals, from those within reach (n,).

    The balls are those over the n intervals, and then those in their middles.
    """
    (low, least), (high, most) = (np.hsplit(rows, 2) for rows in ball.bounds())
    for k in range(len(low) - 2, -1, -1):
        spread = reach * np.maximum(np.abs(low[k + 1]), np.abs(high[k + 1])) * (1.0 + ROUNDING)
        low[k] = np.fmax(low[k], least[k] - spread)
        high[k] = np.fmin(high[k], most[k] + spread)
    return low, high


def _over_sharpened(ball: BallJet, reach: Array) -> BallJet:
    """Balls over intervals sharpened, then the same in their middles."""
    sharp = Ball.between(*_sharpened(ball, reach))
    factorial = factorials(ball.order)
    rad = sharp.rad / factorial * (1.0 + ROUNDING) + 1e-15 * np.abs(sharp.mid)
    mids, rads = ball.mid[:, reach.size :], ball.rad[:, reach.size :]
    return BallJet(np.hstack([sharp.mid / factorial, mids]), np.hstack([rad, rads]))
