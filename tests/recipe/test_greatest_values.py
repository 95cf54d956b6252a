"""The greatest values of fields, each allowed, and a little more refused with the bound in the message."""

from __future__ import annotations

import pytest

import camgeo

RISE = "cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 8}, motion: {formula: 3*(1 - cos(t))}}\n"
HALF = "cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 5, over: VALUE, law: cycloidal}]}\n"
MILLED = "manufacture: {cutter: 6, feed: 600, plunge: 120, spindle: 8000, start: VALUE}\n"
BUDGET = "budget: {permitted: 0.1, tolerances: {profile: 0.01, angle: VALUE}}\n"
SEED = "budget: {permitted: 0.1, tolerances: {profile: 0.01}, seed: VALUE}\n"


@pytest.mark.parametrize(
    ("text", "most", "more"),
    [
        (HALF, "180", "180.5"),
        (RISE + "part: {thickness: 10, bolts: {count: VALUE, circle: 400, hole: 2}}\n", "60", "61"),
        (RISE + MILLED, "360", "360.5"),
        (RISE + MILLED, "-360", "-360.5"),
        (RISE + BUDGET, "45", "45.5"),  # needs: budget
        (RISE + SEED, "4294967295", "4294967296"),  # needs: budget
    ],
)
def test_the_greatest_value_is_allowed_and_no_more(text: str, most: str, more: str) -> None:
    camgeo.load(text.replace("VALUE", most))
    with pytest.raises(camgeo.RecipeErrors) as refused:
        camgeo.load(text.replace("VALUE", more))
    assert most in str(refused.value)
