"""A programme of segments: rises, returns, dwells, absolute strokes, matched segments, formulas, one after another."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.law.normalised import IntentError, Law
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Constant, Stretch
from kin.law.sources.functions import RiseFall, TwoPoint
from kin.law.sources.motion import Motion, joined
from kin.numeric.lengths import INPUT, input_number, input_words
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.formula.formula import Formula
    from kin.numeric.arrays import Array


_ANGLE_TOLERANCE = 1e-9  # rad: of the sum of a programme's segments, and the least segment
_START = 1e-12  # of a formula's greatest value: a value at u = 0 below this is rounding


@dataclass(frozen=True)
class JointState:
    """Velocity, acceleration and jerk at a joint, in mm or rad per rad, rad^2 and rad^3."""

    v: float = 0.0
    a: float = 0.0
    j: float = 0.0


@dataclass(frozen=True)
class Matched:
    """Law of a segment, 5 or 7 in degree, that takes v and a (degree 7: and j) from its neighbours, or from `at_*`.

    Of two matched segments in a row one must give the state between them; v = 0 with an acceleration there is the quick
    return (VDI 2143, motions R, G, U, B).
    """

    degree: int = 5
    at_start: JointState | None = None
    at_end: JointState | None = None


@dataclass(frozen=True)
class Dwell:
    """A dwell of the programme: the shaft angle that it takes, rad."""

    over: float


@dataclass(frozen=True)
class Move:
    """A stroke over the angle `over`, rad: either the signed stroke `by` or the absolute displacement `to`."""

    over: float
    law: Law | Matched
    by: float | None = None
    to: float | None = None


@dataclass(frozen=True)
class RiseAndFall:
    """Up by `by`, mm or rad, and back again over the angle `over`, rad, by the polynomial 3-4-5-6."""

    over: float
    by: float


@dataclass(frozen=True)
class Given:
    """Displacement from the segment's start: `scale` times a formula f(u), u from 0 to 1 over the angle `over`, rad."""

    over: float
    formula: Formula
    scale: float = 1.0


Step = Dwell | Move | RiseAndFall | Given


@dataclass()
class _Part:
    """A segment in the making, over [begin, end], rad, from `level` to `level + by`; `built` once it is known."""

    field: str
    step: Step
    begin: float
    end: float
    level: float = 0.0
    by: float = 0.0
    built: Piecewise | None = None

    def lay(self, knots: Sequence[float], functions: Sequence[Stretch]) -> None:
        self.built = Piecewise(np.array(knots), tuple(functions))


def programme(segments: Sequence[Step], total: float, *, around: int | None = 1, field: str = "motion") -> Motion:
    """Join segments into a motion over [0, total] rad.

    With `around` 1 the motion repeats; with -1 it goes on as S(total) - S(t - total); with None it does not go on. A
    matched segment at an end matches its neighbour beyond it, or rest where `around` is None. Raises IntentError if
    there is no segment or the angles do not sum to `total` within 1e-9 rad, for a segment without angle or stroke, a
    formula that does not exist or begin at 0, a degree other than 5 and 7, and where two matched segments meet with no
    state given. Jumps of velocity are no errors here: `Motion.joints` has them.
    """
    if not segments:
        raise IntentError("a motion needs at least one segment", field)
    for i, segment in enumerate(segments):
        if not (math.isfinite(segment.over) and segment.over > _ANGLE_TOLERANCE):
            stated, least = input_words(segment.over), input_number(_ANGLE_TOLERANCE, ".1g")
            problem = f"the {INPUT} of a segment must be above 0, not {stated}"
            if segment.over > 0.0:
                problem = f"the {INPUT} of a segment, {stated}, is as good as none; give {least} or more"
            raise IntentError(problem, f"{field}[{i}]")
    covered = math.fsum(segment.over for segment in segments)
    if not abs(covered - total) <= _ANGLE_TOLERANCE:
        raise IntentError(
            f"the segments cover {input_words(covered, '.10g')}, {input_number(total, '.10g')} are wanted", field
        )
    # all but matched segments first, then these between their neighbours
    ends = [math.fsum(segment.over for segment in segments[:i]) for i in range(len(segments))] + [total]
    parts: list[_Part] = []
    strokes: list[float] = []
    for i, (step, (begin, end)) in enumerate(zip(segments, pairwise(ends), strict=True)):
        part = _Part(f"{field}[{i}]", step, begin, end, level=math.fsum(strokes))
        _build(part)
        strokes.append(part.by)
        parts.append(part)
    for i, part in enumerate(parts):
        if part.built is None:
            _match(parts, i, around)
    knots: list[float] = [0.0]
    functions: list[Stretch] = []
    for part in parts:
        assert part.built is not None
        functions += part.built.functions
        knots += part.built.knots[1:].tolist()
    return joined(knots, functions, around)


def _build(part: _Part) -> None:
    """Set the stroke of a segment, and its stretches unless it is matched."""
    step, begin, end = part.step, part.begin, part.end
    if isinstance(step, Dwell):
        part.lay([begin, end], [Constant(part.level)])
    elif isinstance(step, RiseAndFall):
        _demand_stroke(step.by, part.field)
        moved = AffineStretch(RiseFall(), offset=part.level, scale=step.by, start=begin, width=end - begin)
        part.lay([begin, end], [moved])
    elif isinstance(step, Given):
        _formula(part, step)
    else:
        part.by = _stroke(step, part)
        if isinstance(step.law, Law):
            _lay_law(part, step.law)


