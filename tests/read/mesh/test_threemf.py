"""3MF files: precision, the same bytes twice, a second reader; planted faults caught; strange and hostile archives."""

import math
import re
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import lib3mf
from support.outlines import bored
from support.parts import failures, files_of, recipe_of

from camgeo import testing
from camgeo.cli.main import main
from camgeo.files.mesh import Item, Mesh
from camgeo.files.precision import DECIMALS
from camgeo.files.prism import extruded_mesh
from camgeo.files.sides import sides
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.pieces import Bound, Polygon
from camgeo.formats.three_mf import write_3mf
from camgeo.output.pipeline import judge_files
from camgeo.schema.errors import RecipeErrors
from kin.read.errors import ReadError
from kin.read.files import read_solid
from kin.read.mesh.threemf import read_3mf, read_placed

MODEL = "3D/3dmodel.model"
PLAIN = "{thickness: 8, bore: 10}"
FULL = (
    "{thickness: 8, bore: 10, keyway: {width: 4, depth: 1.8, at: 180}, hub: {diameter: 22, height: 6}, "
    "set_screw: {diameter: 3.4, at: 90}, chamfer: 0.5, bolts: {count: 3, circle: 34, hole: 4, start: 60}, "
    "mark: {as: engrave, width: 1, length: 3, depth: 0.4, radius: 20}}"
)


def asked(recipe, *files):
    """The recipe with these files asked for."""
    one = recipe.export.files[0]
    requests = tuple(replace(one, **{"kind": "3mf", "as_": None, "options": (), **file}) for file in files)
    return replace(recipe, export=replace(recipe.export, files=requests))


def made(part, folder, tolerance=0.01, **more):
    recipe = asked(recipe_of(part, **more), {"tolerance": tolerance})
    design, files = files_of(recipe, folder)
    return recipe, design, *files["3mf"]


def model_of(path):
    with zipfile.ZipFile(path) as archive:
        return archive.read(MODEL).decode()


