"""Checks of printed bodies: where each may be limited, and what helps against bodies that meet."""

from __future__ import annotations

import pytest

from camgeo.capabilities.mechanism.checks import ANSWERS, slimmer_sizes
from camgeo.recipe.loading import load_text

RECIPE = """
cam: {{kind: disc, base_radius: 20, follower: {{kind: roller, radius: 5}}, motion: [{{rise_fall: 8, over: 360}}]}}
part: {{thickness: 8, bore: {{hexagon: 10}}}}
{mechanism}
"""


def test_what_is_checked_of_bodies():
    assert {check.name for check in ANSWERS.checks} == {"clearance", "collision", "outline"}
    assert all(check.units == ("mm",) for check in ANSWERS.checks)


@pytest.mark.parametrize(
    ("mechanism", "words"),
    [
        ("", "a smaller mechanism.pin"),
        ("mechanism: {bar: 9}", "a smaller mechanism.bar"),
        ("mechanism: {knob: 30, wall: 4, bar: 9}", "smaller mechanism.wall, mechanism.bar and mechanism.knob"),
    ],
)
def test_what_makes_bodies_slimmer(mechanism, words):
    assert slimmer_sizes(load_text(RECIPE.format(mechanism=mechanism), "slim.yaml")) == words
