"""Seconds of each stage of a run."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


@dataclass()
class Clock:
    """Clock of a run: `stages` has (name, seconds) of each stage, in the order of their ends.

    `report` is called with the name of each stage as it begins. The seconds of a stage leave out those of stages within
    it, so that no second counts twice.
    """

    report: Callable[[str], None] | None = None
    stages: list[tuple[str, float]] = field(default_factory=list)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Context that adds a stage and the seconds spent in the context to `stages`."""
        if self.report is not None:
            self.report(name)
        start, first = time.perf_counter(), len(self.stages)
        try:
            yield
        finally:
            within = sum(seconds for _, seconds in self.stages[first:])
            self.stages.append((name, time.perf_counter() - start - within))
