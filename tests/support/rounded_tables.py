"""Tables of known laws, rounded to their own last digit, and spoilt ones whose line is known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kin.law.sources.laws import NAMES, named
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.sources.ring import Samples

if TYPE_CHECKING:
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array

TURN = 2 * math.pi
LAWS = tuple(name for name in NAMES if name != "constant-velocity")  # its velocity jumps: no motion of a cam
KINDS = ("row", "small", "step", "swap", "digit", "stuck")


@dataclass(frozen=True)
class Shape:
    """Rise and return of two laws: stroke in the table's unit, angles in degrees, rows `step` apart."""

    rise: str
    fall: str
    stroke: float
    up: float
    top: float
    down: float
    step: int
    places: int
    unit: str  # mm, or degrees

    @property
    def scale(self) -> float:
        """One unit of the table, in mm or rad."""
        return 1.0 if self.unit == "mm" else math.radians(1.0)

    @property
    def reading(self) -> float:
        """Half of the last digit, in mm or rad."""
        return 0.5 * 10.0**-self.places * self.scale

    def motion(self) -> Motion:
        """The law itself."""
        rest = 360.0 - self.up - self.top - self.down
        stroke = self.stroke * self.scale
        steps: list[Dwell | Move] = [Move(math.radians(self.up), named(self.rise), by=stroke)]
        steps += [Dwell(math.radians(self.top))] if self.top else []
        steps += [Move(math.radians(self.down), named(self.fall), by=-stroke)]
        steps += [Dwell(math.radians(rest))] if rest > 1e-9 else []
        return programme(steps, TURN)

    def rows(self) -> Samples:
        """The law at each row, rounded."""
        theta = np.radians(np.arange(0.0, 360.0, self.step))
        return self.rounded(theta, self.motion().derivatives(theta, 0)[0] / self.scale)

    def rounded(self, theta: Array, values: Array) -> Samples:
        """Displacements in the table's unit as rows of a file."""
        return Samples(theta, np.round(values, self.places) * self.scale, np.arange(len(theta)) + 1, self.scale)


def sound_shapes(count: int, seed: int = 19) -> list[Shape]:
    """Shapes of every law in turn: with and without dwells, rows each 1 or 2 degrees, 2 to 4 decimals, both units."""
    rng, shapes = np.random.default_rng(seed), []
    for k in range(count):
        rise = LAWS[k % len(LAWS)]
        fall = rise if rng.random() < 0.5 else LAWS[int(rng.integers(len(LAWS)))]
        if rng.random() < 0.4:  # without a dwell
            up, digits = float(rng.uniform(100, 260)), int(rng.integers(0, 3))
            up = round(up, digits)
            top, down = 0.0, 360.0 - up
        else:
            digits = int(rng.integers(0, 3))
            up, top, down = (round(float(rng.uniform(a, b)), digits) for a, b in ((60, 140), (15, 60), (60, 140)))
        stroke = round(float(rng.uniform(4, 40)), 3)
        step, places = int(rng.integers(1, 3)), int(rng.integers(2, 5))
        shapes.append(Shape(rise, fall, stroke, up, top, down, step, places, "mm" if rng.random() < 0.7 else "degrees"))
    return shapes


@dataclass(frozen=True)
class Spoilt:
    """A spoilt table: lines that may be named."""

    kind: str
    shape: Shape
    rows: Samples
    lines: frozenset[int]


def spoilt(shape: Shape, kind: str, seed: int) -> Spoilt:
    """A sound table with one fault well away from the others' reach: what lines name it."""
    rng, rows, motion = np.random.default_rng(seed), shape.rows(), shape.motion()
    s, reading, count = rows.s.copy(), shape.reading, len(rows.s)
    speed = np.abs(motion.derivatives(rows.theta, 1)[1])
    moving = np.flatnonzero(speed > 0.3 * speed.max())  # on a flank
    i = int(rng.choice(moving[(moving > 2) & (moving < count - 3)]))
    lines = {i + 1}
    if kind == "row":
        s[i] += 20 * reading * rng.choice([-1.0, 1.0])
    elif kind == "small":
        s[i] += 8 * reading * rng.choice([-1.0, 1.0])
    elif kind == "step":
        last = min(count - 3, i + count // 5)
        s[i:last] += 60 * reading
        lines = {i + 1, last + 1}
    elif kind == "swap":
        s[[i, i + 1]] = s[[i + 1, i]]
        lines = {i + 1, i + 2}
    elif kind == "digit":
        s[i] += 2000 * reading
    elif kind == "stuck":  # the row before, once more
        s[i] = s[i - 1]
    return Spoilt(kind, shape, rows._replace(s=s), frozenset(lines))


def spoilt_tables(count: int, seed: int = 20) -> list[Spoilt]:
    """Each kind in turn, each in a table of its own."""
    return [spoilt(shape, KINDS[k % len(KINDS)], seed + k) for k, shape in enumerate(sound_shapes(count, seed))]
