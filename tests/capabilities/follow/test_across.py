"""What `follow` says of contours that are open: a gap, a slot that reaches the shaft, points that are left out."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.heavy import ezdxf

import camgeo
from camgeo.capabilities.follow.followed import judged_by_recipe
from camgeo.cli.main import main

if TYPE_CHECKING:
    from pathlib import Path

RADIUS, ECCENTRIC, HALF = 20.0, 3.0, 3.0


def slot(path: Path, *, marked: bool = False) -> Path:
    """A round disc about (3, 0) with a slot to the shaft, and two bolt holes; `marked` by full centre lines."""
    made = ezdxf.new("R2010")
    made.header["$INSUNITS"] = 4
    space, out = made.modelspace(), ECCENTRIC - math.sqrt(RADIUS**2 - HALF**2)
    angle = 180.0 - math.degrees(math.asin(HALF / RADIUS))
    space.add_arc((ECCENTRIC, 0), RADIUS, -angle, angle)
    for y in (HALF, -HALF):
        space.add_line((out, y), (0, y))
        space.add_circle((5, 3.0 * y), 2)
    space.add_arc((0, 0), HALF, -90, 90)
    if marked:
        space.add_line((-40, 0), (40, 0), dxfattribs={"layer": "AXES"})
    made.saveas(path)
    return path


def rings(path: Path, gap: float, *, unit: int = 4) -> Path:
    """The same disc of six arcs without a slot, one of which begins `gap` mm too late."""
    made = ezdxf.new("R2010")
    made.header["$INSUNITS"] = unit
    made.modelspace().add_circle((0, 0), 5)
    for first in range(0, 360, 60):
        late = math.degrees(gap / RADIUS) if first == 120 else 0.0
        made.modelspace().add_arc((ECCENTRIC, 0), RADIUS, first + late, first + 60)
    made.saveas(path)
    return path


def points(path: Path, out: float = 0.0) -> Path:
    """Points of the disc without the last `out` degrees."""
    angle = np.radians(np.arange(0.0, 360.0 - out + 1e-9, 2.0)[: None if out else -1])
    x, y = ECCENTRIC + RADIUS * np.cos(angle), RADIUS * np.sin(angle)
    rows = "".join(f"{a:.6f},{b:.6f}\n" for a, b in zip(x, y, strict=True))
    path.write_text(f"x_mm,y_mm\n{rows}")
    return path


def test_a_slot_is_closed_as_asked_and_its_angles_are_judged_apart(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = slot(tmp_path / "slot.dxf")
    with pytest.raises(camgeo.CallError) as refused:
        camgeo.follow(path, roller=5.0)
    assert str(refused.value).endswith(
        "a slot reaches the shaft at 0, 0 mm: give across arc or chord to close the contour there"
    )
    marked = slot(tmp_path / "marked.dxf", marked=True)
    with pytest.raises(camgeo.CallError, match="a slot reaches the shaft at 0, 0 mm"):
        camgeo.follow(marked, roller=5.0)
    assert "1 LINE on AXES" in camgeo.follow(marked, roller=5.0, across="arc", steps=72).remarks[0]
    told = {}
    for way in ("arc", "chord"):
        followed = camgeo.follow(path, roller=5.0, across=way)
        ((begin, end),) = np.degrees(followed.unknown).tolist()
        assert (begin, 360.0 - end) == pytest.approx((end - 2.0 * (end - 180.0), begin), abs=1e-6)
        assert "nothing is known of the contour from 169.9 to 190.1 degrees" in followed.remarks[-1]
        assert main(["follow", str(path), "--roller", "5", "--across", way, "--json"]) == 0
        told[way] = json.loads(capsys.readouterr().out)
        (part,) = told[way]["across"]
        assert (part["start_deg"], part["end_deg"]) == (begin, end)
        # where it is known both are the disc's own
        assert told[way]["greatest"]["position"] == pytest.approx(28.0)
        assert told[way]["least"]["position"] > part["greatest"]
    assert told["arc"]["radius_of_curvature"]["value"] == pytest.approx(20.0)
    assert told["arc"]["across"][0]["least"] == pytest.approx(5.0 + math.hypot(math.sqrt(391.0) - 3.0, 3.0))
    assert told["chord"]["across"][0]["least"] == pytest.approx(5.0 + math.sqrt(391.0) - 3.0)
    with pytest.raises(camgeo.CallError, match="leave across out"):
        camgeo.follow(rings(tmp_path / "round.dxf", 0.0), roller=5.0, across="arc")


def test_a_gap_is_refused_with_the_one_that_closes_it(tmp_path: Path) -> None:
    near = camgeo.follow(rings(tmp_path / "near.dxf", 1.1e-6), roller=5.0, steps=72)
    assert near.lift == pytest.approx(6.0, abs=1e-5)
    assert near.remarks == ("ends up to 1.1e-06 mm apart are joined, as the digits or the size of the drawing explain",)
    for unit, units in ((4, None), (0, "inch")):
        path = rings(tmp_path / "gap.dxf", 0.0025, unit=unit)
        with pytest.raises(camgeo.CallError) as refused:
            camgeo.follow(path, roller=5.0, units=units)
        gap = float(str(refused.value).partition("give gap ")[2].partition(" ")[0])
        wide = camgeo.follow(path, roller=5.0, units=units, gap=gap, steps=72)
        assert wide.lift == pytest.approx(6.0 if unit else 152.4, rel=1e-3)
        assert wide.remarks[0].endswith("apart are joined, as asked")
        assert judged_by_recipe(wide).ok or unit == 0
    with pytest.raises(camgeo.CallError, match="a gap is a length above 0, not 0"):
        camgeo.follow(path, roller=5.0, gap=0.0)


def test_a_gap_that_is_no_slot_is_closed_by_gap_and_not_across(tmp_path: Path) -> None:
    made = ezdxf.new("R2010")
    made.header["$INSUNITS"] = 4
    turn = np.radians(np.arange(91) * 4.0)
    corners = np.column_stack([8.0 + 30.0 * np.cos(turn), 30.0 * np.sin(turn)])
    corners[-1] += (corners[-2] - corners[-1]) * 0.005
    for begin, end in pairwise(corners.tolist()):
        made.modelspace().add_line(begin, end)
    made.saveas(path := tmp_path / "gap.dxf")
    for way in ("arc", "chord"):
        with pytest.raises(camgeo.CallError) as refused:
            _ = camgeo.follow(path, roller=10.0, across=way).known
        assert "and leave across out" in str(refused.value)
        gap = float(str(refused.value).partition("give gap ")[2].partition(" ")[0])
        assert camgeo.follow(path, roller=10.0, gap=gap, steps=72).lift == pytest.approx(16.0, abs=0.05)


def test_points_are_followed_where_they_go_all_the_way_round(tmp_path: Path) -> None:
    whole = camgeo.follow(points(tmp_path / "cam.csv"), roller=5.0, steps=72)
    assert whole.lift == pytest.approx(6.0, abs=0.01)
    with pytest.raises(camgeo.CallError, match="these are points: leave page out"):
        judged_by_recipe(whole)
    part = points(tmp_path / "part.csv", 40.0)
    with pytest.raises(camgeo.CallError, match=r"lines 2 and 162: 13\.68 apart, 20 times the usual step"):
        camgeo.follow(part, roller=5.0)
    for way in ("arc", "chord"):  # also where the roller would rest on the end of a chord, it is not known
        closed = camgeo.follow(part, roller=5.0, across=way, steps=72)
        assert 0.85 < closed.known.mean() < 0.9
        assert closed.position[closed.known] == pytest.approx(whole.position[closed.known], abs=1e-6)
    (tmp_path / "bare.csv").write_text((tmp_path / "cam.csv").read_text().partition("\n")[2])
    with pytest.raises(camgeo.CallError, match="state no unit: give units, or head them x_mm,y_mm"):
        camgeo.follow(tmp_path / "bare.csv", roller=5.0)


def test_a_contour_is_mirrored_and_turned_about_the_shaft(tmp_path: Path) -> None:
    path = rings(tmp_path / "cam.dxf", 0.0)
    hows: list[tuple[dict[str, Any], float]]
    hows = [({"turn": 30.0}, 30.0), ({"mirror": "y", "turn": 30.0}, 210.0), ({"mirror": "x"}, 0.0)]
    for how, place in hows:
        followed = camgeo.follow(path, roller=5.0, **how)
        assert math.degrees(followed.greatest[1]) == pytest.approx(place, abs=1e-4)
    with pytest.raises(camgeo.CallError, match="turned by at most 360 degrees, not 400"):
        camgeo.follow(path, roller=5.0, turn=400.0)


def test_a_body_is_chosen_by_its_number_or_its_name(tmp_path: Path) -> None:
    """Of two discs in an STL, the second half as large and off the shaft; a file of one body needs no choice."""
    text = []
    for scale, x in ((1.0, 0.0), (0.5, 100.0)):
        angle = 2.0 * np.pi * np.arange(48) / 48
        rim = np.column_stack([x + scale * (3.0 + 20.0 * np.cos(angle)), scale * 20.0 * np.sin(angle)])
        text.append(f"solid d{x:g}")
        for a, b in zip(rim.tolist(), np.roll(rim, -1, axis=0).tolist(), strict=True):
            low, high, middle = 0.0, 6.0, [x + 3.0 * scale, 0.0]
            for corners in (
                [(*middle, low), (*b, low), (*a, low)],
                [(*middle, high), (*a, high), (*b, high)],
                [(*a, low), (*b, low), (*b, high)],
                [(*a, low), (*b, high), (*a, high)],
            ):
                vertices = "\n".join("vertex {:.9g} {:.9g} {:.9g}".format(*corner) for corner in corners)
                text.append(f"facet normal 0 0 0\nouter loop\n{vertices}\nendloop\nendfacet")
        text.append("endsolid")
    path = tmp_path / "two.stl"
    path.write_text("\n".join(text))
    with pytest.raises(camgeo.CallError, match=r"2 bodies: 1: body 1 of .*; 2: body 2 of .*; give body") as refused:
        camgeo.follow(path, roller=5.0)
    assert "at x 91.5 to 111.5" in str(refused.value)
    for body, at, lift in ((1, 0.0, 6.0), (2, 100.0, 3.0), ("body 2", 100.0, 3.0)):
        assert camgeo.follow(path, roller=5.0, body=body, at=(at, 0.0), steps=72).lift == pytest.approx(lift, abs=0.05)
    with pytest.raises(camgeo.CallError, match="give one of them, not 3"):
        camgeo.follow(path, roller=5.0, body=3)
    with pytest.raises(camgeo.CallError, match="only a solid has bodies: leave body out"):
        camgeo.follow(slot(tmp_path / "slot.dxf"), roller=5.0, body=1)
