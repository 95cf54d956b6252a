"""Pages with their frame (ISO 5457) and title block (ISO 7200)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from camgeo.capabilities.sheet.lettering import PLAIN, SMALL, width
from camgeo.capabilities.sheet.marks import BORDER, THICK, THIN, CircleMark, Page
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from camgeo.capabilities.sheet.marks import Point
    from camgeo.capabilities.sheet.options import Sheet

SIZES = {
    "A4": (210.0, 297.0),
    "A3": (420.0, 297.0),
    "A2": (594.0, 420.0),
    "A1": (841.0, 594.0),
    "A0": (1189.0, 841.0),
}
"""Width and height of ISO 216, mm; A4 stands upright."""
BINDING, EDGE = 20.0, 10.0  # mm: margin on the left, and on the other sides
INNER = 5.5  # mm: between the frame and what stands beside it, clear of the marks of its middles
BLOCK = 180.0  # mm: width of the title block
ROW = 9.5  # mm: height of a row of the title block
LABEL = 2.9  # mm from its upper edge to the baseline of the labels, clear of accents below
CELLS = (
    (
        (90.0, "number", "Drawing number"),
        (25.0, "revision", "Revision"),
        (40.0, "date", "Date of issue"),
        (25.0, "page", "Sheet"),
    ),
    ((115.0, "title", "Title"), (65.0, "type", "Document type")),
    ((60.0, "drawn", "Drawn"), (60.0, "approved", "Approved"), (60.0, "owner", "Legal owner")),
    ((60.0, "material", "Material"), (60.0, "finish", "Finish"), (60.0, "general", "General tolerances")),
    ((40.0, "scale", "Scale"), (40.0, "mass", "Mass"), (40.0, "units", "Units"), (60.0, "projection", "Projection")),
)
"""Rows of it from below: width of each cell, mm, the option or fact that stands in it, and its label."""
ROWS = len(CELLS)


class Area(NamedTuple):
    """A part of a page: its lower left and upper right corners, mm."""

    left: float
    low: float
    right: float
    high: float


class LongTextError(CamgeoError, ValueError):
    """A text that does not fit into its cell: `option` is its option, `fits` the number of characters that would."""

    def __init__(self, option: str, fits: int) -> None:
        super().__init__(option)
        self.option, self.fits = option, fits


class Facts(NamedTuple):
    """Entries of the title block that are not options: scale and mass in words, page number and number of pages."""

    scale: str
    mass: str
    page: int
    pages: int


def framed_page(name: str, paper: str) -> Page:
    """An empty page with its frame and centring marks; `paper` is a size of SIZES."""
    wide, high = SIZES[paper]
    page = Page(name, wide, high)
    page.box((BINDING, EDGE), wide - BINDING - EDGE, high - 2.0 * EDGE, BORDER, "FRAME")
    # below, where the title block or notes stand, the mark ends at the frame
    for x, inner, outer in ((0.5 * wide, EDGE, 5.0), (0.5 * wide, high - EDGE - 5.0, high - 5.0)):
        page.line((x, inner), (x, outer), weight=THICK, layer="FRAME")
    for y, inner, outer in ((0.5 * high, BINDING + 5.0, 5.0), (0.5 * high, wide - EDGE - 5.0, wide - 5.0)):
        page.line((inner, y), (outer, y), weight=THICK, layer="FRAME")
    return page


def free_area(paper: str, *, block: bool, notes: float = 0.0) -> Area:
    """Area of a page within its frame that stays free above the title block, or else a footer, and above the notes.

    `notes` is their height, mm; on paper wider than A4 they stand beside the block.
    """
    wide, high = SIZES[paper]
    beside = wide - BINDING - EDGE - BLOCK > 100.0
    low = EDGE + (ROWS * ROW if block else ROW)
    low = max(low, EDGE + notes) if beside else low + notes
    return Area(BINDING + INNER, low + 3.0, wide - EDGE - INNER, high - EDGE - 6.0)


def notes_at(paper: str) -> tuple[float, float, float]:
    """Place of the notes on a page, mm: their left edge, the baseline of their lowest line, their greatest width."""
    wide, _ = SIZES[paper]
    beside = wide - BINDING - EDGE - BLOCK > 100.0
    free = wide - BINDING - EDGE - (BLOCK if beside else 0.0)
    return BINDING + 4.0, EDGE + (3.0 if beside else ROWS * ROW + 3.0), free - 8.0


def title_block(page: Page, sheet: Sheet, facts: Facts) -> None:
    """Draw the title block at the lower right; raises LongTextError for a text that does not fit into its cell."""
    left, low = page.width - EDGE - BLOCK, EDGE
    page.box((left, low), BLOCK, ROWS * ROW, THICK, "FRAME")
    page_of = f"{facts.page}/{facts.pages}"
    fixed = {"page": page_of, "type": "Shop drawing", "units": "mm, degrees", "projection": ""}
    values = {**sheet.texts, **fixed, "scale": facts.scale, "mass": facts.mass}
    for k, row in enumerate(CELLS):
        x, y = left, low + k * ROW
        if k:
            page.line((left, y), (left + BLOCK, y), layer="FRAME")
        for wide, name, label in row:
            if x > left:
                page.line((x, y), (x, y + ROW), layer="FRAME")
            page.text((x + 1.2, y + ROW - LABEL), label, SMALL, layer="FRAME")
            _value(page, (x + 1.2, y + 1.2), wide - 2.4, name, values[name])
            x += wide
    _projection(page, left + BLOCK - 26.0, low + 4.5 * ROW, sheet.projection)


def _value(page: Page, at: Point, wide: float, option: str, value: str) -> None:
    height = next((size for size in (PLAIN, SMALL) if width(value, size) <= wide), None)
    if height is None:
        share = wide / width(value, SMALL)
        raise LongTextError(option, int(share * len(value)))
    page.text(at, value, height, layer="FRAME")


def footer(page: Page, sheet: Sheet, facts: Facts) -> None:
    """Draw the strip at the lower right of a further page; texts that do not fit are cut off."""
    left, low = page.width - EDGE - BLOCK, EDGE
    page.box((left, low), BLOCK, ROW, THICK, "FRAME")
    x = left
    for wide, label, value in (
        (75.0, "Drawing number", sheet.texts["number"]),
        (60.0, "", page.name),
        (20.0, "Revision", sheet.texts["revision"]),
        (25.0, "Sheet", f"{facts.page}/{facts.pages}"),
    ):
        if x > left:
            page.line((x, low), (x, low + ROW), layer="FRAME")
        page.text((x + 1.2, low + ROW - LABEL), label, SMALL, layer="FRAME")
        page.text((x + 1.2, low + 1.3), _within(value, wide - 2.4), SMALL, layer="FRAME")
        x += wide


def _within(text: str, wide: float) -> str:
    while width(text, SMALL) > wide:
        text = f"{text[:-2]}…"
    return text


def _projection(page: Page, x: float, y: float, projection: str) -> None:
    """Draw the symbol of ISO 5456-2: a truncated cone from the side and from its end."""
    side, end = (x, x + 14.0) if projection == "first" else (x + 10.0, x)
    small, large = 1.2, 2.4
    # the view from the left shows the small end: it stands on the right in the first angle, on the left in the third
    page.line((side, y - small), (side + 6.0, y - large), (side + 6.0, y + large), (side, y + small), (side, y - small),
              weight=THIN, layer="FRAME")  # fmt: skip
    for radius in (small, large):
        page.marks.append(CircleMark((end + 2.4, y), radius, THIN, "FRAME"))
