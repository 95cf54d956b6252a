"""Developments of barrels: points on the flank of brute force, chords within their bound, and files that kin accepts.

Holds: camgeo.capabilities.indexing.development.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.indexing.made_indexers import Rollers, changed, design_of, shared_design, window
from capabilities.indexing.rollers import TURN, Indexed, barrel_away, nearest
from support.heavy import ezdxf
from support.places import ROOT

from camgeo.capabilities.indexing.development import developed_line, drawn, unrolled, unrolled_bends
from camgeo.fit.nodes import ToleranceError
from kin.turned.files import Developed

if TYPE_CHECKING:
    from pathlib import Path

BARREL = """cam:
  kind: indexing
  barrel: {radius: 50, offset: 57}
  depth: 13
  turret: {stops: 6, radius: 60, roller: 9, clearance: 0.03}
  motion: [{rise: 60, over: 150, law: polynomial-345}, {dwell: 210}]
part: {length: 70, bore: 24}
"""
LAW = Indexed([("rise", 60.0, 150.0, "polynomial-345"), ("dwell", 0.0, 210.0, "")], -30.0)
AWAY = barrel_away(57.0, 60.0, 1, 35.0)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "roller"), [("lower", 9.0), ("upper", 9.03)])
@pytest.mark.parametrize("radius", [50.0, 40.0])
def test_a_line_lies_on_what_rollers_leave(name: str, roller: float, radius: float) -> None:
    flank = shared_design(BARREL).flanks[name]
    points, off = developed_line(flank, radius, 0.01)
    assert off <= 0.01
    assert points[0, 1] == 0.0
    assert points[-1, 1] == 70.0
    some = points[:: len(points) // 30]
    phi = some[:, 0] / radius
    space = np.column_stack([radius * np.cos(phi), radius * np.sin(phi), some[:, 1]])
    assert nearest(AWAY, LAW, space, 3) == pytest.approx(roller, abs=1e-8)


@pytest.mark.parametrize("name", ["lower", "upper"])
def test_chords_are_within_their_bound(name: str) -> None:
    flank = shared_design(BARREL).flanks[name]
    points, off = developed_line(flank, 38.0, 0.05)
    fine, _ = developed_line(flank, 38.0, 1e-5)
    between = np.interp(fine[:, 0], points[:, 0], points[:, 1]) - fine[:, 1]
    rise = np.interp(fine[:, 0], 0.5 * (points[1:, 0] + points[:-1, 0]), np.diff(points[:, 1]) / np.diff(points[:, 0]))
    assert np.abs(between / np.hypot(1.0, rise)).max() <= off + 2e-5


def test_the_second_derivative_is_bounded() -> None:
    flank, e = shared_design(BARREL).flanks["lower"], 1e-4
    theta = np.linspace(0.7, 2.4, 60)
    bound = unrolled_bends(flank, np.sort(np.concatenate([theta - 1e-3, theta + 1e-3])), 42.0)[::2]
    rows = [flank.on(theta + k * e, 42.0) for k in (-1, 0, 1)]
    bent = [
        (one - 2.0 * two + three) / e**2 for one, two, three in zip(*((42.0 * r.phi, r.z) for r in rows), strict=True)
    ]
    size = np.hypot(*bent)
    assert (size <= bound + 1e-4).all()
    assert (bound <= 1.1 * size + 1.0).all()


@pytest.mark.parametrize("stops", [2, 6, 12, 60])
def test_random_developments_are_held_against_rollers_at_all_angles(stops: int) -> None:
    """The angles of `window` lead the roller of no turn through the half turn that faces the cam."""
    sizes = {"height": 0.0, "pitch": 60.0, "offset": 60.0, "side": 1.0}
    psi = Rollers("barrel", sizes, stops, 200.0, -math.pi / stops).psi(window(stops))
    assert psi.min() <= -0.5 * math.pi
    assert psi.max() >= 0.5 * math.pi
    assert np.diff(window(stops)).max() < 0.0025


def test_too_many_points() -> None:
    with pytest.raises(ToleranceError, match="too many points"):
        developed_line(shared_design(BARREL).flanks["lower"], 50.0, 1e-12)


def test_pieces_of_a_turn() -> None:
    design = shared_design(BARREL)
    line = drawn(design, Developed("", 50.0, "lower"), 0.01)
    turn = TURN * 50.0
    assert len(line.pieces) >= 2
    for piece in line.pieces:
        assert piece[:, 0].min() >= -1e-9
        assert piece[:, 0].max() <= turn + 1e-9
        assert (np.diff(piece[:, 0]) > 0.0).all()
    for one, two in zip(line.pieces[:-1], line.pieces[1:], strict=True):
        assert one[-1] - two[0] == pytest.approx([turn, 0.0], abs=1e-9)
    mirrored = drawn(design_of(f"rotation: ccw\n{BARREL}"), Developed("", 50.0, "lower"), 0.01)
    assert mirrored.pieces[0] == pytest.approx(line.pieces[0] * [-1.0, 1.0], abs=1e-12)
    assert len(unrolled(design, 0.01)) == 4 + 2 * len(line.pieces)


@pytest.mark.parametrize("text", [BARREL, changed(BARREL, ("cam:", "rotation: ccw\ncam:"))], ids=["cw", "ccw"])
def test_a_drawing_is_accepted(text: str, tmp_path: Path) -> None:
    from camgeo.cli.main import main

    path = tmp_path / "index.yaml"
    path.write_text(f"{text}export: {{tolerance: 0.01, files: [{{dxf: {{as: development, at: [outer, 40]}}}}]}}\n")
    assert main(["export", str(path), "--out", str(tmp_path)]) == 0
    (drawing,) = tmp_path.rglob("*.dxf")
    space = ezdxf.readfile(drawing).modelspace()
    layers = {entity.dxf.layer for entity in space}
    assert layers == {f"R{radius}_{name}" for radius in (50, 40) for name in ("LOWER", "UPPER", "TURN")}
    assert math.isclose(
        max(p[0] for e in space for p in e.get_points()) - min(p[0] for e in space for p in e.get_points()),
        TURN * 50.0,
        rel_tol=1e-9,
    )


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-4, 3e-5, 1e-5])
def test_a_fine_drawing_leaves_room_for_its_verdict(tolerance: float, tmp_path: Path) -> None:
    from camgeo.cli.main import main

    shipped = ROOT / "recipes" / "indexing" / "index-barrel.yaml"
    assert main(["export", str(shipped), "--only", "dxf", "--tolerance", str(tolerance), "--out", str(tmp_path)]) == 0
