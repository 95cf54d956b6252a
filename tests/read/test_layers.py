"""Metal between the sections that are looked at: bumps, dents, fins and barrels pass no check of any solid.

Holds: kin.read.checks.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.heavy import trimesh
from support.kernel import kernel
from support.meshfiles import binary, bumped, ring, triangles_in

import camgeo
from kin.numeric.lengths import shown
from kin.read.files import read_solid
from kin.read.layers import Lean, between_sections
from kin.read.mesh.mesh import welded
from kin.read.mesh.prism import walls

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

DISC = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
TRACK  motion: [{rise: 12, over: 60, law: cycloidal}, {dwell: 30}, {return: 12, over: 90, law: cycloidal}, {dwell: 180}]
part: {PART}
export: {tolerance: FIT, files: [FILES]}
verify: {angles: 90}
"""
FIT, TOLERANCE = "0.0099", "0.01"  # mm; files are judged by the second, so that rounding does not add up to a fault

PARTS = {
    "plain": ("thickness: 10, bore: 12", ""),
    "hub": ("thickness: 10, bore: 12, hub: {diameter: 30, height: 8}", ""),
    "chamfer": ("thickness: 10, bore: 12, chamfer: 0.5", ""),
    "screw": (
        "thickness: 10, bore: 12, hub: {diameter: 30, height: 8}, set_screw: {diameter: 3.4, at: 90}, chamfer: 0.5",
        "",
    ),
    "groove": ("thickness: 14, bore: 12, outer: 160", "  track: {groove: {clearance: 0.03, depth: 8}}\n"),
    "camshaft": ("thickness: 10", ""),  # needs: camshaft
}
WALLS = {
    "plain": (0.0, 10.0),
    "hub": (0.0, 10.0),
    "chamfer": (0.5, 9.5),
    "screw": (0.5, 9.5),
    "groove": (6.0, 14.0),
    "camshaft": (20.0, 30.0),
}


def exported(kind: str, folder: Path, files: str = "stl") -> tuple[Path, Path]:
    """A recipe of that kind of part, and the solid that camgeo makes of it."""
    part, track = PARTS[kind]
    text = DISC.replace("PART", part).replace("TRACK", track).replace("FILES", files).replace("FIT", FIT)
    recipe = folder / "part.yaml"
    recipe.write_text(text)
    if kind == "camshaft":
        recipe = folder / "shaft.yaml"
        lobes = "camshaft:\n  shaft: {diameter: 30, to: 60, bore: 8}\n  lobes: [{recipe: part.yaml, at: 20, z: 20}]\n"
        recipe.write_text(f"{lobes}export: {{tolerance: {FIT}, files: [{files}]}}\nverify: {{angles: 90}}\n")
    report = camgeo.export(recipe, folder / "out")
    assert report.ok
    assert report.path is not None
    recipe.write_text(recipe.read_text().replace(FIT, TOLERANCE))
    return recipe, report.path / f"{recipe.stem}.{files}"


@pytest.fixture(scope="module", params=PARTS)
def solid(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path, Path]:
    return (request.param, *exported(request.param, tmp_path_factory.mktemp(request.param)))


def failing(recipe: Path, path: Path) -> dict[str, str]:
    report = camgeo.verify(recipe, path)
    return {check.name: check.detail for check in report.checks if not check.ok}


@pytest.mark.thin(16)
@pytest.mark.parametrize("out", [2.0, 0.2, -0.2])
@pytest.mark.parametrize("share", [(0.06, 0.44), (0.56, 0.94)])
def test_a_bump_or_a_dent_between_sections(
    solid: tuple[str, Path, Path], tmp_path: Path, out: float, share: tuple[float, float]
) -> None:
    """Half a cubic millimetre of metal, which no volume tells, where no section is looked at."""
    kind, recipe, path = solid
    low, high = WALLS[kind]
    span = (low + share[0] * (high - low), low + share[1] * (high - low))
    triangles = bumped(triangles_in(path), (low, high), span, angle=4.2, out=out)
    mesh = trimesh.Trimesh(*trimesh.triangles.to_kwargs(triangles).values())
    mesh.merge_vertices()
    assert mesh.is_watertight
    found = failing(recipe, binary(tmp_path / "part.stl", triangles))
    assert "thickness" in found
    assert "volume" not in found
    assert "lean" in found["thickness"] or "sections at different heights differ" in found["thickness"]


def moved(path: Path, target: Path, move: Callable[[np.ndarray], np.ndarray]) -> Path:
    """The same mesh with its vertices (n, 3) elsewhere."""
    mesh = trimesh.load(path)
    mesh.vertices = move(mesh.vertices.copy())
    mesh.export(target)
    return target


