"""Which of several closed contours is the outer one, and which lie inside which."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.nearest import signed_distance
from kin.numeric.places import place_text
from kin.numeric.records import dataclass
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.contour.contour import Contour

MOST_CONTOURS = 2000
MOST_PIECES = 1_000_000  # of all contours: a polygon within 1e-9 mm may have more than half of that


class NestingPlace(NamedTuple):
    """Place of a contour among others.

    number  of the contour in the list given
    depth   how many others it lies inside
    inside  rank by falling area, from 0, of the smallest of these; None for the outer contour
    """

    number: int
    depth: int
    inside: int | None


class ClosedContour(NamedTuple):
    """A closed contour, counter-clockwise, mm.

    depth   how many others it lies inside
    inside  place in `Nest.chains` of the smallest of these; None for the outer contour
    layer   of a drawing on which it stands
    pieces  number of its pieces as the file counts them: edges, arcs, spans of a spline, moves
    gap     widest gap between two pieces that a line joins, mm
    """

    contour: Contour
    depth: int = 0
    inside: int | None = None
    layer: str = ""
    pieces: int = 0
    gap: float = 0.0


@dataclass(frozen=True, eq=False)
class Nest:
    """Closed chains by falling area, the first of which holds all others."""

    chains: tuple[ClosedContour, ...]

    @property
    def contour(self) -> Contour:
        """The outer contour."""
        return self.chains[0].contour

    @property
    def holes(self) -> tuple[Contour, ...]:
        """Contours inside the outer contour."""
        return tuple(chain.contour for chain in self.chains[1:])

    @property
    def pieces(self) -> int:
        """Number of pieces of the outer contour as the file counts them: edges, arcs, spans of a spline."""
        return self.chains[0].pieces


def scaled(chains: Sequence[ClosedContour], factor: float, *, mirrored: bool = False) -> tuple[ClosedContour, ...]:
    """Return chains enlarged about the origin by a factor above 0, and with `mirrored` reflected in the x axis."""
    enlarged = []
    for chain in chains:
        contour = chain.contour.scaled(factor) if factor != 1.0 else chain.contour
        contour = contour.mirrored() if mirrored else contour
        enlarged.append(chain._replace(contour=contour, gap=factor * chain.gap))
    return tuple(enlarged)


def demand_few(count: int, path: Path) -> None:
    """Raise ReadError for a count of more than MOST_CONTOURS closed contours, before the work on each is begun."""
    if count > MOST_CONTOURS:
        raise ReadError("range", f"it has {count} closed contours; up to {MOST_CONTOURS} are read", path)


def demand_few_pieces(count: int, path: Path) -> None:
    """Raise ReadError for a count of more than MOST_PIECES pieces, before the work on each is begun."""
    if count > MOST_PIECES:
        raise ReadError("range", f"its contours have {count} pieces; up to {MOST_PIECES} are read", path)


def counter_clockwise(contour: Contour) -> Contour:
    """Return the contour, turned round if its area is negative."""
    return contour if contour.area >= 0.0 else contour.reversed()


def met(place: tuple[float, float], path: Path, remedy: str = "") -> ReadError:
    """Return the error for contours that meet at a place, mm, with a remedy behind it."""
    told = f"two closed contours cross or touch at {place_text(*place, digits=9)}{remedy}"
    return ReadError("crossing", told, path, place)


def nested(contours: list[Contour], path: Path, deepest: int = 1) -> list[NestingPlace]:
    """Places of contours by falling area: the first holds all others. The contours must not meet.

    Raises ReadError: "several" for one that lies outside the first, "island" for one inside more than `deepest` others.
    """
    order = sorted(range(len(contours)), key=lambda k: -abs(contours[k].area))
    points = np.array([contours[k].start[0] for k in order])
    depth, inside_of = np.zeros(len(order), dtype=np.intp), np.full(len(order), -1, dtype=np.intp)
    # contours that do not meet lie inside one another or not: the start of each smaller one decides
    for rank, k in enumerate(order[:-1]):
        later = points[rank + 1 :]
        x_min, y_min, x_max, y_max = contours[k].box
        inside = np.zeros(len(later), dtype=np.bool_)
        near = np.flatnonzero(((later >= (x_min, y_min)) & (later <= (x_max, y_max))).all(axis=1))  # in its box
        if near.size:
            contour = counter_clockwise(contours[k])
            chain, off = contour.rough  # arcs within `off` mm of the contour; the exact ones only for points as near
            away = signed_distance(chain, later[near])
            if (np.abs(away) <= off).any():
                away = signed_distance(contour.as_arcs()[0], later[near])
            inside[near] = away < 0.0
        depth[rank + 1 :][inside], inside_of[rank + 1 :][inside] = depth[rank] + 1, rank
        wrong = ~inside if rank == 0 else inside & (depth[rank] >= deepest)
        if not wrong.any():
            continue
        x, y = later[wrong][0].tolist()
        box = contours[order[rank + 1 + int(np.flatnonzero(wrong)[0])]].box
        size = f"{box.x_max - box.x_min:.6g} x {box.y_max - box.y_min:.6g} mm"
        subject = f"the closed contour at {place_text(x, y, digits=9)}"
        if rank:
            raise ReadError("island", f"{subject} lies inside a hole; it is {size}", path, (x, y))
        raise ReadError("several", f"{subject} does not lie inside the largest one; it is {size}", path, (x, y))
    places = zip(order, depth.tolist(), inside_of.tolist(), strict=True)
    return [NestingPlace(k, deep, None if outer < 0 else outer) for k, deep, outer in places]
