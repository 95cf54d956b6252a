"""Contours from DXF files, from any CAD system: entities in any order and direction, joined within a stated gap."""

from __future__ import annotations

import re
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kin.read.drawing.about_shaft import drawing_about_shaft
from kin.read.drawing.drawing import (
    BESIDE,
    CUT,
    ENGRAVED,
    REFERENCE,
    CutEntities,
)
from kin.read.drawing.dxf_document import DAMAGE, opened, whole
from kin.read.drawing.dxf_entities import CURVES, FILLS, NOTES, facing, shape_of, written
from kin.read.drawing.shapes import Affine, UnfitError, check
from kin.read.errors import ReadError, short
from kin.read.formats import contents
from kin.read.home import prepare_home

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from ezdxf.document import Drawing as Document

    from kin.read.drawing.drawing import Drawing
    from kin.read.formats import DrawingOptions

# Mm in a unit of $INSUNITS: inch, foot, mm, cm, m, microinch, mil, yard, micrometre, decimetre.
UNIT_MM = {1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0, 8: 25.4e-6, 9: 0.0254, 10: 914.4, 13: 1e-3, 14: 100.0}
UNIT_NAMES = {"mm": 1.0, "millimetre": 1.0, "millimeter": 1.0, "inch": 25.4, "inches": 25.4, "in": 25.4, "cm": 10.0}
UNIT_COMMENT = re.compile(rb"^[ \t]*999[ \t]*\r?\n[^\r\n]*\bunits?[ \t]*[:=][ \t]*(\w+)", re.IGNORECASE | re.MULTILINE)
COMMENT_BYTES = 4000
# A number with an underscore, which Python reads: 1_0 as 10. Before it the code of a group that is a number.
UNDERSCORED = re.compile(
    rb"^[ \t]*(?:[1-9]\d|1[1-7]\d|2[1-8]\d|37\d|38\d|4[0246]\d|10[1-7]\d)[ \t]*\r?\n"
    rb"[ \t]*([-+.\deE]*\d_\d[-+.\deE_]*)[ \t]*\r?$",
    re.MULTILINE,
)
JOINED = re.compile(rb"_(?<=\d_)\d")  # found soon where there is none
END_MARK = re.compile(rb"(^|\n)[ \t]*0[ \t]*\r?\n[ \t]*EOF\s*$")
MOST_ENTITIES = 20_000  # that blocks may bring in
DEEPEST = 16  # of blocks within blocks
EXTERNAL = 4 | 32  # flags of a block that another file has
NO_LAYER = "0"  # what is drawn without choosing a layer stands there
BINARY_MARK = b"AutoCAD Binary DXF"
BY_LAYER = "BYLAYER"
DASH = 49  # group code of a dash, a dot or a space in a line type


def read_dxf(path: Path, options: DrawingOptions) -> Drawing:
    """Read the outer contour and the holes that a DXF file gives to cut.

    Cut are the layers CUT, BORE, HOLES, MARK, GROOVE, GROOVE_INNER, GROOVE_OUTER and 0, if there is something on CUT;
    else all layers but those of reference geometry, without what has a line type with dashes, as centre lines and
    hidden edges have: outlines are continuous (ISO 128). The outermost closed chain is the contour, those inside it are
    holes.

    Raises OSError where the file cannot be read; ReadError for a damaged or too large file, an unknown unit, and, with
    the place and the size of a gap, a contour that is not one closed chain of lines, arcs and splines in one plane.
    """
    raw = contents(path, "dxf")
    check_whole(raw, path)
    with damage_reported(path):
        document, space = opened(raw)
        unit = unit_of(document, raw[:COMMENT_BYTES], path)
        drawn = everything(document, space, path)
        passed = NOTES | FILLS if options.shaft is not None else NOTES  # to follow a contour no fill matters
        entities = entities_to_cut(document, drawn, path, passed)
        marks = entities_engraved(drawn, path) if options.engraved else None
    return drawing_about_shaft(entities, marks, unit, path, options, version=document.dxfversion)


@contextmanager
def damage_reported(path: Path) -> Iterator[None]:
    """Turn the errors that damaged text causes inside ezdxf, any of DAMAGE, into a ReadError that has them as cause."""
    prepare_home()
    from ezdxf.lldxf.const import DXFError

    try:
        yield
    except ReadError:
        raise
    except (*DAMAGE, DXFError) as error:
        line = re.search(r"\bline:? (\d+)", str(error))  # the one thing of ezdxf's own words that helps
        where = (
            f"line {line[1]} cannot be read"
            if line
            else "a record in it is incomplete, or no number stands where one belongs"
        )
        raise ReadError("syntax", f"not a sound DXF file: {where}; save it anew from CAD", path) from error


