"""The exact motion of an axis over a turn of its master, and its figures in time."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.axis.keys import ADVANCE, FIGURES
from camgeo.checks.declared import LIMIT
from camgeo.common.rounding import downward
from camgeo.formats.tables.drive_rows import Slave
from camgeo.measures.units import report_unit
from kin.judge.drive import Driven
from kin.law.joints import ORDERS, joints_of
from kin.law.normalised import IntentError
from kin.law.sources.peaks import extremes
from kin.numeric.angles import TURN
from kin.numeric.angles import degrees as in_degrees
from kin.numeric.check import Check
from kin.numeric.lengths import in_unit
from kin.numeric.quadrature import gauss
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.axis.keys import AxisRecipe
    from camgeo.common.clock import Clock
    from camgeo.recipe.export import FileRequest
    from kin.law.contacts import Unit
    from kin.law.joints import DerivativeJump
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array

MOST_CYCLES = 10_000  # after which an axis is taken never to come back to its place
SAME = 1e-9  # of the modulo: two places so near are one
ROUNDING = 1e-9  # share of a limit by which a figure that just reaches it may miss it
NODES, PARTS = 12, 8  # of Gauss's rule, on each of so many parts of a stretch, for the mean square


class Figure(NamedTuple):
    """A figure: its value in mm or degrees and seconds, its unit, and the master's angle of its place, degrees."""

    name: str
    value: float
    unit: str
    at: float | None = None