@pytest.mark.thin(12)
@pytest.mark.parametrize("amount", [1e-30, 1e-9, 5e-6, 1e-4])
def test_noise_in_height_is_rounding_for_every_kind(
    solid: tuple[str, Path, Path], tmp_path: Path, amount: float
) -> None:
    """Faces of single precision, 1e-5 mm at 50 mm, are level with it, and it is counted; faces of 1e-4 mm are not."""
    _, recipe, path = solid

    def noisy(vertices: np.ndarray) -> np.ndarray:
        shifts = np.random.default_rng(0).uniform(-amount, amount, len(vertices))
        return vertices + np.column_stack([np.zeros((len(vertices), 2)), shifts])

    spoilt = moved(path, tmp_path / "cam.stl", noisy)
    assert ("thickness" in failing(recipe, spoilt)) is (amount > 1e-5)
    if amount == 5e-6:
        quiet, noise = (
            next(check.value for check in camgeo.verify(recipe, one).checks if check.name == "thickness")
            for one in (path, spoilt)
        )
        assert 0.9 * amount < noise - quiet < 4.0 * amount


@pytest.mark.thin(12)
@pytest.mark.parametrize(("amount", "turned"), [(1e-4, False), (0.0, True)])
def test_leans_of_all_walls_and_turns_there_and_back(
    solid: tuple[str, Path, Path], tmp_path: Path, amount: float, turned: bool
) -> None:
    """What is turned onto its side and back in single precision stands upright; what is sheared does not."""
    _, recipe, path = solid

    def there_and_back(vertices: np.ndarray) -> np.ndarray:
        turn = trimesh.transformations.euler_matrix(0.7, 0.3, 0.0)[:3, :3]
        on_its_side = (vertices @ turn.T).astype(np.float32).astype(float)
        return on_its_side @ turn

    def sheared(vertices: np.ndarray) -> np.ndarray:
        return vertices + np.outer(vertices[:, 2], [amount / vertices[:, 2].max(), 0.0, 0.0])

    spoilt = moved(path, tmp_path / "cam.stl", there_and_back if turned else sheared)
    assert (not failing(recipe, spoilt)) is turned


def leaning(path: Path, target: Path, top: float, amount: float, *, single: bool) -> Path:
    """Its upper edge drawn out at one vertex of the contour, or all of it sheared by as much."""

    def lean(vertices: np.ndarray) -> np.ndarray:
        x, y, z = vertices.T
        if not single:
            return vertices + np.outer((z - z.min()) / np.ptp(z), [amount, 0.0, 0.0])
        at = np.flatnonzero((np.abs(z - top) < 1e-6) & (np.hypot(x, y) > 20.0))[0]
        vertices[at, :2] *= 1.0 + amount / np.hypot(x[at], y[at])
        return vertices

    return moved(path, target, lean)


@pytest.mark.thin(6)
@pytest.mark.parametrize(
    ("amount", "single"),
    [
        (1e-4, True),
        *(
            pytest.param(*case, marks=pytest.mark.slow)
            for case in ((2e-5, True), (2e-5, False), (1e-3, True), (1e-3, False))
        ),
    ],
)
def test_leans_of_single_walls_and_of_all(
    solid: tuple[str, Path, Path], tmp_path: Path, amount: float, single: bool
) -> None:
    """On every kind the same bound, that of single precision: 2e-5 mm pass, 1e-4 mm are named as a lean."""
    kind, recipe, path = solid
    found = failing(recipe, leaning(path, tmp_path / "cam.stl", WALLS[kind][1], amount, single=single))
    assert bool(found) is (amount > 3e-5)
    assert not found or {"thickness", "chamfer", "set-screw"} & set(found)


LEANS = [(2e-5, True), (2e-5, False), (1e-4, True), (1e-4, False)]


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["ply", "3mf"])
@pytest.mark.parametrize(("amount", "single"), LEANS)
def test_leans_in_other_formats(
    solid: tuple[str, Path, Path], tmp_path: Path, suffix: str, amount: float, single: bool
) -> None:
    """The bound is that of a format's own numbers: single precision in a PLY, decimals of a 3MF that are finer."""
    kind, recipe, path = solid
    found = failing(recipe, leaning(path, tmp_path / f"lean.{suffix}", WALLS[kind][1], amount, single=single))
    assert bool(found) is (amount > 3e-5 or suffix == "3mf")
    assert not found or {"thickness", "chamfer", "set-screw"} & set(found)


