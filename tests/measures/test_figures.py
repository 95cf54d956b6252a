"""Figures of disc cams: against dense samples, worked cases and their own definitions; limits, remarks and checks."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, cast

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.cases import examples

from camgeo.measures.figures import _play, design_figures
from camgeo.measures.limits import limit_checks
from camgeo.measures.remarks import remarks_of
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.follower.motion_error import Play

if TYPE_CHECKING:
    from camgeo.cams.disc_cams import DiscCam
    from camgeo.curve.moving_frame import Displacement
    from camgeo.measures.measured import Measured
    from camgeo.measures.rule_remark import RuleRemark
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check

MOTION = "[{rise: 24, over: 100, law: modified-sine}, {dwell: 40}, {return: 24, over: 140, law: modified-trapezoid}, "
MOTION += "{dwell: 80}]"
SWING = "[{rise: 20, over: 110, law: modified-sine}, {dwell: 50}, {return: 20, over: 120, law: cycloidal}, {dwell: 80}]"
FLAT = "[{rise: 12, over: 100, law: cycloidal}, {dwell: 40}, {return: 12, over: 100, law: modified-trapezoid}, "
FLAT += "{dwell: 120}]"


def disc(follower: str, motion: str = MOTION, base: float = 36.0, more: str = "") -> str:
    track = "" if ";" not in follower else "track: internal, "
    said = f"kind: disc, base_radius: {base}, follower: {{{follower.strip(';')}}}, {track}motion: {motion}"
    ring = "part: {outer: 400}\n" if track else ""
    return f"cam: {{{said}}}\n{ring}{more}"


def figures(text: str, *names: str) -> dict[str, Measured]:
    recipe = load_text(text, "cam.yaml")
    design = designed(recipe)
    return design_figures(recipe, design, design.checks, names)


def checks(text: str) -> dict[str, Check]:
    recipe = load_text(text, "cam.yaml")
    design = designed(recipe)
    return {check.name: check for check in (*design.checks, *limit_checks(recipe, design, design.checks, (), None))}


def remarks(text: str) -> dict[str, RuleRemark]:
    recipe = load_text(text, "cam.yaml")
    return {remark.name: remark for remark in remarks_of(recipe, designed(recipe))}


TRAIN = "dynamics: {mass: 1, stiffness: 2.0e5, preload: 900, rpm: 60, "
TRAIN += "guide: {overhang: 30, length: 40, friction: 0.15}}"
RISE, RETURN = "pressure-angle-rise", "pressure-angle-return"


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("offset", "rise", "back"),
    [
        (10, (14.433626554, 46.60080), (28.395362172, 216.15537)),
        (0, (23.443852354, 44.31670), (19.224649073, 213.91811)),
        (-10, (32.277169661, 41.82876), (9.850384833, 211.93806)),
    ],
)
def test_d02_pressure_angles(offset: float, rise: tuple[float, float], back: tuple[float, float]) -> None:
    found = figures(disc(f"kind: roller, radius: 9, offset: {offset}"), RISE, RETURN, "pressure-angle")
    for name, (value, at) in ((RISE, rise), (RETURN, back)):
        assert found[name].value == pytest.approx(value, abs=1.01e-9)
        assert found[name].at_deg == pytest.approx(at, abs=1.01e-5)
    assert found["pressure-angle"].value == pytest.approx(max(rise[0], back[0]), abs=1.01e-9)


def test_d07_pressure_angles_of_an_arm() -> None:
    arm = "kind: roller, radius: 8, arm: {length: 65, pivot: 80}"
    found = figures(disc(arm, SWING, 34.0), RISE, RETURN, "radius-of-curvature", "pitch-radius")
    assert found[RISE].value == pytest.approx(26.412053026, abs=1.01e-9)
    assert found[RETURN].value == pytest.approx(20.131074515, abs=1.01e-9)
    assert found["pitch-radius"].value == pytest.approx(39.474535506, abs=1.01e-9)
    assert found["radius-of-curvature"].value == pytest.approx(31.474535506, abs=1.01e-9)


def test_d04_contact_of_a_tilted_face() -> None:
    found = figures(disc("kind: flat, tilt: 8, offset: 5", FLAT, 32.0), "contact-travel", "face-width", RISE, RETURN)
    assert found["contact-travel"].value == pytest.approx(13.921113620 + 13.347296574, abs=2.1e-9)
    assert found["face-width"].value == pytest.approx(2 * 13.921113620, abs=2.1e-9)
    assert (found[RISE].value, found[RETURN].value) == pytest.approx((8.0, -8.0), abs=1e-12)


def test_d17_speed_of_the_roller() -> None:
    lift = "[{rise: 20, over: 120, law: cycloidal}, {dwell: 60}, {return: 20, over: 120, law: polynomial-345}, "
    lift += "{dwell: 60}]"
    found = figures(disc("kind: roller, radius: 10", lift, 40.0), "roller-speed")
    assert found["roller-speed"].value == pytest.approx(5400.0 / 900.0, abs=1e-11)


# needs: dynamics
def test_d20_angle_at_which_a_guide_jams() -> None:
    train = TRAIN
    made = checks(disc("kind: roller, radius: 9", more=train + "\nlimits: {jam-margin: {at_least: 40}}\n"))
    assert made["guide-jam"].ok
    assert made["guide-jam"].limit == pytest.approx(69.443954780, abs=1.01e-9)
    assert made["guide-jam"].value == pytest.approx(23.443852354, abs=1.01e-9)
    assert made["limit:jam-margin"].value == pytest.approx(69.443954780 - 23.443852354, abs=2.1e-9)
    stiff = checks(disc("kind: roller, radius: 9", more=train.replace("0.15", "1.5")))
    assert not stiff["guide-jam"].ok
    # where the rise begins an eccentric stem is pushed aside by its eccentricity alone
    began = checks(disc("kind: roller, radius: 9, offset: 30", more=train))["guide-jam"].value
    assert began == pytest.approx(math.degrees(math.asin(30 / 45)), abs=1e-9)


D01 = "[{rise: 20, over: 120, law: cycloidal}, {dwell: 60}, {return: 20, over: 120, law: polynomial-345}, {dwell: 60}]"


@pytest.mark.parametrize(
    ("text", "area"),
    [
        (disc("kind: roller, radius: 10", D01, 40.0), 8033.402512156),  # d01
        (disc("kind: flat", FLAT, 30.0), 3735.255254814),  # d03
        (
            disc(
                "kind: knife-edge",
                "[{rise: 25, over: 180, law: harmonic}, {return: 25, over: 180, law: harmonic}]",
                30.0,
            ),
            5919.938656608,  # d05
        ),
        (disc("kind: roller, radius: 10;", D01, 60.0), 15665.460508015),  # d10
    ],
)
def test_areas_of_the_worked_cases(text: str, area: float) -> None:
    from camgeo.output import pipeline

    report = pipeline.check(load_text(text + "export: {files: [csv]}\n", "cam.yaml")).report
    assert report["contour"]["area"] == pytest.approx(area, abs=1.01e-9)


def test_d06_width_of_a_shoe() -> None:
    motion = "[{rise: 10, over: 90, law: polynomial-4567}, {dwell: 30}, {return: 10, over: 90, law: polynomial-4567}, "
    found = figures(disc("kind: shoe, radius: 60", motion + "{dwell: 150}]", 25.0), RISE, RETURN, "radius-of-curvature")
    for name in (RISE, RETURN):
        assert found[name].value == pytest.approx(8.806525542, abs=1.01e-9)
        assert 60.0 * math.sin(math.radians(found[name].value or 0.0)) == pytest.approx(9.185903208, abs=2e-9)
    assert found["radius-of-curvature"].value == pytest.approx(10.950026472, abs=1.01e-9)


# --- against samples --------------------------------------------------------------------------------------------------


def sampled(text: str) -> tuple[Array, Array, Recipe]:
    """Pressure angles and roller speeds from differences of the centre's place, at many shaft angles."""
    recipe = load_text(text, "cam.yaml")
    cam = cast("DiscCam", recipe.cam)
    law, guide = cast("Displacement", cam.exact().law), cam.centre_guide
    theta = np.linspace(0.0, 2.0 * math.pi, 20_001)
    step = 1e-6
    near, far = (guide.place(theta + by, law.derivatives(theta + by, 0)[0])[0] for by in (-step, step))
    s = law.derivatives(theta, 1)
    travel = guide.place(theta, s[0])[1]
    velocity = (far - near) / (2 * step)
    normal = -1j * velocity / np.abs(velocity)
    angle = np.angle(np.exp(1j * travel) / normal)
    # turn of the direction of travel by the shaft angle, and the centre's way rolled off
    turned = np.unwrap(travel)
    spin = cam.side * np.abs(velocity) / cam.touch.radius - np.gradient(turned, theta)
    return np.degrees(angle), spin, recipe


