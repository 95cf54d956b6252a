"""What a recipe says of the part as made: the zone of its profile, what fixes its axes, and points of runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.capabilities.made.runs import POINTS, places_of
from camgeo.part.features import with_records
from camgeo.schema.fields import Field, Kind, either, length, mapping
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.made.runs import Run
    from camgeo.part.part import Part
    from camgeo.recipe.export import FileRequest
    from camgeo.registry.formats import Form, Format
    from camgeo.schema.reader import Reader, Values
    from kin.made.points import Datum

DATUMS = ("part", "bore", "none")


@dataclass(frozen=True)
class Made:
    """Key `made`: width of the profile's zone, mm, and its datum; None where the recipe gives none.

    `points` are the points of parts that were made, run by run.
    """

    profile: float | None = None
    datum: Datum | None = None
    points: tuple[Run, ...] = ()


def fields() -> Sequence[Field]:
    """Give the key."""
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


def offered(record: Format) -> bool:
    """Files that show the contour itself, or cut or grind it, may be corrected; of tables, those that do."""
    return record.contour or any(_is_contour(form) for form in record.forms.values())


def _is_contour(form: Form) -> bool:
    """Whether a form of tables holds a contour: a grinder's, or points of a curve."""
    return form.ground or form.curve


def check(values: Values, reader: Reader) -> None:
    """Note files of points that are not there."""
    for place, file in places_of(values.get("made", {}).get("points", ())):
        if not (Path(reader.source.file).parent / file.file).is_file():
            remedy = "give its path as seen from the recipe's folder"
            reader.fault_at(place, "no such file", repr(file.file), remedy)


def check_corrected(request: FileRequest, values: Values, reader: Reader, path: str) -> None:
    """Note a corrected file without points, or of what is not corrected."""
    place = f"{path}.{request.kind}.{CORRECT.name}"
    if not (request.format.contour or _is_contour(request.form)):
        kinds = either(tuple(name for name, form in request.format.forms.items() if _is_contour(form)))
        reader.fault_at(place, f"belongs to a table as {kinds}", None, "leave it out")
    if "made.points" not in reader.marks:
        remedy = "give made.points, such as `made: {points: [run1.csv]}`, or leave it out"
        reader.fault_at(place, "there are no measured points to correct by", None, remedy)
    if values.get("cam", {}).get("undercut") == "trim":
        remedy = "give undercut: refuse, or leave it out"
        reader.fault_at(place, "a contour whose undercut is cut off is not corrected", None, remedy)


def build(values: Values) -> Made | None:
    """Make the value."""
    return Made(**values["made"]) if "made" in values else None


def datum_of(made: Made | None, part: Part) -> Datum:
    """Datum of a recipe: what it gives, or what its bore fixes."""
    if made is not None and made.datum is not None:
        return made.datum
    fixed = bool(part.sides) or any(feature.locates for feature, _ in with_records(part.features))
    return "part" if fixed else "none" if part.bore is None else "bore"
