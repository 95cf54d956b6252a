"""What a recipe's `sweep` asks for, in the words of this package."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.capabilities.sweep.figures import Evaluator, Scene, asked_of, estimated
from camgeo.capabilities.sweep.gather import Ranking
from camgeo.capabilities.sweep.keys import Sweep
from camgeo.capabilities.sweep.plan import Axis, Plan, steps
from camgeo.recipe.export import Export
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.linkage import output_slides
from camgeo.recipe.part import Part
from camgeo.recipe.recipe import Recipe, Verify
from camgeo.schema.errors import RecipeErrors, shown
from camgeo.schema.fields import Kind, field_at
from camgeo.schema.yaml_source import join
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from camgeo.capabilities.sweep.figures import FigureTable
    from camgeo.capabilities.sweep.gather import Floats
    from camgeo.capabilities.sweep.keys import Axis as Varied

EXACT = 100  # designs: of no more each is worked out, which takes seconds
_LENGTH = {"mm": "mm", "inch": "in"}
_LENGTHS = {Kind.LENGTH, Kind.POINT, Kind.PAIR}


@dataclass(frozen=True)
class Unit:
    """Unit of a figure as told, and what its value in mm and degrees is divided by."""

    name: str
    divisor: float = 1.0


@dataclass(frozen=True)
class Ask:
    """A recipe that has a sweep, the parts of that sweep, and the recipe with each of the words that vary."""

    recipe: Recipe
    sweep: Sweep
    plan: Plan
    ranking: Ranking
    variants: tuple[Recipe, ...] = ()

    @staticmethod
    def of(recipe: Recipe) -> Ask:
        """Take the sweep of a recipe; raises RecipeErrors where it has none."""
        sweep = recipe.of(Sweep)
        if sweep is None:
            raise recipe.error("sweep", "this recipe has no sweep", None, "add what to vary: `sweep: {vary: ...}`")
        axes = tuple(map(_axis, sweep.vary))
        count = sweep.count
        if count is None:
            count = 1
            for axis in axes:
                count *= len(axis.values)
        plan = Plan(axes, sweep.method, count, sweep.seed)
        ranking = Ranking(sweep.rank, FIGURES[sweep.rank].best == "most", sweep.limits)
        return Ask(recipe, sweep, plan, ranking, _variants(recipe, sweep))

    @cached_property
    def figures(self) -> tuple[str, ...]:
        """The figures that every design is given: those that cost little, and the others where they rank or limit.

        Limits on the cheap ones so leave what is computed as it is. Designs with a linkage that are made one by one
        get all, which then cost next to nothing.
        """
        if self.screened:
            return self._estimated
        if self.recipe.linkage is not None and Evaluator.of(self.recipe, self.paths).slow:
            return self.all_figures
        return tuple(name for name in self.all_figures if name in self._asked or not FIGURES[name].dear)

    @property
    def _asked(self) -> set[str]:
        return {self.sweep.rank, *(limit.figure for limit in self.sweep.limits)}

    @property
    def _estimated(self) -> tuple[str, ...]:
        """The figures that can be estimated, and those that must be."""
        known = estimated(self.recipe)
        return tuple(name for name in self.all_figures if name in known or name in self._asked)

    @property
    def paths(self) -> tuple[str, ...]:
        """The fields that vary."""
        return tuple(axis.path for axis in self.sweep.vary)

    @property
    def screened(self) -> bool:
        """Whether figures of all designs are estimates, and those of the designs kept alone exact."""
        return not self.unscreened

    @cached_property
    def unscreened(self) -> str:
        """Why figures are not estimates but come from each design; empty where they are estimates."""
        if self.plan.count <= EXACT:
            return f"up to {EXACT} designs are all worked out"
        screen = Evaluator.of(self.recipe, self.paths, figures=self._estimated, screened=True).screen
        return screen if isinstance(screen, str) else ""

    def exactly(self, values: Floats) -> FigureTable:
        """All figures of designs with the values (m, axes) of the sweep, and why one has none, from each design."""
        scene = self.scene(self.all_figures)
        return Evaluator.of(scene.recipe, scene.paths, figures=scene.figures).found(values)

    @property
    def all_figures(self) -> tuple[str, ...]:
        """The figures that the best designs are given: those that they have with all words."""
        return tuple(name for name in asked_of(self.recipe) if all(name in asked_of(other) for other in self.variants))

    def told(self, values: Mapping[str, float]) -> dict[str, float | str]:
        """Values by path as the recipe has them."""
        return {axis.path: axis.told(values[axis.path]) for axis in self.plan.axes}

    def scene(self, figures: tuple[str, ...]) -> Scene:
        """What decides these figures of a design.

        It leaves out what has no bearing on them, so that a change of limits, ranking or files to export leaves what
        was computed as it is.
        """
        owners = {"sweep", *(FIGURES.owner(name) for name in figures)}
        whole = any(FIGURES[name].needs.part for name in figures)
        plain = replace(self.sweep, limits=(), rank="size", keep=1, refine=False)
        recipe = replace(
            self.recipe.without(*(name for name in self.recipe.uses if name not in owners)).with_value(plain),
            name="",
            about="",
            part=self.recipe.part if whole else Part(),
            export=Export(1.0, ()),
            verify=Verify(1),
            path=self.recipe.path if self.recipe.tables else Path("recipe.yaml"),
        )
        return Scene(recipe, figures, self.screened, tuple(variant.cam for variant in self.variants))

    def measured(self, values: Floats) -> dict[str, Floats]:
        """All figures (m,) of designs with the values (m, axes) of the sweep, in mm and degrees."""
        return self.exactly(values).figures

    def units(self, figures: Iterable[str]) -> dict[str, Unit]:
        """Unit of each figure, lengths in that of the recipe."""
        length = Unit(_LENGTH[self.recipe.units], self.recipe.mm)
        linkage, swings = self.recipe.linkage, self.recipe.cam.arrangement.unit == "deg"
        slides = not swings if linkage is None else output_slides(linkage)
        by_kind = {
            Kind.ANGLE: Unit("deg"),
            Kind.LENGTH: length,
            Kind.MOTION: length if slides else Unit("deg"),
            Kind.FORCE: Unit("N"),
            Kind.MOMENT: Unit("N m"),
            Kind.THRUST: Unit("N m" if swings else "N"),
        }
        found = {}
        for name in figures:
            unit = by_kind.get(FIGURES[name].kind, Unit(""))  # numbers, and forces in SI
            found[name] = replace(unit, name=unit.name + FIGURES[name].per)
        return found

    def axis_unit(self, path: str) -> str:
        """Unit in which the recipe writes a field that is varied; empty for a plain number."""
        linkage = "" if self.recipe.linkage is None else self.recipe.linkage.kind
        field = field_at(recipe_table(), path, {"cam": self.recipe.cam.kind, "linkage": linkage})
        length = _LENGTH[self.recipe.units]
        if field is None:
            return ""
        if field.kind is Kind.HARMONICS:
            return f"{length}^2" if path.startswith("cam.delta.") else length
        kind = field.unit or field.kind
        return length if kind in _LENGTHS else "deg" if kind is Kind.ANGLE else ""


def _variants(recipe: Recipe, sweep: Sweep) -> tuple[Recipe, ...]:
    """The recipe with each word; raises RecipeErrors, at the word, where there is no such recipe."""
    found = []
    for axis in sweep.vary:
        for i, word in enumerate(axis.words):
            place = join(join("sweep.vary", axis.path), i)
            try:
                found.append(recipe.replace(axis.path, word))
            except RecipeErrors as errors:
                first = errors.errors[0]
                problem = f"with it {first.path}: {first.problem}"
                raise recipe.error(place, problem, shown(word), first.remedy) from errors
    return tuple(found)


def _axis(varied: Varied) -> Axis:
    if varied.words:
        counts = tuple(map(float, range(len(varied.words))))
        return Axis(varied.path, counts[0], counts[-1], counts, varied.words)
    if varied.values:
        return Axis(varied.path, min(varied.values), max(varied.values), varied.values)
    values = steps(varied.low, varied.high, varied.steps) if varied.steps else ()
    return Axis(varied.path, varied.low, varied.high, values)
