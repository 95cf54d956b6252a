"""A search to start from."""

from __future__ import annotations

from camgeo.recipe.starter import DWELLING, FOUR_BAR, Starter, Starters

_STARTERS = {
    "sweep": Starter(
        "A search for a longer dwell of a four-bar.",
        "support",
        {"p": DWELLING, "shaft": "[18, 8.5]"},
        {
            **FOUR_BAR,
            "sweep": {
                "vary": (
                    "\n    cam.shaft[0]: {from: 16, to: 20, steps: 9}"
                    "\n    linkage.rocker: {from: 95, to: 110, steps: 16}"
                ),
                "limits": "{radius-of-curvature: {at_least: 3}, transmission-angle: {at_least: 30}}",
                "rank": "dwell",
                "keep": "5",
            },
        },
        after="slider-crank",
        task="a search among linkages",
        also="sweep optimise optimize best dwell",
    ),
}

ANSWERS = Starters(starters=_STARTERS)
