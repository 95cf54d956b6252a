"""Contours read back from files: DXF of any origin, STL of a plain part."""

from __future__ import annotations

from kin.read_dxf import Aside, Drawing, Fault, read_dxf
from kin.read_error import ReadError
from kin.read_stl import Solid, read_stl

__all__ = ["Aside", "Drawing", "Fault", "ReadError", "Solid", "read_dxf", "read_stl"]
