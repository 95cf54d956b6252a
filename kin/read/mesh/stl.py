"""Plain parts from STL files, binary or text: the mesh checked, the contour and the holes of its section."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.contour.contour import Contour
from kin.contour.intersections import first_meeting
from kin.numeric.distinct import distinct
from kin.numeric.places import place_text
from kin.numeric.records import dataclass
from kin.read.bodies import MOST_BODIES, ReadSolid, Section, SeparateBody, demand_reached, no_rows
from kin.read.errors import ReadError
from kin.read.mesh.checked import boxes_of, ends, several_bodies
from kin.read.mesh.mesh import WordError, doubles, fault_words, welded
from kin.read.mesh.prism import Outline, evened, rounding, upright, walls
from kin.read.nesting import ClosedContour, counter_clockwise, demand_few, met, nested

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array, Indices
    from kin.read.mesh.checked import Form
    from kin.read.mesh.mesh import EdgeFaults, Mesh
    from kin.read.mesh.prism import Corners

HEADER = 84
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
# What stands in the 21 words of a facet in text form, where it is not a number.
FACET = {0: b"facet", 1: b"normal", 5: b"outer", 6: b"loop", 7: b"vertex", 11: b"vertex", 15: b"vertex"}
FACET |= {19: b"endloop", 20: b"endfacet"}
NEXT_SOLID = re.compile(rb"endsolid[^\n]*\n\s*solid[^\n]*\n")
WORDS = 21
LONGEST_WORD = 40
SPACES = str.maketrans("", "", "\r\n\t")
NUMBERS = [8, 9, 10, 12, 13, 14, 16, 17, 18]
# Share of a section's extent within which a point is on the straight between its neighbours, and of a part's heights
# within which a corner lies in the plane of a section: some roundings of doubles.
STRAIGHT = 1e-13
# Sections that are looked at for the widest one.
MOST_STEPS = 8
# What a section is found to be where there is more than one body.
NOT_ONE = frozenset({"several", "island", "crossing"})


@dataclass(frozen=True, eq=False, kw_only=True)
class Solid(ReadSolid):
    """A part as a file of triangles holds it, mm; its walls are upright to the rounding of `kin.read.mesh.prism`.

    triangles           number of triangles
    edges               faults of the edges; all three numbers are zero for a closed, oriented mesh
    degenerate          number of triangles without area
    duplicate           number of triangles with the corners of a triangle before
    form                "binary" or "text", or "3mf"
    """

    triangles: int
    edges: EdgeFaults
    degenerate: int
    duplicate: int
    form: Form

    @property
    def faults(self) -> tuple[str, ...]:
        """Faults in words, with their numbers: a closed, oriented mesh that faces outward has none."""
        return fault_words(self.edges, self.degenerate, self.duplicate, self.volume)


def solid_of(corners: Corners, form: Form, heights: Sequence[float], path: Path, deepest: int = 1) -> Solid:
    """Make the part of triangles (t, 3, 3), mm.

    `heights`, mm, become `sections`, and the contour is that of the first. Without any it is that of the section at
    half the part's height, or where a part has steps of the widest section midway between two of them. In a section a
    closed chain may lie inside `deepest` others.

    Raises ReadError for coordinates out of range, a flat part, bodies apart, a height beyond the part, and a section
    that does not close or is not one contour with holes.
    """
    *_, (z_min, z_max) = ends(corners, path)
    demand_reached(z_min, z_max, heights, path)
    shell = upright(corners)
    mesh_in_file, leaning, slivers = (
        shell.mesh,
        no_rows(4),
        no_rows(4),
    )  # faults are those of the mesh as it is in the file
    # a prism to the bit, else after rounding is taken out of its corners, else walls that may lean
    apart = 0.0
    if not shell.prism:
        moved = evened(corners)
        evened_shell = None if moved is None else upright(moved.corners)
        if moved is not None and evened_shell is not None and evened_shell.prism:
            corners, slivers, shell = moved.corners, np.array([[z_min, z_max, np.inf, moved.by]]), evened_shell
    mesh, outline = shell.mesh, shell.outline
    if not shell.prism:
        _refuse_apart(mesh_in_file, path, deepest)
        apart = 2.0 * rounding(corners)
        leaning, slivers = walls(mesh, apart)
    # a prism with corners at two heights has its bottom's outline as every section
    height = heights[0] if len(heights) else (z_min + z_max) / 2.0
    prism_outline = outline
    z = corners[:, :, 2]
    levels = distinct(z[(z == z[:, :1]).all(axis=1), 0].astype(np.float64))
    if outline is None:
        steps = no_rows(0) if len(heights) else _steps(corners, apart)
        height = widest(mesh, steps, path) if len(steps) > 2 else height
        outline = cut(mesh, height, path)
    try:
        chains = sectioned(outline, path, deepest, across=prism_outline is None)
    except ReadError as error:
        raise _named_bodies(mesh_in_file, error, path) from None
    sections = [
        Section(
            sectioned(cut(mesh, wanted, path), path, deepest, across=True) if prism_outline is None else chains,
            wanted,
        )
        for wanted in heights
    ]
    return Solid(
        chains=chains,
        z_min=z_min,
        z_max=z_max,
        height=height,
        prism=shell.prism,
        volume=mesh_in_file.volume,
        triangles=len(mesh_in_file.corners),
        edges=mesh_in_file.edge_faults,
        degenerate=mesh_in_file.degenerate,
        duplicate=mesh_in_file.duplicate,
        form=form,
        sections=tuple(sections),
        faces=tuple(levels.tolist()),
        leaning=leaning,
        slivers=slivers,
        rounding=apart,
    )


def bodies_of(corners: Corners, form: Form, path: Path) -> list[SeparateBody]:
    """Bodies of triangles (t, 3, 3) that share corners, in the order of the file; raises ReadError as `solid_of`."""
    ends(corners, path)
    mesh = welded(corners)
    numbers = mesh.bodies
    reads = [partial(_body, corners[numbers == k], form, path) for k in range(int(numbers.max()) + 1)]
    return [
        SeparateBody(f"body {k + 1}", box, read)
        for k, (box, read) in enumerate(zip(boxes_of(mesh, numbers), reads, strict=True))
    ]


def _body(corners: Corners, form: Form, path: Path, heights: Sequence[float], deepest: int) -> Solid:
    return solid_of(corners, form, heights, path, deepest)


def _steps(corners: Corners, apart: float) -> Array:
    """Heights (k,), rising, of triangles (t, 3, 3) that are level within `apart`, mm; heights as near count once."""
    z = corners[:, :, 2]
    levels: Array = np.sort(z[np.ptp(z, axis=1) <= apart].mean(axis=1, dtype=np.float64))
    return levels[np.diff(levels, prepend=-np.inf) > apart]


def _named_bodies(mesh: Mesh, error: ReadError, path: Path) -> ReadError:
    """Return an error on a section as it is, or where there are several closed bodies an error that names them."""
    if error.reason not in NOT_ONE or mesh.edge_faults.open or not mesh.bodies.any():
        return error
    return several_bodies(boxes_of(mesh, mesh.bodies), path)


def _refuse_apart(mesh: Mesh, path: Path, deepest: int) -> None:
    """Raise ReadError for a closed mesh with a body apart from the rest, above or beside it or in one of its holes."""
    if mesh.edge_faults.open or not mesh.bodies.any():
        return
    boxes = boxes_of(mesh, mesh.bodies)
    if len(boxes) > MOST_BODIES:
        raise several_bodies(boxes, path)
    for k, (low, high) in enumerate(boxes):
        others = [box for j, box in enumerate(boxes) if j != k]
        if all(bool((low > above).any() or (high < below).any()) for below, above in others):
            raise several_bodies(boxes, path)
        try:
            sectioned(section(mesh, float(0.5 * (low[2] + high[2]))), path, deepest, across=True)
        except ReadError as error:
            if error.reason in NOT_ONE:
                raise several_bodies(boxes, path) from None


def cut(mesh: Mesh, height: float, path: Path) -> Outline:
    """Outline of the section at a height, mm.

    Raises ReadError where the part does not reach there, or reaches above and below and has no wall there.
    """
    z = mesh.points[:, 2]
    demand_reached(float(z.min()), float(z.max()), [height], path)
    outline = section(mesh, height)
    if not len(outline.points):
        message = f"nothing is at z = {height:.9g} mm, and something above and below: walls are missing between faces"
        raise ReadError("several", message, path)
    return outline


def widest(mesh: Mesh, levels: Array, path: Path) -> float:
    """Height, mm, of the section with the largest box, of those midway between two rising `levels`, mm.

    Of many layers between levels the MOST_STEPS thickest are looked at. Raises ReadError where the part has no wall at
    one of these heights.
    """
    thick = np.argsort(-np.diff(levels), kind="stable")[:MOST_STEPS]
    middles: list[float] = (0.5 * (levels[thick] + levels[thick + 1])).tolist()
    return max(middles, key=lambda height: float(np.prod(np.ptp(cut(mesh, height, path).points, axis=0))))


def sectioned(outline: Outline, path: Path, deepest: int = 1, *, across: bool) -> tuple[ClosedContour, ...]:
    """Closed chains of a section, the outer one first; each lies inside at most `deepest` others.

    `across` says that the section runs across triangles, and not along the edge of a plane face: points on straight
    lines are left out. Raises ReadError for chains that do not close, meet, lie outside the first, are too deep or too
    many.
    """
    loops = [outline.points[ring] for ring in rings(outline, path)]
    demand_few(len(loops), path)
    contours = [Contour.from_vertices(straightened(loop) if across else loop) for loop in loops]
    meeting = first_meeting(contours)
    if meeting:
        raise met(meeting, path)
    order = nested(contours, path, deepest)
    places = ((counter_clockwise(contours[k]), depth, inside) for k, depth, inside in order)
    return tuple(ClosedContour(contour, depth, inside, pieces=len(contour)) for contour, depth, inside in places)


def triangles_of(raw: bytes, path: Path) -> tuple[Corners, Literal["binary", "text"]]:
    """Corners (t, 3, 3) of the triangles, in the file's order and unit, and the form of the file.

    A file of the length that its count of triangles makes is binary, though its header may begin with "solid". Raises
    ReadError for a file that is empty, cut short or none of the format.
    """
    count = int.from_bytes(raw[HEADER - 4 : HEADER], "little") if len(raw) >= HEADER else 0
    expected = HEADER + RECORD.itemsize * count
    if len(raw) >= HEADER and len(raw) == expected:
        if not count:
            raise ReadError("empty", "the file holds no triangles", path)
        return np.frombuffer(raw, RECORD, offset=HEADER)["corners"].copy(), "binary"
    begin = raw[:2000].lower()  # words in capitals are in use too
    if begin.lstrip()[:5] == b"solid" and (b"facet" in begin or b"endsolid" in begin):
        return facets(raw.lower(), path), "text"
    if len(raw) < HEADER:
        raise ReadError("truncated", f"{len(raw)} bytes are not an STL file, whose header alone has {HEADER}", path)
    begin = raw[:HEADER]
    if begin.isascii() and begin.decode("ascii").translate(SPACES).isprintable():
        first = " ".join(begin[:20].decode("ascii").split())
        raise ReadError("syntax", f'not an STL file, neither binary nor text: it begins with "{first}"', path)
    reason = "truncated" if len(raw) < expected else "syntax"
    raise ReadError(reason, f"{count} triangles make a file of {expected} bytes, not {len(raw)}", path)


def facets(raw: bytes, path: Path) -> Array:
    """Corners (t, 3, 3) of the facets of a text in small letters, in the file's order and unit.

    Several solids are taken together. Raises ReadError where the text is empty, cut short, or has a wrong word or
    number.
    """
    # between the lines of solid and endsolid stand facets of 21 words each: a table, whose fixed words are compared
    text = raw.strip()
    body, mark, _ = text.rpartition(b"endsolid")
    if not mark:
        raise ReadError("truncated", "the end mark endsolid is missing", path)
    body = body.partition(b"\n")[2]
    words = NEXT_SOLID.sub(b"\n", body).split()
    if not words:
        raise ReadError("empty", "the file holds no triangles", path)
    if len(words) % WORDS:
        raise ReadError("syntax", f"its facets have {len(words)} words, which is not a multiple of {WORDS}", path)
    longest = max(map(len, words))
    if longest > LONGEST_WORD:
        raise ReadError("syntax", f"a word of {longest} characters", path)
    table = np.array(words).reshape(-1, WORDS)
    for column, word in FACET.items():
        wrong = np.flatnonzero(table[:, column] != word)
        if wrong.size:
            found_word = table[wrong[0], column].decode("latin-1")
            message = f'facet {wrong[0] + 1} has "{found_word}" where "{word.decode("ascii")}" belongs'
            raise ReadError("syntax", message, path)
    coordinates = table[:, NUMBERS].ravel()
    try:
        return doubles(coordinates).reshape(-1, 3, 3)
    except WordError as error:
        facet, coordinate = error.place // len(NUMBERS) + 1, coordinates[error.place].decode("latin-1")
        raise ReadError("syntax", f"facet {facet}: the coordinate {coordinate} is not a number", path) from None


def section(mesh: Mesh, height: float) -> Outline:
    """Outline of the section at a height, mm; where corners or faces lie in its plane, that just above them.

    Each triangle gives an edge from where its boundary comes down through the plane to where it goes up; neighbours
    agree on that point since it belongs to an edge of the mesh, or to a corner in the plane.
    """
    z = mesh.points[:, 2]
    near = STRAIGHT * float(np.abs(z).max())
    above = z > height + near
    high = above[mesh.corners]
    met_by = mesh.corners[high.any(axis=1) & ~high.all(axis=1)]
    after = np.roll(met_by, -1, axis=1)
    rises, falls = ~above[met_by] & above[after], above[met_by] & ~above[after]
    low, top = np.concatenate([[after[falls], met_by[falls]], [met_by[rises], after[rises]]], axis=1)
    top = np.where(z[low] >= height - near, low, top)
    codes, number = np.unique(mesh.code(low, top), return_inverse=True)
    low, top = codes // len(mesh.points), codes % len(mesh.points)
    share = (height - z[low]) / np.where(top == low, np.inf, z[top] - z[low])
    points = mesh.points[low, :2] + share[:, None] * (mesh.points[top] - mesh.points[low])[:, :2]
    start, end = number.reshape(2, -1)
    return Outline(points, start, end)


def straightened(points: Array) -> Array:
    """Ring (n, 2), mm, without points on the straight between their neighbours, where a section cuts diagonals.

    Of two neighbours only one goes at a time: close together at a corner, each may be on a straight to the other.
    """
    slack = STRAIGHT * float(np.abs(points).max())
    while True:
        before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
        chord, offset = after - before, points - before
        length = np.maximum(np.hypot(chord[:, 0], chord[:, 1]), np.finfo(float).tiny)
        off_chord = np.abs(chord[:, 0] * offset[:, 1] - chord[:, 1] * offset[:, 0]) / length
        along = (chord[:, 0] * offset[:, 0] + chord[:, 1] * offset[:, 1]) / length
        out = np.flatnonzero((off_chord <= slack) & (along >= -slack) & (along <= length + slack))
        if len(out):
            out = out[(out % 2 == out[0] % 2) & (out < out[0] + len(points) - 1)]
        if not len(out) or len(points) - len(out) < 3:
            return points
        points = np.delete(points, out, axis=0)


def rings(outline: Outline, path: Path) -> list[Indices]:
    """Point numbers (k,) of each closed ring that the edges form.

    Raises ReadError with the place: "open" where edges do not close, "branch" where a ring touches itself or another.
    """
    points, start, end = outline
    start, end = start[start != end], end[start != end]  # triangles without area leave these
    leaving, arriving = (np.bincount(ends, minlength=len(points)) for ends in (start, end))
    for reason, wrong, problem in (
        ("open", leaving != arriving, "the section is open"),
        ("branch", leaving > 1, "the section touches itself"),
    ):
        if wrong.any():
            x, y = points[np.flatnonzero(wrong)[0]].tolist()
            places = np.count_nonzero(wrong)
            raise ReadError(reason, f"{problem} at {place_text(x, y, digits=9)} mm; {places} such points", path, (x, y))
    following = np.full(len(points), -1, dtype=np.intp)
    following[start] = end
    step = following.tolist()
    seen = bytearray(len(points))
    marks = np.frombuffer(seen, dtype=np.uint8)
    closed = []
    for first in start.tolist():
        if seen[first]:
            continue
        ring = [first]
        point = step[first]
        while point != first:
            ring.append(point)
            point = step[point]
        closed.append(np.array(ring, dtype=np.intp))
        marks[closed[-1]] = 1
    return closed
