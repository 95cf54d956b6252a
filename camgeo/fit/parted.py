"""Shaft angles between which a line or a path is straight within a tolerance, by bounds of how it bends."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.arrays import runs_of

if TYPE_CHECKING:
    from kin.law.piecewise import Piecewise
    from kin.numeric.arrays import Array

LOOKS = 720  # parts of a turn over each of which a second derivative is bounded
WIDEST = TURN / 36.0  # rad between two angles, however little a line bends


def looks_of(law: Piecewise) -> Array:
    """Angles (n + 1,), rad, over a period, between which a second derivative is bounded; breaks are among them."""
    period = law.period or TURN
    looks = np.linspace(0.0, period, round(LOOKS * period / TURN) + 1)
    return np.unique(np.concatenate([looks, np.mod(law.breaks, period), [period]]))


def parted(look: Array, bend: Array, tolerance: float) -> tuple[Array, float]:
    """Angles over a period, rad, without its end, and the bound of what lies between them, mm.

    `bend` (n,) bounds the second derivative over each part of `look` (n + 1,).
    """
    widest = np.minimum(np.sqrt(8.0 * tolerance / np.maximum(bend, 1e-300)), WIDEST)
    count = np.maximum(np.ceil(np.diff(look) / widest), 1).astype(np.intp)
    off = float((bend * (np.diff(look) / count) ** 2).max()) / 8.0
    own, step = runs_of(count)
    return look[own] + (np.diff(look) / count)[own] * step, off
