"""The first page: face, section through the shaft, bore, and every dimension of the part.

Dimensions stand outside the views: diameters and features in columns beside the face, lengths in lanes below and beside
the section. The layout knows the size of every text, so that no two overlap whatever the part.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sheet.callouts import (
    APART,
    CROSSED,
    ColumnCallout,
    Room,
    crossings,
    draw_callouts,
    draw_letter,
    knees_about,
    leaders_cost,
    place_callouts,
    theoretical,
)
from camgeo.capabilities.sheet.lettering import PLAIN, SMALL, width
from camgeo.capabilities.sheet.marks import (
    ARROW,
    PLANE,
    THICK,
    THIN,
    CircleMark,
    LineMark,
    Page,
    across,
    arrow,
    has_room,
    shifted,
    text_beyond,
)
from camgeo.capabilities.sheet.options import SCALES
from camgeo.capabilities.sheet.part import deviation_words, hatching, number, screw_holes, section_edges
from camgeo.part.features import with_records
from camgeo.part.flat import Flat
from camgeo.part.iso286 import HOLES, UPPER_ENDS, deviations
from camgeo.part.keyway import Keyway
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from camgeo.capabilities.sheet.callouts import PlacedCallout
    from camgeo.capabilities.sheet.frame import Area
    from camgeo.capabilities.sheet.marks import Point
    from camgeo.capabilities.sheet.part import DrawnDisc, Loop
    from camgeo.part.part import Part
    from kin.numeric.arrays import Array

ROUND = 17.0  # mm of paper round the face: zero mark, sense of rotation, ends of the section line
LEFT = 12.0  # mm on its left, where the centre line's end stands, and leaders begin
LANE = 8.0  # mm between dimension lines
STRIP = 14.0  # mm above the views: tolerance frame, name of the section
UNDER = 7.0  # mm below the views: names of views
CELL = 7.0  # mm: height of a tolerance frame
KNEE = 7.0  # mm: of its leader before it
UNSTATED = "contour: no profile tolerance is stated"
NARROW = 6.0  # mm: between views
TOP = 5.5  # mm from the upper end of the face's area to the first line of callouts
CLEARANCE = 0.8  # mm between a leader and the texts about the face
COVER = 14.0  # mm between circles that cover a view
SENSES = math.radians(48.0)  # to either side of the ray at 0: where the arcs that show the senses stand
SMALLER = 2  # scales by which the views may become smaller so that no leader crosses an opening
WORTH = 1.25  # of what leaders cost on both sides of the face: they have to be so much better than on its left
PLACES = 24  # at which the leader of a surface's roughness may end
HATCH = 2.5  # mm between lines of the hatching
DATUM = 2.0 * ARROW + 9.5  # mm: how far a datum's box reaches beyond a short dimension's line


_SURFACES: tuple[tuple[str, Callable[[Loop], bool]], ...] = (
    ("contour", lambda loop: loop.surface),
    ("bore", lambda loop: loop.layer == "BORE"),
)
"""Surfaces whose roughness a drawing states, and the outline of each."""


class NoRoomError(CamgeoError, ValueError):
    """The views do not fit on the paper at a scale; `largest` is the largest of ISO 5455 that does, empty for none."""

    def __init__(self, largest: str) -> None:
        super().__init__(largest)
        self.largest = largest


class Along(NamedTuple):
    """A length of the section along the shaft, between two heights z, mm."""

    low: float
    high: float
    text: str


class Across(NamedTuple):
    """A diameter about the shaft, mm, at a height z of the section."""

    z: float
    diameter: float
    text: str


class Tolerance(NamedTuple):
    """Profile tolerance of the contour, mm, None where none is stated, and its datums."""

    width: float | None
    datums: tuple[str, ...]

    @property
    def cells(self) -> tuple[tuple[str, float], ...]:
        """Texts of its frame behind the symbol, each with the width of its cell, mm; none where none is stated."""
        texts = () if self.width is None else (number(self.width), *self.datums)
        return tuple((text, max(CELL, width(text, PLAIN) + 3.0)) for text in texts)

    @property
    def long(self) -> float:
        """Width of frame and leader, or of the words in their place, mm."""
        return KNEE + CELL + sum(wide for _, wide in self.cells) if self.cells else width(UNSTATED, SMALL)


@dataclass(frozen=True)
class Dimensions:
    """Every dimension of a disc by its place in the drawing.

    `column` are callouts of the face, `under` lengths along the shaft, shortest first, `right` diameters on the right
    of the section, the boss before the disc, and `bore` the diameter on its left. `tolerance` is the contour's.
    """

    column: tuple[ColumnCallout, ...]
    under: tuple[Along, ...]
    right: tuple[Across, ...]
    bore: Across | None
    tolerance: Tolerance


def disc_sizes(
    drawn: DrawnDisc, base: tuple[str, float] | None, tolerance: Tolerance, finish: Mapping[str, str]
) -> Dimensions:
    """Every dimension of a disc; `base` is the name and radius, mm, of the circle from which the contour is described.

    `finish` has the roughness of the contour and of the bore where it is stated. Without a thickness there is no
    section, and its diameters are callouts of the face.
    """
    part, body = drawn.part, drawn.body
    column: list[ColumnCallout] = []
    if base is not None:
        name, radius = base
        column.append(_about_shaft(2.0 * radius, name, boxed=True))
    features = ((feature.callouts, value) for feature, value in with_records(part.features))
    sizes = [callouts(value, drawn.view) for callouts, value in features if callouts is not None]
    column += [ColumnCallout(*size) for each in sizes for size in each]
    edges = {name: next(loop.points for loop in drawn.loops if of(loop)) for name, of in _SURFACES if name in finish}
    column += [
        ColumnCallout(finish[name], points=tuple(map(tuple, points[:: len(points) // PLACES + 1].tolist())), rough=True)
        for name, points in edges.items()
    ]
    thick = body.thickness
    plain = part.bore is not None and not part.sides
    bore_text = f"Ø{number(part.bore or 0.0)}{_fit_words(part)}"
    if thick is None:
        if plain and part.bore is not None:
            column.append(_about_shaft(part.bore, "bore", text=bore_text, datum="A"))
        if part.outer is not None:
            column.append(_about_shaft(part.outer))
        return Dimensions(_merged(column), (), (), None, tolerance)
    under = [Along(0.0, thick, number(thick))]
    if body.pocket is not None:
        under.append(Along(thick - body.pocket, thick, f"{number(body.pocket)} groove"))
    right = []
    boss = part.boss
    if boss is not None:
        both = "2 × " if boss.above and boss.below else ""
        ends = (thick, body.top) if boss.above else (body.bottom, 0.0)
        under.append(Along(*ends, f"{both}{number(boss.above or boss.below)} {boss.name}"))
        right.append(Across(body.top if boss.above else body.bottom, boss.diameter, f"Ø{number(boss.diameter)}"))
    if part.outer is not None:
        right.append(Across(thick, part.outer, f"Ø{number(part.outer)}"))
    bore = None
    if plain and part.bore is not None:
        bore = Across(body.bottom, part.bore, bore_text)
    return Dimensions(
        _merged(column),
        tuple(sorted(under, key=lambda length: length.high - length.low)),
        tuple(right),
        bore,
        tolerance,
    )


def _about_shaft(
    diameter: float, name: str = "", *, text: str = "", boxed: bool = False, datum: str = ""
) -> ColumnCallout:
    """Callout of a circle about the shaft of a diameter, mm."""
    circle = ((0.0, 0.0), 0.5 * diameter)
    text = text or f"Ø{number(diameter)}"
    return ColumnCallout(text, (name,) if name else (), (circle,), value=diameter, boxed=boxed, datum=datum)


def _merged(column: Sequence[ColumnCallout]) -> tuple[ColumnCallout, ...]:
    """The callouts, of which those of one circle about the shaft are one, so that its size stands once."""
    merged: dict[object, ColumnCallout] = {}
    for k, row in enumerate(column):
        about = len(row.circles) == 1 and row.circles[0][0] == (0.0, 0.0) and not row.boxed and not row.datum
        key = row.text if about else k
        first = merged.get(key)
        merged[key] = row if first is None else first._replace(notes=(*first.notes, *row.notes))
    return tuple(merged.values())


def _fit_words(part: Part) -> str:
    """Tolerance class of a bore, and its deviations where the tables have them."""
    if not part.fit:
        return ""
    if (part.bore or 0.0) > UPPER_ENDS[-1]:
        return f" {part.fit}"
    return f" {part.fit} ({deviation_words(*deviations(HOLES[part.fit], part.bore or 0.0))})"


# --- the layout -------------------------------------------------------------------------------------------------------


class Extent(NamedTuple):
    """Ends in x and y, mm from the shaft, of the face and of its circles about the shaft.

    `right` is as far out as the arcs that show the senses stand clear of the part.
    """

    left: float
    right: float
    low: float
    high: float


def _outline(drawn: DrawnDisc, sizes: Dimensions) -> Array:
    """Points (n, 2), mm, of all outlines of the face, and of circles about the shaft."""
    radii = [radius for row in sizes.column for centre, radius in row.circles if centre == (0.0, 0.0)]
    radii += [] if drawn.body.boss is None else [0.5 * drawn.body.boss.diameter]
    turn = np.linspace(0.0, 2.0 * np.pi, 121)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    return np.concatenate([*(loop.points for loop in drawn.loops), *(radius * circle for radius in radii)])


def _extent(points: Array) -> Extent:
    (left, low), (right, high) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    ahead = points[np.abs(np.arctan2(points[:, 1], points[:, 0])) <= SENSES]
    far = float(np.hypot(*ahead.T).max()) if len(ahead) else 0.0
    return Extent(min(left, 0.0), max(right, far, 0.0), min(low, 0.0), max(high, 0.0))


class Layout(NamedTuple):
    """Places of the views at a scale: centre of the face, left end of the section, centre of the view of the bore.

    `word` is the scale as a key of SCALES, `scale` its value, `extent` the face's, mm of paper; `callouts` stand beside
    the face. `sense` is the direction of view along x, 1 or -1: the section stands on the right, so in the first angle
    it is seen from the left (1).
    """

    word: str
    scale: float
    face: Point
    section: Point
    bore: Point
    extent: Extent
    callouts: Sequence[PlacedCallout]
    sense: float = 1.0

    @property
    def cost(self) -> float:
        """Lengths of its leaders with their penalties, mm of paper."""
        return leaders_cost(self.callouts)

    @property
    def crossings(self) -> int:
        """Openings and texts that leaders cross."""
        return sum(callout.crossings for callout in self.callouts)


def lay_out(drawn: DrawnDisc, sizes: Dimensions, area: Area, scale: str | None, sense: float) -> Layout:
    """Place the views at a scale, a key of SCALES, or for None at the largest that fits; `sense` is that of Layout.

    Where leaders would cross an opening the next smaller scales are tried too. Raises NoRoomError where the views do
    not fit; for a given scale it names the largest that fits, if there is one.
    """
    found: list[Layout] = []
    for layout in _layouts(drawn, sizes, area, SCALES if scale is None else (scale,)):
        found.append(layout)
        if not layout.crossings or len(found) > SMALLER:
            break
    if found:
        return min(found, key=lambda layout: layout.crossings)._replace(sense=sense)
    fits = iter(()) if scale is None else _layouts(drawn, sizes, area, SCALES)
    raise NoRoomError(next((layout.word for layout in fits), ""))


def _layouts(drawn: DrawnDisc, sizes: Dimensions, area: Area, words: Iterable[str]) -> Iterator[Layout]:
    """The best layout at each of these scales at which the views fit.

    Callouts stand on the left of the face alone, unless leaders are clearer or much shorter with some on its right.
    """
    for word in words:
        for beside in (True, False):
            left, both = (_lay_out_at(drawn, sizes, area, word, beside=beside, both=both) for both in (False, True))
            layouts = [layout for layout in (left, both) if layout is not None]
            if layouts:
                yield min(layouts, key=lambda layout: layout.cost * (1.0 if layout is left else WORTH))
                break


def _lay_out_at(
    drawn: DrawnDisc, sizes: Dimensions, area: Area, word: str, *, beside: bool, both: bool
) -> Layout | None:
    """Place the views at a scale, or give None where they do not fit.

    The bore's own view stands `beside` the others or below; callouts stand on `both` sides of the face or on its left.
    """
    k = SCALES[word]
    points = k * _outline(drawn, sizes)
    extent = _extent(points)
    broad, tall = extent.right - extent.left, extent.high - extent.low
    own = _bore_view(drawn, k)
    below = max(UNDER, LANE * len(sizes.under))
    high = STRIP + tall + 2.0 * ROUND + below + (0.0 if beside else own.above + own.below)
    gap = NARROW + LANE if sizes.bore is not None else NARROW
    section = gap + k * drawn.depth + _beyond(sizes, k) if drawn.body.thickness is not None else 0.0
    face = LEFT + broad + ROUND + section + (own.wide if beside else 0.0)
    if face > area.right - area.left or high > area.high - area.low:
        return None
    y = area.high - STRIP - extent.high - ROUND - 0.5 * (area.high - area.low - high)
    # a view of the bore below the face stands clear of the column, which may reach down beside it
    foot = extent.low - ROUND - below
    aside = max(0.0, extent.left - LEFT + NARROW + 0.5 * own.wide)
    room = _room(drawn, extent, points, k, area.low - y)
    if own.wide and not beside:
        room = room._replace(texts=np.concatenate([room.texts, _cover(aside, foot, own)]))
    callouts = place_callouts(sizes.column, room, both=both)
    if callouts is None:
        return None
    left, right = (max((each.row.wide for each in callouts if each.side == side), default=0.0) for side in (-1, 1))
    # widths from the left; the tolerance stands above the face and may reach over the column
    left = max(left, sizes.tolerance.long - LEFT - broad - ROUND)
    wide = left + face + right
    if not beside:
        wide = max(wide, left + LEFT - extent.left + aside + 0.5 * own.wide)
    if wide > area.right - area.left:
        return None
    # places: the views in the middle of the area
    start = area.left + left + 0.5 * (area.right - area.left - wide)
    x, end = start + LEFT - extent.left, start + LEFT + broad + ROUND + right
    bore = (end + section + 0.5 * own.wide, y) if beside else (x + aside, y + foot - own.above)
    return Layout(word, k, (x, y), (end + gap, y), bore, extent, callouts)


def _cover(x: float, top: float, own: BoreView) -> Array:
    """Circles (n, 3) that cover a view of the bore about x below a height, mm of paper from the shaft."""
    left, right, low = x - 0.5 * own.wide, x + 0.5 * own.wide, top - own.above - own.below
    columns, rows = (max(2, math.ceil(long / COVER) + 1) for long in (right - left, top - low))
    grid = np.meshgrid(np.linspace(left, right, columns), np.linspace(low, top, rows))
    centres = np.column_stack([each.ravel() for each in grid])
    return np.column_stack([centres, np.full(len(centres), 0.71 * COVER)])


def _room(drawn: DrawnDisc, extent: Extent, points: Array, k: float, low: float) -> Room:
    """Room for the callouts of the face at a scale k, about points of paper (n, 2).

    `low` is the lower end of the free area below the shaft, mm.
    """
    texts = [
        (x + shift, y + 0.5 * height, 0.5 * height + CLEARANCE)
        for (x, y), text, height in (*_marks_of_sense(extent), *_letters_of_plane(drawn, extent))
        for shift in np.arange(0.0, width(text, height) + 1.0, height)
    ]
    return Room(
        left=extent.left - LEFT + APART,
        right=extent.right + ROUND - APART,
        low=low,
        high=extent.high + ROUND - TOP,
        knees=knees_about(points),
        openings=k * np.array(drawn.holes).reshape(-1, 3),
        texts=np.array(texts),
        scale=k,
    )


def _beyond(sizes: Dimensions, k: float) -> float:
    """Width to the right of the section, mm on the paper: lanes of dimensions, or texts beyond their lines."""
    texts = (text_beyond(k * (length.high - length.low), length.text) for length in sizes.under)
    return max(LANE * len(sizes.right), *texts) + 1.0


def _width_words(keyway: Keyway) -> str:
    """Width of a keyway, with its tolerance class and deviations where one is stated."""
    fit = f" {keyway.fit} ({deviation_words(*keyway.wider)})" if keyway.fit else ""
    return f"{number(keyway.width)}{fit}"


class BoreView(NamedTuple):
    """Space of the view of the bore on the paper, mm: its width, and its extent above and below the shaft."""

    wide: float
    above: float
    below: float


def _bore_view(drawn: DrawnDisc, k: float) -> BoreView:
    """Size of the bore's own view at the scale k; 0 for a round bore, or none."""
    part = drawn.part
    if part.bore is None or part.round_bore:
        return BoreView(0.0, 0.0, 0.0)
    reach = k * next(opening.reach for opening in drawn.body.openings if opening.name == "bore")
    above, below = reach + 4.0, reach + LANE + 2.0
    if (keyway := part.of(Keyway)) is not None:
        above = max(above, 0.5 * k * keyway.width + 2.0 * ARROW + width(_width_words(keyway), SMALL) + 4.0)
        below = max(below, 0.5 * k * keyway.width + DATUM + 2.0)
    return BoreView(
        max(2.0 * reach + 4.0 * LANE + 8.0, width(_bore_label(drawn)[1], SMALL) + 4.0), above, below + UNDER
    )


