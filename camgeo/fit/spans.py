"""Deviation of cubic spans from the exact curve: proved, not sampled.

A span covers a parameter interval of the curve. Let g be how far outside the curve it meets the normal at t, gamma the
angle from the curve's tangent to the span's, v the span's speed and k its curvature there. Then

    v cos gamma = sigma + g omega,    g' = -v sin gamma,    gamma' = k v - omega,

so g'' is known at every node, and is -sigma m but for small terms, m = k sigma - omega. Between two nodes m differs
from its chord by what the second derivatives of k, sigma and omega allow, and g from its own chord by what g'' allows:
the error falls as the fourth power of the step. Nodes are added where that still matters.

First gamma and g are confined: no place is farther than half a step from a node, so as long as gamma stays within some
bound and g within another, gamma' is bounded, and if gamma and g then keep within less than assumed, neither can ever
leave (continuity). These bounds give a bound of m over the whole step, and that gives closer ones of gamma and g.
As v stays above 0 the span's point runs forward from one node to the next: every normal of the curve between the two
meets the span between the two, and every point of the span lies on such a normal. So the range of g bounds both
distances, from the span to the curve and back.

Points and directions are complex numbers here, x + iy.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.deviation import FORWARD, peak
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Bounds, Curve
    from kin.numeric.arrays import Array

    Complex = NDArray[np.complex128]

HOPELESS = 1.02  # times the tolerance: a span sampled farther off is beyond a fit's limit and needs no proof
SLACK = 0.02  # of the tolerance: a proof that exceeds the samples by more is sharpened,
OVER = 0.01  # and a proof that exceeds the tolerance by more
FIRST_STEPS = 24  # of a span, between nodes
MOST_STEPS = 1024
MOST_FINER = 8  # times as many steps, at once
NEWTON = 6  # steps, at most, that bring feet of normals to rounding
SETTLED = 2.0 * float(np.finfo(np.float64).eps)  # of the distance from the origin
SPARE = 1.25  # times the expected rate of turning: the rate that is assumed, then confirmed
CLOSER = 3  # times that the bounds of angle and distance are made closer


def plane(points: Array) -> Complex:
    """Points or vectors (..., 2) as complex numbers x + iy (...)."""
    return np.ascontiguousarray(points).view(np.complex128)[..., 0]


@dataclass(frozen=True)
class Cubics:
    """Cubics ``start + u (a + u (b + u c))``, u from 0 to 1: complex coefficients (n,), mm."""

    start: Complex
    a: Complex
    b: Complex
    c: Complex

    @staticmethod
    def of(control: Array) -> Cubics:
        """Cubics of Bezier spans with control points (n, 4, 2)."""
        z = plane(control)
        leg = np.diff(z, axis=1)
        bend = np.diff(leg, axis=1)
        return Cubics(z[:, 0], 3.0 * leg[:, 0], 3.0 * bend[:, 0], bend[:, 1] - bend[:, 0])

    def column(self) -> Cubics:
        """Copy with coefficients as columns (n, 1), for several places on each cubic."""
        return Cubics(self.start[:, None], self.a[:, None], self.b[:, None], self.c[:, None])

    def ahead(self, u: Array) -> Complex:
        """Points at u less the start point, complex, mm, in the common shape of `u` and the coefficients."""
        return u * (self.a + u * (self.b + u * self.c))

    def velocity(self, u: Array) -> Complex:
        """First derivative by u, complex, mm, in the common shape of `u` and the coefficients."""
        return self.a + u * (2.0 * self.b + u * (3.0 * self.c))

    def acceleration(self, u: Array) -> Complex:
        """Second derivative by u, complex, mm, in the common shape of `u` and the coefficients; the third is 6 c."""
        return 2.0 * self.b + u * (6.0 * self.c)


def spans_deviation(curve: Curve, control: Array, low: Array, high: Array, tolerance: float) -> tuple[Array, Array]:
    """Greatest outward and inward distance, mm (n,), of Bezier spans `control` (n, 4, 2) from the curve, proved.

    Each span meets the normals at `low` and `high` (n,) in its own ends, and no interval holds a break. Without a proof
    the distances are bounded by the lengths of span and curve. For a span that samples show to be beyond the tolerance,
    mm, the greater of both is the sampled distance: no bound, but beyond the tolerance too.
    """
    count = low.size
    out, into = np.full(count, np.inf), np.full(count, np.inf)
    todo, steps = np.arange(count), FIRST_STEPS
    while todo.size and steps <= MOST_STEPS:
        top, bottom, seen = _ranges(curve, Cubics.of(control[todo]), low[todo], high[todo], steps)
        out[todo], into[todo] = top, bottom
        proved = np.maximum(top, bottom)
        loose = (proved - seen > SLACK * tolerance) | (proved > (1.0 + OVER) * tolerance)
        hopeless = seen > HOPELESS * tolerance
        far = todo[hopeless]
        out[far], into[far] = np.minimum(out[far], seen[hopeless]), np.minimum(into[far], seen[hopeless])
        open_ = loose & ~hopeless
        # the excess of the proof over the samples falls as the fourth power of the step
        beyond = np.minimum(proved[open_] - seen[open_], MOST_FINER**4 * SLACK * tolerance)
        steps *= 2 ** max(1, math.ceil(0.25 * math.log2(float(beyond.max(initial=0.0)) / (SLACK * tolerance) + 1e-9)))
        todo = todo[open_]
    # a span is no farther off than it and its stretch of the curve are long
    reach = np.abs(plane(control[:, 0] - curve.sample(low).point)) + np.abs(np.diff(plane(control), axis=1)).sum(axis=1)
    reach += curve.cells.over(low, high).speed_high * (high - low)
    return np.minimum(out, reach), np.minimum(into, reach)


def _ranges(curve: Curve, spans: Cubics, low: Array, high: Array, steps: int) -> tuple[Array, Array, Array]:
    """Proved greatest outward and inward distance of each span, and the greatest at nodes: (n,) each, mm."""
    # nodes of the curve, and by Newton's method the places u at which their normals meet the span
    count = low.size
    share = np.linspace(0.0, 1.0, steps + 1)
    t = low[:, None] + (high - low)[:, None] * share
    t[:, -1] = high
    frames = curve.sample(t.ravel(), np.tile(np.where(share < 1.0, 1, -1), count))
    point, tangent = plane(frames.point).reshape(t.shape), plane(frames.tangent).reshape(t.shape)
    speed, turn = frames.speed.reshape(t.shape), frames.turn.reshape(t.shape)
    cubic = spans.column()
    offset = cubic.start - point
    u = np.broadcast_to(share, t.shape).copy()
    along = tangent.conj()
    enough = SETTLED * float(np.abs(point).max())
    for _ in range(NEWTON):
        miss = ((offset + cubic.ahead(u)) * along).real
        if not (np.abs(miss) > enough).any():
            break
        pace = (cubic.velocity(u) * along).real
        u = np.clip(u - miss / np.where(pace > 0.0, pace, np.inf), 0.0, 1.0)
    u[:, 0], u[:, -1] = 0.0, 1.0
    # g and gamma at the nodes; `missed` is how far Newton's method leaves a place beside its normal
    beside = (offset + cubic.ahead(u)) * along
    g, missed = -beside.imag, np.abs(beside.real)
    velocity, acceleration = cubic.velocity(u), cubic.acceleration(u)
    pace = np.abs(velocity)
    wedge = (velocity.conj() * acceleration).imag
    angle = np.angle(velocity * along)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # a span that stands still somewhere has no curvature there, and is not proved
        excess = wedge / pace**3 * speed - turn
        bounds = curve.cells.over(t[:, :-1].ravel(), t[:, 1:].ravel())
        rates = _curvature_bounds(cubic, u, pace, wedge)
        bend, sane = _bend(np.diff(t), bounds, rates, g=g, angle=angle, speed=speed, turn=turn, excess=excess)
    pull = speed * excess
    step = np.diff(t)
    slip = np.maximum(missed[:, :-1], missed[:, 1:])
    a, b = g[:, :-1], g[:, 1:]
    top = peak(a, b, step, np.maximum(pull[:, :-1], pull[:, 1:]) + bend) + slip
    bottom = peak(-a, -b, step, np.maximum(-pull[:, :-1], -pull[:, 1:]) + bend) + slip
    sane &= np.isfinite(top) & np.isfinite(bottom)
    sane &= np.diff(u) > 0.0
    top, bottom = np.where(sane, top, np.inf), np.where(sane, bottom, np.inf)
    return top.max(axis=1), bottom.max(axis=1), np.abs(g).max(axis=1)


@dataclass(frozen=True)
class _Rates:
    """Bounds over steps of a span's curvature and of its first two derivatives by the arc length, absolute values."""

    curvature: Array
    slope: Array
    bend: Array


