"""Loads by formulas: corners and narrow features are found, and what is not proved is counted on the safe side."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.cases import few

from camgeo.capabilities.dynamics.force_figures import extremes_of, float_check, forces_section
from camgeo.capabilities.dynamics.load_formula import LoadError, followed
from camgeo.capabilities.dynamics.panel import forces
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from camgeo.capabilities.dynamics.running import Running

CAM = """\
cam:
  kind: disc
  base_radius: 35
  follower: {kind: roller, radius: 9}
  motion: [{rise: 14, over: 115, law: cycloidal}, {dwell: 35}, {return: 14, over: 125, law: modified-sine}, {dwell: 85}]
"""


def running(load: str, train: str = "mass: 1e-6, rpm: 60, preload: 0.05") -> Running:
    made = read(f'{CAM}dynamics: {{{train}, load: "{load}"}}\n'.encode(), Path("case.yaml"))
    found = running_of(made, designed(made))
    assert found is not None
    return found


def test_the_corners_of_a_load_are_found() -> None:
    """58 zeros of the sine: there the preload and hardly any inertia are left, m W^2 y'' by mpmath."""
    found = running("30*abs(sin(29*t))")
    extremes = extremes_of(found)
    assert extremes.along[0] == pytest.approx((0.0499991385180227, 21.0 * 120.0 / 29.0), abs=1e-11)
    check = float_check(found, extremes)
    assert check is not None
    assert check.ok
    assert "sampled" not in check.detail


@pytest.mark.parametrize("count", few([22, 25, 37, 80], 2))
def test_the_mean_force_on_a_roller_under_a_load_with_corners(count: int) -> None:
    """Against Gauss's rule between all corners and joints, with the lever and the roller's turns of the same state."""
    found = running(f"30*abs(sin({count / 2}*t))", "mass: 1, rpm: 60, preload: 40")
    joints = np.radians([0.0, 115.0, 150.0, 275.0, 360.0])
    edges = np.unique(np.concatenate([joints, np.arange(count + 1) * 2.0 * math.pi / count]))
    edges = np.unique(np.concatenate([np.linspace(a, b, 6) for a, b in pairwise(edges)]))
    x, weight = np.polynomial.legendre.leggauss(16)
    half = 0.5 * np.diff(edges)
    state = found.state((edges[:-1, None] + half[:, None] * (x + 1.0)).ravel())
    assert state.roller_rpm is not None
    turned = np.abs(state.roller_rpm[0]) * (half[:, None] * weight).ravel()
    mean = (np.sum(state.normal[0] ** (10.0 / 3.0) * turned) / turned.sum()) ** 0.3
    own = found.mean_force(0)
    assert own is not None
    assert own[0] == pytest.approx(mean, rel=1e-10)


@pytest.mark.parametrize("width", [1e-3, 1e-6])
def test_no_narrow_feature_is_passed_over(width: float) -> None:
    found = extremes_of(running(f"30*exp(-((t - 1.2345)/{width})**2)"))
    assert found.along[1] == pytest.approx((30.05, math.degrees(1.2345)), abs=1e-6)


def test_a_load_that_touches_the_greatest_is_followed_all_round() -> None:
    """80 crests of the greatest load that is taken stay open to the end; behind them one is above it."""
    assert followed("4e12*cos(80*t)").sampled is None
    with pytest.raises(LoadError) as caught:
        followed("4e12*cos(80*t)*(1 - 0.1*exp(-1e4*(t - 6.2)**2)) + 1e12*exp(-1e4*(t - 6.2)**2)")
    assert caught.value.at == pytest.approx(6.2, abs=0.05)


SAMPLED = [
    ("30*sqrt(1 - cos(t))", 0.0, 30.0 * math.sqrt(2.0)),
    ("30*sqrt(abs(sin(5*t)))", 0.0, 30.0),
    ("30*cbrt(sin(t - 1))", -30.0, 30.0),
    ("30*cbrt(sin(t - 1)**2)", 0.0, 30.0),
    ("30*hypot(sin(t), 0)", 0.0, 30.0),
    ("5*abs(sin(400*t))", 0.0, 5.0),
    ("20*(1 - cos(t - 1))/(t - 1)", None, None),
]


@pytest.mark.thin(2)
@pytest.mark.parametrize(("load", "least", "most"), few(SAMPLED, 3))
def test_what_is_sampled_says_so_and_is_counted_on_the_safe_side(load: str, least: float | None, most: float) -> None:
    found = running(load, "mass: 1e-9, rpm: 60, preload: 50")
    assert found.sampled is not None
    assert 0.0 < found.sampled.within < 1e-2
    extremes = extremes_of(found)
    if least is not None:
        low, high = (side.value - 50.0 for side in extremes.along)
        assert low <= least + 1e-8
        assert high >= most - 1e-8
        assert low == pytest.approx(least, abs=2.0 * found.sampled.within + 1e-7)
        assert high == pytest.approx(most, abs=2.0 * found.sampled.within + 1e-7)
    check = float_check(found, extremes)
    assert check is not None
    assert "sampled near" in check.detail
    section = forces_section(found, extremes)
    assert section["load_sampled"] == {
        "at_deg": pytest.approx(math.degrees(found.sampled.at)),
        "within": found.sampled.within,
        "unit": "N",
    }
    assert "load is sampled" in forces({"forces": section, "units": "mm"})


def test_the_preload_for_a_least_force_counts_what_is_sampled() -> None:
    found = running("30*cbrt(sin(t - 1))", "mass: 1e-9, rpm: 60, least_force: 5")
    assert found.sampled is not None
    assert found.preload == pytest.approx(35.0 + found.sampled.within, abs=1e-7)


@pytest.mark.parametrize("load", ["30*sin(t)**2", "5 + 1/(2 + sin(t))", "40", "0"])
def test_a_smooth_load_is_not_cut(load: str) -> None:
    made = followed(load)
    assert len(made.corners) == 0
    assert made.sampled is None


@pytest.mark.parametrize("load", ["1/(t - 1)", "abs(t - 1)**-0.5", "log(abs(t - 1))", "min(1/(t - 1), 3)"])
def test_a_load_without_a_bound_is_refused(load: str) -> None:
    with pytest.raises(LoadError) as caught:
        followed(load)
    assert caught.value.at == pytest.approx(1.0, abs=1e-6)
    assert caught.value.size is None
