"""Parts from 3MF files: the archive's model parsed as it streams out, objects with their components, build items.

Written against the core specification 1.3. The archive is a stranger's: what it unpacks to is bounded, and a document
type, through which a small text could grow without bound, is refused.
"""

from __future__ import annotations

import errno
import re
import zipfile
import zlib
from array import array
from functools import partial
from pathlib import Path
from typing import IO, TYPE_CHECKING
from xml.parsers import expat

import numpy as np

from kin.numeric.records import dataclass, field, replace
from kin.read.bodies import RIGID, Placed, SeparateBody, Sought, missing
from kin.read.errors import ReadError, short, xml_fault
from kin.read.formats import oversize
from kin.read.mesh.checked import LARGEST, Triangles
from kin.read.mesh.stl import Solid, solid_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.numeric.arrays import Array, Indices

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02 "
LINK = "http://schemas.openxmlformats.org/package/2006/relationships Relationship"
MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
UNIT_MM = {"micron": 1e-3, "millimeter": 1.0, "centimeter": 10.0, "inch": 25.4, "foot": 304.8, "meter": 1000.0}
MOST_BYTES = 1 << 28  # of a member of the archive when unpacked
# Models pack to a fifth or a tenth. What packs to next to nothing says the same over and over: so many times its packed
# size, and a free allowance, are unpacked.
MOST_UNPACKED, FREE_BYTES = 50, 1 << 18
# Vertices that no triangle has: up to a share of all, and a free allowance.
LOOSE_SHARE, FREE_LOOSE = 0.5, 1000
# Components and items may repeat one mesh, or nothing at all, without end: what they may put together besides each mesh
# of the file three times, as where a component holds it, an item that, and nothing is repeated.
MOST_TRIANGLES = 2_000_000
MOST_COMPONENTS = 1 << 14
DEEPEST = 16  # of components within components
BLOCK = 1 << 16
NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")
PART = "cam"


def read_3mf(path: Path | str, heights: Sequence[float] = (), deepest: int = 1) -> Solid:
    """Read the part: the only object that is built, or of several the object named "cam".

    `heights`, mm, become `sections`, and the contour is that of the first. Without any it is that of the section at
    half the part's height, or where a part has steps of the widest section midway between two of them. In a section a
    closed chain may lie inside `deepest` others. A place on the plate that only turns and shifts the part is passed
    over; one that scales, shears or mirrors it is applied.

    Raises OSError where the file cannot be read; ReadError for a file that is too large, damaged or no 3MF, several
    objects none or more of which are named "cam", bodies apart, a height beyond the part, and a section that does not
    close or is not one contour with holes.
    """
    path = Path(path)
    corners, form, mm = read_part(path)
    return replace(solid_of(corners, form, heights, path, deepest), units_mm=mm)


def read_part(path: Path) -> Triangles:
    """Read the triangles of the part, which `read_3mf` finds, mm; raises as it does, but for what a section lacks."""
    built = read_placed(path)
    named = [placed for placed in built if placed.name == PART]
    chosen = built if len(built) == 1 else named
    if len(chosen) != 1:
        names = ", ".join(repr(short(placed.name)) for placed in built[:8])
        message = f"{len(built)} objects are built, {names}: one of them should be named {PART!r}"
        raise ReadError("several" if built else "empty", message if built else "no object is built", path)
    placed = chosen[0]
    corners = placed.corners if placed.rigid else _moved(placed.corners, placed.place)
    return Triangles(corners, "3mf", placed.mm)


