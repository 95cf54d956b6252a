"""A groove of several turns on an unknown drum, by what lines along its axis meet: its turns, and where walls are gone.

From line to line a gap between two stretches of metal goes on in the one that it overlaps. Where two turns cross, two
gaps become one and part again. Each of those that come in goes on in the one of those that leave which its height and
slope lead to. Within a crossing the groove has the one wall of its own that lies at an edge of the common gap: the
lower one until both turns are at one height, the upper one from there on, or the other way round.
"""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.cylindrical.unknown import Column
    from kin.numeric.arrays import Array, Indices, Mask

SLOPE = 24  # lines at the end of a run, over which its slope is taken
SHORT = 2  # lines that a run of one turn has at least
MOST_CROSSED = 4  # turns that meet at one place
ASTRAY = 0.25  # of the width of a groove, by which a turn may miss the run that it goes on in
NEARLY = 0.1  # of it, within which an edge of a common gap may be a wall of this turn, by the way between both runs
LIKE = 0.15  # of it, by which a common gap is wider than one turn where it is told which edges are whose
CLOSE = 0.002  # of it, within which an edge is a wall of this turn, by the way between the edges that are told
MOST_TURNS = 40  # as recipes have them


@dataclass(frozen=True, eq=False)
class Winding:
    """A groove over all its turns, at lines along the axis, equally many a turn (n,).

    lower, upper  heights of its walls, mm; where a wall is gone, of where it would be
    stands        whether the lower and the upper wall are there, (2, n)
    """

    lower: Array
    upper: Array
    stands: Mask

    def begun(self, turn: int, lines: int) -> Winding:
        """Groove whose rows begin with another of its turns, by number, where each turn has `lines` lines."""
        back = -turn * lines
        return Winding(np.roll(self.lower, back), np.roll(self.upper, back), np.roll(self.stands, back, axis=1))


class _Run(NamedTuple):
    """Gaps that go on one in one: their first line, their ends (k, 2), the runs before and behind them by number."""

    first: int
    ends: Array
    before: tuple[int, ...]
    behind: tuple[int, ...]

    @property
    def last(self) -> int:
        """Its last line."""
        return self.first + len(self.ends) - 1

    @property
    def middle(self) -> Array:
        """Heights (k,) of the middles, mm."""
        return np.asarray(self.ends.mean(axis=1))


def windings(columns: Sequence[Column], radius: float) -> list[Winding]:
    """Grooves that close after several turns, at lines at a radius, mm; each from the turn on that begins lowest."""
    runs = _runs(columns)
    single = {k for k, run in enumerate(runs) if len(run.before) == len(run.behind) == 1 and len(run.ends) >= SHORT}
    left, found = set(single), []
    while left:
        start = min(left, key=lambda k: float(np.ptp(runs[k].ends, axis=1).min()))
        path = _path(runs, single, start, len(columns))
        left -= {start, *(path or ())}
        if path is not None:
            found.append(_winding(runs, path, columns, radius))
    return found


def _runs(columns: Sequence[Column]) -> list[_Run]:
    """Runs of gaps between stretches of metal; a gap that closes without meeting another is none."""
    n = len(columns)
    gaps = [np.stack([z[1:-1:2], z[2::2]], axis=1) for z in (column.z for column in columns)]
    behind: list[list[list[int]]] = []
    before: list[list[list[int]]] = [[[] for _ in gap] for gap in gaps]
    for j, own in enumerate(gaps):
        following = gaps[(j + 1) % n]
        over = (own[:, None, 0] < following[None, :, 1]) & (own[:, None, 1] > following[None, :, 0])
        behind.append([np.flatnonzero(row).tolist() for row in over])
        for i, k in zip(*np.nonzero(over), strict=True):
            before[(j + 1) % n][int(k)].append(int(i))

    def goes_on(j: int, i: int) -> bool:
        """Whether a gap goes on in one alone, which no other one goes on in."""
        (ahead, *others) = behind[j][i] or [-1]
        return ahead >= 0 and not others and len(before[(j + 1) % n][ahead]) == 1

    number: dict[tuple[int, int], int] = {}
    chains: list[list[tuple[int, int]]] = []
    for j, own in enumerate(gaps):
        for i in range(len(own)):
            back = before[j][i]
            if len(back) == 1 and goes_on((j - 1) % n, back[0]):
                continue
            chain = [(j, i)]
            while goes_on(*chain[-1]) and len(chain) <= n:
                at, gap = chain[-1]
                chain.append(((at + 1) % n, behind[at][gap][0]))
            number |= dict.fromkeys(chain, len(chains))
            chains.append(chain)
    runs = []
    for chain in chains:
        (first, one), (last, other) = chain[0], chain[-1]
        ends = np.array([gaps[j][i] for j, i in chain])
        came = tuple(number[(first - 1) % n, k] for k in before[first][one])
        goes = tuple(number[(last + 1) % n, k] for k in behind[last][other])
        runs.append(_Run(first, ends, came, goes))
    return runs


def _path(runs: Sequence[_Run], single: set[int], start: int, lines: int) -> list[int] | None:
    """Numbers of the runs of one groove in order, from one on until it closes; None where it does not."""
    path = [start]
    while True:
        following = _behind(runs, single, path[-1], lines)
        if following is None:
            return None
        if following == start:
            return path
        if following in path or len(path) > MOST_TURNS * len(runs):
            return None
        path.append(following)


