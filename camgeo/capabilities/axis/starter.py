"""Axes to start from."""

from __future__ import annotations

from camgeo.recipe.starter import Given, Starter, Starters

_FILES: Given = {"tolerance": "0.01", "files": "[{csv: {as: controller, for: plain}}, csv, html]"}


def _starter(title: str, axis: Given, limits: Given) -> Starter:
    return Starter(title, "", {}, {"axis": axis, "export": _FILES, "limits": limits}, root="axis")


_STARTERS = {
    "axis": _starter(
        "A servo axis that pushes and comes back, without a cam.",
        {
            "rpm": "60",
            "motion": (
                "\n    - {rise: 120, over: 140, law: modified-sine}"
                "\n    - {dwell: 40}"
                "\n    - {return: 120, over: 140, law: modified-sine}"
                "\n    - {dwell: 40}"
            ),
        },
        {"velocity": {"at_most": "700"}, "acceleration": {"at_most": "6000"}},
    ),
    "axis-index": _starter(
        "A servo axis that turns a table on by 45 degrees a cycle.",
        {
            "kind": "rotary",
            "rpm": "60",
            "index": "true",
            "modulo": "360",
            "motion": "\n    - {rise: 45, over: 150, law: modified-sine}\n    - {dwell: 210}",
        },
        {"velocity": {"at_most": "300"}, "acceleration": {"at_most": "2000"}},
    ),
}

ANSWERS = Starters(starters=_STARTERS)