def rewritten(path, change):
    """The archive with its model's text changed."""
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    text = members[MODEL].decode()
    changed = change(text)
    assert changed != text
    there = path.with_name("spoilt.3mf")
    with zipfile.ZipFile(there, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in {**members, MODEL: changed.encode()}.items():
            archive.writestr(name, data)
    return there


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return made(PLAIN, tmp_path_factory.mktemp("plain"))


@pytest.fixture(scope="module")
def full(tmp_path_factory):
    return made(FULL, tmp_path_factory.mktemp("full"))


# --- what is written --------------------------------------------------------------------------------------------------


@pytest.mark.thin(2)
@pytest.mark.parametrize("which", ["plain", "full"])
def test_the_consortium_s_own_reader_takes_it_without_a_warning(which, request):
    _, _, path, _ = request.getfixturevalue(which)
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    assert reader.GetWarningCount() == 0
    assert model.GetUnit() == lib3mf.ModelUnit.MilliMeter
    objects = model.GetMeshObjects()
    assert objects.Count() == 1
    assert objects.MoveNext()
    mesh = objects.GetCurrentMeshObject()
    assert mesh.GetName() == "cam"
    assert mesh.IsManifoldAndOriented()
    read = read_3mf(path)
    assert mesh.GetTriangleCount() == read.triangles
    points = np.array([vertex.Coordinates[:] for vertex in mesh.GetVertices()])
    corners = np.array([triangle.Indices[:] for triangle in mesh.GetTriangleIndices()])
    a, b, c = (points[corners[:, k]] for k in range(3))
    volume = float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0
    assert read.volume == pytest.approx(volume, rel=1e-6)  # that reader holds single precision


def test_the_same_bytes_twice_and_no_date_in_them(tmp_path, plain):
    _, _, path, _ = plain
    _, _, again, _ = made(PLAIN, tmp_path)
    assert again.read_bytes() == path.read_bytes()
    with zipfile.ZipFile(path) as archive:
        assert archive.namelist() == ["[Content_Types].xml", "_rels/.rels", MODEL]
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_titles_of_any_text_come_back(tmp_path):
    mesh = Mesh(
        np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    )
    path = tmp_path / "cam.3mf"
    write_3mf(path, [Item('a"<b>', mesh)], title='R&D <"5">', about="line\nline \x01 é")
    assert read_placed(path)[0].name == 'a"<b>'
    model = lib3mf.get_wrapper().CreateModel()
    model.QueryReader("3mf").ReadFromFile(str(path))
    group = model.GetMetaDataGroup()
    found = {group.GetMetaData(k).GetName(): group.GetMetaData(k).GetValue() for k in range(group.GetMetaDataCount())}
    assert found == {"Title": 'R&D <"5">', "Description": "line line é", "Application": "camgeo"}


@pytest.mark.slow
def test_a_millionth_of_a_millimetre_at_a_hundred(tmp_path):
    recipe, design, path, checks = made(PLAIN, tmp_path, 1e-6, cam="cam: {kind: support, p: 100 + 3*cos(3*t)}\n")
    assert 0.0 < checks["contour"].value <= checks["contour"].limit == 1e-6
    assert checks["bore"].value <= 1e-6
    assert failures(path, recipe, design, 1e-6) == set()
    single = asked(recipe, {"kind": "stl", "tolerance": 1e-6})
    with pytest.raises(RecipeErrors, match=r"an STL of a contour that reaches 104\.03 mm .* cannot hold 1e-06 mm"):
        files_of(single, tmp_path)


@pytest.mark.slow
def test_a_chamfered_part_finer_than_single_precision(tmp_path):
    recipe, design, path, _ = made("{thickness: 8, bore: 10, chamfer: 0.5}", tmp_path, 2e-6)
    assert failures(path, recipe, design, 2e-6) == set()


@pytest.mark.parametrize(("size", "least"), [(100.0, 8.84e-10), (1e6, 1.09e-9)])
def test_nine_decimals_have_a_least_tolerance_too(size, least):
    assert DECIMALS.fit_tolerance(1e-6, size) < 1e-6
    with pytest.raises(ToleranceError, match=r"a 3MF of a contour .* to nine decimals alone moves points") as caught:
        DECIMALS.fit_tolerance(5e-10, size)
    assert caught.value.reached == pytest.approx(least, rel=0.02)
    assert DECIMALS.fit_tolerance(caught.value.reached, size) > 0.0


@given(st.floats(-1e6, 1e6))
def test_what_is_written_comes_back_to_the_bit_and_moves_no_farther_than_said(value):
    held = DECIMALS.number(value)
    assert float(repr(held)) == held
    assert len(repr(held).partition(".")[2].partition("e")[0]) <= 9 or abs(held) < 1e-4
    assert abs(held - value) <= math.sqrt(0.5) * DECIMALS.bound(value)


def test_sides_are_exact_for_any_doubles():
    """Points of a line as doubles have them, and the next doubles to either side of it."""
    rng = np.random.default_rng(5)
    a, step = rng.normal(size=(200, 2)), rng.normal(size=(200, 2))
    b, c = a + step, a + 0.3 * step
    from fractions import Fraction

    def exact(a, b, c):
        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, point.tolist()) for point in (a, b, c))
        value = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        return (value > 0) - (value < 0)

    for moved in (c, np.nextafter(c, 10.0), np.nextafter(c, -10.0)):
        assert sides(a, b, moved).tolist() == [exact(*row) for row in zip(a, b, moved, strict=True)]
    assert sides(a, a, c).tolist() == [0] * 200


@settings(max_examples=examples(20))
@given(st.integers(3, 400), st.floats(0.0, 0.9), st.floats(5.0, 90.0))
def test_prisms_of_doubles_close_and_have_their_polygons_volume(n, hollow, size):
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    r = size * (1.0 + 0.3 * hollow * np.cos(5.0 * t))
    polygon = Polygon(np.column_stack((r * np.cos(t), r * np.sin(t))), Bound(0.0, 0.0))
    mesh, facts = extruded_mesh(bored(polygon), thickness=7.3, tolerance=1e-8, precision=DECIMALS)
    assert facts.displacement <= DECIMALS.bound(1.3 * size)
    assert mesh.volume == pytest.approx(7.3 * polygon.area, rel=1e-9)
    edges = {
        tuple(edge)
        for triangle in mesh.triangles.tolist()
        for edge in zip(triangle, triangle[1:] + triangle[:1], strict=True)
    }
    assert len(edges) == 3 * len(mesh.triangles)
    assert {(b, a) for a, b in edges} == edges


