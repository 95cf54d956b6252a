"""Binary glTF: by trimesh as second reader and by the format's own rules; motion at the shaft's angles."""

import json
import math

import numpy as np
import pytest
from support.heavy import trimesh
from support.parts import recipe_of

from camgeo.cli.main import main
from camgeo.files.mesh import Mesh
from camgeo.formats.glb import PERIOD, Actor, make_view, write_glb
from camgeo.output.job import Job
from camgeo.recipe.export import FileRequest
from camgeo.synthesis.design import designed
from kin.read.formats import FORMATS

TETRAHEDRON = Mesh(
    np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 30.0]]),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]),
)
REST = np.array([[5.0, 7.0, 0.5 * math.pi]])
STEPS = 12
PHI = 2.0 * np.pi * np.arange(STEPS + 1) / STEPS
MOVING = np.column_stack((3.0 * np.cos(PHI), np.sin(PHI), -PHI))


def taken_apart(path):
    """The document and the arrays of its accessors, by the rules of the format."""
    data = path.read_bytes()
    assert data[:4] == b"glTF"
    version, length = np.frombuffer(data, "<u4", 2, 4).tolist()
    assert (version, length) == (2, len(data))
    size = int.from_bytes(data[12:16], "little")
    assert data[16:20] == b"JSON"
    assert size % 4 == 0
    document = json.loads(data[20 : 20 + size])
    rest = data[20 + size :]
    assert rest[4:8] == b"BIN\0"
    binary = rest[8:]
    assert int.from_bytes(rest[:4], "little") == len(binary)
    assert document["buffers"] == [{"byteLength": len(binary)}]
    arrays = []
    for accessor in document["accessors"]:
        view = document["bufferViews"][accessor["bufferView"]]
        assert view["byteOffset"] % 4 == 0
        wide = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        assert view["byteLength"] == 4 * wide * accessor["count"]
        array = np.frombuffer(binary, kind, wide * accessor["count"], view["byteOffset"]).reshape(-1, wide)
        if "min" in accessor:
            assert array.min(axis=0).tolist() == accessor["min"]
            assert array.max(axis=0).tolist() == accessor["max"]
        arrays.append(array)
    return document, arrays


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.glb"
    actors = [Actor("base", TETRAHEDRON, REST, "#ff8000"), Actor("follower", TETRAHEDRON, MOVING, "#000000")]
    write_glb(path, actors, title='a "title" é')
    return path


def test_trimesh_reads_bodies_in_their_places(scene):
    read = trimesh.load(scene)
    assert set(read.geometry) == {"base", "follower"}
    for mesh in read.geometry.values():
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(1e-9 * 1000.0, rel=1e-6)  # 10 x 20 x 30 / 6 mm^3
    # z stands upright along y, and y runs to the front, which is -z
    place, _ = read.graph["base"]
    tip = place @ [*read.geometry["base"].vertices[np.argmax(read.geometry["base"].vertices[:, 1])], 1.0]
    assert tip[:3] == pytest.approx([0.005, 0.030, -0.007], abs=1e-7)
    # (10, 0, 0) a quarter of a turn on is (0, 10, 0)
    corner = place @ [0.010, 0.0, 0.0, 1.0]
    assert corner[:3] == pytest.approx([0.005, 0.0, -0.017], abs=1e-7)


def test_motion_is_that_of_the_pose(scene):
    document, arrays = taken_apart(scene)
    (animation,) = document["animations"]
    assert {channel["target"]["node"] for channel in animation["channels"]} == {1}
    found = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        assert sampler["interpolation"] == "LINEAR"
        times = arrays[sampler["input"]][:, 0]
        assert times == pytest.approx(np.linspace(0.0, PERIOD, STEPS + 1))
        found[channel["target"]["path"]] = arrays[sampler["output"]].astype(float)
    x, y, z = 1000.0 * found["translation"].T
    assert np.allclose(x, MOVING[:, 0], atol=1e-5)
    assert np.allclose(-z, MOVING[:, 1], atol=1e-5)
    assert (y == 0.0).all()
    turn = found["rotation"]
    assert np.allclose(np.sum(turn * turn, axis=1), 1.0, atol=1e-6)
    assert (turn[:, [0, 2]] == 0.0).all()
    # neighbours are on the same side, so that a viewer does not turn the long way round
    assert (np.sum(turn[1:] * turn[:-1], axis=1) > 0.9).all()
    angle = 2.0 * np.unwrap(np.arctan2(turn[:, 1], turn[:, 3]), period=2.0 * math.pi)
    assert np.allclose(angle, MOVING[:, 2], atol=1e-6)
    assert document["nodes"][1]["translation"] == pytest.approx([0.003, 0.0, 0.0])


def test_names_colours_and_title(scene):
    document, _ = taken_apart(scene)
    assert document["scenes"][0]["name"] == 'a "title" é'
    assert [node["name"] for node in document["nodes"]] == ["base", "follower"]
    orange = document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"]
    assert orange == [1.0, 0.2159, 0.0, 1.0]  # of sRGB 1, 0.502, 0


def test_nothing_moves_without_poses(tmp_path):
    path = tmp_path / "rest.glb"
    write_glb(path, [Actor("base", TETRAHEDRON, REST, "#ffffff")], title="rest")
    document, _ = taken_apart(path)
    assert "animations" not in document
    assert trimesh.load(path).geometry["base"].is_watertight


@pytest.mark.parametrize(("more", "sense"), [("", -1.0), ("rotation: ccw\n", 1.0)])
def test_the_cam_turns_once_the_way_its_shaft_does(tmp_path, more, sense):
    recipe = recipe_of("{thickness: 8, bore: 10}", more=more)
    path = tmp_path / "cam.glb"
    make_view(Job.of(recipe, designed(recipe)), FileRequest("glb", tolerance=0.01), path)
    document, arrays = taken_apart(path)
    sampler = next(
        document["animations"][0]["samplers"][channel["sampler"]]
        for channel in document["animations"][0]["channels"]
        if channel["target"]["path"] == "rotation"
    )
    turn = arrays[sampler["output"]].astype(float)
    angle = 2.0 * np.unwrap(np.arctan2(turn[:, 1], turn[:, 3]), period=2.0 * math.pi)
    assert angle[-1] - angle[0] == pytest.approx(sense * 2.0 * math.pi, abs=1e-5)
    read = trimesh.load(path).geometry["cam"]
    assert read.is_watertight
    # mirrored, the shaft at 3, 2 of the formula's axes stands on the other side of the x axis
    assert np.sign(-read.bounds[:, 2].mean()) == sense
    assert read.bounds[:, 1] == pytest.approx([0.0, 0.008])


def test_export_is_not_judged_and_the_same_twice(tmp_path, capsys):
    recipe = tmp_path / "disc.yaml"
    text = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 10}\nverify: {angles: 72}\n"
    recipe.write_text(f"{text}export: {{files: [glb]}}\n")
    found = []
    for folder in ("one", "two"):
        assert main(["export", str(recipe), "--out", str(tmp_path / folder)]) == 0
        found.append((tmp_path / folder / "disc" / "disc.glb").read_bytes())
    assert found[0] == found[1]
    assert main(["verify", str(recipe), str(tmp_path / "one" / "disc" / "disc.glb")]) == 2
    judged = ", ".join(record.suffixes[0] for record in FORMATS.values())
    assert f"disc.glb: none of {judged}" in capsys.readouterr().err
    recipe.write_text("cam: {kind: support, p: 25 + 2*cos(3*t)}\nexport: {files: [glb]}\n")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 2
    assert "glb needs a thickness" in capsys.readouterr().err
