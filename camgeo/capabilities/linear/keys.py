"""Keys of the recipe of a linear cam: the plate, its guide and follower, how it is driven, what it is cut from."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from camgeo.formats.options import RECIPE_UNITS, TOLERANCE
from camgeo.motions.inputs import Input
from camgeo.motions.motion import MOST_REPEATS, motion_field
from camgeo.recipe.export import export_of
from camgeo.recipe.figure_bounds import limits_of, verify_of
from camgeo.recipe.figures import HOLLOW_RADIUS, LEAST_WALL, PRESSURE_ANGLE, RADIUS
from camgeo.recipe.keys import CORE
from camgeo.recipe.machining import MANUFACTURE, MOST_RPM
from camgeo.recipe.materials import material
from camgeo.recipe.recipe import Order
from camgeo.registry.formats import FORMATS, Form
from camgeo.registry.slot import NO_CHECK
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm, length, mapping
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.lists import list_of
from camgeo.schema.yaml_source import Mapping, Sequence, join
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from typing import ClassVar

    from camgeo.motions.motion import MotionSource
    from camgeo.part.mark import Mark
    from camgeo.recipe.figure_bounds import Bound
    from camgeo.recipe.machining import Manufacture
    from camgeo.recipe.materials import Material
    from camgeo.registry.formats import Format
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Node

MOST_OPENINGS = 50
TRAVEL = Input(Kind.LENGTH, "travel", MOST, "x")
RADIAL = ("roller", "shoe")
GROOVE_LAYER = "GROOVE"


@dataclass(frozen=True)
class Arm:
    """An arm: its length and the height of its pivot over the lower edge, mm; `side` trails or leads."""

    length: float
    pivot: float
    side: Literal["trailing", "leading"] = "trailing"


@dataclass(frozen=True)
class Follower:
    """Contact of the follower: its radius, mm, 0 of a knife edge; a stem that leans by `lean`, rad, or an arm."""

    kind: Literal["roller", "shoe", "knife-edge"]
    radius: float = 0.0
    lean: float = 0.0
    arm: Arm | None = None

    @property
    def name(self) -> str:
        """Name in reports."""
        return f"{self.kind.replace('-', ' ')} on {'a stem' if self.arm is None else 'an arm'}"


@dataclass(frozen=True)
class Ends:
    """Overrun: length of metal beyond the contacts at the first and the last input, mm, and its shape there."""

    overrun: tuple[float, float]
    tangent: bool = True


@dataclass(frozen=True)
class CrankDrive:
    """A crank that drives the plate to and fro: radius and rod, mm, and turns a minute."""

    radius: float
    rod: float
    rpm: float


@dataclass(frozen=True)
class Drive:
    """How the plate is driven, and what the follower loads it with.

    forth, back    speeds of the plate, mm/s; None under a crank or without a speed
    load           N along the guide, or on an arm at its roller, square to the arm; None without one
    width          of the contact, mm; None for the thickness of the plate
    """

    forth: float | None = None
    back: float | None = None
    crank: CrankDrive | None = None
    load: float | None = None
    width: float | None = None
    material: Material | None = None
    roller_material: Material | None = None


@dataclass(frozen=True)
class Groove:
    """A groove for the roller: clearance, depth, and the metal beyond its ends, mm.

    Without a depth no solid can be made; without a web the metal beyond each end is as long as the overrun there.
    """

    clearance: float
    depth: float | None = None
    web: float | None = None


@dataclass(frozen=True)
class Hole:
    """A round hole through the plate, centre and diameter in mm, in the axes of a plate that travels to the left."""

    at: tuple[float, float]
    diameter: float


@dataclass(frozen=True)
class Slot:
    """A slot with round ends through the plate: its middle, length over all and width, mm; rad from the x axis."""

    at: tuple[float, float]
    length: float
    width: float
    angle: float = 0.0


@dataclass(frozen=True)
class PlacedMark:
    """A mark upright about its middle, mm, engraved or cut as that of a disc."""

    at: tuple[float, float]
    mark: Mark


@dataclass(frozen=True)
class Plate:
    """Dimensions of the plate besides its flank, mm; `height` is that of a plate with a groove."""

    thickness: float | None = None
    chamfer: float = 0.0
    height: float | None = None
    holes: tuple[Hole, ...] = ()
    slots: tuple[Slot, ...] = ()
    mark: PlacedMark | None = None
    wall: float | None = None


@dataclass(frozen=True)
class LinearRecipe(Order):
    """A recipe of a linear cam; lengths in mm, angles in rad."""

    root: ClassVar[str] = "linear"

    base: float
    follower: Follower
    motion: MotionSource
    ends: Ends | None
    plate: Plate
    travel: Literal["left", "right"] = "left"
    periods: int = 1
    groove: Groove | None = None
    undercut: Literal["refuse", "trim"] = "refuse"
    steepest: float | None = None
    drive: Drive = Drive()
    manufacture: Manufacture | None = None
    limits: tuple[Bound, ...] = ()

    __repr__ = Order.__repr__

    @property
    def input_entries(self) -> dict[str, str]:
        """The way of the plate, for a report."""
        return {"travel": self.travel}

    @property
    def input_words(self) -> str:
        """The way of the plate, in words."""
        return f"the plate travels to the {self.travel}"

    @property
    def trims(self) -> bool:
        """Whether undercut is cut off, so that motion is lost."""
        return self.undercut == "trim"

    @property
    def endless(self) -> bool:
        """Whether the motion goes on from its end to its beginning."""
        return self.ends is None

    @property
    def swings(self) -> bool:
        """Whether the follower swings on an arm."""
        return self.follower.arm is not None

    @property
    def pitch(self) -> float:
        """Height of the follower's centre over the lower edge at lift 0, mm."""
        return self.base + self.follower.radius

    @property
    def rest(self) -> float:
        """Angle of the arm at lift 0, rad; 0 without one."""
        arm = self.follower.arm
        return 0.0 if arm is None else math.asin((self.pitch - arm.pivot) / arm.length)


