"""Motions from samples: rows between dwells are fitted stretch by stretch, and the stretches laid round the turn."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.law.normalised import IntentError
from kin.law.segment import AffineStretch, Constant, Stretch, moved
from kin.law.sources.motion import Motion, joined
from kin.law.sources.spline import Ends
from kin.numeric.lengths import INPUT, input_number, input_words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array


SAME_ANGLE = 1e-9  # rad: angles that differ by less are equal
_FOLDED = 1e-13  # rad: greatest rounding of folding by a turn


class Samples(NamedTuple):
    """Angles (rad, rising), displacements, and the line of each in its file, each (n,).

    `unit` is one unit of the file's displacements, in mm or rad, for messages. `slack`, rad, is the greatest rounding
    error of an angle as written; `turned` is the number of the file's units of angle in a degree. `rounding` is the
    greatest rounding error of each displacement as written, (n,), or one for all.
    """

    theta: Array
    s: Array
    lines: NDArray[np.intp]
    unit: float = 1.0
    slack: float = 0.0
    turned: float = 1.0
    rounding: Array | float = 0.0

    def part(self, which: slice | NDArray[np.intp] | NDArray[np.bool_]) -> Samples:
        """Samples of some of the rows: a slice, their indices, or a mask."""
        rounding = self.rounding if isinstance(self.rounding, float) else self.rounding[which]
        return self._replace(theta=self.theta[which], s=self.s[which], lines=self.lines[which], rounding=rounding)


class Dwelling(NamedTuple):
    """A dwell from row `first` to row `last`, counted on beyond the turn, at `level`, mm or rad."""

    first: int
    last: int
    level: float


class FittingMethod(Protocol):
    """Method that fits spans of a function to the rows of one moving stretch."""

    def __call__(
        self, rows: Samples, ends: Ends | None, between: tuple[float, float], /
    ) -> tuple[Array, Sequence[Stretch]]:
        """Give the sites (m + 1,), rad, and m functions, one between each two sites.

        The functions rest at the levels `ends`, or are periodic for None; `between` are the first and last angle.
        """


def laid(rows: Samples, dwells: Sequence[Dwelling], total: float, around: int | None, fit: FittingMethod) -> Motion:
    """Fit the rows between the dwells, and lay all stretches over [0, total], rad.

    Rows of a motion that repeats (`around` 1) lie within one turn, other rows reach from 0 to `total`. With `around` -1
    the motion is fitted over two halves, the second one upside down; with None it rests at both ends. Both begin at 0.
    """
    if around == 1:
        return settled(*_round(rows, dwells, total, fit), total, total)
    if around is None:
        return _open(rows, dwells, fit)
    n = len(rows.theta) - 1
    second_half = rows.s[0] + rows.s[-1] - rows.s[:-1]
    halves = Samples(
        np.concatenate([rows.theta[:-1], rows.theta[:-1] + total]),
        np.concatenate([rows.s[:-1], second_half]),
        np.concatenate([rows.lines[:-1], rows.lines[:-1]]),
        rows.unit,
    )
    again = [Dwelling(d.first + n, d.last + n, rows.s[0] + rows.s[-1] - d.level) for d in dwells]
    knots, functions = _round(halves, merged([*dwells, *again], 2 * n), 2 * total, fit)
    half = settled(knots, functions, 2 * total, total)
    start = float(half.derivatives(0.0, 0)[0, 0])
    return Motion(half.raised(-start).motion, -1)


def merged(dwells: Sequence[Dwelling], count: int) -> list[Dwelling]:
    """Join dwells that touch, across the end of the turn of `count` rows too."""
    joined_dwells: list[Dwelling] = []
    for dwell in dwells:
        if joined_dwells and joined_dwells[-1].last == dwell.first:
            joined_dwells[-1] = Dwelling(joined_dwells[-1].first, dwell.last, dwell.level)
        else:
            joined_dwells.append(dwell)
    if len(joined_dwells) > 1 and joined_dwells[-1].last == joined_dwells[0].first + count:
        first = joined_dwells.pop(0)
        joined_dwells[-1] = Dwelling(joined_dwells[-1].first, first.last + count, first.level)
    return joined_dwells


def _round(
    rows: Samples, dwells: Sequence[Dwelling], turn: float, fit: FittingMethod
) -> tuple[list[float], list[Stretch]]:
    """Knots and stretches round a turn, from the first row or the first dwell on."""
    n = len(rows.theta)
    if not dwells:
        sites, spans = fit(rows, None, (float(rows.theta[0]), float(rows.theta[0]) + turn))
        return sites.tolist(), list(spans)
    knots: list[float] = []
    functions: list[Stretch] = []
    following = [*dwells[1:], Dwelling(dwells[0].first + n, dwells[0].last + n, dwells[0].level)]
    for dwell, after in zip(dwells, following, strict=True):
        knots.append(_angle(rows, dwell.first, turn))
        functions.append(Constant(dwell.level))
        index = np.arange(dwell.last, after.first + 1)
        part = Samples(rows.theta[index % n] + turn * (index // n), rows.s[index % n], rows.lines[index % n], rows.unit)
        between = float(part.theta[0]), float(part.theta[-1])
        sites, spans = fit(part, Ends(dwell.level, after.level), between)
        knots += sites[:-1].tolist()
        functions += spans
    return [*knots, knots[0] + turn], functions


def _angle(rows: Samples, index: int, turn: float) -> float:
    n = len(rows.theta)
    return float(rows.theta[index % n]) + turn * (index // n)


def _open(rows: Samples, dwells: Sequence[Dwelling], fit: FittingMethod) -> Motion:
    knots, functions = [float(rows.theta[0])], []
    last, level = 0, float(rows.s[0])
    stops = [*dwells, Dwelling(len(rows.s) - 1, len(rows.s) - 1, float(rows.s[-1]))]
    for dwell in stops:
        if dwell.first > last:
            part = rows.part(slice(last, dwell.first + 1))
            sites, spans = fit(part, Ends(level, dwell.level), (float(part.theta[0]), float(part.theta[-1])))
            knots += sites[1:].tolist()
            functions += list(spans)
        if dwell.last > dwell.first:
            knots.append(float(rows.theta[dwell.last]))
            functions.append(Constant(dwell.level))
        last, level = dwell.last, dwell.level
    return joined(knots, functions, None).raised(-float(rows.s[0]))


def settled(knots: Sequence[float], functions: Sequence[Stretch], turn: float, total: float) -> Motion:
    """Fold stretches over one turn, from any angle on, into [0, turn], rad, and keep [0, total].

    Stretch i lies between knots i and i + 1. The motion repeats.
    """
    pieces: list[tuple[float, float, Stretch]] = []
    for function, begin, end in zip(functions, knots[:-1], knots[1:], strict=True):
        shift = turn * math.floor((begin + SAME_ANGLE) / turn)
        low, high = begin - shift, end - shift
        folded = moved(function, start=-shift) if shift else function
        if high > turn + SAME_ANGLE:
            pieces += [(low, turn, folded), (0.0, high - turn, moved(folded, start=-turn))]
        else:
            pieces.append((max(low, 0.0), high, folded))
    pieces.sort(key=lambda piece: piece[0])
    kept = [piece for piece in pieces if piece[0] < total - SAME_ANGLE]
    at = [0.0, *(piece[0] for piece in kept[1:]), total]
    return joined(at, [_on_knots(piece[2], ends) for piece, ends in zip(kept, pairwise(at), strict=True)])


def _on_knots(function: Stretch, ends: tuple[float, float]) -> Stretch:
    """The stretch with its start set to the knot of `ends` from which it differs by rounding alone; else as it is."""
    if isinstance(function, AffineStretch):
        for knot in ends:
            if abs(function.start - knot) <= _FOLDED:
                return replace(function, start=knot)
    return function


def demand_whole(rows: Samples, total: float, around: int | None, field: str) -> None:
    """Raise IntentError for rows that do not reach from 0 to `total`, rad, where the motion does not repeat."""
    if around == 1:
        return
    if abs(rows.theta[0]) > SAME_ANGLE or abs(rows.theta[-1] - total) > SAME_ANGLE:
        first, last = map(input_number, rows.theta[[0, -1]].tolist())
        raise IntentError(
            f"the {INPUT}s must reach from 0 to {input_words(total)}, these from {first} to {last}", field
        )
