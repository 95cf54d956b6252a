"""What would help against undercut and lost contact, in the words of the cam's own recipe."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.common.rounding import upward
from camgeo.recipe.cam import ArcRoute, ConstantBreadthCam, FourierShape, HypocycloidShape, ReuleauxShape, SupportCam

if TYPE_CHECKING:
    from camgeo.recipe.cam import Cam, DoubleRollerCam, FlatPairCam


def less_swing(cam: DoubleRollerCam | FlatPairCam, mm: float) -> str:
    """Say how a follower comes to swing less; `mm` is the recipe's unit.

    An arc about the shaft, its radius the mean distance R = 2 l cos(alpha/2), has no swing at all.
    """
    if not isinstance(cam.route, ArcRoute):
        return "a smaller swing"
    mean = 2.0 * cam.arm * math.cos(0.5 * math.pi * cam.mu / cam.lam)
    return f"an arc.radius nearer to {mean / mm:.6g}"


def larger(cam: Cam, by: float, unit: str = "") -> str:
    """Say how the cam's radii of curvature grow by more than `by`, in the recipe's unit; empty for a pair's cam.

    A constant added to the support function adds as much to every radius (AS eq. 3).
    """
    if isinstance(cam, ConstantBreadthCam):
        name, share = "a base radius", 1.0
    elif not isinstance(cam, SupportCam):
        return ""
    elif isinstance(cam.shape, ReuleauxShape):
        name, share = "a reuleaux.rounding", 1.0
    elif isinstance(cam.shape, HypocycloidShape):
        name, share = "a hypocycloid.breadth", 2.0
    elif isinstance(cam.shape, FourierShape):
        name, share = "a fourier.mean", 1.0
    else:
        name, share = "a p", 1.0
    return f"{name} larger by more than {upward(share * by)} {unit}".rstrip()
