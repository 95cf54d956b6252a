"""What each family of cams advises, in the words of its recipe: all in one pass, of recipes alone."""

from __future__ import annotations

import math

import pytest

from camgeo.recipe.loading import load_text

MOTION = "[{rise: 12, over: 110, law: cycloidal}, {dwell: 60}, {return: 12, over: 170, law: cycloidal}, {dwell: 20}]"
HALF = "motion: [{rise: 10, over: 100, law: cycloidal}, {dwell: 80}]"


def disc(follower: str, more: str = "", size: str = "base_radius: 36") -> str:
    return f"cam: {{kind: disc, {size}, follower: {{{follower}}}, {more}motion: {MOTION}}}\n"


PLATE = "cam: {kind: support, p: 30 + 3*cos(2*t)}\n"
REULEAUX = "cam: {kind: support, reuleaux: {sides: 3, breadth: 40, rounding: 5}}\n"
ROLLERS = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n"
FACES = "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {1: 252}}}\n"
ROLLER = disc("kind: roller, radius: 9")
RING = disc("kind: roller, radius: 8", "track: internal, ", "base_radius: 80") + "part: {outer: 300}\n"
SIZED = disc("kind: roller, radius: 8, offset: 0", size="sizing: {pressure-angle: {at_most: 30}}")
ROUND = disc("kind: flat", size="sizing: {radius-of-curvature: {at_least: 10}}")
SIZED_RING = SIZED.replace("motion", "track: internal, motion") + "part: {outer: 400}\n"

# largest roller without undercut, or growth that takes it away, mm; and what is said of it
UNDERCUT = [
    (PLATE, 3.0, "a p larger by more than 3 would have no undercut"),
    (f"units: inch\n{PLATE}", 25.4, "a p larger by more than 1 would have no undercut"),
    (
        "cam: {kind: support, fourier: {mean: 25, cos: {3: 2}}}\n",
        3.0,
        "a fourier.mean larger by more than 3 would have no undercut",
    ),
    (
        "cam: {kind: support, hypocycloid: {cusps: 3, size: 5, breadth: 90}}\n",
        3.0,  # p has half the breadth
        "a hypocycloid.breadth larger by more than 6 would have no undercut",
    ),
    (REULEAUX, 3.0, "a reuleaux.rounding larger by more than 3 would have no undercut"),
    (REULEAUX, 14.9, "a reuleaux.rounding larger by more than 14.9 would have no undercut"),
    (
        REULEAUX,
        15.0,  # a rounding of half the breadth is a circle
        "a reuleaux.rounding larger by more than 15 and a reuleaux.breadth of more than 40 would have no undercut",
    ),
    (
        f"cam: {{kind: constant-breadth, base_radius: 40, {HALF}}}\n",
        3.0,
        "a base radius larger by more than 3 would have no undercut",
    ),
    (
        f"cam: {{kind: constant-diameter, base_radius: 30, roller_radius: 8, {HALF}}}\n",
        3.0,
        "a roller radius below 3 with a base radius of 38 less that radius would be free of it",
    ),
    (ROLLERS, 3.0, "a roller radius below 3 would have no undercut"),
    (ROLLERS, 0.0, "no roller radius is proved to have no undercut"),
    (FACES, 3.0, "a smaller swing would have no undercut"),
    (
        "cam: {kind: flat-pair, ratio: 3, arm: 60, arc: {radius: 300}}\n",
        3.0,
        f"an arc.radius nearer to {120.0 * math.cos(math.pi / 6.0):.6g} would have no undercut",
    ),
    (disc("kind: flat"), 3.0, "a base radius larger by more than 3 would be free of it"),
    (
        disc("kind: flat, arm: {pivot: 80}"),
        3.0,
        "a base radius larger by more than 3 with arm.face smaller by as much would be free of it",
    ),
    (ROLLER, 3.0, "a roller radius below 3 with a base radius of 45 less that radius would be free of it"),
    (ROLLER, 0.0, "no roller radius is proved to be free of it"),
    (
        disc("kind: shoe, radius: 9"),
        3.0,
        "a shoe radius below 3 with a base radius of 45 less that radius would be free of it",
    ),
    (
        disc("kind: roller, radius: 8, arm: {length: 65, pivot: 80}"),
        3.0,
        "a roller radius below 3 with a base radius of 44 less that radius would be free of it",
    ),
    (RING, 3.0, "a roller radius below 3 with a base radius of 72 and that radius would be free of it"),
    (
        disc("kind: roller, radius: 9", "track: {groove: {clearance: 0.03}}, "),
        3.0,
        "a roller radius below 2.97 with a base radius of 45 less that radius would be free of it",
    ),
    (SIZED, 3.0, "radius-of-curvature: {at_least: 8} under sizing would be free of it"),  # the roller's radius
    (ROUND, 3.0, "radius-of-curvature: {at_least: 20} under sizing would be free of it"),  # twice what is asked
    (SIZED_RING, 3.0, "a roller radius below 3 would be free of it"),
    (SIZED_RING, 0.0, ""),
]


def test_what_takes_undercut_away() -> None:
    for text, free_at, words in UNDERCUT:
        recipe = load_text(text, "cam.yaml")
        assert recipe.cam.advice.free_of_undercut(free_at, recipe.mm) == words


def test_what_makes_a_radius_of_curvature_larger() -> None:
    """From 7 to 8 on a flat face's contour; below 7, the pitch curve's least, for a roller."""
    rows = {
        PLATE: "a p larger by more than 1 mm",
        ROLLERS: "a roller radius below 7 mm",
        FACES: "",
        ROLLER: "a roller radius below 7 mm with a base radius of 45 less that radius",
        disc("kind: roller, radius: 9", "track: {groove: {clearance: 0.03}}, "): (
            "a roller radius below 6.97 mm with a base radius of 45 less that radius"
        ),
        SIZED: "radius-of-curvature: {at_least: 8} under sizing",
        SIZED_RING: "a roller radius below 7 mm",
    }
    for text, words in rows.items():
        advice = load_text(text, "cam.yaml").cam.advice
        assert advice.rounder(7.0, 8.0, "mm") == words
        if "roller radius" in words:
            assert advice.rounder(0.0, 8.0, "mm") == ""
    assert load_text(PLATE, "cam.yaml").cam.advice.rounder(7.0, 7.0, "mm") == "a larger p"


def test_disc_2_has_advice_of_its_own() -> None:
    pair = load_text(disc("kind: roller, radius: 9", "conjugate: {radius: 7, distance: 110}, "), "cam.yaml").cam.advice
    first, second = pair.on("disc 1"), pair.on("disc 2")
    assert (first.radius, second.radius) == (9.0, 7.0)
    assert first.most_radius == 45.0
    assert second.most_radius == pytest.approx(110.0 - 57.0)  # opposite the highest place of disc 1's pitch curve
    assert second.free_of_undercut(3.0, 1.0) == "a conjugate.radius below 3 would be free of it"
    assert second.rounder(7.0, 8.0, "mm") == "a conjugate.radius below 7 mm"
    assert load_text(RING, "cam.yaml").cam.advice.most_radius == math.inf


def test_a_round_tappet_reaches_the_lobe_s_farther_edge() -> None:
    wide = load_text(disc("kind: flat"), "cam.yaml").cam.advice
    assert wide.wider_face(50.0, 1.0) == "a follower.width of 50"
    tappet = load_text(
        disc("kind: flat, diameter: 40, axial_offset: 3") + "part: {thickness: 10}\n", "cam.yaml"
    ).cam.advice
    # half the thickness beyond the offset
    assert tappet.wider_face(30.0, 1.0) == "a follower.diameter of 34"
