"""What a recipe says of the printable bodies round the cam: lengths in mm, None where they follow from the cam."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class MechanismAsked:
    """Sizes of the printable mechanism.

    `clearance` is what a hole is wider than its pin, and what the faces stand farther apart than the cam's breadth;
    `gap` what bodies that lie above one another are apart, `press` what is pressed on is too narrow by, `space` what
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
