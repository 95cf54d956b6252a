"""B-spline surfaces of a STEP solid as Bezier patches; mm. A face takes up the whole of its surface."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from kin.contour.bezier import spans_of
from kin.numeric.bernstein import derivative, values
from kin.numeric.quadrature import gauss
from kin.numeric.records import dataclass
from kin.read.drawing.shapes import UnfitError, check_degree, check_spline
from kin.read.step.curves import repeated

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices
    from kin.read.step.curves import StepFile
    from kin.read.step.part21 import Value

PATCH = "B_SPLINE_SURFACE_WITH_KNOTS"
ALONG = 16  # places of a span of a border, from the nearest of which
NEWTON = 4  # steps lead to the nearest point
EQUAL = 1e-12  # of weights, within which they are one


@dataclass(frozen=True, eq=False)
class Patch:
    """A polynomial B-spline surface: control points (m, k, p + 1, q + 1, 3) of its m by k Bezier patches, mm.

    `u` (m + 1,) and `v` (k + 1,) are the parameters between them.
    """

    nets: Array
    u: Array
    v: Array

    level: ClassVar[bool] = False
    upright: ClassVar[bool] = False

    @cached_property
    def corners(self) -> Array:
        """Its corners (4, 3), counter-clockwise in its parameters from the least of both."""
        nets = self.nets
        return np.stack([nets[0, 0, 0, 0], nets[-1, 0, -1, 0], nets[-1, -1, -1, -1], nets[0, -1, 0, -1]])

    @cached_property
    def borders(self) -> list[Array]:
        """Control points (spans, degree + 1, 3) of its four borders."""
        nets = self.nets
        return [nets[:, 0, :, 0], nets[-1, :, -1, :], nets[:, -1, :, -1], nets[0, :, 0, :]]

    def off(self, points: Array) -> Array:
        """Distances (k,) of points (k, 3), those of its edges, from its borders, mm."""
        off: Array = np.min([_distance(border, points) for border in self.borders], axis=0)
        return off

    def beneath(self, count: int) -> tuple[float, float]:
        """Integral of z over the surface as seen from above, mm^3, and its area, mm^2.

        By Gauss's rule of `count` nodes each way in every patch; the sign is that of the surface's normal, du x dv.
        """
        node, weight = gauss(count)
        share, weight = 0.5 * (node + 1.0), 0.5 * weight
        nets = self.nets.reshape(-1, *self.nets.shape[2:])
        du, dv = derivative(nets), np.swapaxes(derivative(np.swapaxes(nets, 1, 2)), 1, 2)
        at = [_over(part, share) for part in (nets, du, dv)]
        normal = np.cross(at[1], at[2])
        both = weight[:, None] * weight
        volume = np.einsum("nij,ij->", at[0][..., 2] * normal[..., 2], both)
        area = np.einsum("nij,ij->", np.linalg.norm(normal, axis=-1), both)
        return float(volume), float(area)


def _over(nets: Array, share: Array) -> Array:
    """Points (n, k, k, 3) of patches at shares (k,) of both parameters."""
    first = np.stack([values(nets, np.full(len(nets), t)) for t in share], axis=1)
    flat = first.reshape(-1, *first.shape[2:])
    second = np.stack([values(flat, np.full(len(flat), t)) for t in share], axis=1)
    return np.asarray(second.reshape(len(nets), len(share), len(share), 3))


def _distance(border: Array, points: Array) -> Array:
    """Distances (k,) of points (k, 3) from a curve of Bezier spans, mm."""
    shares = np.linspace(0.0, 1.0, ALONG + 1)
    count = len(border)
    line = values(np.repeat(border, ALONG + 1, axis=0), np.tile(shares, count))
    square = np.sum(points**2, axis=1)[:, None] - 2.0 * points @ line.T + np.sum(line**2, axis=1)
    nearest = square.argmin(axis=1)
    row: Indices = nearest // (ALONG + 1)
    own, t = border[row], shares[nearest % (ALONG + 1)]
    first, second = derivative(own), derivative(derivative(own)) if border.shape[1] > 2 else None
    for _ in range(NEWTON):
        away, way = values(own, t) - points, values(first, t)
        bent = 0.0 if second is None else np.sum(away * values(second, t), axis=1)
        fall = np.sum(way * way, axis=1)
        fall = np.where(fall + bent > 0.0, fall + bent, fall)
        t = np.clip(t - np.sum(away * way, axis=1) / np.where(fall > 0.0, fall, 1.0), 0.0, 1.0)
    off = np.minimum(np.linalg.norm(values(own, t) - points, axis=1), np.linalg.norm(line[nearest] - points, axis=1))
    return np.asarray(off)


def patch_of(space: StepFile, number: int) -> Patch:
    """Read the B-spline surface of a number.

    Raises ReadError for a rational surface, and where its numbers do not fit together.
    """
    file = space.file
    records = file.instances[number]
    if "RATIONAL_B_SPLINE_SURFACE" in records:
        rows = file.several(file.values(number, "RATIONAL_B_SPLINE_SURFACE", 1)[0], number)
        weights = [file.number(item, number) for row in rows for item in file.several(row, number)]
        if max(weights) - min(weights) > EQUAL * max(weights):
            raise file.error(number, "is rational; flanks are polynomial surfaces")
    if "B_SPLINE_SURFACE" in records:
        shape = file.values(number, "B_SPLINE_SURFACE", 3)
        knotted = file.values(number, PATCH, 4)
    else:
        every = file.values(number, PATCH, 12)
        shape, knotted = every[1:4], every[8:12]
    degrees = [int(file.number(item, number)) for item in shape[:2]]
    control = _control(space, number, shape[2])
    knots = []
    try:
        for axis, degree in enumerate(degrees):
            check_degree(degree)
            count = control.shape[axis]
            knots.append(repeated(space, number, knotted[axis], knotted[2 + axis], count))
            check_spline(degree, knots[axis], np.ones(count), count)
    except UnfitError as error:
        reason, problem = error.args
        raise file.error(number, problem, reason) from None
    rows_, columns = control.shape[:2]
    first = spans_of(degrees[0], knots[0], control.reshape(rows_, -1))
    along = np.moveaxis(first.reshape(*first.shape[:2], columns, 3), 2, 0)  # (columns, m, p + 1, 3)
    both = spans_of(degrees[1], knots[1], along.reshape(columns, -1))
    nets = both.reshape(*both.shape[:2], *along.shape[1:]).transpose(2, 0, 3, 1, 4)
    ends = [np.unique(own[degree : len(own) - degree]) for own, degree in zip(knots, degrees, strict=True)]
    return Patch(np.ascontiguousarray(nets), *ends)


def _control(space: StepFile, number: int, listed: Value) -> Array:
    """Control points (n, m, 3), mm."""
    file = space.file
    rows = [[space.point(item, number) for item in file.several(row, number)] for row in file.several(listed, number)]
    if len({len(row) for row in rows}) != 1 or not rows[0]:  # none, or unlike rows
        raise file.error(number, "its rows of control points are not of one length", "syntax")
    return np.array(rows)
