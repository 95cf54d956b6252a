"""Tangent-continuous arcs whose joints lie where they serve best, not on the curve (docs/theory.md 3).

Where curvature rises or falls steadily the best arc of length L crosses the curve at both its ends, at an angle of
``kappa' L^2 / 12``, and in the middle. It deviates by ``|kappa'| L^3 / 124.7`` to either side, so that the count within
e is the integral of ``(|kappa'| / (124.7 e))^(1/3) ds``, 0.69 of the count of arcs in biarcs.

A part of the curve between two extrema of its curvature, at which arcs touch the curve, takes n arcs: n - 1 joints of
three unknowns each (place along the curve, distance from it, angle); one condition for each arc, that it joins in
tangent; and two extremes of the deviation for each arc but one for the first and the last, all as large as a level that
is unknown too. That is as many equations as unknowns. They are solved by Newton's method, for all parts at once.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.fit.deviation import Chain, chain_deviation, radial
from camgeo.fit.monotone_parts import ENDS, refine
from camgeo.fit.staircase import solve_chains
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve, Frame
    from camgeo.fit.monotone_parts import MonotonePart
    from kin.numeric.arrays import Array

LEVEL = 1.02  # times the level foreseen: a part so near to it has settled
ALONG = 0.03  # of an arc's length: a joint's move that changes its neighbours' deviations by about the tolerance
DOUBT = 0.3  # of the extrapolated part of a deviation: taken as its error
STEPS = 12  # of Newton's method
MOST_MOVE = 0.25  # of an arc's length: greatest move of a joint along the curve in one step
INNER = 0.5 - math.sqrt(1.0 / 12.0)  # share of an arc at which its deviation is greatest, from either end
OUTER = 2.0 / 3.0  # this share for a part's first arc
RAISED = 4  # tries of a part, each with more arcs
MOST_ARCS = 40_000  # tried in all, after which no part is tried again
MOST_RAISED = 1.5  # times the arcs: most for the next try
NOISE = 20.0  # units in the last place of the curve's size, by which rounding raises the level: arcs to spare for it
JOINED = 8.0  # units in the last place of the curve's size, by which an arc may miss the tangent of its end
CLOSING = 12  # steps that bring arcs to this
PROOF_LOOKS = 16  # steps of an arc at which its deviation is first proved


class FittedArcs(NamedTuple):
    """Proved arcs: starting points (n, 2), bulges (n,), greatest deviation outward and inward of the curve, mm."""

    points: Array
    bulges: Array
    outward: float
    inward: float

    @staticmethod
    def join(parts: Iterable[FittedArcs]) -> FittedArcs:
        """Arcs of consecutive parts, at least one, as one chain."""
        points, bulges, outward, inward = zip(*parts, strict=True)
        return FittedArcs(np.concatenate(points), np.concatenate(bulges), max(outward), max(inward))


@dataclass(frozen=True)
class _Layout:
    """Arcs of all parts in order: `part` (n,) and `left` (n,) are the indices of an arc's part and first joint.

    `ends` (m,) marks the joints at which a part begins or ends, which stay, `right_end` (m,) those at which it ends.
    `sign` (n, 2) is the side of an arc on which the curve lies at its two extremes, 1 outside, -1 inside; 0 for the
    extreme that a part's first and last arc lack.
    """

    part: NDArray[np.intp]
    left: NDArray[np.intp]
    ends: NDArray[np.bool_]
    right_end: NDArray[np.bool_]
    sign: Array

    @property
    def part_of_joint(self) -> NDArray[np.intp]:
        """Index of the part of each joint (m,)."""
        return np.cumsum(self.right_end) - self.right_end

    @staticmethod
    def of(counts: Sequence[int], rising: Sequence[float]) -> _Layout:
        """Layout of parts with `counts` arcs each, whose curvature is `rising` (1) or falling (-1)."""
        part = np.repeat(np.arange(len(counts)), counts)
        left = np.arange(part.size) + part
        last = np.cumsum(np.array(counts) + 1) - 1
        first = np.append(0, last[:-1] + 1)
        right_end = np.zeros(part.size + len(counts), dtype=bool)
        right_end[last] = True
        ends = right_end.copy()
        ends[first] = True
        sense = np.array(rising)[part]
        sign = np.column_stack([np.where(ends[left], 0.0, -sense), np.where(ends[left + 1], 0.0, sense)])
        return _Layout(part, left, ends, right_end, sign)


@dataclass(frozen=True)
class _Joints:
    """Joints of arcs (m,): each is `off`, mm, outside the curve's point at `t`, along the arcs' normal.

    Their tangent is the curve's turned left by `lean`, rad.
    """

    t: Array
    off: Array
    lean: Array


@dataclass(frozen=True)
class _Arcs:
    """Arcs between joints, and the curve's `frame` at the joints (m,).

    Each has its chord (n, 2), the chord's length (n,), mm, and `miss` (n,), mm: the chord's length times the sine of
    half the angle between the arc's end and its joint's tangent.
    """

    frame: Frame
    chain: Chain
    chord: Array
    length: Array
    miss: Array


@dataclass(frozen=True)
class _Peaks:
    """Extremes of each arc's deviation (n, 2): height, mm, its extrapolated part `doubt`, and move ahead in parameter.

    `foot` (n, 2, 2) is the foot on the arc, from the arc's start, mm.
    """

    height: Array
    doubt: Array
    move: Array
    foot: Array


def free_arcs(curve: Curve, parts: Sequence[MonotonePart], aim: float, limit: float) -> list[FittedArcs | None]:
    """Arcs with free joints along each part of a curve, sampled errors up to `aim` and proved ones up to `limit`, mm.

    Each part's arcs begin and end on the curve, in its direction; None for a part without arcs that hold. The time
    grows with the number of arcs, so large numbers are not tried repeatedly.
    """
    done: list[FittedArcs | None] = [None] * len(parts)
    unit = float(np.finfo(np.float64).eps) * curve.size
    enough = JOINED * unit
    parts = refine(curve, parts, aim)
    counts = {i: part.count(max(aim - NOISE * unit, 0.5 * aim)) for i, part in enumerate(parts)}
    tried = 0
    for _ in range(RAISED):
        if not counts or tried > MOST_ARCS:
            break
        tried += sum(counts.values())
        todo = list(counts)
        layout = _Layout.of([counts[i] for i in todo], [parts[i].rising for i in todo])
        t = np.concatenate([parts[i].nodes(counts[i]) for i in todo])
        joints, frame, level = _level_out(curve, layout, t, aim)
        arcs = _close(layout, joints, frame, enough)
        holds = (level <= aim)[layout.part] & (np.abs(arcs.miss) <= enough)
        inside, outside = np.full(holds.size, -np.inf), np.full(holds.size, np.inf)
        if holds.any():
            chain = arcs.chain
            rows = (chain.start, chain.tangent, chain.curvature, chain.low, chain.high)
            deviation = chain_deviation(curve, Chain(*(row[holds] for row in rows)), limit, PROOF_LOOKS)
            inside[holds], outside[holds] = deviation.inside, deviation.outside
        bulges = _bulges(arcs)
        # parts that hold are done; others take more arcs, as their level foresees
        for place, i in enumerate(todo):
            own = layout.part == place
            # where the curve lies outside an arc the file lies inward of the curve
            outward, inward = max(-float(inside[own].min()), 0.0), max(float(outside[own].max()), 0.0)
            if max(outward, inward) <= limit:
                done[i] = FittedArcs(arcs.chain.start[own], bulges[own], outward, inward)
                del counts[i]
                continue
            more = counts[i] + 1.0
            if math.isfinite(level[place]):
                more = max(more, (counts[i] - ENDS) * math.cbrt(float(level[place]) / aim) + ENDS)
            counts[i] = math.ceil(min(more, MOST_RAISED * counts[i]))
    return done


def _level_out(curve: Curve, layout: _Layout, t: Array, aim: float) -> tuple[_Joints, Frame, Array]:
    """Joints of arcs with level deviations, the curve's frames at them, and each part's greatest sampled deviation.

    The arcs' misses count as deviation, and so does a share of the extrapolated part. Parts that hold `aim` stay as
    they are.
    """
    # shares of each arc at which its extremes are expected
    left, right = layout.left, layout.left + 1
    side = np.where(layout.right_end, -1, 1)
    places = np.tile([INNER, 1.0 - INNER], (left.size, 1))
    places[layout.ends[left], 1] = OUTER
    places[layout.ends[right], 0] = 1.0 - OUTER
    joints = _first_joints(curve, layout, t, side)
    begin = np.flatnonzero(np.diff(layout.part, prepend=-1))
    foreseen = np.zeros(begin.size)
    for step in range(STEPS + 1):
        # arcs and their extremes, which are followed as they move
        span = (joints.t[right] - joints.t[left])[:, None]
        looks = (joints.t[left][:, None] + places * span).ravel()
        frames = curve.sample(np.append(joints.t, looks), np.append(side, np.ones(looks.size, dtype=np.intp)))
        frame, peak_frames = frames.split(side.size)
        arcs = _arcs(layout, joints, frame)
        peaks = _peaks(layout, arcs, peak_frames)
        places = np.clip(places + np.clip(peaks.move / span, -0.1, 0.1), 0.02, 0.98)
        unsure = np.abs(arcs.miss) + DOUBT * np.abs(peaks.doubt).max(axis=1)
        level = np.maximum.reduceat(np.abs(peaks.height).max(axis=1) + unsure, begin)
        # settled: a part within the aim, or one near the level that Newton's method foresaw where that is above the aim
        settled = (level <= aim) | ((level <= LEVEL * foreseen) & (foreseen > aim))
        if settled.all() or step == STEPS:
            break
        change, foreseen = _newton(layout, joints, arcs, peaks, aim)
        change[settled[layout.part_of_joint]] = 0.0
        joints = _move_joints(layout, joints, arcs, change)
    return joints, frame, level


def _first_joints(curve: Curve, layout: _Layout, t: Array, side: NDArray[np.intp]) -> _Joints:
    """Joints on the curve at `t` (m,), with the lean ``-kappa' L^2 / 12``, 0 at the ends of parts."""
    frame = curve.sample(t, side)
    chord = frame.point[layout.left + 1] - frame.point[layout.left]
    square = _lesser_at_joints(layout, np.sum(chord * chord, axis=1))
    lean = np.where(layout.ends, 0.0, frame.curvature_slope * square / -12.0)
    return _Joints(t, np.zeros_like(t), lean)


