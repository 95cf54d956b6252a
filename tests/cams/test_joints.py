"""What jumps where the parts of a motion meet: in the report, and as a remark where it is the acceleration."""

import math

import pytest

from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

BREADTH = "kind: constant-breadth, base_radius: 40"
ROLLER = "kind: double-roller, ratio: 2, arm: 60, roller_radius: 8"


def recipe(cam, units="mm"):
    return load_text(
        f"units: {units}\ncam: {{{cam}}}\nexport: {{files: [csv]}}\nverify: {{angles: 360}}\n", "case.yaml"
    )


def report(cam, units="mm"):
    return pipeline.check(recipe(cam, units)).report


def jumps(cam, order):
    """Degrees and limits at the joints of a derivative."""
    joints = report(cam)["joints"]
    found = [(one["at_deg"], one["before"], one["after"]) for one in joints if one["derivative"] == order]
    return [tuple(round(value, 6) for value in one) for one in found]


def test_a_harmonic_rise_jumps_at_both_ends_and_is_remarked_on():
    a = 10 / 2 * (math.pi / math.radians(100)) ** 2
    found = report(f"{BREADTH}, motion: [{{rise: 10, over: 100, law: harmonic}}, {{dwell: 80}}]")
    expected = [(0.0, 0.0, a), (100.0, -a, 0.0)]
    assert [(one["at_deg"], one["before"], one["after"]) for one in found["joints"]] == [
        pytest.approx(one, abs=1e-9) for one in expected
    ]
    assert {(one["derivative"], one["unit"]) for one in found["joints"]} == {(2, "mm/rad^2")}
    (remark,) = (one for one in found["remarks"] if one["name"] == "acceleration-jump")
    assert remark["sentence"] == "S'' jumps from 0 to 16.2 mm/rad^2 at 0 degrees, and at 1 other joint by no more"
    assert (remark["value"], remark["rule"], remark["unit"]) == (pytest.approx(a), 0, "mm/rad^2")
    assert found["ok"]


def test_joints_are_told_in_inches():
    cam = "kind: constant-breadth, base_radius: 2, motion: [{rise: 0.4, over: 180, law: parabolic}]"
    found = report(cam, "inch")
    assert {one["unit"] for one in found["joints"]} == {"in/rad^2"}
    assert [(one["at_deg"], one["before"], one["after"]) for one in found["joints"]] == [
        pytest.approx((90, 4 * 0.4 / math.pi**2, -4 * 0.4 / math.pi**2))
    ]
    (remark,) = (one for one in found["remarks"] if one["name"] == "acceleration-jump")
    assert remark["unit"] == "in/rad^2"
    assert "in/rad^2 at 90 degrees" in remark["sentence"]


@pytest.mark.parametrize(
    ("motion", "order"),
    [
        ("[{rise: 9, over: 120, law: cycloidal}, {dwell: 60}]", 3),
        ("{formula: '5*(1 - cos(t)) + max(0, sin(2*t))**3'}", 3),
        ("{formula: 5*(1 - cos(t)) + 2*abs(sin(t - 1))*sin(t - 1) + 2*sin(1)**2}", 2),
        ("{lobe: {lift: 3, half: 60, powers: [2, 3, 4, 5, 6]}}", 3),
    ],
)
def test_what_jumps_first_is_told(motion, order):
    found = report(f"{BREADTH}, motion: {motion}")
    assert min(one["derivative"] for one in found["joints"]) == order
    assert ("acceleration-jump" in {one["name"] for one in found["remarks"]}) == (order == 2)


@pytest.mark.parametrize(
    "motion",
    [
        "[{rise: 9, over: 120, law: polynomial-4567}, {dwell: 60}]",
        "{formula: 6*(1 - cos(t))}",
        "{points: [[0, 0], [50, 3], [90, 5], [130, 7], [180, 10]]}",
        "{lobe: {lift: 3, half: 68, powers: [2, 8, 14, 20, 26]}}",
    ],
)
def test_a_smooth_motion_has_no_joints(motion):
    assert report(f"{BREADTH}, motion: {motion}")["joints"] == []


def test_joints_of_a_swing_are_those_of_its_period():
    """With psi' = 0 the image of psi over the next delta has -psi'' (W 4.9)."""
    a = 4 / 2 * (math.pi / math.radians(45)) ** 2
    law = "[{rise: 4, over: 45, law: harmonic}, {return: 4, over: 45, law: harmonic}]"
    assert jumps(f"{ROLLER}, law: {law}", 2) == [(0.0, -32.0, 32.0), (90.0, 32.0, -32.0)]
    assert a == pytest.approx(32)
    assert jumps(f"kind: flat-pair, ratio: 2, arm: 200, law: {law.replace('4,', '0.5,')}", 2) == [
        (0.0, -4.0, 4.0),
        (90.0, 4.0, -4.0),
    ]


def test_a_first_arc_by_a_formula_tells_its_joints():
    cam = f"{ROLLER.replace('2,', '3,', 1)}, arc: {{formula: 120*cos(pi/6) + 2*sin(3*t)}}"
    first, second = jumps(cam, 2)
    assert first[1] == pytest.approx(-first[2])
    assert second[1] == pytest.approx(-second[2])
    assert designed(recipe(cam.replace("2*sin(3*t)", "2*sin(3*t)**3"))).exact.joints == ()


