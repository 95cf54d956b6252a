"""What drives a follower train: a motion over the shaft angle, as Chebyshev series between its breaks.

A motion gives position, velocity and acceleration from closed forms, never by differences. Each of the three is fitted
by itself, so that a contact force, which is the acceleration's, is not lost in the position's rounding. Where the
velocity jumps, at the corners of a polygon, the jump is that of the two limits.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.chebyshev import AT_START, DEGREE, NODES, evaluated, fitted, split
from kin.numeric.distinct import distinct
from kin.numeric.errors import CamgeoError
from kin.numeric.monotone import cells, extremes
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.follower.drive import Excitation
    from kin.numeric.arrays import Array, Indices


AIM = 1e-14  # of a fitted acceleration, as a share of the greatest
_ROUNDING = 1e-15  # of the greatest position: rounding of it in an acceleration, as of a circle R - q
TOLERANCE = 1e-10  # share of the greatest acceleration that is accepted where halving helps no more
_TAIL = 3  # coefficients that must have died away
_FIRST = 12  # stretches, at least: none is wider than 30 degrees
_GAIN = 0.1  # a halving that leaves more of the last coefficients than this has come to rounding
_MOST_HALVINGS = 18
_MOST_STRETCHES = 200_000
_CLOSE = 1e-9  # rad: breaks that are closer are one


class DriveError(CamgeoError, ValueError):
    """A motion that no series follows; `at` is the shaft angle, radians, near which it does not."""

    def __init__(self, message: str, angle: float) -> None:
        super().__init__(f"{message} near {math.degrees(angle) % 360.0:.6g} degrees")
        self.at = angle


@dataclass(frozen=True, eq=False)
class Drive:
    """One motion over a turn: series of position, velocity and acceleration on m stretches, each (m, DEGREE + 1).

    `knots` (m + 1,) rise from 0 to 2 pi; `jumps` (m,) is how much the velocity leaps at the start of each stretch.
    Lengths, or angles, in the motion's unit; the derivatives by radian of shaft.
    """

    knots: Array
    position: Array
    velocity: Array
    acceleration: Array
    jumps: Array

    def __len__(self) -> int:
        return len(self.position)

    @cached_property
    def half(self) -> Array:
        """Half widths of the stretches (m,), rad."""
        return 0.5 * np.diff(self.knots)

    def find(self, phi: float) -> int:
        """Index of the stretch of a shaft angle in [0, 2 pi]; at a knot the stretch that begins there."""
        return min(max(int(np.searchsorted(self.knots, phi, side="right")) - 1, 0), len(self) - 1)

    def split(self, parts: Indices) -> Drive:
        """Cut each stretch into `parts` (m,) equal ones; a second call with the same parts gives the same drive."""
        if parts.max(initial=1) == 1:
            return self
        key = parts.tobytes()
        if key not in self._cut:
            self._cut.clear()
            self._cut[key] = self._split(parts)
        return self._cut[key]

    @cached_property
    def _cut(self) -> dict[bytes, Drive]:
        """The last drive that was cut from this one, by the bytes of its numbers of parts."""
        return {}

    def _split(self, parts: Indices) -> Drive:
        owner = np.repeat(np.arange(len(self)), parts)
        number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
        step = np.diff(self.knots)[owner] / parts[owner]
        knots = np.append(self.knots[owner] + number * step, self.knots[-1])
        whole = np.stack([self.position, self.velocity, self.acceleration])
        series = whole[:, owner]
        for count in np.unique(parts[parts > 1]).tolist():
            series[:, parts[owner] == count] = split(whole[:, parts == count], count).reshape(3, -1, DEGREE + 1)
        jumps = np.where(number == 0, self.jumps[owner], 0.0)
        return Drive(knots, series[0], series[1], series[2], jumps)

    def scaled(self, factor: float) -> Drive:
        """Give the motion with position, velocity and acceleration times a factor, such as for another unit."""
        rows = (factor * row for row in (self.position, self.velocity, self.acceleration, self.jumps))
        return Drive(self.knots, *rows)


def drives(
    motions: Sequence[Excitation], also: Sequence[float] | Array = (), tolerance: float = TOLERANCE
) -> list[Drive]:
    """Fit motions on common knots, a drive each: all their breaks, the angles `also`, rad, and halvings in between.

    Stretches are halved until the last coefficients of every acceleration are below AIM times the greatest in its
    motion, or stop falling below `tolerance` times it. Raises DriveError where they do not.
    """
    # first stretches: between the knots, none wider than a twelfth of a turn
    ends = np.concatenate([*(np.mod(motion.breaks, TURN) for motion in motions), np.mod(np.asarray(also), TURN)])
    ends = distinct(np.concatenate([[0.0, TURN], ends]))
    ends = ends[np.append(np.diff(ends) > _CLOSE, True)]
    ends[0] = 0.0
    parts = np.ceil(np.diff(ends) / (TURN / _FIRST) - 1e-9).astype(np.intp)
    low = np.concatenate([a + (b - a) / n * np.arange(n) for a, b, n in zip(ends[:-1], ends[1:], parts, strict=True)])
    width = np.repeat(np.diff(ends) / parts, parts)
    done: list[tuple[Array, list[Array]]] = []
    scale, before = np.zeros(len(motions)), np.full((len(motions), len(low)), np.inf)
    for halving in range(_MOST_HALVINGS + 1):
        series, tail = [], np.zeros((len(motions), len(low)))
        phi = low[:, None] + 0.5 * width[:, None] * (1.0 + NODES)
        for i, motion in enumerate(motions):
            rows = motion.rows(phi.ravel()).reshape(3, *phi.shape)
            size = np.abs(rows[[0, 2]]).max(axis=(1, 2), initial=0.0)
            scale[i] = max(scale[i], float(size[1]), float(size[0]) * _ROUNDING / AIM)
            series.append(fitted(rows))
            tail[i] = np.abs(series[i][2, :, -_TAIL:]).max(axis=1)
        # a stretch is done if the tail of every motion is small, or has stopped falling at rounding
        least = np.maximum(scale, np.finfo(float).tiny)[:, None]
        open_ = ((tail > AIM * least) & ((tail > tolerance * least) | (tail < _GAIN * before))).any(axis=0)
        done.append((low[~open_], [part[:, ~open_] for part in series]))
        if not open_.any():
            break
        if halving == _MOST_HALVINGS or 2 * open_.sum() + sum(len(part[0]) for part in done) > _MOST_STRETCHES:
            worst = int(np.argmax((tail / least).max(axis=0)))
            reached = float((tail / least)[:, worst].max())
            raise DriveError(
                f"the acceleration is followed within {reached:.2g} of its greatest, not better", low[worst]
            )
        width = np.repeat(0.5 * width[open_], 2)
        low, before = np.repeat(low[open_], 2), np.repeat(tail[:, open_], 2, axis=1)
        low[1::2] += width[1::2]
    knots = np.concatenate([part[0] for part in done])
    order = np.argsort(knots)
    knots = np.append(knots[order], TURN)
    values = [np.concatenate([part[1][i] for part in done], axis=1)[:, order] for i in range(len(motions))]
    pairs = zip(motions, values, strict=True)
    return [Drive(knots, s, ds, dds, _jumps(knots, ds, motion)) for motion, (s, ds, dds) in pairs]


def lowest(knots: Array, rows: Sequence[Array], figure: Callable[[Array], Array]) -> tuple[float, float]:
    """Least value over a turn of a figure of r series, to rounding, and its shaft angle, rad.

    `rows` are series (m, DEGREE + 1) on the stretches between `knots` (m + 1,); `figure` takes their values (r, n) to
    its own (n,), smooth on each stretch. At a knot the lower of both limits counts. Raises RoughError for a figure that
    no polynomials follow.
    """

    def at(stretch: Indices, phi: Array) -> Array:
        x = 2.0 * (phi - knots[stretch]) / (knots[stretch + 1] - knots[stretch]) - 1.0
        return figure(np.stack([evaluated(row, stretch, x) for row in rows]))

    def between(phi: Array) -> Array:
        return at(np.clip(np.searchsorted(knots, phi, side="right") - 1, 0, len(knots) - 2), phi)[None]

    (_, place), _ = extremes(cells(between, knots))
    # the series are nearer to the figure than the polynomials that show the place
    sides = [np.searchsorted(knots, place, side=side) - 1 for side in ("left", "right")]
    values = at(np.clip(sides, 0, len(knots) - 2), np.full(2, place))
    return float(values.min()), place


def _jumps(knots: Array, velocity: Array, motion: Excitation) -> Array:
    """Leap of the velocity at the start of each stretch (m,): 0 but at breaks of a motion that is not smooth."""
    breaks = np.sort(np.mod(motion.breaks, TURN))
    if motion.smooth or not len(breaks):
        return np.zeros(len(velocity))
    at = knots[:-1]
    after = np.searchsorted(breaks, at) % len(breaks)
    apart = np.stack([breaks[after] - at, at - breaks[after - 1]])
    apart = np.abs(apart - TURN * np.round(apart / TURN)).min(axis=0)
    leap: Array = velocity @ AT_START - np.roll(velocity.sum(axis=1), 1)
    return np.where(apart <= _CLOSE, leap, 0.0)