# --- keys -------------------------------------------------------------------------------------------------------------


def _read_overrun(reader: Reader, field: Field, node: Node, path: str) -> tuple[float, float] | None:
    """Read one length for both ends, or [start, end]; None after a fault."""
    each = replace(field, kind=Kind.LENGTH, form=None)
    if not isinstance(node, Sequence):
        value: float | None = reader.field(each, node, path)
        return None if value is None else (value, value)
    if len(node.items) != 2:
        reader.fault(node.mark, path, f"{len(node.items)} lengths", None, "give one length, or two: [start, end]")
        return None
    first, last = (reader.field(each, item, join(path, i)) for i, item in enumerate(node.items))
    return None if first is None or last is None else (first, last)


def _overrun_schema(field: Field) -> Schema:
    one = number_schema(replace(field, kind=Kind.LENGTH, form=None))
    return {"anyOf": [one, {"type": "array", "items": one, "minItems": 2, "maxItems": 2}]}


_OVERRUN: OwnForm[Reader] = OwnForm(
    "a length, or two", "one length, or two: [start, end]", _read_overrun, _overrun_schema
)
_SEGMENTS = motion_field("segments", Kind.STROKE, "the segments of one period", over=TRAVEL, required=True)
_PERIODS = FieldTable(
    (Field("repeat", Kind.INTEGER, "number of periods that the plate has", at_least=1, at_most=MOST_REPEATS), _SEGMENTS)
)
_PLAIN = motion_field("motion", Kind.STROKE, "lift over the travel of the plate", over=TRAVEL, required=True)


def _read_motion(reader: Reader, field: Field, node: Node, path: str) -> tuple[MotionSource, int] | None:
    """Read a motion, with the number of its periods; None after a fault."""
    repeat = 1
    if isinstance(node, Mapping) and any(key.text == "segments" for key, _ in node.entries if hasattr(key, "text")):
        values = reader.table(_PERIODS, node, path)
        if "segments" not in values:
            return None
        source, repeat = values["segments"], values.get("repeat", 1)
    else:
        source = reader.field(replace(_PLAIN, name=field.name), node, path)
    return None if source is None else (source, repeat)


def _motion_schema(field: Field) -> Schema:
    form = _PLAIN.form
    if form is None:
        raise AssertionError(field.name)
    return {"anyOf": [form.schema(_PLAIN), table_schema(_PERIODS)]}


def _motion() -> Field:
    form = _PLAIN.form
    if form is None:
        raise AssertionError
    others = form.instead.fields if form.instead else ()
    instead = FieldTable((*_PERIODS.fields, *others))
    own: OwnForm[Reader] = OwnForm(form.noun, form.wanted, _read_motion, _motion_schema, instead=instead)
    return replace(_PLAIN, form=own)


def _angle(name: str, about: str, least: float, most: float, default: str) -> Field:
    return Field(name, Kind.ANGLE, about, default=default, at_least=least, at_most=most)


def _number(name: str, about: str, unit: Kind | None = None, default: str = "") -> Field:
    return Field(name, Kind.NUMBER, about, default=default, above=0, at_most=MOST, unit=unit)


