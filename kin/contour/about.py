"""Contours about the shaft at the origin: which contours go round it, and which are circles about it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import cross, dot, radial
from kin.contour.nearest import nearest
from kin.contour.pieces import LINE
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.contour import Contour

ROUND = 1e-4  # of the radius: greatest difference of the corners' distances from the centre
# Of the radius: the middles of a polygon's edges lie inside the circle by less, that of a D-shaped bore's flat by more.
FLAT = 0.01
LEVEL = 1e-9  # slope that is still rounding


def goes_round(contour: Contour) -> bool:
    """Whether a contour encloses the shaft, in either sense."""
    chain, off = contour.rough
    if off and bool(nearest(chain, np.zeros((1, 2)))[1][0] <= off):
        chain = contour.as_arcs()[0]
    start, end = chain.start, chain.ends
    angle = np.arctan2(cross(start, end), dot(start, end))
    # seen from between a piece and its chord, the piece goes the other way round
    way = np.sign(chain.curvature)
    between = (way * radial(chain, np.zeros(2)) < 0.0) & (way * angle < 0.0)
    return bool(abs((angle + TURN * way * between).sum()) > np.pi)


def circle_about(contour: Contour, x: float = 0.0, y: float = 0.0) -> float | None:
    """Diameter, mm, of a contour that is a circle about (x, y), mm, or a polygon on a circle; None for any other."""
    ends, middles = (np.hypot(*(contour.sample(2)[k::2] - (x, y)).T) for k in (0, 1))
    radius = float(ends.mean())
    round_all = np.ptp(ends) <= ROUND * radius and float(np.abs(middles - radius).max()) <= FLAT * radius
    return 2.0 * radius if round_all else None


def tracks(contours: Sequence[Contour]) -> list[Contour]:
    """Contours round the shaft on which a follower can run, in the order of falling area; empty where none goes round.

    Circles about the shaft are the outline of a ring or of a groove's blank, or the bore, and a frame is that of the
    sheet: they are left out where there is another contour round the shaft.
    """
    around = sorted(filter(goes_round, contours), key=lambda contour: -abs(contour.area))
    framed = [contour for contour in around if not is_frame(contour)]
    return [contour for contour in framed if circle_about(contour) is None] or framed or around


def is_frame(contour: Contour) -> bool:
    """Whether a contour is made of lines along x and y alone, as the frame of a sheet is and no cam."""
    along = np.abs(contour.end - contour.start)
    return bool((contour.kind == LINE).all() and (along.min(axis=1) <= LEVEL * along.max(axis=1)).all())
