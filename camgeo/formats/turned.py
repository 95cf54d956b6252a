"""Formats of the files of a turning body, with their options, and what a recipe has to say of each program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.options import RECIPE_UNITS, SOLID_UNITS, TOLERANCE
from camgeo.recipe.export import requests
from camgeo.recipe.machining import BY_MINUTE, INVERSE, LEAST_PLACES, MANUFACTURE, MOST_PLACES
from camgeo.registry.formats import FORMATS, Form
from camgeo.registry.slot import NO_CHECK
from camgeo.schema.errors import quote
from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, either, length
from camgeo.schema.yaml_source import Scalar
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import ShaftOrder
    from camgeo.registry.formats import Format
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

DEVELOPMENT = "development"
"""Word of the drawing whose lines are laid round a cylinder."""
AXES = (("X", "A"), ("X", "Y", "A"))
"""Axes that a program may move beside Z."""
NEEDED = ("axes", "cutter", "feed", "plunge", "spindle", "safe_height")
"""Options that a program cannot do without."""
LEAST_TOLD = {"feed": 1e-3, "plunge": 1e-3, "safe_height": 1e-3, "allowance": 1e-4, "depth_of_cut": 1e-4}
"""Least figures of a program, in the recipe's unit: bounds against slips, far below what any machine keeps to."""


def _read_axes(reader: Reader, field: Field, node: Node, path: str) -> tuple[str, ...] | None:
    """Read the axes of a machine; None after a fault."""
    words = tuple(item.text.upper() if isinstance(item, Scalar) else "" for item in reader.items(field, node, path, 4))
    chosen = tuple(word for word in words if word != "Z")
    found = next((axes for axes in AXES if sorted(axes) == sorted(chosen)), None)
    if words and found is None:
        remedy = "give [X, A], or [X, Y, A] for a machine that moves across the cam, too"
        reader.fault(node.mark, path, "not the axes of such a machine", quote(", ".join(words)), remedy)
    return found


def _axes_schema(_: Field) -> Schema:
    return {"type": "array", "items": {"enum": ["X", "Y", "Z", "A"]}, "minItems": 2, "maxItems": 4}


_AXES: OwnForm[Reader] = OwnForm("a list of axes", "a list of axes such as [X, A]", _read_axes, _axes_schema)


def turned_files(
    unrolled: str, at: Field, programs: dict[str, Format], tables: tuple[str, ...], *, surfaces: bool = False
) -> dict[str, Format]:
    """Formats by their names: meshes, developments, programs, tables, pages; with `surfaces` solids of those too.

    `unrolled` says what a development shows, `at` is the key of its radii. `tables` are their words, the first the
    default.
    """
    form = Field("as", Kind.CHOICE, unrolled, default=DEVELOPMENT, choices=(DEVELOPMENT,))
    solids = {name: _solid(name, "triangles", SOLID_UNITS, TOLERANCE) for name in ("stl", "ply", "3mf")}
    if surfaces:
        solids["step"] = replace(_solid("step", "patches", SOLID_UNITS, TOLERANCE), check=NO_CHECK)
    table = Field("as", Kind.CHOICE, "which table it is", default=tables[0], choices=tables)
    step = Field("step", Kind.ANGLE, "shaft angle between rows", default="0.5", at_least=0.001, at_most=90)
    return {
        **solids,
        "glb": replace(_solid("glb", "triangles", TOLERANCE), contour=False),
        "dxf": replace(
            FORMATS["dxf"],
            options=FieldTable((form, at, RECIPE_UNITS, TOLERANCE)),
            forms={DEVELOPMENT: Form(name=DEVELOPMENT, pieces="lines")},
            check=NO_CHECK,
            contour=True,
        ),
        **programs,
        "csv": replace(
            FORMATS["csv"],
            options=FieldTable((table, step, RECIPE_UNITS)),
            forms={name: Form(name=name) for name in tables},
            check=NO_CHECK,
        ),
        "html": replace(FORMATS["html"], options=FieldTable(())),
    }


def _solid(name: str, pieces: str, *options: Field) -> Format:
    return replace(FORMATS[name], options=FieldTable(options), forms={"": Form(pieces=pieces)}, solid=False)


def program_files(cutter: str, *own: Field) -> dict[str, Format]:
    """Formats of programs by their names, with a meaning of the cutter's diameter and options beside it."""
    options = FieldTable(
        (
            Field(
                "axes",
                Kind.OWN,
                "axes that move beside Z: X along the cam, A about it, Y across it",
                required=True,
                form=_AXES,
            ),
            length("cutter", cutter, required=True),
            *own,
            length("feed", "feed along the path on the blank's radius, a minute", required=True),
            length("plunge", "feed towards the cam's axis, a minute", required=True),
            replace(MANUFACTURE.field("spindle"), about="speed of the spindle, turns a minute", required=True),
            length("depth_of_cut", "greatest depth of one pass", default="the depth of the track"),
            length("safe_height", "height above the blank at which the cutter moves fast", required=True),
            length("allowance", "metal that a last pass takes off each flank", default="no such pass"),
            Field(
                "feed_mode",
                Kind.CHOICE,
                "whether each block states the inverse of its time, G93, or the program one feed, G94",
                default=INVERSE,
                choices=(INVERSE, BY_MINUTE),
            ),
            Field(
                "decimals",
                Kind.INTEGER,
                "decimals of the axes' words",
                default="as many as the tolerance asks for",
                at_least=LEAST_PLACES,
                at_most=MOST_PLACES,
            ),
            RECIPE_UNITS,
            TOLERANCE,
        )
    )
    return {
        name: replace(record, options=options, check=NO_CHECK) for name, record in FORMATS.items() if record.program
    }


def program_asked(recipe: ShaftOrder, request: FileRequest | None, example: str) -> FileRequest:
    """The request by whose cutter a program is judged: its own, or the first program that the recipe asks for.

    Raises RecipeErrors where it asks for none, with an `example` of options.
    """
    asked = request or next((each for each in recipe.export.files if each.format.program), None)
    if asked is None:
        remedy = f"give export: {{files: [{{gcode: {{{example}}}}}]}}: a program is judged by its cutter"
        raise recipe.error("export.files", "no program is asked for", None, remedy)
    return asked


def developments_asked(recipe: ShaftOrder, request: FileRequest | None, files: dict[str, Format]) -> list[FileRequest]:
    """Requests with which a development is compared: its own, or all that the recipe has, or else the default one."""
    own = [request] if request is not None else [each for each in recipe.export.files if each.as_ == DEVELOPMENT]
    return own or list(requests([{"kind": "dxf"}], files))


def programs_in(values: Values, reader: Reader, example: str) -> list[Values]:
    """Programs that a recipe asks for, of those that say what they need; notes the others, and figures too small."""
    found = []
    for file in values.get("export", {}).get("files", []):
        record = FORMATS[file["kind"]]
        if not record.program:
            continue
        if "axes" not in file:  # the format's word alone
            remedy = f"give {either(NEEDED, 'and')}: {{{record.name}: {{{example}}}}}"
            reader.fault_at(file["path"], "a program needs its machine and cutter", None, remedy)
            continue
        for key, least in LEAST_TOLD.items():
            if key in file and file[key] < least * reader.mm:
                remedy, own = f"give at least {least:g} {reader.units}", f"{file[key] / reader.mm:.9g} {reader.units}"
                reader.fault_at(f"{file['path']}.{record.name}.{key}", "too little for a program", own, remedy)
        found.append(file)
    return found
