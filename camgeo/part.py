"""The plain part round the contour: what its bore leaves of the metal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.radius import roots

if TYPE_CHECKING:
    from camgeo.curve import Array, Curve, Frame

LOOKS = 8  # points of each cell at which the distance from the shaft is looked at
SETTLED = 1e-9  # of the interval: a least distance is off by the square of this


def least_wall(contour: Curve, bore: float) -> tuple[float, float]:
    """Least wall in mm between a bore of this diameter about the shaft and the contour, and where (parameter).

    Negative where the bore breaks through, and where the shaft lies outside the contour.
    """
    cells = contour.cells
    share = np.linspace(0.0, 1.0, LOOKS + 1)
    t = cells.low[:, None] + (cells.high - cells.low)[:, None] * share
    low, high = t[:, :-1].ravel(), t[:, 1:].ravel()
    # between two nodes the nearest point is where the radius meets the tangent square: its product changes sign upwards
    first, last = contour.span(low, high)
    falls, rises = _outward(first), _outward(last)
    turning = (falls < 0.0) & (rises > 0.0)
    nearest_points = roots(
        lambda t: _outward(contour.sample(t)), low[turning], high[turning], (falls[turning], rises[turning]), SETTLED
    )
    nodes = np.concatenate([low, nearest_points])
    point = contour.sample(nodes).point
    distance = np.hypot(point[:, 0], point[:, 1])
    nearest = int(np.argmin(distance))
    ring = first.point
    around = np.append(ring, ring[:1], axis=0)
    turned = np.arctan2(
        around[:-1, 0] * around[1:, 1] - around[:-1, 1] * around[1:, 0], np.sum(around[:-1] * around[1:], axis=1)
    )
    inside = abs(float(turned.sum())) > np.pi
    side = 1.0 if inside else -1.0
    return side * float(distance[nearest]) - 0.5 * bore, float(nodes[nearest])


def _outward(at: Frame) -> Array:
    """Radius times the rate at which it grows along the curve (n,)."""
    product: Array = np.sum(at.point * at.tangent, axis=1)
    return product
