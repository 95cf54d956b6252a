"""Motions of an axis: figures in time against closed forms, tables against scipy, an index that goes on, the page.

Holds: camgeo.capabilities.axis.design, camgeo.capabilities.axis.library, camgeo.capabilities.axis.pipeline,
camgeo.capabilities.axis.tables, camgeo.capabilities.axis.axis_page, camgeo.capabilities.axis.root,
camgeo.capabilities.axis.starter, camgeo.capabilities.axis.keys, camgeo.capabilities.axis.reading.
"""

from __future__ import annotations

import csv
import math
import re
from typing import TYPE_CHECKING, Any

import mpmath
import numpy as np
import pytest
from support.heavy import interpolate
from support.places import ROOT

import camgeo
from camgeo.api.root import root_of
from camgeo.cli.main import main
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

INDEX = """\
axis:
  kind: rotary
  rpm: 60
  index: true
  modulo: 360
  motion: [{rise: 45, over: 150, law: modified-sine}, {dwell: 210}]
export: {tolerance: 0.005, files: [FILES]}
"""
PUSH = """\
axis:
  rpm: 90
  motion: [{rise: 30, over: 90, law: cycloidal}, {dwell: 90}, {return: 30, over: 90, law: polynomial-345}, {dwell: 90}]
export: {tolerance: 0.01, files: [FILES]}
"""
PLAIN = "{csv: {as: controller, for: plain}}"


def written(folder: Path, text: str, files: str = PLAIN) -> Path:
    path = folder / "axis.yaml"
    path.write_text(text.replace("FILES", files), encoding="utf-8")
    return path


def refused(folder: Path, text: str, files: str = PLAIN) -> str:
    with pytest.raises(RecipeErrors) as caught:
        camgeo.check(written(folder, text, files))
    return str(caught.value)


def columns_of(path: Path) -> tuple[list[str], dict[str, Any]]:
    lines = path.read_text(encoding="utf-8").splitlines()
    table = list(csv.reader(line for line in lines if not line.startswith("#")))
    head = [line for line in lines if line.startswith("#")]
    return head, dict(zip(table[0], np.array(table[1:], dtype=float).T, strict=True))


def test_figures_in_time_are_those_of_the_law(tmp_path: Path) -> None:
    """Modified sine, h = 45 degrees in T = 150/360 s: v = 4 pi/(4 + pi) h/T, a = 4 pi^2/(4 + pi) h/T^2, j = 4 pi a/T.

    The mean square of its acceleration over the cycle, with 40 digits: sin^2 over its three parts.
    """
    axis = camgeo.design(written(tmp_path, INDEX))
    with mpmath.workdps(40):
        pi, h, rise = mpmath.pi, mpmath.mpf(45), mpmath.mpf(150) / 360
        peak = 4 * pi**2 / (4 + pi) * h / rise**2
        wanted = {"velocity": 4 * pi / (4 + pi) * h / rise, "acceleration": peak, "jerk": 4 * pi * peak / rise}
        parts = (0, mpmath.mpf(1) / 8, mpmath.mpf(7) / 8, 1)
        phases = (lambda x: 4 * pi * x, lambda x: 4 * pi * x / 3 + pi / 3, lambda x: 4 * pi * x - 2 * pi)
        square = mpmath.fsum(
            mpmath.quad(lambda x, of=of: mpmath.sin(of(x)) ** 2, [parts[i], parts[i + 1]])
            for i, of in enumerate(phases)
        )
        wanted["rms-acceleration"] = peak * mpmath.sqrt(square * rise)
    for name, value in wanted.items():
        assert axis.figures[name].value == pytest.approx(float(value), rel=1e-12), name
    assert (axis.figures["cycle"].value, axis.figures["advance"].value) == (1.0, pytest.approx(45.0, rel=1e-14))
    assert axis.figures["cycles"].value == 8
    assert axis.figures["jerk"].unit == "deg/s^3"
    assert axis.motion(2.0 * math.pi) == pytest.approx(math.radians(45.0))
    assert axis.ok


