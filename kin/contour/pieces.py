"""Lines, circular arcs and Bezier pieces of one drawing, held as arrays: made, taken apart, reversed, moved."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import unit
from kin.contour.bezier import Beziers
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices

__all__ = ["ARC", "BEZIER", "LINE", "TURN", "NormalRanges", "Pieces", "wrapped"]

LINE, ARC, BEZIER = 0, 1, 2

# An arc with a bulge below this is off its chord by less than the rounding of the chord's length.
STRAIGHT_BULGE = 1e-18


class NormalRanges(NamedTuple):
    """Curved pieces (c,) as indices, and the angles of the normals at which each can be the farthest.

    They run counter-clockwise from `low` (c,) in [0, 2 pi) over `width` (c,), rad. Each normal in the range belongs to
    one point of the piece.
    """

    piece: Indices
    low: Array
    width: Array


@dataclass(frozen=True, eq=False)
class Pieces:
    """n pieces, each from start[i] to end[i], in mm.

    kind (n,)       LINE, ARC or BEZIER
    start, end      (n, 2)
    centre          (n, 2), radius (n,), angle (n,) polar angle of the start seen from the centre, sweep (n,) signed,
                    |sweep| <= 2 pi: of the arcs; zero elsewhere
    curve (n,)      row of a Bezier piece in `beziers`; -1 elsewhere
    beziers         the Bezier pieces, each turning one way by less than pi
    """

    kind: NDArray[np.uint8]
    start: Array
    end: Array
    centre: Array
    radius: Array
    angle: Array
    sweep: Array
    curve: Indices
    beziers: Beziers

    @staticmethod
    def from_chords(start: Array, end: Array, bulge: Array) -> Pieces:
        """Lines and arcs from start (n, 2) to end (n, 2) with bulges (n,), bulge = tan(sweep/4), zero for a line."""
        n = start.shape[0]
        arc = np.abs(bulge) > STRAIGHT_BULGE
        b = np.where(arc, bulge, 1.0)
        chord = end - start
        length = np.hypot(chord[:, 0], chord[:, 1])
        across = np.stack([-chord[:, 1], chord[:, 0]], axis=1)
        centre = (start + end) / 2.0 + across * ((1.0 - b * b) / (4.0 * b))[:, None]
        sweep = 4.0 * np.arctan(bulge)
        # By way of the chord, not of the centre, which may be far away.
        angle = np.arctan2(chord[:, 1], chord[:, 0]) - sweep / 2.0 - np.copysign(np.pi / 2.0, bulge)
        return Pieces(
            kind=np.where(arc, ARC, LINE).astype(np.uint8),
            start=start,
            end=end,
            centre=np.where(arc[:, None], centre, 0.0),
            radius=np.where(arc, length * (1.0 + b * b) / (4.0 * np.abs(b)), 0.0),
            angle=np.where(arc, angle, 0.0),
            sweep=np.where(arc, sweep, 0.0),
            curve=np.full(n, -1, dtype=np.intp),
            beziers=Beziers.empty(),
        )

    @staticmethod
    def from_arcs(centre: Array, radius: Array, angle: Array, sweep: Array) -> Pieces:
        """Arcs about centres (n, 2) with radii (n,), polar angles (n,) of the starts, and signed sweeps (n,), rad."""
        n = radius.size
        return Pieces(
            kind=np.full(n, ARC, dtype=np.uint8),
            start=centre + radius[:, None] * unit(angle),
            end=centre + radius[:, None] * unit(angle + sweep),
            centre=centre,
            radius=radius,
            angle=angle,
            sweep=sweep,
            curve=np.full(n, -1, dtype=np.intp),
            beziers=Beziers.empty(),
        )

    @staticmethod
    def from_unrolled(pieces: Beziers) -> Pieces:
        """Bezier pieces that each turn one way by less than pi, as `Beziers.unrolled` leaves them."""
        n = pieces.count
        return Pieces(
            kind=np.full(n, BEZIER, dtype=np.uint8),
            start=pieces.control[:, 0].copy(),
            end=pieces.control[:, -1].copy(),
            centre=np.zeros((n, 2)),
            radius=np.zeros(n),
            angle=np.zeros(n),
            sweep=np.zeros(n),
            curve=np.arange(n),
            beziers=pieces,
        )

    @staticmethod
    def joined(parts: list[Pieces]) -> Pieces:
        """All pieces of `parts`, one part at least, in order."""
        if len(parts) == 1:
            return parts[0]
        offsets = np.cumsum([0] + [p.beziers.count for p in parts[:-1]])
        return Pieces(
            kind=np.concatenate([p.kind for p in parts]),
            start=np.concatenate([p.start for p in parts]),
            end=np.concatenate([p.end for p in parts]),
            centre=np.concatenate([p.centre for p in parts]),
            radius=np.concatenate([p.radius for p in parts]),
            angle=np.concatenate([p.angle for p in parts]),
            sweep=np.concatenate([p.sweep for p in parts]),
            curve=np.concatenate([np.where(p.curve < 0, -1, p.curve + o) for p, o in zip(parts, offsets, strict=True)]),
            beziers=Beziers.joined([p.beziers for p in parts]),
        )

    def __len__(self) -> int:
        return len(self.kind)

    def take(self, index: Indices | NDArray[np.bool_]) -> Pieces:
        """Return the pieces chosen by index or mask, in that order."""
        curve = self.curve[index]
        bows = curve >= 0
        return Pieces(
            kind=self.kind[index],
            start=self.start[index],
            end=self.end[index],
            centre=self.centre[index],
            radius=self.radius[index],
            angle=self.angle[index],
            sweep=self.sweep[index],
            curve=np.where(bows, np.cumsum(bows) - 1, -1),
            beziers=self.beziers.take(curve[bows]) if self.beziers.count else self.beziers,
        )

    def turned_round(self, which: NDArray[np.bool_] | None = None) -> Pieces:
        """Return the same pieces in the same order, those of the mask (n,), by default all, run through backwards."""
        w = np.ones(len(self), dtype=bool) if which is None else which
        beziers = self.beziers
        if beziers.count:
            back = np.zeros(beziers.count, dtype=bool)
            back[self.curve[w & (self.curve >= 0)]] = True
            beziers = beziers.turned_round(back)
        return Pieces(
            kind=self.kind,
            start=np.where(w[:, None], self.end, self.start),
            end=np.where(w[:, None], self.start, self.end),
            centre=self.centre,
            radius=self.radius,
            angle=np.where(w, self.angle + self.sweep, self.angle),
            sweep=np.where(w, -self.sweep, self.sweep),
            curve=self.curve,
            beziers=beziers,
        )

    def reflected(self) -> Pieces:
        """Return the mirror image in the x axis, each piece still from its start to its end."""
        flip = np.array([1.0, -1.0])
        return self._mapped(lambda points: points * flip, self.radius, -self.angle, -self.sweep)

    def enlarged(self, factor: float) -> Pieces:
        """Return the pieces scaled about the origin by a positive factor."""
        return self._mapped(lambda points: points * factor, self.radius * factor, self.angle, self.sweep)

    def shifted(self, x: float, y: float) -> Pieces:
        """Return the pieces moved by a distance along x and along y, mm."""
        by = np.array([x, y])
        return replace(
            self,
            start=self.start + by,
            end=self.end + by,
            centre=np.where((self.kind == ARC)[:, None], self.centre + by, 0.0),
            beziers=Beziers(self.beziers.control + by, self.beziers.weight),
        )

    def rotated(self, angle: float) -> Pieces:
        """Return the pieces turned counter-clockwise about the origin by an angle, rad."""
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        return self._mapped(lambda points: points @ turn, self.radius, self.angle + angle, self.sweep)

    def _mapped(self, moved: Callable[[Array], Array], radius: Array, angle: Array, sweep: Array) -> Pieces:
        """The pieces under a map of points (..., 2) that leaves the origin where it is, their arcs as given."""
        start, end, centre = moved(self.start), moved(self.end), moved(self.centre)
        beziers = Beziers(moved(self.beziers.control), self.beziers.weight)
        return Pieces(self.kind, start, end, centre, radius, angle, sweep, self.curve, beziers)

    @cached_property
    def directions(self) -> tuple[Array, Array]:
        """Angles of the tangents at the starts (n,) and at the ends (n,), rad."""
        chord = self.end - self.start
        first = np.arctan2(chord[:, 1], chord[:, 0])
        last = first.copy()
        arc = self.kind == ARC
        first[arc] = self.angle[arc] + np.copysign(np.pi / 2.0, self.sweep[arc])
        last[arc] = first[arc] + self.sweep[arc]
        bow = self.kind == BEZIER
        if bow.any():
            begin, finish = self.beziers.directions
            first[bow], last[bow] = begin[self.curve[bow]], finish[self.curve[bow]]
        return first, last

    @cached_property
    def turns(self) -> Array:
        """Turn of the tangent (n,), rad, along each piece, counter-clockwise positive."""
        first, last = self.directions
        return np.where(self.kind == ARC, self.sweep, wrapped(last - first))

    @cached_property
    def lengths(self) -> Array:
        """Arc length of each piece, mm (n,): closed forms, Gauss's rule on Bezier pieces."""
        out = np.hypot(*(self.end - self.start).T)
        arc = self.kind == ARC
        out[arc] = self.radius[arc] * np.abs(self.sweep[arc])
        bow = self.kind == BEZIER
        if bow.any():
            out[bow] = self.beziers.lengths[self.curve[bow]]
        lengths: Array = out
        return lengths

    @cached_property
    def normal_ranges(self) -> NormalRanges:
        """Ranges of normals over which each curved piece can be the farthest."""
        curved = np.flatnonzero(self.kind != LINE)
        first, last = (d[curved] for d in self.directions)
        turn = self.turns[curved]
        # A piece that turns left bulges to the right of its tangents, one that turns right to their left.
        low = np.where(turn >= 0.0, first - np.pi / 2.0, last + np.pi / 2.0)
        low = np.mod(low, TURN)
        low[low >= TURN] = 0.0
        return NormalRanges(curved, low, np.abs(turn))

    def arc_points(self, pieces: Indices, turn: Array) -> Array:
        """Points (k, 2) of the arcs `pieces` (k,), `turn` (k,) rad counter-clockwise from their starts."""
        half = turn / 2.0
        middle = self.angle[pieces] + half
        along = np.stack([-np.sin(middle), np.cos(middle)], axis=1)
        points: Array = self.start[pieces] + (2.0 * self.radius[pieces] * np.sin(half))[:, None] * along
        return points

    def points(self, pieces: Indices, share: Array) -> Array:
        """Points (k, 2) on `pieces` (k,), at shares (k,) in [0, 1] of their lengths, or of Bezier parameters."""
        start, end = self.start[pieces], self.end[pieces]
        x = start + share[:, None] * (end - start)
        kind = self.kind[pieces]
        arc, bow = kind == ARC, kind == BEZIER
        x[arc] = self.arc_points(pieces[arc], share[arc] * self.sweep[pieces[arc]])
        if bow.any():
            x[bow] = self.beziers.point(self.curve[pieces[bow]], share[bow])
        x[share == 1.0] = end[share == 1.0]
        return x


def wrapped(angle: Array) -> Array:
    """Angles, rad, of any shape, brought to [-pi, pi) by whole turns."""
    return np.mod(angle + np.pi, TURN) - np.pi
