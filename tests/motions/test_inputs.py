"""The grammar of motions over a length of travel: segments, formulas, tables and points, and their messages."""

import math

import numpy as np
import pytest
from support.motion_recipes import reader_of

from camgeo.motions.inputs import Input
from camgeo.motions.motion import motion_field
from camgeo.recipe.keys import UNITS
from camgeo.schema.fields import MOST, Kind
from kin.law.normalised import IntentError
from kin.numeric.lengths import in_unit

TRAVEL = Input(Kind.LENGTH, "travel", MOST, "x")


def read(text, units="mm"):
    reader, node = reader_of(text)
    reader.units, reader.mm = units, UNITS[units]
    source = reader.field(motion_field("motion", Kind.LENGTH, "a travel", over=TRAVEL), node, "motion")
    return source, [str(error) for error in reader.errors]


def test_segments_have_lengths_and_need_not_end_where_they_begin():
    source, errors = read(
        "[{dwell: 1}, {rise: 2, over: 5, law: cycloidal}, {return: 3, over: 4, law: harmonic}]", "inch"
    )
    assert errors == []
    motion = source.motion(source.covered, "motion", None, open_ends=True)
    assert motion.total == pytest.approx(254.0, rel=1e-15)
    lift, slope = motion.derivatives(np.array([0.0, 3.5, 6.0, 8.0, 10.0]) * 25.4, 1)
    assert lift / 25.4 == pytest.approx([1.0, 2.0, 3.0, 1.5, 0.0], abs=1e-14)  # the least is 0
    assert slope == pytest.approx([0.0, 2 * 2 / 5, 0.0, -3 / 4 * math.pi / 2, 0.0], abs=1e-14)  # without a unit


def test_a_state_at_the_end_is_per_length():
    source, errors = read("[{rise: 2, over: 4, law: match, at_end: {v: 0.5, a: -0.25}}]", "inch")
    assert errors == []
    end = source.motion(source.covered, "motion", None).at_end(2)
    assert end.tolist() == pytest.approx([2 * 25.4, 0.5, -0.25 / 25.4], rel=1e-13)


def test_a_formula_in_x_has_the_recipes_unit():
    source, errors = read("{formula: 0.1*x**2, over: 3}", "inch")
    assert errors == []
    rows = source.motion(source.covered, "motion", None, open_ends=True).derivatives(np.array([0.0, 25.4, 76.2]), 2)
    assert rows[0] / 25.4 == pytest.approx([0.0, 0.1, 0.9], abs=1e-15)
    assert rows[1] == pytest.approx([0.0, 0.2, 0.6], abs=1e-15)
    assert rows[2] * 25.4 == pytest.approx([0.2, 0.2, 0.2], rel=1e-14)


def test_points_are_met_over_their_length():
    source, errors = read("{points: [[0, 1], [10, 3], [25, 2]], over: 25}")
    assert errors == []
    motion = source.motion(source.covered, "motion", None, open_ends=True)
    assert motion.derivatives(np.array([0.0, 10.0, 25.0]), 0)[0] == pytest.approx([0.0, 2.0, 1.0], abs=1e-14)


@pytest.mark.parametrize("text", ["{lobe: {lift: 3, half: 60}}", "{contour: a.dxf}", "{formula: x}"])
def test_what_is_not_made_over_a_length_is_refused(text):
    assert read(text)[1]


def test_messages_speak_of_lengths():
    source, _ = read("[{rise: 1, over: 30, law: match}, {return: 1, over: 20, law: match}]")
    with pytest.raises(IntentError) as caught:
        source.motion(50.0, "motion", None)
    words = in_unit(caught.value.message, 25.4, "in", travel=True)
    assert words.startswith("two matched segments meet at 1.1811 in: ")


# --- tables -----------------------------------------------------------------------------------------------------------


def written(tmp_path, text, keys="", units="mm", kind=Kind.LENGTH):
    """A table's motion, as read from a file beside the recipe, and the faults."""
    path = tmp_path / "lift.csv"
    path.write_text(text, "utf-8")
    reader, node = reader_of(f"{{table: {path}{keys}}}")
    reader.units, reader.mm = units, UNITS[units]
    source = reader.field(motion_field("motion", kind, "a travel", over=TRAVEL), node, "motion")
    return source, [str(error) for error in reader.errors]


def ramp(x):
    return 3.0 + 0.1 * x + 0.004 * x**2


def rows_of(unit=1.0, step=1.0, count=41, mark=","):
    return "".join(f"{k * step / unit:.7f}{mark}{ramp(k * step):.6f}\n" for k in range(count))


