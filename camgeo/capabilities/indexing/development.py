"""Developments of a barrel."""

from __future__ import annotations

from typing import Any


def developed(design: Any, request: Any, mm: float) -> Any:  # noqa: ANN401
    """Lines of a requested development."""
    raise NotImplementedError


def write_development(design: Any, request: Any, path: Any, tolerance: float, mm: float) -> Any:  # noqa: ANN401
    """Write a development."""
    raise NotImplementedError


def unrolled(design: Any, tolerance: float) -> Any:  # noqa: ANN401
    """Lines on the blank."""
    raise NotImplementedError
