"""The schema of the printable mechanism, as data."""

from __future__ import annotations

from camgeo.recipe.spec import length

MECHANISM = (
    length("clearance", "what a hole is wider than its pin, and faces are wider apart than the cam", default="0.2 mm"),
    length("gap", "what bodies that lie above one another are apart", default="0.4 mm"),
    length("press", "what a hole that is pressed on is narrower than its pin", default="0.1 mm"),
    length("space", "what bodies that never touch are apart in plan, where their size is free", default="1 mm"),
    length("pin", "diameter of the pins", default="by the cam's size"),
    length("bar", "width of bars, stems and guides", default="the pin and two walls"),
    length("plate", "thickness of the base plate", default="by the cam's size"),
    length("link", "thickness of arms, rockers and rods", default="the pin's diameter"),
    length("wall", "width of a frame's sides, and of the ring about a pin's hole", default="by the pin"),
    length("clip", "thickness of retaining discs and caps", default="2 mm, or by the pin"),
    length("knob", "diameter of the knob", default="by the cam's size"),
)
