"""Callouts beside a view: texts in a column on its left, if need be in another on its right, and their leaders.

Leaders are laid so that they run over no text, cross no opening, and each other as seldom as can be: straight ones
where there are such, else with a knee outside the part.
"""

from __future__ import annotations

import math
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sheet.lettering import SMALL, width
from camgeo.capabilities.sheet.marks import (
    TALL,
    THIN,
    CircleMark,
    LineMark,
    Text,
    arrow,
    finish_symbol,
    finish_width,
    round_size,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.sheet.marks import Anchor, Page, Point
    from camgeo.part.feature import Circle
    from kin.numeric.arrays import Array

PITCH = 5.5  # mm from the last line of a callout to the first of the next
SECOND = 3.8  # mm from one line of a callout to the next
LETTER = 9.0  # mm: of the box of a datum's letter and of its distance from the leader
FRAMED = 1.0  # mm: of a box round a theoretically exact size beyond its text
SYMBOL_LOW = TALL - 1.0 - SMALL  # mm from the line of a text down to the point of its surface symbol
APART = 0.8  # mm between a leader's start and its text
CLEAR = 0.6  # mm between a leader and an opening
KNEE_OUT = 3.0  # mm from the part to the knees of leaders
KNEES = np.radians(np.arange(0.0, 360.0, 12.0) + 6.0)  # their directions from the middle
AIM = np.radians([0.0, -20.0, 20.0, -40.0, 40.0])  # of a leader against the direction to a circle's centre
CROSSED, MET, ASKEW, BENT, LEVEL = 1e4, 60.0, 6.0, 4.0, 3.0
"""Penalties of a leader, in mm of its length: for each opening or text that it crosses, for each leader that it
crosses, for each rad by which it misses the circle's centre, for a knee, and for lying along the centre line."""
NEAR = 3.0  # mm from an opening: leaders that end there may come nearer to it than that
TOUCH = 1e-6  # mm: rounding of a leader's end at the edge of its own opening
GRID = 2.0  # mm between heights that are tried
ROUNDS, MANY = 3, 24  # rounds of improving the order and the sides; of more callouts it would take too long


class ColumnCallout(NamedTuple):
    """A callout: any of equal circles of the part, or any of several points, that its leader leads to, in mm.

    Its first line is `text`, boxed where the size is theoretically exact; `notes` are the others. `value` is a
    diameter, mm, that is a dimension; None of words. `datum` is the letter of the datum that the feature is. With
    `rough` the text is the roughness of a surface, under its symbol.
    """

    text: str
    notes: tuple[str, ...] = ()
    circles: tuple[Circle, ...] = ()
    points: tuple[Point, ...] = ()
    value: float | None = None
    boxed: bool = False
    datum: str = ""
    rough: bool = False

    @property
    def wide(self) -> float:
        """Width on the paper, mm."""
        first = width(self.text, SMALL) + (LETTER if self.datum else 0.0) + (2.0 * FRAMED if self.boxed else 0.0)
        return max(finish_width(self.text) if self.rough else first, *(width(note, SMALL) for note in self.notes), 0.0)

    @property
    def high(self) -> float:
        """Height from its first line to the next callout's, mm on the paper."""
        return PITCH + (SYMBOL_LOW + 1.0 if self.rough else self.lower + SECOND * len(self.notes))

    @property
    def lower(self) -> float:
        """Space, mm, by which its notes stand lower below the box of a datum letter."""
        return 1.0 if self.datum else 0.0

    @property
    def start(self) -> float:
        """Height of its leader's start above its first line, mm."""
        return -SYMBOL_LOW if self.rough else 0.5 * SMALL

    @property
    def middle(self) -> float:
        """Mean height of what it leads to, mm on the part."""
        places = [y for (_, y), _ in self.circles] or [y for _, y in self.points]
        return sum(places) / len(places)

    def moved(self, by: Array) -> ColumnCallout:
        """The callout with what it leads to moved by (x, y), mm."""
        u, v = by.tolist()
        circles = tuple(((x + u, y + v), radius) for (x, y), radius in self.circles)
        return self._replace(circles=circles, points=tuple((x + u, y + v) for x, y in self.points))


class PlacedCallout(NamedTuple):
    """A callout at its place, mm of paper from the middle of the view: left of it with `side` -1, right with 1.

    `height` is that of its first line. `leader` (n, 2) runs from the text to the part. `circle` is the circle that it
    leads to, None for a point; `crossings` is how many openings and texts the leader crosses.
    """

    row: ColumnCallout
    side: int
    height: float
    leader: Array
    circle: Circle | None
    crossings: int


class Room(NamedTuple):
    """Room round a view for its callouts, mm of paper from its middle.

    The leaders start at x `left` and `right`; heights lie between `low` and `high`. `knees` (k, 2) are places about the
    part; `openings` (n, 3) and `texts` (m, 3) are circles, x, y and radius, that leaders keep clear of. `scale` is the
    paper's mm to a mm of the part.
    """

    left: float
    right: float
    low: float
    high: float
    knees: Array
    openings: Array
    texts: Array
    scale: float

    @property
    def circles(self) -> Array:
        """Openings and texts, (n + m, 3)."""
        return np.concatenate([self.openings, self.texts])

    def start(self, side: int) -> float:
        """Place x of the starts of leaders on a side."""
        return self.left if side < 0 else self.right


def knees_about(points: Array) -> Array:
    """Places (k, 2) of knees about the middle of a view, beyond all of its points (n, 2), mm of paper."""
    angles, radii = np.arctan2(points[:, 1], points[:, 0]), np.hypot(*points.T)
    apart = np.abs(np.angle(np.exp(1j * (KNEES[:, None] - angles))))
    far = np.where(apart < KNEES[0], radii, 0.0).max(axis=1) + KNEE_OUT
    places: Array = far[:, None] * np.column_stack([np.cos(KNEES), np.sin(KNEES)])
    return places


class _Way(NamedTuple):
    """The best leaders of a callout on one side by heights of its first line: cost, points, circle, crossings."""

    costs: Array
    tips: Array  # (heights, 2)
    circles: Array  # number of the circle, -1 for a point
    crossings: Array
    knees: Array  # (heights, 2), nan without a knee


def place_callouts(rows: Sequence[ColumnCallout], room: Room, *, both: bool) -> list[PlacedCallout] | None:
    """Place callouts on the left of a view, or on both sides of it; None where a column is too short for them.

    Leaders that cross openings or texts are left only where there are no others.
    """
    heights = np.arange(room.high, room.low, -GRID)
    if not rows or not len(heights):
        return None if rows else []
    sides = (-1, 1) if both else (-1,)
    columns = _Columns(rows, [{side: _way(row, room, side, heights) for side in sides} for row in rows], room, heights)
    # on the side of the better leader; where that column is too full, on both by turns
    better = [_better_side(way) for way in columns.ways]
    turns = [sides[i % len(sides)] for i in range(len(rows))]
    order = sorted(range(len(rows)), key=lambda i: -rows[i].middle)
    return next((found for chosen in (better, turns) if (found := columns.improved(chosen, order)) is not None), None)


def _better_side(ways: dict[int, _Way]) -> int:
    """Side of the cheaper leader; of equal ones the left."""
    return min(ways, key=lambda side: float(ways[side].costs.min()) + side)


class _Stack(NamedTuple):
    """Callouts in their columns, and what that costs."""

    cost: float
    placed: list[PlacedCallout]


class _Columns(NamedTuple):
    """Callouts that are placed, the ways of their leaders by side, the room, and the heights that are tried."""

    rows: Sequence[ColumnCallout]
    ways: Sequence[dict[int, _Way]]
    room: Room
    heights: Array

    def improved(self, chosen: list[int], order: list[int]) -> list[PlacedCallout] | None:
        """Improve sides and order step by step: neighbours change places, single callouts the side.

        None where the columns are too short for all that is tried.
        """
        best = self.stack(chosen, order)
        for _ in range(ROUNDS if len(self.rows) <= MANY else 0):
            before = best
            for i in range(len(self.rows)):
                for other in self.ways[i].keys() - {chosen[i]}:
                    trial = [*chosen[:i], other, *chosen[i + 1 :]]
                    if _better(found := self.stack(trial, order), best):
                        best, chosen = found, trial
            for i in range(len(self.rows) - 1):
                trial = [*order[:i], order[i + 1], order[i], *order[i + 2 :]]
                if _better(found := self.stack(chosen, trial), best):
                    best, order = found, trial
            if best is before:
                break
        return None if best is None else best.placed

    def stack(self, chosen: Sequence[int], order: Sequence[int]) -> _Stack | None:
        """Heights of least cost for columns in an order from above; None where they do not fit."""
        total = 0.0
        placed: list[PlacedCallout] = []
        for side in (-1, 1):
            column = [i for i in order if chosen[i] == side]
            if not column:
                continue
            found = self._heights(column, side)
            if found is None:
                return None
            total += found[0]
            placed += [self._placed(i, side, at) for i, at in zip(column, found[1], strict=True)]
        return _Stack(total + MET * _meetings(placed), placed)

    def _heights(self, column: Sequence[int], side: int) -> tuple[float, list[int]] | None:
        """Least cost of a column from above, and the numbers of its heights; None where it does not fit."""
        # costs of all callouts so far, the last of them at each height; and where the one before then stands
        sums = self.ways[column[0]][side].costs
        before: list[Array] = []
        for last, i in pairwise(column):
            steps = math.ceil(self.rows[last].high / GRID)
            least = np.minimum.accumulate(sums)
            where = np.maximum.accumulate(np.where(sums <= least, np.arange(len(sums)), 0))
            shifted = np.concatenate([np.full(steps, np.inf), least])[: len(sums)]
            before.append(np.concatenate([np.zeros(steps, int), where])[: len(sums)])
            sums = shifted + self.ways[i][side].costs
        # the last one keeps its notes above the lower end
        sums = np.where(self.heights - self.rows[column[-1]].high >= self.room.low, sums, np.inf)
        at = int(np.argmin(sums))
        if not np.isfinite(sums[at]):
            return None
        numbers = [at]
        for back in reversed(before):
            numbers.append(int(back[numbers[-1]]))
        return float(sums[at]), numbers[::-1]

    def _placed(self, i: int, side: int, at: int) -> PlacedCallout:
        row, way, height = self.rows[i], self.ways[i][side], float(self.heights[at])
        start, knee = (self.room.start(side), height + row.start), way.knees[at]
        points = [start, way.tips[at]] if np.isnan(knee[0]) else [start, knee, way.tips[at]]
        circle = row.circles[int(way.circles[at])] if way.circles[at] >= 0 else None
        return PlacedCallout(row, side, height, np.array(points), circle, int(way.crossings[at]))


def _better(found: _Stack | None, best: _Stack | None) -> bool:
    return found is not None and (best is None or found.cost < best.cost)


def _way(row: ColumnCallout, room: Room, side: int, heights: Array) -> _Way:
    """The best leader of a callout on a side at each height of its first line."""
    starts = np.column_stack([np.full(len(heights), room.start(side)), heights + row.start])
    tips, askew, circles = _tips(row, room.scale, starts)
    crossed = crossings(starts[:, None], tips, room.circles)
    long = np.hypot(*(tips - starts[:, None]).transpose(2, 0, 1))
    flat = (np.abs(starts[:, None, 1]) < 2.0) & (np.abs(tips[..., 1]) < 2.0)
    costs = CROSSED * crossed + ASKEW * askew + LEVEL * flat + long
    # with a knee: from there the leader is as good at any height, but for the way to the knee
    knees = room.knees[side * room.knees[:, 0] > 0.0]
    beyond, beyond_askew, beyond_circles = _tips(row, room.scale, knees)
    beyond_crossed = crossings(knees[:, None], beyond, room.circles)
    from_knee = CROSSED * beyond_crossed + ASKEW * beyond_askew
    from_knee = from_knee + np.hypot(*(beyond - knees[:, None]).transpose(2, 0, 1))
    tip = np.argmin(from_knee, axis=1)
    each = np.arange(len(knees))
    to_knee = np.hypot(*(knees[None] - starts[:, None]).transpose(2, 0, 1))
    to_knee = to_knee + 2.0 * np.abs(knees[None, :, 1] - starts[:, None, 1])
    cut = crossings(starts[:, None], np.broadcast_to(knees[None], (len(starts), len(knees), 2)), room.circles)
    through = BENT + CROSSED * cut + from_knee[each, tip] + to_knee
    # the better of both at each height
    here = np.arange(len(heights))
    straight, bent = np.argmin(costs, axis=1), np.argmin(through, axis=1)
    knee = through[here, bent] < costs[here, straight]
    return _Way(
        np.where(knee, through[here, bent], costs[here, straight]),
        np.where(knee[:, None], beyond[bent, tip[bent]], tips[here, straight]),
        np.where(knee, beyond_circles[bent, tip[bent]], circles[here, straight]),
        np.where(knee, beyond_crossed[bent, tip[bent]] + cut[here, bent], crossed[here, straight]),
        np.where(knee[:, None], knees[bent], np.nan),
    )


def _tips(row: ColumnCallout, scale: float, starts: Array) -> tuple[Array, Array, Array]:
    """Ends of leaders from `starts` (n, 2): (n, m, 2), how far each is off a circle's centre, rad, circles (n, m)."""
    ends: list[Array] = []
    askew: list[Array] = []
    circles: list[Array] = []
    for number, (centre, radius) in enumerate(row.circles):
        middle = scale * np.array(centre)
        direction = np.arctan2(starts[:, 1] - middle[1], starts[:, 0] - middle[0])[:, None] + AIM
        ends.append(middle + scale * radius * np.stack([np.cos(direction), np.sin(direction)], axis=2))
        askew.append(np.broadcast_to(np.abs(AIM), direction.shape))
        circles.append(np.full(direction.shape, number))
    if row.points:
        points = scale * np.array(row.points)
        shape = (len(starts), len(points))
        ends.append(np.broadcast_to(points[None], (*shape, 2)))
        askew.append(np.zeros(shape))
        circles.append(np.full(shape, -1))
    return np.concatenate(ends, axis=1), np.concatenate(askew, axis=1), np.concatenate(circles, axis=1)


def crossings(starts: Array, ends: Array, circles: Array) -> Array:
    """Number of circles (k, 3), mm, that each line from `starts` (n, 1, 2) to `ends` (n, m, 2) crosses: (n, m)."""
    x0, y0, x1, y1 = starts[..., 0], starts[..., 1], ends[..., 0], ends[..., 1]
    u, v = x1 - x0, y1 - y0
    over = 1.0 / np.maximum(u * u + v * v, 1e-12)
    found = np.zeros(u.shape)
    for x, y, radius in circles.tolist():
        to_x, to_y = x - x0, y - y0
        share = np.clip((to_x * u + to_y * v) * over, 0.0, 1.0)
        nearest = (to_x - share * u) ** 2 + (to_y - share * v) ** 2
        # an opening at whose edge, or near it, the leader ends may be touched
        near = (x - x1) ** 2 + (y - y1) ** 2 < (radius + NEAR) ** 2
        found += nearest < np.where(near, max(radius - TOUCH, 0.0), radius + CLEAR) ** 2
    return found


def leaders_cost(placed: Sequence[PlacedCallout]) -> float:
    """Lengths of leaders with the penalties of knees and crossings, mm of paper."""
    long = sum(float(np.hypot(*np.diff(each.leader, axis=0).T).sum()) for each in placed)
    bent = sum(len(each.leader) - 2 for each in placed)
    return long + BENT * bent + CROSSED * sum(each.crossings for each in placed) + MET * _meetings(placed)


def _meetings(placed: Sequence[PlacedCallout]) -> int:
    """Number of pairs of leaders that cross each other or share a knee."""
    pairs = [(one.leader, other.leader) for one, other in combinations(placed, 2)]
    knees = sum(len(one) == len(other) > 2 and bool((one[1] == other[1]).all()) for one, other in pairs)
    return knees + sum(_meet(one, other) for one, other in pairs)


def _meet(one: Array, other: Array) -> int:
    """Number of crossings of two chains of points."""
    count = 0
    for a, b in pairwise(one):
        for c, d in pairwise(other):
            count += _turn(a, b, c) * _turn(a, b, d) < 0.0 and _turn(c, d, a) * _turn(c, d, b) < 0.0
    return count


def _turn(a: Array, b: Array, c: Array) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


# --- drawing them -----------------------------------------------------------------------------------------------------


def draw_callouts(page: Page, placed: Sequence[PlacedCallout], middle: Point, scale: float) -> None:
    """Draw callouts of a view whose middle is at a point of the page, at a scale."""
    for each in placed:
        _draw_callout(page, each, middle, scale)


def _draw_callout(page: Page, placed: PlacedCallout, middle: Point, scale: float) -> None:
    row, side = placed.row, placed.side
    points = placed.leader + np.array(middle)
    (ex, ey), (tx, ty) = points[-2].tolist(), points[-1].tolist()
    page.marks.extend([LineMark(points), arrow((tx, ty), math.atan2(ty - ey, tx - ex))])
    out, base = float(points[0, 0]) + APART * side, middle[1] + placed.height
    anchor: Anchor = "right" if side < 0 else "left"
    if row.rough:
        page.marks.extend(finish_symbol((out, base - SYMBOL_LOW), row.text, side))
    else:
        at = out + side * ((LETTER if row.datum else 0.0) + (FRAMED if row.boxed else 0.0))
        label = Text((at, base), row.text, SMALL, anchor, "DIM")
        if row.value is None or placed.circle is None:
            page.marks.append(label)
        else:
            centre, radius = placed.circle
            place = (middle[0] + scale * centre[0], middle[1] + scale * centre[1])
            page.marks.append(round_size(place, scale * radius, label, row.value))
        if row.boxed:
            x0, _, x1, _ = label.box
            page.box((x0 - 0.8, base - 0.8), x1 - x0 + 1.6, SMALL + 1.6)
    for k, note in enumerate(row.notes):
        page.text((out, base - row.lower - SECOND * (k + 1)), note, anchor=anchor, layer="DIM")
    if row.datum:
        draw_letter(page, (out + side * 3.5, base + 0.5 * SMALL), row.datum)


def draw_letter(page: Page, middle: Point, letter: str) -> None:
    """Draw the letter of a datum in its box."""
    x, y = middle
    page.box((x - 2.5, y - 2.5), 5.0, 5.0)
    page.text((x, y - 0.5 * SMALL), letter, SMALL, "middle")


def theoretical(placed: Sequence[PlacedCallout], middle: Point, scale: float) -> list[CircleMark]:
    """Circles about the middle of a view that are no edges of the part, such as bolt circles."""
    return [
        CircleMark(middle, scale * radius, THIN, "CENTRE", "chain")
        for row, *_ in placed
        for centre, radius in row.circles
        if centre == (0.0, 0.0) and not row.datum and not row.rough
    ]
