"""Formulas: the grammar, its bounds and messages; values against Python, enclosures against mpmath; switches.

Holds: kin.law.formula.parser, kin.law.formula.roots, kin.law.formula.switches.
"""

from __future__ import annotations

import math
import pickle
from fractions import Fraction
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.law.formula.expression import Expression
from kin.law.formula.formula import Formula, FormulaDomainError, FormulaError
from kin.numeric.elementary import BallJet, DomainError, Jet

TURN = 2 * math.pi
FUNCTIONS = "sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, exp, log, sqrt, cbrt, hypot, abs, sign, min, max"
CAM_2A = "25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t)"


def python_value(text: str, t: float) -> float:
    names = {name: getattr(math, name) for name in ("sin", "cos", "tan", "exp", "hypot", "atan2", "pi", "e", "cbrt")}
    return eval(f"({text})", {"__builtins__": {}}, names | {"t": t, "abs": abs, "min": min, "max": max})


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    "text",
    [
        CAM_2A,
        "-t**2",
        "2**-t",
        "2**3**2 + t",
        "-2**2*t",
        "t - 1 - 2 - 3",
        "t/2/3",
        "2/3*t",
        "- - + -t",
        "(t)",
        "1.5e-1*t + .5 + 2. + 1E2",
        "  sin ( t )\n * 2 ",
        "min(t, 1, cos(t)) + max(2, t)",
        "abs(t - 1)*pi + e",
        "hypot(t, 3) + atan2(t, -2)",
        "cbrt(-t)",
        "t**2.0 + t**0 + t**1",
        "(1 + t)**(1/2)",
        "t**t",
    ],
)
def test_a_formula_means_what_it_means_in_python(text: str) -> None:
    t = np.array([0.3, 1.0, 2.7])
    found = Formula(text)(t)
    np.testing.assert_allclose(found, [python_value(text, x) for x in t], rtol=1e-14)
    assert Formula(text)(0.3) == found[0]


atoms = st.one_of(st.just("t"), st.integers(0, 9).map(str), st.floats(0, 9, width=16).map(lambda x: f"{x:.3f}"))
trees = st.recursive(
    atoms,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", "*", " / "]), inner).map("".join),
        inner.map(lambda a: f"-{a}"),
        inner.map(lambda a: f"({a})"),
        inner.map(lambda a: f"({a})**2"),
        st.tuples(st.sampled_from(["sin", "cos", "abs"]), inner).map(lambda p: f"{p[0]}({p[1]})"),
        st.tuples(st.sampled_from(["min", "max", "hypot"]), inner, inner).map(lambda p: f"{p[0]}({p[1]}, {p[2]})"),
    ),
    max_leaves=12,
)


@given(trees, st.floats(-3, 3))
@settings(max_examples=examples(300), deadline=None)
def test_random_formulas_agree_with_python(text: str, t: float) -> None:
    try:
        expected = python_value(text, t)
    except ArithmeticError:
        with pytest.raises(FormulaError, match=r"division by zero|overflow"):
            Formula(text)(t)
        return
    found = attempt(lambda: Formula(text)(t))
    if isinstance(found, FormulaError):  # refused as soon as any part is not finite
        assert found.message.startswith(("overflow", "division by zero"))
    else:
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-9) or abs(expected) > 1e6


@given(st.text(max_size=40))
@settings(max_examples=examples(400))
@example("9**9**9")
@example("\x00")
@example("t\u0301")
@example("1_000")
@example("٣*t")
@example("__import__('os')")
@example("(" * 1000)
@example("-" * 1000)
@example("t**" * 300)
@example("(((9**99)**99)**99)**99")
@example("max(" * 40)
def test_any_text_is_a_formula_or_an_error_with_its_place(text: str) -> None:
    check_text(text)


@given(st.lists(st.sampled_from([*"t0123456789.+-*/(), e", "**", "pi", *FUNCTIONS.split(", "), "(t)"]), max_size=30))
@settings(max_examples=examples(600))
def test_any_text_out_of_the_signs_is_a_formula_or_an_error_with_its_place(signs: list[str]) -> None:
    check_text("".join(signs))


