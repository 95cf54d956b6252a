"""The schema of a recipe as data: one table that is read, checked, published and explained from."""

from __future__ import annotations

import re

from camgeo.recipe.spec import MOST, Field, Kind, Table, either, length, mapping
from camgeo.recipe.table_cam import CAMS
from camgeo.recipe.table_dynamics import DYNAMICS
from camgeo.recipe.table_figures import LIMITS
from camgeo.recipe.table_linkage import DYADS, LINKAGES
from camgeo.recipe.table_manufacture import COMPENSATION, MANUFACTURE
from camgeo.recipe.table_mechanism import MECHANISM
from camgeo.recipe.table_part import PART
from camgeo.recipe.table_sweep import DWELL, SWEEP

_TOLERANCE = length("tolerance", "greatest distance between this file's contour and the exact one", default="export's")
_PARTS = Field("parts", Kind.CHOICE, "the cam, or every body of the mechanism", default="cam", choices=("cam", "all"))
FILES: dict[str, Table] = {
    "dxf": Table(
        (
            Field(
                "as",
                Kind.CHOICE,
                "what the contour is made of",
                default="arcs",
                choices=("arcs", "polyline", "spline", "exact"),
            ),
            Field(
                "version",
                Kind.CHOICE,
                "version of the format; R12 has no splines",
                default="R2010",
                choices=("R12", "R2000", "R2010", "R2013"),
            ),
            _TOLERANCE,
            *COMPENSATION,
        ),
    ),
    "svg": Table(
        (
            Field(
                "as",
                Kind.CHOICE,
                "what the contour is made of",
                default="arcs",
                choices=("arcs", "polyline", "spline"),
            ),
            _TOLERANCE,
            *COMPENSATION,
        ),
    ),
    "stl": Table((_PARTS, _TOLERANCE, *COMPENSATION)),
    "3mf": Table((_PARTS, _TOLERANCE, *COMPENSATION)),
    "step": Table(
        (
            Field(
                "as",
                Kind.CHOICE,
                "what the contour is made of: cylinders and planes, or the surface that a spline sweeps",
                default="arcs",
                choices=("arcs", "spline", "exact"),
            ),
            _TOLERANCE,
            *COMPENSATION,
        ),
    ),
    "glb": Table((_PARTS, _TOLERANCE)),
    "csv": Table((Field("as", Kind.CHOICE, "which table it is", default="motion", choices=("motion", "inspection")),)),
    "html": Table(()),
    "gcode": Table((_TOLERANCE,)),
}

RECIPE = Table(
    (
        Field("name", Kind.NAME, "name of the output folder and of the files in it", default="the file's stem"),
        Field("about", Kind.TEXT, "a note that travels into the files", default="none"),
        Field("units", Kind.CHOICE, "unit of every length", default="mm", choices=("mm", "inch")),
        Field(
            "rotation",
            Kind.CHOICE,
            "sense in which the shaft turns, seen as drawn",
            default="cw",
            choices=("cw", "ccw"),
        ),
        Field("cam", Kind.CAM, "the cam, of exactly one kind", required=True),
        Field("linkage", Kind.LINKAGE, "the linkage whose coupler is the square frame around the cam", default="none"),
        PART,
        mapping(
            "export",
            "the files",
            length("tolerance", "greatest distance between a file's contour and the exact one", default="0.001 mm"),
            Field(
                "files",
                Kind.FILES,
                "dxf, svg, stl, 3mf, step, glb, csv, html, gcode, or mappings such as {dxf: {as: spline}}",
                default="[dxf]",
            ),
        ),
        mapping(
            "verify",
            "how each file is judged",
            Field(
                "angles",
                Kind.INTEGER,
                "number of shaft angles at which each file is judged",
                default="3600",
                at_least=8,
                at_most=1_000_000,
            ),
            Field(
                "motion_error",
                Kind.ERROR,
                "greatest motion error permitted: a length, or degrees where the follower swings",
                default="what the tolerance implies",
                above=0,
                at_most=MOST,
            ),
            Field(
                "output_error",
                Kind.OUTPUT,
                "greatest error permitted of the linkage's output, in degrees, or a length where it slides",
                default="what the tolerance implies",
                above=0,
                at_most=MOST,
            ),
        ),
        LIMITS,
        mapping("mechanism", "sizes of the printable bodies round the cam, for files with `parts: all`", *MECHANISM),
        mapping("dwell", "dwells of the linkage's output", *DWELL),
        mapping("sweep", "a search among designs", *SWEEP),
        Field(
            "dynamics",
            Kind.TABLE,
            "the follower train, whose forces, float and impacts at a speed are found",
            default="none",
            table=DYNAMICS,
        ),
        Field("manufacture", Kind.TABLE, "how the part is milled", default="none", table=MANUFACTURE),
    ),
)


def is_known(path: str, cam_kind: str, linkage_kind: str) -> bool:
    """Tell whether the schema has a field at a path such as `cam.pivot[0]`, whichever entry of a list it is in."""
    return field_at(path, cam_kind, linkage_kind) is not None


def field_at(path: str, cam_kind: str, linkage_kind: str) -> Field | None:
    """Find the field at a path, that of the whole list or mapping for an entry of points, numbers and harmonics."""
    table: Table | None = RECIPE
    field: Field | None = None
    for name in re.sub(r"\[[0-9]+\]", "", path).split("."):
        if field is not None and field.kind is Kind.HARMONICS:
            return field if name.isdecimal() else None
        if table is None or name not in table.keys:
            return None
        field = table.field(name)
        match field.kind:
            case Kind.CAM:
                table = CAMS.get(cam_kind)
            case Kind.LINKAGE:
                table = LINKAGES.get(linkage_kind)
            case Kind.DYADS:
                table = Table(tuple(item for dyad in DYADS.values() for item in dyad.fields))
            case _:
                table = field.table
    return field


def elsewhere(name: str, known: tuple[str, ...]) -> str:
    """Say where a key belongs that stands in the wrong place, or else which keys there are."""
    if name in RECIPE.keys:
        return "it belongs at the top level"
    groups = {"the file": FILES, "cam of kind": CAMS, "linkage of kind": LINKAGES, "a dyad of kind": DYADS}
    places = [item.name for item in RECIPE.fields if item.table and name in item.table.keys]
    places += [
        f"{group} {kind}" for group, kinds in groups.items() for kind, found in kinds.items() if name in found.keys
    ]
    if places:
        return f"it belongs under {either(tuple(places))}"
    return f"the keys here are {either(known, 'and')}" if known else "there are no keys here"
