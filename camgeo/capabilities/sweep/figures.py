"""Figures of many designs at once: what a sweep ranks by and limits.

Designs that differ in the place of the shaft, the lengths of a linkage and the harmonics of a cam are computed
together, in blocks that stay in the cache; other fields of a cam cost one evaluation of its lift for each distinct cam.
Dyads are computed one by one (`single_designs`). These motions are sampled at the recipe's `angles`, raised to a
multiple of 4, and no rounding depends on which designs are computed together. Recipes without a linkage are designed
one by one, or estimated together (`screen`).
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from camgeo.capabilities.sweep import single_designs
from camgeo.capabilities.sweep.cams import BINDS, BROKEN, FINE, IMPOSSIBLE, REVERSES, CamSampler
from camgeo.capabilities.sweep.gather import REASON
from camgeo.capabilities.sweep.keys import SAMPLES, Sweep, sweep_figures, varied_fields
from camgeo.capabilities.sweep.linkages import Lengths, angles, loop_class
from camgeo.capabilities.sweep.windows import (
    Ends,
    Samples,
    cell_bounds,
    greatest,
    least,
    longest_windows,
    window_ends,
    window_lengths,
)
from camgeo.recipe.figures import CONTACT_TRAVEL, DWELL, RADIUS, SIZE
from camgeo.recipe.linkage import output_slides
from camgeo.schema.errors import RecipeErrors
from kin.linkage.loop import side_of
from kin.numeric.records import dataclass, full_text, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from camgeo.cams.family import Cam
    from camgeo.capabilities.sweep.cams import Codes
    from camgeo.capabilities.sweep.linkages import Loop
    from camgeo.capabilities.sweep.screen import Screen
    from camgeo.capabilities.sweep.single_designs import MotionRows
    from camgeo.recipe.limits import Limit
    from camgeo.recipe.recipe import Recipe
    from kin.linkage.four_bar import Linkage
    from kin.numeric.arrays import Array, Indices, Mask

Motion: TypeAlias = "Loop | MotionRows"

BLOCK = 11_520  # samples of a block: a dozen arrays of them stay in a cache of 1 MB
DWELLS = (DWELL, "dwell-relative")
_HEAP = 3 << 20  # numbers, 24 MB


class FigureTable(NamedTuple):
    """Figures of m designs by name, (m,) each, in mm and degrees, derivatives by radian of the shaft angle.

    `reason` (m,) is an index into REASONS, why a design lacks figures or breaks a limit, 0 for none.
    """

    figures: dict[str, Array]
    reason: Codes


@dataclass(frozen=True)
class SweepScene:
    """All that decides the figures of a sweep's designs, as plain data for any worker; it is part of the key.

    `recipe` has its sweep, without parts on which no figure depends. `figures` are the names of the figures computed,
    by estimates where `screened` is true. `variants` are the recipe's cams with each word that varies, whose tables are
    part of the key.
    """

    recipe: Recipe
    figures: tuple[str, ...]
    screened: bool = False
    variants: tuple[Cam, ...] = ()

    def __repr__(self) -> str:
        """All fields of the scene as text, from which the key is made; a recipe's own `repr` is only its name."""
        fields = f"figures={self.figures!r}, screened={self.screened!r}, variants={self.variants!r}"
        return f"Scene(recipe={full_text(self.recipe)}, {fields})"

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the fields that vary."""
        return tuple(axis.path for axis in varied_fields(self.recipe))


def figure_names(recipe: Recipe) -> tuple[str, ...]:
    """Names of the figures that a recipe's designs have."""
    fields = {path for path in recipe.marks if path.partition(".")[0] != "part"}
    if recipe.part.density is not None and recipe.linkage is None:
        fields.add("part.density")
    if recipe.part.thickness is not None:
        fields.add("part.thickness")
    offers = recipe.cam.arrangement.offers
    return tuple(name for name, figure in sweep_figures().items() if figure.needs.there(offers, fields))


def estimable_figures(recipe: Recipe) -> tuple[str, ...]:
    """Names of the figures of a cam without a linkage that can be estimated."""
    from camgeo.capabilities.sweep.screen import estimates

    return tuple(name for name in figure_names(recipe) if name in estimates())


