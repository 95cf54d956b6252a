"""The contour that is left where a profile undercuts: the metal that no position of the follower cuts away.

A point q of the metal stands if no contact position cuts it away. For a contour point z(s) with the outward normal N
and a follower of curvature k (a roller of radius e: k = 1/e; a flat face: k = 0) that is

    g(q, s) = k/2 |q - z|^2 - (q - z).N >= 0        for every s,

the disc about z + N/k, or the half plane beyond the tangent. Along s, ``dg/ds = -(k sigma + omega) (q - z).T``. The
metal that stands is bounded by stretches of the contour and by corners in which the contour crosses itself.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.backwards import backwards, runs_backwards
from camgeo.curve.curvature import ROUNDING, roots
from camgeo.curve.curve import SHIFT, Curve, SmoothRun, cyclic_gap
from camgeo.curve.undercut.causes import UndercutError, causes, follower_radius, in_ring
from camgeo.curve.undercut.self_intersection import (
    SHORT,
    all_breaks,
    displacement,
    in_parts,
    newton_crossings,
    polygon_crossings,
)
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Frame
    from camgeo.curve.undercut.causes import Causes
    from kin.numeric.arrays import Array

NODES = 480  # of the polygon on which crossings are sought first
MOST_TANGLED = 40  # stretches that run backwards whose crossings are sought all over: time grows with their square
ROUNDS = 3  # of the search for crossings, each with twice the nodes
NEAR_BY = 0.03  # of a reversal's length: distance of the first node beside it; following distances grow
GROWTH = 1.35  # from node to node
STARTS = (0.366, 0.05, 1.0)  # a swallowtail reaches (sqrt 3 - 1)/2 of its reversal beyond it, where sigma is a parabola
ZOOMS = 4  # about the greatest depth found


@dataclass(frozen=True)
class Corner:
    """A corner of the contour that stands: it is left at one parameter and entered at another, both at `point` (2,)."""

    leave: float
    enter: float
    point: Array


@dataclass(frozen=True)
class LostStretch:
    """Parameters `start` to `end` at which the follower touches nothing, with the corners at both ends (m, 2).

    m is 1 where both ends meet, 2 at a neck, 0 where nothing at all is left. `depth` is how far the follower hangs
    free at the worst, in mm along its normal, infinite where nothing is left.
    """

    start: float
    end: float
    corners: Array
    depth: float


@dataclass(frozen=True)
class Remains:
    """The contour left: lost stretches in order, corners between the kept ones, and the number of pieces of metal."""

    lost: tuple[LostStretch, ...]
    corners: tuple[Corner, ...]
    pieces: int


def trimmed(curve: Curve) -> Curve:
    """Contour that is left of a whole curve where it undercuts: several runs that meet in corners, round the shaft.

    It is the curve itself if it does not undercut. Raises UndercutError where nothing is left, the metal falls into
    pieces, the shaft is not inside, or the crossings cannot be separated; CurveError where undercut can be neither
    proved nor excluded; ValueError for a concave curve under a flat face.
    """
    if not in_ring(curve):
        return _trim(curve, 1)
    try:
        reverse = _trim(backwards(curve), -1)
    except UndercutError as error:
        raise error.mirrored() from error
    return curve if reverse.closed else Curve(curve.shape, runs_backwards(reverse.runs))


def _trim(curve: Curve, sense: int) -> Curve:
    """The contour left of a curve that goes round the shaft in a sense, 1 or -1.

    Raises UndercutError where nothing is left, the metal falls into pieces, the shaft is not inside, or the crossings
    cannot be separated.
    """
    reasons = causes(curve)
    if reasons.none:
        return curve
    remainder = remains(curve, reasons)
    place = next((0.5 * (r.start + r.end) for r in reasons.reversals), None)
    if not remainder.corners:
        raise UndercutError("the undercut leaves nothing of the contour", place)
    if remainder.pieces > 1:
        middle = 0.5 * (remainder.lost[0].start + remainder.lost[0].end)
        raise UndercutError(f"the undercut divides the metal into {remainder.pieces} pieces", middle)
    contour = Curve(curve.shape, kept_runs(curve, remainder))
    if _turns(contour) != sense:
        raise UndercutError("the shaft lies outside of what the undercut leaves", place)
    return contour


def remains(curve: Curve, reasons: Causes) -> Remains:
    """The contour left of a curve that undercuts, for its causes; raises UndercutError for inseparable crossings.

    Every corner is checked against all contact positions. Where the pitch curve is convex, and for a flat face, that
    settles the whole contour: kept stretches run forward and turn once round, so they bound the body of the half planes
    beyond them, and no face between two of them cuts into it. A hollow pitch curve is checked at the nodes as well,
    a fine grid, without proof between them; a missed cut shows when the file is judged.
    """
    contact = _Contact.of(curve)
    plain = _swallowtails(curve, contact, reasons)
    if plain is not None:
        return plain
    reverse = sum(not r.still for r in reasons.reversals)
    if reverse > MOST_TANGLED * curve.shape.repeats:
        message = (
            f"{reverse} stretches of the contour run backwards into each other; up to {MOST_TANGLED} are separated"
        )
        raise UndercutError(message, reasons.reversals[0].start)
    # crossings of a polygon and guesses are refined on the curve, until those that stand explain all that is lost
    for turn in range(ROUNDS):
        nodes = _nodes(curve, reasons, NODES << turn)
        frames = curve.sample(nodes)
        own = int(np.searchsorted(nodes, _first_part(curve)))
        guesses = np.concatenate(
            [polygon_crossings(nodes, frames.point, curve.shape.period, own), _guesses(curve, reasons)]
        )
        corners = contact.standing(_corners_at(curve, newton_crossings(curve, guesses, contact.size)), nodes, frames)
        still = [r for r in reasons.reversals if r.still]  # arcs of radius 0
        points = [Corner(r.start, r.end, curve.sample(np.array([r.start])).point[0]) for r in still]
        corners = _images(curve, corners) + contact.standing(points, nodes, frames)
        stretches = _lost_stretches(curve, corners)
        if stretches is not None and _explained(stretches, contact, reasons, nodes, frames):
            return _with_depths(curve, contact, corners, stretches)
    place = reasons.reversals[0].start if reasons.reversals else reasons.necks[0].first
    raise UndercutError(f"the crossings of the undercut contour near parameter {place:.9g} cannot be separated", place)


def _swallowtails(curve: Curve, contact: _Contact, reasons: Causes) -> Remains | None:
    """The contour left where each reversal is cut off by a crossing of its own, apart from all others; else None.

    Without a hollow in the pitch curve that settles it: what is kept runs forward and turns once round in left corners,
    so it bounds a convex body. Many small swallowtails, equal but for rounding, are separated by this alone.
    """
    convex = bool((curve.cells.rows[2] >= 0.0).all())
    if not convex or reasons.necks or not reasons.reversals or any(r.still for r in reasons.reversals):
        return None
    # one crossing about each reversal, from guesses at its width
    period = curve.shape.period
    starts = np.array([r.start for r in reasons.reversals])
    ends = np.array([r.end for r in reasons.reversals])
    crossings = np.full((len(starts), 2), np.nan)
    for share in STARTS:
        open_ = np.flatnonzero(np.isnan(crossings[:, 0]))
        extra = share * (ends - starts)[open_]
        pairs = newton_crossings(curve, np.column_stack([starts[open_] - extra, ends[open_] + extra]), contact.size)
        numbers = np.searchsorted(starts, pairs[:, 0], side="right")  # the reversal after the first of the two
        for (low, high), number in zip(pairs.tolist(), numbers.tolist(), strict=True):
            shift, i = (period, 0) if number == len(starts) else (0.0, number)
            if low - shift < starts[i] and ends[i] < high - shift and np.isnan(crossings[i, 0]):
                crossings[i] = low - shift, high - shift
    # none missing, none within another, and the contour turns left in each
    following = np.append(crossings[1:, 0], crossings[0, 0] + period)
    if np.isnan(crossings).any() or not (crossings[:, 1] < following).all():
        return None
    leaving, entering = curve.sample(crossings[:, 0], -1), curve.sample(crossings[:, 1])
    if not (
        leaving.tangent[:, 0] * entering.tangent[:, 1] - leaving.tangent[:, 1] * entering.tangent[:, 0] > 0.0
    ).all():
        return None
    middle = 0.5 * (leaving.point + entering.point)
    corners = [Corner(low, high, point) for (low, high), point in zip(crossings.tolist(), middle, strict=True)]
    base = curve.runs[0].low
    turns = np.floor((crossings[:, 0] - base) / period) * period
    stretches = sorted(
        ((i, i, low, high) for i, (low, high) in enumerate((crossings - turns[:, None]).tolist())), key=lambda s: s[2]
    )
    return _with_depths(curve, contact, corners, stretches)


@dataclass(frozen=True)
class _Contact:
    """The follower's curvature k and the curve's size, mm, which sets what rounding may hide."""

    curve: Curve
    k: float
    size: float

    @staticmethod
    def of(curve: Curve) -> _Contact:
        radius = follower_radius(curve)
        frame = curve.sample(curve.cells.low)
        return _Contact(curve, 1.0 / radius, float(max(np.abs(frame.point).max(), np.abs(frame.speed).max())))

    @property
    def tolerance(self) -> float:
        return 4.0 * ROUNDING * self.size

    def clearance(self, apart: Array, normal: Array) -> Array:
        """The function g of q - z (..., 2) and N (..., 2), mm; below 0 where q is cut away."""
        g: Array = 0.5 * self.k * np.sum(apart * apart, axis=-1) - np.sum(apart * normal, axis=-1)
        return g

    def cut(self, frames: Frame, own: int) -> NDArray[np.bool_]:
        """Whether the first `own` contour points (n,) are cut away by contact at any of them (own,)."""
        least = np.empty(own)
        for rows in in_parts(own, len(frames.point)):
            least[rows] = self.clearance(frames.point[rows, None] - frames.point[None], frames.normal[None]).min(axis=1)
        return np.asarray(least < -self.tolerance)

    def standing(self, corners: list[Corner], nodes: Array, frames: Frame) -> list[Corner]:
        """Corners that no contact position cuts away; the least g between nodes is found wherever it lies."""
        if not corners:
            return []
        # g has a least value where (q - z).T falls through 0
        points = np.array([c.point for c in corners])
        apart = points[:, None] - frames.point[None]
        along = np.sum(apart * frames.tangent[None], axis=2)
        cut = np.asarray(self.clearance(apart, frames.normal[None]).min(axis=1) < -self.tolerance)
        corner, where = np.nonzero((along > 0.0) & (np.roll(along, -1, axis=1) < 0.0) & ~cut[:, None])
        period = self.curve.shape.period
        after = np.append(nodes[1:], nodes[0] + period)

        def facing(t: Array) -> Array:
            frame = self.curve.sample(t)
            return np.asarray(np.sum((points[corner] - frame.point) * frame.tangent, axis=1))

        values = along[corner, where], along[corner, (where + 1) % nodes.size]
        frame = self.curve.sample(roots(facing, nodes[where], after[where], values, 1e-9))
        low = self.clearance(points[corner] - frame.point, frame.normal) < -self.tolerance
        cut[corner[low]] = True
        return [c for c, is_cut in zip(corners, cut.tolist(), strict=True) if not is_cut]


def _nodes(curve: Curve, reasons: Causes, count: int) -> Array:
    """Parameters over one period (n,), close together beside reversals and necks."""
    run, period = curve.runs[0], curve.shape.period
    coarse = period / count
    parts = [np.linspace(run.low, run.high, count + 1)[:-1], np.array(run.breaks)]

    def beside(parameter: float, first: float, side: int) -> Array:
        steps = math.ceil(math.log(max(2.0 * coarse / first, 1.0)) / math.log(GROWTH)) + 1
        return np.asarray(parameter + side * first * GROWTH ** np.arange(steps, dtype=np.float64))

    # nodes within a reversal and ever farther apart on both sides of it, and likewise beside both ends of a neck
    for reversal in reasons.reversals:
        width = reversal.end - reversal.start
        parts.append(np.linspace(reversal.start, reversal.end, 9))
        first = max(NEAR_BY * width, 1e-13 * period)
        parts += [beside(reversal.start, first, -1), beside(reversal.end, first, 1)]
    for neck in reasons.necks:
        for end in (neck.first, neck.second):
            parts += [np.array([end]), beside(end, 1e-6 * period, -1), beside(end, 1e-6 * period, 1)]
    t = np.sort(run.low + np.mod(np.concatenate(parts) - run.low, period))
    apart: Array = t[np.append(True, np.diff(t) > 1e-14 * period)]
    return apart


def _first_part(curve: Curve) -> float:
    """Parameter just beyond the end of the first of the curve's equal parts."""
    part: float = curve.shape.period / curve.shape.repeats
    return curve.runs[0].low + part * (1.0 + SHIFT)


