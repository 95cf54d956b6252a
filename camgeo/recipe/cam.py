"""The cam of a recipe: of one of the families, by the keys of its kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.cams.families import FAMILIES
from camgeo.schema.fields import Field, Form, Table
from camgeo.schema.json_schema import one_of_schema

if TYPE_CHECKING:
    from camgeo.cams.family import Cam
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

CAMS: dict[str, Table] = {kind: family.table for kind, family in FAMILIES.items()}
MADE = (
    "cams are made for one roller, knife edge, curved shoe or flat face on a stem or an arm (disc), for a yoke of two "
    "parallel faces (constant-breadth, support) or two opposite rollers (constant-diameter), for two rollers on one "
    "oscillating arm (double-roller) and for two faces on one (flat-pair); grooves, conjugate and cylindrical cams are "
    "not made"
)
"""Which followers there are cams for, in the error of a kind that is none."""


def read_cam(reader: Reader, field: Field, node: Node, path: str) -> Values | None:
    """Read the cam by the table of its kind."""
    return reader.one_of(field, node, path)


CAM = Form(
    "a cam",
    "a mapping with the kind of cam and its fields",
    read_cam,
    lambda _: one_of_schema("cam", CAMS),
    tables=CAMS,
    group="cam of kind",
    others=MADE,
)


def check_cam(cam: Values, reader: Reader) -> None:
    """Note the faults between the fields of a cam."""
    if family := FAMILIES.get(cam.get("kind", "")):
        family.check(cam, reader)


def build_cam(cam: Values, mm: float) -> Cam:
    """Make the cam of values in which there is no fault; `mm` is the recipe's unit of length."""
    return FAMILIES[cam["kind"]].build(cam, mm)
