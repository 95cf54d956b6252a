"""A motion by a table: its file, columns, units and rows, what is refused with its line, and rows that stand out."""

import math
import os
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.motion_recipes import BREADTH, HALF, fault, lift, rad, recipe, sampled, written

from camgeo.cli.main import main
from camgeo.motions.motion import TableMotion
from camgeo.output import pipeline
from camgeo.recipe.loading import load
from camgeo.schema.errors import RecipeErrors
from kin.law.normalised import IntentError
from kin.law.sources.laws import named
from kin.law.sources.programme import Dwell, Move, programme


@pytest.mark.parametrize(
    ("form", "head"),
    [
        ("{:g},{:.3f}", ""),
        ("{:g}; {:.3f}", "angle; lift"),
        ("{:g}\t{:.3f}", "# read off\nangle\tlift"),
    ],
)
@pytest.mark.parametrize("comma", [False, True])
def test_a_table_says_the_same_in_every_way_of_writing(form, head, comma, tmp_path):
    if comma and "," in form:
        form = "{:g} {:.3f}"
    rows = written(tmp_path, HALF, sampled(HALF), form, head=head)
    if comma:
        text = "\n".join([head, *(row.replace(".", ",") for row in rows)])
        (tmp_path / "lift.csv").write_text(text, encoding="utf-8")
    asked = recipe("{table: lift.csv}", tmp_path).cam.motion
    assert isinstance(asked, TableMotion)
    assert asked.rows.s == tuple(np.round(sampled(HALF), 3).tolist())
    assert asked.reading is None
    assert np.array(asked.rows.rounding) == pytest.approx(0.0005)


def test_crank_degrees_and_inches_of_a_table(tmp_path):
    written(tmp_path, HALF, sampled(HALF))
    plain = recipe("{table: lift.csv, reading: 0.001}", tmp_path)
    written(tmp_path, 2 * HALF, np.round(sampled(HALF), 3) / 25.4, "{:g};{:.12f}")
    other = recipe("{table: lift.csv, angle: crank, units: inch, reading: 0.001}", tmp_path)
    theta = np.arange(0.0, 360.0, 3.0)
    assert lift(other, theta)[0] == pytest.approx(lift(plain, theta)[0], abs=1e-6)


def test_a_file_of_several_columns_in_crank_degrees_and_thousandths(tmp_path):
    """As it comes: one message that says what to add, and then the motion."""
    deg = np.arange(0.0, 720.0, 10.0)
    lifts = [200 - 200 * np.cos(np.radians(0.5 * deg)), 150 - 150 * np.cos(np.radians(0.5 * deg))]
    rows = "\n".join(f"{a:g};{b:.1f};{c:.1f}" for a, b, c in zip(deg, *lifts, strict=True))
    (tmp_path / "lift.csv").write_text(f"crank;intake_thou;exhaust_thou\n{rows}\n", encoding="utf-8")
    head = "kind: disc, base_radius: 40, follower: {kind: roller, radius: 8}"
    message = str(fault("{table: lift.csv}", tmp_path, head=head))
    assert "the table's columns are crank, intake_thou, exhaust_thou" in message
    told = re.search(r"such as (columns: \[.*\])", message)[1]
    for columns, lift_ in ((told, lifts[0]), ("columns: [crank, exhaust]", lifts[1]), ("columns: [1, 3]", lifts[1])):
        made = recipe(f"{{table: lift.csv, {columns}}}", tmp_path, head=head).cam.exact()
        s = made.motion.rows(np.radians(0.5 * deg), 0)[0]
        assert s - s.min() == pytest.approx(0.0254 * lift_, abs=0.0254 * 0.06)
        assert made.kept.distance <= 0.05 * 0.0254
    scaled = recipe("{table: lift.csv, columns: [1, 2], scale: 1.5, offset: 3}", tmp_path, head=head).cam.motion
    assert scaled.rows.s == pytest.approx(0.0254 * (1.5 * np.round(lifts[0], 1) + 3))
    assert np.array(scaled.rows.rounding) == pytest.approx(1.5 * 0.05 * 0.0254)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("{table: lift.csv, columns: [1, 2, 3]}", "cam.motion.columns"),
        ("{table: lift.csv, columns: 2}", "cam.motion.columns: not a list"),
        ("{table: lift.csv, columns: [1]}", "cam.motion.columns: not two columns"),
        ("{table: lift.csv, columns: [1, 5]}", "the table has columns 1 to 2, not 5"),
        ("{table: [[0, 0], [90, 3], [180, 5]]}", "rows in a recipe show no last digit; give reading beside them"),
        ("{table: [[0, 0], [90]], reading: 0.1}", "cam.motion.table[1]: not a row"),
        ("{formula: cos(t), columns: [1, 2]}", "cam.motion.columns: cannot stand without a table"),
    ],
)
def test_columns_and_rows_that_are_none_are_refused(given, message, tmp_path):
    written(tmp_path, HALF, sampled(HALF))
    assert message in str(fault(given, tmp_path))


