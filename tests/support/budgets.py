# needs: budget
"""A cam with a bore and a key, its budget, and the dimensions that a recipe's cam and linkage may have in a budget."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.budget.dimensions import dimension_names, traits
from camgeo.capabilities.budget.keys import Budget
from camgeo.recipe.loading import load_text

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe


CAM = """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9, offset: 10}
  motion: [{rise: 24, over: 100, law: cycloidal}, {dwell: 40}, {return: 24, over: 140, law: cycloidal}, {dwell: 80}]
part: {thickness: 10, bore: {diameter: 20, fit: H7}, keyway: din6885}
export: {tolerance: 0.01, files: [dxf]}
verify: {angles: 360}
"""


def dimensions_of(recipe: Recipe) -> tuple[str, ...]:
    arrangement = recipe.cam.arrangement
    linkage = recipe.linkage.kind if recipe.linkage else ""
    return dimension_names(traits(arrangement.offers, arrangement.discs, linkage))


def budget(body: str, cam: str = CAM) -> Budget:
    value = load_text(f"{cam}budget: {{permitted: 0.05, {body}}}\n", "c.yaml").of(Budget)
    assert value is not None
    return value
