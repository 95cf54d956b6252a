"""Wunderlich's cams: the pitch curve of a double roller and the profile of a flat-faced pair (W sections 4, 5).

Both follow from the transmission law alone. With the half angle ``h = (psi + alpha)/2`` and the polar angle
``t = phi - h`` (W eq. 4.10), ``r = 2 l cos h`` is the polar radius of the pitch curve, or the support function of the
flat pair's cam.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import Bounds, Frame, columns
from camgeo.curve.face import FaceShape
from camgeo.curve.rates import OfLaw, bounds_of, cut, series_of
from kin.law.transmission_law import Transmission
from kin.numeric import elementary

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array


@dataclass(frozen=True)
class PitchShape(OfLaw[Transmission]):
    """Path of a roller's centre round the standing cam.

    In the complex plane the centre is ``c = l (exp(i phi) + exp(i chi))``, ``chi = phi - psi - alpha``: the pivot and
    the arm. That form keeps every digit and gives, with a = phi', b = chi' = a - psi', h = (psi + alpha)/2,

        (sigma/l)^2 = psi'^2 + 4 a b cos^2 h,
        omega = (a + b)/2 (1 + psi'^2 l^2/sigma^2) + (a psi'' - a' psi') sin 2h l^2/sigma^2,

    sums in which nothing cancels: a and b are positive where the cam can be turned through.
    """

    @property
    def radii(self) -> Array:
        """Radii of the stretches that are circular arcs (m,): dwells, and the arcs of a law made from an arc."""
        return self.law.pitch_arcs[:, 2]

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,) of the law."""
        rows_phi, rows_psi = self.law.at(t, 3, side)
        phi, chi = rows_phi[0], rows_phi[0] - rows_psi[0] - self.law.alpha
        arm = self.law.arm
        pivot, end = (np.cos(phi), np.sin(phi)), (np.cos(chi), np.sin(chi))
        point = arm * columns(pivot[0] + end[0], pivot[1] + end[1])
        a, b = rows_phi[1], rows_phi[1] - rows_psi[1]
        velocity = columns(-a * pivot[1] - b * end[1], a * pivot[0] + b * end[0])
        length = np.hypot(velocity[:, 0], velocity[:, 1])
        return Frame(point, velocity / length[:, None], *self._rates_at(rows_phi, rows_psi))

    def _rates_at(self, phi: Array, psi: Array) -> tuple[Array, Array, Array, Array]:
        """Speed, turn and their slopes (n,) from derivatives (4, n) of phi and psi: `_rates` by hand."""
        (a, a1, a2), (s, s1, s2) = phi[1:], psi[1:]
        b, b1 = a - s, a1 - s1
        half = 0.5 * (psi[0] + self.law.alpha)
        cosine, sine = np.cos(half), np.sin(half)
        double, square = 2.0 * sine * cosine, 4.0 * cosine**2
        lean, cross = s * s, a * s1 - a1 * s
        # with q = (sigma/l)^2: omega = (a + b)/2 + part/q
        q = lean + a * b * square
        q1 = 2.0 * s * s1 + (a1 * b + a * b1) * square - 2.0 * a * b * s * double
        part = 0.5 * (a + b) * lean + cross * double
        part1 = 0.5 * (a1 + b1) * lean + (a + b) * s * s1 + (a * s2 - a2 * s) * double
        part1 += cross * s * (0.5 * square - 1.0)
        root, share = np.sqrt(q), part / q
        turn_slope = 0.5 * (a1 + b1) + (part1 - share * q1) / q
        return self.law.arm * root, 0.5 * (a + b) + share, 0.5 * self.law.arm * q1 / root, turn_slope

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn at parameters t (n,) of the law."""
        return series_of(self.law.jets, t, order, side, self._rates)

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds over intervals (n,)."""
        return bounds_of(self.law.jets, low, high, self._rates)

    def _rates(self, figures: tuple[Series, ...]) -> tuple[Series, Series]:
        """Speed and turn from phi and psi: two orders fewer."""
        phi, psi = figures
        a, slope = phi.derivative(), psi.derivative()
        a_slope, bend = a.derivative(), slope.derivative()
        order = bend.order
        a, slope, half = cut(a, order), cut(slope, order), (cut(psi, order) + self.law.alpha) * 0.5
        cosine, sine = elementary.cos(half), elementary.sin(half)
        b = a - slope
        lean = slope**2
        square = lean + a * b * cosine**2 * 4.0
        inverse = square**-1
        turn = (a + b) * (lean * inverse + 1.0) * 0.5 + (a * bend - a_slope * slope) * sine * cosine * inverse * 2.0
        return elementary.sqrt(square) * self.law.arm, turn


@dataclass(frozen=True)
class FlatPairShape(FaceShape[Transmission]):
    """Curve with an isoptic circle: r as the support function (W section 5)."""
