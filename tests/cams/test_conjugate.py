"""Conjugate discs in a recipe: what is refused and helps, sizes that keep both discs' limits, figures by disc.

Holds: camgeo.recipe.discs.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from camgeo.measures.figures import design_figures
from camgeo.measures.limits import limit_checks
from camgeo.measures.remarks import remarks_of
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from camgeo.curve.extremes import Extreme
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

STROKES = "[{rise: 24, over: 100, law: LAW}, {dwell: 40}, {return: 24, over: 140, law: LAW}, {dwell: 80}]"
MOTION = STROKES.replace("LAW", "polynomial-4567")
SWING = "[{rise: 20, over: 110, law: modified-sine}, {dwell: 50}, {return: 20, over: 120, law: cycloidal}, {dwell: 80}]"
LOW = "[{rise: 8, over: 120, law: cycloidal}, {return: 8, over: 240, law: cycloidal}]"
STEM = "kind: roller, radius: 9, offset: 6"
ARM = "kind: roller, radius: 8, arm: {length: 65, pivot: 80}"


def text(follower: str, conjugate: str, motion: str = MOTION, size: str = "base_radius: 36", more: str = "") -> str:
    cam = f"cam:\n  {size}\n  kind: disc\n  follower: {{{follower}}}\n  conjugate: {{{conjugate}}}\n"
    return f"{cam}  motion: {motion}\n{more}"


def recipe(*args: str, **kwargs: str) -> Recipe:
    return read(text(*args, **kwargs).encode(), Path("pair.yaml"))


def pair(*args: str, **kwargs: str) -> Design:
    return designed(recipe(*args, **kwargs))


def refused(*args: str, **kwargs: str) -> str:
    with pytest.raises(RecipeErrors) as caught:
        pair(*args, **kwargs)
    (error,) = caught.value.errors
    return str(error).removeprefix("pair.yaml:")


@pytest.mark.parametrize(
    ("follower", "conjugate", "message", "repair"),
    [
        ("kind: knife-edge", "distance: 120", "4:20: cam.follower.kind: a knife edge has no conjugate disc", STEM),
        (
            "kind: flat, arm: {pivot: 80}",
            "distance: 120",
            "4:20: cam.follower.kind: a flat face on an arm has no conjugate disc",
            STEM,
        ),
        (
            "kind: flat, tilt: 5",
            "distance: 120",
            "4:32: cam.follower.tilt: two faces on conjugate discs stand across the stem: leave it out",
            "kind: flat",
        ),
        (STEM, "radius: 9", "5:14: cam.conjugate.distance: missing: give a length above 0", "distance: 120"),
        (STEM, "distance: 120, angle: 90", "5:37: cam.conjugate.angle: does not belong to a stem", "distance: 120"),
        (ARM, "angle: 90", "5:14: cam.conjugate.length: missing: give a length above 0", "length: 60, angle: 90"),
        (ARM, "length: 60", "5:14: cam.conjugate.angle: missing: give an angle in", "length: 60, angle: 90"),
        ("kind: flat", "distance: 90, radius: 4", "5:37: cam.conjugate.radius: a flat face has none", "distance: 90"),
    ],
)
def test_what_does_not_go_together(follower: str, conjugate: str, message: str, repair: str) -> None:
    motion = SWING if "arm" in follower else LOW
    assert re.sub(r"[;:] ", ": ", refused(follower, conjugate, motion)).startswith(message)
    follower, conjugate = (repair, conjugate) if repair.startswith("kind") else (follower, repair)
    assert pair(follower, conjugate, SWING if "arm" in follower else LOW).contours


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("part: {thickness: 8, hub: {diameter: 20, height: 5}}\n", "part.hub: belongs to a cam of one disc"),
        ("linkage: {kind: four-bar, ground: 100, rocker: 80, coupler: 60}\n", "does not carry"),
    ],
)
def test_what_does_not_go_with_two_discs(more: str, message: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        recipe(STEM, "distance: 120", more=more)
    assert any(message in str(error) for error in caught.value.errors) or "linkage" in str(caught.value)


def test_other_tracks_are_refused() -> None:
    track = "base_radius: 36\n  track: {groove: {clearance: 0.03}}"
    assert "cam.track: conjugate discs are followed from outside" in refused(STEM, "distance: 120", size=track)


@pytest.mark.parametrize(
    ("follower", "conjugate", "motion", "key"),
    [
        (STEM, "distance: 60, radius: 5", MOTION, "distance"),
        (STEM, "distance: 60, radius: 20", MOTION, "distance"),
        (ARM, "length: 60, angle: 40", SWING, "angle"),
        (ARM, "length: 60, angle: 40, radius: 30", SWING, "angle"),
        ("kind: flat", "distance: 40", LOW, "distance"),
    ],
)
def test_discs_too_near_are_refused_with_the_least_distance(
    follower: str, conjugate: str, motion: str, key: str
) -> None:
    told = refused(follower, conjugate, motion)
    assert f"cam.conjugate.{key}: disc 2 would have no base circle" in told
    (least,) = re.findall(r"above ([\d.]+) ", told)
    there = re.sub(rf"{key}: \d+", f"{key}: {float(least) * (1 + 1e-5)}", conjugate)
    exact = recipe(follower, there, motion).cam.exact()
    assert len(exact.surfaces) == 2
    near = re.sub(rf"{key}: \d+", f"{key}: {float(least) * (1 - 1e-5)}", conjugate)
    assert "disc 2 would have no base circle" in refused(follower, near, motion)


# --- sizes ------------------------------------------------------------------------------------------------------------


def least_by_brute_force(cam: Recipe, apart: float, rise: float, back: float) -> float:
    """Least prime circle over offsets in steps of 0.01 mm, by both discs' pressure angles at 1800 shaft angles."""
    s, v = cam.cam.exact().motion.rows(np.radians(np.arange(1800) / 5), 1)
    up, down = 1 / math.tan(math.radians(rise)), 1 / math.tan(math.radians(back))
    e = np.arange(-15, 15, 0.01)[:, None]
    low = np.maximum((v - e) * up, (e - v) * down) - s
    high = apart - s - np.maximum((e - v) * down, (v - e) * up)
    d = low.max(axis=1)
    kept = d <= high.min(axis=1)
    return float(np.hypot(d, e[:, 0])[kept].min())


