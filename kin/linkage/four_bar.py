"""Linkages driven by a constant-breadth cam in a square frame (AS sections 3 to 5): positions and their derivatives.

The frame is the coupler. Its axes u(theta_3), n(theta_3) carry the joint D at X = w + r3 - S1, Y = S - w/2 + e from
the shaft A, where S, S1 are the support of the cam at theta and a quarter turn on, and `joint_offset` e is the distance
of D from the frame's mid-line towards face 1, whose lift is S. AS have e = 0 and state that a different point would do
as well: r4 - e then stands for the r4 of an inverted slider-crank's loop. So D = X u + Y n, and no cotangent of
theta_3 occurs anywhere (AS 11-13, 19, 22 have it). B = (r1, 0) is the fixed pivot, and theta_4 the angle at B from BA
to BD, clockwise as in AS Figure 7. Each loop is a triangle or a right triangle, solved by half angles and
differentiated implicitly (`kin.linkage.loop`); AS 34 is 0/0 at theta_3 = theta_4 and theta_4 + pi, the forms here are
not.

All linkages have the same methods. `lengths` are the fields of the links' lengths. At solved positions `output_link` is
the link that a linkage drives, `driven` its name, and `joined` the name of the link in which D is fixed and whose axes
are the frame's: the frame, or a block in it. `joints` are D and the pivot B. `transmission` is the sine and cosine (n,)
of the angle from the frame's line u to the rocker BD, or to the slide's normal; `force_angle` the sine and cosine of
the force angle (`kin.linkage.forces`) for the slopes S' and S1' (n,): the sine has the sign of phi' and is 0 where
there is no line of force. `force_line` is that line. `deviation` is the change of the output by small displacements.
`closure` has the gap, mm, by which the loop fails to close, and the output, (n,) each, for any place D of the joint,
mm, and unit vector u along the frame, (n,) each, with B or the slide's line displaced by `pivot`, mm, and the rocker
longer, or the slide higher, by `link`, mm.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from kin.linkage.forces import ForceLine, angle, pushing
from kin.linkage.links import Joint, Link, Place, pivot, rocker
from kin.linkage.loop import (
    Assembly,
    BindingError,
    Triangle,
    Vector,
    bearing,
    demand_finite,
    demand_lengths,
    demand_mobile,
    excess,
    excesses,
    longer,
    side_of,
    total,
    triangle_margins,
    with_value,
)
from kin.numeric.elementary import Jet, sqrt
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Complexes

__all__ = [
    "Assembly",
    "BindingError",
    "Displaced",
    "FourBar",
    "InvertedSliderCrank",
    "Linkage",
    "Positions",
    "SliderCrank",
]


QUARTER = 0.5 * math.pi


@dataclass(frozen=True, eq=False)
class Positions:
    """A linkage at n points, as jets in whatever parameter the lifts were given.

    `frame` is theta_3 (rad), continuous round a turn; `output` is theta_4 (rad) or D_x (mm); `joint` is D (mm);
    `slide` is the X of D along the frame (mm).
    """

    frame: Jet
    output: Jet
    joint: Place
    slide: Jet

    @property
    def coupler(self) -> Link:
        """The link with the joint D, its origin, and x along u(theta_3), away from the frame."""
        return Link(self.joint, self.frame)

    def instant_centre(self, slope: Array, slope1: Array) -> tuple[Array, Array]:
        """P = -S' u - S1' n, where the normals of the contacts meet (n,), mm; S' and S1' (n,)."""
        c, s = np.cos(self.frame.c[0]), np.sin(self.frame.c[0])
        return -slope * c + slope1 * s, -slope * s - slope1 * c

    def from_instant_centre(self, slope: Array, slope1: Array) -> tuple[Array, Array]:
        """Vector (x, y) from the instant centre P to the joint D, (n,) each, mm."""
        px, py = self.instant_centre(slope, slope1)
        return self.joint[0].c[0] - px, self.joint[1].c[0] - py


class Displaced(NamedTuple):
    """Small displacements of a solved linkage whose shaft is held, (n,) or one for all positions, mm.

    joint   of D, with the frame's direction kept
    sweep   of D, per rad of the frame's turn
    pivot   of B, or of the slide's line
    link    growth of the rocker's length, or of the slide's height
    """

    joint: Complexes
    sweep: Complexes
    pivot: Complexes | complex
    link: float

    def closed(self, closing: Complexes | complex) -> tuple[Complexes, Array]:
        """Displacement of D from the pivot, mm, and turn of the frame, rad, (n,) each, that close the loop again.

        `closing` is the unit vector, one or (n,), along which D keeps its distance but for the link's growth.
        """
        turn = (self.link - _dot(closing, self.joint - self.pivot)) / _dot(closing, self.sweep)
        return self.joint + self.sweep * turn - self.pivot, turn


class _Rocking:
    """A linkage that drives a rocker about B."""

    ground: float

    def output_link(self, positions: Positions) -> Link:
        """Return the rocker: origin B, x towards D."""
        return rocker((self.ground, 0.0), math.pi - positions.output)


@dataclass(frozen=True)
class FourBar(_Rocking):
    """AB = ground r1, coupler r3 from the frame's face to D, rocker BD = r4; D `joint_offset` off the mid-line; mm.

    Open is the (+) root of AS 18, D above AB (Figure 7); crossed has D below. ValueError unless all lengths are
    positive and the offset finite.
    """

    ground: float
    coupler: float
    rocker: float
    assembly: Assembly = "open"
    joint_offset: float = 0.0
    unit: ClassVar[str] = "deg"
    lengths: ClassVar[tuple[str, ...]] = ("coupler", "rocker", "ground")
    driven: ClassVar[str] = "rocker"
    joined: ClassVar[str] = "frame"

    def __post_init__(self) -> None:
        demand_lengths(self.assembly, ground=self.ground, coupler=self.coupler, rocker=self.rocker)
        demand_finite("joint's offset", self.joint_offset)

    def margins(self, s: float | Array, s1: float | Array, w: float) -> Array:
        """Distances of AD from its limits |r1 - r4| and r1 + r4, mm (2, n): negative where the loop cannot close."""
        x, y = _frame_terms(s, s1, w, self.coupler, self.joint_offset)
        q = np.atleast_1d(total(*x) ** 2 + total(*y) ** 2)
        return triangle_margins(self.ground, self.rocker, q, *excesses(x, y, self.ground, self.rocker))

    def solve(self, s: Jet, s1: Jet, w: float) -> Positions:
        """Solve the triangle ABD of r1, r4 and AD; in place of AS 13-18, 19-20 and 34.

        AS 20 takes theta_4 from its sine, which loses the branch beyond 90 degrees; here it is 2 atan2 of the roots of
        AD^2 - (r1 - r4)^2 and (r1 + r4)^2 - AD^2, and 2 r1 r4 sin theta_4 theta_4' = (AD^2)'. Raises BindingError where
        the triangle does not close, where AD is 0, and where it is flat and the jets have derivatives.
        """
        r1, r4, side = self.ground, self.rocker, side_of(self.assembly)
        ad = _frame_vector(s, s1, w, self.coupler, self.joint_offset)
        abd = Triangle.of(r1, r4, ad)
        joint = abd.along / (2 * r1), abd.root * (side / (2 * r1))
        frame = abd.beside * side - ad.bearing()
        return Positions(frame, abd.between * side, joint, ad.x)

    def joints(self, positions: Positions) -> dict[str, Joint]:
        """Joints by their letters: B and D."""
        return {"B": pivot((self.ground, 0.0), positions.output), "D": Joint("pin", Link(positions.joint, None))}

    def deviation(self, positions: Positions, by: Displaced) -> Array:
        """Change of theta_4, rad (n,), to first order: (dD - dB).h = dr4 along the rocker h."""
        away = np.exp(1j * (math.pi - positions.output.c[0]))  # from B to D
        change: Array = _dot(-1j * away, by.closed(away)[0]) / self.rocker
        return change

    def closure(
        self,
        joint: Complexes,
        along: Complexes,  # noqa: ARG002 - one call for all linkages
        pivot: Complexes | complex,
        link: Array | float,
    ) -> tuple[Array, Array]:
        """Gap, mm, and output, rad, (n,) each."""
        arm = joint - self.ground - pivot
        return np.abs(arm) - self.rocker - link, math.pi - np.angle(arm)

    def transmission(self, positions: Positions) -> tuple[Array, Array]:
        """Sine and cosine (n,) of the angle between frame and rocker."""
        frame, output = positions.frame.c[0], positions.output.c[0]
        return np.sin(frame + output), -np.cos(frame + output)

    def force_angle(self, positions: Positions, slope: Array, slope1: Array) -> tuple[Array, Array]:
        """Sine and cosine (n,) of the angle between DP, along which the frame's force acts, and the rocker DB."""
        ax, ay = positions.from_instant_centre(slope, slope1)
        dx, dy = (row.c[0] for row in positions.joint)
        bx, by = dx - self.ground, dy
        return angle(ax * by - ay * bx, ax * bx + ay * by, dy)

    def force_line(self, positions: Positions, slope: Array, slope1: Array) -> ForceLine:
        """Line of the frame's force: along DP, in the sense in which it pushes the rocker on.

        Positions are jets of order 1 at least.
        """
        dx, dy = (row.c[0] for row in positions.joint)
        along = positions.from_instant_centre(slope, slope1)
        return pushing((dx, dy), along, (-dy, dx - self.ground), -positions.output.c[1])


