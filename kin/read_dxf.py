"""Contours from DXF files, from any CAD system: entities in any order and direction, joined within a stated gap."""

from __future__ import annotations

import io
import re
from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kin.bezier import Beziers
from kin.chaining import SAME_POINT, close_pairs, loops
from kin.contour import Box, Contour
from kin.dxf_entities import CURVES, NOTES, Shape, UnfitError, shape_of
from kin.flaws import first_meeting
from kin.nesting import counter_clockwise, met, nested
from kin.pieces import ARC, Pieces
from kin.read_error import ReadError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ezdxf.document import Drawing as Document
    from numpy.typing import NDArray

    from kin.arcs import Array, Indices

__all__ = ["Aside", "Drawing", "Fault", "read_dxf"]

CUT, BORE = "CUT", "BORE"
# Layers that are cut beside CUT: the bore's, holes, a mark that is cut through.
BESIDE = frozenset({BORE, "HOLES", "MARK"})
# What is engraved stands here, read if it is asked for.
ENGRAVED = "ENGRAVE"
# Layers that are never cut: our own reference geometry, and AutoCAD's definition points.
REFERENCE = frozenset({"REFERENCE", "DEFPOINTS"})
# Mm in a unit of $INSUNITS: inch, foot, mm, cm, m, microinch, mil, yard, micrometre, decimetre.
UNIT_MM = {1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0, 8: 25.4e-6, 9: 0.0254, 10: 914.4, 13: 1e-3, 14: 100.0}
UNIT_NAMES = {"mm": 1.0, "millimetre": 1.0, "millimeter": 1.0, "inch": 25.4, "inches": 25.4, "in": 25.4, "cm": 10.0}
UNIT_COMMENT = re.compile(rb"^[ \t]*999[ \t]*\r?\n[^\r\n]*\bunits?[ \t]*[:=][ \t]*(\w+)", re.IGNORECASE | re.MULTILINE)
COMMENT_BYTES = 4000
END_MARK = re.compile(rb"(^|\n)[ \t]*0[ \t]*\r?\n[ \t]*EOF\s*$")
BINARY_MARK = b"AutoCAD Binary DXF"
# What wrong text causes in code that expects numbers, names and references.
DAMAGE = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, AssertionError, StopIteration)
# Pieces shorter than this, mm, have no direction to speak of.
ZERO_LENGTH = 1e-9
# Pieces whose ends and middles agree to this, mm, are drawn twice.
DUPLICATE = 1e-9
# Heights above the drawing's plane may differ by so much, mm.
FLAT = 1e-6


class Fault(NamedTuple):
    """Something that should not be in a drawing for a machine, though a contour could be read: kind, entity, place, mm.

    kind: "zero-length" (left out), "duplicate" (of another entity; left out), "overlap" (only some of its pieces are).
    """

    kind: str
    entity: str
    layer: str
    x: float
    y: float


class Aside(NamedTuple):
    """Entities that were not read as contour: their layer, type and number."""

    layer: str
    kind: str
    number: int


@dataclass(frozen=True, eq=False)
class Drawing:
    """What a DXF file gives to cut, in mm (in drawing units if it states none), and what is worth knowing about it.

    contour, holes  counter-clockwise all of them
    units_mm        mm in a drawing unit, by $INSUNITS or a comment on top; None if the file states no unit
    turned          the outer contour was drawn clockwise, and was turned round
    pieces          pieces of the outer contour as the file counts them: edges, arcs, spans of a spline
    widest_gap      widest gap between entities joined to the outer contour, mm
    layers          layers that the contour and the holes were taken from
    aside           what was not read: reference geometry, text, other layers
    faults          zero-length and duplicate entities
    version         of DXF, such as "AC1024"
    measurement     $MEASUREMENT: 0 English, 1 metric, None if not stated
    extents         $EXTMIN and $EXTMAX, mm; None if not stated
    audit           messages of ezdxf's auditor, None if it was not asked
    engraved        what is engraved, counter-clockwise, if it was asked for
    """

    contour: Contour
    holes: tuple[Contour, ...]
    units_mm: float | None
    turned: bool
    pieces: int
    widest_gap: float
    layers: tuple[str, ...]
    aside: tuple[Aside, ...]
    faults: tuple[Fault, ...]
    version: str
    measurement: int | None
    extents: Box | None
    audit: tuple[str, ...] | None
    engraved: tuple[Contour, ...] = ()