FOLLOWER = mapping(
    "follower",
    "what touches the plate, and on what it is led",
    Field(
        "kind",
        Kind.CHOICE,
        "a roller, a fixed shoe of a radius, or a knife edge",
        default="roller",
        choices=("roller", "shoe", "knife-edge"),
        others="a flat face on a stem can only be a wedge, one on an arm is touched at infinity in a dwell: "
        "give a shoe of a large radius",
    ),
    length("radius", "radius of the roller or of the shoe"),
    _angle("lean", "angle by which the stem leans so that the rise is eased, the return loaded", -80, 80, "0"),
    mapping(
        "arm",
        "an arm in place of a stem",
        length("length", "from its pivot to the centre of the roller", required=True),
        Field(
            "pivot",
            Kind.LENGTH,
            "height of its pivot over the lower edge",
            required=True,
            at_least=-MOST,
            at_most=MOST,
        ),
        Field(
            "side",
            Kind.CHOICE,
            "whether it drags its roller over the plate or pushes it",
            default="trailing",
            choices=("trailing", "leading"),
        ),
    ),
)
ENDS = mapping(
    "ends",
    "the metal beyond the contacts at the first and the last input",
    Field(
        "overrun",
        Kind.OWN,
        "length of that metal along x, one or [start, end]",
        required=True,
        above=0,
        at_most=MOST,
        form=_OVERRUN,
    ),
    Field(
        "as",
        Kind.CHOICE,
        "how the flank goes on: along its end tangent, or level as in a dwell",
        default="tangent",
        choices=("tangent", "dwell"),
    ),
)
DRIVE = mapping(
    "drive",
    "how the plate is driven, and what it carries",
    length("forth", "speed of the plate on its way forth, a second"),
    length("back", "speed on its way back, a second", default="that of forth"),
    mapping(
        "crank",
        "a crank that drives the plate in place of a speed; twice its radius is the length of the motion",
        length("radius", "radius of the crank", required=True),
        length("rod", "length of the connecting rod", required=True),
        Field("rpm", Kind.NUMBER, "turns a minute", required=True, above=0, at_most=MOST_RPM),
    ),
    _number("load", "load along the guide, N, or at the roller square to an arm", Kind.FORCE),
    length("width", "length of the line of contact, of which its pressure is found", default="part.thickness"),
    material("material", "material of the plate"),
    material("roller_material", "that of what touches it", default="that of the plate"),
)
TRACK = mapping(
    "track",
    "what the follower runs in instead of on the upper edge",
    mapping(
        "groove",
        "a groove for a roller, closed by half circles at both ends",
        Field(
            "clearance",
            Kind.LENGTH,
            "play of the roller, square to the flanks",
            required=True,
            at_least=0,
            at_most=MOST,
        ),
        length("depth", "depth of the groove; solids need it"),
        length("web", "metal beyond each end of the groove", default="ends.overrun"),
    ),
)
SIZING = mapping(
    "sizing",
    "limits for which the travel is found: all lengths of the motion grow or shrink alike",
    mapping(
        PRESSURE_ANGLE,
        "greatest pressure angle, either way of travel",
        Field("at_most", Kind.ANGLE, "greatest magnitude", required=True, above=0, at_most=89),
    ),
)
CAM = FieldTable(
    (
        Field("kind", Kind.CHOICE, "a plate that travels along a straight guide", required=True, choices=("linear",)),
        Field(
            "base",
            Kind.LENGTH,
            "height of the contour over the lower edge at lift 0; of the lower flank of a groove",
            required=True,
            above=0,
            at_most=MOST,
        ),
        Field(
            "travel",
            Kind.CHOICE,
            "way of the plate while the motion runs from its first segment, as drawn; right mirrors all, holes too",
            default="left",
            choices=("left", "right"),
        ),
        FOLLOWER,
        _motion(),
        ENDS,
        Field("endless", Kind.TRUTH, "whether the motion is periodic, and the plate has no ends", default="false"),
        TRACK,
        Field(
            "undercut",
            Kind.CHOICE,
            "what is done where the roller is too large for a crest: an error, or motion is lost",
            default="refuse",
            choices=("refuse", "trim"),
        ),
        SIZING,
        DRIVE,
    )
)
_AT = Field("at", Kind.POINT, "its middle", required=True)
HOLE = FieldTable((_AT, length("diameter", "diameter", required=True)))
SLOT = FieldTable(
    (
        _AT,
        length("length", "length over its round ends", required=True),
        length("width", "width", required=True),
        _angle("angle", "direction of its length from the x axis", -180, 180, "0"),
    )
)
PART = mapping(
    "part",
    "the plate round the flank",
    length("thickness", "thickness of the plate; solids need it"),
    length("chamfer", "chamfer of 45 degrees along both edges of the outline", default="none"),
    length("height", "height of a plate with a groove", default="required for one"),
    list_of("holes", HOLE, "round holes", "[{at: [20, 10], diameter: 6.6}]", MOST_OPENINGS),
    list_of("slots", SLOT, "slots with round ends", "[{at: [60, 10], length: 12, width: 6}]", MOST_OPENINGS),
    mapping(
        "mark",
        "a mark, upright about its middle",
        _AT,
        Field("as", Kind.CHOICE, "engraved or cut through", default="engrave", choices=("engrave", "cut")),
        length("width", "width", default="0.5 mm"),
        length("length", "length", default="4 mm"),
        length("depth", "depth of an engraved mark", default="0.3 mm"),
    ),
    length("wall", "least wall between any two edges", default="reported, and above 0"),
)