@pytest.mark.slow
@pytest.mark.parametrize(("amount", "single"), [(0.0, False), *LEANS])
def test_leans_in_a_glb_that_is_turned_z_up(
    solid: tuple[str, Path, Path], tmp_path: Path, amount: float, single: bool
) -> None:
    """A glTF is in metres with y upward, in single precision; what another program makes of it is judged as an STL."""
    kind, recipe, path = solid
    leans = trimesh.load(
        leaning(path, tmp_path / "lean.ply", WALLS[kind][1], amount, single=single) if amount else path
    )
    x, y, z = leans.vertices.T
    leans.vertices = 1e-3 * np.column_stack([x, z, -y])
    leans.export(tmp_path / "lean.glb")
    turned = trimesh.load(tmp_path / "lean.glb").to_geometry()
    x, z, y = 1e3 * turned.vertices.T
    turned.vertices = np.column_stack([x, -y, z])
    turned.export(tmp_path / "lean.stl")
    found = failing(recipe, tmp_path / "lean.stl")
    assert bool(found) is (amount > 3e-5)
    assert not found or {"thickness", "chamfer", "set-screw"} & set(found)


@pytest.mark.slow
@pytest.mark.parametrize("out", [0.0, 0.05])
def test_a_chamfer_with_vertices_on_its_way(tmp_path: Path, out: float) -> None:
    """As remeshing leaves it, every triangle cut in four; and one vertex halfway up drawn out."""
    recipe, path = exported("chamfer", tmp_path)
    mesh = trimesh.load(path).subdivide()
    vertices = mesh.vertices.copy()
    halfway = np.flatnonzero(np.abs(vertices[:, 2] - 9.75) < 1e-6)
    vertices[halfway[0], :2] *= 1.0 + out / 40.0
    mesh.vertices = vertices
    mesh.export(tmp_path / "fine.stl")
    assert set(failing(recipe, tmp_path / "fine.stl")) == ({"chamfer"} if out else set())


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["hub", "groove", "camshaft"])
def test_a_fin_thinner_than_the_tolerance(tmp_path: Path, kind: str) -> None:
    """A sheet of 8 micrometres round the top of the wall, 4 mm wide: its faces are where they may be."""
    recipe, path = exported(kind, tmp_path)
    high = WALLS[kind][1]
    body = trimesh.load(path)
    sheet = trimesh.creation.cylinder(75.0, 0.008, sections=64)
    if kind == "groove":
        sheet = trimesh.creation.cylinder(5.0, 0.008, sections=64)
        sheet.apply_translation([0.0, -40.0, 0.0])
    sheet.apply_translation([0.0, 0.0, high - 0.004])
    hole = trimesh.creation.cylinder(10.0, 1.0, sections=64)
    hole.apply_translation([0.0, 0.0, high])
    if kind != "groove":
        sheet = trimesh.boolean.difference([sheet, hole])
    spoilt = tmp_path / f"{path.stem}.stl"
    trimesh.boolean.union([body, sheet]).export(spoilt)
    found = failing(recipe, spoilt)
    assert "where one is expected" in found["thickness"]


@pytest.mark.slow
@kernel
@pytest.mark.parametrize(("kind", "form"), [("hub", "cone"), ("camshaft", "cone"), ("camshaft", "box")])
def test_a_bump_on_a_step_file(tmp_path: Path, kind: str, form: str) -> None:
    """A small cone or box joined to the wall by Open CASCADE, between the sections."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Reader, STEPControl_Writer

    recipe, path = exported(kind, tmp_path, "step")
    assert not failing(recipe, path)
    low, high = WALLS[kind]
    reader = STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    foot = low + 0.06 * (high - low)
    if form == "cone":
        axis = gp_Ax2(gp_Pnt(-40.0, 0.5, foot), gp_Dir(0, 0, 1))
        bump = BRepPrimAPI_MakeCone(axis, 1.0, 0.5, 0.3 * (high - low)).Shape()
    else:
        bump = BRepPrimAPI_MakeBox(gp_Pnt(0.5, -39.5, foot), gp_Pnt(1.0, -40.5, low + 0.4 * (high - low))).Shape()
    writer = STEPControl_Writer()
    writer.Transfer(BRepAlgoAPI_Fuse(reader.OneShape(), bump).Shape(), STEPControl_AsIs)
    spoilt = tmp_path / f"spoilt{path.suffix}"
    writer.Write(str(spoilt))
    found = failing(recipe, spoilt)
    assert set(found) == {"thickness"}
    assert ("lean" if form == "cone" else "where none is expected") in found["thickness"]


def stepped(path: Path, turn: float = 0.0) -> Path:
    """A ring with a smaller one on it; the upper one's top turned by `turn`, rad, against its foot."""
    outer, inner, bore = (radius * np.array(_circle()) for radius in (20.0, 12.0, 5.0))
    whole = trimesh.boolean.union(
        [trimesh.Trimesh(*_kwargs(ring(outer, bore, 0.0, 4.0))), trimesh.Trimesh(*_kwargs(ring(inner, bore, 2.0, 9.0)))]
    )
    points = whole.vertices.copy()
    c, s = np.cos(turn), np.sin(turn)
    top = points[:, 2] == 9.0
    points[top, :2] = points[top, :2] @ np.array([[c, s], [-s, c]])
    whole.vertices = points
    whole.export(path)
    return path


