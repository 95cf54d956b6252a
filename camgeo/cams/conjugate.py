"""Conjugate discs: a second contact of the same stem or arm on a disc of its own, which drives the follower back.

The second roller stands `apart` from the first with the shaft between them, the second arm of a bell crank at that
angle from the first, a second face opposite it (Wunderlich 1971, section 1, the "second cam integral with the first").
Its position is `apart` less the first contact's, so that on its own disc it is an ordinary follower: on a stem half a
turn on, with the offset on the other side; on an arm that leads where the first one trails.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from camgeo.cams.family import Circle
from camgeo.cams.flat_faced import SizeAdvice
from camgeo.cams.guided import (
    LARGER_BASE,
    MARGIN,
    Flank,
    Holding,
    RoundAdvice,
    base_size,
    centre_guide_of,
    least_prime_for_roller,
    shrink_touch,
)
from camgeo.common.rounding import upward
from camgeo.schema.fields import MOST, Field, Kind, length, mapping
from kin.law.contacts import LEADING, TRAILING, Contact, Flat, Oscillating, Translating
from kin.law.normalised import IntentError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.cams.family import Advice
    from camgeo.cams.guided import ExactGuided, GuidedCam
    from camgeo.curve import moving_frame
    from camgeo.curve.disc import Face
    from camgeo.curve.moving_frame import Displacement
    from camgeo.schema.reader import Reader, Values
    from kin.law.contacts import Guide, Side, Touch
    from kin.numeric.arrays import Array

FIRST, SECOND = "disc 1", "disc 2"
"""Names of the two surfaces."""
RADIUS = "conjugate.radius"
FEASIBLE = 1e-11  # of the distance: by so much a limit may be missed


@dataclass(frozen=True)
class Conjugate(Holding):
    """Second contact of a follower on conjugate discs: its touch and its distance `apart` from the first, mm or rad.

    `length` is the length of a bell crank's second arm, mm; None on a stem.
    """

    closure: ClassVar[str] = "form-closure"
    discs: ClassVar[int] = 2
    touch: Touch
    apart: float
    length: float | None = None

    @property
    def key(self) -> str:
        """The recipe's key for the distance of the contacts."""
        return "conjugate.distance" if self.length is None else "conjugate.angle"

    @property
    def larger(self) -> str:
        """Words for a larger base radius of disc 1 and a larger distance: disc 1 alone would leave less to disc 2."""
        return f"{LARGER_BASE} and {self.key}"

    @property
    def beside(self) -> str:
        """Words for the distance of the contacts, which must grow with the base radius so that disc 2 stays."""
        return f" with a {self.key} larger by as much"

    @property
    def second_arm(self) -> tuple[float, float] | None:
        """Length of the second arm of a bell crank, mm, and the angle between both, rad; None on a stem."""
        return None if self.length is None else (self.length, self.apart)

    def follower_name(self, name: str) -> str:
        """Name of the follower in reports: `name`, of its guide and touch, followed by `on conjugate discs`."""
        return f"{name} on conjugate discs"

    def flanks(self, touch: Touch, side: Side) -> tuple[Flank, ...]:
        """Flanks of both discs, in their order: `touch` runs on disc 1, and the metal of both lies on `side`."""
        return Flank(FIRST, side, touch.radius), Flank(SECOND, side, self.touch.radius, disc=1)

    def contacts(self, first: Contact[Guide, Touch]) -> tuple[Contact[Guide, Touch], ...]:
        """Contacts of the follower: the first on disc 1, and the opposite one on disc 2, which pushes it back."""
        guide, datum = first.guide, self.apart - first.datum
        if isinstance(guide, Translating):
            second = Contact(Translating(-guide.offset), self.touch, datum, -1, turned=math.pi, surface=SECOND)
            return replace(first, surface=FIRST), second
        side = LEADING if guide.side == TRAILING else TRAILING
        arm = Oscillating(guide.pivot, side, self.length)
        return replace(first, surface=FIRST), Contact(arm, self.touch, datum, -1, surface=SECOND)

    def demand(self, first: Contact[Guide, Touch], greatest: float) -> None:
        """Raise IntentError where disc 2 has no base circle at the follower's greatest displacement, mm or rad."""
        _, second = self.contacts(first)
        radius, guide = self.touch.radius, second.guide
        if isinstance(guide, Translating):
            # where the roller's centre passes the shaft nearer than its radius no contour is left
            nearest = 0.0 if isinstance(self.touch, Flat) else math.sqrt(max(radius**2 - guide.offset**2, 0.0))
            factor, unit = 1.0, "mm"
        else:
            nearest, factor, unit = _swing(guide.pivot, guide.arm, radius), math.degrees(1.0), "degrees"
        if second.datum - greatest > nearest:
            return
        least = upward(factor * (first.datum + greatest + nearest))
        article = "an" if self.length is not None else "a"
        word = self.key.rpartition(".")[2]
        raise IntentError(
            f"disc 2 would have no base circle at the greatest displacement; {article} {word} above {least} {unit} "
            "leaves one",
            self.key,
        )

    def grow(self, out: float, scale: float, *, flat: bool) -> Conjugate:
        """Copy for metal grown by `out` mm, then lengths times `scale`.

        The second roller is smaller, or, with `flat`, the faces are farther apart. Raises GrownError where nothing of
        that roller is left.
        """
        gap = scale * self.gap
        if flat:
            return replace(self, apart=scale * (self.apart + 2.0 * out), gap=gap)
        touch = shrink_touch(self.touch, out, scale)
        if self.length is None:
            return replace(self, touch=touch, apart=scale * self.apart, gap=gap)
        return replace(self, touch=touch, length=scale * self.length, gap=gap)

    def advice(self, cam: GuidedCam, own: Advice) -> Advice:
        """Advice with another distance, angle or second roller for disc 2, so that disc 1 stays as it is."""
        larger, steep = f"a larger {self.key}", own.less_steep
        if isinstance(self.touch, Flat):
            second: Advice = SizeAdvice(size=self.key, free="be free of it", larger=larger, less_steep=steep)
        else:
            second = SecondAdvice(cam, self.touch.radius, larger=larger, less_steep=steep, radius_field=RADIUS)
        return replace(own, others={SECOND: second})

    def circles(self, surface: str, own: tuple[Circle, ...]) -> tuple[Circle, ...]:
        """Reference circles of a surface's disc: `own` for disc 1, one at the least distance of disc 2's curve."""
        if surface != SECOND:
            return own
        return (Circle("base circle" if isinstance(self.touch, Flat) else "prime circle"),)

    def least_stem(
        self, law: Displacement, angles: tuple[float, float], offset: float | None
    ) -> moving_frame.Translating:
        """Stem with the least prime circle of disc 1 that keeps `angles`, on rise and return, rad, on both discs.

        An `offset`, mm, is kept; for None the best is found. Raises IntentError for contacts that are not far enough
        apart, a motion that stands still, and an angle that is not between 0 and 90 degrees.
        """
        return least_pair(law, *angles, self.apart, offset)

    def gentler_size(
        self, exact: ExactGuided, rising: float, falling: float, mm: float
    ) -> tuple[str, GuidedCam] | None:
        """A size in words and the cam of that size, with pressure angles within both limits on both discs.

        The limits are `rising` on the rise and `falling` on the return, rad. For an arm the size is a base radius and
        the pivot's distance; for a stem a base radius, and where needed a larger distance between the contacts. None if
        unknown.
        """
        from camgeo.cams import least_size
        from camgeo.curve import moving_frame

        cam, guide = exact.cam, exact.follower.contacts[0].guide
        if not isinstance(guide, Translating):
            # where two limits meet, rounding of the size would break one
            angles = rising - MARGIN, falling - MARGIN
            try:
                arm = least_size.least_arm(exact.law, guide.arm, guide.side, *angles, second=self.second_arm)
            except IntentError:
                return None
            return base_size(cam, arm.prime, mm, arm.pivot)
        # the base radius that disc 1 needs, then the distance that disc 2 needs with it
        advised = base_size(cam, least_size.least_stem(exact.law, rising, falling, guide.offset).prime, mm)
        if advised is None:
            return None
        sentence, resized = advised
        stem = moving_frame.Translating.on(resized.base_radius + cam.touch.radius, guide.offset)
        least = least_apart(exact.law, rising, falling, stem)
        if least <= self.apart:
            return sentence, resized
        apart = upward(least / mm)
        farther = replace(self, apart=float(apart) * mm)
        return f"{sentence} and a {self.key} of {apart}", resized.resized(resized.base_radius, None, farther)

    def rounder(self, surface: str, exact: ExactGuided, mm: float) -> str:
        """Words for the size at which a surface's roller is half the pitch curve's least convex radius, or empty.

        The size is the base radius for disc 1, the distance or angle of the contacts for disc 2.
        """
        if surface != SECOND:
            return Holding.rounder(self, surface, exact, mm)
        first, second = exact.follower.contacts
        guide, roller = centre_guide_of(second), self.touch.radius
        prime = least_prime_for_roller(exact.law.scaled(-1.0), guide, roller)
        if prime is None:
            return ""
        factor = 1.0 / mm if self.length is None else math.degrees(1.0)
        apart = upward(factor * (first.datum + guide.resized(prime).datum))
        return f"a {self.key} of {apart}"


