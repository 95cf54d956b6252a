"""How large a disc can roll all round inside a pitch curve: necks between far-apart stretches (docs/theory.md 7).

The disc that touches the curve from inside at x and passes through y has the radius

    R(x, y) = |x - y|^2 / (2 (x - y).N(x)),    N the outward normal;

the least of it over all pairs is the inner reach of the curve (Federer, Curvature measures, 1959, 4.18): the least
radius of curvature, or half of the narrowest double normal, whichever is less. Three facts make the search certain:

- while the tangent stays within a right angle of that at x, an arc of curvature at most 1/R does not enter the disc
  of radius R that touches it at x (the slope ``sin theta`` of the arc as a graph over the tangent is at most s/R); on
  a convex arc this holds up to a half turn (Blaschke's rolling theorem). Such pairs are near and need no search;
- the others are kept in boxes, pairs of intervals, with proved lower bounds of R from the bounds of speed and turn;
- where |x - y|^2 is proved convex over a box, in arc length, its least value is at the double normal itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve import CurveError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve import Array, Curve

NECK_SHARPNESS = 1e-9  # relative: no neck is narrower than the narrowest one found by more than this
LINKS = 96  # about as many intervals make the first boxes
LEVELS = 60
MOST_BOXES = 40_000


@dataclass(frozen=True)
class Neck:
    """A double normal of the pitch curve across its inside: parameters of its ends, and half its length in mm."""

    first: float
    second: float
    half: float


@dataclass(frozen=True)
class Pitch:
    """The curve at `distance` outside a contour: the path of a roller's centre."""

    contour: Curve
    distance: float

    def at(self, t: Array) -> _Points:
        """Points at parameters t (n,)."""
        frame = self.contour.sample(t)
        normal, e = frame.normal, self.distance
        return _Points(
            frame.point + e * normal,
            frame.tangent,
            normal,
            frame.speed + e * frame.turn,
            frame.turn,
            frame.speed_slope + e * frame.turn_slope,
            frame.turn_slope,
        )

    def bounds(self, low: Array, high: Array, points: _Points, t: Array) -> _Bends:
        """Bounds over intervals [low, high] (n,), each about a point at t (n,) of its own."""
        b, e = self.contour.cells.over(low, high), self.distance
        far = np.maximum(t - low, high - t)
        # breaks inside an interval spoil Taylor's series about the point, not the bounds of the cells
        speed_room = np.abs(points.speed_slope) * far + 0.5 * (b.speed_bend + e * b.turn_bend) * far**2
        turn_room = np.abs(points.turn_slope) * far + 0.5 * b.turn_bend * far**2
        broken = self._broken(low, high)
        speed_room[broken], turn_room[broken] = np.inf, np.inf
        least = np.maximum(b.speed_low + e * b.turn_low, points.speed - speed_room)
        most = np.minimum(b.speed_high + e * b.turn_high, points.speed + speed_room)
        turn_low = np.maximum(b.turn_low, points.turn - turn_room)
        turn_high = np.minimum(b.turn_high, points.turn + turn_room)
        # where the speed is not proved to be above 0, nothing is known of the curvature
        least = np.where(least > 0.0, least, np.nan)
        bend_low = np.minimum(turn_low / least, turn_low / most)
        bend_high = np.maximum(turn_high / least, turn_high / most)
        return _Bends(most, turn_low, turn_high, bend_low, bend_high)

    def _broken(self, low: Array, high: Array) -> NDArray[np.bool_]:
        """Whether a break lies inside the intervals (n,)."""
        breaks = np.array(self.contour.runs[0].breaks)
        inside: NDArray[np.bool_] = np.searchsorted(breaks, high) > np.searchsorted(breaks, low, side="right")
        return inside


@dataclass(frozen=True)
class _Points:
    """Points, tangents, outward normals (n, 2); speed, turn and their derivatives (n,) of the pitch curve."""

    point: Array
    tangent: Array
    normal: Array
    speed: Array
    turn: Array
    speed_slope: Array
    turn_slope: Array

    def part(self, chosen: slice) -> _Points:
        """Give a slice of the points."""
        return _Points(
            self.point[chosen],
            self.tangent[chosen],
            self.normal[chosen],
            self.speed[chosen],
            self.turn[chosen],
            self.speed_slope[chosen],
            self.turn_slope[chosen],
        )


@dataclass(frozen=True)
class _Bends:
    """Greatest speed, bounds of turn and of curvature over intervals (n,); curvature nan where it has no bound."""

    speed: Array
    turn_low: Array
    turn_high: Array
    low: Array
    high: Array


