"""A roller on a smooth surface, over all shaft angles: proved bounds of what stands out, is missing, and holds.

The surface comes as Bezier patches. A place of it is seen along the roller's axis, which is at (y0, z0) by its guide: X
along it, y across, q = y - y0 and v = side (z0 - z), where the roller has the radius R, growing by g along it. On a
cell of a patch, with parameters (s, t) from 0 to 1, the angle of the worst place is laid bilinearly between those of
the corners. There

    H = v + sqrt(R^2 - q^2)   and   K = hypot(q, v) - R

are smooth functions of (s, t), which bend by no more than balls of their second derivatives over the cell say: between
the corners they are off what is bilinear by at most (|f_ss| + |f_tt|)/8. Over the angle, at one place, let F be that
height by which the roller has to give way along z. No place stands out by less than H, nor is farther within the metal
than K cos d, tan d = g.

How much more it stands out is a matter of the slope by the angle, which is bounded likewise: with d = sqrt(R^2 - q^2),

    F_theta = side z0' + (R g y + q (X + y0'))/d
    -F_theta theta = (R (X + y0') + g y q)^2/d^3 + (R g X - q (y + y0''))/d - side z0'',

so that where F falls as c theta^2/2 at least, its greatest value is no more than F_theta^2/(2 c) above H. F has one
peak, as the exact flank is regular: z is but a constant in F, whose peaks are the angles at which the flank is touched
at the polar angle and radius of the place, and that there is one alone is proved first. The same serves
P = (q^2 + v^2 - R^2)/2, which is least near by, with P_theta = -d F_theta + F side z0' and
P_theta theta = (X + y0')^2 - q (y + y0'') + z0'^2 + v side z0'' - g^2 y^2 + R g X.

A roller that is led along a path, not along z, gives way on it by G, where F = G m for m = T_z + side q T_y/d of a
place of the roller between both, T along its path. All of the above is true of all rollers that are shifted by some
G as well, and is proved for these.

At every shaft angle some place of a line t = const holds the roller, if the line goes round: as high as H at least.

A groove of several turns crosses itself. Its patches lie in one turn each, and lines go as far as a wall stands. All of
it has to leave the rollers of other turns room: a place lies within the way of one if F of both its flanks is above 0,
and no deeper than the bounds of either flank say.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.edges import Peak
from kin.cylindrical.grid import FINE
from kin.cylindrical.roller import BESIDE
from kin.numeric.angles import TURN
from kin.numeric.arrays import runs_of
from kin.numeric.bernstein import halves, restrict
from kin.numeric.elementary import cos, sin, sqrt
from kin.numeric.errors import UnsettledError
from kin.numeric.interval import Ball
from kin.numeric.jet import BallJet
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array, Indices, Mask

WIDE, DEEP = 0.0125, 1 / 12  # rad, and of the depth: cells to begin with
ROUNDS, MOST = 12, 400_000  # of halving cells, and cells at a time
FAR = 3.0  # times the tolerance: what is so far off need not be known more closely
BINS = 2048  # parts of a turn, for each of which the roller is held
WINDOW, ROOM, MOST_WINDOW = 0.004, 1.5, 0.1  # rad, about the worst angle, within which F falls; one with room; greatest
NOTHING = 0.01  # of what bounds have to be close to: cells whose own bounds are below it need not be smaller
AMPLE, SHARPER = 1.25, 0.5  # times the window that is needed; share of the one at hand, below which it is narrowed
NARROWER = 3  # times that the window is a quarter, where F is not known to fall all over it
LOOKS, DEPTHS, PARTINGS = 720, 8, 4  # cells of the proof that a flank is regular, and how often they are halved
JUMP = 1e-9  # of the greatest jump of S'', mm per rad^2, below which one is rounding
SHIFT = 2.0  # times what is seen, and what bounds may be above it: ways that a roller may give, for which all is true
LOST = 0.05  # of the radius, by the radian: where F is steeper no peak is near
NEARER = 2e-4  # of a radius, by which chords of the control points of a cell lie nearer to the axis
LOOSE = 1e-7  # rad, by which two faces may miss one another


@dataclass(frozen=True, eq=False)
class Smooth:
    """Patches of a surface, of which all s run along the turn and all t across it.

    nets   (n, p + 1, q + 1, 3) control points, mm
    lines  (n, 2) where t begins and ends, as shares of the surface's own depth
    about  (n,) polar angles over all turns of the motion, rad, within half a turn of which patches lie; by default
           in the first turn
    """

    nets: Array
    lines: Array
    about: Array | None = None

    @property
    def near(self) -> Array:
        """Polar angles (n,), rad, near those of patches."""
        corners = self.nets[:, 0, 0]
        return np.arctan2(corners[:, 1], corners[:, 0]) if self.about is None else self.about


class SeenSmooth(NamedTuple):
    """What a surface shows to a roller, with proved bounds.

    out      greatest way, mm along its path, by which the roller gives to the metal that it reaches
    holds    (k,) at k equal steps of the period: the roller stands so high over its intended place, mm, to a share of
             the tolerance; nan where nothing holds it
    carried  (k,) where it is to be held
    least    least height at which it is held there, mm, with its angle, rad; its bound is below by `remainder`
    proud    greatest distance, mm, of the surface out of the metal, or into the roller of another turn
    bare     greatest distance, mm, of the surface into the metal
    """

    out: Peak
    holds: Array
    carried: Mask
    least: Peak
    proud: Peak
    bare: Peak


class Crossed(NamedTuple):
    """Gauges of all flanks of a track of several turns, and where the flank that is judged has to carry the roller.

    `carries` says for lines at radii (m,), mm, in which of BINS equal parts of each turn some of them have to hold.
    """

    gauges: tuple[Gauge, ...]
    carries: Callable[[Array], Mask]


class _Cells(NamedTuple):
    """Cells (n,): control points (n, p + 1, q + 1, 3), and where t begins and ends (n, 2).

    Of a corner, (n, 2, 2) each, the first index is that of s: worst angle, H, its slope, K cos d and G; q, y, X and v.
    """

    nets: Array
    lines: Array
    theta: Array
    height: Array
    rate: Array
    distance: Array
    gives: Array
    q: Array
    y: Array
    along: Array
    v: Array

    def take(self, which: Mask | Indices) -> _Cells:
        return _Cells(*(rows[which] for rows in self))


class _Bounds(NamedTuple):
    """Bounds over cells (n,), mm: of H and K cos d beside what is bilinear, of F over H, of the depth under -K; X.

    `skew` (2, n) are the shares of s and t in the first two, `path` bounds of m. `gap` is infinite and m from 0 where
    nothing is known.
    """

    height: Array
    distance: Array
    gap: Array
    under: Array
    along: tuple[Array, Array]
    skew: Array
    path: tuple[Array, Array]

    def given(self, height: Array) -> tuple[Array, Array]:
        """Lower and upper bounds (n,) of G, mm, where F is `height` (n,), mm."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ways = np.stack([height / each for each in self.path])
        known = self.path[0] > 0.0
        return np.where(known, ways.min(axis=0), -np.inf), np.where(known, ways.max(axis=0), np.inf)


