"""The exact contour that a follower's intended motion asks for, and how far any point lies outside it.

A flat face whose intended support function is p(theta) must leave every point X of the cam with X.u(theta) <= p(theta):
the excess of a point is the greatest X.u - p over theta, which for a convex contour is its signed distance, positive
outside (docs/theory.md 2: the metal a face would feel). A roller of radius e whose centre runs on the pitch curve must
leave every point at least e away from it: the excess is e less the distance to the pitch curve. Both definitions are
global, so they hold for a trimmed undercut as well. Nothing but the intent is used.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.contour.arcs import cross, dot, left, right, unit
from kin.numeric.angles import TURN
from kin.numeric.feet import Feet, better, climb, grid, searched_again, turn_quadrature, two_best
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.piecewise import Piecewise
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array, Indices


class Frames(NamedTuple):
    """Points, normals and their rates of an exact contour at n parameters; the tangent is the normal turned left.

    points (n, 2)   mm
    normals (n, 2)  unit vectors, outward
    speed (n,)      of the point along the tangent, mm by the parameter
    turn (n,)       of the normal, rad by the parameter
    """

    points: Array
    normals: Array
    speed: Array
    turn: Array


class Envelope(Protocol):
    """An exact contour over a parameter of period 2 pi."""

    @property
    def regular(self) -> bool:
        """Whether the contour is free of undercut, so that each point near it has one foot."""

    @property
    def breaks(self) -> Array:
        """Parameters (k,) in [0, 2 pi) at which the curvature may jump."""

    def feet(self, points: Array) -> Feet:
        """Feet on the contour of points (n, 2), mm. Raises UnsettledError where a foot is not found."""

    def points(self, parameter: Array) -> Array:
        """Points (n, 2) of the contour, mm, at parameters (n,).

        With undercut also points of the parts that are cut off.
        """

    def frames(self, parameter: Array) -> Frames:
        """Points, outward normals and their rates by the parameter, at parameters (n,)."""

    def radii(self) -> tuple[Array, Array]:
        """Parameters (m,) closely round the turn, and radii of curvature there (m,), mm, negative where hollow."""

    @property
    def extent(self) -> float:
        """Greatest length, mm, that enters an excess, which is known to the rounding of this length."""

    def area_and_perimeter(self) -> tuple[float, float]:
        """Enclosed area, mm^2, and length, mm, of a regular contour."""

    def inset(self, distance: float) -> Envelope:
        """Envelope of the parallel contour inside this one, at a distance, mm."""

    def displaced(self, by: Outwards) -> Envelope:
        """Contour that lies the distance `by` farther outside, to first order of it.

        To that order a jump of this contour's curvature leaves no corner in it.
        """


class Outwards(Protocol):
    """Smooth distance, mm, by which a contour is displaced, over its parameter of period 2 pi."""

    def rows(self, t: Array, order: int = 0) -> Array:
        """The distance and its derivatives at parameters t (n,), up to `order`: (order + 1, n)."""


class FacePitch(Protocol):
    """A moving line along a flat face, over a parameter of period 2 pi; of face A of a pair its `Transmission`."""

    @property
    def breaks(self) -> Array:
        """Parameters (k,) in [0, 2 pi) where the second derivative may jump, rising."""

    def pitch(self, tau: Array, order: int, side: int = 1) -> tuple[Array, Array]:
        """Distance r from the shaft, mm, and direction t of the normal, rad, which rises, at parameters tau (n,).

        Both with derivatives by tau, (order + 1, n) each; at a break those from the right, or from the left (side -1).
        """


@dataclass(frozen=True, eq=False)
class LiftPitch:
    """A face on a line of travel, its normal `tilt` ahead of the line, rad; the parameter is the shaft angle.

    The line stands `turned` ahead of the shaft angle, rad; `along` is the face's distance from the shaft along it, mm.
    """

    along: Lift
    tilt: float = 0.0
    turned: float = 0.0

    @property
    def breaks(self) -> Array:
        """Shaft angles, rad (m,), of the lift's breaks."""
        return self.along.breaks

    def pitch(self, tau: Array, order: int, side: int = 1) -> tuple[Array, Array]:
        """Distance r = cos(tilt) along, mm, and direction t = tau + tilt + turned, rad, with derivatives by tau.

        Both are (order + 1, n); at a break they come from the right, or from the left (side -1).
        """
        r: Array = np.cos(self.tilt) * self.along.derivatives(tau, order, side)
        t = np.zeros_like(r)
        t[0], t[1:2] = tau + (self.tilt + self.turned), 1.0
        return r, t


