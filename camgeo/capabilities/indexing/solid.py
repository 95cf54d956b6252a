"""The cam as a mesh."""

from __future__ import annotations

from typing import Any


def index_mesh(design: Any, tolerance: float, precision: Any) -> Any:  # noqa: ANN401
    """The mesh, and facts about it."""
    raise NotImplementedError
