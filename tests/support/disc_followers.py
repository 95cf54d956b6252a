"""The follower of every disc cam of `support.discs`, and contours of them as a file would hold them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from camgeo.curve.curve import Curve
from camgeo.curve.moving_frame import CentreShape, Oscillating
from camgeo.curve.parallel import Parallel
from camgeo.fit.arcs import fit_arcs
from kin.contour.contour import Contour
from kin.follower.guide import Arm, Line
from kin.law.contacts import LEADING, TRAILING
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Constant
from kin.law.support_function import Lift
from support import followers
from support.discs import CONTOURS, DEGREE, M01, M02, M03, M05, M06, M07, M08, arm, offset


def raised(over, by):
    functions = tuple(
        Constant(f.value + by) if isinstance(f, Constant) else AffineStretch(f, by) for f in over.functions
    )
    return Piecewise(over.knots, functions, over.period, over.smooth_seam)


def on_stem(motion, prime, offset, radius, **other):
    return followers.roller(Line(offset), radius, raised(motion.over, np.sqrt(prime**2 - offset**2)), **other)


def on_arm(motion, sized, radius, **other):
    guide = Arm(sized.length, sized.pivot, TRAILING if sized.side > 0 else LEADING)
    return followers.roller(guide, radius, raised(motion.over, sized.rest), **other)


def on_face(motion, base, tilt=None):
    lift = Lift(raised(motion.over, base / np.cos(tilt or 0.0)))
    return followers.flat_face(lift) if tilt is None else followers.flat_face(lift, tilt)


def on_swinging_face(motion, base, pivot, offset, side):
    law = raised(motion.over, np.arcsin((base + offset) / pivot))
    return followers.swinging_face(pivot, offset, law, TRAILING if side > 0 else LEADING)


CURVES = CONTOURS | {
    "knife edge, offset": offset(10.0),
    "knife edge, leading arm": arm(-1),
    "shoe, trailing arm": Parallel(CentreShape(M07, Oscillating.on(325.0, 380.0, 215.0, 1)), 300.0),
    "ring, leading arm": Parallel(arm(-1), -8.0),
}

FOLLOWERS = {
    "roller": on_stem(M01, 50.0, 0.0, 10.0),
    "roller, offset": on_stem(M02, 45.0, 10.0, 9.0),
    "roller, offset against": on_stem(M02, 45.0, -10.0, 9.0),
    "knife edge": on_stem(M05, 30.0, 0.0, 0.0),
    "shoe": on_stem(M06, 85.0, 0.0, 60.0),
    "trailing arm": on_arm(M07, Oscillating.on(42.0, 80.0, 65.0, 1), 8.0),
    "leading arm": on_arm(M07, Oscillating.on(42.0, 80.0, 65.0, -1), 8.0),
    "ring": on_stem(M01, 50.0, 0.0, 10.0, side=-1),
    "knife edge, offset": on_stem(M02, 45.0, 10.0, 0.0),
    "knife edge, leading arm": on_arm(M07, Oscillating.on(42.0, 80.0, 65.0, -1), 0.0),
    "shoe, trailing arm": on_arm(M07, Oscillating.on(325.0, 380.0, 215.0, 1), 300.0),
    "ring, leading arm": on_arm(M07, Oscillating.on(42.0, 80.0, 65.0, -1), 8.0, side=-1),
    "flat": on_face(M03, 30.0),
    "flat, tilted": on_face(M03, 32.0, 8 * DEGREE),
    "trailing face": on_swinging_face(M08, 36.0, 90.0, 10.0, 1),
    "leading face": on_swinging_face(M08, 36.0, 90.0, 10.0, -1),
}


@lru_cache
def chain(name, tolerance=1e-5):
    return fit_arcs(Curve.whole(CURVES[name]), tolerance)


def contour(name, tolerance=1e-5):
    made = chain(name, tolerance)
    return Contour.from_bulges(made.points, made.bulges)


def fitted(curve, tolerance):
    """Contour of a shape or of a curve made of one, of arcs."""
    made = fit_arcs(curve if isinstance(curve, Curve) else Curve.whole(curve), tolerance)
    return Contour.from_bulges(made.points, made.bulges)