def _behind(runs: Sequence[_Run], single: set[int], own: int, lines: int) -> int | None:
    """Number of the run in which one goes on behind a crossing; None where the crossing does not tell."""
    common, comes, leaves = set(), {own}, set()
    open_ = list(runs[own].behind)
    while open_:
        k = open_.pop()
        if k in common:
            continue
        common.add(k)
        comes |= {each for each in runs[k].before if each in single}
        leaves |= {each for each in runs[k].behind if each in single}
        open_ += [each for each in (*runs[k].before, *runs[k].behind) if each not in single]
    if len(comes) != len(leaves) or len(comes) > MOST_CROSSED:
        return None
    first = sorted(comes)
    orders = list(permutations(sorted(leaves)))
    bent = [max(_missed(runs[a], runs[b], lines)[1] for a, b in zip(first, order, strict=True)) for order in orders]
    best = orders[int(np.argmin(bent))][first.index(own)]
    width = float(np.ptp(runs[own].ends, axis=1).min())
    return best if _missed(runs[own], runs[best], lines)[0] <= ASTRAY * width else None


def _missed(one: _Run, other: _Run, lines: int) -> tuple[float, float]:
    """By how much, mm, a run misses another one behind it, by their mean slope, and by that of either at most."""
    ahead = (other.first - one.last) % lines
    rise, slopes = float(other.middle[0] - one.middle[-1]), (_slope(one, -1), _slope(other, 0))
    off = [abs(rise - slope * ahead) for slope in slopes]
    return abs(rise - 0.5 * sum(slopes) * ahead), max(off)


def _slope(run: _Run, end: int) -> float:
    """Slope of a run at its end, or where it begins (0), mm a line."""
    middle = run.middle[-SLOPE:] if end else run.middle[:SLOPE]
    return float(middle[-1] - middle[0]) / max(len(middle) - 1, 1)


def _winding(runs: Sequence[_Run], path: Sequence[int], columns: Sequence[Column], radius: float) -> Winding:
    """The groove along a path of runs, with what lies in the crossings between them."""
    n = len(columns)
    walls, stands = [], []
    for one, other in zip(path, [*path[1:], path[0]], strict=True):
        own, following = runs[one], runs[other]
        between, there = _crossed(own, following, columns, radius)
        walls += [own.ends, between]
        stands += [np.ones(own.ends.shape, dtype=np.bool_), there]
    # the first line of the path is that of its first run: turn it to the beginning of a turn
    rows, flags = (np.roll(np.concatenate(each), runs[path[0]].first, axis=0) for each in (walls, stands))
    winding = Winding(rows[:, 0], rows[:, 1], flags.T)
    return winding.begun(int(np.argmin(rows[::n].sum(axis=1))), n)


def _crossed(one: _Run, other: _Run, columns: Sequence[Column], radius: float) -> tuple[Array, Mask]:
    """Walls (k, 2) at the lines between two runs, and whether they stand, (k, 2)."""
    n = len(columns)
    ahead = (other.first - one.last) % n
    places = np.arange(1, ahead)
    middle = _cubic((0, ahead), (one.middle[-1], other.middle[0]), (_slope(one, -1), _slope(other, 0)), places)
    step = radius * TURN / n
    # along the axis a groove is as much wider as it climbs
    square = [np.ptp(run.ends[k]) / np.hypot(1.0, _slope(run, k) / step) for run, k in ((one, -1), (other, 0))]
    climbs = np.gradient(np.concatenate([one.middle[-1:], middle, other.middle[:1]]))[1:-1] / step
    width = np.interp(places, [0, ahead], square) * np.hypot(1.0, climbs)
    common = [_gap(columns[(one.last + k) % n], c) for k, c in zip(places.tolist(), middle.tolist(), strict=True)]
    edges = np.array(common).reshape(-1, 2)
    by_wall = edges + 0.5 * np.stack([width, -width], axis=1)
    near = np.abs(by_wall - middle[:, None]) <= NEARLY * width[:, None]
    # where the common gap is about as wide as one turn, either may have an edge
    told = near & (np.abs(np.diff(by_wall, axis=1)) > LIKE * width[:, None])
    known = [0, *places[told.any(axis=1)].tolist(), ahead]
    heights = np.where(told[:, 0], by_wall[:, 0], by_wall[:, 1])[told.any(axis=1)]
    heights = [float(one.middle[-1]), *heights.tolist(), float(other.middle[0])]
    for k in np.flatnonzero(np.diff(known) > 1).tolist():
        inside = np.arange(known[k] + 1, known[k + 1])
        slopes = [
            float(np.polyfit(known[part], heights[part], 1)[0]) if len(known[part]) > 1 else _slope(run, end)
            for part, run, end in (
                (slice(max(k + 1 - SLOPE, 0), k + 1), one, -1),
                (slice(k + 1, k + 1 + SLOPE), other, 0),
            )
        ]
        middle[inside - 1] = _cubic(known[k : k + 2], heights[k : k + 2], slopes, inside)
    middle[np.array(known[1:-1], dtype=np.intp) - 1] = heights[1:-1]
    there = np.abs(by_wall - middle[:, None]) <= CLOSE * width[:, None]
    return middle[:, None] + 0.5 * np.stack([-width, width], axis=1), there


def _cubic(ends: Sequence[int], heights: Sequence[float], slopes: Sequence[float], places: Indices) -> Array:
    """The cubic through both ends, lines, with its slopes there, mm a line, at places (k,) between them."""
    length = ends[1] - ends[0]
    share = (places - ends[0]) / length
    rest = 1.0 - share
    first = (1.0 + 2.0 * share) * heights[0] + share * length * slopes[0]
    last = (3.0 - 2.0 * share) * heights[1] - rest * length * slopes[1]
    return np.asarray(rest**2 * first + share**2 * last)


def _gap(column: Column, height: float) -> tuple[float, float]:
    """Ends of the gap in which a height lies, or of the nearest one."""
    low, high = column.z[1:-1:2], column.z[2::2]
    k = int(np.argmin(np.maximum(low - height, height - high)))
    return float(low[k]), float(high[k])
