"""The files that a recipe asks for."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

from camgeo.recipe.discs import is_pair
from camgeo.recipe.machining import COMPENSATION, Compensation, build_compensation, check_milling, check_slight
from camgeo.recipe.track import is_ring
from camgeo.schema.errors import shown, suggestion
from camgeo.schema.fields import MOST_FILES, Field, Form, Kind, Table, either, length, mapping
from camgeo.schema.yaml_source import Mapping, Scalar, described, is_empty, join
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    import collections.abc

    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node


Length: TypeAlias = Literal["mm", "inch"]


FileKind: TypeAlias = Literal["dxf", "svg", "stl", "3mf", "step", "glb", "csv", "html", "gcode"]


KINDS: tuple[FileKind, ...] = get_args(FileKind)


As: TypeAlias = Literal[
    "arcs",
    "polyline",
    "spline",
    "motion",
    "contacts",
    "polar",
    "inspection",
    "trace",
    "events",
    "timing",
    "bars",
    "cam-wheel",
    "crank-wheel",
    "shaft",
    "grinding",
    "lift",
]
"""Forms of files, by their key `as`."""


NO_CONTOUR = frozenset({"csv", "html", "glb"})
"""Kinds of file that hold no contour to be judged."""


NO_PART = NO_CONTOUR | {"gcode"}
"""Kinds of file that do not show the part itself."""


SOLIDS = frozenset({"stl", "3mf", "step", "glb"})
"""Kinds of file that hold a solid, which needs a thickness."""


BY_DISC = frozenset({"dxf", "svg", "stl", "gcode"})
"""Kinds of file of which each disc on a shaft has one of its own; of others one has all."""


ALL_PARTS: dict[FileKind, str] = {"stl": "cam", "3mf": "parts", "glb": "assembly"}
"""Ends of the name of the first file of all bodies."""


GROUND = frozenset({"grinding", "lift"})
"""Tables by which a lobe is ground."""


WHOLE = 1e-9  # rad by which steps may miss a turn


COARSEST, FINEST = 10.0, 1e-3  # degrees between rows of a grinder's table: one with finer ones is too large to read


SUFFIXES: dict[FileKind, str] = {"gcode": "ngc"}  # of kinds that are not their own


@dataclass(frozen=True)
class FileRequest:
    """One file to write.

    `as_` is of DXF, SVG, STEP and CSV, `version` of DXF; `tolerance` (mm) stands in for the export's own; a part that
    is made different from the nominal one has its `compensation`. `parts` is of solids: the cam, or all bodies of the
    mechanism. `units` is the file's own unit, None for the kind's (`told_in`). `step`, rad, is that of a grinder's
    table, `roller` the radius, mm, of the one whose lift is tabled.
    `overlays` are what a page shows besides.
    """

    kind: FileKind
    as_: As | None = None
    version: Literal["R12", "R2000", "R2010", "R2013"] | None = None
    tolerance: float | None = None
    compensation: Compensation | None = None
    parts: Literal["cam", "all"] = "cam"
    units: Length | None = None
    step: float | None = None
    roller: float | None = None
    overlays: tuple[str, ...] = ()

    @property
    def ground(self) -> bool:
        """Whether it is a table that a lobe is ground by, whose contour is judged."""
        return self.as_ in GROUND

    def told_in(self, units: Length) -> Length:
        """Give the unit of the file where the recipe's is `units`: its own, or the recipe's, but mm of a solid."""
        return self.units or ("mm" if self.kind in SOLIDS else units)

    def filename(self, name: str, requests: collections.abc.Sequence[FileRequest]) -> str:
        """Name the file among all `requests` of recipe `name`: no later one renames it.

        The first of a kind is `<name>.<kind>`, another is `<name>-<as>.<kind>`. After one that is alike in that it is
        `<name>-<as>-<version>.<kind>`, with `-kerf` and the like behind for a part that is not nominal, and `-inch` or
        `-mm` for a unit of its own. Of all bodies of a mechanism it is the first: `<name>-cam.stl`,
        `<name>-parts.3mf` or `<name>-assembly.glb`. A plain solid behind one that is not is `<name>-nominal.<kind>`.
        """
        before = requests[: requests.index(self)] if self in requests else requests
        kin = [request for request in before if request.kind == self.kind]
        parts = [name] if self.parts == "cam" else [name, ALL_PARTS[self.kind]]
        alike = [request for request in kin if request.as_ == self.as_]
        if kin and self.as_:
            parts.append(self.as_)
            if alike and self.version:
                parts.append(self.version)
        if alike and self.compensation:
            parts.append(self.compensation.tags)
        if alike and self.units and self.parts == "cam":
            parts.append(self.units)
        if len(parts) == 1 and any(request.compensation or request.units for request in alike):
            parts.append("nominal")
        return f"{'-'.join(parts)}.{SUFFIXES.get(self.kind, self.kind)}"

    def filenames(self, name: str, requests: collections.abc.Sequence[FileRequest], discs: int = 1) -> tuple[str, ...]:
        """Name every file with a cam of that many discs: one for all, or one for each disc."""
        whole = self.filename(name, requests)
        if discs == 1 or self.kind not in BY_DISC:
            return (whole,)
        return tuple(name_of_disc(whole, k) for k in range(discs))


def name_of_disc(filename: str, disc: int) -> str:
    """Name the file of one disc, counted from 0, after that of the cam: `<name>-1.dxf` for `<name>.dxf`."""
    stem, dot, suffix = filename.rpartition(".")
    return f"{stem}-{disc + 1}{dot}{suffix}"


@dataclass(frozen=True)
class Export:
    """The files, and the greatest distance (mm) between a file's contour and the exact one."""

    tolerance: float
    files: tuple[FileRequest, ...]

    @property
    def overlays(self) -> tuple[str, ...]:
        """What pages show over the mechanism, each once."""
        return tuple(dict.fromkeys(name for request in self.files for name in request.overlays))


