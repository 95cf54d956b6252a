"""The forms in which a fitted contour is written: polygon, arcs and B-spline.

Each is a closed contour in millimetres, counter-clockwise about its inside, with the shaft at the origin. The closing
piece, from the last point to the first, is understood for polygons and arcs; the B-spline ends where it starts. Each
carries the bound that its fit has proved.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import ArcChain
from camgeo.fit.bound import Bound
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.fit.bound import Box
    from kin.numeric.arrays import Array

__all__ = ["ArcSpline", "BSpline", "Bound", "Outline", "Polygon"]


@dataclass(frozen=True, eq=False)
class Polygon:
    """A closed polygon: vertices (n, 2), n >= 3, no vertex repeated at the end.

    Raises ValueError where the shape is wrong, a coordinate is not finite, or an edge has no length.
    """

    vertices: Array
    bound: Bound

    def __post_init__(self) -> None:
        _points("polygon: vertices", self.vertices, least=3)
        _distinct("polygon: vertices", self.vertices)

    @property
    def count(self) -> int:
        """Number of edges."""
        return len(self.vertices)

    @property
    def area(self) -> float:
        """Enclosed area in mm^2, positive for a counter-clockwise polygon."""
        return _polygon_area(self.vertices)

    def mirrored(self) -> Polygon:
        """The mirror image in the x axis, again counter-clockwise, from the same first vertex."""
        return Polygon(_mirrored_loop(self.vertices), self.bound)

    def turned(self, angle: float) -> Polygon:
        """The outline turned counter-clockwise about the origin by an angle, rad."""
        return Polygon(_turned_loop(self.vertices, angle), self.bound)

    def scaled(self, k: float) -> Polygon:
        """The outline k times as large, as for a change of unit; raises ValueError unless k > 0."""
        return Polygon(self.vertices * _positive(k), self.bound.scaled(k))

    def box(self) -> Box:
        """Least and greatest coordinates (x_min, y_min, x_max, y_max), mm."""
        return _box(self.vertices)


@dataclass(frozen=True, eq=False)
class ArcSpline(ArcChain):
    """A closed chain of arcs and lines, two at least: points (n, 2), bulges (n,) of the pieces that follow them.

    Raises ValueError where a shape is wrong, a number is not finite, or a piece has no length.
    """

    bound: Bound

    def __post_init__(self) -> None:
        _points("arcs: points", self.points, least=2)
        _distinct("arcs: points", self.points)
        _numbers("arcs: bulges", self.bulges, (len(self.points),))

    @property
    def count(self) -> int:
        """Number of arcs and lines."""
        return len(self.points)

    @property
    def area(self) -> float:
        """Enclosed area in mm^2: the chords' polygon, and the segments between arcs and chords."""
        chord = self.chords
        half = 2.0 * np.arctan(self.bulges)  # half the angle turned through
        segment = np.einsum("ij,ij->i", chord, chord) * _segment_ratio(half)
        return _polygon_area(self.points) + float(segment.sum())

    def mirrored(self) -> ArcSpline:
        """The mirror image in the x axis, again counter-clockwise, from the same first point.

        Mirroring turns the sign of every bulge and so does running backwards: bulges keep their signs.
        """
        return ArcSpline(_mirrored_loop(self.points), self.bulges[::-1].copy(), self.bound)

    def turned(self, angle: float) -> ArcSpline:
        """The outline turned counter-clockwise about the origin by an angle, rad."""
        return ArcSpline(_turned_loop(self.points, angle), self.bulges, self.bound)

    def scaled(self, k: float) -> ArcSpline:
        """The chain k times as large, as for a change of unit, with the same bulges; raises ValueError unless k > 0."""
        return ArcSpline(self.points * _positive(k), self.bulges, self.bound.scaled(k))

    def box(self) -> Box:
        """Exact extremes (x_min, y_min, x_max, y_max) of the arcs themselves, mm.

        An arc reaches beyond its ends along an axis direction d only if d lies within its normals. The excess is
        written with the sagitta, so that a nearly straight arc loses nothing to its distant centre.
        """
        curved = self.bulges != 0.0
        start, bulge, chord = self.points[curved], self.bulges[curved], self.chords[curved]
        end = np.roll(self.points, -1, axis=0)[curved]
        length = np.hypot(chord[:, 0], chord[:, 1])
        lowest, highest = self.points.min(axis=0), self.points.max(axis=0)
        # outward normal at the middle of the arc: to the right of the chord for a counter-clockwise arc
        normal = np.sign(bulge)[:, None] * np.column_stack((chord[:, 1], -chord[:, 0])) / length[:, None]
        b = np.abs(bulge)
        for axis in (0, 1):
            middle = 0.5 * (start[:, axis] + end[:, axis])
            for sense in (1.0, -1.0):
                cosine = sense * normal[:, axis]
                sine = normal[:, 1 - axis]
                versine = np.where(cosine > 0.0, sine * sine / (1.0 + np.abs(cosine)), 1.0 - cosine)
                within = versine <= 2.0 * b * b / (1.0 + b * b)
                # value along d = middle + radius (1 - cos(half) cos(delta)), delta between d and the middle normal
                bulge_in, beyond = b[within], versine[within]
                reach = 0.5 * length[within] * (bulge_in + (1.0 - bulge_in * bulge_in) * (0.5 * beyond / bulge_in))
                extreme = middle[within] + sense * reach
                if extreme.size and sense > 0.0:
                    highest[axis] = max(highest[axis], extreme.max())
                elif extreme.size:
                    lowest[axis] = min(lowest[axis], extreme.min())
        return float(lowest[0]), float(lowest[1]), float(highest[0]), float(highest[1])


