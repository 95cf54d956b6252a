"""The task that a recipe's `sweep` sets: its plan, its ranking, the figures computed, and their units."""

from __future__ import annotations

import math
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.figures import Evaluator, SweepScene, estimable_figures, figure_names
from camgeo.capabilities.sweep.gather import Ranking
from camgeo.capabilities.sweep.keys import Sweep
from camgeo.capabilities.sweep.plan import Plan
from camgeo.part.part import Part
from camgeo.recipe.export import Export
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.linkage import output_slides
from camgeo.recipe.recipe import Recipe, Verify
from camgeo.schema.errors import RecipeErrors, quote
from camgeo.schema.fields import Kind, field_at
from camgeo.schema.yaml_source import join
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterable

    from camgeo.capabilities.sweep.figures import FigureTable
    from kin.numeric.arrays import Array, Mask

_START_DISTANCE = 0.15  # of an axis's range in every value: polishing would lead nearer designs to one place
EXACT = 100  # designs, up to which each is computed exactly, which takes seconds
_LENGTH_UNITS = {"mm": "mm", "inch": "in"}
_LENGTHS = {Kind.LENGTH, Kind.POINT, Kind.PAIR}


@dataclass(frozen=True)
class Unit:
    """Unit in which a figure is reported, and the divisor that turns its value in mm or degrees into this unit."""

    name: str
    divisor: float = 1.0


@dataclass(frozen=True)
class SweepTask:
    """A recipe that has a sweep, its plan and ranking; `variants` are the recipe with each of the words that vary."""

    recipe: Recipe
    sweep: Sweep
    plan: Plan
    ranking: Ranking
    variants: tuple[Recipe, ...] = ()

    @staticmethod
    def from_recipe(recipe: Recipe) -> SweepTask:
        """Task of a recipe's sweep; raises RecipeErrors without one, and for a word that makes no recipe."""
        sweep = recipe.of(Sweep)
        if sweep is None:
            raise recipe.error("sweep", "this recipe has no sweep", None, "add what to vary: `sweep: {vary: ...}`")
        count = math.prod(len(axis.values) for axis in sweep.vary) if sweep.count is None else sweep.count
        ranking = Ranking(sweep.rank, FIGURES[sweep.rank].best == "most", sweep.limits)
        return SweepTask(
            recipe, sweep, Plan(sweep.vary, sweep.method, count, sweep.seed), ranking, _variants(recipe, sweep)
        )

    @cached_property
    def figures(self) -> tuple[str, ...]:
        """Names of the figures of every design: those that cost little, and the others where they rank or limit.

        So limits on cheap figures leave what was computed as it is. Designs with a linkage that are made one by one get
        all, which then cost next to nothing.
        """
        if self.screened:
            return self._estimated_figures
        if self.recipe.linkage is not None and Evaluator.prepare(self.recipe, self.paths).slow:
            return self.all_figures
        return tuple(name for name in self.all_figures if name in self._needed_figures or not FIGURES[name].dear)

    @property
    def _needed_figures(self) -> set[str]:
        """Names of the figures that rank or limit."""
        return {self.sweep.rank, *(limit.figure for limit in self.sweep.limits)}

    @property
    def _estimated_figures(self) -> tuple[str, ...]:
        """Names of the figures that can be estimated, and those that must be, as they rank or limit."""
        names = {*estimable_figures(self.recipe), *self._needed_figures}
        return tuple(name for name in self.all_figures if name in names)

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the fields that vary."""
        return tuple(axis.path for axis in self.sweep.vary)

    @property
    def screened(self) -> bool:
        """Whether figures are estimates, but for the exact figures of the best designs."""
        return not self.unscreened

    @cached_property
    def unscreened(self) -> str:
        """Why figures of every design are computed exactly; empty where they are estimates."""
        if self.plan.count <= EXACT:
            return f"up to {EXACT} designs are all worked out"
        screen = Evaluator.prepare(self.recipe, self.paths, figures=self._estimated_figures, screened=True).screen
        return screen if isinstance(screen, str) else ""

    def exact_figures(self, values: Array) -> FigureTable:
        """All figures of designs with the values (m, axes), each computed exactly, in mm and degrees.

        The table's `reason` says why figures of a design are missing, 0 where none is.
        """
        scene = self.scene(self.all_figures)
        return Evaluator.prepare(scene.recipe, scene.paths, figures=scene.figures).evaluate(values)

    def measure(self, values: Array) -> dict[str, Array]:
        """All figures (m,) by name of designs with the values (m, axes), in mm and degrees."""
        return self.exact_figures(values).figures

    @property
    def all_figures(self) -> tuple[str, ...]:
        """Names of the figures of the best designs: those that the recipe has whichever words it takes."""
        names = [figure_names(recipe) for recipe in (self.recipe, *self.variants)]
        return tuple(name for name in names[0] if all(name in variant for variant in names))

    def are_apart(self, values: Array, start: Array) -> Mask:
        """Mask (n,) of designs with `values` (n, axes) so far from `start` (axes,) that polishing leads elsewhere.

        All do where nothing is polished.
        """
        ranges = np.array([axis.range or 1.0 for axis in self.plan.axes])
        apart: Mask = np.abs((values - start) / ranges).max(axis=1) > (_START_DISTANCE if self.sweep.refine else -1.0)
        return apart

    def values_by_path(self, values: Iterable[float]) -> dict[str, float | str]:
        """Values of a design (axes,) by their paths, as the recipe writes them, words as words."""
        return {axis.path: axis.written(float(value)) for axis, value in zip(self.plan.axes, values, strict=True)}

    def scene(self, figures: tuple[str, ...]) -> SweepScene:
        """Scene of the given figures of a design: all that they depend on, and no more.

        So a change of limits, ranking or files to export leaves what was computed as it is.
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
        return SweepScene(recipe, figures, self.screened, tuple(variant.cam for variant in self.variants))

    def units(self, figures: Iterable[str]) -> dict[str, Unit]:
        """Unit of each of the figures by name, lengths in the recipe's unit."""
        length = Unit(_LENGTH_UNITS[self.recipe.units], self.recipe.mm)
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
        units = {}
        for name in figures:
            unit = by_kind.get(FIGURES[name].kind, Unit(""))  # numbers, and forces in SI
            units[name] = replace(unit, name=unit.name + FIGURES[name].per)
        return units

    def axis_unit(self, path: str) -> str:
        """Unit in which the recipe writes a varied field; empty for a plain number."""
        linkage = "" if self.recipe.linkage is None else self.recipe.linkage.kind
        field = field_at(recipe_table(), path, {"cam": self.recipe.cam.kind, "linkage": linkage})
        length = _LENGTH_UNITS[self.recipe.units]
        if field is None:
            return ""
        if field.kind is Kind.HARMONICS:
            return f"{length}^2" if path.startswith("cam.delta.") else length
        kind = field.unit or field.kind
        return length if kind in _LENGTHS else "deg" if kind is Kind.ANGLE else ""


def _variants(recipe: Recipe, sweep: Sweep) -> tuple[Recipe, ...]:
    """The recipe with each word that varies; raises RecipeErrors, at the word, where that is no recipe."""
    variants = []
    for axis in sweep.vary:
        for i, word in enumerate(axis.words):
            place = join(join("sweep.vary", axis.path), i)
            try:
                variants.append(recipe.replace(axis.path, word))
            except RecipeErrors as errors:
                first = errors.errors[0]
                problem = f"with it {first.path}: {first.problem}"
                raise recipe.error(place, problem, quote(word), first.remedy) from errors
    return tuple(variants)
