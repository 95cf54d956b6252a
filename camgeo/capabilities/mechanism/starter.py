"""A printed toy to start from."""

from __future__ import annotations

from camgeo.recipe.starter import Starter, Starters

_STARTERS = {
    "toy-set": Starter(
        "All bodies of a toy, to print: cam, follower, shaft with a knob, base; two bumps of 12 mm a turn.",
        "disc",
        {
            "base_radius": "26",
            "follower": {"kind": "flat"},
            "motion": 2 * "\n    - {rise: 12, over: 80}\n    - {return: 12, over: 80}\n    - {dwell: 20}",
        },
        {
            "part": {"thickness": "6", "bore": "{hexagon: 8}", "mark": "{as: engrave, width: 1, length: 5}"},
            "mechanism": {"clearance": "0.25"},
            "export": {"tolerance": "0.02", "files": "[{stl: {parts: all}}, {3mf: {parts: all}}, html]"},
        },
        unfit=("conjugate",),
        after="disc-flat",
        task="a whole toy to print",
        also="bodies set assembly follower base frame knob shaft hexagon 3mf mechanism",
    ),
}

ANSWERS = Starters(starters=_STARTERS)
