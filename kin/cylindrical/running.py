"""The motion that a drum of unknown origin gives a roller: set down on its lower flank and up against its upper one.

A line along the axis, half way along the roller, shows where there is metal: between two stretches of it lies a groove,
a stretch between two rollers is a rib, and the outermost end may be that of an end cam. Followed round the turn these
are tracks. A roller that stands on the line of a flank at that radius tells which metal is below its axis and which is
above; then it is set down on all facets of its side, over its own length, at each angle: a place by contact, of the
file as it is, with no intent.

A groove of several turns crosses itself, and is followed over all of them (`kin.cylindrical.wound`). Where a wall is
gone the pin of a shoe touches the other one, and where both are, its way is a cubic between the places beside.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from kin.cylindrical.contact import set_down
from kin.cylindrical.follower import DrumFollower
from kin.cylindrical.frame import On, Rates, pressure_jet
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.intent import DrumIntent, End, Groove, Rib
from kin.cylindrical.lifts import Lifts
from kin.cylindrical.unknown import UnknownError
from kin.cylindrical.wound import windings
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.numeric.angles import TURN, degrees
from kin.numeric.elementary import Jet
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.cylindrical.follower import Arm
    from kin.cylindrical.intent import Track
    from kin.cylindrical.roller import Gauge
    from kin.cylindrical.unknown import Column, Drum
    from kin.cylindrical.wound import Winding
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.turned.guide import Guide

Kind = Literal["groove", "rib", "top", "bottom"]
ENDS: tuple[Kind, ...] = ("top", "bottom")

LOOKS = 2880  # lines along the axis, over a turn
STEPS = 720  # angles at which the roller is set down
GAP = 0.5  # mm that a roller stands off the floor where it is not said where it begins
BENEATH = 1e-3  # of the radius of the blank, by which lines lie within its facets, and a roller may stand out of it
ROUNDS = 4  # of the angle at which a roller on an arm passes over a point
STILL = 4.0  # times the facets' sag and rounding: an end that varies by less is no track
LEANING = 0.2  # of an arm's length, by which its swing may move the roller aside where nothing is known of it yet
CORNERS = 2.0  # times the facets' sag: their corners may be as far off again, which a file does not show
MOST_REACH = 1.4  # rad, beyond which a line about the axis is not touched
ASIDE = 0.02  # of the roller's radius, by which a guess may put it aside
SPREAD = 3  # steps to both sides, over which a slope is taken
FAR = 3.0  # times the roller's radius: facets of another turn, farther from its axis than this, hold nothing
BESIDE = 2 * TURN / STEPS  # rad, beside the end of a wall, in which it is not said to hold the roller
FIT = 12  # steps to either side of a stretch without walls, by which its cubic is found
ASTRAY = 0.25  # of the width of a groove, within which its turns at another radius are the same


class StatedRoller(NamedTuple):
    """What is known of the roller: lengths mm.

    `inner` and `outer` are where it bears along its axis, None for the floor and GAP, and for the blank. A cone by
    `taper`, rad, or "axis" for an apex on the drum's axis, has its radius `at` a place, None for half way. `height` is
    that of the track at angle 0, where there are several, or of the turn that begins there; `distance` that of a rib's
    two rollers. `turns` is after how many the track closes, None for what the file shows. A `shoe` is twice the radius
    wide, and turns on a pin that bears as the roller does.
    """

    radius: float
    kind: Kind | None = None
    inner: float | None = None
    outer: float | None = None
    offset: float = 0.0
    taper: float | Literal["axis"] = 0.0
    at: float | None = None
    arm: Arm | None = None
    height: float | None = None
    distance: float | None = None
    turns: int | None = None
    shoe: bool = False


@dataclass(frozen=True, eq=False)
class Run:
    """The motion of a roller on an unknown drum, at equal steps of the turn from 0, or of all turns.

    kind      of the track
    follower  the roller, where it bears, its guide; its law is none
    floor     radius down to which flanks reach, mm
    lower     position (n,) of the roller that is set down on the lower flank, mm over the lower face, or the arm's
              angle, rad, over level; nan without such a flank
    upper     the same, up against the upper flank
    lean      greatest pressure angle, rad, about, at the roller's inner end
    error     by how much facets may put a position wrong, about, in its unit
    distance  of the axes of a rib's two rollers, mm, None of others
    touches   whether the lower and the upper flank hold the roller (2, n); in a crossing of several turns a position on
              a wall that is gone is that on the other one less the play beside, or on a cubic between both sides
    gap       longest stretch without a wall along the groove, mm, about; 0 without a crossing
    sag       how far facets stand off the surface between them, mm, about
    """

    kind: Kind
    follower: DrumFollower
    floor: float
    lower: Array
    upper: Array
    lean: Array
    error: float
    distance: float | None
    touches: Mask
    gap: float
    sag: float

    @property
    def turns(self) -> int:
        """Turns of the drum after which the motion repeats."""
        return self.follower.turns

    @property
    def closed(self) -> bool:
        """Whether flanks hold the follower to both sides; else it is pressed on an end face."""
        return self.kind not in ENDS


class _Track(NamedTuple):
    """A track by the heights of its lower and upper flank, mm, at lines along the axis (n,); nan without a flank.

    The lower flank is that on which a roller stands. A groove of several turns has as many times LOOKS lines, and
    `stands` (2, n) says where it has its walls; None of one turn.
    """

    kind: Kind
    lower: Array
    upper: Array
    stands: Mask | None = None

    @property
    def turns(self) -> int:
        """Turns after which it closes."""
        return len(self.lower) // LOOKS

    def begun(self, turn: int) -> _Track:
        """Track whose rows begin with another of its turns, by number."""
        lower, upper = (np.roll(row, -turn * LOOKS) for row in (self.lower, self.upper))
        stands = None if self.stands is None else np.roll(self.stands, -turn * LOOKS, axis=1)
        return _Track(self.kind, lower, upper, stands)


def run(drum: Drum, stated: StatedRoller) -> Run:
    """Let a roller run on a drum over the turn.

    Raises UnknownError where no track is found, or several; where there is no floor, and where the roller touches
    nothing or metal stands in its way.
    """
    outer = drum.radius if stated.outer is None else stated.outer
    if not outer <= drum.radius * (1.0 + BENEATH) or (
        stated.inner is not None and not stated.inner < (1.0 - BENEATH) * outer
    ):
        begins = "" if stated.inner is None else f"from {stated.inner:.6g} "
        raise UnknownError(
            f"the blank is at {drum.radius:.6g} mm, and the roller bears {begins}to {outer:.6g} mm",
            "give from and to between floor and blank",
        )
    beneath = (1.0 - BENEATH) * drum.rim
    probe = 0.5 * (stated.inner + outer) if stated.inner is not None else min(outer, beneath)
    track = _track(drum, stated, probe)
    floor = _floor(drum, track, stated, probe)
    inner = floor + GAP if stated.inner is None else stated.inner
    if not floor < inner < outer:
        raise UnknownError(
            f"the floor is at {floor:.6g} mm and the blank at {drum.radius:.6g}, and the roller bears from "
            f"{inner:.6g} to {outer:.6g} mm",
            "give from and to between floor and blank",
        )
    if stated.inner is None:
        probe = 0.5 * (inner + outer)
        track = _track(drum, stated._replace(kind=track.kind), probe)
    _demand_led(track, stated)
    distance = stated.distance
    if track.kind == "rib" and distance is None:
        if stated.arm is not None:
            raise UnknownError("two rollers on one arm have a distance of their own", "give distance")
        distance = 0.0
    middle = 0.5 * (inner + outer) if stated.at is None else stated.at
    taper = math.atan2(stated.radius, middle) if stated.taper == "axis" else stated.taper
    follower = DrumFollower(
        stated.radius,
        inner,
        outer,
        0.0 if stated.arm is None else stated.arm.pivot,
        Piecewise(np.array([0.0, TURN * track.turns]), (Constant(0.0),)),
        stated.offset,
        taper,
        middle if taper else None,
        stated.arm,
        track.turns,
    )
    depth = drum.radius - floor
    gauges = gauges_of(DrumIntent(follower, _flanks(track.kind, depth, distance or 0.0), drum.radius, drum.length))
    count = STEPS * track.turns
    theta = equal_steps(count) * track.turns
    found = {-1: np.full(count, np.nan), 1: np.full(count, np.nan)}
    touches, gap = _touches(drum, track, stated, (inner, probe, outer)) if track.stands is not None else (None, 0.0)
    steepest, leans = 0.0, np.zeros(count)
    for gauge in gauges:
        line = track.lower if gauge.side < 0 else track.upper
        beside = gauge.level - follower.level
        guide = follower.guide(beside)
        size = stated.radius + (probe - (follower.at or 0.0)) * follower.growth
        guess = _guessed(gauge, guide, line, (probe, size, _aside(follower)))
        found[gauge.side] = _placed(drum, gauge, guide, guess, theta)
    if touches is not None:
        found[-1], found[1] = _bridged(found[-1], found[1], touches)
    for gauge in gauges:
        lean = _leaning(follower, gauge.level - follower.level, gauge.side, found[gauge.side])
        leans = np.where(np.abs(lean) > np.abs(leans), lean, leans)
        steepest = max(steepest, float(np.abs(lean).max()))
    lower, upper = found[-1], found[1]
    if track.kind == "rib" and stated.distance is None:
        distance = float((lower - upper).mean())
        lower, upper = lower - 0.5 * distance, upper + 0.5 * distance
    lever = gauges[0].lever
    sag = drum.sag if track.turns == 1 else drum.crossed_sag
    error = (CORNERS * sag + math.sqrt(3.0) * drum.rounding) / max(math.cos(steepest), 0.1) / lever
    held = np.isfinite([lower, upper]) if touches is None else touches
    return Run(track.kind, follower, floor, lower, upper, leans, error, distance, held, gap, sag)


def _flanks(kind: Kind, depth: float, distance: float) -> Track:
    """What is cut: flanks of a track, by its depth and the distance of two rollers, mm."""
    if kind == "groove":
        return Groove(depth)
    return Rib(depth, distance) if kind == "rib" else End(kind, depth)


# --- tracks -----------------------------------------------------------------------------------------------------------


def _track(drum: Drum, stated: StatedRoller, radius: float) -> _Track:
    """The track at a radius, mm, of the kind that is asked for, or of that which the drum shows."""
    columns = drum.columns(radius, _looks())
    for k, column in enumerate(columns):
        ways = np.where(np.arange(len(column.sense)) % 2 == 0, -1.0, 1.0)
        if not len(column.z) or len(column.z) % 2 or (column.sense != ways).any():
            raise UnknownError(
                f"at a radius of {radius:.6g} mm and a polar angle of {degrees(float(_looks()[k])):.6g} degrees "
                f"the solid has no metal, or no inside: no drum, or a damaged file"
            )
    still = STILL * (drum.sag + drum.rounding)
    voids, metals = _stretches(columns, 1), _stretches(columns, 0)
    tracks: dict[Kind, list[_Track]] = {"groove": [], "rib": [], "top": [], "bottom": []}
    tracks["groove"] = [_Track("groove", low, high) for low, high in voids]
    if not voids or (stated.turns or 1) > 1:
        tracks["groove"] += [
            _Track("groove", each.lower, each.upper, each.stands) for each in windings(columns, radius)
        ]
    # upper flank of the roller below a rib, lower flank of that above it
    both = [(low, high) for low, high in metals if np.ptp(low) > still and np.ptp(high) > still]
    tracks["rib"] = [_Track("rib", high, low) for low, high in both]
    none = np.full(len(columns), np.nan)
    last, first = np.array([column.z[-1] for column in columns]), np.array([column.z[0] for column in columns])
    if np.ptp(last) > still:
        tracks["top"] = [_Track("top", last, none)]
    if np.ptp(first) > still:
        tracks["bottom"] = [_Track("bottom", none, first)]
    kind = stated.kind
    if kind is None:
        inner: tuple[Kind, ...] = ("groove", "rib")
        shown = [name for name in inner if tracks[name]] or [name for name in ENDS if tracks[name]]
        if not shown:
            raise UnknownError(f"no groove, rib or end face that rises and falls is found at {radius:.6g} mm")
        if len(shown) > 1:
            raise UnknownError(f"it may be of kind {' or '.join(shown)}", "give drum with one of them")
        kind = shown[0]
    chosen = tracks[kind]
    if stated.turns is not None and chosen:
        own = [track for track in chosen if track.turns == stated.turns]
        if not own:
            counts = sorted({track.turns for track in chosen})
            words = " or ".join("a turn" if count == 1 else f"{count} turns" for count in counts)
            raise UnknownError(f"the {_NOUNS[kind]} closes after {words}, not {stated.turns}", "leave turns out")
        chosen = own
    if stated.height is not None and chosen:
        begun = [track.begun(turn) for track in chosen for turn in range(track.turns)]
        chosen = [min(begun, key=lambda track: abs(_level(track) - (stated.height or 0.0)))]
    if not chosen:
        raise UnknownError(
            f"no {_NOUNS[kind]} that goes round the turn and closes is found at a radius of {radius:.6g} mm",
            "give another drum, or from and to where its flanks are",
        )
    if len(chosen) > 1:
        heights = " and ".join(f"{_level(track):.6g}" for track in chosen)
        raise UnknownError(f"there are {len(chosen)} tracks, at heights of {heights} mm at angle 0", "give height")
    return chosen[0]


_NOUNS: dict[Kind, str] = {
    "groove": "groove",
    "rib": "rib",
    "top": "end face towards the top",
    "bottom": "end face towards the bottom",
}


def _looks(turns: int = 1) -> Array:
    """Polar angles of lines along the axis over turns: half a step off 0, so that they meet no regular edges."""
    return equal_steps(LOOKS * turns) * turns + 0.5 * TURN / LOOKS


def _level(track: _Track) -> float:
    """Height of a track at angle 0, mm."""
    sides = [line[0] for line in (track.lower, track.upper) if np.isfinite(line[0])]
    return float(np.mean(sides))


def _stretches(columns: Sequence[Column], first: Literal[0, 1]) -> list[tuple[Array, Array]]:
    """Lower and upper ends (n,) of stretches that go round the turn and close: voids (first 1), or metal (0).

    From line to line a stretch goes on in the one that it overlaps, and ends where there is none or are several.
    """
    each = [np.stack([z[first : len(z) - 1 : 2], z[first + 1 : len(z) : 2]], axis=1) for z in (c.z for c in columns)]
    found = []
    for start in each[0]:
        rows = [start]
        for following in [*each[1:], each[0]]:
            low, high = rows[-1]
            over = following[(following[:, 0] < high) & (following[:, 1] > low)]
            if len(over) != 1:
                break
            rows.append(over[0])
        else:
            if (rows[-1] == start).all():
                track = np.array(rows[:-1])
                found.append((track[:, 0], track[:, 1]))
    return found


def _floor(drum: Drum, track: _Track, stated: StatedRoller, radius: float) -> float:
    """Radius, mm, of the floor: the farthest that is met inwards from where the roller runs.

    A ring of an end cam that stands over what lies within it has its own floor, by where the roller begins.
    """
    theta, kind, lower, upper = _looks(track.turns), track.kind, track.lower, track.upper
    if kind in ENDS and stated.inner is not None:
        return stated.inner - GAP
    # the axis of a roller on the flank is about so far off it
    rows = [0.5 * (lower + upper)] if kind == "groove" else [lower + stated.radius, upper - stated.radius]
    floor = max(drum.floor(theta, z) for z in rows if np.isfinite(z).all())
    if math.isnan(floor) or floor >= radius:
        raise UnknownError(f"no floor is found beside the {_NOUNS[kind]} at a radius of {radius:.6g} mm", "give from")
    return floor


# --- several turns ---------------------------------------------------------------------------------------------------


def _demand_led(track: _Track, stated: StatedRoller) -> None:
    """Raise UnknownError for a roller that drops into a crossing, and for a shoe where no groove leads it straight."""
    if stated.shoe and track.kind != "groove":
        raise UnknownError(
            f"a shoe is led by a groove, and this is of kind {track.kind}", "give roller, and leave width out"
        )
    if track.turns > 1 and not stated.shoe:
        raise UnknownError(
            f"the groove closes after {track.turns} turns and crosses itself, where a roller drops in",
            f"give width {2.0 * stated.radius:.6g} of a shoe in place of roller",
        )


def _touches(drum: Drum, track: _Track, stated: StatedRoller, radii: tuple[float, ...]) -> tuple[Mask, float]:
    """Whether both flanks of a groove of several turns hold the pin at equal steps, (2, n); and the longest gap, mm.

    A flank holds it where its wall stands at all radii, mm, at the place of contact there, and beside that.
    """
    count, theta = STEPS * track.turns, equal_steps(STEPS * track.turns) * track.turns
    middle = 0.5 * (track.lower + track.upper)
    held, gap = np.ones((2, count), dtype=np.bool_), 0.0
    for radius in radii:
        at = min(radius, (1.0 - BENEATH) * drum.rim)
        own = _alike(windings(drum.columns(at, _looks()), at), middle, at)
        slope = np.gradient(np.concatenate([middle[-1:], middle, middle[:1]]))[1:-1] * (LOOKS / TURN)
        sine = slope / np.hypot(slope, at)
        for side, wall in enumerate(own.stands):
            # a groove that climbs is touched below ahead of the pin, and above behind it
            ahead = (1 - 2 * side) * np.arcsin(np.clip(stated.radius * _at(sine, theta) / at, -1.0, 1.0))
            for beside in (-BESIDE, 0.0, BESIDE):
                place = np.floor(((theta + ahead + beside) / TURN) * LOOKS).astype(np.intp) % len(wall)
                held[side] &= wall[place]
            gap = max(gap, _longest(~wall, np.hypot(at, slope) * (TURN / LOOKS)))
    return held, gap


def _alike(found: Sequence[Winding], middle: Array, radius: float) -> Winding:
    """Groove among those found at a radius, mm, begun at the turn whose middles are those given (n,), mm.

    Raises UnknownError where none is near enough, beside the groove's width.
    """
    for winding in found:
        for turn in range(len(winding.lower) // LOOKS):
            own = winding.begun(turn, LOOKS)
            if len(own.lower) == len(middle):
                off = np.abs(0.5 * (own.lower + own.upper) - middle)
                if float(off.max()) <= ASTRAY * float((own.upper - own.lower).min()):
                    return own
    raise UnknownError(
        f"the turns of the groove are not told from one another at a radius of {radius:.6g} mm", "give from and to"
    )


def _longest(gone: Mask, lengths: Array) -> float:
    """Greatest length of a stretch of lines, over the turns and round, in which all are gone; lengths (n,) each."""
    if gone.all():
        return float(lengths.sum())
    begin = int(np.argmin(gone))
    total, most = 0.0, 0.0
    for is_gone, length in zip(np.roll(gone, -begin).tolist(), np.roll(lengths, -begin).tolist(), strict=True):
        total = total + length if is_gone else 0.0
        most = max(most, total)
    return most


def _bridged(lower: Array, upper: Array, held: Mask) -> tuple[Array, Array]:
    """Positions (n,), mm, on both flanks where one of them is gone, or both."""
    both = held.all(axis=0)
    if not both.any():
        raise UnknownError("the groove has nowhere both of its walls, so that its play is not told")
    n, steps = len(lower), np.arange(len(lower))
    # facets are as wide as some steps: the mean of these has less of their error
    known = (upper - lower)[both]
    mean = np.mean([np.roll(known, k) for k in range(-FIT // 2, FIT // 2 + 1)], axis=0)
    play = np.interp(steps, steps[both], mean, period=n)
    lower = np.where(held[0], lower, upper - play)
    free: Mask = ~(held[0] | held[1])
    for first in np.flatnonzero(free & ~np.roll(free, 1)):
        length = int(np.argmin(np.roll(free, -first)))
        near = np.concatenate([np.arange(-FIT, 0), length + np.arange(FIT)])
        near = near[~free[(first + near) % n]]
        cubic = np.polynomial.Polynomial.fit(near, lower[(first + near) % n], 3)
        inside = np.arange(length)
        lower[(first + inside) % n] = cubic(inside)
    return lower, np.where(held[1], upper, lower + play)


# --- the roller -------------------------------------------------------------------------------------------------------


class _Near(Lifts):
    """Positions by a guess at lines along the axis, in place of those of a law."""

    guess: Array

    @staticmethod
    def of(lifts: Lifts, guess: Array) -> _Near:
        """A guess (n,) in place of a law."""
        near = _Near(lifts.law, lifts.turns)
        object.__setattr__(near, "guess", guess)
        return near

    def at(self, theta: Array) -> tuple[Array, Array, Array]:
        """The guess (n,) at angles (n,), rad; no slope and no bend."""
        still = np.zeros_like(theta)
        return _at(self.guess, theta), still, still


def _guessed(gauge: Gauge, guide: Guide, line: Array, roller: tuple[float, float, float]) -> Array:
    """Position (n,), at lines along the axis, of a roller on the line of a flank: nearly that on all of the flank.

    `roller` has the radius of the line, the roller's own there, and how far aside its axis may stand, mm. Raises
    UnknownError where it touches none of the line.
    """
    radius, size, aside = roller
    step = TURN / LOOKS
    most = int(min(math.asin(min(1.0, (size + aside) / radius)), MOST_REACH) / step) + 1
    best = np.full(len(line), -np.inf)
    still, sizes = np.zeros(len(line)), np.full(len(line), size)
    for k in range(-most, most + 1):
        y = np.full(len(line), radius * math.sin(k * step))
        best = np.fmax(best, guide.touching((y, np.roll(line, -k)), still, sizes, gauge.side).gives)
    if not np.isfinite(best).all():
        at = degrees(float(_looks(len(line) // LOOKS)[int(np.argmin(np.isfinite(best)))]))
        raise UnknownError(f"the roller touches nothing of the {gauge.name} flank at about {at:.6g} degrees")
    return np.asarray(-gauge.side * best / guide.lever)


def _aside(follower: DrumFollower) -> float:
    """About how far from a radius the roller's axis comes, mm."""
    if follower.arm is None:
        return abs(follower.offset)
    return abs(follower.arm.offset - follower.arm.side * follower.arm.length) + LEANING * follower.arm.length


