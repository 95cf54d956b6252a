"""A curve point table of SEW-EURODRIVE's MOVI-C controllers: the number of points, then a master and a slave a line.

The manual's chapter "Curve point table" has a semicolon between the two, and a point or a comma in numbers; that of
MOVIRUN open has a tab. No unit, no heading and no remark stands in it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.read.errors import ReadError
from kin.read.formats import contents

if TYPE_CHECKING:
    from pathlib import Path

    from kin.numeric.arrays import Array

LEAST_POINTS, MOST_POINTS = 3, 16_383  # the most that its library's constant may be set to
_LINE = 4096  # bytes, more than a line has


def is_curve_points(path: Path) -> bool:
    """Whether a file is a curve point table: a whole number, and a master of 0 with a slave in the line below.

    Raises OSError where the file cannot be read.
    """
    with path.open("rb") as file:
        count, first = (file.readline(_LINE).decode("utf-8-sig", "replace") for _ in range(2))
    pair = _pair(first)
    return count.strip().isdecimal() and pair is not None and pair[0] == 0.0


def read_curve_points(path: Path) -> Array:
    """Positions of master and slave (n, 2), in the file's unit, of a file for which `is_curve_points` holds.

    Raises OSError where the file cannot be read; ReadError for a file that is too large, a line that is not of two
    finite numbers, and a number of lines that is not that of the first line or out of bounds.
    """
    lines = [line for line in contents(path, "csv").decode("utf-8-sig", "replace").splitlines() if line.strip()]
    count, rows = int(lines[0]), [_pair(line) for line in lines[1:]]
    bad = next((i for i, row in enumerate(rows) if row is None), None)
    if bad is not None:
        raise ReadError("syntax", f"row {bad + 1} is not of 2 finite numbers", path)
    if len(rows) != count:
        raise ReadError("syntax", f"its first line says {count} rows, and there are {len(rows)}", path)
    if not LEAST_POINTS <= count <= MOST_POINTS:
        raise ReadError("range", f"{count} rows; {LEAST_POINTS} to {MOST_POINTS} are judged", path)
    return np.array(rows)


def _pair(line: str) -> tuple[float, float] | None:
    """The two numbers of a line, None for anything else."""
    cells = line.replace(",", ".").replace("\t", ";").split(";")
    try:
        numbers = [float(cell) for cell in cells]
    except ValueError:
        return None
    return (numbers[0], numbers[1]) if len(numbers) == 2 and all(map(math.isfinite, numbers)) else None
