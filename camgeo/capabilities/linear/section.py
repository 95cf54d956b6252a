"""Section `plate` of the report of a linear cam: its travel, its extent, all figures with their places."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.measures.placed import figure_entry

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.measures.placed import Figure


def plate_section(design: LinearDesign, figures: Sequence[Figure]) -> dict[str, Any]:
    """The section as plain data, in the recipe's unit."""
    recipe = design.recipe
    low, high = design.extent
    section: dict[str, Any] = {
        "travel": design.total / recipe.mm,
        "from": low / recipe.mm,
        "to": high / recipe.mm,
        "figures": [figure_entry(recipe, figure, recipe.mm) for figure in figures],
    }
    if recipe.endless:
        section["periods"] = recipe.periods
    if recipe.swings:
        from math import degrees

        section["arm_at_rest_deg"] = degrees(recipe.rest)
    if recipe.trims and design.lower.lost:
        reach = design.path.guide.reach
        section["lost"] = [
            {
                "from": lost.begin / recipe.mm,
                "to": lost.end / recipe.mm,
                "corner": (design.drawn(_row(lost.corner))[0] / recipe.mm).tolist(),
                "motion": lost.depth * reach / recipe.mm,
                "at": lost.at / recipe.mm,
            }
            for lost in design.lower.lost
        ]
    return section


def _row(point: tuple[float, float]) -> Any:  # noqa: ANN401 - an array of one row
    import numpy as np

    return np.array([point])