@dataclass(frozen=True)
class Evaluator:
    """Computes the figures `names` of designs that differ at `paths`; what they share is prepared once.

    A design that breaks one of the `limits` is computed no further. `count` is the number of samples of a turn. With
    `screened`, cams without a linkage are estimated where they can be.
    """

    recipe: Recipe
    paths: tuple[str, ...]
    names: tuple[str, ...]
    limits: tuple[Limit, ...]
    count: int
    screened: bool = False

    @staticmethod
    def prepare(
        recipe: Recipe,
        paths: Sequence[str],
        *,
        figures: Sequence[str] | None = None,
        samples: int | None = None,
        screened: bool = False,
    ) -> Evaluator:
        """Evaluator of designs in which the fields at `paths` differ.

        `figures` names the figures computed besides the limited ones, by default all that the recipe has, of estimates
        all that can be estimated. `samples` is the number of samples of a turn, by default the sweep's `angles`, raised
        to a multiple of 4. With `screened`, figures of cams without a linkage are estimated where that is possible.
        Raises CallError for a path at which neither a number nor a varied word stands.
        """
        sweep = recipe.of(Sweep)
        limits = sweep.limits if sweep else ()
        possible = estimable_figures if screened and recipe.linkage is None else figure_names
        names = tuple(dict.fromkeys((*(figures or possible(recipe)), *(limit.figure for limit in limits))))
        count = samples or (sweep.angles if sweep else SAMPLES)
        words = single_designs.word_lists(recipe)
        recipe.text_with({path: 1.0 for path in paths if path not in words})  # raises where no number stands
        return Evaluator(recipe, tuple(paths), names, limits, -(-count // 4) * 4, screened)

    @cached_property
    def word_columns(self) -> tuple[int, ...]:
        """Columns of the values that are indices of words."""
        words = single_designs.word_lists(self.recipe)
        return tuple(column for column, path in enumerate(self.paths) if path in words)

    @property
    def _numbers(self) -> tuple[str, ...]:
        """Paths of the numbers that vary."""
        return tuple(path for column, path in enumerate(self.paths) if column not in self.word_columns)

    def _with_words(self, chosen: tuple[float, ...]) -> Evaluator | None:
        """Evaluator of the designs that share these words, by their indices; None where there is no such recipe."""
        if chosen not in self._by_words:
            words = [self.paths[column] for column in self.word_columns]
            try:
                variant = single_designs.recipe_with(self.recipe, words, chosen)
            except RecipeErrors:
                self._by_words[chosen] = None
            else:
                recipe = replace(self.recipe, cam=variant.cam, linkage=variant.linkage, text=variant.text)
                self._by_words[chosen] = replace(self, recipe=recipe, paths=self._numbers)
        return self._by_words[chosen]

    @cached_property
    def _by_words(self) -> dict[tuple[float, ...], Evaluator | None]:
        """Evaluators made so far by `_with_words`."""
        return {}

    def _evaluate_by_words(self, values: Array) -> FigureTable:
        """Figures of designs with values (m, k); designs that share all words are computed together."""
        m = len(values)
        figures = {name: np.full(m, np.nan) for name in self.names}
        reason = np.full(m, IMPOSSIBLE, dtype=np.uint8)
        distinct, group = np.unique(values[:, self.word_columns], axis=0, return_inverse=True)
        numbers = np.delete(values, self.word_columns, axis=1)
        for i, chosen in enumerate(distinct):
            rows, evaluator = np.flatnonzero(group.reshape(-1) == i), self._with_words(tuple(chosen.tolist()))
            if evaluator is not None:
                part = evaluator.evaluate(numbers[rows])
                reason[rows] = part.reason
                for name, column in part.figures.items():
                    figures[name][rows] = column
        return FigureTable(figures, reason)

    @cached_property
    def screen(self) -> Screen | str:
        """Screen that estimates cams without a linkage, with the recipe's own words; or the reason why it cannot."""
        from camgeo.capabilities.sweep.screen import Screen

        return Screen.prepare(self.recipe, self._numbers, self.names, self.count)

    @property
    def estimator(self) -> Screen | None:
        """The screen, if figures shall and can be estimated; else None."""
        screen = self.screen if self.screened else ""
        return None if isinstance(screen, str) else screen

    @cached_property
    def cams(self) -> CamSampler:
        """Sampler of the cams of all designs, with the recipe's own words."""
        return CamSampler.prepare(self.recipe, self._numbers, self.count)

    @property
    def slow(self) -> bool:
        """Whether a recipe is made for each design, or for each distinct cam."""
        linkage = self.recipe.linkage
        return self.estimator is None if linkage is None else bool(linkage.dyads) or bool(self.cams.others)

    def evaluate(self, values: Array) -> FigureTable:
        """Figures of m designs; `values` (m, k) are those at the paths, in the recipe's units, words by their index.

        A design that does not exist or does not turn has nan for all figures. With a linkage, a design that breaks a
        limit is computed no further: its dwells are -inf, and other figures not computed by then nan. Raises ValueError
        for a dwell in a recipe without a band.
        """
        m = len(values)
        values = np.asarray(values, dtype=float).reshape(m, len(self.paths))
        if self.word_columns:
            return self._evaluate_by_words(values)
        figures = {name: np.full(m, np.nan) for name in self.names}
        reason = np.zeros(m, dtype=np.uint8)
        if self.recipe.linkage is None:
            if self.estimator is None:
                computed, reason[:] = single_designs.evaluate(self.recipe, self.paths, values, tuple(figures))
            else:
                computed, reason[:] = self.estimator.estimate(values)
            figures.update(computed)
            self._mark_broken(figures, reason)
            return FigureTable(figures, reason)
        # mechanisms in blocks that stay in the cache: `_block` fills in all figures but dwells
        rows = max(1, BLOCK // self.count)
        blocks: list[tuple[Indices, dict[str, Ends]]] = []
        for first in range(0, m, rows):
            block = slice(first, min(first + rows, m))
            index, dwells = self._block(
                values[block], {name: column[block] for name, column in figures.items()}, reason[block]
            )
            if index.size:
                blocks.append((index + first, dwells))
        # dwells are measured from their ends for all designs at once, as their bisections take many small steps
        for name in DWELLS:
            if name in figures:
                figures[name][reason == BROKEN] = -np.inf
                if blocks:
                    rows_left = np.concatenate([index for index, _ in blocks])
                    windows = Ends.concatenate([dwells[name] for _, dwells in blocks])
                    figures[name][rows_left] = np.degrees(window_lengths(windows, self._band))
        for column in figures.values():
            column[(reason != FINE) & (reason != BROKEN)] = np.nan
        self._mark_broken(figures, reason)
        return FigureTable(figures, reason)

    @property
    def _band(self) -> float:
        """Band of the recipe's dwells, mm or rad."""
        dwell = self.recipe.dwell
        if dwell is None:
            raise ValueError(f"{self.recipe.name}: a dwell needs a band")
        return dwell.band

    def _mark_broken(self, figures: Mapping[str, Array], reason: Codes) -> None:
        """Set the reason BROKEN of fine designs that break a limit on a figure; nan, not yet computed, breaks none."""
        broken = np.zeros(len(reason), dtype=np.bool_)
        for limit in self.limits:
            values = figures[limit.figure]
            if limit.at_least is not None:
                broken |= values < limit.at_least
            if limit.at_most is not None:
                broken |= values > limit.at_most
        reason[(reason == FINE) & broken] = BROKEN

    def _block(self, values: Array, figures: dict[str, Array], reason: Codes) -> tuple[Indices, dict[str, Ends]]:
        """Fill in figures and reasons (m,) of a block; return the fine designs (k,), and the ends of their dwells."""
        cams = self.cams.sample(values)
        support, smooth = cams.support, cams.smooth
        reason[:] = cams.fault
        # figures of the cam alone, then those of the loop: each step leaves out the designs that failed before
        at_cam = {
            RADIUS: lambda: cams.radius,
            CONTACT_TRAVEL: lambda: greatest(support.dp, smooth) - least(support.dp, smooth),
            SIZE: lambda: np.sqrt(greatest(support.p * support.p + support.dp * support.dp, smooth)),
        }
        _fill(figures, np.arange(len(values)), at_cam)
        self._mark_broken(figures, reason)
        index = np.flatnonzero(reason == FINE)
        if not index.size:
            return index, {}
        motion: Motion
        linkage = self.recipe.linkage
        if linkage is None or linkage.dyads:
            margin, motion = single_designs.dyad_motions(self.recipe, self.paths, values[index], self.count)
        else:
            kind, side = loop_class(linkage.loop), side_of(linkage.loop.assembly)
            part = support if len(index) == len(values) else support.part(reason == FINE)
            motion = kind.from_lengths(side, part, self._lengths(linkage.loop, kind.dimensions, values[index]))
            smooth_rows = smooth[index]
            margin = motion.margin(lambda rows: least(rows, smooth_rows))
        _fill(figures, index, {"margin": lambda: margin})
        reason[index[~(margin > 0.0)]] = BINDS
        index, motion = self._keep(index, motion, figures, reason)
        if index.size:
            # phi = theta - theta_3: a shaft that turns back makes a design of no use
            rate = least(1.0 - motion.frame_rate, smooth[index])
            reason[index[~(rate > 0.0)]] = REVERSES
            angles_at_d = {
                "shaft-rate": lambda: rate,
                "transmission-angle": lambda: _acute_angle(motion.transmission, len(index), smooth[index]),
                "force-angle": lambda: _acute_angle(motion.force, len(index), smooth[index]),
            }
            _fill(figures, index, angles_at_d)
            index, motion = self._keep(index, motion, figures, reason)
        if index.size:
            self._fill_output(index, motion, figures, smooth[index])
            index, motion = self._keep(index, motion, figures, reason)
        return index, self._dwells(motion) if index.size else {}

    def _keep(self, index: Indices, motion: Motion, figures: dict[str, Array], reason: Codes) -> tuple[Indices, Motion]:
        """Indices of the designs without a fault so far that keep the limits, and their motion; marks the others."""
        part = reason[index]
        self._mark_broken({name: column[index] for name, column in figures.items()}, part)
        reason[index] = part
        fine = part == FINE
        return (index, motion) if fine.all() else (index[fine], motion.part(fine))

    def _fill_output(self, index: Indices, motion: Motion, figures: dict[str, Array], smooth: Mask) -> None:
        """Fill in the figures of the output at the designs `index`, in mm or degrees, by rad of the shaft."""
        linkage, turn = self.recipe.linkage, 1.0 - motion.frame_rate
        scale = 1.0 if linkage is not None and output_slides(linkage) else math.degrees(1.0)

        def acceleration() -> Array:
            """Greatest second derivative of the output f by the shaft angle phi, (m,).

            It is (f'/phi')'/phi', with phi' = 1 - theta_3' and phi'' = -theta_3''.
            """
            second: Array = motion.second * turn
            second += motion.rate * motion.frame_second
            second /= turn * turn * turn
            return scale * greatest(np.abs(second), smooth)

        of_output = {
            "swing": lambda: scale * (greatest(motion.output, smooth) - least(motion.output, smooth)),
            "peak-velocity": lambda: scale * greatest(np.abs(motion.rate / turn), smooth),
            "peak-acceleration": acceleration,
        }
        _fill(figures, index, of_output)

    def _dwells(self, motion: Motion) -> dict[str, Ends]:
        """Ends of the longest dwell of each design, by the figures of dwells that are computed."""
        names = [name for name in DWELLS if name in self.names]
        if not names:
            return {}
        output = motion.output, motion.rate
        bounds = cell_bounds(*output)
        theta = np.broadcast_to(angles(self.count), output[0].shape)
        abscissae = {
            DWELL: (theta - motion.frame, 1.0 - motion.frame_rate),
            "dwell-relative": (theta, np.ones_like(theta)),
        }
        samples = Samples(output[0], *bounds, np.stack([abscissae[name][0] for name in names]))
        start, cells = longest_windows(samples, self._band)
        return {
            name: window_ends((start[k], cells[k]), output, abscissae[name], bounds) for k, name in enumerate(names)
        }

    def _lengths(self, linkage: Linkage, dimensions: tuple[str, ...], values: Array) -> Lengths:
        """Dimensions, mm, of m linkages that differ from the recipe's in the values (m, k); unused ones are 0."""
        columns = []
        for name in Lengths._fields:
            path = f"linkage.{name}"
            if path in self.paths:
                column = self.paths.index(path)
                columns.append(values[:, column : column + 1] * self.recipe.mm)
            else:
                columns.append(np.full((len(values), 1), vars(linkage)[name] if name in dimensions else 0.0))
        return Lengths(*columns)


def _fill(figures: dict[str, Array], index: Indices, columns: Mapping[str, Callable[[], Array]]) -> None:
    """Set the figures of the designs at `index`; columns of figures that are not among `figures` are not computed."""
    for name, column in columns.items():
        if name in figures:
            figures[name][index] = column()


def _acute_angle(sine: Array | None, count: int, smooth: Mask) -> Array:
    """Least acute angle, degrees (m,), from its signed sine (m, n), 0 where that changes sign; 90 degrees for None."""
    if sine is None:
        return np.full(count, 90.0)
    smallest = np.maximum(least(np.abs(sine), smooth), 0.0)
    smallest[(sine.min(axis=1) < 0.0) & (sine.max(axis=1) > 0.0)] = 0.0
    angle: Array = np.degrees(np.arcsin(np.minimum(smallest, 1.0)))
    return angle


def compute_figures(scene: SweepScene, values: Array) -> dict[str, Array]:
    """Figures by name, (m,) each, of designs with `values` (m, axes) in the recipe's units, words by their index.

    Lengths are in mm, angles in degrees. Under REASON is the index into `REASONS`, 0 for a design without a fault that
    keeps the limits. Figures not computed are nan, dwells of a design that breaks a limit on another figure -inf.
    Raises ValueError for a dwell in a recipe without a band.
    """
    table = _evaluator(scene).evaluate(values)
    return {**table.figures, REASON: table.reason.astype(np.float64)}


@lru_cache(maxsize=1)
def _evaluator(scene: SweepScene) -> Evaluator:
    """The evaluator that all chunks of a sweep share; a process that computes one computes many."""
    # glibc hands the memory of each block back to the system, and takes it again page by page for the next, at a tenth
    # of all time. It keeps what is smaller than the largest piece it was ever given back.
    np.empty(_HEAP)
    return Evaluator.prepare(scene.recipe, scene.paths, figures=scene.figures, screened=scene.screened)
