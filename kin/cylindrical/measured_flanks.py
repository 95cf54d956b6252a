"""Points measured on the flanks of a made drum: how far they are off, where the part lies, what it does to the motion.

The distance of a point from the exact flank is by the roller that comes nearest to it (`kin.cylindrical.roller`), above
0 where there is too much metal. A point that is off by e moves the roller that touches there by e/(n.T), n being the
normal out of the metal and T the roller's way. Along the turn, at one radius, errors are smoothed by waves, by least
squares; what is left is noise, and points that stand far out of it are named and left out of the motion.

Centres of a probe's ball lie on the flank of a roller that is smaller by the ball, on the same path: surfaces by
rollers of one axis are parallel. They are held against that one, exactly, and the metal is the ball's radius along the
normal from them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.inspected import ANY
from kin.numeric.angles import TURN
from kin.numeric.errors import CamgeoError
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array, Indices, Mask

PROFILE, MOTION = "made-profile", "made-motion"  # names of the checks of points, as those of a disc
UNKNOWNS = "gzxyab"  # a turn about z, shifts along z, x and y, tilts about x and y
ROUNDS = 6  # of Gauss and Newton
SETTLED = 1e-9  # mm
ALIKE = 0.1  # of the roller's radius, within which nine of ten points of a drum lie
EVEN = 0.1  # of the distance at which points lie off, about which half of those of a ball's centres scatter
MOST = 0.9  # of the points: so many have to lie so near
BEYOND = 0.05  # of the depth of the flank, by which points may lie beyond it
LOOKED = 400  # points of a wrong drum that are looked at
TRIED = 360  # turns of a wrong drum that are tried
RING = 0.25  # mm, within which points are of one radius
LEAST_RING, WIDEST = 36, math.radians(20.0)  # points round a radius, and the widest gap between them
WAVES, PER_WAVE = 36, 6.0  # most waves a turn, and points that each takes at least
STANDS_OUT = 4.5  # standard deviations
LEAST_OUT = 5e-4  # mm: less stands out of nothing
NORMAL = 1.4826  # standard deviations in a median absolute deviation
COVERAGE = 2.0  # standard deviations: about 95 % (GUM)
STEPS = 720  # of the turn, at which the motion is told


class UnlikeError(CamgeoError, ValueError):
    """Points that are not of the drum, in words, with what they look like."""


@dataclass(frozen=True, eq=False)
class Measured:
    """Points of one flank: how far they are off and where.

    number  of the flank among the drum's gauges
    rows    (n,) numbers of the points in their file
    places  (n, 3) of the metal as placed, mm, where a ball touched it
    e       (n,) distance from the exact flank along its normal, mm, above 0 out of the metal
    theta   (n,) shaft angle, rad, at which the roller touches there
    normal  (n, 3) out of the metal
    way     (n,) n.T: the roller moves by e over it
    """

    gauge: Gauge
    number: int
    rows: Indices
    places: Array
    e: Array
    theta: Array
    normal: Array
    way: Array

    @property
    def r(self) -> Array:
        """Distances (n,) from the axis, mm."""
        return np.hypot(self.places[:, 0], self.places[:, 1])


class Placing(NamedTuple):
    """How the part lies, by the unknowns that were asked for, mm and rad: a turn about z and so on; and uncertainties.

    `values` and `uncertain` (6,), k = 2 by what is left, are 0 where nothing was asked.
    """

    values: Array
    uncertain: Array


@dataclass(frozen=True, eq=False)
class Ring:
    """Error of the motion by the points round one radius of a flank, at equal steps of the turn from 0.

    error      (s,) of the position, mm or rad, by the smoothed errors; above 0 along the lift
    uncertain  (s,) k = 2, by what is left
    most_moved greatest |error| by 1 mm along the normal
    sd         standard deviation of what is left, mm along the normal
    outliers   (k,) numbers of points in the file that stand out of it and were left out
    """

    flank: int
    radius: float
    count: int
    waves: int
    error: Array
    uncertain: Array
    most_moved: float
    sd: float
    outliers: Indices


@dataclass(frozen=True, eq=False)
class MadeDrum:
    """A measured drum: points by flank, the placing, and rings of points that suffice for the motion."""

    flanks: tuple[Measured, ...]
    placing: Placing
    rings: tuple[Ring, ...]


def made_drum(drum: DrumIntent, places: Array, flank: Indices, unknowns: str = "", ball: float = 0.0) -> MadeDrum:
    """Judge points (n, 3), mm, as their file has them, whose flanks (n,) are 0 lower, 1 upper, or ANY.

    `unknowns` are letters of UNKNOWNS that least squares may take out. Points are centres of a `ball` of a radius, mm,
    or of the metal (0). Raises UnlikeError for points of another drum, and for a ball that is no smaller than the
    roller, UnsettledError where nothing of the drum is bounded.
    """
    gauges = _probed(drum, ball)
    for gauge in gauges:
        gauge.demand_bounded()
    own = places * [1.0, -1.0, 1.0] if drum.mirrored else places
    _demand_alike(drum, gauges, own, flank, ball)
    values, free = np.zeros(6), [UNKNOWNS.index(letter) for letter in unknowns]
    uncertain = np.zeros(6)
    for _ in range(ROUNDS if free else 0):
        flanks = _sorted(gauges, drum, _moved(own, values), flank, ball)
        columns = np.concatenate([_columns(each) for each in flanks])[:, free]
        e = np.concatenate([each.e for each in flanks])
        step = np.linalg.lstsq(columns, -e, rcond=None)[0]
        values[free] += step
        left = float(np.sum((e + columns @ step) ** 2)) / max(len(e) - len(free), 1)
        uncertain[free] = COVERAGE * np.sqrt(left * np.diag(np.linalg.pinv(columns.T @ columns)))
        if float(np.abs(step).max()) < SETTLED:
            break
    flanks = _sorted(gauges, drum, _moved(own, values), flank, ball)
    rings = [ring for each in flanks for ring in _rings(each, drum)]
    # the part lies where its points had to be moved from
    told = -values * ([-1.0, 1.0, 1.0, -1.0, -1.0, 1.0] if drum.mirrored else np.ones(6))
    return MadeDrum(tuple(flanks), Placing(told, uncertain), tuple(rings))


def _probed(drum: DrumIntent, ball: float) -> list[Gauge]:
    """The drum's gauges, smaller by a ball, mm; raises UnlikeError for one that is no smaller than they are."""
    across = math.hypot(1.0, drum.follower.growth)  # square to the axis of a cone, for a length square to its surface
    gauges = gauges_of(drum)
    most = min(gauge.smallest for gauge in gauges) / across
    if not ball < most:
        raise UnlikeError(
            f"a ball of radius {ball:.6g} mm does not go where a roller of {most:.6g} mm does: give its radius, not "
            f"its diameter, or points of the metal"
        )
    return [replace(gauge, radius=gauge.radius - ball * across) for gauge in gauges]


