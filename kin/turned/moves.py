"""Programs for a machine with a rotary axis: moves of X along the drum, A about it, Z square to it, and Y beside both.

Words are those of `kin.read.gcode` without arcs, with A in degrees, and with G93: a feed that is the inverse of a
block's time in minutes, which every block states anew. A machine without Y stands over the axis.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from kin.numeric.records import dataclass
from kin.read.gcode import GROUPS, Machine, follow

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from kin.numeric.arrays import Array


class Position(NamedTuple):
    """Position of the cutter's end, mm, and of the rotary axis, rad."""

    x: float
    y: float
    z: float
    a: float

    def mirrored(self) -> Position:
        """The position beside the mirror image of a drum."""
        return Position(self.x, -self.y, self.z, -self.a)


class TurnMove(NamedTuple):
    """One move, from `start` to `end`, on the line with this number in the file.

    feed     mm a minute, or the inverse of the time in minutes where `inverse`; 0 for a rapid move
    """

    line: int
    rapid: bool
    start: Position
    end: Position
    feed: float
    inverse: bool

    def mirrored(self) -> TurnMove:
        """The move beside the mirror image of a drum."""
        return self._replace(start=self.start.mirrored(), end=self.end.mirrored())


@dataclass(frozen=True)
class TurnedProgram:
    """Moves of a program and its comments, both in order, the mm in its unit, and whether Y moves."""

    path: Path
    moves: tuple[TurnMove, ...]
    units_mm: float
    comments: tuple[str, ...]
    beside: bool


def read_turned(path: Path) -> TurnedProgram:
    """Read a program with a rotary axis A; raises as `kin.read.gcode.read_gcode` does."""
    machine = _Turning(path)
    follow(machine)
    return TurnedProgram(path, tuple(machine.moves), machine.unit, tuple(machine.comments), machine.beside)


class _Turning(Machine):
    """State of a machine whose work turns."""

    letters = "XYZA"
    groups: ClassVar = {
        **{name: codes for name, codes in GROUPS.items() if name != "arc centres"},
        "motion": ("0", "1"),
        "distance": ("90",),
        "feed": ("93", "94"),
    }

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.moves: list[TurnMove] = []  # type: ignore[assignment]
        self.place: dict[str, float] = {}
        self.beside = False

    def _feed(self, number: int, value: float) -> float:
        return value if self.modes.get("feed") == "93" else self._length(number, value)

    def _move(self, number: int, numbers: dict[str, float]) -> None:
        motion = self.modes.get("motion")
        if motion is None or "distance" not in self.modes:
            raise self._error(number, "a coordinate stands before G0 or G1, and G90", "syntax")
        before, inverse = dict(self.place), self.modes.get("feed") == "93"
        for axis in "XYZ":
            if axis in numbers:
                self.place[axis] = self._length(number, numbers[axis])
        if "A" in numbers:
            self.place["A"] = math.radians(numbers["A"])
        self.beside |= bool(numbers.get("Y"))
        if motion == "1":
            if inverse and "F" not in numbers:
                raise self._error(number, "G93 asks for a feed F in every block that cuts", "syntax")
            if "feed" not in self.modes or not (self.feed > 0.0 and self.turning):
                raise self._error(number, "a feed move without G93 or G94, a feed F and a spindle that turns", "syntax")
        if not {"X", "Z", "A"} <= self.place.keys():
            if motion == "1":
                raise self._error(number, "a feed move from an unknown place", "syntax")
            return
        # what was unknown before the move is taken as its end's
        start, end = ({"Y": 0.0, **self.place, **known} for known in (before, self.place))
        first, last = (Position(at["X"], at["Y"], at["Z"], at["A"]) for at in (start, end))
        if not {"X", "Z", "A"} <= before.keys():
            first = first._replace(z=max(first.z, last.z))
        rapid = motion == "0"
        self.moves.append(TurnMove(number, rapid, first, last, 0.0 if rapid else self.feed, inverse))


@dataclass(frozen=True, eq=False)
class Pass:
    """A way of the cutter at one depth, with its end at the distance `z` from the axis, mm.

    Points (n,) of the angle, rad, the place along the drum and that beside its axis, mm, between which all axes move
    evenly; `line` is that of the first of its blocks.
    """

    line: int
    z: float
    a: Array
    x: Array
    y: Array

    def same_way(self, other: Pass) -> bool:
        """Whether another pass follows the same way, perhaps deeper."""
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in "axy")


def passes_of(moves: tuple[TurnMove, ...], blank: float) -> Iterator[Pass]:
    """Passes of the moves that cut below the blank's radius, mm.

    A cutter that goes down and does not cut on from there makes one of a single place, twice.
    """
    open_: list[TurnMove] = []

    def made() -> Iterator[Pass]:
        if open_:
            points = np.array([open_[0].start, *(move.end for move in open_)])
            yield Pass(open_[0].line, open_[0].start.z, points[:, 3], points[:, 0], points[:, 1])
            open_.clear()

    down: TurnMove | None = None
    for move in moves:
        level = move.start.z == move.end.z
        if not move.rapid and level and move.start.z < blank:
            if move.start != move.end:
                open_.append(move)
                down = None
            continue
        yield from made()
        deeper = move.end.z < min(move.start.z, blank)
        if down is not None and not (deeper and move.end._replace(z=0.0) == down.end._replace(z=0.0)):
            yield _still(down)
            down = None
        if deeper:
            down = move
    yield from made()
    if down is not None:
        yield _still(down)


def _still(down: TurnMove) -> Pass:
    """The pass of a cutter that only goes down."""
    x, y, z, a = down.end
    return Pass(down.line, z, np.array([a, a]), np.array([x, x]), np.array([y, y]))