@pytest.mark.slow
@pytest.mark.parametrize(("rise", "back"), [(30, 30), (35, 25), (25, 40)])
def test_a_stem_is_sized_by_both_discs(rise: int, back: int) -> None:
    size = f"sizing: {{pressure-angle: {{at_most: {rise}, on_return: {back}}}}}"
    free = "kind: roller, radius: 3"
    told = refused(free, "distance: 60", size=size)
    (least,) = re.findall(r"a distance of at least ([\d.]+) mm does", told)
    assert "no base radius keeps" in refused(free, f"distance: {float(least) * 0.9999}", size=size)
    for share in (1.0, 1.1):
        apart = share * float(least)
        cam = recipe(free, f"distance: {apart!r}", size=size)
        prime = cam.cam.sizes["base_radius"] + 3.0
        if share > 1.0:  # at the least distance one offset alone keeps them
            assert prime == pytest.approx(least_by_brute_force(cam, apart, rise, back), abs=0.03)
        within(designed(cam), rise, back)


def within(design: Design, rise: float, back: float) -> None:
    """Both discs keep the limits, and one of them is at one."""
    reached = [[math.degrees(math.atan(most.value)) for most in steepest(design, k)] for k in (0, 1)]
    for up, down in reached:
        assert up <= rise + 1e-6
        assert down <= back + 1e-6
    assert (
        min(abs(max(one) - limit) for one, limit in zip(zip(*reached, strict=True), (rise, back), strict=True)) < 1e-6
    )


def steepest(design: Design, k: int) -> tuple[Extreme, Extreme]:
    found = design.exact.steepest(design.exact.surfaces[k])
    assert found is not None
    return found


def test_a_stem_with_its_offset_given_is_sized_by_both_discs() -> None:
    size = "sizing: {pressure-angle: {at_most: 30}}"
    follower = "kind: roller, radius: 9, offset: 3"
    (least,) = re.findall(r"a distance of at least ([\d.]+) mm does", refused(follower, "distance: 60", size=size))
    within(pair(follower, f"distance: {least}", size=size), 30, 30)


