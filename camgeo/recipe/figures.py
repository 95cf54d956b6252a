"""The figures of a design, each declared once: what a recipe limits, and what a sweep ranks by."""

from __future__ import annotations

from typing import Literal, TypeAlias, TypeVar

from camgeo.schema.fields import Kind
from kin.numeric.records import dataclass

Value = TypeVar("Value")


Own: TypeAlias = Literal[
    "guided",
    "rolling",
    "arm",
    "stem",
    "stem-face",
    "guide",
    "speed",
    "density",
    "wanted",
    "stiff",
    "forces",
    "material",
    "bearing",
    "reaction",
]
Needs: TypeAlias = (
    Literal["", "linkage", "dwell", "follower", "roller", "swings", "face", "wall", "all", "preload", "backlash"] | Own
)


NEEDS: dict[Needs, str] = {
    "linkage": "a linkage",
    "dwell": "dwell.band",
    "follower": "a follower without a linkage",
    "roller": "a cam for rollers",
    "swings": "a cam of kind double-roller or flat-pair",
    "face": "a cam for a flat face that is pushed along its normal",
    "wall": "a part with openings or a hub",
    "all": "a file with `parts: all`",
    "preload": "dynamics.preload and its stiffness",
    "backlash": "dynamics.backlash",
    "guided": "a cam of kind disc or constant-diameter",
    "rolling": "a roller that a cam of kind disc or constant-diameter turns",
    "arm": "an arm that a cam of kind disc works",
    "stem": "a stem that a cam of kind disc works",
    "stem-face": "a flat face on a stem",
    "guide": "dynamics.guide of a round follower",
    "wanted": "cam.delta.law",
    "speed": "a follower without a linkage, and dynamics.rpm",
    "stiff": "cam.preload.stiffness",
    "forces": "dynamics without stiffness",
    "material": "dynamics.material, part.thickness, a groove's depth or dynamics.width, and no stiffness",
    "reaction": "dynamics.guide, and no stiffness",
    "bearing": "a roller that a cam turns, and dynamics without stiffness",
    "density": "part.density, and in a sweep no linkage",
}
"""What a figure is taken from, besides the cam and its files, in words."""
OF_PART: frozenset[Needs] = frozenset({"density", "material"})
"""Needs for which the part counts as well, its material or its thickness."""


_OPENINGS = ("bore", "hub", "bolts", "dowel", "lightening", "mark")


# Names that stand in programs too.
DWELL, SIZE, CONTACT_TRAVEL, LEAST_WALL = "dwell", "size", "contact-travel", "wall"


RADIUS, HOLLOW_RADIUS, PITCH_RADIUS = "radius-of-curvature", "hollow-radius", "pitch-radius"


PRESSURE_ANGLE, VELOCITY_RATIO, MOTION_ERROR = "pressure-angle", "velocity-ratio", "motion-error"
LAW_ERROR = "law-error"


BACKLASH, BACKLASH_LEFT = "backlash", "least-backlash"


ON_RISE, ON_RETURN = "pressure-angle-rise", "pressure-angle-return"


MASS, ECCENTRICITY, INERTIA, UNBALANCE = "mass", "centre-of-mass", "inertia", "unbalance"


DURATION, LOBE_CENTRE, RAMP_VELOCITY, LIFT_AREA = "duration", "lobe-centre", "ramp-velocity", "lift-area"


AT_LIFT = {DURATION: 1.27, LOBE_CENTRE: 1.27, RAMP_VELOCITY: 0.1524, LIFT_AREA: 0.0}
"""Lifts, mm, at which figures of lobes are taken unless a limit says another: 0.050 and 0.006 in, and all of it."""


BASE_RADIUS, OFFSET, PIVOT = "base-radius", "offset", "pivot"


FACE_WIDTH, ROLLER_SPEED, PIVOT_CLEARANCE, JAM_MARGIN = "face-width", "roller-speed", "pivot-clearance", "jam-margin"


FORCE_LEAST, FORCE_GREATEST, TORQUE = "contact-force-least", "contact-force-greatest", "shaft-torque"


PRESSURE, GUIDE_FORCE, MEAN_FORCE = "contact-pressure", "guide-force", "mean-roller-force"


PRELOAD_LEAST, PRELOAD_GREATEST = "preload-force-least", "preload-force-greatest"


LEAST_FORCE, PEAK_FORCE = "least-force", "peak-force"


PEAKS = ("peak-velocity", "peak-acceleration", "peak-jerk")


AT_SPEED = tuple(f"{name}-at-speed" for name in PEAKS)


STEEP = frozenset({PRESSURE_ANGLE, ON_RISE, ON_RETURN, VELOCITY_RATIO, CONTACT_TRAVEL, FACE_WIDTH, *PEAKS, *AT_SPEED})
"""Figures that are the less the smaller the motion is."""


