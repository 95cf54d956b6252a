"""The kinds of array that every room passes on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Indices = NDArray[np.intp]
    Mask = NDArray[np.bool_]
else:  # numpy.typing is for type checkers, and slow to import
    Array = Indices = Mask = np.ndarray
