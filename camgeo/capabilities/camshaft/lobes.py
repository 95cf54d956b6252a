"""The lobes of a camshaft as exact cams, and the angles at which they stand on the shaft."""

from __future__ import annotations

import math
from itertools import pairwise
from operator import itemgetter
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.camshaft.events import event, stretches, valves_of
from camgeo.capabilities.camshaft.keys import ROUNDING, of_a_lobe
from camgeo.curve.measures import nearest
from camgeo.measures.limits import limit_checks
from camgeo.measures.lobe import moved_by
from camgeo.measures.rule_remark import RuleRemark
from camgeo.part.part import THINNEST
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.shaft_cam import ShaftCam
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.capabilities.camshaft.events import Event, Stretch, Valves
    from camgeo.capabilities.camshaft.keys import Bar, CamshaftRecipe, Engine, Lobe
    from camgeo.common.clock import Clock
    from camgeo.curve.curve import Curve
    from camgeo.measures.extension import MovedBody
    from camgeo.synthesis.design import Design
    from camgeo.synthesis.expected_checks import Foreseen
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check

STROKE_STEPS = 3600  # of a turn, over which the ends of a stroke are looked for


@dataclass(frozen=True)
class PlacedLobe:
    """A lobe, its exact design, and the angle `at`, rad, by which its metal is turned.

    The angle is counter-clockwise in a drawing for the rotation `cw`. `events` are computed so far, by lift.
    """

    lobe: Lobe
    design: Design
    at: float
    events: dict[float, Event | None] = field(default_factory=dict, repr=False, compare=False)

    @property
    def zero(self) -> float:
        """Shaft angle, rad, at which its motion begins: the angle of its metal less the direction of its follower."""
        return self.at - self.lobe.direction

    def on_shaft(self, engine: Engine | None) -> ShaftCam:
        """Lobe as a ShaftCam for capabilities that judge files.

        Its event lift is None without an engine, where its follower swings, and where the engine's lift is the valve's
        and it has none. Where the engine's lift is the valve's, raises RecipeErrors and EventError as `moved` does.
        """
        lobe, stated = self.lobe, self._stated_lift(engine)
        return ShaftCam(lobe.name, lobe.recipe, self.design, self.at, self.zero, lobe.low, lobe.high, stated)

    @property
    def contour(self) -> Curve | None:
        """The contour to be made, before it is turned; None where a check forbids it."""
        return self.design.only_surface.contour

    def event(self, lift: float) -> Event | None:
        """Event of the lobe at a lift of its follower, mm or rad.

        None where that is not one stretch of a turn, or the motion is too rough to tell.
        """
        if lift not in self.events:
            self.events[lift] = event(self.design.exact, self.zero, lift)
        return self.events[lift]

    @property
    def moved(self) -> MovedBody | None:
        """Motion of the part that the follower drives, such as a valve; None where the recipe names none.

        Raises RecipeErrors where the follower cannot drive it, as by a table of ratios that ends below its lift,
        EventError where its motion is too rough to tell.
        """
        return moved_by(self.lobe.recipe, self.design)

    @property
    def swings(self) -> bool:
        """Whether the lobe's follower swings, so that its lifts are angles."""
        return self.lobe.recipe.cam.arrangement.unit == "deg"

    def event_lift(self, engine: Engine | None) -> float:
        """Lift of the lobe's follower, mm or rad, at which its events are stated.

        It is the engine's lift, converted to the follower where it is a valve's lift. Without an engine, for a follower
        that swings, and without a valve where the lift is a valve's, it is the middle of the stroke. Where the engine's
        lift is the valve's, raises RecipeErrors and EventError as `moved` does.
        """
        stated = self._stated_lift(engine)
        if stated is not None:
            return stated
        lift = self.design.motion.rows(equal_steps(STROKE_STEPS), 0)[0]
        return 0.5 * float(np.ptp(lift)) + float(lift.min())

    def _stated_lift(self, engine: Engine | None) -> float | None:
        """Lift of the lobe's follower, mm, at the engine's lift; None where that is no lift of this lobe."""
        if engine is None or self.swings:
            return None
        if not engine.at_valve:
            return engine.lift
        moved = self.moved
        return None if moved is None else moved.follower_lift(engine.lift)

    @property
    def stretches(self) -> tuple[Stretch, ...]:
        """Rises, dwells and returns of the lobe over the shaft's angle; empty for a motion too rough to be followed."""
        return stretches(self.design.exact, self.zero)

    def rows(self, shaft: Array, order: int) -> Array:
        """Lift above the lowest position, mm or rad, and its derivatives by rad up to `order`, (order + 1, n).

        They are at the shaft angles `shaft` (n,), rad.
        """
        return self.design.motion.rows(np.mod(shaft - self.zero, TURN), order)


