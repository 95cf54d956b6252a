"""A part made different from the nominal one: edges moved for a kerf or a clearance, scaled for shrinkage, altered.

Moved is the intent: a flat face farther out, a smaller roller on the same pitch curve, faces of a pair beside their
pivot's lines. The contour follows from it by the same formulas and is proved by the same proofs; openings are moved the
other way, as exact parallels. So what kin is given differs from the nominal part by a number, and nothing is sampled.
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
from camgeo.registry.formats import alteration
from camgeo.synthesis.design import SurfaceDesign, discs_of, sound
from kin.contour.offset import TightError, chain_of, parallel
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.recipe.machining import Compensation
    from camgeo.recipe.part import Part
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design, Disc
    from camgeo.synthesis.part.body import Body
    from camgeo.synthesis.part.shapes import Opening
    from kin.judge.check import Check

FINE = 1e-9  # mm: pieces of an opening's parallel no longer than this are left out


@dataclass(frozen=True)
class Compensated:
    """A recipe and a design as a file shows them, and the checks of its contour that fail.

    The linkage is not driven by such a part: what is cut or shrunk afterwards is.
    """

    recipe: Recipe
    design: Design
    checks: tuple[Check, ...]


class NothingLeftError(CamgeoError, ValueError):
    """An opening that is no wider than what is taken from it."""


def compensated(recipe: Recipe, design: Design, by: Compensation, field: str) -> Compensated:
    """Make a part different from the nominal one; its contour is None where a check fails.

    Raises RecipeErrors at `field`, that of the file, where a roller or an opening would be nothing, CurveError where
    the contour cannot be proved.
    """
    out, scale = by.out, by.scale
    try:
        exact = design.exact if out == 0.0 and scale == 1.0 else design.exact.grown(out, scale)
    except GrownError as error:
        name, radius = error.args
        what = f"the metal is enlarged by {out / recipe.mm:.6g}, "
        if radius:
            raise recipe.error(field, f"{what}{name} is {radius / recipe.mm:.6g}", None, "give less") from error
        what += "and a knife edge has no radius to be smaller by that"
        least = f"{0.5 * by.kerf / recipe.mm:.6g}"
        remedy = f"leave kerf out, give a clearance of at least {least} too, or a roller"
        raise recipe.error(field, what, None, remedy) from error
    try:
        bodies = [None if disc.body is None else _body(disc.body, out, scale) for disc in design.discs]
        part = _part(recipe.part, out, scale)
    except (TightError, NothingLeftError) as error:
        raise recipe.error(field, f"an opening cannot be made smaller by {out / recipe.mm:.6g}: {error}") from error
    try:
        for one in by.altered:
            exact = alteration(one.capability).alter(recipe, design, exact, one.value, scale)
    except CallError as error:
        raise recipe.error(field, str(error)) from error
    name = f"{recipe.name}, {by.told(recipe.mm)}"
    made = replace(recipe, name=name, cam=exact.cam, part=part)
    if exact.free:
        whole = bool(design.contours)
        surfaces = [SurfaceDesign(one, one.curve if whole else None, ()) for one in exact.surfaces]
    else:
        surfaces = [sound(made, exact, surface) for surface in exact.surfaces]
    discs = tuple(starmap(_with_body, zip(discs_of(surfaces, part, exact.gap), bodies, strict=True)))
    failed = tuple(check for surface in surfaces for check in surface.checks if not check.ok)
    return Compensated(made, replace(design, exact=exact, discs=discs, driven=None), failed)


def _with_body(disc: Disc, body: Body | None) -> Disc:
    """The disc with its body, whose chamfer runs along another contour than before."""
    if body is not None and body.chamfer is not None and disc.contours:
        body = replace(body, least_radius=least_radius(disc.contours[0][1])[0])
    return replace(disc, body=body)


def _part(part: Part, out: float, scale: float) -> Part:
    """Lengths of the part that the files are given directly."""
    hub = part.hub
    if hub is not None:
        hub = replace(hub, diameter=scale * (hub.diameter + 2.0 * out), height=scale * hub.height)
    return replace(
        part,
        bore=None if part.bore is None else _across(part.bore, out, scale),
        outer=None if part.outer is None else scale * (part.outer + 2.0 * out),
        thickness=None if part.thickness is None else scale * part.thickness,
        hub=hub,
    )


def _across(width: float, out: float, scale: float) -> float:
    left = width - 2.0 * out
    if not left > 0.0:
        raise NothingLeftError(f"it is {width:.6g} mm across")
    return scale * left


def _body(body: Body, out: float, scale: float) -> Body:
    hub, screw = body.hub, body.screw
    if hub is not None:
        hub = replace(hub, diameter=scale * (hub.diameter + 2.0 * out), height=scale * hub.height)
    if screw is not None:
        height = None if screw.height is None else scale * screw.height
        screw = replace(screw, diameter=_across(screw.diameter, out, scale), height=height)
    return replace(
        body,
        thickness=None if body.thickness is None else scale * body.thickness,
        openings=tuple(_opening(opening, out, scale) for opening in body.openings),
        bore=None if body.bore is None else _across(body.bore, out, scale),
        outer=None if body.outer is None else scale * (body.outer + 2.0 * out),
        hub=hub,
        screw=screw,
        chamfer=None if body.chamfer is None else scale * body.chamfer,
    )


def _opening(opening: Opening, out: float, scale: float) -> Opening:
    """An opening made smaller by `out` all round, and scaled."""
    depth = None if opening.depth is None else scale * opening.depth
    if opening.circle is not None:
        (x, y), radius = opening.circle
        radius = 0.5 * _across(2.0 * radius, out, scale)
        points = np.array([[scale * x + radius, scale * y], [scale * x - radius, scale * y]])
        outline = ArcSpline(points, np.ones(2), EXACT)
        return replace(opening, outline=outline, circle=((scale * x, scale * y), radius), depth=depth)
    outline = opening.outline
    if out:
        edge = parallel(chain_of(outline.points, outline.bulges), out, FINE)
        outline = ArcSpline(edge.start.copy(), np.tan(0.25 * edge.sweep), EXACT)
    return replace(opening, outline=outline.scaled(scale), depth=depth)
