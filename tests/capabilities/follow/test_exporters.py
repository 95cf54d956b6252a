"""Drawings in the manner of ten CAD exporters, each unlike the others, are followed at the first try.

Holds: kin.read.drawing.about_shaft.
"""

from __future__ import annotations

import math
import random
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.heavy import ezdxf

import camgeo
from camgeo.cli.main import main

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

# two circles and their outer tangents: base circle, nose, distance of their centres; the lift is 10 under any roller
BASE, NOSE, APART = 20.0, 6.0, 24.0
TANGENT = math.acos((BASE - NOSE) / APART)
BULGES = math.tan(0.5 * (math.pi - TANGENT)), math.tan(0.5 * TANGENT)
MILLIMETRES, INCHES = 4, 1


def corners(scale: float = 1.0, digits: int = 17, turn: float = 0.0) -> list[tuple[float, float]]:
    """Ends of the tangents: on the base circle and on the nose above, on the nose and on the base circle below."""
    c, s = math.cos(TANGENT), math.sin(TANGENT)
    plain = [(BASE * c, BASE * s), (APART + NOSE * c, NOSE * s), (APART + NOSE * c, -NOSE * s), (BASE * c, -BASE * s)]
    cos, sin = math.cos(turn), math.sin(turn)
    return [(round(scale * (cos * x - sin * y), digits), round(scale * (sin * x + cos * y), digits)) for x, y in plain]


def loose(
    block: Any, *, scale: float = 1.0, digits: int = 17, turn: float = 0.0, at: Any = (0.0, 0.0), **on: Any
) -> None:
    """Draw the cam by two LINE and two ARC, in any order and direction."""
    points = [(x + at[0], y + at[1]) for x, y in corners(scale, digits, turn)]
    degrees, turned = math.degrees(TANGENT), math.degrees(turn)
    nose = round(scale * APART * math.cos(turn), digits) + at[0], round(scale * APART * math.sin(turn), digits) + at[1]
    first, last = round((degrees + turned) % 360.0, digits), round((turned - degrees) % 360.0, digits)
    draws = [
        lambda: block.add_line(points[1], points[0], dxfattribs=on),
        lambda: block.add_line(points[2], points[3], dxfattribs=on),
        lambda: block.add_arc(at, round(scale * BASE, digits), first, last, dxfattribs=on),
        lambda: block.add_arc(nose, round(scale * NOSE, digits), last, first, dxfattribs=on),
    ]
    for draw in random.Random(1).sample(draws, 4):
        draw()


def document(version: str, units: int = MILLIMETRES) -> Any:
    made = ezdxf.new(version, setup=True)
    made.header["$INSUNITS"] = units
    return made


def round_cam(count: int) -> np.ndarray:
    """Points (n, 2) at 30 + 5 cos t from the shaft."""
    t = 2.0 * np.pi * np.arange(count) / count
    return (30.0 + 5.0 * np.cos(t))[:, None] * np.column_stack([np.cos(t), np.sin(t)])


def autocad(path: Path) -> None:
    """Loose entities; centre lines, dimensions, hatches, notes and a construction line, some on the outline's layer."""
    made = document("R2010")
    for name, line in (("CENTER", "CENTER"), ("DIM", "Continuous"), ("OUTLINE", "Continuous")):
        made.layers.add(name, linetype=line)
    space, on = made.modelspace(), {"layer": "OUTLINE"}
    loose(space, **on)
    space.add_circle((0, 0), 6, dxfattribs=on)
    for a, b in (((-30, 0), (40, 0)), ((0, -30), (0, 30))):
        space.add_line(a, b, dxfattribs={"layer": "CENTER"})
    space.add_xline((0, 0), (1, 1), dxfattribs=on)
    space.add_linear_dim(base=(0, -40), p1=(-20, 0), p2=(30, 0), dxfattribs={"layer": "DIM"}).render()
    space.add_hatch(dxfattribs=on).paths.add_polyline_path([(-20, 0), (0, 20), (30, 0), (0, -20)])
    space.add_mtext("CAM 1", dxfattribs=on)
    made.saveas(path)


