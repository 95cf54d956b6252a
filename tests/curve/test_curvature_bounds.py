"""Bounds of a cubic's curvature and of its derivatives over steps, on which the proof of a spline rests."""

from __future__ import annotations

import numpy as np
import pytest

from camgeo.fit.spans import Cubics, _curvature_bounds

STEPS = 4
DENSE = 101


def rates_of(cubic: Cubics, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Absolute values of k, dk/ds and d2k/ds2 by truncated series of u, an arithmetic of its own."""
    p, a, j = cubic.velocity(u), cubic.acceleration(u), 6.0 * cubic.c
    n = np.array([(p.conj() * a).imag, (p.conj() * j).imag, (a.conj() * j).imag / 2.0])  # N(u + h) = n0 + n1 h + n2 h^2
    v = np.array([abs(p) ** 2, 2.0 * (p.conj() * a).real, (abs(a) ** 2 + (p.conj() * j).real)])
    # k = N v^(-3/2)
    r, q = v[1] / v[0], v[2] / v[0]
    power = np.array([np.ones_like(r), -1.5 * r, -1.5 * q + 1.875 * r**2]) * v[0] ** -1.5
    k0 = n[0] * power[0]
    k1 = n[1] * power[0] + n[0] * power[1]
    k2 = 2.0 * (n[2] * power[0] + n[1] * power[1] + n[0] * power[2])
    pace = np.sqrt(v[0])
    return abs(k0), abs(k1) / pace, abs(k2 / v[0] - k1 * v[1] / (2.0 * v[0] ** 2))


@pytest.mark.thin(2)
@pytest.mark.parametrize("seed", range(40))
def test_no_place_of_a_step_exceeds_its_bound(seed: int) -> None:
    rng = np.random.default_rng(seed)
    control = np.cumsum(rng.normal(size=(200, 4, 2)) * 0.5 + np.array([rng.choice([0.3, 1.0, 3.0]), 0.0]), axis=1)
    cubic = Cubics.of(control).column()
    u = np.broadcast_to(np.linspace(0.0, 1.0, STEPS + 1), (200, STEPS + 1))
    velocity, acceleration = cubic.velocity(u), cubic.acceleration(u)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found = _curvature_bounds(cubic, u, np.abs(velocity), (velocity.conj() * acceleration).imag)
    within = np.linspace(0.0, 1.0, DENSE)
    for step in range(STEPS):
        places = u[:, step, None] + (u[:, step + 1] - u[:, step])[:, None] * within
        proved = [bound[:, step] for bound in (found.curvature, found.slope, found.bend)]
        for seen, bound in zip(rates_of(cubic, places), proved, strict=True):
            sane = np.isfinite(bound)
            assert sane.any()
            assert (seen.max(axis=1)[sane] <= bound[sane] * (1.0 + 1e-9)).all()
