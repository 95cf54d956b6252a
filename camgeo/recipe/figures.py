"""The figures of a design, each declared once: what a recipe limits, and what a sweep ranks by."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from camgeo.part.feature import WALL
from camgeo.part.features import FEATURES
from camgeo.recipe.design_figure import NOTHING, DesignFigure, Need
from camgeo.recipe.extension import KEYS, Keys
from camgeo.registry.gathered import Gathered
from camgeo.schema.fields import MOST, Field, Kind

if TYPE_CHECKING:
    from collections.abc import Callable
    from collections.abc import Set as AbstractSet


def _offered(*names: str) -> Callable[[AbstractSet[str], AbstractSet[str]], bool]:
    """Function for `Need.there`: whether the cam offers one of these names."""
    return lambda offers, _: not offers.isdisjoint(names)


def _given(*paths: str) -> Callable[[AbstractSet[str], AbstractSet[str]], bool]:
    """Function for `Need.there`: whether one of these fields is given."""
    return lambda _, fields: not fields.isdisjoint(paths)


OF_LINKAGE = Need("a linkage", _given("linkage"))
OF_DWELL = Need("dwell.band", _given("dwell"))
OF_FOLLOWER = Need("a follower without a linkage", lambda _, paths: "linkage" not in paths)
OF_ROLLER = Need("a cam for rollers", _offered("roller"))
OF_SWING = Need("a cam of kind double-roller or flat-pair", _offered("swings"))
OF_FACE = Need("a cam for a flat face that is pushed along its normal", _offered("face"))
OF_WALL = Need(
    "a part with openings or a hub",
    _given("part.bore", *(f"part.{each.name}" for each in FEATURES if each.holes or each.walled)),
)
OF_GUIDED = Need("a cam of kind disc or constant-diameter", _offered("guided"))
OF_ROLLING = Need("a roller that a cam of kind disc or constant-diameter turns", _offered("rolling"))
OF_ARM = Need("an arm that a cam of kind disc works", _offered("arm"))
OF_STEM = Need("a stem that a cam of kind disc works", _offered("stem", "stem-face"))
OF_STEM_FACE = Need("a flat face on a stem", _offered("stem-face"))
OF_WANTED_LAW = Need("cam.delta.law", _given("cam.delta.law"))
OF_STIFFNESS = Need("cam.preload.stiffness", _given("cam.preload.stiffness"))
OF_DENSITY = Need("part.density, and in a sweep no linkage", _given("part.density"), part=True)

# Names of figures.
DWELL, DWELL_RELATIVE, SIZE, CONTACT_TRAVEL, LEAST_WALL = "dwell", "dwell-relative", "size", "contact-travel", WALL
RADIUS, HOLLOW_RADIUS, PITCH_RADIUS = "radius-of-curvature", "hollow-radius", "pitch-radius"
PRESSURE_ANGLE, VELOCITY_RATIO, MOTION_ERROR = "pressure-angle", "velocity-ratio", "motion-error"
LAW_ERROR, DWELL_ERROR, CONTOUR_ERROR, OUTPUT_ERROR = "law-error", "dwell-error", "contour-error", "output-error"
PIECES = "pieces"
OF_LINKS = TRANSMISSION_ANGLE, FORCE_ANGLE, MARGIN, SHAFT_RATE = (
    "transmission-angle",
    "force-angle",
    "margin",
    "shaft-rate",
)
BACKLASH = "backlash"
ON_RISE, ON_RETURN = "pressure-angle-rise", "pressure-angle-return"
MASS, ECCENTRICITY, INERTIA, UNBALANCE = "mass", "centre-of-mass", "inertia", "unbalance"
DURATION, LOBE_CENTRE, RAMP_VELOCITY, LIFT_AREA = "duration", "lobe-centre", "ramp-velocity", "lift-area"
BASE_RADIUS, OFFSET, PIVOT = "base-radius", "offset", "pivot"
FACE_WIDTH, ROLLER_SPEED, PIVOT_CLEARANCE = "face-width", "roller-speed", "pivot-clearance"
PRELOAD_LEAST, PRELOAD_GREATEST = "preload-force-least", "preload-force-greatest"
PEAKS = ("peak-velocity", "peak-acceleration", "peak-jerk")

_RETURN = Field(
    "on_return",
    Kind.NUMBER,
    "greatest value on the return, where at_most is that on the rise alone",
    default="at_most",
    at_least=-(MOST**2),
    at_most=MOST**2,
    unit=Kind.ANGLE,
)


def lift_key(usual: float) -> tuple[Field]:
    """The key `at_lift` of a limit, by which a figure is taken at another lift than its `usual` lift, mm."""
    about = "lift at which it is taken, from the lowest"
    return (Field("at_lift", Kind.LENGTH, about, default=f"{usual:g} mm", at_least=0, at_most=MOST),)


def _of_lobe(about: str, kind: Kind, best: Literal["most", "least"], lift: float, per: str = "") -> DesignFigure:
    return DesignFigure(about, kind, best, OF_STEM, per, keys=lift_key(lift), at_lift=lift)


def _peak(about: str, per: str, needs: Need = NOTHING) -> DesignFigure:
    return DesignFigure(about, Kind.MOTION, "least", needs, per, dear=True, eased_by="motion")


def _of_size(about: str, kind: Kind, needs: Need, *, dear: bool = True) -> DesignFigure:
    """Figure that a smaller motion or a larger cam makes less."""
    return DesignFigure(about, kind, "least", needs, dear=dear, eased_by="size")


def _of_file(about: str, kind: Kind, needs: Need = NOTHING) -> DesignFigure:
    return DesignFigure(about, kind, "least", needs, of="file", swept=False)


_CORE: dict[str, DesignFigure] = {
    DWELL: DesignFigure("longest dwell over the shaft angle, at the band of `dwell`", Kind.ANGLE, "most", OF_DWELL),
    DWELL_RELATIVE: DesignFigure(
        "longest dwell over the relative angle, at that band", Kind.ANGLE, "most", OF_DWELL, dear=True
    ),
    "swing": DesignFigure("swing or stroke of the output, without a linkage of the follower", Kind.MOTION, "most"),
    PEAKS[0]: _peak("its greatest velocity, per radian of shaft angle", "/rad"),
    PEAKS[1]: _peak("its greatest acceleration, per radian squared", "/rad^2"),
    PEAKS[2]: _peak("the follower's greatest jerk, per radian cubed", "/rad^3", OF_FOLLOWER),
    PRESSURE_ANGLE: DesignFigure(
        "greatest angle between the contact's normal and the follower's way; 0 of a flat face",
        Kind.ANGLE,
        "least",
        OF_FOLLOWER,
        eased_by="size",
        keys=(_RETURN,),
    ),
    ON_RISE: _of_size("greatest pressure angle, above 0 where the cam drives a rise", Kind.ANGLE, OF_GUIDED),
    ON_RETURN: _of_size("the same on the return, greatest below 0", Kind.ANGLE, OF_GUIDED),
    VELOCITY_RATIO: _of_size(
        "greatest angular velocity of the arm over that of the shaft", Kind.NUMBER, OF_SWING, dear=False
    ),
    LAW_ERROR: DesignFigure(
        "greatest distance of the swing from delta.law, over the turn", Kind.ANGLE, "least", OF_WANTED_LAW
    ),
    CONTACT_TRAVEL: _of_size("how far the contact travels along the face", Kind.LENGTH, OF_FACE),
    FACE_WIDTH: DesignFigure(  # the contact lies off the axis by the velocity, on a cam of any size
        "least width of a face, centred on the stem's axis, that the contact does not leave",
        Kind.LENGTH,
        "least",
        OF_STEM_FACE,
        dear=True,
        eased_by="motion",
    ),
    ROLLER_SPEED: DesignFigure(
        "greatest speed of the roller, turns per turn of the shaft", Kind.NUMBER, "least", OF_ROLLING, dear=True
    ),
    PIVOT_CLEARANCE: DesignFigure(
        "least distance of the arm's pivot from the contour over the turn, below 0 where the disc passes over it",
        Kind.LENGTH,
        "most",
        OF_ARM,
        dear=True,
    ),
    PRELOAD_LEAST: DesignFigure(
        "least force of a preload by interference over the turn, along the travel, N; N m where it turns",
        Kind.THRUST,
        "most",
        OF_STIFFNESS,
        dear=True,
    ),
    PRELOAD_GREATEST: DesignFigure("its greatest force", Kind.THRUST, "least", OF_STIFFNESS, dear=True),
    TRANSMISSION_ANGLE: DesignFigure("least transmission angle", Kind.ANGLE, "most", OF_LINKAGE),
    FORCE_ANGLE: DesignFigure(
        "least angle between the force at the joint and the rocker", Kind.ANGLE, "most", OF_LINKAGE, dear=True
    ),
    MARGIN: DesignFigure("least distance from binding", Kind.LENGTH, "most", OF_LINKAGE),
    SHAFT_RATE: DesignFigure(
        "least turn of the shaft per turn of the cam against the frame", Kind.NUMBER, "most", OF_LINKAGE
    ),
    RADIUS: DesignFigure("least radius of curvature of the contour", Kind.LENGTH, "most"),
    HOLLOW_RADIUS: DesignFigure(
        "least radius of the contour's hollows, infinite without one", Kind.LENGTH, "most", OF_ROLLER, dear=True
    ),
    PITCH_RADIUS: DesignFigure(
        "least radius of curvature of the pitch curve, in a ring that of its hollows, infinite without one",
        Kind.LENGTH,
        "most",
        OF_ROLLER,
    ),
    BASE_RADIUS: DesignFigure("radius of the base circle, which `sizing` may find", Kind.LENGTH, "least", OF_GUIDED),
    OFFSET: DesignFigure("eccentricity of the stem's line, likewise", Kind.LENGTH, "least", OF_STEM),
    PIVOT: DesignFigure("distance of the arm's pivot from the shaft, likewise", Kind.LENGTH, "least", OF_ARM),
    SIZE: DesignFigure("greatest distance of the contour from the shaft", Kind.LENGTH, "least"),
    MASS: DesignFigure("mass of a disc, kg", Kind.MASS, "least", OF_DENSITY, per="kg", dear=True),
    ECCENTRICITY: DesignFigure(
        "distance of a disc's centre of mass from the shaft", Kind.LENGTH, "least", OF_DENSITY, dear=True
    ),
    INERTIA: DesignFigure(
        "moment of inertia of a disc about the shaft, kg mm²", Kind.NUMBER, "least", OF_DENSITY, "kg mm^2", dear=True
    ),
    UNBALANCE: DesignFigure(
        "mass of a disc times the distance of its centre of mass, kg mm",
        Kind.NUMBER,
        "least",
        OF_DENSITY,
        "kg mm",
        dear=True,
    ),
    # lobes: at a lift of 0.050 in, of 0.006 in, and over the whole lobe
    DURATION: _of_lobe("crank degrees for which the lift is above one of 1.27 mm", Kind.ANGLE, "most", 1.27),
    LOBE_CENTRE: _of_lobe("cam angle midway between the crossings of 1.27 mm of lift", Kind.ANGLE, "most", 1.27),
    RAMP_VELOCITY: _of_lobe("velocity at a lift of 0.1524 mm, a cam degree", Kind.LENGTH, "least", 0.1524, "/deg"),
    LIFT_AREA: _of_lobe("lift over the turn, times cam degrees", Kind.LENGTH, "most", 0.0, " deg"),
    LEAST_WALL: DesignFigure("least wall between any two edges of the part", Kind.LENGTH, "most", OF_WALL, swept=False),
    CONTOUR_ERROR: _of_file("distance between a file's contour and the exact one", Kind.LENGTH),
    MOTION_ERROR: _of_file("greatest motion error of a file", Kind.ERROR),
    DWELL_ERROR: _of_file("range of the follower's position over a dwell, of a file", Kind.ERROR),
    BACKLASH: _of_file(
        "greatest backlash or interference of a follower held from both sides, of a file", Kind.BACKLASH
    ),
    OUTPUT_ERROR: _of_file("greatest error of the linkage's output, of a file", Kind.OUTPUT, OF_LINKAGE),
    PIECES: _of_file("number of pieces of a file's contour", Kind.NUMBER),
}


FIGURES: Gathered[Keys, DesignFigure] = Gathered(_CORE, KEYS, lambda answers: answers.figures)
"""Every figure by name, the core's and those of capabilities."""
