"""Taking an expression apart at its switches: abs, sign, min, max where their sign changes, atan2 at its cut."""

from __future__ import annotations

import math
from bisect import bisect
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from kin.law.formula.expression import ANGLE, Builder, Expression, FormulaError, Instruction
from kin.law.formula.roots import Signs, signs, snap
from kin.numeric.errors import UnsettledError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    # Adds to a builder, on the indices of a switch's arguments, the steps that replace the switch.
    Build = Callable[[Builder, tuple[int, ...]], int]

_SWITCHES = ("abs", "sign", "min", "max", "atan2")


class _Settled(NamedTuple):
    """One switch over an interval: the parameters at which it changes, and what replaces it on each stretch between."""

    changes: tuple[float, ...]
    builds: tuple[Build, ...]


def innermost(expression: Expression) -> list[int]:
    """Return the indices of the steps that are switches with no switch in their arguments; [] if there is none."""
    holding: set[int] = set()
    steps = []
    for place, step in enumerate(expression.steps):
        inner = any(i in holding for i in step.args)
        if step.op in _SWITCHES and not inner:
            steps.append(place)
        if inner or step.op in _SWITCHES:
            holding.add(place)
    return steps


def branches(
    expression: Expression, places: list[int], lower: float, upper: float
) -> tuple[list[float], list[Expression]]:
    """Settle the innermost switches, steps of the indices `places`, over [lower, upper].

    Returns the k parameters inside at which one of them changes, rising, and k + 1 expressions without them. Raises
    FormulaError where the sign that decides cannot be settled.
    """
    settled = {place: _settle(expression, place, lower, upper) for place in places}
    least = snap(lower, upper)
    inside: list[float] = []
    for change in sorted(change for switch in settled.values() for change in switch.changes):
        if not inside or change - inside[-1] > least:
            inside.append(change)
    expressions = []
    for a, b in pairwise((lower, *inside, upper)):
        middle = a + 0.5 * (b - a)
        builds = {place: switch.builds[bisect(switch.changes, middle)] for place, switch in settled.items()}
        builder, steps = _copy(expression, builds)
        expressions.append(builder.expression(steps[-1]))
    return inside, expressions


def _settle(expression: Expression, place: int, lower: float, upper: float) -> _Settled:
    step = expression.steps[place]
    try:
        if step.op == "atan2":
            return _settle_angle(expression, step, lower, upper)
        changes = signs(_deciding(expression, step), lower, upper)
    except UnsettledError as error:
        decider = "the difference of the arguments" if step.op in {"min", "max"} else "the argument"
        at = f"{expression.variables[0]} = {error.at:.12g}"
        raise FormulaError(f"{step.op} cannot be settled: {decider} {error.reason} near {at}", step.column) from None
    return _settled(changes, lambda sign: _case(step, sign))


def _settled(signs: Signs, build: Callable[[int], Build]) -> _Settled:
    return _Settled(signs.changes, tuple(build(sign) for sign in signs.signs))


def _deciding(expression: Expression, step: Instruction) -> Expression:
    """Return the expression whose sign decides: the argument, or the difference of both arguments."""
    builder, places = _copy(expression, {})
    args = tuple(places[i] for i in step.args)
    return builder.expression(builder.apply("sub", args, step.column) if step.op in {"min", "max"} else args[0])


def _case(step: Instruction, sign: int) -> Build:
    """Return what replaces a switch where the deciding expression has the sign `sign`, 1, 0 or -1."""

    def build(builder: Builder, args: tuple[int, ...]) -> int:
        if step.op == "sign":
            return builder.constant(sign, 0.0, step.column)
        if step.op == "abs":
            if sign == 0:
                return builder.constant(0.0, 0.0, step.column)
            return args[0] if sign > 0 else builder.apply("neg", args, step.column)
        return args[0] if (sign >= 0) == (step.op == "max") else args[1]

    return build


def _settle_angle(expression: Expression, step: Instruction, lower: float, upper: float) -> _Settled:
    """Turn atan2 by a quarter where y keeps its sign: for y > 0 it is pi/2 + atan2(-x, y), clear of the cut."""
    builder, places = _copy(expression, {})
    y, x = (builder.expression(places[i]) for i in step.args)
    changes = signs(y, lower, upper)

    def plain(builder: Builder, args: tuple[int, ...]) -> int:
        return builder.apply(ANGLE, args, step.column)

    zeros = [*changes.changes, *([lower] if changes.at_start else []), *([upper] if changes.at_end else [])]
    if 0 in changes.signs or not any(_may_be_left(x, zero) for zero in zeros):
        return _settled(Signs((), (0,), at_start=False, at_end=False), lambda _: plain)

    def turned(sign: int) -> Build:
        def build(builder: Builder, args: tuple[int, ...]) -> int:
            y, x = args
            across = builder.apply("neg", (x if sign > 0 else y,), step.column)
            turn = builder.apply(ANGLE, (across, y) if sign > 0 else (x, across), step.column)
            quarter = builder.constant(sign * math.pi / 2, math.ulp(2.0), step.column)
            return builder.apply("add", (turn, quarter), step.column)

        return build

    return _settled(changes, turned)


def _may_be_left(x: Expression, angle: float) -> bool:
    return not bool(x.ball(angle, angle, 0).rows.positive.all())


def _copy(expression: Expression, builds: Mapping[int, Build]) -> tuple[Builder, list[int]]:
    """Return a builder that holds the expression, steps in `builds` replaced, and the new index of each step."""
    builder = Builder(expression.variables)
    places: list[int] = []
    for i, step in enumerate(expression.steps):
        args = tuple(places[j] for j in step.args)
        places.append(builds[i](builder, args) if i in builds else builder.copy(step, args))
    return builder, places
