"""Figures of many cams at once, without a linkage: estimates, from which a sweep chooses what it works out exactly.

An extreme between two samples is that of the parabola through three of them. How far the estimates are off was
measured (`FigureEstimate.error`); whatever a sweep keeps is certified by the exact design.

The contours follow from the sampled motions: the moving frame of a round touch, a face's support function. Formulas as
in `camgeo.curve.moving_frame`, `camgeo.curve.disc` and `camgeo.curve.support`, over arrays (m, n) of m designs at n
samples; lengths mm, angles rad. `sound` (m,) says which designs can be driven at all, where the exact cam would raise
IntentError.
"""

from __future__ import annotations

import math
from functools import cache, cached_property
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from camgeo.capabilities.sweep.cams import EDGE, FINE, IMPOSSIBLE, OUTSIDE, UNDERCUT
from camgeo.capabilities.sweep.extension import ESTIMATES
from camgeo.capabilities.sweep.keys import varied_fields
from camgeo.capabilities.sweep.samples import Template, sample_cam
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
from camgeo.schema.errors import RecipeErrors
from kin.law.normalised import IntentError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.capabilities.sweep.cams import Codes
    from camgeo.capabilities.sweep.samples import CamSample, MotionBatch
    from camgeo.recipe.limits import Limit
    from camgeo.recipe.recipe import Recipe
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Mask

DESIGNS = 1000  # random ones on which the errors of the estimates were measured
_SAFETY = 2.0  # times the greatest error measured: estimates that miss a bound by less are computed exactly too
_BLOCK = 24_000  # samples of a block: two dozen arrays of them stay in a cache
_QUARTER = 0.5 * np.pi

Sizes: TypeAlias = "dict[str, Array]"


class Contours(NamedTuple):
    """m contours; arrays (m, n) where no other shape is named.

    sound     (m,) whether there is such a contour
    slope     tangent of the pressure angle
    distance  of the contour from the shaft, squared, mm^2
    bend      curvature of the centre's path, 1/mm, for a round touch; None for a face
    radius    of curvature of the contour, mm, for a face; None for a round touch
    contact   place along a face, mm; None for a round touch
    spin      turns of a roller per turn of the shaft; None for a face and a point
    outside   (m,) whether the shaft lies outside
    lean      (m, 1) tangent of the pressure angle at which an eccentric stem begins to rise
    """

    sound: Mask
    slope: Array
    distance: Array
    bend: Array | None = None
    radius: Array | None = None
    contact: Array | None = None
    spin: Array | None = None
    outside: Mask | None = None
    lean: Array | None = None


def _centre_path(b: Array, a: Array, rates: tuple[Array, Array, Array | float]) -> tuple[Array, Array]:
    """Speed of the centre, mm/rad, and curvature of its path, 1/mm; `rates` are b', a' and tau'."""
    b1, a1, travel = rates
    square = a * a + b * b
    speed = np.sqrt(square)
    return speed, (travel + (b1 * a - a1 * b) / square) / speed


def _spin(sizes: Sizes, side: Side, speed: Array, travel: Array | float) -> Array | None:
    """Turns of a roller per turn of the shaft (m, n); None for a touch of radius 0."""
    return side * speed / sizes["radius"] - travel if (sizes["radius"] > 0.0).all() else None


def _stem(sizes: Sizes, side: Side, rows: Array) -> Contours:
    """Contours for a round touch on a stem: the centre at d + S along its line, d^2 = Rp^2 - e^2."""
    e, radius = sizes["offset"], side * sizes["radius"]
    prime = sizes["base"] + radius
    foot = np.sqrt(np.maximum((prime - e) * (prime + e), 0.0))
    b, a = foot + rows[0], rows[1] - e
    sound = ((prime > np.abs(e)) & (b.min(axis=1, keepdims=True) > 0.0))[:, 0]
    speed, bend = _centre_path(b, a, (rows[1], rows[2], 1.0))
    share = radius / speed
    distance = (b - share * b) ** 2 + (e + share * a) ** 2
    lean = np.abs(e) / np.maximum(foot, 1e-300)
    return Contours(sound, a / b, distance, bend, spin=_spin(sizes, side, speed, 1.0), lean=lean)


