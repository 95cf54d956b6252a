"""A cam in a square frame driving a linkage: its motion over the relative angle and over the shaft angle.

theta is the cam's angle relative to the frame, the abscissa of AS's plots. The frame itself turns by theta_3, so the
shaft has turned by phi = theta - (theta_3(theta) - theta_3(0)), clockwise positive: phi' = 1 - theta_3'. Results are
given over either angle. Derivatives are exact (`kin.numeric.elementary`), extremes and roots those of monotone pieces
(`kin.numeric.monotone`).
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.law.normalised import IntentError
from kin.linkage.chain import Chain
from kin.linkage.extremes import Figures, Quantities, figures
from kin.linkage.loop import BindingError
from kin.linkage.mobility import Mobility, mobility
from kin.numeric.angles import TURN
from kin.numeric.bernstein import values
from kin.numeric.distinct import distinct
from kin.numeric.elementary import Jet
from kin.numeric.jet import derivatives_by
from kin.numeric.longest_window import Window, dwells
from kin.numeric.monotone import between, cells, extremes_of_each
from kin.numeric.records import dataclass, field
from kin.numeric.taylor import factorials

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.law.piecewise import Side
    from kin.law.support_function import Lift
    from kin.linkage.chain import Solved
    from kin.linkage.dyad import Dyad
    from kin.linkage.four_bar import Linkage
    from kin.numeric.arrays import Array, Indices
    from kin.numeric.monotone import Cells

__all__ = ["LinkageMotion", "Mechanism", "OutsideError", "PlaceError"]

QUARTER = 0.5 * math.pi
# Rounding of a lift's own constants, as a part of the breadth.
_ROUNDED = 1e-9
_EDGE = 1e-12  # of the breadth, by which the shaft may lie outside; rad, within which two breaks are one
_LOOKS = 256  # relative angles at which the direction of a dyad's point is looked at


class PlaceError(BindingError):
    """A mechanism that binds, or would turn its shaft back, at the relative angle `at`, rad.

    `indices` (k,) are the points concerned; it is empty where the whole turn was looked at, not points of it.
    """

    def __init__(self, message: str, angle: float, indices: Indices) -> None:
        super().__init__(message, indices)
        self.at = angle

    def __str__(self) -> str:
        return f"{self.message}, at a relative angle of {math.degrees(self.at % TURN):.6g} degrees"


class OutsideError(IntentError):
    """A shaft that lies outside the cam, by `depth` mm in the direction `at_deg`, degrees."""

    def __init__(self, depth: float, at_deg: float) -> None:
        what = f"the shaft lies outside the cam, by {depth:.6g} mm in the direction of {at_deg:.6g} degrees"
        super().__init__(what, "shaft", at_deg)
        self.depth = depth


@dataclass(frozen=True, eq=False)
class LinkageMotion:
    """A mechanism at relative angles theta (n,): derivatives by theta, (order + 1, n) each; rad and mm.

    `shaft` is the shaft angle phi, rad; `solved` has the positions of all links as jets.
    """

    theta: Array
    shaft: Array
    solved: Solved

    @cached_property
    def frame(self) -> Array:
        """Angle theta_3 of the frame and its derivatives by the relative angle, rad."""
        return self.solved.linkage.frame.derivatives()

    @cached_property
    def outputs(self) -> tuple[Array, ...]:
        """Outputs of linkage and dyads, rad or mm, with derivatives by the relative angle: (order + 1, n) each."""
        return tuple(output.derivatives() for output in self.solved.outputs)

    @cached_property
    def joints(self) -> tuple[Array, ...]:
        """Joint D, then the joint that each dyad's point drives, mm, with derivatives: (2, order + 1, n) each."""
        return tuple(np.stack([row.derivatives() for row in joint]) for joint in self.solved.joints)

    @cached_property
    def faces(self) -> Array:
        """Lifts S and S1 with derivatives by the relative angle, mm: (2, order + 1, n)."""
        return np.stack([lift.derivatives() for lift in self.solved.lifts])

    @property
    def joint(self) -> Array:
        """Joint D between frame and output link, mm, with derivatives: (2, order + 1, n)."""
        return self.joints[0]

    @property
    def output(self) -> Array:
        """Output of the last link with derivatives by the relative angle, rad or mm: (order + 1, n)."""
        return self.outputs[-1]

    def over_shaft(self, row: Array) -> Array:
        """A quantity's derivatives by the shaft angle, (order + 1, n), from its derivatives `row` by theta, as many."""
        scale = factorials(len(row) - 1)
        return np.stack([f.c[0] for f in derivatives_by(Jet(row / scale), Jet(self.shaft[: len(row)] / scale))])