def _stroke(step: Move, part: _Part) -> float:
    if (step.by is None) == (step.to is None):
        raise IntentError("a segment has either a stroke or an absolute displacement", part.field)
    by = step.by if step.by is not None else step.to - part.level  # type: ignore[operator]
    if step.to is not None and abs(by) <= 1e-12 * max(abs(step.to), abs(part.level)):
        raise IntentError("the motion is there already; write a dwell", f"{part.field}.to")
    _demand_stroke(by, part.field)
    return by


def _demand_stroke(by: float, field: str) -> None:
    if not (math.isfinite(by) and by != 0.0):
        raise IntentError(f"the stroke of a segment must be a number other than 0, not {by:.6g}", field)


def _lay_law(part: _Part, law: Law) -> None:
    begin, width = part.begin, part.end - part.begin
    motion, u = law.motion, law.motion.knots[1:-1].tolist()
    if part.by < 0 and law.reverses:  # s(1 - u), from the foot of the return
        place = {"offset": part.level + part.by, "scale": -part.by, "start": part.end, "width": -width}
        functions = [AffineStretch.of(f, **place) for f in reversed(motion.functions)]
        part.lay([begin, *(part.end - x * width for x in reversed(u)), part.end], functions)
        return
    place = {"offset": part.level, "scale": part.by, "start": begin, "width": width}
    part.lay(
        [begin, *(begin + x * width for x in u), part.end], [AffineStretch.of(f, **place) for f in motion.functions]
    )


def _formula(part: _Part, step: Given) -> None:
    from kin.law.sources.whole_turn import pieces_of

    field = f"{part.field}.displacement"
    knots, functions = pieces_of(step.formula, 0.0, 1.0, field, "u")
    whole = Piecewise(np.array(knots), tuple(functions))
    ends = step.scale * whole.derivatives(np.array([0.0, 1.0]), 0, np.array([1, -1]))[0]
    size = step.scale * np.abs(whole.derivatives(np.linspace(0.0, 1.0, 33), 0)[0]).max()
    if abs(ends[0]) > _START * size:
        raise IntentError(
            f"a displacement counts from the segment's start: f(0) must be 0, not {ends[0] / step.scale:.6g}", field
        )
    width = part.end - part.begin
    place = {"offset": part.level, "scale": step.scale, "start": part.begin, "width": width}
    inner = [part.begin + u * width for u in knots[1:-1]]
    part.lay([part.begin, *inner, part.end], [AffineStretch.of(f, **place) for f in functions])
    part.by = float(ends[1])


def _match(parts: Sequence[_Part], i: int, around: int | None) -> None:
    """Lay a matched segment between the states of its neighbours, or the given ones."""
    part = parts[i]
    step = part.step
    assert isinstance(step, Move)
    assert isinstance(step.law, Matched)
    if step.law.degree not in (5, 7):
        raise IntentError(f"a matched segment has degree 5 or 7, not {step.law.degree}", f"{part.field}.law")
    order = (step.law.degree - 1) // 2
    width = part.end - part.begin
    scales = np.array([width**k for k in range(1, order + 1)])
    start, end = (_state(parts, i, way, around)[:order] * scales for way in (-1, 1))
    function = TwoPoint.of((0.0, *start.tolist()), (part.by, *end.tolist()))
    part.lay([part.begin, part.end], [AffineStretch(function, offset=part.level, start=part.begin, width=width)])


def _state(parts: Sequence[_Part], i: int, way: int, around: int | None) -> Array:
    """Velocity, acceleration and jerk (3,) at the start (`way` -1) or end (1) of the matched segment i."""
    stated = _matched_state(parts[i], way)
    if stated is not None:
        return stated
    # else from the neighbour, across the end of the motion too, where its sense may change
    sign, n = 1.0, i + way
    if not 0 <= n < len(parts):
        if around is None:
            return np.zeros(3)
        sign, n = float(around), n % len(parts)
    neighbour = parts[n]
    if neighbour.built is not None and not _is_matched(neighbour):
        at, side = (neighbour.end, -1) if way < 0 else (neighbour.begin, 1)
        return sign * neighbour.built.derivatives(at, 3, side)[1:, 0]
    state = _matched_state(neighbour, -way)
    if state is None:
        first = parts[i] if way > 0 else neighbour
        where = math.degrees(first.end)
        which = "the last entry" if first is parts[-1] else "the first one"
        problem = f"two matched segments meet at {input_words(first.end)}: give {which} `at_end: {{v: ..., a: ...}}`"
        if neighbour is parts[i]:
            problem = "a matched segment that stands alone has no neighbour to match: "
            problem += "add one, such as a dwell" if around == 1 else "add one, or give it `at_end: {v: 0, a: 0}`"
        raise IntentError(problem, first.field, where)
    return sign * state


def _is_matched(part: _Part) -> bool:
    return isinstance(part.step, Move) and isinstance(part.step.law, Matched)


def _matched_state(part: _Part, way: int) -> Array | None:
    """State (3,) given for the start (`way` -1) or end (1) of a matched segment; None without one."""
    if not (isinstance(part.step, Move) and isinstance(part.step.law, Matched)):
        return None
    state = part.step.law.at_start if way < 0 else part.step.law.at_end
    return None if state is None else np.array([state.v, state.a, state.j])
