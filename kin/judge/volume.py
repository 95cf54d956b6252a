"""The check on a solid's volume, by the area and the perimeter of its exact surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.check import ROUNDING, Check, at_most
from kin.numeric.lengths import UNIT, length_words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.contour import Contour
    from kin.judge.intent import PartIntent


def exact_area(contours: Sequence[Contour], part: PartIntent) -> tuple[float, float, str]:
    """Area, mm^2, and length of edges, mm, of the part's section without bore or holes, and their source.

    The edges are those of the surfaces and of a round outline. The source is "intent", or "contour" where a trimmed
    cam has no closed form: then the file's contours, one of each surface in their order, give area and length.
    """
    area, length, regular = 0.0, 0.0, True
    for contour, surface in zip(contours, part.surfaces, strict=True):
        envelope = surface.gauge.envelope
        regular = regular and envelope.regular
        enclosed, edge = envelope.area_and_perimeter() if envelope.regular else (contour.area, contour.length)
        area, length = area + surface.side * enclosed, length + edge
    if part.outline is not None:
        area, length = 0.25 * np.pi * part.outline**2 + area, np.pi * part.outline + length
    return area, length, "intent" if regular else "contour"


def volume_check(
    measured: float, height: float, contours: Sequence[Contour], part: PartIntent, tolerance: float
) -> Check:
    """Check a solid's volume, mm^3, against the exact area times its `height`, mm.

    The limit is the tolerance, mm, times the area of the walls.
    """
    area, perimeter, source = exact_area(contours, part)
    bore = part.bore or 0.0
    expected = (area - 0.25 * np.pi * bore**2) * height
    limit = tolerance * (perimeter + np.pi * bore + 2.0 * np.pi * tolerance) * height  # to second order
    detail = f"{length_words(measured, '.9g', 3)} {UNIT}^3, by the {source} {length_words(expected, '.9g', 3)}"
    return at_most("volume", abs(measured - expected), limit, "mm^3", detail=detail, slack=ROUNDING * expected)


def layers_volume_check(measured: float, contours: Sequence[Contour], part: PartIntent, tolerance: float) -> Check:
    """Check the volume of a part in layers, mm^3, against that by the area and length of edges of `exact_area`.

    `contours` are the file's, one of each surface. The limit is the tolerance, mm, times the area of the walls.
    """
    from kin.read.layers import volume, wall_area

    area, perimeter, source = exact_area(contours, part)
    expected = volume(part.layers, part.cross_holes, area, perimeter)
    limit = tolerance * wall_area(part.layers, part.cross_holes, perimeter)
    detail = f"{length_words(measured, '.9g', 3)} {UNIT}^3, by the {source} {length_words(expected, '.9g', 3)}"
    return at_most("volume", abs(measured - expected), limit, "mm^3", detail=detail, slack=ROUNDING * expected)
