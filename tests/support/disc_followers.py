"""The follower of every disc cam of `support.discs`, and contours of them as a file would hold them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from support.discs import CONTOURS, DEGREE, M01, M02, M03, M05, M06, M07, M08, TURN

from camgeo.curve.curve import Curve
from camgeo.curve.moving_frame import Oscillating
from camgeo.fit.arcs import fit_arcs
from kin.contour.contour import Contour
from kin.follower.follower import Roller
from kin.follower.guide import LEADING, TRAILING, Arm, Translating
from kin.law.piecewise import Piecewise
from kin.law.segment import Affine, Constant


def raised(over, by):
    functions = tuple(Constant(f.value + by) if isinstance(f, Constant) else Affine(f, by) for f in over.functions)
    return Piecewise(over.knots, functions, over.period, over.smooth_seam)


def on_stem(motion, prime, offset, radius, **other):
    return Roller(Translating(offset), radius, raised(motion.over, np.sqrt(prime**2 - offset**2)), **other)


def on_arm(motion, prime, pivot, length, side, radius, **other):
    rest = Oscillating.on(prime, pivot, length, side).rest
    return Roller(Arm(length, pivot, TRAILING if side > 0 else LEADING), radius, raised(motion.over, rest), **other)


FOLLOWERS = {
    "roller": on_stem(M01, 50.0, 0.0, 10.0),
    "roller, offset": on_stem(M02, 45.0, 10.0, 9.0),
    "roller, offset against": on_stem(M02, 45.0, -10.0, 9.0),
    "knife edge": on_stem(M05, 30.0, 0.0, 0.0),
    "shoe": on_stem(M06, 85.0, 0.0, 60.0),
    "trailing arm": on_arm(M07, 42.0, 80.0, 65.0, 1, 8.0),
    "leading arm": on_arm(M07, 42.0, 80.0, 65.0, -1, 8.0),
    "ring": on_stem(M01, 50.0, 0.0, 10.0, internal=True),
}


@lru_cache
def chain(name, tolerance=1e-5):
    return fit_arcs(Curve.whole(CONTOURS[name]), tolerance)


def contour(name, tolerance=1e-5):
    made = chain(name, tolerance)
    return Contour.from_bulges(made.points, made.bulges)