@dataclass(frozen=True, eq=False)
class ArmPitch:
    """Line through the pivot of an arm along its face, over the shaft angle.

    Its angle psi to the line from pivot to shaft is `law`, rad; C is the distance `pivot` from the shaft, mm. Then
    r = C sin psi and t = phi + side (psi - pi/2), with `side` 1 where the face trails the pivot, else -1.
    """

    law: Piecewise
    pivot: float
    side: int

    @property
    def breaks(self) -> Array:
        """Shaft angles, rad (m,), of the law's breaks."""
        return self.law.breaks

    def pitch(self, tau: Array, order: int, side: int = 1) -> tuple[Array, Array]:
        """Distance r, mm, and direction t, rad, at shaft angles tau (n,), with derivatives: (order + 1, n) each.

        The order is at most 2; at a break derivatives come from the right, or from the left (side -1).
        """
        psi, rate, bend = self.law.derivatives(tau, 2, side)
        sine, cosine = np.sin(psi), np.cos(psi)
        r = self.pivot * np.stack([sine, cosine * rate, cosine * bend - sine * rate**2])
        t = self.side * np.stack([psi - 0.5 * np.pi, rate, bend])
        t[0] += tau
        t[1] += 1.0
        return r[: order + 1], t[: order + 1]


@dataclass(frozen=True, eq=False)
class DisplacedFace:
    """A face in the direction of another one, farther from the shaft by the smooth distance `by`.

    Its contour keeps the normals of the other: a jump of the radius of curvature leaves no corner.
    """

    face: FacePitch
    by: Outwards

    @property
    def breaks(self) -> Array:
        """Parameters of the breaks of the face displaced, rad."""
        return self.face.breaks

    def pitch(self, tau: Array, order: int, side: int = 1) -> tuple[Array, Array]:
        """Distance, mm, and direction, rad, with derivatives by the parameter tau (n,): (order + 1, n) each."""
        r, t = self.face.pitch(tau, order, side)
        return r + self.by.rows(tau, order), t


def support_rows(pitch: FacePitch, tau: Array, side: int = 1) -> tuple[Array, Array]:
    """Support function p, mm, and two derivatives by the normal's direction t; and t, rad, and two by tau: (3, n) each.

    At a break of the pitch derivatives come from the right, or from the left (side -1).
    """
    r, t = pitch.pitch(tau, 2, side)
    slope = r[1] / t[1]
    return np.stack([r[0], slope, (r[2] - slope * t[2]) / t[1] ** 2]), t


