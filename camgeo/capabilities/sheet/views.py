"""The first page: face, section through the shaft, bore, and every dimension of the part.

Dimensions stand outside the views: diameters and features in a column on the left, lengths in lanes below and beside
the section. The layout knows the size of every text, so that no two overlap whatever the part.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sheet.lettering import PLAIN, SMALL, width
from camgeo.capabilities.sheet.marks import (
    ARROW,
    THICK,
    THIN,
    CircleMark,
    LineMark,
    Page,
    Text,
    across,
    arrow,
    has_room,
    leader,
    round_size,
    shifted,
    text_beyond,
)
from camgeo.capabilities.sheet.options import SCALES
from camgeo.capabilities.sheet.part import hatching, number, sections
from camgeo.part.features import with_records
from camgeo.part.flat import Flat
from camgeo.part.keyway import Keyway
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.capabilities.sheet.frame import Area
    from camgeo.capabilities.sheet.marks import Point
    from camgeo.capabilities.sheet.part import DrawnDisc
    from kin.numeric.arrays import Array

ROUND = 17.0  # mm of paper round the face: zero mark, sense of rotation, ends of the section line
LEFT = 6.0  # mm on its left, where nothing but the centre line's end stands
LANE = 8.0  # mm between dimension lines
PITCH = 5.5  # mm between callouts of the column
SECOND = 3.8  # mm from the first line of a callout to the second
SLANT = 6.0  # mm by which a callout stands lower whose leader would lie on the centre line
STRIP = 14.0  # mm above the views: tolerance frame, name of the section
UNDER = 7.0  # mm below the views: names of views
CELL = 7.0  # mm: height of a tolerance frame
KNEE = 7.0  # mm: of its leader before it
UNSTATED = "contour: no profile tolerance is stated"
NARROW = 6.0  # mm: between views
HATCH = 2.5  # mm between lines of the hatching
DATUM = 2.0 * ARROW + 9.5  # mm: how far a datum's box reaches beyond a short dimension's line


class NoRoomError(CamgeoError, ValueError):
    """The views do not fit on the paper at a scale; `largest` is the largest of ISO 5455 that does, empty for none."""

    def __init__(self, largest: str) -> None:
        super().__init__(largest)
        self.largest = largest


class ColumnCallout(NamedTuple):
    """A callout of the column: what it points at, as centre, radius and angle (rad) of a circle of the part or a point.

    Its first line is `text`, boxed where the size is theoretically exact; `note` is the second, empty for none. `value`
    is a diameter, mm, that is a dimension; None of words. `datum` is the letter of the datum that the feature is.
    """

    text: str
    note: str
    centre: Point
    radius: float
    angle: float
    value: float | None = None
    boxed: bool = False
    datum: str = ""

    @property
    def wide(self) -> float:
        """Width on the paper, mm."""
        first = width(self.text, SMALL) + (CELL + 2.0 if self.datum else 0.0) + (2.0 if self.boxed else 0.0)
        return max(first, width(self.note, SMALL))

    @property
    def high(self) -> float:
        """Height from its first line to the next callout's, mm on the paper."""
        return PITCH + (SECOND if self.note else 0.0)

    @property
    def tip(self) -> Point:
        """End of the leader on the part, x and y, mm."""
        return (
            self.centre[0] + self.radius * math.cos(self.angle),
            self.centre[1] + self.radius * math.sin(self.angle),
        )


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


def disc_sizes(drawn: DrawnDisc, base: tuple[str, float] | None, tolerance: Tolerance) -> Dimensions:
    """Every dimension of a disc; `base` is the name and radius, mm, of the circle from which the contour is described.

    Without a thickness there is no section, and its diameters are callouts of the face.
    """
    part, body = drawn.part, drawn.body
    column: list[ColumnCallout] = []
    origin = (0.0, 0.0)
    if base is not None:
        name, radius = base
        column.append(
            ColumnCallout(f"Ø{number(2.0 * radius)}", name, origin, radius, 0.8 * math.pi, 2.0 * radius, boxed=True)
        )
    features = ((feature.callouts, value) for feature, value in with_records(part.features))
    sizes = [callouts(value, drawn.view) for callouts, value in features if callouts is not None]
    column += [ColumnCallout(*size) for each in sizes for size in each]
    thick = body.thickness
    plain = part.bore is not None and not part.sides
    if thick is None:
        if plain and part.bore is not None:
            text = f"Ø{number(part.bore)} {part.fit}".rstrip()
            column.append(ColumnCallout(text, "bore", origin, 0.5 * part.bore, 1.1 * math.pi, part.bore, datum="A"))
        if part.outer is not None:
            column.append(
                ColumnCallout(f"Ø{number(part.outer)}", "", origin, 0.5 * part.outer, 0.9 * math.pi, part.outer)
            )
        return Dimensions(tuple(column), (), (), None, tolerance)
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
        bore = Across(body.bottom, part.bore, f"Ø{number(part.bore)} {part.fit}".rstrip())
    return Dimensions(
        tuple(column), tuple(sorted(under, key=lambda length: length.high - length.low)), tuple(right), bore, tolerance
    )


