"""Size and motion of a disc cam: one touch on one guide, a stem or an arm, on the outside of a disc or in a ring."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from camgeo.cams.conjugate import FIRST, SECOND, Conjugate
from camgeo.cams.family import Advice, Circle, ExactCam, Follower, GrownError, Surface, Undercut
from camgeo.cams.flat_faced import SizeAdvice
from camgeo.cams.groove import Groove, GrooveAdvice
from camgeo.cams.guided import LARGER_BASE, ExactGuided, ExactLed, Flank, GuidedCam, RoundAdvice
from camgeo.curve.curve import Curve
from kin.law.contacts import Arrangement, Contact, Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.cams.motion import MotionAsked
    from camgeo.curve import moving_frame
    from camgeo.curve.disc import Face
    from camgeo.curve.moving_frame import Displacement
    from kin.law.contacts import Guide, Side, Touch
    from kin.law.joints import Joint
    from kin.law.sources.motion import Motion


@dataclass(frozen=True, kw_only=True)
class DiscCam(GuidedCam):
    """Size and motion of a disc cam.

    `beyond` is how far the lobe reaches along the shaft from the axis of a round tappet, mm; 0 under a straight face.
    """

    kind: ClassVar[str] = "disc"
    base_radius: float
    guide: Guide
    touch: Touch
    motion: MotionAsked
    undercut: Undercut
    side: Side = 1
    groove: Groove | None = None
    beyond: float = 0.0
    conjugate: Conjugate | None = None

    @property
    def flanks(self) -> tuple[Flank, ...]:
        """The one that the roller runs on, or both of its groove or pair; `base_radius` is that of the first."""
        if self.conjugate is not None:
            first = Flank(FIRST, 1, self.touch.radius)
            return first, Flank(SECOND, 1, self.conjugate.touch.radius, disc=1)
        return super().flanks if self.groove is None else self.groove.flanks(self.touch.radius)

    @property
    def arrangement(self) -> Arrangement:
        """One touch, which a spring, gravity, a groove or a second disc holds on the cam."""
        discs = 1 if self.conjugate is None else 2
        return Arrangement(type(self.guide), type(self.touch), discs, discs)

    def exact(self, *, framed: bool = False) -> ExactCam:  # noqa: ARG002
        """By the displacement over a whole turn, 0 where it is lowest."""
        from camgeo.curve.moving_frame import Displacement

        law = Displacement.of(self._turn().demand_joined("motion", "mm" if self.guide.unit == "mm" else "rad"))
        return ExactFaced(self, law) if isinstance(self.touch, Flat) else ExactGuided(self, law)

    def _turn(self) -> Motion:
        return self.motion.motion(2.0 * math.pi, "motion", 1)

    def joints(self) -> tuple[Joint, ...]:
        """Those of the turn, or of the part of it that repeats."""
        return self._turn().joints

    def follower(self, law: Displacement) -> Follower:  # noqa: ARG002 - the motion has no say in it
        """One touch, a contact on every flank; where a face's width is given, it must stay on it."""
        checks: tuple[str, ...] = ("pressure-angle",)
        if isinstance(self.touch, Flat):
            checks += ("contact-travel",) if self.touch.width is None else ("contact-travel", "face-width")
        name, first = f"{self.guide.word} {self.touch.word}", Contact(self.guide, self.touch, self.datum)
        if self.conjugate is not None:
            return Follower(f"{name} on conjugate discs", self.conjugate.contacts(first), checks, "form-closure")
        if self.groove is None:
            return Follower(name, (first,), checks)
        contacts = tuple(replace(first, touch=Roller(one.radius), surface=one.name) for one in self.flanks)
        return Follower(name, contacts, checks, "form-closure")

    @property
    def datum(self) -> float:
        """Own position of the contact at displacement 0: foot or level on a line, mm, rest of an arm, rad."""
        match self.guide, self.touch:
            case Translating(offset=offset), Flat(tilt=tilt):
                return (self.base_radius - offset * math.sin(tilt)) / math.cos(tilt)
            case Oscillating(pivot=pivot), Flat(nearer=nearer):
                from camgeo.curve.disc import rest_of

                return rest_of(self.base_radius, pivot, nearer)
        return self.led.datum

    @property
    def advice(self) -> Advice:
        """In the words of the touch."""
        if isinstance(self.touch, Flat):
            beside = " with arm.face smaller by as much" if isinstance(self.guide, Oscillating) else ""
            return SizeAdvice(beside=beside, beyond=self.beyond, free="be free of it", less_steep=LARGER_BASE)
        if self.groove is not None:
            return GrooveAdvice(self, self.groove.clearance, less_steep=LARGER_BASE, trims=False)
        return RoundAdvice(self, less_steep=LARGER_BASE, radius_field=self.radius_field)

    @property
    def radius_field(self) -> str:
        """What the radius of the touch is called."""
        return "shoe radius" if isinstance(self.touch, Shoe) else "roller radius"

    @property
    def prime(self) -> float:
        """Radius of the prime circle, mm; raises IntentError where the roller does not fit the opening."""
        from kin.law.programme import IntentError

        prime = self.base_radius + self.side * self.touch.radius
        if not prime > 0.0:
            raise IntentError(
                "the roller does not fit the opening: its radius is not below the base radius", "follower"
            )
        return prime

    @property
    def led(self) -> moving_frame.Guide:
        """The line of travel, or the arm, of the centre of a round touch."""
        from camgeo.curve import moving_frame

        if isinstance(self.guide, Translating):
            return moving_frame.Translating.on(self.prime, self.guide.offset)
        return moving_frame.Oscillating.on(self.prime, self.guide.pivot, self.guide.arm, self.guide.side)

    @property
    def gap(self) -> float:
        """Axial gap between conjugate discs, mm."""
        return 0.0 if self.conjugate is None else self.conjugate.gap

    def demand(self, law: Displacement) -> None:
        """Raise IntentError where a second disc has no base circle."""
        if self.conjugate is not None:
            self.conjugate.demand(Contact(self.guide, self.touch, self.datum), law.range[1])

    def face(self, motion: Displacement) -> Face:
        """The flat face over the shaft angle; raises IntentError where it cannot be driven."""
        from camgeo.curve.disc import StraightFace, SwingingFace

        if not isinstance(self.touch, Flat):
            raise TypeError("a round touch has no face")
        if isinstance(self.guide, Translating):
            return StraightFace(motion, self.base_radius, self.touch.tilt, self.guide.offset)
        return SwingingFace.on(motion, self.base_radius, self.guide.pivot, self.touch.nearer, self.guide.side)

    def circles(self) -> tuple[Circle, ...]:
        """The base circle, which a face is tangent to at displacement 0, and the prime circle of a round touch."""
        return super().circles() if self.touch.radius else (Circle("base circle", self.base_radius),)

    def second_face(self, motion: Displacement, contact: Contact[Guide, Touch]) -> Face:
        """The face that conjugate discs have opposite, over the shaft angle."""
        from camgeo.curve.disc import StraightFace

        guide = contact.guide
        offset = guide.offset if isinstance(guide, Translating) else 0.0
        return StraightFace(motion.scaled(-1.0), contact.zero, 0.0, offset, contact.turned)

    def resized(self, base: float, pivot: float | None = None) -> DiscCam:
        """With another base radius, and of an arm another pivot."""
        guide = self.guide if pivot is None or isinstance(self.guide, Translating) else replace(self.guide, pivot=pivot)
        return replace(self, base_radius=base, guide=guide)

    def grown(self, out: float, scale: float) -> DiscCam:
        """A smaller roller on the same pitch curve, or a larger base circle under a face."""
        match self.guide:
            case Translating(offset=offset):
                guide: Guide = Translating(scale * offset)
            case Oscillating(pivot=pivot, side=side, length=length):
                guide = Oscillating(scale * pivot, side, None if length is None else scale * length)
        if isinstance(self.touch, Flat):
            width = None if self.touch.width is None else scale * self.touch.width
            # on an arm the same swing of a face that stands farther out
            nearer = scale * (self.touch.nearer - out) if isinstance(self.guide, Oscillating) else 0.0
            face = Flat(self.touch.tilt, width, nearer)
            pair = self.conjugate and self.conjugate.scaled(face, scale, 2.0 * out)
            return replace(self, base_radius=scale * (self.base_radius + out), guide=guide, touch=face, conjugate=pair)
        touch = _less(self.touch, out, scale)
        pair = self.conjugate and self.conjugate.scaled(_less(self.conjugate.touch, out, scale), scale)
        base, groove = scale * (self.base_radius + self.side * out), self.groove and self.groove.scaled(scale)
        return replace(self, base_radius=base, guide=guide, touch=touch, groove=groove, conjugate=pair)