def _bore_label(drawn: DrawnDisc) -> tuple[float, str]:
    """Direction of a bore's keyway, flat or side in the recipe, rad, and the words under its own view."""
    part = drawn.part
    at, what = part.bore_at, f"{'square' if part.sides == 4 else 'hexagon'}, a flat's normal"
    if (keyway := part.of(Keyway)) is not None:
        at, what = keyway.at, "keyway"
    elif (flat := part.of(Flat)) is not None:
        at, what = flat.at, "flat"
    return at, f"bore, {what} at {drawn.degrees(at)}"


# --- drawing it -------------------------------------------------------------------------------------------------------


def draw_views(page: Page, drawn: DrawnDisc, sizes: Dimensions, layout: Layout) -> None:
    """Draw all views with their dimensions on a page."""
    _draw_face(page, drawn, layout)
    draw_callouts(page, layout.callouts, layout.face, layout.scale)
    _draw_tolerance(page, drawn, layout, sizes.tolerance)
    if drawn.body.thickness is not None:
        _draw_section(page, drawn, sizes, layout)
    if _bore_view(drawn, 1.0).wide:
        _draw_bore(page, drawn, layout, sizes.tolerance)


def _draw_face(page: Page, drawn: DrawnDisc, layout: Layout) -> None:
    k, (x, y) = layout.scale, layout.face
    left, right, low, high = layout.extent
    for loop in drawn.loops:
        page.marks.append(LineMark(shifted(loop.points, k, layout.face), THICK, "", closed=True))
    boss = drawn.body.boss
    if boss is not None:
        outline = CircleMark(layout.face, 0.5 * k * boss.diameter, THICK, "VIEW")
        page.marks.append(outline if boss.above else replace(outline, weight=THIN, pattern="dashed"))
    page.line((x + left - 4.0, y), (x + right + 2.0, y), layer="CENTRE", pattern="chain")
    solid = drawn.body.thickness is not None
    page.line((x, y + low - 3.0), (x, y + high + 3.0), layer="CENTRE", pattern="chain")
    page.marks.extend(theoretical(layout.callouts, layout.face, k))
    for start, stop in drawn.hidden:
        page.marks.append(LineMark(shifted([start, stop], k, layout.face), THIN, "VIEW", "dashed"))
    for opening in drawn.body.openings:
        if opening.circle is not None and opening.name != "bore":
            (cx, cy), r = opening.circle
            at, half = (x + k * cx, y + k * cy), k * r + 1.5
            page.line((at[0] - half, at[1]), (at[0] + half, at[1]), layer="CENTRE")
            page.line((at[0], at[1] - half), (at[0], at[1] + half), layer="CENTRE")
    # the mark of the angle 0
    page.line((x + right + 3.0, y), (x + right + 8.0, y), weight=THICK)
    for (u, v), text, height in _marks_of_sense(layout.extent):
        page.text((x + u, y + v), text, height)
    _draw_sense(page, layout.face, right + 5.0, *((14.0, 40.0) if drawn.ccw else (40.0, 14.0)))
    _draw_sense(page, layout.face, right + 5.0, -40.0, -14.0)
    if solid:
        _draw_plane(page, drawn, layout)


