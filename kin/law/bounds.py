"""Proved bounds of functions over stretches, by halving cells that are not decided yet."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.distinct import distinct
from kin.numeric.elementary import BallJet, Jet
from kin.numeric.errors import UnsettledError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kin.law.piecewise import Piecewise
    from kin.law.segment import Stretch
    from kin.numeric.arrays import Array, Mask


_CELLS = 32  # parts of a stretch that are bounded first
_PARTS = 16  # parts of a stretch for which cubics stand first
_HALVINGS = 40  # of a cell: 2^-40 of a part is near rounding
_AT_ONCE = 3  # most halvings of a cell in one step
_MOST_CELLS = 20000  # open at a time: with more the answer is taken to be no


def cubics_between(law: Piecewise, nodes: Array) -> Array:
    """Coefficients (4, m), the constant first, of the cubics with a law's values and slopes at nodes (m + 1,), rad."""
    low, high = nodes[:-1], nodes[1:]
    (f, g), (f1, g1) = law.derivatives(low, 1, 1), law.derivatives(high, 1, -1)
    h = high - low
    rise = (f1 - f) / h
    return np.stack([f, g, (3.0 * rise - 2.0 * g - g1) / h, (g + g1 - 2.0 * rise) / h**2])


def undecided(
    function: Stretch, begin: float | Array, end: float | Array, limits: Mapping[int, tuple[float, float]]
) -> tuple[int, float] | None:
    """Prove that each derivative k in `limits` stays strictly between its two limits over [begin, end], one or (m,).

    Returns None where that is proved, else (k, place) where it is false or not proved. A cell is bounded directly, and
    where that is not enough by Taylor's formula about its middle, whose error falls with the square of the width.
    """
    top = max(limits)

    # masks of the cells that keep the limits for certain, and of those that break one
    def settled(lower: Array, upper: Array) -> tuple[Mask, Mask]:
        low, high = function(BallJet.variable(lower, upper, top + 2)).bounds()
        yes, no = _within(low, high, limits)
        open_ = np.flatnonzero(~(yes | no))
        if len(open_):
            sharper = _about_middle(function, lower[open_], upper[open_], low[:, open_], high[:, open_])
            yes[open_], no[open_] = _within(*sharper, limits)
        return yes, no

    at = _halve(settled, begin, end)
    if at is None:
        return None
    value = function(BallJet.variable(at, at, top))
    (low, high), blame = value.bounds(), top
    for k, (least, most) in limits.items():
        if not (low[k, 0] > least and high[k, 0] < most):
            blame = k
            break
    return blame, at


def _within(low: Array, high: Array, limits: Mapping[int, tuple[float, float]]) -> tuple[Mask, Mask]:
    """Masks (n,) of the cells where all derivatives certainly keep the limits, and where one certainly breaks them."""
    yes, no = np.ones(low.shape[1], dtype=bool), np.zeros(low.shape[1], dtype=bool)
    for k, (least, most) in limits.items():
        yes &= (low[k] > least) & (high[k] < most)
        no |= (high[k] <= least) | (low[k] >= most)
    return yes, no


