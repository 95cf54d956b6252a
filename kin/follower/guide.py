"""How a roller's centre is guided: on an arm that swings about a pivot, or along a straight line of travel.

The frame runs round the cam by the shaft angle phi. A point of the plane, at distance r from the shaft, is reached by
the centre at exactly one position and one shaft angle: position(r), and phi = (polar angle of the point) - lead(r).
Along a curve of arc length s, with u = r^2, a = P.T and c = P x T of its point P and tangent T,

    position' = 2 a/S,    phi' = (c + 2 a m/S)/u

where S^2 is a polynomial in u and m is linear in u: a guide gives these two for its derivatives (position' has the
opposite sign where the guide counts inwards). An arm of length l, its pivot at distance L from the shaft:
S^2 = 4 L^2 l^2 - (L^2 + l^2 - u)^2, 2 m = -side (u + l^2 - L^2); a line of travel displaced by e:
S^2 = 4 (u - e^2), m = e.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from kin.contour.arcs import Arcs, cross, dot, left, right, unit
from kin.law.contacts import METRE, TRAILING, Oscillating
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.law import contacts
    from kin.law.contacts import Side, Unit
    from kin.numeric.arrays import Array

SLACK = 1e-12  # of the guide's size, by which neighbouring pieces may overlap, against rounding at their joints
MOST_SHARE = 0.1  # of the arm, or of the cam: pieces that are searched for contact are shorter


@dataclass(frozen=True)
class Arm:
    """A roller's arm: `length` l, `pivot` its distance L from the shaft, mm; `side` 1 trailing, -1 leading.

    The position is the arm's lean, the angle at the pivot between shaft and roller centre, rad; in a ring, where the
    way `away` from the metal is inwards (-1), it is minus the lean.
    """

    length: float
    pivot: float
    side: Side = TRAILING
    away: Side = 1

    @property
    def unit(self) -> Unit:
        """Unit of the position as reported: degrees."""
        return "deg"

    @property
    def si(self) -> float:
        """SI units in one unit of the position: 1, as it is in radians."""
        return 1.0

    @property
    def lever(self) -> float:
        """The arm's length, mm."""
        return self.length

    def slack(self, extent: float = 0.0) -> float:  # noqa: ARG002 - an arm knows its own size
        """Greatest length, mm, that rounding may feign, whatever the cam's extent."""
        return SLACK * (self.length + self.pivot)

    def step(self, extent: float) -> float:  # noqa: ARG002 - the protocol's
        """Greatest length, mm, of the pieces in which a cam is searched, whatever its extent."""
        return MOST_SHARE * self.length

    def reach(self) -> tuple[float, float]:
        """Least and greatest distance of the roller's centre from the shaft, mm."""
        return abs(self.pivot - self.length), self.pivot + self.length

    def shaft_angle(self, points: Array) -> Array:
        """Shaft angles (n,), rad, at which the arm's end reaches points (n, 2), mm; nan out of reach."""
        r = np.hypot(points[:, 0], points[:, 1])
        with np.errstate(invalid="ignore", divide="ignore"):
            lead = np.arccos((r * r + (self.pivot - self.length) * (self.pivot + self.length)) / (2.0 * r * self.pivot))
        angle: Array = np.arctan2(points[:, 1], points[:, 0]) + self.side * lead
        return angle

    def lead(self, r: Array) -> Array:
        """Polar angle, rad (n,), of the roller's centre less the shaft angle, at its distance r (n,), mm.

        A distance beyond the arm's reach counts as the nearer end of the reach.
        """
        with np.errstate(invalid="ignore", divide="ignore"):
            w = (r * r + (self.pivot**2 - self.length**2)) / (2.0 * r * self.pivot)
        lead: Array = -self.side * np.arccos(np.clip(w, -1.0, 1.0))
        return lead

    def lead_slope(self, least: Array, most: Array) -> Array:
        """Upper bound of the magnitude of the lead's slope over r, rad/mm (n,), from `least` to `most` (n,), mm.

        Infinite at and beyond the ends of the reach.
        """
        # w = cos(phi - t) = (r^2 + L^2 - l^2)/(2 r L); its slope is steepest at an end, and sqrt(1 - w^2) least at one
        excess = self.pivot**2 - self.length**2

        def w(x: Array) -> Array:
            return (x * x + excess) / (2.0 * x * self.pivot)

        turning = self.turning
        sine = np.sqrt(np.maximum(1.0 - np.maximum(np.abs(w(least)), np.abs(w(most))) ** 2, 0.0))
        slope = np.maximum(np.abs(1.0 - excess / least**2), np.abs(1.0 - excess / most**2)) / (2.0 * self.pivot)
        slope = np.where((least < turning) & (turning < most), np.maximum(slope, 1.0 / (2.0 * self.pivot)), slope)
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            steepest: Array = slope / sine
        return steepest

    @property
    def turning(self) -> float:
        """Distance of the centre from the shaft, mm, at which the lead turns: on either side of it it is monotone."""
        return float(np.sqrt(max(self.pivot**2 - self.length**2, 0.0)))

    def position(self, r: Array) -> Array:
        """Angle at the pivot between shaft and roller centre, rad (n,), at its distance r (n,), mm, from the shaft.

        It is negative where `away` is -1. A distance beyond the arm's reach counts as the nearer end of the reach.
        """
        # the half-angle form keeps its digits at either end of the reach
        above = (r - (self.pivot - self.length)) * (r + (self.pivot - self.length))
        below = ((self.pivot + self.length) - r) * ((self.pivot + self.length) + r)
        angle: Array = 2.0 * np.arctan2(np.sqrt(np.maximum(above, 0.0)), np.sqrt(np.maximum(below, 0.0)))
        return self.away * angle

    def centre(self, phi: Array, position: Array) -> Array:
        """Roller centre (n, 2), mm, at shaft angles phi and positions (n,), rad."""
        return self.pivot * unit(phi) - self.length * unit(phi - self._turn * position)

    def path(self, phi: Array, position: Array) -> tuple[Array, Array, Array]:
        """Centre, mm, and two derivatives by a parameter, (n, 2) each, from rows (3, n) of phi and of the position."""
        pivot, arm = polar_rows(phi, self.pivot), polar_rows(phi - self._turn * position, -self.length)
        first, second, third = (p + a for p, a in zip(pivot, arm, strict=True))
        return first, second, third

    def along(self, phi: Array, position: Array) -> tuple[Array, Array]:
        """First and second derivative of the centre by its position, (n, 2) each, at phi and positions (n,), rad."""
        arm = -self.length * unit(phi - self._turn * position)
        return -self._turn * left(arm), -arm

    @property
    def _turn(self) -> int:
        """Sense in which the arm turns as its position grows: 1 clockwise, -1 counter-clockwise."""
        return -self.side * self.away

    def rates(self, phi: Array, centre: Array, tangent: Array, curvature: Array) -> tuple[Array, Array]:
        """First and second derivative of the position by phi (n,), rad, with the roller's centre (n, 2) on pieces.

        The pieces have tangents (n, 2) and curvatures (n,), 1/mm, there. With X on a piece of curvature k and tangent
        t, X' = w t and X'' = w' t + w^2 k left(t). As the distance from X to the pivot P stays l, w and w' follow from
        (X - P)^2 = l^2, and the position's derivatives from (X - P)' and (X - P)''.
        """
        pivot = self.pivot * unit(phi)
        pivot_rate, pivot_bend = left(pivot), -pivot
        d = centre - pivot
        along = dot(d, tangent)
        w = dot(d, pivot_rate) / along
        rate = w[:, None] * tangent - pivot_rate
        hollow = (w**2 * curvature)[:, None] * left(tangent) - pivot_bend
        bend = hollow - ((dot(d, hollow) + dot(rate, rate)) / along)[:, None] * tangent
        square = self.length**2
        return self._turn * (1.0 - cross(d, rate) / square), -self._turn * cross(d, bend) / square

    def crossings(self, pieces: Arcs, phi: Array, slack: float) -> Array:
        """Both places (2, n, 2), mm from the pieces' starts, where the arm's circle at phi (n,) meets theirs; else nan.

        From the start of a piece, m its outward normal and q the pivot, the piece's circle is 2 y.m + k y^2 = 0 and the
        arm's |y - q| = l; both intersections lie on the line y.(m + k q) = k (q^2 - l^2)/2, also for k = 0. Their
        places on that line come from the smaller circle: by the larger one they would be differences of large numbers.
        Circles that miss by `slack`, mm, or less touch.
        """
        q = self.pivot * unit(phi) - pieces.start
        small = np.abs(pieces.curvature) * self.length > 1.0
        y = np.empty((2, len(phi), 2))
        for rows, crossings in ((np.flatnonzero(~small), _on_arm), (np.flatnonzero(small), _on_piece)):
            if len(rows):
                y[:, rows] = crossings(pieces.take(rows), q[rows], self.length, slack)
        return y

    def on_side(self, phi: Array, points: Array, slack: float) -> NDArray[np.bool_]:
        """Mask (n,) of points (n, 2) on the roller's side of the line from shaft to pivot or `slack`, mm, beyond."""
        on_side: NDArray[np.bool_] = -self.side * cross(self.pivot * unit(phi), points) >= -slack * self.pivot
        return on_side

    def square(self, u: Array) -> Array:
        """S^2 = (2 L l sin(lean))^2, mm^4 (n,), at u = r^2, mm^2 (n,)."""
        square: Array = (u - (self.pivot - self.length) ** 2) * ((self.pivot + self.length) ** 2 - u)
        return square

    def square_slope(self, u: Array) -> Array:
        """Derivative of S^2 by u, mm^2 (n,), at u = r^2, mm^2 (n,)."""
        return 2.0 * (self.pivot**2 + self.length**2 - u)

    @property
    def square_bend(self) -> float:
        """Second derivative of S^2 by u, a constant: -2."""
        return -2.0

    def moment(self, u: Array) -> Array:
        """The m of phi' = (c + 2 a m/S)/u, mm^2 (n,), at u = r^2, mm^2 (n,): -side (u + l^2 - L^2)/2."""
        return -0.5 * self.side * (u + (self.length - self.pivot) * (self.length + self.pivot))

    @property
    def moment_slope(self) -> float:
        """Derivative of m by u, a constant: -side/2."""
        return -0.5 * self.side