def cells_of(gauge: Gauge, surface: Smooth) -> _Cells:
    """Cells of a surface, about WIDE by DEEP."""
    depth = surface.lines[:, 1] - surface.lines[:, 0]
    along = np.maximum(np.ceil(_turned(surface.nets) / WIDE), 1.0).astype(np.intp)
    across = np.maximum(np.ceil(depth / DEEP - 1e-9), 1.0).astype(np.intp)
    nets, own, _ = _parted(surface.nets, along)
    turned, back, shares = _parted(np.swapaxes(nets, 1, 2), across[own])
    own = own[back]
    lines = surface.lines[own, :1] + shares * depth[own, None]
    return _measured(gauge, np.ascontiguousarray(np.swapaxes(turned, 1, 2)), lines, surface.near[own])


def _parted(nets: Array, count: Indices) -> tuple[Array, Indices, Array]:
    """Patches parted along their first parameter, each into a number of parts; their own patch, and shares (k, 2)."""
    own, step = runs_of(count)
    shares = np.stack([step, step + 1], axis=1) / count[own][:, None]
    return restrict(nets[own], shares[:, 0], shares[:, 1]), own, shares


def _alike(surfaces: Sequence[Smooth]) -> list[Smooth]:
    """Surfaces of the same degrees as one each."""
    groups: dict[tuple[int, ...], list[Smooth]] = {}
    for surface in surfaces:
        groups.setdefault(surface.nets.shape[1:], []).append(surface)
    return [
        Smooth(*(np.concatenate([getattr(each, name) for each in own]) for name in ("nets", "lines", "near")))
        for own in groups.values()
    ]


def off_flank(gauge: Gauge, surfaces: Sequence[Smooth], turn: int = 0) -> Array:
    """Distances (n,), mm, of half of the corners of surfaces from a flank in a turn, and no less of the other half."""
    corners = [surface.nets[:, [0, -1]][:, :, [0, -1]].reshape(-1, 3) for surface in surfaces]
    about = np.concatenate([np.repeat(surface.near, 4) for surface in surfaces]) + TURN * turn
    points = np.concatenate(corners)
    height, _, distance, *_ = _standing(gauge, points, gauge.peaked(points, about))
    off = np.where(height < gauge.largest, np.abs(distance), np.inf)
    off = np.where(np.isfinite(off), off, np.inf)
    found = np.split(off, np.cumsum([len(each) for each in corners])[:-1])
    return np.array([np.median(each) for each in found])


def _turned(nets: Array) -> Array:
    """Angle (n,), rad, by which patches go round the axis from s = 0 to 1."""
    corners = nets[:, [0, -1]][:, :, [0, -1]]
    phi = np.arctan2(corners[..., 1], corners[..., 0])
    turned: Array = np.abs(np.remainder(phi[:, 1] - phi[:, 0] + math.pi, TURN) - math.pi).max(axis=1)
    return turned


def _measured(gauge: Gauge, nets: Array, lines: Array, about: Array | None = None) -> _Cells:
    corners = nets[:, [0, -1]][:, :, [0, -1]]
    points = corners.reshape(-1, 3)
    near = None if about is None else np.repeat(about, 4)
    theta = gauge.peaked(points, near)
    rows = _standing(gauge, points, theta)
    # one peak is proved later on; where none was found by climbing, it is sought
    lost = np.flatnonzero(~(np.abs(rows[1]) < LOST * gauge.radius))
    if len(lost):
        theta[lost] = gauge.worst(points[lost], None if near is None else near[lost]).theta
        rows[:, lost] = _standing(gauge, points[lost], theta[lost])
    theta, *rest = (row.reshape(corners.shape[:3]) for row in (theta, *rows))
    theta = theta[:, :1, :1] + np.remainder(theta - theta[:, :1, :1] + math.pi, TURN) - math.pi
    return _Cells(nets, lines, theta, *rest)


