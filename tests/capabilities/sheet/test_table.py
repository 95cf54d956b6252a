"""Table of a contour: a step by its spline, against a contour and a spline of this test's own; what a coarse one says.

Holds: camgeo.capabilities.sheet.pages.
"""

from __future__ import annotations

import functools
import math
import re
from typing import TYPE_CHECKING

import ezdxf
import numpy as np
import pytest
from support.heavy import interpolate

import camgeo
from camgeo.capabilities.sheet.marks import LineMark
from camgeo.capabilities.sheet.pages import Zone, contour_table, table_pages
from camgeo.recipe.recipe import load_text
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.sheet.pages import SheetTable

CAM = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 9}
  motion:
    - {rise: 12, over: 100, law: cycloidal}
    - {dwell: 60}
    - {return: 12, over: 140, law: polynomial-345}
    - {dwell: 60}
part: {thickness: 12, bore: 16}
export: {tolerance: 0.002, files: [{sheet: {profile: 0.04}}]}
verify: {angles: 180}
"""


def table(text: str, permitted: float, step: float | None = None) -> SheetTable:
    design = designed(load_text(text, "cam.yaml"))
    contours = [("", contour) for _, contour in design.contours]
    return contour_table(contours, step, Zone(permitted, stated=True), ccw="ccw" in text)


@functools.cache
def places() -> tuple[np.ndarray, np.ndarray]:
    """Polar angles of the contour of CAM over three turns, and distances from the shaft, mm: 9 mm within the pitch
    curve, along its normal.
    """
    t = np.linspace(0.0, 2.0 * np.pi, 400_001)[:-1]
    x, u = t / np.radians(100.0), (t - np.radians(160.0)) / np.radians(140.0)
    rise, back = x < 1.0, (u > 0.0) & (u < 1.0)
    dwell = np.where(t < np.radians(160.0), 12.0, 0.0)
    up = (
        12.0 * (x - np.sin(2.0 * np.pi * x) / (2.0 * np.pi)),
        12.0 * (1.0 - np.cos(2.0 * np.pi * x)) / np.radians(100.0),
    )
    down = 12.0 * (1.0 - u**3 * (10.0 - 15.0 * u + 6.0 * u * u)), -360.0 * (u * (1.0 - u)) ** 2 / np.radians(140.0)
    lift = np.select([rise, back], [up[0], down[0]], dwell)
    speed = np.select([rise, back], [up[1], down[1]])
    pitch = (49.0 + lift) * np.exp(1j * t)
    along = (speed + 1j * (49.0 + lift)) * np.exp(1j * t)
    contour = pitch + 9.0j * along / np.abs(along)
    polar = np.unwrap(np.angle(contour))
    return np.concatenate([polar - 2.0 * np.pi, polar, polar + 2.0 * np.pi]), np.tile(np.abs(contour), 3)


def radii(angles: np.ndarray) -> np.ndarray:
    """Distances of the contour of CAM from the shaft at polar angles, mm."""
    found: np.ndarray = np.interp(angles, *places())
    return found


def spline_error(count: int) -> float:
    """How far scipy's periodic spline through `count` radii, rounded as printed, is off the contour, mm."""
    angles = 2.0 * np.pi / count * np.arange(count + 1)
    rows = np.round(radii(angles), 4)
    rows[-1] = rows[0]
    fine = np.linspace(0.0, 2.0 * np.pi, 50_001)
    return float(np.abs(interpolate.CubicSpline(angles, rows, bc_type="periodic")(fine) - radii(fine)).max())


@pytest.mark.parametrize(("permitted", "count"), [(0.004, 36), (0.001, 60), (0.0005, 72), (8e-5, 180)])
def test_the_step_is_the_greatest_whose_spline_is_permitted(permitted: float, count: int) -> None:
    found = table(CAM, permitted)
    assert len(found.rows) == count
    assert found.exact
    assert found.off <= permitted
    assert found.off == pytest.approx(spline_error(count), rel=0.02, abs=2e-6)
    assert found.rows[:, 0] == pytest.approx(360.0 / count * np.arange(count))
    assert found.rows[:, 1] == pytest.approx(radii(np.radians(found.rows[:, 0])), abs=6e-5)
    coarser = max((fewer for fewer in (36, 60, 72, 120) if fewer < count), default=None)
    assert coarser is None or spline_error(coarser) > permitted


