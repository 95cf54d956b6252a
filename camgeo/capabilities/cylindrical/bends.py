"""Proved bounds of the second derivatives of a flank over (theta, r), by which its triangles are as fine as need be.

Over (theta, r), r the real radius, the flank of a roller on a radius is r e^(i phi), z with phi = theta + f(v, r),
z = level + S + g(v, r) and v = S' (`camgeo.capabilities.cylindrical.flank`), so that all its second derivatives follow
from those of f and g and from S'' and S'''. On an arm, beside a radius or with a taper the angle a of the contact is
implicit, and so is rho on a cylinder: its derivatives follow from A sin a - z' cos a = side y tan d and from
rho^2 + q^2 = r^2, over balls of rho that hold every solution. All are balls over a cell.

`camgeo.fit.facets` bounds by them how far triangles are from the surface.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.fit.facets import facets_off, facets_width
from camgeo.fit.parted import looks_of
from kin.numeric.interval import Ball, asin, atan2, sin_cos

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.flank import Flank
    from kin.numeric.arrays import Array, Indices

SETTLE, WIDER = 8, 1e-12  # rounds by which places along a roller are enclosed, and the rounding of the first


class Bends(NamedTuple):
    """Bounds of a flank's second derivatives over cells (n,), in mm and rad.

    across   of |p_ij . n|, (3, n): twice by theta, by theta and r, twice by r
    whole    of |p_ij|, (3, n)
    turns    of the turn of the normal by theta and by r, (2, n)
    regular  least of D cos d/M, cos a and (rho + q q_2)/rho, above 0 where the flank is proved regular
    sweep    greatest |dphi/dtheta|
    unrolled of the second derivative by theta of (r phi, z), a row unrolled
    """

    across: Array
    whole: Array
    turns: Array
    regular: Array
    sweep: Array
    unrolled: Array

    def off(self, h1: Array, h2: Array | float) -> Array:
        """Bound of the distance of triangles from the surface, mm (n,), in cells of h1 rad (n,) by h2 mm."""
        return facets_off(self, h1, h2)

    def step(self, h2: float, tolerance: float) -> Array:
        """Widths h1, rad (n,), of cells of h2 mm whose triangles are within a tolerance, mm; 0 where none is."""
        return facets_width(self, h2, tolerance)

    def most(self, blocks: int) -> Bends:
        """Greatest bounds of corresponding cells in `blocks` equal blocks of them, (n / blocks,)."""

        def over(values: Array) -> Array:
            folded: Array = values.reshape(*values.shape[:-1], blocks, -1).max(axis=-2)
            return folded

        return Bends(*(over(part) for part in self))._replace(regular=-over(-self.regular))

    def at(self, index: Indices) -> Bends:
        """Bounds of some of the cells."""
        return Bends(*(part[..., index] for part in self))

    def joined(self, other: Bends) -> Bends:
        """Bounds over these cells and those of `other` of the same number together."""
        most = Bends(*(np.maximum(a, b) for a, b in zip(self, other, strict=True)))
        return most._replace(regular=np.minimum(self.regular, other.regular))


class _Second(NamedTuple):
    """A function of v and r as balls: its value, and its first and second derivatives."""

    value: Ball
    v: Ball
    r: Ball
    vv: Ball
    vr: Ball
    rr: Ball

    def times(self, other: _Second) -> _Second:
        """The product."""
        return _Second(
            self.value * other.value,
            self.v * other.value + self.value * other.v,
            self.r * other.value + self.value * other.r,
            self.vv * other.value + self.v * other.v * 2.0 + self.value * other.vv,
            self.vr * other.value + self.v * other.r + self.r * other.v + self.value * other.vr,
            self.rr * other.value + self.r * other.r * 2.0 + self.value * other.rr,
        )

    def through(self, value: Ball, first: Ball, second: Ball) -> _Second:
        """A function of it, from that function's value and derivatives."""
        return _Second(
            value,
            first * self.v,
            first * self.r,
            second * self.v * self.v + first * self.vv,
            second * self.v * self.r + first * self.vr,
            second * self.r * self.r + first * self.rr,
        )


def bends(flank: Flank, theta: tuple[Array, Array], r: tuple[Array, Array]) -> Bends:
    """Bounds of second derivatives over cells from theta[0] to theta[1], rad, and r[0] to r[1], mm, (n,) each.

    No cell has a break of the motion inside.
    """
    rows = Ball(*flank.law.enclosure(theta[0], theta[1], 3))
    return _explicit(flank, rows, r) if flank.radial else _implicit(flank, rows, Ball.between(*r))


