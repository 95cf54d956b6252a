"""Contours that a milling program leaves of the stock, its closed paths moved by the cutter's radius, and its faults.

z is 0 at the top of the stock and falls into it. `kin.judge.cuts` divides a program into cuts.
"""

from __future__ import annotations

import re
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import cross, dot, left
from kin.contour.least_distance import least_distance
from kin.contour.nearest import nearest, signed_distance
from kin.judge.cuts import across, at_the_floor, cuts_of, features_of, rounds, trace
from kin.numeric.check import Check, at_most, failed
from kin.numeric.lengths import UNIT, file_place_words, length_words
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.gcode import ARC_MM, arcs_of
from kin.read.nesting import ClosedContour, Nest

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.judge.cuts import CutEdge, Feature, Key
    from kin.judge.intent import Milling
    from kin.read.gcode import Program, ToolMove

STEP = 0.05  # of the cutter's radius: places at which two paths side by side are looked at
KINK = 0.5  # degrees between the ways in and out and the path: what rounding makes of a tangent on a small part
MOST_NAMED = 3
_CUTTER = re.compile(r"^cutter: diameter ([0-9.]+)")


@dataclass(frozen=True, eq=False)
class Milled(Nest):
    """Contours that a milling program leaves, mm, by falling area, a milled outline first; `checks` of the program."""

    checks: tuple[Check, ...]


def milled(program: Program, milling: Milling, tolerance: float) -> Milled:
    """Contours that a milling program leaves, by simulating it, and checks of the program itself.

    Joints of paths may be off by a share of `tolerance`, mm. Raises ReadError where no closed contour is left.
    """
    cuts = list(cuts_of(program))
    if not cuts:
        raise ReadError("empty", "the program cuts nothing below the top of the stock", program.path)
    features = list(features_of(program, cuts, milling, tolerance))
    edges = [edge for feature in features for edge in feature.edges]
    chains = [ClosedContour(edge.contour, pieces=len(edge.cut.loop)) for edge in edges]
    falling = sorted(range(len(chains)), key=lambda k: (not _is_outline(edges[k], milling), -edges[k].contour.area))
    checks = (
        _cutter_check(program, milling),
        _arcs_check(program),
        _rapid_check(program, milling),
        _depth_check(features, milling, tolerance),
        *(() if milling.pocket is None else (_floor_check(features, milling.radius, tolerance),)),
        _direction_check(features, milling),
        _entry_check(features),
        _hub_check(program, milling) or _gouge_check(features, milling, tolerance),
    )
    return Milled(tuple(chains[k] for k in falling), checks)


def _is_outline(edge: CutEdge, milling: Milling) -> bool:
    """Whether an edge is the outline of the part."""
    return milling.outline and edge.side > 0


def _cutter_check(program: Program, milling: Milling) -> Check:
    """Check the diameter of the cutter that the program names at its head, if it names one."""
    named = [float(tool[1]) for text in program.comments if (tool := _CUTTER.match(text))]
    if not named:
        return Check("cutter", True, None, None, "mm", detail="the program names no cutter")
    diameter = named[0] * program.units_mm
    expected = 2.0 * milling.radius
    named_so = f"the program names {length_words(diameter, '.9g')} {UNIT} across"
    detail = f"{named_so}, {length_words(expected, '.9g')} are expected"
    return at_most("cutter", abs(diameter - expected), 1e-6 * milling.radius, "mm", detail=detail)


def _arcs_check(program: Program) -> Check:
    """Check that the ends of each arc lie equally far from its centre; more than the limit is not read at all."""
    worst = max(program.moves, key=lambda move: move.mismatch)
    return at_most("arcs", worst.mismatch, ARC_MM, "mm", detail=f"line {worst.line}")


def _rapid_check(program: Program, milling: Milling) -> Check:
    """Check that no rapid move goes down into the stock or along it, nor into a hub that stands on it."""
    bad = [f"line {move.line} moves fast into the hub" for move in _into_hub(program, milling) if move.rapid]
    for move in program.moves:
        low = min(move.start[2], move.end[2])
        if move.rapid and low <= 0.0 and (across(move) or move.end[2] < move.start[2]):
            bad.append(f"line {move.line} moves fast at z = {length_words(low)} {UNIT}")
    return _count_check("rapid", bad)


def _hub_check(program: Program, milling: Milling) -> Check | None:
    """A failed check for feed moves into a hub that stands on the stock; None without such moves."""
    bad = [move for move in _into_hub(program, milling) if not move.rapid]
    return failed("gouge", f"line {bad[0].line} cuts into the hub", unit="mm") if bad else None


def _into_hub(program: Program, milling: Milling) -> list[ToolMove]:
    """Moves on which the cutter comes to the hub below its top."""
    if milling.hub is None:
        return []
    radius, top = milling.hub
    low = [move for move in program.moves if min(move.start[2], move.end[2]) < top]
    return [move for move in low if _from_shaft(move) < radius + milling.radius]


def _from_shaft(move: ToolMove) -> float:
    """Least distance, mm, of a move from the shaft in the plane."""
    if not across(move) and move.centre is None:
        return float(np.hypot(*move.start[:2]))
    return float(nearest(arcs_of([move]), np.zeros((1, 2)))[1][0])


def _count_check(name: str, faults: list[str]) -> Check:
    more = f"; and {len(faults) - MOST_NAMED} more" if len(faults) > MOST_NAMED else ""
    return at_most(name, len(faults), 0, "faults", detail="; ".join(faults[:MOST_NAMED]) + more)