def _images(curve: Curve, corners: list[Corner]) -> list[Corner]:
    """Corners that begin in the curve's first part, with their images in the other parts."""
    if curve.shape.repeats == 1 or not corners:
        return corners
    turns = curve.shape.period / curve.shape.repeats * np.arange(curve.shape.repeats)
    pairs = np.array([(c.leave, c.enter) for c in corners])
    return _corners_at(curve, (turns[:, None, None] + pairs).reshape(-1, 2))


def _guesses(curve: Curve, reasons: Causes) -> Array:
    """Guessed crossings (m, 2), as if a reversal's speed were a parabola and a neck's sides circles.

    Of crossings that are images of each other in the curve's equal parts at least one is guessed.
    """
    last = _first_part(curve)
    guesses = [
        (r.start - share * (r.end - r.start), r.end + share * (r.end - r.start))
        for r in reasons.reversals
        if not r.still and r.start <= last
        for share in STARTS
    ]
    for neck in reasons.necks:
        if curve.runs[0].low + (min(neck.first, neck.second) - curve.runs[0].low) % curve.shape.period > last:
            continue
        ends = curve.sample(np.array([neck.first, neck.second]))
        # sides that part as circles are a roller's diameter apart at the distance `reach` along the curve
        opening = -float(ends.curvature.sum())
        if opening > 0.0:
            reach = math.sqrt(4.0 * max(follower_radius(curve) - neck.half, 0.0) / opening)
            t, s = reach / ends.speed
            guesses += [(neck.first - t, neck.second + s), (neck.first + t, neck.second - s)]
    return np.array(guesses).reshape(-1, 2)


