"""A frame that is to swing by a law over the shaft angle: sound files pass, false ones and false lifts are caught.

The verdict rests on the swing: a file that follows its lift to the last digit fails where the lift is not the law's.
"""

from __future__ import annotations

import dataclasses
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from support import followers
from support.camfiles import arcs_through, write_dxf
from support.cases import few
from support.intent import gauge_of, linked
from support.square_frame import RESTS, Bars, Bench

from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.law.frame_swing import frame_swing
from kin.law.support_function import lift_constant_breadth
from kin.linkage.four_bar import InvertedSliderCrank
from kin.linkage.mechanism import Mechanism
from kin.read.files import read_drawing

E = 1e-4  # mm, the tolerance
ANGLES = 90
EDGES = 1000
TEXT = """\
cam:
  kind: constant-breadth
  base_radius: 80
  swing: [{rise: 20, over: 140, law: polynomial-4567}, {dwell: 60}]
linkage: {kind: inverted-slider-crank, ground: 80, rocker: 15, joint_offset: 6}
part: {thickness: 8, bore: 10}
export: {tolerance: 0.02, files: [{dxf: {as: polyline}}]}
verify: {angles: 360}
"""


def read(old="", new=""):
    assert old in TEXT
    return load_text(TEXT.replace(old, new), "a.yaml")


@pytest.fixture(scope="module")
def intent():
    recipe = read()
    return intended(recipe, designed(recipe))


def file_of(folder, lift, turned=0.0):
    """Arcs through points of the contour of a lift, closer to it than the tolerance."""
    t = np.arange(EDGES) * 2 * np.pi / EDGES
    p, dp = lift.derivatives(t, 1)
    points = np.column_stack([p * np.cos(t) - dp * np.sin(t), p * np.sin(t) + dp * np.cos(t)])
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    return write_dxf(folder / "cam.dxf", *arcs_through(points @ np.array([[c, s], [-s, c]])))


def failures(path, intent):
    checks = verify(path, intent, ANGLES, Limits(E)).checks
    return {check.name for check in checks if not check.ok}


def false_lift(intent, law):
    """What is meant by an intent whose lift has come from another law: all but the swing agrees with the file."""
    lift = lift_constant_breadth(80.0, law.half_turn, "swing")
    breadth = float(lift.derivatives(np.array([0.0, math.pi]), 0)[0].sum())
    mechanism = Mechanism(intent.linkage.mechanism.linkage, lift, breadth)
    (surface,) = linked(intent, mechanism=mechanism).surfaces
    surfaces = (dataclasses.replace(surface, gauge=followers.yoke(lift, breadth=breadth)),)
    return dataclasses.replace(linked(intent, mechanism=mechanism), surfaces=surfaces), lift


def test_a_sound_file_passes(tmp_path, intent):
    assert failures(file_of(tmp_path, gauge_of(intent).motion), intent) == set()


FAULTS = {
    "the offset's sign": ("joint_offset: 6", "joint_offset: -6"),
    "crossed for open": ("joint_offset: 6", "joint_offset: 6, assembly: crossed"),
    "a ground longer by a micrometre in 50": ("ground: 80", "ground: 80.02"),
    "the rocker without the offset": ("joint_offset: 6", "joint_offset: 0"),
    "a rise less by 0.002 degrees": ("rise: 20, over: 140", "rise: 19.998, over: 139.998"),
    "another law": ("polynomial-4567", "polynomial-345"),
    "against the shaft": (
        "[{rise: 20, over: 140, law: polynomial-4567}, {dwell: 60}]",
        "[{return: 20, over: 100, law: polynomial-4567}, {dwell: 60}]",
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_the_cam_of_another_swing_is_caught(tmp_path, intent, fault):
    wrong = read(*FAULTS[fault]).cam.exact().law
    assert failures(file_of(tmp_path, wrong), intent) >= {"contour", "motion", "linkage-error"}


@pytest.mark.parametrize("turned", few([0.02, -0.02]))
def test_a_turned_cam_is_caught(tmp_path, intent, turned):
    assert failures(file_of(tmp_path, gauge_of(intent).motion, turned), intent) >= {"contour", "linkage-error"}


@pytest.mark.slow
@pytest.mark.parametrize("part", few(["motion", "links"]))
def test_a_lift_that_is_not_the_laws_is_caught_by_the_swing_alone(tmp_path, intent, part):
    """As a generator would make it that mistook the law: the file is what its own lift says, exactly."""
    law = intent.linkage.swing
    if part == "motion":
        wrong = frame_swing(read("polynomial-4567", "polynomial-345").cam.frame_swing.motion, 80.0, 9.0, 1.0)
    else:
        wrong = frame_swing(law.motion, 80.05, 9.0, 1.0)
    meant, lift = false_lift(intent, wrong)
    path = file_of(tmp_path, lift)
    assert failures(path, linked(meant, swing=None)) == set()
    assert failures(path, meant) == {"linkage-error"}


@pytest.mark.slow
def test_the_judge_holds_the_file_against_the_law_over_the_shaft_angle(tmp_path):
    """The reported error is that of the polygon in the file, turned in a rigid square by plain geometry."""
    recipe = load_text(TEXT, "a.yaml")
    outcome = pipeline.export(recipe, tmp_path)
    assert outcome.ok
    reported = outcome.report["linkage"]["error"]
    path = next(Path(tmp_path).rglob("*.dxf"))
    vertices = read_drawing(path).contour.vertices
    law = recipe.cam.frame_swing
    lift = recipe.cam.exact().law
    breadth = float(lift.derivatives(np.array([0.0, math.pi]), 0)[0].sum())
    bars = Bars("inverted", 80.0, rocker=15.0, aside=6.0)
    bench = Bench(bars, breadth, cache(lambda x: float(lift.derivatives(x, 0)[0, 0])))
    phi = np.arange(0.0, 2 * math.pi, 0.0199)
    worst = max(
        np.degrees(np.abs(bench.measured(vertices, phi, rest) - law.output(phi, 0).c[0])).max()
        for rest in RESTS.values()
    )
    assert 0.5 * reported["max"] < worst <= reported["max"] * (1 + 1e-9)
    assert reported["unit"] == "deg"


def test_what_is_given_to_the_judge(intent):
    assert isinstance(intent.linkage.mechanism.linkage, InvertedSliderCrank)
    assert intent.linkage.swing is not None
    plain = TEXT.replace("swing: [{rise: 20, over: 140, law: polynomial-4567}, {dwell: 60}]", "motion: [{dwell: 180}]")
    recipe = load_text(plain, "a.yaml")
    assert intended(recipe, designed(recipe)).linkage.swing is None
