"""Results for a file of a turning body whose flanks lead rollers, and the check of a flank's surface."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

from kin.numeric.check import Check, at_most
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.records import dataclass
from kin.read.verdict import FileVerdict

if TYPE_CHECKING:
    from kin.law.motion_error import MotionError, Play
    from kin.numeric.arrays import Array
    from kin.read.mesh.mesh import Mesh

CONTOUR, MOTION, PLAY, ENDS = "contour", "motion", "form-closure", "ends"
OPEN = 0.25  # of the tolerance: what a proof may leave open


@dataclass(frozen=True, eq=False)
class FlankVerdict:
    """Results for one flank, or for one line of a development.

    name            "lower" or "upper", or the line's layer
    motion          of what the flank leads; of an upper flank that of its gauge, larger by the clearance
    measured_error  greatest distance of the file's surface from the exact flank, mm
    pieces          triangles or polynomial patches of the file on this flank; None of a line, and of a program
    free            stretches of the shaft angle, degrees, in which a crossing leaves the flank nothing that carries:
                    the motion is judged beside them; the last may go on over the end of the period
    """

    name: str
    motion: MotionError | None = None
    measured_error: float | None = None
    pieces: int | None = None
    free: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True, eq=False)
class TurnedVerdict(FileVerdict):
    """Results for a file; places of checks are shaft angles, degrees.

    checks  of a solid: watertight, blank, floor, ends, bore, contour and motion (one for each flank), form-closure,
            volume, crossings, shoe; of a development: units, contour and motion (one for each line); of a program:
            cutter, rapid, ways, feed, depth, cleared, contour and motion (one for each flank), form-closure
    flanks  lower and upper, as far as there are both; none where the file cannot be read
    play    of what runs between two flanks, or about a rib; None with one flank
    units   mm in a unit of the file as it was read
    mesh    of a solid of triangles, mm, as the file has it
    lines   of a development: points (n, 2), mm, of each line, by its layer, as if not mirrored
    """

    flanks: tuple[FlankVerdict, ...] = ()
    play: Play | None = None
    units: float | None = None
    mesh: Mesh | None = None
    lines: tuple[tuple[str, Array], ...] = ()


class Peak(Protocol):
    """Protocol of a greatest distance."""

    @property
    def value(self) -> float:
        """The greatest one that was found, mm."""
        ...

    @property
    def remainder(self) -> float:
        """By how much the true one may lie above it, mm."""
        ...


def assured(value: float, remainder: float, tolerance: float) -> float:
    """A value found, or its bound where the proof leaves more open than a share of the tolerance, all in one unit.

    A value above the tolerance is enough by itself.
    """
    return value if value > tolerance or remainder <= OPEN * tolerance else value + remainder


def surface_check(proud: Peak, bare: Peak, tolerance: float, slack: float) -> tuple[Check, float]:
    """Check, without a place, of the distance of a flank's surface, out of the metal and into it; the greater one."""
    worst = max(assured(peak.value, peak.remainder, tolerance) for peak in (proud, bare))
    words = " and ".join(
        f"{length_words(max(peak.value, 0.0), '.3g')} {UNIT} {way}" for peak, way in ((proud, "proud"), (bare, "bare"))
    )
    left = max(proud.remainder, bare.remainder)
    told = (
        f"true within {length_words(left, '.2g')} {UNIT}" if math.isfinite(left) else "other places were not measured"
    )
    detail = f"{words} of the exact flank; {told}"
    return at_most(CONTOUR, worst, tolerance, "mm", detail=detail, slack=slack), worst
