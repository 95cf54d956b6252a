"""A list of points of a closed curve, and the spline that a CAD system puts through it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.bezier import Beziers
from kin.contour.closed_spline import closed_spline
from kin.contour.contour import Contour
from kin.contour.pieces import Pieces
from kin.read.errors import ReadError
from kin.read.rows import has_more_rows

if TYPE_CHECKING:
    from pathlib import Path

    from kin.numeric.arrays import Array

MOST = 16_000_000  # bytes
LEAST_POINTS, MOST_POINTS = 4, 100_000
LARGEST = 1e6  # of a coordinate, in the file's unit
_WIDTHS = (2, 3)  # numbers of a line
_LINE = 4096  # bytes, more than a line has
SAME = 1e-9  # mm, or share of the size above 1 mm, within which points are one


def is_point_list(path: Path) -> bool:
    """Whether a file lists a closed curve: its first line is of two or three numbers and stands again as its last.

    Raises OSError where the file cannot be read.
    """
    with path.open("rb") as file:
        begin = file.readline(_LINE)
        after_first = file.tell()
        file.seek(max(after_first, file.seek(0, 2) - _LINE))
        end = file.read().strip().rpartition(b"\n")[2]
    first = _cells(begin)
    return first == _cells(end) and len(first) in _WIDTHS and all(map(_is_number, first))


def _cells(line: bytes) -> list[str]:
    return line.decode("utf-8-sig", "replace").replace(",", " ").replace(";", " ").split()


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def spline_of_points(path: Path, mm: float = 1.0) -> tuple[Contour, int]:
    """Closed spline, counter-clockwise, mm, through the points of a file, and their number without the repeated one.

    Lines of the file hold x, y and perhaps z, in units of `mm` mm, parted by commas, semicolons, blanks or tabs. Raises
    ReadError for a file that is too large, has a line of other than these numbers, too few or too many points, a point
    twice in a row, or no closed curve in a plane z = constant; OSError where the file cannot be read.
    """
    points = mm * _points(path)
    size = float(np.abs(points).max())
    if np.hypot(*(points[-1] - points[0])) > SAME * max(size, 1.0):
        raise ReadError("open", "the last point is not the first: the curve is not closed", path)
    points = points[:-1]
    chords = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    if not (chords > SAME * max(size, 1.0)).all():
        raise ReadError("syntax", f"point {(int(np.argmin(chords)) + 1) % len(points) + 1} is the one before it", path)
    control = closed_spline(points)
    unrolled = Beziers(control, np.ones(control.shape[:2])).unrolled()
    contour = Contour.from_pieces(Pieces.from_unrolled(unrolled.pieces))
    return (contour if contour.area > 0.0 else contour.reversed()), len(points)


def _points(path: Path) -> Array:
    """Points (n, 2), in the file's unit; raises ReadError for a file that is too large, and unfit lines or points."""
    if path.stat().st_size > MOST:
        raise ReadError("range", f"larger than {MOST / 1e6:g} MB", path)
    text = path.read_bytes().decode("utf-8-sig", "replace")
    if has_more_rows(text, MOST_POINTS + 1):
        raise ReadError(
            "range", f"more than {MOST_POINTS + 1} points; {LEAST_POINTS + 1} to {MOST_POINTS + 1} are read", path
        )
    lines = [line.replace(",", " ").replace(";", " ").split() for line in text.splitlines() if line.strip()]
    try:
        rows = np.array([[float(cell) for cell in line] for line in lines])
    except ValueError as error:
        raise ReadError("syntax", "a line is not of two or three numbers, as many on each", path) from error
    if rows.ndim != 2 or rows.shape[1] not in _WIDTHS or not np.isfinite(rows).all():
        raise ReadError("syntax", "a line is not of two or three numbers, as many on each", path)
    if not LEAST_POINTS < len(rows) <= MOST_POINTS + 1:
        raise ReadError("range", f"{len(rows)} points; {LEAST_POINTS + 1} to {MOST_POINTS + 1} are read", path)
    if np.abs(rows).max() > LARGEST:
        raise ReadError("range", f"a coordinate is {np.abs(rows).max():.6g}, which no part has", path)
    if rows.shape[1] == 3 and np.ptp(rows[:, 2]) != 0.0:
        raise ReadError("unsupported", "the points do not lie in a plane z = constant", path)
    return rows[:, :2]
