"""From estimates to certified designs: the exact design of each one that a sweep keeps, the next where one falls."""

from __future__ import annotations

from collections import Counter
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sweep.figures import REASONS
from camgeo.capabilities.sweep.gather import Certificate, Nearest
from camgeo.capabilities.sweep.screen import estimates
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from camgeo.capabilities.sweep.ask import Ask
    from camgeo.capabilities.sweep.gather import Gathered
    from camgeo.recipe.limits import Limit
    from kin.numeric.arrays import Array, Indices, Mask

    Spread = Callable[[Callable[[int], "Exact"], Sequence[int]], Iterable[tuple[int, "Exact"]]]

_ROOM = 2.0  # times the greatest error measured: estimates that miss a bound by less are looked at too


class Exact(NamedTuple):
    """Figures of an exact design, and why it is not kept: a reason for having none, or the figure of a limit."""

    figures: dict[str, float]
    fault: str


def _room(name: str, value: float) -> float:
    """By how much an estimate of a figure near a value may be off."""
    estimate = estimates().get(name)
    error = None if estimate is None else estimate.error
    if estimate is None or error is None:
        return 0.0
    return _ROOM * error * (1.0 if estimate.in_degrees else abs(value))


def slack(limit: Limit) -> float:
    """By how much an estimate may miss a limit and is looked at all the same."""
    return max(_room(limit.figure, bound) for bound in (limit.at_least, limit.at_most) if bound is not None)


def error_of(name: str, estimate: float, exact: float) -> float:
    """By how much an estimate is off: in degrees of an angle, else as a share of the value."""
    if estimate == exact or np.isnan(estimate):
        return 0.0
    return abs(estimate - exact) / (1.0 if estimates()[name].in_degrees else max(abs(exact), 1e-300))


def certified(
    ask: Ask, found: Gathered, spread: Spread, apart: Callable[[Array, Array], Mask], tell: Callable[[int], None]
) -> Gathered:
    """The table with the exact figures of designs that hold in front.

    Designs are worked out in the order of their estimates, until as many hold as the sweep keeps; then, as many at the
    most, those whose estimates are as good as the last of these but for the error of an estimate. `apart` (n,) says of
    values (n, axes) which lie apart from a design (axes,); only such are kept. Where no design is within the limits the
    nearest one is looked at.
    """
    if not found.rows and (near := found.nearest) is not None:
        unknown = {name: np.full(1, np.nan) for name in found.figures}
        found = replace(found, index=np.array([near.index]), values=near.values[None], figures=unknown)
    left: Indices = np.arange(found.rows)
    more, seen = ask.sweep.keep, dict[int, Exact]()
    holding: list[int] = []
    while len(left):
        batch = left[: ask.sweep.keep - len(holding)]
        if not len(batch) and more:
            batch, more = _as_good(ask, found, left, [seen[place].figures for place in holding]), more - 1
        if not len(batch):
            break
        left = np.setdiff1d(left, batch)
        for place, exact in sorted(spread(partial(_exactly, ask, found), batch.tolist())):
            seen[place] = exact
            if not exact.fault and apart(found.values[holding], found.values[place]).all():
                holding.append(place)
                left = left[apart(found.values[left], found.values[place])]
                tell(min(len(holding), ask.sweep.keep))
    off = {name: max((_off(found, name, seen)), default=0.0) for name in found.figures}
    fell = Counter(exact.fault for exact in seen.values() if exact.fault)
    certificate = Certificate(len(holding), dict(sorted(fell.items())), off)
    nearest = None if holding else _nearest(ask, found, seen)
    return replace(_table(ask, found, seen, holding), nearest=nearest, certificate=certificate)


def _off(found: Gathered, name: str, seen: Mapping[int, Exact]) -> list[float]:
    return [
        error_of(name, float(found.figures[name][place]), exact.figures[name])
        for place, exact in seen.items()
        if exact.figures
    ]


def _as_good(ask: Ask, found: Gathered, left: Indices, holding: Sequence[Mapping[str, float]]) -> Indices:
    """The first of the places left, if it is estimated as good as the last of the designs that are kept so far."""
    rank, way = ask.ranking.rank, 1.0 if ask.ranking.most else -1.0
    worst = sorted(way * figures[rank] for figures in holding)[-ask.sweep.keep]
    better = ask.ranking.score(found.figures)[left] >= worst - _room(rank, worst)
    first: Indices = left[better][:1]
    return first


def _exactly(ask: Ask, found: Gathered, place: int) -> Exact:
    """The exact design at a place of the table."""
    computed = ask.exactly(found.values[[place]])
    if computed.reason[0]:
        return Exact({}, REASONS[computed.reason[0]])
    figures = {name: computed.figures[name] for name in found.figures}
    broken = [limit.figure for limit in ask.ranking.limits if not ask.ranking.held(limit, figures)[0]]
    return Exact({name: float(column[0]) for name, column in figures.items()}, broken[0] if broken else "")


def _nearest(ask: Ask, found: Gathered, seen: Mapping[int, Exact]) -> Nearest | None:
    """Of designs that were worked out and do not hold the one that misses the limits by least."""
    nearest, missed = None, np.inf
    for place, exact in seen.items():
        figures = {name: np.array([value]) for name, value in exact.figures.items()}
        misses = [float(ask.ranking.miss(limit, figures)[0]) for limit in ask.ranking.limits if figures]
        if misses and max(misses) < missed:
            missed = max(misses)
            worst = ask.ranking.limits[misses.index(missed)]
            index, values = int(found.index[place]), found.values[place]
            nearest = Nearest(index, values, worst, exact.figures[worst.figure])
    return nearest if nearest is not None else found.nearest


def _table(ask: Ask, found: Gathered, seen: Mapping[int, Exact], holding: Sequence[int]) -> Gathered:
    """The designs that hold, best first, and behind them others whose estimates keep the limits."""
    figures = {name: column.copy() for name, column in found.figures.items()}
    inside = np.ones(found.rows, dtype=np.bool_)
    for limit in ask.ranking.limits:
        inside &= ask.ranking.held(limit, found.figures)
    for place in holding:
        for name, value in seen[place].figures.items():
            figures[name][place] = value
    score = ask.ranking.score(figures)
    first = sorted(holding, key=lambda place: (-score[place], found.index[place]))
    behind = [place for place in range(found.rows) if (inside[place] if place not in seen else not seen[place].fault)]
    order = np.array([*first, *(place for place in behind if place not in holding)], dtype=np.int64)
    fallen = sum(bool(inside[place]) for place, exact in seen.items() if exact.fault)
    gained = sum(not inside[place] for place in holding)
    return replace(
        found,
        counts=replace(found.counts, kept=found.counts.kept - fallen + gained),
        index=found.index[order],
        values=found.values[order],
        figures={name: column[order] for name, column in figures.items()},
    )
