"""The grinder's table: worked cases, an own simulation of the wheel, planted faults, and what is refused.

Holds: camgeo.formats.tables.grinding, camgeo.formats.tables.ground, camgeo.formats.tables.lift.
"""

import json
import re

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from camgeo.cli.main import main
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.files.table import write_table
from camgeo.machining.grinding import greatest_bend
from camgeo.output import pipeline
from camgeo.recipe.loading import load, load_text
from camgeo.recipe.machining import FINEST
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.judge.grinding import MOST_ROWS, bend
from kin.read.formats import FORMATS

FLAT = """
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat}
  motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}
manufacture: {wheel: 400}
export: {tolerance: %s, files: [%s]}
"""
UNEVEN = "[{rise: 6, over: 70, law: polynomial-4567}, {return: 6, over: 95, law: polynomial-4567}, {dwell: 195}]"
FAULTS = ("wheel", "half", "contact", "turned", "open", "inch", "radians", "lift", "twice", "missing")
GRINDING = "{csv: {as: grinding%s}}"


def made(folder, text, name="lobe"):
    path = folder / f"{name}.yaml"
    path.write_text(text)
    assert main(["export", str(path), "--out", str(folder)]) == 0
    table = folder / name / f"{name}.csv"
    return path, table, json.loads((folder / name / "report.json").read_text())


def rows_of(table):
    lines = [line for line in table.read_text().splitlines() if line[0].isdigit()]
    return np.array([[float(cell) for cell in line.split(",")] for line in lines])


def test_table_of_the_worked_lobe(tmp_path) -> None:
    _, table, report = made(tmp_path, FLAT % (0.002, GRINDING % ", step: 1"))
    lines = table.read_text().splitlines()
    head, rows = [line for line in lines if line.startswith("#")], rows_of(table)
    assert lines[len(head)] == "c_deg,x_mm,normal_deg"
    assert "wheel 400 mm across" in head[0]
    assert rows[:, 0].tolist() == list(range(361))
    worked = {0: 226.0, 5: 225.910595224, 10: 225.642343054, 20: 224.570473925, 30: 222.823127475, 40: 220.674127720}
    worked |= {50: 218.851948569, 60: 218.054940951, 65: 218.000855652, 180: 218.0}
    assert rows[list(worked), 1] == pytest.approx(list(worked.values()), abs=6e-10)
    assert rows[[5, 20, 50], 2] == pytest.approx([5.519679076, 22.082078216, 52.058966404], abs=6e-10)
    (file,) = report["files"]
    said = float(re.search(r"within (\S+) mm", head[-1])[1])
    assert said == pytest.approx(file["geometry_error"], rel=1e-5)
    assert 1.491e-3 <= said < 1.52e-3
    check = next(check for check in report["checks"] if check["name"] == "contour")
    outside, inside = map(float, re.findall(r"(\S+) mm (?:out|in)side", check["detail"]))
    assert (outside, inside) == pytest.approx((1.4904e-3, 8.94e-4), abs=1.1e-6)  # by brute force over 560 001 places
    assert file["motion"]["max"] < 0.002


@pytest.mark.slow
def test_bound_of_the_second_derivative_is_proved_and_sharp() -> None:
    design = designed(load_text(FLAT % (0.001, "dxf"), "r"))
    shape = design.contours[0][1].shape
    path = Curve.whole(Parallel(shape, -200.0))
    assert 39.164804617 <= greatest_bend(path) < 39.164804617 * 1.01
    t = np.linspace(0.0, 2.0 * np.pi, 4001)
    point = path.sample(t).point
    angle, x = np.unwrap(np.arctan2(point[:, 1], point[:, 0])), np.hypot(*point.T)
    bent = np.gradient(np.gradient(x, angle), angle)[5:-5]
    assert np.abs(bent).max() == pytest.approx(39.1648, rel=1e-3)


