"""Sizes that `sizing` finds: they keep their limits, and no other guide keeps them with a smaller cam."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

import camgeo
from camgeo.curve.curvature import least_radius

DEGREE = math.pi / 180.0
LAWS = ("cycloidal", "harmonic", "modified-sine", "modified-trapezoid", "parabolic", "cubic", "polynomial-345")
ARM = """
cam:
  kind: disc
  sizing: {pressure-angle: {at_most: 27.6, on_return: 40.4}, radius-of-curvature: {at_least: 48.9}}
  follower: {kind: roller, radius: 15, arm: {length: 219.9, side: leading}}
  motion:
    - {rise: 4.392, over: 83.64, law: scca-33}
    - {dwell: 128.29}
    - {return: 4.392, over: 88.38, law: cubic}
    - {dwell: 59.69}
"""


def sized(text: str) -> Any:
    """Cam of a recipe, held against its own limits by the exact figures."""
    recipe = camgeo.load(text)
    cam: Any = recipe.cam
    exact = cam.exact()
    rising, falling = cam.sizing.angles
    low, high = exact.surfaces[0].extremes("slope")
    assert math.atan(high.value) <= rising + 1e-9 * DEGREE
    assert -math.atan(low.value) <= falling + 1e-9 * DEGREE
    radius = least_radius(exact.surfaces[0].base)[0] - cam.touch.radius
    assert radius >= cam.sizing.radius * (1.0 - 1e-9)
    return cam


def least_prime_by_chance(cam: Any, looks: int, seed: int) -> float:
    """Least prime circle of random places of the shaft; limits are taken at angles alone, a hair too lax."""
    motion, guide, rng = cam.exact().law, cam.centre_guide, np.random.default_rng(seed)
    ends = np.append(motion.breaks, motion.breaks[0] + 2.0 * math.pi)
    shares = np.linspace(0.0, 1.0, 300)
    tau = ends[:-1, None] * (1.0 - shares) + ends[1:, None] * shares
    s, v, w = np.hstack([motion.derivatives(tau[:, :-1].ravel(), 2, 1), motion.derivatives(tau[:, -1], 2, -1)])
    rising, falling = (math.tan(angle) for angle in cam.sizing.angles)
    radius, best, at, most = cam.sizing.radius + cam.touch.radius, math.inf, 0.0, 1.05 * guide.prime

    def keeping(prime: Any, turn: Any, every: int) -> Any:
        """Which of the places keep the limits at one of `every` so many angles."""
        d, e = (prime * np.cos(turn))[:, None], (prime * np.sin(turn))[:, None]
        lift, speed, bend = s[::every], v[::every], w[::every]
        if cam.guide.unit == "mm":
            b, a, b1, a1, rate = d + lift, speed - e, speed, bend, 1.0
        else:
            side, length = guide.side, guide.length
            x = length + side * e
            b, c = x * np.sin(lift) + d * np.cos(lift), x * np.cos(lift) - d * np.sin(lift)
            a, b1, rate = length * speed - side * (c - length), c * speed, 1.0 + side * speed
            a1 = length * bend + side * b * speed
        pace = np.hypot(a, b)
        turned = rate + (b1 * a - a1 * b) / pace**2
        kept = (b > 0.0) & (a <= b * rising) & (-a <= b * falling) & (pace >= radius * turned)
        return kept.all(axis=1)

    for look in range(looks):
        if look % 2 and best < math.inf:
            prime = best * (1.0 - np.abs(rng.normal(0.0, 10.0 ** rng.uniform(-5, -1), 300)))
            turn = rng.normal(at, 10.0 ** rng.uniform(-4, -1), 300)
        else:
            prime = rng.uniform(cam.touch.radius, min(best, most), 300)
            turn = rng.uniform(-cam.sizing.angles[0], cam.sizing.angles[1], 300)
        for every in (30, 5, 1):  # most places fail at some of few angles
            good = keeping(prime, turn, every)
            prime, turn = prime[good], turn[good]
        if prime.size and prime.min() < best:
            first = np.argmin(prime)
            best, at = float(prime[first]), float(turn[first])
    return best


@pytest.mark.slow
def test_the_pivot_is_searched_where_the_radius_of_curvature_binds() -> None:
    cam = sized(ARM)
    assert cam.base_radius == pytest.approx(73.35116062, abs=1e-7)  # 80.915 at the pivot of the pressure angle alone
    assert cam.guide.pivot == pytest.approx(198.781985, abs=1e-5)


@pytest.mark.slow
def test_the_offset_is_searched_where_the_radius_of_curvature_binds() -> None:
    text = re.sub(", arm: {.*?}", "", ARM).replace("roller, radius: 15", "roller, radius: 8")
    cam = sized(text)
    assert least_prime_by_chance(cam, 60, 3) >= (1.0 - 1e-4) * cam.prime
    for offset in (cam.guide.offset - 0.5, cam.guide.offset + 0.5):
        held = sized(text.replace("radius: 8", f"radius: 8, offset: {offset!r}"))
        assert held.base_radius > cam.base_radius


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_no_random_search_does_better(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rise, dwell, back = (round(value, 2) for value in rng.uniform((50, 5, 50), (130, 60, 130)))
    stroke, radius = rng.uniform((3, 2), (25, 20))
    first, second = rng.choice(LAWS, 2)
    arm = f", arm: {{length: {rng.uniform(60, 250)}, side: {rng.choice(['leading', 'trailing'])}}}"
    angles = f"{{at_most: {rng.uniform(25, 40)}, on_return: {rng.uniform(30, 55)}}}"
    text = f"""
