"""Balls of derivatives that were sharpened, against exact fractions.

Holds: camgeo.curve.rates.
"""

from __future__ import annotations

from fractions import Fraction
from math import factorial

import numpy as np

from camgeo.curve.rates import _sharpen, _sharpen_balls
from kin.numeric.elementary import BallJet


def test_a_sharpened_ball_holds_its_bounds() -> None:
    """Of series, as of derivatives: division by factorials rounds, and what it rounds off is within."""
    rng = np.random.default_rng(5)
    mid = np.tile(rng.normal(0.0, 10.0, (7, 200)), 2)  # over intervals, then in their middles
    ball = BallJet(mid, np.abs(mid) * 1e-16)
    reach = np.full(200, 1e-3)
    sharp = _sharpen_balls(ball, reach)
    low, high = _sharpen(ball, reach)
    for k in range(3, 7):
        for i in range(200):
            centre, radius = Fraction(sharp.mid[k, i]), Fraction(sharp.rad[k, i])
            assert (centre - radius) * factorial(k) <= Fraction(low[k, i])
            assert (centre + radius) * factorial(k) >= Fraction(high[k, i])
