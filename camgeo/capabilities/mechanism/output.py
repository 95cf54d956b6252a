"""Files of printed bodies, and why a run leaves them out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.mechanism import LABEL
from camgeo.capabilities.mechanism.checks import NAME
from camgeo.checks.declared import STANDS
from camgeo.output.extension import Output

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def _foresee(job: Job, request: FileRequest) -> None:
    from camgeo.capabilities.mechanism.making import foresee_mechanism

    foresee_mechanism(job, request)


def _make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    from camgeo.capabilities.mechanism.making import make_mechanism

    return make_mechanism(job, request, path)


def _left_out(_: Recipe, requests: Sequence[FileRequest], design: Design) -> list[tuple[str, str]]:
    """The capability with the reason why it makes no bodies; empty where it makes them."""
    if not any(request.variant == NAME for request in requests):
        return [(NAME, LABEL.absent)]
    driven = design.driven
    return [] if driven is None or driven.turns else [(NAME, STANDS)]


ANSWERS = Output(foresee=_foresee, make=_make, left_out=_left_out)
