"""What computes the figures of designs and polishes the best of them, put in the words of this package."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.sweep.figures import REASONS, evaluate
from camgeo.sweep.gather import REASON

if TYPE_CHECKING:
    from camgeo.recipe.model import Recipe
    from camgeo.sweep.gather import Floats

__all__ = ["REASONS", "figures"]


def figures(scene: Recipe, values: Floats) -> dict[str, Floats]:
    """Figures of designs with the values (m, axes) of the scene's sweep, and why a design has none, as a number."""
    paths = tuple(axis.path for axis in scene.sweep.vary) if scene.sweep else ()
    found = evaluate(scene, paths, values)
    return {**found.figures, REASON: found.reason.astype(np.float64)}
