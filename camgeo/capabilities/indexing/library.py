"""Designs of indexing cams for the library, exact and without files; texts of failed checks; expected checks."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.api.log import stage_reporter
from camgeo.api.own_kind import DesignInRun, angles_of, foreseen_with, order_of
from camgeo.capabilities.indexing.exact import designed
from camgeo.capabilities.indexing.keys import LENGTH, RIB
from camgeo.checks.declared import FORM_CLOSURE, LIMIT, WATERTIGHT
from camgeo.common.clock import Clock
from camgeo.common.errors import CallError
from camgeo.common.rounding import downward
from camgeo.curve.curve import CurveError
from camgeo.recipe.figures import LEAST_WALL, PRESSURE_ANGLE
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.index_recipe import IndexRecipe
    from camgeo.checks.declaration import Entry
    from camgeo.output.own_kind import OwnKind
    from camgeo.recipe.export import FileRequest
    from camgeo.synthesis.expected_checks import Foreseen
    from kin.numeric.arrays import Array

FIELDS = {PRESSURE_ANGLE: "cam.motion", LENGTH: "cam.turret", RIB: "cam.turret.roller", LEAST_WALL: "part"}
"""Keys that a check of the exact cam names where it fails."""


@dataclass(frozen=True, eq=False)
class IndexingCam(DesignInRun):
    """The exact cam of an indexing drive; no file is made. Checks and figures are in the recipe's units."""

    recipe: IndexRecipe
    _design: IndexDesign = field(repr=False)

    @property
    def kind(self) -> OwnKind[Any, Any]:
        """The kind of the cam in a run."""
        from camgeo.capabilities.indexing.pipeline import INDEXERS

        return INDEXERS

    def motion(self, theta: ArrayLike, *, derivative: int = 0) -> Array:
        """Angle of the turret above its start, rad, at any shaft angles, rad, in their shape, or a derivative.

        After each turn it is further on by the pitch of the rollers. Derivatives are known up to the sixth. Raises
        CallError for another order and for angles that are not finite; TypeError for what is no number.
        """
        places, order = angles_of(theta), order_of(derivative)
        return np.asarray(self._design.law.derivatives(places.ravel(), order)[order].reshape(places.shape))

    def flank(self, theta: ArrayLike, layer: float, *, upper: bool = False) -> Array:
        """Points (n, 3), mm, of the lower flank, or of the upper one, in a layer, mm.

        A layer of a barrel is a cylinder about its axis, one of a globoid a torus about the turret's. At the shaft
        angles (n,), rad, the points are touched by the roller that stands at the start at 0; the other rollers are
        whole turns further on. The cam is as it is made, mirrored for `rotation: ccw`. Raises CallError for a layer
        outside floor and blank, and for angles at which the roller does not touch it.
        """
        recipe, (low, high) = self.recipe, self.recipe.layers
        if not low <= layer <= high:
            raise CallError(f"flanks reach from {low:.9g} to {high:.9g} mm")
        places = angles_of(theta).ravel()
        try:
            contact = self._design.flanks["upper" if upper else "lower"].on(places, float(layer))
        except CurveError as error:
            raise CallError("the roller does not touch that layer at one of these shaft angles") from error
        return np.asarray(recipe.form.points(contact.phi, contact.h, contact.w) * [1.0, recipe.sense, 1.0])


def cam_of(recipe: IndexRecipe) -> IndexingCam:
    """Design an indexing cam; raises RecipeErrors where there is none."""
    return IndexingCam(recipe, designed(recipe, Clock(stage_reporter(recipe))))


def remedy(check: Entry, recipe: IndexRecipe) -> str:
    """Change that would let a check of the exact cam hold; empty where none is known."""
    name, value, limit = check["name"], check.get("value"), check.get("limit")
    if value is None or limit is None or "file" in check:
        return ""
    if name == f"{LIMIT}{PRESSURE_ANGLE}" and check["sense"] == "at_most":
        return "a larger cam, or a longer motion"
    if name in {f"{LIMIT}velocity", f"{LIMIT}acceleration"}:
        turns = (limit / value) ** (1.0 if name.endswith("velocity") else 0.5) * (recipe.drive.rpm or 0.0)
        return f"cam.drive.rpm of at most {downward(turns, 5)}"
    loads = {f"{LIMIT}{each}": 1.0 for each in ("contact-force", "turret-torque", "torque")}
    loads[f"{LIMIT}contact-pressure"] = 2.0
    if name in loads:
        share = downward(100.0 * (limit / value) ** loads[name], 4)
        return f"a load and an inertia of {share} percent" if recipe.drive.inertia else f"a load of {share} percent"
    if name == f"{LIMIT}play":
        least = downward(recipe.clearance / recipe.mm * limit / value, 4)
        return f"a clearance of at most {least} {recipe.units}"
    return ""


OF_SOLIDS = ("volume", "floor", "blank", "ends")
"""Checks of every solid, beside those of its flanks and its bore."""


def foreseen(recipe: IndexRecipe) -> tuple[Foreseen, ...]:
    """Checks that the report is sure to have."""
    return foreseen_with((PRESSURE_ANGLE, LENGTH, RIB, LEAST_WALL), recipe, recipe.limits, partial(_of_file, recipe))


def _of_file(recipe: IndexRecipe, request: FileRequest) -> list[str]:
    """Names of the checks of a file."""
    if request.kind == "dxf":
        return ["units", "contour", "motion"]
    names = [WATERTIGHT.name, "contour", "motion", *OF_SOLIDS]
    names += ["bore"] if recipe.part.bore is not None else []
    return [*names, FORM_CLOSURE.name]
