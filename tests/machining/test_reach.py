"""Whether a cutter reaches all of a cam, as a check with the least hollow and the largest cutter that does."""

from dataclasses import replace
from pathlib import Path

import pytest

from camgeo.curve.backwards import least_hollow
from camgeo.machining.reach import cutter_paths, milled_contours, path_arcs, reach_checks
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed

DEEP = """\
cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 4, delta: {cos: {1: 1500}}}
manufacture: {cutter: CUTTER}
export: {tolerance: 0.01, files: [dxf]}
"""


def milled(cutter):
    recipe = read(DEEP.replace("CUTTER", cutter).encode(), Path("deep.yaml"))
    return recipe, designed(recipe)


@pytest.mark.slow
def test_a_cutter_that_reaches_all_says_the_least_hollow():
    recipe, design = milled("9")
    ((check, path),) = reach_checks(recipe, design)
    hollow, _ = least_hollow(design.only_surface.contour)
    assert (check.ok, check.value, check.unit, path.lost) == (True, 0.0, "mm", ())
    assert check.detail.startswith(f"least hollow radius {hollow:.6g} mm at ")
    (beside,) = cutter_paths(recipe, design, 0.25)
    assert beside.radius == pytest.approx(4.75)
    assert path_arcs(recipe, path, 0.01).bound.outward <= 0.01


def test_a_cutter_too_wide_for_a_hollow_names_one_that_is_not():
    recipe, design = milled("11")
    ((check, path),) = reach_checks(recipe, design)
    hollow, _ = least_hollow(design.only_surface.contour)
    assert not check.ok
    assert check.value == max(cut.depth for cut in path.lost) > 0.0
    assert f"a cutter {2.0 * hollow:.6g} mm across would reach all" in check.detail


def test_nothing_is_milled_without_a_cutter():
    recipe, design = milled("9")
    with pytest.raises(ValueError, match="there is nothing to mill"):
        milled_contours(replace(recipe, manufacture=None), design)


def test_a_contour_without_a_hollow_names_none(monkeypatch):
    """Where it is not proved at once that there is none, its least radius is infinite."""
    monkeypatch.setattr("camgeo.machining.reach.no_hollow", lambda _: False)
    text = "cam: {kind: support, p: 20 + cos(2*t)}\nmanufacture: {cutter: 9}\n"
    recipe = read(text.encode(), Path("round.yaml"))
    ((check, _),) = reach_checks(recipe, designed(recipe))
    assert (check.ok, check.detail) == (True, "no hollow")
