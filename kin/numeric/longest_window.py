"""Dwells: the longest stretches of the input over which an output stays within a band.

A window [a, b] with range(f) <= band that cannot be lengthened has f leave the band at both ends. Moving the band's
level moves the ends, and the length is greatest where

- an extremum inside touches one edge of the band, or an end meets a corner of f: the level is that of a node; or
- f rises (or falls) through both ends and f'(a) = f'(b), with f(b) - f(a) = +-band: the slopes balance.

Nodes are the ends of `kin.numeric.monotone`'s pieces. Between two neighbouring starts of node windows the pieces in
which a window begins and ends stay the same and the slopes at both ends are monotone in a, so where they balance is
either excluded by their ranges or bracketed.
"""

from __future__ import annotations

import math
from functools import cached_property
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.distinct import distinct
from kin.numeric.monotone import MonotonePieces, between, cells, pieces
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices

    Flags = NDArray[np.bool_]

# Output that differs by less than this part of the band is resolved no further; ends are then found from f itself.
_RESOLUTION = 1e-9
_JUMP = 1e-6
# Starts and ends closer than this part of the period are one.
_SAME = 1e-12
# Lengths, and gains of length, that differ by less than this part of the period are equal.
_EQUAL = 1e-10
# Rates of the two ends that differ by less than this, relatively, balance.
_BALANCED = 1e-9
# More open cells than this: the slopes balance over a whole stretch, and any window in it will do.
_MOST_CELLS = 4096
# Steps of the rule of false position, and halvings after them: so many bring any part of the period below _SAME.
_FALSE_POSITIONS, _HALVINGS = 24, 42
# An end that f itself would move by more than this part of the period is not moved: f is flat there.
_FARTHEST_STEP = 1e-6
_STEPS = 2
# |f'| below this counts as this, and its inverse as the steepest.
_FLAT = 1e-150


@dataclass(frozen=True)
class Window:
    """A window of the input, from `start` in [0, period) over `length`; the output stays from `least` to `greatest`."""

    start: float
    length: float
    least: float
    greatest: float

    @property
    def end(self) -> float:
        """End of the window; beyond the period where the window runs through zero."""
        return self.start + self.length


def dwells(
    f: Callable[[Array, int], Array],
    breaks: Sequence[float] | Array,
    band: float,
    period: float = TURN,
    most: int = 8,
) -> tuple[Window, ...]:
    """Find the longest windows over which f stays within `band`, to a billionth of it, the longest first.

    f(x (n,), order) gives (order + 1, n) derivatives; it is called with order 0, at 0 <= x <= period. It is continuous
    and periodic, and smooth between breaks. No window can be lengthened by shifting it a little, and none overlaps a
    longer one; there are at most `most`. Ends are good to 1e-10 of the period, or as far as f's rounding lets them be
    known. An output that never leaves the band is one window of a whole period. Raises ValueError for a band that is
    not positive or is lost in the rounding of f, and for an output that jumps; RoughError for one too rough to follow.
    """
    search = _search(f, breaks, band, period)
    (least, _), (greatest, _) = search.of.least(), search.of.greatest()
    if greatest - least <= band + 2.0 * search.slack:  # a run from a little above the least takes in all of it
        return (Window(0.0, period, least, greatest),)
    at_nodes = search.node_windows()
    shortest = float((at_nodes.b - at_nodes.a).max(initial=0.0)) if most == 1 else 0.0
    return _polished(_disjoint(search.maximal_windows(at_nodes, shortest), period, most), f, search)


def longest_of_each(
    f: Callable[[Array, int], Array], breaks: Sequence[float] | Array, band: float, edges: Array
) -> tuple[Window, ...]:
    """Find the longest window of each section between `edges` (m + 1,), the period's 0 and end among them.

    Over a window f stays within `band`, to a billionth of it. f(x (n,), order) gives (order + 1, n) derivatives and is
    called with order 0; it is periodic and continuous, and smooth between `breaks`. It leaves the band about each edge,
    so that no window reaches from one section into the next. Ends are good to 1e-10 of the period, or as far as f's
    rounding lets them be known. Raises ValueError for a band that is not positive or is lost in the rounding of f, and
    for an output that jumps; RoughError for one too rough to follow.
    """
    search = _search(f, breaks, band, float(edges[-1]))
    at_nodes = search.node_windows()
    length = at_nodes.b - at_nodes.a
    sections = range(len(edges) - 1)
    section = search.section(at_nodes, edges)
    longest = search.maximal_windows(at_nodes, min(float(length[section == k].max(initial=0.0)) for k in sections))
    section = search.section(longest, edges)
    windows = [_disjoint(longest.take(section == k), search.period, 1) for k in sections]
    return _polished(windows[0].joined(*windows[1:]), f, search)


