"""Rows of a drive's table, as few as hold what is asked of the motion that its controller makes of them."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.common.rounding import upward
from camgeo.files.controllers import Rows
from camgeo.formats.tables.tabled import TICKS, fewest_rows
from camgeo.recipe.machining import FINEST
from kin.law.joined_rows import RATES, JoinedRows, errors, peaks
from kin.numeric.angles import TURN
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.files.controllers import Controller
    from kin.law.joined_rows import Errors, Off
    from kin.numeric.arrays import Array

NOTHING = 1e-13  # of the greatest value: rounding about 0
RATE_NAMES = ("velocity", "acceleration")
RATE_OPTIONS = ("velocity_error", "acceleration_error")
"""Options of a file: greatest errors of the first and the second derivative, percent of their greatest values."""


class RowsError(CamgeoError):
    """Rows that do not hold what is asked; `option` is what asks for them: a file's option, or the tolerance."""

    def __init__(self, option: str, problem: str, value: str | None, remedy: str) -> None:
        super().__init__(problem)
        self.option, self.problem, self.value, self.remedy = option, problem, value, remedy


@dataclass(frozen=True, eq=False)
class Slave:
    """A slave's motion over a turn of its master, mm or rad, and the unit of its file.

    `rows` gives position and derivatives (order + 1, n) at angles (n,), rad, those that follow at a break; `turn` gives
    them at rising angles up to a turn, at the last those before it. `base` is the position at which the slave is 0.
    `breaks`, rad, are where segments and parts of laws join. `unit` is mm, in or deg, `scale` that in mm or rad.
    `title` is the first line of the table's head, behind a recipe's name.
    """

    title: str
    rows: Callable[[Array, int], Array]
    turn: Callable[[Array, int], Array]
    breaks: list[float]
    base: float
    unit: str
    scale: float

    def above(self, angle: Array, order: int) -> Array:
        """Position above the base, mm or rad, and derivatives by rad (order + 1, n), at angles (n,)."""
        rows = np.array(self.rows(angle, order))
        rows[0] -= self.base
        return rows


class Wanted(NamedTuple):
    """Demands on a table: greatest error of the position, mm or rad, and of rates as shares of their peaks.

    `step` is the step between rows, rad, None for the fewest rows; with `joints` there are rows at all breaks.
    """

    most: float
    rates: tuple[float | None, float | None] = (None, None)
    step: float | None = None
    joints: bool = False


class Demand(NamedTuple):
    """One thing that rows are to hold: the option that asks for it, what was reached and what is allowed, in `unit`."""

    option: str
    reached: float
    allowed: float
    unit: str

    @property
    def share(self) -> float:
        """Error reached, as a share of the permitted one."""
        return self.reached / self.allowed if self.allowed else math.inf * self.reached

    def told(self) -> str:
        """Words on what is left."""
        if self.unit == "%":
            word = RATE_NAMES[RATE_OPTIONS.index(self.option)]
            return f"{self.reached:.4g} % of the greatest {word}"
        return f"{self.reached:.4g} {self.unit}"