@dataclass(frozen=True)
class InvertedSliderCrank(_Rocking):
    """AB = ground r1, and a rocker r4 whose end D slides along the frame's u: theta_3 + theta_4 = 90 degrees; mm.

    The line on which it slides is `joint_offset` off the frame's mid-line, and touches the circle of r4 about B. r4 = 0
    is the oscillating yoke. Open is the root of AS 27, theta_4 from 0 to 180 degrees; crossed is its negative:
    the mirror image, with D on the other side of the shaft along u. ValueError unless r1 > 0, r4 >= 0 and the offset is
    finite.
    """

    ground: float
    rocker: float
    assembly: Assembly = "open"
    joint_offset: float = 0.0
    unit: ClassVar[str] = "deg"
    lengths: ClassVar[tuple[str, ...]] = ("rocker", "ground")
    driven: ClassVar[str] = "rocker"
    joined: ClassVar[str] = "block"

    def __post_init__(self) -> None:
        demand_lengths(self.assembly, ground=self.ground)
        if not (math.isfinite(self.rocker) and self.rocker >= 0):
            raise ValueError(f"the rocker must be 0 or longer, not {self.rocker!r} mm")
        demand_finite("joint's offset", self.joint_offset)

    def margins(self, s: float | Array, s1: float | Array, w: float) -> Array:  # noqa: ARG002 - one call for all linkages
        """Distances of Y from the ends of its range, r4 - r1 and r4 + r1, mm (2, n), negative out of reach.

        They are r1 (1 - cos theta_4) and r1 (1 + cos theta_4).
        """
        r1, r4, e = self.ground, self.rocker, self.joint_offset
        near, far = total(r1, -r4, s, -w / 2, e), total(r1, r4, -s, w / 2, -e)
        return np.stack([np.atleast_1d(near), np.atleast_1d(far)])

    def solve(self, s: Jet, s1: Jet, w: float) -> Positions:
        """Solve r1 cos theta_4 = r4 - Y (AS 24-27), r1 sin theta_4 theta_4' = S' (AS 29).

        AS 30 has the wrong sign before r1 omega_4^2 cos theta_4; AS 31 is right. Raises BindingError where the loop
        does not close, or stands in a limit position and the jets have derivatives.
        """
        r1, r4, side = self.ground, self.rocker, side_of(self.assembly)
        near_value, far_value = self.margins(s.c[0], s1.c[0], w)
        demand_mobile(np.minimum(near_value, far_value), order=s.order)
        near, far = with_value(s, near_value), with_value(-s, far_value)
        slide = sqrt(near * far) * side
        value = 2 * side * np.arctan2(np.sqrt(near_value), np.sqrt(far_value))
        output = (s.derivative() / slide.lower()).integral(value) if s.order else Jet(value[None])
        joint = near * (r4 / r1) + (r1 - r4), slide * (r4 / r1)
        return Positions(math.pi / 2 - output, output, joint, slide)

    def joints(self, positions: Positions) -> dict[str, Joint]:
        """Joints by their letters: B, and D in a slot of the frame along u."""
        return {"B": pivot((self.ground, 0.0), positions.output), "D": Joint("slot", positions.coupler)}

    def deviation(self, positions: Positions, by: Displaced) -> Array:
        """Change of theta_4, rad (n,), to first order: Y + r1 cos theta_4 = r4, and theta_3 turns the other way."""
        return -by.closed(1j * np.exp(1j * positions.frame.c[0]))[1]

    def closure(
        self, joint: Complexes, along: Complexes, pivot: Complexes | complex, link: Array | float
    ) -> tuple[Array, Array]:
        """Gap, mm, and output, rad, (n,) each."""
        off = _dot(1j * along, joint - self.ground - pivot) - self.rocker - link
        return off, QUARTER - np.angle(along)

    def transmission(self, positions: Positions) -> tuple[Array, Array]:
        """Sine and cosine (n,) of a right angle: the block always presses across the frame's line."""
        frame = positions.frame.c[0]
        return np.ones_like(frame), np.zeros_like(frame)

    def force_angle(self, positions: Positions, slope: Array, slope1: Array) -> tuple[Array, Array]:
        """Sine and cosine (n,) of the angle between BP and the force through P, across the frame's line."""
        frame = positions.frame.c[0]
        c, s = np.cos(frame), np.sin(frame)
        px, py = positions.instant_centre(slope, slope1)
        ax, ay = self.ground - px, -py
        return angle(ax * c + ay * s, ay * c - ax * s, positions.slide.c[0])

    def force_line(self, positions: Positions, slope: Array, slope1: Array) -> ForceLine:
        """Line of the frame's force: across the frame's line, through the foot of the instant centre P on that line.

        Positions are jets of order 1 at least.
        """
        frame = positions.frame.c[0]
        c, s = np.cos(frame), np.sin(frame)
        fx, fy = positions.from_instant_centre(slope, slope1)
        back = fx * c + fy * s
        x, y = positions.joint[0].c[0] - back * c, positions.joint[1].c[0] - back * s
        return pushing((x, y), (-s, c), (-y, x - self.ground), -positions.output.c[1])