def _marks_of_sense(extent: Extent) -> list[tuple[Point, str, float]]:
    """Texts right of the face, mm from its middle: where the angles begin, what turns, and which way angles count."""
    out = extent.right + 5.0
    c, s = out * math.cos(math.radians(40.0)), out * math.sin(math.radians(40.0))
    return [
        ((extent.right + 9.0, -0.5 * SMALL), "0°", SMALL),
        ((c + 1.0, s + 1.0), "shaft", SMALL),
        ((c + 1.0, -s - 1.0 - SMALL), "angles", SMALL),
    ]


def _draw_sense(page: Page, middle: Point, radius: float, start: float, end: float) -> None:
    """Arc about the middle of the face from one angle to another, degrees, with an arrow at its end."""
    x, y = middle
    angles = np.radians(np.linspace(start, end, 24))
    points = np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])
    page.marks.append(LineMark(points))
    tip = (float(points[-1, 0]), float(points[-1, 1]))
    page.marks.append(arrow(tip, float(angles[-1]) + math.copysign(0.5 * math.pi, end - start)))


def _letters_of_plane(drawn: DrawnDisc, extent: Extent) -> list[tuple[Point, str, float]]:
    """Letters at the ends of the cutting plane, mm from the middle of the face; none without a section."""
    if drawn.body.thickness is None:
        return []
    above, below = extent.high + 11.3, extent.low - 11.3 - PLAIN
    return [((-0.5 * PLAIN, above), "A", PLAIN), ((-0.5 * PLAIN, below), "A", PLAIN)]


