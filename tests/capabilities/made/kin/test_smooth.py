"""Smoothing splines: their uncertainty, bias and outliers, against closed forms and worked cases."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np
import pytest

from kin.made import smooth
from kin.made.smooth import GapError, fit, strays

TURN = 2.0 * np.pi
COUNT = 720
T = np.arange(COUNT) * TURN / COUNT
SHIFTED = T + 0.3 * TURN / COUNT  # knots lie between points

UNCERTAIN = {  # spans: sd of value (um), slope (mm/rad) and bend (mm/rad^2), rms over the turn, then greatest
    36: (0.4472135955, 0.004686629353, 0.06662009111, 0.4753439327, 0.005479986152, 0.08504215051),
    24: (0.3651483717, 0.002551103511, 0.02417635476, 0.3881211545, 0.002983032136, 0.03086258243),
    72: (0.6324555287, 0.013255788483, 0.37686005502, 0.6722377772, 0.015499737377, 0.48107083692),
}


@pytest.mark.parametrize("spans", list(UNCERTAIN))
def test_uncertainty_of_a_curve_and_its_derivatives(spans):
    e = 0.002 * np.random.default_rng(3).normal(size=COUNT)
    found = fit(T, e, spans)
    at = np.arange(36_000) * TURN / 36_000
    told = []
    for order, unit in enumerate((1e3, 1.0, 1.0)):
        sd = found.curve.standard_deviations(at, order) * 0.002 / (found.curve.sigma * found.curve.widened) * unit
        told.append((float(np.sqrt(np.mean(sd**2))), float(sd.max())))
    rms, most = zip(*told, strict=True)
    assert rms == pytest.approx(UNCERTAIN[spans][:3], rel=1e-9)
    assert most == pytest.approx(UNCERTAIN[spans][3:], rel=1e-9)


@pytest.mark.parametrize(
    ("spans", "harmonic", "rms"), [(36, 4, 3.943868492e-6), (36, 9, 1.373260728e-3), (36, 12, 1.562513336e-2)]
)
def test_bias_of_harmonics(spans, harmonic, rms):
    t = np.arange(7200) * TURN / 7200
    e = np.cos(harmonic * t)
    off = fit(t, e, spans).curve.rows(t)[0] - e
    assert np.sqrt(2.0 * np.mean(off**2)) == pytest.approx(rms, rel=1e-6)


def test_derivatives_are_those_of_the_curve():
    found = fit(SHIFTED, np.cos(5 * SHIFTED) + 0.1 * np.sin(SHIFTED), 48).curve
    t, h = np.linspace(0.0, TURN, 200), 1e-5
    low, here, high = (found.rows(x, 2) for x in (t - h, t, t + h))
    assert (high[0] - low[0]) / (2 * h) == pytest.approx(here[1], abs=1e-7)
    assert (high[1] - low[1]) / (2 * h) == pytest.approx(here[2], abs=1e-6)
    assert found.rows(t + TURN, 2) == pytest.approx(here, abs=1e-9)


def test_many_spans_are_solved_as_few_are():
    """Blocks of the band give what the dense solution of the same equations does."""
    t = np.sort(np.random.default_rng(1).uniform(0.0, TURN, 6000))
    e = np.random.default_rng(2).normal(size=6000)
    curve = fit(t, e, 700).curve
    dense = np.array([fit(t, e, 700).curve.factor @ _right(t, e, 700)])
    assert curve.coefficients == pytest.approx(dense[0], abs=1e-9)


def _right(t, e, spans):
    from kin.made.smooth import _Points

    return _Points(t, e, len(t))._normal(spans)[1]


def test_spans_follow_the_form_and_not_the_noise():
    noise = 0.002 * np.random.default_rng(5).normal(size=COUNT)
    assert fit(T, noise).curve.spans <= 24
    waves = fit(T, 0.01 * np.cos(30 * T) + noise)
    assert waves.curve.spans >= 72
    assert waves.curve.sigma == pytest.approx(0.002, rel=0.1)
    assert waves.curve.rows(T)[0] == pytest.approx(0.01 * np.cos(30 * T), abs=0.005)


def test_outliers_are_named_and_faults_of_the_part_are_not():
    noise = 0.002 * np.random.default_rng(7).normal(size=COUNT)
    clean = fit(T, 0.01 * np.cos(3 * T) + noise)
    assert clean.outliers.sum() == 0
    wrong = noise + 0.01 * np.cos(3 * T)
    wrong[[100, 101, 400]] += [0.05, 0.05, -0.5]
    found = fit(T, wrong)
    assert np.flatnonzero(found.outliers).tolist() == [100, 101, 400]
    assert found.curve.rows(T)[0] == pytest.approx(clean.curve.rows(T)[0], abs=0.002)
    burr = noise + 0.05 * np.exp(-0.5 * ((T - 2.0) / np.radians(2.0)) ** 2)
    assert not fit(T, burr).outliers.any()


def test_correlated_residuals_widen_the_uncertainty():
    draw = np.random.default_rng(11)
    noise = draw.normal(size=7200)
    running = np.convolve(np.append(noise, noise[:4]), np.ones(5) / 5, "valid")
    found = fit(np.arange(7200) * TURN / 7200, 0.002 * running, 36)
    assert found.correlation == pytest.approx(0.8, abs=0.05)
    assert found.curve.widened == pytest.approx(3.0, rel=0.2)
    assert fit(T, 0.002 * draw.normal(size=COUNT), 36).curve.widened < 1.15


def test_a_gap_is_refused():
    t = np.linspace(0.0, np.radians(285.0), 600)
    with pytest.raises(GapError, match=r"within 75 degrees of the contour from 285 degrees"):
        fit(t, np.zeros(600))
    t = np.linspace(0.0, np.radians(320.0), 600)
    assert fit(t, np.cos(t)).curve.spans <= 18
    with pytest.raises(GapError, match="more than two of 36 spans"):
        fit(t, np.cos(t), 36)


def test_points_on_slopes_are_no_outliers_however_little_they_scatter():
    """Where most points are their neighbours' median, these still scatter as all do."""
    t = np.arange(720) * np.pi / 360.0
    e = 0.05 * np.abs(np.sin(t)) ** 3 + np.random.default_rng(1).normal(0.0, 2e-5, 720)
    assert not fit(t, e).outliers.any()
    e[100] += 0.004
    assert np.flatnonzero(fit(t, e).outliers).tolist() == [100]


