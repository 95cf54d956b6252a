"""Rings: a cam whose opening is followed from within; what its recipe needs, and what it cannot have."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.cams.groove import is_groove

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values

OF_A_DISC = ("bore", "keyway", "flat", "hub", "set_screw", "lightening", "chamfer", "mark")
"""Keys of a part that a ring cannot have."""


def check_ring(values: Values, reader: Reader) -> None:
    """Note a ring without its outline, an outline without its ring, and what a ring cannot have."""
    cam, given = values.get("cam"), "part.outer" in reader.marks
    if not is_ring(values):
        unread = cam is None or ("track" not in cam and "cam.track" in reader.marks)
        if given and not unread and not is_groove(values["cam"]):
            remedy = "give a disc cam with `track: internal` or a groove, or leave it out"
            reader.fault_at("part.outer", "belongs to a ring or a groove", None, remedy)
        return
    if not given:
        remedy = "give part.outer, or leave track out"
        reader.fault_at("cam.track", "a ring needs part.outer, the diameter of its outline", "internal", remedy)
    for name in OF_A_DISC:
        if f"part.{name}" in reader.marks:
            reader.fault_at(f"part.{name}", "belongs to a disc on a shaft, not to a ring", None, "leave it out")


def is_ring(values: Values) -> bool:
    """Whether the values of a recipe are of a ring."""
    return bool(values.get("cam", {}).get("track") == "internal")