@pytest.mark.parametrize("step", [30.0, 7.2])
def test_an_own_step_that_is_too_coarse_is_measured_and_not_exact(step: float) -> None:
    found = table(CAM, 0.0005, math.radians(step))
    assert found.off == pytest.approx(spline_error(round(360.0 / step)), rel=0.02)
    assert not found.exact
    (page,) = table_pages(found, "A3")
    texts = [text.text for text in page.texts]
    assert "Contour, for orientation, from the shaft, in mm" in texts
    assert any(text.startswith("These are no theoretically exact dimensions.") for text in texts)
    assert not any(isinstance(mark, LineMark) and mark.closed and mark.layer == "TABLE" for mark in page.marks)


def test_exact_numbers_stand_in_boxes_that_fill_the_page() -> None:
    """A hundred and eighty rows stand in letters of 3.5 mm or more and take two thirds of the page's width."""
    (page,) = table_pages(table(CAM, 8e-5), "A3")
    boxes = [mark.points for mark in page.marks if isinstance(mark, LineMark) and mark.closed and mark.layer == "TABLE"]
    cells = [text for text in page.texts if text.layer == "TABLE"]
    assert min(text.height for text in cells) >= 3.5
    assert len([text for text in cells if re.fullmatch(r"\d\d\.\d{4}", text.text)]) == 180
    for text in cells:
        x0, y0, x1, y1 = text.box
        inside = [(b.min(axis=0) < (x0, y0)).all() and (b.max(axis=0) > (x1, y1)).all() for b in boxes]
        assert inside.count(True) == 1
    wide = max(box[:, 0].max() for box in boxes) - min(box[:, 0].min() for box in boxes)
    assert wide > 0.66 * 390.0


def test_of_a_shaft_that_turns_the_other_way_the_table_is_of_the_drawing() -> None:
    there = table(CAM, 0.004)
    back = table(f"rotation: ccw\n{CAM}", 0.004)
    assert back.rows[1:, 1] == pytest.approx(there.rows[:0:-1, 1], abs=1e-4)


def test_where_a_ray_meets_the_contour_twice_the_table_has_x_and_y() -> None:
    text = "cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [30, 0]}\npart: {}\nexport: {files: [dxf]}\n"
    found = table(text.replace("part: {}\n", ""), 0.002)
    assert found.heads == ("no.", "X", "Y")
    assert found.exact
    # the support function's own envelope, seen from the shaft
    t = 2.0 * np.pi / 720 * np.arange(720)
    p, dp = 25.0 + 2.0 * np.cos(3.0 * t), -6.0 * np.sin(3.0 * t)
    own = np.column_stack([p * np.cos(t) - dp * np.sin(t) - 30.0, p * np.sin(t) + dp * np.cos(t)])
    apart = np.hypot(*(found.rows[:, None, 1:] - own[None]).transpose(2, 0, 1)).min(axis=1)
    assert apart.max() < 1e-4


@pytest.mark.slow
def test_the_sheet_says_what_its_table_is(tmp_path: Path) -> None:
    for step, by in (("", "by the table, or the DXF"), (", step: 30", "by the DXF")):
        recipe = load_text(CAM.replace("0.04", f"0.04{step}"), tmp_path / "cam.yaml")
        assert camgeo.export(recipe, tmp_path / "out").ok
        space = ezdxf.readfile(tmp_path / "out" / "cam" / "cam-sheet.dxf").modelspace()
        texts = [entity.dxf.text for entity in space.query("TEXT")]
        assert any(text.startswith(f"The contour is theoretically exact {by}") for text in texts)
