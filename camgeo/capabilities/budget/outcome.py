"""The budget of a design: the sums of its errors, what is left for free dimensions, and how they are told."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.budget.influence import even, influence, velocities
from camgeo.capabilities.budget.inverse import Split, TakenError, left_for, widest
from camgeo.capabilities.budget.sums import Sum, Worst, by_name, powers, total, worst
from camgeo.capabilities.budget.words import WORDS
from camgeo.common.rounding import downward
from camgeo.measures.units import UNIT_NAMES
from kin.numeric.angles import degrees
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.budget.influence import Influence, Output
    from camgeo.capabilities.budget.keys import Budget
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.errors import RecipeErrors
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

ROUNDING = 1e-9  # share of what is permitted by which a sum may exceed it: tolerances that were found just keep it
SUMS: tuple[Sum, ...] = ("worst", "rss")
SHARES_STEP = 5  # degrees from one angle of the report's shares to the next
LEFT_STEP = 10  # degrees from one angle of the report's list of what is left to the next


@dataclass(frozen=True, eq=False)
class Outcome:
    """A budget at even angles: what each dimension does, the greatest sums, and what was found for free ones.

    `budget` has tolerances for all its dimensions, those found among them. `left` (n,) is what is left at each angle
    for the only free one, None where several or none are free; `splits` are the widest sets by cost. `play` is the
    least and the greatest play, mm or rad, of a follower held from both sides.
    """

    budget: Budget
    influence: Influence
    sums: dict[Sum, Worst]
    free: tuple[str, ...]
    left: Array | None = None
    splits: dict[Sum, Split] | None = None
    play: tuple[float, float] | None = None

    @property
    def kept(self) -> bool:
        """Whether the sum that the recipe chose stays within what is permitted, and the play within its own."""
        budget = self.budget
        kept = self.sums[budget.sums].value <= budget.permitted * (1.0 + ROUNDING)
        return kept and (budget.play is None or self.play is None or self.play[1] <= budget.play * (1.0 + ROUNDING))


def outcome(recipe: Recipe, design: Design, budget: Budget) -> Outcome:
    """Work out the budget of a design; raises RecipeErrors where nothing is left for a free dimension."""
    shaft = even(recipe.verify.angles)
    try:
        return _outcome(recipe, design, budget, shaft)
    except TakenError as error:
        raise _taken(recipe, budget, error) from error


def _outcome(recipe: Recipe, design: Design, budget: Budget, shaft: Array) -> Outcome:
    free, left, splits = budget.free, None, None
    rows = influence(recipe, design, budget, shaft)
    if free and not budget.cost:
        left = left_for(rows, budget.permitted, budget.sums)
        chosen = {free[0]: float(left.min())}
    elif free:
        costs = dict(budget.cost)
        splits = {kind: widest(rows, budget.permitted, costs, kind, budget.exponent) for kind in SUMS}
        chosen = dict(splits[budget.sums].tolerances)
    if free:
        # a dimension that moves nothing has no bound, and adds nothing
        budget = budget.split([(name, value if math.isfinite(value) else 0.0) for name, value in chosen.items()])
        rows = influence(recipe, design, budget, shaft)
    sums = {kind: worst(rows, kind) for kind in SUMS}
    return Outcome(budget, rows, sums, free, left, splits, _play(rows, budget.sums))


def _play(rows: Influence, kind: Sum) -> tuple[float, float] | None:
    between = rows.play_between()
    if between is None or rows.play is None:
        return None
    sums = total(rows, between, kind)
    return float((rows.play - sums).min()), float((rows.play + sums).max())


def _taken(recipe: Recipe, budget: Budget, error: TakenError) -> RecipeErrors:
    """The fault of a budget that leaves nothing: of the dimension that takes most."""
    permitted, unit = told(recipe, budget.permitted)
    taken, _ = told(recipe, error.taken)
    of_fit = budget.fit is not None and f"budget.tolerances.{error.name}" not in recipe.marks
    path = "budget.fit" if of_fit else tolerance_path(recipe, error.name)
    problem = f"nothing is left for {budget.free[0]}: {error.name} alone takes {taken:.4g} of {permitted:.4g} {unit}"
    return recipe.error(path, f"{problem} at {degrees(error.at):.6g} degrees", None, "make it smaller, or permit more")


def tolerance_path(recipe: Recipe, name: str) -> str:
    """Path of a dimension's tolerance in a recipe, or of all tolerances where it comes from elsewhere."""
    paths = (f"budget.tolerances.{name}", f"budget.tolerances.{name!r}")
    return next((path for path in paths if path in recipe.marks), "budget.tolerances")


