"""Where a rigid body stands over one turn of the shaft, and between which bounds its velocity lies over an interval.

A pose is x, y in mm and an angle in rad, of the body's own axes in the fixed ones. Rates are by the shaft angle. Over
an interval every motion gives its pose at the middle, rates, and by how much the rates may differ from these at most;
these are bounds, not samples: a search that rests on them is a proof for the motion as it is stated. A `Sampled` motion
is a curve through samples, stated between them by interpolation alone; its `slack` estimates how far the true motion
may be from it.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

__all__ = ["PlaneMotion", "PoseCourse", "Sampled", "Still", "Turning", "alike"]

FEWEST = 8  # samples of a turn: with fewer an interpolation has no meaning
CLOSED = 1e-6  # mm and rad, by which the last sample may differ from the first, but for whole turns


class PoseCourse(NamedTuple):
    """Poses (n, 3) at the middle of n intervals, and rates over each: every rate within `spread` of `rate`, (n, 3)."""

    pose: Array
    rate: Array
    spread: Array


class PlaneMotion(Protocol):
    """A body's motion over one turn of the shaft."""

    def over(self, phi: Array, half: Array) -> PoseCourse:
        """Give the course over the intervals [phi - half, phi + half], (n,) each, rad."""
        ...

    @property
    def slack(self) -> tuple[float, float]:
        """Greatest difference of true and stated pose, (of the origin, mm; angle, rad); if sampled an estimate."""
        ...


@dataclass(frozen=True)
class Still:
    """A body at rest, its origin at x, y and turned by `angle`."""

    x: float = 0.0
    y: float = 0.0
    angle: float = 0.0

    slack = (0.0, 0.0)

    def over(self, phi: Array, half: Array) -> PoseCourse:  # noqa: ARG002 - it rests at every angle
        """Give the course, (n,) rows, over the intervals [phi - half, phi + half], (n,) each, rad: at rest."""
        pose = np.broadcast_to(np.array([self.x, self.y, self.angle]), (len(phi), 3))
        return PoseCourse(pose, np.zeros_like(pose), np.zeros_like(pose))


@dataclass(frozen=True)
class Turning:
    """A body turning steadily about its own origin at x, y, `rate` times as fast as the shaft.

    A positive rate is counter-clockwise; `angle` is the body's angle at shaft angle 0.
    """

    rate: float
    x: float = 0.0
    y: float = 0.0
    angle: float = 0.0

    slack = (0.0, 0.0)

    def over(self, phi: Array, half: Array) -> PoseCourse:  # noqa: ARG002 - its rates are constant
        """Give the course, (n,) rows, over the intervals [phi - half, phi + half], (n,) each, rad.

        The rates are constant: `spread` is 0.
        """
        pose = np.stack([np.full_like(phi, self.x), np.full_like(phi, self.y), self.angle + self.rate * phi], axis=1)
        rate = np.broadcast_to(np.array([0.0, 0.0, self.rate]), pose.shape)
        return PoseCourse(pose, rate, np.zeros_like(pose))


