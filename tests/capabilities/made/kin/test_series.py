"""Series of measured support functions: their harmonics, their uncertainty, and what they leave."""

from __future__ import annotations

import numpy as np
import pytest

from kin.made.series import support_series

T = np.arange(1440) * 2.0 * np.pi / 1440
P = 25.0 + 1.5 * np.cos(3.0 * T) + 0.3 * np.sin(5.0 * T) - 0.4 * np.cos(8.0 * T + 1.0)


def smooth_noise(seed: int, sd: float, spans: int) -> np.ndarray:
    """Noise of a curve of so many spans: every harmonic below half of them has sd sqrt(2/spans)."""
    random = np.random.default_rng(seed)
    waves = random.normal(0.0, sd * np.sqrt(2.0 / spans), (2, spans // 2))
    k = np.arange(1, spans // 2 + 1)[:, None]
    noise: np.ndarray = waves[0] @ np.cos(k * T) + waves[1] @ np.sin(k * T)
    return noise


def test_harmonics_come_back_and_no_others() -> None:
    series = support_series(P, 1e-9, 60)
    assert series.mean == pytest.approx(25.0, abs=1e-12)
    assert sorted(series.cos) == sorted(series.sin) == [3, 5, 8]
    assert [series.cos[k] for k in (3, 5, 8)] == pytest.approx([1.5, 0.0, -0.4 * np.cos(1.0)], abs=1e-12)
    assert [series.sin[k] for k in (3, 5, 8)] == pytest.approx([0.0, 0.3, 0.4 * np.sin(1.0)], abs=1e-12)
    assert series.left(P) < 1e-11


def test_their_uncertainty_is_that_of_the_noise() -> None:
    """Within the expanded uncertainty in 95 of 100 parts, and noise alone taken for a harmonic in hardly any."""
    off, strange = [], 0
    for seed in range(100):
        series = support_series(P + smooth_noise(seed, 0.002, 60), 0.002, 60)
        off.append(abs(series.cos[3] - 1.5) / series.unsure)
        strange += len(series.cos) - 3
    assert 0.88 <= np.mean(np.array(off) <= 1.0) <= 1.0
    assert strange <= 5


def test_a_harmonic_in_the_noise_is_left_over() -> None:
    series = support_series(P + 0.0005 * np.cos(11.0 * T), 0.002, 60)
    assert 11 not in series.cos
    assert series.left(P + 0.0005 * np.cos(11.0 * T)) == pytest.approx(0.0005, rel=1e-6)
