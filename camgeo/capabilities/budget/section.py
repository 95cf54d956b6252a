"""The section `budget` of a report, and the sums over the turn as a page plots them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.budget.dimensions import CONTOUR, DIMENSIONS
from camgeo.capabilities.budget.influence import velocities
from camgeo.capabilities.budget.outcome import SUMS, motion_unit, size_unit
from camgeo.capabilities.budget.sums import Sum, Worst, by_name, powers, total, worst
from camgeo.measures.units import UNIT_NAMES
from kin.numeric.angles import TURN, degrees

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.budget.influence import Influence, Output
    from camgeo.capabilities.budget.inverse import Split
    from camgeo.capabilities.budget.outcome import BudgetOutcome
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array

SHARES_STEP = 5  # degrees from one angle of the shares to the next
LEFT_STEP = 10  # degrees from one angle of what is left to the next


def section(recipe: Recipe, outcome: BudgetOutcome, files: Sequence[str] = ()) -> dict[str, Any]:
    """Entry `budget` of a report as plain data: lengths in the recipe's unit, angles in degrees.

    `files` are the names of the files whose contours the outcome has.
    """
    budget, (scale, unit) = outcome.budget, motion_unit(recipe)
    # what each budget has; further keys below need a field of the budget or a second contact
    entry: dict[str, Any] = {
        "permitted": scale * budget.permitted,
        "unit": unit,
        "sum": budget.sums,
        "kept": outcome.kept,
        "zero_deg": None if budget.zero is None else degrees(budget.zero),
        "angles": len(outcome.influence.shaft),
        **{kind: _sum(recipe, sum_) for kind, sum_ in outcome.sums.items()},
        "contacts": [
            {"name": output.name, **_greatest(recipe, outcome, output)} for output in outcome.influence.outputs()
        ],
        "dimensions": [_dimension(recipe, outcome, name, size) for name, size in budget.tolerances],
        "over_turn": _over_turn(recipe, outcome),
    }
    if outcome.influence.contour is not None:
        entry["contour"] = {"files": list(files), **_contour_error(recipe, outcome.influence)}
    if budget.waves is not None:
        rates = velocities(outcome.influence, budget.waves)
        entry["velocity"] = {"waves": budget.waves, **{kind: _rate(recipe, worst(rates, kind)) for kind in SUMS}}
    if budget.fit is not None:
        angle = budget.fit.angle
        play = {"bore": budget.fit.bore / recipe.mm, "unit": UNIT_NAMES[recipe.units]}
        entry["fit"] = play | ({} if angle is None else {"key_deg": 2.0 * math.degrees(angle)})
    middle = outcome.influence.middle()
    if middle is not None:
        entry["middle"] = _greatest(recipe, outcome, middle)
    if outcome.play is not None:
        least, most = (scale * play for play in outcome.play)
        limit = None if budget.play is None else scale * budget.play
        entry["play"] = {"min": least, "max": most, "limit": limit, "unit": unit}
    if outcome.left is not None:
        entry["left"] = _left(recipe, outcome, outcome.left)
    if outcome.splits is not None:
        entry["splits"] = {kind: _split(recipe, split) for kind, split in outcome.splits.items()}
    return entry


def _sum(recipe: Recipe, sum_: Worst) -> dict[str, Any]:
    scale, unit = motion_unit(recipe)
    place = {"at_deg": degrees(sum_.at), "contact": sum_.contact}
    return {"value": scale * sum_.value, "unit": unit, **place, "shares": dict(sum_.shares)}


def _rate(recipe: Recipe, rate: Worst) -> dict[str, Any]:
    entry = _sum(recipe, rate)
    del entry["contact"]
    return {**entry, "unit": f"{entry['unit']}/rad"}


def _contour_error(recipe: Recipe, rows: Influence) -> dict[str, Any]:
    """The greatest error of the motion by the contour alone, over the angles and contacts, and its place."""
    scale, unit = motion_unit(recipe)
    outputs = rows.outputs()
    errors = np.abs([output.contour for output in outputs])
    contact, place = np.unravel_index(int(errors.argmax()), errors.shape)
    at = {"at_deg": degrees(float(rows.shaft[place])), "contact": outputs[contact].name}
    return {"error": scale * float(errors[contact, place]), "unit": unit, **at}


def _greatest(recipe: Recipe, outcome: BudgetOutcome, output: Output) -> dict[str, float]:
    """The greatest sums of one output over the angles, by kind, in the motion's unit of the report."""
    scale, _ = motion_unit(recipe)
    return {kind: scale * float(total(outcome.influence, output, kind).max()) for kind in SUMS}


