"""The exact linear cam of a recipe: motion, path of the follower, flanks, and the outlines that are cut.

All axes are those of a plate that travels to the right, as in `camgeo.capabilities.linear.path`; `drawn` turns what is
written into the axes of the recipe.
"""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.linear.flank import Flank, FlankError, demand_graph
from camgeo.capabilities.linear.outline import Joined, Part, Round, Straight, joined
from camgeo.capabilities.linear.path import Arm, CentrePath, Stem, Travel
from camgeo.common.rounding import downward, upward
from camgeo.curve.backwards import Backwards
from camgeo.curve.curvature import roots
from camgeo.curve.curve import CurveError
from kin.law.normalised import IntentError
from kin.numeric.lengths import in_unit, input_words
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.linear.keys import LinearRecipe
    from camgeo.capabilities.linear.path import Guide
    from camgeo.common.clock import Clock
    from camgeo.curve.curve import Curve, Frame
    from camgeo.motions.stated import StatedMotion
    from camgeo.schema.errors import RecipeErrors
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array, Indices

LEVEL = 1e-9  # slope of a flank at its end below which it is level
ROOM = (
    0.25  # of the roller's radius: half circles end a groove so much farther out, to leave the overrun whole in files
)
MOST_LONGER = 1024.0  # times the lengths of a motion, up to which a sound plate is sought
SEEK = 512  # parts of a period among which the place of the flank at an edge, or where it is lowest, is sought


