"""Profiles of flat-faced followers: the envelope of the face (AS eqs. 2, 3; SW eqs. 14, 17)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import Bounds, Curve, Frame, SmoothRun, columns
from kin.numeric.records import dataclass
from kin.numeric.taylor import factorials

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from kin.law.support_function import Lift
    from kin.numeric.arrays import Array
    from kin.numeric.jet import Series


@dataclass(frozen=True)
class SupportShape:
    """The curve whose support function is a face's lift: ``c = p u + p' n``, ``sigma = p + p''``, ``omega = 1``.

    u is the outward normal, n the tangent. The parameter is the direction of the outward normal, which is the shaft
    angle. SW's second half turn with the sign of [d - L] corrected is the same formula (docs/validation.md).
    """

    lift: Lift

    @property
    def period(self) -> float:
        """Period of the parameter: a full turn, 2 pi rad."""
        return 2.0 * np.pi

    @property
    def breaks(self) -> Array:
        """Parameters (m,), rising, at which the radius of curvature or its derivatives may jump."""
        return self.lift.breaks

    @property
    def repeats(self) -> int:
        """Number of equal parts of the curve per turn: always 1, as equal parts are not used."""
        return 1

    @property
    def steady(self) -> Array:
        """Speed and turn, mm and rad per rad of the parameter, (m, 2), on stretches that are circular arcs; else nan.

        The speed is the signed radius of curvature, the turn 1.
        """
        radius = self.lift.radius
        return np.column_stack([radius, np.where(np.isnan(radius), np.nan, 1.0)])

    @property
    def radii(self) -> Array:
        """Signed radii of the stretches that are circular arcs, mm, nan of the others, (m,)."""
        return self.lift.radius

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at normal directions t (n,), rad; at a break the limit from above (side 1) or from below (side -1)."""
        p = self.lift.derivatives(t, 3, side)
        cosine, sine = np.cos(t), np.sin(t)
        point = columns(p[0] * cosine - p[1] * sine, p[0] * sine + p[1] * cosine)
        return Frame(point, columns(-sine, cosine), p[0] + p[2], np.ones_like(t), p[1] + p[3], np.zeros_like(t))

    def place(self, t: Array) -> Array:
        """Place of contact p' (n,), mm along the face from the line through the shaft, at shaft angles t (n,), rad."""
        slope: Array = self.lift.derivatives(t, 1)[1]
        return slope

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn at normal directions t (n,)."""
        p = self.lift.derivatives(t, order + 2, side)
        speed = (p[:-2] + p[2:]) / factorials(order)
        turn = np.zeros_like(speed)
        turn[0] = 1.0
        return speed, turn

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, as series at jets `tau`, of two orders fewer."""
        speed = self.lift.radius_on(tau, side)
        return speed, speed * 0.0 + 1.0

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds over intervals [low, high] (n,): the speed is the radius of curvature, the turn 1."""
        mid, rad = self.lift.radius_enclosure(low, high, 2)
        ones, zeros = np.ones_like(low), np.zeros_like(low)
        size = np.abs(mid) + rad
        return Bounds(mid[0] - rad[0], mid[0] + rad[0], ones, ones, size[1], zeros, size[2], zeros)


def with_corners(curve: Curve) -> Curve:
    """Copy of a whole curve with corners for its arcs of radius 0: an open run for each stretch between them.

    It is the curve itself where no stretch, or every stretch, has radius 0. All stretches between corners are arcs, as
    in a Reuleaux polygon.
    """
    stretches = curve.runs[0].stretches
    arcs = [stretch for stretch in stretches.tolist() if curve.radius(stretch) != 0.0]
    if len(arcs) in {0, len(stretches)}:
        return curve
    return Curve(curve.shape, tuple(SmoothRun(low, high, (), closed=False) for low, high in arcs))


def is_sharp(contour: Curve) -> bool:
    """Whether a contour has corners at all arcs of radius 0 of its shape and at no other place: it is not trimmed."""
    return not contour.closed and contour == with_corners(Curve.whole(contour.shape))
