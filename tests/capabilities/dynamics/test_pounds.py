"""Forces, moments, spring rates and masses with units: lbf, lbf*in, lbf/in and lb beside N, N m, N/m and kg."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.sweep.keys import Sweep  # needs: sweep
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.json_schema import json_schema
from camgeo.schema.quantity import read_quantity

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe

CAM = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10BESIDE}
  motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}, {return: 20, over: 180, law: cycloidal}]
"""
STEM, ARM = CAM.replace("BESIDE", ""), CAM.replace("BESIDE", ", arm: {length: 65, pivot: 80}").replace(" 20,", " 15,")
LBF, IN, LB = Fraction("0.45359237") * Fraction("9.80665"), Fraction("0.0254"), Fraction("0.45359237")
UNITS = {
    ("lbf", "N"): LBF,
    ("N", "N"): Fraction(1),
    ("lbf*in", "N m"): LBF * IN,
    ("lbf-in", "N m"): LBF * IN,
    ("Nm", "N m"): Fraction(1),
    ("lbf/in", "N/m"): LBF / IN,
    ("N/mm", "N/m"): Fraction(1000),
    ("N/m", "N/m"): Fraction(1),
    ("lb", "kg"): LB,
    ("kg", "kg"): Fraction(1),
}


def made(train: str, cam: str = STEM, more: str = "") -> Recipe:
    return load_text(f"{cam}dynamics: {{rpm: 300, {train}}}\n{more}", "pounds.yaml")


def train(text: str, cam: str = STEM) -> Dynamics:
    found = made(text, cam).of(Dynamics)
    assert found is not None
    return found


def refusal(text: str, cam: str = STEM, more: str = "") -> str:
    with pytest.raises(RecipeErrors) as caught:
        made(text, cam, more)
    (error,) = caught.value.errors
    return str(error)


@given(
    st.decimals(min_value="1e-6", max_value="1e5", places=6), st.sampled_from(sorted(UNITS)), st.sampled_from(["", " "])
)
def test_a_decimal_is_rounded_once(value: object, units: tuple[str, str], between: str) -> None:
    unit, own = units
    exact = Fraction(str(value)) * UNITS[units]
    assert read_quantity(f"{value}{between}{unit}", own) == exact.numerator / exact.denominator


def test_a_train_in_pounds() -> None:
    """Published factors: a pound-force is 4.4482216152605 N, one by the inch 175.12683524647 N/m (NIST SP 811)."""
    found = train("mass: 2 lb, preload: 10 lbf, rate: 30 lbf/in, load: -5 lbf")
    assert found.mass == 2.0 * 0.45359237
    assert found.preload == pytest.approx(44.482216152605, rel=1e-15)
    assert found.rate == pytest.approx(30.0 * 175.126835246476, rel=1e-13)
    assert float(str(found.load)) == pytest.approx(-22.2411080763025, rel=1e-15)
    assert train("mass: 1 kg, preload: 80 N, rate: 2 N/mm") == train("mass: 1, preload: 80, rate: 2000")
    assert train("mass: 1, least_force: 20 lbf").least_force == pytest.approx(88.96443230521)
    assert train("mass: 1, stiffness: 1000 lbf/in, preload: 9").stiffness == pytest.approx(175126.835246476)


def test_bare_numbers_stay_si_in_inches() -> None:
    inches = load_text(
        "units: inch\n" + STEM.replace("40", "2").replace("10}", "0.5}").replace(" 20,", " 0.5,")
        + "dynamics: {rpm: 300, mass: 1, preload: 80, rate: 2000, load: 30}\n", "a.yaml"
    )  # fmt: skip
    assert inches.of(Dynamics) == train("mass: 1, preload: 80, rate: 2000, load: 30")


def test_what_turns_takes_moments() -> None:
    found = train("mass: 0.01, preload: 20 lbf*in, load: 3 lbf-in", ARM)
    assert found.preload == pytest.approx(20.0 * 0.1129848290276167, rel=1e-15)
    assert float(str(found.load)) == pytest.approx(3.0 * 0.1129848290276167, rel=1e-15)


def test_contacts_under_preload_and_limits() -> None:
    text = (
        "cam: {kind: support, p: 25 + 2*cos(3*t), preload: {interference: 0.03, stiffness: [1000 lbf/in, 200 N/mm]}}\n"
    )
    recipe = load_text(text + "limits: {preload-force-least: {at_least: 10 lbf}}\n", "a.yaml")
    assert recipe.cam.preload.stiffness == pytest.approx((175126.835246476, 2e5))  # type: ignore[attr-defined]
    assert recipe.limits[0].at_least == pytest.approx(44.482216152605)
    limited = made(
        "mass: 1, preload: 80",
        more="limits: {contact-force-greatest: {at_most: 1 lbf}, shaft-torque: {at_most: 2 Nm}}\n",
    )
    assert [one.at_most for one in limited.limits] == [pytest.approx(4.4482216152605), 2.0]


