"""Files of a linear cam: what is fitted and written, and what kin's verdict on each is."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.linear.keys import GROOVE_LAYER
from camgeo.capabilities.linear.narrowed import narrowed
from camgeo.capabilities.linear.plate import as_drawn, body_of, openings
from camgeo.capabilities.linear.verdicts import judged_file
from camgeo.common.units import UNIT_MM
from camgeo.files.errors import demand_package
from camgeo.files.layer_outline import LayerOutline
from camgeo.files.precision import conversion_error
from camgeo.fit.pieces import ArcSpline, Polygon
from camgeo.measures.file_result import FileResult
from camgeo.output.extension import MAKING, numbers_of
from camgeo.output.own_kind import Made, judged_made
from camgeo.output.part_geometry import needs_booleans, part_mesh, remarks, solid_of
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.capabilities.linear.job import Job
    from camgeo.files.mesh import Mesh, MeshFacts
    from camgeo.fit.pieces import Outline
    from camgeo.formats.dxf import Reference
    from camgeo.part.shapes import Opening
    from camgeo.recipe.export import FileRequest
    from kin.linear.verdict import PlateVerdict
    from kin.numeric.arrays import Array

REFERENCE_STEPS = 240  # of the path of the follower's centre in a drawing
COLOUR = "#5f8dd3"
LAYERS = ("CUT", GROOVE_LAYER)  # of the fitted outlines, the outermost first
POSES = 60  # of a plate that slides, in a viewer


def foresee(design: LinearDesign, request: FileRequest) -> None:
    """Raise MissingExtraError where a package is missing that makes a file, RecipeErrors where it cannot be made."""
    recipe, kind = design.recipe, request.kind
    if kind == "dxf":
        demand_package("ezdxf", "a DXF file needs ezdxf")
    elif kind == "step":
        from camgeo.files.brep import need_kernel

        need_kernel()
    elif request.format.mesh or kind == "glb":
        grooved, plate = recipe.groove is not None, recipe.plate
        if grooved or plate.chamfer or (plate.mark is not None and plate.mark.mark.kind == "engrave"):
            from camgeo.files.solid import need_booleans

            need_booleans()


def make(job: Job, request: FileRequest, path: Path) -> Made[PlateVerdict]:
    """Fit, write, read back and judge one file.

    Raises RecipeErrors where the tolerance cannot be held or no sound file can be made, OSError where it cannot be
    written.
    """
    kind = request.kind
    if kind == "csv":
        from camgeo.capabilities.linear.tables import write_csv

        with job.clock.stage("table"):
            write_csv(job.design, request, path)
        return Made(FileResult(path, request, units=UNIT_MM[request.unit_for(job.design.recipe.units)]))
    with job.refusals(request):
        if kind in {"dxf", "svg"}:
            return _drawing(job, request, path)
        if kind == "step":
            return _step(job, request, path)
        if kind == "glb":
            return _glb(job, request, path)
        if request.format.program:
            from camgeo.capabilities.linear.program import make_program

            return make_program(job, request, path)
        return _mesh(job, request, path)


def _unit(job: Job, request: FileRequest) -> float:
    return UNIT_MM[request.unit_for(job.design.recipe.units)]


def _out(request: FileRequest) -> float:
    """By how much the metal is drawn larger all round, mm."""
    return 0.0 if request.compensation is None else request.compensation.out


def _drawing(job: Job, request: FileRequest, path: Path) -> Made[PlateVerdict]:
    design, recipe, mm, out = job.design, job.design.recipe, _unit(job, request), _out(request)
    has_own_unit = request.units not in {None, recipe.units}
    tolerance = job.tolerance(request)
    if out:
        _demand_room(job, request, out)
    outlines: list[Outline] = []
    for name in job.names:
        fits = job.fits(name, out)
        form = request.as_ or "arcs"
        outline = fits.within(form, tolerance)
        shift = conversion_error(outline) if has_own_unit else 0.0
        if outline.bound.worst + shift > tolerance and 4.0 * shift < tolerance:
            outline = fits.within(form, tolerance - 2.0 * shift)
        outlines.append(as_drawn(design, outline))
    layered = [LayerOutline(layer, outline) for layer, outline in zip(LAYERS, outlines, strict=False)]
    cut = [_narrowed(opening, out) for opening in openings(recipe, drawn=True)]
    layered += [LayerOutline(opening.layer, opening.outline, opening.circle) for opening in cut]
    notes = remarks(body_of(design, None), mm)
    if recipe.groove is not None and recipe.groove.depth is not None:
        notes.append(f"camgeo groove: {recipe.groove.depth / mm:.9g} deep")
    if out:
        notes.append(f"camgeo kerf: {2.0 * out / mm:.9g}")
    with job.clock.stage(f"write {request.kind}"):
        if request.kind == "svg":
            from camgeo.formats.svg import write_svg

            write_svg(path, layered, mm=mm, name=recipe.name, about=recipe.about, remarks=notes)
        else:
            from camgeo.formats.dxf import VERSION, Point, ReferenceLine, write_dxf

            u = np.linspace(0.0, design.length, REFERENCE_STEPS * recipe.periods + 1)
            side = np.where(u < design.length, 1, -1) if not recipe.endless else 1
            line = design.drawn(design.path.sample(u, side).point)
            reference: list[Reference] = [Point("guide at input 0", (0.0, 0.0))]
            if recipe.follower.radius:
                reference.append(ReferenceLine("path of the roller's centre", line))
            write_dxf(
                path,
                layered,
                reference=reference,
                mm=mm,
                version=request.own.get("version", VERSION),
                name=recipe.name,
                about=recipe.about,
                remarks=notes,
            )
    pieces, bound = sum(outline.count for outline in outlines), outlines[0].bound
    for other in outlines[1:]:
        bound = bound.wider(other.bound)
    return judged_made(judged_file, design, path, request, clock=job.clock, fit=(pieces, bound))


def _demand_room(job: Job, request: FileRequest, out: float) -> None:
    """Raise RecipeErrors where the metal cannot be drawn larger by `out`, mm: in a hollow or an opening."""
    design, recipe = job.design, job.design.recipe
    where = f"{recipe.field_of(request)}.{request.kind}.kerf"
    from camgeo.capabilities.linear.flank import convex_radius

    hollow = convex_radius(design.path, -1)[0] + design.lower.distance
    if not hollow > out:
        problem = f"the flank's hollow of {hollow / recipe.mm:.6g} is sharper than half the kerf"
        raise recipe.error(where, problem, None, f"give less than {2.0 * hollow / recipe.mm:.4g}")
    if not design.lower.distance > out:
        problem = "half the kerf is not below the radius of the follower, by which the drawing is judged"
        raise recipe.error(where, problem, None, f"give less than {2.0 * design.lower.distance / recipe.mm:.4g}")
    if recipe.trims and design.lower.lost:
        raise recipe.error(where, "a trimmed flank takes no kerf", None, "leave it out, or undercut: refuse")
    for opening in openings(recipe, drawn=True):
        low = opening.outline.box()
        narrow = min(low[2] - low[0], low[3] - low[1])
        if not narrow > 2.0 * out:
            raise recipe.error(where, f"nothing is left of {opening.name}", None, "give a smaller kerf")


def _narrowed(opening: Opening, out: float) -> Opening:
    """An opening smaller by `out`, mm, all round."""
    return narrowed(opening, out) if out else opening


def cut_outlines(job: Job, tolerance: float) -> list[LayerOutline]:
    """The plate's outline, its groove and its openings in arcs and lines within a tolerance, mm, as drawn."""
    outlines = [as_drawn(job.design, job.fits(name).within("arcs", tolerance)) for name in job.names]
    layered = [LayerOutline(layer, outline) for layer, outline in zip(LAYERS, outlines, strict=False)]
    cut = openings(job.design.recipe, drawn=True)
    return layered + [LayerOutline(opening.layer, opening.outline, opening.circle) for opening in cut]


