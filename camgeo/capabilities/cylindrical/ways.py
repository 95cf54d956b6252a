"""Ways of a cutter along a flank: where its axis stands at a shaft angle, on a machine that turns the drum.

A cutter as large as the roller at every distance rho from the drum's axis takes the roller's own place, and leaves the
flank everywhere: A = theta, y and x those of the roller's axis. Beside an arm, or with an offset, that is beside the
drum's axis. A smaller one touches the flank as the roller does at one distance; let e be by how much it is smaller
there, and a the angle of the contact.

- Beside the drum's axis it lies within the roller and touches it at rho:

      A = theta,    y = y_0 - side e sin a,    x = z_0 + side e cos a.

  Elsewhere it leaves at most sqrt((R - e)^2 + 2 R e (1 - cos d)) - C, R and C being the radii of roller and cutter
  there and d the difference of the contact angles: so far is the point that the roller touches from the cutter, which
  stays within the roller and cuts nothing else. A cutter that tapers less than its roller does so if it touches at its
  end.
- With its axis through that of the drum, and a cylinder for a roller on a radius, it follows the path whose flank on
  the cylinder r is the same curve. That rises by v = S' there, and a flank of any roller is level + S + g(v, r) at the
  angle theta + f(v, r), so that

      A = theta + f_R(v, r) - f_C(v, r),    x = level + S + g_R(v, r) - g_C(v, r).

  Farther out it cuts too deep, by about e sin^2 a (rho - r)/r, farther in it leaves metal. More depths do not help: a
  cutter that goes deeper cuts at every radius above its end.
- With its axis through that of the drum, and a roller beside a radius by y, it stands at A = theta + asin(y/rho). A
  point at X along the roller and Y across it is then from both axes at distances that differ by no more than
  |y| |1 - X/rho| + |Y| (1 - cos(A - theta)); on a cone its place along them counts as well.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.bends import bends_on, contact_turns, ways_bend
from camgeo.capabilities.cylindrical.flank import distance
from camgeo.fit.parted import looks_of
from kin.numeric.interval import Ball
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.flank import Flank
    from kin.numeric.arrays import Array

SAME = 1e-9  # mm: sizes that differ by less are one
TAPERS = 2e-6  # rad: so are half angles, as no figure says that of a cone with its apex on the axis
NEAR, ENDS = 0.05, 0.25  # of the tolerance: sizes of cones that are one, and a cutter's end that is on the floor
SLOPES, RADII = 33, 25  # at which what a way leaves is looked at
PARTS = 48  # of the roller's length, over each of which it is bounded how the contact turns
HALVINGS = 30  # of the radius at which a cutter is set
MOST_DEPTHS = 40  # that a smaller cutter may go in
BELOW = 0.02  # mm that a depth goes below where the next begins


class Off(NamedTuple):
    """Greatest metal, mm, that a way leaves on a flank, and that it cuts too deep."""

    left: float
    deep: float


class Cutter(NamedTuple):
    """A cutter by its radius at its end, mm, and its half angle, rad; it is thicker away from its end."""

    radius: float
    taper: float = 0.0

    def size(self, rho: Array | float, end: float) -> Array:
        """Its radius, mm, at distances rho from the drum's axis, its end at another, mm."""
        return np.asarray(self.radius + (rho - end) * math.tan(self.taper))


@dataclass(frozen=True, eq=False)
class Way:
    """The way of a cutter along a flank.

    at      distance from the drum's axis, mm, at which it leaves the flank as it is: on that cylinder with its axis
            through the drum's, else that far along the roller
    beside  whether its axis may stand beside the drum's
    end     distance of its end from the drum's axis, mm
    near    mm by which a cone may differ from its roller, and still counts as large as that
    """

    flank: Flank
    cutter: Cutter
    at: float
    beside: bool
    end: float = 0.0
    near: float = 0.0

    @cached_property
    def apart(self) -> float:
        """By how much the cutter differs from the roller, mm, at most, at its end and as far out as `at`."""
        ends = np.array([self.end, self.at])
        return float(np.abs(self.flank.size(ends) - self.cutter.size(ends, self.end)).max())

    @property
    def alike(self) -> bool:
        """Whether the cutter is as large as the roller, and stands in its place."""
        return self.apart <= max(self.near, SAME)

    @property
    def less(self) -> float:
        """By how much the cutter is smaller where it is set, mm; 0 of one that is as large as the roller."""
        return 0.0 if self.alike else float(self.flank.size(self.at) - self.cutter.size(self.at, self.end))

    @property
    def _aside(self) -> bool:
        """Whether the cutter's axis goes through that of the drum, and the roller's does not."""
        return not self.beside and not self.flank.guide.radial

    def places(self, theta: Array) -> tuple[Array, Array, Array]:
        """Angle A, rad, x along the drum and y beside its axis, mm, (n,) each, at shaft angles (n,), rad."""
        flank, pose = self.flank, self.flank.pose(theta)
        if self._aside:
            return theta + np.arcsin(pose.y / self.at), pose.z, np.zeros_like(theta)
        if self.alike:
            return theta, pose.z, pose.y
        if not self.beside:
            own = flank.on(theta, self.at)
            smaller = replace(flank, radius=self.cutter.radius).on(theta, self.at)
            return theta + own.phi - smaller.phi, pose.z + own.z - smaller.z, np.zeros_like(theta)
        angle = flank.along(theta, np.full_like(theta, self.at)).angle
        less = flank.side * self.less
        return theta, pose.z + less * np.cos(angle), pose.y - less * np.sin(angle)

    def bends(self, blank: float) -> tuple[Array, Array]:
        """Shaft angles (n + 1,), rad, over a period, and bounds (n,) of the way's second derivative between them, mm.

        An angle counts on the blank's radius, mm.
        """
        flank, look = self.flank, looks_of(self.flank.law)
        if not (self.beside or self.alike or self._aside):
            bend = ways_bend(flank, (look[:-1], look[1:]), self.at, self.cutter.radius) * (blank / self.at)
            return look, bend
        if not self._aside:
            return look, bends_on(flank, (look[:-1], look[1:]), self.at, self.less)
        y, z = flank.guide.place(Ball(*flank.law.enclosure(look[:-1], look[1:], 2)))
        u, u1, u2 = (row * (1.0 / self.at) for row in y)
        upright = 1.0 - u * u
        turn = u2 * upright**-0.5 + u * u1 * u1 * upright**-1.5
        return look, np.hypot(blank * turn.magnitude, z[2].magnitude)


