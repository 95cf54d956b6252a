"""The motion that a contour gives a follower, for programs and for the command `camgeo follow`."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from camgeo.capabilities.follow.follower import TRACKS, describe_follower
from camgeo.capabilities.follow.laws import Laws, laws_of
from camgeo.capabilities.follow.outline import Reading, read_outline
from camgeo.common.arguments import demand_type, number_of, path_of, short_repr, text_of, whole_of
from camgeo.common.errors import CallError, with_packages
from camgeo.common.rounding import upward
from camgeo.common.terminal import escaped
from camgeo.common.units import UNIT_MM
from camgeo.motions.recognised import in_flow
from camgeo.schema.fields import MOST
from kin.contour.pieces import LINE
from kin.follower.measured import measured
from kin.follower.motion_error import ContactError
from kin.follower.unknown import across_words, stretches, unknown_angles
from kin.numeric.records import dataclass, field, replace
from kin.read.points import SUFFIXES

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from camgeo.api.report import Report
    from camgeo.capabilities.follow.follower import FollowerDescription, Track
    from camgeo.capabilities.follow.outline import Outline
    from camgeo.common.units import Units
    from kin.follower.measured import MeasuredMotion
    from kin.numeric.arrays import Array, Mask

READING = 0.01  # mm: default tolerance of dwells about their level, and of a recipe's motion about the rows
STEPS = 720  # of a turn by default
LEAST_STEPS, MOST_STEPS = 36, 100_000
MOST_TURN = 360
LENGTHS = 2  # coordinates of a place
# A contour is a polygon drawn for a curve where so many lines meet by turns below this angle, rad; it stands off the
# curve as far as this share of them do at most.
LEAST_FACETS, FACET_TURN, MOST_FACETS = 12, math.radians(15.0), 0.95
OPENINGS = "verify: {openings: ignore}  # those of the file are not made: name in part what is wanted of them"


@dataclass(frozen=True)
class Rest:
    """A dwell: shaft angles from `begin` to `end`, rad, end > begin, with its level and flatness, mm or rad.

    The level is the median of its positions, the flatness the greatest less the least of them.
    """

    begin: float
    end: float
    level: float
    flatness: float


@dataclass(frozen=True, eq=False)
class Followed:
    """The motion that a contour gives a follower, over n equal steps of the shaft; lengths in mm, angles in radians.

    `at` is the place of the shaft in the file; `units` is mm in the unit that the call gave, or None; `reading` is the
    tolerance of dwells and of a recipe, mm. `unit` is that of the motion: mm on a line of travel, rad on an arm.
    `position` (n,) is the distance of the touch along the line of travel from its point nearest to the shaft, or the
    angle at the pivot between the line to the shaft and the arm; `velocity` and `acceleration` (n,) are by radian of
    the shaft. `pressure_angle` (n,) is above 0 where the cam drives a rise, `radius` (n,) the contour's radius of
    curvature at the contact, negative in a hollow, 0 at a corner. Of a polygon, which has `facets`, `acceleration` and
    `radius` are those of its corners: tables and figures leave them out. `bore` is the diameter of a round hole about
    the shaft, `blank` that of a round outline of a ring or of a groove's blank; None without one.
    """

    path: Path
    follower: FollowerDescription
    rotation: Literal["cw", "ccw"]
    at: tuple[float, float]
    units: float | None
    reading: float
    _asked: Reading = field(repr=False)
    _outline: Outline = field(repr=False)
    _motion: MeasuredMotion = field(repr=False)

    @property
    def unit(self) -> Literal["mm", "rad"]:
        """Unit of the motion: mm on a line of travel, rad on an arm."""
        return "mm" if self._motion.unit == "mm" else "rad"

    @property
    def bore(self) -> float | None:
        """Diameter of a round hole about the shaft, mm; None without one."""
        return self._outline.bore

    @property
    def blank(self) -> float | None:
        """Diameter, mm, of the round outline of a ring or of a grooved disc; None where there is none."""
        return self._outline.blank

    @property
    def openings(self) -> int:
        """Number of other closed contours in the file, such as a bore with a keyway; the motion disregards them."""
        return self._outline.openings

    @property
    def remarks(self) -> tuple[str, ...]:
        """Sentences on what was done with the file: ends that were joined, and what was left out."""
        bridge = self._outline.bridge
        told = [] if bridge is None else [across_words(bridge, self.unknown)]
        return (*self._outline.remarks, *told)

    @property
    def gap(self) -> float | None:
        """Gap of the call within which ends of a drawing were joined, mm; None where it gave none."""
        return self._asked.gap

    @property
    def unknown(self) -> tuple[tuple[float, float], ...]:
        """Stretches of shaft angles, (begin, end), rad, at which the contact is where `across` closes the contour."""
        return tuple(stretches(self.theta, ~self.known))

    @property
    def unjudged(self) -> str:
        """Why the file cannot be judged as it is by the recipe of this motion, with a remedy; empty where it can."""
        asked = self._asked
        if self.at != (0.0, 0.0):
            return "a page judges a file about its own origin: move the shaft there, or leave page out"
        if self.path.suffix.lower() in SUFFIXES:
            return "a page judges drawings and solids, and these are points: leave page out"
        if asked.mirror is not None or asked.turn:
            return "a page judges a file as it is drawn: leave mirror and turn out, or page"
        if self._outline.bridge is not None:
            return "a page judges a whole contour, and this one is closed across: leave page out"
        return (
            "" if asked.body is None else "a page judges all bodies of a file: save this one alone, or leave page out"
        )

    @cached_property
    def known(self) -> Mask:
        """Whether the contact at each shaft angle is on the contour of the file, not where `across` closes it, (n,).

        Raises CallError where that cannot be told, as across ends that all but meet.
        """
        bridge, follower = self._outline.bridge, self.follower
        if bridge is None:
            return np.ones(len(self.theta), dtype=np.bool_)
        try:
            unknown = [
                unknown_angles(self._outline.contour, bridge, contact, follower.side, self.theta)
                for contact in follower.contacts
            ]
        except ContactError as error:
            apart = upward(math.dist(*bridge), 2)
            remedy = f"give gap {apart} to join its ends, and leave across out"
            raise CallError(f"{escaped(str(self.path))}: the contour is open by {apart} mm: {remedy}") from error
        known: Mask = ~np.any(unknown, axis=0)
        return known

    @property
    def theta(self) -> Array:
        """Shaft angles (n,), rad."""
        return self._motion.phi

    @property
    def position(self) -> Array:
        """Position of the follower (n,), mm or rad."""
        position: Array = self._motion.rows[0]
        return position

    @property
    def velocity(self) -> Array:
        """First derivative of the position by the shaft angle (n,), mm/rad or rad/rad."""
        velocity: Array = self._motion.rows[1]
        return velocity

    @property
    def acceleration(self) -> Array:
        """Second derivative of the position by the shaft angle (n,), mm/rad^2 or rad/rad^2."""
        acceleration: Array = self._motion.rows[2]
        return acceleration

    @property
    def pressure_angle(self) -> Array:
        """Pressure angle (n,), rad, above 0 where the cam drives a rise."""
        return self._motion.pressure

    @property
    def radius(self) -> Array:
        """Radius of curvature of the contour at the contact (n,), mm, negative in a hollow, 0 at a corner."""
        return self._motion.radius

    @property
    def facets(self) -> float | None:
        """How far the edges of a polygon stand off the curve that it is drawn for, mm; None of any other contour."""
        contour = self._outline.contour
        line = contour.kind == LINE
        length = np.linalg.norm(contour.end - contour.start, axis=1)
        turn = np.abs(contour.joints)  # at the start of each piece
        facet = line & np.roll(line, 1) & (turn < FACET_TURN)
        if np.count_nonzero(facet & (turn > 0.0)) < LEAST_FACETS:
            return None
        heights = turn * (length + np.roll(length, 1)) / 16.0
        return float(np.quantile(heights[facet], MOST_FACETS))

    @cached_property
    def smoothed(self) -> Array | None:
        """Acceleration (n,) of the recipe's motion, within the reading and a polygon's facets of the positions.

        mm/rad^2 or rad/rad^2; None where the motion makes no recipe.
        """
        import tempfile
        from pathlib import Path

        from camgeo.recipe.loading import load_text
        from camgeo.synthesis.design import sketched
        from kin.numeric.errors import CamgeoError

        wide = replace(self, reading=max(self.reading, self.facets or 0.0))
        with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
            (Path(folder) / "lift.csv").write_text(wide.lifts(), encoding="utf-8")
            try:
                recipe = load_text(wide.recipe("lift.csv"), Path(folder) / "follow.yaml")
                motion = sketched(recipe).motion
            except CamgeoError:
                return None
        acceleration: Array = motion.rows(self.theta, 2)[2]
        return acceleration

    @property
    def breadth(self) -> tuple[float, float] | None:
        """Least and greatest distance between a yoke's faces, or its rollers' centres, mm; None for one contact."""
        apart = self._motion.apart
        return (-apart[1], -apart[0]) if self.follower.yoke and apart is not None else None

    @property
    def play(self) -> tuple[float, float] | None:
        """Least and greatest play of a roller between the flanks of a groove, mm or rad; None for another track."""
        return None if self.follower.yoke else self._motion.apart

    @property
    def contact_travel(self) -> tuple[float, float] | None:
        """Least and greatest place of contact on a flat face, mm; None for a round touch.

        On a stem they count from its axis, above 0 on the side from which the contour comes, on an arm from the foot of
        the pivot on the face.
        """
        return self._motion.travel

    @property
    def least(self) -> tuple[float, float]:
        """Least position, mm or rad, and its shaft angle, rad."""
        return self._motion.least

    @property
    def greatest(self) -> tuple[float, float]:
        """Greatest position, mm or rad, and its shaft angle, rad."""
        return self._motion.most

    @property
    def lift(self) -> float:
        """Greatest position less the least, mm or rad."""
        return self._motion.lift

    @property
    def base_radius(self) -> float:
        """Radius of the circle about the shaft that the follower would touch at its least position, mm."""
        return self.follower.base_radius(self._motion.least[0])

    @property
    def rests(self) -> tuple[Rest, ...]:
        """Dwells, in order: stretches of at least 10 degrees in which the position keeps within the reading."""
        return tuple(Rest(*dwell) for dwell in self._motion.dwells(self._reading))

    @cached_property
    def laws(self) -> Laws:
        """The motion as segments of a recipe, where laws keep within the reading of it; else why there are none."""
        if self.follower.yoke:
            return Laws(None, why="a yoke has its motion over half a turn, which is kept point by point")
        if self.unknown:
            return Laws(None, why="the contour is closed across a gap, where nothing is known of the motion")
        facets = (self.facets or 0.0) / self.follower.motion_to_mm
        found = laws_of(self._motion, self.follower, self._reading, facets)
        if found.begin is None:
            return found
        turned = math.degrees(self._asked.turn) + (found.begin if self.rotation == "ccw" else -found.begin)
        return found._replace(why=f"{found.why}; give --turn={math.remainder(turned, 360.0):.6g} to begin elsewhere")

    def law_lines(self, table: str) -> list[str]:
        """Lines of text on the motion of a recipe by laws: what they are, or why it has the file `table` of lifts."""
        laws, name = self.laws, escaped(table)
        if laws.rows is None:
            return [f"  the recipe has the motion as the table {name}: {laws.why}"]
        unit = "mm" if self.unit == "mm" else "deg"
        within = f"within {laws.off:.2g} {unit} of the motion"
        return [
            *(f"  {line}" for line in laws.lines),
            f"  the recipe has these laws, {within}, and names the table {name} beside them",
        ]

    @property
    def _reading(self) -> float:
        """The reading in the motion's unit: mm, or on an arm the angle that moves the touch by it, rad."""
        return self.reading if self.unit == "mm" else self.reading / self.follower.motion_to_mm

    def table(self) -> str:
        """Motion over the turn as CSV text: a header, then a row for each step; lengths in mm, angles in degrees.

        The columns are the shaft angle, position, velocity and acceleration by radian of the shaft, pressure angle, and
        radius of curvature, empty on a straight line; then the breadth of a yoke, or the play in a groove. Of a polygon
        the acceleration is that of the smoothed motion, under that name, and there is no radius.
        """
        arm, polygon = self.unit == "rad", self.facets is not None
        scale, unit = (math.degrees(1.0), "deg") if arm else (1.0, "mm")
        none = np.full(len(self.theta), np.nan)
        finite = none if polygon else np.where(np.isfinite(self.radius), self.radius, np.nan)
        smoothed = self.smoothed if polygon else self.acceleration
        acceleration = none if smoothed is None else smoothed
        columns = {
            "shaft_deg": np.degrees(self.theta),
            f"position_{unit}": scale * self.position,
            f"velocity_{unit}_per_rad": scale * self.velocity,
            f"{'smoothed_' if polygon else ''}acceleration_{unit}_per_rad2": scale * acceleration,
            "pressure_angle_deg": np.degrees(self.pressure_angle),
            "radius_of_curvature_mm": finite,
        }
        second = self._motion.second
        if second is not None:
            name, factor = ("breadth_mm", -1.0) if self.follower.yoke else (f"play_{unit}", scale)
            columns[name] = factor * (second - self.position)
        rows = np.column_stack(list(columns.values())) + 0.0
        lines = [",".join("" if math.isnan(value) else f"{value:.12g}" for value in row) for row in rows.tolist()]
        return "\n".join([",".join(columns), *lines, ""])

    def lifts(self) -> str:
        """Motion as CSV text of lifts that a recipe reads: shaft angle in degrees, lift in mm or degrees.

        Lifts count from the least position. The table of a yoke covers half a turn, and its lifts count from the
        position at 0; a deviation of the breadth from its mean is shared by both faces.
        """
        scale = 1.0 if self.unit == "mm" else math.degrees(1.0)
        theta, lift = self.theta, scale * (self.position - self._motion.least[0])
        if self.breadth is not None and self._motion.second is not None:
            half = len(theta) // 2 + 1
            middle = 0.5 * (self.position + self._motion.second)[:half]
            theta, lift = theta[:half], middle - middle[0]
        pairs = zip(np.degrees(theta).tolist(), (np.round(lift, 9) + 0.0).tolist(), strict=True)
        return "".join(["angle,lift\n", *(f"{angle:.12g},{value:.9f}\n" for angle, value in pairs)])

    def recipe(self, table: str, *, laws: bool = False) -> str:
        """Text of a recipe of a cam with this motion, whose lifts are in the file `table`.

        Its motion is within the reading of the rows. With `laws` it is that of `Followed.laws`, where there are some,
        and the table stands in a comment. Its tolerance is twice the reading, so that the file passes when it is judged
        by the recipe. It has no opening but a round bore, and passes over others when files are judged by it. Raises
        TypeError for a `table` that is no str, CallError for one that is no printable name, for a yoke whose breadth
        varies by more than two readings or whose steps are odd in number, and for a ring without a round outline.
        """
        demand_type("table", table, str, "a str")
        if not table.isprintable() or not table:
            raise CallError(f"table is the name of a file of lifts, not {short_repr(table)}")
        reading = self.reading if self.unit == "mm" else math.degrees(self._reading)
        about = f"The motion of {escaped(self.path.name)} under a {self.follower.words}, within {self.reading:.6g} mm"
        cam = self._yoke_keys() if self.follower.yoke else self._disc_keys()
        motion = [f"  motion: {{table: {_quoted(table)}, angle: cam, reading: {reading:.6g}}}"]
        if laws and self.laws.rows is not None:
            cam["base_radius"] = f"{self.laws.base:.9g}"
            # lifts of the table count from the least position
            beside = f"  # as it was followed: base_radius: {self.base_radius:.9g}, {motion[0].strip()}"
            motion = ["  motion:", *(f"    - {in_flow(row)}" for row in self.laws.rows), beside]
        part = {"bore": self.bore, "outer": self.blank if self.follower.track != "external" else None}
        keys = ", ".join(f"{key}: {value:.9g}" for key, value in part.items() if value is not None)
        lines = [
            f"about: {_quoted(about)}",
            f"rotation: {self.rotation}",
            "cam:",
            *(f"  {key}: {value}" for key, value in cam.items()),
            *motion,
            *([f"part: {{{keys}}}"] if keys else []),
            *([OPENINGS] if self.openings or self._outline.passed else []),
            "export:",
            f"  tolerance: {2.0 * self.reading:.6g}",
            "  files: [dxf, csv, html]",
            "",
        ]
        return "\n".join(lines)

    def _disc_keys(self) -> dict[str, str]:
        """Keys of a cam of kind disc, without its motion; raises CallError for a ring without a round outline."""
        keys = {"kind": "disc", "base_radius": f"{self.base_radius:.9g}", "follower": self.follower.keys}
        if self.follower.track == "internal":
            if self.blank is None:
                raise CallError(
                    f"{escaped(str(self.path))}: a ring's recipe has a round outline: leave recipe and page out"
                )
            keys["track"] = "internal"
        if self.follower.track == "groove" and self._motion.second is not None:
            play = self.follower.motion_to_mm * (self._motion.second - self.position)
            clearance = max(float(np.median(play * np.cos(self.pressure_angle))), 0.0)
            keys["track"] = f"{{groove: {{clearance: {clearance:.6g}}}}}"
        return keys

    def _yoke_keys(self) -> dict[str, str]:
        """Keys of a cam for a yoke, without its motion; raises CallError for a breadth that varies, or odd steps."""
        narrow, wide = self.breadth or (0.0, 0.0)
        if wide - narrow > 2.0 * self.reading:
            raise CallError(
                f"{escaped(str(self.path))}: the breadth varies by {wide - narrow:.6g} mm, and a recipe's cam has one: "
                f"give reading {upward(0.5 * (wide - narrow))} or more, or leave yoke out"
            )
        if len(self.theta) % 2:
            raise CallError("a recipe of a yoke has a table over half a turn: give an even number of steps")
        # of the first contact at angle 0: the middle of the yoke there, and half the mean breadth
        distance = 0.5 * (float(self.position[0] - self.position[len(self.theta) // 2]) + 0.5 * (narrow + wide))
        base = f"{distance - self.follower.touch.radius:.9g}"
        if self.follower.flat:
            return {"kind": "constant-breadth", "base_radius": base}
        return {"kind": "constant-diameter", "base_radius": base, "roller_radius": f"{self.follower.touch.radius!r}"}


def _quoted(text: str) -> str:
    """The text as a double-quoted scalar of YAML."""
    import json

    return json.dumps(text, ensure_ascii=False)


@with_packages()
def follow(
    file: str | PathLike[str],
    *,
    roller: float | None = None,
    shoe: float | None = None,
    flat: bool = False,
    width: float | None = None,
    offset: float = 0.0,
    arm: tuple[float, ...] | float | None = None,
    leading: bool = False,
    yoke: bool = False,
    track: Track = "external",
    units: Units | None = None,
    gap: float | None = None,
    across: Literal["arc", "chord"] | None = None,
    mirror: Literal["x", "y"] | None = None,
    turn: float = 0.0,
    body: int | str | None = None,
    at: tuple[float, float] = (0.0, 0.0),
    rotation: Literal["cw", "ccw"] = "cw",
    reading: float = READING,
    steps: int = STEPS,
) -> Followed:
    """Motion of a follower that runs on the contour of a drawing or a solid; lengths in mm.

    The follower has a `roller` or a curved `shoe` of a radius, a roller of 0 being a knife edge, or is `flat`, perhaps
    of a `width` that is centred on the stem's axis. It is led on a line of travel that passes the shaft at `offset`, or
    on an `arm`: the distance of its pivot from the shaft, and with a round touch the length. The arm trails, or is
    `leading`. A `yoke` has a second contact opposite. By its `track` a roller runs in the opening of a ring
    ("internal") or in a "groove", where its motion is that on the inner flank. The shaft is `at` a place of the file
    and turns by `rotation`; the follower is along x at shaft angle 0. `units` is the unit of a file that states none.
    Ends of a drawing within `gap` are joined, by default those that the file's digits or its size explain. `across`
    closes a contour that is open, by an arc about the shaft or a chord. The contour is mirrored in the axis `mirror`
    through the shaft, then turned counter-clockwise by `turn`, degrees. Of a solid with several bodies `body` is the
    number, from 1, or the name of one. A
    dwell is within `reading` of its level. The motion is given at `steps` equal steps of a turn, from 36 to 100,000.

    Raises CallError for a file that cannot be read or has no such contour, for arguments that are wrong or do not go
    together, where the follower does not meet the contour or its contact leaves a face of `width`, and for a roller
    that no groove holds; SurroundingsError for a package that is missing, TypeError for an argument of a wrong type.
    """
    # arguments are checked first
    path = path_of("file", file)
    for name, value in (("flat", flat), ("leading", leading), ("yoke", yoke)):
        demand_type(name, value, bool, "a bool")
    lengths = {"roller": roller, "shoe": shoe, "width": width}
    touch = {name: None if value is None else number_of(name, value) for name, value in lengths.items()}
    text_of("track", track, tuple(TRACKS), "a track")
    follower = describe_follower(
        **touch,
        flat=flat,
        offset=number_of("offset", offset),
        arm=_numbers("arm", () if arm is None else arm if isinstance(arm, tuple) else (arm,)),
        leading=leading,
        yoke=yoke,
        track=track,
    )
    if units is not None:
        text_of("units", units, tuple(UNIT_MM), "a unit")
    text_of("rotation", rotation, ("cw", "ccw"), "a rotation")
    place = _numbers("at", at)
    if len(place) != LENGTHS or not all(math.isfinite(value) and abs(value) <= MOST for value in place):
        raise CallError("at is the place of the shaft in the file: two lengths in mm, x and y")
    bridged = None if gap is None else number_of("gap", gap)
    if bridged is not None and not 0.0 < bridged <= MOST:
        raise CallError(f"a gap is a length above 0, not {short_repr(gap)}")
    if across is not None:
        text_of("across", across, ("arc", "chord"), "a way to close a contour")
    if mirror is not None:
        text_of("mirror", mirror, ("x", "y"), "an axis")
    if body is not None and not isinstance(body, str):
        whole_of("body", body)
    turned = number_of("turn", turn)
    if not abs(turned) <= MOST_TURN:
        raise CallError(f"a contour is turned by at most {MOST_TURN} degrees, not {short_repr(turn)}")
    level, count = number_of("reading", reading), whole_of("steps", steps)
    if not 0.0 < level <= MOST:
        raise CallError(f"a reading is a length above 0, not {short_repr(reading)}")
    if not LEAST_STEPS <= count <= MOST_STEPS:
        raise CallError(f"a turn is looked at in {LEAST_STEPS} to {MOST_STEPS} steps, not {short_repr(steps)}")
    # the contour, and the follower by contact on it
    unit = None if units is None else UNIT_MM[units]
    asked = Reading(
        unit,
        (place[0], place[1]),
        track,
        bridged,
        across,
        mirror,
        math.radians(turned),
        mirrored=rotation == "ccw",
        body=body,
    )
    outline = read_outline(path, asked)
    try:
        motion = measured(outline.contour, follower.contacts, count, follower.side, outline.outer)
    except ContactError as error:
        raise CallError(f"{escaped(str(path))}: {error}") from error
    _require_on_face(escaped(str(path)), motion, width)
    _require_groove(escaped(str(path)), motion, follower)
    return Followed(path, follower, rotation, (place[0], place[1]), unit, level, asked, outline, motion)


def _require_on_face(name: str, motion: MeasuredMotion, width: float | None) -> None:
    """Raise CallError where the contact leaves a face of a width that is centred on the stem's axis."""
    if width is None or motion.travel is None:
        return
    low, high = motion.travel
    needed = 2.0 * max(abs(low), abs(high))
    if needed > width:
        raise CallError(
            f"{name}: the contact leaves the face: it runs from {low:.6g} to {high:.6g} mm along it; give width "
            f"{upward(needed)} or more, or leave it out"
        )


def _require_groove(name: str, motion: MeasuredMotion, follower: FollowerDescription) -> None:
    """Raise CallError where a roller's play between two flanks, or its overlap with them, exceeds its diameter."""
    if follower.track != "groove" or motion.apart is None:
        return
    low, high = (follower.motion_to_mm * value for value in motion.apart)
    if max(-low, high) > 2.0 * follower.touch.radius:
        raise CallError(
            f"{name}: no groove for this roller, whose play between the two outermost contours round the shaft would "
            f"be {low:.6g} to {high:.6g} mm: leave track out, or give another roller"
        )


def _numbers(name: str, values: object) -> tuple[float, ...]:
    """Numbers of an argument; raises TypeError for anything but a tuple of numbers."""
    demand_type(name, values, tuple, "a tuple of numbers")
    return tuple(number_of(name, value) for value in values) if isinstance(values, tuple) else ()


def judged_by_recipe(followed: Followed) -> Report:
    """Report, with a page, of the file judged by the recipe of its motion.

    Raises CallError where `unjudged` says why, and CallError or RecipeErrors where the motion makes no recipe.
    """
    import tempfile
    from pathlib import Path

    from camgeo.api.run import verify
    from camgeo.recipe.loading import load_text

    if followed.unjudged:
        raise CallError(followed.unjudged)
    with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
        (Path(folder) / "lift.csv").write_text(followed.lifts(), encoding="utf-8")
        # no file has this text, and the name stands on the page alone: that of the contour's file, whatever it is
        text, name = followed.recipe("lift.csv", laws=True), escaped(followed.path.stem)
        recipe = replace(load_text(text, Path(folder) / "follow.yaml", escaped(str(followed.path))), name=name)
        units = next((name for name, mm in UNIT_MM.items() if mm == followed.units), None)
        return verify(recipe, followed.path, units=units, gap=followed.gap, page=True)
