"""The exact contour that a follower's intended motion asks for, and how far any point lies outside it.

A flat face whose intended support function is p(theta) must leave every point X of the cam with X.u(theta) <= p(theta):
the excess of a point is the greatest X.u - p over theta, which for a convex contour is its signed distance, positive
outside (THEORY section 2: the metal a face would feel). A roller of radius e whose centre runs on the pitch curve must
leave every point at least e away from it: the excess is e less the distance to the pitch curve. Both definitions are
global, so they hold for a trimmed undercut as well. Nothing but the intent is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from kin.arcs import cross, dot, left, right, unit

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.arcs import Array, Indices
    from kin.transmission import Transmission

TURN = 2.0 * np.pi
COARSE = 4096  # samples from which the search for a foot starts
FINE_STEP = 1e-5  # rad: a Newton step below this leaves the excess good to a third power of it
MOST_STEPS = 60
CHUNK = 4_000_000  # entries of a matrix of points against samples held at a time


@dataclass(frozen=True, eq=False)
class Feet:
    """The feet of n points on an exact contour.

    parameter (n,)      of the foot
    excess (n,)         of the point, mm
    normal (n, 2)       gradient of the excess
    curvature (n,)      of the line of equal excess through the point, 1/mm
    """

    parameter: Array
    excess: Array
    normal: Array
    curvature: Array


class Envelope(Protocol):
    """An exact contour over a parameter of period 2 pi."""

    @property
    def regular(self) -> bool:
        """Whether the contour is free of undercut, so that each point near it has one foot."""

    def feet(self, points: Array) -> Feet:
        """Feet of points (n, 2)."""

    def samples(self, count: int) -> Array:
        """Points of the contour at `count` equal steps of the parameter, and at its breaks: (m, 2)."""

    def area_and_perimeter(self) -> tuple[float, float]:
        """Enclosed area and length of a regular contour, mm^2 and mm."""


class SupportLaw(Protocol):
    """A support function of period 2 pi; `kin.lift.Lift` is one."""

    @property
    def breaks(self) -> Array:
        """Angles in [0, 2 pi) where the second derivative may jump."""

    def derivatives(self, theta: Array, order: int, side: int = 1) -> Array:
        """Return p and its derivatives, (order + 1, n)."""


class Inverse:
    """Inverse of a rising function that gains 2 pi over its period 2 pi, from a table and one Newton step or more."""

    def __init__(self, function: Callable[[Array], Array], breaks: Array) -> None:
        """`function(x)` gives value and two derivatives, (3, n); `breaks` are where the second one jumps."""
        self._function = function
        x = grid(breaks)
        y = function(x)[0]
        self._x = np.concatenate([x - TURN, x, x + TURN])
        self._y = np.concatenate([y - TURN, y, y + TURN])
        self._middle = float(y[0]) + 0.5 * TURN

    def __call__(self, y: Array) -> tuple[Array, Array]:
        """Return x near the solutions, and the remaining steps to them, |step| below FINE_STEP: each (n,)."""
        base = TURN * np.round((y - self._middle) / TURN)
        x = np.interp(y - base, self._y, self._x)
        step = np.zeros_like(x)
        todo = np.arange(len(x))
        for _ in range(MOST_STEPS):
            value, slope, bend = self._function(x[todo])
            miss = y[todo] - base[todo] - value
            first = miss / slope
            step[todo] = first - 0.5 * bend * first * first / slope
            todo = todo[np.abs(step[todo]) > FINE_STEP]
            if not len(todo):
                break
            x[todo] += step[todo]
        return x + base, step


def grid(breaks: Array, count: int = COARSE) -> Array:
    """`count` equal steps of [0, 2 pi) and the breaks, rising and distinct."""
    return np.unique(np.concatenate([np.arange(count) * (TURN / count), np.mod(breaks, TURN)]))


@dataclass(frozen=True, eq=False)
class PairSupport:
    """W's polar pitch curve r(t) read as the support function of the cam of a flat pair (W section 5)."""

    transmission: Transmission

    @cached_property
    def breaks(self) -> Array:
        """Angles in [0, 2 pi) where the second derivative may jump, rising."""
        return np.sort(np.mod(self.transmission.pitch(self.transmission.breaks, 0)[1][0], TURN))

    @cached_property
    def _parameter(self) -> Callable[[Array], tuple[Array, Array]]:
        polar = self.transmission.pitch(grid(self.transmission.breaks, 64), 0)[1][0]
        if np.allclose(polar, grid(self.transmission.breaks, 64), rtol=0.0, atol=1e-13):  # tau is t itself
            return lambda theta: (theta, np.zeros_like(theta))
        return Inverse(lambda tau: self.transmission.pitch(tau, 2)[1], self.transmission.breaks)

    def derivatives(self, theta: Array, order: int, side: int = 1) -> Array:
        """Return r and its derivatives by t, (order + 1, n), order at most 2."""
        tau, step = self._parameter(np.asarray(theta, dtype=float))
        tau = np.where(np.abs(step) < 1e-14, tau, tau + step)  # a break stays a break
        r, t = self.transmission.pitch(tau, 2, side)
        slope = r[1] / t[1]
        return np.stack([r[0], slope, (r[2] - slope * t[2]) / t[1] ** 2])[: order + 1]


