"""What an undercut costs: parts of the envelope of all rollers that other rollers cut off, and the motion lost there.

Each part ends at two inputs whose contacts are one point, the corner that is left; there the roller sits while the
intended motion runs through what is lost. That holds for crests that are sharper than the roller, and for two parts of
the flank far from one another alike.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import cross
from kin.linear.follower import Stem
from kin.linear.pitch import Pitch
from kin.numeric.elementary import BallJet, Jet, acos, atan2, sqrt
from kin.numeric.extrema import extremes, resolution
from kin.numeric.interval import sin_cos
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.piecewise import Side as KnotSide
    from kin.linear.follower import LinearFollower
    from kin.numeric.arrays import Array, Indices, Mask

CUT_OFF = 1e-11  # of the length: a point of the envelope covered by other rollers by more is cut off
LOOKS = 64  # inputs about a part whose speed is below 0
BESIDE = 2.0  # lengths of such a part, before and behind it, in which its loop ends
STEPS = 40  # of Newton's method
CLOSE = 1e-14  # of the length: accuracy of a corner
PARTS = 32  # of a cut, on which the motion lost is looked at first


@dataclass(frozen=True)
class Cut:
    """A part of the flank that is lost: inputs from `begin` to `end`, mm, whose contacts meet at `corner`, mm.

    `lost`, mm or rad, is by how far a roller on the trimmed flank stays below the intended lift at most, at input
    `lost_at`, mm.
    """

    begin: float
    end: float
    corner: tuple[float, float]
    lost: float
    lost_at: float


def cuts(
    follower: LinearFollower, beyond: tuple[float, float] = (0.0, 0.0), *, tangent: bool = True
) -> tuple[Cut, ...]:
    """Undercut parts of a flank, local or global, by rising input; empty where all of the envelope is flank.

    The flank goes on by `beyond`, mm, along its end tangents or level, and what meets it there counts. Of an endless
    motion the parts of one period are given.
    """
    if follower.radius == 0.0 or _is_graph(follower):
        return ()
    return tuple(_cut(follower, *part) for part in _parts(Pitch(follower, beyond, tangent)))


def _is_graph(follower: LinearFollower) -> bool:
    """Whether the envelope is proved to run on towards +x all along, so that it meets itself nowhere.

    With speed sigma + R omega along T that is sigma^3 + R sigma^2 omega > 0 and T_x > 0, by balls over the law's cells.
    """
    if len(follower.corners):
        return False
    cells = follower.cells
    rows = follower.law.on(BallJet.variable(cells[:-1], cells[1:], 2)).rows
    lift, slope, bend = rows[0], rows[1], rows[2] * 2.0
    guide = follower.guide
    if isinstance(guide, Stem):
        sine, cosine = math.sin(guide.gamma), math.cos(guide.gamma)
        square, ahead, turn = slope**2 + slope * (2.0 * sine) + 1.0, slope * sine + 1.0, bend * cosine
    else:
        sine_psi, cosine_psi = sin_cos(lift + follower.psi0)
        path, s = slope * guide.length, float(guide.side)
        leaning = path * sine_psi * s
        square, ahead = path**2 + leaning * 2.0 + 1.0, leaning + 1.0
        turn = bend * cosine_psi * guide.length - slope * leaning * s - path**2 * slope * s
    runs_on = (square**1.5 + turn * follower.radius).positive & ahead.positive
    return bool(runs_on.all())


def _parts(pitch: Pitch) -> list[tuple[float, float, Array]]:
    """First and last input of each part cut off, and the corner (2,)."""
    u = _looked(pitch)
    size = max(map(abs, pitch.span))
    off = CUT_OFF * size

    def lost(at: Array) -> Mask:
        gone: Mask = pitch.feet(pitch.envelope(at)[0]).excess > off
        return gone

    gone = lost(u)
    if not gone.any():
        return []
    # ends of the runs that are lost, by bisection, then both together by Newton's method
    low, high = u[:-1].copy(), u[1:].copy()
    edge = np.flatnonzero(gone[:-1] != gone[1:])
    low, high, was = low[edge], high[edge], gone[edge]
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        same = lost(middle) == was
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    begins, ends = low[~was], high[was]
    if pitch.follower.endless:
        first, last = pitch.span
        if len(ends) and len(begins) and ends[0] < begins[0]:
            ends = np.append(ends[1:], ends[0] + last - first)
    else:
        begins = begins if not gone[0] else np.append(u[0], begins)
        ends = ends if not gone[-1] else np.append(ends, u[-1])
    parts = []
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        a, b = _corner(pitch, begin, end, CLOSE * size)
        parts.append((a, b, pitch.envelope(np.array([a]))[0][0]))
    return parts


def _looked(pitch: Pitch) -> Array:
    """Inputs (n,), rising, at which the envelope is looked at: the chords' ends, and closely where it runs back."""
    first, last = pitch.span
    u = pitch.inputs
    u = np.concatenate([u, 0.5 * (u[1:] + u[:-1])])
    u = np.unique(u[(u >= first) & (u <= last)])
    if not pitch.follower.endless:
        before, behind = pitch.beyond
        steps = np.linspace(0.0, 1.0, LOOKS)
        u = np.unique(np.concatenate([first - before * steps, u, last + behind * steps]))
    # the corners of the pitch curve lie in what is lost, or are hollow
    knots = pitch.follower.law.breaks
    points, rates = pitch.envelope(u)
    step = np.diff(points, axis=0)
    back = (np.einsum("ij,ij->i", step, rates[:-1]) < 0.0) | (np.einsum("ij,ij->i", step, rates[1:]) < 0.0)
    closely = [u, knots]
    runs = np.flatnonzero(np.diff(np.concatenate([[False], back, [False]]).astype(np.intp)))
    for begin, end in runs.reshape(-1, 2).tolist():
        a, b = u[begin], u[end]
        wide = BESIDE * (b - a)
        closely.append(np.clip(np.linspace(a - wide, b + wide, LOOKS), u[0], u[-1]))
    return np.unique(np.concatenate(closely))