# --- planted faults ---------------------------------------------------------------------------------------------------

NUMBER = r"-?[\d.e-]+"


def moved_vertex(text):
    """The farthest vertex of the upper face 0.05 mm farther out."""
    found = [
        (float(x), match)
        for match in re.finditer(rf'<vertex x="({NUMBER})" y="{NUMBER}" z="({NUMBER})"/>', text)
        for x in [match.group(1)]
    ]
    x, match = max(found, key=lambda one: one[0])
    return text.replace(match.group(0), match.group(0).replace(f'x="{match.group(1)}"', f'x="{x + 0.05!r}"'))


def flipped(text):
    return re.sub(r'v1="(\d+)" v2="(\d+)"', r'v1="\2" v2="\1"', text, count=1)


def removed(text):
    return re.sub(r"<triangle [^>]*>\n?", "", text, count=1)


def doubled(text):
    return re.sub(r"(<triangle [^>]*>)", r"\1\1", text, count=1)


def placed(numbers):
    return lambda text: text.replace('<item objectid="1"/>', f'<item objectid="1" transform="{numbers}"/>')


FAULTS = {
    "a vertex moved": (moved_vertex, {"contour", "motion"}),
    "a triangle flipped": (flipped, {"watertight"}),
    "a triangle removed": (removed, {"watertight"}),
    "a triangle twice": (doubled, {"watertight"}),
    "inches": (lambda text: text.replace('"millimeter"', '"inch"'), {"contour", "motion", "thickness", "bore"}),
    "unit left out": (lambda text: text.replace('unit="millimeter"', 'unit="micron"'), {"contour", "motion"}),
    "scaled": (placed("1.001 0 0 0 1.001 0 0 0 1.001 0 0 0"), {"contour", "motion"}),
    "stretched upward": (placed("1 0 0 0 1 0 0 0 1.01 0 0 0"), {"thickness"}),
    "sheared": (placed("1 0 0 0.001 1 0 0 0 1 0 0 0"), {"contour"}),
    "mirrored": (placed("1 0 0 0 -1 0 0 0 1 0 0 0"), {"contour", "motion"}),
    "all triangles turned": (lambda text: re.sub(r'v1="(\d+)" v2="(\d+)"', r'v1="\2" v2="\1"', text), {"watertight"}),
}


@pytest.mark.thin(2)
@pytest.mark.parametrize("fault", FAULTS)
def test_fault_of_a_plain_part(plain, fault):
    recipe, design, path, _ = plain
    change, caught = FAULTS[fault]
    assert caught <= failures(rewritten(path, change), recipe, design)


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["a triangle flipped", "a triangle removed", "inches", "stretched upward", "scaled"])
def test_fault_of_a_part_with_everything(full, fault):
    recipe, design, path, _ = full
    change, caught = FAULTS[fault]
    assert caught & failures(rewritten(path, change), recipe, design)


def test_a_part_turned_and_shifted_on_the_plate_is_the_same_part(plain):
    recipe, design, path, _ = plain
    c, s = math.cos(0.7), math.sin(0.7)
    for numbers in (f"{c!r} {s!r} 0 {-s!r} {c!r} 0 0 0 1 120 80 3", "1 0 0 0 -1 0 0 0 -1 50 50 8"):
        assert failures(rewritten(path, placed(numbers)), recipe, design) == set()


@pytest.mark.slow
def test_a_wrong_hub_is_told_by_name(full, tmp_path):
    recipe, design, _, _ = full
    _, _, path, _ = made(FULL.replace("height: 6}", "height: 6.03}"), tmp_path)
    assert "hub" in failures(path, recipe, design)
    _, _, path, _ = made(FULL.replace("set_screw: {diameter: 3.4, at: 90}, ", ""), tmp_path)
    assert "set-screw" in failures(path, recipe, design)


@pytest.mark.slow
def test_counter_clockwise_is_drawn_mirrored(tmp_path):
    recipe, design, path, _ = made(FULL, tmp_path, more="rotation: ccw\n")
    assert failures(path, recipe, design) == set()
    assert {"contour", "motion"} <= failures(path, recipe, design, mirrored=False)


