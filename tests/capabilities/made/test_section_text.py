"""A report on measured points in lines of text: the verdict by what failed, and figures beside the intended ones."""

from __future__ import annotations

from typing import Any

import pytest

from camgeo.capabilities.made.section_text import shown, table_rows

ERROR = {"max": 0.0123456, "at_deg": 50.0, "uncertainty": 0.00123, "unit": "mm"}
SECTION: dict[str, Any] = {
    "files": ["points.csv"],
    "unit": "mm",
    "verdicts": {},
    "surfaces": [],
    "discs": [],
    "motion": {
        "error": ERROR,
        "velocity": ERROR,
        "acceleration": ERROR,
        "offset": -0.5,
        "offset_uncertainty": 0.002,
        "unit": "mm",
        "phase_deg": 0.25,
        "phase_uncertainty_deg": 0.01,
        "without_phase": 0.002,
        "peak_acceleration": {"made": 12.0, "intended": 11.5, "unit": "mm/rad^2"},
    },
    "remarks": ["no limit is given"],
}
MADE, OTHER = (
    {"name": "made-motion", "ok": False, "detail": "0.2 +- 0.1 mm"},
    {"name": "limit", "ok": False, "detail": ""},
)


@pytest.mark.parametrize(
    ("verdict", "checks", "word"),
    [
        ("not proved", [MADE], "NOT PROVED"),
        ("failed", [MADE], "FAILED"),
        ("not proved", [MADE, OTHER], "FAILED"),
        ("ok", [], "ok"),
        (None, [], "measured, no limit given"),
    ],
)
def test_the_verdict_is_not_proved_where_nothing_fails_for_certain(
    verdict: str | None, checks: list[dict[str, Any]], word: str
) -> None:
    section = SECTION | {"verdicts": {"made-motion": verdict} if verdict else {}}
    text = shown({"recipe": "cam", "ok": not checks, "checks": checks, "made": section}, everything=False)
    assert text.startswith(f"cam: {word}  points.csv\n")
    assert "  remark: no limit is given" in text
    assert ("  made-motion: 0.2 +- 0.1 mm" in text) == bool(checks)


def test_figures_stand_beside_the_intended_ones() -> None:
    event = {"made": 8.05, "intended": 8.0, "uncertainty": 0.004, "unit": "mm"}
    rows = dict(table_rows(SECTION | {"events": {"follower": {"lift": event}}}, everything=False))
    assert rows["motion, error"] == "+0.01235 +- 0.0012 mm at 50.00 degrees"
    assert rows["  constant offset"] == "-0.5 +- 0.002 mm, set on assembly"
    assert rows["  phase, by the motion"] == "+0.25 +- 0.01 degrees; 0.002 mm remain without it"
    assert rows["follower, greatest lift"] == "8.05 +- 0.004 mm, intended 8: +0.05"