def _search(f: Callable[[Array, int], Array], breaks: Sequence[float] | Array, band: float, period: float) -> _Search:
    if not (math.isfinite(band) and band > 0):
        raise ValueError(f"the band of a dwell must be above 0, not {band!r}")
    places = between(0.0, period, np.mod(np.asarray(breaks, dtype=float), period).tolist())
    function = pieces(cells(lambda x: f(x, 0)[:1], places, _RESOLUTION * band))
    if band <= 4.0 * function.noise:
        raise ValueError(f"a band of {band:.3g} is lost in the rounding of the output, {function.noise:.3g}")
    _demand_continuous(function, band)
    return _Search.through(function, band, period)


def _demand_continuous(pieces: MonotonePieces, band: float) -> None:
    """Raise ValueError for a jump between pieces or over the seam of more than _JUMP of the band, and of rounding."""
    jump = np.abs(np.roll(pieces.coefficients[:, 0], -1) - pieces.coefficients[:, -1])
    worst = int(np.argmax(jump))
    if jump[worst] > _JUMP * band + 4.0 * pieces.noise:
        raise ValueError(f"the output jumps by {jump[worst]:.6g} at {pieces.x[worst + 1]:.9g}")


def doubled(value: Array, extreme: np.ufunc) -> list[Array]:
    """Extremes over runs of 1, 2, 4, ... of the values (n,), up to the longest that fits.

    `extreme` is numpy's minimum or maximum. Entry k of each array (n - run + 1,) belongs to the run that begins at k.
    """
    runs = [value]
    while 2 ** len(runs) <= len(value):
        half = 2 ** (len(runs) - 1)
        runs.append(extreme(runs[-1][:-half], runs[-1][half:]))
    return runs


class _Windows(NamedTuple):
    """n windows [a, b], each (n,); the arrays are (n,).

    They begin within piece `first` and end within `last`, pieces being numbered on through three periods. `rises`:
    f rises through a, from below the band, else falls; `leaves_up`: f rises through b. `anchor` is the node whose value
    is an edge of the band, -1 where the slopes balance; `upper`: it is the upper edge.
    """

    a: Array
    b: Array
    first: Indices
    last: Indices
    rises: Flags
    leaves_up: Flags
    anchor: Indices
    upper: Flags

    def take(self, which: Flags | Indices) -> _Windows:
        return _Windows(*map(itemgetter(which), self))

    def joined(self, *others: _Windows) -> _Windows:
        return _Windows(*map(np.concatenate, zip(self, *others, strict=True)))