@dataclass(frozen=True, eq=False)
class FlatEnvelope:
    """The contour enveloped by a flat face; its parameter is theta, the direction of the face's outward normal."""

    support: SupportLaw

    @cached_property
    def _table(self) -> tuple[Array, Array, Array, Array]:
        """theta, point, smaller radius of curvature of the two sides, p."""
        theta = grid(self.support.breaks)
        p, slope, bend = self.support.derivatives(theta, 2)
        left_bend = self.support.derivatives(self.support.breaks, 2, -1)[2]
        rho = p + bend
        at = np.searchsorted(theta, np.mod(self.support.breaks, TURN))
        rho[at] = np.minimum(rho[at], p[at] + left_bend)
        u = unit(theta)
        return theta, p[:, None] * u + slope[:, None] * left(u), rho, p

    @cached_property
    def regular(self) -> bool:
        """Whether rho >= 0 all round."""
        _, _, rho, p = self._table
        return bool(rho.min() >= -1e-12 * np.abs(p).max())

    @cached_property
    def _start(self) -> tuple[Array, Array, Array]:
        """A point inside (the mean of c(theta), Steiner's), and theta over the direction from there."""
        theta, point, _, _ = self._table
        inside = point.mean(axis=0)
        away = np.unwrap(np.arctan2(point[:, 1] - inside[1], point[:, 0] - inside[0]))
        away = np.maximum.accumulate(away)
        turns = np.array([-TURN, 0.0, TURN])[:, None]
        return inside, (away + turns).ravel(), (theta + turns).ravel()

    def feet(self, points: Array) -> Feet:
        """Feet of points (n, 2): where X.u - p is greatest."""
        if self.regular:
            inside, direction, theta = self._start
            return self._climb(points, np.interp(_angle(points - inside), direction, theta))
        theta, _, _, p = self._table
        u = unit(theta)
        return _best([self._climb(points, theta[j]) for j in two_best(lambda x: x @ u.T - p, points, len(theta))])

    def _climb(self, points: Array, theta: Array) -> Feet:
        def slopes(x: Array, which: Indices) -> tuple[Array, Array, Array]:
            p, slope, bend = self.support.derivatives(x, 2)
            u = unit(x)
            here = points[which]
            away = dot(here, u)
            return away - p, dot(here, left(u)) - slope, away + bend

        theta, step, value, slope, bend = climb(slopes, theta)
        curved = bend > 0.0
        radius = np.where(curved, bend, 1.0)
        excess = value + np.where(curved, 0.5 * slope * slope / radius, 0.0)
        return Feet(theta + step, excess, unit(theta + step), np.where(curved, 1.0 / radius, 0.0))

    def samples(self, count: int) -> Array:
        """Points at `count` equal steps of theta, and at the breaks (m, 2)."""
        theta = grid(self.support.breaks, count)
        p, slope = self.support.derivatives(theta, 1)
        u = unit(theta)
        points: Array = p[:, None] * u + slope[:, None] * left(u)
        return points

    def area_and_perimeter(self) -> tuple[float, float]:
        """1/2 integral of (p^2 - p'^2), and integral of p (Cauchy)."""
        theta, weight = gauss(self.support.breaks)
        p, slope = self.support.derivatives(theta, 1)
        return float(0.5 * weight @ (p * p - slope * slope)), float(weight @ p)