def _corners_at(curve: Curve, pairs: Array) -> list[Corner]:
    """Corners at crossings (m, 2), each once; the contour turns left in them."""
    leaving, entering = curve.sample(pairs[:, 0], -1), curve.sample(pairs[:, 1])
    left = leaving.tangent[:, 0] * entering.tangent[:, 1] - leaving.tangent[:, 1] * entering.tangent[:, 0] > 0.0
    corners: list[Corner] = []
    period = curve.shape.period
    for i, (t, s) in enumerate(pairs.tolist()):
        leave, enter = (t, s) if left[i] else (s, t)
        # for a swallowtail that is lost in rounding, guesses converge a little apart
        near = 1e-2 * cyclic_gap(s, t, period)
        if not any(
            cyclic_gap(leave, c.leave, period) < near and cyclic_gap(enter, c.enter, period) < near for c in corners
        ):
            corners.append(Corner(leave, enter, 0.5 * (leaving.point[i] + entering.point[i])))
    return corners


def _lost_stretches(curve: Curve, corners: list[Corner]) -> list[tuple[int, int, float, float]] | None:
    """Indices of the leaving and the next entering corner, and their parameters, of each lost stretch.

    None if leaving and entering do not alternate.
    """
    low, period = curve.runs[0].low, curve.shape.period
    if not corners:
        return []
    events = sorted(
        [(low + (c.leave - low) % period, True, i) for i, c in enumerate(corners)]
        + [(low + (c.enter - low) % period, False, i) for i, c in enumerate(corners)]
    )
    if events[0][1] is False:
        place, _, i = events.pop(0)
        events.append((place + period, False, i))
    pairs = list(zip(events[::2], events[1::2], strict=True))
    if not all(start[1] and not end[1] for start, end in pairs):
        return None
    return [(start[2], end[2], start[0], end[0]) for start, end in pairs]


