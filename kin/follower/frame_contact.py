"""The square frame of a linkage resting on a contour read from a file: shaft angle and output over the relative angle.

The frame depends on the contour's support function q alone: at relative angle theta its four faces would touch at
q(theta), q(theta + pi/2), ... from the shaft. Held by face 1 the frame has S = q(theta), by face 3
S = w - q(theta + pi), likewise S1 by face 2 or 4; the linkage turns S and S1 into shaft angle and output. Between
breaks of these q all is smooth. The intended lift is used for nothing but the zero of the shaft angle, by which a
drawing is mounted.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.contour import apart
from kin.linkage.loop import BindingError
from kin.numeric.angles import TURN, degrees
from kin.numeric.elementary import Jet
from kin.numeric.errors import CamgeoError, UnsettledError
from kin.numeric.quintics import Quintics, coefficients, polynomial
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from kin.follower.support import FlatContacts
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array, Indices

    Flags = NDArray[np.bool_]

QUARTER = 0.5 * np.pi
COARSEST = 720  # intervals of a turn at least, however few the breaks
RESOLUTION = 2e-13  # of the breadth: of lengths
RESOLUTION_ANGLE = 1e-13  # rad
ROUNDING = 64.0 * 2.0**-52  # of values that are subtracted from one another, relative
HALVINGS = 16  # of an interval, until quintics follow the motion
SHORT = 1e-6  # rad: over less, the mean rate of the shaft is rounding


class FrameError(CamgeoError, ValueError):
    """The contour does not drive the mechanism all round; the message says at which relative angle and why."""


@dataclass(frozen=True)
class FrameRest:
    """A way in which the frame lies on the cam, by weights 0 to 1 of the faces that place it.

    first    weight of face 1; face 3 has the rest
    second   weight of face 2; face 4 has the rest
    """

    name: str
    first: float
    second: float


WAYS = (
    FrameRest("on faces 1 and 2", 1.0, 1.0),
    FrameRest("on faces 1 and 4", 1.0, 0.0),
    FrameRest("on faces 3 and 2", 0.0, 1.0),
    FrameRest("on faces 3 and 4", 0.0, 0.0),
)
# With the relative angle given, the least squares of the four gaps place the frame midway between opposite contacts.
CENTRED = FrameRest("centred", 0.5, 0.5)


@dataclass(frozen=True, eq=False)
class Resting:
    """A frame resting on a contour; m intervals of the relative angle between `nodes` (m + 1,), from 0 to 2 pi.

    `low` and `high` (2, 3, m) are shaft angle and output, rad or mm, with their derivatives by the relative angle at
    the ends of the intervals, seen from within. The intervals are so short that quintics follow both functions.
    """

    rest: FrameRest
    nodes: Array
    low: Array
    high: Array

    @cached_property
    def shaft(self) -> Array:
        """Shaft angles at the nodes (m + 1,), rad, rising."""
        return np.append(self.low[0, 0], self.high[0, 0, -1])

    @cached_property
    def least_rate(self) -> tuple[float, float]:
        """Least rate of the shaft over the relative angle, 1 - theta_3', by cubics between nodes, and where, rad."""
        h = np.diff(self.nodes)
        first, last = self.low[0, 1], self.high[0, 1]
        mean = (self.high[0, 0] - self.low[0, 0]) / h
        # the slope of the cubic is first + s (2 c + 3 s d) at s of the interval; its least is where c + 3 s d vanishes
        c, d = 3.0 * mean - 2.0 * first - last, first + last - 2.0 * mean
        with np.errstate(divide="ignore", invalid="ignore"):
            s = -c / (3.0 * d)
        inside = (h > SHORT) & (d > 0.0) & (s > 0.0) & (s < 1.0)
        s = np.where(inside, s, 0.0)
        rate = np.stack([first, last, first + s * (2.0 * c + 3.0 * s * d)])
        k, i = divmod(int(rate.argmin()), len(h))
        return float(rate[k, i]), float(self.nodes[i] + (0.0, 1.0, s[i])[k] * h[i])

    @cached_property
    def turned(self) -> Quintics:
        """Shaft angle, rad, over the relative angle, as quintics of one turn: beyond it whole turns are missing."""
        return Quintics(self.nodes, self.low[0], self.high[0])

    @cached_property
    def over_relative(self) -> Quintics:
        """Output, rad or mm, over the relative angle."""
        return Quintics(self.nodes, self.low[1], self.high[1])

    @cached_property
    def over_shaft(self) -> Quintics:
        """Output, rad or mm, over the shaft angle."""
        return Quintics(self.shaft, _by_shaft(self.low), _by_shaft(self.high))

    def rows(self, theta: Array, interval: Indices) -> Array:
        """Shaft angle and output at theta (n,) in intervals (n,), with two derivatives by theta: (2, 3, n)."""
        return np.stack([function.within(interval, theta, 2) for function in (self.turned, self.over_relative)])