@dataclass(frozen=True)
class Figure:
    """One figure of a design.

    `kind` is that of its values: degrees for an angle, the recipe's unit for a length, and for a motion either, as
    the follower or the last link swings or slides. `best` says which values a ranking puts first, `needs` what the
    figure is taken from. `per` ends its unit's name. `of` says whether the exact design has it, each file, or each run
    of the dynamics. `swept` is whether a sweep knows it.
    """

    about: str
    kind: Kind
    best: Literal["most", "least"]
    needs: Needs = ""
    per: str = ""
    of: Literal["design", "file", "dynamics"] = "design"
    swept: bool = True


def _of_file(about: str, kind: Kind, needs: Needs = "") -> Figure:
    return Figure(about, kind, "least", needs, of="file", swept=False)


FIGURES: dict[str, Figure] = {
    DWELL: Figure("longest dwell over the shaft angle, at the band of `dwell`", Kind.ANGLE, "most", "dwell"),
    "dwell-relative": Figure("longest dwell over the relative angle, at that band", Kind.ANGLE, "most", "dwell"),
    "swing": Figure("swing or stroke of the output, without a linkage of the follower", Kind.MOTION, "most"),
    PEAKS[0]: Figure("its greatest velocity, per radian of shaft angle", Kind.MOTION, "least", per="/rad"),
    PEAKS[1]: Figure("its greatest acceleration, per radian squared", Kind.MOTION, "least", per="/rad^2"),
    PEAKS[2]: Figure("the follower's greatest jerk, per radian cubed", Kind.MOTION, "least", "follower", per="/rad^3"),
    AT_SPEED[0]: Figure("peak-velocity a second, at the shaft's speed", Kind.MOTION, "least", "speed", per="/s"),
    AT_SPEED[1]: Figure("peak-acceleration a second squared, at that speed", Kind.MOTION, "least", "speed", per="/s^2"),
    AT_SPEED[2]: Figure("peak-jerk a second cubed, at that speed", Kind.MOTION, "least", "speed", per="/s^3"),
    PRESSURE_ANGLE: Figure(
        "greatest angle between the contact's normal and the follower's way; 0 of a flat face",
        Kind.ANGLE,
        "least",
        "follower",
    ),
    ON_RISE: Figure("greatest pressure angle, above 0 where the cam drives a rise", Kind.ANGLE, "least", "guided"),
    ON_RETURN: Figure("the same on the return, greatest below 0", Kind.ANGLE, "least", "guided"),
    JAM_MARGIN: Figure(
        "by how much the pressure angle stays below that at which the stem jams in its guide",
        Kind.ANGLE,
        "most",
        "guide",
    ),
    VELOCITY_RATIO: Figure(
        "greatest angular velocity of the arm over that of the shaft", Kind.NUMBER, "least", "swings"
    ),
    LAW_ERROR: Figure("greatest distance of the swing from delta.law, over the turn", Kind.ANGLE, "least", "wanted"),
    CONTACT_TRAVEL: Figure("how far the contact travels along the face", Kind.LENGTH, "least", "face"),
    FACE_WIDTH: Figure(
        "least width of a face, centred on the stem's axis, that the contact does not leave",
        Kind.LENGTH,
        "least",
        "stem-face",
    ),
    ROLLER_SPEED: Figure("greatest speed of the roller, turns per turn of the shaft", Kind.NUMBER, "least", "rolling"),
    PIVOT_CLEARANCE: Figure(
        "least distance of the arm's pivot from the contour over the turn, below 0 where the disc passes over it",
        Kind.LENGTH,
        "most",
        "arm",
    ),
    PRELOAD_LEAST: Figure(
        "least force of a preload by interference over the turn, along the travel, N; N m where it turns",
        Kind.THRUST,
        "most",
        "stiff",
    ),
    PRELOAD_GREATEST: Figure("its greatest force", Kind.THRUST, "least", "stiff"),
    FORCE_LEAST: Figure("least normal force of any contact at the speed, N", Kind.FORCE, "most", "forces"),
    FORCE_GREATEST: Figure("greatest normal force of any contact at the speed, N", Kind.FORCE, "least", "forces"),
    TORQUE: Figure("greatest torque of the shaft at the speed, either way, N m", Kind.MOMENT, "least", "forces"),
    PRESSURE: Figure(
        "greatest pressure of the contacts (Hertz), N/mm²", Kind.NUMBER, "least", "material", per="N/mm^2"
    ),
    GUIDE_FORCE: Figure("greatest reaction of the stem's guide, N", Kind.FORCE, "least", "reaction"),
    MEAN_FORCE: Figure("mean force of a roller over its own turns, exponent 10/3, N", Kind.FORCE, "least", "bearing"),
    "transmission-angle": Figure("least transmission angle", Kind.ANGLE, "most", "linkage"),
    "force-angle": Figure("least angle between the force at the joint and the rocker", Kind.ANGLE, "most", "linkage"),
    "margin": Figure("least distance from binding", Kind.LENGTH, "most", "linkage"),
    "shaft-rate": Figure(
        "least turn of the shaft per turn of the cam against the frame", Kind.NUMBER, "most", "linkage"
    ),
    RADIUS: Figure("least radius of curvature of the contour", Kind.LENGTH, "most"),
    HOLLOW_RADIUS: Figure("least radius of the contour's hollows, infinite without one", Kind.LENGTH, "most", "roller"),
    PITCH_RADIUS: Figure(
        "least radius of curvature of the pitch curve, in a ring that of its hollows, infinite without one",
        Kind.LENGTH,
        "most",
        "roller",
    ),
    BASE_RADIUS: Figure("radius of the base circle, which `sizing` may find", Kind.LENGTH, "least", "guided"),
    OFFSET: Figure("eccentricity of the stem's line, likewise", Kind.LENGTH, "least", "stem"),
    PIVOT: Figure("distance of the arm's pivot from the shaft, likewise", Kind.LENGTH, "least", "arm"),
    SIZE: Figure("greatest distance of the contour from the shaft", Kind.LENGTH, "least"),
    MASS: Figure("mass of a disc, kg", Kind.MASS, "least", "density", per="kg"),
    ECCENTRICITY: Figure("distance of a disc's centre of mass from the shaft", Kind.LENGTH, "least", "density"),
    INERTIA: Figure("moment of inertia of a disc about the shaft, kg mm²", Kind.NUMBER, "least", "density", "kg mm^2"),
    UNBALANCE: Figure(
        "mass of a disc times the distance of its centre of mass, kg mm", Kind.NUMBER, "least", "density", "kg mm"
    ),
    DURATION: Figure("crank degrees for which the lift is above one of 1.27 mm", Kind.ANGLE, "most", "stem"),
    LOBE_CENTRE: Figure("cam angle midway between the crossings of 1.27 mm of lift", Kind.ANGLE, "most", "stem"),
    RAMP_VELOCITY: Figure("velocity at a lift of 0.1524 mm, a cam degree", Kind.LENGTH, "least", "stem", "/deg"),
    LIFT_AREA: Figure("lift over the turn, times cam degrees", Kind.LENGTH, "most", "stem", " deg"),
    LEAST_WALL: Figure("least wall between any two edges of the part", Kind.LENGTH, "most", "wall", swept=False),
    "clearance": Figure("least running clearance of the bodies", Kind.LENGTH, "most", "all", swept=False),
    "collision": Figure("least distance between bodies over the turn", Kind.LENGTH, "most", "all", swept=False),
    "contour-error": _of_file("distance between a file's contour and the exact one", Kind.LENGTH),
    MOTION_ERROR: _of_file("greatest motion error of a file", Kind.ERROR),
    "dwell-error": _of_file("range of the follower's position over a dwell, of a file", Kind.ERROR),
    BACKLASH: _of_file(
        "greatest backlash or interference of a follower held from both sides, of a file", Kind.BACKLASH
    ),
    "output-error": _of_file("greatest error of the linkage's output, of a file", Kind.OUTPUT, "linkage"),
    "pieces": _of_file("number of pieces of a file's contour", Kind.NUMBER),
    LEAST_FORCE: Figure(
        "least contact force, N; N m where it turns", Kind.THRUST, "most", "preload", of="dynamics", swept=False
    ),
    PEAK_FORCE: Figure(
        "greatest contact force, N; N m where it turns", Kind.THRUST, "least", "preload", of="dynamics", swept=False
    ),
    BACKLASH_LEFT: Figure(
        "least backlash that the dynamics leave between the faces",
        Kind.ERROR,
        "most",
        "backlash",
        of="dynamics",
        swept=False,
    ),
}


