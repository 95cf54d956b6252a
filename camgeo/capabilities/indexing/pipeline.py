"""A run of indexing cams: from a recipe to files on disk and a verdict on them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from camgeo.capabilities.indexing.checks_of import design_checks, remarks_on
from camgeo.capabilities.indexing.design import in_recipe
from camgeo.capabilities.indexing.exact import designed, stated_motion
from camgeo.capabilities.indexing.figures import figures_of
from camgeo.capabilities.indexing.making import foresee, make
from camgeo.capabilities.indexing.section import index_section
from camgeo.capabilities.indexing.solid import index_mesh
from camgeo.capabilities.indexing.verdicts import judged_file
from camgeo.measures.flanks import turned_rows
from camgeo.measures.placed import limits_and_wall
from camgeo.measures.units import UNIT_NAMES, report_unit
from camgeo.output.extension import numbers_of
from camgeo.output.own_kind import OwnKind, Told
from camgeo.output.refusals import refusals
from camgeo.recipe.export import FileRequest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.files.layer_outline import LayerOutline
    from camgeo.files.mesh import Mesh
    from camgeo.measures.placed import Figure
    from camgeo.output.own_kind import Page
    from camgeo.report.page.scene import Scene
    from kin.numeric.arrays import Array


def _told(design: IndexDesign, figures: Sequence[Figure]) -> Told:
    unit = report_unit(design.recipe, "deg")
    return Told(design.recipe.follower_name, remarks_on(design, figures), design.motion.kept, unit)


def _seen(design: IndexDesign, step: int) -> Scene:
    from camgeo.capabilities.indexing.turning import scene

    return scene(design, step)


def _page() -> Page[IndexDesign]:
    from camgeo.capabilities.indexing import index_page

    return index_page


def _drawings(design: IndexDesign, tolerance: float) -> list[tuple[str, Sequence[LayerOutline | Array]]]:
    """The flanks of a barrel unrolled at the blank's radius, to be wrapped about it; a globoid has no such drawing."""
    from camgeo.capabilities.indexing.development import unrolled

    recipe = design.recipe
    if not recipe.turret.unrolls:
        raise recipe.error("cam.globoid", "a globoid has no development", None, "give stl, 3mf or ply")
    radius = f"{recipe.form.blank / recipe.mm:.6g} {UNIT_NAMES[recipe.units]}"
    with refusals(recipe, FileRequest("dxf"), partial(in_recipe, recipe)):
        return [(f"{recipe.name}, unrolled at a radius of {radius}", unrolled(design, tolerance))]


def _mesh(design: IndexDesign, request: FileRequest) -> Mesh:
    with refusals(design.recipe, request, partial(in_recipe, design.recipe)):
        return index_mesh(design, design.recipe.tolerance(request), numbers_of(request.kind, 1.0))[0]


INDEXERS = OwnKind(
    designed=designed,
    figures=figures_of,
    at_unit="deg",
    checks=design_checks,
    limited=lambda design, figures, checks: limits_and_wall(design.recipe.limits, figures, checks, "deg"),
    told=_told,
    section=lambda design, figures: {"indexing": index_section(design, figures)},
    rows=partial(turned_rows, named=True),
    foresee=foresee,
    maker=lambda design, clock: partial(make, design, clock),
    judged=judged_file,
    seen=_seen,
    page_of=_page,
    motion=stated_motion,
    drawings=_drawings,
    mesh=_mesh,
    formats=("stl", "ply", "3mf", "dxf"),
)
