"""Lobes as engine people give them: ramps, duration at a lift, lobe centre, lift area, round tappets, thousandths."""

import math
import re

import numpy as np
import pytest

from camgeo.measures.limits import limit_checks
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.law.sources.lobe import Ramp, lobe
from kin.law.sources.motion import Motion

DEGREE = math.radians(1.0)
POWERS = (2, 8, 14, 20, 26)
RAMP = Ramp(0.25, 0.02 / DEGREE)
LOBE = """
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat%s}
  motion: {lobe: {lift: 8.25, half: 66, powers: [2, 8, 14, 20, 26], ramp: {height: 0.25, velocity: 0.02}%s}}
part: {thickness: 14}
"""


def measured(text, limits):
    recipe = load_text(f"{text}limits: {{{limits}}}\n", "lobe.yaml")
    design = designed(recipe)
    return {check.name.removeprefix("limit:"): check for check in limit_checks(recipe, design, design.checks, (), None)}


def at(motion: Motion, degrees: float, order: int = 0) -> float:
    return float(motion.derivatives(np.array([degrees * DEGREE]), order)[order, 0])


def test_lobe_on_its_ramp() -> None:
    motion = lobe(8.25, 66 * DEGREE, POWERS, ramp=RAMP)
    worked = {0: 8.25, 20: 6.933955598, 45: 2.163978148, 60: 0.389009127}
    assert [at(motion, degrees) for degrees in worked] == pytest.approx(list(worked.values()), abs=6e-10)
    assert [at(motion, 66 + 17.5 - u) for u in (5, 10, 14, 17.5)] == pytest.approx(
        [0.01875, 0.1, 0.18, 0.25], abs=1e-14
    )
    assert [at(motion, 0, 2), at(motion, 66, 1)] == pytest.approx([-21.617405249, -1.145915590], abs=6e-10)
    assert {k for joint in motion.joints for k, *_ in joint.jumps} == {3}  # where the ramp begins and is steady


@pytest.mark.parametrize("nose", [0.0, 30.0, 83.5, 90.0, 180.0, 340.0, 360.0])
def test_nose_stands_where_it_is_asked_for(nose: float) -> None:
    motion, turned = (lobe(8.25, 66 * DEGREE, POWERS, ramp=RAMP, nose=angle * DEGREE) for angle in (0.0, nose))
    t = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    moved = turned.derivatives(np.mod(t + nose * DEGREE, 2.0 * np.pi), 2)
    assert moved == pytest.approx(motion.derivatives(t, 2), abs=1e-10)


@pytest.mark.parametrize(
    ("begin", "return_law", "end", "opens"),
    [
        ("", "cycloidal", ", {dwell: 60}", 0),
        ("{dwell: 60}, ", "harmonic", "", 60),
        ("{dwell: 20}, ", "parabolic", ", {dwell: 40}", 20),
    ],
)
def test_a_lobe_is_off_its_lowest_place_wherever_its_turn_begins(begin, return_law, end, opens) -> None:
    motion = f"{begin}{{rise: 9, over: 150, law: polynomial-4567}}, {{return: 9, over: 150, law: {return_law}}}{end}"
    text = f"cam: {{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 9}}, motion: [{motion}]}}\n"
    made = measured(text, "duration: {at_lift: 0, at_least: 601}")["duration"]
    assert made.value == pytest.approx(600.0, abs=1e-9)
    assert made.at_deg == pytest.approx(opens, abs=1e-9)


def test_duration_centre_velocity_and_area() -> None:
    figures = "duration: {at_lift: %s, at_least: 0}, lobe-centre: {at_most: 360}, "
    figures += "ramp-velocity: {at_most: 1}, lift-area: {at_lift: 0.25, at_most: 1000}"
    for lift, duration in ((0.4024, 238.452819623), (1.27, 200.061617891), (1.52, 193.858569753)):
        made = measured(LOBE % ("", ", nose: 100"), figures % lift)
        assert made["duration"].value == pytest.approx(duration, abs=6e-10)
        assert made["lobe-centre"].value == pytest.approx(100.0, abs=1e-9)
    ramp = 2.0 * (66.0 + 17.5 - 12.62)  # 0.1524 is 2.62 degrees up the steady part
    assert measured(LOBE % ("", ""), figures % 0.1524)["duration"].value == pytest.approx(2.0 * ramp, abs=1e-9)
    assert made["ramp-velocity"].value == pytest.approx(0.02, rel=1e-12)
    assert made["ramp-velocity"].unit == "mm/deg"
    assert made["lift-area"].value == pytest.approx(550.782624600, abs=6e-10)
    whole = measured(LOBE % ("", ""), "lift-area: {at_most: 1000}")["lift-area"].value
    assert whole == pytest.approx(550.782624600 + 0.25 * 132.0 + 3.225, abs=1e-8)


