"""Cams for flat faces whose lift is the support function of the contour, and advice for all flat faces."""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from camgeo.cams.family import Advice, Cam, ExactCam, Proof
from camgeo.cams.follower import Follower
from camgeo.cams.preload import with_preload
from camgeo.cams.surface import Surface
from camgeo.common.rounding import upward
from camgeo.curve.curve import Curve
from camgeo.motions.position import LiftPosition, Position
from kin.law.contacts import Arrangement, Contact, Flat, Translating, opposite
from kin.numeric.angles import degrees
from kin.numeric.distinct import distinct
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.cams.family import Preload
    from kin.law.contacts import Guide, Touch
    from kin.law.joints import DerivativeJump
    from kin.law.piecewise import Piecewise
    from kin.law.support_function import Lift
    from kin.numeric.arrays import Array

SAME_BREADTH = 1e-9  # of the size: a breadth that varies by less is constant
LOOKS = 1440  # shaft angles at which the breadth is sampled
STRETCH_LOOKS = 16  # samples of each stretch between breaks, however short


@dataclass(frozen=True)
class SizeAdvice(Advice):
    """Advice for a flat face: a larger cam, by the key `size`, which grows by `share` per unit of radius.

    `beside` are words for what grows with it, `free` ends the sentence on undercut. `beyond` is how far the lobe
    reaches along the shaft from the axis of a round tappet, mm; 0 for a straight face.
    """

    size: str = "base radius"
    share: float = 1.0
    beside: str = ""
    beyond: float = 0.0
    free: str = "have no undercut"

    def wider_face(self, width: float, mm: float) -> str:
        """Words for the width of a face, or the diameter of a round tappet that is so wide at the lobe's farther edge.

        `width` is in the recipe's unit.
        """
        across = upward(math.hypot(width, 2.0 * self.beyond / mm))
        return f"a follower.diameter of {across}" if self.beyond else super().wider_face(width, mm)

    def enlarge(self, growth: float, unit: str = "") -> str:
        """Words for a larger size that raises all radii of curvature by more than `growth`; both are in `unit`."""
        if growth == 0.0:  # a radius that is 0 needs no more than not to be
            return f"a larger {self.size}{self.beside}"
        return f"{f'a {self.size} larger by more than {upward(self.share * growth)} {unit}'.rstrip()}{self.beside}"

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Words for a size without undercut; `free_at` is the growth of all radii of curvature that it takes, mm."""
        return f"{self.enlarge(free_at / mm)} would {self.free}"

    def rounder(self, value: float, limit: float, unit: str) -> str:
        """Words for a size that raises the least radius of curvature from `value` beyond `limit`, in `unit`."""
        return self.enlarge(limit - value, unit)


class FlatFacedCam(Cam):
    """A cam whose follower's face is pushed along its normal; a linkage can carry it in a square frame."""

    always_in_a_yoke: ClassVar[bool] = False
    """Whether the motion is for two faces, so that a varying breadth is a fault."""
    preload: Preload | None

    @property
    def arrangement(self) -> Arrangement:
        """Translating flat follower: one face, or a yoke of two parallel faces where the breadth is constant."""
        return Arrangement(Translating, Flat, 2)

    @property
    def touch(self) -> Flat:
        """A flat face without a given width."""
        return Flat()

    @abstractmethod
    def lift(self) -> Lift:
        """Distance of the face from the shaft over the shaft angle, mm.

        Raises IntentError for a motion or a function that no cam has.
        """

    def exact(self, *, framed: bool = False) -> ExactCam:
        """The cam with its support function, and its preload; `framed` names the follower a square frame.

        Raises IntentError for a support function that no cam has, and for a preload of a single face.
        """
        return with_preload(ExactLifted(self, self.lift(), framed), self.preload)

    def joints(self) -> tuple[DerivativeJump, ...]:
        """Angles at which derivatives of the recipe's motion jump."""
        return ()

    def surface(self, whole: Curve) -> Surface:
        """Surface of the disc for the envelope of the face as a whole curve; a family may put corners on it."""
        return Surface(whole, whole)

    @abstractmethod
    def grow(self, out: float, scale: float) -> FlatFacedCam:
        """Copy whose lengths in drawings are for metal grown by `out`, mm, then multiplied by `scale`.

        It is the cam itself where drawings show none of its lengths.
        """


