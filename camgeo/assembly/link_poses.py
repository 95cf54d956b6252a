"""Exact places of a linkage's bodies over the shaft angle, from the jets of its mechanism."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kin.linkage.dyad import RRP, Link
from kin.linkage.four_bar import SliderCrank
from kin.numeric.elementary import Jet, atan2, cos, sin
from kin.numeric.taylor import factorials

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.assembly.assembly import Place
    from kin.linkage.mechanism import Mechanism, Motion
    from kin.numeric.arrays import Array

    Posed = Callable[[Motion], tuple[Jet, Jet, Jet]]
    """x, y and angle of a body's axes as jets in the relative angle."""


def jet(rows: Array) -> Jet:
    """Make a jet of derivatives (order + 1, n)."""
    return Jet(rows / factorials(len(rows) - 1))


@dataclass(frozen=True, eq=False)
class Links:
    """The links of a mechanism that turns: each by its place over the shaft angle."""

    mechanism: Mechanism

    def place(self, posed: Posed) -> Place:
        """Turn what gives a body's axes over the relative angle into a place over the shaft angle."""
        mechanism = self.mechanism

        def place(phi: Array, order: int) -> Array:
            motion = mechanism.at(mechanism.relative(phi), order)
            found: Array = np.stack([motion.over_shaft(row.derivatives()) for row in posed(motion)])
            return found

        return place

    def link(self, link: Callable[[Motion], Link]) -> Place:
        """Give the place of a link's own axes."""

        def posed(motion: Motion) -> tuple[Jet, Jet, Jet]:
            found = link(motion)
            x, y = found.origin
            return x, y, x.constant(0.0) if found.direction is None else found.direction

        return self.place(posed)

    def frame(self, motion: Motion) -> tuple[Jet, Jet, Jet]:
        """Axes of the square frame: its middle, and u(theta_3)."""
        half = 0.5 * self.mechanism.breadth
        s, s1 = (jet(rows) for rows in motion.faces)
        angle = jet(motion.frame)
        x, y, c, n = half - s1, s - half, cos(angle), sin(angle)
        return c * x - n * y, n * x + c * y, angle

    def coupler(self, motion: Motion) -> Link:
        """The frame as `kin.linkage.dyad` has it: origin in D."""
        x, y = (jet(rows) for rows in motion.joint)
        return Link((x, y), jet(motion.frame))

    def output(self, motion: Motion) -> Link:
        """The linkage's output link: a rocker about B, x towards D, or the slide."""
        if isinstance(self.mechanism.linkage, SliderCrank):
            x, y = (jet(rows) for rows in motion.joint)
            return Link((x, y), None)
        angle = np.pi - jet(motion.outputs[0])
        return Link((angle.constant(self.mechanism.linkage.ground), angle.constant(0.0)), angle)

    def dyad(self, number: int) -> Callable[[Motion], Link]:
        """Output link of a dyad: a rocker about its ground pivot, or a slide in its joint Q."""
        dyad = self.mechanism.dyads[number]

        def link(motion: Motion) -> Link:
            if isinstance(dyad, RRP):
                x, y = (jet(rows) for rows in motion.joints[number + 1])
                return Link((x, y), x.constant(dyad.direction))
            angle = jet(motion.outputs[number + 1])
            return Link((angle.constant(dyad.ground[0]), angle.constant(dyad.ground[1])), angle)

        return link

    def carrier(self, number: int) -> Callable[[Motion], Link]:
        """The link that a dyad hangs on, in the axes of the dyad's `point`."""
        dyads = self.mechanism.dyads
        if dyads[number].on == "coupler":
            return self.coupler
        if dyads[number].on == "output":
            return self.output
        before = dyads[number - 1]
        found = self.dyad(number - 1)
        if not isinstance(before, RRP):
            return found
        return lambda motion: Link(found(motion).origin, None)

    def hung(self, number: int) -> Callable[[Motion], tuple[Jet, Jet]]:
        """The point P that a dyad hangs on."""
        carrier, point = self.carrier(number), self.mechanism.dyads[number].point
        return lambda motion: carrier(motion).point(*point)

    def rod(self, number: int) -> Place:
        """Place of a dyad's bar PQ: origin P, x towards Q."""
        hung = self.hung(number)

        def posed(motion: Motion) -> tuple[Jet, Jet, Jet]:
            px, py = hung(motion)
            qx, qy = (jet(rows) for rows in motion.joints[number + 1])
            return px, py, atan2(qy - py, qx - px)

        return self.place(posed)

    def block(self) -> Place:
        """Place of a block that slides along the frame in D."""
        return self.link(self.coupler)
