"""Estimates of cams without a linkage against their exact designs; and that no design is kept by an estimate alone.

Holds: camgeo.capabilities.sweep.samples, camgeo.capabilities.sweep.extension.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from camgeo.capabilities.sweep.cams import REASONS
from camgeo.capabilities.sweep.engines import Workers
from camgeo.capabilities.sweep.figures import Evaluator, estimable_figures
from camgeo.capabilities.sweep.keys import varied_fields
from camgeo.capabilities.sweep.screen import error_of, estimates
from camgeo.capabilities.sweep.search import search
from camgeo.capabilities.sweep.task import EXACT, SweepTask
from camgeo.recipe.loading import load, load_text
from camgeo.schema.errors import RecipeErrors

MOTION = "[{rise: 20, over: 110, law: LAW}, {dwell: 50}, {to: 0, over: 120, law: LAW}, {dwell: 80}]"
DISC = f"kind: disc, base_radius: 40, motion: {MOTION}, follower: "
LOBE = "{lobe: {lift: 4, half: 70, powers: [2, 6, 10, 14, 18]}}"
SIZE, RISE = {"cam.base_radius": (30, 60)}, {"cam.motion[0].rise": (5, 25)}
STEM = {**SIZE, "cam.follower.offset": (-12, 12), **RISE}
ARM = {**SIZE, "cam.follower.arm.pivot": (75, 95), "cam.follower.arm.length": (55, 75), **RISE}
CAMS = {
    "roller": (DISC + "{kind: roller, radius: 9, offset: 5}", {**STEM, "cam.follower.radius": (4, 14)}),
    "knife-edge": (DISC + "{kind: knife-edge, offset: 5}", STEM),
    "shoe": (DISC + "{kind: shoe, radius: 20, offset: 5}", STEM),
    "flat": (
        DISC.replace("40", "90") + "{kind: flat, tilt: 5, offset: 5}",
        {"cam.base_radius": (70, 120), "cam.follower.tilt": (-20, 20), "cam.motion[0].rise": (5, 12)},
    ),
    "arm": (DISC + "{kind: roller, radius: 9, arm: {length: 65, pivot: 80}}", ARM),
    "leading arm": (DISC + "{kind: shoe, radius: 9, arm: {length: 65, pivot: 80, side: leading}}", ARM),
    "flat arm": (
        DISC + "{kind: flat, arm: {pivot: 90, face: 5}}",
        {**SIZE, "cam.follower.arm.pivot": (75, 95), "cam.follower.arm.face": (-5, 10), "cam.motion[0].rise": (2, 5)},
    ),
    "ring": (
        DISC.replace("kind", "track: internal, kind", 1) + "{kind: roller, radius: 9, offset: 5}",
        {"cam.base_radius": (50, 90), "cam.follower.radius": (4, 14), "cam.motion[0].rise": (5, 20)},
    ),
    "ring arm": (
        DISC.replace("kind", "track: internal, kind", 1) + "{kind: roller, radius: 9, arm: {length: 65, pivot: 80}}",
        {"cam.base_radius": (50, 80), "cam.motion[0].rise": (5, 20)},
    ),
    "constant breadth": (
        "kind: constant-breadth, base_radius: 60, motion: [{rise: 8, over: 120, law: LAW}, {dwell: 60}]",
        {"cam.base_radius": (50, 90), "cam.motion[0].rise": (3, 12)},
    ),
    "support": (
        "kind: support, fourier: {mean: 30, cos: {3: 0.8, 5: 0.2}, sin: {3: 0.7}}, shaft: [3, 2]",
        {"cam.fourier.cos.3": (-1, 1), "cam.fourier.mean": (20, 40), "cam.shaft[0]": (-5, 15), "cam.shaft[1]": (-5, 5)},
    ),
    "lobe": (
        f"kind: disc, base_radius: 18, follower: {{kind: flat}}, motion: {LOBE}",
        {"cam.base_radius": (18, 25), "cam.motion.lobe.lift": (2, 4), "cam.motion.lobe.half": (65, 85)},
    ),
}
LAWS = ["cycloidal", "modified-sine", "polynomial-4567", "double-harmonic"]
GUIDE = "dynamics: {rpm: 300, mass: 1, stiffness: 1e6, preload: 100, guide: {overhang: 30, length: 60, friction: 0.1}}"


def recipe(
    cam: str, ranges: dict[str, tuple[float, float]], law: str = "cycloidal", units: str = "mm", sweep: str = ""
):
    vary = ", ".join(f"'{path}': {{from: {low}, to: {high}}}" for path, (low, high) in ranges.items())
    more = f"units: {units}\n" + ("part: {thickness: 8, outer: 500}\n" if "internal" in cam else "")
    # needs: dynamics
    more += f"{GUIDE}\n" if "radius: 9, offset" in cam and "internal" not in cam else ""
    sweep = sweep or "method: random, count: 1, rank: size"
    return load_text(f"cam: {{{cam.replace('LAW', law)}}}\n{more}sweep: {{vary: {{{vary}}}, {sweep}}}\n", "a.yaml")


def assert_near(estimates, exact):
    """All figures of all designs, and why one has none."""
    assert [REASONS[code] for code in estimates.reason] == [REASONS[code] for code in exact.reason]
    assert {"size", "swing", "peak-jerk", "radius-of-curvature"} <= set(estimates.figures)
    for name, column in estimates.figures.items():
        for estimate, value in zip(column, exact.figures[name], strict=True):
            assert math.isnan(estimate) == math.isnan(value), name
            # the jerk, and radii that follow it, change most between two samples; a hollow may be hardly one
            most = 1e-2 if name in {"peak-jerk", "hollow-radius"} else 1e-3
            assert math.isnan(value) or error_of(name, float(estimate), float(value)) < most, name


@pytest.mark.thin(12)
@pytest.mark.parametrize("name", CAMS)
def test_estimates_are_near_the_exact_designs(name):
    text, ranges = CAMS[name]
    low, high = np.array(list(ranges.values()), dtype=float).T
    one = recipe(text, ranges, units="inch" if name == "roller" else "mm")
    evaluator = Evaluator.prepare(one, tuple(ranges), screened=True)
    assert evaluator.estimator is not None
    assert evaluator.estimator.template.resampled == ()
    values = np.array([0.6 * low + 0.4 * high, 0.2 * low + 0.8 * high])
    assert_near(evaluator.evaluate(values), Evaluator.prepare(one, tuple(ranges)).evaluate(values))


@pytest.mark.slow
@settings(deadline=None, max_examples=examples(15))
@given(st.sampled_from(sorted(CAMS)), st.sampled_from(LAWS), st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4))
def test_estimates_anywhere_are_near_the_exact_designs(name, law, shares):
    text, ranges = CAMS[name]
    one = recipe(text, ranges, law)
    ends = list(ranges.values())
    values = np.array([[low + share * (high - low) for (low, high), share in zip(ends, shares, strict=False)]])
    exact = Evaluator.prepare(one, tuple(ranges)).evaluate(values)
    estimates = Evaluator.prepare(one, tuple(ranges), screened=True).evaluate(values)
    near_undercut = abs(estimates.figures.get("radius-of-curvature", np.ones(1))[0]) < 0.05
    if not near_undercut and not {"undercut"} & {REASONS[exact.reason[0]]}:
        assert_near(estimates, exact)


def test_why_a_design_has_no_estimate():
    text, ranges = CAMS["roller"]
    one = recipe(text, ranges)
    values = np.array([[40.0, 5.0, 20.0, 9.0], [1.0, 0.0, 25.0, 40.0], [10.0, 40.0, 20.0, 9.0]])
    both = [Evaluator.prepare(one, tuple(ranges), screened=screened).evaluate(values) for screened in (False, True)]
    assert [REASONS[code] for code in both[1].reason] == ["", "undercut", "impossible"]
    assert list(both[0].reason) == list(both[1].reason)
    text, ranges = CAMS["support"]
    away = np.array([[0.8, 30.0, 40.0, 0.0]])
    outside = Evaluator.prepare(recipe(text, ranges), tuple(ranges), screened=True).evaluate(away)
    assert [REASONS[code] for code in outside.reason] == ["shaft-outside"]


def test_what_acts_otherwise_is_worked_out_anew():
    """The angle of a point moves a spline, and a number of waves makes another cam: neither acts linearly."""
    cam = "kind: disc, base_radius: 40, follower: {kind: roller, radius: 8}, motion: {points: "
    cam += "[[0, 0], [60, 5], [120, 15], [180, 20], [260, 6], [330, 0]]}"
    ranges = {"cam.base_radius": (35, 50), "cam.motion.points[2][0]": (110, 130), "cam.motion.points[2][1]": (13, 16)}
    one = recipe(cam, ranges)
    evaluator = Evaluator.prepare(one, tuple(ranges), screened=True)
    assert evaluator.estimator is not None
    assert evaluator.estimator.template.resampled == (1, 2)
    values = np.array([[40.0, 112.0, 14.0], [45.0, 128.0, 15.5]])
    assert_near(evaluator.evaluate(values), Evaluator.prepare(one, tuple(ranges)).evaluate(values))


@pytest.mark.parametrize(
    ("cam", "path", "why"),
    [
        (
            "kind: double-roller, ratio: 2, arm: 60, roller_radius: 8, delta: {cos: {1: 40}}",
            "cam.arm",
            "its contour is not",
        ),
        (f"undercut: trim, {CAMS['roller'][0]}", "cam.base_radius", "undercut is trimmed"),
        ("kind: support, reuleaux: {sides: 3, breadth: 60, rounding: 0}", "cam.reuleaux.breadth", "its contour is not"),
    ],
)
def test_what_is_not_screened_says_why(cam, path, why):
    one = recipe(cam, {path: (40, 80)}, sweep=f"method: random, count: {EXACT + 1}, rank: size")
    assert SweepTask.from_recipe(one).unscreened.startswith(why)
    assert not SweepTask.from_recipe(one).screened


@pytest.mark.parametrize(("rank", "why"), [("size", ""), ("mass", "mass is not sampled")])
def test_what_is_weighed_is_worked_out(rank, why):
    text = f"cam: {{{CAMS['roller'][0].replace('LAW', 'cycloidal')}}}\npart: {{thickness: 8, density: 7.85}}\nsweep: "
    text += f"{{vary: {{cam.base_radius: {{from: 40, to: 45}}}}, rank: {rank}, method: random, count: {EXACT + 1}}}\n"
    asked = SweepTask.from_recipe(load_text(text, "a.yaml"))
    assert asked.unscreened == why
    assert "mass" in asked.all_figures
    assert ("mass" in asked.figures) == bool(why)


def test_few_designs_are_all_exact():
    few, many = (recipe(*CAMS["roller"], sweep=f"method: random, count: {n}, rank: size") for n in (EXACT, EXACT + 1))
    assert not SweepTask.from_recipe(few).screened
    assert SweepTask.from_recipe(many).screened
    assert SweepTask.from_recipe(many).figures == estimable_figures(many)


# --- words ------------------------------------------------------------------------------------------------------------

KINDS = "{cam.base_radius: [40, 45], 'cam.motion[0].law': [cycloidal, harmonic], cam.follower.kind: [roller, shoe]}"


def worded(vary: str = KINDS, more: str = "rank: size", text: str = CAMS["roller"][0]):
    return load_text(f"cam: {{{text.replace('LAW', 'cycloidal')}}}\nsweep: {{vary: {vary}, {more}}}\n", "a.yaml")


def test_words_are_compared_in_the_lists_order():
    one = worded()
    asked = SweepTask.from_recipe(one)
    assert asked.plan.count == 8
    told = [asked.values_by_path(row) for row in asked.plan.values(0, 8)]
    assert told[:3] == [
        {"cam.base_radius": 40.0, "cam.motion[0].law": "cycloidal", "cam.follower.kind": "roller"},
        {"cam.base_radius": 40.0, "cam.motion[0].law": "cycloidal", "cam.follower.kind": "shoe"},
        {"cam.base_radius": 40.0, "cam.motion[0].law": "harmonic", "cam.follower.kind": "roller"},
    ]
    assert "roller-speed" not in asked.all_figures  # which a shoe has not
    assert "roller-speed" in SweepTask.from_recipe(worded("{cam.base_radius: [40, 45]}")).all_figures
    plan = SweepTask.from_recipe(worded(more="rank: size, method: random, count: 200")).plan
    assert len(np.unique(plan.values(0, 200)[:, 1])) == 2


@pytest.mark.slow
def test_designs_with_words_have_the_figures_of_their_recipes():
    asked = SweepTask.from_recipe(worded())
    values = asked.plan.values(0, 8)[[0, 5, 6]]
    found = asked.exact_figures(values)
    figures = [name for name in estimable_figures(asked.recipe) if name in asked.all_figures]
    screened = Evaluator.prepare(asked.recipe, asked.paths, figures=figures, screened=True).evaluate(values)
    assert_near(screened, found)
    text = asked.recipe.text.replace("law: cycloidal}, {dwell: 50", "law: harmonic}, {dwell: 50").replace(
        "radius: 40", "radius: 45"
    )
    by_hand = Evaluator.prepare(load_text(text, "a.yaml"), (), figures=asked.all_figures).evaluate(np.zeros((1, 0)))
    assert {name: column[2] for name, column in found.figures.items()} == {
        name: column[0] for name, column in by_hand.figures.items()
    }


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_files_tell_words(tmp_path):
    asked = SweepTask.from_recipe(worded(more="rank: peak-acceleration, keep: 1, limits: {size: {at_least: 64}}"))
    outcome = search(asked, tmp_path, Workers(1))
    best = outcome.report["best"][0]["values"]
    assert best == {"cam.base_radius": 45.0, "cam.motion[0].law": "harmonic", "cam.follower.kind": "roller"}
    assert outcome.report["sweep"]["vary"]["cam.motion[0].law"] == {"words": ["cycloidal", "harmonic"], "values": 2}
    rows = [row.split(",") for row in (outcome.folder / "sweep.csv").read_text(encoding="utf-8").splitlines()]
    assert rows[1][2:5] == ["45.0", "harmonic", "roller"]
    made = load(outcome.folder / "best-1.yaml")
    assert "rise: 20, over: 110, law: harmonic" in made.text
    assert not made.uses


def test_words_of_a_linkage():
    text = "cam: {kind: support, p: 25 + sin(3*t), shaft: [12, 6]}\ndwell: {band: 0.1}\n"
    text += "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105, assembly: open}\n"
    text += "sweep: {vary: {linkage.rocker: [105, 110], linkage.assembly: [crossed, open]}, rank: swing}\n"
    one = load_text(text, "a.yaml")
    values = SweepTask.from_recipe(one).plan.values(0, 4)
    found = Evaluator.prepare(one, tuple(axis.path for axis in varied_fields(one))).evaluate(values).figures["swing"]
    for row, (rocker, word) in enumerate([(105, "crossed"), (105, "open"), (110, "crossed"), (110, "open")]):
        single = load_text(
            text.replace("105,", f"{rocker},", 1).replace("assembly: open", f"assembly: {word}"), "a.yaml"
        )
        by_hand = Evaluator.prepare(single, (), figures=("swing",)).evaluate(np.zeros((1, 0)))
        assert found[row] == pytest.approx(by_hand.figures["swing"][0], rel=1e-12)


LAW, KIND = "sweep.vary.'cam.motion[0].law'", "sweep.vary.'cam.follower.kind'"


@pytest.mark.parametrize(
    ("vary", "place", "message"),
    [
        (
            "{'cam.motion[0].law': [cycloidal, modified-sin]}",
            f"a.yaml:2:49: {LAW}[1]",
            "with it cam.motion[0].law: unknown motion law, given 'modified-sin'; did you mean modified-sine?",
        ),
        (
            "{cam.follower.kind: [roller, flap]}",
            f"a.yaml:2:44: {KIND}[1]",
            "with it cam.follower.kind: not one of the choices, given 'flap'; did you mean flat?",
        ),
        (
            "{cam.follower.kind: [roller, roller]}",
            f"a.yaml:2:44: {KIND}[1]",
            "listed twice, given 'roller'; leave one of the two out",
        ),
        (
            "{cam.follower.kind: {from: 1, to: 2, steps: 3}}",
            f"a.yaml:2:35: {KIND}",
            "no number stands there; list the words that it takes, such as [cycloidal, modified-sine]",
        ),
        (
            "{cam.kind: [disc, support]}",
            "a.yaml:2:26: sweep.vary.'cam.kind'",
            "another cam has other keys; give it a recipe of its own",
        ),
        (
            "{cam.base_radius: [40, wide]}",
            "a.yaml:2:38: sweep.vary.'cam.base_radius'[1]",
            "not a number, given 'wide'; give a number in mm",
        ),
    ],
)
def test_words_that_are_none(vary, place, message):
    with pytest.raises(RecipeErrors) as caught:
        SweepTask.from_recipe(worded(vary))
    assert str(caught.value) == f"{place}: {message}"


def test_a_figure_that_a_word_has_not():
    with pytest.raises(RecipeErrors, match=r"'cam.follower.kind'\[1\]: with it sweep.rank: roller-speed needs"):
        SweepTask.from_recipe(worded(more="rank: roller-speed"))


# --- certification ----------------------------------------------------------------------------------------------------

SEARCH = (
    "method: sobol, count: 128, rank: size, keep: 3, limits: {pressure-angle: {at_most: 35}, swing: {at_least: 12}}"
)


@pytest.fixture
def swept(tmp_path):
    """Report and folder of a sweep of the roller's cam, some exact designs of which may be made to fall."""

    def sweep(text=SEARCH, fall=()):
        def lost(task, values, exactly=SweepTask.exact_figures):
            computed = exactly(task, values)
            if values[0].tolist() in fall:
                computed.reason[:] = REASONS.index("undercut")
            return computed

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(SweepTask, "exact_figures", lost)

            asked = SweepTask.from_recipe(recipe(*CAMS["roller"], sweep=text))
            outcome = search(asked, tmp_path, Workers(1))
        return outcome.report, outcome.folder

    return sweep


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_the_next_design_follows_where_one_falls(swept):
    report, folder = swept()
    best = [design["index"] for design in report["best"]]
    assert report["screen"]["used"]
    assert report["screen"]["certified"] >= 3
    assert report["screen"]["fell"] == {}
    for place, design in enumerate(report["best"], 1):
        made = load(folder / f"best-{place}.yaml")
        exact = Evaluator.prepare(made, ()).evaluate(np.zeros((1, 0))).figures
        for name, value in design["figures"].items():
            assert value == exact[name][0], name
    rows = (folder / "sweep.csv").read_text(encoding="utf-8").splitlines()
    assert rows[0].endswith(",certified")
    marks = [row.rpartition(",")[2] for row in rows[1:]]
    assert marks == sorted(marks, reverse=True)
    assert marks.count("1") == report["screen"]["certified"]
    errors = report["screen"]["greatest_error"]
    assert errors["size"]["of 1000 random designs"] > 0.0
    assert 0.0 < errors["pressure-angle"]["of the designs worked out here"] < 1e-3
    assert errors["pressure-angle"]["unit"] == "deg"
    # the best two turn out to be none: the others move up, and one more is worked out
    fallen = [list(design["values"].values()) for design in report["best"][:2]]
    kept = report["counts"]["kept"]
    report, folder = swept(fall=fallen)
    assert len(report["best"]) == 3
    assert report["best"][0]["index"] == best[2]
    assert report["screen"]["fell"] == {"undercut": 2}
    assert report["counts"]["kept"] == kept - 2
    indices = [int(row.split(",")[1]) for row in (folder / "sweep.csv").read_text(encoding="utf-8").splitlines()[1:]]
    assert not set(best[:2]) & set(indices)


