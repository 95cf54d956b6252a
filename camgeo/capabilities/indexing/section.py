"""Section `indexing` of the report of an indexing cam: its sizes, and all figures with their shaft angles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from camgeo.measures.placed import figure_entry

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.measures.placed import Figure


def index_section(design: IndexDesign, figures: Sequence[Figure]) -> dict[str, Any]:
    """The section as plain data, in the recipe's unit, angles in degrees."""
    recipe = design.recipe
    return {
        "form": recipe.turret.word,
        "radius": recipe.form.blank / recipe.mm,
        "floor": recipe.form.floor / recipe.mm,
        "stops": recipe.stops,
        "height": recipe.turret.height / recipe.mm,
        **{key: value / recipe.mm for key, value in recipe.turret.sizes.items()},
        "roller": recipe.roller.radius / recipe.mm,
        "from": recipe.roller.inner / recipe.mm,
        "to": recipe.roller.outer / recipe.mm,
        "start_deg": math.degrees(recipe.start),
        "figures": [figure_entry(recipe, figure, 1.0) for figure in figures],
    }
