"""What cams for a flat face on a guide have in common: on a stem, tilted and offset, or on an arm.

The contour is the envelope of the face (`camgeo.curve.disc`); its parameter is the shaft angle.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, ClassVar, cast

import numpy as np

from camgeo.cams.family import Cam, Circle, Profile
from camgeo.common.rounding import upward
from camgeo.curve.curve import Curve

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.family import Intent
    from camgeo.curve.disc import Face
    from camgeo.curve.extremes import Figure
    from camgeo.curve.face import FaceShape
    from camgeo.curve.moving_frame import Displacement
    from kin.law.piecewise import Piecewise
    from kin.numeric.arrays import Array

LARGER_BASE = "a larger base radius, a smaller stroke, or the same over a wider angle"


class FacedCam(Cam):
    """A cam whose follower is a flat face, led along a line or about a pivot."""

    less_steep: ClassVar[str] = LARGER_BASE
    offers: ClassVar[frozenset[str]] = frozenset({"face", "guided"})
    base_radius: float

    @abstractmethod
    def face(self, motion: Displacement) -> Face:
        """The face over the shaft angle; raises IntentError where it cannot be driven."""

    def profile(self, intent: Intent) -> Profile:
        """The envelope of the face."""
        from camgeo.curve.disc import face_shape
        from camgeo.curve.moving_frame import Displacement

        if not isinstance(intent, Displacement):
            raise TypeError("a face on a guide takes a displacement over the shaft angle")
        whole = Curve.whole(face_shape(self.face(intent)))
        return Profile(whole, whole, 0.0)

    def law(self, intent: Intent) -> Piecewise:
        """The displacement."""
        return cast("Displacement", intent).law()

    def pressure_angle(self, intent: Intent, profile: Profile) -> Callable[[Array], Array]:  # noqa: ARG002
        """Between the face's normal and its way."""
        from kin.numeric.elementary import Jet

        face = cast("FaceShape[Face]", profile.base.shape).law
        return lambda t: np.arctan(face.slope(Jet.variable(t, 1)).c[0])

    def contact_place(self, intent: Intent, profile: Profile) -> Callable[[Array], Array]:  # noqa: ARG002
        """Along the face, mm, from the stem's axis or from the arm's pivot."""
        from kin.numeric.elementary import Jet

        face = cast("FaceShape[Face]", profile.base.shape).law
        return lambda t: np.asarray(face.contact(Jet.variable(t, 1)).c[0])

    def series(self, intent: Intent, profile: Profile) -> dict[str, Figure]:  # noqa: ARG002
        """Of the pressure angle, and of the place of contact."""
        face = cast("FaceShape[Face]", profile.base.shape).law
        return {"slope": face.slope, "contact": face.contact}

    def circles(self) -> tuple[Circle, ...]:
        """The base circle, which the face is tangent to at displacement 0."""
        return (Circle("base circle", self.base_radius),)

    def larger(self, by: float, unit: str = "") -> str:
        """Say how radii of curvature, which grow with the base radius, grow by more than `by`, in its unit."""
        if by == 0.0:  # a radius that is 0 needs no more than not to be
            return "a larger base radius"
        return f"a base radius larger by more than {upward(by)} {unit}".rstrip()

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """A larger cam."""
        return f"{self.larger(free_at / mm)} would be free of it"

    def rounder(self, value: float, limit: float, unit: str) -> str:
        """A larger cam."""
        return self.larger(limit - value, unit)

    def grown_intent(self, intent: Intent, out: float, scale: float) -> Intent:  # noqa: ARG002
        """The face farther out; a lift is scaled with the drawing, a swing is not."""
        law = cast("Displacement", intent)
        return law.scaled(scale) if self.unit == "mm" else law
