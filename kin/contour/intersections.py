"""Places where a contour crosses or touches itself or another, which a sound contour does not."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import Arcs, cross, dot, left, nearest_on, right
from kin.contour.nearest import nearest
from kin.numeric.bernstein import cross_product

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array, Indices

    Levels = list[tuple[Array, Array]]

# Two pieces closer than this, mm, have a point in common.
TOUCHING = 1e-9
# A loop shorter than this, mm, is the rounding of a joint.
SHORTEST_LOOP = 1e-7
# Boxes under one box of the next level.
BRANCH = 4
# Pairs of boxes that are looked at together, which bounds the memory.
PAIRS_AT_ONCE = 500_000
# Crossings, or common points, after which the search ends: the verdict is clear.
ENOUGH = 200


class Crossings(NamedTuple):
    """Common points (k, 2), mm, and the indices of the two pieces that have each in common (k, 2)."""

    point: Array
    piece: Indices


def crossings(contour: Contour) -> Crossings:
    """Points at which the contour crosses, touches or covers itself, to 1e-9 mm; joints of pieces do not count.

    A convex contour, or one seen whole from its middle or from the origin, has none, without further work. Else pieces
    whose boxes overlap are found by descending a tree of boxes against itself, and intersected in closed form. The
    search ends early once it has hundreds. Raises ValueError where the contour's `arcs_within` is below rounding.
    """
    nothing = Crossings(np.zeros((0, 2)), np.zeros((0, 2), dtype=np.intp))
    if contour.is_convex or seen_whole(contour, contour.start.mean(axis=0)) or seen_whole(contour, np.zeros(2)):
        return nothing
    chain, owner = contour.as_arcs()
    before = np.concatenate([[0.0], np.cumsum(chain.length)])
    crossings = []
    levels = boxes(chain)
    for i, j in overlapping(levels, levels, mirrored=True):
        shared = common_points(chain, chain, i, j)
        first, second = i[shared.pair], j[shared.pair]
        apart = before[second] + shared.second - before[first] - shared.first
        loop = np.minimum(apart, before[-1] - apart) > SHORTEST_LOOP
        crossings.append((shared.point[loop], np.stack([owner[first[loop]], owner[second[loop]]], axis=1)))
        if sum(len(p) for p, _ in crossings) > ENOUGH:
            break
    return distinct(crossings)


def meetings(contour: Contour, other: Contour) -> Crossings:
    """Points that two contours have in common, to 1e-9 mm, with the piece of the first and of the other; some hundreds.

    Raises ValueError where the `arcs_within` of a contour is below rounding.
    """
    first, first_owner = contour.as_arcs()
    second, second_owner = other.as_arcs()
    meetings = []
    for i, j in overlapping(boxes(first), boxes(second), mirrored=False):
        shared = common_points(first, second, i, j)
        meetings.append((shared.point, np.stack([first_owner[i[shared.pair]], second_owner[j[shared.pair]]], axis=1)))
        if sum(len(p) for p, _ in meetings) > ENOUGH:
            break
    return distinct(meetings)


def first_meeting(contours: list[Contour]) -> tuple[float, float] | None:
    """A point (x, y), mm, that the boundaries of two contours have in common; None if they all keep apart.

    Raises ValueError where the `arcs_within` of a contour is below rounding.
    """
    boxes = np.array([contour.box for contour in contours]).reshape(-1, 4)
    for k, outline in enumerate(contours[:-1]):
        x_min, y_min, x_max, y_max = boxes[k]
        later = boxes[k + 1 :]
        near = (later[:, 0] <= x_max + TOUCHING) & (later[:, 2] >= x_min - TOUCHING)
        near &= (later[:, 1] <= y_max + TOUCHING) & (later[:, 3] >= y_min - TOUCHING)
        candidates = [contours[k + 1 + int(j)] for j in np.flatnonzero(near)]
        if not candidates:
            continue
        rough, off = outline.rough
        _, away = nearest(rough, np.array([candidate.start[0] for candidate in candidates]))
        for candidate, distance in zip(candidates, away, strict=True):
            x_min, y_min, x_max, y_max = candidate.box
            if distance - off > np.hypot(x_max - x_min, y_max - y_min):
                continue  # no point of the later contour is so far from its first point
            common = meetings(outline, candidate).point
            if len(common):
                return float(common[0, 0]), float(common[0, 1])
    return None


def distinct(crossings: list[tuple[Array, Indices]]) -> Crossings:
    """Return the points (k, 2) and pairs of pieces (k, 2) of all parts, those of one pair within 1e-7 mm only once.

    A point at the joint of two arcs of one piece is found with both.
    """
    point = np.concatenate([np.zeros((0, 2)), *(p for p, _ in crossings)])
    piece = np.concatenate([np.zeros((0, 2), dtype=np.intp), *(n for _, n in crossings)])
    order = np.lexsort((point[:, 1], point[:, 0], piece[:, 1], piece[:, 0]))
    point, piece = point[order], piece[order]
    new = np.ones(len(point), dtype=bool)
    step = np.abs(np.diff(point, axis=0)).max(axis=1, initial=0.0)
    new[1:] = (np.diff(piece, axis=0) != 0).any(axis=1) | (step > SHORTEST_LOOP)
    return Crossings(point[new], piece[new])


def seen_whole(contour: Contour, eye: Array) -> bool:
    """Whether every ray from the eye (2,) meets the closed contour once: then it cannot cross itself (sufficient).

    The moment x cross x' about the eye stays positive along each piece, and the pieces' angles at the eye add up to one
    turn. Along an arc the moment is bounded from its ends by its greatest slope |k x.T|; along a Bezier piece it is a
    polynomial, which its Bernstein coefficients bound.
    """
    chain, beziers = contour.plain[0], contour.beziers
    x, ends = chain.start - eye, chain.ends - eye
    at_start, at_end = cross(x, chain.tangent), cross(ends, chain.end_tangents)
    reach = np.maximum(np.hypot(x[:, 0], x[:, 1]), np.hypot(ends[:, 0], ends[:, 1])) + chain.length
    least = (at_start + at_end - np.abs(chain.curvature) * reach * chain.length) / 2.0
    y = (beziers.control - eye) * beziers.weight[:, :, None]
    moment = cross_product(y, beziers.velocity)
    x, ends = np.concatenate([x, y[:, 0]]), np.concatenate([ends, y[:, -1]])
    angle = np.arctan2(cross(x, ends), dot(x, ends))
    once = abs(float(angle.sum()) - 2.0 * np.pi) < 1.0
    return bool((least > 0.0).all() and (moment > 0.0).all() and (angle > 0.0).all()) and once


def boxes(chain: Arcs) -> Levels:
    """Lower and upper corners of boxes about runs of 1, BRANCH, BRANCH^2 ... pieces that turn <= pi, finest first."""
    ends = chain.ends
    sagitta = np.hypot(*(ends - chain.start).T) / 2.0 * np.tan(np.abs(chain.curvature) * chain.length / 4.0)
    margin = sagitta[:, None] + TOUCHING
    low, high = np.minimum(chain.start, ends) - margin, np.maximum(chain.start, ends) + margin
    levels = [(low, high)]
    while len(low) > BRANCH:
        heads = np.arange(0, len(low), BRANCH)
        low, high = np.minimum.reduceat(low, heads), np.maximum.reduceat(high, heads)
        levels.append((low, high))
    return levels


def overlapping(first: Levels, second: Levels, *, mirrored: bool) -> Iterator[tuple[Indices, Indices]]:
    """Batches of indices (k,), (k,) of pieces, one from either tree, whose boxes overlap.

    `mirrored`: both trees are the same, and each pair is given once, with i < j.
    """
    top = max(len(first), len(second)) - 1
    i, j = np.indices((len(first[-1][0]), len(second[-1][0]))).reshape(2, -1)
    stack = [(top, i, j)]
    # pairs of boxes whose descendants are still to be paired; a lower tree waits at its top
    while stack:
        level, i, j = stack.pop()
        if len(i) > PAIRS_AT_ONCE:
            half = len(i) // 2
            stack += [(level, i[half:], j[half:]), (level, i[:half], j[:half])]
            continue
        (a_low, a_high), (b_low, b_high) = (levels[min(level, len(levels) - 1)] for levels in (first, second))
        keep = (a_low[i] <= b_high[j]).all(axis=1) & (b_low[j] <= a_high[i]).all(axis=1)
        if mirrored:
            keep &= (i <= j) if level else (i < j)
        i, j = i[keep], j[keep]
        if not len(i):
            continue
        if level == 0:
            yield i, j
            continue
        a, b = (branches(k, levels, level) for k, levels in ((i, first), (j, second)))
        i, j = (g.ravel() for g in np.broadcast_arrays(a[:, :, None], b[:, None, :]))
        real = (i < len(first[min(level, len(first)) - 1][0])) & (j < len(second[min(level, len(second)) - 1][0]))
        stack.append((level - 1, i[real], j[real]))


def branches(runs: Indices, levels: Levels, level: int) -> Indices:
    """Return indices (k, BRANCH) of the boxes one level down under boxes `runs` (k,); (k, 1) beyond the tree's top."""
    if level >= len(levels):
        return runs[:, None]
    numbers: Indices = runs[:, None] * BRANCH + np.arange(BRANCH)
    return numbers


