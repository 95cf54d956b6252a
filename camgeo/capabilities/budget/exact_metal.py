"""The exact contour under a touch: one equation in the contour's parameter, solved by Newton's method for all parts.

Points, normals and directions are complex numbers, x + iy, in the cam's axes, mm.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.budget.contact import LostError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Curve
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Complexes

    # (point, unit tangent, speed, turn) at contour parameters -> (residual, its derivative by the parameter); speed is
    # mm along the tangent, turn rad of the tangent, per unit of the parameter
    Residual = Callable[[Complexes, Complexes, Array, Array], tuple[Array, Array]]

SETTLED = 1e-11  # mm, or rad: residual at which a contact is found
MOST_STEPS = 50  # of Newton's method; five are usual
LONGEST = 0.1  # greatest step of the parameter, rad, so that the search stays near the intended contact


@dataclass(frozen=True, eq=False)
class ExactMetal:
    """Metal bounded by an exact contour `curve`, under a touch at n shaft angles.

    `side` is 1 for metal inside the contour, -1 outside. `parameter` (n,) has the contour's parameters of the intended
    contacts, from which Newton's method starts.
    """

    curve: Curve
    side: Side
    parameter: Array

    def reach(self, normal: Complexes) -> Array:
        """Distance from the shaft to a flat face on the metal along its unit `normal`, mm, (parts, angles).

        Raises LostError where no contact is found near the intended one.
        """

        def residual(_: Complexes, tangent: Complexes, __: Array, turn: Array) -> tuple[Array, Array]:
            return (np.conj(normal) * tangent).real, turn * (np.conj(normal) * 1j * tangent).real

        point, _ = self._touched(normal.shape, residual)
        reach: Array = (np.conj(normal) * point).real
        return reach

    def along(self, way: Complexes, middle: Complexes, radius: Array) -> Array:
        """Distance from `middle` along the unit direction `way` to the centre of a round touch, mm, (parts, angles).

        Raises LostError where no contact is found near the intended one.
        """

        def residual(point: Complexes, tangent: Complexes, speed: Array, turn: Array) -> tuple[Array, Array]:
            aside = (np.conj(way) * (self._centre(point, tangent, radius) - middle)).imag
            return aside, (speed + self.side * radius * turn) * (np.conj(way) * tangent).imag

        point, tangent = self._touched(np.broadcast_shapes(way.shape, middle.shape, radius.shape), residual)
        along: Array = (np.conj(way) * (self._centre(point, tangent, radius) - middle)).real
        return along

    def arm(self, pivot: Complexes, length: Array, radius: Array) -> Complexes:
        """Unit direction from a pivot to the centre of a round touch on the metal, (parts, angles).

        `length` is that of the arm, `radius` that of the touch, mm. Raises LostError where no contact is found near the
        intended one.
        """

        def residual(point: Complexes, tangent: Complexes, speed: Array, turn: Array) -> tuple[Array, Array]:
            # (|arm|^2 - length^2)/2 is 0 on the arm's circle; over the length it is in mm
            arm = self._centre(point, tangent, radius) - pivot
            slope = (speed + self.side * radius * turn) * (np.conj(arm) * tangent).real
            return 0.5 * (np.abs(arm) ** 2 - length**2) / length, slope / length

        point, tangent = self._touched(np.broadcast_shapes(pivot.shape, length.shape, radius.shape), residual)
        arm = self._centre(point, tangent, radius) - pivot
        return arm / np.abs(arm)

    def face_normal(self, pivot: Complexes, nearer: Array) -> Complexes:
        """Outward unit normal of a flat face on an arm that touches the metal, (parts, angles).

        The face is `nearer` mm nearer the shaft than its parallel through the pivot. Raises LostError where no contact
        is found near the intended one.
        """

        def residual(point: Complexes, tangent: Complexes, _: Array, turn: Array) -> tuple[Array, Array]:
            # along the normal, the point of contact is `nearer` mm nearer the shaft than the pivot
            arm = point - pivot
            return (np.conj(-1j * tangent) * arm).real + nearer, turn * (np.conj(tangent) * arm).real

        _, tangent = self._touched(np.broadcast_shapes(pivot.shape, nearer.shape), residual)
        return -1j * tangent

    def _centre(self, point: Complexes, tangent: Complexes, radius: Array) -> Complexes:
        """Centre of a round touch at a point of the contour."""
        centre: Complexes = point - 1j * self.side * radius * tangent
        return centre

    def _touched(self, shape: tuple[int, ...], residual: Residual) -> tuple[Complexes, Complexes]:
        """Point, mm, and unit tangent of the contour where a residual is 0, each of a `shape` (parts, angles).

        Raises LostError where no contact is found near the intended one.
        """
        t = np.broadcast_to(self.parameter, shape)
        for _ in range(MOST_STEPS):
            frame = self.curve.sample(np.mod(t, self.curve.shape.period).ravel())
            point, tangent = (row[:, 0].reshape(shape) + 1j * row[:, 1].reshape(shape) for row in frame.rows[:2])
            off, slope = residual(point, tangent, frame.speed.reshape(shape), frame.turn.reshape(shape))
            if np.abs(off).max() < SETTLED:
                return point, tangent
            with np.errstate(divide="ignore", invalid="ignore"):
                step = np.where(off == 0.0, 0.0, off / slope)
            if not np.isfinite(step).all():
                break
            t = t - np.clip(step, -LONGEST, LONGEST)
        raise LostError("a made part has no contact near where it is meant to be")