def _groove_chords(job: Job, tolerance: float) -> ArcSpline | None:
    """The outline of the groove as straight pieces, as drawn; None without one."""
    if job.design.recipe.groove is None:
        return None
    outline = as_drawn(job.design, job.fits("groove").within("polyline", tolerance))
    if not isinstance(outline, Polygon):
        raise TypeError("a groove of a mesh is made of chords")
    return ArcSpline(outline.vertices, np.zeros(len(outline.vertices)), outline.bound)


def solid_mesh(job: Job, request: FileRequest, kind: str, mm: float) -> tuple[Mesh, MeshFacts]:
    """Mesh of the plate and facts on it, in the precision of a kind of file in a unit of `mm` mm."""
    recipe, tolerance = job.design.recipe, job.tolerance(request)
    if recipe.plate.thickness is None:
        raise recipe.error("part.thickness", "a solid needs a thickness")
    precision = numbers_of(kind, mm)
    fine = precision.fit_tolerance(tolerance, 1.01 * job.design.outline.size)
    groove = _groove_chords(job, fine)
    body = body_of(job.design, groove)
    if needs_booleans(body):
        from camgeo.files.solid import need_booleans

        need_booleans()
    polygon = as_drawn(job.design, job.fits("outline").within("polyline", fine * body.fineness))
    cut = [LayerOutline(opening.layer, opening.outline, opening.circle) for opening in body.openings]
    with job.clock.stage(f"mesh {request.kind}"):
        mesh, facts = part_mesh([LayerOutline("CUT", polygon), *cut], body, tolerance=tolerance, precision=precision)
    if groove is not None:
        bound = facts.bound.wider(groove.bound.widened(facts.displacement))
        facts = replace(facts, bound=bound, vertices=facts.vertices + len(groove.points))
    return mesh, facts


