"""Solids of a STEP file by their faces: planes, upright cylinders and B-spline surfaces, closed or not; mm."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.bernstein import values_and_slopes
from kin.numeric.quadrature import gauss
from kin.numeric.records import dataclass
from kin.read.bodies import MOST_BODIES, beside
from kin.read.errors import ReadError
from kin.read.formats import contents
from kin.read.step.curves import Conic, Straight
from kin.read.step.faces import Plane, RoundFace, edge_faults, face_of, points_along
from kin.read.step.part21 import exchange
from kin.read.step.patch import Patch
from kin.read.step.space import space_of

if TYPE_CHECKING:
    from pathlib import Path

    from kin.read.step.curves import StepEdge, StepFile
    from kin.read.step.faces import Face
    from kin.read.step.part21 import Exchange

NODES = 8  # of a span, or of an eighth of a circle
PATCH_NODES = 8  # of a patch each way


class Faces(NamedTuple):
    """Faces and edges of a solid, and what the file says of all."""

    space: StepFile
    faces: list[Face]
    edges: dict[int, StepEdge]


def solid_numbers(file: Exchange) -> list[int]:
    """Numbers of the solids of a file; raises ReadError where there is none."""
    solids = [*file.of("MANIFOLD_SOLID_BREP"), *file.of("BREP_WITH_VOIDS"), *file.of("FACETED_BREP")]
    if not solids:
        raise ReadError("empty", "it holds no solid", file.path)
    return solids


def faces_of_solid(file: Exchange, solid: int, *, alone: bool = True, smooth: bool = False) -> Faces:
    """Read the faces of the solid of a number; `smooth` takes B-spline surfaces too.

    Raises ReadError for what is not read.
    """
    kind = file.kind(solid, ("MANIFOLD_SOLID_BREP",), solid)
    shell = file.reference(file.values(solid, kind, 2)[1], solid)
    file.kind(shell, ("CLOSED_SHELL",), solid)
    space = space_of(file, solid, alone=alone)
    edges: dict[int, StepEdge] = {}
    listed = file.several(file.values(shell, "CLOSED_SHELL", 2)[1], shell)
    faces = [face_of(space, file.reference(face, shell), edges, smooth=smooth) for face in listed]
    if not edges:
        raise file.error(shell, "it has no edges", "empty")
    return Faces(space, faces, edges)


@dataclass(frozen=True, eq=False)
class Shell:
    """A solid of planes, upright cylinders and whole B-spline surfaces, by its faces and edges.

    `units_mm` is the length of the file's unit, mm.
    """

    space: StepFile
    faces: list[Face]
    edges: dict[int, StepEdge]

    @property
    def units_mm(self) -> float:
        """Length of the file's unit, mm."""
        return self.space.mm

    def faults(self, tolerance: float) -> list[str]:
        """Faults in words, with numbers: none of a closed shell all of whose faces look out of the solid.

        Edges lie within the tolerance, mm, of the surfaces on both sides.
        """
        faults = edge_faults(self.faces)
        inward = [face.number for face in self.faces if not _lies_left(face)]
        faults += [f"face #{number} lies on the wrong side of its bounds" for number in inward]
        ends = {face.number: _gap(face) for face in self.faces}
        faults += [
            f"face #{number} ends {gap:.3g} mm from a corner of its surface"
            for number, gap in ends.items()
            if not gap <= tolerance
        ]
        off = {number: edge.misfit for number, edge in self.edges.items()}
        off |= {face.number: face.misfit for face in self.faces}
        wide = {number: value for number, value in off.items() if not value <= tolerance}
        faults += [
            f"#{number} lies {value:.3g} mm beside {'its ends' if number in self.edges else 'its edges'}"
            for number, value in wide.items()
        ]
        if not faults and not self.volume > 0.0:
            faults.append(f"the volume is {self.volume:.6g} mm^3: the faces look inward")
        return faults

    @cached_property
    def _measured(self) -> tuple[float, float]:
        volume = area = 0.0
        for face in self.faces:
            sense = 1.0 if face.outward else -1.0
            if isinstance(face.surface, Patch):
                own, size = face.surface.beneath(PATCH_NODES)
                volume, area = volume + sense * own, area + size
            elif isinstance(face.surface, Plane) and face.surface.level:
                own = sum(_swept(edge, forward) for edge, forward in face.uses)
                volume, area = volume + face.surface.point[2] * own, area + abs(own)
            else:
                area += _wall_area(face)
        return volume, area

    @property
    def volume(self) -> float:
        """Volume, mm^3: the integral of z over all that is not upright, as seen from above."""
        return self._measured[0]

    @property
    def area(self) -> float:
        """Area of all faces, mm^2."""
        return self._measured[1]


