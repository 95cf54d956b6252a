"""Support functions that are trigonometric polynomials, found from how they are written: exactly, with error bounds.

A recipe's formula is worked out in the algebra of trigonometric polynomials, whose sums, products and whole powers are
such polynomials again, cos and sin of a multiple of t being the first of them. Nothing is sampled: a formula that has
anything else in it is refused with the place, even if its values happened to be those of a polynomial.
"""

from __future__ import annotations

import cmath
import math
from fractions import Fraction
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from camgeo.curve.support import SupportShape
from camgeo.fit.bound import FormError
from kin.law.formula.expression import Expression
from kin.law.segment import Harmonics, Round
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve
    from kin.law.formula.expression import Instruction
    from kin.law.segment import Stretch
    from kin.numeric.arrays import Array

UNIT = 2.0**-53  # of rounding
WIDEST_DENOMINATOR = 64  # of a frequency inside a formula, such as the 3/2 of cos(3*t/2)**2
MOST_TERMS = 2000  # within a formula; one with more is of no use as a spline
MOST_PRODUCTS = 100_000  # of harmonics, in one product of a formula: about a second


@runtime_checkable
class _Moved(Protocol):
    """A function seen from another shaft: scale f - x cos t - y sin t."""

    function: Stretch
    scale: float
    x: float
    y: float
    offset: float


@dataclass(frozen=True)
class Polynomial:
    """p = sum over k of c_k exp(i k t), k from -n to n, by c_0 .. c_n (n + 1,): c_-k is the conjugate of c_k.

    `error` (n + 1,) bounds how far each coefficient may be off; `rest` how far what was left out moves the contour, mm.
    `dropped` are the harmonics among that which are surely there.
    """

    coefficients: NDArray[np.complex128]
    error: Array
    rest: float = 0.0
    dropped: tuple[int, ...] = ()

    @property
    def order(self) -> int:
        """Highest harmonic n."""
        return len(self.coefficients) - 1

    @staticmethod
    def of_waves(mean: float, waves: list[tuple[int, float, float]]) -> Polynomial:
        """Polynomial mean + sum of a cos k t + b sin k t, exact."""
        order = max([0, *(k for k, _, _ in waves)])
        c = np.zeros(order + 1, dtype=np.complex128)
        c[0] = mean
        for k, a, b in waves:
            c[k] += 0.5 * complex(a, -b)
        return Polynomial(c, np.zeros(order + 1))

    def moved(self, scale: float, x: float, y: float) -> Polynomial:
        """Scale p and see it from a shaft at (x, y): less x cos t + y sin t (AS 10)."""
        c = np.zeros(max(2, len(self.coefficients)), dtype=np.complex128)
        error = np.zeros(len(c))
        c[: self.order + 1] = scale * self.coefficients
        error[: self.order + 1] = abs(scale) * self.error + 2.0 * UNIT * np.abs(c[: self.order + 1])
        c[1] -= 0.5 * complex(x, -y)
        error[1] += 2.0 * UNIT * (abs(c[1]) + math.hypot(x, y))
        return Polynomial(c, error, abs(scale) * self.rest)

    def raised(self, offset: float) -> Polynomial:
        """Add a constant to p: that of a parallel curve."""
        if offset == 0.0:
            return self
        c, error = self.coefficients.copy(), self.error.copy()
        c[0] += offset
        error[0] += 2.0 * UNIT * (abs(c[0]) + abs(offset))
        return Polynomial(c, error, self.rest)

    def trimmed(self) -> Polynomial:
        """Leave out the highest harmonics as long as they may be nothing but rounding: they go into `rest`.

        So do those that all together move the contour by less than a unit of rounding of its size.
        """
        n, rest, dropped = self.order, self.rest, self.dropped
        # of c and its conjugate, with the factors 1 - k and 1 + k of the contour
        moves = 2.0 * np.arange(n + 1) * (np.abs(self.coefficients) + self.error)
        spare = UNIT * float(np.abs(self.coefficients).max())
        while n > 0 and (abs(self.coefficients[n]) <= self.error[n] or moves[n] <= spare):
            if abs(self.coefficients[n]) > self.error[n]:
                spare -= float(moves[n])
                dropped = (n, *dropped)
            rest += float(moves[n])
            n -= 1
        return Polynomial(self.coefficients[: n + 1], self.error[: n + 1], rest, dropped)


