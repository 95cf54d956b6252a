"""Sizes of the printable bodies round the cam."""

from __future__ import annotations

from camgeo.schema.fields import length
from kin.numeric.records import dataclass


@dataclass(frozen=True)
class MechanismAsked:
    """Sizes of the printable mechanism.

    `clearance` is what a hole is wider than its pin, and what the faces stand farther apart than the cam's breadth;
    `gap` axial gap between bodies that lie above one another, `press` what is pressed on is too narrow by, `space` what
    bodies that never touch keep in plan by construction. `plate` is the thickness of the base, `link` that of arms,
    rockers and rods, `bar` their width, `wall` that of frames and hubs about a hole, `clip` the thickness of retainers.
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


MECHANISM = (
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
