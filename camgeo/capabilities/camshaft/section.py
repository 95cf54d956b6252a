"""The camshaft's section of a report: where its lobes stand, when they lift, how it is balanced."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.camshaft.events import CYCLE
from camgeo.capabilities.camshaft.lobes import valves
from camgeo.measures.balance import KG

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe


def camshaft_section(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> dict[str, Any]:
    """Section `camshaft` of the report: lobes, valve events of an engine, and unbalance.

    Lengths are in the recipe's unit, angles in degrees. Raises RecipeErrors and EventError as `PlacedLobe.event_lift`
    does.
    """
    section: dict[str, Any] = {"lobes": [_lobe(recipe, lobe) for lobe in lobes]}
    if recipe.engine is not None:
        section["cylinders"] = [
            {"cylinder": cylinder, **events._asdict()}
            for cylinder in recipe.engine.firing
            if (events := valves(lobes, recipe.engine, cylinder)) is not None
        ]
    balance = _balance(recipe, lobes)
    return section if balance is None else {**section, "balance": balance}


def _lobe(recipe: CamshaftRecipe, lobe: PlacedLobe) -> dict[str, Any]:
    lift = lobe.event_lift(recipe.engine)
    entry: dict[str, Any] = {
        "name": lobe.lobe.name,
        "recipe": lobe.lobe.recipe.path.name,
        "at_deg": math.degrees(lobe.at),
        "zero_deg": math.degrees(lobe.zero) % 360.0,
        "from": lobe.lobe.low / recipe.mm,
        "to": lobe.lobe.high / recipe.mm,
        "lift": math.degrees(lift) if lobe.swings else lift / recipe.mm,
    }
    event = lobe.event(lift)
    if event is None:
        return {**entry, "opens_deg": None, "closes_deg": None, "centre_deg": None, "duration_deg": None}
    angles = {"opens_deg": event.opens, "closes_deg": event.closes, "centre_deg": event.centre}
    entry = {**entry, **angles, "duration_deg": event.duration}
    if recipe.engine is not None:
        entry["opens_crank_deg"] = 2.0 * event.opens % CYCLE
        entry["closes_crank_deg"] = 2.0 * event.closes % CYCLE
    return entry


def _balance(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> dict[str, Any] | None:
    """Unbalance of the lobes, and its couple about the middle of the shaft; None where a density or contour is missing.

    U = sum of m_k times the centre of mass, M = sum of U_k (z_k - z_0) (THEORY: balance in two planes); round parts
    about the axis add nothing to either.
    """
    from camgeo.curve.measures import moments

    middle = 0.5 * (recipe.bars[0].low + recipe.bars[0].high)
    total, couple = 0.0 + 0.0j, 0.0 + 0.0j
    for lobe in lobes:
        density, contour = lobe.lobe.recipe.part.density, lobe.contour
        if density is None or contour is None:
            return None
        # integrals of x and of y over the lobe's section, mm^3: its area times the place of its centre
        integral, length = moments(contour), lobe.lobe.high - lobe.lobe.low
        unbalance = density * KG * length * complex(integral.x, integral.y) * np.exp(1j * lobe.at)
        total += unbalance
        couple += unbalance * (0.5 * (lobe.lobe.high + lobe.lobe.low) - middle)
    turned = -1.0 if recipe.rotation == "ccw" else 1.0
    return {
        "unbalance_kg_mm": abs(total),
        "unbalance_deg": turned * math.degrees(math.atan2(total.imag, total.real)) % 360.0,
        "couple_kg_mm2": abs(couple),
        "couple_deg": turned * math.degrees(math.atan2(couple.imag, couple.real)) % 360.0,
        "about_z": middle / recipe.mm,
    }