def _moved(places: Array, values: Array) -> Array:
    """Places (n, 3) turned about z, tilted, and shifted, by the unknowns (6,)."""
    g, z, x, y, a, b = values
    turns = [
        np.array([[1.0, 0.0, 0.0], [0.0, math.cos(a), -math.sin(a)], [0.0, math.sin(a), math.cos(a)]]),
        np.array([[math.cos(b), 0.0, math.sin(b)], [0.0, 1.0, 0.0], [-math.sin(b), 0.0, math.cos(b)]]),
        np.array([[math.cos(g), -math.sin(g), 0.0], [math.sin(g), math.cos(g), 0.0], [0.0, 0.0, 1.0]]),
    ]
    return np.asarray(places @ (turns[2] @ turns[1] @ turns[0]).T + [x, y, z])


def _columns(flank: Measured) -> Array:
    """How e changes (n, 6) by each of the unknowns."""
    n, (px, py, pz) = flank.normal, flank.places.T
    nx, ny, nz = n.T
    return np.stack([ny * px - nx * py, nz, nx, ny, nz * py - ny * pz, nx * pz - nz * px], axis=-1)


def _sorted(
    gauges: Sequence[Gauge], drum: DrumIntent, places: Array, flank: Indices, ball: float = 0.0
) -> list[Measured]:
    """Points by flank: as their file says, else by the nearer one; the metal is a `ball` from them, mm."""
    worst = [gauge.worst(places) for gauge in gauges]
    off = [
        np.where((each.height < gauge.smallest) & np.isfinite(each.distance), np.abs(each.distance), np.inf)
        for gauge, each in zip(gauges, worst, strict=True)
    ]
    sides = np.array([0 if gauge.side < 0 else 1 for gauge in gauges])
    named = np.array([int(np.flatnonzero(sides == k)[0]) if (sides == k).any() else 0 for k in (0, 1)])
    number = np.where(flank == ANY, np.argmin(np.stack(off), axis=0), named[np.maximum(flank, 0)])
    found = []
    for k, gauge in enumerate(gauges):
        rows = np.flatnonzero(number == k)
        if not len(rows):
            continue
        own, theta = places[rows], worst[k].theta[rows]
        sine, cosine = np.sin(theta), np.cos(theta)
        across = gauge.aside(theta) - (own[:, 1] * cosine - own[:, 0] * sine)
        up = gauge.axis(theta) - own[:, 2]
        far, growth = np.maximum(np.hypot(across, up), 1e-300), drum.follower.growth
        across, up = across / far, up / far
        upright = 1.0 / math.hypot(1.0, growth)
        normal = upright * np.stack([growth * cosine - across * sine, growth * sine + across * cosine, up], axis=-1)
        guide = drum.follower.guide(gauge.level - drum.follower.level)
        lift = gauge.lifts.at(theta)[0]
        still = np.zeros_like(lift)
        moving = guide.axis(lift, still + 1.0, still)
        way = upright * (across * moving.y1 + up * moving.z1)
        metal = own - ball * normal
        found.append(Measured(gauge, k, rows, metal, -worst[k].distance[rows], theta, normal, way))
    return found


