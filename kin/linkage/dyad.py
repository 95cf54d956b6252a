"""Further links: dyads, of two links and three joints each, hung on a point of an earlier link (AS section 4).

A point P of the earlier link drives each dyad: RRR (two bars to a ground pivot G), RRP (a bar to a slide on a fixed
line) and RPR (a block at P in a slotted rocker about G). All are triangles or right triangles, solved and
differentiated as in `kin.linkage.loop`. Angles are counter-clockwise from the x axis.

Of each dyad `on` names the link that carries P: the linkage's output or coupler, or the output link of the previous
dyad; `point` is P in that link's axes, mm. `output_link` is the link that the dyad drives, `driven` the name of that
link, `joints` are those of P, Q and G that it has, and `lengths` are the fields of its links' lengths. For P on the
closed path x, y (n,), the direction of GP is taken about the `middle` of its range, so that the output is continuous on
it, and `turned` is the angle by which that direction turns once round the path, which must be 0. Making a dyad raises
ValueError for another link or assembly, for a number that is not finite and for a length that is not above 0.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

import numpy as np

from kin.linkage.links import Joint, Link, Place, pivot, rocker
from kin.linkage.loop import (
    Assembly,
    BindingError,
    Triangle,
    Vector,
    bearing,
    demand_lengths,
    demand_mobile,
    excess,
    excesses,
    longer,
    side_of,
    triangle_margins,
    with_value,
)
from kin.numeric.elementary import Jet, sqrt
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

__all__ = ["RPR", "RRP", "RRR", "Assembly", "BindingError", "Dyad", "Link", "On", "Reached"]

On = Literal["output", "coupler", "previous"]
Point = tuple[float, float]


class Reached(NamedTuple):
    """A dyad at n points, as jets: its output (rad or mm), and the joint Q that the point P drives (RPR: P itself)."""

    output: Jet
    joint: Place


class _Pivoted:
    """A dyad whose output link turns about the ground pivot G."""

    ground: Point

    def output_link(self, reached: Reached) -> Link:
        """Return the output link, its origin G."""
        return rocker(self.ground, reached.output)

    def middle(self, x: Array, y: Array) -> float:
        """Middle of the range of GP's directions, rad, for P on a path x, y (n,), mm, that does not circle G."""
        directions = np.unwrap(np.arctan2(y - self.ground[1], x - self.ground[0]))
        return float(directions.min() + directions.max()) / 2

    def turned(self, x: Array, y: Array) -> float:
        """Angle, rad, by which GP turns as P runs once round a closed path x, y (n,), mm: 0, or whole turns."""
        x, y = x - self.ground[0], y - self.ground[1]
        steps = np.diff(np.arctan2(y, x), append=math.atan2(y[0], x[0]))
        return float(np.sum(steps - 2 * np.pi * np.round(steps / (2 * np.pi))))


@dataclass(frozen=True)
class RRR(_Pivoted):
    """Bars PQ and QG of the lengths `links`, mm; the output is the angle of GQ.

    Open has Q on the left of the line from G to P, crossed on the right. The output link's origin is G, x towards Q.
    """

    on: On
    point: Point
    ground: Point
    links: tuple[float, float]
    assembly: Assembly = "open"
    unit: ClassVar[str] = "deg"
    lengths: ClassVar[tuple[str, ...]] = ("links[0]", "links[1]")
    driven: ClassVar[str] = "rocker"

    def __post_init__(self) -> None:
        _demand_place(self.on, self.point, self.ground)
        demand_lengths(self.assembly, **{"first link": self.links[0], "second link": self.links[1]})

    def margins(self, x: float | Array, y: float | Array) -> Array:
        """Length GP less the least that the bars span, and the greatest less GP, mm (2, n), for P at x, y (n,).

        A row is negative out of reach.
        """
        a, b = self.links[1], self.links[0]
        terms = _arm_terms(x, y, self.ground)
        return triangle_margins(a, b, _square(*terms), *excesses(*terms, a, b))

    def solve(self, x: Jet, y: Jet, about: float = 0.0) -> Reached:
        """Solve the triangle GQP for P at x, y; GP's direction is taken within pi of `about`, rad.

        Raises BindingError where the triangle does not close, or is flat and the jets have derivatives.
        """
        side = side_of(self.assembly)
        arm = _arm(x, y, self.ground)
        gqp = Triangle.of(self.links[1], self.links[0], arm)
        along, across = gqp.along / (2.0 * arm.q), gqp.root * (side / 2) / arm.q
        joint = arm.x * along - arm.y * across + self.ground[0], arm.y * along + arm.x * across + self.ground[1]
        return Reached(arm.bearing(about) + gqp.beside * side, joint)

    def joints(self, point: Place, reached: Reached) -> dict[str, Joint]:
        """Joints by their letters: P, Q, and the pivot G."""
        pins = {"P": point, "Q": reached.joint}
        return {
            **{name: Joint("pin", Link(place, None)) for name, place in pins.items()},
            "G": pivot(self.ground, reached.output),
        }


