"""What cams for a flat face on a guide have in common: on a stem, tilted and offset, or on an arm.

The contour is the envelope of the face (`camgeo.curve.disc`); its parameter is the shaft angle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.cams.family import Advice, Surface
from camgeo.cams.guided import ExactLed
from camgeo.common.rounding import upward
from camgeo.curve.curve import Curve

if TYPE_CHECKING:
    from camgeo.cams.disc_cams import DiscCam
    from camgeo.curve.disc import Face
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
class ExactFaced(ExactLed):
    """A disc cam for a flat face by the displacement of its follower."""

    cam: DiscCam

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """The envelope of the face."""
        from camgeo.curve.disc import face_shape

        face = self.cam.face(self.law)
        whole = Curve.whole(face_shape(face))
        series = {"slope": face.slope, "contact": face.contact}
        return (Surface(whole, whole, pressure=FacePressure(face), place=FacePlace(face), series=series),)