@dataclass(frozen=True, eq=False)
class LinearDesign:
    """A linear cam before any file: its recipe, its motion over the travel, and the path of the follower's centre."""

    recipe: LinearRecipe
    motion: Motion
    path: CentrePath

    @cached_property
    def lower(self) -> Flank:
        """The flank below the follower."""
        return Flank(self.path, self.recipe.follower.radius, self.recipe.endless)

    @cached_property
    def upper(self) -> Flank | None:
        """The flank above the roller of a groove, a clearance farther off; None without a groove."""
        groove = self.recipe.groove
        if groove is None:
            return None
        return Flank(self.path, -(self.recipe.follower.radius + groove.clearance), self.recipe.endless)

    @property
    def flanks(self) -> dict[str, Flank]:
        """Flanks by name: `lower` and `upper` of a groove, a single one without a name of a plate's edge."""
        return {"": self.lower} if self.upper is None else {"lower": self.lower, "upper": self.upper}

    @property
    def total(self) -> float:
        """Travel of the motion, of one period where it is endless, mm."""
        return self.motion.total

    @property
    def length(self) -> float:
        """Travel over all periods, mm."""
        return self.total * self.recipe.periods

    # --- outlines -----------------------------------------------------------------------------------------------------

    @cached_property
    def outline(self) -> Curve:
        """The plate's outline, counter-clockwise; with a groove a rectangle."""
        return self.grown(0.0)

    def grown(self, out: float) -> Curve:
        """The plate's outline with all metal `out` mm larger all round.

        Raises RecipeErrors where the flank, its ends or its parallel cannot be made.
        """
        if self.recipe.groove is not None:
            return joined(_box(*self.box, out=out))
        flank = replace(self.lower, distance=self.lower.distance - out) if out else self.lower
        run = _along(self, flank, None if self.recipe.endless else self.overruns, out)
        start, end = run.points
        corners = [(end[0], -out), (start[0], -out)]
        edges = [Straight(end, corners[0]), Straight(corners[0], corners[1]), Straight(corners[1], start)]
        if not min(start[1], end[1]) > -out:
            raise self.error("cam.ends", "the flank goes on below the lower edge", "give a shorter overrun")
        low, high = sorted((start[0], end[0]))
        reach = run.reach
        if reach[0] < low - LEVEL or reach[1] > high + LEVEL:
            raise self.error(
                "cam.ends.overrun",
                "the flank reaches beyond the ends of the plate",
                f"give an overrun of at least {upward(max(low - reach[0], reach[1] - high) / self.recipe.mm, 4)} more",
            )
        return joined([*run.parts, *(Part(edge, 0.0, edge.period) for edge in edges)])

    @cached_property
    def groove(self) -> Curve:
        """Outline of the groove, counter-clockwise; raises ValueError without one."""
        return self.groove_within(0.0)

    def groove_within(self, inset: float) -> Curve:
        """Outline of the groove `inset` mm inside, as a cutter's path; ValueError without a groove.

        Beyond the overruns half circles join the flanks.
        """
        upper = self.upper
        if upper is None:
            raise ValueError(f"{self.recipe.name}: no groove")
        flanks = [replace(flank, distance=flank.distance - flank.sense * inset) for flank in (upper, self.lower)]
        beyond = ROOM * self.recipe.follower.radius
        ways = self.overruns[0] + beyond, self.overruns[1] + beyond
        above, below = (_along(self, flank, ways, 0.0) for flank in flanks)
        back = [_reversed(part) for part in reversed(below.parts)]
        first, last = _cap(below.points[0], above.points[0]), _cap(above.points[1], below.points[1])
        quarter = 0.5 * math.pi
        return joined(
            [
                Part(first, quarter, 2.0 * quarter),
                *above.parts,
                Part(last, 0.0, 2.0 * quarter),
                *back,
                Part(first, 0.0, quarter),
            ]
        )

    @property
    def overruns(self) -> tuple[float, float]:
        """Overruns at the first and the last input, mm; raises ValueError for an endless plate."""
        if self.recipe.ends is None:
            raise ValueError(self.recipe.name)
        return self.recipe.ends.overrun

    @cached_property
    def box(self) -> tuple[float, float, float]:
        """Greatest and least x and the height of the plate of a groove, mm."""
        groove, ends, height = self.recipe.groove, self.recipe.ends, self.recipe.plate.height
        if groove is None or height is None or ends is None:
            raise ValueError(self.recipe.name)
        webs = ends.overrun if groove.web is None else (groove.web, groove.web)
        caps = [part.shape for part in _parts_of(self.groove) if isinstance(part.shape, Round)]
        right, left = (sorted((cap.centre[0] for cap in caps), reverse=True)[i] for i in (0, -1))
        return right + caps[0].radius + webs[0], left - caps[0].radius - webs[1], height

    @cached_property
    def extent(self) -> tuple[float, float]:
        """Least and greatest x of the plate, mm, as drawn."""
        if self.recipe.groove is not None:
            high, low, _ = self.box
        else:
            ends = np.array([run.low for run in self.outline.runs])
            x = self.outline.sample(ends).point[:, 0]
            low, high = float(x.min()), float(x.max())
        return (low, high) if self.recipe.travel == "right" else (-high, -low)

    def sides(self, u: Array) -> Indices:
        """Sides (n,) of breaks at inputs u (n,) that rows have: what follows, at the end of a motion what precedes."""
        chosen: Indices = np.where((u < self.length) | self.recipe.endless, 1, -1)
        return chosen

    def error(self, field: str, problem: str, remedy: str = "") -> RecipeErrors:
        """Error at a field of the recipe, or at its nearest parent that is given; lengths are in the recipe's unit."""
        recipe = self.recipe
        return recipe.error(recipe.stated(field), in_recipe(recipe, problem), None, remedy)

    def drawn(self, points: Array) -> Array:
        """Places or directions (n, 2) in the axes of the drawing: mirrored for a plate that travels to the left."""
        turned: Array = points if self.recipe.travel == "right" else points * np.array([-1.0, 1.0])
        return turned


def in_recipe(recipe: LinearRecipe, words: str) -> str:
    """Words with lengths and inputs in the recipe's unit."""
    return in_unit(words, recipe.mm, "in" if recipe.units == "inch" else "mm", travel=True)


@dataclass(frozen=True, eq=False)
class _Run:
    """A flank as it is cut, with what it goes on along: parts, their outermost points, and the reach in x, mm."""

    parts: tuple[Part, ...]
    points: tuple[tuple[float, float], tuple[float, float]]
    reach: tuple[float, float]


def _along(design: LinearDesign, flank: Flank, ends: tuple[float, float] | None, out: float) -> _Run:
    """The flank from its first to its last contact, and on by the overruns, mm; endless from edge to edge.

    `out` moves the ends outwards.
    """
    shape = flank.shape
    low, high = (0.0, design.total) if ends is not None else _from_edge_to_edge(design, flank, out)
    kept = [Part(shape, begin, end) for begin, end in flank.kept(low, high)]
    first, last = kept[0].ends, kept[-1].ends
    start, end = _point(first.point[0]), _point(last.point[1])
    x = np.concatenate([shape.sample(np.linspace(part.low, part.high, 257)).point[:, 0] for part in kept])
    reach = float(x.min()), float(x.max())
    if ends is None:
        return _Run(tuple(kept), (start, end), reach)
    before, after = _beyond(design, flank, first, 0, ends[0] + out), _beyond(design, flank, last, 1, ends[1] + out)
    points = _point(before[0].ends.point[0]), _point(after[-1].ends.point[1])
    return _Run((*before, *kept, *after), points, reach)


