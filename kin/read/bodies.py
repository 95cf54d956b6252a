"""Solids as files of any format hold them, the sections sought of each, and errors for a wrong number of solids."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.records import dataclass, field, replace
from kin.read.errors import ReadError
from kin.read.nesting import Nest, scaled

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path
    from typing import Self

    from kin.numeric.arrays import Array

MOST_BODIES = 5  # that are named in a message
RIGID = 1e-9  # a place turns and shifts only if its axes are square and of length 1 within this


def no_rows(columns: int) -> Array:
    """Empty array (0, columns), as for the leaning walls of a solid that has none."""
    return np.empty((0, columns))


@dataclass(frozen=True, eq=False)
class Section(Nest):
    """Section of a solid at a height, mm: its closed chains."""

    height: float


@dataclass(frozen=True, eq=False, kw_only=True)
class ReadSolid(Nest):
    """A part as a file of any format holds it, mm.

    chains              of the section at `height`
    z_min, z_max        least and greatest height
    height              at which the section was taken
    prism               the walls stand upright from the lowest face to the highest one, to the file's rounding
    volume              mm^3, negative if the surface faces inward
    sections            at the heights given to the reader, in their order; one of several bodies has none at heights
                        that it does not reach
    faces               heights of the horizontal faces, rising
    leaning             triangles or faces neither horizontal nor upright (k, 4): least and greatest height, reach from
                        the axis, mm, and mm that they go inward per mm of height, nan for a STEP file
    slivers             walls that lean no farther than the file's rounding explains (k, 4): least and greatest height,
                        reach from the axis, and greatest distance from the upright, mm
    rounding            mm by which heights that should be equal may differ through that rounding; 0 in a prism or STEP
    units_mm            length of the file's unit, None where it states none
    """

    z_min: float
    z_max: float
    height: float
    prism: bool
    volume: float
    sections: tuple[Section, ...]
    faces: tuple[float, ...]
    leaning: Array
    slivers: Array = field(default_factory=partial(no_rows, 4))
    rounding: float = 0.0
    units_mm: float | None = None

    def section(self, z: float) -> Section:
        """Section at a height z, mm, that was given to the reader; raises ValueError for any other height."""
        for cut in self.sections:
            if cut.height == z:
                return cut
        raise ValueError(f"no section was taken at z = {z:.9g} mm")

    @property
    def thickness(self) -> float:
        """Height of the part, mm."""
        return self.z_max - self.z_min

    @property
    def uneven(self) -> float:
        """Greatest distance, mm, by which the file's rounding holds a wall off the upright; 0 without such walls."""
        return self.uneven_between(-np.inf, np.inf)

    def uneven_between(self, low: float, high: float, beyond: float = 0.0) -> float:
        """Greatest distance from the upright, mm, of `slivers` between `low` and `high` that reach `beyond`; else 0.

        `low` and `high` are heights, mm; `beyond` is a distance from the axis, mm.
        """
        rows = self.slivers
        chosen = (rows[:, 0] < high) & (rows[:, 1] > low) & (rows[:, 2] >= beyond)
        return float(rows[chosen, 3].max(initial=0.0))

    def in_units(self, heights: Sequence[float], units: float) -> Self:
        """The solid, read as if its file were in mm with sections at z / `units` for each of `heights`, mm, in mm.

        `units`, mm, is the length of its unit.
        """
        own = {z / units: z for z in heights}  # to the last bit, by which sections are looked up
        return replace(
            self,
            chains=scaled(self.chains, units),
            z_min=units * self.z_min,
            z_max=units * self.z_max,
            height=units * self.height,
            volume=units**3 * self.volume,
            sections=tuple(Section(scaled(cut.chains, units), own[cut.height]) for cut in self.sections),
            faces=tuple(units * z for z in self.faces),
            leaning=self.leaning * [units, units, units, 1.0],
            slivers=units * self.slivers,
            rounding=units * self.rounding,
        )

    def lowered(self, heights: Sequence[float], level: float) -> Self:
        """The solid with its heights counted from a level, mm.

        Its sections are at `level` + z for z among `heights`, mm above that level.
        """
        own = {level + z: z for z in heights}  # to the last bit
        return replace(
            self,
            z_min=self.z_min - level,
            z_max=self.z_max - level,
            height=self.height - level,
            sections=tuple(Section(cut.chains, own[cut.height]) for cut in self.sections),
            faces=tuple(z - level for z in self.faces),
            leaning=self.leaning - [level, level, 0.0, 0.0],
            slivers=self.slivers - [level, level, 0.0, 0.0],
        )


