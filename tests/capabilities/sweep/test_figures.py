"""Figures of many designs against the exact mechanism of each; where a design has none, and why."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.sweepers import compute, evaluate

from camgeo.cams.flat_faced import breadth_of
from camgeo.capabilities.sweep.cams import REASONS
from camgeo.capabilities.sweep.figures import Evaluator
from camgeo.capabilities.sweep.figures import compute_figures as searched
from camgeo.capabilities.sweep.keys import sweep_figures as known
from camgeo.capabilities.sweep.linkages import LOOPS, Lengths, Support, angles, loop_class
from camgeo.capabilities.sweep.single_designs import recipe_with
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.measures.figures import design_figures
from camgeo.recipe.design_figure import NOTHING
from camgeo.recipe.figures import OF_DWELL, OF_FACE, OF_LINKAGE
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed
from camgeo.synthesis.linkage import mechanism_of
from kin.linkage import four_bar
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank

CAM_2A = "p: sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25"
FOURIER = "fourier: {mean: 25, cos: {1: 0.1, 3: 0.8, 5: 0.2}, sin: {3: 0.7, 5: -0.1}}"
FOUR_BAR = "kind: four-bar, ground: 80, coupler: 70, rocker: 105"
INVERTED = "kind: inverted-slider-crank, ground: 90, rocker: 20"
SLIDER = "kind: slider-crank, coupler: 70, offset: 12"
PATHS = {
    FOUR_BAR: ("linkage.ground", "linkage.coupler", "linkage.rocker"),
    INVERTED: ("linkage.ground", "linkage.rocker"),
    SLIDER: ("linkage.coupler", "linkage.offset"),
}
HERE = (NOTHING, OF_LINKAGE, OF_DWELL, OF_FACE)
OF_LINKAGES = tuple(name for name, figure in known().items() if figure.needs in HERE)
PIVOT = ("cam.shaft[0]", "cam.shaft[1]")


def recipe(shape=CAM_2A, linkage=FOUR_BAR, *, more="", assembly="open", pivot="[18, 8.5]", band=0.1, units="mm"):
    driven = f"linkage: {{{linkage}, assembly: {assembly}{more}}}\ndwell: {{band: {band}}}\n" if linkage else ""
    place = f"  shaft: {pivot}\n" if pivot else ""
    kind = "" if shape.startswith("kind") else "  kind: support\n"
    return load_text(f"units: {units}\ncam:\n{kind}  {shape}\n{place}{driven}part: {{thickness: 8}}\n", "a.yaml")


def exact(recipe):
    """Figures by kin, of a mechanism that turns."""
    lift = recipe.cam.exact().law
    mechanism = mechanism_of(recipe, lift, breadth_of(lift)[0])
    mobility = mechanism.mobility()
    if not mobility.turns:
        return None
    told, scale = mechanism.figures(), math.degrees(1) if mechanism.unit == "deg" else 1.0
    t = np.linspace(0, 2 * math.pi, 20_001)
    p = lift.derivatives(t, 2)
    return {
        "dwell": math.degrees(mechanism.dwells(recipe.dwell.band, "shaft")[0].length),
        "dwell-relative": math.degrees(mechanism.dwells(recipe.dwell.band, "relative")[0].length),
        "swing": scale * told.swing,
        "peak-velocity": scale * abs(told.velocity.value),
        "peak-acceleration": scale * abs(told.acceleration.value),
        "transmission-angle": math.degrees(told.transmission_least.value),
        "force-angle": math.degrees(told.force_least.value),
        "margin": mobility.margin,
        "shaft-rate": mobility.least_rate,
        "radius-of-curvature": (p[0] + p[2]).min(),
        "size": np.hypot(p[0], p[1]).max(),
        "contact-travel": np.ptp(p[1]),
    }


def dwells(recipe, over):
    """Lengths of all dwells by kin, degrees."""
    lift = recipe.cam.exact().law
    mechanism = mechanism_of(recipe, lift, breadth_of(lift)[0])
    return [math.degrees(dwell.length) for dwell in mechanism.dwells(recipe.dwell.band, over)]


def assert_like(figures, wanted, row=0, tolerance=3e-6):
    assert set(figures) == set(wanted)
    for name, value in wanted.items():
        assert figures[name][row] == pytest.approx(value, rel=tolerance, abs=tolerance), name


@pytest.mark.thin(8)
@pytest.mark.parametrize("assembly", few(["open", "crossed"], 3))
@pytest.mark.parametrize("shape", [CAM_2A, FOURIER, "hypocycloid: {cusps: 3, size: 2, breadth: 50}"])
@pytest.mark.parametrize("linkage", list(PATHS))
def test_figures_are_those_of_the_mechanism(linkage, shape, assembly):
    one = recipe(shape, linkage, assembly=assembly, pivot="[12, 6]")
    found = evaluate(one, (), np.zeros((1, 0)), samples=720)
    assert REASONS[found.reason[0]] == ""
    assert_like(found.figures, exact(one))


@pytest.mark.slow
@pytest.mark.parametrize("linkage", list(PATHS))
def test_a_joint_off_the_mid_line(linkage):
    one, path = recipe(linkage=linkage, more=", joint_offset: 0", pivot="[12, 6]"), ("linkage.joint_offset",)
    found = evaluate(one, path, np.array([[9.0], [-9.0]]), samples=720)
    for row, value in enumerate([9.0, -9.0]):
        assert_like(found.figures, exact(recipe_with(one, path, [value])), row)
    assert found.figures["swing"][0] != pytest.approx(found.figures["swing"][1], rel=1e-4)


def test_the_papers_dwell():
    found = compute_one(recipe(), {})
    assert found["dwell-relative"] == pytest.approx(45.174019358, abs=2e-6)
    assert found["dwell"] == pytest.approx(37.049100772, abs=2e-6)
    assert set(found) == set(OF_LINKAGES)


def compute_one(recipe, given, **how):
    found = evaluate(recipe, tuple(given), np.array([list(given.values())]), **how)
    return {name: float(column[0]) for name, column in found.figures.items()}


@pytest.mark.slow
@settings(deadline=None, max_examples=examples(15))
@given(
    st.sampled_from(list(PATHS)),
    st.integers(-2100, 2100).map(lambda n: n / 100),
    st.integers(-2100, 2100).map(lambda n: n / 100),
    st.lists(st.floats(0.05, 1.9), min_size=3, max_size=3),
    st.sampled_from(["open", "crossed"]),
)
@example("kind: inverted-slider-crank, ground: 90, rocker: 20", -2.32, -2.31, [1.5, 1.0, 1.0], "open")
def test_designs_anywhere_have_the_figures_of_their_mechanism_or_none(linkage, x, y, shares, assembly):
    one = recipe(FOURIER, linkage, assembly=assembly)
    sizes = {name: 80 * share for name, share in zip(PATHS[linkage], shares, strict=False)}
    given = {**dict(zip(PIVOT, (x, y), strict=True)), **sizes}
    found = evaluate(one, tuple(given), np.array([list(given.values())]), samples=720)
    made = recipe_with(one, tuple(given), list(given.values()))
    p = made.cam.exact().law.derivatives(angles(720), 0)[0]
    if abs(p.min()) < 1e-6:
        return
    if p.min() < 0:
        assert REASONS[found.reason[0]] == "shaft-outside"
        return
    wanted = exact(made)
    if wanted is None:
        # what binds or reverses between two samples alone is not seen
        assert REASONS[found.reason[0]] in {"binds", "reverses"} or found.figures["shaft-rate"][0] < 0.05
        return
    if min(wanted["margin"] / 50, wanted["shaft-rate"]) < 0.2:
        return  # near a limit position the motion is too sharp for the samples
    for name, over in (("dwell", "shaft"), ("dwell-relative", "relative")):
        # of dwells as long as each other to half the angle between samples, any may be reported
        alike = [dwell for dwell in dwells(made, over) if dwell > wanted[name] - 180 / 720]
        wanted[name] = min(alike, key=lambda dwell: abs(dwell - found.figures[name][0]))
    assert_like(found.figures, wanted, tolerance=2e-4)


@pytest.mark.slow
def test_a_design_depends_on_no_other_to_the_last_bit():
    rng = np.random.default_rng(1)
    paths = (*PIVOT, "linkage.ground", "cam.fourier.cos.3", "cam.fourier.sin.5", "cam.fourier.mean")
    values = rng.uniform((-18, -18, 60, -1, -0.5, 22), (18, 18, 100, 1, 0.5, 28), (150, 6))
    one = recipe(FOURIER)
    whole = evaluate(one, paths, values)
    assert {REASONS[code] for code in whole.reason} >= {"", "shaft-outside"}
    cuts = [slice(0, 1), slice(1, 50), slice(50, 51), slice(51, 150)]
    parts = [evaluate(one, paths, values[cut]) for cut in cuts]
    assert np.array_equal(whole.reason, np.concatenate([part.reason for part in parts]))
    for name, column in whole.figures.items():
        assert np.array_equal(column, np.concatenate([part.figures[name] for part in parts]), equal_nan=True), name


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("shape", "given"),
    [
        (FOURIER, {"cam.fourier.cos.3": 0.5, "cam.fourier.sin.5": 0.2, "cam.fourier.mean": 26.0, "cam.shaft[1]": 5.0}),
        (FOURIER, {"cam.fourier.cos.1": 1.5}),
        ("hypocycloid: {cusps: 3, size: 2, breadth: 50}", {"cam.hypocycloid.size": 1.5, "cam.hypocycloid.breadth": 44}),
        ("hypocycloid: {cusps: 3, size: 2, breadth: 50}", {"cam.hypocycloid.cusps": 5, "cam.hypocycloid.size": 0.8}),
    ],
)
def test_fields_of_the_cam_that_vary(shape, given):
    one = recipe(shape, pivot="[12, 6]")
    found = evaluate(one, tuple(given), np.array([list(given.values())] * 2), samples=720)
    assert_like(found.figures, exact(recipe_with(one, tuple(given), list(given.values()))), row=1)


def test_a_cam_with_breaks():
    given = {"cam.reuleaux.rounding": 12.0, "linkage.rocker": 100.0}
    one = recipe("reuleaux: {sides: 3, breadth: 50, rounding: 10}", pivot="[5, 3]", band=0.5)
    found = evaluate(one, tuple(given), np.array([[12.0, 100.0], [30.0, 100.0], [12.0, 95.0]]), samples=7200)
    assert [REASONS[code] for code in found.reason] == ["", "impossible", ""]
    made = recipe_with(one, tuple(given), list(given.values()))
    wanted = {**exact(made), "radius-of-curvature": 12.0}
    # the least and the greatest lie at breaks, which samples miss by a step
    assert_like(found.figures, wanted, tolerance=5e-3)


def test_why_a_design_has_no_figures():
    paths = (*PIVOT, "linkage.rocker", "cam.fourier.cos.5")
    values = [
        [12.0, 6.0, 105.0, 0.2],
        [30.0, 6.0, 105.0, 0.2],
        [12.0, 6.0, 20.0, 0.2],
        [18.0, 8.5, 159.0, 0.2],
        [12.0, 6.0, 105.0, 2.0],
    ]
    found = evaluate(recipe(FOURIER), paths, np.array(values))
    assert [REASONS[code] for code in found.reason] == ["", "shaft-outside", "binds", "binds", "undercut"]
    for column in found.figures.values():
        assert np.isfinite(column[0])
        assert np.isnan(column[1:]).all()
    even = evaluate(recipe(FOURIER.replace("5: 0.2", "4: 0")), ("cam.fourier.cos.4",), np.array([[0.0], [0.1]]))
    assert [REASONS[code] for code in even.reason] == ["", "impossible"]


def test_a_shaft_that_would_turn_back():
    # the yoke r1 = 20, r4 = 0: no loop binds, yet phi' falls to -0.20
    one = recipe(linkage="kind: inverted-slider-crank, ground: 20, rocker: 0")
    found = evaluate(one, ("linkage.ground",), np.array([[20.0], [60.0]]))
    assert [REASONS[code] for code in found.reason] == ["reverses", ""]
    assert np.isnan(found.figures["shaft-rate"][0])


SWEPT = """
sweep:
  vary: {linkage.rocker: {from: 95, to: 115, steps: 21}}
  limits: {LIMITS}
  rank: dwell
