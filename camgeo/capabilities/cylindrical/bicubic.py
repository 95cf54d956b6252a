"""A flank as bicubic splines over (theta, r) that are once continuously differentiable, with a proved bound.

At the nodes of a grid the spline has the flank's place p, both first derivatives and the mixed one. With h1 rad and
h2 mm between nodes, I1 and I2 the interpolation in each parameter and I the identity,

    I - I1 I2 = (I - I1) + I1 (I - I2),    |I1 g| <= max |g| + h1/4 max |g_theta|,

so that nothing of the spline is farther from the flank at the same (theta, r) than

    h1^4/384 |p_1111| + h2^4/384 (|p_2222| + h1/4 |p_12222|)

(the error of cubic Hermite interpolation; P. J. Davis, Interpolation and Approximation, 1963, 3.5). In the frame of
e_r(theta), with the place (y, z) of the roller's axis and the contact of `camgeo.capabilities.cylindrical.flank`,

    p = (rho, q, z + side R cos a),    q = y - side R sin a,    rho^2 + q^2 = r^2,

and with the derivatives a_1 by theta and a_2 by rho of the contact's angle, which that of A sin a - z' cos a gives,

    M a_1 = side y' tan d - y'' sin a + z'' cos a,    M a_2 = -sin a/cos^2 d,    M = A cos a + z' sin a,

those of q, and rho_theta = -q q_1/(rho + q q_2) and rho_r = r/(rho + q q_2) on a cylinder, from which rho follows as a
series. All needs S and five derivatives, as balls over cells. Breaks of any derivative are nodes; where S'' jumps,
p_theta does, and one spline ends and another begins.

A spline may end at lines that lean. Then its parameter is s, theta(s, r) is linear in s, and the derivatives are those
of p(theta(s, r), r): along r they are by d/dr + theta_r d/dtheta, and need a sixth of S. The frame turns by theta_r.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

import numpy as np

from camgeo.capabilities.cylindrical.bends import places_along
from camgeo.capabilities.cylindrical.flank import Pose
from camgeo.capabilities.cylindrical.grid import SAME, breaks_of, parts_between
from camgeo.common.rounding import upward
from camgeo.fit.nodes import ToleranceError, check_precision, rounding
from kin.numeric.angles import TURN
from kin.numeric.elementary import cos, sin, sqrt
from kin.numeric.interval import Ball
from kin.numeric.jet import BallJet, Jet
from kin.numeric.records import dataclass
from kin.numeric.taylor import compose_balls

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.flank import Flank
    from kin.law.piecewise import Side
    from kin.numeric.arrays import Array

Number = TypeVar("Number", Jet, BallJet)

FOURTH = 4  # order of the derivatives that bound cubic interpolation
HERMITE = 384.0  # of the error of cubic Hermite interpolation
LOOKS, BLOCKS = 360, 4  # parts of a turn and of the depth, over each of which derivatives are bounded
MOST_ROWS, MOST_NODES = 64, 10_000  # of one flank: beyond, a tolerance is refused
WIDEST = 0.5  # rad between nodes
NEAR = 1e-9  # rad: a wanted angle so near a break is meant to be it
JUMP = 1e-9  # of S', in mm, and of S'': what is less is rounding


@dataclass(frozen=True, eq=False)
class Bicubic:
    """A spline of degree 3 by 3 with knots theta (n + 1,), rad, and r (m + 1,), mm, twofold within.

    `control` (2 n + 2, 2 m + 2, 3) are its control points, mm.
    """

    theta: Array
    r: Array
    control: Array


class Border(NamedTuple):
    """A line over radii r (m + 1,) at which a spline begins or ends, as the parameter s, rad, has it.

    Its shaft angles are s and `lean`, (2, m + 1), more: rad, and their slopes, rad/mm, cubic between the radii.
    """

    s: float
    lean: Array

    @staticmethod
    def upright(s: float, count: int) -> Border:
        """A line at one shaft angle."""
        return Border(s, np.zeros((2, count)))


class Span(NamedTuple):
    """Part of a flank between two borders; the shaft angle on a cylinder is linear in s, from 0 to 1, between them."""

    first: Border
    last: Border

    @property
    def upright(self) -> bool:
        """Whether the shaft angle is s."""
        return not (self.first.lean.any() or self.last.lean.any())

    @property
    def rates(self) -> Array:
        """Derivatives (2, m + 1) of the shaft angle by s, and those of them by r, 1/mm."""
        rates: Array = (self.last.lean - self.first.lean) / (self.last.s - self.first.s)
        rates[0] += 1.0
        return rates

    def at(self, s: Array) -> tuple[Array, Array]:
        """Shaft angles (n, m + 1), rad, and their slopes, rad/mm, along lines s = const (n,)."""
        share = ((s - self.first.s) / (self.last.s - self.first.s))[:, None]
        theta, slope = (a * (1.0 - share) + b * share for a, b in zip(self.first.lean, self.last.lean, strict=True))
        return s[:, None] + theta, slope

    def border(self, s: float) -> Border:
        """The line at an s within."""
        theta, slope = self.at(np.array([s]))
        return Border(s, np.stack([theta[0] - s, slope[0]]))


class _Bounds(NamedTuple):
    """Bounds over parts of the turn (n,): |p_1111|, mm per rad^4, |p_2222|, per mm^3, |p_12222|, per rad and mm^3."""

    along: Array
    across: Array
    mixed: Array

    def off(self, h1: Array, h2: Array | float) -> Array:
        """Bound of the distance, mm (n,), between nodes h1 rad (n,) and h2 mm apart."""
        off: Array = (h1**4 * self.along + h2**4 * (self.across + 0.25 * h1 * self.mixed)) / HERMITE
        return off

    def step(self, h2: float, tolerance: float) -> Array:
        """Distances of nodes, rad (n,), within which the tolerance, mm, is held; 0 where it is not."""
        left = tolerance - self.off(np.full_like(self.along, WIDEST), h2) + WIDEST**4 * self.along / HERMITE
        with np.errstate(divide="ignore"):
            step = (HERMITE * np.maximum(left, 0.0) / self.along) ** 0.25
        return np.asarray(np.minimum(step, WIDEST))


def bicubics(
    flank: Flank, ends: tuple[float, float], tolerance: float, ends_at: Sequence[float]
) -> tuple[list[Bicubic], float]:
    """Splines of a regular flank between radii `ends`, mm, over a turn from the first of the angles `ends_at`, rad.

    One ends and another begins at each of these, and where S'' jumps. Returned with them is the proved bound, mm.
    Raises ToleranceError where the tolerance cannot be held or proved.
    """
    low, high = ends
    size = high + abs(flank.level) + flank.guide.reach
    check_precision(size, tolerance)
    lost = rounding(size)
    breaks = breaks_of(flank)
    wanted = np.array([_snapped(angle, breaks) for angle in ends_at])
    start = float(wanted[0])
    joints = np.append(_behind(start, np.concatenate([wanted, jumps_of(flank)])), start + TURN)
    knots = np.append(_behind(start, np.concatenate([joints, breaks])), start + TURN)
    look = _distinct(np.concatenate([np.linspace(start, start + TURN, LOOKS + 1), knots]))
    look[[0, -1]] = start, start + TURN
    bounds, (count, step) = _rows_of(flank, look, ends, (tolerance, lost))
    theta = _columns(knots, look, step)
    r = np.linspace(low, high, count + 1)
    while True:  # between places of unlike steps nodes may be too far apart
        off = _over(look, bounds, theta).off(np.diff(theta), (high - low) / count) + lost
        wide = off > tolerance
        if not wide.any():
            break
        theta = np.sort(np.concatenate([theta, 0.5 * (theta[:-1] + theta[1:])[wide]]))
    first = np.searchsorted(theta, joints - SAME)
    parts = []
    for a, b in pairwise(first):
        span = Span(*(Border.upright(float(theta[k]), len(r)) for k in (a, b)))
        parts.append(spline(flank, theta[a : b + 1], r, span))
    return parts, float(off.max())


def _distinct(angles: Array) -> Array:
    rising = np.sort(angles)
    return np.asarray(rising[np.append(True, np.diff(rising) > SAME)])


def _snapped(angle: float, breaks: Array) -> float:
    """The break that an angle is all but equal to, or the angle."""
    off = np.remainder(breaks - angle + math.pi, TURN) - math.pi
    nearest = int(np.argmin(np.abs(off)))
    return float(breaks[nearest]) if abs(off[nearest]) < NEAR else angle


def _behind(start: float, angles: Array) -> Array:
    """Angles, rad, each once and rising over a turn from the first of them, `start`."""
    offset = np.mod(angles - start, TURN)
    return start + _distinct(np.append(0.0, offset[TURN - offset > SAME]))


def jumps_of(flank: Flank) -> Array:
    """Shaft angles (k,), rad, at which S'' jumps; raises ToleranceError where S' does."""
    if not len(flank.law.breaks):
        return np.zeros(0)
    at, jumps = flank.law.jumps(2)
    jumps = jumps * flank.guide.reach
    size = max(1.0, flank.guide.reach * float(np.abs(flank.law.derivatives(at, 2)).max()))
    if bool((np.abs(jumps[1]) > JUMP * size).any()):
        where = math.degrees(float(at[int(np.argmax(np.abs(jumps[1])))])) % 360.0
        raise ToleranceError(f"the velocity jumps at {where:.6g} degrees, where no smooth flank goes on", math.inf)
    return np.asarray(at[np.abs(jumps[2]) > JUMP * size])