@pytest.mark.parametrize(("text", "controller"), [(INDEX, "twincat"), (INDEX, "rockwell"), (PUSH, "codesys-table")])
def test_a_table_is_what_its_controller_makes_of_it_in_time(text: str, controller: str, tmp_path: Path) -> None:
    path = written(tmp_path, text, f"{{csv: {{as: controller, for: {controller}}}}}")
    report = camgeo.export(path, tmp_path / "out")
    assert report.ok
    _, columns = columns_of(tmp_path / "out" / "axis" / "axis.csv")
    checks, axis = {check.name: check for check in report.checks}, camgeo.design(path)
    degrees = np.linspace(0.0, 360.0, 30_001)
    own, speed = (math.radians(1.0), 360.0) if text == INDEX else (1.0, 540.0)
    rows = [axis.motion(np.radians(degrees), derivative=k) / own * math.radians(speed) ** k for k in range(3)]
    x, s = list(columns.values())[:2] if controller != "twincat" else (columns["MasterPos"], columns["SlavePos"])
    if controller == "twincat":
        rates = np.column_stack([s, columns["SlaveVelo"], columns["SlaveAcc"]])
        made = interpolate.BPoly.from_derivatives(x, list(rates))
    elif controller == "rockwell":
        x, s = (each.astype(np.float32).astype(float) for each in (x, s))
        made = interpolate.CubicSpline(x, s, bc_type=((1, 0.0), (1, 0.0)))
    else:
        made = interpolate.make_interp_spline(x, s, k=1)
    names = ("interpolation", "interpolation-velocity", "interpolation-acceleration")
    for order, name in enumerate(names[: 2 if controller == "codesys-table" else 3]):
        off = np.abs(made(degrees, order) * speed**order - rows[order]).max()
        assert 0.95 * checks[name].value - 1e-9 <= off <= checks[name].value * (1 + 1e-6) + 1e-9, name
    assert checks["interpolation"].unit == ("deg" if text == INDEX else "mm")
    assert checks["interpolation-velocity"].unit.endswith("/s")
    assert ("advance" in checks) == (text == INDEX)
    recipe = camgeo.load(path)
    assert {each.name for each in root_of(recipe).foresee(recipe)} == set(checks)


def test_an_advance_that_a_number_of_32_bits_does_not_hold_is_told_by_the_hour(tmp_path: Path) -> None:
    path = written(
        tmp_path, INDEX.replace("rise: 45", "rise: 360/7"), "{csv: {as: controller, for: rockwell, step: 1}}"
    )
    check = next(check for check in camgeo.check(path).checks if check.name == "advance")
    off = abs(float(np.float32(360.0 / 7.0)) - 360.0 / 7.0)
    assert check.value == pytest.approx(off, rel=1e-6)
    assert f"{off * 3600.0:.3g} deg in an hour" in check.detail


def test_a_modulo_that_no_number_of_cycles_fills_is_remarked(tmp_path: Path) -> None:
    files = "csv"
    report = camgeo.export(written(tmp_path, INDEX.replace("rise: 45", "rise: 45.1234567"), files), tmp_path / "out")
    assert [remark.name for remark in report.remarks] == ["modulo"]
    assert not camgeo.check(written(tmp_path, INDEX, files)).remarks


def test_the_motion_is_written_in_time(tmp_path: Path) -> None:
    text = INDEX.replace("rise: 45", "rise: 405").replace("rpm: 60", "rpm: 120")
    camgeo.export(written(tmp_path, text, "{csv: {as: motion, step: 0.1}}"), tmp_path / "out")
    _, columns = columns_of(tmp_path / "out" / "axis" / "axis.csv")
    t, s = columns["time_s"], columns["position_deg"]
    assert (t[-1], s[-1]) == (0.5, pytest.approx(405.0, abs=1e-9))
    assert columns["modulo_deg"][-1] == pytest.approx(45.0, abs=1e-9)
    for before, after in (("position_deg", "velocity"), ("velocity", "acceleration")):
        inside = np.abs(t - 0.1) < 0.07
        slope = np.gradient(columns[before], t)[inside]
        assert slope == pytest.approx(columns[after][inside], abs=2e-3 * np.abs(columns[after]).max())


def test_a_limit_that_fails_names_a_speed_that_holds(tmp_path: Path) -> None:
    text = PUSH + "limits: {acceleration: {at_most: 2000}}\n"
    path = written(tmp_path, text)
    report = camgeo.check(path)
    (check,) = [check for check in report.checks if not check.ok]
    assert check.value == pytest.approx(2.0 * math.pi * 30.0 / (60.0 / 90.0 / 4.0) ** 2, rel=1e-9)
    told = report.explain(check)
    rpm = re.search(r"an rpm of at most (\S+)", told)
    assert rpm is not None
    assert "limits.acceleration" in told
    assert camgeo.check(written(tmp_path, text.replace("rpm: 90", f"rpm: {rpm[1]}"))).ok
    assert not camgeo.check(written(tmp_path, text.replace("rpm: 90", f"rpm: {float(rpm[1]) * 1.001}"))).ok


def test_a_jerk_is_limited_only_where_the_acceleration_joins(tmp_path: Path) -> None:
    text = PUSH.replace("polynomial-345", "parabolic") + "limits: {jerk: {at_most: 1e7}}\n"
    report = camgeo.check(written(tmp_path, text))
    (check,) = [check for check in report.checks if not check.ok]
    assert (check.value, check.detail) == (None, "the acceleration jumps")
    assert "such as polynomial-4567" in report.explain(check)
    assert camgeo.check(written(tmp_path, text.replace("parabolic", "polynomial-4567"))).ok


