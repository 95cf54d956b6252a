"""Loose runs of pieces, in any order and direction, joined end to end into closed loops within a stated gap."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.places import place_text
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices

# Ends closer than this, mm, are one point; only ends that find no partner here look farther, up to the permitted gap.
SAME_POINT = 1e-9
# A drawing smaller than 50 mm is read as closely for its size: what is one point, and what gap is permitted by default.
SAME_SHARE = SAME_POINT / 50.0
GAP, GAP_SHARE = 1e-6, 1e-6 / 50.0
# Ends this near for the size of a drawing are joined, and told: so far apart are they where single precision was used.
NEAR_SHARE = 1e-7
# Digits explain no gap that is wider for the size of the drawing.
MOST_EXPLAINED = 1e-4
# An opening wider than this share of the drawing is called a missing segment, a smaller one a gap.
MISSING_SHARE = 0.01
# Rounding of a point computed from an arc's centre, radius and angle, in units of its coordinates.
ROUNDING = 8.0 * np.finfo(float).eps
# Openings that an error looks at.
MOST_SHOWN = 500
MOST_TOGETHER = 64  # pieces or ends at one place
# A direction in which no drawing puts many of its points on one line: sorting along it keeps candidates few.
SLANT = 0.5370795


class Closeness(NamedTuple):
    """How near ends are to be, mm.

    same      ends within it are one point
    usual     ends that are joined with no word on it: a line joins those that are farther apart
    gap       ends within it are joined: the usual distance, or the one that the caller wants
    near      what is left open is joined within this distance too, 0 for no more
    rounding  what rounding of the file's numbers may put the ends of each run off (n,); None where nothing shows it
    """

    same: float
    usual: float
    gap: float
    near: float = 0.0
    rounding: Array | None = None


class Loop(NamedTuple):
    """Runs (k,) in order round a closed loop, by number, which of them run backwards (k,), and the widest gap, mm."""

    runs: Indices
    backwards: NDArray[np.bool_]
    gap: float


def close_pairs(points: Array, tolerance: float, path: Path | None = None) -> tuple[Indices, Indices]:
    """Pairs i, j (k,), (k,) of points (n, m) no farther apart than `tolerance` in any coordinate; each pair once.

    Raises ReadError, if `path` names their file, where more than `MOST_TOGETHER` points lie together.
    """
    # pairs that are near are near along a slanted direction too: only these candidates are compared in full
    direction = np.cos(SLANT * np.arange(1, points.shape[1] + 1) ** 2)
    along = points @ direction
    order = np.argsort(along, kind="stable")
    along = along[order]
    rounding = 8.0 * np.finfo(float).eps * float(np.abs(along).max(initial=0.0))
    reach = tolerance * float(np.abs(direction).sum()) + rounding
    first, second = [order[:0]], [order[:0]]
    step = 1  # of the pairs compared, in the order along the direction
    candidates = np.arange(len(order))
    while True:
        candidates = candidates[candidates + step < len(order)]
        candidates = candidates[along[candidates + step] - along[candidates] <= reach]
        if not candidates.size:
            break
        i, j = order[candidates], order[candidates + step]
        close = (np.abs(points[i] - points[j]) <= tolerance).all(axis=1)
        first.append(i[close])
        second.append(j[close])
        step += 1
        if path is not None and step > MOST_TOGETHER:
            raise ReadError("range", f"more than {MOST_TOGETHER} pieces are drawn over one another", path)
    return np.concatenate(first), np.concatenate(second)


def loops(start: Array, end: Array, close: Closeness, path: Path, *, some: bool = False) -> list[Loop]:
    """Join runs, whose starts and ends are (n, 2), mm, into closed loops where ends lie near each other.

    The nearest are joined first. A gap below the rounding of the coordinates is raised to it. Raises ReadError:
    "branch" where more than two ends meet, "range" where very many do, "gap" or "open" where an end finds no partner;
    with `some` an open chain is left out instead.
    """
    count = len(start)
    ends = np.concatenate([start, end])  # of run k: its start is number k, its end number k + count
    gap = max(close.gap, ROUNDING * float(np.abs(ends).max()))
    partner = np.full(2 * count, -1, dtype=np.intp)
    closed = np.flatnonzero((np.abs(start - end) <= min(close.same, gap)).all(axis=1))
    partner[closed], partner[closed + count] = closed + count, closed
    for tolerance in (min(close.same, gap), gap):
        join(np.flatnonzero(partner < 0), ends, (tolerance, None), partner, path)
    free = np.flatnonzero(partner < 0)
    if free.size and close.near:
        rounding = None if close.rounding is None else np.tile(close.rounding, 2)
        join(free, ends, (close.near, rounding), partner, path)
    free = np.flatnonzero(partner < 0)
    if free.size and not some:
        raise opening(free, ends, max(gap, close.near), path)
    # runs of open chains are marked from their free ends on, and so left out
    follow = partner.tolist()
    seen = bytearray(count)
    for opened in free.tolist():
        at = opened
        while at >= 0:
            seen[at % count] = 1
            at = follow[at + count if at < count else at - count]
    # each loop is followed from its first run: where a run leaves at one end, its partner enters the next run
    chains = []
    for first in range(count):
        if seen[first]:
            continue
        runs, backwards = [], []
        run, back = first, False
        while not seen[run]:
            seen[run] = 1
            runs.append(run)
            backwards.append(back)
            leaves = run if back else run + count
            enters = follow[leaves]
            run, back = enters % count, enters >= count
        index, flip = np.array(runs, dtype=np.intp), np.array(backwards)
        out = ends[np.where(flip, index, index + count)]
        into = np.roll(ends[np.where(flip, index + count, index)], -1, axis=0)
        chains.append(Loop(index, flip, float(np.hypot(*(out - into).T).max())))
    return chains


def join(free: Indices, ends: Array, within: tuple[float, Array | None], partner: Indices, path: Path) -> None:
    """Write into `partner` (m,) the number of the other free end that is near each `free` end (k,).

    `ends` are (m, 2), mm; an end without such a partner is left as it is. `within` is a distance, mm, and how far
    rounding may put each end off (m,), or None: two ends are near too where both together explain it. Raises ReadError
    "branch" where more than two free ends meet, "range" where very many do.
    """
    tolerance, rounding = within
    off = np.zeros(len(free)) if rounding is None else rounding[free]
    i, j = close_pairs(ends[free], max(tolerance, 2.0 * float(off.max(initial=0.0))), path)
    near = np.abs(ends[free[i]] - ends[free[j]]).max(axis=1) <= np.maximum(tolerance, off[i] + off[j])
    i, j = i[near], j[near]
    met = np.bincount(np.concatenate([i, j]), minlength=len(free))
    crowded = np.flatnonzero(met > 1)
    if crowded.size:
        x, y = ends[free[crowded[0]]].tolist()
        message = f"{met[crowded[0]] + 1} ends meet at {place_text(x, y, digits=9)}, where two should"
        raise ReadError("branch", message, path, (x, y))
    partner[free[i]], partner[free[j]] = free[j], free[i]


def opening(free: Indices, ends: Array, gap: float, path: Path) -> ReadError:
    """Return the error for `free` ends (k,): the widest opening from one of them to the nearest other one.

    `ends` are (m, 2), mm; `gap`, mm, is what is permitted. The first MOST_SHOWN free ends are looked at.
    """
    points = ends[free]
    shown = points[:MOST_SHOWN]
    apart = np.hypot(*np.moveaxis(shown[:, None] - points[None], 2, 0))
    apart[np.arange(len(shown)), np.arange(len(shown))] = np.inf
    nearest = apart.argmin(axis=1)
    width = apart.min(axis=1)
    worst = int(width.argmax())
    (x, y), (x2, y2), wide = points[worst].tolist(), points[nearest[worst]].tolist(), float(width[worst])
    missing = wide > MISSING_SHARE * float(np.ptp(ends, axis=0).max())
    more = f"; {len(free) // 2} such places" if len(free) > 2 else ""
    problem = "the contour is open, a segment is missing" if missing else "the contour is open"
    places = f"{place_text(x, y, digits=9)} and {place_text(x2, y2, digits=9)}"
    message = f"{problem} between {places}: {wide:.3g} apart, permitted is {gap:.3g}{more}"
    error = ReadError("open" if missing else "gap", message, path, (x, y), wide)
    if len(free) == 2:
        error.between = (x, y), (x2, y2)
    return error
