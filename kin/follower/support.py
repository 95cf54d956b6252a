"""Where a contour bears on flat faces all round: corner after corner, arc after arc, and the support function of each.

Between two neighbouring breaks one corner, arc or Bezier piece is the farthest in every direction, so the support
function q(theta) = x.u(theta) is smooth there: q' = x.n and q'' = R - q, with x the contact point and R the contour's
radius of curvature at it, 0 for a corner.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import cross, dot, unit
from kin.contour.contour import ARC, BEZIER, LINE
from kin.numeric.angles import TURN
from kin.numeric.bernstein import values
from kin.numeric.distinct import distinct
from kin.numeric.extrema import extremes
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.bezier import Beziers
    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array, Indices
    from kin.numeric.extrema import Extremes

ROUNDED = 1e-12  # rad: a normal this close to 2 pi may belong to an edge in line with an edge of normal 0
NEAR_CENTRE = 20.0  # of the extent; a point found from a centre farther away would lose too much to rounding
FLATTEST = 1e9  # mm; larger radii of curvature are all alike


@dataclass(frozen=True, eq=False)
class FlatContacts:
    """Contacts of a contour with flat faces in all directions, on m stretches of the normal's angle.

    Stretch k runs from breaks[k] to breaks[k+1], the last over 2 pi to the first; breaks rise in [0, 2 pi). `point` (m,
    2) is the corner that bears, `piece` (m,) the arc or Bezier piece that does instead, -1 for a corner. `back` is the
    length, mm, that is subtracted from the support function in the reported q.
    """

    contour: Contour
    breaks: Array
    point: Array
    piece: Indices
    back: float = 0.0

    def find(self, theta: Array) -> Indices:
        """Index (n,) of the stretch of each angle theta (n,), rad; at a break of the stretch that begins there."""
        return (np.searchsorted(self.breaks, np.mod(theta, TURN), side="right") - 1) % len(self.breaks)

    def derivatives(self, theta: Array, stretch: Indices) -> Array:
        """q, q', q'' (3, n), mm, at angles theta (n,), rad, of the corner or piece of the given stretches (n,)."""
        return self._rows(theta, stretch, unit(theta))

    def _rows(self, theta: Array, stretch: Indices, u: Array) -> Array:
        x, radius = self._contact(theta, stretch, u)
        q = dot(x, u)
        return np.stack([q - self.back, cross(u, x), radius - q])

    def between(self, nodes: Array, turned: float = 0.0) -> tuple[Indices, Array, Array]:
        """Give q(theta + turned), mm, at both ends of m intervals without a break, each as its own interval has it.

        `nodes` (m + 1,), rad, bound the intervals. Returns the stretch of each (m,) and q, q', q'' (3, m) at the low
        and at the high ends.
        """
        low, high = nodes[:-1] + turned, nodes[1:] + turned
        stretch = self.find(0.5 * (low + high))
        u = unit(nodes + turned)
        return stretch, self._rows(low, stretch, u[:-1]), self._rows(high, stretch, u[1:])

    def all_round(self, steps: int) -> Array:
        """Support function rows q, q', q'' (3, n), mm and mm/rad^k, from both ends of the intervals all round.

        The intervals are bounded by `steps` equal steps of the turn and by the breaks, so that each node occurs twice:
        as seen from the interval before it and from the one after.
        """
        _, low, high = self.between(self.nodes(0.0, TURN, TURN * np.arange(steps) / steps))
        return np.concatenate([low, high], axis=1)

    def breadth_extremes(self, resolution: float) -> Extremes:
        """Extremes of the breadth q(theta) + q(theta + pi), mm, over theta from 0 to pi, to a `resolution`, mm.

        Raises UnsettledError where rounding is larger than the resolution.
        """
        nodes = self.nodes(0.0, np.pi, np.mod(self.breaks - np.pi, TURN))
        near, near_low, near_high = self.between(nodes)
        far, far_low, far_high = self.between(nodes, np.pi)

        def breadth(theta: Array, interval: Indices) -> Array:
            return self.derivatives(theta, near[interval]) + self.derivatives(theta + np.pi, far[interval])

        return extremes(nodes[:-1], nodes[1:], near_low + far_low, near_high + far_high, breadth, resolution=resolution)

    def _contact(self, theta: Array, stretch: Indices, u: Array) -> tuple[Array, Array]:
        """Points of contact (n, 2), mm, and radii of curvature there (n,), mm, 0 at corners.

        The normals have angles `theta` (n,), rad, and unit vectors `u` (n, 2), and lie on the stretches given.
        """
        x = self.point[stretch]
        radius = np.zeros(len(x))
        piece = self.piece[stretch]
        curved = np.flatnonzero(piece >= 0)
        if len(curved):
            kind = self.contour.kind[piece[curved]]
            arc, bow = curved[kind == ARC], curved[kind == BEZIER]
            i = piece[arc]
            radius[arc] = r = self.contour.radius[i]
            x[arc] = self.contour.centre[i] + r[:, None] * u[arc]
            far = r > NEAR_CENTRE * float(np.abs(self.contour.vertices).max())
            arc, i = arc[far], i[far]
            # from a centre far away the points lose digits, so these are found from the arc's start
            x[arc] = self.contour.arc_points(i, theta[arc] - self.contour.angle[i])
            if len(bow):
                row = self.contour.curve[piece[bow]]
                beziers = self.contour.beziers
                t = beziers.farthest(row, theta[bow])
                x[bow] = beziers.point(row, t)
                radius[bow] = _radius(beziers, row, t)
        return x, radius

    def nodes(self, low: float, high: float, breaks: Array, turned: float = 0.0) -> Array:
        """Angles low and high, rad, and between them, rising, the breaks of q(theta + turned) and `breaks`.

        `breaks` (k,) are angles, rad, in [0, 2 pi]; all recur on every turn.
        """
        all_breaks = np.concatenate([np.mod(self.breaks - turned, TURN), breaks])
        first = int(np.floor(low / TURN))
        turns = TURN * np.arange(first, int(np.ceil(high / TURN)) + 1)
        spread = all_breaks if len(turns) == 1 else (all_breaks + turns[:, None]).ravel()
        spread = spread[(spread > low) & (spread < high)]
        return distinct(np.concatenate([[low], spread, [high]]))


