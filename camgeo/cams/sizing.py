"""A size in place of a base radius: the least that keeps given pressure angles and a radius of curvature.

`camgeo.cams.least_size` finds it; here it is checked by the exact figures before it is used.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeVar

from camgeo.cams.disc_cams import DiscCam, ExactFaced
from camgeo.cams.family import Advice
from camgeo.cams.guided import SMALLER_STROKE, ExactGuided
from camgeo.common.rounding import NOISE, downward, upward
from camgeo.schema.fields import Field, Kind, length, mapping
from kin.law.contacts import Flat, Oscillating, Translating
from kin.numeric.angles import degrees
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.cams.family import ExactCam
    from camgeo.cams.surface import Surface
    from camgeo.curve import moving_frame
    from camgeo.curve.moving_frame import Displacement
    from camgeo.schema.reader import Values
    from kin.law.contacts import Side

_GuideT = TypeVar("_GuideT", "moving_frame.Translating", "moving_frame.Oscillating")
ON_RETURN = "pressure-angle-return"
RETURN = math.radians(45.0)  # rule for the return of a follower that a spring holds
_LESS = 0.99  # of a base radius: only a smaller size is worth a remark
_NEAR = 1e-7  # rad, and of a radius: a figure so near its limit bounds the size
_SMALL = 1e-3  # of the wanted radius of curvature: where a search begins
SLACK = 1e-9  # degrees, and of a radius: within this a limit is kept

SIZING = mapping(
    "sizing",
    "limits in place of a base radius: the least cam that keeps them is made",
    mapping(
        "pressure-angle",
        "greatest pressure angle; finds the pivot, which is not given then, and the offset unless given",
        Field("at_most", Kind.ANGLE, "on the rise", required=True, above=0, at_most=89),
        Field("on_return", Kind.ANGLE, "on the return", default="at_most", above=0, at_most=89),
    ),
    mapping(
        "radius-of-curvature",
        "least radius of curvature of the cam's convex stretches",
        length("at_least", "least radius", required=True),
    ),
)


@dataclass(frozen=True)
class Sizing:
    """Greatest pressure angles on the rise and the return, rad, and least convex radius of the metal, mm.

    A figure without a limit is None. `place` is the stem's offset or the pivot's distance, mm, None where not given.
    """

    angles: tuple[float, float] | None = None
    radius: float | None = None
    place: float | None = None

    @staticmethod
    def of(values: Values, follower: Values) -> Sizing:
        """Limits from the values of a recipe's `sizing`, and the place from the values of its `follower`."""
        angle, radius = values.get("pressure-angle"), values.get("radius-of-curvature")
        angles = None if angle is None else (angle["at_most"], angle.get("on_return", angle["at_most"]))
        place = follower["arm"].get("pivot") if "arm" in follower else follower.get("offset")
        return Sizing(angles, None if radius is None else radius["at_least"], place)


@dataclass(frozen=True, kw_only=True)
class SizedDiscCam(DiscCam):
    """A disc cam whose size is found from the limits of `sizing`."""

    sizing: Sizing

    @property
    def own_advice(self) -> SizedAdvice:
        """Remedies in the words of `sizing`."""
        trims = self.holding.trims
        return SizedAdvice(self, less_steep=SMALLER_STROKE, radius_field=self.radius_field, trims=trims)

    @property
    def sizes(self) -> dict[str, float]:
        """Base radius, and offset or pivot's distance if found with it, mm, by their keys below `cam`."""
        sizes = {"base_radius": self.base_radius}
        if self.sizing.place is None and self.sizing.angles is not None:
            if isinstance(self.guide, Translating):
                sizes["follower.offset"] = self.guide.offset
            else:
                sizes["follower.arm.pivot"] = self.guide.pivot
        return sizes