def _arm(sizes: Sizes, side: Side, rows: Array) -> Contours:
    """Contours for a round touch on an arm: psi = rest + S at the pivot, between the shaft and the arm."""
    pivot, length, sense, radius = sizes["pivot"], sizes["length"], sizes["side"], side * sizes["radius"]
    prime = sizes["base"] + radius
    low, high = (prime - pivot + length) * (prime + pivot - length), pivot + length - prime
    reached = (low > 0.0) & (high > 0.0) & (prime > 0.0)
    low, high = np.where(reached, low, 1.0), np.where(reached, high * (pivot + length + prime), 1.0)
    psi = 2.0 * np.arctan2(np.sqrt(low), np.sqrt(high)) + rows[0]
    sound = reached[:, 0] & (psi.min(axis=1) > 0.0) & (psi.max(axis=1) < np.pi)
    sine, cosine = np.sin(psi), np.cos(psi)
    b = pivot * sine
    a = length * rows[1] - sense * (pivot * cosine - length)
    travel = 1.0 + sense * rows[1]
    rates = pivot * cosine * rows[1], length * rows[2] + sense * b * rows[1], travel
    speed, bend = _centre_path(b, a, rates)
    # N = E(psi - 90 deg, in the arm's sense)(b - i a)/sigma, seen from the line to the pivot
    share = radius / speed
    x = pivot - length * cosine - share * (sine * b - sense * cosine * a)
    y = -sense * length * sine + share * (sine * a + sense * cosine * b)
    return Contours(sound, a / b, x * x + y * y, bend, spin=_spin(sizes, side, speed, travel))


def _stem_face(sizes: Sizes, side: Side, rows: Array) -> Contours:  # noqa: ARG001 - a table of one signature
    """Contours for a face on a stem, its normal turned ahead of travel by the tilt."""
    base, tilt, e = sizes["base"], sizes["tilt"], sizes["offset"]
    sine, cosine = np.sin(tilt), np.cos(tilt)
    p, q = base + cosine * rows[0], cosine * rows[1]
    level = (base - e * sine) / cosine
    contact = q + (rows[0] + level) * sine - e * cosine
    radius = base + cosine * (rows[0] + rows[2])
    sound = np.ones(len(p), dtype=np.bool_)
    slope = np.tan(tilt) + 0.0 * p
    return Contours(sound, slope, p * p + q * q, radius=radius, contact=contact)


def _arm_face(sizes: Sizes, side: Side, rows: Array) -> Contours:  # noqa: ARG001 - a table of one signature
    """Contours for a face on an arm, nearer the cam than its parallel through the pivot."""
    pivot, nearer, sense = sizes["pivot"], sizes["nearer"], sizes["side"]
    share = (sizes["base"] + nearer) / pivot
    reached = (share > 0.0) & (share < 1.0)
    psi = np.arcsin(np.where(reached, share, 0.5)) + rows[0]
    turn = 1.0 + sense * rows[1]
    sound = reached[:, 0] & (psi.min(axis=1) > 0.0) & (psi.max(axis=1) < _QUARTER) & (turn.min(axis=1) > 0.0)
    sine, cosine = pivot * np.sin(psi), pivot * np.cos(psi)
    p, q = sine - nearer, cosine * rows[1] / turn
    rate = (cosine * rows[2] - sine * rows[1] ** 2) / turn - q * sense * rows[2] / turn
    contact = cosine / turn
    return Contours(sound, nearer / contact, p * p + q * q, radius=p + rate / turn, contact=contact)


def plate(rows: Array) -> Contours:
    """Contours of plates under a face at right angles to its travel.

    `rows` are the support functions p, mm, and at least two derivatives by rad, (m, n) each.
    """
    p, q = rows[0], rows[1]
    outside = p.min(axis=1) < -EDGE * p.max(axis=1)
    sound = np.ones(len(p), dtype=np.bool_)
    return Contours(sound, 0.0 * p, p * p + q * q, radius=p + rows[2], contact=q, outside=outside)


GUIDED: dict[tuple[str, bool], Callable[[Sizes, Side, Array], Contours]] = {
    ("mm", True): _stem,
    ("deg", True): _arm,
    ("mm", False): _stem_face,
    ("deg", False): _arm_face,
}
"""Contours of guided followers, by the unit of the guide's motion and whether the touch is round."""


