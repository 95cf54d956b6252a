"""Figures of a follower train of many cams at once, for a sweep."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.dynamics.figures import AT_SPEED, JAM_MARGIN
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.registry.capability import Estimate
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.registry.capability import SampledCams
    from kin.numeric.arrays import Array

PEAK_ERRORS = (1.3e-5, 5.5e-5, 6.3e-6)  # greatest on 1,000 random designs (`benchmarks/sweep.py screen`)
ANGLE_ERROR = 3.7e-4  # the same, degrees


def _peak(order: int, cams: SampledCams) -> Array:
    """Greatest magnitude of a time derivative of the motion at the recipe's speed, (m,), by cam; 0 without a speed."""
    rpm = cams.recipe.rpm
    return cams.peak(order, 0.0 if rpm is None else rpm * TURN / 60.0)


def _jam_margin(cams: SampledCams) -> Array:
    """Margin of the pressure angle below the one at which the stem jams in its guide, degrees, (m,); below 0 it jams.

    Raises TypeError where no stem is led in a guide.
    """
    train, lean = cams.recipe.of(Dynamics), cams.lean
    if train is None or train.guide is None or lean is None:
        raise TypeError("no stem is led in a guide")
    steepest = np.maximum(cams.most(cams.slope), lean)
    return math.degrees(train.guide.jam()) - np.degrees(np.arctan(steepest))


ESTIMATES = {
    **{name: Estimate(partial(_peak, k), PEAK_ERRORS[k - 1]) for k, name in enumerate(AT_SPEED, 1)},
    JAM_MARGIN: Estimate(_jam_margin, ANGLE_ERROR, in_degrees=True),
}