@dataclass(frozen=True)
class SizedAdvice(Advice):
    """Advice for a cam whose size is found: other limits under `sizing`; for a ring a smaller roller.

    A ring is sized by pressure angles alone, so that its pitch curve stays with another roller.
    """

    cam: SizedDiscCam

    @property
    def radius(self) -> float:
        """Radius of the roller or shoe, mm; 0 for others."""
        return self.cam.touch.radius

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Words for the roller's radius, or twice the present limit if more, as radius of curvature under `sizing`.

        For a ring they are for a roller radius below `free_at`, mm; empty unless that is above 0.
        """
        if self.cam.side < 0:
            less = free_at / mm
            return f"a {self.radius_field} below {downward(less)} would be free of it" if less > 0.0 else ""
        radius = max(self.cam.touch.radius, 2.0 * (self.cam.sizing.radius or 0.0)) / mm
        return f"{_at_least(radius)} would be free of it"

    def rounder(self, value: float, limit: float, unit: str) -> str:
        """Words for the radius of curvature `limit` under `sizing`; for a ring for a roller radius below `value`."""
        if self.cam.side < 0:
            return f"a {self.radius_field} below {downward(value)} {unit}" if value > 0.0 else ""
        return _at_least(limit)

    def chosen_size(self, exact: ExactCam, mm: float) -> str:
        """Words for the base radius, the offset or pivot found with it, and the limits that bound them.

        Where a limit on the return below 45 degrees bounds the size, the base radius for 45 follows if much smaller.
        """
        from kin.law.normalised import IntentError

        cam, limits, bounding = self.cam, self.cam.sizing, _binding_limits(self.cam, exact)
        # sizes other than the base radius, by the last part of their keys; what only rounding left of an offset is 0
        places = {path.rpartition(".")[2]: x for path, x in cam.sizes.items() if "." in path}
        more = "".join(
            f" with {key} {_four_digits(x / mm) if abs(x) > NOISE * cam.base_radius else '0'}"
            for key, x in places.items()
        )
        bounds = [f"{name} at {at_deg:.4g} deg" for name, at_deg in bounding.items()]
        sentence = f"base radius {_four_digits(cam.base_radius / mm)}{more}, bound by {' and '.join(bounds)}"
        # a spring lets the return be steeper than the rise
        if limits.angles is not None and limits.angles[1] < RETURN and ON_RETURN in bounding:
            try:
                gentler = find_size(replace(cam, sizing=replace(limits, angles=(limits.angles[0], RETURN))))
            except IntentError:
                return sentence
            if gentler.base_radius < _LESS * cam.base_radius:
                sentence += f"; {_four_digits(gentler.base_radius / mm)} with on_return: {math.degrees(RETURN):.0f}"
        return sentence


def _at_least(radius: float) -> str:
    return f"radius-of-curvature: {{at_least: {upward(radius)}}} under sizing"


def _four_digits(size: float) -> str:
    return f"{size:#.4g}".rstrip(".")


def _binding_limits(cam: SizedDiscCam, exact: ExactCam) -> dict[str, float]:
    """Shaft angle, degrees, at which each figure that reaches its limit does so, by the figure's name."""
    limits, bounds = cam.sizing, {}
    for surface in exact.surfaces:
        suffix, steepest = f" of {surface.name}" if cam.holding.discs > 1 else "", exact.steepest(surface)
        if limits.angles is not None and steepest is not None:
            for name, most, limit in zip(("pressure-angle-rise", ON_RETURN), steepest, limits.angles, strict=True):
                if math.atan(most.value) > limit - _NEAR:
                    bounds[f"{name}{suffix}"] = degrees(most.at)
        if limits.radius is not None:
            radius, place = _least_convex_radius(surface)
            if radius < limits.radius * (1.0 + _NEAR):
                bounds[f"radius-of-curvature{suffix}"] = exact.motion.shaft_deg(place)
    return bounds


