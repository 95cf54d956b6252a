"""Intents of files: of one disc or of all, each where it stands, of the part as a compensation alters it."""

import pytest

import camgeo
from camgeo.output.file_intent import intent_of_file, shaft_of_file
from camgeo.recipe.machining import Compensation
from camgeo.synthesis.design import designed

PAIR = """
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  conjugate: {distance: 120, radius: 11, gap: 2}
  motion: [{rise: 24, over: 110, law: modified-sine}, {dwell: 50}, {return: 24, over: 120, law: cycloidal}, {dwell: 80}]
part: {thickness: 12, bore: 20}
"""
PLAIN = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {bore: 10}\n"


def test_discs_stand_above_each_other():
    recipe = camgeo.load(PAIR)
    shaft = shaft_of_file(recipe, designed(recipe), "stl")
    assert [part.name for part in shaft.parts] == [disc.name for disc in designed(recipe).discs]
    assert shaft.levels == (0.0, 14.0)
    with pytest.raises(ValueError, match="too many values"):
        intent_of_file(recipe, designed(recipe), "stl")


def test_a_kerf_alters_the_intent():
    recipe = camgeo.load(PLAIN)
    (nominal,) = shaft_of_file(recipe, designed(recipe), "dxf").parts
    (cut,) = shaft_of_file(recipe, designed(recipe), "dxf", Compensation(kerf=0.4)).parts
    assert [nominal.bore, cut.bore] == pytest.approx([10.0, 9.6])
