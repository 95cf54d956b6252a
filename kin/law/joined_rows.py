"""Rows of a cam table joined as a drive's controller joins them: by lines, cubic splines, or polynomials of degree 5.

Between two rows the difference from a motion, and those of their derivatives, are followed by polynomials that leave
nothing between samples (`kin.numeric.monotone`), so that no greater value is missed.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from kin.numeric import cubics, quintics
from kin.numeric.monotone import between, cells, extremes_of_each
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from kin.numeric.arrays import Array

Join = Literal["line", "cubic", "quintic"]
ORDERS: dict[Join, int] = {"line": 1, "cubic": 2, "quintic": 2}
"""Highest derivative of the joined rows that is no impulse."""
RATES: dict[Join, int] = {"line": 0, "cubic": 0, "quintic": 2}
"""Number of derivatives that the rows themselves have."""
PLACES = np.array([0.001, 0.28, 0.5])
"""Shares of a part's width near which differences of smooth motions are greatest: second derivatives of a cubic spline
beside a row, first ones of polynomials at about 0.2 to 0.3, positions half way."""
PLACES_ABOUT_A_BREAK = 33  # of a part in which the motion is not smooth
_SHARE = 1e-12  # accuracy of the difference, as a part of the range of positions
_SHARE_OF_RATES = 1e-10  # likewise of a derivative, of its greatest value
_MOST = 1e60  # mm or rad by rad^order, whose squares are still numbers
_AT_ONCE = 16_384  # parts that are followed together: more would take much memory


class Off(NamedTuple):
    """A greatest difference, mm or rad by rad^order, and the master's angle where it is, rad."""

    value: float
    at: float


@dataclass(frozen=True, eq=False)
class JoinedRows:
    """Rows of a master's angle (n,), rad, and of a slave (1 or 3, n): row 0 its position, mm or rad.

    Lines and cubic splines meet the position alone. Quintics also meet the first and second derivatives by the master's
    angle, rows 1 and 2 of the slave. `ends` are the slopes of a cubic spline at the first and the last row.
    """

    master: Array
    slave: Array
    join: Join
    ends: tuple[float, float] = (0.0, 0.0)

    @cached_property
    def coefficients(self) -> Array:
        """Coefficients (2, 4 or 6, n - 1) of the polynomial of each part over 0 to 1, the constant first."""
        if self.join == "line":
            return np.stack([self.slave[0, :-1], np.diff(self.slave[0])])
        width = self._width
        if self.join == "quintic":
            return quintics.coefficients(self.slave[:, :-1], self.slave[:, 1:], width)
        rows = np.stack([self.slave[0], cubics.spline_slopes(self.master, self.slave[0], *self.ends)])
        return cubics.coefficients(rows[:, :-1], rows[:, 1:], width)

    def rows(self, angle: Array, order: int) -> Array:
        """The slave's position, mm or rad, and derivatives (order + 1, n) at angles of the master (n,), rad.

        At a row they are those of the part that follows; `order` is at most that of `ORDERS`.
        """
        part = np.clip(np.searchsorted(self.master, angle, side="right") - 1, 0, len(self.master) - 2)
        step = angle - self.master[part]
        return quintics.polynomial(self.coefficients[:, part], self._width[part], step, order)

    @cached_property
    def _width(self) -> Array:
        """Width of each part (n - 1,), rad."""
        return np.diff(self.master)

    @property
    def sound(self) -> bool:
        """Whether position and derivatives at and between the rows are small enough to be computed with."""
        with np.errstate(all="ignore"):
            rows = self.rows(np.concatenate([self.master, self._middles]), ORDERS[self.join])
        return bool((np.abs(rows) < _MOST).all())

    def off(self, motion: Callable[[Array, int], Array], breaks: Iterable[float], order: int = 0) -> tuple[Off, ...]:
        """Greatest |motion - joined rows| over all rows, of the position and each derivative up to an order.

        `motion` gives the motion and its derivatives (order + 1, n) at angles (n,); at `breaks`, rad, they may jump.
        Raises RoughError where the motion changes too abruptly to be followed.
        """
        begin, end = self.master[[0, -1]].tolist()
        places = between(begin, end, [*self.master.tolist(), *breaks])
        resolution = self._resolution(order)

        def difference(angle: Array) -> Array:
            return motion(angle, order) - self.rows(angle, order)

        worst: tuple[Off, ...] = ()
        for first in range(0, len(places) - 1, _AT_ONCE):
            followed = cells(difference, places[first : first + _AT_ONCE + 1], resolution)
            found = (_greatest(*pair) for pair in extremes_of_each(followed))
            worst = tuple(map(max, worst, found)) if worst else tuple(found)
        return worst

    def off_at_some(
        self, motion: Callable[[Array, int], Array], breaks: Iterable[float], order: int = 0
    ) -> tuple[Off, ...]:
        """Greatest |motion - joined rows| at some places: `off` is no less, and costs several times as much.

        They are `PLACES` of each part, and more of those with `breaks`.
        """
        broken = np.unique(np.clip(np.searchsorted(self.master, np.array([*breaks])) - 1, 0, len(self.master) - 2))
        shares = (np.arange(PLACES_ABOUT_A_BREAK) + 0.5) / PLACES_ABOUT_A_BREAK
        more = self.master[broken, None] + self._width[broken, None] * shares
        places = np.append(self.master[:-1, None] + self._width[:, None] * PLACES, more)
        apart = np.abs(motion(places, order) - self.rows(places, order))
        worst = apart.argmax(axis=1)
        return tuple(Off(float(row[k]), float(places[k])) for row, k in zip(apart, worst, strict=True))

    @cached_property
    def _middles(self) -> Array:
        """Angles half way between rows (n - 1,), rad."""
        middles: Array = 0.5 * (self.master[1:] + self.master[:-1])
        return middles

    def _resolution(self, order: int) -> Array:
        """What is not resolved of the difference and its derivatives (order + 1,)."""
        sizes = np.abs(self.rows(np.concatenate([self.master, self._middles]), order)).max(axis=1)
        sizes[0] = np.ptp(self.slave[0])
        shares = np.array([_SHARE, *[_SHARE_OF_RATES] * order])
        resolution: Array = shares * np.where(sizes > 0.0, sizes, 1.0)
        return resolution

    def step(self) -> Off:
        """Greatest step of the velocity of lines where two meet, mm or rad by rad, over the end of the rows too."""
        slopes = np.diff(self.slave[0]) / np.diff(self.master)
        steps = np.abs(np.diff(np.append(slopes, slopes[0])))
        worst = int(np.argmax(steps))
        return Off(float(steps[worst]), float(self.master[worst + 1]))


