"""Which unit a file is judged in: the one that it states, the one that is given, and where both are at odds.

Holds: kin.read.drawing.svg.
"""

from __future__ import annotations

import pytest
from ezdxf.math import Matrix44
from support.heavy import ezdxf

from camgeo.cli.main import main
from kin.read.files import read_drawing, read_solid

RECIPE = """\
name: cam
cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [3, 2]}
part: {thickness: 8, bore: 10}
export: {tolerance: 0.01, files: [{dxf: {as: arcs, version: R12}}, stl, 3mf, svg]}
verify: {angles: 36}
"""


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    folder = tmp_path_factory.mktemp("units")
    (folder / "cam.yaml").write_text(RECIPE)
    assert main(["export", str(folder / "cam.yaml"), "--out", str(folder)]) == 0
    return folder


def verified(folder, name, *more):
    return main(["verify", str(folder / "cam.yaml"), str(folder / name), *more])


def saved_anew(folder, *, unit=0, scale=1.0, version="R12", name="anew.dxf", block=None):
    """The exported drawing, written by ezdxf; within a block that is inserted twice over where `block` says how."""
    old, new = ezdxf.readfile(folder / "cam" / "cam.dxf"), ezdxf.new(version)
    if version != "R12":
        new.header["$INSUNITS"] = unit
    into = new.modelspace() if block is None else new.blocks.new("CAM", base_point=(2.0, 1.0))
    for entity in old.modelspace():
        copy = entity.copy()
        copy.transform(Matrix44.scale(scale))
        into.add_foreign_entity(copy)
    if block is not None:
        inner, outer = block
        new.blocks.new("HOLDER").add_blockref("CAM", (0.0, 0.0), dxfattribs=inner)
        place = (-2.0 if "extrusion" in outer else 2.0, 1.0)
        new.modelspace().add_blockref("HOLDER", place, dxfattribs=outer)
    new.saveas(folder / name)
    return name


@pytest.mark.slow
def test_a_drawing_that_states_no_unit(exported, capsys):
    name = saved_anew(exported)
    assert read_drawing(exported / name).units_mm is None
    assert verified(exported, name) == 1
    said = capsys.readouterr().out
    assert said.count("\n") == 2
    assert "states no unit and is judged in that of the recipe, 1 mm; give it by --units, such as --units mm" in said
    assert verified(exported, name, "--units", "mm") == 0
    assert verified(exported, name, "--units", "inch") == 1


@pytest.mark.slow
def test_a_drawing_that_is_converted(exported, capsys):
    inch = saved_anew(exported, unit=1, scale=1 / 25.4, version="R2010", name="inch.dxf")
    assert verified(exported, inch) == 0
    assert verified(exported, inch, "--units", "inch") == 0
    silent = saved_anew(exported, unit=0, scale=1 / 25.4, version="R2010", name="silent.dxf")
    assert verified(exported, silent, "--units", "inch") == 0
    assert verified(exported, silent, "--units", "mm") == 1
    wrong = saved_anew(exported, unit=1, version="R2010", name="wrong.dxf")
    capsys.readouterr()
    assert verified(exported, wrong) == 1
    told = "a drawing unit is 25.4 mm, 1 mm is expected, as the size has it: save the file with its right unit\n"
    assert f"units (wrong.dxf): 24.4, at most 1e-09 allowed: {told}" in capsys.readouterr().out
    saved_anew(exported, unit=4, version="R2010", name="wrong.dxf")
    assert verified(exported, wrong) == 0


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", ["cam/cam.dxf", "cam/cam.3mf", "cam/cam.svg"])
def test_a_unit_that_is_given_beside_another_that_is_stated(exported, capsys, name):
    assert verified(exported, name, "--units", "mm") == 0
    capsys.readouterr()
    assert verified(exported, name, "--units", "inch") == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert "the file states its unit, 1 mm; 25.4 mm is given" in said.err
    assert "leave --units out, or save the file with its right unit\n" in said.err


def test_a_mesh_in_inches(exported):
    path = exported / "cam" / "cam.stl"
    raw = bytearray(path.read_bytes())
    import numpy as np

    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows = np.frombuffer(raw, record, offset=84).copy()
    rows["corners"] /= np.float32(25.4)
    (exported / "inch.stl").write_bytes(bytes(raw[:84]) + rows.tobytes())
    assert verified(exported, "inch.stl") == 1
    assert verified(exported, "inch.stl", "--units", "inch") == 0
    small, large = read_solid(exported / "inch.stl"), read_solid(exported / "inch.stl", [4.0], 25.4)
    assert large.volume == pytest.approx(25.4**3 * small.volume, rel=1e-12)
    assert [one.height for one in large.sections] == [4.0]


@pytest.mark.slow
@pytest.mark.parametrize(
    "block",
    [
        ({}, {}),
        ({"layer": "CUT"}, {"layer": "FRAME"}),
        ({"rotation": 30.0}, {"rotation": -30.0}),
        ({"xscale": 2.0, "yscale": 2.0}, {"xscale": 0.5, "yscale": 0.5, "rotation": 360.0}),
        ({"xscale": -1.0}, {"xscale": -1.0}),
        ({"xscale": -1.0}, {"extrusion": (0.0, 0.0, -1.0)}),
    ],
)
def test_a_contour_in_blocks(exported, block):
    name = saved_anew(exported, unit=4, version="R2010", name="block.dxf", block=block)
    assert verified(exported, name) == 0


def test_a_block_is_what_ezdxf_explodes_it_to(exported):
    inner = {"rotation": 25.0, "xscale": -1.5, "yscale": 1.5, "insert": (4.0, -7.0)}
    name = saved_anew(exported, unit=4, version="R2010", name="block.dxf", block=(inner, {"rotation": -70.0}))
    document = ezdxf.readfile(exported / name)
    found = read_drawing(exported / name)
    while inserts := document.modelspace().query("INSERT"):
        for one in inserts:
            one.explode()
    document.saveas(exported / "exploded.dxf")
    meant = read_drawing(exported / "exploded.dxf")
    assert found.contour.start == pytest.approx(meant.contour.start, abs=1e-10)
    assert found.contour.area == pytest.approx(meant.contour.area, rel=1e-12)


@pytest.mark.thin(3)
@pytest.mark.parametrize("outer", [{"rotation": 1.0}, {"xscale": 1.01, "yscale": 1.01}, {"xscale": -1.0}])
def test_a_block_that_moves_the_contour_is_caught(exported, outer):
    name = saved_anew(exported, unit=4, version="R2010", name="moved.dxf", block=({}, outer))
    assert verified(exported, name) == 1


@pytest.mark.thin(6)
@pytest.mark.parametrize(
    "transform",
    ["rotate(360)", "rotate(-90) rotate(90)", "rotate(20, 7, -3) rotate(-20, 7, -3)", "skewX(30) skewX(-30)",
     "skewY(10)skewX(0)skewY(-10)", "rotate(45) scale(2 2) rotate(-45) scale(.5)"],
)  # fmt: skip
def test_turns_and_skews_that_leave_a_drawing_where_it_is(exported, transform):
    text = (exported / "cam" / "cam.svg").read_text()
    path = exported / "turned.svg"
    path.write_text(text.replace('transform="', f'transform="{transform} '))
    assert path.read_text() != text
    assert verified(exported, "turned.svg") == 0
    path.write_text(text.replace('transform="', 'transform="rotate(1) '))
    assert verified(exported, "turned.svg") == 1
    assert read_drawing(path).contour.area == pytest.approx(
        read_drawing(exported / "cam" / "cam.svg").contour.area, rel=1e-12
    )
