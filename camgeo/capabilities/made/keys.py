"""Key `made` of a recipe: the zone of the profile, the datum of its axes, and files of points of earlier runs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.motions.lift_table import read_path
from camgeo.part.features import with_records
from camgeo.registry.formats import FORMATS
from camgeo.schema.errors import quote
from camgeo.schema.fields import MOST_FILES, Field, FieldTable, Kind, OwnForm, either, length, mapping
from camgeo.schema.file_bytes import path_fault
from camgeo.schema.scalars import MOST_TEXT
from camgeo.schema.yaml_source import Mapping, describe, join
from camgeo.schema.yaml_source import Sequence as YamlSequence
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.part.part import Part
    from camgeo.registry.formats import Form as TableForm
    from camgeo.registry.formats import Format
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.made.points import Datum

DATUMS = ("part", "bore", "none")
ALIGN = {"none": "", "rotation": "g", "best-fit": "gxy"}
"""Unknowns of a placing by least squares, by the word after `align`: g a turn, x and y shifts."""
UNITS = {"mm": 1.0, "inch": 25.4}


@dataclass(frozen=True)
class PointFile:
    """A file of points; None for what its entry does not give.

    file    its path as seen from the recipe
    units   mm in its unit where its heading states none; None for the recipe's unit
    align   unknowns of a placing by least squares: letters of g (turn), x, y (shifts)
    ball    radius of the probe, mm; None for points of the metal, and for lifts of the follower itself
    face    width of the flat face of an indicator of lifts, mm
    error   expanded uncertainty (k = 2) of a point, mm
    """

    file: str
    units: float | None = None
    align: str = ""
    ball: float | None = None
    face: float | None = None
    error: float | None = None


Run = tuple[PointFile, ...]


@dataclass(frozen=True)
class Made:
    """Key `made`: width of the profile's zone, mm, and its datum; None where the recipe does not give them.

    `points` are the files of points of earlier runs, in the order in which the parts were made.
    """

    profile: float | None = None
    datum: Datum | None = None
    points: tuple[Run, ...] = ()


# --- the key ----------------------------------------------------------------------------------------------------------

_FILE = OwnForm(
    "the path of a file",
    "the path of a file of points, such as run1.csv",
    read_path,
    lambda _: {"type": "string", "minLength": 1, "maxLength": MOST_TEXT},
)
POINT_FILE = FieldTable(
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
    """Read runs, each a file or a list of files that are taken together; None for an empty list or a fault."""
    runs = []
    for i, run in enumerate(reader.items(field, node, path, MOST_FILES)):
        below = join(path, i)
        nodes = [(run, below)]
        if isinstance(run, YamlSequence):
            nodes = [(entry, join(below, k)) for k, entry in enumerate(reader.items(field, run, below, MOST_FILES))]
        files = [_point_file(reader, field, entry, place) for entry, place in nodes]
        runs.append(tuple(entry for entry in files if entry is not None))
    return tuple(runs) or None


def _point_file(reader: Reader, field: Field, node: Node, path: str) -> PointFile | None:
    """Read a file of points, a path or a mapping; None where a fault was noted."""
    if isinstance(node, Mapping):
        values: Values | None = reader.field(Field("", Kind.TABLE, "", table=POINT_FILE), node, path)
        if values is None or "file" not in values:
            return None
        probe = values.get("probe", {})
        units, align = UNITS.get(values.get("units", "")), ALIGN[values.get("align", "none")]
        return PointFile(values["file"], units, align, probe.get("radius"), probe.get("face"), probe.get("error"))
    if isinstance(node, YamlSequence):
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
    form=OwnForm(
        "a list of files of points",
        "a list of files of points such as [run1.csv, [run2a.csv, run2b.csv]]",
        _read,
        _schema,
        tables={"file": POINT_FILE},
        group="the points",
    ),
)

POINTS_PATH = f"made.{POINTS.name}"
ZONE_PATH = "made.profile"


def files_of_run(run: Run, place: str) -> list[tuple[str, PointFile]]:
    """Pairs of the path in the recipe and the file, for each file of a run; `place` is the run's, `made.points[1]`."""
    return [(f"{place}[{k}]" if len(run) > 1 else place, file) for k, file in enumerate(run)]


