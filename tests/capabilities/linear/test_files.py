"""Files of linear cams: written, read back by other libraries, judged, refused where they are wrong; the page.

Holds: camgeo.capabilities.linear.making, camgeo.capabilities.linear.pipeline, camgeo.capabilities.linear.program,
camgeo.capabilities.linear.plate, camgeo.capabilities.linear.outline, camgeo.capabilities.linear.tables,
camgeo.capabilities.linear.verdicts, camgeo.capabilities.linear.checks_of, camgeo.capabilities.linear.plate_page,
camgeo.capabilities.linear.section, camgeo.capabilities.linear.narrowed, camgeo.capabilities.linear.root,
camgeo.capabilities.linear.job, camgeo.capabilities.linear.starter, camgeo.measures.flanks, kin.read.verdict.
"""

from __future__ import annotations

import csv
import math
from typing import TYPE_CHECKING, Any

import ezdxf
import numpy as np
import pytest
from capabilities.linear.plates import ENDLESS, GROOVE, MOTION, ON_ARM, PLATE, changed
from support.heavy import trimesh

import camgeo
from camgeo.api.root import root_of
from camgeo.cli.main import main

if TYPE_CHECKING:
    from pathlib import Path

FURNISHED = changed(
    PLATE,
    (
        "thickness: 12",
        "thickness: 12, holes: [{at: [20, 10], diameter: 6}], slots: [{at: [60, 9], length: 9, width: 4}]",
    ),
)


def test_a_table_over_the_travel_becomes_a_plate_and_the_report_says_how_near(tmp_path: Path) -> None:
    """Its lift need not begin at 0, and its ends move: the drawing's follower has the velocity of the last rows."""
    x = np.arange(0.0, 101.0)
    lift = 3.0 + 0.1 * x + 2.0 * np.sin(x / 20.0)
    rows = "".join(f"{at / 25.4:.8f};{s:.5f}\n" for at, s in zip(x, lift, strict=True))
    (tmp_path / "lift.csv").write_text("travel_in;lift_mm\n" + rows, "utf-8")
    text = changed(PLATE, (f"motion: {MOTION}", "motion: {table: lift.csv}"))
    report = exported(tmp_path, text)
    assert report.ok
    found: Any = dict(report)
    assert found["table"]["distance_lowered"] < 2e-5
    assert found["table"]["lowered"] == pytest.approx(3.0, abs=1e-4)
    assert [remark.name for remark in report.remarks if remark.name.startswith("table")] == ["table-distance"]
    design: Any = camgeo.design(camgeo.load(tmp_path / "plate.yaml"))
    assert design.travel == pytest.approx(100.0, abs=1e-6)
    assert float(design.motion(design.travel, derivative=1)) == pytest.approx(0.1 + 0.1 * math.cos(5.0), abs=1e-4)


@pytest.fixture(scope="module")
def furnished(tmp_path_factory: pytest.TempPathFactory) -> camgeo.Report:
    """What an export of FURNISHED reports."""
    return exported(tmp_path_factory.mktemp("furnished"), FURNISHED)


