"""Milled features of a part: contours, holes and depths; and the intent by which kin judges a program."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from camgeo.machining.reach import milled_contours, reach_checks
from camgeo.part.as_intent import holes_of
from camgeo.part.features import with_records
from camgeo.synthesis.intent import intended

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent

MOST_PASSES = 2000  # through the part
LEAST_ROOM = 1e-2  # mm: a hole that is wider than the cutter by less than twice this is not milled


class RoundHole(NamedTuple):
    """A round hole through the part, in the cam's axes, mm."""

    name: str
    centre: tuple[float, float]
    radius: float


def pocket_of(design: Design) -> float | None:
    """Depth of the groove between two surfaces, mm; None for a cam that is cut through."""
    return next((disc.body.pocket for disc in design.discs if disc.body is not None), None)


def few_passes(recipe: Recipe, depth: float | None, paths: int = 1) -> None:
    """Raise RecipeErrors where `paths` paths through `depth`, mm, make more than MOST_PASSES passes.

    Nothing is checked without a depth, or without a depth of cut.
    """
    manufacture = recipe.manufacture
    if depth is None or manufacture is None or manufacture.depth_of_cut is None:
        return
    count = paths * depth / manufacture.depth_of_cut
    if count > MOST_PASSES:
        depth_words = f"{manufacture.depth_of_cut / recipe.mm:.6g} {recipe.units}"
        what = f"makes {math.ceil(count)} passes, more than {MOST_PASSES}"
        remedy = f"give at least {paths * depth / MOST_PASSES / recipe.mm:.6g} {recipe.units}"
        raise recipe.error("manufacture.depth_of_cut", what, depth_words, remedy)


def unmilled(recipe: Recipe, design: Design) -> list[tuple[str, str]]:
    """Pairs of the name of a feature of the part that a program leaves unmade, and the reason.

    A program cuts straight down: chamfers and holes across the shaft stay unmade, a hub and the outline round a ring or
    a groove come with the stock. Raises ValueError without a contour or without `manufacture`.
    """
    part = recipe.part
    items = list(milled_holes(recipe, design)[1])
    if part.outer is not None:
        items.append(("outline", f"the stock comes with it, a disc {part.outer / recipe.mm:.6g} across"))
    elif pocket_of(design) is not None:
        items.append(("outline", "the stock comes with it"))
    features = (feature for feature, _ in with_records(part.features))
    return [*items, *((feature.name.replace("_", " "), feature.unmilled) for feature in features if feature.unmilled)]


def milled_holes(recipe: Recipe, design: Design) -> tuple[list[RoundHole], list[tuple[str, str]]]:
    """Holes that the cutter goes round, and pairs of the name of a hole that is not milled, and the reason.

    Raises ValueError without a contour or without `manufacture`.
    """
    _, manufacture = milled_contours(recipe, design)
    boss = recipe.part.boss
    reach, within = (0.0, "") if boss is None else (0.5 * boss.diameter, f"within the {boss.name}")
    holes: list[RoundHole] = []
    others: list[tuple[str, str]] = []
    for opening in design.openings:
        if opening.circle is not None and opening.depth is None:
            holes.append(RoundHole(opening.name, *opening.circle))
        else:
            others.append((opening.name, "not a round hole" if opening.depth is None else "engraved"))
    if not manufacture.holes:
        return [], [*((hole.name, "manufacture.holes is not true") for hole in holes), *others]
    beside = [hole for hole in holes if math.hypot(*hole.centre) >= reach]
    others += [(hole.name, f"{within}, which is higher than the disc") for hole in holes if hole not in beside]
    wide = [hole for hole in beside if hole.radius >= manufacture.radius + LEAST_ROOM]
    others += [(hole.name, "not wider than the cutter") for hole in beside if hole not in wide]
    return wide, others


def milling_intent(recipe: Recipe, design: Design) -> PartIntent:
    """Intent by which kin judges a milling program: the part without features not milled, and the cutter's data.

    Raises CurveError where the cutter's path fails.
    """
    from kin.judge.intent import Milling

    _, manufacture = milled_contours(recipe, design)
    reached = reach_checks(recipe, design)
    lost = [path is None or bool(path.lost) for _, path in reached]
    intent, pocket = intended(recipe, design), pocket_of(design)
    trimmed = [each.trimmed or less for each, less in zip(intent.surfaces, lost, strict=True)]
    # the part as kin intends it, less the holes and openings that stay unmade
    holes, _ = milled_holes(recipe, design)
    names = {hole.name for hole in holes}
    boss = recipe.part.boss
    (disc,) = design.discs
    shaped = () if disc.body is None or recipe.part.plain else holes_of(disc.body)
    milling = Milling(
        radius=manufacture.radius,
        thickness=recipe.part.thickness or 0.0,
        depth_of_cut=manufacture.depth_of_cut or recipe.part.thickness or 0.0,
        climb=manufacture.direction == "climb",
        standing=manufacture.unreached if any(lost) else 0.0,
        hub=(0.5 * boss.diameter, boss.above) if boss is not None and boss.above else None,
        outline=recipe.part.outer is None and pocket is None,
        pocket=pocket,
    )
    return replace(
        intent,
        bore=intent.bore if "bore" in names else None,
        holes=tuple(hole for hole in shaped if hole.name in names),
        layers=(),
        cross_holes=(),
        surfaces=tuple(replace(each, trimmed=less) for each, less in zip(intent.surfaces, trimmed, strict=True)),
        milling=milling,
    )
