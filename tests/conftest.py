"""Pytest's own fixtures that tests of the plugin need, and how property tests choose their examples.

A run repeats the last one's examples, so that a change is judged by what it changes; `HYPOTHESIS_PROFILE=explore` looks
for new ones, and what it finds becomes an example of its own. A quick run takes a quarter of them; any other, such as
`pytest -m slow`, takes all, and every property test counts as slow in it.
"""

from __future__ import annotations

import os
import signal

import mpmath
import pytest
from hypothesis import settings
from support.cases import FULL

pytest_plugins = ["pytester"]

# A run in the background of a shell is born deaf to interrupts, and so would be the processes that tests interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

QUICK = "not slow"
DIGITS = 50  # of mpmath
settings.register_profile("quick", derandomize=True, deadline=None, max_examples=FULL // 4)
settings.register_profile("repeat", derandomize=True, deadline=None, max_examples=FULL)
settings.register_profile("explore", deadline=None, max_examples=FULL)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup() -> None:
    """Mpmath works in as many digits in every test, whatever was imported or run before."""
    mpmath.mp.dps = DIGITS


def pytest_configure(config: pytest.Config) -> None:
    usual = "quick" if config.getoption("markexpr") == QUICK else "repeat"
    settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", usual))


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("markexpr") != QUICK:
        for item in items:
            if item.get_closest_marker("hypothesis"):
                item.add_marker(pytest.mark.slow)
