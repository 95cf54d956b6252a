"""Further pages: the contour's table, the motion over a turn, the verdict with its files, the part at 1 : 1."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sheet.frame import EDGE, SIZES, framed_page, free_area
from camgeo.capabilities.sheet.lettering import LARGE, PLAIN, SMALL, width, wrap
from camgeo.capabilities.sheet.marks import THICK, THIN, LineMark, Page, shifted
from camgeo.capabilities.sheet.part import number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.sheet.marks import Point
    from camgeo.capabilities.sheet.part import DrawnDisc
    from camgeo.curve.curve import Curve
    from camgeo.report.document import Findings
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

LINE = 4.4  # mm between lines of text
COUNTS = (36, 60, 72, 120, 180, 360, 720)  # rows of a table whose step is chosen: from 10 to half a degree
PLACES = 16 * COUNTS[-1]  # of a turn, at which the error of interpolation is measured
DECIMALS = 4  # of the numbers in the table
SHARE = 0.1  # of the profile's zone that a spline through the table may be off
BAR = 100.0  # mm: length of the bar by which a print at 1 : 1 is checked


class Zone(NamedTuple):
    """Permitted error, mm, of a spline through a table; `stated` where it is a share of the profile's zone."""

    permitted: float
    stated: bool

    @property
    def words(self) -> str:
        """Origin of the permitted error, in words."""
        return "a tenth of the profile's zone" if self.stated else "the tolerance of the files"


class SheetTable(NamedTuple):
    """Table of a contour on the drawing: headings of its columns, numbers (n, columns), and notes.

    `off` is how far a spline through the rows is off the contour, mm, nan where that is not known. `exact` is whether
    that is permitted, so that the numbers are theoretically exact dimensions.
    """

    heads: tuple[str, ...]
    rows: Array
    notes: tuple[str, ...]
    off: float
    exact: bool


