"""Cam tables of drives as they lie on disk: rows of a master and a slave, and how their controller joins them.

A plain table names its columns by quantity and unit, and says in its head how rows are joined. A layout of a vendor has
the members of the vendor's structure as columns; a column of codes says how its rows are joined.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.joined_rows import RATES, JoinedRows
from kin.numeric.angles import TURN
from kin.read.curve_points import is_curve_points, read_curve_points
from kin.read.errors import ReadError
from kin.read.formats import contents

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from kin.law.joined_rows import Join
    from kin.numeric.arrays import Array

MASTER = "master_deg"
"""Heading of the first column, by which a plain table for a drive is told from others."""
SLAVES = {"slave_mm": 1.0, "slave_in": 25.4, "slave_deg": math.radians(1.0)}
COLUMNS = ("velocity", "acceleration")  # of a plain table: per degree of the master, and per its square
JOINS: dict[Join, str] = {
    "line": "joined by straight lines",
    "cubic": "joined by a cubic spline",
    "quintic": "joined by polynomials of degree 5",
}
"""How rows are joined, as the head of a table has it."""
SINGLE = "numbers of single precision"
"""Words of the head of a table whose controller keeps numbers of 32 bits."""
STATED = re.compile(r"\bwithin (\S+) (?:mm|in|deg) of the motion")
UNIT = re.compile(r"\bslave in (mm|in|deg)\b")
ENDS = re.compile(r"\bStart Slope (\S+), End Slope (\S+?)[;,]?(?:\s|$)")
LEAST_ROWS, MOST_ROWS = 3, 400_000
FULL = 1e-9  # degrees, within which a table begins at 0 and ends at 360


class Layout(NamedTuple):
    """Columns of a vendor's table as its structure names them, those that are read, and the codes of a join.

    `read` are master, slave and its derivatives. `joins` are the joins by the codes in the column `code`. `single` is
    whether numbers have 32 bits.
    """

    columns: tuple[str, ...]
    read: tuple[str, ...]
    code: str
    joins: Mapping[int, Join]
    single: bool = False

    def code_of(self, join: Join) -> int:
        """Code of a join; raises StopIteration for a join that the layout does not have."""
        return next(code for code, name in self.joins.items() if name == join)


MOTION_FUNCTION = Layout(
    (
        *("PointIndex", "FunctionType", "PointType", "RelIndexNextPoint"),
        *("MasterPos", "SlavePos", "SlaveVelo", "SlaveAcc", "SlaveJerk"),
    ),
    ("MasterPos", "SlavePos", "SlaveVelo", "SlaveAcc"),
    "FunctionType",
    {1: "line", 15: "quintic"},
)
"""Beckhoff's `MC_MotionFunctionPoint`; its code is an `MC_MotionFunctionType`."""
CAM_ARRAY = Layout(
    ("Master", "Slave", "SegmentType"), ("Master", "Slave"), "SegmentType", {0: "line", 1: "cubic"}, single=True
)
"""Rockwell's array of `CAM`."""
LAYOUTS = (MOTION_FUNCTION, CAM_ARRAY)


class DriveTable(NamedTuple):
    """A cam table as read: rows in mm or rad, the slave's unit in these, and the error stated in it."""

    rows: JoinedRows
    unit: float
    stated: float | None


def is_drive(path: Path) -> bool:
    """Whether a table is one for a drive, by its first lines; raises OSError where the disk refuses."""
    with path.open("rb") as file:
        text = file.read(1 << 16).decode("utf-8-sig", "replace")
    names = _heading(text)
    return MASTER in names or _layout(names) is not None or is_curve_points(path)


