"""How far a contour from a file lies from the exact one, both ways: what contact cannot feel is measured as well.

From the file to the exact contour: the excess of every point, its extremes found piece by piece
(`kin.numeric.extrema`). From the exact contour to the file: a closed contour within a tube about the exact one, whose
feet go round it once, meets every normal of it inside the tube, so no point of the exact contour is farther from the
file than the tube is wide. That takes normals that do not cross inside the tube: tight corners, whose radius of
curvature compares with the tube's width, are measured on their own. The feet also show a contour that turns back on
itself within the tube.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import dot, left
from kin.numeric.extrema import extremes, resolution
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.contour.arcs import Arcs
    from kin.contour.bezier import Beziers
    from kin.contour.contour import Contour
    from kin.follower.envelope import Envelope
    from kin.numeric.arrays import Array, Indices
    from kin.numeric.extrema import Extremes
    from kin.numeric.feet import Feet

LEAST_PARTS = 1024  # a contour of fewer pieces is cut into about so many
TIGHT = 4.0  # widths of the tube: a smaller radius of curvature makes a tight corner
CUT_OFF = 2e-11  # of the extent: points of the exact curve with more excess are no part of the trimmed contour
MOST_TURN = 0.05  # rad; greatest turn of a part
HALVINGS = 50  # of the parameter between two neighbours, in the search for a corner: to the last places
JOINED = 1e-12  # ends closer than this share of the contour's extent are one point


@dataclass(frozen=True)
class Deviation:
    """Two-sided distance of a contour from the exact one.

    outside, inside     greatest excess, and greatest want, of metal, mm; one is below 0 if the contour lies wholly on
                        the other side
    bare                greatest distance of a tight corner of the exact contour from this one, mm; 0 without any
    outside_at, ...     the envelope's parameters of those places; `bare_at` is nan without a tight corner
    rounds              number of turns that the feet make along the exact contour, above 0 counter-clockwise
    backwards           greatest length, mm, of a run in which the feet go back
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
        """Greatest two-sided deviation, mm, and the envelope's parameter there."""
        return max((self.outside, self.outside_at), (self.inside, self.inside_at), (self.bare, self.bare_at))

    def less_sure(self, by: float) -> Deviation:
        """Copy with all distances greater by `by`, mm, the distance by which the contour itself may be off."""
        return replace(self, outside=self.outside + by, inside=self.inside + by, bare=self.bare + by)


class _OfArcs(NamedTuple):
    """Lines and arcs, as `deviation` runs along them: by their arc length."""

    pieces: Arcs

    @property
    def ends(self) -> tuple[Array, Array]:
        """Arc lengths (n,) from which and to which each piece is followed."""
        return np.zeros(len(self.pieces)), self.pieces.length

    def rows(self, s: Array, piece: Indices) -> tuple[Array, Array, Array]:
        """Points and two derivatives by the arc length, (k, 2) each."""
        here = self.pieces.take(piece)
        tangent = here.tangents(s)
        return here.points(s), tangent, here.curvature[:, None] * left(tangent)


class _OfBeziers(NamedTuple):
    """Equal parts (n,) of polynomials, by their parameter: the row of each, where it starts and where it ends."""

    beziers: Beziers
    row: Indices
    ends: tuple[Array, Array]

    def rows(self, t: Array, piece: Indices) -> tuple[Array, Array, Array]:
        """Points and two derivatives by the parameter, (k, 2) each."""
        return self.beziers.rows(self.row[piece], t)


def _walk(contour: Contour, within: float | None) -> _OfArcs | _OfBeziers:
    """The contour in about LEAST_PARTS parts that turn little; arcs within a distance, mm, stand for mixed splines."""
    if contour.is_spline:
        count = np.ceil(np.maximum(LEAST_PARTS / len(contour), np.abs(contour.turns) / MOST_TURN)).astype(np.intp)
        row = np.repeat(np.arange(len(contour)), count)
        number = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
        return _OfBeziers(contour.beziers.elevated(2), row, (number / count[row], (number + 1.0) / count[row]))
    chain, _ = contour.as_arcs(within)
    coarse = chain.length.sum() / LEAST_PARTS
    parts = np.ceil(np.maximum(chain.length / coarse, np.abs(chain.curvature) * chain.length / MOST_TURN))
    return _OfArcs(chain.cut(np.maximum(parts, 1.0).astype(np.intp))[0])


