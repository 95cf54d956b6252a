"""The printable bodies of a recipe's mechanism, by the kind of its follower or linkage."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism import arms, disc_followers, yoke
from camgeo.capabilities.mechanism.keys import requested_sizes
from camgeo.capabilities.mechanism.shaft import Drive, cam_disk, shaft_in
from camgeo.capabilities.mechanism.sizes import derive_sizes
from camgeo.synthesis.view import Drawer, entry, view_of
from kin.contour.contour import Contour
from kin.contour.region import farthest
from kin.law.contacts import Arrangement, Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.assembly import Assembly
    from camgeo.fit.pieces import ArcSpline
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def build_assembly(recipe: Recipe, design: Design, *contours: ArcSpline) -> Assembly:
    """Bodies round a cam's contours, one contour for each surface, drawn for a shaft that turns clockwise.

    Raises BodyError for a body that cannot be made, ValueError without a part.
    """
    (disc,) = design.discs
    if disc.body is None:
        raise ValueError(f"{recipe.name}: there is no part to be made")
    part = recipe.part
    reach = max(map(_greatest_radius, contours)) if part.outer is None else 0.5 * part.outer
    arrangement, view = design.follower.arrangement, view_of(recipe, design)
    rolling = arrangement.touch is Roller
    field = "" if not rolling else "cam.follower.radius" if arrangement.contacts == 1 else "cam.roller_radius"
    radius = view.touch.radius if rolling else None
    s = derive_sizes(requested_sizes(recipe), reach, part.bore or 0.0, radius, field)
    drive = Drive(cam_disk(part, disc.body, contours), reach, shaft_in(part, s), s)
    if design.driven is not None:
        from camgeo.capabilities.mechanism.linkage_bodies import linkage_assembly

        return linkage_assembly(design.driven.mechanism, drive)
    return BODIES[arrangement](view, drive)


BODIES: dict[Arrangement, Drawer[[Drive], Assembly]] = dict(
    [
        entry(Translating, Roller, disc_followers.on_stem),
        entry(Translating, Shoe, disc_followers.on_stem),
        entry(Translating, KnifeEdge, disc_followers.on_stem),
        entry(Translating, Flat, yoke.face_on_stem),
        entry(Translating, Flat, yoke.yoke, 2),
        entry(Translating, Roller, disc_followers.roller_frame, 2),
        entry(Oscillating, Roller, disc_followers.on_arm),
        entry(Oscillating, Shoe, disc_followers.on_arm),
        entry(Oscillating, KnifeEdge, disc_followers.on_arm),
        entry(Oscillating, Flat, disc_followers.face_on_arm),
        entry(Oscillating, Roller, arms.double_roller, 2),
        entry(Oscillating, Flat, arms.flat_pair, 2),
    ]
)
"""Functions that make the bodies of each follower; those of a linkage are in `linkage_bodies`."""


def _greatest_radius(contour: ArcSpline) -> float:
    """Upper bound of a contour's distance from the shaft, mm."""
    arcs, _ = Contour.from_bulges(contour.points, contour.bulges).as_arcs()
    return float(farthest(arcs, np.zeros((len(arcs), 2))).max()) + contour.bound.worst
