"""The square frame of a linkage resting on a contour read from a file: shaft angle and output over the relative angle.

The contour's support function q is all that the frame feels: at relative angle theta its four faces stand at
q(theta), q(theta + pi/2), ... from the shaft. Held by face 1 the frame has S = q(theta), by face 3
S = w - q(theta + pi), likewise S1 by face 2 or 4; the linkage does the rest. Between breaks of these q all is smooth.
The intended lift is not used here, but for the zero of the shaft angle, which a drawing is mounted by.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.contour import apart
from kin.linkage.loop import BindingError
from kin.numeric.angles import TURN, degrees
from kin.numeric.elementary import Jet
from kin.numeric.errors import CamgeoError
from kin.numeric.newton import cubic_inverse, zeros
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.follower.support import Bearing
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array, Indices

QUARTER = 0.5 * np.pi
COARSEST = 720  # intervals of a turn at least, however few the breaks
SETTLED = 1e-8  # rad: after a Newton step below this the next is lost in rounding
SHORT = 1e-6  # rad: over less, the mean rate of the shaft is rounding


class FrameError(CamgeoError, ValueError):
    """The contour does not drive the mechanism all round; the message says at which relative angle and why."""


@dataclass(frozen=True)
class Rest:
    """How the frame lies on the cam: face 1 has the share `first` in placing it, face 3 the rest, face 2 `second`."""

    name: str
    first: float
    second: float


WAYS = (
    Rest("on faces 1 and 2", 1.0, 1.0),
    Rest("on faces 1 and 4", 1.0, 0.0),
    Rest("on faces 3 and 2", 0.0, 1.0),
    Rest("on faces 3 and 4", 0.0, 0.0),
)
# With the relative angle given, the least squares of the four gaps place the frame midway between opposite contacts.
CENTRED = Rest("centred", 0.5, 0.5)


@dataclass(frozen=True, eq=False)
class Resting:
    """A frame resting on a contour; m intervals of the relative angle between `nodes` (m + 1,), from 0 to 2 pi.

    `low` and `high` (2, 3, m) are shaft angle and output, rad or mm, with their derivatives by the relative angle at
    the ends of the intervals, seen from within; `stretch` (4, m) is what bears on each face.
    """

    mechanism: Mechanism
    bearing: Bearing
    rest: Rest
    nodes: Array
    stretch: Indices
    low: Array
    high: Array

    @staticmethod
    def of(mechanism: Mechanism, bearing: Bearing, rest: Rest) -> Resting:
        """Lay the frame on the contour all round. FrameError where the mechanism binds or the shaft would turn back."""
        nodes = _nodes(bearing, rest, mechanism.breaks)
        middle = 0.5 * (nodes[:-1] + nodes[1:])
        stretch = np.stack([bearing.find(middle + k * QUARTER) for k in range(4)])
        low, high = (_rows(mechanism, bearing, rest, theta, stretch) for theta in (nodes[:-1], nodes[1:]))
        found = Resting(mechanism, bearing, rest, nodes, stretch, low, high)
        least, at = found.least_rate
        if least <= 0.0:
            raise FrameError(
                f"{rest.name} the frame turns the shaft back at a relative angle of {degrees(at):.6g} degrees: "
                f"1 - theta_3' is {least:.3g}"
            )
        return found

    def rows(self, theta: Array, interval: Indices) -> Array:
        """Shaft angle and output at theta (n,) in intervals (n,), with two derivatives by theta: (2, 3, n)."""
        return _rows(self.mechanism, self.bearing, self.rest, theta, self.stretch[:, interval])

    @cached_property
    def shaft(self) -> Array:
        """Shaft angles at the nodes (m + 1,), rising."""
        return np.append(self.low[0, 0], self.high[0, 0, -1])

    @cached_property
    def least_rate(self) -> tuple[float, float]:
        """Least rate of the shaft over the relative angle, 1 - theta_3', and where, rad; of cubics between nodes."""
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

    def relative(self, shaft: Array, side: int = 1) -> tuple[Array, Indices]:
        """Relative angles, in [0, 2 pi], at any shaft angles (n,), and their intervals (n,), to rounding.

        At a node the interval is that which begins there (side 1) or ends there (side -1).
        """
        interval, reduced = _place(self.shaft, shaft, side)
        low, high = self.nodes[interval], self.nodes[interval + 1]
        ends, rates = (self.shaft[interval], self.shaft[interval + 1]), (self.low[0, 1], self.high[0, 1])
        theta = cubic_inverse(reduced, ends, (low, high), (rates[0][interval], rates[1][interval]))

        def over(theta: Array) -> tuple[Array, Array]:
            value, slope = self.rows(theta, interval)[0, :2]
            return value - reduced, slope

        return zeros(over, low, high, theta, SETTLED), interval

    def shaft_at(self, theta: float) -> float:
        """Shaft angle at any relative angle, rad, to whole turns."""
        return float(self.rows(*self.place(np.array([theta])))[0, 0, 0])

    def place(self, theta: Array, side: int = 1) -> tuple[Array, Indices]:
        """Return relative angles (n,), any, brought to [0, 2 pi], and their intervals; at a node as `relative` does."""
        interval, reduced = _place(self.nodes, theta, side)
        return reduced, interval

    def over_shaft(self, shaft: Array, order: int, side: int = 1) -> Array:
        """Output, rad or mm, at shaft angles (n,) and up to two derivatives by them, (order + 1, n).

        At a node as `relative` has it.
        """
        phi, output = self.rows(*self.relative(shaft, side))
        rows = [output[0]]
        if order > 0:
            rows.append(output[1] / phi[1])
        if order > 1:
            rows.append((output[2] - rows[1] * phi[2]) / phi[1] ** 2)
        return np.stack(rows)

    def over_relative(self, theta: Array, order: int, side: int = 1) -> Array:
        """Output at relative angles (n,) and up to two derivatives by them, likewise."""
        rows: Array = self.rows(*self.place(theta, side))[1, : order + 1]
        return rows


