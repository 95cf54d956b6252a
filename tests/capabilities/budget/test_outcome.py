"""The budget of a design: tolerances of least cost in the units written, and sums on contours that are not exact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.brute_disc import Touching, motion, polygon
from support.budgets import CAM
from support.places import ROOT

import camgeo
from camgeo.capabilities.budget import read_contours
from camgeo.capabilities.budget.library import budget
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe

# units, sum, exponent; profile in the unit, angle in degrees, their cost: by a search over the angle's tolerance, with
# the influences sqrt(1 + ((v - e)/(s + s0))^2) and |v| by hand, s0 = sqrt(47^2 - 4^2) mm, at each tenth of a degree
LEAST_COSTS = [
    ("mm", "worst", 1, (0.030777478, 0.061681091), 113.619855),
    ("mm", "rss", 1, (0.041520098, 0.091664718), 80.8974119),
    ("mm", "worst", 2, (0.033764485, 0.053681436), 2795.37714),
    ("inch", "worst", 1, (0.0018428023, 0.018668917), 1245.99850),
    ("inch", "rss", 0.5, (0.0018890944, 0.065140477), 57.7696690),
]


@pytest.mark.parametrize(("units", "kind", "exponent", "tolerances", "cost"), LEAST_COSTS)
def test_costs_are_of_the_units_written(units, kind, exponent, tolerances, cost) -> None:
    mm = 1.0 if units == "mm" else 25.4
    text = f"""\
units: {units}
cam:
  kind: disc
  base_radius: {38 / mm}
  follower: {{kind: roller, radius: {9 / mm}, offset: {4 / mm}}}
  motion:
    - {{rise: {20 / mm}, over: 113, law: modified-trapezoid}}
    - {{dwell: 44}}
    - {{return: {20 / mm}, over: 90, law: polynomial-345}}
    - {{dwell: 113}}
budget:
  permitted: {0.06 / mm}
  tolerances: {{profile: free, angle: free}}
  cost: {{profile: 2, angle: 3}}
  exponent: {exponent}
  sum: {kind}
  runs: 0
"""
    entry = budget(load_text(text, "c.yaml"))
    assert [row["tolerance"] for row in entry["dimensions"]] == pytest.approx(tolerances, rel=1e-6)
    assert entry["splits"][kind]["cost"] == pytest.approx(cost, rel=1e-8)


# --- contours that are not exact --------------------------------------------------------------------------------------

ROLLER = Touching("roller", radius=9.0, offset=10.0)  # of CAM
ROWS = [(24.0, 100.0, "cycloidal"), (0.0, 40.0, ""), (-24.0, 140.0, "cycloidal"), (0.0, 80.0, "")]
PERMITTED, RADIUS = 1.0, 0.02  # mm; of the latter the tolerance of the roller
YOKE = "cam: {kind: constant-breadth, base_radius: %r, motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]}\n"
FRAME = """\
cam: {kind: support, p: %s + 2*cos(3*t), shaft: [10, 4]%s}
linkage: {kind: slider-crank, coupler: 75, offset: 0}
"""
FINE = "export: {tolerance: 0.0005, files: [dxf]}\nverify: {angles: 36}\n"


def drawn(text: str, folder: Path) -> Path:
    """The drawing that a recipe makes."""
    return camgeo.export(load_text(text, "c.yaml"), folder, only=["dxf"]).path / "c.dxf"


@pytest.fixture(scope="module")
def coarse(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, np.ndarray, np.ndarray]:
    """A coarse polyline; at whole degrees the roller's error on it, mm, and the influence of a radius."""
    text = CAM.replace("tolerance: 0.01, files: [dxf]", "tolerance: 0.5, files: [{dxf: {as: polyline}}]")
    drawing = drawn(text.replace("360}", "360, motion_error: 2}"), tmp_path_factory.mktemp("coarse"))
    degrees, metal, rest = np.arange(360.0), polygon(drawing, step=0.02), ROLLER.rest(36.0)
    intended = rest + motion(ROWS, degrees)
    error = np.array([ROLLER.place(metal, theta, 36.0) for theta in np.radians(degrees)]) - intended
    slope = (motion(ROWS, degrees + 1e-3) - motion(ROWS, degrees - 1e-3)) / np.radians(2e-3)
    return drawing, error, np.hypot(1.0, (slope - ROLLER.offset) / intended)


def recipe_of(body: str) -> Recipe:
    return load_text(f"{CAM}budget: {{permitted: {PERMITTED}, runs: 0, {body}}}\n", "c.yaml")


@pytest.mark.slow
def test_the_error_of_a_file_adds_to_both_sums(coarse: tuple[Path, np.ndarray, np.ndarray]) -> None:
    drawing, error, influence = coarse
    assert np.abs(error).max() > 0.3
    entry = budget(recipe_of(f"tolerances: {{profile: 0.01, follower.radius: {RADIUS}}}"), drawing)
    worst, rss = (np.abs(error) + size * influence for size in (0.01 + RADIUS, np.hypot(0.01, RADIUS)))
    assert entry["contour"]["error"] == pytest.approx(np.abs(error).max(), abs=2e-5)
    assert entry["worst"]["value"] == pytest.approx(worst.max(), abs=2e-5)
    assert entry["rss"]["value"] == pytest.approx(rss.max(), abs=2e-5)
    for kind, sums in (("worst", worst), ("rss", rss)):
        at, shares = int(sums.argmax()), entry[kind]["shares"]
        assert entry[kind]["at_deg"] == at
        assert shares["contour"] == pytest.approx(abs(error[at]) / sums[at], abs=1e-4)
        assert sum(shares.values()) == pytest.approx(1.0)


