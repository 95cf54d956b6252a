"""Whether a flank is regular in all of the metal: proved, or refused.

A flank is regular where D > 0 (`camgeo.capabilities.indexing.flank`). In every layer a regular flank is a line along
which the polar angle rises, and each roller touches it at one place alone. If it is regular from floor to blank and
from one end face to the other, no roller cuts into what another one leaves. D > 0 is proved in cells of shaft angles
and rho; where an undercut is, and which roller would serve, is sampled.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.bends import pose_over
from camgeo.capabilities.indexing.spans import angles_of, breaks_within, layers_of
from camgeo.curve.curve import CurveError
from kin.numeric.angles import TURN
from kin.numeric.interval import Ball

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.flank import Flank
    from kin.numeric.arrays import Array, Mask

CELLS, PARTS, MOST_PARTS, ROUNDS, MOST_OPEN = 360, 4, 64, 15, 60_000  # of the proof: of a turn, of the depth, rounds
LAYERS = 17  # in which an undercut is sought


class UndercutError(CurveError):
    """A flank that is undercut within the metal, near a shaft angle `parameter`, rad, in the layer `w`, mm."""

    def __init__(self, message: str, parameter: float, w: float) -> None:
        super().__init__(message, parameter)
        self.w = w


def least_regular(flank: Flank) -> tuple[float, float, float]:
    """Least D/w of a flank among many places within the metal, its shaft angle, rad, and its layer, mm."""
    theta = angles_of(flank)
    pose = flank.pose(theta)
    best = (np.inf, float(theta[0]), flank.form.blank)
    for w in layers_of(flank, LAYERS).tolist():
        rho = flank.reached(pose, w)
        touch = flank.touch(pose, rho)
        z = flank.place(pose, rho, touch.sine, touch.cosine)[2]
        inside = np.isfinite(rho) & (z >= 0.0) & (z <= flank.form.length)
        if inside.any():
            share = np.where(inside, touch.regular / touch.w, np.inf)
            k = int(np.argmin(share))
            best = min(best, (float(share[k]), float(theta[k]), w))
    return best


def demand_regular(flank: Flank) -> None:
    """Raise UndercutError unless a flank is proved to be free of undercut within the metal."""
    least, at, layer = least_regular(flank)
    if least <= 0.0:
        raise UndercutError(f"the {flank.name} flank is undercut", at, layer)
    low, high = flank.form.reach(flank.radius)
    # behind an end face, too: a flank that turns back there might come back into the metal
    begin, end = angles_of(flank)[[0, -1]].tolist()
    breaks = breaks_within(flank)
    count = math.ceil(CELLS * (end - begin) / TURN)
    theta = np.unique(np.concatenate([np.linspace(begin, end, count + 1), breaks[(breaks > begin) & (breaks < end)]]))
    edges = np.linspace(low, high, min(math.ceil(PARTS * (high - low) / flank.form.depth), MOST_PARTS) + 1)
    n, parts = theta.size - 1, edges.size - 1
    a, b = np.tile(theta[:-1], parts), np.tile(theta[1:], parts)
    c, d = np.repeat(edges[:-1], n), np.repeat(edges[1:], n)
    for _ in range(ROUNDS):
        open_ = ~_proved(flank, (a, b), (c, d))
        if not open_.any():
            return
        if np.count_nonzero(open_) > MOST_OPEN:
            break
        a, b, c, d = a[open_], b[open_], c[open_], d[open_]
        t, rho = 0.5 * (a + b), 0.5 * (c + d)
        a, b = np.concatenate([a, t, a, t]), np.concatenate([t, b, t, b])
        c, d = np.concatenate([c, c, rho, rho]), np.concatenate([rho, rho, d, d])
    problem = f"the {flank.name} flank is so near to an undercut that it can be neither proved nor excluded"
    raise UndercutError(problem, float(a[0]), float(flank.along(a[:1], c[:1]).w[0]))


def _proved(flank: Flank, theta: tuple[Array, Array], rho: tuple[Array, Array]) -> Mask:
    """Cells (n,) of shaft angles and rho in which a flank is regular wherever it is in the metal."""
    form, pose, along = flank.form, pose_over(flank, theta), Ball.between(*rho)
    touch = flank.touch(pose, along)
    place = flank.place(pose, along, touch.sine, touch.cosine)
    layer, outwards = flank.outwards(pose, along, touch)
    outside = np.zeros(along.mid.shape, dtype=bool)
    low, high = sorted((form.floor, form.blank))
    for ball, least, most in ((layer, low, high), (place[2], 0.0, form.length)):
        below, above = ball.bounds()
        outside |= np.isfinite(ball.rad) & ((above < least) | (below > most))
    rising = flank.rising(touch, outwards)[1]
    sound = touch.regular.positive & touch.cosine.positive & (rising.positive | rising.negative)
    return np.asarray(outside | sound)
