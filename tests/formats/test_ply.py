"""PLY files: written and read in double precision, by a second reader, planted faults; foreign and damaged ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.heavy import trimesh
from support.meshfiles import BORE, HEIGHT, OUTER, N, ring
from support.parts import failures, files_of, recipe_of

import camgeo
from camgeo.cli.main import main
from kin.contour.contour import Contour
from kin.read.errors import ReadError
from kin.read.files import read_meshes, read_solid

if TYPE_CHECKING:
    from pathlib import Path

PART = (
    "{thickness: 8, bore: 12, keyway: din6885, hub: {diameter: 30, height: 8}, chamfer: 0.4, set_screw: {diameter: 3}}"
)
CAM = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 12}\n"
HEADER = "ply\nformat {} 1.0\n{}element vertex {}\n{}element face {}\n{}end_header\n"
XYZ = "property double x\nproperty double y\nproperty double z\n"
LIST = "property list uchar int vertex_indices\n"


def text(path: Path, triangles, *, comment: str = "", faces: str = LIST, more: str = "") -> Path:
    """A PLY in text form, each corner a vertex of its own."""
    points = triangles.reshape(-1, 3)
    rows = [" ".join(repr(float(c)) for c in point) for point in points]
    rows += [f"3 {3 * k} {3 * k + 1} {3 * k + 2}" for k in range(len(triangles))]
    head = HEADER.format("ascii", comment, len(points), XYZ, len(triangles), faces)
    path.write_text(head + "\n".join(rows) + "\n" + more)
    return path


def binary(path: Path, triangles, order: str = "<", kind: str = "f8") -> Path:
    """The same in binary form, with a colour for each face."""
    points = triangles.reshape(-1, 3)
    faces = np.zeros(len(triangles), np.dtype([("n", "u1"), ("v", f"{order}i4", 3), ("red", "u1")]))
    faces["n"], faces["v"] = 3, np.arange(len(points)).reshape(-1, 3)
    name = {"f8": "double", "f4": "float"}[kind]
    xyz = XYZ.replace("double", name)
    word = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = HEADER.format(word, "comment by hand\n", len(points), xyz, len(faces), LIST + "property uchar red\n")
    path.write_bytes(head.encode() + points.astype(order + kind).tobytes() + faces.tobytes())
    return path


@pytest.mark.slow
def test_a_part_with_all_features_is_right(tmp_path):
    recipe = recipe_of(PART, files="ply")
    design, made = files_of(recipe, tmp_path)
    path, checks = made["ply"]
    assert {"watertight", "thickness", "contour", "motion", "bore", "volume", "hub", "chamfer"} <= set(checks)
    assert failures(path, recipe, design) == set()
    read = trimesh.load_mesh(path)
    assert read.is_watertight
    assert read.is_winding_consistent
    assert read.volume == pytest.approx(read_solid(path).volume, rel=1e-9)


@pytest.mark.slow
def test_numbers_are_those_of_the_mesh_to_the_bit(tmp_path: Path) -> None:
    """Of a tenth of a micrometre, which single precision does not hold at 25 mm."""
    report = camgeo.export(camgeo.load(f"{CAM}export: {{tolerance: 1.0e-7, files: [ply]}}\n"), tmp_path)
    assert report.ok
    (file,) = report.files
    assert 0.9e-7 < file.geometry_error <= 1e-7
    (mesh,) = read_meshes(file.path)
    assert (mesh.corners != mesh.corners.astype(np.float32)).any()
    with pytest.raises(camgeo.RecipeErrors, match="an STL of a contour"):
        camgeo.export(camgeo.load(f"{CAM}export: {{tolerance: 1.0e-7, files: [stl]}}\n"), tmp_path)


def test_the_same_bytes_twice(tmp_path: Path) -> None:
    recipe = camgeo.load(f"name: cam\nabout: of two\n{CAM}export: {{files: [ply]}}\n")
    once, again = (camgeo.export(recipe, tmp_path / name).files[0].path.read_bytes() for name in "ab")
    assert once == again
    head = once.partition(b"end_header\n")[0].decode("ascii").splitlines()
    assert head[:3] == ["ply", "format binary_little_endian 1.0", "comment camgeo: in mm, z upwards. cam"]


@pytest.mark.slow
def test_kerf_inches_and_a_file_for_each_body(tmp_path: Path) -> None:
    recipe = camgeo.load(
        "name: cam\nunits: inch\ncam: {kind: support, p: 1 + 0.08*cos(3*t)}\npart: {thickness: 0.3, bore: 0.5}\n"
        "export: {tolerance: 0.0004, files: [{ply: {units: inch}}, {ply: {units: inch, kerf: 0.01}}]}\n"
    )
    report = camgeo.export(recipe, tmp_path)
    assert report.ok
    nominal, cut = (trimesh.load_mesh(file.path) for file in report.files)
    assert np.ptp(cut.vertices[:, 0]) - np.ptp(nominal.vertices[:, 0]) == pytest.approx(0.01, abs=1e-6)
    assert np.ptp(nominal.vertices[:, 2]) == pytest.approx(0.3, abs=1e-12)
    # its unit is that of the recipe's file of this name, or is given
    assert camgeo.verify(recipe, report.files[0].path).ok
    foreign = tmp_path / "other.ply"
    foreign.write_bytes(report.files[0].path.read_bytes())
    assert not camgeo.verify(recipe, foreign).ok
    assert camgeo.verify(recipe, foreign, units="inch").ok


# needs: mechanism
@pytest.mark.slow
def test_all_bodies_of_a_mechanism(tmp_path: Path) -> None:
    recipe = camgeo.load("recipes/print-roller.yaml").replace("export.files", [{"ply": {"parts": "all"}}])
    report = camgeo.export(recipe, tmp_path)
    assert report.ok
    names = {file.path.name for file in report.files}
    assert {"print-roller-cam.ply", "print-roller-shaft.ply", "print-roller-roller.ply"} <= names


def test_a_file_of_another_program(tmp_path: Path) -> None:
    """Trimesh writes single precision, in either form."""
    recipe = camgeo.load(f"{CAM}export: {{files: [stl]}}\n")
    stl = camgeo.export(recipe, tmp_path).files[0].path
    for encoding in ("binary", "ascii"):
        path = tmp_path / f"{encoding}.ply"
        path.write_bytes(trimesh.load_mesh(stl).export(file_type="ply", encoding=encoding))
        assert camgeo.verify(recipe, path, units="mm").ok, encoding


def test_planted_faults_are_caught(tmp_path):
    recipe = recipe_of("{thickness: 8, bore: 12}", files="ply")
    design, made = files_of(recipe, tmp_path)
    (mesh,) = read_meshes(made["ply"][0])
    assert failures(binary(tmp_path / "same.ply", mesh.corners), recipe, design) == set()
    low = mesh.corners[:, :, 2] < 4.0
    shifted, leaning = mesh.corners.copy(), mesh.corners.copy()
    corner = mesh.corners[np.argmax(mesh.corners[:, :, 0].max(axis=1))]
    place = corner[np.argmax(corner[:, 0])][:2]
    shifted[(shifted[:, :, :2] == place).all(axis=2), 0] += 0.02
    leaning[low, 0] += 0.02
    turned = mesh.corners.copy()
    turned[5] = turned[5][::-1]
    planted = {
        "vertex": (shifted, {"contour"}),
        "leaning": (leaning, {"thickness"}),
        "hole": (mesh.corners[1:], {"watertight"}),
        "turned": (turned, {"watertight"}),
        "inches": (mesh.corners / 25.4, {"contour", "thickness"}),
    }
    for name, (corners, least) in planted.items():
        assert failures(binary(tmp_path / f"{name}.ply", corners), recipe, design) >= least, name


@pytest.mark.thin(2)
@pytest.mark.parametrize("form", ["text", "<f8", "<f4", ">f8"])
def test_every_form_is_read(tmp_path: Path, form: str) -> None:
    path = tmp_path / "ring.ply"
    solid = read_solid(text(path, ring()) if form == "text" else binary(path, ring(), form[0], form[1:]))
    exact = (Contour.from_vertices(OUTER).area - Contour.from_vertices(BORE).area) * HEIGHT
    assert solid.volume == pytest.approx(exact, rel=1e-14 if form[1:] != "f4" else 1e-6)
    assert (solid.triangles, solid.faults, len(solid.contour)) == (8 * N, (), N)


SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
WRONG = {
    "no ply": (b"solid cam\n", "syntax", "not a PLY file"),
    "no end": (b"ply\nformat ascii 1.0\n", "truncated", "no line end_header"),
    "format": (b"ply\nformat ascii 2.0\nend_header\n", "syntax", "line 2 of the header"),
    "element": (
        HEADER.format("ascii", "", 3, XYZ, 1, LIST).replace("face 1", "edge 1").encode(),
        "unsupported",
        "edge",
    ),
    "flat": (HEADER.format("ascii", "", 3, XYZ[:-18], 1, LIST).encode(), "unsupported", "no x, y and z"),
    "none": (HEADER.format("ascii", "", 0, XYZ, 0, LIST).encode(), "empty", "no triangles"),
    "quads": (
        (HEADER.format("ascii", "", 4, XYZ, 1, LIST) + SQUARE + "4 0 1 2 3\n").encode(),
        "unsupported",
        "face 1 has 4 corners; triangles alone are read",
    ),
    "corner": (
        (HEADER.format("ascii", "", 4, XYZ, 1, LIST) + SQUARE + "3 0 1 9\n").encode(),
        "syntax",
        "none of the 4",
    ),
    "word": ((HEADER.format("ascii", "", 4, XYZ, 1, LIST) + SQUARE + "3 0 1_0 2\n").encode(), "syntax", "'1_0' is"),
    "many": (HEADER.format("binary_little_endian", "", 10**30, XYZ, 1, LIST).encode(), "truncated", "vertices take"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_not_read_is_refused_with_the_place(tmp_path: Path, name: str) -> None:
    path = tmp_path / "cam.ply"
    raw, reason, message = WRONG[name]
    path.write_bytes(raw)
    with pytest.raises(ReadError, match=message) as caught:
        read_solid(path)
    assert caught.value.reason == reason


@pytest.mark.parametrize("form", ["text", "binary"])
def test_a_file_that_is_cut_short_or_goes_on_is_refused(tmp_path: Path, form: str) -> None:
    path = {"text": text, "binary": binary}[form](tmp_path / "cam.ply", ring())
    raw = path.read_bytes()
    for share in (0.2, 0.5, 0.95):
        path.write_bytes(raw[: int(share * len(raw))])
        with pytest.raises(ReadError) as caught:
            read_solid(path)
        assert caught.value.reason in {"truncated", "syntax"}
    path.write_bytes(raw + b"1 2 3 4 ")
    with pytest.raises(ReadError, match="follow"):
        read_solid(path)


def test_the_command_says_what_is_wrong_with_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recipe, path = tmp_path / "cam.yaml", tmp_path / "cam.ply"
    recipe.write_text(f"{CAM}export: {{files: [ply]}}\n")
    path.write_bytes(b"ply\nformat ascii 1.0\n")
    assert main(["verify", str(recipe), str(path)]) == 1
    assert "the header does not end" in capsys.readouterr().out
