"""What the library reports by `logging`: stages at debug, files and verdicts at info, checks that fail at warning."""

from __future__ import annotations

import logging
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from camgeo.recipe.recipe import Order
    from kin.judge.check import Check

LOG = logging.getLogger("camgeo")
LOG.addHandler(logging.NullHandler())  # without logging set up nothing is written


@contextmanager
def unsaid() -> Iterator[None]:
    """Tell nothing meanwhile, where all of it is reported in another way."""
    before, LOG.disabled = LOG.disabled, True
    try:
        yield
    finally:
        LOG.disabled = before


def staged(recipe: Order, progress: Callable[[str], None] | None = None) -> Callable[[str], None]:
    """Give what a clock reports of each stage as it begins: the log hears of it, and who wants to know."""

    def tell(stage: str) -> None:
        LOG.debug("%s: %s", recipe.name, stage)
        if progress is not None:
            progress(stage)

    return tell


def tell_checks(name: str, checks: Iterable[Check]) -> None:
    """Tell of the checks that fail."""
    for check in checks:
        if not check.ok:
            LOG.warning("%s: %s", name, check)
