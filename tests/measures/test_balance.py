"""Mass, centre of mass, inertia and unbalance of discs: worked cases, the file's own mesh, limits and sweeps."""

import json
import math
import re

import numpy as np
import pytest
from support.heavy import trimesh

from camgeo.cli.main import main
from camgeo.curve.measures import moments_of_chain
from camgeo.measures.balance import balances_of
from camgeo.measures.limits import limit_checks
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.contour.arcs import circle
from kin.contour.contour import Contour

LOBE = """
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat}
  motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}
part: {thickness: 14, density: 7850}
"""
ROLLER = """
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion:
    - {rise: 20, over: 120, law: cycloidal}
    - {dwell: 60}
    - {return: 20, over: 120, law: polynomial-345}
    - {dwell: 60}
part: {thickness: 10, density: 7850%s}
"""
FEATURES = (
    ", bore: 16, keyway: din6885, hub: {diameter: 30, height: 8, side: both}, chamfer: 1.5, "
    "mark: {depth: 3, width: 3}, lightening: {ring: 3, wall: 4}"
)


def balance(text):
    recipe = load_text(text, "cam.yaml")
    (found,) = balances_of(recipe, designed(recipe))
    return found


def test_lobe_and_roller_cam_of_the_worked_cases() -> None:
    lobe = balance(LOBE)
    assert lobe.mass / (7.85e-6 * 14.0) == pytest.approx(1145.7886636727, rel=1e-12)
    assert lobe.eccentricity == pytest.approx(2.210763945, abs=6e-10)
    assert lobe.unbalance == pytest.approx(0.278384202, abs=6e-10)
    assert lobe.centre[2] == pytest.approx(7.0, abs=1e-12)
    assert lobe.error < 1e-11
    cam = balance(ROLLER % "")
    assert (cam.unbalance, cam.direction) == pytest.approx((7.364116372, 149.926828849), abs=2e-9)
    mirrored = balance(f"rotation: ccw\n{ROLLER % ''}")
    assert mirrored.direction == pytest.approx(360.0 - 149.926828849, abs=2e-9)


def test_cam_of_four_arcs() -> None:
    base, nose = np.radians([52.831100344, 43.861697524])
    upper = np.array([9.0 + 14.0 * np.exp(1j * nose), 20.0 * np.exp(1j * base)])
    corners = np.array([upper[0].conj(), upper[0], upper[1], upper[1].conj()])
    sweeps = np.array([2.0 * nose, base - nose, 2.0 * (math.pi - base), base - nose])
    points, bulges = np.column_stack([corners.real, corners.imag]), np.tan(0.25 * sweeps)
    whole = moments_of_chain(Contour.from_bulges(points, bulges).as_arcs()[0])
    bore = moments_of_chain(circle(np.zeros((1, 2)), np.array([6.0])))
    assert whole.area == pytest.approx(1314.545813001, abs=2e-6)  # of corners given to nine digits
    assert whole.x / whole.area == pytest.approx(0.886963464, abs=2e-9)
    assert whole.polar == pytest.approx(277333.228799175, abs=1e-3)
    assert 7.85e-5 * (whole.area - bore.area) == pytest.approx(0.094313705, abs=6e-10)
    assert 7.85e-5 * (whole.polar - bore.polar) == pytest.approx(21.610851926, abs=1e-7)
    off_centre = moments_of_chain(circle(np.array([[3.0, -4.0]]), np.array([2.0])))
    expected = math.pi * np.array([4.0, 12.0, -16.0, 4.0 * (2.0 + 25.0)])
    assert [off_centre.area, off_centre.x, off_centre.y, off_centre.polar] == pytest.approx(expected, rel=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        ROLLER % FEATURES,
        "rotation: ccw\n" + ROLLER % FEATURES,
        (ROLLER % ", outer: 160").replace("motion:", "track: internal\n  motion:"),
        (ROLLER % ", bore: 16, outer: 180").replace("motion:", "track: {groove: {depth: 4}}\n  motion:"),
    ],
    ids=["features", "mirrored", "ring", "groove"],
)
def test_mesh_of_the_file_weighs_the_same(text, tmp_path, capsys) -> None:
    (tmp_path / "cam.yaml").write_text(text + "export: {tolerance: 0.0005, files: [stl]}\n")
    assert main(["export", str(tmp_path / "cam.yaml"), "--out", str(tmp_path)]) == 0
    capsys.readouterr()
    (report,) = json.loads((tmp_path / "cam" / "report.json").read_text())["balance"]
    mesh = trimesh.load_mesh(tmp_path / "cam" / "cam.stl")
    mesh.density = 7.85e-6
    assert report["mass_kg"] == pytest.approx(mesh.mass, rel=4e-5)
    assert report["centre"] == pytest.approx(mesh.center_mass, abs=1e-3)
    x, y, _ = mesh.center_mass
    about_shaft = mesh.moment_inertia[2, 2] + mesh.mass * (x * x + y * y)
    assert report["inertia_kg_mm2"] == pytest.approx(about_shaft, rel=6e-5)
    assert report["unbalance_kg_mm"] == pytest.approx(mesh.mass * math.hypot(x, y), rel=2e-3)
    assert report["error"] < 1e-11


def test_set_screw_is_said_to_be_left_out() -> None:
    hub = ", bore: 16, hub: {diameter: 30, height: 8}"
    whole, holed = balance(ROLLER % hub), balance(ROLLER % f"{hub}, set_screw: {{diameter: 4}}")
    assert (whole.without, holed.without) == ((), ("set screw",))
    assert whole.mass == holed.mass


def test_limits_and_what_they_need() -> None:
    recipe = load_text(
        LOBE + "limits: {unbalance: {at_most: 0.2784}, inertia: {at_least: 20}, mass: {at_most: 1}}\n", "r"
    )
    design = designed(recipe)
    found = {check.name: check for check in limit_checks(recipe, design, design.checks, (), None)}
    assert all(check.ok for check in found.values())
    assert {check.unit for check in found.values()} == {"kg", "kg mm", "kg mm^2"}
    with pytest.raises(RecipeErrors, match=r"mass needs part\.density"):
        load_text(LOBE.replace(", density: 7850", "") + "limits: {mass: {at_most: 1}}\n", "r")
    with pytest.raises(RecipeErrors, match=r"part\.density: needs part\.thickness"):
        load_text(LOBE.replace("thickness: 14, ", ""), "r")


# needs: sweep
@pytest.mark.slow
def test_sweep_ranks_by_mass(tmp_path, capsys) -> None:
    sweep = "sweep: {vary: {cam.base_radius: [18, 20, 22]}, rank: mass, keep: 3}\n"
    (tmp_path / "lobe.yaml").write_text(LOBE.replace("density: 7850", "density: 7850, bore: 37") + sweep)
    assert main(["sweep", str(tmp_path / "lobe.yaml"), "--out", str(tmp_path)]) == 0
    capsys.readouterr()
    best = sorted((tmp_path / "lobe").glob("best-*.yaml"))
    mass = [balance(path.read_text()).mass for path in best]
    bores = 7.85e-6 * 14.0 * math.pi * 18.5**2
    assert len(mass) == 2  # a base radius of 18 has no room for the bore
    assert mass == sorted(mass)
    plain = balance(LOBE.replace("base_radius: 18", "base_radius: 20")).mass
    assert mass[0] == pytest.approx(plain - bores, rel=1e-9)
    with pytest.raises(RecipeErrors, match=r"mass needs part\.density, and in a sweep no linkage"):
        load_text(re.sub(", density: 7850", "", LOBE) + sweep, "r")
