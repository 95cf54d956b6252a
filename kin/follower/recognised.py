"""The motion that a part gives its follower as a programme: dwells, and strokes each by the law that fits it best.

Nothing is asked but positions at equal shaft angles (`Moved`). Dwells are stretches that rest within a reading;
between them, and between turning points, are strokes. Boundaries and levels are fitted together by least squares: first
each stroke alone, by every law of the catalogue, then all at once by the best ones. What is left is form rather than
noise, with as many independent values as it changes its sign: its scatter gives the uncertainties. Long waves of the
metal's form are in part taken for motion, which no scatter shows: `Hidden` has how much of them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.follower.measured import MeasuredMotion
from kin.law.sources.laws import NAMES, named
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.follower.measured import MeasuredDwell
    from kin.law.contacts import Unit
    from kin.law.normalised import Law
    from kin.numeric.arrays import Array, Indices

COVERAGE = 2.0  # standard deviations: about 95 % (GUM)
MOST_WAVES = 4  # a turn, of forms that may be taken for motion: shorter waves stand out of it
ROUNDS = 25  # of Gauss and Newton
SETTLED = 1e-9  # of a turn, and of the stroke: a step that changes nothing
DIFFERENCE = 1e-6  # rad, and of the stroke: of numerical derivatives
ENDS_STEP = 1e-4  # rad: of numerical derivatives by the ends of one stroke
SHORTEST = 1e-3  # rad: no stroke is fitted shorter
NEARLY = 1.5  # times the least residual: laws that fit no worse are named too
LEAST_STROKE = 4.0  # readings: the least height of a stroke at a turning point


class Moved(Protocol):
    """A motion of which nothing is known but positions, mm or rad, at equal shaft angles, rad."""

    @property
    def turn(self) -> Array:
        """Position at equal shaft angles of a turn."""
        ...

    @property
    def position(self) -> Array:
        """The same at equal shaft angles (k,) of the `span`."""
        ...

    @property
    def shaft(self) -> Array:
        """These shaft angles (k,)."""
        ...

    @property
    def span(self) -> float:
        """Part of the turn, from angle 0 on, by which the motion is told."""
        ...

    @property
    def last(self) -> float:
        """Position at the end of the span."""
        ...

    @property
    def closed(self) -> bool:
        """Whether the span is a whole turn."""
        ...

    @property
    def spans(self) -> int:
        """Most independent values of what is left, in the span."""
        ...

    @property
    def sd(self) -> float:
        """Standard deviation of the position."""
        ...

    @property
    def zero_ends(self) -> bool:
        """Whether a part of a turn begins and ends at 0."""
        ...

    def alike(self, most: int, /) -> tuple[int, ...]:
        """Numbers of waves a turn, up to `most`, that motion and a form error of the part share."""
        ...


@dataclass(frozen=True, eq=False)
class WholeTurn:
    """A motion by its positions (n,), mm or rad, at equal steps of a turn, and their standard deviation `sd`.

    What laws leave of it may have half as many independent values as there are positions.
    """

    position: Array
    sd: float
    span: float = TURN
    closed: bool = True
    zero_ends: bool = False

    @property
    def turn(self) -> Array:
        """Positions (n,) over the turn."""
        return self.position

    @property
    def shaft(self) -> Array:
        """Shaft angles (n,), rad."""
        return equal_steps(len(self.position))

    @property
    def last(self) -> float:
        """Position at the end of the turn."""
        return float(self.position[0])

    @property
    def spans(self) -> int:
        """Most independent values of what laws leave."""
        return len(self.position) // 2

    def alike(self, most: int, /) -> tuple[int, ...]:
        """All numbers of waves up to `most`."""
        return tuple(range(1, most + 1))


class Stroke(NamedTuple):
    """A stroke by a `law` between two boundaries and two levels of a programme.

    `first` and `last` are indices of its boundaries, `low` and `high` those of its first and last level: a fall has the
    lower level last. `others` are laws that fit nearly as well, `residual` the root mean square of measured less law,
    mm or rad.
    """

    first: int
    last: int
    low: int
    high: int
    law: str
    others: tuple[str, ...]
    residual: float


class Hidden(NamedTuple):
    """How much of a form deviation a fitted programme takes for motion, at the number of waves where that is the most.

    waves       number of its waves in a turn
    share       of its height that is taken for motion, at the phase where that is the most; the rest is in the residual
    boundaries  (m,), rad, how far a form of height 1 (mm or rad) moves each, at its worst phase
    levels      (k,), the same of levels
    """

    waves: int
    share: float
    boundaries: Array
    levels: Array


@dataclass(frozen=True, eq=False)
class Programme:
    """A motion as strokes with dwells between; mm or rad, angles rad.

    boundaries (m,)   shaft angles at which strokes begin and end, in the order of the turn
    levels (k,)       positions at which strokes begin and end
    strokes           in order
    uncertainty       expanded (k = 2), of boundaries and of levels, from the residual
    hidden            further uncertainty by a form deviation that the residual does not show
    residual (n,)     measured position less the programme's
    """

    boundaries: Array
    levels: Array
    strokes: tuple[Stroke, ...]
    uncertainty: tuple[Array, Array]
    hidden: Hidden
    residual: Array

    @property
    def greatest(self) -> float:
        """Greatest |residual|, mm or rad."""
        return float(np.abs(self.residual).max())

    def written(self, motion: Moved, boundaries: Array, levels: Array) -> Programme:
        """The programme with other boundaries (m,), rad, and levels (k,), and its residual from `motion`."""
        residual = motion.position - _model(motion.shaft, boundaries, levels, self.strokes)
        return replace(self, boundaries=boundaries, levels=levels, residual=residual)


def recognised(motion: Moved, reading: float, unit: Unit) -> Programme | None:
    """Programme of dwells and strokes that a measured motion follows; None for a motion without strokes.

    A dwell is a stretch of at least 10 degrees that stays within `reading`, mm or rad; `unit` is that of the follower's
    motion.
    """
    places = _places(motion, reading, unit)
    if len(places) < 2:  # a turn of one level
        return None
    boundaries = np.array([end for begin, end, _ in places for end in ((begin, end) if end > begin else (begin,))])
    levels = np.array([level for _, _, level in places])
    strokes, at = [], 0
    for k, (begin, end, _) in enumerate(places if motion.closed else places[:-1]):
        at += int(end > begin)
        strokes.append(Stroke(at, (at + 1) % len(boundaries), k, (k + 1) % len(places), "", (), 0.0))
        at += 1
    laws = tuple(_by_law(motion, stroke, boundaries, levels, places) for stroke in strokes)
    rough = _fitted(motion, boundaries, levels, laws)
    laws = tuple(_by_law(motion, stroke, rough.boundaries, rough.levels, places) for stroke in strokes)
    return _fitted(motion, rough.boundaries, rough.levels, laws)


def _places(motion: Moved, reading: float, unit: Unit) -> list[tuple[float, float, float]]:
    """Dwells, and turning points between them as dwells of no length: begin, end, level; in order.

    A part of a turn has its ends among them.
    """
    position, shaft, least = motion.position, motion.shaft, LEAST_STROKE * reading
    places = _rests(motion, reading, unit)
    if motion.closed:
        if not places:
            lowest = int(np.argmin(position))
            places = [(float(shaft[lowest]), float(shaft[lowest]), float(position[lowest]))]
    else:
        if not places or places[0][0] > 0.0:
            places.insert(0, (0.0, 0.0, float(position[0])))
        if places[-1][1] < motion.span:
            places.append((motion.span, motion.span, motion.last))
    turns = []
    for k, (_, end, level) in enumerate(places if motion.closed else places[:-1]):
        following = places[(k + 1) % len(places)][0]
        length = (following - end) % TURN or TURN
        inside = np.flatnonzero((np.mod(shaft - end, TURN) > 0.0) & (np.mod(shaft - end, TURN) < length))
        inside = inside[np.argsort(np.mod(shaft[inside] - end, TURN))]
        turns += _turns(position, shaft, inside, level, least)
    return sorted(places + turns, key=lambda place: place[0] % TURN)


def dwells_of(position: Array, reading: float, unit: Unit) -> list[MeasuredDwell]:
    """Dwells, in the order of the turn, of positions (n,), mm or rad, at equal steps that rest within a reading."""
    nothing = np.zeros(len(position))
    rows, ends = np.stack([position, nothing, nothing]), (float(position.min()), 0.0)
    shaft, most = equal_steps(len(position)), (float(position.max()), 0.0)
    return MeasuredMotion(unit, shaft, rows, nothing, nothing, ends, most).dwells(reading)


def _rests(motion: Moved, reading: float, unit: Unit) -> list[tuple[float, float, float]]:
    """Stretches that rest within a reading: begin, end, level, those that lie in the span of the motion."""
    rests = [(rest.begin, rest.end, rest.level) for rest in dwells_of(motion.turn, reading, unit)]
    if motion.closed:
        return rests
    parts = [
        (max(begin - turn, 0.0), min(end - turn, motion.span), level)
        for begin, end, level in rests
        for turn in (0.0, TURN)
    ]
    return sorted(part for part in parts if part[1] - part[0] > TURN / len(motion.turn))


def _turns(
    position: Array, shaft: Array, inside: Indices, level: float, least: float
) -> list[tuple[float, float, float]]:
    """Turning points of a stretch that begins at a level: extremes from which it comes back by `least`."""
    turns, best, rising = [], None, 0
    last = level
    for i in inside.tolist():
        here = float(position[i])
        if rising == 0:
            if abs(here - last) >= least:
                rising, best = (1 if here > last else -1), i
            continue
        if best is None or (here - position[best]) * rising >= 0.0:
            best = i
        elif (position[best] - here) * rising >= least:
            turns.append((float(shaft[best]), float(shaft[best]), float(position[best])))
            rising, best = -rising, i
    return turns


def _law_of(name: str, u: Array, *, falls: bool) -> Array:
    """Displacement (n,), from 0 to 1, of a law at shares u (n,) of its stroke; a fall runs it backwards."""
    law: Law = named(name)
    share = np.clip(u, 0.0, 1.0)
    moved: Array = law.derivatives(1.0 - share if falls else share, 0)[0]
    return 1.0 - moved if falls else moved


def _model(shaft: Array, boundaries: Array, levels: Array, strokes: Sequence[Stroke]) -> Array:
    """Position (n,), mm or rad, of a programme at shaft angles (n,), rad."""
    position = np.empty_like(shaft)
    for k, stroke in enumerate(strokes):
        following = strokes[(k + 1) % len(strokes)]
        begin = boundaries[stroke.first]
        length = np.mod(boundaries[stroke.last] - begin, TURN) or TURN
        reach = np.mod(boundaries[following.first] - begin, TURN) or TURN
        away = np.mod(shaft - begin, TURN)
        own = away <= reach
        low, high = levels[stroke.low], levels[stroke.high]
        moved = _law_of(stroke.law, away[own] / length, falls=bool(high < low))
        position[own] = low + (high - low) * moved
    if strokes[0].low != strokes[-1].high:  # a part of a turn, at whose end it is not where it began
        position[shaft < boundaries[strokes[0].first]] = levels[strokes[0].low]
    return position


def _by_law(
    motion: Moved, stroke: Stroke, boundaries: Array, levels: Array, places: Sequence[tuple[float, float, float]]
) -> Stroke:
    """The stroke with the law of least residual; each law is fitted with free levels, and free ends beside dwells."""
    before, after = places[stroke.low], places[stroke.high]
    begin, end = boundaries[stroke.first], boundaries[stroke.last]
    length = np.mod(end - begin, TURN) or TURN
    lead, tail = (0.5 * (place[1] - place[0]) for place in (before, after))
    away = np.mod(motion.shaft - begin + lead, TURN)
    own = away <= lead + length + tail
    shaft, position = away[own] - lead, motion.position[own]
    free = np.array([lead > 0.0, tail > 0.0])
    falls = bool(levels[stroke.high] < levels[stroke.low])
    residuals = {}
    for name in NAMES:

        def off(ends: Sequence[Array], name: str = name) -> list[Array]:
            # the law is evaluated once for all: its calls are what takes long
            u = [(shaft - begin) / max(float(end - begin), SHORTEST) for begin, end in ends]
            found = []
            for moved in np.split(_law_of(name, np.concatenate(u), falls=falls), len(u)):
                columns = np.column_stack([1.0 - moved, moved])
                level = np.linalg.lstsq(columns, position, rcond=None)[0]
                found.append(position - columns @ level)
            return found

        # Gauss and Newton over the free ends; levels follow linearly
        ends = np.array([0.0, length])
        (here,) = off([ends])
        for _ in range(ROUNDS if free.any() else 0):
            steps = ENDS_STEP * np.eye(2)[free]
            sides = off([*(ends + steps), *(ends - steps)])
            rises = [more - less for more, less in zip(sides[: len(steps)], sides[len(steps) :], strict=True)]
            change = np.zeros(2)
            change[free] = np.linalg.lstsq(np.column_stack(rises) / (2.0 * ENDS_STEP), -here, rcond=None)[0]
            change = np.clip(change, -0.1 * length, 0.1 * length)
            (new,) = off([ends + change])
            if not float(new @ new) < float(here @ here):
                break
            ends, here = ends + change, new
            if float(np.abs(change).max()) < SETTLED * TURN:
                break
        residuals[name] = math.sqrt(float(here @ here) / len(here))
    order = sorted(residuals, key=lambda name: residuals[name])
    best = residuals[order[0]]
    others = tuple(name for name in order[1:] if residuals[name] <= NEARLY * max(best, motion.sd))
    return stroke._replace(law=order[0], others=others, residual=best)


def _fitted(motion: Moved, boundaries: Array, levels: Array, strokes: tuple[Stroke, ...]) -> Programme:
    """Fit boundaries and levels all at once, by Gauss and Newton; the ends of a part of a turn stay where they are."""
    m, stroke_height = len(boundaries), float(np.ptp(levels))
    values = np.concatenate([boundaries, levels])
    scale = np.concatenate([np.ones(m), np.full(len(levels), stroke_height)])
    held = np.zeros(len(values), dtype=bool)
    if not motion.closed:
        held[:m] = (boundaries == 0.0) | (boundaries == motion.span)
        held[[m, -1]] = motion.zero_ends
        values[m:][held[m:]] = 0.0
    free = np.flatnonzero(~held)

    def off(at: Array) -> Array:
        residual: Array = motion.position - _model(motion.shaft, at[:m], at[m:], strokes)
        return residual

    def slopes(at: Array) -> Array:
        columns = []
        for k in free:
            step = np.zeros(len(at))
            step[k] = DIFFERENCE * scale[k]
            columns.append((off(at + step) - off(at - step)) / (2.0 * DIFFERENCE))
        return np.column_stack(columns)

    here = off(values)
    for _ in range(ROUNDS):
        change = np.zeros(len(values))
        change[free] = np.linalg.lstsq(slopes(values), -here, rcond=None)[0]
        share = 1.0
        while share > SETTLED:
            new = off(values + share * change * scale)
            if float(new @ new) < float(here @ here):
                break
            share *= 0.5
        else:
            break
        values, here = values + share * change * scale, new
        if float(np.abs(change).max()) < SETTLED:
            break
    # uncertainty from the residual, by its number of independent values
    columns = slopes(values)
    independent = int(np.count_nonzero(np.sign(here) != np.sign(np.roll(here, 1))))  # waves count by their half waves
    beyond = max(min(independent, motion.spans) - len(free), 1)
    expanded = np.zeros(len(values))
    covariance = float(here @ here) / beyond * np.linalg.pinv(columns.T @ columns)
    expanded[free] = COVERAGE * np.sqrt(np.diag(covariance)) * scale[free]
    hidden = _hidden(motion, columns, free, scale, m)
    return Programme(values[:m], values[m:], strokes, (expanded[:m], expanded[m:]), hidden, here)


def _hidden(motion: Moved, columns: Array, free: Indices, scale: Array, boundaries: int) -> Hidden:
    """How much of a form of few waves a turn f unknowns, whose columns are (n, f), take for motion: of the worst one.

    `free` (f,) are their indices among all unknowns: as many boundaries as `boundaries` says, then levels. `scale` has
    for each of all unknowns the step, rad or mm, to which its column belongs.
    """
    base, _ = np.linalg.qr(columns)
    most: Hidden | None = None
    for waves in motion.alike(MOST_WAVES):  # numbers of waves that motion and form may share
        form = np.column_stack([np.cos(waves * motion.shaft), np.sin(waves * motion.shaft)])
        share = float(np.linalg.norm(base.T @ np.linalg.qr(form)[0], 2))
        if most is None or share > most.share:
            moved = np.zeros(len(scale))
            moved[free] = np.linalg.norm(np.linalg.lstsq(columns, form, rcond=None)[0], axis=1) * scale[free]
            most = Hidden(waves, share, moved[:boundaries], moved[boundaries:])
    assert most is not None
    return most
