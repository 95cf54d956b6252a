"""Shop drawings as files: a PDF and a DXF of each disc, made when all other files are judged."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.sheet.options import OPTIONS, check_sheet
from camgeo.output.extension import Making
from camgeo.registry.formats import Format

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.extension import RunResults
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest


def _foresee(_job: Job, _request: FileRequest) -> None:
    from importlib.util import find_spec

    if find_spec("fpdf") is None:
        from camgeo.files.errors import MissingExtraError, install

        raise MissingExtraError(f"a shop drawing needs fpdf2: {install('sheet')}")


def _summarise(run: RunResults, request: FileRequest, path: Path) -> MadeFiles:
    from camgeo.capabilities.sheet.drawing import make_sheets

    return make_sheets(run, request, path)


FORMAT = Format(
    name="sheet",
    suffix="pdf",
    tail="sheet",
    options=OPTIONS,
    check=check_sheet,
    contour=False,
    part=False,
    by_disc=True,
    summary=True,
)
MAKING = Making(summarise=_summarise, foresee=_foresee)