def check_text(text: str) -> None:
    formula = attempt(lambda: Formula(text))
    if isinstance(formula, FormulaError):
        assert type(formula) is FormulaError
        assert 0 <= formula.column <= len(text)
        assert formula.message == str(formula)
        return
    jet = attempt(lambda: formula.jet(np.array([0.1, 1.0]), 3))
    if isinstance(jet, FormulaError):
        assert isinstance(jet, FormulaDomainError)
        assert jet.at in {0.1, 1.0}
    formula.ball(0.1, 1.0, 3)
    taken_apart = attempt(lambda: formula.pieces(0.1, 1.0))
    if isinstance(taken_apart, FormulaError):
        assert 0 <= taken_apart.column <= len(text)
    else:
        assert len(taken_apart[0]) == len(taken_apart[1]) + 1


def attempt(call):
    try:
        return call()
    except FormulaError as error:
        return error


@pytest.mark.parametrize(
    ("text", "message", "column"),
    [
        ("", "the formula is empty", 0),
        ("  ", "the formula is empty", 0),
        ("25 + 3t", "no operator between '3' and 't'; write 3*t", 6),
        ("3 sin(t)", "no operator between '3' and 'sin'; write 3*sin(...)", 2),
        ("2(t + 1)", "no operator between '2' and '('; write 2*(...)", 1),
        ("(t + 1)(t + 2)", "no operator between ')' and '('; write (...)*(...)", 7),
        ("t 2", "no operator between 't' and '2'; write t*2", 2),
        ("t(2)", "no operator between 't' and '('; write t*(...)", 1),
        ("sin t", "sin takes its argument in parentheses: sin(...)", 0),
        ("t^2", "'^' is not understood; a power is written **", 1),
        ("2·t", "'·' is not understood; a product is written *", 1),
        ("t − 1", "'−' is not understood; minus is written -", 2),
        ("2*π", "'π' is not understood; pi is written pi", 2),
        ("p = t", "'=' is not understood; a formula is the right-hand side alone", 2),
        ("t//2", "'//' is not understood; a quotient is written /", 1),
        ("t # 2", "'#' is not understood; it has no meaning here", 2),
        ("sin(t", "this parenthesis is never closed", 3),
        ("(t,1)", "this parenthesis is not closed before ','", 0),
        ("t)", "this closing parenthesis was never opened", 1),
        ("2,5*t", "a comma separates the arguments of a function; decimals take a point", 1),
        ("t +", "the formula ends where a number, a name or a parenthesis should follow", 3),
        ("t + * 2", "a number, a name or a parenthesis should stand before '*'", 4),
        ("atan2(t)", "atan2 takes two arguments, not 1", 0),
        ("1 + sin()", "sin takes one argument, not 0", 4),
        ("sin(t, 2)", "sin takes one argument, not 2", 0),
        ("max(t)", "max takes two arguments or more, not 1", 0),
        ("9**9**9", "the exponent 3.8742e+08 is too large; exponents run from -199 to 199", 1),
        ("t**200", "the exponent 200 is too large; exponents run from -199 to 199", 1),
        ("t**-200.5", "the exponent -200.5 is too large; exponents run from -199 to 199", 1),
        ("1e999*t", "1e999 is too large a number", 0),
        ("(9**199)**9", "overflow", 8),
        ("t + log(1 - 1)", "log of a number that is not positive", 4),
        ("t/(2 - 2)", "division by zero", 1),
        ("t + 1/0", "division by zero", 5),
        ("sqrt(-2)", "sqrt of a negative number", 0),
        ("(-8)**(1/3)", "fractional power of a negative number", 4),
        ("exp(1000)", "overflow in exp", 0),
        ("1+sn(t)", f"unknown name 'sn'; did you mean sin? (variable: t; constants: pi, e; functions: {FUNCTIONS})", 2),
        (
            "cosine(t)",
            f"unknown name 'cosine'; did you mean cos? (variable: t; constants: pi, e; functions: {FUNCTIONS})",
            0,
        ),
        ("ln(t)", f"unknown name 'ln'; write log (variable: t; constants: pi, e; functions: {FUNCTIONS})", 0),
        ("x", f"unknown name 'x' (variable: t; constants: pi, e; functions: {FUNCTIONS})", 0),
        ("t + " * 300, "the formula has 1200 characters; 1000 are allowed", 1000),
        ("t+" * 400 + "t", "the formula has more than 500 terms and operations", 499),
        ("(" * 51 + "t" + ")" * 51, "the formula is nested more than 50 deep", 50),
    ],
)
def test_an_error_says_what_is_wrong_where_and_what_would_do(text: str, message: str, column: int) -> None:
    with pytest.raises(FormulaError) as caught:
        Formula(text)
    assert (caught.value.message, caught.value.column) == (message, column)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.message, again.column) == (message, column)


