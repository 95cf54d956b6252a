"""The plate round the flank: its openings, the walls between all edges, and its body for solids."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from camgeo.curve.curvature import least_radius
from camgeo.fit.pieces import ArcSpline, BSpline, Polygon
from camgeo.part.body import Body
from camgeo.part.chamfer import Chamfer
from camgeo.part.checks import thinnest
from camgeo.part.shapes import Opening, disc, slot_at
from camgeo.part.walls import NOWHERE, Gap, Looks, Pair, contour_gap, known, outside_gap
from camgeo.part.walls import Possible as PossibleWall
from camgeo.recipe.figures import LEAST_WALL
from kin.numeric.check import Check

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.capabilities.linear.keys import LinearRecipe
    from camgeo.fit.pieces import Outline

ROUNDING = 1e-9  # mm: a wall that is less by no more holds
UPRIGHT = 0.5 * math.pi

CHAMFER = "chamfer"  # name of the check that the outline has room for it


def openings(recipe: LinearRecipe, *, drawn: bool) -> tuple[Opening, ...]:
    """Openings of the plate, its groove apart: in the axes of the drawing, or of a plate that travels to the right."""
    sign = 1.0 if drawn and recipe.travel == "left" else -1.0
    plate = recipe.plate

    def place(at: tuple[float, float]) -> tuple[float, float]:
        return sign * at[0], at[1]

    found = [
        disc(_named("hole", i, len(plate.holes)), "HOLES", place(hole.at), 0.5 * hole.diameter)
        for i, hole in enumerate(plate.holes)
    ]
    for i, slot in enumerate(plate.slots):
        turned = slot.angle if sign > 0.0 else -slot.angle
        shape = slot_at(place(slot.at), slot.length, slot.width, turned)
        found.append(Opening(_named("slot", i, len(plate.slots)), "HOLES", shape))
    if plate.mark is not None:
        mark, engraved = plate.mark.mark, plate.mark.mark.kind == "engrave"
        shape = slot_at(place(plate.mark.at), mark.length, mark.width, UPRIGHT)
        found.append(Opening("mark", "ENGRAVE" if engraved else "MARK", shape, depth=mark.depth if engraved else None))
    return tuple(found)


def _named(word: str, number: int, count: int) -> str:
    return word if count == 1 else f"{word} {number + 1}"


def body_of(design: LinearDesign, groove: ArcSpline | None) -> Body:
    """The plate without its outline, as drawn; `groove` is the fitted outline of its groove, as drawn.

    Raises CurveError where the sharpest place of an outline that is to be chamfered cannot be proved.
    """
    recipe = design.recipe
    cut = openings(recipe, drawn=True)
    if groove is not None and recipe.groove is not None:
        cut = (*cut, Opening("groove", "ENGRAVE", groove, depth=recipe.groove.depth))
    chamfer = recipe.plate.chamfer
    radius = least_radius(design.outline)[0] if chamfer else math.inf
    return Body(recipe.plate.thickness, cut, features=(Chamfer(chamfer),) if chamfer else (), least_radius=radius)


def wall_checks(design: LinearDesign) -> list[Check]:
    """Check of the least wall between any two edges; none of a plate of its outline alone."""
    recipe = design.recipe
    if not (recipe.groove or openings(recipe, drawn=False)):
        return []
    pair = thinnest(_walls(design), 0.0)[0]
    least, wall = recipe.plate.wall, pair.gap.wall
    holds = wall > 0.0 if least is None else wall >= least - ROUNDING
    return [Check(LEAST_WALL, holds, wall, least or 0.0, "mm", sense="at_least", detail=str(_drawn(design, pair)))]


def _drawn(design: LinearDesign, pair: Pair) -> Pair:
    x, y = pair.gap.place
    return pair if design.recipe.travel == "right" else pair._replace(gap=pair.gap._replace(place=(-x, y)))


def _walls(design: LinearDesign) -> Iterator[PossibleWall]:
    """Walls between all pairs of edges, not yet computed."""
    recipe = design.recipe
    cut = openings(recipe, drawn=False)
    looks = Looks.of(design.outline)
    for opening in cut:
        yield _possible(opening, looks, "outline", recipe.plate.chamfer)
    for i, first in enumerate(cut):
        for second in cut[:i]:
            apart = math.dist(first.middle, second.middle)
            yield PossibleWall(apart - first.reach - second.reach, partial(_between, first, second))
    if recipe.groove is not None:
        pocket = Looks.of(design.groove, -1)
        for opening in cut:
            yield _possible(opening, pocket, "groove", 0.0)
        for gap in _groove_walls(design):
            yield known("groove", "outline", gap)
        depth, thickness = recipe.groove.depth, recipe.plate.thickness
        if depth is not None and thickness is not None:
            yield known("groove", "the lower face", Gap(thickness - depth, NOWHERE))
    for opening in cut:
        if opening.depth is not None and recipe.plate.thickness is not None:
            yield known(opening.name, "the lower face", Gap(recipe.plate.thickness - opening.depth, NOWHERE))


def _groove_walls(design: LinearDesign) -> Iterator[Gap]:
    """Walls between a groove and the four edges of its plate, mm; an endless one has none at its ends."""
    right, left, height = design.box
    frame = design.groove.sample(Looks.of(design.groove).low)
    x, y = frame.point.T
    top, low = int(y.argmax()), int(y.argmin())
    yield Gap(height - float(y[top]), (float(x[top]), float(y[top])))
    yield Gap(float(y[low]), (float(x[low]), float(y[low])))
    if not design.recipe.endless:
        for i, wall in ((int(x.argmax()), right - x.max()), (int(x.argmin()), x.min() - left)):
            yield Gap(float(wall), (float(x[i]), float(y[i])))


def _possible(opening: Opening, looks: Looks, other: str, edge: float) -> PossibleWall:
    least = looks.wall_at_least(opening.middle, opening.radius) - edge
    return PossibleWall(least, partial(_to_contour, opening, looks, other, edge))


def _to_contour(opening: Opening, looks: Looks, other: str, edge: float) -> Pair:
    gap = contour_gap(looks, opening.chain)
    return Pair(opening.name, other, gap._replace(wall=gap.wall - edge))


def _between(opening: Opening, other: Opening) -> Pair:
    return Pair(other.name, opening.name, outside_gap(opening.chain, other.chain))


def as_drawn(design: LinearDesign, outline: Outline) -> Outline:
    """An outline in the axes of the drawing: mirrored (x -> -x) for a plate that travels to the left."""
    if design.recipe.travel == "right":
        return outline
    turned = outline.mirrored()  # about the x axis, and then turned by half a turn
    match turned:
        case Polygon():
            return Polygon(-turned.vertices + 0.0, turned.bound)
        case ArcSpline():
            return ArcSpline(-turned.points + 0.0, turned.bulges, turned.bound)
        case BSpline():
            return BSpline(turned.degree, -turned.control + 0.0, turned.knots, turned.spans, turned.bound)


def chamfer_checks(design: LinearDesign) -> list[Check]:
    """Check that the outline is nowhere sharper than its chamfer, its corners apart."""
    chamfer = design.recipe.plate.chamfer
    if not chamfer:
        return []
    radius, _ = least_radius(design.outline)
    detail = "the outline's least radius of curvature must be above the chamfer"
    return [Check(CHAMFER, radius > chamfer, radius, chamfer, "mm", None, "at_least", detail=detail)]
