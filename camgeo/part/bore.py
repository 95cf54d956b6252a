"""The bore round the shaft: a diameter, or its form, with flats or with a tolerance class."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.feature import angle
from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, length
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.read_scalar import read_numeric
from camgeo.schema.yaml_source import Scalar

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

LEAST_SIZE = 1e-3  # mm: least size of an opening or a boss; readers of files take much smaller ones for none
SIDES = {"square": 4, "hexagon": 6}
TABLE = FieldTable(
    (
        length("square", "width across flats of a square bore"),
        length("hexagon", "width across flats of a hexagonal bore"),
        angle("at", "direction of one flat's normal"),
        length("diameter", "diameter of a round bore with a tolerance class"),
        Field("fit", Kind.CHOICE, "its tolerance class of ISO 286", choices=("H7",)),
    ),
    alternatives=(("square", ()), ("hexagon", ()), ("diameter", ("fit",))),
)


def read_bore(reader: Reader, field: Field, node: Node, path: str) -> float | Values | None:
    """Diameter in mm, or values of the mapping of a bore with flats or with a tolerance class; None where it is faulty.

    Faults are noted in the reader.
    """
    if isinstance(node, Scalar):
        return read_numeric(reader, length(field.name, field.about), node, path)
    return reader.mapping(field, node, path)


FORM = OwnForm(
    "a bore",
    "a diameter above 0, or a form such as {square: 10}, {hexagon: 10} or {diameter: 20, fit: H7}",
    read_bore,
    lambda field: {"anyOf": [number_schema(length("", "")), table_schema(field.inner)]},
)
FIELD = Field(
    "bore",
    Kind.OWN,
    "diameter of the bore around the shaft, or its form",
    default="none",
    table=TABLE,
    unit=Kind.LENGTH,
    form=FORM,
)


def diameter_of(part: Values) -> float | None:
    """Diameter of a round bore, mm; None for a bore with flats, and without a bore."""
    bore = part.get("bore")
    diameter: float | None = bore.get("diameter") if isinstance(bore, dict) else bore
    return diameter


def width_of(part: Values) -> tuple[float | None, str]:
    """Diameter of a round bore or width across flats, mm, and the word for it, `diameter` or `width`.

    The size is None without a bore.
    """
    bore, diameter = part.get("bore"), diameter_of(part)
    if diameter is not None or bore is None:
        return diameter, "diameter"
    return next((bore[name] for name in SIDES if name in bore), None), "width"


def check_bore(part: Values, reader: Reader, shaping: list[str]) -> None:
    """Note faults of the bore in the reader.

    `shaping` are the keys of the features that shape a round bore: they do not go with flats, nor with each other. A
    round bore has no direction.
    """
    bore = part.get("bore")
    if diameter_of(part) is None:
        if bore is not None and not {"part.bore.diameter", "part.bore.fit"} & reader.marks.keys():
            for name in shaping:
                remedy = "give the bore's diameter, or leave it out"
                reader.fault_at(f"part.{name}", "needs a round bore", None, remedy)
        return
    if isinstance(bore, dict) and "at" in bore:
        reader.fault_at("part.bore.at", "a round bore has no flats", None, "leave it out")
    for name in shaping[1:]:
        reader.fault_at(f"part.{name}", f"cannot be combined with {shaping[0]}", None, "give one of them")


def build_bore(part: Values) -> Values:
    """Arguments of `Part` that describe its bore, by their names."""
    bore = part.get("bore")
    form: Values = bore if isinstance(bore, dict) else {}
    sides = next((SIDES[name] for name in SIDES if name in form), 0)
    return {"bore": width_of(part)[0], "sides": sides, "bore_at": form.get("at", 0.0), "fit": form.get("fit", "")}