cam:
  kind: disc
  sizing: {{pressure-angle: {angles}, radius-of-curvature: {{at_least: {rng.uniform(0.3, 4.0) * radius + 20.0}}}}}
  follower: {{kind: roller, radius: {radius}{arm if seed % 4 else ""}}}
  motion:
    - {{rise: {stroke}, over: {rise}, law: {first}}}
    - {{dwell: {dwell}}}
    - {{return: {stroke}, over: {back}, law: {second}}}
    - {{dwell: {360.0 - rise - dwell - back}}}
"""
    cam = sized(text)
    assert least_prime_by_chance(cam, 150, seed) >= (1.0 - 1e-4) * cam.prime


FACE = """
cam:
  kind: disc
  sizing: {radius-of-curvature: {at_least: 10}}
  follower: {kind: flat, arm: {pivot: 120, face: 5, side: leading}}
  motion:
    - {rise: 12, over: 120, law: modified-sine}
    - {dwell: 60}
    - {return: 12, over: 120, law: polynomial-345}
    - {dwell: 60}
"""


@pytest.mark.slow
@pytest.mark.parametrize("side", ["leading", "trailing"])
@pytest.mark.parametrize(("face", "radius"), [(5.0, 10.0), (0.0, 3.0), (-10.0, 12.0), (40.0, 60.0)])
def test_a_face_on_an_arm_is_sized_by_its_radius(face: float, radius: float, side: str) -> None:
    text = FACE.replace("face: 5", f"face: {face}").replace("least: 10", f"least: {radius}").replace("leading", side)
    cam: Any = camgeo.load(text).cam
    base = cam.base_radius
    for share in (0.999, 1.0, 1.001):
        given = camgeo.design(camgeo.load(re.sub("sizing: .*", f"base_radius: {share * base!r}", text)))
        value = given.figures["radius-of-curvature"].value
        assert value is not None
        if share == 1.0:
            assert value == pytest.approx(radius, rel=1e-9)
        else:
            assert (value > radius) == (share > 1.0)


def fault(text: str) -> str:
    with pytest.raises(camgeo.RecipeErrors) as caught:
        camgeo.load(text)
    (error,) = caught.value.errors
    return str(error)


def test_a_face_on_an_arm_that_no_size_rounds_is_told_which_face_does() -> None:
    text = FACE.replace("least: 10", "least: 114").replace("face: 5", "face: 5.5")
    told = re.search(r"a face below (\S+) mm does", fault(text))
    assert told
    assert camgeo.load(text.replace("face: 5.5", f"face: {float(told[1]) - 0.001}"))


def test_what_a_face_on_an_arm_needs_is_told() -> None:
    assert "give follower.arm.pivot" in fault(FACE.replace("pivot: 120, ", ""))
    assert "any base radius keeps this" in fault(FACE.replace("face: 5", "face: -110"))
    asked = FACE.replace("sizing: {", "sizing: {pressure-angle: {at_most: 30}, ")
    assert "a flat face on an arm is sized by its radius of curvature alone" in fault(asked)
    assert "leaves the face room to swing" in fault(FACE.replace("face: 5", "face: 119"))


BOUND = """
cam:
  kind: disc
  sizing: {pressure-angle: {at_most: 30}}  # of the return too
  follower: {kind: roller, radius: 8, offset: 0}
  motion:
    - {rise: 20, over: 90, law: modified-sine}
    - {dwell: 30}
    - {return: 20, over: 60, law: cycloidal}
    - {dwell: 180}