@given(share=st.floats(0.0, 0.9), angle=st.floats(0.0, 6.3))
@settings(max_examples=examples(40), deadline=None)
def test_bound_of_the_third_derivative_of_an_arc(share: float, angle: float) -> None:
    """Against mpmath's derivative of the distance of a circle's points from the shaft, the radius 1."""

    def distance(c: mpmath.mpf) -> mpmath.mpf:
        return share * mpmath.cos(c) + mpmath.sqrt(1 - (share * mpmath.sin(c)) ** 2)

    with mpmath.workdps(40):
        third = abs(float(mpmath.diff(distance, mpmath.mpf(angle), 3)))
    assert third <= float(bend(np.array(share), np.array(share))) * (1.0 + 1e-12) + 1e-15


def test_bound_of_the_third_derivative_is_sharp_for_small_shares() -> None:
    angle = np.linspace(0.0, 6.3, 4001)
    for share, least in ((1e-3, 0.99), (0.1, 0.75), (0.5, 0.3)):
        distance = share * np.cos(angle) + np.sqrt(1.0 - (share * np.sin(angle)) ** 2)
        third = distance
        for _ in range(3):
            third = np.gradient(third, angle)
        assert np.abs(third[9:-9]).max() >= least * float(bend(np.array(share), np.array(share)))


@pytest.mark.parametrize("rotation", ["cw", pytest.param("ccw", marks=pytest.mark.slow)])
def test_wheel_simulated_by_hand(rotation, tmp_path) -> None:
    """The metal's own places stand one wheel's radius from the joined rows, within what the head of the table says."""
    text = f"rotation: {rotation}\n" + FLAT % (0.001, GRINDING % "")
    path, table, report = made(
        tmp_path, text.replace("400", "90").replace(re.search(r"\{lobe.*", text)[0], UNEVEN).replace("18", "30")
    )
    rows = rows_of(table)
    assert 3_600_000 % round(rows[1, 0] * 10_000) == 0  # a decimal divisor of 360
    fine = np.linspace(0.0, 360.0, 150_001)
    centre = np.interp(fine, rows[:, 0], rows[:, 1]) * np.exp(1j * np.radians(fine))
    motion = load(path).cam.exact().motion
    theta = np.radians(np.arange(0.18, 360.0, 2.16))
    lift, rate = motion.rows(theta, 1)
    metal = (30.0 + lift + 1j * rate) * np.exp(1j * theta)
    metal = metal.conj() if rotation == "ccw" else metal
    away = np.array([np.abs(centre - place).min() for place in metal]) - 45.0
    said = report["files"][0]["geometry_error"]
    assert 0.5 * said < np.abs(away).max() <= said + 1e-7
    assert said < 0.001