@dataclass(frozen=True)
class SecondAdvice(RoundAdvice):
    """Advice for the roller on disc 2, whose radius, `roller` in mm, changes that disc alone."""

    roller: float

    @property
    def radius(self) -> float:
        """Radius of the roller on disc 2, mm."""
        return self.roller

    def same_pitch(self, mm: float) -> str:  # noqa: ARG002 - the protocol's
        """Empty: the pitch curve depends on the distance, not on the roller."""
        return ""

    @property
    def most_radius(self) -> float:
        """Least distance of disc 2's pitch curve from the shaft, mm: a roller so large leaves no base circle."""
        from camgeo.curve.measures import nearest

        _, second = self.cam.exact().surfaces
        return nearest(second.base).value


def _swing(pivot: float, arm: float, radius: float) -> float:
    """Angle at the pivot, rad, at which an arm's end is a radius from the shaft, mm; 0 where it never comes so near."""
    cosine = (pivot**2 + arm**2 - radius**2) / (2.0 * pivot * arm)
    return math.acos(cosine) if cosine < 1.0 else 0.0


# --- least sizes -----------------------------------------------------------------------------------------------------


def least_pair(
    motion: Displacement, rising: float, falling: float, apart: float, offset: float | None = None
) -> moving_frame.Translating:
    """Stem with the least prime circle of disc 1 that keeps both pressure angles on both of two conjugate discs.

    The angles are `rising` on the follower's rise and `falling` on its return, rad. The contacts are `apart`, mm. An
    `offset`, mm, is kept; for None the best is found. Raises IntentError for contacts that are not far enough apart, a
    motion that stands still, and an angle that is not between 0 and 90 degrees.
    """
    from camgeo.cams import least_size
    from camgeo.curve import moving_frame

    # the distance of the contacts suffices where some foot keeps the limits of both discs
    a, b = 1.0 / math.tan(rising), 1.0 / math.tan(falling)
    rows = np.array(_pair_rows(motion, rising, falling))
    if offset is None:  # least where two limits of one disc meet
        crossing = [(rows[i, 2] - rows[i + 1, 2]) / (rows[i, 1] - rows[i + 1, 1]) for i in (0, 2)]
        least = min(_least_apart(rows, e) for e in crossing)
    else:
        least = _least_apart(rows, offset)
    if apart < least:
        raise IntentError(
            f"no base radius keeps the pressure angles on both discs; a distance of at least {upward(least)} mm does",
            "conjugate.distance",
        )
    if offset is not None:
        return moving_frame.Translating(
            least_size.positive_foot(float((rows[:2, 2] - rows[:2, 1] * offset).max())), offset
        )
    # the foot d and the offset e nearest to the shaft within all four half planes, their rows of normals of length 1
    rows[2:, 2] -= apart
    scale = np.hypot(1.0, np.array([a, b, b, a]))
    d, e = least_size.nearest_in(rows / scale[:, None], np.zeros(2), FEASIBLE * apart)
    return moving_frame.Translating(least_size.positive_foot(float(d)), float(e))


