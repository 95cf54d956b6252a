# needs: follow
"""Drawings by ezdxf of contours that a follower follows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from support.heavy import ezdxf

if TYPE_CHECKING:
    from pathlib import Path


def polygon(path: Path, points: np.ndarray[Any, Any], *, unit: int = 4) -> Path:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = unit
    document.modelspace().add_lwpolyline(points.tolist(), close=True, dxfattribs={"layer": "0"})
    document.saveas(path)
    return path


def circle(count: int, radius: float, middle: tuple[float, float]) -> np.ndarray[Any, Any]:
    angle = 2.0 * np.pi * np.arange(count) / count
    return np.column_stack((middle[0] + radius * np.cos(angle), middle[1] + radius * np.sin(angle)))