def parsed(raw: bytes, path: Path) -> Document:
    """Parse the bytes of a DXF file by ezdxf; raises ReadError for an empty, binary, cut short or damaged file."""
    check_whole(raw, path)
    with damage_reported(path):
        return whole(raw)


def check_whole(raw: bytes, path: Path) -> None:
    """Raise ReadError for a file that is empty, binary or cut short, and for a number that only Python reads."""
    if not raw.strip():
        raise ReadError("empty", "the file is empty", path)
    if raw.startswith(BINARY_MARK):
        raise ReadError("unsupported", "this is a binary DXF file; save it as text", path)
    if END_MARK.search(raw[-200:]) is None:
        raise ReadError("truncated", "the end mark EOF is missing: the file is cut short, or no DXF file", path)

    if JOINED.search(raw) and (number := UNDERSCORED.search(raw)):
        line = raw.count(b"\n", 0, number.start(1)) + 1
        raise ReadError("syntax", f"line {line}: {number[1].decode('ascii')} is not a number", path)


def unit_of(document: Document, head: bytes, path: Path) -> float | None:
    """Mm in a drawing unit, by $INSUNITS or else by a comment "units: mm" on top; None if neither states it.

    Raises ReadError where $INSUNITS is not a unit for a cam drawing.
    """
    code = document.header.get("$INSUNITS", 0)
    if code in UNIT_MM:
        return UNIT_MM[code]
    if code != 0:
        raise ReadError("unsupported", f"$INSUNITS {code} is not a unit for a cam drawing", path)
    comment = UNIT_COMMENT.search(head)
    return None if comment is None else UNIT_NAMES.get(comment[1].decode("ascii", errors="ignore").lower())


class Drawn(NamedTuple):
    """An entity, its layer, its name, and how the blocks round it place it: x and y by `to`, z at `rise` + `scale` z.

    What is drawn on layer 0 of a block stands on the layer where the block is inserted.
    """

    entity: Any
    layer: str
    name: str
    to: Affine | None = None
    rise: float = 0.0
    scale: float = 1.0

    @property
    def kind(self) -> str:
        """Type of the entity."""
        return str(self.entity.dxftype())


def everything(document: Document, space: Iterable[Any], path: Path) -> list[Drawn]:
    """List the entities of the model space `space`, and in place of each INSERT those of its block, in order.

    Raises ReadError for a block that is not there, lies in another file or is placed unsoundly, and for blocks too deep
    or of too many entities.
    """
    entities: list[Drawn] = []
    left = [Drawn(entity, entity.dxf.layer, _name(entity)) for entity in space]
    depths = [0] * len(left)
    left.reverse()
    most = MOST_ENTITIES + len(left)
    while left:
        item, depth = left.pop(), depths.pop()
        if item.kind != "INSERT":
            entities.append(item)
            continue
        inside = list(_inserted(document, item, path))
        if depth == DEEPEST or len(entities) + len(left) + len(inside) > most:
            bounds = f"blocks more than {DEEPEST} deep, or of more than {MOST_ENTITIES} entities in all"
            raise ReadError("range", f"{item.name}: {bounds}", path)
        left += reversed(inside)
        depths += [depth + 1] * len(inside)
    return entities


def _name(entity: Any) -> str:  # noqa: ANN401  ezdxf's entities declare their attributes while they run
    return f"{entity.dxftype()} #{entity.dxf.handle} on layer {short(entity.dxf.layer)}"


def _inserted(document: Document, insert: Drawn, path: Path) -> Iterator[Drawn]:
    """List the entities that an INSERT brings in, once for each of its columns and rows."""
    dxf = insert.entity.dxf
    block = document.blocks.get(dxf.name)
    if block is None or block.block is None:
        raise ReadError("syntax", f"{insert.name}: there is no block {dxf.name}", path)
    if block.block.dxf.flags & EXTERNAL:
        raise ReadError("unsupported", f"{insert.name}: block {dxf.name} lies in another file; bind it", path)
    try:
        side = facing(insert.entity)
        # a column or a row more or less is another drawing: they are counted as they are written
        columns, rows = (max(1, int(dxf.get(name, 1))) for name in ("column_count", "row_count"))
        sizes = [float(dxf.get(name, 1.0)) for name in ("xscale", "yscale", "zscale")]
        place, base, turn = dxf.insert, block.block.dxf.base_point, float(dxf.get("rotation", 0.0))
        check(np.array([*sizes, *place, *base, turn]))
    except UnfitError as error:
        raise ReadError(error.args[0], f"{insert.name}: {error.args[1]}", path) from None
    if not all(sizes[:2]):
        raise ReadError("unsupported", f"{insert.name}: its scale is 0", path)
    if columns * rows * max(len(block), 1) > MOST_ENTITIES:
        raise ReadError("range", f"{insert.name}: {columns} columns and {rows} rows of {len(block)} entities", path)
    turned = Affine(a=side).after(Affine(e=place.x, f=place.y)).after(Affine.rotation(turn))
    own = Affine(a=sizes[0], d=sizes[1]).after(Affine(e=-base.x, f=-base.y))
    rise, scale = side * (place.z - sizes[2] * base.z), side * sizes[2]
    for row in range(rows):
        for column in range(columns):
            step = Affine(e=column * dxf.get("column_spacing", 0.0), f=row * dxf.get("row_spacing", 0.0))
            to = turned.after(step).after(own)
            to = to if insert.to is None else insert.to.after(to)
            for entity in block:
                on = insert.layer if entity.dxf.layer == NO_LAYER else entity.dxf.layer
                name = f"{entity.dxftype()} #{entity.dxf.handle} of block {dxf.name} on layer {short(on)}"
                yield Drawn(entity, on, name, to, insert.rise + insert.scale * rise, insert.scale * scale)