@pytest.mark.thin(2)
@pytest.mark.parametrize("side", ["trailing", "leading"])
def test_a_bell_crank_is_sized_by_both_discs(side: str) -> None:
    """No pivot near the one that was found keeps the limits on both discs with a smaller base radius."""
    size = "sizing: {pressure-angle: {at_most: 35, on_return: 30}}"
    follower = f"kind: roller, radius: 4, arm: {{length: 65, side: {side}}}"
    cam = recipe(follower, "length: 60, angle: 90", SWING, size)
    within(designed(cam), 35, 30)
    base, pivot = cam.cam.sizes["base_radius"], cam.cam.sizes["follower.arm.pivot"]
    for off in (-0.5, -0.05, 0.05, 0.5):
        arm = follower.replace("65,", f"65, pivot: {pivot + off!r},")
        other = pair(arm, "length: 60, angle: 90", SWING, f"base_radius: {base - 0.01!r}")
        angles = [math.degrees(math.atan(most.value)) for k in (0, 1) for most in steepest(other, k)]
        assert max(angles[0] - 35, angles[1] - 30, angles[2] - 35, angles[3] - 30) > 1e-3


def test_flat_faces_are_sized_by_both_discs() -> None:
    size = "sizing: {radius-of-curvature: {at_least: 30}}"
    assert pair("kind: flat", "distance: 90", LOW, size).contours
    told = refused("kind: flat", "distance: 62", LOW, size)
    assert "radius of curvature of disc 2" in told
    assert "a larger conjugate.distance leaves more" in told


# --- figures, remarks, remedies ---------------------------------------------------------------------------------------


def test_figures_are_of_the_worst_disc() -> None:
    cam = recipe(STEM, "distance: 85, radius: 8")
    design = designed(cam)
    found = design_figures(
        cam, design, design.checks, ["pressure-angle-rise", "pressure-angle-return", "size", "pitch-radius"]
    )
    assert {name: one.surface for name, one in found.items()} == {
        "pressure-angle-rise": "disc 2",
        "pressure-angle-return": "disc 2",
        "size": "disc 1",
        "pitch-radius": "disc 2",
    }
    low, high = design.exact.surfaces[1].extremes("slope") or (None, None)
    assert low is not None
    assert high is not None
    # on the return disc 2 drives, so that its own greatest slope is there
    assert found["pressure-angle-return"].value == pytest.approx(math.degrees(math.atan(high.value)), abs=1e-9)
    assert found["pressure-angle-rise"].value == pytest.approx(-math.degrees(math.atan(low.value)), abs=1e-9)


def test_remarks_say_which_size_would_keep_the_rules() -> None:
    cam = recipe(STEM, "distance: 85, radius: 8")
    told = {remark.name: remark.sentence for remark in remarks_of(cam, designed(cam))}
    assert "reaches 46.96 deg on disc 2" in told["pressure-angle"]
    base, apart = re.findall(
        r"a base radius of ([\d.]+) and a conjugate.distance of ([\d.]+) keeps", told["pressure-angle"]
    )[0]
    other = pair(STEM, f"distance: {apart}, radius: 8", size=f"base_radius: {base}")
    assert max(math.atan(most.value) for k in (0, 1) for most in steepest(other, k)) <= math.radians(30.0)
    (apart,) = re.findall(
        r"the roller's radius on disc 2.*which a conjugate.distance of ([\d.]+) keeps", told["large-roller"]
    )
    rounder = recipe(STEM, f"distance: {apart}, radius: 8")
    assert "large-roller" not in {remark.name for remark in remarks_of(rounder, designed(rounder))}


def undercut(design: Design) -> dict[str, str]:
    checks = [check for check in design.checks if not check.ok and check.name.startswith(("undercut", "radius"))]
    return {check.surface: check.detail for check in checks if check.detail}


@pytest.mark.slow
def test_undercut_of_disc_2_and_what_frees_it() -> None:
    sharp = STROKES.replace("LAW", "parabolic").replace("140", "60").replace("80", "160")
    told = undercut(pair(STEM, "distance: 100, radius: 26", sharp))
    assert set(told) == {"disc 2"}
    (radius,) = re.findall(r"a conjugate.radius below ([\d.]+) would be free of it", told["disc 2"])
    assert not undercut(pair(STEM, f"distance: 100, radius: {float(radius) * 0.9999}", sharp))
    assert undercut(pair(STEM, f"distance: 100, radius: {float(radius) * 1.001}", sharp))


