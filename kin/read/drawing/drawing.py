"""What a drawing gives to cut, whatever its format: shapes joined into closed contours, the outer one and its holes."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.bezier import Beziers
from kin.contour.contour import Contour
from kin.contour.intersections import first_meeting
from kin.contour.pieces import ARC, Pieces
from kin.numeric.records import dataclass
from kin.read.drawing.chaining import (
    GAP,
    GAP_SHARE,
    MISSING_SHARE,
    MOST_EXPLAINED,
    NEAR_SHARE,
    ROUNDING,
    SAME_POINT,
    SAME_SHARE,
    Closeness,
    close_pairs,
    loops,
)
from kin.read.drawing.closing import closed_up
from kin.read.errors import ReadError
from kin.read.nesting import ClosedContour, Nest, counter_clockwise, demand_few, demand_few_pieces, met, nested

if TYPE_CHECKING:
    from collections import Counter
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from kin.contour.across import Bridge
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.read.drawing.digits import Written
    from kin.read.drawing.shapes import Shape
    from kin.read.formats import DrawingOptions

CUT, BORE = "CUT", "BORE"
# Layers that are cut beside CUT: the bore's, holes, a mark that is cut through, the flanks of a groove.
BESIDE = frozenset({BORE, "HOLES", "MARK", "GROOVE", "GROOVE_INNER", "GROOVE_OUTER"})
# What is engraved stands here, read if it is asked for.
ENGRAVED = "ENGRAVE"
# A gap is bridged that is as wide as its ends say.
WIDER = 1.0 + 1e-9
# Layers that are never cut: our own reference geometry and cutter's path, and AutoCAD's definition points.
REFERENCE = frozenset({"REFERENCE", "TOOLPATH", "DEFPOINTS"})
ASIDE = ": delete what is no part of the cam, such as its base circle, or put it on a layer REFERENCE"


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
    passed          what was left out, in words, where the contours round the shaft alone were sought
    bridge          the stretch, mm, that closes a contour which is open in one place
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
    passed: tuple[str, ...] = ()
    bridge: Bridge | None = None


class CutEntities(NamedTuple):
    """Entities that are read, with their shapes, names and layers, and counts of the others by layer and type.

    `written` has their numbers as the file shows them, in the order of the shapes; empty where it does not.
    """

    shapes: list[Shape]
    names: list[str]
    layers: list[str]
    aside: Counter[tuple[str, str]]
    written: list[Written]

    def chosen(self, which: Mask) -> CutEntities:
        """The entities that are marked (n,)."""
        rows = np.flatnonzero(which).tolist()
        return CutEntities(
            [self.shapes[k] for k in rows],
            [self.names[k] for k in rows],
            [self.layers[k] for k in rows],
            self.aside,
            [self.written[k] for k in rows] if self.written else [],
        )


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
    near = closeness(pieces, gap)
    scratched: tuple[Contour, ...] = ()
    if marks is not None and marks.shapes:
        lines, owner = gathered(marks.shapes)
        lines = lines.enlarged(scale) if scale != 1.0 else lines
        scratched = tuple(counter_clockwise(c.contour) for c in chain(lines, owner, near, path))
    demand_one_plane(np.concatenate([s.heights for s in curves.shapes]) * scale, near.usual, path)
    # pieces of no length and pieces drawn twice are left out, the rest is joined and nested
    keep, faults = without_faults(pieces, run, curves, near.same, path)
    if not keep.any():
        raise ReadError("empty", "all entities to cut are of zero length", path)
    short = np.flatnonzero(keep & (reach(pieces) <= gap)) if gap is not None else ()
    shorter = tuple(fault("short", pieces, int(k), run, curves) for k in short)
    chained, openings = chain_most(pieces.take(keep), run[keep], (near, partial(rounded, curves, scale)), path, bridged)
    meeting = first_meeting([c.contour for c in chained])
    if meeting:
        raise met(meeting, path, ASIDE)
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
                ring.gap if ring.gap > near.usual else 0.0,
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


def closeness(pieces: Pieces, gap: float | None) -> Closeness:
    """How near ends are to be; `gap`, mm, is what the caller wants to be joined, None for what a drawing may leave."""
    size = extent(pieces)
    same = max(min(SAME_POINT, SAME_SHARE * size), ROUNDING * float(np.abs(pieces.start).max()))
    usual = max(min(GAP, GAP_SHARE * size), same)
    return Closeness(same, usual, usual, NEAR_SHARE * size) if gap is None else Closeness(same, usual, gap)


def rounded(curves: CutEntities, scale: float, near: Closeness) -> Closeness:
    """How near ends are to be by the digits of the file too; `scale` is mm in the drawing's unit."""
    if not near.near or not curves.written:
        return near
    from kin.read.drawing.digits import rounding

    most = 0.5 * MOST_EXPLAINED / NEAR_SHARE * near.near
    return near._replace(rounding=np.minimum(scale * rounding(curves.written), most))


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


def chain_most(
    pieces: Pieces, run: Indices, near: tuple[Closeness, Callable[[Closeness], Closeness]], path: Path, bridged: float
) -> tuple[list[Chained], tuple[str, ...]]:
    """Contours out of pieces whose runs (n,), rising, are joined end to end, and messages on what is open.

    `near` is how near ends are to be, and what counts the digits of the file in, where that leaves some open. With
    `bridged` above 0, mm, gaps up to it are joined too, and chains that stay open are left out. Raises ReadError for an
    open chain without it, an open outermost contour, and more than two ends that meet.
    """
    close, by_digits = near
    try:
        return chain(pieces, run, close, path), ()
    except ReadError as error:
        if error.width is None:
            raise
    likely = by_digits(close)
    # the gap grows to the widest opening met until all is closed; beyond `bridged`, open chains are left out
    width, opened = 0.0, None
    while True:
        some = width > bridged
        close = likely if opened is None else likely._replace(gap=max(likely.gap, WIDER * min(width, bridged)))
        try:
            chained = chain(pieces, run, close, path, some=some)
        except ReadError as error:
            opened = error if opened is None else opened
            if some or not bridged or error.width is None or not error.width > width:
                raise opened.closed_by(closing_gap(pieces, run, likely, path)) from None
            width = error.width
        else:
            return chained, () if opened is None else (opened.message,)


def closing_gap(pieces: Pieces, run: Indices, near: Closeness, path: Path) -> float | None:
    """Gap, mm, that would close all chains; None where a segment is missing, or ends would find no one partner."""
    width, most = 0.0, MISSING_SHARE * extent(pieces)
    while True:
        try:
            chain(pieces, run, near._replace(gap=max(near.gap, WIDER * width)), path)
        except ReadError as error:
            if error.width is None or not width < error.width <= most:
                return None
            width = error.width
        else:
            return width


def chain(pieces: Pieces, run: Indices, near: Closeness, path: Path, *, some: bool = False) -> list[Chained]:
    """Contours out of pieces whose runs (n,), rising, are joined end to end.

    With `some` open chains are left out, where a contour goes round them. Raises ReadError: "branch" where more than
    two ends meet, "gap" or "open" where an end finds no partner or the outermost contour is open, "range" for too many
    contours.
    """
    # first piece and number of pieces of each run
    first = np.flatnonzero(np.diff(run, prepend=-1))
    count = np.diff(first, append=len(run))
    made = []
    close = near if near.rounding is None else near._replace(rounding=near.rounding[run[first]])
    rings = loops(pieces.start[first], pieces.end[first + count - 1], close, path, some=some)
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
        contour = Contour.from_pieces(closed_up(ordered, near.same, near.usual))
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
