"""Disc cams as recipes write them: tables on stems and arms, long strokes, hollows of a knife edge, sizes that fail.

Holds: camgeo.cams.guided.
"""

import math

import numpy as np
import pytest

from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

STEM = "{kind: roller, radius: 8}"
ARM = "{kind: roller, radius: 8, arm: {length: 65, pivot: 80}}"
SWING = "[{rise: 20, over: 180, law: cycloidal}, {return: 20, over: 180, law: cycloidal}]"


def recipe(motion, follower, folder, *, units="mm"):
    text = f"units: {units}\ncam: {{kind: disc, base_radius: 36, follower: {follower}, motion: {motion}}}\n"
    text += "part: {outer: 200}\n" if "internal" in follower else ""
    return load_text(text, folder / "case.yaml")


def stroke(made):
    return made.cam.exact().law.derivatives(np.radians(np.arange(0.0, 360.0, 2.0)), 0)[0].max()


@pytest.fixture
def table(tmp_path):
    angles = np.arange(0.0, 360.0, 2.0)
    rows = [f"{a:g};{5.0 * (1.0 - math.cos(math.radians(a))):.4f}" for a in angles]
    (tmp_path / "lift.csv").write_text("\n".join(rows), encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize(
    ("motion", "follower", "units", "greatest"),
    [
        ("{table: lift.csv}", STEM, "mm", 10.0),
        ("{table: lift.csv}", STEM, "inch", 254.0),
        ("{table: lift.csv, units: mm}", STEM, "inch", 10.0),
        ("{table: lift.csv}", ARM, "mm", math.radians(10.0)),
    ],
)
def test_a_table_is_in_the_unit_of_the_follower_s_stroke(motion, follower, units, greatest, table):
    assert stroke(recipe(motion, follower, table, units=units)) == pytest.approx(greatest, rel=1e-4)


def test_a_table_of_an_arm_has_no_unit_of_length(table):
    with pytest.raises(RecipeErrors, match=r"cam\.motion\.units: the follower swings: .*; leave it out"):
        recipe("{table: lift.csv, units: mm}", ARM, table)
    recipe("{table: lift.csv}", ARM, table)


def test_a_stroke_of_a_stem_may_be_longer_than_180(tmp_path):
    motion = "[{rise: 200, over: 180, law: cycloidal}, {return: 200, over: 180, law: cycloidal}]"
    assert stroke(recipe(motion, STEM, tmp_path)) == pytest.approx(200.0)


HEART = (
    "[{rise: 2, over: 20, law: match}, {rise: 26, over: 140, law: constant-velocity},"
    " {rise: 2, over: 20, law: match, at_end: {v: 0, a: 0}}, {return: 2, over: 20, law: match},"
    " {return: 26, over: 140, law: constant-velocity}, {return: 2, over: 20, law: match, at_end: {v: 0, a: 0}}]"
)


def test_a_knife_edge_goes_into_hollows(tmp_path):
    made = recipe(HEART, "{kind: knife-edge}", tmp_path)
    assert designed(made).only_surface.surface.curve.cells.rows[3].min() < 0.0  # somewhere the tangent turns back
    assert pipeline.check(made).ok


@pytest.mark.parametrize(
    ("follower", "motion", "field", "sentence"),
    [
        ("{kind: roller, radius: 8, arm: {length: 10, pivot: 90}}", SWING, ".arm", "reaches 80 to 100 mm"),
        ("{kind: roller, radius: 8, offset: 50}", SWING, ".offset", "below the prime circle's radius, 44 mm"),
        ("{kind: flat, arm: {pivot: 20}}", SWING, ".arm", "must lie between 0 and the pivot's distance"),
        (ARM, SWING.replace("20", "170"), ".arm", "only angles between 0 and 180 can be driven"),
        ("{kind: roller, radius: 38}, track: internal", SWING, "", "the roller does not fit the opening"),
    ],
)
def test_sizes_that_do_not_fit_are_errors_of_the_recipe(follower, motion, field, sentence, tmp_path):
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe(motion, follower, tmp_path))
    (error,) = caught.value.errors
    assert error.path == f"cam.follower{field}"
    assert sentence in error.problem