def test_undercut_under_two_faces_and_what_frees_it() -> None:
    steep = "[{rise: 16, over: 90, law: cycloidal}, {return: 16, over: 270, law: cycloidal}]"
    told = undercut(pair("kind: flat", "distance: 56", steep, "base_radius: 20"))
    assert set(told) == {"disc 1", "disc 2"}
    (more,) = re.findall(r"a conjugate.distance larger by more than ([\d.]+)", told["disc 2"])
    left = undercut(pair("kind: flat", f"distance: {56 + 1.001 * float(more)}", steep, "base_radius: 20"))
    assert set(left) == {"disc 1"}
    (base,) = re.findall(r"a base radius larger by more than ([\d.]+)", told["disc 1"])
    assert "with a conjugate.distance larger by as much" in told["disc 1"]
    by = 1.001 * float(base)
    both = pair("kind: flat", f"distance: {56 + 1.001 * float(more) + by}", steep, f"base_radius: {20 + by}")
    assert not undercut(both)
    assert both.contours


def test_limits_of_disc_2_name_what_helps() -> None:
    limit = "limits: {radius-of-curvature: {at_least: 12}, pressure-angle: {at_most: 30}}\n"
    cam = recipe(STEM, "distance: 85, radius: 8", more=limit)
    design = designed(cam)
    told = {check.name: check for check in limit_checks(cam, design, list(design.checks), [], None)}
    assert {check.surface for check in told.values()} == {"disc 2"}
    assert "a larger conjugate.distance, a smaller stroke" in told["limit:pressure-angle"].detail
    (radius,) = re.findall(r"a conjugate.radius of ([\d.]+) mm", told["limit:radius-of-curvature"].detail)
    other = recipe(STEM, f"distance: 85, radius: {radius}", more=limit)
    held = {check.name: check.ok for check in limit_checks(other, designed(other), [], [], None)}
    assert held["limit:radius-of-curvature"]
    farther = recipe(STEM, "distance: 120, radius: 8", more=limit)
    assert {check.ok for check in limit_checks(farther, designed(farther), [], [], None) if "angle" in check.name} == {
        True
    }


# --- extremes ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("radius", [1e-3, 34.0])
def test_a_tiny_and_a_large_second_roller(radius: float) -> None:
    """Disc 2 comes down to a hundredth of its roller's radius from the shaft."""
    d = math.hypot(45, 0) + 24
    apart = d + radius * 1.01
    cam = recipe("kind: roller, radius: 9", f"distance: {apart!r}, radius: {radius!r}")
    _, second = cam.cam.exact().surfaces
    angle = np.radians([110.0, 125.0])  # at the top, where disc 2 is lowest
    assert np.hypot(*second.curve.sample(angle).point.T) == pytest.approx(0.01 * radius, abs=1e-12)


def test_arms_square_to_the_line_of_centres() -> None:
    """Where arm 2 points at the tangent from the pivot b = C sin psi2 is greatest, and nothing is singular there."""
    psi = math.degrees(math.acos((80**2 + 65**2 - 44**2) / (2 * 80 * 65)))
    for at in (0.0, 20.0):  # at the lowest, at the greatest position
        design = pair(ARM, f"length: 60, angle: {psi + at + 90!r}", SWING)
        assert all(check.ok for check in design.checks)


def test_a_grown_pair_keeps_its_pitch_curves() -> None:
    cam = recipe(STEM, "distance: 120, radius: 11, gap: 2", more="part: {thickness: 8}\n")
    exact = designed(cam).exact
    grown = exact.grow(0.1, 2.0)
    t = np.linspace(0.0, 6.0, 50)
    for one, other in zip(exact.surfaces, grown.surfaces, strict=True):
        assert other.base.sample(t).point == pytest.approx(2 * one.base.sample(t).point, abs=1e-11)
        assert other.radius == pytest.approx(2 * (one.radius - 0.1))
    assert grown.gap == 4.0
    flat = designed(recipe("kind: flat", "distance: 90", LOW)).exact
    for one, other in zip(flat.surfaces, flat.grow(0.1, 1.0).surfaces, strict=True):
        at = one.curve.sample(t)
        normal = np.stack([at.tangent[:, 1], -at.tangent[:, 0]], axis=1)
        assert other.curve.sample(t).point == pytest.approx(at.point + 0.1 * normal, abs=1e-11)