def _placed(drum: Drum, gauge: Gauge, guide: Guide, guess: Array, theta: Array) -> Array:
    """Positions (n,), at angles, rad, of a roller that is set down on the metal of its side.

    Metal is that below its axis as it stands by a `guess` at lines along the axis. Raises UnknownError where that
    cannot be told, and where the roller touches nothing.
    """
    metal, turn = _metal(drum, gauge, guide, guess)
    corners, phi = drum.facets[metal], drum.phi[metal] + TURN * turn[:, None]
    reach = math.asin(min(1.0, (gauge.largest + _aside_of(guide, guess)) / gauge.inner))
    kept, at = [], []
    low, high = phi.min(axis=1) - reach, phi.max(axis=1) + reach
    order = np.argsort(low)
    low, high, corners = low[order], high[order], corners[order]
    widest, period = float((high - low).max(initial=0.0)), gauge.lifts.period
    for angle, stands in zip(theta, _at(guess, theta), strict=True):
        windows = []
        for beside in (-period, 0.0, period):
            first, last = np.searchsorted(low, [angle + beside - widest, angle + beside])
            windows.append(first + np.flatnonzero(high[first:last] >= angle + beside))
        own = np.unique(np.concatenate(windows))
        own = own[_may_touch(gauge, guide, corners[own], float(angle), stands)]
        kept.append(own)
        at.append(np.full(len(own), angle))
    chosen, angles = np.concatenate(kept), np.concatenate(at)
    near = replace(gauge, lifts=_Near.of(gauge.lifts, guess))
    gives = set_down(near, corners[chosen], (angles, angles), theta)
    if not np.isfinite(gives).all():
        free = degrees(float(theta[int(np.argmin(np.isfinite(gives)))]))
        raise UnknownError(f"the roller touches nothing of the {gauge.name} flank at {free:.6g} degrees")
    return np.asarray(_at(guess, theta) - gauge.side * gives / guide.lever)


