"""A cam's motion and sizes as plain numbers, and how they follow the numbers of its recipe.

A motion is sampled over the pieces between its breaks, each on an even grid of its own with both ends, and its
derivatives are taken by the share of the piece. So strokes, harmonics and the shaft's place change them linearly, and
angles change the widths of pieces alone, whatever the family. The numbers of a sweep are tried one by one: those that
act linearly only move the samples by their slopes; for the others the motion is sampled anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.cams.family import Cam, ExactCam
    from kin.numeric.arrays import Array, Indices, Mask

ORDER = 3  # derivatives of the motion: figures need as many
_LEAST_CELLS = 12  # of a piece, however narrow
_ROUNDING = 1e-9  # of the greatest value: where a number acts linearly the samples deviate by less
_TRIALS = (0.5, 0.0, 1.0, 0.25, 0.75)  # shares of all ranges at which a design is looked for
_RANDOM_TRIALS = 24  # and so many elsewhere


class CamSample(NamedTuple):
    """Sizes of a cam by name, mm and rad, widths of the pieces of its motion (p,), rad, and the motion sampled on them.

    `rows` (4, n) are the motion, mm or rad, and its derivatives by the share of a piece, at the ends of all cells.
    `counts` (p,) are the cells of the pieces. A plate's motion is its support function, any other's the displacement.
    """

    sizes: dict[str, float]
    widths: Array
    rows: Array
    counts: tuple[int, ...]

    def comparable(self, other: CamSample) -> bool:
        """Whether both have sizes of the same names, and as many cells in each piece."""
        return tuple(self.sizes) == tuple(other.sizes) and self.counts == other.counts

    def plus(self, other: CamSample, factor: float) -> CamSample:
        """Sum of the sample and `factor` times another that is comparable, number by number."""
        sizes = {name: value + factor * other.sizes[name] for name, value in self.sizes.items()}
        return CamSample(sizes, self.widths + factor * other.widths, self.rows + factor * other.rows, self.counts)

    def equals(self, other: CamSample) -> bool:
        """Whether two samples are the same but for rounding."""
        if not self.comparable(other):
            return False
        sizes = np.array(list(self.sizes.values())), np.array(list(other.sizes.values()))
        pairs = [sizes, (self.widths, other.widths), *zip(self.rows, other.rows, strict=True)]
        return all(
            np.allclose(a, b, rtol=0.0, atol=_ROUNDING * max(np.nanmax(np.abs(a)), 1e-300), equal_nan=True)
            for a, b in pairs
        )


Sampling: TypeAlias = Callable[["Array"], "CamSample | None"]


class MotionBatch(NamedTuple):
    """Cams of m designs: sizes by name (m, 1); the motion and its derivatives by rad, (4, g, n), where g is m or 1.

    `inside` (n - 2,) says which of the samples but the first and the last lie within a piece.
    """

    sizes: dict[str, Array]
    rows: Array
    inside: Mask


def _sizes(cam: Cam, exact: ExactCam) -> dict[str, float]:
    """Radius of the base circle, mm, and the numbers of the first contact's guide and touch, mm and rad, by name."""
    first = exact.follower.contacts[0]
    numbers = {**vars(first.guide), **vars(first.touch)}
    sizes = {name: float(value) for name, value in numbers.items() if isinstance(value, int | float)}
    base = next((circle.radius for circle in cam.circles() if circle.radius is not None), math.nan)
    return {"base": base, "radius": 0.0, **sizes}


def sample_cam(cam: Cam, count: int, counts: tuple[int, ...] = ()) -> CamSample:
    """Sample a cam at about `count` angles of a turn.

    `counts` are the numbers of cells of the pieces; they are used only for a cam with as many pieces. Raises
    IntentError for a cam that does not exist.
    """
    exact = cam.exact()
    repeats = min(surface.base.shape.repeats for surface in exact.surfaces)
    period = TURN / repeats
    breaks = exact.breaks[exact.breaks < period * (1.0 - 1e-12)]
    begins = breaks if len(breaks) else np.zeros(1)
    widths = np.diff(np.append(begins, begins[0] + period))
    if len(counts) != len(widths):
        counts = tuple(max(_LEAST_CELLS, math.ceil(count * width / TURN)) for width in widths)
    share = np.concatenate([np.arange(n + 1) / n for n in counts])
    piece = np.repeat(np.arange(len(counts)), np.array(counts) + 1)
    theta = begins[piece] + share * widths[piece]
    law = exact.motion.rows if exact.plate is None else exact.plate.derivatives
    ends = share == 1.0
    rows = np.empty((ORDER + 1, len(theta)))
    rows[:, ~ends], rows[:, ends] = law(theta[~ends], ORDER, 1), law(theta[ends], ORDER, -1)
    return CamSample(_sizes(cam, exact), widths, rows * widths[piece] ** np.arange(ORDER + 1)[:, None], counts)


