"""A guided roller on a smooth contour of Bezier pieces: where it rests, and bounds of its error by their polynomials.

The roller's centre runs at its radius r beside the contour, along a path of arc length s and curvature k/(1 + k r),
whose derivative by s is k'/(1 + k r)^3; k and k' are those of the contour by its own arc length. Over a stretch of a
piece they are bounded by the Bernstein coefficients of X' x X'', X' x X''', X'.X'' and X' there, within whose hulls
these lie. `kin.follower.tracking` makes bounds of the error from that.

Where the path is smooth and the shaft angle rises strictly all along it, by one turn, it is the graph of the roller's
position over the shaft angle: there is one contact at each angle, nothing is hidden, and the error is that of the path.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kin.contour.arcs import cross, dot, right
from kin.follower.laws import own_rows
from kin.follower.tracking import RESOLUTION, CentreState, bounds_of_error
from kin.numeric.angles import TURN
from kin.numeric.bernstein import bernstein_product, cross_product, derivative, restrict
from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.contour.bezier import Beziers
    from kin.contour.contour import Contour
    from kin.follower.guide import Guide
    from kin.follower.tracking import DerivativeBounds, IntendedLaw
    from kin.law.contacts import Contact
    from kin.numeric.arrays import Array, Indices

# Of a radian, or of the contour's extent: positions by closed forms of a piece are good to a tenth of it.
ROUNDING = 1e-13
CELLS = 16  # of a piece, in the table of shaft angles
PARTS = 2  # of a piece, with which the search for its bounds begins
MOST_CUTS = 8  # in quarters, until the shaft angle is seen to rise
STEPS = 12  # of Newton's method
NEAR = 1e-6  # rad: from here a step of second order is good to rounding
ONCE_ROUND = 1e-8  # rad: what rounding may leave of a turn all round
ON_CONTOUR = 1e-8  # of the roller: how far along the contour the nearest point may be off
MOST_PLAY = 0.1  # of the roller: beyond, its nearest point may be another one


@dataclass(frozen=True, eq=False)
class SplinePath:
    """Path of the centre of a roller in contact, `offset` mm to the right of polynomial pieces of degree 3 or more.

    The pieces follow one another counter-clockwise, smoothly.
    """

    beziers: Beziers
    offset: float
    guide: Guide
    contact: Contact[Any, Any]

    @staticmethod
    def of(contour: Contour, offset: float, guide: Guide, contact: Contact[Any, Any]) -> SplinePath:
        """Path `offset` mm beside a contour, turned back by the angle that the contact's guide stands turned ahead.

        Raises UnsettledError where the path is not smooth, does not go once round, or is not all of polynomials.
        """
        if not contour.is_spline:
            raise UnsettledError("not all of the contour are polynomials")
        beziers = (contour.turned(-contact.turned) if contact.turned else contour).beziers
        path = SplinePath(beziers.elevated(3), offset, guide, contact)
        path.demand_smooth()
        return path

    @property
    def resolution(self) -> float:
        """Greatest motion error that rounding may feign, mm or rad.

        For a translating roller it is a share of the contour's extent, for an arm a constant.
        """
        return ROUNDING * (float(np.abs(self.beziers.control).max()) if self.guide.unit == "mm" else 1.0)

    def at(self, row: Indices, t: Array) -> tuple[CentreState, Array]:
        """State of the centre on pieces `row` (n,) at t (n,), and the derivative of its path's length by t (n,), mm."""
        x, v, w = self.beziers.rows(row, t)
        speed = np.hypot(v[:, 0], v[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):  # at a cusp nothing is proved
            tangent = v / speed[:, None]
            curvature = cross(v, w) / speed**3
            growth = 1.0 + self.offset * curvature
            state = CentreState.of(x + self.offset * right(tangent), tangent, curvature / growth, self.guide)
        return state, speed * growth

    def demand_smooth(self) -> None:
        """Raise UnsettledError unless the path is smooth and the graph of a position over the shaft angle, proved."""
        # a corner passes where the path keeps within rounding: ends that meet, and a tangent that hardly turns
        before, after = np.roll(self.beziers.velocity[:, -1], 1, axis=0), self.beziers.velocity[:, 0]
        turn = np.arctan2(cross(before, after), dot(before, after))
        gap = np.hypot(*(self.beziers.control[:, 0] - np.roll(self.beziers.control[:, -1], 1, axis=0)).T)
        extent = float(np.abs(self.beziers.control).max())
        if not (gap + (gap + abs(self.offset * turn)) * np.abs(turn) <= RESOLUTION * extent).all():
            raise UnsettledError("the contour has corners")
        # parts are quartered until the shaft angle's slope in the middle exceeds all that it can change by
        row, low, high = self.parts()
        for _ in range(MOST_CUTS):
            state, rate = self.at(row, 0.5 * (low + high))
            if not (state.angle[0] * rate > 0.0).all():
                raise UnsettledError("the shaft angle falls along the contour")
            shape = CurvatureBounds.of(restrict(self.beziers.control[row], low, high), self.offset)
            _, curved, _ = state.limits(shape.half, shape.curvature, shape.change).angle
            open_ = ~(state.angle[0] > curved * shape.half)
            if not open_.any():
                break
            row, low, high = quartered(row, low, high, open_)
        else:
            raise UnsettledError("the shaft angle is not seen to rise all along the contour")
        if abs(self._table.edges[-1] - self._table.edges[0] - TURN) > ONCE_ROUND:
            raise UnsettledError("the contour does not go once round the shaft")

    @cached_property
    def _table(self) -> _Table:
        count = self.beziers.count
        t = np.tile(np.linspace(0.0, 1.0, CELLS + 1), count)
        state, rate = self.at(np.repeat(np.arange(count), CELLS + 1), t)
        phi, slope = (row.reshape(count, CELLS + 1) for row in (state.phi, state.angle[0] * rate))
        width = np.mod(np.diff(phi, axis=1) + np.pi, TURN) - np.pi
        edges = phi[0, 0] + np.append(0.0, np.cumsum(width))
        return _Table(edges, width.ravel(), 1.0 / slope[:, :-1].ravel(), 1.0 / slope[:, 1:].ravel())

    def _about(self, phi: Array) -> tuple[Indices, Array]:
        """Pieces and parameters about where the roller rests at shaft angles phi (n,), from the table: (n,) each."""
        table = self._table
        x = np.mod(phi - table.edges[0], TURN) + table.edges[0]
        cell = np.clip(np.searchsorted(table.edges, x, side="right") - 1, 0, len(table.width) - 1)
        u, width = (x - table.edges[cell]) / table.width[cell], table.width[cell]
        start = u * u * (3.0 - 2.0 * u) / CELLS
        start += width * (u * (1.0 - u) ** 2 * table.after[cell] - u * u * (1.0 - u) * table.before[cell])
        return cell // CELLS, np.clip(cell % CELLS / CELLS + start, 0.0, 1.0)

    def reached(self, phi: Array) -> Array:
        """Own position of the roller, mm or rad (n,), at shaft angles phi (n,), rad.

        Raises UnsettledError where a contact is not found in `STEPS` steps.
        """
        row, t = self._about(phi)
        for _ in range(STEPS):
            state, speed = self.at(row, t)
            (place, q, q_1), (rate, bend) = state.position, state.angle
            missing = np.mod(phi - state.phi + np.pi, TURN) - np.pi
            ahead = missing / rate
            if not (np.abs(missing) > NEAR).any():
                position: Array = place + ahead * (q + 0.5 * ahead * (q_1 - q * bend / rate))
                return position
            t = np.clip(t + ahead / speed, 0.0, 1.0)
        raise UnsettledError("a contact is not found")

    @cached_property
    def ends(self) -> Array:
        """Shaft angles (2 m,), rad, at which the roller touches the starts and the middles of the m pieces."""
        return self._table.edges[:-1][:: CELLS // 2]

    def gap(self, centres: Array, phi: Array) -> Array:
        """Gap (n,), mm, between the contour and a roller with its centre at `centres` (n, 2), mm.

        The nearest point of the contour is sought from where the roller rests at shaft angles phi (n,), rad.

        Raises UnsettledError for a gap above `MOST_PLAY` of the roller's radius, and where the foot is not found.
        """
        row, t = self._about(phi)
        first, last = (np.hypot(*self.beziers.velocity[:, k].T) for k in (0, -1))
        side, radius = np.sign(self.offset), abs(self.offset)
        for _ in range(STEPS):
            x, v, w = self.beziers.rows(row, t)
            away = centres - x
            step = dot(away, v) / (dot(v, v) - dot(away, w))
            speed = np.hypot(v[:, 0], v[:, 1])
            if not (np.abs(step) * speed > ON_CONTOUR * radius).any():
                gap: Array = side * cross(v, away) / -speed - radius
                if np.abs(gap).max() > MOST_PLAY * radius:
                    break
                return gap
            # a step that leaves the piece goes on over the next one by as much arc length
            t = t + step
            over, under = t > 1.0, t < 0.0
            beyond = np.where(over, (t - 1.0) * speed, t * speed)
            row = np.mod(row + over - under, self.beziers.count)
            t = np.where(over, beyond / first[row], np.where(under, 1.0 + beyond / last[row], t))
        raise UnsettledError("the play is too large to be told from one place")

    def spans(self) -> BezierSpans:
        """Stretches of the path all round."""
        return BezierSpans.over(self, *self.parts())

    def looked_at_about(self, phi: Array) -> SplinePath:  # noqa: ARG002 - nothing is hidden
        """Give the path itself: no contacts need to be known."""
        return self

    def parts(self) -> tuple[Indices, Array, Array]:
        """Equal parts of all pieces: the index of the piece, and the parameters at both ends, (n,) each."""
        part = np.tile(np.arange(PARTS), self.beziers.count)
        return np.repeat(np.arange(self.beziers.count), PARTS), part / PARTS, (part + 1.0) / PARTS


class _Table(NamedTuple):
    """n cells of shaft angle: `edges` (n + 1,) rising, widths, the parameter's derivatives at both ends, within."""

    edges: Array
    width: Array
    after: Array
    before: Array


class CurvatureBounds(NamedTuple):
    """Bounds over n stretches of a path, (n,) each; inf where unknown, `inner` 0.

    curvature    of the curvature's magnitude, 1/mm
    change       of the magnitude of its derivative by arc length, 1/mm^2
    half, inner  of the arc length from the middle to either end, mm, from above and from below
    """

    curvature: Array
    change: Array
    half: Array
    inner: Array

    @staticmethod
    def of(control: Array, offset: float) -> CurvatureBounds:
        """Bounds of the path `offset` mm to the right of stretches of a contour, control points (n, d + 1, 2), mm."""
        v = derivative(control)  # first to third derivative, as polynomials of the parameter
        w = derivative(v)
        u = derivative(w)
        # the speed is at least its part along the chord, and at most the longest coefficient
        chord = control[:, -1] - control[:, 0]
        way = chord / np.hypot(chord[:, 0], chord[:, 1])[:, None]
        least, most = np.einsum("nkc,nc->nk", v, way).min(axis=1), np.hypot(v[:, :, 0], v[:, :, 1]).max(axis=1)
        # curvature k = (v x w)/v^3 and k' = (v x u)/v^4 - 3 (v x w)(v.w)/v^6, on the path over 1 + k r and its cube
        turning = cross_product(v, w)
        low, high = turning.min(axis=1), turning.max(axis=1)
        along = bernstein_product(v[:, :, 0], w[:, :, 0]) + bernstein_product(v[:, :, 1], w[:, :, 1])
        size, stretched = np.maximum(-low, high), np.abs(along).max(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            bends = np.stack(
                [low / np.where(low < 0.0, least, most) ** 3, high / np.where(high > 0.0, least, most) ** 3]
            )
            growth = 1.0 + np.sort(offset * bends, axis=0)
            change = (np.abs(cross_product(v, u)).max(axis=1) + 3.0 * size * stretched / least**2) / least**4
            curvature, change = np.abs(bends).max(axis=0) / growth[0], change / growth[0] ** 3
        known = (least > 0.0) & (growth[0] > 0.0)
        curvature, change, half = np.where(known, np.stack([curvature, change, 0.5 * most * growth[1]]), np.inf)
        return CurvatureBounds(curvature, change, half, np.where(known, 0.5 * least * growth[0], 0.0))


@dataclass(frozen=True, eq=False)
class BezierSpans:
    """Stretches (n,) of Bezier pieces from parameter `low` to `high`, (n,) each.

    Errors of both signs are sought at once.
    """

    path: SplinePath
    piece: Indices
    low: Array
    high: Array
    shape: CurvatureBounds

    @staticmethod
    def over(path: SplinePath, row: Indices, low: Array, high: Array) -> BezierSpans:
        """Make the stretches of pieces `row` (n,) from parameter `low` to `high`, (n,) each."""
        shape = CurvatureBounds.of(restrict(path.beziers.control[row], low, high), path.offset)
        return BezierSpans(path, row, low, high, shape)

    @property
    def middle(self) -> Array:
        """Parameters (n,) of the middles of the stretches."""
        return 0.5 * (self.low + self.high)

    @property
    def half(self) -> Array:
        """Greatest arc length (n,), mm, from the middle of each stretch to its ends."""
        return self.shape.half

    def quarters(self, which: NDArray[np.bool_]) -> BezierSpans:
        """Four equal parts, by the parameter, of each stretch that the mask (n,) marks."""
        return BezierSpans.over(self.path, *quartered(self.piece, self.low, self.high, which))

    def one(self, i: int) -> BezierSpans:
        """Stretch i alone."""
        return BezierSpans.over(self.path, self.piece[[i]], self.low[[i]], self.high[[i]])

    def summit(self, law: IntendedLaw, where: float) -> Array:
        """Shaft angles (2,), rad, on a stretch that is alone: near its greatest error, and a Newton step closer to it.

        The first is `where`, mm along the centre's path, off the middle of the stretch.
        """
        path = self.path
        _, rate = path.at(self.piece, self.middle)
        t = np.clip(self.middle + where / rate, self.low, self.high)
        state, rate = path.at(self.piece, t)
        _, slope, bend = state.error(own_rows(path.contact, law.rows(state.phi)))
        step = np.where(bend * slope != 0.0, -slope / bend, 0.0)
        near, _ = path.at(self.piece, np.clip(t + step / rate, self.low, self.high))
        return np.concatenate([state.phi, near.phi])

    def state(self) -> CentreState:
        """Roller centre and its derivatives at the middles of the stretches."""
        return self.path.at(self.piece, self.middle)[0]

    def limits(self, state: CentreState) -> DerivativeBounds:
        """Bounds of the derivatives over the stretches."""
        return state.limits(self.half, self.shape.curvature, self.shape.change)

    def bounds(self, state: CentreState, most: tuple[Array, Array, Array], rows: Array) -> tuple[Array, Array, Array]:
        """Upper bounds of the absolute error, one reached in each stretch, and where, mm off the middle: (n,) each.

        `most` bounds the error's three derivatives, `rows` (3, n) are the law's at the middles.
        """
        error = state.error(own_rows(self.path.contact, rows))
        (up, high, at_high), (down, low, at_low) = (
            bounds_of_error(sign * error, most, self.half, self.shape.inner) for sign in (1.0, -1.0)
        )
        return np.maximum(up, down), np.maximum(high, low), np.where(high >= low, at_high, at_low)


def quartered(row: Indices, low: Array, high: Array, which: NDArray[np.bool_]) -> tuple[Indices, Array, Array]:
    """Quarters of the k intervals that the mask `which` (n,) chooses, of those from low to high (n,) on rows (n,).

    Row, lower and upper end of each, (4k,): the first quarters of all intervals, then the second ones, and so on.
    """
    begin, step = low[which], 0.25 * (high - low)[which]
    cuts = [begin + k * step for k in range(4)] + [high[which]]
    return np.tile(row[which], 4), np.concatenate(cuts[:-1]), np.concatenate(cuts[1:])
