"""The exact cylindrical cam of a recipe."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.design import DrumDesign, in_recipe
from camgeo.capabilities.cylindrical.soundness import demand_sound
from kin.law.normalised import IntentError

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe
    from camgeo.common.clock import Clock
    from camgeo.motions.stated import StatedMotion
    from kin.numeric.arrays import Array


def designed(recipe: DrumRecipe, clock: Clock) -> DrumDesign:
    """The exact cam of a recipe; raises RecipeErrors where there is none."""
    with clock.stage("motion"):
        design = moved(recipe)
    with clock.stage("undercut"):
        demand_sound(design)
    return design


def moved(recipe: DrumRecipe) -> DrumDesign:
    """The cam of a recipe, its flanks not yet checked; raises RecipeErrors where its motion cannot be made."""
    try:
        motion = recipe.motion.motion(recipe.period, "cam.motion", 1)
        law = motion.periodic("cam.motion", "rad" if recipe.swings else "mm")
    except IntentError as error:
        raise recipe.error(recipe.stated(error.field), in_recipe(recipe, error.message)) from error
    return DrumDesign(recipe, motion, law)


def stated_motion(design: DrumDesign) -> StatedMotion:
    """The motion over the shaft angle, as the recipe states it."""
    from camgeo.motions.stated import StatedMotion

    recipe = design.recipe

    def lift(theta: Array) -> Array:
        flat = np.asarray(theta, dtype=np.float64).ravel()
        return np.asarray(design.law.derivatives(flat, 0)[0].reshape(np.shape(theta)))

    shown = math.degrees(1.0) if recipe.swings else 1.0 / recipe.mm
    return StatedMotion(recipe.motion, recipe.period, recipe.motion.repeats, "same", lift, math.degrees(1.0), shown)
