"""Fits of ISO 286 between bore and shaft, and of parallel keys: limits of size in mm.

Limits of ISO 286-2 for sizes up to 120 mm; H7, h6, JS9 and the widths of P9 follow from the standard tolerances of
ISO 286-1, IT6 = 10 i, IT7 = 16 i, IT9 = 40 i with i = 0.45 D^(1/3) + 0.001 D in micrometres, D the geometric mean
of the range in mm.
"""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING, NamedTuple

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

UPPER_ENDS = (3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0)  # of the ranges of sizes, inclusive, mm
MICROMETRE = 1e-3  # in mm


def _mirrored(*limits: float) -> tuple[tuple[float, float], ...]:
    return tuple((-limit, limit) for limit in limits)


# lower and upper deviation from the nominal size in each range, micrometres
HOLES: Mapping[str, tuple[tuple[float, float], ...]] = {
    "H7": ((0, 10), (0, 12), (0, 15), (0, 18), (0, 21), (0, 25), (0, 30), (0, 35)),
}
SHAFTS: Mapping[str, tuple[tuple[float, float], ...]] = {
    "h6": ((-6, 0), (-8, 0), (-9, 0), (-11, 0), (-13, 0), (-16, 0), (-19, 0), (-22, 0)),
    "g6": ((-8, -2), (-12, -4), (-14, -5), (-17, -6), (-20, -7), (-25, -9), (-29, -10), (-34, -12)),
    "k6": ((0, 6), (1, 9), (1, 10), (1, 12), (2, 15), (2, 18), (2, 21), (3, 25)),
}
KEYWAYS: Mapping[str, tuple[tuple[float, float], ...]] = {
    "JS9": _mirrored(12.5, 15, 18, 21.5, 26, 31, 37, 43.5),
    "P9": ((-31, -6), (-42, -12), (-51, -15), (-61, -18), (-74, -22), (-88, -26), (-106, -32), (-124, -37)),
}


class Clearance(NamedTuple):
    """Least and greatest clearance of a fit, mm of diameter or width; a clearance below 0 is an interference."""

    least: float
    most: float


def clearance(hole: str, shaft: str, diameter: float) -> Clearance:
    """Clearance between a bore of a class `hole` (H7) and a shaft of a class `shaft` (h6, g6, k6), mm.

    Raises ValueError for a diameter, mm, that is not above 0 and at most 120, KeyError for another class.
    """
    low, high = _limits(HOLES[hole], diameter)
    least, most = _limits(SHAFTS[shaft], diameter)
    return Clearance(low - most, high - least)


def key_clearance(keyway: str, width: float) -> Clearance:
    """Clearance of a key h9 in a keyway of a class JS9 or P9, mm.

    Raises ValueError for a width, mm, that is not above 0 and at most 120, KeyError for another class.
    """
    low, high = _limits(KEYWAYS[keyway], width)
    key = _limits(KEYWAYS["JS9"], width)  # as wide as h9, whose upper limit is 0
    return Clearance(low, high + key[1] - key[0])


def _limits(ranges: tuple[tuple[float, float], ...], size: float) -> tuple[float, float]:
    """Lower and upper deviation of a size, mm; raises ValueError outside the table."""
    if not 0.0 < size <= UPPER_ENDS[-1]:
        raise ValueError(f"the table of fits reaches to {UPPER_ENDS[-1]:g} mm")
    low, high = ranges[bisect_left(UPPER_ENDS, size)]
    return low * MICROMETRE, high * MICROMETRE


@dataclass(frozen=True)
class ShaftFit:
    """Greatest play of a cam on its shaft.

    `bore` is how far the cam's axis may stand off the shaft's, mm. `angle` is how far the cam may turn to either side
    of the key's middle, rad; None without a key.
    """

    bore: float
    angle: float | None


def fit_of(
    diameter: float, hole: str, shaft: str, keyways: tuple[str, str] | None = None, width: float | None = None
) -> ShaftFit:
    """Greatest play of a cam on a shaft, 0 where a fit is always tight.

    `hole` and `shaft` are the tolerance classes at a `diameter`, mm. `keyways` are the classes of the hub's and the
    shaft's keyway of a `width`, mm; without them, or without a width, the angle is None. Raises ValueError for a
    diameter or a width that is not above 0 and at most 120 mm.
    """
    radial = 0.5 * max(clearance(hole, shaft, diameter).most, 0.0)
    if keyways is None or width is None:
        return ShaftFit(radial, None)
    play = sum(max(key_clearance(keyway, width).most, 0.0) for keyway in keyways)
    # half the play, at half the diameter from the axis
    return ShaftFit(radial, play / diameter)
