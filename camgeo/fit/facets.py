"""Triangles on a curved surface: how far they may be from it, by bounds of its second derivatives.

A triangle whose corners lie on a surface p(a, b) within h1 by h2 of its parameters is off by at most

    (h1^2 M11 + 2 h1 h2 M12 + h2^2 M22)/8,   M bounds of |p_ij|

(D. Filip, R. Magedson, R. Markot, Surface algorithms using bounds on derivatives, CAGD 3, 1986). The corners may lie
anywhere in the cell: the sum of weights times squared differences from the mean is a variance. Of what lies along the
surface only the second order counts. With N bounds of |p_ij . n|, and n turning by t over the cell, the distance from
the surface is at most that of N, and `BESIDE` t times that of M.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

BESIDE = 2.1  # once for the normal of the place in place of the cell's, once for the surface beside the foot
TINY = 1e-300  # keeps a quotient finite whose parts are both 0
STEPS = 2  # by which a cell is made narrower until it holds its tolerance


class Curved(Protocol):
    """Protocol of bounds over cells (n,), in mm and units of the parameters a and b."""

    @property
    def across(self) -> Array:
        """Bounds of |p_ij . n|, (3, n): twice by a, by a and b, twice by b."""
        ...

    @property
    def whole(self) -> Array:
        """Bounds of |p_ij|, (3, n)."""
        ...

    @property
    def turns(self) -> Array:
        """Bounds of the turn of the normal by a and by b, (2, n)."""
        ...


def facets_off(cells: Curved, h1: Array, h2: Array | float) -> Array:
    """Bound of the distance of triangles from the surface, mm (n,), in cells of h1 by h2."""
    square = np.stack([h1 * h1, 2.0 * h1 * h2, h2 * h2 + 0.0 * h1]) / 8.0
    turn = cells.turns[0] * h1 + cells.turns[1] * h2
    bound: Array = np.sum(square * cells.across, axis=0) + BESIDE * turn * np.sum(square * cells.whole, axis=0)
    return bound


def facets_width(cells: Curved, h2: Array | float, tolerance: float) -> Array:
    """Widths h1 (n,) of cells of h2 whose triangles are within a tolerance, mm; 0 where none is."""
    rest = facets_off(cells, np.zeros_like(cells.turns[0]), h2)
    left = tolerance - rest
    b = cells.across[1] * h2
    h1 = 8.0 * np.abs(left) / (b + np.sqrt(b * b + 8.0 * cells.across[0] * np.abs(left)) + TINY)
    h1 = np.minimum(h1, 1.0)
    for _ in range(STEPS):  # above its value at 0 the bound is convex, so that it falls by the share at least
        h1 = h1 * np.minimum(1.0, left / (facets_off(cells, h1, h2) - rest + TINY))
    return np.where(left > 0.0, h1, 0.0)