def test_rows_may_stand_in_the_recipe(tmp_path):
    rows = ", ".join(f"[{angle:g}, {value:.3f}]" for angle, value in zip(HALF, sampled(HALF), strict=True))
    written(tmp_path, HALF, sampled(HALF))
    theta = np.arange(0.0, 360.0, 7.0)
    expected = lift(recipe("{table: lift.csv}", tmp_path), theta)[0]
    for reading in ("auto", "0.0005"):
        made = recipe(f"{{table: [{rows}], reading: {reading}}}", tmp_path)
        assert lift(made, theta)[0] == pytest.approx(expected, abs=1e-9)


def test_a_dwell_of_a_table_is_one_exactly(tmp_path):
    written(tmp_path, HALF, sampled(HALF))
    rows = lift(recipe("{table: lift.csv}", tmp_path), np.array([125.0, 150.0, 179.0]), 2)
    assert rows[1].tolist() == rows[2].tolist() == [0, 0, 0]
    assert rows[0] == pytest.approx([20, 20, 20], abs=1e-3)


@settings(max_examples=examples(40), deadline=None)
@given(
    law=st.sampled_from(["cycloidal", "modified-sine", "polynomial-345", "modified-trapezoid"]),
    stroke=st.floats(0.5, 30),
    over=st.integers(80, 150),
    places=st.integers(2, 4),
)
def test_a_table_of_a_law_comes_back_within_its_reading(law, stroke, over, places, tmp_path_factory):
    folder = tmp_path_factory.mktemp("table")
    true = programme([Move(rad(over), named(law), by=stroke), Dwell(rad(180 - over))], math.pi, around=-1)
    angles = np.arange(0.0, 181.0)
    values = true.derivatives(np.radians(angles), 0)[0]
    written(folder, angles, values, f"{{:g}};{{:.{places}f}}")
    reading = 10.0**-places
    made = recipe(f"{{table: lift.csv, reading: {reading}}}", folder)
    assert np.abs(lift(made, angles)[0] - np.round(values, places)).max() <= reading * (1 + 1e-6)
    between = angles[:-1] + 0.5
    off = np.abs(lift(made, between)[0] - true.derivatives(np.radians(between), 0)[0])
    assert off.max() <= 3 * reading


@pytest.mark.slow
def test_a_hundred_thousand_rows(tmp_path):
    angles = np.linspace(0, 180, 100_000)
    written(tmp_path, angles, 10 * (1 - np.cos(np.radians(angles))), "{:.6f},{:.4f}")
    made = recipe("{table: lift.csv, reading: 0.0002}", tmp_path)
    assert len(made.cam.motion.rows.s) == 100_000
    theta = np.arange(0.0, 180.0, 3.7)
    assert lift(made, theta)[0] == pytest.approx(10 * (1 - np.cos(np.radians(theta))), abs=3e-4)


def with_word(rows):
    return [*rows[:9], "17,none", *rows[10:]], r"lift\.csv, line 10: 'none' is not a number, in '17,none'"


def with_angle_twice(rows):
    return [*rows[:9], "16,7", *rows[9:]], r"lift\.csv, line 10: the angles must rise; 16 stands twice, with another"


def with_slip(rows):
    return [*rows[:30], f"60,{float(rows[30].split(',')[1]) + 0.2:.3f}", *rows[31:]], (
        r"lift\.csv, line 31: the row stands out: it is 10\.2 mm, about 10 mm fits the others; .* suspect: keep or drop"
    )


def begun_above(rows):
    return [f"{2 * i},{float(row.split(',')[1]) + 3:.3f}" for i, row in enumerate(rows)], (
        r"lift\.csv, line 1: the motion begins at 3; S\(0\) must be 0: make every displacement 3 less"
    )


@pytest.mark.parametrize("harm", [with_word, with_angle_twice, with_slip, begun_above])
def test_a_table_that_is_none_is_refused_with_its_line(harm, tmp_path):
    rows, message = harm(written(tmp_path, HALF, sampled(HALF)))
    (tmp_path / "lift.csv").write_text("\n".join(rows), encoding="utf-8")
    error = fault("{table: lift.csv, reading: 0.001, suspect: refuse}", tmp_path)
    assert (error.line, error.path) == (2, "cam.motion.table")
    assert re.search(message, str(error)), str(error)


