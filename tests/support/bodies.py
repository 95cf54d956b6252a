# needs: mechanism
"""Printable bodies for tests: built from a recipe's text, and looked at with shapely."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.making import build_assembly
from camgeo.fit.arcs import fit_arcs
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour

if TYPE_CHECKING:
    from shapely import Polygon

    from camgeo.capabilities.mechanism.assembly import Assembly, Member
    from camgeo.fit.pieces import ArcSpline
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

FIT = 0.002  # mm


def build(text: str) -> tuple[Recipe, Design, Assembly]:
    recipe = load_text(text, "set.yaml")
    design = designed(recipe)
    assert design.only_surface.contour is not None
    return recipe, design, build_assembly(recipe, design, fit_arcs(design.only_surface.contour, FIT))


def polygon(outline: ArcSpline, holes: tuple[ArcSpline, ...] = ()) -> Polygon:
    import shapely

    def ring(one: ArcSpline) -> np.ndarray:
        return Contour.from_bulges(one.points, one.bulges).sample(96)

    return shapely.Polygon(ring(outline), [ring(hole) for hole in holes])


def placed(member: Member, phi: float) -> list[tuple[Polygon, float, float]]:
    """Plates of a member at a shaft angle, as shapely polygons between heights."""
    from shapely.affinity import rotate, translate

    x, y, angle = (0.0, 0.0, 0.0) if member.place is None else member.place(np.array([phi]), 0)[:, 0, 0]
    return [
        (translate(rotate(polygon(p.outline, p.holes), angle, (0.0, 0.0), use_radians=True), x, y), p.low, p.high)
        for p in member.plates
    ]