def _beyond(design: LinearDesign, flank: Flank, frame: Frame, end: int, length: float) -> list[Part]:
    """Parts along which a flank goes on for a length along x, mm, from one end: 0 the first contact, 1 the last one.

    It goes on along its tangent, or as a dwell: then the centre of the roller would go on along the travel, and where
    the flank comes down to its end the roller's own arc leads to the level.
    """
    point, tangent = frame.point[end], frame.tangent[end]
    ends, name, way = design.recipe.ends, ("beginning", "end")[end], (1.0, -1.0)[end]
    if not tangent[0] < -LEVEL:
        raise design.error("cam.motion", f"the flank is upright at its {name}", "let the motion begin and end gently")
    x = float(point[0]) + way * length
    if ends is None or ends.tangent or abs(tangent[1]) <= LEVEL:
        far = x, float(point[1] + tangent[1] / tangent[0] * (x - point[0]))
        return _straight(_point(point), far, end)
    # above 0 where the follower rises beyond the end
    rising = float(tangent[1]) * -way
    if rising > 0.0 or design.recipe.groove is not None:
        why = "cannot stay where it is" if rising > 0.0 else "is led by a groove"
        problem = f"the follower moves at the {name} of the motion and {why} beyond it"
        raise design.error("cam.ends.as", problem, "give tangent, or a motion that comes to rest there")
    u = np.array([0.0 if end == 0 else design.total])
    centre = design.path.sample(u, 1 if end == 0 else -1).point[0]
    foot = _point(centre - np.array([0.0, flank.distance]))
    if way * (x - foot[0]) <= 0.0:
        least = upward(abs(foot[0] - float(point[0])) / design.recipe.mm, 4)
        raise design.error("cam.ends.overrun", "the level begins farther out", f"give more than {least}")
    level = _straight(foot, (x, foot[1]), end)
    begin = math.atan2(point[1] - centre[1], point[0] - centre[0])
    bend = abs(math.remainder(-0.5 * math.pi - begin, 2.0 * math.pi))
    if flank.distance <= 0.0 or bend <= LEVEL:
        return level
    if end:
        return [Part(Round(_point(centre), flank.distance, begin, -1), 0.0, bend), *level]
    return [*level, Part(Round(_point(centre), flank.distance, -0.5 * math.pi, -1), 0.0, bend)]


def _straight(near: tuple[float, float], far: tuple[float, float], end: int) -> list[Part]:
    line = Straight(near, far) if end else Straight(far, near)
    return [Part(line, 0.0, line.period)]


def _from_edge_to_edge(design: LinearDesign, flank: Flank, out: float) -> tuple[float, float]:
    """Inputs at which an endless flank stands at the edges of its plate, x from 0 over all periods, mm."""
    period = design.total

    def beyond(x: float, u: Array) -> Array:
        return flank.shape.sample(u).point[:, 0] - x

    places = []
    for around, x in ((0.0, out), (design.length, -design.length - out)):
        u = around + np.linspace(-period, period, 2 * SEEK + 1)
        kept = flank.kept(float(u[0]), float(u[-1]))
        u = np.unique(np.concatenate([u, np.array(kept).ravel()]))
        inside = np.zeros(u.size, dtype=bool)
        for begin, end in kept:
            inside |= (u >= begin) & (u <= end)
        value = beyond(x, u)
        change = np.flatnonzero((value[:-1] > 0.0) & (value[1:] <= 0.0) & inside[:-1] & inside[1:])
        if not change.size:
            raise design.error("cam.endless", "no place of the flank stands at the edge of the plate")
        i = change[:1]
        place = roots(partial(beyond, x), u[i], u[i + 1], (value[i], value[i + 1]), 0.0)
        places.append(float(place[0]))
    return places[0], places[1]


def _parts_of(curve: Curve) -> tuple[Part, ...]:
    if not isinstance(curve.shape, Joined):
        raise TypeError("an outline of parts")
    return curve.shape.parts


def _cap(start: tuple[float, float], end: tuple[float, float]) -> Round:
    """Half circle counter-clockwise from one point to another, mm."""
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    return Round(middle, 0.5 * math.dist(start, end), math.atan2(start[1] - middle[1], start[0] - middle[0]))