def test_inch_recipes_make_millimetres(tmp_path):
    cam = "units: inch\ncam: {kind: support, p: 1 + 0.05*cos(3*t)}\n"
    _, _, path, _ = made("{thickness: 0.25, bore: 0.5}", tmp_path, 0.001, cam=cam)
    assert read_solid(path).z_max == pytest.approx(6.35, abs=1e-12)


# --- other people's files ---------------------------------------------------------------------------------------------


def test_units_components_and_the_object_s_name(plain):
    recipe, design, path, _ = plain
    vertex = rf'<vertex x="({NUMBER})" y="({NUMBER})" z="({NUMBER})"/>'

    def in_centimetres(text):
        text = text.replace('"millimeter"', '"centimeter"')
        return re.sub(
            vertex, lambda m: '<vertex x="{!r}" y="{!r}" z="{!r}"/>'.format(*(float(v) / 10 for v in m.groups())), text
        )

    assert failures(rewritten(path, in_centimetres), recipe, design) == set()

    def in_two_steps(text):
        """Ten times too large, and scaled back as a component."""
        text = re.sub(
            vertex, lambda m: '<vertex x="{!r}" y="{!r}" z="{!r}"/>'.format(*(float(v) * 10 for v in m.groups())), text
        )
        inner = '<component objectid="1" transform=".1 0 0 0 .1 0 0 0 .1 0 0 0"/>'
        group = f'<object id="2" name="group"><components>{inner}</components></object></resources>'
        return text.replace("</resources>", group).replace('<item objectid="1"/>', '<item objectid="2"/>')

    assert failures(rewritten(path, in_two_steps), recipe, design) == set()


def two_objects(text, second):
    mesh = re.search(r"<mesh>.*</mesh>", text, re.DOTALL).group(0)
    text = text.replace("</resources>", f'<object id="2" name="{second}">{mesh}</object></resources>')
    return text.replace('<item objectid="1"/>', '<item objectid="1"/><item objectid="2"/>')


def test_of_several_objects_the_one_that_is_named_cam(plain):
    recipe, design, path, _ = plain
    assert failures(rewritten(path, lambda text: two_objects(text, "frame")), recipe, design) == set()
    with pytest.raises(ReadError, match=r"2 objects are built, 'cam', 'cam': one of them should be named 'cam'"):
        read_3mf(rewritten(path, lambda text: two_objects(text, "cam")))
    with pytest.raises(ReadError, match=r"2 objects are built, 'disc', 'frame'"):
        read_3mf(rewritten(path, lambda text: two_objects(text.replace('name="cam"', 'name="disc"'), "frame")))


