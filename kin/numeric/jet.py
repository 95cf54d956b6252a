"""The two kinds of truncated Taylor series: `Jet` at points, `BallJet` over intervals, with their arithmetic."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, TypeVar

import numpy as np

from kin.numeric import interval
from kin.numeric.errors import CamgeoError
from kin.numeric.interval import Ball
from kin.numeric.taylor import (
    ball_product,
    compose,
    compose_balls,
    exp_rows,
    factorials,
    log_rows,
    polynomial_rows,
    power_rows,
    product,
    quotient,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Mask


class DomainError(CamgeoError, ArithmeticError):
    """A jet left the domain of an operation or the finite numbers.

    `operation` names the fault in words; `indices` (k,) are the points of the jet at which it lies.
    """

    def __init__(self, operation: str, indices: NDArray[np.intp]) -> None:
        self.operation = operation
        self.indices = indices

    def __str__(self) -> str:
        return f"{self.operation} (at {len(self.indices)} of the points, first at index {self.indices[0]})"


def demand(sound: NDArray[np.bool_] | np.bool_, operation: str) -> None:
    """Raise DomainError, with the words `operation`, unless all points (n,) are sound."""
    if not sound.all():
        raise DomainError(operation, np.flatnonzero(~sound))


def finite(c: Array, operation: str) -> Jet:
    """Return the jet of these coefficients (order + 1, n); DomainError unless all of them are finite."""
    sound = np.isfinite(c)
    if np.count_nonzero(sound) < c.size:
        demand(sound.all(axis=0), operation)
    return Jet(c)


@dataclass(frozen=True, eq=False, slots=True)
class Jet:
    """Taylor coefficients c (order + 1, n) at n points: the k-th derivative is k! c[k].

    Operations raise DomainError where the result does not exist or is not finite. Plain numbers and arrays (n,) mix in
    as constants.
    """

    c: Array

    __array_ufunc__: ClassVar[None] = None  # numpy arrays leave mixed operators to this class

    @staticmethod
    def variable(t: float | Array, order: int) -> Jet:
        """Return the variable itself at the points t (n,); DomainError for one that is not finite."""
        c = np.zeros((order + 1, np.size(t)))
        c[0] = t
        if order > 0:
            c[1] = 1.0
        return finite(c, "a number that is not finite")

    def constant(self, value: float | Array) -> Jet:
        """Return a constant, of the order and at the points of this jet; DomainError if it is not finite."""
        c = np.zeros_like(self.c)
        c[0] = value
        return finite(c, "a number that is not finite")

    @property
    def order(self) -> int:
        """Highest derivative held."""
        return len(self.c) - 1

    def derivatives(self) -> Array:
        """Return the true derivatives, (order + 1, n)."""
        return self.c * factorials(self.order)

    def derivative(self) -> Jet:
        """Return the derivative, one order less."""
        return Jet(self.c[1:] * np.arange(1.0, self.order + 1)[:, None])

    def lower(self) -> Jet:
        """Return the jet to one order less."""
        return Jet(self.c[:-1])

    def integral(self, start: float | Array) -> Jet:
        """Return the primitive that takes the value start (n,), one order more."""
        c = np.empty((self.order + 2, self.c.shape[1]))
        c[0] = start
        c[1:] = self.c / np.arange(1.0, self.order + 2)[:, None]
        return Jet(c)

    def __neg__(self) -> Jet:
        return Jet(-self.c)

    def __add__(self, other: Jet | float | Array) -> Jet:
        with np.errstate(all="ignore"):
            if isinstance(other, Jet):
                return finite(self.c + other.c, "overflow")
            c = self.c.copy()
            c[0] += other
            return finite(c, "overflow")

    __radd__ = __add__

    def __sub__(self, other: Jet | float | Array) -> Jet:
        return self + (-other)

    def __rsub__(self, other: float | Array) -> Jet:
        return -self + other

    def __mul__(self, other: Jet | float | Array) -> Jet:
        with np.errstate(all="ignore"):
            return finite(product(self.c, other.c) if isinstance(other, Jet) else self.c * other, "overflow")

    __rmul__ = __mul__

    def __truediv__(self, other: Jet | float | Array) -> Jet:
        divisor = other.c[0] if isinstance(other, Jet) else np.broadcast_to(other, self.c[0].shape)
        demand(divisor != 0, "division by zero")
        with np.errstate(all="ignore"):
            c = quotient(self.c, other.c) if isinstance(other, Jet) else self.c / other
            return finite(c, "overflow")

    def __rtruediv__(self, other: float | Array) -> Jet:
        return self.constant(other) / self

    def __pow__(self, exponent: float | Jet) -> Jet:
        x = self.c[0]
        if isinstance(exponent, Jet):
            demand(x > 0, "variable power of a number that is not positive")
            with np.errstate(all="ignore"):
                product_of_log = product(exponent.c, compose(log_rows(x, np.log(x), self.order), self.c))
                return finite(compose(exp_rows(np.exp(product_of_log[0]), self.order), product_of_log), "overflow")
        demand((x != 0) | np.greater_equal(exponent, 0), "division by zero")
        if not float(exponent).is_integer():
            demand(x >= 0, "fractional power of a negative number")
            demand((x > 0) | np.greater(exponent, self.order), "derivative of a fractional power at zero")
        with np.errstate(all="ignore"):
            return finite(compose(power_rows(x, exponent, self.order), self.c), "overflow")

    def __rpow__(self, base: float) -> Jet:
        return self.constant(base) ** self


@dataclass(frozen=True, eq=False, slots=True)
class BallJet:
    """Balls mid +- rad (order + 1, n): row k encloses f^(k)(x)/k! for every x in the n-th interval.

    Nothing raises: where an enclosure cannot be formed, rad is infinite. A plain number stands for the real number
    that it is the nearest double of (`kin.numeric.interval`); arrays (n,) mix in likewise.
    """

    mid: Array
    rad: Array

    __array_ufunc__: ClassVar[None] = None

    @staticmethod
    def variable(lower: float | Array, upper: float | Array, order: int) -> BallJet:
        """Return the variable over the intervals [lower, upper], each (n,); ValueError unless lower <= upper."""
        low, high = np.broadcast_arrays(np.atleast_1d(np.asarray(lower, dtype=float)), np.asarray(upper, dtype=float))
        if not (low <= high).all():
            raise ValueError("an interval ends before it begins, or an end is not a number")
        value = Ball.between(low, high)
        mid, rad = np.zeros((2, order + 1, len(value.mid)))
        mid[0], rad[0] = value.mid, value.rad
        if order > 0:
            mid[1] = 1.0
        return BallJet(mid, rad)

    @staticmethod
    def of(rows: Ball) -> BallJet:
        """Return the ball jet of these coefficients (order + 1, n)."""
        return BallJet(rows.mid, rows.rad)

    def constant(self, value: float | Array | Ball) -> BallJet:
        """Return a constant, of the order and over the intervals of this jet; numbers are taken as exact."""
        ball_value = value if isinstance(value, Ball) else Ball.exact(value)
        mid, rad = np.zeros_like(self.mid), np.zeros_like(self.rad)
        mid[0], rad[0] = ball_value.mid, ball_value.rad
        return BallJet(mid, rad)

    @property
    def order(self) -> int:
        """Highest derivative held."""
        return len(self.mid) - 1

    @property
    def rows(self) -> Ball:
        """The coefficients as one ball array (order + 1, n)."""
        return Ball(self.mid, self.rad)

    def bounds(self) -> tuple[Array, Array]:
        """Return lower and upper bounds of the true derivatives, each (order + 1, n)."""
        return (self.rows * Ball.exact(factorials(self.order))).bounds()

    def derivative(self) -> BallJet:
        """Return the derivative, one order less."""
        return BallJet.of(self.rows[1:] * Ball.exact(np.arange(1.0, self.order + 1)[:, None]))

    def lower(self) -> BallJet:
        """Return the jet to one order less."""
        return BallJet.of(self.rows[:-1])

    def integral(self, start: Ball) -> BallJet:
        """Return the primitive that takes the value start (n,), one order more."""
        rows = self.rows / np.arange(1.0, self.order + 2)[:, None]
        return BallJet(np.vstack((start.mid, rows.mid)), np.vstack((start.rad, rows.rad)))

    def __neg__(self) -> BallJet:
        return BallJet(-self.mid, self.rad)

    def __add__(self, other: BallJet | Ball | float | Array) -> BallJet:
        if isinstance(other, BallJet):
            return BallJet.of(self.rows + other.rows)
        first = self.rows[0] + other
        mid, rad = self.mid.copy(), self.rad.copy()
        mid[0], rad[0] = first.mid, first.rad
        return BallJet(mid, rad)

    __radd__ = __add__

    def __sub__(self, other: BallJet | Ball | float | Array) -> BallJet:
        return self + (-other)

    def __rsub__(self, other: Ball | float | Array) -> BallJet:
        return -self + other

    def __mul__(self, other: BallJet | Ball | float | Array) -> BallJet:
        if isinstance(other, BallJet):
            return BallJet.of(ball_product(self.rows, other.rows))
        return BallJet.of(self.rows * other)

    __rmul__ = __mul__

    def __truediv__(self, other: BallJet | Ball | float | Array) -> BallJet:
        return self * other**-1 if isinstance(other, BallJet) else BallJet.of(self.rows / other)

    def __rtruediv__(self, other: Ball | float | Array) -> BallJet:
        return self**-1 * other

    def __pow__(self, exponent: float | BallJet) -> BallJet:
        x = self.rows[0]
        if isinstance(exponent, BallJet):
            logarithm = compose_balls(log_rows(x, interval.log(x), self.order), self.rows)
            product_of_log = ball_product(exponent.rows, logarithm)
            return BallJet.of(compose_balls(exp_rows(interval.exp(product_of_log[0]), self.order), product_of_log))
        return BallJet.of(compose_balls(power_rows(x, exponent, self.order), self.rows))

    def __rpow__(self, base: Ball | float) -> BallJet:
        return self.constant(base) ** self


Series = TypeVar("Series", Jet, BallJet)


def chosen(first: Mask, one: Series, other: Series) -> Series:
    """Series `one` at the points or intervals where the mask `first` (n,) is true, else `other`."""
    if isinstance(one, Jet) and isinstance(other, Jet):
        return Jet(np.where(first, one.c, other.c))
    return BallJet(np.where(first, one.mid, other.mid), np.where(first, one.rad, other.rad))


def derivatives_by(f: Series, parameter: Series) -> list[Series]:
    """F and its derivatives by another function of the same variable: series of f's order, one less, and so on to 0.

    Jets raise DomainError where the rate of `parameter` is 0 or a result is not finite.
    """
    rows = [f]
    if not f.order:
        return rows
    rate = parameter.derivative()
    if isinstance(rate, BallJet):
        rate = rate**-1  # balls are divided by their inverse, here the same each time
    while f.order:
        f = f.derivative() * rate if isinstance(rate, BallJet) else f.derivative() / rate
        rate = rate.lower()
        rows.append(f)
    return rows


def horner(coefficients: Sequence[float] | Array, x: Series) -> Series:
    """Polynomials of these coefficients (k,) or (k, n), lowest first, at a jet or ball jet.

    Raises DomainError where a jet overflows.
    """
    if isinstance(x, BallJet):
        return BallJet.of(compose_balls(polynomial_rows(coefficients, x.rows[0], x.order), x.rows))
    with np.errstate(all="ignore"):
        total = np.zeros_like(x.c)
        total[0] = coefficients[-1]
        if x.c[2:].any():
            for row in coefficients[-2::-1]:
                total = product(total, x.c)
                total[0] += row
            return finite(total, "overflow")
        # a product has two terms in each row, and the same digits
        value, above, below, carry = total[0], total[1:], total[:-1], np.empty_like(total[1:])
        at, slope = x.c[0], x.c[1:2]
        for row in coefficients[-2::-1]:
            np.multiply(below, slope, out=carry)
            total *= at
            above += carry
            value += row
        return finite(total, "overflow")
