"""Linkages driven by a cam in a square frame, many designs at once: `kin.linkage.four_bar` on plain arrays.

A block holds m designs at n even relative angles, arrays (m, n), mm and rad; S and S1 are the support at theta and a
quarter turn on, u and n the frame's axes. Everything but two angles a sample is algebra: theta_4 and its derivatives
need AD^2 alone, and theta_3 is one arctangent (`turned`), so shaft angles need no unwrapping. The care that
`kin.linkage.four_bar` takes of rounding near limit positions is left out: designs so near to binding are no good ones.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Self, TypeAlias, TypeVar

import numpy as np

from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.linkage.four_bar import Linkage
    from kin.numeric.arrays import Array, Mask

Arrays = TypeVar("Arrays", bound="Support | LoopArrays")


class Lengths(NamedTuple):
    """Dimensions of m linkages, each (m, 1), mm; 0 for a link that the kind does not have."""

    ground: Array
    coupler: Array
    rocker: Array
    offset: Array
    joint_offset: Array


@dataclass(frozen=True, eq=False)
class Support:
    """Sampled cams: breadth (m, 1), mm; support p about the shaft, mm, and its derivatives by rad, (m, n) each.

    n is a multiple of 4.
    """

    breadth: Array
    p: Array
    dp: Array
    ddp: Array

    @cached_property
    def p1(self) -> Array:
        """Support a quarter turn on, mm (m, n)."""
        return _quarter_on(self.p)

    @cached_property
    def dp1(self) -> Array:
        """Derivative of the support a quarter turn on, mm/rad (m, n)."""
        return _quarter_on(self.dp)

    @cached_property
    def ddp1(self) -> Array:
        """Second derivative of the support a quarter turn on, mm/rad^2 (m, n)."""
        return _quarter_on(self.ddp)

    def part(self, rows: Mask) -> Support:
        """The cams of the rows that a mask (m,) marks."""
        return _copy_cached(self, Support(self.breadth[rows], self.p[rows], self.dp[rows], self.ddp[rows]), rows)


def _copy_cached(whole: Arrays, part: Arrays, rows: Mask) -> Arrays:
    """Put the rows of arrays that `whole` has computed and cached into the cache of its part; return the part."""
    for name, values in vars(whole).items():
        if name not in vars(part) and isinstance(values, np.ndarray):
            vars(part)[name] = values[rows]
    return part


def _quarter_on(values: Array) -> Array:
    """Samples (m, n) a quarter turn on."""
    n = values.shape[1]
    return np.concatenate([values[:, n // 4 :], values[:, : n // 4]], axis=1)


@dataclass(frozen=True, eq=False)
class LoopArrays:
    """Loops of m linkages of one kind at n relative angles, arrays (m, n).

    `side` is 1 for an open assembly, -1 for a crossed one. `x`, `y` are D in the frame's axes, mm, `q` is AD^2, mm^2.
    `near` and `far` are positive where the loop closes, and 0 at its limits. Each kind gives `output` (rad or mm),
    `frame` (theta_3 but for a constant, continuous round the turn, rad), `rate`, `second`, `frame_rate`,
    `frame_second`, their first and second derivatives by the relative angle, the signed sine of the `transmission`
    angle at D, None where that is always a right angle, and the sine of the `force` angle, at least 0
    (`kin.linkage.forces`).
    """

    side: float
    cams: Support
    lengths: Lengths
    x: Array
    y: Array
    q: Array
    near: Array
    far: Array

    def part(self, rows: Mask) -> Self:
        """The loops of the rows that a mask (m,) marks."""
        lengths = Lengths(*(length[rows] for length in self.lengths))
        fields = (self.x, self.y, self.q, self.near, self.far)
        part = self.__class__(self.side, self.cams.part(rows), lengths, *(field[rows] for field in fields))
        return _copy_cached(self, part, rows)

    def signed_root(self, square: Array) -> Array:
        """Square root of `square` (m, n), below 0 for a crossed assembly, in mm of mm^2 and mm^2 of mm^4."""
        root = np.sqrt(square)
        return root if self.side > 0 else -root

    @cached_property
    def root(self) -> Array:
        """Signed root of near far (m, n): 2 r1 r4 sin theta_4, mm^2; of an inverted slider-crank r1 sin theta_4."""
        return self.signed_root(self.near * self.far)

    @cached_property
    def output(self) -> Array:
        """Output of the loop: the angle theta_4, rad (m, n)."""
        angle: Array = np.arctan(self.near / self.root)
        angle += angle
        return angle


class InvertedLoop(LoopArrays):
    """The frame slides on a rocker: theta_3 and -theta_4 differ by a constant; `x` and `q` are not used.

    `near` and `far` are mm.
    """

    dimensions: ClassVar[tuple[str, ...]] = ("ground", "rocker", "joint_offset")

    @classmethod
    def from_lengths(cls, side: float, cams: Support, lengths: Lengths) -> Self:
        """Loops of linkages with these lengths, driven by these cams; `side` is -1 for crossed ones, else 1."""
        r1, r4 = lengths.ground, lengths.rocker
        y = cams.p - (0.5 * cams.breadth - lengths.joint_offset)
        return cls(side, cams, lengths, y, y, y, y + (r1 - r4), (r1 + r4) - y)

    def margin(self, extreme: Callable[[Array], Array]) -> Array:
        """Least distance from binding, mm (m,), 0 or less where the loop binds; `extreme` gives row minima (m,)."""
        return np.minimum(extreme(self.near), extreme(self.far))

    @cached_property
    def rate(self) -> Array:
        """First derivative of the output angle by the relative angle, theta_4', (m, n)."""
        return self.cams.dp / self.root

    @cached_property
    def second(self) -> Array:
        """Second derivative of the output angle by the relative angle, theta_4'', 1/rad, (m, n)."""
        rate = self.rate
        return (self.cams.ddp - (self.lengths.rocker - self.y) * rate * rate) / self.root

    @cached_property
    def frame(self) -> Array:
        """Angle of the frame, theta_3, rad (m, n), but for a constant."""
        return -self.output

    @cached_property
    def frame_rate(self) -> Array:
        """First derivative of the frame's angle by the relative angle, theta_3', (m, n)."""
        return -self.rate

    @cached_property
    def frame_second(self) -> Array:
        """Second derivative of the frame's angle by the relative angle, theta_3'', 1/rad, (m, n)."""
        return -self.second

    @cached_property
    def transmission(self) -> None:
        """None: the angle at D is always a right angle."""
        return None

    @cached_property
    def force(self) -> Array:
        """Sine of the force angle, at least 0, (m, n): the force acts along the line from B to P.

        P = -S' u - S1' n from the shaft is where the normals of the contacts meet.
        """
        cams = self.cams
        along, across = cams.dp + self.root, cams.dp1 + (self.y - self.lengths.rocker)
        return np.abs(along) / _length(along, across)