def _explicit(flank: Flank, rows: Ball, r: tuple[Array, Array]) -> Bends:
    """Bounds of the flank of a roller whose axis is a radius, from rows of S to the third derivative."""
    v, bend, jerk = rows[1], rows[2], rows[3]
    radius, side = flank.radius, float(flank.side)
    s, c, h, square = _angles(v, Ball.between(*r), radius)
    k = 1.0 - h.value * h.value
    f = _turned(h, side)
    reach = side * radius
    phi1, phi2 = f.v * bend + 1.0, f.r
    phi11, phi12, phi22 = f.vv * bend * bend + f.v * jerk, f.vr * bend, f.rr
    z11 = bend + (c.vv * bend * bend + c.v * jerk) * reach
    z12, z22 = c.vr * bend * reach, c.rr * reach
    radial = Ball.between(*r)
    # along e^(i phi), square to it, and along z
    second = (
        (-(radial * phi1 * phi1), radial * phi11, z11),
        (-(radial * phi1 * phi2), phi1 + radial * phi12, z12),
        (-(radial * phi2 * phi2), phi2 * 2.0 + radial * phi22, z22),
    )
    normal = (s.value * h.value * side, -(s.value * k**0.5), c.value)
    across = [p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2] for p in second]
    whole = [np.sqrt(sum(part.magnitude**2 for part in parts)) for parts in second]
    lean1, lean2 = s.v * bend * c.value**-1, s.r * c.value**-1
    turns = np.stack([np.hypot(lean1.magnitude, s.value.magnitude), lean2.magnitude])
    regular = 1.0 - (c.value * bend * reach + s.value * s.value * radius**2) * square**-1
    return Bends(
        np.stack([ball.magnitude for ball in across]),
        np.stack(whole),
        turns,
        regular.bounds()[0],
        phi1.magnitude,
        np.hypot((radial * phi11).magnitude, z11.magnitude),
    )


def ways_bend(flank: Flank, theta: tuple[Array, Array], r: float, cutter: float) -> Array:
    """Bounds (n,) over cells of the second derivative of the path of a cutter that leaves a flank on a cylinder.

    The path is that of `camgeo.capabilities.cylindrical.ways`: A and x on the cylinder r, mm, of a cutter of a radius,
    mm; in mm per rad^2, that of A times r.
    """
    rows = Ball(*flank.law.enclosure(theta[0], theta[1], 3))
    v, bend, jerk = rows[1], rows[2], rows[3]
    side, radial = float(flank.side), Ball.between(np.full_like(v.mid, r), np.full_like(v.mid, r))
    turns, heights = [], []
    for radius in (flank.radius, cutter):
        _, c, h, _ = _angles(v, radial, radius)
        f = _turned(h, side)
        turns.append(f.vv * bend * bend + f.v * jerk)
        heights.append((c.vv * bend * bend + c.v * jerk) * (side * radius))
    return np.hypot(r * (turns[0] - turns[1]).magnitude, (bend + heights[0] - heights[1]).magnitude)


def bends_on(flank: Flank, theta: tuple[Array, Array], rho: float, less: float) -> Array:
    """Bounds (n,) over cells of the second derivative of a place square to the roller's axis, y and z, in mm per rad^2.

    It is that axis, or a place `less` mm from it towards where a flank is touched at rho, mm.
    """
    y, z = flank.guide.place(Ball(*flank.law.enclosure(theta[0], theta[1], 3)))
    if not less:
        return np.asarray(np.hypot(y[2].magnitude, z[2].magnitude))
    contact = _contact(flank, y, z, Ball.exact(np.full_like(theta[0], rho)))
    s, c, a1 = contact.s, contact.c, contact.first
    a11 = _bent(flank, y, z, contact)
    reach = flank.side * less
    across, up = y[2] - (c * a11 - s * a1 * a1) * reach, z[2] - (s * a11 + c * a1 * a1) * reach
    return np.asarray(np.hypot(across.magnitude, up.magnitude))


def contact_turns(flank: Flank, rho: Array) -> Array:
    """Bounds (m,) of how fast the angle of contact turns along the roller, rad/mm, between places (m + 1,), mm."""
    look = looks_of(flank.law)
    mid, rad = flank.law.enclosure(look[:-1], look[1:], 2)
    parts, count = len(rho) - 1, mid.shape[1]
    y, z = flank.guide.place(Ball(np.tile(mid, parts), np.tile(rad, parts)))
    places = Ball.between(np.repeat(rho[:-1], count), np.repeat(rho[1:], count))
    return np.asarray(_contact(flank, y, z, places).second.magnitude.reshape(parts, count).max(axis=1))