@pytest.mark.slow
def test_where_a_machine_is_set_a_file_has_no_error(coarse: tuple[Path, np.ndarray, np.ndarray]) -> None:
    drawing, error, influence = coarse
    entry = budget(recipe_of(f"zero: 300, tolerances: {{follower.radius: {RADIUS}}}"), drawing)
    sums = np.abs(error - error[300]) + RADIUS * np.abs(influence - influence[300])
    assert entry["worst"]["value"] == pytest.approx(sums.max(), abs=4e-5)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["worst", "rss"])
def test_a_free_dimension_gets_what_a_file_leaves(coarse: tuple[Path, np.ndarray, np.ndarray], kind: str) -> None:
    drawing, error, influence = coarse
    entry = budget(recipe_of(f"sum: {kind}, tolerances: {{profile: free, follower.radius: {RADIUS}}}"), drawing)
    power = 1 if kind == "worst" else 2
    left = ((PERMITTED - np.abs(error)) ** power - (RADIUS * influence) ** power) ** (1.0 / power) / influence
    assert entry["left"]["least"] == pytest.approx(left.min(), abs=4e-5)
    assert entry["left"]["at_deg"] == left.argmin()
    assert entry["ok"]
    assert entry[kind]["value"] == pytest.approx(PERMITTED, rel=1e-9)


def test_the_motion_that_is_lost_to_trimmed_undercut_is_in_the_sums() -> None:
    """A flat face on the metal of all positions of the face: its support, by linear programming on half planes."""
    from scipy.optimize import linprog

    recipe = load_text(
        (ROOT / "recipes" / "disc-trim.yaml").read_text(encoding="utf-8")
        + "budget: {permitted: 0.05, runs: 0, tolerances: {profile: 0.01}}\n",
        "a.yaml",
    )
    entry = budget(recipe)
    degrees = np.arange(0.0, 180.0, 0.1)
    rows, theta = [(16.0, 90.0, "cycloidal"), (-16.0, 90.0, "cycloidal"), (0.0, 180.0, "")], np.radians(degrees)
    reach = 20.0 + motion(rows, degrees)
    normals = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    at = range(660, 670)
    lost = [reach[i] + linprog(-normals[i], normals, reach, bounds=(None, None)).fun for i in at]
    assert np.argmax(lost) not in {0, 9}
    assert entry["worst"]["value"] == pytest.approx(0.01 + max(lost), abs=2e-5)
    assert not entry["ok"]


@pytest.mark.thin(2)
@pytest.mark.parametrize("zero", ["", "zero: 100, "])
def test_a_file_that_is_too_broad_takes_play(zero: str, tmp_path: Path) -> None:
    """A yoke whose disc is 0.03 larger all round: 0.06 less play, wherever the machine is set."""
    text = f"{YOKE % 40.0}{FINE}budget: {{permitted: 1, {zero}runs: 0, tolerances: {{profile: 0.01, breadth: 0.07}}}}\n"
    recipe = load_text(text, "c.yaml")
    play = budget(recipe)["play"]
    assert (play["min"], play["max"]) == pytest.approx((-0.09, 0.09), abs=1e-9)
    play = budget(recipe, drawn(YOKE % 40.03 + FINE, tmp_path))["play"]
    assert (play["min"], play["max"]) == pytest.approx((-0.15, 0.03), abs=2e-3)


def test_a_file_that_is_too_broad_takes_play_of_a_frame(tmp_path: Path) -> None:
    """A contour 0.01 larger all round is what a preload by 0.02 makes of it."""
    body = FINE + "budget: {permitted: 1, runs: 0, tolerances: {breadth: 0.03}}\n"
    preloaded = budget(load_text(FRAME % ("25", ", preload: {interference: 0.02}") + body, "c.yaml"))["play"]
    recipe = load_text(FRAME % ("25", "") + body, "c.yaml")
    play = budget(recipe, drawn(FRAME % ("25.01", "") + FINE, tmp_path))["play"]
    assert budget(recipe)["play"]["max"] > play["max"] + 0.01
    assert (play["min"], play["max"]) == pytest.approx((preloaded["min"], preloaded["max"]), abs=3e-3)


def test_a_trimmed_contour_that_gives_no_motion_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(read_contours, "TRIMMED_WITHIN", 1e-18)
    trimmed = (ROOT / "recipes" / "disc-trim.yaml").read_text(encoding="utf-8")
    stated = "budget: {permitted: 0.05, runs: 0, tolerances: {profile: 0.01}}\n"
    with pytest.raises(
        RecipeErrors, match=r"budget: .* trimmed contour: .*; leave it out, or give a cam without undercut"
    ):
        budget(load_text(trimmed + stated, "a.yaml"))
    assert budget(load_text(trimmed.replace("base_radius: 20", "base_radius: 60") + stated, "a.yaml"))["ok"]