BAD = {
    "no model": (lambda _: "<x/>", "there is no model"),
    "another namespace": (lambda text: text.replace("/core/2015/02", "/core/2013/01"), "there is no model"),
    "not closed": (lambda text: text[:-20], "is not sound"),
    "a document type": (
        lambda text: text.replace("<model", '<!DOCTYPE model [<!ENTITY a "aaaa">]>\n<model', 1),
        "a document type of its own",
    ),
    "nothing built": (lambda text: text.replace('<item objectid="1"/>', ""), "no object is built"),
    "support built": (lambda text: text.replace('type="model"', 'type="support"'), "no object is built"),
    "another object built": (
        lambda text: text.replace('<item objectid="1"/>', '<item objectid="7"/>'),
        "no object '7'",
    ),
    "an object twice": (
        lambda text: text.replace("</resources>", '<object id="1"/></resources>'),
        "'1' is there twice",
    ),
    "no triangles": (lambda text: re.sub(r"<triangle [^>]*>", "", text), "holds no triangles"),
    "a corner too many": (lambda text: re.sub(r'v1="\d+"', 'v1="99999999"', text, count=1), "none of the"),
    "a corner below": (
        lambda text: re.sub(r'v1="\d+"', 'v1="-1"', text, count=1),
        "not the number of a vertex",
    ),
    "no number": (lambda text: re.sub(rf'x="{NUMBER}"', 'x="nan"', text, count=1), "x='nan' is not a number"),
    "a comma": (lambda text: re.sub(rf'x="{NUMBER}"', 'x="1,5"', text, count=1), "x='1,5' is not a number"),
    "a digit of another script": (
        lambda text: re.sub(r'v1="\d+"', 'v1="٣"', text, count=1),
        "is not the number of a vertex",
    ),
    "out of range": (lambda text: re.sub(rf'x="{NUMBER}"', 'x="1e300"', text, count=1), "out of range"),
    "a coordinate missing": (lambda text: re.sub(rf'x="{NUMBER}" ', "", text, count=1), "x='' is not a number"),
    "a unit unknown": (lambda text: text.replace('"millimeter"', '"furlong"'), "the unit 'furlong'"),
    "an extension required": (
        lambda text: text.replace("<model ", '<model requiredextensions="p" xmlns:p="http://p" ', 1),
        "requires extensions, 'p'",
    ),
    "a place of eleven numbers": (placed("1 0 0 0 1 0 0 0 1 0 0"), "not twelve numbers"),
    "a flat place": (placed("1 0 0 0 1 0 0 0 0 0 0 0"), "is flat"),
    "a place far away": (placed("1 0 0 0 1 0 0 0 1 1e30 0 0"), "out of range"),
    "a component of itself": (
        lambda text: text.replace("<mesh>", '<components><component objectid="1"/></components><mesh>', 1),
        "hold themselves",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_a_damaged_model_is_told(plain, name):
    recipe, design, path, _ = plain
    change, message = BAD[name]
    spoilt = rewritten(path, change)
    with pytest.raises(ReadError) as caught:
        read_3mf(spoilt)
    assert message in str(caught.value)
    assert failures(spoilt, recipe, design) == {"readable"}


def archive_of(path, members):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return path


def test_archives_that_are_none(tmp_path, plain):
    _, _, sound, _ = plain
    with zipfile.ZipFile(sound) as archive:
        links = archive.read("_rels/.rels")
    cam = tmp_path / "cam.3mf"
    cases = [
        (lambda: cam.write_bytes(b""), "not a sound 3MF"),
        (lambda: cam.write_bytes(sound.read_bytes()[:-400]), "not a sound 3MF"),
        (lambda: archive_of(cam, {"a": "b"}), "the archive has no _rels/.rels"),
        (lambda: archive_of(cam, {"_rels/.rels": links}), f"the archive has no {MODEL}"),
        (lambda: archive_of(cam, {"_rels/.rels": "<x/>"}), "names 0 models"),
    ]
    for write, message in cases:
        write()
        with pytest.raises(ReadError, match=re.escape(message)):
            read_3mf(cam)
    data = bytearray(sound.read_bytes())
    data[len(data) // 2] ^= 0xFF
    cam.write_bytes(data)
    with pytest.raises(ReadError, match=r"is not sound|not a sound 3MF"):
        read_3mf(cam)


def test_archives_that_unpack_without_end(plain, monkeypatch):
    _, _, sound, _ = plain
    monkeypatch.setattr("kin.read.mesh.threemf.MOST_BYTES", 1 << 20)
    spoilt = rewritten(sound, lambda text: text.replace("<resources>", "<resources>" + " " * (1 << 20), 1))
    assert spoilt.stat().st_size < 1 << 16
    with pytest.raises(ReadError, match=r"unpacks to more than \d+ bytes: .*, and 1048576 in all, are read"):
        read_3mf(spoilt)


def towered(text, storeys):
    """Sixteen of sixteen of sixteen and so on of the first object."""
    for k in range(2, storeys + 2):
        held = f'<component objectid="{k - 1}"/>' * 16
        text = text.replace("</resources>", f'<object id="{k}"><components>{held}</components></object></resources>')
    return text.replace('<item objectid="1"/>', f'<item objectid="{storeys + 1}"/>')


def test_components_that_multiply(plain, monkeypatch):
    _, _, sound, _ = plain
    monkeypatch.setattr("kin.read.mesh.threemf.MOST_TRIANGLES", 1 << 16)

    with pytest.raises(ReadError, match="more than 65536 triangles"):
        read_3mf(rewritten(sound, lambda text: towered(text, 3)))


def test_components_that_multiply_nothing(plain):
    _, _, sound, _ = plain

    def hollow(text):
        return towered(re.sub(r"<mesh>.*</mesh>", "", text, flags=re.DOTALL), 12)

    with pytest.raises(ReadError, match="or 16384 components"):
        read_3mf(rewritten(sound, hollow))


def test_places_that_multiply(plain):
    """Each place is within measure, and what they make together is not."""
    _, _, sound, _ = plain

    def grown(text):
        held = '<component objectid="1" transform="1e7 0 0 0 1e7 0 0 0 1e7 0 0 0"/>'
        text = text.replace("</resources>", f'<object id="2"><components>{held}</components></object></resources>')
        return text.replace('<item objectid="1"/>', '<item objectid="2"/>')

    with pytest.raises(ReadError, match="reaches out of range"):
        read_3mf(rewritten(sound, grown))


def test_assertions_of_one_s_own_take_it(plain):
    recipe, _, path, _ = plain
    assert testing.assert_watertight(path) == pytest.approx(read_3mf(path).volume)
    assert testing.assert_closed(path) == 0.0
    assert testing.assert_motion(recipe, path, tolerance=0.01).max < 0.01
    with pytest.raises(AssertionError, match="3 edges with one triangle"):
        testing.assert_watertight(rewritten(path, removed))


# --- the command ------------------------------------------------------------------------------------------------------

RECIPE = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 10}\n"


def test_export_and_verify(tmp_path, capsys):
    recipe = tmp_path / "disc.yaml"
    recipe.write_text(f"{RECIPE}export: {{files: [3mf, {{stl: {{tolerance: 0.01}}}}]}}\nverify: {{angles: 72}}\n")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 0
    assert "3mf " in capsys.readouterr().out
    made = tmp_path / "out" / "disc" / "disc.3mf"
    assert main(["verify", str(recipe), str(made)]) == 0
    spoilt = rewritten(made, FAULTS["inches"][0])
    assert main(["verify", str(recipe), str(spoilt)]) == 1
    assert "contour" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ("[{3mf: {tolerence: 0.1}}]", "tolerence: unknown key"),
        ("[{3mf: {parts: some}}]", "give cam or all"),  # needs: mechanism
        ("[{3mf: {as: arcs}}]", "as: unknown key"),
        ("[3MF]", "unknown file format, given '3MF'"),
        ("[{3mf: {tolerance: 1.0e-10}}]", "rounding to nine decimals alone moves points by 7.07e-10 mm"),
    ],
)
def test_options_that_are_wrong(tmp_path, capsys, files, message):
    recipe = tmp_path / "disc.yaml"
    recipe.write_text(f"{RECIPE}export: {{files: {files}}}\n")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 2
    assert message in capsys.readouterr().err