class Placed(NamedTuple):
    """A mesh in a file: its triangles (t, 3, 3), mm, in axes of its own, and its place on the plate.

    `place` (4, 3) has the images of the three axes and of the origin, mm, as rows; `mm` is the length of the file's
    unit.
    """

    name: str
    corners: Array
    place: Array
    mm: float = 1.0

    @property
    def rigid(self) -> bool:
        """Whether the place turns and shifts the object and does nothing else to it."""
        turn = self.place[:3]
        return bool((np.abs(turn @ turn.T - np.eye(3)) <= RIGID).all() and np.linalg.det(turn) > 0.0)


class SeparateBody(NamedTuple):
    """One of several bodies of a file: its name, its box, and what reads it.

    The box is its least and greatest coordinates (3,), in the file's unit or, where it states one, mm; None where it
    cannot be read. `read` takes heights of sections and how many others a chain may lie inside, and gives the solid, in
    the same unit (`heights`, `deepest`); it raises ReadError as the reader of a file with that body alone does.
    """

    name: str
    box: tuple[Array, Array] | None
    read: Callable[..., ReadSolid]


class Sought(NamedTuple):
    """Sections sought of one body, at heights, mm.

    `deepest` is the number of other closed chains that a chain may lie inside.
    """

    heights: Sequence[float] = ()
    deepest: int = 1


def demand_reached(low: float, high: float, heights: Sequence[float], path: Path, why: str = "") -> None:
    """Raise ReadError for the first of `heights` that a part from `low` to `high`, all mm, does not reach.

    Its message ends with the words `why`, if there are any.
    """
    for z in heights:
        if not low < z < high:
            message = f"the part reaches from z = {low:.9g} to {high:.9g} mm: it has no section at {z:.9g}"
            raise ReadError("height", "; ".join(filter(None, [message, why])), path)


def missing(count: int, expected: int, path: Path) -> ReadError:
    """Make the error for a file that holds `count` bodies, fewer than are expected."""
    holds = f"it holds {count} {'body' if count == 1 else 'bodies'}, where {expected} are expected"
    return ReadError("several", f"{holds}, one above the other", path)


def beside(
    bodies: Sequence[tuple[str, tuple[Array, Array] | None]], count: int, path: Path, expected: int = 1
) -> ReadError:
    """Make the error for a file that holds `count` bodies, more than are expected.

    `bodies` are some of them, at least one: name, and least and greatest coordinates (3,), (3,), mm, None if unknown.
    Where one is expected, the body with the largest box is taken for the part, and the message asks for the others to
    be taken out.
    """
    if expected > 1:
        named = "; ".join(described(*body) for body in bodies)
        return ReadError("several", f"it holds {count} bodies, where {expected} are expected: {named}", path)
    sizes = [-1.0 if box is None else float(np.prod(box[1] - box[0])) for _, box in bodies]
    part = int(np.argmax(sizes))
    others = [described(*body) for k, body in enumerate(bodies) if k != part]
    more = f", and {count - len(bodies)} more" if count > len(bodies) else ""
    name = bodies[part][0]
    message = f"it holds {count} bodies, where one is expected; beside {name} there is {'; '.join(others)}{more}"
    return ReadError("several", f"{message}; take out what does not belong", path)


def described(name: str, box: tuple[Array, Array] | None) -> str:
    """Text of a body's name, size and place, by its least and greatest coordinates, mm; its name without a box."""
    if box is None:
        return name
    low, high = box
    size = " x ".join(f"{side:.6g}" for side in (high - low).tolist())
    spans = (f"{axis} {a:.6g} to {b:.6g}" for axis, a, b in zip("xyz", low.tolist(), high.tolist(), strict=True))
    return f"{name} of {size} mm at {', '.join(spans)} mm"