def polynomial_of(curve: Curve) -> Polynomial:
    """Support function of a contour as a trigonometric polynomial.

    Raises FormError, with the reason, where it is none or is not written as one.
    """
    shape = curve.shape
    if not isinstance(shape, SupportShape):
        raise FormError("the contour is not given by a support function")
    if not curve.closed:
        raise FormError("the contour has corners")
    functions = shape.lift.law.functions
    if len(functions) > 1:
        raise FormError(f"the support function is pieced together from {len(functions)} stretches")
    return _of(functions[0]).trimmed()


def _of(function: Stretch) -> Polynomial:
    if isinstance(function, _Moved):
        return _of(function.function).moved(function.scale, function.x, function.y).raised(function.offset)
    if isinstance(function, Harmonics):
        return Polynomial.of_waves(function.mean, list(function.terms))
    if isinstance(function, Expression):
        return _of_expression(function)
    if isinstance(function, Round):
        mean, x, y = function.first_harmonic
        circle = Polynomial.of_waves(mean, [(1, x, y)])
        return replace(circle, error=4.0 * UNIT * np.abs(circle.coefficients))  # a formula may have come to this
    raise FormError("the support function is a motion law")


@dataclass(frozen=True)
class _Number:
    """A coefficient known to within `error`."""

    value: complex
    error: float = 0.0

    def __add__(self, other: _Number) -> _Number:
        value = self.value + other.value
        return _Number(value, self.error + other.error + 2.0 * UNIT * abs(value))

    def __mul__(self, other: _Number) -> _Number:
        if _ONE in (self, other):  # t times a whole number is that number, exactly
            return other if self == _ONE else self
        value = self.value * other.value
        spread = self.error * (abs(other.value) + other.error) + abs(self.value) * other.error
        return _Number(value, (spread + 4.0 * UNIT * abs(value)) * (1.0 + 8.0 * UNIT))

    def inverse(self) -> _Number:
        """1 over a real number that is surely not 0."""
        low = abs(self.value) - self.error
        if not low > 0.0:
            raise ZeroDivisionError
        value = 1.0 / self.value
        return _Number(value, self.error / (low * abs(self.value)) * (1.0 + 8.0 * UNIT) + 2.0 * UNIT * abs(value))


Waves = dict[Fraction, _Number]
"""Sum of c exp(i f t) over frequencies f."""


@dataclass(frozen=True)
class _Angle:
    """slope t + offset, as it stands within cos and sin."""

    slope: _Number
    offset: _Number


_ONE, _MINUS = _Number(1.0), _Number(-1.0)


def _of_expression(expression: Expression) -> Polynomial:
    values: list[Waves | _Angle] = []
    for step in expression.steps:
        values.append(_apply(step, [values[i] for i in step.args]))
    result = values[-1]
    if isinstance(result, _Angle):
        raise FormError("the formula has t outside cos and sin")
    if any(f.denominator > 1 for f, c in result.items() if abs(c.value) > c.error):
        raise FormError("the formula has a harmonic that is not a whole number")
    order = max(int(abs(f)) for f in result)
    c, error, rest = np.zeros(order + 1, dtype=np.complex128), np.zeros(order + 1), 0.0
    for f, number in result.items():
        if f.denominator > 1:
            rest += float(abs(f) + 1) * (abs(number.value) + number.error)
        elif f >= 0:
            c[int(f)], error[int(f)] = number.value, number.error
    c[0] = c[0].real
    return Polynomial(c, error, rest)


def _apply(step: Instruction, args: list[Waves | _Angle]) -> Waves | _Angle:
    """Run one instruction of a formula in the algebra of trigonometric polynomials and of angles."""
    if step.op == "constant":
        return {Fraction(0): _Number(step.value, step.error)}
    if step.op == "variable":
        return _Angle(_Number(1.0), _Number(0.0))
    first = args[0]
    if step.op in {"cos", "sin"}:
        if isinstance(first, _Angle):
            return _wave(first, sine=step.op == "sin")
        raise FormError(f"{step.op} of something other than a multiple of t{_at(step)}")
    if step.op == "neg":
        return _scaled(first, _MINUS)
    if step.op in {"add", "sub"}:
        second = args[1] if step.op == "add" else _scaled(args[1], _MINUS)
        return _sum(first, second, step)
    if step.op == "mul":
        return _product(first, args[1], step)
    if step.op == "div":
        divisor = _constant(args[1])
        if divisor is None:
            raise FormError(f"division by something other than a number{_at(step)}")
        return _scaled(first, divisor.inverse())
    if step.op == "pow" and step.value == int(step.value) and step.value >= 0 and not isinstance(first, _Angle):
        return _power(first, int(step.value), step)
    what = "power" if step.op in {"pow", "power"} else step.op
    raise FormError(f"{what} is not an operation on trigonometric polynomials{_at(step)}")


