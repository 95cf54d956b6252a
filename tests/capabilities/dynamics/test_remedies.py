"""What would let checks and limits of a follower train hold, in words."""

from pathlib import Path

import pytest

from camgeo.capabilities.dynamics.remedies import of_limit, stronger_spring
from camgeo.recipe.loading import read

TEXT = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion: {formula: 6*(1 - cos(t))}
dynamics: {mass: 1, rpm: 60, preload: 100, rate: 3000, stiffness: 30000}
export: {tolerance: 0.01, files: [dxf]}
"""
RECIPE = read(TEXT.encode(), Path("train.yaml"))


def test_the_preload_makes_up_for_what_the_stiffness_gives_way():
    entry = {"name": "float", "value": -20.0, "limit": 0.0, "ok": False}
    report = {"checks": [entry]}
    assert stronger_spring(entry, report, RECIPE) == "a dynamics.preload of 122"  # 100 + 20 (1 + 3000/30000)
    held = {**entry, "value": 5.0, "ok": True}
    assert stronger_spring(held, {"checks": [held]}, RECIPE) == ""


@pytest.mark.parametrize(
    ("figure", "value", "bound", "words"),
    [
        ("contact-pressure", 2000.0, 1000.0, "contacts 4 times as wide"),  # with the root of force over width
        ("contact-pressure", 500.0, 1000.0, "contacts 0.25 times as wide"),
        ("contact-force-greatest", 500.0, 400.0, "a smaller dynamics.preload, less mass or load"),
        ("guide-force", 500.0, 400.0, "a longer guide, or a smaller dynamics.preload"),
        ("contact-force-least", 5.0, 10.0, "a greater dynamics.preload, or a lower dynamics.rpm"),
        ("least-backlash", 0.1, 0.2, "a greater dynamics.backlash"),
        ("jam-margin", 5.0, 10.0, "a longer guide, less overhang or friction of it"),
    ],
)
def test_what_changes_a_figure(figure, value, bound, words):
    assert of_limit(RECIPE, figure, value, bound).startswith(words)
    assert of_limit(RECIPE, figure, value, 0.0) == ""


def test_what_holds_already_needs_nothing():
    assert of_limit(RECIPE, "least-backlash", 0.3, 0.2) == ""
    assert of_limit(RECIPE, "stroke", 1.0, 2.0) == ""
