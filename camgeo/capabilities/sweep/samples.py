"""A cam's motion and sizes as plain numbers, and how they follow the numbers of its recipe.

A motion is sampled over the pieces between its breaks, each on an even grid of its own with both ends, and its
derivatives are taken by the share of the piece. So strokes, harmonics and the shaft's place change them linearly and
angles the widths of pieces alone, whatever the family: the numbers of a sweep are tried one by one, and those that turn
out to act linearly are set by two products. The motion is worked out anew where the others change.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.cams.family import Cam, ExactCam
    from kin.numeric.arrays import Array, Indices, Mask

ORDER = 3  # derivatives of the motion: figures need as many
_LEAST = 12  # cells of a piece, however narrow
_SAME = 1e-9  # of the greatest: a number that acts linearly is off by less
_TRIALS = (0.5, 0.0, 1.0, 0.25, 0.75)  # shares of all ranges at which a design is looked for
_MORE = 24  # and so many elsewhere


class Shot(NamedTuple):
    """One cam: its sizes by name (mm, rad); widths of pieces (p,), rad; the motion by shares of pieces (4, n).

    `counts` (p,) are the cells of the pieces. A plate's motion is its support function, any other's the displacement.
    """

    sizes: dict[str, float]
    widths: Array
    rows: Array
    counts: tuple[int, ...]

    @property
    def shape(self) -> tuple[object, ...]:
        """What shots must share to be compared."""
        return tuple(self.sizes), self.counts


Shoot: TypeAlias = Callable[["Array"], "Shot | None"]


class Sampled(NamedTuple):
    """Cams of m designs: sizes by name (m, 1); the motion with its derivatives (4, g, n), where g is m or 1.

    `inside` (n - 2,) says which of the samples but the first and the last lie within a piece.
    """

    sizes: dict[str, Array]
    rows: Array
    inside: Mask


def sizes_of(cam: Cam, exact: ExactCam) -> dict[str, float]:
    """Radius of the base circle, and the numbers of the first contact's guide and touch."""
    first = exact.follower.contacts[0]
    numbers = {**vars(first.guide), **vars(first.touch)}
    sizes = {name: float(value) for name, value in numbers.items() if isinstance(value, int | float)}
    base = next((circle.radius for circle in cam.circles() if circle.radius is not None), math.nan)
    return {"base": base, "radius": 0.0, **sizes}


def shot_of(cam: Cam, count: int, counts: tuple[int, ...] = ()) -> Shot:
    """Sample a cam at about so many angles of a turn, or by as many cells as `counts` say where it has as many pieces.

    Raises IntentError for a cam that does not exist.
    """
    exact = cam.exact()
    repeats = min(surface.base.shape.repeats for surface in exact.surfaces)
    period = TURN / repeats
    breaks = exact.breaks[exact.breaks < period * (1.0 - 1e-12)]
    begins = breaks if len(breaks) else np.zeros(1)
    widths = np.diff(np.append(begins, begins[0] + period))
    if len(counts) != len(widths):
        counts = tuple(max(_LEAST, math.ceil(count * width / TURN)) for width in widths)
    share = np.concatenate([np.arange(n + 1) / n for n in counts])
    piece = np.repeat(np.arange(len(counts)), np.array(counts) + 1)
    theta = begins[piece] + share * widths[piece]
    law = exact.motion.rows if exact.plate is None else exact.plate.derivatives
    ends = share == 1.0
    rows = np.empty((ORDER + 1, len(theta)))
    rows[:, ~ends], rows[:, ends] = law(theta[~ends], ORDER, 1), law(theta[ends], ORDER, -1)
    return Shot(sizes_of(cam, exact), widths, rows * widths[piece] ** np.arange(ORDER + 1)[:, None], counts)


def _plus(shot: Shot, other: Shot, factor: float) -> Shot:
    """One shot, and a factor times another."""
    sizes = {name: value + factor * other.sizes[name] for name, value in shot.sizes.items()}
    return Shot(sizes, shot.widths + factor * other.widths, shot.rows + factor * other.rows, shot.counts)


def _times(shot: Shot, factor: float) -> Shot:
    sizes = {name: factor * value for name, value in shot.sizes.items()}
    return Shot(sizes, factor * shot.widths, factor * shot.rows, shot.counts)


def _alike(one: Shot, other: Shot) -> bool:
    """Whether two shots are the same but for rounding."""
    if one.shape != other.shape:
        return False
    pairs = [(np.array(list(one.sizes.values())), np.array(list(other.sizes.values()))), (one.widths, other.widths)]
    pairs += list(zip(one.rows, other.rows, strict=True))
    return all(
        np.allclose(a, b, rtol=0.0, atol=_SAME * max(np.nanmax(np.abs(a)), 1e-300), equal_nan=True) for a, b in pairs
    )


