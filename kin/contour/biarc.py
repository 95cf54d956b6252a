"""Smooth chains of arcs that stand for Bezier pieces, within a distance that is proved."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import Arcs, cross, dot, left, turned, unit
from kin.contour.bezier import Beziers
from kin.numeric.bernstein import bernstein_product, restrict, rising_root, split

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

# Each halving divides the deviation by about eight; this many take any curve to below rounding.
MOST_HALVINGS = 24
# Rounding of the proof's own terms, in units of the curve's extent.
ROUNDING = 64.0 * np.finfo(float).eps
# Greatest turn of an arc: up to it the distance of the curve from the arc is also that of the arc from the curve.
MOST_TURN = np.pi / 2.0


class Pair(NamedTuple):
    """Two arcs tangent to each other for each of m curves, and a bound (m,), mm, of their distance from the curve.

    The bound is infinite where no pair of arcs serves.
    """

    first: Arcs
    second: Arcs
    bound: Array


def arcs_along(beziers: Beziers, tolerance: float) -> tuple[Arcs, Indices]:
    """Arcs along the pieces, in order, nowhere farther than `tolerance` mm from them, and the row of each (k,).

    Tangents are continuous wherever the curve's are. Each piece must turn one way by less than pi (`Beziers.unrolled`);
    it is halved until a pair of arcs with its end points and end tangents is proved close enough. Cost grows as
    tolerance^(-1/3). Raises ValueError where rounding keeps the arcs farther than the tolerance from a piece.
    """
    extent = float(np.abs(beziers.control).max(initial=0.0))
    if not tolerance > ROUNDING * extent:
        raise ValueError(f"arcs within {tolerance:g} mm of a curve {extent:g} mm from the origin are lost in rounding")
    row, low, high = np.arange(beziers.count), np.zeros(beziers.count), np.ones(beziers.count)
    nothing = Arcs(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0), np.zeros(0))
    runs, rows, places = [nothing], [row[:0]], [low[:0]]
    for _ in range(MOST_HALVINGS):
        if not row.size:
            break
        part = Beziers.from_homogeneous(restrict(beziers.homogeneous[row], low, high))
        pair = pair_of(part)
        middle = (low + high) / 2.0
        good = pair.bound <= tolerance
        tiny = ~good & (np.hypot(*np.ptp(part.control, axis=1).T) <= tolerance)  # the neighbourhood of a cusp
        runs += [pair.first.take(good), pair.second.take(good), chords(part.take(tiny))]
        rows += [row[good], row[good], row[tiny]]
        places += [low[good], middle[good], low[tiny]]
        left_over = ~(good | tiny)
        row = np.repeat(row[left_over], 2)
        low, high = (np.stack(ends, axis=1)[left_over].ravel() for ends in ((low, middle), (middle, high)))
    if row.size:
        x, y = beziers.control[row[0], 0]
        raise ValueError(f"arcs within {tolerance:g} mm of the curve at ({x:g}, {y:g}) are lost in rounding")
    arcs = Arcs(
        np.concatenate([a.start for a in runs]),
        np.concatenate([a.tangent for a in runs]),
        np.concatenate([a.curvature for a in runs]),
        np.concatenate([a.length for a in runs]),
    )
    owner = np.concatenate(rows)
    order = np.lexsort((np.concatenate(places), owner))
    order = order[arcs.length[order] > 0.0]
    return arcs.take(order), owner[order]


def chords(curves: Beziers) -> Arcs:
    """Return the chords of the curves, straight lines from start to end."""
    chord = curves.control[:, -1] - curves.control[:, 0]
    length = np.hypot(chord[:, 0], chord[:, 1])
    tangent = chord / np.where(length > 0.0, length, 1.0)[:, None]
    return Arcs(curves.control[:, 0], tangent, np.zeros(curves.count), length)


def pair_of(curves: Beziers) -> Pair:
    """Two arcs through the ends of each curve, with its tangents there, and a proved bound of their distance from it.

    With the chord c and the end tangents T0 and T1, both tangent lengths are d, which |c - d (T0 + T1)| = 2 d gives.
    Where the curve crosses the normal in the arcs' common point, it passes from the first arc to the second.
    """
    start, end = curves.control[:, 0], curves.control[:, -1]
    out, into = (unit(angle) for angle in curves.directions)
    chord, sum_ = end - start, out + into
    along, square = dot(chord, sum_), dot(chord, chord)
    # the positive root of the quadratic for d, without cancellation
    with np.errstate(invalid="ignore", divide="ignore"):
        side = square / (along + np.sqrt(along * along + square * np.maximum(4.0 - dot(sum_, sum_), 0.0)))
    usable = np.isfinite(side) & (side > 0.0)
    joint = (start + end + np.where(usable, side, 0.0)[:, None] * (out - into)) / 2.0
    # each arc turns by twice the angle between its chord and its tangent
    first_chord, second_chord = joint - start, end - joint
    half = np.arctan2(cross(out, first_chord), dot(out, first_chord))
    other_half = np.arctan2(cross(second_chord, into), dot(second_chord, into))
    sizes = [np.hypot(c[:, 0], c[:, 1]) for c in (first_chord, second_chord)]
    usable &= (sizes[0] > 0.0) & (sizes[1] > 0.0)
    usable &= (np.abs(half) <= MOST_TURN / 2.0) & (np.abs(other_half) <= MOST_TURN / 2.0)
    safe = [np.where(size > 0.0, size, 1.0) for size in sizes]
    first = Arcs(start, out, 2.0 * np.sin(half) / safe[0], sizes[0] / np.sinc(half / np.pi))
    tangent = turned(second_chord / safe[1][:, None], -other_half)
    second = Arcs(joint, tangent, 2.0 * np.sin(other_half) / safe[1], sizes[1] / np.sinc(other_half / np.pi))

    # the curve is cut where it crosses the joint's normal, and each part is held against the circle of its own arc
    w = curves.weight
    passing = rising_root(np.einsum("nkc,nc->nk", curves.control - joint[:, None], tangent) * w)
    before, after = split(curves.homogeneous, passing)
    bound = np.maximum(
        off_circle(before, start, out, first.curvature),
        off_circle(after, end, into, second.curvature),
    )
    return Pair(first, second, np.where(usable, bound, np.inf))


def off_circle(homogeneous: Array, point: Array, tangent: Array, curvature: Array) -> Array:
    """Upper bounds (m,), mm, of the distance of curves from circles; infinite where the proof fails.

    The curves are homogeneous control points (m, d+1, 3); each circle goes through `point` (m, 2) with the unit
    `tangent` (m, 2) and `curvature` k (m,). With y from the point and l the left normal there, g = k y^2/2 - y.l
    vanishes on the circle, and a point lies 2 g/(1 + sqrt(1 + 2 k g)) outside it. Along the curve g is a polynomial
    over w^2: its coefficients bound it.
    """
    w = homogeneous[:, :, 2]
    y = homogeneous[:, :, :2] - point[:, None] * w[:, :, None]
    square = bernstein_product(y[:, :, 0], y[:, :, 0]) + bernstein_product(y[:, :, 1], y[:, :, 1])
    across = bernstein_product(np.einsum("nkc,nc->nk", y, left(tangent)), w)
    g = np.abs(curvature[:, None] / 2.0 * square - across).max(axis=1) / w.min(axis=1) ** 2
    radicand = 1.0 - 2.0 * np.abs(curvature) * g
    bound: Array = np.where(radicand > 0.0, 2.0 * g / (1.0 + np.sqrt(np.maximum(radicand, 0.0))), np.inf)
    return bound