@dataclass(frozen=True, eq=False)
class ScreenedCams:
    """Sampled cams of m designs at n places each, from which figures are estimated.

    `side` is 1 where the metal lies inside the contour, -1 outside, as in a ring.
    """

    recipe: Recipe
    motion: MotionBatch
    contours: Contours
    side: Side

    def most(self, rows: Array) -> Array:
        """Greatest value (m,) of rows (m, n) over the turn, between samples by parabolas."""
        left, middle, right = rows[:, :-2], rows[:, 1:-1], rows[:, 2:]
        bend, lean = 2.0 * middle - left - right, right - left
        crest = self.motion.inside & (bend > 0.0) & (np.abs(lean) <= 2.0 * bend)
        more = np.divide(lean * lean, 8.0 * bend, out=np.zeros_like(bend), where=crest)
        greatest: Array = np.maximum(rows.max(axis=1), (middle + more).max(axis=1))
        return greatest

    def least(self, rows: Array) -> Array:
        """Least value (m,) of rows (m, n) over the turn, between samples by parabolas."""
        return -self.most(-rows)

    def greatest(self, rows: Array) -> Array:
        """Greatest absolute value (m,) of rows (m, n) over the turn, between samples by parabolas."""
        return np.maximum(self.most(rows), self.most(-rows))

    @property
    def scale(self) -> float:
        """Factor from the motion's mm or rad to mm or degrees."""
        return 1.0 if self.recipe.cam.arrangement.unit == "mm" else math.degrees(1.0)

    @cached_property
    def bend(self) -> tuple[Array, Array]:
        """Greatest curvature of the pitch curve, 1/mm (m,), where the metal lies inside its bend, and outside.

        Both are at least 0. Raises TypeError for a flat face, which has no centre.
        """
        rows = self.contours.bend
        if rows is None:
            raise TypeError("no contact has a centre")
        ends = np.maximum(self.most(rows), 0.0), np.maximum(self.most(-rows), 0.0)
        return ends if self.side > 0 else ends[::-1]

    @cached_property
    def pitch(self) -> Array:
        """Least radius of curvature that decides undercut, mm (m,): of the pitch curve, or of a flat face's contour.

        Of a pitch curve that nowhere bends round the metal it is infinite.
        """
        if self.contours.radius is not None:
            return self.least(self.contours.radius)
        with np.errstate(divide="ignore"):
            return 1.0 / self.bend[0]

    @property
    def undercut(self) -> Mask:
        """Mask (m,) of the cams with undercut: the least radius of the pitch curve is not above the roller radius."""
        return ~(self.pitch > self.size("radius"))

    @property
    def hollow(self) -> Array:
        """Least radius of curvature where the contour is concave, mm (m,); infinite where it is convex.

        Raises TypeError for a flat face, whose contour is convex.
        """
        with np.errstate(divide="ignore"):
            return 1.0 / self.bend[1] + self.size("radius")

    def size(self, name: str) -> Array:
        """Size of this name of each cam, mm or rad (m,); raises KeyError for a size that the follower lacks."""
        return self.motion.sizes[name][:, 0]

    @property
    def reach(self) -> Array:
        """Greatest distance of the contour from the shaft, of a ring the least, mm (m,)."""
        return np.sqrt(self.most(self.contours.distance) if self.side > 0 else self.least(self.contours.distance))

    @property
    def slope(self) -> Array:
        """Tangent of the pressure angle, above 0 on the rise, (m, n)."""
        return self.contours.slope

    @property
    def lean(self) -> Array | None:
        """Tangent of the pressure angle at rest, at least 0, (m,); None without a round touch on a stem."""
        return None if self.contours.lean is None else self.contours.lean[:, 0]

    @property
    def contact(self) -> Array:
        """Place of the contact along a flat face, mm (m, n); raises TypeError for another follower."""
        rows = self.contours.contact
        if rows is None:
            raise TypeError("no contact travels along a face")
        return rows

    def peak(self, order: int, speed: float = 1.0) -> Array:
        """Greatest absolute derivative of the motion, mm or degrees (m,), of `order` 1 to 3.

        It is by radian of the shaft angle, or, at a `speed` in rad/s, by time in s.
        """
        return self.scale * speed**order * self.greatest(self.motion.rows[order])

    def spin(self) -> Array:
        """Greatest speed of the roller, turns per turn of the shaft (m,); raises TypeError without a roller."""
        if self.contours.spin is None:
            raise TypeError("no roller turns")
        return self.greatest(self.contours.spin)


