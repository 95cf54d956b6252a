"""Contours from DXF files, from any CAD system: entities in any order and direction, joined within a stated gap."""

from __future__ import annotations

import io
import re
from collections import Counter
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kin.contour import Box
from kin.drawing import BESIDE, BORE, CUT, ENGRAVED, REFERENCE, Aside, Drawing, Fault, Found, drawing_of
from kin.dxf_entities import CURVES, NOTES, shape_of
from kin.home import prepare_home
from kin.read_error import ReadError
from kin.shape import UnfitError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ezdxf.document import Drawing as Document

__all__ = ["Aside", "Drawing", "Fault", "read_dxf"]

# Mm in a unit of $INSUNITS: inch, foot, mm, cm, m, microinch, mil, yard, micrometre, decimetre.
UNIT_MM = {1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0, 8: 25.4e-6, 9: 0.0254, 10: 914.4, 13: 1e-3, 14: 100.0}
UNIT_NAMES = {"mm": 1.0, "millimetre": 1.0, "millimeter": 1.0, "inch": 25.4, "inches": 25.4, "in": 25.4, "cm": 10.0}
UNIT_COMMENT = re.compile(rb"^[ \t]*999[ \t]*\r?\n[^\r\n]*\bunits?[ \t]*[:=][ \t]*(\w+)", re.IGNORECASE | re.MULTILINE)
COMMENT_BYTES = 4000
END_MARK = re.compile(rb"(^|\n)[ \t]*0[ \t]*\r?\n[ \t]*EOF\s*$")
NO_LAYER = "0"  # what is drawn without choosing a layer stands there
BINARY_MARK = b"AutoCAD Binary DXF"
# What wrong text causes in code that expects numbers, names and references.
DAMAGE = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, AssertionError, StopIteration)


def read_dxf(
    path: Path | str,
    gap: float | None = None,
    layer: str | None = None,
    *,
    audit: bool = False,
    engraved: bool = False,
) -> Drawing:
    """Read the outer contour and the holes that a DXF file gives to cut.

    gap     mm; ends of loose pieces are joined if they lie within it. Default: 1e-6, or 2e-8 of a drawing below 50 mm
    layer   the one to cut. Default: CUT, with holes also from BORE, HOLES, MARK and 0, if there is something on CUT;
            else all layers but those of reference geometry. The outermost closed chain is the contour, those inside
            it are holes.
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
    return drawing_of(
        found,
        marks,
        unit,
        gap,
        path,
        version=document.dxfversion,
        measurement=measurement,
        extents=extents,
        audit=messages,
    )


@contextmanager
def damage_reported(path: Path) -> Iterator[None]:
    """Turn what damaged text causes inside ezdxf into a ReadError.

    It can surface anywhere there, as any of DAMAGE. To the caller they all mean the same; the cause stays attached.
    """
    prepare_home()
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

    prepare_home()
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
    named = drawn - REFERENCE if chosen is None else {chosen.upper(), *beside}
    refuse_elsewhere(document, named, path)
    # what is drawn with no thought for layers goes to the machine too
    wanted = named | {NO_LAYER} if layer is None else named
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
