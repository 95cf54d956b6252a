"""The designs of a sweep: the values of each follow from its index alone.

So a design can be computed anywhere and at any time. The division into chunks is part of the plan, and no engine or
number of workers changes it: vectorised arithmetic may round the last designs of an array otherwise than others.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from camgeo.common.system import uninterrupted
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.keys import Axis
    from kin.numeric.arrays import Array

Method: TypeAlias = Literal["grid", "random", "sobol"]

MOST = 2**30  # designs of a sweep; as many points has scipy's Sobol sequence
SOBOL_BITS = 30  # its coordinates are whole multiples of 2^-30
CHUNKS = 64  # about as many chunks make a sweep, so that a kill costs little and workers stay busy to the end
SMALLEST, GREATEST = 64, 8192  # designs of a chunk: worth a file of its own; small enough to hold at 360 angles each
_WORDS = 4  # random words that one step of Philox's counter gives


@dataclass(frozen=True)
class Plan:
    """The designs of a sweep, numbered from 0 to count - 1.

    grid: every combination of the axes' values, the last axis running fastest; random: independent and uniform,
    by Philox, a counter-based generator; sobol: Sobol's sequence as scipy scrambles it with the seed. Raises ValueError
    for no axes, a count that is not 1 to MOST, and a grid whose axes have no values or whose designs are not `count`.
    """

    axes: tuple[Axis, ...]
    method: Method
    count: int
    seed: int = 0

    def __post_init__(self) -> None:
        if not self.axes:
            raise ValueError("a sweep varies at least one field")
        if not 0 < self.count <= MOST:
            raise ValueError(f"a sweep has 1 to {MOST} designs, not {self.count}")
        if self.method == "grid":
            if not all(axis.values for axis in self.axes):
                raise ValueError("every axis of a grid has its values")
            if self.count != (full := math.prod(len(axis.values) for axis in self.axes)):
                raise ValueError(f"this grid has {full} designs, not {self.count}")

    @property
    def chunk(self) -> int:
        """Number of designs of a chunk, a power of two; the last chunk may have fewer."""
        return min(max(1 << (self.count // CHUNKS).bit_length(), SMALLEST), GREATEST)

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.count // self.chunk)

    def span(self, number: int) -> tuple[int, int]:
        """Index of the first design of chunk `number`, counted from 0, and the index after its last."""
        return number * self.chunk, min((number + 1) * self.chunk, self.count)

    def values(self, first: int, last: int) -> Array:
        """Values of designs first .. last - 1, (last - first, axes), in the recipe's units.

        Words are given by their index. Raises ValueError for designs that the plan does not have, ModuleNotFoundError
        for Sobol's sequence without scipy.
        """
        if not 0 <= first <= last <= self.count:
            raise ValueError(f"designs {first} to {last} of {self.count}")
        if self.method == "grid":
            index = np.unravel_index(np.arange(first, last), [len(axis.values) for axis in self.axes])
            columns = [np.array(axis.values)[i] for axis, i in zip(self.axes, index, strict=True)]
            return np.stack(columns, axis=1)
        draw = _random if self.method == "random" else _sobol
        share = draw(first, last, len(self.axes), self.seed)
        return np.stack([_spread(axis, share[:, i]) for i, axis in enumerate(self.axes)], axis=1)


def _spread(axis: Axis, share: Array) -> Array:
    """Values of an axis for shares in [0, 1): listed ones for equal parts, else linear between the ends."""
    if axis.values:
        return np.array(axis.values)[(share * len(axis.values)).astype(np.int64)]
    return axis.low * (1.0 - share) + axis.high * share


def _random(first: int, last: int, width: int, seed: int) -> Array:
    """Uniform numbers in [0, 1), shape (last - first, width), of which each depends on seed and place alone."""
    per = -(-width // _WORDS)
    words = np.random.Philox(key=seed, counter=first * per).random_raw((last - first) * per * _WORDS)
    rows = words.reshape(last - first, per * _WORDS)[:, :width]
    return np.ldexp((rows >> np.uint64(11)).astype(np.float64), -53)


def _sobol(first: int, last: int, width: int, seed: int) -> Array:
    """Points first .. last - 1 of the scrambled sequence, shape (last - first, width).

    In Gray code order point i is a fixed point combined by exclusive or with one direction for each bit of i, so any
    point is reached without those before it.
    """
    start, directions = _sobol_directions(width, seed, max(last - 1, 1).bit_length())
    index = np.arange(first, last, dtype=np.uint64)
    points = np.broadcast_to(start, (last - first, width)).copy()
    for bit, direction in enumerate(directions):
        points ^= ((index >> np.uint64(bit)) & np.uint64(1))[:, None] * direction
    return np.ldexp(points.astype(np.float64), -SOBOL_BITS)


@lru_cache(maxsize=8)
def _sobol_directions(width: int, seed: int, bits: int) -> tuple[NDArray[np.uint64], NDArray[np.uint64]]:
    """Point 0 (width,) and, for each of `bits` bits, how it changes a point (bits, width), as whole numbers."""
    from scipy.stats import qmc

    # the first one reads scipy's table of numbers, in compiled code that prints an exception and goes on without them
    with uninterrupted():
        sequence = qmc.Sobol(width, scramble=True, bits=SOBOL_BITS, rng=np.random.default_rng(seed))

    def point() -> NDArray[np.uint64]:
        return np.asarray(sequence.random(1)[0] * 2.0**SOBOL_BITS).astype(np.uint64)

    start = point()
    rows = []
    for bit in range(bits):
        sequence.fast_forward(2**bit - sequence.num_generated)
        rows.append(point() ^ start)
    return start, np.stack(rows)