@dataclass(frozen=True)
class RRP:
    """A bar PQ of length `link`, mm, and a slide for Q on the line through `through` in `direction`, rad.

    The output is the distance of Q from `through` along the direction, mm; open has Q farther along than the foot of P
    on the line, crossed less far. The output link's origin is Q, its axes fixed.
    """

    on: On
    point: Point
    link: float
    through: Point
    direction: float
    assembly: Assembly = "open"
    unit: ClassVar[str] = "mm"
    lengths: ClassVar[tuple[str, ...]] = ("link",)
    driven: ClassVar[str] = "slide"

    def __post_init__(self) -> None:
        _demand_place(self.on, self.point, (*self.through, self.direction))
        demand_lengths(self.assembly, link=self.link)

    def margins(self, x: float | Array, y: float | Array) -> Array:
        """Length of the bar less P's height above the line and plus it, mm (2, n), for P at x, y (n,).

        The height is above 0 on the left of the line; where a row is negative the bar does not reach the line.
        """
        c, s = math.cos(self.direction), math.sin(self.direction)
        across = np.atleast_1d((y - self.through[1]) * c - (x - self.through[0]) * s)
        return np.stack([self.link - across, self.link + across])

    def solve(self, x: Jet, y: Jet, about: float = 0.0) -> Reached:  # noqa: ARG002 - one call for all dyads
        """Solve (output - P's place along the line)^2 = link^2 - (P's distance from the line)^2.

        Raises BindingError where P is farther from the line than the link is long, or as far and the jets have
        derivatives.
        """
        c, s = math.cos(self.direction), math.sin(self.direction)
        x, y = x - self.through[0], y - self.through[1]
        across = y * c - x * s
        height = across.c[0]
        demand_mobile(self.link - np.abs(height), order=x.order)
        square = with_value(-(across * across), (self.link - height) * (self.link + height))
        output = x * c + y * s + sqrt(square) * side_of(self.assembly)
        return Reached(output, (output * c + self.through[0], output * s + self.through[1]))

    def output_link(self, reached: Reached) -> Link:
        """Return the slide: origin Q, its axes fixed."""
        return Link(reached.joint, None)

    def joints(self, point: Place, reached: Reached) -> dict[str, Joint]:
        """Joints by their letters: P, and Q, which slides on the fixed line."""
        slide = Link(reached.joint, reached.output.constant(self.direction))
        return {"P": Joint("pin", Link(point, None)), "Q": Joint("slide", slide)}

    def middle(self, x: Array, y: Array) -> float:  # noqa: ARG002 - one call for all dyads
        """Return 0: the output of a slide has no direction."""
        return 0.0

    def turned(self, x: Array, y: Array) -> float:  # noqa: ARG002 - one call for all dyads
        """Return 0: a slide does not turn."""
        return 0.0


@dataclass(frozen=True)
class RPR(_Pivoted):
    """A block at P in a slotted rocker about G; the output is the direction of the slot, away from G.

    The slot's line passes G at the distance `offset`, mm, which is positive where that line lies on the left of its
    parallel through G. The output link's origin is G, its x axis along that parallel.
    """

    on: On
    point: Point
    ground: Point
    offset: float = 0.0
    unit: ClassVar[str] = "deg"
    lengths: ClassVar[tuple[str, ...]] = ()
    driven: ClassVar[str] = "rocker"

    def __post_init__(self) -> None:
        _demand_place(self.on, self.point, (*self.ground, self.offset))

    def margins(self, x: float | Array, y: float | Array) -> Array:
        """Distance GP less the size of the slot's offset, mm (1, n), for P at x, y (n,): negative out of reach."""
        terms = _arm_terms(x, y, self.ground)
        return longer(_square(*terms), excess(*terms, (self.offset,)), self.offset)[None]

    def solve(self, x: Jet, y: Jet, about: float = 0.0) -> Reached:
        """Solve GP^2 = slide^2 + offset^2 for P's place `slide` along the slot, away from G.

        The direction of GP is taken within pi of `about`, rad. Raises BindingError where GP is shorter than the offset,
        or as short and derivatives are asked for, or is 0.
        """
        arm = _arm(x, y, self.ground)
        square = excess(arm.x_terms, arm.y_terms, (self.offset,))
        demand_mobile(longer(arm.q.c[0], square, self.offset), order=x.order, fixed=arm.q.c[0] == 0)
        slide = sqrt(with_value(arm.q, square))
        return Reached(arm.bearing(about) - bearing(slide, slide.constant(self.offset), arm.q), (x, y))

    def joints(self, point: Place, reached: Reached) -> dict[str, Joint]:
        """Joints by their letters: P in the slot, and the pivot G."""
        return {"P": Joint("slot", Link(point, reached.output)), "G": pivot(self.ground, reached.output)}


Dyad = RRR | RRP | RPR


def _demand_place(on: str, point: Point, numbers: tuple[float, ...]) -> None:
    if on not in {"output", "coupler", "previous"}:
        raise ValueError(f"a dyad is attached to the output, the coupler or the previous dyad, not to {on!r}")
    if not all(math.isfinite(number) for number in (*point, *numbers)):
        raise ValueError(f"the place of a dyad must be finite, not {(*point, *numbers)!r}")


def _arm_terms(
    x: float | Array, y: float | Array, ground: Point
) -> tuple[tuple[float | Array, float], tuple[float | Array, float]]:
    """X and y of GP, as the terms of which they are the sums."""
    return (x, -ground[0]), (y, -ground[1])


def _arm(x: Jet, y: Jet, ground: Point) -> Vector:
    return Vector.of(x, y, (x.c[0], -ground[0]), (y.c[0], -ground[1]))


def _square(x_terms: tuple[float | Array, float], y_terms: tuple[float | Array, float]) -> Array:
    square: Array = np.atleast_1d(sum(x_terms) ** 2 + sum(y_terms) ** 2)
    return square