class Found(NamedTuple):
    """The entities to cut: their shapes, names and layers; and what was set aside."""

    shapes: list[Shape]
    names: list[str]
    layers: list[str]
    aside: Counter[tuple[str, str]]


def read_dxf(
    path: Path | str, gap: float = 1e-6, layer: str | None = None, *, audit: bool = False, engraved: bool = False
) -> Drawing:
    """Read the outer contour and the holes that a DXF file gives to cut.

    gap     mm; ends of loose pieces are joined if they lie within it
    layer   the one to cut. Default: CUT, with holes also from BORE, HOLES and MARK, if there is something on CUT; else
            all layers but those of reference geometry. The outermost closed chain is the contour, those inside it are
            holes.
    audit   have ezdxf's auditor look at the file too, which takes as long again
    engraved  read closed chains on the layer ENGRAVE too, if there is something on CUT

    Raises OSError as the file system does; ReadError for all that makes the contour anything but one closed chain of
    lines, arcs and splines in one plane, with the place and the size of the gap.
    """
    path = Path(path)
    raw = path.read_bytes()
    document = parsed(raw, path)
    with damage_reported(path):
        unit = unit_of(document, raw[:COMMENT_BYTES], path)
        scale = 1.0 if unit is None else unit
        found = entities_to_cut(document, layer, path)
        marks = entities_engraved(document, path) if engraved else None
        messages = tuple(e.message for e in document.audit().errors) if audit else None
        low, high = (document.header.get(name) for name in ("$EXTMIN", "$EXTMAX"))
        stated = low is not None and high is not None and low[0] <= high[0] and low[1] <= high[1]
        extents = Box(*(float(v) * scale for v in (*low[:2], *high[:2]))) if stated else None
        measurement = document.header.get("$MEASUREMENT")
    scratched: tuple[Contour, ...] = ()
    if marks is not None and marks.shapes:
        lines, owner = gathered(marks.shapes)
        lines = lines.enlarged(scale) if scale != 1.0 else lines
        scratched = tuple(counter_clockwise(c.contour) for c in chain(lines, owner, gap, path))
    pieces, run = gathered(found.shapes)
    pieces = pieces.enlarged(scale) if scale != 1.0 else pieces
    heights = np.concatenate([s.heights for s in found.shapes]) * scale
    if np.ptp(heights) > FLAT:
        message = f"the entities do not lie in one plane: heights from {heights.min():g} to {heights.max():g}"
        raise ReadError("unsupported", message, path)
    keep, faults = without_faults(pieces, run, found)
    if not keep.any():
        raise ReadError("empty", "all entities to cut are of zero length", path)
    chained = chain(pieces.take(keep), run[keep], gap, path)
    meeting = first_meeting([c.contour for c in chained])
    if meeting:
        raise met(meeting, path)
    first, *others = nested([c.contour for c in chained], path)
    outer = chained[first]
    return Drawing(
        contour=counter_clockwise(outer.contour),
        holes=tuple(counter_clockwise(chained[k].contour) for k in others),
        units_mm=unit,
        turned=outer.contour.area < 0.0,
        pieces=sum(found.shapes[k].spans for k in outer.entities),
        widest_gap=outer.gap,
        layers=tuple(sorted(set(found.layers))),
        aside=tuple(Aside(*key, count) for key, count in sorted(found.aside.items())),
        faults=tuple(faults),
        version=document.dxfversion,
        measurement=measurement,
        extents=extents,
        audit=messages,
        engraved=scratched,
    )


@contextmanager
def damage_reported(path: Path) -> Iterator[None]:
    """Turn what damaged text causes inside ezdxf into a ReadError.

    It can surface anywhere there, as any of DAMAGE. To the caller they all mean the same; the cause stays attached.
    """
    from ezdxf.lldxf.const import DXFError

    try:
        yield
    except ReadError:
        raise
    except (*DAMAGE, DXFError) as error:
        raise ReadError("syntax", f"not a sound DXF file: {type(error).__name__}: {error}", path) from error