# --- how it is told ---------------------------------------------------------------------------------------------------


def turns(recipe: Recipe) -> bool:
    """Whether the errors of a recipe are angles: of a follower that swings, of an output that turns."""
    from camgeo.recipe.linkage import output_slides

    if recipe.linkage is not None:
        return not output_slides(recipe.linkage)
    return recipe.cam.arrangement.unit == "deg"


def told(recipe: Recipe, value: float) -> tuple[float, str]:
    """An error of the motion, mm or rad, in the recipe's unit or degrees, with its name."""
    return (math.degrees(value), "deg") if turns(recipe) else (value / recipe.mm, UNIT_NAMES[recipe.units])


def told_size(recipe: Recipe, name: str, value: float) -> tuple[float, str]:
    """A tolerance of a dimension, mm or rad, in the recipe's unit or degrees, with its name."""
    return (math.degrees(value), "deg") if WORDS[name].angle else (value / recipe.mm, UNIT_NAMES[recipe.units])


def section(recipe: Recipe, outcome: Outcome) -> dict[str, Any]:
    """What a report says of a budget: lengths in the recipe's unit, angles in degrees."""
    budget = outcome.budget
    permitted, unit = told(recipe, budget.permitted)
    entry: dict[str, Any] = {
        "permitted": permitted,
        "unit": unit,
        "sum": budget.sums,
        "kept": outcome.kept,
        "zero_deg": None if budget.zero is None else degrees(budget.zero),
        "angles": len(outcome.influence.shaft),
        **{kind: _sum(recipe, found) for kind, found in outcome.sums.items()},
        "contacts": [
            {"name": output.name, **_greatest(recipe, outcome, output)} for output in outcome.influence.outputs()
        ],
        "dimensions": _dimensions(recipe, outcome),
        "over_turn": _over_turn(recipe, outcome),
    }
    if budget.waves is not None:
        rates = velocities(outcome.influence, budget.waves)
        entry["velocity"] = {
            "waves": budget.waves,
            **{kind: _rate(recipe, worst(rates, kind)) for kind in SUMS},
        }
    if budget.fit is not None:
        angle = budget.fit.angle
        play = {"bore": budget.fit.bore / recipe.mm, "unit": UNIT_NAMES[recipe.units]}
        entry["fit"] = play | ({} if angle is None else {"key_deg": 2.0 * math.degrees(angle)})
    middle = outcome.influence.middle()
    if middle is not None:
        entry["middle"] = _greatest(recipe, outcome, middle)
    if outcome.play is not None:
        least, most = (told(recipe, value)[0] for value in outcome.play)
        limit = None if budget.play is None else told(recipe, budget.play)[0]
        entry["play"] = {"min": least, "max": most, "limit": limit, "unit": unit}
    if outcome.left is not None:
        entry["left"] = _left(recipe, outcome)
    if outcome.splits is not None:
        entry["splits"] = {kind: _split(recipe, split) for kind, split in outcome.splits.items()}
    return entry


def _sum(recipe: Recipe, found: Worst) -> dict[str, Any]:
    value, unit = told(recipe, found.value)
    return {
        "value": value,
        "unit": unit,
        "at_deg": degrees(found.at),
        "contact": found.contact,
        "shares": dict(found.shares),
    }