# --- the layout -------------------------------------------------------------------------------------------------------


class Layout(NamedTuple):
    """Places of the views at a scale: centre of the face, left end of the section, centre of the view of the bore.

    `word` is the scale as a key of SCALES, `scale` its value, `column` the right end of the column, `area` the free
    area, mm on the paper. `sense` is the direction of view along x, 1 or -1: the section stands on the right, so in the
    first angle it is seen from the left (1).
    """

    word: str
    scale: float
    face: Point
    section: Point
    bore: Point
    column: float
    area: Area
    sense: float = 1.0


def lay_out(drawn: DrawnDisc, sizes: Dimensions, area: Area, scale: str | None, sense: float) -> Layout:
    """Place the views at a scale, a key of SCALES, or for None at the largest that fits; `sense` is that of Layout.

    Raises NoRoomError where they do not fit; for a given scale it names the largest that fits, if there is one.
    """
    words = SCALES if scale is None else (scale,)
    for word in words:
        for beside in (True, False):
            layout = _lay_out_at(drawn, sizes, area, word, beside=beside)
            if layout is not None:
                return layout._replace(sense=sense)
    fits = (word for word in SCALES for beside in (True, False) if _lay_out_at(drawn, sizes, area, word, beside=beside))
    raise NoRoomError("" if scale is None else next(fits, ""))


def _lay_out_at(drawn: DrawnDisc, sizes: Dimensions, area: Area, word: str, *, beside: bool) -> Layout | None:
    """Place the views at a scale, the bore's own view beside the others or below; None where they do not fit."""
    k = SCALES[word]
    reach = k * drawn.reach
    # widths from the left; the tolerance stands above the face and may reach over the column
    column = max((callout.wide for callout in sizes.column), default=0.0) + (NARROW if sizes.column else 0.0)
    face = max(LEFT + 2.0 * reach + ROUND, sizes.tolerance.long - column)
    gap = NARROW + LANE if sizes.bore is not None else NARROW
    section = gap + k * drawn.depth + _beyond(sizes, k) if drawn.body.thickness is not None else 0.0
    own = _bore_view(drawn, k)
    below = max(UNDER, LANE * len(sizes.under))
    wide = column + face + section + (own.wide if beside else 0.0)
    high = STRIP + 2.0 * (reach + ROUND) + below + (0.0 if beside else own.above + own.below)
    if wide > area.right - area.left or high > area.high - area.low:
        return None
    # places: the views in the middle of the area; the column, from the face's upper end downward, stays within it
    start = area.left + column + 0.5 * (area.right - area.left - wide)
    x, y = start + face - reach - ROUND, area.high - STRIP - reach - ROUND - 0.5 * (area.high - area.low - high)
    if sum(callout.high for callout in sizes.column) + SLANT > y + reach + ROUND - area.low:
        return None
    bore = (start + face + section + 0.5 * own.wide, y) if beside else (x, y - reach - ROUND - below - own.above)
    return Layout(word, k, (x, y), (start + face + gap, y), bore, start - NARROW, area)


def _beyond(sizes: Dimensions, k: float) -> float:
    """Width to the right of the section, mm on the paper: lanes of dimensions, or texts beyond their lines."""
    texts = (text_beyond(k * (length.high - length.low), length.text) for length in sizes.under)
    return max(LANE * len(sizes.right), *texts) + 1.0


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
        above = max(above, 0.5 * k * keyway.width + 2.0 * ARROW + width(number(keyway.width), SMALL) + 4.0)
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
    _draw_face(page, drawn, sizes, layout)
    _draw_column(page, drawn, sizes, layout)
    _draw_tolerance(page, drawn, layout, sizes.tolerance)
    if drawn.body.thickness is not None:
        _draw_section(page, drawn, sizes, layout)
    if _bore_view(drawn, 1.0).wide:
        _draw_bore(page, drawn, layout, sizes.tolerance)