@pytest.mark.slow
@settings(deadline=None, max_examples=examples(40))
@given(
    st.sampled_from(["stem", "trailing", "leading", "ring"]),
    st.integers(4, 12),
    st.integers(-150, 150).map(lambda tenths: tenths / 10),
    st.integers(60, 160),
    st.integers(60, 160),
)
def test_any_follower_against_samples(kind: str, radius: int, offset: float, rise: int, back: int) -> None:
    stroke = 20.0 if kind in {"stem", "ring"} else 14.0
    motion = f"[{{rise: {stroke}, over: {rise!r}, law: cycloidal}}, {{dwell: {180 - rise!r}}}, "
    motion += f"{{return: {stroke}, over: {back!r}, law: polynomial-345}}, {{dwell: {180 - back!r}}}]"
    follower = {
        "stem": f"kind: roller, radius: {radius}, offset: {offset}",
        "ring": f"kind: roller, radius: {radius};",
    }.get(kind, f"kind: roller, radius: {radius}, arm: {{length: 65, pivot: {75 + offset}, side: {kind}}}")
    text = disc(follower, motion, 45.0)
    names = [RISE, RETURN, "roller-speed", *(["pivot-clearance"] if "ing" in kind and kind != "ring" else [])]
    found = figures(text, *names)
    angle, spin, recipe = sampled(text)
    for name, wanted in ((RISE, angle.max()), (RETURN, -angle.min())):
        assert wanted - 1e-6 <= (found[name].value or 0.0)
        assert found[name].value == pytest.approx(wanted, abs=1e-4)
    assert found["roller-speed"].value == pytest.approx(np.abs(spin).max(), rel=1e-4)
    if "pivot-clearance" in found:
        contour = designed(recipe).only_surface.contour
        assume(contour is not None)
        assert contour is not None
        point = contour.sample(np.linspace(contour.runs[0].low, contour.runs[0].high, 4001)).point
        theta, pivot_at = np.linspace(0.0, 2.0 * math.pi, 91), 75 + offset
        pivots = pivot_at * np.column_stack([np.cos(theta), np.sin(theta)])
        inside = np.hypot(*point.T).max() < pivot_at
        if inside:
            away = min(float(np.hypot(*(point - pivot).T).min()) for pivot in pivots)
            assert found["pivot-clearance"].value == pytest.approx(away, abs=0.05)


