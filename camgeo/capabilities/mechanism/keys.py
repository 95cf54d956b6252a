"""Sizes of the printable bodies round the cam, and the files that show them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.discs import is_pair
from camgeo.recipe.machining import build_compensation
from camgeo.recipe.track import is_ring
from camgeo.schema.fields import Field, Kind, length, mapping
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class RequestedSizes:
    """Sizes of the printable mechanism that a recipe gives, mm; None for a size that follows from the cam.

    clearance  of a hole on its pin, in diameter, and of faces about the cam, both sides together
    gap        axial gap between bodies one above another
    press      interference of a pressed hole, in diameter
    space      gap in plan between bodies that never touch
    pin        diameter of the pins
    bar        width of bars, stems and guides
    plate      thickness of the base
    link       thickness of arms, rockers and rods
    wall       width of a frame's sides, and of the ring about a pin's hole
    clip       thickness of retainers and caps
    knob       width of the shaft's knob across flats
    """

    clearance: float = 0.2
    gap: float = 0.4
    press: float = 0.1
    space: float = 1.0
    pin: float | None = None
    bar: float | None = None
    plate: float | None = None
    link: float | None = None
    wall: float | None = None
    clip: float | None = None
    knob: float | None = None


SIZES = (
    length("clearance", "running clearance of holes on their pins, and of faces about the cam", default="0.2 mm"),
    length("gap", "axial gap between bodies that lie above one another", default="0.4 mm"),
    length("press", "interference of a pressed hole on its pin", default="0.1 mm"),
    length("space", "gap in plan between bodies that never touch, where their size is free", default="1 mm"),
    length("pin", "diameter of the pins", default="by the cam's size"),
    length("bar", "width of bars, stems and guides", default="the pin and two walls"),
    length("plate", "thickness of the base plate", default="by the cam's size"),
    length("link", "thickness of arms, rockers and rods", default="the pin's diameter"),
    length("wall", "width of a frame's sides, and of the ring about a pin's hole", default="by the pin"),
    length("clip", "thickness of retaining discs and caps", default="2 mm, or by the pin"),
    length("knob", "width of the knob across flats", default="by the cam's size"),
)
MECHANISM = mapping("mechanism", "sizes of the printable bodies round the cam, for files with `parts: all`", *SIZES)
PARTS = Field("parts", Kind.CHOICE, "the cam, or every body of the mechanism", default="cam", choices=("cam", "all"))


def fields() -> tuple[Field, ...]:
    """The key `mechanism` of a recipe, with the keys below it."""
    return (replace(MECHANISM, after="limits", unshown=("disc-conjugate", "disc-ring")),)


def build(values: Values) -> RequestedSizes:
    """Sizes of a recipe without faults, mm; the defaults without the key."""
    return RequestedSizes(**values.get("mechanism", {}))


def requested_sizes(recipe: Recipe) -> RequestedSizes:
    """Sizes that a recipe gives, mm; the defaults without the key."""
    return recipe.of(RequestedSizes) or RequestedSizes()


def check(file: Values, values: Values, reader: Reader) -> None:
    """Note, at the path of a file with `parts: all`, why its cam has no printable mechanism."""
    path: str = file["path"]
    if build_compensation(file) is not None:
        remedy = "give mechanism.clearance, which sets how the bodies fit, or leave `parts: all` out"
        reader.fault_at(path, "compensation of a whole mechanism", None, remedy)
    if values.get("cam", {}).get("preload") is not None:
        reader.fault_at(path, "the bodies round a preloaded cam are not made", None, "leave `parts: all` out")
    unsupported = "a ring" if is_ring(values) else "conjugate discs" if is_pair(values) else ""
    if unsupported:
        reader.fault_at(path, f"the bodies round {unsupported} are not made", None, "leave `parts: all` out")
    elif "part.bore" not in reader.marks:
        remedy = "give part.bore, such as {hexagon: 10}, or leave `parts: all` out"
        reader.fault_at(path, "a mechanism needs a bore for its shaft", None, remedy)