def _at(guess: Array, angle: Array | float) -> Array:
    """Guess at an angle, rad."""
    turns = len(guess) // LOOKS
    return np.asarray(np.interp(angle, _looks(turns), guess, period=TURN * turns))


def _aside_of(guide: Guide, guess: Array) -> float:
    """Greatest distance of the roller's axis from a radius, mm."""
    still = np.zeros_like(guess)
    return float(np.abs(guide.axis(guess, still, still).y).max())


def _metal(drum: Drum, gauge: Gauge, guide: Guide, guess: Array) -> tuple[Indices, Indices]:
    """Facets on the metal's side of the roller's axis, along its length: their numbers, and those of the turn, (t,).

    Of several turns a facet is of each that comes near it.
    """
    within = np.flatnonzero(drum.r.max(axis=1) >= gauge.inner)
    turns = gauge.lifts.turns
    own, turn = np.tile(within, turns), np.repeat(np.arange(turns), len(within))
    phi, r, z = drum.phi[own] + TURN * turn[:, None], drum.r[own], drum.facets[own][..., 2]
    theta = phi.ravel()
    for _ in range(ROUNDS):
        position = _at(guess, theta)
        axis = guide.axis(position, np.zeros_like(position), np.zeros_like(position))
        theta = phi.ravel() - np.arcsin(np.clip(axis.y / np.maximum(r.ravel(), 1e-300), -1.0, 1.0))
    above = (axis.z - z.ravel()).reshape(-1, 3)
    away = gauge.side * above > 0.0
    across = away.any(axis=1) & ~away.all(axis=1)
    if across.any():
        place = drum.facets[own[across][0]].mean(axis=0)
        angle = degrees(math.atan2(place[1], place[0]) % TURN)
        raise UnknownError(
            f"metal stands in the roller's way at about {angle:.6g} degrees, {np.hypot(*place[:2]):.6g} mm out",
            "give from and to within the flanks, or a smaller roller",
        )
    there = ~away.any(axis=1)
    if turns > 1:
        there &= np.abs(above).min(axis=1) <= FAR * gauge.largest
    return own[there], turn[there]


