"""Fits of ISO 286 between bore and shaft, and of parallel keys: limits of size in mm.

Limits of ISO 286-2 for sizes up to 120 mm. Those of bores and keyways are the part's; those of shafts follow from the
standard tolerance IT6 = 10 i of ISO 286-1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from camgeo.part.iso286 import HOLES, KEYWAYS, deviations
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

# lower and upper deviation from the nominal size in each range, micrometres
SHAFTS: Mapping[str, tuple[tuple[float, float], ...]] = {
    "h6": ((-6, 0), (-8, 0), (-9, 0), (-11, 0), (-13, 0), (-16, 0), (-19, 0), (-22, 0)),
    "g6": ((-8, -2), (-12, -4), (-14, -5), (-17, -6), (-20, -7), (-25, -9), (-29, -10), (-34, -12)),
    "k6": ((0, 6), (1, 9), (1, 10), (1, 12), (2, 15), (2, 18), (2, 21), (3, 25)),
}


class Clearance(NamedTuple):
    """Least and greatest clearance of a fit, mm of diameter or width; a clearance below 0 is an interference."""

    least: float
    most: float


def clearance(hole: str, shaft: str, diameter: float) -> Clearance:
    """Clearance between a bore of a class `hole` (H7) and a shaft of a class `shaft` (h6, g6, k6), mm.

    Raises ValueError for a diameter, mm, that is not above 0 and at most 120, KeyError for another class.
    """
    low, high = deviations(HOLES[hole], diameter)
    least, most = deviations(SHAFTS[shaft], diameter)
    return Clearance(low - most, high - least)


def key_clearance(keyway: str, width: float) -> Clearance:
    """Clearance of a key h9 in a keyway of a class JS9 or P9, mm.

    Raises ValueError for a width, mm, that is not above 0 and at most 120, KeyError for another class.
    """
    low, high = deviations(KEYWAYS[keyway], width)
    key = deviations(KEYWAYS["JS9"], width)  # as wide as h9, whose upper limit is 0
    return Clearance(low, high + key[1] - key[0])


@dataclass(frozen=True)
class ShaftFit:
    """How far a cam may stand off its place on its shaft: by half the greatest clearances of bore and key.

    `bore` is the distance of the cam's axis from the shaft's, mm. `angle` is the turn to either side of the key's
    middle, rad; None without a key.
    """

    bore: float
    angle: float | None


def fit_of(
    diameter: float, hole: str, shaft: str, keyways: tuple[str, str] | None = None, width: float | None = None
) -> ShaftFit:
    """How far a cam may stand off its place on a shaft, 0 where a fit is always tight.

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
