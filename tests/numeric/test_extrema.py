"""Extremes from values and two derivatives: against calculus, and against dense sampling."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kin.numeric.extrema import extremes


def found(function, ends, resolution=1e-12):
    """Extremes of a function that gives f, f', f'' and may ask for the interval."""
    low, high = np.asarray(ends[:-1], dtype=float), np.asarray(ends[1:], dtype=float)
    every = np.arange(len(low))
    return extremes(low, high, function(low, every), function(high, every), function, resolution=resolution)


def sine(x, _of):
    return np.stack([np.sin(x), np.cos(x), -np.sin(x)])


def test_a_sine_over_few_intervals():
    result = found(sine, [0.0, 1.3, 4.0, 6.2])
    assert result.greatest == pytest.approx(1.0, abs=1e-12)
    assert result.greatest_at == pytest.approx(np.pi / 2, abs=1e-5)
    assert result.least == pytest.approx(-1.0, abs=1e-12)
    assert result.least_at == pytest.approx(3 * np.pi / 2, abs=1e-5)
    assert (result.greatest_index, result.least_index) == (1, 2)
    assert result.span == pytest.approx(2.0, abs=2e-12)


def test_extremes_at_the_ends_and_the_worst_of_both():
    result = found(lambda x, _of: np.stack([x**3, 3 * x**2, 6 * x]), [-2.0, 0.5, 1.5])
    assert (result.least, result.least_at) == (-8.0, -2.0)
    assert (result.greatest, result.greatest_at) == (1.5**3, 1.5)
    assert result.worst == (8.0, -2.0)


def test_one_sided_values_at_a_step_between_intervals():
    """f = x on the first interval, x - 1 on the second: the left limit at the joint counts."""

    def steps(x, of):
        return np.stack([x - of, np.ones_like(x), np.zeros_like(x)])

    result = found(steps, [0.0, 1.0, 2.0])
    assert (result.greatest, result.least) == (1.0, 0.0)


def test_an_undeclared_corner_inside_an_interval_is_closed_in_on():
    def roof(x, _of):
        return np.stack([-np.abs(x - 0.3), np.where(x < 0.3, 1.0, -1.0), np.zeros_like(x)])

    assert found(roof, [0.0, 1.0]).greatest == pytest.approx(0.0, abs=1e-12)


@given(
    st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6),
    st.lists(st.floats(0.0, 1.0), max_size=5),
    st.sampled_from([1e-4, 1e-8, 1e-12]),
)
def test_trigonometric_polynomials_against_dense_sampling(amplitudes, inner, resolution):
    k = np.arange(1, 4)[:, None]
    a, b = np.array(amplitudes[:3])[:, None], np.array(amplitudes[3:])[:, None]

    def f(x, _of=None):
        c, s = np.cos(k * x), np.sin(k * x)
        rows = [a * c + b * s, k * (b * c - a * s), -k * k * (a * c + b * s)]
        return np.stack([row.sum(axis=0) for row in rows])

    result = found(f, np.unique([0.0, *inner, 1.0]) * 6.0, resolution)
    dense = f(np.linspace(0.0, 6.0, 20001))[0]
    curvature = 9 * np.abs(amplitudes).sum()
    for value, seen in ((result.greatest, dense.max()), (-result.least, -dense.min())):
        assert seen - 2 * resolution - 1e-14 <= value <= seen + curvature * (3e-4) ** 2 / 8 + 2 * resolution


def test_resolution_is_kept_on_the_dot_of_noise():
    """Values of size 1e3 with rounding noise do not make it halve for ever, and noise is all that is lost."""
    result = found(lambda x, _of: sine(x, None) + np.array([[1e3], [0.0], [0.0]]), np.linspace(0.0, 7.0, 2000))
    assert result.greatest == pytest.approx(1001.0, abs=1e-12)