@dataclass(frozen=True, eq=False)
class Template:
    """Cam in dependence on the numbers (k,) of a recipe: a centre, and a slope for each number that acts linearly.

    `resampled` are the columns of the other numbers, for which the motion is sampled anew. `sample` gives the cam with
    some numbers, None where there is none; `centre_cam` is the cam with the numbers `centre`.
    """

    sample: Sampling
    centre: Array
    centre_cam: CamSample
    slopes: dict[int, CamSample]
    resampled: tuple[int, ...]

    @staticmethod
    def fit(
        sample_cells: Callable[[Array, tuple[int, ...]], CamSample | None], low: Array, high: Array
    ) -> Template | None:
        """Template for numbers between `low` and `high` (k,); None where no design that is tried exists.

        `sample_cells` samples the cam with the numbers (k,) at given counts of cells, () for its own, and returns None
        where there is no cam.
        """
        trials = (*(low + share * (high - low) for share in _TRIALS), *_random_numbers(low, high))
        centres = ((numbers, sample_cells(numbers, ())) for numbers in trials)
        centre, cam = next(((numbers, cam) for numbers, cam in centres if cam is not None), (low, None))
        if cam is None:
            return None
        slopes, resampled = dict[int, CamSample](), list[int]()
        template = Template(lambda numbers: sample_cells(numbers, cam.counts), centre, cam, slopes, ())
        for column in range(len(centre)):
            slope = template._slope(column, low[column], high[column])
            if slope is None:
                resampled.append(column)
            else:
                slopes[column] = slope
        if resampled or not template._slopes_add_up(low, high):
            resampled += [column for column, slope in slopes.items() if slope.rows.any() or slope.widths.any()]
            slopes = {column: slope for column, slope in slopes.items() if column not in resampled}
        return Template(template.sample, centre, cam, slopes, tuple(sorted(resampled)))

    def _slope(self, column: int, low: float, high: float) -> CamSample | None:
        """Derivative of the cam by one number; None where it is not linear, or too few designs show it."""
        # up to three designs along the column, the others at the centre
        seen: list[tuple[float, CamSample]] = []
        for share in (0.0, 1.0, 0.7, 0.3, 0.55, 0.45):
            numbers = self.centre.copy()
            numbers[column] = low + share * (high - low)
            step = float(numbers[column] - self.centre[column])
            cam = self.sample(numbers) if step else None
            if cam is None:
                continue
            if not cam.comparable(self.centre_cam):
                return None
            seen.append((step, cam))
            if len(seen) == 3:
                break
        if len(seen) < 2:
            return None
        # slopes from the first design; changes within rounding count as none
        step, cam = seen[0]
        change = cam.plus(self.centre_cam, -1.0)
        factor, sizes = 1.0 / step, dict[str, float]()
        for name, value in change.sizes.items():
            slope = factor * value
            sizes[name] = slope if abs(slope * step) > _ROUNDING * abs(self.centre_cam.sizes[name]) else 0.0
        widths, rows = factor * change.widths, factor * change.rows
        if np.abs(widths * step).max() <= _ROUNDING:
            widths = 0.0 * widths
        if np.abs(rows * step).max() <= _ROUNDING * np.abs(self.centre_cam.rows).max():
            rows = 0.0 * rows
        # the number acts linearly if the slopes give all the designs seen
        slopes = CamSample(sizes, widths, rows, cam.counts)
        return slopes if all(cam.equals(self.centre_cam.plus(slopes, step)) for step, cam in seen) else None

    def _slopes_add_up(self, low: Array, high: Array) -> bool:
        """Whether a design in which all numbers differ from the centre is the sum of the slopes."""
        for numbers in _random_numbers(low, high):
            cam = self.sample(numbers)
            if cam is not None and (numbers != self.centre).any():
                linear = self.centre_cam
                for column, slope in self.slopes.items():
                    linear = linear.plus(slope, numbers[column] - self.centre[column])
                return cam.equals(linear)
        return len(self.slopes) < 2

    def sample_designs(self, values: Array) -> list[tuple[Indices, MotionBatch]]:
        """Groups of designs with `values` (m, k), each as the rows of its designs and their cams.

        Designs whose motion cannot be sampled are in no group.
        """
        if not self.resampled:
            return [(np.arange(len(values)), self._shift(self.centre_cam, values, self.centre))]
        distinct, group = np.unique(values[:, self.resampled], axis=0, return_inverse=True)
        groups = []
        for i, shared in enumerate(distinct):
            numbers = self.centre.copy()
            numbers[list(self.resampled)] = shared
            cam = self.sample(numbers)
            rows = np.flatnonzero(group.reshape(-1) == i)
            if cam is None and self.slopes:  # it may exist beside the sizes of a design, if not beside the centre's
                numbers = values[rows[0]]
                cam = self.sample(numbers)
            if cam is not None:
                groups.append((rows, self._shift(cam, values[rows], numbers)))
        return groups

    def _shift(self, cam: CamSample, values: Array, numbers: Array) -> MotionBatch:
        """The cams of m designs with `values` (m, k) from the cam with `numbers` (k,), by the slopes."""
        steps = {column: values[:, column] - numbers[column] for column in self.slopes}
        sizes = {
            name: value + sum((steps[k] * self.slopes[k].sizes[name] for k in steps), np.zeros(len(values)))
            for name, value in cam.sizes.items()
        }
        rows, widths = cam.rows[:, None, :], cam.widths[None]
        for column, slope in self.slopes.items():
            if slope.rows.any():
                rows = rows + steps[column][None, :, None] * slope.rows[:, None, :]
            if slope.widths.any():
                widths = widths + steps[column][:, None] * slope.widths
        # derivatives by the share of a piece, divided by the width of each sample's piece, are those by rad
        samples = np.array(cam.counts) + 1  # of each piece, both its ends among them, which do not lie inside it
        width = widths[:, np.repeat(np.arange(len(samples)), samples)]
        rows = np.stack([rows[0] + 0.0 * width, rows[1] / width, rows[2] / width**2, rows[3] / width**3])
        inside = np.ones(samples.sum(), dtype=np.bool_)
        last = np.cumsum(samples) - 1
        inside[last] = inside[last + 1 - samples] = False
        return MotionBatch({name: column[:, None] for name, column in sizes.items()}, rows, inside[1:-1])


def _random_numbers(low: Array, high: Array) -> list[Array]:
    """Numbers (k,) between their ends, the same at each call."""
    rng = np.random.default_rng(3)
    return [low + share * (high - low) for share in rng.random((_RANDOM_TRIALS, len(low)))]
