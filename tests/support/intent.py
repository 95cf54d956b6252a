"""Parts of one surface, as the judge is told of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from kin.judge.contour_checks import judge_contour
from kin.judge.intent import LinkageIntent, PartIntent, SurfaceIntent
from kin.judge.verdict import Verdict
from kin.read.nesting import ClosedContour

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.follower.base import Follower
    from kin.judge.intent import Limits
    from kin.numeric.arrays import Array

LINKAGE = frozenset({"mechanism", "swing", "dwell"})


def part_of(follower: Follower, *, trimmed: bool = False, outline: float | None = None, **others: Any) -> PartIntent:
    """A disc of one surface, which is its outline or, with a round one of that diameter, mm, its opening.

    `others` are the fields of a PartIntent, and of its LinkageIntent.
    """
    surface = SurfaceIntent(follower, side=1 if outline is None else -1, trimmed=trimmed)
    mechanism = {name: others.pop(name) for name in LINKAGE & others.keys()}
    linkage = LinkageIntent(**mechanism) if mechanism else None
    return PartIntent((surface,), outline=outline, linkage=linkage, **others)


def linked(part: PartIntent, **changes: Any) -> PartIntent:
    """The part with changes of its LinkageIntent."""
    assert part.linkage is not None
    return replace(part, linkage=replace(part.linkage, **changes))


def gauge_of(part: PartIntent) -> Follower:
    """The follower of a part of one surface."""
    (surface,) = part.surfaces
    return surface.gauge


def findings(contour: Contour, part: PartIntent, phi: Array, limits: Limits, uneven: float = 0.0) -> Verdict:
    """What is found on the contour of a part of one surface."""
    (surface,) = part.surfaces
    found, checks = judge_contour(ClosedContour(contour), surface, phi, limits, uneven, linkage=part.linkage)
    return Verdict("dxf", tuple(checks), (found,))