def _draw_plane(page: Page, drawn: DrawnDisc, layout: Layout) -> None:
    """Thick ends of the cutting plane, with arrows in the direction of view."""
    (x, y), sense = layout.face, layout.sense
    for side, end in ((-1.0, layout.extent.low), (1.0, layout.extent.high)):
        edge = y + end
        inner, outer = edge + side * 4.0, edge + side * 10.0
        page.line((x, inner), (x, outer), weight=PLANE)
        page.line((x, outer), (x + sense * 6.0, outer))
        page.marks.append(arrow((x + sense * 6.0, outer), 0.0 if sense > 0.0 else math.pi))
    for (u, v), letter, height in _letters_of_plane(drawn, layout.extent):
        page.text((x + u + 0.5 * PLAIN, y + v), letter, height, "middle")


def _draw_datum(page: Page, at: Point, direction: Point, letter: str) -> None:
    """Datum symbol of ISO 5459: a filled triangle at a point, and its letter in a box some way along a direction."""
    (x, y), (u, v) = at, direction
    base = [(x - 1.2 * v, y + 1.2 * u), (x + 1.2 * v, y - 1.2 * u), (x + 2.0 * u, y + 2.0 * v)]
    page.marks.append(LineMark(np.array(base), closed=True, filled=True))
    page.line((x + 2.0 * u, y + 2.0 * v), (x + 4.5 * u, y + 4.5 * v))
    draw_letter(page, (x + 7.0 * u, y + 7.0 * v), letter)


