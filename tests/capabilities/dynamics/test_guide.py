"""The angle and the distance at which a stem jams in its guide."""

import math
from pathlib import Path

import pytest

from camgeo.capabilities.dynamics.guide import guide_checks, jam_angle
from camgeo.capabilities.dynamics.keys import StemGuide
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed

TEXT = """\
cam:
  kind: disc
  base_radius: 40
  follower: {follower}
  motion: {{formula: 6*(1 - cos(t))}}
dynamics: {{mass: 1, rpm: 60, preload: 100, guide: {{overhang: 20, length: 40, friction: 0.1}}}}
export: {{tolerance: 0.01, files: [dxf]}}
"""


def test_a_guide_by_hand():
    guide = StemGuide(20.0, 40.0, 0.1)
    assert math.tan(guide.jam()) == pytest.approx(5.0)  # 40/(0.1 (2*20 + 40))
    assert math.tan(guide.jam(10.0)) == pytest.approx(4.0)
    assert guide.reach == pytest.approx(200.0)


def test_a_roller_is_pushed_with_its_greatest_pressure_angle():
    recipe = read(TEXT.format(follower="{kind: roller, radius: 10}").encode(), Path("guide.yaml"))
    exact = designed(recipe).exact
    angle, limit, at = jam_angle(exact, StemGuide(20.0, 40.0, 0.1))
    # tan = S'/(rb + rf + S): its square is greatest where cos t = 6/56
    assert math.tan(math.radians(angle)) == pytest.approx(6.0 / math.sqrt(56.0**2 - 36.0), rel=1e-9)
    assert limit == pytest.approx(math.degrees(math.atan(5.0)))
    assert at == pytest.approx(math.degrees(math.acos(6.0 / 56.0)), abs=1e-4)
    (check,) = guide_checks(recipe, exact)
    assert (check.ok, check.value, check.unit) == (True, angle, "deg")


@pytest.mark.slow
def test_a_flat_face_is_pushed_beside_the_stem():
    recipe = read(TEXT.format(follower="{kind: flat, width: 40}").encode(), Path("guide.yaml"))
    (check,) = guide_checks(recipe, designed(recipe).exact)
    assert (check.unit, check.limit) == ("mm", 200.0)
    assert check.value == pytest.approx(6.0, abs=1e-6)  # the greatest S'
    assert guide_checks(recipe.without("dynamics"), designed(recipe).exact) == []