def _dimension(recipe: Recipe, outcome: BudgetOutcome, name: str, tolerance: float | None) -> dict[str, Any]:
    """Row of the report on one dimension: its tolerance, its influence at the worst angle, and its greatest influence.

    Influences are in the motion's unit by the dimension's unit; `share` is the dimension's fraction of the worst case.
    """
    rows, sum_ = outcome.influence, outcome.sums["worst"]
    place = int(np.argmin(np.abs(rows.shaft - sum_.at)))
    own = [i for i, contribution in enumerate(rows.contributions) if contribution.name == name]
    greatest = max(float(output.weights[own].sum(axis=0).max()) for output in rows.outputs())
    (per, unit), (scale, motion) = size_unit(recipe, name), motion_unit(recipe)
    return {
        "name": name,
        "tolerance": per * (tolerance or 0.0),
        "unit": unit,
        "radius": DIMENSIONS[name].radius,
        "free": name in outcome.free,
        "influence": scale / per * float(outcome.worst_output.weights[own, place].sum()),
        "greatest": scale / per * greatest,
        "influence_unit": f"{motion}/{unit}",
        "share": sum_.shares[name],
    }


def _left(recipe: Recipe, outcome: BudgetOutcome, left: Array) -> dict[str, Any]:
    (name,), shaft = outcome.free, outcome.influence.shaft
    per, unit = size_unit(recipe, name)
    step, least = max(len(shaft) * LEFT_STEP // 360, 1), int(left.argmin())
    rows = [
        {"at_deg": degrees(float(angle)), "value": per * float(value)}
        for angle, value in zip(shaft[::step], left[::step], strict=True)
    ]
    place = {"least": per * float(left[least]), "unit": unit, "at_deg": degrees(float(shaft[least]))}
    return {"name": name, **place, "over_turn": rows}


def _split(recipe: Recipe, split: Split) -> dict[str, Any]:
    units = {name: size_unit(recipe, name) for name in split.tolerances}
    rows = [
        {"name": name, "tolerance": units[name][0] * value, "unit": units[name][1]}
        for name, value in split.tolerances.items()
    ]
    return {"tolerances": rows, "cost": split.cost, "binding_deg": [degrees(at) for at in split.binding]}


def _over_turn(recipe: Recipe, outcome: BudgetOutcome) -> dict[str, Any]:
    """What each dimension and the contour add to the worst case, every 5 degrees, by the worst contact.

    It is in the motion's unit of the report.
    """
    rows, (scale, _) = outcome.influence, motion_unit(recipe)
    step = max(len(rows.shaft) * SHARES_STEP // 360, 1)
    # in a worst case the powers are the influences times the tolerances themselves
    added = by_name(rows, powers(rows, outcome.worst_output, "worst")[:, ::step])
    if rows.contour is not None:
        added = {CONTOUR: np.abs(outcome.worst_output.contour[::step]), **added}
    at = [degrees(float(angle)) for angle in rows.shaft[::step]]
    return {"at_deg": at, "worst": {name: (scale * values).tolist() for name, values in added.items()}}


def sums_over_turn(recipe: Recipe, outcome: BudgetOutcome, shaft: Array) -> dict[Sum, Array]:
    """Worst case and root of the sum of squares (n,) at shaft angles (n,), rad, by kind.

    They are in degrees or the recipe's unit of length, by the contact at which the worst case is greatest, and
    interpolated linearly between the angles of the outcome.
    """
    rows, (scale, _) = outcome.influence, motion_unit(recipe)
    sums = {kind: total(rows, outcome.worst_output, kind) for kind in SUMS}
    return {kind: scale * np.interp(shaft, rows.shaft, values, period=TURN) for kind, values in sums.items()}
