"""What a cutter that follows the passes of a program leaves of a flank: metal cut away, and metal left.

A cutter of the radius C on an axis square to the drum's, which stands at the angle A, x along the drum and y beside its
axis, is from a point at the polar angle phi, the radius r and the height z at the distance

    H = hypot(r sin(phi - A) - y, z - x) - C,        if r cos(phi - A) is no less than that of its end.

Between points of a pass A, x and y move evenly. The least H over all positions is D: below 0 the point is cut away by
so much, above 0 so much metal stands on it, as a cutter larger by d leaves a surface d away. D is taken at points
p(theta, rho) of the exact flank, over all angles and the roller's length.

Over a cell of h1 rad by h2 mm D is less than at the least of its corners by no more than (h1^2 M11 + h2^2 M22)/8, with
bounds M of the second derivatives of H: the least of functions bends upwards no faster than they do. Nor is it more
than at the greatest corner by more than that and what the slopes of H at the corners differ by. The nearest position is
sought from the point's own angle on, over neighbouring blocks.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.cylindrical.roller import Gauge
    from kin.cylindrical.turned import Pass
    from kin.numeric.arrays import Array, Indices, Mask

LOOKS = 720  # parts of a turn over each of which the flank's second derivatives are bounded
ACROSS, ALONG = 0.05, 0.05  # of the tolerance, by which D may differ between angles, and between places of the roller
NEARLY = 0.9  # of the cutter's radius: a point that is nearer to its axis is cut away by more than any tolerance
END = 1e-4  # mm that a cutter's end counts deeper, so that points at its very end are met
NEAR = 10.0  # times the tolerance: a pass that leaves so much more than another decides nothing
LONGEST = 0.02  # rad of a block: Newton's method is at home within
STEPS, HOPS = 2, 60  # of Newton's method in a block, and blocks on the way to the nearest
MOST_POINTS = 4_000_000
ROOM = 0.01  # rad
THIN_ROWS, THIN = 6, 12  # every so many points are looked at, to see that a pass is far off


class Left(NamedTuple):
    """What stands on a flank at angles theta (n,), rad, and places rho (m,), mm: D (m, n), mm, inf where nothing cuts.

    `above` and `below` (m - 1, n - 1) bound D over the cells between.
    """

    theta: Array
    rho: Array
    off: Array
    above: Array
    below: Array


class _Points(NamedTuple):
    """Points of a flank (m, n): shaft angle, polar angle, radius, height; derivatives by theta and rho, (3, m, n).

    The components of the derivatives are along the roller, square to it and to the drum's axis, and along that.
    """

    theta: Array
    phi: Array
    r: Array
    z: Array
    by_theta: Array
    by_rho: Array

    def part(self, rows: slice, columns: slice) -> _Points:
        """Those at some of the places and angles."""
        return _Points(*(values[..., rows, columns] for values in self))


class _Met(NamedTuple):
    """How a pass comes to points (m, n): D, mm, how far out, mm, theta less A, rad, and slopes of H (2, m, n)."""

    off: Array
    along: Array
    tilt: Array
    slopes: Array


def left_on(gauge: Gauge, passes: Sequence[Pass], cutter: float, tolerance: float) -> Left | None:
    """What passes of a cutter of a radius, mm, leave of a flank; None where it would take too many points.

    The flank has to be regular, its motion without jumps of the velocity, and no pass may turn to and fro.
    """
    ways = [_forwards(one) for one in _deepest(passes)]
    longest = max((float(np.diff(one.a).max(initial=0.0)) for one in ways), default=0.0)
    radial = any(not one.y.any() for one in ways)
    tilt = (2.0 * abs(gauge.radius - cutter) / gauge.inner if radial else 0.0) + longest + ROOM
    while True:
        theta, rho = _grid(gauge, cutter, tilt, tolerance)
        if len(theta) * len(rho) > MOST_POINTS:
            return None
        left, widest = _left(gauge, ways, cutter, (theta, rho), tolerance)
        if widest <= tilt:
            return left
        tilt = 1.5 * widest


def _deepest(passes: Sequence[Pass]) -> list[Pass]:
    """Of passes on the same way the deepest."""
    found: list[Pass] = []
    for one in sorted(passes, key=lambda each: each.z):
        if not any(one.same_way(other) for other in found):
            found.append(one)
    return found


def _forwards(one: Pass) -> Pass:
    """A pass with rising angles, its blocks parted so that each is nearly straight as a point sees it."""
    order = slice(None) if one.a[-1] >= one.a[0] else slice(None, None, -1)
    rows = [row[order] for row in (one.a, one.x, one.y)]
    count = np.maximum(np.ceil(np.diff(rows[0]) / LONGEST), 1.0)
    at = np.arange(len(count) + 1, dtype=np.float64)
    own = np.repeat(at[:-1], count.astype(np.intp))
    step = np.arange(len(own)) - np.repeat(np.cumsum(count) - count, count.astype(np.intp))
    share = np.append(own + step / np.repeat(count, count.astype(np.intp)), at[-1])
    return type(one)(one.line, one.z, *(np.interp(share, at, row) for row in rows))


def _left(
    gauge: Gauge, ways: Sequence[Pass], cutter: float, grid: tuple[Array, Array], tolerance: float
) -> tuple[Left, float]:
    """What is left at points of a flank, and by how much the angle of a cutter differs from theirs at most, rad."""
    theta, rho = grid
    points = _points(gauge, theta, rho)
    off = np.full(points.phi.shape, np.inf)
    above, below = (np.full((len(rho) - 1, len(theta) - 1), np.inf) for _ in range(2))
    h1, h2 = 0.25 * np.diff(theta), 0.25 * np.diff(rho)[:, None]
    bend, widest = tolerance * (ACROSS + ALONG), 0.0
    for one in ways:
        # a point is met a little nearer to the drum's axis than the roller meets it
        first = int(np.searchsorted(rho, one.z - 0.5 * cutter))
        if first > len(rho) - 2:
            continue
        reach = cutter / gauge.floor + ROOM
        if _is_clear(points.part(slice(first, None, THIN_ROWS), slice(None, None, THIN)), one, gauge.radius, cutter):
            continue
        for turn, columns in _turns(one, theta, reach):
            met = _nearest(points.part(slice(first, None), columns), one, turn, gauge.radius, cutter)
            own, here = met.along >= one.z - END, (slice(first, None), columns)
            off[here] = np.minimum(off[here], np.where(own, met.off, np.inf))
            near = own & (met.off <= off[here] + NEAR * tolerance)
            widest = max(widest, float(np.abs(met.tilt[near]).max(initial=0.0)))
            cells = (slice(first, None), slice(columns.start, columns.stop - 1))
            spread = _over(met.slopes, np.maximum) - _over(met.slopes, np.minimum)
            most = _over(met.off, np.maximum) + spread[0] * h1[cells[1]] + spread[1] * h2[first:] + bend
            above[cells] = np.minimum(above[cells], np.where(_over(own, np.minimum), most, np.inf))
            least = _over(met.off, np.minimum) - bend
            below[cells] = np.minimum(below[cells], np.where(_over(own, np.maximum), least, np.inf))
    return Left(theta, rho, off, above, below), widest


def _is_clear(points: _Points, one: Pass, roller: float, cutter: float) -> bool:
    """Whether a pass stands so far from some points of a flank that it does not come to it anywhere between them."""
    theta = points.theta[0]
    far = np.inf
    for turn, columns in _turns(one, theta, cutter / float(points.r.min()) + ROOM):
        far = min(far, float(_nearest(points.part(slice(None), columns), one, turn, roller, cutter).off.min()))
    places = np.stack([points.r * np.cos(points.phi), points.r * np.sin(points.phi), points.z])
    apart = [np.sqrt((np.diff(places, axis=axis) ** 2).sum(axis=0)).max(initial=0.0) for axis in (1, 2)]
    return bool(far > sum(apart))


def _turns(one: Pass, theta: Array, reach: float) -> list[tuple[float, slice]]:
    """Turns, rad, that a pass is met on, the longest stay first, each with the angles that may meet it on that turn."""
    first = int(np.floor((one.a[0] - theta[-1] - reach) / TURN))
    found = []
    for turn in range(first, int(np.ceil((one.a[-1] + reach) / TURN)) + 1):
        low, high = np.searchsorted(theta + TURN * turn, (one.a[0] - reach, one.a[-1] + reach))
        if high - low > 1:
            found.append((TURN * turn, slice(int(low), int(high))))
    return sorted(found, key=lambda each: each[1].start - each[1].stop)


def _over(values: Array | Mask, pick: np.ufunc) -> Array:
    """The greatest or the least of the corners of each cell, (..., m - 1, n - 1) of (..., m, n)."""
    rows = pick(values[..., 1:, :], values[..., :-1, :])
    found: Array = pick(rows[..., 1:], rows[..., :-1])
    return found


def _points(gauge: Gauge, theta: Array, rho: Array) -> _Points:
    lift, v, bend = gauge.lifts.at(theta)
    place = rho[:, None]
    w = np.hypot(place, v)
    sine, cosine, reach = v / w, place / w, gauge.side * gauge.radius
    by_angle, by_place = place * bend / w**2, -v / w**2
    y, z = -reach * sine, gauge.level + lift + reach * cosine
    return _Points(
        np.broadcast_to(theta, y.shape),
        theta + np.arctan2(y, place),
        np.hypot(place, y),
        z,
        np.stack([-y, place - reach * cosine * by_angle, v - reach * sine * by_angle]),
        np.stack([np.ones_like(y), -reach * cosine * by_place, -reach * sine * by_place]),
    )


def _grid(gauge: Gauge, cutter: float, tilt: float, tolerance: float) -> tuple[Array, Array]:
    """Angles, rad, and places, mm, between which D changes by no more than the shares of the tolerance.

    `tilt`, rad, bounds the difference of a cutter's angle from the roller's that touches there.
    """
    law, radius, nearest = gauge.lifts.law, gauge.radius, NEARLY * cutter
    looks = np.unique(np.concatenate([np.linspace(0.0, TURN, LOOKS + 1), np.mod(law.breaks, TURN)]))
    mid, rad = law.enclosure(looks[:-1], looks[1:], 3)
    _, v, bend, jerk = np.abs(mid) + rad
    low, high = gauge.inner, gauge.outer
    turned = bend / low  # |a_theta|, and its derivative
    turning = jerk / low + 2.0 * bend**2 * np.minimum(v, low) / (low * (low**2 + np.minimum(v, low) ** 2))
    sine = v / np.hypot(low, v)
    speed = np.hypot(high + radius * turned, v + radius * sine * turned) + radius * sine * tilt
    across, up = radius * (turning + turned**2), bend + radius * (turning + turned**2)
    second = np.hypot(across + radius * sine + (high + 2.0 * radius * turned) * tilt, up)
    count = np.ceil(np.diff(looks) / np.sqrt(8.0 * ACROSS * tolerance / (speed**2 / nearest + second)))
    own = np.repeat(np.arange(len(count)), count.astype(np.intp))
    step = np.arange(len(own)) - np.repeat(np.cumsum(count) - count, count.astype(np.intp))
    theta = np.append(looks[own] + step * (np.diff(looks) / count)[own], TURN)
    # over rho the contact turns by S'/w^2, and that by 2 rho S'/w^4
    steep = float(v.max())
    turned_ = min(steep, low) / (low**2 + min(steep, low) ** 2)
    steep = min(steep, low / 3.0**0.5)
    turning_ = 2.0 * low * steep / (low**2 + steep**2) ** 2
    along = (radius * turned_ + tilt) ** 2 / nearest + radius * (turning_ + turned_**2)
    rows = int(np.ceil((high - low) * np.sqrt(along / (8.0 * ALONG * tolerance))))
    return theta, np.linspace(low, high, max(rows, 1) + 1)


def _nearest(points: _Points, one: Pass, turn: float, roller: float, cutter: float) -> _Met:
    """How a pass with rising angles comes to points whose angles are `turn`, rad, more."""
    shape = points.phi.shape
    phi, r, z = (points.phi + turn).ravel(), points.r.ravel(), points.z.ravel()
    start = (points.theta + turn).ravel()
    if not one.y.any():
        start = phi - (phi - start) * (cutter / roller)
    block = np.clip(np.searchsorted(one.a, start, side="right") - 1, 0, len(one.a) - 2)
    best, share = _least(one, block, phi, r, z)
    open_, way = np.arange(phi.size), np.zeros(phi.size)
    for _ in range(HOPS):
        going = np.where(share[open_] >= 1.0, 1, np.where(share[open_] <= 0.0, -1, 0))
        going[going == -way[open_]] = 0  # back again: it is nearest at their joint
        going[(block[open_] + going < 0) | (block[open_] + going > len(one.a) - 2)] = 0
        open_, going = open_[going != 0], going[going != 0]
        if not len(open_):
            break
        way[open_], block[open_] = going, block[open_] + going
        best[open_], share[open_] = _least(one, block[open_], phi[open_], r[open_], z[open_])
    # where the way bends away from a point there is a nearest place on both sides of the bend
    other = np.clip(block + np.where(share < 0.5, -1, 1), 0, len(one.a) - 2)
    square, part = _least(one, other, phi, r, z)
    nearer = square < best
    best, share, at = np.where(nearer, square, best), np.where(nearer, part, share), np.where(nearer, other, block)
    a, x, beside_ = (row[at] + share * (row[at + 1] - row[at]) for row in (one.a, one.x, one.y))
    y, v, far = r * np.sin(phi - a) - beside_, z - x, np.sqrt(best)
    y, v, far, a = (values.reshape(shape) for values in (y, v, far, a))
    tilt = np.remainder(points.theta - a + 0.5 * TURN, TURN) - 0.5 * TURN
    slopes = []
    for along, across, up in (points.by_theta, points.by_rho):
        slopes.append((y * (along * np.sin(tilt) + across * np.cos(tilt)) + v * up) / far)
    return _Met(far - cutter, points.r * np.cos(points.phi - a), tilt, np.stack(slopes))


def _least(one: Pass, block: Indices, phi: Array, r: Array, z: Array) -> tuple[Array, Array]:
    """Least square of the distance (n,) of points from the cutter's axis over a block each, and its share of it."""
    a, x, y = one.a[block], one.x[block], one.y[block]
    da, dx, dy = (row[block + 1] - row[block] for row in (one.a, one.x, one.y))
    share = np.full(len(phi), 0.5)
    for _ in range(STEPS):
        turn = phi - a - share * da
        across, along = r * np.sin(turn), r * np.cos(turn)
        beside, up = across - y - share * dy, z - x - share * dx
        rate, rise = -along * da - dy, -dx
        slope = beside * rate + up * rise
        bend = rate**2 + rise**2 - beside * across * da**2
        share = np.clip(share - slope / np.where(bend > 0.0, bend, 1.0), 0.0, 1.0)
    beside, up = r * np.sin(phi - a - share * da) - y - share * dy, z - x - share * dx
    return beside**2 + up**2, share
