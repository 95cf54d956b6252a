"""Values each once, for the paths that every run takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


def distinct(values: Array) -> Array:
    """Return the values (m,) of an array (n,), rising and each once.

    The same as `numpy.unique`, which imports numpy.ma, a tenth of numpy's whole import, only to see whether its
    argument is masked.
    """
    ordered = np.sort(values)
    first = np.ones(ordered.size, dtype=np.bool_)
    first[1:] = ordered[1:] != ordered[:-1]
    return ordered[first]
