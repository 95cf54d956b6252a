"""Sizes that are written out into a recipe are in its own unit: the cam that is read back is the same."""

from __future__ import annotations

import pytest

import camgeo

RISE = "{{rise: {rise}, over: 90, law: cycloidal}}, {{dwell: 90}}"
CAM = (
    "cam: {{kind: disc, sizing: {{pressure-angle: {{at_most: 30}}}}, follower: {{kind: roller, radius: {radius}}}, "
    f"motion: [{RISE}, {RISE.replace('{{rise', '{{return')}]}}}}\n"
)


def test_the_sized_recipe_has_the_same_cam_in_each_unit() -> None:
    sizes = []
    for head, unit in (("", 1.0), ("units: inch\n", 25.4)):
        recipe = camgeo.load(head + CAM.format(radius=10.16 / unit, rise=12.7 / unit))
        again = recipe.sized()
        assert not again.cam.sizes
        assert again.cam.sizes != recipe.cam.sizes
        assert again.cam.base_radius == pytest.approx(recipe.cam.base_radius, rel=1e-12)
        sizes.append(again.cam.base_radius)
    assert sizes[0] == pytest.approx(sizes[1], rel=1e-9)
    assert 10.0 < sizes[0] < 60.0
