"""The cam of a recipe, by the keys of its family."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.cams.families import FAMILIES
from camgeo.common.on_demand import OnDemand
from camgeo.registry.root import kinds
from camgeo.schema.readers import form_of_kinds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.cams.family import Cam
    from camgeo.schema.fields import FieldTable, OwnForm
    from camgeo.schema.reader import Reader, Values

CAMS: Mapping[str, FieldTable] = OnDemand(tuple(FAMILIES), lambda kind: FAMILIES[kind].table)
MADE = (
    "disc cams are made for one roller, also in a groove, for one knife edge, curved shoe or flat face on a stem or an "
    "arm, or for two on conjugate discs (disc), for a yoke of two parallel faces (constant-breadth, support) or two "
    "opposite rollers (constant-diameter), for two rollers on one oscillating arm (double-roller) and for two faces on "
    "one (flat-pair)"
)
"""Followers that there are disc cams for, in the error of an unknown kind."""


def _form() -> OwnForm[Reader]:
    """Form of the cam; the error of an unknown kind says what cams of other recipes are made for, and that is all."""
    others = kinds()
    made = [MADE, *(f"{words} ({kind})" for kind, words in others.items()), "other cams are not made"]
    return form_of_kinds("cam", CAMS, "cam of kind", "; ".join(made), tuple(others))


CAM = _form()


def check_cam(cam: Values, reader: Reader) -> None:
    """Note the faults between the fields of a cam."""
    if family := FAMILIES.get(cam.get("kind", "")):
        family.check(cam, reader)


def check_tappet(values: Values, reader: Reader) -> None:
    """Note keys that do not go with a round tappet, and a lobe beyond it; set the follower's `width` and `beyond`.

    `values` are the whole recipe's, and change in place. The line of contact runs across the lobe's thickness. The
    tappet's axis is `axial_offset` beside the lobe's middle, so the lobe's farther edge is `beyond` the axis by the
    offset and half the thickness, mm. The whole line lies on the round face if its end there does: the chord at that
    distance, mm, is the width. Neither is set without a `diameter`, on an arm, or for a lobe beyond the tappet.
    """
    follower, path = values.get("cam", {}).get("follower", {}), "cam.follower"
    if "axial_offset" in follower and f"{path}.diameter" not in reader.marks:
        reader.fault_at(f"{path}.axial_offset", "belongs to a round tappet", None, "give diameter, or leave it out")
    if "diameter" not in follower or "arm" in follower:
        return
    if f"{path}.width" in reader.marks:
        reader.fault_at(f"{path}.width", "cannot be combined with diameter", None, "give one of them")
    beyond = abs(follower.get("axial_offset", 0.0)) + 0.5 * values.get("part", {}).get("thickness", 0.0)
    if not beyond < 0.5 * follower["diameter"]:
        diameter, least = (
            f"{length / reader.mm:.6g} {reader.units}" for length in (follower["diameter"], 2.0 * beyond)
        )
        reader.fault_at(f"{path}.diameter", "the lobe reaches beyond the tappet", diameter, f"give more than {least}")
        return
    follower |= {"width": math.sqrt(follower["diameter"] ** 2 - 4.0 * beyond * beyond), "beyond": beyond}


def build_cam(cam: Values, mm: float) -> Cam:
    """Build the cam from values of a recipe without faults; `mm` is the recipe's unit of length, mm."""
    return FAMILIES[cam["kind"]].build(cam, mm)
