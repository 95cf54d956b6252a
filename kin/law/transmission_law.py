"""Transmission laws of a single-disk cam with an oscillating double follower, by every route.

W is W. Wunderlich, Single-disk cam mechanisms with oscillating double roller follower, 1984. The follower's two arms of
length l include 2 alpha, alpha = pi mu/lam, its pivot stands at distance l from the shaft. phi is the shaft angle, psi
the follower's (positive clockwise). The law has period 2 delta = 2 pi/lam and maps onto
itself by (phi, psi) -> (phi - psi + delta, -psi) (W 4.9). A law is held over a parameter tau over which psi only
changes its sign, psi(tau + delta) = -psi(tau), and

    phi = tau + w psi + c.

Polar routes: tau is the polar angle t of roller A, w = 1/2, c = alpha/2 (W 4.4). A given law: tau is phi itself on
[0, delta], w = c = 0, and w = 1 on the next delta, which is W 4.9.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.law.joints import ORDERS, DerivativeJump, joints_of
from kin.law.piecewise import Piecewise, Places, Side
from kin.law.routes import DeltaDistance, FromDelta, FromExpression, FromLeaf
from kin.law.segment import AffineStretch, Constant, Series
from kin.numeric.elementary import Ball, BallJet, Jet, cos
from kin.numeric.jet import derivatives_by
from kin.numeric.newton import zeros
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array

_TURN = 2 * math.pi
_LOOKS = 1024  # parameters at which a formula's rounding is looked at


@dataclass(frozen=True, eq=False)
class Transmission:
    """Swing psi and shaft angle phi over the parameter tau, rad. `arm` is l, mm.

    `psi` has period 2 delta; `lean` holds w for each of its stretches, `offset` is c. `arc` is, where roller A's pitch
    curve begins with a circular arc, its centre and signed radius (x, y, radius), mm, for the first stretch of psi.

    Over the whole turn, stretch i runs from breaks[i] to the next break, the last one over 2 pi; without breaks there
    is one stretch.
    """

    lam: int
    mu: int
    arm: float
    psi: Piecewise
    lean: tuple[float, ...]
    offset: float
    arc: tuple[float, float, float] | None = None

    def scaled(self, scale: float) -> Transmission:
        """Give the law of a mechanism `scale` times as large: the same psi and phi."""
        functions = tuple(f.scaled(scale) if isinstance(f, FromDelta) else f for f in self.psi.functions)
        arc = None if self.arc is None else (scale * self.arc[0], scale * self.arc[1], scale * self.arc[2])
        return replace(self, arm=scale * self.arm, psi=replace(self.psi, functions=functions), arc=arc)

    @property
    def alpha(self) -> float:
        """Half the angle between the arms, rad."""
        return math.pi * self.mu / self.lam

    @property
    def delta(self) -> float:
        """Half the period of the law, rad."""
        return math.pi / self.lam

    @cached_property
    def breaks(self) -> Array:
        """Parameters tau (m,) in [0, 2 pi) at which the second or a higher derivative may jump, rising."""
        turns = np.arange(self.lam) * (_TURN / self.lam)
        return np.sort((self.psi.breaks[None, :] + turns[:, None]).ravel())

    @property
    def repeats(self) -> int:
        """Number of equal periods in a turn of tau."""
        return self.lam

    @property
    def level(self) -> Array:
        """For each stretch (m,) psi, rad, if it is exactly constant, a dwell, else nan; (1,) without breaks."""
        functions = [self.psi.functions[i] for i in self._stretches()]
        return np.array([f.value if isinstance(f, Constant) else math.nan for f in functions])

    @property
    def steady(self) -> NDArray[np.bool_]:
        """Mask (m,) of the stretches in which psi is exactly constant and the pitch curve is an arc about the shaft."""
        return ~np.isnan(self.level)

    @property
    def radius(self) -> Array:
        """For each stretch (m,) the radius of the pitch curve about the shaft, mm, if psi is constant, else nan."""
        return 2 * self.arm * np.cos((self.level + self.alpha) / 2)

    @property
    def pitch_arcs(self) -> Array:
        """For each stretch the arc that the pitch curve exactly is, (m, 3): centre x, y and radius, mm, else nan.

        The radius is negative where the arc is hollow. Arcs are those of dwells, and a given first arc with its images.
        """
        stretches, at = self._stretches(), self.breaks if len(self.breaks) else np.zeros(1)
        arcs = np.column_stack((np.zeros((len(at), 2)), self.radius))
        arcs[~self.steady] = math.nan
        if self.arc is not None:
            x, y, radius = self.arc
            ends = np.flatnonzero(stretches == 0)
            turn = np.round((at[ends] - self.psi.knots[0]) / (2 * self.delta)) * (2 * self.delta)
            c, s = np.cos(turn), np.sin(turn)
            arcs[ends] = np.column_stack((x * c - y * s, x * s + y * c, np.full(len(ends), radius)))
        return arcs

    def _stretches(self) -> NDArray[np.intp]:
        at = self.breaks if len(self.breaks) else np.zeros(1)
        return self.psi.locate(at, 1)[0]

    @cached_property
    def _lead(self) -> _Lead:
        """The angle phi - tau."""
        return _Lead.of(self.lean, self.offset)

    @cached_property
    def _polar_lead(self) -> _Lead:
        """The angle t - tau, t = phi - (psi + alpha)/2: exactly 0 where tau is t."""
        return _Lead.of(tuple(w - 0.5 for w in self.lean), self.offset - self.alpha / 2)

    def jets(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Series of shaft angle phi and swing psi, rad, of a jet or ball jet tau, rad; `side` decides at breaks.

        Raises DomainError where a formula of the law does not exist at a jet.
        """
        places = self.psi.places(tau, side)
        psi = self.psi.at(tau, places)
        return self._lead.on(tau, psi, places), psi

    @cached_property
    def _distance(self) -> Piecewise | None:
        """The polar radius r over tau = t where it is given without psi."""
        first = self.psi.functions[0]
        if not isinstance(first, FromDelta):
            return None
        distance = DeltaDistance(first, self.alpha)
        return Piecewise(self.psi.knots, (distance,), self.psi.period, self.psi.smooth_seam)

    def polar(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Series of r, mm, and t, rad, of roller A's centre, of a jet or ball jet tau (W 4.10).

        `side` decides at breaks. t is formed from tau, not as phi - (psi + alpha)/2: near leaps of psi the difference
        would cancel.
        """
        if self._distance is not None:
            return self._distance.on(tau, side), tau
        places = self.psi.places(tau, side)
        psi = self.psi.at(tau, places)
        return cos(psi * 0.5 + self.alpha / 2) * (2 * self.arm), self._polar_lead.on(tau, psi, places)

    def at(self, tau: float | Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Shaft angle phi and swing psi, rad, with their derivatives by tau, (order + 1, n) each, at tau (n,), rad."""
        phi, psi = self.jets(Jet.variable(tau, order), side)
        return phi.derivatives(), psi.derivatives()

    def enclosure(
        self, lower: float | Array, upper: float | Array, order: int
    ) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Enclose phi, and psi, rad, with their derivatives by tau over [lower, upper], rad (n,).

        Gives (mid, rad) of phi and (mid, rad) of psi, (order + 1, n) each.
        """
        balls = [Ball.between(*jet.bounds()) for jet in self.jets(BallJet.variable(lower, upper, order))]
        return (balls[0].mid, balls[0].rad), (balls[1].mid, balls[1].rad)

    def pitch(self, tau: float | Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Polar r, mm, and t, rad, of roller A's centre with their derivatives by tau, (order + 1, n) each (W 4.10)."""
        r, t = self.polar(Jet.variable(tau, order), side)
        return r.derivatives(), t.derivatives()

    @cached_property
    def rounding(self) -> float:
        """Greatest error of the pitch curve, mm, through the rounding of a recipe's own formula; 0 without one.

        It is the greatest radius that proved arithmetic gives at 1024 parameters of the law's period.
        """
        bare = [f.function if isinstance(f, AffineStretch) else f for f in self.psi.functions]
        if not any(isinstance(f, FromLeaf | FromExpression) for f in bare):
            return 0.0
        tau = self.psi.knots[0] + np.arange(_LOOKS) * (2 * self.delta / _LOOKS)
        (_, phi), (_, psi) = self.enclosure(tau, tau, 0)
        return 2 * self.arm * float((phi + psi).max())

    def psi_of_shaft(self, phi: float | Array, order: int, side: int = 1) -> Array:
        """Swing psi, rad, and its derivatives by phi, (order + 1, n), at phi (n,), rad; at a break those of `side`.

        Raises UnsettledError where phi(tau) cannot be solved for tau.
        """
        return self._by_shaft(self.parameter(phi, side), order, side)

    def _by_shaft(self, tau: Array, order: int, side: int) -> Array:
        """Swing psi, rad, and its derivatives by phi, (order + 1, n), at parameters tau (n,), rad."""
        shaft, psi = self.jets(Jet.variable(tau, order), side)
        return np.stack([row.c[0] for row in derivatives_by(psi, shaft)])

    @cached_property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Jumps of psi or its derivatives by phi, at shaft angles of the law's period, rising; () without any."""
        tau = self.psi.breaks
        if not len(tau):
            return ()
        after, before = (self._by_shaft(tau, ORDERS, side) for side in (1, -1))
        looks = self._by_shaft(self.psi.knots[0] + np.arange(_LOOKS) * (2 * self.delta / _LOOKS), ORDERS, 1)
        size = np.abs(np.concatenate([after, before, looks], axis=1)).max(axis=1)
        at = np.mod(self.at(tau, 0)[0][0], 2 * self.delta)
        order = np.argsort(at)
        return joints_of(((float(at[i]), before[:, i], after[:, i]) for i in order), size)

    def parameter(self, phi: float | Array, side: int = 1) -> Array:
        """Parameter tau (n,) at which phi(tau) is the shaft angle phi (n,), rad; at a break it belongs to `side`.

        Raises UnsettledError where it is not found.
        """
        return self._solved(self._lead, phi, side)

    def polar_parameter(self, t: float | Array, side: int = 1) -> Array:
        """Parameter tau (n,) at which roller A's polar angle t(tau) is t (n,), rad: well posed also for steep psi(phi).

        `side` decides at breaks. Raises UnsettledError where it is not found.
        """
        return self._solved(self._polar_lead, t, side)

    def _solved(self, lead: _Lead, angle: float | Array, side: int) -> Array:
        """Solve tau + lead = angle for tau, (n,): Newton's steps inside the stretch, halving where they leave it."""
        angle = np.atleast_1d(np.asarray(angle, dtype=float))
        knots, period = self.psi.knots, 2 * self.delta

        def at(tau: Array, order: int) -> Array:
            variable = Jet.variable(tau, order)
            places = self.psi.places(variable)
            # the whole angle, tau + lead
            return lead.on(variable, self.psi.at(variable, places), places).c

        # the angles at the knots tell the stretch of each angle, in which the solution is bracketed
        ends = np.append(at(knots[:-1], 0)[0], 0.0)
        ends[-1] = ends[0] + period
        places = Piecewise(ends, (Constant(0.0),) * (len(ends) - 1), period)
        index, x = places.locate(angle, side)
        low, high = knots[index], knots[index + 1]
        tau = low + (x - ends[index]) * (high - low) / (ends[index + 1] - ends[index])

        def over(tau: Array) -> tuple[Array, Array]:
            value, slope = at(tau, 1)
            return value - x, slope

        tau = zeros(over, low, high, tau, 2 * np.spacing(np.maximum(np.abs(tau), period)))
        # an angle on a knot gives the knot to the last bit
        tau = np.where(x == ends[index], knots[index], np.where(x == ends[index + 1], knots[index + 1], tau))
        turns = np.round((angle - x) / period)
        return tau + turns * period


@dataclass(frozen=True, eq=False)
class _Lead:
    """An angle less tau: psi times `weight` plus `offset`; stretches of different weights have theirs in `weights`."""

    weight: float
    offset: float
    weights: Array | None

    @staticmethod
    def of(weights: tuple[float, ...], offset: float) -> _Lead:
        alike = len(set(weights)) == 1
        return _Lead(weights[0], offset, None if alike else np.array(weights))

    def on(self, tau: Series, psi: Series, places: Places) -> Series:
        """Give the angle at tau, where the law has the swing `psi` and which lies at `places` of it."""
        if self.weights is not None:
            return tau + (places.weigh(psi, self.weights) + self.offset)
        angle = tau + psi * self.weight if self.weight else tau
        return angle + self.offset if self.offset else angle