def _rate(recipe: Recipe, found: Worst) -> dict[str, Any]:
    value, unit = told(recipe, found.value)
    return {"value": value, "unit": f"{unit}/rad", "at_deg": degrees(found.at), "shares": dict(found.shares)}


def _greatest(recipe: Recipe, outcome: Outcome, output: Output) -> dict[str, float]:
    """The greatest sums of one output over the angles, as told."""
    return {kind: told(recipe, float(total(outcome.influence, output, kind).max()))[0] for kind in SUMS}


def _dimensions(recipe: Recipe, outcome: Outcome) -> list[dict[str, Any]]:
    """Each dimension with its tolerance, its influence at the worst angle, and the greatest of the turn."""
    rows, found = outcome.influence, outcome.sums["worst"]
    place = int(np.argmin(np.abs(rows.shaft - found.at)))
    entries = []
    for name, tolerance in outcome.budget.tolerances:
        own = [i for i, one in enumerate(rows.contributions) if one.name == name]
        (at_worst,) = (o.weights[own, place].sum() for o in rows.outputs() if o.name == found.contact)
        greatest = max(float(o.weights[own].sum(axis=0).max()) for o in rows.outputs())
        size, unit = told_size(recipe, name, tolerance or 0.0)
        per, _ = told_size(recipe, name, 1.0)
        scale = told(recipe, 1.0)[0] / per
        entries.append(
            {
                "name": name,
                "tolerance": size,
                "unit": unit,
                "radius": WORDS[name].radius,
                "free": name in outcome.free,
                "influence": scale * float(at_worst),
                "greatest": scale * greatest,
                "influence_unit": f"{told(recipe, 1.0)[1]}/{unit}",
                "share": found.shares[name],
            }
        )
    return entries


