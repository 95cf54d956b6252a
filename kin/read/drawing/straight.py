"""Straight lines of a drawing, layer by layer, as developments are drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.read.drawing.dxf import COMMENT_BYTES, check_whole, damage_reported, everything, gather, unit_of
from kin.read.drawing.dxf_document import opened
from kin.read.errors import ReadError
from kin.read.formats import contents

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array


def read_lines(path: Path, layers: Sequence[str]) -> tuple[float | None, dict[str, list[Array]]]:
    """Mm in a unit of a DXF, None where it states none, and runs of points (n, 2) on each of the layers, in it.

    Raises OSError where the file cannot be read, ReadError for a damaged file and for curves on these layers.
    """
    raw = contents(path, "dxf")
    check_whole(raw, path)
    found: dict[str, list[Array]] = {}
    with damage_reported(path):
        document, space = opened(raw)
        unit = unit_of(document, raw[:COMMENT_BYTES], path)
        drawn = everything(document, space, path)
        for layer in layers:
            entities = gather(drawn, {layer.upper()}, path)
            parts = []
            for shape, name in zip(entities.shapes, entities.names, strict=True):
                if len(shape.arcs) or shape.beziers.count or shape.chords[:, 4].any():
                    raise ReadError("unsupported", f"{name} is no straight line of a development", path)
                parts.append(np.concatenate([shape.chords[:1, :2], shape.chords[:, 2:4]]))
            found[layer] = parts
    return unit, found