class CouplerLoop(LoopArrays):
    """The frame is the coupler: what a four-bar and a slider-crank share. `near` and `far` are mm^2."""

    @staticmethod
    def vector(cams: Support, lengths: Lengths, least: Array) -> tuple[Array, Array, Array, Array]:
        """D from A in the frame's axes, x and y, mm; AD^2, mm^2; and AD^2 - least^2, mm^2; (m, n) each.

        `least` (m, 1) is the least AD, mm, at which the loop closes.
        """
        y = cams.p - (0.5 * cams.breadth - lengths.joint_offset)
        x = (cams.breadth + lengths.coupler) - cams.p1
        yy = y * y
        return x, y, x * x + yy, (x - least) * (x + least) + yy

    def _beyond(self, least: Array, extreme: Callable[[Array], Array]) -> Array:
        """Least value of AD - least, mm (m,), found by `extreme`, which gives the least value of each row.

        Where the loop does not close it is another negative length, as AD is not known.
        """
        near = extreme(self.near)
        return np.asarray(near / (np.sqrt(np.maximum(near + least * least, 0.0)) + least))

    @cached_property
    def half_rate(self) -> Array:
        """Half the derivative of AD^2 by the relative angle, mm^2/rad (m, n)."""
        return self.y * self.cams.dp - self.x * self.cams.dp1

    @property
    def half_second(self) -> Array:
        """Half the second derivative of AD^2 by the relative angle, mm^2/rad^2 (m, n)."""
        cams = self.cams
        return cams.dp * cams.dp + cams.dp1 * cams.dp1 + self.y * cams.ddp - self.x * cams.ddp1

    @property
    def spin(self) -> Array:
        """Derivative of the polar angle of D in the frame's axes by the relative angle, times AD^2, mm^2/rad (m, n)."""
        return self.x * self.cams.dp + self.y * self.cams.dp1

    @property
    def spin_rate(self) -> Array:
        """Derivative of `spin` by the relative angle, mm^2/rad^2 (m, n)."""
        return self.x * self.cams.ddp + self.y * self.cams.ddp1

    def turned(self, along: Array, across: Array) -> tuple[Array, Array]:
        """Components (m, n) of the vector (along, across) along AD and at right angles to it, times the length of AD.

        Their angle never reaches the cut of the arctangent in `frame`: D stays on one side of AB, or of the slide's
        foot, and x > 0.
        """
        x, y = self.x, self.y
        return along * x + across * y, across * x - along * y

    @property
    def lever(self) -> tuple[Array, Array]:
        """Components along the frame's axes u and n, mm, (m, n) each, of the vector from P to D.

        P = -S' u - S1' n is where the normals of the contacts meet. The force of the frame on the joint D acts along
        the vector.
        """
        return self.cams.dp + self.x, self.cams.dp1 + self.y


