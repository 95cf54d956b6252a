"""The speed from which a preloaded contact is lost, of loads at two places, by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from camgeo.capabilities.dynamics.running import LossSpeed, Pull, lost

if TYPE_CHECKING:
    from collections.abc import Callable

PLACES = [30.0, 200.0]  # degrees


class Turn:
    """Two places of a turn: least and greatest value of each row, with its place."""

    @staticmethod
    def extremes(rows: Callable[[np.ndarray], np.ndarray]) -> list[tuple[SimpleNamespace, SimpleNamespace]]:
        def at(row: np.ndarray, place: int) -> SimpleNamespace:
            return SimpleNamespace(value=float(row[place]), at_deg=PLACES[place])

        return [(at(row, int(np.argmin(row))), at(row, int(np.argmax(row)))) for row in rows(np.radians(PLACES))]


def speeds(inertia: list[float], rest: list[float], doubts: tuple[float, ...] = (0.0,)) -> list[LossSpeed]:
    """Of contacts that are lost at a load of -9 and of 8."""

    def pull(t: np.ndarray, more: float) -> Pull:
        return Pull(np.array(inertia), np.array(rest) + more, np.full(len(t), -9.0), np.full(len(t), 8.0))

    return lost(Turn(), ["first", "second"], pull, doubts)


def rpm(squared: float) -> float:
    return 30.0 / math.pi * math.sqrt(squared)


@pytest.mark.parametrize(
    ("inertia", "rest", "first", "second"),
    [
        ([2.0, -1.0], [0.0, 0.0], (rpm(9.0), 200.0), (rpm(4.0), 30.0)),
        ([2.0, -1.0], [2.0, -5.0], (rpm(4.0), 200.0), (rpm(3.0), 30.0)),
        ([2.0, 4.0], [2.0, -16.0 + 8.0], (None, None), (rpm(3.0), 30.0)),
        ([2.0, -1.0], [9.0, 0.0], (rpm(9.0), 200.0), (0.0, 30.0)),
        ([2.0, -1.0], [0.0, -9.0], (0.0, 200.0), (rpm(4.0), 30.0)),
        ([0.0, 0.0], [0.0, 0.0], (None, None), (None, None)),
    ],
)
def test_the_least_speed_at_which_the_load_is_reached(
    inertia: list[float], rest: list[float], first: tuple[float, float], second: tuple[float, float]
) -> None:
    """Omega^2 J + W = L at the place where that takes the least; at once where W alone is so much, else never."""
    found = speeds(inertia, rest)
    assert [loss.contact for loss in found] == ["first", "second"]
    for (_, speed, at), (expected, place) in zip(found, (first, second), strict=True):
        assert speed == (None if expected is None else pytest.approx(expected, abs=1e-9))
        assert at == place


def test_of_doubts_the_earlier_counts_for_each_contact() -> None:
    found = speeds([2.0, -1.0], [0.0, 0.0], (0.0, 4.0, -5.0))
    assert [loss.rpm for loss in found] == pytest.approx([rpm(4.0), rpm(2.0)])
