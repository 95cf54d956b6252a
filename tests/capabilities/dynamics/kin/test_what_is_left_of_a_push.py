"""The smooth motion that a look takes off a push, and the bound of what it leaves, by quadrature of the equation.

Holds: kin.dynamics.separation_bounds.
"""

import math

import numpy as np
import pytest
from numpy.polynomial import chebyshev
from support.dynamics_oracle import Cycloid
from support.trains import stiff

from kin.dynamics.drive import drives
from kin.dynamics.events import Work
from kin.dynamics.separation_bounds import Look


@pytest.mark.parametrize(("r", "zeta"), [(30.0, 0.0), (30.0, 0.3), (2.5, 0.3), (1.5, 0.8)])
def test_what_a_smooth_motion_leaves_of_a_push(r, zeta):
    """q' is the slope of q, and the integral of |g - (q'' + 2 a q' + r^2 q)| keeps below its bound, not far below."""
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    train, rpm = stiff(r, zeta, rpm=300.0, preload=300.0), 300.0
    look = Look(train, drive, rpm, Work(10**6))
    a = zeta * r
    push = train.at(rpm).forcing.series(look.response.drive)
    q, rate, bound = look._particular(push)
    half, x = look.response.half, np.linspace(-1.0, 1.0, 401)
    slope, bend = chebyshev.chebder(q.T) / half, chebyshev.chebder(q.T, 2) / half**2
    pushed, at, rising, bending, told = (chebyshev.chebval(x, row) for row in (push.T, q.T, slope, bend, rate.T))
    assert told == pytest.approx(rising, abs=1e-9 * np.abs(rising).max())
    left = pushed - (bending + 2.0 * a * rising + r * r * at)
    integral = half * np.trapezoid(np.abs(left), x, axis=1)
    assert (integral <= bound * (1.0 + 1e-4) + 1e-12 * np.abs(pushed).max()).all()
    # of g/r^2 and g/r^2 - 2 a g'/r^4 that which leaves less is taken
    rows = [chebyshev.chebval(x, chebyshev.chebder(push.T, k)) / half[:, None] ** k for k in range(4)]
    plain = -(rows[2] + 2.0 * a * rows[1]) / r**2
    dragged = plain + 2.0 * a / r**4 * (rows[3] + 2.0 * a * rows[2] + r * r * rows[1])
    least = min(float((half * np.trapezoid(np.abs(row), x, axis=1)).sum()) for row in (plain, dragged))
    assert integral.sum() > 0.93 * bound.sum()
    assert integral.sum() == pytest.approx(least, rel=1e-9)
