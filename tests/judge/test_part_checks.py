"""The judge of openings, layers and set screws: closed forms, and planted faults caught by checks that name them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support import followers
from support.heavy import ezdxf
from support.parts import failures, files_of, recipe_of

from camgeo.synthesis.intent import intended
from kin.contour.holes import Hole, round_hole
from kin.follower.envelope import FlatEnvelope
from kin.law.support_function import lift_from_fourier
from kin.read.errors import ReadError
from kin.read.files import read_drawing, read_solid
from kin.read.layers import CrossHole, Layer, faces, heights, slotted, volume

E = 0.01
PRISM = (
    "{thickness: 8, bore: 12, keyway: {standard: din6885, at: 180}, bolts: {count: 3, circle: 32, hole: 4, start: 60}, "
    "dowel: {circle: 32, hole: 3, at: 20}, mark: {as: AS, length: 3, width: 1}}"
)
SOLID = (
    "{thickness: 8, bore: 12, keyway: {width: 4, depth: 1.8, at: 180}, hub: {diameter: 22, height: 6}, "
    "set_screw: {diameter: 3.4, at: 90}, dowel: {circle: 34, hole: 3, at: 20}, chamfer: 0.5, "
    "mark: {depth: 0.4, radius: 20}}"
)


@pytest.fixture(scope="module")
def drawing(tmp_path_factory):
    recipe = recipe_of(PRISM.replace("AS", "engrave"))
    design, files = files_of(recipe, tmp_path_factory.mktemp("drawing"))
    return recipe, design, files


@pytest.fixture(scope="module")
def solid(tmp_path_factory):
    recipe = recipe_of(SOLID)
    design, files = files_of(recipe, tmp_path_factory.mktemp("solid"))
    return recipe, design, files


# --- a drawing spoilt -----------------------------------------------------------------------------------------------


def spoilt(drawing, folder, spoil):
    recipe, design, files = drawing
    document = ezdxf.readfile(files["dxf"][0])
    spoil(document.modelspace())
    path = folder / "spoilt.dxf"
    document.saveas(path)
    return failures(path, recipe, design)


def on(space, layer):
    return [entity for entity in space if entity.dxf.layer == layer]


def moved(entity, dx, dy=0.0):
    entity.translate(dx, dy, 0.0)


def turned(entity, degrees):
    entity.rotate_z(math.radians(degrees))


@pytest.mark.slow
def test_untouched_it_holds(drawing, tmp_path):
    assert spoilt(drawing, tmp_path, lambda space: space) == set()


@pytest.mark.thin(6)
@pytest.mark.parametrize("which", range(4))
@pytest.mark.parametrize("angle", [0.0, 2.0])
def test_hole_moved_by_three_tolerances(drawing, tmp_path, which, angle):
    step = 3 * E * np.array([math.cos(angle), math.sin(angle)])
    assert spoilt(drawing, tmp_path, lambda space: moved(on(space, "HOLES")[which], *step)) == {"holes"}
    small = 0.9 * E * np.array([math.cos(angle), math.sin(angle)])
    assert spoilt(drawing, tmp_path, lambda space: moved(on(space, "HOLES")[which], *small)) == set()


def larger(space):
    on(space, "HOLES")[0].dxf.radius += 1.5 * E


def without_keyway(space):
    for entity in on(space, "BORE"):
        space.delete_entity(entity)
    space.add_circle((0, 0), 6.0, dxfattribs={"layer": "BORE"})


def keyway_turned(space):
    turned(on(space, "BORE")[0], 0.2)


def keyway_on_the_other_side(space):
    turned(on(space, "BORE")[0], 180.0)


def no_bore(space):
    for entity in on(space, "BORE"):
        space.delete_entity(entity)


def one_hole_less(space):
    space.delete_entity(on(space, "HOLES")[1])


def one_hole_more(space):
    space.add_circle((-14.0, 8.0), 1.0, dxfattribs={"layer": "HOLES"})


def hole_elsewhere(space):
    moved(on(space, "HOLES")[2], 6.0, 1.0)


def mark_turned(space):
    turned(on(space, "ENGRAVE")[0], 0.2)


def mark_the_other_way(space):
    turned(on(space, "ENGRAVE")[0], 180.0)


def no_mark(space):
    space.delete_entity(on(space, "ENGRAVE")[0])


def mark_cut_through(space):
    on(space, "ENGRAVE")[0].dxf.layer = "MARK"


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("spoil", "caught"),
    [
        (larger, {"holes"}),
        (without_keyway, {"bore"}),
        (keyway_turned, {"bore"}),
        (keyway_on_the_other_side, {"bore"}),
        (no_bore, {"bore"}),
        (one_hole_less, {"holes"}),
        (one_hole_more, {"holes"}),
        (hole_elsewhere, {"holes"}),
        (mark_turned, {"mark"}),
        (mark_the_other_way, {"mark", "holes"}),
        (no_mark, {"mark"}),
        (mark_cut_through, {"mark"}),
    ],
)
def test_fault_of_a_drawing(drawing, tmp_path, spoil, caught):
    assert spoilt(drawing, tmp_path, spoil) == caught


def test_faults_are_told_with_name_and_place(drawing, tmp_path):
    recipe, design, files = drawing
    document = ezdxf.readfile(files["dxf"][0])
    one_hole_less(document.modelspace())
    one_hole_more(document.modelspace())
    path = tmp_path / "spoilt.dxf"
    document.saveas(path)
    from kin.judge.intent import Limits
    from kin.judge.verify import verify

    checks = {check.name: check for check in verify(path, intended(recipe, design), 36, Limits(E)).checks}
    detail = checks["holes"].detail
    assert "bolt hole 2 at (-16, " in detail
    assert "is missing" in detail
    assert "an opening of 3.14159 mm^2 about (-14, 8), where none is expected" in detail


@pytest.mark.slow
def test_cut_mark_turned_by_a_fifth_of_a_degree(tmp_path):
    recipe = recipe_of(PRISM.replace("AS", "cut"))
    design, files = files_of(recipe, tmp_path)
    document = ezdxf.readfile(files["dxf"][0])
    turned(on(document.modelspace(), "MARK")[0], 0.2)
    document.saveas(tmp_path / "spoilt.dxf")
    assert failures(tmp_path / "spoilt.dxf", recipe, design) == {"mark"}
    assert failures(files["stl"][0], recipe, design) == set()


@pytest.mark.slow
def test_mirrored_drawing_is_judged_as_such(tmp_path):
    recipe = recipe_of(PRISM.replace("AS", "cut"), more="rotation: ccw\n")
    design, files = files_of(recipe, tmp_path)
    for kind in ("dxf", "stl"):
        assert {"holes", "contour", "motion"} <= failures(files[kind][0], recipe, design, mirrored=False)


# --- a solid that is another one ------------------------------------------------------------------------------------


VARIANTS = {
    "hub too high": ("height: 6}", "height: 6.03}", {"hub", "volume", "set-screw"}),
    "hub too low": ("height: 6}", "height: 5.97}", {"hub", "volume", "set-screw"}),
    "hub too wide": ("diameter: 22", "diameter: 22.06", {"hub", "volume", "set-screw"}),
    "hub below": ("height: 6}", "height: 6, side: bottom}", None),
    "no keyway": ("keyway: {width: 4, depth: 1.8, at: 180}, ", "", {"bore", "volume", "set-screw"}),
    "keyway turned": ("at: 180", "at: 179.7", {"bore", "set-screw"}),
    "dowel moved": ("circle: 34, hole: 3, at: 20", "circle: 34, hole: 3, at: 20.1", {"holes"}),
    "screw turned": ("diameter: 3.4, at: 90", "diameter: 3.4, at: 90.2", {"set-screw"}),
    "screw wider": ("diameter: 3.4", "diameter: 3.46", {"set-screw"}),
    "screw higher": ("diameter: 3.4, at: 90", "diameter: 3.4, at: 90, height: 3.06", {"set-screw"}),
    "no screw": ("set_screw: {diameter: 3.4, at: 90}, ", "", {"set-screw", "volume"}),
    "chamfer too wide": ("chamfer: 0.5", "chamfer: 0.53", {"chamfer", "volume"}),
    "no chamfer": ("chamfer: 0.5, ", "", {"chamfer", "volume"}),
    "mark too deep": ("depth: 0.4,", "depth: 0.43,", {"mark"}),
    "no mark": (", mark: {depth: 0.4, radius: 20}", "", {"mark", "volume"}),
    "disc too thick": (
        "thickness: 8",
        "thickness: 8.05",
        {"thickness", "hub", "volume", "set-screw", "mark", "chamfer"},
    ),
}


@pytest.mark.thin(20)
@pytest.mark.parametrize("name", VARIANTS)
def test_fault_of_a_solid(solid, tmp_path, name):
    recipe, design, _ = solid
    was, becomes, caught = VARIANTS[name]
    assert was in SOLID
    _, files = files_of(recipe_of(SOLID.replace(was, becomes, 1), files="stl"), tmp_path)
    found = failures(files["stl"][0], recipe, design)
    if caught is None:
        assert found
    else:
        named = {"hub too high": "hub", "hub too low": "hub"}.get(name)
        assert found <= caught
        assert found
        assert named is None or named in found


@pytest.mark.slow
def test_solid_stretched_turned_or_spoilt(solid, tmp_path):
    recipe, design, files = solid
    raw = bytearray(files["stl"][0].read_bytes())
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    triangles = np.frombuffer(raw, record, offset=84).copy()

    def failing(change):
        changed = triangles.copy()
        changed["corners"] = change(triangles["corners"].astype(float))
        path = tmp_path / "spoilt.stl"
        path.write_bytes(bytes(raw[:84]) + changed.tobytes())
        return failures(path, recipe, design)

    assert failing(lambda corners: corners) == set()
    up = np.array([0.0, 0.0, 0.03])
    assert {"thickness", "hub"} <= failing(lambda corners: corners + up)
    # between the disc's faces nothing shows but the hub
    raised = failing(lambda corners: np.where(corners[..., 2:] > 13.9, corners + up, corners))
    assert {"hub"} <= raised <= {"hub", "volume"}
    c, s = math.cos(math.radians(0.2)), math.sin(math.radians(0.2))
    spun = failing(lambda corners: corners @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))
    assert {"bore", "mark", "holes", "contour", "motion"} <= spun


def test_section_that_is_not_there_is_told(solid):
    _, _, files = solid
    with pytest.raises(ReadError, match=r"it has no section at 20"):
        read_solid(files["stl"][0], [4.0, 20.0])


# --- parts of the judge, against closed forms -----------------------------------------------------------------------


def test_ring_cut_open_by_a_slot():
    hub, bore = round_hole("hub", "hub", (0.0, 0.0), 20.0), round_hole("bore", "bore", (0.0, 0.0), 10.0)
    for at in (0.0, 0.7, math.pi / 2, 4.0):
        ring = slotted(hub, bore, at, 1.5)

        def cap(r):
            return 1.5 * math.sqrt(r * r - 2.25) + r * r * math.asin(1.5 / r)

        assert ring.area == pytest.approx(75 * math.pi - cap(10) + cap(5), rel=1e-12)
        assert ring.is_convex is False
        gap = np.array([math.cos(at), math.sin(at)]) * 7.5
        assert ring.distance(gap[None, :])[0] == pytest.approx(1.5, abs=1e-12)


def test_volume_of_layers():
    bore = round_hole("bore", "bore", (0.0, 0.0), 10.0)
    hub = round_hole("hub", "hub", (0.0, 0.0), 20.0)
    layers = (
        Layer(0.0, 1.0, (bore,), None, (1.0, 0.0)),
        Layer(1.0, 6.0, (bore,)),
        Layer(6.0, 10.0, (bore,), hub),
    )
    # a round contour of radius 25: a frustum, a disc, a hub
    area, perimeter = math.pi * 625, math.pi * 50
    frustum = math.pi * (24**2 + 24 * 25 + 25**2) / 3
    expected = frustum + 5 * area + 4 * math.pi * 100 - 10 * math.pi * 25
    assert volume(layers, (), area, perimeter) == pytest.approx(expected, rel=1e-14)
    cross = CrossHole("screw", 0.3, 2.0, 8.0)
    bored = expected - volume(layers, (cross,), area, perimeter)
    y = np.sin((np.arange(100000) + 0.5) / 100000 * math.pi - math.pi / 2)
    way = np.sqrt(100 - y * y) - np.sqrt(25 - y * y)
    assert bored == pytest.approx(np.sum(2 * (1 - y * y) * way) * math.pi / 100000, rel=1e-8)


def test_faces_and_heights_of_layers():
    hub = round_hole("hub", "hub", (0.0, 0.0), 20.0)
    mark = round_hole("mark", "mark", (15.0, 0.0), 1.0)
    layers = (
        Layer(-5.0, 0.0, (), hub),
        Layer(0.0, 7.6),
        Layer(7.6, 8.0, (mark,)),
        Layer(8.0, 12.0, (), hub),
    )
    assert faces(layers) == [("hub", -5.0), ("thickness", 0.0), ("mark", 7.6), ("thickness", 8.0), ("hub", 12.0)]
    levels = heights(layers, (CrossHole("screw", 0.0, 2.0, 10.0),))
    assert levels[0] == (3.8, layers[1])
    assert all(layer.low < z < layer.high for z, layer in levels)
    assert sum(layer is layers[3] for _, layer in levels) == 5


def test_parallel_of_a_flat_envelope():
    envelope = followers.flat_face(lift_from_fourier(25.0, {3: 2.0}, {}, (3.0, 2.0))).envelope
    assert isinstance(envelope, FlatEnvelope)
    inner = envelope.inset(1.5)
    (area, length), (inside, shorter) = envelope.area_and_perimeter(), inner.area_and_perimeter()
    assert shorter == pytest.approx(length - 3 * math.pi, rel=1e-13)
    assert inside == pytest.approx(area - 1.5 * length + math.pi * 2.25, rel=1e-13)
    points = inner.points(np.linspace(0, 6, 50))
    assert envelope.feet(points).excess == pytest.approx(-1.5, abs=1e-9)


def test_engraved_chains_are_read_only_if_asked_for(drawing):
    _, _, files = drawing
    path = files["dxf"][0]
    assert read_drawing(path).engraved == ()
    assert len(read_drawing(path, engraved=True).engraved) == 1
    assert len(read_drawing(path).holes) == 5


def test_an_intent_with_nothing_but_a_bore_is_plain(solid):
    recipe, design, _ = solid
    intent = intended(recipe, design)
    assert intent.featured
    assert not replace(intent, holes=(), layers=()).featured
    assert isinstance(intent.holes[0], Hole)
