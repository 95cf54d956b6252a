"""Closing a loop of links: triangles of two fixed sides and one that varies, their limits, and their derivatives.

Limit positions are where a square root vanishes. The value under the root is computed so that its sign is right, by
exact arithmetic where rounding leaves it in doubt; and angles are differentiated implicitly, root times rate =
rate of the given length, so that nothing is divided by the difference of two roundings.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.numeric.arrays import Array
from kin.numeric.elementary import Jet, sqrt
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Term = float | Array
Assembly = Literal["open", "crossed"]

# A difference of squares is good to a few roundings of the squares. Less than this part of them it would not be good to
# 1e-10 of itself.
_CLOSE = 2.0**-15
# Nearer to a limit position than this, mm, derivatives would overflow. Doubles of common size do not come so near.
_STILL = 1e-30


class BindingError(CamgeoError, ValueError):
    """A loop that cannot be closed, or whose derivatives are wanted in a limit position.

    `message` says by how much the links miss each other, or that they stand in a limit position; `indices` (k,) are the
    points concerned, out of n.
    """

    def __init__(self, message: str, indices: NDArray[np.intp]) -> None:
        super().__init__(message)
        self.message = message
        self.indices = indices


def demand_mobile(margin: Array, *, order: int, fixed: NDArray[np.bool_] | None = None) -> None:
    """Raise BindingError where the margin (n,), mm, is negative, or is 0 and the order is above 0.

    `order` is the number of derivatives wanted; `fixed` (n,) marks points without a direction, refused to any order.
    """
    bound = margin < 0 if order == 0 else margin <= _STILL
    if fixed is not None:
        bound = bound | fixed
    if bound.any():
        indices = np.flatnonzero(bound)
        least = float(margin[indices].min())
        if least < 0:
            what = f"the links do not reach each other by {-least:.6g} mm"
        else:
            what = "the links stand in a limit position, where the loop has no derivative"
        raise BindingError(what, indices)


def total(*terms: Term) -> Array:
    """Sum of numbers or arrays (n,), compensated: good to an ulp unless it nearly vanishes (Knuth's sum of two)."""
    value: Term = terms[0]  # plain numbers stay so until an array comes
    lost: Term = 0.0
    for term in terms[1:]:
        longer = value + term
        share = longer - value
        lost = lost + ((value - (longer - share)) + (term - share))
        value = longer
    return np.asarray(value + lost)


def excess(x: Sequence[Term], y: Sequence[Term], z: Sequence[Term]) -> Array:
    """x^2 + y^2 - z^2 (n,), each of the three the sum of its terms, numbers or (n,); its sign is right.

    With terms of z in columns (k, 1) the result is (k, n). x^2 - z^2 is taken as a product; where little is left of the
    squares, the sum is formed in rational arithmetic.
    """
    a, b, c = total(*x), total(*y), total(*z)
    value = np.atleast_1d(total(*x, *(-term for term in z)) * total(*x, *z) + b * b)
    for i in zip(*np.nonzero(np.abs(value) <= _CLOSE * np.atleast_1d(a * a + b * b + c * c)), strict=True):
        squares = [sum(Fraction(float(np.broadcast_to(t, value.shape)[i])) for t in terms) ** 2 for terms in (x, y, z)]
        value[i] = float(squares[0] + squares[1] - squares[2])
    return value


def excesses(x: Sequence[Term], y: Sequence[Term], a: float, b: float) -> tuple[Array, Array]:
    """x^2 + y^2 - (a - b)^2 and (a + b)^2 - x^2 - y^2, (n,) each, without cancellation; their signs are right."""
    value = excess(x, y, (a, np.array([[-b], [b]])))
    return value[0], -value[1]


def with_value(jet: Jet, value: Array) -> Jet:
    """Return the jet with its value (n,) replaced by a better one."""
    c = jet.c.copy()
    c[0] = value
    return Jet(c)


@dataclass(frozen=True, eq=False)
class Vector:
    """A vector of jets, mm, whose values are the sums of the given terms."""

    x: Jet
    y: Jet
    x_terms: Sequence[Term]
    y_terms: Sequence[Term]

    @staticmethod
    def of(x: Jet, y: Jet, x_terms: Sequence[Term], y_terms: Sequence[Term]) -> Vector:
        """Make the vector whose derivatives are those of x and y, and whose values are the sums."""
        return Vector(with_value(x, total(*x_terms)), with_value(y, total(*y_terms)), x_terms, y_terms)

    @cached_property
    def q(self) -> Jet:
        """Squared length of the vector, mm^2."""
        return self.x * self.x + self.y * self.y

    def bearing(self, about: float = 0.0) -> Jet:
        """Polar angle of the vector, rad, within pi of `about`."""
        return bearing(self.x, self.y, self.q, about)


@dataclass(frozen=True, eq=False)
class Triangle:
    """Two fixed sides a, b and a third one of squared length q, varying: its angles and their derivatives.

    `near` is q - (a - b)^2 and `far` (a + b)^2 - q, both positive; `root` is the root of their product: 2 a b times the
    sine of the angle between a and b, and four times the area.
    """

    a: float
    b: float
    q: Jet
    near: Jet
    far: Jet

    @staticmethod
    def of(a: float, b: float, third: Vector) -> Triangle:
        """Make the triangle with the sides a, b, mm, and the vector `third`.

        Raises BindingError where the sides do not close, where they lie in one line and the jets have derivatives, and
        where `third` is 0.
        """
        q = third.q
        near, far = excesses(third.x_terms, third.y_terms, a, b)
        demand_mobile(np.minimum(*triangle_margins(a, b, q.c[0], near, far)), order=q.order, fixed=q.c[0] == 0)
        return Triangle(a, b, q, with_value(q, near), with_value(-q, far))

    @cached_property
    def root(self) -> Jet:
        """Product 2 a b sin(angle between a and b), mm^2."""
        return sqrt(self.near * self.far)

    @cached_property
    def between(self) -> Jet:
        """Angle between a and b, 0 to pi: its rate is q'/root, from q = a^2 + b^2 - 2 a b cos."""
        value = 2 * np.arctan2(np.sqrt(self.near.c[0]), np.sqrt(self.far.c[0]))
        if not self.q.order:
            return Jet(value[None])
        return (self.q.derivative() / self.root.lower()).integral(value)

    @cached_property
    def along(self) -> Jet:
        """Twice a times the projection of the third side on a: q + a^2 - b^2, without cancellation."""
        return self.near + 2 * self.a * (self.a - self.b)

    @cached_property
    def beside(self) -> Jet:
        """Angle between a and the third side, 0 to pi: its rate is b (a cos C - b)/q times the rate of `between`, C."""
        value = np.arctan2(self.root.c[0], self.along.c[0])
        if not self.q.order:
            return Jet(value[None])
        # a^2 - b^2 - q = 2 b (a cos C - b), without cancellation
        factor = (-self.near + 2 * self.b * (self.a - self.b)).lower()
        return (factor * self.between.derivative() / (2.0 * self.q.lower())).integral(value)


def triangle_margins(a: float, b: float, q: Array, near: Array, far: Array) -> Array:
    """Distances of the third side from its limits |a - b| and a + b, mm (2, n), negative out of reach.

    `q` is its square, `near` q - (a - b)^2 and `far` (a + b)^2 - q, mm^2 (n,).
    """
    side, least = np.sqrt(q), abs(a - b)
    with np.errstate(invalid="ignore"):
        inner = np.where(side + least > 0, near / (side + least), 0.0)
    return np.stack([inner, far / (side + (a + b))])


def bearing(x: Jet, y: Jet, q: Jet, about: float = 0.0) -> Jet:
    """Polar angle, rad, of the vector (x, y), mm, of squared length q, within pi of `about`, rad."""
    value = np.arctan2(y.c[0], x.c[0])
    if about:
        value = value - 2 * np.pi * np.round((value - about) / (2 * np.pi))
    if not x.order:
        return Jet(value[None])
    return ((x.lower() * y.derivative() - y.lower() * x.derivative()) / q.lower()).integral(value)


def longer(q: Array, square: Array, offset: float) -> Array:
    """Difference sqrt(q) - |offset|, mm (n,), without cancellation, from `square` = q - offset^2.

    Below 0 the links do not reach each other.
    """
    side = np.sqrt(q) + abs(offset)
    with np.errstate(invalid="ignore"):
        margin: Array = np.where(side > 0, square / side, 0.0)
    return margin


def side_of(assembly: Assembly) -> float:
    """Sign of the root of an assembly: 1 open, -1 crossed."""
    return 1.0 if assembly == "open" else -1.0


def demand_finite(name: str, value: float) -> None:
    """Raise ValueError unless a length of either sign is finite."""
    if not math.isfinite(value):
        raise ValueError(f"the {name} must be finite, not {value!r} mm")


def demand_lengths(assembly: str, **lengths: float) -> None:
    """Raise ValueError unless the assembly has one of its names and the lengths are positive and finite."""
    if assembly not in {"open", "crossed"}:
        raise ValueError(f"the assembly is open or crossed, not {assembly!r}")
    for name, length in lengths.items():
        if not (math.isfinite(length) and length > 0):
            raise ValueError(f"the {name} must be longer than 0, not {length!r} mm")