_OPTION_KEYS = (
    f"{field.name}-{key.name}" if field.table else field.name
    for field in POINT_FILE.fields
    for key in (field.inner.fields if field.table else (field,))
)
_OPTION = re.compile(rf"--({'|'.join(_OPTION_KEYS)})((?: (?:{'|'.join((*UNITS, *ALIGN, 'cm', 'm'))})\b)?)")


def in_recipe(text: str) -> str:
    """A text with the options of `verify` in it replaced by the keys of a file's entry, such as `probe.radius`."""
    return _OPTION.sub(lambda option: f"{option[1].replace('-', '.')}{option[2] and ':'}{option[2]}", text)


def fields() -> Sequence[Field]:
    """The field `made` of a recipe's top level."""
    zone = length("profile", "width of the tolerance zone of the contour, ISO 1101: half of it to either side")
    about = "what fixes the axes of the profile: part as measured, bore leaves it to turn, none to shift as well"
    datum = Field("datum", Kind.CHOICE, about, default="by the bore", choices=DATUMS)
    return (
        replace(
            mapping("made", "how a made part is judged by points measured on it", zone, datum, POINTS), after="verify"
        ),
    )


CORRECT = Field(
    "correct",
    Kind.NUMBER,
    "share of the summed deviations of made.points that is taken off the contour",
    default="0",
    at_least=0,
    at_most=1.5,
)


LEAVE, TAKE = "leave", "take"
LOCAL = Field(
    "local",
    Kind.CHOICE,
    "whether local faults that a single run has are left on the contour, or taken off with the rest",
    default=LEAVE,
    choices=(LEAVE, TAKE),
)


def offered(record: Format) -> bool:
    """Whether files of a format may be corrected: files with the contour, and tables of which a form has it."""
    return record.contour or any(_is_contour(form) for form in record.forms.values())


def _is_contour(form: TableForm) -> bool:
    """Whether a form of tables holds a contour: a grinder's, or points of a curve."""
    return form.ground or form.curve


def check(values: Values, reader: Reader) -> None:
    """Note entries of `made.points` that lead to no file."""
    for i, run in enumerate(values.get("made", {}).get("points", ())):
        for place, file in files_of_run(run, f"{POINTS_PATH}[{i}]"):
            if fault := path_fault(Path(reader.source.file).parent / file.file):
                remedy = "give its path as seen from the recipe's folder"
                reader.fault_at(place, fault, quote(file.file), remedy)


def check_corrected(file: Values, values: Values, reader: Reader) -> None:
    """Note faults of a file that is to be corrected.

    They are a file without a contour, a recipe without points of earlier runs, and a contour whose undercut is cut off.
    """
    place, record = f"{file['path']}.{file['kind']}.{CORRECT.name}", FORMATS[file["kind"]]
    if not (record.contour or _is_contour(record.form(file.get("as")))):
        kinds = either(tuple(name for name, form in record.forms.items() if _is_contour(form)))
        reader.fault_at(place, f"belongs to a table as {kinds}", None, "leave it out")
    if "made.points" not in reader.marks:
        remedy = "give made.points, such as `made: {points: [run1.csv]}`, or leave it out"
        reader.fault_at(place, "there are no measured points to correct by", None, remedy)
    if values.get("cam", {}).get("undercut") == "trim":
        remedy = "give undercut: refuse, or leave it out"
        reader.fault_at(place, "a contour whose undercut is cut off is not corrected", None, remedy)


def build(values: Values) -> Made | None:
    """Value of the key `made`; None for a recipe without it."""
    return Made(**values["made"]) if "made" in values else None


def datum_of(made: Made | None, part: Part) -> Datum:
    """Datum of the profile that a recipe gives, else one by what fixes the part on its shaft.

    `part` where a feature fixes the angle, else `bore`, or `none` without a bore.
    """
    if made is not None and made.datum is not None:
        return made.datum
    fixed = bool(part.sides) or any(feature.locates for feature, _ in with_records(part.features))
    return "part" if fixed else "none" if part.bore is None else "bore"
