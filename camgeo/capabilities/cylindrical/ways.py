"""Ways of a cutter along a flank: where its axis stands at a shaft angle, on a machine that turns the drum.

A cutter as large as the roller takes the roller's own place, and leaves the flank at every radius. One that is smaller
by e touches the flank as the roller does at one radius:

- With its axis through that of the drum it follows the path whose flank on the cylinder r is the same curve. That rises
  by v = S' there, and a flank of any roller is level + S + g(v, r) at the angle theta + f(v, r), so that

      A = theta + f_R(v, r) - f_C(v, r),    x = level + S + g_R(v, r) - g_C(v, r).

  Farther out it cuts too deep, by about e sin^2 a (rho - r)/r, farther in it leaves metal. More depths do not help: a
  cutter that goes deeper cuts at every radius above its end.
- With its axis beside that of the drum it lies within the roller and touches it at rho:

      A = theta,    y = -side e sin a,    x = level + S + side e cos a,    tan a = v/rho.

  Elsewhere it leaves at most sqrt((R - e)^2 + 2 R e (1 - cos d)) - (R - e), d the difference of the contact angles: so
  far is the point that the roller touches from the cutter, which stays within the roller and cuts nothing else.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.angles import looks_of
from camgeo.capabilities.cylindrical.bends import ways_bend
from camgeo.capabilities.cylindrical.flank import distance
from kin.numeric.interval import Ball
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.flank import Flank
    from kin.numeric.arrays import Array

SAME = 1e-9  # mm: sizes that differ by less are one
SLOPES, RADII = 33, 25  # at which what a way leaves is looked at
HALVINGS = 30
MOST_DEPTHS = 40


class Off(NamedTuple):
    """Greatest metal, mm, that a way leaves on a flank, and that it cuts too deep."""

    left: float
    deep: float


@dataclass(frozen=True, eq=False)
class Way:
    """The way of a cutter of a radius, mm, along a flank, set on the cylinder, or at the distance rho, `at`, mm."""

    flank: Flank
    cutter: float
    at: float
    beside: bool

    @property
    def alike(self) -> bool:
        """Whether the cutter is as large as the roller."""
        return abs(self.flank.radius - self.cutter) <= SAME

    def places(self, theta: Array) -> tuple[Array, Array, Array]:
        """Angle A, rad, x along the drum and y beside its axis, mm, (n,) each, at shaft angles (n,), rad."""
        flank = self.flank
        level = flank.level + flank.law.derivatives(theta, 0)[0]
        if self.alike:
            return theta, level, np.zeros_like(theta)
        if not self.beside:
            own = flank.on(theta, self.at)
            smaller = replace(flank, radius=self.cutter).on(theta, self.at)
            return theta + own.phi - smaller.phi, level + own.z - smaller.z, np.zeros_like(theta)
        slope = flank.law.derivatives(theta, 1)[1]
        w, less = np.hypot(self.at, slope), flank.side * (flank.radius - self.cutter)
        return theta, level + less * self.at / w, -less * slope / w

    def bends(self, blank: float) -> tuple[Array, Array]:
        """Shaft angles (n + 1,), rad, over a turn, and bounds (n,) of the way's second derivative between them, mm.

        An angle counts on the blank's radius, mm.
        """
        flank, look = self.flank, looks_of(self.flank.law)
        if self.beside or self.alike:
            rows = Ball(*flank.law.enclosure(look[:-1], look[1:], 3))
            v, bend, jerk = rows[1], rows[2], rows[3]
            less = 0.0 if self.alike else flank.side * (flank.radius - self.cutter)
            inverse = (v * v + self.at**2) ** -0.5
            cube = inverse * inverse * inverse
            steeper = v * cube * inverse * inverse * (-3.0 * self.at**2)
            y = (steeper * bend * bend + cube * jerk * self.at**2) * less
            lower = (v * v * 3.0 * inverse * inverse - 1.0) * cube * self.at
            x = bend + (lower * bend * bend - v * cube * jerk * self.at) * less
            return look, np.hypot(x.magnitude, y.magnitude)
        return look, ways_bend(flank, (look[:-1], look[1:]), self.at, self.cutter) * (blank / self.at)


def set_radially(flank: Flank, cutter: float, steep: float, ends: tuple[float, float]) -> tuple[Way, Off]:
    """The way with its axis through the drum's that is off least between two radii, mm, and by how much it is off.

    `steep` is the greatest |S'|, mm. Looked at on a grid of slopes and radii.
    """
    low, high = ends
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        off = radially_off(flank, cutter, steep, middle, ends)
        low, high = (low, middle) if off.left > off.deep else (middle, high)  # farther out it leaves more
    at = 0.5 * (low + high)
    return Way(flank, cutter, at, beside=False), radially_off(flank, cutter, steep, at, ends)


def radially_off(flank: Flank, cutter: float, steep: float, at: float, ends: tuple[float, float]) -> Off:
    """By how much a way set on the cylinder `at`, mm, is off between two radii, mm, on slopes up to `steep`, mm."""
    v = np.linspace(0.0, steep, SLOPES)[:, None]
    r = np.linspace(*ends, RADII)

    def of(radius: float, on: Array) -> tuple[Array, Array]:
        rho = distance(on, v, radius)
        w = np.hypot(rho, v)
        return np.arctan2(-flank.side * radius * v / w, rho), flank.side * radius * rho / w

    (turn, height), (less, lower) = of(flank.radius, np.array([at])), of(cutter, np.array([at]))
    a, x = turn - less, height - lower
    (phi, z), (own, own_z) = of(flank.radius, r), of(cutter, r)
    left = np.hypot(r * np.sin(phi - a), z - x) - cutter
    deep = np.hypot(r * np.sin(a + own), x + own_z) - flank.radius
    return Off(max(float(left.max()), 0.0), max(float(deep.max()), 0.0))


def set_beside(
    flank: Flank, cutter: float, steep: float, ends: tuple[float, float], most: float
) -> tuple[list[tuple[Way, float]], Off]:
    """Ways with their axes beside the drum's, the outermost first, each with the distance, mm, down to which it goes.

    As few as leave no more than `most`, mm, between two distances, up to MOST_DEPTHS; and what they leave, proved.
    """
    inner, outer = ends
    for count in range(1, MOST_DEPTHS + 1):
        edges = outer * (inner / outer) ** (np.arange(count + 1) / count)
        at = np.sqrt(edges[:-1] * edges[1:])
        left = max(_left(flank.radius, cutter, steep, *pair) for pair in zip(at, edges[1:], strict=True))
        left = max(left, *(_left(flank.radius, cutter, steep, *pair) for pair in zip(edges[:-1], at, strict=True)))
        if left <= most:
            break
    ways = [Way(flank, cutter, float(middle), beside=True) for middle in at]
    return list(zip(ways, edges[1:].tolist(), strict=True)), Off(left, 0.0)


def _left(radius: float, cutter: float, steep: float, outer: float, inner: float) -> float:
    """Bound of the metal, mm, left at one of two distances by a way set at the other, on slopes up to `steep`, mm."""
    slope = min(steep, math.sqrt(outer * inner))  # where the contact angles differ most
    apart = math.atan2(slope, inner) - math.atan2(slope, outer)
    less = radius - cutter
    return math.sqrt(cutter**2 + 2.0 * radius * less * (1.0 - math.cos(apart))) - cutter
