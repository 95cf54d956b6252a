"""Hertz's pressure of line contacts, by hand and against the equation of elastic bodies of which it is the solution."""

from __future__ import annotations

import math

import numpy as np
import pytest

from camgeo.measures.hertz import bearable, line_pressure
from camgeo.recipe.materials import Material

STEEL, POLYMER = Material(206_000.0, 0.3), Material(3_000.0, 0.35)


def test_pressure_by_hand() -> None:
    """Two steel rollers of radius 20 under 1000 N over 10 mm, and one of steel in a hollow of a polymer, by decimals.

    The first is sqrt(1000 x 0.1/(10 pi 2 x 0.91/206000)); of handbooks (Roark) 0.591 sqrt(100 x 206000/20).
    """
    pressure = line_pressure(np.array([[1000.0]]), np.array([[0.1]]), 10.0, STEEL, STEEL)
    assert pressure == pytest.approx(np.array([[600.2372999322891]]), rel=1e-14)
    assert pressure[0, 0] == pytest.approx(0.591 * math.sqrt(100.0 * 206_000.0 / 20.0), rel=1e-3)
    in_hollow = line_pressure(np.array([250.0]), np.array([1.0 / 12.0 - 1.0 / 40.0]), 8.0, STEEL, POLYMER)
    assert in_hollow == pytest.approx(np.array([44.20695399621057]), rel=1e-14)


def test_under_that_pressure_the_bodies_fit_together() -> None:
    """Flamant: a line load p ds dents a half-plane by the slope 2 (1 - nu^2) p ds/(pi E (x - s)), summed over both.

    The pressure, half an ellipse, carries the force; its slopes are those of the gap, kappa x. The integral is a
    principal value: with s = a cos(v), and x midway between the v of a trapezium rule, the rule is exact.
    """
    force, curvature, width = 700.0, 0.07, 9.0
    (greatest,) = line_pressure(np.array([force]), np.array([curvature]), width, STEEL, POLYMER)
    half = 2.0 * force / (width * math.pi * greatest)
    n = 64
    v, at = math.pi * np.arange(n) / n, math.pi * (np.arange(n) + 0.5) / n
    s, x = half * np.cos(v), half * np.cos(at)
    share = greatest * np.sin(v) * half * np.sin(v) * math.pi / n
    assert float(share.sum()) * width == pytest.approx(force, rel=1e-12)
    compliance = (1.0 - 0.3**2) / 206_000.0 + (1.0 - 0.35**2) / 3_000.0
    slope = 2.0 * compliance / math.pi * (share / (x[:, None] - s)).sum(axis=1)
    assert slope == pytest.approx(curvature * x, rel=1e-9)


def test_without_a_force_or_with_a_hollow_that_is_sharper_there_is_none() -> None:
    none = line_pressure(np.array([0.0, -5.0, 5.0]), np.array([0.1, 0.1, -0.1]), 10.0, STEEL, STEEL)
    assert none.tolist() == [0.0, 0.0, 0.0]


def test_the_lower_of_two_limits() -> None:
    strong, weak = Material(206_000.0, 0.3, 900.0), Material(3_000.0, 0.35, 20.0)
    assert bearable(strong, weak) == bearable(weak, strong) == bearable(None, weak) == 20.0
    assert bearable(strong, STEEL) == bearable(strong, None) == 900.0
    assert bearable(STEEL, None) is None