def _least_convex_radius(surface: Surface) -> tuple[float, float]:
    """Least radius of a surface's convex metal, mm, and its parameter; hollows of the curve for metal outside."""
    from camgeo.curve.backwards import least_hollow
    from camgeo.curve.curvature import least_radius

    radius, place = least_radius(surface.base) if surface.side > 0 else least_hollow(surface.base)
    return radius - surface.radius, place


def find_size(cam: SizedDiscCam) -> SizedDiscCam:
    """Copy of the cam with the least size that keeps the limits of its `sizing`.

    Raises IntentError where no size keeps them, and TypeError for a round touch on an arm without a length.
    """
    from kin.law.normalised import IntentError

    match cam.guide, cam.nominal():
        case Translating(), ExactGuided(law=law):
            sized = _stem(cam, law)
        case Oscillating(length=float(length), side=side), ExactGuided(law=law):
            sized = _arm(cam, law, length, side)
        case guide, ExactFaced(law=law):
            if isinstance(guide, Oscillating) and cam.sizing.place is None:
                raise IntentError("a flat face does not find the pivot; give follower.arm.pivot", "follower.arm")
            sized = _face(cam, law)
        case _:
            raise TypeError("a disc cam has a round touch or a flat face")
    _demand_kept(sized)
    return sized


def _stem(cam: SizedDiscCam, motion: Displacement) -> SizedDiscCam:
    """The cam for a roller, shoe or knife edge on a stem: with base radius and, unless given, offset."""
    from camgeo.curve import moving_frame

    limits = cam.sizing
    stem = moving_frame.Translating(0.0, limits.place or 0.0)
    if limits.angles is not None:
        stem = cam.holding.least_stem(motion, limits.angles, limits.place)
    stem = _keep_outer_radius(cam, motion, _keep_radius(cam, motion, stem, settled=limits.place is not None))
    return replace(cam, guide=Translating(stem.offset), base_radius=_base(cam, stem.prime))


def _arm(cam: SizedDiscCam, motion: Displacement, length: float, side: Side) -> SizedDiscCam:
    """The cam for a roller, shoe or knife edge on an arm: with base radius and, unless given, pivot.

    Raises IntentError where a pivot is given beside pressure angles, or neither is.
    """
    from camgeo.cams.least_size import least_arm
    from camgeo.curve import moving_frame
    from kin.law.normalised import IntentError

    limits = cam.sizing
    pivot = limits.place
    if limits.angles is not None:
        if pivot is not None:
            raise IntentError("the pivot is found with the pressure angle", "follower.arm.pivot")
        arm = least_arm(motion, length, side, *limits.angles, second=cam.holding.second_arm)
    elif pivot is None:
        raise IntentError("without a pressure angle the pivot must be given", "sizing")
    else:
        arm = moving_frame.Oscillating(pivot, length, 0.0, side)
    arm = _keep_outer_radius(cam, motion, _keep_radius(cam, motion, arm, settled=False))
    return replace(cam, guide=Oscillating(float(arm.pivot), side, length), base_radius=_base(cam, arm.prime))


def _face(cam: SizedDiscCam, motion: Displacement) -> SizedDiscCam:
    """The cam for a flat face, on a stem or on an arm whose pivot is given: with base radius.

    Raises IntentError for limits of the pressure angle, and where every base radius keeps the radius of curvature.
    """
    from camgeo.cams.least_size import least_face, least_swing
    from kin.law.normalised import IntentError

    limits = cam.sizing
    if limits.angles is not None or limits.radius is None:
        problem = "the pressure angle of a flat face is its tilt, whatever the size"
        if isinstance(cam.guide, Oscillating):
            problem = "a flat face on an arm is sized by its radius of curvature alone"
        raise IntentError(problem, "sizing.pressure-angle")
    if isinstance(cam.guide, Oscillating) and isinstance(cam.touch, Flat):
        guide = cam.guide
        return replace(
            cam, base_radius=least_swing(motion, guide.pivot, cam.touch.nearer, guide.side, limits.radius).base
        )
    base = least_face(replace(cam, base_radius=1.0).face(motion), limits.radius)
    if not base > 0.0:
        raise IntentError("any base radius keeps this radius of curvature; give one", "sizing.radius-of-curvature")
    return replace(cam, base_radius=base)


