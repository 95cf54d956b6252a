"""Measured points against an exact contour: signed deviations along its normals, placed as a datum lets them be.

The foot of a point q on the contour P(t) is where q - P has no part along the tangent (`Envelope.feet`); its deviation
e = (q - P).N, N out of the metal, is above 0 where there is too much of it.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from kin.contour.arcs import cross
from kin.made.placing import ILL, conditions, interval, least_squares, minimax
from kin.made.smooth import strays
from kin.numeric.angles import TURN, degrees
from kin.numeric.errors import CamgeoError, UnsettledError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.follower.base import Follower
    from kin.law.contacts import Side
    from kin.made.placing import Minimax
    from kin.numeric.arrays import Array, Indices, Mask

Datum: TypeAlias = Literal["part", "bore", "none"]
FREE: dict[Datum, str] = {"part": "", "bore": "g", "none": "gxy"}
"""What may be turned (g) and shifted (x, y) about the axes that each datum fixes."""
STEPS = 16  # of placing and taking feet anew
TIED = 1e-9  # share of the greatest deviation within which two are equal but for rounding
STILL = 1e-10  # rad, and share of the size: a step that changes nothing
AT_ONCE = 100_000  # points whose feet are found at a time: memory
COARSE_TURNS = 120  # angles at which a turn is looked for
FEW = 120  # points that do for that
UNLIKE = 0.05  # of the stroke: lifts that are off by more on average are of something else
FAR = 0.01  # of the mean radius: points that lie farther from the contour, on average, are of something else
BETTER = 0.1  # of their distance: what another placing has to bring it down to, to be what they look like
WIDEST = math.radians(150.0)  # without a point, seen from the shaft: more is no turn
MANY = 2000  # points that do to tell what they look like
LIKE = 1.5  # ratio of mean radii within which points may be of this cam
SHIFT = 0.25  # of the mean radius: a shift above is none
MIRRORED = 3.0  # times nearer than any other placing points are to be, to look mirrored
OF_SHAFT = "measure them about the axis of the bearings, or `--align best-fit` with lobes at three heights"
FACTORS = {25.4: "inch", 1.0 / 25.4: "mm", 10.0: "cm", 1000.0: "m"}  # of points read in mm or inches by mistake


class UnlikePointsError(CamgeoError, ValueError):
    """Points that lie far off this contour.

    The message says what they look like, such as another unit or a mirror image.
    """


@dataclass(frozen=True, eq=False)
class Deviations:
    """Deviations of n points on one surface.

    parameter (n,)   of their feet on the contour, rad
    e (n,)           deviations, mm, above 0 where there is too much metal
    normals (n, 2)   of the contour at the feet, out of the metal
    moment (n,)      change of e by a turn of the metal counter-clockwise, mm/rad
    """

    parameter: Array
    e: Array
    normals: Array
    moment: Array

    def columns(self, free: str) -> Array:
        """Derivatives (n, k) of the deviations by turn (g, mm/rad) and shifts (x, y, mm/mm), a column a letter."""
        by_unknown = {"g": self.moment, "x": self.normals[:, 0], "y": self.normals[:, 1]}
        return np.column_stack([by_unknown[name] for name in free]) if free else np.empty((len(self.e), 0))


@dataclass(frozen=True, eq=False)
class Placing:
    """Placement of the metal against the contour as drawn: turn, rad counter-clockwise, and shift, mm."""

    turn: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)

    def back(self, points: Array, directions: Array | None = None) -> tuple[Array, Array | None]:
        """Points (n, 2), mm, and directions (n, 2) or None, as if the metal were neither turned nor shifted."""
        c, s = math.cos(self.turn), math.sin(self.turn)
        rotation = np.array([[c, -s], [s, c]])
        return (points - self.shift) @ rotation, None if directions is None else directions @ rotation

    def on(self, step: Array, free: str) -> Placing:
        """The placing after a `step` (k,) of the unknowns `free`, in the axes of the metal as placed so far.

        `free` has a letter for each: g, turn, rad, x and y, shifts, mm; unknowns that it does not name stay.
        """
        by = dict(zip(free, step.tolist(), strict=True))
        x, y = by.get("x", 0.0), by.get("y", 0.0)
        c, s = math.cos(self.turn), math.sin(self.turn)
        shift = (self.shift[0] + c * x - s * y, self.shift[1] + s * x + c * y)
        return Placing(self.turn + by.get("g", 0.0), shift)


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points measured on a surface, in the axes of the drawing as if not mirrored, mm.

    follower         the follower whose exact contour is that of the surface
    side             1 for metal inside that contour, -1 outside
    places (n, 2)    points, or centres of a probe's ball
    ball             radius of the ball whose centres the places are; 0 for points of the metal
    directions       normals out of the metal as measured (n, 2), None without
    placing          of the metal against the drawing, which is taken out
    """

    follower: Follower
    side: Side
    places: Array
    ball: float = 0.0
    directions: Array | None = None
    placing: Placing = Placing()

    def __len__(self) -> int:
        return len(self.places)

    @cached_property
    def deviations(self) -> Deviations:
        """Deviations of the points less the placing; raises UnsettledError where a foot is not found."""
        parts = [self._deviations(slice(i, i + AT_ONCE)) for i in range(0, len(self), AT_ONCE)]
        rows = zip(*((part.parameter, part.e, part.normals, part.moment) for part in parts), strict=True)
        return Deviations(*(np.concatenate(row) for row in rows))

    def _deviations(self, part: slice) -> Deviations:
        directions = None if self.directions is None else self.directions[part]
        places, directions = self.placing.back(self.places[part], directions)
        if self.ball and directions is not None:
            places = places - self.ball * directions
        feet = self.follower.envelope.feet(places)
        normals = self.side * feet.normal
        touched = places - (self.side * feet.excess)[:, None] * normals
        e = self.side * feet.excess - (0.0 if directions is not None else self.ball)
        return Deviations(feet.parameter, e, normals, cross(touched, normals))

    @cached_property
    def on_metal(self) -> SurfacePoints:
        """The points without strays, a few that lie so far off the others that they are not on the part.

        Strays count in deviations of the part, but say nothing of where it stands. Raises UnsettledError where a foot
        is not found.
        """
        stray = strays(self.deviations.parameter, self.deviations.e, FAR * _size([self]))
        return self.part(~stray) if stray.any() else self

    def placed(self, placing: Placing) -> SurfacePoints:
        """The points with another placing of the metal to take out, instead of the former one."""
        same = placing.turn == self.placing.turn and placing.shift == self.placing.shift
        return self if same else replace(self, placing=placing)

    def part(self, chosen: Indices | Mask) -> SurfacePoints:
        """Those of the points that indices or a mask (n,) choose."""
        directions = None if self.directions is None else self.directions[chosen]
        return replace(self, places=self.places[chosen], directions=directions)

    def thinned(self, most: int) -> SurfacePoints:
        """At most `most` of the points, evenly chosen."""
        return self.part(np.linspace(0, len(self) - 1, min(most, len(self))).astype(np.intp))


