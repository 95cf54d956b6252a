"""A flat face's intended distance from the shaft over the shaft angle: the support function of its cam.

theta is the direction of the face's outward normal in the cam frame (Aygahoglu and Saka 2023, AS, eqs. 1-6; Wunderlich
1971), so a lift is a support function p(theta), mm over rad, of period 2 pi, and the radius of curvature is rho = p +
p''. Any lift here has p and p' continuous all round; p'' may jump, at declared breaks only. rho need not be positive.
SW is K.-L. Shu and L.-I. Wu, Synthesis of constant-breadth cam mechanisms, 2012. Every `pivot` is the shaft's (x, y),
mm.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import accumulate
from typing import TYPE_CHECKING

import numpy as np

from kin.law.normalised import IntentError, first_harmonic
from kin.law.piecewise import Piecewise, Side
from kin.law.segment import AffineStretch, Constant, Harmonic, Harmonics, Series, Stretch
from kin.numeric.elementary import BallJet, cos, sin
from kin.numeric.interval import Ball
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array


_TURN = 2 * math.pi
# A jump in p or p' below this, relative to the largest of p, p', p'', is the rounding of a formula.
_JOIN = 1e-11
_SAME_CIRCLE = 16 * 2.0**-52  # of the greatest number of a circle: rounding


@dataclass(frozen=True)
class Circle(Harmonic):
    """p of a circular arc, mm: radius + x cos t + y sin t, the centre (x, y) seen from the shaft; rho is the radius."""

    radius: float
    x: float = 0.0
    y: float = 0.0

    @property
    def first_harmonic(self) -> tuple[float, float, float]:
        """Radius and centre x, y, mm."""
        return self.radius, self.x, self.y

    def __call__(self, t: Series, /) -> Series:
        """Support function, mm, a series of t's own kind."""
        total = t.constant(self.radius)
        if self.x:
            total = total + cos(t) * self.x
        return total + sin(t) * self.y if self.y else total

    def matches(self, other: Circle) -> bool:
        """Whether two circles are the same but for rounding."""
        size = max(abs(self.radius), abs(self.x), abs(self.y))
        apart = max(abs(self.radius - other.radius), abs(self.x - other.x), abs(self.y - other.y))
        return apart <= _SAME_CIRCLE * size


@dataclass(frozen=True)
class _Moved:
    """p about the shaft at (x, y): scale p - x cos t - y sin t + offset (closed form of AS eq. 10)."""

    function: Stretch
    scale: float
    x: float
    y: float
    offset: float = 0.0

    def __call__(self, t: Series, /) -> Series:
        """Give the support function about the new shaft."""
        total = self.function(t)
        if self.scale != 1:
            total = total * self.scale
        if self.x:
            total = total - cos(t) * self.x
        if self.y:
            total = total - sin(t) * self.y
        return total + self.offset if self.offset else total


