"""How a file's flanks hold the turret, over the angles of the cam, by positions of its rollers alone.

Layers cut the triangles of a flank to lines. On each line those places are looked at that a roller touches about the
middle of a step of the angle; the worst angles of the corners tell them. A place is a point of the file's surface, so
the turret is held at least as well as by the best of them. Each is looked at from both ends of the step. Between the
ends its excess is above the greater of both by no more than a bound that the form gives. The excess is convex in the
turret's angle, so that this turns the turret by at most the bound over the slope. How far a flank pushes the turret at
most follows from the worst angles of its corners and edges (`kin.indexing.contour`).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.indexing.motion import STEPS
from kin.numeric.angles import TURN
from kin.numeric.arrays import runs_of

if TYPE_CHECKING:
    from kin.indexing.contour import Known
    from kin.indexing.faces import Body
    from kin.indexing.rollers import Rollers
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Indices

SHARE = 0.05  # of the tolerance: what angles between two of the grid may cost
LEAST, MOST = 1024, 65_536  # angles of the grid
LAYERS = (0.02, 0.14, 0.26, 0.38, 0.5, 0.62, 0.74, 0.86, 0.98)  # of the length of a roller, at which flanks are asked
NEAR = 1e-3  # mm: a roller that touches so near the blank or the floor touches a flank
EVEN = 1e-6  # of a step: so near its middle an angle counts as there
MEETINGS = 30  # steps to the place of a roller that touches a layer
SLACK = 1e-6  # of the cost at the steepest of these places, for steeper ones between them
ANGLES = 720  # at which the steepest place is looked for


class Held(NamedTuple):
    """How far a flank keeps the turret from its place at angles of a grid (n,), rad, above 0 away from the metal.

    at       at each angle; -inf where nothing holds it
    between  at least, from each angle to the next
    own      with the turret's own roller in place of the gauge
    """

    at: Array
    between: Array
    own: Array


def angles_for(rollers: Rollers) -> int:
    """How many angles the grid needs, so that what lies between them costs a share of the tolerance."""
    room = 2.0 * float(rollers.radii.min()) * SHARE * rollers.tolerance
    step = math.sqrt(8.0 * room / float(rollers.bends(TURN / STEPS).max()))
    return min(MOST, max(LEAST, math.ceil(TURN / step)))


def held(rollers: Rollers, body: Body, known: Known, flank: tuple[Indices, Side], count: int) -> Held:
    """What triangles of a flank, by their numbers and its side, hold at so many angles of the cam."""
    which, side = flank
    rows = [np.full(count, -np.inf) for _ in range(3)]
    for share in LAYERS:
        places, step = _places(rollers, body, known, which, (share, TURN / count))
        if len(step):
            _take(rollers, (places, step), side, rows)
    return Held(*rows)


def _places(
    rollers: Rollers, body: Body, known: Known, which: Indices, about: tuple[float, float]
) -> tuple[Array, Indices]:
    """Places (m, 3) in a layer and the numbers (m,) of the steps about whose middle a roller touches them."""
    intent, (share, width) = rollers.intent, about
    # beside a roller its flanks lie where the rim of its end would be; a roller may be longer than the track is deep
    form = intent.form
    one, other = (
        min(max(form.deepest(place, intent.roller), 0.0), form.depth) for place in (intent.inner, intent.outer)
    )
    level = one + share * (other - one)
    corners = body.corners[which]
    depth = body.depth[corners] - level
    cut = (depth.min(axis=1) < 0.0) & (depth.max(axis=1) > 0.0)
    corners, depth = corners[cut], depth[cut]
    rows = np.arange(len(corners))
    # the corner that is alone on its side of the level
    alone = np.where((depth > 0.0).sum(axis=1) == 1, depth.argmax(axis=1), depth.argmin(axis=1))
    ends = []
    theta = known.worst.theta[corners]
    theta = theta[:, :1] + np.remainder(theta - theta[:, :1] + math.pi, TURN) - math.pi
    for after in (1, 2):
        next_ = (alone + after) % 3
        down = depth[rows, alone] - depth[rows, next_]
        part = depth[rows, alone] / np.where(down == 0.0, 1.0, down)
        place = body.points[corners[rows, alone]]
        place = place + part[:, None] * (body.points[corners[rows, next_]] - place)
        angle = theta[rows, alone] + part * (theta[rows, next_] - theta[rows, alone])
        ends.append((place, angle))
    (a, low), (b, high) = ends
    # neighbours have a place in common, but its angle in each of them to within rounding alone
    first = np.ceil(np.minimum(low, high) / width - 0.5 - EVEN).astype(np.intp)
    last = np.floor(np.maximum(low, high) / width - 0.5 + EVEN).astype(np.intp)
    own, more = runs_of(np.maximum(last - first + 1, 0))
    step = first[own] + more
    way = (high - low)[own]
    part = np.clip(((step + 0.5) * width - low[own]) / np.where(way == 0.0, 1.0, way), 0.0, 1.0)
    return a[own] + part[:, None] * (b[own] - a[own]), step


def _take(rollers: Rollers, places: tuple[Array, Indices], side: Side, rows: list[Array]) -> None:
    """Take into account what places hold at both ends of their steps."""
    intent, (points, step) = rollers.intent, places
    form, count = intent.form, len(rows[0])
    radius = np.full(len(step), intent.radius(side))
    gives, falls = [], np.zeros(len(step))
    for after in (0, 1):
        theta = (step + after) * np.float64(TURN / count)
        met = rollers.at(points, theta)
        along = form.along(met.x, met.s, met.d)
        there = (along >= intent.inner) & (along <= intent.outer) & (met.d * side > 0.0)
        size = np.abs(met.d)
        touch = form.touch(met.s, met.y, radius)
        own = touch if intent.roller == intent.radius(side) else form.touch(met.s, met.y, 0.0 * radius + intent.roller)
        give, own = (np.where(there & np.isfinite(one), one - size, -np.inf) for one in (touch, own))
        at = (step + after) % count
        np.maximum.at(rows[0], at, give)
        np.maximum.at(rows[2], at, own)
        gives.append(give)
        with np.errstate(invalid="ignore", divide="ignore"):
            rate = form.slope(met.s, touch)
        falls = np.maximum(falls, np.where(np.isfinite(rate) & (rate > 0.0), 1.0 / rate, 0.0))
    room = (0.125 * (TURN / count) ** 2 * rollers.bends(TURN / count))[(step % count) * STEPS // count]
    np.maximum.at(rows[1], step % count, np.minimum(*gives) - room * falls)


def by_error(rollers: Rollers, side: Side, layer: float | None = None) -> float:
    """Greatest turn of the turret, rad, that an error of 1 mm of a flank costs where it may carry a roller: sampled.

    It is that along the whole roller, or where it touches the layer of a depth, mm.
    """
    intent = rollers.intent
    form, radius = intent.form, intent.radius(side)
    # what of a roller is outside the blank bears nowhere
    first, last = (place + form.inwards * max(-form.depth_at(place), 0.0) for place in (intent.inner, intent.outer))
    theta = np.arange(ANGLES) * np.float64(TURN / ANGLES)
    psi, slope = rollers.turning.at(theta)
    own = (psi + np.arange(-intent.stops, intent.stops + 1)[:, None] * intent.pitch).ravel()
    facing = np.abs(own) < 0.5 * math.pi
    own, slope = own[facing], np.tile(slope, 2 * intent.stops + 1)[facing]
    worst = 0.0
    for share in np.linspace(0.0, 1.0, 5):
        rho = np.full(len(own), first + share * (last - first))
        cost, depth, height = form.costs(rho, (own, slope), side * radius)
        if layer is not None:
            for _ in range(MEETINGS):
                rho = np.maximum(rho + form.inwards * (layer - depth), NEAR)
                cost, depth, height = form.costs(rho, (own, slope), side * radius)
        there = (height >= intent.ends[0]) & (height <= intent.ends[1])
        there &= (depth >= -NEAR) & (depth <= form.depth + NEAR)
        worst = max(worst, float(cost[there].max(initial=0.0)))
    return worst * (1.0 + SLACK)