class FourBarLoop(CouplerLoop):
    """The coupler's end D is on a rocker."""

    dimensions: ClassVar[tuple[str, ...]] = ("ground", "coupler", "rocker", "joint_offset")

    @classmethod
    def from_lengths(cls, side: float, cams: Support, lengths: Lengths) -> Self:
        """Loops of linkages with these lengths, driven by these cams; `side` is -1 for crossed ones, else 1."""
        r1, r4 = lengths.ground, lengths.rocker
        x, y, q, near = cls.vector(cams, lengths, np.abs(r1 - r4))
        return cls(side, cams, lengths, x, y, q, near, (r1 + r4) ** 2 - q)

    def margin(self, extreme: Callable[[Array], Array]) -> Array:
        """Least distance from binding, mm (m,), 0 or less where the loop binds; `extreme` gives row minima (m,)."""
        r1, r4 = self.lengths.ground[:, 0], self.lengths.rocker[:, 0]
        margin = self._beyond(np.abs(r1 - r4), extreme)
        far, most = extreme(self.far), r1 + r4
        return np.minimum(margin, far / (np.sqrt(np.maximum(most * most - far, 0.0)) + most))

    @cached_property
    def rate(self) -> Array:
        """First derivative of the output angle by the relative angle, theta_4', (m, n)."""
        rate = self.half_rate / self.root
        rate += rate
        return rate

    @cached_property
    def second(self) -> Array:
        """Second derivative of the output angle by the relative angle, theta_4'', 1/rad, (m, n)."""
        r1, r4 = self.lengths.ground, self.lengths.rocker
        rate, half = self.rate, self.half_second
        return (half + half - ((r1 * r1 + r4 * r4) - self.q) * rate * rate) / self.root

    @cached_property
    def _lean(self) -> Array:
        """Q + r4^2 - r1^2, mm^2 (m, n), with Q = AD^2: 2 r4 AD times the cosine of the angle ADB."""
        r1, r4 = self.lengths.ground, self.lengths.rocker
        return self.q - (r1 * r1 - r4 * r4)

    @cached_property
    def frame(self) -> Array:
        """Angle of the frame, theta_3, rad (m, n), but for a constant."""
        r1, r4 = self.lengths.ground, self.lengths.rocker
        cosine, sine = self.turned(self.q + (r1 * r1 - r4 * r4), self.root)
        return np.arctan2(-cosine, sine) if self.side > 0 else np.arctan2(cosine, -sine)

    @cached_property
    def frame_rate(self) -> Array:
        """First derivative of the frame's angle by the relative angle, theta_3', (m, n)."""
        # (arg D)' Q = theta_4' (r1 D_x - Q)
        return (-0.5 * self.rate * self._lean - self.spin) / self.q

    @cached_property
    def frame_second(self) -> Array:
        """Second derivative of the frame's angle by the relative angle, theta_3'', 1/rad, (m, n)."""
        turning = -0.5 * self.second * self._lean - self.rate * self.half_rate - self.spin_rate
        return (turning - 2.0 * self.frame_rate * self.half_rate) / self.q

    @cached_property
    def transmission(self) -> Array:
        """Sine of the angle between coupler and rocker, with a sign, (m, n)."""
        return (self.x * self.root + self.y * self._lean) / (2.0 * self.lengths.rocker * self.q)

    @cached_property
    def force(self) -> Array:
        """Sine of the force angle at D, at least 0, (m, n)."""
        along, across = self.lever
        cosine, sine = self.y * self.root - self.x * self._lean, self.x * self.root + self.y * self._lean
        scale = _length(along, across) * (2.0 * self.lengths.rocker * self.q)
        return np.abs(along * sine + across * cosine) / scale


