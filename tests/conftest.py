"""What a quick run takes of all tests, and what every run of them needs.

Rows: a test marked `thin(n)` runs on a diagonal of its rows, those whose places in its parameters add up to a multiple
of n; the others are slow. A table of n cams by n faults so has each fault once, and each cam.

Parts: `-m slow --part 2/8` runs an eighth of the slow tests, and an eighth of the rows of each long table. `.ci/run`
runs as many parts as there is time for, and begins with another one for each commit.

Property tests: a run repeats the last one's examples, so that a change is judged by what it changes, whatever tests
ran before in the same process: constants of the modules that are imported by then are no examples.
`HYPOTHESIS_PROFILE=explore` looks for new ones, and what it finds becomes an example of its own. A quick run takes an
eighth of them; any other, such as `pytest -m slow`, takes all, and every property test counts as slow in it.

Time: the tests of a file run in one process of xdist, so that what they share is made once; compiled modules are kept
even where the shell asks for none (PYTHONDONTWRITEBYTECODE), since every process that a test starts would compile
the product anew; one thread for linear algebra, as the processes of xdist share the cores; and what was there before
the first test is not looked through for garbage again and again.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading
from contextlib import suppress
from typing import TYPE_CHECKING

import mpmath
import pytest
from hypothesis import HealthCheck, settings
from support.cases import FULL, left_to_other_parts, thinned_out
from support.designs import share

if TYPE_CHECKING:
    from collections.abc import Iterator

    from xdist.remote import Producer
    from xdist.scheduler import LoadFileScheduling

pytest_plugins = ["pytester", "support.work"]

sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
gc.disable()  # until all tests are collected
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # nothing has imported numpy yet

# A run in the background of a shell is born deaf to interrupts, and so would be the processes that tests interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

QUICK = "not slow"
DIGITS = 50  # of mpmath
UNTIMED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])  # a busy machine is no fault
with suppress(ImportError):  # should hypothesis move it, a test in test_thinned.py fails, and no other
    from hypothesis.internal.conjecture import providers

    providers.is_local_module_file = lambda _: False  # type: ignore[assignment]
settings.register_profile("quick", UNTIMED, derandomize=True, max_examples=FULL // 8)
settings.register_profile("repeat", UNTIMED, derandomize=True, max_examples=FULL)
settings.register_profile("explore", UNTIMED, max_examples=FULL)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--part", metavar="K/N", default="1/1", help="of slow tests, part K of N")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup() -> None:
    """Mpmath works in as many digits in every test, whatever was imported or run before."""
    mpmath.mp.dps = DIGITS


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown() -> None:
    """A test that leaves a timer running fails: it would write into the output of another test."""
    left = [thread for thread in threading.enumerate() if isinstance(thread, threading.Timer)]
    for timer in left:
        timer.cancel()
        timer.join()
    assert not left


@pytest.fixture(autouse=True)
def patient() -> Iterator[None]:
    """On a busy machine any command takes long: what is said of that is of the tests that ask for it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("camgeo.cli.progress.LONG", 3600.0)
        yield


def pytest_configure(config: pytest.Config) -> None:
    usual = "quick" if config.getoption("markexpr") == QUICK else "repeat"
    settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", usual))
    if usual == "quick":
        config.pluginmanager.register(share(), "designs")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    full = config.getoption("markexpr") != QUICK
    chance = [item for item in items if full and item.get_closest_marker("hypothesis")]
    for item in [*chance, *thinned_out(items)]:
        item.add_marker(pytest.mark.slow)
    part, parts = map(int, config.getoption("part").split("/"))
    if others := set(left_to_other_parts(items, part, parts)):
        config.hook.pytest_deselected(items=[*others])
        items[:] = [item for item in items if item not in others]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> LoadFileScheduling | None:
    """Give a file's tests to one process, unless `--dist` asks for another way."""
    if config.getvalue("dist") != "load":
        return None
    from xdist.scheduler import LoadFileScheduling

    return LoadFileScheduling(config, log)


def pytest_collection_finish() -> None:
    gc.enable()
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
