"""First contact of a roller on a swinging arm, with the contour as it lies in a file.

The roller's centre may not come closer than its radius to any point of the contour: it stays outside the dilated
contour, whose pieces are the contour's own moved outward, and arcs of the roller's radius about convex corners. The
arm's end runs on a circle about the pivot; on the side of either roller a point at polar coordinates (r, t) is reached
from exactly one shaft angle,

    phi = t + acos((r^2 + L^2 - l^2)/(2 r L))   roller A, which trails the pivot;   minus for roller B, which leads it

(L from shaft to pivot, l arm). So each piece covers an interval of shaft angles, found by sorting, and each pair of
piece and angle is one intersection of two circles in closed form. The first contact from outside is that of largest r.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.arcs import Arcs, circle, cross, dot, left, right, unit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.arcs import Array, Indices

Side = Literal[-1, 1]
TRAILING: Side = -1  # roller A
LEADING: Side = 1  # roller B

STRAIGHT_ON = 1e-12  # corners that turn less, in radians, get no arc of their own
MOST_TURN = np.pi / 8.0  # pieces are cut until each turns less
MOST_SHARE = 0.1  # and is shorter than this share of the arm
PAIRS_AT_ONCE = 1_000_000  # bounds the memory that a hostile contour can ask for
SLACK = 1e-12  # of the arm's reach, by which neighbouring pieces may overlap, against rounding at their joints


@dataclass(frozen=True)
class Arm:
    """A roller's arm: `length` l, `pivot` its distance L from the shaft, mm; `side` on which the roller lies."""

    length: float
    pivot: float
    side: Side = TRAILING

    @property
    def slack(self) -> float:
        """Length, mm, that rounding may make of nothing."""
        return SLACK * (self.length + self.pivot)

    def shaft_angle(self, points: Array) -> Array:
        """Shaft angle at which the arm's end reaches points (n, 2): (n,); nan out of reach."""
        r = np.hypot(points[:, 0], points[:, 1])
        with np.errstate(invalid="ignore", divide="ignore"):
            lead = np.arccos((r * r + (self.pivot - self.length) * (self.pivot + self.length)) / (2.0 * r * self.pivot))
        angle: Array = np.arctan2(points[:, 1], points[:, 0]) - self.side * lead
        return angle

    def lean(self, r: Array) -> Array:
        """Angle at the pivot between shaft and roller centre, from the centre's distance r (n,) from the shaft.

        A distance beyond the arm's reach counts as the end of it.
        """
        # Half-angle form: good digits at either end of the reach.
        above = (r - (self.pivot - self.length)) * (r + (self.pivot - self.length))
        below = ((self.pivot + self.length) - r) * ((self.pivot + self.length) + r)
        angle: Array = 2.0 * np.arctan2(np.sqrt(np.maximum(above, 0.0)), np.sqrt(np.maximum(below, 0.0)))
        return angle

    def centre(self, phi: Array, lean: Array) -> Array:
        """Roller centre (n, 2) at shaft angles phi and leans (n,)."""
        return self.pivot * unit(phi) - self.length * unit(phi - self.side * lean)


def dilated(chain: Arcs, radius: float) -> Arcs:
    """Return the pieces, in no order, that bound what a disc's centre cannot enter, from a closed chain."""
    growth = 1.0 + chain.curvature * radius
    fits = growth > 0.0
    moved = chain.start + radius * right(chain.tangent)
    pieces = Arcs(moved, chain.tangent, chain.curvature / np.where(fits, growth, 1.0), chain.length * growth).take(fits)
    turns = chain.turns()
    corner = turns > STRAIGHT_ON
    before = np.roll(chain.end_tangents, 1, axis=0)[corner]
    vertices = chain.start[corner]
    bend = np.full(len(vertices), 1.0 / radius)
    pieces = pieces.joined(Arcs(vertices + radius * right(before), before, bend, radius * turns[corner]))
    if not fits.all():  # hollows too tight for the disc: it rests on their edges
        edges = np.concatenate([chain.start[~fits], chain.ends[~fits]])
        pieces = pieces.joined(circle(edges, np.full(len(edges), radius)))
    return pieces


def first_contact(obstacle: Arcs, arm: Arm, phi: Array) -> tuple[Array, Indices]:
    """Find where the arm's end, coming from outside, meets the obstacle first: distance from the shaft, and piece met.

    `obstacle` is the dilated contour, `phi` (n,) shaft angles. Returns r (n,) in mm and the index of the piece (n,):
    nan and -1 where nothing is met. Cost: one sort of phi, and the pairs of piece and angle that can meet.
    """
    parts = np.maximum(
        np.ceil(np.abs(obstacle.curvature) * obstacle.length / MOST_TURN),
        np.ceil(obstacle.length / (MOST_SHARE * arm.length)),
    )
    pieces, owner = obstacle.cut(np.maximum(parts, 1.0).astype(np.intp))
    within = _within_reach(pieces, arm)
    pieces, owner = pieces.take(within), owner[within]
    middle, reach = _interval(pieces, arm)
    turn = 2.0 * np.pi
    order = np.argsort(np.mod(phi, turn), kind="stable")
    angle = np.mod(phi, turn)[order]
    low = np.mod(middle - reach, turn)
    ring = np.concatenate([angle, angle + turn])
    first = np.searchsorted(ring, low, side="left")
    count = np.minimum(np.searchsorted(ring, low + 2.0 * reach, side="right") - first, len(angle))
    best = np.full(len(angle), -np.inf)
    met = np.full(len(angle), -1)
    total = np.cumsum(count)
    begin = 0
    while begin < len(pieces):
        end = max(begin + 1, int(np.searchsorted(total, total[begin] - count[begin] + PAIRS_AT_ONCE, side="right")))
        chosen = np.arange(begin, end)
        piece = np.repeat(chosen, count[chosen])
        number = np.arange(len(piece)) - np.repeat(np.cumsum(count[chosen]) - count[chosen], count[chosen])
        index = (first[piece] + number) % len(angle)
        r = _meet(pieces.take(piece), arm, angle[index])
        np.maximum.at(best, index, r)
        won = (r == best[index]) & (r > 0.0)
        met[index[won]] = piece[won]
        begin = end
    radius, piece_met = np.full(len(angle), np.nan), np.full(len(angle), -1)
    touched = met >= 0
    radius[order[touched]] = best[touched]
    piece_met[order[touched]] = owner[met[touched]]
    return radius, piece_met


