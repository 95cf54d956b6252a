"""What a milling program leaves of the stock: its closed paths moved by the cutter's radius; what goes wrong on it.

z is 0 at the top of the stock and falls into it. A cut is what the cutter does between coming down and going up again:
an arc of entry, a closed path, an arc of exit. The deepest path of each contour decides what it is; the one that holds
all others is milled from outside, the others are holes. Of stock that comes with its outline all are holes.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import cross, dot
from kin.contour.intersections import boxes, overlapping
from kin.contour.nearest import nearest, signed_distance
from kin.contour.offset import TightError, parallel
from kin.contour.region import gaps
from kin.judge.check import Check, at_most, failed
from kin.numeric.places import place_text
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.gcode import ARC_MM, arcs_of
from kin.read.nesting import Chain, Nest, counter_clockwise

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array
    from kin.read.gcode import Move, Program

FINE = 0.05  # of the tolerance: what joints of the path may be snapped by
KINK = 0.5  # degrees between the ways in and out and the path: what rounding makes of a tangent on a small part
LOOKS = 40  # halvings of a path that is held against a contour
MOST_NAMED = 3
_CUTTER = re.compile(r"^cutter: diameter ([0-9.]+)")


@dataclass(frozen=True)
class Milling:
    """How a part is meant to be milled, mm.

    radius        of the cutter
    thickness     of the stock, which is cut through
    depth_of_cut  that one pass may have at most
    climb         a right-handed cutter meets the metal climbing
    standing      how far metal may stand outside the contour where the cutter does not reach
    hub           radius and height of the metal about the shaft that stands on the stock; None without
    outline       the outline is milled; of round stock, as of a ring, it is not
    """

    radius: float
    thickness: float
    depth_of_cut: float
    climb: bool = True
    standing: float = 0.0
    hub: tuple[float, float] | None = None
    outline: bool = True


class Cut(NamedTuple):
    """Moves at one height: on the way to the closed path, round it, and away from it."""

    z: float
    entry: list[Move]
    loop: list[Move]
    exit: list[Move]


@dataclass(frozen=True, eq=False)
class Milled(Nest):
    """What a program leaves, mm, by falling area, the outline first if it is milled; and checks."""

    checks: tuple[Check, ...]


def milled(program: Program, milling: Milling, tolerance: float) -> Milled:
    """Simulate a program; raises ReadError where no closed contour comes of it."""
    path, radius = program.path, milling.radius
    cuts = list(_cuts(program))
    if not cuts:
        raise ReadError("empty", "the program cuts nothing below the top of the stock", path)
    features = _features(cuts, radius)
    last = [feature[-1] for feature in features]
    loops = [arcs_of(cut.loop) for cut in last]
    sizes = [abs(_area(loop)) for loop in loops]
    outer = int(np.argmax(sizes)) if milling.outline else None
    edges = []
    for k, (cut, loop) in enumerate(zip(last, loops, strict=True)):
        inward = 1.0 if (_area(loop) > 0.0) == (k == outer) else -1.0
        try:
            edge = parallel(loop, inward * radius, FINE * tolerance)
        except TightError as error:
            raise ReadError("open", f"the cutter's path from line {cut.loop[0].line}: {error}", path) from error
        edges.append(counter_clockwise(edge))
    chains = [Chain(edge, pieces=len(cut.loop)) for edge, cut in zip(edges, last, strict=True)]
    falling = sorted(range(len(chains)), key=lambda k: (k != outer, -edges[k].area))
    checks = (
        _cutter_check(program, milling),
        _arcs_check(program),
        _rapid_check(program, milling),
        _depth_check(features, milling, tolerance),
        _direction_check(features, outer, milling),
        _entry_check(features),
        _hub_check(program, milling) or _gouge_check(features, edges, outer, milling, tolerance),
    )
    return Milled(tuple(chains[k] for k in falling), checks)


def _cuts(program: Program) -> list[Cut]:
    """What the cutter does below the top of the stock, each time it is down."""
    found: list[Cut] = []
    down: list[Move] = []
    plunge: Move | None = None
    for move in (*program.moves, None):
        if move is not None and not move.rapid and move.start[2] == move.end[2] < 0.0:
            if move.start != move.end or move.centre is not None:
                down.append(move)
            continue
        if move is not None and not move.rapid and min(move.start[2], move.end[2]) < 0.0 and _across(move):
            raise _unread(program, move, "cuts along a slope")
        if down:
            found.append(_cut(program, down))
        elif plunge is not None:
            raise _unread(program, plunge, "goes down where nothing is cut")
        down, plunge = [], None
        if move is not None and not move.rapid and min(move.start[2], move.end[2]) < 0.0:
            plunge = move if move.end[2] < move.start[2] else None
    return found


def _across(move: Move) -> bool:
    return move.start[:2] != move.end[:2]


def _unread(program: Program, move: Move, what: str) -> ReadError:
    return ReadError("unsupported", f"line {move.line} {what}, which is not read", program.path)


def _cut(program: Program, down: list[Move]) -> Cut:
    """Take a path apart where it comes back to a place it has been at."""
    places: dict[tuple[float, float], int] = {}
    best = (0, 0)
    for i, move in enumerate(down):
        places.setdefault(move.start[:2], i)
        begin = places.get(move.end[:2])
        if begin is not None and i + 1 - begin > best[1] - best[0]:
            best = (begin, i + 1)
    if best[1] == 0:
        line, (x, y, _) = down[0].line, down[0].start
        raise ReadError("open", f"line {line}: the path from {place_text(x, y)} does not close", program.path)
    return Cut(down[0].start[2], down[: best[0]], down[best[0] : best[1]], down[best[1] :])


def _features(cuts: list[Cut], radius: float) -> list[list[Cut]]:
    """Cuts about the same contour together, in order; two paths about one are nearer to each other than the radius."""
    found: list[tuple[Arcs, list[Cut]]] = []
    for cut in reversed(cuts):
        place = np.array([cut.loop[0].start[:2]])
        mine = next((group for chain, group in found if float(nearest(chain, place)[1][0]) < radius), None)
        if mine is None:
            found.append((arcs_of(cut.loop), [cut]))
        else:
            mine.insert(0, cut)
    return [group for _, group in reversed(found)]


def _area(loop: Arcs) -> float:
    """Area of the polygon through the starts of a closed path's pieces, positive counter-clockwise."""
    x, y = loop.start.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _cutter_check(program: Program, milling: Milling) -> Check:
    """Check the cutter that the program names on top, if it does."""
    named = [float(found[1]) for text in program.comments if (found := _CUTTER.match(text))]
    if not named:
        return Check("cutter", True, None, None, "mm", detail="the program names no cutter")
    diameter = named[0] * program.units_mm
    off, detail = abs(diameter - 2.0 * milling.radius), f"the program names {diameter:.9g} mm across"
    return at_most(
        "cutter", off, 1e-6 * milling.radius, "mm", detail=f"{detail}, {2.0 * milling.radius:.9g} are expected"
    )


