"""Taylor coefficients of the elementary functions against Cauchy's integrals of the complex functions of numpy."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mpmath as mp
import numpy as np
import pytest

from kin.numeric import elementary as own
from kin.numeric import jet
from kin.numeric.elementary import Jet
from kin.numeric.jet import BallJet, horner
from kin.numeric.taylor import ball_product

if TYPE_CHECKING:
    from collections.abc import Callable

ORDER, ROUND = 7, 64  # places on the circle of each integral


def cbrt(z: np.ndarray) -> np.ndarray:
    side = np.sign(z.real)
    root: np.ndarray = side * np.exp(np.log(side * z) / 3.0)
    return root


# in jets, in numpy, places, radius of a circle on which the function has no singularity near
FUNCTIONS: dict[str, tuple[Callable[[Any], Any], Callable[[Any], Any], tuple[float, ...], float]] = {
    "sin": (own.sin, np.sin, (-4.0, 0.3, 2.0), 1.0),
    "cos": (own.cos, np.cos, (-4.0, 0.3, 2.0), 1.0),
    "tan": (own.tan, np.tan, (-0.9, 0.0, 0.7, 2.8), 0.3),
    "asin": (own.asin, np.arcsin, (-0.7, 0.0, 0.4, 0.6), 0.15),
    "acos": (own.acos, np.arccos, (-0.7, 0.0, 0.4, 0.6), 0.15),
    "atan": (own.atan, np.arctan, (-3.0, 0.0, 0.4, 1.7), 0.4),
    "sinh": (own.sinh, np.sinh, (-2.0, 0.3, 1.5), 1.0),
    "cosh": (own.cosh, np.cosh, (-2.0, 0.3, 1.5), 1.0),
    "tanh": (own.tanh, np.tanh, (-1.0, 0.0, 0.7), 0.5),
    "exp": (own.exp, np.exp, (-2.0, 0.3, 1.5), 1.0),
    "log": (own.log, np.log, (0.7, 1.0, 3.0), 0.3),
    "sqrt": (own.sqrt, np.sqrt, (0.7, 1.0, 3.0), 0.3),
    "cbrt": (own.cbrt, cbrt, (-2.0, 0.7, 1.0, 3.0), 0.3),
    "cube": (lambda t: t**3, lambda z: z**3, (-2.0, 0.0, 0.7), 0.5),
    "reciprocal": (lambda t: 2.0 / (t - 5.0), lambda z: 2.0 / (z - 5.0), (-2.0, 0.0, 0.7), 0.5),
    "broken power": (lambda t: t**-2.5, lambda z: z**-2.5, (0.7, 1.0, 3.0), 0.3),
    "product": (lambda t: own.sin(t) * own.exp(-t), lambda z: np.sin(z) * np.exp(-z), (-1.0, 0.4, 2.0), 0.5),
    "in one another": (
        lambda t: own.atan(own.exp(t) - own.cos(t * t)),
        lambda z: np.arctan(np.exp(z) - np.cos(z * z)),
        (-0.8, 0.2, 1.1),
        0.2,
    ),
}


def coefficients(function: Callable[[Any], Any], places: np.ndarray, radius: float) -> np.ndarray:
    """Taylor coefficients (ORDER + 1, n) at places (n,), by the mean of f(x + r e^(i t)) e^(-i k t) / r^k."""
    away = radius * np.exp(2j * math.pi * np.arange(ROUND) / ROUND)
    found = np.fft.fft(function(places[:, None] + away), axis=1).real / ROUND
    rows: np.ndarray = found[:, : ORDER + 1].T / radius ** np.arange(ORDER + 1)[:, None]
    return rows


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", list(FUNCTIONS))
def test_coefficients(name: str) -> None:
    function, known, at, radius = FUNCTIONS[name]
    places = np.array(at)
    expected = coefficients(known, places, radius)
    jet = function(Jet.variable(places, ORDER))
    size = np.abs(expected).max(axis=0)
    assert jet.c.shape == expected.shape
    assert (np.abs(jet.c - expected) <= 1e-8 * size).all()
    for order in (0, 1, 2):  # what is left out changes nothing
        assert (np.abs(function(Jet.variable(places, order)).c - expected[: order + 1]) <= 1e-8 * size).all()
    assert jet.derivatives()[3] == pytest.approx(6.0 * expected[3], abs=1e-6 * float(size.max()))

    # over an interval of 2e-8 the bounds hold what is inside, and little more
    below, above = function(BallJet.variable(places - 1e-8, places + 1e-8, ORDER)).bounds()
    derivatives = expected * np.array([math.factorial(k) for k in range(ORDER + 1)])[:, None]
    slack = 1e-7 * np.abs(derivatives).max(axis=0)
    assert (below <= derivatives + slack).all()
    assert (derivatives - slack <= above).all()
    assert (above - below <= 1e-2 * np.abs(derivatives).max(axis=0)).all()


def intervals(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Points, hair's breadths and wide intervals of either sign, and such as begin or end at 0."""
    rng = np.random.default_rng(count)
    low = rng.uniform(-1.2, 1.2, 24)
    wide = 10.0 ** rng.uniform(-17.0, 0.3, 24)
    wide[:4] = 0.0
    low[4:8] = 0.0
    low[3], low[8], wide[8] = 0.0, -wide[8], wide[8]
    low[9], wide[9] = 1e-200, 1e-210
    return low, low + wide


@pytest.mark.thin(5)
@pytest.mark.parametrize("count", [1, 2, 6, 22, 96])
def test_polynomials_over_intervals(count: int) -> None:
    """Bounds hold what mpmath gives at random places, and are as tight as Horner's scheme on series."""
    low, high = intervals(count)
    rng = np.random.default_rng(1)
    numbers = rng.normal(size=(count, low.size)) * 10.0 ** rng.uniform(-3.0, 3.0, size=(count, 1))
    x = BallJet.variable(low, high, 4)
    (least, most), scheme = horner(numbers, x).rows.bounds(), x.constant(numbers[-1])
    for row in numbers[-2::-1]:
        scheme = scheme * x + row
    before = scheme.rows.bounds()
    sizes = np.abs(before).max(axis=0)
    assert (most - least <= (before[1] - before[0]) * (1.0 + 1e-9) + 4e-14 * sizes).all()
    assert not np.stack([least, most])[:, count:].any()
    with mp.workdps(60):
        for column in range(low.size):
            begin, end = mp.mpf(low[column]), mp.mpf(high[column])
            exact = [mp.mpf(float(a)) for a in numbers[:, column]]
            for share in (mp.mpf(0), mp.mpf(float(rng.uniform())), mp.mpf(1)):
                at = begin + share * (end - begin)
                powers = [at**j for j in range(count)]
                for k in range(min(5, count)):
                    choices = [math.comb(j, k) for j in range(k, count)]
                    value = mp.fdot(zip(map(mp.fmul, exact[k:], choices), powers, strict=False))
                    assert least[k, column] <= value <= most[k, column]


def test_many_powers_over_intervals_multiply_no_series(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each step of the scheme would be a product of series: all rows go through it together."""
    products = []
    monkeypatch.setattr(jet, "ball_product", lambda *pair: products.append(1) or ball_product(*pair))
    x = 1.0 - BallJet.variable(np.linspace(0.0, 0.9, 10), np.linspace(0.1, 1.0, 10), 4)
    horner(np.ones(96), x)
    assert not products
