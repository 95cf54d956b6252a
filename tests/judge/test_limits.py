"""Limits that the tolerance implies: none where they would permit a good part of the stroke; a given one takes over."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

import camgeo
from camgeo.measures.remarks import LOOSE
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed
from kin.judge.limits import stroke_of
from kin.numeric.limits import MOST_SHARE, NO_LIMIT, STEEP, is_loose

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.api.report import Report

ROLLERS = """\
cam: {{kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {{cos: {{1: {delta}}}}}}}
verify: {{angles: 36{more}}}
export: {{tolerance: 0.001, files: [dxf]}}
"""
STEM = """\
cam:
  kind: disc
  base_radius: 0.5
  follower: {{kind: knife-edge}}
  motion:
    - {{rise: 40, over: 2, law: cycloidal}}
    - {{dwell: 100}}
    - {{return: 40, over: 120, law: cycloidal}}
    - {{dwell: 138}}
verify: {{angles: 36}}
export: {{tolerance: {tolerance}, files: [dxf]}}
"""
FACE = """\
cam:
  kind: disc
  base_radius: {base}
  follower: {{kind: flat, arm: {{pivot: 70}}}}
  motion: [{{rise: 0.001, over: 120, law: cycloidal}}, {{return: 0.001, over: 240, law: cycloidal}}]
verify: {{angles: 36}}
export: {{tolerance: 0.0001, files: [dxf]}}
"""


def report(folder: Path, text: str) -> Report:
    path = folder / "cam.yaml"
    path.write_text(text)
    return camgeo.check(camgeo.load(path))


def failing(made: Report) -> dict[str, Any]:
    return {check.name: check for check in made.checks if not check.ok}


def loose(made: Report) -> list[Any]:
    return [remark for remark in made.remarks if remark.name == "loose-motion-error"]


def test_a_limit_is_loose_beside_the_stroke_and_beside_what_the_tolerance_gives_directly() -> None:
    assert is_loose(1.01, 0.1, lambda: 10.0)
    assert not is_loose(0.99, 0.01, lambda: 10.0)  # less than a tenth of the stroke
    assert not is_loose(1.99, 0.2, lambda: pytest.fail("the stroke does not count"))
    assert not is_loose(1.99, 0.2, lambda: 10.0)  # a coarse tolerance, which the recipe is told of by another remark
    assert is_loose(0.11, 0.001, lambda: 10.0, LOOSE)
    assert not is_loose(0.09, 0.001, lambda: 10.0, LOOSE)


@pytest.mark.slow
@pytest.mark.parametrize("delta", [1799, 1799.99])
def test_a_double_roller_nearly_square_to_its_way_has_no_implied_limit(tmp_path: Path, delta: float) -> None:
    failed = failing(report(tmp_path, ROLLERS.format(delta=delta, more="")))
    assert set(failed) == ({"motion"} if delta == 1799 else {"motion", "form-closure"})
    for check in failed.values():
        assert check.limit is None
        assert check.detail.startswith(NO_LIMIT)
    given = report(tmp_path, ROLLERS.format(delta=delta, more=", motion_error: 2"))
    assert failing(given) == {}
    limits = {check.name: check.limit for check in given.checks if check.file}
    assert limits["motion"] == 2.0
    assert limits["form-closure"] == pytest.approx(math.radians(2.0) * 60.0, rel=1e-12)


@pytest.mark.slow
def test_a_double_roller_that_is_steep_but_bounded_is_held_as_before(tmp_path: Path) -> None:
    made = report(tmp_path, ROLLERS.format(delta=1790, more=""))
    assert made.ok
    assert not loose(made)
    assert next(check.limit for check in made.checks if check.name == "motion") == pytest.approx(0.488544, rel=1e-5)
    assert set(failing(report(tmp_path, ROLLERS.format(delta=1799, more=", motion_error: 1")))) == {"motion"}


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("share", "fails", "remarked"),
    [(1.01 * MOST_SHARE, True, False), (0.99 * MOST_SHARE, False, True), (0.99 * LOOSE, False, False)],
)
def test_a_steep_stem_on_both_sides_of_its_bounds(tmp_path: Path, share: float, fails: bool, remarked: bool) -> None:
    """The tolerance at which the limit is that share of the stroke: 84 times the tolerance and more here."""
    recipe = load_text(STEM.format(tolerance=0.01), "cam.yaml")
    follower = designed(recipe).exact.gauge
    assert stroke_of(follower) == pytest.approx(40.0, rel=1e-12)
    low, high = 1e-6, 1.0
    while high - low > 1e-9 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if follower.motion_limit(middle) > share * 40.0 else (middle, high)
    assert follower.motion_limit(low) > STEEP * low
    made = report(tmp_path, STEM.format(tolerance=f"{low:.12f}"))
    assert ("motion" in failing(made)) == fails
    assert bool(loose(made)) == remarked
    if remarked:
        (remark,) = loose(made)
        assert remark.value == pytest.approx(share * 40.0, rel=1e-6)
        assert remark.rule == pytest.approx(0.4, rel=1e-9)
        assert "3.96 mm, is 0.099 times the stroke; verify.motion_error" in remark.sentence


def test_a_face_that_rests_beside_its_pivot(tmp_path: Path) -> None:
    """Its lever is 1.2 mm of the pivot's 70: what the tolerance gives there is no measure of it."""
    assert set(failing(report(tmp_path, FACE.format(base=69.99)))) == {"motion"}
    assert failing(report(tmp_path, FACE.format(base=30))) == {}
