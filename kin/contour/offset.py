"""Parallel of a closed chain of lines and arcs: arcs to arcs, exactly, with its corners cut off or rounded.

On the side to which a corner opens the parallel is an arc about it; on the other side its neighbours are cut where they
meet. An arc about a centre nearer than the parallel's distance has none; one that shrinks to a point is left out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import Arcs, cross, dot, left
from kin.contour.contour import Contour
from kin.numeric.errors import CamgeoError
from kin.numeric.places import place_text

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Mask

STEPS = 60  # of Newton's method
SETTLED = 1e-13  # of the size: accuracy of a meeting
SMOOTH = 1e-3  # times `fine`: a joint at which a corner would move the parallel by less is taken as smooth


class TightError(CamgeoError, ValueError):
    """A piece has no parallel at the distance; `piece` is its index in the chain, `place` its start (x, y), mm."""

    def __init__(self, message: str, piece: int, place: tuple[float, float]) -> None:
        super().__init__(message)
        self.piece = piece
        self.place = place


def parallel(loop: Arcs, distance: float, fine: float) -> Contour:
    """Parallel curve at `distance` mm to the left of a closed chain, to its right if negative, run the same way.

    A corner that opens to the parallel's side is rounded by an arc about it; at other corners the neighbouring pieces
    are cut where they meet. Pieces of the parallel that follow one another and are together no longer than `fine` mm
    are left out, as are kinks that move the curve by less than a thousandth of `fine`. Raises TightError, which names
    the piece, where a piece has no parallel: its radius is too small, or its neighbours cut it away.
    """
    # A piece of length s and curvature k has a parallel of length s (1 - k d), turned inside out where that is
    # negative.
    stretched = loop.length * (1.0 - loop.curvature * distance)
    left_out = _left_out(stretched, fine)
    tight = np.flatnonzero(~left_out & (stretched <= 0.0))
    if tight.size:
        raise _tight(loop, int(tight[0]), distance)
    kept = np.flatnonzero(~left_out)
    if not kept.size:
        raise _tight(loop, 0, distance)
    chain = loop.take(kept)
    moved = Arcs(
        chain.start + distance * left(chain.tangent),
        chain.tangent,
        chain.curvature / (1.0 - chain.curvature * distance),
        stretched[kept],
    )
    # [begin, end] of each moved piece, as arc lengths, is the part that its joints leave
    begin, end = np.zeros(len(kept)), moved.length.copy()
    following = np.roll(np.arange(len(kept)), -1)
    leave, enter = moved.ends, moved.start[following]
    out, into = moved.end_tangents, moved.tangent[following]
    turn = np.arctan2(cross(out, into), dot(out, into))
    gap = enter - leave
    apart = np.hypot(gap[:, 0], gap[:, 1])
    smooth = apart * np.abs(turn) <= SMOOTH * fine
    neighbours = (kept[following] - kept) % len(loop) == 1
    rounded = ~smooth & neighbours & (distance * turn < 0.0)
    # smooth joints meet midway, along the tangents; other corners where the pieces, run on, meet
    joint = 0.5 * (leave + enter)
    end += np.where(smooth, dot(joint - leave, out), 0.0)
    begin[following] += np.where(smooth, dot(joint - enter, into), 0.0)
    for i in np.flatnonzero(~smooth & ~rounded).tolist():
        j = int(following[i])
        met = _meeting(moved.take(np.array([i])), moved.take(np.array([j])))
        if met is None:
            raise _tight(loop, int(kept[i]), distance)
        joint[i], end[i], begin[j] = met
    swallowed = np.flatnonzero(end <= begin)
    if swallowed.size:
        raise _tight(loop, int(kept[swallowed[0]]), distance)
    # each piece by its start and bulge, with the arc of a rounded corner before it
    points, bulges = [], []
    spanned = np.tan(0.25 * moved.curvature * (end - begin))
    for i in range(len(kept)):
        before = (i - 1) % len(kept)
        if rounded[before]:
            points += [leave[before], enter[before]]
            bulges += [np.tan(0.25 * turn[before]), spanned[i]]
        else:
            points.append(joint[before])
            bulges.append(spanned[i])
    return Contour.from_bulges(np.array(points), np.array(bulges))


def _left_out(stretched: Array, fine: float) -> Mask:
    """Mask (n,) of the pieces of a closed chain whose run of short neighbours is together no longer than `fine`, mm."""
    length = np.abs(stretched)
    short = length <= fine
    first = int(np.argmin(short))  # a piece that stays: runs are counted from it
    run = np.cumsum(~np.roll(short, -first))
    together = np.bincount(run, np.roll(np.where(short, length, 0.0), -first))
    left_out: Mask = short & np.roll(together[run] <= fine, first)
    return left_out


def chain_of(points: Array, bulges: Array) -> Arcs:
    """Lines and arcs from point to point (n, 2) and back, each turning by at most half a turn.

    A bulge (n,) is tan(sweep/4) of the piece that starts at its point.
    """
    return Contour.from_bulges(points, bulges).as_arcs()[0]


def _meeting(first: Arcs, other: Arcs) -> tuple[Array, float, float] | None:
    """Where two pieces (1,), run on beyond their ends, meet near the end of one and the start of the other.

    Returns the point (2,) and the arc lengths on both, by Newton's method; None where it does not converge.
    """
    s, t = first.length.copy(), np.zeros(1)
    size = float(np.abs(first.start).max() + first.length[0] + other.length[0])
    for _ in range(STEPS):
        gap = other.points(t) - first.points(s)
        along, across = first.tangents(s), other.tangents(t)
        sine = cross(along, across)
        if not abs(float(sine[0])) > 0.0:
            return None
        step, shift = cross(gap, across) / sine, cross(gap, along) / sine
        s, t = s + step, t + shift
        if not (abs(float(s[0])) < 4.0 * size and abs(float(t[0])) < 4.0 * size):
            return None
        if max(abs(float(step[0])), abs(float(shift[0]))) <= SETTLED * size / min(1.0, abs(float(sine[0]))):
            return first.points(s)[0], float(s[0]), float(t[0])
    return None


def _tight(loop: Arcs, piece: int, distance: float) -> TightError:
    x, y = loop.start[piece].tolist()
    what = f"the curve turns too sharply for its parallel at {abs(distance):.6g} mm, near {place_text(x, y)}"
    return TightError(what, piece, (x, y))
