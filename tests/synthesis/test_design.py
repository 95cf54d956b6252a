"""The exact cam of a recipe: what its messages say would do does."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.cases import few

from camgeo.common.rounding import downward, upward
from camgeo.curve.undercut.bottleneck import OpenNeckError
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import Design, designed

BREADTH = """\
cam:
  kind: constant-breadth
  base_radius: {size!r}
  motion: [{{rise: {of}, over: 100, law: cycloidal}}, {{dwell: 80}}]
"""
ROLLER = "cam: {{kind: double-roller, ratio: 4/3, arm: 60, roller_radius: {size!r}, delta: {{cos: {{1: {of}}}}}}}\n"
BEYOND = 1e-8  # more than the least, less than the last digit


def sharp(text: str, **values: float) -> Design:
    return designed(load_text(text.format(**values), "sharp.yaml"))


def free(design: Design, words: str) -> float:
    assert design.only_surface.contour is None
    (detail,) = (check.detail for check in design.checks if check.name == "undercut-local")
    found = re.search(words + r" (\S+) would have no undercut", detail)
    assert found, detail
    return float(found[1])


@pytest.mark.thin(6)
@pytest.mark.parametrize("rise", [37.2, 39.8, 42.4, 45.0, 47.6, 50.2])
def test_the_base_radius_that_is_told_is_free_of_undercut(rise: float) -> None:
    larger = free(sharp(BREADTH, size=5.0, of=rise), "a base radius larger by more than")
    assert all(check.ok for check in sharp(BREADTH, size=(5.0 + larger) * (1.0 + BEYOND), of=rise).checks)
    assert sharp(BREADTH, size=(5.0 + larger) * (1.0 - 1e-5), of=rise).only_surface.contour is None


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("square", few([400.0, 497.3, 594.6, 789.2, 886.5], 3))
def test_the_roller_radius_that_is_told_is_free_of_undercut(square: float) -> None:
    below = free(sharp(ROLLER, size=40.0, of=square), "a roller radius below")
    assert all(check.ok for check in sharp(ROLLER, size=below * (1.0 - BEYOND), of=square).checks)
    assert sharp(ROLLER, size=below * (1.0 + 1e-5), of=square).only_surface.contour is None


@pytest.mark.parametrize(("units", "lower", "half"), [("mm", "25.4", "27.94"), ("inch", "1", "1.1")])
def test_what_is_left_open_is_told_in_the_recipes_unit(
    units: str, lower: str, half: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def undercuts(_: object) -> None:
        raise OpenNeckError(25.4, 27.94, (0.5, 1.5), seen=True)

    monkeypatch.setattr("camgeo.curve.undercut.undercut.undercuts", undercuts)
    cam = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n"
    with pytest.raises(RecipeErrors) as caught:
        designed(load_text(f"units: {units}\n{cam}", "neck.yaml"))
    said = str(caught.value)
    assert f"half the width of the neck there lies between {lower} and {half}; one below {lower} is proved" in said


@given(st.floats(1e-12, 1e12))
def test_rounded_figures_keep_their_side(value: float) -> None:
    assert float(upward(value)) >= value * (1.0 - 2e-9)
    assert float(downward(value)) <= value * (1.0 + 2e-9)
    assert float(upward(value)) == pytest.approx(value, rel=1.0001e-5)
    assert float(downward(value)) == pytest.approx(value, rel=1.0001e-5)


def test_round_figures_stay_round() -> None:
    for value in (6.0, 6.000000000000001, 5.999999999999999):
        assert upward(value) == downward(value) == "6"
    assert (upward(17.888543), downward(17.888543)) == ("17.8886", "17.8885")
    assert (upward(1.2345e-7, 3), downward(1.2345e-7, 3)) == ("1.24e-07", "1.23e-07")
