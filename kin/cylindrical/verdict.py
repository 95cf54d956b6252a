"""Results for a file of a cylindrical cam."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check
    from kin.read.mesh.mesh import Mesh
    from kin.turned.guide import Unit


@dataclass(frozen=True)
class MotionError:
    """Error of the position, measured less intended, over all shaft angles, in its `unit`: mm, or deg of an arm.

    An error above 0 pushes the roller away from the metal of its flank.

    max          greatest magnitude found, at the angle `at`, degrees; no error exceeds it by more than `remainder`,
                 which is proved
    least, most  the greatest error into the metal (below 0) and out of it
    rms          over equal steps of the shaft angle
    """

    max: float
    at: float
    remainder: float
    least: float
    most: float
    rms: float
    unit: Unit = "mm"

    @property
    def bound(self) -> float:
        """Greatest error with what the proof leaves open."""
        return self.max + self.remainder


@dataclass(frozen=True)
class Play:
    """Least and greatest free travel of the follower, cam at rest, in its `unit`, at shaft angles, degrees.

    It is mm along z, or deg of an arm.

    Below 0 the roller is pinched: the flanks stand closer than it is wide, as far as their tolerance permits.
    Both are exact at so many `angles`; between these the check of the gauges bounds it.
    """

    least: float
    least_at: float
    most: float
    most_at: float
    angles: int
    unit: Unit = "mm"


@dataclass(frozen=True, eq=False)
class FlankVerdict:
    """Results for one flank, or for one line of a development.

    name            "lower" or "upper", or the line's layer
    motion          of the roller on it; of an upper flank of a groove that of its gauge, larger by the clearance
    measured_error  greatest distance of the file's surface from the exact flank, mm
    pieces          triangles or polynomial patches of the file on this flank; None of a line
    free            stretches of the shaft angle, degrees, in which a crossing leaves the flank nothing that carries:
                    the motion is judged beside them; the last may go on over the end of the period
    """

    name: str
    motion: MotionError | None = None
    measured_error: float | None = None
    pieces: int | None = None
    free: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True, eq=False)
class DrumVerdict:
    """Results for a file.

    kind    name of the file's format: stl, ply, 3mf, step, dxf, gcode
    checks  of a solid: watertight, contour and motion (one for each flank), form-closure, floor, blank, ends, bore,
            volume; of a motion of several turns crossings, of a shoe shoe; of a development: units, contour, motion
            (one for each line); of a program: cutter, rapid, ways, feed, depth, cleared, contour and motion (one for
            each flank); or a single one that says why the file cannot be read. Places are shaft angles, degrees
    flanks  lower and upper, as far as the track has them; none where the file cannot be read
    play    in a groove, or of two rollers about a rib; None with one flank
    units   mm in a unit of the file as it was read
    mesh    of a solid of triangles, mm, as if not mirrored
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
