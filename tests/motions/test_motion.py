"""A motion by a formula, a table, points or a lobe, from the recipe's text to the judged cam."""

import math
import pickle

import numpy as np
import pytest
from support.motion_recipes import HALF, ROLLER, fault, lift, rad, read_motion, recipe, sampled, written

from camgeo.motions.inputs import TURN
from camgeo.motions.motion import FormulaMotion, Segments, motion_field
from camgeo.output import pipeline
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.loading import load
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.fields import Kind, field_at
from camgeo.schema.json_schema import table_schema
from camgeo.synthesis.design import designed
from kin.law.normalised import IntentError


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    "motion",
    [
        "{formula: 10*(1 - cos(t))}",
        "{table: lift.csv}",
        "{points: [[0, 0], [30, 2], [60, 6], [90, 10], [120, 12], [180, 12]]}",
        "{lobe: {lift: 3, half: 68, powers: [2, 8, 14, 20, 26]}}",
    ],
)
def test_a_plate_of_any_source_is_exported_and_passes(motion, tmp_path):
    written(tmp_path, HALF, sampled(HALF))
    made = recipe(motion, tmp_path)
    assert pickle.loads(pickle.dumps(made)) == made
    assert hash(made.cam) == hash(recipe(motion, tmp_path).cam)
    (tmp_path / "lift.csv").unlink()  # the recipe is complete
    outcome = pipeline.check(made)
    assert outcome.ok
    theta = np.arange(0.0, 180.0, 7.0)
    first, second = lift(made, theta)[0], lift(made, theta + 180)[0]
    stroke = lift(made, np.array([180.0]))[0, 0]
    assert second == pytest.approx(stroke - first, abs=1e-12)  # Shu and Wu eq. 2
    assert lift(made, np.array([0.0]))[0, 0] == pytest.approx(0, abs=1e-12)


def test_a_formula_is_in_radians_and_in_the_recipe_s_unit(tmp_path):
    made = recipe("{formula: 0.2*(1 - cos(t))}", tmp_path, "kind: constant-breadth, base_radius: 1.5", units="inch")
    theta = np.arange(0.0, 180.0, 15.0)
    assert lift(made, theta)[0] == pytest.approx(5.08 * (1 - np.cos(np.radians(theta))), abs=1e-13)
    swing = recipe("{formula: 3*sin(2*t)**3}", tmp_path, ROLLER, "law").cam.exact().law
    assert np.degrees(swing.psi_of_shaft(rad(30), 0)[0]) == pytest.approx([3 * math.sin(rad(60)) ** 3], abs=1e-12)


def test_points_are_met_and_equal_neighbours_rest(tmp_path):
    made = recipe("{points: [[0, 0], [20, 0], [40, 0], [70, 4], [100, 9], [130, 12], [180, 12]]}", tmp_path)
    assert lift(made, np.array([0.0, 31.0, 40.0, 70.0, 100.0, 130.0, 155.0]))[0] == pytest.approx(
        [0, 0, 0, 4, 9, 12, 12], abs=1e-12
    )
    rests = made.cam.motion.motion(math.pi, "motion", -1).rests
    assert [(round(math.degrees(r.begin), 9), round(math.degrees(r.end), 9)) for r in rests] == [(0, 40), (130, 180)]


def test_points_of_a_whole_turn_rest_over_its_end():
    asked = read_motion("{points: [[0, 5], [40, 5], [90, 9], [200, 8], [300, 5], [360, 5]]}")
    made = asked.motion(2 * math.pi, "motion", 1)
    ((begin, end, level),) = made.rests
    assert np.degrees([begin, end]) == pytest.approx([300, 400], abs=1e-9)
    assert level == pytest.approx(0, abs=1e-3)  # the spline's least is a little lower, beside it
    assert made.range[0] == pytest.approx(0, abs=1e-12)
    assert made.derivatives(np.radians([90.0, 200.0]), 0)[0] == pytest.approx([4 + level, 3 + level], abs=1e-12)
    still = read_motion("{points: [[0, 5], [40, 5]]}").motion(2 * math.pi, "motion", 1)
    assert still.range == (0, 0)


