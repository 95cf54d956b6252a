"""Tables for electronic cams: what a drive makes of them is within what they say, and a row that is off is refused.

Holds: kin.judge.drive.
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
from camgeo.formats.tables.controller import CONTROLLERS
from camgeo.schema.errors import RecipeErrors
from kin.law.joined_rows import JoinedRows

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


def joined(columns: dict[str, Any], degrees: Any) -> Any:
    """What a drive makes of the rows, by scipy: straight lines or Hermite polynomials of degree 5."""
    x, slave = columns["master_deg"], next(columns[key] for key in columns if key.startswith("slave"))
    if "velocity" not in columns:
        return np.interp(degrees, x, slave)
    rows = np.column_stack([slave, columns["velocity"], columns["acceleration"]])
    return interpolate.BPoly.from_derivatives(x, list(rows))(degrees)


@pytest.mark.thin(6)
@pytest.mark.parametrize("cam", CAMS)
@pytest.mark.parametrize("controller", [name for name in CONTROLLERS if name != "sew"])
def test_a_drive_is_within_what_its_table_says(cam: str, controller: str, tmp_path: Path) -> None:
    path = written(tmp_path, cam, f"for: {controller}", "0.0001" if cam == "inch" else "0.002")
    report = camgeo.export(path, tmp_path / "out")
    checks = {check.name: check for check in report.checks if check.file == "cam.csv"}
    assert set(checks) == {"interpolation", "stated-error"}
    assert report.ok
    head, columns = rows_of(tmp_path / "out" / "cam" / "cam.csv")
    stated = re.search(r"within (\S+) (mm|in|deg) of the motion, proved", " ".join(head))
    assert stated is not None
    degrees = np.linspace(0.0, 360.0, 100_001)[:-1]
    motion = camgeo.design(path).motion(np.radians(degrees))
    scale = {"mm": 1.0, "in": 25.4, "deg": math.radians(1.0)}[stated[2]]
    off = np.abs(joined(columns, degrees) - (motion - motion.min()) / scale).max()
    error = float(stated[1])
    assert off <= error * (1.0 + 1e-6)
    assert off >= 0.97 * error - 1e-9
    assert checks["interpolation"].value == pytest.approx(error, rel=1e-4, abs=1e-10)


@pytest.mark.thin(3)
@pytest.mark.parametrize("cam", few(CAMS, 2))
def test_a_curve_point_table_has_its_number_of_rows_and_holds_its_tolerance(cam: str, tmp_path: Path) -> None:
    path = written(tmp_path, cam, "for: sew", "0.0002" if cam == "inch" else "0.005")
    report = camgeo.export(path, tmp_path / "out")
    assert report.ok
    (check,) = (check for check in report.checks if check.file == "cam.csv")
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


@pytest.mark.thin(2)
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


@pytest.mark.thin(3)
@pytest.mark.parametrize("controller", [name for name in CONTROLLERS if name != "sew"])
def test_a_row_changed_by_twice_the_tolerance_is_refused(
    controller: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, "stem", f"for: {controller}", "0.01")
    camgeo.export(path, tmp_path / "out")
    table = tmp_path / "out" / "cam" / "cam.csv"
    assert main(["verify", str(path), str(table)]) == 0
    lines = table.read_text(encoding="utf-8").splitlines()
    place = len(lines) // 7  # in the rise
    for by, status in ((0.02, 1), (-0.02, 1), (1e-11, 0)):
        cells = lines[place].split(",")
        cells[1] = repr(float(cells[1]) + by)
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


@pytest.mark.thin(6)
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("joined by", "put together by", "the head does not say how rows are joined: give a line `# joined by"),
        ("slave_mm", "slave_deg", "the slave is not in the follower's unit, mm"),
        ("slave_mm", "lift", "its columns are master_deg, lift, velocity, acceleration, and not master_deg, slave_mm"),
        ("\n360,", "\n359,", "the master does not rise from 0 to 360 degrees"),
        ("\n0,0,0,0", "\n0,0,zero,0", "row 1 is not of 4 finite numbers"),
        ("\n0,0,0,0", "\n0,0,inf,0", "row 1 is not of 4 finite numbers"),
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
            "as: controller, for: siemens",
            "for: not one of the choices, given 'siemens'; give codesys, codesys-table, sew or plain",
            "as: controller, for: plain",
        ),
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


def test_joined_rows_are_hermite_polynomials_and_lines() -> None:
    x = np.radians([0.0, 40.0, 100.0, 360.0])
    rows = np.array([[0.0, 1.0, 5.0, 0.0], [0.0, 2.0, 0.5, 0.0], [0.0, 1.0, -3.0, 0.0]])
    t = np.linspace(0.0, 2 * math.pi, 400)
    made = interpolate.BPoly.from_derivatives(x, list(rows.T))
    assert JoinedRows(x, rows, "quintic").position(t) == pytest.approx(made(t), abs=1e-11)
    assert JoinedRows(x, rows[:1], "line").position(t) == pytest.approx(np.interp(t, x, rows[0]), abs=1e-12)
    worst, at = JoinedRows(x, rows[:1], "line").off(lambda angle: np.interp(angle, x, rows[0]) + (angle > 3), [3.0])
    assert worst == pytest.approx(1.0, abs=1e-9)
    assert at >= 3.0 - 1e-12
