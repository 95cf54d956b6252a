"""Precision of the numbers of a format: distance that writing moves a vertex, and the tolerance left to the fit.

An STL holds single-precision numbers, so that at 50 mm a vertex moves by up to 2.7e-6 mm. A 3MF holds decimals, of
which nine are written: 7.1e-10 mm. A PLY holds doubles. Programs that save a file again mostly do so in single
precision; where the tolerance allows it, that is kept back too.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.rounding import upward
from camgeo.fit.nodes import ToleranceError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.fit.pieces import Outline
    from kin.numeric.arrays import Array

# Least tolerance that is accepted, in worst displacements of a vertex. The fit is then left e, a quarter of the
# displacement, and the sagitta over two edges, 8 e, is twice the displacement, so that rounding makes no dent. The same
# holds for the numbers in which a file is saved again; a finer tolerance is kept by the file alone.
_LEAST = 1.25


@dataclass(frozen=True)
class Precision:
    """Precision of the coordinates of a file.

    file, name   as messages have them: "an STL", "single precision"
    nearest      gives the numbers that are written for an array of numbers, in its shape
    spacing      upper bound, mm, of the distance between neighbouring numbers up to a size, mm
    again        precision of coarser numbers in which other programs save the file again; None for none
    """

    file: str
    name: str
    nearest: Callable[[Array], Array]
    spacing: Callable[[float], float]
    again: Precision | None = None

    def in_units(self, mm: float) -> Precision:
        """Precision, of lengths in mm, of a file whose unit is `mm` mm long and whose numbers have this precision."""
        if mm == 1.0:
            return self

        def spacing(size: float) -> float:
            return mm * self.spacing(size / mm) + 4.0 * float(np.spacing(size))  # the quotient and the product round

        coarser = None if self.again is None else self.again.in_units(mm)
        return replace(self, nearest=lambda values: self.nearest(values / mm) * mm, spacing=spacing, again=coarser)

    def rounded(self, points: Array) -> tuple[Array, float]:
        """Points (n, d) as written, mm, without negative zeros, and the greatest distance that one moved, mm."""
        nearest: Array = self.nearest(points) + 0.0
        return nearest, float(np.sqrt(np.sum((nearest - points) ** 2, axis=1)).max())

    def number(self, value: float) -> float:
        """Length in mm as written."""
        return float(self.nearest(np.array([value]))[0])

    def bound(self, size: float) -> float:
        """Greatest distance, mm, that rounding moves a plane point with coordinates up to `size` mm."""
        return math.sqrt(0.5) * self.spacing(abs(size))

    def fit_tolerance(self, tolerance: float, size: float) -> float:
        """Tolerance, mm, that is left to the fit of a polygon with coordinates up to `size` mm.

        The error of saving the file again in coarser numbers is subtracted too, where enough is left. Raises
        ToleranceError, with the least tolerance that can be held, where too little is left.
        """
        moved = self.bound(size + tolerance)
        if not tolerance >= _LEAST * moved:
            # a tolerance of the refused size no longer widens the contour, the least one does
            least = _LEAST * self.bound(size + 2.0 * _LEAST * self.bound(size))
            raise ToleranceError(
                f"{self.file} of a contour that reaches {size:.6g} mm from the origin cannot hold {tolerance:.3g} mm: "
                f"rounding to {self.name} alone moves points by {moved:.3g} mm; at least {upward(least, 3)} mm",
                least,
            )
        remainder, moved_again = tolerance - moved, 0.0 if self.again is None else self.again.bound(size + tolerance)
        return remainder - moved_again if remainder >= _LEAST * moved_again else remainder

    def within(self, noun: str, deviation: float, tolerance: float) -> None:
        """Raise ToleranceError for a deviation, mm, that is above the tolerance or nan; `noun` begins its message."""
        if not deviation <= tolerance:
            raise ToleranceError(
                f"{self.file}: {noun} would be off by {deviation:.6g} mm in {self.name}, more than {tolerance:.6g} mm",
                deviation,
            )


def conversion_error(outline: Outline) -> float:
    """Greatest distance, mm, that writing an outline in another unit and reading it back moves one of its points.

    A quotient and a product of each coordinate, each of which rounds by half a unit in the last place, and a factor
    that is no double itself: two and a half in all, sqrt(2) times as much in the plane, and twice that for the control
    points of a spline, which lie outside.
    """
    return 8.0 * float(np.spacing(np.abs(outline.box()).max()))


def _single(values: Array) -> Array:
    return values.astype(np.float32).astype(np.float64)


_UNIT = 1e9


def _nine_decimals(values: Array) -> Array:
    # a quotient is rounded once: what is read back from nine decimals is this very double
    rounded: Array = np.round(values * _UNIT) / _UNIT
    return rounded


SINGLE = Precision("an STL", "single precision", _single, lambda size: float(np.spacing(np.float32(size))))
# the product above is rounded too, which shows beyond 4.5 km
DECIMALS = Precision(
    "a 3MF", "nine decimals", _nine_decimals, lambda size: 1.0 / _UNIT + 2.0 * float(np.spacing(size)), again=SINGLE
)
DOUBLE = Precision(
    "a PLY", "double precision", lambda values: values, lambda size: float(np.spacing(size)), again=SINGLE
)