def laid(mechanism: Mechanism, bearing: FlatContacts, rests: Sequence[FrameRest]) -> list[Resting]:
    """The frame as it rests on the contour all round: a Resting for each of `rests`, in their order.

    `bearing` are the contour's contacts with flat faces. Raises FrameError where the mechanism binds or turns the shaft
    back, UnsettledError where rounding hides the motion.
    """
    # all ways of resting go through the linkage together
    shares = np.transpose([(rest.first, rest.second) for rest in rests])[:, None]

    def rows(theta: Array, way: Indices, stretch: Indices) -> Array:
        """Shaft angle and output (2, 3, n) at theta (n,) in ways (n,), the contour's stretches (4, n) on the faces."""
        faces = np.stack([bearing.derivatives(theta + k * QUARTER, stretch[k]) for k in range(4)])
        faces[2:] *= -1.0
        faces[2:, 0] += mechanism.breadth
        s, s1 = shares[..., way] * faces[:2] + (1.0 - shares[..., way]) * faces[2:]
        return driven(mechanism, theta, s, s1, lambda k: f"{rests[int(way[k])].name} ")

    nodes = [_nodes(bearing, rest, mechanism.breaks) for rest in rests]
    begin, end = (np.concatenate([places[part] for places in nodes]) for part in (slice(-1), slice(1, None)))
    way = np.repeat(np.arange(len(rests)), [len(places) - 1 for places in nodes])
    stretch = np.stack([bearing.find(0.5 * (begin + end) + k * QUARTER) for k in range(4)])
    # at the ends of the intervals; a shaft that turns back is refused first
    low, high = np.split(rows(np.concatenate([begin, end]), np.tile(way, 2), np.tile(stretch, 2)), 2, axis=2)
    allowed = np.empty(len(rests))
    for k, whole in enumerate(_parted(rests, way, begin, low, high)):
        least, at = whole.least_rate
        if least <= 0.0:
            raise FrameError(
                f"{whole.rest.name} the frame turns the shaft back at a relative angle of {degrees(at):.6g} degrees: "
                f"1 - theta_3' is {least:.3g}"
            )
        allowed[k] = resolution(mechanism, whole.low[1, 0])
    # intervals are halved until quintics meet the motion in their middles
    done: list[tuple[Indices, Array, Array, Array]] = []
    for _ in range(HALVINGS):
        middle = 0.5 * (begin + end)
        between = rows(middle, way, stretch)
        open_ = _missed(end - begin, low, between, high, allowed[way])
        done.append((way[~open_], begin[~open_], low[..., ~open_], high[..., ~open_]))
        if not open_.any():
            break
        begin, middle, end, stretch = begin[open_], middle[open_], end[open_], np.tile(stretch[:, open_], 2)
        low, between, high, way = low[..., open_], between[..., open_], high[..., open_], np.tile(way[open_], 2)
        begin, end = np.concatenate([begin, middle]), np.concatenate([middle, end])
        low, high = np.concatenate([low, between], axis=2), np.concatenate([between, high], axis=2)
    else:
        raise UnsettledError("rounding makes the motion rougher than its error may be", float(begin[0]))
    way, begin, low, high = (np.concatenate(parts, axis=-1) for parts in zip(*done, strict=True))
    order = np.lexsort((begin, way))
    return _parted(rests, way[order], begin[order], low[..., order], high[..., order])


