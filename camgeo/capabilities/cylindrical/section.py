"""Section `drum` of the report of a cylindrical cam: its sizes, and all figures with their shaft angles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.cylindrical.shoe import angle_of
from camgeo.measures.placed import figure_entry

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.measures.placed import Figure


def drum_section(design: DrumDesign, figures: Sequence[Figure]) -> dict[str, Any]:
    """The section as plain data, in the recipe's unit, angles in degrees."""
    recipe = design.recipe
    section: dict[str, Any] = {
        "radius": recipe.radius / recipe.mm,
        "floor": recipe.floor / recipe.mm,
        "from": recipe.roller.inner / recipe.mm,
        "to": recipe.roller.outer / recipe.mm,
        **({"shoe": recipe.roller.shoe / recipe.mm} if recipe.roller.shoe is not None else {}),
        **({"taper_deg": math.degrees(recipe.roller.taper)} if recipe.roller.taper else {}),
        "figures": [figure_entry(recipe, figure, 1.0) for figure in figures],
    }
    undercuts = [
        {"flank": name, "inside": tip.r / recipe.mm, "at_deg": math.degrees(tip.at) % math.degrees(recipe.period)}
        for name, found in design.tips.items()
        for tip in found
    ]
    crossings = [
        {
            "at_deg": [math.degrees(crossing.first), math.degrees(crossing.second)],
            "height": float(design.flanks["lower"].pose(np.array([crossing.first])).z[0]) / recipe.mm,
            "angle_deg": math.degrees(angle_of(design, crossing)),
            "gap": gap / recipe.mm,
        }
        for crossing, gap in zip(design.crossings, design.gaps, strict=True)
    ]
    section |= {"turns": recipe.turns, "crossings": crossings} if crossings else {}
    return {**section, "undercut": undercuts} if undercuts else section
