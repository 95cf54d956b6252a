"""Segments of a motion and their own laws: what they make, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

from camgeo.motions.segments import MotionSegment, PointsLaw, SccaLaw, UniformLaw
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from kin.law.normalised import IntentError
from kin.law.sources.programme import Dwell, Move


def test_a_dwell_and_a_return_as_kin_takes_them():
    assert MotionSegment("dwell", 0.5).step() == Dwell(0.5)
    step = MotionSegment("return", 1.0, 4.0, "cycloidal").step()
    assert isinstance(step, Move)
    assert (step.over, step.by, step.to) == (1.0, -4.0, None)
    to = MotionSegment("to", 1.0, 4.0, "cycloidal").step()
    assert isinstance(to, Move)
    assert (to.by, to.to) == (None, 4.0)


@pytest.mark.parametrize(
    ("segment", "field"),
    [
        (MotionSegment("rise", 1.0, 4.0, "match", split=0.4), "motion.split"),
        (MotionSegment("rise", 1.0, 4.0, "cycloidal", at_end=(1.0, 0.0)), "motion.at_end"),
    ],
)
def test_what_does_not_go_with_a_law(segment, field):
    with pytest.raises(IntentError) as caught:
        segment.step()
    assert caught.value.field == field


def test_laws_of_a_recipes_own():
    at = np.array([0.0, 0.5, 1.0])
    blends = UniformLaw((math.radians(10.0), math.radians(10.0)))
    uniform = blends.law(math.radians(60.0), "law").derivatives(at, 1)
    assert uniform[0] == pytest.approx(at, abs=1e-15)
    assert uniform[1] == pytest.approx([0.0, 1.2, 0.0], abs=1e-14)  # 1/(1 - 1/6) between two blends of a sixth
    with pytest.raises(IntentError, match="take 20 degrees, their segment 15"):
        blends.law(math.radians(15.0), "law")
    constant = SccaLaw(constant=1.0).law(1.0, "law").derivatives(np.array([0.25]), 1)
    assert constant[:, 0] == pytest.approx([0.125, 1.0], abs=1e-14)  # constant acceleration of 4
    through = PointsLaw(((0.0, 0.0), (0.4, 0.25), (1.0, 1.0))).law(1.0, "law")
    assert through.derivatives(np.array([0.4]), 0)[0, 0] == pytest.approx(0.25, abs=1e-14)


@pytest.mark.parametrize("kind", ["rise", "return", "to"])
def test_a_segment_without_a_law_has_that_of_the_starters(kind):
    cam = "{{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 8}}, motion: [{}]}}"
    moves = {"rise": "{rise: 9, over: 90%s}", "return": "{return: 9, over: 90%s}", "to": "{to: 9, over: 90%s}"}
    others = {
        "rise": "{return: 9, over: 90, law: cycloidal}",
        "return": "{rise: 9, over: 90, law: cycloidal}",
        "to": "{to: 0, over: 90, law: cycloidal}",
    }
    segments = [moves[kind], "{dwell: 90}", others[kind], "{dwell: 90}"]
    if kind == "return":
        segments = segments[2:] + segments[:2]
    text = f"cam: {cam.format(', '.join(segments))}\nexport: {{tolerance: 0.01, files: [dxf]}}\n"
    bare, given = (load_text(text % law, Path("case.yaml")) for law in ("", ", law: modified-sine"))
    assert bare.cam == given.cam
    with pytest.raises(RecipeErrors, match="needs a law"):
        load_text(text % ", split: 0.4", Path("case.yaml"))


@pytest.mark.parametrize(
    ("segments", "message"),
    [
        ("[{rise: 9, over: least, law: cycloidal}, {return: 9, over: 90, law: cycloidal}]", "no dwell takes the rest"),
        ("[{rise: 9, over: 90, law: cycloidal}, {dwell: rest}]", "every other angle is given"),
        ("[{rise: 9, over: 90, law: {uniform: {blend: [10]}}}]", "not two angles"),
        ("[{rise: 9, over: 90, law: {points: [[0, 0], [1]]}}]", "not a point"),
        ("[{rise: 9, over: 90, law: {polynomial: [0, 2]}}]", "let c0 be 0 and the sum of all coefficients 1"),
        ("[{dwell: 90, split: 0.4}]", "split"),
    ],
)
def test_segments_that_are_refused(segments, message):
    cam = f"{{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 8}}, motion: {segments}}}"
    with pytest.raises(RecipeErrors, match=message):
        load_text(f"cam: {cam}\nexport: {{tolerance: 0.01, files: [dxf]}}\n", Path("case.yaml"))


@pytest.mark.parametrize(("word", "key"), [("fall", "return"), ("raise", "rise"), ("hold", "dwell")])
def test_other_words_for_a_segment_name_its_key(word, key):
    more = "" if key == "dwell" else ", over: 90, law: cycloidal"
    motion = f"[{{rise: 9, over: 90, law: cycloidal}}, {{{word}: 9{more}}}]"
    with pytest.raises(RecipeErrors) as caught:
        load_text(f"cam: {{kind: disc, base_radius: 30, follower: {{kind: flat}}, motion: {motion}}}", "cam.yaml")
    (error,) = caught.value.errors
    assert (error.path, error.remedy) == (f"cam.motion[1].{word}", f"did you mean {key}?")