@pytest.mark.slow
def test_a_disc_that_passes_over_the_pivot_is_remarked() -> None:
    text = disc("kind: roller, radius: 8, arm: {length: 40, pivot: 45}", SWING, 40.0)
    value = figures(text, "pivot-clearance")["pivot-clearance"].value
    assert value is not None
    assert value < 0.0
    assert remarks(text)["pivot-clearance"].value == value
    assert "pivot-clearance" not in remarks(text + "limits: {pivot-clearance: {at_least: -30}}\n")
    far = disc("kind: roller, radius: 8, arm: {length: 65, pivot: 80}", SWING, 34.0)
    assert "pivot-clearance" not in remarks(far)


def test_a_ring_s_metal_is_bent_the_other_way() -> None:
    found = figures(disc("kind: roller, radius: 9;"), "radius-of-curvature", "hollow-radius", "pitch-radius")
    curve = designed(load_text(disc("kind: roller, radius: 9;"), "cam.yaml")).only_surface.surface.curve
    at = curve.sample(np.linspace(0.0, 2.0 * math.pi, 100_001))
    assert found["radius-of-curvature"].value == pytest.approx(-(at.speed / at.turn)[at.turn < 0].max(), rel=1e-6)
    assert found["hollow-radius"].value == pytest.approx((at.speed / at.turn)[at.turn > 0].min(), rel=1e-6)
    assert found["radius-of-curvature"].value == pytest.approx((found["pitch-radius"].value or 0.0) - 9.0, abs=1e-9)


