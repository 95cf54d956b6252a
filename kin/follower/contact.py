"""First contact of a guided roller (`kin.follower.guide`) with the contour as it lies in a file.

The roller's centre may not come closer than its radius to any point of the contour: it stays outside the dilated
contour, whose pieces are the contour's own moved outward, and arcs of the roller's radius about convex corners. At a
shaft angle the centre runs on a circle about the pivot, or on a line; a point at polar coordinates (r, t) is reached
from exactly one shaft angle, for an arm

    phi = t + acos((r^2 + L^2 - l^2)/(2 r L))   roller A, which trails the pivot;   minus for roller B, which leads it

(L from shaft to pivot, l arm). So each piece covers an interval of shaft angles, found by sorting, and each pair of
piece and angle is one intersection in closed form. The first contact from outside is that of largest r; in the opening
of a ring, from within, that of least r, and the guide counts its position inwards, away from the metal as ever.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import cross, dot, left
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.contour.arcs import Arcs
    from kin.follower.guide import Guide
    from kin.numeric.arrays import Array, Indices

MOST_TURN = np.pi / 8.0  # pieces are cut until each turns less
WIDER = 1e3  # times the slack, for a second search where the first meets nothing
PAIRS_AT_ONCE = 1_000_000  # of piece and angle: bounds the memory that a hostile contour takes


def shortened(obstacle: Arcs, guide: Guide) -> tuple[Arcs, Indices]:
    """The obstacle cut into pieces short enough for the search, in order; index (k,) of the piece each is part of."""
    step = guide.step(extent(obstacle))
    parts = np.maximum(
        np.ceil(np.abs(obstacle.curvature) * obstacle.length / MOST_TURN), np.ceil(obstacle.length / step)
    )
    return obstacle.cut(np.maximum(parts, 1.0).astype(np.intp))


def extent(pieces: Arcs) -> float:
    """Greatest absolute coordinate of the pieces' starts, mm."""
    return float(np.abs(pieces.start).max())


@dataclass(frozen=True, eq=False)
class Search:
    """An obstacle made ready for searches at any shaft angles: pieces that the centre can meet, and from which angles.

    `obstacle` is the dilated contour, `pieces` are k short parts of it within reach, `owner` (k,) is the index of the
    obstacle's piece that each is part of. A part is met from shaft angles of `low` to `low` + `width` (k,), rad.
    `slack`, mm, allows for rounding at the joints: `share` times the guide's own slack.
    """

    obstacle: Arcs
    guide: Guide
    share: float
    slack: float
    pieces: Arcs
    owner: Indices
    low: Array
    width: Array

    @staticmethod
    def of(obstacle: Arcs, guide: Guide, share: float = 1.0) -> Search:
        """Prepare the search for first contacts on an obstacle, with `share` times the guide's slack.

        The cost grows with the number of pieces.
        """
        slack = share * guide.slack(extent(obstacle))
        pieces, owner = shortened(obstacle, guide)
        within = within_reach(pieces, guide, slack)
        pieces, owner = pieces.take(within), owner[within]
        middle, reach = angles_of(pieces, guide, slack)
        low = np.mod(middle - reach, 2.0 * np.pi)
        return Search(obstacle, guide, share, slack, pieces, owner, low, 2.0 * reach)

    def first(self, phi: Array) -> tuple[Array, Indices]:
        """Find where the centre, coming from outside, first meets the obstacle at shaft angles phi (n,), rad.

        From within if the guide counts inwards. Returns the distance r (n,) from the shaft, mm, and the index (n,) of
        the obstacle's piece: nan and -1 where nothing is met. Cost: one sort of phi, and the pairs of piece and angle
        that can meet. Where nothing is met, as by rounding at the joints of walls along the centre's own path, the
        slack is widened.
        """
        turn, guide = 2.0 * np.pi, self.guide
        order = np.argsort(np.mod(phi, turn), kind="stable")
        angle = np.mod(phi, turn)[order]
        # over two turns of rising angles, those that meet a piece are one run: its first place and its count
        ring = np.concatenate([angle, angle + turn])
        first = np.searchsorted(ring, self.low, side="left")
        count = np.minimum(np.searchsorted(ring, self.low + self.width, side="right") - first, len(angle))
        best = np.full(len(angle), -np.inf)
        met = np.full(len(angle), -1)
        total = np.cumsum(count)
        begin = 0
        while begin < len(self.pieces):
            # as many pieces at a time as make PAIRS_AT_ONCE pairs
            end = max(begin + 1, int(np.searchsorted(total, total[begin] - count[begin] + PAIRS_AT_ONCE, side="right")))
            chosen = np.arange(begin, end)
            piece = np.repeat(chosen, count[chosen])
            number = np.arange(len(piece)) - np.repeat(np.cumsum(count[chosen]) - count[chosen], count[chosen])
            index = (first[piece] + number) % len(angle)
            # the piece that reaches highest so far is met; a height of 0 is the shaft itself
            height = meet(self.pieces.take(piece), guide, angle[index], self.slack)
            np.maximum.at(best, index, height)
            won = (height == best[index]) & np.isfinite(height) & (height != 0.0)
            met[index[won]] = piece[won]
            begin = end
        radius, piece_met = np.full(len(angle), np.nan), np.full(len(angle), -1)
        touched = met >= 0
        radius[order[touched]] = guide.away * best[touched]
        piece_met[order[touched]] = self.owner[met[touched]]
        # misses by rounding are searched for once more, with a wider slack
        missed = np.flatnonzero(piece_met < 0)
        if self.share < WIDER and len(missed):
            radius[missed], piece_met[missed] = Search.of(self.obstacle, guide, WIDER).first(phi[missed])
        return radius, piece_met