@pytest.mark.parametrize(
    ("text", "change", "told"),
    [
        (INDEX, ("  index: true\n", ""), "let the motion end where it begins, or give index: true"),
        (INDEX, ("index:", "indx:"), "axis.indx: unknown key; did you mean index?"),
        (INDEX, ("dwell: 210", "dwell: 200"), "let them cover the whole turn, 360 degrees"),
        (INDEX, ("{dwell: 210}", "{rise: 20, over: 210, law: constant-velocity}"), "S' jumps from 0 to"),
        (
            INDEX,
            (
                "[{rise: 45, over: 150, law: modified-sine}, {dwell: 210}]",
                "{formula: 45*t/(2*pi) + 3*sin(t/2)}",
            ),
            "the velocity jumps from 35.5752 to 54.4248 deg/s where the next cycle begins",  # 45 -+ 3 pi
        ),
        (INDEX, ("rpm: 60", "rpm: 0"), "axis.rpm: not above 0"),
        (PUSH, ("axis:", "cam: {kind: disc}\naxis:"), "cam: a motion of an axis takes no cam; leave it out"),
        (PUSH, ("FILES", "dxf"), "export.files[0]: a motion of an axis takes no dxf"),
        (PUSH, ("FILES", "{csv: {as: motion, for: sew}}"), "belongs to a table as controller; leave it out"),
        (PUSH, ("FILES", "{csv: {as: controller}}"), "a table for a controller needs to know which"),
        (PUSH, ("FILES", "{csv: {as: motion, step: 7}}"), "360 degrees are no whole number of it"),
        (
            PUSH,
            ("FILES", "{csv: {as: controller, for: plain, step: 10, tolerance: 0.00001}}"),
            "csv.step: joined as the controller joins them rows so far apart leave",
        ),
    ],
)
def test_faults_say_what_mends_them(text: str, change: tuple[str, str], told: str, tmp_path: Path) -> None:
    assert change[0] in text
    assert told in refused(tmp_path, text.replace(*change))


def test_an_index_whose_speed_goes_on_is_taken(tmp_path: Path) -> None:
    """The remedy of a velocity that jumps over the end of the cycle: both ends at one velocity."""
    motion = "{formula: 45*t/(2*pi) + 3*sin(t)}"
    path = written(tmp_path, INDEX.replace("[{rise: 45, over: 150, law: modified-sine}, {dwell: 210}]", motion))
    report = camgeo.check(path)
    assert report.ok
    assert report["joints"] == []


def test_lengths_are_in_the_recipes_unit_and_a_table_of_another_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    inch = "units: inch\n" + PUSH.replace("30", "1.2").replace("0.01", "0.0005")
    path = written(tmp_path, inch + "limits: {velocity: {at_most: 15}}\n")
    report = camgeo.export(path, tmp_path / "out")
    check = next(check for check in report.checks if check.name == "limit:velocity")
    assert check.unit == "in/s"
    assert check.value == pytest.approx(2.0 * 1.2 / (60.0 / 90.0 / 4.0))
    head, columns = columns_of(tmp_path / "out" / "axis" / "axis.csv")
    assert columns["slave_in"].max() == pytest.approx(1.2)
    assert report["axis"]["rpm"] == 90
    assert (report["tolerance"], report["tolerance_unit"]) == (0.0005, "in")
    table = tmp_path / "out" / "axis" / "axis.csv"
    assert main(["verify", str(path), str(table)]) == 0
    off = tmp_path / "off.csv"
    off.write_text(table.read_text().replace("\n90,1.2,", "\n90,1.202,"), encoding="utf-8")
    assert off.read_text() != table.read_text()
    assert main(["verify", str(path), str(off)]) == 1
    assert "interpolation (off.csv): 0.002 in" in capsys.readouterr().out
    turned = written(tmp_path, INDEX)
    assert main(["verify", str(turned), str(table)]) == 1
    assert "the slave is not in the motion's unit, deg" in capsys.readouterr().out
    assert main(["verify", str(turned), str(table), "--tolerance", "0.1"]) == 2
    assert "give it in the recipe as export.tolerance" in capsys.readouterr().err
    assert "in/deg" in " ".join(head)


@pytest.mark.thin(2)
@pytest.mark.parametrize(("text", "shape"), [(INDEX, "table"), (PUSH, "carriage")])
def test_the_page_has_four_curves_in_time_with_their_limits(text: str, shape: str, tmp_path: Path) -> None:
    path = written(tmp_path, text + "limits: {velocity: {at_most: 500}}\n", f"{PLAIN}, html")
    assert camgeo.export(path, tmp_path / "out").ok
    page = (tmp_path / "out" / "axis" / "axis.html").read_text(encoding="utf-8")
    for title in ("Position", "Velocity", "Acceleration", "Jerk"):
        assert f'"title":"{title}"' in page
    (limits,) = re.findall(r'"limits":\[\[(\S+?),"limit"\],\[-\1,""\]\]', page)
    assert float(limits) == pytest.approx(500.0)
    assert "the master turns at" in page
    assert shape in page
    assert "svg" in camgeo.design(path)._repr_html_()


