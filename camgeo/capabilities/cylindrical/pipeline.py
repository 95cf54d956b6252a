"""A run of cylindrical cams: from a recipe to files on disk and a verdict on them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from camgeo.capabilities.cylindrical.checks_of import design_checks, remarks_on
from camgeo.capabilities.cylindrical.design import in_recipe
from camgeo.capabilities.cylindrical.exact import designed, stated_motion
from camgeo.capabilities.cylindrical.figures import figures_of
from camgeo.capabilities.cylindrical.making import foresee, make
from camgeo.capabilities.cylindrical.section import drum_section
from camgeo.capabilities.cylindrical.solid import drum_mesh
from camgeo.capabilities.cylindrical.verdicts import judged_file
from camgeo.measures.flanks import turned_rows
from camgeo.measures.placed import limits_and_wall
from camgeo.measures.units import UNIT_NAMES, report_unit
from camgeo.output.extension import numbers_of
from camgeo.output.own_kind import OwnKind, Told
from camgeo.output.refusals import refusals
from camgeo.recipe.export import FileRequest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.files.layer_outline import LayerOutline
    from camgeo.files.mesh import Mesh
    from camgeo.measures.placed import Figure
    from camgeo.output.own_kind import Page
    from camgeo.report.page.scene import Scene
    from kin.numeric.arrays import Array


def _told(design: DrumDesign, figures: Sequence[Figure]) -> Told:
    unit = report_unit(design.recipe, design.recipe.guide.unit)
    return Told(design.recipe.follower_name, remarks_on(design, figures), design.motion.kept, unit)


def _seen(design: DrumDesign, step: int) -> Scene:
    from camgeo.capabilities.cylindrical.turning import scene

    return scene(design, step)


def _page() -> Page[DrumDesign]:
    from camgeo.capabilities.cylindrical import drum_page

    return drum_page


def _drawings(design: DrumDesign, tolerance: float) -> list[tuple[str, Sequence[LayerOutline | Array]]]:
    """The flanks unrolled at the blank's radius, to be wrapped about it."""
    from camgeo.capabilities.cylindrical.development import unrolled

    recipe = design.recipe
    radius = f"{recipe.radius / recipe.mm:.6g} {UNIT_NAMES[recipe.units]}"
    with refusals(recipe, FileRequest("dxf"), partial(in_recipe, recipe)):
        return [(f"{recipe.name}, unrolled at a radius of {radius}", unrolled(design, tolerance))]


def _mesh(design: DrumDesign, request: FileRequest) -> Mesh:
    with refusals(design.recipe, request, partial(in_recipe, design.recipe)):
        return drum_mesh(design, design.recipe.tolerance(request), numbers_of(request.kind, 1.0))[0]


DRUMS = OwnKind(
    designed=designed,
    figures=figures_of,
    at_unit="deg",
    checks=design_checks,
    limited=lambda design, figures, checks: limits_and_wall(design.recipe.limits, figures, checks, "deg"),
    told=_told,
    section=lambda design, figures: {"drum": drum_section(design, figures)},
    rows=turned_rows,
    foresee=foresee,
    maker=lambda design, clock: partial(make, design, clock),
    judged=judged_file,
    seen=_seen,
    page_of=_page,
    motion=stated_motion,
    drawings=_drawings,
    mesh=_mesh,
    formats=("stl", "ply", "3mf", "step", "dxf"),
)
