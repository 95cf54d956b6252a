"""Least sizes of disc cams for given pressure angles or a given radius of curvature.

A pressure angle bounds where the shaft may lie, seen from the follower: half planes, one for every shaft angle. For a
stem the worst of each kind is one number; for an arm the nearest point to the roller's lowest place is sought, and the
worst half planes are added until none is broken by more than rounding (cutting planes; J. E. Kelley, SIAM J. 8, 1960).
Each size found is the least that keeps the angles, up to rounding.

A radius of curvature bounds the shaft's place by no convex set. Where it is to be kept too, each direction from the
shaft to the roller's lowest place has its least prime circle, and the best direction is sought over shaft angles that
stand for all; those at which its cam breaks a limit are added until there are none (an exchange method; R. Hettich and
K. O. Kortanek, SIAM Review 35, 1993).

In all functions `rising` and `falling` are the greatest pressure angles on the follower's rise and return, rad, and
`motion` is the displacement, mm on a stem, rad on an arm.
"""

from __future__ import annotations

import math
from itertools import product
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np

from camgeo.curve.curvature import least_radius, roots
from camgeo.curve.curve import Curve
from camgeo.curve.disc import SwingingFace, face_shape
from camgeo.curve.extremes import greatest, least, subdivide
from camgeo.curve.moving_frame import CentreShape, Oscillating, Translating
from camgeo.curve.rates import cut, stretches
from kin.law.normalised import IntentError
from kin.numeric import elementary
from kin.numeric.elementary import Jet

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from camgeo.curve.curve import Shape, Side
    from camgeo.curve.disc import Face
    from camgeo.curve.moving_frame import Displacement
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array, Mask

    _Limits = Callable[[Array, Array | float], Mask]

_GuideT = TypeVar("_GuideT", Translating, Oscillating)
_CUTS = 60  # pairs of cutting planes
_BROKEN = 1e-12  # of the arm's length: the distance by which the shaft may miss a half plane in the end
_FEASIBLE = 1e-11  # of the arm's length: the distance by which a corner on trial may miss a half plane
_DOUBLINGS = 30  # of a size: a billion times the first, before the search ends without one
_PRECISE = 1e-13  # of a size
_ANGLES = 480  # shaft angles that stand for all at first
_DIRECTIONS = 65  # tried together, and twice as many at first
_GROWTH = 1.1  # from prime circle to prime circle, as long as none is known that keeps the limits
_SIZES = 145  # prime circles of this growth: up to a million times the first
_PARTS = 32  # of the range of prime circles below the first that keeps the limits
_NARROWER = 8.0  # times the directions draw together from one pass to the next
_LOOKS = 4  # passes over ever closer directions, before the exact figures are taken
_FINE = 1e-9  # rad: the search for a direction ends at this width
_EXCHANGES = 16  # times that worst shaft angles are added
_SPARE = 1e-10  # rad, and of a radius: limits are kept with this to spare, for rounding
_TINY = 1e-9  # rad: least angle of a swinging face at rest
_RESTS = 256  # angles at rest of a swinging face that are tried
_LOOSE = 1e-4  # of the pivot's distance: radii between the angles tried may be less by this


class _Planes(Protocol):
    """Rows (x, y, c) of half planes ``x X + y Y >= c`` over the shaft angle."""

    def __call__(self, tau: Series, break_side: Side = 1) -> list[tuple[Series, Series, Series]]:
        """The rows as series at jets of the shaft angle; `break_side` picks a side at a break."""
        ...


def _demand_angles(rising: float, falling: float) -> None:
    for name, angle in (("at_most", rising), ("on_return", falling)):
        if not 0.0 < angle < 0.5 * math.pi:
            raise IntentError(
                f"a pressure angle to keep below lies between 0 and 90 degrees, not {math.degrees(angle):.6g}",
                f"sizing.pressure-angle.{name}",
            )


