"""Inverses of functions that rise: from a table of values and slopes by Newton's method."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.newton import zeros
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array

_CLOSE = 1e-9  # a step of Newton's method after which the next is lost in rounding


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
        values, slopes = self._table
        value = np.clip(value, values[0], values[-1])
        k = np.clip(np.searchsorted(values, value, side="right") - 1, 0, len(values) - 2)
        low, high, wide = self.places[k], self.places[k + 1], values[k + 1] - values[k]
        share, rise, first, last = (value - values[k]) / wide, high - low, wide / slopes[k], wide / slopes[k + 1]
        bend = 3.0 * rise - 2.0 * first - last + share * (first + last - 2.0 * rise)
        start = np.clip(low + share * (first + share * bend), low, high)

        def over(x: Array) -> tuple[Array, Array]:
            at, slope = self.function(x)
            return at - value, slope

        return zeros(over, low, high, start, _CLOSE)
