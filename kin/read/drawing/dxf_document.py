"""DXF text by ezdxf, with a short way through files of the plain form that CAD programs and camgeo write.

The frame of such a file, which is all but its entities, differs from the next one's by lengths that no contour depends
on. A frame is read once, and of each file only its entities.
"""

from __future__ import annotations

import io
import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from kin.read.home import prepare_home

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ezdxf.document import Drawing as Document

# What wrong text causes in code that expects numbers, names and references.
DAMAGE = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, AssertionError, StopIteration)
HEADER = re.compile(rb"^[ \t]*2[ \t]*\r?\n[ \t]*HEADER[ \t]*\r?$", re.MULTILINE)
ONCE = (b"ENTITIES", b"EOF")  # words that a plain file has no second time
COMMENTS = re.compile(rb"(?: *999\n.*\n)*")
BEGIN = re.compile(rb"\n( *0\nSECTION\n *2\nENTITIES\n)")
END = re.compile(rb"\n( *0\nENDSEC\n)")
# The value of a length or an angle, such as the extremes of a drawing; before it a code of two digits, or of three.
MEASURE = re.compile(rb"\n(?<=[ \n12][1-5]\d\n) *-?\d{1,15}\.\d{0,17}(?:[eE]-?\d\d?)?(?=\n)")
HANDLES = re.compile(rb"^ *(?:5|105|3[2-6]\d|39\d|48\d|1005)\n([0-9A-Fa-f]+)$", re.MULTILINE)
HANDLE = re.compile(r"0*[1-9A-F][0-9A-F]*")
FRAMES = 8  # that are kept, of some MB each
# Entities that refer to nothing but a layer and a line type.
PLAIN = frozenset({"LINE", "ARC", "CIRCLE", "LWPOLYLINE", "SPLINE", "ELLIPSE", "POINT"})


def whole(raw: bytes) -> Document:
    """All of a file, by ezdxf; raises ezdxf's DXFError and those of DAMAGE for damaged text."""
    prepare_home()
    from ezdxf.filemanagement import dxf_stream_info, read

    encoding = dxf_stream_info(io.StringIO(raw.decode("utf-8", errors="ignore"), newline=None)).encoding
    document = read(io.TextIOWrapper(io.BytesIO(raw), encoding=encoding, errors="surrogateescape"))
    if HEADER.search(raw) is None:
        document.header.hdrvars.clear()  # ezdxf makes a header up, in metres
    return document


def opened(raw: bytes) -> tuple[Document, Iterable[Any]]:
    """A file's document, and the entities of its model space; raises what `whole` raises."""
    found = plain(raw)
    if found is not None:
        return found
    document = whole(raw)
    return document, document.modelspace()


def plain(raw: bytes) -> tuple[Document, list[Any]] | None:
    """A file's frame, and its entities in the model space; None if it is not plain or something in it is unsound.

    Frame and entities are those that `whole` gives.
    """
    raw = raw.replace(b"\r\n", b"\n")
    begin = BEGIN.search(raw)
    end = begin and END.search(raw, begin.end() - 1)
    top = COMMENTS.match(raw)
    if begin is None or end is None or top is None or b"\r" in raw:
        return None
    body, rest = raw[begin.start(1) : end.end()], raw[top.end() : begin.end()] + raw[end.start(1) :]
    if any(not raw.count(word) == rest.count(word) == 1 for word in ONCE):
        return None
    prepare_home()
    from ezdxf.lldxf.const import DXFError
    from ezdxf.lldxf.loader import load_dxf_entities, load_dxf_structure
    from ezdxf.lldxf.tagger import ascii_tags_loader, tag_compiler

    try:
        frame = _frame(MEASURE.sub(rb"\n0.0", rest))
        tags = ascii_tags_loader(io.StringIO(body.decode("ascii") + "0\nEOF\n"))
        sections = load_dxf_structure(tag_compiler(tags))
        entities = list(load_dxf_entities(sections["ENTITIES"][1:], frame.document))  # type: ignore[arg-type]  # they are tags until then
    except (*DAMAGE, DXFError):
        return None
    alone = len(sections) == 1 and all(frame.has_room_for(entity) for entity in entities)
    return (frame.document, entities) if alone else None


class _Frame(NamedTuple):
    """A file without entities, the handle of its model space, and all handles in it."""

    document: Document
    space: str
    handles: frozenset[str]

    def has_room_for(self, entity: Any) -> bool:  # noqa: ANN401  ezdxf's entities declare their attributes while they run
        """Whether an entity is plain, stands in the model space and has a handle of its own."""
        handle, owner = entity.dxf.handle, entity.dxf.owner
        own = HANDLE.fullmatch(str(handle)) is not None and handle not in self.handles
        return own and owner == self.space and entity.dxftype() in PLAIN


@lru_cache(maxsize=FRAMES)
def _frame(raw: bytes) -> _Frame:
    document = whole(raw)
    space = document.modelspace()
    own = space.block_record is document.block_records.get("*Model_Space")
    if len(space) or not own or document.loaded_dxfversion != document.dxfversion:
        raise ValueError("the model space has entities elsewhere, or ezdxf turned the file into a later version's")
    handles = frozenset([*document.entitydb, *(handle.decode("ascii") for handle in HANDLES.findall(raw))])
    return _Frame(document, space.layout_key, handles)