def parsed(raw: bytes, path: Path) -> Document:
    """Parse a file by ezdxf; one without its end mark is refused before."""
    if not raw.strip():
        raise ReadError("empty", "the file is empty", path)
    if raw.startswith(BINARY_MARK):
        raise ReadError("unsupported", "this is a binary DXF file; save it as text", path)
    if END_MARK.search(raw[-200:]) is None:
        raise ReadError("truncated", "the end mark EOF is missing: the file is cut short, or no DXF file", path)

    from ezdxf.filemanagement import dxf_stream_info, read

    with damage_reported(path):
        encoding = dxf_stream_info(io.StringIO(raw.decode("utf-8", errors="ignore"), newline=None)).encoding
        return read(io.TextIOWrapper(io.BytesIO(raw), encoding=encoding, errors="surrogateescape"))


def unit_of(document: Document, head: bytes, path: Path) -> float | None:
    """Mm in a drawing unit, by $INSUNITS or else by a comment "units: mm" on top; None if neither states it."""
    code = document.header.get("$INSUNITS", 0)
    if code in UNIT_MM:
        return UNIT_MM[code]
    if code != 0:
        raise ReadError("unsupported", f"$INSUNITS {code} is no unit to draw a cam in", path)
    comment = UNIT_COMMENT.search(head)
    return None if comment is None else UNIT_NAMES.get(comment[1].decode("ascii", errors="ignore").lower())


def entities_to_cut(document: Document, layer: str | None, path: Path) -> Found:
    """Find the entities on the layers to cut, and count the others. Raises ReadError for what cannot be read there."""
    space = list(document.modelspace())
    drawn = {e.dxf.layer.upper() for e in space if e.dxftype() in CURVES or e.dxftype() == "INSERT"}
    if layer is not None and layer.upper() not in drawn:
        there = ", ".join(sorted(drawn)) or "none"
        raise ReadError("layer", f"nothing is drawn on a layer {layer}; layers with curves: {there}", path)
    chosen = layer if layer is not None else (CUT if CUT in drawn else None)
    beside = BESIDE if layer is None else {BORE}
    wanted = drawn - REFERENCE if chosen is None else {chosen.upper(), *beside}
    refuse_elsewhere(document, wanted, path)
    found = gather(space, wanted, path)
    if not found.shapes:
        others = ", ".join(f"{n} {kind} on {on}" for (on, kind), n in sorted(found.aside.items())) or "nothing at all"
        raise ReadError("empty", f"nothing to cut; the file holds {others}", path)
    return found


def entities_engraved(document: Document, path: Path) -> Found:
    """Find the entities on the layer that is engraved; none where no layer is cut by its name."""
    space = list(document.modelspace())
    by_name = any(entity.dxf.layer.upper() == CUT for entity in space)
    return gather(space, {ENGRAVED} if by_name else set(), path)


def gather(space: list[Any], wanted: set[str], path: Path) -> Found:
    """Read the entities on some layers, and count the others."""
    found = Found([], [], [], Counter())
    for entity in space:
        kind, on = entity.dxftype(), entity.dxf.layer
        if on.upper() not in wanted or kind in NOTES:
            found.aside[on, kind] += 1
            continue
        name = f"{kind} #{entity.dxf.handle} on layer {on}"
        if kind not in CURVES:
            hint = "; explode the block" if kind == "INSERT" else ""
            raise ReadError("unsupported", f"{name} is none of {', '.join(CURVES)}{hint}", path)
        try:
            found.shapes.append(shape_of(entity))
        except UnfitError as error:
            reason, what = error.args
            raise ReadError(reason, f"{name}: {what}", path) from None
        found.names.append(name)
        found.layers.append(on)
    return found


def refuse_elsewhere(document: Document, wanted: set[str], path: Path) -> None:
    """Refuse curves on the layers to cut that stand in paper space, or in a block inserted from another layer."""

    def cut(entity: Any) -> bool:  # noqa: ANN401  ezdxf's entities declare their attributes while they run
        return entity.dxf.layer.upper() in wanted and (entity.dxftype() in CURVES or entity.dxftype() == "INSERT")

    for layout in document.layouts:
        first = next((e for e in layout if cut(e)), None) if layout.is_any_paperspace else None
        if first is not None:
            what = f"{first.dxftype()} #{first.dxf.handle} on layer {first.dxf.layer}"
            raise ReadError("unsupported", f"{what} is drawn in the paper space {layout.name}", path)
    for insert in document.modelspace().query("INSERT"):
        block = document.blocks.get(insert.dxf.name)
        if block is not None and any(cut(e) for e in block):
            what = f"INSERT #{insert.dxf.handle} brings in block {insert.dxf.name}, which draws on a layer to cut"
            raise ReadError("unsupported", f"{what}; explode it", path)


