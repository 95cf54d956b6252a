"""How well a cam in a frame drives the output: transmission angle and force angle, as sine and cosine.

Three forces act on the frame where there is no friction: those of the two contacts along their normals, and that of the
joint. They meet in P = -S' u - S1' n, the intersection of the normals, about which the frame turns against the cam for
an instant. The force on the output acts along DP, and the angle between DP and the direction in which it does nothing
is 0 exactly where the shaft stands still, phi' = 0: that is where a mechanism driven by its shaft truly binds. The
transmission angle, between frame and rocker, is what matters for a mechanism driven by its coupler.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.linkage.four_bar import FourBar, InvertedSliderCrank

if TYPE_CHECKING:
    from kin.linkage.four_bar import Linkage, Positions
    from kin.numeric.arrays import Array

__all__ = ["force", "transmission"]


def transmission(linkage: Linkage, at: Positions) -> tuple[Array, Array]:
    """Sine and cosine (n,) of the angle from the frame's line u to the rocker BD, or to the slide's normal.

    The block of an inverted slider-crank presses across the frame's line: 90 degrees throughout.
    """
    frame, output = at.frame.c[0], at.output.c[0]
    if isinstance(linkage, InvertedSliderCrank):
        return np.ones_like(frame), np.zeros_like(frame)
    if isinstance(linkage, FourBar):
        return np.sin(frame + output), -np.cos(frame + output)
    return np.cos(frame), np.sin(frame)


def force(linkage: Linkage, at: Positions, slope: Array, slope1: Array) -> tuple[Array, Array]:
    """Sine and cosine (n,) of the force angle, the sine of the sign of phi'; `slope` and `slope1` (n,) are S' and S1'.

    A four-bar: between DP and DB. A slider-crank: between DP and the slide's normal. An inverted slider-crank: its
    force passes through P across the frame's line, so it is between that and BP. Where P falls on D (or B) there is no
    such line, and the sine is 0.
    """
    frame = at.frame.c[0]
    c, s = np.cos(frame), np.sin(frame)
    px, py = -slope * c + slope1 * s, -slope * s - slope1 * c
    dx, dy = (row.c[0] for row in at.joint)
    if isinstance(linkage, FourBar):
        ax, ay, bx, by = dx - px, dy - py, dx - linkage.ground, dy
        lever, along, side = ax * by - ay * bx, ax * bx + ay * by, dy
    elif isinstance(linkage, InvertedSliderCrank):
        ax, ay = linkage.ground - px, -py
        lever, along, side = ax * c + ay * s, ay * c - ax * s, at.slide.c[0]
    else:
        lever, along, side = dx - px, dy - py, dx
    size = np.hypot(lever, along)
    size = np.where(size > 0, size, 1.0) * np.where(side < 0, -1.0, 1.0)
    return lever / size, along / size
