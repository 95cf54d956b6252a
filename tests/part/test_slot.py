"""A slot through the disc: outline, walls and mass in closed form, files by other readers, planted faults."""

import math

import numpy as np
import pytest
from support.heavy import ezdxf, trimesh
from support.parts import failures, files_of, found, recipe_of

import camgeo
from camgeo.measures.balance import balances_of
from camgeo.part.shapes import slot_across
from camgeo.part.slot import Slot
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.intent import intended
from kin.numeric.records import replace

ROUND = "cam: {kind: support, p: 30 + 0*t}\n"
SLOT = "slot: {length: 12, width: 5, circle: 36, at: 40}"
AREA = 5 * (12 - 5) + 0.25 * math.pi * 5**2
PART = f"{{thickness: 8, bore: 12, {SLOT}, wall: 3}}"


def test_its_ends_lie_at_half_its_length_from_the_ray():
    outline = slot_across(18.0, 12.0, 5.0, math.radians(40))
    radial = np.array([math.cos(math.radians(40)), math.sin(math.radians(40))])
    along = np.array([-radial[1], radial[0]])
    # two straight sides, 7 mm long, and two half circles
    assert outline.points @ radial == pytest.approx([20.5, 20.5, 15.5, 15.5])
    assert outline.points @ along == pytest.approx([-3.5, 3.5, 3.5, -3.5])
    assert outline.bulges.tolist() == [0.0, 1.0, 0.0, 1.0]


def test_its_walls_are_those_of_its_sides_and_corners():
    _, checks = found(recipe_of(f"{{bore: 12, {SLOT}}}", cam=ROUND))
    # to the bore from its straight side, to the rim from the outer end of that side's round
    inner, outer = 18 - 2.5 - 6, 30 - (math.hypot(18, 3.5) + 2.5)
    assert checks["wall"].value == pytest.approx(min(inner, outer), abs=1e-6)
    assert "slot and contour" in checks["wall"].detail
    _, checks = found(recipe_of(f"{{bore: 26, {SLOT}}}", cam=ROUND))
    assert checks["wall"].value == pytest.approx(18 - 2.5 - 13, abs=1e-9)
    assert "slot" in checks["wall"].detail
    assert "bore" in checks["wall"].detail
    _, checks = found(recipe_of(f"{{bore: 32, {SLOT}}}", cam=ROUND))
    assert not checks["wall"].ok


def test_it_takes_its_mass_away_and_moves_the_centre():
    recipe = recipe_of(PART.replace("wall: 3", "density: 8000"), cam=ROUND)
    (balance,) = balances_of(recipe, found(recipe)[0])
    volume = 8 * (math.pi * (30**2 - 6**2) - AREA)
    assert balance.mass == pytest.approx(8000e-9 * volume, rel=1e-12)
    assert balance.unbalance == pytest.approx(8000e-9 * 8 * AREA * 18, rel=1e-9)
    assert balance.direction == pytest.approx(220, abs=1e-6)


@pytest.mark.thin(2)
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_other_readers_find_it(tmp_path, rotation):
    _, files = files_of(recipe_of(PART, cam=ROUND, more=f"rotation: {rotation}\n"), tmp_path)
    (drawn,) = [entity for entity in ezdxf.readfile(files["dxf"][0]).modelspace() if entity.dxf.layer == "HOLES"]
    points = np.array([point[:2] for point in drawn.get_points()])
    x, y = 18 * math.cos(math.radians(40)), 18 * math.sin(math.radians(40))
    assert points.mean(axis=0) == pytest.approx([x, y if rotation == "cw" else -y], abs=1e-9)
    assert sorted(abs(bulge) for *_, bulge in drawn.get_points()) == [0, 0, 1, 1]
    assert drawn.closed
    mesh = trimesh.load(files["stl"][0])
    assert mesh.is_watertight
    # two openings through a disc
    assert mesh.euler_number == -2
    assert mesh.volume == pytest.approx(8 * (math.pi * (30**2 - 6**2) - AREA), abs=0.01 * mesh.area)


@pytest.mark.slow
def test_a_kernel_reads_its_volume_from_a_step(tmp_path):
    pytest.importorskip("OCP")
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.STEPControl import STEPControl_Reader

    _, files = files_of(recipe_of(PART, cam=ROUND, files="step"), tmp_path)
    reader = STEPControl_Reader()
    reader.ReadFile(str(files["step"][0]))
    reader.TransferRoots()
    properties = GProp_GProps()
    BRepGProp.VolumePropertiesGK_s(reader.OneShape(), properties, 1e-10, True)
    assert properties.Mass() == pytest.approx(8 * (math.pi * (30**2 - 6**2) - AREA), rel=1e-6)


@pytest.mark.thin(4)
@pytest.mark.parametrize("kind", ["dxf", "stl"])
@pytest.mark.parametrize("change", [{"at": math.radians(40.2)}, {"length": 12.1}, {"circle": 36.1}, None])
def test_a_planted_fault_is_caught(tmp_path, kind, change):
    recipe = recipe_of(PART, cam=ROUND)
    design, files = files_of(recipe, tmp_path)
    path = files[kind][0]
    assert failures(path, recipe, design) == set()
    slot = recipe.part.of(Slot)
    features = () if change is None else (replace(slot, **change),)
    other = replace(recipe, part=replace(recipe.part, features=features))
    meant = intended(other, found(other)[0])
    changes = {"holes": meant.holes, "layers": meant.layers, "bore": meant.bore}
    assert failures(path, recipe, design, **changes) & {"holes", "bore"}


def test_a_kerf_makes_it_narrower(tmp_path):
    more = ROUND + f"part: {PART.replace(', wall: 3', '')}\n"
    recipe = load_text(more + "export: {tolerance: 0.01, files: [{dxf: {kerf: 0.4}}]}\n", tmp_path / "kerf.yaml")
    report = camgeo.export(recipe, tmp_path / "out")
    assert report.ok
    (path,) = (tmp_path / "out").rglob("*.dxf")
    (drawn,) = [entity for entity in ezdxf.readfile(path).modelspace() if entity.dxf.layer == "HOLES"]
    points = np.array([point[:2] for point in drawn.get_points()])
    u = np.array([math.cos(math.radians(40)), math.sin(math.radians(40))])
    assert np.ptp(points @ u) == pytest.approx(5 - 0.4, abs=1e-9)


@pytest.mark.parametrize(
    ("keys", "problem"),
    [
        ("{length: 5, width: 5, circle: 36}", "part.slot.width: not below its length"),
        ("{length: 5, width: 2}", "part.slot.circle: missing"),
        ("{length: 5, width: 0.0001, circle: 36}", "part.slot.width: smaller than a file can hold"),
        ("{length: 5, width: 2, circle: 36, start: 3}", "part.slot.start: unknown key"),
    ],
)
def test_what_is_no_slot_is_refused_at_its_field(keys, problem):
    with pytest.raises(RecipeErrors) as refused:
        recipe_of(f"{{bore: 12, slot: {keys}}}", cam=ROUND)
    assert problem in str(refused.value)
