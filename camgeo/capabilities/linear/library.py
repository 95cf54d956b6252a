"""Designs of linear cams for the library, exact and without files; texts of failed checks; expected checks."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.api.log import stage_reporter
from camgeo.api.own_kind import DesignInRun, foreseen_with, order_of
from camgeo.capabilities.linear.design import designed
from camgeo.checks.declared import FORM_CLOSURE, WATERTIGHT
from camgeo.common.arguments import numbers_of
from camgeo.common.clock import Clock
from camgeo.common.errors import CallError
from camgeo.recipe.figures import LEAST_WALL, PITCH_RADIUS, PRESSURE_ANGLE
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.capabilities.linear.keys import LinearRecipe
    from camgeo.checks.declaration import Entry
    from camgeo.output.own_kind import OwnKind
    from camgeo.recipe.export import FileRequest
    from camgeo.synthesis.expected_checks import Foreseen
    from kin.numeric.arrays import Array

FIELDS = {
    PRESSURE_ANGLE: "cam.motion",
    PITCH_RADIUS: "cam.follower.radius",
    "undercut": "cam.follower.radius",
    LEAST_WALL: "part",
    "chamfer": "part.chamfer",
}


@dataclass(frozen=True, eq=False)
class LinearCam(DesignInRun):
    """The exact plate of a linear cam; no file is made. Checks and figures are in the recipe's units."""

    recipe: LinearRecipe
    _design: LinearDesign = field(repr=False)

    @property
    def kind(self) -> OwnKind[Any, Any]:
        """The kind of the cam in a run."""
        from camgeo.capabilities.linear.pipeline import PLATES

        return PLATES

    @property
    def travel(self) -> float:
        """Travel of the motion, of one period where it is endless, mm."""
        return self._design.total

    def motion(self, travel: ArrayLike, *, derivative: int = 0) -> Array:
        """Lift, mm, or swing, rad, at places of the travel, mm, or a derivative by it, up to the sixth.

        The result has the shape of `travel`. Raises CallError for another order, and for places that are not finite or
        outside the motion; TypeError for places that are no numbers.
        """
        places, order = numbers_of("travel", travel), order_of(derivative)
        outside = not self.recipe.endless and ((places < 0.0) | (places > self._design.total)).any()
        if outside or not np.isfinite(places).all():
            raise CallError(f"places of the travel are from 0 to {self._design.total:.9g} mm")
        flat = places.ravel()
        rows = self._design.path.law.derivatives(flat, order, self._design.sides(flat))
        return np.asarray(rows[order].reshape(places.shape))

    def flank(self, travel: ArrayLike, *, upper: bool = False) -> Array:
        """Points (n, 2), mm, as drawn, that are touched at places of the travel (n,), mm; or of its upper flank.

        Raises CallError for an upper flank of a plate without a groove.
        """
        flank = self._design.upper if upper else self._design.lower
        if flank is None:
            raise CallError("only a groove has an upper flank")
        u = numbers_of("travel", travel).ravel()
        return self._design.drawn(flank.shape.sample(u, self._design.sides(u)).point)

    def _repr_svg_(self) -> str:
        from camgeo.capabilities.linear.plate_page import drawing

        return drawing(self._design)

    def _drawing(self) -> str:
        return self._repr_svg_()


def cam_of(recipe: LinearRecipe) -> LinearCam:
    """Design a linear cam; raises RecipeErrors where there is none."""
    return LinearCam(recipe, designed(recipe, Clock(stage_reporter(recipe))))


def remedy(check: Entry, recipe: LinearRecipe) -> str:
    """Change that would let a check of the exact plate hold; empty where none is known."""
    from camgeo.common.rounding import downward, upward

    name, value, limit = check["name"], check.get("value"), check.get("limit")
    if value is None or limit is None or "file" in check:
        return ""
    if name == "limit:pressure-angle" and check["sense"] == "at_most":
        return f"sizing: {{pressure-angle: {{at_most: {limit:.6g}}}}} under cam, which finds the travel"
    if name == "chamfer":
        return f"a chamfer below {downward(value)} {check['unit']}" if value > 0.0 else "no chamfer"
    if name == "limit:radius-of-curvature" and check["sense"] == "at_least":
        less = limit - value
        if less * recipe.mm >= recipe.follower.radius:
            return "a longer motion"
        return f"a follower.radius smaller by {upward(less)} {check['unit']}, or a longer motion"
    if name == "limit:velocity":
        return f"a speed of {100.0 * limit / value:.3g} percent"
    if name == "limit:acceleration":
        return f"a speed of {100.0 * (limit / value) ** 0.5:.3g} percent"
    if name in {"limit:contact-force", "limit:drive-force"}:
        return f"a load of {100.0 * limit / value:.3g} percent"
    return ""


OF_PROGRAM = ("cutter", "arcs", "rapid", "depth", "direction", "entry", "gouge")


def foreseen(recipe: LinearRecipe) -> tuple[Foreseen, ...]:
    """Checks that the report is sure to have."""
    plate = recipe.plate
    expected = [PRESSURE_ANGLE]
    if recipe.follower.radius:
        expected += [PITCH_RADIUS, "undercut"]
    if plate.chamfer:
        expected.append("chamfer")
    if recipe.groove or plate.holes or plate.slots or plate.mark:
        expected.append(LEAST_WALL)
    return foreseen_with(expected, recipe, recipe.limits, partial(_of_file, recipe))


def _of_file(recipe: LinearRecipe, request: FileRequest) -> list[str]:
    """Names of the checks of a file; the motion of what may be trimmed is judged only by a limit that is given."""
    plate, record = recipe.plate, request.format
    if record.program:
        names = [*OF_PROGRAM, "closed", "holes"]
    elif record.solid:
        layered = recipe.groove is not None or plate.chamfer or (plate.mark and plate.mark.mark.kind == "engrave")
        names = [WATERTIGHT.name, "thickness"]
        names += ["holes"] if plate.holes or plate.slots or not layered else []
    else:
        names = ["closed", "holes", *(() if request.compensation else ("units",))]
        names += ["outer"] if recipe.groove else []
    if not record.program and not request.compensation:
        names += ["mark"] if plate.mark else []
        names += ["chamfer"] if plate.chamfer and record.solid else []
    names += ["contour"] if recipe.endless else ["contour", "ends"]
    names += [] if recipe.trims and recipe.verify.motion_error is None else ["motion"]
    return [*names, FORM_CLOSURE.name] if recipe.groove else names