def read_shell(path: Path) -> Shell:
    """Read the one solid of a STEP file.

    Raises OSError where the file cannot be read; ReadError for a file that is too large or damaged, several solids,
    surfaces that are not read, and faces that take up a part of a B-spline surface alone.
    """
    file = exchange(contents(path, "step"), path)
    solids = solid_numbers(file)
    if len(solids) > 1:
        raise beside([(f"solid #{number}", None) for number in solids[:MOST_BODIES]], len(solids), path)
    read = faces_of_solid(file, solids[0], smooth=True)
    for face in read.faces:
        if isinstance(face.surface, Patch):
            _demand_whole(read.space, face)
        elif not (face.surface.level or face.surface.upright):
            raise file.error(face.number, "is neither level nor upright, nor a B-spline surface")
    return Shell(*read)


def _demand_whole(space: StepFile, face: Face) -> None:
    """Raise ReadError for a face that does not go round all corners of its B-spline surface."""
    if len(face.loops) != 1 or sorted(_rounds(face)) != [0, 1, 2, 3]:
        problem = "does not take up the whole of its B-spline surface, between its four borders"
        raise space.file.error(face.number, problem)


def _rounds(face: Face) -> list[int]:
    """Numbers of the corners of a B-spline surface in the order in which its bound comes by them, each to the nearest.

    Corners are counter-clockwise in the surface's parameters, from 0.
    """
    if not isinstance(face.surface, Patch):
        return []
    corners = face.surface.corners
    ends = np.array([edge.start if forward else edge.end for edge, forward in face.uses])
    nearest = [int(np.argmin(np.linalg.norm(ends - corner, axis=1))) for corner in corners]
    if len(set(nearest)) < len(corners):
        return []
    return [nearest.index(place) for place in sorted(nearest)]


def _gap(face: Face) -> float:
    """Greatest distance, mm, of a corner of a B-spline surface from the ends of its face's edges; 0 of any other."""
    if not isinstance(face.surface, Patch):
        return 0.0
    ends = np.array([edge.start if forward else edge.end for edge, forward in face.uses])
    return max(float(np.linalg.norm(ends - corner, axis=1).min()) for corner in face.surface.corners)


def _lies_left(face: Face) -> bool:
    """Whether a face lies on the left of its bounds, as seen from outside."""
    match face.surface:
        case Patch():
            order = _rounds(face)
            first = order.index(0)
            turned = [*order[first:], *order[:first]]
            return turned == ([0, 1, 2, 3] if face.outward else [0, 3, 2, 1])
        case Plane() | RoundFace():
            return face.enclosed > 0.0
    return False


def _wall_area(face: Face) -> float:
    """Area of an upright face, mm^2, to that of chords."""
    if isinstance(face.surface, RoundFace):
        return abs(face.unrolled) * face.surface.radius
    total = np.zeros(3)
    for edge, forward in face.uses:
        points = points_along(edge, forward)
        total += 0.5 * np.cross(points[:-1], points[1:]).sum(axis=0)
    return float(np.linalg.norm(total))


def _swept(edge: StepEdge, forward: bool) -> float:
    """Integral of (x dy - y dx)/2 along an edge in the sense of a bound, mm^2."""
    node, weight = gauss(NODES)
    share, weight = 0.5 * (node + 1.0), 0.5 * weight
    match edge.curve:
        case Straight():
            (x, y, _), (x1, y1, _) = edge.start, edge.end
            total = 0.5 * float(x * y1 - x1 * y)
        case Conic():
            curve = edge.curve
            parts = 8
            t = curve.first + curve.sweep * ((np.arange(parts)[:, None] + share) / parts).ravel()
            place = curve.centre + np.outer(np.cos(t), curve.u) + np.outer(np.sin(t), curve.v)
            rate = (np.outer(np.cos(t), curve.v) - np.outer(np.sin(t), curve.u)) * curve.sweep
            cross = place[:, 0] * rate[:, 1] - place[:, 1] * rate[:, 0]
            total = 0.5 * float(np.tile(weight, parts) @ cross) / parts
        case _:
            plan = edge.curve.plan
            row, t = np.repeat(np.arange(plan.count), NODES), np.tile(share, plan.count)
            (x, dx), (y, dy), (w, dw) = (values_and_slopes(plan.homogeneous[row, :, k], t) for k in range(3))
            px, py = x / w, y / w
            cross = px * (dy - py * dw) / w - py * (dx - px * dw) / w
            total = 0.5 * float(np.tile(weight, plan.count) @ cross) * (-1.0 if edge.curve.back else 1.0)
    return total if forward else -total
