"""Figures of many cams at once, without a linkage: estimates, from which a sweep chooses what it works out exactly.

An extreme between two samples is that of the parabola through three of them. What the estimates may be off by was
measured (`Estimated.error`, `benchmarks/sweep.py screen`); whatever a sweep keeps is certified by the exact design.
"""

from __future__ import annotations

import math
from functools import cache, cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sweep.cams import FINE, IMPOSSIBLE, OUTSIDE, UNDERCUT
from camgeo.capabilities.sweep.contours import MAKERS, plate
from camgeo.capabilities.sweep.estimate_errors import DEGREES, ERRORS
from camgeo.capabilities.sweep.keys import varied
from camgeo.capabilities.sweep.samples import Template, shot_of
from camgeo.recipe.figures import (
    BASE_RADIUS,
    CONTACT_TRAVEL,
    FACE_WIDTH,
    HOLLOW_RADIUS,
    OFFSET,
    ON_RETURN,
    ON_RISE,
    PEAKS,
    PITCH_RADIUS,
    PIVOT,
    PIVOT_CLEARANCE,
    PRESSURE_ANGLE,
    RADIUS,
    ROLLER_SPEED,
    SIZE,
)
from camgeo.recipe.loading import load_text
from camgeo.registry import registry
from camgeo.schema.errors import RecipeErrors
from kin.law.programme import IntentError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.capabilities.sweep.cams import Codes
    from camgeo.capabilities.sweep.contours import Contours
    from camgeo.capabilities.sweep.samples import Sampled, Shot
    from camgeo.recipe.recipe import Recipe
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Mask

_BLOCK = 24_000  # samples of a block: two dozen arrays of them stay in a cache


@dataclass(frozen=True, eq=False)
class Cams:
    """Cams of m designs, sampled: what figures are taken from."""

    recipe: Recipe
    sampled: Sampled
    contours: Contours
    side: Side

    def most(self, rows: Array) -> Array:
        """Greatest value of rows (m, n) over the turn, (m,)."""
        left, middle, right = rows[:, :-2], rows[:, 1:-1], rows[:, 2:]
        bent, leaning = 2.0 * middle - left - right, right - left
        crest = self.sampled.inside & (bent > 0.0) & (np.abs(leaning) <= 2.0 * bent)
        more = np.divide(leaning * leaning, 8.0 * bent, out=np.zeros_like(bent), where=crest)
        greatest: Array = np.maximum(rows.max(axis=1), (middle + more).max(axis=1))
        return greatest

    def least(self, rows: Array) -> Array:
        """Least value."""
        return -self.most(-rows)

    def greatest(self, rows: Array) -> Array:
        """Greatest absolute value."""
        return np.maximum(self.most(rows), self.most(-rows))

    @property
    def scale(self) -> float:
        """What positions are reported in: mm as they are, rad in degrees."""
        return 1.0 if self.recipe.cam.arrangement.unit == "mm" else math.degrees(1.0)

    @cached_property
    def bend(self) -> tuple[Array, Array]:
        """Greatest curvature of a centre's path where the metal lies inside its bend, and outside, 1/mm; or 0."""
        rows = self.contours.bend
        if rows is None:
            raise TypeError("no centre is led")
        ends = np.maximum(self.most(rows), 0.0), np.maximum(self.most(-rows), 0.0)
        return ends if self.side > 0 else ends[::-1]

    @cached_property
    def pitch(self) -> Array:
        """Least radius where the cam may undercut, mm (m,): of the centre's path, or of a face's contour."""
        if self.contours.radius is not None:
            return self.least(self.contours.radius)
        with np.errstate(divide="ignore"):
            return 1.0 / self.bend[0]

    @property
    def touch(self) -> Array:
        """Radius of the touch, mm (m,)."""
        return self.sampled.sizes["radius"][:, 0]

    @property
    def undercut(self) -> Mask:
        """Where the contour turns back."""
        return ~(self.pitch > self.touch)

    @property
    def hollow(self) -> Array:
        """Least radius of the metal's hollows, mm, infinite without one."""
        with np.errstate(divide="ignore"):
            return 1.0 / self.bend[1] + self.touch

    def size(self, name: str) -> Array:
        """One of the sizes (m,)."""
        return self.sampled.sizes[name][:, 0]

    @property
    def reach(self) -> Array:
        """Greatest distance of the contour from the shaft, of a ring the least, mm."""
        return np.sqrt(self.most(self.contours.distance) if self.side > 0 else self.least(self.contours.distance))

    @property
    def slope(self) -> Array:
        """Tangent of the pressure angle, above 0 on the rise, (m, n)."""
        return self.contours.slope

    @property
    def lean(self) -> Array | None:
        """Tangent of the pressure angle at rest, (m,); None without a stem."""
        return None if self.contours.lean is None else self.contours.lean[:, 0]

    @property
    def contact(self) -> Array:
        """Where a face is touched, mm (m, n)."""
        rows = self.contours.contact
        if rows is None:
            raise TypeError("no contact travels along a face")
        return rows

    def peak(self, order: int, speed: float = 1.0) -> Array:
        """Greatest derivative of the motion by the shaft angle, or at a speed, rad/s, by time."""
        return self.scale * speed**order * self.greatest(self.sampled.rows[order])

    def spin(self) -> Array:
        """Greatest speed of the roller."""
        if self.contours.spin is None:
            raise TypeError("no roller turns")
        return self.greatest(self.contours.spin)


def _degrees(slope: Array) -> Array:
    return np.degrees(np.arctan(slope))


