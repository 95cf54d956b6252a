"""Tables for electronic cams: what a drive makes of them is within what they say, and a row that is off is refused.

Holds: kin.judge.drive, kin.read.drive_tables, kin.law.joined_rows, camgeo.formats.tables.drive_rows.
"""

import csv
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.cases import few
from support.heavy import interpolate

import camgeo
from camgeo.cli.main import main
from camgeo.files.controllers import CONTROLLERS
from camgeo.formats.tables.drive_rows import finest
from camgeo.schema.errors import RecipeErrors
from kin.law.joined_rows import ORDERS, JoinedRows

PLATE = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion: [{rise: 20, over: 100, law: modified-sine}, {dwell: 60}, {return: 20, over: 120, law: LAW}, {dwell: 80}]
"""
STEM = PLATE.replace("LAW", "cycloidal")
CAMS = {
    "stem": STEM,
    "jumps": PLATE.replace("LAW", "parabolic"),
    "inch": "units: inch\n" + STEM.replace("40", "1.6").replace("10}", "0.4}").replace(": 20", ": 0.8"),
    "arm": STEM.replace("radius: 10}", "radius: 10, arm: {length: 70, pivot: 80}}"),
    "flat": "cam: {kind: disc, base_radius: 30, follower: {kind: flat}, motion: {formula: 5*(1 - cos(t))}}\n",
    "breadth": "cam: {kind: constant-breadth, base_radius: 40, motion: {formula: 6*(1 - cos(t)) + sin(t)**4}}\n",
}


def written(folder: Path, cam: str, options: str, tolerance: str = "0.001") -> Path:
    path = folder / "cam.yaml"
    path.write_text(
        f"{CAMS[cam]}export: {{tolerance: {tolerance}, files: [{{csv: {{as: controller, {options}}}}}]}}\n",
        encoding="utf-8",
    )
    return path


def rows_of(path: Path) -> tuple[list[str], dict[str, Any]]:
    lines = path.read_text(encoding="utf-8").splitlines()
    head = [line for line in lines if line.startswith("#")]
    table = list(csv.reader(line for line in lines if not line.startswith("#")))
    return head, dict(zip(table[0], np.array(table[1:], dtype=float).T, strict=True))


MASTERS = ("master_deg", "MasterPos", "Master")
SLAVES = ("slave_mm", "slave_in", "slave_deg", "SlavePos", "Slave")


def joined(head: list[str], columns: dict[str, Any]) -> Any:
    """What a drive makes of the rows, by scipy: lines, a spline of given slopes, or Hermite polynomials of degree 5."""
    x, slave = (next(columns[key] for key in names if key in columns) for names in (MASTERS, SLAVES))
    if any("single precision" in line for line in head):
        x, slave = x.astype(np.float32).astype(float), slave.astype(np.float32).astype(float)
    if "joined by straight lines" in " ".join(head):
        return interpolate.make_interp_spline(x, slave, k=1)
    if ends := re.search(r"Start Slope (\S+), End Slope (\S+)$", "\n".join(head), re.MULTILINE):
        first, last = (float(np.float32(end)) for end in ends.groups())
        return interpolate.CubicSpline(x, slave, bc_type=((1, first), (1, last)))
    rates = [columns[next(key for key in pair if key in columns)] for pair in RATES]
    return interpolate.BPoly.from_derivatives(x, list(np.column_stack([slave, *rates])))


RATES = (("velocity", "SlaveVelo"), ("acceleration", "SlaveAcc"))


@pytest.mark.slow
@pytest.mark.parametrize("cam", CAMS)
@pytest.mark.parametrize("controller", [name for name in CONTROLLERS if name != "sew"])
def test_a_drive_is_within_what_its_table_says(cam: str, controller: str, tmp_path: Path) -> None:
    path = written(tmp_path, cam, f"for: {controller}", "0.0001" if cam == "inch" else "0.002")
    report = camgeo.export(path, tmp_path / "out")
    checks = {check.name: check for check in report.checks if check.file == "cam.csv"}
    lines = CONTROLLERS[controller].join == "line"
    rates = {"interpolation-velocity", "velocity-step" if lines else "interpolation-acceleration"}
    assert set(checks) == {"interpolation", "stated-error", *rates}
    assert report.ok
    head, columns = rows_of(tmp_path / "out" / "cam" / "cam.csv")
    stated = re.search(r"within (\S+) (mm|in|deg) of the motion, proved", " ".join(head))
    assert stated is not None
    degrees = np.linspace(0.0, 360.0, 100_001)[:-1]
    motion = camgeo.design(path).motion(np.radians(degrees))
    scale = {"mm": 1.0, "in": 25.4, "deg": math.radians(1.0)}[stated[2]]
    made, unit = joined(head, columns), camgeo.load(path).cam.arrangement.unit
    off = np.abs(made(degrees) - (motion - motion.min()) / scale).max()
    error = float(stated[1])
    assert off <= error * (1.0 + 1e-6)
    assert off >= 0.97 * error - 1e-9
    assert checks["interpolation"].value == pytest.approx(error, rel=1e-4, abs=1e-10)
    for order, name in enumerate(("velocity", "acceleration")[: 1 if lines else 2], 1):
        rate = camgeo.design(path).motion(np.radians(degrees), derivative=order) * math.radians(1.0) ** order / scale
        check, off = checks[f"interpolation-{name}"], np.abs(made(degrees, order) - rate).max()
        assert 0.95 * check.value - 1e-9 <= off <= check.value * (1.0 + 1e-6) + 1e-12
        share = float(re.match(r"(\S+) %", check.detail)[1])
        assert share == pytest.approx(100.0 * check.value / np.abs(rate).max(), rel=0.01)
        assert check.unit.startswith("deg/deg" if unit == "deg" else "in/deg" if cam == "inch" else "mm/deg")
    if lines:
        slope = np.diff(made(np.linspace(0.0, 360.0, 100_001)))
        assert checks["velocity-step"].value >= np.abs(np.diff(slope)).max() / 0.0036 * 0.5


@pytest.mark.slow
@pytest.mark.parametrize("cam", few(CAMS, 2))
def test_a_curve_point_table_has_its_number_of_rows_and_holds_its_tolerance(cam: str, tmp_path: Path) -> None:
    path = written(tmp_path, cam, "for: sew", "0.0002" if cam == "inch" else "0.005")
    report = camgeo.export(path, tmp_path / "out")
    assert report.ok
    check = next(check for check in report.checks if check.file == "cam.csv")
    table = tmp_path / "out" / "cam" / "cam.csv"
    count, *lines = table.read_text(encoding="ascii").splitlines()
    assert int(count) == len(lines) <= 1024
    assert re.fullmatch(r"[-0-9.;\n]+", "\n".join(lines))  # no exponents
    rows = np.array([line.split(";") for line in lines], dtype=float)
    degrees = np.linspace(0.0, 360.0, 100_001)[:-1]
    motion = camgeo.design(path).motion(np.radians(degrees))
    scale = {"arm": math.radians(1.0), "inch": 25.4}.get(cam, 1.0)
    off = np.abs(np.interp(degrees, *rows.T) - (motion - motion.min()) / scale).max()
    assert (check.name, check.unit) == ("interpolation", "deg" if cam == "arm" else "in" if cam == "inch" else "mm")
    assert 0.97 * off <= check.value <= check.limit
    assert off <= check.value * (1 + 1e-6)
    for suffix, text in ((".txt", table.read_text()), (".csv", table.read_text().replace(".", ",").replace(";", "\t"))):
        other = tmp_path / f"other{suffix}"
        other.write_text(text)
        tolerance = ["--tolerance", "0.0002" if cam == "inch" else "0.005"]
        assert main(["verify", str(path), str(other), *tolerance]) == 0
        place = len(lines) // 7
        cells = text.splitlines()[place].replace(",", ".").replace(";", "\t").split("\t")
        cells[1] = repr(float(cells[1]) + 2 * check.limit)
        other.write_text("\n".join([*text.splitlines()[:place], ";".join(cells), *text.splitlines()[place + 1 :]]))
        assert main(["verify", str(path), str(other), *tolerance]) == 1


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("360;0\n", "", "its first line says 400 rows, and there are 399"),
        ("360;0", "359;0", "the master does not rise from 0 to 360 degrees"),
        ("360;0", "360;x", "row 400 is not of 2 finite numbers"),
        ("360;0", "360;0;1", "row 400 is not of 2 finite numbers"),
    ],
)
def test_what_is_no_curve_point_table_says_why(
    old: str, new: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, table = written(tmp_path, "stem", "for: plain"), tmp_path / "table.csv"
    text = "400\n" + "".join(f"{360 * i / 399:.9g};0\n" for i in range(400))
    assert old in text
    table.write_text(text.replace(old, new))
    assert main(["verify", str(path), str(table)]) == 1
    assert told in capsys.readouterr().out


def test_a_curve_point_table_has_so_many_rows_and_no_more(tmp_path: Path) -> None:
    with pytest.raises(RecipeErrors, match=r"rows 0.36 degrees apart leave .*; give at least (\S+) mm") as caught:
        camgeo.export(written(tmp_path, "stem", "for: sew", "0.00001"), tmp_path / "out")
    enough = re.search(r"give at least (\S+) mm", str(caught.value))
    assert enough is not None
    assert camgeo.export(written(tmp_path, "stem", "for: sew", enough[1]), tmp_path / "out").ok
    assert (tmp_path / "out" / "cam" / "cam.csv").read_text().startswith("1001\n")


@pytest.mark.slow
@pytest.mark.parametrize(("controller", "tolerance"), [("codesys", "0.00001"), ("codesys-table", "0.01")])
def test_the_step_is_the_widest_that_holds_the_tolerance(controller: str, tolerance: str, tmp_path: Path) -> None:
    path = written(tmp_path, "stem", f"for: {controller}", tolerance)
    camgeo.export(path, tmp_path / "out")
    _, columns = rows_of(tmp_path / "out" / "cam" / "cam.csv")
    step = columns["master_deg"][1]
    wider = min(tick for tick in range(1, 100_001) if 3_600_000 % tick == 0 and tick > round(step * 1e4)) / 1e4
    told = r"rows so far apart leave .*; give (\S+) or less, or a tolerance of (\S+) mm"
    with pytest.raises(RecipeErrors, match=told) as caught:
        camgeo.export(written(tmp_path, "stem", f"for: {controller}, step: {wider:g}", tolerance), tmp_path / "out")
    found = re.search(told, str(caught.value))
    assert found is not None
    assert float(found[1]) == step
    assert camgeo.export(
        written(tmp_path, "stem", f"for: {controller}, step: {wider:g}", found[2]), tmp_path / "out"
    ).ok


@pytest.mark.slow
@pytest.mark.parametrize("controller", [name for name in CONTROLLERS if name not in {"sew", "codesys-table", "plain"}])
def test_a_row_changed_by_twice_the_tolerance_is_refused(
    controller: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, "stem", f"for: {controller}", "0.01")
    camgeo.export(path, tmp_path / "out")
    table = tmp_path / "out" / "cam" / "cam.csv"
    assert main(["verify", str(path), str(table)]) == 0
    lines = table.read_text(encoding="utf-8").splitlines()
    heads = next(i for i, line in enumerate(lines) if not line.startswith("#")) + 1
    place = heads + (len(lines) - heads) // 12  # in the rise
    column = 5 if controller == "twincat" else 1
    for by, status in ((0.04, 1), (-0.04, 1), (1e-11, 0)):
        cells = lines[place].split(",")
        cells[column] = repr(float(cells[column]) + by)
        changed = tmp_path / "changed.csv"
        changed.write_text("\n".join([*lines[:place], ",".join(cells), *lines[place + 1 :]]) + "\n", encoding="utf-8")
        assert main(["verify", str(path), str(changed)]) == status
    told = capsys.readouterr().out
    assert "interpolation (changed.csv): 0.0" in told
    # a row that is not there, and rows in another order
    changed.write_text("\n".join([*lines[:place], *lines[place + 2 :]]) + "\n", encoding="utf-8")
    assert main(["verify", str(path), str(changed)]) == 1
    changed.write_text("\n".join([*lines[:place], lines[place + 1], lines[place]]) + "\n", encoding="utf-8")
    assert main(["verify", str(path), str(changed)]) == 1


@pytest.mark.thin(8)
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("joined by", "put together by", "the head does not say how rows are joined: give a line `# joined by"),
        ("slave_mm", "slave_deg", "the slave is not in the motion's unit, mm"),
        ("slave_mm", "lift", "its columns are master_deg, lift, velocity, acceleration, and not master_deg, slave_mm"),
        ("\n360,", "\n359,", "the master does not rise from 0 to 360 degrees"),
        ("\n0,0,0,0", "\n0,0,zero,0", "row 1 is not of 4 finite numbers"),
        ("\n0,0,0,0", "\n0,0,inf,0", "row 1 is not of 4 finite numbers"),
        ("\n0,0,0,0", "\n0,0,1e300,0", "its numbers are too large, or its masters too near, to be joined"),
        ("\n0,0,0,0", "\n0,0,0,0\n1e-300,9,0,0", "its numbers are too large, or its masters too near, to be joined"),
    ],
)
def test_what_is_no_table_for_a_drive_says_why(
    old: str, new: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, "stem", "for: plain", "0.01")
    camgeo.export(path, tmp_path / "out")
    text = (tmp_path / "out" / "cam" / "cam.csv").read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "changed.csv").write_text(text.replace(old, new), encoding="utf-8")
    assert main(["verify", str(path), str(tmp_path / "changed.csv")]) == 1
    assert told in capsys.readouterr().out


@pytest.mark.parametrize(
    ("file", "message", "remedy"),
    [
        (
            "as: controller",
            "as: a table for a controller needs to know which, given 'controller'; give one of codesys",
            "as: controller, for: codesys",
        ),
        ("as: motion, for: plain", "for: belongs to a table as controller; leave it out", "as: motion"),
        ("as: motion, step: 1", "step: belongs to a table as inspection, grinding, lift", "as: motion"),
        (
            "as: controller, for: plain, step: 0.7",
            "step: 360 degrees are no whole number of it; give 0.700389105 or another divisor",
            "as: controller, for: plain, step: 0.5",
        ),
        (
            "as: controller, for: sew, step: 0.25",
            "step: more rows than its table takes; give 0.36 or more",
            "as: controller, for: sew, step: 0.36",
        ),
        (
            "as: controller, for: simens",
            "for: not one of the choices, given 'simens'; did you mean siemens?",
            "as: controller, for: siemens",
        ),
        (
            "as: controller, for: sew, acceleration_error: 5",
            "acceleration_error: straight lines have no acceleration but in steps of the velocity; leave it out",
            "as: controller, for: rockwell, acceleration_error: 5",
        ),
        ("as: motion, joints: true", "joints: belongs to a table as controller; leave it out", "as: motion"),
    ],
)
def test_faults_and_what_mends_them(file: str, message: str, remedy: str, tmp_path: Path) -> None:
    def load(options: str) -> Any:
        (tmp_path / "cam.yaml").write_text(f"{STEM}export: {{files: [{{csv: {{{options}}}}}]}}\n", encoding="utf-8")
        return camgeo.load(tmp_path / "cam.yaml")

    with pytest.raises(RecipeErrors) as caught:
        load(file)
    assert message in str(caught.value)
    load(remedy)


def test_joined_rows_are_hermite_polynomials_splines_and_lines() -> None:
    x = np.radians([0.0, 40.0, 100.0, 360.0])
    rows = np.array([[0.0, 1.0, 5.0, 0.0], [0.0, 2.0, 0.5, 0.0], [0.0, 1.0, -3.0, 0.0]])
    t = np.linspace(0.0, 2 * math.pi, 400)
    made = interpolate.BPoly.from_derivatives(x, list(rows.T))
    spline = interpolate.CubicSpline(x, rows[0], bc_type=((1, 2.0), (1, -1.0)))
    for order, found in enumerate(JoinedRows(x, rows, "quintic").rows(t, 2)):
        assert found == pytest.approx(made(t, order), abs=1e-10)
    for order, found in enumerate(JoinedRows(x, rows[:1], "cubic", (2.0, -1.0)).rows(t, 2)):
        assert found == pytest.approx(spline(t, order), abs=1e-11)
    lines = JoinedRows(x, rows[:1], "line")
    assert lines.rows(t, 0)[0] == pytest.approx(np.interp(t, x, rows[0]), abs=1e-12)
    (off,) = lines.off(lambda angle, _: (np.interp(angle, x, rows[0]) + (angle > 3))[None], [3.0])
    assert off.value == pytest.approx(1.0, abs=1e-9)
    assert off.at >= 3.0 - 1e-12
    slopes = np.diff(rows[0]) / np.diff(x)
    assert lines.step().value == pytest.approx(slopes[1] - slopes[2], rel=1e-12)
    assert lines.step().at == x[2]


SIX = """\
cam:
  kind: disc
  base_radius: 60
  follower: {kind: roller, radius: 10}
  motion: [{rise: 20, over: 60, law: modified-sine}, {dwell: 120}, {return: 20, over: 60, law: cycloidal}, {dwell: 120}]
