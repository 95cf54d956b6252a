"""Pieces of a loop whose ends do not quite meet, made to meet: both move by half of the gap, or a line joins them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.pieces import ARC, BEZIER, Pieces
from kin.numeric.records import replace

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Mask

# A piece whose ends are this many gaps apart is turned so little by the move of one end that none follows it wrongly.
LONG = 20.0


def closed_up(pieces: Pieces, same: float, usual: float) -> Pieces:
    """Pieces of a loop whose ends meet the next starts.

    Ends that lie within `same`, mm, of the next start are set to it. Of two that are farther apart both move to their
    middle, a line or an arc to the end of a curve beside it; an arc keeps its sweep. Short pieces, and curves, are
    joined by a line, where they are farther apart than `usual`, mm, and else left.
    """
    following = np.roll(pieces.start, -1, axis=0)
    if not (np.abs(following - pieces.end) > same).any():
        return with_same_ends(pieces, same)
    pieces = halved(pieces)
    start, end = pieces.start.copy(), pieces.end.copy()
    following = np.roll(start, -1, axis=0)
    apart = np.hypot(*(following - end).T)
    # the ends that move, of pieces that are long enough for that
    size = np.hypot(*(end - start).T)
    bow = pieces.kind == BEZIER
    joint = (apart > same) & (np.minimum(size, np.roll(size, -1)) >= LONG * apart) & ~(bow & np.roll(bow, -1))
    place = np.where(bow[:, None], end, np.where(np.roll(bow, -1)[:, None], following, 0.5 * (end + following)))
    end[joint] = place[joint]
    start[np.roll(joint, 1)] = np.roll(place, 1, axis=0)[np.roll(joint, 1)]
    moved = (joint | np.roll(joint, 1)) & ~bow
    chords = Pieces.from_chords(start, end, np.tan(0.25 * pieces.sweep))
    made = replace(
        pieces,
        start=start,
        end=end,
        centre=_chosen(moved, chords.centre, pieces.centre),
        radius=_chosen(moved, chords.radius, pieces.radius),
        angle=_chosen(moved, chords.angle, pieces.angle),
    )
    return with_lines(with_same_ends(made, same), usual)


def _chosen(which: Mask, there: Array, elsewhere: Array) -> Array:
    return np.where(which[:, None] if there.ndim > 1 else which, there, elsewhere)


def halved(pieces: Pieces) -> Pieces:
    """Pieces in which no arc sweeps more than a half turn: longer ones are two, so that their chords hold them."""
    wide = np.flatnonzero((pieces.kind == ARC) & (np.abs(pieces.sweep) > np.pi))
    if not wide.size:
        return pieces
    half, angle = 0.5 * pieces.sweep[wide], pieces.angle[wide]
    parts = [Pieces.from_arcs(pieces.centre[wide], pieces.radius[wide], begin, half) for begin in (angle, angle + half)]
    first = replace(parts[0], start=pieces.start[wide])
    second = replace(parts[1], start=first.end, end=pieces.end[wide])
    kept = np.setdiff1d(np.arange(len(pieces)), wide)
    order = np.argsort(np.concatenate([kept, wide, wide + 0.5]), kind="stable")
    return Pieces.joined([pieces.take(kept), first, second]).take(order)


def with_same_ends(pieces: Pieces, same: float) -> Pieces:
    """Return the pieces of a loop, ends that lie within `same`, mm, of the next start set to it."""
    following = np.roll(pieces.start, -1, axis=0)
    near = np.abs(following - pieces.end).max(axis=1, keepdims=True) <= same
    return replace(pieces, end=np.where(near, following, pieces.end))


def with_lines(pieces: Pieces, usual: float) -> Pieces:
    """Return the pieces of a loop with a line wherever an end lies farther than `usual`, mm, from the next start."""
    following = np.roll(pieces.start, -1, axis=0)
    apart = np.flatnonzero(np.hypot(*(following - pieces.end).T) > usual)
    if not apart.size:
        return pieces
    lines = Pieces.from_chords(pieces.end[apart], following[apart], np.zeros(apart.size))
    order = np.argsort(np.concatenate([np.arange(len(pieces)), apart + 0.5]), kind="stable")
    return Pieces.joined([pieces, lines]).take(order)
