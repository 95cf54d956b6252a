"""What a failed check tells that would do, by kind of check and of cam."""

from __future__ import annotations

import math
from typing import Any

import pytest

from camgeo.recipe.loading import load_text
from camgeo.report.failure import remedy

CAMS = {
    "support": "{kind: support, p: 25 + 2*cos(3*t)}",
    "breadth": "{kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: harmonic}, {dwell: 60}]}",
    "roller": "{kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}",
    "diameter": "{kind: constant-diameter, base_radius: 30, roller_radius: 8, motion: "
    "[{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]}",
    "pair": "{kind: flat-pair, ratio: 3, arm: 60, delta: {cos: {1: 100}}}",
}
LIMITED = "\nverify: {motion_error: 0.001}"


def told(name: str, value: float | None, limit: float | None, cam: str, more: str = "", **given: Any) -> str:
    recipe = load_text(f"cam: {CAMS[cam]}{more}\n", "cam.yaml")
    report = {"files": [{"path": "cam.dxf", "tolerance": 0.002}]}
    return remedy({"name": name, "value": value, "limit": limit, "unit": "mm", **given}, report, recipe)


@pytest.mark.parametrize(
    ("said", "name", "value", "limit", "cam"),
    [
        ("a smaller swing, or the same over a wider angle", "velocity-ratio", 1.2, 1.0, "roller"),
        ("a smaller swing, or the same over a wider angle", "pressure-angle", None, 90.0, "roller"),
        ("a p larger by more than 1.23457 mm", "radius-of-curvature", -1.2345678, 0.0, "support"),
        ("a base radius larger by more than 1.23457 mm", "radius-of-curvature", -1.2345621, 0.0, "breadth"),
        ("a roller radius below 7.65432 mm", "radius-of-curvature", 7.6543288, 8.0, "roller"),
        ("", "radius-of-curvature", -1.0, 8.0, "roller"),
        ("", "radius-of-curvature", -1.0, 0.0, "pair"),
        ("a chamfer below 0.4 mm", "chamfer", 0.4, 0.5, "support"),
        ("no chamfer, or a contour without corners", "chamfer", 0.0, 0.5, "support"),
        ("", "motion", 0.002, 0.001, "support"),
        ("", "volume", 2.0, 1.0, "support"),
        ("", "wall", None, 1.0, "support"),
    ],
)
def test_what_would_do(said: str, name: str, value: float | None, limit: float, cam: str) -> None:
    assert told(name, value, limit, cam) == said


def test_a_motion_limit_of_ones_own() -> None:
    said = "a tolerance of 0.001, or verify.motion_error above 0.00154322"
    assert told("motion", 0.0015432111, 0.001, "support", LIMITED) == said
    said = "a tolerance of about 0.001, or verify.motion_error above 0.002"
    assert told("motion", 0.002, 0.001, "roller", LIMITED, file="cam.dxf") == said
    assert told("motion", 0.002, 0.001, "diameter", LIMITED, file="cam.dxf") == said
    assert told("motion", 0.002, 0.001, "roller", LIMITED, file="sent.dxf") == "verify.motion_error above 0.002"


def test_a_motion_error_that_permits_the_play() -> None:
    """Of a given one the limit of the play is a multiple: 0.001 degrees over an arm of 60 mm."""
    limit = 0.001 * 60.0 * math.pi / 180.0
    assert told("form-closure", 1.5 * limit, limit, "roller", LIMITED) == "verify.motion_error above 0.0015"
    assert told("form-closure", 0.003, 0.002, "diameter", LIMITED) == "verify.motion_error above 0.0015"
    assert told("form-closure", 0.003, 0.002, "diameter") == ""


def test_a_smaller_bore_where_one_would_do() -> None:
    bored = "\npart: {bore: 10}"
    assert told("wall", -0.5, 1.0, "support", bored) == "a bore smaller by more than 3 mm"
    assert told("wall", -4.5, 1.0, "support", bored) == ""


def test_what_the_check_tells_itself_is_not_told_again() -> None:
    bolted = "\npart: {bore: 10, bolts: {count: 4, circle: 20, hole: 9}}"
    assert told("wall", -0.5, 0.0, "support", bolted, detail="bore and bolt hole 3") == ""
    assert told("chamfer", 0.4, 0.5, "support", file="cam.stl") == ""
