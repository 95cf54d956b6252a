"""Draw docs/figures/camshaft-*.svg, when the lobes of shipped camshafts lift: `python docs/make_camshafts.py`."""

from __future__ import annotations

import argparse
from pathlib import Path

from drawing import keep

from camgeo.camshaft.lobes import placed
from camgeo.camshaft.timing import timing
from camgeo.common.clock import Clock
from camgeo.recipe.camshaft import CamshaftRecipe
from camgeo.recipe.loading import load_order

ROOT = Path(__file__).parents[1]
NAMES = ("four-cylinder", "packaging")


def figures() -> dict[str, str]:
    """Each picture by its name."""
    drawn = {}
    for name in NAMES:
        recipe = load_order(ROOT / "recipes" / "camshafts" / f"{name}.yaml")
        if isinstance(recipe, CamshaftRecipe):
            drawn[f"camshaft-{name}"] = timing(recipe, placed(recipe, Clock()))
    return drawn


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    keep(ROOT / "docs" / "figures", figures(), "camshaft-")
