"""What a drawing gives to cut, whatever its format: shapes joined into closed contours, the outer one and its holes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from kin.contour.bezier import Beziers
from kin.contour.contour import Contour
from kin.contour.intersections import first_meeting
from kin.contour.pieces import ARC, Pieces
from kin.numeric.records import dataclass, replace
from kin.read.drawing.chaining import GAP, GAP_SHARE, ROUNDING, SAME_POINT, SAME_SHARE, close_pairs, loops
from kin.read.errors import ReadError
from kin.read.nesting import ClosedContour, Nest, counter_clockwise, demand_few, demand_few_pieces, met, nested

if TYPE_CHECKING:
    from collections import Counter
    from pathlib import Path

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices, Mask
    from kin.read.drawing.shapes import Shape
    from kin.read.formats import DrawingOptions

CUT, BORE = "CUT", "BORE"
# Layers that are cut beside CUT: the bore's, holes, a mark that is cut through, the flanks of a groove.
BESIDE = frozenset({BORE, "HOLES", "MARK", "GROOVE_INNER", "GROOVE_OUTER"})
# What is engraved stands here, read if it is asked for.
ENGRAVED = "ENGRAVE"
# A gap is bridged that is as wide as its ends say.
WIDER = 1.0 + 1e-9
# Layers that are never cut: our own reference geometry and cutter's path, and AutoCAD's definition points.
REFERENCE = frozenset({"REFERENCE", "TOOLPATH", "DEFPOINTS"})


class Fault(NamedTuple):
    """Something that should not be in a drawing for a machine, though a contour could be read, and its place, mm.

    kind: "zero-length" (left out), "duplicate" (of another entity; left out), "overlap" (only some of its pieces are
    drawn twice; it stays), "short" (no longer than the gap that the caller permits; it stays).
    """

    kind: str
    entity: str
    layer: str
    x: float
    y: float


class Aside(NamedTuple):
    """Entities of one type, `kind`, on one layer that were not read as contour, and how many there are."""

    layer: str
    kind: str
    number: int


@dataclass(frozen=True, eq=False)
class Drawing(Nest):
    """Contours that a DXF or SVG file gives to cut, mm (drawing units if it states none), and facts about the file.

    chains          every closed chain to cut
    units_mm        mm in a drawing unit, by $INSUNITS or a comment on top, or by an SVG's width and viewBox; None if
                    the file states none
    turned          the outer contour was drawn clockwise, and was turned round
    widest_gap      widest gap between entities joined to the outer contour, mm
    layers          layers that the contour and the holes were taken from
    aside           what was not read: reference geometry, text, other layers
    faults          zero-length, duplicate and overlapping entities
    short           pieces no longer than the gap that the caller permits; empty where the caller states no gap
    openings        messages on ends that do not meet, where a contour could be read all the same
    version         of DXF, such as "AC1024", or "SVG" or "STEP"
    engraved        closed chains on the layer ENGRAVE, counter-clockwise, if the caller wants them
    """

    units_mm: float | None
    turned: bool
    widest_gap: float
    layers: tuple[str, ...]
    aside: tuple[Aside, ...]
    faults: tuple[Fault, ...]
    version: str
    engraved: tuple[Contour, ...] = ()
    short: tuple[Fault, ...] = ()
    openings: tuple[str, ...] = ()


class CutEntities(NamedTuple):
    """Entities that are read, with their shapes, names and layers, and counts of the others by layer and type."""

    shapes: list[Shape]
    names: list[str]
    layers: list[str]
    aside: Counter[tuple[str, str]]


def drawing_of(
    curves: CutEntities,
    marks: CutEntities | None,
    unit: float | None,
    path: Path,
    options: DrawingOptions,
    *,
    version: str,
) -> Drawing:
    """Join the entities to cut, `curves`, and to engrave, `marks`, to the contours of a drawing, mm.

    They are in units of `unit` mm; without a unit the drawing stays in theirs. Heights may differ by as much as the
    default gap. Gaps up to `options.bridged` and open chains within the contour are reported among `openings`; without
    `bridged` they raise. Raises ReadError for entities of no length alone, too many pieces, more than one plane, and
    what is not one closed contour with holes.
    """
    gap, bridged = options.gap, options.bridged
    scale = 1.0 if unit is None else unit
    if unit is None:
        gap, bridged = None if gap is None else gap / options.unstated, bridged / options.unstated
    # pieces in mm, and the distances within which ends are one or are joined
    pieces, run = gathered(curves.shapes)
    demand_few_pieces(len(run), path)
    pieces = pieces.enlarged(scale) if scale != 1.0 else pieces
    same, usual = closeness(pieces)
    demanded, gap = gap, usual if gap is None else gap
    scratched: tuple[Contour, ...] = ()
    if marks is not None and marks.shapes:
        lines, owner = gathered(marks.shapes)
        lines = lines.enlarged(scale) if scale != 1.0 else lines
        scratched = tuple(counter_clockwise(c.contour) for c in chain(lines, owner, (gap, usual, same), path))
    demand_one_plane(np.concatenate([s.heights for s in curves.shapes]) * scale, usual, path)
    # pieces of no length and pieces drawn twice are left out, the rest is joined and nested
    keep, faults = without_faults(pieces, run, curves, same, path)
    if not keep.any():
        raise ReadError("empty", "all entities to cut are of zero length", path)
    short = np.flatnonzero(keep & (reach(pieces) <= gap)) if demanded is not None else ()
    shorter = tuple(fault("short", pieces, int(k), run, curves) for k in short)
    chained, openings = chain_most(pieces.take(keep), run[keep], (gap, usual, same), path, bridged)
    meeting = first_meeting([c.contour for c in chained])
    if meeting:
        raise met(meeting, path)
    order = nested([c.contour for c in chained], path, options.deepest)
    outer = chained[order[0].number]
    return Drawing(
        chains=tuple(
            ClosedContour(
                counter_clockwise(ring.contour),
                depth,
                inside,
                curves.layers[ring.entities[0]],
                ring.spans(curves.shapes),
                ring.gap if ring.gap > usual else 0.0,
            )
            for ring, depth, inside in ((chained[k], depth, inside) for k, depth, inside in order)
        ),
        units_mm=unit,
        turned=outer.contour.area < 0.0,
        widest_gap=outer.gap,
        layers=tuple(sorted(set(curves.layers))),
        aside=tuple(Aside(*key, count) for key, count in sorted(curves.aside.items())),
        faults=tuple(faults),
        version=version,
        engraved=scratched,
        short=shorter,
        openings=openings,
    )


def gathered(shapes: list[Shape]) -> tuple[Pieces, Indices]:
    """Pieces of all the shapes, in order, and the index of the shape that each piece belongs to (n,), rising."""
    numbers = np.arange(len(shapes))
    chords, arcs = np.concatenate([s.chords for s in shapes]), np.concatenate([s.arcs for s in shapes])
    unrolled = Beziers.joined([s.beziers for s in shapes]).unrolled()
    run = np.concatenate(
        [
            np.repeat(numbers, [len(s.chords) for s in shapes]),
            np.repeat(numbers, [len(s.arcs) for s in shapes]),
            np.repeat(numbers, [s.beziers.count for s in shapes])[unrolled.row],
        ]
    )
    parts = [
        Pieces.from_chords(chords[:, :2], chords[:, 2:4], chords[:, 4]),
        Pieces.from_arcs(arcs[:, :2], arcs[:, 2], arcs[:, 3], arcs[:, 4]),
        Pieces.from_unrolled(unrolled.pieces),
    ]
    pieces = Pieces.joined([p for p in parts if len(p)])
    order = np.argsort(run, kind="stable")
    return (pieces, run) if (np.diff(run) >= 0).all() else (pieces.take(order), run[order])


def closeness(pieces: Pieces) -> tuple[float, float]:
    """Two distances, mm: within the first points are one, within the second ends are joined by default."""
    size = extent(pieces)
    same = max(min(SAME_POINT, SAME_SHARE * size), ROUNDING * float(np.abs(pieces.start).max()))
    return same, max(min(GAP, GAP_SHARE * size), same)


def demand_one_plane(heights: Array, most: float, path: Path) -> None:
    """Raise ReadError where heights (n,) differ by more than `most`, in the same unit."""
    if np.ptp(heights) > most:
        message = f"the entities do not lie in one plane: heights from {heights.min():g} to {heights.max():g}"
        raise ReadError("unsupported", message, path)


def extent(pieces: Pieces) -> float:
    """Greater side, mm, of a box round the ends and middles of the pieces: about the size of a drawing, never more."""
    every = np.arange(len(pieces))
    points = [pieces.start, pieces.end, pieces.points(every, np.full(every.size, 0.5))]
    return float(np.ptp(np.concatenate(points), axis=0).max())


def without_faults(
    pieces: Pieces, run: Indices, curves: CutEntities, same: float, path: Path
) -> tuple[NDArray[np.bool_], list[Fault]]:
    """Which pieces (n,) to keep, and the faults: pieces of no length, and pieces drawn twice, whichever way round.

    `run` (n,) is the entity of each piece. Pieces no longer than `same`, mm, have no length; pieces whose ends and
    middles agree to `same` are drawn twice. An entity is left out if all its pieces are drawn before it, and stays if
    only some are. Raises ReadError where very many pieces are drawn over one another.
    """
    keep = reach(pieces) > same
    faults = [fault("zero-length", pieces, int(k), run, curves) for k in np.flatnonzero(~keep)]
    kept = np.flatnonzero(keep)
    middle = pieces.points(kept, np.full(kept.size, 0.5))
    start, end = pieces.start[kept], pieces.end[kept]
    chord = end - start
    size = np.maximum(np.hypot(chord[:, 0], chord[:, 1]), same)
    # The same whichever way the piece is run through: middle of the chord, of the piece, and the direction doubled.
    doubled = np.stack([chord[:, 0] ** 2 - chord[:, 1] ** 2, 2.0 * chord[:, 0] * chord[:, 1]], axis=1) / size[:, None]
    first, second = close_pairs(np.column_stack([(start + end) / 2.0, middle, doubled]), same, path)
    again = np.zeros(len(pieces), dtype=bool)
    again[kept[np.maximum(first, second)]] = True
    if not again.any():
        return keep, faults
    count = len(curves.names)
    whole = np.bincount(run[keep & ~again], minlength=count) == 0
    for k in np.flatnonzero(np.bincount(run[again], minlength=count)):
        place = int(np.flatnonzero(again & (run == k))[0])
        faults.append(fault("duplicate" if whole[k] else "overlap", pieces, place, run, curves))
    return keep & ~whole[run], faults


def fault(kind: str, pieces: Pieces, piece: int, run: Indices, curves: CutEntities) -> Fault:
    """Return a Fault at the start of the piece numbered `piece`; `run` (n,) is the entity of each piece."""
    x, y = pieces.start[piece].tolist()
    return Fault(kind, curves.names[run[piece]], curves.layers[run[piece]], x, y)


def reach(pieces: Pieces) -> Array:
    """Size of each piece, mm (n,): chord, length of an arc, or side of a curve's box.

    It is never less than a third of the piece's length.
    """
    size = np.hypot(*(pieces.end - pieces.start).T)
    size = np.where(pieces.kind == ARC, pieces.radius * np.abs(pieces.sweep), size)
    bow = pieces.curve >= 0
    if bow.any():
        size[bow] = np.ptp(pieces.beziers.control, axis=1).max(axis=1)[pieces.curve[bow]]
    return size


class Chained(NamedTuple):
    """A closed contour, the numbers of the entities it is made of (k,), and the widest gap between them, mm."""

    contour: Contour
    entities: Indices
    gap: float

    def spans(self, shapes: list[Shape]) -> int:
        """Number of pieces as the file counts them."""
        return sum(shapes[k].spans for k in self.entities)


Closeness: TypeAlias = tuple[float, float, float]
"""Gap within which ends are joined, that beyond which a line joins them, distance of points that are one, mm."""


def chain_most(
    pieces: Pieces, run: Indices, near: Closeness, path: Path, bridged: float
) -> tuple[list[Chained], tuple[str, ...]]:
    """Contours out of pieces whose runs (n,), rising, are joined end to end, and messages on what is open.

    With `bridged` above 0, mm, gaps up to it are joined too, and chains that stay open are left out. Raises ReadError
    for an open chain without it, an open outermost contour, and more than two ends that meet.
    """
    gap, usual, same = near
    # the gap grows to the widest opening met until all is closed; beyond `bridged`, open chains are left out
    width, opened = 0.0, None
    while True:
        some = width > bridged
        close = (gap if opened is None else max(gap, WIDER * min(width, bridged)), usual, same)
        try:
            chained = chain(pieces, run, close, path, some=some)
        except ReadError as error:
            opened = error if opened is None else opened
            if some or not bridged or error.width is None or not error.width > width:
                raise opened from None
            width = error.width
        else:
            return chained, () if opened is None else (opened.message,)


def chain(pieces: Pieces, run: Indices, near: Closeness, path: Path, *, some: bool = False) -> list[Chained]:
    """Contours out of pieces whose runs (n,), rising, are joined end to end.

    With `some` open chains are left out, where a contour goes round them. Raises ReadError: "branch" where more than
    two ends meet, "gap" or "open" where an end finds no partner or the outermost contour is open, "range" for too many
    contours.
    """
    gap, usual, same = near
    # first piece and number of pieces of each run
    first = np.flatnonzero(np.diff(run, prepend=-1))
    count = np.diff(first, append=len(run))
    made = []
    rings = loops(pieces.start[first], pieces.end[first + count - 1], gap, same, path, some=some)
    demand_few(len(rings), path)
    closed = np.concatenate([np.empty(0, dtype=np.intp), *(loop.runs for loop in rings)])
    if some and not outermost_closed(pieces, np.isin(np.cumsum(np.diff(run, prepend=-1) > 0) - 1, closed)):
        raise ReadError("open", "the outermost contour is open", path)
    # pieces of each loop in order, those of runs taken backwards from last to first and turned round
    for loop in rings:
        many, back = count[loop.runs], loop.backwards
        owner = np.repeat(np.arange(len(many)), many)
        step = np.arange(len(owner)) - np.repeat(np.cumsum(many) - many, many)
        step = np.where(back[owner], many[owner] - 1 - step, step)
        ordered = pieces.take(first[loop.runs][owner] + step).turned_round(back[owner])
        contour = Contour.from_pieces(with_lines(closed_up(ordered, same), usual))
        made.append(Chained(contour, run[first[loop.runs]], loop.gap))
    return made


def outermost_closed(pieces: Pieces, closed: Mask) -> bool:
    """Whether the pieces of closed loops, marked in `closed` (n,), reach farther than all others on every side."""
    if not closed.any() or closed.all():
        return bool(closed.any())
    every = np.arange(len(pieces))
    points = np.stack([pieces.start, pieces.end, pieces.points(every, np.full(every.size, 0.5))])
    inner, outer = points[:, ~closed].reshape(-1, 2), points[:, closed].reshape(-1, 2)
    return bool((outer.min(axis=0) < inner.min(axis=0)).all() and (outer.max(axis=0) > inner.max(axis=0)).all())


def with_lines(pieces: Pieces, usual: float) -> Pieces:
    """Return the pieces of a loop with a line wherever an end lies farther than `usual`, mm, from the next start."""
    following = np.roll(pieces.start, -1, axis=0)
    apart = np.flatnonzero(np.hypot(*(following - pieces.end).T) > usual)
    if not apart.size:
        return pieces
    lines = Pieces.from_chords(pieces.end[apart], following[apart], np.zeros(apart.size))
    order = np.argsort(np.concatenate([np.arange(len(pieces)), apart + 0.5]), kind="stable")
    return Pieces.joined([pieces, lines]).take(order)


def closed_up(pieces: Pieces, same: float) -> Pieces:
    """Return the pieces of a loop, ends that lie within `same`, mm, of the next start set to it."""
    following = np.roll(pieces.start, -1, axis=0)
    near = np.abs(following - pieces.end).max(axis=1, keepdims=True) <= same
    return replace(pieces, end=np.where(near, following, pieces.end))
