"""The cams of many designs, sampled: one lift evaluation a distinct cam, and none where harmonics or the shaft vary."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from camgeo.cams.flat_faced import is_constant_breadth
from camgeo.capabilities.sweep.ends import least
from camgeo.capabilities.sweep.linkages import Support, angles
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.recipe import Recipe
    from kin.law.support_function import Lift

Array: TypeAlias = NDArray[np.float64]
Codes: TypeAlias = NDArray[np.uint8]

FINE, IMPOSSIBLE, UNDERCUT, OUTSIDE, BINDS, REVERSES, BROKEN = range(7)
EDGE = 1e-12  # of the breadth: how far outside the cam rounding may put a shaft on its edge


class Sampled(NamedTuple):
    """m cams: supports about the shaft, least radii of curvature in mm, whether p'' is continuous, what is wrong."""

    support: Support
    radius: Array
    smooth: NDArray[np.bool_]
    fault: Codes


class _Base(NamedTuple):
    """A cam about the origin of its own axes: breadth and least radius, mm; p, p', p'' at n angles, (3, n)."""

    breadth: float
    radius: float
    rows: Array
    smooth: bool
    fault: int


@dataclass(frozen=True)
class Cams:
    """Where the cams of a sweep come from.

    `terms` are the harmonics that vary: order (0 for the mean radius), whether of a sine, column of the values, mm per
    unit; they are 0 in `base`, but for the mean radius. `shaft` are the columns of its place, or None with its
    value in mm. `others` are the columns of all else in the cam, which a cam is made anew for.
    """

    recipe: Recipe
    paths: tuple[str, ...]
    count: int
    terms: tuple[tuple[int, bool, int, float], ...]
    shaft: tuple[tuple[int | None, float], tuple[int | None, float]]
    others: tuple[int, ...]
    base: _Base | None

    @staticmethod
    def of(recipe: Recipe, paths: Sequence[str], count: int) -> Cams:
        """Sort the fields that vary; `paths` are those of all columns, `count` is that of the angles."""
        cam, mm = recipe.cam, recipe.mm
        linear = cam.linear
        place = linear.shaft if linear is not None else (0.0, 0.0)
        of_cam = ("cam.", "linkage.") if cam.by_linkage else "cam."
        columns = {path: column for column, path in enumerate(paths) if path.startswith(of_cam)}
        shaft = tuple((columns.pop(f"cam.shaft[{i}]", None), place[i]) for i in (0, 1))
        terms = []
        for path in list(columns):
            found = linear.harmonic(path) if linear is not None else None
            if found is not None:
                order, is_sine, scale = found
                terms.append((order, is_sine, columns.pop(path), scale * mm))
        others = tuple(columns.values())
        if others:  # whatever else varies with them is part of the same cam
            others, terms = tuple(sorted({*others, *(term[2] for term in terms)})), []
        base = None if others else _base(_silent(recipe, terms), count)
        return Cams(recipe, tuple(paths), count, tuple(terms), (shaft[0], shaft[1]), others, base)

    def sampled(self, values: Array) -> Sampled:
        """Sample the cams of designs with the given values (m, k), in the recipe's units."""
        m = len(values)
        shape = (m, self.count)
        if self.base is not None:
            breadth, radius = np.full((m, 1), self.base.breadth), np.full(m, self.base.radius)
            fault, smooth = np.full(m, self.base.fault, dtype=np.uint8), np.full(m, self.base.smooth)
            rows = tuple(self.base.rows[:, None, :])
        else:
            breadth, radius, fault, smooth, rows = self._made(values)
        if self.terms:
            rows = self._harmonics(values, breadth, fault, rows)
            radius = least(rows[0] + rows[2])
        x, y = (
            (np.full((m, 1), fixed) if column is None else values[:, column : column + 1] * self.recipe.mm)
            for column, fixed in self.shaft
        )
        cosine, sine = np.cos(angles(self.count)), np.sin(angles(self.count))
        shift = x * cosine
        shift += y * sine
        p, ddp = rows[0] - shift, rows[2] + shift
        dp = rows[1] + x * sine
        dp -= y * cosine
        if self.recipe.cam.undercut == "refuse":
            fault[(fault == FINE) & ~(radius > 0.0)] = UNDERCUT
        fault[(fault == FINE) & (p.min(axis=1) < -EDGE * breadth[:, 0])] = OUTSIDE
        support = Support(breadth, *(np.broadcast_to(row, shape) for row in (p, dp, ddp)))
        return Sampled(support, radius, smooth, fault)

    def _harmonics(
        self, values: Array, breadth: Array, fault: Codes, rows: tuple[Array, ...]
    ) -> tuple[Array, Array, Array]:
        """Add the harmonics that vary, one after another: a sum by a library might round by the number of designs."""
        p, dp, ddp = (np.repeat(row, len(values), axis=0) for row in rows)
        t = angles(self.count)
        for order, is_sine, column, scale in self.terms:
            size = values[:, column : column + 1] * scale
            if order == 0:
                size = size - 0.5 * breadth
                p += size
                breadth += 2.0 * size
                continue
            if order % 2 == 0:
                fault[size[:, 0] != 0.0] = IMPOSSIBLE  # no constant breadth
            wave, slope = (np.sin, np.cos) if is_sine else (np.cos, np.sin)
            value = wave(order * t)
            p += size * value
            dp += size * (slope(order * t) * (order if is_sine else -order))
            ddp -= size * (value * order**2)
        return p, dp, ddp

    def _made(self, values: Array) -> tuple[Array, Array, Codes, NDArray[np.bool_], tuple[Array, ...]]:
        """Make each distinct cam anew."""
        own = values[:, self.others]
        distinct, which = np.unique(own, axis=0, return_inverse=True)
        found = []
        for cam in distinct:
            given = {self.paths[column]: float(value) for column, value in zip(self.others, cam, strict=True)}
            try:
                found.append(_base(load_text(self.recipe.text_with(given), self.recipe.path), self.count))
            except RecipeErrors:
                found.append(_Base(np.nan, np.nan, np.full((3, self.count), np.nan), smooth=False, fault=IMPOSSIBLE))
        which = which.reshape(-1)
        return (
            np.array([base.breadth for base in found])[which, None],
            np.array([base.radius for base in found])[which],
            np.array([base.fault for base in found], dtype=np.uint8)[which],
            np.array([base.smooth for base in found])[which],
            tuple(np.stack([base.rows[i] for base in found])[which] for i in range(3)),
        )