def _degrees(slope: Array) -> Array:
    return np.degrees(np.arctan(slope))


class FigureEstimate(NamedTuple):
    """Estimate of a figure: `compute` gives it in mm and degrees, (m,).

    `error` is the greatest error measured, in degrees where `in_degrees`, else as a share of the value; None for an
    exact figure.
    """

    compute: Callable[[ScreenedCams], Array]
    error: float | None = None
    in_degrees: bool = False


def _swing(cams: ScreenedCams) -> Array:
    return cams.scale * (cams.most(cams.motion.rows[0]) - cams.least(cams.motion.rows[0]))


def _on_return(cams: ScreenedCams) -> Array:
    return _degrees(cams.most(-cams.slope))


def _pivot_clearance(cams: ScreenedCams) -> Array:
    return cams.side * (cams.size("pivot") - cams.reach)


_CORE: dict[str, FigureEstimate] = {
    "swing": FigureEstimate(_swing, 8.3e-6),
    PEAKS[0]: FigureEstimate(lambda cams: cams.peak(1), 1.3e-5),
    PEAKS[1]: FigureEstimate(lambda cams: cams.peak(2), 5.5e-5),
    PEAKS[2]: FigureEstimate(lambda cams: cams.peak(3), 6.3e-6),
    PRESSURE_ANGLE: FigureEstimate(lambda cams: _degrees(cams.greatest(cams.slope)), 3.7e-4, in_degrees=True),
    ON_RISE: FigureEstimate(lambda cams: _degrees(cams.most(cams.slope)), 3.7e-4, in_degrees=True),
    ON_RETURN: FigureEstimate(_on_return, 3.7e-4, in_degrees=True),
    RADIUS: FigureEstimate(lambda cams: cams.pitch - cams.size("radius"), 3.2e-4),
    PITCH_RADIUS: FigureEstimate(lambda cams: cams.pitch, 3.2e-4),
    HOLLOW_RADIUS: FigureEstimate(lambda cams: cams.hollow, 1.2e-3),
    SIZE: FigureEstimate(lambda cams: np.sqrt(cams.most(cams.contours.distance)), 1.6e-6),
    PIVOT_CLEARANCE: FigureEstimate(_pivot_clearance, 3.1e-5),
    CONTACT_TRAVEL: FigureEstimate(lambda cams: cams.most(cams.contact) - cams.least(cams.contact), 1.0e-5),
    FACE_WIDTH: FigureEstimate(lambda cams: 2.0 * cams.greatest(cams.contact), 4.2e-6),
    ROLLER_SPEED: FigureEstimate(ScreenedCams.spin, 2.5e-6),
    BASE_RADIUS: FigureEstimate(lambda cams: cams.size("base")),
    OFFSET: FigureEstimate(lambda cams: cams.size("offset")),
    PIVOT: FigureEstimate(lambda cams: cams.size("pivot")),
}
"""Estimates of the core's figures, with the greatest error on DESIGNS designs (`benchmarks/sweep.py screen`).

The designs are of every follower on a stem and on an arm, in a disc and in a ring, of constant breadth and by a support
function, with each law of the catalogue, at 360 angles.
"""


@cache
def estimates() -> dict[str, FigureEstimate]:
    """Estimates by the names of their figures: the core's first, then the capabilities'."""
    every = ESTIMATES.of(ESTIMATES.answering())
    return _CORE | {name: FigureEstimate(*estimate) for each in every for name, estimate in each.estimates.items()}


def allowance(name: str, value: float) -> float:
    """Greatest error to be expected of an estimate near `value`, in the figure's unit.

    It is 0 for an exact figure, and for one without an estimate.
    """
    estimate = estimates().get(name)
    if estimate is None or estimate.error is None:
        return 0.0
    return _SAFETY * estimate.error * (1.0 if estimate.in_degrees else abs(value))