def stem_needs(motion: Displacement, rising: float, falling: float) -> tuple[float, float]:
    """Bounds A_r and A_f, mm, of a stem's foot d and offset e that keep both pressure angles.

    They are kept where ``d + e cot rising >= A_r`` on the rise and ``d - e cot falling >= A_f`` on the return. Raises
    IntentError for an angle that is not between 0 and 90 degrees.
    """
    _demand_angles(rising, falling)

    def need(cotangent: float) -> float:
        def figure(tau: Series, side: Side = 1) -> Series:
            # tan alpha = (S' - e)/(d + S), solved for d + e cot alpha
            s = motion.on(tau, side)
            v = s.derivative()
            return v * cotangent - cut(s, v.order)

        return greatest(figure, stretches(motion)).value

    return need(1.0 / math.tan(rising)), need(-1.0 / math.tan(falling))


def least_stem(motion: Displacement, rising: float, falling: float, offset: float | None = None) -> Translating:
    """Stem with the least prime circle that keeps both pressure angles.

    An `offset`, mm, is kept; for None the best is found. Raises IntentError for a motion that stands still, and for an
    angle that is not between 0 and 90 degrees.
    """
    up, down = stem_needs(motion, rising, falling)
    a, b = 1.0 / math.tan(rising), 1.0 / math.tan(falling)
    if offset is not None:
        return Translating(positive_foot(max(up - offset * a, down + offset * b)), offset)
    for need, angle, sign, cotangent in ((up, rising, 1.0, b), (down, falling, -1.0, a)):
        # foot of the perpendicular from the shaft on one limit's edge, if the other limit is kept there
        d, e = need * math.sin(angle) ** 2, sign * need * math.sin(angle) * math.cos(angle)
        if d - sign * cotangent * e >= (down if sign > 0 else up):
            return Translating(positive_foot(d), e)
    # else the corner of both limits is nearest to the shaft
    e = (up - down) / (a + b)
    return Translating(positive_foot(up - e * a), e)


def positive_foot(foot: float) -> float:
    """The foot d of a stem, mm, itself; raises IntentError unless it is above 0."""
    if not foot > 0.0:
        raise IntentError("a motion that stands still needs no pressure angle; give a base radius", "sizing")
    return foot


def least_arm(
    motion: Displacement,
    length: float,
    side: int,
    rising: float,
    falling: float,
    *,
    second: tuple[float, float] | None = None,
) -> Oscillating:
    """Arm of a length, mm, with the pivot that gives the least prime circle within both pressure angles.

    `side` is 1 for a trailing arm, -1 for a leading one. `second` is the length of a bell crank's second arm, mm, and
    the angle between both arms, rad: the second disc keeps the same angles, on the first arm's rise and return. Raises
    IntentError where no pivot keeps the angles, and for an angle that is not between 0 and 90 degrees.
    """
    _demand_angles(rising, falling)
    planes = [_half_planes(motion, length, side, rising, falling)]
    if second is not None:
        planes.append(_half_planes(motion.scaled(-1.0), second[0], -side, falling, rising, apart=second[1]))

    # the shaft begins in the roller's lowest place, seen from the pivot
    rows = np.empty((0, 3))
    shaft = np.array([length, 0.0])
    for _ in range(_CUTS):
        # of each disc and kind the half plane that the shaft breaks most
        worst, new_rows = 0.0, []
        for of_arm, kind in product(planes, (0, 1)):

            def broken(
                tau: Series, break_side: Side = 1, of_arm: _Planes = of_arm, kind: int = kind, shaft: Array = shaft
            ) -> Series:
                x, y, c = of_arm(tau, break_side)[kind]
                return c - x * float(shaft[0]) - y * float(shaft[1])

            extreme = greatest(broken, stretches(motion))
            worst = max(worst, extreme.value)
            new_rows.append([float(row.c[0, 0]) for row in of_arm(Jet.variable(extreme.at, 1))[kind]])
        if worst <= _BROKEN * length:
            break
        # the nearest shaft that keeps all half planes so far
        rows = np.vstack([rows, new_rows])
        target, previous = np.array([length, 0.0]), shaft
        shaft = nearest_in(rows, target, _FEASIBLE * length)
        if bool((shaft == previous).all()):  # a corner that breaks a known half plane by less than the slack
            shaft = nearest_in(rows, target, 0.5 * _BROKEN * length)
    else:
        raise IntentError("the least prime circle of the arm was not found", "sizing")
    x, y = shaft
    return Oscillating(math.hypot(x, y), length, math.atan2(y, x), side)