_TOLERANCE = length("tolerance", "greatest distance between this file's contour and the exact one", default="export's")


_PARTS = Field("parts", Kind.CHOICE, "the cam, or every body of the mechanism", default="cam", choices=("cam", "all"))


def _units(default: str) -> Field:
    about = "unit of the file's numbers, which the file states where its format can"
    return Field("units", Kind.CHOICE, about, default=default, choices=("mm", "inch"))


_OF_RECIPE, _OF_SOLID = _units("the recipe's"), _units("mm")


OVERLAYS = {
    "instant-centres": "plate",
    "chord-polygon": "swings",
    "isoptic": "swings",
    "pedal": "swings",
    "evolute": "",
}
"""What a page can show over a mechanism, and what of its cam's offers that needs; a linkage leaves the evolute."""


def _read_overlays(reader: Reader, field: Field, node: Node, path: str) -> tuple[str, ...]:
    """Read the names of overlays, those that the cam's family has, each once."""
    linked = bool(reader.kinds["linkage"])
    there = [name for name, need in OVERLAYS.items() if not need or (need in reader.offers and not linked)]
    names: list[str] = []
    for i, item in enumerate(reader.items(field, node, path, len(OVERLAYS))):
        word = item.text if isinstance(item, Scalar) else ""
        if word in names:
            reader.fault(item.mark, join(path, i), "the same overlay twice", shown(word), "leave one out")
        elif word in there:
            names.append(word)
        elif word in OVERLAYS:
            of = "a linkage" if linked else f"a cam of kind {reader.kinds['cam']}"
            remedy = f"give {either(tuple(there))}"
            reader.fault(item.mark, join(path, i), f"an overlay that {of} does not have", shown(word), remedy)
        else:
            remedy = suggestion(word, tuple(there)) or f"give {either(tuple(there))}"
            reader.fault(item.mark, join(path, i), "no overlay", described(item), remedy)
    return tuple(names)


_OVERLAYS = Field(
    "overlays",
    Kind.OWN,
    "constructions shown over the mechanism, which turn with it, as far as its family has them",
    default="none",
    form=Form(
        "a list of overlays",
        f"a list of {either(tuple(OVERLAYS), 'and')}",
        _read_overlays,
        lambda _: {
            "type": "array",
            "items": {"enum": list(OVERLAYS)},
            "minItems": 1,
            "maxItems": len(OVERLAYS),
            "uniqueItems": True,
        },
    ),
)


