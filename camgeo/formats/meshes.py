"""Formats of meshes: their options, their form, and the functions that make their files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.options import OF_SOLID
from camgeo.output.extension import Making
from camgeo.registry.formats import Form, Format
from camgeo.schema.fields import FieldTable

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.files.mesh import Item
    from camgeo.files.precision import Precision
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest

OPTIONS = FieldTable(OF_SOLID)
EDGES = {"": Form(surfaces=2, discs=2, pieces="edges")}


def mesh_format(name: str, *, units: bool) -> Format:
    """Facts of a format whose files hold one mesh each; `units` is whether a file states its unit."""
    return Format(name=name, options=OPTIONS, forms=EDGES, solid=True, by_disc=True, units=units, mesh=True)


def mesh_making(
    numbers: Callable[[], Precision], write: Callable[[Path, Sequence[Item], str, float, str], None]
) -> Making:
    """What makes the files of a format of meshes.

    `numbers` gives the precision of the numbers of a file; `write` writes meshes, whose points have that precision:
    (path, meshes, title, mm of the unit, `about` of the recipe).
    """
    return Making(make=make_mesh, foresee=foresee_mesh, numbers=numbers, write=write)


def make_mesh(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Fit, write, read back and judge the meshes of a file.

    Raises RecipeErrors for a part without thickness, a tolerance that cannot be held, and outlines that make no sound
    solid; OSError where the file cannot be written. A missing package is refused by `foresee_mesh`.
    """
    from camgeo.output.solid import make_mesh as make

    return make(job, request, path)


def foresee_mesh(job: Job, request: FileRequest) -> None:
    """Raise RecipeErrors for a tolerance that the precision cannot hold, MissingExtraError for a missing package."""
    from camgeo.output.solid import foresee

    foresee(job, request)