def _mesh(job: Job, request: FileRequest, path: Path) -> Made[PlateVerdict]:
    from camgeo.files.mesh import Item

    recipe, mm, write = job.design.recipe, _unit(job, request), MAKING[request.kind].write
    if write is None:
        raise ValueError(f"{request.kind} holds no mesh")
    mesh, facts = solid_mesh(job, request, request.kind, mm)
    with job.clock.stage(f"write {request.kind}"):
        write(path, [Item("plate", mesh)], recipe.name, mm, recipe.about)
    return judged_made(judged_file, job.design, path, request, clock=job.clock, fit=(facts.vertices, facts.bound))


def _glb(job: Job, request: FileRequest, path: Path) -> Made[PlateVerdict]:
    """The plate as it slides to and fro, to look at."""
    from camgeo.formats.glb import Actor, write_glb

    design = job.design
    mesh, _ = solid_mesh(job, request, "stl", 1.0)
    turn = 2.0 * math.pi * np.arange(POSES + 1) / POSES
    far = 0.5 * design.total * (1.0 - np.cos(turn)) if not design.recipe.endless else design.total * turn / turn[-1]
    x = far if design.recipe.travel == "right" else -far
    pose: Array = np.column_stack([x, np.zeros_like(x), np.zeros_like(x)])
    with job.clock.stage("write glb"):
        write_glb(path, [Actor("plate", mesh, pose, COLOUR)], title=design.recipe.name)
    return Made(FileResult(path, request, units=UNIT_MM["m"]))


def _step(job: Job, request: FileRequest, path: Path) -> Made[PlateVerdict]:
    from camgeo.formats.step import StepBody, wall_error, write_step

    design, recipe, tolerance = job.design, job.design.recipe, job.tolerance(request)
    if recipe.plate.thickness is None:
        raise recipe.error("part.thickness", "a solid needs a thickness")
    units = request.units or "mm"

    def fitted(name: str) -> ArcSpline:
        fits = job.fits(name)
        outline = fits.within("arcs", tolerance)
        shift = wall_error(outline, units)
        if outline.bound.worst + shift > tolerance and 4.0 * shift < tolerance:
            outline = fits.within("arcs", tolerance - 2.0 * shift)
        drawn = as_drawn(design, outline)
        if not isinstance(drawn, ArcSpline):
            raise TypeError("a solid is made of arcs")
        return drawn

    outline, groove = fitted("outline"), fitted("groove") if recipe.groove is not None else None
    body = body_of(design, groove)
    with job.clock.stage("write step"):
        solid = StepBody([LayerOutline("CUT", outline)], solid_of(body))
        bound = write_step(path, [solid], tolerance=tolerance, units=units, name=recipe.name, about=recipe.about)
    pieces = outline.count
    if groove is not None:
        pieces, bound = pieces + groove.count, bound.wider(groove.bound.widened(wall_error(groove, units)))
    return judged_made(judged_file, job.design, path, request, clock=job.clock, fit=(pieces, bound))