@dataclass(frozen=True, eq=False)
class Sampled:
    """A motion known at equal steps of one turn: pose (n + 1, 3), the last a whole turn after the first.

    Angles run on without jumps. Between samples x, y and angle are cubics with the slopes `rate` (n + 1, 3), the true
    rates by the shaft angle if they are known, else those of the quartics through five samples. For a smooth motion
    the error falls with the fourth power of the step, with the second where an acceleration jumps. `slack` takes it as
    the error at a sample that is left out: sixteen times the error of a smooth motion, and more than it at a jump.
    Raises ValueError for fewer than 8 steps or a pose that is not finite, for rates of another shape, a last pose that
    is not the first but for whole turns, or angles that jump by more than a right angle.
    """

    pose: Array
    rate: Array | None = None

    def __post_init__(self) -> None:
        shape = np.shape(self.pose)
        if len(shape) != 2 or shape[1] != 3 or shape[0] <= FEWEST or not np.isfinite(self.pose).all():
            raise ValueError(f"a sampled motion takes finite poses (n + 1, 3) of {FEWEST} steps or more, not {shape}")
        if self.rate is not None and np.shape(self.rate) != shape:
            raise ValueError("the rates of a sampled motion are as many as its poses")
        turned = self.pose[-1] - self.pose[0]
        turned[2] -= TURN * np.round(turned[2] / TURN)
        if np.abs(turned).max() > CLOSED:
            raise ValueError("the last pose of a sampled motion is not the first, a turn of the shaft on")
        if np.abs(np.diff(self.pose[:, 2])).max() > 0.5 * np.pi:
            raise ValueError("the angle of a sampled motion jumps by more than a right angle between two samples")

    @property
    def steps(self) -> int:
        """Number of equal steps of the turn."""
        return len(self.pose) - 1

    @cached_property
    def _slope(self) -> Array:
        """Rates at the samples, times the step (n + 1, 3)."""
        if self.rate is not None:
            return np.asarray(self.rate, dtype=float) * (TURN / self.steps)
        whole = self.pose[-1] - self.pose[0]
        longer = np.concatenate([self.pose[-3:-1] - whole, self.pose, self.pose[1:3] + whole])
        slope: Array = (8.0 * (longer[3:-1] - longer[1:-3]) - (longer[4:] - longer[:-4])) / 12.0
        return slope

    @cached_property
    def slack(self) -> tuple[float, float]:
        """Estimate, no bound, of the true motion's distance from this curve: (of the origin, mm; of the angle, rad)."""
        whole = self.pose[-1] - self.pose[0]
        longer = np.concatenate([self.pose[-2:-1] - whole, self.pose, self.pose[1:2] + whole])
        slope = np.concatenate([self._slope[-2:-1], self._slope, self._slope[1:2]])
        between = 0.5 * (longer[:-2] + longer[2:]) + 0.25 * (slope[:-2] - slope[2:])
        miss = np.abs(self.pose - between)
        return float(np.hypot(miss[:, 0], miss[:, 1]).max()), float(miss[:, 2].max())

    @cached_property
    def _bends(self) -> list[Array]:
        """Greatest second derivatives over runs of 1, 2, 4, ... steps from each step on, twice round: (2 n, 3) each."""
        rise, slope = np.diff(self.pose, axis=0), self._slope
        first = 6.0 * rise - 4.0 * slope[:-1] - 2.0 * slope[1:]
        last = 2.0 * slope[:-1] + 4.0 * slope[1:] - 6.0 * rise
        bend = np.maximum(np.abs(first), np.abs(last)) * (self.steps / TURN) ** 2
        levels = [np.concatenate([bend, bend])]
        while 2 ** len(levels) <= self.steps:
            far = 2 ** (len(levels) - 1)
            levels.append(np.maximum(levels[-1], np.roll(levels[-1], -far, axis=0)))
        return levels

    def _bend(self, low: Array, high: Array) -> Array:
        """Greatest second derivatives (m, 3), by rad^2, over stretches from `low` to `high` (m,), in steps.

        Two runs of 2^k steps, the greatest that fit, cover a stretch.
        """
        begin = np.floor(low - 1e-9).astype(np.intp)
        count = np.clip(np.floor(high + 1e-9).astype(np.intp) - begin + 1, 1, self.steps)
        level = np.floor(np.log2(count)).astype(np.intp)
        begin = begin % self.steps
        bends = np.empty((len(low), 3))
        for k in range(len(self._bends)):
            at = np.flatnonzero(level == k)
            table = self._bends[k]
            bends[at] = np.maximum(table[begin[at]], table[begin[at] + count[at] - 2**k])
        return bends

    def over(self, phi: Array, half: Array) -> PoseCourse:
        """Give the course over the intervals [phi - half, phi + half], (n,) each, rad.

        `spread` is half times the greatest second derivative of the cubics within the interval.
        """
        # cubics by value and slope at both samples (Hermite), x from 0 to 1 over the step k
        width = TURN / self.steps
        turns = np.floor(phi / TURN)
        u = (phi - turns * TURN) / width
        k: Indices = np.clip(np.floor(u).astype(np.intp), 0, self.steps - 1)
        x = (u - k)[:, None]
        start, slope, end = self.pose[k], self._slope[k], self._slope[k + 1]
        rise = self.pose[k + 1] - start
        c, d = 3.0 * rise - 2.0 * slope - end, slope + end - 2.0 * rise
        pose = start + x * (slope + x * (c + x * d)) + turns[:, None] * (self.pose[-1] - self.pose[0])
        rate = (slope + x * (2.0 * c + 3.0 * x * d)) / width
        return PoseCourse(pose, rate, half[:, None] * self._bend(u - half / width, u + half / width))


def alike(first: PlaneMotion, other: PlaneMotion) -> bool:
    """Whether two motions are plainly the same but for a fixed pose: both at rest, or of one kind and equal.

    False also for equal motions that are not seen to be equal, as two copies of samples with given rates.
    """
    if first is other or (isinstance(first, Still) and isinstance(other, Still)):
        return True
    if isinstance(first, Turning) and isinstance(other, Turning):
        return (first.rate, first.x, first.y) == (other.rate, other.x, other.y)
    if isinstance(first, Sampled) and isinstance(other, Sampled):
        known = first.rate is None and other.rate is None
        return known and np.array_equal(first.pose, other.pose)
    return False
