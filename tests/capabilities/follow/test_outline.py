"""Outlines that a follower runs on: contours of a file that are none, and files without any."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.drawn import circle
from support.heavy import ezdxf

import camgeo
from camgeo.capabilities.follow.library import judged_by_recipe

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