@pytest.mark.slow
def test_lift_of_a_roller_on_the_same_metal(tmp_path) -> None:
    text = FLAT.replace("manufacture: {wheel: 400}\n", "")
    _, table, _ = made(tmp_path, text % (0.002, "{csv: {as: lift, roller: 400, step: 1}}"))
    rows = rows_of(table)
    assert rows[[0, 20, 50, 65], 1] == pytest.approx([8.0, 6.570473925, 0.851948569, 0.000855652], abs=6e-10)
    assert "\nc_deg,lift_mm\n" in table.read_text()


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    "fault",
    ["mirrored", "spoilt", "spoilt outward", *(pytest.param(name, marks=pytest.mark.slow) for name in FAULTS)],
)
def test_planted_faults_are_caught(fault, tmp_path, capsys) -> None:
    text = FLAT % (0.0001, GRINDING % "")
    path, table, _ = made(
        tmp_path, text.replace(re.search(r"\{lobe.*", text)[0], UNEVEN).replace("18", "30").replace("400", "60")
    )
    lines, rows = table.read_text().splitlines(), rows_of(table)
    first = next(i for i, line in enumerate(lines) if line.startswith("c_deg"))
    match fault:
        case "wheel":  # the radius for the diameter, of the wheel that the table is made for
            made(tmp_path, path.read_text().replace("wheel: 60", "wheel: 30"), "other")
            rows = rows_of(tmp_path / "other" / "other.csv")
        case "half":  # crank degrees for those of the cam
            again = np.linspace(0.0, 360.0, len(rows))
            rows = np.column_stack([again, np.interp(np.minimum(2.0 * again, 360.0), rows[:, 0], rows[:, 1]), again])
        case "mirrored":
            rows = np.column_stack([360.0 - rows[::-1, 0], rows[::-1, 1], rows[::-1, 2]])
        case "contact":  # the angle of the contact's normal for that of the centre
            rows[:, 0] = np.unwrap(rows[:, 2], period=360.0)
            rows[-1, 0] = rows[0, 0] + 360.0
        case "turned":  # by a hundredth of a degree
            rows[:, 1] = np.interp(np.mod(rows[:, 0] + 0.01, 360.0), rows[:, 0], rows[:, 1])
            rows[-1, 1] = rows[0, 1]
        case "open":
            rows = rows[:-1]
        case "spoilt":  # one row, where the cam dwells, by twice the tolerance
            rows[len(rows) - 40, 1] -= 2e-4
        case "spoilt outward":
            rows[np.argmax(np.abs(np.diff(rows[:, 1]))), 1] += 2e-4
        case "radians":
            rows[:, 0] = np.radians(rows[:, 0])
        case "lift":
            rows[:, 1] -= rows[:, 1].min() - 1e-6
        case "twice":
            rows = np.insert(rows, 7, rows[7], axis=0)
        case "missing":  # twenty rows on a flank
            worst = int(np.argmax(np.abs(np.diff(rows[:, 1]))))
            rows = np.delete(rows, np.arange(worst, worst + 20), axis=0)
        case "inch":
            lines[first] = lines[first].replace("_mm", "_in")
    lines[first] = lines[first].removesuffix(",normal_deg")  # without normals, which would be caught by themselves
    body = [",".join(f"{value:.12g}" for value in row[:2]) for row in rows]
    table.write_text("\n".join([*lines[: first + 1], *body]) + "\n")
    assert main(["verify", str(path), str(table)]) == 1
    said = capsys.readouterr()
    assert "FAILED" in said.out + said.err


LIFT = "{csv: {as: lift, roller: 60}}"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("files", "change", "wanted"),
    [
        (GRINDING % "", ("wheel 60 mm", "wheel 64 mm"), r"head .*the wheel is stated as 64 mm, 60 mm is expected"),
        (GRINDING % "", ("wheel 60 mm", "wheel 60 inch"), r"head .*the wheel is stated as 1524 mm, 60 mm is expected"),
        (GRINDING % "", ("wheel 60 mm", "wheel s mm"), r"head .*the wheel is stated as nan mm, 60 mm is expected"),
        (GRINDING % "", ("# ", "#"), ""),
        (GRINDING % "", ("wheel", "stone"), r"head .*no line states the wheel, such as `# wheel 60 mm across`"),
        (GRINDING % "", (r"within \S+ mm", "within 0.0005 mm"), r"stated-error .*: 0\.000[89]\d+ mm, at most 0\.0005"),
        (LIFT, ("roller 60 mm", "roller 62 mm"), r"head .*the roller is stated as 62 mm, 60 mm is expected"),
        (LIFT, ("centre is 60 mm", "centre is 60.001 mm"), r"head .*lift 0 is stated as 60\.001 mm, 60 mm is expected"),
        (LIFT, ("#.*\n", ""), r"head .*: 2 faults.*`# roller 60 mm across`.*`# at lift 0 its centre is 60 mm from"),
    ],
)
def test_head_of_a_table_is_judged(files, change, wanted, tmp_path, capsys) -> None:
    text = "rotation: ccw\n" + FLAT % (0.001, files)
    text = text.replace(re.search(r"\{lobe.*", text)[0], UNEVEN).replace("18", "30").replace("400", "60")
    path, table, _ = made(tmp_path, text)
    assert main(["verify", str(path), str(table)]) == 0
    capsys.readouterr()
    table.write_text(re.sub(*change, table.read_text()))
    assert main(["verify", str(path), str(table)]) == (1 if wanted else 0)
    assert re.search(wanted, capsys.readouterr().out)


