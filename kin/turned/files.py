"""Files of turning bodies, solids, developments and programs: what is read and checked before flanks are looked at."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np

from kin.numeric.check import ROUNDING, Check, at_most, failed
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.records import dataclass, replace
from kin.read.checks import count_check, demand_same, enclosed_check, units_check
from kin.read.errors import ReadError
from kin.read.files import read_mesh
from kin.read.formats import format_of
from kin.read.mesh.split import joined
from kin.turned.moves import passes_of, read_turned
from kin.turned.verdict import TurnedVerdict

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array
    from kin.read.mesh.checked import CheckedMesh
    from kin.turned.moves import Pass, TurnedProgram
    from kin.turned.verdict import FlankVerdict

WATERTIGHT = "watertight"


@dataclass(frozen=True)
class Developed:
    """A line of a development, by its layer, unrolled at a `radius`, mm: x = radius phi over one period, y = z.

    flank  "lower" or "upper", as the flank meets the cylinder of that radius; "pitch" for a drum's roller's axis there
    """

    layer: str
    radius: float
    flank: Literal["lower", "upper", "pitch"]


class Drawn(Protocol):
    """An intended body whose development is drawn."""

    @property
    def mirrored(self) -> bool:
        """Whether the file is mirrored, y -> -y."""
        ...

    @property
    def mm(self) -> float:
        """Length of a unit of a development's DXF, mm."""
        ...


def verify_mesh(path: Path, units: float | None, judge: Callable[[CheckedMesh, str], TurnedVerdict]) -> TurnedVerdict:
    """Verdict on a solid of triangles, by the suffix of its file, as `judge` gives it for the mesh and the format.

    `units`, mm, is the unit of a file that states none; None is mm. A file from which no mesh can be read gets a
    verdict that says why. Raises OSError where the disk refuses, ValueError for a suffix of files without meshes.
    """
    kind = format_of(path)
    try:
        read = read_mesh(path, units)
    except ReadError as error:
        return TurnedVerdict.unread(path, kind.name, "solid", error)
    return judge(read, kind.name).about(path)


def verify_lines(
    path: Path,
    lines: Sequence[Developed],
    drawn: Drawn,
    period: float,
    judge: Callable[[list[Array], Developed], tuple[FlankVerdict, list[Check]]],
    *,
    units: float | None,
) -> TurnedVerdict:
    """Verdict on a development's DXF, as `judge` gives it for the runs of points of each line, mm, not mirrored.

    A line goes over a `period`, rad, and may go on beyond it, as an overlap does. `units`, mm, is the unit of a file
    that states none. Raises OSError where the disk refuses, UnitsError where the file states another unit than `units`,
    ValueError for a file that is no DXF.
    """
    from kin.read.drawing.straight import read_lines

    kind = format_of(path)
    if kind.name != "dxf":
        raise ValueError(f"{path.name} is no DXF")
    try:
        stated, read = read_lines(path, [line.layer for line in lines])
    except ReadError as error:
        return TurnedVerdict.unread(path, kind.name, kind.contents, error)
    demand_same(stated, units, path)
    mm = stated or units or drawn.mm
    widest = max((float(np.ptp(part[:, 0])) for parts in read.values() for part in parts), default=0.0)
    whole = period * max((line.radius for line in lines), default=1.0)
    checks = [units_check(stated, units, drawn.mm, lambda: drawn.mm * widest / whole)]
    verdicts, points = [], []
    for line in lines:
        parts = [mm * part * ([-1.0, 1.0] if drawn.mirrored else [1.0, 1.0]) for part in read[line.layer]]
        points += [(line.layer, part) for part in parts]
        flank, own = judge(parts, line)
        verdicts.append(replace(flank, name=line.layer))
        checks += [replace(check, surface=line.layer) for check in own]
    return TurnedVerdict(kind.name, tuple(checks), tuple(verdicts), units=mm, lines=tuple(points)).about(path)


def verify_moves(
    path: Path, blank: float, judge: Callable[[TurnedProgram, list[Pass]], TurnedVerdict], *, mirrored: bool
) -> TurnedVerdict:
    """Verdict on a program, as `judge` gives it for its moves and its passes in a blank of a radius, mm, not mirrored.

    Raises OSError where the disk refuses.
    """
    try:
        program = read_turned(path)
    except ReadError as error:
        return TurnedVerdict.unread(path, "gcode", "program", error)
    if mirrored:
        program = replace(program, moves=tuple(move.mirrored() for move in program.moves))
    return judge(program, list(passes_of(program.moves, blank))).about(path)


def closed_mesh(read: CheckedMesh, tolerance: float) -> tuple[CheckedMesh, Check]:
    """The mesh with corners joined that its file keeps apart by less than a tolerance, mm; check that it is closed."""
    read, count, apart = joined(read, tolerance)
    closed = count_check(WATERTIGHT, list(read.faults))
    told = f"joined at {count} corners that the file keeps up to {length_words(apart, '.2g')} {UNIT} apart"
    return read, replace(closed, detail=told) if count else closed


def rounding_of(read: CheckedMesh, points: Array) -> float:
    """By how much places (n, 3), mm, of a mesh may be off by the numbers of its file and of the judge, mm."""
    return read.rounding * math.sqrt(3.0) + ROUNDING * float(np.abs(points).max())


def face_check(name: str, off: float, limit: float, detail: str, slack: float) -> Check:
    """Check of a plain face that is `off` at most, mm, against a limit, mm; nan of one that is not there, which fails.

    `slack` is the rounding of its places, mm.
    """
    if math.isnan(off):
        return failed(name, f"nothing is there; {detail}", unit="mm", limit=limit)
    return at_most(name, off, limit, "mm", detail=detail, slack=slack)


def volume_check(read: CheckedMesh, exact: tuple[float, float], tolerance: float) -> Check:
    """Check of what a mesh encloses by the exact volume and by how much that may be off, mm^3; tolerance in mm."""
    area = 0.5 * float(np.sqrt(sum(part * part for part in read.mesh.area_vectors)).sum())
    return enclosed_check((read.mesh.volume, area), exact, tolerance, stated=read.units_mm is not None)