FIGURES = {
    PRESSURE_ANGLE: ("greatest pressure angle, either way of travel, degrees", Kind.ANGLE),
    RADIUS: ("least radius of curvature of the flank where the metal is convex", Kind.LENGTH),
    HOLLOW_RADIUS: ("least radius of curvature of the flank where the metal is hollow", Kind.LENGTH),
    "lost-motion": ("greatest motion lost by trimmed undercut, along the path of the roller", Kind.LENGTH),
    "shoe-travel": ("length of the arc of a shoe that touches", Kind.LENGTH),
    "play": ("greatest play in a groove", Kind.STROKE),
    "travel": ("length of the motion, of one period where it is endless", Kind.LENGTH),
    "velocity": ("greatest velocity of the follower, a second", Kind.STROKE),
    "acceleration": ("greatest acceleration of the follower, a second squared", Kind.STROKE),
    "contact-force": ("greatest force between plate and follower, N", Kind.FORCE),
    "drive-force": ("greatest force along the travel that drives the plate, N", Kind.FORCE),
    "contact-pressure": ("greatest pressure of the contact by Hertz, N/mm²", Kind.FORCE),
    LEAST_WALL: ("least wall between two edges of the plate", Kind.LENGTH),
}
"""Figures of a linear cam that a recipe may limit, each with what it is and the kind of its values."""
LIMITS = limits_of(FIGURES)


TABLES = ("motion", "points", "inspection")
"""Tables of CSV, by their words."""


def _plain_format(name: str, *kept: str) -> Format:
    record = FORMATS[name]
    return replace(record, options=FieldTable(tuple(f for f in record.options.fields if f.name in kept)))


def _table_format() -> Format:
    form = Field("as", Kind.CHOICE, "which table it is", default="motion", choices=TABLES)
    step = Field("step", Kind.LENGTH, "travel between rows", default="a 720th of the motion", above=0, at_most=MOST)
    forms = {name: Form(name=name) for name in TABLES}
    return replace(FORMATS["csv"], options=FieldTable((form, step, RECIPE_UNITS)), forms=forms, check=NO_CHECK)


MESHES = ("stl", "ply", "3mf")
_DRAWN = ("as", "version", "units", "tolerance", "kerf")
FILES: dict[str, Format] = {
    "dxf": _plain_format("dxf", *_DRAWN),
    "svg": _plain_format("svg", *_DRAWN),
    **{name: _plain_format(name, "units", "tolerance") for name in MESHES},
    "step": replace(_plain_format("step", "units", "tolerance"), forms={"": FORMATS["step"].form("arcs")}),
    "glb": replace(_plain_format("glb", "tolerance"), contour=False),
    **{
        name: replace(record, options=FieldTable((RECIPE_UNITS, TOLERANCE)), check=NO_CHECK)
        for name, record in FORMATS.items()
        if record.program
    },
    "csv": _table_format(),
    "html": replace(FORMATS["html"], options=FieldTable(())),
}
"""Formats of the files of a linear cam, with the options that they take."""
_MILLED = ("cutter", "feed", "plunge", "spindle", "depth_of_cut", "safe_height", "lead_in", "direction", "holes")
RECIPE = FieldTable(
    (
        *(CORE.field(name) for name in ("name", "about", "units")),
        Field("cam", Kind.TABLE, "the plate", required=True, table=CAM),
        PART,
        export_of(FILES),
        verify_of(Kind.ERROR, "greatest motion error permitted: a length, or degrees where the follower swings"),
        LIMITS,
        Field(
            "manufacture",
            Kind.TABLE,
            "how the plate is milled",
            default="none",
            table=FieldTable(tuple(MANUFACTURE.field(name) for name in _MILLED)),
        ),
    )
)