def _half_planes(
    motion: Displacement, length: float, side: int, rising: float, falling: float, *, apart: float | None = None
) -> _Planes:
    """Rows (x, y, c) of the half planes ``x X + y Y >= c`` for the shaft's place, as a function of the shaft angle.

    The shaft is seen from the pivot, x along the lowest arm; `apart` is the angle of a bell crank's second arm, rad,
    from that arm.
    """
    ahead, behind = (rising, falling) if side > 0 else (falling, rising)

    def planes(tau: Series, break_side: Side = 1) -> list[tuple[Series, Series, Series]]:
        # tan alpha = side (L (1 + side S') - C cos psi)/(C sin psi), psi = rest + S, within both limits: linear in the
        # shaft's place (C cos rest, C sin rest)
        s = motion.on(tau, break_side)
        pace = (s.derivative() * float(side) + 1.0) * length
        s = cut(s, pace.order)
        first, second = s - ahead, s + behind
        rows = [
            (elementary.cos(first), -elementary.sin(first), pace * math.cos(ahead)),
            (-elementary.cos(second), elementary.sin(second), pace * -math.cos(behind)),
        ]
        if apart is None:
            return rows
        # the shaft seen along the second arm is turned by the angle between both arms, and mirrored
        x, y = math.cos(apart), math.sin(apart)
        return [(u * x + v * y, u * y - v * x, c) for u, v, c in rows]

    return planes


def nearest_in(rows: Array, target: Array, slack: float) -> Array:
    """Point (2,), mm, nearest to `target` (2,) in the intersection of half planes ``x X + y Y >= c``.

    `rows` (m, 3) are (x, y, c) with normals (x, y) of length 1. A point may miss a half plane by `slack`, mm. Raises
    IntentError where the intersection is empty.
    """
    normals, level = rows[:, :2], rows[:, 2]
    # the nearest point is the target, the foot of its perpendicular on an edge, or a corner of two edges
    feet = target + np.maximum(level - normals @ target, 0.0)[:, None] * normals
    i, j = np.triu_indices(len(rows), 1)
    determinant = normals[i, 0] * normals[j, 1] - normals[i, 1] * normals[j, 0]
    i, j, determinant = (part[np.abs(determinant) > 0.0] for part in (i, j, determinant))
    corners = np.column_stack(
        [
            (level[i] * normals[j, 1] - level[j] * normals[i, 1]) / determinant,
            (normals[i, 0] * level[j] - normals[j, 0] * level[i]) / determinant,
        ]
    )
    points = np.concatenate([feet, corners])
    inside = points[(points @ normals.T >= level - slack).all(axis=1)]
    if not inside.size:
        raise IntentError(
            "no pivot keeps the pressure angles with this arm; a smaller swing, a longer rise or wider limits do",
            "sizing.pressure-angle",
        )
    nearest: Array = inside[np.argmin(np.hypot(*(inside - target).T))]
    return nearest