"""


def one(folder: Path, options: str, tolerance: str = "0.01") -> tuple[camgeo.Report, list[str], dict[str, Any]]:
    path = folder / "cam.yaml"
    files = f"export: {{tolerance: {tolerance}, files: [{{csv: {{as: controller, {options}}}}}]}}\n"
    path.write_text(SIX + files, encoding="utf-8")
    report = camgeo.export(path, folder / "out")
    assert report.ok
    return report, *rows_of(folder / "out" / "cam" / "cam.csv")


def test_a_table_of_six_degrees_has_its_position_and_loses_its_acceleration(tmp_path: Path) -> None:
    """A modified sine of 20 mm in 60 degrees: its laws join at 7.5 and 52.5 degrees, between two rows.

    Its acceleration is 4 pi^2 h/((4 + pi) b^2) times sin(4 pi x) up to x = 1/8, then sin(4/3 pi x + pi/3).
    """
    report, head, columns = one(tmp_path, "for: codesys, step: 6", "0.1")
    x, rows = columns["master_deg"], np.column_stack([columns[k] for k in ("slave_mm", "velocity", "acceleration")])
    t = np.linspace(6.0, 12.0, 20_001)
    u, peak = t / 60.0, 2.0 * math.pi * 20.0 / 60.0**2  # that of the cycloidal return, the greater one
    law = (
        4.0
        * math.pi**2
        / (4.0 + math.pi)
        * 20.0
        / 60.0**2
        * np.where(u < 0.125, np.sin(4 * math.pi * u), np.sin(4 / 3 * math.pi * u + math.pi / 3))
    )
    off = np.abs(interpolate.BPoly.from_derivatives(x, list(rows))(t, 2) - law).max()
    check = next(check for check in report.checks if check.name == "interpolation-acceleration")
    assert check.value == pytest.approx(off, rel=1e-3)
    assert 100.0 * off / peak == pytest.approx(float(re.match(r"(\S+) %", check.detail)[1]), rel=0.01)
    assert f"its acceleration within {check.value:.3g}"[:28] in " ".join(head)


@pytest.mark.slow
@pytest.mark.parametrize("controller", ["twincat", "twincat-table", "rockwell"])
def test_rows_at_joints_are_fewer_and_at_every_joint(controller: str, tmp_path: Path) -> None:
    even, _, plain = one(tmp_path, f"for: {controller}", "0.002")
    report, head, columns = one(tmp_path, f"for: {controller}, joints: true", "0.002")
    x = next(columns[name] for name in MASTERS if name in columns)
    assert {7.5, 52.5, 60.0, 180.0, 240.0} <= set(x.tolist())
    assert len(x) < len(next(iter(plain.values())))
    if controller != "rockwell":  # a dwell is one part
        assert not ((x > 60.0) & (x < 180.0)).any()
    if controller == "twincat":  # one step fewer between the joints at 180 and 240 degrees is too few
        sites = np.linspace(180.0, 240.0, int(((x >= 180.0) & (x < 240.0)).sum()))
        rows = [law(sites, order) for order in range(3)]
        inside = np.linspace(180.0, 240.0, 5001)
        assert (
            np.abs(
                interpolate.BPoly.from_derivatives(sites, list(zip(*rows, strict=True)))(inside) - law(inside, 0)
            ).max()
            > 0.002
        )
    made = joined(head, columns)
    degrees = np.linspace(0.0, 360.0, 50_001)
    motion = camgeo.design(tmp_path / "cam.yaml").motion(np.radians(degrees))
    checks = {check.name: check.value for check in report.checks}
    assert np.abs(made(degrees) - motion).max() <= checks["interpolation"] + 1e-9 <= 0.002 + 1e-9
    assert even.ok


def law(x: Any, order: int) -> Any:
    """The cycloidal return of 20 mm from 180 to 240 degrees, and derivatives by degree."""
    u, turn = (x - 180.0) / 60.0, 2.0 * math.pi
    value = (1.0 - u + np.sin(turn * u) / turn, np.cos(turn * u) - 1.0, -turn * np.sin(turn * u))[order]
    return 20.0 * value / 60.0**order


@pytest.mark.slow
def test_a_limit_of_the_acceleration_takes_the_rows_that_it_needs(tmp_path: Path) -> None:
    def steps(options: str) -> tuple[int, float]:
        report, _, columns = one(tmp_path, options)
        share = next(check.detail for check in report.checks if check.name == "interpolation-acceleration")
        return len(columns["Master"]) - 1, float(share.split(" ")[0])

    loose, tight = steps("for: rockwell"), steps("for: rockwell, acceleration_error: 3")
    assert loose[1] > 3.0 >= tight[1]
    assert tight[0] > loose[0]
    wider = max(count for count in range(1, tight[0]) if 3_600_000 % count == 0)
    with pytest.raises(RecipeErrors, match=rf"give {360 / tight[0]:g} or less, or acceleration_error: (\S+)") as caught:
        one(tmp_path, f"for: rockwell, acceleration_error: 3, step: {360 / wider!r}")
    enough = re.search(r"acceleration_error: ([\d.]+)", str(caught.value).rpartition("or less")[2])
    assert enough is not None
    one(tmp_path, f"for: rockwell, acceleration_error: {enough[1]}, step: {360 / wider!r}")


def test_an_acceleration_that_jumps_is_held_by_no_rows(tmp_path: Path) -> None:
    path = written(tmp_path, "jumps", "for: plain, acceleration_error: 2", "0.01")
    with pytest.raises(RecipeErrors, match="acceleration_error: the acceleration jumps at 160 degrees") as caught:
        camgeo.export(path, tmp_path / "out")
    assert "leave it out, or give laws whose acceleration joins" in str(caught.value)
    text = path.read_text().replace("parabolic", "polynomial-345")
    path.write_text(text)
    assert camgeo.export(path, tmp_path / "out").ok


def test_limits_of_rows() -> None:
    assert [finest(CONTROLLERS[name].most) for name in ("sew", "rockwell", "plain")] == [0.36, 0.006, 0.001]


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("2,15,8,1", "2,1,8,1", "FunctionType is 1, 15; it is judged where all rows have 1 or 15"),
        (",15,", ",24,", "FunctionType is 24"),
        ("slave in mm", "slave in deg", "the slave is not in the motion's unit, mm"),
        (",SlaveJerk", ",Jerk", "its columns are"),
    ],
)
def test_a_motion_function_of_other_functions_is_refused(
    old: str, new: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one(tmp_path, "for: twincat")
    text = (tmp_path / "out" / "cam" / "cam.csv").read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "other.csv").write_text(text.replace(old, new), encoding="utf-8")
    assert main(["verify", str(tmp_path / "cam.yaml"), str(tmp_path / "other.csv")]) == (1 if "Jerk" not in new else 2)
    told_text = "".join(capsys.readouterr())
    assert told in told_text or "Jerk" in new


@pytest.mark.parametrize("join", ["line", "cubic", "quintic"])
def test_some_places_show_most_of_what_rows_miss_and_never_more(join: str) -> None:
    """A sine of three periods in rows of seven degrees: its position and the derivatives that the rows have."""

    def motion(angle: np.ndarray, order: int) -> np.ndarray:
        return np.stack([3.0**k * np.sin(3.0 * angle + 0.5 * k * math.pi) for k in range(order + 1)])

    x = np.radians(np.append(np.arange(0.0, 360.0, 7.0), 360.0))
    rows = JoinedRows(x, motion(x, 2), join, (3.0, 3.0))
    order = ORDERS[join]
    most = rows.off(motion, [], order)
    some = rows.off_at_some(motion, [], order)
    for greatest, seen in zip(most, some, strict=True):
        assert 0.9 * greatest.value < seen.value <= greatest.value * (1.0 + 1e-9)