def _curvature_bounds(cubic: Cubics, u: Array, pace: Array, wedge: Array) -> _Rates:
    """Bounds between nodes at u (n, m), from bounds of the terms of the curvature: (n, m - 1).

    With p, a, j the derivatives of the cubic, N = p x a and w = p.a: k = N/|p|^3, k_s = N'/|p|^4 - 3 N w/|p|^6 and
    k_ss = N''/|p|^5 - (7 N' w + 3 N w')/|p|^7 + 18 N w^2/|p|^9.
    """
    velocity, acceleration, jerk = cubic.velocity(u), cubic.acceleration(u), 6.0 * cubic.c
    step = np.diff(u)
    most_a, most_j = _greater(np.abs(acceleration)), np.abs(jerk)
    slowest = np.minimum(pace[:, :-1], pace[:, 1:]) - 0.5 * step * most_a
    fastest = _greater(pace) + 0.5 * step * most_a
    slowest = np.where(slowest > 0.0, slowest, np.nan)
    square = step**2 / 8.0
    twist = np.abs((acceleration.conj() * jerk).imag)[:, 1:]  # N'', the same all along
    wedges = _greater(np.abs(wedge)) + square * twist
    wedge_slopes = _greater(np.abs((velocity.conj() * jerk).imag))
    gains = _greater(np.abs((velocity.conj() * acceleration).real)) + 3.0 * square * most_a * most_j
    gain_slopes = most_a**2 + fastest * most_j
    over = 1.0 / slowest
    gain = gains * over**2
    return _Rates(
        wedges * over**3,
        (wedge_slopes + 3.0 * wedges * gain) * over**4,
        (twist + 7.0 * wedge_slopes * gain + 3.0 * wedges * (gain_slopes * over**2 + 6.0 * gain**2)) * over**5,
    )


