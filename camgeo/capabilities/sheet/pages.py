"""Further pages: the contour's table, the motion over a turn, the verdict with its files, the part at 1 : 1."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sheet.frame import EDGE, SIZES, framed_page, free_area
from camgeo.capabilities.sheet.lettering import PLAIN, SMALL, width, wrap
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
COLUMN = 6.0  # mm between columns of the table
BETWEEN = 16  # places in each step at which the error of interpolation is computed
BAR = 100.0  # mm: length of the bar by which a print at 1 : 1 is checked


class SheetTable(NamedTuple):
    """Table of a contour on the drawing: headings of its columns, numbers (n, columns), and notes."""

    heads: tuple[str, ...]
    rows: Array
    notes: tuple[str, ...]


def polar_table(contours: Sequence[tuple[str, Curve]], step: float, *, ccw: bool) -> SheetTable:
    """Table of polar radii, mm, of the contours at every `step`, rad; notes give the error of interpolation.

    `contours` are pairs of a name and a curve. Where a ray may cross a contour more than once, the table has places
    X, Y, mm, at even steps of the curve's parameter instead. The angles run as the disc is drawn:
    mirrored with `ccw`.
    """
    from camgeo.curve.measures import StarError, polar_radius

    count = round(2.0 * math.pi / step)
    fine = 2.0 * math.pi / count / BETWEEN * np.arange(count * BETWEEN, dtype=np.float64)
    columns, heads, notes = [360.0 / count * np.arange(count)], ["angle °"], []
    try:
        for name, curve in contours:
            exact = polar_radius(curve, -fine if ccw else fine)
            off = float(np.abs(_spline(exact[::BETWEEN][:, None], BETWEEN)[:, 0] - exact).max())
            columns.append(exact[::BETWEEN])
            heads.append(f"R {name}".strip())
            notes.append(_error(name, off))
    except StarError:
        return _places(contours, count, ccw=ccw)
    return SheetTable(tuple(heads), np.column_stack(columns), tuple(notes))


def _error(name: str, off: float) -> str:
    whose = f" of the {name} contour" if name else ""
    seen = f"{off:.2g} mm at most (estimated, {BETWEEN} places a step)"
    return f"A periodic cubic spline through the rows{whose} is off by {seen}."


def _places(contours: Sequence[tuple[str, Curve]], count: int, *, ccw: bool) -> SheetTable:
    from camgeo.curve.measures import touched

    columns: list[Array] = [np.arange(1, count + 1, dtype=np.float64)]
    heads, notes = ["no."], []
    for name, curve in contours:
        fine = curve.shape.period / count / BETWEEN * np.arange(count * BETWEEN, dtype=np.float64)
        points = curve.sample(fine).point * (np.array([1.0, -1.0]) if ccw else 1.0)
        there = touched(curve, fine)
        columns += list(np.where(there[::BETWEEN, None], points[::BETWEEN], np.nan).T)
        heads += [f"X {name}".strip(), f"Y {name}".strip()]
        if there.all():
            splined = _spline(points[::BETWEEN], BETWEEN)
            notes.append(_error(name, float(np.hypot(*(splined - points).T).max())))
        else:
            notes.append(
                "Rows without numbers are places that were trimmed away; interpolation across them is not estimated."
            )
    return SheetTable(tuple(heads), np.column_stack(columns), tuple(notes))


def _spline(rows: Array, between: int) -> Array:
    """Periodic cubic spline through rows (n, k) one step apart, at `between` places a step, (n between, k)."""
    n = len(rows)
    matrix = 4.0 * np.eye(n) + np.roll(np.eye(n), 1, axis=1) + np.roll(np.eye(n), -1, axis=1)
    after, before = np.roll(rows, -1, axis=0), np.roll(rows, 1, axis=0)
    bend = np.linalg.solve(matrix, 6.0 * (after - 2.0 * rows + before))
    t = (np.arange(between) / between)[None, :, None]
    a, b, c, d = rows[:, None], after[:, None], bend[:, None], np.roll(bend, -1, axis=0)[:, None]
    splined: Array = a * (1.0 - t) + b * t + (c * ((1.0 - t) ** 3 - (1.0 - t)) + d * (t**3 - t)) / 6.0
    return splined.reshape(n * between, -1)


def table_pages(table: SheetTable, paper: str) -> list[Page]:
    """Pages of the table, as many as its rows need."""
    area = free_area(paper, block=False)
    cells = [[_cell(value, k) for k, value in enumerate(row)] for row in table.rows.tolist()]
    texts = [[head, *(row[k] for row in cells)] for k, head in enumerate(table.heads)]
    wides = [max(width(text, SMALL) for text in column) + 3.0 for column in texts]
    block = sum(wides) + COLUMN
    notes = [line for note in table.notes for line in wrap(note, area.right - area.left)]
    above = 9.0 + LINE * len(notes)
    each = int((area.high - area.low - above - LINE - 3.0) // LINE)
    beside = max(1, int((area.right - area.left + COLUMN) // block))
    pages = []
    for first in range(0, len(cells), each * beside):
        page = framed_page("Contour", paper)
        page.text((area.left, area.high - PLAIN), "Contour, theoretically exact, from the shaft, in mm", PLAIN)
        for k, note in enumerate(notes):
            page.text((area.left, area.high - 9.0 - LINE * k - 0.5), note)
        top = area.high - above - LINE
        for k in range(beside):
            rows = cells[first + k * each : first + (k + 1) * each]
            if rows:
                _draw_rows(page, (area.left + k * block, top), table.heads, wides, rows)
        pages.append(page)
    return pages


def _cell(value: float, column: int) -> str:
    if math.isnan(value):
        return "-"
    return number(value) if column == 0 else f"{value:.4f}"


def _draw_rows(
    page: Page, corner: Point, heads: Sequence[str], wides: Sequence[float], rows: Sequence[Sequence[str]]
) -> None:
    left, top = corner
    x = left
    page.line((left, top - 1.2), (left + sum(wides), top - 1.2), layer="TABLE")
    for k, (head, wide) in enumerate(zip(heads, wides, strict=True)):
        x += wide
        page.text((x - 1.5, top), head, SMALL, "right", "TABLE")
        for i, row in enumerate(rows):
            page.text((x - 1.5, top - LINE * (i + 1) - 1.0), row[k], SMALL, "right", "TABLE")


# --- motion and verdict -----------------------------------------------------------------------------------------------


def motion_page(design: Design, findings: Findings, paper: str, sources: Sequence[tuple[str, str]]) -> Page:
    """Page with the follower's motion over a turn, and below it the verdict and the judged files.

    `sources` are pairs of a file's name and its SHA-256.
    """
    page, area = framed_page("Motion and verdict", paper), free_area(paper, block=False)
    lines = _verdict(findings)
    rows = len(lines) + 2 * len(sources) + 2
    split = area.low + LINE * rows + 6.0
    _draw_motion(
        page, design, (area.left + 16.0, max(split + 16.0, area.high - 130.0), area.right - 4.0, area.high - 10.0)
    )
    y = split - LINE
    for line in lines:
        page.text((area.left, y), line)
        y -= LINE
    y -= 0.5 * LINE
    for name, checksum in sources:
        page.text((area.left, y), name)
        page.text((area.left + 4.0, y - LINE), f"sha256 {checksum}")
        y -= 2.0 * LINE
    return page


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