class _Axis(NamedTuple, Generic[Number]):
    """Places y and z of the roller's axis with two derivatives by theta, as series."""

    y: Number
    y1: Number
    y2: Number
    z: Number
    z1: Number
    z2: Number


class _Touch(NamedTuple, Generic[Number]):
    """Contact at rho, as series: q, the height h, side R, sin a, cos a and 1/M."""

    q: Number
    h: Number
    reach: Number
    sine: Number
    cosine: Number
    over: Number


class _Rates(NamedTuple, Generic[Number]):
    """Derivatives of q and h by theta (1) and by rho (2), as series; rho + q q_2, and that of rho on a cylinder."""

    q1: Number
    h1: Number
    q2: Number
    h2: Number
    out: Number
    rho: Number


def _to(series: Number, order: int) -> Number:
    while series.order > order:
        series = series.lower()
    return series


def _axis_to(axis: _Axis[Number], order: int) -> _Axis[Number]:
    return _Axis(*(_to(part, order) for part in axis))


def _touch(flank: Flank, axis: _Axis[Number], rho: Number) -> _Touch[Number]:
    t = flank.slope
    radius = (rho - flank.at) * t + flank.radius
    along = rho + radius * t + axis.y1
    inverse = (along * along + axis.z1 * axis.z1) ** -0.5
    v, u, lag = along * inverse, axis.z1 * inverse, axis.y * inverse * (flank.side * t)
    beside = sqrt(1.0 - lag * lag)
    sine, cosine = u * beside + v * lag, v * beside - u * lag
    reach = radius * float(flank.side)
    return _Touch(axis.y - reach * sine, axis.z + reach * cosine, reach, sine, cosine, inverse / beside)


