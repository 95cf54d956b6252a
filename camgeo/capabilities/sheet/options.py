"""What a recipe says of a shop drawing: its keys, and the record that they become."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from camgeo.common.rounding import NOISE
from camgeo.schema.fields import Field, Kind, Table, length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.schema.reader import Reader, Values

SCALES: Mapping[str, float] = {
    **{f"{k}:1": float(k) for k in (50, 20, 10, 5, 2, 1)},
    **{f"1:{k}": 1.0 / k for k in (2, 5, 10, 20, 50, 100, 200, 500, 1000)},
}
"""Scales of ISO 5455, from enlarging to reducing."""
AUTO, LEAST_STEP, MOST_STEP = "auto", 0.5, 90.0  # degrees


@dataclass(frozen=True)
class Sheet:
    """The options of one drawing; `scale` is None for the largest that fits, `step` in rad, `profile` in mm."""

    paper: str = "A3"
    projection: str = "first"
    scale: str | None = None
    step: float = math.radians(10.0)
    profile: float | None = None
    title: str = ""
    number: str = ""
    revision: str = ""
    date: str = ""
    drawn: str = ""
    approved: str = ""
    owner: str = ""
    material: str = ""
    finish: str = ""
    general: str = "ISO 2768-m"

    @property
    def texts(self) -> Mapping[str, str]:
        """Texts of the title block by their options."""
        return {
            "title": self.title,
            "number": self.number,
            "revision": self.revision,
            "date": self.date,
            "drawn": self.drawn,
            "approved": self.approved,
            "owner": self.owner,
            "material": self.material,
            "finish": self.finish,
            "general": self.general,
        }


def _text(name: str, about: str, default: str = "empty") -> Field:
    return Field(name, Kind.TEXT, about, default=default)


OPTIONS = Table(
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
            default="10",
            at_least=LEAST_STEP,
            at_most=MOST_STEP,
        ),
        length("profile", "width of the contour's tolerance zone, ISO 1660", default="what another section states"),
        _text("title", "title of the part", "the recipe's name"),
        _text("number", "drawing number"),
        _text("revision", "index of the revision"),
        _text("date", "date of issue"),
        _text("drawn", "who drew it"),
        _text("approved", "who approved it"),
        _text("owner", "legal owner"),
        _text("material", "material of the part"),
        _text("finish", "surface finish"),
        _text("general", "general tolerances", "ISO 2768-m"),
    )
)


def check_sheet(file: Values, _: Values, reader: Reader) -> None:
    """Note a step by which a turn cannot be divided."""
    step = file.get("step")
    if step is not None:
        turns = 2.0 * math.pi / step
        if abs(turns - round(turns)) > NOISE * turns:
            remedy = "give a step such as 5 or 10"
            reader.fault_at(f"{file['path']}.sheet.step", "does not divide 360 degrees", None, remedy)


def build_sheet(options: Mapping[str, Any]) -> Sheet:
    """Make the drawing of options in which there is no fault."""
    return Sheet(**{name: value for name, value in options.items() if value != AUTO or name != "scale"})