@dataclass(frozen=True, eq=False)
class AxisDesign:
    """An axis before any file: its recipe, and its motion over a turn of the master, mm or rad."""

    recipe: AxisRecipe
    motion: Motion

    @property
    def unit(self) -> Unit:
        """Unit of displacements, mm or deg."""
        return "deg" if self.recipe.swings else "mm"

    @property
    def own(self) -> float:
        """Length of that unit: 1 mm, or a degree in rad."""
        return math.radians(1.0) if self.recipe.swings else 1.0

    @property
    def speed(self) -> float:
        """Speed of the master, rad/s."""
        return TURN / self.recipe.cycle

    @property
    def advance(self) -> float:
        """Displacement of a cycle from its beginning to its end, mm or rad."""
        return float(self.motion.at_end(0)[0] - self.motion.at_start(0)[0])

    def rows(self, angle: Array, order: int) -> Array:
        """Position, mm or rad, and derivatives by the master's angle (order + 1, n), at angles (n,), rad."""
        return self.motion.derivatives(angle, order)

    def turn(self, angle: Array, order: int) -> Array:
        """As `rows`, at rising angles of which the last may be a turn: there the derivatives are those before it."""
        side = np.ones(len(angle), dtype=int)
        side[-1] = -1
        return self.motion.derivatives(angle, order, side)

    def in_time(self, angle: Array, order: int) -> Array:
        """Position and derivatives by time (order + 1, n), in the recipe's unit or degrees, and seconds."""
        scale, _ = report_unit(self.recipe, self.unit)
        rows: Array = self.turn(angle, order) * scale * (self.speed ** np.arange(order + 1.0))[:, None]
        return rows

    @cached_property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Angles at which derivatives jump, the seam of an index among them, whose position goes on."""
        if not self.recipe.index:
            return self.motion.joints
        before, after = self.motion.at_end(ORDERS), self.motion.at_start(ORDERS)
        before[0] = after[0]
        knots = self.motion.motion.knots
        size = np.abs(self.motion.derivatives(np.linspace(knots[0], knots[-1], 257), ORDERS)).max(axis=1)
        return (*joints_of([(0.0, before, after)], size), *self.motion.joints)

    # --- what a drive is to do ----------------------------------------------------------------------------------------

    def slave(self, request: FileRequest) -> Slave:
        """The slave of a table, in the unit of its file."""
        inch = request.unit_for(self.recipe.units) == "inch"
        unit, scale = ("deg", self.own) if self.recipe.swings else ("in", 25.4) if inch else ("mm", 1.0)
        at = "the cycle begins" if self.recipe.index else "the axis is lowest"
        title = f"one turn of the master in {self.recipe.cycle:.9g} s; the slave is 0 where {at}"
        return Slave(title, self.rows, self.turn, self.motion.breaks.tolist(), 0.0, unit, scale)

    def driven(self, most: float, rates: tuple[float | None, float | None] = (None, None)) -> Driven:
        """Motion that a drive is held to, in time: errors up to `most`, mm or rad, rates to shares of their peaks."""
        return Driven(self.motion, self.unit, 0.0, most / self.own, rates, math.degrees(self.speed))

    # --- figures ------------------------------------------------------------------------------------------------------

    @cached_property
    def figures(self) -> tuple[Figure, ...]:
        """All figures, in the order of reports."""
        low, high = self.motion.range
        figures = [Figure("cycle", self.recipe.cycle, "s"), Figure("stroke", (high - low) / self.own, self.unit)]
        if self.recipe.index:
            figures.append(Figure(ADVANCE, self.advance / self.own, self.unit))
        if self.cycles is not None:
            figures.append(Figure("cycles", float(self.cycles), ""))
        figures += [self._greatest(name, order) for name, order in FIGURES.items()]
        figures.insert(-1, Figure("rms-acceleration", self._rms(), f"{self.unit}/s^2"))
        return tuple(figures)

    @cached_property
    def cycles(self) -> int | None:
        """Cycles after which an index with a modulo is in its place again; None where it never is, or is at once."""
        if self.recipe.modulo is None or not self.recipe.index or not self.advance:
            return None
        share = self.advance / self.recipe.modulo
        nearest = Fraction(share).limit_denominator(MOST_CYCLES)
        return nearest.denominator if abs(share - nearest) <= SAME / nearest.denominator else None

    def _greatest(self, name: str, order: int) -> Figure:
        """Greatest magnitude of a derivative in time; a jerk is infinite where the acceleration jumps."""
        unit = f"{self.unit}/s{'' if order == 1 else f'^{order}'}"
        jump = next((joint for joint in self.joints for k, _, _ in joint.jumps if k == order - 1), None)
        if jump is not None:
            return Figure(name, math.inf, unit, in_degrees(jump.at))
        least, low, greatest, high = extremes(self.motion.motion, order)
        value, at = max((abs(least), low), (abs(greatest), high))
        return Figure(name, value * self.speed**order / self.own, unit, in_degrees(at))

    def _rms(self) -> float:
        """Root of the mean square of the acceleration, mm or degrees by second squared."""
        nodes, weights = gauss(NODES)
        total = 0.0
        for begin, end in pairwise(self.motion.motion.knots.tolist()):
            edges = np.linspace(begin, end, PARTS + 1)
            half = 0.5 * np.diff(edges)[:, None]
            at = (edges[:-1, None] + half * (1.0 + nodes)).ravel()
            total += float(self.motion.derivatives(at, 2)[2] ** 2 @ (half * weights).ravel())
        return math.sqrt(total / TURN) * self.speed**2 / self.own

    def limit_checks(self) -> list[Check]:
        """Checks of the figures that the recipe limits."""
        known = {figure.name: figure for figure in self.figures}
        checks = []
        for bound in self.recipe.limits:
            figure, limit = known[bound.figure], bound.at_most / self.own
            ok, finite = figure.value <= limit * (1.0 + ROUNDING), math.isfinite(figure.value)
            detail = "" if finite else "the acceleration jumps"
            value = figure.value if finite else None
            checks.append(Check(LIMIT + bound.figure, ok, value, limit, figure.unit, figure.at, detail=detail))
        return checks


def designed(recipe: AxisRecipe, clock: Clock) -> AxisDesign:
    """The exact motion of a recipe; raises RecipeErrors where there is none, or its velocity jumps."""
    with clock.stage("motion"):
        try:
            motion = recipe.motion.motion(TURN, "axis.motion", None if recipe.index else 1)
            design = AxisDesign(recipe, motion)
            motion.demand_joined("axis.motion", "rad" if recipe.swings else "mm")
        except IntentError as error:
            remedy = _index_remedy(recipe, error.message)
            raise recipe.error(_stated(recipe, error.field), _words(recipe, error.message) + remedy) from error
    _demand_seam(design)
    return design


def _index_remedy(recipe: AxisRecipe, message: str) -> str:
    ends = "let the motion end where it begins" in message
    return ", or give index: true, so that the next cycle goes on from there" if ends and not recipe.index else ""


def _words(recipe: AxisRecipe, words: str) -> str:
    return in_unit(words, recipe.mm, "in" if recipe.units == "inch" else "mm")


def _stated(recipe: AxisRecipe, field: str) -> str:
    """A field, or the nearest one above it that the recipe gives."""
    while field and field not in recipe.marks:
        field = field.rpartition("[" if field.endswith("]") else ".")[0]
    return field or "axis"


def _demand_seam(design: AxisDesign) -> None:
    """Raise RecipeErrors where the velocity jumps from one cycle of an index to the next."""
    if not design.recipe.index:
        return
    for joint in design.joints:
        for order, before, after in joint.jumps:
            if order == 1 and joint.at == 0.0:
                scale, unit = report_unit(design.recipe, design.unit)
                speeds = [f"{value * scale * design.speed:.6g}" for value in (before, after)]
                problem = f"the velocity jumps from {speeds[0]} to {speeds[1]} {unit}/s where the next cycle begins"
                remedy = "let both ends meet at one velocity, as laws from rest to rest do"
                raise design.recipe.error("axis.motion", problem, None, remedy)


def rpm_for(recipe: AxisRecipe, name: str, value: float, limit: float) -> str:
    """Text of the greatest speed of the master at which a figure keeps its limit."""
    order = FIGURES[name]
    return downward(recipe.rpm * (limit / value) ** (1.0 / order))
