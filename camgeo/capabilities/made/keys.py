"""What a recipe says of the part as made: the zone of its profile, and what fixes its axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.fields import Field, Kind, length, mapping
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.part import Part
    from camgeo.schema.reader import Values
    from kin.made.points import Datum

DATUMS = ("part", "bore", "none")


@dataclass(frozen=True)
class Made:
    """How a made part is judged: width of its profile's zone, mm, and its datum; None where the recipe gives none."""

    profile: float | None = None
    datum: Datum | None = None


def fields() -> Sequence[Field]:
    """Give the key."""
    zone = length("profile", "width of the tolerance zone of the contour, ISO 1101: half of it to either side")
    about = "what fixes the axes of the profile: part as measured, bore leaves it to turn, none to shift as well"
    datum = Field("datum", Kind.CHOICE, about, default="by the bore", choices=DATUMS)
    return (
        replace(mapping("made", "how a made part is judged by points measured on it", zone, datum), after="verify"),
    )


def build(values: Values) -> Made | None:
    """Make the value."""
    return Made(**values["made"]) if "made" in values else None


def datum_of(made: Made | None, part: Part) -> Datum:
    """Datum of a recipe: what it gives, or what its bore fixes."""
    if made is not None and made.datum is not None:
        return made.datum
    fixed = part.keyway is not None or part.flat is not None or bool(part.sides) or part.dowel is not None
    return "part" if fixed else "none" if part.bore is None else "bore"