@dataclass(frozen=True)
class Line:
    """A line of travel at the shaft angle, displaced by `offset` e, mm, towards its left.

    The position is the centre's distance along it from the foot of the shaft, mm; in a ring, where the way `away` from
    the metal is inwards (-1), it is minus that distance.
    """

    offset: float = 0.0
    away: Side = 1

    @property
    def unit(self) -> Unit:
        """Unit of the position as reported: millimetres."""
        return "mm"

    @property
    def si(self) -> float:
        """SI units in one unit of the position: metres in a millimetre."""
        return METRE

    @property
    def lever(self) -> float:
        """Infinite: a line of travel has no arm."""
        return float("inf")

    def slack(self, extent: float) -> float:
        """Greatest length, mm, that rounding may feign on a cam of that extent, mm."""
        return SLACK * (extent + abs(self.offset))

    def step(self, extent: float) -> float:
        """Greatest length, mm, of the pieces in which a cam of an extent, mm, is searched."""
        return MOST_SHARE * extent

    def reach(self) -> tuple[float, float]:
        """Least and greatest distance of the centre from the shaft, mm."""
        return abs(self.offset), float("inf")

    def shaft_angle(self, points: Array) -> Array:
        """Shaft angles (n,), rad, at which the centre reaches points (n, 2), mm; nan out of reach."""
        r = np.hypot(points[:, 0], points[:, 1])
        with np.errstate(invalid="ignore"):
            along = np.sqrt((r - self.offset) * (r + self.offset))
        angle: Array = np.arctan2(points[:, 1], points[:, 0]) - np.arctan2(self.offset, along)
        return angle

    def lead(self, r: Array) -> Array:
        """Polar angle, rad (n,), of the roller's centre less the shaft angle, at a distance r (n,), mm."""
        lead: Array = np.arctan2(self.offset, self.away * self.position(r))
        return lead

    def lead_slope(self, least: Array, most: Array) -> Array:  # noqa: ARG002 - steepest where it is nearest
        """Greatest magnitude of the lead's slope over r, rad/mm (n,), from the distance `least` (n,), mm, on.

        Infinite where `least` is no more than the magnitude of `offset`.
        """
        e = abs(self.offset)
        with np.errstate(divide="ignore", invalid="ignore"):
            steepest: Array = np.where(least > e, e / (least * np.sqrt(least**2 - e**2)), np.inf)
        return steepest

    @property
    def turning(self) -> float:
        """Zero, mm: the lead goes one way at all distances; it falls if `offset` is above 0, rises if it is below."""
        return 0.0

    def position(self, r: Array) -> Array:
        """Position (n,), mm, along the line of travel, at the centre's distance r (n,), mm, from the shaft.

        A distance below the offset counts as the offset.
        """
        along: Array = np.sqrt(np.maximum((r - self.offset) * (r + self.offset), 0.0))
        return self.away * along

    def centre(self, phi: Array, position: Array) -> Array:
        """Roller centre (n, 2), mm, at shaft angles phi (n,), rad, and positions (n,), mm."""
        u = unit(phi)
        return self.away * position[:, None] * u + self.offset * left(u)

    def path(self, phi: Array, position: Array) -> tuple[Array, Array, Array]:
        """Centre, mm, and two derivatives by a parameter, (n, 2) each, from rows (3, n) of phi and of the position."""
        u, du, ddu = polar_rows(phi, 1.0)
        p, dp, ddp = (self.away * row[:, None] for row in position)
        first, second = p * u + self.offset * left(u), dp * u + p * du + self.offset * left(du)
        return first, second, ddp * u + 2.0 * dp * du + p * ddu + self.offset * left(ddu)

    def along(self, phi: Array, position: Array) -> tuple[Array, Array]:
        """First and second derivative of the centre by its position, (n, 2) each, at phi (n,), rad: the second is 0."""
        u = unit(phi)
        return self.away * u + 0.0 * position[:, None], np.zeros_like(u)

    def rates(self, phi: Array, centre: Array, tangent: Array, curvature: Array) -> tuple[Array, Array]:
        """First and second derivative, mm, of the position by phi (n,), rad, with the centre (n, 2) on pieces.

        The pieces have tangents (n, 2) and curvatures (n,), 1/mm, there. Along the line of travel d the centre X has
        X' = p' d + left(X) and X'' = p'' d + 2 p' left(d) - X. Across a piece of tangent t and curvature k these have
        the parts 0 and (X'.t)^2 k.
        """
        d, across = unit(phi), left(tangent)
        reach = dot(d, across)
        turning = left(centre)
        first = -dot(turning, across) / reach
        along = dot(first[:, None] * d + turning, tangent)
        bend = 2.0 * first[:, None] * left(d) - centre
        return self.away * first, self.away * (along**2 * curvature - dot(bend, across)) / reach

    def crossings(self, pieces: Arcs, phi: Array, slack: float) -> Array:
        """Both places (2, n, 2), mm from the pieces' starts, where the line of travel at phi (n,) meets their circles.

        With y = q + x d on the line, q its foot, m the piece's outward normal at its start, the circle 2 y.m + k y^2 =
        0 is k x^2 + 2 x (d.m + k q.d) + (2 q.m + k q^2) = 0, also for k = 0. Where they do not meet it is nan; a circle
        missed by `slack`, mm, or less is touched.
        """
        d, m, k = unit(phi), right(pieces.tangent), pieces.curvature
        q = self.offset * left(d) - pieces.start
        half, last = dot(d, m) + k * dot(q, d), 2.0 * dot(q, m) + k * dot(q, q)
        square = half * half - k * last
        touching = (square < 0.0) & (square >= -2.0 * slack * np.abs(k))
        with np.errstate(divide="ignore", invalid="ignore"):
            big = -(half + np.copysign(np.sqrt(np.where(touching, 0.0, square)), half))
            x = np.stack([big / k, last / big])
        x[~np.isfinite(x)] = np.nan
        return q + x[:, :, None] * d

    def on_side(self, phi: Array, points: Array, slack: float) -> NDArray[np.bool_]:
        """Mask (n,) of points (n, 2) beyond the foot of the shaft along the travel, or `slack`, mm, short of it."""
        on_side: NDArray[np.bool_] = dot(unit(phi), points) >= -slack
        return on_side

    def square(self, u: Array) -> Array:
        """S^2 = (2 position)^2, mm^2 (n,), at u = r^2, mm^2 (n,)."""
        return 4.0 * (u - self.offset**2)

    def square_slope(self, u: Array) -> Array:
        """Derivative of S^2 by u (n,): 4."""
        return np.full_like(u, 4.0)

    @property
    def square_bend(self) -> float:
        """Second derivative of S^2 by u: 0."""
        return 0.0

    def moment(self, u: Array) -> Array:
        """The m of phi' = (c + 2 a m/S)/u, mm (n,), at u = r^2, mm^2 (n,): the offset e."""
        return np.full_like(u, self.offset)

    @property
    def moment_slope(self) -> float:
        """Derivative of m by u: 0."""
        return 0.0