@dataclass(frozen=True, eq=False)
class Lift:
    """p(theta) in mm, period 2 pi. Reports take `datum` off, mm: the base radius of a constant-breadth cam, or 0.

    Stretch i runs from breaks[i] to the next break, the last one over 2 pi; without breaks there is one stretch.
    `law.functions` are the stretches in the order of `law.knots`, which may begin below 0.
    """

    law: Piecewise
    datum: float = 0.0

    @property
    def breaks(self) -> Array:
        """Angles (b,) in [0, 2 pi) at which p'' or a higher derivative may jump, rising."""
        return self.law.breaks

    @cached_property
    def radius(self) -> Array:
        """For each stretch its radius of curvature, mm, if exactly constant, else nan: (b,), (1,) without breaks."""
        ends = self.breaks if len(self.breaks) else self.law.knots[:1]
        index, _ = self.law.locate(ends, 1)
        functions = [self.law.functions[i] for i in index]
        return np.array([_radius(f) for f in functions])

    @property
    def steady(self) -> NDArray[np.bool_]:
        """Mask of the stretches, as `radius`, whose rho is exactly constant: a dwell, a Reuleaux arc, a circle."""
        return ~np.isnan(self.radius)

    def derivatives(self, theta: float | Array, order: int, side: Side = 1) -> Array:
        """Give p, mm, and its derivatives at theta (n,), (order + 1, n); at a break the right-hand limit, or left (-1).

        Raises DomainError where a formula of the lift does not exist.
        """
        return self.law.derivatives(theta, order, side)

    def radius_enclosure(self, lower: float | Array, upper: float | Array, order: int) -> tuple[Array, Array]:
        """Enclose rho = p + p'', mm, and its derivatives over [lower, upper] (n,): mid and rad, (order + 1, n) each.

        The place of the shaft adds nothing to rho; its terms are left out, as enclosures would not cancel them.
        """
        low, high = self._centred.on(BallJet.variable(lower, upper, order + 2)).bounds()
        p = Ball.between(low, high)
        rho = p[:-2] + p[2:]
        return rho.mid, rho.rad

    def radius_on(self, t: Series, side: Side = 1) -> Series:
        """Radius of curvature rho = p + p'', mm, as a jet or ball jet two orders lower than the shaft angle's, `t`."""
        p = self._centred.on(t, side)
        bend = p.derivative().derivative()
        for _ in range(2):
            p = p.lower()
        return p + bend

    def moved(self, out: float, scale: float = 1.0) -> Lift:
        """The lift of the cam's parallel contour `out` mm farther outside, then enlarged `scale` times."""
        law = self.law
        functions = tuple(_farther(f, out, scale) for f in law.functions)
        return Lift(Piecewise(law.knots, functions, law.period, law.smooth_seam), scale * self.datum)

    @property
    def rounding(self) -> float:
        """Greatest error, mm, of p or p' by the rounding of a recipe's own formula; 0 without one."""
        return self.law.rounding

    @cached_property
    def _centred(self) -> Piecewise:
        """The lift less its first harmonic, where that is held as numbers."""
        law = self.law
        return Piecewise(law.knots, tuple(_less_first(f) for f in law.functions), law.period, law.smooth_seam)


def _radius(function: Stretch) -> float:
    if isinstance(function, Circle):
        return function.radius
    return function.value if isinstance(function, Constant) else math.nan


def _less_first(function: Stretch) -> Stretch:
    if isinstance(function, Circle):
        return Circle(function.radius)
    if isinstance(function, Harmonics):
        return Harmonics(function.mean, tuple(term for term in function.terms if term[0] > 1))
    if isinstance(function, _Moved):
        return _Moved(_less_first(function.function), function.scale, 0.0, 0.0, function.offset)
    return function


def _farther(function: Stretch, out: float, scale: float) -> Stretch:
    """Give scale (p + out), of the same kind of stretch where there is one."""
    if isinstance(function, Circle):
        return Circle(scale * (function.radius + out), scale * function.x, scale * function.y)
    if isinstance(function, Harmonics):
        terms = tuple((k, scale * a, scale * b) for k, a, b in function.terms)
        return Harmonics(scale * (function.mean + out), terms)
    return _Moved(function, scale, 0.0, 0.0, scale * out)


def joined(
    knots: Sequence[float], functions: Sequence[Stretch], field: str, *, datum: float = 0.0, smooth_seam: bool = False
) -> Lift:
    """Join stretches round the turn, stretch i between knots i and i + 1, rad: neighbours on one circle become one.

    `datum` is that of the lift, mm; `smooth_seam` tells that the last stretch runs on in the first. Raises IntentError
    at `field` where p or p' jumps.
    """
    knots, functions = list(knots), list(functions)
    i = 1
    while i < len(functions):
        if _one_circle(functions[i - 1], functions[i]):
            del functions[i], knots[i]
        else:
            i += 1
    if len(functions) == 1:
        smooth_seam = smooth_seam or isinstance(functions[0], Circle)
    elif _one_circle(functions[-1], functions[0]):
        del functions[-1], knots[-1]
        knots[0] = knots[-1] - _TURN
        smooth_seam = False
    law = Piecewise(np.array(knots), tuple(functions), _TURN, smooth_seam)
    _demand_joined(law, field)
    return Lift(law, datum)


def _one_circle(first: Stretch, second: Stretch) -> bool:
    return isinstance(first, Circle) and isinstance(second, Circle) and first.matches(second)


