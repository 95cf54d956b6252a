"""Outlines on layers for writers: a contour, and a round bore in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.files.layer_outline import LayerOutline
from camgeo.part.shapes import disc

if TYPE_CHECKING:
    from camgeo.fit.pieces import Outline


def bored(outline: Outline, bore: float | None = None) -> list[LayerOutline]:
    """A contour on CUT, and a bore of a diameter about the origin, mm."""
    if bore is None:
        return [LayerOutline("CUT", outline)]
    hole = disc("bore", "BORE", (0.0, 0.0), 0.5 * bore)
    return [LayerOutline("CUT", outline), LayerOutline(hole.layer, hole.outline, hole.circle)]