def _at(step: Instruction) -> str:
    return f" (character {step.column + 1} of the formula)"


def _constant(value: Waves | _Angle) -> _Number | None:
    if isinstance(value, dict) and set(value) == {Fraction(0)}:
        return value[Fraction(0)]
    return None


def _scaled(value: Waves | _Angle, factor: _Number) -> Waves | _Angle:
    if isinstance(value, _Angle):
        return _Angle(value.slope * factor, value.offset * factor)
    return {f: c * factor for f, c in value.items()}


def _sum(first: Waves | _Angle, second: Waves | _Angle, step: Instruction) -> Waves | _Angle:
    if isinstance(first, _Angle) and isinstance(second, _Angle):
        return _Angle(first.slope + second.slope, first.offset + second.offset)
    if isinstance(first, _Angle) or isinstance(second, _Angle):
        angle, other = (first, second) if isinstance(first, _Angle) else (second, first)
        number = _constant(other)
        if number is None or not isinstance(angle, _Angle):
            raise FormError(f"t stands outside cos and sin{_at(step)}")
        return _Angle(angle.slope, angle.offset + number)
    out = dict(first)
    for f, c in second.items():
        out[f] = out[f] + c if f in out else c
    return out


def _product(first: Waves | _Angle, second: Waves | _Angle, step: Instruction) -> Waves | _Angle:
    if isinstance(first, _Angle) or isinstance(second, _Angle):
        angle, other = (first, second) if isinstance(first, _Angle) else (second, first)
        number = _constant(other)
        if number is None:
            raise FormError(f"t stands outside cos and sin{_at(step)}")
        return _scaled(angle, number)
    if len(first) * len(second) > MOST_PRODUCTS:
        raise FormError(f"a product of sums of {len(first)} and {len(second)} harmonics{_at(step)} is too long")
    out: Waves = {}
    for f, a in first.items():
        for g, b in second.items():
            out[f + g] = out[f + g] + a * b if f + g in out else a * b
    if len(out) > MOST_TERMS:
        raise FormError(f"more than {MOST_TERMS} harmonics{_at(step)}")
    return out


def _power(base: Waves, exponent: int, step: Instruction) -> Waves:
    result: Waves = {Fraction(0): _Number(1.0)}
    for bit in f"{exponent:b}":
        for factor in (result, base) if bit == "1" else (result,):
            found = _product(result, factor, step)
            assert isinstance(found, dict)
            result = found
    return result


def _wave(angle: _Angle, *, sine: bool) -> Waves:
    """Give cos or sin of an angle: (exp(i a) + exp(-i a))/2 or (exp(i a) - exp(-i a))/2i."""
    slope = angle.slope.value.real
    frequency = Fraction(slope).limit_denominator(WIDEST_DENOMINATOR)
    # p closes over a turn, which it only does if a frequency written as 0.1 or 1/3 is that number
    if abs(float(frequency) - slope) > angle.slope.error + 2.0 * UNIT * abs(slope):
        raise FormError(f"the formula has the frequency {slope:.9g}, which does not close over a turn")
    turned = cmath.exp(1j * angle.offset.value.real)
    # what the frequency may be off is 2 pi times as much at the end of a turn, and once more in the derivative; twice
    # that, as the contour takes a harmonic and its derivative
    drift = abs(float(frequency) - slope) + angle.slope.error
    spread = angle.offset.error + 4.0 * UNIT + 2.0 * (2.0 * math.pi + 1.0) * drift
    half = _Number(-0.5j * turned if sine else 0.5 * turned, 0.5 * spread)
    other = _Number(half.value.conjugate(), half.error)
    if frequency == 0:
        return {frequency: half + other}
    return {frequency: half, -frequency: other}
