"""The series D nearest to a wanted law: least greatest error of psi over the period, and its proof.

D is that of W. Wunderlich, 1984, 6.5: psi = -asin(D/l^2). For a wanted law psi_w over the shaft angle phi and a series
D of the harmonics 1, 3, .., J of lambda t, the error is psi - psi_w at the same phi. Where two laws of such series
meet, at one phi and one psi, they meet at one t, and there their series agree: at most J times on [0, delta), as these
J + 1 functions are a Chebyshev system there. So, as with Remez, D is best where the error has J + 2 extremes of one
size in turn, and no series whatever does better than the least of them (de la Vallee Poussin); a place and its image
under (t, psi) -> (t + delta, -psi) count once.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.law.bounds import undecided
from kin.law.normalised import IntentError
from kin.law.segment import Harmonics
from kin.numeric.elementary import asin
from kin.numeric.errors import UnsettledError
from kin.numeric.newton import zeros
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.law.segment import Series, Stretch
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

MOST_HARMONICS = 31  # the highest harmonic
_CLOSE = 1e-6  # of the greatest error: the best series is nearer by no larger part
_NOTHING = 1e-12  # rad: a smaller error is the rounding of both laws
_STEPS = 80  # of the exchange
_LOOKS = 48  # places of the grid for each expected extreme
_SETTLED = 1e-13  # rad: Newton's next step would be its square
_SECTIONS = 44  # of an interval by the golden ratio: to rounding
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
_SHARE = 0.999  # of l^2: beyond it the arcsine goes on as its tangent while a series is looked for
_HALVINGS = 12  # of a step that does not lower the error
_STEEP = 0.02  # least slope of phi over t while a series is looked for


@dataclass(frozen=True)
class Nearest:
    """The series of cosines and of sines: coefficients, as parts of l^2, by odd harmonics of lambda t.

    `error` is the greatest error of psi, rad, at the parameter `at` of the wanted law; `least`, rad, is a lower bound
    of it for any series of these harmonics.
    """

    cos: dict[int, float]
    sin: dict[int, float]
    error: float
    least: float
    at: float


def nearest(wanted: Transmission, harmonics: int) -> Nearest:
    """Find the series of harmonics 1, 3, .. `harmonics`, an odd number, whose law has the least greatest error.

    Its error is within a millionth of the least. Raises IntentError where the exchange does not come so near.
    """
    # Remez: the errors at alternating extremes are levelled until they are no less than the bound that they give
    search = _Search(wanted, np.arange(1, harmonics + 1, 2))
    coefficients = search.on_grid(search.projected())
    best, least = _Extremes.none(), 0.0
    nearest_yet = coefficients
    for _ in range(_STEPS):
        try:
            extremes = search.extremes(coefficients)
        except UnsettledError:
            break
        reference = search.reference(extremes)
        least = max(least, search.least(reference))
        if not extremes.greatest < best.greatest:
            break
        best, nearest_yet = extremes, coefficients
        if extremes.greatest <= max(_NOTHING, (1 + 0.01 * _CLOSE) * least) or not search.least(reference):
            break
        coefficients = coefficients + search.levelling_change(
            reference, reference.error, search.jacobian(coefficients, reference)
        )
    if not best.greatest <= max(_NOTHING, (1 + _CLOSE) * least):
        remedy = "a smaller stroke" if harmonics == MOST_HARMONICS else "other harmonics"
        raise IntentError(
            f"the nearest series up to harmonic {harmonics} was not found, as the law is steep; {remedy} may do",
            "delta.harmonics",
        )
    coefficients, greatest, extremes = nearest_yet, best.greatest, best
    half = len(coefficients) // 2
    worst = int(np.argmax(np.abs(extremes.error)))
    series = [dict(zip(search.odd.tolist(), part.tolist(), strict=True)) for part in np.split(coefficients, [half])]
    return Nearest(series[0], series[1], greatest, min(least, greatest), float(extremes.tau[worst]))


@dataclass(frozen=True, eq=False)
class _Extremes:
    """Extremes of the error: parameters tau of the wanted law, polar angles t of the series' law, errors, rad; (n,)."""

    tau: Array
    t: Array
    error: Array

    @staticmethod
    def none() -> _Extremes:
        """One infinite error, for no series."""
        return _Extremes(np.zeros(1), np.zeros(1), np.full(1, math.inf))

    @property
    def greatest(self) -> float:
        """Greatest absolute error, rad; infinite for no series."""
        return float(np.abs(self.error).max())

    def taken(self, index: NDArray[np.intp]) -> _Extremes:
        """The extremes at some indices."""
        return _Extremes(self.tau[index], self.t[index], self.error[index])


