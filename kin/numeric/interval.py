"""Balls: arrays of real intervals kept as midpoint and radius, every rounding covered outwards.

An operation on balls encloses the operation on every choice of numbers inside them; that is what makes a bound
computed with them a proof. A ball that cannot be formed (the logarithm of an interval that reaches zero, an overflow)
has radius infinity and midpoint 0: it says nothing, and is never wrong. Dependencies between operands are not seen, so
`x - x` is an interval about 0 twice as wide as `x`.

Rounding. IEEE double, to nearest: each sum or product is off by at most half an ulp, so `_ULP` (a whole ulp, relative)
of the midpoint is added to the radius, and the few roundings of the radius itself are covered by the factor `_UP`.
numpy's elementary functions are off by less than 4 ulp (its own accuracy tests ask for that); 8 are allowed. A plain
number that is added, multiplied or divided by stands for the real number that it is the nearest double of: half an ulp
of it is allowed for, so 0.1, 13/15 and pi mean what they say. `Ball.exact` takes a double as it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array, Mask


_ULP = 2.0**-52
_UP = 1 + 16 * _ULP
_LIBRARY = 8 * _ULP
_TINY = 1e-300
_TURN = 2 * math.pi
# Maxima of sin, minima of sin, maxima of cos, minima of cos, in turns.
_PEAKS = np.array([0.25, 0.75, 0.0, 0.5])[:, None, None]

_quiet = np.errstate(all="ignore")  # decorator; an operation that fails shows in the radius, see `_ball`


@dataclass(frozen=True, eq=False, slots=True)
class Ball:
    """Intervals [mid - rad, mid + rad], elementwise; `mid` and `rad` of one shape."""

    mid: Array
    rad: Array

    __array_ufunc__: ClassVar[None] = None  # numpy arrays leave mixed operators to this class

    @staticmethod
    def exact(value: float | Array) -> Ball:
        """Return balls of radius 0 about these doubles; a number that is not finite gives radius infinity."""
        mid = np.array(value, dtype=float)
        return _ball(mid, np.where(np.isfinite(mid), 0.0, np.inf))

    @staticmethod
    @_quiet
    def between(lower: Array, upper: Array) -> Ball:
        """Return a ball of [lower, upper], lower <= upper, the ends taken as exact; an end at 0 stays at 0."""
        mid = 0.5 * lower + 0.5 * upper
        rad = np.maximum(upper - mid, mid - lower) * (1 + 2 * _ULP)
        mid = np.where(lower >= 0, np.maximum(mid, rad), np.where(upper <= 0, np.minimum(mid, -rad), mid))
        return _ball(mid, rad)

    def __getitem__(self, key: int | slice) -> Ball:
        return Ball(self.mid[key], self.rad[key])

    @_quiet
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper ends, rounded outwards; exact numbers, and an end at 0, keep their value."""
        lower, upper = self.mid - self.rad, self.mid + self.rad
        pad = np.where(self.rad > 0, _ULP * (np.abs(self.mid) + self.rad), 0.0)
        return np.where(lower == 0, lower, lower - pad), np.where(upper == 0, upper, upper + pad)

    @property
    def magnitude(self) -> Array:
        """Upper bound of the absolute value; 0 exactly where the ball is the number 0."""
        return (np.abs(self.mid) + self.rad) * _UP

    def __neg__(self) -> Ball:
        return Ball(-self.mid, self.rad)

    @_quiet
    def __add__(self, other: Ball | float | Array) -> Ball:
        if not isinstance(other, Ball):
            mid = self.mid + other
            return _ball(mid, self.rad * _UP + _ULP * (np.abs(mid) + np.abs(other)))
        mid = self.mid + other.mid
        return _ball(mid, (self.rad + other.rad) * _UP + _ULP * np.abs(mid))

    __radd__ = __add__

    def __sub__(self, other: Ball | float | Array) -> Ball:
        return self + (-other)

    def __rsub__(self, other: float | Array) -> Ball:
        return -self + other

    @_quiet
    def __mul__(self, other: Ball | float | Array) -> Ball:
        a, r = np.abs(self.mid), self.rad
        if not isinstance(other, Ball):
            mid = self.mid * other
            rad = (r * np.abs(other) + 2 * _ULP * np.abs(mid)) * _UP
            return _ball(mid, rad + _unless_zero(a + r, np.abs(np.asarray(other, dtype=float))))
        b, s = np.abs(other.mid), other.rad
        mid = self.mid * other.mid
        rad = (a * s + r * (b + s) + _ULP * np.abs(mid)) * _UP
        return _ball(mid, rad + _unless_zero(a + r, b + s))

    __rmul__ = __mul__

    @_quiet
    def __truediv__(self, other: Ball | float | Array) -> Ball:
        if isinstance(other, Ball):
            return self * other**-1
        mid = np.divide(self.mid, other)
        rad = (np.divide(self.rad, np.abs(other)) + 2 * _ULP * np.abs(mid)) * _UP
        return _ball(mid, rad + 4 * np.minimum(self.magnitude, _TINY))

    def __rtruediv__(self, other: float | Array) -> Ball:
        return self**-1 * other

    @_quiet
    def __pow__(self, exponent: float | Array) -> Ball:
        """Powers are monotone on each side of 0, so the ends decide; infinite where no real power exists.

        A column (m, 1) of exponents gives a row for each.
        """
        n = np.asarray(exponent, dtype=float)
        lower, upper = self.bounds()
        even, one_side = n % 2 == 0, (lower >= 0) | (upper <= 0)
        exists = np.where(n % 1 == 0, (n >= 0) | (lower > 0) | (upper < 0), lower >= 0)
        low, high = _only(exists, np.power(lower, n)), _only(exists, np.power(upper, n))
        least = np.where(one_side | ~even, np.minimum(low, high), 0.0)
        floor = np.where((lower >= 0) | even, 0.0, -math.inf)
        power = _outward(least, np.maximum(low, high), _LIBRARY, np.minimum(self.magnitude, _TINY), floor)
        if (n == 0).any():
            return Ball(np.where(n == 0, 1.0, power.mid), np.where(n == 0, 0.0, power.rad))
        return power

    def powers(self, count: int) -> Ball:
        """x**0, x**1, ..., x**(count - 1), one a row: shape (count, *shape of x)."""
        exponent = np.arange(count, dtype=float).reshape(count, *(1,) * self.mid.ndim)
        with _fresh():
            magnitude = self.magnitude
            greatest = magnitude**exponent
            rad = np.zeros_like(greatest)
            rad[1:] = (exponent[1:] * self.rad * greatest[:-1] + _LIBRARY * greatest[1:]) * _UP
            rad[1:] += 4 * np.minimum(magnitude, _TINY)
            if count > 1:
                rad[1] = self.rad
            return _ball(self.mid**exponent, rad)

    @property
    def positive(self) -> Mask:
        """Whether every number in the ball is above 0 (n,)."""
        return self.mid > self.rad

    @property
    def negative(self) -> Mask:
        """Whether every number in the ball is below 0 (n,)."""
        return -self.mid > self.rad

    @property
    def zero(self) -> Mask:
        """Whether the ball is the number 0 itself (n,)."""
        return np.logical_not(np.logical_or(self.mid, self.rad))