def _demand_kept(cam: SizedDiscCam) -> None:
    """Raise IntentError where the exact figures of a cam break the limits of its `sizing`."""
    from kin.law.normalised import IntentError

    limits = cam.sizing
    exact = cam.exact()
    for surface in exact.surfaces:
        several, steepest = cam.holding.discs > 1, exact.steepest(surface)
        suffix = f" of {surface.name}" if several else ""
        if limits.angles is not None and steepest is not None:
            for name, reached, limit in zip(("rise", "return"), steepest, limits.angles, strict=True):
                angle, most = math.degrees(math.atan(reached.value)), math.degrees(limit)
                if angle > most + SLACK:
                    raise IntentError(
                        f"the least size for the radius of curvature has a pressure angle{suffix} of {angle:.6g} "
                        f"degrees on the {name}, more than {most:.6g}; give a base radius, or a smaller radius of "
                        "curvature",
                        "sizing",
                    )
        if limits.radius is not None:
            radius, _ = _least_convex_radius(surface)
            if radius < limits.radius * (1.0 - SLACK):
                less = f"; {cam.advice.on(surface.name).larger} leaves more" if several else ""
                raise IntentError(
                    f"the size found has a radius of curvature{suffix} of {radius:.9g} mm{less}", "sizing"
                )


def _keep_radius(cam: SizedDiscCam, motion: Displacement, guide: _GuideT, *, settled: bool) -> _GuideT:
    """The guide with the least prime circle, from its own on, that keeps the radius of curvature too.

    The offset or pivot is found with it where there are pressure angles, unless `settled`.
    """
    from camgeo.cams.least_size import least_prime, least_round
    from camgeo.curve.curvature import least_radius
    from camgeo.curve.curve import Curve
    from camgeo.curve.moving_frame import CentreShape

    limits = cam.sizing
    if limits.radius is None:
        return guide
    radius, prime = limits.radius + cam.touch.radius, guide.prime
    # where nothing else bounds the size from below, a search needs some start
    start = max(prime, cam.touch.radius, _SMALL * limits.radius)
    if limits.angles is None:
        start = max(start, prime * (1.0 + 1e-9))
    elif start == prime and least_radius(Curve.whole(CentreShape(motion, guide)))[0] >= radius:
        return guide
    elif not settled:
        return least_round(motion, guide, limits.angles, radius, start)
    return guide.resized(least_prime(lambda size: CentreShape(motion, guide.resized(size)), radius, start))


def _keep_outer_radius(cam: SizedDiscCam, motion: Displacement, guide: _GuideT) -> _GuideT:
    """The guide with the least prime circle, from its own on, that keeps the radius on the outer flank too.

    The metal of that flank is convex where the path is hollow.
    """
    from camgeo.cams.least_size import least_prime
    from camgeo.curve.backwards import least_hollow
    from camgeo.curve.moving_frame import CentreShape

    outer = [flank.radius for flank in cam.holding.flanks(cam.touch, cam.side) if flank.side < cam.side]
    if not outer or cam.sizing.radius is None:
        return guide
    radius = cam.sizing.radius + outer[0]
    prime = least_prime(
        lambda size: CentreShape(motion, guide.resized(size)), radius, guide.prime, lambda curve: least_hollow(curve)[0]
    )
    return guide if prime == guide.prime else guide.resized(prime)


def _base(cam: DiscCam, prime: float) -> float:
    from kin.law.normalised import IntentError

    base = prime - cam.side * cam.touch.radius
    if not base > 0.0:
        raise IntentError(
            f"the least prime circle, {prime:.6g} mm, lies within the roller: a smaller one would do", "sizing"
        )
    return base
