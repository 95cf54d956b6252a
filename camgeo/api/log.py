"""Log of the library by `logging`: stages at debug, files and verdicts at info, failed checks at warning."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import logging
    from collections.abc import Callable, Iterable, Iterator

    from camgeo.recipe.recipe import Order
    from kin.numeric.check import Check


def library_log() -> logging.Logger | None:
    """Logger `camgeo` of the library; None where `logging` was never imported, and so was not set up."""
    if "logging" not in sys.modules:
        return None
    import logging

    log = logging.getLogger("camgeo")
    if not log.handlers:
        log.addHandler(logging.NullHandler())  # without logging set up nothing is written
    return log


@contextmanager
def without_log() -> Iterator[None]:
    """Context in which nothing is logged, for results that are reported in another way."""
    if (log := library_log()) is None:
        yield
        return
    before, log.disabled = log.disabled, True
    try:
        yield
    finally:
        log.disabled = before


def stage_reporter(recipe: Order, progress: Callable[[str], None] | None = None) -> Callable[[str], None]:
    """Function for a clock that passes the name of each stage to the log and to `progress`."""

    def tell(stage: str) -> None:
        if log := library_log():
            log.debug("%s: %s", recipe.name, stage)
        if progress is not None:
            progress(stage)

    return tell


def log_failures(name: str, checks: Iterable[Check]) -> None:
    """Log the failed checks as warnings; `name` is the recipe's."""
    if log := library_log():
        for check in checks:
            if not check.ok:
                log.warning("%s: %s", name, check)