def _pair_rows(motion: Displacement, rising: float, falling: float) -> list[tuple[float, float, float]]:
    """Rows (x, y, c) of ``x d + y e >= c`` for a stem's foot d and offset e, mm: two of disc 1, then two of disc 2.

    The last two lack the distance of the contacts, by which c is less. Disc 2 drives the return, so that its own rise
    has the limit `falling`.
    """
    from camgeo.cams import least_size

    a, b = 1.0 / math.tan(rising), 1.0 / math.tan(falling)
    (up, down), (back, forth) = (
        least_size.stem_needs(motion, rising, falling),
        least_size.stem_needs(motion.scaled(-1.0), falling, rising),
    )
    return [(1.0, a, up), (1.0, -b, down), (-1.0, -b, back), (-1.0, a, forth)]


def _least_apart(rows: Array, offset: float) -> float:
    """Least distance of two contacts on a stem of this offset, mm, by the rows (4, 3) of both discs.

    Where both discs' rows hold with equality the foot of the stem cancels.
    """
    needs = rows[:, 2] - rows[:, 1] * offset
    return float(needs[:2].max() + needs[2:].max())


def least_apart(motion: Displacement, rising: float, falling: float, stem: moving_frame.Translating) -> float:
    """Least distance between the rollers' centres, mm, at which disc 2 keeps the pressure angles on a stem.

    They are `rising` on the follower's rise and `falling` on its return, rad. Raises IntentError for an angle that is
    not between 0 and 90 degrees.
    """
    rows = np.array(_pair_rows(motion, rising, falling))
    return stem.foot + float((rows[2:, 2] - rows[2:, 1] * stem.offset).max())


