"""Measures of a whole contour: perimeter, area and moments, distances from the shaft, the contour over its polar angle.

With g = P.T and h = P.N, N the outward normal, the frame gives

    (r^2)' = 2 sigma g,    h' = omega g,    g' = sigma - omega h,    g'' = sigma' - omega' h - omega^2 g.

So over an interval of width w the greatest |g| is at most ``(e + w^2/8 (|sigma'| + |omega'| r))/(1 - w^2 omega^2/8)``,
e being the greater of its ends, and r^2 and h differ from those at the nearer end by no more than w/2 times their rate.
Intervals that may still hold more than the best value found are divided: no extreme is missed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curvature import roots
from camgeo.curve.curve import CurveError
from camgeo.curve.extremes import LEVELS, MOST, SHARPNESS, Extreme, subdivide_undecided
from camgeo.curve.support import is_sharp
from kin.numeric.quadrature import gauss
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Bounds, Curve, Frame
    from kin.contour.arcs import Arcs
    from kin.numeric.arrays import Array, Mask

NODES, WEIGHTS = gauss(12)
FIRST = 8  # parts of a stretch, at first
EXACT = 1e-13  # of the whole integral: a part that halving changes by less is done
HALVINGS = 30
ROUNDING = 1e-14  # of an integral: error of its sum
STEP = 0.05  # rad: greatest step in polar angle between knots, among which parameters are sought
PLACES = 2048  # knots of each run, at first
CLOSE = 1e-15  # of a step between knots: precision of a parameter
NOISE = 0.05  # of the tolerance of a proof: a place must be better by more than this, which is rounding


@dataclass(frozen=True)
class Measures:
    """Perimeter, mm, and area, mm^2, of a closed contour."""

    perimeter: float
    area: float


@dataclass(frozen=True)
class Moments:
    """Integrals over a plane area: of 1, mm^2; of x and of y from the shaft, mm^3; of the radius squared, mm^4.

    `error` bounds the error of each, in their order and units.
    """

    area: float
    x: float
    y: float
    polar: float
    error: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)


def measures(curve: Curve) -> Measures:
    """Perimeter and area within a curve: integrals of sigma and of h sigma/2 (Green), to about twelve digits."""

    def rates(frame: Frame) -> Array:
        return np.stack([frame.speed, 0.5 * frame.speed * np.sum(frame.point * frame.normal, axis=1)])

    (perimeter, area), _ = _integrals(curve, rates)
    return Measures(float(perimeter), float(area))


def moments(curve: Curve, inset: float = 0.0) -> Moments:
    """Moments of the area within a curve, or within its parallel `inset` mm inside.

    A homogeneous function f of degree d has as integral over the area the integral of h sigma f/(d + 2) round the curve
    (by the divergence of f times the place), h the distance of the tangent from the shaft. The parallel has the speed
    sigma - inset omega. Raises CurveError where no finite bounds of the curve are proved.
    """

    def rates(frame: Frame) -> Array:
        point = frame.point - inset * frame.normal
        return _moment_rates(point, np.sum(point * frame.normal, axis=1) * (frame.speed - inset * frame.turn))

    total, change = _integrals(curve, rates)
    area, x, y, polar = total.tolist()
    far = curve.size
    # rounding of the sums: each is of terms no larger than the area's by a power of the size
    scale = ROUNDING * area * np.array([1.0, far, far, far * far])
    error = np.maximum(change, scale).tolist()
    return Moments(area, x, y, polar, (error[0], error[1], error[2], error[3]))


def moments_of_chain(chain: Arcs) -> Moments:
    """Moments of the area within a closed chain of lines and arcs, counter-clockwise; exact to rounding."""
    # h f/(d + 2) along arcs of no more than about a radian each
    parts, _ = chain.cut(np.maximum(np.ceil(np.abs(chain.curvature) * chain.length), 1.0).astype(np.intp))
    total = np.zeros(4)
    for node, weight in zip(NODES, WEIGHTS, strict=True):
        s = 0.5 * (1.0 + node) * parts.length
        point, tangent = parts.points(s), parts.tangents(s)
        height = point[:, 0] * tangent[:, 1] - point[:, 1] * tangent[:, 0]
        total += _moment_rates(point, 0.5 * weight * parts.length * height).sum(axis=1)
    area, x, y, polar = total.tolist()
    return Moments(area, x, y, polar)


def _moment_rates(point: Array, swept: Array) -> Array:
    """Contributions (4, n) of points (n, 2) with `swept` h ds (n,) to integrals of 1, x, y and radius squared."""
    x, y = point.T
    added: Array = swept * np.stack([np.full_like(x, 0.5), x / 3.0, y / 3.0, 0.25 * (x * x + y * y)])
    return added


def _integrals(curve: Curve, rates: Callable[[Frame], Array]) -> tuple[Array, Array]:
    """Integrals (k,) of rates (k, n) over the whole curve, and by how much the last halving changed them (k,)."""
    stretches = np.concatenate([run.stretches for run in curve.runs])
    share = np.linspace(0.0, 1.0, FIRST + 1)
    knots = stretches[:, :1] * (1.0 - share) + stretches[:, 1:] * share
    low, high = knots[:, :-1].ravel(), knots[:, 1:].ravel()
    whole = _over(curve, rates, low, high)
    scale = np.abs(whole).sum(axis=1)
    total, changed = np.zeros(len(whole)), np.zeros(len(whole))
    # a part is done where its halves together agree with the whole
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        first, second = _over(curve, rates, low, middle), _over(curve, rates, middle, high)
        change = np.abs(first + second - whole)
        done = (change <= EXACT * scale[:, None]).all(axis=0)
        total += (first + second)[:, done].sum(axis=1)
        changed += change[:, done].sum(axis=1)
        if done.all():
            break
        low, high = np.concatenate([low[~done], middle[~done]]), np.concatenate([middle[~done], high[~done]])
        whole = np.concatenate([first[:, ~done], second[:, ~done]], axis=1)
    else:
        total += whole.sum(axis=1)  # parts that are still open, too narrow to count
        changed += np.abs(whole).sum(axis=1)
    return total, changed


def _over(curve: Curve, rates: Callable[[Frame], Array], low: Array, high: Array) -> Array:
    """Integrals (k, n) of rates over intervals (n,) within stretches, by Gauss and Legendre."""
    half = 0.5 * (high - low)
    t = 0.5 * (low + high)[:, None] + half[:, None] * NODES
    rows = rates(curve.sample(t.ravel()))
    integrals: Array = (rows.reshape(len(rows), *t.shape) @ WEIGHTS) * half
    return integrals


def touched(contour: Curve, parameter: Array) -> Mask:
    """Whether the contour has a point, perhaps a sharp corner, at each parameter (n,): it is not trimmed away there."""
    if contour.closed or is_sharp(contour):
        return np.ones(parameter.shape, dtype=bool)
    period = contour.shape.period
    inside = [np.mod(parameter - run.low, period) <= run.high - run.low for run in contour.runs]
    mask: Mask = np.any(inside, axis=0)
    return mask


# --- distances from the shaft -----------------------------------------------------------------------------------------


def farthest(curve: Curve) -> Extreme:
    """Greatest distance of a contour from the shaft, mm, its parameter, and how much greater it may be, mm."""
    return _root(_greatest(curve, lambda frame: np.sum(frame.point**2, axis=1), _radial), 1.0)


def nearest(curve: Curve) -> Extreme:
    """Least distance of a contour from the shaft, mm, its parameter, and how much less it may be, mm."""
    return _root(_greatest(curve, lambda frame: -np.sum(frame.point**2, axis=1), _radial), -1.0)


def least_support(curve: Curve) -> Extreme:
    """Least distance of the shaft from a tangent of a contour, mm, its parameter, and how much less it may be, mm.

    It is below 0 where the shaft lies on a tangent's outer side. Where it is above 0 each ray from the shaft meets the
    contour once.
    """
    extreme = _greatest(curve, lambda frame: -np.sum(frame.point * frame.normal, axis=1), _turning)
    return Extreme(-extreme.value, extreme.at, extreme.excess)


def _root(square: Extreme, sign: float) -> Extreme:
    value = math.sqrt(max(sign * square.value, 0.0))
    return Extreme(value, square.at, square.excess / value if value else math.sqrt(square.excess))


def _radial(bounds: Bounds) -> tuple[Array, Mask]:
    """Greatest |2 sigma| of each cell (n,), mm, and whether sigma keeps its sign there: (r^2)' is 2 sigma g."""
    rate = 2.0 * np.maximum(np.abs(bounds.speed_low), np.abs(bounds.speed_high))
    return rate, (bounds.speed_low >= 0.0) | (bounds.speed_high <= 0.0)