@dataclass(frozen=True)
class _Boxes:
    """Pairs of parameter intervals: low and high ends (n, 2)."""

    low: Array
    high: Array


def narrowest_necks(pitch: Pitch, below: float) -> tuple[Neck, ...]:
    """Narrowest necks of a pitch curve, alike within `NECK_SHARPNESS`, if they are narrower than 2 `below` mm.

    `below` must not exceed the curve's least radius of curvature. With nothing found it is proved that R(x, y) is at
    least `below` for all pairs of points (within `NECK_SHARPNESS`; up to rounding of the samples). Raises CurveError
    where the proof does not end, as for two concentric arcs that leave exactly a roller's diameter between them.
    """
    cells = pitch.contour.cells
    if bool((cells.rows[2] >= 0.0).all()):
        return ()  # a convex curve: every pair is near
    boxes = _far_boxes(pitch, below)
    found: list[Neck] = []
    limit = below
    for _ in range(LEVELS):
        if boxes.low.shape[0] == 0:
            return _distinct([n for n in found if n.half < below], limit, pitch.contour.shape.period)
        if boxes.low.shape[0] > MOST_BOXES:
            break
        boxes, limit = _sifted(pitch, boxes, limit, found)
    where = float(boxes.low[0, 0])
    raise CurveError(f"whether a radius of {limit:.9g} mm passes near parameter {where:.9g} cannot be proved", where)


def neck_from(pitch: Pitch, first: float, second: float) -> Neck | None:
    """Double normal across the inside that Newton's method finds from two parameters, None if it finds none."""
    ends = _double_normals(pitch, np.array([[first, second]]))
    neck, inside = _measured(pitch, ends)
    return Neck(float(ends[0, 0]), float(ends[0, 1]), float(neck[0])) if inside[0] else None


def rolling_radius(pitch: Pitch, t: Array, s: Array) -> Array:
    """R(x(t), y(s)) for all pairs, (n, m): infinite where y lies on the outer side of the tangent at x."""
    x, y = pitch.at(t), pitch.at(s)
    d = x.point[:, None] - y.point[None]
    across = np.einsum("nmi,ni->nm", d, x.normal)
    square = np.einsum("nmi,nmi->nm", d, d)
    radius = np.full(across.shape, np.inf)
    np.divide(square, 2.0 * across, out=radius, where=across > 0.0)
    return radius


# --- which pairs need a search ----------------------------------------------------------------------------------------


def _links(pitch: Pitch) -> tuple[Array, Array]:
    """Divide the curve into intervals, each a small share of its length and turning: low and high ends (n,)."""
    cells = pitch.contour.cells
    width = cells.high - cells.low
    length = (cells.rows[1] + pitch.distance * cells.rows[3]) * width
    turning = np.maximum(np.abs(cells.rows[2]), np.abs(cells.rows[3])) * width
    weight = 0.5 * LINKS * (length / length.sum() + turning / turning.sum())
    parts = np.maximum(1, np.ceil(weight)).astype(np.intp)
    share = np.concatenate([np.arange(n) / n for n in parts.tolist()])
    owner = np.repeat(np.arange(parts.size), parts)
    low = cells.low[owner] + share * width[owner]
    total = np.cumsum(np.append(0.0, (weight / parts)[owner]))[:-1]
    first = np.flatnonzero(np.diff(np.floor(total), prepend=-1.0))
    low = low[first]
    return low, np.append(low[1:], cells.high[-1])


