"""Flanks of a groove that crosses itself, as bicubic splines between their crossings that share the corners' edges.

A flank is kept between lines on which it meets the flank of another turn (`camgeo.capabilities.cylindrical.patches`).
Such a line has the shaft angle t on one flank and s on the other, and p(t, r) = q(s, r) on all cylinders: so

    p_theta t' - q_theta s' = q_r - p_r

with the derivatives by r at constant angles. At the nodes of r both t and t' are those of the line, between them t is
the cubic; the border of a spline depends on places and derivatives at nodes alone, so that those of both flanks are one
curve, and within the bound of either. From a line the shaft angle goes over linearly to the next upright border or
line, and `camgeo.capabilities.cylindrical.bicubic` bounds the spline along lines that lean, too.

A break of a higher derivative than S'' may lie beneath such a line, where it is no node. In a cell with a break second
derivatives p_ss and p_rr jump, and p_s has a first one by r. If they are within balls of radii b, cubic Hermite
interpolation, which keeps quadratics, is off by at most

    h1^2/16 b_ss + h2^2/16 b_rr + h1/4 (3/4) h2 b_sr

(Peano's kernel for the second derivative has the integral 1/16 in the middle; for a slope within b of its middle the
values are off by h2/2 b and the slopes add h2/4 b; Davis, as for `bicubic`).
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.bicubic import (
    FOURTH,
    MOST_NODES,
    MOST_ROWS,
    NEAR,
    WIDEST,
    Border,
    Span,
    Way,
    derived,
    jumps_of,
    local,
    rows_for,
    size_of,
    spline,
)
from camgeo.capabilities.cylindrical.grid import SAME
from camgeo.capabilities.cylindrical.patches import kept_of, lines_of
from camgeo.common.rounding import upward
from camgeo.fit.nodes import ToleranceError, check_precision, rounding
from kin.numeric.arrays import runs_of
from kin.numeric.interval import Ball
from kin.numeric.jet import BallJet, horner
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.capabilities.cylindrical.bicubic import Bicubic
    from camgeo.capabilities.cylindrical.crossings import Corner
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.flank import Flank
    from camgeo.capabilities.cylindrical.patches import At
    from kin.numeric.arrays import Array, Indices

WEDGE = 0.05  # rad, or half of what a line leans, at which an upright border follows
LOOK, DEEP = 0.035, 2  # rad, and parts of the depth: cells that bounds are taken over
MORE_ROWS = 1.5  # times as many rows in each further round
COARSER = 2.0  # times a tolerance that is not held, the next one that is tried
MOST_PARTS = 4  # into which a cell is parted at once
SECOND = 16.0  # of the error of cubic interpolation, where the second derivative jumps
MIXED = 3.0 / 16.0  # of that where the mixed one does


@dataclass(frozen=True, eq=False)
class Stretch:
    """A stretch of a flank between two corners, and the splines that it is parted into, in order."""

    name: str
    begin: Corner
    end: Corner
    parts: tuple[Bicubic, ...]


@dataclass(frozen=True, eq=False)
class Trimmed:
    """All stretches of both flanks, and the proved bound of their distance from the exact flanks, mm."""

    stretches: tuple[Stretch, ...]
    off: float


class _Kept(NamedTuple):
    """A stretch before it has splines: the borders between its parts, rising."""

    name: str
    begin: Corner
    end: Corner
    borders: list[Border]


def trimmed(design: DrumDesign, tolerance: float, parted: Callable[[float, Array], Sequence[float]]) -> Trimmed:
    """Splines of a groove that crosses itself, within a tolerance, mm, of its flanks.

    `parted` gives, for a radius, mm, and the polar angles (n,), rad, of all places at which splines end there, those at
    which all flanks are to be parted on that cylinder. Raises ToleranceError where the tolerance cannot be held or
    proved.
    """
    recipe = design.recipe
    size = max(recipe.radius + abs(flank.level) + flank.guide.reach for flank in design.flanks.values())
    check_precision(size, tolerance)
    least, found = tolerance, _made(design, (tolerance, rounding(size)), parted)
    if found is not None:
        return found
    while found is None:
        least *= COARSER
        if least > size:
            raise ToleranceError("flanks that cross have no bound near enough: no surface is proved", math.inf)
        found = _made(design, (least, rounding(size)), parted)
    problem = f"flanks that cross within {tolerance:.3g} mm would take too many control points"
    raise ToleranceError(f"{problem}; give at least {upward(least, 3)} mm", least)


def _made(
    design: DrumDesign, within: tuple[float, float], parted: Callable[[float, Array], Sequence[float]]
) -> Trimmed | None:
    """Splines within a tolerance, mm, of which so much is rounding; None where it takes too many control points."""
    tolerance, lost = within
    flanks, ends = design.flanks, (design.recipe.floor, design.recipe.radius)
    count = max(rows_for(flank, ends, tolerance, lost) for flank in flanks.values())
    while count <= MOST_ROWS:
        r = np.linspace(*ends, count + 1)
        kept = _kept(design, r, parted)
        made, off = [], 0.0
        for name, flank in flanks.items():
            own = [each for each in kept if each.name == name]
            found = _splines(flank, r, [each.borders for each in own], tolerance - lost)
            if found is None:
                break
            off = max(off, found[1])
            made += [Stretch(*each[:3], tuple(parts)) for each, parts in zip(own, found[0], strict=False)]
        else:
            return Trimmed(tuple(made), off + lost) if math.isfinite(off) else None
        count = math.ceil(MORE_ROWS * count)
    return None


# --- borders ----------------------------------------------------------------------------------------------------------


def _kept(design: DrumDesign, r: Array, parted: Callable[[float, Array], Sequence[float]]) -> list[_Kept]:
    """All stretches, with borders at corners and beside them, at jumps of S'', and where flanks are to be parted."""
    found = []
    for name, flank in design.flanks.items():
        jumps = jumps_of(flank)
        for begin, end in kept_of(design.crossings, name, flank.period):
            found.append(_Kept(name, begin[0], end[0], _borders(flank, (begin, end), r, jumps)))
    for row in (-1, 0):
        places = [
            _polar(design.flanks[each.name], np.array([_angle(border, row) for border in each.borders]), r[row])
            for each in found
        ]
        cuts = parted(float(r[row]), np.concatenate(places))
        for each, phi in zip(found, places, strict=True):
            _part(design.flanks[each.name], each.borders, (row, float(r[row])), _within(phi, cuts))
    return found


def _angle(border: Border, row: int) -> float:
    return border.s + float(border.lean[0, row])


def _polar(flank: Flank, theta: Array, r: float) -> Array:
    return flank.on(theta, r).phi


def _within(phi: Array, cuts: Sequence[float]) -> Array:
    """Angles, rad, between the first and the last of some (n,), that are whole turns off one of the cuts."""
    found = [cut + 2.0 * math.pi * np.arange(*_turns(cut, phi)) for cut in cuts]
    return np.sort(np.concatenate(found))


def _turns(cut: float, phi: Array) -> tuple[int, int]:
    return tuple(math.ceil((float(end) - cut) / (2.0 * math.pi)) for end in (phi[0], phi[-1]))  # type: ignore[return-value]


def _borders(flank: Flank, ends: tuple[At, At], r: Array, jumps: Array) -> list[Border]:
    """Borders of a stretch between two corners: its lines, and upright ones beside them and at jumps of S''."""
    lines = lines_of(ends, r, flank.period)
    slopes = [slopes_of(corner, r)[k] for corner, k in ends]
    leaning = [
        Border(float(theta.mean()), np.stack([theta - theta.mean(), slope]))
        for theta, slope in zip(lines, slopes, strict=True)
    ]
    low, high = float(lines[0].max()), float(lines[1].min())
    every = jumps + flank.period * np.arange(-1, 3)[:, None]
    upright = sorted(every[(every > low + NEAR) & (every < high - NEAR)].tolist())
    wide = [max(WEDGE, 0.5 * float(np.ptp(theta))) for theta in lines]
    first, last = low + wide[0], high - wide[1]
    if first + WEDGE < (upright[0] if upright else last):
        upright.insert(0, first)
    if last - WEDGE > (upright[-1] if upright else last):
        upright.append(last)
    return [leaning[0], *(Border.upright(each, len(r)) for each in upright), leaning[1]]


def slopes_of(corner: Corner, r: Array) -> tuple[Array, Array]:
    """Derivatives by r of the shaft angles of a corner's line on both its flanks, rad/mm (n,), on cylinders r, mm."""
    still = np.zeros_like(r)
    (_, p_r, p_t, _), (_, q_r, q_t, _) = (
        local(flank, (theta, still), r) for flank, theta in zip(corner.flanks, corner.at(r), strict=True)
    )
    # the normal equations of p_t t' - q_t s' = q_r - p_r
    away = q_r - p_r
    pp, qq, pq = ((a * b).sum(axis=1) for a, b in ((p_t, p_t), (q_t, q_t), (p_t, q_t)))
    p, q = ((a * away).sum(axis=1) for a in (p_t, q_t))
    det = pp * qq - pq * pq
    return (p * qq - q * pq) / det, (p * pq - q * pp) / det


