"""Figures of many designs at once: what a sweep ranks by and limits.

Designs that differ in the place of the shaft, the lengths of a linkage and the harmonics of a cam are computed
together, in blocks that stay in the cache; other fields of a cam cost one evaluation of its lift for each distinct cam.
Dyads, and recipes without a linkage, are computed one by one (`rebuilt`). All is sampled at the recipe's `angles`,
a multiple of 4, and rounded so that it does not depend on which designs are computed together.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from camgeo.capabilities.sweep import rebuilt
from camgeo.capabilities.sweep.cams import BINDS, BROKEN, FINE, IMPOSSIBLE, REVERSES, Cams
from camgeo.capabilities.sweep.ends import Ends, cell_bounds, ends, greatest, least, lengths
from camgeo.capabilities.sweep.gather import REASON
from camgeo.capabilities.sweep.keys import Sweep, swept, varied
from camgeo.capabilities.sweep.linkages import Lengths, angles, engine
from camgeo.capabilities.sweep.windows import Samples, longest
from camgeo.recipe.figures import CONTACT_TRAVEL, DWELL, RADIUS, SIZE
from camgeo.recipe.linkage import output_slides
from camgeo.schema.errors import RecipeErrors
from kin.linkage.loop import side_of
from kin.numeric.records import dataclass, full_text, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.cams.family import Cam
    from camgeo.capabilities.sweep.screen import Screen
    from camgeo.recipe.limits import Limit
    from camgeo.recipe.recipe import Recipe
    from kin.linkage.four_bar import Linkage

Array: TypeAlias = NDArray[np.float64]
Codes: TypeAlias = NDArray[np.uint8]

# Why a design has no figures, or not all; by number.
REASONS = ("", "impossible", "undercut", "shaft-outside", "binds", "reverses", "limits")
BLOCK = 11_520  # samples of a block: a dozen arrays of them stay in a cache of 1 MB
_SAMPLES = 360
DWELLS = (DWELL, "dwell-relative")
_HEAP = 3 << 20  # numbers, 24 MB


class FigureTable(NamedTuple):
    """Figures by name, (m,) each, in mm and degrees, rates by radian of the shaft; and a number of REASONS, (m,)."""

    figures: dict[str, Array]
    reason: Codes


@dataclass(frozen=True)
class Scene:
    """What is computed of each design of a sweep: plain data that travels to any worker, and is part of the key.

    A recipe with its sweep, without what has no bearing on a figure, and the names of the figures wanted; estimates
    where it is `screened`. `others` are the cams that it is with other words, whose tables are part of the key.
    """

    recipe: Recipe
    figures: tuple[str, ...]
    screened: bool = False
    others: tuple[Cam, ...] = ()

    def __repr__(self) -> str:
        """Write all of it, as the key is made of this; a recipe's own `repr` is its name."""
        told = f"figures={self.figures!r}, screened={self.screened!r}, others={self.others!r}"
        return f"Scene(recipe={full_text(self.recipe)}, {told})"

    @property
    def paths(self) -> tuple[str, ...]:
        """The fields that vary."""
        return tuple(axis.path for axis in varied(self.recipe))


def asked_of(recipe: Recipe) -> tuple[str, ...]:
    """Names of the figures that a recipe's designs have."""
    given = {path for path in recipe.marks if path.partition(".")[0] != "part"}
    if recipe.part.density is not None and recipe.linkage is None:
        given.add("part.density")
    if recipe.part.thickness is not None:
        given.add("part.thickness")
    offers = recipe.cam.arrangement.offers
    return tuple(name for name, figure in swept().items() if figure.needs.there(offers, given))


def estimated(recipe: Recipe) -> tuple[str, ...]:
    """Names of those of a cam without a linkage that can be estimated."""
    from camgeo.capabilities.sweep.screen import estimates

    return tuple(name for name in asked_of(recipe) if name in estimates())


class _Motion(Protocol):
    """Samples of m mechanisms, (m, n) each, as `Loop` has them."""

    @property
    def output(self) -> Array: ...
    @property
    def rate(self) -> Array: ...
    @property
    def second(self) -> Array: ...
    @property
    def frame(self) -> Array: ...
    @property
    def frame_rate(self) -> Array: ...
    @property
    def frame_second(self) -> Array: ...
    @property
    def transmission(self) -> Array | None: ...
    @property
    def force(self) -> Array: ...
    def part(self, rows: NDArray[np.bool_], /) -> _Motion: ...


