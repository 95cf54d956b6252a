"""Quintics from values and two derivatives: against the functions themselves, and Hermite's remainder."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kin.numeric.quintics import Quintics

TURN = 2.0 * np.pi


def wave(x: np.ndarray) -> np.ndarray:
    return np.stack([np.sin(2.0 * x), 2.0 * np.cos(2.0 * x), -4.0 * np.sin(2.0 * x)])


def followed(count: int, begin: float = 0.0) -> Quintics:
    x = begin + np.linspace(0.0, TURN, count + 1)
    return Quintics(x, wave(x[:-1]), wave(x[1:]))


@pytest.mark.parametrize("count", [20, 40, 80])
def test_a_wave_is_missed_by_no_more_than_the_remainder(count: int) -> None:
    x = np.linspace(-3.0, 9.0, 4001)
    off = np.abs(followed(count, 0.3)(x, 2) - wave(x)).max(axis=1)
    bound = (TURN / count) ** 6 * 2.0**6 / 46080.0
    assert 0.8 * bound < off[0] <= bound + 1e-15
    assert off[1] < 40.0 * bound / (TURN / count)
    assert off[2] < 400.0 * bound / (TURN / count) ** 2


@given(st.lists(st.floats(-2.0, 2.0), min_size=6, max_size=6), st.floats(0.0, 1.0, exclude_max=True))
def test_polynomials_of_degree_five_are_their_own(powers: list[float], share: float) -> None:
    of = np.polynomial.Polynomial(powers)
    rows = [of, of.deriv(), of.deriv(2)]
    x = np.array([-1.0, 0.5, 2.0])
    ends = np.array([f(x) for f in rows])
    at = np.array([-1.0 + 3.0 * share])
    expected = np.array([f(at) for f in rows])
    assert Quintics(x, ends[:, :-1], ends[:, 1:])(at, 2) == pytest.approx(expected, abs=1e-11)


def test_at_a_node_the_side_counts_and_the_period_goes_on() -> None:
    x = np.array([0.0, 1.0, 3.0])
    low, high = np.array([[0.0, 1.0], [1.0, -0.5], [0.0, 0.0]]), np.array([[1.0, 0.0], [1.0, -0.5], [0.0, 0.0]])
    of = Quintics(x, low, high)
    for shift in (-3.0, 0.0, 3.0):
        node = np.array([1.0 + shift])
        assert of(node, 1)[1] == pytest.approx([-0.5])
        assert of(node, 1, -1)[1] == pytest.approx([1.0])
    assert of(np.array([0.0, 3.0, 6.0]), 1)[1] == pytest.approx([1.0, 1.0, 1.0])
    assert of(np.array([0.0, 3.0, 6.0]), 1, -1)[1] == pytest.approx([-0.5, -0.5, -0.5])
    assert of(np.array([0.5, 2.0, 3.5, -1.0]), 0)[0] == pytest.approx([0.5, 0.5, 0.5, 0.5])


def test_intervals_without_a_width_have_their_value() -> None:
    x = np.array([0.0, 1.0, 1.0, 2.0])
    values = np.array([[0.0, 1.0, 1.0], [1.0, 0.0, -1.0], [0.0, 0.0, 0.0]])
    of = Quintics(x, values, np.array([[1.0, 1.0, 0.0], [1.0, 0.0, -1.0], [0.0, 0.0, 0.0]]))
    assert of.within(np.array([1]), np.array([1.0]), 0) == pytest.approx(1.0)
    assert of(np.array([0.25, 1.75]), 0)[0] == pytest.approx([0.25, 0.25])


@pytest.mark.parametrize(
    ("begin", "end", "least", "greatest"),
    [
        (0.1, 0.6, np.sin(0.2), np.sin(1.2)),
        (0.1, 2.0, np.sin(4.0), 1.0),
        (5.0, 5.0 + 0.9 * TURN, -1.0, 1.0),
        (6.2, 6.4, np.sin(12.4), np.sin(12.8)),
        (6.3, 6.2 + TURN, -1.0, 1.0),
    ],
)
def test_extremes_from_one_place_to_another(begin: float, end: float, least: float, greatest: float) -> None:
    found = followed(200).extremes(begin, end, 1e-12)
    assert (found.least, found.greatest) == pytest.approx((least, greatest), abs=1e-11)
