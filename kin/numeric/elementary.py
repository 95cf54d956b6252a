"""Jets: truncated Taylor arithmetic on arrays, for exact derivatives; and ball jets, for proved bounds of them.

A `Jet` holds the Taylor coefficients of a function at n points, a `BallJet` holds balls that enclose them over n
intervals. Both take + - * / ** and the functions below, which also work on plain numbers and arrays (as values alone).
No difference quotient anywhere: a function of a jet is the function's own Taylor series at the jet's value, composed
with the rest of the jet (`kin.numeric.taylor`; Griewank and Walther, Evaluating Derivatives, chapter 13).

At a switch (abs_, sign, minimum, maximum exactly at a tie) a jet is that of the right-hand side. Rounding can hide a
tie, so a function with switches is better taken apart first: `kin.law.formula.formula.Formula.pieces`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar, overload

import numpy as np

from kin.numeric import interval
from kin.numeric.arrays import Array
from kin.numeric.interval import Ball
from kin.numeric.jet import BallJet, DomainError, Jet, demand, finite
from kin.numeric.records import dataclass
from kin.numeric.taylor import (
    asin_rows,
    atan_rows,
    cbrt_rows,
    compose,
    compose_balls,
    exp_rows,
    led,
    log_rows,
    power_rows,
    sine_rows,
    sinh_rows,
    tan_rows,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = [
    "Ball", "BallJet", "DomainError", "Elementary", "Jet",
    "abs_", "acos", "asin", "atan", "atan2", "cbrt", "cos", "cosh", "exp", "hypot", "log", "maximum", "minimum",
    "sign", "sin", "sinh", "sqrt", "tan", "tanh",
]  # fmt: skip

Domain = tuple["Callable[[Array], NDArray[np.bool_]]", str]
Number = TypeVar("Number", Jet, BallJet, Array, float)


@dataclass(frozen=True)
class Elementary:
    """An elementary function of one argument, for numbers, arrays, balls, jets and ball jets.

    `point_rows` and `ball_rows` give its Taylor coefficients at x (n,) up to an order, (order + 1, n);
    `domain` says where its value exists, `open_domain` where its derivatives do, each with the words for a DomainError.
    """

    name: str
    point_rows: Callable[[Array, int], Array]
    ball_rows: Callable[[Ball, int], Ball]
    domain: Domain | None = None
    open_domain: Domain | None = None

    @overload
    def __call__(self, x: float) -> float: ...
    @overload
    def __call__(self, x: Array) -> Array: ...
    @overload
    def __call__(self, x: Ball) -> Ball: ...
    @overload
    def __call__(self, x: Jet) -> Jet: ...
    @overload
    def __call__(self, x: BallJet) -> BallJet: ...
    def __call__(self, x: float | Array | Ball | Jet | BallJet) -> float | Array | Ball | Jet | BallJet:
        """Return the function of x, of x's own kind; raise DomainError unless x is a ball or a ball jet."""
        if isinstance(x, BallJet):
            return BallJet.of(compose_balls(self.ball_rows(x.rows[0], x.order), x.rows))
        if isinstance(x, Ball):
            return self.ball_rows(x, 0)[0]
        if not isinstance(x, Jet):
            return _as_value(self(_as_jet(x)), x)
        if self.domain:
            demand(self.domain[0](x.c[0]), self.domain[1])
        if self.open_domain and x.order:
            demand(self.open_domain[0](x.c[0]), self.open_domain[1])
        with np.errstate(all="ignore"):
            return finite(compose(self.point_rows(x.c[0], x.order), x.c), f"overflow in {self.name}")


def _as_jet(x: float | Array) -> Jet:
    return Jet(np.reshape(np.asarray(x, dtype=float), (1, -1)))


@overload
def _as_value(jet: Jet, like: float) -> float: ...
@overload
def _as_value(jet: Jet, like: Array) -> Array: ...
def _as_value(jet: Jet, like: float | Array) -> float | Array:
    return jet.c[0].reshape(like.shape) if isinstance(like, np.ndarray) else float(jet.c[0, 0])


