"""The exact indexing cam of a recipe."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.design import IndexDesign, in_recipe
from camgeo.capabilities.indexing.law import IndexLaw
from camgeo.capabilities.indexing.soundness import demand_room, demand_sound
from kin.law.normalised import IntentError
from kin.law.piecewise import Piecewise
from kin.law.segment import moved
from kin.numeric.angles import TURN
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.index_recipe import IndexRecipe
    from camgeo.common.clock import Clock
    from camgeo.motions.stated import StatedMotion
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array

SAME = 1e-6  # of the advance, by which the digits of a recipe may miss 360/stops degrees
JOINED = 1e-9  # of the greatest velocity, by which those at both ends of the turn may differ
MORE = 3  # turns of the cam that the law knows beyond those in which a roller touches it


def designed(recipe: IndexRecipe, clock: Clock) -> IndexDesign:
    """The exact cam of a recipe; raises RecipeErrors where there is none."""
    with clock.stage("motion"):
        try:
            motion = recipe.motion.motion(TURN, "cam.motion", None).demand_joined("cam.motion", "rad")
        except IntentError as error:
            raise recipe.error(recipe.stated(error.field), in_recipe(recipe, error.message)) from error
        motion = _closed(recipe, motion)
        design = IndexDesign(recipe, motion, IndexLaw(motion.motion, recipe.advance, (0, 1)))
        demand_room(design)
        turns = design.turns
        law = IndexLaw(motion.motion, recipe.advance, (turns.start - MORE, turns.stop + MORE))
    design = replace(design, law=law)
    with clock.stage("undercut"):
        demand_sound(design)
    return design


def _closed(recipe: IndexRecipe, motion: Motion) -> Motion:
    """The motion, scaled by the last digits that a recipe rounds, so that it advances by one pitch of the rollers."""
    end, wanted = float(motion.at_end(0)[0]), recipe.advance
    shown = f"{math.degrees(wanted):.9g} degrees, 360/{recipe.stops}"
    if not abs(end - wanted) <= SAME * wanted:
        problem = f"the turret advances by {math.degrees(end):.9g} degrees a turn, not by {shown}"
        remedy = f"let the motion end {shown}, above its start"
        raise recipe.error(recipe.stated("cam.motion"), problem, None, remedy)
    before, after = float(motion.at_end(1)[1]), float(motion.at_start(1)[1])
    theta = np.linspace(0.0, TURN, 721)
    if abs(before - after) > JOINED * float(np.abs(motion.derivatives(theta, 1)[1]).max()):
        problem = f"the velocity jumps from {before:.6g} to {after:.6g} deg/deg where one turn follows the other"
        remedy = "let the motion begin and end with one velocity, as laws from rest to rest do"
        raise recipe.error(recipe.stated("cam.motion"), problem, None, remedy)
    functions = tuple(moved(each, scale=wanted / end) for each in motion.motion.functions)
    return replace(motion, motion=Piecewise(motion.motion.knots, functions))


def stated_motion(design: IndexDesign) -> StatedMotion:
    """The angle of the turret over the shaft angle, as the recipe states it, from the start on: it does not return."""
    from camgeo.motions.stated import StatedMotion

    recipe = design.recipe

    def lift(theta: Array) -> Array:
        flat = np.asarray(theta, dtype=np.float64).ravel()
        return np.asarray(recipe.start + design.law.derivatives(flat, 0)[0].reshape(np.shape(theta)))

    shown = math.degrees(1.0)
    return StatedMotion(recipe.motion, TURN, recipe.motion.repeats, "nothing", lift, shown, shown)
