"""Tables whose values are made at first use: once, and of known names alone."""

import pytest

from camgeo.common.on_demand import OnDemand


def test_values_are_made_once_and_names_may_change():
    made, names = [], {"a": 1, "b": 2}

    def make(name):
        made.append(name)
        return name.upper()

    table = OnDemand(names, make)
    assert list(table) == ["a", "b"]
    assert "a" in table
    assert made == []
    assert (table["a"], table["a"], made) == ("A", "A", ["a"])
    names["c"] = 3
    assert (len(table), table["c"]) == (3, "C")
    del names["a"]
    with pytest.raises(KeyError):
        table["a"]