def _corner(pitch: Pitch, begin: float, end: float, close: float) -> tuple[float, float]:
    """Two inputs near begin and end whose contacts are one point; these themselves where none is found."""
    a, b = begin, end
    width = end - begin
    for _ in range(STEPS):
        (first, second), (one, other) = pitch.envelope(np.array([a, b]))
        gap, sine = second - first, float(cross(one, other))
        if sine == 0.0:
            break
        # first + da one = second + db other
        da, db = float(cross(gap, other)) / sine, float(cross(gap, one)) / sine
        a, b = a + da, b + db
        if not (abs(a - begin) < 0.5 * width and abs(b - end) < 0.5 * width):
            return begin, end
        if max(abs(da), abs(db)) <= close:
            break
    return a, b


def _cut(follower: LinearFollower, begin: float, end: float, corner: Array) -> Cut:
    """The cut with the greatest motion that is lost."""
    first, last = (begin, end) if follower.endless else np.clip([begin, end], *follower.span).tolist()
    lost, at = 0.0, first
    if last > first:
        knots = follower.law.breaks
        if follower.endless:
            length = follower.span[1] - follower.span[0]
            knots = np.concatenate([knots + turn * length for turn in (-1, 0, 1, 2)])
        inside = knots[(knots > first) & (knots < last)]
        cells = np.unique(np.concatenate([np.linspace(first, last, PARTS + 1), inside]))

        # rounding counts from what the lift is found of: the corner, and the roller about it
        fine = resolution(np.append(corner, [follower.radius, follower.lever])) / follower.lever

        def rows(u: Array, side: KnotSide = 1) -> Array:
            jet = Jet.variable(u, 2)
            return (follower.law.on(jet, side) - resting(follower, corner, jet)).derivatives()

        def within(u: Array, _: Indices) -> Array:
            return rows(u)

        found = extremes(cells[:-1], cells[1:], rows(cells[:-1]), rows(cells[1:], -1), within, resolution=fine)
        lost, at = max(found.greatest, 0.0), found.greatest_at
    return Cut(begin, end, (float(corner[0]), float(corner[1])), lost, at)


def resting(follower: LinearFollower, point: Array, u: Jet) -> Jet:
    """Lift, mm or rad, at inputs u (n,), mm, with the roller on a point (2,), mm, from above."""
    guide, radius = follower.guide, follower.radius
    if isinstance(guide, Stem):
        sine, cosine = math.sin(guide.gamma), math.cos(guide.gamma)
        ahead, above = u - float(point[0]), follower.level - float(point[1])
        along, across = ahead * sine + above * cosine, ahead * cosine - above * sine
        return sqrt(radius**2 - across * across) - along
    # seen from the pivot, x towards the side of the arm
    x, y = (u - float(point[0])) * float(guide.side), u.constant(float(point[1]) - guide.pivot)
    square = x * x + y * y
    angle = acos((square + (guide.length**2 - radius**2)) / (sqrt(square) * (2.0 * guide.length)))
    return atan2(y, x) + angle - follower.psi0
