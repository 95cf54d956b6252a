"""A milling program divided into cuts, the features that they mill together, and the edges of these.

A cut is the moves of the cutter between coming down and going up again: an arc of entry, a closed path, an arc of exit.
The deepest path of each contour makes its edge; the path that holds all others is milled from outside, the others make
holes. Of stock that comes with its outline all make holes. The paths round the shaft that lie side by side clear a
pocket between two surfaces: the innermost makes one of its edges, the outermost the other.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import cross, dot
from kin.contour.nearest import nearest
from kin.contour.offset import TightError, parallel
from kin.numeric.places import place_text
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.gcode import arcs_of
from kin.read.nesting import counter_clockwise

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kin.contour.arcs import Arcs
    from kin.contour.contour import Contour
    from kin.judge.intent import Milling
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array
    from kin.read.gcode import Program, ToolMove

    Key = frozenset[tuple[object, ...]]

FINE = 0.05  # of the tolerance, within which joints of the path may be snapped together


@dataclass(frozen=True, eq=False)
class Cut:
    """Moves at one height z, mm, below 0: on the way to the closed path, round it, and away from it."""

    z: float
    entry: list[ToolMove]
    loop: list[ToolMove]
    exit: list[ToolMove]

    @cached_property
    def path(self) -> Arcs:
        """Closed path of the cutter's centre in the plane, mm."""
        return arcs_of(self.loop)

    @cached_property
    def area(self) -> float:
        """Area of the closed path, mm^2, positive counter-clockwise: of the polygon, and between arcs and chords."""
        (x, y), bend = self.path.start.T, self.path.curvature
        turn, square = bend * self.path.length, np.where(bend == 0.0, 1.0, bend**2)
        beside = np.where(bend == 0.0, 0.0, (turn - np.sin(turn)) / square)
        return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1) + beside))

    @cached_property
    def key(self) -> Key:
        """Key of the closed path: the same at every height and from every starting point."""
        return frozenset(map(trace, self.loop))


class CutEdge(NamedTuple):
    """Edge that a closed path cuts: the contour, its side on which the metal lies (1 inside, -1 outside), the path."""

    contour: Contour
    side: Side
    cut: Cut


class Feature(NamedTuple):
    """Cuts in the program's order, the depth, mm, intended for them, and the edges that they leave.

    The depth is above 0. There is one edge, or of a pocket both: the inner, then the outer.
    """

    cuts: list[Cut]
    depth: float
    edges: tuple[CutEdge, ...]


def cuts_of(program: Program) -> Iterator[Cut]:
    """Cuts of a program: the moves at depth between plunge and retract, one `Cut` each time the cutter is down.

    Raises ReadError for a cut along a slope, a plunge without a cut, and a path that does not close.
    """
    down: list[ToolMove] = []
    plunge: ToolMove | None = None
    for move in (*program.moves, None):  # None ends the last cut
        if move is not None and not move.rapid and move.start[2] == move.end[2] < 0.0:
            if move.start != move.end or move.centre is not None:
                down.append(move)
            continue
        if move is not None and not move.rapid and min(move.start[2], move.end[2]) < 0.0 and across(move):
            raise _unread(program, move, "cuts along a slope")
        if down:
            yield _cut(program, down)
        elif plunge is not None:
            raise _unread(program, plunge, "goes down where nothing is cut")
        down, plunge = [], None
        if move is not None and not move.rapid and min(move.start[2], move.end[2]) < 0.0:
            plunge = move if move.end[2] < move.start[2] else None


def across(move: ToolMove) -> bool:
    """Whether a move ends at another x or y than it starts at."""
    return move.start[:2] != move.end[:2]


def trace(move: ToolMove) -> tuple[object, ...]:
    """Key of a move's path in the plane, whatever its height: ends, centre, whether it turns counter-clockwise."""
    return (*move.start[:2], *move.end[:2], move.centre, move.sweep > 0.0)


