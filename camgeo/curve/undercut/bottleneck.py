"""Largest disc that rolls all round inside a pitch curve: necks between far-apart stretches (docs/theory.md 7).

The disc that touches the curve from inside at x and passes through y has the radius

    R(x, y) = |x - y|^2 / (2 (x - y).N(x)),    N the outward normal;

the least R of all pairs is the inner reach of the curve (Federer, Curvature measures, 1959, 4.18): the least radius of
curvature, or half of the narrowest double normal, if less. Three facts make the search certain:

- while the tangent stays within a right angle of the tangent at x, an arc of curvature at most 1/R does not enter the
  disc of radius R that touches it at x (the slope ``sin theta`` of the arc as a graph over the tangent is at most s/R);
  on a convex arc this holds up to a half turn (Blaschke's rolling theorem), and a concave one leaves the tangent for
  the outer side. Such pairs are near and need no search (`camgeo.curve.undercut.tangents` gives the directions);
- the others are kept in boxes, pairs of intervals, with proved lower bounds of R from the bounds of speed and turn;
- where |x - y|^2 is proved convex over a box, in arc length, its least value is at the double normal itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import SHIFT, CurveError, cyclic_gap
from camgeo.curve.undercut.pairs import Boxes, Pairs, Pitch
from camgeo.curve.undercut.tangents import TangentDirections
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve
    from kin.numeric.arrays import Array

    _Least = tuple[float, tuple[float, float] | None]  # least R seen, mm, and the parameters at which

NECK_SHARPNESS = 1e-9  # relative: no neck is narrower than the narrowest neck found by more than this
LINKS = 96  # intervals, about, whose pairs are the first boxes
LINKS_PER_PART = 8  # intervals, at least, of each part that the curve repeats
LEVELS = 60  # halvings of undecided boxes
MOST_BOXES = 40_000
NEWTON = 30  # steps towards a double normal, the error of which is measured
HALVINGS = 50  # of a radius until undecided boxes are free, and as many to find the greatest such radius


@dataclass(frozen=True)
class Neck:
    """A double normal of the pitch curve across its inside: parameters of its ends, and half its length in mm."""

    first: float
    second: float
    half: float


class OpenNeckError(CurveError):
    """An undecided neck at parameters `pair`; a disc of radius `least`, mm, is proved to roll all round.

    With `seen` a pair of points was found that no disc larger than `most`, mm, passes; else `most` is the radius to be
    decided.
    """

    def __init__(self, least: float, most: float, pair: tuple[float, float], seen: bool) -> None:
        super().__init__(
            f"whether a radius of {most:.9g} mm passes between parameters {pair[0]:.9g} and {pair[1]:.9g} cannot be "
            f"proved; {least:.9g} mm is proved to pass",
            pair[0],
        )
        self.least, self.most, self.pair, self.seen = least, most, pair, seen


def narrowest_necks(pitch: Pitch, below: float) -> tuple[Neck, ...]:
    """Narrowest necks of a pitch curve, equal within `NECK_SHARPNESS`, if they are narrower than 2 `below` mm.

    `below` must not exceed the curve's least radius of curvature. An empty result proves that R(x, y) is at least
    `below` for all pairs of points (within `NECK_SHARPNESS`; up to rounding of the samples). Raises OpenNeckError where
    the proof does not end, as for two concentric arcs that leave exactly a roller's diameter between them.
    """
    if bool((pitch.curve.cells.rows[2] >= 0.0).all()):
        return ()  # a convex curve: every pair is near
    search = _Search.of(pitch)
    boxes = search.boxes()
    necks: list[Neck] = []
    least: _Least = (below, None)
    for _ in range(LEVELS):
        boxes, least = search.sift(boxes, least, necks)
        if boxes.low.shape[0] == 0 and (necks or least[1] is None):
            return _distinct(search.images(n for n in necks if n.half < below), least[0], pitch.curve.shape.period)
        if not 0 < boxes.low.shape[0] <= MOST_BOXES:
            break
    raise search.undecided(boxes, least)


def neck_from(pitch: Pitch, first: float, second: float) -> Neck | None:
    """Double normal across the inside that Newton's method reaches from two parameters, or None."""
    ends = _double_normals(pitch, np.array([[first, second]]))
    neck, inside, _ = _chord(pitch, ends)
    return Neck(float(ends[0, 0]), float(ends[0, 1]), float(neck[0])) if inside[0] else None


def rolling_radius(pitch: Pitch, t: Array, s: Array) -> Array:
    """Radius R of the disc that touches at t (n,) and passes through the point at s (m,), mm (n, m).

    It is infinite where that point lies on the outer side of the tangent at t.
    """
    x, y = pitch.curve.sample(t), pitch.curve.sample(s)
    d = x.point[:, None] - y.point[None]
    across = np.einsum("nmi,ni->nm", d, x.normal)
    square = np.einsum("nmi,nmi->nm", d, d)
    radius = np.full(across.shape, np.inf)
    np.divide(square, 2.0 * across, out=radius, where=across > 0.0)
    return radius


