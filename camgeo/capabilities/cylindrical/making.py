"""Files of a cylindrical cam: what is made and written, and what kin's verdict on each is."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from camgeo.capabilities.cylindrical.design import in_recipe
from camgeo.capabilities.cylindrical.solid import drum_mesh
from camgeo.capabilities.cylindrical.verdicts import intended, judged_file
from camgeo.common.units import UNIT_MM
from camgeo.files.errors import demand_package
from camgeo.files.mesh import Item
from camgeo.fit.bound import Bound
from camgeo.formats.glb import COLOURS, Actor, steady_turn, write_glb
from camgeo.machining.turned import cutting_of, demand_judged
from camgeo.measures.file_result import FileResult
from camgeo.output.extension import MAKING, numbers_of
from camgeo.output.own_kind import Made, judged_made
from camgeo.output.refusals import demand_flanks, refusals

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.common.clock import Clock
    from camgeo.recipe.export import FileRequest
    from kin.turned.verdict import TurnedVerdict


def foresee(design: DrumDesign, request: FileRequest) -> None:
    """Raise MissingExtraError where a package is missing that makes a file, RecipeErrors where it cannot be made."""
    if request.kind == "dxf":
        demand_package("ezdxf", "a DXF file needs ezdxf")
    if request.kind == "step":
        from camgeo.files.brep import need_kernel

        if any(design.tips.values()):
            problem = "a flank that an undercut shortens ends in a sharp edge, and no STEP is made of it"
            raise design.recipe.error(design.recipe.field_of(request), problem, None, "give stl, 3mf or ply")
        need_kernel()
    demand_flanks(design.recipe, request, design.recipe.track.depth)
    if request.format.program:
        _demand_judged(design, request)


def _demand_judged(design: DrumDesign, request: FileRequest) -> None:
    """Raise RecipeErrors for a program with a tolerance below the accuracy of its verdict."""
    from kin.cylindrical.program import finest_told

    recipe = design.recipe
    finest = finest_told(intended(design), cutting_of(request, recipe.track.depth))
    demand_judged(recipe, request, finest, "a program of this drum")


def make(design: DrumDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    """Make, write, read back and judge one file.

    Raises RecipeErrors where the tolerance cannot be held or no sound file can be made, OSError where it cannot be
    written.
    """
    recipe = design.recipe
    if request.kind == "csv":
        from camgeo.capabilities.cylindrical.tables import write_csv

        with clock.stage("table"):
            write_csv(design, request, path)
        return Made(FileResult(path, request, units=UNIT_MM[request.unit_for(recipe.units)]))
    with refusals(recipe, request, partial(in_recipe, recipe)):
        maker = _program if request.format.program else _MAKERS.get(request.kind, _mesh)
        return maker(design, clock, request, path)


def _mesh(design: DrumDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    recipe, mm, write = design.recipe, UNIT_MM[request.unit_for(design.recipe.units)], MAKING[request.kind].write
    if write is None:
        raise ValueError(f"{request.kind} holds no mesh")
    with clock.stage(f"mesh {request.kind}"):
        mesh, facts = drum_mesh(design, design.recipe.tolerance(request), numbers_of(request.kind, mm))
    with clock.stage(f"write {request.kind}"):
        write(path, [Item("drum", mesh)], recipe.name, mm, recipe.about)
    return judged_made(judged_file, design, path, request, clock=clock, fit=(None, facts.bound))


def _surfaces(design: DrumDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    from camgeo.capabilities.cylindrical.brep import drum_solid
    from camgeo.formats.step import write_shape

    recipe, units = design.recipe, request.unit_for(design.recipe.units)
    with clock.stage("surfaces step"):
        solid = drum_solid(design, design.recipe.tolerance(request))
    with clock.stage("write step"):
        write_shape(path, solid.shape, units=units, name=recipe.name, about=recipe.about or "cylindrical cam")
    return judged_made(judged_file, design, path, request, clock=clock, fit=(solid.pieces, Bound(solid.off, solid.off)))


def _view(design: DrumDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    """The drum as it turns, to look at."""
    with clock.stage("mesh glb"):
        mesh, _ = drum_mesh(design, design.recipe.tolerance(request), numbers_of("glb", 1.0))
    with clock.stage("write glb"):
        actor = Actor("drum", mesh, steady_turn(design.recipe.rotation), COLOURS[0])
        write_glb(path, [actor], title=design.recipe.name)
    return Made(FileResult(path, request, units=UNIT_MM["m"]))


def _development(design: DrumDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    from camgeo.capabilities.cylindrical.development import write_development

    mm = UNIT_MM[request.unit_for(design.recipe.units)]
    with clock.stage("write dxf"):
        fit = write_development(design, request, path, design.recipe.tolerance(request), mm)
    return judged_made(judged_file, design, path, request, clock=clock, fit=fit)


def _program(design: DrumDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    from camgeo.capabilities.cylindrical.program import write_program

    with clock.stage(f"write {request.kind}"):
        fit = write_program(
            design, request, path, design.recipe.tolerance(request), UNIT_MM[request.unit_for(design.recipe.units)]
        )
    return judged_made(judged_file, design, path, request, clock=clock, fit=fit)


_MAKERS = {"dxf": _development, "glb": _view, "step": _surfaces}
"""Makers of files by their formats, beside programs and meshes."""
