"""A part that differs from the nominal one: edges moved for kerf or clearance, scaled for shrinkage, or altered.

The follower is changed, not the contour: a flat face stands farther out, a roller on the same pitch curve is smaller,
faces of a pair stand beside their pivot's lines. The contour follows by the same formulas and proofs; openings are
moved the other way, as exact parallels. Nothing is sampled.
"""

from __future__ import annotations

from itertools import starmap
from typing import TYPE_CHECKING

import numpy as np

from camgeo.cams.family import GrownError
from camgeo.common.errors import CallError
from camgeo.curve.curvature import least_radius
from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline
from camgeo.measures.extension import MEASURES
from camgeo.part.feature import NothingLeftError, narrowed
from camgeo.part.features import with_records
from camgeo.synthesis.design import SurfaceDesign, discs_of, sound
from kin.contour.offset import TightError, chain_of, parallel
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.part.body import Body
    from camgeo.part.part import Part
    from camgeo.part.shapes import Opening
    from camgeo.recipe.machining import Compensation
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design, Disc
    from kin.numeric.check import Check

FINE = 1e-9  # mm: pieces of an opening's parallel no longer than this are rounding, and left out


@dataclass(frozen=True)
class CompensatedPart:
    """Recipe and design of a compensated part, and the checks of its contour that fail.

    The design has no linkage: only the part as cut or shrunk drives one.
    """

    recipe: Recipe
    design: Design
    checks: tuple[Check, ...]


def compensate(recipe: Recipe, design: Design, compensation: Compensation, field: str) -> CompensatedPart:
    """Change a part by a compensation; a surface's contour is None where its check of undercut fails.

    Raises RecipeErrors at `field`, the path of the file, where a roller or an opening would be nothing or an alteration
    is refused, CurveError where undercut can be neither proved nor excluded.
    """
    # the exact cam with its follower changed, then the openings, then what capabilities alter
    growth, scale = compensation.out, compensation.scale
    try:
        exact = design.exact if growth == 0.0 and scale == 1.0 else design.exact.grow(growth, scale)
    except GrownError as error:
        name, radius = error.args
        problem = f"the metal is enlarged by {growth / recipe.mm:.6g}, "
        if radius:
            raise recipe.error(field, f"{problem}{name} is {radius / recipe.mm:.6g}", None, "give less") from error
        problem += "and a knife edge has no radius to be smaller by that"
        least = f"{0.5 * compensation.kerf / recipe.mm:.6g}"
        remedy = f"leave kerf out, give a clearance of at least {least} too, or a roller"
        raise recipe.error(field, problem, None, remedy) from error
    try:
        part = _part(recipe.part, growth, scale)
        bodies = [None if disc.body is None else _body(disc.body, part, growth, scale) for disc in design.discs]
    except (TightError, NothingLeftError) as error:
        raise recipe.error(field, f"an opening cannot be made smaller by {growth / recipe.mm:.6g}: {error}") from error
    try:
        for altered in compensation.altered:
            alter = MEASURES[altered.capability].alter
            if alter is None:
                raise ValueError(f"nothing alters a part by {altered.key}")
            exact = alter(recipe, design, exact, altered, scale)
    except CallError as error:
        raise recipe.error(field, str(error)) from error
    name = f"{recipe.name}, {compensation.words(recipe.mm)}"
    different = replace(recipe, name=name, cam=exact.cam, part=part)
    # checks of undercut are made anew unless the family has none
    if exact.never_undercut:
        has_contour = bool(design.contours)
        surfaces = [SurfaceDesign(surface, surface.curve if has_contour else None, ()) for surface in exact.surfaces]
    else:
        surfaces = [sound(different, exact, surface) for surface in exact.surfaces]
    discs = tuple(starmap(_with_body, zip(discs_of(surfaces, part, exact.gap), bodies, strict=True)))
    failed = tuple(check for surface in surfaces for check in surface.checks if not check.ok)
    return CompensatedPart(different, replace(design, exact=exact, discs=discs, driven=None), failed)


def _with_body(disc: Disc, body: Body | None) -> Disc:
    """The disc with its body, the least radius of a chamfer taken from its new contour."""
    if body is not None and body.edge and disc.contours:
        body = replace(body, least_radius=least_radius(disc.contours[0][1])[0])
    return replace(disc, body=body)


def _part(part: Part, growth: float, scale: float) -> Part:
    """The part with its edges moved outward by `growth`, mm, then scaled."""
    return replace(
        part,
        bore=None if part.bore is None else narrowed(part.bore, growth, scale),
        outer=None if part.outer is None else scale * (part.outer + 2.0 * growth),
        thickness=None if part.thickness is None else scale * part.thickness,
        features=tuple(
            value if feature.grown is None else feature.grown(value, growth, scale)
            for feature, value in with_records(part.features)
        ),
    )


def _body(body: Body, part: Part, growth: float, scale: float) -> Body:
    return replace(
        body,
        thickness=part.thickness,
        openings=tuple(_opening(opening, growth, scale) for opening in body.openings),
        bore=part.bore,
        outer=part.outer,
        features=part.features,
    )


def _opening(opening: Opening, growth: float, scale: float) -> Opening:
    """An opening made smaller by `growth`, mm, all round, then scaled about the shaft."""
    depth = None if opening.depth is None else scale * opening.depth
    if opening.circle is not None:
        (x, y), radius = opening.circle
        radius = 0.5 * narrowed(2.0 * radius, growth, scale)
        points = np.array([[scale * x + radius, scale * y], [scale * x - radius, scale * y]])
        outline = ArcSpline(points, np.ones(2), EXACT)
        return replace(opening, outline=outline, circle=((scale * x, scale * y), radius), depth=depth)
    outline = opening.outline
    if growth:
        edge = parallel(chain_of(outline.points, outline.bulges), growth, FINE)
        outline = ArcSpline(edge.start.copy(), np.tan(0.25 * edge.sweep), EXACT)
    return replace(opening, outline=outline.scaled(scale), depth=depth)
