"""Designs computed one by one, each as a recipe of its own: cams without a linkage, and linkages with dyads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.cams import EDGE, FINE, IMPOSSIBLE, OUTSIDE, UNDERCUT
from camgeo.capabilities.sweep.keys import varied_fields
from camgeo.capabilities.sweep.linkages import angles
from camgeo.checks.declared import BENT, UNDERCUT_GLOBAL, UNDERCUT_LOCAL
from camgeo.part.part import Part
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.capabilities.sweep.cams import Codes
    from camgeo.recipe.recipe import Recipe
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array, Mask

UNDERCUTS = BENT | {UNDERCUT_LOCAL.name, UNDERCUT_GLOBAL.name}
_ANGLES = 720  # at which the support of a plate is compared with 0


@dataclass(frozen=True, eq=False)
class MotionRows:
    """Motion of m mechanisms at n relative angles, (m, n) each.

    `output`, mm or rad, and `frame`, the frame's angle, rad, have the first derivatives `rate` and `frame_rate` and the
    second ones `second` and `frame_second` by the relative angle. `transmission` is the sine of the transmission angle,
    with a sign, `force` the sine of the force angle, at least 0.
    """

    output: Array
    rate: Array
    second: Array
    frame: Array
    frame_rate: Array
    frame_second: Array
    transmission: Array
    force: Array

    def part(self, rows: Mask) -> MotionRows:
        """The rows (m,) that are true in a mask."""
        return MotionRows(*(column[rows] for column in vars(self).values()))


def word_lists(recipe: Recipe) -> dict[str, tuple[str, ...]]:
    """Words that a recipe's sweep varies, by the path of their field."""
    return {axis.path: axis.words for axis in varied_fields(recipe) if axis.words}


def text_with(recipe: Recipe, values: Mapping[str, float]) -> str:
    """Text of a recipe with values, in its units, at paths; words are given by their index.

    Raises CallError, a ValueError, for a path at which no number stands.
    """
    words = word_lists(recipe)
    chosen = {path: words[path][int(value)] for path, value in values.items() if path in words}
    variant = replace(recipe, text=recipe.changed(chosen)) if chosen else recipe
    return variant.text_with({path: value for path, value in values.items() if path not in words})


def recipe_with(recipe: Recipe, paths: Sequence[str], values: Sequence[float] | Array) -> Recipe:
    """The recipe with values, in its units, at paths; words are given by their index.

    Raises RecipeErrors where that is no recipe, CallError for a path at which no number stands.
    """
    numbers = {path: float(value) for path, value in zip(paths, values, strict=True)}
    return load_text(text_with(recipe, numbers), recipe.path)


def evaluate(
    recipe: Recipe, paths: Sequence[str], values: Array, names: Sequence[str]
) -> tuple[dict[str, Array], Codes]:
    """Figures `names` of m designs, (m,) each, lengths in mm and angles in degrees, and fault codes (m,).

    `values` (m, k) are those at the k paths, in the recipe's units, words by their index. A code is an index into
    REASONS; a design with a fault has nan. Bores and other features are left out unless a figure needs the part.
    """
    from camgeo.measures.figures import design_figures
    from camgeo.synthesis.design import designed

    m, whole = len(values), any(FIGURES[name].needs.part for name in names)
    figures, fault = {name: np.full(m, np.nan) for name in names}, np.full(m, IMPOSSIBLE, dtype=np.uint8)
    for i, row in enumerate(values):
        try:
            single = replace(recipe_with(recipe, paths, row), manufacture=None, wheel=None)
            single = single if whole else replace(single, part=Part())
            design = designed(single)
        except RecipeErrors:
            continue
        lift = design.exact.plate
        if lift is not None and (p := lift.derivatives(angles(_ANGLES), 0)[0]).min() < -EDGE * p.max():
            fault[i] = OUTSIDE  # some face would have to pass the shaft
            continue
        if not design.contours:
            undercut = any(not check.ok and check.name in UNDERCUTS for check in design.checks)
            fault[i] = UNDERCUT if undercut else IMPOSSIBLE  # its openings do not fit
            continue
        for name, measured in design_figures(single, design, design.checks, names).items():
            figures[name][i] = np.nan if measured.value is None else measured.value
        fault[i] = FINE
    return figures, fault


def dyad_motions(recipe: Recipe, paths: Sequence[str], values: Array, count: int) -> tuple[Array, MotionRows]:
    """Least margin of any loop, mm (m,), and the motions of m mechanisms at `count` angles.

    `values` (m, k) are those at the k paths, in the recipe's units. Of a mechanism that binds the margin is -inf and
    the motion nan.
    """
    from kin.linkage.loop import BindingError

    m = len(values)
    margin, rows = np.full(m, -np.inf), MotionRows(*(np.full((m, count), np.nan) for _ in range(8)))
    for i, row in enumerate(values):
        mechanism = mechanism_in(recipe_with(recipe, paths, row))
        try:
            state = mechanism.at(angles(count), 2)
            margin[i] = min(
                float(mechanism.chain.margins(loop, state.faces[0, 0], state.faces[1, 0], mechanism.about).min())
                for loop in range(mechanism.outputs)
            )
        except BindingError:
            continue
        linkage, positions = mechanism.linkage, state.solved.linkage
        sines = linkage.transmission(positions)[0], np.abs(linkage.force_angle(positions, *state.faces[:, 1])[0])
        for column, samples in zip(vars(rows).values(), (*state.output, *state.frame, *sines), strict=True):
            column[i] = samples
    return margin, rows


def mechanism_in(recipe: Recipe) -> Mechanism:
    """Mechanism of a recipe with a linkage. Raises TypeError for a cam without a lift, which no such recipe has."""
    from camgeo.cams.flat_faced import breadth_of
    from camgeo.synthesis.linkage import mechanism_of

    lift = recipe.cam.exact().plate
    if lift is None:
        raise TypeError("a linkage is driven by the lift of a frame")
    return mechanism_of(recipe, lift, breadth_of(lift)[0])
