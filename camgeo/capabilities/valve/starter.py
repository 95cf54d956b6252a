"""A valve train to start from."""

from __future__ import annotations

from camgeo.recipe.starter import Starter, Starters

_STARTERS = {
    "valve-train": Starter(
        "A valve that a rocker opens: its lobe by its cam card, its events and its seating.",
        "disc",
        {
            "base_radius": "17",
            "follower": {"kind": "flat", "width": "29"},
            "motion": (
                "\n    lobe:"
                "\n      lift: 7.4"
                "\n      duration: [{at_lift: 1.27, degrees: 214}, {at_lift: 0.5, degrees: 242}]"
                "\n      ramp: {height: 0.25, velocity: 0.012}"
            ),
        },
        {
            "part": {"thickness": "14"},
            "valve": {"ratio": "1.5", "lash": "0.25"},
            "export": {"tolerance": "0.001", "files": "[dxf, svg, stl, {csv: {as: valve}}, html]"},
        },
        unfit=("conjugate",),
        after="disc-card",
        task="a valve that a rocker opens",
        also="engine motor camshaft train intake exhaust lash seat spring",
    ),
}

ANSWERS = Starters(starters=_STARTERS)
