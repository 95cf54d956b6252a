"""Influences with the metal fixed against brute-force contact, and sums of them against a worked budget."""

from __future__ import annotations

import numpy as np
import pytest
from support.budgets import dimensions_of
from support.made_cases import CASES

from camgeo.capabilities.budget.dimensions import DIMENSIONS
from camgeo.capabilities.budget.influence import Influence, influence, velocities
from camgeo.capabilities.budget.keys import Budget
from camgeo.capabilities.budget.sums import by_name, powers, spread, total
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed
from kin.numeric.feet import equal_steps
from kin.numeric.records import replace

COMPONENTS = {"x": 0, "y": 1}
EXACT = 2e-9  # relative to 1 or the value: digits of the cases


def of_words(text: str, degrees: tuple[float, ...], guide: float = 0.0, *, relative: bool = False) -> Influence:
    """Influences of every dimension that a cam has."""
    recipe = load_text(text, "a.yaml")
    design = designed(recipe)
    shaft = np.radians(degrees)
    if relative and design.driven is not None:
        shaft = design.driven.mechanism.at(shaft, 0).shaft[0]
    words = dimensions_of(recipe)
    return influence(recipe, design, Budget(1.0, tuple((word, 1.0) for word in words), guide=guide), shaft)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", CASES)
def test_influences_are_those_of_brute_force_contact(name: str) -> None:
    case = CASES[name]
    rows = of_words(case.cam, case.angles, case.guide, relative=case.relative)
    for contact, expected in enumerate(case.rows):
        for dimension, values in expected.items():
            word, _, component = dimension.partition(".")
            word, part = (word, COMPONENTS[component]) if component in COMPONENTS else (dimension, 0)
            ours = [one.rows[contact, part] for one in rows.contributions if one.name == word]
            # sizes that each contact has of its own stand behind one another
            own = (
                max(ours, key=lambda row: float(np.abs(row).max()))
                if len(case.rows) == 1
                else ours[contact % len(ours)]
            )
            deviation = np.abs(own - values) / np.maximum(1.0, np.abs(values))
            assert deviation.max() < EXACT, (dimension, contact, own, values)


def test_a_roller_without_offset_and_a_yoke_follow_their_profile() -> None:
    """The error of the profile is that of the position: of a yoke always, of a roller where it is at rest."""
    roller = "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 5}, motion: [{dwell: 360}]}\n"
    for text in (roller, CASES["yoke"].cam):
        rows = of_words(text, (10.0, 100.0, 200.0))
        profile = [one.rows for one in rows.contributions if one.name == "profile"]
        assert np.abs(np.abs(np.sum(profile, axis=0)) - 1.0).max() < 1e-12


BUDGET = """
budget:
  permitted: 0.05
  tolerances: {profile: 0.01, follower.radius: 0.005, follower.offset: 0.02, angle: 0.05, bore: 0.01}
"""


def test_the_worked_budget() -> None:
    recipe = load_text(CASES["roller on a stem"].cam + BUDGET, "a.yaml")
    budget = recipe.of(Budget)
    assert budget is not None
    rows = influence(recipe, designed(recipe), budget, np.radians([50.0, 215.0, 300.0]))
    (output,) = rows.outputs()
    assert np.abs(total(rows, output, "worst") - [0.0519909960, 0.0560326036, 0.0301995528]).max() < 1e-10
    assert np.abs(total(rows, output, "rss") - [0.0266683158, 0.0262693897, 0.0160457949]).max() < 1e-10
    assert abs(spread(rows, output)[0] - 0.0159627349) < 1e-10
    added = by_name(rows, powers(rows, output, "worst"))
    shares = [added[name] / total(rows, output, "worst") for name in ("profile", "follower.offset", "angle")]
    assert np.abs(np.array(shares)[:, 0] - [0.1985, 0.0977, 0.4061]).max() < 5e-5


def test_the_error_where_the_machine_is_set_is_subtracted() -> None:
    recipe = load_text(CASES["roller on a stem"].cam + BUDGET.replace("0.05\n", "0.05\n  zero: 300\n", 1), "a.yaml")
    budget = recipe.of(Budget)
    assert budget is not None
    rows = influence(recipe, designed(recipe), budget, np.radians([50.0, 300.0]))
    (output,) = rows.outputs()
    of_name = by_name(rows, output.weights)
    assert abs(of_name["follower.offset"][0] - (0.2540729964 + 0.2279211529)) < 1e-9
    assert abs(of_name["angle"][0] - 24.1962834317) < 1e-9
    assert of_name["bore"][1] == of_name["angle"][1] == 0.0
    # another error of the profile at each angle: both count
    assert abs(of_name["profile"][0] - (1.0317718195 + 1.0256451881)) < 1e-9


def test_every_word_is_known_of_some_cam() -> None:
    seen = {word for case in CASES.values() for word in dimensions_of(load_text(case.cam, "a.yaml"))}
    assert set(DIMENSIONS) - seen == {
        "index",
        "conjugate.radius",
        "conjugate.distance",
        "conjugate.length",
        "conjugate.angle",
    }


