"""What a grinder's table leaves of a lobe: the envelope of its wheel over the straight joins of the rows.

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
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.offset import TightError, chain_of, parallel
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.nesting import Chain
from kin.read.size import contents

if TYPE_CHECKING:
    from pathlib import Path

    from kin.contour.arcs import Arcs
    from kin.numeric.arrays import Array

UNITS = {"mm": 1.0, "in": 25.4}
SHOWN = 80  # characters of a header in a message
FULL = 1e-9  # degrees within which a table closes
FINE = 1e-3  # of the tolerance: what pieces of the metal are left out by
LEAST_ROWS, MOST_ROWS = 8, 400_000
COARSE = 0.9  # of a join's radius: its centre lies nearer the shaft than that


@dataclass(frozen=True)
class Grinding:
    """How tables of a lobe are meant, mm.

    wheel   radius of the wheel whose distance from the shaft is tabled; None where none is given
    roller  radius of the roller whose lift is tabled; None where there is no such table
    zero    distance of that roller's centre from the shaft where its lift is 0
    """

    wheel: float | None = None
    roller: float | None = None
    zero: float = 0.0


class Ground(NamedTuple):
    """What a table leaves: the contour, the unit of its lengths, mm, and by how much the contour may be off, mm."""

    chain: Chain
    units: float
    off: float


def ground(path: Path, grinding: Grinding, tolerance: float) -> Ground:
    """Simulate a table of the wheel's or the roller's places; raises ReadError for what is none or grinds no lobe."""
    angles, distance, radius, units = _rows(path, grinding)
    loop, off = _joins(angles, distance, path)
    fine = FINE * tolerance
    try:
        edge = parallel(loop, radius, fine)
    except TightError as error:
        told = f"the wheel of radius {radius:.6g} mm leaves no single contour: {error}"
        raise ReadError("open", told, path) from error
    short = np.abs(loop.length * (1.0 - loop.curvature * radius)) <= fine
    return Ground(Chain(edge, pieces=len(angles)), units, off + (fine if short.any() else 0.0))


def _rows(path: Path, grinding: Grinding) -> tuple[Array, Array, float, float]:
    """Angles, rad, and distances of the centre, mm, (n,) each, without the closing row; its radius and the unit, mm."""
    try:
        lines = contents(path, "csv").decode("ascii").splitlines()
    except UnicodeDecodeError as error:
        raise ReadError("syntax", "the table is not plain text", path) from error
    lines = [line for line in lines if line.strip() and not line.startswith("#")]
    names = [name.strip() for name in lines[0].split(",")] if lines else []
    kind = next((name for name in names if name.partition("_")[0] in {"x", "lift"}), "")
    word, _, unit = kind.partition("_")
    radius = grinding.wheel if word == "x" else grinding.roller
    if "c_deg" not in names or unit not in UNITS or radius is None:
        wheel = "c_deg and x_mm or x_in with manufacture.wheel"
        roller = "c_deg and lift_mm or lift_in with the lift table's roller"
        there = ", ".join(name for name in names if name)[:SHOWN] or "none"
        message = f"of a CSV the columns {wheel}, or {roller}, are judged; its columns are {there}"
        raise ReadError("unsupported", message, path)
    columns = names.index("c_deg"), names.index(kind)
    try:
        rows = [line.split(",") for line in lines[1:]]
        values = np.array([[float(row[column]) for column in columns] for row in rows], dtype=np.float64)
    except (ValueError, IndexError) as error:
        raise ReadError("syntax", f"a row is no row of {len(names)} numbers", path) from error
    if not LEAST_ROWS < len(values) <= MOST_ROWS:
        raise ReadError("range", f"the table has {len(values)} rows; {LEAST_ROWS} to {MOST_ROWS} are read", path)
    degrees, distance = values[:, 0], UNITS[unit] * values[:, 1] + (0.0 if word == "x" else grinding.zero)
    if not (np.isfinite(values).all() and (np.diff(degrees) > 0.0).all() and (distance > 0.0).all()):
        raise ReadError("range", "the angles must rise, and the distances be above 0", path)
    if abs(degrees[-1] - degrees[0] - 360.0) > FULL or abs(distance[-1] - distance[0]) > FULL * distance[0]:
        raise ReadError("open", f"the table does not close: it covers {degrees[-1] - degrees[0]:.9g} degrees", path)
    return np.radians(degrees[:-1]), distance[:-1], radius, UNITS[unit]


def _joins(angles: Array, distance: Array, path: Path) -> tuple[Arcs, float]:
    """An arc for each join of two rows, and by how much any is off at most, mm."""
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
        told = f"the wheel moves too fast for its step about {math.degrees(angles[row]):.6g} degrees"
        raise ReadError("range", told, path)
    return loop, float((step**3 * bend(away, away / radius)).max()) / (72.0 * math.sqrt(3.0))


def bend(away: Array, share: Array) -> Array:
    """Bound of |r'''|, mm/rad^3, of circles in polar coordinates whose centres lie `away`, a `share` of the radius."""
    return away * (1.0 + share * (1.0 + 3.0 / (1.0 - share * share)))
