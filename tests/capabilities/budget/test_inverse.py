"""The widest tolerances against closed forms and an independent solver's worked cases."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from support.made_cases import CASES

from camgeo.capabilities.budget.influence import Contribution, Influence, influence
from camgeo.capabilities.budget.inverse import TakenError, left_for, widest
from camgeo.capabilities.budget.keys import Budget
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed

NAMES = ("profile", "follower.radius", "follower.offset", "angle", "bore")
# costs; for one angle of 50 degrees and all whole degrees, by worst case and squares: tolerances and cost
WORKED = [
    (
        (4, 1, 1.5, 0.02, 2),
        "one",
        "worst",
        (0.0169832791, 0.0084916396, 0.0209579962, 0.0002479842, 0.0120089918),
        672.05255788,
    ),
    (
        (4, 1, 1.5, 0.02, 2),
        "one",
        "rss",
        (0.0308303437, 0.0194218995, 0.0565898953, 0.0006434652, 0.0244700600),
        320.55132621,
    ),
    (
        (4, 1, 1.5, 0.02, 2),
        "all",
        "worst",
        (0.015064523, 0.007532261, 0.013389119, 0.000257785, 0.010652226),
        775.65631710,
    ),
    (
        (4, 1, 1.5, 0.02, 2),
        "all",
        "rss",
        (0.027627805, 0.017404427, 0.032738955, 0.000712457, 0.021928204),
        367.33389764,
    ),
    (
        (4, 1, 0.5, 0.5, 2),
        "all",
        "worst",
        (0.011354944, 0.005677472, 0.006145709, 0.000933005, 0.008029158),
        1394.75691714,
    ),
    (
        (4, 1, 0.5, 0.5, 2),
        "all",
        "rss",
        (0.023615416, 0.014876780, 0.028249025, 0.001458376, 0.018743569),
        703.84981674,
    ),
]
BINDING = {("all", "worst", 0.5): (49, 212), ("all", "rss", 0.5): (50, 212), ("all", "worst", 1.5): (214,)}


def rows_of(degrees: np.ndarray, tolerance: float | None = None) -> Influence:
    recipe = load_text(CASES["roller on a stem"].cam, "a.yaml")
    budget = Budget(0.05, tuple((name, tolerance) for name in NAMES))
    return influence(recipe, designed(recipe), budget, np.radians(degrees))


@pytest.mark.parametrize(("costs", "angles", "kind", "tolerances", "cost"), WORKED)
def test_the_worked_splits(costs, angles, kind, tolerances, cost) -> None:
    rows = rows_of(np.array([50.0]) if angles == "one" else np.arange(360.0))
    split = widest(rows, 0.05, dict(zip(NAMES, costs, strict=True)), kind)
    assert split.cost == pytest.approx(cost, rel=1e-10)
    assert [split.tolerances[name] for name in NAMES] == pytest.approx(tolerances, abs=1e-9)
    if expected := BINDING.get((angles, kind, costs[2])):
        assert np.degrees(split.binding) == pytest.approx(expected)


# costs 4, 1, 1.5 over tolerance^exponent at one angle, permitted 0.05
EXPONENTS = [
    (2, "worst", (0.025408163, 0.016006139, 0.029373075)),
    (2, "rss", (0.037806863, 0.026733489, 0.060051943)),
    (3, "worst", (0.024545388, 0.017356210, 0.027365414)),
    (3, "rss", (0.037254670, 0.028233760, 0.053944337)),
]


@pytest.mark.parametrize(("exponent", "kind", "tolerances"), EXPONENTS)
def test_the_worked_splits_of_other_exponents(exponent, kind, tolerances) -> None:
    weights = np.array([[1.03], [1.03], [0.25]])
    split = widest(made(weights, [None] * 3), 0.05, {"a": 4.0, "b": 1.0, "c": 1.5}, kind, exponent)
    assert [*split.tolerances.values()] == pytest.approx(tolerances, abs=2e-9)
    assert split.cost == pytest.approx((np.array([4.0, 1.0, 1.5]) / np.array(tolerances) ** exponent).sum(), rel=1e-6)


def made(weights: np.ndarray, tolerances: list[float | None]) -> Influence:
    """Contributions with given influences (c, n)."""
    named = zip("abcdef", tolerances, weights, strict=False)
    rows = tuple(Contribution(name, size, row[None, None]) for name, size, row in named)
    return Influence(np.arange(weights.shape[1], dtype=float), rows, ("follower",))


@pytest.mark.slow
@given(
    st.integers(2, 5),
    st.integers(1, 40),
    st.sampled_from(["worst", "rss"]),
    st.sampled_from([0.5, 1, 2, 3, 10]),
    st.integers(0, 2**32 - 1),
)
@example(2, 5, "worst", 0.5, 2)  # more angles than dimensions, which leaves multipliers undetermined
@example(4, 25, "worst", 0.5, 1875061228)  # nearly so
def test_no_angle_is_broken_and_the_dual_proves_the_cost_least(count, angles, kind, exponent, seed) -> None:
    rng = np.random.default_rng(seed)
    weights, costs = rng.uniform(0.01, 3.0, (count, angles)), rng.uniform(0.1, 5.0, count)
    split = widest(made(weights, [None] * count), 1.0, dict(zip("abcdef", costs, strict=False)), kind, exponent)
    t = np.array([split.tolerances[name] for name in "abcdef"[:count]])
    q = 1 if kind == "worst" else 2
    sums = (weights.T**q) @ t**q
    assert sums.max() <= 1.0 + 1e-10
    assert sums.max() >= 1.0 - 1e-8
    # stationary: k c/(q t^(q+k)) is a mixture of the rows that bind, with weights that are not below 0
    binding = np.array([int(at) for at in split.binding])
    from scipy.optimize import nnls

    price = exponent * costs / (q * t ** (q + exponent))
    _, residual = nnls(weights[:, binding] ** q, price)
    assert residual <= 1e-6 * np.linalg.norm(price)


def test_what_is_left_for_one() -> None:
    weights = np.array([[1.0, 2.0, 1.0], [3.0, 1.0, 0.5]])
    left = left_for(made(weights, [0.1, None]), 1.0, "worst")
    assert left == pytest.approx([0.9 / 3.0, 0.8, 0.9 / 0.5])
    left = left_for(made(weights, [0.1, None]), 1.0, "rss")
    assert left == pytest.approx(np.sqrt(1.0 - (0.1 * weights[0]) ** 2) / weights[1])


def test_a_dimension_that_moves_nothing_has_no_bound() -> None:
    split = widest(made(np.array([[1.0], [0.0]]), [None, None]), 1.0, {"a": 1.0, "b": 1.0}, "worst")
    assert split.tolerances["a"] == pytest.approx(1.0)
    assert split.tolerances["b"] == np.inf


def test_what_takes_all_is_named() -> None:
    rows = made(np.array([[1.0, 1.0], [1.0, 3.0], [1.0, 1.0]]), [0.2, 0.3, None])
    with pytest.raises(TakenError) as caught:
        left_for(rows, 1.0, "worst")
    assert (caught.value.name, caught.value.at) == ("b", 1.0)
    assert caught.value.taken == pytest.approx(0.9)
    assert caught.value.needed == pytest.approx(0.2 + 0.3 * 3.0)
