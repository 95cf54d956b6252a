"""Strokes have one bound, wherever a motion comes from, and are refused before any curve is made."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import camgeo
from camgeo.schema.fields import MOST

if TYPE_CHECKING:
    from pathlib import Path

ROLLER = "follower: {kind: roller, radius: 5}"
CAMS = {
    "disc": f"kind: disc, base_radius: 30, {ROLLER}",
    "arm": "kind: disc, base_radius: 30, follower: {kind: roller, radius: 5, arm: {pivot: 60, length: 50}}",
    "breadth": "kind: constant-breadth, base_radius: 30",
    "diameter": "kind: constant-diameter, base_radius: 30, roller_radius: 5",
}
HALF = "law: cycloidal, over: 90"


def refusal(cam: str, motion: str, at: Path, units: str = "mm") -> str:
    recipe = at / "cam.yaml"
    recipe.write_text(f"units: {units}\ncam: {{{CAMS[cam]}, motion: {motion}}}\n")
    with pytest.raises(camgeo.RecipeErrors) as caught:
        camgeo.design(camgeo.load(recipe))
    place, _, told = str(caught.value).partition(": ")
    assert place.startswith(f"{recipe}:2:")
    return told


@pytest.mark.parametrize("units", ["mm", "inch"])
@pytest.mark.parametrize(
    ("cam", "motion", "field"),
    [
        ("disc", "{formula: 1e9*(1 - cos(t))}", ".formula"),
        ("disc", "{formula: 1e30*(1 - cos(40*t))}", ".formula"),
        ("arm", "{formula: 1e9*(1 - cos(t))}", ".formula"),
        ("breadth", "{formula: 1e9*(1 - cos(t))/2}", ".formula"),
        ("diameter", "{formula: 1e9*(1 - cos(t))/2}", ".formula"),
        ("disc", "[{rise: 1, over: 180, law: cycloidal}, {displacement: 1e9*u, over: 180}]", ""),
        ("disc", f"[{{rise: 2e6, {HALF}}}, {{rise: 1, {HALF}}}, {{return: 1, {HALF}}}, {{return: 2e6, {HALF}}}]", ""),
        (
            "disc",
            "{repeat: 2, segments: [{rise: 1, over: 90, law: cycloidal}, {displacement: 1e9*u, over: 90}]}",
            "",
        ),
        ("disc", "{points: [[0, -2e6], [90, 2e6], [180, 0]]}", ".points"),
    ],
)
def test_a_stroke_beyond_the_bound_is_refused_with_what_would_do(
    cam: str, motion: str, field: str, units: str, tmp_path: Path
) -> None:
    told = refusal(cam, motion, tmp_path, units)
    assert told.startswith(f"cam.motion{field}: a motion over ")
    assert told.endswith(f"; give displacements that differ by {MOST:.0f} at most")


@pytest.mark.parametrize("units", ["mm", "inch"])
@pytest.mark.parametrize(
    "motion",
    [
        f"{{formula: {MOST / 2}*(1 - cos(t))}}",
        f"[{{rise: {MOST}, over: 180, law: cycloidal}}, {{return: {MOST}, over: 180, law: cycloidal}}]",
        f"{{points: [[0, {-MOST / 2}], [90, 0], [180, {MOST / 2}], [270, 0]]}}",
        f"{{lobe: {{lift: {MOST}, half: 90, powers: [2, 8, 14, 20, 26]}}}}",
        "{table: lift.csv}",
    ],
)
def test_the_bound_itself_is_a_stroke(motion: str, units: str, tmp_path: Path) -> None:
    turn = np.arange(0, 361, 10)
    rows = zip(turn, 0.4999 * MOST * (1 - np.cos(np.radians(turn))), strict=True)
    (tmp_path / "lift.csv").write_text("".join(f"{angle};{s}\n" for angle, s in rows))
    path = tmp_path / "cam.yaml"
    path.write_text(f"units: {units}\ncam: {{{CAMS['disc']}, motion: {motion}}}\n")
    recipe = camgeo.load(path)
    motion_made = recipe.cam.exact().law
    assert motion_made.range[1] - motion_made.range[0] == pytest.approx(MOST * recipe.mm, rel=3e-4)


def test_a_table_beyond_the_bound_names_its_row(tmp_path: Path) -> None:
    rows = [(angle, 3e6 if angle == 180 else 1e6 * (0 < angle < 360)) for angle in range(0, 361, 10)]
    (tmp_path / "lift.csv").write_text("".join(f"{angle};{s}\n" for angle, s in rows))
    told = refusal("disc", "{table: lift.csv}", tmp_path)
    assert told == ("cam.motion.table: lift.csv, line 19: a displacement above 2000000; give a table of smaller ones")
    path = tmp_path / "cam.yaml"
    path.write_text(path.read_text().replace("units: mm", "units: inch").replace("lift.csv", "lift.csv, units: mm"))
    camgeo.load(path)  # in inch they are small enough


def test_a_support_function_beyond_the_bound_has_a_remedy() -> None:
    text = "cam: {kind: support, p: 1e9 + 2*cos(3*t)}\n"
    with pytest.raises(camgeo.RecipeErrors, match=r"p reaches 1e\+09 at .*; give a p of smaller values"):
        camgeo.design(camgeo.load(text))
    assert camgeo.design(camgeo.load(text.replace("1e9", "1e6"))).ok
