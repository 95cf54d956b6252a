"""What the library reports by `logging`: stages at debug, files and verdicts at info, checks that fail at warning."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import logging
    from collections.abc import Callable, Iterable, Iterator

    from camgeo.recipe.recipe import Order
    from kin.judge.check import Check


def heard() -> logging.Logger | None:
    """Logger of the library; None where `logging` was never imported, and nobody can have set it up."""
    if "logging" not in sys.modules:
        return None
    import logging

    log = logging.getLogger("camgeo")
    if not log.handlers:
        log.addHandler(logging.NullHandler())  # without logging set up nothing is written
    return log


@contextmanager
def unsaid() -> Iterator[None]:
    """Tell nothing meanwhile, where all of it is reported in another way."""
    if (log := heard()) is None:
        yield
        return
    before, log.disabled = log.disabled, True
    try:
        yield
    finally:
        log.disabled = before


def staged(recipe: Order, progress: Callable[[str], None] | None = None) -> Callable[[str], None]:
    """Give what a clock reports of each stage as it begins: the log hears of it, and who wants to know."""

    def tell(stage: str) -> None:
        if log := heard():
            log.debug("%s: %s", recipe.name, stage)
        if progress is not None:
            progress(stage)

    return tell


def tell_checks(name: str, checks: Iterable[Check]) -> None:
    """Tell of the checks that fail."""
    if log := heard():
        for check in checks:
            if not check.ok:
                log.warning("%s: %s", name, check)
