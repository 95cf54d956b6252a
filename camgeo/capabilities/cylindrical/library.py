"""Designs of cylindrical cams for the library, exact and without files; texts of failed checks; expected checks."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.api.log import stage_reporter
from camgeo.api.own_kind import DesignInRun, angles_of, foreseen_with, order_of
from camgeo.capabilities.cylindrical.checks import LENGTH, RIB
from camgeo.capabilities.cylindrical.exact import designed
from camgeo.capabilities.cylindrical.figures import CONTACT_PRESSURE
from camgeo.capabilities.cylindrical.gentler import gentler
from camgeo.capabilities.cylindrical.sheet import points_of
from camgeo.checks.declared import FORM_CLOSURE, LIMIT, WATERTIGHT
from camgeo.common.arguments import numbers_of
from camgeo.common.clock import Clock
from camgeo.common.errors import CallError
from camgeo.common.rounding import downward, upward
from camgeo.recipe.figures import LEAST_WALL, PRESSURE_ANGLE
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe
    from camgeo.checks.declaration import Entry
    from camgeo.output.own_kind import OwnKind
    from camgeo.recipe.export import FileRequest
    from camgeo.synthesis.expected_checks import Foreseen
    from kin.numeric.arrays import Array

FIELDS = {
    PRESSURE_ANGLE: "cam.motion",
    LENGTH: "cam.follower",
    RIB: "cam.track.rib.distance",
    LEAST_WALL: "part",
}
"""Keys that a check of the exact drum names where it fails."""


@dataclass(frozen=True, eq=False)
class CylindricalCam(DesignInRun):
    """The exact drum of a cylindrical cam; no file is made. Checks and figures are in the recipe's units."""

    recipe: DrumRecipe
    _design: DrumDesign = field(repr=False)

    @property
    def kind(self) -> OwnKind[Any, Any]:
        """The kind of the cam in a run."""
        from camgeo.capabilities.cylindrical.pipeline import DRUMS

        return DRUMS

    def motion(self, theta: ArrayLike, *, derivative: int = 0) -> Array:
        """Lift, mm, of an arm its swing, rad, at shaft angles, rad, in their shape, or a derivative up to the sixth.

        Raises CallError for another order and for angles that are not finite; TypeError for what is no number.
        """
        places, order = angles_of(theta), order_of(derivative)
        return np.asarray(self._design.law.derivatives(places.ravel(), order)[order].reshape(places.shape))

    def flank(self, theta: ArrayLike, radius: float, *, upper: bool = False) -> Array:
        """Points (n, 3), mm, of the lower flank, or of the upper one, on a cylinder about the axis.

        They are touched at shaft angles (n,), rad, and lie where the drum is made, mirrored for `rotation: ccw`. Raises
        CallError for a flank that the drum does not have, and for a radius outside floor and blank.
        """
        name, recipe = ("upper" if upper else "lower"), self.recipe
        if name not in self._design.flanks:
            raise CallError(f"this drum has no {name} flank")
        if not recipe.floor <= radius <= recipe.radius:
            raise CallError(f"flanks reach from {recipe.floor:.9g} to {recipe.radius:.9g} mm")
        places = numbers_of("theta", theta).ravel()
        points = points_of(self._design.flanks[name], places, np.full(places.shape, float(radius)))
        return np.asarray(points * [1.0, recipe.sense, 1.0])


def cam_of(recipe: DrumRecipe) -> CylindricalCam:
    """Design a cylindrical cam; raises RecipeErrors where there is none."""
    return CylindricalCam(recipe, designed(recipe, Clock(stage_reporter(recipe))))


def remedy(check: Entry, recipe: DrumRecipe) -> str:
    """Change that would let a check of the exact drum hold; empty where none is known."""
    name, value, limit = check["name"], check.get("value"), check.get("limit")
    if value is None or limit is None or "file" in check:
        return ""
    share = 100.0 * limit / value if value else 0.0
    if name == f"{LIMIT}{PRESSURE_ANGLE}" and check["sense"] == "at_most":
        if recipe.swings or recipe.roller.taper:
            return gentler(recipe, float(np.radians(limit)))
        factor = np.tan(np.radians(value)) / np.tan(np.radians(limit))
        inner = f"{upward(recipe.roller.inner / recipe.mm * factor, 5)} {recipe.units}"
        return f"a larger drum, whose roller begins at {inner} from the axis, or a longer motion"
    if name in {f"{LIMIT}velocity", f"{LIMIT}acceleration"}:
        turns = (limit / value) ** (1.0 if name.endswith("velocity") else 0.5) * (recipe.drive.rpm or 0.0)
        return f"cam.drive.rpm of at most {downward(turns, 5)}"
    if name in {f"{LIMIT}{force}" for force in ("contact-force", "side-thrust", "axial-thrust", "torque")}:
        return f"a load of {downward(share, 4)} percent"
    if name in {f"{LIMIT}{CONTACT_PRESSURE}", f"{LIMIT}{CONTACT_PRESSURE}-middle"}:
        return f"a load of {downward(1e-2 * share * share, 4)} percent"
    if name == f"{LIMIT}play":
        return (
            f"a clearance of at most {downward(recipe.track.clearance / recipe.mm * limit / value, 4)} {recipe.units}"
        )
    return ""


OF_SOLIDS = ("volume", "floor", "blank", "ends")
"""Checks of every solid, beside those of its flanks and its bore."""


def foreseen(recipe: DrumRecipe) -> tuple[Foreseen, ...]:
    """Checks that the report is sure to have."""
    expected = [PRESSURE_ANGLE, LENGTH, *([RIB] if RIB in recipe.track.figures else []), LEAST_WALL]
    return foreseen_with(expected, recipe, recipe.limits, partial(_of_file, recipe))


def _of_file(recipe: DrumRecipe, request: FileRequest) -> list[str]:
    """Names of the checks of a file."""
    if request.kind == "dxf":
        return ["units", "contour", "motion"]
    if request.format.program:
        names = ["cutter", "rapid", "ways", "feed", "depth", "contour", "motion"]
        return names if recipe.track.unmilled else [*names, "cleared"]
    names = [WATERTIGHT.name, "contour", "motion", *OF_SOLIDS]
    names += ["bore"] if recipe.part.bore is not None else []
    return [*names, FORM_CLOSURE.name] if recipe.track.closed else names