def test_segments_that_repeat_are_made_once_and_stand_on_their_least():
    asked = read_motion(
        "{repeat: 3, segments: [{return: 4, over: 50, law: cycloidal}, {rise: 4, over: 70, law: cubic}]}"
    )
    assert isinstance(asked, Segments)
    made = asked.motion(2 * math.pi, "motion", 1)
    assert (asked.repeats, made.total) == (3, 2 * math.pi / 3)
    assert made.range == pytest.approx((0, 4), abs=1e-12)
    assert made.periodic().period == made.total


def test_a_formula_of_a_whole_turn_stands_on_its_least():
    made = FormulaMotion("7 - 12*cos(t)", 1.0).motion(2 * math.pi, "motion", 1)
    assert made.derivatives(np.array([0.0, math.pi]), 0)[0] == pytest.approx([0, 24], abs=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "{repeat: 3, segments: [{rise: 4, over: 50, law: cycloidal}]}",
            (
                "motion: the segments do not fill their angle, given 50 degrees; let them cover 360/3 degrees; "
                "an angle may be a fraction such as 180/7"
            ),
        ),
        (
            "{segments: [{dwell: 360}]}",
            "motion.repeat: missing, needed with segments; give a whole number from 1 to 100",
        ),
        ("{repeat: 2, formula: cos(t)}", "motion.repeat: cannot be combined with formula; leave it out"),
        ("{formula: cos(t), reading: 1}", "motion.reading: cannot stand without a table; leave it out"),
    ],
)
def test_keys_of_a_mapping_that_do_not_go_together(text, message):
    with pytest.raises(RecipeErrors) as caught:
        read_motion(text)
    assert message in str(caught.value)


def test_the_schema_takes_what_the_reader_takes():
    field = motion_field("motion", Kind.LENGTH, "a turn", over=TURN)
    segments, sources = field.form.schema(field)["anyOf"]
    assert segments["items"]["properties"]["over"]["anyOf"][0]["maximum"] == 360
    assert sources == table_schema(field.form.instead)
    assert [one["required"] for one in sources["oneOf"]] == [
        ["segments", "repeat"],
        ["formula"],
        ["table"],
        ["points"],
        ["lobe"],
        ["contour"],
    ]
    part = motion_field("law", Kind.ANGLE, "a part of a turn")
    assert set(table_schema(part.form.instead)["properties"]) == {
        *(
            "formula",
            "table",
            "angle",
            "period",
            "columns",
            "scale",
            "offset",
            "reading",
            "rest",
            "suspect",
            "points",
            "lobe",
        ),
    }


def test_a_number_of_a_source_can_be_varied_by_its_path():
    kinds = {"cam": "constant-breadth"}
    for path in ("cam.motion.lobe.lift", "cam.motion[0].rise", "cam.motion.reading"):
        assert field_at(recipe_table(), path, kinds) is not None
    assert field_at(recipe_table(), "cam.motion.lobe.drop", kinds) is None


@pytest.mark.parametrize(
    ("motion", "path", "message", "mended"),
    [
        (
            "{formula: 10*(2 - cos(t))}",
            "cam.motion.formula",
            "the motion begins at 10; S(0) must be 0: make every displacement 10 less",
            "{formula: 10*(2 - cos(t)) - 10}",
        ),
        (
            "{points: [[0, -1], [60, 3], [120, 7], [180, 9]]}",
            "cam.motion.points[0]",
            "the motion begins at -1; S(0) must be 0: make every displacement 1 more",
            "{points: [[0, 0], [60, 4], [120, 8], [180, 10]]}",
        ),
        (
            "{points: [[0, 0], [60, 3], [120, 7], [170, 9]]}",
            "cam.motion.points",
            "the angles must reach from 0 to 180 degrees, these from 0 to 170",
            "{points: [[0, 0], [60, 3], [120, 7], [180, 9]]}",
        ),
        (
            "{lobe: {lift: 3, half: 95, powers: [2, 8, 14, 20, 26]}}",
            "cam.motion.lobe.half",
            "half the event lies between 0 and 90 degrees, not 95",
            "{lobe: {lift: 3, half: 80, powers: [2, 8, 14, 20, 26]}}",
        ),
        (
            "{formula: 5*sin(t/2)}",
            "cam.motion",
            "the motion does not join over the half turn",
            "{formula: 5*sin(t/2)**2}",
        ),
        (
            "{formula: abs(t - 1) - 1}",
            "cam.motion",
            "p' jumps from -1 to 1 mm/rad at 57.2958 degrees",
            "{formula: t - sin(2*t)/2}",
        ),
        (
            "4 - 4*cos(2*t)",
            "cam.motion",
            "a formula stands in a mapping, given '4 - 4*cos(2*t)'; give {formula: 4 - 4*cos(2*t)}",
            "{formula: 4 - 4*cos(2*t)}",
        ),
        (
            "7",
            "cam.motion",
            "not a list, given 7; give a list of segments",
            "[{rise: 9, over: 120, law: cubic}, {dwell: 60}]",
        ),
    ],
)
def test_what_no_plate_can_do_is_refused_at_its_field(motion, path, message, mended, tmp_path):
    error = fault(motion, tmp_path)
    assert error.path == path
    assert message in str(error)
    recipe(mended, tmp_path).cam.exact()