def _lesser_at_joints(layout: _Layout, value: Array) -> Array:
    """The lesser value (n,) of the two arcs at each joint (m,)."""
    least = np.full(layout.ends.size, np.inf)
    least[layout.left] = value
    least[layout.left + 1] = np.minimum(least[layout.left + 1], value)
    return least


def _arcs(layout: _Layout, joints: _Joints, frame: Frame) -> _Arcs:
    """Arcs that leave each joint along its direction and reach the next one."""
    sine, cosine = np.sin(joints.lean)[:, None], np.cos(joints.lean)[:, None]
    tangent = cosine * frame.tangent - sine * frame.normal
    point = frame.point + joints.off[:, None] * (cosine * frame.normal + sine * frame.tangent)
    left, right = layout.left, layout.left + 1
    start, along = point[left], tangent[left]
    chord = point[right] - start
    square = np.sum(chord * chord, axis=1)
    curvature = 2.0 * cross(along, chord) / square
    mean = along + tangent[right]
    mean /= np.hypot(mean[:, 0], mean[:, 1])[:, None]
    chain = Chain(start, along, curvature, joints.t[left], joints.t[right])
    return _Arcs(frame, chain, chord, np.sqrt(square), cross(chord, mean))


def _peaks(layout: _Layout, arcs: _Arcs, frame: Frame) -> _Peaks:
    """Extremes of the curve's distance outside the arcs, extrapolated from a frame near each (2n)."""
    chain = arcs.chain
    point = frame.point.reshape(-1, 2, 2)
    f, away = radial(chain.start[:, None], chain.tangent[:, None], chain.curvature[:, None], point)
    angle = -np.sum(frame.tangent.reshape(-1, 2, 2) * away, axis=2)
    speed, turn = frame.speed.reshape(-1, 2), frame.turn.reshape(-1, 2)
    # f' = -sigma angle, f'' = -sigma bend
    bend = turn - chain.curvature[:, None] * speed
    sharp = layout.sign * bend > 0.0
    move = np.where(sharp, -angle / np.where(sharp, bend, 1.0), 0.0)
    doubt = np.where(layout.sign != 0.0, -0.5 * speed * angle * move, 0.0)
    height = np.where(layout.sign != 0.0, f + doubt, 0.0)
    foot = point - f[..., None] * away - chain.start[:, None]
    return _Peaks(height, doubt, move, foot)


