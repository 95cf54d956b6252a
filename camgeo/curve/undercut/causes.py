"""Causes of lost contact: reversals of the contour, and necks that a roller does not pass."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.curve.curvature import least_radius, reversals
from camgeo.curve.parallel import Parallel
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curvature import Reversal
    from camgeo.curve.curve import Curve
    from camgeo.curve.undercut.bottleneck import Neck, OpenNeckError


class UndercutError(CamgeoError, ValueError):
    """Undercut that leaves no single contour, or whose extent cannot be found.

    `parameter` is a place of its cause, None where none is known. `free_at`, mm, is the value that would be free of
    undercut: the largest roller radius, or for a flat face by how much the base radius must grow; None where it is not
    worked out.
    """

    def __init__(self, message: str, parameter: float | None = None, free_at: float | None = None) -> None:
        super().__init__(message)
        self.parameter, self.free_at = parameter, free_at

    def mirrored(self) -> UndercutError:
        """The error for the curve run through the other way, whose parameter is negated."""
        return UndercutError(str(self), None if self.parameter is None else -self.parameter, self.free_at)


@dataclass(frozen=True)
class Causes:
    """Causes of lost contact: reversals of the contour, and the narrowest necks of a pitch curve.

    `open` is set where there is undercut and narrower necks could be neither found nor excluded.
    """

    reversals: tuple[Reversal, ...]
    necks: tuple[Neck, ...]
    open: OpenNeckError | None = None

    @property
    def none(self) -> bool:
        """Whether the contour is free of undercut, and has no arc of radius 0 that ought to be a corner."""
        return not self.reversals and not self.necks


def in_ring(curve: Curve) -> bool:
    """Whether a contour is the opening of a ring: a parallel outside the pitch curve of its roller."""
    return isinstance(curve.shape, Parallel) and curve.shape.distance < 0.0


def follower_radius(curve: Curve) -> float:
    """Radius of the roller whose contour this is, mm: 0 for a knife edge, infinite for a flat face.

    Raises ValueError for an outer parallel.
    """
    if not isinstance(curve.shape, Parallel):
        from camgeo.curve.moving_frame import CentreShape

        return 0.0 if isinstance(curve.shape, CentreShape) else math.inf
    if not curve.shape.distance >= 0.0:
        raise ValueError(f"a roller's contour lies inside its pitch curve, not {-curve.shape.distance:g} mm outside")
    return curve.shape.distance


def causes(curve: Curve) -> Causes:
    """Reversals of a contour, and the narrowest necks that its roller does not pass; that there are no more is proved.

    Raises ValueError for an outer parallel and for a concave curve under a flat face, which cannot touch it; CurveError
    where undercut can be neither proved nor excluded.
    """
    radius = follower_radius(curve)
    reversed_stretches = reversals(curve)
    if math.isinf(radius):
        hollow = curve.cells.rows[3] < 0.0
        if hollow.any():
            raise ValueError(
                f"a flat face cannot touch the concave part near parameter {curve.cells.low[hollow][0]:.9g}"
            )
        return Causes(reversed_stretches, ())
    if radius == 0.0:  # a point passes every neck
        return Causes(reversed_stretches, ())
    from camgeo.curve.undercut.bottleneck import OpenNeckError, narrowest_necks, neck_from
    from camgeo.curve.undercut.pairs import Pitch

    # bent stretches are undercut already: necks count up to the pitch curve's least radius of curvature
    below = radius if not reversed_stretches else min(radius, radius + least_radius(curve)[0])
    pitch = Pitch.of(curve)
    try:
        return Causes(reversed_stretches, narrowest_necks(pitch, below))
    except OpenNeckError as error:
        # a pair of points that the roller does not pass is undercut, even if other pairs are undecided
        neck = neck_from(pitch, *error.pair) if error.seen else None
        if not reversed_stretches and (neck is None or not neck.half < radius):
            raise
        return Causes(reversed_stretches, () if neck is None or not neck.half < radius else (neck,), error)