class Pitch(Protocol):
    """A closed pitch curve over a parameter of period 2 pi."""

    @property
    def breaks(self) -> Array:
        """Parameters in [0, 2 pi) where the second derivative may jump."""

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Give the roller's centre and its two derivatives by the parameter, each (n, 2)."""


@dataclass(frozen=True, eq=False)
class TransmissionPitch:
    """Path of roller A (and of roller B) under a transmission law, polar r(t) of W 4.10."""

    transmission: Transmission

    @property
    def breaks(self) -> Array:
        """Parameters where the second derivative may jump."""
        return self.transmission.breaks

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Centre and two derivatives, each (n, 2)."""
        r, t = self.transmission.pitch(tau, 2)
        u = unit(t[0])
        n = left(u)
        first = r[1][:, None] * u + (r[0] * t[1])[:, None] * n
        second = (r[2] - r[0] * t[1] ** 2)[:, None] * u + (2.0 * r[1] * t[1] + r[0] * t[2])[:, None] * n
        return r[0][:, None] * u, first, second


@dataclass(frozen=True, eq=False)
class RollerEnvelope:
    """The contour at the roller's `radius`, mm, inside a counter-clockwise pitch curve, over that curve's parameter."""

    pitch: Pitch
    radius: float

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Parameter, pitch point, contour point."""
        tau = grid(self.pitch.breaks)
        point, first, _ = self.pitch.points(tau)
        outward = right(first) / np.hypot(first[:, 0], first[:, 1])[:, None]
        return tau, point, point - self.radius * outward

    @cached_property
    def _direction(self) -> Array:
        _, _, contour = self._table
        return np.unwrap(_angle(contour))

    @cached_property
    def regular(self) -> bool:
        """Whether the contour runs once round the shaft without turning back: then no part of it undercuts another."""
        closed = np.append(self._direction, self._direction[0] + TURN)
        return bool((np.diff(closed) > 0.0).all())

    def feet(self, points: Array) -> Feet:
        """Feet of points (n, 2): the nearest points of the pitch curve."""
        tau, centre, _ = self._table
        if self.regular:
            away, turns = self._direction, np.array([-TURN, 0.0, TURN])[:, None]
            start = np.interp(_angle(points), (away + turns).ravel(), (tau + turns).ravel())
            return self._climb(points, start)
        size = 0.5 * dot(centre, centre)
        return _best([self._climb(points, tau[j]) for j in two_best(lambda x: x @ centre.T - size, points, len(tau))])

    def _climb(self, points: Array, tau: Array) -> Feet:
        reached = [np.empty_like(points) for _ in range(3)]

        def slopes(x: Array, which: Indices) -> tuple[Array, Array, Array]:
            centre, first, second = self.pitch.points(x)
            for kept, new in zip(reached, (centre, first, second), strict=True):
                kept[which] = new
            gap = points[which] - centre
            return -0.5 * dot(gap, gap), dot(gap, first), dot(first, first) - dot(gap, second)

        tau, step, _, _, _ = climb(slopes, tau)
        centre, first, second = reached
        h = step[:, None]
        centre, first = centre + h * (first + 0.5 * h * second), first + h * second
        speed = np.hypot(first[:, 0], first[:, 1])
        outward = right(first) / speed[:, None]
        gap = points - centre
        height = np.copysign(np.hypot(gap[:, 0], gap[:, 1]), dot(gap, outward))
        bend = cross(first, second) / speed**3
        widened = 1.0 + bend * height
        curvature = np.where(widened > 0.0, bend / np.where(widened > 0.0, widened, 1.0), 0.0)
        return Feet(tau + step, height + self.radius, outward, curvature)

    def samples(self, count: int) -> Array:
        """Points of the contour at `count` equal steps of the parameter, and at the breaks (m, 2)."""
        point, first, _ = self.pitch.points(grid(self.pitch.breaks, count))
        return point - self.radius * right(first) / np.hypot(first[:, 0], first[:, 1])[:, None]

    def area_and_perimeter(self) -> tuple[float, float]:
        """Steiner's formulas for the inner parallel curve: A - e P + pi e^2 and P - 2 pi e."""
        tau, weight = gauss(self.pitch.breaks)
        point, first, _ = self.pitch.points(tau)
        area = float(0.5 * weight @ cross(point, first))
        perimeter = float(weight @ np.hypot(first[:, 0], first[:, 1]))
        return area - self.radius * perimeter + np.pi * self.radius**2, perimeter - TURN * self.radius