@dataclass(frozen=True)
class SliderCrank:
    """A slide for D along the fixed x axis at height `offset`, coupler r3 from the frame's face to D; mm.

    D is `joint_offset` off the frame's mid-line. Open has D at positive x, crossed at negative. ValueError unless the
    coupler is positive and the offsets finite.
    """

    coupler: float
    offset: float
    assembly: Assembly = "open"
    joint_offset: float = 0.0
    unit: ClassVar[str] = "mm"
    lengths: ClassVar[tuple[str, ...]] = ("coupler",)
    driven: ClassVar[str] = "slide"
    joined: ClassVar[str] = "frame"

    def __post_init__(self) -> None:
        demand_lengths(self.assembly, coupler=self.coupler)
        demand_finite("offset", self.offset)
        demand_finite("joint's offset", self.joint_offset)

    def margins(self, s: float | Array, s1: float | Array, w: float) -> Array:
        """Length AD less the slider's offset, mm (1, n): negative where the loop cannot close."""
        x, y = _frame_terms(s, s1, w, self.coupler, self.joint_offset)
        q = np.atleast_1d(total(*x) ** 2 + total(*y) ** 2)
        return longer(q, excess(x, y, (self.offset,)), self.offset)[None]

    def solve(self, s: Jet, s1: Jet, w: float) -> Positions:
        """Solve D_x^2 = AD^2 - offset^2, D_x D_x' = (AD^2)'/2.

        Raises BindingError where AD is shorter than the offset, or as short and the jets have derivatives, or is 0.
        """
        offset, side = self.offset + 0.0, side_of(self.assembly)  # no -0, whose polar angle is -pi
        ad = _frame_vector(s, s1, w, self.coupler, self.joint_offset)
        q = ad.q
        square = excess(ad.x_terms, ad.y_terms, (offset,))
        demand_mobile(longer(q.c[0], square, offset), order=q.order, fixed=q.c[0] == 0)
        output = sqrt(with_value(q, square)) * side
        height = output.constant(offset)
        return Positions(bearing(output, height, q) - ad.bearing(), output, (output, height), ad.x)

    def output_link(self, positions: Positions) -> Link:
        """Return the slide: origin D, its axes fixed."""
        return Link(positions.joint, None)

    def joints(self, positions: Positions) -> dict[str, Joint]:
        """Joints by their letters: D, which slides on the fixed line."""
        return {"D": Joint("slide", Link(positions.joint, positions.output.constant(0.0)))}

    def deviation(self, positions: Positions, by: Displaced) -> Array:  # noqa: ARG002 - one call for all linkages
        """Change of D_x, mm (n,), to first order: D_y is the offset."""
        change: Array = by.closed(1j)[0].real
        return change

    def closure(
        self,
        joint: Complexes,
        along: Complexes,  # noqa: ARG002 - one call for all linkages
        pivot: Complexes | complex,
        link: Array | float,
    ) -> tuple[Array, Array]:
        """Gap and output, mm, (n,) each."""
        place = joint - pivot
        return place.imag - self.offset - link, place.real

    def transmission(self, positions: Positions) -> tuple[Array, Array]:
        """Sine and cosine (n,) of the angle between the frame and the slide's normal."""
        frame = positions.frame.c[0]
        return np.cos(frame), np.sin(frame)

    def force_angle(self, positions: Positions, slope: Array, slope1: Array) -> tuple[Array, Array]:
        """Sine and cosine (n,) of the angle between DP, along which the frame's force acts, and the slide's normal."""
        return angle(*positions.from_instant_centre(slope, slope1), positions.joint[0].c[0])

    def force_line(self, positions: Positions, slope: Array, slope1: Array) -> ForceLine:
        """Line of the frame's force: along DP, in the sense in which it pushes the slide on.

        Positions are jets of order 1 at least.
        """
        dx, dy = (row.c[0] for row in positions.joint)
        way = np.ones_like(dx), np.zeros_like(dx)
        return pushing((dx, dy), positions.from_instant_centre(slope, slope1), way, positions.output.c[1])


Linkage = FourBar | InvertedSliderCrank | SliderCrank


def _frame_terms(
    s: float | Array, s1: float | Array, w: float, r3: float, e: float
) -> tuple[tuple[float | Array, ...], tuple[float | Array, ...]]:
    """X and Y of D in the frame's axes, as the terms of which they are the sums."""
    return (r3, w, -s1), (s, -w / 2, e)


def _frame_vector(s: Jet, s1: Jet, w: float, r3: float, e: float) -> Vector:
    return Vector.of(-s1, s, *_frame_terms(s.c[0], s1.c[0], w, r3, e))


def _dot(x: Complexes | complex, y: Complexes | complex) -> Array:
    """Scalar products (n,) of vectors as complex numbers."""
    product: Array = (np.conj(x) * y).real
    return product