@pytest.mark.usefixtures("no_pictures")
def test_where_all_fall_none_is_kept_and_the_nearest_is_exact(swept):
    hard = SEARCH.replace("at_most: 35", "at_most: 4")
    report, folder = swept(hard)
    assert folder.name.endswith(".rejected")
    assert not report["ok"]
    broken = report["nearest"]["breaks"]
    near = recipe(*CAMS["roller"]).text_with(report["nearest"]["values"])
    exact = Evaluator.prepare(load_text(near, "a.yaml"), ()).evaluate(np.zeros((1, 0))).figures
    assert report["nearest"]["value"] == exact[broken][0]
    assert report["screen"]["certified"] == 0
    assert sum(report["screen"]["fell"].values()) == 1


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_polishing_goes_by_estimates_and_keeps_exact_designs(swept):
    plain, _ = swept()
    polished, folder = swept(SEARCH.replace("keep: 3", "keep: 1, refine: true"))
    best = polished["best"][0]
    assert best["polished"]
    assert best["figures"]["size"] < plain["best"][0]["figures"]["size"]
    assert best["figures"]["pressure-angle"] <= 35.0
    assert best["figures"]["swing"] >= 12.0
    exact = Evaluator.prepare(load(folder / "best-1.yaml"), ()).evaluate(np.zeros((1, 0))).figures
    assert best["figures"]["size"] == exact["size"][0]


@pytest.mark.parametrize("name", ["pressure-angle", "size"])
def test_errors_are_degrees_or_shares(name):
    wanted = 0.5 if estimates()[name].in_degrees else 0.25
    assert error_of(name, 2.5, 2.0) == wanted
    assert error_of(name, math.inf, math.inf) == 0.0
