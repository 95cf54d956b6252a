"""Instants at which a state ends."""

import math

import pytest

from kin.dynamics.events import Work, crossing

TURN = 2.0 * math.pi


@pytest.mark.parametrize(
    ("level", "root"),
    [
        (lambda x: math.cos(x) - x, 0.7390851332151607),
        (lambda x: 1e-3 - x**5, 10.0**-0.6),
        (lambda x: 1.0 - math.exp(20.0 * x - 5.0), 0.25),
        (lambda x: math.atan(1e6 * (0.3 - x)), 0.3),
        (lambda x: 1.0 if x < 0.4 else -1.0, 0.4),
    ],
)
def test_an_instant_is_found_to_the_last_bits_and_on_its_later_side(level, root):
    found = crossing(level, 0.0, 2.0, 0.0, Work(10**6))
    assert found == pytest.approx(root, abs=2e-15)
    assert level(found) < 0.0


def test_an_instant_is_where_the_search_begins_if_the_state_has_ended_there():
    assert crossing(lambda x: -1.0 - x, 0.5, 2.0, 0.0, Work(10**6)) == 0.5
