"""Types of the arrays that functions take and give, one number for a pair of indices, and numbers of runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Complexes = NDArray[np.complex128]
    Indices = NDArray[np.intp]
    Mask = NDArray[np.bool_]
else:  # numpy.typing is for type checkers, and slow to import
    Array = Complexes = Indices = Mask = np.ndarray


def paired(first: Indices, second: Indices, size: int) -> NDArray[np.int64]:
    """Return one number (n,) for each ordered pair of indices `first` (n,), `second` (n,) below `size`.

    The number has 64 bits, also where an index has 32 (Python in a browser), in which the product would overflow.
    """
    return first.astype(np.int64, copy=False) * size + second


def runs_of(count: Indices) -> tuple[Indices, Indices]:
    """Return for each entry of runs of `count` (n,) entries the number of its run, and its place in that, (m,) each."""
    own = np.repeat(np.arange(len(count)), count)
    return own, np.arange(len(own)) - np.repeat(np.cumsum(count) - count, count)
