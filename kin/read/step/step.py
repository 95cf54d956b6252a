"""Parts read back from STEP files: each solid, its sections at any height, its faces, edges and volume.

No CAD kernel is needed: walls are planes, cylinders and cones about upright axes, swept splines, and cylinders about
level ones, as a cam with its hub and set screw has them. The section of each is exact. Anything else, and more solids
than are expected, are refused with the number of the instance.
"""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.distinct import distinct
from kin.numeric.quadrature import gauss
from kin.numeric.records import dataclass, replace
from kin.read.bodies import MOST_BODIES, ReadSolid, Section, SeparateBody, Sought, beside, demand_reached, missing
from kin.read.drawing.drawing import CutEntities, drawing_of
from kin.read.errors import ReadError
from kin.read.formats import DrawingOptions, contents
from kin.read.step.faces import Plane, Tube, edge_faults
from kin.read.step.part21 import exchange
from kin.read.step.shell import faces_of_solid, solid_numbers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array
    from kin.read.drawing.drawing import Drawing
    from kin.read.step.curves import StepEdge, StepFile
    from kin.read.step.faces import Face
    from kin.read.step.part21 import Exchange

SAME = 1e-9  # mm: heights this close are one
GAUSS = 12  # nodes over the height of a level hole
AREA_NODES, AREA_WEIGHTS = gauss(3)  # exact where a section is a cubic in the height


@dataclass(frozen=True, eq=False, kw_only=True)
class StepSolid(ReadSolid):
    """A part as a STEP file holds it, mm; its volume is the integral of its sections' areas.

    faults              in words: edges that do not belong to exactly two faces which run along them opposite ways; arcs
                        that go the wrong way round; lids that look into the solid
    misfit              greatest distance of an edge from its faces, or of its ends from its curve
    schema              name of the file's schema
    """

    faults: tuple[str, ...]
    misfit: float
    schema: str


def read_step(path: Path | str, heights: Sequence[float] = (), deepest: int = 1) -> StepSolid:
    """Read a part from a STEP file.

    `heights`, mm, become `sections`, and the contour is that of the first; without any it is that of the section of
    the largest area midway between two levels of the part. In a section a closed chain may lie inside `deepest` others.

    Raises OSError where the file cannot be read; ReadError for a file that is too large or damaged, what is not read,
    with the number of the instance, a height beyond the part, and a section that is not one closed contour with others
    in it.
    """
    (solid,) = read_step_bodies(path, [Sought(heights, deepest)])
    return solid


def read_step_bodies(path: Path | str, sought: Sequence[Sought]) -> list[StepSolid]:
    """Read as many solids as are sought, the lowest first by the middle of its height.

    Where one of several does not reach a height it has no such section. Raises OSError where the file cannot be read;
    ReadError for a file that is too large or damaged, more or fewer solids, what is not read, a height beyond a single
    solid, and a section that is not one closed contour with others in it.
    """
    path = Path(path)
    bodies = _Body.every(exchange(contents(path, "step"), path), len(sought))
    rising = sorted(bodies, key=lambda body: body.levels[0] + body.levels[-1])
    if len(sought) > 1:
        ends = [(body.levels[0], body.levels[-1]) for body in rising]
        sought = [
            wanted._replace(heights=[z for z in wanted.heights if low < z < high])
            for wanted, (low, high) in zip(sought, ends, strict=True)
        ]
    return [_solid(replace(body, deepest=wanted.deepest), wanted) for body, wanted in zip(rising, sought, strict=True)]


def separate_bodies(path: Path) -> list[SeparateBody]:
    """Solids of a file, in its order, named as it names them.

    Raises OSError where the file cannot be read; ReadError for a file that is too large or damaged, or holds no solid.
    """
    file = exchange(contents(path, "step"), path)
    solids = solid_numbers(file)
    read = partial(_separate, file, alone=len(solids) == 1)
    return [SeparateBody(_Body.name(file, k), _Body.reach(file, k), partial(read, k)) for k in solids]


def _separate(file: Exchange, number: int, heights: Sequence[float], deepest: int, *, alone: bool) -> StepSolid:
    body = replace(_Body.one(file, number, alone=alone), deepest=deepest)
    return _solid(body, Sought(heights, deepest))


