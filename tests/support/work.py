"""The work of a quick test, counted and never timed: with `--work`, one of more than MOST exports of shu-wu says why.

Counted are calls of a few functions through which what takes long goes, each by what it costs against an evaluation of
a law; an evaluation costs more the more numbers it is of. What a fixture of more than one test does, counts for none of
them. `@pytest.mark.costly("reason")` is the reason of a test.
"""

from __future__ import annotations

import functools
import tempfile
from importlib import import_module
from typing import TYPE_CHECKING, Any

import pytest

from support.places import RECIPES

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

MOST = 7.0  # exports of shu-wu in a process that has made one: in time, less than three runs of the command
NUMBERS = 1000.0  # of an evaluation, which cost as much as its call
COUNTED = {
    "kin.law.piecewise Piecewise.at": 1.0,
    "kin.contour.nearest _foot": 5.0,
    "camgeo.synthesis.design _checked": 80.0,
    "kin.judge.verify _verdict": 120.0,
    "subprocess Popen.__init__": 1500.0,
}


def numbers(_: object, t: Any, *__: object) -> float:
    """How many numbers a jet, or a ball jet, has."""
    return float(t.c.size if hasattr(t, "c") else 2 * t.mid.size)


class Work:
    """Work since the count began; `export` is that of an export of shu-wu."""

    def __init__(self) -> None:
        self.done, self.begun, self.export = 0.0, 0.0, 0.0
        self._undo: list[Callable[[], None]] = []

    def count(self) -> None:
        """Begin to count."""
        for place, weight in COUNTED.items():
            module, _, names = place.partition(" ")
            *owners, name = names.split(".")
            owner = functools.reduce(getattr, owners, import_module(module))
            real = getattr(owner, name)
            self._undo.append(functools.partial(setattr, owner, name, real))
            setattr(owner, name, self._counting(real, weight, numbers if name == "at" else None))

    def _counting(self, real: Any, weight: float, size: Callable[..., float] | None) -> Any:
        @functools.wraps(real)
        def called(*given: Any, **named: Any) -> Any:
            self.done += weight if size is None else weight * (1.0 + size(*given, **named) / NUMBERS)
            return real(*given, **named)

        return called

    def stop(self) -> None:
        """Count no more."""
        while self._undo:
            self._undo.pop()()

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef[Any]) -> Generator[None, Any, Any]:
        before = self.done
        try:
            return (yield)
        finally:
            if fixturedef.scope != "function":
                self.done = before

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self) -> None:
        if not self.export:
            import camgeo

            for _ in range(2):  # the first one makes what is kept for all others
                before = self.done
                with tempfile.TemporaryDirectory() as written:
                    camgeo.export(RECIPES / "shu-wu.yaml", written)
            self.export = self.done - before
        self.begun = self.done

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Generator[None, Any, Any]:
        result = yield
        exports = (self.done - self.begun) / self.export
        if exports > MOST and not any(map(item.get_closest_marker, ("slow", "costly"))):
            told = (
                f"the work of {exports:.1f} exports of shu-wu: do with less, or mark it slow, or costly with a reason"
            )
            pytest.fail(told, pytrace=False)
        return result

    def pytest_unconfigure(self) -> None:
        self.stop()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--work", action="store_true", help="fail quick tests of much work that give no reason for it")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--work"):
        work = Work()
        work.count()
        config.pluginmanager.register(work, "work")
