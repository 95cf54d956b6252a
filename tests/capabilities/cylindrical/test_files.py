"""Files of cylindrical cams: written, read back by other libraries, judged, refused where they are wrong; the library.

Holds: camgeo.capabilities.cylindrical.making, camgeo.capabilities.cylindrical.pipeline,
camgeo.capabilities.cylindrical.verdicts, camgeo.capabilities.cylindrical.development,
camgeo.capabilities.cylindrical.tables, camgeo.capabilities.cylindrical.section,
camgeo.capabilities.cylindrical.root, camgeo.capabilities.cylindrical.starter,
camgeo.capabilities.cylindrical.library, camgeo.capabilities.cylindrical.design, camgeo.capabilities.cylindrical.exact,
camgeo.capabilities.cylindrical.checks_of, camgeo.capabilities.cylindrical.checks,
camgeo.capabilities.cylindrical.gentler, camgeo.capabilities.cylindrical.drum_page, camgeo.output.own_kind,
camgeo.api.own_kind, camgeo.output.refusals, camgeo.measures.placed, camgeo.recipe.figure_bounds,
camgeo.measures.flanks, camgeo.fit.cells, kin.read.verdict.
"""

from __future__ import annotations

import csv
import math
import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import (
    ARM,
    BESIDE,
    BOTTOM,
    CONE,
    GROOVE,
    LEADING,
    RIB,
    RIB_ON_ARM,
    TOP,
    UNDERCUT,
    changed,
    design_of,
)
from support.heavy import ezdxf, manifold3d, trimesh

import camgeo
from camgeo.api.root import root_of
from camgeo.capabilities.cylindrical.figures import figures_of, volume
from camgeo.capabilities.cylindrical.flank import Contact, Flank
from camgeo.capabilities.cylindrical.solid import drum_mesh
from camgeo.cli.main import main
from camgeo.files.mesh import Mesh
from camgeo.formats.stl import write_stl
from camgeo.output.extension import numbers_of
from camgeo.schema.errors import RecipeErrors
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign

TOLERANCE = 0.02
SIMPLER = 0.1 * TOLERANCE
DEVELOPED = changed(
    GROOVE, ("[stl]", "[{dxf: {as: development, at: [outer, pitch, 38]}}, {csv: {as: flank, step: 10}}]")
)