@dataclass(frozen=True, eq=False)
class ExactLifted(ExactCam):
    """A flat-faced cam with its lift; `framed` where a linkage carries it in a square frame.

    `contacts` are given for a cam grown from another; without them they follow from the breadth.
    """

    cam: FlatFacedCam
    law: Lift
    framed: bool = False
    contacts: tuple[Contact[Guide, Touch], ...] = ()

    @cached_property
    def follower(self) -> Follower:
        """A yoke where two parallel faces fit the cam, else one face."""
        contacts = self.contacts
        if not contacts:
            mean, deviation, _ = self._breadth
            yoke = self.cam.always_in_a_yoke or is_constant(mean, deviation)
            contacts = opposite(Flat(), mean) if yoke else (Contact(Translating(), Flat()),)
        two = len(contacts) > 1
        name = "square frame" if self.framed else "yoke" if two else f"{Translating.word} {Flat.word}"
        if not two:
            return Follower(name, contacts, ("contact-travel",))
        return Follower(name, contacts, ("constant-breadth", "contact-travel"), "constant-breadth")

    @cached_property
    def _breadth(self) -> tuple[float, float, float]:
        return breadth_of(self.law)

    @cached_property
    def motion(self) -> Position:
        """Position of the face over the shaft angle: its lift from the datum, mm."""
        return LiftPosition(self.law, self.law.datum)

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """Surface of the disc, in a tuple of one: the envelope of the face (AS eqs. 2, 3; SW eqs. 14, 17)."""
        from camgeo.curve.support import SupportShape

        shape = SupportShape(self.law)
        return (replace(self.cam.surface(Curve.whole(shape)), place=shape.place),)

    @property
    def judged_law(self) -> Piecewise:
        """Lift over the shaft angle, mm, as pieces, by which kin judges the files."""
        return self.law.law

    @cached_property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Joints of the recipe's motion."""
        return self.cam.joints()

    @property
    def plate(self) -> Lift:
        """Support function of the cam's outline, mm, over the shaft angle: distance of the face from the shaft."""
        return self.law

    @property
    def proofs(self) -> Mapping[str, Callable[[], Proof]]:
        """Check of the motion, by its name: whether the breadth is constant, for a yoke."""
        return {"constant-breadth": self._constant_breadth}

    def _constant_breadth(self) -> Proof:
        """Constancy of the breadth, for a yoke (AS eq. 4)."""
        mean, deviation, place = self._breadth
        limit = SAME_BREADTH * abs(mean)
        return Proof(deviation <= limit, deviation, limit, "mm", degrees(place))

    def grow(self, out: float, scale: float) -> ExactLifted:
        """The cam with its faces `out` mm farther out, then all lengths multiplied by `scale`."""
        first, *second = self.follower.contacts
        contacts = (first, *(replace(contact, datum=scale * (contact.datum + 2.0 * out)) for contact in second))
        return ExactLifted(self.cam.grow(out, scale), self.law.moved(out, scale), self.framed, contacts)


def breadth_of(lift: Lift) -> tuple[float, float, float]:
    """Middle of the least and the greatest breadth p(t) + p(t + pi), greatest deviation from it, mm, and its place.

    The place is a shaft angle in [0, pi), rad.
    """
    t = spread(np.mod(lift.breaks, math.pi), math.pi)
    p = lift.derivatives(np.concatenate([t, t + math.pi]), 0)[0]  # continuous: one side of a break will do
    breadth = p[: len(t)] + p[len(t) :]
    mean = 0.5 * float(breadth.max() + breadth.min())
    worst = int(np.argmax(np.abs(breadth - mean)))
    return mean, float(np.abs(breadth[worst] - mean)), float(t[worst])


def is_constant_breadth(lift: Lift) -> bool:
    """Whether a yoke of two parallel faces fits the cam."""
    return is_constant(*breadth_of(lift)[:2])


def is_constant(mean: float, deviation: float) -> bool:
    """Whether a breadth with this mean and greatest deviation, mm, counts as constant."""
    return deviation <= SAME_BREADTH * abs(mean)


def spread(breaks: Array, end: float) -> Array:
    """Parameters in [0, end), rad (n,), rising: evenly spread, at breaks (m,), and some between any two breaks."""
    inside = breaks[(breaks >= 0.0) & (breaks < end)]
    between = np.linspace(inside[:-1], inside[1:], STRETCH_LOOKS + 1)[:-1].ravel()
    return distinct(np.concatenate([np.linspace(0.0, end, LOOKS, endpoint=False), between, inside]))