@dataclass(frozen=True, eq=False)
class Profile:
    """The profile deviation of points under a datum (ISO 1101, ISO 1660): the value is twice the greatest |e|.

    datum, free      what fixes the axes, and which unknowns it leaves free and the points can tell: of g, x, y
    placing          minimax: of least greatest deviation, strays left out; as the points stand where nothing is free
    deviations       of all points so placed, strays too, surface by surface
    certified        touching points with multipliers; None where nothing is free
    turns            least and greatest turn, rad, with that deviation, where only a turn is free
    least            placing by least squares, and its greatest deviation, mm
    """

    datum: Datum
    free: str
    placing: Placing
    deviations: tuple[Deviations, ...]
    certified: Minimax | None
    turns: tuple[float, float] | None
    least: tuple[Placing, float]

    @property
    def e(self) -> Array:
        """Deviations of all points (n,), mm."""
        return np.concatenate([part.e for part in self.deviations])

    @property
    def greatest(self) -> float:
        """Greatest |e|, mm."""
        return float(np.abs(self.e).max())

    @property
    def worst(self) -> int:
        """Index of the greatest |e|; of several, as a placing makes them, the first with too much metal.

        Those that differ by rounding alone count as equal: else the processor would choose.
        """
        tied = np.flatnonzero(np.abs(self.e) >= (1.0 - TIED) * self.greatest)
        return int(tied[np.argmax(self.e[tied] > 0.0)])


