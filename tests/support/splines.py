"""Closed B-splines for tests, in both forms that files keep: clamped, and periodic."""

from __future__ import annotations

import numpy as np

from camgeo.fit.pieces import Bound, BSpline
from support.heavy import interpolate

NONE = Bound(0.0, 0.0)


def closed_spline(n=24, centre=(3.0, 4.0)):
    """Clamped cubic through points of an ellipse-like curve, its end on its start."""
    t = np.linspace(0.0, 2.0 * np.pi, n + 1)
    xy = np.column_stack((centre[0] + 9.0 * np.cos(t) + np.cos(3 * t), centre[1] + 6.0 * np.sin(t)))
    spline = interpolate.make_interp_spline(t, xy, k=3)
    control = spline.c.copy()
    control[-1] = control[0]
    spans = int(np.count_nonzero(np.diff(spline.t)))
    return BSpline(3, control, spline.t, spans, NONE)


def periodic_spline(m=9, degree=3):
    t = np.arange(m) * 2.0 * np.pi / m
    loop = np.column_stack((5.0 * np.cos(t), 5.0 * np.sin(t) + np.cos(2 * t)))
    return BSpline(degree, np.concatenate((loop, loop[:degree])), np.arange(m + 2.0 * degree + 1.0), m, NONE)