def within_reach(pieces: Arcs, guide: Guide, slack: float) -> NDArray[np.bool_]:
    """Mask (n,) of the short pieces of which some point may lie as far from the shaft as the roller's centre can.

    `slack`, mm, widens the distances of each piece against rounding.
    """
    nearest, farthest = _distances(pieces, slack)
    least, most = guide.reach()
    within: NDArray[np.bool_] = (farthest >= least) & (nearest <= most)
    return within


def angles_of(pieces: Arcs, guide: Guide, slack: float) -> tuple[Array, Array]:
    """Middle and half-width, rad, (n,) each, of an interval of all shaft angles from which each short piece is reached.

    `slack`, mm, lengthens the pieces against rounding.
    """
    middle = pieces.points(0.5 * pieces.length)
    r = np.hypot(middle[:, 0], middle[:, 1])
    half = 0.5 * pieces.length + slack
    least, most = _distances(pieces, slack)
    lead = guide.lead(r)
    with np.errstate(over="ignore"):
        # phi = t - lead(r): t changes by at most 1/r per mm, the lead by its steepest slope
        reach = half * np.hypot(1.0 / least, guide.lead_slope(least, most))
        # at an end of the travel the lead is infinitely steep, and yet changes by no more than between its extremes
        ends = [guide.lead(x) - lead for x in (least, most, np.clip(guide.turning, least, most))]
        reach = np.fmin(reach, half / least + np.abs(ends).max(axis=0))
    angle = np.arctan2(middle[:, 1], middle[:, 0]) - lead
    return angle, np.fmin(reach, np.pi)


def _distances(pieces: Arcs, slack: float) -> tuple[Array, Array]:
    """Bounds of the distance from the shaft over each short piece, mm: (n,) each, the first above 0.

    No point is farther from the middle than half the length. Nor does the distance leave the range of both ends by more
    than length^2/8 times its second derivative, which is at most 1/r + |k|: close bounds for pieces that run round the
    shaft, as long arms need, whose shaft angle changes fast with the distance.
    """
    middle, half = pieces.points(0.5 * pieces.length), 0.5 * pieces.length + slack
    r = np.hypot(middle[:, 0], middle[:, 1])
    least, most = np.maximum(r - half, slack), r + half
    ends = np.stack([np.hypot(*pieces.start.T), np.hypot(*pieces.ends.T)])
    sag = 0.5 * half**2 * (1.0 / least + np.abs(pieces.curvature)) + slack
    return np.maximum(least, ends.min(axis=0) - sag), np.minimum(most, ends.max(axis=0) + sag)


def meet(pieces: Arcs, guide: Guide, phi: Array, slack: float) -> Array:
    """Greatest distance from the shaft, mm (n,), at which the centre meets each short piece at its angle phi (n,), rad.

    For a guide that counts inwards it is minus the least such distance. Where they do not meet it is -inf. A meeting up
    to `slack`, mm, beyond the piece counts.
    """
    # a crossing of the piece's whole circle is on the piece if it lies over the chord and within the sagitta
    chord_turn = 0.5 * pieces.curvature * pieces.length
    chord = pieces.length * np.sinc(chord_turn / np.pi)
    along = np.cos(chord_turn)[:, None] * pieces.tangent + np.sin(chord_turn)[:, None] * left(pieces.tangent)
    sagitta = np.abs(chord * np.tan(0.5 * chord_turn)) + slack
    best = np.full(len(phi), -np.inf)
    for crossing in guide.crossings(pieces, phi, slack):
        s = dot(crossing, along)
        point = pieces.start + crossing
        with np.errstate(invalid="ignore"):
            on_piece = (s >= -slack) & (s <= chord + slack) & (np.abs(cross(along, crossing)) <= sagitta)
            on_side = guide.on_side(phi, point, slack)
        height = guide.away * np.hypot(point[:, 0], point[:, 1])
        best = np.where(on_piece & on_side & (height > best), height, best)
    return best