def _standing(gauge: Gauge, points: Array, theta: Array) -> Array:
    """H and its slope, K cos d, G, q, y, X and v (8, n) of points (n, 3) at angles (n,), rad."""
    rows = gauge.lifts.at(theta)
    sine, cosine = np.sin(theta), np.cos(theta)
    held = gauge.held(list(points.T), rows[0], sine, cosine)
    axis = gauge.led.axis(*rows)
    x, y = points[:, 0] * cosine + points[:, 1] * sine, points[:, 1] * cosine - points[:, 0] * sine
    growth, size = gauge.spread, gauge.size(0.0) + gauge.spread * x
    q, v = y - axis.y, gauge.side * (axis.z - points[:, 2])
    with np.errstate(invalid="ignore", divide="ignore"):
        depth = np.sqrt(size * size - q * q)
        rate = gauge.side * axis.z1 + (size * growth * y + q * (x + axis.y1)) / depth
    return np.stack([v + depth, rate, held.away, held.gives, q, y, x, v])


def look(
    gauge: Gauge, surfaces: Sequence[Smooth], tolerance: float, angles: int, crossed: Crossed | None = None
) -> SeenSmooth:
    """Look at a surface from a roller; bounds are sharp to a share of the tolerance, mm, unless it is far off.

    A groove of several turns is `crossed`. Raises UnsettledError where the flank is not proved regular, or bounds do
    not come close to what is reached.
    """
    return _Look(gauge, tolerance).seen([cells_of(gauge, surface) for surface in _alike(surfaces)], angles, crossed)


