"""Taking an expression apart at a switch: abs, sign, min, max at the zeros of what decides, atan2 at its cut."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kin.expression import ANGLE, Builder, Expression, FormulaError, Instruction
from kin.roots import UnsettledError, signs

if TYPE_CHECKING:
    from collections.abc import Callable

SWITCHES = ("abs", "sign", "min", "max", "atan2")


@dataclass(frozen=True)
class Branches:
    """The expressions that take a switch's place over an interval, and the parameters `inside` it between them.

    `at_start` and `at_end` say that the switch also lies on the interval's ends.
    """

    inside: tuple[float, ...]
    expressions: tuple[Expression, ...]
    at_start: bool
    at_end: bool


def settle(expression: Expression, place: int, lower: float, upper: float) -> Branches:
    """Return the branches over [lower, upper] of the switch at a place whose arguments hold no switch themselves.

    Raises FormulaError where the sign that decides cannot be settled.
    """
    step = expression.steps[place]
    try:
        if step.op == "atan2":
            return _settle_angle(expression, place, lower, upper)
        found = signs(_deciding(expression, place), lower, upper)
    except UnsettledError as error:
        what = "the difference of the arguments" if step.op in {"min", "max"} else "the argument"
        message = f"{step.op} cannot be settled: {what} {error.reason} near {_at(expression, error)}"
        raise FormulaError(message, step.column) from None
    expressions = tuple(_replaced(expression, place, _case(step, sign)) for sign in found.signs)
    return Branches(found.changes, expressions, found.at_start, found.at_end)


def _at(expression: Expression, error: UnsettledError) -> str:
    return f"{expression.variables[0]} = {error.at:.12g}"


def _deciding(expression: Expression, place: int) -> Expression:
    """Return what is compared with 0: the argument, or the difference of two."""
    args = expression.steps[place].args
    builder, places = _copied(expression, place)
    if expression.steps[place].op in {"min", "max"}:
        return builder.expression(builder.apply("sub", (places[args[0]], places[args[1]]), 0))
    return builder.expression(places[args[0]])


def _settle_angle(expression: Expression, place: int, lower: float, upper: float) -> Branches:
    """Turn by a quarter where y keeps its sign: atan2(y, x) = pi/2 + atan2(-x, y) for y > 0, the cut out of reach."""
    column = expression.steps[place].column
    y, x = (_argument(expression, i) for i in expression.steps[place].args)
    found = signs(y, lower, upper)
    zeros = [*found.changes, *([lower] if found.at_start else []), *([upper] if found.at_end else [])]
    if 0 in found.signs or not any(_may_be_left(x, zero) for zero in zeros):
        plain = _replaced(expression, place, lambda builder, args: builder.apply(ANGLE, args, column))
        return Branches((), (plain,), at_start=False, at_end=False)

    def turned(sign: int) -> Expression:
        def build(builder: Builder, args: tuple[int, ...]) -> int:
            y, x = args
            across = builder.apply("neg", (x if sign > 0 else y,), column)
            turn = builder.apply(ANGLE, (across, y) if sign > 0 else (x, across), column)
            return builder.apply("add", (turn, builder.constant(sign * math.pi / 2, math.ulp(2.0), column)), column)

        return _replaced(expression, place, build)

    return Branches(found.changes, tuple(turned(sign) for sign in found.signs), found.at_start, found.at_end)


def _may_be_left(x: Expression, at: float) -> bool:
    return not bool(x.ball(at, at, 0).rows.positive.all())


def _argument(expression: Expression, place: int) -> Expression:
    builder, places = _copied(expression, place + 1)
    return builder.expression(places[place])


def _case(step: Instruction, sign: int) -> Callable[[Builder, tuple[int, ...]], int]:
    """How to build what a switch amounts to where the deciding expression has a sign."""

    def build(builder: Builder, args: tuple[int, ...]) -> int:
        if step.op == "sign":
            return builder.constant(sign, 0.0, step.column)
        if step.op == "abs":
            if sign == 0:
                return builder.constant(0.0, 0.0, step.column)
            return args[0] if sign > 0 else builder.apply("neg", args, step.column)
        return args[0] if (sign >= 0) == (step.op == "max") else args[1]

    return build


def _copied(expression: Expression, count: int) -> tuple[Builder, list[int]]:
    """Return a builder with the first steps of an expression, and their places in it."""
    builder = Builder(expression.variables)
    places: list[int] = []
    for step in expression.steps[:count]:
        places.append(builder.copy(step, tuple(places[i] for i in step.args)))
    return builder, places


def _replaced(expression: Expression, place: int, build: Callable[[Builder, tuple[int, ...]], int]) -> Expression:
    """Return the expression with one step built otherwise."""
    builder, places = _copied(expression, place)
    places.append(build(builder, tuple(places[i] for i in expression.steps[place].args)))
    for step in expression.steps[place + 1 :]:
        places.append(builder.copy(step, tuple(places[i] for i in step.args)))
    return builder.expression(places[-1])