def contour_table(contours: Sequence[tuple[str, Curve]], step: float | None, zone: Zone, *, ccw: bool) -> SheetTable:
    """Table of polar radii, mm, of the contours at every `step`, rad; notes give the error of interpolation.

    Without a step it is the greatest of COUNTS whose error is permitted by the zone, the least if none is. `contours`
    are pairs of a name and a curve. Where a ray may cross a contour more than once, the table has places X, Y, mm, at
    even steps of the curve's parameter instead. The angles run as the disc is drawn: mirrored with `ccw`.
    """
    from camgeo.curve.measures import StarError

    counts = COUNTS if step is None else (round(2.0 * math.pi / step),)
    places = PLACES if step is None else counts[0] * math.ceil(PLACES / counts[0])
    names: tuple[str, ...] = ("R",)
    try:
        fine, head = _radii(contours, places, ccw=ccw), "angle °"
    except StarError:
        fine, head, names = _places(contours, places, ccw=ccw), "no.", ("X", "Y")
    rounded, off = fine, math.nan
    for count in counts:
        rows = np.round(fine[:: places // count], DECIMALS)
        rounded, off = rows, _error(rows, fine, len(names))
        if off <= zone.permitted:
            break
    count, exact = len(rounded), off <= zone.permitted
    heads = (head, *(f"{name} {whose}".strip() for whose, _ in contours for name in names))
    numbers = 360.0 / count * np.arange(count) if names == ("R",) else np.arange(1.0, count + 1.0)
    notes = _notes(off, zone, places, exact=exact)
    if np.isnan(rounded).any():
        notes = ("Rows without numbers are places that were trimmed away; interpolation across them is not measured.",)
    return SheetTable(heads, np.column_stack([numbers, rounded]), notes, off, exact)


def _notes(off: float, zone: Zone, places: int, *, exact: bool) -> tuple[str, ...]:
    found = f"A periodic cubic spline through the rows is off by {off:.2g} mm at most, measured at {places} places"
    if exact:
        return (f"{found}: within {zone.words}, {zone.permitted:.2g} mm.",)
    limit = f"{found}: more than {zone.words}, {zone.permitted:.2g} mm."
    return limit, "These are no theoretically exact dimensions. The contour is that of the DXF of this drawing."


def _radii(contours: Sequence[tuple[str, Curve]], places: int, *, ccw: bool) -> Array:
    """Polar radii of the contours, mm (places, contours); raises StarError where a ray may cross one more than once."""
    from camgeo.curve.measures import polar_radius

    angles = 2.0 * math.pi / places * np.arange(places, dtype=np.float64)
    return np.column_stack([polar_radius(curve, -angles if ccw else angles) for _, curve in contours])


def _places(contours: Sequence[tuple[str, Curve]], places: int, *, ccw: bool) -> Array:
    """Points of the contours, mm (places, 2 contours), nan where they were trimmed away."""
    from camgeo.curve.measures import touched

    columns = []
    for _, curve in contours:
        t = curve.shape.period / places * np.arange(places, dtype=np.float64)
        points = curve.sample(t).point * (np.array([1.0, -1.0]) if ccw else 1.0)
        columns.append(np.where(touched(curve, t)[:, None], points, np.nan))
    return np.column_stack(columns)


def _error(rows: Array, fine: Array, width: int) -> float:
    """Greatest distance, mm, of splines through rows (n, k) from (m n, k), `width` columns a contour; nan with gaps."""
    if np.isnan(fine).any():
        return math.nan
    apart = _spline(rows, len(fine) // len(rows)) - fine
    return float(np.hypot.reduce(apart.reshape(len(fine), -1, width), axis=2).max())


def _spline(rows: Array, between: int) -> Array:
    """Periodic cubic spline through rows (n, k) one step apart, at `between` places a step, (n between, k)."""
    n = len(rows)
    # the second derivatives: of a circulant system, which a Fourier transform solves
    after, before = np.roll(rows, -1, axis=0), np.roll(rows, 1, axis=0)
    waves = np.fft.rfft(6.0 * (after - 2.0 * rows + before), axis=0)
    bend = np.fft.irfft(waves / (4.0 + 2.0 * np.cos(2.0 * math.pi * np.arange(len(waves)) / n))[:, None], n, axis=0)
    t = (np.arange(between) / between)[None, :, None]
    a, b, c, d = rows[:, None], after[:, None], bend[:, None], np.roll(bend, -1, axis=0)[:, None]
    splined: Array = a * (1.0 - t) + b * t + (c * ((1.0 - t) ** 3 - (1.0 - t)) + d * (t**3 - t)) / 6.0
    return splined.reshape(n * between, -1)


# --- its pages --------------------------------------------------------------------------------------------------------

FEWEST = 9  # rows of a column, where the table has more than one
WIDEST = 40.0  # mm: greatest distance between columns
NEAREST = 6.0  # mm: least distance
HEADING = 9.0  # mm from the upper edge to the notes


class _Columns(NamedTuple):
    """Columns of the table: height of its letters and width of each part, mm, columns and rows on a page, gap, mm."""

    height: float
    wides: tuple[float, ...]
    beside: int
    each: int
    gap: float

    @property
    def line(self) -> float:
        """Distance between two rows, mm."""
        return LINE / SMALL * self.height


def table_pages(table: SheetTable, paper: str) -> list[Page]:
    """Pages of the table, as many as its rows need: in letters as large, and columns as many, as fill the page."""
    area = free_area(paper, block=False)
    cells = [[_cell(value, k) for k, value in enumerate(row)] for row in table.rows.tolist()]
    notes = [line for note in table.notes for line in wrap(note, area.right - area.left)]
    top = area.high - HEADING - LINE * len(notes) - 2.0
    columns = _columns([list(table.heads), *cells], area.right - area.left, top - area.low)
    each, block = columns.each, sum(columns.wides) + columns.gap
    word = "theoretically exact" if table.exact else "for orientation"
    pages = []
    for first in range(0, len(cells), each * columns.beside):
        page = framed_page("Contour", paper)
        page.text((area.left, area.high - PLAIN), f"Contour, {word}, from the shaft, in mm", PLAIN)
        for k, note in enumerate(notes):
            page.text((area.left, area.high - HEADING - LINE * k - 0.5), note)
        for k in range(columns.beside):
            rows = cells[first + k * each : first + (k + 1) * each]
            if rows:
                _draw_rows(page, (area.left + k * block, top), table, columns, rows)
        pages.append(page)
    return pages


def _columns(cells: Sequence[Sequence[str]], wide: float, high: float) -> _Columns:
    """Columns of a table, its heads the first row of cells, on pages `wide` by `high` mm.

    The letters are the largest of which one page holds all, else the smallest.
    """
    rows = len(cells) - 1
    for height in (LARGE, PLAIN, SMALL):
        wides = tuple(max(width(row[k], height) for row in cells) + 1.2 * height for k in range(len(cells[0])))
        most = max(1, int((wide + NEAREST) // (sum(wides) + NEAREST)))
        each = int(high // (LINE / SMALL * height)) - 1
        if rows <= most * each:
            break
    if rows <= most * each:
        beside = max(math.ceil(rows / each), min(most, rows // FEWEST), 1)
        each = math.ceil(rows / beside)
        beside = math.ceil(rows / each)
    else:
        beside = most
    left = wide - beside * sum(wides)
    return _Columns(height, wides, beside, each, min(WIDEST, left / max(beside - 1, 1)))


def _cell(value: float, column: int) -> str:
    if math.isnan(value):
        return "-"
    return number(value) if column == 0 else f"{value:.{DECIMALS}f}"


def _draw_rows(page: Page, corner: Point, table: SheetTable, columns: _Columns, rows: Sequence[Sequence[str]]) -> None:
    """Draw a column of rows below its heads, its upper left corner at a point; in a box where the numbers are exact."""
    (left, top), line, high = corner, columns.line, columns.height
    raised = 0.5 * (line - high)
    x = left
    page.line((left, top - line), (left + sum(columns.wides), top - line), layer="TABLE")
    if table.exact:
        bottom = top - line * (len(rows) + 1) - 0.3 * raised
        page.box((left, bottom), sum(columns.wides), top - bottom, layer="TABLE")
    for k, (head, wide) in enumerate(zip(table.heads, columns.wides, strict=True)):
        x += wide
        page.text((x - 0.5 * high, top - line + raised), head, high, "right", "TABLE")
        for i, row in enumerate(rows):
            page.text((x - 0.5 * high, top - line * (i + 2) + raised), row[k], high, "right", "TABLE")


# --- motion and verdict -----------------------------------------------------------------------------------------------


PLOT = 104.0  # mm: height of the plot of the motion, with its words
FIGURE = 90.0  # mm: least height of the follower's figure


def motion_pages(
    design: Design, drawn: DrawnDisc, findings: Findings, paper: str, sources: Sequence[tuple[str, str]]
) -> list[Page]:
    """Pages with the follower's motion over a turn, the follower itself, and the verdict with the judged files.

    They are one page, or two where the list of files is long. `sources` are pairs of a file's name and its SHA-256.
    """
    from camgeo.capabilities.sheet.follower import draw_follower, follower_figure

    area = free_area(paper, block=False)
    lines = _verdict(findings)
    tall = LINE * (len(lines) + 2 * len(sources) + 2)
    together = area.high - area.low - PLOT - tall >= FIGURE
    page = framed_page("Motion and verdict" if together else "Motion", paper)
    _draw_motion(page, design, (area.left + 16.0, area.high - PLOT + 20.0, area.right - 4.0, area.high - 10.0))
    low = area.low + (tall if together else 0.0)
    draw_follower(page, follower_figure(design, drawn), drawn, area._replace(low=low, high=area.high - PLOT))
    pages = [page] if together else [page, framed_page("Verdict", paper)]
    y = low - LINE if together else area.high - LINE
    for line in lines:
        pages[-1].text((area.left, y), line)
        y -= LINE
    y -= 0.5 * LINE
    for name, checksum in sources:
        pages[-1].text((area.left, y), name)
        pages[-1].text((area.left + 4.0, y - LINE), f"sha256 {checksum}")
        y -= 2.0 * LINE
    return pages


def _verdict(findings: Findings) -> list[str]:
    from camgeo.version import __version__

    failed = [check for check in findings.checks if not check.ok]
    if failed:
        names = ", ".join(dict.fromkeys(check.name for check in failed))
        return [
            f"NOT APPROVED: {len(failed)} of {len(findings.checks)} checks fail (camgeo {__version__}):",
            names[:90],
        ]
    return [f"All {len(findings.checks)} checks hold (camgeo {__version__}). The verdict is on these files alone:"]


def _draw_motion(page: Page, design: Design, place: tuple[float, float, float, float]) -> None:
    left, low, right, high = place
    position = design.motion
    shaft = np.linspace(0.0, 2.0 * np.pi, 721)
    values = position.turn(shaft, 0)[0] * position.factor(1.0)
    least, most = float(values.min()), float(values.max())
    step = _round_step(max(most - least, 1e-9))
    bottom, top = step * math.floor(least / step + 1e-9), step * math.ceil(most / step - 1e-9)
    top = top if top > bottom else bottom + step
    page.box((left, low), right - left, high - low, THIN, "VIEW")

    def placed(x: Array, y: Array) -> Array:
        return np.column_stack([left + (right - left) * x / 360.0, low + (high - low) * (y - bottom) / (top - bottom)])

    for degrees in range(0, 361, 30 if right - left > 200.0 else 60):
        x = left + (right - left) * degrees / 360.0
        page.line((x, low), (x, high), layer="HATCH")
        page.text((x, low - 4.5), str(degrees), SMALL, "middle")
    for k in range(round((top - bottom) / step) + 1):
        y = low + (high - low) * k * step / (top - bottom)
        page.line((left, y), (right, y), layer="HATCH")
        page.text((left - 1.5, y - 0.5 * SMALL), number(bottom + k * step), SMALL, "right")
    page.marks.append(LineMark(placed(np.degrees(shaft), values), THICK, "VIEW"))
    page.text((0.5 * (left + right), low - 9.5), "shaft angle, degrees", SMALL, "middle")
    page.text((left, high + 2.5), f"Motion: {position.title} of the follower, {position.unit}", PLAIN)


def _round_step(span: float) -> float:
    """Step of 1, 2 or 5 times a power of ten that divides a span into at most ten parts."""
    power = 10.0 ** math.floor(math.log10(span / 10.0))
    return next(k * power for k in (1.0, 2.0, 5.0, 10.0) if span <= 10.0 * k * power * (1.0 + 1e-9))


# --- 1 : 1 ------------------------------------------------------------------------------------------------------------


def full_size(drawn: DrawnDisc) -> Page | None:
    """The face at 1 : 1 on the least paper that holds it, with a bar of 100 mm; None where no ISO paper does."""
    points = np.concatenate([loop.points for loop in drawn.loops])
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    for paper in SIZES:
        area = free_area(paper, block=False)
        if x1 - x0 <= area.right - area.left and y1 - y0 + 24.0 <= area.high - area.low:
            break
    else:
        return None
    page = framed_page("1 : 1", paper)
    x = 0.5 * (area.left + area.right) - 0.5 * (x0 + x1)
    y = 0.5 * (area.low + 14.0 + area.high - 8.0) - 0.5 * (y0 + y1)
    for loop in drawn.loops:
        page.marks.append(LineMark(shifted(loop.points, 1.0, (x, y)), THIN, "", closed=True))
    for u, v in ((4.0, 0.0), (0.0, 4.0)):
        page.line((x - u, y - v), (x + u, y + v), layer="CENTRE")
    page.text((area.left, area.high - PLAIN), "1 : 1, to be printed at actual size", PLAIN)
    low = EDGE + 16.0
    page.line((area.left, low), (area.left + BAR, low), weight=THIN)
    for end in (area.left, area.left + BAR):
        page.line((end, low - 2.0), (end, low + 2.0), weight=THIN)
    page.text((area.left + 0.5 * BAR, low + 1.5), "100 mm", SMALL, "middle")
    return page
