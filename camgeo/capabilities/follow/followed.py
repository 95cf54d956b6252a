"""The motion that a contour gives a follower: its figures, its table, its recipe and the page of that."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from camgeo.capabilities.follow.laws import Laws, laws_of
from camgeo.common.arguments import demand_type, short_repr
from camgeo.common.errors import CallError
from camgeo.common.rounding import upward
from camgeo.common.terminal import escaped
from camgeo.common.units import UNIT_MM
from camgeo.motions.recognised import in_flow
from kin.contour.pieces import LINE
from kin.follower.measured import LEAST_DWELL
from kin.follower.motion_error import ContactError
from kin.follower.unknown import across_words, stretches, unknown_angles
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, field, replace
from kin.read.points import SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.api.report import Report
    from camgeo.capabilities.follow.follower import FollowerDescription
    from camgeo.capabilities.follow.outline import Outline, Reading
    from kin.follower.measured import MeasuredMotion
    from kin.numeric.arrays import Array, Mask

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

    def document(self) -> dict[str, Any]:
        """The figures as plain data; lengths in mm, angles in degrees."""
        return document(self)

    def summary(self) -> str:
        """Text for a terminal."""
        return summary(self)

    def told_recipe(self, table: str) -> tuple[str, list[str]]:
        """Text of the recipe with the laws of this motion where they fit, and lines of text on what it has.

        The lines tell the laws, or why the recipe has the file `table` of lifts. Raises as `Followed.recipe` does.
        """
        text, laws, name = self.recipe(table, laws=True), self.laws, escaped(table)
        if laws.rows is None:
            return text, [f"  the recipe has the motion as the table {name}: {laws.why}"]
        unit = "mm" if self.unit == "mm" else "deg"
        within = f"within {laws.off:.2g} {unit} of the motion"
        last = f"  the recipe has these laws, {within}, and names the table {name} beside them"
        return text, [*(f"  {line}" for line in laws.lines), last]

    def page(self) -> str:
        """HTML of the page of this motion's recipe, with the verdict on the file.

        Raises CallError where `unjudged` says why, and CallError or RecipeErrors where the motion makes no recipe.
        """
        return judged_by_recipe(self).page or ""


def _quoted(text: str) -> str:
    """The text as a double-quoted scalar of YAML."""
    import json

    return json.dumps(text, ensure_ascii=False)


def document(followed: Followed) -> dict[str, Any]:
    """The motion's figures as plain data for JSON; lengths in mm, angles in degrees."""
    scale, unit = (1.0, "mm") if followed.unit == "mm" else (math.degrees(1.0), "deg")
    travel, radius, known = followed.contact_travel, followed.radius, followed.known
    least, greatest, smoothed = followed.least, followed.greatest, None
    if not known.all():
        low, high = np.where(known, followed.position, np.inf), np.where(known, followed.position, -np.inf)
        least = float(low.min()), float(followed.theta[low.argmin()])
        greatest = float(high.max()), float(followed.theta[high.argmax()])
    if followed.facets is not None:  # what a polygon says of radii and accelerations is of its corners
        radius = np.full(len(radius), math.inf)
        if followed.smoothed is not None and known.any():
            kept = scale * followed.smoothed[known]
            smoothed = [float(kept.min()), float(kept.max())]
    return {
        "file": followed.path.name,
        "follower": followed.follower.words,
        "unit": unit,
        "base_radius": followed.follower.base_radius(least[0]),
        "lift": scale * (greatest[0] - least[0]),
        "least": {"position": scale * least[0], "at_deg": math.degrees(least[1])},
        "greatest": {"position": scale * greatest[0], "at_deg": math.degrees(greatest[1])},
        "dwells": [
            {
                "start_deg": math.degrees(rest.begin),
                "length_deg": math.degrees(rest.end - rest.begin),
                "position": scale * rest.level,
                "flatness": scale * rest.flatness,
            }
            for rest in known_rests(followed.rests, followed.unknown)
        ],
        # the greatest magnitude, as the least of the negative ones
        "pressure_angle": _least(followed, -math.degrees(1.0) * abs(followed.pressure_angle)),
        "radius_of_curvature": _least(followed, np.where(radius < 0.0, math.inf, radius)),
        "hollow_radius": _least(followed, np.where(radius < 0.0, -radius, math.inf)),
        "facets": followed.facets,
        "smoothed_acceleration": smoothed,
        "breadth": None if followed.breadth is None else list(followed.breadth),
        "play": None if followed.play is None else [scale * value for value in followed.play],
        "contact_travel": None if travel is None else list(travel),
        "across": [_across(followed, begin, end, scale) for begin, end in followed.unknown],
        "openings": followed.openings,
        "remarks": list(followed.remarks),
    }