def _fresh() -> np.errstate:
    return np.errstate(all="ignore")


def _ball(mid: Array, rad: Array) -> Ball:
    """Return the ball, with midpoint 0 and radius infinity where the arithmetic has left the finite numbers."""
    sound = np.isfinite(rad)
    if not sound.all():
        mid, rad = np.where(sound, mid, 0.0), np.where(sound, rad, np.inf)
    return Ball(mid, rad)


def _unless_zero(a: Array, b: Array) -> Array:
    """Cover for the underflow of a product of magnitudes a and b: nothing where one factor is exactly 0."""
    return 16 * np.minimum(np.minimum(a, b), _TINY)


def _only(sound: Mask, value: Array) -> Array:
    return np.where(sound, value, math.nan)


def _outward(
    lower: Array, upper: Array, relative: float, absolute: float | Array = 0.0, floor: float | Array = -math.inf
) -> Ball:
    """Return the ball of [lower, upper], each end computed and off by the given errors; nothing lies below floor."""
    lower = np.maximum(lower - (_error(lower, relative) + absolute), floor)
    return Ball.between(lower, upper + (_error(upper, relative) + absolute))


def _error(value: Array, relative: float) -> Array:
    """Error of a computed value; the least numbers are off by more than any part of themselves, 0 is exact."""
    size = np.abs(value)
    return relative * size + np.minimum(size, _TINY)


def rising(
    function: Callable[[Array], Array],
    x: Ball,
    domain: tuple[float, float] = (-math.inf, math.inf),
    tiny: float = 0.0,
    floor: float = -math.inf,
) -> Ball:
    """Ball that encloses an increasing function, nowhere below `floor`, of every number in the ball x.

    `tiny` is the error of its underflow. The radius is infinite where x is not within `domain`, its two ends included.
    """
    lower, upper = x.bounds()
    with _fresh():
        inside = (lower >= domain[0]) & (upper <= domain[1])
        return _outward(_only(inside, function(lower)), _only(inside, function(upper)), _LIBRARY, tiny, floor)