def _parted(rests: Sequence[FrameRest], way: Indices, begin: Array, low: Array, high: Array) -> list[Resting]:
    """Resting of each way, from n intervals in the order of the ways (n,) that they belong to."""
    ends = np.searchsorted(way, np.arange(len(rests) + 1))
    parts = [slice(*pair) for pair in pairwise(ends.tolist())]
    return [
        Resting(rest, np.append(begin[part], TURN), low[..., part], high[..., part])
        for rest, part in zip(rests, parts, strict=True)
    ]


def _by_shaft(rows: Array) -> Array:
    """Output and two derivatives by the shaft angle (3, n), from both by the relative angle (2, 3, n)."""
    phi, output = rows
    slope = output[1] / phi[1]
    return np.stack([output[0], slope, (output[2] - slope * phi[2]) / phi[1] ** 2])


def _missed(width: Array, low: Array, middle: Array, high: Array, allowed: Array) -> Flags:
    """Whether quintics between the ends of intervals (n,) miss the rows (2, 3, n) in the middle by too much.

    `allowed` (n,) is the error permitted in the output, beside the rounding of the angle itself.
    """
    turned, step, off = high[0, 0] - low[0, 0], middle[0, 0] - low[0, 0], np.zeros((3, len(width)))
    spans = ((width, 0.5 * width, low[0], high[0]), (width, 0.5 * width, low[1], high[1]))
    ends = _by_shaft(low), _by_shaft(high)
    for row, (wide, share, first, last) in enumerate((*spans, (turned, step, *ends))):
        off[row] = polynomial(coefficients(first, last, wide), wide, share, 0)[0]
    off = np.abs(off - middle[[0, 1, 1], 0])
    allowed = np.stack([np.full_like(allowed, RESOLUTION_ANGLE), allowed, allowed])
    missed: Flags = np.any(off > allowed + ROUNDING * TURN * np.abs(middle[[0, 1, 1], 1]), axis=0)
    return missed


def resolution(mechanism: Mechanism, output: Array) -> float:
    """Least change of the output that counts, in the unit of its values `output` (n,), rad or mm."""
    least = RESOLUTION * mechanism.breadth if mechanism.unit == "mm" else RESOLUTION_ANGLE
    return max(least, ROUNDING * float(np.abs(output).max()))


def driven(mechanism: Mechanism, theta: Array, s: Array, s1: Array, lies: Callable[[int], str] = lambda _: "") -> Array:
    """Shaft angle and output of a mechanism, with derivatives by the relative angle theta (n,): (2, order + 1, n).

    `s` and `s1` (order + 1, n), mm, are the distances of faces 1 and 2 from the shaft, with their derivatives by theta.
    The shaft angle, rad, counts from the intended mechanism's zero. Raises FrameError where the mechanism binds; its
    message begins with `lies(i)`, words for how the frame rests at theta[i].
    """
    scale = 1.0 / np.cumprod(np.maximum(np.arange(len(s)), 1.0))[:, None]
    try:
        frame, output = mechanism.driven(Jet(s * scale), Jet(s1 * scale))
    except BindingError as error:
        first = int(error.indices[0])
        at = degrees(float(theta[first]))
        message = f"{lies(first)}the mechanism binds at a relative angle of {at:.6g} degrees: {error.message}"
        raise FrameError(message) from error
    shaft = -frame.derivatives()
    shaft[0] += theta + mechanism.start
    if len(shaft) > 1:
        shaft[1] += 1.0
    return np.stack([shaft, output.derivatives()])


def _nodes(bearing: FlatContacts, rest: FrameRest, breaks: Array) -> Array:
    """0, 2 pi and between them equal steps, the breaks of q at all faces that place the frame, and the given breaks."""
    shares = (rest.first, rest.second, 1.0 - rest.first, 1.0 - rest.second)
    angles = [bearing.breaks - k * QUARTER for k, share in enumerate(shares) if share]
    # breaks of two faces that differ by rounding alone are one
    rising = apart(np.concatenate([*angles, breaks, np.arange(COARSEST) * (TURN / COARSEST)]))
    inside = rising[(rising > 0.0) & (rising < TURN * (1.0 - 1e-13))]
    return np.concatenate([[0.0], inside, [TURN]])
