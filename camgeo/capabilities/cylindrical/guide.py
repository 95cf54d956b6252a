"""Guide of the roller of a cylindrical cam: a carriage along the axis, or an arm that swings beside the drum.

The roller's axis is parallel to e_r(theta), at places (y, z) along e_t and the cam's axis. With an arm, whose pivot's
axis is parallel to it as well,

    y = pivot_y - side l cos psi,     z = pivot_z + l sin psi,     psi = start + S

so that the roller leaves the radius. On a `trailing` arm, side 1, the drum's surface runs from the pivot to the roller.
Rows of derivatives by the shaft angle are arrays or balls.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np

from kin.numeric.elementary import cos, sin
from kin.numeric.interval import Ball, sin_cos
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from typing import ClassVar, Literal

    from kin.numeric.arrays import Array
    from kin.numeric.jet import Series

Rows = TypeVar("Rows", "Array", Ball)


@dataclass(frozen=True)
class Carriage:
    """A carriage along the axis: height of the roller's axis at lift 0, and its distance from a radius, mm."""

    level: float
    offset: float = 0.0
    unit: ClassVar[Literal["mm", "deg"]] = "mm"
    reach: ClassVar[float] = 1.0

    @property
    def radial(self) -> bool:
        """Whether the roller's axis is a radius of the drum."""
        return self.offset == 0.0

    def height(self, lift: float) -> float:
        """Height of the roller's axis at a lift, mm."""
        return self.level + lift

    def beside(self, distance: float) -> Carriage:
        """Carriage with its roller higher by `distance`, mm."""
        return replace(self, level=self.level + distance)

    def place(self, rows: Rows) -> tuple[list[Rows], list[Rows]]:
        """Y and z, mm, and derivatives by the shaft angle, from as many rows of S, mm."""
        lift, *rates = _each(rows)
        return [lift * 0.0 + self.offset, *(rate * 0.0 for rate in rates)], [lift + self.level, *rates]

    def path(self, lift: Series) -> tuple[Series, Series]:
        """Y and z, mm, of a lift as a series."""
        return lift * 0.0 + self.offset, lift + self.level

    def lean(self, lift: Array) -> Array:
        """Angle of the roller's way against the cam's axis, towards -e_t, rad (n,)."""
        return np.zeros_like(lift)

    def intended(self) -> dict[str, Any]:
        """Arguments of kin's `DrumFollower` for this guide, by their names."""
        return {"offset": self.offset}


@dataclass(frozen=True)
class Arm:
    """An arm: from its pivot to the roller's axis, mm; y and z of the pivot, mm; side; its angle at lift 0, rad.

    `reach` is how far the roller goes along its way by the radian, mm.
    """

    length: float
    y: float
    z: float
    side: Literal[-1, 1]
    start: float
    unit: ClassVar[Literal["mm", "deg"]] = "deg"
    radial: ClassVar[bool] = False

    @property
    def reach(self) -> float:
        """How far the roller goes along its way by the radian, mm."""
        return self.length

    def height(self, lift: float) -> float:
        """Height of the roller's axis where the arm has swung by `lift`, rad, mm."""
        return self.z + self.length * math.sin(self.start + lift)

    def beside(self, distance: float) -> Arm:
        """Arm whose roller lies `distance`, mm, square to it on its upper side."""
        turn = math.atan2(distance, self.length)
        return replace(self, length=math.hypot(self.length, distance), start=self.start + turn)

    def across(self, low: float, high: float) -> tuple[float, float]:
        """Least and greatest distance of the roller from its pivot, across the drum's axis, between two lifts, mm."""
        ends = [self.length * math.cos(self.start + lift) for lift in (low, high)]
        most = self.length if (self.start + low) * (self.start + high) < 0.0 else max(ends)
        return min(ends), most

    def place(self, rows: Rows) -> tuple[list[Rows], list[Rows]]:
        """Y and z, mm, and derivatives by the shaft angle, from as many rows, up to 4, of S, rad."""
        s, *rates = _each(rows)
        sine, cosine = _sin_cos(s + self.start)
        across, up = cosine * (-self.side * self.length), sine * self.length
        # derivatives of across and up by psi: those of a circle
        circle = (sine * (self.side * self.length), cosine * self.length)
        y, z = [across + self.y], [up + self.z]
        beside = (across * -1.0, up * -1.0)
        for values, first, second in zip((y, z), circle, beside, strict=True):
            if rates:
                values.append(first * rates[0])
            if len(rates) > 1:
                values.append(second * rates[0] * rates[0] + first * rates[1])
            if len(rates) > 2:
                third = first * rates[0] * rates[0] * rates[0] * -1.0
                values.append(third + second * rates[0] * rates[1] * 3.0 + first * rates[2])
        return y, z

    def path(self, lift: Series) -> tuple[Series, Series]:
        """Y and z, mm, of a lift as a series, rad."""
        psi = lift + self.start
        return cos(psi) * (-self.side * self.length) + self.y, sin(psi) * self.length + self.z

    def lean(self, lift: Array) -> Array:
        """Angle of the roller's way against the cam's axis, towards -e_t, rad (n,)."""
        return np.asarray(self.side * (self.start + lift))

    def intended(self) -> dict[str, Any]:
        """Arguments of kin's `DrumFollower` for this guide, by their names."""
        from kin.cylindrical import follower

        return {"arm": follower.Arm(self.length, self.y, self.z, self.side)}


Guide: TypeAlias = Carriage | Arm


def _each(rows: Rows) -> list[Rows]:
    return [rows[k] for k in range(len(rows.mid if isinstance(rows, Ball) else rows))]


def _sin_cos(angle: Rows) -> tuple[Rows, Rows]:
    return sin_cos(angle) if isinstance(angle, Ball) else (np.sin(angle), np.cos(angle))
