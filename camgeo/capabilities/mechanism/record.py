"""Record of printed mechanisms: the key of their sizes, the option `parts` of solids, their checks and figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.mechanism.keys import PARTS, build, check, fields
from camgeo.recipe.figures import LEAST_WALL, DesignFigure, Need
from camgeo.registry.capability import Capability
from camgeo.registry.formats import Variant
from camgeo.schema.fields import Kind

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.checks.declared import Declared
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.formats import Format
    from camgeo.synthesis.design import Design

OF_BODIES = Need("a file with `parts: all`", lambda _, fields: "parts: all" in fields)
CLEARANCE, COLLISION = "clearance", "collision"
FIGURES = {
    CLEARANCE: DesignFigure(
        "least running clearance of the bodies", Kind.LENGTH, "most", OF_BODIES, swept=False, after=LEAST_WALL
    ),
    COLLISION: DesignFigure(
        "least distance between bodies over the turn", Kind.LENGTH, "most", OF_BODIES, swept=False, after=LEAST_WALL
    ),
}


def _is_mesh(record: Format) -> bool:
    """Whether files of a format hold a mesh, and so can hold every body."""
    return record.numbers is not None


def _tag(record: Format) -> str:
    """Ending of the name of a request's first file: the cam's file, or the file of all bodies."""
    if record.by_disc:
        return "cam"
    return "parts" if record.contour else "assembly"


def _foresee(job: Job, request: FileRequest) -> None:
    from camgeo.capabilities.mechanism.making import foresee_mechanism

    foresee_mechanism(job, request)


def _make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    from camgeo.capabilities.mechanism.making import make_mechanism

    return make_mechanism(job, request, path)


def _checks() -> Sequence[Declared]:
    from camgeo.capabilities.mechanism.checks import CHECKS

    return CHECKS


def _remedy(recipe: Recipe, figure: str, value: float, bound: float) -> str:
    """Words for a change that brings a figure of bodies to its bound, mm; empty for other figures."""
    if figure not in FIGURES:
        return ""
    if figure == COLLISION and value <= 0.0:
        from camgeo.capabilities.mechanism.checks import slimmer_sizes

        return slimmer_sizes(recipe)
    return f"a {'larger' if value < bound else 'smaller'} mechanism.clearance"


def _left_out(_: Recipe, requests: Sequence[FileRequest], design: Design) -> list[tuple[str, str]]:
    """The capability with the reason why it makes no bodies; empty where it makes them."""
    from camgeo.capabilities.mechanism import LABEL
    from camgeo.capabilities.mechanism.checks import NAME
    from camgeo.checks.declared import STANDS

    if not any(request.variant == NAME for request in requests):
        return [(NAME, LABEL.absent)]
    driven = design.driven
    return [] if driven is None or driven.turns else [(NAME, STANDS)]


CAPABILITY = Capability(
    fields=fields,
    build=build,
    figures=FIGURES,
    checks=_checks,
    remedy=_remedy,
    variant=Variant(option=PARTS, offered=_is_mesh, tag=_tag, check=check, foresee=_foresee, make=_make),
    left_out=_left_out,
)