def deviation(contour: Contour, envelope: Envelope, within: float | None = None) -> Deviation:
    """Deviation of a closed contour from an exact one.

    A contour of polynomials alone is followed itself. Arcs stand for rational pieces, and for splines beside lines and
    arcs: to `within`, mm, or to the contour's own tolerance where that is None. Raises UnsettledError where a foot or
    an extreme is not found, ValueError where rounding is larger than `within`.
    """
    # feet of both ends of all parts: an end is the next part's start, unless the file leaves gaps
    walk = _walk(contour, within)
    low, high = walk.ends
    every = np.arange(len(low))
    start, *first = walk.rows(low, every)
    end, *last = walk.rows(high, every)
    feet = envelope.feet(start)
    apart = np.abs(end - np.roll(start, -1, axis=0)).max() > JOINED * np.abs(start).max()
    end_feet = envelope.feet(end) if apart else _rolled(feet)

    def inside(x: Array, piece: Indices) -> Array:
        point, *derivatives = walk.rows(x, piece)
        return _along(envelope.feet(point), *derivatives)

    def parameter(piece: int, x: float) -> float:
        point, *_ = walk.rows(np.array([x]), np.array([piece]))
        return float(envelope.feet(point).parameter[0])

    # one way the extremes of the excess along the parts, the other way tight corners of the exact contour left bare
    fine = resolution(np.append(start, [[envelope.extent, 0.0]], axis=0))
    excess = extremes(low, high, _along(feet, *first), _along(end_feet, *last), inside, resolution=fine)
    bare, bare_at = _bare(contour, envelope, max(excess.greatest, -excess.least), within)
    # how far the foot goes on along each part
    advance = np.mod(end_feet.parameter - feet.parameter + np.pi, 2.0 * np.pi) - np.pi
    return Deviation(
        outside=excess.greatest,
        outside_at=parameter(excess.greatest_index, excess.greatest_at),
        inside=-excess.least,
        inside_at=parameter(excess.least_index, excess.least_at),
        bare=bare,
        bare_at=bare_at,
        rounds=round(float(advance.sum()) / (2.0 * np.pi)),
        backwards=_longest_run(np.where(advance < 0.0, np.abs(dot(end - start, left(feet.normal))), 0.0)),
    )


def convex_deviation(reach: Extremes) -> Deviation:
    """Deviation of a convex contour from a convex exact one, from the extremes `reach` of q - p, mm, over theta.

    q is the contour's support function, p the exact one. For convex bodies the Hausdorff distance is the greatest
    difference of their support functions, either way.
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


def _bare(contour: Contour, envelope: Envelope, width: float, within: float | None) -> tuple[float, float]:
    """Greatest distance, mm, from the contour of the exact contour's tight corners, and the parameter of that place.

    `width`, mm, is the tube's: the greatest excess or want. Without a tight corner 0 and nan come back.
    """
    parameter, radius = envelope.radii()
    tight = np.abs(radius) < TIGHT * width
    if not envelope.regular:
        parameter, tight = _trimmed(envelope, parameter, tight)
    if not tight.any():
        return 0.0, float("nan")
    parameter = parameter[tight]
    distance = contour.distance(envelope.points(parameter), within)
    worst = int(np.argmax(distance))
    return float(distance[worst]), float(parameter[worst])


def _trimmed(envelope: Envelope, parameter: Array, tight: NDArray[np.bool_]) -> tuple[Array, NDArray[np.bool_]]:
    """Parameters and whether each is tight, without what an undercut cuts off, with the corners that it leaves."""
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


def _along(feet: Feet, first: Array, second: Array) -> Array:
    """Excess and its two derivatives along a curve (3, n), from the feet of points on it.

    With the curve's derivatives x' and x'' (n, 2) there, M the quarter turn to the left, N the gradient of the excess
    and K the curvature of its level line: f' = N.x', f'' = N.x'' + K (x'.MN)^2.
    """
    bend = dot(feet.normal, second) + feet.curvature * dot(left(feet.normal), first) ** 2
    return np.stack([feet.excess, dot(feet.normal, first), bend])


def _rolled(feet: Feet) -> Feet:
    return type(feet)(*(np.roll(row, -1, axis=0) for row in feet.rows))


def _longest_run(length: Array) -> float:
    """Greatest sum of consecutive positive entries."""
    if not length.any():
        return 0.0
    total = np.cumsum(length)
    return float((total - np.maximum.accumulate(np.where(length == 0.0, total, 0.0))).max())