@pytest.mark.thin(4)
@pytest.mark.parametrize("stroke", [1e-7, 1e-3, 2.0])
def test_a_rise_over_a_hundredth_of_a_degree_is_exact_or_fails_its_check(stroke, tmp_path):
    form = f"{stroke}*max(0, min(1, (t - 1)/{math.radians(0.01)!r}))"
    assert "p' jumps" in str(fault(f"{{formula: '{form}'}}", tmp_path))  # a ramp alone would tear the contour
    made = recipe(f"[{{dwell: 100}}, {{rise: {stroke:.9f}, over: 0.01, law: cycloidal}}, {{dwell: 79.99}}]", tmp_path)
    middle = lift(made, np.array([100.005]), 1)
    assert middle[:, 0] == pytest.approx([stroke / 2, 2 * stroke / rad(0.01)], rel=1e-9)
    outcome = pipeline.check(made)
    failed = {check["name"] for check in outcome.report["checks"] if not check["ok"]}
    assert failed == (set() if stroke == 1e-7 else {"radius-of-curvature", "undercut-local"})


def test_kin_s_own_error_keeps_its_angle(tmp_path):
    with pytest.raises(IntentError) as caught:
        recipe("{formula: 5*sin(t/2)}", tmp_path).cam.exact()
    assert caught.value.at_deg == 180


TINY_RAMP = "{lobe: {lift: 8, half: 60, powers: [2, 8, 14, 20, 26], ramp: {height: 1e-12, velocity: 0.02}}}"
LAW_IN_DEGREES = "[{rise: 8, over: 120, law: {table: law.csv}}, {return: 8, over: 240, law: cycloidal}]"


@pytest.mark.parametrize(
    ("motion", "told", "mended"),
    [
        (
            "{table: lift.csv, scale: 0}",
            "cam.motion.scale: times 0 no motion is left, given 0; give another number, or leave it out",
            "{table: lift.csv, scale: 2}",
        ),
        (
            TINY_RAMP,
            "motion.lobe.ramp.height: at its velocity so low a ramp lasts 7e-11 degrees: give one of 0.0001 or more",
            TINY_RAMP.replace("1e-12", "1e-5"),
        ),
        (
            LAW_IN_DEGREES,
            "law.table: law.csv, the column 'deg' is in degrees; a share from 0 to 1 of a law's stroke or of its angle",
            LAW_IN_DEGREES.replace("law.csv", "named.csv"),
        ),
    ],
)
def test_a_motion_that_is_none_is_told_with_a_remedy(motion, told, mended, tmp_path):
    rows = "".join(f"{angle},{5.0 - 5.0 * np.cos(np.radians(angle)):.5f}\n" for angle in range(0, 361, 5))
    (tmp_path / "lift.csv").write_text(f"angle,lift\n{rows}", "utf-8")
    shares = "".join(f"{u:.2f},{u - np.sin(2.0 * np.pi * u) / 2.0 / np.pi:.5f}\n" for u in np.linspace(0.0, 1.0, 41))
    (tmp_path / "law.csv").write_text(f"deg,s\n{shares}", "utf-8")
    (tmp_path / "named.csv").write_text(f"u,s\n{shares}", "utf-8")
    file = tmp_path / "cam.yaml"
    head = "cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 10}, motion: "
    file.write_text(f"{head}{motion}}}\n", "utf-8")
    with pytest.raises(RecipeErrors) as refused:
        designed(load(file))
    assert told in str(refused.value)
    assert len(str(refused.value).splitlines()) == 1
    file.write_text(f"{head}{mended}}}\n", "utf-8")
    assert designed(load(file)).exact.motion is not None
