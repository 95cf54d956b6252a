"""A drawing as a PDF at true size, 1 : 1, over as many sheets as it takes, with a line of 50 mm to check the print by.

Its pages have no compressed streams: their numbers can be read. The margins leave a drawing whole on A4 and on letter.
"""

from __future__ import annotations

import math
from itertools import pairwise, product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.curve.ring import centre_of, steps_along
from camgeo.fit.pieces import ArcSpline, Polygon

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from camgeo.files.layer_outline import LayerOutline
    from kin.numeric.arrays import Array

POINT = 72.0 / 25.4  # units of a PDF in a mm
SHEETS = ((210.0, 297.0), (297.0, 210.0))  # mm: A4 upright, and across
MARGIN = (10.0, 20.0)  # mm at the long and at the short edges: A4 upon letter loses 9 mm at each short edge
STRIP = 16.0  # mm below the drawing, for the line and the words
OVERLAP = 10.0  # mm that two sheets beside each other both show
CHECK = 50.0  # mm: length of the line to measure
MOST_SHEETS = 60
ARC = math.pi / 4.0  # most of a cubic: it is within 5e-6 of the radius
LINE = 0.2  # mm, width of what is drawn
CROSS = 3.0  # mm, half of a mark


class TooManySheetsError(ValueError):
    """A drawing that takes more sheets than anybody joins; `count` is how many."""

    def __init__(self, count: int) -> None:
        """`count` is the number of sheets."""
        super().__init__(f"the drawing takes {count} sheets, and {MOST_SHEETS} are the most")
        self.count = count


class Sheet(NamedTuple):
    """One sheet of a drawing: its size, and the part of the drawing's plane that it shows, all in mm.

    `column` and `row` count from the left and from below, of `columns` and `rows`.
    """

    size: tuple[float, float]
    low: tuple[float, float]
    column: int
    row: int
    columns: int
    rows: int

    @property
    def corner(self) -> tuple[float, float]:
        """Lower left corner on the sheet of what is shown."""
        x, y = _margins(self.size)
        return x, y + STRIP

    @property
    def area(self) -> tuple[float, float]:
        """Width and height of what is shown."""
        return _area(self.size)


def _margins(size: tuple[float, float]) -> tuple[float, float]:
    return MARGIN if size[0] < size[1] else (MARGIN[1], MARGIN[0])


def _area(size: tuple[float, float]) -> tuple[float, float]:
    x, y = _margins(size)
    return size[0] - 2.0 * x, size[1] - 2.0 * y - STRIP


def sheets(box: tuple[float, float, float, float]) -> list[Sheet]:
    """Sheets that show a box of the plane, mm, together: the way up that takes fewer, row by row from below.

    The box stands in their middle. Raises TooManySheetsError.
    """
    wide, high = box[2] - box[0] + 2.0 * LINE, box[3] - box[1] + 2.0 * LINE
    counts = []
    for size in SHEETS:
        area = _area(size)
        counts.append([_count(length, room) for length, room in zip((wide, high), area, strict=True)])
    best = min((0, 1), key=lambda way: math.prod(counts[way]))
    size, (columns, rows) = SHEETS[best], counts[best]
    if columns * rows > MOST_SHEETS:
        raise TooManySheetsError(columns * rows)
    (x_step, y_step) = (room - OVERLAP for room in _area(size))
    left = 0.5 * (box[0] + box[2] - columns * x_step - OVERLAP)
    foot = 0.5 * (box[1] + box[3] - rows * y_step - OVERLAP)
    return [
        Sheet(size, (left + column * x_step, foot + row * y_step), column, row, columns, rows)
        for row, column in product(range(rows), range(columns))
    ]


def _count(length: float, room: float) -> int:
    return 1 if length <= room else math.ceil((length - OVERLAP) / (room - OVERLAP))


