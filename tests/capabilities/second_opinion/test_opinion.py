"""A second opinion: each row catches the fault it is for, sound files of every kind pass, nothing else imports it."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.camfiles import circle_points, solid_triangles, support_points, write_dxf, write_stl
from support.cases import few
from support.meshfiles import in_3mf
from support.places import RECIPES

import camgeo
from camgeo import testing
from camgeo.capabilities.second_opinion import opinion as second_opinion
from camgeo.capabilities.second_opinion.checks import SECOND_OPINIONS
from camgeo.cli.main import main
from camgeo.report.failure import remedy
from kin.contour.contour import Contour
from kin.contour.nearest import nearest
from kin.read.formats import FORMATS

if TYPE_CHECKING:
    from pathlib import Path

COUNT = 720
CAM = """\
cam: {kind: support, fourier: {mean: 25, cos: {3: 2}, sin: {5: 0.3}}}
part: {thickness: 8, bore: 10}
export: {tolerance: 0.002, files: [dxf, stl]}
verify: {angles: 90}
"""
HUB = CAM.replace("bore: 10}", "bore: 10, hub: {diameter: 24, height: 9}, bolts: {count: 3, circle: 38, hole: 3}}")
VERTICES = support_points(COUNT)
DXF = {"ezdxf:audit", "shapely:valid", "shapely:area", "shapely:distance"}
MESH = {row.name for row in SECOND_OPINIONS} - {"ezdxf:audit"}


@pytest.fixture
def recipe(tmp_path: Path) -> Any:
    (tmp_path / "cam.yaml").write_text(CAM)
    return camgeo.load(tmp_path / "cam.yaml")


def triangles(vertices: Any = VERTICES) -> Any:
    return solid_triangles(vertices, 5.0 * circle_points(len(vertices)), 0.0, 8.0)


def write_3mf(path: Path, mesh: Any) -> Path:
    return in_3mf(path, mesh, model_name="3D/3dmodel.model")  # the one name by which trimesh finds it


def rows(report: Any) -> dict[str, Any]:
    names = {row.name for row in SECOND_OPINIONS}
    return {check.name: check for check in report.checks if check.name in names}


def failed(report: Any) -> set[str]:
    return {name for name, check in rows(report).items() if not check.ok}


def asked(recipe: Any, path: Path, **more: Any) -> Any:
    return camgeo.verify(recipe, path, second_opinion=True, **more)


# --- sound files ------------------------------------------------------------------------------------------------------

CONTOURS = [name for name, record in FORMATS.items() if record.contents in {"drawing", "solid"}]
KINDS = (
    "shu-wu",
    "disc-ring",  # needs: milling
    "w-booth",
    "disc-knife-edge",
    "disc-arm-flat",
    "reuleaux",
    "disc-arm",
    "w-figure-9",
)


@pytest.mark.parametrize("name", few(KINDS, 8))
def test_shipped_recipes_pass(name: str) -> None:
    report = camgeo.check(camgeo.load(RECIPES / f"{name}.yaml"), second_opinion=True)
    assert report.ok, failed(report)
    assert {check.file for check in report.checks if check.name == "shapely:distance"} == {
        file.name for file in report.files if file.kind in CONTOURS
    }
    assert set(rows(report)) >= {"shapely:valid"}
    skipped = {entry["what"]: entry["why"] for entry in report["skipped"]}
    assert skipped.get(f"second opinion[{name}.csv]") == "a table has no contour"


@pytest.mark.costly("files in each form, each judged twice")
@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("units", "rotation", "compensation"), [("mm", "ccw", "{kerf: 0.2}"), ("inch", "cw", "{clearance: 0.01}")]
)
def test_units_turns_kerf_and_layers_are_followed(tmp_path: Path, units: str, rotation: str, compensation: str) -> None:
    text = HUB if units == "mm" else "cam: {kind: support, p: 1 + 0.05*cos(3*t)}\npart: {thickness: 0.3, bore: 0.4}\n"
    head = f"units: {units}\nrotation: {rotation}\n"
    inside = compensation[1:-1]
    files = f"export: {{tolerance: 0.002, files: [{{dxf: {{as: arcs, {inside}}}}}, stl, 3mf, svg]}}\n"
    (tmp_path / "cam.yaml").write_text(head + text.partition("export")[0] + files)
    recipe = camgeo.load(tmp_path / "cam.yaml")
    made = camgeo.export(recipe, tmp_path / "out", second_opinion=True)
    assert made.ok, failed(made)
    assert {check.name for check in made.checks if check.file and check.file.endswith(".3mf")} >= MESH
    again = camgeo.verify(recipe, *sorted(made.path.glob("cam*.[ds3]*")), second_opinion=True)
    assert again.ok, failed(again)
    assert rows(again).keys() == DXF | MESH


def test_sound_files_of_others_pass(tmp_path: Path, recipe: Any) -> None:
    report = asked(recipe, write_dxf(tmp_path / "cam.dxf", VERTICES, extra=lambda _: None))
    assert report.ok
    assert set(rows(report)) == DXF
    assert rows(report)["shapely:distance"].limit == pytest.approx(1.2 * 0.002)
    assert rows(report)["shapely:area"].limit == pytest.approx(2.0 * 0.002 * 50.0 * np.pi, rel=1e-4)
    for path in (write_stl(tmp_path / "cam.stl", triangles()), write_3mf(tmp_path / "cam.3mf", triangles())):
        report = asked(recipe, path)
        assert report.ok, failed(report)
        assert set(rows(report)) == MESH


# --- planted faults ---------------------------------------------------------------------------------------------------


def moved(by: float, at: int = 100) -> Any:
    spoilt = VERTICES.copy()
    spoilt[at] *= 1.0 + by / np.hypot(*spoilt[at])
    return spoilt


def crossed() -> Any:
    spoilt = VERTICES.copy()
    spoilt[[100, 101]] = spoilt[[101, 100]]
    return spoilt


@pytest.mark.slow
@pytest.mark.parametrize(
    ("vertices", "caught"),
    [
        (crossed(), {"shapely:valid"}),
        (moved(0.0035), {"shapely:distance"}),
        (moved(-0.0035), {"shapely:distance"}),
        (VERTICES * (1 + 0.006 / 25), {"shapely:distance", "shapely:area"}),
    ],
    ids=["crossing", "vertex out", "vertex in", "too large"],
)
def test_faults_of_outlines(tmp_path: Path, recipe: Any, vertices: Any, caught: set[str]) -> None:
    assert failed(asked(recipe, write_dxf(tmp_path / "cam.dxf", vertices))) >= caught
    named = failed(asked(recipe, write_stl(tmp_path / "cam.stl", triangles(vertices))))
    assert named >= caught


def test_a_shift_that_the_tolerance_takes_passes(tmp_path: Path, recipe: Any) -> None:
    assert not failed(asked(recipe, write_dxf(tmp_path / "cam.dxf", moved(0.0012), extra=lambda _: None)))


def without_line_type(path: Path) -> Path:
    """A sound contour in a line type that the drawing does not define."""
    write_dxf(path, VERTICES, extra=lambda _: None)
    path.write_text(path.read_text().replace("  8\nCUT\n", "  8\nCUT\n  6\nABSENT\n", 1))
    return path


def test_the_auditor_finds_what_the_judge_passes_over(tmp_path: Path, recipe: Any) -> None:
    path = without_line_type(tmp_path / "cam.dxf")
    report = asked(recipe, path)
    assert failed(report) == {"ezdxf:audit"}
    assert "undefined linetype absent" in rows(report)["ezdxf:audit"].detail
    assert camgeo.verify(recipe, path).ok


def flipped(mesh: Any) -> Any:
    spoilt = mesh.copy()
    spoilt[7] = spoilt[7][::-1]
    return spoilt


def with_a_box(mesh: Any) -> Any:
    square = 0.5 * np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    box = solid_triangles(square, 0.5 * square, 0.0, 8.0)
    return np.concatenate([mesh, box + np.array([60.0, 0.0, 0.0])])


@pytest.mark.thin(8)
@pytest.mark.parametrize("write", [write_stl, write_3mf])
@pytest.mark.parametrize(
    ("spoil", "caught"),
    [
        (flipped, {"trimesh:winding", "manifold3d:status"}),
        (lambda mesh: mesh[:, ::-1], {"trimesh:winding", "trimesh:volume"}),
        (lambda mesh: np.delete(mesh, 7, axis=0), {"trimesh:watertight", "manifold3d:status"}),
        (with_a_box, {"trimesh:bodies"}),
        (lambda mesh: mesh * (1.0, 1.0, 1.01), {"trimesh:volume"}),
    ],
    ids=["one flipped", "all flipped", "missing", "extra body", "too thick"],
)
def test_faults_of_meshes(tmp_path: Path, recipe: Any, spoil: Any, caught: set[str], write: Any) -> None:
    path = tmp_path / ("cam.stl" if write is write_stl else "cam.3mf")
    report = asked(recipe, write(path, spoil(triangles())))
    assert failed(report) >= caught
    assert not report.ok


def test_libraries_warn_of_nothing_beside_their_rows(tmp_path: Path, recipe: Any, recwarn: Any) -> None:
    """A body and the same inside out have no volume, by which trimesh divides."""
    mesh = triangles()
    report = asked(recipe, write_stl(tmp_path / "cam.stl", np.concatenate([mesh, mesh[:, ::-1]])))
    assert failed(report) >= {"trimesh:winding"}
    assert not list(recwarn)


def test_what_trimesh_cannot_open_fails(tmp_path: Path, recipe: Any) -> None:
    report = asked(recipe, in_3mf(tmp_path / "cam.3mf", triangles()))  # a sound file, its model by another name
    assert failed(report) == {"trimesh:watertight"}
    assert "trimesh does not read it: StopIteration" in rows(report)["trimesh:watertight"].detail


@pytest.mark.parametrize("text", ["", "solid", "0\nSECTION\n"])
def test_what_cannot_be_read_is_left_out_and_fails_as_ever(tmp_path: Path, recipe: Any, text: str) -> None:
    for name in (f"cam.{kind}" for kind in CONTOURS):
        (tmp_path / name).write_text(text)
        report = asked(recipe, tmp_path / name)
        assert not report.ok
        assert not rows(report)
        assert report["skipped"]


@pytest.mark.slow
def test_an_undercut_leaves_nothing_to_compare_with(tmp_path: Path) -> None:
    (tmp_path / "cam.yaml").write_text("cam: {kind: support, p: 7 + cos(3*t)}\nexport: {files: [dxf]}\n")
    report = asked(camgeo.load(tmp_path / "cam.yaml"), write_dxf(tmp_path / "cam.dxf", VERTICES))
    assert not rows(report)
    assert {"what": "second opinion[cam.dxf]", "why": "a check of the exact contour fails"} in report["skipped"]


def test_many_triangles_are_left_to_the_judge(tmp_path: Path, recipe: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(second_opinion, "MOST_TRIANGLES", 8 * COUNT)
    path = write_stl(tmp_path / "cam.stl", triangles())
    assert set(rows(asked(recipe, path))) == MESH
    monkeypatch.setattr(second_opinion, "MOST_TRIANGLES", 8 * COUNT - 1)
    report = asked(recipe, path)
    assert report.ok
    assert set(rows(report)) == {"shapely:valid", "shapely:area", "shapely:distance"}
    why = f"{8 * COUNT} triangles are more than {8 * COUNT - 1}"
    assert {"what": "trimesh:volume[cam.stl]", "why": why} in report["skipped"]


def test_remedies_help(tmp_path: Path, recipe: Any) -> None:
    path = write_dxf(tmp_path / "cam.dxf", moved(0.01))
    report = asked(recipe, path)
    for check in report["checks"]:
        if check["name"] not in failed(report):
            continue
        text = remedy(check, dict(report), recipe)
        assert "the file that `camgeo export` writes from this recipe" in text
        if check["name"] == "shapely:distance":
            tolerance = float(text.split()[3].rstrip(","))
            assert "shapely:distance" not in failed(asked(recipe, path, tolerance=tolerance))
    made = camgeo.export(recipe, tmp_path / "out")
    assert asked(recipe, made.path / "cam.dxf").ok


# --- polygons ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("tolerance", [1.0, 1e-2, 1e-5])
@pytest.mark.parametrize("bulge", [-1.0, 1e-3, 0.4, 1.0])
def test_arcs_are_cut_within_the_tolerance(tolerance: float, bulge: float) -> None:
    contour = Contour.from_bulges(np.array([[0.0, 0.0], [30.0, 0.0], [0.0, 30.0]]), np.array([0.0, bulge, 0.0]))
    polygon = second_opinion.polygon_of(contour, tolerance)
    _, distance = nearest(contour.as_arcs()[0], 0.5 * (polygon + np.roll(polygon, -1, axis=0)))
    assert distance.max() <= tolerance
    assert distance.max() >= 0.02 * min(tolerance, 30.0 * abs(bulge)) or len(polygon) < 8


def test_too_many_chords_are_refused() -> None:
    contour = Contour.from_bulges(np.array([[0.0, 0.0], [30.0, 0.0]]), np.array([1.0, 1.0]))
    with pytest.raises(ValueError, match="chords are needed, more than 1000000"):
        second_opinion.polygon_of(contour, 1e-14)


# --- where it is asked for --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("library", ["shapely", "trimesh", "manifold3d", "lxml"])
def test_without_a_library_the_command_says_how_to_get_it(
    tmp_path: Path, recipe: Any, library: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_dxf(tmp_path / "cam.dxf", VERTICES)
    monkeypatch.setitem(sys.modules, library, None)
    assert main(["verify", str(recipe.path), str(path), "--second-opinion"]) == 3
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert f"a second opinion needs {library}: pip install '.[check]' in a clone of camgeo" in message
    assert main(["verify", str(recipe.path), str(path)]) == 0


@pytest.mark.slow
def test_the_command_asks_where_it_is_told_to(tmp_path: Path, recipe: Any, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(write_dxf(tmp_path / "cam.dxf", moved(0.0023)))
    assert main(["verify", str(recipe.path), path, "--tolerance", "0.0025", "-v"]) == 0
    assert "shapely" not in capsys.readouterr().out
    assert main(["verify", str(recipe.path), path, "--second-opinion", "--tolerance", "0.001"]) == 1
    assert "shapely:distance (cam.dxf): " in capsys.readouterr().out


@pytest.mark.slow
def test_assertions_take_the_rows_along(tmp_path: Path, recipe: Any) -> None:
    sound = write_dxf(tmp_path / "sound.dxf", VERTICES, extra=lambda _: None)
    testing.assert_contour(recipe, sound, second_opinion=True)
    testing.assert_recipe(recipe, second_opinion=True)
    path = without_line_type(tmp_path / "cam.dxf")
    testing.assert_contour(recipe, path)
    testing.assert_motion(recipe, path)
    for wanted in (testing.assert_contour, testing.assert_motion):
        with pytest.raises(AssertionError, match=r"ezdxf:audit of cam\.dxf"):
            wanted(recipe, path, second_opinion=True)


@pytest.mark.slow
def test_nothing_else_imports_the_libraries(tmp_path: Path, recipe: Any) -> None:
    path = write_stl(tmp_path / "cam.stl", triangles())
    code = (
        "import sys; from camgeo.cli.main import main\n"
        f"assert main(['verify', {str(recipe.path)!r}, {str(path)!r}]) == 0\n"
        "print({'shapely', 'trimesh', 'manifold3d', 'scipy', 'networkx', 'lxml'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.splitlines()[-1:] == ["set()"], done.stderr
