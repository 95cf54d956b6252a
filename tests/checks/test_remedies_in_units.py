"""Remedies with a figure worked by hand, in both units: the limit that is named is the figure's own, and it does."""

from __future__ import annotations

import pytest

import camgeo
from camgeo.checks.remedies import Missed, limit_remedy

CAM = (
    "cam: {kind: disc, base_radius: 2, follower: {kind: roller, radius: 0.5}, motion: [{rise: 0.5, over: 60, "
    "law: cycloidal}, {dwell: 60}, {return: 0.5, over: 180, law: cycloidal}, {dwell: 60}]}\n"
    "limits: {size: {at_least: 8}, peak-velocity: {at_least: 2}, pressure-angle: {at_least: 30}}\n"
)


@pytest.mark.parametrize(("head", "mm"), [("", 1.0), ("units: inch\n", 25.4)])
def test_the_least_that_a_figure_keeps_is_in_the_recipe_s_unit(head: str, mm: float) -> None:
    """2 + 0.5 from the shaft, 2 h/beta of a cycloid, and an angle, which has no other unit."""
    recipe = camgeo.load(head + CAM)
    missed = {
        "size": Missed(2.5 * mm, 8.0 * mm, "mm"),
        "peak-velocity": Missed(0.95493 * mm, 2.0 * mm, "mm/rad"),
        "pressure-angle": Missed(19.2, 30.0, "deg"),
    }
    told = {limit.figure: limit_remedy(recipe, limit, missed[limit.figure]) for limit in recipe.limits}
    values = {"size": "2.5", "peak-velocity": "0.95493", "pressure-angle": "19.2"}
    assert told == {name: f"limits.{name}.at_least of {value}" for name, value in values.items()}


def test_holes_of_one_size_share_what_their_wall_lacks() -> None:
    """Six round a circle of 20 mm stand 10 mm apart: with 2 mm of wall between they are 8 mm."""
    text = "part: {{thickness: 8, bore: 1, wall: 2, bolts: {{count: 6, circle: 20, hole: {}}}}}\n"
    cam = "cam: {kind: support, p: 40 + cos(2*t)}\n"
    (check,) = [check for check in camgeo.check(camgeo.load(text.format(9) + cam)).checks if not check.ok]
    assert check.detail.endswith("; a part.bolts.hole below 8 mm would do")
    assert camgeo.check(camgeo.load(text.format(7.999) + cam)).ok
