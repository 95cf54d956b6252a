"""The exact volume of an indexing cam: the blank less what rollers sweep, by quadrature over layers and angles.

In a layer, at a polar angle, each roller sweeps one stretch of heights while it passes. The stretch ends at the least
and the greatest height at which the roller leaves the layer. These are sampled over the angles of the cam, and taken
from the parabola through the greatest three samples. No flank is needed for it, and nothing is proved.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from kin.indexing.rollers import Rollers
    from kin.numeric.arrays import Array

ANGLES = 360  # of a turn
LAYERS = 8  # by Gauss' rule from the blank to the floor
HEIGHTS = 9  # at which it is looked how far round the cam a roller reaches
SAMPLES = 73  # of the angles at which a roller passes a place


class Volume(NamedTuple):
    """Volume, mm^3, and by how much it may be off: what half as many angles change of it."""

    value: float
    remainder: float


def exact_volume(rollers: Rollers) -> Volume:
    """Volume of the intended cam with what the rollers sweep cut down to its floor."""
    intent = rollers.intent
    form, ends = intent.form, intent.ends
    shares, weights = np.polynomial.legendre.leggauss(LAYERS)
    depth, weights = 0.5 * form.depth * (1.0 + shares), 0.5 * form.depth * weights
    low, high = form.faces(depth, ends)
    whole = form.measure(depth, high) - form.measure(depth, low)
    rows = np.stack([_taken(rollers, float(one)) for one in depth], axis=-1)  # (angles, layers)
    left = whole - rows
    bore = 0.0 if intent.bore is None else intent.bore.contour.area * intent.length
    fine, coarse = (TURN * float((part @ weights).mean()) for part in (left, left[::2]))
    return Volume(form.core(ends) - bore + fine, abs(fine - coarse))


def _taken(rollers: Rollers, depth: float) -> Array:
    """What rollers take of a layer (ANGLES,), per depth and polar angle, mm^2: stretches that overlap count once."""
    form, layer = rollers.intent.form, np.full(1, depth)
    bottom, top = form.faces(layer, rollers.intent.ends)
    phi = np.arange(ANGLES) * np.float64(TURN / ANGLES)
    total, reached = np.zeros(ANGLES), np.broadcast_to(bottom, (ANGLES,))
    for least, most in swept_stretches(rollers, depth, phi):
        met = np.isfinite(least) & np.isfinite(most)
        begin = np.where(met, np.maximum(np.clip(least, bottom, top), reached), 0.0)
        end = np.where(met, np.maximum(np.clip(most, bottom, top), begin), 0.0)
        total = total + np.where(met, form.measure(layer, end) - form.measure(layer, begin), 0.0)
        reached = np.where(met, np.maximum(reached, end), reached)
    return total


def swept_stretches(rollers: Rollers, depth: float, phi: Array) -> list[tuple[Array, Array]]:
    """Least and greatest height that each roller takes of a layer at polar angles (n,), rad, from the lowest roller on.

    Heights are over the turret's centre, mm, of a globoid angles about the turret's axis; nan where it takes nothing.
    """
    intent = rollers.intent
    form, layer = intent.form, np.full(1, depth)
    radius = max(intent.radius(-1), intent.radius(1))
    heights = np.linspace(*intent.ends, HEIGHTS)
    found = [form.window(form.rims(depth, height), height, radius) for height in heights[:, None]]
    low, high = min(float(one[0]) for one, _ in found), max(float(other[0]) for _, other in found)
    ahead = np.linspace(low, high, SAMPLES)
    theta = (phi[:, None] - ahead).ravel()
    psi = (rollers.turning.at(theta)[0] + intent.pitch * np.floor(theta / TURN)).reshape(len(phi), SAMPLES)
    first = math.floor((-0.5 * math.pi - float(psi.max())) / intent.pitch)
    last = math.ceil((0.5 * math.pi - float(psi.min())) / intent.pitch)
    stretches = []
    for k in range(first, last + 1):
        own = psi + k * intent.pitch
        own = np.where(np.abs(own) <= 0.5 * math.pi, own, np.nan)
        least = -_greatest(-form.swept(layer, ahead, own, (intent.radius(-1), -1)))
        stretches.append((least, _greatest(form.swept(layer, ahead, own, (intent.radius(1), 1)))))
    return stretches


def _greatest(values: Array) -> Array:
    """Greatest of rows (n, m), by the parabola through the greatest of them and those beside it; nan for none."""
    values = np.where(np.isfinite(values), values, -np.inf)
    at = np.clip(values.argmax(axis=1), 1, values.shape[1] - 2)
    rows = np.arange(len(values))
    before, here, after = (values[rows, at + k] for k in (-1, 0, 1))
    with np.errstate(invalid="ignore", divide="ignore"):
        bend = before - 2.0 * here + after
        more = np.where(bend < 0.0, -0.125 * (after - before) ** 2 / bend, 0.0)
    inside = np.isfinite(before) & np.isfinite(after) & (here >= before) & (here >= after)
    most = values.max(axis=1)
    return np.where(np.isfinite(most), np.where(inside, here + np.where(inside, more, 0.0), most), np.nan)
