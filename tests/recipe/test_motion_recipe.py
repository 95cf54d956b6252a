"""Recipes whose motion uses the whole grammar of segments, from the text to the judged cam."""

import math

import numpy as np
import pytest

from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from kin.law.sources.laws import named, scca, split
from kin.law.sources.programme import Dwell, JointState, Matched, Move, programme

rad = math.radians


def intent(motion, head="kind: constant-breadth, base_radius: 60", units="mm"):
    return read(f"units: {units}\ncam: {{{head}, motion: {motion}}}\n".encode(), "case.yaml").cam.exact().law


def displacement(lift, degrees):
    return lift.derivatives(np.radians(degrees), 0)[0] - lift.datum


def test_a_window_of_constant_velocity_is_exported_and_passes():
    body = """\
cam:
  kind: constant-breadth
  base_radius: 45
  motion:
    - {rise: 4, over: 40, law: match}
    - {rise: 6, over: 40, law: constant-velocity}
    - {to: 14, over: 60, law: match}
    - {dwell: 40}
export: {files: [{dxf: {as: polyline, tolerance: 0.01}}]}
verify: {angles: 360}
"""
    recipe = read(body.encode(), "window.yaml")
    assert pipeline.check(recipe).ok
    lift = recipe.cam.exact().law
    rows = lift.derivatives(np.radians([41.0, 60.0, 79.0]), 2)
    assert rows[1] == pytest.approx([6 / rad(40)] * 3, rel=1e-13)
    assert rows[2] == pytest.approx([0, 0, 0], abs=1e-13)


def test_each_kind_of_segment_is_what_it_says():
    lift = intent(
        "[{rise: 5, over: 60, law: {scca: {sine: 0.25, velocity: 0.3}}, split: 0.4}, {to: 2, over: 40, law: cubic}, "
        "{rise_fall: 1, over: 40}, {displacement: u**3*(10-15*u+6*u**2), over: 30}, {dwell: 10}]"
    )
    law = split(scca(0.25, 0.0, 0.3), 0.4).motion
    u = np.array([0.2, 0.5, 0.9])
    assert displacement(lift, 60 * u) == pytest.approx(5 * law.derivatives(u, 0)[0], abs=1e-13)
    assert displacement(lift, np.array([60.0, 100.0, 120.0, 140.0, 155.0, 170.0, 175.0])) == pytest.approx(
        [5, 2, 3, 2, 2.5, 3, 3], abs=1e-13
    )


def test_inches_scale_strokes_formulas_and_states():
    rest = "over: 60, law: match}, {dwell: 40}]"
    mm = "[{rise: 5.08, over: 80, law: match, at_end: {v: 0, a: -12.7}}, {return: 5.08, " + rest
    inch = "[{rise: 0.2, over: 80, law: match, at_end: {v: 0, a: -0.5}}, {return: 0.2, " + rest
    theta = np.linspace(0, 360, 73)
    first = displacement(intent(mm), theta)
    head = "kind: constant-breadth, base_radius: 2.4"
    assert displacement(intent(inch, head, "inch"), theta) == pytest.approx(first, abs=1e-12)
    turning = JointState(0.0, -12.7)
    motion = programme(
        [Move(rad(80), Matched(at_end=turning), by=5.08), Move(rad(60), Matched(), by=-5.08), Dwell(rad(40))],
        math.pi,
        around=-1,
    )
    assert first[:37] == pytest.approx(motion.derivatives(np.radians(theta[:37]), 0)[0], abs=1e-12)
    formula = "[{displacement: 0.2*u**3*(10-15*u+6*u**2), over: 140}, {dwell: 40}]"
    last = displacement(intent(formula, head, "inch"), np.array([140.0]))
    assert last == pytest.approx([5.08], abs=1e-13)


def test_a_swinging_follower_takes_the_same_segments():
    text = """\
cam:
  kind: flat-pair
  ratio: 2
  arm: 60
  law: [{to: 4, over: 40, law: freudenstein-13}, {dwell: 10}, {to: 0, over: 40, law: double-harmonic}]
"""
    law = read(text.encode(), "swing.yaml").cam.exact().law
    at = law.psi.derivatives(np.radians([20.0, 40.0, 45.0, 60.0]), 0)[0]
    back = float(named("double-harmonic").motion.derivatives(0.75, 0)[0, 0])
    assert np.degrees(at) / 2 == pytest.approx([2, 4, 4, 4 * back], abs=1e-12)


@pytest.mark.parametrize(
    ("motion", "field", "message"),
    [
        (
            "[{rise: 5, over: 90, law: match}, {return: 5, over: 60, law: match}, {dwell: 30}]",
            "cam.motion[0]",
            "two matched segments meet at 90 degrees: give the first one `at_end: {v: ..., a: ...}`",
        ),
        (
            "[{rise: 5, over: 90, law: double-harmonic, split: 0.3}, {dwell: 90}]",
            "cam.motion[0].split",
            "double-harmonic is not symmetric: its acceleration cannot be split",
        ),
        (
            "[{rise: 5, over: 90, law: match, split: 0.3}, {dwell: 90}]",
            "cam.motion[0].split",
            "a matched segment takes no split",
        ),
        (
            "[{rise: 5, over: 90, law: cubic, at_end: {v: 1}}, {dwell: 90}]",
            "cam.motion[0].at_end",
            "only a matched segment takes a state at its end",
        ),
        (
            "[{displacement: 1 + u, over: 90}, {dwell: 90}]",
            "cam.motion[0].displacement",
            "a displacement counts from the segment's start: f(0) must be 0, not 1",
        ),
    ],
)
def test_what_does_not_go_together_is_refused_at_its_field(motion, field, message):
    recipe = read(f"cam: {{kind: constant-breadth, base_radius: 60, motion: {motion}}}\n".encode(), "case.yaml")
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe)
    (error,) = caught.value.errors
    assert error.path == field
    assert message in str(error)