def _may_touch(gauge: Gauge, guide: Guide, corners: Array, angle: float, guess: Array) -> Mask:
    """Which facets (t, 3, 3) may hold the roller at an angle: none of the others reaches as high as one corner does."""
    sine, cosine, still = math.sin(angle), math.cos(angle), np.zeros(3 * len(corners))
    points = list(corners.reshape(-1, 3).T)
    held = gauge.held(points, still + guess, still + sine, still + cosine)
    gives, along = held.gives.reshape(-1, 3), held.along.reshape(-1, 3)
    own = np.isfinite(gives)
    inside = own & (along >= gauge.inner) & (along <= gauge.outer)
    most = float(gives[inside].max(initial=-np.inf))
    y = (points[1] * cosine - points[0] * sine - float(guide.axis(guess, 0.0 * guess, 0.0 * guess).y)).reshape(-1, 3)
    # F bends along an edge by no more than at its end that is farthest aside
    size = gauge.smallest
    aside = np.minimum((np.abs(y).max(axis=1) + ASIDE * size) / size, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        more = np.ptp(y, axis=1) ** 2 / (8.0 * size * (1.0 - aside**2) ** 1.5)
        bound = np.where(own.all(axis=1) & (aside < 1.0), np.max(gives, axis=1) + more, np.inf)
    wide = gauge.largest * (1.0 + ASIDE)
    there = (y.min(axis=1) <= wide) & (y.max(axis=1) >= -wide)
    there &= (along.max(axis=1) >= gauge.inner) & (along.min(axis=1) <= gauge.outer)
    return np.asarray(there & ~(bound < most))


def _leaning(follower: DrumFollower, beside: float, side: Side, position: Array) -> Array:
    """Pressure angles (n,), rad, about, at the roller's inner end, by the differences of positions at equal steps."""
    slope = (np.roll(position, -SPREAD) - np.roll(position, SPREAD)) * (STEPS / (2.0 * SPREAD * TURN))
    rows = Rates(*(Jet(row[None]) for row in (position, slope, np.zeros_like(slope))))
    return np.asarray(pressure_jet(follower, rows, follower.inner, On(side, beside=beside)).c[0])
