"""Cylindrical cams to start from."""

from __future__ import annotations

from camgeo.recipe.starter import Given, Starter, Starters

_MOTION = (
    "\n    - {{rise: {0}, over: 120, law: modified-sine}}"
    "\n    - {{dwell: 60}}"
    "\n    - {{return: {0}, over: 120, law: cycloidal}}"
    "\n    - {{dwell: 60}}"
)


_OUT_AND_BACK = (
    "\n    - {rise: 60, over: 1080, law: {uniform: {blend: 90}}}"
    "\n    - {return: 60, over: 1080, law: {uniform: {blend: 90}}}"
)


def _starter(
    title: str, task: str, track: Given, cam: Given, part: Given, *, arm: str = "", follower: Given | None = None
) -> Starter:
    roller: Given = {"kind": "roller", "radius": "8", **({"from": "40"} if "end" in track else {})}
    if arm:
        roller["arm"] = arm
    return Starter(
        title,
        "",
        {},
        {
            "cam": {
                "kind": "cylindrical",
                "radius": "50",
                "track": track,
                "follower": follower or roller,
                "motion": _MOTION.format("20" if arm else "25"),
                **cam,
            },
            "part": {**part, "bore": "{diameter: 25, fit: H7}", "keyway": "din6885"},
            "export": {
                "tolerance": "0.01",
                "files": "[stl, {dxf: {as: development, at: [outer, pitch]}}, {csv: {as: flank}}]",
            },
            "verify": {"motion_error": "0.03" if arm else "0.02"},
        },
        root="cylindrical",
        task=task,
        also="barrel drum",
    )


ANSWERS = Starters(
    starters={
        "cylindrical": _starter(
            "A drum with a groove that leads a roller along its axis.",
            "a barrel or drum cam with a groove",
            {"groove": {"depth": "11", "clearance": "0.03"}},
            {"pitch_height": "25"},
            {"length": "75"},
        ),
        "cylindrical-rib": _starter(
            "A drum with a rib between two rollers.",
            "a drum cam with a rib between two rollers",
            {"rib": {"distance": "30", "depth": "11"}},
            {"pitch_height": "28"},
            {"length": "80"},
        ),
        "cylindrical-end": _starter(
            "A drum whose end face lifts a roller against a spring.",
            "a bell or face cam on the end of a drum",
            {"end": "top"},
            {"pitch_height": "40"},
            {"length": "80"},
        ),
        "cylindrical-arm": _starter(
            "A drum with a rib between two rollers that swing an arm.",
            "a drum cam that swings an arm",
            {"rib": {"distance": "32", "depth": "11"}},
            {"pitch_height": "31"},
            {"length": "90"},
            arm="{length: 80, offset: 79.4, pivot: 45}",
        ),
        "cylindrical-screw": _starter(
            "A reversing screw that leads a shoe three turns out and three back.",
            "a self-reversing screw, as of the level wind of a winch",
            {"groove": {"depth": "6", "clearance": "0.05"}},
            {"radius": "30", "turns": "6", "pitch_height": "14", "motion": _OUT_AND_BACK},
            {"length": "88"},
            follower={"kind": "shoe", "width": "8", "length": "46", "from": "25"},
        ),
    }
)