@dataclass(frozen=True, eq=False)
class BSpline:
    """A closed, non-rational B-spline: control points (m, 2), knots (m + degree + 1,), never falling.

    `spans` is the number of knot intervals that are not empty. The curve runs over knots[degree] .. knots[m] and ends
    exactly where it starts: either clamped, its first and last control points the same, or periodic, its last `degree`
    control points the first ones again. Raises ValueError for anything else.
    """

    degree: int
    control: Array
    knots: Array
    spans: int
    bound: Bound

    def __post_init__(self) -> None:
        if self.degree < 1:
            raise ValueError(f"spline: degree must be >= 1, not {self.degree}")
        _points("spline: control", self.control, least=self.degree + 1)
        _numbers("spline: knots", self.knots, (len(self.control) + self.degree + 1,))
        if not bool(np.all(np.diff(self.knots) >= 0.0)):
            raise ValueError("spline: knots must not fall")
        spans = len(self._span_indices())
        if self.spans != spans:
            raise ValueError(f"spline: spans is {self.spans}, but the knots make {spans}")
        if not (self.clamped or self.periodic):
            raise ValueError("spline: does not close, neither clamped on one point nor periodic")

    @property
    def count(self) -> int:
        """Number of polynomial spans."""
        return self.spans

    @property
    def clamped(self) -> bool:
        """True where the curve starts and ends in its first control point."""
        p = self.degree
        ends = self.knots[0] == self.knots[p] and self.knots[-1] == self.knots[-1 - p]
        return bool(ends and np.array_equal(self.control[0], self.control[-1]))

    @property
    def periodic(self) -> bool:
        """True where the last `degree` control points equal the first ones and the knots repeat with the period."""
        p, knots = self.degree, self.knots
        m = len(self.control)
        if m < 2 * p or not np.array_equal(self.control[:p], self.control[-p:]):
            return False
        period = knots[m] - knots[p]
        around = np.abs(knots[m - p :] - knots[: 2 * p + 1] - period)
        return bool(np.all(around <= 8.0 * np.finfo(float).eps * np.abs(knots).max()))

    @property
    def area(self) -> float:
        """Enclosed area in mm^2: 1/2 of the integral of x y' - y x', which is a sum over the Bezier points."""
        pieces = self.beziers()
        p = self.degree
        # integral of B_i,p B_j,p-1 over [0, 1]
        weight = np.array(
            [
                [math.comb(p, i) * math.comb(p - 1, j) / (math.comb(2 * p - 1, i + j) * 2 * p) for j in range(p)]
                for i in range(p + 1)
            ]
        )
        slope = p * np.diff(pieces, axis=1)
        x, y = np.einsum("kia,ij->kja", pieces, weight).transpose(2, 0, 1)
        return 0.5 * float(np.sum(x * slope[:, :, 1] - y * slope[:, :, 0]))

    def mirrored(self) -> BSpline:
        """The mirror image in the x axis, run backwards so that it is counter-clockwise again."""
        control = self.control[::-1] * np.array([1.0, -1.0])
        knots = (self.knots[0] + self.knots[-1]) - self.knots[::-1]
        return BSpline(self.degree, control, knots, self.spans, self.bound)

    def scaled(self, k: float) -> BSpline:
        """The outline k times as large, as for a change of unit; raises ValueError unless k > 0."""
        return BSpline(self.degree, self.control * _positive(k), self.knots, self.spans, self.bound.scaled(k))

    def beziers(self) -> Array:
        """Bezier control points of each span, mm, (spans, degree + 1, 2).

        They are values of the span's polar form (blossom) at its two ends repeated, found by de Boor's triangle.
        """
        p, knots = self.degree, self.knots
        span = self._span_indices()
        low, high = knots[span], knots[span + 1]
        out = np.empty((len(span), p + 1, 2))
        for k in range(p + 1):
            arguments = [low] * (p - k) + [high] * k
            d = [self.control[span - p + j] for j in range(p + 1)]
            for r in range(1, p + 1):
                u = arguments[r - 1]
                for j in range(p, r - 1, -1):
                    left, right = knots[span - p + j], knots[span + 1 + j - r]
                    a = ((u - left) / (right - left))[:, None]
                    d[j] = (1.0 - a) * d[j - 1] + a * d[j]
            out[:, k] = d[p]
        return out

    def box(self) -> Box:
        """Exact extremes (x_min, y_min, x_max, y_max) of the curve, not of its control polygon, mm."""
        pieces = self.beziers()
        ends = pieces[:, (0, -1)].reshape(-1, 2)
        lowest, highest = ends.min(axis=0), ends.max(axis=0)
        for axis in (0, 1):
            rows = pieces[:, :, axis]
            # only a span whose control points leave the ends' range can reach beyond it
            for row in rows[(rows.min(axis=1) < lowest[axis]) | (rows.max(axis=1) > highest[axis])]:
                low, high = _bezier_range(row)
                lowest[axis], highest[axis] = min(lowest[axis], low), max(highest[axis], high)
        return float(lowest[0]), float(lowest[1]), float(highest[0]), float(highest[1])

    def _span_indices(self) -> NDArray[np.intp]:
        inside = self.knots[self.degree : len(self.control) + 1]
        return np.flatnonzero(np.diff(inside) > 0.0) + self.degree


