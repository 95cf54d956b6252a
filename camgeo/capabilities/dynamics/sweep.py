# needs: sweep
"""Estimates of a follower train's figures for many cams at once, for a sweep."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.dynamics.figures import AT_SPEED, JAM_MARGIN
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.sweep.extension import Estimate, Estimates
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.sweep.extension import SampledCams
    from kin.numeric.arrays import Array

# greatest errors on 1,000 random designs (`benchmarks/sweep.py screen`)
PEAK_ERRORS = (1.3e-5, 5.5e-5, 6.3e-6)  # shares of velocity, acceleration and jerk
ANGLE_ERROR = 3.7e-4  # degrees


def _peak(order: int, cams: SampledCams) -> Array:
    """Greatest magnitude of a time derivative, from order 1, at the recipe's speed, of each cam (m,); 0 without one."""
    rpm = cams.recipe.rpm
    return cams.peak(order, 0.0 if rpm is None else rpm * TURN / 60.0)


def _jam_margin(cams: SampledCams) -> Array:
    """Angle at which the stem jams in its guide less the pressure angle, degrees (m,); below 0 the stem jams.

    Raises TypeError where no stem is led in a guide.
    """
    train, lean = cams.recipe.of(Dynamics), cams.lean
    if train is None or train.guide is None or lean is None:
        raise TypeError("no stem is led in a guide")
    steepest = np.maximum(cams.most(cams.slope), lean)
    return math.degrees(train.guide.jam()) - np.degrees(np.arctan(steepest))


_ESTIMATES = {
    **{name: Estimate(partial(_peak, k), PEAK_ERRORS[k - 1]) for k, name in enumerate(AT_SPEED, 1)},
    JAM_MARGIN: Estimate(_jam_margin, ANGLE_ERROR, in_degrees=True),
}

ANSWERS = Estimates(estimates=_ESTIMATES)