class _Search:
    """The error of the law of a series: (2 m,) coefficients over l^2, cosines first, of m odd harmonics."""

    def __init__(self, wanted: Transmission, odd: NDArray[np.intp]) -> None:
        self.wanted, self.odd = wanted, odd
        self.rates = odd * float(wanted.lam)
        knots = wanted.psi.knots
        parts = [
            np.linspace(a, b, max(9, math.ceil(_LOOKS * 4 * (len(odd) + 1) * (b - a) / (2 * wanted.delta))))
            for a, b in pairwise(knots.tolist())
        ]
        self.grid = np.unique(np.concatenate(parts))[:-1]

    def projected(self) -> Array:
        """Coefficients (2 m,) of the first terms of the wanted law's own series."""
        period = 2 * self.wanted.delta
        t: Array = np.linspace(0.0, period, 1024, endpoint=False)
        d = -np.sin(self.wanted.at(self.wanted.polar_parameter(t), 0)[1][0])
        angles = self.rates[:, None] * t
        return np.concatenate([np.cos(angles) @ d, np.sin(angles) @ d]) / 512

    def _psi(self, coefficients: Array, t: Array) -> tuple[Array, Array]:
        """Psi and its slope of a series at t (n,); beyond `_SHARE` the tangent stands for the arcsine."""
        angles = self.rates[:, None] * t
        a, b = np.split(coefficients, 2)
        cosine, sine = np.cos(angles), np.sin(angles)
        d, slope = a @ cosine + b @ sine, (b * self.rates) @ cosine - (a * self.rates) @ sine
        inside = np.clip(d, -_SHARE, _SHARE)
        rate = 1.0 / np.sqrt(1.0 - inside * inside)
        return -(np.arcsin(inside) + rate * (d - inside)), -rate * slope

    def _error_at(self, coefficients: Array, tau: Array) -> tuple[Array, Array]:
        """Error, rad, at parameters tau (n,) of the wanted law, and the polar angles of the series' law there."""
        phi, wanted = (rows[0] for rows in self.wanted.at(tau, 0))
        shaft = phi - 0.5 * self.wanted.alpha

        def over(psi: Array) -> tuple[Array, Array]:
            value, slope = self._psi(coefficients, shaft - 0.5 * psi)
            return psi - value, np.maximum(1.0 + 0.5 * slope, _STEEP)

        bound = np.full(tau.shape, 4.0 + 40.0 * float(np.abs(coefficients).sum()))
        psi = zeros(over, -bound, bound, wanted, _SETTLED)
        return psi - wanted, shaft - 0.5 * psi

    def extremes(self, coefficients: Array) -> _Extremes:
        """Every local extreme of the error over the period that the grid shows, refined by golden sections."""
        tau = self.grid
        error, _ = self._error_at(coefficients, tau)
        size = np.abs(error)
        before, after = np.roll(size, 1), np.roll(size, -1)
        top = np.flatnonzero((size >= before) & (size >= after) & ((size > before) | (size > after)))
        if not len(top):
            top = np.array([int(np.argmax(size))])
        # golden sections between the neighbours of each local maximum of |error| on the grid
        period = 2 * self.wanted.delta
        low = np.where(top > 0, tau[top - 1], tau[-1] - period)
        high = np.where(top + 1 < len(tau), tau[(top + 1) % len(tau)], tau[0] + period)
        sign = np.sign(error[top])
        inner, outer = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        at_inner, at_outer = (sign * self._error_at(coefficients, x)[0] for x in (inner, outer))
        for _ in range(_SECTIONS):
            left = at_inner > at_outer
            low, high = np.where(left, low, inner), np.where(left, outer, high)
            fresh = np.where(left, high - _GOLDEN * (high - low), low + _GOLDEN * (high - low))
            at_fresh = sign * self._error_at(coefficients, fresh)[0]
            inner, outer = np.where(left, fresh, outer), np.where(left, inner, fresh)
            at_inner, at_outer = np.where(left, at_fresh, at_outer), np.where(left, at_inner, at_fresh)
        best = np.where(
            np.maximum(at_inner, at_outer) > size[top], np.where(at_inner > at_outer, inner, outer), tau[top]
        )
        error, t = self._error_at(coefficients, best)
        return _Extremes(best, t, error)

    def reference(self, extremes: _Extremes) -> _Extremes:
        """Extremes that alternate in sign round the half period: 2 m + 1 if there are as many, else fewer.

        Of neighbours alike in sign the greater stays; of too many the two least neighbours are dropped. Round the
        circle an odd number alternates, as the sign changes with t + delta.
        """
        # the error changes its sign with t + delta: all extremes are folded to one half period
        delta = self.wanted.delta
        halves = np.floor(extremes.t / delta)
        folded, sign = extremes.t - halves * delta, np.where(halves % 2 == 0, 1.0, -1.0) * np.sign(extremes.error)
        ring = [(int(i), float(sign[i]), float(abs(extremes.error[i]))) for i in np.argsort(folded, kind="stable")]
        kept: list[tuple[int, float, float]] = []
        for row in ring:
            if kept and kept[-1][1] == row[1]:
                if row[2] > kept[-1][2]:
                    kept[-1] = row
            else:
                kept.append(row)
        if len(kept) > 1 and kept[0][1] == -kept[-1][1]:
            kept.pop(0 if kept[0][2] < kept[-1][2] else -1)
        while len(kept) > 2 * len(self.odd) + 1:
            i = min(range(len(kept)), key=lambda k: max(kept[k][2], kept[k - 1][2]))
            for k in sorted({i, (i - 1) % len(kept)}, reverse=True):
                del kept[k]
        return extremes.taken(np.array([i for i, _, _ in kept]))

    def least(self, reference: _Extremes) -> float:
        """Lower bound of any series' greatest error, rad, by the errors at a reference; 0 for one of too few."""
        whole = len(reference.error) == 2 * len(self.odd) + 1
        return float(np.abs(reference.error).min()) if whole else 0.0

    def jacobian(self, coefficients: Array, places: _Extremes) -> Array:
        """Derivatives of the error at n places by the 2 m coefficients, (n, 2 m)."""
        angles = self.rates[:, None] * places.t
        psi, slope = self._psi(coefficients, places.t)
        rate = -1.0 / np.sqrt(np.maximum(np.cos(psi) ** 2, 1.0 - _SHARE**2))
        weight = rate / np.maximum(1.0 + 0.5 * slope, _STEEP)
        jacobian: Array = (weight * np.concatenate([np.cos(angles), np.sin(angles)])).T
        return jacobian

    def levelling_change(self, reference: _Extremes, error: Array, jacobian: Array) -> Array:
        """Change of the coefficients (2 m,) after which the errors at a reference are of one size, to first order."""
        solved: Array = np.linalg.solve(np.column_stack([jacobian, -np.sign(reference.error)]), -error)
        return solved[:-1]

    def on_grid(self, coefficients: Array) -> Array:
        """Coefficients (2 m,) of the best series at the places of the grid, by repeated exchange.

        A step is halved until the greatest error falls, so that a first series far off leads there too.
        """
        error, t = self._sampled_error(coefficients)
        while not np.isfinite(error).all():
            coefficients = 0.5 * coefficients
            error, t = self._sampled_error(coefficients)
        # each step solves the problem made linear at the grid's places
        for _ in range(_STEPS):
            places = _Extremes(self.grid, t, error)
            step = self._best_change(places, self.jacobian(coefficients, places))
            for halving in range(_HALVINGS):
                trial = coefficients + 0.5**halving * step
                error, t = self._sampled_error(trial)
                if np.abs(error).max() < places.greatest:
                    break
            else:
                return coefficients
            coefficients = trial
            if np.abs(error).max() > (1 - 1e-4) * places.greatest:
                return coefficients
        return coefficients

    def _sampled_error(self, coefficients: Array) -> tuple[Array, Array]:
        """Error and polar angles on the grid; infinite errors for a series too steep for its angles to be found."""
        try:
            return self._error_at(coefficients, self.grid)
        except UnsettledError:
            return np.full(self.grid.shape, math.inf), self.grid

    def _best_change(self, places: _Extremes, jacobian: Array) -> Array:
        """The change of the coefficients (2 m,) that is best for the linear problem at places."""
        change, error = np.zeros(jacobian.shape[1]), places.error
        for _ in range(_STEPS):
            reference = self.reference(_Extremes(np.arange(len(error), dtype=float), places.t, error))
            level = self.least(reference)
            if not level or np.abs(error).max() <= (1 + 1e-3) * level:
                break
            kept = reference.tau.astype(np.intp)
            change = self.levelling_change(reference, places.error[kept], jacobian[kept])
            error = places.error + jacobian @ change
        return change