def _within_reach(pieces: Arcs, arm: Arm) -> NDArray[np.bool_]:
    """Whether some point of each short piece may lie as far from the shaft as the arm's end can."""
    middle = pieces.points(0.5 * pieces.length)
    r = np.hypot(middle[:, 0], middle[:, 1])
    half = 0.5 * pieces.length + arm.slack
    within: NDArray[np.bool_] = (r + half >= abs(arm.pivot - arm.length)) & (r - half <= arm.pivot + arm.length)
    return within


def _interval(pieces: Arcs, arm: Arm) -> tuple[Array, Array]:
    """Middle and half-width of an interval of shaft angles that holds all from which each short piece is reached."""
    middle = pieces.points(0.5 * pieces.length)
    r = np.hypot(middle[:, 0], middle[:, 1])
    half = 0.5 * pieces.length + arm.slack
    least, most = np.maximum(r - half, arm.slack), r + half
    # w = cos(phi - t) = (r^2 + L^2 - l^2)/(2 r L); its slope is steepest, and sqrt(1 - w^2) least, at an end
    excess = arm.pivot**2 - arm.length**2

    def w(x: Array) -> Array:
        return (x * x + excess) / (2.0 * x * arm.pivot)

    turning = np.sqrt(max(excess, 0.0))  # where w is least, if at all
    sine = np.sqrt(np.maximum(1.0 - np.maximum(np.abs(w(least)), np.abs(w(most))) ** 2, 0.0))
    slope = np.maximum(np.abs(1.0 - excess / least**2), np.abs(1.0 - excess / most**2)) / (2.0 * arm.pivot)
    slope = np.where((least < turning) & (turning < most), np.maximum(slope, 1.0 / (2.0 * arm.pivot)), slope)
    with np.errstate(divide="ignore", over="ignore"):
        reach = half * np.hypot(1.0 / least, slope / sine)
    w_middle = np.clip(w(r), -1.0, 1.0)
    angle = np.arctan2(middle[:, 1], middle[:, 0]) - arm.side * np.arccos(w_middle)
    return angle, np.minimum(reach, np.pi)


def _meet(pieces: Arcs, arm: Arm, phi: Array) -> Array:
    """Greatest distance from the shaft at which each piece meets the arm's circle at its angle (n,), -inf if nowhere.

    From the start of the piece, its circle is 2 y.m + k y^2 = 0 and the arm's |y - q| = l; their difference is the line
    both intersections lie on, y.(m + k q) = k (q^2 - l^2)/2, also for k = 0. Where on that line they lie is asked of
    the smaller of the two circles: of the other one it would be a difference of large numbers.
    """
    pivot, slack = arm.pivot * unit(phi), arm.slack
    q = pivot - pieces.start
    small = np.abs(pieces.curvature) * arm.length > 1.0
    y = np.empty((2, len(phi), 2))
    for rows, crossings in ((np.flatnonzero(~small), _on_arm), (np.flatnonzero(small), _on_piece)):
        if len(rows):
            y[:, rows] = crossings(pieces.take(rows), q[rows], arm.length, slack)
    chord_turn = 0.5 * pieces.curvature * pieces.length
    chord = pieces.length * np.sinc(chord_turn / np.pi)
    along = np.cos(chord_turn)[:, None] * pieces.tangent + np.sin(chord_turn)[:, None] * left(pieces.tangent)
    sagitta = np.abs(chord * np.tan(0.5 * chord_turn)) + slack
    best = np.full(len(phi), -np.inf)
    for found in y:
        s = dot(found, along)
        with np.errstate(invalid="ignore"):
            on_piece = (s >= -slack) & (s <= chord + slack) & (np.abs(cross(along, found)) <= sagitta)
            point = pieces.start + found
            on_side = arm.side * cross(pivot, point) >= -slack * arm.pivot
        r = np.hypot(point[:, 0], point[:, 1])
        best = np.where(on_piece & on_side & (r > best), r, best)
    return best


def _on_arm(pieces: Arcs, q: Array, length: float, slack: float) -> Array:
    """Both crossings (2, n, 2), seen from the pieces' starts, nan where there are none; from the arm's circle."""
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
    """The same from the piece's own circle, which is the smaller one."""
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