def _draw_tolerance(page: Page, drawn: DrawnDisc, layout: Layout, tolerance: Tolerance) -> None:
    """Profile of a surface with its tolerance, all around, by the datums; or that none is stated."""
    k, (x, y) = layout.scale, layout.face
    extent = layout.extent
    low = y + extent.high + ROUND + 2.0
    left = min(x + extent.left, x + extent.right + ROUND - tolerance.long)
    if not tolerance.cells:
        page.text((left, low + 2.0), UNSTATED)
        return
    knee = (left + 0.3 * KNEE, low + 0.5 * CELL)
    # the nearest place of the contour, so that the leader meets it at right angles, but behind no opening
    contour = shifted(next(loop.points for loop in drawn.loops if loop.surface), k, layout.face)
    circles = k * np.array(drawn.holes).reshape(-1, 3) + np.array([x, y, 0.0])
    costs = np.hypot(*(contour - np.array(knee)).T)
    costs = costs + CROSSED * crossings(np.array([[knee]]), contour[None], circles)[0]
    tip_x, tip_y = contour[int(np.argmin(costs))].tolist()
    tip = (tip_x, tip_y)
    page.line(tip, knee, (left + KNEE, knee[1]))
    page.marks.append(arrow(tip, math.atan2(tip[1] - knee[1], tip[0] - knee[0])))
    page.marks.append(CircleMark(knee, 1.4, THIN, "DIM"))
    x = left + KNEE
    page.box((x, low), CELL, CELL)
    arc = np.linspace(0.0, math.pi, 17)
    symbol = np.column_stack([x + 0.5 * CELL + 2.0 * np.cos(arc), low + 2.4 + 2.0 * np.sin(arc)])
    page.marks.append(LineMark(symbol, closed=True))
    x += CELL
    for text, wide in tolerance.cells:
        page.box((x, low), wide, CELL)
        page.text((x + 0.5 * wide, low + 0.5 * (CELL - PLAIN)), text, PLAIN, "middle")
        x += wide


