"""The contour of a file under a touch: corners and points so close along every piece that those between bound no more.

Each point bounds the touch alone. Coming from outside it is stopped by the one that holds it farthest out; in the
opening of a ring, from within, by the one that holds it nearest the shaft.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.budget.contact import LostError
from kin.law.contacts import Flat, Oscillating
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.contour.contour import Contour
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.numeric.arrays import Array, Complexes, Indices

ACCURACY = 1e-6  # mm: what a touch would sink between two points
FEWEST = 8  # points on either side of the place of contact that are looked at, at least
MOST_POINTS = 2_000_000  # of a contour


def points_of(contour: Contour, radius: float) -> Complexes:
    """Points along a contour (k,), complex, mm, every corner among them, for a touch of a radius, infinite of a face.

    Raises LostError where that takes more than two million points.
    """
    arcs, _ = contour.as_arcs(0.1 * ACCURACY)
    apart = np.sqrt(8.0 * ACCURACY / (1.0 / radius + np.abs(arcs.curvature) + 1e-12))
    parts = np.ceil(arcs.length / apart)
    # a line bounds nothing between its ends but by a round touch
    parts = (
        np.maximum(parts, 1.0) if np.isfinite(radius) else np.where(arcs.curvature == 0.0, 1.0, np.maximum(parts, 1.0))
    )
    if parts.sum() > MOST_POINTS:
        raise LostError("the contour is too long, or bends too much, for parts to be simulated on it")
    fine, _ = arcs.cut(parts.astype(np.intp))
    points: Complexes = fine.start[:, 0] + 1j * fine.start[:, 1]
    return points


def read_metal(
    contact: Contact[Guide, Touch], side: Side, contour: Contour, meant: Complexes, wander: float
) -> ReadMetal:
    """The metal of a file's contour under a contact; raises LostError for a knife edge, which falls between points."""
    if isinstance(contact.touch, Flat):
        radius = np.inf
    elif contact.touch.radius > 0.0:
        radius = contact.touch.radius
    else:
        raise LostError("a knife edge is simulated on the exact contour alone: leave the file out")
    hand = contact.guide.side if isinstance(contact.guide, Oscillating) else 1
    return ReadMetal(points_of(contour, radius), side, hand, meant, wander)


@dataclass(frozen=True, eq=False)
class ReadMetal:
    """Points (k,) of a contour in order, at shaft angles (n,), at which it is meant to be touched near `meant` (n,).

    The metal lies on its `side`; `hand` is the side of an arm. `wander` is how far along the contour a contact is
    looked for at first, mm: farther where it is found at an end of that.
    """

    points: Complexes
    side: Side
    hand: Side
    meant: Complexes
    wander: float

    @cached_property
    def _at(self) -> Indices:
        """Index of the point nearest to each place."""
        return np.array([int(np.abs(self.points - place).argmin()) for place in self.meant])

    def reach(self, normal: Complexes) -> Array:
        """See `Metal`."""

        def bound(points: Complexes, n: Complexes) -> Array:
            bound: Array = (np.conj(n) * points).real
            return bound

        return self._held(bound, (normal,))

    def along(self, way: Complexes, middle: Complexes, radius: Array) -> Array:
        """See `Metal`."""

        def bound(points: Complexes, d: Complexes, m: Complexes, r: Complexes) -> Array:
            off = np.conj(d) * (points - m)
            with np.errstate(invalid="ignore"):
                bound: Array = off.real + self.side * np.sqrt(r.real**2 - off.imag**2)
            return bound

        return self._held(bound, (way, middle, _complex(radius)))

    def arm(self, pivot: Complexes, length: Array, radius: Array) -> Complexes:
        """See `Metal`."""

        def bound(points: Complexes, a: Complexes, arm: Complexes, r: Complexes, start: Complexes) -> Array:
            distance = np.abs(points - a)
            with np.errstate(invalid="ignore"):
                opening = np.arccos((distance**2 + arm.real**2 - r.real**2) / (2.0 * distance * arm.real))
            bound: Array = self.hand * np.angle((points - a) * np.conj(start)) + self.side * opening
            return bound

        start = self._toward(pivot)
        turn = self._held(bound, (pivot, _complex(length), _complex(radius), start))
        arm: Complexes = start * np.exp(1j * self.hand * turn)
        return arm

    def leaning(self, pivot: Complexes, nearer: Array) -> Complexes:
        """See `Metal`."""

        def bound(points: Complexes, a: Complexes, f: Complexes, start: Complexes) -> Array:
            opening = np.arccos(-f.real / np.abs(points - a))
            bound: Array = self.hand * np.angle((points - a) * np.conj(start)) + opening
            return bound

        start = self._toward(pivot)
        turn = self._held(bound, (pivot, _complex(nearer), start))
        normal: Complexes = start * np.exp(1j * self.hand * turn)
        return normal

    def _toward(self, pivot: Complexes) -> Complexes:
        """Direction from a pivot to the place of contact."""
        arm = self.meant - pivot
        toward: Complexes = arm / np.abs(arm)
        return toward

    def _held(self, bound: Callable[..., Array], rows: tuple[Complexes, ...]) -> Array:
        """What holds the touch, (parts, angles): the greatest bound by the points, or the least from within."""
        shape = np.broadcast_shapes(*(row.shape for row in rows), self.meant.shape)
        rows = tuple(np.broadcast_to(row, shape) for row in rows)
        held = np.empty(shape)
        for angle, place in enumerate(self._at):
            held[:, angle] = self._nearby(bound, [row[:, angle, None] for row in rows], int(place))
        return held

    def _nearby(self, bound: Callable[..., Array], rows: list[Complexes], place: int) -> Array:
        count = len(self.points)
        few = self._few(place)
        while True:
            within = np.arange(place - few, place + few + 1) if 2 * few + 1 < count else np.arange(count)
            bounds = self.side * bound(self.points[within % count], *rows)
            best = np.where(np.isnan(bounds), -np.inf, bounds)
            found = best.argmax(axis=1)
            if len(within) == count or ((found > 0) & (found < len(within) - 1)).all():
                break
            few *= 4
        if not np.isfinite(best.max(axis=1)).all():
            raise LostError("a made part has no contact near where it is meant to be")
        held: Array = self.side * best.max(axis=1)
        return held

    def _few(self, place: int) -> int:
        """How many points stand within the way that a contact is looked for, on the side where they are closer."""
        count = len(self.points)
        few = FEWEST
        while 2 * few + 1 < count:
            ends = self.points[[(place - few) % count, (place + few) % count]]
            if np.abs(ends - self.points[place]).min() >= self.wander:
                break
            few *= 2
        return few


def _complex(row: Array) -> Complexes:
    numbers: Complexes = row.astype(np.complex128)
    return numbers
