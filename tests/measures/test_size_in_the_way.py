"""The size that a remark on the pressure angle names is tried, and what stands against it is said."""

from __future__ import annotations

import re

import pytest

from camgeo.measures.remarks import remarks_of
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed


def recipe(base: float, arm: str, rise: float, over: int, *, ring: bool, more: str = "") -> str:
    back = f"{{return: {rise}, over: {over}, law: cycloidal}}, {{dwell: {360 - 2 * over}}}"
    motion = f"[{{rise: {rise}, over: {over}, law: cycloidal}}, {back}]"
    track = "track: internal, " if ring else ""
    return (
        f"cam: {{kind: disc, base_radius: {base}, {track}follower: {{kind: roller, {arm}}}, motion: {motion}}}\n{more}"
    )


def remark(text: str) -> str:
    made = load_text(text, "cam.yaml")
    return next(one.sentence for one in remarks_of(made, designed(made)) if one.name == "pressure-angle")


@pytest.mark.slow
@pytest.mark.thin(3)
@pytest.mark.parametrize(
    "text",
    [
        recipe(53.1, "radius: 20, arm: {pivot: 45.3, length: 41.3}", 25.9, 60, ring=True, more="part: {outer: 600}\n"),
        recipe(
            73.62, "radius: 12, arm: {pivot: 116.8, length: 57.6}", 8.9, 120, ring=True, more="part: {outer: 600}\n"
        ),
        recipe(
            50.06,
            "radius: 20, arm: {pivot: 70.1, length: 45.9, side: leading}",
            16.4,
            120,
            ring=True,
            more="part: {outer: 600}\n",
        ),
    ],
)
def test_a_size_that_undercuts_is_called_that(text: str) -> None:
    found = re.search(
        r"; a base radius of (\S+) with a pivot at (\S+) would keep it, but fails pitch-radius$", remark(text)
    )
    assert found
    other = re.sub(r"base_radius: [\d.]+", f"base_radius: {found[1]}", text)
    other = re.sub(r"pivot: [\d.]+", f"pivot: {found[2]}", other)
    assert "pitch-radius" in {check.name for check in designed(load_text(other, "cam.yaml")).checks if not check.ok}


def test_a_ring_that_needs_more_metal_says_how_much() -> None:
    text = recipe(60.0, "radius: 5", 20, 60, ring=True, more="part: {outer: OUTER}\n")
    size = re.search(r"which a base radius of (\S+) keeps$", remark(text.replace("OUTER", "600")))
    assert size
    told = remark(text.replace("OUTER", "162"))
    found = re.search(r"; a base radius of (\S+) would keep it, but needs a part\.outer above (\S+)$", told)
    assert found
    assert found[1] == size[1]
    better = text.replace("60.0", size[1])
    for outer, ok in ((float(found[2]) + 0.01, True), (float(found[2]) - 0.01, False)):
        checks = designed(load_text(better.replace("OUTER", f"{outer}"), "cam.yaml")).checks
        assert next(check.ok for check in checks if check.name == "wall") is ok


def test_a_bore_that_leaves_nothing_of_it_is_named() -> None:
    text = recipe(20.0, "radius: 5", 20, 60, ring=False, more="part: {bore: BORE}\n")
    assert re.search(r"which a base radius of \S+ keeps$", remark(text.replace("BORE", "10")))
    told = remark(text.replace("BORE", "120"))
    assert re.search(r"; a base radius of \S+ would keep it, but leaves no metal round the shaft$", told)
