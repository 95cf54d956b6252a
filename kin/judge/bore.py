"""Round openings and outlines about the shaft: the bore of a plain part, the outline of a ring."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.about import goes_round
from kin.contour.arcs import dot, left
from kin.numeric.check import ROUNDING, Check, at_most, failed
from kin.numeric.extrema import extremes, resolution
from kin.numeric.lengths import UNIT, length_words, place_words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array, Indices


def bore_check(holes: Sequence[Contour], bore: float | None, tolerance: float, *, closed: bool = True) -> Check | None:
    """Check that one hole of diameter `bore`, mm, is there, round and about the shaft; None if no check is due.

    That is without a bore and without holes. Of a part that is not `closed` only the first hole round the shaft counts,
    and only against a bore.
    """
    if not closed:
        holes = [] if bore is None else [hole for hole in holes if goes_round(hole)][:1]
    if bore is None:
        if not holes:
            return None
        return failed("bore", f"{len(holes)} hole(s), where none is expected", unit="mm", limit=tolerance)
    if len(holes) != 1:
        detail = f"{len(holes)} holes, where one of diameter {length_words(bore, '.9g')} {UNIT} is expected"
        return failed("bore", detail, unit="mm", limit=tolerance)
    return round_check("bore", holes[0], bore, tolerance)


def round_check(name: str, contour: Contour, diameter: float, tolerance: float) -> Check:
    """Check that a contour is a circle of a `diameter`, mm, about the shaft, within `tolerance`, mm.

    Raises UnsettledError where rounding hides the extremes of its distance.
    """
    least, most = _distance_range(contour)
    across, box = 2.0 * float(np.sqrt(abs(contour.area) / np.pi)), contour.box
    worst = max(most - 0.5 * diameter, 0.5 * diameter - least, 0.5 * abs(across - diameter))
    place = place_words(0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max))
    detail = f"diameter {length_words(across, '.9g')} {UNIT} about {place}"
    return at_most(name, worst, tolerance, "mm", detail=detail, slack=ROUNDING * diameter)


def _distance_range(contour: Contour) -> tuple[float, float]:
    """Least and greatest distance, mm, of a contour from the origin."""
    arcs, _ = contour.as_arcs()
    pieces, _ = arcs.cut(np.ceil(np.maximum(np.abs(arcs.curvature) * arcs.length / 0.1, 1.0)).astype(np.intp))
    fine = resolution(pieces.start)

    def distance(s: Array, piece: Indices) -> Array:
        arcs_here = pieces.take(piece)
        x, tangent = arcs_here.points(s), arcs_here.tangents(s)
        r = np.maximum(np.hypot(x[:, 0], x[:, 1]), fine)
        slope = dot(x, tangent) / r
        return np.stack([r, slope, (1.0 + arcs_here.curvature * dot(x, left(tangent)) - slope**2) / r])

    every = np.arange(len(pieces))
    low, high = np.zeros(len(pieces)), pieces.length
    ends = extremes(low, high, distance(low, every), distance(high, every), distance, resolution=fine)
    return ends.least, ends.greatest