def _draw_face(page: Page, drawn: DrawnDisc, sizes: Dimensions, layout: Layout) -> None:
    k, (x, y) = layout.scale, layout.face
    reach = k * drawn.reach
    for loop in drawn.loops:
        page.marks.append(LineMark(shifted(loop.points, k, layout.face), THICK, "", closed=True))
    boss = drawn.body.boss
    if boss is not None:
        outline = CircleMark(layout.face, 0.5 * k * boss.diameter, THICK, "VIEW")
        page.marks.append(outline if boss.above else replace(outline, weight=THIN, pattern="dashed"))
    page.line((x - reach - 4.0, y), (x + reach + 2.0, y), layer="CENTRE", pattern="chain")
    solid = drawn.body.thickness is not None
    end = reach + (5.0 if solid else 4.0)
    page.line((x, y - end), (x, y + end), layer="CENTRE", pattern="chain")
    for callout in sizes.column:
        if callout.value is not None and callout.centre == (0.0, 0.0) and not callout.datum:
            page.marks.append(CircleMark(layout.face, k * callout.radius, THIN, "CENTRE", "chain"))
    for opening in drawn.body.openings:
        if opening.circle is not None and opening.name != "bore":
            (cx, cy), r = opening.circle
            at, half = (x + k * cx, y + k * cy), k * r + 1.5
            page.line((at[0] - half, at[1]), (at[0] + half, at[1]), layer="CENTRE")
            page.line((at[0], at[1] - half), (at[0], at[1] + half), layer="CENTRE")
    # the mark of the angle 0
    page.line((x + reach + 3.0, y), (x + reach + 8.0, y), weight=THICK)
    page.text((x + reach + 9.0, y - 0.5 * SMALL), "0°")
    _draw_rotation(page, drawn, layout)
    if solid:
        _draw_plane(page, drawn, layout)


def _draw_rotation(page: Page, drawn: DrawnDisc, layout: Layout) -> None:
    """Arc with an arrow: the sense in which the shaft turns."""
    (x, y), radius = layout.face, layout.scale * drawn.reach + 5.0
    start, end = (14.0, 40.0) if drawn.ccw else (40.0, 14.0)
    angles = np.radians(np.linspace(start, end, 24))
    points = np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])
    page.marks.append(LineMark(points))
    sense = 0.5 * math.pi if drawn.ccw else -0.5 * math.pi
    tip = (float(points[-1, 0]), float(points[-1, 1]))
    page.marks.append(arrow(tip, float(angles[-1]) + sense))


def _draw_plane(page: Page, drawn: DrawnDisc, layout: Layout) -> None:
    """Ends of the cutting plane, with arrows in the direction of view."""
    (x, y), reach = layout.face, layout.scale * drawn.reach
    sense = layout.sense
    for side in (-1.0, 1.0):
        inner, outer = y + side * (reach + 5.0), y + side * (reach + 10.0)
        page.line((x, inner), (x, outer), weight=THICK)
        page.line((x, outer), (x + sense * 6.0, outer))
        page.marks.append(arrow((x + sense * 6.0, outer), 0.0 if sense > 0.0 else math.pi))
        page.text((x, outer + 1.3 if side > 0.0 else outer - 1.0 - PLAIN), "A", PLAIN, "middle")


def _draw_column(page: Page, drawn: DrawnDisc, sizes: Dimensions, layout: Layout) -> None:
    """Callouts of the column, each as near to the height of its feature as the others let it."""
    k, (x, y) = layout.scale, layout.face
    rows = sorted(sizes.column, key=lambda row: -row.tip[1])
    heights = [y + k * row.tip[1] - 0.5 * SMALL - (SLANT if abs(k * row.tip[1]) < 2.0 else 0.0) for row in rows]
    # downwards no callout covers its upper neighbour; upwards none leaves the free area
    for i in range(len(rows)):
        top = y + k * drawn.reach + ROUND - PITCH if i == 0 else heights[i - 1] - rows[i - 1].high
        heights[i] = min(heights[i], top)
    for i in reversed(range(len(rows))):
        bottom = layout.area.low if i == len(rows) - 1 else heights[i + 1]
        heights[i] = max(heights[i], bottom + rows[i].high)
    for row, height in zip(rows, heights, strict=True):
        end = layout.column - (CELL + 2.0 if row.datum else 0.0) - (1.0 if row.boxed else 0.0)
        label = Text((end, height), row.text, SMALL, "right", "DIM")
        tip = (x + k * row.tip[0], y + k * row.tip[1])
        centre = (x + k * row.centre[0], y + k * row.centre[1])
        sized = label if row.value is None else round_size(centre, k * row.radius, label, row.value)
        page.marks.extend([*leader(tip, (layout.column + 0.8, height + 0.5 * SMALL)), sized])
        page.text((layout.column, height - SECOND), row.note, anchor="right", layer="DIM")
        if row.boxed:
            wide = width(row.text, SMALL)
            page.box((end - wide - 0.8, height - 0.8), wide + 1.6, SMALL + 1.6)
        if row.datum:
            _draw_letter(page, (layout.column - 3.5, height + 0.5 * SMALL), row.datum)