def _place(ends: Array, x: Array, side: int) -> tuple[Indices, Array]:
    """Interval between the `ends` (m + 1,) of a turn for each x (n,), and x within the turn.

    At an end that is the interval to the right, or to the left (side -1); the turn goes on from its end at its start.
    """
    outside = (x < ends[0]) | (x > ends[-1])
    x = np.where(outside, ends[0] + np.mod(x - ends[0], TURN), x)
    x = np.where(x == (ends[-1] if side > 0 else ends[0]), ends[0] if side > 0 else ends[-1], x)
    interval = np.searchsorted(ends, x, side="right" if side > 0 else "left") - 1
    return np.clip(interval, 0, len(ends) - 2), x


def driven(mechanism: Mechanism, theta: Array, s: Array, s1: Array, rest: Rest | None = None) -> Array:
    """Shaft angle and output of a mechanism, with derivatives by the relative angle theta (n,): (2, order + 1, n).

    `s` and `s1` (order + 1, n) are the distances of faces 1 and 2 from the shaft, with their derivatives by theta. The
    shaft angle's zero is that of the intended mechanism. FrameError, which names `rest`, where it binds.
    """
    scale = 1.0 / np.cumprod(np.maximum(np.arange(len(s)), 1.0))[:, None]
    try:
        frame, output = mechanism.driven(Jet(s * scale), Jet(s1 * scale))
    except BindingError as error:
        at = degrees(float(theta[int(error.indices[0])]))
        lies = f"{rest.name} " if rest else ""
        message = f"{lies}the mechanism binds at a relative angle of {at:.6g} degrees: {error.message}"
        raise FrameError(message) from error
    shaft = -frame.derivatives()
    shaft[0] += theta + mechanism.start
    if len(shaft) > 1:
        shaft[1] += 1.0
    return np.stack([shaft, output.derivatives()])


def _rows(mechanism: Mechanism, bearing: Bearing, rest: Rest, theta: Array, stretch: Indices) -> Array:
    """Shaft angle and output (2, 3, n) at theta (n,), with that which bears on each face (4, n)."""

    def reach(face: int) -> Array:
        return bearing.derivatives(theta + face * QUARTER, stretch[face])

    def placed(share: float, near: int, far: int) -> Array:
        if share == 1.0:
            return reach(near)
        opposite = -reach(far)
        opposite[0] += mechanism.breadth
        return opposite if share == 0.0 else share * reach(near) + (1.0 - share) * opposite

    return driven(mechanism, theta, placed(rest.first, 0, 2), placed(rest.second, 1, 3), rest)


def _nodes(bearing: Bearing, rest: Rest, breaks: Array) -> Array:
    """0, 2 pi and, between them, the breaks of all faces that place the frame, those of the intent, and equal steps."""
    shares = (rest.first, rest.second, 1.0 - rest.first, 1.0 - rest.second)
    angles = [bearing.breaks - k * QUARTER for k, share in enumerate(shares) if share]
    # breaks of two faces that differ by rounding alone are one
    rising = apart(np.concatenate([*angles, breaks, np.arange(COARSEST) * (TURN / COARSEST)]))
    inside = rising[(rising > 0.0) & (rising < TURN * (1.0 - 1e-13))]
    return np.concatenate([[0.0], inside, [TURN]])