def test_lobe_centre_is_no_peak() -> None:
    """Of a lobe that closes more slowly than it opens the middle of the crossings lies after the peak, at 60."""
    motion = "[{rise: 8, over: 60, law: polynomial-345}, {return: 8, over: 90, law: polynomial-345}, {dwell: 210}]"
    text = re.sub(r"motion: .*", f"motion: {motion}", LOBE % ("", "")).replace("18", "30")
    made = measured(text, "lobe-centre: {at_most: 90}, duration: {at_least: 1}")
    u = np.roots([6.0, -15.0, 10.0, 0.0, 0.0, -1.27 / 8.0])
    (share,) = u[(abs(u.imag) < 1e-12) & (u.real > 0.0) & (u.real < 1.0)].real
    assert made["lobe-centre"].value == pytest.approx(0.5 * (60.0 * share + 60.0 + 90.0 * (1.0 - share)), abs=1e-8)
    assert made["duration"].value == pytest.approx(2.0 * 150.0 * (1.0 - share), abs=1e-8)


def test_one_figure_at_two_lifts() -> None:
    """Each entry of a list is a limit of its own, at its own lift, and a remedy names the one that fails."""
    lifts = "duration: [{at_lift: 1.27, at_least: 190}, {at_lift: 1.52, at_least: 194, at_most: 200}, {at_most: 300}]"
    with pytest.raises(RecipeErrors, match=re.escape("limits.duration[2]: limits.duration[0] at the same lift")):
        measured(LOBE % ("", ""), lifts.replace("at_most: 300", "at_least: 3"))
    recipe = load_text(f"{LOBE % ('', '')}limits: {{{lifts}}}\n", "lobe.yaml")
    design = designed(recipe)
    checks = limit_checks(recipe, design, design.checks, (), None)
    assert [check.name for check in checks] == ["limit:duration"] * 4
    assert [check.ok for check in checks] == [True, False, True, True]
    values = [200.061617891, 193.858569753, 193.858569753, 200.061617891]
    assert [check.value for check in checks] == pytest.approx(values, abs=6e-10)
    assert checks[0].detail == "at a lift of 1.27 mm"
    assert (
        checks[1].detail == "at a lift of 1.52 mm: a cam.motion.lobe.half about 1.00073 times as large would satisfy it"
    )
    wider = (LOBE % ("", "")).replace("half: 66", f"half: {66 * 1.0008}")
    mended = load_text(f"{wider}limits: {{{lifts}}}\n", "lobe.yaml")
    assert all(check.ok for check in limit_checks(mended, designed(mended), design.checks, (), None))


@pytest.mark.parametrize(
    ("limits", "wanted"),
    [
        ("duration: []", "limits.duration: an empty list"),
        ("duration: [{at_lift: 1}]", r"limits.duration\[0\]: no bound"),
        ("duration: [{at_lift: 1, at_leest: 3}]", r"limits.duration\[0\].at_leest: unknown key; did you mean at_least"),
        ("duration: [7]", r"limits.duration\[0\]: not a mapping"),
        ("size: [{at_most: 9}]", "limits.size: not a mapping, given a list of 1"),
    ],
)
def test_lists_of_limits_that_are_refused(limits: str, wanted: str) -> None:
    with pytest.raises(RecipeErrors, match=wanted):
        measured(LOBE % ("", ""), limits)


def test_lift_that_is_not_crossed_twice_fails_and_says_so() -> None:
    check = measured(LOBE % ("", ""), "duration: {at_lift: 9, at_least: 1}")["duration"]
    assert (check.ok, check.value) == (False, None)
    assert "passes 9 mm 0 times" in check.detail
    with pytest.raises(RecipeErrors, match="duration needs a stem that a cam of kind disc works"):
        load_text("cam: {kind: support, p: 25 + 2*cos(3*t)}\nlimits: {duration: {at_least: 1}}\n", "r")