def profile(surfaces: Sequence[SurfacePoints], datum: Datum) -> Profile:
    """Profile deviation of the surfaces of one part, which is placed as a whole.

    Raises UnsettledError where the placing does not converge, or the foot of a point is not found.
    """
    wanted = FREE[datum]
    standing = _stacked(surfaces, surfaces[0].placing)
    free = told_apart(standing, wanted)
    if not free:
        return Profile(datum, free, surfaces[0].placing, standing, None, None, (surfaces[0].placing, _most(standing)))
    on_metal = [surface.on_metal for surface in surfaces]
    least = settled(on_metal, free)
    rough = _stacked(on_metal, least)
    best, placing, turns = least, None, None
    # minimax to first order, then feet anew; of an interval of equal turns the one nearest to least squares
    for _ in range(STEPS):
        columns, e = _columns(rough, free), np.concatenate([deviation.e for deviation in rough])
        placing = minimax(columns, e)
        step = placing.x
        if free == "g":
            turns = interval(columns[:, 0], e, placing.value)
            step = np.array([min(max(float(least_squares(columns, e)[0]), turns[0]), turns[1])])
            turns = (best.turn + turns[0], best.turn + turns[1])
        best = best.on(step, free)
        rough = _stacked(on_metal, best)
        if _still(step, free, on_metal):
            break
    else:
        raise UnsettledError("the placing of the points does not come to rest")
    if any(len(surface) < len(every) for surface, every in zip(on_metal, surfaces, strict=True)):
        rough = _stacked(surfaces, best)
    return Profile(datum, free, best, rough, placing, turns, (least, _most(_stacked(surfaces, least))))


def settled(surfaces: Sequence[SurfacePoints], free: str) -> Placing:
    """Placing by least squares over the unknowns `free`, with feet taken anew until it rests, at most STEPS times."""
    placing = surfaces[0].placing
    for _ in range(STEPS):
        now = _stacked(surfaces, placing)
        step = least_squares(_columns(now, free), np.concatenate([deviation.e for deviation in now]))
        placing = placing.on(step, free)
        if _still(step, free, surfaces):
            break
    return placing


def told_apart(deviations: Sequence[Deviations], wanted: str) -> str:
    """Unknowns out of `wanted` (letters g, x, y) that the points determine.

    The turn g is left out where it cannot be told from the shifts, or moves no deviation.
    """
    if "g" not in wanted:
        return wanted
    columns = _columns(deviations, wanted)
    size = float(np.abs(columns[:, 1:]).max(initial=1.0))
    turning = float(np.sqrt(np.mean(columns[:, 0] ** 2)))
    reach = max(float(np.abs(np.concatenate([deviation.moment for deviation in deviations])).max()), 1e-300)
    scaled = columns / np.array([max(turning, 1e-12), *[1.0] * (len(wanted) - 1)])
    if turning < 1e-6 * size or reach < 1e-6 or conditions(scaled).min() < ILL:
        return wanted.replace("g", "")
    return wanted


def turned_at(surfaces: Sequence[SurfacePoints], free: str = "g") -> Placing:
    """Placing of points whose zero of the angle is arbitrary: a least-squares fit from the best of many turns.

    `free` names the unknowns of the fit: g, x, y. Raises UnsettledError where the foot of a point is not found.
    """
    few = [surface.thinned(FEW) for surface in surfaces]
    turns = np.arange(COARSE_TURNS) * (TURN / COARSE_TURNS)
    turn = min(turns.tolist(), key=lambda angle: _off(few, Placing(angle)))
    turn = math.remainder(turn, TURN)
    return settled([surface.placed(Placing(turn)) for surface in surfaces], free)


def demand_round(surfaces: Sequence[SurfacePoints]) -> None:
    """Raise UnlikePointsError for a surface whose points leave more than 150 degrees round the shaft without any."""
    for surface in surfaces:
        angle = np.sort(np.arctan2(surface.places[:, 1], surface.places[:, 0]))
        gaps = np.diff(angle, append=angle[:1] + TURN)
        widest = int(np.argmax(gaps))
        if gaps[widest] > WIDEST:
            begin, end = degrees(float(angle[widest])), degrees(float(angle[(widest + 1) % len(angle)]))
            sight = f"seen from the shaft, no point lies from {begin:.4g} to {end:.4g} degrees"
            raise UnlikePointsError(f"{sight}: measure all round the cam, from its axis")