def read_3mf_bodies(path: Path | str, sought: Sequence[Sought]) -> list[Solid]:
    """Read as many objects as are sought, the lowest first by the middle of its height.

    Objects stand in the axes of the lowest, or on the plate where that one's place scales, shears or mirrors it. Where
    an object does not reach a height it has no such section.

    Raises OSError where the file cannot be read; ReadError for a file that is too large, damaged or no 3MF, more or
    fewer objects, and a section that does not close or is not one contour with holes.
    """
    path = Path(path)
    built = read_placed(path)
    if len(built) < len(sought):
        raise missing(len(built), len(sought), path)
    if len(built) > len(sought):
        names = ", ".join(repr(body.name) for body in built[:8])
        raise ReadError("several", f"{len(built)} objects are built, {names}, where {len(sought)} are expected", path)
    rising = sorted(built, key=lambda body: sum(_ends(_moved(body.corners, body.place))))
    base = rising[0].place if rising[0].rigid else np.vstack([np.eye(3), np.zeros(3)])
    # places are composed with the inverse of the lowest object's place
    back = np.linalg.inv(base[:3])
    solids = []
    for body, (heights, deepest) in zip(rising, sought, strict=True):
        turn, shift = body.place[:3] @ back, (body.place[3] - base[3]) @ back
        if bool((np.abs(turn - np.eye(3)) <= RIGID).all()):
            turn = np.eye(3)  # what stands upright does so to the last bit
        corners = _moved(body.corners, np.vstack([turn, shift]))
        low, high = _ends(corners)
        solid = solid_of(corners, "3mf", [z for z in heights if low < z < high], path, deepest)
        solids.append(replace(solid, units_mm=body.mm))
    return solids


def separate_bodies(path: Path) -> list[SeparateBody]:
    """Objects that are built, each in axes of its own unless its place scales, shears or mirrors it, with its name.

    Raises as `read_placed` does.
    """
    bodies = []
    for placed in read_placed(path):
        corners = placed.corners if placed.rigid else _moved(placed.corners, placed.place)
        points = corners.reshape(-1, 3)
        box = points.min(axis=0), points.max(axis=0)
        bodies.append(SeparateBody(placed.name, box, partial(_body, corners, placed.mm, path)))
    return bodies


def _body(corners: Array, mm: float, path: Path, heights: Sequence[float], deepest: int) -> Solid:
    return replace(solid_of(corners, "3mf", heights, path, deepest), units_mm=mm)


def _ends(corners: Array) -> tuple[float, float]:
    """Least and greatest height of triangles (t, 3, 3)."""
    z = corners[:, :, 2]
    return float(z.min()), float(z.max())


def read_placed(path: Path | str) -> tuple[Placed, ...]:
    """Read every object that is built, in the order of the build, mm; objects that are not models are left out.

    Raises OSError where the file cannot be read; ReadError for a file that is too large, damaged or no 3MF, and for an
    object that is empty, out of range or of too many triangles.
    """
    path = Path(path)
    if problem := oversize(path, "3mf"):
        raise ReadError("range", problem, path)
    try:
        with zipfile.ZipFile(path) as archive:
            links = _Links()
            _parse(archive, "_rels/.rels", links.start, None, path)
            if len(links.targets) != 1:
                raise ReadError("syntax", f"the archive names {len(links.targets)} models, where one should be", path)
            model = _Model(path)
            _parse(archive, links.targets[0].lstrip("/"), model.start, model.end, path)
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError, EOFError, OSError) as error:
        if isinstance(error, OSError) and error.errno != errno.EINVAL:  # which is a place before the file's beginning
            raise
        raise ReadError("syntax", "not a sound 3MF file: its archive is damaged, or has a password", path) from error
    return model.placed()


def _parse(
    archive: zipfile.ZipFile,
    name: str,
    start: Callable[[str, dict[str, str]], None],
    end: Callable[[str], None] | None,
    path: Path,
) -> None:
    """Run a member of the archive through a parser, block by block."""

    def refuse(*_: object) -> None:
        raise ReadError("unsupported", f"{name} has a document type of its own", path)

    parser = expat.ParserCreate(namespace_separator=" ")
    parser.StartDoctypeDeclHandler = refuse
    parser.StartElementHandler = start
    if end is not None:
        parser.EndElementHandler = end
    if name not in archive.namelist():
        raise ReadError("syntax", f"the archive has no {name}", path)
    try:
        with archive.open(name) as stream:
            packed = archive.getinfo(name).compress_size
            _feed(parser, stream, min(MOST_BYTES, MOST_UNPACKED * packed + FREE_BYTES), name, path)
    except ReadError:
        raise
    except (expat.ExpatError, LookupError, ValueError) as error:  # the last two of an encoding that expat does not have
        raise ReadError("syntax", f"{name} is not sound: {xml_fault(error)}", path) from error