@pytest.mark.thin(2)
@pytest.mark.parametrize("units", ["mm", "inch"])
def test_the_page_of_a_judged_table_has_its_error(units: str, tmp_path: Path) -> None:
    """One row of a table is moved by 0.02, twice the tolerance: the error is that there, and ends at its neighbours."""
    path = written(tmp_path, f"units: {units}\n{PUSH}")
    assert camgeo.export(path, tmp_path / "out").ok
    text = (tmp_path / "out" / "axis" / "axis.csv").read_text(encoding="utf-8")
    rows = text[text.index("\nmaster_deg") :].splitlines()[2:]
    place = next(k for k, row in enumerate(rows) if float(row.split(",")[0]) > 40.0)
    angle, slave, rates = rows[place].split(",", 2)
    moved = f"{angle},{float(slave) + 0.02:.9f},{rates}"
    (tmp_path / "off.csv").write_text(text.replace(f"\n{rows[place]}\n", f"\n{moved}\n"), encoding="utf-8")
    report = camgeo.verify(path, tmp_path / "off.csv", page=True)
    assert not report.ok
    assert report.page is not None
    data = report.page.split('"title":"Error of off.csv"')[1].split("]}]")[0]
    digits, steps = re.findall(r'"d":(-?\d+),"v":\[([^\]]*)', data)[0]
    error = np.cumsum([float(step) for step in steps.split(",")]) / 10.0 ** int(digits)
    angles = np.arange(len(error)) * 360.0 / (len(error) - 1)
    before, at, after = (float(rows[place + k].split(",")[0]) for k in (-1, 0, 1))
    assert np.abs(error).max() == pytest.approx(0.02, rel=0.01)
    assert angles[np.abs(error).argmax()] == pytest.approx(at, abs=0.51)
    assert np.abs(error[(angles < before) | (angles > after)]).max() < 0.01
    assert '[0.01,"tolerance"],[-0.01,""]' in report.page


def test_a_file_that_is_no_table_has_a_page_without_its_error(tmp_path: Path) -> None:
    path = written(tmp_path, PUSH)
    (tmp_path / "no.csv").write_text("master_deg,other\n0,2\n", encoding="utf-8")
    report = camgeo.verify(path, tmp_path / "no.csv", page=True)
    assert not report.ok
    assert report.page is not None
    assert '"title":"Error of' not in report.page


def test_an_axis_that_stands_or_runs_on_evenly_is_made(tmp_path: Path) -> None:
    """A motion without velocity, and one without acceleration, of which nothing is a share."""
    files = "{csv: {as: controller, for: rockwell, acceleration_error: 1}}, html"
    for motion, index, what in (
        ("{dwell: 360}", "false", "velocity"),
        ("{rise: 360, over: 360, law: constant-velocity}", "true", "acceleration"),
    ):
        text = INDEX.replace("[{rise: 45, over: 150, law: modified-sine}, {dwell: 210}]", f"[{motion}]")
        report = camgeo.export(
            written(tmp_path, text.replace("index: true", f"index: {index}"), files), tmp_path / "out"
        )
        assert report.ok
        check = next(check for check in report.checks if check.name == f"interpolation-{what}")
        assert (check.detail, check.limit) == (f"the motion has no {what}", None)
    still = PUSH.replace(PUSH[PUSH.index("[") : PUSH.index("]") + 1], "[{dwell: 360}]")
    assert camgeo.export(written(tmp_path, still, files), tmp_path / "out").ok


@pytest.mark.parametrize("name", ["axis", "axis-index"])
def test_a_starter_is_made_and_holds(name: str, tmp_path: Path) -> None:
    path = tmp_path / "new.yaml"
    assert main(["new", name, str(path)]) == 0
    assert camgeo.check(path).ok


def test_the_page_of_documents_is_what_it_says(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "axis.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```yaml\n# dial.yaml\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    report = camgeo.export(written(tmp_path, block), tmp_path / "out")
    assert report.ok
    assert {file.kind for file in report.files} == {"csv", "html"}


def test_a_limit_without_a_bound_says_by_which_time(tmp_path: Path) -> None:
    with pytest.raises(RecipeErrors, match=r"limits\.jerk\.at_most: missing; .*, by second cubed"):
        camgeo.load(written(tmp_path, PUSH + "limits: {jerk: {}}\n"))