def demand_alike(surfaces: Sequence[SurfacePoints], *, aligned: bool, shiftable: bool = True) -> None:
    """Raise UnlikePointsError for points that lie far from the contours, saying what they look like.

    `aligned` is whether they are turned back already, `shiftable` whether `--align best-fit` may shift them.
    """
    far, size = _off(surfaces, surfaces[0].placing), _size(surfaces)
    if far <= FAR * size:
        return
    how_far = f"the points lie {far:.3g} mm off its contour on average"
    e = np.concatenate([surface.deviations.e for surface in surfaces])
    middle = float(np.median(e))
    if FAR * size < abs(middle) < SHIFT * size and float(np.median(np.abs(e - middle))) < BETTER * abs(middle):
        ball = f"{abs(middle):.4g} mm too {'large' if middle > 0.0 else 'small'} all round"
        remedy = "leave `--probe-radius` out, or give its own" if surfaces[0].ball else "`--probe-radius` of the ball?"
        raise UnlikePointsError(f"{how_far}: they look {ball}: {remedy}")
    # other units and mirror images, each placed the best
    few = [surface.thinned(MANY) for surface in surfaces]
    radius = float(np.mean([np.hypot(*surface.places.T).mean() for surface in few]))
    looks: list[tuple[float, str]] = []
    for factor in (1.0, *FACTORS):
        if not 1.0 / LIKE < factor * radius / size < LIKE:
            continue
        for mirrored in (False, True):
            scaled = [_altered(surface, factor, mirrored=mirrored) for surface in few]
            try:
                placing = turned_at(scaled, "g")
                if _off(scaled, placing) > FAR * size:
                    placing = settled([surface.placed(placing) for surface in scaled], "gxy")
            except (UnsettledError, np.linalg.LinAlgError):
                continue
            left = _off(scaled, placing)
            if math.hypot(*placing.shift) <= SHIFT * size and left <= BETTER * min(far, size):
                words = _likeness(placing, factor, size, (mirrored, aligned, shiftable))
                looks.append((left * (MIRRORED if mirrored else 1.0), words))
    if looks:
        raise UnlikePointsError(f"{how_far}: {min(looks)[1]}")
    if float(np.median(np.abs(e))) > FAR * size:  # else most lie on it, and the others are a fault of the part
        raise UnlikePointsError(f"{how_far}, however they are turned or mirrored: they look like those of another cam")


def _likeness(placing: Placing, factor: float, size: float, about: tuple[bool, bool, bool]) -> str:
    """Sentence on what points look like by their placing; `about`: whether mirrored, turned already, free to shift."""
    words, remedies = [], []
    mirrored, aligned, shiftable = about
    if factor != 1.0:
        large = max(factor, 1.0 / factor)
        words.append(f"{large:.6g} times too {'small' if factor > 1.0 else 'large'}")
        remedies.append(f"`--units {FACTORS[factor]}`")
    if mirrored:
        words.append("mirrored")
        remedies.append("measure them with the upper face up, as the file is drawn, or turn y round")
    turn = math.degrees(placing.turn)
    if abs(turn) > 0.05:
        words.append(f"turned by {turn:.3g} degrees")
    x, y = placing.shift
    if math.hypot(x, y) > 1e-3 * size:
        words.append(f"shifted by ({x:.3g}, {y:.3g}) mm")
        remedies.append("`--align best-fit`" if shiftable else OF_SHAFT)
    elif abs(turn) > 0.05 and not aligned:
        remedies.append("`--align rotation`")
    return f"they look {', '.join(words)}: {', then '.join(remedies)}"


def _altered(surface: SurfacePoints, factor: float, *, mirrored: bool) -> SurfacePoints:
    by = np.array([factor, -factor if mirrored else factor])
    directions = None if surface.directions is None else surface.directions * np.sign(by)
    return replace(surface, places=surface.places * by, directions=directions, placing=Placing())


def _off(surfaces: Sequence[SurfacePoints], placing: Placing) -> float:
    """Root mean square of the deviations, mm."""
    e = np.concatenate([deviation.e for deviation in _stacked(surfaces, placing)])
    return float(np.sqrt(np.mean(e * e)))


def _size(surfaces: Sequence[SurfacePoints]) -> float:
    """Mean radius of the exact contours, mm."""
    points = [surface.follower.envelope.points(np.linspace(0.0, TURN, 64)) for surface in surfaces]
    return float(np.mean([np.hypot(contour[:, 0], contour[:, 1]).mean() for contour in points]))


def _stacked(surfaces: Sequence[SurfacePoints], placing: Placing) -> tuple[Deviations, ...]:
    return tuple(surface.placed(placing).deviations for surface in surfaces)


def _columns(deviations: Sequence[Deviations], free: str) -> Array:
    return np.concatenate([deviation.columns(free) for deviation in deviations])


def _most(deviations: Sequence[Deviations]) -> float:
    return max(float(np.abs(deviation.e).max()) for deviation in deviations)


def _still(step: Array, free: str, surfaces: Sequence[SurfacePoints]) -> bool:
    size = float(np.abs(surfaces[0].places).max())
    return all(
        abs(value) <= STILL * (1.0 if name == "g" else size) for name, value in zip(free, step.tolist(), strict=True)
    )