# --- which pairs need a search ----------------------------------------------------------------------------------------


def _links(curve: Curve) -> tuple[Array, Array]:
    """Divide the curve into intervals, each a small share of its length and turning: low and high ends (n,)."""
    cells = curve.cells
    width = cells.high - cells.low
    length = cells.rows[1] * width
    turning = np.maximum(np.abs(cells.rows[2]), np.abs(cells.rows[3])) * width
    count = max(LINKS, LINKS_PER_PART * curve.shape.repeats)
    # intervals of equal weight: half by length, half by turning
    weight = 0.5 * count * (length / length.sum() + turning / turning.sum())
    parts = np.maximum(1, np.ceil(weight)).astype(np.intp)
    share = np.concatenate([np.arange(n) / n for n in parts.tolist()])
    owner = np.repeat(np.arange(parts.size), parts)
    low = cells.low[owner] + share * width[owner]
    total = np.cumsum(np.append(0.0, (weight / parts)[owner]))[:-1]
    first = np.flatnonzero(np.diff(np.floor(total), prepend=-1.0))
    low = low[first]
    return low, np.append(low[1:], cells.high[-1])


@dataclass(frozen=True)
class _Search:
    """Search over the pairs of a pitch curve's points; the first point lies in the first of the equal parts."""

    pitch: Pitch
    turning: TangentDirections

    @staticmethod
    def of(pitch: Pitch) -> _Search:
        return _Search(pitch, TangentDirections.of(pitch.curve))

    def boxes(self) -> Boxes:
        """Boxes that hold every pair, or its image by a turn that leads the curve into itself."""
        low, high = _links(self.pitch.curve)
        period = self.pitch.curve.shape.period
        own = np.flatnonzero(low < low[0] + (period / self.pitch.curve.shape.repeats) * (1.0 - SHIFT))
        # one of two points is no more than half a turn behind the other
        apart = (low[None] - high[own, None]) % period <= 0.5 * period
        apart |= (high[None] - low[own, None]) % period <= 0.5 * period
        apart[np.arange(own.size), own] = True
        first, second = np.nonzero(apart)
        first = own[first]
        return Boxes(np.column_stack([low[first], low[second]]), np.column_stack([high[first], high[second]]))

    def images(self, necks: Iterable[Neck]) -> list[Neck]:
        """Necks with their images by all turns that lead the curve into itself."""
        shape = self.pitch.curve.shape
        by = [shape.period / shape.repeats * k for k in range(shape.repeats)]
        return [Neck(n.first + turn, n.second + turn, n.half) for n in necks for turn in by]

    def far(self, boxes: Boxes) -> Boxes:
        """Boxes whose pairs are not all near, one way round or the other."""
        period = self.pitch.curve.shape.period
        near = np.zeros(boxes.low.shape[0], dtype=bool)
        for first, second in ((0, 1), (1, 0)):
            before = boxes.low[:, second] < boxes.low[:, first]
            near |= self.turning.near(boxes.low[:, first], boxes.high[:, second] + np.where(before, period, 0.0))
        return Boxes(boxes.low[~near], boxes.high[~near])

    def sift(self, boxes: Boxes, least: _Least, necks: list[Neck]) -> tuple[Boxes, _Least]:
        """Halved boxes in which R may still fall below the least found, and that least R; `necks` gets new ones."""
        boxes = self.far(boxes)
        if boxes.low.shape[0] == 0:
            return boxes, least
        pairs = Pairs.of(self.pitch, boxes)
        radius = pairs.radius.min(axis=0)
        worst = int(np.argmin(radius))
        if radius[worst] < least[0]:
            least = float(radius[worst]), _pair(pairs.centre[worst])
        free = pairs.free(least[0] * (1.0 - NECK_SHARPNESS))
        # in a bowl the distance has one minimum at most; the neck is wanted even where its box is just free
        bowls = np.flatnonzero((pairs.bowl > 0.0) & (pairs.chord < 2.0 * least[0] * (1.0 + NECK_SHARPNESS)))
        if bowls.size:
            ends = _double_normals(self.pitch, pairs.centre[bowls])
            half, inside, slant = _chord(self.pitch, ends)
            reached = ((ends >= boxes.low[bowls]) & (ends <= boxes.high[bowls])).all(axis=1) & inside
            # the least |x - y| is less by a share of slant^2 / 2 bowl at most: Newton's method has come close enough
            reached &= slant * slant <= 2.0 * NECK_SHARPNESS * pairs.bowl[bowls]
            free[bowls[reached]] = True
            necks += [
                Neck(float(t), float(s), float(h)) for (t, s), h in zip(ends[reached], half[reached], strict=True)
            ]
            narrowest = min(necks, key=lambda n: n.half, default=None)
            if narrowest is not None and narrowest.half < least[0]:
                least = narrowest.half, (narrowest.first, narrowest.second)
        return _halve(boxes, pairs.centre, pairs.doubt.T, ~free), least

    def undecided(self, boxes: Boxes, least: _Least) -> OpenNeckError:
        """Error for undecided boxes: the radius that is proved to pass, and the least R found."""
        most, seen = least
        boxes = self.far(boxes)
        if boxes.low.shape[0] == 0:  # a pair has the least R, but no neck was found there
            pair = seen or (0.0, 0.0)
            return OpenNeckError(most * (1.0 - NECK_SHARPNESS), most, pair, seen is not None)
        pairs = Pairs.of(self.pitch, boxes)
        low, high = 0.0, most
        where = pairs.centre[int(np.argmin(pairs.radius.min(axis=0)))]
        # the greatest radius at which all boxes are free: halving down to one, then between it and the next above
        for step in range(2 * HALVINGS):
            aim = 0.5 * (low + high) if low or step > HALVINGS else 0.5 * high
            free = pairs.free(aim)
            if free.all():
                low = aim
            else:
                high, where = aim, pairs.centre[int(np.argmin(free))]
            if high - low <= 1e-3 * high:
                break
        return OpenNeckError(low, most, seen or _pair(where), seen is not None)


