"""How well a cam in a frame drives the output: the force of the frame on the next link, and its angle.

Three forces act on the frame where there is no friction: those of the two contacts along their normals, and that of the
joint. They meet in P = -S' u - S1' n, the intersection of the normals, about which the frame turns against the cam for
an instant. The force on the output acts along DP, and the angle between DP and the direction in which it does nothing
is 0 exactly where the shaft stands still, phi' = 0: that is where a mechanism driven by its shaft truly binds. The
transmission angle, between frame and rocker, is what matters for a mechanism driven by its coupler.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

__all__ = ["ForceLine", "angle", "pushing"]


class ForceLine(NamedTuple):
    """Lines of force at n places: a point, mm, and the unit vector, (n,) each; the vector is 0, 0 where none exists."""

    x: Array
    y: Array
    along_x: Array
    along_y: Array


def angle(lever: Array, along: Array, side: Array) -> tuple[Array, Array]:
    """Sine and cosine (n,) of a force angle, from parts in their ratio: `lever` of the sine, `along` of the cosine.

    The parts are (n,), in one unit, whichever it is; where both are 0 so are both results. Where `side` (n,) is
    negative both results change their sign, so that the sine has the sign of phi'.
    """
    size = np.hypot(lever, along)
    size = np.where(size > 0, size, 1.0) * np.where(side < 0, -1.0, 1.0)
    return lever / size, along / size


def pushing(place: tuple[Array, Array], along: tuple[Array, Array], way: tuple[Array, Array], rate: Array) -> ForceLine:
    """Line of force through `place`, along or against `along`, so that it pushes a link on in its motion.

    Places, mm, and vectors are pairs (x, y) of arrays (n,). The link moves at `rate` times `way` there.
    """
    size = np.hypot(*along)
    fx, fy = (np.divide(part, size, out=np.zeros_like(part), where=size > 0.0) for part in along)
    side = np.where((fx * way[0] + fy * way[1]) * rate < 0.0, -1.0, 1.0)
    return ForceLine(*place, side * fx, side * fy)