def _far_boxes(pitch: Pitch, below: float) -> _Boxes:
    """Boxes of pairs that are neither near along the curve nor proved further than 2 `below` apart."""
    low, high = _links(pitch)
    count = low.size
    at = pitch.at(low)
    following = np.roll(np.arange(count), -1)
    bends = pitch.bounds(low, high, at, low)
    width = high - low
    length = bends.speed * width
    middle = 0.5 * (at.point + at.point[following])
    gap = np.hypot(*(middle[:, None] - middle[None]).transpose(2, 0, 1))
    close = gap - 0.5 * (length[:, None] + length[None]) < 2.0 * below

    tangent, after = at.tangent, at.tangent[following]
    cross = tangent[:, 0] * after[:, 1] - tangent[:, 1] * after[:, 0]
    change = np.arctan2(cross, np.sum(tangent * after, axis=1))
    # what a link's tangent may do between its ends: nothing where the curve keeps its sense of turning
    turning = np.maximum(np.abs(bends.turn_low), np.abs(bends.turn_high)) * width
    one_way = (bends.turn_low >= 0.0) | (bends.turn_high <= 0.0)
    slack = np.where(one_way, 0.0, 0.5 * np.maximum(turning - np.abs(change), 0.0))
    theta = np.concatenate([[0.0], np.cumsum(np.tile(change, 2))])
    start, end = theta[:-1], theta[1:]
    slack = np.tile(slack, 2)
    least, greatest = np.minimum(start, end) - slack, np.maximum(start, end) + slack
    path = np.arange(count)[:, None] + np.arange(count)[None]
    span = np.maximum.accumulate(greatest[path], axis=1) - np.minimum.accumulate(least[path], axis=1)
    convex = np.logical_and.accumulate(np.tile(bends.turn_low >= 0.0, 2)[path], axis=1)
    sound = (turning < 0.5 * math.pi).all()  # else the change of direction over a link is not known
    near = (span <= 0.5 * math.pi) | (convex & (span <= math.pi)) if sound else np.zeros(span.shape, dtype=bool)
    to = path % count
    reached = np.zeros_like(near)
    np.put_along_axis(reached, to, near, axis=1)
    first, second = np.nonzero(np.triu(close & ~(reached | reached.T)))
    return _Boxes(np.column_stack([low[first], low[second]]), np.column_stack([high[first], high[second]]))


# --- proof over boxes -------------------------------------------------------------------------------------------------