def _less(touch: Touch, out: float, scale: float) -> Touch:
    """A round touch smaller by `out` mm and then scaled; raises GrownError where nothing of it is left."""
    radius, kind = touch.radius, Shoe if isinstance(touch, Shoe) else Roller
    if out > 0.0 and not radius > out:  # a knife edge can become a roller, and be scaled
        raise GrownError("the shoe radius" if kind is Shoe else "the roller's radius", radius)
    left = scale * (radius - out)
    return kind(left) if left else KnifeEdge()


@dataclass(frozen=True, eq=False)
class ExactFaced(ExactLed):
    """A disc cam under a flat face."""

    cam: DiscCam

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """The envelope of the face (`camgeo.curve.disc`), its parameter the shaft angle."""
        from camgeo.curve.disc import face_shape

        self.cam.demand(self.law)
        _, *others = self.follower.contacts
        faces = [self.cam.face(self.law), *(self.cam.second_face(self.law, contact) for contact in others)]
        surfaces = []
        for face, flank in zip(faces, self.cam.flanks, strict=True):
            whole = Curve.whole(face_shape(face))
            series = {"slope": face.slope, "contact": face.contact}
            pressure, place = face.pressure_angle, face.place
            surfaces.append(
                Surface(whole, whole, pressure=pressure, place=place, series=series, name=flank.name, disc=flank.disc)
            )
        return tuple(surfaces)