@dataclass(frozen=True, eq=False)
class _Search:
    """The n pieces, their nodes through three periods (3 n + 1,), and tables of extremes over runs of 2^k nodes."""

    of: MonotonePieces
    band: float
    period: float
    x: Array
    value: Array
    lowest: list[Array]
    highest: list[Array]

    @staticmethod
    def through(pieces: MonotonePieces, band: float, period: float) -> _Search:
        x = np.concatenate([pieces.x[:-1] - period, pieces.x[:-1], pieces.x[:-1] + period, [pieces.x[-1] + period]])
        value = np.concatenate([np.tile(pieces.values[:-1], 3), pieces.values[:1]])
        return _Search(pieces, band, period, x, value, doubled(value, np.minimum), doubled(value, np.maximum))

    @property
    def slack(self) -> float:
        """Difference of values that are equal: what pieces leave of f, and their rounding."""
        return _RESOLUTION * self.band + self.of.noise

    def local(self, piece: Indices) -> tuple[Indices, Array]:
        """Each piece (k,) as one of the period's own, and how far it is from there."""
        count = len(self.of.coefficients)
        return piece % count, self.x[piece] - self.of.x[piece % count]

    def crossing(self, piece: Indices, level: Array) -> Array:
        own, shift = self.local(piece)
        return self.of.crossing(own, level) + shift

    def slope(self, piece: Indices, x: Array) -> Array:
        own, shift = self.local(piece)
        return self.of.slope(own, x - shift)

    def inside(self, level: int, begin: Indices, low: Array) -> Flags:
        """Whether the 2^level nodes from `begin` (k,) on lie in the band from `low` (k,)."""
        lowest, highest = self.lowest[level][begin], self.highest[level][begin]
        return (lowest >= low - self.slack) & (highest <= low + self.band + self.slack)

    def reach_right(self, node: Indices, low: Array) -> Indices:
        """Last node (k,) of the run from `node` (k,) to the right that stays in the band; `node` counts as within."""
        node = node.copy()
        for level in range(len(self.lowest) - 1, -1, -1):
            last = len(self.lowest[level]) - 1
            further = (node + 1 <= last) & self.inside(level, np.minimum(node + 1, last), low)
            node += further * 2**level
        return node

    def reach_left(self, node: Indices, low: Array) -> Indices:
        """First node (k,) of the run from `node` (k,) to the left that stays in the band; `node` counts as within."""
        node = node.copy()
        for level in range(len(self.lowest) - 1, -1, -1):
            begin = node - 2**level
            further = (begin >= 0) & self.inside(level, np.maximum(begin, 0), low)
            node -= further * 2**level
        return node

    def node_windows(self) -> _Windows:
        """For each node of the middle period the windows whose band has its lower, and its upper, edge at the node."""
        count = len(self.of.coefficients)
        node = np.tile(np.arange(count, 2 * count), 2)
        upper = np.arange(2 * count) >= count
        low = self.value[node] - self.band * upper
        first, last = self.reach_left(node, low) - 1, self.reach_right(node, low)
        rises, leaves_up = self.value[first] < low, self.value[last + 1] > low + self.band
        a = self.crossing(first, np.where(rises, low, low + self.band))
        b = self.crossing(last, np.where(leaves_up, low + self.band, low))
        windows = _Windows(a, b, first, last, rises, leaves_up, node, upper)
        return windows.take(b - a > _SAME * self.period)

    @cached_property
    def runs(self) -> Indices:
        """Number of the run of each piece, through three periods: along a run |f'| rises all along, or falls.

        Jumps the other way within _BALANCED do not end a run.
        """
        of = self.of
        steep = np.abs(np.diff(of.coefficients, axis=1)[:, [0, -1]]) / of.width[:, None]
        begin, end = np.tile(steep, (3, 1)).T
        way = np.sign(end - begin)
        step = way[1:] * (begin[1:] - end[:-1])
        broken = (way[1:] != way[:-1]) | (way[1:] == 0.0) | (step < -_BALANCED * end[:-1])
        runs: Indices = np.append(0, np.cumsum(broken))
        return runs

    def section(self, w: _Windows, edges: Array) -> Indices:
        """In which section between `edges` (m + 1,) the middle of each window lies."""
        return np.searchsorted(edges, np.mod(0.5 * (w.a + w.b), self.period), side="right") - 1

    def maximal_windows(self, at_nodes: _Windows, shortest: float) -> _Windows:
        """Windows that cannot be lengthened; windows of balanced slopes clearly below `shortest` may be missing."""
        balanced = self.balanced_windows(at_nodes.a, shortest - _EQUAL * self.period)
        return at_nodes.take(self.is_longest(at_nodes)).joined(balanced)

    def is_longest(self, w: _Windows) -> Flags:
        """Whether the windows cannot be lengthened by moving their bands a little up or down."""
        rates_at_a, rates_at_b = self._rates(w.first, w.a, w.first + 1), self._rates(w.last, w.b, w.last)
        low = self.value[w.anchor] - self.band * w.upper
        at_low, at_high = self._touched(w, low)
        lengthened = np.zeros(len(w.a), dtype=np.bool_)
        for up, level in ((True, at_low), (False, at_high)):
            # moving up, an end through which f rises goes right, one through which f falls left
            at_a = np.where(w.rises, rates_at_a[up], rates_at_a[not up])
            at_b = np.where(w.leaves_up, rates_at_b[up], rates_at_b[not up])
            gain = np.where(w.leaves_up, 1.0, -1.0) / at_b - np.where(w.rises, 1.0, -1.0) / at_a
            gain *= 1.0 if up else -1.0
            lengthened |= ~level & (gain > _BALANCED * (1.0 / at_a + 1.0 / at_b))
        return ~lengthened

    def _rates(self, piece: Indices, x: Array, node: Indices) -> tuple[Array, Array]:
        """|f'| to the left and right of ends x (k,) that lie in pieces (k,), perhaps on the nodes (k,)."""
        own = np.abs(self.slope(piece, x))
        neighbour = 2 * node - 1 - piece  # the piece on the node's other side
        beyond = np.where(
            np.abs(x - self.x[node]) <= _SAME * self.period, np.abs(self.slope(neighbour, self.x[node])), own
        )
        steep = 1.0 / _FLAT
        left, right = np.where(neighbour < piece, beyond, own), np.where(neighbour < piece, own, beyond)
        return np.clip(left, _FLAT, steep), np.clip(right, _FLAT, steep)

    def _touched(self, w: _Windows, low: Array) -> tuple[Flags, Flags]:
        """Whether a node between the ends lies on the lower and on the upper edge of the band."""
        begin = w.first + 1 + (self.x[w.first + 1] - w.a <= _SAME * self.period)
        end = w.last - (w.b - self.x[w.last] <= _SAME * self.period)
        any_node = begin <= end
        length = np.where(any_node, end - begin + 1, 1)
        level = np.frexp(length.astype(float))[1] - 1
        begin, end = np.where(any_node, begin, 0), np.where(any_node, end, 0)
        lowest, highest = np.full(len(begin), np.inf), np.full(len(begin), -np.inf)
        for k in np.flatnonzero(np.bincount(level)).tolist():
            at_level = np.flatnonzero(level == k)
            tail = end[at_level] + 1 - 2**k
            lowest[at_level] = np.minimum(self.lowest[k][begin[at_level]], self.lowest[k][tail])
            highest[at_level] = np.maximum(self.highest[k][begin[at_level]], self.highest[k][tail])
        return any_node & (lowest <= low + self.slack), any_node & (highest >= low + self.band - self.slack)

    def balanced_windows(self, starts: Array, least: float) -> _Windows:
        """Windows through whose ends f goes alike, with equal slopes, between neighbouring starts of node windows.

        Those shorter than `least` may be left out.
        """
        of, count, period = self.of, len(self.of.coefficients), self.period
        starts = distinct(np.concatenate([of.x, np.mod(starts, period)]))
        wide = np.diff(starts) > _SAME * period
        left, right = starts[:-1][wide], starts[1:][wide]
        middle = 0.5 * (left + right)
        # between neighbouring starts a window begins and ends in the same pieces: its middle start shows which
        own = np.clip(np.searchsorted(of.x, middle, side="right") - 1, 0, count - 1)
        change = of.coefficients[own, -1] - of.coefficients[own, 0]
        first, rises = own + count, change > 0
        low = of.at(own, middle) - np.where(rises, 0.0, self.band)
        last = self.reach_right(first, low)
        beyond = self.value[last + 1]
        alike = np.where(rises, beyond > low + self.band, beyond < low) & (np.abs(change) > of.noise)
        family = _Family(self, first[alike], last[alike], rises[alike])
        which, a = family.balanced(left[alike], right[alike], least)
        b, _, _ = family.take(which).ends(a)
        first, last, rises = first[alike][which], last[alike][which], rises[alike][which]
        return _Windows(a, b, first, last, rises, rises, np.full(len(a), -1), ~rises)


