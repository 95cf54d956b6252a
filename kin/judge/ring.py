"""Rings, whose follower runs inside: the contour that it touches is an opening, and the outline is a circle."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import cross, dot
from kin.judge.contour_checks import round_check
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.contour.contour import Contour
    from kin.judge.check import Check

LOOKS = 16  # on each piece: an arc of a whole turn is seen to go round


class Faced(NamedTuple):
    """The contour that the follower touches, the holes besides, and what is reported of a ring's outline."""

    contour: Contour
    holes: tuple[Contour, ...]
    checks: tuple[Check, ...]


def faced(outline: Contour, holes: Sequence[Contour], outer: float | None, tolerance: float, path: Path) -> Faced:
    """Tell apart what a file holds, in mm: the outline is touched, or of a ring of diameter `outer` the opening.

    That is the one that goes round the shaft. ReadError without one.
    """
    if outer is None:
        return Faced(outline, tuple(holes), ())
    opening = next((k for k, hole in enumerate(holes) if goes_round(hole)), None)
    if opening is None:
        raise ReadError("empty", "the ring has no opening about the shaft, in which its follower runs", path)
    rest = tuple(hole for k, hole in enumerate(holes) if k != opening)
    return Faced(holes[opening], rest, (round_check("outer", outline, outer, tolerance),))


def goes_round(contour: Contour) -> bool:
    """Whether a contour encloses the shaft."""
    points = contour.sample(LOOKS)
    after = np.roll(points, -1, axis=0)
    return bool(abs(np.arctan2(cross(points, after), dot(points, after)).sum()) > np.pi)
