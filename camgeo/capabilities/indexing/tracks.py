"""Tracks of rollers in one layer of an indexing cam, all turns of one roller as one line; the rib between them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign
    from kin.numeric.arrays import Array

STEPS = 1440  # places of a turn at which a track is known


class Track(NamedTuple):
    """A flank in a layer: shaft angles, polar angles, rad, heights h, mm or rad, and D, mm; (n,) each."""

    theta: Array
    phi: Array
    h: Array
    regular: Array


def angles(design: IndexDesign) -> Array:
    """Shaft angles (n,), rad, at which the roller that stands at the start after no turn may touch the cam."""
    turns = design.turns
    steps = np.arange(turns.start * STEPS, turns.stop * STEPS + 1) * (TURN / STEPS)
    breaks = (design.law.breaks[None, :] + TURN * np.arange(turns.start, turns.stop)[:, None]).ravel()
    theta = np.unique(np.concatenate([steps, breaks]))
    psi = design.recipe.start + design.law.derivatives(theta, 0)[0]
    low, high = design.spanned
    near = np.flatnonzero((psi >= low) & (psi <= high))
    return theta[near[0] : near[-1] + 1]


def track(design: IndexDesign, name: str, w: float) -> Track:
    """A flank in a layer, mm; raises CurveError where a roller does not touch it at one place."""
    theta = angles(design)
    line = design.lines[name].on(theta, w)
    beside, _, h = line.place
    return Track(theta, theta + beside, h, line.regular)


def rib_thickness(design: IndexDesign) -> tuple[float, float]:
    """Least thickness of the rib within the cam, mm, and the shaft angle at which its lower roller is there, rad.

    It is measured along the cam's axis, in a globoid along arcs about the turret's axis, at floor, middle and blank.
    """
    recipe, found = design.recipe, []
    for w in np.linspace(*recipe.layers, 3).tolist():
        lower, upper = track(design, "lower", w), track(design, "upper", w)
        low, high = recipe.turret.ends(w, recipe.length)
        phi = upper.phi + TURN  # where the next roller comes after
        inside = (phi >= lower.phi[0]) & (phi <= lower.phi[-1])
        above = np.interp(phi[inside], lower.phi, lower.h)
        between = (above > low) & (upper.h[inside] < high)
        thick = recipe.turret.thickness(w, above - upper.h[inside])[between]
        if thick.size:
            i = int(np.argmin(thick))
            found.append((float(thick[i]), float(upper.theta[inside][between][i])))
    return min(found, default=(np.inf, 0.0))


def removed(design: IndexDesign, w: float) -> float:
    """Area, mm^2, that all rollers together take out of a layer, mm."""
    turret = design.recipe.turret
    ends = np.array(turret.ends(w, design.recipe.length))
    base, most = turret.across(np.full(2, w), ends)
    taken, last = {}, {}
    for name in design.lines:
        rows = track(design, name, w)
        below = turret.across(np.full(rows.h.shape, w), np.clip(rows.h, *ends)) - base
        taken[name] = float(np.sum(0.5 * (below[1:] + below[:-1]) * np.diff(rows.phi)))
        last[name] = float(rows.phi[-1])
    return taken["upper"] - taken["lower"] + float(most - base) * (last["lower"] - last["upper"])