@dataclass(frozen=True, eq=False)
class _Family:
    """k families of windows that begin in a piece `first` and end in a piece `last`, f going alike through both."""

    search: _Search
    first: Indices
    last: Indices
    rises: Flags

    def take(self, which: Indices) -> _Family:
        return _Family(self.search, self.first[which], self.last[which], self.rises[which])

    def ends(self, a: Array) -> tuple[Array, Array, Array]:
        """The end b of the window from a, and |f'| at a and at b; (k,) each."""
        search = self.search
        own, shift = search.local(self.first)
        level = search.of.at(own, a - shift) + np.where(self.rises, search.band, -search.band)
        b = search.crossing(self.last, level)
        return b, np.abs(search.slope(self.first, a)), np.abs(search.slope(self.last, b))

    def balanced(self, left: Array, right: Array, least: float) -> tuple[Indices, Array]:
        """Which of the families have a longest window with a between left and right (k,), and its a.

        As db/da = f'(a)/f'(b), the length grows where f is steeper at a than at b. As b rises with a, no window between
        them is longer than from left to the end of the last; one of at least `least` is looked for.
        """
        period, runs = self.search.period, self.search.runs
        of, in_run = np.arange(len(left)), runs[self.first] == runs[self.last]
        _, at_a, at_b = self.ends(left)
        end, to_a, to_b = self.ends(right)
        places: list[tuple[Indices, Array, Array, Array, Array]] = []
        while len(of) or not places:
            least_a, most_a = np.minimum(at_a, to_a), np.maximum(at_a, to_a)
            least_b, most_b = np.minimum(at_b, to_b), np.maximum(at_b, to_b)
            apart = (least_a > most_b) | (most_a < least_b) | (end - left < least)
            # of two places of one run the same is steeper all along
            unlike = (np.abs(at_a - at_b) > _BALANCED * at_b) & (np.abs(to_a - to_b) > _BALANCED * to_b)
            apart |= in_run[of] & unlike
            one_way = ((to_a <= at_a) & (to_b >= at_b)) | ((to_a >= at_a) & (to_b <= at_b))
            small = (right - left) * (most_a - least_b) <= _EQUAL * period * least_b
            small |= right - left <= _SAME * period  # also where f is flat at an end, whose slope no part outweighs
            settled = apart | one_way | small | (len(of) > _MOST_CELLS)
            peak = settled & ~apart & (at_a >= at_b) & (to_a <= to_b)
            places.append((of[peak], left[peak], right[peak], (at_a - at_b)[peak], (to_a - to_b)[peak]))
            unsettled = ~settled
            of, left, right, end = of[unsettled], left[unsettled], right[unsettled], end[unsettled]
            at_a, at_b, to_a, to_b = at_a[unsettled], at_b[unsettled], to_a[unsettled], to_b[unsettled]
            middle = 0.5 * (left + right)
            mid, mid_a, mid_b = self.take(of).ends(middle)
            of = np.concatenate([of, of])
            left, right, end = (np.concatenate(p) for p in ((left, middle), (middle, right), (mid, end)))
            at_a, to_a = np.concatenate([at_a, mid_a]), np.concatenate([mid_a, to_a])
            at_b, to_b = np.concatenate([at_b, mid_b]), np.concatenate([mid_b, to_b])
        which, left, right, before, after = (np.concatenate(list(part)) for part in zip(*places, strict=True))
        return which, self.take(which).refined(left, right, before, after)

    def refined(self, left: Array, right: Array, before: Array, after: Array) -> Array:
        """Places (n,) where the difference of slopes is 0; it is `before` >= 0 at left, `after` <= 0 at right.

        Illinois' method, and halving where that does not end soon.
        """
        if not len(left):
            return left
        last, rose = left, np.full(len(left), -1)
        for step in range(_FALSE_POSITIONS + _HALVINGS):
            drop = before - after
            with np.errstate(divide="ignore", invalid="ignore"):
                share = np.where(drop > 0, before / drop, 0.0) if step < _FALSE_POSITIONS else 0.5
            a = left + (right - left) * share
            _, at_a, at_b = self.ends(a)
            h = at_a - at_b
            rises = h > 0
            again = np.where(rises == rose, 0.5, 1.0)  # an end that stays twice counts half
            before, after, rose = np.where(rises, h, again * before), np.where(rises, again * after, h), rises
            left, right = np.where(rises, a, left), np.where(rises, right, a)
            if (np.abs(a - last) <= _SAME * self.search.period).all():
                break
            last = a
        return last


