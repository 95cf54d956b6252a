"""Views of a part: edges behind the cutting plane, its ends, surface symbols, deviations, and equal sizes once.

Holds: camgeo.capabilities.sheet.marks, camgeo.capabilities.sheet.part.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

import camgeo
from camgeo.capabilities.sheet import drawing
from camgeo.capabilities.sheet.marks import LineMark
from camgeo.capabilities.sheet.options import build_sheet
from camgeo.capabilities.sheet.part import DrawnDisc, deviation_words, disc_loops, screw_holes, section_edges
from camgeo.capabilities.sheet.views import Tolerance, disc_sizes
from camgeo.output.part_geometry import openings_of
from camgeo.recipe.recipe import load_text
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from pathlib import Path

CAM = """\
cam: {kind: support, p: 40 + 2*cos(3*t)}
part: {thickness: 12, PART}
export: {tolerance: 0.02, files: [{sheet: {profile: 0.04OPTIONS}}]}
verify: {angles: 36}
"""


def recipe(part: str, options: str = "") -> str:
    return CAM.replace("PART", part).replace("OPTIONS", options)


def drawn(part: str) -> DrawnDisc:
    """The disc of a part; in place of its contour a circle of 45 mm."""
    read = load_text(recipe(part), "cam.yaml")
    body = designed(read).discs[0].body
    assert body is not None
    turn = np.linspace(0.0, 2.0 * np.pi, 361)[:-1]
    loops = disc_loops(openings_of(body), body, 0)
    contour = type(loops[0])(45.0 * np.column_stack([np.cos(turn), np.sin(turn)]), "CUT", surface=True)
    return DrawnDisc((contour, *loops), body, read.part, ccw=False)


def edges(part: str, sense: float = 1.0) -> list[list[list[float]]]:
    _, found = section_edges(drawn(part), sense)
    return [np.round(edge, 4).tolist() for edge in found]


def test_corners_of_a_keyway_are_seen_behind_the_plane_and_not_before_it() -> None:
    """A keyway of 6 mm at 30 degrees in a bore of 20: its corners by hand, from z 0 to 12."""
    part = "bore: 20, keyway: {width: 6, depth: 3, at: 30}"
    near, far = math.sqrt(100.0 - 9.0), 13.0
    c, s = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
    heights = {round(along * s + off * c, 4) for along in (near, far) for off in (-3.0, 3.0)}
    # the greatest height of the far wall bounds the cut itself only where the plane meets it: all four are in sight
    found = {edge[0][1] for edge in edges(part) if edge[0][1] == edge[1][1]}
    assert found <= heights
    assert {round(near * s - 3.0 * c, 4), round(far * s - 3.0 * c, 4)} <= found
    assert all(sorted(z for z, _ in edge) == [0.0, 12.0] for edge in edges(part) if edge[0][1] == edge[1][1])
    assert not [edge for edge in edges(part, -1.0) if edge[0][1] == edge[1][1]]


def test_rims_of_a_hole_in_the_plane_close_its_gap_on_both_faces() -> None:
    found = edges("bore: 10, dowel: {circle: 50, hole: 6, at: 90}")
    for z in (0.0, 12.0):
        (rim,) = [edge for edge in found if edge[0][0] == z and edge[0][1] > 10.0]
        assert rim == [pytest.approx([z, 22.0], abs=2e-2), pytest.approx([z, 28.0], abs=2e-2)]


def test_rims_of_a_hole_under_the_boss_lie_on_its_face() -> None:
    found = edges("bore: 10, hub: {diameter: 40, height: 8}, dowel: {circle: 26, hole: 6, at: 90}")
    assert {edge[0][0] for edge in found if edge[0][1] > 9.0} == {0.0, 20.0}


@pytest.mark.parametrize(("at", "holes"), [(90.0, 1), (-90.0, 1), (60.0, 0)])
def test_a_set_screw_in_the_plane_is_cut_open(at: float, holes: int) -> None:
    disc = drawn(f"bore: 10, hub: {{diameter: 26, height: 8}}, set_screw: {{diameter: 3, at: {at}}}")
    rings = [np.round(ring, 4).tolist() for ring in screw_holes(disc)]
    side = math.copysign(1.0, at)
    square = [[14.5, 5.0 * side], [17.5, 5.0 * side], [17.5, 13.0 * side], [14.5, 13.0 * side]]
    assert rings == [pytest.approx(np.array(square), abs=1e-2)] * holes
    assert len(disc.hidden) == 2


def test_equal_sizes_stand_once() -> None:
    """Two circles about the shaft of one size are one, and so are lightening holes of one diameter."""
    part = "bore: 10, bolts: {count: 3, circle: 50, hole: 5}, dowel: {circle: 50, hole: 4, at: 60}"
    disc = drawn(f"{part}, lightening: {{largest: 3, wall: 3}}")
    rows = disc_sizes(disc, None, Tolerance(None, ()), {}).column
    (circle,) = [row for row in rows if row.text == "Ø50"]
    assert circle.notes == ("bolt circle", "dowel circle")
    holes = [row for row in rows if row.notes and row.notes[0].startswith("at X")]
    assert sum(len(row.circles) for row in holes) == 3
    assert len({row.text for row in holes}) == len(holes)
    for row in holes:
        assert row.text.startswith(f"{len(row.circles)} × " if len(row.circles) > 1 else "Ø")
        assert len(row.notes) == len(row.circles)


def test_deviations_are_written_upper_first() -> None:
    assert deviation_words(-0.042, -0.012) == "−0.012/−0.042"
    assert deviation_words(0.0, 0.1) == "+0.1/0"
    assert deviation_words(-0.015, 0.015) == "±0.015"


def test_the_sheet_has_deviations_symbols_and_thick_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[drawing.Pages] = []
    pages = drawing._pages
    monkeypatch.setattr(drawing, "_pages", lambda *a, **k: seen.append(pages(*a, **k)) or seen[-1])
    part = "bore: {diameter: 16, fit: H7}, keyway: {standard: din6885, fit: P9, at: 20}"
    text = recipe(part, ", finish: {contour: Ra 0.8, bore: 'Rz6.3'}")
    assert camgeo.export(load_text(text, tmp_path / "cam.yaml"), tmp_path).ok
    first = seen[0].annotated[0]
    texts = [text.text for text in first.texts]
    wanted = ["Ø16 H7 (+0.018/0)", "5 P9 (−0.012/−0.042)", "18.3 +0.1/0", "Ra 0.8", "Rz 6.3", "as drawn"]
    assert [texts.count(word) for word in [*wanted, "shaft", "angles"]] == [1] * 8
    thick = [mark for mark in first.marks if isinstance(mark, LineMark) and mark.weight == 1.0]
    assert len(thick) == 2
    assert "Ø18" not in " ".join(texts)
    assert any("flat face" in text.text for text in seen[0].annotated[-1].texts)


@pytest.mark.parametrize(
    ("finish", "problem", "remedy"),
    [
        ("{contour: 0.8}", "contour: not a roughness, given '0.8'; give Ra or Rz in micrometres", "{contour: Ra 0.8}"),
        ("{contour: Ra 0}", "contour: not a roughness, given 'Ra 0'", "{contour: Ra 0.1}"),
        ("{contour: [Ra]}", "contour: not a roughness", "{contour: Ra 1}"),
        ("{hub: Ra 0.8}", "finish.hub: unknown key", "{bore: Ra 0.8}"),
        ("{}", "finish: no surface is named; give {contour: Ra 0.8}, or leave it out", "{contour: Ra 0.8}"),
        ("{bore: Ra 0.8}", "", ""),
    ],
)
def test_a_wrong_finish_is_refused(finish: str, problem: str, remedy: str) -> None:
    for value in filter(None, (remedy, "ground")):
        load_text(recipe("bore: 10", f", finish: {value}"), "cam.yaml")
    if problem:
        with pytest.raises(camgeo.RecipeErrors, match=problem.translate({ord(c): f"\\{c}" for c in "{}.[]"})):
            load_text(recipe("bore: 10", f", finish: {finish}"), "cam.yaml")
    else:
        with pytest.raises(camgeo.RecipeErrors, match=r"finish\.bore: the part has no bore; leave it out"):
            load_text(recipe("wall: 1", f", finish: {finish}"), "cam.yaml")


def test_a_finish_is_a_text_or_symbols() -> None:
    assert build_sheet({"finish": "ground"}).texts["finish"] == "ground"
    assert build_sheet({"finish": (("contour", "Ra 0.8"),)}).rough == (("contour", "Ra 0.8"),)