def sin_cos(x: Ball) -> tuple[Ball, Ball]:
    """Balls (n,) that enclose sin and cos of every number in the ball x (n,), never wider than [-1, 1]."""
    with _fresh():
        ends = np.stack(x.bounds())
        values = np.concatenate((np.sin(ends), np.cos(ends))).reshape(2, 2, -1)
        least, greatest = values.min(axis=1), values.max(axis=1)
        least = np.fmax(least - _error(least, _LIBRARY), -1.0)
        greatest = np.fmin(greatest + _error(greatest, _LIBRARY), 1.0)
        # An extremum lies inside if a whole turn from it does; slack for the rounding of x/2pi.
        turns = ends / _TURN
        slack = 8 * _ULP * (1 + np.abs(turns))
        turns[0] -= slack[0]
        turns[1] += slack[1]
        left, right = (turns - _PEAKS).transpose(1, 0, 2)
        holds = ~(np.ceil(left) > np.floor(right))  # true also where nothing is known
        greatest = np.where(holds[0::2], 1.0, greatest)
        least = np.where(holds[1::2], -1.0, least)
        enclosing = Ball.between(least, greatest)
    return enclosing[0], enclosing[1]


def tan(x: Ball) -> Ball:
    """Ball that encloses tan of every number in the ball; its radius is infinite where the ball may hold a pole."""
    lower, upper = x.bounds()
    with _fresh():
        slack = 8 * _ULP * (1 + np.maximum(np.abs(lower), np.abs(upper)))
        left, right = (lower - slack) / math.pi - 0.5, (upper + slack) / math.pi - 0.5
        clear = np.ceil(left) > np.floor(right)
        return _outward(_only(clear, np.tan(lower)), _only(clear, np.tan(upper)), _LIBRARY)


def exp(x: Ball) -> Ball:
    """Ball that encloses exp of every number in the ball."""
    return rising(np.exp, x, tiny=_TINY, floor=0.0)


def log(x: Ball) -> Ball:
    """Ball that encloses log of every number in the ball.

    Its radius is infinite where the ball is not wholly above 0.
    """
    return rising(np.log, x, (math.ulp(0.0), math.inf))


def sqrt(x: Ball) -> Ball:
    """Ball that encloses the square root of every number in the ball; its radius is infinite where one is below 0."""
    return rising(np.sqrt, x, (0.0, math.inf), floor=0.0)


def cbrt(x: Ball) -> Ball:
    """Ball that encloses the cube root of every number in the ball."""
    return rising(np.cbrt, x)


def asin(x: Ball) -> Ball:
    """Ball that encloses asin of every number in the ball, rad; its radius is infinite where one is outside [-1, 1]."""
    return rising(np.arcsin, x, (-1.0, 1.0))


def acos(x: Ball) -> Ball:
    """Ball that encloses acos of every number in the ball, rad; its radius is infinite where one is outside [-1, 1]."""
    return -rising(lambda a: -np.arccos(a), x, (-1.0, 1.0))


def atan(x: Ball) -> Ball:
    """Ball that encloses atan of every number in the ball, rad."""
    return rising(np.arctan, x)


def sinh(x: Ball) -> Ball:
    """Ball that encloses sinh of every number in the ball."""
    return rising(np.sinh, x)


def cosh(x: Ball) -> Ball:
    """Ball that encloses cosh of every number in the ball."""
    lower, upper = x.bounds()
    with _fresh():
        least = np.where((lower < 0) & (upper > 0), 0.0, np.minimum(np.abs(lower), np.abs(upper)))
        return _outward(np.cosh(least), np.cosh(np.maximum(np.abs(lower), np.abs(upper))), _LIBRARY)


def tanh(x: Ball) -> Ball:
    """Ball that encloses tanh of every number in the ball."""
    return rising(np.tanh, x)


def atan2(y: Ball, x: Ball) -> Ball:
    """Ball that encloses the polar angles, rad, of all points of the box x by y.

    It is [-pi, pi] where the box meets the cut (x <= 0, y = 0).
    """
    (y0, y1), (x0, x1) = y.bounds(), x.bounds()
    with _fresh():
        corners = np.stack([np.arctan2(b, a) for b in (y0, y1) for a in (x0, x1)])
        inside = (x0 > 0) | (y0 > 0) | (y1 < 0)
        least = np.where(inside, corners.min(axis=0), -math.pi)
        greatest = np.where(inside, corners.max(axis=0), math.pi)
    return _outward(least, greatest, _LIBRARY, np.minimum(y.magnitude, _TINY))


def absolute(x: Ball) -> Ball:
    """Ball that encloses the absolute value of every number in the ball."""
    lower, upper = x.bounds()
    return Ball.between(np.maximum(np.maximum(lower, -upper), 0.0), np.maximum(-lower, upper))


def hull(a: Ball, b: Ball) -> Ball:
    """Return a ball that holds both balls, as small as rounding allows."""
    (a0, a1), (b0, b1) = a.bounds(), b.bounds()
    return Ball.between(np.minimum(a0, b0), np.maximum(a1, b1))
