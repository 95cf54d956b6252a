"""Motion and play of followers on the flanks of a plate or a groove as they lie in a file."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import Arcs
from kin.law.motion_error import MotionError, Play
from kin.linear.contact import Held
from kin.linear.motion import errors, intended
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.contour.contour import Contour
    from kin.linear.intent import PlateIntent
    from kin.linear.outline import Flank
    from kin.numeric.arrays import Array

STEPS = 720  # of the input, from which the root mean square is taken
PROBES = 16  # inputs about the least and the greatest play, in each closer look
ROUNDS = 12  # of these


class Metal(NamedTuple):
    """Where metal lies: outside the closed chain of a groove, or inside that of a plate."""

    outside: bool

    @staticmethod
    def of(plate: PlateIntent) -> Metal:
        """Side of the metal of a plate's flanks."""
        return Metal(plate.groove is not None)


def held_by(contour: Contour, flank: Flank, metal: Metal, tolerance: float, radius: float | None = None) -> Held:
    """Make ready the follower of a flank, with another roller of `radius`, mm, if that is given, on a contour."""
    follower = flank.follower if radius is None else replace(flank.follower, radius=radius)
    chain = contour.as_arcs()[0]
    chain = chain.reversed() if metal.outside else chain
    if flank.ends is None:
        chain = _endless(chain, flank, tolerance)
    near = max(0.5 * follower.radius, tolerance) if metal.outside else None
    return Held.of(chain, follower, flank.span, near)


def _endless(chain: Arcs, flank: Flank, tolerance: float) -> Arcs:
    """The flank's pieces of an endless plate, over and over, without the ends at which one joins the next."""
    low, high = flank.reach
    middle = chain.points(0.5 * chain.length)
    away = np.abs(flank.pitch.feet(middle).excess)
    between = (away <= tolerance) | ((middle[:, 0] > low + tolerance) & (middle[:, 0] < high - tolerance))
    if not between.any():
        return chain.take(between)
    # runs of pieces between two ends: the flank, and an edge or a flank across from it
    first = int(np.argmin(between))
    order = np.roll(np.arange(len(chain)), -first)
    order = order[between[order]]
    run = np.cumsum(np.diff(order, prepend=order[:1]) % len(chain) > 1)
    nearest = int(np.argmin([np.median(away[order[run == k]]) for k in range(int(run.max(initial=0)) + 1)]))
    own = chain.take(order[run == nearest])
    # they run towards -x, as metal lies to their left, and so do the copies
    turns = np.arange(flank.copies + flank.periods, -flank.copies - flank.periods - 1, -1)
    turns = turns[np.mod(turns, flank.periods) == 0]
    shifts = np.stack([turns * (flank.follower.span[1] - flank.follower.span[0]), np.zeros(len(turns))], axis=-1)
    start = own.start + shifts[:, None, :]
    every = own.take(np.tile(np.arange(len(own)), len(turns)))
    return Arcs(start.reshape(-1, 2), every.tangent, every.curvature, every.length)


def judged_motion(held: Held, span: tuple[float, float]) -> MotionError:
    """Motion error over all inputs of the span, mm or degrees; RestError and UnsettledError as `errors` raises them."""
    least, most = errors(held, span)
    unit = held.follower.unit
    u = np.linspace(*span, STEPS + 1)
    off = held.reached(u) - intended(held.follower, u)
    worst = most if abs(most.error) >= abs(least.error) else least
    rest, rms = max(least.remainder, most.remainder), float(np.sqrt(np.mean(off * off)))
    found = MotionError(abs(worst.error), worst.at, rest, least.error, most.error, rms, unit)
    return found.scaled(math.degrees(1.0), unit) if unit == "deg" else found


def judged_play(lower: Held, upper: Held, span: tuple[float, float]) -> Play:
    """Free travel between a flank below and, reflected, one above: its extremes at ends of pieces, closely looked at.

    The same roller in both gives its own play; gauges, each the size of its flank, should fit without any.
    """

    def travel(u: Array) -> Array:
        return -upper.reached(u) - lower.reached(u)

    first, last = span
    ends = np.concatenate([lower.ends, upper.ends])
    u = np.unique(np.concatenate([[first], ends[(ends > first) & (ends < last)], [last]]))
    u = np.unique(np.concatenate([u, 0.5 * (u[1:] + u[:-1])]))
    (least, least_at), (most, most_at) = _best(travel, u, -1.0), _best(travel, u, 1.0)
    unit = lower.follower.unit
    scale = 180.0 / math.pi if unit == "deg" else 1.0
    return Play(scale * least, least_at, scale * most, most_at, unit)


def _best(function: Callable[[Array], Array], u: Array, sign: float) -> tuple[float, float]:
    """Extreme of a function from inputs u (n,), rising, looked at again about the best one, ever closer."""
    value = function(u)
    best = int(np.argmax(sign * value))
    found, at = float(value[best]), float(u[best])
    low, high = float(u[max(best - 1, 0)]), float(u[min(best + 1, len(u) - 1)])
    for _ in range(ROUNDS):
        near = np.linspace(low, high, PROBES)
        value = function(near)
        best = int(np.argmax(sign * value))
        if sign * value[best] > sign * found:
            found, at = float(value[best]), float(near[best])
        low, high = float(near[max(best - 1, 0)]), float(near[min(best + 1, PROBES - 1)])
    return found, at
