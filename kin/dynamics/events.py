"""When contact ends: the force of a contact along one stretch, and the first instant at which the contact ends.

Along a stretch everything is a Chebyshev series and a free motion. Windows of samples show where the state may end;
the instant itself is found with plain floats, since a turn may hold thousands.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.numeric.chebyshev import together, value
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from kin.dynamics.oscillator import Free
    from kin.numeric.arrays import Array


FREE, LOWER, UPPER = 0, 1, -1

_GRID = 17  # places of a closer look; each round keeps an eighth of the interval
_ROUNDS = 15  # after which the interval is lost in rounding
_FIRST, _MOST = 64, 4096  # samples of a window
_COARSE = 32  # steps in what is left of a stretch, at least
_EPS = float(np.finfo(float).eps)
CALL = 100  # places that a look costs besides those it takes
_STRIDE = 40  # places that a stride of a flight costs


class SpentError(CamgeoError):
    """A search that would look at more places than are permitted, or a turn of too many changes of contact."""


@dataclass()
class Work:
    """Count of the places looked at so far, and the most that are permitted; each search costs CALL places more."""

    most: int
    places: int = 0

    def take(self, places: int) -> None:
        """Count a number of places, and CALL for the search itself. Raises SpentError beyond the most."""
        self._count(places + CALL)

    def stride(self) -> None:
        """Count the cost of one stride of a flight. Raises SpentError beyond the most."""
        self._count(_STRIDE)

    def _count(self, places: int) -> None:
        self.places += places
        if self.places > self.most:
            raise SpentError


class Span(Protocol):
    """One state of contact along one stretch: its level is above 0 while it lasts. Times count from the knot, rad."""

    @property
    def limit(self) -> float:
        """Level, a little below 0, below which the state of contact has ended.

        Above it a negative level may be rounding.
        """
        ...

    def at(self, time: Array) -> Array:
        """Level (n,), above 0 while the state of contact lasts, at times (n,) from the knot, rad."""
        ...

    def once(self, time: float) -> float:
        """Level at one time from the knot, rad."""
        ...


class Driven(NamedTuple):
    """Chebyshev series (DEGREE + 1,) of a driven figure on a stretch of half width `half`, rad."""

    series: Array
    half: float


class Pressed:
    """The contact force on one face along a stretch, a Span: a series of its driven part, and a free motion.

    `weights` are the factors of z and z' of the free motion in the force.
    """

    def __init__(self, driven: Driven, free: Free, weights: tuple[float, float], limit: float) -> None:
        self.limit = limit
        self._series, self._half, self._free = *driven, free
        self._plain: list[float] = self._series.tolist()
        self._factors = free.summed(*weights)

    def at(self, time: Array) -> Array:
        """Contact force (n,), N or N m, at times (n,) from the knot, rad."""
        cosine, sine = self._free.oscillator.basis(time - self._free.since)
        first, second = self._factors
        value: Array = together(self._series[None], time / self._half - 1.0)[0] + first * cosine + second * sine
        return value

    def once(self, time: float) -> float:
        """Contact force, N or N m, at one time from the knot, rad."""
        cosine, sine = self._free.oscillator.basis_at(time - self._free.since)
        first, second = self._factors
        return value(self._plain, time / self._half - 1.0) + first * cosine + second * sine


def windows(begin: float, end: float, fine: float, step: float) -> Iterator[Array]:
    """Times from `begin` to `end`, rad, in growing arrays; each begins with the last but one time of the array before.

    They are at most `step` apart until `fine`, rad, and then 1/32 of the whole time.
    """
    count, now, before = _FIRST, begin, np.empty(0)
    coarse = (end - begin) / _COARSE
    step = min(step, coarse)
    while now < end:
        stop = min(now + count * step, end) if now < fine else end
        parts = math.ceil((stop - now) / (step if now < fine else coarse) - 1e-9)
        times = np.linspace(now, stop, max(parts, 1) + 1)
        yield np.concatenate([before, times])
        count, now, before = min(2 * count, _MOST), stop, times[-2:-1]


def first(span: Span, time: Array, level: Array, work: Work) -> float | None:
    """First time, rad, at which a state has ended, from its levels (n,) at times (n,), rad; None if it outlasts them.

    It is the first of the times where the state has ended already there. Raises SpentError beyond what `work` permits.
    """
    ended = np.flatnonzero(level < span.limit)
    until = int(ended[0]) if len(ended) else len(level)
    for i in dips(level[:until]).tolist():
        hit = _dip(span, float(time[max(i - 1, 0)]), float(time[min(i + 1, until - 1)]), work)
        if hit is not None:
            return crossing(span.once, float(time[max(i - 1, 0)]), hit, span.limit, work)
    if until == len(level):
        return None
    if until == 0:
        return float(time[0])
    return crossing(span.once, float(time[until - 1]), float(time[until]), span.limit, work)


def dips(level: Array) -> NDArray[np.intp]:
    """Indices (k,) of samples (n,) that are lowest among their neighbours, and beside which the level may dip below 0.

    The dip may be as deep again as the sample is below its neighbours; a smooth one is a quarter as deep at most.
    """
    if len(level) < 3:
        return np.empty(0, dtype=np.intp)
    middle, before, after = level[1:-1], level[:-2], level[2:]
    rise = np.maximum(before, after) - middle
    places: NDArray[np.intp] = 1 + np.flatnonzero((middle <= before) & (middle <= after) & (middle < rise))
    return places


def _dip(span: Span, low: float, high: float, work: Work) -> float | None:
    """A time between `low` and `high`, rad, at which a state has ended; None where its level dips less deep."""
    for _ in range(_ROUNDS):
        time = np.linspace(low, high, _GRID)
        work.take(_GRID)
        level = span.at(time)
        j = int(np.argmin(level))
        if level[j] < span.limit:
            return float(time[j])
        low, high = float(time[max(j - 1, 0)]), float(time[min(j + 1, _GRID - 1)])
        rise = float(max(level[max(j - 1, 0)], level[min(j + 1, _GRID - 1)]) - level[j])
        if level[j] - span.limit > rise or high - low <= 4.0 * _EPS * high:
            return None
    return None


def crossing(
    level: Callable[[float], float], low: float, high: float, limit: float, work: Work, *, width: float = 2.0 * _EPS
) -> float:
    """Time between `low` and `high` at which a level falls below `limit`: later end of a bracket of relative `width`.

    Chandrupatla's method, Adv. Eng. Softw. 28, 1997: inverse interpolation where it is safe, else halving. A level that
    is below the limit at the start gives the start. Raises SpentError beyond what `work` permits.
    """
    work.take(0)
    width *= max(abs(low), abs(high))
    b, at_b, a, at_a = low, level(low) - limit, high, level(high) - limit
    if at_b < 0.0:
        return low
    c, at_c = b, at_b
    share = 0.5
    while abs(b - a) > width:
        x = a + share * (b - a)
        at = level(x) - limit
        if (at < 0.0) == (at_a < 0.0):
            c, at_c = a, at_a
        else:
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = x, at
        near = width / abs(b - a) if b != a else 1.0
        if near > 0.5:
            break
        share = _interpolated((a, b, c), (at_a, at_b, at_c))
        share = min(max(share, 0.5 * near), 1.0 - 0.5 * near)
    return float(a if at_a < 0.0 else b)


def _interpolated(places: tuple[float, float, float], levels: tuple[float, float, float]) -> float:
    """Share of the way from a to b at which the inverse quadratic through three places puts the root, or a half."""
    (a, b, c), (at_a, at_b, at_c) = places, levels
    if at_c in (at_a, at_b):
        return 0.5
    xi, phi = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
    if not phi * phi < xi or not (1.0 - phi) ** 2 < 1.0 - xi:
        return 0.5
    return at_a / (at_b - at_a) * at_c / (at_b - at_c) + (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)


def top(span: Span, low: float, high: float, sign: float, work: Work) -> tuple[float, float]:
    """The level between times `low` and `high`, rad, whose product with `sign` is greatest, and its time.

    Found by closer and closer looks. Raises SpentError beyond what `work` permits.
    """
    for _ in range(_ROUNDS):
        time = np.linspace(low, high, _GRID)
        work.take(_GRID)
        level = sign * span.at(time)
        j = int(np.argmax(level))
        i, k = max(j - 1, 0), min(j + 1, _GRID - 1)
        low, high = float(time[i]), float(time[k])
        if level[j] - min(level[i], level[k]) <= 8.0 * _EPS * abs(float(level[j])) or high - low <= 4.0 * _EPS * high:
            break
    return sign * float(level[j]), float(time[j])