def _ball_sine_rows(x: Ball, order: int) -> Ball:
    return sine_rows(*interval.sin_cos(x), order)


def _ball_cosine_rows(x: Ball, order: int) -> Ball:
    s, c = interval.sin_cos(x)
    return sine_rows(c, -s, order)


sin = Elementary("sin", lambda x, m: sine_rows(np.sin(x), np.cos(x), m), _ball_sine_rows)
cos = Elementary("cos", lambda x, m: sine_rows(np.cos(x), -np.sin(x), m), _ball_cosine_rows)
tan = Elementary("tan", lambda x, m: tan_rows(np.tan(x), 1.0, m), lambda x, m: tan_rows(interval.tan(x), 1.0, m))
asin = Elementary(
    "asin",
    lambda x, m: asin_rows(x, np.arcsin(x), m),
    lambda x, m: asin_rows(x, interval.asin(x), m),
    (lambda x: np.abs(x) <= 1, "asin of a number outside -1 to 1"),
    (lambda x: np.abs(x) < 1, "derivative of asin at -1 or 1"),
)
acos = Elementary(
    "acos",
    lambda x, m: led(-asin_rows(x, x, m), np.arccos(x)),
    lambda x, m: led(-asin_rows(x, x, m), interval.acos(x)),
    (lambda x: np.abs(x) <= 1, "acos of a number outside -1 to 1"),
    (lambda x: np.abs(x) < 1, "derivative of acos at -1 or 1"),
)
atan = Elementary("atan", lambda x, m: atan_rows(x, np.arctan(x), m), lambda x, m: atan_rows(x, interval.atan(x), m))
sinh = Elementary(
    "sinh",
    lambda x, m: sinh_rows(np.sinh(x), np.cosh(x), m),
    lambda x, m: sinh_rows(interval.sinh(x), interval.cosh(x), m),
)
cosh = Elementary(
    "cosh",
    lambda x, m: sinh_rows(np.cosh(x), np.sinh(x), m),
    lambda x, m: sinh_rows(interval.cosh(x), interval.sinh(x), m),
)
tanh = Elementary("tanh", lambda x, m: tan_rows(np.tanh(x), -1.0, m), lambda x, m: tan_rows(interval.tanh(x), -1.0, m))
exp = Elementary("exp", lambda x, m: exp_rows(np.exp(x), m), lambda x, m: exp_rows(interval.exp(x), m))
log = Elementary(
    "log",
    lambda x, m: log_rows(x, np.log(x), m),
    lambda x, m: log_rows(x, interval.log(x), m),
    (lambda x: x > 0, "log of a number that is not positive"),
)
sqrt = Elementary(
    "sqrt",
    lambda x, m: power_rows(x, 0.5, m),
    lambda x, m: led(power_rows(x, 0.5, m), interval.sqrt(x)),
    (lambda x: x >= 0, "sqrt of a negative number"),
    (lambda x: x > 0, "derivative of sqrt at zero"),
)
cbrt = Elementary(
    "cbrt",
    lambda x, m: cbrt_rows(x, np.cbrt(x), m),
    lambda x, m: cbrt_rows(x, interval.cbrt(x), m),
    None,
    (lambda x: x != 0, "derivative of cbrt at zero"),
)


def atan2(y: Number, x: Number) -> Number:
    """Polar angle of the point (x, y), in [-pi, pi]; DomainError at the origin.

    A ball jet that may meet the cut (y = 0, x <= 0), where the angle jumps, is [-pi, pi] with unknown derivatives.
    """
    if isinstance(y, Jet) and isinstance(x, Jet):
        demand((y.c[0] != 0) | (x.c[0] != 0), "atan2 at the origin")
        value = np.arctan2(y.c[0], x.c[0])
        if not y.order:
            return Jet(value[None])
        a, b = y.lower(), x.lower()
        return ((b * y.derivative() - a * x.derivative()) / (a * a + b * b)).integral(value)
    if isinstance(y, BallJet) and isinstance(x, BallJet):
        angle = interval.atan2(y.rows[0], x.rows[0])
        if not y.order:
            return BallJet.of(Ball(angle.mid[None], angle.rad[None]))
        p, q = y.lower(), x.lower()
        angle_jet = ((q * y.derivative() - p * x.derivative()) / (p**2 + q**2)).integral(angle)
        clear = x.rows[0].positive | y.rows[0].positive | y.rows[0].negative
        return _where(clear, angle_jet, _known_to(0, angle_jet, angle))
    return _as_value(atan2(_as_jet(y), _as_jet(x)), y)


