"""How far a recipe is from trouble: undercut, binding, the edge of a square root; and by what errors grow."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.checks.declared import PRESSURE, REVERSAL, WALL
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

SMALL = 1e-7  # mm: an error of the profile that stands for the limit of small ones
EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Margin:
    """A distance from trouble, at which it is 0; or, where `grows` is true, a factor by which errors grow.

    `unit` mm, deg, deg/mm or none; `of` says in words what happens at 0, or what grows.
    """

    name: str
    value: float
    unit: str
    of: str
    grows: bool = False


def margins(recipe: Recipe, design: Design) -> list[Margin]:
    """Everything that applies to the scene, in mm and degrees."""
    found = _undercut(design)
    found += [Margin(*margin) for margin in design.exact.margins]
    for check in design.checks:
        if check.name == PRESSURE.name and check.value is not None:
            what = f"{check.surface} the cam cannot drive the roller".strip()
            found.append(Margin(PRESSURE.name, 90.0 - check.value, "deg", what))
        if check.name == WALL.name and check.value is not None:
            what = f"{check.surface} the bore breaks through the contour".strip()
            found.append(Margin(WALL.name, check.value, "mm", what))
    found += _linkage(design)
    found += _conditions(recipe, design)
    return found


def _undercut(design: Design) -> list[Margin]:
    found = []
    for made in design.surfaces:
        surface, value = made.surface, made.bent.value
        if value is None or math.isinf(value):  # of a ring without a hollow nothing undercuts
            continue
        roller = surface.radius
        what = f"{surface.name} {'the roller undercuts' if roller else 'the flat face loses contact'}".strip()
        found.append(Margin("undercut", value - roller, "mm", f"{what} (least radius of curvature)"))
        base = roller or surface.curve.size
        found.append(Margin("undercut-relative", (value - roller) / base, "", f"{what}, as a part of the size"))
    return found


def _linkage(design: Design) -> list[Margin]:
    if design.driven is None:
        return []
    mechanism = design.driven.mechanism
    mobility = mechanism.mobility()
    found = [Margin("binding", mobility.margin, "mm", "a loop of the linkage binds: its square root's edge")]
    if not math.isnan(mobility.least_rate):
        found.append(Margin(REVERSAL.name, mobility.least_rate, "", "the shaft would have to turn back"))
    if design.driven.figures is None:
        return found
    force = math.degrees(design.driven.figures.force_least.value)
    found.append(Margin("force-angle", force, "deg", "the force on the output link runs along it"))
    from kin.follower.frame import implied_limit

    limit = implied_limit(mechanism, SMALL)
    if limit is not None:
        unit = "deg/mm" if mechanism.unit == "deg" else ""
        found.append(
            Margin("output-condition", limit / SMALL, unit, "error of the output by that of the profile", True)
        )
    return found


def _conditions(recipe: Recipe, design: Design) -> list[Margin]:
    if not design.contours:
        return []
    factors = []
    for name, gauge in design.exact.gauges.items():
        unit, what = (
            "deg/mm" if gauge.unit == "deg" else "",
            f"{name} error of the follower by that of the profile".strip(),
        )
        factors.append(Margin("motion-condition", gauge.motion_limit(SMALL) / SMALL, unit, what, True))
    size = max(contour.size for _, contour in design.contours)
    precision = recipe.export.tolerance / (EPS * size)
    what = "tolerance over the rounding of the contour's coordinates; 64 at least"
    return [*factors, Margin("precision", precision, "", what)]
