"""Parallels of the pitch curve: the motion that they give, and how far flanks within a tolerance can take it off."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from kin.linear.follower import Arm
from kin.linear.frame import frame, frame_jets
from kin.numeric.extrema import extremes_over
from kin.numeric.newton import zeros

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.piecewise import Side as KnotSide
    from kin.linear.follower import LinearFollower
    from kin.numeric.arrays import Array

SETTLED = 1e-8  # of the length: accuracy of an input that is solved for, before one step along a tangent
SLACK = 1e-6  # of a limit that is found on the cells' ends


class At(NamedTuple):
    """A value and the input at which it is reached, mm."""

    value: float
    at: float


class Angles(NamedTuple):
    """Greatest and least pressure angle, rad, at their inputs, mm.

    Driven the other way each changes its sign; a rise forth is a return back, so the greater magnitude counts.
    """

    greatest: At
    least: At


_ANGLES: WeakKeyDictionary[LinearFollower, Angles] = WeakKeyDictionary()  # of each follower, while it is in use


def pressure_angles(follower: LinearFollower) -> Angles:
    """Pressure angles over all inputs, rad: above 0 where the plate drives a rise, forth."""
    if follower not in _ANGLES:
        found = extremes_over(follower.cells, lambda u, side: frame_jets(follower, u, 2, side).tan)
        _ANGLES[follower] = Angles(
            At(math.atan(found.greatest), found.greatest_at), At(math.atan(found.least), found.least_at)
        )
    return _ANGLES[follower]


def parallel_lift(follower: LinearFollower, distance: float | Array, u: Array) -> Array:
    """Lift (n,), mm or rad, at inputs u (n,), mm, with the centre on the pitch curve's parallels at `distance`, mm.

    Above 0 they lie towards +S. Beyond its ends the pitch curve goes on along its tangents.
    """
    first, last = follower.span
    apart = np.broadcast_to(np.asarray(distance, dtype=np.float64), u.shape)

    def inner(v: Array) -> tuple[Array, KnotSide]:
        inside = v if follower.endless else np.clip(v, first, last)
        return inside, np.where(inside < last, 1, -1)

    def place(v: Array) -> tuple[Array, Array, Array]:
        inside, side = inner(v)
        rows = frame(follower, inside, side)
        beyond = ((v - inside) * rows.sigma)[:, None] * rows.tangent
        return rows.centre + beyond + apart[:, None] * rows.normal, rows.tangent, rows.sigma - apart * rows.omega

    def off(v: Array) -> tuple[Array, Array]:
        point, _, speed = place(v)
        input_, _ = follower.lift_at(point)
        return np.where(np.isfinite(input_), input_ - u, v - u), np.maximum(speed, 1e-3)

    reach = np.abs(apart) + (follower.lever if isinstance(follower.guide, Arm) else 0.0)
    angles = pressure_angles(follower)
    wide = reach * (1.0 + math.tan(max(angles.greatest.value, -angles.least.value)))
    v = zeros(off, u - wide, u + wide, u, SETTLED * max(abs(first), abs(last)))
    # what is left of the way to the input is gone along the parallel's tangent
    point, tangent, _ = place(v)
    input_, lift = follower.lift_at(point)
    per_input, per_lift = follower.rates_along(point, tangent)
    reached: Array = lift + (u - input_) * per_lift / per_input
    return reached


def motion_limits(follower: LinearFollower, tolerances: Sequence[float]) -> list[float]:
    """Greatest motion errors, mm or degrees, that flanks within each of the tolerances, mm, can cause.

    To first order e/cos alpha along a stem, e/(l cos alpha) by an arm; taken to the parallels of the pitch curve.
    """
    angles, (_, last) = pressure_angles(follower), follower.span
    u = np.concatenate([follower.cells, [angles.greatest.at, angles.least.at]])
    lift = follower.law.derivatives(u, 0, np.where(u < last, 1, -1))[0]
    apart = np.array([side * e for e in tolerances for side in (1.0, -1.0)])
    found = parallel_lift(follower, np.repeat(apart, len(u)), np.tile(u, len(apart))).reshape(len(tolerances), -1)
    most = np.nanmax(np.abs(found - np.tile(lift, 2)), axis=1) * (1.0 + SLACK)
    limits: list[float] = (np.degrees(most) if follower.unit == "deg" else most).tolist()
    return limits
