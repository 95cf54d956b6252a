"""The metal as it was made: the exact contour and the smoothed deviation along its normals, and what runs on it.

Every point of the metal and its normal would put a contact at one shaft angle in one position (`Follower.touching`).
Over the parameter these pairs are a curve; where the metal is hollow beyond what the contact reaches into, it folds.
The contact rests where no metal is in its way: of all places with the same shaft angle, on the place that puts it the
farthest out. So contacts that leap over a dent are found, which no formula of first order gives.

Where the exact contour's radius of curvature jumps, a deviation that is smooth over the parameter leaves a corner, on
which the contact turns: there the pair runs over all normals between those of both sides.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import left
from kin.follower.motion_error import ContactError
from kin.numeric.angles import TURN
from kin.numeric.feet import grid
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.follower.base import Follower
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Indices

    Deviation = Callable[[Array], Array]  # of parameters (n,): deviation, mm, and its derivative (2, n)
    Skin = Callable[[Array, float], tuple[Array, Array]]
    # of parameters (n,), with so much more metal all round, mm: points, mm, and outward normals of the contour (n, 2)

COARSE = 4096  # least number of places of the turn between which contact is looked for
PER_SPAN = 12  # such places in a span of the smoothed deviation
STEPS = 12  # of the search within two places: to rounding
SETTLED = 1e-14  # rad: the search ends within this of the shaft angle
ROUNDING = 1e-12  # rad, by which neighbouring places overlap
BEFORE = 1e-12  # rad before a break of the exact contour, where its left side is evaluated
NO_BREAKS = np.zeros(0)


class Corners(NamedTuple):
    """Points (m, 2), mm, of the metal at breaks (m,) of the exact contour, outward normals before and after."""

    parameters: Array
    points: Array
    before: Array
    after: Array


class _Pieces(NamedTuple):
    """Stretches of metal between places `low` and `high` (n,), parameters in rad.

    `angle` is the shaft angle of a contact at `low`, rad, `step` the angle from there to that at `high`. `corner` is
    the index of the corner that a piece is, else -1; places of a corner run from 0 to 1, shares of the normal's turn.
    """

    low: Array
    high: Array
    corner: Indices
    angle: Array
    step: Array


def places_of(finest: int) -> Array:
    """Parameters (m,) over the turn, close enough for a curve of `finest` spans or waves a turn."""
    return grid(NO_BREAKS, max(COARSE, PER_SPAN * finest))


@dataclass(frozen=True, eq=False)
class Metal:
    """Metal over the parameter of a follower's exact contour, whose surface `skin` gives.

    `places` are parameters (m,), rising over a turn, close enough that between two of them nothing of the surface is
    lost. `gauge` is what runs on the metal: the follower itself, or a probe on its guide. `height` is by how much
    more metal there is all round, mm.
    """

    follower: Follower
    skin: Skin
    places: Array
    gauge: Follower
    height: float = 0.0

    @staticmethod
    def of(
        follower: Follower, side: Side, deviation: Deviation, finest: int = 0, gauge: Follower | None = None
    ) -> Metal:
        """Metal whose surface lies off the exact contour along its normal, by a deviation above 0 for too much metal.

        `side` is 1 for metal inside the contour, -1 outside. `deviation` of parameters (n,) is the distance, mm, and
        its derivative, (2, n). `finest` is the number of its shortest waves or spans in a turn. `gauge` runs on the
        metal, by default the follower.
        """

        def skin(parameter: Array, height: float) -> tuple[Array, Array]:
            frame = follower.envelope.frames(parameter)
            off, slope = side * (deviation(parameter) + np.array([[height], [0.0]]))
            along = frame.speed + off * frame.turn
            normal = along[:, None] * frame.normals - slope[:, None] * left(frame.normals)
            size = np.hypot(normal[:, 0], normal[:, 1])
            return frame.points + off[:, None] * frame.normals, normal / size[:, None]

        return Metal(follower, skin, places_of(finest), gauge or follower)

    def raised(self, height: float) -> Metal:
        """The metal grown by `height`, mm, all round along the normals."""
        return replace(self, height=self.height + height)

    def surface(self, parameter: Array) -> tuple[Array, Array]:
        """Points (n, 2), mm, of the metal at parameters (n,), and normals (n, 2) outward of the contour."""
        return self.skin(parameter, self.height)

    def positions(self, shaft: Array) -> tuple[Array, Array]:
        """Position of the follower with each contact resting on the metal at shaft angles (n,), and where it rests.

        Positions, mm or rad, and the parameters of the places are (c, n) for c contacts. Raises ContactError where a
        contact finds no metal.
        """
        rest = [self._resting(i, shaft) for i in range(len(self.gauge.contacts))]
        return np.stack([position for position, _ in rest]), np.stack([place for _, place in rest])

    @cached_property
    def corners(self) -> Corners:
        """Corners at the breaks of the exact contour; both normals are equal where its curvature does not jump."""
        breaks = np.mod(self.follower.envelope.breaks, TURN)
        points, after = self.surface(breaks)
        return Corners(breaks, points, self.surface(breaks - BEFORE)[1], after)

    def _within(self, place: Array, corner: Indices, contact: int) -> tuple[Array, Array]:
        """Shaft angles (n,) and positions (n,) at which a contact touches places (n,) of the metal.

        A place is a parameter, or where `corner` (n,) is 0 or more, that corner's number, the share from 0 to 1 of the
        turn of the normal there.
        """
        points, normals = self.surface(np.where(corner < 0, place, 0.0))
        at_corner = corner >= 0
        own, share = corner[at_corner], place[at_corner, None]
        points[at_corner] = self.corners.points[own]
        chord = (1.0 - share) * self.corners.before[own] + share * self.corners.after[own]
        normals[at_corner] = chord / np.hypot(chord[:, :1], chord[:, 1:])
        return self.gauge.touching(points, normals)[contact]

    def _pieces(self, contact: int) -> _Pieces:
        """Stretches of the metal between `places`, and its corners, in order, with the shaft angles of their touch.

        Places of a corner run from 0 to 1. Raises ContactError where the contact does not reach the metal.
        """
        breaks = self.corners.parameters
        near = np.mod(self.places[:, None] - breaks + 2.0 * BEFORE, TURN) < 4.0 * BEFORE
        places = self.places[~near.any(axis=1)]
        low = np.concatenate([places, np.mod(breaks - BEFORE, TURN), breaks])
        corner = np.full(len(low), -1)
        corner[len(places) : len(places) + len(breaks)] = np.arange(len(breaks))
        order = np.argsort(low, kind="stable")
        low, corner = low[order], corner[order]
        share = np.where(corner >= 0, 0.0, low)
        angle, _ = self._within(share, corner, contact)
        if not np.isfinite(angle).all():
            at = int(np.argmin(np.isfinite(angle)))
            raise ContactError("the metal is out of the follower's reach", float(low[at]))
        high = np.where(corner >= 0, 1.0, np.append(low[1:], low[0] + TURN))
        return _Pieces(share, high, corner, angle, np.mod(np.roll(angle, -1) - angle + np.pi, TURN) - np.pi)

    def _resting(self, contact: int, shaft: Array) -> tuple[Array, Array]:
        """Positions (n,) of a contact that rests on the metal, and the parameters (n,) of its places."""
        outwards = self.gauge.contacts[contact].sense  # own positions grow outwards
        # of all pieces over each shaft angle, the place at that angle
        pieces = self._pieces(contact)
        query, piece = _pairs(np.mod(shaft, TURN), pieces.angle, pieces.step)
        corner = pieces.corner[piece]
        off = np.mod(shaft[query] - pieces.angle[piece] + np.pi, TURN) - np.pi
        ends = (pieces.low[piece], pieces.high[piece])
        place = self._place(contact, shaft[query], corner, ends, (-off, pieces.step[piece] - off))
        _, position = self._within(place, corner, contact)
        place[corner >= 0] = self.corners.parameters[corner[corner >= 0]]
        # the place that puts the contact the farthest out
        best = np.full(len(shaft), -np.inf)
        np.maximum.at(best, query, outwards * position)
        if not np.isfinite(best).all():
            raise ContactError("the follower finds no metal", float(shaft[int(np.argmin(best))]))
        parameter = np.empty_like(shaft)
        won = outwards * position == best[query]
        parameter[query[won]] = place[won]
        return outwards * best, parameter

    def _place(
        self, contact: int, shaft: Array, corner: Indices, ends: tuple[Array, Array], excess: tuple[Array, Array]
    ) -> Array:
        """Places (n,) between two `ends` at which the contact stands at shaft angles (n,): Illinois' rule.

        `excess` has the shaft angles at the ends less the wanted ones, rad.
        """
        (a, b), (excess_a, excess_b) = ends, excess
        place = a
        for _ in range(STEPS):
            width = excess_b - excess_a
            place = np.where(width != 0.0, b - excess_b * (b - a) / np.where(width != 0.0, width, 1.0), a)
            angle, _ = self._within(place, corner, contact)
            middle = np.mod(angle - shaft + np.pi, TURN) - np.pi
            same = (middle > 0.0) == (excess_b > 0.0)
            a, excess_a = np.where(same, a, b), np.where(same, 0.5 * excess_a, excess_b)
            b, excess_b = place, middle
            if np.abs(middle).max(initial=0.0) < SETTLED:
                break
        return place


def _pairs(shaft: Array, angle: Array, step: Array) -> tuple[Indices, Indices]:
    """Indices of the shaft angles (n,), in [0, 2 pi), and of the pieces over which they lie, pair by pair."""
    order = np.argsort(shaft, kind="stable")
    ring = np.concatenate([shaft[order], shaft[order] + TURN])
    low = np.mod(np.minimum(angle, angle + step) - ROUNDING, TURN)
    first = np.searchsorted(ring, low, side="left")
    count = np.searchsorted(ring, low + np.abs(step) + 2.0 * ROUNDING, side="right") - first
    piece = np.repeat(np.arange(len(angle)), count)
    number = np.arange(len(piece)) - np.repeat(np.cumsum(count) - count, count)
    return order[(first[piece] + number) % len(shaft)], piece