def _draw_section(page: Page, drawn: DrawnDisc, sizes: Dimensions, layout: Layout) -> None:
    """The section A-A, its lower face on the left in the first angle, on the right in the third."""
    k, (left, y) = layout.scale, layout.section
    body, sense = drawn.body, layout.sense

    def placed(z: float, height: float) -> Point:
        along = z - body.bottom if sense > 0.0 else body.top - z
        return left + k * along, y + k * height

    cut, edges = section_edges(drawn, sense)
    chains = [[placed(*point) for point in chain] for chain in cut]
    for chain in chains:
        page.marks.append(LineMark(np.array(chain), THICK, "VIEW", closed=True))
    gone = [[placed(*point) for point in ring] for ring in screw_holes(drawn)]
    for ring in gone:
        page.marks.append(LineMark(np.array(ring), THICK, "VIEW", closed=True))
    for ends in hatching([*chains, *gone], HATCH):
        page.marks.append(LineMark(ends, THIN, "HATCH"))
    behind = [[placed(*point) for point in edge] for edge in edges]
    for edge in behind:
        page.line(*edge, weight=THICK, layer="VIEW")
    right = left + k * drawn.depth
    page.line((left - 4.0, y), (right + 4.0, y), layer="CENTRE", pattern="chain")
    top = y + layout.extent.high + ROUND + 2.0
    page.text((0.5 * (left + right), top + 1.5), "A-A", PLAIN, "middle")
    low = min(height for chain in [*chains, *behind] for _, height in chain)
    # the lengths stand below the part, and below the datum of its bore where that reaches lower
    lanes = low if sizes.bore is None else min(low, y - 0.5 * k * sizes.bore.diameter - DATUM)
    spans = [sorted(placed(z, 0.0)[0] for z in (length.low, length.high)) for length in sizes.under]
    for i, (length, (start, end)) in enumerate(zip(sizes.under, spans, strict=True)):
        # a text stands on the side where no extension line of another length runs
        before, value = end < max(x for _, x in spans), length.high - length.low
        page.marks.append(across((start, low), (end, low), lanes - LANE * (i + 1), value, length.text, before=before))
    for i, round_one in enumerate(sizes.right):
        first, second = (placed(round_one.z, half * round_one.diameter) for half in (-0.5, 0.5))
        base, value = right + LANE * (i + 1), round_one.diameter
        page.marks.append(across(first, second, base, value, round_one.text, upright=True))
    if sizes.bore is not None:
        bore, base, half = sizes.bore, left - LANE, 0.5 * k * sizes.bore.diameter
        page.marks.append(across((left, y - half), (left, y + half), base, bore.diameter, bore.text, upright=True))
        _draw_datum(page, (base, y - half - (0.0 if has_room(2.0 * half) else 2.0 * ARROW)), (0.0, -1.0), "A")