def _explained(
    stretches: list[tuple[int, int, float, float]], contact: _Contact, reasons: Causes, nodes: Array, frames: Frame
) -> bool:
    """Whether every cause and every node that is cut away lies within a lost stretch, and nothing else is lost."""
    period = contact.curve.shape.period
    own = int(np.searchsorted(nodes, _first_part(contact.curve)))
    cut = contact.cut(frames, own)
    if not stretches:
        # without corners all must be lost; a node where the contour runs backwards may be cut by less than rounding
        return bool((cut | (frames.speed[:own] < 0.0)).all())
    causes_at = [0.5 * (r.start + r.end) for r in reasons.reversals] + [n.first for n in reasons.necks]
    doubtful = np.concatenate([nodes[:own][cut], np.array(causes_at)])
    inside = np.zeros(doubtful.size, dtype=bool)
    for _, _, start, end in stretches:
        slack = 1e-9 * period
        inside |= (doubtful - (start - slack)) % period <= end - start + 2.0 * slack
    return bool(inside.all())


def _with_depths(
    curve: Curve, contact: _Contact, corners: list[Corner], stretches: list[tuple[int, int, float, float]]
) -> Remains:
    if not stretches:
        low, period = curve.runs[0].low, curve.shape.period
        return Remains((LostStretch(low, low + period, np.empty((0, 2)), math.inf),), (), 0)
    lost: list[LostStretch] = []
    own = len(stretches) // curve.shape.repeats if len(stretches) % curve.shape.repeats == 0 else len(stretches)
    for first, last, start, end in stretches:
        points = np.array([corners[i].point for i in sorted({first, last})])
        # the curve's parts are alike: so are the stretches lost from them
        alike = len(lost) >= own
        depth = lost[len(lost) - own].depth if alike else _depth(curve, contact, points, start, end)
        lost.append(LostStretch(start, end, points, depth))
    # the corner in which the run after each corner ends
    follows = {now[1]: then[0] for now, then in zip(stretches, stretches[1:] + stretches[:1], strict=True)}
    unseen, pieces = set(follows), 0
    while unseen:
        pieces += 1
        corner = next(iter(unseen))
        while corner in unseen:
            unseen.remove(corner)
            corner = follows[corner]
    return Remains(tuple(lost), tuple(corners), pieces)