RING = """\
cam:
  kind: disc
  track: internal
  base_radius: 60
  follower: {kind: roller, radius: 9}
  motion:
    - {rise: 12, over: 120, law: cycloidal}
    - {dwell: 60}
    - {return: 12, over: 120, law: cycloidal}
    - {dwell: 60}
part: {outer: 170}
"""


def test_check_figure_and_limit_of_a_ring_s_pitch_curve_are_one() -> None:
    """Of its hollows, also where it has none: its convex places cannot undercut."""
    made = checks(RING + "limits: {pitch-radius: {at_least: 1000}}\n")
    assert made["pitch-radius"].value == made["limit:pitch-radius"].value == math.inf
    assert made["limit:pitch-radius"].ok
    hollow = checks(disc("kind: roller, radius: 9;", more="limits: {pitch-radius: {at_least: 1}}\n"))
    assert hollow["pitch-radius"].value == hollow["limit:pitch-radius"].value
    assert math.isfinite(hollow["pitch-radius"].value or math.inf)


# --- limits -----------------------------------------------------------------------------------------------------------


def test_on_return_is_a_bound_of_its_own() -> None:
    text = disc("kind: roller, radius: 9, offset: 10", more="limits: {pressure-angle: {at_most: 15, on_return: 28}}\n")
    made = checks(text)
    rise, back = made[f"limit:{RISE}"], made[f"limit:{RETURN}"]
    assert (rise.ok, rise.limit, back.ok, back.limit) == (True, 15, False, 28)
    assert "limit:pressure-angle" not in made
    assert re.search(r"a larger base radius, .* would satisfy it", back.detail)
    alone = checks(text.replace("at_most: 15, ", ""))
    assert not alone[f"limit:{RETURN}"].ok
    assert f"limit:{RISE}" not in alone


def test_without_it_one_bound_holds_both_ways() -> None:
    text = disc("kind: roller, radius: 9, offset: 10", more="limits: {pressure-angle: {at_most: 15}}\n")
    assert not checks(text)["limit:pressure-angle"].ok
    assert checks(text.replace("at_most: 15", "at_most: 28.4"))["limit:pressure-angle"].ok


def test_on_return_of_a_cam_that_has_it_not() -> None:
    roller = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 300}}}\n"
    with pytest.raises(RecipeErrors, match="on_return needs a cam of kind disc or constant-diameter"):
        load_text(roller + "limits: {pressure-angle: {on_return: 40}}\n", "cam.yaml")


def test_a_failure_names_its_key() -> None:
    from camgeo.output import pipeline
    from camgeo.report.failure import failure

    text = disc("kind: roller, radius: 9", more="limits:\n  pressure-angle: {at_most: 30, on_return: 5}\n")
    recipe = load_text(text + "export: {files: [csv]}\n", "cam.yaml")
    report = pipeline.check(recipe).report
    (check,) = [one for one in report["checks"] if not one["ok"]]
    assert failure(check, report, recipe).endswith("cam.yaml:3:44 limits.pressure-angle.on_return")


# needs: dynamics
@pytest.mark.thin(2)
@pytest.mark.parametrize("rpm", [900.0, 37.5])
def test_peaks_at_a_speed(rpm: float) -> None:
    names = [f"peak-{name}-at-speed" for name in ("velocity", "acceleration", "jerk")]
    limits = "limits: {" + ", ".join(f"{name}: {{at_most: 1, rpm: {rpm}}}" for name in names) + "}\n"
    text = disc("kind: roller, radius: 9")
    made = checks(text + limits)
    radian = figures(text, *(name.removesuffix("-at-speed") for name in names))
    omega = rpm * 2 * math.pi / 60
    for order, (name, unit) in enumerate(zip(names, ("mm/s", "mm/s^2", "mm/s^3"), strict=True), 1):
        plain = radian[name.removesuffix("-at-speed")].value
        assert plain is not None
        assert made[f"limit:{name}"].value == pytest.approx(plain * omega**order, rel=1e-13)
        assert made[f"limit:{name}"].unit == unit
    train = f"dynamics: {{mass: 1, stiffness: 2.0e5, preload: 900, rpm: {rpm}}}\n"
    same = checks(text + train + limits.replace(f", rpm: {rpm}", ""))
    assert all(same[f"limit:{name}"].value == made[f"limit:{name}"].value for name in names)
    with pytest.raises(RecipeErrors, match=r"needs a follower without a linkage, and dynamics\.rpm"):
        load_text(text + limits.replace(f", rpm: {rpm}", ""), "cam.yaml")