def test_a_3mf_needs_a_thickness(tmp_path, capsys):
    recipe = tmp_path / "disc.yaml"
    recipe.write_text("cam: {kind: support, p: 25 + 2*cos(3*t)}\nexport: {files: [3mf]}\n")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 2
    assert "3mf needs a thickness; give part.thickness, or leave 3mf out" in capsys.readouterr().err


@pytest.mark.parametrize("encoding", ["rot13", "cp99999", "utf-7", "idna", "hex"])
def test_encodings_that_are_none_or_are_not_read(plain, encoding):
    recipe, _, sound, _ = plain
    spoilt = rewritten(sound, lambda text: text.replace('encoding="UTF-8"', f'encoding="{encoding}"', 1))
    with pytest.raises(ReadError, match=r"3dmodel\.model is not sound: "):
        read_3mf(spoilt)
    report = judge_files(recipe, [spoilt])
    assert [check["name"] for check in report["checks"] if not check["ok"]] == ["readable"]


def test_a_directory_that_points_before_the_file_is_a_damaged_archive(tmp_path, plain):
    data = bytearray(plain[2].read_bytes())
    end = data.rindex(b"PK\x05\x06") + 16  # where the directory begins, of four bytes
    data[end : end + 4] = (int.from_bytes(data[end : end + 4], "little") + (1 << 30)).to_bytes(4, "little")
    path = tmp_path / "cam.3mf"
    path.write_bytes(data)
    with pytest.raises(ReadError, match="its archive is damaged"):
        read_3mf(path)