def _bent(flank: Flank, y: list[Ball], z: list[Ball], contact: _Contact) -> Ball:
    """The second derivative of the contact's angle by theta, from A sin a - z' cos a = side y tan d."""
    s, c, a1 = contact.s, contact.c, contact.first
    side, t = float(flank.side), flank.slope
    lag, lag2 = y[0] * (side * t), y[2] * (side * t)
    lean1 = y[2] * c + z[2] * s
    return (lag2 - y[3] * s + z[3] * c - a1 * lean1 * 2.0 + lag * a1 * a1) * contact.m**-1


def _turned(h: _Second, side: float) -> _Second:
    """The angle f by which a contact lies before the roller: sin f = -side h."""
    k = 1.0 - h.value * h.value
    return h.through(h.value, k**-0.5 * -side, h.value * k**-1.5 * -side)


def _angles(v: Ball, r: Ball, radius: float) -> tuple[_Second, _Second, _Second, Ball]:
    """Sine and cosine of the pressure angle, R sin a/r, each with derivatives, and w^2."""
    nothing, one = Ball.exact(np.zeros_like(v.mid)), Ball.exact(np.ones_like(v.mid))
    vv, rr = v * v, r * r
    total = vv + rr
    sums = _Second(total, v * 2.0, r * 2.0, one * 2.0, nothing, one * 2.0)
    apart = rr - vv
    less = total - 2.0 * radius**2
    q = _Second(
        apart * apart + vv * (rr - radius**2) * 4.0,
        v * less * 4.0,
        r * total * 4.0,
        less * 4.0 + vv * 8.0,
        v * r * 8.0,
        total * 4.0 + rr * 8.0,
    )
    root = q.through(q.value**0.5, q.value**-0.5 * 0.5, q.value**-1.5 * -0.25)
    x = _Second(*((a + b) * 0.5 for a, b in zip(sums, root, strict=True)))
    inverse = x.through(x.value**-0.5, x.value**-1.5 * -0.5, x.value**-2.5 * 0.75)
    s = inverse.times(_Second(v, one, nothing, nothing, nothing, nothing))
    u = 1.0 - s.value * s.value
    c = s.through(u**0.5, -(s.value * u**-0.5), -(u**-1.5))
    h = s.times(_Second(r**-1 * radius, nothing, r**-2 * -radius, nothing, nothing, r**-3 * (2.0 * radius)))
    return s, c, h, x.value


class _Contact(NamedTuple):
    """Balls of contact along the roller: sine and cosine of a, R, M, and a's derivatives by theta and by rho."""

    s: Ball
    c: Ball
    radius: Ball
    m: Ball
    first: Ball
    second: Ball


def _contact(flank: Flank, y: list[Ball], z: list[Ball], rho: Ball) -> _Contact:
    t = flank.slope
    radius = (rho - flank.at) * t + flank.radius
    along = rho + radius * t + y[1]
    lag = y[0] * (flank.side * t)
    square = along**2 + z[1] ** 2
    m = (square - lag**2) ** 0.5
    s, c = sin_cos(atan2(z[1], along) + asin(lag * square**-0.5))
    first = (y[1] * (flank.side * t) - y[2] * s + z[2] * c) * m**-1
    return _Contact(s, c, radius, m, first, s * m**-1 * -(1.0 + t * t))


def places_along(flank: Flank, y: list[Ball], z: list[Ball], r: Ball) -> Ball:
    """Balls of the distances along the roller at which cylinders are touched.

    Each solution stays inside: it is the root of r^2 - q^2, with q of a place that was inside before.
    """
    reach = np.abs(y[0].magnitude) + flank.size(r.magnitude)
    low = np.sqrt(np.maximum(r.bounds()[0] ** 2 - reach**2, 0.0))
    rho = Ball.between(low * (1.0 - WIDER), r.bounds()[1])
    for _ in range(SETTLE):
        contact = _contact(flank, y, z, rho)
        q = y[0] - contact.radius * contact.s * float(flank.side)
        low, high = ((r**2 - q**2) ** 0.5).bounds()
        before = rho.bounds()
        rho = Ball.between(np.maximum(low, before[0]), np.maximum(np.minimum(high, before[1]), before[0]))
    return rho


