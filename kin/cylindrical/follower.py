"""A roller on a cylindrical cam, as intended: where it bears along its axis, its height at lift 0, its motion.

Axes: z is the cam's axis, mm and radians. The cam stands still and the follower runs round it, counter-clockwise seen
from +z, by the shaft angle theta. At theta = 0 the roller's axis points along +x. That axis is always parallel to a
radius, at y across it and z along the cam's axis; rho is the coordinate along it. On a slide y is the offset and z the
level + S(theta), S growing along +z. `rotation: ccw` is the mirror image (y -> -y), undone when a file is read.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

from kin.law.bounds import cubic_cells
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass
from kin.turned.guide import Slide, Swing

if TYPE_CHECKING:
    from kin.law.contacts import Side, Unit
    from kin.law.piecewise import Piecewise
    from kin.numeric.arrays import Array
    from kin.numeric.elementary import Jet
    from kin.turned.guide import Guide

    Number = float | Array | Jet

NEAR = 1e-6  # mm: cells of the law are cubics within this


@dataclass(frozen=True)
class Arm:
    """An arm of `length`, mm, about an axis that is parallel to the roller's, at y = `offset` and z = `pivot`, mm.

    At the angle psi, rad, the roller's axis is at y = offset - side length cos psi, z = pivot + length sin psi. `side`
    is 1 trailing (the roller runs behind the pivot), -1 leading. Two rollers about a rib are on one body: both are
    `length` along the arm's line, and half their distance square to it.
    """

    length: float
    offset: float
    pivot: float
    side: Side = 1


@dataclass(frozen=True, eq=False)
class DrumFollower:
    """A roller of `radius`, mm, on a follower that travels along the cam's axis or swings.

    inner, outer  where the roller begins and ends along its axis, mm from the cam's axis
    level         height of the roller's axis at lift 0, mm; with a rib of the middle between both rollers
    law           intended lift, mm, or rad of an arm, over the shaft angle, rad, with the period of all `turns`
    offset        y of the roller's axis on a slide, mm
    taper         half angle of a conical roller, rad: it grows outwards, and has its `radius` at the place `at`, mm
    arm           on which the roller swings; its angle is psi0 + S, where sin psi0 = (level - pivot)/length
    turns         of the drum after which the motion repeats
    shoe          length, mm, of a shoe that turns freely about its pin in place of a roller, between two arcs from tip
                  to tip that are twice the radius apart in the middle; None for a roller

    Raises ValueError for turns below 1, and for a shoe that is not longer than wide, or not led by a slide whose pin
    is a cylinder on a radius.
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
    turns: int = 1
    shoe: float | None = None

    def __post_init__(self) -> None:
        if self.turns < 1:
            raise ValueError(f"a motion repeats after a whole number of turns, not {self.turns}")
        if self.shoe is None:
            return
        if not self.shoe > 2.0 * self.radius:
            raise ValueError(f"a shoe of {self.shoe:.6g} mm is not longer than it is wide")
        if self.arm is not None or self.offset or self.taper:
            raise ValueError("a shoe is on a slide, its pin a cylinder on a radius of the drum")

    @property
    def period(self) -> float:
        """Shaft angle, rad, after which the motion repeats."""
        return TURN * self.turns

    @cached_property
    def cells(self) -> Array:
        """Angles (m + 1,), rad, rising over the period from 0, between which the law is all but a cubic.

        Raises UnsettledError for a motion that is too rough.
        """
        return cubic_cells(self.law, self.law.breaks, NEAR / self.guide().lever, (0.0, self.period))

    @property
    def growth(self) -> float:
        """How fast the roller's radius grows along its axis."""
        return math.tan(self.taper)

    def radius_at(self, rho: Number, clearance: float = 0.0) -> Number:
        """Radius, mm, at places rho, mm, along the roller, of one that is larger by a clearance, mm."""
        return self.radius + clearance + (rho - (self.at or 0.0)) * self.growth

    @property
    def unit(self) -> Unit:
        """Unit of positions as they are reported."""
        return "mm" if self.arm is None else "deg"

    @property
    def start(self) -> float:
        """Position at lift 0: height of the roller's axis, mm, or the arm's angle, rad."""
        return self.level if self.arm is None else math.asin((self.level - self.arm.pivot) / self.arm.length)

    def in_unit(self, position: float) -> float:
        """A position, mm or rad, in the unit in which it is reported."""
        return position if self.arm is None else math.degrees(position)

    def guide(self, beside: float = 0.0) -> Guide:
        """What leads the roller's axis; of two about a rib that which is `beside` the middle, mm, upwards.

        Raises ValueError where an arm does not reach its level.
        """
        if self.arm is None:
            return Slide(self.offset, self.level + beside)
        arm, rise = self.arm, (self.level - self.arm.pivot) / self.arm.length
        if not abs(rise) < 1.0:
            raise ValueError(f"an arm of {arm.length:.6g} mm at {arm.pivot:.6g} mm does not reach {self.level:.6g} mm")
        angle = self.start + math.atan2(beside, arm.length)
        return Swing(math.hypot(arm.length, beside), arm.offset, arm.pivot, arm.side, angle)
