"""The best designs polished: never worse, within the ranges and the limits; and the recipes that came of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.places import RECIPES
from support.sweepers import evaluate

from camgeo.cams.flat_faced import breadth_of
from camgeo.capabilities.sweep import refine
from camgeo.capabilities.sweep.refine import PolishError, output_error, polish
from camgeo.capabilities.sweep.single_designs import mechanism_in, recipe_with
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.recipe.loading import load, load_text
from camgeo.synthesis.linkage import mechanism_of

pytest.importorskip("scipy")

TEXT = """
cam:
  kind: support
  p: sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25
  shaft: [18, 8.5]
linkage: {kind: KIND}
dwell: {band: 0.1}
sweep:
  vary: {VARY}
  method: random
  count: 100
  limits: {LIMITS}
  rank: RANK
"""
FOUR_BAR = "four-bar, ground: 80, coupler: 70, rocker: 105"
RANGES = "'cam.shaft[0]': {from: 14, to: 20}, 'cam.shaft[1]': {from: 5, to: 12}, linkage.rocker: {from: 100, to: 110}"


def task(limits="", rank="dwell", vary=RANGES, kind=FOUR_BAR):
    text = TEXT.replace("KIND", kind).replace("VARY", vary).replace("LIMITS", limits).replace("RANK", rank)
    return SweepTask.from_recipe(load_text(text, "a.yaml"))


@pytest.fixture(autouse=True)
def short(monkeypatch):
    monkeypatch.setattr(refine, "_GENERATIONS", 25)
    monkeypatch.setattr(refine, "_STEPS", 60)
    monkeypatch.setattr(refine, "_SLOW_GENERATIONS", 1)
    monkeypatch.setattr(refine, "_SLOW_STEPS", 5)


def start(task, values):
    given = dict(zip((axis.path for axis in task.sweep.vary), values, strict=True))
    found = evaluate(task.recipe, tuple(given), np.array([values]), samples=720)
    return given, {name: float(column[0]) for name, column in found.figures.items()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rank", "limits", "sense"),
    [
        ("dwell", "", 1),
        ("dwell", "transmission-angle: {at_least: 34.5}, size: {at_most: 44}", 1),
        ("peak-acceleration", "swing: {at_least: 25}", -1),
        ("shaft-rate", "dwell: {at_least: 30}", 1),
    ],
)
def test_a_design_gets_better_within_its_ranges_and_limits(rank, limits, sense):
    asked = task(limits, rank)
    given, before = start(asked, (18.0, 8.5, 105.0))
    values, after = polish(asked, given)
    assert sense * after[rank] > sense * before[rank]
    for axis in asked.sweep.vary:
        assert axis.low <= values[axis.path] <= axis.high
    for limit in asked.sweep.limits:
        assert limit.at_least is None or after[limit.figure] >= limit.at_least
        assert limit.at_most is None or after[limit.figure] <= limit.at_most
    assert (values, after) == polish(asked, given)
    # few digits, and the figures of just these values
    assert all(len(repr(value)) <= 11 for value in values.values())
    again = start(asked, tuple(values.values()))[1]
    assert again == after


@pytest.mark.slow
def test_a_design_that_breaks_a_limit_is_brought_within():
    asked = task("transmission-angle: {at_least: 36}")
    given, before = start(asked, (18.0, 8.5, 105.0))
    assert before["transmission-angle"] < 36
    assert polish(asked, given)[1]["transmission-angle"] >= 36


@pytest.mark.slow
def test_where_nothing_better_is_found_the_start_stays():
    asked = task("dwell: {at_least: 170}")
    given, _ = start(asked, (18.0, 8.5, 105.0))
    assert polish(asked, given)[0] == given


@pytest.mark.slow
def test_listed_values_stay():
    asked = task(vary="linkage.rocker: [100, 105], 'cam.shaft[0]': {from: 14, to: 20}")
    given, before = start(asked, (105.0, 17.0))
    values, after = polish(asked, given)
    assert values["linkage.rocker"] == 105.0
    assert after["dwell"] > before["dwell"]
    alone = task(vary="linkage.rocker: [100, 105]")
    assert polish(alone, {"linkage.rocker": 105.0})[0] == {"linkage.rocker": 105.0}


def test_where_there_is_nothing_to_gain_the_start_stays():
    # the cam's least radius of curvature does not depend on where its shaft is
    asked = task(rank="radius-of-curvature", vary="'cam.shaft[0]': {from: -20, to: 20}")
    assert polish(asked, {"cam.shaft[0]": 17.0})[0] == {"cam.shaft[0]": 17.0}


def test_a_polished_zero_has_no_sign():
    asked = task(vary="'cam.shaft[1]': {from: -20, to: 20}")
    goal = refine._goal(asked, ["cam.shaft[1]"], np.array([3.0]))
    assert repr(float(refine._rounded(goal, np.array([-1e-9]))[0])) == "0.0"


def test_designs_made_one_by_one(monkeypatch):
    monkeypatch.setattr(refine, "_MEMBERS", 6)
    monkeypatch.setattr(refine, "_ANGLES", 90)
    dyads = ", dyads: [{kind: rrr, on: output, point: [80, 0], ground: [140, 80], links: [100, 30]}]"
    asked = task(kind=FOUR_BAR + dyads, rank="swing", vary="linkage.rocker: {from: 104, to: 106}")
    given, before = start(asked, (105.0,))
    assert polish(asked, given)[1]["swing"] > before["swing"]


def narrow(asked, values):
    """The dwell (deg) that a file within the tolerance has at least."""
    recipe = recipe_with(asked.recipe, list(values), list(values.values()))
    (longest,) = mechanism_in(recipe).dwells(recipe.dwell.band - 2.0 * output_error(recipe), "shaft", most=1)
    return math.degrees(longest.length)


@pytest.mark.slow
def test_a_dwell_is_polished_off_the_knifes_edge():
    # eight numbers with which a ripple just fills the band: within 0.001 mm it may leave it
    asked = SweepTask.from_recipe(load(RECIPES / "long-dwell.yaml"))
    numbers = (2.938, -0.0487, -0.0206, -0.0628, 14.833, 79.28, 61.85, 60.0)
    given = dict(zip((axis.path for axis in asked.sweep.vary), numbers, strict=True))
    assert narrow(asked, given) < 0.85 * start(asked, numbers)[1]["dwell"]
    values, after = polish(asked, given)
    assert narrow(asked, values) > 0.99 * after["dwell"]
    assert after["dwell"] > 90.0


@pytest.mark.thin(2)
@pytest.mark.parametrize("tolerance", ["0.05", "4"])
def test_a_tolerance_that_leaves_nothing_of_the_band_is_refused_with_one_that_does(tolerance):
    def coarse(tolerance):
        text = TEXT.replace("KIND", FOUR_BAR).replace("VARY", RANGES).replace("LIMITS", "").replace("RANK", "dwell")
        return SweepTask.from_recipe(load_text(f"{text}export: {{tolerance: {tolerance}}}\n", "a.yaml"))

    given = start(asked := coarse(tolerance), (18.0, 8.5, 105.0))[0]
    with pytest.raises(PolishError, match=r"give (export.tolerance at most|a smaller export.tolerance)") as refused:
        polish(asked, given)
    most = str(refused.value).rpartition(" ")[2]
    if most != "export.tolerance":
        assert output_error(coarse(most).recipe) < 0.5 * asked.recipe.dwell.band


def exact(recipe):
    lift = recipe.cam.exact().law
    mechanism = mechanism_of(recipe, lift, breadth_of(lift)[0])
    both = (mechanism.dwells(math.radians(0.1), over)[0].length for over in ("shaft", "relative"))
    return mechanism, [math.degrees(length) for length in both]


@pytest.mark.slow
def test_the_dwell_that_was_found_is_longer_than_the_papers():
    ours, theirs = load(RECIPES / "long-dwell.yaml"), load(RECIPES / "as-figure-9-2a.yaml")
    assert ours.dwell.band == math.radians(0.1)
    mechanism, (shaft, relative) = exact(ours)
    papers, (shaft_before, relative_before) = exact(theirs)
    assert shaft == pytest.approx(93.22303, abs=1e-4)
    assert relative == pytest.approx(75.17116, abs=1e-4)
    assert shaft > 2.5 * shaft_before
    assert relative > 1.66 * relative_before
    # the same breadth, as great a swing, and no weakness elsewhere
    assert mechanism.breadth == pytest.approx(papers.breadth)
    assert mechanism.figures().swing > papers.figures().swing
    assert math.degrees(mechanism.figures().transmission_least.value) > 45
    assert math.degrees(papers.figures().transmission_least.value) < 35
    assert mechanism.mobility().least_rate > papers.mobility().least_rate
    p = mechanism.lift.derivatives(np.linspace(0, 2 * math.pi, 10_000), 2)
    assert (p[0] + p[2]).min() > 4
    assert p[0].min() - ours.part.bore / 2 > 7


def test_the_shipped_recipe_keeps_the_limits_of_its_own_sweep():
    recipe = load(RECIPES / "long-dwell.yaml")
    found = evaluate(recipe, (), np.zeros((1, 0)), samples=720)
    assert found.reason[0] == 0
    assert found.figures["dwell"][0] == pytest.approx(93.22303, abs=1e-4)