def _newton(layout: _Layout, joints: _Joints, arcs: _Arcs, peaks: _Peaks, aim: float) -> tuple[Array, Array]:
    """A step of Newton's method: moves of each joint along the curve and off it, mm, and its turn, rad (m, 3).

    With it comes the level foreseen for each part, mm. An arc through its two joints and along the direction of the
    first moves off the curve as the heights h0, h1 of its joints and the direction g0 change, by ``(1 - w) h0 + w h1 +
    (x - s w) g0`` at a foot ahead by x, s the chord's length along the first direction. A move of a joint along the
    curve changes its height by its lean, and its direction by the difference of the curvatures.
    """
    chain, left, right = arcs.chain, layout.left, layout.left + 1
    curvature = arcs.frame.curvature
    reach = _lesser_at_joints(layout, arcs.length)
    scale = np.column_stack([ALONG * reach, np.full(reach.size, aim), aim / reach])
    cosine = np.sum(chain.tangent * arcs.chord, axis=1) / arcs.length  # of half an arc's turn
    ahead = arcs.length * cosine
    lever = 0.5 * arcs.length / cosine  # from an arc's ends to where its tangents there meet
    bend0, bend1 = curvature[left] - chain.curvature, curvature[right] - chain.curvature
    lean0, lean1 = joints.lean[left], joints.lean[right]
    # sine of half the angle between an arc's end and its right joint's direction
    ones, kink = np.ones_like(lean0), arcs.miss / arcs.length
    # a row for the miss and for both extremes of each arc; columns: moves of its left joint, of its right one, the
    # level, the right-hand side
    rows = np.zeros((left.size, 3, 8))
    rows[:, 0, 0:3] = np.column_stack([lever * bend0 - lean0 - kink, -ones, lever])
    rows[:, 0, 3:6] = np.column_stack([lever * bend1 + lean1 - kink, ones, lever])
    rows[:, 0, 7] = -arcs.miss / cosine
    # w and x of the two extremes of each arc
    w = np.sum(peaks.foot**2, axis=2) / (arcs.length**2)[:, None]
    x = np.sum(peaks.foot * chain.tangent[:, None], axis=2) - ahead[:, None] * w
    rows[:, 1:, 0] = x * bend0[:, None] - (1.0 - w) * lean0[:, None]
    rows[:, 1:, 1] = w - 1.0
    rows[:, 1:, 2] = x
    rows[:, 1:, 3] = -w * (lean1 - 2.0 * kink)[:, None]
    rows[:, 1:, 4] = -w
    rows[:, 1:, 6] = -layout.sign * aim
    rows[:, 1:, 7] = -peaks.height
    rows[:, 1:][layout.sign == 0.0] = 0.0
    rows[:, :, 0:3] *= scale[left][:, None]
    rows[:, :, 3:6] *= scale[right][:, None]
    change, level = solve_chains(rows / aim, layout.part)
    return change * scale, level * aim