"""


def swept(limits):
    base = recipe()
    return load_text(base.text + SWEPT.replace("LIMITS", limits), "a.yaml")


@pytest.mark.parametrize(
    ("rank", "limits", "without"),
    [
        ("dwell", "", {"dwell-relative", "peak-velocity", "peak-acceleration", "force-angle", "contact-travel"}),
        ("force-angle", "peak-velocity: {at_least: 0}", {"dwell-relative", "peak-acceleration", "contact-travel"}),
        ("dwell-relative", "", {"peak-velocity", "peak-acceleration", "force-angle", "contact-travel"}),
    ],
)
def test_a_search_goes_without_dear_figures_and_the_others_keep_their_bits(rank, limits, without):
    one = swept(limits)
    asked = SweepTask.from_recipe(load_text(one.text.replace("rank: dwell", f"rank: {rank}"), "a.yaml"))
    values = asked.plan.values(0, 21)
    cheap, whole = searched(asked.scene(asked.figures), values), asked.measure(values)
    assert set(OF_LINKAGES) - set(cheap) == without
    assert set(whole) == set(OF_LINKAGES)
    for name in set(OF_LINKAGES) - without:
        assert np.array_equal(cheap[name], whole[name], equal_nan=True), name


def test_what_chunks_share_is_prepared_once(monkeypatch):
    calls = []
    of = Evaluator.prepare

    def told(*given, **how):
        calls.append(given)
        return of(*given, **how)

    monkeypatch.setattr(Evaluator, "prepare", told)
    asked = SweepTask.from_recipe(swept("force-angle: {at_least: 20.125}"))
    scenes = [asked.scene(asked.figures) for _ in range(3)]
    calls.clear()
    for first, scene in zip((0, 7, 14), scenes, strict=True):
        searched(scene, asked.plan.values(first, first + 7))
    assert len(calls) <= 1


def test_designs_made_one_by_one_get_all_figures():
    dyads = ", dyads: [{kind: rrr, on: output, point: [80, 0], ground: [140, 80], links: [100, 30]}]"
    base = recipe(more=dyads)
    asked = SweepTask.from_recipe(load_text(base.text + SWEPT.replace("LIMITS", ""), "a.yaml"))
    assert asked.figures == asked.all_figures == OF_LINKAGES


def test_what_breaks_a_limit_is_computed_no_further():
    values = np.linspace(95, 115, 21)[:, None]
    whole = compute(swept(""), values)
    angle, speed = np.quantile(whole["transmission-angle"], 0.3), np.quantile(whole["peak-velocity"], 0.7)
    one = swept(f"transmission-angle: {{at_least: {angle}}}, peak-velocity: {{at_most: {speed}}}")
    screened = compute(one, values)
    broken = (whole["transmission-angle"] < angle) | (whole["peak-velocity"] > speed)
    assert broken.any()
    assert not broken.all()
    assert (screened["dwell"][broken] == -np.inf).all()
    for name, column in whole.items():
        assert np.array_equal(screened[name][~broken], column[~broken]), name
    codes = evaluate(one, ("linkage.rocker",), values).reason
    assert [REASONS[code] == "limits" for code in codes] == broken.tolist()


def test_a_limit_on_the_dwell_is_told_too():
    one = swept("dwell: {at_least: 37}")
    found = evaluate(one, ("linkage.rocker",), np.linspace(95, 115, 21)[:, None])
    assert [REASONS[code] == "limits" for code in found.reason] == (found.figures["dwell"] < 37).tolist()


def test_lengths_are_in_the_units_of_the_recipe_and_figures_in_mm():
    inch = recipe("fourier: {mean: 1, cos: {3: 0.05}}", pivot="[0.5, 0.2]", units="inch", linkage=FOUR_BAR_INCH)
    given = {"cam.shaft[0]": 0.55, "linkage.ground": 3.0, "cam.fourier.cos.3": 0.06}
    found = evaluate(inch, tuple(given), np.array([list(given.values())]), samples=720)
    assert_like(found.figures, exact(recipe_with(inch, tuple(given), list(given.values()))))
    assert found.figures["size"][0] > 25.4


FOUR_BAR_INCH = "kind: four-bar, ground: 3.2, coupler: 2.8, rocker: 4.2"


@pytest.mark.slow
def test_dyads_are_figured_design_by_design():
    rrr = ", dyads: [{kind: rrr, on: output, point: [80, 0], ground: [140, 80], links: [100, 30]}]"
    one = recipe(more=rrr, band=0.2)
    paths = ("cam.shaft[0]", "linkage.dyads[0].links[1]")
    found = evaluate(one, paths, np.array([[18.0, 30.0], [18.0, 2.0], [40.0, 30.0], [17.5, 33.0]]), samples=720)
    assert [REASONS[code] for code in found.reason] == ["", "binds", "shaft-outside", ""]
    for row, values in ((0, (18.0, 30.0)), (3, (17.5, 33.0))):
        assert_like(found.figures, exact(recipe_with(one, paths, values)), row=row)


@pytest.mark.slow
def test_a_recipe_without_a_linkage():
    one = recipe(linkage="")
    found = evaluate(one, ("cam.shaft[0]",), np.array([[18.0], [0.0]]))
    own = {"swing", "peak-velocity", "peak-acceleration", "peak-jerk", "pressure-angle", "contact-travel"}
    assert set(found.figures) == {"radius-of-curvature", "size", *own}
    assert (found.figures["pressure-angle"] == 0).all()
    t = np.linspace(0, 2 * math.pi, 20_001)
    p = one.cam.exact().law.derivatives(t, 3)
    for row, name in ((1, "peak-velocity"), (2, "peak-acceleration"), (3, "peak-jerk")):
        assert found.figures[name][0] == pytest.approx(np.abs(p[row]).max(), rel=1e-6)
    assert found.figures["swing"][0] == pytest.approx(np.ptp(p[0]), rel=1e-6)
    assert found.figures["contact-travel"][0] == pytest.approx(np.ptp(p[1]), rel=1e-5)
    assert found.figures["radius-of-curvature"] == pytest.approx(7.815923456997, abs=1e-9)
    assert found.figures["size"][0] == pytest.approx(compute_one(recipe(), {})["size"], rel=1e-6)
    roller = recipe(
        "kind: double-roller\n  ratio: 2\n  arm: 60\n  roller_radius: 8\n  delta: {cos: {1: 360}}", "", pivot=""
    )
    both = evaluate(roller, ("cam.roller_radius", "cam.arm"), np.array([[8.0, 60.0], [8.0, 5.0]]))
    assert [REASONS[code] for code in both.reason] == ["", "impossible"]
    assert both.figures["size"][0] > 0
    # of the contour, not of the roller's way, which is bent less by the roller's radius
    way = evaluate(roller, ("cam.roller_radius",), np.array([[8.0], [3.0]])).figures["radius-of-curvature"]
    assert way[1] - way[0] == pytest.approx(5.0, abs=1e-6)
    bent = evaluate(recipe(FOURIER, linkage=""), ("cam.fourier.cos.5",), np.array([[0.2], [2.0]]))
    assert [REASONS[code] for code in bent.reason] == ["", "undercut"]


def test_a_bore_has_no_bearing_on_a_cam_without_a_linkage_but_the_shaft_lies_within():
    given = np.array([[18.0, 0.0], [30.0, 0.0], [0.0, -27.0]])
    bored = load_text(recipe(linkage="").text.replace("thickness: 8", "thickness: 8, bore: 30"), "a.yaml")
    plain, other = (evaluate(one, PIVOT, given) for one in (recipe(linkage=""), bored))
    assert [REASONS[code] for code in other.reason] == ["", "shaft-outside", "shaft-outside"]
    for name, column in plain.figures.items():
        assert np.array_equal(column, other.figures[name], equal_nan=True), name


def test_a_constant_breadth_cam_drives_a_linkage():
    shape = (
        "kind: constant-breadth\n  base_radius: 20\n  motion: [{rise: 8, over: 120, law: cycloidal}, {dwell: 60}]\n"
        "  undercut: refuse"
    )
    one = recipe(shape, "kind: four-bar, ground: 80, coupler: 60, rocker: 90", pivot="")
    found = evaluate(one, ("linkage.rocker", "cam.base_radius"), np.array([[90.0, 20.0], [80.0, 22.0]]), samples=3600)
    wanted = exact(recipe_with(one, ("linkage.rocker", "cam.base_radius"), (80.0, 22.0)))
    assert_like(found.figures, wanted, row=1, tolerance=3e-3)


def test_no_number_at_a_path():
    with pytest.raises(ValueError, match="no number"):
        evaluate(recipe(FOURIER), ("cam.fourier.cos.9",), np.array([[1.0]]))


def test_few_samples_are_made_a_multiple_of_four():
    whole, few = (compute_one(recipe(), {}, samples=n)["dwell"] for n in (720, 177))
    assert few == pytest.approx(whole, abs=1e-3)


@pytest.mark.parametrize(
    ("linkage", "lengths"),
    [
        (FourBar(80, 70, 105), (80, 70, 105, 0)),
        (InvertedSliderCrank(90, 20), (90, 0, 20, 0)),
        (SliderCrank(70, 12), (0, 70, 0, 12)),
    ],
)
def test_the_margin_of_a_linkage_that_binds_is_negative(linkage, lengths):
    n = 48
    p = 25 + 200 * np.cos(angles(n))[None]
    cams = Support(np.array([[50.0]]), p, 0 * p, 0 * p)
    loop = loop_class(linkage).from_lengths(
        1.0, cams, Lengths(*(np.array([[float(length)]]) for length in (*lengths, 0)))
    )
    margin = loop.margin(lambda rows: rows.min(axis=1))
    s1 = np.roll(p[0], -n // 4)
    wanted = linkage.margins(p[0], s1, 50.0).min()
    assert (margin[0] < 0) == (wanted < 0)
    if wanted > 0:
        assert margin[0] == pytest.approx(wanted)


def test_screening_leaves_the_recipe_alone():
    one = swept("size: {at_most: 40}")
    assert one.without("sweep") == swept("").without("sweep")


@pytest.mark.slow
def test_links_that_shape_the_cam_make_it_anew():
    """Where the swing of the frame is given, the lift hangs on the lengths of the linkage."""
    swing = "swing: [{rise: 20, over: 140, law: cycloidal}, {dwell: 60}]"
    shape = f"kind: constant-breadth\n  base_radius: 80\n  {swing}"
    one = recipe(shape, "kind: inverted-slider-crank, ground: 80, rocker: 12", more=", joint_offset: 2", pivot="")
    paths = ("linkage.ground", "linkage.joint_offset", "cam.base_radius")
    values = np.array([[80.0, 2.0, 80.0], [95.0, 2.0, 80.0], [80.0, 20.0, 80.0], [80.0, 2.0, 84.0]])
    found = evaluate(one, paths, values, samples=7200)
    for row, numbers in enumerate(values):
        wanted = exact(recipe_with(one, paths, numbers))
        assert_like(found.figures, wanted, row, tolerance=3e-5)
        assert found.figures["swing"][row] == pytest.approx(20.0, abs=1e-6)
    assert np.ptp(found.figures["radius-of-curvature"]) > 1.0


# needs: dynamics
@pytest.mark.thin(4)
@pytest.mark.parametrize("figure", ["contact-force-least", "shaft-torque", "contact-pressure", "guide-force"])
def test_forces_of_a_rigid_train_are_ranked_by(figure):
    """Those of each design's own cam, as limits have them."""
    text = (
        "cam: {kind: disc, base_radius: 36, follower: {kind: roller, radius: 9}, "
        "motion: [{rise: 18, over: 180, law: cycloidal}, {return: 18, over: 180, law: cycloidal}]}\n"
        "dynamics: {mass: 0.4, preload: 900, rpm: 300, width: 10, material: steel, "
        "guide: {overhang: 40, length: 60, friction: 0.1}}\n"
        f"sweep: {{vary: {{cam.base_radius: {{from: 34, to: 40, steps: 2}}}}, rank: {figure}}}\n"
    )
    recipe = load_text(text, "cam.yaml")
    found = Evaluator.prepare(recipe, ["cam.base_radius"], figures=[figure]).evaluate(np.array([[34.0], [40.0]]))
    for value, base in zip(found.figures[figure].tolist(), (34, 40), strict=True):
        own = recipe.replace("cam.base_radius", base)
        exact = designed(own)
        assert value == design_figures(own, exact, exact.checks, [figure])[figure].value


def test_every_first_loop_has_an_engine():
    loops = (one for one in vars(four_bar).values() if isinstance(one, type) and one.__module__ == four_bar.__name__)
    assert set(LOOPS) == {loop for loop in loops if "margins" in vars(loop)}