# needs: sweep
def test_a_sweep_accepts_designs_by_pounds() -> None:
    more = (
        "sweep: {vary: {cam.base_radius: [40, 45]}, limits: {contact-force-greatest: {at_most: 100 lbf}}, rank: size}\n"
    )
    sweep = made("mass: 1, preload: 12 lbf", more=more).of(Sweep)
    assert sweep is not None
    assert sweep.limits[0].at_most == pytest.approx(444.82216152605)


FORCE, RATE, MASS = (
    "give N or lbf, or",
    "give N/m, N/mm or lbf/in, or",
    "give kg or lb, or a number alone, which is in kg",
)


@pytest.mark.parametrize(
    ("text", "cam", "words"),
    [
        ("mass: 2 lbs, preload: 9", STEM, f"dynamics.mass: 'lbs' is no unit of a mass, given '2 lbs'; {MASS}"),
        ("mass: 2 lbf, preload: 9", STEM, f"'lbf' is no unit of a mass, given '2 lbf'; {MASS}"),
        ("mass: 1, preload: 9 lb", STEM, f"dynamics.preload: 'lb' is no unit of a force, given '9 lb'; {FORCE}"),
        ("mass: 1, preload: 9 lbs", STEM, f"'lbs' is no unit of a force, given '9 lbs'; {FORCE}"),
        ("mass: 1, preload: 9 kN", STEM, f"'kN' is no unit of a force, given '9 kN'; {FORCE}"),
        ("mass: 1, preload: 9, rate: 3 lb/in", STEM, f"'lb/in' is no unit of a spring rate, given '3 lb/in'; {RATE}"),
        ("mass: 1, preload: 9, rate: 3 lbf", STEM, f"'lbf' is no unit of a spring rate, given '3 lbf'; {RATE}"),
        (
            "mass: 1, preload: 9, load: 3 lbs",
            STEM,
            f"dynamics.load: 'lbs' is no unit of a force, given '3 lbs'; {FORCE}",
        ),
        (
            "mass: 1, preload: 9, load: 3 lbf*t",
            STEM,
            "'lbf*t' is no unit of a force, given '3 lbf*t'",
        ),
        ("mass: 1, preload: 9 lbf", ARM, "'lbf' is no unit of a moment, given '9 lbf'; give Nm, lbf*in or lbf-in, or"),
        (
            "mass: 1 lb, preload: 9",
            ARM,
            "dynamics.mass: carries a unit, given '1 lb'; give a number above 0 in kg m² without",
        ),
        ("mass: 1, preload: 9, rate: 3 lbf/in", ARM, "give a number of at least 0 in N m/rad without a unit"),
        ("mass: 1, preload: 9, damping: 2 lbf", STEM, "dynamics.damping: carries a unit, given '2 lbf'"),
        ("mass: 1, preload: -9 lbf", STEM, "dynamics.preload: not above 0, given '-9 lbf'; give a number above 0 in N"),
    ],
)
def test_units_that_are_none(text: str, cam: str, words: str) -> None:
    assert words in refusal(text, cam)


def test_a_length_in_pounds() -> None:
    with pytest.raises(RecipeErrors, match="'lb' is no unit of a length"):
        load_text(STEM.replace("base_radius: 40", "base_radius: 4 lb"), "a.yaml")


def test_the_schema_takes_them() -> None:
    schema = json_schema(recipe_table())["properties"]["dynamics"]["properties"]
    for key, value, ok in (
        ("preload", "10 lbf", True),
        ("preload", "3 lbf*in", True),
        ("mass", "2 lb", True),
        ("mass", "2 lbs", False),
        ("rate", "30 lbf/in", True),
        ("rate", "30 lb/in", False),
    ):
        assert bool(re.search(schema[key]["anyOf"][1]["pattern"], value)) is ok, (key, value)


def test_a_linkage_whose_output_swings_has_moments() -> None:
    linked = """\
cam: {kind: support, p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t), shaft: [18, 8.5]}
linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}
"""
    found = train("mass: 0.02, stiffness: 200, damping: 0.01, preload: 20 lbf*in", linked)
    assert found.preload == pytest.approx(20.0 * 0.1129848290276167, rel=1e-15)
    assert "'lbf' is no unit of a moment" in refusal("mass: 0.02, stiffness: 200, preload: 20 lbf", linked)
