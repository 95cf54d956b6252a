"""Results for a file of a linear cam."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass
from kin.read.verdict import FileVerdict

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.law.motion_error import MotionError, Play


@dataclass(frozen=True, eq=False)
class FlankVerdict:
    """Results for one flank; all but the name is None where nothing could be read.

    name            "" of a plate's edge; "lower" and "upper" of a groove
    contour         closed chain that holds the flank, mm, as if not mirrored
    motion          of the follower on it; of an upper flank that of its gauge, larger by the clearance, from below
    measured_error  two-sided distance from the exact outline or flank, mm
    pieces          of the chain, as the file counts them
    reach           by how far, mm along x, metal reaches beyond the contacts at the first and the last input
    """

    name: str = ""
    contour: Contour | None = None
    motion: MotionError | None = None
    measured_error: float | None = None
    pieces: int | None = None
    reach: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class PlateVerdict(FileVerdict):
    """Results for a file; places of checks are inputs: `at` in mm, `at_unit` "mm".

    checks  units, closed, contour, motion, ends, form-closure, holes, thickness ...
    flanks  one, or lower and upper of a groove; none where the file cannot be read
    play    in a groove; else None
    units   mm in a unit of the file as it was read
    bodies  every closed chain of the drawing or section, outermost first, mm, as if not mirrored
    """

    flanks: tuple[FlankVerdict, ...] = ()
    play: Play | None = None
    units: float | None = None
    bodies: tuple[Contour, ...] = ()
