"""The cams of many designs, sampled; one lift serves all that differ in harmonics or shaft alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sweep.linkages import Support, angles
from camgeo.capabilities.sweep.windows import least
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array, Mask

    Codes = NDArray[np.uint8]

# why a design has no figures, or not all
REASONS = ("", "impossible", "undercut", "shaft-outside", "binds", "reverses", "limits")
FINE, IMPOSSIBLE, UNDERCUT, OUTSIDE, BINDS, REVERSES, BROKEN = range(7)
EDGE = 1e-12  # of the breadth: a shaft on the cam's edge may lie outside by so much, for rounding


class CamBatch(NamedTuple):
    """m sampled cams: `support` has their support functions about the shaft.

    `radius` (m,) is the least radius of curvature of the contour, mm, `smooth` (m,) whether the second derivative of
    the support function is continuous, and `fault` (m,) an index into REASONS, 0 for a cam without a fault.
    """

    support: Support
    radius: Array
    smooth: Mask
    fault: Codes


class _CentredCam(NamedTuple):
    """A cam about the origin of its own axes: breadth and least radius of curvature, mm.

    `rows` (3, n) are the support function p, mm, and its two derivatives by the angle, at n even angles. `smooth` says
    whether the second derivative is continuous, `fault` is an index into REASONS.
    """

    breadth: float
    radius: float
    rows: Array
    smooth: bool
    fault: int

    @staticmethod
    def missing(count: int) -> _CentredCam:
        """Entry for a cam that does not exist: nan, with the fault IMPOSSIBLE."""
        return _CentredCam(np.nan, np.nan, np.full((3, count), np.nan), smooth=False, fault=IMPOSSIBLE)

    @staticmethod
    def sample(recipe: Recipe, count: int) -> _CentredCam:
        """Cam of a recipe at `count` angles, with a fault where it does not exist or its breadth varies."""
        from camgeo.cams.flat_faced import breadth_of, is_constant_breadth
        from camgeo.curve.curvature import least_radius
        from camgeo.curve.curve import CurveError
        from kin.law.normalised import IntentError

        linear = recipe.cam.linear
        cam = linear.about_origin() if linear is not None else recipe.cam
        try:
            exact = cam.exact()
            lift = exact.plate
            if lift is None:
                return _CentredCam.missing(count)
            (surface,) = exact.surfaces
            radius, _ = least_radius(surface.curve)
        except (IntentError, CurveError):
            return _CentredCam.missing(count)
        fault = FINE if is_constant_breadth(lift) else IMPOSSIBLE
        rows = lift.derivatives(angles(count), 2)
        return _CentredCam(breadth_of(lift)[0], radius, rows, not len(lift.breaks), fault)


class _Harmonic(NamedTuple):
    """A harmonic that varies: its `order`, 0 for the mean radius, and whether it is a sine or a cosine.

    `column` is the place of its amplitude among the values of a design, `scale` is mm in the unit of the amplitude.
    """

    order: int
    is_sine: bool
    column: int
    scale: float


@dataclass(frozen=True)
class CamSampler:
    """Samples the cams of a sweep's designs.

    `paths` are the fields that vary, a column of the values each, and `count` is the number of angles. `harmonics` are
    those that vary; they are 0 in `base`, but for the mean radius. `shaft` has, for x and y, the column or None, and
    the recipe's value in mm. `others` are the columns of all other fields of the cam: where there are any, each
    distinct cam is made, `harmonics` are empty and `base` is None.
    """

    recipe: Recipe
    paths: tuple[str, ...]
    count: int
    harmonics: tuple[_Harmonic, ...]
    shaft: tuple[tuple[int | None, float], tuple[int | None, float]]
    others: tuple[int, ...]
    base: _CentredCam | None

    @staticmethod
    def prepare(recipe: Recipe, paths: Sequence[str], count: int) -> CamSampler:
        """Sampler of cams that differ in the fields at `paths`, at `count` angles, a multiple of 4.

        Paths outside the cam are left alone.
        """
        cam, mm = recipe.cam, recipe.mm
        linear = cam.linear
        place = linear.shaft if linear is not None else (0.0, 0.0)
        of_cam = ("cam.", "linkage.") if cam.by_linkage else "cam."
        columns = {path: column for column, path in enumerate(paths) if path.startswith(of_cam)}
        shaft = tuple((columns.pop(f"cam.shaft[{i}]", None), place[i]) for i in (0, 1))
        harmonics = []
        for path in list(columns):
            harmonic = linear.harmonic(path) if linear is not None else None
            if harmonic is not None:
                order, is_sine, scale = harmonic
                harmonics.append(_Harmonic(order, is_sine, columns.pop(path), scale * mm))
        others, base = tuple(columns.values()), None
        if others:  # harmonics that vary beside them are part of the same cam
            others, harmonics = tuple(sorted({*others, *(harmonic.column for harmonic in harmonics)})), []
        elif harmonics and linear is not None:
            silent = linear.without_harmonics({(harmonic.order, harmonic.is_sine) for harmonic in harmonics})
            base = _CentredCam.sample(replace(recipe, cam=silent), count)
        else:
            base = _CentredCam.sample(recipe, count)
        return CamSampler(recipe, tuple(paths), count, tuple(harmonics), (shaft[0], shaft[1]), others, base)

    def sample(self, values: Array) -> CamBatch:
        """Sample the cams of m designs; `values` (m, k) are those at the k paths, in the recipe's units."""
        m = len(values)
        shape = (m, self.count)
        if self.base is not None:
            breadth, radius = np.full((m, 1), self.base.breadth), np.full(m, self.base.radius)
            fault, smooth = np.full(m, self.base.fault, dtype=np.uint8), np.full(m, self.base.smooth)
            rows = tuple(self.base.rows[:, None, :])
        else:
            breadth, radius, fault, smooth, rows = self._make_each(values)
        if self.harmonics:
            rows = self._add_harmonics(values, breadth, fault, rows)
            radius = least(rows[0] + rows[2])
        x, y = (
            (np.full((m, 1), fixed) if column is None else values[:, column : column + 1] * self.recipe.mm)
            for column, fixed in self.shaft
        )
        cosine, sine = np.cos(angles(self.count)), np.sin(angles(self.count))
        # about the shaft (x, y) the support function is p - x cos t - y sin t
        shift = x * cosine
        shift += y * sine
        p, ddp = rows[0] - shift, rows[2] + shift
        dp = rows[1] + x * sine
        dp -= y * cosine
        if self.recipe.cam.undercut == "refuse":
            fault[(fault == FINE) & ~(radius > 0.0)] = UNDERCUT
        fault[(fault == FINE) & (p.min(axis=1) < -EDGE * breadth[:, 0])] = OUTSIDE
        support = Support(breadth, *(np.broadcast_to(row, shape) for row in (p, dp, ddp)))
        return CamBatch(support, radius, smooth, fault)

    def _add_harmonics(
        self, values: Array, breadth: Array, fault: Codes, rows: tuple[Array, ...]
    ) -> tuple[Array, Array, Array]:
        """Rows p, p', p'' with the harmonics that vary; `breadth` and `fault` are changed in place.

        They are added one after another: a library's sum might round differently for another number of designs.
        """
        p, dp, ddp = (np.repeat(row, len(values), axis=0) for row in rows)
        t = angles(self.count)
        for order, is_sine, column, scale in self.harmonics:
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

    def _make_each(self, values: Array) -> tuple[Array, Array, Codes, Mask, tuple[Array, ...]]:
        """Breadths, radii, faults, smoothness and rows of the designs' cams, each distinct cam made once."""
        distinct, group = np.unique(values[:, self.others], axis=0, return_inverse=True)
        cams = []
        for row in distinct:
            numbers = {self.paths[column]: float(value) for column, value in zip(self.others, row, strict=True)}
            try:
                recipe = load_text(self.recipe.text_with(numbers), self.recipe.path)
            except RecipeErrors:
                cams.append(_CentredCam.missing(self.count))
            else:
                cams.append(_CentredCam.sample(recipe, self.count))
        group = group.reshape(-1)
        return (
            np.array([cam.breadth for cam in cams])[group, None],
            np.array([cam.radius for cam in cams])[group],
            np.array([cam.fault for cam in cams], dtype=np.uint8)[group],
            np.array([cam.smooth for cam in cams])[group],
            tuple(np.stack([cam.rows[i] for cam in cams])[group] for i in range(3)),
        )
