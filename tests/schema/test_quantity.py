"""Numbers with units: each reads as the number in the field's own unit, and what is no unit of it is refused."""

from __future__ import annotations

import re
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from camgeo.recipe.keys import recipe_table
from camgeo.recipe.loading import load_text
from camgeo.schema.edit import with_values
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.json_schema import json_schema
from camgeo.schema.quantity import read_quantity

MM = {"mm": Fraction(1), "cm": Fraction(10), "in": Fraction(254, 10), "inch": Fraction(254, 10)}
TAKEN = "give mm, cm, in or inch, or a number alone, which is in"
DISC = """\
units: {units}
cam:
  kind: disc
  base_radius: {radius}
  follower: {{kind: roller, radius: {roller}, offset: {offset}}}
  motion: [{{rise: {rise}, over: {over}, law: cycloidal}}, {{dwell: 60}}, {{return: {rise}, over: 180, law: cycloidal}}]
part: {{bore: {{square: {bore}}}, bolts: {{count: 3, circle: {circle}, hole: {bolt}}}, thickness: {thickness}}}
limits: {{size: {{at_most: {size}}}, pressure-angle: {{at_most: {angle}}}}}
"""
PLAIN = {
    "units": "mm", "radius": "40", "roller": "9.525", "offset": "-2.54", "rise": "12.7", "over": "120", "bore": "10",
    "circle": "50.8", "bolt": "5", "thickness": "6.35", "size": "76.2", "angle": "45",
}  # fmt: skip
CARRIED = PLAIN | {
    "radius": "4 cm", "roller": "3/8 in", "offset": "-0.1in", "rise": "1/2 inch", "over": "120 deg", "bore": "10mm",
    "circle": "2 in", "bolt": "5 mm", "thickness": "0.25 in", "size": "(1 + 2) in", "angle": "45deg",
}  # fmt: skip


def refusal(text: str) -> str:
    with pytest.raises(RecipeErrors) as caught:
        load_text(text, "unit.yaml")
    return str(caught.value)


def support(text: str, units: str = "mm") -> str:
    return f"units: {units}\ncam: {{kind: support, p: 25 + 2*cos(3*t), shaft: [{text}, 4]}}\n"


def test_a_recipe_with_units_is_the_one_without() -> None:
    assert load_text(DISC.format(**CARRIED), "a.yaml") == load_text(DISC.format(**PLAIN), "a.yaml")


@pytest.mark.parametrize(
    ("text", "units", "value"),
    [
        ("0.75 in", "mm", 19.05),
        ("15/25.4 inch", "mm", 15.0),
        ("1+1/2 in", "mm", 38.1),
        ("2*pi mm", "mm", 6.283185307179586),
        ("-.5cm", "mm", -5.0),
        ("1e-3 in", "mm", 0.0254),
        ("0 in", "mm", 0.0),
        ("25.4 mm", "inch", 25.4),
        ("1/3 in", "inch", 25.4 / 3),
    ],
)
def test_the_number_that_is_read(text: str, units: str, value: float) -> None:
    shaft = load_text(support(text, units), "a.yaml").cam.shaft  # type: ignore[attr-defined]
    assert shaft[0] == pytest.approx(value, rel=3e-16, abs=0)


@given(
    st.decimals(min_value="1e-6", max_value="1e5", places=6),
    st.sampled_from(sorted(MM)),
    st.sampled_from(["mm", "inch"]),
    st.sampled_from(["", " "]),
)
def test_a_decimal_is_rounded_once(value: object, unit: str, own: str, between: str) -> None:
    exact = Fraction(str(value)) * MM[unit] / MM[own]
    assert read_quantity(f"{value}{between}{unit}", own) == exact.numerator / exact.denominator


@given(st.integers(1, 10**6), st.integers(1, 10**6), st.sampled_from(sorted(MM)), st.sampled_from(["mm", "inch"]))
def test_a_fraction_is_rounded_once(over: int, under: int, unit: str, own: str) -> None:
    exact = Fraction(over, under) * MM[unit] / MM[own]
    assert read_quantity(f"{over}/{under} {unit}", own) == exact.numerator / exact.denominator


@given(st.floats(1e-3, 1e3), st.sampled_from(["mm", "inch"]))
def test_the_own_unit_changes_nothing(value: float, own: str) -> None:
    assert read_quantity(f"{value!r} {own}", own) == value
    assert read_quantity(f"{value!r} deg", "degrees") == value


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("field", "text", "said"),
    [
        ("radius", "5 m", f"cam.base_radius: 'm' is no unit of a length, given '5 m'; {TAKEN} mm"),
        ("radius", "5 inches", f"cam.base_radius: 'inches' is no unit of a length, given '5 inches'; {TAKEN} mm"),
        ("radius", "'0.75\"'", f"cam.base_radius: '\"' is no unit of a length, given '0.75\"'; {TAKEN} mm"),
        ("radius", "30 deg", f"cam.base_radius: 'deg' is no unit of a length, given '30 deg'; {TAKEN} mm"),
        ("radius", "5 N/m", f"cam.base_radius: 'N/m' is no unit of a length, given '5 N/m'; {TAKEN} mm"),
        ("radius", "5 mm^2", f"cam.base_radius: 'mm^2' is no unit of a length, given '5 mm^2'; {TAKEN} mm"),
        ("size", "3 kg", f"limits.size.at_most: 'kg' is no unit of a length, given '3 kg'; {TAKEN} mm"),
        ("radius", "10 mm + 3", "given '10 mm + 3'; a unit stands once, behind the whole number"),
        ("radius", "1 1/2 in", "given '1 1/2 in'; a mixed number takes a plus, such as 1+1/2"),
        ("radius", "-3 in", "cam.base_radius: not above 0, given '-3 in'; give a length above 0 in mm"),
        ("radius", "1e308 in", "cam.base_radius: too large, given '1e308 in'"),
        ("radius", "1e-99999999 in", "cam.base_radius: not above 0"),
        ("radius", "100 km", "cam.base_radius: 'km' is no unit of a length"),
        ("radius", "100000 in", "cam.base_radius: above 2000000, given '100000 in'"),
        (
            "over",
            "1 rad",
            "over: 'rad' is no unit of an angle, given '1 rad'; give deg, or a number alone, which is in",
        ),
        ("angle", "4 mm", "limits.pressure-angle.at_most: 'mm' is no unit of an angle, given '4 mm'; give deg, or a"),
    ],
)
def test_what_is_no_unit_of_a_field(field: str, text: str, said: str) -> None:
    assert said in refusal(DISC.format(**PLAIN | {field: text}))