def climb(
    slopes: Callable[[Array, Indices], tuple[Array, Array, Array]], x: Array
) -> tuple[Array, Array, Array, Array, Array]:
    """Climb to the maximum nearest uphill from x (n,) by Newton's method, bracketed and with bounded steps.

    `slopes(x, which)` gives f, f' and -f''. Returns x, the last Newton step that remains (below FINE_STEP, unless the
    bracket closed first), and f, f', -f'' at x: (n,) each.
    """
    x = x.copy()
    f, slope, bend = slopes(x, np.arange(len(x)))
    step = _newton(slope, bend)
    todo = np.flatnonzero(np.abs(step) > FINE_STEP)
    low, high = np.full(len(x), -np.inf), np.full(len(x), np.inf)
    for _ in range(MOST_STEPS):
        if not len(todo):
            break
        uphill = slope[todo] > 0.0
        low[todo] = np.where(uphill, x[todo], low[todo])
        high[todo] = np.where(uphill, high[todo], x[todo])
        new = x[todo] + step[todo]
        out = ~((new > low[todo]) & (new < high[todo]))
        new[out] = 0.5 * (low[todo] + high[todo])[out]
        x[todo] = new
        f[todo], slope[todo], bend[todo] = slopes(new, todo)
        step[todo] = _newton(slope[todo], bend[todo])
        closed = high[todo] - low[todo] <= 1e-15 * TURN
        step[todo[closed]] = 0.0
        todo = todo[np.abs(step[todo]) > FINE_STEP]
    return x, step, f, slope, bend


def _newton(slope: Array, bend: Array) -> Array:
    """Newton's step, at most 0.2 rad; uphill by that much where the function is not bent the right way."""
    most = 0.2
    with np.errstate(divide="ignore", invalid="ignore"):
        step = np.where(bend > 0.0, slope / bend, np.copysign(most, slope))
    step = np.where(slope == 0.0, 0.0, step)
    return np.clip(step, -most, most)


def two_best(score: Callable[[Array], Array], points: Array, count: int) -> tuple[Indices, Indices]:
    """For each point the sample of highest score, and the best of those well away from it: (n,) each.

    Near a corner of a trimmed contour two feet count, and coarse samples cannot tell which one wins.
    """
    first, second = np.empty(len(points), dtype=np.intp), np.empty(len(points), dtype=np.intp)
    away = count // 64
    near = np.arange(-away, away + 1)
    size = max(1, CHUNK // count)
    for begin in range(0, len(points), size):
        part = slice(begin, begin + size)
        value = score(points[part])
        first[part] = value.argmax(axis=1)
        np.put_along_axis(value, (first[part][:, None] + near) % count, -np.inf, axis=1)
        second[part] = value.argmax(axis=1)
    return first, second


def _best(options: list[Feet]) -> Feet:
    one, two = options
    wins = one.excess >= two.excess
    return Feet(
        np.where(wins, one.parameter, two.parameter),
        np.where(wins, one.excess, two.excess),
        np.where(wins[:, None], one.normal, two.normal),
        np.where(wins, one.curvature, two.curvature),
    )


def gauss(breaks: Array) -> tuple[Array, Array]:
    """Nodes and weights (m,) that integrate over one turn a function smooth between the breaks."""
    ends = grid(breaks, 64)
    ends = np.append(ends, ends[0] + TURN)
    node, weight = np.polynomial.legendre.leggauss(16)
    half = 0.5 * np.diff(ends)
    at = (0.5 * (ends[1:] + ends[:-1]))[:, None] + half[:, None] * node
    return at.ravel(), (half[:, None] * weight).ravel()


def _angle(v: Array) -> Array:
    angle: Array = np.arctan2(v[:, 1], v[:, 0])
    return angle
