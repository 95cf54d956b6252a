"""Results for a file of an indexing cam."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check
    from kin.read.mesh.mesh import Mesh

CONTOUR, MOTION = "contour", "motion"  # checks of solids and of developments


@dataclass(frozen=True)
class MotionError:
    """Error of the turret's position, measured less intended, over all shaft angles, deg.

    An error above 0 pushes the turret away from the metal of the flank.

    max          greatest magnitude found, at the shaft angle `at`, degrees
    remainder    of a solid no error exceeds `max` by more, which is proved; of a line those at the angles looked at
    least, most  the greatest error into the metal (below 0) and out of it
    rms          over equal steps of the shaft angle
    """

    max: float
    at: float
    remainder: float
    least: float
    most: float
    rms: float

    @property
    def bound(self) -> float:
        """Greatest error with what the proof leaves open."""
        return self.max + self.remainder


@dataclass(frozen=True)
class Play:
    """Least and greatest free travel of the turret, cam at rest, deg, at shaft angles, degrees.

    It is what all rollers together leave free. Below 0 the turret is pinched: it has a preload, or the flanks stand
    closer than the rollers are wide, as far as their tolerance permits. Both are exact at so many `angles`.
    """

    least: float
    least_at: float
    most: float
    most_at: float
    angles: int


@dataclass(frozen=True, eq=False)
class FlankVerdict:
    """Results for one flank, or for one line of a development.

    name            "lower" or "upper", or the line's layer
    motion          of the turret on it; of an upper flank that of its gauges, larger by the clearance
    measured_error  greatest distance of the file's surface from the exact flank, mm
    pieces          triangles of the file on this flank; None of a line, and of a program
    """

    name: str
    motion: MotionError | None = None
    measured_error: float | None = None
    pieces: int | None = None


@dataclass(frozen=True, eq=False)
class IndexVerdict:
    """Results for a file.

    kind    name of the file's format: stl, ply, 3mf, dxf, gcode
    checks  of a solid: watertight, blank, floor, ends, bore, contour and motion (one for each flank), form-closure,
            volume; of a development: units, contour and motion (one for each line); of a program: cutter, rapid, ways,
            feed, depth, cleared, contour and motion (one for each flank), form-closure; or a single one that says why
            the file cannot be read. Places are shaft angles, degrees
    flanks  lower and upper; none where the file cannot be read
    play    of the turret between its rollers' flanks
    units   mm in a unit of the file as it was read
    mesh    of a solid, mm, as the file has it
    lines   of a development: points (n, 2), mm, of each line, by its layer, as if not mirrored
    """

    kind: str
    checks: tuple[Check, ...]
    flanks: tuple[FlankVerdict, ...] = ()
    play: Play | None = None
    units: float | None = None
    mesh: Mesh | None = None
    lines: tuple[tuple[str, Array], ...] = ()

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return all(check.ok for check in self.checks)