def read_drive(path: Path, unit: float = 1.0) -> DriveTable:
    """Read a table for a drive; its slave's unit is `unit`, mm or rad, if the table states none.

    Raises ReadError for a file that is too large or no such table, OSError where the disk refuses.
    """
    if is_curve_points(path):
        points = read_curve_points(path)
        pairs = JoinedRows(_turn(points[:, 0], path), points[:, 1:].T * unit, "line")
        return DriveTable(_sound(pairs, path), unit, None)
    text = contents(path, "csv").decode("utf-8-sig", "replace")
    head, names = [line for line in text.splitlines() if line.startswith("#")], _heading(text)
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")][1:]
    layout = _layout(names)
    stated = [float(match[1]) for line in head if (match := STATED.search(line)) and _is_number(match[1])]
    if layout is None:
        join = _join_in(head, path)
        slave = next((name for name in names if name in SLAVES), "")
        columns = [MASTER, slave or "slave_mm", *COLUMNS[: RATES[join]]]
        if names[: len(columns)] != columns:
            raise ReadError("unsupported", f"its columns are {', '.join(names)}, and not {', '.join(columns)}", path)
        numbers = _numbers(lines, len(names), path)[:, : len(columns)]
        unit, single = SLAVES[slave], any(SINGLE in line for line in head)
    else:
        table = _numbers(lines, len(names), path)
        join = _join_of(table[:-1, names.index(layout.code.lower())], layout, path)
        numbers = table[:, [names.index(name.lower()) for name in layout.read[: 2 + RATES[join]]]]
        shown = next((match[1] for line in head if (match := UNIT.search(line))), None)
        unit, single = (unit if shown is None else SLAVES[f"slave_{shown}"]), layout.single
    ends = np.array(_ends(head, path))
    if single:
        with np.errstate(over="ignore"):
            numbers, ends = (each.astype(np.float32).astype(np.float64) for each in (numbers, ends))
    angle, degree = _turn(numbers[:, 0], path), math.degrees(1.0)
    rows = numbers[:, 1:].T * unit * (degree ** np.arange(numbers.shape[1] - 1.0))[:, None]
    first, last = (ends * unit * degree).tolist()
    joined = _sound(JoinedRows(angle, rows, join, (first, last)), path)
    return DriveTable(joined, unit, min(stated, default=None))


def _sound(rows: JoinedRows, path: Path) -> JoinedRows:
    """The rows; raises ReadError where numbers are too large, or masters too near, to be joined."""
    if not rows.sound:
        raise ReadError("range", "its numbers are too large, or its masters too near, to be joined", path)
    return rows


def _layout(names: list[str]) -> Layout | None:
    """Vendor's layout with these columns, in lower case; None for a plain table."""
    return next((each for each in LAYOUTS if names == [name.lower() for name in each.columns]), None)


def _join_in(head: list[str], path: Path) -> Join:
    join = next((name for name, words in JOINS.items() if any(words in line for line in head)), None)
    if join is None:
        accepted = " or ".join(f"`# {words}`" for words in JOINS.values())
        raise ReadError("unsupported", f"the head does not say how rows are joined: give a line {accepted}", path)
    return join


def _join_of(codes: Array, layout: Layout, path: Path) -> Join:
    """Join of all rows by their codes (n,); raises ReadError for several, and for one that is not known."""
    kinds = np.unique(codes).tolist()
    join = layout.joins.get(kinds[0]) if len(kinds) == 1 else None
    if join is None:
        shown, known = ", ".join(f"{kind:g}" for kind in kinds[:5]), " or ".join(map(str, layout.joins))
        raise ReadError("unsupported", f"{layout.code} is {shown}; it is judged where all rows have {known}", path)
    return join


def _ends(head: list[str], path: Path) -> tuple[float, float]:
    """Slopes of a cubic spline at its ends as the head states them, by degree of the master; 0 without."""
    found = next((match for line in head if (match := ENDS.search(line))), None)
    if found is None:
        return 0.0, 0.0
    if not (_is_number(found[1]) and _is_number(found[2])):
        raise ReadError("syntax", f"Start Slope {found[1]} and End Slope {found[2]} are not two finite numbers", path)
    return float(found[1]), float(found[2])


def _turn(master: Array, path: Path) -> Array:
    """Angles of a master (n,), rad, from degrees; raises ReadError where they do not go round."""
    if abs(master[0]) > FULL or abs(master[-1] - 360.0) > FULL or (np.diff(master) <= 0.0).any():
        raise ReadError("range", "the master does not rise from 0 to 360 degrees", path)
    angle = np.radians(master)
    angle[-1] = TURN
    return angle


def _numbers(lines: list[str], count: int, path: Path) -> Array:
    """Rows of numbers, (n, count); raises ReadError for others, and for too few or too many."""
    if not LEAST_ROWS <= len(lines) <= MOST_ROWS:
        raise ReadError("range", f"{len(lines)} rows; {LEAST_ROWS} to {MOST_ROWS} are judged", path)
    try:
        rows = np.loadtxt(lines, delimiter=",", comments=None, ndmin=2)
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1)).tolist() if rows.shape[1] == count else [0]
    except ValueError:  # one row at a time takes longer, and tells which
        cells = (line.split(",") for line in lines)
        bad = [i for i, row in enumerate(cells) if len(row) != count or not all(map(_is_number, row))] or [0]
    if bad:
        raise ReadError("syntax", f"row {bad[0] + 1} is not of {count} finite numbers", path)
    return rows


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _heading(text: str) -> list[str]:
    """Names of the columns, from the first line that is no remark."""
    line = next((line for line in text.splitlines() if line.strip() and not line.startswith("#")), "")
    return [cell.strip().strip('"').lower() for cell in line.split(",")]
