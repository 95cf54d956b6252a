"""The support function of a measured cam as a Fourier series: the harmonics that stand out of its uncertainty."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.follower.recognised import COVERAGE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kin.numeric.arrays import Array

STANDS_OUT = 2.0  # a harmonic below so many expanded uncertainties is noise


class SupportSeries(NamedTuple):
    """Support function mean + sum of cos[k] cos(k t) + sin[k] sin(k t), mm, t the angle of the normal, rad.

    `unsure` is the expanded uncertainty (k = 2) of each coefficient by the noise of the points, mm.
    """

    mean: float
    cos: Mapping[int, float]
    sin: Mapping[int, float]
    unsure: float

    def left(self, p: Array) -> float:
        """Greatest deviation, mm, from the values p (n,), mm, at equal steps of a turn."""
        t = 2.0 * math.pi / len(p) * np.arange(len(p))
        total = np.full(len(p), self.mean)
        for coefficients, wave in ((self.cos, np.cos), (self.sin, np.sin)):
            for k, size in coefficients.items():
                total += size * wave(k * t)
        return float(np.abs(p - total).max())


def support_series(p: Array, sd: float, spans: int) -> SupportSeries:
    """Harmonics of a support function p (n,), mm, at equal steps of a turn, that stand out of its uncertainty.

    `sd` is the standard deviation, mm, of p, which is a spline of `spans` spans; a coefficient has sd sqrt(2/spans).
    Harmonics from half the spans on are left out, since the spline does not resolve them.
    """
    waves = 2.0 * np.fft.rfft(p) / len(p)
    unsure = COVERAGE * sd * math.sqrt(2.0 / spans)
    orders = [k for k in range(1, spans // 2) if abs(waves[k]) > STANDS_OUT * unsure]
    return SupportSeries(
        0.5 * float(waves[0].real),
        {k: float(waves[k].real) for k in orders},
        {k: -float(waves[k].imag) for k in orders},
        unsure,
    )