def least_round(
    motion: Displacement, guide: _GuideT, angles: tuple[float, float], radius: float, start: float
) -> _GuideT:
    """Guide of the least prime circle, of radius `start`, mm, or more, that keeps pressure angles and a radius.

    It is `guide` with the shaft elsewhere. `angles` are the greatest on the rise and on the return, rad; `radius`, mm,
    is the least radius of curvature on the pitch curve's convex stretches. Raises IntentError where no guide is found,
    and for an angle that is not between 0 and 90 degrees.
    """
    rising, falling = angles
    _demand_angles(rising, falling)
    steep = math.tan(rising - _SPARE), math.tan(falling - _SPARE)
    samples: Array = _samples(motion)

    def keeps(direction: Array, prime: Array | float) -> Mask:
        """Whether each direction (n,), rad, keeps the limits, with the shaft on prime circles (n,), mm."""
        along, across = prime * np.cos(direction), prime * np.sin(direction)
        s = np.broadcast_to(samples[:, None], (4, len(direction), samples.shape[1]))
        # tan alpha = a/b and sigma >= rho omega, the moving frame of `camgeo.curve.moving_frame`
        b, a, rate = guide.with_shaft(along[:, None], across[:, None]).rows(s)
        speed = np.hypot(a[0], b[0])
        turn = rate[0] + (b[1] * a[0] - a[1] * b[0]) / speed**2
        gentle = (b[0] > 0.0) & (a[0] <= b[0] * steep[0]) & (-a[0] <= b[0] * steep[1])
        mask: Mask = (gentle & (speed >= radius * (1.0 + _SPARE) * turn)).all(axis=1)
        return mask

    # at rest, where the motion is lowest, the pressure angle is that of the direction, turned round
    middle, half = 0.5 * (falling - rising), 0.5 * (falling + rising)
    directions = middle + half * np.linspace(-1.0, 1.0, 2 * _DIRECTIONS - 1)
    prime = _first_size(keeps, directions, (start * _GROWTH**k for k in range(_SIZES)))
    prime = _first_size(keeps, directions, np.linspace(start, prime, _PARTS + 1).tolist())
    for _ in range(_EXCHANGES):
        # the best direction at the samples, among ever closer ones
        for _ in range(_LOOKS):
            prime = _first_size(keeps, directions, (prime * (1.0 + half) ** k for k in range(_SIZES)))
            middle, prime = _best_direction(
                keeps, directions, prime, max(start, prime * (1.0 - _NARROWER * half)), start
            )
            half /= _NARROWER
            directions = middle + half * np.linspace(-1.0, 1.0, _DIRECTIONS)
        best: _GuideT = guide.with_shaft(prime * math.cos(middle), prime * math.sin(middle))
        worst, places = _violation(CentreShape(motion, best), angles, radius)
        if worst <= 0.0 and half < _FINE:
            return best
        # the worst shaft angles join the samples, and directions spread as wide as the excess demands
        samples = np.hstack([samples, motion.derivatives(places, 3, 1), motion.derivatives(places, 3, -1)])
        half = max(half, _NARROWER * math.sqrt(max(worst, 0.0)))
        directions = middle + half * np.linspace(-1.0, 1.0, _DIRECTIONS)
    raise IntentError("the least cam within both limits was not found", "sizing")