class _Look:
    """A look at cells, which are halved until their bounds are close to what is reached."""

    def __init__(self, gauge: Gauge, tolerance: float) -> None:
        self.gauge, self.tolerance, self.near = gauge, tolerance, FINE * tolerance
        self.most = {"out": -math.inf, "proud": -math.inf, "bare": -math.inf}  # reached
        self.at = dict.fromkeys(self.most, math.nan)
        self.bound = dict(self.most)
        self.lowest, self.edges = math.inf, _Held()
        self.shift = 0.0

    def seen(self, cells: Sequence[_Cells], angles: int, crossed: Crossed | None) -> SeenSmooth:
        """All that the cells show."""
        gauge = self.gauge
        corners = np.concatenate([np.hypot(each.nets[..., 0], each.nets[..., 1]).ravel() for each in cells])
        if len(gauge.lifts.corners):
            raise UnsettledError("where the velocity jumps no smooth surface is the flank")
        gauge.demand_bounded()
        if not all(bool((np.isfinite(each.height) & np.isfinite(each.gives)).all()) for each in cells):
            raise UnsettledError("a part of the surface is nowhere near the flank")
        self.shift = SHIFT * (max(float(np.abs(each.gives).max()) for each in cells) + self.near)
        far = max(float(np.abs(each.distance).max()) for each in cells) > FAR * self.tolerance
        if not far:
            # between control points a surface may lie a little nearer to the axis
            demand_regular(gauge, (1.0 - NEARER) * float(corners.min()), float(corners.max()), self.shift)
        carries = np.ones(BINS * gauge.lifts.turns, dtype=np.bool_)
        if crossed is not None:
            carries = crossed.carries(_radii(cells))
        carried = carries[np.arange(angles) * len(carries) // angles]
        holds = _holds(gauge, cells, angles)
        for each in cells:
            self._settle(each, far=far)
            if crossed is not None:
                self._pass_by(each, crossed.gauges, far=far)
        wanted = np.where(carried, holds, np.nan)
        at = int(np.nanargmin(wanted)) if np.isfinite(wanted).any() else 0
        least, period = float(wanted[at]), gauge.lifts.period
        peaks = [
            Peak(self.most[name], self.at[name] % period, max(self.bound[name] - self.most[name], 0.0))
            for name in ("out", "proud", "bare")
        ]
        bound = self.edges.least(carries)
        held = Peak(least, at * period / angles, max(least - bound, 0.0) if math.isfinite(least) else math.inf)
        return SeenSmooth(peaks[0], holds, carried, held, peaks[1], peaks[2])

    def _settle(self, cells: _Cells, *, far: bool) -> None:
        """Take in cells and their bounds; those that are far above what is reached are halved."""
        for parting in range(ROUNDS + 1):
            # at the places of a cell a roller gives way by little more than at its corners
            shift = np.minimum(SHIFT * (np.abs(cells.gives).max(axis=(1, 2)) + self.near), self.shift)
            bounds = _bounds(self.gauge, cells, shift)
            reached = self._reached(cells)
            top, deep = cells.height.max(axis=(1, 2)) + bounds.height + bounds.gap, cells.distance
            out = np.where(reached, bounds.given(top)[1], -np.inf)
            # what stands out by no more than that is no farther out of the metal
            proud = np.minimum(-deep.min(axis=(1, 2)) + bounds.distance + bounds.under, np.maximum(top, 0.0))
            bare = deep.max(axis=(1, 2)) + bounds.distance
            if far:  # a bound that is not known says no more than what is reached
                out, proud = (
                    np.where(np.isfinite(bound), bound, seen)
                    for bound, seen in (
                        (out, np.where(reached, cells.gives.max(axis=(1, 2)), -np.inf)),
                        (proud, -deep.min(axis=(1, 2))),
                    )
                )
            low = bounds.given(cells.height.min(axis=(1, 2)) - bounds.height)[0]
            self.lowest = min(self.lowest, float(cells.gives.min()))
            open_ = (
                (out > self.most["out"] + self.near)
                | (proud > max(self.most["proud"], 0.0) + self.near)
                | (bare > max(self.most["bare"], 0.0) + self.near)
                | (low < self.lowest - self.near)
            )
            hopeless = bool((open_ & _hopeless(cells, bounds, (self.near, shift))).any())
            last = far or parting == ROUNDS or np.count_nonzero(open_) > MOST or hopeless
            done = np.ones_like(open_) if last else ~open_
            for name, values in (("out", out), ("proud", proud), ("bare", bare)):
                self.bound[name] = max(self.bound[name], float(values[done].max(initial=-math.inf)))
            self._hold(cells, bounds, done)
            if last and open_.any() and not far:
                steep = "this steep flank is not proved by its surface at this tolerance"
                raise UnsettledError(f"{steep}: give a smaller one, or an STL")
            if done.all():
                return
            cells = self._halved(cells.take(open_), bounds.skew[:, open_])

    def _pass_by(self, cells: _Cells, gauges: Sequence[Gauge], *, far: bool) -> None:
        """Take in how far cells stand in the way of the rollers of other turns, of all flanks together.

        A place is within a roller's way if it is above the one flank and below the other one.
        """
        for turn in range(1, self.gauge.lifts.turns):
            nets, lines, about = cells.nets, cells.lines, cells.theta[:, 0, 0] + TURN * turn
            for parting in range(ROUNDS + 1):
                near = _near(gauges, nets, about)
                if not near.any():
                    break
                nets, lines, about = nets[near], lines[near], about[near]
                inside, bound = np.zeros((len(nets), 2, 2)), np.full(len(nets), np.inf)
                for gauge in gauges:
                    seen = _measured(gauge, nets, lines, about)
                    bounds = _bounds(gauge, seen, 0.0)
                    inside = np.fmax(inside, -seen.distance)  # at any angle a place is as deep at least
                    top = seen.height.max(axis=(1, 2)) + bounds.height + bounds.gap
                    under = -seen.distance.min(axis=(1, 2)) + bounds.distance + bounds.under
                    bound = np.fmin(bound, np.fmin(under, np.maximum(top, 0.0)))
                k = int(np.argmax(inside))
                if inside.ravel()[k] > max(self.most["proud"], 0.0):
                    self.most["proud"], self.at["proud"] = float(inside.ravel()[k]), float(seen.theta.ravel()[k])
                open_ = ~(bound <= max(self.most["proud"], 0.0) + self.near)
                far = far or self.most["proud"] > FAR * self.tolerance
                last = far or parting == ROUNDS or np.count_nonzero(open_) > MOST
                if last and open_.any() and not far:
                    raise UnsettledError("bounds of what stands in the way of another turn are not close: give an STL")
                done = np.ones_like(open_) if last else ~open_
                known = np.where(np.isfinite(bound), bound, inside.max(axis=(1, 2)))
                self.bound["proud"] = max(self.bound["proud"], float(known[done].max(initial=-math.inf)))
                if done.all():
                    break
                nets, lines = _quartered(nets[open_], lines[open_])
                about = np.tile(about[open_], 4)

    def _hold(self, cells: _Cells, bounds: _Bounds, done: Mask) -> None:
        """Take in the edges of cells that are done."""
        least = np.stack([bounds.given(cells.height[:, :, k].min(axis=1) - bounds.height)[0] for k in (0, 1)], axis=1)
        inside = np.stack([self._within(cells, k) for k in (0, 1)], axis=1)
        self.edges.add(cells.take(done), np.where(inside, least, -np.inf)[done])

    def _within(self, cells: _Cells, k: int) -> Mask:
        """Whether the edges (n,) of cells at the beginning of t, or at its end, lie within the roller's length."""
        theta, edge = cells.theta[:, :, k], cells.nets[:, :, -k]
        middle, half = theta.mean(axis=1)[:, None], 0.5 * np.abs(np.diff(theta, axis=1))[:, 0]
        c, s = np.cos(middle), np.sin(middle)
        along, across = edge[..., 0] * c + edge[..., 1] * s, np.abs(edge[..., 1] * c - edge[..., 0] * s).max(axis=1)
        low = along.min(axis=1) * np.cos(half) - across * np.sin(half)
        high = along.max(axis=1) + across * np.sin(half)
        within: Mask = (low >= self.gauge.inner) & (high <= self.gauge.outer)
        return within

    def _reached(self, cells: _Cells) -> Mask:
        """Cells (n,) that the roller may reach with its length; what their corners show is taken in."""
        gauge = self.gauge
        corners = cells.nets[:, [0, -1]][:, :, [0, -1]]
        along = corners[..., 0] * np.cos(cells.theta) + corners[..., 1] * np.sin(cells.theta)
        within = (along >= gauge.inner) & (along <= gauge.outer)
        for name, values in (
            ("out", np.where(within, cells.gives, -np.inf)),
            ("proud", -cells.distance),
            ("bare", cells.distance),
        ):
            k = int(np.argmax(values))
            if values.ravel()[k] > self.most[name]:
                self.most[name], self.at[name] = float(values.ravel()[k]), float(cells.theta.ravel()[k])
        # within the roller's length is nothing that is nearer to the axis than its inner end
        r = np.hypot(cells.nets[..., 0], cells.nets[..., 1]).reshape(len(cells.nets), -1).max(axis=1)
        reached: Mask = r >= gauge.inner
        return reached

    def _halved(self, cells: _Cells, skew: Array) -> _Cells:
        along = skew[0] >= skew[1]
        first = _along_halved(cells.nets[along], cells.lines[along])
        second = _across_halved(cells.nets[~along], cells.lines[~along])
        nets, lines = (np.concatenate(pair) for pair in zip(first, second, strict=True))
        about = np.concatenate([np.tile(cells.theta[own, 0, 0], 2) for own in (along, ~along)])
        return _measured(self.gauge, np.ascontiguousarray(nets), lines, about)


def _along_halved(nets: Array, lines: Array) -> tuple[Array, Array]:
    """Cells (2 n,) and their lines: first halves along s, then second ones."""
    return np.concatenate(halves(nets)), np.tile(lines, (2, 1))


def _across_halved(nets: Array, lines: Array) -> tuple[Array, Array]:
    """Cells (2 n,) and their lines: first halves along t, then second ones."""
    parts = [np.swapaxes(part, 1, 2) for part in halves(np.swapaxes(nets, 1, 2))]
    (low, high), middle = lines.T, lines.mean(axis=1)
    ends = np.concatenate([np.stack([low, middle], axis=1), np.stack([middle, high], axis=1)])
    return np.concatenate(parts), ends


def _quartered(nets: Array, lines: Array) -> tuple[Array, Array]:
    """Cells (4 n,), halved along s and t, and their lines."""
    nets, lines = _across_halved(*_along_halved(nets, lines))
    return np.ascontiguousarray(nets), lines


def _near(gauges: Sequence[Gauge], nets: Array, about: Array) -> Mask:
    """Cells (n,) that are not surely below or above the way of a roller at angles (n,), rad, of its turn."""
    points = nets.reshape(-1, 3)
    phi = gauges[0].polar(points, np.repeat(about, len(points) // len(nets))).reshape(len(nets), -1)
    low, high = phi.min(axis=1), phi.max(axis=1)
    z = nets[..., 2].reshape(len(nets), -1)
    beyond = np.zeros(len(nets), dtype=np.bool_)
    for gauge in gauges:
        highest = np.maximum(*(gauge.most(0.5 * (low + high), end) for end in (z.min(axis=1), z.max(axis=1))))
        beyond |= highest <= 0.0
    near: Mask = ~beyond | (high - low > 2.0 * BESIDE)
    return near


def _hopeless(cells: _Cells, bounds: _Bounds, sizes: tuple[float, Array]) -> Mask:
    """Cells (n,) so small that not they, but how far rollers are shifted, leaves F unknown.

    `sizes` are what bounds have to be close to, and how far rollers are shifted (n,), mm.
    """
    near, shift = sizes
    span = (cells.theta.max(axis=(1, 2)) - cells.theta.min(axis=(1, 2))) * bounds.along[1]
    small = (span < shift) & (bounds.height + bounds.distance < NOTHING * near)
    hopeless: Mask = small & ~np.isfinite(bounds.gap)
    return hopeless


# --- bounds over cells ------------------------------------------------------------------------------------------------


class _Places(NamedTuple):
    """Balls over cells (n,) of q, y, X, v and R, mm."""

    q: Ball
    y: Ball
    along: Ball
    v: Ball
    size: Ball

    def take(self, which: Indices) -> _Places:
        return _Places(*(Ball(ball.mid[which], ball.rad[which]) for ball in self))


def _bounds(gauge: Gauge, cells: _Cells, shift: Array | float) -> _Bounds:
    """Bounds over cells, true of rollers that give way by no more than `shift`, mm, one for all cells or (n,)."""
    side, guide, base, growth = float(gauge.side), gauge.led, float(gauge.size(0.0)), gauge.spread
    middle = cells.theta.mean(axis=(1, 2))
    c, s = np.cos(middle)[:, None, None], np.sin(middle)[:, None, None]
    x, y, z = np.moveaxis(cells.nets, 3, 0)
    turned = [x * c + y * s, y * c - x * s, z]
    tau = cells.theta - middle[:, None, None]
    low, high = tau.min(axis=(1, 2)), tau.max(axis=(1, 2))
    seen, bent, apart = [], [], []
    jumps = _jumping(gauge, low + middle, high + middle)
    for axis in (1, 2):
        px, py, pz = (_jet(part, axis) for part in turned)
        ways = np.diff(tau, axis=axis).reshape(len(tau), 2)
        rows = [Ball.between(low, high), Ball.between(ways.min(axis=1), ways.max(axis=1))]
        angle = BallJet(
            np.stack([rows[0].mid, rows[1].mid, 0.0 * low]), np.stack([rows[0].rad, rows[1].rad, 0.0 * low])
        )
        lift = gauge.lifts.round.on(angle + Ball.exact(middle))
        led = guide.jets(lift, _slopes(gauge, angle, middle), lift.constant(0.0))
        cosine, sine = cos(angle), sin(angle)
        across, along = py * cosine - px * sine, px * cosine + py * sine
        seen.append(((across - led.y, across, along, (led.z - pz) * side), led))
    for parts in zip(*(own for own, _ in seen), cells[-4:], strict=True):
        _sharpen(*parts)
    for (q, across, along, v), led in seen:
        size = along * growth + base
        depth = sqrt(size * size - q * q)
        height, reach = v + depth, sqrt(q * q + v * v) - size
        rate = (size * across * growth + q * (along + led.y1)) / depth + led.z1 * side
        bent.append([2.0 * part.rows[2].magnitude for part in (height, reach, rate)])
        # where S'' jumps F_theta is off what is linear by a quarter of the span of its first derivative
        apart.append(np.where(jumps, 0.5 * rate.rows[1].rad, 0.25 * rate.rows[2].magnitude))
    (h1, k1, q1), (h2, k2, q2) = bent
    steep = np.abs(cells.rate).max(axis=(1, 2)) + apart[0] + apart[1]
    places = _Places(*(part.rows[0] for part in (q, across, along, v, size)))
    beside, under, path = _gaps(
        gauge, cells, places, (low + middle, high + middle), (steep, np.broadcast_to(shift, steep.shape))
    )
    upright = 1.0 / math.hypot(1.0, growth)
    return _Bounds(
        0.125 * (h1 + h2),
        0.125 * upright * (k1 + k2),
        beside,
        upright * under,
        along.rows[0].bounds(),
        np.stack([h1 + k1 + gauge.radius * q1, h2 + k2 + gauge.radius * q2]),
        path,
    )


def _sharpen(by_s: BallJet, by_t: BallJet, corners: Array) -> None:
    """Take from what is bilinear between corners (n, 2, 2) a closer enclosure of jets by s and by t."""
    off = 0.25 * (by_s.rows[2].magnitude + by_t.rows[2].magnitude)
    for jet in (by_s, by_t):
        low, high = jet.rows[0].bounds()
        low = np.maximum(low, corners.min(axis=(1, 2)) - off)
        value = Ball.between(low, np.maximum(np.minimum(high, corners.max(axis=(1, 2)) + off), low))
        jet.mid[0], jet.rad[0] = value.mid, value.rad


def _jumping(gauge: Gauge, low: Array, high: Array) -> Mask:
    """Whether the second derivative of the lift jumps between angles (n,), rad."""
    law = gauge.lifts.round
    found = np.zeros(len(low), dtype=np.bool_)
    if not len(law.breaks):
        return found
    at, jumps = law.jumps(2)
    for angle in at[np.abs(jumps[2]) > JUMP * max(1.0, float(np.abs(jumps[2]).max()))].tolist():
        found |= np.remainder(angle - low + LOOSE, gauge.lifts.period) <= high - low + 2.0 * LOOSE
    return found


def _jet(values: Array, axis: int) -> BallJet:
    """Coordinate of patches (n, p + 1, q + 1) as jets to the second order along an axis."""
    degree = values.shape[axis] - 1
    first = degree * np.diff(values, axis=axis)
    second = 0.5 * (degree - 1) * np.diff(first, axis=axis) if degree > 1 else np.zeros((len(values), 1, 1))
    balls = [
        Ball.between(part.reshape(len(part), -1).min(axis=1), part.reshape(len(part), -1).max(axis=1))
        for part in (values, first, second)
    ]
    return BallJet(np.stack([ball.mid for ball in balls]), np.stack([ball.rad for ball in balls]))


def _slopes(gauge: Gauge, angle: BallJet, middle: Array) -> BallJet:
    """Slope of the lift along jets of the angle about a middle, rad."""
    low, high = (angle.rows[0] + Ball.exact(middle)).bounds()
    mid, rad = gauge.lifts.round.enclosure(low, high, 3)
    rows = Ball(mid, rad)
    first, second = angle.rows[1], angle.rows[2]
    bent = rows[2] * second + rows[3] * first * first * 0.5
    parts = [rows[1], rows[2] * first, bent]
    return BallJet(np.stack([part.mid for part in parts]), np.stack([part.rad for part in parts]))


def _gaps(
    gauge: Gauge, cells: _Cells, places: _Places, angles: tuple[Array, Array], steepness: tuple[Array, Array]
) -> tuple[Array, Array, tuple[Array, Array]]:
    """How far F rises above H (n,), and the depth above -K (n,), mm, infinite where F is not known to fall; and m.

    `places` are those over cells whose worst angles lie between `angles`; `steepness` are bounds of |F_theta|, mm per
    rad, and how far rollers are shifted, mm (n,).
    """
    steep, shift = steepness
    growth, smallest = gauge.spread, np.maximum(places.size.bounds()[0], 0.0)
    seen = np.abs(cells.height).max(axis=(1, 2))
    top = np.maximum(cells.height.max(axis=(1, 2)), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        near = np.full_like(top, WINDOW)
        found = _falls(gauge, places, angles, near, shift)
        peaked = found.peaks(steep, shift, near)
        # where the roller is all but beside a place F is known close to its peak alone
        for _ in range(NARROWER):
            lost = np.flatnonzero(~peaked)
            if not len(lost):
                break
            near[lost] *= 0.25
            own = (angles[0][lost], angles[1][lost])
            found = found.replaced(lost, _falls(gauge, places.take(lost), own, near[lost], shift[lost]))
            peaked = found.peaks(steep, shift, near)
        # the nearer the peak, the less all that follows is blurred by what F may be elsewhere
        needed = np.where(peaked, AMPLE * (steep + shift * found.turns) / found.fall, near)
        sharper = np.flatnonzero(needed < SHARPER * near)
        if len(sharper):
            near[sharper] = needed[sharper]
            own = (angles[0][sharper], angles[1][sharper])
            found = found.replaced(sharper, _falls(gauge, places.take(sharper), own, near[sharper], shift[sharper]))
            peaked[sharper] = found.peaks(steep, shift, near)[sharper]
        fall, (least, most) = found.fall, found.path
        beside = np.where(peaked, steep**2 / (2.0 * fall), np.inf)
        # where F is above 0 the roller may stand nearer: within a window at whose ends F is below 0
        top = np.where(np.isfinite(beside), top + beside, 0.0)
        window = np.where(fall > 0.0, 2.0 * near + ROOM * np.sqrt(2.0 * top / np.maximum(fall, 1e-6)), near)
        window = np.minimum(window, MOST_WINDOW)
        found = _falls(gauge, places, angles, window, np.zeros_like(window))
        fall, nearing = found.fall, found.nearing
        within = np.isfinite(beside) & (fall > 0.0) & (top < 0.5 * fall * (window - near) ** 2) & (nearing > 0.0)
        rate = places.size.magnitude * steep + seen * found.slope
        # P is less by no more than rate^2/(2 nearing), and with it R^2/2 by what R grows; both are above 9/10 of R
        gap = rate**2 / (2.0 * nearing) + top * growth * places.y.magnitude * window
        under = np.where(within & (top < 0.05 * smallest), gap / (0.9 * smallest), np.inf)
        known = np.isfinite(beside) & (least > 0.0) & (seen < shift * least)
    return beside, under, (np.where(known, least, 0.0), np.where(known, most, np.inf))


class _Falls(NamedTuple):
    """Lower bounds (n,) of -F'' and of P''; upper ones of |z0'| and of the slope of m; lower and upper of m."""

    fall: Array
    nearing: Array
    slope: Array
    turns: Array
    path: tuple[Array, Array]

    def peaks(self, steep: Array, shift: Array, window: Array) -> Mask:
        """Whether F of all rollers has its peak within the window (n,), rad, about where its slope is `steep` (n,)."""
        peaked: Mask = (self.fall > 0.0) & (steep + shift * self.turns <= self.fall * window)
        return peaked

    def replaced(self, which: Indices, other: _Falls) -> _Falls:
        """Bounds with those of some cells taken from others."""

        def put(own: Array, values: Array) -> Array:
            row = own.copy()
            row[which] = values
            return row

        return _Falls(
            put(self.fall, other.fall),
            put(self.nearing, other.nearing),
            put(self.slope, other.slope),
            put(self.turns, other.turns),
            (put(self.path[0], other.path[0]), put(self.path[1], other.path[1])),
        )


def _falls(gauge: Gauge, places: _Places, angles: tuple[Array, Array], window: Array, shift: Array) -> _Falls:
    """Bounds over angles wider by a window (n,), rad, and for rollers that are shifted by up to `shift` (n,), mm.

    `places` are those over cells whose worst angles lie between `angles`.
    """
    side, guide, growth = float(gauge.side), gauge.led, gauge.spread
    mid, rad = gauge.lifts.round.enclosure(angles[0] - window, angles[1] + window, 2)
    lift = Ball(mid[0], rad[0] + shift / guide.lever)
    led = guide.jets(lift, Ball(mid[1], rad[1]), Ball(mid[2], rad[2]))
    farther = np.hypot(places.y.magnitude, places.along.magnitude) * window
    y = Ball(places.y.mid, places.y.rad + farther)
    along = Ball(places.along.mid, places.along.rad + y.magnitude * window)
    q = Ball(places.q.mid, places.q.rad + farther + led.y1.magnitude * window + shift)
    size = Ball(places.size.mid, places.size.rad + growth * y.magnitude * window)
    v = Ball(places.v.mid, places.v.rad + led.z1.magnitude * window + shift)
    depth = (size * size - q * q) ** 0.5
    over, moved = depth**-1, along + led.y1
    sheer = size * moved + y * q * growth
    rest = size * along * growth - q * (y + led.y2)
    fall = sheer * sheer * over * over * over + rest * over - led.z2 * side
    nearing = moved * moved - q * (y + led.y2) + led.z1 * led.z1 + v * led.z2 * side
    nearing = nearing + size * along * growth - y * y * growth**2
    _, *ways = guide.enclosed(*lift.bounds())
    across, up = (Ball.between(*way) for way in ways)
    path = up + q * over * across * side
    turn = np.hypot(led.y1.magnitude, led.z1.magnitude) * guide.bend
    turns = turn * (1.0 + (q * over).magnitude) + across.magnitude * (size * sheer * over * over * over).magnitude
    return _Falls(fall.bounds()[0], nearing.bounds()[0], led.z1.magnitude, turns, path.bounds())


def demand_regular(gauge: Gauge, low: float, high: float, shift: float = 0.0) -> None:
    """Raise UnsettledError unless on every cylinder from `low` to `high`, mm, each polar angle is touched once alone.

    It is of all rollers that are shifted by up to `shift`, mm. Where F is level it falls to both sides: with
    q = -side R sin a and d = R cos a of the contact at a place X along the roller, its -F'' times d^3/R^2 is above 0. F
    is there over one stretch of the shaft angle, as q/R falls with it.
    """
    side, guide, base, growth = float(gauge.side), gauge.led, float(gauge.size(0.0)), gauge.spread
    near = math.sqrt(max(low**2 - (gauge.reach + shift) ** 2, 0.0))
    edges, looks = np.linspace(near, high, DEPTHS + 1), LOOKS * gauge.lifts.turns
    turn = np.linspace(0.0, gauge.lifts.period, looks + 1)
    a, b = np.tile(turn[:-1], DEPTHS), np.tile(turn[1:], DEPTHS)
    c, d = np.repeat(edges[:-1], looks), np.repeat(edges[1:], looks)
    for _ in range(PARTINGS + 1):
        mid, rad = gauge.lifts.round.enclosure(a, b, 2)
        led = guide.jets(Ball(mid[0], rad[0] + shift / guide.lever), Ball(mid[1], rad[1]), Ball(mid[2], rad[2]))
        x = Ball.between(c, d)
        size = x * growth + base
        # A sin a - z0' cos a = side y0 g, of whose two angles one alone has cos a above 0
        moved = x + led.y1
        reach = moved + size * growth
        inverse = (reach * reach + led.z1 * led.z1) ** -0.5
        lag = led.y * inverse * (side * growth)
        beside = (1.0 - lag * lag) ** 0.5
        up, out = led.z1 * inverse, reach * inverse
        sine, cosine, other = up * beside + out * lag, out * beside - up * lag, out * beside + up * lag
        y = led.y - size * sine * side
        square = cosine * cosine
        sheer = moved - y * sine * (side * growth)
        rest = size * square * (x * growth + sine * (y + led.y2) * side)
        level = sheer * sheer + rest - size * square * cosine * led.z2 * side
        one = near + led.y1.bounds()[0] > growth * (gauge.reach + shift)
        sound = one & (level.bounds()[0] > 0.0) & (cosine.bounds()[0] > 0.0) & (other.bounds()[0] > 0.0)
        open_ = ~sound & ~((x * x + y * y).bounds()[1] < low**2)
        if not open_.any():
            return
        a, b, c, d = a[open_], b[open_], c[open_], d[open_]
        m, n = 0.5 * (a + b), 0.5 * (c + d)
        a, b = np.concatenate([a, m, a, m]), np.concatenate([m, b, m, b])
        c, d = np.concatenate([c, c, n, n]), np.concatenate([n, n, d, d])
    raise UnsettledError("the exact flank is not proved regular: it may be undercut")


# --- what holds the roller --------------------------------------------------------------------------------------------


class _Held:
    """How high lines t = const hold the roller over the turn, from the edges of cells."""

    def __init__(self) -> None:
        self.parts: list[tuple[Indices, Array, Array, Array]] = []

    def add(self, cells: _Cells, least: Array) -> None:
        """Take in both edges along s of cells (n,), where they hold the roller at `least` (n, 2), mm."""
        for k in (0, 1):
            line = 2 * np.round(cells.lines[:, k] * 2**40).astype(np.int64) + k
            self.parts.append((line, cells.theta[:, 0, k], cells.theta[:, 1, k], least[:, k]))

    def least(self, carries: Mask) -> float:
        """Height, mm, at which some line holds the roller at least in parts of the period (BINS a turn) that carry.

        It is -inf where no line goes through one.
        """
        line, first, last, least = (np.concatenate(part) for part in zip(*self.parts, strict=True))
        numbers, row = np.unique(line, return_inverse=True)
        width, count_all = TURN / BINS, len(carries)
        low, high = np.minimum(first, last), np.maximum(first, last)
        sense = np.where(last >= first, 1.0, -1.0)
        begin = np.floor(low / width).astype(np.intp)
        count = np.floor(high / width).astype(np.intp) - begin + 1
        own, step = runs_of(count)
        bins = begin[own] + step
        over = np.minimum(high[own], (bins + 1) * width) - np.maximum(low[own], bins * width)
        places = row[own] * count_all + bins % count_all
        held, covered = np.full(len(numbers) * count_all, np.inf), np.zeros(len(numbers) * count_all)
        np.minimum.at(held, places, least[own])
        np.add.at(covered, places, sense[own] * over)
        whole = np.abs(covered) >= width - LOOSE
        best = np.where(whole, held, -np.inf).reshape(-1, count_all).max(axis=0)
        return float(best[carries].min()) if carries.any() else -math.inf


def _holds(gauge: Gauge, cells: Sequence[_Cells], angles: int) -> Array:
    """Height (angles,), mm, at which the surface holds the roller at equal steps, laid straight between corners."""
    width = gauge.lifts.period / angles
    best = np.full(angles, np.nan)
    for each in cells:
        corners = each.nets[:, [0, -1]][:, :, [0, -1]]
        reach = corners[..., 0] * np.cos(each.theta) + corners[..., 1] * np.sin(each.theta)
        inside: Mask = np.logical_and.reduce((reach >= gauge.inner) & (reach <= gauge.outer), axis=1)
        low, high = each.theta.min(axis=1), each.theta.max(axis=1)
        for k in (0, 1):
            begin = np.ceil((low[:, k] - LOOSE) / width).astype(np.intp)
            count = np.floor((high[:, k] + LOOSE) / width).astype(np.intp) - begin + 1
            own, step = runs_of(np.where(inside[:, k], np.maximum(count, 0), 0))
            number = begin[own] + step
            (first, last), (start, end) = (part[own, :, k].T for part in (each.theta, each.gives))
            way = last - first
            share = np.where(way == 0.0, 0.0, (number * width - first) / np.where(way == 0.0, 1.0, way))
            values = start + np.clip(share, 0.0, 1.0) * (end - start)
            order = np.argsort(np.where(np.isfinite(values), values, -np.inf))  # of several the highest stays
            best[number[order] % angles] = np.fmax(best[number[order] % angles], values[order])
    return best


def _radii(cells: Sequence[_Cells]) -> Array:
    """Radii (m,), mm, of the lines t = const of cells."""
    lines = np.concatenate([each.lines.ravel() for each in cells])
    ends = np.concatenate([each.nets[:, 0, [0, -1], :2].reshape(-1, 2) for each in cells])
    _, row = np.unique(np.round(lines * 2**40), return_inverse=True)
    radii: Array = np.bincount(row, np.hypot(ends[:, 0], ends[:, 1])) / np.bincount(row)
    return radii