_CORE: dict[str, Callable[[Cams], Array]] = {
    "swing": lambda cams: cams.scale * (cams.most(cams.sampled.rows[0]) - cams.least(cams.sampled.rows[0])),
    PEAKS[0]: lambda cams: cams.peak(1),
    PEAKS[1]: lambda cams: cams.peak(2),
    PEAKS[2]: lambda cams: cams.peak(3),
    PRESSURE_ANGLE: lambda cams: _degrees(cams.greatest(cams.contours.slope)),
    ON_RISE: lambda cams: _degrees(cams.most(cams.contours.slope)),
    ON_RETURN: lambda cams: _degrees(cams.most(-cams.contours.slope)),
    RADIUS: lambda cams: cams.pitch - cams.touch,
    PITCH_RADIUS: lambda cams: cams.pitch,
    HOLLOW_RADIUS: lambda cams: cams.hollow,
    SIZE: lambda cams: np.sqrt(cams.most(cams.contours.distance)),
    PIVOT_CLEARANCE: lambda cams: cams.side * (cams.size("pivot") - cams.reach),
    CONTACT_TRAVEL: lambda cams: cams.most(cams.contact) - cams.least(cams.contact),
    FACE_WIDTH: lambda cams: 2.0 * cams.greatest(cams.contact),
    ROLLER_SPEED: Cams.spin,
    BASE_RADIUS: lambda cams: cams.size("base"),
    OFFSET: lambda cams: cams.size("offset"),
    PIVOT: lambda cams: cams.size("pivot"),
}
"""How a figure of the core is estimated, in mm and degrees (m,)."""


class Estimated(NamedTuple):
    """How a figure is estimated, and the greatest error seen, as `camgeo.registry.capability.Estimate` has them."""

    of: Callable[[Cams], Array]
    error: float | None
    in_degrees: bool


@cache
def estimates() -> dict[str, Estimated]:
    """Give every figure that is estimated, those of capabilities behind the core's."""
    found = {name: Estimated(of, ERRORS.get(name), name in DEGREES) for name, of in _CORE.items()}
    for capability in registry.in_order(registry.recorded()):
        found |= {name: Estimated(*estimate) for name, estimate in capability.estimates().items()}
    return found


@dataclass(frozen=True, eq=False)
class Screen:
    """Estimates of the figures `names` of cams that differ at paths, from samples at about `count` angles."""

    recipe: Recipe
    names: tuple[str, ...]
    side: Side
    make: Callable[[Sampled], Contours]
    template: Template

    @staticmethod
    def of(recipe: Recipe, paths: Sequence[str], names: Sequence[str], count: int) -> Screen | str:
        """Prepare for a recipe's sweep; the reason in words where its designs cannot be screened."""
        if recipe.linkage is not None:
            return "it has a linkage"
        if unknown := [name for name in names if name not in estimates()]:
            return f"{unknown[0]} is not sampled"
        if recipe.cam.undercut == "trim":
            return "undercut is trimmed"
        if recipe.settled is not None:
            return "an angle of its motion is found for each design"

        def shoot(values: Array, counts: tuple[int, ...]) -> Shot | None:
            given = {path: float(value) for path, value in zip(paths, values, strict=True)}
            try:
                return shot_of(load_text(recipe.text_with(given), recipe.path).cam, count, counts)
            except (RecipeErrors, IntentError):
                return None

        ranges = {axis.path: axis for axis in varied(recipe)}
        ends = [(ranges[path].values or (ranges[path].low, ranges[path].high)) for path in paths]
        try:
            exact = recipe.cam.exact()
            surfaces = exact.surfaces
        except IntentError:
            return "the cam does not exist as the recipe has it"
        arrangement, offers = recipe.cam.arrangement, recipe.cam.arrangement.offers
        maker = MAKERS[arrangement.unit, "roller" in offers] if "guided" in offers else None
        if len(surfaces) > 1 or not surfaces[0].curve.closed or (maker is None and exact.plate is None):
            return "its contour is not sampled"
        template = Template.of(shoot, np.array([min(end) for end in ends]), np.array([max(end) for end in ends]))
        if template is None:
            return "no design turned up in the midst of the ranges"
        side = surfaces[0].side

        def make(sampled: Sampled) -> Contours:
            if exact.plate is not None or maker is None:
                return plate(sampled.rows)
            return maker(sampled.sizes, side, sampled.rows)

        return Screen(recipe, tuple(names), side, make, template)

    def found(self, values: Array) -> tuple[dict[str, Array], Codes]:
        """Estimates by name, (m,) each, nan without a cam, and what is wrong (m,), of designs with values (m, k)."""
        m = len(values)
        figures, faults = {name: np.full(m, np.nan) for name in self.names}, np.full(m, IMPOSSIBLE, dtype=np.uint8)
        step = max(1, _BLOCK // self.template.shot.rows.shape[1])
        for first in range(0, m, step):
            block = values[first : first + step]
            for index, sampled in self.template.sampled(block):
                rows = index + first
                with np.errstate(all="ignore"):
                    cams = Cams(self.recipe, sampled, self.make(sampled), self.side)
                    code = np.where(cams.undercut, UNDERCUT, FINE)
                    if cams.contours.outside is not None:
                        code[cams.contours.outside] = OUTSIDE
                    code[~cams.contours.sound] = IMPOSSIBLE
                    faults[rows] = code
                    for name in self.names:
                        figures[name][rows] = np.where(code == FINE, estimates()[name].of(cams), np.nan)
        return figures, faults
