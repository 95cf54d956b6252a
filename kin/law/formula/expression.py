"""Expressions: a formula as a list of instructions, run on jets, ball jets or numbers; never evaluated as code.

Equal sub-expressions are one instruction, run once. Constant sub-expressions are folded as they are met, with a bound
of their error: a ball jet encloses the formula as it is written, `0.1` and `pi` and `sqrt(2)/7` included. Only an
exponent is rounded to the nearest double.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from kin.numeric import elementary
from kin.numeric.elementary import BallJet, DomainError, Jet
from kin.numeric.errors import CamgeoError
from kin.numeric.interval import Ball
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array

Series = TypeVar("Series", Jet, BallJet)

FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": elementary.sin,
    "cos": elementary.cos,
    "tan": elementary.tan,
    "asin": elementary.asin,
    "acos": elementary.acos,
    "atan": elementary.atan,
    "atan2": elementary.atan2,
    "sinh": elementary.sinh,
    "cosh": elementary.cosh,
    "tanh": elementary.tanh,
    "exp": elementary.exp,
    "log": elementary.log,
    "sqrt": elementary.sqrt,
    "cbrt": elementary.cbrt,
    "hypot": elementary.hypot,
    "abs": elementary.abs_,
    "sign": elementary.sign,
    "min": elementary.minimum,
    "max": elementary.maximum,
}
# atan2 whose cut is known not to be met: not a name in formulas, and no switch.
ANGLE = "angle"
_OPERATIONS = {**FUNCTIONS, ANGLE: elementary.atan2}
OF_TWO = ("atan2", "hypot", "min", "max")  # functions of two arguments
GREATEST_EXPONENT = 199
_AHEAD = 1e-3  # of the variable: the stretch over which an expression is proved to be constant
_LIBRARY = 2.0**-49  # relative error allowed to a function of an exact constant


class FormulaError(CamgeoError, ValueError):
    """A fault in a formula: `message`, and the `column` in its text, counted from 0."""

    def __init__(self, message: str, column: int) -> None:
        self.message = message
        self.column = column

    def __str__(self) -> str:
        return self.message


class FormulaDomainError(FormulaError, DomainError):
    """A formula has no value, or no derivative, at a given place: `at` is the value of its first variable there.

    `operation` names what failed; `indices` (k,) are those of the given points at which it failed, `at` the first one.
    """

    def __init__(self, operation: str, indices: NDArray[np.intp], variable: str, place: float, column: int) -> None:
        FormulaError.__init__(self, f"{operation} at {variable} = {place:.12g}", column)
        DomainError.__init__(self, operation, indices)
        self.at = place


@dataclass(frozen=True)
class Instruction:
    """One step: `op` applied to the results of earlier steps `args`; `column`, from 0, is its place in the text.

    `value` is the value of a "constant", the index of a "variable", the exponent of a "pow"; `error` bounds the error
    of a constant.
    """

    op: str
    args: tuple[int, ...]
    value: float
    error: float
    column: int


@dataclass(frozen=True)
class Expression:
    """Instructions, each after its arguments; the last one gives the result.

    Evaluation raises FormulaDomainError where the expression does not exist; for ball jets the enclosure is unbounded
    there instead. TypeError unless there is one argument for each variable.
    """

    steps: tuple[Instruction, ...]
    variables: tuple[str, ...]

    def __call__(self, *arguments: Any) -> Any:  # noqa: ANN401 -- the kind that came in, see `on`
        """Value at numbers or arrays that broadcast, or series of jets or ball jets; one argument for each variable."""
        if isinstance(arguments[0], Jet | BallJet):
            return self.on(*arguments)
        values = np.broadcast_arrays(*(np.asarray(argument, dtype=float) for argument in arguments))
        result = self.on(*(Jet(value.reshape(1, -1)) for value in values)).c[0].reshape(values[0].shape)
        return result if any(isinstance(argument, np.ndarray) for argument in arguments) else float(result)

    def jet(self, t: float | Array, order: int) -> Jet:
        """Taylor coefficients, (order + 1, n), as a jet at t (n,)."""
        return self.on(Jet.variable(t, order))

    def ball(self, lower: float | Array, upper: float | Array, order: int) -> BallJet:
        """Return proved enclosures of the Taylor coefficients up to an order over the intervals [lower, upper] (n,)."""
        return self.on(BallJet.variable(lower, upper, order))

    def constant_value(self, start: float) -> float | None:
        """Value of the expression of one variable if it is constant from `start` to 0.001 beyond; else None."""
        if self.jet(start, 1).c[1].any():
            return None
        enclosed = self.ball(start, start + _AHEAD, 1)
        return None if enclosed.mid[1].any() or enclosed.rad[1].any() else float(enclosed.mid[0, 0])

    def on(self, *series: Series) -> Series:
        """Apply to jets or ball jets, one for each variable.

        Raises FormulaDomainError where the formula has no value or no derivative, TypeError for another number of
        series.
        """
        if len(series) != len(self.variables):
            raise TypeError(f"the formula is in {', '.join(self.variables)}; {len(series)} series were given")
        model = series[0]
        values: list[Any] = []  # of each step: a series, or for a constant a number or ball
        for step in self.steps:
            if step.op == "constant":
                values.append(step.value if isinstance(model, Jet) else _ball_of(step))
            elif step.op == "variable":
                values.append(series[int(step.value)])
            else:
                try:
                    values.append(_apply(step, [values[i] for i in step.args], model))
                except DomainError as error:
                    at = float(model.c[0, error.indices[0]]) if isinstance(model, Jet) else math.nan
                    raise FormulaDomainError(
                        error.operation, error.indices, self.variables[0], at, step.column
                    ) from None
        result = values[-1]
        return result if isinstance(result, type(model)) else model.constant(result)


def _ball_of(step: Instruction) -> Ball:
    return Ball(np.array([step.value]), np.array([step.error]))


def _apply(step: Instruction, args: list[Any], model: Series) -> Series:
    """Run one instruction that is neither a constant nor a variable; at least one argument is a series."""
    kind = type(model)
    first = args[0]
    result: Series
    match step.op:
        case "neg":
            result = -first
        case "pow":
            result = first**step.value
        case "add" | "mul":
            a, b = args if isinstance(first, kind) else args[::-1]
            result = a + b if step.op == "add" else a * b
        case "sub":
            result = first - args[1] if isinstance(first, kind) else -args[1] + first
        case "div":
            result = first / args[1] if isinstance(first, kind) else args[1].__rtruediv__(first)
        case "power":
            whole = [a if isinstance(a, kind) else model.constant(a) for a in args]
            result = whole[0] ** whole[1]
        case _:
            result = _OPERATIONS[step.op](*(a if isinstance(a, kind) else model.constant(a) for a in args))
    return result


class Builder:
    """Collects instructions for one expression; equal ones are kept once, constants are folded."""

    def __init__(self, variables: Iterable[str]) -> None:
        self.variables = tuple(variables)
        self._steps: list[Instruction] = []
        self._known: dict[tuple[str, tuple[int, ...], float, float], int] = {}

    def constant(self, value: float, error: float, column: int) -> int:
        """Add a constant known to within `error`, and give its index; `column`, from 0, is its place in the text."""
        return self._place(Instruction("constant", (), value, error, column))

    def variable(self, index: int, column: int) -> int:
        """Add the instruction that reads variable `index`, and give its index among the instructions.

        `column`, from 0, is its place in the text, for messages.
        """
        return self._place(Instruction("variable", (), index, 0.0, column))

    def apply(self, op: str, args: tuple[int, ...], column: int) -> int:
        """Add an operation on earlier instructions, by their indices `args`, and give its index; constants are folded.

        `column`, from 0, is its place in the text. Raises FormulaError for a constant that does not exist and for an
        exponent out of bounds.
        """
        steps = [self._steps[i] for i in args]
        if op == "power" and steps[1].op == "constant":
            exponent = steps[1].value
            if abs(exponent) > GREATEST_EXPONENT:
                bounds = f"-{GREATEST_EXPONENT} to {GREATEST_EXPONENT}"
                raise FormulaError(f"the exponent {exponent:.6g} is too large; exponents run from {bounds}", column)
            if exponent == 1:
                return args[0]
            return self._fold(Instruction("pow", args[:1], exponent, 0.0, column))
        return self._reduce(Instruction(op, args, 0.0, 0.0, column))

    def copy(self, step: Instruction, args: tuple[int, ...]) -> int:
        """Add another expression's instruction on arguments `args` of this builder, folded anew, and give its index.

        Raises FormulaError for a constant that does not exist.
        """
        if step.op in {"constant", "variable"}:
            return self._place(step)
        return self._reduce(Instruction(step.op, args, step.value, step.error, step.column))

    def expression(self, result: int) -> Expression:
        """Return the expression that ends in the step of index `result`, with the steps that it needs and no more."""
        needed = {result}
        for i in range(result, -1, -1):
            if i in needed:
                needed.update(self._steps[i].args)
        order = {old: new for new, old in enumerate(sorted(needed))}
        steps = tuple(
            Instruction(s.op, tuple(order[i] for i in s.args), s.value, s.error, s.column)
            for s in (self._steps[i] for i in order)
        )
        return Expression(steps, self.variables)

    def _place(self, step: Instruction) -> int:
        key = (step.op, step.args, step.value, step.error)
        if key not in self._known:
            self._known[key] = len(self._steps)
            self._steps.append(step)
        return self._known[key]

    def _reduce(self, step: Instruction) -> int:
        if step.op == "div" and self._steps[step.args[1]].op == "constant" and self._steps[step.args[1]].value == 0:
            raise FormulaError("division by zero", step.column)
        if step.op in {"min", "max"} and step.args[0] == step.args[1]:
            return step.args[0]
        if step.op == "sub" and step.args[0] == step.args[1]:  # exactly 0, but only where x has a value
            step = Instruction("mul", (step.args[0], self.constant(0.0, 0.0, step.column)), 0.0, 0.0, step.column)
        return self._fold(step)

    def _fold(self, step: Instruction) -> int:
        steps = [self._steps[i] for i in step.args]
        if any(s.op != "constant" for s in steps):
            return self._place(step)
        point, balls = Jet(np.zeros((1, 1))), BallJet(np.zeros((1, 1)), np.zeros((1, 1)))
        try:
            value = float(_apply(step, [point.constant(s.value) for s in steps], point).c[0, 0])
        except DomainError as error:
            raise FormulaError(error.operation, step.column) from None
        if step.op in _OPERATIONS and all(s.error == 0 for s in steps):
            error_bound = _LIBRARY * abs(value) + (1e-300 if value else 0.0)
        else:
            constant = _apply(step, [balls.constant(_ball_of(s)) for s in steps], balls)
            error_bound = float(constant.rad[0, 0] + abs(value - constant.mid[0, 0])) * (1 + 1e-15)
        return self._place(Instruction("constant", (), value, error_bound, step.column))