def _arcs_check(program: Program) -> Check:
    """Check that the ends of each arc lie equally far from its centre; more than the limit is not read at all."""
    worst = max(program.moves, key=lambda move: move.mismatch)
    return at_most("arcs", worst.mismatch, ARC_MM, "mm", detail=f"line {worst.line}")


def _rapid_check(program: Program, milling: Milling) -> Check:
    """Check that no rapid move goes down into the stock or along it, nor into a hub that stands on it."""
    bad = [f"line {move.line} moves fast into the hub" for move in _into_hub(program, milling) if move.rapid]
    for move in program.moves:
        low = min(move.start[2], move.end[2])
        if move.rapid and low <= 0.0 and (_across(move) or move.end[2] < move.start[2]):
            bad.append(f"line {move.line} moves fast at z = {low:.6g} mm")
    return _counted("rapid", bad)


def _hub_check(program: Program, milling: Milling) -> Check | None:
    """Tell feed moves into a hub that stands on the stock; None where there are none."""
    bad = [move for move in _into_hub(program, milling) if not move.rapid]
    return failed("gouge", f"line {bad[0].line} cuts into the hub", unit="mm") if bad else None


def _into_hub(program: Program, milling: Milling) -> list[Move]:
    """Moves on which the cutter comes to the hub below its top."""
    if milling.hub is None:
        return []
    radius, top = milling.hub
    low = [move for move in program.moves if min(move.start[2], move.end[2]) < top]
    return [move for move in low if _from_shaft(move) < radius + milling.radius]


