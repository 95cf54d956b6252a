"""Linkages driven by a cam in a square frame, many designs at once: `kin.linkage.four_bar` on plain arrays.

A block holds m designs at n even relative angles, arrays (m, n), mm and rad; S and S1 are the support at theta and a
quarter turn on. Everything but two angles a sample is algebra: theta_4 and its derivatives need AD^2 alone, and
theta_3 is one arctangent of D X, so shaft angles need no unwrapping. `kin.linkage.four_bar` takes care of rounding
near limit positions; here designs count that keep clear of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable

Array: TypeAlias = NDArray[np.float64]
_Rows = TypeVar("_Rows")
Kind: TypeAlias = Literal["four-bar", "inverted-slider-crank", "slider-crank"]


class Lengths(NamedTuple):
    """Dimensions of m linkages, each (m, 1), mm; a kind that has no such link leaves it 0."""

    ground: Array
    coupler: Array
    rocker: Array
    offset: Array


@dataclass(frozen=True, eq=False)
class Support:
    """Sampled cams: breadth (m, 1), support p and p', p'' about the shaft, (m, n), n a multiple of 4."""

    breadth: Array
    p: Array
    dp: Array
    ddp: Array

    @cached_property
    def p1(self) -> Array:
        """Support a quarter turn on."""
        return _quarter_on(self.p)

    @cached_property
    def dp1(self) -> Array:
        """Its derivative."""
        return _quarter_on(self.dp)

    @cached_property
    def ddp1(self) -> Array:
        """Its second derivative."""
        return _quarter_on(self.ddp)

    def part(self, rows: NDArray[np.bool_]) -> Support:
        """Return some of the cams."""
        part = Support(self.breadth[rows], self.p[rows], self.dp[rows], self.ddp[rows])
        return _with_found(self, part, rows)


def _with_found(whole: object, part: _Rows, rows: NDArray[np.bool_]) -> _Rows:
    """Give a part of some designs what has been worked out for the whole."""
    for name, values in vars(whole).items():
        if name not in vars(part) and isinstance(values, np.ndarray):
            vars(part)[name] = values[rows]
    return part


