"""Tables that capabilities add to: order by the places that entries state, and no import for what the core has.

Holds: camgeo.registry.registry, camgeo.registry.capability, camgeo.registry.label.
"""

from types import SimpleNamespace
from typing import NamedTuple

import pytest

from camgeo.registry import registry
from camgeo.registry.gathered import Gathered


class Place(NamedTuple):
    after: str = ""


ADDED = {"early": {"x": Place("a"), "y": Place()}, "late": {"z": Place("a"), "w": Place("b")}}


@pytest.fixture
def table(monkeypatch):
    asked = []

    def record(name):
        asked.append(name)
        return SimpleNamespace(name=name)

    monkeypatch.setattr(registry, "names_with_record", lambda: ("early", "late"))
    monkeypatch.setattr(registry, "names_loaded", lambda: ())
    monkeypatch.setattr(registry, "capability", record)
    monkeypatch.setattr(registry, "in_order", lambda names: [record(name) for name in ADDED if name in names])
    core = {"a": Place(), "b": Place(), "c": Place()}
    return Gathered(core, lambda capability: ADDED[vars(capability)["name"]]), asked


def test_entries_stand_behind_the_ones_they_name(table):
    assert list(table[0]) == ["a", "x", "z", "b", "w", "c", "y"]
    assert len(table[0]) == 7


def test_those_of_some_capabilities(table):
    assert list(table[0].among(("late",))) == ["a", "z", "b", "w", "c"]
    assert list(table[0].among(())) == ["a", "b", "c"]


def test_a_name_of_the_core_imports_nothing(table):
    gathered, asked = table
    assert gathered["b"] == Place()
    assert "c" in gathered
    assert asked == []
    assert (gathered.owner("w"), gathered.owner("a")) == ("late", "")
    assert gathered["y"] == Place()
    assert "nothing" not in gathered
    with pytest.raises(KeyError):
        gathered["nothing"]