def _from_shaft(move: Move) -> float:
    """Least distance of a move from the shaft in the plane."""
    if not _across(move) and move.centre is None:
        return float(np.hypot(*move.start[:2]))
    return float(nearest(arcs_of([move]), np.zeros((1, 2)))[1][0])


def _counted(name: str, faults: list[str]) -> Check:
    more = f"; and {len(faults) - MOST_NAMED} more" if len(faults) > MOST_NAMED else ""
    return at_most(name, len(faults), 0, "faults", detail="; ".join(faults[:MOST_NAMED]) + more)


def _depth_check(features: list[list[Cut]], milling: Milling, tolerance: float) -> Check:
    """Check that each contour is cut through, and that no pass goes deeper than it may below the one before.

    Only a path that follows the last one all round, no farther off than the cutter's radius, makes way for it.
    """
    worst, detail = 0.0, ""
    for feature in features:
        line = feature[-1].loop[0].line
        bottom = feature[-1].z
        if abs(bottom + milling.thickness) > tolerance:
            what = (
                f"the last pass, from line {line}, is at z = {bottom:.6g} mm, the part {milling.thickness:.6g} mm thick"
            )
            return failed("depth", what, unit="mm", limit=milling.depth_of_cut)
        reached = 0.0
        for cut in feature:
            step = reached - cut.z
            if step >= worst:
                worst, detail = step, f"from z = {reached:.6g} to {cut.z:.6g} mm, line {cut.loop[0].line}"
            if _follows(arcs_of(cut.loop), arcs_of(feature[-1].loop), milling.radius):
                reached = min(reached, cut.z)
    return at_most("depth", worst, milling.depth_of_cut, "mm", detail=detail, slack=tolerance)


def _follows(loop: Arcs, last: Arcs, radius: float) -> bool:
    """Whether a closed path runs along another, and as often round the middle of it."""
    points = np.concatenate([loop.start, loop.points(0.5 * loop.length)])
    near = nearest(last, points)[1].max() <= radius
    middle = last.start.mean(axis=0)
    return bool(near) and abs(_rounds(loop, middle)) == abs(_rounds(last, middle))


def _rounds(loop: Arcs, middle: Array) -> int:
    """How often a closed path runs round a point, by the starts of its pieces."""
    away = loop.start - middle
    after = np.roll(away, -1, axis=0)
    return round(float(np.arctan2(cross(away, after), dot(away, after)).sum()) / (2.0 * np.pi))


def _direction_check(features: list[list[Cut]], outer: int | None, milling: Milling) -> Check:
    """Check on which side the cutter meets the metal: to climb it goes clockwise round the part, not so in holes."""
    bad = []
    for k, feature in enumerate(features):
        for cut in feature:
            clockwise = _area(arcs_of(cut.loop)) < 0.0
            if clockwise != (milling.climb == (k == outer)):
                bad.append(f"the path from line {cut.loop[0].line} runs the wrong way round")
    return _counted("direction", bad)


def _entry_check(features: list[list[Cut]]) -> Check:
    """Check that the cutter comes to each path and leaves it along its tangent, so that it leaves no mark."""
    worst, detail = 0.0, ""
    for cut in (cut for feature in features for cut in feature):
        loop = arcs_of(cut.loop)
        pairs = []
        if cut.entry:
            pairs.append((arcs_of(cut.entry).end_tangents[-1], loop.tangent[0], cut.entry[-1].line))
        if cut.exit:
            pairs.append((loop.end_tangents[-1], arcs_of(cut.exit).tangent[0], cut.exit[0].line))
        for before, after, line in pairs:
            kink = abs(float(np.degrees(np.arctan2(cross(before, after), dot(before, after)))))
            if kink > worst:
                worst, detail = kink, f"line {line}"
    return at_most("entry", worst, KINK, "deg", detail=detail)