@pytest.mark.slow
def test_a_row_that_stands_out_is_told_wherever_the_cam_is_and_may_be_left_out(tmp_path, capsys):
    rows, _ = with_slip(written(tmp_path, HALF, sampled(HALF)))
    (tmp_path / "lift.csv").write_text("\n".join(rows), encoding="utf-8")
    value = float(rows[30].split(",")[1])
    (tmp_path / "case.yaml").write_text("cam: {kind: constant-breadth, base_radius: 900, motion: {table: lift.csv}}\n")
    made = recipe("{table: lift.csv}", tmp_path)
    assert lift(made, np.array([60.0]))[0] == pytest.approx([value], abs=0.0005)
    (remark,) = (one for one in pipeline.check(made).report["remarks"] if one["name"] == "table-row")
    told = f"line 31: the row stands out: it is {value} mm, about {value - 0.2:g} mm fits the others"
    assert remark["sentence"].startswith(told)
    assert main(["check", str(tmp_path / "case.yaml")]) == 0
    assert told in capsys.readouterr().out.splitlines()[-1]
    dropped = recipe("{table: lift.csv, suspect: drop}", tmp_path)
    assert lift(dropped, np.array([60.0]))[0] == pytest.approx([value - 0.2], abs=0.001)


@pytest.mark.slow
def test_the_report_tells_the_greatest_distance_from_the_rows(tmp_path):
    written(tmp_path, HALF, sampled(HALF), "{:g},{:.1f}")
    report = pipeline.check(recipe("{table: lift.csv}", tmp_path)).report
    assert report["table"]["unit"] == "mm"
    assert 0.03 < report["table"]["distance"] <= 0.05
    assert 1 <= report["table"]["line"] <= len(HALF)
    assert "table" not in pipeline.check(recipe("{formula: 5 - 5*cos(t)}", tmp_path)).report


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("head", "units", "key"),
    [
        ("kind: disc, base_radius: 40, follower: {kind: roller, radius: 8}", "inch", ""),
        ("kind: disc, base_radius: 2, follower: {kind: roller, radius: 1}", "mm", ", units: inch"),
        ("kind: disc, base_radius: 34, follower: {kind: roller, radius: 8, arm: {length: 65, pivot: 80}}", "mm", ""),
    ],
)
def test_faults_of_rows_are_told_as_the_table_has_them(head, units, key, tmp_path):
    angles = np.arange(0.0, 361.0, 2.0)
    values = 5.0 * (1.0 - np.cos(np.radians(angles)))
    reading = f"{{table: lift.csv, suspect: refuse, reading: {0.001 if not key else 0.0254}{key}}}"

    def told(change):
        written(tmp_path, angles, change(values.copy()))
        return str(fault(reading, tmp_path, head=head, units=units))

    def slipped(s):
        s[45] += 0.2
        return s

    def unclosed(s):
        s[-1] += 0.5
        return s

    unit = "deg" if "arm" in head else "in"
    assert f"line 46: the row stands out: it is 5.2 {unit}, about 5 {unit} fits the others" in told(slipped)
    assert f"line 181: the motion does not close: 0.5 {unit} off the first row, 360 degrees earlier" in told(unclosed)
    angles, values = angles[:100], values[:100]
    assert f"{values[-1]:.3f} {unit} off its first row: the rest of the turn can be no dwell" in told(np.copy)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("units", "stem", "unit", "key"),
    [
        ("mm", "", "deg", ""),
        ("inch", "", "deg", ""),
        ("mm", "stem", "mm", ""),
        ("inch", "stem", "in", ""),
        ("mm", "stem", "in", ", units: thou"),
    ],
)
def test_an_advised_reading_does_in_the_unit_in_which_it_is_told(units, stem, unit, key, tmp_path):
    """Of rows that scatter, of a motion that does not close, and of a reading that leaves none."""
    size = 100 if key else 1
    rows = [
        f"{k},{size * (5 - 5 * math.cos(math.radians(k)) + 0.02 * math.sin(7 * k * k)):.3f}" for k in range(0, 361, 2)
    ]
    rows[-1] = f"360,{0.3 * size:.3f}"
    guide = "" if stem else ", arm: {length: 65, pivot: 80}"
    base = f"units: {units}\ncam: {{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 8{guide}}}, motion: "

    def told(reading, pattern):
        given = f", reading: {reading}" if reading else ""
        (tmp_path / "c.yaml").write_text(f"{base}{{table: lift.csv{key}{given}}}}}\n", encoding="utf-8")
        exact = load(tmp_path / "c.yaml").cam.exact
        if pattern is None:
            return exact()
        with pytest.raises(IntentError, match=pattern) as caught:
            exact()
        return re.search(pattern, caught.value.message)[1]

    (tmp_path / "lift.csv").write_text("\n".join(rows), encoding="utf-8")
    closes = told("", rf"or reading: (\S+ {unit})$")
    told(closes, None)
    moves = told(f"30 {unit}", rf"give reading: (\S+ {unit}) or less")
    told(moves, None)
    (tmp_path / "lift.csv").write_text("\n".join(rows[:-1]), encoding="utf-8")
    (noise,) = (remark.sentence for remark in told("", None).kept.remarks if remark.name == "table-noise")
    calm = told(re.search(rf"with reading: (\S+ {unit}) the", noise)[1], None)
    assert "table-noise" not in {remark.name for remark in calm.kept.remarks}