def gathered(shapes: list[Shape]) -> tuple[Pieces, Indices]:
    """All pieces of the shapes, in order, and the number of the shape that each belongs to (n,), rising."""
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


def without_faults(pieces: Pieces, run: Indices, found: Found) -> tuple[NDArray[np.bool_], list[Fault]]:
    """Which pieces (n,) to keep, and the faults: pieces of no length, and pieces drawn twice, whichever way round.

    An entity all of whose pieces are drawn by entities before it is left out. Where only some are, the pieces stay.
    """
    keep = reach(pieces) > ZERO_LENGTH
    faults = [fault("zero-length", pieces, int(k), run, found) for k in np.flatnonzero(~keep)]
    kept = np.flatnonzero(keep)
    middle = pieces.points(kept, np.full(kept.size, 0.5))
    start, end = pieces.start[kept], pieces.end[kept]
    chord = end - start
    size = np.maximum(np.hypot(chord[:, 0], chord[:, 1]), ZERO_LENGTH)
    # The same whichever way the piece is run through: middle of the chord, of the piece, and the direction doubled.
    doubled = np.stack([chord[:, 0] ** 2 - chord[:, 1] ** 2, 2.0 * chord[:, 0] * chord[:, 1]], axis=1) / size[:, None]
    one, other = close_pairs(np.column_stack([(start + end) / 2.0, middle, doubled]), DUPLICATE)
    again = np.zeros(len(pieces), dtype=bool)
    again[kept[np.maximum(one, other)]] = True
    if not again.any():
        return keep, faults
    count = len(found.names)
    whole = np.bincount(run[keep & ~again], minlength=count) == 0
    for k in np.flatnonzero(np.bincount(run[again], minlength=count)):
        place = int(np.flatnonzero(again & (run == k))[0])
        faults.append(fault("duplicate" if whole[k] else "overlap", pieces, place, run, found))
    return keep & ~whole[run], faults


def fault(kind: str, pieces: Pieces, piece: int, run: Indices, found: Found) -> Fault:
    """Return a Fault at the start of a piece."""
    x, y = pieces.start[piece].tolist()
    return Fault(kind, found.names[run[piece]], found.layers[run[piece]], x, y)


def reach(pieces: Pieces) -> Array:
    """Return the size of each piece, mm (n,): never less than a third of its length."""
    size = np.hypot(*(pieces.end - pieces.start).T)
    size = np.where(pieces.kind == ARC, pieces.radius * np.abs(pieces.sweep), size)
    bow = pieces.curve >= 0
    if bow.any():
        size[bow] = np.ptp(pieces.beziers.control, axis=1).max(axis=1)[pieces.curve[bow]]
    return size


class Chained(NamedTuple):
    """A closed contour, the entities it is made of (k,), and the widest gap between them, mm."""

    contour: Contour
    entities: Indices
    gap: float


def chain(pieces: Pieces, run: Indices, gap: float, path: Path) -> list[Chained]:
    """Contours out of pieces whose runs (n,), rising, are joined end to end."""
    first = np.flatnonzero(np.diff(run, prepend=-1))
    count = np.diff(first, append=len(run))
    made = []
    for loop in loops(pieces.start[first], pieces.end[first + count - 1], gap, path):
        many, back = count[loop.runs], loop.backwards
        owner = np.repeat(np.arange(len(many)), many)
        step = np.arange(len(owner)) - np.repeat(np.cumsum(many) - many, many)
        step = np.where(back[owner], many[owner] - 1 - step, step)
        ordered = pieces.take(first[loop.runs][owner] + step).turned_round(back[owner])
        made.append(Chained(Contour.from_pieces(closed_up(ordered)), run[first[loop.runs]], loop.gap))
    return made


def closed_up(pieces: Pieces) -> Pieces:
    """Return the pieces of a loop, ends that lie within rounding of the next start set to it."""
    following = np.roll(pieces.start, -1, axis=0)
    near = np.abs(following - pieces.end).max(axis=1, keepdims=True) <= SAME_POINT
    return replace(pieces, end=np.where(near, following, pieces.end))