FILES: dict[str, Table] = {
    "dxf": Table(
        (
            Field(
                "as",
                Kind.CHOICE,
                "what the contour is made of",
                default="arcs",
                choices=("arcs", "polyline", "spline"),
            ),
            Field(
                "version",
                Kind.CHOICE,
                "version of the format; R12 has no splines",
                default="R2010",
                choices=("R12", "R2000", "R2010", "R2013"),
            ),
            _OF_RECIPE,
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
            _OF_RECIPE,
            _TOLERANCE,
            *COMPENSATION,
        ),
    ),
    "stl": Table((_PARTS, _OF_SOLID, _TOLERANCE, *COMPENSATION)),
    "3mf": Table((_PARTS, _OF_SOLID, _TOLERANCE, *COMPENSATION)),
    "step": Table(
        (
            Field(
                "as",
                Kind.CHOICE,
                "what the contour is made of: cylinders and planes, or the surface that a spline sweeps",
                default="arcs",
                choices=("arcs", "spline"),
            ),
            _OF_SOLID,
            _TOLERANCE,
            *COMPENSATION,
        ),
    ),
    "glb": Table((_PARTS, _TOLERANCE)),
    "csv": Table(
        (
            Field(
                "as",
                Kind.CHOICE,
                "which table it is",
                default="motion",
                choices=("motion", "contacts", "polar", "inspection", "grinding", "lift", "trace", "forces"),
            ),
            Field(
                "step",
                Kind.ANGLE,
                "of grinding and lift, between rows; 360 degrees are a whole number of it",
                default="the largest that holds the tolerance",
                at_least=FINEST,
                at_most=COARSEST,
            ),
            length("roller", "of lift, diameter of the roller on a stem through the shaft whose lift it is"),
            _OF_RECIPE,
            _TOLERANCE,
        )
    ),
    "html": Table((_OVERLAYS,)),
    "gcode": Table((_OF_RECIPE, _TOLERANCE)),
}


def read_files(
    tables: collections.abc.Mapping[str, Table], reader: Reader, field: Field, node: Node, path: str
) -> list[Values]:
    """Read the list of files of these formats; each with its `kind`. A faulty one is left out."""
    found = []
    for i, item in enumerate(reader.items(field, node, path, MOST_FILES)):
        below = join(path, i)
        kind, options = _format(item)
        if kind is None:
            remedy = "give a format, or a mapping with one format such as {dxf: {as: spline}}"
            reader.fault(item.mark, below, "not a file", described(item), remedy)
            continue
        if kind.text not in tables:
            reader.fault(kind.mark, below, "unknown file format", shown(kind.text), f"give {either(tuple(tables))}")
        elif options is None:
            found.append({"kind": kind.text, "path": below})
        else:
            table = Field("", Kind.TABLE, "", table=tables[kind.text])
            values = reader.field(table, options, join(below, kind.text))
            if values is not None:
                found.append({"kind": kind.text, "path": below, **values})
    return found


def _format(node: Node) -> tuple[Scalar | None, Node | None]:
    """Take an entry of the list of files apart: `dxf`, or the format and options of `{dxf: {...}}`."""
    if isinstance(node, Scalar):
        return (None if is_empty(node) else node), None
    if isinstance(node, Mapping) and len(node.entries) == 1:
        key, options = node.entries[0]
        return (key if isinstance(key, Scalar) else None), options
    return None, None


def _files_schema(tables: collections.abc.Mapping[str, Table], _: Field) -> Schema:
    from camgeo.schema.json_schema import table_schema

    formats = [Field(kind, Kind.TABLE, "", required=True, table=table) for kind, table in tables.items()]
    items = {"anyOf": [{"enum": list(tables)}, *(table_schema(Table((item,))) for item in formats)]}
    return {"type": "array", "items": items, "minItems": 1, "maxItems": MOST_FILES}


def export_of(tables: collections.abc.Mapping[str, Table], example: str, default: str) -> Field:
    """Make the field of the files that are written, in these formats."""
    form = Form(
        "a list of files",
        "a list of files such as [dxf, stl]" if "dxf" in tables else f"a list of files such as {default}",
        partial(read_files, tables),
        partial(_files_schema, tables),
        tables=tables,
        group="the file",
    )
    return mapping(
        "export",
        "the files",
        length("tolerance", "greatest distance between a file's contour and the exact one", default="0.001 mm"),
        Field(
            "files",
            Kind.OWN,
            f"{', '.join(tables)}, or mappings such as {example}",
            default=default,
            form=form,
        ),
    )


EXPORT = export_of(FILES, "{dxf: {as: spline}}", "[dxf]")


