"""The surfaces of a part found among the closed chains of a drawing, a section or a program.

Chains that go round the shaft lie one in another: a round outline, the surfaces, the bore. The outermost of all chains
is the outline, whether or not it goes round.
"""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.about import goes_round
from kin.judge.bore import round_check
from kin.numeric.angles import TURN
from kin.read.errors import ReadError
from kin.read.nesting import MOST_CONTOURS

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.contour.contour import Contour
    from kin.judge.intent import PartIntent, SurfaceIntent
    from kin.numeric.check import Check
    from kin.read.nesting import ClosedContour

SIZED = np.linspace(0.0, TURN, 64)  # parameters at which an exact contour's size is taken


class SortedChains(NamedTuple):
    """Sorted chains of a part: one for each surface, in order, the other chains as holes, checks of a round outline."""

    surfaces: tuple[ClosedContour, ...]
    holes: tuple[Contour, ...]
    checks: tuple[Check, ...]


def sort_chains(
    outline: ClosedContour | None,
    others: Sequence[ClosedContour],
    part: PartIntent,
    tolerance: float,
    path: Path,
    *,
    z: float | None = None,
) -> SortedChains:
    """Sort the chains of a part, in mm, as if not mirrored; `outline` is None where it is not in the file.

    `z`, mm, is the height of their section, None for the plain disc's. A surface is the chain on its layer; where no
    surface has a chain on a layer of its own, the surfaces are the chains that go round the shaft, in the order of
    `others`, outermost first. Raises ReadError where a surface is missing, or its layer has several closed contours.
    """
    checks: tuple[Check, ...] = ()
    if outline is not None and part.outline is None:
        others = (outline, *others)
    elif outline is not None and part.outline is not None:
        checks = (round_check("outer", outline.contour, part.outline, tolerance),)
    surfaces = [surface for surface in part.surfaces if surface.z == z]
    round_shaft = (chain for chain in others if chain is outline or goes_round(chain.contour))
    layers = {chain.layer for chain in others} - {""}
    by_layer = any(surface.layer in layers for surface in surfaces)
    chosen: dict[str, ClosedContour] = {}
    for surface in outermost_first(surfaces):
        there = [chain for chain in others if chain.layer == surface.layer] if by_layer else [*islice(round_shaft, 1)]
        if not there:
            raise ReadError("empty", missing(surface, part), path)
        if len(there) > 1:
            raise ReadError("several", f"{len(there)} closed contours on the layer {surface.layer}", path)
        (chosen[surface.name],) = there
    holes = tuple(chain.contour for chain in others if not any(chain is used for used in chosen.values()))
    return SortedChains(tuple(chosen[surface.name] for surface in surfaces), holes, checks)


def outermost_first(surfaces: Sequence[SurfaceIntent]) -> list[SurfaceIntent]:
    """Surfaces, which lie one in another, by the falling reach of their exact contours from the shaft."""

    def reach(surface: SurfaceIntent) -> float:
        return float(np.hypot(*surface.gauge.envelope.points(SIZED).T).max())

    return sorted(surfaces, key=reach, reverse=True) if len(surfaces) > 1 else list(surfaces)


def deepest(part: PartIntent) -> int:
    """Greatest number of other chains that a closed chain of a part may lie inside.

    Holes lie in metal, and nothing lies in an opening. Where openings are passed over, there is no limit but
    MOST_CONTOURS.
    """
    if not part.closed:
        return MOST_CONTOURS
    ring = 0 if part.outline is None else 1
    return ring + len(part.surfaces) - (1 if outermost_first(part.surfaces)[-1].side < 0 else 0)


def missing(surface: SurfaceIntent, part: PartIntent) -> str:
    """Words for a surface that is missing in a file: several surfaces of one part are the flanks of a groove."""
    if surface.name:
        flank = " flank" if len(part.surfaces) > 1 else ""
        return f"the {surface.name}{flank} is missing, on which its follower runs"
    return "the ring has no opening about the shaft, in which its follower runs"
