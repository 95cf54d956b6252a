"""Wunderlich's cams: the pitch curve of a double roller and the profile of a flat-faced pair (W sections 4, 5).

Both follow from the transmission law alone. With the half angle ``h = (psi + alpha)/2`` and the polar angle
``t = phi - h`` (W eq. 4.10), ``r = 2 l cos h`` is the polar radius of the pitch curve, or the support function of the
flat pair's cam.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from camgeo.curve import Bounds, Frame
from kin import jet
from kin.jet import BallJet, Jet

if TYPE_CHECKING:
    from camgeo.curve import Array
    from kin.transmission import Transmission

Series = TypeVar("Series", Jet, BallJet)


@dataclass(frozen=True)
class PitchShape:
    """Path of a roller's centre round the standing cam.

    In the complex plane the centre is ``c = l (exp(i phi) + exp(i chi))``, ``chi = phi - psi - alpha``: the pivot and
    the arm. That form keeps every digit and gives, with a = phi', b = chi', g = psi + alpha,

        sigma^2 = l^2 (a^2 + b^2 + 2 a b cos g),
        omega sigma^2 / l^2 = a^3 + b^3 + a b (a + b) cos g + (a' b - a b') sin g.
    """

    law: Transmission

    @property
    def period(self) -> float:
        """A full turn."""
        return 2.0 * np.pi

    @property
    def breaks(self) -> Array:
        """Breaks of the transmission law."""
        return self.law.breaks

    @property
    def steady(self) -> Array:
        """Speed and turn (m, 2) where the follower rests and the pitch curve is a circle about the shaft."""
        count = self.law.steady.size
        out = np.full((count, 2), np.nan)
        for i, (low, high) in enumerate(_stretches(self.law)):
            if self.law.steady[i]:
                at = self.sample(np.array([0.5 * (low + high)]))
                out[i] = at.speed[0], at.turn[0]
        return out

    def sample(self, t: Array, side: int = 1) -> Frame:
        """Frame at parameters t (n,) of the law."""
        rows_phi, rows_psi = self.law.at(t, 3, side)
        phi, chi = rows_phi[0], rows_phi[0] - rows_psi[0] - self.law.alpha
        arm = self.law.arm
        point = arm * np.column_stack([np.cos(phi) + np.cos(chi), np.sin(phi) + np.sin(chi)])
        a, b = rows_phi[1], rows_phi[1] - rows_psi[1]
        velocity = np.column_stack([-a * np.sin(phi) - b * np.sin(chi), a * np.cos(phi) + b * np.cos(chi)])
        length = np.hypot(velocity[:, 0], velocity[:, 1])
        speed, turn = self._rates(_jet(rows_phi), _jet(rows_psi))
        sigma, omega = speed.derivatives(), turn.derivatives()
        return Frame(point, velocity / length[:, None], sigma[0], omega[0], sigma[1], omega[1])

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds over intervals (n,)."""
        phi, psi = self.law.jets(BallJet.variable(low, high, 4))
        return _bounds(*self._rates(phi, psi))

    def _rates(self, phi: Series, psi: Series) -> tuple[Series, Series]:
        """Speed and turn from phi and psi: two orders fewer."""
        a = phi.derivative()
        b = a - psi.derivative()
        a_slope, b_slope = a.derivative(), b.derivative()
        order = a_slope.order
        a, b, angle = _cut(a, order), _cut(b, order), _cut(psi, order) + self.law.alpha
        cosine, sine = jet.cos(angle), jet.sin(angle)
        product = a * b
        square = a * a + b * b + product * cosine * 2.0
        cubic = a * a * a + b * b * b + product * (a + b) * cosine
        return jet.sqrt(square) * self.law.arm, (cubic + (a_slope * b - a * b_slope) * sine) / square