@dataclass(frozen=True, eq=False)
class Mechanism:
    """A linkage whose frame holds the cam of a lift, and further links.

    `breadth` of frame and cam is in mm; `chain` has all the links. Raises ValueError if the first dyad hangs on a
    previous one; IntentError if the breadth is not above 0 or p(theta) + p(theta + pi) is not the breadth all round
    (field "p"), if the shaft lies outside the cam (field "shaft"), or if the point to which a dyad is attached circles
    the dyad's ground pivot (field "dyads").
    """

    linkage: Linkage
    lift: Lift
    breadth: float
    dyads: tuple[Dyad, ...] = ()

    chain: Chain = field(init=False)

    def __post_init__(self) -> None:
        if not self.breadth > 0:
            raise IntentError(f"no frame has a breadth of {self.breadth:.6g} mm: it must be above 0", "p")
        object.__setattr__(self, "chain", Chain(self.linkage, self.breadth, self.dyads))
        self._demand_held()
        _ = self.about

    @property
    def unit(self) -> str:
        """Unit of the last output as reported, deg or mm; the methods give rad or mm."""
        return self.chain.unit

    @property
    def outputs(self) -> int:
        """Number of outputs: the linkage's, and one for each dyad."""
        return 1 + len(self.dyads)

    @cached_property
    def breaks(self) -> Array:
        """Relative angles (m,), rad, in [0, 2 pi), rising, at which a derivative may jump: breaks of S or of S1."""
        own = self.lift.breaks
        turned = np.mod(own - QUARTER, TURN)
        near = np.abs(turned[:, None] - own) <= _EDGE  # one break, found from both sides
        return distinct(np.concatenate([own, turned[~near.any(axis=1)]]))

    @cached_property
    def start(self) -> float:
        """Angle theta_3, rad, of the frame at relative angle 0, where the shaft angle begins.

        Raises PlaceError if the linkage binds there.
        """
        frame, _ = self._driven(np.zeros(1), 0)
        return float(frame.c[0, 0])

    def at(self, theta: float | Array, order: int, side: Side = 1) -> LinkageMotion:
        """Motion at relative angles theta (n,), rad, with derivatives to `order`; at a break from the right, or left.

        `side` -1 means the left. Raises PlaceError where a loop cannot be closed, or has no derivative.
        """
        theta = np.atleast_1d(np.asarray(theta, dtype=float))
        s, s1 = self._lifts(theta, order, side)
        try:
            solved = self.chain.solve(s, s1, self.about)
        except BindingError as error:
            raise _placed(error, theta) from error
        frame = solved.linkage.frame
        shaft = -frame.derivatives()
        shaft[0] += theta + self.start
        if frame.order > 0:
            shaft[1] += 1.0
        return LinkageMotion(theta, shaft, solved)

    def driven(self, s: Jet, s1: Jet) -> tuple[Jet, Jet]:
        """theta_3, rad, and output, rad or mm, for any lifts of the frame's faces 1 and 2, mm, as jets at n points.

        Raises BindingError where a loop does not close, or stands in a limit position and the jets have derivatives.
        """
        solved = self.chain.solve(s, s1, self.about)
        return solved.linkage.frame, solved.outputs[-1]

    def relative(self, shaft: float | Array) -> Array:
        """Relative angles (n,), rad, at shaft angles (n,), rad, any real numbers.

        Raises PlaceError unless the mechanism turns.
        """
        shaft = np.atleast_1d(np.asarray(shaft, dtype=float))
        turns = np.floor(shaft / TURN) * TURN
        cell, share = self._relation.reach(shaft - turns)
        low, high = self._relation.low[cell], self._relation.high[cell]
        return low + share * (high - low) + turns

    def output(self, shaft: Array) -> Array:
        """Output (n,), rad or mm, at shaft angles (n,), rad, any real numbers, by polynomials good to rounding.

        Raises PlaceError unless the mechanism turns.
        """
        cell, share = self._relation.reach(np.mod(shaft, TURN))
        return values(self._relation.coefficients[1, cell], share)

    @cached_property
    def _mobility(self) -> Mobility:
        return mobility(
            [self._margins(loop) for loop in range(self.outputs)],
            lambda theta: 1.0 - self._driven(theta, 1)[0].c[1],
            self._sense,
            self.breaks,
            self.breadth,
        )

    def _margins(self, loop: int) -> Callable[[Array], Array]:
        """Margins of a loop, mm, over the relative angle."""

        def margins(theta: Array) -> Array:
            s, s1 = self._lifts(theta, 0)
            return self.chain.margins(loop, s.c[0], s1.c[0], self.about)

        return margins

    def mobility(self) -> Mobility:
        """Where the mechanism binds or turns back, or how far it is from that.

        Raises RoughError where no polynomials follow a margin.
        """
        return self._mobility

    def figures(self) -> Figures:
        """Extremes of the motion over a turn.

        Raises PlaceError unless the mechanism turns, and RoughError where it comes so close to binding that rounding
        hides them.
        """
        self._demand_turning()
        return figures(self._rows, lambda theta: self.at(theta, 0).shaft[0], self.breaks)

    @cached_property
    def _dwells(self) -> dict[tuple[float, str, int], tuple[Window, ...]]:
        """Dwells known so far, by band, angle and number: the judge of a file needs those of the design again."""
        return {}

    def dwells(self, band: float, over: Literal["shaft", "relative"] = "shaft", most: int = 8) -> tuple[Window, ...]:
        """The longest dwells of the output within a band, rad or mm, over either angle: at most `most`, longest first.

        Dwells do not overlap. Raises PlaceError unless the mechanism turns, ValueError for a band that is not above 0
        or is lost in rounding.
        """
        key = band, over, most
        if key not in self._dwells:
            self._dwells[key] = self._longest(band, over, most)
        return self._dwells[key]

    def _longest(self, band: float, over: Literal["shaft", "relative"], most: int) -> tuple[Window, ...]:
        if over == "relative":
            return dwells(lambda theta, _: self._relation.at(theta)[1:], self.breaks, band, TURN, most)

        shaft = self.at(self.breaks, 0).shaft[0] if len(self.breaks) else self.breaks
        return dwells(lambda phi, _: self.output(phi)[None], shaft, band, TURN, most)

    def _rows(self, theta: Array) -> Quantities:
        motion = self.at(theta, 2)
        at, (s, s1) = motion.solved.linkage, motion.solved.lifts
        over = motion.over_shaft(motion.output)
        sine, cosine = self.linkage.transmission(at)
        force_sine, force_cosine = self.linkage.force_angle(at, s.c[1], s1.c[1])
        return Quantities(
            output=motion.output[0],
            velocity_relative=motion.output[1],
            acceleration_relative=motion.output[2],
            velocity=over[1],
            acceleration=over[2],
            frame=motion.frame[0],
            transmission_sine=sine,
            transmission_cosine=cosine,
            force_sine=force_sine,
            force_cosine=force_cosine,
            offset=s.c[0] - 0.5 * self.breadth + self.linkage.joint_offset,
        )

    def _lifts(self, theta: Array, order: int, side: Side = 1) -> tuple[Jet, Jet]:
        c = self.lift.law.on(Jet.variable(np.concatenate([theta, theta + QUARTER]), order), side).c
        return Jet(c[:, : len(theta)]), Jet(c[:, len(theta) :])

    def _driven(self, theta: Array, order: int) -> tuple[Jet, Jet]:
        """theta_3, rad, and the linkage's own output, rad or mm, as jets; PlaceError where it binds."""
        s, s1 = self._lifts(theta, order)
        try:
            at = self.linkage.solve(s, s1, self.breadth)
        except BindingError as error:
            raise _placed(error, theta) from error
        return at.frame, at.output

    def _sense(self, theta: Array) -> Array:
        """Sine of the force angle (n,): bounded, and of the sign of phi'."""
        s, s1 = self._lifts(theta, 1)
        at = self.linkage.solve(Jet(s.c[:1]), Jet(s1.c[:1]), self.breadth)
        return self.linkage.force_angle(at, s.c[1], s1.c[1])[0]

    @cached_property
    def about(self) -> tuple[float, ...]:
        """Direction, rad, for each dyad, within half a turn of which its point's angle is taken so as not to jump.

        Raises IntentError for a dyad whose point circles its ground pivot: its output would rotate.
        """
        angles: tuple[float, ...] = ()
        theta: Array = np.linspace(0.0, TURN, _LOOKS, endpoint=False)
        for loop, dyad in enumerate(self.dyads):
            s, s1 = (lift.c[0] for lift in self._lifts(theta, 0))
            theta = theta[(self.chain.margins(loop, s, s1, angles) > 0).all(axis=0)]
            if not len(theta):
                return (*angles, *(0.0,) * (len(self.dyads) - loop))
            s0, s01 = self._lifts(theta, 0)
            x, y = self.chain.hung(self.chain.solve(s0, s01, angles), loop)
            if len(theta) == _LOOKS and abs(dyad.turned(x.c[0], y.c[0])) > math.pi:
                raise IntentError(
                    f"the point that dyad {loop + 1} is attached to circles the dyad's ground pivot: its "
                    "output would rotate, not oscillate",
                    "dyads",
                )
            angles = (*angles, dyad.middle(x.c[0], y.c[0]))
        return angles

    @cached_property
    def _relation(self) -> Cells:
        """Shaft angle, rad, and output, rad or mm, over the relative angle, as polynomials good to rounding."""
        self._demand_turning()

        def rows(theta: Array) -> Array:
            at = self.at(theta, 0)
            return np.stack([at.shaft[0], at.output[0]])

        return cells(rows, between(0.0, TURN, self.breaks.tolist()))

    def _demand_turning(self) -> None:
        mobile = self._mobility
        if not mobile.turns:
            what, place = "the shaft would have to turn back", mobile.rate_at
            if mobile.binds:
                what, place = "a loop cannot be closed", mobile.margin_at
            elif math.isnan(mobile.least_rate):
                what = "the linkage is so close to binding that the rate of the shaft is lost in rounding"
            raise PlaceError(what, place, np.zeros(0, dtype=np.intp))

    def _demand_held(self) -> None:
        """Raise IntentError unless the frame touches the cam all round, and the shaft is within it."""
        law, size = self.lift.law, self.breadth

        def lifts(theta: Array) -> Array:
            near, far = np.split(law.derivatives(np.concatenate([theta, theta + math.pi]), 0)[0], 2)
            return np.stack([near, far, near + far - size])

        places = between(0.0, math.pi, [*self.lift.breaks, *(self.lift.breaks - math.pi)])
        within, breadth = 1e-3 * _EDGE * size, 0.01 * _ROUNDED * size
        curves = cells(lifts, places, np.array([within, within, breadth]))
        near, far, off = extremes_of_each(curves)
        miss, at = max(*off[::-1], key=lambda extreme: abs(extreme[0]))
        if not abs(miss) <= _ROUNDED * size:
            degrees = math.degrees(at) % 360
            raise IntentError(
                f"a frame holds cams of constant breadth alone: p(t) + p(t + 180 deg) is {size + miss:.9g} mm "
                f"at {degrees:.6g} degrees, the breadth of the frame {size:.9g} mm",
                "p",
                degrees,
            )
        least, at = min(near[0], (far[0][0], far[0][1] + math.pi))
        if least < -_EDGE * size:
            raise OutsideError(-least, math.degrees(at) % 360)


def _placed(error: BindingError, theta: Array) -> PlaceError:
    return PlaceError(error.message, float(theta[error.indices[0]]), error.indices)
