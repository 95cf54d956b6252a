"""The diagrams of a camshaft by the forms of its SVG, and those that its page shows."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.camshaft.diagram import stacked
from camgeo.capabilities.camshaft.drawing import shaft_drawing
from camgeo.capabilities.camshaft.timing import bars
from camgeo.capabilities.camshaft.wheels import cam_wheel, crank_wheels

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe


def diagram(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], form: str | None) -> str:
    """Return the SVG of a form: `timing`, `bars`, `cam-wheel`, `crank-wheel` or `shaft`.

    `timing` is the wheel of the camshaft's turn for an engine, and bars for other shafts; wheels are of engines alone.
    """
    engine = recipe.engine
    if form == "shaft":
        return shaft_drawing(recipe, lobes)
    if form == "bars" or engine is None:
        return bars(recipe, lobes)
    return stacked(crank_wheels(recipe, lobes, engine)) if form == "crank-wheel" else cam_wheel(recipe, lobes, engine)


def shown(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> list[str]:
    """Return the diagrams of a page: of an engine its wheels first, then bars and the drawing of the shaft."""
    engine = recipe.engine
    wheels = [] if engine is None else [*crank_wheels(recipe, lobes, engine), cam_wheel(recipe, lobes, engine)]
    return [*wheels, bars(recipe, lobes), shaft_drawing(recipe, lobes)]