def proved_error(series: Nearest, wanted: Transmission) -> float:
    """Prove a bound of |psi - psi_w| at the same shaft angles, rad, from 1.0001 to 2 times the error of the series.

    For a series that makes a possible law, F(psi) = psi - f(phi - (psi + alpha)/2) rises, where f is psi over t. So the
    error is below e where F(psi_w + e) > 0, and above -e where F(psi_w - e) < 0, which is proved on cells of the wanted
    law's stretches over the whole period. Raises IntentError where no bound is proved.
    """
    made = Harmonics(0.0, tuple((j * wanted.lam, a, series.sin[j]) for j, a in series.cos.items()))
    for slack in (1e-4, 1e-2, 0.1, 1.0):
        bound = series.error * (1 + slack) + _NOTHING * 10
        if _holds(made, wanted, bound):
            return bound
    near = math.degrees(series.error)
    raise IntentError(f"no bound near {near:.4g} degrees is proved for the error of the law", "delta.law")


def _holds(made: Harmonics, wanted: Transmission, bound: float) -> bool:
    knots = wanted.psi.knots.tolist()
    stretches = zip(wanted.psi.functions, wanted.lean, knots[:-1], knots[1:], strict=True)
    for function, lean, begin, end in stretches:
        for sign in (1.0, -1.0):
            margin = _Room(made, function, lean - 0.5, wanted.offset - 0.5 * wanted.alpha, sign, bound)
            if undecided(margin, begin, end, {0: (0.0, math.inf)}) is not None:
                return False
    return True


@dataclass(frozen=True, eq=False)
class _Room:
    """`sign` F(psi_w + `sign` bound) over the wanted law's parameter, positive where the bound holds.

    The polar angle t is tau + lean psi_w + offset - sign bound/2.
    """

    made: Harmonics
    wanted: Stretch
    lean: float
    offset: float
    sign: float
    bound: float

    def __call__(self, tau: Series, /) -> Series:
        """Value of the function, rad, a series of tau's own kind."""
        psi: Series = self.wanted(tau)
        reach = self.sign * self.bound
        made: Series = asin(self.made(tau + psi * self.lean + (self.offset - 0.5 * reach)))
        return (psi + reach + made) * self.sign
