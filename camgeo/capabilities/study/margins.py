"""Margins of a recipe: its distance from undercut, from binding and other failures; factors by which errors grow."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING

from camgeo.checks.declared import PRESSURE, REVERSAL, WALL
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

SMALL = 1e-7  # mm: an error of the profile small enough that its effect is linear


@dataclass(frozen=True)
class FailureMargin:
    """Distance from a failure, at which it is 0; or, where `grows` is true, a factor by which errors grow.

    `unit` is mm, deg, deg/mm or none; `of` says in words what happens at 0, or what grows.
    """

    name: str
    value: float
    unit: str
    of: str
    grows: bool = False


def margins(recipe: Recipe, design: Design) -> list[FailureMargin]:
    """All margins and factors that a design has, in mm and degrees."""
    margins = _undercut_margins(design)
    margins += [FailureMargin(*margin) for margin in design.exact.margins]
    for check in design.checks:
        if check.name == PRESSURE.name and check.value is not None:
            what = f"{check.surface} the cam cannot drive the roller".strip()
            margins.append(FailureMargin(PRESSURE.name, 90.0 - check.value, "deg", what))
        if check.name == WALL.name and check.value is not None:
            what = f"{check.surface} the bore breaks through the contour".strip()
            margins.append(FailureMargin(WALL.name, check.value, "mm", what))
    return [*margins, *_linkage_margins(design), *_error_factors(recipe, design)]


def _undercut_margins(design: Design) -> list[FailureMargin]:
    """Distance of each surface from undercut: mm, and as a share of the roller radius or of the size."""
    margins = []
    for drawn in design.surfaces:
        surface, value = drawn.surface, drawn.bent.value
        if value is None or math.isinf(value):  # a ring without a hollow cannot undercut
            continue
        roller = surface.radius
        what = f"{surface.name} {'the roller undercuts' if roller else 'the flat face loses contact'}".strip()
        margins.append(FailureMargin("undercut", value - roller, "mm", f"{what} (least radius of curvature)"))
        base = roller or surface.curve.size
        margins.append(
            FailureMargin("undercut-relative", (value - roller) / base, "", f"{what}, as a part of the size")
        )
    return margins


def _linkage_margins(design: Design) -> list[FailureMargin]:
    """Distances of a linkage from binding, reversal and a force along the link; the factor of its output's error."""
    if design.driven is None:
        return []
    mechanism = design.driven.mechanism
    mobility = mechanism.mobility()
    margins = [FailureMargin("binding", mobility.margin, "mm", "a loop of the linkage binds: its square root's edge")]
    if not math.isnan(mobility.least_rate):
        margins.append(FailureMargin(REVERSAL.name, mobility.least_rate, "", "the shaft would have to turn back"))
    if design.driven.figures is None:
        return margins
    force = math.degrees(design.driven.figures.force_least.value)
    margins.append(FailureMargin("force-angle", force, "deg", "the force on the output link runs along it"))
    from kin.follower.frame import implied_limit

    limit = implied_limit(mechanism, SMALL)
    if limit is not None:
        unit = "deg/mm" if mechanism.unit == "deg" else ""
        what = "error of the output by that of the profile"
        margins.append(FailureMargin("output-condition", limit / SMALL, unit, what, True))
    return margins


def _error_factors(recipe: Recipe, design: Design) -> list[FailureMargin]:
    """Factors by which errors of the profile act on the follower, for each gauge; tolerance over rounding error."""
    if not design.contours:
        return []
    factors = []
    for name, gauge in design.exact.gauges.items():
        unit = "deg/mm" if gauge.unit == "deg" else ""
        what = f"{name} error of the follower by that of the profile".strip()
        factors.append(FailureMargin("motion-condition", gauge.motion_limit(SMALL) / SMALL, unit, what, True))
    size = max(contour.size for _, contour in design.contours)
    precision = recipe.export.tolerance / (sys.float_info.epsilon * size)
    what = "tolerance over the rounding of the contour's coordinates; 64 at least"
    return [*factors, FailureMargin("precision", precision, "", what)]
