"""Size and motion of a disc cam: one touch on one guide, a stem or an arm, on the outside of a disc or in a ring."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from camgeo.cams.conjugate import opposite_face
from camgeo.cams.family import Advice, Circle, ExactCam, Undercut
from camgeo.cams.flat_faced import SizeAdvice
from camgeo.cams.follower import Follower
from camgeo.cams.guided import SMALLER_STROKE, ExactGuided, ExactLed, GuidedCam, Holding, RoundAdvice, shrink_touch
from camgeo.cams.preload import with_preload
from camgeo.cams.surface import Surface
from camgeo.curve.curve import Curve
from kin.law.contacts import Arrangement, Contact, Flat, Oscillating, Shoe, Translating
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.cams.family import Preload
    from camgeo.curve import moving_frame
    from camgeo.curve.disc import Face
    from camgeo.curve.moving_frame import Displacement
    from camgeo.motions.motion import MotionSource, Open
    from kin.law.contacts import Guide, Side, Touch
    from kin.law.joints import DerivativeJump
    from kin.law.sources.motion import Kept, Motion


@dataclass(frozen=True, kw_only=True)
class DiscCam(GuidedCam):
    """Size and motion of a disc cam.

    `base_radius`, mm, is the radius of the cam's circle at displacement 0; `side` is 1 for metal inside the contour,
    -1 for a ring. `beyond` is how far the lobe reaches along the shaft from the axis of a round tappet, mm; 0 under a
    straight face.
    """

    kind: ClassVar[str] = "disc"
    base_radius: float
    guide: Guide
    touch: Touch
    motion: MotionSource
    undercut: Undercut
    side: Side = 1
    beyond: float = 0.0
    holding: Holding = Holding()
    preload: Preload | None = None

    @property
    def arrangement(self) -> Arrangement:
        """Guide and touch, with one contact, or one on each of two discs."""
        discs = self.holding.discs
        return Arrangement(type(self.guide), type(self.touch), discs, discs)

    @property
    def open(self) -> Open | None:
        """Angles that the motion leaves open; None where all are given."""
        return self.motion.open

    @property
    def stated_motion(self) -> MotionSource:
        """Motion as the recipe has it."""
        return self.motion

    def with_motion(self, motion: MotionSource) -> DiscCam:
        """The cam of the same size and follower for another motion."""
        return replace(self, motion=motion)

    def exact(self, *, framed: bool = False) -> ExactCam:  # noqa: ARG002 - the protocol's
        """The cam with its displacement over a whole turn, 0 where it is lowest, and its preload.

        Raises IntentError for a motion that does not join or that the guide cannot follow, and for a preload of a
        follower with one contact or greater than its roller's radius.
        """
        return with_preload(self.nominal(), self.preload)

    def nominal(self) -> ExactCam:
        """The exact cam without its preload; raises IntentError for a motion whose S or S' does not join."""
        from camgeo.curve.moving_frame import Displacement

        law = Displacement.of(self._turn.demand_joined("motion", "mm" if self.guide.unit == "mm" else "rad"))
        return ExactFaced(self, law) if isinstance(self.touch, Flat) else ExactGuided(self, law)

    @cached_property
    def _turn(self) -> Motion:
        flanks = [flank for flank in self.holding.flanks(self.touch, self.side) if flank.disc == 0]
        within = len(flanks) - 1 if self.side > 0 else -1
        motion = self.motion.for_follower(self._contact, within)
        return motion.motion(2.0 * math.pi, "motion", 1)

    def _contact(self) -> Contact[Guide, Touch]:
        return Contact(self.guide, self.touch, self.datum)

    def joints(self) -> tuple[DerivativeJump, ...]:
        """Joints of the motion over the turn, or over the part of a turn that repeats."""
        return self._turn.joints

    def kept(self) -> Kept | None:
        """Record of how the motion keeps the rows of its table, mm or rad; None without a table or cam card.

        It has the greatest distance from a row, the row's line, and remarks.
        """
        return self._turn.kept

    def follower(self, law: Displacement) -> Follower:  # noqa: ARG002 - the motion has no say in it
        """The follower with a contact on every flank; `face-width` is checked where a face has a width."""
        checks: tuple[str, ...] = ("pressure-angle",)
        if isinstance(self.touch, Flat):
            checks += ("contact-travel",) if self.touch.width is None else ("contact-travel", "face-width")
        first, name = self._contact(), f"{self.guide.word} {self.touch.word}"
        holding = self.holding
        return Follower(holding.follower_name(name), holding.contacts(first), checks, holding.closure)

    @property
    def datum(self) -> float:
        """Position of the contact at displacement 0: foot or level on a line, mm, angle of an arm, rad.

        Raises IntentError where the guide does not reach the base or prime circle.
        """
        match self.guide, self.touch:
            case Translating(offset=offset), Flat(tilt=tilt):
                return (self.base_radius - offset * math.sin(tilt)) / math.cos(tilt)
            case Oscillating(pivot=pivot), Flat(nearer=nearer):
                from camgeo.curve.disc import rest_of

                return rest_of(self.base_radius, pivot, nearer)
        return self.centre_guide.datum

    @property
    def advice(self) -> Advice:
        """Remedies by the touch and by the way it is held."""
        return self.holding.advice(self, self.own_advice)

    @property
    def own_advice(self) -> Advice:
        """Remedies for a cam with one contact."""
        larger, trims = self.holding.larger, self.holding.trims
        if isinstance(self.touch, Flat):
            beside = " with arm.face smaller by as much" if isinstance(self.guide, Oscillating) else self.holding.beside
            return SizeAdvice(
                beside=beside, beyond=self.beyond, free="be free of it", larger=larger, less_steep=SMALLER_STROKE
            )
        return RoundAdvice(self, larger=larger, less_steep=SMALLER_STROKE, radius_field=self.radius_field, trims=trims)

    @property
    def radius_field(self) -> str:
        """Name of the radius of the touch in advice."""
        return "shoe radius" if isinstance(self.touch, Shoe) else "roller radius"

    @property
    def prime(self) -> float:
        """Radius of the prime circle, mm; raises IntentError where the roller does not fit the opening."""
        from kin.law.normalised import IntentError

        prime = self.base_radius + self.side * self.touch.radius
        if not prime > 0.0:
            raise IntentError(
                "the roller does not fit the opening: its radius is not below the base radius", "follower"
            )
        return prime

    @property
    def centre_guide(self) -> moving_frame.Guide:
        """Guide of the centre of a round touch: a line of travel, or an arm.

        Raises IntentError where the guide does not reach the prime circle, or the roller does not fit the opening, and
        ValueError for an arm without a length.
        """
        from camgeo.curve import moving_frame

        if isinstance(self.guide, Translating):
            return moving_frame.Translating.on(self.prime, self.guide.offset)
        return moving_frame.Oscillating.on(self.prime, self.guide.pivot, self.guide.arm, self.guide.side)

    def face(self, motion: Displacement) -> Face:
        """The flat face over the shaft angle.

        Raises IntentError for a face that cannot be driven and TypeError for a round touch.
        """
        from camgeo.curve.disc import StraightFace, SwingingFace

        if not isinstance(self.touch, Flat):
            raise TypeError("a round touch has no face")
        if isinstance(self.guide, Translating):
            return StraightFace(motion, self.base_radius, self.touch.tilt, self.guide.offset)
        return SwingingFace.on(motion, self.base_radius, self.guide.pivot, self.touch.nearer, self.guide.side)

    def circles(self) -> tuple[Circle, ...]:
        """The base circle, tangent to a face at displacement 0, and the prime circle of a roller or shoe."""
        return super().circles() if self.touch.radius else (Circle("base circle", self.base_radius),)

    def resized(self, base: float, pivot: float | None = None, holding: Holding | None = None) -> DiscCam:
        """Copy with the base radius `base`, mm, and, unless None, the distance of an arm's pivot, mm, and a holding."""
        guide = self.guide if pivot is None or isinstance(self.guide, Translating) else replace(self.guide, pivot=pivot)
        return replace(self, base_radius=base, guide=guide, holding=holding or self.holding)

    def grow(self, out: float, scale: float) -> DiscCam:
        """Copy for metal grown by `out` mm, then all lengths times `scale`.

        A round touch is smaller on the same pitch curve; under a flat face the base circle is larger. Raises GrownError
        where nothing of a round touch is left.
        """
        match self.guide:
            case Translating(offset=offset):
                guide: Guide = Translating(scale * offset)
            case Oscillating(pivot=pivot, side=side, length=length):
                guide = Oscillating(scale * pivot, side, None if length is None else scale * length)
        touch, more = self.touch, out if isinstance(self.touch, Flat) else self.side * out
        if isinstance(touch, Flat):
            # on an arm the swing stays, and the face stands farther from its parallel through the pivot
            nearer = scale * (touch.nearer - out) if isinstance(self.guide, Oscillating) else 0.0
            touch = Flat(touch.tilt, None if touch.width is None else scale * touch.width, nearer)
        else:
            touch = shrink_touch(touch, out, scale)
        base = scale * (self.base_radius + more)
        holding = self.holding.grow(out, scale, flat=isinstance(touch, Flat))
        return replace(self, base_radius=base, guide=guide, touch=touch, holding=holding)


@dataclass(frozen=True, eq=False)
class ExactFaced(ExactLed):
    """A disc cam under a flat face."""

    cam: DiscCam

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """Surface of each contact, the envelope of its flat face (`camgeo.curve.disc`), over the shaft angle."""
        from camgeo.curve.disc import face_shape

        flanks, (_, *opposite) = self.flanks, self.follower.contacts
        faces = [self.cam.face(self.law), *(opposite_face(self.law, contact) for contact in opposite)]
        surfaces = []
        for face, flank in zip(faces, flanks, strict=True):
            whole = Curve.whole(face_shape(face))
            series = {"slope": face.slope, "contact": face.contact}
            pressure, place = face.pressure_angle, face.place
            surface = Surface(whole, whole, pressure=pressure, place=place, series=series, name=flank.name)
            surfaces.append(replace(surface, disc=flank.disc))
        return tuple(surfaces)