def release_12(path: Path) -> None:
    """A POLYLINE with bulges of four decimals that ends where it begins and is not flagged closed; no header."""
    up, top, low, down = corners(digits=4)
    vertices = [(up, BULGES[0]), (down, 0.0), (low, BULGES[1]), (top, 0.0), (up, 0.0)]
    text = ["0", "SECTION", "2", "ENTITIES", "0", "POLYLINE", "8", "0", "66", "1", "70", "0"]
    for (x, y), bulge in vertices:
        text += f"0 VERTEX 8 0 10 {x:.4f} 20 {y:.4f} 30 0.0000 42 {bulge:.6f}".split()
    circle = "0 SEQEND 8 0 0 CIRCLE 8 0 10 0.0000 20 0.0000 40 6.0000 0 ENDSEC 0 EOF"
    text += circle.split()
    path.write_text("\n".join([*text, ""]))


def inches(path: Path) -> None:
    """LWPOLYLINE of six decimals, clockwise, in inches; a bore with a keyway in one polyline of its own."""
    made, one = document("R2000", INCHES), 1.0 / 25.4
    up, top, low, down = corners(one, 6)
    rows = [(*down, -BULGES[0]), (*up, 0.0), (*top, -BULGES[1]), (*low, 0.0)]
    made.modelspace().add_lwpolyline(np.round(rows, 6).tolist(), format="xyb", close=True)
    wide, bore = 0.08, 0.25
    x, bulge = math.sqrt(bore**2 - wide**2), -math.tan(0.5 * (math.pi - math.asin(wide / bore)))
    rows = [(x, wide, 0.0), (0.3, wide, 0.0), (0.3, -wide, 0.0), (x, -wide, bulge)]
    made.modelspace().add_lwpolyline(np.round(rows, 6).tolist(), format="xyb", close=True)
    made.saveas(path)


def rhino(path: Path) -> None:
    """One closed periodic SPLINE with knots that are not clamped."""
    points, made = round_cam(96), document("R2007")
    spline = made.modelspace().add_spline(dxfattribs={"flags": 11})
    spline.control_points = np.column_stack([np.vstack([points, points[:3]]), np.zeros(99)])
    spline.knots = np.arange(-3.0, 100.0).tolist()
    made.modelspace().add_circle((0, 0), 8)
    made.modelspace().add_point((0, 0))
    made.saveas(path)


def on_a_sheet(path: Path) -> None:
    """Halves of an ELLIPSE with parameters of six decimals; the frame and the title block of the sheet round it."""
    made = document("R2010")
    space, on = made.modelspace(), {"layer": "VISIBLE"}
    for first, last in ((0.0, 3.141593), (3.141593, 6.283185)):
        space.add_ellipse((0, 0), (30, 0), 0.666667, first, last, dxfattribs=on)
    frame = [(-148, -105), (149, -105), (149, 105), (-148, 105), (-148, -105)]
    for a, b in [*pairwise(frame), ((50, -105), (50, -80)), ((50, -80), (149, -80))]:
        space.add_line(a, b, dxfattribs={"layer": "BORDER"})
    made.saveas(path)


def in_blocks(path: Path) -> None:
    """A block in inches within another one, mirrored and turned, its base point off the shaft, at 100, 50."""
    made = document("R2013")
    inner, outer = made.blocks.new("NOCKEN"), made.blocks.new("ASSY")
    inner.block.dxf.base_point = (1, 1, 0)
    loose(inner, scale=1.0 / 25.4, at=(1.0, 1.0))
    outer.add_blockref("NOCKEN", (2, 0), dxfattribs={"xscale": -1, "rotation": 30})
    scale = dict.fromkeys(("xscale", "yscale", "zscale"), 25.4)
    made.modelspace().add_blockref("ASSY", (100 - 2 * 25.4, 50), dxfattribs=scale)
    made.saveas(path)


def stretched(path: Path) -> None:
    """Two ARC in a block that is stretched along x, which makes an ellipse of them."""
    made = document("R2018")
    unit = made.blocks.new("UNIT")
    unit.add_arc((0, 0), 1, 0, 180)
    unit.add_arc((0, 0), 1, 180, 360)
    made.modelspace().add_blockref("UNIT", (0, 0), dxfattribs={"xscale": 30, "yscale": 20})
    made.modelspace().add_circle((0, 0), 6)
    made.saveas(path)