def test_a_table_that_is_no_file_is_one_error_at_the_recipe_s_line(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "bytes.csv").write_bytes(b"0,0\n\x00\x01")
    (tmp_path / "empty.csv").write_text("\n# nothing\n")
    found = {name: str(fault(f"{{table: {name}}}", tmp_path)) for name in ("none.csv", ".", "pipe", "bytes.csv")}
    where = f"{tmp_path}/case.yaml:2:64: cam.motion.table: "
    looked = "give its path as seen from the recipe's folder"
    assert found == {
        "none.csv": f"{where}the file does not exist, given 'none.csv'; {looked}",
        ".": f"{where}a folder, given '.'; {looked}",
        "pipe": f"{where}a pipe, a socket or a device, not a file, given 'pipe'; save the table as a file",
        "bytes.csv": f"{where}not a text, given 'bytes.csv'; save the table as CSV",
    }
    assert "empty.csv, no row of numbers is among its lines" in str(fault("{table: empty.csv}", tmp_path))
    (tmp_path / "none.csv").write_text("\n".join(written(tmp_path, HALF, sampled(HALF))))
    recipe("{table: none.csv}", tmp_path).cam.exact()


# needs: sweep
@pytest.mark.slow
def test_a_sweep_reads_the_table_and_its_best_design_finds_it_from_its_own_folder(tmp_path, monkeypatch, capsys):
    written(tmp_path, HALF, sampled(HALF))
    vary = "{cam.base_radius: {from: 38, to: 44, steps: 3}, cam.motion.reading: [0.001, 0.002]}"
    (tmp_path / "case.yaml").write_text(
        f"cam: {{{BREADTH}, motion: {{table: lift.csv, reading: 0.001}}}}\nexport: {{files: [csv]}}\n"
        f"sweep: {{vary: {vary}, rank: radius-of-curvature, keep: 1}}\n"
    )
    assert main(["sweep", str(tmp_path / "case.yaml"), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    (best,) = (tmp_path / "out").rglob("best-1.yaml")
    monkeypatch.chdir("/")
    assert main(["check", str(best)]) == 0
    assert "base_radius: 44" in best.read_text()
    capsys.readouterr()


@pytest.mark.parametrize("cell", ["inf", "nan", "1e999"])
def test_a_displacement_without_end_is_refused_with_its_line(cell, tmp_path):
    rows = written(tmp_path, HALF, sampled(HALF))
    rows[30] = f"{rows[30].split(',')[0]},{cell}"
    (tmp_path / "lift.csv").write_text("\n".join(rows), encoding="utf-8")
    error = fault("{table: lift.csv}", tmp_path)
    assert (error.line, error.path) == (2, "cam.motion.table")
    assert "lift.csv, line 31: the displacement is not finite" in str(error)


def test_a_table_of_more_rows_than_any_motion_needs(tmp_path, monkeypatch):
    monkeypatch.setattr("camgeo.motions.lift_table.MAX_ROWS", 400)
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(
        "cam: {kind: constant-breadth, base_radius: 40, motion: {table: lift.csv, angle: cam, units: mm}}\n"
    )
    for end in ("\n", "\r\n", "\r"):
        rows = [f"{k / 5};{5 - 5 * math.cos(math.radians(k / 5)):.6f}" for k in range(901)]
        (tmp_path / "lift.csv").write_bytes(end.join(rows).encode())
        with pytest.raises(RecipeErrors, match=r"motion\.table: more than 400 rows, given 'lift\.csv'; leave rows out"):
            load(recipe)
        (tmp_path / "lift.csv").write_bytes(end.join(rows[::3]).encode())
        load(recipe)
        # rows alone are counted: neither a heading, nor a comment, nor an empty line
        text = ["deg;mm", "# as measured", "", *rows[:400], ""]
        (tmp_path / "lift.csv").write_bytes(end.join(text).encode())
        load(recipe)
        (tmp_path / "lift.csv").write_bytes(end.join([*text, rows[400]]).encode())
        with pytest.raises(RecipeErrors, match=r"motion\.table: more than 400 rows, given 'lift\.csv'; leave rows out"):
            load(recipe)
    monkeypatch.setattr("camgeo.motions.lift_table.MAX_LINES", 800)
    (tmp_path / "lift.csv").write_text("\n\n\n".join(rows[:400]), encoding="utf-8")
    with pytest.raises(RecipeErrors, match=r"motion\.table: more than 800 lines, given 'lift\.csv'; leave rows out"):
        load(recipe)
