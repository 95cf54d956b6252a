"""A motion over an angle, from any source: derivatives, bounds, breaks, dwells, and how its parts join."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from kin.law.joints import ORDERS, DerivativeJump, joints_of
from kin.law.normalised import IntentError
from kin.law.piecewise import Piecewise, Side
from kin.law.segment import Constant, moved
from kin.law.sources.peaks import extremes
from kin.numeric.lengths import marked
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.segment import Series, Stretch
    from kin.numeric.arrays import Array


_JOIN = 1e-9  # of the greatest derivative: a smaller difference over the seam is rounding
_CLOSED = 1e-11  # of the greatest of S, S', S'': a jump of S or S' below this is rounding, as for a lift
_LOOKS = 64  # places at which the size of a derivative is looked at, besides the knots
_INSIDE = (np.arange(8) + 0.5) / 8  # such places in each part, as shares of its width
_SEAM_ORDER = 6  # derivatives that agree where a function runs on over the seam


class DwellStretch(NamedTuple):
    """A dwell from `begin` to `end`, rad, where `end` may lie beyond a turn, at the displacement `level`, mm or rad."""

    begin: float
    end: float
    level: float


class TableRemark(NamedTuple):
    """Remark on a table or a cam card: its name, and a sentence in the table's own units."""

    name: Literal["cam-card", "contour", "table-angles", "table-distance", "table-noise", "table-row"]
    sentence: str


class Kept(NamedTuple):
    """Greatest distance of a motion from a row of its table, mm or rad, the row's line, and remarks.

    `lowered` is by how much the rows as a whole must be lowered to be nearest to it, and `distance_lowered` the
    greatest distance then, mm or rad. A motion from another source, such as a cam card, has remarks alone: `distance`
    is None.
    """

    distance: float | None
    line: int
    remarks: tuple[TableRemark, ...]
    lowered: float = 0.0
    distance_lowered: float = 0.0


