"""A follower on a linear cam, as intended: guide, touch, height of the pitch line, motion over the plate's travel.

Axes of a drawing: x along the travel, y away from the plate's lower edge at y = 0; mm and radians. The input u, mm, is
how far the plate has moved towards -x; the follower runs over the standing plate towards +x, and at input u its guide
stands at x = u. `travel: right` is the mirror image (x -> -x), which is undone when a file is read.

The lift S is in mm along a stem, in radians about an arm's pivot; it grows away from the metal below.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, TypeAlias, TypeVar

import numpy as np

from kin.law.bounds import cubic_cells
from kin.numeric.arrays import Array
from kin.numeric.elementary import BallJet, Jet, cos, sin
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.law.contacts import Side, Unit
    from kin.law.piecewise import Piecewise

NEAR = 1e-3  # of a thousandth of the length: cells of the law are cubics within this
LEVEL = 1e-18  # square of the cosine of an arm that stands all but upright
VELOCITY = 1e-9  # mm per mm: a jump of the velocity below this is rounding
Number = TypeVar("Number", Jet, BallJet, Array)


@dataclass(frozen=True)
class Stem:
    """A line of travel that leans by `gamma`, rad, from +y towards +x, which loads the rise.

    The `lean` of a recipe is -gamma. At input u the roller's centre is at (u + S sin gamma, level + S cos gamma).
    """

    gamma: float = 0.0
    unit: ClassVar[Unit] = "mm"


@dataclass(frozen=True)
class Arm:
    """An arm of `length`, mm, about a pivot at the height `pivot`, mm, over the lower edge.

    At input u the pivot is at (u, pivot), the roller's centre at (u - side length cos psi, pivot + length sin psi),
    psi = psi0 + S. `side` is 1 trailing (the roller behind the pivot), -1 leading.
    """

    length: float
    pivot: float
    side: Side = 1
    unit: ClassVar[Unit] = "deg"


Guide: TypeAlias = Stem | Arm


@dataclass(frozen=True, eq=False)
class LinearFollower:
    """A roller, shoe or knife edge (`radius` 0) of `radius`, mm, on its guide.

    level  height of the roller's centre over the lower edge at lift 0, mm: base + radius on a flank below the roller
    law    intended lift, mm or rad, over the input, mm, from its first knot to its last; with a period it is endless
    """

    guide: Guide
    radius: float
    level: float
    law: Piecewise

    @property
    def unit(self) -> Unit:
        """Unit of positions as they are reported."""
        return self.guide.unit

    @property
    def psi0(self) -> float:
        """Angle of an arm over +x (side -1) or -x (side 1) at lift 0, rad; raises ValueError beyond the arm's reach."""
        if not isinstance(self.guide, Arm):
            return 0.0
        return math.asin((self.level - self.guide.pivot) / self.guide.length)

    @property
    def span(self) -> tuple[float, float]:
        """First and last input, mm; one period of an endless motion."""
        if self.law.period is not None:
            return 0.0, self.law.period
        return float(self.law.knots[0]), float(self.law.knots[-1])

    @property
    def lever(self) -> float:
        """Length of the arm, mm, by which a swing becomes a path; 1 along a stem, whose lift is one."""
        return self.guide.length if isinstance(self.guide, Arm) else 1.0

    @property
    def endless(self) -> bool:
        """Whether the motion is periodic."""
        return self.law.period is not None

    def centre(self, u: Array, lift: Array) -> Array:
        """Centre of the roller (n, 2), mm, at inputs u (n,), mm, and lifts (n,), mm or rad."""
        x, y = self.path(u, lift)
        return np.stack([x, y], axis=-1)

    def path(self, u: Number, lift: Number) -> tuple[Number, Number]:
        """Coordinates of the roller's centre, mm, as numbers, jets or ball jets of inputs, mm, and lifts, mm or rad."""
        if isinstance(self.guide, Stem):
            return u + lift * math.sin(self.guide.gamma), lift * math.cos(self.guide.gamma) + self.level
        psi = lift + self.psi0
        x = u - cos(psi) * (self.guide.side * self.guide.length)
        return x, sin(psi) * self.guide.length + self.guide.pivot

    def lift_at(self, point: Array) -> tuple[Array, Array]:
        """Input, mm, and lift, mm or rad, (n,) each, that bring the centre to points (n, 2), mm; nan out of reach."""
        x, y = point[..., 0], point[..., 1]
        if isinstance(self.guide, Stem):
            lift = (y - self.level) / math.cos(self.guide.gamma)
            return x - lift * math.sin(self.guide.gamma), lift
        with np.errstate(invalid="ignore"):
            share = (y - self.guide.pivot) / self.guide.length
            psi = np.arcsin(share)
            return x + self.guide.side * self.guide.length * np.sqrt(1.0 - share * share), psi - self.psi0

    def rates_along(self, point: Array, tangent: Array) -> tuple[Array, Array]:
        """Rates (n,) of input and lift along paths of the centre, per mm, at points (n, 2), mm, tangents (n, 2)."""
        x, y = tangent[..., 0], tangent[..., 1]
        if isinstance(self.guide, Stem):
            return x - y * math.tan(self.guide.gamma), y / math.cos(self.guide.gamma)
        share = (point[..., 1] - self.guide.pivot) / self.guide.length
        upright = np.sqrt(np.maximum(1.0 - share * share, LEVEL))
        return x - self.guide.side * share / upright * y, y / (self.guide.length * upright)

    def reflected(self) -> LinearFollower:
        """The follower mirrored in y = 0: a flank above the roller becomes one below it."""
        if isinstance(self.guide, Stem):
            guide: Guide = Stem(-self.guide.gamma)
        else:
            guide = replace(self.guide, pivot=-self.guide.pivot)
        return LinearFollower(guide, self.radius, -self.level, self.law.taken_from(0.0))

    def larger(self, by: float) -> LinearFollower:
        """The follower with a roller larger by `by`, mm, its pitch curve the same."""
        return replace(self, radius=self.radius + by) if by else self

    @cached_property
    def cells(self) -> Array:
        """Inputs (m,), rising from the first to the last, between which the law is all but a cubic.

        Raises UnsettledError for a motion that is too rough.
        """
        first, last = self.span
        near = NEAR * max(1e-3 * (last - first) / self.lever, 1e-9)
        return cubic_cells(self.law, self.law.breaks, near, (first, last))

    @cached_property
    def corners(self) -> Array:
        """Inputs (k,) where the velocity jumps, so that the pitch curve has a corner."""
        if not len(self.law.breaks):
            return np.empty(0)
        at, jumps = self.law.jumps(1)
        corners: Array = at[np.abs(jumps[1]) > VELOCITY / self.lever]
        return corners
