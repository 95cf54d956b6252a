"""Starter recipe with a budget."""

from __future__ import annotations

from camgeo.recipe.starter import Starter, Starters

_STARTERS = {
    "disc-budget": Starter(
        "A disc cam whose roller may be off by 0.05, and what that leaves for the cam's profile.",
        "disc",
        {
            "base_radius": "36",
            "follower": {"kind": "roller", "radius": "9", "offset": "10"},
            "motion": (
                "\n    - {rise: 24, over: 100, law: modified-sine}"
                "\n    - {dwell: 40}"
                "\n    - {return: 24, over: 140, law: modified-trapezoid}"
                "\n    - {dwell: 80}"
            ),
        },
        {
            "part": {"thickness": "10", "bore": "{diameter: 20, fit: H7}"},
            "budget": {
                "permitted": "0.05",
                "tolerances": "{profile: free, follower.radius: 0.005, follower.offset: 0.01, shaft: 0.005}",
                "fit": "h6",
            },
        },
        after="disc-conjugate",
        task="what each size may be off",
        also="tolerance budget error play production accuracy",
    ),
}

ANSWERS = Starters(starters=_STARTERS)
