"""Least number of pieces of a curve within a tolerance, by theory to leading order (docs/theory.md 3)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.cubic import ORDER, span_density
from camgeo.fit.nodes import Density
from camgeo.fit.polygon import least_vertices

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Curve, Frame
    from kin.numeric.arrays import Array

FREE_ARCS = 124.7  # tangent-continuous arcs with joints off the curve: the integral of (|kappa'|/(124.7 e))^(1/3) ds


def least_pieces(form: str, curve: Curve, tolerance: float) -> float:
    """Least number of pieces within `tolerance` mm, to leading order: edges, arcs or cubic spans by the form.

    At least one arc or span is counted for each smooth stretch, as the arcs' integral vanishes on a dwell. Raises
    KeyError for an unknown form.
    """
    return COUNTS[form](curve, tolerance)


def least_arcs(curve: Curve, tolerance: float) -> float:
    """Least number of tangent-continuous arcs with free joints within `tolerance` mm, to leading order.

    At least one is counted for each smooth stretch.
    """
    parts = [part.total for run in curve.runs for part in Density.of(curve, run.stretches, _arc_density)]
    return sum(max(1.0, part / math.cbrt(tolerance)) for part in parts)


def least_spline(curve: Curve, tolerance: float) -> float:
    """Least number of cubic spans with a continuous tangent within `tolerance` mm, to leading order.

    At least one is counted for each smooth stretch.
    """
    stretches = np.concatenate([run.stretches for run in curve.runs])
    scale = math.pow(tolerance, -1.0 / ORDER)
    return float(np.maximum(1.0, scale * span_density(curve, stretches).totals).sum())


def _arc_density(frame: Frame) -> Array:
    """Density of tangent-continuous arcs by the parameter at unit tolerance: (|kappa'|/124.7)^(1/3) ds.

    Computed as the cube root of |omega' sigma - omega sigma'|, with sigma the speed and omega the rate at which the
    tangent turns, it needs no division.
    """
    slope = np.abs(frame.turn_slope * frame.speed - frame.turn * frame.speed_slope)
    density: Array = np.cbrt(slope / FREE_ARCS)
    return density


COUNTS: dict[str, Callable[[Curve, float], float]] = {
    "polyline": least_vertices,
    "stl": least_vertices,
    "arcs": least_arcs,
    "spline": least_spline,
}
"""Least number of pieces by the form of the file."""
