"""Options of `camgeo verify` for files of points, and which files these are."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from camgeo.capabilities.made.keys import ALIGN
from camgeo.common.arguments import short_repr
from camgeo.common.errors import CallError
from camgeo.schema.quantity import read_quantity
from camgeo.schema.scalars import Complaint
from kin.follower.recognised import COVERAGE
from kin.numeric.records import dataclass
from kin.read.drive_tables import is_drive
from kin.read.formats import FORMATS
from kin.read.point_list import is_point_list
from kin.read.points import heading_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe
    from kin.made.motion import Influence

GRINDER = "c_deg"  # heading of the column of the work's angle in a grinder's table
MOST_LENGTH = 1e3  # mm, of a probe and its errors


def claims(path: Path, options: Mapping[str, object]) -> bool:
    """Whether a file holds measured points; raises OSError for a file that cannot be read.

    The option `as` decides. Without it a file holds them if it is neither a list of points of a curve nor rows for a
    drive or a grinder.
    """
    if "as" in options:
        return options["as"] == "measured"
    if is_point_list(path) or is_drive(path):  # of a curve, which is judged as a contour, or of a motion
        return False
    if path.suffix.lower() not in FORMATS["csv"].suffixes:
        return True
    heading = [cell.strip().strip('"').lower() for cell in heading_of(path)]
    return GRINDER not in heading


@dataclass(frozen=True)
class Probing:
    """Way in which points were measured.

    align   unknowns of a placing by least squares before the motion is judged: letters of g (turn), x, y (shifts)
    ball    radius of the probe, mm; None for points of the metal, and for lifts of the follower itself
    face    width of the flat face of an indicator of lifts, mm; None without one
    units   mm in a unit of files whose headings state none; None for the recipe's unit
    turned  known turn, rad, of a cam on a shaft against the others; None for a part of its own
    """

    align: str = ""
    ball: float | None = None
    face: float | None = None
    units: float | None = None
    turned: float | None = None


@dataclass(frozen=True)
class PointOptions:
    """Options of a call on files of points, mm and radians; None for an option that is not given.

    probing      how the points were measured
    error        expanded uncertainty (k = 2) of a point along its normal
    axes         expanded uncertainty of the part's axes: shift, mm, and turn, rad
    spans        number of spans of the smoothed deviation
    out          folder for a page, a drawing and a table
    """

    probing: Probing = Probing()
    error: float | None = None
    axes: tuple[float, float] | None = None
    spans: int | None = None
    out: str | None = None

    @property
    def axes_shift(self) -> float:
        """Expanded uncertainty of the place of the part's axes, mm; 0 where none is given."""
        return 0.0 if self.axes is None else self.axes[0]

    @property
    def axes_turn(self) -> float:
        """Expanded uncertainty of the turn of the part's axes, rad; 0 where none is given."""
        return 0.0 if self.axes is None else self.axes[1]

    @property
    def systematic(self) -> float:
        """Expanded uncertainty of the probe and of the axes' shift together, mm, which does not average out."""
        return math.hypot(self.error or 0.0, self.axes_shift)

    def expanded(self, influence: Influence) -> float:
        """Expanded uncertainty (k = 2) of a figure: root sum of squares of noise, probe and shift of the axes.

        The probe's error counts with its sign the worst at every place. The result is in the unit of the figure.
        """
        shifted = math.hypot(*influence.shifted.tolist())
        return math.hypot(COVERAGE * influence.sd, influence.worst * (self.error or 0.0), shifted * self.axes_shift)


def read_options(options: Mapping[str, object], recipe: Recipe, units: float | None = None) -> PointOptions:
    """Read the options of a call by their names; `units` is mm in the unit of files that state none.

    Lengths without a unit are in the recipe's. Raises CallError with a line for each option of a wrong value.
    """
    faults: list[str] = []

    def length(name: str) -> float | None:
        if name not in options:
            return None
        try:
            number = read_quantity(str(options[name]), recipe.units) * recipe.mm
        except Complaint:
            number = math.nan
        if 0.0 <= number <= MOST_LENGTH:
            return number
        problem = f"a length such as 0.002 or 0.0001in is expected, not {short_repr(options[name])}"
        faults.append(f"--{name.replace('_', '-')}: {problem}")
        return None

    align = str(options.get("align", "none"))
    if align not in ALIGN:
        faults.append(f"--align: one of {', '.join(ALIGN)}, not {short_repr(align)}")
    ball, face = length("probe_radius"), length("probe_face")
    if face is not None and ball is not None:
        faults.append("--probe-face: a probe has a face or a radius: leave one of them out")
    error = length("probe_error")
    axes = _read_axes(options["axes_error"], recipe, faults) if "axes_error" in options else None
    spans = None
    if "spans" in options:
        text = str(options["spans"])
        if re.fullmatch(r"[0-9]{1,6}", text):
            spans = int(text)
        else:
            faults.append(f"--spans: a whole number from 12 is expected, not {short_repr(text)}")
    out = options.get("out")
    if out is not None and not str(out):
        faults.append("--out: an empty name")
    if faults:
        raise CallError(*faults)
    return PointOptions(Probing(ALIGN[align], ball, face, units), error, axes, spans, None if out is None else str(out))


def _read_axes(value: object, recipe: Recipe, faults: list[str]) -> tuple[float, float] | None:
    """Shift, mm, and turn, rad, of an option `L,DEG`; None, and one more of `faults`, for another value."""
    cells = [str(cell) for cell in value] if isinstance(value, (tuple, list)) else str(value).split(",")
    try:
        shift = read_quantity(cells[0], recipe.units) * recipe.mm
        (turn,) = [float(cell) for cell in cells[1:]]
    except (Complaint, ValueError):
        shift = turn = math.nan
    if 0.0 <= shift <= MOST_LENGTH and 0.0 <= turn <= 180.0:
        return shift, math.radians(turn)
    faults.append(f"--axes-error: a length and an angle in degrees, such as 0.005,0.02, not {short_repr(value)}")
    return None
