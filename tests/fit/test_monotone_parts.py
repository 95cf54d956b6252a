"""Where thousands of arcs begin: near their places, so that few are tried and none twice. Counted, not timed."""

import numpy as np
import pytest
from support.places import RECIPES

from camgeo.fit import arcs as fitting
from camgeo.fit import free_arcs
from camgeo.fit.arcs import FLOOR, fit_arcs
from camgeo.fit.monotone_parts import CONSTANT, MonotonePart, refine
from camgeo.fit.nodes import rounding
from camgeo.recipe.loading import load


def curve_of(name):
    cam = load(RECIPES / f"{name}.yaml").cam
    return cam.exact().surfaces[0].curve


class Counted:
    """How many arcs with free joints were begun, how many biarcs, and how many steps Newton's method took."""

    def __init__(self, monkeypatch):
        self.free, self.biarcs, self.steps = [], [], 0
        levelled, biarcs, newton = free_arcs._level_out, fitting._biarcs, free_arcs._newton

        def of_free(curve, layout, t, aim):
            self.free.append(layout.part.size)
            return levelled(curve, layout, t, aim)

        def of_biarcs(curve, low, high, slip):
            self.biarcs.append(low.size)
            return biarcs(curve, low, high, slip)

        def of_newton(*given):
            self.steps += 1
            return newton(*given)

        monkeypatch.setattr(free_arcs, "_level_out", of_free)
        monkeypatch.setattr(fitting, "_biarcs", of_biarcs)
        monkeypatch.setattr(free_arcs, "_newton", of_newton)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["as-figure-2a", "as-figure-2c", "fourier", "w-ellipse"])
@pytest.mark.parametrize("roundings", [2.0 * FLOOR, 20.0, 1000.0])
def test_near_rounding_arcs_are_found_at_once(name, roundings, monkeypatch):
    curve = curve_of(name)
    seen = Counted(monkeypatch)
    found = fit_arcs(curve, roundings * rounding(curve.size))
    assert len(seen.free) <= (1 if roundings <= 20.0 else 2)
    assert not seen.biarcs
    assert seen.steps <= 8 * len(seen.free)
    assert found.count <= 1.01 * seen.free[0]


@pytest.mark.slow
def test_arcs_grow_as_the_third_root_of_the_tolerance_down_to_the_floor():
    curve = curve_of("w-ellipse")
    unit = rounding(curve.size)
    counts = {m: fit_arcs(curve, m * unit).count for m in (2.0 * FLOOR, 100.0, 1e4)}
    for m, count in counts.items():
        # near the floor rounding takes its share of the tolerance
        usable = 0.995 * m if m > 1000.0 else m - 2.2
        assert count <= 1.03 * counts[1e4] * (0.995e4 / usable) ** (1.0 / 3.0)


@pytest.mark.slow
def test_a_finer_grid_has_the_share_of_a_density_that_is_known():
    """Between extrema of curvature of an ellipse, against quadrature on a grid of a million."""
    curve = curve_of("w-ellipse")
    run = curve.runs[0].stretches[0]
    at = curve.sample(np.linspace(*run, 2001)[1:-1])
    slope = at.turn_slope * at.speed - at.turn * at.speed_slope
    turning = np.flatnonzero(slope[1:] * slope[:-1] < 0.0)[:2]
    low, high = np.linspace(*run, 2001)[turning + 1] + 1e-9
    coarse = np.linspace(low, high, 12)

    def share(grid):
        frame = curve.sample(grid)
        value = np.cbrt(np.abs(frame.turn_slope * frame.speed - frame.turn * frame.speed_slope) / CONSTANT)
        return np.append(0.0, np.cumsum(0.5 * (value[1:] + value[:-1]) * np.diff(grid)))

    part = MonotonePart(coarse, share(coarse), 1.0)
    (finer,) = refine(curve, [part], 1e-9)
    grid = np.linspace(low, high, 1_000_001)
    truth = np.interp(finer.grid, grid, share(grid))
    arcs = 1e-9 ** (-1.0 / 3.0)
    assert finer.grid[0] == low
    assert finer.grid[-1] == high
    assert (np.diff(finer.grid) > 0.0).all()
    assert np.abs(finer.share - truth).max() * arcs < 0.5
    assert np.abs(part.share - np.interp(coarse, grid, share(grid))).max() * arcs > 3.0
    assert refine(curve, [part], 1.0) == [part]