def _circle(count: int = 90) -> list[tuple[float, float]]:
    return [(float(np.cos(t)), float(np.sin(t))) for t in np.arange(count) * 2.0 * np.pi / count]


def _kwargs(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles))
    mesh.merge_vertices()
    return mesh.vertices, mesh.faces


def test_slivers_that_rounding_explains_stand_upright(tmp_path: Path) -> None:
    """A wall whose corners are off by less than the numbers' rounding counts as upright, by as much less sure."""
    little = read_solid(stepped(tmp_path / "b.stl", 2e-7))
    assert little.faces == (0.0, 4.0, 9.0)
    assert not len(little.leaning)
    assert 0.0 < little.uneven < 1e-6
    turned = read_solid(stepped(tmp_path / "c.stl", 1e-4))
    assert [4.0, 9.0] in turned.leaning[:, :2].tolist()


@pytest.mark.parametrize(("needles", "leans"), [(1, True), (2, False), (200, True)])
def test_slivers_side_by_side_lean_together(needles: int, leans: bool) -> None:
    """A millimetre of wall that leans by a millimetre, of needles so narrow that each alone might be rounding."""
    wide = 1.0 if needles == 1 else 0.005 * needles
    foot = np.linspace(0.0, wide, needles + 1)
    feet = np.column_stack([foot, np.zeros_like(foot), np.zeros_like(foot)])
    tip = np.broadcast_to([0.5 * wide, 1.0, 10.0], (needles, 3))
    fan = np.stack([feet[:-1], feet[1:], tip], axis=1)
    upright = np.array([[[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [0.0, 0.0, 10.0]]])
    found = walls(welded(np.concatenate([fan, upright])), 0.006)
    assert np.unique(found.leaning[:, :2], axis=0).tolist() == ([[0.0, 10.0]] if leans else [])
    assert (0.004 < found.slivers[:, 3].max(initial=0.0) < 0.006) is not leans


class _Solid:
    faces: tuple[float, ...] = (0.0, 4.0, 9.0)
    leaning = np.array([[4.0, 9.0, 20.0, 1.0]])


@pytest.mark.parametrize(
    ("lean", "named"),
    [
        (Lean("chamfer", 4.0, 9.0), None),
        (Lean("chamfer", 4.009, 8.991), None),
        (Lean("chamfer", 4.02, 9.0), "chamfer"),
        (Lean("chamfer", 3.98, 9.0), "chamfer"),  # a part of it is no even lean
        (Lean("chamfer", 3.0, 9.5, inward=1.001), None),  # but as steep as it should be
        (Lean("chamfer", 3.0, 9.5, inward=1.002), "chamfer"),
        (Lean("chamfer", 3.0, 9.5, inward=-1.0), "chamfer"),
        (Lean("chamfer", 0.0, 3.9), "thickness"),
        (Lean("set-screw", 3.0, 9.5, 20.0), None),
        (Lean("set-screw", 3.0, 9.5, 19.98), "set-screw"),
        (Lean("set-screw", 4.02, 9.5, 30.0), "set-screw"),
    ],
)
def test_what_may_lean_and_what_may_not(lean: Lean, named: str | None) -> None:
    """Evenly from end to end or as steeply, or within heights and reach; each within the tolerance."""
    told = between_sections(_Solid, [0.0, 4.0, 9.0], [lean], 0.01)
    assert [kind for kind, _ in told] == ([] if named is None else [named])
    assert named is None or "between z = 4 and 9 mm" in shown(told[0][1])


@pytest.mark.parametrize(
    ("faces", "double"), [((0.0, 9.0), False), ((0.0, 8.991, 9.0), True), ((0.0, 8.9, 9.0), False)]
)
def test_one_face_where_one_is_meant(faces: tuple[float, ...], double: bool) -> None:
    """Two within the tolerance are a fin; what is farther off is for the checks on faces."""

    class Faced(_Solid):
        leaning = np.empty((0, 4))

    Faced.faces = faces
    assert bool(between_sections(Faced, [0.0, 9.0], [], 0.01)) is double