# --- points of another drum -------------------------------------------------------------------------------------------


def _demand_alike(drum: DrumIntent, gauges: Sequence[Gauge], places: Array, flank: Indices, ball: float) -> None:
    """Raise UnlikeError for points that are not of this drum, with what they look like."""

    def off(own: Array) -> float:
        """Distance, mm, within which most points lie; infinite for those beyond the flanks."""
        r = np.hypot(own[:, 0], own[:, 1])
        room = BEYOND * (drum.radius - drum.floor)
        if np.mean((r > drum.floor - room) & (r < drum.radius + room)) < MOST:
            return math.inf
        return _off(gauges, drum, own, flank)

    limit, here = ALIKE * drum.follower.radius, off(places)
    if here <= limit:
        return
    ways = [
        (
            "they were in inches, and are read as mm: head their columns x_in, or give --units inch for a bare x",
            places * 25.4,
        ),
        (
            "they were in mm, and are read as inches: head their columns x_mm, or give --units mm for a bare x",
            places / 25.4,
        ),
        ("they were mirrored: change rotation", places * [1.0, -1.0, 1.0]),
        ("they were measured from the other end, turned over", (places - [0, 0, drum.length]) * [1.0, -1.0, -1.0]),
    ]
    for words, tried in ways:
        if off(tried) <= limit:
            raise UnlikeError(f"these points look as if {words}")
    if math.isfinite(here):
        e = np.concatenate([each.e for each in _sorted(gauges, drum, places, flank)])
        middle = float(np.nanmedian(e))
        if limit < abs(middle) < drum.follower.radius and float(np.nanmedian(np.abs(e - middle))) < EVEN * abs(middle):
            how = f"{abs(middle):.4g} mm too {'large' if middle > 0.0 else 'small'} all round"
            remedy = "leave `--probe-radius` out, or give its own" if ball else "`--probe-radius` of the ball?"
            raise UnlikeError(f"these points look {how}: {remedy}")
        some = slice(None, None, max(len(places) // LOOKED, 1))
        few = places[some], flank[some]
        turn = _best(gauges, drum, few, 0, TURN / TRIED * np.arange(TRIED, dtype=np.float64))
        if turn is not None:
            angle = math.degrees(math.remainder(-turn, TURN)) * (-1.0 if drum.mirrored else 1.0)
            raise UnlikeError(f"these points look turned by about {angle:.0f} degrees: turn them back, then align")
        shift = _best(gauges, drum, few, 1, np.arange(-drum.length, drum.length, limit, dtype=np.float64))
        if shift is not None:
            raise UnlikeError(f"these points look shifted along z by about {-shift:.3g} mm: count from the lower face")
        raise UnlikeError(f"these points are of another drum: one of ten is {here:.3g} mm or more off its flanks")
    r = np.hypot(places[:, 0], places[:, 1])
    raise UnlikeError(
        f"these points are of another drum: they lie {r.min():.6g} to {r.max():.6g} mm from its axis, and its flanks "
        f"{drum.floor:.6g} to {drum.radius:.6g}"
    )


def _off(gauges: Sequence[Gauge], drum: DrumIntent, places: Array, flank: Indices) -> float:
    """Distance, mm, within which most points lie."""
    e = np.concatenate([each.e for each in _sorted(gauges, drum, places, flank)])
    return float(np.quantile(np.where(np.isfinite(e), np.abs(e), np.inf), MOST))


def _best(
    gauges: Sequence[Gauge], drum: DrumIntent, few: tuple[Array, Indices], unknown: int, tried: Array
) -> float | None:
    """The value of an unknown that brings points to the drum; None where none of those tried does."""
    values = np.zeros((len(tried), len(UNKNOWNS)))
    values[:, unknown] = tried
    places = np.concatenate([_moved(few[0], row) for row in values])
    e = np.empty(len(places))
    for each in _sorted(gauges, drum, places, np.tile(few[1], len(tried))):
        e[each.rows] = each.e
    off = np.quantile(np.where(np.isfinite(e), np.abs(e), np.inf).reshape(len(tried), -1), MOST, axis=1)
    best = int(np.argmin(off))
    return float(tried[best]) if off[best] <= ALIKE * drum.follower.radius else None


# --- the motion -------------------------------------------------------------------------------------------------------


def _rings(flank: Measured, drum: DrumIntent) -> list[Ring]:
    """Rings of points at one radius, as many as suffice: round the whole turn, without a wide gap."""
    order = np.argsort(flank.r)
    ends = np.flatnonzero(np.diff(flank.r[order]) > RING) + 1
    rings = []
    for own in np.split(order, ends):
        theta = np.sort(np.unique(flank.theta[own] % TURN))
        if len(theta) < LEAST_RING or np.ptp(flank.r[own]) > 4.0 * RING:
            continue
        if float(np.diff(np.append(theta, theta[0] + TURN)).max()) <= WIDEST:
            rings.append(_ring(flank, own, drum))
    return rings


def _ring(flank: Measured, own: Indices, drum: DrumIntent) -> Ring:
    theta, e, way = flank.theta[own], flank.e[own], flank.way[own]
    kept = np.ones(len(own), dtype=np.bool_)
    waves = int(min(WAVES, len(own) / PER_WAVE))
    sd = 0.0
    for _ in range(ROUNDS):
        base = _waves(theta[kept], waves)
        found = np.linalg.lstsq(base, e[kept], rcond=None)[0]
        left = e - _waves(theta, waves) @ found
        sd = math.sqrt(float(np.sum(left[kept] ** 2)) / max(int(kept.sum()) - base.shape[1], 1))
        spread = (
            NORMAL
            * float(np.median(np.abs(left[kept])))
            * math.sqrt(len(left) / max(int(kept.sum()) - base.shape[1], 1))
        )
        inside = _within(left, max(STANDS_OUT * spread, LEAST_OUT))
        if (inside == kept).all():
            break
        kept = inside
    steps = equal_steps(STEPS)
    at = _waves(steps, waves)
    covariance = sd**2 * np.linalg.pinv(base.T @ base)
    own_sd = np.sqrt(np.maximum(np.einsum("nk,kl,nl->n", at, covariance, at), 0.0))
    moved = 1.0 / np.interp(steps, theta[np.argsort(theta % TURN)] % TURN, way[np.argsort(theta % TURN)], period=TURN)
    scale = drum.follower.in_unit(1.0)
    return Ring(
        flank.number,
        float(np.median(flank.r[own])),
        len(own),
        waves,
        scale * moved * (at @ found),
        COVERAGE * scale * np.abs(moved) * own_sd,
        float(np.abs(moved).max()),
        sd,
        flank.rows[own[~kept]],
    )


def _within(left: Array, limit: float) -> Mask:
    inside: Mask = np.abs(left) <= limit
    return inside


def _waves(theta: Array, waves: int) -> Array:
    """Columns (n, 2 k + 1): 1, cosines and sines of up to so many waves a turn."""
    phase = np.outer(theta, np.arange(1, waves + 1))
    return np.hstack([np.ones((len(theta), 1)), np.cos(phase), np.sin(phase)])