def _draw_bore(page: Page, drawn: DrawnDisc, layout: Layout, tolerance: Tolerance) -> None:
    """A bore that is not round, turned so that its keyway or flat is on the right, and its sizes."""
    part, k, (x, y) = drawn.part, layout.scale, layout.bore
    bore = part.bore or 0.0
    points = next(loop.points for loop in drawn.loops if loop.layer == "BORE")
    at, words = _bore_label(drawn)
    turned = _turned(points, -drawn.direction(at))
    page.marks.append(LineMark(shifted(turned, k, layout.bore), THICK, "VIEW", closed=True))
    # outline and centre lines, then the size of the keyway, the flat or the sides
    low, high = k * float(turned[:, 1].min()), k * float(turned[:, 1].max())
    left, right = k * float(turned[:, 0].min()), k * float(turned[:, 0].max())
    page.line((x + left - 3.0, y), (x + right + 3.0, y), layer="CENTRE", pattern="chain")
    page.line((x, y + low - 3.0), (x, y + high + 3.0), layer="CENTRE", pattern="chain")
    base = y + low - LANE
    if (key := part.of(Keyway)) is not None:
        corner = 0.5 * bore + key.depth
        value = bore + key.depth
        ends = (x + left, y), (x + k * corner, y - 0.5 * k * key.width)
        deeper = f" {deviation_words(0.0, key.deeper)}" if key.deeper else ""
        page.marks.append(across(*ends, base, value, f"{number(value)}{deeper}", before=True))
        edges = (x + k * corner, y - 0.5 * k * key.width), (x + k * corner, y + 0.5 * k * key.width)
        lane = x + k * corner + LANE
        page.marks.append(across(*edges, lane, key.width, _width_words(key), upright=True))
        if "B" in tolerance.datums:
            half = 0.5 * k * key.width
            _draw_datum(page, (lane, y - half - (0.0 if has_room(2.0 * half) else 2.0 * ARROW)), (0.0, -1.0), "B")
    elif (flat := part.of(Flat)) is not None:
        across_flat = flat.across
        ends = (x + left, y), (x + k * (across_flat - 0.5 * bore), y)
        page.marks.append(across(*ends, base, across_flat, number(across_flat), before=True))
        if "B" in tolerance.datums:
            _draw_datum(page, (x + k * (across_flat - 0.5 * bore), y), (1.0, 0.0), "B")
    else:
        ends = (x - 0.5 * k * bore, y), (x + 0.5 * k * bore, y)
        page.marks.append(across(*ends, base, bore, number(bore), before=True))
        _draw_datum(page, (x + right, y), (1.0, 0.0), "A")
    page.text((x, y - _bore_view(drawn, k).below + 3.0), words, SMALL, "middle")


def _turned(points: Array, angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    turned: Array = points @ np.array([[c, s], [-s, c]])
    return turned