def _part(flank: Flank, borders: list[Border], at: tuple[int, float], cuts: Array) -> None:
    """Add borders whose places on a row of r, mm, are at polar angles (n,), rad."""
    row, r = at
    for theta in _angles_at(flank, cuts, r).tolist():
        k = int(np.searchsorted([_angle(border, row) for border in borders], theta))
        span = Span(borders[k - 1], borders[k])
        low, high = (_angle(border, row) for border in span)
        share = (theta - low) / (high - low)
        borders.insert(k, span.border(span.first.s + share * (span.last.s - span.first.s)))


def _angles_at(flank: Flank, phi: Array, r: float) -> Array:
    """Shaft angles (n,), rad, at which a flank is at polar angles on a cylinder, mm."""
    from camgeo.capabilities.cylindrical.figures import at_angle

    return at_angle(flank, phi, r, phi)


# --- splines ----------------------------------------------------------------------------------------------------------


def _splines(
    flank: Flank, r: Array, borders: Sequence[Sequence[Border]], tolerance: float
) -> tuple[list[list[Bicubic]], float] | None:
    """Splines between neighbours of borders of stretches, and their bound, mm; None where more rows are needed.

    The bound is infinite where they would take too many columns.
    """
    spans = [Span(*pair) for row in borders for pair in pairwise(row)]
    columns = [_begun(flank, span) for span in spans]
    own = np.repeat(np.arange(len(spans)), [len(nodes) - 1 for nodes in columns])
    low, high = (np.concatenate([nodes[k : len(nodes) - 1 + k] for nodes in columns]) for k in (0, 1))
    cells, off, total = _Cells(flank, r, spans), 0.0, len(own)
    done: list[tuple[Indices, Array]] = []
    while len(own):
        found, across = cells.off(own, low, high)
        if not bool((across <= tolerance).all()):
            return None
        right = found <= tolerance
        off = max(off, float(found[right].max(initial=0.0)))
        done.append((own[right], high[right]))
        own, low, high, found = own[~right], low[~right], high[~right], found[~right]
        with np.errstate(invalid="ignore"):
            parts = np.where(np.isfinite(found), np.ceil((found / tolerance) ** 0.25), MOST_PARTS)
        count = np.clip(parts, 2, MOST_PARTS).astype(np.intp)
        each, step = runs_of(count)
        first, width, last = low[each], ((high - low) / count)[each], step + 1 == count[each]
        own, low, high = own[each], first + step * width, np.where(last, high[each], first + (step + 1) * width)
        total += len(each)
        if total > MOST_NODES:
            return [], math.inf
    owners, ends = (np.concatenate(part) for part in zip(*done, strict=True))
    made = [
        spline(flank, np.concatenate([[span.first.s], np.sort(ends[owners == k])]), r, span)
        for k, span in enumerate(spans)
    ]
    counts = [len(row) - 1 for row in borders]
    starts = np.cumsum(counts) - counts
    return [made[a : a + n] for a, n in zip(starts.tolist(), counts, strict=True)], off


