"""In a quick run designs of equal recipes are made once in a process: most tests ask for one that others ask for too.

A test that patches anything has its own, as what it patches may be what makes a design; so have all tests of any other
run. The stages that a run tells of are told alike.
"""

from __future__ import annotations

import functools
import pickle
from collections import OrderedDict
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

MOST = 64  # designs that are kept
OWN = {"name", "path"}  # of a recipe, not of its design


class Designs:
    """Designs that were made, each with the names of its stages, by all that its recipe says."""

    def __init__(self, make: Callable[..., Any]) -> None:
        self.make, self.kept, self.shared = make, OrderedDict[bytes, tuple[Any, list[str]]](), True

    def designed(self, recipe: Any, clock: Any = None) -> Any:
        from camgeo.common.clock import Clock

        if not self.shared:
            return self.make(recipe, clock)
        clock = clock or Clock()
        says = [(field.name, getattr(recipe, field.name)) for field in fields(recipe) if field.name not in OWN]
        key = pickle.dumps(says)
        if key in self.kept:
            design, stages = self.kept[key]
            for name in stages:
                with clock.stage(name):
                    pass
        else:
            before = len(clock.stages)
            design = self.make(recipe, clock)
            self.kept[key] = design, [name for name, _ in clock.stages[before:]]
        self.kept.move_to_end(key)
        if len(self.kept) > MOST:
            self.kept.popitem(last=False)
        return design

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        self.shared = "monkeypatch" not in getattr(item, "fixturenames", ())


def share() -> Designs:
    """Let all that asks for designs from now on ask here."""
    from camgeo.synthesis import design

    designs = Designs(design.designed)

    @functools.wraps(design.designed)
    def designed(recipe: Any, clock: Any = None) -> Any:
        return designs.designed(recipe, clock)

    design.designed = designed
    return designs
