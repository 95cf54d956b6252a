"""How far a contour from a file lies from the exact one, both ways: what contact cannot feel is measured as well.

From the file to the exact contour: the excess of every point, its extremes found piece by piece
(`kin.numeric.extrema`). From the exact contour to the file: a closed contour within a tube about the exact one, whose
feet go round it once, meets every normal of it inside the tube, so no point of the exact contour is farther from the
file than the tube is wide. That takes normals that do not cross inside the tube: tight corners, whose radius of
curvature compares with the tube's width, are looked at on their own. The feet also tell a contour that turns back on
itself within the tube.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import Arcs, dot, left
from kin.contour.nearest import nearest
from kin.numeric.extrema import extremes, resolution
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.follower.envelope import Envelope
    from kin.numeric.arrays import Array, Indices
    from kin.numeric.extrema import Extremes
    from kin.numeric.feet import Feet

LEAST_PARTS = 1024  # a contour of fewer pieces is cut into about so many
TIGHT = 4.0  # a radius of curvature below so many widths of the tube makes a tight corner
CUT_OFF = 2e-11  # of the extent; points of the exact curve with more excess are no part of the trimmed contour
MOST_TURN = 0.05  # rad; greatest turn of a part
HALVINGS = 50  # between two looks, in the search for a corner: to the last places
JOINED = 1e-12  # ends closer than this share of the contour's extent are one point


@dataclass(frozen=True)
class Deviation:
    """How far a contour lies from the exact one.

    outside, inside     greatest excess, and greatest want, of metal, mm; one is below 0 if the contour lies wholly on
                        the other side
    bare                greatest distance of a tight corner of the exact contour from this one, mm; 0 without any
    outside_at, ...     the envelope's parameters of those places
    rounds              how often the feet go round
    backwards           greatest length, mm, of a run in which they go back
    """

    outside: float
    outside_at: float
    inside: float
    inside_at: float
    bare: float
    bare_at: float
    rounds: int
    backwards: float

    @property
    def worst(self) -> tuple[float, float]:
        """Two-sided deviation, mm, and where: the envelope's parameter."""
        return max((self.outside, self.outside_at), (self.inside, self.inside_at), (self.bare, self.bare_at))

    def less_sure(self, by: float) -> Deviation:
        """Count in that the contour may be off by as much, mm."""
        return replace(self, outside=self.outside + by, inside=self.inside + by, bare=self.bare + by)


def deviation(chain: Arcs, envelope: Envelope) -> Deviation:
    """Deviation of a closed chain of lines and arcs from an exact contour."""
    coarse = chain.length.sum() / LEAST_PARTS
    parts = np.ceil(np.maximum(chain.length / coarse, np.abs(chain.curvature) * chain.length / MOST_TURN))
    pieces, _ = chain.cut(np.maximum(parts, 1.0).astype(np.intp))
    feet = envelope.feet(pieces.start)
    zero, end_tangents = np.zeros(len(pieces)), pieces.end_tangents
    ends, nexts = pieces.ends, np.roll(pieces.start, -1, axis=0)
    apart = np.abs(ends - nexts).max() > JOINED * np.abs(pieces.start).max()
    end_feet = envelope.feet(ends) if apart else _rolled(feet)

    def inside(s: Array, piece: Indices) -> Array:
        here = pieces.take(piece)
        return _along(envelope.feet(here.points(s)), here.tangents(s), here.curvature)

    at_start = _along(feet, pieces.tangent, pieces.curvature)
    at_end = _along(end_feet, end_tangents, pieces.curvature)
    fine = resolution(np.append(pieces.start, [[envelope.extent, 0.0]], axis=0))
    extremes_of_lift = extremes(zero, pieces.length, at_start, at_end, inside, resolution=fine)
    bare, bare_at = _bare(chain, envelope, max(extremes_of_lift.greatest, -extremes_of_lift.least))
    advance = np.mod(end_feet.parameter - feet.parameter + np.pi, 2.0 * np.pi) - np.pi
    return Deviation(
        outside=extremes_of_lift.greatest,
        outside_at=_parameter(pieces, envelope, extremes_of_lift.greatest_index, extremes_of_lift.greatest_at),
        inside=-extremes_of_lift.least,
        inside_at=_parameter(pieces, envelope, extremes_of_lift.least_index, extremes_of_lift.least_at),
        bare=bare,
        bare_at=bare_at,
        rounds=round(float(advance.sum()) / (2.0 * np.pi)),
        backwards=_longest_run(np.where(advance < 0.0, np.abs(dot(ends - pieces.start, left(feet.normal))), 0.0)),
    )


