"""Play of a follower between the exact flanks of a groove with a clearance, by rollers set down on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.cylindrical.gauge import gauges_of
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array

ACROSS = 33  # places across a roller
ROUNDS = 7  # of a search for a level place, each 8 times as fine
WITHIN = 0.999  # of a roller's radius: so far across it contact is looked for


def exact_play(drum: DrumIntent, theta: Array) -> Array:
    """Travel (n,), mm or rad, of the follower between exact flanks at shaft angles (n,), rad, cam at rest.

    In a groove with a clearance the roller goes up until it meets the upper flank, which it does at one of its ends, or
    where the blank ends there; elsewhere there is no play.
    """
    if not drum.track.clearance:
        return np.zeros(len(theta))
    _, upper = gauges_of(drum)
    roller = replace(upper, radius=drum.follower.radius)

    def play(end: float) -> Array:
        return least_across(lambda y: room_of(upper, roller, theta, y, (end, drum.radius)), upper, theta, ROUNDS)[1]

    found = play(drum.follower.inner), play(drum.follower.outer)
    least: Array = np.minimum(*found)
    return least


def room_of(gauge: Gauge, roller: Gauge, theta: Array, across: Array, ends: tuple[float, float]) -> Array:
    """How far (n, m) a roller at angles (n,) may go, mm or rad, until it meets the exact flank of a gauge.

    It does so at places across its axis (n, m), mm, and along it at the first of `ends`, mm, or on the cylinder of the
    second, where the blank ends it; infinite where it meets nothing.
    """
    y = gauge.aside(theta)[:, None] + across
    x = np.minimum(ends[0], np.sqrt(ends[1] ** 2 - y * y))
    r, phi = np.hypot(x, y), theta[:, None] + np.arctan2(y, x)
    z = gauge.surface(phi.ravel(), r.ravel())
    points = np.stack([(r * np.cos(phi)).ravel(), (r * np.sin(phi)).ravel(), z], axis=-1)
    gives = roller.stand(points, np.repeat(theta, across.shape[1])).gives.reshape(across.shape)
    return np.where(np.isfinite(gives), -gives / gauge.lever, np.inf)


def least_across(function: Callable[[Array], Array], gauge: Gauge, theta: Array, rounds: int) -> tuple[Array, Array]:
    """Place across a roller, mm, at which a function of places (n, m) is least, and its value, by closer grids."""
    middle, roller = np.zeros((len(theta), 1)), gauge.largest
    width = WITHIN * roller
    for _ in range(rounds):
        y = np.clip(middle + width * np.linspace(-1.0, 1.0, ACROSS), -WITHIN * roller, WITHIN * roller)
        values = function(y)
        best = values.argmin(axis=1)[:, None]
        middle = np.take_along_axis(y, best, axis=1)
        width /= 0.25 * ACROSS
    return middle[:, 0], np.take_along_axis(values, best, axis=1)[:, 0]
