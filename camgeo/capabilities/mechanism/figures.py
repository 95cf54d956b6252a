"""Figures of printed bodies, by which recipes limit them."""

from __future__ import annotations

from camgeo.recipe.design_figure import DesignFigure, Need
from camgeo.recipe.figures import LEAST_WALL
from camgeo.schema.fields import Kind

OF_BODIES = Need("a file with `parts: all`", lambda _, fields: "parts: all" in fields)
CLEARANCE, COLLISION = "clearance", "collision"
FIGURES = {
    CLEARANCE: DesignFigure(
        "least running clearance of the bodies", Kind.LENGTH, "most", OF_BODIES, swept=False, after=LEAST_WALL
    ),
    COLLISION: DesignFigure(
        "least distance between bodies over the turn", Kind.LENGTH, "most", OF_BODIES, swept=False, after=LEAST_WALL
    ),
}
