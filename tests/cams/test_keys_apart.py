"""Keys of a cam that contradict each other: each fault with its place and remedy, as the recipe is read."""

from __future__ import annotations

import pytest

from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors

FILLED = "[{rise: 12, over: 110, law: cycloidal}, {dwell: 60}, {return: 12, over: 170, law: cycloidal}, {dwell: 20}]"
ROLLER = "kind: roller, radius: 9"
PRESSED = "preload: {interference: 0.02, stiffness: [1e7]}, "
SECOND = "conjugate: {radius: 9, distance: 110}, "
LAW = "law: [{rise: 4, over: 20, law: cycloidal}, {return: 4, over: 25, law: cycloidal}]"


def disc(follower: str, more: str = "", motion: str = FILLED, size: str = "base_radius: 36") -> str:
    return f"{{kind: disc, {size}, follower: {{{follower}}}, {more}motion: {motion}}}"


def corners(more: str) -> str:
    return f"{{kind: support, reuleaux: {{{more}}}}}"


def rollers(route: str) -> str:
    return f"{{kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, {route}}}"


FAULTS = [
    (
        disc(f"{ROLLER}, arm: {{length: 65, pivot: 80}}, offset: 3"),
        "follower.offset: belongs to a stem, not to an arm;",
    ),
    (disc("kind: flat, width: 30, arm: {pivot: 80}"), "follower.width: belongs to a stem, not to an arm; leave it out"),
    (disc("kind: flat, tilt: 5, arm: {pivot: 80}"), "follower.tilt: belongs to a stem, not to an arm; leave it out"),
    *(
        (
            disc(follower, "track: internal, "),
            "track: a ring is followed by a roller, given internal; give a roller, or ",
        )
        for follower in ("kind: flat", "kind: shoe, radius: 5", "kind: knife-edge")
    ),
    (disc(f"{ROLLER}, arm: {{length: 65}}"), "follower.arm.pivot: missing; give a length above 0, its distance from "),
    (disc(ROLLER, PRESSED), "preload: one contact alone is not preloaded; give conjugate, or leave preload out"),
    (
        disc(ROLLER, f"{PRESSED}track: {{groove: {{clearance: 0.03}}}}, "),
        "preload: a roller in a groove needs clearance; for preload take conjugate discs, or leave it out",
    ),
    (
        disc(ROLLER, motion=FILLED.replace("110", "least").replace("dwell: 20", "dwell: rest")),
        "motion[0].over: nothing bounds it, given least; give limits, such as limits: {pressure-angle: {at_most: 30}}",
    ),
    (
        disc(
            ROLLER,
            motion=FILLED.replace("170", "least").replace("dwell: 20", "dwell: rest"),
            size="sizing: {pressure-angle: {at_most: 30}}",
        ),
        "motion[2].over: the size is found for angles that are given, given least; give base_radius in place of ",
    ),
    (
        disc(ROLLER, motion=FILLED.replace("dwell: 20", "dwell: 10")),
        "motion: the segments do not fill their angle, given 350 degrees; let them cover the whole turn, 360 degrees",
    ),
    (disc(ROLLER, f"{SECOND}track: internal, "), "track: conjugate discs are followed from outside; leave it out, or "),
    # three angles follow from the others
    (
        corners("sides: 5, angles: [30], breadth: 40, rounding: 2"),
        "reuleaux.angles: not as many as 5 sides leave open, given 1; give 2; the last three follow",
    ),
    (
        corners("sides: 3, angles: [30], breadth: 40, rounding: 2"),
        "reuleaux.angles: not as many as 3 sides leave open, given 1; leave it out: it is regular",
    ),
    (
        corners("sides: 3, breadth: 40, rounding: 20"),
        "reuleaux.rounding: not below half the breadth, given 20; give less than 20 mm",
    ),
    (rollers("delta: {harmonics: 3}"), "delta.harmonics: cannot stand without a law; leave it out, or give delta.law"),
    (rollers("delta: {cos: {1: 625}, formula: 600*cos(t)}"), "delta.cos: cannot stand beside formula; leave one of "),
    (rollers(f"delta: {{sin: {{1: 625}}, {LAW}}}"), "delta.sin: cannot stand beside law; leave one of them out"),
]


def test_keys_that_contradict_each_other() -> None:
    for cam, words in FAULTS:
        with pytest.raises(RecipeErrors) as caught:
            load_text(f"cam: {cam}\n", "cam.yaml")
        assert f": cam.{words}" in str(caught.value.errors[0]), cam


def test_what_is_just_allowed() -> None:
    for cam in (
        corners("sides: 3, breadth: 40, rounding: 19.99"),
        corners("sides: 5, angles: [20, 40], breadth: 40, rounding: 2"),
        disc("kind: flat", "conjugate: {distance: 110}, "),
        disc(ROLLER, PRESSED + SECOND),
    ):
        assert load_text(f"cam: {cam}\n", "cam.yaml")