def _radius(beziers: Beziers, row: Indices, t: Array) -> Array:
    """Radius of curvature of Bezier pieces `row` (n,) at parameters t (n,), mm (n,), no more than FLATTEST."""
    velocity = beziers.velocity[row]
    v = values(velocity, t)
    degree = velocity.shape[1] - 1
    change = values(degree * np.diff(velocity, axis=1), t) if degree else np.zeros_like(v)
    # v is w^2 times the derivative where the pieces are rational, and then v x v' is w^4 times its numerator
    weight = values(beziers.weight[row], t) if beziers.rational else np.ones(len(t))
    bend = np.abs(cross(v, change)) * weight**2
    size = np.hypot(v[:, 0], v[:, 1]) ** 3
    radius: Array = size / np.maximum(bend, size / FLATTEST)
    return radius


def bearing_of(contour: Contour) -> FlatContacts:
    """Contacts of a contour with flat faces in all directions, with `back` 0.

    The cost is one support evaluation for each break of the contour's support function.
    """
    breaks = contour.normals
    middle = np.mod(breaks + 0.5 * np.diff(breaks, append=breaks[:1] + TURN), TURN)
    if contour.is_convex and not _overlap(contour):
        return _of_convex(contour, breaks, middle)
    support = contour.support(middle)
    ranges = contour.normal_ranges
    low, width = np.zeros(len(contour)), np.full(len(contour), -1.0)
    low[ranges.piece], width[ranges.piece] = ranges.low, ranges.width
    curved = np.mod(middle - low[support.piece], TURN) <= width[support.piece]
    return FlatContacts(contour, breaks, support.point, np.where(curved, support.piece, -1))


def _overlap(contour: Contour) -> bool:
    """Whether neighbours' normals overlap, by rounding, so much that it matters which of them bears there.

    The ends of an arc hardly longer than the rounding of its coordinates point anywhere; where the tangent turns back
    by b onto an arc of radius R, that arc reaches R b^2/2 farther than the short one.
    """
    back = np.maximum(-contour.joints, 0.0)
    chord, turn = np.hypot(*(contour.end - contour.start).T), np.abs(contour.turns)
    radius = np.divide(chord, turn, out=np.zeros(len(contour)), where=(contour.kind != LINE) & (turn > 0.0))
    felt = 0.5 * np.maximum(radius, np.roll(radius, 1)) * back**2
    return bool((felt > 4.0 * np.finfo(float).eps * float(np.abs(contour.vertices).max())).any())


def _of_convex(contour: Contour, breaks: Array, middle: Array) -> FlatContacts:
    """Contacts of a convex contour: a piece bears over its own normals, its end up to the next piece's first normal."""
    first = np.mod(contour.directions[0] - 0.5 * np.pi, TURN)
    first = np.where(first > TURN - ROUNDED, first - TURN, first)
    # all round the normals rise, but for the step back where they pass 2 pi, and for the rounding of edges in one line
    step = np.diff(first, append=first[:1])
    order = np.roll(np.arange(len(contour)), -1 - int(np.argmin(step)))
    piece = order[np.searchsorted(np.maximum.accumulate(first[order]), middle, side="right") - 1]
    own = np.mod(middle - first[piece], TURN) < contour.turns[piece]
    own &= contour.kind[piece] != LINE
    return FlatContacts(contour, breaks, contour.end[piece], np.where(own, piece, -1))