def _left(recipe: Recipe, outcome: Outcome) -> dict[str, Any]:
    left, shaft = outcome.left, outcome.influence.shaft
    if left is None:
        raise ValueError("no dimension is free alone")
    (name,) = outcome.free
    least, unit = told_size(recipe, name, float(left.min()))
    step = max(len(shaft) * LEFT_STEP // 360, 1)
    rows = [
        {"at_deg": degrees(float(angle)), "value": told_size(recipe, name, float(value))[0]}
        for angle, value in zip(shaft[::step], left[::step], strict=True)
    ]
    at = degrees(float(shaft[int(left.argmin())]))
    return {"name": name, "least": least, "unit": unit, "at_deg": at, "over_turn": rows}


def _split(recipe: Recipe, split: Split) -> dict[str, Any]:
    rows = [
        {"name": name, "tolerance": told_size(recipe, name, value)[0], "unit": told_size(recipe, name, value)[1]}
        for name, value in split.tolerances.items()
    ]
    return {"tolerances": rows, "binding_deg": [degrees(at) for at in split.binding]}


def table(recipe: Recipe, entry: dict[str, Any]) -> str:
    """A section as text: the verdict, then a line a dimension."""
    permitted, unit, chosen = entry["permitted"], entry["unit"], entry[entry["sum"]]
    word = "kept" if entry["kept"] else "NOT KEPT"
    title = {"worst": "worst case", "rss": "root sum of squares"}
    other = entry["rss" if entry["sum"] == "worst" else "worst"]
    chosen_title, other_title = (title[entry["sum"]], title["rss" if entry["sum"] == "worst" else "worst"])
    line = f"{recipe.name}: {permitted:.6g} {unit} {word} by {chosen_title}: {_place(chosen)}; by {other_title} "
    lines = [line + _place(other)]
    if not entry["kept"]:
        largest = max(chosen["shares"], key=lambda name: chosen["shares"][name])
        lines.append(f"  {largest} takes most of it, {chosen['shares'][largest]:.0%}")
    head = ("dimension", "plus and minus", "influence", "share")
    rows = [
        (
            row["name"] + (" (found)" if row["free"] else ""),
            f"{'radius ' if row['radius'] else ''}{_shown(row)} {row['unit']}",
            f"{row['influence']:.4g} {row['influence_unit']}",
            f"{row['share']:.1%}",
        )
        for row in entry["dimensions"]
    ]
    widths = [max(len(row[i]) for row in (head, *rows)) for i in range(len(head))]
    for row in (head, *rows):
        first, *others = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        lines.append(f"  {'  '.join([first, *others])}".rstrip())
    if "left" in entry:
        left = entry["left"]
        lines.append(f"  left for {left['name']}: {downward(left['least'])} {left['unit']} at {left['at_deg']:.4g} deg")
    if "play" in entry:
        play = entry["play"]
        limit = "" if play["limit"] is None else f", {play['limit']:.6g} permitted"
        lines.append(f"  play from {play['min']:.4g} to {play['max']:.4g} {unit}{limit}")
    if "velocity" in entry:
        rates = entry["velocity"]
        found = " and ".join(f"by {title[kind]} {_place(rates[kind])}" for kind in SUMS)
        lines.append(f"  velocity, with {rates['waves']} waves of the profile: {found}")
    if "parts" in entry:
        lines += _simulated(entry["parts"])
    return "\n".join(lines)


def _simulated(parts: dict[str, Any]) -> list[str]:
    if "why" in parts:
        return [f"  no parts were simulated: {parts['why']}"]
    worst, unit = parts["worst"], parts["unit"]
    agrees = "agrees" if worst["agrees"] else "does not agree"
    where = f" on {' and '.join(parts['files'])}" if parts["files"] else ""
    kept, greatest = f"{parts['within']:.2%} keep it", f"the greatest error is {parts['greatest']:.4g} {unit}"
    deviation = f"standard deviation at {worst['at_deg']:.4g} deg {worst['sd']:.4g} {unit}"
    return [
        f"  of {parts['runs']:,} parts by contact{where} {kept}, {greatest}",
        f"  {deviation}, which {agrees} with {worst['foreseen']:.4g} by the influences",
    ]


def _place(found: dict[str, Any]) -> str:
    return f"{found['value']:.4g} {found['unit']} at {found['at_deg']:.4g} deg"


def _shown(row: dict[str, Any]) -> str:
    """A tolerance; one that was found is rounded to the safe side."""
    return downward(row["tolerance"]) if row["free"] and row["tolerance"] > 0.0 else f"{row['tolerance']:.6g}"


def over_turn(recipe: Recipe, outcome: Outcome, shaft: Array) -> dict[Sum, Array]:
    """Both sums at shaft angles (n,), as told, at the contact that is worst of all, between the angles looked at."""
    rows, output = outcome.influence, _worst_output(outcome)
    scale, turn = told(recipe, 1.0)[0], 2.0 * math.pi
    return {kind: scale * np.interp(shaft, rows.shaft, total(rows, output, kind), period=turn) for kind in SUMS}


def _worst_output(outcome: Outcome) -> Output:
    contact = outcome.sums["worst"].contact
    return next(output for output in outcome.influence.outputs() if output.name == contact)


def _over_turn(recipe: Recipe, outcome: Outcome) -> dict[str, Any]:
    """What each dimension adds to the worst case every few degrees, at the contact that is worst of all."""
    rows = outcome.influence
    step = max(len(rows.shaft) * SHARES_STEP // 360, 1)
    added = by_name(rows, powers(rows, _worst_output(outcome), "worst")[:, ::step])
    scale = told(recipe, 1.0)[0]
    at = [degrees(float(angle)) for angle in rows.shaft[::step]]
    return {"at_deg": at, "worst": {name: (scale * values).tolist() for name, values in added.items()}}