@dataclass(frozen=True, eq=False)
class FlatEnvelope:
    """The contour enveloped by a flat face that stands `out` mm beyond its pitch, over the pitch's parameter.

    In the formulas p is the support function of the contour, u the normal, n the normal turned left.
    """

    pitch: FacePitch
    out: float = 0.0

    @property
    def breaks(self) -> Array:
        """Breaks of the pitch (k,), rad."""
        return self.pitch.breaks

    def _support(self, tau: Array, side: int = 1) -> tuple[Array, Array]:
        p, t = support_rows(self.pitch, tau, side)
        p[0] += self.out
        return p, t

    def points(self, parameter: Array) -> Array:
        """Points (n, 2) of the contour, mm, at parameters (n,): p u + p' n."""
        (p, slope, _), t = self._support(np.asarray(parameter, dtype=float))
        u = unit(t[0])
        points: Array = p[:, None] * u + slope[:, None] * left(u)
        return points

    def frames(self, parameter: Array) -> Frames:
        """Points and outward normals of the contour at parameters (n,), and their rates by the parameter."""
        (p, slope, bend), t = self._support(np.asarray(parameter, dtype=float))
        u = unit(t[0])
        return Frames(p[:, None] * u + slope[:, None] * left(u), u, (p + bend) * t[1], t[1])

    @cached_property
    def _table(self) -> tuple[Array, Array, Array, Array]:
        """Parameter, radius rho = p + p'' (the lesser of both sides at a break), p and direction of the normal."""
        tau, breaks = grid(self.pitch.breaks), self.pitch.breaks
        (p, _, bend), t = self._support(tau)
        rho = p + bend
        at = np.searchsorted(tau, np.mod(breaks, TURN))
        rho[at] = np.minimum(rho[at], p[at] + self._support(breaks, -1)[0][2])
        return tau, rho, p, t[0]

    def radii(self) -> tuple[Array, Array]:
        """Parameters (m,) closely round the turn, and radii of curvature rho (m,) there, mm."""
        tau, rho, _, _ = self._table
        return tau, rho

    @property
    def extent(self) -> float:
        """Greatest distance of the face from the shaft, mm."""
        return float(np.abs(self._table[2]).max())

    @cached_property
    def regular(self) -> bool:
        """Whether the contour has no undercut: its radius of curvature rho is 0 or above all round."""
        _, rho, p, _ = self._table
        return bool(rho.min() >= -1e-12 * np.abs(p).max())

    @cached_property
    def _start(self) -> tuple[Array, Array, Array]:
        """A point inside (the mean of the points), and the parameter over the direction from there."""
        tau = self._table[0]
        point = self.points(tau)
        inside = point.mean(axis=0)
        away = np.unwrap(np.arctan2(point[:, 1] - inside[1], point[:, 0] - inside[0]))
        away = np.maximum.accumulate(away)
        turns = np.array([-TURN, 0.0, TURN])[:, None]
        return inside, (away + turns).ravel(), (tau + turns).ravel()

    def feet(self, points: Array) -> Feet:
        """Feet of points X (n, 2), mm: where X.u - p is greatest. Raises UnsettledError where a foot is not found."""
        if not self.regular:
            return self._search(points)
        inside, direction, tau = self._start
        feet = self._climb(points, np.interp(_angle(points - inside), direction, tau))
        return searched_again(feet, points, self, self._search)

    def _search(self, points: Array) -> Feet:
        """Feet found from samples all round."""
        tau, _, p, t = self._table
        u = unit(t)
        first, second = two_best(lambda x: x @ u.T - p, points, len(tau))
        return better(self._climb(points, tau[first]), self._climb(points, tau[second]))

    def _climb(self, points: Array, tau: Array) -> Feet:
        """Feet of points X (n, 2), climbing from parameters tau (n,)."""
        turned = np.empty((3, len(tau)))  # t and its derivatives at the last place of each
        curved = np.empty(len(tau))

        def slopes(x: Array, which: Indices) -> tuple[Array, Array, Array]:
            (p, slope, bend), t = self._support(x)
            u = unit(t[0])
            here = points[which]
            away = dot(here, u)
            rise = dot(here, left(u)) - slope
            turned[:, which], curved[which] = t, away + bend
            # of f = X.u - p: f, f' = t' (X.n - p') and -f'' = t'^2 (X.u + p'') - t'' (X.n - p')
            return away - p, t[1] * rise, t[1] ** 2 * (away + bend) - t[2] * rise

        tau, step, value, slope, bend = climb(slopes, tau, self.pitch.breaks)
        # what is left of the step counts to second order; where the top is not round the excess stays as it is
        round_ = (bend > 0.0) & (curved > 0.0)
        excess = value + np.where(round_, 0.5 * slope * slope / np.where(round_, bend, 1.0), 0.0)
        direction = turned[0] + step * (turned[1] + 0.5 * step * turned[2])
        curvature = np.where(round_, 1.0 / np.where(round_, curved, 1.0), 0.0)
        return Feet(tau + step, excess, unit(direction), curvature)

    def area_and_perimeter(self) -> tuple[float, float]:
        """Area, 1/2 integral of (p^2 - p'^2) over t, mm^2, and perimeter, integral of p, mm (Cauchy)."""
        tau, weight = turn_quadrature(self.pitch.breaks)
        (p, slope, _), t = self._support(tau)
        weight = weight * t[1]
        return float(0.5 * weight @ (p * p - slope * slope)), float(weight @ p)

    def inset(self, distance: float) -> FlatEnvelope:
        """Envelope of the parallel contour inside this one, at a distance, mm."""
        return FlatEnvelope(self.pitch, self.out - distance)

    def displaced(self, by: Outwards) -> FlatEnvelope:
        """Contour of a face that stands `by` farther out: its support function is greater by as much, mm."""
        return FlatEnvelope(DisplacedFace(self.pitch, by), self.out)


