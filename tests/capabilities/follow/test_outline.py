"""Outlines that a follower runs on: contours of a file that are none, and files without any."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.drawn import circle
from support.heavy import ezdxf

import camgeo
from camgeo.capabilities.follow.followed import judged_by_recipe

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.thin(2)
@pytest.mark.parametrize("by_layer", [True, False])
def test_centre_lines_are_no_outline(tmp_path: Path, *, by_layer: bool) -> None:
    document = ezdxf.new("R2010", setup=True)
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    space.add_lwpolyline(circle(720, 20.0, (5.0, 0.0)), close=True)
    document.layers.add("AXES", linetype="CENTER" if by_layer else "CONTINUOUS")
    space.add_line((-60, 0), (60, 0), dxfattribs={"layer": "AXES"} | ({} if by_layer else {"linetype": "CENTER"}))
    document.saveas(tmp_path / "axes.dxf")
    followed = camgeo.follow(tmp_path / "axes.dxf", flat=True)
    assert followed.lift == pytest.approx(10.0, abs=1e-3)
    assert judged_by_recipe(followed).ok
    for line in space.query("LINE"):
        line.dxf.layer, line.dxf.linetype = "0", "BYLAYER"
    document.saveas(tmp_path / "lines.dxf")
    followed = camgeo.follow(tmp_path / "lines.dxf", flat=True)
    assert followed.lift == pytest.approx(10.0, abs=1e-3)
    assert followed.remarks == ("what is no part of the cam is passed over: 1 LINE on 0",)
    assert judged_by_recipe(followed).ok


def test_a_unit_is_asked_for_beside_a_gap(tmp_path: Path) -> None:
    document = ezdxf.new("R12")
    document.modelspace().add_arc((0, 0), 1.0, 0.0, 179.0)
    document.modelspace().add_arc((0, 0), 1.0, 180.0, 0.0)
    document.saveas(tmp_path / "gap.dxf")
    with pytest.raises(camgeo.CallError, match=r"give gap 0\.018 to join them, and units mm, or another and"):
        camgeo.follow(tmp_path / "gap.dxf", flat=True)
    with pytest.raises(camgeo.CallError, match=r"give gap 0\.018 to join them$"):
        camgeo.follow(tmp_path / "gap.dxf", flat=True, units="mm")
    with pytest.raises(camgeo.CallError, match=r"give gap 0\.45 to join them"):
        camgeo.follow(tmp_path / "gap.dxf", flat=True, units="inch")


def test_a_drawing_of_dashed_lines_alone_has_no_outline(tmp_path: Path) -> None:
    document = ezdxf.new("R2010", setup=True)
    document.modelspace().add_circle((0, 0), 20, dxfattribs={"linetype": "DASHED"})
    document.saveas(tmp_path / "dashed.dxf")
    with pytest.raises(camgeo.CallError, match="the file holds 1 CIRCLE of line type DASHED on 0"):
        camgeo.follow(tmp_path / "dashed.dxf", flat=True)


def test_a_contour_within_a_round_outline_is_no_outer_one(tmp_path: Path) -> None:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    for radius, x in ((40.0, 0.0), (20.0, 5.0)):
        document.modelspace().add_circle((x, 0.0), radius)
    document.saveas(tmp_path / "ring.dxf")
    with pytest.raises(camgeo.CallError, match=r"lies within another contour: of a ring's opening give track internal"):
        camgeo.follow(tmp_path / "ring.dxf", roller=3.0)
    assert camgeo.follow(tmp_path / "ring.dxf", roller=3.0, track="internal").lift == pytest.approx(10.0)


def turned_solid(path: Path, rows: list[tuple[float, float, float]], eccentric: float) -> Path:
    """An STL of rows (radius, height, its swing round the axis), rising, about a centre that stands off the shaft."""
    phi = np.linspace(0.0, 2.0 * math.pi, 241)[:-1]
    rings = [
        np.stack([eccentric + r * np.cos(phi), r * np.sin(phi), z + swing * np.sin(phi)], axis=1)
        for r, z, swing in [(1e-9, rows[0][1], 0.0), *rows, (1e-9, rows[-1][1], 0.0)]
    ]
    rings[0], rings[-1] = (np.broadcast_to(ring.mean(axis=0), ring.shape) for ring in (rings[0], rings[-1]))
    corners = []
    for low, high in pairwise(rings):
        for a, b, c, d in zip(low, np.roll(low, -1, axis=0), high, np.roll(high, -1, axis=0), strict=True):
            corners += [(a, b, d), (a, d, c)]
    facets = [
        "outer loop " + " ".join(f"vertex {x!r} {y!r} {z!r}" for x, y, z in np.array(t).tolist())
        for t in corners
        if len({tuple(p) for p in np.array(t).tolist()}) == 3
    ]
    text = "".join(f"facet normal 0 0 0 {facet} endloop endfacet\n" for facet in facets)
    path.write_text(f"solid it\n{text}endsolid\n", encoding="ascii")
    return path


@pytest.mark.parametrize(
    ("rows", "disc"),
    [
        ([(20.0, 0.0, 0.0), (20.0, 10.0, 0.0)], True),
        # with a draft of 8.5 degrees, and with chamfers
        ([(20.0, 0.0, 0.0), (18.5, 10.0, 0.0)], True),
        ([(19.0, 0.0, 0.0), (20.0, 1.0, 0.0), (20.0, 9.0, 0.0), (19.0, 10.0, 0.0)], True),
        # the face of an end cam, which rises from one side to the other
        ([(20.0, 0.0, 0.0), (20.0, 4.5, 2.0), (15.0, 5.0, 2.0), (15.0, 10.0, 0.0)], False),
    ],
    ids=["upright", "drafted", "chamfered", "drum"],
)
def test_a_drum_is_no_disc(rows: list[tuple[float, float, float]], *, disc: bool, tmp_path: Path) -> None:
    """A contour that is another one just above its section is that of no disc; a drafted one is."""
    path = turned_solid(tmp_path / "it.stl", rows, 5.0)
    if disc:
        assert camgeo.follow(path, flat=True).lift == pytest.approx(10.0, abs=1e-2)
        return
    with pytest.raises(camgeo.CallError, match=r"no disc, its contour changes .*: camgeo verify RECIPE .*it\.stl$"):
        camgeo.follow(path, flat=True)
