"""Numbers for a page's script: rounded to what a picture shows, and as differences, which are short."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.report.page.scene import digits_for

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

WHOLE = 2.0**52  # of a script's numbers, up to which differences of whole ones are exact
SHARE = 1e-5  # of its range: to this a row of numbers is rounded


def pack_numbers(values: Array, extent: float | None = None) -> dict[str, Any]:
    """Return values (n,) as `{"d": digits, "v": [first, step, step, ...]}` in units of the last digit.

    Rounded to `SHARE` of the extent, by default of the range of the values, but to no more than sixteen places. A row
    with values that are not finite is `{"n": [...]}`, null where they are not; one that is constant is a plain number.
    """
    good = values[np.isfinite(values)]
    spread = float(np.ptp(good)) if good.size else 0.0
    extent = spread if extent is None else extent
    largest = float(np.abs(good).max(initial=0.0))
    if good.size == values.size and spread <= 1e-13 * largest:
        return {"c": float(f"{values[0]:.12g}")} if values.size else {"n": []}
    digits = digits_for(extent, SHARE)
    if good.size < values.size:
        return {"n": [round(v, digits) if np.isfinite(v) else None for v in values.tolist()]}
    if largest > WHOLE / 10.0**digits:
        digits = math.floor(math.log10(WHOLE) - math.log10(largest))
    whole = np.round(values * 10.0**digits).astype(np.int64)
    return {"d": digits, "v": [int(whole[0]), *np.diff(whole).tolist()]}
