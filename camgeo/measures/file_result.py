"""The result of a file that was written and judged."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.judge.verdict import OfSurfaces
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.fit.pieces import Bound
    from camgeo.recipe.export import FileRequest
    from kin.contour.contour import Contour
    from kin.judge.verdict import ClosureVerdict, SurfaceVerdict, Verdict


@dataclass(frozen=True)
class FileResult(OfSurfaces):
    """A written file: its request, what was proved of its contour, and what the judge measured, in mm and degrees.

    tolerance, pieces, bound  of the fit: mm, number of pieces, proved bound; None where there is none
    body      name of the body that the file shows
    units     length of the file's unit, mm; None where its numbers have no unit or nothing was read
    surfaces, closures, bodies, uneven, passed  of the judge's verdict, `bodies` with every closed contour as read;
              empty, or 0, for a file that is not judged as the cam
    disc      number of the disc that the file holds, from 0; None for all discs
    """

    path: Path
    request: FileRequest
    tolerance: float | None = None
    pieces: int | None = None
    bound: Bound | None = None
    body: str = "cam"
    units: float | None = None
    surfaces: tuple[SurfaceVerdict, ...] = ()
    closures: tuple[ClosureVerdict, ...] = ()
    bodies: tuple[tuple[Contour, ...], ...] = ()
    disc: int | None = None
    uneven: float = 0.0
    passed: tuple[str, ...] = ()

    @staticmethod
    def of(
        path: Path, request: FileRequest, tolerance: float, verdict: Verdict, fit: tuple[int, Bound] | None = None
    ) -> FileResult:
        """Result of a judged file of the cam from its verdict; `fit` is number of pieces and proved bound of the fit.

        `tolerance` is the file's, mm. Without `fit` the number of pieces is as read, and there is no bound.
        """
        pieces, bound = (verdict.pieces, None) if fit is None else fit
        read = verdict.surfaces, verdict.closures, verdict.bodies
        units, uneven, passed = verdict.units, verdict.uneven, verdict.passed
        return FileResult(path, request, tolerance, pieces, bound, "cam", units, *read, uneven=uneven, passed=passed)

    @property
    def shows_cam(self) -> bool:
        """Whether the file has the cam's contour, uncompensated for a process, and not another body's or none."""
        return self.body == "cam" and self.request.format.part and self.request.compensation is None
