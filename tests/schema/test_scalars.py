"""Plain arithmetic wherever a recipe has a number: values, refusals with their place, the JSON schema, a sweep."""

from __future__ import annotations

import math
import re

import pytest

from camgeo.cams.constant_breadth import ConstantBreadthCam
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.loading import load_text
from camgeo.schema.edit import with_values
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.json_schema import json_schema
from camgeo.schema.scalars import Complaint, read_number, whole

TEXT = (
    "cam: {{kind: constant-breadth, base_radius: {0}, "
    "motion: [{{rise: 20, over: 120, law: cycloidal}}, {{dwell: 60}}]}}\n"
)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("15/25.4", 15 / 25.4),
        ("2*(3 + 0.5)", 7.0),
        ("0.1+0.2", 0.1 + 0.2),
        ("-(2 - 5)*1e1", 30.0),
        ("--3", 3.0),
        ("pi", math.pi),
        ("180/pi", 180 / math.pi),
        ("1/2/4", 0.125),
        ("180/7", 180 / 7),
        ("10-1", 9.0),
        ("2**3", 8.0),
        ("3*2 ** -1", 1.5),
    ],
)
def test_what_it_comes_to(text: str, value: float) -> None:
    assert read_number(text) == value


def test_a_whole_number() -> None:
    assert whole(read_number("2*3 + 1")) == 7
    with pytest.raises(Complaint, match="not a whole number"):
        whole(read_number("7/2.0"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("5/(2 - 2)", "divides by zero, given '5/(2 - 2)'; give a length above 0 in mm"),
        ("1e308*10", "too large, given '1e308*10'; give a length above 0 in mm"),
        ("1 - 3", "not above 0, given '1 - 3'; give a length above 0 in mm"),
        ("2* *3", "not a number, given '2* *3'; numbers are joined by + - * / ** and parentheses alone"),
        ("10**1000", "not a number: the exponent 1000 is too large; exponents run from -199 to 199, given '10**1000'"),
        ("9**9**9", "not a number: the exponent 3.8742e+08 is too large"),
        ("0**-1", "divides by zero"),
        ("(1 + 2", "not a number: this parenthesis is never closed, given '(1 + 2'; give a length above 0 in mm"),
        ("1/3/", "not a number: it ends where a number, a name or a parenthesis should follow, given '1/3/'"),
        ("010 + 1", "a leading zero, which some read as octal, given '010 + 1'; leave the zero out"),
        ("sin(1)", "not a number, given 'sin(1)'; give a length above 0 in mm"),
        ("e*2", "not a number, given 'e*2'"),
        ("2 3", "not a number, given '2 3'"),
        ("2 1/2", "not a number, given '2 1/2'; a mixed number takes a plus, such as 1+1/2"),
    ],
)
def test_what_is_refused_and_where(text: str, said: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        load_text(TEXT.format(text), "arithmetic.yaml")
    assert str(caught.value).startswith(f"arithmetic.yaml:1:44: cam.base_radius: {said}")


def test_no_text_takes_long() -> None:
    """The longest that is read, of alike characters: the patterns do not look at it in many ways."""
    for text in ("1" * 59 + "x", "(" * 60, "1." * 30, "+" * 60, "pi" * 30, "1e" * 30):
        with pytest.raises(Complaint):
            read_number(text)


def test_the_json_schema_knows_it() -> None:
    kinds = json_schema(recipe_table())["properties"]["cam"]["oneOf"]
    cam = next(kind for kind in kinds if "base_radius" in kind["properties"])
    pattern = re.compile(cam["properties"]["base_radius"]["anyOf"][1]["pattern"])
    assert all(map(pattern.search, ("15/25.4", "2*(3 + 0.5)", "1e-3", "pi", "-.5")))
    assert not any(map(pattern.search, ("", "abc", "( )", "12 m", "sin(1)", "1,5")))


def test_wherever_a_number_is_expected() -> None:
    text = (
        "units: inch\n"
        "cam: {kind: support, fourier: {mean: 15/25.4, cos: {3: 1/100 + 0.001}}, shaft: [2*0.05, -(1/20)]}\n"
        "part: {bore: 5/25.4}\n"
        "export: {tolerance: 0.01/25.4, files: [dxf]}\n"
    )
    recipe = load_text(text, "inch.yaml")
    assert recipe.part.bore == pytest.approx(5.0)
    assert recipe.export.tolerance == pytest.approx(0.01)
    assert "cos: {3: 0.5}" in with_values(text, {"cam.fourier.cos.3": 0.5})


def test_a_sweep_varies_it() -> None:
    text = TEXT.format("80/2")
    cam = load_text(with_values(text, {"cam.base_radius": 41.0}), "swept.yaml").cam
    assert isinstance(cam, ConstantBreadthCam)
    assert cam.base_radius == 41.0