CONJUGATE = """
cam:
  kind: disc
  base_radius: 34
  follower: {kind: roller, radius: 8, arm: {length: 65, pivot: 80}}
  conjugate: {radius: 9, length: 60, angle: 90}
  motion: [{rise: 20, over: 110, law: modified-sine}, {dwell: 50}, {return: 20, over: 120, law: cycloidal}, {dwell: 80}]
"""


def test_conjugate_discs_have_an_index_and_bores_of_their_own() -> None:
    rows = of_words(CONJUGATE, (30.0, 120.0, 230.0))
    index, bores = ([one.rows for one in rows.contributions if one.name == name] for name in ("index", "bore"))
    (turned,) = (one.rows for one in rows.contributions if one.name == "angle")
    assert np.abs(index[0][0]).max() == 0.0
    assert np.abs(index[0][1] - turned[1]).max() == 0.0
    assert len(bores) == 2
    assert rows.upper == 1


def test_play_of_a_groove_is_its_clearance_over_the_pressure_angle() -> None:
    groove = CASES["roller on a stem"].cam.rstrip() + "\n  track: {groove: {clearance: 0.03}}\npart: {outer: 170}\n"
    rows = of_words(groove, (50.0, 215.0))
    assert rows.play is not None
    assert np.abs(rows.play - 0.03 * np.array([1.0317718195, 1.1366018754])).max() < 1e-9
    between = rows.play_between()
    assert between is not None
    # a larger roller takes play on both flanks
    (radius,) = (i for i, one in enumerate(rows.contributions) if one.name == "follower.radius")
    assert np.abs(between.weights[radius] - 2.0 * np.array([1.0317718195, 1.1366018754])).max() < 1e-9


def test_a_frame_bears_on_either_pair_of_faces_and_plays_between_them() -> None:
    """Four-bar: worked cases of the breadths under the faces opposite, rad/mm."""
    case = CASES["four-bar"]
    rows = of_words(case.cam, case.angles, relative=True)
    breadth_x, breadth_y = (one.rows[:, 0] for one in rows.contributions if one.name == "breadth")
    under_minus_y = [0.0002872573, 0.0001855689, 0.0001097007, -0.0001143694]
    assert np.abs(breadth_y - [np.negative(under_minus_y), under_minus_y]).max() < 1e-9
    assert np.abs(breadth_x[1]).max() == 0.0
    between = rows.play_between()
    assert between is not None
    assert rows.play == pytest.approx(0.0)
    play = by_name(rows, between.weights)
    # a frame that is wider plays by as much, and so does a cam that is smaller under both opposite faces
    wider = np.abs(breadth_x[0]) + 2.0 * np.abs(breadth_y[0])
    assert play["breadth"] == pytest.approx(wider)
    assert play["profile"] == pytest.approx(2.0 * wider)
    assert max(np.abs(play[name]).max() for name in play if name not in {"breadth", "profile"}) < 1e-12


def test_a_preload_leaves_interference_in_place_of_play() -> None:
    preload = "preload: {interference: 0.02}"
    motion = "motion: [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]"
    yoke = of_words(f"cam: {{kind: constant-breadth, base_radius: 40, {motion}, {preload}}}\n", (30.0, 120.0, 230.0))
    assert yoke.play == pytest.approx(-0.02)
    four_bar = of_words(CASES["four-bar"].cam.replace("}\n", f", {preload}}}\n", 1), (30.0, 120.0, 230.0))
    between = four_bar.play_between()
    assert between is not None
    assert four_bar.play == pytest.approx(-0.02 * by_name(four_bar, between.weights)["breadth"])


def test_velocities_are_slopes_and_waves_of_the_profile() -> None:
    """Of a yoke the profile is the position's error: a wave t sin(n phi) has the velocity n t, an angle S'' t."""
    recipe = load_text(CASES["yoke"].cam, "a.yaml")
    stated = Budget(1.0, (("profile", 0.01), ("angle", 0.001)))
    shaft = equal_steps(3600)
    rates = velocities(influence(recipe, designed(recipe), stated, shaft), 12)
    weights = by_name(rates, rates.outputs()[0].weights)
    assert np.abs(weights["profile"] - 12.0).max() < 1e-9
    curved = designed(recipe).motion.travel(shaft, 2)[2]
    assert np.abs(weights["angle"] - np.abs(curved)).max() < 1e-2 * np.abs(curved).max()  # a step wide where S'' bends
    # and a contour of its own error adds the slope of that
    broad = replace(influence(recipe, designed(recipe), stated, shaft), contour=1e-3 * np.sin([3.0 * shaft] * 2))
    assert velocities(broad, 12).contour == pytest.approx(3e-3 * np.cos([3.0 * shaft] * 2), abs=1e-7)
    # the error where the machine is set stays the same, and has no velocity
    zeroed = velocities(influence(recipe, designed(recipe), replace(stated, zero=1.0), shaft), 12)
    assert np.abs(by_name(zeroed, zeroed.outputs()[0].weights)["profile"] - 12.0).max() < 1e-9
