"""Keys of the recipe of an indexing cam, with what they take, their defaults and what they mean."""

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
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, length, mapping
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.registry.formats import Format

FLOOR_GAP = 0.5  # mm that a roller stands off the floor where the recipe does not say where it ends
LEAST_STOPS, MOST_STOPS = 2, 60
MOST_INERTIA = 1e6  # kg m^2
OUTER = "outer"
MIDDLE, INNER, OUTSIDE, ANY = (f"{PRESSURE_ANGLE}-{word}" for word in ("middle", "inner", "outer", "any"))
LENGTH, RIB, LEAST, MOST_ENGAGED = "contact-length", "rib-thickness", "engaged-least", "engaged-most"

EXAMPLE = "axes: [X, Y, A], cutter: 18, feed: 300, plunge: 60, spindle: 2500, safe_height: 5"
NO_PROGRAM = "no program is made of a globoid: its rollers swing in a plane with its axis, which takes a fifth axis"
SOLID_OF_IT = "give stl, 3mf or ply to the software of a machine with five axes"

BARREL = mapping(
    "barrel",
    "a barrel: the rollers' axes are parallel to the turret's axis, which is parallel to a radius of the cam",
    length("radius", "radius of the blank", required=True),
    Field(
        "offset",
        Kind.LENGTH,
        "distance of the turret's axis from that radius, above 0 against the way the cam's surface moves",
        default="half of turret.radius times 1 + cos(180°/stops); below 0 of a leading turret",
        at_least=-MOST,
        at_most=MOST,
    ),
)
GLOBOID = mapping(
    "globoid",
    "a globoid: the rollers are radial on the turret, whose axis is square to the cam's",
    length("distance", "distance of the turret's axis from the cam's", required=True),
    length("radius", "radius of the blank's throat about the turret's axis", required=True),
)
TURRET = Field(
    "turret",
    Kind.TABLE,
    "the turret and its rollers, which are cylinders",
    required=True,
    table=FieldTable(
        (
            Field(
                "stops",
                Kind.INTEGER,
                "stops of a whole turn of the turret, each with a roller",
                required=True,
                at_least=LEAST_STOPS,
                at_most=MOST_STOPS,
            ),
            length("radius", "of a barrel's turret: from its axis to the rollers' axes"),
            length("roller", "radius of a roller", required=True),
            length(
                "from",
                "where a roller begins to bear: of a barrel from its axis, of a globoid from the turret's",
                default="a barrel's floor and 0.5 mm; radius of a globoid's throat",
            ),
            length(
                "to",
                "where it ends",
                default="radius of a barrel's blank; where the end of a globoid's roller stands 0.5 mm off the floor",
            ),
            Field(
                "height",
                Kind.LENGTH,
                "height of the turret's axis over the lower face",
                default="half of part.length",
                at_least=-MOST,
                at_most=MOST,
            ),
            Field(
                "start",
                Kind.ANGLE,
                "angle of a roller where the motion begins, from the plane across the cam's axis, above 0 upwards",
                default="-180°/stops: the rib between two rollers holds the dwell",
                at_least=-180,
                at_most=180,
            ),
            Field(
                "side",
                Kind.CHOICE,
                "trailing: the barrel's surface runs from the turret's axis to the contact; leading: the other way",
                default="trailing",
                choices=("trailing", "leading"),
            ),
            Field(
                "clearance",
                Kind.LENGTH,
                "clearance of a roller in the groove, square to the upper flank",
                default="0",
                at_least=0,
                at_most=MOST,
            ),
            length("preload", "by how much the roller of the upper flank is smaller: it is pressed on the rib"),
        )
    ),
)
DRIVE = mapping(
    "drive",
    "how fast the cam turns, and what the turret carries",
    Field("rpm", Kind.NUMBER, "turns of the cam a minute", above=0, at_most=MOST_RPM),
    Field("load", Kind.NUMBER, "torque against the turret's motion, N m", above=0, at_most=MOST, unit=Kind.MOMENT),
    Field(
        "inertia",
        Kind.NUMBER,
        "moment of inertia of the turret and its load about the turret's axis, kg m²",
        above=0,
        at_most=MOST_INERTIA,
    ),
    material("material", "material of the cam"),
    material("roller_material", "that of the rollers", default="that of the cam"),
)
CAM = FieldTable(
    (
        Field("kind", Kind.CHOICE, "a cam that advances a turret", required=True, choices=("indexing",)),
        BARREL,
        GLOBOID,
        length("depth", "depth of the groove below the blank", required=True),
        TURRET,
        motion_field(
            "motion",
            Kind.STROKE,
            "angle of the turret over one turn of the cam, 360 degrees; it ends 360/stops degrees further on",
            over=Input(most=360),
            required=True,
        ),
        DRIVE,
    ),
    alternatives=(("barrel", ()), ("globoid", ())),
)
PART = replace(
    mapping(
        "part",
        "the cam beside its groove; angles from the radius that faces the turret at shaft angle 0",
        length("length", "length of the cam along its axis", required=True),
        bore.FIELD,
        KEYWAY.field,
        length("wall", "least wall between any two edges", default="reported, and above 0"),
        DENSITY,
    ),
    required=True,
)
FIGURES = {
    PRESSURE_ANGLE: (
        "greatest pressure angle of the roller that is best placed at each shaft angle, degrees",
        Kind.ANGLE,
    ),
    MIDDLE: ("greatest pressure angle in the middle of that roller's line of contact, degrees", Kind.ANGLE),
    INNER: ("greatest pressure angle at the end of that line nearer to `from`, degrees", Kind.ANGLE),
    OUTSIDE: ("greatest pressure angle at the end of that line nearer to `to`, degrees", Kind.ANGLE),
    ANY: ("greatest pressure angle of any roller, of one that just leaves the cam too, degrees", Kind.ANGLE),
    LENGTH: ("least length, over the turn, of the longest line along which a flank bears on a roller", Kind.LENGTH),
    LEAST: ("least number of rollers that a flank bears on at once", Kind.NUMBER),
    MOST_ENGAGED: ("greatest number of rollers that a flank bears on at once", Kind.NUMBER),
    RIB: ("least thickness of the rib between two rollers, across the turret's radius", Kind.LENGTH),
    "play": ("greatest play of the turret, to first order in the clearance, degrees", Kind.ANGLE),
    "mating-radius": ("least equivalent radius of curvature of cam and roller, across a line of contact", Kind.LENGTH),
    "velocity": ("greatest velocity of the turret, degrees a second", Kind.ANGLE),
    "acceleration": ("greatest acceleration of the turret, degrees a second squared", Kind.ANGLE),
    "turret-torque": ("greatest torque on the turret, of load and inertia, N m", Kind.NUMBER),
    "torque": ("greatest torque that turns the cam, or holds it back, N m", Kind.NUMBER),
    "contact-force": ("greatest force between cam and roller, N", Kind.FORCE),
    "contact-pressure": ("greatest pressure of the contact by Hertz, N/mm²", Kind.NUMBER),
    "mass": ("mass, kg", Kind.NUMBER),
    LEAST_WALL: ("least wall between two edges of the cam", Kind.LENGTH),
}
"""Figures of an indexing cam that a recipe may limit, each with what it is and the kind of its values."""

LIMITS = limits_of(FIGURES)

FILES: dict[str, Format] = turned_files(
    "the flanks, unrolled",
    Field(
        "at",
        Kind.OWN,
        "radii at which they are unrolled",
        default=f"[{OUTER}]",
        form=radii_form({OUTER: "for the blank"}),
    ),
    program_files("diameter of the cutter; at most that of the smaller roller"),
    ("motion",),
)
"""Formats of the files of an indexing cam, with the options that they take."""
RECIPE = FieldTable(
    (
        *(CORE.field(name) for name in ("name", "about", "units", "rotation")),
        Field("cam", Kind.TABLE, "the cam and its turret", required=True, table=CAM),
        PART,
        export_of(FILES, "{dxf: {as: development, at: [outer, 38]}}", "[stl]"),
        verify_of(Kind.MOTION, "greatest error of the turret's angle permitted"),
        LIMITS,
    )
)