def construction(path: Path) -> None:
    """Base circle and pitch curve in dashes on the outline's layer; full circles and spokes on another, over it."""
    made = document("R2010")
    space, on = made.modelspace(), {"layer": "CONSTRUCTION"}
    loose(space, digits=6)
    space.add_circle((0, 0), 20, dxfattribs={"linetype": "DASHED"})
    space.add_circle((0, 0), 25, dxfattribs={"linetype": "DASHDOT"})
    space.add_circle((0, 0), 5, dxfattribs={"layer": "HOLES"})
    for centre, radius in (((APART, 0), NOSE), ((0, 0), BASE)):
        space.add_circle(centre, radius, dxfattribs=on)
    for k in range(12):
        space.add_line((0, 0), (35 * math.cos(k * math.pi / 6), 35 * math.sin(k * math.pi / 6)), dxfattribs=on)
    made.saveas(path)


def several(path: Path) -> None:
    """Three cams on a sheet, each with its bore, and centre marks of full lines."""
    made = document("R2010")
    space = made.modelspace()
    for k, (x, y) in enumerate(((0.0, 0.0), (90.0, 0.0), (180.0, 10.0))):
        loose(space, digits=6, turn=0.7 * k, at=(x, y))
        space.add_circle((x, y), 6)
        for a, b in (((x - 35, y), (x + 35, y)), ((x, y - 35), (x, y + 35))):
            space.add_line(a, b, dxfattribs={"layer": "MITTE"})
    made.saveas(path)


def in_space(path: Path) -> None:
    """A polyline in space at one height, through points of three decimals; a centre mark on its layer; no header."""
    points = round_cam(720)
    text = ["0", "SECTION", "2", "ENTITIES", "0", "POLYLINE", "8", "Cam", "66", "1", "70", "8"]
    for x, y in [*points.tolist(), points[0].tolist()]:
        text += f"0 VERTEX 8 Cam 70 32 10 {x:.3f} 20 {y:.3f} 30 0.000".split()
    text += ["0", "SEQEND", "8", "Cam"]
    for x, y in ((3, 0), (0, 3)):
        text += f"0 LINE 8 Cam 10 {-x} 20 {-y} 11 {x} 21 {y}".split()
    path.write_text("\n".join([*text, "0", "ENDSEC", "0", "EOF", ""]))


EXPORTERS: dict[Callable[[Path], None], tuple[dict[str, Any], float]] = {
    autocad: ({}, 1e-9),
    release_12: ({"units": "mm"}, 1e-4),
    inches: ({}, 1e-4),
    rhino: ({}, 0.02),
    on_a_sheet: ({}, 1e-4),
    in_blocks: ({"at": (100.0, 50.0)}, 1e-9),
    stretched: ({}, 1e-9),
    construction: ({}, 1e-5),
    several: ({"at": (90.0, 0.0)}, 1e-5),
    in_space: ({"units": "mm"}, 2e-3),
}


@pytest.mark.thin(4)
@pytest.mark.parametrize("draw", EXPORTERS)
def test_each_is_followed_at_the_first_try(tmp_path: Path, draw: Callable[[Path], None]) -> None:
    draw(path := tmp_path / "cam.dxf")
    how, near = EXPORTERS[draw]
    followed = camgeo.follow(path, roller=5.0, steps=72, **how)
    assert followed.lift == pytest.approx(10.0, abs=near)
    assert followed.base_radius == pytest.approx(25.0 if draw in {rhino, in_space} else 20.0, abs=max(near, 1e-4))


