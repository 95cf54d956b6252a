"""The figures of a design, each declared once: what a recipe limits, and what a sweep ranks by."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeAlias, TypeVar

from camgeo.schema.errors import suggestion
from camgeo.schema.fields import MOST, Field, Form, Kind, Table, either
from camgeo.schema.json_schema import table_schema
from camgeo.schema.yaml_source import Mapping, Sequence, described, entries, join, keys, scalars
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    import collections.abc

    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node


Value = TypeVar("Value")


@dataclass(frozen=True)
class Limit:
    """Bounds of a figure, as reported: angles in degrees, lengths in mm, rates per radian of shaft angle.

    `rpm` is the speed, turns a minute, at which a figure in time is bounded, None for that of the dynamics. `at_lift`
    is the lift, mm, at which a lobe's is taken, None for its usual one. `key` is
    the recipe's key of the upper bound below `limits`, empty for the figure's own; `place` the entry of the figure's
    list, such as duration[1], empty where it has none.
    """

    figure: str
    at_least: float | None = None
    at_most: float | None = None
    rpm: float | None = None
    at_lift: float | None = None
    key: str = ""
    place: str = ""

    @property
    def lift(self) -> float:
        """Lift, mm, at which a lobe's figure is held."""
        return AT_LIFT[self.figure] if self.at_lift is None else self.at_lift

    def field(self, sense: str) -> str:
        """Give the recipe's field of a bound, `at_least` or `at_most`."""
        own = f"{self.place or self.figure}.{sense}"
        return f"limits.{self.key}" if self.key and sense == "at_most" else f"limits.{own}"


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
    "material": "dynamics.material, part.thickness or dynamics.width, and no stiffness",
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


FORMER = {VELOCITY_RATIO: "transmission", CONTACT_TRAVEL: "face-length", BACKLASH_LEFT: "play"}
"""Former names of renamed figures: in this version they are read, and written beside the present ones."""


PRESENT = {former: name for name, former in FORMER.items()}


def with_former(values: collections.abc.Mapping[str, Value]) -> dict[str, Value]:
    """Give values by figures, and behind them those of renamed figures by their former names."""
    return {**values, **{FORMER[name]: value for name, value in values.items() if name in FORMER}}


ON_RISE, ON_RETURN = "pressure-angle-rise", "pressure-angle-return"


MASS, ECCENTRICITY, INERTIA, UNBALANCE = "mass", "centre-of-mass", "inertia", "unbalance"


DURATION, LOBE_CENTRE, RAMP_VELOCITY, LIFT_AREA = "duration", "lobe-centre", "ramp-velocity", "lift-area"


MOST_LIFTS = 20  # at which a recipe bounds one figure
AT_LIFT = {DURATION: 1.27, LOBE_CENTRE: 1.27, RAMP_VELOCITY: 0.1524, LIFT_AREA: 0.0}
"""Lifts, mm, at which figures of lobes are taken unless a limit says another: 0.050 and 0.006 in, and all of it."""


BASE_RADIUS, OFFSET, PIVOT = "base-radius", "offset", "pivot"


FACE_WIDTH, ROLLER_SPEED, PIVOT_CLEARANCE, JAM_MARGIN = "face-width", "roller-speed", "pivot-clearance", "jam-margin"


FORCE_LEAST, FORCE_GREATEST, TORQUE = "contact-force-least", "contact-force-greatest", "shaft-torque"


PRESSURE, GUIDE_FORCE, MEAN_FORCE = "contact-pressure", "guide-force", "mean-roller-force"


