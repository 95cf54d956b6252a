"""A design's scene: everything that a page draws, as plain data and without a file."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.cases import few
from support.pages import of, unpacked
from support.places import SHIPPED

import camgeo
from camgeo.curve.ring import Ring, bar, disc, steps_along

if TYPE_CHECKING:
    from pathlib import Path

KEYED = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 12, keyway: din6885}\n"
UNDERCUT = "cam: {kind: support, p: 10 + 2*cos(3*t)}\npart: {thickness: 5}\n"


@pytest.mark.thin(12)
@pytest.mark.parametrize("path", few(SHIPPED, 3), ids=lambda path: path.stem)
def test_it_is_plain_data(path: Path) -> None:
    scene = camgeo.design(path).scene()
    again = json.loads(json.dumps(scene, allow_nan=False))
    assert again == json.loads(json.dumps(dict(scene)))
    assert {"drawing", "bodies", "plots", "marks", "checks", "remarks", "contours", "rests", "note"} <= set(scene)
    assert scene["drawing"].count('class="body ') == len(scene["bodies"])


def test_the_page_is_made_of_it() -> None:
    """What the page has besides is of files: their contours in the drawing, their errors and their checks."""
    made = of("shu-wu")
    scene = camgeo.design(made.recipe).scene()
    for key in ("unit", "sense", "steps", "bodies", "rests", "relative", "linked"):
        assert scene[key] == made.data[key], key
    titles = [plot["title"] for plot in made.data["plots"]]
    assert [plot["title"] for plot in scene["plots"]] == titles
    assert scene["errors"] == []
    assert made.data["errors"]


def test_openings_have_their_keyway() -> None:
    """As a path from corner to corner: three sides of the keyway and an arc of the bore, within one shape of metal."""
    drawing = camgeo.design(camgeo.load(KEYED)).scene()["drawing"]
    metal = drawing.split('class="metal" d="')[1].split('"')[0]
    assert metal.count("Z") == 2
    bore = metal.split("Z")[1]
    assert bore.count("A") == 1
    assert bore.count("L") >= 2


@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_marks_lie_on_the_contour_where_checks_fail(rotation: str) -> None:
    design = camgeo.design(camgeo.load(f"{UNDERCUT}rotation: {rotation}\n"))
    scene = design.scene()
    failed = [check for check in scene["checks"] if not check["ok"] and check["at_deg"] is not None]
    marks = [mark for mark in scene["marks"] if mark["kind"] == "failed"]
    assert [mark["name"] for mark in marks] == [check["name"] for check in failed] != []
    for mark in marks:
        angle = math.radians(mark["at_deg"])
        p, slope = 10.0 + 2.0 * math.cos(3.0 * angle), -6.0 * math.sin(3.0 * angle)
        x, y = p * math.cos(angle) - slope * math.sin(angle), p * math.sin(angle) + slope * math.cos(angle)
        place = (x, y if rotation == "cw" else -y)
        assert (mark["x"], mark["y"]) == pytest.approx(place, abs=0.2)  # half a step of the page
        assert mark["text"]


@pytest.mark.slow
def test_marks_of_a_groove_lie_on_the_flank_that_fails() -> None:
    scene = camgeo.design(
        camgeo.load(
            "cam: {kind: disc, base_radius: 10, follower: {kind: roller, radius: 12}, track: {groove: {depth: 5}}, "
            "motion: [{rise: 15, over: 40, law: cycloidal}, {return: 15, over: 40, law: cycloidal}, {dwell: 280}]}\n"
            "part: {thickness: 10, outer: 150}\n"
        )
    ).scene()
    failed = [check for check in scene["checks"] if not check["ok"] and check["at_deg"] is not None]
    marks = [mark for mark in scene["marks"] if mark["kind"] == "failed"]
    assert [mark["name"] for mark in marks] == [check["name"] for check in failed]
    assert {check["surface"] for check in failed} == {"inner", "outer"}
    for check, mark in zip(failed, marks, strict=True):
        rows = [unpacked(row, scene["steps"])[: scene["steps"]] for row in scene["contours"][check["surface"]][:2]]
        assert np.hypot(rows[0] - mark["x"], rows[1] - mark["y"]).min() < 1e-3


@pytest.mark.parametrize(
    "ring",
    [
        disc(3.0, -1.0, 5.0),
        bar((0.0, 0.0), (4.0, 3.0), 2.0),
        Ring.through([(0.0, 0.0), (1.0, 0.0), (0.0, 2.0)]),
        Ring.through([(0.0, 0.0), (1.0, 0.0), (0.0, 2.0)], closed=False),
        Ring(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), np.array([0.3, -1.7, 0.0])),
        Ring(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), np.array([0.3, -1.7, 0.5]), closed=False),
    ],
)
def test_a_ring_is_flattened_piece_by_piece(ring: Ring) -> None:
    pieces = list(ring.pieces())
    pieces = pieces if ring.closed else pieces[:-1]
    steps = [max(1, math.ceil(abs(4.0 * math.atan(bulge)) / 0.02)) for _, _, bulge in pieces]
    wanted = [steps_along(*piece, count) for piece, count in zip(pieces, steps, strict=True)]
    last = ring.points[:1] if ring.closed else ring.points[-1:]
    np.testing.assert_allclose(ring.flattened(), np.concatenate([*wanted, last]), atol=1e-14)