def test_the_place_of_a_shaft_in_a_drawing_without_a_unit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """First the unit, then the place, as options that the next call takes; a verdict has no such option."""
    path = tmp_path / "cam.dxf"
    made = document("R2010")
    made.header["$INSUNITS"] = 0
    turn = np.linspace(0.0, 2.0 * math.pi, 360, endpoint=False)
    reach = 1.5 + 0.2 * np.cos(turn)  # inches
    places = np.column_stack([3.0 + reach * np.cos(turn), 2.0 + reach * np.sin(turn)])
    made.modelspace().add_lwpolyline(places.tolist(), close=True)
    made.modelspace().add_circle((3.0, 2.0), 0.25)
    made.modelspace().add_line((0.0, 2.0), (6.0, 2.0), dxfattribs={"layer": "AXES"})
    made.saveas(path)
    call = ["follow", str(path), "--roller", "0.375in"]
    assert main(call) == 2
    assert capsys.readouterr().err.endswith("the drawing states no unit: give units, such as --units mm\n")
    assert main([*call, "--units", "inch"]) == 2
    told = capsys.readouterr().err
    assert told.endswith("; it has a cam at 76.2,50.8: give one of these as at, such as --at 76.2,50.8\n")
    for place in ("76.2,50.8", "3in,2in"):
        assert main([*call, "--units", "inch", "--at", place]) == 0
        words = capsys.readouterr().out
        assert "roller of radius 9.525 mm on a stem" in words
        lift = float(words.partition("  lift ")[2].partition(" mm")[0])
        assert lift == pytest.approx(10.16, abs=2e-3)  # 0.4 in between both places on its axis, but for the chords
    recipe = tmp_path / "round.yaml"
    recipe.write_text(
        "cam: {kind: disc, base_radius: 33.02, follower: {kind: roller, radius: 9.525},\n"
        "  motion: {formula: 1 - cos(t)}}\n"
        "verify: {openings: ignore}\n",
        encoding="utf-8",
    )
    assert main(["verify", str(recipe), str(path), "--units", "inch"]) == 1
    assert "; move the cam in its file until its shaft is there" in capsys.readouterr().out


@pytest.mark.parametrize("text", ["0.3xx", "5 degrees", "1e", ""])
def test_what_is_no_length(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["follow", "cam.dxf", "--roller", text])
    assert "a length in mm or with its unit is expected, such as 9.525 or 0.375in, not" in capsys.readouterr().err


def test_what_is_passed_over_is_told_and_other_cams_by_their_places(tmp_path: Path) -> None:
    on_a_sheet(path := tmp_path / "cam.dxf")
    joined, passed = camgeo.follow(path, roller=5.0, steps=72).remarks
    assert joined == "ends up to 6.14e-06 mm apart are joined, as the digits or the size of the drawing explain"
    assert passed == "what is no part of the cam is passed over: 6 LINE on BORDER"
    construction(path)
    assert camgeo.follow(path, roller=5.0, steps=72).bore == pytest.approx(10.0)
    several(path)
    with pytest.raises(camgeo.CallError, match=r"it has 3 cams, at 0,0 and 90,0 and 180,10: give one of these"):
        camgeo.follow(path, roller=5.0, at=(5.0, 50.0))


def test_a_recipe_of_a_file_judges_it_without_what_is_no_part_of_the_cam(tmp_path: Path) -> None:
    path = tmp_path / "cam.dxf"
    made = document("R2010")
    loose(made.modelspace(), layer="PART")
    made.modelspace().add_line((-50, 1), (50, 1), dxfattribs={"layer": "CENTER"})
    made.modelspace().add_line((10, 10), (40, 35), dxfattribs={"layer": "DIM"})
    made.saveas(path)
    followed = camgeo.follow(path, roller=5.0)
    (tmp_path / "lifts.csv").write_text(followed.lifts())
    (tmp_path / "cam.yaml").write_text(followed.recipe("lifts.csv"))
    recipe = camgeo.load(tmp_path / "cam.yaml")
    report = camgeo.verify(recipe, path)
    assert report.ok
    (told,) = (remark.sentence for remark in report.remarks if remark.name == "openings")
    assert "what is no part of the cam in cam.dxf is passed over, 1 LINE on CENTER, 1 LINE on DIM" in told
    strict = camgeo.verify(recipe.replace("verify.openings", "judge"), path)
    (closed,) = (check for check in strict.checks if not check.ok)
    assert closed.name == "closed"
    assert "verify: {openings: ignore} passes over what is no part of the cam" in closed.detail


def pitch_curve(path: Path) -> None:
    """The pitch curve of a roller of 5 mm in full lines on a layer of its own, round the cam."""
    made = document("R2010")
    loose(made.modelspace(), layer="PROFILE")
    c, s = math.cos(TANGENT), math.sin(TANGENT)
    ends = [((BASE + 5) * c, (BASE + 5) * s), (APART + (NOSE + 5) * c, (NOSE + 5) * s)]
    ends += [(x, -y) for x, y in reversed(ends)]
    rows = [(x, y, bulge) for (x, y), bulge in zip(ends, (0.0, -BULGES[1], 0.0, -BULGES[0]), strict=True)]
    made.modelspace().add_lwpolyline(rows, format="xyb", close=True, dxfattribs={"layer": "PITCH"})
    made.saveas(path)


