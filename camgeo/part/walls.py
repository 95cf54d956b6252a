"""Least walls: what is left of the metal between two edges of a part, and where.

The line of a least distance is square to the edges at both ends. Between two sampled points of an edge such a place
lies where the scalar product of the vector from the other edge's nearest point and the tangent changes its sign from
below to above 0; it is found there as a root.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.curve.curvature import roots
from kin.contour.arcs import cross, dot
from kin.contour.nearest import feet, signed_distance
from kin.numeric.lengths import UNIT, length_words, place_words

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.curve.curve import Curve, Frame
    from camgeo.part.body import Body
    from camgeo.part.shapes import Opening
    from kin.contour.arcs import Arcs
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array

LOOKS_PER_TURN = 768  # points of a contour, about, between which least distances are sought
PART_TURN = 0.1  # rad: an arc is cut into parts that turn by about this
PARTS = 12  # least number of parts of a line or an arc
SETTLED = 1e-9  # of the interval: a least distance is off by the square of this

NOWHERE = (float("inf"), float("inf"))  # place of a wall that is the same all along a face


class Gap(NamedTuple):
    """A least wall, mm, negative where edges cross or one lies on the wrong side of the other.

    `place` (x, y), mm, is on one of the edges, NOWHERE along a face; `parameter` is the contour's there, None between
    other edges.
    """

    wall: float
    place: tuple[float, float]
    parameter: float | None = None


class Pair(NamedTuple):
    """Names of two edges, and the wall between them."""

    one: str
    other: str
    gap: Gap

    def __str__(self) -> str:
        """Text with the names of the pair, its wall and the place."""
        place = "" if self.gap.place == NOWHERE else f" at {place_words(*self.gap.place, digits=4)}"
        return f"{self.one} and {self.other}: {length_words(self.gap.wall, '.4g')} {UNIT}{place}"


class Possible(NamedTuple):
    """Pair of edges whose wall is at least `at_least`, mm; `pair` computes the wall."""

    at_least: float
    pair: Callable[[], Pair]


class Looks(NamedTuple):
    """A contour in intervals (n,) of its parameter from `low` to `high`, in each of which distances are sought.

    `first` and `last` are its frames at the ends of the intervals. The metal lies inside it for `side` 1, outside for
    -1; `name` is the surface's.
    """

    contour: Curve
    low: Array
    high: Array
    first: Frame
    last: Frame
    side: Side = 1
    name: str = ""

    @staticmethod
    def of(contour: Curve, side: Side = 1, name: str = "") -> Looks:
        """Cut the cells of a contour into intervals of at most its period over LOOKS_PER_TURN."""
        cells = contour.cells
        width = cells.high - cells.low
        parts = np.maximum(np.ceil(width * (LOOKS_PER_TURN / contour.shape.period)), 1.0).astype(np.intp)
        owner = np.repeat(np.arange(parts.size), parts)
        number = np.arange(owner.size) - np.repeat(np.cumsum(parts) - parts, parts)
        low = cells.low[owner] + width[owner] * (number / parts[owner])
        last = number + 1 == parts[owner]
        high = np.where(last, cells.high[owner], np.append(low[1:], 0.0))
        return Looks(contour, low, high, *contour.span(low, high), side, name)

    def nearest(self, first: Array, last: Array) -> Array:
        """Lower bounds (n,), mm, of a distance over each interval, from those at its two ends, (n,) each.

        The distance of a point of the contour changes by no more than the way along it.
        """
        bounds = self.contour.cells.over(self.low, self.high)
        longest = np.maximum(np.abs(bounds.speed_low), np.abs(bounds.speed_high)) * (self.high - self.low)
        nearest: Array = np.minimum(first, last) - 0.5 * longest
        return nearest

    def wall_at_least(self, middle: tuple[float, float], reach: float) -> float:
        """Lower bound, mm, of the wall between the contour and anything within `reach`, mm, of `middle`.

        -inf where the ends of the intervals show no bound above 0, or `middle` does not lie on the metal's side.
        """
        first, last = (np.hypot(*(at.point - middle).T) for at in (self.first, self.last))
        wall = float(self.nearest(first, last).min()) - reach
        return wall if wall > 0.0 and winds(self.first.point - middle) is (self.side > 0) else -np.inf


def least_wall(looks: Looks, bore: float) -> tuple[float, float]:
    """Least wall in mm between a bore of this diameter about the shaft and the contour, and where (parameter).

    Negative where the bore breaks through, and where the shaft does not lie in the metal on that side of the contour.
    """
    distance, at = distance_inside(looks, (0.0, 0.0))
    return looks.side * distance - 0.5 * bore, at


def distance_inside(looks: Looks, place: tuple[float, float]) -> tuple[float, float]:
    """Distance of a point inside a contour, mm, negative outside, and the parameter of the nearest point."""
    origin = np.array(place)
    contour, low, high, first, last, *_ = looks
    # between two nodes the nearest point is where the radius meets the tangent square: its product changes sign upwards
    falls, rises = _outward(first, origin), _outward(last, origin)
    first_away, last_away = (np.hypot(*(at.point - origin).T) for at in (first, last))
    turning = (falls < 0.0) & (rises > 0.0) & ~(looks.nearest(first_away, last_away) > first_away.min())
    nearest_points = roots(
        lambda t: _outward(contour.sample(t), origin),
        low[turning],
        high[turning],
        (falls[turning], rises[turning]),
        SETTLED,
    )
    nodes = np.concatenate([low, nearest_points])
    point = np.concatenate([first.point, contour.sample(nearest_points).point]) - origin
    distance = np.hypot(point[:, 0], point[:, 1])
    nearest_node = int(np.argmin(distance))
    side = 1.0 if winds(first.point - origin) else -1.0
    return side * float(distance[nearest_node]), float(nodes[nearest_node])


def contour_gap(looks: Looks, chain: Arcs) -> Gap:
    """Least wall, mm, between a closed chain and a contour, with its place on the contour and the parameter there.

    It is negative where the chain reaches over the contour, and where it does not lie on the metal's side of it.
    """
    contour, low, high, first, last, side, _ = looks
    # each interval ends where the next begins
    distance, foot = feet(chain, np.concatenate([first.point, last.point[-1:]]))
    out = np.sign(distance)
    falls = out[:-1] * dot(first.point - foot[:-1], first.tangent)
    rises = out[1:] * dot(last.point - foot[1:], last.tangent)
    turning = (falls < 0.0) & (rises > 0.0) & ~(looks.nearest(distance[:-1], distance[1:]) > distance.min())

    def product(t: Array) -> Array:
        at = contour.sample(t)
        return _from_chain(chain, at.point, at.tangent)

    zeros = roots(product, low[turning], high[turning], (falls[turning], rises[turning]), SETTLED)
    between = contour.sample(zeros).point
    nodes, point = np.concatenate([low, zeros]), np.concatenate([first.point, between])
    distance = np.concatenate([distance[:-1], signed_distance(chain, between)])
    least = int(np.argmin(distance))
    wall = float(distance[least])
    if wall > 0.0 and winds(first.point - chain.start[0]) is (side < 0):
        wall = -wall
    return Gap(wall, _place(point[least]), float(nodes[least]))


def to_surface(opening: Opening, body: Body, surfaces: Sequence[Looks]) -> Possible:
    """The wall between an opening or a boss and the surface in whose metal it lies, or that surface's chamfer.

    Of the walls to the surfaces, that is the widest one.
    """
    edge = body.edge
    other = "chamfer" if edge else "contour"

    def pair() -> Pair:
        gaps = [(contour_gap(looks, opening.chain), looks.name) for looks in surfaces]
        gap, name = max(gaps, key=lambda row: row[0].wall)
        return Pair(opening.name, f"{name} {other}".strip(), gap._replace(wall=gap.wall - edge))

    at_least = max(looks.wall_at_least(opening.middle, opening.radius) for looks in surfaces)
    return Possible(at_least - edge, pair)


def known(name: str, other: str, gap: Gap) -> Possible:
    """Pair of named edges whose wall is known already, as a `Possible`."""
    return Possible(gap.wall, lambda: Pair(name, other, gap))


def outside_gap(chain: Arcs, other: Arcs) -> Gap:
    """Least wall, mm, between two closed chains side by side; negative where they cross or one contains the other."""
    gap = _chain_gap(chain, other, 1.0)
    held = float(signed_distance(chain, other.start[:1])[0])
    return gap if held > 0.0 else Gap(min(gap.wall, held), _place(other.start[0]))


def inside_gap(inner: Arcs, outer: Arcs) -> Gap:
    """Least wall between a closed chain and the chain about it, mm; negative where they cross or it lies outside."""
    return _chain_gap(inner, outer, -1.0)


def _chain_gap(chain: Arcs, other: Arcs, side: float) -> Gap:
    """Least signed distance, mm, of points of one chain outside (side 1) or inside (-1) the other, and its place."""
    turns = np.abs(chain.curvature) * chain.length
    parts, _ = chain.cut(np.maximum(np.ceil(turns / PART_TURN), PARTS).astype(np.intp))
    falls = side * _from_chain(other, parts.start, parts.tangent)
    rises = side * _from_chain(other, parts.ends, parts.end_tangents)
    turning = np.flatnonzero((falls < 0.0) & (rises > 0.0))

    def product(s: Array) -> Array:
        turning_parts = parts.take(turning)
        return side * _from_chain(other, turning_parts.points(s), turning_parts.tangents(s))

    zero = np.zeros(turning.size)
    feet = roots(product, zero, parts.length[turning], (falls[turning], rises[turning]), SETTLED)
    point = np.concatenate([parts.start, parts.take(turning).points(feet)])
    distance = side * signed_distance(other, point)
    least = int(np.argmin(distance))
    return Gap(float(distance[least]), _place(point[least]))


def _place(point: Array) -> tuple[float, float]:
    x, y = point.tolist()
    return x, y


def _from_chain(chain: Arcs, point: Array, tangent: Array) -> Array:
    """Rate at which the distance outside a chain grows along tangents (n, 2) at points, times that distance (n,)."""
    distance, foot = feet(chain, point)
    product: Array = np.sign(distance) * dot(point - foot, tangent)
    return product


def winds(ring: Array) -> bool:
    """Whether a closed ring of points (n, 2) runs round the origin."""
    around = np.append(ring, ring[:1], axis=0)
    turned = np.arctan2(cross(around[:-1], around[1:]), dot(around[:-1], around[1:]))
    return abs(float(turned.sum())) > np.pi


def _outward(frame: Frame, origin: Array) -> Array:
    """Distance from the origin times the rate at which it grows along the curve (n,)."""
    return dot(frame.point - origin, frame.tangent)