def test_a_face_that_is_too_narrow_fails() -> None:
    text = disc("kind: flat, tilt: 8, offset: 5, width: 27.8", FLAT, 32.0)
    narrow = checks(text)["face-width"]
    assert (narrow.ok, narrow.limit) == (False, 27.8)
    assert narrow.value == pytest.approx(27.842227240, abs=3e-9)
    assert checks(text.replace("27.8", "27.85"))["face-width"].ok
    assert "face-width" not in checks(text.replace(", width: 27.8", ""))


HOLLOW = "[{rise: 20, over: 50, law: polynomial-4567}, {return: 20, over: 50, law: polynomial-4567}, "
HOLLOW += "{dwell: 130}, {dwell: 130}]"


@pytest.mark.slow
def test_wheel_and_cutter_in_a_hollow() -> None:
    text = disc("kind: roller, radius: 9", HOLLOW)
    radius = figures(text, "hollow-radius")["hollow-radius"].value
    assert radius is not None
    assert 10.0 < radius < 100.0
    for share, ok in ((0.999, True), (1.001, False)):
        made = checks(text + f"manufacture: {{cutter: 6, wheel: {2 * radius * share!r}}}\n")["grinding-wheel"]
        assert (made.ok, made.value) == (ok, radius)
        said = remarks(text + f"manufacture: {{cutter: {2 * radius * share!r}}}\n").get("large-cutter")
        assert (said is None) is ok
    assert said is not None
    fits = re.search(r"a cutter of (\S+) does", said.sentence)
    assert fits
    assert "large-cutter" not in remarks(text + f"manufacture: {{cutter: {fits[1]}}}\n")


# --- remarks that name a size -----------------------------------------------------------------------------------------

STEEP = (
    "[{rise: 30, over: 60, law: modified-sine}, {dwell: 60}, {return: 30, over: 60, law: polynomial-345}, {dwell: 180}]"
)
WIDE = STEEP.replace("30,", "25,")
YOKE = "cam: {kind: constant-diameter, base_radius: 20.0, roller_radius: 9, "
YOKE += "motion: [{rise: 20, over: 80, law: cycloidal}, {dwell: 100}]}\n"


@pytest.mark.thin(16)
@pytest.mark.parametrize(
    ("text", "rising", "falling"),
    [
        (disc("kind: roller, radius: 9, offset: 4", STEEP, 30.0), 30, 45),
        (disc("kind: roller, radius: 9, offset: -4", STEEP, 30.0), 30, 45),
        (disc("kind: roller, radius: 9;", STEEP, 40.0), 30, 45),
        (disc("kind: shoe, radius: 12", STEEP, 30.0), 30, 45),
        (disc("kind: roller, radius: 9, arm: {length: 65, pivot: 60}", WIDE, 25.0), 45, 45),
        (disc("kind: roller, radius: 9, arm: {length: 65, pivot: 60, side: leading}", WIDE, 25.0), 45, 45),
        (YOKE, 30, 30),
        ("units: inch\n" + disc("kind: roller, radius: 0.4", STEEP.replace("30,", "1.2,"), 1.0), 30, 45),
    ],
)
def test_the_size_that_would_do_does(text: str, rising: float, falling: float) -> None:
    said = remarks(text)["pressure-angle"].sentence
    sizes = re.search(r"which a base radius of (\S+?)(?: with a pivot at (\S+))? keeps", said)
    assert sizes, said
    better = re.sub(r"base_radius: [\d.]+", f"base_radius: {sizes[1]}", text)
    if sizes[2]:
        better = re.sub(r"pivot: [\d.]+", f"pivot: {sizes[2]}", better)
    assert "pressure-angle" not in remarks(better)
    found = figures(better, RISE, RETURN)
    up, down = found[RISE].value or 0.0, found[RETURN].value or 0.0
    assert (up, down) <= (rising + 1e-9, 90)
    assert down <= falling + 1e-9
    assert max(up - rising, down - falling) > -0.1  # and no larger than it must be