def _rates(flank: Flank, axis: _Axis[Number], rho: Number) -> _Rates[Number]:
    q, _, reach, sine, cosine, over = _touch(flank, axis, rho)
    side, t = float(flank.side), flank.slope
    turn1 = (axis.y1 * (side * t) - axis.y2 * sine + axis.z2 * cosine) * over
    turn2 = sine * over * -(1.0 + t * t)
    q1, h1 = axis.y1 - reach * cosine * turn1, axis.z1 - reach * sine * turn1
    q2, h2 = sine * (-side * t) - reach * cosine * turn2, cosine * (side * t) - reach * sine * turn2
    out = rho + q * q2
    return _Rates(q1, h1, q2, h2, out, q * q1 / out * -1.0)


def _place(flank: Flank, axis: _Axis[Number], rho: Number) -> list[Number]:
    """Place in the frame of e_r(theta)."""
    touch = _touch(flank, axis, rho)
    return [rho, touch.q, touch.h]


def _rate(flank: Flank, axis: _Axis[Number], rho: Number) -> list[Number]:
    """Derivative by theta on a cylinder in the frame of e_r(theta)."""
    q, rates = _touch(flank, axis, rho).q, _rates(flank, axis, rho)
    return [rates.rho - q, rho + rates.q1 + rates.q2 * rates.rho, rates.h1 + rates.h2 * rates.rho]


