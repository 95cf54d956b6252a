"""A run of linear cams: from a recipe to files on disk and a verdict on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.linear.checks_of import design_checks, limits_held, remarks_on
from camgeo.capabilities.linear.design import designed, stated_motion
from camgeo.capabilities.linear.figures import figures_of
from camgeo.capabilities.linear.job import Job
from camgeo.capabilities.linear.making import cut_outlines, foresee, make, solid_mesh
from camgeo.capabilities.linear.section import plate_section
from camgeo.capabilities.linear.verdicts import file_rows, judged_file
from camgeo.common.clock import Clock
from camgeo.measures.units import report_unit
from camgeo.output.own_kind import OwnKind, Told
from camgeo.recipe.export import FileRequest

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.files.layer_outline import LayerOutline
    from camgeo.files.mesh import Mesh
    from camgeo.measures.placed import Figure
    from camgeo.output.own_kind import Made, Page
    from camgeo.report.page.scene import Scene
    from kin.linear.verdict import PlateVerdict
    from kin.numeric.arrays import Array


def _told(design: LinearDesign, figures: Sequence[Figure]) -> Told:
    unit = report_unit(design.recipe, design.path.guide.unit)
    return Told(design.recipe.follower.name, remarks_on(design, figures), design.motion.kept, unit)


def _maker(design: LinearDesign, clock: Clock) -> Callable[[FileRequest, Path], Made[PlateVerdict]]:
    job = Job(design, clock)
    return lambda request, path: make(job, request, path)


def _seen(design: LinearDesign, _: int) -> Scene:
    from camgeo.capabilities.linear.plate_page import scene

    return scene(design)


def _page() -> Page[LinearDesign]:
    from camgeo.capabilities.linear import plate_page

    return plate_page


def _drawings(design: LinearDesign, tolerance: float) -> list[tuple[str, Sequence[LayerOutline | Array]]]:
    """The plate, as it is cut."""
    job, request = Job(design, Clock()), FileRequest("dxf")
    with job.refusals(request):
        return [(design.recipe.name, cut_outlines(job, tolerance))]


def _mesh(design: LinearDesign, request: FileRequest) -> Mesh:
    job = Job(design, Clock())
    with job.refusals(request):
        foresee(design, request)
        return solid_mesh(job, request, request.kind, 1.0)[0]


PLATES = OwnKind(
    designed=designed,
    figures=figures_of,
    at_unit="mm",
    checks=design_checks,
    limited=limits_held,
    told=_told,
    section=lambda design, figures: {"plate": plate_section(design, figures)},
    rows=file_rows,
    foresee=foresee,
    maker=_maker,
    judged=judged_file,
    seen=_seen,
    page_of=_page,
    motion=stated_motion,
    drawings=_drawings,
    mesh=_mesh,
    formats=("dxf", "svg", "stl", "ply", "3mf", "step"),
)