def _quarter_on(values: Array) -> Array:
    n = values.shape[1]
    return np.concatenate([values[:, n // 4 :], values[:, : n // 4]], axis=1)


@dataclass(frozen=True, eq=False)
class Loop:
    """What the loops of a kind come down to, (m, n) each.

    `x`, `y` are D in the frame's axes, `q` their squares' sum AD^2. `near` and `far` are positive where the loop
    closes, and vanish at its limits. `root` is the root of near far, negative for crossed.
    """

    kind: Kind
    side: float
    cams: Support
    lengths: Lengths
    x: Array
    y: Array
    q: Array
    near: Array
    far: Array

    @staticmethod
    def of(kind: Kind, side: float, cams: Support, lengths: Lengths) -> Loop:
        """Set the loops up; those of the given designs need not close."""
        r1, r3, r4, offset = lengths
        y = cams.p - 0.5 * cams.breadth
        if kind == "inverted-slider-crank":
            near, far = y + (r1 - r4), (r1 + r4) - y
            return Loop(kind, side, cams, lengths, y, y, y, near, far)
        x = (cams.breadth + r3) - cams.p1
        yy = y * y
        q = x * x + yy
        if kind == "four-bar":
            least = np.abs(r1 - r4)
            near = (x - least) * (x + least) + yy
            return Loop(kind, side, cams, lengths, x, y, q, near, (r1 + r4) ** 2 - q)
        least = np.abs(offset)
        near = (x - least) * (x + least) + yy
        return Loop(kind, side, cams, lengths, x, y, q, near, near)

    def margin(self, extreme: Callable[[Array], Array]) -> Array:
        """Least distance from binding, mm (m,); `extreme` gives the least of each row (m, n)."""
        r1, _, r4, offset = (length[:, 0] for length in self.lengths)
        near = extreme(self.near)
        if self.kind == "inverted-slider-crank":
            return np.minimum(near, extreme(self.far))
        least = np.abs(r1 - r4) if self.kind == "four-bar" else np.abs(offset)
        # AD - least from AD^2 - least^2; where that is negative it is a distance too, if not quite that one
        margin = near / (np.sqrt(np.maximum(near + least * least, 0.0)) + least)
        if self.kind == "four-bar":
            far, most = extreme(self.far), r1 + r4
            margin = np.minimum(margin, far / (np.sqrt(np.maximum(most * most - far, 0.0)) + most))
        return np.asarray(margin, dtype=np.float64)

    def part(self, rows: NDArray[np.bool_]) -> Loop:
        """Return some of the designs."""
        lengths = Lengths(*(length[rows] for length in self.lengths))
        fields = (self.x, self.y, self.q, self.near, self.far)
        part = Loop(self.kind, self.side, self.cams.part(rows), lengths, *(field[rows] for field in fields))
        return _with_found(self, part, rows)

    @cached_property
    def root(self) -> Array:
        """Signed root of near far: r1 r4 2 sin theta_4, r1 sin theta_4, or, of near alone, D_x."""
        square = self.near if self.kind == "slider-crank" else self.near * self.far
        root = np.sqrt(square)
        return root if self.side > 0 else -root

    @cached_property
    def output(self) -> Array:
        """theta_4, rad, or D_x, mm."""
        if self.kind == "slider-crank":
            return self.root
        angle = np.arctan(self.near / self.root)
        angle += angle
        return angle

    @cached_property
    def half_rate(self) -> Array:
        """Half the derivative of AD^2."""
        return self.y * self.cams.dp - self.x * self.cams.dp1

    @cached_property
    def rate(self) -> Array:
        """Derivative of the output by the relative angle."""
        if self.kind == "inverted-slider-crank":
            return self.cams.dp / self.root
        rate = self.half_rate / self.root
        if self.kind == "four-bar":
            rate += rate
        return rate

    @cached_property
    def second(self) -> Array:
        """Second derivative of the output by the relative angle."""
        cams, rate = self.cams, self.rate
        if self.kind == "inverted-slider-crank":
            return (cams.ddp - (self.lengths.rocker - self.y) * rate * rate) / self.root
        half = cams.dp * cams.dp + cams.dp1 * cams.dp1 + self.y * cams.ddp - self.x * cams.ddp1
        if self.kind == "slider-crank":
            return (half - rate * rate) / self.root
        r1, _, r4, _ = self.lengths
        return (half + half - ((r1 * r1 + r4 * r4) - self.q) * rate * rate) / self.root

    @cached_property
    def _lean(self) -> Array:
        """Q + r4^2 - r1^2: twice r4 times the cosine of the angle at D, times the root of Q."""
        r1, _, r4, _ = self.lengths
        return self.q - (r1 * r1 - r4 * r4)

    @cached_property
    def _turning(self) -> Array:
        """theta_3' times Q."""
        cams = self.cams
        spin = self.x * cams.dp + self.y * cams.dp1
        if self.kind == "slider-crank":
            return -(self.lengths.offset * self.rate) - spin
        # (arg D)' Q = theta_4' (r1 D_x - Q)
        return -0.5 * self.rate * self._lean - spin

    @cached_property
    def frame_rate(self) -> Array:
        """theta_3'."""
        return -self.rate if self.kind == "inverted-slider-crank" else self._turning / self.q

    @cached_property
    def frame_second(self) -> Array:
        """theta_3''."""
        if self.kind == "inverted-slider-crank":
            return -self.second
        cams = self.cams
        spin = self.x * cams.ddp + self.y * cams.ddp1
        if self.kind == "slider-crank":
            turning = -(self.lengths.offset * self.second) - spin
        else:
            turning = -0.5 * self.second * self._lean - self.rate * self.half_rate - spin
        return (turning - 2.0 * self.frame_rate * self.half_rate) / self.q

    @cached_property
    def joint(self) -> tuple[Array, Array]:
        """D in the fixed frame, mm; not for the inverted slider-crank."""
        if self.kind == "slider-crank":
            return self.root, np.broadcast_to(self.lengths.offset, self.root.shape)
        r1 = self.lengths.ground
        scale = 0.5 / r1
        return r1 - scale * self._lean_ground, scale * self.root

    @cached_property
    def _lean_ground(self) -> Array:
        """r1^2 + r4^2 - Q: 2 r1 r4 cos theta_4."""
        r1, _, r4, _ = self.lengths
        return (r1 * r1 + r4 * r4) - self.q

    @cached_property
    def frame(self) -> Array:
        """theta_3, rad, but for a constant: continuous round the turn."""
        if self.kind == "inverted-slider-crank":
            return -self.output
        r1, _, r4, offset = self.lengths
        x, y = self.x, self.y
        # D times the conjugate of X + iY; it keeps clear of the ray on which the arctangent jumps:
        # D keeps to one side of AB, or of the slide's foot, and X > 0
        if self.kind == "four-bar":
            along, across = self.q + (r1 * r1 - r4 * r4), self.root
        else:
            along, across = self.root, offset
        cosine, sine = along * x + across * y, across * x - along * y
        if self.kind == "slider-crank":
            return np.arctan2(sine, cosine) if self.side > 0 else np.arctan2(-sine, -cosine)
        return np.arctan2(-cosine, sine) if self.side > 0 else np.arctan2(cosine, -sine)

    @cached_property
    def transmission(self) -> Array | None:
        """Signed sine of the transmission angle at D; None where it is always a right angle."""
        if self.kind == "inverted-slider-crank":
            return None
        if self.kind == "slider-crank":
            return (self.root * self.x + self.lengths.offset * self.y) / self.q
        return (self.x * self.root + self.y * self._lean) / (2.0 * self.lengths.rocker * self.q)

    @cached_property
    def force(self) -> Array:
        """Sine of the force angle at D, at least 0 (`kin.linkage.transmission_angle`).

        The force runs along the line through D (inverted slider-crank: B) and P = -S' u - S1' n, where the normals of
        the contacts meet.
        """
        cams, (_, _, r4, offset) = self.cams, self.lengths
        if self.kind == "inverted-slider-crank":
            along, across = cams.dp + self.root, cams.dp1 + (self.y - r4)
            return np.abs(along) / np.sqrt(along * along + across * across)
        along, across = cams.dp + self.x, cams.dp1 + self.y
        length = np.sqrt(along * along + across * across)
        if self.kind == "slider-crank":  # P to D, along the slide
            cosine, sine = self.root * self.x + offset * self.y, offset * self.x - self.root * self.y
            return np.abs(along * cosine - across * sine) / (length * self.q)
        cosine, sine = self.y * self.root - self.x * self._lean, self.x * self.root + self.y * self._lean
        return np.abs(along * sine + across * cosine) / (length * (2.0 * r4 * self.q))


def angles(n: int) -> Array:
    """Relative angles of n samples, rad (n,)."""
    return np.arange(n, dtype=np.float64) * (2.0 * math.pi / n)
