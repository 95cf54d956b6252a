"""The cam of a recipe: of one of the families, by the keys of its kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.cams.families import FAMILIES
from camgeo.common.on_demand import OnDemand
from camgeo.schema.readers import form_of_kinds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.cams.family import Cam
    from camgeo.schema.fields import Table
    from camgeo.schema.reader import Reader, Values

CAMS: Mapping[str, Table] = OnDemand(tuple(FAMILIES), lambda kind: FAMILIES[kind].table)
MADE = (
    "cams are made for one roller, also in a groove, for one knife edge, curved shoe or flat face on a stem or an arm, "
    "or for two on conjugate discs (disc), for a yoke of two parallel faces (constant-breadth, support) or two "
    "opposite rollers (constant-diameter), for two rollers on one oscillating arm (double-roller) and for two faces on "
    "one (flat-pair); cylindrical cams are not made"
)
"""Which followers there are cams for, in the error of a kind that is none."""


CAM = form_of_kinds("cam", CAMS, "cam of kind", MADE)


def check_cam(cam: Values, reader: Reader) -> None:
    """Note the faults between the fields of a cam."""
    if family := FAMILIES.get(cam.get("kind", "")):
        family.check(cam, reader)


def build_cam(cam: Values, mm: float) -> Cam:
    """Make the cam of values in which there is no fault; `mm` is the recipe's unit of length."""
    return FAMILIES[cam["kind"]].build(cam, mm)