@pytest.mark.slow
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
@pytest.mark.parametrize("fault", [(slice(None), 5.0, 1), (70, 0.003, 1), (70, -0.0015, 0)])
def test_normals_of_a_table_are_judged(rotation, fault, tmp_path, capsys) -> None:
    """A wheel of radius 30 touches 0.00157 mm beside the place where its normal is 0.003 degrees off."""
    which, by, status = fault
    text = f"rotation: {rotation}\n" + FLAT % (0.001, GRINDING % "")
    text = text.replace(re.search(r"\{lobe.*", text)[0], UNEVEN).replace("18", "30").replace("400", "60")
    path, table, _ = made(tmp_path, text)
    head, rows = [line for line in table.read_text().splitlines() if not line[0].isdigit()], rows_of(table)
    rows[which, 2] += by
    table.write_text("\n".join([*head, *(",".join(f"{value:.12g}" for value in row) for row in rows)]) + "\n")
    capsys.readouterr()
    assert main(["verify", str(path), str(table)]) == status
    said = capsys.readouterr().out
    if status:
        off = float(re.search(r"normals .*: (\S+) mm, at most 0\.001", said)[1])
        assert off == pytest.approx(60.0 * np.sin(np.radians(by) / 2.0), rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ("c_deg,x_mm,normal_deg", "c_deg,x_mm,feed_mm", "columns c_deg, x_mm, feed_mm: .* c_deg, x_mm and normal_deg"),
        ("c_deg,x_mm,normal_deg", "c_deg,x_mm,lift_mm", "columns c_deg, x_mm, lift_mm"),
        ("c_deg,x_mm,normal_deg", "c_deg,x_mm,c_deg", "columns c_deg, x_mm, c_deg"),
        ("\n0,(.*),0\n", r"\n0,\1,1\n", "does not close"),
        ("\n0,(.*),0\n", r"\n0,\1\n", "a row is no row of 3 numbers"),
    ],
)
def test_columns_that_are_not_judged_are_refused(old, new, wanted, tmp_path, capsys) -> None:
    path, table, _ = made(tmp_path, FLAT % (0.002, GRINDING % ", step: 1"))
    capsys.readouterr()
    table.write_text(re.sub(old, new, table.read_text()))
    assert main(["verify", str(path), str(table)]) == 1
    assert re.search(wanted, capsys.readouterr().out)


@pytest.mark.slow
def test_the_finest_table_can_be_read_back(tmp_path) -> None:
    """The longest rows of the finest step a table may have, all digits of each number and an exponent."""
    rows = np.column_stack([np.arange(360.0 / FINEST + 1.0) * FINEST, *[np.full(360_001, 0.000123456789012)] * 2])
    write_table(tmp_path / "t.csv", ("c_deg", "x_in", "normal_deg"), rows, head=("wheel",) * 4)
    assert (tmp_path / "t.csv").stat().st_size < FORMATS["csv"].most
    assert len(rows) <= MOST_ROWS


@pytest.mark.slow
def test_table_of_any_origin_is_verified(tmp_path, capsys) -> None:
    path, table, _ = made(tmp_path, FLAT % (0.001, GRINDING % ""))
    assert main(["verify", str(path), str(table)]) == 0
    other = tmp_path / "other.csv"
    other.write_text("c_deg,y_mm\n0,1\n")
    assert main(["verify", str(path), str(other)]) == 1
    assert "its columns are c_deg, y_mm" in capsys.readouterr().out
    other.write_text("shaft_deg,lift_mm\n0,1\n")  # no grinder's: places of a cam that was measured
    assert main(["verify", str(path), str(other)]) == 2
    assert "points: 1, and at least 36 are needed, all round the cam" in capsys.readouterr().err


