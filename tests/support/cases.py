"""How many of many cases a quick run takes; `pytest -m slow` takes the others."""

from __future__ import annotations

from typing import TYPE_CHECKING
from zlib import crc32

import pytest
from _pytest.mark import ParameterSet
from hypothesis import settings

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


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
    return max(3, full * settings().max_examples // FULL)


def thinned_out(items: Iterable[pytest.Item]) -> Iterator[pytest.Item]:
    """Rows of tests marked `thin(every)` that are left to the slow run: those off the diagonal of the parameters.

    A row's place in a parameter is told by its name there, among the rows that are not slow anyway: the first stays.
    """
    seen: dict[str, list[dict[str, int]]] = {}
    for item in items:
        thin = item.get_closest_marker("thin")
        if thin is not None and item.get_closest_marker("slow") is None:
            names = item.callspec._idlist  # type: ignore[attr-defined]
            places = seen.setdefault(item.nodeid.split("[")[0], [{} for _ in names])
            number = sum(known.setdefault(name, len(known)) for name, known in zip(names, places, strict=True))
            if number % thin.args[0]:
                yield item


def left_to_other_parts(items: Iterable[pytest.Item], part: int, parts: int) -> list[pytest.Item]:
    """Slow tests that part number `part` of `parts` leaves to the others; each is in one part.

    The rows of a table are dealt out over all parts, in an order that their names give, so that no part has one value
    of a parameter alone; which part begins is told by the table's name, so that single tests are dealt out too.
    """
    tables: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.get_closest_marker("slow") is not None:
            tables.setdefault(item.nodeid.split("[")[0], []).append(item)
    left = []
    for name, rows in tables.items():
        dealt = enumerate(sorted(rows, key=lambda item: crc32(item.nodeid.encode())), start=crc32(name.encode()))
        left += [item for number, item in dealt if number % parts != part - 1]
    return left
