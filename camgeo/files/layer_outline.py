"""The closed outlines of a part as every writer takes them: each on the layer of a drawing, in millimetres."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from camgeo.fit.pieces import Outline


class LayerOutline(NamedTuple):
    """A closed outline on a layer; `circle` is the centre and radius of a round one, which a drawing says exactly."""

    layer: str
    outline: Outline
    circle: tuple[tuple[float, float], float] | None = None