@pytest.mark.slow
def test_the_bound_of_outliers_follows_the_number_of_points():
    """Normal noise of 200,000 points reaches 4.56 standard deviations, and is no outlier."""
    count = 200_000
    t = np.arange(count) * TURN / count
    normal = NormalDist()
    quantiles = np.tile([normal.inv_cdf((k + 0.5) / 2000) for k in range(2000)], count // 2000)
    quantiles[0] = normal.inv_cdf(0.5 / count)
    e = 0.002 * np.random.default_rng(1).permutation(quantiles)
    assert np.abs(e).max() > 0.002 * 4.56
    assert not fit(t, e, 12).outliers.any()
    low, bound = 4.0, 7.0  # n erfc(z / sqrt 2) = 0.005, by bisection
    for _ in range(60):
        middle = 0.5 * (low + bound)
        low, bound = (middle, bound) if count * math.erfc(middle / math.sqrt(2.0)) > 0.005 else (low, middle)
    e[[1000, 90_000]] = 0.002 * (bound - 0.1), 0.002 * (bound + 0.1)
    assert np.flatnonzero(fit(t, e, 12).outliers).tolist() == [90_000]


def test_the_number_of_spans_is_chosen_once_and_again_without_the_outliers(monkeypatch):
    calls = []
    chosen = smooth._Points.chosen
    monkeypatch.setattr(smooth._Points, "chosen", lambda self, spans: calls.append(self.count) or chosen(self, spans))
    e = 0.01 * np.cos(3 * T) + 0.002 * np.random.default_rng(7).normal(size=COUNT)
    fit(T, e)
    assert len(calls) == 1
    e[[100, 103, 106, 109]] += [0.016, 0.018, 0.020, 0.022]  # beside one another: the worst of them goes first
    calls.clear()
    assert {100, 103, 106, 109} <= set(np.flatnonzero(fit(T, e).outliers).tolist())
    assert len(calls) == 2


def test_the_worst_outlier_comes_first():
    e = 0.002 * np.random.default_rng(7).normal(size=COUNT)
    e[[50, 300, 650]] += [0.05, -0.3, 0.1]
    assert fit(T, e).worst.tolist() == [300, 650, 50]


def test_strays_are_the_few_that_lie_far_off():
    e = 0.01 * np.cos(3 * T)
    e[[7, 8, *range(100, 120), 500]] = 2.0
    assert np.flatnonzero(strays(T, e, 0.5)).tolist() == [7, 8, *range(100, 120), 500]
    turned = e + np.sin(T)  # most lie far off: those count that stand off the ones beside them, alone or in pairs
    assert np.flatnonzero(strays(T, turned, 0.5)).tolist() == [7, 8, 500]
    assert not strays(T, np.where(np.arange(COUNT) % 2, 2.0, 0.0), 0.5).any()
