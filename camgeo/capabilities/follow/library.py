"""The motion of a contour from a program, as `camgeo follow` finds it from a terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from camgeo.capabilities.follow.follower import FollowerAsked
from camgeo.capabilities.follow.outline import contour_of
from camgeo.common.arguments import is_a, number_of, path_of, spelled, text_of, whole_of
from camgeo.common.errors import CallError, with_packages
from camgeo.common.units import UNIT_MM
from camgeo.schema.fields import MOST
from kin.follower.measured import measured
from kin.follower.motion_error import ContactError
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from camgeo.api.report import Report
    from camgeo.common.units import Units
    from kin.follower.measured import MeasuredMotion
    from kin.numeric.arrays import Array

READING = 0.01  # mm, to which a dwell rests and a recipe's motion keeps to the rows, where nothing is said
STEPS = 720
MOST_STEPS = 100_000
LENGTHS = 2  # numbers of a place, and at most of an arm


@dataclass(frozen=True)
class Rest:
    """A dwell: shaft angles from `begin` to `end`, rad, end > begin; its level and how flat it is, mm or rad."""

    begin: float
    end: float
    level: float
    flatness: float


@dataclass(frozen=True, eq=False)
class Followed:
    """The motion that a contour gives a follower, over n equal steps of the shaft; lengths in mm, angles in radians.

    `unit` is that of the motion: mm on a line of travel, rad on an arm. `position` (n,) is the distance of the touch
    along the line of travel from the foot of the shaft, or the angle at the pivot between the line to the shaft and the
    arm; `velocity` and `acceleration` (n,) are by radian of the shaft. `pressure_angle` (n,) is above 0 where the cam
    drives a rise, `radius` (n,) the contour's radius of curvature where it is touched, negative in a hollow, 0 at a
    corner. `bore` is the diameter of a round hole about the shaft, None without one.
    """

    path: Path
    follower: FollowerAsked
    rotation: Literal["cw", "ccw"]
    at: tuple[float, float]
    units: float | None
    reading: float
    bore: float | None
    _motion: MeasuredMotion = field(repr=False)

    @property
    def unit(self) -> Literal["mm", "rad"]:
        """Unit of the motion."""
        return "mm" if self._motion.unit == "mm" else "rad"

    @property
    def theta(self) -> Array:
        """Shaft angles (n,)."""
        return self._motion.phi

    @property
    def position(self) -> Array:
        """Position of the follower (n,)."""
        position: Array = self._motion.rows[0]
        return position

    @property
    def velocity(self) -> Array:
        """First derivative of the position by the shaft angle (n,)."""
        velocity: Array = self._motion.rows[1]
        return velocity

    @property
    def acceleration(self) -> Array:
        """Second derivative of the position by the shaft angle (n,)."""
        acceleration: Array = self._motion.rows[2]
        return acceleration

    @property
    def pressure_angle(self) -> Array:
        """Pressure angle (n,)."""
        return self._motion.pressure

    @property
    def radius(self) -> Array:
        """Radius of curvature of the contour where it is touched (n,)."""
        return self._motion.radius

    @property
    def breadth(self) -> tuple[float, float] | None:
        """Least and greatest distance between two opposite contacts; None of one contact."""
        return self._motion.breadth

    @property
    def least(self) -> tuple[float, float]:
        """Least position, and its shaft angle."""
        return self._motion.least

    @property
    def greatest(self) -> tuple[float, float]:
        """Greatest position, and its shaft angle."""
        return self._motion.most

    @property
    def lift(self) -> float:
        """Greatest position less the least."""
        return self._motion.lift

    @property
    def base_radius(self) -> float:
        """Radius of the circle about the shaft on which the follower would stand as low as it does anywhere, mm."""
        return self.follower.base_radius(self._motion.least[0])

    @property
    def rests(self) -> tuple[Rest, ...]:
        """Dwells: at least 10 degrees that rest within the reading of their level."""
        return tuple(Rest(*dwell) for dwell in self._motion.dwells(self._reading))

    @property
    def _reading(self) -> float:
        """The reading as one of the motion: mm, or on an arm the angle that it is at the touch."""
        if self.unit == "mm":
            return self.reading
        return self.reading / (self.follower.length or self.follower.pivot or 1.0)

    def table(self) -> str:
        """Everything over the turn as CSV: a header, then a row a step; angles in degrees."""
        arm = self.unit == "rad"
        scale, unit = (math.degrees(1.0), "deg") if arm else (1.0, "mm")
        names = ["shaft_deg", f"position_{unit}", f"velocity_{unit}_per_rad", f"acceleration_{unit}_per_rad2"]
        names += ["pressure_angle_deg", "radius_of_curvature_mm"]
        finite = np.where(np.isfinite(self.radius), self.radius, np.nan)
        columns = [np.degrees(self.theta), *(scale * self._motion.rows), np.degrees(self.pressure_angle), finite]
        rows = np.column_stack(columns) + 0.0
        lines = [",".join("" if math.isnan(value) else f"{value:.12g}" for value in row) for row in rows.tolist()]
        return "\n".join([",".join(names), *lines, ""])

    def lifts(self) -> str:
        """The motion as a table of lifts that a recipe reads: shaft angle in degrees, lift in mm or degrees."""
        scale = 1.0 if self.unit == "mm" else math.degrees(1.0)
        lift = scale * (self.position - self._motion.least[0])
        pairs = zip(np.degrees(self.theta).tolist(), lift.tolist(), strict=True)
        return "".join(["angle,lift\n", *(f"{angle:.12g},{value:.9f}\n" for angle, value in pairs)])

    def recipe(self, table: str) -> str:
        """The recipe of a disc cam with this motion, whose lifts are in the file `table`; raises CallError for a yoke.

        Its motion keeps to the rows within the reading, and so does its contour to that of the file, about.
        """
        is_a("table", table, str, "a str")
        if self.follower.yoke:
            raise CallError("a recipe is made of one contact: leave yoke out")
        if not table.isprintable() or not table:
            raise CallError(f"table is the name of a file of lifts, not {spelled(table)}")
        reading = self.reading if self.unit == "mm" else math.degrees(self._reading)
        bore = "" if self.bore is None else f"part: {{bore: {self.bore:.9g}}}\n"
        about = f"The motion of {self.path.name} as a {self.follower.words} has it, within {self.reading:.6g} mm"
        return (
            f"about: {_quoted(about)}\n"
            f"rotation: {self.rotation}\n"
            "cam:\n"
            "  kind: disc\n"
            f"  base_radius: {self.base_radius:.9g}\n"
            f"  follower: {self.follower.keys}\n"
            f"  motion: {{table: {_quoted(table)}, angle: cam, reading: {reading:.6g}}}\n"
            f"{bore}"
            "export:\n"
            f"  tolerance: {self.reading:.6g}\n"
            "  files: [dxf, csv, html]\n"
        )


def _quoted(text: str) -> str:
    """A text as a double-quoted scalar of YAML."""
    import json

    return json.dumps(text, ensure_ascii=False)


@with_packages()
def follow(
    file: str | PathLike[str],
    *,
    roller: float | None = None,
    flat: bool = False,
    offset: float = 0.0,
    arm: tuple[float, ...] | float | None = None,
    leading: bool = False,
    yoke: bool = False,
    units: Units | None = None,
    at: tuple[float, float] = (0.0, 0.0),
    rotation: Literal["cw", "ccw"] = "cw",
    reading: float = READING,
    steps: int = STEPS,
) -> Followed:
    """Let a follower run on the contour of a drawing or a solid, and give the motion that it makes; lengths in mm.

    The follower has a `roller` of a radius, 0 for a knife edge, or is `flat`. It is led on a line of travel that passes
    the shaft at `offset`, or on an `arm`: the distance of its pivot from the shaft, and with a roller the length. The
    arm trails, or is `leading`. A `yoke` has a second contact opposite. The shaft stands `at` a place of the file and
    turns by `rotation` under a follower that stands along x at shaft angle 0. `units` is that of a file that states
    none. A dwell rests within `reading` of its level.

    Raises CallError for what cannot be read or does not go together, and where the follower does not meet the contour.
    """
    path = path_of("file", file)
    for name, value in (("flat", flat), ("leading", leading), ("yoke", yoke)):
        is_a(name, value, bool, "a bool")
    radius = None if roller is None else number_of("roller", roller)
    if (radius is None) is not flat:
        raise CallError("a follower has a roller, of radius 0 for a knife edge, or is flat: give one of both")
    lengths = _numbers("arm", () if arm is None else arm if isinstance(arm, tuple) else (arm,))
    pivot, length = (*lengths, None, None)[:LENGTHS]
    if len(lengths) > LENGTHS:
        raise CallError("arm is the distance of its pivot from the shaft, and the length of an arm with a roller")
    asked = FollowerAsked(radius, number_of("offset", offset), pivot, length, leading=leading, yoke=yoke)
    asked.demand_sound()
    if units is not None:
        text_of("units", units, tuple(UNIT_MM), "a unit")
    text_of("rotation", rotation, ("cw", "ccw"), "a rotation")
    place = _numbers("at", at)
    if len(place) != LENGTHS or not all(math.isfinite(value) and abs(value) <= MOST for value in place):
        raise CallError("at is the place of the shaft in the file: two lengths in mm, x and y")
    within, count = number_of("reading", reading), whole_of("steps", steps)
    if not 0.0 < within <= MOST:
        raise CallError(f"a reading is a length above 0, not {spelled(reading)}")
    if not 36 <= count <= MOST_STEPS:
        raise CallError(f"a turn is looked at in 36 to {MOST_STEPS} steps, not {spelled(steps)}")
    unit = None if units is None else UNIT_MM[units]
    contour, bore = contour_of(path, unit, (place[0], place[1]), mirrored=rotation == "ccw")
    try:
        motion = measured(contour, asked.contacts, count)
    except ContactError as error:
        raise CallError(f"{path}: {error}") from error
    return Followed(path, asked, rotation, (place[0], place[1]), unit, within, bore, motion)


def _numbers(name: str, values: object) -> tuple[float, ...]:
    is_a(name, values, tuple, "a tuple of numbers")
    return tuple(number_of(name, value) for value in values) if isinstance(values, tuple) else ()


def shown(followed: Followed) -> Report:
    """Judge the file by the recipe of its motion, with a page; raises RecipeErrors where there is no such cam."""
    import tempfile
    from pathlib import Path

    from camgeo.api.loading import load
    from camgeo.api.run import verify

    if followed.at != (0.0, 0.0):
        raise CallError("a page shows a contour about the origin of its file: leave at out")
    with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
        (Path(folder) / "lift.csv").write_text(followed.lifts(), encoding="utf-8")
        recipe = Path(folder) / f"{followed.path.stem}.yaml"
        recipe.write_text(followed.recipe("lift.csv"), encoding="utf-8")
        units = next((name for name, mm in UNIT_MM.items() if mm == followed.units), None)
        return verify(load(recipe), followed.path, units=units, tolerance=2.0 * followed.reading, page=True)