def _begun(flank: Flank, span: Span) -> Array:
    """Nodes of a span to begin with; breaks of the motion are among them where the shaft angle is theirs all along."""
    low, high = span.first.s, span.last.s
    nodes = np.linspace(low, high, max(1, math.ceil((high - low) / WIDEST)) + 1)
    if not span.upright or not len(flank.law.breaks):
        return nodes
    every = (flank.law.breaks + flank.period * np.arange(-1, 3)[:, None]).ravel()
    inside = np.sort(every[(every > low + NEAR) & (every < high - NEAR)])
    rising = np.sort(np.concatenate([nodes, inside]))
    near = np.isin(rising, inside) | (np.abs(rising[:, None] - np.append(inside, np.inf)).min(axis=1) > NEAR)
    return np.asarray(rising[near])


class _Of(NamedTuple):
    """Cells (n,): the numbers of their spans and rows, and between which s, rad, and r, mm, they lie."""

    own: Indices
    row: Indices
    s: tuple[Array, Array]
    r: tuple[Array, Array]

    def take(self, which: Indices) -> _Of:
        """Some of the cells."""
        s, r = (tuple(part[which] for part in pair) for pair in (self.s, self.r))
        return _Of(self.own[which], self.row[which], s, r)  # type: ignore[arg-type]

    def parts(self, count: Indices, deep: int) -> tuple[_Of, Indices]:
        """Cells parted into numbers (n,) along and so many across, and the first part of each."""
        cell, step = runs_of(count * deep)
        along, across = step // deep, step % deep

        def between(ends: tuple[Array, Array], k: Indices, many: Array) -> tuple[Array, Array]:
            low, wide = ends[0][cell], (ends[1] - ends[0])[cell]
            return low + wide * k / many, np.where(k + 1 == many, ends[1][cell], low + wide * (k + 1) / many)

        many = count[cell].astype(np.float64), np.full(len(cell), float(deep))
        s, r = between(self.s, along, many[0]), between(self.r, across, many[1])
        return _Of(self.own[cell], self.row[cell], s, r), np.flatnonzero(step == 0)

    @property
    def size(self) -> tuple[Array, Array]:
        """Extents (n,), rad and mm."""
        return self.s[1] - self.s[0], self.r[1] - self.r[0]


