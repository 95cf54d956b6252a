"""A roller on a cylindrical cam, as intended: where it bears along its axis, its height at lift 0, its motion.

Axes: z is the cam's axis, mm and radians. The cam stands still and the follower runs round it, counter-clockwise seen
from +z, by the shaft angle theta. At theta = 0 the roller's axis points along +x. The roller's axis is a radius, at the
height level + S(theta), S growing along +z; rho is the coordinate along it. `rotation: ccw` is the mirror image
(y -> -y), which is undone when a file is read.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from kin.law.bounds import cubic_cells
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.piecewise import Piecewise
    from kin.numeric.arrays import Array

NEAR = 1e-6  # mm: cells of the law are cubics within this


@dataclass(frozen=True)
class Arm:
    """An arm that leads the roller: its length, and the place of its pivot, mm.

    The pivot's axis is parallel to the roller's, at (offset, pivot) along e_t and z; `side` is 1 of an arm that trails,
    -1 of one that leads. Its angle at lift 0 follows from the height of the roller's axis there.
    """

    length: float
    offset: float
    pivot: float
    side: int


@dataclass(frozen=True, eq=False)
class DrumFollower:
    """A roller of `radius`, mm, on a follower that travels along the cam's axis, or on an arm.

    inner, outer  where the roller begins and ends along its axis, mm from the cam's axis
    level         height of the roller's axis at lift 0, mm; with a rib of the middle between both rollers
    law           intended lift, mm, of an arm rad, over the shaft angle, rad, with the period 2 pi
    offset        distance of the roller's axis from a radius, along e_t, mm; 0 on an arm
    taper         half angle of a conical roller, rad, thicker outwards; its radius is that at the distance `at`, mm
    """

    radius: float
    inner: float
    outer: float
    level: float
    law: Piecewise
    offset: float = 0.0
    taper: float = 0.0
    at: float | None = None
    arm: Arm | None = None

    @cached_property
    def cells(self) -> Array:
        """Angles (m + 1,), rad, rising from 0 to 2 pi, between which the law is all but a cubic.

        Raises UnsettledError for a motion that is too rough.
        """
        return cubic_cells(self.law, self.law.breaks, NEAR)
