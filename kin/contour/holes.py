"""The intended openings of a part, each once at its place: matched with the openings of a file, and measured.

Distances between two closed chains of lines and arcs are taken at points so close that nothing between them is farther
off by more than `FINE` of the tolerance. Ends and middles of all pieces are among them, and are enough where both
chains are the same pieces within so much.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.contour import Contour
from kin.contour.nearest import nearest
from kin.numeric.check import Check, at_most
from kin.numeric.lengths import UNIT, length_words, place_words
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.arcs import Arcs
    from kin.numeric.arrays import Array

FINE = 1e-2  # of the tolerance, to which distances are found
MOST_PARTS = 20_000  # of one piece
ROUNDING = 1e-12  # mm
MOST_NAMED = 5  # faults named in a message


@dataclass(frozen=True)
class Hole:
    """An intended closed outline, counter-clockwise, mm: points and bulges as in a DXF polyline.

    name    in messages
    kind    the check that reports it: bore, holes or mark
    depth   below the upper face of the disc, mm; None through everything
    """

    name: str
    kind: str
    points: tuple[tuple[float, float], ...]
    bulges: tuple[float, ...]
    depth: float | None = None

    @cached_property
    def contour(self) -> Contour:
        """Outline of the hole as a contour, mm."""
        return Contour.from_bulges(np.array(self.points), np.array(self.bulges))


def round_hole(name: str, kind: str, centre: tuple[float, float], diameter: float) -> Hole:
    """Make a round hole, diameter in mm, its outline two half circles."""
    x, y = centre
    return Hole(name, kind, ((x + 0.5 * diameter, y), (x - 0.5 * diameter, y)), (1.0, 1.0))


@dataclass()
class Tally:
    """Deviations and faults of one kind of opening or outline, gathered over all sections of a part.

    worst   greatest deviation so far, mm
    detail  words for the place of it
    faults  faults in words, each of which fails the check
    """

    worst: float = 0.0
    detail: str = ""
    faults: list[str] = field(default_factory=list)

    def measured(self, off: float, detail: str) -> None:
        """Keep a deviation `off`, mm, and the words for its place if it is the greatest so far."""
        if off >= self.worst:
            self.worst, self.detail = off, detail

    def check(self, name: str, tolerance: float) -> Check:
        """Check that fails on any fault, else compares the greatest deviation with the tolerance, mm."""
        if self.faults:
            more = f"; and {len(self.faults) - MOST_NAMED} more" if len(self.faults) > MOST_NAMED else ""
            detail = "; ".join(self.faults[:MOST_NAMED]) + more
            return Check(name, ok=False, value=None, limit=tolerance, unit="mm", detail=detail)
        return at_most(name, self.worst, tolerance, "mm", detail=self.detail, slack=ROUNDING)


Tallies = dict[str, Tally]


def tally(
    tallies: Tallies,
    openings: Sequence[Contour],
    intended: Sequence[Hole],
    tolerance: float,
    *,
    where: str = "",
    settled: Sequence[Hole] = (),
    closed: bool = True,
) -> None:
    """Match the openings of a file with the intended holes, and take their deviations into `tallies`.

    Each intended kind gets its tally; `where` is added to messages. An opening beyond the intended ones counts as a
    fault of the kind of the hole in `settled` that it resembles, else of `holes`, or of `bore` where no other kind is
    intended; of a part that is not `closed` it is passed over. Deviations are found to a share of `tolerance`, mm.
    """
    pairs, left_over = _matched(openings, intended)
    for hole, contour in pairs:
        hole_tally = tallies.setdefault(hole.kind, Tally())
        if contour is None:
            x, y = _middle(hole.contour)
            hole_tally.faults.append(f"{hole.name} at {place_words(x, y)} is missing{where}")
            continue
        off = apart(contour, hole.contour, FINE * tolerance)
        x, y = _middle(contour)
        hole_tally.measured(
            off, f"{hole.name}, about {place_words(x, y)}{where}, is off by {length_words(off, '.3g')} {UNIT}"
        )
    for contour in left_over if closed else ():
        x, y = _middle(contour)
        alike = [hole for hole, match in _matched([contour], settled)[0] if match is not None]
        if alike:
            kind = alike[0].kind
        else:
            kind = "holes" if "holes" in tallies or len(tallies) > 1 else next(iter(tallies), "bore")
        area = f"{length_words(abs(contour.area), '.6g', 2)} {UNIT}^2"
        fault = f"an opening of {area} about {place_words(x, y)}{where}, where none is expected"
        tallies.setdefault(kind, Tally()).faults.append(fault)


def _matched(
    openings: Sequence[Contour], intended: Sequence[Hole]
) -> tuple[list[tuple[Hole, Contour | None]], list[Contour]]:
    """Each intended hole with the opening at its place, None if none is there; and the openings left over.

    The two match if the middles of their boxes lie within half the size of the intended one. Of several pairs the one
    with the least sum of distance and difference in size, mm, comes first.
    """
    size = [_size(hole.contour) for hole in intended]
    place = [_middle(hole.contour) for hole in intended]
    ranked = []
    for k, contour in enumerate(openings):
        (x, y), large = _middle(contour), _size(contour)
        for j, (u, v) in enumerate(place):
            gap = float(np.hypot(x - u, y - v))
            if gap <= 0.5 * size[j]:
                ranked.append((gap + abs(large - size[j]), j, k))
    partner: dict[int, int] = {}
    used: set[int] = set()
    for _, j, k in sorted(ranked):
        if j not in partner and k not in used:
            partner[j] = k
            used.add(k)
    pairs = [(hole, openings[partner[j]] if j in partner else None) for j, hole in enumerate(intended)]
    return pairs, [contour for k, contour in enumerate(openings) if k not in used]


def _middle(contour: Contour) -> tuple[float, float]:
    box = contour.box
    return 0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)


def _size(contour: Contour) -> float:
    box = contour.box
    return float(np.hypot(box.x_max - box.x_min, box.y_max - box.y_min))


def apart(contour: Contour, other: Contour, fine: float) -> float:
    """Two-sided distance of two closed contours, mm, to within `fine`."""
    first, second = contour.as_arcs()[0], other.as_arcs()[0]
    bend = float(max(np.abs(first.curvature).max(), np.abs(second.curvature).max()))
    if _piece_by_piece(first, second) <= fine:
        fine = math.inf
    return max(farthest(first, second, bend, fine), farthest(second, first, bend, fine))


def _piece_by_piece(first: Arcs, second: Arcs) -> float:
    """Bound of the distance of two chains, mm, from their k-th pieces; infinite if their numbers of pieces differ."""
    if len(first) != len(second):
        return math.inf
    turn = np.hypot(*(first.tangent - second.tangent).T) + 0.5 * first.length * np.abs(
        first.curvature - second.curvature
    )
    off = np.hypot(*(first.start - second.start).T) + first.length * turn + np.abs(first.length - second.length)
    return float(off.max())


def farthest(chain: Arcs, other: Arcs, bend: float, fine: float) -> float:
    """Greatest distance, mm, of a chain's points from another chain, to within `fine`, mm.

    Along a piece the distance bends by no more than the curvatures of both, `bend`, 1/mm: over a part of length h it
    exceeds its values at the ends by h^2/8 of that at most.
    """
    step = np.sqrt(4.0 * fine / max(bend, 1e-12))
    parts = np.clip(2.0 * np.ceil(0.5 * chain.length / step), 2, MOST_PARTS).astype(np.intp)
    points: Array = chain.cut(parts)[0].start
    return float(nearest(other, points)[1].max())