@dataclass(frozen=True)
class Evaluator:
    """Computes the figures `wanted` of designs that differ at `paths`; what they share is prepared once."""

    recipe: Recipe
    paths: tuple[str, ...]
    wanted: tuple[str, ...]
    limits: tuple[Limit, ...]
    count: int
    screened: bool = False

    @staticmethod
    def of(
        recipe: Recipe,
        paths: Sequence[str],
        *,
        figures: Sequence[str] | None = None,
        samples: int | None = None,
        screened: bool = False,
    ) -> Evaluator:
        """Prepare for designs in which the fields at `paths` differ.

        `figures`, if given, are those wanted besides those limited. `samples` is their number, raised to a multiple
        of 4. Cams without a linkage are estimated where they are `screened` and can be. Raises ValueError for a path at
        which no number stands.
        """
        sweep = recipe.of(Sweep)
        limits = sweep.limits if sweep else ()
        wanted = figures or (estimated(recipe) if screened and recipe.linkage is None else asked_of(recipe))
        wanted = tuple(dict.fromkeys((*wanted, *(limit.figure for limit in limits))))
        count = samples or (sweep.angles if sweep else _SAMPLES)
        worded = rebuilt.words_of(recipe)
        recipe.text_with({path: 1.0 for path in paths if path not in worded})  # raises where no number stands
        return Evaluator(recipe, tuple(paths), wanted, limits, -(-count // 4) * 4, screened)

    @cached_property
    def worded(self) -> tuple[int, ...]:
        """Columns of the words that vary."""
        words = rebuilt.words_of(self.recipe)
        return tuple(column for column, path in enumerate(self.paths) if path in words)

    def _with_words(self, chosen: tuple[float, ...]) -> Evaluator | None:
        """What computes the designs that have words in common, by their counts; None where there is no such recipe."""
        if chosen not in self._by_words:
            words = [self.paths[column] for column in self.worded]
            left = tuple(path for path in self.paths if path not in words)
            try:
                made = rebuilt.recipe_with(self.recipe, words, chosen)
            except RecipeErrors:
                self._by_words[chosen] = None
            else:
                recipe = replace(self.recipe, cam=made.cam, linkage=made.linkage, text=made.text)
                self._by_words[chosen] = replace(self, recipe=recipe, paths=left)
        return self._by_words[chosen]

    @cached_property
    def _by_words(self) -> dict[tuple[float, ...], Evaluator | None]:
        return {}

    def _each_word(self, values: Array) -> FigureTable:
        """The figures of designs by the words that they have."""
        m = len(values)
        figures = {name: np.full(m, np.nan) for name in self.wanted}
        reason = np.full(m, IMPOSSIBLE, dtype=np.uint8)
        distinct, which = np.unique(values[:, self.worded], axis=0, return_inverse=True)
        others = np.delete(values, self.worded, axis=1)
        for i, chosen in enumerate(distinct):
            rows, evaluator = np.flatnonzero(which.reshape(-1) == i), self._with_words(tuple(chosen.tolist()))
            if evaluator is not None:
                found = evaluator.found(others[rows])
                reason[rows] = found.reason
                for name, column in found.figures.items():
                    figures[name][rows] = column
        return FigureTable(figures, reason)

    @cached_property
    def screen(self) -> Screen | str:
        """What estimates figures of cams without a linkage, or why nothing does; of words, with those of the recipe."""
        from camgeo.capabilities.sweep.screen import Screen

        if self.worded:
            return replace(self, paths=tuple(np.delete(self.paths, self.worded).tolist())).screen
        return Screen.of(self.recipe, self.paths, self.wanted, self.count)

    @property
    def estimator(self) -> Screen | None:
        """The screen, where figures are to be estimated and can be."""
        screen = self.screen if self.screened else ""
        return None if isinstance(screen, str) else screen

    @cached_property
    def cams(self) -> Cams:
        """Where the cams come from."""
        return Cams.of(self.recipe, self.paths, self.count)

    @property
    def slow(self) -> bool:
        """Whether designs are made one by one."""
        linkage = self.recipe.linkage
        if linkage is None:
            return self.estimator is None
        if self.worded:
            return replace(self, paths=tuple(np.delete(self.paths, self.worded).tolist())).slow
        return bool(linkage.dyads) or bool(self.cams.others)

    @cached_property
    def scale(self) -> float:
        """What the output is reported in: mm as it is, rad in degrees."""
        linkage = self.recipe.linkage
        return 1.0 if linkage is not None and output_slides(linkage) else math.degrees(1.0)

    def found(self, values: Array) -> FigureTable:
        """Give the figures of designs with values (m, k) at the paths, as the recipe writes them.

        A design that does not exist or does not turn has nan for all figures. One that breaks a limit of the recipe's
        sweep is computed no further: its dwells are -inf.
        """
        m = len(values)
        values = np.asarray(values, dtype=float).reshape(m, len(self.paths))
        if self.worded:
            return self._each_word(values)
        figures = {name: np.full(m, np.nan) for name in self.wanted}
        reason = np.zeros(m, dtype=np.uint8)
        if self.recipe.linkage is None:
            if self.estimator is None:
                found, reason[:] = rebuilt.plain(self.recipe, self.paths, values, tuple(figures))
            else:
                found, reason[:] = self.estimator.found(values)
            figures.update(found)
            reason[(reason == FINE) & self._broken(figures)] = BROKEN
            return FigureTable(figures, reason)
        rows = max(1, BLOCK // self.count)
        kept: list[tuple[NDArray[np.intp], dict[str, Ends]]] = []
        for first in range(0, m, rows):
            block = slice(first, min(first + rows, m))
            here = {name: column[block] for name, column in figures.items()}
            index, windows = self._block(values[block], here, reason[block])
            kept.append((index + first, windows))
        for name in DWELLS:
            if name in figures:
                figures[name][reason == BROKEN] = -np.inf
                parts = [windows[name] for index, windows in kept if len(index)]
                if parts:
                    at = np.concatenate([index for index, _ in kept])
                    figures[name][at] = np.degrees(lengths(Ends.joined(parts), self._band))
        bad = (reason != FINE) & (reason != BROKEN)
        for column in figures.values():
            column[bad] = np.nan
        reason[(reason == FINE) & self._broken(figures)] = BROKEN
        return FigureTable(figures, reason)

    @property
    def _band(self) -> float:
        dwell = self.recipe.dwell
        if dwell is None:
            raise ValueError(f"{self.recipe.name}: a dwell needs a band")
        return dwell.band

    def _broken(self, figures: dict[str, Array]) -> NDArray[np.bool_]:
        """Which designs break a limit on a figure known by now."""
        broken = np.zeros(len(next(iter(figures.values()))), dtype=np.bool_)
        for limit in self.limits:
            values = figures[limit.figure]
            if limit.at_least is not None:
                broken |= values < limit.at_least
            if limit.at_most is not None:
                broken |= values > limit.at_most
        return broken

    def _block(
        self, values: Array, figures: dict[str, Array], reason: Codes
    ) -> tuple[NDArray[np.intp], dict[str, Ends]]:
        """Fill in figures and reasons (m,) of a block; and give what the dwells of some designs (k,) are made of."""
        cams = self.cams.sampled(values)
        reason[:] = cams.fault
        alive = reason == FINE
        if RADIUS in figures:
            figures[RADIUS][:] = cams.radius
        if CONTACT_TRAVEL in figures:
            figures[CONTACT_TRAVEL][:] = greatest(cams.support.dp, cams.smooth) - least(cams.support.dp, cams.smooth)
        if SIZE in figures:
            square = cams.support.p * cams.support.p
            square += cams.support.dp * cams.support.dp
            figures[SIZE][:] = np.sqrt(greatest(square, cams.smooth))
        alive = self._keep(alive, figures, reason)
        index = np.flatnonzero(alive)
        if not index.size:
            return index, {}
        motion: _Motion
        linkage = self.recipe.linkage
        if linkage is None or linkage.dyads:
            margin, motion = rebuilt.chains(self.recipe, self.paths, values[index], self.count)
        else:
            support = cams.support if alive.all() else cams.support.part(alive)
            kind, side = engine(linkage.loop), side_of(linkage.loop.assembly)
            loop = kind.of(side, support, self._lengths(linkage.loop, kind.dimensions, values[index]))
            smooth = cams.smooth[index]
            margin, motion = loop.margin(lambda rows: least(rows, smooth)), loop
        if "margin" in figures:
            figures["margin"][index] = margin
        reason[index[~(margin > 0.0)]] = BINDS
        index, motion = self._still(index, motion, margin > 0.0, figures, reason)
        if index.size:
            smooth = cams.smooth[index]
            rate = least(1.0 - motion.frame_rate, smooth)
            if "shaft-rate" in figures:
                figures["shaft-rate"][index] = rate
            reason[index[~(rate > 0.0)]] = REVERSES
            if "transmission-angle" in figures:
                figures["transmission-angle"][index] = _acute(motion.transmission, len(index), smooth)
            if "force-angle" in figures:
                figures["force-angle"][index] = _acute(motion.force, len(index), smooth)
            index, motion = self._still(index, motion, rate > 0.0, figures, reason)
        if index.size:
            self._moving(index, motion, figures, cams.smooth[index])
            index, motion = self._still(index, motion, np.ones(len(index), dtype=np.bool_), figures, reason)
        return index, self._windows(motion) if index.size else {}

    def _keep(self, alive: NDArray[np.bool_], figures: dict[str, Array], reason: Codes) -> NDArray[np.bool_]:
        broken = alive & self._broken(figures)
        reason[broken] = BROKEN
        return alive & ~broken

    def _still(
        self,
        index: NDArray[np.intp],
        motion: _Motion,
        alive: NDArray[np.bool_],
        figures: dict[str, Array],
        reason: Codes,
    ) -> tuple[NDArray[np.intp], _Motion]:
        """Leave out the designs that are no longer alive and those that break a limit."""
        alive = self._keep(alive, {name: column[index] for name, column in figures.items()}, part := reason[index])
        reason[index] = part
        return (index, motion) if alive.all() else (index[alive], motion.part(alive))

    def _moving(
        self, index: NDArray[np.intp], motion: _Motion, figures: dict[str, Array], smooth: NDArray[np.bool_]
    ) -> None:
        """Fill in the figures of the output."""
        turn = 1.0 - motion.frame_rate
        if "swing" in figures:
            output = motion.output
            figures["swing"][index] = self.scale * (greatest(output, smooth) - least(output, smooth))
        if "peak-velocity" in figures:
            figures["peak-velocity"][index] = self.scale * greatest(np.abs(motion.rate / turn), smooth)
        if "peak-acceleration" in figures:
            # (f'/phi')'/phi' with phi'' = -theta_3''
            bent = motion.second * turn
            bent += motion.rate * motion.frame_second
            bent /= turn * turn * turn
            figures["peak-acceleration"][index] = self.scale * greatest(np.abs(bent), smooth)

    def _windows(self, motion: _Motion) -> dict[str, Ends]:
        names = [name for name in DWELLS if name in self.wanted]
        if not names:
            return {}
        output = motion.output, motion.rate
        bounds = cell_bounds(*output)
        theta = np.broadcast_to(angles(self.count), output[0].shape)
        over = {
            DWELL: (theta - motion.frame, 1.0 - motion.frame_rate),
            "dwell-relative": (theta, np.ones_like(theta)),
        }
        abscissae = np.stack([over[name][0] for name in names])
        start, cells = longest(Samples(output[0], *bounds, abscissae), self._band)
        return {name: ends((start[k], cells[k]), output, over[name], bounds) for k, name in enumerate(names)}

    def _lengths(self, linkage: Linkage, dimensions: tuple[str, ...], values: Array) -> Lengths:
        """Dimensions, of those that there are, of linkages that differ from this one in the values (m, k)."""
        numbers, columns = vars(linkage), []
        for name in Lengths._fields:
            path = f"linkage.{name}"
            if path in self.paths:
                column = self.paths.index(path)
                columns.append(values[:, column : column + 1] * self.recipe.mm)
            else:
                columns.append(np.full((len(values), 1), numbers[name] if name in dimensions else 0.0))
        return Lengths(*columns)


def _acute(sine: Array | None, count: int, smooth: NDArray[np.bool_]) -> Array:
    """Least angle, degrees (m,), of which the signed sine (m, n) is given; 90 degrees where there is none."""
    if sine is None:
        return np.full(count, 90.0)
    smallest = np.maximum(least(np.abs(sine), smooth), 0.0)
    smallest[(sine.min(axis=1) < 0.0) & (sine.max(axis=1) > 0.0)] = 0.0
    found: Array = np.degrees(np.arcsin(np.minimum(smallest, 1.0)))
    return found


def figures(scene: Scene, values: Array) -> dict[str, Array]:
    """Figures of designs with the values (m, axes) of the scene's sweep, and why a design has none, as a number."""
    found = _evaluator(scene).found(values)
    return {**found.figures, REASON: found.reason.astype(np.float64)}


@lru_cache(maxsize=1)
def _evaluator(scene: Scene) -> Evaluator:
    """What the chunks of a sweep share; a process that computes one computes many."""
    # glibc hands the memory of each block back to the system, and takes it again page by page for the next, at a tenth
    # of all time. It keeps what is smaller than the largest piece it was ever given back.
    np.empty(_HEAP)
    return Evaluator.of(scene.recipe, scene.paths, figures=scene.figures, screened=scene.screened)
