"""Greatest and least values of a contact force, or of any figure linear in the state, over stretches of a response."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.dynamics.response import Response, ResponsePlaces
from kin.numeric.chebyshev import evaluated
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array, Indices


_NEAR = 0.03  # of the range: samples a quarter of a radian apart miss less of a peak
_MOST_NEAR = 256
_GRID, _ROUNDS = 17, 4  # places between two neighbours; each round keeps an eighth, and after the last a parabola does
_FOR_VALUE = 3  # rounds after which its height is good to 1e-11 of a swing, if not its place
_AT_ONCE = 400_000  # samples, which bounds the memory


class PeaksOverTurn(NamedTuple):
    """Greatest and least value, in the unit of the figure, each with the shaft angle, rad, at which it is reached."""

    greatest: float
    greatest_at: float
    least: float
    least_at: float


@dataclass(frozen=True, eq=False)
class ResponseFigure:
    """A figure w0 z + w1 z' + q over a response, q a polynomial on each stretch.

    `series` (m, DEGREE + 1) is the driven part w0 p + w1 p' + q; `z` and `v` are w0 and w1, for the free motion.
    """

    response: Response
    series: Array
    z: float
    v: float

    @staticmethod
    def of(response: Response, z: float, v: float, more: Array | float = 0.0) -> ResponseFigure:
        """Make the figure w0 z + w1 z' + q: w0 is `z`, w1 `v`, and q `more`, a constant or a series (m, DEGREE + 1)."""
        series = z * response.p + v * response.v
        if isinstance(more, float):
            series[:, 0] += more
        else:
            series = series + more
        return ResponseFigure(response, series, z, v)

    def at(self, starts: Array, samples: ResponsePlaces) -> Array:
        """Values (n,) of the figure at the samples, from the states (2, m) at the starts of all stretches."""
        response, stretch = self.response, samples.stretch
        first, second = self._free(starts)
        cosine, sine = response.oscillator.basis(samples.time)
        x = samples.time / response.half[stretch] - 1.0
        value: Array = evaluated(self.series, stretch, x) + first[stretch] * cosine + second[stretch] * sine
        return value

    def together(self, starts: Array, x: Array, polynomials: Array) -> Array:
        """Values (m, n) of the figure at the same x (n,) in [-1, 1] of all m stretches.

        `starts` (2, m) are the states at the starts of the stretches, `polynomials` (DEGREE + 1, n) Chebyshev's at x.
        """
        first, second = self._free(starts)
        cosine, sine = self.response.oscillator.basis(self.response.half[:, None] * (1.0 + x))
        values: Array = self.series @ polynomials + first[:, None] * cosine + second[:, None] * sine
        return values

    def _free(self, starts: Array) -> tuple[Array, Array]:
        """Factors (m,) of the two motions of `Oscillator.basis` in the free part of the figure on each stretch."""
        return self.response.oscillator.factors(starts - self.response.ends[0].T, self.z, self.v)

    def peaks(self, starts: Array, stretches: Indices) -> PeaksOverTurn:
        """Extremes over the given stretches (n,), ends included, from the states (2, m) at the starts of all stretches.

        They are found by sampling every swing, and closer and closer between the neighbours of each sample that may be
        the highest.
        """
        parts: list[tuple[ResponsePlaces, Array]] = []
        for chosen in np.array_split(stretches, max(1, len(stretches) * 64 // _AT_ONCE)):
            at = self.response.samples(starts, chosen)
            for first in range(0, len(at.time), _AT_ONCE):
                part = ResponsePlaces(at.stretch[first : first + _AT_ONCE + 2], at.time[first : first + _AT_ONCE + 2])
                parts.append((part, self.at(starts, part)))
        return PeaksOverTurn(*self._highest(starts, parts, 1.0), *self._highest(starts, parts, -1.0))

    def least(self, starts: Array, samples: ResponsePlaces) -> float:
        """Least value at and between samples (n,) in time order, which must show every swing.

        `starts` (2, m) are the states at the starts of all stretches.
        """
        return self._highest(starts, [(samples, self.at(starts, samples))], -1.0, _FOR_VALUE)[0]

    def _highest(
        self, starts: Array, parts: list[tuple[ResponsePlaces, Array]], sign: float, rounds: int = _ROUNDS
    ) -> tuple[float, float]:
        """The value whose product with `sign` is greatest, and its shaft angle, rad."""
        # samples close to the best that are no lower than both neighbours may hold the peak between these
        best = max(float((sign * values).max()) for _, values in parts)
        spread = best + max(float((-sign * values).max()) for _, values in parts)
        least = best - _NEAR * spread
        peaks: list[tuple[float, int, float]] = []
        brackets: list[tuple[int, float, float]] = []
        for at, values in parts:
            near = np.flatnonzero(sign * values >= least)
            top = int(near[np.argmax(sign * values[near])]) if len(near) else -1
            if top >= 0:
                peaks.append((float(values[top]), int(at.stretch[top]), float(at.time[top])))
            before, after = beside(at.stretch, near)
            peak = (sign * values[near] >= sign * values[before]) & (sign * values[near] >= sign * values[after])
            near, before, after = near[peak], before[peak], after[peak]
            highest = np.argsort(-sign * values[near], kind="stable")[:_MOST_NEAR]
            columns = at.stretch[near], at.time[before], at.time[after]
            brackets += zip(*(column[highest].tolist() for column in columns), strict=True)
        if brackets:
            stretch, low, high = (np.array(column) for column in zip(*brackets, strict=True))
            tops, times = narrowed(lambda at: self.at(starts, at), stretch, (low, high), sign, rounds)
            peaks += zip(tops.tolist(), stretch.tolist(), times.tolist(), strict=True)
        value, stretch_of_value, time = max(peaks, key=lambda candidate: sign * candidate[0])
        return value, float(self.response.drive.knots[stretch_of_value]) + time


def narrowed(
    value: Callable[[ResponsePlaces], Array],
    stretch: Indices,
    between: tuple[Array, Array],
    sign: float,
    rounds: int = _ROUNDS,
) -> tuple[Array, Array]:
    """Values (n,) whose product with `sign` is greatest between two times (n,) on stretches (n,), and their times.

    `value(places)` gives the values at places. Times are rad since the start of the stretch; each of the rounds keeps
    an eighth of the interval.
    """
    low, high = between
    grid, rows = np.linspace(0.0, 1.0, _GRID), np.arange(len(stretch))
    best, where = np.empty(len(stretch)), low
    for _ in range(rounds):
        time = low[:, None] + (high - low)[:, None] * grid
        values = value(ResponsePlaces(np.repeat(stretch, _GRID), time.ravel())).reshape(time.shape)
        top = np.argmax(sign * values, axis=1)
        best, where = values[rows, top], time[rows, top]
        before, after = np.maximum(top - 1, 0), np.minimum(top + 1, _GRID - 1)
        low, high = time[rows, before], time[rows, after]
    # where there is a neighbour to either side
    slope, bend = (
        0.5 * (values[rows, after] - values[rows, before]),
        values[rows, before] + values[rows, after] - 2 * best,
    )
    share = np.divide(-slope, bend, out=np.zeros_like(bend), where=(after - before == 2) & (sign * bend < 0.0))
    return best + 0.5 * slope * share, where + 0.5 * (high - low) * share


def beside(stretch: Indices, places: Indices) -> tuple[Indices, Indices]:
    """Indices (k,) of the samples before and after `places` (k,), or of these themselves at the ends of a stretch.

    `stretch` (n,) is the stretch of each sample.
    """
    before, after = np.maximum(places - 1, 0), np.minimum(places + 1, len(stretch) - 1)
    before = np.where(stretch[before] == stretch[places], before, places)
    after = np.where(stretch[after] == stretch[places], after, places)
    return before, after
