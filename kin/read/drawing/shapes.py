"""One entity of a drawing as numbers, in the plane and unit of the drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kin.contour.bezier import Beziers
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

__all__ = ["Shape", "UnfitError", "check", "shape"]

# Beyond this, in drawing units, the squares of coordinates have no digits left for a contour.
LARGEST = 1e7
LARGEST_BULGE = 1e6


class UnfitError(CamgeoError):
    """An entity that is no part of a plane contour: a reason out of read_error.REASONS, and what is wrong with it."""


class Shape(NamedTuple):
    """One entity: chords (k, 5) of x, y, x', y', bulge; arcs (k, 5) of x, y, radius, angle, sweep; or Bezier pieces.

    One of the three is filled, in order along the entity. Heights (h,) above the plane are kept to be compared.
    """

    chords: Array
    arcs: Array
    beziers: Beziers
    heights: Array

    @property
    def spans(self) -> int:
        """Number of pieces as the file counts them."""
        return len(self.chords) + len(self.arcs) + self.beziers.count


def shape(*, chords: Any = (), arcs: Any = (), beziers: Beziers | None = None, heights: Any) -> Shape:  # noqa: ANN401
    """Return a Shape, its numbers checked to be finite and of a size that can be computed with."""
    made = Shape(
        np.asarray(chords, dtype=np.float64).reshape(-1, 5),
        np.asarray(arcs, dtype=np.float64).reshape(-1, 5),
        Beziers.empty() if beziers is None else beziers,
        np.asarray(heights, dtype=np.float64).ravel(),
    )
    check(made.chords[:, :4], made.arcs, made.heights)
    check(made.chords[:, 4], limit=LARGEST_BULGE)
    return made


def check(*numbers: Array, limit: float = LARGEST) -> None:
    """Raise UnfitError for numbers that are not finite or too large."""
    for array in numbers:
        bad = array[~(np.abs(array) <= limit)]
        if bad.size:
            what = f"a value of {bad.flat[0]:g}" if np.isfinite(bad.flat[0]) else "a value that is not finite"
            raise UnfitError("range", what)