class Way(NamedTuple):
    """Lines s = const over cells (n,): their shaft angles and the derivatives of these by s, as series by the radius.

    `low` and `high` are the least and the greatest shaft angle, rad; `straight` where it is the same all along a line.
    """

    low: Array
    high: Array
    theta: BallJet
    rate: BallJet
    straight: bool

    @staticmethod
    def upright(low: Array, high: Array) -> Way:
        """Lines on which the shaft angle is the same all along, and is s."""
        theta = BallJet.variable(low, high, FOURTH).constant(Ball.between(low, high))
        return Way(low, high, theta, theta.constant(1.0), straight=True)


class Derived(NamedTuple):
    """Derivatives of the place over cells, in a frame that turns with e_r, as balls of its three parts by order.

    By s or, times the fourth power of dtheta/ds, by theta (`along`), by the radius along a line s = const (`across`),
    and of the derivative by s likewise (`mixed`).
    """

    along: list[list[Ball]]
    across: list[list[Ball]]
    mixed: list[list[Ball]]
    rate: Array

    def bounds(self) -> _Bounds:
        """Bounds of the fourth derivatives."""
        along, across, mixed = (size_of(part[FOURTH]) for part in self[:3])
        return _Bounds(along * self.rate**4, across, mixed)


def derived(flank: Flank, way: Way, r: tuple[Array, Array]) -> Derived:
    """Derivatives over cells (n,) along lines s = const, between radii r[0] and r[1], mm, (n,) each."""
    lift = flank.law.on(BallJet.variable(way.low, way.high, FOURTH + (1 if way.straight else 2)))
    y, z = flank.guide.path(lift)
    y1, z1 = y.derivative(), z.derivative()
    axis = _Axis(y, y1, y1.derivative(), z, z1, z1.derivative())
    rows = [part.rows[0] for part in axis]
    start = places_along(flank, rows[:3], rows[3:], Ball.between(*r))
    here = BallJet(start.mid[None], start.rad[None])

    # by theta: the frame itself turns
    rho = here
    for order in range(FOURTH):
        rho = _rates(flank, _axis_to(axis, order), rho).rho.integral(start)
    even = rho.constant(1.0)
    along = _turning(_place(flank, _axis_to(axis, FOURTH), rho), even)

    # by r, where the shaft angle is that of the line
    rho, radius, slope = here, BallJet.variable(*r, FOURTH), way.theta.derivative()
    led = _Axis(*(_led(part, way) for part in axis))
    for order in range(FOURTH):
        rates = _rates(flank, _axis_to(led, order), rho)
        rise = _to(radius, order) / rates.out
        rho = (rise if way.straight else rise + rates.rho * _to(slope, order)).integral(start)
    across = _turning(_place(flank, led, rho), slope)
    mixed = _turning([part * way.rate for part in _rate(flank, led, rho)], slope)
    return Derived(along, across, mixed, way.rate.rows[0].magnitude)


def _led(part: BallJet, way: Way) -> BallJet:
    """A series by theta as one by the radius, along lines s = const."""
    if way.straight:
        return way.theta.constant(part.rows[0])
    return BallJet.of(compose_balls(_to(part, FOURTH).rows, way.theta.rows))


