"""Keys of the recipe of a cylindrical cam, with what they take, their defaults and what they mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.turned import program_files, turned_files
from camgeo.motions.inputs import Input
from camgeo.motions.motion import motion_field
from camgeo.part import bore
from camgeo.part.keyway import FEATURE as KEYWAY
from camgeo.part.part import DENSITY
from camgeo.recipe.export import export_of
from camgeo.recipe.figure_bounds import limits_of, verify_of
from camgeo.recipe.figures import LEAST_WALL, PRESSURE_ANGLE
from camgeo.recipe.keys import CORE
from camgeo.recipe.machining import MOST_RPM
from camgeo.recipe.materials import material
from camgeo.recipe.radii import radii_form
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm, length, mapping
from camgeo.schema.json_schema import number_schema
from camgeo.schema.read_scalar import read_numeric
from camgeo.schema.yaml_source import Scalar
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.registry.formats import Format
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Node

FLOOR_GAP = 0.5  # mm that a roller stands off the floor where the recipe does not say where it begins
OUTER, PITCH = "outer", "pitch"
MOST_TURNS = 40  # of one motion
APEX = "axis"  # of a cone whose apex is on the drum's axis
STEEPEST_CONE = 60  # degrees, half angle of a conical roller


def _read_taper(reader: Reader, field: Field, node: Node, path: str) -> float | str | None:
    """Read a half angle, rad, or the word for a cone with its apex on the axis; None after a fault."""
    if isinstance(node, Scalar) and node.text == APEX:
        return APEX
    faults = len(reader.errors)
    value = read_numeric(reader, replace(field, kind=Kind.ANGLE, form=None), node, path)
    if len(reader.errors) > faults:
        told = reader.errors[-1]
        reader.errors[-1] = replace(told, remedy=f"{told.remedy}, or {APEX} for an apex on the drum's axis")
    return value


def _taper_schema(field: Field) -> Schema:
    return {"anyOf": [{"enum": [APEX]}, number_schema(replace(field, kind=Kind.ANGLE, form=None))]}


_TAPER: OwnForm[Reader] = OwnForm(
    f"an angle above 0, or {APEX}", f"an angle, or {APEX} for an apex on the drum's axis", _read_taper, _taper_schema
)


def _place(name: str, about: str, default: str = "", *, required: bool = False) -> Field:
    return Field(name, Kind.LENGTH, about, default=default, required=required, at_least=-MOST, at_most=MOST)


_FOLLOWER = (
    Field(
        "kind",
        Kind.CHOICE,
        "what touches the drum",
        default="roller",
        choices=("roller", "shoe"),
        others="a conical roller is a roller with a taper",
    ),
    length("radius", "radius of the roller"),
    length("width", "width of a shoe, as wide as its groove: one in the shape of a boat that turns on its pin"),
    length("length", "length of a shoe from tip to tip; its sides are two arcs"),
    length("from", "where it begins to bear along its axis, from the cam's axis", default="the floor and 0.5 mm"),
    length("to", "where it ends", default="radius of the blank"),
    _place("offset", "distance of its axis from a radius of the drum, the way the contact runs on a turning drum", "0"),
    Field(
        "taper",
        Kind.OWN,
        "half angle of a conical roller, thicker outwards, or `axis` for an apex on the drum's axis",
        default="a cylinder",
        above=0,
        at_most=STEEPEST_CONE,
        form=_TAPER,
    ),
    length("at", "distance from the drum's axis at which a cone has its radius", default="middle of from and to"),
    mapping(
        "arm",
        "an arm in place of the carriage, swinging about an axis parallel to the roller's; lifts are angles",
        length("length", "from its pivot to the roller's axis; of a rib to the middle of both rollers", required=True),
        _place("offset", "distance of its pivot from the radius about which the roller swings", required=True),
        _place("pivot", "height of its pivot over the lower face", required=True),
        Field(
            "side",
            Kind.CHOICE,
            "trailing: the drum's surface runs from the pivot to the contact; leading: the other way",
            default="trailing",
            choices=("trailing", "leading"),
        ),
    ),
)
ROLLER = Field(
    "follower",
    Kind.TABLE,
    "the roller, on a carriage that travels along the cam's axis, or on an arm; or a shoe on a carriage",
    required=True,
    table=FieldTable(_FOLLOWER, alternatives=(("radius", ()), ("width", ("length",)))),
)
_DEPTH = length("depth", "depth below the blank", required=True)
TRACK = Field(
    "track",
    Kind.TABLE,
    "what leads the roller",
    required=True,
    table=FieldTable(
        (
            mapping(
                "groove",
                "a groove for one roller",
                _DEPTH,
                Field(
                    "clearance",
                    Kind.LENGTH,
                    "play of the roller, on the upper flank and square to it",
                    default="0",
                    at_least=0,
                    at_most=MOST,
                ),
            ),
            mapping(
                "rib",
                "a rib between two rollers",
                length(
                    "distance", "distance of their axes along the cam's axis; on an arm square to it", required=True
                ),
                _DEPTH,
            ),
            Field(
                "end",
                Kind.CHOICE,
                "an end face towards the top, with the metal below it, or towards the bottom, for a spring",
                choices=("top", "bottom"),
            ),
        ),
        alternatives=(("groove", ()), ("rib", ()), ("end", ())),
    ),
)
DRIVE = mapping(
    "drive",
    "how fast the drum turns, and what it carries",
    Field("rpm", Kind.NUMBER, "turns a minute", above=0, at_most=MOST_RPM),
    Field("load", Kind.NUMBER, "load on the follower along its way, N", above=0, at_most=MOST, unit=Kind.FORCE),
    material("material", "material of the drum"),
    material("roller_material", "that of the roller", default="that of the drum"),
)
CAM = FieldTable(
    (
        Field("kind", Kind.CHOICE, "a drum that turns about its axis", required=True, choices=("cylindrical",)),
        length("radius", "radius of the blank", required=True),
        TRACK,
        ROLLER,
        Field(
            "pitch_height",
            Kind.LENGTH,
            "height of the roller's axis at lift 0 over the lower face; of a rib's middle",
            required=True,
            at_least=-MOST,
            at_most=MOST,
        ),
        motion_field(
            "motion",
            Kind.STROKE,
            "lift, of an arm its swing, over one turn, 360 degrees, or over `turns`",
            over=Input(most=360 * MOST_TURNS),
            required=True,
        ),
        Field(
            "turns",
            Kind.INTEGER,
            "turns of the drum after which the motion repeats; only of a groove, which crosses itself then",
            default="1",
            at_least=1,
            at_most=MOST_TURNS,
        ),
        Field(
            "undercut",
            Kind.CHOICE,
            "what is done where the flank is undercut near the floor: an error, or contact begins farther out",
            default="refuse",
            choices=("refuse", "shorten"),
        ),
        DRIVE,
    )
)
PART = replace(
    mapping(
        "part",
        "the drum beside its track; angles from the roller's ray at shaft angle 0",
        length(
            "length",
            "length of the drum along its axis; of an end cam that of what lies within the flank",
            required=True,
        ),
        bore.FIELD,
        KEYWAY.field,
        length("wall", "least wall between any two edges", default="reported, and above 0"),
        DENSITY,
    ),
    required=True,
)
FIGURES = {
    PRESSURE_ANGLE: ("greatest pressure angle, mostly at the roller's inner end, degrees", Kind.ANGLE),
    f"{PRESSURE_ANGLE}-middle": ("greatest pressure angle in the middle of the roller, degrees", Kind.ANGLE),
    f"{PRESSURE_ANGLE}-outer": ("greatest pressure angle where the contact ends outside, degrees", Kind.ANGLE),
    "contact-length": ("least length of the line of contact", Kind.LENGTH),
    "carrying-share": ("least share of the roller's line that carries, from 0 to 1", Kind.NUMBER),
    "undercut-radius": ("distance from the axis within which a flank is undercut", Kind.LENGTH),
    "crossings": ("number of places at which a groove of several turns crosses itself", Kind.NUMBER),
    "crossing-angle": ("least angle between two tracks that cross, degrees", Kind.ANGLE),
    "crossing-gap": ("greatest length over which a track lacks a wall at a crossing", Kind.LENGTH),
    "shoe-play": ("greatest play of a shoe across its track, to either side, in a crossing", Kind.LENGTH),
    "shoe-twist": ("greatest play that a shoe needs as its track's slope is another at its inner end", Kind.LENGTH),
    "rib-thickness": ("least thickness of a rib along the axis", Kind.LENGTH),
    "off-radius": ("greatest distance of the roller's axis on an arm from a radius of the drum", Kind.LENGTH),
    "play": ("greatest play of the follower in a groove", Kind.STROKE),
    "mating-radius": ("least radius, of both bodies together, across the line of contact", Kind.LENGTH),
    "velocity": ("greatest velocity of the follower, a second", Kind.STROKE),
    "acceleration": ("greatest acceleration of the follower, a second squared", Kind.STROKE),
    "contact-force": ("greatest force between drum and roller, N", Kind.FORCE),
    "side-thrust": ("greatest force on the follower's guide, of an arm along it, N", Kind.FORCE),
    "axial-thrust": ("greatest force that pushes a conical roller outwards along its axis, N", Kind.FORCE),
    "torque": ("greatest torque that turns the drum against the load, N m", Kind.NUMBER),
    "contact-pressure": ("greatest pressure of the contact by Hertz, N/mm²", Kind.NUMBER),
    "contact-pressure-middle": ("greatest pressure by Hertz half way along the line of contact, N/mm²", Kind.NUMBER),
    "mass": ("mass, kg", Kind.NUMBER),
    LEAST_WALL: ("least wall between two edges of the drum", Kind.LENGTH),
}
"""Figures of a cylindrical cam that a recipe may limit, each with what it is and the kind of its values."""


LIMITS = limits_of(FIGURES)

FILES: dict[str, Format] = turned_files(
    "the flanks and the path of the roller's axis, unrolled",
    Field(
        "at",
        Kind.OWN,
        "radii at which it is unrolled",
        default="[outer, pitch]",
        form=radii_form({OUTER: "for the blank", PITCH: "for the path of the roller's axis"}),
    ),
    program_files(
        "diameter of the cutter, of one that tapers at its end; at most that of the roller",
        Field(
            "taper",
            Kind.ANGLE,
            "half angle of a cutter that tapers, thicker away from its end; at most that of the roller",
            default="a cylinder",
            above=0,
            at_most=STEEPEST_CONE,
        ),
    ),
    ("motion", "flank"),
    surfaces=True,
)
"""Formats of the files of a cylindrical cam, with the options that they take."""
MADE = mapping(
    "made",
    "how measured points of its flanks are judged",
    length("profile", "width of the tolerance zone of a flank, ISO 1101: half of it to either side"),
)
RECIPE = FieldTable(
    (
        *(CORE.field(name) for name in ("name", "about", "units", "rotation")),
        Field("cam", Kind.TABLE, "the drum", required=True, table=CAM),
        PART,
        export_of(FILES, "{dxf: {as: development, at: [outer, 38]}}", "[stl]"),
        verify_of(Kind.MOTION, "greatest motion error permitted, along the axis, of an arm an angle"),
        LIMITS,
        MADE,
    )
)