def _feed(parser: expat.XMLParserType, stream: IO[bytes], most: int, name: str, path: Path) -> None:
    size = 0
    while block := stream.read(BLOCK):
        size += len(block)
        if size > most:
            bound = f"{MOST_UNPACKED} times its packed size and {FREE_BYTES} bytes, and {MOST_BYTES} in all, are read"
            raise ReadError("range", f"{name} unpacks to more than {most} bytes: {bound}", path)
        parser.Parse(block, False)
    parser.Parse(b"", True)


class _Links:
    """The models that an archive names."""

    def __init__(self) -> None:
        self.targets: list[str] = []

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        if tag == LINK and attributes.get("Type") == MODEL:
            self.targets.append(attributes.get("Target", ""))


@dataclass()
class _Object:
    """An object as it stands in the file, in the file's unit: a mesh, or components by name and place (4, 3)."""

    name: str
    printed: bool
    points: array[float] = field(default_factory=lambda: array("d"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    components: list[tuple[str, Array]] = field(default_factory=list)
    whole: Array | None = None  # its triangles with those of its components, once they are put together
    under: int = 0  # components of that, and theirs


class _Model:
    """A model, filled in as the parser meets its elements; `mm` is the length of its unit."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.mm: float | None = None
        self.objects: dict[str, _Object] = {}
        self.current: _Object | None = None
        self.items: list[tuple[str, Array]] = []
        self.components = 0  # that have been put together
        self.room = 0  # triangles that may still be put together

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        if tag == f"{CORE}vertex":
            self._open().points.extend([self._number(attributes, name) for name in ("x", "y", "z")])
        elif tag == f"{CORE}triangle":
            self._open().corners.extend([self._whole(attributes, name) for name in ("v1", "v2", "v3")])
        elif tag == f"{CORE}model":
            self._begin(attributes)
        elif tag == f"{CORE}object":
            name = attributes.get("id", "")
            if name in self.objects:
                raise self._fault(f"object {short(name)!r} is there twice")
            self.current = _Object(attributes.get("name", ""), attributes.get("type", "model") == "model")
            self.objects[name] = self.current
        elif tag == f"{CORE}component":
            self._open().components.append((attributes.get("objectid", ""), self._place(attributes)))
        elif tag == f"{CORE}item":
            self.items.append((attributes.get("objectid", ""), self._place(attributes)))

    def end(self, tag: str) -> None:
        if tag == f"{CORE}object":
            self.current = None

    def placed(self) -> tuple[Placed, ...]:
        """Every object that is built and printed, in mm.

        Raises ReadError where there is no model, or an object is empty, out of range or of too many triangles.
        """
        if self.mm is None:
            raise self._fault("there is no model in it")
        objects = []
        # besides each mesh of the file three times: `corners` has three entries for each of its triangles
        self.room = MOST_TRIANGLES + sum(len(item.corners) for item in self.objects.values())
        for name, place in self.items:
            item = self._named(name)
            if not item.printed:
                continue
            corners = self._corners(item, 0)
            self._demand_room(len(corners))
            corners = corners * self.mm
            if not len(corners):
                raise ReadError("empty", f"object {short(item.name or name)!r} holds no triangles", self.path)
            placing = np.concatenate((place[:3], self.mm * place[3:]))
            if not all(bool((np.abs(numbers) <= LARGEST).all()) for numbers in (corners, placing)):
                raise ReadError("range", f"object {short(item.name or name)!r} reaches out of range", self.path)
            objects.append(Placed(item.name, corners, placing, self.mm))
        return tuple(objects)

    def _demand_room(self, triangles: int = 0) -> None:
        """Count triangles that are put together; raise ReadError for more of them, or of components, than are read."""
        self.room -= triangles
        if self.room < 0 or self.components > MOST_COMPONENTS:
            most = f"more than {MOST_TRIANGLES} triangles or {MOST_COMPONENTS} components"
            raise ReadError("range", f"{most}, those that repeat an object counted", self.path)

    def _corners(self, item: _Object, depth: int) -> Array:
        """Triangles (t, 3, 3) of an object and all its components, in the file's unit."""
        if depth > DEEPEST:
            raise ReadError("unsupported", f"components lie more than {DEEPEST} deep, or hold themselves", self.path)
        if item.whole is not None:
            self.components += item.under
            return item.whole
        before = self.components
        points = np.array(item.points, dtype=np.float64).reshape(-1, 3)
        corners: Indices = np.array(item.corners, dtype=np.intp).reshape(-1, 3)
        if not bool((corners < len(points)).all()):
            raise self._fault(f"a triangle has a corner that is none of the {len(points)} vertices")
        self._demand_used(item, len(points), corners)
        parts = [points[corners]]
        for name, place in item.components:
            self.components += 1
            self._demand_room()
            part = self._corners(self._named(name), depth + 1)
            self._demand_room(len(part))
            parts.append(_moved(part, place))
        item.whole, item.under = np.concatenate(parts), self.components - before
        return item.whole

    def _demand_used(self, item: _Object, count: int, corners: Indices) -> None:
        """Raise ReadError for a mesh of `count` vertices most of which no triangle has."""
        used = np.zeros(count, dtype=bool)
        used[corners.ravel()] = True
        loose = count - int(np.count_nonzero(used))
        if loose > FREE_LOOSE + LOOSE_SHARE * count:
            message = (
                f"{loose} of the {count} vertices of object {short(item.name)!r} belong to no triangle; leave them out"
            )
            raise ReadError("range", message, self.path)

    def _begin(self, attributes: dict[str, str]) -> None:
        unit = attributes.get("unit", "millimeter")
        if unit not in UNIT_MM:
            raise ReadError("unsupported", f"the unit {short(unit)!r}", self.path)
        if attributes.get("requiredextensions", "").split():
            message = f"it requires extensions, {short(attributes['requiredextensions'])!r}: export it without"
            raise ReadError("unsupported", message, self.path)
        self.mm = UNIT_MM[unit]

    def _open(self) -> _Object:
        if self.current is None:
            raise self._fault("a mesh that is in no object")
        return self.current

    def _named(self, name: str) -> _Object:
        if name not in self.objects:
            raise self._fault(f"there is no object {short(name)!r}")
        return self.objects[name]

    def _number(self, attributes: dict[str, str], name: str) -> float:
        text = attributes.get(name, "")
        if not NUMBER.fullmatch(text):
            raise self._fault(f"{name}={short(text)!r} is not a number")
        if not abs(float(text)) <= LARGEST:
            raise ReadError("range", f"{name}={short(text)!r} is out of range", self.path)
        return float(text)

    def _whole(self, attributes: dict[str, str], name: str) -> int:
        text = attributes.get(name, "")
        if not (text.isascii() and text.isdecimal() and len(text) < 18):
            raise self._fault(f"{name}={short(text)!r} is not the number of a vertex")
        return int(text)

    def _place(self, attributes: dict[str, str]) -> Array:
        words = attributes.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0").split()
        if len(words) != 12 or not all(NUMBER.fullmatch(word) for word in words):
            raise self._fault(f"transform={short(attributes['transform'])!r} is not twelve numbers")
        place = np.array(words, dtype=np.float64).reshape(4, 3)
        if not bool((np.abs(place) <= LARGEST).all()):
            raise ReadError("range", f"transform={short(attributes['transform'])!r} is out of range", self.path)
        if np.linalg.det(place[:3]) == 0.0:
            raise self._fault(f"transform={short(attributes['transform'])!r} is flat")
        return place

    def _fault(self, message: str) -> ReadError:
        return ReadError("syntax", message, self.path)


def _moved(corners: Array, place: Array) -> Array:
    """Triangles (t, 3, 3) in a place (4, 3); corners of mirrored ones are reversed, so that they still face outward."""
    moved: Array = corners @ place[:3] + place[3]
    return moved if np.linalg.det(place[:3]) > 0.0 else moved[:, ::-1]