def known_rests(rests: Sequence[Rest], unknown: Sequence[tuple[float, float]]) -> list[Rest]:
    """Dwells without what of them lies in unknown stretches, (begin, end), rad; parts below ten degrees go."""
    left = list(rests)
    for begin, end in unknown:
        parts = []
        for rest in left:
            first = begin + TURN * math.ceil((rest.begin - end) / TURN)  # the stretch that ends beyond its beginning
            last = first + end - begin
            sides = [(rest.begin, min(rest.end, first)), (max(rest.begin, last), rest.end)]
            cut = first < rest.end
            parts += [replace(rest, begin=a, end=b) for a, b in sides if b - a >= LEAST_DWELL] if cut else [rest]
        left = parts
    return left


def _across(followed: Followed, begin: float, end: float, scale: float) -> dict[str, float]:
    """Figures of the motion over a stretch of shaft angles, rad, in which nothing is known of the contour."""
    within = (followed.theta - begin) % TURN <= end - begin
    position, pressure = scale * followed.position[within], followed.pressure_angle[within]
    return {
        "start_deg": math.degrees(begin),
        "end_deg": math.degrees(end) % 360.0,
        "least": float(position.min()),
        "greatest": float(position.max()),
        "pressure_angle": math.degrees(float(np.abs(pressure).max())),
    }


def _least(followed: Followed, values: Array) -> dict[str, float] | None:
    """Magnitude of the least of values (n,) where the contour is known, and its shaft angle; None if not finite."""
    values = np.where(followed.known, values, math.inf)
    place = int(values.argmin())
    if not math.isfinite(values[place]):
        return None
    return {"value": abs(float(values[place])), "at_deg": math.degrees(float(followed.theta[place]))}


def summary(followed: Followed) -> str:
    """The motion's figures in lines of text."""
    figures = document(followed)
    unit, least, most = figures["unit"], figures["least"], figures["greatest"]
    ends = f"least at {least['at_deg']:.2f} degrees, greatest at {most['at_deg']:.2f}"
    lines = [
        f"{escaped(figures['file'])}: {figures['follower']}",
        f"  lift {figures['lift']:.6g} {unit}, {ends}; base radius {figures['base_radius']:.6g} mm",
    ]
    for dwell in figures["dwells"]:
        end = (dwell["start_deg"] + dwell["length_deg"]) % 360.0
        height = round(dwell["position"] - least["position"], 7) + 0.0  # no more than rounding on a large roller
        lines.append(
            f"  dwell at {height:.6g} {unit} from {dwell['start_deg']:.1f} to {end:.1f} degrees, "
            f"flat within {dwell['flatness']:.2g} {unit}"
        )
    angle = figures["pressure_angle"]
    lines.append(f"  pressure angle up to {angle['value']:.2f} degrees at {angle['at_deg']:.1f}")
    radii = {"least radius of curvature": "radius_of_curvature", "least radius of a hollow": "hollow_radius"}
    for words, key in radii.items():
        if (radius := figures[key]) is not None:
            corner = "" if radius["value"] else ", a corner,"
            lines.append(f"  {words} {radius['value']:.4g} mm{corner} at {radius['at_deg']:.1f} degrees")
    if (facets := figures["facets"]) is not None:
        lines.append(f"  a polygon: its edges stand {facets:.2g} mm off a curve, and say nothing of radii of curvature")
        if (pair := figures["smoothed_acceleration"]) is not None:
            lines.append(f"  acceleration of the smoothed motion from {pair[0]:.4g} to {pair[1]:.4g} {unit}/rad²")
    for words, key, scale in (("breadth", "breadth", "mm"), ("play in the groove", "play", unit)):
        if (pair := figures[key]) is not None:
            lines.append(f"  {words} from {pair[0]:.6g} to {pair[1]:.6g} {scale}")
    if (travel := figures["contact_travel"]) is not None:
        width = "" if unit == "deg" else f", a centred face is {2.0 * max(map(abs, travel)):.6g} mm wide"
        lines.append(f"  contact on the face from {travel[0]:.6g} to {travel[1]:.6g} mm{width}")
    if count := figures["openings"]:
        contours = "1 other closed contour is" if count == 1 else f"{count} other closed contours are"
        lines.append(f"  {contours} passed over: a bore that is not round, holes, or what is drawn in them")
    for part in figures["across"]:
        low, high = (round(part[key] - least["position"], 7) + 0.0 for key in ("least", "greatest"))
        lines.append(
            f"  where it is closed, from {part['start_deg']:.1f} to {part['end_deg']:.1f} degrees: at {low:.6g} to "
            f"{high:.6g} {unit}, pressure angle up to {part['pressure_angle']:.2f} degrees"
        )
    lines += [f"  {escaped(remark)}" for remark in figures["remarks"]]
    return "\n".join(lines)


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
