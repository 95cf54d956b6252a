"""How far the surface of a file is from the flanks: out of the metal, proud, and into it, bare; with proofs.

Proud is the depth to which a triangle reaches into what rollers sweep. Seen along a roller's axis, the deepest place of
a triangle is on an edge, unless the axis passes through it; that axis is near the edges too. So edges tell it, within
what their search leaves open. Bare is how far a place of the surface is from all rollers at all angles. At one angle
the distance from an axis is convex, and over a triangle it is greatest at a corner. So the corners' distances at any
angle bound it. An angle between the worst ones of the corners is taken, and triangles are divided until the bound is
close to what corners show.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.indexing.rollers import Worst
from kin.numeric.angles import TURN
from kin.numeric.arrays import runs_of
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.indexing.faces import Body
    from kin.indexing.rollers import Rollers
    from kin.numeric.arrays import Array, Indices, Mask

OPEN = 0.2  # of the tolerance, or of a greater distance: what the proof may leave open
PLAIN = 0.5  # of the tolerance: a bound below it need not be closer
ROUNDS = 24  # of dividing triangles
FAR, FEW = 10.0, 2  # times the tolerance: a surface found so far off is divided in no more rounds than these
MOST_AT_ONCE = 200_000  # triangles of a file
MOST_PARTS = 2_000_000  # of these, while dividing
LEAST_PARTS = 4  # of an edge that may span a track
APART = 0.1  # rad: worst angles of a triangle's corners that are farther apart are not of one place of a flank
ASKED = 16  # triangles in each round, those of the greatest bounds, whose corners are measured
BESIDE = 4  # of the finest steps: places of a parabola beside an angle
MOST_MOVED = 2.0  # of these, by which the parabola may move the angle


class Peak(NamedTuple):
    """A greatest distance, mm, found at a shaft angle, rad, and by how much it may be exceeded at most."""

    value: float
    remainder: float
    at: float


@dataclass(frozen=True, eq=False)
class Known:
    """Distances of a body's corners from the rollers; nan for corners that were not examined.

    worst     (v,) each at its worst angle
    distance  (v,) from what rollers sweep, mm
    above     (v,) whether the corner is above the roller: on an upper flank, if on any
    along     (v,) place along the roller
    gives     (v,) how far the corner pushes the turret at that angle, rad; below 0 it is that far off
    slope     (v,) of the excess by the turret's angle where it touches
    """

    worst: Worst
    distance: Array
    above: Mask
    along: Array
    gives: Array
    slope: Array

    @staticmethod
    def of(rollers: Rollers, body: Body, asked: Indices) -> Known:
        """Corners by their numbers; values of others are nan."""
        count = len(body.points)
        worst = Worst(*(np.full(count, np.nan) for _ in range(4)))
        points = body.points[asked]
        found = rollers.worst(points)
        for row, values in zip(worst, found, strict=True):
            row[asked] = values
        met, form = rollers.at(points, found.theta), rollers.intent.form
        radius = rollers.own(met)
        distance, along, gives, slope = (np.full(count, np.nan) for _ in range(4))
        size = np.abs(met.d)
        touch = form.touch(met.s, met.y, radius)
        distance[asked] = rollers.distance(found.excess, radius)
        along[asked] = form.along(met.x, met.s, met.d)
        gives[asked] = touch - size
        slope[asked] = form.slope(met.s, np.where(np.isfinite(touch), touch, size))
        above = np.zeros(count, dtype=np.bool_)
        above[asked] = met.d > 0.0
        return Known(worst, distance, above, along, gives, slope)

    def take(self, which: Indices) -> Worst:
        """Worst angles of some corners."""
        return Worst(*(row[which] for row in self.worst))


class Edged(NamedTuple):
    """Edges of triangles, by the numbers of their ends (e,), at their worst angles."""

    start: Indices
    last: Indices
    worst: Worst


def edges_of(rollers: Rollers, body: Body, known: Known, which: Indices) -> Edged:
    """Edges of triangles by their numbers, of those whose ends are in reach of a roller."""
    a, b = body.edges_of(which)
    ends = known.worst.excess
    near = np.maximum(ends[a], ends[b]) < rollers.reached
    a, b = a[near], b[near]
    return Edged(a, b, rollers.edges(body.points[a], body.points[b], (known.take(a), known.take(b))))


def proud(rollers: Rollers, known: Known, edged: Edged, own: Indices) -> Peak:
    """How far corners and edges of a flank stand out of the metal; `own` are the corners of its triangles."""
    corner = own[int(known.distance[own].argmin())]
    best = Peak(-float(known.distance[corner]), 0.0, float(known.worst.theta[corner]))
    if not len(edged.start):
        return best
    radius = np.where(known.above[edged.start], rollers.radii[1], rollers.radii[0])
    sure = -rollers.distance(edged.worst.excess, radius)
    most = -rollers.distance(edged.worst.excess - edged.worst.open, radius)
    k = int(sure.argmax())
    if sure[k] > best.value:
        best = Peak(float(sure[k]), 0.0, float(edged.worst.theta[k]))
    return best._replace(remainder=max(0.0, float(most.max()) - best.value))


def across(rollers: Rollers, body: Body, known: Known, which: Indices, floor: float) -> tuple[Peak, Peak]:
    """How far edges of blank and ends, by numbers of their triangles, stand in the way of rollers: below, above them.

    Such an edge spans metal. One that spans a track closes it, though both its ends be on flanks: it is asked at places
    between them, those above the `floor`, a depth, mm. Where nothing is in the way a peak is minus infinity.
    """
    a, b = body.edges_of(which)
    start, last = body.points[a], body.points[b]
    square = np.sum((last - start) ** 2, axis=1)
    ends = np.minimum(np.minimum(known.worst.excess[a], known.worst.excess[b]), rollers.reached)
    # below the lesser of its ends' by a quarter of its square at most; ends that are not asked are nan, and may be near
    open_ = ~(ends > 0.25 * square) & (square > 4.0 * float(rollers.radii.min()) * PLAIN * rollers.tolerance)
    start, way, square = start[open_], (last - start)[open_], square[open_]
    parts = np.maximum(LEAST_PARTS, np.ceil(2.0 * np.sqrt(square) / float(rollers.radii.min()))).astype(np.intp)
    own, more = runs_of(parts - 1)
    points = start[own] + way[own] * ((more + 1) / parts[own])[:, None]
    points = points[rollers.intent.form.depth_of(np.hypot(points[:, 0], points[:, 1]), points[:, 2]) < floor]
    found = rollers.worst(points)
    met = rollers.at(points, found.theta)
    off = -rollers.distance(found.excess, rollers.own(met))
    peaks = []
    for side in (met.d <= 0.0, met.d > 0.0):
        rows = np.flatnonzero(side)
        k = rows[off[rows].argmax()] if len(rows) else -1
        peaks.append(Peak(float(off[k]), 0.0, float(found.theta[k])) if k >= 0 else Peak(-math.inf, 0.0, math.nan))
    return peaks[0], peaks[1]


def bare(rollers: Rollers, body: Body, known: Known, which: Indices) -> Peak:
    """How far triangles of a flank, by their numbers, reach into the metal."""
    corners = body.corners[which]
    flat = corners.ravel()
    place = flat[int(known.distance[flat].argmax())]
    peak = Peak(float(known.distance[place]), 0.0, float(known.worst.theta[place]))
    for begin in range(0, len(corners), MOST_AT_ONCE):
        block = corners[begin : begin + MOST_AT_ONCE]
        peak = _raised(peak, rollers, body.points[block], known.worst.theta[block])
    return peak


def _raised(peak: Peak, rollers: Rollers, triangles: Array, theta: Array) -> Peak:
    """How far a surface is bare with triangles (t, 3, 3), which have these worst angles (t, 3), beside the `peak`."""
    value, at, bound = peak.value, peak.at, peak.value + peak.remainder
    theta = theta[:, :1] + np.remainder(theta - theta[:, :1] + math.pi, TURN) - math.pi
    for turn in range(ROUNDS + 1):
        apart = np.ptp(theta, axis=1)
        strayed = np.flatnonzero(apart > APART)
        if len(strayed) and turn:
            theta[strayed] = rollers.worst(triangles[strayed].reshape(-1, 3)).theta.reshape(-1, 3)
            theta[strayed, 1:] += TURN * np.round((theta[strayed, :1] - theta[strayed, 1:]) / TURN)
        # where angles that seem to agree have left the bound open, one of them is not the worst
        alike = np.flatnonzero(apart < rollers.finest)
        if len(alike) and turn:
            theta[alike] = _settled(rollers, triangles[alike].reshape(-1, 3), theta[alike].ravel()).reshape(-1, 3)
        off = _farthest(rollers, triangles, theta)
        if turn:
            # a flank that bulges is bare within its triangles, though no corner of the file is
            found, angle = _barest(rollers, triangles[np.argsort(off)[-ASKED:]])
            value, at = (found, angle) if found > value else (value, at)
        left = off > max(value + OPEN * max(value, rollers.tolerance), PLAIN * rollers.tolerance)
        bound = max(bound, float(off[~left].max(initial=-math.inf)))
        if not left.any():
            break
        rounds = FEW if value > FAR * rollers.tolerance else ROUNDS
        if turn >= rounds or 2 * np.count_nonzero(left) > MOST_PARTS:
            bound = max(bound, float(off.max()))
            break
        triangles, theta = _halved(rollers, triangles[left], theta[left])
    return Peak(value, max(0.0, bound - value), at)


def _barest(rollers: Rollers, triangles: Array) -> tuple[float, float]:
    """Distance of that corner of triangles (t, 3, 3) which is farthest from rollers, mm, and its worst angle, rad.

    One that is out of reach of all rollers is told to be as far as they reach.
    """
    points = triangles.reshape(-1, 3)
    found = rollers.worst(points)
    excess = np.minimum(found.excess, rollers.reached)
    distance = rollers.distance(excess, rollers.own(rollers.at(points, found.theta)))
    k = int(distance.argmax())
    return float(distance[k]), float(found.theta[k])


def _halved(rollers: Rollers, triangles: Array, theta: Array) -> tuple[Array, Array]:
    """Triangles (t, 3, 3) and angles at their corners (t, 3), in two by the side over which the angle goes most."""
    first = np.abs(theta - np.roll(theta, -1, axis=1)).argmax(axis=1)
    rows = np.arange(len(theta))
    a, b, c = ((triangles[rows, (first + k) % 3], theta[rows, (first + k) % 3]) for k in range(3))
    place = 0.5 * (a[0] + b[0])
    middle = place, _settled(rollers, place, 0.5 * (a[1] + b[1]))
    parts = [(a, middle, c), (middle, b, c)]
    places, angles = (np.concatenate([np.stack([at[k] for at in part], axis=1) for part in parts]) for k in range(2))
    return places, angles


def _settled(rollers: Rollers, points: Array, theta: Array) -> Array:
    """Angles (n,) nearer to the worst ones of points (n, 3): where a parabola about theta (n,) is least.

    The worst angle is not even along a long side: at the mean of its ends a sound place may seem to be bare.
    """
    step = BESIDE * rollers.finest
    theta = rollers.finest * np.rint(theta / rollers.finest)
    before, at, after = (rollers.near(points, theta + by)[0] for by in (-step, 0.0, step))
    curve = before - 2.0 * at + after
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = np.where(curve > 0.0, 0.5 * (before - after) / curve, 0.0)
    return np.asarray(theta + step * np.clip(moved, -MOST_MOVED, MOST_MOVED))


def _farthest(rollers: Rollers, triangles: Array, theta: Array) -> Array:
    """Bound (t,), mm, of how far triangles (t, 3, 3) are from rollers, by corners at an angle between theirs (t, 3)."""
    one, other, third = theta.T
    low, high = np.minimum(np.minimum(one, other), third), np.maximum(np.maximum(one, other), third)
    middle = np.repeat(0.5 * (low + high), 3)
    off, psi = (row.reshape(-1, 3) for row in rollers.near(triangles.reshape(-1, 3), middle))
    one = np.abs(psi - psi[:, :1]).max(axis=1) < 0.5 * rollers.intent.pitch
    return np.where(one, np.maximum(np.maximum(off[:, 0], off[:, 1]), off[:, 2]), np.inf)