ALL = "parts: all"


def there(needs: Needs, offers: frozenset[str], paths: frozenset[str] | set[str]) -> bool:
    """Say whether a recipe has what a figure needs, by what its cam offers and the paths of the fields given.

    `ALL` is given where a file shows every body.
    """
    match needs:
        case "linkage" | "dwell":
            return needs in paths
        case "backlash" | "preload":
            return {f"dynamics.{needs}", "dynamics.stiffness"} <= paths
        case "forces":
            return "dynamics" in paths and "dynamics.stiffness" not in paths
        case "material":
            wide = not paths.isdisjoint({"dynamics.width", "part.thickness", "cam.track.groove.depth"})
            return wide and "dynamics.material" in paths and there("forces", offers, paths)
        case "reaction":
            return "dynamics.guide" in paths and there("forces", offers, paths)
        case "bearing":
            return "rolling" in offers and there("forces", offers, paths)
        case "follower":
            return "linkage" not in paths
        case "speed":
            return "linkage" not in paths and "dynamics.rpm" in paths
        case "guide":
            return "dynamics.guide" in paths and "stem" in offers
        case "wanted" | "stiff":
            return NEEDS[needs] in paths
        case "density":
            return "part.density" in paths
        case "roller" | "swings" | "face" | "guided" | "rolling" | "arm" | "stem-face":
            return needs in offers
        case "stem":
            return not offers.isdisjoint({"stem", "stem-face"})
        case "wall":
            return any(f"part.{name}" in paths for name in _OPENINGS)
        case "all":
            return ALL in paths
    return True
