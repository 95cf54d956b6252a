"""Materials of bodies that touch: names, their figures, and the form in which a recipe states one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm, either
from camgeo.schema.json_schema import table_schema
from camgeo.schema.yaml_source import Mapping
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node


@dataclass(frozen=True)
class Material:
    """Young's modulus, N/mm^2, Poisson's ratio, and the contact pressure that the material bears, N/mm^2.

    `limit` is None where the recipe states none.
    """

    modulus: float
    poisson: float
    limit: float | None = None


MATERIALS = {
    "steel": Material(206_000.0, 0.3),
    "nodular-iron": Material(169_000.0, 0.275),
    "grey-iron": Material(110_000.0, 0.26),
    "bronze": Material(110_000.0, 0.34),
    "aluminium": Material(71_000.0, 0.33),
    "pom": Material(3_000.0, 0.35),
    "pa66": Material(3_000.0, 0.39),
}
"""Round figures of handbooks, for the pressure of contacts alone; none has a limit of its own."""


OWN_MATERIAL = FieldTable(
    (
        Field("E", Kind.NUMBER, "Young's modulus, N/mm²", required=True, above=0, at_most=MOST, unit=Kind.PRESSURE),
        Field("nu", Kind.NUMBER, "Poisson's ratio", required=True, at_least=0, at_most=0.5),
        Field(
            "limit",
            Kind.NUMBER,
            "pressure that it bears, N/mm²: reported, and not judged",
            above=0,
            at_most=MOST,
            unit=Kind.PRESSURE,
        ),
    )
)
"""Keys of a material that is stated by its figures."""


def _read(reader: Reader, field: Field, node: Node, path: str) -> Material | None:
    """Read a material's name, or a mapping with its figures; None after a fault."""
    if isinstance(node, Mapping):
        values = reader.table(OWN_MATERIAL, node, path)
        return Material(values["E"], values["nu"], values.get("limit")) if {"E", "nu"} <= values.keys() else None
    return MATERIALS.get(reader.readers[Kind.CHOICE](reader, field, node, path))


_FORM: OwnForm[Reader] = OwnForm(
    "a material",
    f"{either(tuple(MATERIALS))}, or {{E: 210000, nu: 0.3}}",
    _read,
    lambda _: {"anyOf": [{"enum": list(MATERIALS)}, table_schema(OWN_MATERIAL)]},
    instead=OWN_MATERIAL,
)


def material(name: str, about: str, *, default: str = "") -> Field:
    """Field of a `Material`: one of MATERIALS, or a mapping with its figures."""
    return Field(name, Kind.OWN, about, default=default, choices=tuple(MATERIALS), form=_FORM)


def check_materials(
    drive: Values,
    reader: Reader,
    *,
    loaded: bool,
    need: str = "load",
    keys: Sequence[str] = ("material", "roller_material"),
) -> None:
    """Note keys of `cam.drive` that stand without the load they need, and a roller's material without the cam's."""
    for key in keys:
        if key in drive and not loaded:
            remedy = "give load beside it, or leave it out"
            reader.fault_at(f"cam.drive.{key}", f"cannot stand without {need}", None, remedy)
    if "roller_material" in drive and "material" not in drive:
        reader.fault_at("cam.drive.roller_material", "cannot stand without material", None, "give material beside it")