def test_a_circular_arc_and_a_support_function_have_none_of_a_motion():
    assert report("kind: support, reuleaux: {sides: 3, breadth: 50, rounding: 5}")["joints"] == []
    assert report("kind: double-roller, ratio: 3, arm: 60, roller_radius: 8, arc: {radius: 80}")["joints"] == []


@pytest.mark.parametrize(
    ("cam", "message"),
    [
        (f"{BREADTH}, motion: [{{dwell: 60}}, {{rise: 9, over: 120, law: constant-velocity}}]", "does not join"),
        (
            f"{ROLLER}, law: [{{rise: 4, over: 45, law: constant-velocity}}, {{return: 4, over: 45, law: cubic}}]",
            "jumps",
        ),
        (f"{ROLLER}, law: [{{rise: 4, over: 45, law: cubic}}, {{return: 3, over: 45, law: cubic}}]", "come back to 0"),
    ],
)
def test_a_jump_of_the_displacement_or_the_velocity_is_refused(cam, message):
    with pytest.raises(RecipeErrors, match=message):
        designed(recipe(cam))


@pytest.mark.parametrize(
    ("route", "problem"),
    [
        (
            "delta: {formula: 600*cos(4*t), cos: {1: 600}}",
            "cam.delta.cos: cannot stand beside formula; leave one of them out",
        ),
        (
            "arc: {formula: '90 + t', side: concave}",
            "cam.arc.side: cannot stand beside formula; leave one of them out",
        ),
        ("arc: {side: concave}", "cam.arc: needs radius or formula; give exactly one of them"),
        ("delta: {formula: 600*cos(5*t)}", "cam.delta.formula: D(t + delta) must be -D(t)"),
    ],
)
def test_a_formula_of_a_route_is_refused_at_its_field(route, problem):
    with pytest.raises(RecipeErrors) as caught:
        designed(recipe(f"{ROLLER.replace('2,', '4/3,', 1)}, {route}"))
    (error,) = caught.value.errors
    assert problem in str(error)


def test_d_by_a_formula_passes_for_rollers_and_flats():
    assert report(f"{ROLLER.replace('2,', '4/3,', 1)}, delta: {{formula: 600*cos(4*t) + 40*cos(4*t)**3}}")["ok"]
    assert report("kind: flat-pair, ratio: 2, arm: 30, delta: {formula: 200*cos(2*t)}")["ok"]
    inch = "kind: double-roller, ratio: 4/3, arm: 2, roller_radius: 0.3, delta: {formula: 0.6*cos(4*t)}"
    plain = "kind: double-roller, ratio: 4/3, arm: 2, roller_radius: 0.3, delta: {cos: {1: 0.6}}"
    first, second = (recipe(cam, "inch").cam.exact().law.psi_of_shaft(1.1, 1) for cam in (inch, plain))
    assert first == pytest.approx(second, abs=1e-13)


@pytest.mark.slow
def test_rounding_at_the_ends_of_a_short_rise_is_no_jump():
    """A rise over a hundredth of a degree has accelerations of 1e9: what rounding leaves of them at its ends is 0."""
    rows = "[{rise: 27, over: 0.01, law: cycloidal}, {dwell: 50}, {return: 27, over: 1, law: polynomial-4567}, "
    made = recipe(
        f"kind: disc, base_radius: 50, follower: {{kind: roller, radius: 5}}, motion: {rows}{{dwell: 308.99}}]"
    )
    assert [[order for order, _, _ in joint.jumps] for joint in designed(made).exact.joints] == [[3], [3]]


def of_swing(segments, order):
    swing = f"kind: constant-breadth, base_radius: 60, swing: [{segments}]"
    text = f"cam: {{{swing}}}\nlinkage: {{kind: inverted-slider-crank, ground: 80, rocker: 0}}\n"
    found = pipeline.check(load_text(f"{text}export: {{files: [csv]}}\nverify: {{angles: 90}}\n", "case.yaml")).report
    assert {one["unit"] for one in found["joints"]} <= {"deg/rad^2", "deg/rad^3"}
    return [(one["at_deg"], one["before"], one["after"]) for one in found["joints"] if one["derivative"] == order]


def test_the_joints_of_a_frames_swing_stand_at_the_shafts_angles():
    """At 140 degrees, where the rise ends, and at 0, where the law follows its own image."""
    a = 20 / 2 * (180 / 140) ** 2
    told = of_swing("{rise: 20, over: 140, law: harmonic}, {dwell: 60}", 2)
    assert told == [pytest.approx(one, abs=1e-9) for one in ((0.0, 0.0, a), (140.0, -a, 0.0))]
    # from rest to rest over all of it: the image begins and ends as the law does, upside down, but for its jerk
    whole = "{rise: 20, over: 200, law: harmonic}"
    assert of_swing(whole, 2) == []
    ((at, before, after),) = of_swing(whole, 3)
    a = math.radians(20) / 2 * (180 / 200) ** 2
    # at rest the third derivative of the image is the law's, negative, less six squares of the second: chain rule
    assert (at, before) == (0.0, pytest.approx(math.degrees(-6 * a * a), abs=1e-9))
    assert after == pytest.approx(0.0, abs=1e-9)