def _turning(parts: Sequence[BallJet], slope: BallJet) -> list[list[Ball]]:
    """Derivatives of a place by order, from its parts as series in a frame that turns by an angle of a slope."""
    x, q, h = parts
    found = [[part.rows[0] for part in parts]]
    while x.order:
        turn = _to(slope, x.order - 1)
        across, along = _to(q, x.order - 1) * turn, _to(x, x.order - 1) * turn
        x, q, h = x.derivative() - across, q.derivative() + along, h.derivative()
        found.append([part.rows[0] for part in (x, q, h)])
    return found


def _bounds(flank: Flank, look: Array, ends: tuple[float, float]) -> _Bounds:
    """Bounds between neighbours of angles (n + 1,), rad, and radii `ends`, mm."""
    n, edges = len(look) - 1, np.linspace(*ends, BLOCKS + 1)
    way = Way.upright(np.tile(look[:-1], BLOCKS), np.tile(look[1:], BLOCKS))
    found = derived(flank, way, (np.repeat(edges[:-1], n), np.repeat(edges[1:], n)))
    folded = [part.reshape(BLOCKS, n).max(axis=0) for part in found.bounds()]
    for part in folded:
        if not bool(np.isfinite(part).all()):
            where = math.degrees(float(look[int(np.argmax(~np.isfinite(part)))])) % 360.0
            message = f"the motion's higher derivatives have no bound near {where:.6g} degrees: no surface is proved"
            raise ToleranceError(message, math.inf)
    return _Bounds(*folded)


def size_of(parts: Sequence[Ball]) -> Array:
    """Bound of a derivative's length (n,)."""
    return np.asarray(np.sqrt(sum(part.magnitude**2 for part in parts)))


def rows_for(flank: Flank, ends: tuple[float, float], tolerance: float, lost: float) -> int:
    """Number of rows between radii `ends`, mm, that needs the fewest control points within a tolerance, mm.

    `lost`, mm, of it is rounding. Raises as `bicubics` does.
    """
    look = _distinct(parts_between(breaks_of(flank), LOOKS))
    return _rows_of(flank, look, ends, (tolerance, lost))[1][0]


def _rows_of(
    flank: Flank, look: Array, ends: tuple[float, float], within: tuple[float, float]
) -> tuple[_Bounds, tuple[int, Array]]:
    """Bounds between neighbours of angles, rad, and what `_rows` finds by them within a tolerance and its rounding."""
    tolerance, lost = within
    bounds, wide, depth = _bounds(flank, look, ends), np.diff(look), ends[1] - ends[0]
    rows = _rows(bounds, wide, depth, tolerance - lost)
    if rows is None:
        least = tolerance
        while _rows(bounds, wide, depth, least) is None:
            least *= 1.5
        problem = f"a flank within {tolerance:.3g} mm would take too many control points"
        raise ToleranceError(f"{problem}; give at least {upward(least + lost, 3)} mm", least + lost)
    return bounds, rows


def _rows(bounds: _Bounds, wide: Array, depth: float, tolerance: float) -> tuple[int, Array] | None:
    """Number of rows that needs the fewest control points, and the greatest distance of nodes (n,), rad.

    None where a tolerance, mm, takes too many.
    """
    best: tuple[float, int, Array] | None = None
    for count in range(1, MOST_ROWS + 1):
        step = bounds.step(depth / count, tolerance)
        if step.min() > 0.0:
            points = (count + 1) * (float(np.sum(wide / step)) + 1.0)
            if best is None or points < best[0]:
                best = points, count, step
    return None if best is None or best[0] > MOST_NODES else best[1:]


def _columns(knots: Array, look: Array, step: Array) -> Array:
    """Shaft angles, rad, from knot to knot, no farther apart than `step` (n,) anywhere between them."""
    found = []
    for low, high in pairwise(knots):
        inside = np.flatnonzero((look[1:] > low + SAME) & (look[:-1] < high - SAME))
        places = np.concatenate([[low], look[inside[1:]], [high]])
        along = np.concatenate([[0.0], np.cumsum(np.diff(places) / step[inside])])
        count = max(1, math.ceil(along[-1]))
        found.append(np.append(low, np.interp(np.linspace(0.0, along[-1], count + 1)[1:-1], along, places)))
    return np.append(np.concatenate(found), knots[-1])