def _bend(
    step: Array, bounds: Bounds, rates: _Rates, *, g: Array, angle: Array, speed: Array, turn: Array, excess: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Bound, over each step, of g'' less the greater -sigma m of its ends, and whether it is confirmed: (n, steps).

    `g`, `angle` gamma, `speed` sigma, `turn` omega and `excess` m, as the head of this module defines them, are values
    at the nodes (n, steps + 1). The bound holds for -g'' and sigma m as well.
    """
    # greatest and least speed and turn over each step
    shape, square = step.shape, step**2 / 8.0
    speed_slope, speed_bend = bounds.speed_slope.reshape(shape), bounds.speed_bend.reshape(shape)
    turn_slope, turn_bend = bounds.turn_slope.reshape(shape), bounds.turn_bend.reshape(shape)
    most = np.maximum(np.abs(bounds.speed_low), np.abs(bounds.speed_high)).reshape(shape)
    speeds = np.minimum(_greater(np.abs(speed)) + square * speed_bend, most)
    slowest = np.maximum(-_greater(-speed) - square * speed_bend, bounds.speed_low.reshape(shape))
    most = np.maximum(np.abs(bounds.turn_low), np.abs(bounds.turn_high)).reshape(shape)
    turns = np.minimum(_greater(np.abs(turn)) + square * turn_bend, most)
    off, lean, half = _greater(np.abs(g)), _greater(np.abs(angle)), 0.5 * step

    def within(rate: Array) -> tuple[Array, Array, Array]:
        """Bounds of gamma, g and k (v - sigma) where gamma' is at most `rate`."""
        most_lean = lean + half * rate + 1e-15
        tangent, secant = np.tan(np.minimum(most_lean, FORWARD)), 1.0 / np.cos(np.minimum(most_lean, FORWARD))
        clearance = 1.0 - half * tangent * turns
        most_off = (off + half * tangent * speeds) / np.where(clearance > 0.0, clearance, np.nan)
        return most_lean, most_off, rates.curvature * (speeds * (secant - 1.0) + most_off * turns * secant)

    # an assumed rate of turning, which the bounds that follow from it confirm
    rate = SPARE * (rates.curvature * (speeds + off * turns) + turns)
    most_lean, most_off, lag = within(rate)
    sane = (rates.curvature * speeds + lag + turns <= rate) & (most_lean < FORWARD) & (slowest > most_off * turns)
    # bounds of the span's speed and its slope, and of the second derivative of m
    secant, tangent = 1.0 / np.cos(np.minimum(most_lean, FORWARD)), np.tan(np.minimum(most_lean, FORWARD))
    pace = (speeds + most_off * turns) * secant
    pace_slope = (speed_slope + pace * tangent * turns + most_off * turn_slope) * secant + pace * tangent * rate
    bend = (rates.bend * pace**2 + rates.slope * pace_slope) * speeds + 2.0 * rates.slope * pace * speed_slope
    bend += rates.curvature * speed_bend + turn_bend
    most_excess = _greater(np.abs(excess)) + square * bend
    for _ in range(CLOSER):
        rate = np.minimum(rate, most_excess + lag)
        most_lean, most_off, lag = within(rate)
    # g'' + sigma m, and sigma m between its values at the ends
    tangent = np.tan(np.minimum(most_lean, FORWARD))
    small = pace_slope * tangent + most_off * turns * rate + speeds * lag
    excess_slope = np.abs(np.diff(excess)) / step + half * bend
    product = speed_bend * most_excess + 2.0 * speed_slope * excess_slope + speeds * bend
    return small + square * product, sane


def _greater(value: Array) -> Array:
    """Greater of the values (n, m) at both ends of each step (n, m - 1)."""
    return np.maximum(value[:, :-1], value[:, 1:])