def convex_deviation(reach: Extremes) -> Deviation:
    """Deviation of a convex contour from a convex exact one, from the extremes of q - p over theta.

    For convex bodies the Hausdorff distance is the greatest difference of their support functions, either way.
    """
    return Deviation(
        outside=reach.greatest,
        outside_at=reach.greatest_at,
        inside=-reach.least,
        inside_at=reach.least_at,
        bare=0.0,
        bare_at=float("nan"),
        rounds=1,
        backwards=0.0,
    )


def _bare(chain: Arcs, envelope: Envelope, width: float) -> tuple[float, float]:
    """Greatest distance from the chain of the exact contour's tight corners, and the parameter of that place."""
    parameter, radius = envelope.radii()
    tight = np.abs(radius) < TIGHT * width
    if not envelope.regular:
        parameter, tight = _trimmed(envelope, parameter, tight)
    if not tight.any():
        return 0.0, float("nan")
    parameter = parameter[tight]
    _, distance = nearest(chain, envelope.points(parameter))
    worst = int(np.argmax(distance))
    return float(distance[worst]), float(parameter[worst])


def _trimmed(envelope: Envelope, parameter: Array, tight: NDArray[np.bool_]) -> tuple[Array, NDArray[np.bool_]]:
    """Leave out what an undercut cuts off, and add the corners that it leaves."""
    points = envelope.points(parameter)
    cut_off = CUT_OFF * float(np.abs(points).max())
    kept = envelope.feet(points).excess <= cut_off
    after = np.roll(kept, -1)
    edge = np.flatnonzero(kept != after)
    low, high = parameter[edge], np.append(parameter[1:], parameter[0] + 2.0 * np.pi)[edge]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = (envelope.feet(envelope.points(middle)).excess <= cut_off) == kept[edge]
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    corner = np.where(kept[edge], low, high)
    return np.concatenate([parameter, corner]), np.concatenate([tight & kept, np.ones(len(corner), dtype=bool)])


def _along(feet: Feet, tangent: Array, curvature: Array) -> Array:
    """Excess and its two derivatives along pieces (3, n), from the feet of points on them.

    With the pieces' tangents T (n, 2) and curvature k (n,) there, M the quarter turn to the left, N and K the gradient
    of the excess and the curvature of its line: f' = N.T, f'' = k N.MT + K (T.MN)^2.
    """
    side = left(feet.normal)
    rise = dot(feet.normal, tangent)
    bend = curvature * dot(feet.normal, left(tangent)) + feet.curvature * dot(side, tangent) ** 2
    return np.stack([feet.excess, rise, bend])


def _rolled(feet: Feet) -> Feet:
    return type(feet)(*(np.roll(row, -1, axis=0) for row in feet.rows))


def _parameter(pieces: Arcs, envelope: Envelope, piece: int, s: float) -> float:
    point = pieces.take(np.array([piece])).points(np.array([s]))
    return float(envelope.feet(point).parameter[0])


def _longest_run(length: Array) -> float:
    """Greatest sum of consecutive positive entries."""
    if not length.any():
        return 0.0
    total = np.cumsum(length)
    return float((total - np.maximum.accumulate(np.where(length == 0.0, total, 0.0))).max())