@pytest.mark.parametrize(
    ("heading", "unit", "keys", "units"),
    [
        ("travel_in,lift_mm\n", 25.4, "", "mm"),
        ("", 25.4, ", length: inch", "mm"),
        ("x,lift_mm\n", 25.4, "", "inch"),
        ("x,lift\n", 0.0254, ", length: thou, units: mm", "inch"),
        ("travel_mm,lift_mm\n", 1.0, "", "inch"),
        ("n,s,travel_cm\n", 10.0, ", columns: [travel, s]", "mm"),
        ("", 1.0, ", columns: {column: 2, step: 1}", "mm"),
    ],
)
def test_a_table_over_a_length_is_in_the_unit_of_its_heading_of_its_key_or_of_the_recipe(
    tmp_path, heading, unit, keys, units
):
    rows = rows_of(unit)
    if heading.startswith("n,"):
        rows = "".join(f"{k},{row.split(',')[1]},{row.split(',')[0]}\n" for k, row in enumerate(rows.splitlines()))
    source, errors = written(tmp_path, heading + rows, keys, units)
    assert errors == []
    scale = 1.0 if "mm" in heading + keys or units == "mm" else 25.4
    assert source.covered == pytest.approx(40.0, abs=1e-5)
    motion = source.motion(source.covered, "motion", None, open_ends=True)
    x = np.linspace(0.0, source.covered, 99)
    lift, slope = motion.derivatives(x, 1, np.where(x < source.covered, 1, -1))
    assert lift == pytest.approx(scale * (ramp(x) - 3.0), abs=4e-6)
    assert slope[[0, -1]] == pytest.approx(scale * (0.1 + 0.008 * x[[0, -1]]), abs=1e-5)
    assert motion.kept.lowered == pytest.approx(scale * 3.0, abs=2e-6)


def test_rows_of_a_length_may_stand_in_the_recipe():
    rows = [[x, round(ramp(x), 6)] for x in range(0, 41, 4)]
    source, errors = read(f"{{table: {rows}, reading: 0.000001}}")
    assert errors == []
    end = source.motion(source.covered, "motion", None, open_ends=True).at_end(1)
    assert end.tolist() == pytest.approx([ramp(40) - 3.0, 0.1 + 0.32], abs=1e-5)
    _, errors = read("{table: [[0, 1], [2]], reading: 0.1}")
    assert "give a list [length, displacement]" in errors[0]


def test_an_arms_table_over_a_length_is_in_degrees(tmp_path):
    text = "travel_mm,swing_deg\n" + "".join(f"{x},{0.01 * x * x:.5f}\n" for x in range(31))
    reader, node = reader_of(f"{{table: {tmp_path / 'arm.csv'}}}")
    (tmp_path / "arm.csv").write_text(text, "utf-8")
    reader.angular |= {Kind.STROKE}
    source = reader.field(motion_field("motion", Kind.STROKE, "a travel", over=TRAVEL), node, "motion")
    assert reader.errors == []
    end = source.motion(source.covered, "motion", None, open_ends=True).at_end(1)
    assert np.degrees(end).tolist() == pytest.approx([9.0, 0.6], abs=1e-4)


@pytest.mark.parametrize(
    ("heading", "keys", "problem"),
    [
        ("travel_mm,lift\n", ", length: inch", "the column 'travel_mm' is in mm, not in inch"),
        ("cam_deg,lift\n", "", "the column 'cam_deg' is in degrees; a length is meant here"),
        ("travel,lift\n", ", angle: cam", "unknown key"),
        ("travel,lift\n", ", rest: mirror", "unknown key"),
        ("travel,lift\n", ", over: 40", "cannot be combined with table; leave it out"),
        ("travel,lift\n", ", columns: [1, 1]", "column 1 cannot be both the length and the value"),
        ("travel,lift\n", ", length: cm", "motion.length: not one of the choices, given 'cm'; give mm, inch or thou"),
        ("travel,lift\n", ", columns: {column: 2, step: 60000}", "lift.csv: a travel above 2000000"),
    ],
)
def test_keys_that_do_not_suit_a_table_over_a_length_are_refused(tmp_path, heading, keys, problem):
    _, errors = written(tmp_path, heading + rows_of(), keys)
    assert problem in " ".join(errors)


def test_a_table_of_one_column_or_a_broken_row_names_its_line(tmp_path):
    _, errors = written(tmp_path, "1\n2\n3\n")
    assert "give columns: {column: 1, step: 2}" in errors[0]
    _, errors = written(tmp_path, "x,lift\n0,1\n1,a\n2,3\n3,4\n")
    assert "line 3" in errors[0]
    assert "a length and a displacement are expected" in errors[0]


def test_the_keys_of_a_table_stand_beside_a_table_alone():
    _, errors = read("{formula: x, over: 9, length: mm}")
    assert "motion.length: cannot stand without a table" in errors[0]