def _implicit(flank: Flank, rows: Ball, r: Ball) -> Bends:
    """Bounds of the flank of any roller, from rows of S to the third derivative, in axes that turn with the roller."""
    y, z = flank.guide.place(rows)
    t, side = flank.slope, float(flank.side)
    rho = places_along(flank, y, z, r)
    contact = _contact(flank, y, z, rho)
    s, c, radius, m, a1, a2 = contact
    inverse, spread = m**-1, 1.0 + t * t
    lag = y[0] * (side * t)

    # A sin a - z' cos a = lag, differentiated twice: A_1 = y'', A_2 = 1 + t^2
    lean1, lean2 = y[2] * c + z[2] * s, c * spread
    a11 = _bent(flank, y, z, contact)
    a12 = (lag * a1 * a2 - a2 * lean1 - a1 * lean2) * inverse
    a22 = (lag * a2 * a2 - a2 * lean2 * 2.0) * inverse

    # across q = y - side R sin a, height h = z + side R cos a, over (theta, rho)
    q = y[0] - radius * s * side
    q1 = y[1] - radius * c * a1 * side
    q2, h2 = (s * t + radius * c * a2) * -side, (c * t - radius * s * a2) * side
    q11 = y[2] - radius * (c * a11 - s * a1 * a1) * side
    h11 = z[2] - radius * (s * a11 + c * a1 * a1) * side
    q12 = (c * a1 * t + radius * (c * a12 - s * a1 * a2)) * -side
    h12 = (s * a1 * t + radius * (s * a12 + c * a1 * a2)) * -side
    q22 = (c * a2 * (2.0 * t) + radius * (c * a22 - s * a2 * a2)) * -side
    h22 = (s * a2 * (2.0 * t) + radius * (s * a22 + c * a2 * a2)) * -side

    # rho^2 + q^2 = r^2
    out = rho + q * q2
    over = out**-1
    rho1, rho2 = q * q1 * over * -1.0, r * over
    k11, k12, k22 = q1 * q1 + q * q11, q1 * q2 + q * q12, q2 * q2 + q * q22 + 1.0
    rho11 = (k11 + k12 * rho1 * 2.0 + k22 * rho1 * rho1) * over * -1.0
    rho12 = (k12 + k22 * rho1) * rho2 * over * -1.0
    rho22 = (1.0 - k22 * rho2 * rho2) * over

    # second derivatives over (theta, rho) along e_r, e_t and z, then over (theta, r)
    one = Ball.exact(np.ones_like(r.mid))
    p2 = (one, q2, h2)
    p11, p12, p22 = (q1 * -2.0 - rho, q11 - q, h11), (q2 * -1.0, q12 + 1.0, h12), (one * 0.0, q22, h22)
    second = (
        [a + b * rho1 * 2.0 + d * rho1 * rho1 + rho11 * e for a, b, d, e in zip(p11, p12, p22, p2, strict=True)],
        [(b + d * rho1) * rho2 + rho12 * e for b, d, e in zip(p12, p22, p2, strict=True)],
        [d * rho2 * rho2 + rho22 * e for d, e in zip(p22, p2, strict=True)],
    )
    # along the normal p_2 has no part, and the rest is short
    n11 = (q1 * 2.0 + rho) * t + (s * (q - y[2]) + c * z[2]) * side - radius * a1 * a1
    n12 = (s * spread + radius * c * a2 * t) * -side - radius * a1 * a2
    n22 = radius * a2 * a2 * -1.0
    steep = math.cos(flank.taper)
    across = (n11 + n12 * rho1 * 2.0 + n22 * rho1 * rho1, (n12 + n22 * rho1) * rho2, n22 * rho2 * rho2)
    turn1, turn2 = a1 + a2 * rho1, a2 * rho2
    turns = (
        steep * s.magnitude,
        (c * turn1 * (steep * side) + math.sin(flank.taper)).magnitude,
        steep * (s * turn1).magnitude,
    )
    factor = 1.0 - (radius * c * t + radius * (a1 + q * a2) * side) * inverse
    around = (q11 + q12 * rho1 * 2.0 + q22 * rho1 * rho1 + q2 * rho11, q1 + q2 * rho1)
    phi11 = (around[0] * rho - around[1] * rho1) * rho**-2
    return Bends(
        np.stack([steep * ball.magnitude for ball in across]),
        np.stack([np.sqrt(sum(part.magnitude**2 for part in parts)) for parts in second]),
        np.stack([np.sqrt(sum(part**2 for part in turns)), steep * turn2.magnitude]),
        np.min([factor.bounds()[0], c.bounds()[0], (out * rho**-1).bounds()[0]], axis=0),
        (around[1] * rho**-1 + 1.0).magnitude,
        np.hypot((r * phi11).magnitude, second[0][2].magnitude),
    )