def _sifted(pitch: Pitch, boxes: _Boxes, limit: float, found: list[Neck]) -> tuple[_Boxes, float]:
    """Boxes, divided, in which R may still fall below `limit`, and the limit after what was found in these."""
    count = boxes.low.shape[0]
    centre = 0.5 * (boxes.low + boxes.high)
    both = pitch.at(centre.T.ravel())
    x, y = both.part(slice(None, count)), both.part(slice(count, None))
    bends = pitch.bounds(boxes.low.T.ravel(), boxes.high.T.ravel(), both, centre.T.ravel())
    bend_low, bend_high = bends.low.reshape(2, count), bends.high.reshape(2, count)
    reach = 0.5 * bends.speed.reshape(2, count) * (boxes.high - boxes.low).T
    bend = np.maximum(np.abs(bend_low), np.abs(bend_high))
    d = x.point - y.point
    square = np.sum(d * d, axis=1)
    length = np.sqrt(square)
    room = reach.sum(axis=0)
    along = np.stack([np.sum(d * x.tangent, axis=1), -np.sum(d * y.tangent, axis=1)])
    across = np.stack([np.sum(d * x.normal, axis=1), -np.sum(d * y.normal, axis=1)])
    # how far these may change over the box: d moves by `room`, the frames turn by bend * reach
    turned = bend * reach
    along_room = room + turned * (length + room)
    across_room = room + turned * (np.abs(along) + along_room)
    parallel = np.sum(x.tangent * y.tangent, axis=1)
    slanted = np.abs(np.sum(x.normal * y.tangent, axis=1))

    radius = np.full(across.shape, np.inf)
    np.divide(square, 2.0 * across, out=radius, where=across > 0.0)
    limit = min(limit, float(radius.min()))
    aim = limit * (1.0 - NECK_SHARPNESS)
    free = length - room >= 2.0 * aim
    # G = |d|^2 - 2 v across is above 0 where R > v; its derivatives are 2 (1 - v k) along, and for the other point
    # 2 (along' - v N.T')
    clear = np.ones(count, dtype=bool)
    for i in (0, 1):
        other = 1 - i
        steep = np.maximum(np.abs(1.0 - aim * bend_low[i]), np.abs(1.0 - aim * bend_high[i]))
        own = 2.0 * steep * (np.abs(along[i]) + along_room[i]) * reach[i]
        pull = np.abs(along[other]) + along_room[other] + aim * (slanted + turned.sum(axis=0))
        clear &= square - 2.0 * aim * across[i] > own + 2.0 * pull * reach[other]
    free |= clear
    # Hessian of |d|^2 / 2 in arc length: [[1 - k across, -T.T'], [-T.T', 1 - k' across']]
    diagonal = 1.0 - np.maximum(
        np.maximum(bend_low * (across - across_room), bend_low * (across + across_room)),
        np.maximum(bend_high * (across - across_room), bend_high * (across + across_room)),
    )
    mixed = np.minimum(np.abs(parallel) + turned.sum(axis=0), 1.0)
    half_sum, half_difference = 0.5 * (diagonal[0] + diagonal[1]), 0.5 * (diagonal[0] - diagonal[1])
    bowl = half_sum - np.hypot(half_difference, mixed)
    slope = np.sum(along**2, axis=0)
    least = square - 2.0 * np.sum(np.abs(along) * reach, axis=0) + np.minimum(bowl, 0.0) * np.sum(reach**2, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        least = np.where(bowl > 0.0, np.maximum(least, square - slope / bowl), least)
    bowls = np.flatnonzero(~free & (bowl > 0.0) & (least < (2.0 * limit * (1.0 + NECK_SHARPNESS)) ** 2))
    free |= least >= (2.0 * aim) ** 2
    if bowls.size:
        ends = _double_normals(pitch, centre[bowls])
        half, inside = _measured(pitch, ends)
        held = ((ends >= boxes.low[bowls]) & (ends <= boxes.high[bowls])).all(axis=1) & inside
        free[bowls[held]] = True
        found += [Neck(float(t), float(s), float(h)) for (t, s), h in zip(ends[held], half[held], strict=True)]
        limit = min([limit, *half[held].tolist()])
    return _divided(boxes, centre, reach.T, ~free), limit


def _divided(boxes: _Boxes, centre: Array, reach: Array, kept: NDArray[np.bool_]) -> _Boxes:
    """Halve the kept boxes, along both intervals unless one is much the shorter."""
    low, high, centre, reach = boxes.low[kept], boxes.high[kept], centre[kept], reach[kept]
    for side in (0, 1):
        cut = reach[:, side] > 0.5 * reach[:, 1 - side]
        upper, lower = low[cut].copy(), high[cut].copy()
        upper[:, side] = lower[:, side] = centre[cut, side]
        whole = ~cut
        low, high = np.concatenate([low[whole], low[cut], upper]), np.concatenate([high[whole], lower, high[cut]])
        centre, reach = (np.concatenate([a[whole], a[cut], a[cut]]) for a in (centre, reach))
    return _Boxes(low, high)


def _double_normals(pitch: Pitch, ends: Array) -> Array:
    """Parameters (n, 2) at which the chord is normal to the curve at both ends, by Newton's method from (n, 2)."""
    ends = ends.copy()
    count = ends.shape[0]
    for _ in range(30):
        both = pitch.at(ends.T.ravel())
        x, y = both.part(slice(None, count)), both.part(slice(count, None))
        d = x.point - y.point
        f, g = np.sum(d * x.tangent, axis=1), np.sum(d * y.tangent, axis=1)
        ft, fs = x.speed - x.turn * np.sum(d * x.normal, axis=1), -y.speed * np.sum(x.tangent * y.tangent, axis=1)
        gt, gs = x.speed * np.sum(x.tangent * y.tangent, axis=1), -y.speed - y.turn * np.sum(d * y.normal, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.stack([f * gs - g * fs, ft * g - gt * f], axis=1) / (ft * gs - fs * gt)[:, None]
        step = np.clip(np.where(np.isfinite(step), step, 0.0), -0.1, 0.1)
        ends -= step
        if (np.abs(step) <= 4.0 * np.spacing(np.abs(ends))).all():
            break
    return ends


def _measured(pitch: Pitch, ends: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Half the chord between parameters (n, 2), and whether it is a double normal that runs across the inside."""
    count = ends.shape[0]
    both = pitch.at(ends.T.ravel())
    x, y = both.part(slice(None, count)), both.part(slice(count, None))
    d = x.point - y.point
    length = np.hypot(d[:, 0], d[:, 1])
    square = np.maximum(np.abs(np.sum(d * x.tangent, axis=1)), np.abs(np.sum(d * y.tangent, axis=1))) <= 1e-6 * length
    inside = (np.sum(d * x.normal, axis=1) > 0.0) & (np.sum(d * y.normal, axis=1) < 0.0)
    return 0.5 * length, square & inside


def _distinct(found: list[Neck], limit: float, period: float) -> tuple[Neck, ...]:
    """Narrowest necks, each once; its first end is the lower parameter."""
    kept: list[Neck] = []
    for neck in sorted(found, key=lambda n: n.half):
        if neck.half > limit * (1.0 + NECK_SHARPNESS):
            break
        a, b = sorted((neck.first % period, neck.second % period))
        if not any(_apart(a, n.first, period) < 1e-7 and _apart(b, n.second, period) < 1e-7 for n in kept):
            kept.append(Neck(a, b, neck.half))
    return tuple(sorted(kept, key=lambda n: n.first))


def _apart(a: float, b: float, period: float) -> float:
    gap = abs(a - b) % period
    return min(gap, period - gap)