def test_what_is_within_the_bounds_is_accepted() -> None:
    assert Formula("(" * 49 + "t" + ")" * 49)(2.0) == 2
    assert Formula("t+" * 249 + "t")(1.0) == 250
    assert Formula("t**199")(1.0) == 1
    assert Formula("u*x", ("u", "x"))(2.0, 3.0) == 6
    assert Formula("0.5*u", ("u",))(np.array([[1.0], [2.0]])).shape == (2, 1)


@pytest.mark.parametrize(
    ("text", "at", "order", "message", "column"),
    [
        ("1 + log(t - 1)", [2.0, 0.5], 2, "log of a number that is not positive at t = 0.5", 4),
        ("t + 1/(t - 1)", [2.0, 1.0], 0, "division by zero at t = 1", 5),
        ("sqrt(t - 2)", [3.0, 2.0], 1, "derivative of sqrt at zero at t = 2", 0),
        ("sqrt(1 - t)", [0.0, 2.25], 0, "sqrt of a negative number at t = 2.25", 0),
        ("asin(t)*2", [0.0, 1.5], 0, "asin of a number outside -1 to 1 at t = 1.5", 0),
        ("(t - 2)**-3", [0.0, 2.0], 3, "division by zero at t = 2", 7),
        ("exp(t)**100", [0.0, 9.0], 0, "overflow at t = 9", 6),
    ],
)
def test_leaving_the_domain_names_the_parameter(text: str, at: list, order: int, message: str, column: int) -> None:
    with pytest.raises(FormulaDomainError) as caught:
        Formula(text).jet(np.array(at), order)
    error = caught.value
    assert (error.message, error.column, error.at, error.indices.tolist()) == (message, column, at[1], [1])
    assert isinstance(error, DomainError)
    assert isinstance(error, FormulaError)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.at, again.operation) == (message, at[1], error.operation)
    assert np.isinf(Formula(text).ball(min(at), max(at), 1).rad[1]).all()


def test_wrong_calls_are_refused() -> None:
    with pytest.raises(TypeError, match="the formula is in u, x; 1 series were given"):
        Formula("u*x", ("u", "x")).jet(1.0, 2)
    with pytest.raises(ValueError, match="no interval from 1 to 1"):
        Formula("t").pieces(1, 1)


def test_equal_parts_are_computed_once_and_constants_beforehand() -> None:
    steps = Formula(CAM_2A).expression.steps
    assert sum(step.op == "sin" for step in steps) == 1
    assert [step.value for step in steps if step.op == "constant"] == [25, 3, 13 / 15, 2]
    assert [step.op for step in Formula("sin(1)**2 + 2**0.5*pi").expression.steps] == ["constant"]