@pytest.mark.parametrize(
    ("ramp", "wanted"),
    [
        ("{height: 8.25, velocity: 0.02}", "ramp's height must lie between 0 and the lift"),
        ("{height: 0.25, velocity: 0.002}", r"the ramp takes 175 degrees, 114 are left beyond `half`; 0\.0030701"),
        ("{height: 0.25}", r"ramp\.velocity: missing"),
    ],
)
def test_ramps_that_are_none(ramp: str, wanted: str) -> None:
    text = (LOBE % ("", "")).replace("{height: 0.25, velocity: 0.02}", ramp)
    with pytest.raises(RecipeErrors, match=wanted):
        designed(load_text(text, "r"))


def test_nose_of_a_half_turn_is_in_its_middle() -> None:
    text = "cam: {kind: constant-breadth, base_radius: 40, motion: {lobe: {lift: 4, half: 75, nose: 60, "
    with pytest.raises(RecipeErrors, match=r"cam\.motion\.lobe\.nose: the nose stands in the middle"):
        designed(load_text(f"{text}powers: [2, 6, 8, 10, 12]}}}}}}\n", "r"))


def test_round_tappet() -> None:
    text = LOBE % (", diameter: %s, axial_offset: -2", "")
    recipe = load_text(text % 30, "r")
    design = designed(recipe)
    check = next(check for check in design.checks if check.name == "face-width")
    assert check.limit == pytest.approx(math.sqrt(30.0**2 - 18.0**2), rel=1e-14)
    assert check.value is not None
    least = math.hypot(check.value, 18.0)
    for diameter, ok in ((least * (1.0 - 1e-6), False), (least * (1.0 + 1e-6), True)):
        found = designed(load_text(text % repr(diameter), "r")).checks
        assert next(check.ok for check in found if check.name == "face-width") is ok
    for given, wanted in (
        (
            ", diameter: 18, axial_offset: 2",
            r"follower\.diameter: the lobe reaches beyond the tappet, given 18 mm; give more than 18 mm",
        ),
        (", diameter: 30, width: 20", r"follower\.width: cannot be combined with diameter; give one of them"),
        (", axial_offset: 2", r"follower\.axial_offset: belongs to a round tappet; give diameter, or leave it out"),
        (", diameter: 30, arm: {pivot: 60}", "diameter: belongs to a stem, not to an arm"),
    ):
        with pytest.raises(RecipeErrors, match=wanted):
            load_text(LOBE % (given, ""), "r")


def test_a_table_of_crank_degrees_that_is_read_as_one_of_the_cam_says_what_to_give(tmp_path) -> None:
    rows = [f"{angle},{max(0.0, 8.0 * math.cos(math.radians(angle / 2.0))) ** 3:.6f}" for angle in range(0, 720, 4)]
    (tmp_path / "lift.csv").write_text("\n".join(rows) + "\n")
    text = "cam: {kind: disc, base_radius: 300, follower: {kind: flat}, motion: {table: lift.csv%s}}\n"
    with pytest.raises(RecipeErrors, match="covers more than 360 degrees; give angle: crank if its angles are the"):
        designed(load_text(text % "", str(tmp_path / "lobe.yaml")))
    designed(load_text(text % ", angle: crank, reading: 0.01", str(tmp_path / "lobe.yaml")))


def test_table_in_thousandths(tmp_path) -> None:
    motion = lobe(8.0, 68 * DEGREE, POWERS)
    rows = [(k, at(motion, float(k % 360))) for k in range(360)]
    for name, unit, digits in (("mm", 1.0, 4), ("thou", 0.0254, 2)):
        (tmp_path / f"{name}.csv").write_text("".join(f"{k}, {s / unit:.{digits}f}\n" for k, s in rows))
        table = f"motion: {{table: {name}.csv, units: {name}, reading: 0.001}}"
        (tmp_path / f"{name}.yaml").write_text(re.sub(r"motion: .*", table, LOBE % ("", "")))
    made = []
    for name in ("mm", "thou"):
        path = tmp_path / f"{name}.yaml"
        made.append(designed(load_text(path.read_text(), path)).motion.rows(np.linspace(0.0, 6.0, 50), 0)[0])
    assert made[0] == pytest.approx(made[1], abs=4e-3)
    assert made[1].max() == pytest.approx(8.0, abs=2e-3)
