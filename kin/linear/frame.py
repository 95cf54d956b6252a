"""The exact flank of a linear cam in closed form: the pitch curve's moving frame, and the flank beside it.

With c the roller's centre, c' = sigma T and N the left normal of T, the flank on the side -1 (below) or 1 (above) is
c + side R N. For a stem that leans by g

    sigma^2 = 1 + 2 S' sin g + S'^2,  N = (-S' cos g, 1 + S' sin g)/sigma,  omega = S'' cos g/sigma^2,

omega the turn of T per mm of input; for an arm sin g = s sin psi, cos g = cos psi, S' -> l S', and
omega = (l S'' cos psi - l S'^2 sin psi - s l^2 S'^3)/sigma^2.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import left
from kin.linear.follower import Stem
from kin.numeric.elementary import Jet, cos, sin, sqrt

if TYPE_CHECKING:
    from kin.law.piecewise import Side as KnotSide
    from kin.linear.follower import LinearFollower
    from kin.numeric.arrays import Array


class FrameRows(NamedTuple):
    """Pitch curve at inputs u (n,).

    centre (n, 2), mm; tangent (n, 2) and normal (n, 2), unit, the normal to the left, towards +S
    sigma (n,)  speed of the centre over the plate, mm per mm of input
    omega (n,)  turn of the tangent, rad per mm of input: the curvature of the pitch curve is omega/sigma
    tan (n,)    tangent of the pressure angle, above 0 where the plate drives a rise
    """

    centre: Array
    tangent: Array
    normal: Array
    sigma: Array
    omega: Array
    tan: Array


class FrameJets(NamedTuple):
    """Figures of the pitch curve as jets of the input.

    lift, mm or rad, and its two derivatives; sigma, omega and tan as in `FrameRows`
    """

    lift: Jet
    slope: Jet
    bend: Jet
    sigma: Jet
    omega: Jet
    tan: Jet


def frame_jets(follower: LinearFollower, u: Array, order: int = 2, knot_side: KnotSide = 1) -> FrameJets:
    """Figures at inputs u (n,), mm, with derivatives up to `order`; at a knot of the law the limit from one side."""
    lift = follower.law.on(Jet.variable(u, order + 2), knot_side)
    slope = lift.derivative()
    bend = slope.derivative()
    lift, slope = Jet(lift.c[: order + 1]), Jet(slope.c[: order + 1])
    guide = follower.guide
    if isinstance(guide, Stem):
        sine, cosine = math.sin(guide.gamma), math.cos(guide.gamma)
        sigma = sqrt(slope * slope + slope * (2.0 * sine) + 1.0)
        return FrameJets(lift, slope, bend, sigma, bend * cosine / (sigma * sigma), (slope + sine) / cosine)
    psi, length, s = lift + follower.psi0, guide.length, float(guide.side)
    path = slope * length
    leaning, upright = sin(psi) * s, cos(psi)
    sigma = sqrt(path * path + path * leaning * 2.0 + 1.0)
    turn = bend * upright * length - slope * slope * sin(psi) * length - path * path * slope * s
    return FrameJets(lift, slope, bend, sigma, turn / (sigma * sigma), (path + leaning) / upright)


def frame(follower: LinearFollower, u: Array, knot_side: KnotSide = 1) -> FrameRows:
    """Frame of the pitch curve at inputs u (n,), mm; at a knot of the law the limit from the right, or left (-1).

    Raises ValueError for inputs outside the motion.
    """
    jets = frame_jets(follower, u, 0, knot_side)
    lift, slope, sigma = jets.lift.c[0], jets.slope.c[0], jets.sigma.c[0]
    guide = follower.guide
    if isinstance(guide, Stem):
        rates = np.stack([1.0 + slope * math.sin(guide.gamma), slope * math.cos(guide.gamma)], axis=-1)
    else:
        psi, path = lift + follower.psi0, slope * guide.length
        rates = np.stack([1.0 + guide.side * path * np.sin(psi), path * np.cos(psi)], axis=-1)
    tangent = rates / sigma[:, None]
    return FrameRows(follower.centre(u, lift), tangent, left(tangent), sigma, jets.omega.c[0], jets.tan.c[0])