class Shared(NamedTuple):
    """Common points (p, 2), the index of the pair that has each (p,), and its arc lengths (p,) on both pieces."""

    point: Array
    pair: Indices
    first: Array
    second: Array


def common_points(first: Arcs, second: Arcs, i: Indices, j: Indices) -> Shared:
    """Points common to pieces i of `first` and j of `second`, (k,) each: crossings, and ends of one on the other.

    With y from the start of piece i, right normals m and m' and curvatures k and k', the circles are
    k y^2 + 2 m.y = 0  and  k' y^2 + 2 n.y + c = 0,  n = m' - k' g, g from start to start. The difference of their
    multiples is the line  v.y = w  through both intersections, also where one piece or both are lines.
    """
    a, b = first.take(i), second.take(j)
    gap = b.start - a.start
    m = right(a.tangent)
    m2 = right(b.tangent) - b.curvature[:, None] * gap
    c = b.curvature * dot(gap, gap) - 2.0 * dot(right(b.tangent), gap)
    lines = (a.curvature == 0.0) & (b.curvature == 0.0)
    v = np.where(lines[:, None], m, b.curvature[:, None] * m - a.curvature[:, None] * m2)
    w = np.where(lines, 0.0, a.curvature * c / 2.0)
    # the line is met with the more curved of both circles
    flatter = np.abs(a.curvature) < np.abs(b.curvature)
    k = np.where(flatter, b.curvature, a.curvature)
    m = np.where((flatter | lines)[:, None], m2, m)
    c = np.where(flatter | lines, c, 0.0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        size = np.hypot(v[:, 0], v[:, 1])
        along = left(v) / size[:, None]
        foot = v * (w / size**2)[:, None]
        slope, height = dot(m, along), k * dot(foot, foot) + 2.0 * dot(m, foot) + c
        far = -(slope + np.copysign(np.sqrt(slope**2 - k * height), slope))
        # the roots of  k x^2 + 2 slope x + height = 0  without cancellation: height/far and far/k
        steps = np.stack([height / far, np.where(k == 0.0, np.nan, far / k)])
        crossing = a.start + foot + steps[:, :, None] * along
    # Pieces that cover each other have no crossing, but an end or the middle of one lies on the other.
    covering = (a.start, a.points(a.length / 2.0), a.ends, b.start, b.points(b.length / 2.0), b.ends)
    point = np.concatenate([*crossing, *covering])
    pair = np.tile(np.arange(len(i)), 2 + len(covering))
    near = np.isfinite(point).all(axis=1)
    point, pair = point[near], pair[near]
    s, off = nearest_on(a.take(pair), point)
    t, off2 = nearest_on(b.take(pair), point)
    on = (off <= TOUCHING) & (off2 <= TOUCHING)
    return Shared(point[on], pair[on], s[on], t[on])