def opposite_face(motion: Displacement, contact: Contact[Guide, Touch]) -> Face:
    """Face of the second contact, opposite the first face, over the shaft angle; `motion` is the first face's."""
    from camgeo.curve.disc import StraightFace

    guide = contact.guide
    offset = guide.offset if isinstance(guide, Translating) else 0.0
    return StraightFace(motion.scaled(-1.0), contact.zero, 0.0, offset, contact.turned)


# --- in a recipe ------------------------------------------------------------------------------------------------------

CONJUGATE = mapping(
    "conjugate",
    "a second disc on the same shaft, whose contact on the same stem or arm drives the follower back",
    length("radius", "radius of the second roller or shoe", default="that of the follower"),
    length("distance", "on a stem, between the rollers' centres with the shaft between them, or between the faces"),
    length("length", "of the second arm of a bell crank, from the pivot to the roller's centre"),
    Field("angle", Kind.ANGLE, "at the pivot between both arms, the shaft's line within it", above=0, at_most=359),
    Field("gap", Kind.LENGTH, "from the top face of disc 1 to disc 2 above it", default="0", at_least=0, at_most=MOST),
)


def check_conjugate(cam: Values, reader: Reader) -> None:
    """Note keys that do not go with a second disc, and those that it lacks."""
    follower, path = cam.get("follower", {}), "cam.conjugate"
    kind, arm, conjugate = follower.get("kind", "roller"), "arm" in follower, cam["conjugate"]
    if "track" in cam and cam["track"] != "external":
        reader.fault_at("cam.track", "conjugate discs are followed from outside", None, "leave it out, or conjugate")
        return
    if kind == "knife-edge" or (kind == "flat" and arm):
        remedy = "give a roller, or leave conjugate out"
        touch = "a knife edge" if kind == "knife-edge" else "a flat face on an arm"
        reader.fault_at("cam.follower.kind", f"{touch} has no conjugate disc", None, remedy)
        return
    if kind == "flat" and follower.get("tilt", 0.0):
        reader.fault_at("cam.follower.tilt", "two faces on conjugate discs stand across the stem", None, "leave it out")
    required = {"length", "angle"} if arm else {"distance"}
    for name in ("distance", "length", "angle"):
        if name in required and name not in conjugate and f"{path}.{name}" not in reader.marks:
            reader.fault(reader.marks[path], f"{path}.{name}", "missing", None, _WANTED[name])
        elif name in conjugate and name not in required:
            guide = "an arm" if arm else "a stem"
            reader.fault_at(f"{path}.{name}", f"does not belong to {guide}", None, "leave it out")
    if kind == "flat" and "radius" in conjugate:
        reader.fault_at(f"{path}.radius", "a flat face has none", None, "leave it out")


_WANTED = {
    "distance": "give a length above 0, from one contact to the other with the shaft between them",
    "length": "give a length above 0, of the second arm",
    "angle": "give an angle in degrees, at the pivot between both arms",
}


def conjugate_of(values: Values, touch: Touch) -> Conjugate:
    """The second contact of values without fault, with the first contact's `touch` but for a radius of its own."""
    if "radius" in values:
        touch = replace(touch, radius=values["radius"])
    apart = values["angle"] if "angle" in values else values["distance"]
    return Conjugate(touch, apart, values.get("length"), gap=values.get("gap", 0.0))