@pytest.mark.parametrize(
    ("section", "said"),
    [
        (
            "manufacture: {cutter: 6, spindle: 9000 rpm}",
            "given '9000 rpm'; give a number above 0 up to 1000000 without a unit: speed of the spindle, turns",
        ),
        # needs: dynamics
        (
            "dynamics: {mass: 1, stiffness: 2e5, damping: 30 N s/m, preload: 100, rate: 1000, rpm: 600}",
            "dynamics.damping: not a number, given '30 N s/m'; give a number of at least 0",
        ),
        ("verify: {angles: 360 mm}", "verify.angles: carries a unit, given '360 mm'; give a whole number"),
    ],
)
def test_a_number_of_another_kind_takes_none(section: str, said: str) -> None:
    assert said in refusal(f"{support('10')}{section}\n")


def test_a_formula_takes_none() -> None:
    said = refusal("cam: {kind: support, p: 1 in + 2*cos(3*t)}\nunits: inch\n")
    assert said.endswith("a formula carries no units, given '1 in + 2*cos(3*t)'; give its numbers alone, in inch")


@pytest.mark.thin(3)
@pytest.mark.parametrize("bore", [8, 10, 12, 17, 22, 30, 38, 44, 50, 58])
def test_a_metric_length_in_inches_is_what_a_standard_takes(bore: int) -> None:
    """A keyway's range ends at these bores; one in the last place more would have the next."""
    text = "units: {}\ncam: {{kind: support, p: 60}}\npart: {{thickness: 8 mm, bore: {} mm, keyway: din6885}}"
    metric, inches = (load_text(text.format(units, bore), "a.yaml").part for units in ("mm", "inch"))
    assert inches == metric
    assert inches.bore == bore


def test_strokes_are_lengths_or_angles_as_the_follower_moves() -> None:
    swings = (
        "cam: {{kind: disc, base_radius: 34, follower: {{kind: roller, radius: 8, arm: {{length: 65, pivot: 80}}}}, "
    )
    swings += "motion: [{{rise: {0}, over: 100, law: cycloidal}}, {{return: {0}, over: 260, law: cycloidal}}]}}\n"
    assert load_text(swings.format("20 deg"), "a.yaml") == load_text(swings.format("20"), "a.yaml")
    assert "rise: 'mm' is no unit of an angle" in refusal(swings.format("20 mm"))


def test_points_of_a_motion() -> None:
    motion = "motion: {{points: [[{}, 0], [90, {}], [180, 0]]}}"
    text = "cam: {{kind: disc, base_radius: 34, follower: {{kind: roller, radius: 8}}, {}}}\n"
    carried, plain = text.format(motion.format("0 deg", "0.5 in")), text.format(motion.format("0", "12.7"))
    assert load_text(carried, "a.yaml") == load_text(plain, "a.yaml")


def test_a_value_is_written_in_the_recipes_unit() -> None:
    text = with_values(support("12 mm", "inch"), {"cam.shaft[0]": 0.5})
    assert "shaft: [0.5, 4]" in text
    with pytest.raises(ValueError, match="no number at units"):
        with_values(text, {"units": 1.0})


def test_replaced_by_a_program() -> None:
    recipe = load_text(support("10"), "a.yaml")
    assert recipe.replace("cam.shaft[0]", "0.5 in").cam == load_text(support("12.7"), "a.yaml").cam
    again = recipe.replace("part", {"bore": "3/8 in"})
    assert again.part.bore == 9.525
    assert load_text(again.text, "a.yaml") == again


def test_the_json_schema_knows_them() -> None:
    cam = json_schema(recipe_table())["properties"]["cam"]["oneOf"]
    lengths = next(kind for kind in cam if "base_radius" in kind["properties"])["properties"]["base_radius"]
    pattern = re.compile(lengths["anyOf"][1]["pattern"])
    assert all(map(pattern.search, ("15/25.4 in", "10mm", "1.5 cm", "3/4 inch", "2*pi mm")))
    assert not any(map(pattern.search, ("10 deg", "10 m", "mm", "10 mm 3", "10 N/m")))
    start = json_schema(recipe_table())["properties"]["manufacture"]["properties"]["start"]["anyOf"][1]["pattern"]
    assert re.search(start, "30 deg")
    assert not re.search(start, "30 mm")