def _pair(pair: Array) -> tuple[float, float]:
    return float(pair[0]), float(pair[1])


def _halve(boxes: Boxes, centre: Array, doubt: Array, doubtful: NDArray[np.bool_]) -> Boxes:
    """Halve the doubtful boxes along both intervals, or along one where the other adds half its doubt at most."""
    low, high, centre, doubt = boxes.low[doubtful], boxes.high[doubtful], centre[doubtful], doubt[doubtful]
    for side in (0, 1):
        cut = doubt[:, side] > 0.5 * doubt[:, 1 - side]
        upper, lower = low[cut].copy(), high[cut].copy()
        upper[:, side] = lower[:, side] = centre[cut, side]
        whole = ~cut
        low, high = np.concatenate([low[whole], low[cut], upper]), np.concatenate([high[whole], lower, high[cut]])
        centre, doubt = (np.concatenate([a[whole], a[cut], a[cut]]) for a in (centre, doubt))
    return Boxes(low, high)


def _double_normals(pitch: Pitch, ends: Array) -> Array:
    """Parameters (n, 2) that Newton's method comes to from `ends` (n, 2), for chords normal to the curve at both ends.

    Without a double normal nearby it ends anywhere, which `_chord` shows.
    """
    # roots of f = d.T at x and g = d.T at y; ft, fs, gt, gs are their derivatives by the parameters of x and y
    ends = ends.copy()
    count = ends.shape[0]
    for _ in range(NEWTON):
        x, y = pitch.curve.sample(ends.T.ravel()).split(count)
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


def _chord(pitch: Pitch, ends: Array) -> tuple[Array, NDArray[np.bool_], Array]:
    """Half the chord between parameters (n, 2), mm, whether it is a double normal across the inside, and its slant.

    The slant is the share of the chord that lies along both tangents, 0 for a double normal.
    """
    count = ends.shape[0]
    x, y = pitch.curve.sample(ends.T.ravel()).split(count)
    d = x.point - y.point
    length = np.hypot(d[:, 0], d[:, 1])
    slant = np.full(count, np.inf)
    along = np.hypot(np.sum(d * x.tangent, axis=1), np.sum(d * y.tangent, axis=1))
    np.divide(along, length, out=slant, where=length > 0.0)
    inside = (np.sum(d * x.normal, axis=1) > 0.0) & (np.sum(d * y.normal, axis=1) < 0.0)
    return 0.5 * length, (slant <= 1e-6) & inside, slant


def _distinct(necks: list[Neck], limit: float, period: float) -> tuple[Neck, ...]:
    """Narrowest necks, each once; its first end is the lower parameter."""
    distinct: list[Neck] = []
    for neck in sorted(necks, key=lambda n: n.half):
        if neck.half > limit * (1.0 + NECK_SHARPNESS):
            break
        a, b = sorted((neck.first % period, neck.second % period))
        if not any(cyclic_gap(a, n.first, period) < 1e-7 and cyclic_gap(b, n.second, period) < 1e-7 for n in distinct):
            distinct.append(Neck(a, b, neck.half))
    return tuple(sorted(distinct, key=lambda n: n.first))
