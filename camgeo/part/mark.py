"""The timing mark: a slot on the ray at 0, engraved into the upper face or cut through."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from camgeo.part.feature import Callout, Feature, FeatureCheck, Placed, check_below, optional
from camgeo.schema.fields import Field, Kind, length
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.part.feature import SheetView, Site
    from camgeo.part.shapes import Layer, Opening
    from camgeo.schema.reader import Reader, Values
    from kin.numeric.check import Check

STEP = 0.01  # mm: what is placed automatically is placed on whole steps
TRIES = 200  # of moving the mark inward
MARGIN = 1e-9  # mm: rounding of a wall that is just held


@dataclass(frozen=True)
class Mark:
    """A slot on the ray at 0, engraved `depth` deep into the upper face or cut through; lengths in mm.

    `radius` is the distance of its outer end from the shaft; None for as far out as the wall permits.
    """

    kind: Literal["engrave", "cut"] = "engrave"
    width: float = 0.5
    length: float = 4.0
    depth: float = 0.3
    radius: float | None = None


def _check(part: Values, reader: Reader) -> None:
    mark = part["mark"]
    if "thickness" in part:
        check_below(reader, "part.mark.depth", mark.get("depth"), part["thickness"], "the thickness")
    if "length" in mark:
        check_below(reader, "part.mark.width", mark.get("width"), mark["length"], "its length")
    if mark.get("as") == "cut" and "depth" in mark:
        reader.fault_at("part.mark.depth", "a mark that is cut through has no depth", None, "leave it out")


def _place(mark: Mark, site: Site) -> Placed:
    """The mark where the recipe has it, or as far out on the ray as the wall permits.

    Without room there is no opening, and the check names the greatest mark, or else the wall, that leaves some.
    """
    opening = _opening(mark, site, site.wall)
    if opening is not None:
        return Placed((opening,))
    # of the same shape, but longer than wide
    shape = mark if mark.width < mark.length else replace(mark, length=2.0 * mark.width)

    def scaled(share: float) -> Mark:
        return replace(shape, width=share * shape.width, length=share * shape.length)

    share = _greatest(lambda share: _opening(scaled(share), site, site.wall) is not None)
    if share > 0.0:
        return Placed((), _no_room(mark, fits=scaled(share)))
    wall = site.wall or 0.0
    return Placed(
        (), _no_room(mark, wall=wall and wall * _greatest(lambda k: _opening(mark, site, k * wall) is not None))
    )


def _greatest(fits: Callable[[float], bool]) -> float:
    """Greatest share of 1 that fits, to a thousandth of 1 and on the safe side; 0 if none does, 1 if that does."""
    low, high = (1.0, 1.0) if fits(1.0) else (0.0, 1.0)
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def _opening(mark: Mark, site: Site, wall: float | None) -> Opening | None:
    """The mark at its `radius`, whatever its wall; else as far out as the wall to the contour permits.

    That is `wall`, mm, or without one the width of the mark. None without room on the ray, and for a mark that is not
    longer than wide.
    """
    from camgeo.part.shapes import Opening, slot
    from camgeo.part.walls import contour_gap, distance_inside

    depth = mark.depth if mark.kind == "engrave" else None
    layer: Layer = "ENGRAVE" if mark.kind == "engrave" else "MARK"
    least = (wall or mark.width) + site.edge

    def ending(outer: float) -> Opening:
        return Opening("mark", layer, slot(outer - mark.length, outer, mark.width), depth=depth)

    if mark.width >= mark.length:
        return None  # no slot
    if mark.radius is not None:
        return ending(mark.radius)
    outer = site.looks.contour.size
    for _ in range(TRIES):  # no point of the slot comes nearer to the contour than by what it is moved
        inside, _ = distance_inside(site.looks, (outer - 0.5 * mark.width, 0.0))
        want = least + 0.5 * mark.width - inside
        if want <= MARGIN:
            break
        outer -= want
        if outer <= 0.0:
            return None  # nowhere on the ray
    outer = STEP * math.floor(outer / STEP)
    # its sides are nearer than its end
    while (lack := least - MARGIN - contour_gap(site.looks, ending(outer).chain).wall) > 0.0:
        if outer <= mark.length:
            return None
        outer = STEP * round(outer / STEP - max(1.0, math.floor(lack / STEP)))
    return ending(outer)


def _no_room(mark: Mark, fits: Mark | None = None, wall: float = 0.0) -> Check:
    """Check that fails as there is no room; it names the mark `fits`, or the `wall`, mm, for which there is some."""
    from camgeo.common.rounding import downward
    from kin.numeric.check import Check
    from kin.numeric.lengths import amount_words

    width = 0.0 if fits is None else fits.width
    would = "; no other has any, leave it out"
    if fits is not None:
        would = f"; {{width: {downward(fits.width)} mm, length: {downward(fits.length)} mm}} has"
    elif wall > 0.0:
        would = f"; a part.wall of {downward(wall)} mm leaves some"
    wide, long = (amount_words(size, "mm") for size in (mark.width, mark.length))
    detail = f"no room on the ray at 0 for a mark {wide} wide and {long} long{would}"
    return Check(FEATURE.name, ok=False, value=mark.width, limit=width, unit="mm", sense="at_most", detail=detail)


def _callouts(mark: Mark, view: SheetView) -> list[Callout]:
    opening = view.openings.get("mark")
    if opening is None:
        return []
    outer = opening.outline.box()[2]
    deep = "through" if opening.depth is None else f"{view.number(opening.depth)} deep"
    text = f"mark {view.number(mark.width)} × {view.number(mark.length)}"
    return [Callout(text, (f"R{view.number(outer)}, {deep}",), points=view.edge("mark"))]


FEATURE = Feature(
    Mark,
    optional(
        "mark",
        "timing mark on the ray where the shaft angle is 0",
        Field(
            "as",
            Kind.CHOICE,
            "engraved into the upper face, or cut through",
            default="engrave",
            choices=("engrave", "cut"),
        ),
        length("width", "width of the slot", default="0.5 mm"),
        length("length", "length of the slot along the ray", default="4 mm"),
        length("depth", "depth of an engraved slot", default="0.3 mm"),
        length("radius", "distance of the slot's outer end from the shaft", default="as far out as the wall lets it"),
    ),
    of_ring=False,
    walled=True,
    check=_check,
    make=lambda values, _part: Mark(**{"kind" if key == "as" else key: item for key, item in values.items()}),
    place=_place,
    judged=FeatureCheck("mark", files="all"),
    callouts=_callouts,
)
