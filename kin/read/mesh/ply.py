"""Triangles from PLY files, text or binary: vertices with x, y and z, and faces of three corners.

Header and types are those of G. Turk's description of the format (1994), with the names that later programs give to the
types. Further properties of one number each are passed over; further lists and elements are refused.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from kin.read.errors import ReadError, short
from kin.read.mesh.mesh import WordError, doubles

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from kin.numeric.arrays import Indices
    from kin.read.mesh.prism import Corners

TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"}
TYPES |= {"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"}
TYPES |= {"float": "f4", "float32": "f4", "double": "f8", "float64": "f8"}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
INDICES = ("vertex_indices", "vertex_index")
LONGEST_HEADER = 65_536  # bytes
LONGEST_WORD = 40
CORNERS = 3


class _Property(NamedTuple):
    """A property of an element: its name, the type of its numbers, and if it is a list the type of its length."""

    name: str
    type: str
    length: str = ""


class _Element(NamedTuple):
    """An element of a header: its name, how often it comes, and its properties."""

    name: str
    number: int
    properties: list[_Property]


def triangles_of(raw: bytes, path: Path) -> tuple[Corners, Literal["binary", "text"]]:
    """Corners (t, 3, 3) of the triangles, in the file's order, unit and precision, and the form of the file.

    Raises ReadError for a file that is empty, cut short or none of the format, and for faces that are no triangles.
    """
    order, elements, begin = _header(raw, path)
    vertex, face = _elements(elements, path)
    points: NDArray[np.float32] | NDArray[np.float64]
    if order:
        points, corners = _of_bytes(raw[begin:], order, vertex, face, path)
    else:
        points, corners = _of_text(raw[begin:], vertex, face, path)
    wrong = np.flatnonzero(((corners < 0) | (corners >= len(points))).any(axis=1))
    if wrong.size:
        message = f"face {wrong[0] + 1} has a corner that is none of the {len(points)} vertices"
        raise ReadError("syntax", message, path)
    return points[corners], "binary" if order else "text"


def _header(raw: bytes, path: Path) -> tuple[str, list[_Element], int]:
    """Order of the bytes, empty for text; the elements; and where the data begin."""
    if not raw.startswith((b"ply\n", b"ply\r")):
        raise ReadError("syntax", f"not a PLY file: it begins with {raw[:20]!r}", path)
    end = raw.find(b"end_header", 0, LONGEST_HEADER)
    line_end = raw.find(b"\n", end)
    if end < 0 or line_end < 0:
        raise ReadError("truncated", "the header does not end: there is no line end_header", path)
    order, elements = None, list[_Element]()
    lines = raw[:end].decode("ascii", "replace").splitlines()
    for number, line in enumerate(lines[1:], start=2):
        words = line.split()
        match words:
            case [] | ["comment" | "obj_info", *_]:
                continue
            case ["format", name, "1.0"] if name in ORDERS and order is None:
                order = ORDERS[name]
            case ["element", name, count] if count.isdecimal() and len(count) < LONGEST_WORD:
                elements.append(_Element(name, int(count), []))
            case ["property", kind, name] if kind in TYPES and elements:
                elements[-1].properties.append(_Property(name, TYPES[kind]))
            case ["property", "list", count, kind, name] if {count, kind} <= TYPES.keys() and elements:
                elements[-1].properties.append(_Property(name, TYPES[kind], TYPES[count]))
            case _:
                raise ReadError("syntax", f"line {number} of the header is not read: {line.strip()[:60]!r}", path)
    if order is None:
        raise ReadError("syntax", "the header has no line format", path)
    return order, elements, line_end + 1


def _elements(elements: list[_Element], path: Path) -> tuple[_Element, _Element]:
    """Elements of the vertices and of the faces; raises ReadError for other elements, and for properties not read."""
    kept = [element for element in elements if element.number or element.name in {"vertex", "face"}]
    unread = [element.name for element in kept if element.name not in {"vertex", "face"}]
    if unread:
        raise ReadError("unsupported", f"it holds elements {short(unread[0])!r} beside vertices and faces", path)
    if [element.name for element in kept] != ["vertex", "face"]:
        raise ReadError("syntax", "the header lists no vertices and then faces", path)
    vertex, face = kept
    axes = {entry.name: entry for entry in vertex.properties if entry.type in {"f4", "f8"} and not entry.length}
    if not {"x", "y", "z"} <= axes.keys() or any(entry.length for entry in vertex.properties):
        raise ReadError("unsupported", "a vertex has no x, y and z of type float or double, or a list", path)
    lists = [entry for entry in face.properties if entry.length]
    whole = [entry for entry in lists if entry.name in INDICES and "f" not in entry.type + entry.length]
    if len(lists) != 1 or not whole:
        raise ReadError("unsupported", f"a face has no list {INDICES[0]}, or another list beside it", path)
    if not face.number or not vertex.number:
        raise ReadError("empty", "the file holds no triangles", path)
    return vertex, face


def _of_bytes(
    raw: bytes, order: str, vertex: _Element, face: _Element, path: Path
) -> tuple[NDArray[np.float32] | NDArray[np.float64], Indices]:
    """Vertices (v, 3) and corners of the faces (t, 3) of a binary file.

    Raises ReadError for too few or too many bytes, and faces that are no triangles.
    """
    # a row a vertex, a record a face; the faces that the file has whole are checked before the file's length
    names = [entry.name for entry in vertex.properties]
    row = np.dtype([(f"{k}", order + entry.type) for k, entry in enumerate(vertex.properties)])
    parts: list[tuple[str, str] | tuple[str, str, int]] = []
    for k, entry in enumerate(face.properties):
        parts += [("count", order + entry.length), ("corners", order + entry.type, CORNERS)] if entry.length else []
        parts += [] if entry.length else [(f"{k}", order + entry.type)]
    record = np.dtype(parts)
    begin, expected = vertex.number * row.itemsize, vertex.number * row.itemsize + face.number * record.itemsize
    if len(raw) < begin:
        raise ReadError("truncated", f"{vertex.number} vertices take {begin} bytes, and {len(raw)} follow", path)
    complete = min(face.number, (len(raw) - begin) // record.itemsize)
    faces = np.frombuffer(raw, record, count=complete, offset=begin)
    _demand_triangles(faces["count"].astype(np.int64), path)
    if len(raw) != expected:
        message = f"{vertex.number} vertices and {face.number} triangles take {expected} bytes, and {len(raw)} follow"
        raise ReadError("truncated" if len(raw) < expected else "syntax", message, path)
    table = np.frombuffer(raw, row, count=vertex.number)
    columns = [table[f"{names.index(axis)}"] for axis in "xyz"]
    points = np.stack([column.astype(column.dtype.newbyteorder("=")) for column in columns], axis=1)
    return points, faces["corners"].astype(np.intp)


def _of_text(raw: bytes, vertex: _Element, face: _Element, path: Path) -> tuple[NDArray[np.float64], Indices]:
    """Vertices (v, 3) and corners of the faces (t, 3) of a file in text form; numbers are read as doubles.

    A corner whose magnitude is not below the number of vertices is -1. Raises ReadError for too few or too many
    numbers, words that are no numbers, faces that are no triangles, and corners that are no whole numbers.
    """
    words = raw.split()
    if not words or max(map(len, words)) > LONGEST_WORD:
        reason = "syntax" if words else "truncated"
        raise ReadError(reason, "the vertices are missing, or a word is longer than a number", path)
    # the faces that the text has whole are checked before the number of words
    wide = len(vertex.properties)
    begin = wide * vertex.number
    if len(words) < begin:
        message = f"{vertex.number} vertices have {begin} numbers, and {len(words)} follow"
        raise ReadError("truncated", message, path)
    names = [entry.name for entry in vertex.properties]
    table = _numbers(words[:begin], path).reshape(-1, wide)
    points = table[:, [names.index(axis) for axis in "xyz"]]
    place = next(k for k, entry in enumerate(face.properties) if entry.length)
    width = len(face.properties) + CORNERS
    complete = min(face.number, (len(words) - begin) // width)
    rows = _numbers(words[begin : begin + complete * width], path).reshape(-1, width)
    _demand_triangles(rows[:, place], path)
    expected = begin + face.number * width
    if len(words) != expected:
        message = (
            f"{vertex.number} vertices and {face.number} triangles have {expected} numbers, and {len(words)} follow"
        )
        raise ReadError("truncated" if len(words) < expected else "syntax", message, path)
    corners = rows[:, place + 1 : place + 1 + CORNERS]
    wrong = np.flatnonzero((corners != np.floor(corners)).any(axis=1))
    if wrong.size:
        raise ReadError("syntax", f"face {wrong[0] + 1} has a corner that is no whole number", path)
    return points, np.where(np.abs(corners) < len(points), corners, -1.0).astype(np.intp)


def _numbers(words: list[bytes], path: Path) -> NDArray[np.float64]:
    """Read numbers as doubles; raises ReadError with the first word that is none."""
    try:
        return doubles(np.array(words, dtype="S"))
    except WordError as error:
        text = words[error.place].decode("latin-1")
        raise ReadError("syntax", f"{short(text)!r} is not a number", path) from None


def _demand_triangles(counts: NDArray[np.int64] | NDArray[np.float64], path: Path) -> None:
    """Raise ReadError for faces of other than three corners: numbers behind the first such face are misread."""
    wrong = np.flatnonzero(counts != CORNERS)
    if wrong.size:
        message = f"face {wrong[0] + 1} has {counts[wrong[0]]:g} corners; triangles alone are read: export it as such"
        raise ReadError("unsupported", message, path)