def pdf(drawings: Sequence[tuple[str, Sequence[LayerOutline | Array]]]) -> bytes:
    """PDF of drawings, each with its title, its closed outlines and open lines (n, 2), mm: one path for each, in mm.

    Raises TooManySheetsError.
    """
    pages: list[tuple[tuple[float, float], bytes]] = []
    for title, outlines in drawings:
        paths = [path(outline) for outline in outlines]
        boxes = np.array([_box(outline) for outline in outlines])
        box = (*boxes[:, :2].min(axis=0).tolist(), *boxes[:, 2:].max(axis=0).tolist())
        pages += [(sheet.size, _page(sheet, paths, title).encode("ascii")) for sheet in sheets(box)]
    return _document(pages)


def _box(layered: LayerOutline | Array) -> tuple[float, float, float, float]:
    if isinstance(layered, np.ndarray):
        return (*layered.min(axis=0).tolist(), *layered.max(axis=0).tolist())
    if layered.circle is None:
        return layered.outline.box()
    (x, y), r = layered.circle
    return x - r, y - r, x + r, y + r


# --- a contour --------------------------------------------------------------------------------------------------------


def path(layered: LayerOutline | Array) -> str:
    """Operators of a closed path, or of an open line, mm: lines and cubics.

    Raises ValueError for an outline of no known kind.
    """
    if isinstance(layered, np.ndarray):
        return "\n".join(f"{_numbers(point)} {'l' if i else 'm'}" for i, point in enumerate(layered))
    outline = layered.outline
    if layered.circle is not None:
        (x, y), r = layered.circle
        ends = [np.array([x - r, y]), np.array([x + r, y])]
        pieces = [piece for i in (0, 1) for piece in _arc(ends[i], ends[1 - i], 1.0)]
        return "\n".join([f"{_numbers(ends[0])} m", *pieces, "h"])
    match outline:
        case Polygon():
            first, pieces = outline.vertices[0], [f"{_numbers(point)} l" for point in outline.vertices[1:]]
        case ArcSpline():
            first = outline.points[0]
            ends_of = zip(outline.points, np.roll(outline.points, -1, axis=0), outline.bulges, strict=True)
            pieces = [piece for start, end, bulge in ends_of for piece in _arc(start, end, float(bulge))]
        case _:
            raise ValueError("a drawing on paper holds lines and arcs")
    return "\n".join([f"{_numbers(first)} m", *pieces, "h"])


def _arc(start: Array, end: Array, bulge: float) -> Iterator[str]:
    """Operators of an arc as cubics, by the usual 4/3 tan(angle / 4) of the radius; of a line where bulge is 0."""
    if bulge == 0.0:
        yield f"{_numbers(end)} l"
        return
    angle = 4.0 * math.atan(bulge)
    count = max(math.ceil(abs(angle) / ARC - 1e-9), 1)
    centre = centre_of(start, end, bulge)
    share = 4.0 / 3.0 * math.tan(0.25 * angle / count)
    points = [*steps_along(start, end, bulge, count), end]
    for a, b in pairwise(points):
        along = [share * np.array([centre[1] - point[1], point[0] - centre[0]]) for point in (a, b)]
        yield f"{_numbers(np.concatenate([a + along[0], b - along[1], b]))} c"


def _numbers(values: Array) -> str:
    return " ".join(f"{value:.5f}" for value in values.tolist())


# --- a sheet ----------------------------------------------------------------------------------------------------------


def _page(sheet: Sheet, paths: list[str], title: str) -> str:
    """Content of a sheet: what it shows of the paths, marks where it meets others, the line to measure, and words."""
    (x, y), (wide, high) = sheet.corner, sheet.area
    at = (x - sheet.low[0], y - sheet.low[1])
    k = f"{POINT:.9f}"
    content = ["q", f"{k} 0 0 {k} 0 0 cm", f"{LINE} w 1 j", "q", f"{x:.3f} {y:.3f} {wide:.3f} {high:.3f} re W n"]
    content += [f"1 0 0 1 {at[0]:.5f} {at[1]:.5f} cm", *(f"{one}\nS" for one in paths)]
    content += [f"{-CROSS:g} 0 m {CROSS:g} 0 l S 0 {-CROSS:g} m 0 {CROSS:g} l S", "Q"]  # the middle of the shaft
    content += _marks(sheet)
    foot = y - STRIP
    content += [f"{x:.3f} {foot + 2.0:.3f} m {x + CHECK:.3f} {foot + 2.0:.3f} l S"]
    content += [f"{end:.3f} {foot:.3f} m {end:.3f} {foot + 4.0:.3f} l S" for end in (x, x + CHECK)]
    place = ""
    if sheet.columns * sheet.rows > 1:
        place = f"   column {sheet.column + 1} of {sheet.columns} from the left, row {sheet.row + 1} of {sheet.rows}"
        place += " from below: lay crosses and dashed lines upon each other"
    content += _text(x + CHECK + 3.0, foot + 1.0, 3.2, f"{CHECK:g} mm: measure it. Print at 100 %, not fitted.")
    content += _text(x, foot + 7.0, 3.2, f"{title}, 1:1{place}")
    return "\n".join([*content, "Q"])