def led(guide: contacts.Guide, away: Side = 1) -> Arm | Line:
    """Formulas of a round touch's guide whose position grows outwards, or inwards where the metal lies outside (-1).

    Raises ValueError for an arm without a length.
    """
    if isinstance(guide, Oscillating):
        return Arm(guide.arm, guide.pivot, guide.side, away)
    return Line(guide.offset, away)


Guide: TypeAlias = Arm | Line
"""How a roller's centre moves; `unit` is its position's as reported, radians being reported as degrees."""


def polar_rows(angle: Array, length: float) -> tuple[Array, Array, Array]:
    """Vectors length u(angle) and two derivatives, each (n, 2), from an angle, rad, and its derivatives, (3, n)."""
    u = length * unit(angle[0])
    n = left(u)
    return u, angle[1][:, None] * n, angle[2][:, None] * n - (angle[1] ** 2)[:, None] * u


def _on_arm(pieces: Arcs, q: Array, length: float, slack: float) -> Array:
    """Both crossings (2, n, 2), from the pieces' starts, nan without any; their places come from the arm's circle.

    `q` (n, 2) is the pivot from there, `length` the arm, mm: `Arm.crossings` has the formulas.
    """
    m, k = right(pieces.tangent), pieces.curvature
    v = m + k[:, None] * q
    size = np.hypot(v[:, 0], v[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        across = v / size[:, None]
        depth = -(dot(q, m) + 0.5 * k * (dot(q, q) + length**2)) / size
        square = (length - depth) * (length + depth)
        touching = (square < 0.0) & (square >= -slack * length)
        half = np.sqrt(np.where(touching, 0.0, square))
    middle, aside = q + depth[:, None] * across, half[:, None] * left(across)
    return np.stack([middle + aside, middle - aside])


def _on_piece(pieces: Arcs, q: Array, length: float, slack: float) -> Array:
    """Both crossings (2, n, 2), from the pieces' starts, nan without any; their places come from the piece's circle.

    `q` (n, 2) is the pivot from there, `length` the arm, mm: `Arm.crossings` has the formulas.
    """
    m, k = right(pieces.tangent), pieces.curvature
    v = m + k[:, None] * q
    size, away = np.hypot(v[:, 0], v[:, 1]), np.hypot(q[:, 0], q[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        across = v / size[:, None]
        foot = 0.5 * k * (away - length) * (away + length) / size
        cosine = dot(across, m) + k * foot
        square = (1.0 - cosine) * (1.0 + cosine)
        touching = (square < 0.0) & (square >= -2.0 * slack * np.abs(k))
        half = np.sqrt(np.where(touching, 0.0, square)) / k
    aside = left(across)
    middle = foot[:, None] * across - (dot(aside, m) / k)[:, None] * aside
    return np.stack([middle + half[:, None] * aside, middle - half[:, None] * aside])