@pytest.mark.parametrize(
    ("text", "exact"),
    [
        ("0.1*t + pi", lambda t: t / 10 + mpmath.pi),
        ("t*(sqrt(2)/7 + 1/3)", lambda t: t * (mpmath.sqrt(2) / 7 + mpmath.mpf(1) / 3)),
        ("0.3 - 0.1 + t - 0.2", lambda t: t),
        ("cos(pi/2) + sin(pi*t)", lambda t: mpmath.sin(mpmath.pi * t)),
        ("e**t + atan2(0, -1) + log(10)", lambda t: mpmath.exp(t) + mpmath.pi + mpmath.log(10)),
        ("3.0000000000000000001*t", lambda t: t * (3 + mpmath.mpf(10) ** -19)),
        ("tan(1) + t**2/tan(1)", lambda t: mpmath.tan(1) + t**2 / mpmath.tan(1)),
    ],
)
def test_a_ball_encloses_the_formula_as_it_is_written(text: str, exact) -> None:
    t = 0.7
    found = Formula(text).ball(t, t, 3)
    for k, value in enumerate(mpmath.taylor(exact, mpmath.mpf(t), 3)):
        # taylor itself rounds at 50 digits
        assert abs(value - mpmath.mpf(found.mid[k, 0])) <= mpmath.mpf(found.rad[k, 0]) + mpmath.mpf(10) ** -30
    assert (found.rad < 1e-13).all()


def test_the_cam_of_figure_2a_and_its_derivatives() -> None:
    """AS Figure 2 a, against the sum of harmonics it is: sin 3t cos 2t = (sin 5t + sin t)/2."""
    t = np.linspace(0, TURN, 50)
    found = Formula(CAM_2A).jet(t, 5).derivatives()
    for k in range(6):
        turn = k * math.pi / 2
        true = 3**k * np.sin(3 * t + turn) + 13 / 30 * (5**k * np.sin(5 * t + turn) + np.sin(t + turn)) + 25 * (k == 0)
        np.testing.assert_allclose(found[k], true, rtol=0, atol=1e-12 * 5**k)


@given(trees, st.floats(-3, 3), st.sampled_from([0.0, 1e-6, 0.1, 1.0]), st.floats(0, 1))
@settings(max_examples=examples(300), deadline=None)
def test_balls_of_random_formulas_hold_the_jets_inside(text: str, start: float, width: float, part: float) -> None:
    try:
        formula = Formula(text)
        point = min(start + part * width, start + width)
        jet = formula.jet(point, 3).c[:, 0]
    except FormulaError:
        return
    found = formula.ball(start, start + width, 3)
    # Where a switch lies in the interval a jet may stand on either side of it: value and slope are hulls of both.
    slack = 1e-11 * (1 + np.abs(jet).max())
    assert (np.abs(jet - found.mid[:, 0]) <= found.rad[:, 0] + slack).all()


def test_a_formula_applies_to_any_series() -> None:
    formula = Formula("t**2 + 1")
    inner = Jet.variable(np.array([0.5]), 3) * 2 + 1
    np.testing.assert_allclose(formula.on(inner).c[:, 0], [5, 8, 4, 0])
    np.testing.assert_allclose(formula(inner).c, formula.on(inner).c)
    balls = formula(BallJet.variable(0.0, 1.0, 1))
    assert isinstance(balls, BallJet)
    constant = Formula("25")
    np.testing.assert_array_equal(constant.jet(np.array([1.0, 2.0]), 1).c, [[25, 25], [0, 0]])
    assert constant.ball(0.0, 1.0, 1).rad.max() == 0
    np.testing.assert_array_equal(constant(np.zeros((2, 2))), np.full((2, 2), 25.0))


