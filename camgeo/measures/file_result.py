"""What is known of a file once it is written and judged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from camgeo.recipe.export import NO_PART

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.fit.pieces import Bound
    from camgeo.recipe.export import FileRequest
    from kin.contour.contour import Contour
    from kin.follower.frame import LinkageVerdict
    from kin.follower.motion_error import MotionError


@dataclass(frozen=True)
class FileResult:
    """One written file: what was asked, what was proved of it and what the judge measured (mm, degrees).

    `body` is the one that it is judged as. `perimeter` and `area` (mm, mm^2) are those of its contour as read,
    `units` (mm) is the unit of its numbers, None where there are none or nothing was read; `contour` is that contour,
    in mm and as if not mirrored.
    """

    path: Path
    request: FileRequest
    tolerance: float | None
    pieces: int | None
    bound: Bound | None
    measured_error: float | None
    motion: MotionError | None
    linkage: LinkageVerdict | None = None
    body: str = "cam"
    perimeter: float | None = None
    area: float | None = None
    units: float | None = None
    contour: Contour | None = None

    @property
    def shows_cam(self) -> bool:
        """Whether the file has the nominal cam's contour, and not another body's or none."""
        return self.body == "cam" and self.request.kind not in NO_PART and self.request.compensation is None