def exported(folder: Path, text: str, name: str = "drum") -> camgeo.Report:
    (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    return camgeo.export(folder / f"{name}.yaml", folder / "out")


def demand_foreseen(folder: Path, report: camgeo.Report) -> None:
    """Demand that the report has every check that was foreseen."""
    recipe = camgeo.load(folder / "drum.yaml")
    found = {(check.name, check.file) for check in report.checks}
    assert {(each.name, each.file) for each in root_of(recipe).foresee(recipe)} <= found


def failing(report: camgeo.Report) -> set[str]:
    return {check.name for check in report.checks if not check.ok}


@pytest.mark.costly("a solid, which the judge sets its roller down on at all angles")
def test_a_groove_as_a_solid(tmp_path: Path) -> None:
    report = exported(tmp_path, GROOVE)
    assert report.ok
    body = trimesh.load(tmp_path / "out" / "drum" / "drum.stl")
    assert body.is_watertight
    assert body.volume == pytest.approx(volume(design_of(GROOVE)), abs=TOLERANCE * body.area)
    found: Any = dict(report)
    motions = [surface["motion"] for surface in found["files"][0]["surfaces"]]
    steep = math.radians(45.15)
    assert all(motion["max"] + motion["remainder"] <= TOLERANCE / math.cos(steep) for motion in motions)
    demand_foreseen(tmp_path, report)
    assert found["drum"]["floor"] == 37.5
    assert {entry["name"] for entry in found["drum"]["figures"]} >= {"pressure-angle", "contact-length", "play"}


def test_a_solid_too_coarse_for_its_flanks_is_refused_with_a_tolerance_that_does(tmp_path: Path) -> None:
    text = changed(GROOVE, ("tolerance: 0.02", "tolerance: 100"))
    with pytest.raises(RecipeErrors, match=r"export\.tolerance: the flanks are 12\.5 mm deep.*; give at most 6\.25 mm"):
        exported(tmp_path, text)
    assert exported(tmp_path, changed(text, ("100", "6.25"))).ok
    own = changed(text, ("100", "1"), ("[stl]", "[{stl: {tolerance: 7}}]"))
    with pytest.raises(RecipeErrors, match=r"export\.files\[0\].*given 7 mm; give at most 6\.25 mm"):
        exported(tmp_path, own)


@pytest.mark.costly("solids of each other track, judged")
@pytest.mark.parametrize(
    "text", [RIB, TOP, BOTTOM, "units: inch\nrotation: ccw\n" + GROOVE], ids=["rib", "top", "bottom", "inch"]
)
def test_other_tracks(text: str, tmp_path: Path) -> None:
    if text.startswith("units"):
        for old in (
            "radius: 50",
            "depth: 12.5",
            "radius: 10",
            "from: 38",
            "pitch_height: 20",
            "rise: 40",
            "return: 40",
        ):
            text = changed(text, (old, f"{old} mm"))
        text = changed(text, ("length: 80", "length: 80 mm"), ("bore: 24", "bore: 24 mm"), ("0.02", "0.02 mm"))
    text = changed(text, ("tolerance: 0.02", "tolerance: 0.05"))
    report = exported(tmp_path, text)
    assert report.ok, [str(check) for check in report.checks if not check.ok]


@pytest.mark.costly("a solid without a bore, judged")
def test_an_end_face_all_of_whose_corners_are_on_the_blank(tmp_path: Path) -> None:
    """A length that single precision does not hold leaves the corners nearer to the blank than to the end face."""
    text = changed(
        GROOVE, ("length: 80, bore: 24, keyway: din6885", "length: 80.3"), ("tolerance: 0.02", "tolerance: 0.2")
    )
    report = exported(tmp_path, text)
    assert report.ok, [str(check) for check in report.checks if not check.ok]


@pytest.mark.costly("the one drum of the quick tests that is cut short, made and judged")
def test_a_shortened_flank_loses_no_motion(tmp_path: Path) -> None:
    report = exported(tmp_path, UNDERCUT)
    assert report.ok, [str(check) for check in report.checks if not check.ok]
    found: Any = dict(report)
    assert len(found["drum"]["undercut"]) == 4


LED = {"leading": LEADING, "rib": RIB_ON_ARM, "cone": CONE, "beside": BESIDE}


@pytest.mark.costly("solids of arms and cones, judged")
@pytest.mark.parametrize("name", ["rib", "cone"])
def test_other_followers(name: str, tmp_path: Path) -> None:
    judge_led(LED[name], tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["leading", "beside"])
def test_more_followers(name: str, tmp_path: Path) -> None:
    judge_led(LED[name], tmp_path)


def judge_led(text: str, folder: Path) -> None:
    """Demand a solid and developments that are judged right, in the follower's unit."""
    text = changed(text, ("tolerance: 0.02", "tolerance: 0.4"), ("[stl]", "[stl, {dxf: {at: [outer, pitch]}}]"))
    report = exported(folder, text)
    assert report.ok, [str(check) for check in report.checks if not check.ok]
    demand_foreseen(folder, report)
    unit = "deg" if "arm:" in text else "mm"
    assert {check.unit for check in report.checks if check.name == "motion"} == {unit}
    found: Any = dict(report)
    assert found["files"][0]["surfaces"][0]["motion"]["unit"] == unit
    assert found["files"][0]["play"][0]["unit"] == unit


# --- developments and tables ------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_development_names_its_radii(tmp_path: Path) -> None:
    report = exported(tmp_path, DEVELOPED)
    assert report.ok, [str(check) for check in report.checks if not check.ok]
    demand_foreseen(tmp_path, report)
    drawing = ezdxf.readfile(tmp_path / "out" / "drum" / "drum.dxf")
    lines = {line.dxf.layer: np.array(line.get_points("xy")) for line in drawing.modelspace().query("LWPOLYLINE")}
    assert set(lines) == {f"R{r}_{name}" for r in (50, 38) for name in ("LOWER", "UPPER")} | {
        "R50_PITCH",
        "R50_OVERLAP",
        "R38_OVERLAP",
    }
    turn = 2.0 * math.pi
    for layer, points in lines.items():
        radius = float(layer[1:3])
        if layer.endswith("OVERLAP"):
            assert points[:, 1].tolist() == [0.0, 80.0]
            continue
        x, z = points.T
        assert x[0] == pytest.approx(0.0, abs=1e-9)
        assert x[-1] == pytest.approx(radius * turn * 25.0 / 24.0, abs=2.0)
        assert (np.diff(x) > 0.0).all()
        # the overlap repeats the beginning
        again = x > radius * turn
        assert abs(np.interp(x[again] - radius * turn, x, z) - z[again]).max() < 2.0 * TOLERANCE
    # the place of the worked case on the cylinder of the blank
    x, z = lines["R50_LOWER"].T
    assert np.interp([29.7592556974, 58.4745116351], x, z) == pytest.approx([14.2951535, 32.0755273], abs=TOLERANCE)
    remarks = {remark.name: remark.sentence for remark in report.remarks}
    assert "the development at 38 mm is right at that radius alone" in remarks["wrapped-wall"]
    assert "of the roller's size" in remarks["offset-path"]
    with (tmp_path / "out" / "drum" / "drum.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 36 * 3
    row = rows[3 * 6]
    assert float(row["lower_phi_deg"]) == pytest.approx(70.567709167)
    assert float(row["lower_z_mm"]) == pytest.approx(32.9472546161)
    normal = [float(row[f"lower_n{axis}"]) for axis in "xyz"]
    assert math.hypot(*normal) == pytest.approx(1.0)


@pytest.mark.slow
def test_ccw_mirrors_a_development_and_a_table(tmp_path: Path) -> None:
    for name, text in (("cw", DEVELOPED), ("ccw", "rotation: ccw\n" + DEVELOPED)):
        exported(tmp_path, text, name)
    rows = []
    for name in ("cw", "ccw"):
        drawing = ezdxf.readfile(tmp_path / "out" / name / f"{name}.dxf")
        (line,) = drawing.modelspace().query('LWPOLYLINE[layer=="R50_LOWER"]')
        rows.append(np.array(line.get_points("xy")))
    np.testing.assert_allclose(rows[0] * [-1.0, 1.0], rows[1], atol=1e-12)
    lines = (tmp_path / "out" / "ccw" / "ccw.csv").read_text("utf-8").splitlines()
    names, row = (lines[k].split(",") for k in (0, 1 + 3 * 6))
    assert float(row[names.index("lower_phi_deg")]) == pytest.approx(360.0 - 70.567709167)


# --- planted faults ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def drum(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Mesh]:
    """Recipe of a groove, and its mesh."""
    folder = tmp_path_factory.mktemp("planted")
    (folder / "drum.yaml").write_text(GROOVE, encoding="utf-8")
    mesh, _ = drum_mesh(design_of(GROOVE), TOLERANCE, numbers_of("stl", 1.0))
    return folder / "drum.yaml", mesh


def verdict(drum: tuple[Path, Mesh], mesh: Mesh, name: str = "given.stl") -> camgeo.Report:
    path = drum[0].parent / name
    write_stl(path, mesh)
    return camgeo.verify(drum[0], path)


class Radial(Flank):
    """Walls cut radially from the right line on one cylinder."""

    cut = 50.0

    def on(self, theta: np.ndarray, r: Any, at: Any = 1) -> Contact:
        return super().on(theta, 0.0 * r + self.cut, at)


class Mean(Radial):
    """Walls cut radially from the line at the middle of the depth."""

    cut = 43.75


class Offset(Flank):
    """Walls cut radially from the path offset by the roller's radius on the cylinder of the blank."""

    def on(self, theta: np.ndarray, r: Any, at: Any = 1) -> Contact:
        right = super().on(theta, r, at)
        s, v = self.law.derivatives(theta, 1, at)
        angle = np.arctan2(v, 50.0)
        phi = theta - self.side * self.radius * np.sin(angle) / 50.0
        return right._replace(phi=phi, z=self.level + s + self.side * self.radius * np.cos(angle))


class Along(Flank):
    """Walls as far from the path as the roller's radius, measured along the axis."""

    def on(self, theta: np.ndarray, r: Any, at: Any = 1) -> Contact:
        right = super().on(theta, r, at)
        lift = self.law.derivatives(theta, 0, at)[0]
        return right._replace(phi=theta, z=self.level + lift + self.side * self.radius)


@pytest.mark.slow
@pytest.mark.parametrize("wrong", [Radial, Mean, Offset, Along])
def test_wrong_walls_are_refused(wrong: type[Flank], drum: tuple[Path, Mesh]) -> None:
    design = design_of(GROOVE)
    flanks = {name: wrong(each.law, each.guide, each.radius, each.side) for name, each in design.flanks.items()}
    design.__dict__["flanks"] = flanks
    mesh, _ = drum_mesh(design, TOLERANCE, numbers_of("stl", 1.0))
    report = verdict(drum, mesh)
    assert "motion" in failing(report)


def led_wrong(design: DrumDesign, **guide: float) -> dict[str, Flank]:
    return {name: replace(flank, guide=replace(flank.guide, **guide)) for name, flank in design.flanks.items()}


WRONG: dict[str, tuple[str, Callable[[DrumDesign], dict[str, Flank]]]] = {
    "on the other side": (ARM, lambda design: led_wrong(design, y=-78.0, side=-1)),
    "pivot 0.3 off": (ARM, lambda design: led_wrong(design, y=78.3)),
    "a cylinder": (CONE, lambda design: {name: replace(each, taper=0.0) for name, each in design.flanks.items()}),
    "on a radius": (BESIDE, lambda design: led_wrong(design, offset=0.0)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", WRONG)
def test_wrong_followers_are_refused(name: str, tmp_path: Path) -> None:
    text, wrong = WRONG[name]
    text = changed(text, ("tolerance: 0.02", "tolerance: 0.3"))
    (tmp_path / "drum.yaml").write_text(text, encoding="utf-8")
    design = design_of(text)
    design.__dict__["flanks"] = wrong(design)
    mesh, _ = drum_mesh(design, 0.3, numbers_of("stl", 1.0))
    assert {"contour", "motion"} & failing(verdict((tmp_path / "drum.yaml", mesh), mesh))


def moved(mesh: Mesh) -> Mesh:
    points = mesh.points.copy()
    lower = np.abs(np.hypot(points[:, 0], points[:, 1]) - 44.0) < 2.0
    points[np.flatnonzero(lower)[17], 2] += 0.05
    return Mesh(points, mesh.triangles)


def turned(mesh: Mesh) -> Mesh:
    c, s = math.cos(math.radians(0.1)), math.sin(math.radians(0.1))
    return Mesh(mesh.points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]]), mesh.triangles)


def mirrored(mesh: Mesh) -> Mesh:
    return Mesh(mesh.points * [1.0, -1.0, 1.0], mesh.triangles[:, ::-1])


def flipped(mesh: Mesh) -> Mesh:
    triangles = mesh.triangles.copy()
    triangles[100] = triangles[100, ::-1]
    return Mesh(mesh.points, triangles)


def shallow(mesh: Mesh) -> Mesh:
    """The floor 0.6 mm nearer the blank: the roller's end would scrape on it."""
    points = mesh.points.copy()
    r = np.hypot(points[:, 0], points[:, 1])
    floor = np.abs(r - 37.5) < 1e-3
    points[floor, :2] *= 38.1 / 37.5
    return Mesh(points, mesh.triangles)


FAULTS: dict[str, Callable[[Mesh], Mesh]] = {
    "moved": moved,
    "turned": turned,
    "mirrored": mirrored,
    "flipped": flipped,
    "shallow": shallow,
    "scaled": lambda mesh: Mesh(mesh.points * 1.001, mesh.triangles),
    "open": lambda mesh: Mesh(mesh.points, mesh.triangles[1:]),
}


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults_are_refused(fault: str, drum: tuple[Path, Mesh]) -> None:
    assert not verdict(drum, FAULTS[fault](drum[1])).ok


@pytest.mark.slow
def test_a_drum_of_another_roller_is_refused(drum: tuple[Path, Mesh]) -> None:
    design = design_of(changed(GROOVE, ("radius: 10,", "radius: 10.02,")))
    mesh, _ = drum_mesh(design, TOLERANCE, numbers_of("stl", 1.0))
    assert {"contour", "motion"} & failing(verdict(drum, mesh))


def resaved(mesh: Mesh) -> Mesh:
    body = trimesh.Trimesh(mesh.points, mesh.triangles, process=True)
    return Mesh(np.asarray(body.vertices), np.asarray(body.faces))


def subdivided(mesh: Mesh) -> Mesh:
    points, triangles = trimesh.remesh.subdivide(mesh.points, mesh.triangles)
    return Mesh(points.astype(np.float32).astype(float), triangles)


def simplified(mesh: Mesh) -> Mesh:
    body = manifold3d.Manifold(manifold3d.Mesh64(mesh.points, mesh.triangles.astype(np.uint64)))
    kept = body.simplify(SIMPLER).to_mesh64()
    return Mesh(np.asarray(kept.vert_properties)[:, :3].astype(np.float32).astype(float), np.asarray(kept.tri_verts))


HARMLESS = [resaved, subdivided, simplified]


@pytest.mark.slow
@pytest.mark.parametrize("harmless", HARMLESS, ids=lambda each: each.__name__)
def test_harmless_changes_are_accepted(harmless: Callable[[Mesh], Mesh], drum: tuple[Path, Mesh]) -> None:
    # what is simplified may stray by that much more
    mesh, _ = drum_mesh(design_of(GROOVE), TOLERANCE - SIMPLER, numbers_of("stl", 1.0))
    report = verdict(drum, harmless(mesh))
    assert report.ok, [str(check) for check in report.checks if not check.ok]


# --- library, commands ------------------------------------------------------------------------------------------------


def test_the_library_has_an_arm(tmp_path: Path) -> None:
    """Swings are radians, and the flank on the blank is where the worked case has it."""
    (tmp_path / "drum.yaml").write_text(ARM, encoding="utf-8")
    design: Any = camgeo.design(camgeo.load(tmp_path / "drum.yaml"))
    assert design.ok
    assert design.motion(math.radians(60)) == pytest.approx(math.radians(15))
    assert design.figures["off-radius"].value == pytest.approx(2.0)
    x, y, z = design.flank([math.radians(60)], 38.3609494216)[0]
    assert [math.degrees(math.atan2(y, x)), z - 40.0] == pytest.approx([67.8660599927, -6.88749461915])


def test_the_library_has_the_exact_drum(tmp_path: Path) -> None:
    (tmp_path / "drum.yaml").write_text(GROOVE, encoding="utf-8")
    design: Any = camgeo.design(camgeo.load(tmp_path / "drum.yaml"))
    assert design.ok
    assert str(design) == "drum: ok"
    assert design.figures["pressure-angle"].value == pytest.approx(45.1482721410)
    assert design.motion(math.radians(60)) == pytest.approx(20.0)
    point = design.flank([math.radians(30)], 50.0)[0]
    assert math.atan2(point[1], point[0]) * 50 == pytest.approx(29.7592556974)
    assert point[2] == pytest.approx(14.29515354681)
    with pytest.raises(camgeo.CallError, match=r"from 37\.5 to 50 mm"):
        design.flank([0.0], 30.0)
    with pytest.raises(camgeo.CallError, match="order 0 to 6"):
        design.motion(0.0, derivative=7)
    (tmp_path / "drum.yaml").write_text(TOP, encoding="utf-8")
    with pytest.raises(camgeo.CallError, match="no upper flank"):
        camgeo.design(camgeo.load(tmp_path / "drum.yaml")).flank([0.0], 40.0, upper=True)  # type: ignore[attr-defined]
    assert "pressure-angle" in design._repr_html_()


REMEDIES = [
    ("limits: {pressure-angle: {at_most: 40}}", "begins at 45.522 mm", ("from: 38", "from: 45.522")),
    ("limits: {velocity: {at_most: 400}}", "rpm of at most 100", ("rpm: 120", "rpm: 100")),
    ("limits: {torque: {at_most: 6}}", "a load of 78.53 percent", ("load: 200", "load: 157")),
    ("limits: {side-thrust: {at_most: 150}}", "a load of 74.61 percent", ("load: 200", "load: 149")),
    ("limits: {contact-pressure: {at_most: 250}}", "a load of", ("load: 200", "load: 110")),
    ("limits: {play: {at_most: 0.03}}", "a clearance of at most 0.023", ("clearance: 0.03", "clearance: 0.0236")),
]


@pytest.mark.thin(3)
@pytest.mark.costly("a drum before and after each remedy")
@pytest.mark.parametrize(("limit", "words", "change"), REMEDIES, ids=lambda _: "")
def test_remedies_hold(limit: str, words: str, change: tuple[str, str], tmp_path: Path) -> None:
    text = changed(
        GROOVE,
        ("  motion", "  drive: {rpm: 120, load: 200, material: steel}\n  motion"),
        ("depth: 12.5", "depth: 12.5, clearance: 0.03"),
        ("export:", f"{limit}\nexport:"),
        ("[stl]", "[csv]"),
    )
    report = exported(tmp_path, text)
    (failed,) = [check for check in report.checks if not check.ok]
    assert words in report.explain(failed)
    assert exported(tmp_path, changed(text, change)).ok


@pytest.mark.thin(6)
@pytest.mark.costly("drums on both sides of each figure that is told")
@pytest.mark.parametrize(
    ("text", "most", "ways"),
    [
        (ARM, 40, 2),
        (LEADING, 30, 1),
        (CONE, 35, 2),
        (changed(CONE, ("taper: axis", "taper: 8")), 40, 2),
        (RIB_ON_ARM, 40, 1),
        (changed(TOP, ("radius: 10,", "radius: 10, taper: axis, at: 44,")), 30, 1),
    ],
    ids=["arm", "leading arm", "apex", "cone", "rib", "end"],
)
def test_a_larger_drum_and_a_longer_motion_are_gentler(text: str, most: float, ways: int, tmp_path: Path) -> None:
    """What is told holds, and a little less does not; a motion is longer as far as rests of the turn are left."""
    text = changed(text, ("export:", f"limits: {{pressure-angle: {{at_most: {most}}}}}\nexport:"), ("[stl]", "[csv]"))
    report = exported(tmp_path, text)
    told = report.explain(next(check for check in report.checks if not check.ok))
    (radius,) = (float(found) for found in re.findall(r"a cam\.radius of at least ([\d.]+) mm", told))
    longer = [float(found) for found in re.findall(r"or a motion ([\d.]+) times as long", told)]
    assert len(longer) == ways - 1

    def steep(text: str) -> float:
        return next(each.value for each in figures_of(design_of(text)) if each.name == "pressure-angle")

    for share, holds in ((1.0, True), (0.995, False)):
        more = share * (radius - float(re.search(r"^  radius: (\d+)", text, re.MULTILINE)[1]))

        def moved(found: re.Match[str], by: float = more) -> str:
            return f"{found[1]}: {float(found[2]) + by!r}"

        farther = re.sub(r"(^  radius|from|at): (\d+)", moved, text, flags=re.MULTILINE)
        assert (steep(farther) <= most) is holds
        for by in longer:
            over = share * by
            slower = text.replace("over: 120", f"over: {120 * over!r}").replace(
                "dwell: 60", f"dwell: {180 - 120 * over!r}"
            )
            assert (steep(slower) <= most) is holds


def test_a_swing_that_no_drum_makes_gentle(tmp_path: Path) -> None:
    text = changed(ARM, ("export:", "limits: {pressure-angle: {at_most: 14}}\nexport:"), ("[stl]", "[csv]"))
    report = exported(tmp_path, text)
    told = report.explain(next(check for check in report.checks if not check.ok))
    assert "a swing that leaves the arm within 14 degrees" in told
    assert "radius" not in told


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        *("cylindrical", "cylindrical-rib", "cylindrical-end", "cylindrical-arm"),
        pytest.param("cylindrical-screw", marks=pytest.mark.slow),  # crossings of six turns are found
    ],
)
def test_starters_are_drums(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", name]) == 0
    (tmp_path / "it.yaml").write_text(capsys.readouterr().out, encoding="utf-8")
    assert camgeo.design(camgeo.load(tmp_path / "it.yaml")).ok


def test_a_tolerance_that_no_number_holds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "drum.yaml").write_text(changed(GROOVE, ("tolerance: 0.02", "tolerance: 0.000005")), encoding="utf-8")
    assert main(["export", str(tmp_path / "drum.yaml"), "--out", str(tmp_path / "out")]) == 2
    message = capsys.readouterr().err
    assert "export.tolerance: an STL" in message
    assert "at least" in message
    assert not (tmp_path / "out").exists()
    assert replace(design_of(GROOVE)).recipe.name == "drum"
