"""How far the output of a linkage is off where a dimension is, the cam's metal and the shaft angle being held.

The frame bears on the cam with two of its faces: face 1, by whose lift S its mid-line stands, and the one opposite face
2, so that the joint D stands at X = w + r3 - S1, Y = S - w/2 + e in the axes of the frame, theta_3 its direction u and
A the shaft. At a held shaft angle the cam turns against the frame as the frame turns, by x: D moves by dD + V x with

    V = u (-S1' - Y + i (X + S')),      dD = u (dX + i dY),

and the loop sets the x that closes it (`deviation` of each linkage). Contacts on the opposite faces make the same
changes or lesser ones: a change of the breadth then leaves X as it is. Plane as complex numbers, x.y = Re(conj(x) y).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.linkage.four_bar import Displaced
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.linkage.mechanism import LinkageMotion, Mechanism
    from kin.numeric.arrays import Array, Complexes

QUARTER = 0.5 * math.pi


@dataclass(frozen=True, eq=False)
class FrameBearing:
    """A mechanism without dyads at n relative angles, its frame on the cam: changes of its output, rad or mm, (n,)."""

    mechanism: Mechanism
    motion: LinkageMotion

    def output(
        self,
        along: Array | float = 0.0,
        across: Array | float = 0.0,
        *,
        pivot: Complexes | complex = 0.0,
        joint: Complexes | complex = 0.0,
        link: float = 0.0,
    ) -> Array:
        """Change (n,) of the output, rad or mm, for small displacements, mm, (n,) or one for all angles.

        The shaft is held.

        along, across  displacement of the frame on the cam, dX and dY
        pivot, joint   displacement of B, and of D, in fixed axes, as complex numbers
        link           growth of the output link's length, of a slide of its height
        """
        positions = self.motion.solved.linkage
        (s, slope), (_, slope1) = self.motion.faces
        x, y = positions.slide.c[0], s - 0.5 * self.mechanism.breadth + self.mechanism.linkage.joint_offset
        u = np.exp(1j * self.motion.frame[0])
        # a frame that turns with the shaft held turns about the instant centre, at -S', -S1' in its axes
        sweep = u * (-slope1 - y + 1j * (x + slope))
        off = u * (along + 1j * across) + joint
        return self.mechanism.linkage.deviation(positions, Displaced(off, sweep, pivot, link))

    def shaft(self, displacement: complex) -> Array:
        """Change (n,) of the output, rad or mm, when shaft and cam are displaced in the ground by `displacement`, mm.

        The x axis points from the shaft to the pivot.
        """
        return self.output(pivot=-displacement)

    def metal(self, displacement: complex) -> Array:
        """Change (n,) of the output, rad or mm, when the metal is displaced, mm, in the cam's own axes."""
        along = (np.conj(displacement) * np.exp(1j * (self.motion.theta + QUARTER))).real
        across = (np.conj(displacement) * np.exp(1j * self.motion.theta)).real
        return self.output(-along, across)

    def metal_turned(self) -> Array:
        """Change (n,) of the output, rad or mm, per rad of the metal's turn counter-clockwise about the shaft."""
        (_, slope), (_, slope1) = self.motion.faces
        return self.output(slope1, -slope)

    def squareness(self) -> Array:
        """Change (n,) of the output, rad or mm, per rad by which face 2 and its opposite are out of square.

        They turn counter-clockwise about a point of the frame's mid-line.
        """
        (s, _), (_, slope1) = self.motion.faces
        middle = s - 0.5 * self.mechanism.breadth
        return self.output(-(slope1 + middle))


def frame_bearing(mechanism: Mechanism, relative: Array) -> FrameBearing:
    """Bearing of the frame at relative angles (n,), rad.

    Raises ValueError for a linkage with dyads, PlaceError where the loop binds.
    """
    if mechanism.dyads:
        raise ValueError("the influence of dyads is not known")
    return FrameBearing(mechanism, mechanism.at(relative, 1))