class Pitch(Protocol):
    """A closed pitch curve over a parameter of period 2 pi."""

    @property
    def breaks(self) -> Array:
        """Parameters (k,) in [0, 2 pi) where the second derivative may jump."""

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Roller centre, mm, and its two derivatives by the parameter tau (n,), each (n, 2)."""


@dataclass(frozen=True, eq=False)
class TransmissionPitch:
    """Path of roller A (and of roller B) under a transmission law, polar r(t) of W 4.10."""

    transmission: Transmission

    @property
    def breaks(self) -> Array:
        """Parameters (k,) in [0, 2 pi) at which the second derivative may jump."""
        return self.transmission.breaks

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Roller centre, mm, and its two derivatives by the parameter tau (n,), each (n, 2)."""
        r, t = self.transmission.pitch(tau, 2)
        u = unit(t[0])
        n = left(u)
        first = r[1][:, None] * u + (r[0] * t[1])[:, None] * n
        second = (r[2] - r[0] * t[1] ** 2)[:, None] * u + (2.0 * r[1] * t[1] + r[0] * t[2])[:, None] * n
        return r[0][:, None] * u, first, second


@dataclass(frozen=True, eq=False)
class DisplacedPitch:
    """A pitch curve displaced outwards along its normals by the smooth distance `by` over its parameter.

    Where the curvature of the pitch curve jumps, the corner left is of second order in the distance and its slope.
    """

    pitch: Pitch
    by: Outwards

    @property
    def breaks(self) -> Array:
        """Parameters (k,) of the pitch curve's breaks, in [0, 2 pi)."""
        return self.pitch.breaks

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Centre, mm, and two derivatives by the parameter tau (n,), each (n, 2).

        The second lacks one term along the tangent, the distance times the rate of the turn: feet do not depend on it,
        and the curvature does so only to second order of the distance.
        """
        point, first, second = self.pitch.points(tau)
        off, slope, bend = self.by.rows(tau, 2)
        speed = np.hypot(first[:, 0], first[:, 1])
        tangent = first / speed[:, None]
        normal = right(tangent)
        turn = cross(first, second) / speed**2
        return (
            point + off[:, None] * normal,
            first + slope[:, None] * normal + (off * turn)[:, None] * tangent,
            second + (bend - off * turn**2)[:, None] * normal + (2.0 * slope * turn)[:, None] * tangent,
        )


@dataclass(frozen=True, eq=False)
class RollerEnvelope:
    """The contour at the roller's `radius`, mm, inside a counter-clockwise pitch curve, over that curve's parameter.

    A radius below 0 is that of a roller in a ring, whose opening lies as far outside the pitch curve.
    """

    pitch: Pitch
    radius: float

    @property
    def breaks(self) -> Array:
        """Breaks of the pitch curve (k,), rad."""
        return self.pitch.breaks

    def points(self, parameter: Array) -> Array:
        """Points (n, 2) of the contour, mm, at parameters (n,): a roller radius inside the pitch curve."""
        point, first, _ = self.pitch.points(parameter)
        points: Array = point - self.radius * right(first) / np.hypot(first[:, 0], first[:, 1])[:, None]
        return points

    def frames(self, parameter: Array) -> Frames:
        """Points and outward normals of the contour at parameters (n,), and their rates by the parameter."""
        point, first, second = self.pitch.points(np.asarray(parameter, dtype=float))
        speed = np.hypot(first[:, 0], first[:, 1])
        normal = right(first) / speed[:, None]
        turn = cross(first, second) / speed**2
        return Frames(point - self.radius * normal, normal, speed - self.radius * turn, turn)

    @cached_property
    def _table(self) -> tuple[Array, Array, Array, Array]:
        """Parameter, pitch point, radius of curvature of the contour (from the right at a break), contour point."""
        tau = grid(self.pitch.breaks)
        point, first, second = self.pitch.points(tau)
        speed = np.hypot(first[:, 0], first[:, 1])
        bend = cross(first, second) / speed**3
        radius = 1.0 / np.where(bend == 0.0, np.finfo(float).tiny, bend) - self.radius
        return tau, point, radius, point - self.radius * right(first) / speed[:, None]

    def radii(self) -> tuple[Array, Array]:
        """Parameters (m,) closely round the turn, and radii of curvature (m,), mm, negative where hollow."""
        tau, _, radius, _ = self._table
        return tau, radius

    @property
    def extent(self) -> float:
        """Greatest coordinate of the pitch curve, mm."""
        return float(np.abs(self._table[1]).max())

    @cached_property
    def _direction(self) -> Array:
        return np.unwrap(_angle(self._table[3]))

    @cached_property
    def regular(self) -> bool:
        """Whether the contour runs once round the shaft without turning back: then no part of it undercuts another."""
        closed = np.append(self._direction, self._direction[0] + TURN)
        return bool((np.diff(closed) > 0.0).all())

    def feet(self, points: Array) -> Feet:
        """Feet of points (n, 2), mm: the nearest points of the pitch curve; UnsettledError where none is found."""
        if not self.regular:
            return self._search(points)
        tau = self._table[0]
        away, turns = self._direction, np.array([-TURN, 0.0, TURN])[:, None]
        feet = self._climb(points, np.interp(_angle(points), (away + turns).ravel(), (tau + turns).ravel()))
        return searched_again(feet, points, self, self._search)

    def _search(self, points: Array) -> Feet:
        """Feet found from samples all round."""
        tau, centre, _, _ = self._table
        size = 0.5 * dot(centre, centre)
        first, second = two_best(lambda x: x @ centre.T - size, points, len(tau))
        feet = self._climb(points, tau[first]), self._climb(points, tau[second])
        # across a fold of the pitch curve the far side is seen from without: the nearer foot counts, not the higher
        near = [-np.abs(foot.excess - self.radius) for foot in feet]
        return better(*feet, *near)

    def _climb(self, points: Array, tau: Array) -> Feet:
        """Feet of points X (n, 2), climbing from parameters tau (n,)."""
        reached = [np.empty_like(points) for _ in range(3)]

        def slopes(x: Array, which: Indices) -> tuple[Array, Array, Array]:
            centre, first, second = self.pitch.points(x)
            for kept, new in zip(reached, (centre, first, second), strict=True):
                kept[which] = new
            # with the centre c at x, of f = -(X - c)^2/2: f, f' and -f''
            gap = points[which] - centre
            return -0.5 * dot(gap, gap), dot(gap, first), dot(first, first) - dot(gap, second)

        tau, step, _, _, _ = climb(slopes, tau, self.pitch.breaks)
        # the step that is left counts to second order; then height and curvature of the parallel through the point
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

    def area_and_perimeter(self) -> tuple[float, float]:
        """Area A - e P + pi e^2, mm^2, and perimeter P - 2 pi e, mm (Steiner).

        A and P are those of the pitch curve, e is the roller's radius.
        """
        tau, weight = turn_quadrature(self.pitch.breaks)
        point, first, _ = self.pitch.points(tau)
        area = float(0.5 * weight @ cross(point, first))
        perimeter = float(weight @ np.hypot(first[:, 0], first[:, 1]))
        return area - self.radius * perimeter + np.pi * self.radius**2, perimeter - TURN * self.radius

    def inset(self, distance: float) -> RollerEnvelope:
        """Parallel contour inside, at a distance, mm: by a radius greater by as much on the same pitch curve."""
        return RollerEnvelope(self.pitch, self.radius + distance)

    def displaced(self, by: Outwards) -> RollerEnvelope:
        """Contour by a pitch curve that lies `by`, mm, farther outside along its normals."""
        return RollerEnvelope(DisplacedPitch(self.pitch, by), self.radius)


def _angle(v: Array) -> Array:
    angle: Array = np.arctan2(v[:, 1], v[:, 0])
    return angle