def _turning(bounds: Bounds) -> tuple[Array, Mask]:
    """Greatest |omega| of each cell (n,), and whether omega keeps its sign there: h' is omega g."""
    rate = np.maximum(np.abs(bounds.turn_low), np.abs(bounds.turn_high))
    return rate, (bounds.turn_low >= 0.0) | (bounds.turn_high <= 0.0)


def _greatest(curve: Curve, value: Callable[[Frame], Array], pace: Callable[[Bounds], tuple[Array, Mask]]) -> Extreme:
    """Greatest value of a figure of the curve, whose derivative is g times its `pace`."""
    cells = curve.cells
    low, high, size = cells.low, cells.high, 2.0 * curve.size
    best, place, tolerance = -math.inf, float(low[0]), 0.0
    for _ in range(LEVELS):
        ends = curve.span(low, high)
        values = np.stack([value(frame) for frame in ends])
        g = np.stack([np.sum(frame.point * frame.tangent, axis=1) for frame in ends])
        top = int(np.argmax(values))
        tolerance = max(tolerance, SHARPNESS * float(np.abs(values).max()))
        if values.flat[top] > best + NOISE * tolerance:  # on a circle the first place, not where rounding is greatest
            best, place = float(values.flat[top]), float(np.concatenate([low, high])[top])
        # |g''| <= |sigma'| + |omega'| r + omega^2 |g|, so g exceeds its ends by w^2/8 of that sum at the most; the
        # figure exceeds its ends by w/2 of the greatest |g| times the pace, by nothing where both keep their signs
        bounds, width = cells.over(low, high), high - low
        turn = np.maximum(np.abs(bounds.turn_low), np.abs(bounds.turn_high))
        bend = 0.125 * width**2
        slack, share = bend * (bounds.speed_slope + bounds.turn_slope * size), 1.0 - bend * turn**2
        with np.errstate(divide="ignore", invalid="ignore"):
            most = np.where(share > 0.0, np.minimum((np.abs(g).max(axis=0) + slack) / share, size), size)
        keeps = (g[0] * g[1] > 0.0) & (np.abs(g).min(axis=0) > slack + bend * turn**2 * most)
        rate, one_way = pace(bounds)
        reach = values.max(axis=0) + np.where(keeps & one_way, 0.0, 0.5 * width * rate * most)
        open_ = ~(reach <= best + tolerance)
        if not open_.any():
            return Extreme(best, place, tolerance)
        low, high, reach = low[open_], high[open_], reach[open_]
        if low.size > MOST:
            break
        low, high, _ = subdivide_undecided(low, high)
    return Extreme(best, place, float(reach.max()) - best)


