"""How many bodies a solid's file holds: what is sought of each, and one error where others are there."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array

__all__ = ["MOST_BODIES", "Placed", "Sought", "beside", "missing"]

MOST_BODIES = 5  # that are named in a message
RIGID = 1e-9  # a place turns and shifts only if its axes are square and of length 1 within this


def no_rows(columns: int) -> Array:
    """Empty array (0, columns): a solid without leaning walls."""
    return np.empty((0, columns))


class Slivered:
    """A solid some of whose walls lean, no farther than the rounding of its file explains.

    `slivers` (k, 4): least and greatest height, reach from the axis, and by how much, mm.
    """

    if TYPE_CHECKING:
        slivers: Array

    @property
    def uneven(self) -> float:
        """Greatest distance, mm, of a point of the mesh from upright walls; exactly 0 where all stand upright."""
        return self.uneven_between(-np.inf, np.inf)

    def uneven_between(self, low: float, high: float, beyond: float = 0.0) -> float:
        """Greatest unevenness, mm, of what lies between two heights and reaches `beyond` mm from the axis."""
        rows = self.slivers
        there = (rows[:, 0] < high) & (rows[:, 1] > low) & (rows[:, 2] >= beyond)
        return float(rows[there, 3].max(initial=0.0))


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


class Sought(NamedTuple):
    """Sections sought of one body, at heights, mm.

    `deepest` is the number of others that a closed chain may lie inside.
    """

    heights: Sequence[float] = ()
    deepest: int = 1


def missing(count: int, expected: int, path: Path) -> ReadError:
    """Make the error for a file of fewer bodies than are expected."""
    holds = f"it holds {count} {'body' if count == 1 else 'bodies'}, where {expected} are expected"
    return ReadError("several", f"{holds}, one above the other", path)


def beside(
    bodies: Sequence[tuple[str, tuple[Array, Array] | None]], count: int, path: Path, expected: int = 1
) -> ReadError:
    """Make the error for a file of `count` bodies, of which some are given: names, and boxes (3,), (3,), mm, if known.

    Where one is expected, that with the largest box is taken for the part, the others for what does not belong there.
    """
    if expected > 1:
        named = "; ".join(told(*body) for body in bodies)
        return ReadError("several", f"it holds {count} bodies, where {expected} are expected: {named}", path)
    sizes = [-1.0 if box is None else float(np.prod(box[1] - box[0])) for _, box in bodies]
    part = int(np.argmax(sizes))
    others = [told(*item) for k, item in enumerate(bodies) if k != part]
    more = f", and {count - len(bodies)} more" if count > len(bodies) else ""
    name = bodies[part][0]
    message = f"it holds {count} bodies, where one is expected; beside {name} there is {'; '.join(others)}{more}"
    return ReadError("several", f"{message}; take out what does not belong", path)


def told(name: str, box: tuple[Array, Array] | None) -> str:
    """Text of a body's name, size and place."""
    if box is None:
        return name
    low, high = box
    size = " x ".join(f"{side:.6g}" for side in (high - low).tolist())
    spans = (f"{axis} {a:.6g} to {b:.6g}" for axis, a, b in zip("xyz", low.tolist(), high.tolist(), strict=True))
    return f"{name} of {size} mm at {', '.join(spans)} mm"
