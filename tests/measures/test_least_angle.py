"""Angles that `over: least` finds: they keep every limit, and no shorter one does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.cases import few

import camgeo

STEM = """
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 8}
  motion:
    - {rise: 20, over: 180, law: cycloidal}
    - {dwell: 60}
    - {return: 20, over: least, law: modified-sine}   # the drop
    - {dwell: rest}                                   # whatever is left
limits: {pressure-angle: {at_most: 35}}
export: {tolerance: 0.01, files: [dxf]}
"""
FACE = """
units: inch
cam:
  kind: disc
  base_radius: 1.5
  follower: {kind: flat}
  motion:
    - {rise: 0.4, over: least, law: cycloidal}
    - {dwell: 100}
    - {return: 0.4, over: 100, law: cycloidal}
    - {dwell: rest}
limits: {radius-of-curvature: {at_least: 0.5}}
"""
ARM = """
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 8, arm: {length: 80, pivot: 90}}
  motion: [{dwell: rest}, {rise: 15, over: 120, law: cycloidal}, {to: 0, over: least, law: polynomial-345}]
limits: {peak-acceleration: {at_most: 60}, peak-velocity: {at_most: 24}}
"""
REPEATED = (
    STEM.replace("180", "60").replace("60}", "5}").replace("  motion:\n", "  motion:\n    repeat: 3\n    segments:\n")
)
REPEATED = REPEATED.replace("    - ", "      - ").replace("20,", "6,")
RIGID = STEM.replace("35}", "60}, contact-force-least: {at_least: 40}")
RIGID += "dynamics: {mass: 0.4, preload: 150, rate: 4000, rpm: 200}\n"
ELASTIC = RIGID.replace("contact-force-least", "least-force").replace("200}", "200, stiffness: 1e6, damping: 40}")
VALVE = STEM.replace("roller, radius: 8", "flat").replace("20,", "6,")
VALVE = VALVE.replace("pressure-angle: {at_most: 35}", "valve-acceleration: {at_most: 60}") + "valve: {ratio: 1.6}\n"
CASES = {
    "stem": STEM,
    "face": FACE,
    "arm": ARM,
    "repeated": REPEATED,
    "rigid train": RIGID,  # needs: dynamics
    "elastic train": ELASTIC,  # needs: dynamics
    "valve": VALVE,  # needs: valve
}


def with_angles(recipe: Any, angle: float) -> Any:
    """The recipe with another angle in place of the one found, and the dwell that is left."""
    (least, old), (rest, dwell) = recipe.settled.least, recipe.settled.rest
    return recipe.replace({least: angle, rest: round(dwell + old - angle, 9)})


def passes(recipe: Any) -> bool:
    """Whether a recipe's every check holds, none of files."""
    if "stiffness" not in recipe.text:
        return camgeo.design(recipe).ok
    return all(check.ok for check in camgeo.check(recipe).checks if check.file is None)


@pytest.mark.slow
@pytest.mark.parametrize("name", few(CASES, 3))
def test_the_angle_found_holds_and_a_hundredth_less_does_not(name: str) -> None:
    recipe = camgeo.load(CASES[name])
    angle = recipe.settled.least.degrees
    assert angle == round(angle, 2)
    assert passes(with_angles(recipe, angle))
    assert not passes(with_angles(recipe, angle - 0.02))
    assert recipe.settled.bound


@pytest.mark.slow
def test_the_angle_of_a_harmonic_return_is_that_of_its_formula() -> None:
    text = STEM.replace("modified-sine", "harmonic").replace(
        "pressure-angle: {at_most: 35}", "peak-velocity: {at_most: 30}"
    )
    settled = camgeo.load(text).settled
    angle, dwell = settled.least.degrees, settled.rest.degrees
    exact = np.degrees(np.pi / 2 * 20 / 30)  # v = pi h / (2 beta)
    assert exact <= angle < exact + 0.01
    assert angle + dwell == pytest.approx(120, abs=1e-9)