def placed(recipe: CamshaftRecipe, clock: Clock) -> tuple[PlacedLobe, ...]:
    """Design each lobe, each recipe once, and find its angle on the shaft.

    Raises RecipeErrors where a lobe has no such motion or curve, for a cam that cannot be a lobe, for lobes or journals
    that are too thin, and for a lobe set by an engine's centres that has no event at the engine's lift; EventError
    where the motion of the valve that states the lift is too rough to tell.
    """
    _demand_thick(recipe)
    designs: dict[str, Design] = {}
    lobes = []
    for i, lobe in enumerate(recipe.lobes):
        key = str(lobe.recipe.path)
        if key not in designs:
            try:
                designs[key] = designed(lobe.recipe, clock)
            except RecipeErrors as errors:
                raise of_a_lobe(recipe, f"camshaft.lobes[{i}].recipe", errors) from None
            _demand_one_outside(recipe, designs[key], i)
        design = designs[key]
        lobes.append(PlacedLobe(lobe, design, _angle(recipe, lobe, design, i)))
    return tuple(lobes)


def _demand_thick(recipe: CamshaftRecipe) -> None:
    """Raise RecipeErrors where two faces along the shaft are no farther apart than a file's tolerance.

    Each may be off by the tolerance, so no file could tell whether there is anything between them.
    """
    tolerances = [recipe.export.tolerance, *(file.tolerance or 0.0 for file in recipe.export.files)]
    least = max(THINNEST, *tolerances)
    more = f"more than {least / recipe.mm:.6g} {recipe.units}"
    shaft, *journals = recipe.bars
    paths = [f"camshaft.lobes[{i}]" for i in range(len(recipe.lobes))]
    paths += [f"camshaft.journals[{i}]" for i in range(len(journals))]
    parts: list[Lobe | Bar] = [*recipe.lobes, *journals]
    faces = [(shaft.low, "the shaft's lower end", ""), (shaft.high, "the shaft's upper end", "")]
    for path, part in zip(paths, parts, strict=True):
        if (long := part.high - part.low) <= least:
            problem = f"{part.name} is too thin, {long / recipe.mm:.3g} {recipe.units} long"
            raise recipe.error(f"{path}.length", problem, None, f"give a length of {more}, or leave it out")
        faces += [(part.low, part.name, f"{path}.z"), (part.high, part.name, f"{path}.z")]
    for (low, below, first), (high, above, second) in pairwise(sorted(faces, key=itemgetter(0))):
        if 0.0 < (gap := high - low) <= least:
            problem = f"{below} and {above} are {gap / recipe.mm:.3g} {recipe.units} apart, which is too thin"
            raise recipe.error(second or first, problem, None, f"let them meet, or set them {more} apart")


def _demand_one_outside(recipe: CamshaftRecipe, design: Design, index: int) -> None:
    if len(design.exact.surfaces) != 1 or any(surface.side < 0 for surface in design.exact.surfaces):
        remedy = "give a cam with one contour, followed from outside"
        raise recipe.error(f"camshaft.lobes[{index}].recipe", "a ring, a groove or a pair is no lobe", None, remedy)
    if len(design.follower.contacts) > 1 and math.isfinite(design.follower.pivot):
        remedy = "give a cam with a follower on a stem, or one that touches it once"
        raise recipe.error(f"camshaft.lobes[{index}].recipe", "two contacts on one arm are no lobe's", None, remedy)


def _angle(recipe: CamshaftRecipe, lobe: Lobe, design: Design, index: int) -> float:
    """Angle by which a lobe's metal is turned, rad from 0 to below a turn: as given, or so that its centre is right."""
    if lobe.at is not None or recipe.engine is None or lobe.cylinder is None:
        return float(np.mod(lobe.at or 0.0, TURN))
    lift = _tappet_lift(recipe, recipe.engine, lobe, design, index)
    unturned = event(design.exact, 0.0, lift)
    if unturned is None:
        remedy = "give a camshaft.engine.lift that each lobe crosses once on its rise and once on its return"
        message = f"{lobe.name} does not cross the lift of {recipe.engine.lift / recipe.mm:.9g} twice"
        raise recipe.error(f"camshaft.lobes[{index}].recipe", message, None, remedy)
    zero = recipe.engine.centre(lobe.cylinder, lobe.valve) - math.radians(unturned.centre)
    return float(np.mod(zero + lobe.direction, TURN))


def _tappet_lift(recipe: CamshaftRecipe, engine: Engine, lobe: Lobe, design: Design, index: int) -> float:
    """Lift of a lobe's tappet, mm, at which its events are stated.

    Where they are stated by the valve's lift, raises RecipeErrors for a recipe of the lobe without a valve, and
    RecipeErrors and EventError as `moved_by` does.
    """
    if not engine.at_valve:
        return engine.lift
    moved = moved_by(lobe.recipe, design)
    if moved is None:
        message = f"{lobe.recipe.path.name} tells of no valve"
        remedy = "give `valve: {ratio: ..., lash: ...}` there, or camshaft.engine.lift in place of valve_lift"
        raise recipe.error(f"camshaft.lobes[{index}].recipe", message, None, remedy)
    return moved.follower_lift(engine.lift)


