"""Closed outlines of a part for all writers: each on the layer of a drawing, in millimetres."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from camgeo.fit.pieces import Outline


class LayerOutline(NamedTuple):
    """A closed outline on a layer, mm; `circle` is the centre and radius of a round one, None for others."""

    layer: str
    outline: Outline
    circle: tuple[tuple[float, float], float] | None = None
