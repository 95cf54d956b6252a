"""Wunderlich's cams: the pitch curve of a double roller and the profile of a flat-faced pair (W sections 4, 5).

Both follow from the transmission law alone. With the half angle ``h = (psi + alpha)/2`` and the polar angle
``t = phi - h`` (W eq. 4.10), ``r = 2 l cos h`` is the polar radius of the pitch curve, or the support function of the
flat pair's cam.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.face import FaceShape
from camgeo.curve.moving_frame import FramedShape
from camgeo.curve.rates import cut
from kin.law.transmission_law import Transmission
from kin.numeric import elementary
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array


@dataclass(frozen=True)
class PitchShape(FramedShape[Transmission]):
    """Path of a roller's centre round the standing cam.

    In the complex plane the centre is ``c = l (exp(i phi) + exp(i chi))``, ``chi = phi - x``, ``x = psi + alpha``: the
    sum of pivot and arm, which is as long as the pivot is far. A trailing arm at the angle ``pi - x`` has the same
    moving frame, over any parameter,

        b = l phi' sin x,    a = l (phi' (1 + cos x) - psi'),    tau' = phi' - psi'.
    """

    @property
    def radii(self) -> Array:
        """Signed radii, mm (m,), of stretches that are arcs: dwells, and the arc that a law is made from; else nan."""
        return self.law.pitch_arcs[:, 2]

    def figures(self, tau: Series, side: Side = 1) -> tuple[Series, ...]:
        """The angles phi and psi, rad, at jets of the parameter."""
        return self.law.jets(tau, side)

    def frame(self, figures: tuple[Series, ...]) -> tuple[Series, Series, Series | float]:
        """Terms b, a, mm, and tau' of the moving frame as series, from the series phi and psi."""
        phi, psi = figures
        rate, slope = phi.derivative(), psi.derivative()
        x, arm = cut(psi, slope.order) + self.law.alpha, self.law.arm
        a = (elementary.cos(x) + 1.0) * rate - slope
        return elementary.sin(x) * rate * arm, a * arm, rate - slope

    def rows(self, t: Array, side: Side) -> tuple[Array, Array, Array, Array, Array]:
        """Point, mm, as complex numbers (n,), tau, rad (n,), and b, a, mm (3, n), tau' (2, n) with derivatives.

        They are at parameters t (n,) of the law, and the derivatives are by the parameter.
        """
        phi, psi = self.law.at(t, 3, side)
        # f, f1, f2 are derivatives of phi, s, s1, s2 of psi
        x = psi[0] + self.law.alpha
        (f, f1, f2), (s, s1, s2) = phi[1:], psi[1:]
        sine, cosine = np.sin(x), np.cos(x)
        # derivatives of sin x and of cos x
        sine1, cosine1 = cosine * s, -sine * s
        sine2, cosine2 = cosine * s1 - sine * s * s, -sine * s1 - cosine * s * s
        b = [sine * f, sine1 * f + sine * f1, sine2 * f + 2.0 * sine1 * f1 + sine * f2]
        a = [
            (cosine + 1.0) * f - s,
            cosine1 * f + (cosine + 1.0) * f1 - s1,
            cosine2 * f + 2.0 * cosine1 * f1 + (cosine + 1.0) * f2 - s2,
        ]
        centre = np.exp(1j * phi[0]) + np.exp(1j * (phi[0] - x))
        arm = self.law.arm
        return arm * centre, phi[0] - x + 0.5 * np.pi, arm * np.stack(b), arm * np.stack(a), phi[1:3] - psi[1:3]


@dataclass(frozen=True)
class FlatPairShape(FaceShape[Transmission]):
    """Profile of a flat pair's cam, a curve with an isoptic circle: r is its support function (W section 5)."""