def _over(look: Array, bounds: _Bounds, theta: Array) -> _Bounds:
    """Bounds between neighbours of theta (m + 1,), from those between neighbours of `look`."""
    first = np.searchsorted(look, theta[:-1] + SAME, side="right") - 1
    last = np.searchsorted(look, theta[1:] - SAME, side="left")
    return _Bounds(*(np.array([part[a:b].max() for a, b in zip(first, last, strict=True)]) for part in bounds))


def spline(flank: Flank, s: Array, r: Array, span: Span) -> Bicubic:
    """Spline through nodes s (n + 1,), rad, of a span, between which S'' is continuous, and r (m + 1,), mm."""
    theta, slope = (rows.ravel() for rows in span.at(s))
    radius, inner = np.tile(r, len(s)), theta.size - len(r)
    parts = [slice(None, inner), slice(inner, None)]  # a break at the last line counts from before it
    sides: tuple[Side, Side] = (1, -1)
    found = [local(flank, (theta[k], slope[k]), radius[k], side) for k, side in zip(parts, sides, strict=True)]
    p, by_r, by_theta, by_both = (np.concatenate(pair).reshape(len(s), len(r), 3) for pair in zip(*found, strict=True))
    rate, more = span.rates[:, None, :, None]
    by_s, by_both = by_theta * rate, by_both * rate + by_theta * more
    a, b = _beside(s)[:, None, None], _beside(r)[None, :, None]
    nodes = [np.repeat(np.repeat(node, 2, axis=0), 2, axis=1) for node in (p, by_r, by_s, by_both)]
    own, own_r, own_s, own_both = nodes
    return Bicubic(s, r, own + a * own_s + b * own_r + a * b * own_both)


def local(flank: Flank, line: tuple[Array, Array], r: Array, side: Side = 1) -> tuple[Array, Array, Array, Array]:
    """Places (n, 3) on cylinders r (n,), their derivatives along lines by r, those by theta, and of these along lines.

    A line is at a shaft angle, rad, and has a slope, rad/mm (n,) each; a break counts from one side.
    """
    theta, slope = line
    y, z = flank.guide.path(flank.law.on(Jet.variable(theta, 3 if slope.any() else 2), side))
    y1, z1 = y.derivative(), z.derivative()
    axis = _Axis(*(_first(part, slope) for part in (y, y1, y1.derivative(), z, z1, z1.derivative())))
    rows = [part.c[0] for part in axis]
    start = flank.reached(Pose(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], np.zeros_like(theta)), r)
    rates = _rates(flank, _axis_to(axis, 0), Jet(start[None]))
    rho = Jet(np.stack([start, r / rates.out.c[0] + rates.rho.c[0] * slope]))
    turn = Jet(np.stack([theta, slope]))
    c, s = cos(turn), sin(turn)
    found = []
    for x, q, h in (_place(flank, axis, rho), _rate(flank, axis, rho)):
        found += [x * c - q * s, x * s + q * c, h]
    by = np.array([part.c for part in found]).reshape(2, 3, 2, -1).transpose(0, 2, 3, 1)
    return by[0, 0], by[0, 1], by[1, 0], by[1, 1]


def _first(part: Jet, slope: Array) -> Jet:
    """A series by theta as one of first order by r, along lines of a slope (n,)."""
    return Jet(np.stack([part.c[0], part.c[1] * slope if part.order else np.zeros_like(slope)]))


def _beside(nodes: Array) -> Array:
    """How far control points (2 n,) lie beside their nodes (n,): by a third of the way to the next, or on it."""
    third = np.diff(nodes) / 3.0
    return np.stack([-np.append(0.0, third), np.append(third, 0.0)], axis=1).ravel()
