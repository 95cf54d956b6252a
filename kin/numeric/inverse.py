"""Inverses of functions that rise: from a table of values and slopes by Newton's method."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.elementary import DomainError, Jet
from kin.numeric.jet import derivatives_by
from kin.numeric.newton import zeros
from kin.numeric.records import dataclass
from kin.numeric.taylor import factorials

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array

_CLOSE = 1e-9  # a step of Newton's method after which the next is lost in rounding
_SMALL = 1e-8  # of the greatest of a derivative: a change along a series whose square is rounding


@dataclass(frozen=True, eq=False)
class Inverse:
    """The inverse of a function that rises through the `places` (m,), smooth between them.

    `function(x (n,))` gives values and slopes above 0, (n,) each.
    """

    function: Callable[[Array], tuple[Array, Array]]
    places: Array

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        return self.function(self.places)

    def __call__(self, value: Array) -> Array:
        """Give x (n,) where the function has the values (n,), the end of the places for a value beyond its range.

        Newton's method begins from the cubic through two neighbours of the table of the inverse. Raises UnsettledError
        where the method does not end.
        """
        value, start, low, high = self._near(value)

        def over(x: Array) -> tuple[Array, Array]:
            at, slope = self.function(x)
            return at - value, slope

        return zeros(over, low, high, start, _CLOSE)

    def series(
        self,
        pair: Callable[[Jet], tuple[Jet, Jet]],
        value: Array,
        order: int,
        within: tuple[Array | float, Array | float] = (-np.inf, np.inf),
    ) -> Array:
        """Taylor coefficients (order + 1, n) of another function by the value of the inverted one, at values (n,).

        `pair(x)` gives jets of the other function, and of the inverted one, over x, kept `within` two ends. The last
        step of Newton's method is taken along the series, where it is small and one derivative more exists. Raises as
        a call and `pair` do.
        """
        value, x, _, _ = self._near(value)
        try:
            other, by = pair(Jet.variable(np.clip(x, *within), order + 1))
        except DomainError:
            return _by(*pair(Jet.variable(np.clip(self(value), *within), order)))
        rows = _by(other, by)
        left = value - by.c[0]
        change = np.arange(1.0, order + 2.0)[:, None] * rows[1:] * left
        rows, near = rows[:-1], np.abs(left) <= _CLOSE * by.c[1]
        if (near & (np.abs(change) <= _SMALL * np.abs(rows).max(axis=1, keepdims=True, initial=0.0))).all():
            rows += change
            return rows
        return _by(*pair(Jet.variable(np.clip(self(value), *within), order)))

    def _near(self, value: Array) -> tuple[Array, Array, Array, Array]:
        """Values (n,) within the table's range, and near each the cubic's x between two neighbours, and these, (n,)."""
        values, slopes = self._table
        value = np.clip(value, values[0], values[-1])
        k = np.clip(np.searchsorted(values, value, side="right") - 1, 0, len(values) - 2)
        low, high, wide = self.places[k], self.places[k + 1], values[k + 1] - values[k]
        share, rise, first, last = (value - values[k]) / wide, high - low, wide / slopes[k], wide / slopes[k + 1]
        bend = 3.0 * rise - 2.0 * first - last + share * (first + last - 2.0 * rise)
        return value, np.clip(low + share * (first + share * bend), low, high), low, high


def _by(f: Jet, parameter: Jet) -> Array:
    """Taylor coefficients (order + 1, n) of f by another parameter, both given as jets over one."""
    rows: Array = np.stack([row.c[0] for row in derivatives_by(f, parameter)]) / factorials(f.order)
    return rows