def _demand_joined(law: Piecewise, field: str) -> None:
    """Raise IntentError for a jump of p or p' at any knot, the seam included."""
    knots = law.knots[np.argsort(np.mod(law.knots[:-1], _TURN))]
    side = np.repeat([1, -1], knots.size)
    right, left = np.hsplit(law.derivatives(np.tile(knots, 2), 2, side) + 0.0, 2)  # no -0 in a message
    jump = np.abs(right - left)
    # with the shaft on the contour, at a cusp, the values at the knots do not show the size of the cam
    elsewhere = law.derivatives(_TURN * (0.1 + np.arange(8) / 8.0), 1)
    allowed = _JOIN * max(np.abs(right).max(), np.abs(left).max(), np.abs(elsewhere).max())
    for row, what, unit, harm in (
        (0, "p", "mm", "the cam would have a step"),
        (1, "p'", "mm/rad", "the contact would jump along the face, and the contour tear open"),
    ):
        worst = int(np.argmax(jump[row] > 0.999 * jump[row].max()))  # the first of equals
        if jump[row, worst] > allowed:
            at = math.degrees(knots[worst]) % 360
            before, after = f"{left[row, worst]:.9g}", f"{right[row, worst]:.9g}"
            step = f"from {before} to {after}" if before != after else f"by {jump[row, worst]:.3g}"
            raise IntentError(f"{what} jumps {step} {unit} at {at:.6g} degrees: {harm}", field, at)


def about(function: Stretch, pivot: tuple[float, float], scale: float = 1.0) -> Stretch:
    """Give scale times a support function, as seen from the shaft at `pivot`, mm."""
    x, y = pivot
    if isinstance(function, Circle):
        return Circle(function.radius * scale, function.x * scale - x, function.y * scale - y)
    return _Moved(function, scale, x, y) if scale != 1 or x or y else function


def lift_from_fourier(
    mean: float, cos: Mapping[int, float], sin: Mapping[int, float], pivot: tuple[float, float] = (0.0, 0.0)
) -> Lift:
    """Make p = mean + sum of cos[k] cos(k t) + sin[k] sin(k t), mm, about the shaft at `pivot`; all k at least 1.

    Odd harmonics alone give constant breadth 2 mean (Resnikoff, arXiv 1504.06733). Raises IntentError for k below 1.
    """
    for name, series in (("cos", cos), ("sin", sin)):
        for k in series:
            if k < 1:
                raise IntentError(f"harmonics count from 1, not {k} (the constant term is mean)", f"fourier.{name}")
    terms = [(k, float(cos.get(k, 0.0)), float(sin.get(k, 0.0))) for k in sorted({*cos, *sin})]
    terms = [term for term in terms if term[1] or term[2]]
    function: Stretch = Harmonics(float(mean), tuple(terms))
    if all(k == 1 for k, _, _ in terms):
        function = Circle(float(mean), *(terms[0][1:] if terms else ()))
    return joined([0.0, _TURN], [about(function, pivot)], "fourier", smooth_seam=True)


def lift_hypocycloid(cusps: int, size: float, breadth: float, pivot: tuple[float, float] = (0.0, 0.0)) -> Lift:
    """Make p = breadth/2 + size cos(cusps t): the curve parallel to a hypocycloid (Euler; AS section 1).

    `size` is the radius of the hypocycloid's inscribed circle, `breadth` the breadth, mm. Raises IntentError unless
    cusps is odd and at least 3.
    """
    if cusps < 3 or cusps % 2 == 0:
        raise IntentError(f"constant breadth needs an odd number of cusps, 3 or more, not {cusps}", "hypocycloid.cusps")
    function = about(Harmonics(breadth / 2, ((cusps, float(size), 0.0),)), pivot)
    return joined([0.0, _TURN], [function], "hypocycloid", smooth_seam=True)


