"""What a reader refuses before it costs much, and what grows no faster than the file: counted, not timed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.meshfiles import in_3mf, ring

from camgeo.cli.main import main
from kin.contour import intersections
from kin.contour.contour import Contour
from kin.contour.intersections import first_meeting
from kin.read.errors import ReadError
from kin.read.files import kind_of, read_drawing, read_solid
from kin.read.formats import FORMATS, contents, suffixes
from kin.read.gcode import read_gcode
from kin.read.mesh import threemf
from kin.read.mesh.mesh import Mesh
from kin.read.nesting import MOST_CONTOURS, nested
from kin.read.points import heading_of, read_points
from kin.read.step import part21

LONG = 100_000  # of one character: a pattern that passes over it again from each place would take minutes
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="-50 -50 100 100">'


def spoilt(path, more):
    """A 3MF whose model has more vertices behind its own."""
    import zipfile

    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name).decode() for name in archive.namelist()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(name, text.replace("</vertices>", more + "</vertices>"))
    return path


def test_vertices_that_no_triangle_has(tmp_path):
    path = in_3mf(tmp_path / "part.3mf", ring())
    few = "".join(f'<vertex x="{k}" y="0" z="99"/>' for k in range(900))
    assert read_solid(spoilt(path, few)).z_max == 8.0
    many = "".join(f'<vertex x="{math.sqrt(k)!r}" y="{math.sin(k)!r}" z="99"/>' for k in range(5000))
    with pytest.raises(ReadError, match=r"5900 of the 6380 vertices of object 'cam' belong to no triangle"):
        read_solid(spoilt(path, many))


@pytest.mark.slow
def test_what_packs_to_next_to_nothing(tmp_path):
    path = spoilt(in_3mf(tmp_path / "part.3mf", ring()), '<vertex x="0" y="0" z="0"/>' * 400_000)
    assert path.stat().st_size < 80_000
    with pytest.raises(ReadError, match=r"m.model unpacks to more than \d+ bytes: 50 times its packed size"):
        read_solid(path)


def test_an_object_is_put_together_once(tmp_path, monkeypatch):
    path = in_3mf(tmp_path / "part.3mf", ring())
    import zipfile

    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name).decode() for name in archive.namelist()}
    rows = "".join(f'<component objectid="1" transform="1 0 0 0 1 0 0 0 1 {99 * k} 0 0"/>' for k in range(50))
    more = f'<object id="2"><components>{rows}</components></object></resources>'
    with zipfile.ZipFile(path, "w") as archive:
        for name, text in parts.items():
            archive.writestr(name, text.replace("</resources>", more).replace('item objectid="1"', 'item objectid="2"'))
    calls = []
    used = threemf._Model._demand_used
    monkeypatch.setattr(threemf._Model, "_demand_used", lambda *given: calls.append(1) or used(*given))
    with pytest.raises(ReadError, match="it holds 50 bodies"):
        read_solid(path)
    assert len(calls) == 2


def test_more_contours_than_a_part_has(tmp_path):
    path = tmp_path / "cam.svg"
    holes = "".join(f'<circle cx="{-30 + k % 60}" cy="{-25 + k // 60}" r="0.2"/>' for k in range(MOST_CONTOURS))
    path.write_text(f'{HEAD}<circle r="49"/>{holes}</svg>')
    with pytest.raises(ReadError, match=f"it has {MOST_CONTOURS + 1} closed contours; up to {MOST_CONTOURS} are read"):
        read_drawing(path)


def test_contours_far_from_each_other_are_not_compared(tmp_path, monkeypatch):
    t = np.arange(12) * 2.0 * np.pi / 12
    around = np.column_stack([np.cos(t), np.sin(t)])
    contours = [Contour.from_vertices(90.0 * around)]
    contours += [Contour.from_vertices(0.3 * around + (k % 8, k // 8)) for k in range(64)]
    compared = []
    near = vars(intersections)["nearest"]
    monkeypatch.setattr(
        intersections, "nearest", lambda chain, points: compared.append(len(points)) or near(chain, points)
    )
    assert first_meeting(contours) is None
    assert sum(compared) == 64  # each hole with the outline alone
    assert nested(contours, tmp_path)[0].number == 0


def test_bodies_of_a_mesh_by_another_way():
    rng = np.random.default_rng(3)
    corners = rng.integers(0, 300, (150, 3))
    found = Mesh(np.zeros((300, 3)), corners).bodies
    group = {k: {k} for k in range(300)}
    for row in corners.tolist():
        whole = set().union(*(group[k] for k in row))
        for k in whole:
            group[k] = whole
    for a, one in zip(found, corners.tolist(), strict=True):
        for b, other in zip(found, corners.tolist(), strict=True):
            assert (a == b) == (group[one[0]] is group[other[0]])


@pytest.mark.slow
def test_pieces_drawn_over_one_another(tmp_path):
    path = tmp_path / "cam.svg"
    path.write_text(HEAD + '<circle r="20"/>' * 1200 + "</svg>")
    with pytest.raises(ReadError, match="more than 64 pieces are drawn over one another"):
        read_drawing(path)


@pytest.mark.parametrize("suffix", suffixes())
def test_a_file_is_refused_by_its_size_before_it_is_read(tmp_path, monkeypatch, capsys, suffix):
    """Two files with nearly nothing on disk, a byte too large and 3 GiB."""
    monkeypatch.chdir(tmp_path)
    path, kind = tmp_path / f"cam{suffix}", suffixes()[suffix]
    recipe = tmp_path / "cam.yaml"
    recipe.write_text("cam: {kind: support, p: 25 + 2*cos(3*t)}\n")
    others = {"dxf": read_drawing, "svg": read_drawing, "gcode": read_gcode, "csv": lambda path: contents(path, "csv")}
    read = others.get(kind_of(path), read_solid)
    for size, told in ((FORMATS[kind].most + 1, "MB are read"), (3 << 30, "3221 MB, and of a")):
        with path.open("wb") as stream:
            # a table of another heading may hold measured points, of which more are read
            stream.write(b"c_deg,x_mm\n" if kind == "csv" else b"")
            stream.truncate(size)
        with pytest.raises(ReadError, match=told):
            read(path)
        assert main(["verify", str(recipe), str(path)]) == 2
        assert told in capsys.readouterr().err


def test_a_drawing_of_more_pieces_than_a_contour_has(tmp_path, monkeypatch):
    corners = np.column_stack([np.cos(t := np.arange(100) / 50 * math.pi), np.sin(t)]).tolist()
    path = tmp_path / "cam.svg"
    whole = f'<path d="M{"L".join(f"{x!r} {y!r}" for x, y in corners)}Z"/>'
    loose = "".join(
        f'<path d="M{x!r} {y!r}L{u!r} {v!r}"/>'
        for (x, y), (u, v) in zip(corners, corners[1:] + corners[:1], strict=True)
    )
    for text in (whole, loose):
        path.write_text(f"{HEAD}{text}</svg>")
        assert len(read_drawing(path).contour) == 100
        with monkeypatch.context() as patch:
            patch.setattr("kin.read.nesting.MOST_PIECES", 99)
            patch.setattr("kin.read.drawing.svg_path.MOST_PIECES", 99)
            with pytest.raises(ReadError, match=r"more than 99 pieces|have 100 pieces; up to 99 are read"):
                read_drawing(path)


def test_items_and_components_that_repeat_a_mesh(tmp_path, monkeypatch):
    """A mesh through a component is no repetition; many items of it, or objects that hold it, are."""
    path = in_3mf(tmp_path / "part.3mf", ring())
    import zipfile

    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name).decode() for name in archive.namelist()}
    holder = '<object id="{}" name="cam"><components><component objectid="1"/></components></object>'
    ten = "".join(map(holder.format, range(2, 12)))
    cases = {
        (holder.format(2), '<item objectid="2"/>'): True,
        ("", '<item objectid="1"/>' * 10): False,
        (ten, "".join(f'<item objectid="{k}"/>' for k in range(2, 12))): False,
        (
            holder.format(2).replace('<component objectid="1"/>', '<component objectid="1"/>' * 10),
            '<item objectid="2"/>',
        ): False,
    }
    monkeypatch.setattr(threemf, "MOST_TRIANGLES", 100)
    for (objects, items), sound in cases.items():
        with zipfile.ZipFile(path, "w") as archive:
            for name, text in parts.items():
                held = text.replace("</resources>", f"{objects}</resources>")
                archive.writestr(name, held.replace('<item objectid="1"/>', items))
        if sound:
            assert len(threemf.read_placed(path)) == 1
        else:
            with pytest.raises(ReadError, match="more than 100 triangles or"):
                threemf.read_placed(path)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("lines.csv", "\n" * LONG),
        ("brackets.csv", f"x_mm{'(' * LONG},y\n1,2\n"),
        ("blanks.csv", f"x{' ' * LONG}(y,z\n1,2\n"),
        ("marks.csv", f"x{'_' * LONG}(,y\n1,2\n"),
        ("digits.csv", f"x,y\n{'1' * LONG}z,2\n"),
        ("label.dmi", f"FA({' ' * LONG}x\nFEAT"),
        ("units.dmi", f"FA(P)=FEAT/POINT,CART,1,2,3\n{' ' * LONG}UNITS"),
        ("continued.dmi", f"{'a$' * 10}\nFA(P)=FEAT{'$' + chr(10)}" * (LONG // 30)),
        ("width.svg", HEAD.replace("100mm", f"1{' ' * LONG}?", 1) + "</svg>"),
        ("box.svg", HEAD.replace("-50 -50", f"{'1' * LONG}?", 1) + "</svg>"),
        ("radius.svg", f'{HEAD}<circle r="{"1" * LONG}?"/></svg>'),
        ("string.step", f"ISO-10303-21;\nDATA;\n#1=A('{'a' * LONG});\nENDSEC;\nEND-ISO-10303-21;"),
    ],
)
def test_a_pattern_passes_over_a_file_once(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text, newline="")
    read = read_drawing if path.suffix == ".svg" else read_solid if path.suffix == ".step" else read_points
    with pytest.raises(ReadError):
        read(path)


@pytest.mark.slow
@pytest.mark.parametrize("character", [" ", "\n", "\t", "(", "[", "1", "'", '"', "a", "-", ",", "$", "_"])
@pytest.mark.parametrize("suffix", [*suffixes(), ".dmi"])
def test_a_megabyte_of_one_character_is_refused(tmp_path, suffix, character):
    path = tmp_path / f"cam{suffix}"
    path.write_text(character * 1_000_000, newline="")
    kind = suffixes().get(suffix, "csv")
    if kind == "csv":
        heading_of(path)
    others = {"dxf": read_drawing, "svg": read_drawing, "gcode": read_gcode, "csv": read_points}
    with pytest.raises(ReadError):
        others.get(kind, read_solid)(path)


def never(*_given, **_more):
    raise AssertionError("parsed before it was counted")


@pytest.mark.parametrize(
    "pieces", ["L1.5 2.5", " 1.5,2.5", " l 1 2", "H1", "C1 2 3 4 5 6", "C1 2 3 4 5 6 1 2 3 4 5 6", "A1 1 0 0 1 2 3"]
)
def test_pieces_of_a_path_are_counted_before_they_are_read(tmp_path, monkeypatch, pieces):
    path = tmp_path / "cam.svg"
    each = 2 if len(pieces) > 20 else 1
    monkeypatch.setattr("kin.read.drawing.svg_path.MOST_PIECES", 100)
    path.write_text(f'{HEAD}<path d="M 0 0{pieces * (100 // each)}"/></svg>')
    with pytest.raises(ReadError) as caught:  # the pieces make no contour
        read_drawing(path)
    assert "more than 100 pieces" not in str(caught.value)
    monkeypatch.setattr("kin.read.drawing.svg_path.pieces_of", never)
    path.write_text(f'{HEAD}<path d="M 0 0{pieces * 200}"/></svg>')
    with pytest.raises(ReadError, match="path #1: it has more than 100 pieces"):
        read_drawing(path)


def test_steps_of_a_transform_and_elements_are_counted_before_they_are_read(tmp_path, monkeypatch):
    path = tmp_path / "cam.svg"
    for steps in (1000, 1001):
        path.write_text(f'{HEAD}<circle r="5" transform="{"translate(0.001) " * steps}"/></svg>')
        if steps == 1000:
            assert read_drawing(path).contour.box.x_max == pytest.approx(6.0)
            continue
        with pytest.raises(ReadError, match="a transform has more than 1000 steps"):
            read_drawing(path)
    monkeypatch.setattr("kin.read.drawing.svg.MOST_PIECES", 10)
    monkeypatch.setattr("kin.read.drawing.svg.ET.fromstring", never)
    path.write_text(f"{HEAD}{'<g/>' * 20}</svg>")
    with pytest.raises(ReadError, match="the file has more than 10 elements"):
        read_drawing(path)


@pytest.mark.parametrize("row", ["1.5 2.5\n", " 1.5,2.5\r\n", "FA(P) = FEAT/POINT,CART,1.5,2.5,0\n"])
def test_measured_points_are_counted_before_they_are_read(tmp_path, monkeypatch, row):
    path = tmp_path / "points.csv"
    monkeypatch.setattr("kin.read.points.MOST_POINTS", 50)
    monkeypatch.setattr("kin.read.points.MOST_HEADINGS", 2)
    path.write_text("# of a machine\n\n" * 60 + row * 50, newline="")
    assert len(read_points(path)) == 50
    monkeypatch.setattr("kin.read.points.read_rows", never)
    monkeypatch.setattr("kin.read.points._dmis", never)
    path.write_text(row * 53, newline="")
    with pytest.raises(ReadError, match="more than 50 rows; up to 50 are read"):
        read_points(path)


@pytest.mark.parametrize("values", ["(" * LONG, "#1=A(" + "," * LONG, "#1=A(1,,2" + ",2" * LONG])
def test_an_exchange_file_is_read_no_further_than_its_first_fault(tmp_path, monkeypatch, values):
    places = []

    class Counted:
        def match(self, text, place):
            places.append(place)
            return token.match(text, place)

    token = part21.TOKEN
    monkeypatch.setattr(part21, "TOKEN", Counted())
    with pytest.raises(ReadError, match=r"expected|missing"):
        part21.exchange(f"{part21.BEGIN}\nDATA;\n{values}\nENDSEC;\n{part21.END}".encode(), tmp_path)
    assert len(places) < 100


@pytest.mark.slow  # a process of its own
def test_a_text_of_a_step_file_takes_memory_in_proportion_to_its_length():
    import subprocess
    import sys

    pytest.importorskip("resource")
    program = """
import resource
from pathlib import Path
from kin.read.step.part21 import BEGIN, END, exchange
resource.setrlimit(resource.RLIMIT_AS, (600_000_000, 600_000_000))
for letter in "a", "''":
    values = exchange(f"{BEGIN}DATA;#1=A('{letter * 5_000_000}');ENDSEC;{END}".encode(), Path("a.step")).instances
    print(len(values[1]["A"][0]))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["5000000", "5000000"]
