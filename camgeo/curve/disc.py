"""Flat faces of disc cams: where the face stands at each shaft angle, and where the cam touches it.

A face is a support function: its distance p from the shaft over the direction t of its normal. Per shaft angle theta

    straight, normal tilted by beta     t = theta + beta               p = Rb + S cos beta
    oscillating, face f nearer the cam  t = theta + s (psi - pi/2)     p = C sin psi - f

with the displacement S, the base radius Rb, the pivot at the distance C, psi = rest + S and s = 1 trailing, -1 leading.
The contact is ``E(t)(p + i q)``, E(t) = exp(i t), q = p'/t' (`camgeo.curve.face`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.extremes import least, surely_positive
from camgeo.curve.face import FaceShape
from camgeo.curve.rates import cut, stretches
from kin.law.normalised import IntentError
from kin.numeric import elementary
from kin.numeric.elementary import Jet
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from camgeo.curve.moving_frame import Displacement
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array, Mask


@dataclass(frozen=True)
class _Face(ABC):
    """A face with its motion: S, mm on a stem, rad on an arm."""

    motion: Displacement

    @abstractmethod
    def contact(self, tau: Series, side: Side = 1) -> Series:
        """Place of contact along the face, mm, at jets of the shaft angle."""

    @abstractmethod
    def slope(self, tau: Series, side: Side = 1) -> Series:
        """Tangent of the pressure angle at jets of the shaft angle."""

    def pressure_angle(self, theta: Array) -> Array:
        """Pressure angle, rad (n,), at shaft angles `theta` (n,), rad."""
        angle: Array = np.arctan(self.slope(Jet.variable(theta, 1)).c[0])
        return angle

    def place(self, theta: Array) -> Array:
        """Place of contact (n,), mm along the face from the stem's axis or the pivot's foot, at angles (n,), rad."""
        return np.asarray(self.contact(Jet.variable(theta, 1)).c[0])

    @property
    def breaks(self) -> Array:
        """Shaft angles (m,), rising, at which a derivative of the motion may jump."""
        return self.motion.breaks

    @property
    def repeats(self) -> int:
        """Number of equal parts of the motion."""
        return self.motion.repeats


@dataclass(frozen=True)
class StraightFace(_Face):
    """A face on a stem, `base` mm from the shaft at S = 0, its normal turned ahead of travel by `tilt` (rad).

    `offset`, mm, is the eccentricity of the stem: it moves the place of contact on the face, not the cam. The stem
    stands `turned` ahead of the shaft angle, rad. Raises IntentError for a tilt of 90 degrees or more.
    """

    base: float
    tilt: float = 0.0
    offset: float = 0.0
    turned: float = 0.0

    def __post_init__(self) -> None:
        if not abs(self.tilt) < 0.5 * math.pi:
            raise IntentError(
                f"a face tilted by {math.degrees(self.tilt):.6g} degrees is not driven; below 90 it is", "follower.tilt"
            )

    @property
    def steady(self) -> Mask:
        """Whether the contour is a circular arc on each stretch (m,): a dwell, or an eccentric."""
        return self.motion.eccentric

    def polar(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Distance from the shaft, mm, and direction of the normal, rad, at jets of the shaft angle."""
        return self.motion.on(tau, side) * math.cos(self.tilt) + self.base, tau + (self.tilt + self.turned)

    def pitch(self, tau: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Distance from the shaft, mm, and direction of the normal, rad, with derivatives: (order + 1, n) each.

        They are at shaft angles `tau` (n,), rad.
        """
        p = self.motion.derivatives(tau, order, side) * math.cos(self.tilt)
        p[0] += self.base
        t = np.zeros_like(p)
        t[0], t[1:2] = tau + (self.tilt + self.turned), 1.0
        return p, t

    @property
    def level(self) -> float:
        """Place at which the face crosses the stem's axis at S = 0, mm along the axis from the foot of the shaft."""
        return (self.base - self.offset * math.sin(self.tilt)) / math.cos(self.tilt)

    def contact(self, tau: Series, side: Side = 1) -> Series:
        """Place of contact along the face, mm from the stem's axis, above 0 ahead of the axis."""
        s, sine, cosine = self.motion.on(tau, side), math.sin(self.tilt), math.cos(self.tilt)
        v = s.derivative()
        return v * cosine + (cut(s, v.order) + self.level) * sine - self.offset * cosine

    def slope(self, tau: Series, side: Side = 1) -> Series:
        """Tangent of the pressure angle, which is the tilt, as a constant series."""
        return self.motion.on(tau, side) * 0.0 + math.tan(self.tilt)


@dataclass(frozen=True)
class SwingingFace(_Face):
    """A face on an arm about a pivot at distance C, `face` mm nearer the cam than its parallel through the pivot.

    psi = rest + S, rad, is its angle to the line from pivot to shaft; `side` s is 1 trailing, -1 leading. Raises
    IntentError where the face would reach the line, or the contact the pivot (psi = 90 degrees), or the face swing as
    fast as the cam turns: 1 + s psi' must stay above 0.
    """

    pivot: float
    face: float
    rest: float
    side: int

    @staticmethod
    def on(motion: Displacement, base: float, pivot: float, face: float, side: int) -> SwingingFace:
        """Face that stands `base` mm from the shaft at S = 0, psi acute; raises IntentError where none can follow."""
        return SwingingFace(motion, pivot, face, rest_of(base, pivot, face), side)

    def __post_init__(self) -> None:
        low, high = (self.rest + s for s in self.motion.range)
        if not (low > 0.0 and high < 0.5 * math.pi):
            raise IntentError(
                f"the face swings from {math.degrees(low):.6g} to {math.degrees(high):.6g} degrees to the line from "
                "pivot to shaft; at 90 the contact reaches the pivot, and only angles between 0 and 90 can be driven",
                "follower.arm",
            )
        if surely_positive(self._rate, stretches(self.motion)):
            return
        slowest = least(self._rate, stretches(self.motion))
        if not slowest.value > 0.0:
            raise IntentError(
                f"at {math.degrees(slowest.at):.6g} degrees the face swings back {1.0 - slowest.value:.6g} times as "
                "fast as the cam turns; a cam can be turned through below 1",
                "motion",
            )

    def _rate(self, tau: Series, side: Side = 1) -> Series:
        return self.motion.on(tau, side).derivative() * float(self.side) + 1.0

    @property
    def base(self) -> float:
        """Distance of the face from the shaft at S = 0, mm."""
        return self.pivot * math.sin(self.rest) - self.face

    @property
    def steady(self) -> Mask:
        """Whether each stretch (m,) is a dwell."""
        return self.motion.steady

    def polar(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Distance from the shaft, mm, and direction of the normal, rad, at jets of the shaft angle."""
        psi, sense = self.motion.on(tau, side) + self.rest, float(self.side)
        return elementary.sin(psi) * self.pivot - self.face, tau + (psi - 0.5 * math.pi) * sense

    def pitch(self, tau: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Distance from the shaft, mm, and direction of the normal, rad, with derivatives: (order + 1, n) each.

        They are at shaft angles `tau` (n,), rad.
        """
        p, t = self.polar(Jet.variable(tau, order), side)
        return p.derivatives(), t.derivatives()

    def contact(self, tau: Series, side: Side = 1) -> Series:
        """Place of contact along the face, mm from the foot of the pivot."""
        psi = self.motion.on(tau, side) + self.rest
        rate = psi.derivative() * float(self.side) + 1.0
        return elementary.cos(cut(psi, rate.order)) * self.pivot / rate

    def slope(self, tau: Series, side: Side = 1) -> Series:
        """Tangent of the pressure angle: `face` over the place of contact."""
        return self.face / self.contact(tau, side)


def rest_of(base: float, pivot: float, face: float) -> float:
    """Angle, 0 to pi/2 rad, between a face `base` mm from the shaft and the line from pivot to shaft.

    `pivot` is the pivot's distance and `face` how much nearer the shaft the face is than its parallel through the
    pivot, mm. Raises IntentError where base and face together do not lie between 0 and the pivot's distance.
    """
    if not 0.0 < base + face < pivot:
        raise IntentError(
            f"base radius and face offset together, {base + face:.6g} mm, must lie between 0 and the pivot's "
            f"distance, {pivot:.6g} mm",
            "follower.arm",
        )
    return math.asin((base + face) / pivot)


Face = StraightFace | SwingingFace


def face_shape(face: Face) -> FaceShape[Face]:
    """Contour of the cam that drives a flat face."""
    return FaceShape(face)
