"""Where an expression changes sign: isolated with balls so that none is missed, then found to the last places.

A cell is done when a ball shows that the expression has no zero in it, or that it is monotone there. Other cells are
halved. A zero at which derivatives vanish too can never be shown by rounded arithmetic; it is taken as a zero of
multiplicity m where the m-th derivative keeps its sign over the cell and all lower ones are 0 to within rounding at
one point. Zeros of odd multiplicity are changes of sign, those of even multiplicity are not.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.errors import UnsettledError
from kin.numeric.newton import zeros
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.law.formula.expression import Expression
    from kin.numeric.arrays import Array
    from kin.numeric.interval import Ball


_FIRST_CELLS = 32
_MOST_CELLS = 4096  # open at a time: with more the expression is too close to zero
# Cells reach over their neighbours by this part of themselves, so that a zero on an edge lies well inside one of them.
_OVERLAP = 1 / 16
# Multiple zeros are looked for in cells below this part of the whole; cells below the other are given up.
_SMALL_CELL = 2.0**-10
_LEAST_CELL = 2.0**-44
_MOST_MULTIPLE = 6  # greatest multiplicity of a zero that is looked for
# A zero within this many ulps of an end lies on the end.
_END_ULPS = 16
# Places between two zeros at which the sign is looked at, in parts of their distance.
_LOOKOUTS = np.array([0.5, 0.25, 0.75, 0.125, 0.875])


@dataclass(frozen=True)
class Signs:
    """Parameters inside an interval at which an expression changes its sign, rising, and its sign on each stretch.

    A sign is 1, -1, or 0 for zero throughout; there is one more than changes. `at_start` and `at_end` tell whether an
    end of the interval is itself a zero of odd multiplicity.
    """

    changes: tuple[float, ...]
    signs: tuple[int, ...]
    at_start: bool
    at_end: bool


@dataclass(frozen=True)
class _Zero:
    at: float
    left: float  # the cell in which it is the only one
    right: float


def signs(g: Expression, lower: float, upper: float) -> Signs:
    """Signs of g over [lower, upper].

    Raises UnsettledError where g stays too close to zero, is zero too often, has no value or cannot be bounded.
    """
    whole = g.ball(lower, upper, 0).rows[0]
    if whole.zero[0] or _sign(whole)[0]:
        return Signs((), (int(_sign(whole)[0]),), at_start=False, at_end=False)
    zeros = _merged(_zeros(g, lower, upper))
    rounding = snap(lower, upper)
    changes = tuple(zero for zero in zeros if lower + rounding < zero < upper - rounding)
    edges = np.array([lower, *changes, upper])
    places = []
    for a, b in pairwise(edges.tolist()):
        values = set(_sign(g.ball(*2 * (a + (b - a) * _LOOKOUTS,), 0).rows[0]).tolist()) - {0}
        if len(values) != 1:
            raise UnsettledError("stays too close to zero", a + (b - a) / 2)
        places.append(int(values.pop()))
    for place, (before, after) in enumerate(pairwise(places)):
        if before == after:
            raise UnsettledError("stays too close to zero", changes[place])
    at_start, at_end = any(z <= lower + rounding for z in zeros), any(z >= upper - rounding for z in zeros)
    return Signs(changes, tuple(places), at_start, at_end)


def _sign(row: Ball) -> NDArray[np.int_]:
    """Sign of each ball, 0 where it is not certain."""
    return np.where(row.positive, 1, np.where(row.negative, -1, 0))


def snap(lower: float, upper: float) -> float:
    """Distance within which two parameters of an interval from `lower` to `upper` count as one: 16 ulps of its ends."""
    return _END_ULPS * math.ulp(max(abs(lower), abs(upper)))


def _zeros(g: Expression, lower: float, upper: float) -> list[_Zero]:
    """Return all zeros of odd multiplicity; a zero near the edge of a cell is found in both cells.

    Raises UnsettledError where g is close to zero too often or for too long, has no value or cannot be bounded.
    """
    edges = np.linspace(lower, upper, _FIRST_CELLS + 1)
    left, right, kept = edges[:-1], edges[1:], []
    while len(left):
        if len(left) > _MOST_CELLS:
            reason = "is zero, or close to it, too often"
            if not np.isfinite(g.ball(left[:1], right[:1], 0).rad[0, 0]):
                reason = "cannot be bounded, as acos, asin or a root has no slope where it ends,"
            raise UnsettledError(reason, float(left[0]))
        # cells whose ball has a sign are done; those whose slope has a sign hold one simple zero at most
        reach = _OVERLAP * (right - left)
        low, high = np.maximum(left - reach, lower), np.minimum(right + reach, upper)
        ball = g.ball(low, high, 1).rows
        open_ = _sign(ball[0]) == 0
        steady = open_ & (_sign(ball[1]) != 0)
        kept += _simple(g, low[steady], high[steady], lower, upper)
        open_ &= ~steady
        left, right, low, high = left[open_], right[open_], low[open_], high[open_]
        # small cells may hold a multiple zero
        small = right - left < _SMALL_CELL * (upper - lower)
        zeros, settled = _multiple(g, low[small], high[small], lower, upper)
        kept += zeros
        keep = ~small
        keep[small] = ~settled
        left, right = left[keep], right[keep]
        # cells that stay open down to rounding are given up, the others halved
        lost = right - left < _LEAST_CELL * (upper - lower)
        if lost.any():
            at = left[lost]
            undefined = np.isinf(g.ball(at, at, 0).rad[0]).any() or np.isinf(g.ball(at, right[lost], 0).rad[0]).all()
            raise UnsettledError("has no value" if undefined else "stays too close to zero", float(at[0]))
        middle = 0.5 * (left + right)
        left, right = np.concatenate((left, middle)), np.concatenate((middle, right))
    return kept


def _simple(g: Expression, low: Array, high: Array, lower: float, upper: float) -> list[_Zero]:
    """Zeros of g in cells over which it is monotone; one at an inner end of a cell is left to the neighbouring cell."""
    if not len(low):
        return []
    first, last = _sign(g.ball(low, low, 0).rows[0]), _sign(g.ball(high, high, 0).rows[0])
    cross = first * last < 0
    zeros = [
        _Zero(float(z), float(a), float(b))
        for z, a, b in zip(_refine(g, 1, low[cross], high[cross]), low[cross], high[cross], strict=True)
    ]
    rounding = snap(lower, upper)
    zeros += [_Zero(lower, lower, float(b)) for b in high[low == lower] if _on_end(g, 1, lower, rounding)]
    zeros += [_Zero(upper, float(a), upper) for a in low[high == upper] if _on_end(g, 1, upper, rounding)]
    return zeros


def _on_end(g: Expression, m: int, end: float, snapped: float) -> bool:
    """Whether the (m - 1)-th derivative is 0 at an end to within rounding, of itself or, by `snapped`, of the end."""
    at = np.array([end])
    c = g.jet(at, m).c[m - 1 :, 0]
    return not _sign(g.ball(at, at, m - 1).rows[m - 1]).any() or bool(abs(c[0]) <= snapped * m * abs(c[1]))


def _multiple(
    g: Expression, low: Array, high: Array, lower: float, upper: float
) -> tuple[list[_Zero], NDArray[np.bool_]]:
    """Multiple zeros of odd multiplicity in small cells [low, high] (n,), and the mask (n,) of the cells settled."""
    settled, zeros, rounding = np.zeros(len(low), dtype=bool), [], snap(lower, upper)
    if not len(low):
        return [], settled
    certain = _sign(g.ball(low, high, _MOST_MULTIPLE).rows) != 0
    for i in np.flatnonzero(certain[2:].any(axis=0)):
        # the least order whose derivative keeps its sign is the multiplicity of a multiple zero here; the derivative
        # below it has at most one zero
        order = 2 + int(np.argmax(certain[2:, i]))
        a, b = low[i : i + 1], high[i : i + 1]
        signs_at_ends = [_sign(g.ball(x, x, order - 1).rows[order - 1])[0] for x in (a, b)]
        if signs_at_ends[0] * signs_at_ends[1] < 0:  # inside the cell
            zero = _refine(g, order, a, b)
        elif a[0] == lower and _on_end(g, order, lower, rounding):  # at the lower end of all cells
            zero = a
        elif b[0] == upper and _on_end(g, order, upper, rounding):  # at the upper one
            zero = b
        else:
            continue
        if not _sign(g.ball(zero - rounding, zero + rounding, order - 2).rows).any():
            settled[i] = True
            if order % 2:
                zeros.append(_Zero(float(zero[0]), float(a[0]), float(b[0])))
    return zeros, settled


def _refine(g: Expression, m: int, low: Array, high: Array) -> Array:
    """Return the zeros (n,) of the (m - 1)-th derivative, monotone over each [low, high], to the spacing of numbers."""
    sense = np.where(g.jet(high, m - 1).c[m - 1] > 0, 1.0, -1.0)

    def rising(t: Array) -> tuple[Array, Array]:
        c = g.jet(t, m).c
        return sense * c[m - 1], sense * m * c[m]

    return zeros(rising, low, high, 0.5 * (low + high), np.spacing(np.maximum(np.abs(low), np.abs(high))))


def _merged(zeros: list[_Zero]) -> list[float]:
    """Parameters of the zeros, rising, each once where two overlapping cells have found it."""
    kept: list[_Zero] = []
    for zero in sorted(zeros, key=lambda z: z.at):
        last = kept[-1] if kept else None
        if last and zero.left <= last.at and zero.at <= last.right:
            continue
        kept.append(zero)
    return [zero.at for zero in kept]
