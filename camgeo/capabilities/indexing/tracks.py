"""Tracks of rollers in one layer of an indexing cam, all turns of one roller as one line; the rib between them."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.flank import Contact
    from camgeo.capabilities.indexing.forms import Pose
    from kin.numeric.arrays import Array

LAYERS = 5  # from floor to blank, in which a cam is sampled
STEPS = 1440  # places of a turn at which a track is known
PASSED = 8  # of these places that a roller has to be within the cam at least


@lru_cache(maxsize=2)
def passed(design: IndexDesign) -> tuple[Array, Pose]:
    """Shaft angles (n,), rad, at which the roller that stands at the start after no turn may touch the cam; the turret.

    Raises RecipeErrors where a step is so short that there are next to none.
    """
    turns = design.turns
    steps = np.arange(turns.start * STEPS, turns.stop * STEPS + 1) * (TURN / STEPS)
    theta = np.unique(np.concatenate([steps, design.law.breaks_over(turns.start, turns.stop - 1)]))
    psi = design.recipe.start + design.law.derivatives(theta, 0)[0]
    low, high = design.spanned
    way = np.abs(np.diff(psi))
    if PASSED * float(way.max()) > high - low:
        at = math.degrees(theta[int(way.argmax())]) % 360.0
        problem = f"the turret takes a roller past the cam within {PASSED * 360.0 / STEPS:.6g} degrees"
        raise design.error("cam.motion", f"{problem}, near {at:.6g} degrees", "give a longer rise")
    near = np.flatnonzero((psi >= low) & (psi <= high))
    if not near.size:
        problem = f"the turret takes a roller past the cam within {360.0 / STEPS:.6g} degrees"
        raise design.error("cam.motion", problem, "give a longer rise")
    theta = theta[near[0] : near[-1] + 1]
    return theta, design.flanks["lower"].pose(theta)


@lru_cache(maxsize=4 * LAYERS)  # those of two designs: regularity, ribs and figures ask for the same layers
def track(design: IndexDesign, name: str, w: float) -> tuple[Array, Contact]:
    """Shaft angles (n,), rad, and contacts of a flank in a layer, mm.

    Raises CurveError where a roller does not touch the layer.
    """
    theta, pose = passed(design)
    return theta, design.flanks[name].touching(theta, pose, w)


def rib_thickness(design: IndexDesign) -> tuple[float, float]:
    """Least thickness of the rib, mm, and the shaft angle at which its lower roller is there, rad.

    It is measured along the cam's axis, in a globoid along arcs about the turret's axis. It is sampled at floor, middle
    and blank, where both sides of the rib lie within the cam. Where the rollers leave no rib, and it is 0 or less, one
    side is enough. It is infinite without such a place.
    """
    recipe, found = design.recipe, []
    for w in np.linspace(*recipe.layers, 3).tolist():
        (_, lower), (theta, upper) = track(design, "lower", w), track(design, "upper", w)
        low, high = recipe.form.ends(w)
        phi = upper.phi + TURN  # where the next roller comes after
        inside = (phi >= lower.phi[0]) & (phi <= lower.phi[-1])
        above = np.interp(phi[inside], lower.phi, lower.h)
        below = upper.h[inside]
        both = (above > low) & (above < high) & (below > low) & (below < high)
        between = both | ((above <= below) & (above > low) & (below < high))
        thick = recipe.form.unit(w) * (above - below)[between]
        if thick.size:
            i = int(np.argmin(thick))
            found.append((float(thick[i]), float(theta[inside][between][i])))
    return min(found, default=(np.inf, 0.0))


def removed(design: IndexDesign, w: float) -> float:
    """Area, mm^2, that all rollers together take out of a layer, mm."""
    form = design.recipe.form
    ends = np.array(form.ends(w))
    base, most = form.area(w, ends)
    taken, last = {}, {}
    for name in design.flanks:
        _, rows = track(design, name, w)
        below = form.area(w, np.clip(rows.h, *ends)) - base
        taken[name] = float(np.sum(0.5 * (below[1:] + below[:-1]) * np.diff(rows.phi)))
        last[name] = float(rows.phi[-1])
    return taken["upper"] - taken["lower"] + float(most - base) * (last["lower"] - last["upper"])
