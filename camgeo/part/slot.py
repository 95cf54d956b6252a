"""A slot with round ends through the disc, across a ray: a screw on its circle lets the cam be turned for timing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.feature import Callout, Feature, angle, check_below, optional
from camgeo.schema.fields import length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.part.feature import SheetView
    from camgeo.part.shapes import Opening
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class Slot:
    """Slot, `length` over its round ends, square to the ray at `at`, rad; its middle on a circle of diameter `circle`.

    Lengths are in mm.
    """

    length: float
    width: float
    circle: float
    at: float = 0.0


def _check(part: Values, reader: Reader) -> None:
    slot = part["slot"]
    if "length" in slot:
        check_below(reader, "part.slot.width", slot.get("width"), slot["length"], "its length")


def _openings(slot: Slot) -> list[Opening]:
    from camgeo.part.shapes import Opening, slot_across

    return [Opening("slot", "HOLES", slot_across(0.5 * slot.circle, slot.length, slot.width, slot.at))]


def _callouts(slot: Slot, view: SheetView) -> tuple[Callout, ...]:
    text = f"slot {view.number(slot.width)} × {view.number(slot.length)}"
    size = Callout(text, (f"across {view.degrees(slot.at)}",), points=view.edge("slot"))
    return size, view.circle("slot circle", slot.circle)


FEATURE = Feature(
    Slot,
    optional(
        "slot",
        "slot with round ends through the disc, square to a ray",
        length("length", "length over its ends", required=True),
        length("width", "width of the slot", required=True),
        length("circle", "diameter of the circle about the shaft that its middle lies on", required=True),
        angle("at", "direction of its middle"),
    ),
    holes=True,
    check=_check,
    openings=_openings,
    callouts=_callouts,
)
