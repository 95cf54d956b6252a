"""What would free a flat-faced cam of undercut, in the words of its own recipe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.model import ConstantBreadthCam, FourierShape, HypocycloidShape, ReuleauxShape, SupportCam
from camgeo.rounded import upward

if TYPE_CHECKING:
    from camgeo.recipe.model import Cam


def larger(cam: Cam, by: float, unit: str = "") -> str:
    """Say how the cam's radii of curvature grow by more than `by`, in the recipe's unit; empty for a pair's cam.

    A constant added to the support function adds as much to every radius (AS eq. 3).
    """
    if isinstance(cam, ConstantBreadthCam):
        name, share = "a base radius", 1.0
    elif not isinstance(cam, SupportCam):
        return ""
    elif isinstance(cam.shape, ReuleauxShape):
        return "a rounding above 0"  # of its arcs the corners alone can have no radius
    elif isinstance(cam.shape, HypocycloidShape):
        name, share = "a hypocycloid.breadth", 2.0
    elif isinstance(cam.shape, FourierShape):
        name, share = "a fourier.mean", 1.0
    else:
        name, share = "a p", 1.0
    return f"{name} larger by more than {upward(share * by)} {unit}".rstrip()