def exported(folder: Path, text: str, name: str = "plate") -> camgeo.Report:
    (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    return camgeo.export(folder / f"{name}.yaml", folder / "out")


def drawn(path: Path | None, layer: str = "CUT") -> np.ndarray:
    """Vertices (n, 2) of the closed polyline on a layer of a drawing."""
    (line,) = ezdxf.readfile(str(path)).modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
    polyline: Any = line
    return np.array(polyline.get_points("xy"))


def failing(report: camgeo.Report) -> set[str]:
    return {check.name for check in report.checks if not check.ok}


def test_a_drawing_has_its_layers_and_is_as_large_as_it_says(furnished: camgeo.Report) -> None:
    report = furnished
    assert report.ok
    assert report["plate"]["from"] == pytest.approx(-6.0)
    assert report["plate"]["to"] == pytest.approx(126.0)
    path = report.files[0].path
    points = drawn(path)
    np.testing.assert_allclose([*points.min(axis=0), points[:, 0].max()], [-6.0, 0.0, 126.0], atol=1e-12)
    assert points[:, 1].max() == pytest.approx(52.0, abs=1e-3)
    (circle,) = ezdxf.readfile(path).modelspace().query('CIRCLE[layer=="HOLES"]')
    assert tuple(circle.dxf.center)[:2] == (20.0, 10.0)
    assert drawn(path, "HOLES")[:, 0].mean() == pytest.approx(60.0)
    motion = report.files[0].motion
    assert motion.max <= 0.001 / math.cos(math.radians(43.2))
    assert (motion.at_deg, motion.at_unit) == (None, "mm")


def test_to_the_right_all_is_mirrored(furnished: camgeo.Report, tmp_path: Path) -> None:
    right = exported(tmp_path, changed(FURNISHED, ("base: 32", "travel: right\n  base: 32")), "right")
    assert right.ok
    rows = []
    for report in (furnished, right):
        path = report.files[0].path
        (circle,) = ezdxf.readfile(path).modelspace().query("CIRCLE")
        rows.append((drawn(path), circle.dxf.center.x))
    assert rows[0][1] == -rows[1][1]
    np.testing.assert_array_equal(np.sort(rows[0][0][:, 0]), np.sort(-rows[1][0][:, 0]))
    (tmp_path / "right.yaml").write_text(FURNISHED, encoding="utf-8")
    foreign = camgeo.verify(tmp_path / "right.yaml", tmp_path / "out" / "right" / "right.dxf")
    assert {"contour", "motion", "ends"} <= failing(foreign)


def test_a_plate_of_inches_is_one(tmp_path: Path) -> None:
    text = changed(
        "units: inch\n" + PLATE,
        ("base: 32", "base: 32 mm"),
        ("radius: 8", "radius: 8 mm"),
        ("overrun: 6", "overrun: 6 mm"),
        ("{dwell: 10}", "{dwell: 10 mm}"),
        ("rise: 20, over: 50", "rise: 20 mm, over: 50 mm"),
        ("{dwell: 20}", "{dwell: 20 mm}"),
        ("return: 20, over: 40", "return: 20 mm, over: 40 mm"),
        ("thickness: 12", "thickness: 12 mm"),
    )
    report = exported(tmp_path, text)
    assert report.ok
    assert report["plate"]["to"] == pytest.approx(126.0 / 25.4)
    assert drawn(tmp_path / "out" / "plate" / "plate.dxf").max() == pytest.approx(126.0 / 25.4)


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("text", "volume"),
    [
        (changed(FURNISHED, ("[dxf]", "[stl, ply, 3mf], tolerance: 0.02")), 5.0),
        (changed(GROOVE, ("[dxf]", "[stl, ply, 3mf]")), 5.0),
        (changed(ENDLESS + "export: {files: [stl]}\n", ("over: 40}", "over: 40}\n")), None),
    ],
)
def test_solids_are_closed(tmp_path: Path, text: str, volume: float | None) -> None:
    report = exported(tmp_path, text)
    assert report.ok, failing(report)
    for file in report.files:
        solid = trimesh.load(file.path, force="mesh")
        assert solid.is_watertight
        assert solid.volume > 0.0
    if volume is None:
        # of the wave y = base + lift about its mean, less what the roller's own size takes: by Green's formula
        design = camgeo.design(report.recipe)
        u = np.linspace(0.0, 40.0, 200001)
        x, y = design.flank(u).T
        area = float(np.sum(0.5 * (y[1:] + y[:-1]) * np.diff(x)))
        assert solid.volume == pytest.approx(8.0 * area, rel=1e-4)


@pytest.mark.slow
def test_step_has_a_chamfer_round_the_corners(tmp_path: Path) -> None:
    text = changed(ON_ARM + "part: {thickness: 12}\nexport: {files: [step, stl]}\n", ("12}", "12, chamfer: 0.5}"))
    report = exported(tmp_path, text)
    assert report.ok, failing(report)
    assert {"chamfer", "contour", "motion", "thickness"} <= {check.name for check in report.checks}


def test_a_program_mills_round_the_plate_and_a_drawing_has_its_kerf(tmp_path: Path) -> None:
    milled = (
        "manufacture: {cutter: 12, feed: 400, plunge: 99, spindle: 4e3, depth_of_cut: 6, safe_height: 5, holes: true}\n"
    )
    text = changed(FURNISHED, ("diameter: 6", "diameter: 14"), ("[dxf]", "[gcode, {dxf: {kerf: 0.3}}]")) + milled
    report = exported(tmp_path, text)
    assert report.ok, failing(report)
    points = drawn(report.files[1].path)
    np.testing.assert_allclose([*points.min(axis=0), points[:, 0].max()], [-6.15, -0.15, 126.15], atol=1e-12)
    wide = changed(text, ("cutter: 12", "cutter: 50"))
    (tmp_path / "wide.yaml").write_text(wide, encoding="utf-8")
    with pytest.raises(camgeo.RecipeErrors, match=r"does not come into the hollow .* give less than 48\.45 mm"):
        camgeo.check(tmp_path / "wide.yaml")


def test_tables(tmp_path: Path) -> None:
    report = exported(
        tmp_path, changed(PLATE, ("[dxf]", "[csv, {csv: {as: inspection, step: 7}}, {csv: {as: points}}]"))
    )
    motion, inspection, points = (file.path.read_text("utf-8").splitlines() for file in report.files)
    rows = list(csv.DictReader(motion))
    assert [rows[0]["travel_mm"], rows[-1]["travel_mm"], rows[-1]["lift_mm"]] == ["0", "120", "0"]
    middle = rows[210]
    assert float(middle["travel_mm"]) == 35.0
    assert float(middle["velocity"]) == pytest.approx(0.8)
    contact = list(csv.DictReader(inspection))[5]
    x, y, nx, ny = (float(contact[key]) for key in ("x_mm", "y_mm", "nx", "ny"))
    assert float(contact["travel_mm"]) == pytest.approx(120 / 18 * 5, abs=1e-9)
    assert math.hypot(nx, ny) == pytest.approx(1.0)
    lift = float(contact["lift_mm"])
    np.testing.assert_allclose([x + 8.0 * nx, y + 8.0 * ny], [float(contact["travel_mm"]), 40.0 + lift], atol=1e-9)
    assert points[0].split(",")[2] == "0"