def _samples(motion: Displacement) -> Array:
    """Displacement with three derivatives (4, m) at sample angles; at the ends of stretches the limits from inside."""
    over = stretches(motion)[: max(1, len(motion.breaks) // motion.repeats)]
    low, _ = subdivide(over[:, 0], over[:, 1], max(6, math.ceil(_ANGLES / len(over))))
    return np.concatenate([motion.derivatives(low, 3, 1), motion.derivatives(over[:, 1], 3, -1)], axis=1)


def _first_size(limits: _Limits, directions: Array, sizes: Iterable[float]) -> float:
    """First of `sizes`, prime circles in mm, that keeps the limits in some direction; IntentError where none does."""
    for size in sizes:
        if limits(directions, size).any():
            return size
    raise IntentError(
        "no cam was found that keeps the pressure angles and the radius of curvature together; wider limits, a smaller "
        "stroke or a longer rise and return do",
        "sizing",
    )


def _best_direction(limits: _Limits, directions: Array, high: float, low: float, start: float) -> tuple[float, float]:
    """Direction, rad, of the least prime circle up to `high` that keeps the limits, and that circle's radius, mm.

    Below `low`, mm, no circle is expected to keep them; where one does, the search goes down to `start`, mm.
    """
    directions = directions[limits(directions, high)]
    if limits(directions, low).any():
        low = start
    # halving of the circles that break and that keep the limits, in all directions together
    below, above = np.full((2, len(directions)), [[low], [high]])
    above[limits(directions, below)] = low
    while ((above - below) > _PRECISE * high).any():
        between = 0.5 * (below + above)
        good = limits(directions, between)
        below, above = np.where(good, below, between), np.where(good, between, above)
    best = int(np.argmin(above))
    return float(directions[best]), float(above[best])


def _violation(pitch: CentreShape, angles: tuple[float, float], radius: float) -> tuple[float, Array]:
    """Greatest excess over a limit, rad or share of the radius, and the worst shaft angles (3,) of the limits, rad."""
    over = stretches(pitch.law)
    rise, fall = greatest(pitch.slope, over), least(pitch.slope, over)
    least_bend, place = least_radius(Curve.whole(pitch))
    broken = (math.atan(rise.value) - angles[0], -math.atan(fall.value) - angles[1], 1.0 - least_bend / radius)
    return max(broken), np.array([rise.at, fall.at, place])


def least_face(face: Face, radius: float) -> float:
    """Least base radius, mm, at which no radius of curvature of the cam of a face on a stem is below `radius`, mm.

    All radii of curvature grow as the base radius does. The result is 0 or less where any base radius keeps `radius`.
    """
    return face.base + radius - least_radius(Curve.whole(face_shape(face)))[0]


def least_swing(motion: Displacement, pivot: float, nearer: float, side: int, radius: float) -> SwingingFace:
    """Face on an arm at the least base radius at which no radius of curvature is below `radius`, mm.

    `pivot` is the pivot's distance from the shaft and `nearer` how much nearer the face is to the shaft than its
    parallel through the pivot, mm; `side` is 1 for a trailing arm, -1 for a leading one. Raises IntentError where no
    base radius keeps `radius`, where every one does, and where the face has no angle to swing or swings too fast.
    """
    low, high = math.asin(min(max(nearer / pivot, _TINY), 1.0)), 0.5 * math.pi - motion.range[1]
    if not low < high:
        less, field = ("face", "follower.arm.face") if high > 0.0 else ("swing", "motion")
        raise IntentError(f"no base radius leaves the face room to swing; a smaller {less} does", field)
    SwingingFace(motion, pivot, nearer, 0.5 * high, side)  # raises where the motion is too fast, whatever the size
    # angles at rest that the samples of the motion let pass
    s, v, w, _ = _samples(motion)
    k = 1.0 + side * v
    rests = high * np.arange(_RESTS) / _RESTS
    rests = np.append(low, rests[rests > low])
    psi = rests[:, None] + s
    # radius of the contour of a face through the pivot: p + dq/dt, with k = t' and psi = rest + S
    radii = pivot * (np.sin(psi) * (1.0 - (v / k) ** 2) + np.cos(psi) * w / k**3).min(axis=1)
    enough = radii - nearer >= radius
    if enough[0]:
        raise IntentError("any base radius keeps this radius of curvature; give one", "sizing.radius-of-curvature")

    def excess(angles: Array) -> Array:
        faces = [SwingingFace(motion, pivot, nearer, rest, side) for rest in angles.tolist()]
        return np.array([least_radius(Curve.whole(face_shape(face)))[0] for face in faces]) - radius

    # the first angle at which exact radii keep the limit too is refined between it and the angle before
    for i in np.flatnonzero(enough):
        ends = rests[i - 1 : i], rests[i : i + 1]
        values = excess(ends[0]), excess(ends[1])
        if values[1] >= 0.0:
            rest = roots(excess, *ends, values, _PRECISE)[0]
            return SwingingFace(motion, pivot, nearer, float(rest), side)
    less = radii.max() - radius - _LOOSE * pivot
    raise IntentError(
        f"no base radius keeps it with this pivot and face; a face below {less:.5g} mm does",
        "sizing.radius-of-curvature",
    )


def least_prime(
    shape: Callable[[float], Shape], radius: float, start: float, bend: Callable[[Curve], float] | None = None
) -> float:
    """Least prime circle, mm, from `start` on, at which the pitch curve's least convex radius is `radius`, mm.

    It is `start` itself where the radius there is not less. `shape` makes the pitch curve of a prime circle; `bend`
    measures another radius of that curve, mm, in place of the least convex one. Raises IntentError where no prime
    circle up to a billion times `start` keeps `radius`, or `shape` makes no curve for one.
    """

    def short(prime: Array) -> Array:
        curves = [Curve.whole(shape(float(p))) for p in prime]
        # a stretch that is no longer hollow has an infinite radius, which no root finder takes
        radii = [least_radius(curve)[0] if bend is None else min(bend(curve), 2.0 * radius) for curve in curves]
        return np.array(radii) - radius

    # a bracket by doubling, then its root
    low = np.array([start])
    if short(low)[0] >= 0.0:
        return start
    high = 2.0 * low
    for _ in range(_DOUBLINGS):
        if short(high)[0] >= 0.0:
            break
        low, high = high, 2.0 * high
    else:
        raise IntentError(f"no prime circle up to {high[0]:.6g} mm gives a radius of {radius:.6g} mm", "sizing")
    return float(roots(short, low, high, (short(low), short(high)), _PRECISE)[0])
