"""Polynomials by their Bernstein coefficients: against exact fractions, and one way of working them out by another."""

from fractions import Fraction
from math import comb

import numpy as np
import pytest

from kin.numeric.bernstein import bernstein_product, halves, restrict, rising_root, split, values, values_and_slopes
from kin.numeric.errors import UnsettledError

EPS = float(np.finfo(float).eps)


def exact(row, t):
    """Value of a polynomial at a number, in fractions."""
    k, t = len(row) - 1, Fraction(float(t))
    return sum(Fraction(c) * comb(k, i) * t**i * (1 - t) ** (k - i) for i, c in enumerate(row))


@pytest.mark.thin(3)
@pytest.mark.parametrize("degree", [0, 1, 3, 25, 49])
def test_values_are_exact_to_rounding_and_at_both_ends_to_the_bit(degree):
    rng = np.random.default_rng(degree)
    rows = rng.normal(size=(12, degree + 1, 2))
    t = np.concatenate([[0.0, 1.0, 0.5, 1e-12, 1.0 - 1e-12], rng.random(7)])
    found = values(rows, t)
    assert np.array_equal(found[0], rows[0, 0])
    assert np.array_equal(found[1], rows[1, -1])
    for n in range(12):
        for c in (0, 1):
            size = float(exact(np.abs(rows[n, :, c]), t[n]))
            assert abs(Fraction(float(found[n, c])) - exact(rows[n, :, c], t[n])) <= (4 * degree + 4) * EPS * size
    assert np.array_equal(values(rows[:, :, 0], t), found[:, 0])


@pytest.mark.parametrize("degree", [1, 2, 5, 25])
def test_slopes_come_with_the_same_values_and_are_exact_to_rounding(degree):
    rng = np.random.default_rng(degree)
    rows = rng.normal(size=(11, degree + 1))
    t = np.concatenate([[0.0, 1.0, 0.5, 1e-12, 1.0 - 1e-12], rng.random(6)])
    found, slopes = values_and_slopes(rows, t)
    assert np.array_equal(found, values(rows, t))
    for row, at, slope in zip(rows, t, slopes, strict=True):
        true = degree * exact(np.diff([Fraction(float(c)) for c in row]), at)
        size = degree * float(np.abs(row).max())
        assert abs(Fraction(float(slope)) - true) <= (4 * degree + 4) * EPS * size


@pytest.mark.parametrize(("j", "k"), [(0, 3), (1, 1), (5, 2), (2, 5), (20, 19)])
def test_products_have_the_values_of_both_factors_multiplied(j, k):
    rng = np.random.default_rng(j + k)
    f, g, t = rng.normal(size=(6, j + 1)), rng.normal(size=(6, k + 1)), rng.random(6)
    found = bernstein_product(f, g)
    assert found.shape == (6, j + k + 1)
    assert values(found, t) == pytest.approx(values(f, t) * values(g, t), abs=1e-13)
    assert found == pytest.approx(bernstein_product(g, f), abs=1e-15)


@pytest.mark.parametrize("degree", [1, 4, 20])
def test_parts_are_the_same_polynomial_over_less(degree):
    rng = np.random.default_rng(degree)
    rows, t = rng.normal(size=(8, degree + 1, 3)), rng.random(8)
    at = np.concatenate([[0.0, 1.0, 0.5], rng.random(5)])
    left, right = split(rows, at)
    assert values(left, t) == pytest.approx(values(rows, at * t), abs=1e-13)
    assert values(right, t) == pytest.approx(values(rows, at + (1.0 - at) * t), abs=1e-13)
    assert left == pytest.approx(restrict(rows, np.zeros(8), at), abs=1e-13)
    assert right == pytest.approx(restrict(rows, at, np.ones(8)), abs=1e-13)
    for part, half in zip(split(rows, np.full(8, 0.5)), halves(rows), strict=True):
        assert np.array_equal(part, half)
    inner = restrict(rows, 0.25 * at, 0.25 * at + 0.5)
    assert values(inner, t) == pytest.approx(values(rows, 0.25 * at + 0.5 * t), abs=1e-13)


@pytest.mark.parametrize("degree", [1, 3, 9])
def test_rising_roots_are_found_or_the_end_beyond_which_they_lie(degree):
    rng = np.random.default_rng(degree)
    rows = np.cumsum(rng.exponential(size=(200, degree + 1)), axis=1)
    at = rng.random(200)
    rows -= values(rows, at)[:, None]
    assert rising_root(rows) == pytest.approx(at, abs=1e-13)
    for end, beyond in ((0, 1e-9), (-1, -1e-9), (0, 0.0), (-1, 0.0)):
        assert (rising_root(rows - rows[:, [end]] + beyond) == -end).all()


def test_a_polynomial_that_falls_from_zero_first_rises_through_it_inside():
    rows = np.array([[0.0, -1.0, 1.0], [0.0, 0.0, -1.0], [0.0, 1.0, 2.0], [-2.0, -1.0, 0.0], [-1.0, 1.0, 0.0]])
    assert rising_root(rows) == pytest.approx([2.0 / 3.0, 1.0, 0.0, 1.0, 1.0 / 3.0], abs=1e-15)


def test_a_root_of_what_is_not_a_number_is_refused():
    with pytest.raises(UnsettledError, match="1 zeros were not found"):
        rising_root(np.array([[-1.0, 1.0], [-1.0, np.nan]]))