def test_the_page_has_the_plate_and_all_figures(tmp_path: Path) -> None:
    text = changed(GROOVE, ("[dxf]", "[html]"), ("  ends", "  drive: {forth: 300, load: 90}\n  ends"))
    report = exported(tmp_path, text)
    page = report.files[-1].path.read_text("utf-8")
    for word in (
        "the plate travels to the left",
        "drive-force",
        "pitch-radius, upper",
        '"noun":"plate"',
        '"closed":false',
    ):
        assert word in page


def test_a_foreign_drawing_is_told_apart(tmp_path: Path) -> None:
    """A plate whose flank is the lift itself, as an open generator has it, is off by R (1/cos a - 1) and more."""
    (tmp_path / "plate.yaml").write_text(PLATE, encoding="utf-8")
    u = np.linspace(0.0, 120.0, 2001)
    lift = camgeo.design(tmp_path / "plate.yaml").motion(u)
    rows = [(126.0, 32.0), *zip(u[::-1], 32.0 + lift[::-1], strict=True), (-6.0, 32.0), (-6.0, 0.0), (126.0, 0.0)]
    drawing = ezdxf.new(units=4)
    drawing.modelspace().add_lwpolyline(rows, close=True)
    drawing.saveas(tmp_path / "lift.dxf")
    report = camgeo.verify(tmp_path / "plate.yaml", tmp_path / "lift.dxf", page=True)
    assert {"contour", "motion"} <= failing(report)
    assert "Error of lift.dxf" in report.page
    (check,) = (check for check in report.checks if check.name == "motion")
    assert check.value == pytest.approx(2.9, abs=0.3)
    assert check.at_unit == "mm"


def test_limits_are_checks_with_a_remedy(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    limited = changed(
        PLATE, ("part:", "limits: {pressure-angle: {at_most: 40}, radius-of-curvature: {at_least: 9}}\npart:")
    )
    (tmp_path / "plate.yaml").write_text(limited, encoding="utf-8")
    assert main(["check", str(tmp_path / "plate.yaml")]) == 1
    told = capsys.readouterr().out
    assert "limit:pressure-angle: 43.1524 deg, at most 40 allowed, at 100.00 mm" in told
    assert "limit:radius-of-curvature: 8.22468 mm, at least 9 allowed, at 86.42 mm" in told
    report = camgeo.check(tmp_path / "plate.yaml")
    text = "".join(report.explain(check) for check in report.checks if not check.ok)
    assert "sizing: {pressure-angle: {at_most: 40}} under cam" in text
    sized = changed(
        limited, ("  ends", "  sizing: {pressure-angle: {at_most: 40}}\n  ends"), ("at_least: 9", "at_least: 1")
    )
    (tmp_path / "plate.yaml").write_text(sized, encoding="utf-8")
    assert camgeo.check(tmp_path / "plate.yaml").ok


def test_a_plate_that_reverses_while_its_follower_moves_is_remarked(tmp_path: Path) -> None:
    text = changed(PLATE, (MOTION, "{formula: x/4, over: 80}"), ("  ends", "  drive: {forth: 100, back: 300}\n  ends"))
    report = exported(tmp_path, text)
    remarks = [remark for remark in report.remarks if remark.name == "struck"]
    assert [(remark.value, remark.at, remark.at_unit) for remark in remarks] == [
        (100.0, 0.0, "mm"),
        (100.0, 80.0, "mm"),
    ]


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    "text",
    [
        changed(
            FURNISHED, ("thickness: 12", "thickness: 12, chamfer: 0.5, mark: {at: [90, 30]}"), ("[dxf]", "[svg, stl]")
        ),
        changed(GROOVE, ("[dxf]", "[dxf, stl]")),
        ENDLESS + "export: {files: [dxf]}\n",
        PLATE.replace("[dxf]", "[{dxf: {kerf: 0.2}}, gcode]")
        + "manufacture: {cutter: 12, feed: 400, plunge: 99, spindle: 4e3, depth_of_cut: 12, safe_height: 5}\n",
    ],
)
def test_checks_are_foreseen(text: str, tmp_path: Path) -> None:
    (tmp_path / "plate.yaml").write_text(text, encoding="utf-8")
    report = camgeo.check(tmp_path / "plate.yaml")
    made = {(check.name, check.file) for check in report.checks}
    assert {(each.name, each.file) for each in root_of(report.recipe).foresee(report.recipe)} == made


def test_the_same_input_gives_the_same_bytes(tmp_path: Path) -> None:
    names = "[dxf, stl, csv], tolerance: 0.02"
    first, second = (exported(tmp_path / name, changed(PLATE, ("[dxf]", names))) for name in made(tmp_path))
    for one, other in zip(first.files, second.files, strict=True):
        assert one.path.read_bytes() == other.path.read_bytes()


def made(folder: Path) -> tuple[str, str]:
    for name in ("a", "b"):
        (folder / name).mkdir()
    return "a", "b"
