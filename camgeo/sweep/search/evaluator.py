"""What computes the figures of designs and polishes the best of them, put in the words of this package."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from camgeo.sweep.search.figures import REASONS, Evaluator
from camgeo.sweep.search.gather import REASON

if TYPE_CHECKING:
    from camgeo.sweep.search.ask import Ask
    from camgeo.sweep.search.figures import Scene
    from camgeo.sweep.search.gather import Floats

__all__ = ["REASONS", "figures", "measure"]

_HEAP = 3 << 20  # numbers, 24 MB


def figures(scene: Scene, values: Floats) -> dict[str, Floats]:
    """Figures of designs with the values (m, axes) of the scene's sweep, and why a design has none, as a number."""
    found = _evaluator(scene).found(values)
    return {**found.figures, REASON: found.reason.astype(np.float64)}


def measure(ask: Ask, values: Floats) -> dict[str, Floats]:
    """All figures of designs with the values (m, axes) of a sweep."""
    scene = ask.scene(ask.all_figures)
    return Evaluator.of(scene.recipe, scene.paths).found(values).figures


@lru_cache(maxsize=1)
def _evaluator(scene: Scene) -> Evaluator:
    """What the chunks of a sweep share; a process that computes one computes many."""
    # glibc hands the memory of each block back to the system, and takes it again page by page for the next, at a tenth
    # of all time. It keeps what is smaller than the largest piece it was ever given back.
    np.empty(_HEAP)
    return Evaluator.of(scene.recipe, scene.paths, figures=scene.figures)
