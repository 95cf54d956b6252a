"""All bodies of a mechanism written and judged: hand-made bodies beside a real cam; faults planted."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from support.heavy import lib3mf, trimesh
from support.parts import failures, recipe_of

from camgeo.capabilities.mechanism.assembly import Plate, PrintBody
from camgeo.capabilities.mechanism.parts import make_parts
from camgeo.fit.pieces import ArcSpline, Bound
from camgeo.formats import stl, three_mf
from camgeo.output import pipeline
from camgeo.output.job import Job
from camgeo.recipe.export import FileRequest
from camgeo.recipe.loading import load_text
from camgeo.report.document import Findings, document
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.read.mesh.threemf import read_placed

NONE = Bound(0.0, 0.0)
PART = "{thickness: 8, bore: 10, hub: {diameter: 22, height: 6, side: bottom}, chamfer: 0.5}"
TILT = 0.3


def disc(x, y, r):
    return ArcSpline(np.array([[x + r, y], [x - r, y]]), np.ones(2), NONE)


def box(x0, y0, x1, y1):
    return ArcSpline(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float), np.zeros(4), NONE)


BASE = PrintBody("base", (Plate(box(-40.0, -30.0, 60.0, 30.0), (disc(0.0, 0.0, 5.2),), -5.0, 0.0),), fixed=True)
ROCKER = PrintBody(
    "rocker",
    (Plate(box(-5.0, -5.0, 45.0, 5.0), (disc(0.0, 0.0, 3.0),), 7.0, 11.0), Plate(disc(40.0, 0.0, 4.0), (), 4.0, 7.0)),
    np.array([[50.0, 10.0, TILT], [50.0, 10.0, TILT + 0.2], [50.0, 10.0, TILT]]),
    colour="#335577",
)
CAM = PrintBody(
    "cam",
    (Plate(disc(0.0, 0.0, 25.0), (disc(0.0, 0.0, 5.0),), 7.0, 15.0), Plate(disc(0.0, 0.0, 11.0), (), 1.0, 7.0)),
    np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -math.pi], [0.0, 0.0, -2.0 * math.pi]]),
)
BODIES = [CAM, BASE, ROCKER]


def made(folder, kind, bodies=BODIES, more="", part=PART):
    recipe = recipe_of(part, more=more)
    request = FileRequest(kind, tolerance=0.01, variant="mechanism")
    design = designed(recipe)
    path = folder / request.filename(recipe.name, [request])
    return recipe, design, make_parts(Job.of(recipe, design), request, path, bodies)


def failed(checks):
    return {(check.file, check.name) for check in checks if not check.ok}


@pytest.mark.slow
def test_an_stl_for_each_body_lying_flat(tmp_path):
    recipe, design, (files, checks) = made(tmp_path, "stl")
    assert [file.path.name for file in files] == ["part-cam.stl", "part-base.stl", "part-rocker.stl"]
    assert {path.name for path in tmp_path.iterdir()} == {file.path.name for file in files}
    assert [file.body for file in files] == ["cam", "base", "rocker"]
    assert [file.shows_cam for file in files] == [True, False, False]
    assert failed(checks) == set()
    assert failures(files[0].path, recipe, design) == set()
    for name in ("base", "rocker"):
        names = {check.name for check in checks if check.file == f"part-{name}.stl"}
        assert names == {"watertight", "thickness", "outline"}
        mesh = trimesh.load(tmp_path / f"part-{name}.stl")
        assert mesh.is_watertight
        assert mesh.bounds[0, 2] == 0.0
    # the rocker's pin points up from its face
    rocker = trimesh.load(tmp_path / "part-rocker.stl")
    assert rocker.bounds[1, 2] == 7.0
    assert rocker.section([0, 0, 1], [0, 0, 6.0]).bounds[0, 0] == pytest.approx(36.0, abs=0.01)
    assert trimesh.load(tmp_path / "part-base.stl").volume == pytest.approx(5.0 * (6000.0 - math.pi * 5.2**2), rel=1e-4)


@pytest.mark.costly("a set of bodies, made and judged twice")
def test_one_3mf_for_printing_and_one_in_place(tmp_path):
    recipe, design, (files, checks) = made(tmp_path, "3mf")
    assert [file.path.name for file in files] == ["part-parts.3mf", "part-assembly.3mf"]
    assert [file.body for file in files] == ["cam", "assembly"]
    assert failed(checks) == set()
    for file in files:
        assert failures(file.path, recipe, design) == set()
        model = lib3mf.get_wrapper().CreateModel()
        reader = model.QueryReader("3mf")
        reader.SetStrictModeActive(True)
        reader.ReadFromFile(str(file.path))
        assert reader.GetWarningCount() == 0
        assert model.GetBuildItems().Count() == 3
    laid, standing = ({one.name: one for one in read_placed(file.path)} for file in files)
    for name, one in laid.items():
        assert np.array_equal(one.corners, standing[name].corners)
        assert (one.corners @ one.place[:3] + one.place[3])[..., 2].min() == 0.0
    assert laid["cam"].place[2, 2] == -1.0  # on its disc, the hub upward
    assert np.array_equal(standing["base"].place, [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]])
    # in place the cam's disc is at z = 7 to 15, its hub from 1
    cam = standing["cam"].corners @ standing["cam"].place[:3] + standing["cam"].place[3]
    assert (cam[..., 2].min(), cam[..., 2].max()) == (1.0, 15.0)
    pin = np.array([40.0, 0.0, 5.0]) @ standing["rocker"].place[:3] + standing["rocker"].place[3]
    assert pin == pytest.approx([50.0 + 40.0 * math.cos(TILT), 10.0 + 40.0 * math.sin(TILT), 5.0])


@pytest.mark.slow
def test_counter_clockwise_all_is_mirrored(tmp_path):
    recipe, design, (files, checks) = made(tmp_path, "3mf", more="rotation: ccw\n")
    assert failed(checks) == set()
    assert failures(files[1].path, recipe, design) == set()
    rocker = {one.name: one for one in read_placed(files[1].path)}["rocker"]
    pin = np.array([40.0, 0.0, 5.0]) @ rocker.place[:3] + rocker.place[3]
    assert pin == pytest.approx([50.0 + 40.0 * math.cos(TILT), -10.0 - 40.0 * math.sin(TILT), 5.0])
    assert failed(made(tmp_path, "stl", more="rotation: ccw\n")[2].checks) == set()


def test_the_assembly_moves(tmp_path):
    _, _, (files, checks) = made(tmp_path, "glb")
    assert checks == ()
    (file,) = files
    assert file.path.name == "part-assembly.glb"
    scene = trimesh.load(file.path)
    assert set(scene.geometry) == {"cam", "base", "rocker"}
    assert scene.bounds[:, 1] == pytest.approx([-0.005, 0.015])
    data = file.path.read_bytes()
    document = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    assert {channel["target"]["node"] for channel in document["animations"][0]["channels"]} == {0, 2}


@pytest.mark.thin(4)
@pytest.mark.parametrize("kind", ["stl", "3mf", "glb"])
def test_the_same_bytes_twice(tmp_path, kind):
    found = []
    for folder in (tmp_path / "one", tmp_path / "two"):
        folder.mkdir()
        made(folder, kind, part="{thickness: 8, bore: 10}")
        found.append({path.name: path.read_bytes() for path in folder.iterdir()})
    assert found[0] == found[1]


def test_the_report_tells_whose_a_file_is(tmp_path):
    recipe, _, (files, checks) = made(tmp_path, "stl", part="{thickness: 8, bore: 10}")
    told = document(recipe, Findings(checks, files, (), (), "yoke"))["files"]
    assert [file.get("body") for file in told] == [None, "base", "rocker"]
    assert all(file["geometry_error"] <= 0.01 for file in told)
    assert told[1]["motion"] is None


# --- planted faults ---------------------------------------------------------------------------------------------------


@pytest.fixture
def spoil(monkeypatch):
    """Have one body's mesh changed as it is written."""
    return lambda which, change: spoiling(monkeypatch, which, change)