def check_files(values: Values, reader: Reader) -> None:
    """Note the faults between the files that are asked for, and what they lack."""
    files: list[Values] = values.get("export", {}).get("files", [])
    listed = requests(files)
    names = [request.filename("NAME", listed) for request in listed]
    round_what = "a ring" if is_ring(values) else "conjugate discs" if is_pair(values) else ""
    if any(request.kind == "gcode" for request in listed):
        check_slight(values, reader)
    for i, (file, request) in enumerate(zip(files, listed, strict=True)):
        path = file["path"]
        if request.kind in SOLIDS and "part.thickness" not in reader.marks:
            remedy = f"give part.thickness, or leave {request.kind} out"
            reader.fault_at(path, f"{request.kind} needs a thickness", None, remedy)
        if request.parts == "all" and request.compensation is not None:
            remedy = "give mechanism.clearance, which sets how the bodies fit, or leave `parts: all` out"
            reader.fault_at(path, "compensation of a whole mechanism", None, remedy)
        if request.parts == "all" and round_what:
            reader.fault_at(path, f"the bodies round {round_what} are not made", None, "leave `parts: all` out")
        elif request.parts == "all" and "part.bore" not in reader.marks:
            remedy = "give part.bore, such as {hexagon: 10}, or leave `parts: all` out"
            reader.fault_at(path, "a mechanism needs a bore for its shaft", None, remedy)
        if request.as_ == "trace" and "linkage.trace" not in reader.marks:
            remedy = "give points such as linkage.trace: [{on: coupler, point: [40, 10]}]"
            reader.fault_at(f"{path}.csv.as", "needs linkage.trace", "'trace'", remedy)
        if request.kind == "gcode":
            check_milling(path, reader)
        if (request.kind, request.as_) == ("csv", "forces"):
            train = values.get("dynamics", {})
            if not train or "stiffness" in train:
                remedy = "give dynamics without stiffness, or leave this out"
                reader.fault_at(path, "a table of forces needs a train whose forces are found", None, remedy)
        if request.kind == "csv":
            _check_table(file, request, values, reader)
        if request.kind == "step" and request.as_ != "arcs" and "part.chamfer" in reader.marks:
            remedy = "give arcs, whose chamfers are exact cones, or leave part.chamfer out"
            reader.fault_at(f"{path}.step.as", "the chamfer of a spline is not a spline", f"'{request.as_}'", remedy)
        if request.as_ == "spline" and request.version == "R12":
            remedy = "give arcs or polyline, or a later version"
            reader.fault_at(f"{path}.dxf.as", "R12 has no splines", f"'{request.as_}'", remedy)
        if request in listed[:i]:
            reader.fault_at(path, "the same file twice", None, "leave one out")
        elif names[i] in names[:i]:
            name = names[i].removeprefix("NAME")
            remedy = "give each another `as` or `version`, or a recipe of its own"
            reader.fault_at(path, "a second file of one name", f"<name>{name}", remedy)


def _check_table(file: Values, request: FileRequest, values: Values, reader: Reader) -> None:
    """Note what a grinder's table lacks, and what belongs to one alone."""
    path, keys = f"{file['path']}.csv", ("step", "tolerance", "roller")
    for key in keys:
        if key in file and (not request.ground or (key == "roller" and request.as_ == "grinding")):
            kind = "lift" if key == "roller" else "grinding"
            reader.fault_at(f"{path}.{key}", f"belongs to a table as {kind}", None, "leave it out")
    if not request.ground:
        return
    if request.as_ == "grinding" and "manufacture.wheel" not in reader.marks:
        remedy = "give manufacture.wheel, its diameter, such as `manufacture: {wheel: 400}`"
        reader.fault_at(f"{path}.as", "a grinder's table needs the wheel", "'grinding'", remedy)
    if request.as_ == "lift" and "roller" not in file:
        reader.fault_at(f"{path}.as", "the lift of a roller needs its diameter", "'lift'", "give roller beside it")
    if request.step is not None:
        count = round(TURN / request.step)
        if abs(count * request.step - TURN) > WHOLE:
            remedy = f"give {360.0 / count:.9g} or another divisor of 360"
            reader.fault_at(f"{path}.step", "360 degrees are no whole number of it", None, remedy)
    if values.get("cam", {}).get("track", "external") != "external":
        reader.fault_at(f"{path}.as", "a wheel grinds the outside of a disc", None, "leave the table or track out")


TOLERANCE = 0.001  # mm


CHOSEN: dict[FileKind, Values] = {  # what a file is where its options do not say
    "dxf": {"as": "arcs", "version": "R2010"},
    "svg": {"as": "arcs"},
    "step": {"as": "arcs"},
    "csv": {"as": "motion"},
}


def requests(files: list[Values]) -> tuple[FileRequest, ...]:
    """Make the list of files."""
    return tuple(_request(file["kind"], file) for file in files)


def _request(kind: FileKind, file: Values) -> FileRequest:
    chosen = {**CHOSEN.get(kind, {}), **file}
    return FileRequest(
        kind,
        chosen.get("as"),
        chosen.get("version"),
        chosen.get("tolerance"),
        build_compensation(file),
        chosen.get("parts", "cam"),
        chosen.get("units"),
        chosen.get("step"),
        None if "roller" not in chosen else 0.5 * chosen["roller"],
        chosen.get("overlays", ()),
    )


def build_export(values: Values) -> Export:
    """Make the files of values in which there is no fault."""
    return Export(values.get("tolerance", TOLERANCE), requests(values.get("files", [{"kind": "dxf"}])))