def _depth_check(features: list[Feature], milling: Milling, tolerance: float) -> Check:
    """Check that each contour has its depth, and that no pass goes too far below the passes before it.

    Only an earlier path that runs along a pass all round, within the cutter's radius, clears the way for it.
    """
    worst, detail = 0.0, ""
    for cuts, depth, _ in features:
        cut = min(cuts, key=lambda cut: cut.z) if milling.pocket == depth else cuts[-1]
        if abs(cut.z + depth) > tolerance:
            expected = f"the groove is to be {length_words(depth)} {UNIT} deep" if milling.pocket == depth else ""
            what = f"the last pass, from line {cut.loop[0].line}, is at z = {length_words(cut.z)} {UNIT}, "
            what += expected or f"the part {length_words(depth)} {UNIT} thick"
            return failed("depth", what, unit="mm", limit=milling.depth_of_cut)
        reached: dict[Key, tuple[Arcs, float]] = {}
        along: dict[tuple[Key, Key], bool] = {}
        for cut in cuts:
            key, loop = cut.key, cut.path
            before = 0.0
            for other, (path, z) in reached.items():
                if (other, key) not in along:
                    along[other, key] = other == key or _follows(path, loop, milling.radius)
                before = min(before, z) if along[other, key] else before
            step = before - cut.z
            if step >= worst:
                worst, detail = (
                    step,
                    f"from z = {length_words(before)} to {length_words(cut.z)} {UNIT}, line {cut.loop[0].line}",
                )
            reached[key] = loop, min(cut.z, reached[key][1] if key in reached else 0.0)
    return at_most("depth", worst, milling.depth_of_cut, "mm", detail=detail, slack=tolerance)


def _floor_check(features: list[Feature], radius: float, tolerance: float) -> Check:
    """Check that no metal stands on the floor of a pocket between two paths side by side.

    The outer path clears down to one radius inside it. Places on that edge must lie inside the inner path or within the
    radius outside it; between two neighbouring places the edge strays by no more than their distance.
    """
    worst, detail = 0.0, ""
    for feature in (feature for feature in features if len(feature.edges) > 1):
        for inside, outside in pairwise(at_the_floor(feature.cuts, tolerance)):
            path = outside.path
            parts, _ = path.cut(np.ceil(path.length / (STEP * radius)).astype(np.intp))
            inward = radius if outside.area > 0.0 else -radius
            edge = parts.start + inward * left(parts.tangent)
            apart = float(np.hypot(*(np.roll(edge, -1, axis=0) - edge).T).max())
            without = float(np.copysign(1.0, inside.area)) * signed_distance(inside.path, edge)
            stands = float(without.max()) + apart - radius
            if stands > worst:
                lines = f"from lines {inside.loop[0].line} and {outside.loop[0].line}"
                worst, detail = stands, f"metal may stand between the paths {lines}"
    return at_most("floor", worst, 0.0, "mm", detail=detail)


def _follows(loop: Arcs, last: Arcs, radius: float) -> bool:
    """Whether a closed path runs along another within a radius, and as many times round its middle."""
    points = np.concatenate([loop.start, loop.points(0.5 * loop.length)])
    near = nearest(last, points)[1].max() <= radius
    middle = last.start.mean(axis=0)
    return bool(near) and abs(rounds(loop, middle)) == abs(rounds(last, middle))


def _direction_check(features: list[Feature], milling: Milling) -> Check:
    """Check the sense of the paths: to climb, the cutter goes clockwise round metal and counter-clockwise inside it.

    In a pocket the paths along its edges count; a path that makes both edges counts for the metal inside.
    """
    bad, directions = [], set[int]()
    for cuts, _, edges in features:
        for edge in edges:
            for cut in cuts:
                if (len(edges) > 1 and cut.key != edge.cut.key) or cut.loop[0].line in directions:
                    continue
                directions.add(cut.loop[0].line)
                clockwise = cut.area < 0.0
                if clockwise != (milling.climb == (edge.side > 0)):
                    bad.append(f"the path from line {cut.loop[0].line} runs the wrong way round")
    return _count_check("direction", bad)


def _entry_check(features: list[Feature]) -> Check:
    """Check that the cutter comes to each path and leaves it along its tangent, so that it leaves no mark."""
    worst, detail = 0.0, ""
    for cut in (cut for feature in features for cut in feature.cuts):
        loop = cut.path
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


def _gouge_check(features: list[Feature], milling: Milling, tolerance: float) -> Check:
    """Check that on all its ways below the top the cutter keeps clear of the edges that it is to leave."""
    worst, detail = -np.inf, ""
    for cuts, edge in ((feature.cuts, edge) for feature in features for edge in feature.edges):
        chain = edge.contour.as_arcs()[0]
        known = {trace(move) for move in edge.cut.loop}  # of these the edge itself is made
        for cut in cuts:
            for moves in (cut.entry, cut.loop, cut.exit):
                fresh = [move for move in moves if trace(move) not in known]
                if not fresh:
                    continue
                known |= {trace(move) for move in fresh}
                near, place = least_distance(arcs_of(fresh), chain, float(edge.side), milling.radius, tolerance)
                if milling.radius - near > worst:
                    worst = milling.radius - near
                    detail = f"the path from line {fresh[0].line} near {file_place_words(*place)}"
    return at_most("gouge", max(worst, 0.0), tolerance, "mm", detail=detail if worst > tolerance else "")
