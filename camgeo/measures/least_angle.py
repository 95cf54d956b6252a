"""The least angle of a segment that all limits of a recipe allow, in place of `over: least`.

An angle holds if every check of a run's design passes, so no figure need be monotone in the angle. Angles are tried on
a ladder that reaches up to all that the other segments leave; between the first that holds and the rung below it they
are halved to a step of 1/`STEPS` degrees. So the result holds, one step less does not, and every shorter rung fails. A
stretch of shorter angles that holds and lies between two rungs, a ratio `RATIO` apart, may be missed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.checks.declared import PRESSURE
from camgeo.common.clock import Clock
from camgeo.measures.extension import MEASURES
from camgeo.measures.figures import ORDERS
from camgeo.measures.limits import limit_checks
from camgeo.motions.segments import LEAST, REST
from camgeo.recipe.figures import FIGURES, ON_RETURN, ON_RISE
from camgeo.recipe.recipe import Angle, ChosenAngles
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.checks import motion_checks
from camgeo.synthesis.design import Design, designed
from kin.law.normalised import IntentError
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.measures.measured import Measured
    from camgeo.motions.motion import Open
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.check import Check

STEPS = 100  # of a degree: every angle that is tried is a whole number of them
RATIO = 1.2  # of neighbours on the ladder, whose lowest rung is above a degree
OF_MOTION = frozenset({*ORDERS, PRESSURE.name, ON_RISE, ON_RETURN})
"""Figures of the exact cam that need no undercut, whose search takes ten times as long."""


@dataclass(frozen=True)
class _Search:
    """Checks and errors that fail at the angles tried so far, by the angle in steps."""

    recipe: Recipe
    segments: Open
    failing: dict[int, tuple[Check, ...]] = field(default_factory=dict)
    errors: dict[int, RecipeErrors] = field(default_factory=dict)

    def recipe_at(self, steps: int) -> Recipe:
        """The recipe with the open angle set to `steps` steps, and the dwell to the rest."""
        motion, _ = self.segments.with_least(steps / STEPS)
        return replace(self.recipe, cam=self.recipe.cam.with_motion(motion))

    def holds(self, steps: int) -> bool:
        """Whether there is a design at an angle, in steps, and all its checks hold."""
        if steps not in self.failing and steps not in self.errors:
            try:
                self.failing[steps] = tuple(check for check in _checks(self.recipe_at(steps)) if not check.ok)
            except RecipeErrors as errors:
                self.errors[steps] = errors
        return steps not in self.errors and not self.failing[steps]

    def reasons(self, steps: int) -> tuple[str, ...]:
        """Names of the checks that fail at an angle, in steps, or why it gives no cam; empty for an untried angle."""
        if steps in self.errors:
            return tuple(error.problem for error in self.errors[steps].errors)
        return tuple(dict.fromkeys(check.name for check in self.failing.get(steps, ())))


def with_least_angle(recipe: Recipe) -> Recipe:
    """The recipe with the least angle that its limits allow; the recipe itself where no angle is open.

    Raises RecipeErrors where no tried angle holds, and for a limit of files, as no file is written here.
    """
    # a ladder of angles, RATIO apart, then bisection between the least that holds and the one below it
    angles = recipe.cam.open
    if angles is None:
        return recipe
    for limit in recipe.limits:
        if FIGURES[limit.figure].of == "file":
            problem = f"of files, and none is made of the angles that are tried for over: {LEAST}"
            raise recipe.error(f"limits.{limit.figure}", problem, None, "leave it out, or give the angle")
    search = _Search(recipe, angles)
    least, rest = angles.index(LEAST), angles.index(REST)
    path = f"cam.motion{'.segments' if 'cam.motion.segments' in recipe.marks else ''}"
    longest = math.ceil(angles.remaining * STEPS - 1e-6) - 1  # the dwell takes the last step
    rungs = [longest]
    while (shorter := int(rungs[0] / RATIO)) >= STEPS:
        rungs.insert(0, shorter)
    holding = [rung for rung in rungs if search.holds(rung)]
    if not holding:
        raise _refusal(search, longest, f"{path}[{least}].over")
    high = holding[0]
    low = max((rung for rung in rungs if rung < high), default=0)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if search.holds(middle) else (middle, high)
    motion, dwell = angles.with_least(high / STEPS)
    choice = ChosenAngles(
        angles.motion.segments[least].kind,
        Angle(f"{path}[{least}].over", high / STEPS),
        Angle(f"{path}[{rest}].dwell", dwell),
        search.reasons(low),
        tuple(rung / STEPS for rung in rungs if rung > high and not search.holds(rung)),
    )
    return replace(recipe, cam=recipe.cam.with_motion(motion), settled=choice)


def _refusal(search: _Search, longest: int, path: str) -> RecipeErrors:
    """Error where no tried angle holds: the first check that fails at the longest angle."""
    if longest in search.errors:
        return search.errors[longest]
    check, angle = search.failing[longest][0], f"{longest / STEPS:.10g} degrees"
    recipe = search.recipe
    factor = recipe.mm if check.unit == "mm" else 1.0
    unit = recipe.units if check.unit == "mm" else check.unit
    sense = "at least" if check.sense == "at_least" else "at most"
    reached = "cannot be had" if check.value is None else f"is {check.value / factor:.6g} {unit}".rstrip()
    bound = "" if check.limit is None else f", {sense} {check.limit / factor:.6g}"
    return recipe.error(
        path, f"even over {angle} {check.name} {reached}{bound}", LEAST, check.detail or "let the limit be wider"
    )


def _checks(recipe: Recipe) -> Sequence[Check]:
    """Checks of a design that need no file; where a limit of its motion fails, only the checks of such limits.

    Raises RecipeErrors where there is no such motion or curve.
    """
    limits = tuple(limit for limit in recipe.limits if limit.figure in OF_MOTION)
    if limits:
        try:
            exact = recipe.cam.exact()
            design = Design(exact, (), tuple(motion_checks(exact)))
        except IntentError as error:
            raise recipe.error(f"cam.{error.field}", error.message) from error
        checks = limit_checks(replace(recipe, limits=limits), design, design.checks, (), {})
        if not all(check.ok for check in checks):
            return checks
    design = designed(recipe)
    checks = list(design.checks)
    runs: dict[str, Mapping[str | None, Measured]] = {}
    if all(check.ok for check in checks):  # runs take the most time
        owners = {FIGURES.owner(limit.figure) for limit in recipe.limits if FIGURES[limit.figure].of == "run"}
        for answers in MEASURES.of(owners):
            results = answers.examine(recipe, design, (), Clock())
            checks += results.checks
            runs |= results.runs
    return [*checks, *limit_checks(recipe, design, checks, (), runs)]
