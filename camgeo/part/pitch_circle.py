"""Holes on a circle about the shaft, and that circle's size on a shop drawing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.part.feature import Callout

if TYPE_CHECKING:
    from camgeo.part.feature import View
    from camgeo.part.shapes import Opening


def round_hole(name: str, circle: float, hole: float, angle: float) -> Opening:
    """Round opening of diameter `hole` whose centre lies on a circle of diameter `circle`, mm, at an angle, rad."""
    from camgeo.part.shapes import disc, polar

    return disc(name, "HOLES", polar(0.5 * circle, angle), 0.5 * hole)


def pitch_circle(view: View, name: str, diameter: float, half_turns: float) -> Callout:
    """Callout of a circle about the shaft, its leader at so many half turns."""
    text = f"Ø{view.number(diameter)}"
    return Callout(text, name, (0.0, 0.0), 0.5 * diameter, half_turns * math.pi, diameter)