def _marks(sheet: Sheet) -> list[str]:
    """Dashed lines in the middle of what two sheets both show, with two crosses on each."""
    corner, area = sheet.corner, sheet.area
    content = ["0.1 w"]
    for axis, (at, count) in enumerate(((sheet.column, sheet.columns), (sheet.row, sheet.rows))):
        edges = [0.5 * OVERLAP] * (at > 0) + [area[axis] - 0.5 * OVERLAP] * (at < count - 1)
        for edge in edges:
            line = corner[axis] + edge
            ends = (corner[1 - axis], corner[1 - axis] + area[1 - axis])
            pairs = [(line, end) if axis == 0 else (end, line) for end in ends]
            content += [
                "[1 2] 0 d",
                " ".join(f"{a:.3f} {b:.3f} {how}" for (a, b), how in zip(pairs, "ml", strict=True)),
            ]
            content += ["S [] 0 d"]
            for share in (0.25, 0.75):
                across = ends[0] + share * (ends[1] - ends[0])
                a, b = (line, across) if axis == 0 else (across, line)
                content += [f"{a - CROSS:.3f} {b:.3f} m {a + CROSS:.3f} {b:.3f} l"]
                content += [f"{a:.3f} {b - CROSS:.3f} m {a:.3f} {b + CROSS:.3f} l S"]
    return [*content, f"{LINE} w"]


def _text(x: float, y: float, size: float, words: str) -> list[str]:
    plain = words.encode("ascii", "replace").decode().replace("\\", "\\\\").replace("(", "\\(").replace(")", "\\)")
    return [f"BT /F {size:g} Tf {x:.3f} {y:.3f} Td ({plain}) Tj ET"]


# --- the document -----------------------------------------------------------------------------------------------------


def _document(pages: list[tuple[tuple[float, float], bytes]]) -> bytes:
    """A PDF of pages, each with its size, mm, and its content; it asks the printer not to scale it."""
    kids = " ".join(f"{4 + 2 * i} 0 R" for i in range(len(pages)))
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        f"<< /Type /Pages /Kids [{kids}] /Count {len(pages)} >>".encode(),
        b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>",
    ]
    for i, ((wide, high), content) in enumerate(pages):
        box = f"[0 0 {wide * POINT:.4f} {high * POINT:.4f}]"
        resources = "<< /Font << /F 3 0 R >> >>"
        objects.append(
            f"<< /Type /Page /Parent 2 0 R /MediaBox {box} /Resources {resources} /Contents {5 + 2 * i} 0 R >>".encode()
        )
        objects.append(b"<< /Length %d >>\nstream\n%b\nendstream" % (len(content), content))
    data, places = bytearray(b"%PDF-1.6\n"), []
    for i, entry in enumerate(objects, 1):
        places.append(len(data))
        data += b"%d 0 obj\n%b\nendobj\n" % (i, entry)
    table = "".join(f"{place:010d} 00000 n \n" for place in places)
    end = f"xref\n0 {len(objects) + 1}\n0000000000 65535 f \n{table}"
    end += f"trailer\n<< /Size {len(objects) + 1} /Root 1 0 R >>\nstartxref\n{len(data)}\n%%EOF\n"
    return bytes(data + end.encode())
