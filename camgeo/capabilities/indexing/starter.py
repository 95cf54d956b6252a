"""Indexing cams to start from."""

from __future__ import annotations

from camgeo.recipe.starter import Given, Starter, Starters


def _starter(title: str, task: str, form: Given, cam: Given, part: Given) -> Starter:
    return Starter(
        title,
        "",
        {},
        {
            "cam": {"kind": "indexing", **form, **cam},
            "part": {**part, "keyway": "din6885"},
            "export": {"tolerance": "0.01", "files": "[stl, csv]"},
            "verify": {"motion_error": "0.05"},
        },
        root="indexing",
        task=task,
        also="index indexer turret dial globoidal ferguson",
    )


ANSWERS = Starters(
    starters={
        "indexing-barrel": _starter(
            "A barrel that advances a dial of eight rollers by one stop a turn.",
            "a barrel cam that indexes a dial",
            {"barrel": {"radius": "50"}},
            {
                "depth": "13",
                "turret": {"stops": "8", "radius": "60", "roller": "9"},
                "motion": "\n    - {rise: 45, over: 180, law: modified-sine}\n    - {dwell: 180}",
            },
            {"length": "90", "bore": "{diameter: 25, fit: H7}"},
        ),
        "indexing-globoid": _starter(
            "A globoid that advances a turret of eight radial rollers by one stop a turn.",
            "a globoidal cam that indexes a turret",
            {"globoid": {"distance": "90", "radius": "49"}},
            {
                "depth": "13.5",
                "turret": {"stops": "8", "roller": "8"},
                "motion": "\n    - {rise: 45, over: 180, law: modified-sine}\n    - {dwell: 180}",
            },
            {"length": "60", "bore": "{diameter: 20, fit: H7}"},
        ),
    }
)
