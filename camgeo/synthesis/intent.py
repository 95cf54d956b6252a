"""What a file is held against, in kin's words: the part that it is meant to be, and what is permitted of it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from camgeo.recipe.linkage import output_slides
from camgeo.registry.formats import of_formats
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design, Disc
    from kin.judge.intent import ClosureIntent, Limits, PartIntent


def intended(recipe: Recipe, design: Design) -> PartIntent:
    """Intent by which kin judges a part that is one disc; raises ValueError for a cam of several."""
    (intent,) = intents(recipe, design)
    return intent


def intents(recipe: Recipe, design: Design) -> tuple[PartIntent, ...]:
    """Intent of each disc, by which kin judges its files: the follower with its law, and how the part is drawn."""
    return tuple(_intended(recipe, design, disc) for disc in design.discs)


def _intended(recipe: Recipe, design: Design, disc: Disc) -> PartIntent:
    from kin.judge.intent import DwellAsked, LinkageIntent, PartIntent, SurfaceIntent

    driven, limits, linkage = design.driven, recipe.dwell, None
    exact = design.exact
    if driven is not None and driven.turns:
        dwell = None if limits is None else DwellAsked(limits.band, limits.at_least, limits.over)
        overlap = 0.0 if exact.preload is None else exact.preload.overlaps[0]
        linkage = LinkageIntent(driven.mechanism, recipe.cam.frame_swing, dwell, overlap)
    surfaces = tuple(
        SurfaceIntent(
            exact.gauges[surface.surface.name],
            surface.surface.name,
            surface.surface.layer if surface.surface.name else "",
            side=surface.surface.side,
            trimmed=surface.trimmed,
            follower=exact.running.get(surface.surface.name),
        )
        for surface in disc.surfaces
    )
    intent = PartIntent(
        surfaces=surfaces,
        mm=recipe.mm,
        mirrored=recipe.rotation == "ccw",
        bore=recipe.part.bore,
        thickness=recipe.part.thickness,
        outline=recipe.part.outer,
        closed=recipe.verify.openings == "judge",
        linkage=linkage,
        closures=closures_between(design) if len(surfaces) > 1 else (),
    )
    if recipe.part.plain or disc.body is None:
        return intent
    from camgeo.part.as_intent import holes_of, layers_of

    body = disc.body
    return replace(intent, bore=None, holes=holes_of(body), layers=layers_of(body), cross_holes=body.cross_holes)


def closures_between(design: Design) -> tuple[ClosureIntent, ...]:
    """The pair of surfaces that hold the follower between them: the first pushes it out, the second stops it.

    Empty for a cam of one surface, and where no check of the follower's closes them.
    """
    from kin.judge.intent import ClosureIntent

    surfaces = design.exact.surfaces
    if len(surfaces) < 2 or not design.follower.closure:
        return ()
    pushes, stops = (surface.name for surface in surfaces)
    return (ClosureIntent(pushes, stops, design.follower.closure),)


def permitted(recipe: Recipe, tolerance: float, gap: float | None = None) -> Limits:
    """Limits by which kin judges: tolerance, mm, and the recipe's limits of motion and output, mm or degrees.

    Ends in drawings within `gap`, mm, are joined; None stands for the reader's own gap.
    """
    from kin.judge.intent import Limits

    motion, output = recipe.verify.motion_error, recipe.verify.output_error
    if output is not None and recipe.linkage is not None and not output_slides(recipe.linkage):
        output = math.degrees(output)
    if motion is not None and recipe.cam.arrangement.unit == "deg":
        motion = math.degrees(motion)
    return Limits(tolerance, motion, output=output, gap=gap)


@dataclass(frozen=True)
class FileIntent:
    """Intent by which kin judges files of a format: (recipe, design of one disc)."""

    of: Callable[[Recipe, Design], PartIntent] = intended


INTENTS = of_formats("INTENT", FileIntent())
"""`INTENT` of each format by its word."""