def _box(right: float, left: float, height: float, *, out: float) -> list[Part]:
    right, left, low, high = right + out, left - out, -out, height + out
    corners = [(right, high), (left, high), (left, low), (right, low)]
    edges = [Straight(corners[i], corners[(i + 1) % 4]) for i in range(4)]
    return [Part(edge, 0.0, edge.period) for edge in edges]


def _reversed(part: Part) -> Part:
    """A part run through the other way."""
    if isinstance(part.shape, Straight):
        return replace(part, shape=Straight(part.shape.end, part.shape.start))
    return Part(Backwards(part.shape), -part.high, -part.low)


def _point(values: Array) -> tuple[float, float]:
    x, y = values.tolist()
    return x, y


# --- from a recipe ----------------------------------------------------------------------------------------------------


def designed(recipe: LinearRecipe, clock: Clock) -> LinearDesign:
    """The exact cam of a recipe, sized where its recipe has it so; raises RecipeErrors where there is none."""
    with clock.stage("motion"):
        design = _with_travel(recipe, 1.0)
        if recipe.steepest is not None:
            from camgeo.capabilities.linear.sizing import least_travel

            design = _with_travel(recipe, least_travel(recipe, lambda by: _with_travel(recipe, by).path))
        _demand_crank(design)
    with clock.stage("undercut"):
        try:
            _demand_graph(design)
            for name, flank in design.flanks.items():
                _demand_sound(design, name, flank)
        except CurveError as error:
            raise design.error("cam", f"undercut can be neither proved nor excluded: {error}") from error
        except FlankError as error:
            remedy = f"give a smaller radius of the {recipe.follower.kind}"
            raise design.error("cam", f"{error}, at {_at(error.at)}", remedy) from error
    _demand_metal(design)
    with clock.stage("profile"):
        _ = design.outline if recipe.groove is None else design.groove  # raises where its ends cannot be made
    return design


def stated_motion(design: LinearDesign) -> StatedMotion:
    """The motion over the travel, as the recipe states it; where that is sized, as it was found."""
    from camgeo.motions.stated import StatedMotion

    recipe = design.recipe

    def lift(u: Array) -> Array:
        flat = np.asarray(u, dtype=np.float64).ravel()
        return np.asarray(design.path.law.derivatives(flat, 0, design.sides(flat))[0].reshape(np.shape(u)))

    return StatedMotion(
        recipe.motion,
        design.length,
        recipe.periods,
        "same" if recipe.endless else "nothing",
        lift,
        1.0 / recipe.mm,
        math.degrees(1.0) if recipe.swings else 1.0 / recipe.mm,
    )


def _at(u: float) -> str:
    return input_words(u, ".6g")


def motion_field(recipe: LinearRecipe) -> str:
    """Path of the field that has the motion."""
    inner = "cam.motion.segments"
    return inner if inner in recipe.marks else "cam.motion"


def _with_travel(recipe: LinearRecipe, by: float) -> LinearDesign:
    """The design with all lengths of its motion times `by`."""
    field = motion_field(recipe)
    try:
        motion = recipe.motion.motion(
            recipe.motion.covered or 0.0, field, 1 if recipe.endless else None, open_ends=True
        ).stretched(by)
        _demand_joined(recipe, motion, field)
        travel = Travel.of(motion, endless=recipe.endless)
    except IntentError as error:
        raise recipe.error(recipe.stated(error.field), in_recipe(recipe, error.message)) from error
    guide = _guide(recipe)
    if isinstance(guide, Arm):
        most = guide.rest + motion.range[1]
        if not (abs(guide.rest) < 0.5 * math.pi and most < 0.5 * math.pi):
            problem = (
                f"the arm swings to {math.degrees(most):.6g} degrees from the travel; only less than 90 are driven"
            )
            raise recipe.error("cam.follower.arm", problem, None, "give a longer arm, a higher pivot or less swing")
    return LinearDesign(recipe, motion, CentrePath(travel, guide))


def _demand_joined(recipe: LinearRecipe, motion: Motion, field: str) -> None:
    """Raise IntentError where S or S' jumps."""
    motion.demand_joined(field, "rad" if recipe.swings else "mm", "mm")


def _guide(recipe: LinearRecipe) -> Guide:
    arm = recipe.follower.arm
    if arm is None:
        return Stem(recipe.pitch, -recipe.follower.lean)
    return Arm(arm.length, arm.pivot, recipe.rest, 1 if arm.side == "trailing" else -1)


