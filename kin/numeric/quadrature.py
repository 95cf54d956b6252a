"""Gauss and Legendre's rule."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


@cache
def gauss(count: int) -> tuple[Array, Array]:
    """Nodes in [-1, 1], ascending, and weights (count,) that integrate polynomials below the degree 2 count exactly.

    They are the eigenvalues of the Legendre polynomials' matrix of recurrence, and twice the squares of its
    eigenvectors' first entries (G. H. Golub, J. H. Welsch, Mathematics of Computation 23, 1969), to rounding. numpy's
    own rule takes longer to import than a cam takes to be made.
    """
    k = np.arange(1.0, count)
    beside = k / np.sqrt(4.0 * k * k - 1.0)
    nodes, vectors = np.linalg.eigh(np.diag(beside, -1))  # of the lower half
    return nodes, 2.0 * vectors[0] ** 2