def hypot(x: Number, y: Number) -> Number:
    """Length of (x, y); DomainError for a jet with derivatives at the origin, where they do not exist."""
    return sqrt(x**2 + y**2)


def abs_(x: Number) -> Number:
    """Absolute value; a ball jet that may change sign keeps its value and slope enclosed, no more."""
    if isinstance(x, Jet):
        return Jet(x.c * np.where(_side(x.c) < 0, -1.0, 1.0))
    if isinstance(x, BallJet):
        larger = maximum(x, -x)
        value = interval.absolute(x.rows[0])
        larger.mid[0], larger.rad[0] = value.mid, value.rad
        return larger
    return _as_value(abs_(_as_jet(x)), x)


def sign(x: Number) -> Number:
    """-1, 0 or 1 as x is negative, 0 or positive; 0 only where x is 0 to the jet's order."""
    if isinstance(x, Jet):
        return x.constant(_side(x.c))
    if isinstance(x, BallJet):
        row = x.rows[0]
        signs = x.constant(np.where(row.positive, 1.0, np.where(row.negative, -1.0, 0.0)))
        either = Ball(np.zeros_like(row.mid), np.ones_like(row.rad))
        return _where(row.positive | row.negative | x.rows.zero.all(axis=0), signs, _known_to(0, signs, either))
    return _as_value(sign(_as_jet(x)), x)


def maximum(x: Number, y: Number) -> Number:
    """Return the greater of the two; a ball jet that may switch keeps its value and slope enclosed, no more."""
    if isinstance(x, Jet) and isinstance(y, Jet):
        return Jet(np.where(_side(x.c - y.c) < 0, y.c, x.c))
    if isinstance(x, BallJet) and isinstance(y, BallJet):
        apart = x.rows - y.rows
        chosen = _where(apart[0].negative, y, x)
        decided = apart[0].positive | apart[0].negative | apart.zero.all(axis=0)
        if decided.all():
            return chosen
        (a, b), (c, d) = x.rows[0].bounds(), y.rows[0].bounds()
        values = Ball.between(np.maximum(a, c), np.maximum(b, d))
        corner = BallJet.of(interval.hull(x.rows, y.rows))
        return _where(decided, chosen, _known_to(1, corner, values))
    return _as_value(maximum(_as_jet(x), _as_jet(y)), x)


def minimum(x: Number, y: Number) -> Number:
    """Return the lesser of the two; a ball jet that may switch keeps its value and slope enclosed, no more."""
    return -maximum(-x, -y)


def _side(c: Array) -> Array:
    """Sign of the first coefficient that is not 0, hence of the function just to the right; 0 if there is none."""
    signs = np.sign(c)
    first: Array = np.take_along_axis(signs, np.argmax(signs != 0, axis=0)[None], axis=0)[0]
    return first


def _where(condition: NDArray[np.bool_], x: BallJet, y: BallJet) -> BallJet:
    return BallJet(np.where(condition, x.mid, y.mid), np.where(condition, x.rad, y.rad))


def _known_to(order: int, x: BallJet, value: Ball) -> BallJet:
    """Return the given value, x's derivatives up to an order, and nothing known beyond."""
    mid, rad = x.mid.copy(), x.rad.copy()
    mid[0], rad[0] = value.mid, value.rad
    mid[order + 1 :], rad[order + 1 :] = 0.0, np.inf
    return BallJet(mid, rad)