def _demand_crank(design: LinearDesign) -> None:
    crank = design.recipe.drive.crank
    if crank is None or abs(2.0 * crank.radius - design.total) <= 1e-9 * design.total:
        return
    mm, units = design.recipe.mm, design.recipe.units
    problem = f"a stroke of {2.0 * crank.radius / mm:.9g} {units} for a motion over {design.total / mm:.9g} {units}"
    remedy = f"give {0.5 * design.total / mm:.9g} {units}, or motion over twice the radius"
    raise design.error("cam.drive.crank.radius", problem, remedy)


def _demand_sound(design: LinearDesign, name: str, flank: Flank) -> None:
    """Raise RecipeErrors where a flank undercuts and is not to be trimmed, with the roller and travel that serve."""
    if not flank.backwards:
        return
    if design.recipe.trims:
        _ = flank.lost  # raises FlankError where it cannot be trimmed
        return
    recipe, mm, units = design.recipe, design.recipe.mm, design.recipe.units
    radius, at = flank.least_radius
    clear = abs(flank.distance) - recipe.follower.radius
    free = radius - clear
    where = "crest" if flank.sense > 0 else "hollow"
    subject = f"the {name} flank" if name else "the flank"
    kind = recipe.follower.kind
    bend = f"the path bends at a radius of {radius / mm:.6g} {units}"
    problem = f"{subject} undercuts at the {where} near {_at(at)}, where {bend}"
    remedies = [f"give a {kind} radius of at most {downward(free / mm, 4)} {units}"] if free > 0.0 else []
    longer = None if recipe.steepest is not None else _longer(design, flank)
    if longer is not None:
        total = upward(longer * design.total / mm, 4)
        remedies.append(f"lengthen the motion {upward(longer, 4)} times, to {total} {units}")
    elif recipe.steepest is not None:
        remedies.append("a smaller angle under sizing")
    if flank.sense > 0 and recipe.groove is None:
        remedies.append("let what is lost be cut off: undercut: trim")
    raise design.error("cam.follower.radius", problem, ", or ".join(remedies))


def _demand_metal(design: LinearDesign) -> None:
    """Raise RecipeErrors where what stands under the contour is no higher than files may be off."""
    recipe, flank = design.recipe, design.lower
    within = max([recipe.export.tolerance, *(each.tolerance or 0.0 for each in recipe.export.files)])
    looks = np.linspace(0.0, design.total, SEEK + 1)
    least = float(flank.shape.sample(looks).point[:, 1].min())
    if least > within:
        return
    mm, units = recipe.mm, recipe.units
    problem = (
        f"the plate is {least / mm:.4g} {units} high where its contour is lowest, and the tolerance {within / mm:.4g}"
    )
    more = upward((recipe.base + 2.0 * within - least) / mm, 4)
    raise design.error("cam.base", problem, f"give at least {more} {units}")


def _demand_graph(design: LinearDesign) -> None:
    """Raise RecipeErrors where the path of what an arm leads meets itself, with the travel that serves."""

    def meets_itself(path: CentrePath) -> FlankError | None:
        try:
            demand_graph(path)
        except FlankError as error:
            return error
        return None

    error = meets_itself(design.path)
    if error is None:
        return
    recipe = design.recipe
    longer = least_factor(lambda by: meets_itself(_with_travel(recipe, by).path) is None)
    remedy = "give a longer arm, or less swing"
    if longer is not None and recipe.steepest is None:
        total = upward(longer * design.total / recipe.mm, 4)
        remedy = f"lengthen the motion {upward(longer, 4)} times, to {total} {recipe.units}"
    raise design.error("cam", f"{error}, at {_at(error.at)}", remedy) from error


def _longer(design: LinearDesign, flank: Flank) -> float | None:
    """Factor of all lengths of the motion, to a thousandth, from which on the flank is free; None without one."""
    from camgeo.capabilities.linear.flank import convex_radius

    def free(by: float) -> bool:
        path = _with_travel(design.recipe, by).path
        return convex_radius(path, flank.sense)[0] > abs(flank.distance)

    return least_factor(free)


def least_factor(holds: Callable[[float], bool]) -> float | None:
    """Least factor above 1, to a thousandth, from which on something holds; None where that is above MOST_LONGER."""
    high = 2.0
    while not holds(high):
        high *= 2.0
        if high > MOST_LONGER:
            return None
    low = 0.5 * high
    while high - low > 1e-3 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high