def _draw_letter(page: Page, middle: Point, letter: str) -> None:
    x, y = middle
    page.box((x - 2.5, y - 2.5), 5.0, 5.0)
    page.text((x, y - 0.5 * SMALL), letter, SMALL, "middle")


def _draw_datum(page: Page, at: Point, direction: Point, letter: str) -> None:
    """Datum symbol of ISO 5459: a filled triangle at a point, and its letter in a box some way along a direction."""
    (x, y), (u, v) = at, direction
    base = [(x - 1.2 * v, y + 1.2 * u), (x + 1.2 * v, y - 1.2 * u), (x + 2.0 * u, y + 2.0 * v)]
    page.marks.append(LineMark(np.array(base), closed=True, filled=True))
    page.line((x + 2.0 * u, y + 2.0 * v), (x + 4.5 * u, y + 4.5 * v))
    _draw_letter(page, (x + 7.0 * u, y + 7.0 * v), letter)


def _draw_tolerance(page: Page, drawn: DrawnDisc, layout: Layout, tolerance: Tolerance) -> None:
    """Profile of a surface with its tolerance, all around, by the datums; or that none is stated."""
    k, (x, y) = layout.scale, layout.face
    low = y + k * drawn.reach + ROUND + 2.0
    left = min(x - k * drawn.reach, x + k * drawn.reach + ROUND - tolerance.long)
    if not tolerance.cells:
        page.text((left, low + 2.0), UNSTATED)
        return
    contour = next(loop.points for loop in drawn.loops if loop.surface)
    angles = np.arctan2(contour[:, 1], contour[:, 0])
    place = contour[int(np.argmin(np.abs(angles - 0.68 * math.pi)))]
    tip = (x + k * float(place[0]), y + k * float(place[1]))
    knee = (left + 0.3 * KNEE, low + 0.5 * CELL)
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

    chains = [[placed(*point) for point in chain] for chain in sections(drawn)]
    for chain in chains:
        page.marks.append(LineMark(np.array(chain), THICK, "VIEW", closed=True))
    for ends in hatching(chains, HATCH):
        page.marks.append(LineMark(ends, THIN, "HATCH"))
    behind = [[placed(*point) for point in edges] for edges in _behind(drawn, sense)]
    for edges in behind:
        page.line(*edges, weight=THICK, layer="VIEW")
    right = left + k * drawn.depth
    page.line((left - 4.0, y), (right + 4.0, y), layer="CENTRE", pattern="chain")
    outer = 0.0 if body.boss is None else 0.5 * body.boss.diameter
    for hole in body.cross_holes:
        half, side = 0.5 * hole.diameter, 1.0 if math.sin(hole.at) >= 0.0 else -1.0
        for z in (hole.z - half, hole.z + half):
            page.line(placed(z, side * 0.5 * (body.bore or 0.0)), placed(z, side * outer), layer="VIEW")
    top = y + k * drawn.reach + ROUND + 2.0
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


def _behind(drawn: DrawnDisc, sense: float) -> list[tuple[Point, ...]]:
    """Edges behind the cutting plane, as chains of (z, y), mm: rims of the bore, and what reaches beyond the cut."""
    body = drawn.body
    edges: list[tuple[Point, ...]] = []
    thick = body.thickness or 0.0
    if drawn.part.bore is not None:
        bore = next(loop.points for loop in drawn.loops if loop.layer == "BORE")
        beyond = bore[sense * bore[:, 0] >= 0.0]
        low, high = float(beyond[:, 1].min()), float(beyond[:, 1].max())
        edges += [((body.bottom, low), (body.bottom, high)), ((body.top, low), (body.top, high))]
    outer = max((loop for loop in drawn.loops if loop.through), key=lambda loop: float(np.ptp(loop.points[:, 1])))
    beyond = outer.points[sense * outer.points[:, 0] >= 0.0]
    cut = [height for chain in sections(drawn) for _, height in chain]
    for end, edge in ((float(beyond[:, 1].max()), max(cut)), (float(beyond[:, 1].min()), min(cut))):
        if abs(end) > abs(edge) + 1e-3:
            edges.append(((0.0, edge), (0.0, end), (thick, end), (thick, edge)))
    return edges


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
        page.marks.append(across(*ends, base, value, number(value), before=True))
        edges = (x + k * corner, y - 0.5 * k * key.width), (x + k * corner, y + 0.5 * k * key.width)
        lane = x + k * corner + LANE
        page.marks.append(across(*edges, lane, key.width, number(key.width), upright=True))
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