def valves(lobes: Sequence[PlacedLobe], engine: Engine, cylinder: int) -> Valves | None:
    """Events of the valves of `cylinder`; None unless an intake and an exhaust lobe of it each have an event."""
    own = {lobe.lobe.valve: lobe.event(lobe.event_lift(engine)) for lobe in lobes if lobe.lobe.cylinder == cylinder}
    intake, exhaust = own.get("intake"), own.get("exhaust")
    if intake is None or exhaust is None:
        return None
    return valves_of(intake, exhaust, math.degrees(engine.firing[cylinder]))


def lifts(lobes: Sequence[PlacedLobe], shaft: Array) -> Array:
    """Lift of each lobe, mm or rad, at shaft angles (n,), rad: (lobes, n)."""
    return np.array([lobe.rows(shaft, 0)[0] for lobe in lobes])


def lobe_checks(recipe: CamshaftRecipe, lobes: tuple[PlacedLobe, ...]) -> list[Check]:
    """Checks of the exact cam of each lobe, of its own recipe's limits, and that it stands out of the shaft.

    Lobes of one recipe and one length are checked once, under the name of the first. Raises RecipeErrors and EventError
    where a capability cannot measure a figure that a lobe's recipe limits.
    """
    checks: list[Check] = []
    judged: set[tuple[Path, float | None]] = set()
    for lobe in lobes:
        made = lobe.lobe.made
        key = made.path, made.part.thickness
        if key in judged:
            continue  # lobes of one recipe and one length are one cam
        judged.add(key)
        own = list(lobe.design.checks)
        if made.limits:
            own += limit_checks(made, lobe.design, own, [], None)
        own += _outside_shaft(recipe, lobe)
        checks += [replace(check, surface=lobe.lobe.name) for check in own]
    return checks


def foresee(recipe: CamshaftRecipe) -> tuple[Foreseen, ...]:
    """Checks that the report is sure to have, each once, however many lobes it is made of.

    Raises IntentError for a lobe whose intended motion no cam can have.
    """
    from camgeo.checks.declared import CONTOUR, MOTION, THICKNESS, WATERTIGHT
    from camgeo.synthesis.expected_checks import Foreseen

    expected: dict[Foreseen, None] = {}
    for lobe in recipe.lobes:
        expected |= dict.fromkeys(check for check in _own_checks(lobe) if _judged_on_shaft(check.name))
    expected[Foreseen("shaft")] = None
    shaft, *journals = recipe.bars
    # where the shaft is longer than its lobes together, some of it is bare, and is judged as a journal is
    length = math.fsum(lobe.high - lobe.low for lobe in recipe.lobes)
    rounds = ["journal"] if journals or shaft.high - shaft.low > length + ROUNDING else []
    rounds += ["bore"] if recipe.bore is not None else []
    of_solid = (WATERTIGHT.name, THICKNESS.name, "phase", CONTOUR.name, MOTION.name, "position", *rounds, "volume")
    for request in recipe.export.files:
        if request.format.solid and request.format.contour:
            (name,) = recipe.filenames(request)
            expected |= dict.fromkeys(Foreseen(check, name) for check in of_solid)
    return tuple(expected)


def _own_checks(lobe: Lobe) -> tuple[Foreseen, ...]:
    """Checks that a run of the lobe's own recipe makes without files; IntentError for a motion that no cam can have."""
    from camgeo.synthesis.expected_checks import foreseen

    return foreseen(replace(lobe.made, export=replace(lobe.made.export, files=())))


def _judged_on_shaft(name: str) -> bool:
    """Whether a check of a lobe's recipe is made on the shaft: of the core, or a limit on a figure of the exact cam.

    No train and no other capability runs for a lobe.
    """
    from camgeo.checks.declared import CHECKS, LIMIT
    from camgeo.recipe.figures import FIGURES

    if name.startswith(LIMIT):
        return FIGURES[name.removeprefix(LIMIT)].of == "design"
    return not CHECKS.owner(name)


def left_to_lobes(recipe: CamshaftRecipe) -> list[RuleRemark]:
    """Remarks on checks of the lobes' recipes that no run of the shaft makes, one for each recipe that has some."""
    left: dict[str, list[str]] = {}
    for lobe in recipe.lobes:
        if names := [check.name for check in _own_checks(lobe) if not _judged_on_shaft(check.name)]:
            left[lobe.made.path.name] = names
    return [
        RuleRemark("lobe-checks", None, None, "", f"{', '.join(names)} of {file} is judged by its own export alone")
        for file, names in left.items()
    ]


def _outside_shaft(recipe: CamshaftRecipe, lobe: PlacedLobe) -> list[Check]:
    """Check that a lobe's contour stays outside the shaft."""
    if lobe.contour is None:
        return []
    from kin.judge.camshaft import outside_shaft

    return [outside_shaft(nearest(lobe.contour).value, recipe.bars[0].diameter)]
