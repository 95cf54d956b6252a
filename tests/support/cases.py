"""How many of many cases a quick run takes; `pytest -m slow` takes the others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from collections.abc import Iterable

    from _pytest.mark import ParameterSet

FULL = 100  # examples of a property test that names no number, in a full run


def few(cases: Iterable[object], every: int = 2, *, first: int = 0) -> list[ParameterSet]:
    """Cases for parametrisation: of `every` in a row, number `first` runs each time and the others are slow."""
    taken = [case if isinstance(case, tuple) else (case,) for case in cases]
    return [pytest.param(*c, marks=() if i % every == first else pytest.mark.slow) for i, c in enumerate(taken)]


def examples(full: int) -> int:
    """How many examples a property test takes that takes `full` in a full run."""
    return max(4, full * settings().max_examples // FULL)