ROOT_OF_COS_T_IS_T = 0.7390851332151606416553120876738734


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("text", "breaks"),
    [
        (CAM_2A, []),
        ("abs(sin(t))", [0, math.pi, TURN]),
        ("abs(cos(t))", [math.pi / 2, 3 * math.pi / 2]),
        ("sign(sin(3*t - 1))", [(1 + k * math.pi) / 3 for k in range(6)]),
        ("max(sin(t), cos(t))", [math.pi / 4, 5 * math.pi / 4]),
        ("min(1, sin(t), cos(t))", [math.pi / 4, 5 * math.pi / 4]),
        ("max(cos(t), t)", [ROOT_OF_COS_T_IS_T]),
        ("abs(abs(sin(t)) - 1/2)", [0, *(x * math.pi / 6 for x in (1, 5, 6, 7, 11, 12))]),
        ("abs(max(sin(t), 0))", [0, math.pi, TURN]),
        ("abs(cos(t)*max(sin(t), 0))", [0, math.pi / 2, math.pi, TURN]),
        ("max(sin(t), max(sin(t), sin(t)))", []),
        ("abs(t - t)", []),
        ("abs(1 + sin(t))", []),
        ("abs(1.0000001 + sin(t))", []),
        ("abs(sin(t)**3)", [0, math.pi, TURN]),
        ("abs((t - 1)**5)", [1]),
        ("abs((t - 1)**4)", []),
        ("abs((t - 1)*(t - 2))", [1, 2]),
        ("abs(t - 1) + abs(t - 1)", [1]),
        ("abs(t)", [0]),
        ("abs(t - 7)", []),
        ("atan2(sin(t), cos(t) + 2)", []),
        ("atan2(sin(t), cos(t))", [0, math.pi, TURN]),
        ("atan2(sin(t - 1), cos(t - 1))", [1, 1 + math.pi]),
        ("sqrt(abs(t - 2))", [2]),
    ],
)
def test_breaks_are_found_to_the_last_places(text: str, breaks: list[float]) -> None:
    knots, parts = Formula(text).pieces(0, TURN)
    expected = [0, *(x for x in breaks if 0 < x < TURN), TURN]
    assert len(parts) == len(expected) - 1
    np.testing.assert_allclose(knots, expected, rtol=4e-16, atol=4e-16)


SLIVER = 1e-11  # of the variable: a switch as near as this to an end is the end


@given(st.floats(-0.999999, 0.999999), st.integers(1, 9), st.floats(-3, 3))
@example(0.9999999, 1, 0.0)
@example(9.5e-12, 1, 0.0)
@example(1.05e-11, 1, 0.0)
@example(1e-14, 5, 1.87e-11)
@settings(deadline=None)
def test_every_switch_is_found(level: float, factor: int, shift: float) -> None:
    """sin(k t + c) = d has its roots in closed form."""
    found = Formula(f"abs(sin({factor}*t + ({shift!r})) - ({level!r}))").pieces(0, TURN)[0]
    # The level is reached the less sharply the nearer it is to 1.
    rounding = 2e-14 / (factor * math.sqrt(1 - level**2))
    first = [mpmath.asin(level), mpmath.pi - mpmath.asin(level)]
    roots = sorted((x - shift + 2 * mpmath.pi * turn) / factor for x in first for turn in range(-12, 12))
    assume(all(abs(abs(root - end) - SLIVER) > rounding for root in roots for end in (0, TURN)))
    inner = [root for root in roots if SLIVER < root < TURN - SLIVER]
    assert len(found) == len(inner) + 2
    for x, root in zip(found[1:-1], inner, strict=True):
        assert abs(x - root) <= rounding


ENDING = "cannot be bounded, as acos, asin or a root has no slope where it ends,"


def test_two_switches_close_together_are_both_found() -> None:
    knots, _ = Formula("abs((t - 1)*(t - 1.0000001))").pieces(0, 3)
    np.testing.assert_allclose(knots[1:-1], [1, 1.0000001], atol=1e-9)
    near, _ = Formula("sign(cos(t) - 1 + 1e-9)").pieces(0, TURN)
    np.testing.assert_allclose(near[1:-1], [math.acos(1 - 1e-9), TURN - math.acos(1 - 1e-9)], atol=1e-10)


@pytest.mark.parametrize(
    ("text", "message", "column"),
    [
        (
            "1 + abs(sin(t)**2 + cos(t)**2 - 1)",
            "abs cannot be settled: the argument is zero, or close to it, too often near t = 0",
            4,
        ),
        ("abs(tan(t))", "abs cannot be settled: the argument has no value near t = 1.57079632679", 0),
        (
            "max(0, 0.8632 - acos(cos(t)))",
            f"max cannot be settled: the difference of the arguments {ENDING} near t = 0",
            0,
        ),
        (
            "t + max(1/t, 3)",
            "max cannot be settled: the difference of the arguments has no value near t = 0",
            4,
        ),
    ],
)
def test_a_switch_that_cannot_be_settled_is_refused(text: str, message: str, column: int) -> None:
    with pytest.raises(FormulaError) as caught:
        Formula(text).pieces(0, TURN)
    assert (caught.value.message, caught.value.column) == (message, column)