def test_a_return_that_a_spring_drives_may_be_steeper() -> None:
    back = "[{rise: 20, over: 150, law: cycloidal}, {dwell: 60}, {return: 20, over: 60, law: cycloidal}, {dwell: 90}]"
    text = disc("kind: roller, radius: 9", back)
    assert 30 < (figures(text, RETURN)[RETURN].value or 0.0) < 45
    assert "pressure-angle" not in remarks(text)
    assert (
        "on the return"
        in remarks(text.replace("over: 60, law", "over: 35, law").replace("90}", "115}"))["pressure-angle"].sentence
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        disc("kind: roller, radius: 9, arm: {length: 65, pivot: 60}", WIDE, 25.0),
        disc("kind: roller, radius: 17", STEEP.replace("30,", "12,"), 30.0),
        YOKE.replace("roller_radius: 9", "roller_radius: 18"),
    ],
)
def test_a_large_roller_s_base_radius_does(text: str) -> None:
    remark = remarks(text)["large-roller"]
    size = re.search(r"which a base radius of (\S+) keeps", remark.sentence)
    assert size
    better = re.sub(r"base_radius: [\d.]+", f"base_radius: {size[1]}", text)
    assert "large-roller" not in remarks(better)
    smaller = re.sub(r"base_radius: [\d.]+", f"base_radius: {float(size[1]) - 0.01}", text)
    assert "large-roller" in remarks(smaller)
    assert "large-roller" not in remarks(text + "limits: {pitch-radius: {at_least: 1}}\n")


def test_a_shoe_is_no_roller() -> None:
    assert "large-roller" not in remarks(disc("kind: shoe, radius: 60", MOTION))
    with pytest.raises(RecipeErrors, match="roller-speed needs a roller that a cam of kind disc"):
        load_text(disc("kind: shoe, radius: 60", more="limits: {roller-speed: {at_most: 9}}\n"), "cam.yaml")


# needs: dynamics
def test_a_guide_without_a_stem() -> None:
    for follower in ("kind: flat, arm: {pivot: 110, face: 5}", "kind: roller, radius: 8, arm: {length: 65, pivot: 80}"):
        with pytest.raises(RecipeErrors, match=r"dynamics\.guide: the follower has no stem of its own"):
            load_text(disc(follower, more=TRAIN), "cam.yaml")


# needs: dynamics, sweep
@pytest.mark.slow
def test_a_sweep_ranks_and_limits_by_them() -> None:
    from camgeo.capabilities.sweep.figures import compute_figures as searched
    from camgeo.capabilities.sweep.task import SweepTask

    text = disc("kind: roller, radius: 9, offset: 6", more=TRAIN + "\n")
    text += """\
sweep:
  vary: {cam.base_radius: {from: 30, to: 40, steps: 3}}
  limits:
    pressure-angle-return: {at_most: 30}
    peak-acceleration-at-speed: {at_most: 1.0e6}
    jam-margin: {at_least: 10}
  rank: roller-speed
"""
    recipe = load_text(text, "cam.yaml")
    task = SweepTask.from_recipe(recipe)
    columns = searched(task.scene(task.figures), task.plan.values(0, 3))
    names = ["pressure-angle-return", "peak-acceleration-at-speed", "jam-margin", "roller-speed"]
    for i, base in enumerate((30, 35, 40)):
        found = figures(text.replace("base_radius: 36", f"base_radius: {base}"), *names)
        for name in names:
            assert columns[name][i] == pytest.approx(found[name].value, rel=1e-12), name


def test_the_play_of_a_file_is_its_greatest_either_way() -> None:
    """Interference counts as play; where both are as great, the play is told."""
    for least, most, wanted in (
        (-0.3, 0.2, (0.3, 40.0)),
        (-0.2, 0.3, (0.3, 90.0)),
        (-0.2, 0.2, (0.2, 90.0)),
        (0.1, 0.3, (0.3, 90.0)),
        (-0.3, -0.1, (0.3, 40.0)),
    ):
        found = _play(Play(least=least, least_at_deg=40.0, most=most, most_at_deg=90.0, unit="mm"))
        assert (found.value, found.at) == wanted