def set_alike(way: Way, ends: tuple[float, float]) -> tuple[Way, Off]:
    """The way of a cutter as large as the roller, set between two distances, mm, and a bound of how far it is off."""
    inner, outer = ends
    off = way.apart
    if way.beside or way.flank.guide.radial:
        return way, Off(off, off)
    flank, look, at = way.flank, looks_of(way.flank.law), 0.5 * (inner + outer)
    y = float(flank.guide.place(Ball(*flank.law.enclosure(look[:-1], look[1:], 0)))[0][0].magnitude.max())
    across, sine = y + float(flank.size(outer)), y / at
    lost = 1.0 - math.sqrt(max(1.0 - sine * sine, 0.0))
    off += y * max(outer / at - 1.0, 1.0 - inner / at) + across * lost
    off += flank.slope * (outer * lost + across * sine)
    return replace(way, at=at), Off(off, off)


def set_radially(flank: Flank, cutter: Cutter, steep: float, ends: tuple[float, float]) -> tuple[Way, Off]:
    """The way with its axis through the drum's that is off least between two radii, mm, and by how much it is off.

    `steep` is the greatest |S'|, mm. Looked at on a grid of slopes and radii.
    """
    low, high = ends
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        off = radially_off(flank, cutter.radius, steep, middle, ends)
        low, high = (low, middle) if off.left > off.deep else (middle, high)  # farther out it leaves more
    at = 0.5 * (low + high)
    return Way(flank, cutter, at, beside=False), radially_off(flank, cutter.radius, steep, at, ends)


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
    flank: Flank, cutter: Cutter, floor: float, ends: tuple[float, float], most: float
) -> tuple[list[Way], Off]:
    """Ways with their axes beside the drum's, the outermost first, each down to its end; and what they leave, proved.

    The last goes down to the floor, mm. They are as few as leave no more than `most`, mm, between two distances, up to
    MOST_DEPTHS.
    """
    inner, outer = ends
    alike = abs(flank.taper - cutter.taper) <= TAPERS
    besides = (outer - floor) * abs(flank.slope - math.tan(cutter.taper)) if alike else 0.0
    parts = np.linspace(floor, outer, PARTS + 1)
    turned = np.concatenate([[0.0], np.cumsum(contact_turns(flank, parts) * np.diff(parts))])
    for count in range(1, MOST_DEPTHS + 1):
        # of a cutter that tapers as its roller any place will do, one that tapers less has to touch at its end
        edges = outer * ((inner if alike else floor) / outer) ** (np.arange(count + 1) / count)
        down = np.append(np.maximum(edges[1:-1] - BELOW, floor), floor)
        at = np.sqrt(edges[:-1] * edges[1:]) if alike else down
        pairs = zip(at.tolist(), down.tolist(), strict=True)
        ways = [Way(flank, cutter, place, beside=True, end=end) for place, end in pairs]
        left = 0.0
        for way, low, high in zip(ways, edges[1:], edges[:-1], strict=True):
            place, *sides = np.interp([way.at, low, high], parts, turned)
            left = max(left, _left(way, max(abs(each - place) for each in sides), (low, high)))
        if left <= most:
            break
    return ways, Off(left, besides)


def _left(way: Way, apart: float, strip: tuple[float, float]) -> float:
    """Bound of the metal, mm, left over a strip by a way whose contact angles differ by up to `apart`, rad, from there.

    With C = R - e it is what the roller's point is from a cutter that is smaller by e as where it is set, which falls
    with R, and what the cutter is smaller besides.
    """
    less, low = way.less, float(way.flank.size(strip[0]))
    more = max(float(way.flank.size(rho) - way.cutter.size(rho, way.end)) for rho in strip) - less
    square = (low - less) ** 2 + 2.0 * low * less * (1.0 - math.cos(apart))
    return math.sqrt(square) - (low - less) + max(more, 0.0)
