"""Speed and turn of a shape from the figures that define it: their Taylor series, and proved bounds of both."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

import numpy as np

from camgeo.curve.curve import Bounds
from kin.numeric.elementary import BallJet, Jet
from kin.numeric.interval import Ball
from kin.numeric.records import dataclass
from kin.numeric.taylor import factorials

if TYPE_CHECKING:
    from camgeo.curve.curve import Frame, Shape, Side
    from kin.numeric.arrays import Array, Mask

Series = TypeVar("Series", Jet, BallJet)


class MotionJets(Protocol):
    """Figures of a motion as jets of its parameter: angles phi and psi, a displacement S alone, or others.

    At a break they are the limits from above (side 1) or from below (side -1).
    """

    def __call__(self, tau: Series, side: Side = 1, /) -> tuple[Series, ...]:
        """The figures as jets."""
        ...


class Rates(Protocol):
    """Speed and turn of a shape from jets of a motion's figures."""

    def __call__(self, figures: tuple[Series, ...], /) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, as jets."""
        ...


ROUNDING = 1e-10  # relative: far above the rounding of a few dozen operations
ORDER = 5  # of the series that bounds come from
NARROW = 0.01  # rad: intervals narrower to either side were halved, at a fold; there a higher order saves most of them
FINE_ORDER = 9


class Source(Protocol):
    """Protocol of a motion over a turn: its breaks, equal parts, and stretches of constant speed and turn."""

    @property
    def breaks(self) -> Array:
        """Parameters (m,) in [0, 2 pi), rising, at which a derivative may jump."""
        ...

    @property
    def repeats(self) -> int:
        """Number of equal parts of the turn."""
        ...

    @property
    def steady(self) -> Mask:
        """Whether speed and turn are exactly constant on each stretch (m,)."""
        ...


SourceT = TypeVar("SourceT", bound=Source)


@dataclass(frozen=True)
class MotionShape(ABC, Generic[SourceT]):
    """Curve that a motion generates; both have the same parameter."""

    law: SourceT

    @abstractmethod
    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,), rad; at a break the limit from above (side 1) or from below (side -1)."""

    @abstractmethod
    def figures(self, tau: Series, side: Side = 1) -> tuple[Series, ...]:
        """Figures of the motion, such as S, as series at jets of its parameter."""

    @abstractmethod
    def rates_of(self, figures: tuple[Series, ...]) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, from the motion's figures, two orders fewer."""

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, as series at jets `tau`, of two orders fewer."""
        return self.rates_of(self.figures(tau, side))

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn at parameters t (n,)."""
        speed, turn = self.rates(Jet.variable(t, order + 2), side)
        return speed.c, turn.c

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds of speed, turn and their derivatives over parameter intervals [low, high] (n,)."""
        return bounds_of(self.figures, low, high, self.rates_of)

    @property
    def period(self) -> float:
        """Period of the parameter: a full turn, 2 pi rad."""
        return 2.0 * np.pi

    @property
    def breaks(self) -> Array:
        """Parameters (m,) in [0, 2 pi), rising, at which a derivative of the motion may jump."""
        return self.law.breaks

    @property
    def repeats(self) -> int:
        """Number of equal parts of the motion; the curve's are the same but for a turn."""
        return self.law.repeats

    @cached_property
    def steady(self) -> Array:
        """Speed, mm, and turn, rad, per rad of the parameter, (m, 2), where constant, as at dwells; else nan."""
        rests = self.law.steady
        out = np.full((rests.size, 2), np.nan)
        if rests.any():
            frame = self.sample(stretches(self.law).mean(axis=1)[rests])
            out[rests] = np.column_stack([frame.speed, frame.turn])
        return out

    @property
    def radii(self) -> Array:
        """Signed radii of the stretches that are circular arcs, mm, nan of the others, (m,)."""
        steady = self.steady
        return steady[:, 0] / steady[:, 1]


def stretches(shape: Source | Shape) -> Array:
    """Parameters (m, 2) of the ends of the stretches between breaks, rad; without a break the whole turn."""
    breaks = shape.breaks if len(shape.breaks) else np.zeros(1)
    return np.column_stack([breaks, np.append(breaks[1:], breaks[0] + 2.0 * np.pi)])


def cut(series: Series, order: int) -> Series:
    """The series cut to a lower order, with order + 1 rows."""
    if isinstance(series, Jet):
        return Jet(series.c[: order + 1])
    return BallJet(series.mid[: order + 1], series.rad[: order + 1])


def bounds_of(figures: MotionJets, low: Array, high: Array, rates: Rates) -> Bounds:
    """Proved bounds over intervals from `low` to `high` (n,) of speed and turn, which `rates` makes of `figures`.

    Interval arithmetic alone loses the dependence of its operands. So each derivative of the figures and of speed and
    turn is taken at the middle of the interval, plus half the width times the bound of the next derivative; interval
    arithmetic bounds only the last derivative. Balls of no width at the middle bound the rounding.
    """
    middle = low + 0.5 * (high - low)
    reach = np.maximum(high - middle, middle - low)
    order = ORDER if reach.max(initial=0.0) > NARROW else FINE_ORDER
    # one call for the intervals, then their middles
    parameter = BallJet.variable(np.concatenate([low, middle]), np.concatenate([high, middle]), order)
    sharp = tuple(_sharpen_balls(ball, reach) for ball in figures(parameter))
    speed, turn = (_sharpen(ball, reach) for ball in rates(sharp))
    speed_size, turn_size = np.abs(speed).max(axis=0), np.abs(turn).max(axis=0)
    return Bounds(
        speed[0][0], speed[1][0], turn[0][0], turn[1][0], speed_size[1], turn_size[1], speed_size[2], turn_size[2]
    )  # fmt: skip


def _sharpen(ball: BallJet, reach: Array) -> tuple[Array, Array]:
    """Lower and upper bounds (order + 1, n) of derivatives over intervals with this reach from their middles (n,).

    `ball` holds the balls over the n intervals, then the balls in their middles.
    """
    (low, least), (high, most) = (np.hsplit(rows, 2) for rows in ball.bounds())
    for k in range(len(low) - 2, -1, -1):
        spread = reach * np.maximum(np.abs(low[k + 1]), np.abs(high[k + 1])) * (1.0 + ROUNDING)
        low[k] = np.fmax(low[k], least[k] - spread)
        high[k] = np.fmin(high[k], most[k] + spread)
    return low, high


def _sharpen_balls(ball: BallJet, reach: Array) -> BallJet:
    """Copy of `ball` with sharpened balls over the intervals; the balls in their middles stay."""
    sharp = Ball.between(*_sharpen(ball, reach))
    factorial = factorials(ball.order)
    rad = sharp.rad / factorial * (1.0 + ROUNDING) + 1e-15 * np.abs(sharp.mid)
    mids, rads = ball.mid[:, reach.size :], ball.rad[:, reach.size :]
    return BallJet(np.hstack([sharp.mid / factorial, mids]), np.hstack([rad, rads]))
