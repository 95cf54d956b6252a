"""What cams for flat faces on a straight guide have in common: the lift is the support function of the contour."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, cast

import numpy as np

from camgeo.cams.family import Cam, Follower, Intent, Profile
from camgeo.cams.position import LiftPosition, Position
from camgeo.common.rounding import upward
from camgeo.curve.curve import Curve
from kin.law.contacts import Contact, Flat, Translating, opposite
from kin.numeric.distinct import distinct

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.law.piecewise import Piecewise
    from kin.law.support_function import Lift
    from kin.numeric.arrays import Array

SAME_BREADTH = 1e-9  # of the size: a breadth that varies by less is constant
LOOKS = 1440  # shaft angles of a turn at which the breadth is looked at
STRETCH_LOOKS = 16  # and at so many of any stretch between breaks, however short


class FlatFacedCam(Cam):
    """A cam whose follower's face is pushed along its normal."""

    def position(self, intent: Intent) -> Position:
        """The lift."""
        lift = cast("Lift", intent)
        return LiftPosition(lift, lift.datum)

    def profile(self, intent: Intent) -> Profile:
        """The envelope of the face (AS eqs. 2, 3; SW eqs. 14, 17)."""
        from camgeo.curve.support import SupportShape
        from kin.law.support_function import Lift

        if not isinstance(intent, Lift):
            raise TypeError("a motion law of an arm is no motion of a single flat face")
        whole = Curve.whole(SupportShape(intent))
        return Profile(whole, whole, 0.0)

    def follower(self, intent: Intent, *, framed: bool) -> Follower:
        """A yoke where two parallel faces fit the cam, else one face."""
        mean, deviation, _ = breadth_of(cast("Lift", intent))
        yoke = self.always_in_a_yoke or is_constant(mean, deviation)
        name = "square frame" if framed else "yoke" if yoke else "flat face"
        if not yoke:
            return Follower(name, (Contact(Translating(), Flat()),), ("contact-travel",))
        return Follower(name, opposite(Flat(), mean), ("constant-breadth", "contact-travel"), "constant-breadth")

    def contact_place(self, intent: Intent, profile: Profile) -> Callable[[Array], Array]:  # noqa: ARG002
        """From the line through the shaft, along the face: p'."""
        lift = cast("Lift", intent)
        return lambda t: lift.derivatives(t, 1)[1]

    always_in_a_yoke: ClassVar[bool] = False
    """Whether the motion is given for two faces, so that a breadth that varies is a fault."""

    def law(self, intent: Intent) -> Piecewise:
        """The lift."""
        return cast("Lift", intent).law

    def larger(self, by: float, unit: str = "") -> str:
        """Say how radii of curvature grow by more than `by`, in the recipe's unit."""
        name, share = self.size_field
        if by == 0.0:  # a radius that is 0 needs no more than not to be
            return f"a larger {name}"
        return f"a {name} larger by more than {upward(share * by)} {unit}".rstrip()

    @property
    def size_field(self) -> tuple[str, float]:
        """The key that makes the cam larger all round, and how much of it per unit of radius.

        A constant added to the support function adds as much to every radius (AS eq. 3).
        """
        raise NotImplementedError

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """A larger cam."""
        return f"{self.larger(free_at / mm)} would have no undercut"

    def rounder(self, value: float, limit: float, unit: str) -> str:
        """A larger cam."""
        return self.larger(limit - value, unit)

    def grown_intent(self, intent: Intent, out: float, scale: float) -> Intent:
        """The face farther out."""
        return cast("Lift", intent).moved(out, scale)


def breadth_of(lift: Lift) -> tuple[float, float, float]:
    """Mean breadth p(t) + p(t + pi) in mm, the greatest deviation from it, and where in radians."""
    t = spread(np.mod(lift.breaks, math.pi), math.pi)
    p = lift.derivatives(np.concatenate([t, t + math.pi]), 0)[0]  # continuous: one side of a break will do
    breadth = p[: len(t)] + p[len(t) :]
    mean = 0.5 * float(breadth.max() + breadth.min())
    worst = int(np.argmax(np.abs(breadth - mean)))
    return mean, float(np.abs(breadth[worst] - mean)), float(t[worst])


def is_constant_breadth(lift: Lift) -> bool:
    """Whether a yoke of two parallel faces fits the cam; else it works a single flat face."""
    return is_constant(*breadth_of(lift)[:2])


def is_constant(mean: float, deviation: float) -> bool:
    """Whether a breadth that deviates from its mean by so much is constant."""
    return deviation <= SAME_BREADTH * abs(mean)


def spread(breaks: Array, end: float) -> Array:
    """Evenly spread parameters in [0, end) with the breaks among them, and some between any two breaks."""
    inside = breaks[(breaks >= 0.0) & (breaks < end)]
    between = np.linspace(inside[:-1], inside[1:], STRETCH_LOOKS + 1)[:-1].ravel()
    return distinct(np.concatenate([np.linspace(0.0, end, LOOKS, endpoint=False), between, inside]))
