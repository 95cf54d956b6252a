"""Key `made.points`: the files of points of each run of parts, in the order in which they were made."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from camgeo.motions.lift_table import read_path
from camgeo.schema.fields import MOST_FILES, Field, Form, Kind, Table, length, mapping
from camgeo.schema.scalars import MOST_TEXT
from camgeo.schema.yaml_source import Mapping, Sequence, describe, join
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    import collections.abc

    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

ALIGN = {"none": "", "rotation": "g", "best-fit": "gxy"}
"""What `align` frees: unknowns of a placing by least squares."""
UNITS = {"mm": 1.0, "inch": 25.4}


@dataclass(frozen=True)
class PointFile:
    """A file of points, its path as seen from the recipe.

    units   mm in its unit where its heading states none; None for that of the recipe
    align   unknowns that are placed by least squares: of g, x, y
    ball    radius of the probe, mm; None for points of the metal, and for the follower's own of lifts
    face    width of an indicator's flat face, mm
    error   expanded uncertainty (k = 2) of a point, mm
    """

    file: str
    units: float | None = None
    align: str = ""
    ball: float | None = None
    face: float | None = None
    error: float | None = None


Run = tuple[PointFile, ...]


_FILE = Form(
    "the path of a file",
    "the path of a file of points, such as run1.csv",
    read_path,
    lambda _: {"type": "string", "minLength": 1, "maxLength": MOST_TEXT},
)
POINT_FILE = Table(
    (
        Field("file", Kind.OWN, "its path as seen from the recipe", required=True, form=_FILE),
        Field("units", Kind.CHOICE, "unit of a file whose heading states none", default="the recipe's", choices=UNITS),
        Field("align", Kind.CHOICE, "how the points are placed by least squares", default="none", choices=ALIGN),
        mapping(
            "probe",
            "what measured them",
            length("radius", "radius of the ball whose centres they are; of lifts, of its roller"),
            length("face", "width of the flat face of an indicator of lifts"),
            length("error", "expanded uncertainty (k = 2) of a point along its normal"),
        ),
    )
)


def _read(reader: Reader, field: Field, node: Node, path: str) -> tuple[Run, ...] | None:
    """Read runs: a file each, or a list of files that are taken together."""
    runs = []
    for i, item in enumerate(reader.items(field, node, path, MOST_FILES)):
        below = join(path, i)
        nodes = [(item, below)]
        if isinstance(item, Sequence):
            nodes = [(entry, join(below, k)) for k, entry in enumerate(reader.items(field, item, below, MOST_FILES))]
        files = [_point_file(reader, field, entry, place) for entry, place in nodes]
        runs.append(tuple(entry for entry in files if entry is not None))
    return tuple(runs) or None


def _point_file(reader: Reader, field: Field, node: Node, path: str) -> PointFile | None:
    if isinstance(node, Mapping):
        values: Values | None = reader.field(Field("", Kind.TABLE, "", table=POINT_FILE), node, path)
        if values is None or "file" not in values:
            return None
        probe = values.get("probe", {})
        units, align = UNITS.get(values.get("units", "")), ALIGN[values.get("align", "none")]
        return PointFile(values["file"], units, align, probe.get("radius"), probe.get("face"), probe.get("error"))
    if isinstance(node, Sequence):
        reader.fault(node.mark, path, "not the path of a file", describe(node), reader.wanted(field))
        return None
    name = read_path(reader, field, node, path)
    return None if name is None else PointFile(name)


def _schema(_: Field) -> Schema:
    from camgeo.schema.json_schema import table_schema

    file = {"anyOf": [{"type": "string", "minLength": 1, "maxLength": MOST_TEXT}, table_schema(POINT_FILE)]}
    some = {"type": "array", "items": file, "minItems": 1, "maxItems": MOST_FILES}
    return {"type": "array", "items": {"anyOf": [file, some]}, "minItems": 1, "maxItems": MOST_FILES}


POINTS = Field(
    "points",
    Kind.OWN,
    "files of points of parts, in the order made, each from the export before it; of one run in a list",
    form=Form(
        "a list of files of points",
        "a list of files of points such as [run1.csv, [run2a.csv, run2b.csv]]",
        _read,
        _schema,
        tables={"file": POINT_FILE},
        group="the points",
    ),
)


def _option_names() -> list[str]:
    """Options of `verify` that are keys of an entry, a dash before those of a mapping in it."""
    names = [field.name for field in POINT_FILE.fields if field.table is None]
    return [
        *names,
        *(f"{field.name}-{key.name}" for field in POINT_FILE.fields if field.table for key in field.inner.fields),
    ]


POINTS_PATH = f"made.{POINTS.name}"


def places_of(runs: collections.abc.Sequence[Run]) -> list[tuple[str, PointFile]]:
    """Each file of the runs with its place in the recipe."""
    return [each for i, run in enumerate(runs) for each in places_of_run(run, f"{POINTS_PATH}[{i}]")]


def places_of_run(run: Run, place: str) -> list[tuple[str, PointFile]]:
    """Each file of a run with its place, by that of the run."""
    return [(f"{place}[{k}]" if len(run) > 1 else place, file) for k, file in enumerate(run)]


def in_recipe(text: str) -> str:
    """Say by keys of a file's entry what a text says by options of `verify`."""
    return _OPTION.sub(lambda option: f"{option[1].replace('-', '.')}{option[2] and ':'}{option[2]}", text)


_OPTION = re.compile(rf"--({'|'.join(_option_names())})((?: (?:{'|'.join((*UNITS, *ALIGN, 'cm', 'm'))})\b)?)")