def _disjoint(windows: _Windows, period: float, most: int) -> _Windows:
    """At most `most` windows, the longest first: each the longest that overlaps none before, of equals the earliest."""
    length = windows.b - windows.a
    start = np.mod(windows.a, period)
    order = np.lexsort([start, -np.round(length / (_EQUAL * period))])
    chosen: list[int] = []
    slack = _EQUAL * period
    for k in order.tolist():
        if all(
            (start[k] - start[c]) % period >= length[c] - slack and (start[c] - start[k]) % period >= length[k] - slack
            for c in chosen
        ):
            chosen.append(k)
            if len(chosen) == most:
                break
    return windows.take(np.array(chosen, dtype=np.intp))


def _polished(w: _Windows, f: Callable[[Array, int], Array], search: _Search) -> tuple[Window, ...]:
    """Put the ends where f itself, not its polynomial, crosses the edges of the band."""

    def value(x: Array) -> Array:
        values: Array = f(np.mod(x, search.period), 0)[0]
        return values

    edge = value(np.where(w.anchor >= 0, search.x[w.anchor], w.a))
    low = edge - search.band * w.upper
    a, b = (
        _moved(x, piece, low + search.band * is_upper, value, search)
        for x, piece, is_upper in ((w.a, w.first, ~w.rises), (w.b, w.last, w.leaves_up))
    )
    start = np.mod(a, search.period)
    start[start >= search.period] = 0.0
    windows = zip(start.tolist(), (b - a).tolist(), low.tolist(), strict=True)
    return tuple(Window(at, length, least, least + search.band) for at, length, least in windows)


def _moved(x: Array, piece: Indices, level: Array, f: Callable[[Array], Array], search: _Search) -> Array:
    """Ends x (k,) moved to where f itself reaches the levels (k,), by Newton's method with its polynomial's slopes.

    The polynomial follows f to `_RESOLUTION`. Each of the two steps leaves of an end's error no more than the part by
    which the slopes of f and of the polynomial differ.
    """
    for _ in range(_STEPS):
        with np.errstate(divide="ignore", invalid="ignore"):
            step = (f(x) - level) / search.slope(piece, x)
        x = x - np.where(np.abs(step) <= _FARTHEST_STEP * search.period, step, 0.0)
    return x