@dataclass(frozen=True)
class Motion:
    """Displacement S, mm or rad, over [0, total] rad; `around` tells how the motion goes on beyond.

    With 1 the motion repeats. With -1 it goes on as S(total) - S(t - total), as a constant-breadth cam does after its
    half turn. With None it does not go on. `kept` tells how close it is to the table that it was made from, if any.
    """

    motion: Piecewise
    around: int | None = 1
    kept: Kept | None = None

    @property
    def total(self) -> float:
        """Angle covered, rad."""
        return float(self.motion.knots[-1])

    def at_start(self, order: int) -> Array:
        """Give the derivatives 0..order at the first angle, (order + 1,)."""
        return self.motion.derivatives(0.0, order, 1)[:, 0]

    def at_end(self, order: int) -> Array:
        """Give the derivatives 0..order at the last angle, (order + 1,)."""
        return self.motion.derivatives(self.total, order, -1)[:, 0]

    def derivatives(self, theta: float | Array, order: int, side: Side = 1) -> Array:
        """Give S and its derivatives at theta (n,) in [0, total], (order + 1, n); at a break the limit from `side`.

        Raises ValueError outside [0, total], DomainError where a formula does not exist.
        """
        return self.motion.derivatives(theta, order, side)

    def enclosure(self, lower: float | Array, upper: float | Array, order: int) -> tuple[Array, Array]:
        """Middles and radii, (order + 1, n) each, of intervals that hold S and its derivatives over [lower, upper].

        Raises ValueError where [lower, upper], (n,) each, leaves [0, total].
        """
        return self.motion.enclosure(lower, upper, order)

    def on(self, t: Series, side: Side = 1) -> Series:
        """Apply S to a jet (Taylor series at points) or a ball jet (proved Taylor series over intervals).

        Raises ValueError outside [0, total], DomainError where a formula does not exist at a jet.
        """
        return self.motion.on(t, side)

    @property
    def breaks(self) -> Array:
        """Angles (b,) inside (0, total) at which a derivative may jump, rising."""
        return self.motion.breaks

    @cached_property
    def rests(self) -> tuple[DwellStretch, ...]:
        """Exact dwells, rising; one that runs over the end of a repeating motion is a single dwell, the last."""
        knots = self.motion.knots.tolist()
        rests = [
            DwellStretch(knots[i], knots[i + 1], f.value)
            for i, f in enumerate(self.motion.functions)
            if isinstance(f, Constant)
        ]
        over = self.around == 1 and len(rests) > 1 and rests[0].begin == 0.0 and rests[-1].end == knots[-1]
        if over and abs(rests[0].level - rests[-1].level) <= _CLOSED * self._size:
            first, last = rests.pop(0), rests.pop()
            rests.append(DwellStretch(last.begin, self.total + first.end, last.level))
        return tuple(rests)

    @cached_property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Angles at which S, S', S'' or S''' jump, and the limits; jumps over the end of the motion are at 0."""
        knots = self.motion.knots
        side = np.repeat([1, -1], knots.size - 1)
        right, left = np.hsplit(self.motion.derivatives(np.append(knots[:-1], knots[1:]), ORDERS, side), 2)
        size = np.maximum(np.abs(right).max(axis=1), np.abs(left).max(axis=1))
        # within each part too: a short one, whose derivatives are the greatest, is easily stepped over
        inside = (knots[:-1, None] + np.diff(knots)[:, None] * _INSIDE).ravel()
        between = self.motion.derivatives(np.append(np.linspace(knots[0], knots[-1], _LOOKS), inside), ORDERS)
        size = np.maximum(size, np.abs(between).max(axis=1))
        joints = []
        if self.around is not None:
            end = left[:, -1] * self.around
            if self.around < 0:
                end[0] = right[0, 0]  # S begins anew at the end's own level
            joints.append((0.0, end, right[:, 0]))
        joints += [(float(knots[i]), left[:, i - 1], right[:, i]) for i in range(1, len(knots) - 1)]
        return joints_of(joints, size)

    @cached_property
    def _size(self) -> float:
        knots = self.motion.knots
        return float(np.abs(self.motion.derivatives(np.linspace(knots[0], knots[-1], _LOOKS), 2)).max())

    def demand_joined(self, field: str = "motion", unit: str = "mm", per: str = "rad") -> Motion:
        """Return the motion if S and S' join all round; else raise IntentError, at `field`, with the first jump.

        `unit` is that of S, mm or rad, and `per` that of the input, for the message.
        """
        for joint in self.joints:
            low = [(k, a, b) for k, a, b in joint.jumps if k < 2 and abs(b - a) > _CLOSED * self._size]
            if low:
                at = math.degrees(joint.at)
                jump = DerivativeJump(joint.at, tuple(low))  # messages have angles in degrees, as recipes do
                amount = jump.scaled(math.degrees(1.0)).said("deg", per) if unit == "rad" else jump.said(unit, per)
                remedy = _remedy(joint.at, low[0][0])
                raise IntentError(f"the motion does not join: {marked(amount)}; {remedy}", field, at)
        return self

    @cached_property
    def range(self) -> tuple[float, float]:
        """Least and greatest displacement, mm or rad."""
        least, _, greatest, _ = extremes(self.motion, 0)
        return least, greatest

    def raised(self, by: float) -> Motion:
        """Give the motion with a constant added, mm or rad."""
        return replace(self, motion=self.motion.raised(by)) if by else self

    def stretched(self, by: float) -> Motion:
        """Give the motion over an input `by` times as long."""
        if by == 1.0:
            return self
        functions = tuple(moved(function, width=by) for function in self.motion.functions)
        return replace(self, motion=Piecewise(self.motion.knots * by, functions))

    def from_lowest(self) -> Motion:
        """The motion less its least value, so that it is 0 where it is lowest."""
        least = self.range[0]
        return self if abs(least) <= _CLOSED * self._size else self.raised(-least)

    def periodic(self, field: str = "motion", unit: str = "mm") -> Piecewise:
        """S with period `total`; a dwell or a function that runs over the end is one stretch.

        Raises IntentError, at `field`, where S or S' jumps; `unit`, mm or rad, is for the message.
        """
        self.demand_joined(field, unit)
        knots, functions = self.motion.knots.tolist(), list(self.motion.functions)
        if len(functions) > 1 and isinstance(functions[0], Constant) and isinstance(functions[-1], Constant):
            begin = knots[-2] - self.total
            return Piecewise(np.array([begin, *knots[1:-2], begin + self.total]), tuple(functions[:-1]), self.total)
        return Piecewise(self.motion.knots, self.motion.functions, self.total, self._runs_on())

    def _runs_on(self) -> bool:
        """Whether the motion is one function that goes on smoothly over the end."""
        if len(self.motion.functions) > 1:
            return False
        begin, end = self.at_start(_SEAM_ORDER), self.at_end(_SEAM_ORDER)
        return bool((np.abs(end - begin) <= _JOIN * (1 + np.abs(begin).max())).all())


def _remedy(angle: float, order: int) -> str:
    if order:
        laws = "as laws from rest to rest and law: {uniform: {blend: 10}} do"
        return f"let both sides meet at one velocity, {laws}, or give one of them law: match"
    return "let both sides meet at one displacement" if angle else "let the motion end where it begins"


def joined(knots: Sequence[float], functions: Sequence[Stretch], around: int | None = 1) -> Motion:
    """Make a motion from stretches, stretch i between knots i and i + 1, rad; adjacent dwells at one level become one.

    With `around` 1 the motion repeats; with -1 it goes on as S(total) - S(t - total); with None it does not go on.
    """
    kept: list[Stretch] = []
    at = [float(knots[0])]
    for function, end in zip(functions, knots[1:], strict=True):
        if kept and isinstance(function, Constant) and kept[-1] == function:
            at[-1] = float(end)
            continue
        kept.append(function)
        at.append(float(end))
    return Motion(Piecewise(np.array(at), tuple(kept)), around)


def opposed(half: Motion) -> Motion:
    """Motion over the whole turn that goes on from `half`, S over half a turn, mm, as S(total) - S(t - total).

    K.-L. Shu and L.-I. Wu 2012, eq. 4. Raises IntentError where S or S' jumps; for a half with `around` -1 that
    includes its ends, where S'(total) must be -S'(0).
    """
    half.demand_joined("motion", "mm")
    end, knots = float(half.at_end(0)[0]), half.motion.knots.tolist()
    later = [moved(function, offset=end, scale=-1.0, start=half.total) for function in half.motion.functions]
    return joined([*knots, *(knot + half.total for knot in knots[1:])], [*half.motion.functions, *later])
