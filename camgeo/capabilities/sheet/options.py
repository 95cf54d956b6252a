"""Options of a shop drawing in a recipe: their keys, and the record that they become."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

from camgeo.common.rounding import NOISE
from camgeo.schema.errors import quote
from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, length
from camgeo.schema.json_schema import table_schema
from camgeo.schema.read_scalar import read_text
from camgeo.schema.yaml_source import Mapping as YamlMapping
from camgeo.schema.yaml_source import Scalar, describe
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

SCALES: Mapping[str, float] = {
    **{f"{k}:1": float(k) for k in (50, 20, 10, 5, 2, 1)},
    **{f"1:{k}": 1.0 / k for k in (2, 5, 10, 20, 50, 100, 200, 500, 1000)},
}
"""Scales of ISO 5455, from enlarging to reducing."""
AUTO, LEAST_STEP, MOST_STEP = "auto", 0.5, 90.0  # degrees


TEXTS: Mapping[str, tuple[str, str]] = {
    "title": ("title of the part", ""),
    "number": ("drawing number", ""),
    "revision": ("index of the revision", ""),
    "date": ("date of issue", ""),
    "drawn": ("who drew it", ""),
    "approved": ("who approved it", ""),
    "owner": ("legal owner", ""),
    "material": ("material of the part", ""),
    "general": ("general tolerances", "ISO 2768-m"),
}
"""Texts of the title block by their options: what they are, and the text by default."""


@dataclass(frozen=True)
class Sheet:
    """The options of one drawing; `words` are the texts of the title block with their options.

    `scale` is a key of SCALES, None for the largest that fits; `step`, rad, is between rows of the contour's table,
    None for one that is chosen; `profile` is the width of the tolerance zone, mm, None where the drawing states none;
    `rough` has pairs of a surface, `contour` or `bore`, and its roughness.
    """

    words: tuple[tuple[str, str], ...]
    paper: str = "A3"
    projection: str = "first"
    scale: str | None = None
    step: float | None = None
    profile: float | None = None
    rough: tuple[tuple[str, str], ...] = ()

    @property
    def texts(self) -> dict[str, str]:
        """Texts of the title block by their options."""
        return dict(self.words)

    @property
    def title(self) -> str:
        """Title of the part."""
        return self.texts["title"]


def _read_roughness(reader: Reader, field: Field, node: Node, path: str) -> str | None:
    """Roughness such as `Ra 0.8`; None where it is faulty, which is noted."""
    found = _ROUGHNESS.fullmatch(node.text.strip()) if isinstance(node, Scalar) else None
    if found is None or not 0.0 < float(found[2]) <= ROUGHEST:
        given = quote(node.text) if isinstance(node, Scalar) else describe(node)
        reader.fault(node.mark, path, "not a roughness", given, reader.wanted(field))
        return None
    return f"{found[1]} {found[2]}"


_ROUGHNESS = re.compile(r"(Ra|Rz) ?([0-9]{1,3}(?:\.[0-9]{1,3})?)", re.ASCII)
ROUGHEST = 400.0  # micrometres
_VALUE = OwnForm(
    "a roughness",
    "Ra or Rz in micrometres, such as Ra 0.8",
    _read_roughness,
    lambda _: {"type": "string", "pattern": f"^{_ROUGHNESS.pattern}$"},
)
FINISH = FieldTable(
    (
        Field("contour", Kind.OWN, "roughness of the contour, ISO 21920", form=_VALUE),
        Field("bore", Kind.OWN, "roughness of the bore", form=_VALUE),
    )
)


def _read_finish(reader: Reader, field: Field, node: Node, path: str) -> object:
    """A text, or pairs of a surface and its roughness; None where it is faulty, which is noted."""
    if not isinstance(node, YamlMapping):
        return read_text(reader, Field(field.name, Kind.TEXT, field.about), node, path)
    if not node.entries:
        reader.fault(node.mark, path, "no surface is named", None, "give {contour: Ra 0.8}, or leave it out")
        return None
    values = reader.mapping(field, node, path)
    return None if values is None else tuple(values.items())


_FINISH = OwnForm(
    "a finish",
    "a text, or a mapping such as {contour: Ra 0.8, bore: Ra 1.6}",
    _read_finish,
    lambda field: {"anyOf": [{"type": "string"}, table_schema(field.inner)]},
)
OPTIONS = FieldTable(
    (
        Field(
            "paper",
            Kind.CHOICE,
            "size of the pages, ISO 216",
            default="A3",
            choices=("A3", "A4"),
            others="give A3 or A4: sizes of ANSI, and larger ones, are not drawn",
        ),
        Field(
            "projection",
            Kind.CHOICE,
            "first or third angle, ISO 5456-2",
            default="first",
            choices=("first", "third"),
        ),
        Field(
            "scale",
            Kind.CHOICE,
            "scale of the views, ISO 5455; auto is the largest that fits",
            default=AUTO,
            choices=(AUTO, *SCALES),
        ),
        Field(
            "step",
            Kind.ANGLE,
            "between rows of the contour's table; 360 degrees are a whole number of it",
            default="chosen by the profile's zone",
            at_least=LEAST_STEP,
            at_most=MOST_STEP,
        ),
        length("profile", "width of the contour's tolerance zone, ISO 1660", default="what another section states"),
        *(
            Field(name, Kind.TEXT, about, default="the recipe's name" if name == "title" else default or "empty")
            for name, (about, default) in TEXTS.items()
        ),
        Field(
            "finish",
            Kind.OWN,
            "surface finish: symbols on the drawing, or a text",
            default="empty",
            table=FINISH,
            form=_FINISH,
        ),
    )
)


def check_sheet(file: Values, _: Values, reader: Reader) -> None:
    """Note a step that does not divide 360 degrees, and the roughness of a bore that is not there."""
    finish = file.get("finish")
    if isinstance(finish, tuple) and "bore" in dict(finish) and "part.bore" not in reader.marks:
        reader.fault_at(f"{file['path']}.sheet.finish.bore", "the part has no bore", None, "leave it out")
    step = file.get("step")
    if step is not None:
        turns = 2.0 * math.pi / step
        if abs(turns - round(turns)) > NOISE * turns:
            remedy = "give a step such as 5 or 10"
            reader.fault_at(f"{file['path']}.sheet.step", "does not divide 360 degrees", None, remedy)


def build_sheet(options: Mapping[str, Any]) -> Sheet:
    """Options of a drawing without faults, the step in rad."""
    values = {name: value for name, value in options.items() if value != AUTO or name != "scale"}
    finish = values.pop("finish", "")
    rough = finish if isinstance(finish, tuple) else ()
    texts = {name: values.pop(name, default) for name, (_, default) in TEXTS.items()}
    texts["finish"] = "as drawn" if rough else finish
    return Sheet(tuple(texts.items()), rough=rough, **values)
