"""Results for a file of a linear cam."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.law.contacts import Unit
    from kin.numeric.check import Check


@dataclass(frozen=True)
class MotionError:
    """Error of the position, measured less intended, over all inputs: mm or degrees.

    max        greatest magnitude found, at the input `at`, mm; no error exceeds it by more than `remainder` (proved)
    least, most  the greatest error downwards (below 0) and upwards
    rms        over equal steps of the input
    """

    max: float
    at: float
    remainder: float
    least: float
    most: float
    rms: float
    unit: Unit

    def less_sure(self, by: float) -> MotionError:
        """Error of a contour that may itself be off, by which a position changes by no more than `by`, in its unit."""
        if not by:
            return self
        return replace(self, max=self.max + by, least=self.least - by, most=self.most + by, rms=self.rms + by)

    @property
    def bound(self) -> float:
        """Greatest error with what the proof leaves open."""
        return self.max + self.remainder


@dataclass(frozen=True)
class Play:
    """Least and greatest free travel of the follower in a groove, plate at rest, mm or degrees, at inputs, mm."""

    least: float
    least_at: float
    most: float
    most_at: float
    unit: Unit


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
class PlateVerdict:
    """Results for a file.

    kind    name of the file's format: dxf, svg, stl, ply, 3mf, step
    checks  units, closed, contour, motion, ends, form-closure, holes, thickness ...; or a single one that says why the
            file cannot be read. Places are inputs: `at` in mm, `at_unit` "mm"
    flanks  one, or lower and upper of a groove; none where the file cannot be read
    play    in a groove; else None
    units   mm in a unit of the file as it was read
    bodies  every closed chain of the drawing or section, outermost first, mm, as if not mirrored
    """

    kind: str
    checks: tuple[Check, ...]
    flanks: tuple[FlankVerdict, ...] = ()
    play: Play | None = None
    units: float | None = None
    bodies: tuple[Contour, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return all(check.ok for check in self.checks)