def test_the_recipe_with_the_numbers_in_makes_the_same_file() -> None:
    recipe = camgeo.load(STEM)
    sized: Any = camgeo.design(recipe).sized
    angle, dwell = recipe.settled.least.degrees, recipe.settled.rest.degrees
    assert sized.text == STEM.replace("least,", f"{angle},").replace("{dwell: rest}", f"{{dwell: {dwell}}}")
    assert sized.settled is None
    assert sized.sized() is sized
    assert sized.cam.motion == recipe.cam.motion
    assert hash(recipe) != hash(sized)
    (remark,) = (remark for remark in camgeo.check(recipe).remarks if remark.name == "least-angle")
    assert remark.value == angle
    assert (
        f"return over {angle} deg, the least that all limits allow: a hundredth less fails limit:pressure-angle"
        in str(remark)
    )


@pytest.mark.slow
def test_an_angle_is_found_though_longer_ones_fail() -> None:
    text = STEM.replace("35}", "35}, duration: {at_most: 560, at_lift: 0.5 mm}")
    recipe = camgeo.load(text)
    angle = recipe.settled.least.degrees
    assert angle == camgeo.load(STEM).settled.least.degrees
    assert min(recipe.settled.again) > angle
    assert not passes(with_angles(recipe, recipe.settled.again[0]))
    (remark,) = (remark for remark in camgeo.check(recipe).remarks if remark.name == "least-angle")
    assert f"not all longer ones are allowed, such as {recipe.settled.again[0]:.4g} deg" in str(remark)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["stem", "face", "arm"])
def test_no_shorter_angle_of_a_fine_grid_is_allowed(name: str) -> None:
    recipe = camgeo.load(CASES[name])
    angle = recipe.settled.least.degrees
    near = np.arange(angle - 8.0, angle - 0.02, 0.5)  # farther off, what is allowed would be allowed over degrees
    shorter = [*np.arange(1.0, near[0], 2.0), *near]
    assert len(shorter) > 30

    def allowed(other: float) -> bool:
        try:
            return camgeo.design(with_angles(recipe, other)).ok
        except camgeo.RecipeErrors:
            return False

    assert not any(map(allowed, shorter))


def fault(text: str) -> tuple[str, str]:
    """Path and message of the one fault of a recipe."""
    with pytest.raises(camgeo.RecipeErrors) as caught:
        camgeo.load(text)
    (error,) = caught.value.errors
    assert error.line
    return error.path, str(error)


def test_what_it_needs_is_said_at_its_line() -> None:
    over, dwell = "cam.motion[2].over", "cam.motion[3].dwell"
    path, text = fault(STEM.replace("{dwell: rest}", "{dwell: 60}"))
    assert (path, "write one dwell as {dwell: rest}" in text) == (over, True)
    path, text = fault(STEM.replace("over: least", "over: 60"))
    assert (path, "give its angle" in text) == (dwell, True)
    path, text = fault(STEM.replace("{dwell: 60}", "{dwell: rest}"))
    assert (path, "cam.motion[1].dwell is found already; give an angle" in text) == (dwell, True)
    path, text = fault(STEM.replace("over: 180", "over: least"))
    assert (path, "cam.motion[0].over is found already" in text) == (over, True)
    path, text = fault(STEM.replace("limits: {pressure-angle: {at_most: 35}}\n", ""))
    assert (path, "give limits" in text) == (over, True)
    path, text = fault(STEM.replace("base_radius: 40", "sizing: {pressure-angle: {at_most: 30}}"))
    assert (path, "give base_radius in place of sizing" in text) == (over, True)
    path, text = fault(STEM.replace("over: 180", "over: 300"))
    assert (path, "let all the others cover less than 360 degrees" in text) == ("cam.motion", True)
    path, text = fault(STEM.replace("35}", "35}, pieces: {at_most: 90}"))
    assert (path, "leave it out, or give the angle" in text) == ("limits.pieces", True)
    path, text = fault(STEM.replace("at_most: 35", "at_most: 10"))
    assert path == over
    assert "even over 119.99 degrees limit:pressure-angle is" in text
    assert "deg, at most 10, given least; a larger base radius" in text


def test_other_cams_take_angles_alone() -> None:
    yoke = """
cam:
  kind: constant-breadth
  base_radius: 40
  motion: [{rise: 20, over: least, law: modified-sine}, {dwell: 60}]
"""
    path, text = fault(yoke)
    assert path == "cam.motion[0].over"
    assert "give an angle above 0" in text