def _about_middle(function: Stretch, lower: Array, upper: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Bounds (m, n), (m, n) of derivatives over cells, sharper than `low`, `high` (m + 2, n), by Taylor's formula."""
    middle = 0.5 * (lower + upper)
    half = np.maximum(upper - middle, middle - lower) * (1 + 1e-12)
    near_low, near_high = function(BallJet.variable(middle, middle, len(low) - 2)).bounds()
    with np.errstate(invalid="ignore"):  # inf - inf where nothing is known: the direct bound is taken
        bend = np.maximum(np.abs(low[2:]), np.abs(high[2:])) * half**2 * (0.5 + 1e-12)
        reach = np.maximum(np.abs(near_low[1:]), np.abs(near_high[1:])) * half * (1 + 1e-12) + bend
        return np.fmax(low[:-2], near_low[:-1] - reach), np.fmin(high[:-2], near_high[:-1] + reach)


def unbounded(function: Stretch, begin: float, end: float, order: int) -> float | None:
    """Prove that derivatives 0..order are finite over [begin, end]: None, or a parameter where that is not proved."""

    def settled(lower: Array, upper: Array) -> tuple[Mask, Mask]:
        finite = np.isfinite(function(BallJet.variable(lower, upper, order)).rad).all(axis=0)
        return np.asarray(finite), np.zeros(len(lower), dtype=bool)

    return _halve(settled, begin, end)


def _halve(
    settled: Callable[[Array, Array], tuple[Mask, Mask]], begin: float | Array, end: float | Array
) -> float | None:
    """Halve cells until `settled` proves all of them: None; else the middle of a cell that is false or stays open."""
    ends = np.linspace(begin, end, _CELLS + 1)
    lower, upper = ends[:-1].ravel(), ends[1:].ravel()
    for _ in range(_HALVINGS):
        yes, no = settled(lower, upper)
        if yes.all():
            return None
        if no.any():
            first = int(np.argmax(no))
            return float(0.5 * (lower[first] + upper[first]))
        lower, upper = lower[~yes], upper[~yes]
        if len(lower) > _MOST_CELLS:
            break
        middle = 0.5 * (lower + upper)
        lower, upper = np.concatenate((lower, middle)), np.concatenate((middle, upper))
    return float(0.5 * (lower[0] + upper[0]))


def highest(law: Piecewise, weights: Sequence[float], k: int) -> tuple[float, float]:
    """Place and value of the greatest k-th derivative of a law, times the weight of its stretch; sampled, not proved.

    Raises DomainError where a function of the law does not exist.
    """
    best = (float(law.knots[0]), -math.inf)
    for weight, function, begin, end in zip(weights, law.functions, law.knots[:-1], law.knots[1:], strict=True):
        low, high = begin, end
        for _ in range(8):
            points = np.linspace(low, high, 257)
            values = weight * function(Jet.variable(points, k)).derivatives()[k]
            top = int(np.argmax(values))
            if values[top] > best[1]:
                best = (float(points[top]), float(values[top]))
            low, high = points[max(top - 1, 0)], points[min(top + 1, 256)]
    return best


def cubic_cells(law: Piecewise, breaks: Array, near: float, span: tuple[float, float] = (0.0, TURN)) -> Array:
    """Edges (m + 1,), rising over the span, of cells between a law's breaks in which it is nearly a cubic.

    The cubic through a cell's end values and slopes is proved to be within `near`, in the law's unit, of the law: on
    width h it is off by no more than h^4/384 max|f''''|. Where that is not bounded, the law itself is enclosed as
    closely. So no feature of the law is too narrow for a search on the cells. `breaks` lie in the span, or away from it
    by whole spans. Raises UnsettledError where too many cells are needed.
    """
    first, last = span
    ends = distinct(np.concatenate([[first], first + np.mod(breaks - first, last - first), [last]]))
    parts = np.linspace(ends[:-1], ends[1:], _PARTS + 1)
    low, high, settled = parts[:-1].ravel(), parts[1:].ravel(), [ends[:1]]
    for _ in range(_HALVINGS):
        mid, rad = law.enclosure(low, high, 4)
        with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
            strays = (high - low) ** 4 / 384.0 * (np.abs(mid[4]) + rad[4])
            open_ = ~((strays <= near) | (rad[0] <= near))
            # the error falls as the fourth power of the width, which gives the halvings needed
            halvings = np.where(strays < math.inf, np.clip(np.ceil(np.log2(strays / near) / 4.0), 1, _AT_ONCE), 1)
        settled.append(high[~open_])
        halvings = halvings[open_]
        low, high = low[open_], high[open_]
        if not len(low):
            break
        if len(low) > _MOST_CELLS:
            raise UnsettledError(f"the intended motion is too rough to be followed to {near:.3g}")
        parted = [np.linspace(low[halvings == k], high[halvings == k], 2**k + 1) for k in range(1, _AT_ONCE + 1)]
        low, high = (np.concatenate([parts[ends].ravel() for parts in parted]) for ends in (slice(-1), slice(1, None)))
    else:
        raise UnsettledError(f"the intended motion cannot be followed to {near:.3g} about an input of {low[0]:.6g}")
    cells: Array = np.sort(np.concatenate(settled))
    return cells
