"""A table for a drive as it lies on disk: its rows joined as its controller joins them, held to the intended motion."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.judge.check import Check, at_most, failed
from kin.law.joined_rows import JoinedRows
from kin.numeric.angles import TURN
from kin.numeric.monotone import RoughError, between, cells, pieces
from kin.read.curve_points import is_curve_points, read_curve_points
from kin.read.errors import ReadError
from kin.read.formats import contents

if TYPE_CHECKING:
    from pathlib import Path

    from kin.follower.base import Follower
    from kin.judge.intent import Limits
    from kin.law.joined_rows import Join
    from kin.numeric.arrays import Array

MASTER = "master_deg"
"""Heading of the first column, by which a table for a drive is told from others."""
SLAVES = {"slave_mm": 1.0, "slave_in": 25.4, "slave_deg": math.radians(1.0)}
RATES = ("velocity", "acceleration")  # columns per degree of the master, and per its square
JOINS: dict[Join, str] = {
    "line": "joined by straight lines",
    "quintic": "joined by polynomials of degree 5",
}
"""How rows are joined, as the head of a table has it."""
STATED = re.compile(r"\bwithin (\S+) (?:mm|in|deg) of the motion")
LEAST_ROWS, MOST_ROWS = 3, 400_000
FULL = 1e-9  # degrees, within which a table begins at 0 and ends at 360
SHORT = 1e-5  # share by which the error in the head may be short: it has six digits
DIGITS = 1e-11  # of a position, as a table has it
SHARE = 1e-12  # of the stroke, to which its lowest place is found


class Table(NamedTuple):
    """A cam table of a drive as read: rows in mm or rad, the slave's unit in these, and the error stated in it."""

    rows: JoinedRows
    unit: float
    stated: float | None


def is_drive(path: Path) -> bool:
    """Whether a table is one for a drive, by its first lines; raises OSError where the disk refuses."""
    with path.open("rb") as file:
        text = file.read(1 << 16).decode("utf-8-sig", "replace")
    return MASTER in _heading(text) or is_curve_points(path)


def drive_checks(path: Path, follower: Follower, limits: Limits, mm: float = 1.0) -> list[Check]:
    """Check the motion by a drive's table, lowest at 0, against a follower's intended one.

    The greatest error, mm or degrees, may reach the limit of motion or, without one, the error that the tolerance makes
    at a pressure angle of 0. `mm` is the unit, in mm, of a slave whose table states none, of a follower on a stem. A
    file that is no such table has one failed check that says why. Raises OSError where the disk refuses.
    """
    try:
        table = read_table(path, SLAVES["slave_deg"] if follower.unit == "deg" else mm)
        worst, at = _off(table.rows, follower)
    except RoughError:
        return [failed("readable", "the motion changes too abruptly to be followed")]
    except ReadError as error:
        return [failed("readable", error.message)]
    if (table.unit == SLAVES["slave_deg"]) != (follower.unit == "deg"):
        return [failed("readable", f"the slave is not in the follower's unit, {follower.unit}")]
    own = math.radians(1.0) if follower.unit == "deg" else 1.0
    most = follower.direct_limit(limits.tolerance) if limits.motion is None else limits.motion
    slack = DIGITS * float(np.ptp(table.rows.slave[0])) / own
    checks = [at_most("interpolation", worst / own, most, follower.unit, angle=at, slack=slack)]
    if table.stated is not None:
        stated = table.stated * table.unit / own
        checks.append(at_most("stated-error", worst / own, stated, follower.unit, slack=SHORT * stated + slack))
    return checks


def _off(rows: JoinedRows, follower: Follower) -> tuple[float, float]:
    """Greatest distance, mm or rad, of joined rows from a follower's motion above its lowest place, and angle, rad."""
    breaks = follower.motion.breaks.tolist()
    followed = cells(lambda t: follower.intended(t)[None], between(0.0, TURN, breaks), share=SHARE)
    lowest, _ = pieces(followed).least()
    return rows.off(lambda t: follower.intended(t) - lowest, breaks)


def read_table(path: Path, unit: float = 1.0) -> Table:
    """Read a table for a drive; its slave's unit is `unit`, mm or rad, if the table states none.

    Raises ReadError for a file that is too large or no such table, OSError where the disk refuses.
    """
    if is_curve_points(path):
        points = read_curve_points(path)
        return Table(JoinedRows(_turn(points[:, 0], path), points[:, 1:].T * unit, "line"), unit, None)
    text = contents(path, "csv").decode("utf-8-sig", "replace")
    head = [line for line in text.splitlines() if line.startswith("#")]
    join = next((name for name, words in JOINS.items() if any(words in line for line in head)), None)
    if join is None:
        accepted = " or ".join(f"`# {words}`" for words in JOINS.values())
        raise ReadError("unsupported", f"the head does not say how rows are joined: give a line {accepted}", path)
    names, wanted = _heading(text), 2 if join == "line" else 4
    slave = next((name for name in names if name in SLAVES), "")
    columns = [MASTER, slave or "slave_mm", *(RATES if wanted > 2 else ())]
    if names[: len(columns)] != columns:
        raise ReadError("unsupported", f"its columns are {', '.join(names)}, and not {', '.join(columns)}", path)
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")][1:]
    numbers = _numbers(lines, len(names), path)
    angle, degree = _turn(numbers[:, 0], path), math.degrees(1.0)
    rows = numbers[:, 1:wanted].T * SLAVES[slave] * np.array([1.0, degree, degree**2])[: wanted - 1, None]
    stated = [float(match[1]) for line in head if (match := STATED.search(line)) and _is_number(match[1])]
    return Table(JoinedRows(angle, rows, join), SLAVES[slave], min(stated, default=None))


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