def slack(limit: Limit) -> float:
    """Amount, in the figure's unit, by which estimates may miss a limit while the exact figure may keep it."""
    return max(allowance(limit.figure, bound) for bound in (limit.at_least, limit.at_most) if bound is not None)


def error_of(name: str, estimate: float, exact: float) -> float:
    """Error of an estimate, at least 0, for nan 0: of an angle in degrees, else as a share of the exact value."""
    if estimate == exact or np.isnan(estimate):
        return 0.0
    return abs(estimate - exact) / (1.0 if estimates()[name].in_degrees else max(abs(exact), 1e-300))


@dataclass(frozen=True, eq=False)
class Screen:
    """Estimates the figures `names` of a sweep's cams, with metal inside their contours (`side` 1) or outside (-1)."""

    recipe: Recipe
    names: tuple[str, ...]
    side: Side
    contours: Callable[[MotionBatch], Contours]
    template: Template

    @staticmethod
    def prepare(recipe: Recipe, paths: Sequence[str], names: Sequence[str], count: int) -> Screen | str:
        """Screen of cams that differ at `paths`, at about `count` angles; or, in words, why there is none."""
        if recipe.linkage is not None:
            return "it has a linkage"
        if unknown := [name for name in names if name not in estimates()]:
            return f"{unknown[0]} is not sampled"
        if recipe.cam.undercut == "trim":
            return "undercut is trimmed"
        if recipe.settled is not None:
            return "an angle of its motion is found for each design"

        def sample(values: Array, counts: tuple[int, ...]) -> CamSample | None:
            numbers = {path: float(value) for path, value in zip(paths, values, strict=True)}
            try:
                return sample_cam(load_text(recipe.text_with(numbers), recipe.path).cam, count, counts)
            except (RecipeErrors, IntentError):
                return None

        # the followers, and the single closed contour, whose motion can be sampled
        ranges = {axis.path: axis for axis in varied_fields(recipe)}
        low, high = np.array([(ranges[path].low, ranges[path].high) for path in paths], dtype=float).reshape(-1, 2).T
        try:
            exact = recipe.cam.exact()
            surfaces = exact.surfaces
        except IntentError:
            return "the cam does not exist as the recipe has it"
        arrangement, offers = recipe.cam.arrangement, recipe.cam.arrangement.offers
        guided = GUIDED[arrangement.unit, "roller" in offers] if "guided" in offers else None
        if len(surfaces) > 1 or not surfaces[0].curve.closed or (guided is None and exact.plate is None):
            return "its contour is not sampled"
        template = Template.fit(sample, low, high)
        if template is None:
            return "no design turned up in the midst of the ranges"
        side = surfaces[0].side

        def contours(motion: MotionBatch) -> Contours:
            if exact.plate is not None or guided is None:
                return plate(motion.rows)
            return guided(motion.sizes, side, motion.rows)

        return Screen(recipe, tuple(names), side, contours, template)

    def estimate(self, values: Array) -> tuple[dict[str, Array], Codes]:
        """Estimates by name, (m,) each, and fault codes (m,), indices into REASONS, of m designs.

        `values` (m, k) are those at the paths given to `prepare`, in the recipe's units. Estimated lengths are in mm,
        angles in degrees; designs with a fault have nan.
        """
        m = len(values)
        figures, faults = {name: np.full(m, np.nan) for name in self.names}, np.full(m, IMPOSSIBLE, dtype=np.uint8)
        step = max(1, _BLOCK // self.template.centre_cam.rows.shape[1])
        for first in range(0, m, step):
            block = values[first : first + step]
            for index, motion in self.template.sample_designs(block):
                rows = index + first
                with np.errstate(all="ignore"):
                    cams = ScreenedCams(self.recipe, motion, self.contours(motion), self.side)
                    code = np.where(cams.undercut, UNDERCUT, FINE)
                    if cams.contours.outside is not None:
                        code[cams.contours.outside] = OUTSIDE
                    code[~cams.contours.sound] = IMPOSSIBLE
                    faults[rows] = code
                    for name in self.names:
                        figures[name][rows] = np.where(code == FINE, estimates()[name].compute(cams), np.nan)
        return figures, faults