def lift_reuleaux(
    sides: int,
    breadth: float,
    rounding: float,
    pivot: tuple[float, float] = (0.0, 0.0),
    angles: Sequence[float] = (),
) -> Lift:
    """Make the Reuleaux polygon of n = `sides`, odd, and breadth w, mm, its corners rounded by `rounding`, mm.

    It is the curve at distance `rounding` outside the sharp polygon of breadth w - 2 rounding. Without `angles` that
    polygon is regular, its corners on a circle of radius (w - 2 rounding)/(2 cos(pi/2n)) about the origin, the first on
    the +x axis. `angles`, rad, are those of the first n - 3 corners in the order in which the cam turns about them; the
    last three follow. The origin is Steiner's point then, and the first corner is in contact evenly about +x, as of a
    regular polygon. rho is the rounding over each corner and w - rounding opposite. Raises IntentError for an even
    count or one below 3, a rounding outside 0 to w/2, another number of angles, or angles of no polygon.
    """
    if sides < 3 or sides % 2 == 0:
        raise IntentError(f"a Reuleaux polygon has an odd number of sides, 3 or more, not {sides}", "reuleaux.sides")
    if not 0 <= rounding <= breadth / 2:
        raise IntentError(
            f"the rounding must lie between 0 and half the breadth, {breadth / 2:.6g} mm; it is {rounding:.6g} mm",
            "reuleaux.rounding",
        )
    half, size = math.pi / (2 * sides), breadth - 2 * rounding
    if angles:
        from kin.law.reuleaux import closed_angles, corners

        own = closed_angles(sides, angles)
        centres = [(size * corner.real, size * corner.imag) for corner in corners(own)]
        centres += centres
        knots = list(accumulate((*own, *own[:-1]), initial=-0.5 * own[0]))
    else:
        # normals within `half` of i pi/n: about the corner there, or about the opposite corner
        places = ((2 * i if i % 2 == 0 else 2 * (i + sides)) * half for i in range(2 * sides))
        centres = [_polar(size / (2 * math.cos(half)), place) for place in places]
        knots = [(2 * i - 1) * half for i in range(2 * sides)]
    functions = [
        about(Circle(breadth - rounding if i % 2 else rounding, *centre), pivot) for i, centre in enumerate(centres)
    ]
    return joined([*knots, knots[0] + _TURN], functions, "reuleaux")


def _polar(radius: float, angle: float) -> tuple[float, float]:
    return radius * math.cos(angle), radius * math.sin(angle)


def lift_constant_breadth(base_radius: float, programme: Motion, field: str = "motion") -> Lift:
    """Make the constant-breadth cam of a motion S, mm, over the half turn (SW eqs. 1-6); `base_radius` is r_b, mm.

    p = r_b + S on [0, pi] and p(t + pi) = d - p(t), with breadth d = 2 r_b + h. Closing needs S(pi) = h whatever h is:
    h is the displacement at the end of the programme, not its maximum. So a programme that comes back to 0 has h = 0,
    breadth 2 r_b and S(t + pi) = -S(t): r_b is then the mean radius, and the lift falls as far below 0 in the second
    half turn as it rose in the first. One that ends below 0 is the same cam begun half a turn later.

    The velocities must meet too, S'(pi) = -S'(0) and none jumping inside, or the contour tears. S'' may jump; such an
    angle is a break. Raises IntentError, at `field`, where they do not meet and for a breadth not above 0, IntentError
    for a base radius not above 0, and ValueError unless the programme covers pi.
    """
    if programme.total != math.pi:
        raise ValueError(f"the programme covers {programme.total!r} rad, not the half turn")
    if not (math.isfinite(base_radius) and base_radius > 0):
        raise IntentError(f"the base radius must be above 0, not {base_radius:.6g} mm", "base_radius")
    start, end = programme.at_start(2), programme.at_end(2)
    stroke = float(end[0])
    breadth = 2 * base_radius + stroke
    if breadth <= 0:
        raise IntentError(f"the motion ends at {stroke:.6g} mm: no breadth is left beside 2 r_b", field)
    size = base_radius + float(np.abs(programme.motion.derivatives(programme.motion.knots, 2)).max())
    if abs(end[1] + start[1]) > _JOIN * size:
        raise IntentError(
            f"the motion does not join over the half turn: S' is {start[1]:.9g} mm/rad at 0 degrees, so it must be "
            f"{-start[1]:.9g} at 180, where it is {end[1]:.9g}; "
            f"the contour would tear open by {abs(end[1] + start[1]):.6g} mm",
            field,
            180.0,
        )
    # the motion above the base circle, then taken off the breadth half a turn later
    halves: list[Stretch] = []
    for offset, sense, begin in ((base_radius, 1.0, 0.0), (breadth - base_radius, -1.0, math.pi)):
        halves += [_raised(f, offset, sense, begin) for f in programme.motion.functions]
    first = programme.motion.knots
    knots = [*first[:-1], *(first + math.pi)]
    return joined(knots, halves, field, datum=base_radius)


def _raised(function: Stretch, offset: float, sense: float, start: float) -> Stretch:
    """Give offset + sense S(t - start): a dwell as a circle about the shaft, a harmonic half turn as an eccentric."""
    if isinstance(function, Constant):
        return Circle(offset + sense * function.value)
    raised = AffineStretch.of(function, offset=offset, scale=sense, start=start)
    harmonic = first_harmonic(raised)
    return Circle(*harmonic) if harmonic is not None else raised
