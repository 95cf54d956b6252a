"""The longest dwell of an output that has thousands of breaks, as a polygon gives it, without looking everywhere.

A block of the period is known by the least and greatest value at its nodes. Runs of whole blocks that surely stay
within the band show how long the longest window is at least; runs that cannot be excluded and are long enough show
where it may begin and end. Only there the output is followed exactly (`kin.numeric.longest_window`). The core that
every such window contains counts by its extremes alone, and the other parts of the period not at all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.longest_window import Window, doubled, dwells, longest_of_each

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from kin.numeric.arrays import Array, Indices

BLOCKS = 1024
# Between spans that are looked at the output is replaced by a roof: it rises by ROOF ranges over a ridge between two
# straight slopes, placed in widths of the span before it.
ROOF, RIDGE = 16.0, (1.1, 1.25)
# Shares of the core at which its extremes stand; no two slopes between them are equal, or many windows would be so.
PASSING = (0.001, 0.0025, 0.996, 0.9983)
ALIKE = 8  # decimals, rad, to which windows count as equally long; of such windows the first is taken


class Output(NamedTuple):
    """A periodic output, by its nodes x (m + 1,), rad, and the values (m + 1,) there; it is smooth between nodes.

    f(x (n,)) gives values (n,) at any x, `extremes(a, b)` the least and greatest value over [a, b]. Between nodes the
    output strays from the range of their values by `slack` at most.
    """

    f: Callable[[Array], Array]
    extremes: Callable[[float, float], tuple[float, float]]
    x: Array
    value: Array
    slack: float

    @property
    def period(self) -> float:
        """Length of the period, rad."""
        return float(self.x[-1] - self.x[0])


class _Span(NamedTuple):
    """Windows that may be the longest lie in [begin, end], and each contains [core, rest] if core < rest."""

    begin: float
    core: float
    rest: float
    end: float

    def on(self, turn: float) -> _Span:
        return _Span(*(x + turn for x in self))

    def joined(self, other: _Span) -> _Span:
        """Span that holds for the windows of both spans; `other` begins no earlier."""
        return _Span(self.begin, max(self.core, other.core), min(self.rest, other.rest), max(self.end, other.end))


def longest_dwells(outputs: Sequence[Output], band: float) -> list[Window]:
    """Longest window of each output over which it stays within the band; its start is reduced to [0, period).

    Raises ValueError for a band that is not above 0 or is lost in the rounding of an output, RoughError for an output
    that no polynomials follow.
    """
    spans = [_spans(output, band) for output in outputs]
    within = _within([(output, span) for output, some in zip(outputs, spans, strict=True) for span in some], band)
    longest = []
    for output, some in zip(outputs, spans, strict=True):
        dwells = [next(within) for _ in some] or [_anywhere(output, band)]
        best = max(dwells, key=lambda dwell: round(dwell.length, ALIKE))
        longest.append(Window(best.start % output.period, best.length, best.least, best.greatest))
    return longest


def _anywhere(output: Output, band: float) -> Window:
    begin = float(output.x[0])
    best = dwells(lambda t, _: output.f(t + begin)[None], output.x[1:-1] - begin, band, output.period, 1)[0]
    return Window(best.start + begin, best.length, best.least, best.greatest)


class _Cut(NamedTuple):
    """An output from `begin` over `width`, with a polygon through `places` and `values` in place of the core.

    The polygon passes both extremes of the core at either end: a window contains all of it, or hardly any. `breaks`
    are the nodes and places.
    """

    f: Callable[[Array], Array]
    begin: float
    width: float
    places: Array
    values: Array
    breaks: Array

    @staticmethod
    def of(output: Output, span: _Span) -> _Cut:
        begin, core, rest, end = span
        nodes = np.concatenate([output.x[:-1], output.x[:-1] + output.period])
        nodes = nodes[(nodes > begin) & (nodes < end)]
        places, values = np.zeros(0), np.zeros(0)
        if core < rest:
            nodes = nodes[(nodes < core) | (nodes > rest)]
            least, greatest = output.extremes(core, rest)
            places = core + (rest - core) * np.array([0.0, *PASSING, 1.0])
            first, last = output.f(places[[0, -1]])
            values = np.array([first, greatest, least, greatest, least, last])
        return _Cut(output.f, begin, end - begin, places, values, np.concatenate([nodes, places]))

    def __call__(self, x: Array) -> Array:
        """Values (n,) at x (n,) of the span."""
        if not len(self.places):
            return self.f(x)
        value: Array = np.interp(x, self.places, self.values)
        outside = (x <= self.places[0]) | (x >= self.places[-1])
        value[outside] = self.f(x[outside])
        return value


def _within(spans: Sequence[tuple[Output, _Span]], band: float) -> Iterator[Window]:
    """Find the longest window in each span, which may go on beyond the period's end; at its ends it leaves the band.

    The spans stand side by side as one function, roofs between them that quickly leave the band.
    """
    if not spans:
        return
    cuts = [_Cut.of(*pair) for pair in spans]
    width = np.array([cut.width for cut in cuts])
    edges = np.append(0.0, np.cumsum(RIDGE[1] * width))
    starts = edges[:-1].tolist()
    ends = np.array([cut.f(np.array([cut.begin, cut.begin + cut.width])) for cut in cuts])
    values = np.concatenate([output.value for output, _ in spans])
    top = values.max() + ROOF * max(float(np.ptp(values)), band)
    roofs = np.ravel([edges[:-1], edges[:-1] + width, edges[:-1] + RIDGE[0] * width], order="F")
    levels = np.ravel([ends[:, 0], ends[:, 1], np.full(len(cuts), top)], order="F")
    roofs, levels = np.append(roofs, edges[-1]), np.append(levels, levels[0])

    def joined(t: Array, _: int) -> Array:
        value: Array = np.interp(t, roofs, levels)
        for low, cut in zip(starts, cuts, strict=True):
            inside = (t >= low) & (t < low + cut.width)
            value[inside] = cut(t[inside] - low + cut.begin)
        return value[None]

    breaks = [cut.breaks - cut.begin + low for low, cut in zip(starts, cuts, strict=True)]
    best = longest_of_each(joined, np.concatenate([*breaks, roofs]), band, edges)
    for low, cut, dwell in zip(starts, cuts, best, strict=True):
        yield Window(dwell.start - low + cut.begin, dwell.length, dwell.least, dwell.greatest)


def _spans(output: Output, band: float) -> list[_Span]:
    """Disjoint spans that hold every window that may be the longest; none if they would be all of the period."""
    # blocks of about equal width, from node to node
    x, value, period = output.x, output.value, output.period
    count = min(BLOCKS, len(x) - 1)
    first = np.searchsorted(x, x[0] + period / count * np.arange(count))
    first = np.append(first[first < len(x) - 1], len(x) - 1)
    first = first[np.diff(first, prepend=-1) > 0]
    count = len(first) - 1
    # both ends of a block belong to it
    high = np.maximum(np.maximum.reduceat(value[:-1], first[:-1]), value[first[1:]])
    low = np.minimum(np.minimum.reduceat(value[:-1], first[:-1]), value[first[1:]])
    edge = np.concatenate([x[first[:-1]] - period, x[first[:-1]], x[first] + period])
    # the longest run that surely stays within the band; then runs that may stay within it and are as long
    block = count + np.arange(count)
    least = float((edge[block + _runs(low, high, band - 2.0 * output.slack)] - edge[block]).max())
    # a window that contains a block, but not the one before, begins in that and may end in the one after the run
    before, end = edge[block - 1], edge[np.minimum(block + _runs(low, high, band) + 1, len(edge) - 1)]
    long = end - before >= least
    spans: list[_Span] = []
    for columns in zip(*(column[long].tolist() for column in (before, edge[block], before + least, end)), strict=True):
        span = _Span(*columns)
        if spans and span.begin <= spans[-1].end:
            spans[-1] = spans[-1].joined(span)
        else:
            spans.append(span)
    if len(spans) > 1 and spans[0].begin + period <= spans[-1].end:  # the last runs on in the first
        spans[-1] = spans[-1].joined(spans[0].on(period))
        del spans[0]
    return spans if all(span.end - span.begin < period for span in spans) else []


def _runs(low: Array, high: Array, band: float) -> Indices:
    """Per block of a ring (m,): number (m,) of blocks from it on, at most all, whose values stay within the band."""
    count, begin = len(low), np.arange(len(low))
    lows, highs = doubled(np.tile(low, 2), np.minimum), doubled(np.tile(high, 2), np.maximum)
    runs, least, most = np.zeros(count, dtype=np.intp), np.full(count, np.inf), np.full(count, -np.inf)
    for level in range(count.bit_length() - 1, -1, -1):
        place = np.minimum(begin + runs, len(lows[level]) - 1)  # where this cuts off, the run is too long below
        further = np.minimum(least, lows[level][place]), np.maximum(most, highs[level][place])
        longer = (runs + 2**level <= count) & (further[1] - further[0] <= band)
        least, most = np.where(longer, further[0], least), np.where(longer, further[1], most)
        runs += longer * 2**level
    return runs