def _silent(recipe: Recipe, terms: Sequence[tuple[int, bool, int, float]]) -> Recipe:
    """The recipe without the harmonics that vary, but for the mean radius."""
    linear = recipe.cam.linear
    if not terms or linear is None:
        return recipe
    return replace(recipe, cam=linear.silent({(order, is_sine) for order, is_sine, _, _ in terms}))


def _base(recipe: Recipe, count: int) -> _Base:
    """Sample the cam of a recipe about the origin of its axes. An intent that does not exist is a fault."""
    from camgeo.curve.curvature import least_radius
    from camgeo.curve.curve import CurveError
    from kin.law.programme import IntentError

    linear = recipe.cam.linear
    cam = linear.about_origin() if linear is not None else recipe.cam
    nothing = _Base(np.nan, np.nan, np.full((3, count), np.nan), smooth=False, fault=IMPOSSIBLE)
    try:
        exact = cam.exact()
        lift = exact.plate
        if lift is None:
            return nothing
        (surface,) = exact.surfaces
        radius, _ = least_radius(surface.curve)
    except (IntentError, CurveError):
        return nothing
    fault = FINE if is_constant_breadth(lift) else IMPOSSIBLE
    return _Base(_breadth(lift), radius, lift.derivatives(angles(count), 2), not len(lift.breaks), fault)


def _breadth(lift: Lift) -> float:
    from camgeo.cams.flat_faced import breadth_of

    return breadth_of(lift)[0]
