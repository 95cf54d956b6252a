"""Tables that capabilities add to: order by the places that entries state, and no import for what the core has."""

from typing import NamedTuple

import pytest

from camgeo.registry.gathered import Gathered


class Place(NamedTuple):
    after: str = ""


ADDED = {"early": {"x": Place("a"), "y": Place()}, "late": {"z": Place("a"), "w": Place("b")}}


class Asked:
    """A question that two capabilities answer, with the names of those that were asked."""

    def __init__(self):
        self.names = []

    def __getitem__(self, name):
        self.names.append(name)
        return ADDED[name]

    def answering(self):
        return tuple(ADDED)

    def loaded(self):
        return ()

    def of(self, names):
        return [self[name] for name in ADDED if name in names]


@pytest.fixture
def table():
    slot = Asked()
    core = {"a": Place(), "b": Place(), "c": Place()}
    return Gathered(core, slot, lambda answers: answers), slot.names


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
