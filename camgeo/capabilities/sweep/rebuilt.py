"""Designs one by one, each a recipe of its own: recipes without a linkage, and linkages with dyads."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from camgeo.capabilities.sweep.cams import EDGE, FINE, IMPOSSIBLE, OUTSIDE, UNDERCUT
from camgeo.capabilities.sweep.keys import varied
from camgeo.capabilities.sweep.linkages import angles
from camgeo.checks.declared import BENT, UNDERCUT_GLOBAL, UNDERCUT_LOCAL
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.loading import load_text
from camgeo.recipe.part import Part
from camgeo.schema.errors import RecipeErrors
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.recipe.recipe import Recipe
    from kin.law.support_function import Lift
    from kin.linkage.mechanism import Mechanism

Array: TypeAlias = NDArray[np.float64]
Codes: TypeAlias = NDArray[np.uint8]

CUT = BENT | {UNDERCUT_LOCAL.name, UNDERCUT_GLOBAL.name}
_ROUND = 720  # angles at which faces are held against the shaft


@dataclass(frozen=True, eq=False)
class Rows:
    """What `LoopArrays` (`linkages`) knows of m mechanisms at n relative angles, (m, n) each."""

    output: Array
    rate: Array
    second: Array
    frame: Array
    frame_rate: Array
    frame_second: Array
    transmission: Array
    force: Array

    def part(self, rows: NDArray[np.bool_]) -> Rows:
        """Return some of them."""
        return Rows(*(column[rows] for column in vars(self).values()))


def words_of(recipe: Recipe) -> dict[str, tuple[str, ...]]:
    """The words that a recipe's sweep varies, by their paths."""
    return {axis.path: axis.words for axis in varied(recipe) if axis.words}


def text_with(recipe: Recipe, values: Mapping[str, float]) -> str:
    """The text of a recipe with values put in by their paths, of words by their count. Raises as `recipe_with`."""
    words = words_of(recipe)
    chosen = {path: words[path][int(value)] for path, value in values.items() if path in words}
    worded = replace(recipe, text=recipe.changed(chosen)) if chosen else recipe
    return worded.text_with({path: value for path, value in values.items() if path not in words})


def recipe_with(recipe: Recipe, paths: Sequence[str], values: Sequence[float] | Array) -> Recipe:
    """Give the recipe with values put in at paths. RecipeErrors where it is none; ValueError for a wrong path."""
    given = {path: float(value) for path, value in zip(paths, values, strict=True)}
    return load_text(text_with(recipe, given), recipe.path)


def plain(recipe: Recipe, paths: Sequence[str], values: Array, names: Sequence[str]) -> tuple[dict[str, Array], Codes]:
    """Figures by name, (m,) each, lengths in mm and angles in degrees, and what is wrong (m,).

    Of the part there is nothing but the contour, as a bore has no bearing on these, unless a figure is of the part too.
    """
    from camgeo.measures.figures import of_design
    from camgeo.synthesis.design import designed

    m, whole = len(values), any(FIGURES[name].needs.part for name in names)
    figures, fault = {name: np.full(m, np.nan) for name in names}, np.full(m, IMPOSSIBLE, dtype=np.uint8)
    for i, row in enumerate(values):
        try:
            made = replace(recipe_with(recipe, paths, row), manufacture=None, wheel=None)
            made = made if whole else replace(made, part=Part())
            design = designed(made)
        except RecipeErrors:
            continue
        lift = design.exact.plate
        if lift is not None and _outside(lift):
            fault[i] = OUTSIDE
            continue
        if not design.contours:
            undercut = any(not check.ok and check.name in CUT for check in design.checks)
            fault[i] = UNDERCUT if undercut else IMPOSSIBLE  # there is no room for its openings
            continue
        for name, measured in of_design(made, design, design.checks, names).items():
            figures[name][i] = np.nan if measured.value is None else measured.value
        fault[i] = FINE
    return figures, fault


def _outside(lift: Lift) -> bool:
    """Whether the shaft lies outside the contour: some face would have to pass it."""
    p = lift.derivatives(angles(_ROUND), 0)[0]
    return bool(p.min() < -EDGE * p.max())


def chains(recipe: Recipe, paths: Sequence[str], values: Array, count: int) -> tuple[Array, Rows]:
    """Sample mechanisms with dyads: least margin of any loop (m,), mm, and their motion, nan where a loop binds."""
    m = len(values)
    margin = np.full(m, -np.inf)
    rows = Rows(*(np.full((m, count), np.nan) for _ in range(8)))
    for i, row in enumerate(values):
        margin[i] = _chain(recipe_with(recipe, paths, row), count, [column[i] for column in vars(rows).values()])
    return margin, rows


def mechanism_in(recipe: Recipe) -> Mechanism:
    """The mechanism of a recipe with a linkage. TypeError for one on a cam without a lift, which no recipe has."""
    from camgeo.cams.flat_faced import breadth_of
    from camgeo.synthesis.linkage import mechanism_of

    lift = recipe.cam.exact().plate
    if lift is None:
        raise TypeError("a linkage is driven by the lift of a frame")
    return mechanism_of(recipe, lift, breadth_of(lift)[0])


def _chain(recipe: Recipe, count: int, rows: list[Array]) -> float:
    """Fill in the rows (n,) of one mechanism, and return its least margin: -inf where it binds."""
    from kin.linkage.loop import BindingError

    mechanism = mechanism_in(recipe)
    theta = angles(count)
    try:
        at = mechanism.at(theta, 2)
        margin = min(
            float(mechanism.chain.margins(loop, at.faces[0, 0], at.faces[1, 0], mechanism.about).min())
            for loop in range(mechanism.outputs)
        )
    except BindingError:
        return -np.inf
    linkage, positions = mechanism.linkage, at.solved.linkage
    sines = linkage.transmission(positions)[0], np.abs(linkage.force(positions, *at.faces[:, 1])[0])
    for row, values in zip(rows, (*at.output, *at.frame, *sines), strict=True):
        row[:] = values
    return margin