def spoiling(monkeypatch, which, change):
    stl_writer, mf_writer = stl.write_stl, three_mf.write_3mf

    def write_stl(path, mesh, **said):
        stl_writer(path, change(mesh) if which in path.name else mesh, **said)

    def write_3mf(path, items, **said):
        mf_writer(path, [replace(i, mesh=change(i.mesh)) if i.name == which else i for i in items], **said)

    monkeypatch.setattr(stl, "write_stl", write_stl)
    monkeypatch.setattr(three_mf, "write_3mf", write_3mf)


def without_a_triangle(mesh):
    return replace(mesh, triangles=mesh.triangles[1:])


def wider(mesh):
    return replace(mesh, points=mesh.points * np.array([1.001, 1.0, 1.0]))


@pytest.mark.thin(8)
@pytest.mark.parametrize(
    "fault",
    [
        ("base", without_a_triangle, "watertight"),
        ("rocker", wider, "outline"),
        ("cam", wider, "contour"),
        ("cam", without_a_triangle, "watertight"),
    ],
)
@pytest.mark.parametrize("kind", ["stl", "3mf"])
def test_a_spoilt_body_is_caught_in_its_own_file(tmp_path, spoil, kind, fault):
    which, change, caught = fault
    spoil(which, change)
    _, _, (_, checks) = made(tmp_path, kind, part="{thickness: 8, bore: 10}")
    found = failed(checks)
    names = {f"part-{which}.stl"} if kind == "stl" else {"part-parts.3mf", "part-assembly.3mf"}
    assert {(name, caught) for name in names} <= found
    assert {file for file, _ in found} == names


def test_a_body_that_falls_apart_is_an_error_at_the_part(tmp_path):
    apart = replace(ROCKER, plates=(ROCKER.plates[0], Plate(disc(90.0, 0.0, 4.0), (), 4.0, 7.0)))
    with pytest.raises(RecipeErrors, match="mechanism: rocker: its plates make 2 separate bodies"):
        made(tmp_path, "stl", [CAM, BASE, apart], part="{thickness: 8, bore: 10}")


def test_a_body_that_has_no_mesh_is_named_before_the_set_is_turned(tmp_path, monkeypatch):
    def turned(_):
        raise AssertionError("the set was turned first")

    monkeypatch.setattr("camgeo.capabilities.mechanism.making.collision_checks", turned)
    text = """cam: {kind: double-roller, ratio: 4/3, arm: 10000, roller_radius: 8, delta: {cos: {1: 600}}}
part: {thickness: 8, bore: 10}
mechanism: {}
export: {tolerance: 0.01, files: [{3mf: {parts: all}}]}
"""
    with pytest.raises(RecipeErrors, match=r"mechanism: arm: a triangle of the solid has no area in nine decimals"):
        pipeline.export(load_text(text, "cam.yaml"), tmp_path)
