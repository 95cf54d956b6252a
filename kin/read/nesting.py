"""Which of several closed contours is the outer one, and whether the others are holes in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.nearest import signed_distance
from kin.numeric.places import place_text
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from pathlib import Path

    from kin.contour.contour import Contour

__all__ = ["counter_clockwise", "demand_few", "met", "nested"]

MOST_CONTOURS = 2000


def demand_few(count: int, path: Path) -> None:
    """Raise ReadError for more closed contours than a part has, before the work on each is begun."""
    if count > MOST_CONTOURS:
        raise ReadError("range", f"it has {count} closed contours; up to {MOST_CONTOURS} are read", path)


def counter_clockwise(contour: Contour) -> Contour:
    """Return the contour, turned round if its area is negative."""
    return contour if contour.area >= 0.0 else contour.reversed()


def met(place: tuple[float, float], path: Path) -> ReadError:
    """Return the error for contours that meet at a place."""
    x, y = place
    return ReadError("crossing", f"two closed contours cross or touch at {place_text(x, y, digits=9)}", path, place)


def nested(contours: list[Contour], path: Path) -> list[int]:
    """Numbers of the contours by falling area, the first of which holds all others.

    The contours do not meet. Raises ReadError "several" for one that lies outside the first, "island" for one inside
    another hole.
    """
    order = sorted(range(len(contours)), key=lambda k: -abs(contours[k].area))
    places = np.array([contours[k].start[0] for k in order])
    for rank, k in enumerate(order[:-1]):
        others = places[rank + 1 :]
        x_min, y_min, x_max, y_max = contours[k].box
        inside = np.zeros(len(others), dtype=np.bool_)
        near = np.flatnonzero(((others >= (x_min, y_min)) & (others <= (x_max, y_max))).all(axis=1))  # in its box
        if near.size:
            chain, _ = counter_clockwise(contours[k]).as_arcs()
            inside[near] = signed_distance(chain, others[near]) < 0.0
        wrong = others[inside if rank else ~inside]
        if not len(wrong):
            continue
        x, y = wrong[0].tolist()
        box = contours[order[rank + 1 + int(np.flatnonzero(inside if rank else ~inside)[0])]].box
        size = f"{box.x_max - box.x_min:.6g} x {box.y_max - box.y_min:.6g} mm"
        what = f"the closed contour at {place_text(x, y, digits=9)}"
        if rank:
            raise ReadError("island", f"{what} lies inside a hole; it is {size}", path, (x, y))
        raise ReadError("several", f"{what} does not lie inside the largest one; it is {size}", path, (x, y))
    return order
