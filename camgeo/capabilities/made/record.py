"""What the part in hand adds: a key, and the judging of points in `camgeo verify`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.made.keys import CORRECT, build, check, check_corrected, fields, offered, zone_of
from camgeo.registry.capability import CallOption, Capability, FileJudge
from camgeo.registry.formats import Alteration

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from camgeo.cams.family import ExactCam
    from camgeo.checks.declared import Declared
    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Order, Recipe
    from camgeo.registry.capability import FileCall, Results, ShaftCam
    from camgeo.synthesis.design import Design

OPTIONS = {
    "as": CallOption("what a table of numbers is: by its heading if not given", choices=("measured", "grinding")),
    "align": CallOption(
        "place the points by least squares before the motion is judged too (default: none)",
        choices=("none", "rotation", "best-fit"),
    ),
    "probe_radius": CallOption("points are centres of a ball of this radius; of a lift, that of its roller", "R"),
    "probe_face": CallOption("of a lift, the indicator has a flat face of this width on the stem's line", "W"),
    "probe_error": CallOption("expanded uncertainty (k = 2) of a point along its normal", "U"),
    "axes_error": CallOption("that of the part's axes: a length and an angle in degrees, 0.005,0.02", "L,DEG"),
    "spans": CallOption("spans of the smoothed deviation (default: by cross-validation)", "N"),
    "out": CallOption("write a page, a drawing and a table of measured points into this folder", "DIR"),
}


def _checks() -> Sequence[Declared]:
    from camgeo.capabilities.made.checks import CHECKS

    return CHECKS


def _claims(path: Path, options: Mapping[str, object]) -> bool:
    from camgeo.capabilities.made.options import claims

    return claims(path, options)


def _judge(recipe: Recipe, design: Design, call: FileCall, clock: Clock) -> Results:
    from camgeo.capabilities.made.verify import judge

    return judge(recipe, design, call, clock)


def _judge_shaft(recipe: Order, cams: Sequence[ShaftCam], call: FileCall, clock: Clock) -> Results:
    from camgeo.capabilities.made.verify import judge_shaft

    return judge_shaft(recipe, cams, call, clock)


def _examine(recipe: Recipe, design: Design, _: Sequence[FileResult], clock: Clock) -> Results:
    from camgeo.capabilities.made.earlier_runs import examine

    return examine(recipe, design, clock)


def _lines(report: dict[str, Any]) -> str:
    from camgeo.capabilities.made.earlier_runs import lines

    return lines(report)


def _panel(report: dict[str, Any]) -> str:
    from camgeo.capabilities.made.earlier_runs import panel

    return panel(report)


def _shown(report: dict[str, Any], everything: bool) -> str:
    from camgeo.capabilities.made.section_text import shown

    return shown(report, everything=everything)


def _profile(recipe: Recipe) -> tuple[str, float] | None:
    """Field and width, mm, of the tolerance zone of a measured contour; None for a recipe without it."""
    zone = zone_of(recipe)
    return None if zone is None else ("made.profile", zone)


def _corrected(recipe: Recipe, design: Design, exact: ExactCam, share: float, scale: float) -> ExactCam:
    from camgeo.capabilities.made.correction import corrected

    return corrected(recipe, design, exact, share, scale)


CAPABILITY = Capability(
    fields=fields,
    check=check,
    build=build,
    profile=_profile,
    checks=_checks,
    examine=_examine,
    lines=_lines,
    panel=_panel,
    judges=FileJudge(_claims, OPTIONS, _judge, _judge_shaft, _shown),
    alteration=Alteration(option=CORRECT, offered=offered, check=check_corrected, alter=_corrected),
)