def entities_to_cut(document: Document, drawn: list[Drawn], path: Path, passed: frozenset[str]) -> CutEntities:
    """Find the entities on the layers to cut, and count the others; those of types in `passed` are no curves.

    Raises ReadError for an entity on these layers that is not read, and where there is nothing to cut.
    """
    drawn_on = _layers_of_curves(drawn)
    by_name = CUT in drawn_on
    wanted = {CUT, *BESIDE} if by_name else drawn_on - REFERENCE
    dashed = Counter[tuple[str, str]]()
    if not by_name:
        types = [_dashes(document, entity) for entity in drawn]
        dashed.update(
            (item.layer, f"{item.kind} of line type {name}") for item, name in zip(drawn, types, strict=True) if name
        )
        drawn = [item for item, name in zip(drawn, types, strict=True) if not name]
    # what is drawn with no thought for layers goes to the machine too
    entities = gather(drawn, wanted | {NO_LAYER}, path, passed)
    entities.aside.update(on_paper(document))
    entities.aside.update(dashed)
    if not entities.shapes:
        listing = (
            ", ".join(f"{n} {kind} on {on}" for (on, kind), n in sorted(entities.aside.items())) or "nothing at all"
        )
        raise ReadError("empty", f"nothing to cut in the model space; the file holds {listing}", path)
    return entities


def _dashes(document: Document, drawn: Drawn) -> str:
    """Name of a curve's line type, its own or its layer's, if it has dashes; else empty."""
    name = str(drawn.entity.dxf.get("linetype", BY_LAYER))
    if name.upper() == BY_LAYER and drawn.layer in document.layers:
        name = str(document.layers.get(drawn.layer).dxf.linetype)
    if drawn.kind not in CURVES or name not in document.linetypes:
        return ""
    tags = document.linetypes.get(name).pattern_tags.tags
    return name if any(tag.code == DASH for tag in tags) else ""


def entities_engraved(drawn: list[Drawn], path: Path) -> CutEntities:
    """The entities on the engraving layer; empty unless curves are drawn on the layer CUT.

    Raises ReadError for an entity on it that is not read.
    """
    return gather(drawn, {ENGRAVED} if CUT in _layers_of_curves(drawn) else set(), path)


def _layers_of_curves(drawn: list[Drawn]) -> set[str]:
    """Names, in capitals, of the layers on which there are curves; text there makes no layer one to cut."""
    return {entity.layer.upper() for entity in drawn if entity.kind in CURVES}


def gather(drawn: list[Drawn], layers: set[str], path: Path, passed: frozenset[str] = NOTES) -> CutEntities:
    """Read the entities on these layers, named in capitals, and count the others; those of types in `passed` too.

    Raises ReadError for an entity on the layers that is not read.
    """
    entities = CutEntities([], [], [], Counter(), [])
    for item in drawn:
        if item.layer.upper() not in layers or item.kind in passed:
            entities.aside[item.layer, item.kind] += 1
            continue
        if item.kind not in CURVES:
            raise ReadError("unsupported", f"{item.name} is none of {', '.join(CURVES)}", path)
        try:
            shape = shape_of(item.entity)
            entities.shapes.append(shape if item.to is None else item.to.moved(shape, item.rise, item.scale))
            entities.written.append(written(item.entity, shape, 1.0 if item.to is None else item.to.widest))
        except UnfitError as error:
            reason, problem = error.args
            raise ReadError(reason, f"{item.name}: {problem}", path) from None
        entities.names.append(item.name)
        entities.layers.append(item.layer)
    return entities


def on_paper(document: Document) -> Counter[tuple[str, str]]:
    """Count the curves and blocks of paper space, by layer and type: frames and title blocks, which no machine cuts."""
    return Counter(
        (entity.dxf.layer, f"{entity.dxftype()} in the paper space {layout.name}")
        for layout in document.layouts
        if layout.is_any_paperspace
        for entity in layout
        if entity.dxftype() in CURVES or entity.dxftype() == "INSERT"
    )