@dataclass(frozen=True, eq=False)
class Template:
    """How a cam follows the numbers (k,) of a recipe: a centre, and the slope of all by each number that acts linearly.

    `anew` are the columns of the numbers for which the motion is worked out anew. `shoot` samples the cam with given
    numbers, None where there is none.
    """

    shoot: Shoot
    centre: Array
    shot: Shot
    slopes: dict[int, Shot]
    anew: tuple[int, ...]

    @staticmethod
    def of(anyhow: Callable[[Array, tuple[int, ...]], Shot | None], low: Array, high: Array) -> Template | None:
        """Try the numbers between their ends (k,); None where no design turns up.

        `anyhow` samples the cam with given numbers by given counts of cells, if any.
        """
        found = _centre(lambda values: anyhow(values, ()), low, high)
        if found is None:
            return None
        centre, shot = found

        def shoot(values: Array) -> Shot | None:
            return anyhow(values, shot.counts)

        slopes, anew = dict[int, Shot](), list[int]()
        for column in range(len(centre)):
            slope = _slope(shoot, centre, shot, column, (low[column], high[column]))
            if slope is None:
                anew.append(column)
            else:
                slopes[column] = slope
        template = Template(shoot, centre, shot, slopes, tuple(anew))
        if anew or not template._adds_up(low, high):
            moving = [column for column, slope in slopes.items() if slope.rows.any() or slope.widths.any()]
            template = template._without(moving)
        return template

    def _without(self, columns: Sequence[int]) -> Template:
        left = {column: slope for column, slope in self.slopes.items() if column not in columns}
        return Template(self.shoot, self.centre, self.shot, left, tuple(sorted({*self.anew, *columns})))

    def _adds_up(self, low: Array, high: Array) -> bool:
        """Whether designs in which all numbers differ from the centre are as the slopes have them."""
        for values in _places(low, high):
            shot = self.shoot(values)
            if shot is not None and (values != self.centre).any():
                guess = self.shot
                for column, slope in self.slopes.items():
                    guess = _plus(guess, slope, values[column] - self.centre[column])
                return _alike(shot, guess)
        return len(self.slopes) < 2

    def sampled(self, values: Array) -> list[tuple[Indices, Sampled]]:
        """Groups of the designs (m, k) by their rows, with their cams; without those that do not exist."""
        if not self.anew:
            return [(np.arange(len(values)), self._moved(self.shot, values))]
        distinct, which = np.unique(values[:, self.anew], axis=0, return_inverse=True)
        groups = []
        for i, own in enumerate(distinct):
            numbers = self.centre.copy()
            numbers[list(self.anew)] = own
            shot = self.shoot(numbers)
            rows = np.flatnonzero(which.reshape(-1) == i)
            if shot is None and self.slopes:  # beside the centre's sizes, not beside its own
                numbers = values[rows[0]]
                shot = self.shoot(numbers)
            if shot is not None:
                groups.append((rows, self._moved(shot, values[rows], numbers)))
        return groups

    def _moved(self, shot: Shot, values: Array, centre: Array | None = None) -> Sampled:
        """The cams of designs from one of them by the slopes."""
        by = {column: values[:, column] - (self.centre if centre is None else centre)[column] for column in self.slopes}
        sizes = {
            name: value + sum((by[k] * self.slopes[k].sizes[name] for k in by), np.zeros(len(values)))
            for name, value in shot.sizes.items()
        }
        rows, widths = shot.rows[:, None, :], shot.widths[None]
        for column, slope in self.slopes.items():
            if slope.rows.any():
                rows = rows + by[column][None, :, None] * slope.rows[:, None, :]
            if slope.widths.any():
                widths = widths + by[column][:, None] * slope.widths
        counts = np.array(shot.counts) + 1
        piece = np.repeat(np.arange(len(counts)), counts)
        width = widths[:, piece]
        rows = np.stack([rows[0] + 0.0 * width, rows[1] / width, rows[2] / width**2, rows[3] / width**3])
        inside = np.ones(counts.sum(), dtype=np.bool_)
        last = np.cumsum(counts) - 1
        inside[last] = inside[last + 1 - counts] = False
        return Sampled({name: column[:, None] for name, column in sizes.items()}, rows, inside[1:-1])


def _places(low: Array, high: Array) -> list[Array]:
    rng = np.random.default_rng(3)
    return [low + share * (high - low) for share in rng.random((_MORE, len(low)))]


def _centre(shoot: Shoot, low: Array, high: Array) -> tuple[Array, Shot] | None:
    """A design that exists, in the middle if possible."""
    for values in (*(low + share * (high - low) for share in _TRIALS), *_places(low, high)):
        shot = shoot(values)
        if shot is not None:
            return values, shot
    return None


def _slope(shoot: Shoot, centre: Array, shot: Shot, column: int, ends: tuple[float, float]) -> Shot | None:
    """How a shot follows one number; None where not linearly, or too few designs show it."""
    low, high = ends
    seen: list[tuple[float, Shot]] = []
    for share in (0.0, 1.0, 0.7, 0.3, 0.55, 0.45):
        values = centre.copy()
        values[column] = low + share * (high - low)
        by = float(values[column] - centre[column])
        moved = shoot(values) if by else None
        if moved is None:
            continue
        if moved.shape != shot.shape:
            return None
        seen.append((by, moved))
        if len(seen) == 3:
            break
    if len(seen) < 2:
        return None
    by, moved = seen[0]
    slope = _times(_plus(moved, shot, -1.0), 1.0 / by)
    sizes = {
        name: value if abs(value * by) > _SAME * abs(shot.sizes[name]) else 0.0 for name, value in slope.sizes.items()
    }
    flat = np.abs(slope.rows * by).max() <= _SAME * np.abs(shot.rows).max()
    still = np.abs(slope.widths * by).max() <= _SAME
    slope = Shot(
        sizes, 0.0 * slope.widths if still else slope.widths, 0.0 * slope.rows if flat else slope.rows, slope.counts
    )
    return slope if all(_alike(other, _plus(shot, slope, step)) for step, other in seen) else None
