"""Cams that are lobes, and cams that are none: by contours, contacts and what leads the follower."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from camgeo.capabilities.camshaft.lobes import _demand_one_outside
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed

RISE = "{rise: 6, over: 120, law: cycloidal}, {dwell: 60}"
MOTION, HALF = f"motion: [{RISE}, {RISE.replace('rise', 'return')}]", f"motion: [{RISE}]"
ARM = "arm: {length: 65, pivot: 80}"
LOBES = {
    "a roller on a stem": f"kind: disc, base_radius: 40, follower: {{kind: roller, radius: 10}}, {MOTION}",
    "a roller on an arm": f"kind: disc, base_radius: 40, follower: {{kind: roller, radius: 10, {ARM}}}, {MOTION}",
    "two faces on a stem": f"kind: constant-breadth, base_radius: 40, {HALF}",
    "two rollers on a stem": f"kind: constant-diameter, base_radius: 40, roller_radius: 8, {HALF}",
}
NONE = {
    "a ring, a groove or a pair": [
        f"kind: disc, base_radius: 40, follower: {{kind: roller, radius: 10}}, {more}, {MOTION}"
        for more in ("track: internal", "track: {groove: {clearance: 0.03}}", "conjugate: {radius: 12, distance: 118}")
    ],
    "two contacts on one arm": ["kind: double-roller, ratio: 4, arm: 40, roller_radius: 8, delta: {cos: {1: 30}}"],
}


def demand(cam: str) -> None:
    part = "part: {outer: 200}\n" if "internal" in cam else ""
    recipe = SimpleNamespace(error=lambda *told: ValueError(f"{told[0]}: {told[1]}"))
    _demand_one_outside(recipe, designed(load_text(f"{part}cam: {{{cam}}}\n", "a.yaml")), 2)


@pytest.mark.parametrize("name", LOBES)
def test_what_a_follower_touches_from_outside_is_a_lobe(name: str) -> None:
    demand(LOBES[name])


@pytest.mark.parametrize("problem", NONE)
def test_what_is_none(problem: str) -> None:
    for cam in NONE[problem]:
        with pytest.raises(ValueError, match=rf"^camshaft\.lobes\[2\]\.recipe: {problem}"):
            demand(cam)
