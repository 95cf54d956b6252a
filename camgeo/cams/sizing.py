"""A size in place of a base radius: the least that keeps given pressure angles and a radius of curvature.

What is found is held against the exact figures before it is used (`camgeo.curve.sizing` finds it).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from camgeo.cams.faced import ExactFaced
from camgeo.cams.guided import ExactGuided
from camgeo.schema.fields import Field, Kind, length, mapping
from kin.law.contacts import Oscillating, Translating

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.cams.disc_cams import DiscCam
    from camgeo.curve.curve import Shape
    from camgeo.curve.moving_frame import Displacement
    from camgeo.schema.reader import Values
    from kin.law.contacts import Side

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
    """Greatest pressure angles on the rise and the return, rad, and least convex radius of the metal, mm; or None."""

    angles: tuple[float, float] | None = None
    radius: float | None = None

    @staticmethod
    def of(values: Values) -> Sizing:
        """Take the values of a recipe."""
        angle, radius = values.get("pressure-angle"), values.get("radius-of-curvature")
        angles = None if angle is None else (angle["at_most"], angle.get("on_return", angle["at_most"]))
        return Sizing(angles, None if radius is None else radius["at_least"])


def sized(cam: DiscCam, asked: Sizing, given: Mapping[str, float]) -> DiscCam:
    """The cam of the least size that keeps what is asked; `given` are the follower's keys in the recipe.

    Raises IntentError where there is none.
    """
    from kin.law.programme import IntentError

    exact = cam.exact()
    match cam.guide, exact:
        case Translating(), ExactGuided(law=law):
            found = _stem(cam, law, asked, given.get("offset"))
        case Oscillating(length=float(length), side=side), ExactGuided(law=law):
            found = _arm(cam, law, asked, (length, side, given.get("pivot")))
        case Translating(), ExactFaced(law=law):
            found = _face(cam, law, asked)
        case _:
            raise IntentError("the size of a cam for a flat face on an arm is not found", "sizing")
    demand_kept(found, asked)
    return found


def _stem(cam: DiscCam, motion: Displacement, asked: Sizing, given: float | None) -> DiscCam:
    """A roller, shoe or knife edge on a stem: base radius and, unless given, offset."""
    from camgeo.curve import moving_frame
    from camgeo.curve.sizing import least_stem

    offset, prime = given or 0.0, 0.0
    if asked.angles is not None:
        stem = least_stem(motion, *asked.angles, given)
        prime, offset = stem.prime, stem.offset

    def shape(size: float) -> Shape:
        return moving_frame.CentreShape(motion, moving_frame.Translating.on(size, offset))

    base = _base(cam, _rounder(cam, asked, prime, abs(offset), shape))
    return replace(cam, guide=Translating(offset), base_radius=base)


def _arm(cam: DiscCam, motion: Displacement, asked: Sizing, given: tuple[float, Side, float | None]) -> DiscCam:
    """A roller, shoe or knife edge on an arm of given length and side, and maybe pivot: base radius and pivot."""
    from camgeo.curve import moving_frame
    from camgeo.curve.sizing import least_arm
    from kin.law.programme import IntentError

    (length, side, pivot), prime = given, 0.0
    if asked.angles is not None:
        if pivot is not None:
            raise IntentError("the pivot is found with the pressure angle", "follower.arm.pivot")
        arm = least_arm(motion, length, side, *asked.angles)
        prime, pivot = arm.prime, arm.pivot
    elif pivot is None:
        raise IntentError("without a pressure angle the pivot must be given", "sizing")
    place, low = pivot, abs(pivot - length)

    def shape(size: float) -> Shape:
        return moving_frame.CentreShape(motion, moving_frame.Oscillating.on(size, place, length, side))

    prime = _rounder(cam, asked, prime, low, shape)
    return replace(cam, guide=Oscillating(place, side, length), base_radius=_base(cam, prime))


def _face(cam: DiscCam, motion: Displacement, asked: Sizing) -> DiscCam:
    """A flat face on a stem: its pressure angle is its tilt."""
    from camgeo.curve.sizing import least_face
    from kin.law.programme import IntentError

    if asked.angles is not None:
        raise IntentError("the pressure angle of a flat face is its tilt, whatever the size", "sizing.pressure-angle")
    if asked.radius is None:
        raise TypeError("a size is found from a limit")
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

    surface = cam.exact().surface
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


def _rounder(cam: DiscCam, asked: Sizing, prime: float, low: float, shape: object) -> float:
    """Prime radius from `prime` on, and above `low`, at which the radius of curvature is kept too."""
    from camgeo.curve.sizing import least_prime

    if asked.radius is None:
        return prime
    # where nothing else sets a least size there is some size below which no cam is looked for
    start = max(prime, low * (1.0 + 1e-9), cam.touch.radius, _SMALL * asked.radius)
    return least_prime(shape, asked.radius + cam.touch.radius, start)  # type: ignore[arg-type]


def _base(cam: DiscCam, prime: float) -> float:
    from kin.law.programme import IntentError

    base = prime - cam.side * cam.touch.radius
    if not base > 0.0:
        raise IntentError(
            f"the least prime circle, {prime:.6g} mm, lies within the roller: a smaller one would do",
            "sizing",
        )
    return base