Outline = Polygon | ArcSpline | BSpline


def _numbers(what: str, array: Array, shape: tuple[int, ...]) -> None:
    if not isinstance(array, np.ndarray) or array.dtype != np.float64 or array.shape != shape:
        kind = f"{array.dtype} {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
        raise ValueError(f"{what} must be float64 of shape {shape}, not {kind}")
    if not bool(np.all(np.isfinite(array))):
        raise ValueError(f"{what} must be finite")


def _points(what: str, array: Array, least: int) -> None:
    n = len(array) if isinstance(array, np.ndarray) and array.ndim > 0 else least
    _numbers(what, array, (max(n, least), 2))


def _distinct(what: str, points: Array) -> None:
    same = np.flatnonzero(np.all(points == np.roll(points, -1, axis=0), axis=1))
    if same.size:
        raise ValueError(f"{what}: piece {same[0]} has no length")


def _positive(k: float) -> float:
    if not (math.isfinite(k) and k > 0.0):
        raise ValueError(f"scale must be finite and > 0, not {k!r}")
    return k


def _mirrored_loop(points: Array) -> Array:
    mirrored: Array = np.roll(points[::-1], 1, axis=0) * np.array([1.0, -1.0])
    return mirrored


def _turned_loop(points: Array, angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    turned: Array = points @ np.array([[c, s], [-s, c]])
    return turned


def _polygon_area(points: Array) -> float:
    # about the first point, so that a contour far from the origin loses no digits
    x, y = (points - points[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _segment_ratio(half: Array) -> Array:
    """Area between arcs and chords over the chords squared (n,), with the arcs' signs; `half` is half their turn."""
    small = np.abs(half) < 0.02
    a = np.where(small, 1.0, half)
    s = half * half
    series = half * (1.0 / 6.0 + s * (1.0 / 45.0 + s * (1.0 / 315.0 + s / 2362.5)))
    ratio: Array = np.where(small, series, (2.0 * a - np.sin(2.0 * a)) / (8.0 * np.sin(a) ** 2))
    return ratio


def _box(points: Array) -> Box:
    (x_min, y_min), (x_max, y_max) = points.min(axis=0), points.max(axis=0)
    return float(x_min), float(y_min), float(x_max), float(y_max)


def _bezier_range(row: Array) -> tuple[float, float]:
    """Least and greatest value over [0, 1] of a polynomial given by its Bezier ordinates (degree + 1,)."""
    p = len(row) - 1
    differences = row
    power = [row[0]]
    for k in range(1, p + 1):
        differences = np.diff(differences)
        power.append(math.comb(p, k) * differences[0])
    slope = np.array([k * power[k] for k in range(p, 0, -1)])
    roots = np.roots(slope)
    turning = roots.real[(np.abs(roots.imag) <= 1e-6) & (roots.real >= 0.0) & (roots.real <= 1.0)]
    t = np.concatenate(([0.0, 1.0], turning))
    value = np.repeat(row[:, None], len(t), axis=1)
    while len(value) > 1:
        value = (1.0 - t) * value[:-1] + t * value[1:]
    return float(value.min()), float(value.max())