def finest(most: int) -> float:
    """Least step, degrees, that divides a turn into fewer than `most` parts: whole 1/10000 degrees from `FINEST` on."""
    whole = 360 * TICKS
    least = round(FINEST * TICKS)
    return next(tick for tick in range(least, whole + 1) if whole % tick == 0 and whole // tick < most) / TICKS


@dataclass(frozen=True, eq=False)
class DriveRows:
    """Choice of rows of a slave's motion for a controller."""

    slave: Slave
    controller: Controller
    wanted: Wanted

    def rows(self, degrees: Array) -> Rows:
        """Rows at angles of the master (n,), degrees, rounded as the controller keeps them."""
        degrees = self.controller.rounded(degrees)
        values = self.slave.turn(_radians(degrees), self.controller.order)
        values[0] -= self.slave.base
        values *= (math.radians(1.0) ** np.arange(len(values)))[:, None] / self.slave.scale
        values[np.abs(values) < NOTHING * np.abs(values).max(axis=1, keepdims=True)] = 0.0
        return Rows(degrees, self.controller.rounded(values), self.slave.unit, self._ends)

    @cached_property
    def _ends(self) -> tuple[float, float]:
        """Slopes at both ends, in the file's unit by degree, for a spline."""
        slopes = self.slave.turn(np.array([0.0, TURN]), 1)[1] * math.radians(1.0) / self.slave.scale
        first, last = self.controller.rounded(slopes).tolist()
        return first, last

    def joined(self, rows: Rows) -> JoinedRows:
        """Rows as the controller joins them, mm or rad."""
        kept = rows.slave[: 1 + RATES[self.controller.join]]
        degree, scale = math.degrees(1.0), self.slave.scale
        values = kept * scale * (degree ** np.arange(len(kept)))[:, None]
        first, last = (slope * scale * degree for slope in rows.ends)
        return JoinedRows(_radians(rows.degrees), values, self.controller.join, (first, last))

    def errors(self, rows: Rows) -> Errors:
        """Greatest error of the joined rows against the motion, mm or rad."""
        return errors(self.joined(rows), self.slave.above, self.slave.breaks)

    @cached_property
    def peaks(self) -> tuple[float, ...]:
        """Greatest |derivatives| of the motion that a limit is given for, from the first on."""
        order = max((i for i, most in enumerate(self.wanted.rates, 1) if most is not None), default=0)
        return peaks(self.slave.above, TURN, self.slave.breaks, order) if order else ()

    def worst(self, degrees: Array) -> Demand:
        """What rows at these angles hold least of what is asked."""
        off = self.joined(self.rows(degrees)).off(self.slave.above, self.slave.breaks, len(self.peaks))
        return self._least_held(off, self.peaks)

    def _may(self, degrees: Array) -> bool:
        """Whether rows at these angles hold what is asked at some places between them; if not, they do not hold it."""
        off = self.joined(self.rows(degrees)).off_at_some(self.slave.above, self.slave.breaks, len(self.peaks))
        return self._least_held(off, self.peaks).share <= 1.0

    def _holds(self, degrees: Array) -> bool:
        """Whether rows at these angles hold what is asked."""
        return self._may(degrees) and self.worst(degrees).share <= 1.0

    def _least_held(self, off: Sequence[Off], peaks: Sequence[float]) -> Demand:
        scale = self.slave.scale
        demands = [Demand("tolerance", off[0].value / scale, self.wanted.most / scale, self.slave.unit)]
        for option, most, found, peak in zip(RATE_OPTIONS, self.wanted.rates, off[1:], peaks, strict=False):
            if most is not None:
                share = found.value / peak if peak else 0.0
                demands.append(Demand(option, 100.0 * share, 100.0 * most, "%"))
        return max(demands, key=lambda demand: demand.share)

    # --- the choice ---------------------------------------------------------------------------------------------------

    def chosen(self) -> tuple[Rows, Errors]:
        """Rows at the step that is asked for, or the fewest that hold what is asked, and what they miss of the motion.

        With rows at the joints each part between two of them has equal steps. Raises RowsError where such rows hold
        less, or the controller takes too few; RoughError for a motion too abrupt to be followed.
        """
        self._demand_joined()
        return self._at_joints() if self.wanted.joints else self._even()

    def _demand_joined(self) -> None:
        """Raise RowsError where a limited derivative jumps by more than twice its limit.

        Joined rows have one value there, at a row or beside it, so that they miss half the jump or more.
        """
        for order, peak in enumerate(self.peaks, 1):
            share = self.wanted.rates[order - 1]
            for at in self.slave.breaks if share is not None else ():
                before = self.slave.turn(np.array([0.0, at]), order)[order, -1]
                jump = abs(float(self.slave.rows(np.array([at]), order)[order, 0] - before))
                if share is not None and 0.0 < at < TURN and jump > 2.0 * share * peak:
                    name = RATE_NAMES[order - 1]
                    problem = f"the {name} jumps at {math.degrees(at):.9g} degrees, where a row has one value of it"
                    remedy = f"leave it out, or give laws whose {name} joins"
                    raise RowsError(RATE_OPTIONS[order - 1], problem, None, remedy)

    def _even(self) -> tuple[Rows, Errors]:
        most, step = self.controller.most, self.wanted.step
        least = finest(most)
        if step is not None:
            rows, found, worst = self._at(_even_degrees(round(TURN / step)))
            if worst.share <= 1.0:
                return rows, found
            raise self._step_error(worst, self._fewest(least))
        fewest = self._fewest(least)
        if fewest is None:
            worst = self.worst(_even_degrees(round(360.0 / least)))
            raise self._too_few(worst, f"rows {least:g} degrees apart")
        return self._at(_even_degrees(fewest))[:2]

    def _fewest(self, least: float) -> int | None:
        """Fewest equal steps, down to `least` degrees, that hold what is asked; None where none do."""
        return fewest_rows(
            lambda count: self.worst(_even_degrees(count)).share <= 1.0,
            least,
            lambda count: self._may(_even_degrees(count)),
        )

    def _at(self, degrees: Array) -> tuple[Rows, Errors, Demand]:
        """Rows at these angles, what they miss of the motion, and what they hold least."""
        rows = self.rows(degrees)
        found = self.errors(rows)
        return rows, found, self._least_held(found.off, found.peaks)

    def _step_error(self, worst: Demand, fewest: int | None) -> RowsError:
        problem = f"joined as the controller joins them rows so far apart leave {worst.told()}"
        remedy = "" if fewest is None else f"give {360.0 / fewest:g} or less, or "
        step = self.wanted.step or TURN
        return RowsError("step", problem, f"{math.degrees(step):.9g} degrees", f"{remedy}{_allowance(worst)}")

    def _too_few(self, worst: Demand, rows: str) -> RowsError:
        problem = f"joined as the controller joins them {rows} leave {worst.told()}"
        remedy = f"give at least {upward(worst.reached)}{'' if worst.unit == '%' else f' {worst.unit}'}"
        return RowsError(worst.option, problem, None, remedy)

    @cached_property
    def _joints(self) -> Array:
        """Angles between which steps are equal, degrees: both ends and all breaks."""
        inner = self.controller.rounded(np.degrees(np.array(sorted(self.slave.breaks))))
        return np.unique(np.concatenate([[0.0], inner[(inner > 0.0) & (inner < 360.0)], [360.0]]))

    def _at_joints(self) -> tuple[Rows, Errors]:
        step, most = self.wanted.step, self.controller.most
        if step is not None:
            even = self.controller.rounded(_even_degrees(round(TURN / step)))
            degrees = np.unique(np.concatenate([even, self._joints]))
            if len(degrees) > most:
                remedy = f"give joints: false, or a step with at most {most} rows"
                raise RowsError("step", f"{len(degrees)} rows with those at the joints", None, remedy)
            rows, found, worst = self._at(degrees)
            if worst.share <= 1.0:
                return rows, found
            raise self._step_error(worst, None)
        counts = self._least_alike()
        if self.controller.join != "cubic":  # whose parts lean on one another
            counts = [self._least_part(k, count) for k, count in enumerate(counts)]
        return self._at(self._parted(counts))[:2]

    def _parted(self, counts: Sequence[int]) -> Array:
        ends = self._joints
        parts = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(ends[:-1], ends[1:], counts, strict=True)]
        return np.concatenate([*parts, ends[-1:]])

    def _alike(self, steps: int) -> list[int]:
        """Numbers of steps of the parts where none is longer than a turn divided by `steps`."""
        least = 2 if len(self._joints) == 2 else 1  # three rows at the least
        return [max(math.ceil(width * steps / 360.0 - 1e-9), least) for width in np.diff(self._joints).tolist()]

    def _least_alike(self) -> list[int]:
        """Numbers of steps of the parts, about equal ones and as few as hold what is asked."""
        high = 1
        while not self._holds(self._parted(self._alike(high))):
            high *= 2
            if sum(self._alike(high)) >= self.controller.most:
                finest = self._parted(self._alike(high // 2))
                raise self._too_few(self.worst(finest), f"{len(finest)} rows, those at the joints among them,")
        low = high // 2 + 1
        while low < high:
            middle = (low + high) // 2
            fits = self._holds(self._parted(self._alike(middle)))
            low, high = (low, middle) if fits else (middle + 1, high)
        return self._alike(high)

    def _least_part(self, part: int, count: int) -> int:
        """Least number of steps of one part that holds what is asked there, not above `count`, which does."""
        begin, end = self._joints[part : part + 2].tolist()
        low, high = self._alike(1)[part], count
        while low < high:
            middle = (low + high) // 2
            fits = self._holds(np.linspace(begin, end, middle + 1))
            low, high = (low, middle) if fits else (middle + 1, high)
        return high


def _even_degrees(count: int) -> Array:
    return np.linspace(0.0, 360.0, count + 1)


def _radians(degrees: Array) -> Array:
    """Angles, rad, of which 360 degrees are a turn exactly."""
    angle = np.radians(degrees)
    angle[degrees == 360.0] = TURN
    return angle


def _allowance(worst: Demand) -> str:
    if worst.unit == "%":
        return f"{worst.option}: {upward(worst.reached)}"
    return f"a tolerance of {upward(worst.reached)} {worst.unit}"


def error_lines(found: Errors, slave: Slave) -> tuple[str, ...]:
    """Lines of a table's head on what its joined rows miss of the motion."""
    unit, degree = slave.unit, math.radians(1.0)
    lines = [f"so joined it is within {upward(found.off[0].value / slave.scale, 6)} {unit} of the motion, proved"]
    for order, name in enumerate(RATE_NAMES[: len(found.peaks)], 1):
        value = found.off[order].value * degree**order / slave.scale
        per = f"{unit}/deg{f'^{order}' if order > 1 else ''}"
        share = found.share(found.off[order].value, order)
        lines.append(f"its {name} within {upward(value)} {per}, {share}")
    if found.step is not None:
        step = found.step.value * degree / slave.scale
        share = found.share(found.step.value, 1)
        lines.append(f"its velocity steps at rows, by up to {upward(step)} {unit}/deg, {share}")
    return tuple(lines)
