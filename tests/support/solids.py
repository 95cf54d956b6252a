"""What a sound mesh is, as its reader tells it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kin.read.mesh.stl import Solid


def sound(solid: Solid) -> bool:
    """Whether the mesh is closed and its triangles all face the same side."""
    return solid.edges[:2] == (0, 0) and solid.edges.misdirected == 0
