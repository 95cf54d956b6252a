"""Loads over the turn by a formula: where they have corners, and how far they are proved to be followed."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.dynamics.load_table import MOST_LOAD
from kin.numeric.angles import TURN
from kin.numeric.distinct import distinct
from kin.numeric.errors import CamgeoError
from kin.numeric.monotone import DEGREE, FIRST_CELLS
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.formula.expression import Expression
    from kin.law.formula.formula import Formula
    from kin.numeric.arrays import Array

STRETCHES = 256  # of a turn, which are enclosed first
MOST_OPEN = 20_000  # stretches that are halved at a time; where there are more they are left as they are
_SHARE = 1e-12  # of the greatest load: what a polynomial may be off on a stretch
_LEAST = 1e-3  # N or N m: a lesser load counts as this much
_NEAR = 1e-9  # rad: no narrower stretch is halved
_NARROWEST = 2.0**-44 * TURN  # rad: the same where its ball is finite and coarse
_KNOWN = 1e-7  # of the greatest load: a ball of a greater radius is coarse
_STEP = 32.0
_BESIDE = np.outer([-1.0, 1.0], _NEAR * _STEP ** np.arange(3))  # rad: where the load is looked at beside such a stretch
_SETTLING = 0.9  # share of a change, and of that _STEP times as far out, that a bounded load stays below
_ROUNDING = 1e-6  # of the load there, which such a change exceeds


class LoadError(CamgeoError, ValueError):
    """A load that exceeds MOST_LOAD near the shaft angle `at`, rad; `size` is None where it has no bound there."""

    def __init__(self, at: float, size: float | None) -> None:
        super().__init__(f"the load {'has no bound' if size is None else f'is {size:.4g}'} near t = {at:.9g}")
        self.at, self.size = at, size


class Sampled(NamedTuple):
    """A load that is sampled: where it is known least, shaft angle, rad, and by how much it may be off, N or N m."""

    at: float
    within: float


@dataclass(frozen=True, eq=False)
class FormulaLoad:
    """A load over the turn by a formula in the shaft angle t, rad: N, or N m, above 0 towards the cam.

    On each cell between `corners` (n,), shaft angles, rad, that is no wider than a turn over FIRST_CELLS, the
    polynomial of DEGREE through Chebyshev's points follows it. `sampled` is None where that is proved all round.
    """

    formula: Formula
    corners: Array
    sampled: Sampled | None

    def __call__(self, phi: Array) -> Array:
        """The load at shaft angles (n,), rad: N or N m (n,). Raises FormulaDomainError where it has no value."""
        load: Array = np.asarray(self.formula(np.asarray(phi, dtype=np.float64)))
        return load


@lru_cache(maxsize=16)
def followed(text: str) -> FormulaLoad:
    """The load by a formula, cut where it switches and where a polynomial would not follow it.

    Raises FormulaDomainError where it has no value at a place that is looked at, LoadError where it exceeds MOST_LOAD
    in magnitude.
    """
    from kin.law.formula.expression import FormulaDomainError, FormulaError
    from kin.law.formula.formula import Formula

    formula = Formula(text)
    scale = max(float(np.abs(formula(np.linspace(0.0, TURN, STRETCHES + 1))).max()), _LEAST)
    try:
        knots, pieces = formula.pieces(0.0, TURN)
    except FormulaDomainError:
        raise
    except FormulaError:  # the switches are not settled: the formula is halved about them
        knots, pieces = np.array([0.0, TURN]), (formula.expression,)
    stretches = zip(pieces, knots[:-1].tolist(), knots[1:].tolist(), strict=True)
    edges, left = zip(*(_halved(formula, piece, ends, scale) for piece, *ends in stretches), strict=True)
    corners = distinct(np.concatenate([knots[1:-1], *edges]))
    return FormulaLoad(formula, corners, _sampled(formula, np.concatenate(left)))


def _halved(formula: Formula, piece: Expression, ends: Sequence[float], scale: float) -> tuple[Array, Array]:
    """Edges (n,) of the narrow parts of a stretch, and those that no polynomial is proved to follow.

    Of these (m, 3): both ends, rad, and the radius of the load, N or N m, infinite where no ball encloses it.
    `piece` is the formula between `ends` without switches, `scale` the greatest load known, N or N m. Through n
    Chebyshev points on a width h the error is below 2 (h/4)^n max|f^(n)|/n!. Raises as `followed` does.
    """
    places = np.linspace(ends[0], ends[1], int(np.ceil((ends[1] - ends[0]) / TURN * STRETCHES - 1e-9)) + 1)
    low, high = places[:-1], places[1:]
    edges, left = [places[:0]], [np.empty((0, 3))]
    n = DEGREE + 1
    while len(low):
        middle = 0.5 * (low + high)
        size, whole, bent = np.abs(formula(middle)), formula.ball(low, high, 0), piece.ball(low, high, n)
        _demand_within(size, middle, whole.rad[0])
        scale = max(scale, float(size.max()))
        bounded = np.abs(whole.mid[0]) + whole.rad[0] <= MOST_LOAD
        bend = 2.0 * (np.abs(bent.mid[n]) + bent.rad[n])
        calm = bend * (0.25 * TURN / FIRST_CELLS) ** n <= _SHARE * scale
        close = bend * (0.25 * (high - low)) ** n <= _SHARE * scale
        coarse = np.isfinite(whole.rad[0]) & (whole.rad[0] > _KNOWN * scale)
        narrowest = np.where(coarse, _NARROWEST, _NEAR)
        halved = ~(close & bounded) & (high - low > narrowest)
        if 2 * np.count_nonzero(halved) > MOST_OPEN:
            halved[:] = False
        edges.append(np.concatenate([low[~calm & ~halved], high[~calm & ~halved]]))
        left.append(np.column_stack([low, high, whole.rad[0]])[~close & ~halved])
        low, middle, high = low[halved], middle[halved], high[halved]
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return np.concatenate(edges), np.concatenate(left)


def _demand_within(size: Array, at: Array, radius: Array) -> None:
    """Raise LoadError for a magnitude (n,) above MOST_LOAD at shaft angles (n,), rad; `radius` (n,) is the balls'."""
    beyond = size > MOST_LOAD
    if beyond.any():
        first = int(np.argmax(beyond))
        raise LoadError(float(at[first]), float(size[first]) if np.isfinite(radius[first]) else None)


def _sampled(formula: Formula, left: Array) -> Sampled | None:
    """By how much the load may be off over the parts that are `left` (m, 3) by `_halved`; None without any.

    Where no ball encloses it, as of the root of a square, or a fraction of which both sides vanish, this is an estimate
    by how it changes beside the part. Raises LoadError where it does not settle as it comes closer, FormulaDomainError
    where it has no value.
    """
    low, high, radius = left.T
    middle, within = 0.5 * (low + high), 2.0 * radius
    loose = ~np.isfinite(radius)
    near = formula(np.clip(middle[loose, None, None] + _BESIDE, 0.0, TURN))
    inner, outer = np.abs(np.diff(near, axis=2)).max(axis=1).T
    grows = inner > np.maximum(_SETTLING * outer, _ROUNDING * np.abs(near).max(axis=(1, 2), initial=0.0))
    grows |= (high - low)[loose] > _NEAR
    if grows.any():
        raise LoadError(float(middle[loose][np.argmax(grows)]), None)
    within[loose] = inner
    worst = int(np.argmax(within)) if len(within) else None
    return None if worst is None else Sampled(float(middle[worst]), float(within[worst]))
