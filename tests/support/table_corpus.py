"""A corpus of tables: laws at rows of any step, rounded to any digits in any unit, with noise."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.law.sources.laws import NAMES, named
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.sources.ring import Samples

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array

TURN = 2 * math.pi
LAWS = tuple(name for name in NAMES if name != "constant-velocity")  # its velocity jumps: no motion of a cam
STEPS = (1, 2, 5, 10, 15, 20)
PLACES = (0, 1, 2, 3, 4, 5)
UNITS = {"mm": 1.0, "inch": 25.4, "thou": 0.0254, "degrees": math.radians(1.0)}
STROKES = {"mm": (4.0, 40.0), "inch": (0.15, 1.5), "thou": (150.0, 1500.0), "degrees": (4.0, 30.0)}
JUMP = 1e-3  # of the greatest value of a derivative: less is no jump
LOOKS = 7200  # places of a turn at which accelerations are compared


@dataclass(frozen=True)
class Table:
    """Rise and return of a law: stroke in the table's unit, angles in degrees, rows `step` apart, with their digits.

    `noise` is in readings; of `uneven` steps each row is moved by up to a third of a step.
    """

    law: str
    stroke: float
    up: float
    top: float
    down: float
    step: int
    places: int
    unit: str
    seed: int = 0
    noise: float = 0.0
    uneven: bool = False

    @property
    def scale(self) -> float:
        """One unit of the table, in mm or rad."""
        return UNITS[self.unit]

    @property
    def reading(self) -> float:
        """Half of the last digit, in mm or rad."""
        return 0.5 * 10.0**-self.places * self.scale

    @cached_property
    def motion(self) -> Motion:
        """The law itself."""
        rest, stroke, law = 360.0 - self.up - self.top - self.down, self.stroke * self.scale, named(self.law)
        steps: list[Dwell | Move] = [Move(math.radians(self.up), law, by=stroke)]
        steps += [Dwell(math.radians(self.top))] if self.top else []
        steps += [Move(math.radians(self.down), law, by=-stroke)]
        steps += [Dwell(math.radians(rest))] if rest > 1e-9 else []
        return programme(steps, TURN)

    @cached_property
    def rows(self) -> Samples:
        """The law at each row, rounded."""
        rng = np.random.default_rng(self.seed)
        degrees = np.arange(0.0, 360.0, self.step)
        if self.uneven:
            degrees[1:] += np.round(rng.uniform(-1 / 3, 1 / 3, len(degrees) - 1) * self.step, 2)
        theta = np.radians(degrees)
        values = self.motion.derivatives(theta, 0)[0] / self.scale
        values = values + rng.uniform(-1.0, 1.0, len(values)) * self.noise * 0.5 * 10.0**-self.places
        return self.rounded(theta, values)

    def rounded(self, theta: Array, values: Array) -> Samples:
        """Displacements in the table's unit as rows of a file."""
        return Samples(theta, np.round(values, self.places) * self.scale, np.arange(len(theta)) + 1, self.scale)

    @property
    def rows_a_stroke(self) -> float:
        """Rows that the shorter stroke spans."""
        return min(self.up, self.down) / self.step

    @cached_property
    def smooth(self) -> bool:
        """Whether the acceleration of the law jumps nowhere."""
        return not self.jumps(2).size

    def jumps(self, order: int) -> Array:
        """Angles at which a derivative of the law jumps, the second or the third, as the first that does there."""
        knots = self.motion.motion.knots[:-1]
        after = self.motion.derivatives(knots, order)[order]
        before = self.motion.derivatives(np.where(knots > 0.0, knots, TURN), order, -1)[order]
        peak = np.abs(self.motion.derivatives((np.arange(LOOKS) + 0.5) * TURN / LOOKS, order)[order]).max()
        jumping: Array = knots[np.abs(after - before) > JUMP * peak]
        return jumping

    def error(self, made: Motion) -> float:
        """Rms error of the acceleration as a share of its peak, without what is within two rows of a jump."""
        off = self._off(made)
        off = off[self._far(2)]
        return float(math.sqrt((off**2).mean())) if off.size else 0.0

    def greatest(self, made: Motion) -> tuple[float, float]:
        """Greatest error of the acceleration as a share of its peak, and without two rows beside jumps of the jerk."""
        off = self._off(made)
        return float(off.max()), float(off[self._far(2) & self._far(3)].max(initial=0.0))

    def _off(self, made: Motion) -> Array:
        theta = (np.arange(LOOKS) + 0.5) * TURN / LOOKS
        true, found = (motion.derivatives(theta, 2)[2] for motion in (self.motion, made))
        off: Array = np.abs(found - true) / np.abs(true).max()
        return off

    def _far(self, order: int) -> NDArray[np.bool_]:
        """Where no jump of a derivative is within two rows."""
        theta = (np.arange(LOOKS) + 0.5) * TURN / LOOKS
        away = np.abs(np.mod(theta[:, None] - self.jumps(order) + math.pi, TURN) - math.pi)
        far: NDArray[np.bool_] = away.min(axis=1, initial=math.inf) > 2.0 * math.radians(self.step)
        return far


def tables(count: int, seed: int = 31, *, noise: float = 0.0, uneven: bool = False) -> Iterator[Table]:
    """Tables of every law, step, unit and number of decimals in turn."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        law, unit = LAWS[k % len(LAWS)], tuple(UNITS)[int(rng.integers(4))]
        step, places = STEPS[int(rng.integers(6))], PLACES[int(rng.integers(6))]
        yield drawn(rng, law, unit, step, places, noise=noise, uneven=uneven)


def drawn(
    rng: np.random.Generator, law: str, unit: str, step: int, places: int, *, noise: float = 0.0, uneven: bool = False
) -> Table:
    """One of them: strokes over 60 to 180 degrees, half of them with a dwell at the top."""
    low, high = STROKES[unit]
    stroke = round(float(rng.uniform(low, high)), 3)
    up, down = (round(float(rng.uniform(60.0, 180.0)), int(rng.integers(0, 3))) for _ in range(2))
    left = 360.0 - up - down
    top = round(float(rng.uniform(0.0, left)), 1) if rng.random() < 0.5 else 0.0
    return Table(law, stroke, up, top, down, step, places, unit, int(rng.integers(1 << 30)), noise, uneven)