def _depth(curve: Curve, contact: _Contact, points: Array, start: float, end: float) -> float:
    """Greatest distance of the follower from the nearest of the corners (m, 2) between two parameters, mm."""
    low, high, best = start, end, 0.0
    for _ in range(ZOOMS):
        t = np.linspace(low, high, 66)[1:-1]
        frame = curve.sample(t)
        if points.shape[0] == 1 and end - start <= SHORT * curve.shape.period:
            apart = -displacement(curve, np.full(t.size, start), t)[:, None]
        else:
            apart = points[None] - frame.point[:, None]
        g = contact.clearance(apart, frame.normal[:, None])
        # the distance to the follower whose contact point is missed by g
        free = (2.0 * g / (1.0 + np.sqrt(np.maximum(1.0 + 2.0 * contact.k * g, 0.0)))).min(axis=1)
        worst = int(np.argmax(free))
        best = max(best, float(free[worst]))
        step = t[1] - t[0]
        low, high = max(start, t[worst] - step), min(end, t[worst] + step)
    return best


def kept_runs(curve: Curve, remainder: Remains) -> tuple[SmoothRun, ...]:
    """Kept runs in order, from the end of each lost stretch to the beginning of the next.

    Raises UndercutError where a run is so short that it is lost in rounding.
    """
    period = curve.shape.period
    runs = []
    for lost, following in zip(remainder.lost, remainder.lost[1:] + remainder.lost[:1], strict=True):
        low = lost.end
        high = low + (following.start - low) % period
        inside = all_breaks(curve, low, high)
        # a break within rounding of a corner is the corner
        close = 64.0 * np.spacing(max(abs(low), abs(high)))
        for b in inside.tolist():
            low, high = (b if b - low <= close else low), (b if high - b <= close else high)
        inside = inside[(inside > low) & (inside < high)]
        if high - low <= 1e-12 * period:
            raise UndercutError(f"what is left of the contour near parameter {low:.9g} is lost in rounding", low)
        runs.append(SmoothRun(low, high, tuple(inside.tolist()), closed=False))
    # runs begin within the curve's own first period
    shift = period if runs[0].low >= curve.runs[0].low + period else 0.0
    if shift:
        runs = [
            SmoothRun(run.low - shift, run.high - shift, tuple(b - shift for b in run.breaks), run.closed)
            for run in runs
        ]
    return tuple(sorted(runs, key=lambda run: run.low))


def _turns(curve: Curve) -> int:
    """Number of turns of the chain of runs round the shaft, above 0 counter-clockwise."""
    points = []
    for run in curve.runs:
        count = max(8, math.ceil(NODES * (run.high - run.low) / curve.shape.period))
        points.append(curve.sample(np.linspace(run.low, run.high, count + 1)[:-1]).point)
    x, y = np.concatenate(points).T
    after_x, after_y = np.roll(x, -1), np.roll(y, -1)
    angle = np.arctan2(x * after_y - y * after_x, x * after_x + y * after_y)
    return round(float(angle.sum()) / (2.0 * math.pi))
