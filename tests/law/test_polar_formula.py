"""Transmission laws from a formula for D, and from any first arc, against the closed forms and W's own equations."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.law.formula.formula import Formula
from kin.law.normalised import IntentError
from kin.law.polar_formula import from_curve, from_delta_formula
from kin.law.transmission import from_arc, from_delta

TURN = 2 * math.pi
T = np.linspace(0.013, TURN, 401)


def closes(law):
    """How far r(t) and r(t + alpha) miss the closing equation (W 7.1), of l^2."""
    first, second = (law.pitch(law.polar_parameter(t), 0)[0][0] for t in (T, T + law.alpha))
    miss = first**2 + second**2 - 2 * first * second * math.cos(law.alpha)
    return float(np.abs(miss - (2 * law.arm * math.sin(law.alpha)) ** 2).max()) / law.arm**2


def refused(make, *arguments):
    with pytest.raises(IntentError) as caught:
        make(*arguments)
    return caught.value


@settings(max_examples=examples(30), deadline=None)
@given(
    ratio=st.sampled_from([(2, 1), (3, 1), (4, 3), (5, 3)]),
    cos=st.dictionaries(st.sampled_from([1, 3, 5]), st.floats(-900, 900).map(lambda x: round(x, 3)), min_size=1),
    sin=st.dictionaries(st.sampled_from([1, 3]), st.floats(-300, 300).map(lambda x: round(x, 3))),
)
def test_a_sum_of_harmonics_is_the_same_law_as_a_formula(ratio, cos, sin):
    lam, mu = ratio
    terms = [f"{a!r}*cos({j * lam}*t)" for j, a in cos.items()] + [f"{a!r}*sin({j * lam}*t)" for j, a in sin.items()]
    formula = Formula(" + ".join(terms))
    try:
        expected = from_delta(lam, mu, 60.0, cos, sin)
    except IntentError:
        refused(from_delta_formula, lam, mu, 60.0, formula)
        return
    found = from_delta_formula(lam, mu, 60.0, formula)
    assert found.breaks.tolist() == expected.breaks.tolist()
    size = max(1.0, float(np.abs(expected.at(T, 2)[1]).max()))
    assert found.at(T, 2)[1] == pytest.approx(expected.at(T, 2)[1], abs=1e-11 * size)


def test_a_formula_in_inches_is_scaled_and_grows_with_the_arm():
    plain = from_delta_formula(4, 3, 50.8, Formula("600*cos(4*t)**3"))
    inch = from_delta_formula(4, 3, 50.8, Formula(f"{600 / 25.4**2!r}*cos(4*t)**3"), 25.4**2)
    assert inch.at(T, 1)[1] == pytest.approx(plain.at(T, 1)[1], abs=1e-14)
    assert plain.scaled(2.0).pitch(T, 0)[0] == pytest.approx(2 * plain.pitch(T, 0)[0], rel=1e-15)
    assert 0 < plain.rounding < 1e-11


def test_a_d_that_bends_has_its_breaks_and_closes():
    law = from_delta_formula(4, 3, 60.0, Formula("300*abs(cos(4*t))*cos(4*t)"))
    assert np.degrees(law.breaks[:3]) == pytest.approx([0, 22.5, 45], abs=1e-9)
    d = 300 * np.abs(np.cos(4 * T)) * np.cos(4 * T)
    slant = math.pi / 4 - law.alpha / 2
    r = math.sqrt(2) * (math.cos(slant) * np.sqrt(3600 + d) + math.sin(slant) * np.sqrt(3600 - d))  # W 5.10
    assert law.pitch(law.polar_parameter(T), 0)[0][0] == pytest.approx(r, rel=1e-14)
    assert closes(law) < 1e-12


def test_a_d_of_0_and_a_circle_are_rests():
    assert from_delta_formula(4, 3, 60.0, Formula("0*t")).level.tolist() == [0.0]
    assert from_curve(3, 1, 60.0, Formula("120*cos(pi/6)")).level.tolist() == [0.0]


@pytest.mark.parametrize(("side", "radius"), [("convex", 80.0), ("convex", 200.0)])
def test_a_circle_by_a_formula_is_the_circular_arc(side, radius):
    mean = 120 * math.cos(math.pi / 6)
    centre = mean * math.cos(math.pi / 6) - math.sqrt(radius**2 - (mean * math.sin(math.pi / 6)) ** 2)
    text = f"{centre!r}*cos(t - pi/6) + sqrt({radius**2!r} - ({centre!r})**2*sin(t - pi/6)**2)"
    found, expected = from_curve(3, 1, 60.0, Formula(text)), from_arc(3, 1, 60.0, radius, side)
    assert found.at(T, 1)[1] == pytest.approx(expected.at(T, 1)[1], abs=1e-13)
    assert found.breaks == pytest.approx(expected.breaks, abs=1e-14)


def test_any_arc_that_joins_its_image_closes():
    law = from_curve(5, 3, 60.0, Formula("120*cos(3*pi/10) + 4*sin(5*t)**3 + sin(10*t)**3"))
    first = np.linspace(0.01, math.pi / 5 - 0.01, 50)
    expected = 120 * math.cos(0.3 * math.pi) + 4 * np.sin(5 * first) ** 3 + np.sin(10 * first) ** 3
    assert law.pitch(law.polar_parameter(first), 0)[0][0] == pytest.approx(expected, rel=1e-14)
    assert closes(law) < 1e-12


@pytest.mark.parametrize(
    ("text", "message", "mended"),
    [
        ("600*cos(3*t)", "sines and cosines of 4*t and of its odd multiples have it", "600*cos(4*t)"),
        ("600*cos(4*t)**2", "D(t + delta) must be -D(t), delta = 45 degrees", "600*cos(4*t)**3"),
        ("3600*cos(4*t)", "|D| must stay below l^2 = 3600 mm^2; it is 3600 at t = 0 degrees", "600*cos(4*t)"),
        ("2500*cos(4*t)", "psi'(phi) must stay below 1", "600*cos(4*t)"),
        ("300*sign(cos(4*t))", "psi jumps from 4.78019185 to -4.78019185 degrees", "300*cos(4*t)"),
        ("1/sin(4*t)", "division by zero", "cos(4*t)/(2 - cos(4*t)**2)"),
    ],
)
def test_a_d_that_is_none_is_refused(text, message, mended):
    error = refused(from_delta_formula, 4, 3, 60.0, Formula(text))
    assert error.field == "delta.formula"
    assert message in error.message
    from_delta_formula(4, 3, 60.0, Formula(mended))


@pytest.mark.parametrize(
    ("text", "message", "mended"),
    [
        ("100 + 2*sin(3*t)", "an arc from r = 103.923048 to the same does", "103.92304845413265 + 2*sin(3*t)"),
        ("103.92304845413265 + sin(6*t)", "psi'(phi) jumps from", "103.92304845413265 + sin(6*t)**3"),
        ("130 + t", "r must stay below 2 l = 120 mm; it is 131.047198 at t = 60", "103.92304845413265 + 0*t"),
        ("103.92304845413265 - 50*sin(3*t)", "psi'(phi) must stay below 1", "103.92304845413265 - 2*sin(3*t)"),
    ],
)
def test_an_arc_that_is_none_is_refused(text, message, mended):
    error = refused(from_curve, 3, 1, 60.0, Formula(text))
    assert error.field == "arc.formula"
    assert message in error.message
    from_curve(3, 1, 60.0, Formula(mended))