def _unread(program: Program, move: ToolMove, what: str) -> ReadError:
    return ReadError("unsupported", f"line {move.line} {what}, which is not read", program.path)


def _cut(program: Program, down: list[ToolMove]) -> Cut:
    """Divide a path into entry, its closed part of the most moves, and exit; raises ReadError where no part closes."""
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


def features_of(program: Program, cuts: list[Cut], milling: Milling, tolerance: float) -> Iterator[Feature]:
    """Features that the cuts mill, each with its cuts in order; a pocket comes first.

    Joints of paths may be snapped within a share of `tolerance`, mm. Raises ReadError for a path that leaves no edge.
    """

    def edge(cut: Cut, side: Side) -> CutEdge:
        to_left = side if cut.area > 0.0 else -side  # 1 where the edge lies on the left of the path, else -1
        try:
            contour = parallel(cut.path, to_left * milling.radius, FINE * tolerance)
        except TightError as error:
            raise ReadError("open", f"the cutter's path from line {cut.loop[0].line}: {error}", program.path) from error
        return CutEdge(counter_clockwise(contour), side, cut)

    if milling.pocket is not None:
        beside, cuts = _side_by_side(cuts, milling.radius)
        if beside:
            floor = at_the_floor(beside, tolerance)
            yield Feature(beside, milling.pocket, (edge(floor[0], 1), edge(floor[-1], -1)))
    features = _about_one_contour(cuts, milling.radius)
    last = [feature[-1] for feature in features]
    outer = int(np.argmax([abs(cut.area) for cut in last])) if milling.outline else None
    for k, feature in enumerate(features):
        yield Feature(feature, milling.thickness, (edge(last[k], 1 if k == outer else -1),))


def _side_by_side(cuts: list[Cut], radius: float) -> tuple[list[Cut], list[Cut]]:
    """Cuts round the shaft from the outermost inward, as far as the swept areas overlap; and all other cuts.

    Two overlap where the inner path starts within the cutter's diameter of the outer one.
    """
    paths = {cut.key: cut for cut in cuts}
    round_shaft = [cut for cut in paths.values() if rounds(cut.path, np.zeros(2))]
    falling = sorted(round_shaft, key=lambda cut: -abs(cut.area))
    beside = {cut.key for cut in falling[:1]}
    for outside, inside in pairwise(falling):
        if not nearest(outside.path, inside.path.start[:1])[1][0] <= 2.0 * radius:
            break
        beside.add(inside.key)
    return [cut for cut in cuts if cut.key in beside], [cut for cut in cuts if cut.key not in beside]


def at_the_floor(cuts: list[Cut], tolerance: float) -> list[Cut]:
    """Cuts of a pocket at its full depth, within `tolerance`, mm, one for each path, from within outward."""
    bottom = min(cut.z for cut in cuts)
    paths = {cut.key: cut for cut in cuts if cut.z <= bottom + tolerance}
    return sorted(paths.values(), key=lambda cut: abs(cut.area))


def _about_one_contour(cuts: list[Cut], radius: float) -> list[list[Cut]]:
    """Cuts about the same contour together, in the program's order.

    A cut is about the contour of a later one where its path starts less than the radius from the path of the last.
    """
    outlines: list[tuple[Arcs, list[Cut]]] = []
    for cut in reversed(cuts):
        place = np.array([cut.loop[0].start[:2]])
        alike = next((group for chain, group in outlines if float(nearest(chain, place)[1][0]) < radius), None)
        if alike is None:
            outlines.append((cut.path, [cut]))
        else:
            alike.insert(0, cut)
    return [group for _, group in reversed(outlines)]


def rounds(loop: Arcs, middle: Array) -> int:
    """Winding number of a closed path about a point (2,), from the starts of its pieces; counter-clockwise above 0."""
    away = loop.start - middle
    after = np.roll(away, -1, axis=0)
    return round(float(np.arctan2(cross(away, after), dot(away, after)).sum()) / (2.0 * np.pi))
