"""Linear cams to start from."""

from __future__ import annotations

from camgeo.recipe.starter import Given, Starter, Starters

_MOTION = (
    "\n    - {{dwell: 10}}"
    "\n    - {{rise: {0}, over: 50, law: modified-sine}}"
    "\n    - {{dwell: 20}}"
    "\n    - {{return: {0}, over: 60, law: cycloidal}}"
    "\n    - {{dwell: 10}}"
)
_FILES: Given = {"tolerance": "0.001", "files": "[dxf, stl, csv, html]"}


def _starter(title: str, cam: Given, part: Given) -> Starter:
    return Starter(
        title,
        "",
        {},
        {"cam": {"kind": "linear", **cam}, "part": part, "export": _FILES, "verify": {"motion_error": "0.005"}},
        root="linear",
    )


_STARTERS = {
    "linear": _starter(
        "A plate on a slide that lifts a roller on a stem.",
        {
            "base": "30",
            "follower": {"kind": "roller", "radius": "8", "lean": "5"},
            "ends": {"overrun": "6"},
            "motion": _MOTION.format("16"),
        },
        {"thickness": "12", "holes": "[{at: [40, 12], diameter: 8.4}, {at: [110, 12], diameter: 8.4}]"},
    ),
    "linear-groove": _starter(
        "A grooved plate that works a roller on an arm both ways.",
        {
            "base": "30",
            "follower": {"kind": "roller", "radius": "8", "arm": {"length": "70", "pivot": "48"}},
            "track": {"groove": {"clearance": "0.03", "depth": "7"}},
            "ends": {"overrun": "8"},
            "motion": _MOTION.format("16"),
        },
        {"thickness": "14", "height": "90"},
    ),
    "linear-endless": _starter(
        "A rack of waves, without ends.",
        {
            "base": "15",
            "endless": "true",
            "follower": {"kind": "roller", "radius": "4"},
            "motion": (
                "\n    repeat: 3"
                "\n    segments: [{rise: 3, over: 12.5, law: cycloidal}, {return: 3, over: 12.5, law: cycloidal}]"
            ),
        },
        {"thickness": "8"},
    ),
}

ANSWERS = Starters(starters=_STARTERS)
