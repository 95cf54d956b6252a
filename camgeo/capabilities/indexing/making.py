"""Files of an indexing cam: what is made and written, and what kin's verdict on each is."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from camgeo.capabilities.indexing.design import in_recipe
from camgeo.capabilities.indexing.solid import index_mesh
from camgeo.capabilities.indexing.verdicts import intended, judged_file
from camgeo.common.units import UNIT_MM
from camgeo.files.errors import demand_package
from camgeo.files.mesh import Item
from camgeo.formats.glb import COLOURS, Actor, steady_turn, write_glb
from camgeo.machining.turned import cutting_of, demand_judged
from camgeo.measures.file_result import FileResult
from camgeo.output.extension import MAKING, numbers_of
from camgeo.output.own_kind import Made, judged_made
from camgeo.output.refusals import demand_flanks, refusals

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.common.clock import Clock
    from camgeo.recipe.export import FileRequest
    from kin.turned.verdict import TurnedVerdict


def foresee(design: IndexDesign, request: FileRequest) -> None:
    """Raise MissingExtraError where a package is missing that makes a file, RecipeErrors for one that is not judged."""
    if request.kind == "dxf":
        demand_package("ezdxf", "a DXF file needs ezdxf")
    demand_flanks(design.recipe, request, design.recipe.form.depth)
    if request.format.program:
        _demand_judged(design, request)


def _demand_judged(design: IndexDesign, request: FileRequest) -> None:
    """Raise RecipeErrors for a program whose tolerance is finer than what it leaves is judged to."""
    from kin.indexing.program import finest_told

    recipe = design.recipe
    finest = finest_told(intended(design), cutting_of(request, recipe.form.depth))
    demand_judged(recipe, request, finest, "a program of this barrel")


def make(design: IndexDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    """Make, write, read back and judge one file.

    Raises RecipeErrors where the tolerance cannot be held or no sound file can be made, OSError where it cannot be
    written.
    """
    recipe = design.recipe
    if request.kind == "csv":
        from camgeo.capabilities.indexing.tables import write_csv

        with clock.stage("table"):
            write_csv(design, request, path)
        return Made(FileResult(path, request, units=UNIT_MM[request.unit_for(recipe.units)]))
    with refusals(recipe, request, partial(in_recipe, recipe)):
        maker = _program if request.format.program else _MAKERS.get(request.kind, _mesh)
        return maker(design, clock, request, path)


def _mesh(design: IndexDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    recipe, mm, write = design.recipe, UNIT_MM[request.unit_for(design.recipe.units)], MAKING[request.kind].write
    if write is None:
        raise ValueError(f"{request.kind} holds no mesh")
    with clock.stage(f"mesh {request.kind}"):
        mesh, facts = index_mesh(design, recipe.tolerance(request), numbers_of(request.kind, mm))
    with clock.stage(f"write {request.kind}"):
        write(path, [Item("cam", mesh)], recipe.name, mm, recipe.about)
    return judged_made(judged_file, design, path, request, clock=clock, fit=(None, facts.bound))


def _view(design: IndexDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    """The cam as it turns, with its turret, to look at."""
    from camgeo.capabilities.indexing.actors import turret_actors

    with clock.stage("mesh glb"):
        mesh, _ = index_mesh(design, design.recipe.tolerance(request), numbers_of("glb", 1.0))
    with clock.stage("write glb"):
        cam = Actor("cam", mesh, steady_turn(design.recipe.rotation), COLOURS[0])
        write_glb(path, [cam, *turret_actors(design)], title=design.recipe.name)
    return Made(FileResult(path, request, units=UNIT_MM["m"]))


def _development(design: IndexDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    from camgeo.capabilities.indexing.development import write_development

    mm = UNIT_MM[request.unit_for(design.recipe.units)]
    with clock.stage("write dxf"):
        fit = write_development(design, request, path, design.recipe.tolerance(request), mm)
    return judged_made(judged_file, design, path, request, clock=clock, fit=fit)


def _program(design: IndexDesign, clock: Clock, request: FileRequest, path: Path) -> Made[TurnedVerdict]:
    from camgeo.capabilities.indexing.program import write_program

    mm = UNIT_MM[request.unit_for(design.recipe.units)]
    with clock.stage(f"write {request.kind}"):
        fit = write_program(design, request, path, design.recipe.tolerance(request), mm)
    return judged_made(judged_file, design, path, request, clock=clock, fit=fit)


_MAKERS = {"dxf": _development, "glb": _view}
"""Makers of files by their formats, beside programs and meshes."""