def _gouge_check(
    features: list[list[Cut]], edges: list[Contour], outer: int | None, milling: Milling, tolerance: float
) -> Check:
    """Check that on all its ways below the top the cutter keeps clear of the edge that it is to leave."""
    worst, detail = -np.inf, ""
    for k, (feature, edge) in enumerate(zip(features, edges, strict=True)):
        chain, side = edge.as_arcs()[0], 1.0 if k == outer else -1.0
        seen = {_trace(move) for move in feature[-1].loop}  # of these the edge itself is made
        for cut in feature:
            for moves in (cut.entry, cut.loop, cut.exit):
                fresh = [move for move in moves if _trace(move) not in seen]
                if not fresh:
                    continue
                seen |= {_trace(move) for move in fresh}
                near, place = _least(arcs_of(fresh), chain, side, milling.radius, tolerance)
                if milling.radius - near > worst:
                    worst = milling.radius - near
                    detail = f"the path from line {fresh[0].line} near {place_text(place[0], place[1])}"
    return at_most("gouge", max(worst, 0.0), tolerance, "mm", detail=detail if worst > tolerance else "")


def _trace(move: Move) -> tuple[object, ...]:
    return (*move.start[:2], *move.end[:2], move.centre, move.sweep > 0.0)


def _least(arcs: Arcs, chain: Arcs, side: float, radius: float, tolerance: float) -> tuple[float, Array]:
    """Least distance of a path outside (side 1) or inside (-1) a chain, and where; sharp below the radius.

    A path that keeps clear of the chain is measured piece against piece, in closed form: one that runs beside it would
    have to be halved without end. Of one that meets it the depth is found within a hundredth.
    """
    arcs, chain = _bent_little(arcs), _bent_little(chain)
    middle = arcs.points(0.5 * arcs.length)
    distance = side * signed_distance(chain, middle)
    low = int(np.argmin(distance))
    best, place = float(distance[low]), middle[low]
    near = distance - 0.5 * arcs.length < min(best, radius)
    if best <= 0.0:
        return _deepest(arcs.take(near), chain, side, radius, tolerance)
    beside, where = _beside(arcs.take(near), chain, min(best, radius)) if near.any() else (np.inf, place)
    if beside == 0.0:
        return _deepest(arcs.take(near), chain, side, radius, tolerance)
    return (beside, where) if beside < best else (best, place)


def _bent_little(arcs: Arcs) -> Arcs:
    """The same pieces, cut so that none turns by more than a quarter of a turn."""
    turn = np.abs(arcs.curvature) * arcs.length
    return arcs.cut(np.maximum(np.ceil(turn / (0.5 * np.pi)), 1.0).astype(np.intp))[0]


def _beside(arcs: Arcs, chain: Arcs, reach: float) -> tuple[float, Array]:
    """Least distance below `reach` of pieces from a chain, and where; infinite without any."""
    grown = [(low - reach, high + reach) for low, high in boxes(arcs)]
    best, place = np.inf, arcs.start[0]
    for i, j in overlapping(grown, boxes(chain), mirrored=False):
        one, other = arcs.take(i), chain.take(j)
        away = one.points(0.5 * one.length) - other.points(0.5 * other.length)
        near = np.hypot(away[:, 0], away[:, 1]) - 0.5 * (one.length + other.length) < min(best, reach)
        if near.any():
            found = gaps(one.take(near), other.take(near))
            k = int(np.argmin(found.distance))
            if found.distance[k] < best:
                best, place = float(found.distance[k]), found.first[k]
    return best, place


def _deepest(arcs: Arcs, chain: Arcs, side: float, radius: float, tolerance: float) -> tuple[float, Array]:
    """Least distance of a path that meets the chain or lies beyond it, and where.

    A piece no point of which can come nearer than the nearest found, or than the radius, by a hundredth of the
    tolerance or of the depth needs no closer look. Where some still do after all looks, the least is what they cannot
    come below.
    """
    best, place, floor = np.inf, arcs.start[0], np.inf
    for _ in range(LOOKS):
        middle = arcs.points(0.5 * arcs.length)
        distance = side * signed_distance(chain, middle)
        low = int(np.argmin(distance))
        if distance[low] < best:
            best, place = float(distance[low]), middle[low]
        bound = distance - 0.5 * arcs.length
        near = bound < min(best, radius) - 0.01 * max(tolerance, radius - best)
        if not near.any():
            return best, place
        floor = float(bound.min())
        arcs = arcs.take(near)
        arcs, _ = arcs.cut(np.full(len(arcs), 2, dtype=np.intp))
    return min(best, floor), place
