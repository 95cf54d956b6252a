"""Contact of a touch with the contour of a file, by points so close together that the curve between them adds nothing.

Points, normals and directions are complex numbers, x + iy, in the cam's axes, mm. All corners are among the points, and
each point bounds the position of the touch by itself. A touch that comes from outside is stopped by the point that
holds it farthest out; in the opening of a ring, where it comes from within, by the point that holds it nearest the
shaft. A knife edge would fall between points: the chords hold it.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.budget.contact import LostError
from kin.law.contacts import Flat, Oscillating
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from kin.contour.contour import Contour
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.numeric.arrays import Array, Complexes, Indices

ACCURACY = 1e-6  # mm: depth to which a touch may sink into the metal between two points
FEWEST = 8  # points on either side of the place of contact that are looked at, at least
MOST_POINTS = 2_000_000  # of a contour, which bounds memory


def points_of(contour: Contour, radius: float) -> Complexes:
    """Points (k,) along a contour in order, mm, with every corner.

    `radius` is that of the touch, mm, infinite for a flat face; for a knife edge it is that of its path. Raises
    LostError where more than two million points are needed.
    """
    arcs, _ = contour.as_arcs(0.1 * ACCURACY)
    # sag between points d apart: d^2/8 times the sum of the curvatures of touch and contour
    apart = np.sqrt(8.0 * ACCURACY / (1.0 / radius + np.abs(arcs.curvature) + 1e-12))
    parts = np.ceil(arcs.length / apart)
    # between the ends of a straight line no point holds a flat face farther out
    parts = (
        np.maximum(parts, 1.0) if np.isfinite(radius) else np.where(arcs.curvature == 0.0, 1.0, np.maximum(parts, 1.0))
    )
    if parts.sum() > MOST_POINTS:
        raise LostError("the contour is too long, or bends too much, for parts to be simulated on it")
    fine, _ = arcs.cut(parts.astype(np.intp))
    points: Complexes = fine.start[:, 0] + 1j * fine.start[:, 1]
    return points


def read_metal(
    contact: Contact[Guide, Touch], side: Side, contour: Contour, intended: Complexes, wander: float
) -> ReadMetal:
    """The metal of a contour under a contact, as points: EdgeMetal for a knife edge, else ReadMetal.

    `side` is 1 for metal inside the contour, -1 outside. `intended` (n,) are the intended points of contact, mm, and
    `wander` is how far from them contacts are looked for at first, mm. Raises LostError where the contour takes more
    than two million points.
    """
    guide, touch = contact.guide, contact.touch
    hand = guide.side if isinstance(guide, Oscillating) else 1
    flat = isinstance(touch, Flat)
    if flat or touch.radius > 0.0:
        return ReadMetal(points_of(contour, np.inf if flat else touch.radius), side, hand, intended, wander)
    # the path of a knife edge is a line, or a circle about the pivot
    path = guide.arm if isinstance(guide, Oscillating) else np.inf
    return EdgeMetal(points_of(contour, path), side, hand, intended, wander)


@dataclass(frozen=True, eq=False)
class ReadMetal:
    """Metal of a file as points (k,) along its contour, under a touch that should bear near `intended` (n,).

    `side` is 1 for metal inside the contour, -1 outside; `hand` is the side of an arm's guide, 1 for a stem. `wander`
    is the distance from the intended point, mm, within which a contact is looked for at first; the search is widened
    while the point that holds the touch is the first or the last of those looked at.
    """

    points: Complexes
    side: Side
    hand: Side
    intended: Complexes
    wander: float

    def reach(self, normal: Complexes) -> Array:
        """Distance from the shaft to a flat face on the metal along its unit `normal`, mm, (parts, angles)."""

        def bound(within: Indices, n: Complexes) -> Array:
            bound: Array = (np.conj(n) * self.points[within]).real
            return bound

        return self._held(bound, (normal,))

    def along(self, way: Complexes, middle: Complexes, radius: Array) -> Array:
        """Distance from `middle` along the unit direction `way` to the centre of a round touch, mm, (parts, angles).

        Raises LostError where the touch meets no point near the contact.
        """

        def bound(within: Indices, d: Complexes, m: Complexes, r: Array) -> Array:
            off = np.conj(d) * (self.points[within] - m)
            with np.errstate(invalid="ignore"):
                bound: Array = off.real + self.side * np.sqrt(r**2 - off.imag**2)
            return bound

        return self._held(bound, (way, middle, radius))

    def arm(self, pivot: Complexes, length: Array, radius: Array) -> Complexes:
        """Unit direction from a pivot to the centre of a round touch on the metal, (parts, angles).

        `length` is that of the arm, `radius` that of the touch, mm. Raises LostError where the touch meets no point
        near the contact.
        """

        def bound(within: Indices, a: Complexes, arm: Array, r: Array, start: Complexes) -> Array:
            # cosine rule in the triangle of pivot, point and centre of the touch
            distance = np.abs(self.points[within] - a)
            with np.errstate(invalid="ignore"):
                opening = np.arccos((distance**2 + arm**2 - r**2) / (2.0 * distance * arm))
            bound: Array = self._turn(self.points[within], a, start) + self.side * opening
            return bound

        return self._swung(bound, pivot, length, radius)

    def face_normal(self, pivot: Complexes, nearer: Array) -> Complexes:
        """Outward unit normal of a flat face on an arm that touches the metal, (parts, angles).

        The face is `nearer` mm nearer the shaft than its parallel through the pivot. Raises LostError where no point
        near the contact can touch it.
        """

        def bound(within: Indices, axis: Complexes, near: Array, start: Complexes) -> Array:
            # angle at the pivot between a point and the normal of the face through it
            opening = np.arccos(-near / np.abs(self.points[within] - axis))
            return self._turn(self.points[within], axis, start) + opening

        return self._swung(bound, pivot, nearer)

    def _turn(self, points: Complexes, pivot: Complexes, start: Complexes) -> Array:
        """Angles, rad, from the direction `start` to the points, seen from a pivot, above 0 away from the shaft."""
        turn: Array = self.hand * np.angle((points - pivot) * np.conj(start))
        return turn

    def _swung(self, bound: Callable[..., Array], pivot: Complexes, *sizes: Array) -> Complexes:
        """Unit direction (parts, angles) that a swinging touch has on the metal.

        It is the direction from a pivot to the intended contact, turned by the greatest angle that a point bounds.
        """
        start = (self.intended - pivot) / np.abs(self.intended - pivot)
        swung: Complexes = start * np.exp(1j * self.hand * self._held(bound, (pivot, *sizes, start)))
        return swung

    def _held(self, bound: Callable[..., Array], rows: Sequence[NDArray[Any]]) -> Array:
        """Position (parts, angles) at which the touch bears: the greatest bound by a point, or the least in a ring.

        `bound` takes indices of k points and the `rows` at one angle, (parts, 1) each. It returns the position at which
        each point holds the touch, (parts, k), nan where the point cannot touch it.
        """
        shape = np.broadcast_shapes(*(row.shape for row in rows), self.intended.shape)
        whole = [np.broadcast_to(row, shape) for row in rows]
        held = np.empty(shape)
        for angle, intended in enumerate(self.intended):
            held[:, angle] = self._nearby(bound, [row[:, angle, None] for row in whole], intended)
        return held

    def _nearby(self, bound: Callable[..., Array], rows: Sequence[NDArray[Any]], intended: complex) -> Array:
        """Position (parts,) at which the touch bears at one angle, from `rows` (parts, 1); raises LostError."""
        count, distances = len(self.points), np.abs(self.points - intended)
        place = int(distances.argmin())
        few = self._few(place, self.wander + 2.0 * float(distances[place]))
        while True:
            within = np.arange(place - few, place + few + 1) if 2 * few + 1 < count else np.arange(count)
            bounds = self.side * bound(within % count, *rows)
            best = np.where(np.isnan(bounds), -np.inf, bounds)
            holding = best.argmax(axis=1)
            if len(within) == count or ((holding > 0) & (holding < len(within) - 1)).all():
                break
            few *= 4
        if not np.isfinite(best.max(axis=1)).all():
            raise LostError("a made part has no contact near where it is meant to be")
        held: Array = self.side * best.max(axis=1)
        return held

    def _few(self, place: int, wander: float) -> int:
        """Number of points on either side of the index `place` whose last ones are both `wander` mm off or farther.

        It is FEWEST times a power of 2; where that reaches all points, these are all looked at.
        """
        count = len(self.points)
        few = FEWEST
        while 2 * few + 1 < count:
            ends = self.points[[(place - few) % count, (place + few) % count]]
            if np.abs(ends - self.points[place]).min() >= wander:
                break
            few *= 2
        return few


@dataclass(frozen=True, eq=False)
class EdgeMetal(ReadMetal):
    """Metal of a file under a knife edge, which touches where its path crosses a chord between two points.

    The `radius` in its methods is how far the metal has grown along its normals, mm.
    """

    @cached_property
    def _normals(self) -> Complexes:
        """Unit normals (k,) out of the metal at the points, bisecting those of the two chords that meet there."""
        chords = np.roll(self.points, -1) - self.points
        tangents = chords / np.abs(chords)
        tangents = tangents + np.roll(tangents, 1)
        normals: Complexes = -1j * self.side * tangents / np.abs(tangents)
        return normals

    def along(self, way: Complexes, middle: Complexes, radius: Array) -> Array:
        """Distance from `middle` along the unit direction `way` to the knife edge, mm, (parts, angles).

        `radius` is how far the metal has grown along its normals, mm. Raises LostError where the path of the edge
        crosses no chord near the contact.
        """

        def bound(within: Indices, d: Complexes, m: Complexes, r: Array) -> Array:
            first, second = (np.conj(d) * (end - m) for end in self._chords(within, r))
            return _crossings(first.imag, second.imag, first.real, second.real)

        return self._held(bound, (way, middle, radius))

    def arm(self, pivot: Complexes, length: Array, radius: Array) -> Complexes:
        """Unit direction from a pivot to the knife edge, (parts, angles).

        `length` is that of the arm, `radius` how far the metal has grown along its normals, mm. Raises LostError where
        the path of the edge crosses no chord near the contact.
        """

        def bound(within: Indices, a: Complexes, arm: Array, r: Array, start: Complexes) -> Array:
            first, second = self._chords(within, r)
            turns = (self._turn(end, a, start) for end in (first, second))
            return _crossings(np.abs(first - a) - arm, np.abs(second - a) - arm, *turns)

        return self._swung(bound, pivot, length, radius)

    def _chords(self, within: Indices, grown: Array) -> tuple[Complexes, Complexes]:
        """Both ends (parts, k) of the chords that begin at k points, of metal that has grown by `grown` (parts, 1)."""
        first, second = (self.points[i] + grown * self._normals[i] for i in (within, (within + 1) % len(self.points)))
        return first, second


def _crossings(first_off: Array, second_off: Array, first: Array, second: Array) -> Array:
    """Values (parts, k) interpolated on chords where the path crosses them; nan for chords that it does not cross.

    `first_off` and `second_off` are the signed distances of a chord's ends from the path, `first` and `second` the
    values at these ends.
    """
    crosses = (first_off > 0.0) != (second_off > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        values: Array = np.where(crosses, first + first_off / (first_off - second_off) * (second - first), np.nan)
    return values
