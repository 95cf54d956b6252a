"""Options of a shop drawing in a recipe: their keys, and the record that they become."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from camgeo.common.rounding import NOISE
from camgeo.schema.fields import Field, FieldTable, Kind, length
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


TEXTS: Mapping[str, tuple[str, str]] = {
    "title": ("title of the part", ""),
    "number": ("drawing number", ""),
    "revision": ("index of the revision", ""),
    "date": ("date of issue", ""),
    "drawn": ("who drew it", ""),
    "approved": ("who approved it", ""),
    "owner": ("legal owner", ""),
    "material": ("material of the part", ""),
    "finish": ("surface finish", ""),
    "general": ("general tolerances", "ISO 2768-m"),
}
"""Texts of the title block by their options: what they are, and the text by default."""


@dataclass(frozen=True)
class Sheet:
    """The options of one drawing; `words` are the texts of the title block with their options.

    `scale` is a key of SCALES, None for the largest that fits; `step`, rad, is between rows of the contour's table;
    `profile` is the width of the tolerance zone, mm, None where the drawing states none.
    """

    words: tuple[tuple[str, str], ...]
    paper: str = "A3"
    projection: str = "first"
    scale: str | None = None
    step: float = math.radians(10.0)
    profile: float | None = None

    @property
    def texts(self) -> dict[str, str]:
        """Texts of the title block by their options."""
        return dict(self.words)

    @property
    def title(self) -> str:
        """Title of the part."""
        return self.texts["title"]


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
            default="10",
            at_least=LEAST_STEP,
            at_most=MOST_STEP,
        ),
        length("profile", "width of the contour's tolerance zone, ISO 1660", default="what another section states"),
        *(
            Field(name, Kind.TEXT, about, default="the recipe's name" if name == "title" else default or "empty")
            for name, (about, default) in TEXTS.items()
        ),
    )
)


def check_sheet(file: Values, _: Values, reader: Reader) -> None:
    """Add a fault for a step that does not divide 360 degrees."""
    step = file.get("step")
    if step is not None:
        turns = 2.0 * math.pi / step
        if abs(turns - round(turns)) > NOISE * turns:
            remedy = "give a step such as 5 or 10"
            reader.fault_at(f"{file['path']}.sheet.step", "does not divide 360 degrees", None, remedy)


def build_sheet(options: Mapping[str, Any]) -> Sheet:
    """Options of a drawing without faults, the step in rad."""
    values = {name: value for name, value in options.items() if value != AUTO or name != "scale"}
    texts = {name: values.pop(name, default) for name, (_, default) in TEXTS.items()}
    return Sheet(tuple(texts.items()), **values)
