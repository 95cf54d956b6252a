"""Results for a file: checks, and for each surface the figures measured and the contour read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.follower.frame import LinkageVerdict
    from kin.follower.motion_error import MotionError, Play
    from kin.numeric.check import Check


@dataclass(frozen=True)
class SurfaceVerdict:
    """Results for one surface of a part; all but the name is None where nothing could be read.

    name            as the intent has it
    contour         as read, in mm and as if not mirrored
    motion, play    as the contour gives them by contact; None without contact, play also for one-sided followers
    measured_error  two-sided distance from the exact contour, mm
    pieces          of the contour, as the file counts them
    linkage         motion of the mechanism; None without one, or where the contour does not drive it all round
    """

    name: str = ""
    contour: Contour | None = None
    motion: MotionError | None = None
    play: Play | None = None
    measured_error: float | None = None
    pieces: int | None = None
    linkage: LinkageVerdict | None = None

    @property
    def perimeter(self) -> float | None:
        """Length of the contour, mm."""
        return None if self.contour is None else self.contour.length

    @property
    def area(self) -> float | None:
        """Area that the contour encloses, mm^2."""
        return None if self.contour is None else abs(self.contour.area)


UNREAD = SurfaceVerdict()


@dataclass(frozen=True)
class ClosureVerdict:
    """Play of a follower between the surface named `pushes`, which drives it out, and `stops`, which holds it back.

    `gauges` is the play of the followers that judge the surfaces, each its gauge, which should fit without any; `play`
    is that of the follower itself, which may have a clearance or an interference besides. Both are in mm or degrees.
    """

    pushes: str
    stops: str
    gauges: Play
    play: Play


class OfSurfaces:
    """Results of the first surface, under names of their own: most cams have one surface."""

    surfaces: tuple[SurfaceVerdict, ...]

    @property
    def surface(self) -> SurfaceVerdict:
        """Verdict on the first surface; an empty one where none was read."""
        return self.surfaces[0] if self.surfaces else UNREAD

    @property
    def contour(self) -> Contour | None:
        """Contour as read, mm, turned back if the file mirrors it; None where none was read."""
        return self.surface.contour

    @property
    def motion(self) -> MotionError | None:
        """Motion error of the follower on the first surface; None without contact."""
        return self.surface.motion

    @property
    def play(self) -> Play | None:
        """Play of a follower that two contacts hold on the first surface, below 0 where it interferes; else None."""
        return self.surface.play

    @property
    def measured_error(self) -> float | None:
        """Two-sided distance of the first surface from its exact contour, mm; None where that was not measured."""
        return self.surface.measured_error

    @property
    def linkage(self) -> LinkageVerdict | None:
        """Motion of the mechanism that the first surface drives; None without a mechanism."""
        return self.surface.linkage

    @property
    def perimeter(self) -> float | None:
        """Length of the first surface's contour, mm."""
        return self.surface.perimeter

    @property
    def area(self) -> float | None:
        """Area that the first surface's contour encloses, mm^2."""
        return self.surface.area


@dataclass(frozen=True)
class Verdict(OfSurfaces):
    """Results for a file.

    kind      name of the file's format: dxf, svg, step, gcode, csv, ...
    checks    units, closed, contour, motion, bore, ... ; or a single one that says why the file cannot be read
    surfaces  results for each surface, in the intent's order; none where the file cannot be read
    closures  play between pairs of surfaces
    units     mm in a unit of the file as it was read: stated by the file, or else given or intended; None where no
              contour was read
    bodies    of each disc in the file every closed contour of the drawing, section or program that holds its first
              surface, outermost first
    uneven    bound of the contours' own error, mm: a solid's other sections that differ by rounding, a drawing's gaps
              that were joined, the arcs for a grinder's table
    passed    what was left out of a drawing as no part of the cam, in words
    """

    kind: str
    checks: tuple[Check, ...]
    surfaces: tuple[SurfaceVerdict, ...] = ()
    closures: tuple[ClosureVerdict, ...] = ()
    units: float | None = None
    bodies: tuple[tuple[Contour, ...], ...] = ()
    uneven: float = 0.0
    passed: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return all(check.ok for check in self.checks)

    @property
    def pieces(self) -> int | None:
        """Number of pieces of all surfaces together, as the file counts them; None where the file cannot be read."""
        return sum(surface.pieces or 0 for surface in self.surfaces) or None
