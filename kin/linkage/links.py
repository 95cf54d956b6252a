"""Moving links and the joints in which they meet, at n points, as a linkage and its dyads give them."""

from __future__ import annotations

from typing import Literal, NamedTuple

from kin.numeric.elementary import Jet, atan2, cos, sin
from kin.numeric.records import dataclass

__all__ = ["Joint", "Link", "Place", "bar", "pivot", "rocker"]

Place = tuple[Jet, Jet]


@dataclass(frozen=True, eq=False)
class Link:
    """A moving link as jets: its origin in the fixed frame, mm, and the direction of its x axis, rad (None: fixed)."""

    origin: Place
    direction: Jet | None

    def point(self, x: float | Jet, y: float | Jet) -> Place:
        """Position, mm, in the fixed axes, of the point (x, y) of the link."""
        a, b = self.origin
        if self.direction is None:
            return a + x, b + y
        c, s = cos(self.direction), sin(self.direction)
        return a + c * x - s * y, b + s * x + c * y


class Joint(NamedTuple):
    """A pin, a `pivot` (a pin on the ground), a `slide` (a pin in a block on the ground) or a `slot` (in a link).

    `place` has its origin in the pin, and its x axis along the line on which a block slides; no direction without one.
    """

    kind: Literal["pin", "pivot", "slide", "slot"]
    place: Link


def bar(p: Place, q: Place) -> Link:
    """Link from P, its origin, to Q, which is on its x axis; its direction lies within [-pi, pi]."""
    return Link(p, atan2(q[1] - p[1], q[0] - p[0]))


def rocker(ground: tuple[float, float], direction: Jet) -> Link:
    """Link that turns about the fixed point `ground`, mm, its origin; `direction`, rad, is that of its x axis."""
    return Link((direction.constant(ground[0]), direction.constant(ground[1])), direction)


def pivot(ground: tuple[float, float], like: Jet) -> Joint:
    """A pin on the ground at `ground`, mm, as jets of the order and number of points of `like`."""
    return Joint("pivot", Link((like.constant(ground[0]), like.constant(ground[1])), None))