@pytest.mark.slow
def test_too_many_switches_are_refused() -> None:
    assert len(Formula("abs(sin(200*t))").pieces(0.001, TURN)[1]) == 400
    with pytest.raises(FormulaError, match="switches too often to be taken apart: more than 500 stretches"):
        Formula("abs(sin(1100*t))").pieces(0, TURN)
    with pytest.raises(FormulaError, match="too often near"):
        Formula("abs(sin(1e6*t))").pieces(0, TURN)


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    "text",
    [
        "abs(sin(t))",
        "abs(abs(sin(t)) - 0.5)*t",
        "max(sin(t), cos(t), 0.3)**3",
        "sign(cos(3*t))*t + min(t, 2)",
        "cos(t)*max(sin(t), 0) + abs(max(sin(t), 0))",
        "atan2(sin(t - 1) + 0.3, cos(t - 1) - 0.5)",
        "atan2(sin(t - 1), cos(t - 1))**2",
        "abs((t - 2)**3)",
    ],
)
def test_pieces_have_no_switch_and_make_up_the_formula(text: str) -> None:
    formula = Formula(text)
    knots, parts = formula.pieces(0, TURN)
    assert knots[0] == 0
    assert knots[-1] == TURN
    for (a, b), part in zip(pairwise(knots), parts, strict=True):
        assert isinstance(part, Expression)
        assert not {"abs", "sign", "min", "max", "atan2"} & {step.op for step in part.steps}
        t = a + (b - a) * np.linspace(0.01, 0.99, 25)
        np.testing.assert_allclose(part.jet(t, 3).c, formula.jet(t, 3).c, rtol=1e-12, atol=1e-12)
        ends = np.array([a, b])
        assert np.isfinite(part.jet(ends, 3).c).all()
        # Enclosed up to the very ends, and not by the cases next door.
        edges = np.linspace(a, b, 200)
        balls = part.ball(edges[:-1], edges[1:], 3)
        middle = part.jet(0.5 * (edges[:-1] + edges[1:]), 3).c
        assert (np.abs(balls.mid - middle) <= balls.rad).all()
        assert balls.rad.max() < 5


def test_pieces_give_both_limits_at_a_break() -> None:
    knots, (rising, falling) = Formula("abs(sin(t))").pieces(0, TURN)
    left = rising.jet(knots[1:2], 3).derivatives()[:, 0]
    right = falling.jet(knots[1:2], 3).derivatives()[:, 0]
    np.testing.assert_allclose(left, [0, -1, 0, 1], atol=2e-16)
    np.testing.assert_allclose(right, [0, 1, 0, -1], atol=2e-16)
    jump = Formula("atan2(sin(t), cos(t))").pieces(0, TURN)
    assert [float(part(math.pi)) for part in jump[1]] == pytest.approx([math.pi, -math.pi], abs=1e-15)


def test_a_stretch_that_is_zero_throughout_is_exactly_so() -> None:
    knots, parts = Formula("abs(cos(t)*max(sin(t), 0))").pieces(0, TURN)
    np.testing.assert_allclose(knots, [0, math.pi / 2, math.pi, TURN])
    last = parts[-1].ball(math.pi, TURN, 2)
    assert last.rows.zero.all()


def test_numbers_are_read_as_they_are_written() -> None:
    for text in ("0.1", "1e-7", "123456789.123456789", "3.0000000000000000001", "9007199254740993"):
        (step,) = Formula(text).expression.steps
        assert step.value == float(text)
        assert abs(Fraction(text) - Fraction(step.value)) <= Fraction(step.error)
    assert Formula("3").expression.steps[0].error == 0