PRELOAD_LEAST, PRELOAD_GREATEST = "preload-force-least", "preload-force-greatest"


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
    "least-force": Figure(
        "least contact force, N; N m where it turns", Kind.THRUST, "most", "preload", of="dynamics", swept=False
    ),
    "peak-force": Figure(
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


def bounds(figure: Figure) -> Table:
    """Give the table of the limits of a figure; in a recipe's own limits some have a key more."""
    return Table(
        tuple(
            Field(name, Kind.NUMBER, about, at_least=-(MOST**2), at_most=MOST**2, unit=figure.kind)
            for name, about in (("at_least", "least value accepted"), ("at_most", "greatest value accepted"))
        )
    )


_RPM = Field("rpm", Kind.NUMBER, "speed of the shaft, turns a minute", default="dynamics.rpm", above=0, at_most=MOST)
_RETURN = Field(
    "on_return",
    Kind.NUMBER,
    "greatest value on the return, where at_most is that on the rise alone",
    default="at_most",
    at_least=-(MOST**2),
    at_most=MOST**2,
    unit=Kind.ANGLE,
)


def _at_lift(lift: float) -> Field:
    about = "lift at which it is taken, from the lowest"
    return Field("at_lift", Kind.LENGTH, about, default=f"{lift:g} mm", at_least=0, at_most=MOST)


def own_bounds(name: str) -> Table:
    """Give the table of the limits of a figure in a recipe's own `limits`."""
    more = {
        PRESSURE_ANGLE: (_RETURN,),
        **dict.fromkeys(AT_SPEED, (_RPM,)),
        **{figure: (_at_lift(lift),) for figure, lift in AT_LIFT.items()},
    }.get(name, ())
    return Table((*bounds(FIGURES[name]).fields, *more))


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
            wide = not paths.isdisjoint({"dynamics.width", "part.thickness"})
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


def read_limits(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read limits by the figures that they bound, those in `field.choices`; lengths in mm, angles in degrees."""
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", described(node), reader.wanted(field))
        return None
    given = entries(node)
    limits = []
    former = dict(field.former_choices)
    for word, key in keys(node).items():
        name, below = former.get(word, word), join(path, word)
        if name != word:
            reader.notice(key.mark, reader.written(below), name)
            if name in given:
                reader.fault(key.mark, below, f"the former name of {name}, which is given too", None, "leave it out")
                continue
            reader.renamed[join(path, name)] = below
        if name not in field.choices:
            known = tuple(here for here in of_recipe(reader) if here in field.choices)
            remedy = suggestion(name, known) or f"the figures are {either(known, 'and')}"
            reader.fault(key.mark, below, "unknown figure", None, remedy)
            continue
        value = given[word]
        if field is LIMITS and name in AT_LIFT and isinstance(value, Sequence):
            for i, item in enumerate(reader.items(_bounded(field, name), value, below, MOST_LIFTS)):
                own = _read_limit(reader, field, name, item, join(below, i))
                limits += [{**limit, "place": f"{name}[{i}]"} for limit in own]
        else:
            limits += _read_limit(reader, field, name, value, below)
    return limits


def _bounded(field: Field, name: str) -> Field:
    return Field("", Kind.TABLE, "", table=own_bounds(name) if field is LIMITS else bounds(FIGURES[name]))


def _read_limit(reader: Reader, field: Field, name: str, node: Node, path: str) -> list[Values]:
    """Read the bounds of one figure: one limit, or those of the rise and of the return; none where there is a fault."""
    faults = len(reader.errors)
    values = reader.field(_bounded(field, name), node, path)
    if values is None or len(reader.errors) > faults:
        return []
    stated = {key: values.pop(key) for key in ("rpm", "at_lift") if key in values}
    on_return = values.pop("on_return", None)
    if not values and on_return is None:
        reader.fault(node.mark, path, "no bound", None, "give at_least, at_most or both")
    factor = reader.mm if reader.unit(FIGURES[name].kind) == reader.units else 1.0
    if values.get("at_least", -math.inf) > values.get("at_most", math.inf):
        none = "no design" if field is not LIMITS else "nothing"
        reader.fault_at(f"{path}.at_most", f"below at_least, so {none} is accepted", None, "exchange them")
    said = {bound: factor * value for bound, value in values.items()}
    if on_return is None:
        return [{"figure": name, "at": path, **said, **stated}]
    if "at_least" in values:
        reader.fault_at(f"{path}.at_least", "cannot be combined with on_return", None, "leave one of the two out")
        return []
    both = ((ON_RISE, "at_most", said.get("at_most")), (ON_RETURN, "on_return", on_return))
    return [
        {"figure": figure, "at": path, "at_most": most, "key": f"{name}.{bound}"}
        for figure, bound, most in both
        if most is not None
    ]


def _limits_schema(field: Field) -> Schema:
    tables = {name: own_bounds(name) if field is LIMITS else bounds(FIGURES[name]) for name in field.choices}
    limits = {name: {**table_schema(table), "minProperties": 1} for name, table in tables.items()}
    for name in AT_LIFT if field is LIMITS else ():  # one lift, or a list of them
        item = limits[name]
        limits[name] = {**item, "type": ["object", "array"], "items": item, "minItems": 1, "maxItems": MOST_LIFTS}
    for former, name in field.former_choices:
        limits[former] = {**limits[name], "description": f"former name of {name}", "deprecated": True}
    return {"type": "object", "properties": limits, "additionalProperties": False}


FORM = Form(
    "limits",
    "a mapping from figures to bounds, such as {transmission-angle: {at_least: 40}}",
    read_limits,
    _limits_schema,
)


LIMITS = Field(
    "limits",
    Kind.OWN,
    "figures that must keep within bounds, each a check of its own, such as {pressure-angle: {at_most: 45}}",
    default="none",
    choices=tuple(FIGURES),
    former_choices=tuple(PRESENT.items()),
    form=FORM,
)


def of_recipe(reader: Reader) -> tuple[str, ...]:
    """Name the figures that the recipe being read has."""
    given = set(reader.marks)
    if any(path.endswith(".parts") and scalar.text == "all" for path, scalar in scalars(reader.source.root)):
        given.add(ALL)
    return tuple(name for name, figure in FIGURES.items() if there(figure.needs, reader.offers, given))


def check_limits(limits: list[Values], reader: Reader) -> None:
    """Note limits of figures that the recipe has not."""
    here, bounded = of_recipe(reader), dict[tuple[str, str, float | None], str]()
    for limit in limits:
        for bound in ("at_least", "at_most"):
            key = limit["figure"], bound, limit.get("at_lift", AT_LIFT.get(limit["figure"]))
            if bound in limit and bounded.setdefault(key, limit["at"]) != limit["at"]:
                other, path = sorted((bounded[key], limit["at"]), key=len)
                how = "at the same lift" if "place" in limit else "with on_return"
                reader.fault_at(path, f"{other} {how} bounds it too", None, "leave one of the two out")
        name, needs = limit["figure"], FIGURES[limit["figure"]].needs
        if needs and name not in here and not ("rpm" in limit and "linkage" not in reader.marks):
            remedy = f"the figures of this recipe are {either(here, 'and')}"
            path, what = limit["at"], name
            if "key" in limit:  # one that a key of another figure gives
                path, what, remedy = (
                    f"{path}.on_return",
                    "on_return",
                    "give at_most alone, which holds on the return too",
                )
            reader.fault_at(path, f"{what} needs {NEEDS[needs]}", None, remedy)


def build_limits(limits: list[Values]) -> tuple[Limit, ...]:
    """Make the limits of values in which there is no fault."""
    given = ({name: value for name, value in limit.items() if name != "at"} for limit in limits)
    return tuple(Limit(**limit) for limit in given)
