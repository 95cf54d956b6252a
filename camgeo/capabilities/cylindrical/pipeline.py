"""What cylindrical cams answer in a run, from a recipe to files on disk and a verdict on them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.cylindrical.checks_of import design_checks, limits_held, remarks_on
from camgeo.capabilities.cylindrical.exact import designed
from camgeo.capabilities.cylindrical.figures import figures_of
from camgeo.capabilities.cylindrical.making import foresee, make
from camgeo.capabilities.cylindrical.section import drum_section
from camgeo.capabilities.cylindrical.verdicts import file_rows, judged_file
from camgeo.measures.units import report_unit
from camgeo.output.own_kind import OwnKind, Told

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.common.clock import Clock
    from camgeo.measures.placed import Figure
    from camgeo.output.own_kind import Made
    from camgeo.recipe.export import FileRequest
    from kin.cylindrical.verdict import DrumVerdict
    from kin.numeric.check import Check

FOLLOWER = "roller on a carriage along the axis"


def _examined(design: DrumDesign, _: Clock) -> tuple[list[Check], tuple[Figure, ...]]:
    figures = tuple(figures_of(design))
    return design_checks(design, figures), figures


def _told(design: DrumDesign, figures: Sequence[Figure]) -> Told:
    unit = report_unit(design.recipe, "mm")
    return Told(FOLLOWER, remarks_on(design, figures), design.motion.kept, unit)


def _section(design: DrumDesign, figures: Sequence[Figure]) -> dict[str, Any]:
    return {"drum": drum_section(design, figures)}


def _rows(design: DrumDesign, verdict: DrumVerdict) -> dict[str, Any]:
    return file_rows(design.recipe, verdict)


def _maker(design: DrumDesign, clock: Clock) -> Callable[[FileRequest, Path], Made[DrumVerdict]]:
    return partial(make, design, clock)


def _pieces(verdict: DrumVerdict) -> int:
    return sum(flank.pieces or 0 for flank in verdict.flanks)


def _page(design: DrumDesign, made: Sequence[Made[DrumVerdict]], report: dict[str, Any]) -> str:
    from camgeo.capabilities.cylindrical.drum_page import page

    return page(design, made, report)


DRUMS = OwnKind(
    designed=designed,
    examined=_examined,
    limited=limits_held,
    told=_told,
    section=_section,
    rows=_rows,
    foresee=foresee,
    maker=_maker,
    judged=judged_file,
    pieces=_pieces,
    page=_page,
    formats=("stl", "ply", "3mf", "step", "dxf"),
)
