"""Formats of drawings: a contour of arcs, lines or a spline on layers, a file for each disc."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.options import OF_DRAWING
from camgeo.output.extension import Making
from camgeo.registry.formats import Form, Format
from camgeo.registry.slot import NO_CHECK
from camgeo.schema.fields import Field, FieldTable, Kind

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.output.drawing import Draw
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values

PIECES = {"arcs": "arcs", "polyline": "edges", "spline": "spans"}
"""Noun for the pieces of a contour, by the form of the drawing."""
_AS = Field("as", Kind.CHOICE, "what the contour is made of", default="arcs", choices=tuple(PIECES))


def drawing_format(
    name: str,
    *more: Field,
    path: bool = False,
    check: Callable[[Values, Values, Reader], None] = NO_CHECK,
) -> Format:
    """Facts of a format of drawings.

    `more` are options of the format, which stand in the names of its files and in reports; `path` is whether it shows
    the path of the cutter. `check`, (values of the file, values of the recipe, reader), notes faults of the options.
    """
    named = tuple(item.name for item in more)
    return Format(
        name=name,
        options=FieldTable((_AS, *more, *OF_DRAWING)),
        named=named,
        forms={
            form: Form(name=form, surfaces=2, discs=2, pieces=pieces, listed=("as", *named))
            for form, pieces in PIECES.items()
        },
        check=check,
        by_disc=True,
        path=path,
    )


def drawing_making(draw: Draw, foresee: Callable[[Job, FileRequest], None] = NO_CHECK) -> Making:
    """What makes the files of a format of drawings.

    `draw`, (job, request, path, outlines on layers, remarks), writes one file and returns the checks of all else that
    the file has; `foresee` refuses a file before anything is fitted.
    """

    def make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
        from camgeo.output.drawing import make_drawing

        return make_drawing(job, request, path, draw)

    return Making(make=make, foresee=foresee)