@dataclass(frozen=True)
class FlatPairShape:
    """Curve with an isoptic circle: r as the support function (W section 5).

    The parameter is the law's; the normal turns as ``t = phi - h`` does, and ``sigma = (r + d2r/dt2) t'``.
    """

    law: Transmission

    @property
    def period(self) -> float:
        """A full turn."""
        return 2.0 * np.pi

    @property
    def breaks(self) -> Array:
        """Breaks of the transmission law."""
        return self.law.breaks

    @property
    def steady(self) -> Array:
        """Speed and turn (m, 2) where the follower rests."""
        count = self.law.steady.size
        out = np.full((count, 2), np.nan)
        for i, (low, high) in enumerate(_stretches(self.law)):
            if self.law.steady[i]:
                at = self.sample(np.array([0.5 * (low + high)]))
                out[i] = at.speed[0], at.turn[0]
        return out

    def sample(self, t: Array, side: int = 1) -> Frame:
        """Frame at parameters t (n,) of the law."""
        rows_phi, rows_psi = self.law.at(t, 3, side)
        half = 0.5 * (rows_psi[0] + self.law.alpha)
        normal = rows_phi[0] - half
        r = 2.0 * self.law.arm * np.cos(half)
        slope = -self.law.arm * np.sin(half) * rows_psi[1] / (rows_phi[1] - 0.5 * rows_psi[1])
        cosine, sine = np.cos(normal), np.sin(normal)
        point = np.column_stack([r * cosine - slope * sine, r * sine + slope * cosine])
        speed, turn = self._rates(_jet(rows_phi), _jet(rows_psi))
        sigma, omega = speed.derivatives(), turn.derivatives()
        return Frame(point, np.column_stack([-sine, cosine]), sigma[0], omega[0], sigma[1], omega[1])

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds over intervals (n,)."""
        phi, psi = self.law.jets(BallJet.variable(low, high, 4))
        return _bounds(*self._rates(phi, psi))

    def _rates(self, phi: Series, psi: Series) -> tuple[Series, Series]:
        """Speed and turn from phi and psi: with k = dh/dt, ``r + r'' = 2 l (cos h (1 - k^2) - sin h dk/dt)``."""
        half = (psi + self.law.alpha) * 0.5
        turn = phi.derivative() - half.derivative()
        k = half.derivative() / turn
        slope = k.derivative()
        half, turn, k = _cut(half, slope.order), _cut(turn, slope.order), _cut(k, slope.order)
        speed = (turn * (1.0 - k * k) * jet.cos(half) - slope * jet.sin(half)) * (2.0 * self.law.arm)
        return speed, turn


def _stretches(law: Transmission) -> list[tuple[float, float]]:
    """Ends of the stretches between breaks; the whole turn where there is none."""
    breaks = [float(b) for b in law.breaks]
    if not breaks:
        return [(0.0, 2.0 * math.pi)]
    return list(zip(breaks, [*breaks[1:], breaks[0] + 2.0 * math.pi], strict=True))


def _cut(series: Series, order: int) -> Series:
    """The same series to a lower order."""
    if isinstance(series, Jet):
        return Jet(series.c[: order + 1])
    return BallJet(series.mid[: order + 1], series.rad[: order + 1])


def _jet(rows: Array) -> Jet:
    """Taylor coefficients from derivatives (order + 1, n)."""
    scale = np.array([math.factorial(k) for k in range(len(rows))], dtype=np.float64)
    return Jet(rows / scale[:, None])


def _bounds(speed: BallJet, turn: BallJet) -> Bounds:
    """Bounds from enclosures of speed and turn up to their second derivatives at least."""
    speed_low, speed_high = speed.bounds()
    turn_low, turn_high = turn.bounds()
    speed_size = np.maximum(np.abs(speed_low), np.abs(speed_high))
    turn_size = np.maximum(np.abs(turn_low), np.abs(turn_high))
    return Bounds(
        speed_low[0],
        speed_high[0],
        turn_low[0],
        turn_high[0],
        speed_size[1],
        turn_size[1],
        speed_size[2],
        turn_size[2],
    )