def _solid(body: _Body, sought: Sought) -> StepSolid:
    misfit, heights = body.misfit, sought.heights
    demand_reached(body.levels[0], body.levels[-1], heights, body.space.file.path)
    cuts = list(heights) or [body.widest()]
    drawings = [body.section(z) for z in cuts]
    sections = [Section(drawing.chains, z) for z, drawing in zip(cuts, drawings, strict=True)]
    first = drawings[0]
    return StepSolid(
        chains=first.chains,
        z_min=body.levels[0],
        z_max=body.levels[-1],
        height=cuts[0],
        prism=body.prism,
        volume=body.volume,
        sections=tuple(sections) if len(heights) else (),
        faces=tuple(distinct(np.array([face.heights[0] for face in body.lids])).tolist()),
        leaning=np.array([(*face.heights, face.reach, np.nan) for face in body.faces if face.leans]).reshape(-1, 4),
        faults=tuple(body.faults),
        misfit=misfit,
        schema=body.space.file.schema,
        units_mm=body.space.mm,
    )


@dataclass(frozen=True, eq=False)
class _Body:
    """The faces and edges of one solid, and the heights of its corners and level holes, mm, rising."""

    space: StepFile
    faces: list[Face]
    edges: dict[int, StepEdge]
    levels: list[float]
    deepest: int = 1

    @staticmethod
    def name(file: Exchange, solid: int) -> str:
        """Name of a solid, or its number where it has none."""
        given = next((values[0] for values in file.instances[solid].values() if values), "")
        return given if isinstance(given, str) and given else f"solid #{solid}"

    @staticmethod
    def every(file: Exchange, count: int) -> list[_Body]:
        """Read all solids of a file; raises ReadError where they are not `count`, or one is not read."""
        solids = solid_numbers(file)
        if len(solids) < count:
            raise missing(len(solids), count, file.path)
        if len(solids) > count:
            boxes = [(f"solid #{number}", _Body.reach(file, number)) for number in solids[:MOST_BODIES]]
            raise beside(boxes, len(solids), file.path, expected=count)
        return [_Body.one(file, solid, alone=count == 1) for solid in solids]

    @staticmethod
    def reach(file: Exchange, solid: int) -> tuple[Array, Array] | None:
        """Box of a solid that may not be sound, None where it cannot be read."""
        with suppress(ReadError):
            return _Body.one(file, solid).box
        return None

    @staticmethod
    def one(file: Exchange, solid: int, *, alone: bool = True) -> _Body:
        space, faces, edges = faces_of_solid(file, solid, alone=alone)
        z = [float(place[2]) for edge in edges.values() for place in (edge.start, edge.end)]
        for face in faces:
            if isinstance(face.surface, Tube):
                z += [face.surface.point[2] - face.surface.radius, face.surface.point[2] + face.surface.radius]
        rising = np.sort(np.array(z))
        levels = rising[np.diff(rising, prepend=-np.inf) > SAME].tolist()
        if len(levels) < 2:
            raise ReadError("empty", f"the part is flat: all corners lie at z = {rising[0]:g}", file.path)
        return _Body(space, faces, edges, levels)

    @property
    def box(self) -> tuple[Array, Array]:
        """Least and greatest coordinates (3,) of its edges."""
        points = np.concatenate([edge.samples for edge in self.edges.values()])
        return points.min(axis=0), points.max(axis=0)

    @property
    def lids(self) -> list[Face]:
        """Faces that lie in horizontal planes."""
        return [face for face in self.faces if face.surface.level]

    @property
    def prism(self) -> bool:
        """Whether all walls stand upright over the whole height."""
        return len(self.levels) == 2 and all(face.surface.level or face.surface.upright for face in self.faces)

    def widest(self) -> float:
        """Height, mm, midway between two levels, at which the section has the largest area."""
        middles = [0.5 * (low + high) for low, high in zip(self.levels[:-1], self.levels[1:], strict=True)]
        return max(middles, key=self._area) if len(middles) > 1 else middles[0]

    def section(self, z: float) -> Drawing:
        """Contour and holes at height z, mm.

        Raises ReadError where no face reaches through that height, or the section is not one contour with holes.
        """
        entities = CutEntities([], [], [], Counter(), [])
        for face in self.faces:
            for piece in face.section(self.space, z):
                entities.shapes.append(piece)
                entities.names.append(f"face #{face.number}")
                entities.layers.append("STEP")
        path = self.space.file.path
        if not entities.shapes:
            raise ReadError("open", f"no face reaches through z = {z:.9g} mm", path)
        options = DrawingOptions(self.space.accuracy, deepest=self.deepest)
        return drawing_of(entities, None, None, path, options, version="STEP")

    def _area(self, z: float) -> float:
        cut = self.section(z)
        metal, free = (sum(chain.contour.area for chain in cut.chains if chain.depth % 2 == odd) for odd in (0, 1))
        return metal - free

    @property
    def volume(self) -> float:
        """Volume, mm^3: the integral of the sections' area, exact but for layers that a level hole runs through."""
        tubes = [face.surface for face in self.faces if isinstance(face.surface, Tube)]
        total = 0.0
        for low, high in zip(self.levels[:-1], self.levels[1:], strict=True):
            tube = next(
                (surface for surface in tubes if abs(0.5 * (low + high) - surface.point[2]) < surface.radius), None
            )
            if tube is not None:
                total += self._volume_round(tube, low, high)
            elif self._same_between(low, high):
                total += (high - low) * self._area(0.5 * (low + high))
            else:
                heights = 0.5 * (low + high) + 0.5 * (high - low) * AREA_NODES
                areas = np.array([self._area(float(z)) for z in heights])
                total += 0.5 * (high - low) * float(AREA_WEIGHTS @ areas)
        return total

    def _same_between(self, low: float, high: float) -> bool:
        reaching = [face for face in self.faces if face.heights[0] < high - SAME and face.heights[1] > low + SAME]
        return all(face.surface.level or face.surface.upright for face in reaching)

    def _volume_round(self, tube: Tube, low: float, high: float) -> float:
        """Volume of a layer that a level hole runs through: its width is smooth in the angle about its axis."""
        node, weight = gauss(GAUSS)
        first, last = np.arcsin(np.clip((np.array([low, high]) - tube.point[2]) / tube.radius, -1.0, 1.0))
        angle: Array = 0.5 * (first + last) + 0.5 * (last - first) * node
        areas = np.array([self._area(float(z)) for z in tube.point[2] + tube.radius * np.sin(angle)])
        return float(0.5 * (last - first) * tube.radius * np.sum(weight * areas * np.cos(angle)))

    @property
    def faults(self) -> list[str]:
        """Faults in words, with their numbers: a closed solid whose faces look outward has none."""
        faults = edge_faults(self.faces)
        faults += [
            f"face #{face.number} lies on the wrong side of its bounds" for face in self.faces if face.inside_out
        ]
        for lid in self.lids:
            z = lid.heights[0]
            normal = lid.surface.normal[2] if isinstance(lid.surface, Plane) else 0.0
            up = (normal > 0.0) == lid.outward
            if (abs(z - self.levels[0]) <= SAME and up) or (abs(z - self.levels[-1]) <= SAME and not up):
                faults.append(f"face #{lid.number} at z = {z:.9g} mm looks into the solid")
        return faults

    @cached_property
    def misfit(self) -> float:
        """Greatest distance of an edge from its faces, or of its ends from its curve, mm.

        Raises ReadError, with the number of the edge or face, where that is more than the file's own accuracy.
        """
        off = {edge.number: edge.misfit for edge in self.edges.values()}
        off |= {face.number: face.misfit for face in self.faces}
        worst = max(off, key=lambda number: off[number])
        if off[worst] > self.space.accuracy:
            problem = "ends beside its curve" if worst in self.edges else "is bounded by edges beside its surface"
            message = f"{problem} by {off[worst]:.3g} mm, permitted is {self.space.accuracy:.3g}"
            raise self.space.file.error(worst, message, "gap")
        return off[worst]
