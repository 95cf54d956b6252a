"""Disc cams at the ends of what is possible, from the recipe's text: each passes, or is refused with one clear line.

Where one passes, its file is touched by brute force too.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.brute_disc import Touching, motion, polygon

from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

TOLERANCE, STEP = 1e-3, 0.01
PLATE = [(24.0, 100.0, "cycloidal"), (0.0, 40.0, ""), (-24.0, 140.0, "polynomial-345"), (0.0, 80.0, "")]
SWING = [(20.0, 110.0, "cycloidal"), (0.0, 50.0, ""), (-20.0, 120.0, "cycloidal"), (0.0, 80.0, "")]
SHARP = [(20.0, 60.0, "cycloidal"), (0.0, 10.0, ""), (-20.0, 60.0, "cycloidal"), (0.0, 230.0, "")]
BENT = 14.113168077048332  # least convex radius of SHARP's pitch curve about a prime circle of 26 mm


def short(by: float) -> list[tuple[float, float, str]]:
    """A rise over a hundredth of a degree."""
    return [(by, 0.01, "cycloidal"), (0.0, 100.0, ""), (-by, 100.0, "cycloidal"), (0.0, 159.99, "")]


def arm(base: float, pivot: float, length: float, radius: float = 8.0) -> tuple[Touching, float]:
    return Touching("roller", radius, pivot=pivot, length=length, sense=1), base


def near_pi(short_of: float) -> tuple[Touching, float]:
    """An arm that swings to that many degrees before it is stretched out beyond the shaft."""
    low = math.radians(180.0 - 20.0 - short_of)
    prime = math.sqrt(80.0**2 + 78.0**2 - 2 * 80.0 * 78.0 * math.cos(low))
    return arm(prime - 8.0, 80.0, 78.0)


def stem(offset: float, radius: float = 9.0, prime: float = 45.0) -> tuple[Touching, float]:
    return Touching("roller" if radius else "knife-edge", radius, offset), prime - radius


PASSING = {
    "eccentricity 0.999 of the prime radius": (*stem(45 * 0.999), PLATE),
    "eccentricity within 1e-6 of the prime radius": (*stem(45 * (1 - 1e-6)), PLATE),
    "eccentricity against, within 1e-6 of the prime radius": (*stem(-45 * (1 - 1e-6)), PLATE),
    "knife edge, eccentricity 0.999 of the prime radius": (*stem(45 * 0.999, 0.0), PLATE),
    "pivot inside the disc": (*arm(60.0, 30.0, 80.0), SWING),
    "arm nearly folded onto the line of centres": (*arm(10.0, 80.0, 62.0 + 1e-3), SWING),
    "arm nearly stretched beyond the shaft": (*near_pi(0.05), SWING),
    "roller at 1e-9 of undercut": (Touching("roller", BENT * (1 - 1e-9)), 26.0 - BENT * (1 - 1e-9), SHARP),
    "knife edge, a rise over 0.01 degree": (*stem(0.0, 0.0), short(1e-3)),
    "roller, a rise of a nanometre over 0.01 degree": (*stem(0.0, 5.0), short(1e-6)),
    "arm, a rise of 1e-6 degrees over 0.01 degree": (*arm(40.0, 80.0, 65.0, 5.0), short(1e-6)),
}

REFUSED = {
    "eccentricity of the prime radius": (
        *stem(45.0),
        PLATE,
        "cam.follower.offset: the offset, 45 mm, must be below the prime circle's radius, 45 mm",
    ),
    "arm that just does not reach": (*arm(10.0, 80.0, 62.0), SWING, "cam.follower.arm: an arm of 62 mm about a pivot"),
    "arm that swings beyond the line of centres": (*near_pi(-0.05), SWING, "only angles between 0 and 180 can be"),
}

FAILING = {
    "roller of the least radius of curvature": (Touching("roller", BENT), 26.0 - BENT, SHARP, "pitch-radius"),
    "roller at 1e-9 beyond undercut": (
        Touching("roller", BENT * (1 + 1e-9)), 26.0 - BENT * (1 + 1e-9), SHARP, "undercut-local",
    ),
    "roller, a rise over 0.01 degree": (*stem(0.0, 5.0), short(1e-3), "undercut-local"),
    "flat, a rise over 0.01 degree": (Touching("flat"), 40.0, short(1e-3), "undercut-local"),
    "face on an arm, a rise over 0.01 degree": (
        Touching("flat", pivot=80.0, sense=1), 40.0, short(1e-3), "undercut-local",
    ),
}  # fmt: skip

# permitted motion errors, mm or degrees, of those so steep that no limit follows from the tolerance
STEEP = {
    "eccentricity within 1e-6 of the prime radius": 0.15,
    "eccentricity against, within 1e-6 of the prime radius": 0.15,
    "arm nearly stretched beyond the shaft": 0.25,
}


def recipe(touching, base, rows, motion_error=None):
    more = f"export: {{tolerance: {TOLERANCE}, files: [dxf]}}\n"
    more += "" if motion_error is None else f"verify: {{motion_error: {motion_error}}}\n"
    return load_text(touching.recipe(base, rows, more), "cam.yaml")


@pytest.mark.slow
@pytest.mark.parametrize("name", PASSING)
def test_it_passes(name: str, tmp_path: Path) -> None:
    touching, base, rows = PASSING[name]
    if name in STEEP:
        report = pipeline.check(recipe(touching, base, rows)).report
        (failed,) = [check for check in report["checks"] if not check["ok"]]
        assert (failed["name"], failed["limit"]) == ("motion", None)
        assert "no limit follows from the tolerance here; give verify.motion_error" in failed["detail"]
    outcome = pipeline.export(recipe(touching, base, rows, STEEP.get(name)), tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    remarks = {remark["name"] for remark in outcome.report["remarks"]}
    assert ("pivot-clearance" in remarks) == (name == "pivot inside the disc" or "beyond the shaft" in name)
    vertices = polygon(tmp_path / "cam" / "cam.dxf", STEP)
    degrees = np.arange(0.0, 360.0, 7.5)
    place = [touching.place(vertices, theta, base) for theta in np.radians(degrees)]
    off = np.array(place) - touching.rest(base)
    off = np.abs((np.degrees(off) if touching.sense else off) - motion(rows, degrees)).max()
    told = outcome.report["files"][0]["motion"]
    (limit,) = (check["limit"] for check in outcome.report["checks"] if check["name"] == "motion")
    # the vertices stand back from their arcs as much as the file may from the exact contour, in proportion
    assert off <= told["max"] + told["remainder"] + limit / TOLERANCE * STEP**2 / 8 * (1 / 4 + 1 / 4)


@pytest.mark.parametrize("name", REFUSED)
def test_it_is_refused(name: str) -> None:
    touching, base, rows, message = REFUSED[name]
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe(touching, base, rows))
    (error,) = caught.value.errors
    assert message in str(error)
    assert error.line > 0


@pytest.mark.thin(8)
@pytest.mark.parametrize("name", FAILING)
def test_it_fails_before_a_file_is_made(name: str) -> None:
    touching, base, rows, check = FAILING[name]
    report = pipeline.check(recipe(touching, base, rows)).report
    assert report["files"] == []
    assert check in {found["name"] for found in report["checks"] if not found["ok"]}


@pytest.mark.slow
def test_a_knife_edge_that_is_thrown_over_half_a_turn() -> None:
    """Its bounds of the turn are infinite, and stay so."""
    touching = Touching("knife-edge", pivot=50.0, length=55.0, sense=1)
    rows = [(150.0, 0.001, "cycloidal"), (0.0, 50.0, ""), (-150.0, 1.0, "polynomial-345"), (0.0, 308.999, "")]
    pipeline.check(recipe(touching, 20.0, rows))


@pytest.mark.slow
def test_a_size_that_only_a_radius_of_curvature_bounds() -> None:
    """A knife edge on a line through the shaft sets no least size of its own."""
    text = (
        Touching("knife-edge")
        .recipe(1.0, PLATE, "")
        .replace("base_radius: 1.0", "sizing: {radius-of-curvature: {at_least: 0.1}}")
    )
    made = load_text(text, "cam.yaml")
    (bent,) = (check for check in pipeline.check(made).report["checks"] if check["name"] == "radius-of-curvature")
    assert bent["value"] == pytest.approx(0.1, rel=1e-6)


def test_a_motion_that_no_size_mends() -> None:
    rows = [(5.0, 180.0, "parabolic"), (-5.0, 179.0, "parabolic"), (0.0, 1.0, "")]
    text = Touching("roller", 5.0).recipe(1.0, rows, "").replace("parabolic", "constant-velocity")
    with pytest.raises(RecipeErrors, match="does not join") as caught:
        load_text(text.replace("base_radius: 1.0", "sizing: {pressure-angle: {at_most: 30}}"), "cam.yaml")
    assert "base_radius" not in str(caught.value)
