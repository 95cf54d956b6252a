"""A size in place of a base radius: the least that keeps given pressure angles and a radius of curvature.

What is found is held against the exact figures before it is used (`camgeo.curve.sizing` finds it).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

from camgeo.cams.faced import ExactFaced
from camgeo.cams.family import Advice
from camgeo.cams.guided import ExactGuided
from camgeo.common.rounding import downward, upward
from camgeo.schema.fields import Field, Kind, length, mapping
from kin.law.contacts import Flat, Oscillating, Translating
from kin.numeric.angles import degrees

if TYPE_CHECKING:
    from camgeo.cams.disc_cams import DiscCam
    from camgeo.cams.family import ExactCam
    from camgeo.curve import moving_frame
    from camgeo.curve.moving_frame import Displacement
    from camgeo.schema.reader import Values
    from kin.law.contacts import Side

_GuideT = TypeVar("_GuideT", "moving_frame.Translating", "moving_frame.Oscillating")
ON_RETURN = "pressure-angle-return"
RETURN = math.radians(45.0)  # that of a follower which a spring holds
_LESS = 0.99  # of a base radius: a size that is worth telling
_NEAR = 1e-7  # rad, and of a radius: a limit so near bounds the size
_SMALL = 1e-3  # of the radius of curvature that is asked for
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
    """Greatest pressure angles on the rise and the return, rad, and least convex radius of the metal, mm; or None.

    `place` is the offset or the pivot that is given, mm, None where it is found or none is.
    """

    angles: tuple[float, float] | None = None
    radius: float | None = None
    place: float | None = None

    @staticmethod
    def of(values: Values, follower: Values) -> Sizing:
        """Take the values of a recipe."""
        angle, radius = values.get("pressure-angle"), values.get("radius-of-curvature")
        angles = None if angle is None else (angle["at_most"], angle.get("on_return", angle["at_most"]))
        place = follower["arm"].get("pivot") if "arm" in follower else follower.get("offset")
        return Sizing(angles, None if radius is None else radius["at_least"], place)


@dataclass(frozen=True)
class SizedAdvice(Advice):
    """Of a cam whose size is found: a limit in the words of `sizing`; a smaller roller in a ring, which none sizes.

    The pitch curve that pressure angles alone size stays with another roller.
    """

    cam: DiscCam
    sizing: Sizing

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """A radius of curvature as large as the roller, which makes it half of the pitch curve's."""
        if self.cam.side < 0:
            less = free_at / mm
            return f"a {self.radius_field} below {downward(less)} would be free of it" if less > 0.0 else ""
        radius = max(self.cam.touch.radius, 2.0 * (self.sizing.radius or 0.0)) / mm
        return f"{_at_least(radius)} would be free of it"

    def rounder(self, value: float, limit: float, unit: str) -> str:
        """A radius of curvature; in a ring a smaller roller."""
        if self.cam.side < 0:
            return f"a {self.radius_field} below {downward(value)} {unit}" if value > 0.0 else ""
        return _at_least(limit)

    def size_found(self, exact: ExactCam, mm: float) -> str:
        """Base radius, offset or pivot, what bounds them, and the size with the usual pressure angle on the return."""
        from kin.law.programme import IntentError

        cam, asked = self.cam, self.sizing
        more = "".join(
            f" with {path.rpartition('.')[2]} {_shown(x / mm)}" for path, x in cam.sizes.items() if "." in path
        )
        bounds = [f"{name} at {at:.4g} deg" for name, at in _binding(cam, asked, exact).items()]
        told = f"base radius {_shown(cam.base_radius / mm)}{more}, bound by {' and '.join(bounds)}"
        if asked.angles is not None and asked.angles[1] < RETURN and ON_RETURN in _binding(cam, asked, exact):
            try:
                other = sized(cam, replace(asked, angles=(asked.angles[0], RETURN)))
            except IntentError:
                return told
            if other.base_radius < _LESS * cam.base_radius:
                told += f"; {_shown(other.base_radius / mm)} with on_return: {math.degrees(RETURN):.0f}"
        return told


def _at_least(radius: float) -> str:
    return f"radius-of-curvature: {{at_least: {upward(radius)}}} under sizing"


def _shown(size: float) -> str:
    return f"{size:#.4g}".rstrip(".")


def _binding(cam: DiscCam, asked: Sizing, exact: ExactCam) -> dict[str, float]:
    """The figures that are at their limits, and at which shaft angle, degrees."""
    from camgeo.curve.curvature import least_radius

    (surface,), bounds = exact.surfaces, {}
    slope = surface.extremes("slope")
    if asked.angles is not None and slope is not None:
        low, high = slope
        for name, reached, limit, at in (
            ("pressure-angle-rise", high.value, asked.angles[0], high.at),
            (ON_RETURN, -low.value, asked.angles[1], low.at),
        ):
            if math.atan(reached) > limit - _NEAR:
                bounds[name] = degrees(at)
    if asked.radius is not None:
        radius, at = least_radius(surface.base)
        if radius - cam.touch.radius < asked.radius * (1.0 + _NEAR):
            bounds["radius-of-curvature"] = exact.motion.shaft_deg(at)
    return bounds


def sized(cam: DiscCam, asked: Sizing) -> DiscCam:
    """The cam of the least size that keeps what is asked.

    Raises IntentError where there is none.
    """
    from kin.law.programme import IntentError

    exact = cam.exact()
    match cam.guide, exact:
        case Translating(), ExactGuided(law=law):
            found = _stem(cam, law, asked)
        case Oscillating(length=float(length), side=side), ExactGuided(law=law):
            found = _arm(cam, law, asked, length, side)
        case guide, ExactFaced(law=law):
            if isinstance(guide, Oscillating) and asked.place is None:
                raise IntentError("a flat face does not find the pivot; give follower.arm.pivot", "follower.arm")
            found = _face(cam, law, asked)
        case _:
            raise TypeError("a disc cam has a round touch or a flat face")
    demand_kept(found, asked)
    return found