class SliderLoop(CouplerLoop):
    """The coupler's end D is on a slide, on the line at the height `offset`; `far` equals `near`."""

    dimensions: ClassVar[tuple[str, ...]] = ("coupler", "offset", "joint_offset")

    @classmethod
    def from_lengths(cls, side: float, cams: Support, lengths: Lengths) -> Self:
        """Loops of linkages with these lengths, driven by these cams; `side` is -1 for crossed ones, else 1."""
        x, y, q, near = cls.vector(cams, lengths, np.abs(lengths.offset))
        return cls(side, cams, lengths, x, y, q, near, near)

    def margin(self, extreme: Callable[[Array], Array]) -> Array:
        """Least distance from binding, mm (m,), 0 or less where the loop binds; `extreme` gives row minima (m,)."""
        return self._beyond(np.abs(self.lengths.offset[:, 0]), extreme)

    @cached_property
    def root(self) -> Array:
        """D_x, mm (m, n): the square root of `near`, with the sign of the assembly."""
        return self.signed_root(self.near)

    @property
    def output(self) -> Array:
        """Position of the slide, D_x, mm (m, n)."""
        return self.root

    @cached_property
    def rate(self) -> Array:
        """First derivative of the slide's position by the relative angle, D_x', mm/rad (m, n)."""
        return self.half_rate / self.root

    @cached_property
    def second(self) -> Array:
        """Second derivative of the slide's position by the relative angle, D_x'', mm/rad^2 (m, n)."""
        rate = self.rate
        return (self.half_second - rate * rate) / self.root

    @cached_property
    def frame(self) -> Array:
        """Angle of the frame, theta_3, rad (m, n), but for a constant."""
        cosine, sine = self.turned(self.root, self.lengths.offset)
        return np.arctan2(sine, cosine) if self.side > 0 else np.arctan2(-sine, -cosine)

    @cached_property
    def frame_rate(self) -> Array:
        """First derivative of the frame's angle by the relative angle, theta_3', (m, n)."""
        return (-(self.lengths.offset * self.rate) - self.spin) / self.q

    @cached_property
    def frame_second(self) -> Array:
        """Second derivative of the frame's angle by the relative angle, theta_3'', 1/rad, (m, n)."""
        turning = -(self.lengths.offset * self.second) - self.spin_rate
        return (turning - 2.0 * self.frame_rate * self.half_rate) / self.q

    @cached_property
    def transmission(self) -> Array:
        """Sine of the angle between coupler and the slide's normal, with a sign, (m, n)."""
        return (self.root * self.x + self.lengths.offset * self.y) / self.q

    @cached_property
    def force(self) -> Array:
        """Sine of the force angle at D, at least 0, (m, n)."""
        along, across = self.lever
        cosine, sine = self.turned(self.root, self.lengths.offset)
        return np.abs(along * cosine - across * sine) / (_length(along, across) * self.q)


def _length(x: Array, y: Array) -> Array:
    return np.sqrt(x * x + y * y)


Loop: TypeAlias = InvertedLoop | FourBarLoop | SliderLoop
LOOPS: dict[type, type[Loop]] = {FourBar: FourBarLoop, InvertedSliderCrank: InvertedLoop, SliderCrank: SliderLoop}


def loop_class(linkage: Linkage) -> type[Loop]:
    """Class of the loops of a linkage's kind."""
    return LOOPS[type(linkage)]


def angles(n: int) -> Array:
    """Relative angles of n even samples of a turn, rad (n,)."""
    return np.arange(n, dtype=np.float64) * (TURN / n)
