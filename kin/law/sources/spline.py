"""Quintic splines through points: C4, at rest at ends beside dwells.

B-splines by the recurrence of C. de Boor, A Practical Guide to Splines, chapters 9 to 11 and 14. A clamped spline
whose three first coefficients are one number has that value and S' = S'' = 0 at its start, exactly.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.law.segment import AffineStretch, Power
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

DEGREE = 5
_AT_REST = 3  # coefficients that are equal at an end where the spline rests


@dataclass(frozen=True, eq=False)
class Basis:
    """Quintic B-splines over sites a = x0 <= x1 <= ... <= xm = b: clamped at both ends, or of period b - a.

    A clamped spline has m + 5 coefficients, a periodic one m. At a site that is given k times derivative 6 - k jumps.
    """

    sites: Array
    periodic: bool

    @cached_property
    def knots(self) -> Array:
        """Knots (m + 11,): the m + 1 sites and five more beyond each end."""
        x, m = self.sites, len(self.sites) - 1
        if not self.periodic:
            return np.concatenate([[x[0]] * DEGREE, x, [x[-1]] * DEGREE])
        i = np.arange(-DEGREE, m + DEGREE + 1)
        knots: Array = x[i % m] + (x[-1] - x[0]) * (i // m)
        return knots

    @property
    def size(self) -> int:
        """Number of coefficients."""
        m = len(self.sites) - 1
        return m if self.periodic else m + DEGREE

    def rows(self, x: Array) -> tuple[Indices, Array]:
        """Index of the span of each x (n,), and values (6, n) of the six B-splines that do not vanish there."""
        span = np.clip(np.searchsorted(self.sites, x, side="right") - 1, 0, len(self.sites) - 2)
        return span, b_splines(self.knots, span + DEGREE, x, DEGREE)

    def columns(self, span: Indices) -> Indices:
        """Indices (6, n) of the coefficients of the six B-splines over spans (n,)."""
        return (span + np.arange(DEGREE + 1)[:, None]) % self.size

    def spans(self, coefficients: Array) -> tuple[AffineStretch, ...]:
        """The spline of given coefficients as polynomials, one for each span of some width, in rising order.

        Each is expanded about its start, the last one of a clamped spline about its end.
        """
        c = coefficients[np.arange(len(self.sites) - 1 + DEGREE) % self.size]
        wide = np.flatnonzero(np.diff(self.sites) > 0.0)
        knots, index = self.knots, wide + DEGREE
        starts, width = self.sites[wide], np.diff(self.sites)[wide]
        if not self.periodic:
            starts[-1] = self.sites[-1]
        taylor, factorial = np.empty((DEGREE + 1, len(starts))), 1.0
        for k in range(DEGREE + 1):
            low = DEGREE - k
            factorial *= k or 1
            values = b_splines(knots, index, starts, low)
            at = np.arange(low + 1)[:, None] + wide + k
            taylor[k] = (values * c[at]).sum(axis=0) * width**k / factorial
            if k < DEGREE:  # coefficients of the derivative, a spline one degree lower over the same knots
                i = np.arange(k + 1, len(c))
                apart = knots[i + low] - knots[i]  # 0 for a B-spline that vanishes everywhere
                c = np.concatenate([np.zeros(k + 1), low * (c[i] - c[i - 1]) / np.where(apart > 0.0, apart, np.inf)])
        rows = zip(taylor.T.tolist(), starts.tolist(), width.tolist(), strict=True)
        return tuple(AffineStretch(Power(tuple(row)), start=start, width=w) for row, start, w in rows)


def b_splines(knots: Array, index: Indices, x: Array, degree: int) -> Array:
    """Values (degree + 1, n) at x (n,) of the B-splines that do not vanish from knots[index] to the next knot, (n,)."""
    values = np.ones((1, len(x)))
    for d in range(1, degree + 1):
        offset = np.arange(d)[:, None]
        low, high = knots[index - d + 1 + offset], knots[index + 1 + offset]
        share = values / (high - low)
        values = np.zeros((d + 1, len(x)))
        values[:-1] += share * (high - x)
        values[1:] += share * (x - low)
    return values


@dataclass(frozen=True)
class Ends:
    """Levels, mm or rad, at which a spline rests at its ends, S' = S'' = 0."""

    start: float
    end: float


def through(x: Array, s: Array, ends: Ends | None) -> tuple[AffineStretch, ...]:
    """Spline through values s (m + 1,) at sites x (m + 1,), as m polynomials; without `ends` periodic, s[-1] = s[0]."""
    basis = Basis(x, ends is None)
    inner = slice(1, -1) if ends else slice(0, -1)
    span, rows = basis.rows(x[inner])
    matrix = np.zeros((len(span), basis.size))
    np.add.at(matrix, (np.arange(len(span)), basis.columns(span)), rows)
    # coefficients at an end at rest are its level; the others solve for the inner values
    fixed = np.full(basis.size, np.nan)
    if ends:
        fixed[:_AT_REST], fixed[-_AT_REST:] = ends.start, ends.end
    free = np.isnan(fixed)
    known = np.where(free, 0.0, fixed)
    fixed[free] = np.linalg.solve(matrix[:, free], s[inner] - matrix @ known)
    return basis.spans(fixed)
