"""Tolerance classes of ISO 286-2 that bores and keyways have: lower and upper deviation from the nominal size, mm.

H7, JS9 and the widths of P9 follow from the standard tolerances of ISO 286-1, IT7 = 16 i, IT9 = 40 i with
i = 0.45 D^(1/3) + 0.001 D in micrometres, D the geometric mean of the range in mm.
"""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

UPPER_ENDS = (3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0)  # of the ranges of sizes, inclusive, mm
MICROMETRE = 1e-3  # in mm

# in each range, micrometres
HOLES: Mapping[str, tuple[tuple[float, float], ...]] = {
    "H7": ((0, 10), (0, 12), (0, 15), (0, 18), (0, 21), (0, 25), (0, 30), (0, 35)),
}
KEYWAYS: Mapping[str, tuple[tuple[float, float], ...]] = {
    "JS9": ((-12.5, 12.5), (-15, 15), (-18, 18), (-21.5, 21.5), (-26, 26), (-31, 31), (-37, 37), (-43.5, 43.5)),
    "P9": ((-31, -6), (-42, -12), (-51, -15), (-61, -18), (-74, -22), (-88, -26), (-106, -32), (-124, -37)),
}


def deviations(ranges: Sequence[tuple[float, float]], size: float) -> tuple[float, float]:
    """Lower and upper deviation, mm, of a size in mm in a class such as HOLES["H7"].

    Raises ValueError for a size that is not above 0 and at most 120 mm.
    """
    if not 0.0 < size <= UPPER_ENDS[-1]:
        raise ValueError(f"the table of fits reaches to {UPPER_ENDS[-1]:g} mm")
    low, high = ranges[bisect_left(UPPER_ENDS, size)]
    return low * MICROMETRE, high * MICROMETRE
