"""Whether a mechanism turns: how far its loops are from binding, and the least rate of the shaft over the cam's angle.

Two things stop a mechanism: a loop that cannot be closed (AS: a negative discriminant), and a shaft that would have to
turn back, phi' = 1 - theta_3' < 0, which the papers leave out. The second comes first: close to where a loop binds the
frame turns faster than any bound, one way or the other.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.monotone import (
    SAME,
    Cells,
    MonotonePieces,
    RoughError,
    between,
    cells,
    extremes,
    extremes_of_each,
    pieces,
)
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.numeric.arrays import Array

__all__ = ["Mobility", "Span", "mobility"]

Span = tuple[float, float]

_RESOLUTION = 1e-12  # of margins, as a part of the breadth; of the rate of the shaft, which is 1 on average
# Spans begin and end this close to where a loop binds; there the rate of the shaft has no bound.
_BESIDE = 1e-9


@dataclass(frozen=True)
class Mobility:
    """Where and by how much a mechanism binds or turns back; angles are relative ones, rad.

    margin      least distance from binding of any loop, mm, negative or lost in rounding where one binds; loops after
                a binding one are not looked at
    margin_at   relative angle of that, in [0, 2 pi)
    loop        which loop it is: 0 the linkage, k the k-th dyad
    binds       spans (from, to) in which that loop cannot be closed; those that run through 0 end beyond 2 pi
    least_rate  least 1 - theta_3'; nan where the linkage binds, which leaves no least, or comes so close to binding
                that the rate is lost in rounding
    rate_at     relative angle of that, in [0, 2 pi); nan where the linkage binds
    reverses    spans in which the shaft would turn back, as far as the linkage can be closed
    nearest     of each loop, up to the first that binds, the angles at which it is nearest to each of its limits
    """

    margin: float
    margin_at: float
    loop: int
    binds: tuple[Span, ...]
    least_rate: float
    rate_at: float
    reverses: tuple[Span, ...]
    nearest: tuple[tuple[float, ...], ...]

    @property
    def turns(self) -> bool:
        """Whether the cam can be turned right round by its shaft."""
        return not self.binds and self.least_rate > 0


def mobility(
    margins: Sequence[Callable[[Array], Array]],
    rate: Callable[[Array], Array],
    sense: Callable[[Array], Array],
    breaks: Array,
    breadth: float,
) -> Mobility:
    """Where a mechanism binds or turns back, from the margins of its loops and the rate of the shaft all round.

    `margins` give the distances of a loop from its limits, mm (k, n), at relative angles (n,), each called only where
    those before it do not bind; `rate` gives 1 - theta_3', called only where the linkage does not bind anywhere;
    `sense` is a bounded function of the same sign, called where the linkage can be closed. `breaks` (m,) are relative
    angles at which derivatives jump, `breadth`, mm, is the frame's. Raises RoughError where no polynomials follow a
    margin.
    """
    # the loops in order, until one binds
    nearest_binding: tuple[float, float, int] = (math.inf, math.nan, 0)
    binds: tuple[Span, ...] = ()
    nearest: tuple[tuple[float, ...], ...] = ()
    for loop, margin in enumerate(margins):
        curve = _all_round(margin, breaks, _RESOLUTION * breadth)
        places = [least for least, _ in extremes_of_each(curve)]
        nearest += (tuple(at for _, at in places),)
        for limit, (noise, (least, at)) in enumerate(zip(curve.noise, places, strict=True)):
            if least < nearest_binding[0]:
                nearest_binding = (least, at % TURN, loop)
            # a least margin lost in rounding binds too, all over where the margin is within four roundings of 0
            rounding = float(noise.min())
            if least <= rounding:
                binds += _below(pieces(curve, limit), 0.0 if least < -2 * rounding else 4 * rounding)
        if binds:
            binds = _merged(sorted(binds))
            break
    # where the linkage itself binds, the rate has no bound beside that: only its sign is sought between
    if binds and nearest_binding[2] == 0:
        free = _others(binds)
        reverses = tuple(_reduced(span) for begin, end in free for span in _reversing(sense, begin, end, breaks))
        return Mobility(*nearest_binding, binds, math.nan, math.nan, reverses, nearest)
    try:
        curve = _all_round(lambda theta: rate(theta)[None], breaks, _RESOLUTION)
    except RoughError as error:
        return Mobility(*nearest_binding, binds, math.nan, error.at % TURN, (), nearest)
    (least, at), _ = extremes(curve)
    return Mobility(
        *nearest_binding, binds, least, at % TURN, _below(pieces(curve), 0.0) if least <= 0.0 else (), nearest
    )


def _all_round(f: Callable[[Array], Array], breaks: Array, resolution: float) -> Cells:
    return cells(f, between(0.0, TURN, breaks.tolist()), resolution)


def _below(pieces: MonotonePieces, level: float) -> tuple[Span, ...]:
    """Spans of a turn in which a function is at or below a level."""
    places = pieces.crossings_round(level).tolist()
    if not places:
        return ((0.0, TURN),) if pieces.values[0] <= level else ()
    ends = np.array([*places, places[0] + TURN])
    middle = np.mod(0.5 * (ends[:-1] + ends[1:]), TURN)
    piece = np.clip(np.searchsorted(pieces.x, middle, side="right") - 1, 0, len(pieces.coefficients) - 1)
    low = pieces.at(piece, middle) <= level
    return _merged([(float(a), float(b)) for a, b, inside in zip(ends[:-1], ends[1:], low, strict=True) if inside])


def _merged(spans: list[Span]) -> tuple[Span, ...]:
    """Join spans that meet, rising, the last with the first among them."""
    joined: list[Span] = []
    for begin, end in spans:
        if joined and begin - joined[-1][1] <= SAME:
            joined[-1] = (joined[-1][0], end)
        else:
            joined.append((begin, end))
    if len(joined) > 1 and joined[0][0] + TURN - joined[-1][1] <= SAME:
        begin, _ = joined.pop()
        joined[0] = (begin, joined[0][1] + TURN)
        joined.append(joined.pop(0))
    return tuple(joined)


def _reduced(span: Span) -> Span:
    turns = math.floor(span[0] / TURN) * TURN
    return span[0] - turns, span[1] - turns


def _others(spans: tuple[Span, ...]) -> list[Span]:
    """Spans between the given ones, a little narrower."""
    ends = [*spans, (spans[0][0] + TURN, math.nan)]
    free = [(a[1] + _BESIDE, b[0] - _BESIDE) for a, b in pairwise(ends)]
    return [(begin, end) for begin, end in free if begin < end]


def _reversing(sense: Callable[[Array], Array], begin: float, end: float, breaks: Array) -> list[Span]:
    """Spans between two relative angles in which `sense` is not above 0: there the shaft would turn back."""
    places = between(begin, end, [*breaks.tolist(), *(breaks + TURN).tolist()])
    curve = pieces(cells(lambda x: sense(np.mod(x, TURN))[None], places, 1e-9))
    ends = np.array([begin, *curve.crossings(0.0).tolist(), end])
    middle = 0.5 * (ends[:-1] + ends[1:])
    piece = np.clip(np.searchsorted(curve.x, middle, side="right") - 1, 0, len(curve.coefficients) - 1)
    back = curve.at(piece, middle) <= 0
    return [(float(a), float(b)) for a, b, turned in zip(ends[:-1], ends[1:], back, strict=True) if turned and b > a]
