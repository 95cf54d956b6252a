"""From a recipe's cam to the motion it intends (in kin's words) and to the exact curve of its profile."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from camgeo.common.rounding import upward
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.recipe.cam import (
    ArcRoute,
    ConstantBreadthCam,
    DeltaRoute,
    DoubleRollerCam,
    FlatPairCam,
    FormulaShape,
    FourierShape,
    LawRoute,
    ReuleauxShape,
    SupportCam,
)
from camgeo.recipe.schema.fields import MOST

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.cam import Cam
    from camgeo.recipe.motion import MotionSegment
    from kin.law.programme import Programme
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission

LOOKS = 72  # places at which the size of a formula's values is looked at
LEAST_PART = 1e-9  # of its farthest point from the shaft: a cam with a smaller mean radius is lost in rounding
ROUNDING = 1e-15  # of the same: a mean radius below it is 0


@dataclass(frozen=True)
class Profile:
    """The exact curve of a cam.

    `base` is what the intent describes, the pitch curve of a roller or the contour itself; `curve` is the contour,
    `roller_radius` inside the base (0 for flat faces).
    """

    base: Curve
    curve: Curve
    roller_radius: float


def intent_of(cam: Cam) -> Lift | Transmission:
    """Motion that a recipe's cam intends: the lift of a flat face, or Wunderlich's transmission law.

    Raises kin's IntentError where no such motion exists, with the field below `cam` that is at fault.
    """
    if isinstance(cam, SupportCam):
        return _support(cam)
    if isinstance(cam, ConstantBreadthCam):
        from kin.law.support_function import lift_constant_breadth

        return lift_constant_breadth(cam.base_radius, _programme(cam.motion, math.pi, "motion", around=-1))
    return _transmission(cam)


def profile_of(cam: Cam, intent: Lift | Transmission) -> Profile:
    """Exact curve of the cam that gives the intended motion.

    Raises TypeError where the intent is not of the cam's kind.
    """
    from kin.law.support_function import Lift

    if isinstance(intent, Lift):
        if isinstance(cam, DoubleRollerCam | FlatPairCam):
            raise TypeError("a lift is no motion of a double follower")
        from camgeo.curve.support import SupportShape

        whole = Curve.whole(SupportShape(intent))
        return Profile(whole, whole, 0.0)
    from camgeo.curve.wunderlich import FlatPairShape, PitchShape

    if isinstance(cam, DoubleRollerCam):
        pitch = PitchShape(intent)
        return Profile(Curve.whole(pitch), Curve.whole(Parallel(pitch, cam.roller_radius)), cam.roller_radius)
    if not isinstance(cam, FlatPairCam):
        raise TypeError("a transmission law is no motion of a single flat face")
    whole = Curve.whole(FlatPairShape(intent))
    return Profile(whole, whole, 0.0)


def _support(cam: SupportCam) -> Lift:
    from kin.law import support_function

    shape = cam.shape
    if isinstance(shape, FormulaShape):
        return _with_size(_formula(shape, cam.shaft), "p", shape.scale)
    if isinstance(shape, FourierShape):
        found = support_function.lift_from_fourier(shape.mean, dict(shape.cos), dict(shape.sin), cam.shaft)
        return _with_size(found, "fourier.mean")
    if isinstance(shape, ReuleauxShape):
        found = support_function.lift_reuleaux(shape.sides, shape.breadth, shape.rounding, cam.shaft)
        return _with_size(found, "reuleaux.breadth")
    found = support_function.lift_hypocycloid(shape.cusps, shape.size, shape.breadth, cam.shaft)
    return _with_size(found, "hypocycloid.breadth")


def _with_size(lift: Lift, field: str, scale: float = 1.0) -> Lift:
    """Give the lift back unless its mean is no length: 2 pi times the mean is the perimeter, wherever the shaft is.

    Raises IntentError with the mean in the recipe's unit, `scale` mm.
    """
    from kin.law.programme import IntentError

    p = lift.derivatives(np.linspace(0.0, 2.0 * math.pi, LOOKS, endpoint=False), 0)[0]
    mean, farthest = float(np.mean(p)), float(np.abs(p).max())
    least = LEAST_PART * farthest
    if mean > least or not farthest:  # of p = 0 the radius of curvature is held against 0 like any other
        return lift
    mean = 0.0 if abs(mean) < ROUNDING * farthest else mean
    remedy = f"add more than {upward((least - mean) / scale)} to p" if field == "p" else "give a larger one"
    raise IntentError(
        f"the mean radius is {mean / scale:.6g}, not above {least / scale:.3g}: a cam's perimeter is 2 pi times it, "
        f"and this one's points lie up to {farthest / scale:.6g} from the shaft; {remedy}",
        field,
    )


def _formula(shape: FormulaShape, pivot: tuple[float, float]) -> Lift:
    from kin.law.formula.formula import Formula
    from kin.law.from_formula import lift_from_formula
    from kin.law.programme import IntentError

    lift = lift_from_formula(Formula(shape.text), pivot, shape.scale)
    t = np.linspace(0.0, 2.0 * math.pi, LOOKS, endpoint=False)
    size = np.abs(lift.derivatives(t, 0)[0]) / shape.scale
    largest = int(np.argmax(size))
    if size[largest] > MOST:  # other lengths are bounded as they are read
        at = math.degrees(t[largest])
        raise IntentError(f"p reaches {size[largest]:.6g} at {at:.6g} degrees, above {MOST:.0f}", "p", at)
    return lift


def _transmission(cam: DoubleRollerCam | FlatPairCam) -> Transmission:
    from kin.law import transmission

    route = cam.route
    if isinstance(route, DeltaRoute):
        return transmission.from_delta(cam.lam, cam.mu, cam.arm, dict(route.cos), dict(route.sin))
    if isinstance(route, LawRoute):
        swing_of: Literal["arm", "pair"] = "pair" if isinstance(cam, FlatPairCam) else "arm"
        motion = _programme(route.motion, math.pi / cam.lam, "law")
        return transmission.from_law(cam.lam, cam.mu, cam.arm, motion, swing_of)
    if isinstance(route, ArcRoute):
        return transmission.from_arc(cam.lam, cam.mu, cam.arm, route.radius, route.side)
    from kin.law.formula.formula import Formula

    leaf = Formula(route.text, ("x",))
    return transmission.from_rosette(cam.lam, cam.mu, cam.arm, leaf, route.scale)


def _programme(segments: Sequence[MotionSegment], total: float, field: str, around: int | None = None) -> Programme:
    from kin.law.sources.programme import programme

    steps = [segment.step(f"{field}[{i}]") for i, segment in enumerate(segments)]
    return programme(steps, total, around=around, field=field)
