"""How many of many cases a quick run takes; `pytest -m slow` takes the others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from _pytest.mark import ParameterSet
from hypothesis import settings

if TYPE_CHECKING:
    from collections.abc import Iterable


FULL = 100  # examples of a property test that names no number, in a full run


def few(cases: Iterable[object], every: int = 2, *, first: int = 0) -> list[ParameterSet]:
    """Cases for parametrisation: of `every` in a row, number `first` runs each time and the others are slow."""
    chosen = []
    for number, case in enumerate(cases):
        values, marks, name = case if isinstance(case, ParameterSet) else ((case,), (), None)
        if isinstance(case, tuple) and not isinstance(case, ParameterSet):
            values = case
        slow = () if number % every == first else (pytest.mark.slow,)
        chosen.append(pytest.param(*values, marks=(*marks, *slow), id=name))
    return chosen


def examples(full: int) -> int:
    """How many examples a property test takes that takes `full` in a full run."""
    return max(4, full * settings().max_examples // FULL)
