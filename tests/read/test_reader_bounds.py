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