def _stem(cam: DiscCam, motion: Displacement, asked: Sizing) -> DiscCam:
    """A roller, shoe or knife edge on a stem: base radius and, unless given, offset."""
    from camgeo.curve import moving_frame
    from camgeo.curve.sizing import least_stem

    stem = moving_frame.Translating(0.0, asked.place or 0.0)
    if asked.angles is not None:
        stem = least_stem(motion, *asked.angles, asked.place)
    stem = _rounder(cam, motion, asked, stem, settled=asked.place is not None)
    return replace(cam, guide=Translating(stem.offset), base_radius=_base(cam, stem.prime))


def _arm(cam: DiscCam, motion: Displacement, asked: Sizing, length: float, side: Side) -> DiscCam:
    """A roller, shoe or knife edge on an arm: base radius and, unless given, pivot."""
    from camgeo.curve import moving_frame
    from camgeo.curve.sizing import least_arm
    from kin.law.programme import IntentError

    pivot = asked.place
    if asked.angles is not None:
        if pivot is not None:
            raise IntentError("the pivot is found with the pressure angle", "follower.arm.pivot")
        arm = least_arm(motion, length, side, *asked.angles)
    elif pivot is None:
        raise IntentError("without a pressure angle the pivot must be given", "sizing")
    else:
        arm = moving_frame.Oscillating(pivot, length, 0.0, side)
    arm = _rounder(cam, motion, asked, arm, settled=False)
    return replace(cam, guide=Oscillating(float(arm.pivot), side, length), base_radius=_base(cam, arm.prime))


def _face(cam: DiscCam, motion: Displacement, asked: Sizing) -> DiscCam:
    """A flat face, on a stem or on an arm whose pivot is given."""
    from camgeo.curve.sizing import least_face, least_swing
    from kin.law.programme import IntentError

    if asked.angles is not None or asked.radius is None:
        why = "the pressure angle of a flat face is its tilt, whatever the size"
        if isinstance(cam.guide, Oscillating):
            why = "a flat face on an arm is sized by its radius of curvature alone"
        raise IntentError(why, "sizing.pressure-angle")
    if isinstance(cam.guide, Oscillating) and isinstance(cam.touch, Flat):
        guide = cam.guide
        return replace(
            cam, base_radius=least_swing(motion, guide.pivot, cam.touch.nearer, guide.side, asked.radius).base
        )
    base = least_face(replace(cam, base_radius=1.0).face(motion), asked.radius)
    if not base > 0.0:
        raise IntentError("any base radius keeps this radius of curvature; give one", "sizing.radius-of-curvature")
    return replace(cam, base_radius=base)


def demand_kept(cam: DiscCam, asked: Sizing) -> None:
    """Raise IntentError where a size that was found does not keep what was asked, by the exact figures."""
    from camgeo.curve.curvature import least_radius
    from camgeo.curve.extremes import greatest, least
    from camgeo.curve.moving_frame import CentreShape
    from camgeo.curve.rates import stretches
    from kin.law.programme import IntentError

    (surface,) = cam.exact().surfaces
    shape = surface.base.shape
    if asked.angles is not None and isinstance(shape, CentreShape):
        over = stretches(shape.law)
        up, down = greatest(shape.slope, over).value, -least(shape.slope, over).value
        for name, reached, limit in zip(("rise", "return"), (up, down), asked.angles, strict=True):
            angle, most = math.degrees(math.atan(reached)), math.degrees(limit)
            if angle > most + SLACK:
                raise IntentError(
                    f"the least size for the radius of curvature has a pressure angle of {angle:.6g} degrees on the "
                    f"{name}, more than {most:.6g}; give a base radius, or a smaller radius of curvature",
                    "sizing",
                )
    if asked.radius is not None:
        found = least_radius(surface.base)[0] - cam.touch.radius
        if found < asked.radius * (1.0 - SLACK):
            raise IntentError(f"the size found has a radius of curvature of {found:.9g} mm", "sizing")


def _rounder(cam: DiscCam, motion: Displacement, asked: Sizing, guide: _GuideT, *, settled: bool) -> _GuideT:
    """Guide of the least prime circle, from that of a guide on, at which the radius of curvature is kept too.

    The offset or pivot is found with it where there are pressure angles, unless it is `settled`.
    """
    from camgeo.curve.curvature import least_radius
    from camgeo.curve.curve import Curve
    from camgeo.curve.moving_frame import CentreShape
    from camgeo.curve.sizing import least_prime, least_round

    if asked.radius is None:
        return guide
    radius, prime = asked.radius + cam.touch.radius, guide.prime
    # where nothing else sets a least size there is some size below which no cam is looked for
    start = max(prime, cam.touch.radius, _SMALL * asked.radius)
    if asked.angles is None:
        start = max(start, prime * (1.0 + 1e-9))
    elif start == prime and least_radius(Curve.whole(CentreShape(motion, guide)))[0] >= radius:
        return guide
    elif not settled:
        return least_round(motion, guide, asked.angles, radius, start)
    return guide.resized(least_prime(lambda size: CentreShape(motion, guide.resized(size)), radius, start))


def _base(cam: DiscCam, prime: float) -> float:
    from kin.law.programme import IntentError

    base = prime - cam.side * cam.touch.radius
    if not base > 0.0:
        raise IntentError(
            f"the least prime circle, {prime:.6g} mm, lies within the roller: a smaller one would do",
            "sizing",
        )
    return base