def _move_joints(layout: _Layout, joints: _Joints, arcs: _Arcs, change: Array) -> _Joints:
    """Joints moved by `change` (m, 3); a part's by a share if one would go too far, not at all if one is nan."""
    move = change[:, 0] / arcs.frame.speed
    reach = MOST_MOVE * _lesser_at_joints(layout, arcs.chain.high - arcs.chain.low)
    share = np.where(np.isfinite(change).all(axis=1), reach / np.maximum(np.abs(move), reach), 0.0)
    begin = np.flatnonzero(np.diff(layout.part_of_joint, prepend=-1))
    share = np.minimum.reduceat(share, begin)[layout.part_of_joint]
    move, off, lean = np.where(share > 0.0, share * np.stack([move, change[:, 1], change[:, 2]]), 0.0)
    return _Joints(joints.t + move, joints.off + off, joints.lean + lean)


def _close(layout: _Layout, joints: _Joints, frame: Frame, enough: float) -> _Arcs:
    """Arcs that join in tangent to within `enough` mm, their joints where they were along the curve.

    Of all changes of offsets and leans that close the arcs the least is taken. Leans are weighed so that an arc's
    change of a joint leaves the next arc's miss as it is: for levers a, b of the arcs on both sides of the joint,
    ``lean^2 a b + off^2`` is to be least.
    """
    left, right = layout.left, layout.left + 1
    free = np.where(layout.ends, 0.0, 1.0)
    arcs = _arcs(layout, joints, frame)
    # each arc's miss is taken off by its two joints: `effect` is what they take off together for a pull of 1
    for _ in range(CLOSING):
        if not float(np.abs(arcs.miss).max()) > enough:
            break
        cosine = np.sum(arcs.chain.tangent * arcs.chord, axis=1) / arcs.length  # of half an arc's turn
        lever = 0.5 * arcs.length / cosine
        product = np.ones_like(free)
        product[left] *= lever
        product[right] *= lever
        lightness = free / product
        effect = free[left] + free[right] + lever**2 * (lightness[left] + lightness[right])
        pull = arcs.miss / (cosine * effect)
        off, lean = joints.off.copy(), joints.lean.copy()
        off[left] += free[left] * pull
        off[right] -= free[right] * pull
        lean[left] -= lightness[left] * lever * pull
        lean[right] -= lightness[right] * lever * pull
        joints = _Joints(joints.t, off, lean)
        arcs = _arcs(layout, joints, frame)
    return arcs


def _bulges(arcs: _Arcs) -> Array:
    """Tangents of a quarter of each arc's angle (n,)."""
    along = arcs.chain.tangent
    cosine = np.sum(along * arcs.chord, axis=1) / arcs.length
    bulges: Array = (cross(along, arcs.chord) / arcs.length) / (1.0 + cosine)
    return bulges


def cross(a: Array, b: Array) -> Array:
    """Cross products (n,) of vectors (n, 2): above 0 where b points left of a."""
    area: Array = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return area
