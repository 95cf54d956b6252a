"""The contour of a lobe that a grinder's table leaves: the envelope of its wheel over the straight joins of the rows.

Between two rows the distance X of the wheel's centre is linear in the angle C of the work. A circular arc through both
rows and the middle of such a join stands for it. In polar coordinates the two agree at three angles, so they differ by
at most H^3/(72 sqrt 3) max|r'''| over a step H. Of a circle of radius R about a centre at a distance d = q R from the
shaft r = d cos C + g with g = R w, w = sqrt(1 - (q sin C)^2), and

    g''' = R q^2 (sin C cos C/w) (1 + 3 (1 - q^2)/w^4),    |sin C cos C| <= w,    1 - q^2 <= w^2,

so that |r'''| <= d + d q (1 + 3/(1 - q^2)). The metal is the parallel of all joins at the wheel's radius inside: where
two joins meet outward the parallels are cut off where they cross, where they meet inward the wheel leaves its own arc.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.offset import TightError, chain_of, parallel
from kin.numeric.check import Check, at_most
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.formats import contents
from kin.read.nesting import ClosedContour

if TYPE_CHECKING:
    from pathlib import Path

    from kin.contour.arcs import Arcs
    from kin.follower.envelope import Envelope
    from kin.numeric.arrays import Array

UNITS = {"mm": 1.0, "in": 25.4, "inch": 25.4}
COLUMNS = frozenset({"c_deg", "x_mm", "x_in", "lift_mm", "lift_in", "normal_deg"})
WHEEL, ROLLER = re.compile(r"\bwheel (\S+) (mm|inch) across"), re.compile(r"\broller (\S+) (mm|inch) across")
CENTRE = re.compile(r"\bcentre is (\S+) (mm|inch) from the shaft")
ERROR = re.compile(r"\bwithin (\S+) (mm|inch) of the exact contour")
STATED = 1e-9  # share by which a length in the head may differ: it has twelve digits
SHORT = 1e-5  # share by which the error in the head may be short: it has six
SHOWN = 80  # characters of a header in a message
FULL = 1e-9  # degrees within which a table closes
FINE = 1e-3  # of the tolerance: shorter pieces of the metal are left out
LEAST_ROWS, MOST_ROWS = 8, 400_000
COARSE = 0.9  # of a join's radius, the greatest distance of its centre from the shaft


@dataclass(frozen=True)
class Grinding:
    """Meaning of the tables of a lobe, mm.

    wheel   radius of the wheel whose distance from the shaft is tabled; None where none is given
    roller  radius of the roller whose lift is tabled; None where there is no such table
    zero    distance of that roller's centre from the shaft where its lift is 0
    """

    wheel: float | None = None
    roller: float | None = None
    zero: float = 0.0


class Ground(NamedTuple):
    """Contour that a grinder's table leaves, and what its head states.

    chain    the contour
    units    of the table's lengths, mm
    off      greatest distance of the contour from what the wheel leaves, mm, by arcs in place of the joins of the rows
             and by short pieces left out
    faults   words for each length that the head lacks, or states otherwise than intended
    error    greatest distance from the exact contour that the head states, mm; None where it states none
    centres  of the wheel (n, 2), mm, row by row
    normals  unit vectors (n, 2) by the column of normals; None where there is none
    radius   of the wheel or roller, mm
    """

    chain: ClosedContour
    units: float
    off: float
    faults: tuple[str, ...]
    error: float | None
    centres: Array
    normals: Array | None
    radius: float


def ground(path: Path, grinding: Grinding, tolerance: float) -> Ground:
    """Contour that a grinder's table leaves of a lobe, by simulating the wheel at its rows.

    Pieces shorter than a thousandth of `tolerance`, mm, are left out. Raises ReadError for a file that is no such
    table, or whose wheel leaves no single contour.
    """
    table = _read(path, grinding)
    loop, off = _joins(table.angles, table.distance, path)
    fine = FINE * tolerance
    try:
        edge = parallel(loop, table.radius, fine)
    except TightError as error:
        message = f"the wheel of radius {table.radius:.6g} mm leaves no single contour: {error}"
        raise ReadError("open", message, path) from error
    short = np.abs(loop.length * (1.0 - loop.curvature * table.radius)) <= fine
    off += fine if short.any() else 0.0
    centres = table.distance[:, None] * _unit(table.angles)
    normals = None if table.normal is None else _unit(table.normal)
    faults, stated = _head_faults(table, grinding), min(_lengths(table.head, ERROR), default=None)
    chain = ClosedContour(edge, pieces=len(table.angles))
    return Ground(chain, table.units, off, faults, stated, centres, normals, table.radius)


def normals_check(table: Ground, envelope: Envelope, tolerance: float, *, mirrored: bool) -> Check | None:
    """Check the column of normals: how far the places of contact that it gives lie from the exact ones, mm.

    The wheel touches an exact contour where its centre has its foot. None without such a column. Raises UnsettledError
    where a foot is not found.
    """
    if table.normals is None:
        return None
    drawn = np.array([1.0, -1.0 if mirrored else 1.0])
    exact = envelope.feet(drawn * table.centres).normal
    off = table.radius * np.hypot(*(drawn * table.normals - exact).T)
    row = int(np.argmax(off))
    angle = math.degrees(math.atan2(table.centres[row, 1], table.centres[row, 0])) % 360.0
    return at_most("normals", float(off[row]), tolerance, "mm", detail=f"the worst is at c_deg = {angle:.6g}")


def stated_check(measured: float, stated: float, tolerance: float) -> Check:
    """Check that the `measured` error, mm, is no greater than the error that a table states, mm.

    Rounding of the stated digits, and pieces left out within a share of `tolerance`, mm, are allowed for.
    """
    return at_most("stated-error", measured, stated, "mm", slack=SHORT * stated + FINE * tolerance)


class _Table(NamedTuple):
    """Rows without the closing one: angles and normals, rad, and distances of the centre, mm, (n,) each.

    `word` is x or lift, from the name of the column of lengths; `head` has the lines behind a #.
    """

    word: str
    head: str
    angles: Array
    distance: Array
    normal: Array | None
    radius: float
    units: float


def _read(path: Path, grinding: Grinding) -> _Table:
    """Read a table; raises ReadError for a file that is too large, no plain text or no such table."""
    try:
        lines = contents(path, "csv").decode("ascii").splitlines()
    except UnicodeDecodeError as error:
        raise ReadError("syntax", "the table is not plain text", path) from error
    head = " ".join(line for line in lines if line.startswith("#"))
    lines = [line for line in lines if line.strip() and not line.startswith("#")]
    names = [name.strip() for name in lines[0].split(",")] if lines else []
    kinds = [name for name in names if name.partition("_")[0] in {"x", "lift"}]
    word, _, unit = kinds[0].partition("_") if kinds else ("", "", "")
    radius = grinding.wheel if word == "x" else grinding.roller
    if "c_deg" not in names or unit not in UNITS or radius is None:
        wheel = "c_deg and x_mm or x_in with manufacture.wheel"
        roller = "c_deg and lift_mm or lift_in with the lift table's roller"
        there = ", ".join(name for name in names if name)[:SHOWN] or "none"
        message = f"of a CSV the columns {wheel}, or {roller}, are judged; its columns are {there}"
        raise ReadError("unsupported", message, path)
    if len(kinds) > 1 or len(set(names)) < len(names) or not COLUMNS.issuperset(names):
        wanted = f"c_deg, {kinds[0]} and normal_deg are read, each once"
        raise ReadError("unsupported", f"columns {', '.join(names)[:SHOWN]}: of a table of a grinder {wanted}", path)
    if len(lines) > MOST_ROWS + 1:
        raise ReadError("range", f"the table has {len(lines) - 1} rows; {LEAST_ROWS} to {MOST_ROWS} are read", path)
    try:
        rows = [line.split(",") for line in lines[1:]]
        values = np.array([[float(cell) for cell in row] for row in rows], dtype=np.float64)
        values = values.reshape(len(rows), len(names))
    except ValueError as error:
        raise ReadError("syntax", f"a row is no row of {len(names)} numbers", path) from error
    if len(values) <= LEAST_ROWS:
        raise ReadError("range", f"the table has {len(values)} rows; {LEAST_ROWS} to {MOST_ROWS} are read", path)
    degrees, distance = values[:, names.index("c_deg")], UNITS[unit] * values[:, names.index(kinds[0])]
    distance = distance + (0.0 if word == "x" else grinding.zero)
    normal = values[:, names.index("normal_deg")] if "normal_deg" in names else None
    if not (np.isfinite(values).all() and (np.diff(degrees) > 0.0).all() and (distance > 0.0).all()):
        raise ReadError("range", "the angles must rise, and the distances be above 0", path)
    closes = abs(distance[-1] - distance[0]) <= FULL * distance[0]
    if normal is not None:
        closes &= abs(math.remainder(normal[-1] - normal[0], 360.0)) <= FULL
    if abs(degrees[-1] - degrees[0] - 360.0) > FULL or not closes:
        raise ReadError("open", f"the table does not close: it covers {degrees[-1] - degrees[0]:.9g} degrees", path)
    normal = None if normal is None else np.radians(normal[:-1])
    return _Table(word, head, np.radians(degrees[:-1]), distance[:-1], normal, radius, UNITS[unit])


def _unit(angles: Array) -> Array:
    """Unit vectors (n, 2) at angles (n,), rad."""
    return np.column_stack([np.cos(angles), np.sin(angles)])


def _head_faults(table: _Table, grinding: Grinding) -> tuple[str, ...]:
    """Words for each of wheel, or roller and its centre at lift 0, that the head lacks or states otherwise."""
    if table.word == "x":
        wanted = [(WHEEL, "wheel", 2.0 * table.radius, "wheel {} across")]
    else:
        wanted = [
            (ROLLER, "roller", 2.0 * table.radius, "roller {} across"),
            (CENTRE, "centre at lift 0", grinding.zero, "at lift 0 its centre is {} from the shaft"),
        ]
    faults = []
    for pattern, name, expected, example in wanted:
        unit = "mm" if table.units == 1.0 else "inch"
        length = f"{expected / table.units:.12g} {unit}"
        stated = _lengths(table.head, pattern)
        if not stated:
            faults.append(f"no line states the {name}, such as `# {example.format(length)}`")
        faults += [
            f"the {name} is stated as {value / table.units:.9g} {unit}, {length} is expected"
            for value in stated
            if not abs(value - expected) <= STATED * expected
        ]
    return tuple(faults)


def _lengths(head: str, pattern: re.Pattern[str]) -> list[float]:
    """All lengths, mm, that a head states in the words of a pattern; nan where there is no number."""
    lengths = []
    for number, unit in pattern.findall(head):
        try:
            lengths.append(UNITS[unit] * float(number))
        except ValueError:
            lengths.append(math.nan)
    return lengths


def _joins(angles: Array, distance: Array, path: Path) -> tuple[Arcs, float]:
    """An arc for each join of two rows, and the greatest distance of one from its join, mm.

    Raises ReadError where the wheel moves too fast for the step.
    """
    step = np.diff(angles, append=angles[0] + 2.0 * np.pi)
    following = np.roll(distance, -1)
    start, end = distance * np.exp(1j * angles), following * np.exp(1j * (angles + step))
    middle = 0.5 * (distance + following) * np.exp(1j * (angles + 0.5 * step))
    turn = np.angle((end - middle) / (middle - start))  # half of what the arc turns
    loop = chain_of(np.column_stack([start.real, start.imag]), np.tan(0.5 * turn))
    chord = np.abs(end - start)
    with np.errstate(divide="ignore"):
        radius = 0.5 * chord / np.abs(np.sin(turn))
    inward = 1j * (end - start) / chord * np.sign(turn)
    centre = 0.5 * (start + end) + inward * radius * np.cos(turn)
    away = np.abs(np.where(np.isfinite(radius), centre, np.inf))
    if not (away < COARSE * radius).all():
        row = int(np.argmin(away < COARSE * radius))
        message = f"the wheel moves too fast for its step about {math.degrees(angles[row]):.6g} degrees"
        raise ReadError("range", message, path)
    return loop, float((step**3 * bend(away, away / radius)).max()) / (72.0 * math.sqrt(3.0))


def bend(away: Array, share: Array) -> Array:
    """Upper bound (n,) of |r'''|, mm/rad^3, of circular arcs r(angle) about the shaft in polar coordinates.

    Their centres lie `away`, mm, from the shaft, and `share` is that distance over the radius, below 1.
    """
    return away * (1.0 + share * (1.0 + 3.0 / (1.0 - share * share)))