@pytest.mark.slow
def test_wheel_too_large_is_refused_with_the_largest() -> None:
    text = (FLAT % (0.001, GRINDING % "")).replace("kind: flat", "kind: roller, radius: 9")
    with pytest.raises(RecipeErrors, match=r"manufacture\.wheel: does not reach all of the contour's hollows") as told:
        pipeline.check(load_text(text, "r"))
    largest, fits = re.search(
        r"the largest that reaches is (\S+) mm across.*give (\S+) mm or less", str(told.value)
    ).groups()
    assert float(largest) == pytest.approx(2.0 * 51.609351862, rel=1e-5)
    assert pipeline.check(load_text(text.replace("wheel: 400", f"wheel: {fits}"), "r")).ok
    with pytest.raises(
        RecipeErrors, match=r"turns on the spot in a hollow.*largest that reaches is 103\.218 mm across"
    ):
        pipeline.check(load_text(text.replace("wheel: 400", f"wheel: {largest}"), "r"))


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("files", "change", "wanted"),
    [
        (
            GRINDING % ", step: 1",
            ("", ""),
            r"csv\.step: joined by straight lines rows so far apart leave 0\.00149\d+ mm",
        ),
        (GRINDING % ", step: 0.7", ("", ""), r"csv\.step: 360 degrees are no whole number of it.*give 0\.700389105"),
        (GRINDING % "", ("manufacture: {wheel: 400}", ""), r"csv\.as: a grinder's table needs the wheel"),
        ("{csv: {as: lift}}", ("", ""), r"csv\.as: the lift of a roller needs its diameter"),
        (GRINDING % ", roller: 9", ("", ""), r"csv\.roller: belongs to a table as lift"),
        ("{csv: {as: motion, step: 1}}", ("", ""), r"csv\.step: belongs to a table as inspection, grinding"),
        (GRINDING % "", ("{wheel: 400}", "{wheel: 400, feed: 3}"), r"manufacture\.cutter: missing"),
        (GRINDING % ", step: 1e-4", ("", ""), r"csv\.step: below 0\.001, given 1e-4; give an angle from 0\.001 to 10"),
        (GRINDING % ", step: 1e-9", ("", ""), r"csv\.step: below 0\.001"),
        (GRINDING % ", tolerance: 1e-9", ("", ""), r"csv\.tolerance: joined by straight lines a table of 360000 rows"),
    ],
)
def test_what_is_refused(files, change, wanted) -> None:
    with pytest.raises(RecipeErrors, match=wanted):
        pipeline.check(load_text((FLAT % (0.001, files)).replace(*change), "r"))


@pytest.mark.slow
def test_remedies_of_a_step_hold() -> None:
    text = FLAT % (0.001, GRINDING % ", step: 1")
    with pytest.raises(RecipeErrors) as told:
        pipeline.check(load_text(text, "r"))
    step, tolerance = re.search(r"give (\S+) or less, or a tolerance of (\S+) mm", str(told.value)).groups()
    assert step == "0.8"
    assert pipeline.check(load_text(text.replace("step: 1", f"step: {step}"), "r")).ok
    assert pipeline.check(load_text(text.replace("tolerance: 0.001", f"tolerance: {tolerance}"), "r")).ok


@pytest.mark.slow
def test_inches() -> None:
    text = "units: inch\n" + (FLAT % ("0.001 mm", GRINDING % "")).replace("18", "0.7").replace("lift: 8", "lift: 0.3")
    assert pipeline.check(load_text(text.replace("400", "8"), "r")).ok