class _Cells:
    """Cells between nodes of s, rad, and rows r, mm, of spans of a flank."""

    def __init__(self, flank: Flank, r: Array, spans: Sequence[Span]) -> None:
        self.flank, self.r = flank, r
        self.ends = np.array([[span.first.s, span.last.s] for span in spans])
        lean = np.stack([np.stack([border.lean for border in span]) for span in spans], axis=-1)
        h = np.diff(r)[:, None]
        (begin, end), (slope, slope1) = ((lean[:, k, :-1], lean[:, k, 1:]) for k in (0, 1))
        rise = (end - begin) / h
        square, cube = (3.0 * rise - 2.0 * slope - slope1) / h, (slope + slope1 - 2.0 * rise) / h**2
        self.cubics = np.stack([begin, slope, square, cube])  # (4, 2, rows, spans) over each row of both borders
        self.breaks = np.sort((flank.law.breaks + flank.period * np.arange(-1, 4)[:, None]).ravel())

    def off(self, own: Indices, low: Array, high: Array) -> tuple[Array, Array]:
        """Bounds (n,), mm, over columns of cells from `low` to `high`, and what of each stays as they become narrow."""
        rows, n = len(self.r) - 1, len(own)
        row = np.repeat(np.arange(rows), n)
        own, low, high = np.tile(own, rows), np.tile(low, rows), np.tile(high, rows)
        cells = _Of(own, row, (low, high), (self.r[row], self.r[row + 1]))
        way = self._way(cells)
        broken = np.searchsorted(self.breaks, way.low + SAME) < np.searchsorted(self.breaks, way.high - SAME)
        found = np.empty((2, len(own)))
        for which, bound in ((np.flatnonzero(~broken), self._smooth), (np.flatnonzero(broken), self._rough)):
            if which.size:
                found[:, which] = bound(cells.take(which))
        off, across = found.reshape(2, rows, n).max(axis=1)
        return off, across

    def _smooth(self, cells: _Of) -> tuple[Array, Array]:
        """Bounds of cells without a break, from fourth derivatives over parts of them."""
        h1, h2 = cells.size
        count = np.maximum(np.ceil(h1 / LOOK), 1.0).astype(np.intp)
        parts, heads = cells.parts(count, max(1, math.ceil(DEEP / (len(self.r) - 1))))
        bounds = derived(self.flank, self._way(parts), parts.r).bounds()
        folded = type(bounds)(*(np.maximum.reduceat(part, heads) for part in bounds))
        with np.errstate(invalid="ignore"):
            return folded.off(h1, h2), folded.off(0.0 * h1, h2)

    def _rough(self, cells: _Of) -> tuple[Array, Array]:
        """Bounds of cells with a break, at which second derivatives jump."""
        h1, h2 = cells.size
        way = self._way(cells)
        found, turn = derived(self.flank, way, cells.r), 0.5 * (way.high - way.low)

        def ball(parts: Sequence[Ball]) -> Array:
            """Radius of a ball about a derivative, whose frame turns over the cell."""
            around: Array = np.sqrt(sum(part.rad**2 for part in parts)) + turn * size_of(parts)
            return around

        with np.errstate(invalid="ignore"):
            across = h2**2 / SECOND * ball(found.across[2])
            along = h1**2 / SECOND * ball(found.along[2]) * found.rate**2
            return along + across + MIXED * h1 * h2 * ball(found.mixed[1]), across

    def _way(self, cells: _Of) -> Way:
        """Lines s = const over cells."""
        own, row, s, r = cells
        x = BallJet.variable(r[0] - self.r[row], r[1] - self.r[row], FOURTH)
        first, last = (horner(self.cubics[:, k, row, own], x) for k in (0, 1))
        begin, end = self.ends[own].T
        wide = end - begin
        shares = [(each - begin) / wide for each in s]
        low, high = (
            (first.rows[0] * (1.0 - share) + last.rows[0] * share + each).bounds()
            for share, each in zip(shares, s, strict=True)
        )
        within, share = Ball.between(low[0], high[1]), Ball.between(shares[0], shares[1])
        theta = first * (share * -1.0 + 1.0) + last * share
        theta.mid[0], theta.rad[0] = within.mid, within.rad
        return Way(low[0], high[1], theta, (last - first) * (1.0 / wide) + 1.0, straight=False)