# --- over the polar angle ---------------------------------------------------------------------------------------------


class StarError(CurveError):
    """A contour that is not proved to be a function of the polar angle about the shaft."""


def polar_radius(curve: Curve, angles: Array) -> Array:
    """Distance of a contour from the shaft, mm (n,), at polar angles (n,), rad, about the shaft.

    Raises StarError unless each ray from the shaft is proved to cross the contour once.
    """
    point = curve.sample(polar_parameters(curve, angles)).point
    radius: Array = np.hypot(point[:, 0], point[:, 1])
    return radius


def polar_parameters(curve: Curve, angles: Array) -> Array:
    """Parameters (n,) of a contour at polar angles (n,), rad, about the shaft; each a root on the exact curve.

    Raises StarError unless each ray from the shaft is proved to cross the contour once.
    """
    least = least_support(curve)
    if not least.value > least.excess:
        raise StarError("a ray from the shaft may cross the contour more than once or not at all", least.at)
    # the knots on both sides of each ray, then the root of the distance beside the ray between them
    knots, polar = _polar_knots(curve)
    rays = np.mod(angles - polar[0], 2.0 * np.pi) + polar[0]
    cell = np.clip(np.searchsorted(polar, rays, side="right") - 1, 0, len(polar) - 2)
    skipped = knots[cell + 1] <= knots[cell]  # the seam between two runs, at one polar angle
    cell = np.where(skipped, cell - 1, cell)
    low, high = knots[cell], knots[cell + 1]
    cosine, sine = np.cos(rays), np.sin(rays)

    def beside(t: Array) -> Array:
        point = curve.sample(t).point
        distance: Array = point[:, 1] * cosine - point[:, 0] * sine
        return distance

    ends = beside(low), beside(high)
    exact = [np.abs(end) <= 0.0 for end in ends]
    open_ = ~(exact[0] | exact[1]) & (ends[0] < 0.0) & (ends[1] > 0.0)
    # a ray that passes both ends on one side does so by rounding alone: the nearer end is taken
    parameters: Array = np.where(np.abs(ends[0]) <= np.abs(ends[1]), low, high)
    if open_.any():
        cosine, sine = cosine[open_], sine[open_]
        parameters[open_] = roots(beside, low[open_], high[open_], (ends[0][open_], ends[1][open_]), CLOSE)
    return parameters


def _polar_knots(curve: Curve) -> tuple[Array, Array]:
    """Parameters (m,), run after run, and their polar angles, rising over one turn and less than `STEP` apart."""
    runs = []
    for run in curve.runs:
        t = np.linspace(run.low, run.high, PLACES + 1)
        for _ in range(LEVELS):
            point = curve.sample(t).point
            z = point[:, 0] + 1j * point[:, 1]
            wide = np.abs(np.angle(z[1:] / z[:-1])) > STEP
            if not wide.any():
                break
            t = np.sort(np.concatenate([t, 0.5 * (t[:-1] + t[1:])[wide]]))
        runs.append((t, z))
    z = np.concatenate([z for _, z in runs])
    steps = np.angle(z[1:] / z[:-1])
    polar = np.angle(z[0]) + np.concatenate([[0.0], np.cumsum(np.maximum(steps, 0.0))])
    return np.concatenate([t for t, _ in runs]), polar
