"""A camshaft to start from."""

from __future__ import annotations

from camgeo.recipe.starter import Starter, Starters

_STARTERS = {
    "camshaft": Starter(
        "Lobes of other recipes on one shaft: `camgeo new disc-lobe lobe.yaml` makes theirs.",
        "",
        {},
        {
            "camshaft": {
                "shaft": {"diameter": "26", "to": "80", "bore": "8"},
                "journals": "\n    - {z: 0, length: 15, diameter: 32}\n    - {z: 65, length: 15, diameter: 32}",
                "lobes": (
                    "\n    - {recipe: lobe.yaml, cylinder: 1, valve: intake, z: 20}"
                    "\n    - {recipe: lobe.yaml, cylinder: 1, valve: exhaust, z: 45}"
                ),
                "engine": {"order": "[1]", "intake": "110", "exhaust": "114", "lift": "1"},
            },
            "export": {"tolerance": "0.005", "files": "[stl, svg, {csv: {as: events}}, html]"},
        },
        root="camshaft",
    ),
}

ANSWERS = Starters(starters=_STARTERS)
