# needs: camshaft
"""Draw docs/figures/camshaft-*.svg, the diagrams of shipped camshafts: `python tools/docs/make_camshafts.py`."""

from __future__ import annotations

import argparse
from pathlib import Path

from drawing import keep

from camgeo.capabilities.camshaft.diagrams import diagram
from camgeo.capabilities.camshaft.keys import CamshaftRecipe
from camgeo.capabilities.camshaft.lobes import placed
from camgeo.common.clock import Clock
from camgeo.recipe.loading import load_order

ROOT = Path(__file__).parents[2]
FORMS = {"four-cylinder": {"": "cam-wheel", "-crank": "crank-wheel", "-shaft": "shaft"}, "packaging": {"": "bars"}}


def figures() -> dict[str, str]:
    """Each picture by its name."""
    drawn = {}
    for name, forms in FORMS.items():
        recipe = load_order(ROOT / "recipes" / "camshafts" / f"{name}.yaml")
        if isinstance(recipe, CamshaftRecipe):
            lobes = placed(recipe, Clock())
            drawn |= {f"camshaft-{name}{end}": diagram(recipe, lobes, form) for end, form in forms.items()}
    return drawn


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    keep(ROOT / "docs" / "figures", figures(), "camshaft-")