def _greatest(least: tuple[float, float], greatest: tuple[float, float]) -> Off:
    (low, at_low), (high, at_high) = least, greatest
    return Off(abs(low), at_low) if abs(low) > abs(high) else Off(abs(high), at_high)


class Errors(NamedTuple):
    """What joined rows miss of a motion: greatest differences by order, the position first, from greatest values.

    `peaks` are the greatest |derivatives| of the motion itself, from the first on. `step` is the greatest step of the
    velocity between lines, None for other joins, whose velocity has none.
    """

    off: tuple[Off, ...]
    peaks: tuple[float, ...]
    step: Off | None

    def share(self, value: float, order: int) -> str:
        """Words on a value of a derivative as a share of the motion's greatest."""
        names = ("velocity", "acceleration")
        peak = self.peaks[order - 1]
        return f"{100.0 * value / peak:.3g} % of the greatest" if peak else f"the motion has no {names[order - 1]}"


def peaks(motion: Callable[[Array, int], Array], end: float, breaks: Iterable[float], order: int) -> tuple[float, ...]:
    """Greatest |derivatives| of a motion from 0 to `end`, rad, from the first to one of the given order.

    Raises RoughError where the motion changes too abruptly to be followed.
    """
    followed = cells(lambda t: motion(t, order), between(0.0, end, breaks), share=_SHARE_OF_RATES)
    return tuple(_greatest(*pair).value for pair in extremes_of_each(followed)[1:])


def errors(rows: JoinedRows, motion: Callable[[Array, int], Array], breaks: list[float]) -> Errors:
    """Errors of joined rows against a motion and its derivatives; arguments and errors as of `JoinedRows.off`."""
    order = ORDERS[rows.join]
    step = rows.step() if rows.join == "line" else None
    return Errors(rows.off(motion, breaks, order), peaks(motion, float(rows.master[-1]), breaks, order), step)
