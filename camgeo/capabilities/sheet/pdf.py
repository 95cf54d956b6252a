"""Pages as PDF, by fpdf2: vectors, and text with an embedded subset of its font. The same pages give the same bytes."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sheet.lettering import FAMILY, font_points, new_pdf
from camgeo.capabilities.sheet.marks import CircleMark, Dimension, LineMark, Text

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fpdf import FPDF

    from camgeo.capabilities.sheet.marks import Mark, Page
    from kin.numeric.arrays import Array

EPOCH = datetime(2000, 1, 1, tzinfo=UTC)  # in place of the time of writing
PATTERNS = {
    "": (),
    "dashed": (3.0, 1.5),
    "chain": (8.0, 1.5, 0.5, 1.5),
    "phantom": (8.0, 1.5, 0.5, 1.5, 0.5, 1.5),
}  # mm: dashes and gaps by turns
AROUND = 180  # chords of a circle that is drawn in a pattern


def write_pdf(path: Path, pages: Sequence[Page], title: str) -> None:
    """Write pages as one PDF with a title; raises ModuleNotFoundError without fpdf2, OSError where the disk refuses."""
    pdf = new_pdf()
    pdf.set_creation_date(EPOCH)
    pdf.set_title(title)
    pdf.set_producer("camgeo")
    for page in pages:
        pdf.add_page(format=(page.width, page.height))
        for mark in page.marks:
            _draw(pdf, page.height, mark)
    path.write_bytes(bytes(pdf.output()))


def _draw(pdf: FPDF, height: float, mark: Mark) -> None:
    match mark:
        case Dimension(lines=lines, text=text):
            for line in lines:
                _draw(pdf, height, line)
            _draw(pdf, height, text)
        case Text():
            _letter(pdf, height, mark)
        case CircleMark() if not mark.pattern:
            _pen(pdf, mark)
            pdf.circle(mark.centre[0], height - mark.centre[1], mark.radius)
        case CircleMark():
            turn = np.linspace(0.0, 2.0 * np.pi, AROUND + 1)
            points = np.array(mark.centre) + mark.radius * np.column_stack([np.cos(turn), np.sin(turn)])
            _draw(pdf, height, LineMark(points, mark.weight, mark.layer, mark.pattern))
        case LineMark():
            _pen(pdf, mark)
            for piece in _pieces(mark):
                pdf.polyline(
                    [(x, height - y) for x, y in piece.tolist()],
                    polygon=mark.closed,
                    style="DF" if mark.filled else "D",
                )


def _pieces(line: LineMark) -> list[Array]:
    """Dashes of a line, points (k, 2) each; the whole line where it has no pattern."""
    pattern = PATTERNS[line.pattern]
    if not pattern:
        return [line.points]
    steps = np.hypot(*np.diff(line.points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    end, pieces = 0.0, []
    # dashes (k even) and gaps by turns, at least as many as the line is long; those beyond its end have no length
    for k in range(2 * len(line.points) + int(len(pattern) * along[-1] / sum(pattern)) + 1):
        start, end = end, min(end + pattern[k % len(pattern)], float(along[-1]))
        if k % 2 == 0 and end > start:
            places = np.concatenate([[start], along[(along > start) & (along < end)], [end]])
            pieces.append(np.column_stack([np.interp(places, along, column) for column in line.points.T]))
    return pieces


def _letter(pdf: FPDF, height: float, mark: Text) -> None:
    x0, y0 = mark.box[:2]
    pdf.set_font(FAMILY, size=font_points(mark.height))
    if not mark.turned:
        pdf.text(x0, height - mark.at[1], mark.text)
        return
    with pdf.rotation(90.0, mark.at[0], height - y0):
        pdf.text(mark.at[0], height - y0, mark.text)


def _pen(pdf: FPDF, mark: CircleMark | LineMark) -> None:
    pdf.set_line_width(mark.weight)
    pdf.set_fill_color(0)