def test_an_outer_contour_on_another_layer_than_the_next_is_told(tmp_path: Path) -> None:
    pitch_curve(path := tmp_path / "cam.dxf")
    told = (
        "followed is the outermost contour, on layer PITCH; on layer PROFILE another one goes round the shaft within it"
    )
    assert told in camgeo.follow(path, roller=5.0, steps=72).remarks
    (tmp_path / "cam.yaml").write_text(
        "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 5},"
        " motion: {contour: cam.dxf, reading: 0.05}}\n"
    )
    report = camgeo.check(tmp_path / "cam.yaml")
    assert any(told in remark.sentence for remark in report.remarks)


@pytest.mark.slow
def test_a_layer_of_duplicates_alone_is_passed_over(tmp_path: Path) -> None:
    made = document("R2010")
    for layer in ("PART", "COPY"):
        made.modelspace().add_line(*corners()[:2], dxfattribs={"layer": layer})
    loose(made.modelspace(), layer="PART")
    made.modelspace().add_line((50, 50), (60, 50), dxfattribs={"layer": "NOTE"})
    made.saveas(tmp_path / "cam.dxf")
    assert camgeo.follow(tmp_path / "cam.dxf", roller=5.0, steps=72).lift == pytest.approx(10.0)


@pytest.mark.parametrize("corner", [0.0, 10.0])
def test_a_frame_is_no_cam_whether_it_is_closed_or_open(tmp_path: Path, corner: float) -> None:
    made = document("R2010")
    loose(made.modelspace(), layer="PART")
    for x, y, x2, y2 in ((-1, -1, 1, -1), (1, -1, 1, 1), (1, 1, -1, 1), (-1, 1, -1, -1)):
        inward = corner * np.sign([x2 - x, y2 - y])
        ends = np.array([x, y]) * 90.0 + inward, np.array([x2, y2]) * 90.0 - inward
        made.modelspace().add_line(*ends, dxfattribs={"layer": "SHEET"})
    made.saveas(tmp_path / "cam.dxf")
    assert camgeo.follow(tmp_path / "cam.dxf", roller=5.0, steps=72).lift == pytest.approx(10.0)


@pytest.mark.parametrize("bore", ["OUTLINE", "BORE"])
def test_an_open_outline_is_not_passed_over_for_its_bore(tmp_path: Path, bore: str) -> None:
    """The bore goes round the shaft, is no circle and closed; it is still no cam, on the outline's layer or another."""
    made = document("R2010")
    points = round_cam(90)
    for a, b in zip(points[:-1].tolist(), points[1:].tolist(), strict=True):
        made.modelspace().add_line(a, b, dxfattribs={"layer": "OUTLINE"})
    keyed = [(5, -1), (7, -1), (7, 1), (5, 1), (0, 5.5), (-5.5, 0), (0, -5.5)]
    made.modelspace().add_lwpolyline(keyed, close=True, dxfattribs={"layer": bore})
    made.saveas(tmp_path / "cam.dxf")
    with pytest.raises(camgeo.CallError, match=r"a segment is missing.*give across arc or chord to close it there"):
        camgeo.follow(tmp_path / "cam.dxf", roller=3.0)
    for way in ("arc", "chord"):
        closed = camgeo.follow(tmp_path / "cam.dxf", roller=3.0, across=way, steps=36)
        assert closed.base_radius == pytest.approx(25.0, abs=0.02)
        assert closed.lift == pytest.approx(10.0, abs=0.02)


def test_a_drawing_that_is_open_is_closed_the_shorter_way_round(tmp_path: Path) -> None:
    """Whichever way the file runs round: 40 degrees of a circle about the shaft are missing, and the arc is its own."""
    t = np.radians(np.arange(20.0, 341.0, 1.0))
    for way in (1, -1):
        made = document("R2010")
        made.modelspace().add_lwpolyline((30.0 * np.column_stack([np.cos(t), np.sin(t)])[::way]).tolist())
        made.saveas(tmp_path / "cam.dxf")
        assert camgeo.follow(tmp_path / "cam.dxf", roller=3.0, across="arc", steps=36).lift < 0.002
