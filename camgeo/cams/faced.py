"""What cams for a flat face on a guide have in common: on a stem, tilted and offset, or on an arm.

The contour is the envelope of the face (`camgeo.curve.disc`); its parameter is the shaft angle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.cams.family import Advice, ExactCam, Surface
from camgeo.cams.position import Position, position_of
from camgeo.common.rounding import upward
from camgeo.curve.curve import Curve

if TYPE_CHECKING:
    from camgeo.cams.disc_cams import DiscCam
    from camgeo.cams.family import Follower
    from camgeo.curve.disc import Face
    from camgeo.curve.moving_frame import Displacement
    from kin.follower.follower import Follower as Gauge
    from kin.law.joints import Joint
    from kin.numeric.arrays import Array


@dataclass(frozen=True)
class SizeAdvice(Advice):
    """Of a flat face: a larger cam. `size` is the key that makes it larger all round, by `share` per unit of radius."""

    size: str = "base radius"
    share: float = 1.0
    beside: str = ""
    free: str = "have no undercut"

    def larger(self, by: float, unit: str = "") -> str:
        """Say how radii of curvature, which grow with the size, grow by more than `by`, in its unit."""
        if by == 0.0:  # a radius that is 0 needs no more than not to be
            return f"a larger {self.size}{self.beside}"
        return f"{f'a {self.size} larger by more than {upward(self.share * by)} {unit}'.rstrip()}{self.beside}"

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """A larger cam."""
        return f"{self.larger(free_at / mm)} would {self.free}"

    def rounder(self, value: float, limit: float, unit: str) -> str:
        """A larger cam."""
        return self.larger(limit - value, unit)


@dataclass(frozen=True)
class FacePressure:
    """Pressure angle of a flat face."""

    face: Face

    def __call__(self, t: Array) -> Array:
        """At shaft angles t (n,), rad."""
        from kin.numeric.elementary import Jet

        angle: Array = np.arctan(self.face.slope(Jet.variable(t, 1)).c[0])
        return angle


@dataclass(frozen=True)
class FacePlace:
    """Where a flat face is touched."""

    face: Face

    def __call__(self, t: Array) -> Array:
        """At shaft angles t (n,), mm from the stem's axis or from the arm's pivot."""
        from kin.numeric.elementary import Jet

        return np.asarray(self.face.contact(Jet.variable(t, 1)).c[0])


@dataclass(frozen=True, eq=False)
class ExactFaced(ExactCam):
    """A disc cam for a flat face by the displacement of its follower."""

    cam: DiscCam
    law: Displacement

    @cached_property
    def follower(self) -> Follower:
        """As the family has it."""
        return self.cam.follower(self.law)

    @cached_property
    def motion(self) -> Position:
        """The displacement."""
        return position_of(self.cam.guide, self.law)

    @cached_property
    def surface(self) -> Surface:
        """The envelope of the face."""
        from camgeo.curve.disc import face_shape

        face = self.cam.face(self.law)
        whole = Curve.whole(face_shape(face))
        series = {"slope": face.slope, "contact": face.contact}
        return Surface(whole, whole, pressure=FacePressure(face), place=FacePlace(face), series=series)

    @cached_property
    def gauge(self) -> Gauge:
        """The contacts with the displacement."""
        from kin.follower.follower import follower_of

        return follower_of(self.follower.contacts, self.law.law())

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Those that the recipe gives."""
        return self.cam.joints()

    def grown(self, out: float, scale: float) -> ExactFaced:
        """The face farther out; a lift is scaled with the drawing, a swing is not."""
        lifts = self.cam.guide.unit == "mm"
        return ExactFaced(self.cam.grown(out, scale), self.law.scaled(scale) if lifts else self.law)