"""
RING = (
    BOUND.replace("{kind: roller, radius: 8", "{kind: roller, radius: 90") + "  track: internal\npart: {outer: 400}\n"
)


def remark(text: str, name: str) -> str:
    return next((one.sentence for one in camgeo.check(camgeo.load(text)).remarks if one.name == name), "")


def failure(text: str) -> str:
    """Detail of the failed checks of a recipe, with their remedies."""
    return "\n".join(str(check) for check in camgeo.design(camgeo.load(text)).checks if not check.ok)


def test_why_no_size_is_found_is_told() -> None:
    """All before a size is looked for, or after the least one; none makes a design."""
    flat = BOUND.replace("roller, radius: 8, offset: 0", "flat")
    for text, words in (
        (BOUND.replace("pressure-angle: {at_most: 30}", ""), ".sizing: no limit is given; give pressure-angle, "),
        (ARM.replace("219.9,", "219.9, pivot: 200,"), ".pivot: the pivot is found with the pressure angle; leave it "),
        (re.sub("pressure-angle: {.*?}, ", "", ARM), ".sizing: without a pressure angle the pivot must be given; "),
        (flat, ".sizing.pressure-angle: the pressure angle of a flat face is its tilt, whatever the size; give base"),
        (
            # with any roller from the prime circle on; 20 mm in 90 degrees are steeper than none
            BOUND.replace("radius: 8", "radius: 90").replace("at_most: 30", "at_most: 80"),
            " mm, lies within the roller: a smaller one would do; give base_radius instead",
        ),
        (
            RING.replace("pressure-angle: {at_most: 30}", "radius-of-curvature: {at_least: 10}"),
            ".sizing.radius-of-curvature: does not size a ring; give pressure-angle alone, or base_radius in place of ",
        ),
    ):
        assert words in fault(text)


def test_what_bounds_a_size_is_said() -> None:
    """The size and what bounds it where, in mm or inches, and the size for a gentler limit of the return."""
    cam: Any = camgeo.load(BOUND).cam
    exact = cam.exact()
    told = cam.advice.chosen_size(exact, 1.0)
    assert told == "base radius 48.77, bound by pressure-angle-return at 151.8 deg; 22.00 with on_return: 45"
    assert cam.advice.chosen_size(exact, 25.4).startswith(f"base radius {48.77017484 / 25.4:#.4g}, bound by ")
    # at the angle named the return is as steep as its limit: tan 30 times the height above the shaft
    (place,) = re.findall(r"at (\S+) deg", told)
    height, slope = exact.law.derivatives(np.array([math.radians(float(place))]), 1)[:, 0]
    assert -slope == pytest.approx(math.tan(math.pi / 6) * (48.77017484 + 8.0 + height), rel=1e-5)


@pytest.mark.slow
def test_the_remark_says_what_bounds_the_size() -> None:
    wider = BOUND.replace("at_most: 30", "at_most: 30, on_return: 45")
    assert remark(wider, "sizing") == "base radius 22.00, bound by pressure-angle-rise at 38.9 deg"
    assert re.fullmatch(
        r"base radius 73.35 with pivot 198.8, bound by pressure-angle-return at \S+ deg and radius-of-curvature at \S+ "
        r"deg; \S+ with on_return: 45",
        remark(ARM, "sizing"),
    )


def test_an_offset_that_only_rounding_left_is_0() -> None:
    """A rise and a return alike are best on a stem without an offset."""
    law = "over: 60, law: cycloidal"
    text = "cam: {kind: disc, sizing: {pressure-angle: {at_most: 30}}, follower: {kind: roller, radius: 6}, "
    text += f"motion: [{{rise: 20, {law}}}, {{dwell: 10}}, {{return: 20, {law}}}, {{dwell: 230}}]}}\n"
    assert remark(text, "sizing").startswith("base radius 50.77 with offset 0, bound by pressure-angle-rise at ")


@pytest.mark.slow
def test_what_was_found_is_a_figure_and_can_be_limited() -> None:
    stem, arm = camgeo.design(camgeo.load(BOUND)).figures, camgeo.design(camgeo.load(ARM)).figures
    assert stem["base-radius"].value == pytest.approx(48.77017484, abs=1e-7)
    assert (stem["offset"].value, "pivot" in stem, "offset" in arm) == (0.0, False, False)
    assert arm["pivot"].value == pytest.approx(198.781985, abs=1e-5)
    assert camgeo.design(camgeo.load(BOUND + "limits: {base-radius: {at_most: 48.8}, offset: {at_least: 0}}\n")).ok
    assert not camgeo.design(camgeo.load(BOUND + "limits: {base-radius: {at_most: 48.7}}\n")).ok


@pytest.mark.thin(8)
@pytest.mark.parametrize("units", ["mm", "inch"])
@pytest.mark.parametrize("text", [BOUND, BOUND.replace(", offset: 0", ""), ARM, FACE])
def test_the_recipe_with_the_numbers_in_is_the_same_cam(text: str, units: str) -> None:
    text = f"units: {units}\n{text}"
    found: Any = camgeo.design(camgeo.load(text))
    given: Any = found.sized
    assert "sizing" not in given.text
    assert ("# of the return too" in given.text) == ("# of the return too" in text)
    assert not given.cam.sizes
    assert given.cam.base_radius == pytest.approx(found.recipe.cam.base_radius, rel=1e-14)
    assert given.cam.datum == pytest.approx(found.recipe.cam.datum, rel=1e-9)
    assert camgeo.design(given).sized is given


@pytest.mark.thin(2)
@pytest.mark.parametrize("text", [BOUND.replace("radius: 8, offset: 0", "radius: 30"), RING])
def test_undercut_of_a_sized_cam_says_which_key_of_sizing_frees_it(text: str) -> None:
    told = failure(text)
    assert "base radius" not in told
    if limit := re.search(r"; radius-of-curvature: ({at_least: \S+}) under sizing would be free of it", told):
        mended = text.replace("at_most: 30}", f"at_most: 30}}, radius-of-curvature: {limit[1]}")
    else:
        roller = re.search(r"a roller radius below (\S+) would be free of it", told)
        assert roller
        mended = text.replace("radius: 90", f"radius: {0.999 * float(roller[1])}")
    assert camgeo.design(camgeo.load(mended)).ok


@pytest.mark.slow
def test_limits_beside_sizing_name_the_keys_of_sizing() -> None:
    steep = BOUND + "limits: {pressure-angle: {at_most: 20}}\n"
    assert "at_most of 20 under sizing" in failure(steep)
    assert failure(steep.replace("at_most: 30", "at_most: 20")) == ""
    both = steep.replace("at_most: 30", "at_most: 30, on_return: 40")
    assert "at_most and on_return of 20 under sizing" in failure(both)
    sharp = BOUND + "limits: {radius-of-curvature: {at_least: 40}}\n"
    assert "radius-of-curvature: {at_least: 40} under sizing" in failure(sharp)
    assert failure(sharp.replace("at_most: 30}", "at_most: 30}, radius-of-curvature: {at_least: 40}")) == ""


@pytest.mark.slow
def test_a_large_roller_names_the_radius_under_sizing() -> None:
    large = BOUND.replace("radius: 8", "radius: 20")
    limit = re.search(r"which (radius-of-curvature: {at_least: 20}) under sizing keeps", remark(large, "large-roller"))
    assert limit
    assert remark(large.replace("at_most: 30}", f"at_most: 30}}, {limit[1]}"), "large-roller") == ""
