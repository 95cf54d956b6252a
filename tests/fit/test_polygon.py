"""Polygons at tolerances near rounding: as few edges as theory has, in as few rounds as coarse ones."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from camgeo.fit.edges import sagittas
from camgeo.fit.inflection import crossings, inflections
from camgeo.fit.nodes import Density
from camgeo.fit.polygon import fit_polygon, least_vertices, polygon_density
from camgeo.recipe.loading import load, load_text

if TYPE_CHECKING:
    from camgeo.curve.curve import Curve
    from camgeo.fit.edges import PlacedEdges, Sagittas
    from kin.numeric.arrays import Array

RECIPES = Path(__file__).parents[2] / "recipes"


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize(("recipe", "tolerance", "most"), [("w-figure-9", 1e-8, 8), ("as-figure-2a", 1e-9, 4)])
def test_edges_and_rounds_are_few_where_rounding_shows(
    recipe: str, tolerance: float, most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    curve: Curve = load(RECIPES / f"{recipe}.yaml").cam.exact().surfaces[0].curve
    rounds = 0

    def counted(curve: Curve, edges: PlacedEdges, sides: Array, tolerance: float) -> Sagittas:
        nonlocal rounds
        rounds += 1
        return sagittas(curve, edges, sides, tolerance)

    monkeypatch.setattr("camgeo.fit.polygon.sagittas", counted)
    polygon = fit_polygon(curve, tolerance)
    assert 0.9 * tolerance < polygon.bound.worst <= tolerance
    # a part of the tolerance, at most, is kept for the proof
    assert polygon.count <= 1.0015 * least_vertices(curve, tolerance)
    assert rounds <= most


def test_a_root_that_is_far_off_for_a_fine_edge_is_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    curve: Curve = load(RECIPES / "w-figure-9.yaml").cam.exact().surfaces[0].curve
    reached = []

    def seen(curve: Curve, at: Array, low: Array, high: Array, tolerance: float) -> object:
        edges = crossings(curve, at, low, high, tolerance)
        reached.append(((edges.high != high) & (edges.low != low)).all())
        return edges

    monkeypatch.setattr("camgeo.fit.polygon.crossings", seen)

    def stopped(*_: object) -> None:
        raise InterruptedError

    monkeypatch.setattr("camgeo.fit.polygon._settle", stopped)
    for tolerance in (1e-3, 1e-5, 1e-7, 1e-8, 1e-9):
        with pytest.raises(InterruptedError):
            fit_polygon(curve, tolerance)
    assert len(reached) == 5
    assert all(reached)


# a curve bends the other way close to where one motion ends and the next begins, and its curvature jumps there
NEAR_A_BREAK = {
    "rise, rise, return": (
        "base_radius: 150, follower: {kind: roller, radius: 8.435, arm: {length: 316.6, pivot: 365, side: leading}}",
        (
            "{dwell: 92.59}, {to: 22.4, over: 22.84, law: cycloidal}, {to: 14.39, over: 17.7, law: freudenstein-13}, "
            "{dwell: 164.69}, {to: 0, over: 36.9, law: cycloidal}, {dwell: 25.28}"
        ),
    ),
    "trailing": (
        "base_radius: 143.2, follower: {kind: roller, radius: 8.56, arm: {length: 302.7, pivot: 353.2}}",
        (
            "{dwell: 89.85}, {to: 22.27, over: 22.02, law: modified-sine}, "
            "{to: 14.132, over: 17.26, law: freudenstein-13}, {dwell: 159.544}, "
            "{to: 0, over: 35.941, law: harmonic}, {dwell: 35.385}"
        ),
    ),
}


def near_a_break(name: str) -> Curve:
    follower, motion = NEAR_A_BREAK[name]
    text = f"cam: {{kind: disc, {follower}, motion: [{motion}]}}"
    return load_text(text, "r").cam.exact().surfaces[0].curve


@pytest.mark.slow
@pytest.mark.parametrize("name", NEAR_A_BREAK)
@pytest.mark.parametrize("tolerance", [0.05, 0.001, 1e-5])
def test_inflections_close_to_breaks(name: str, tolerance: float) -> None:
    curve = near_a_break(name)
    polygon = fit_polygon(curve, tolerance)
    assert 0.9 * tolerance < polygon.bound.worst <= tolerance
    assert polygon.count <= 1.01 * least_vertices(curve, tolerance) + len(curve.runs[0].breaks) + 1


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    "name",
    [
        "disc-sized",  # needs: dynamics
        "lobe-roller",
        "w-rosette",
        "w-wanted-law",
    ],
)
def test_a_root_that_has_settled_stays(name: str) -> None:
    """Each step of Newton's method after the last one that changes anything leaves the root where it is."""
    curve: Curve = load(RECIPES / f"{name}.yaml").cam.exact().surfaces[0].curve
    densities = Density.of(curve, curve.runs[0].stretches, polygon_density)
    bends, _ = inflections(curve, densities, 0.001)
    breaks = np.concatenate([density.t[[0, -1]] for density in densities])
    smooth = bends[np.abs(bends[:, None] - breaks).min(axis=1) > 1e-6]
    assert smooth.size >= 4
    frame = curve.sample(smooth)
    np.testing.assert_allclose(frame.turn / frame.turn_slope, 0.0, atol=1e-9)


@pytest.mark.parametrize("name", NEAR_A_BREAK)
def test_inflections_are_where_the_turn_is_zero_or_jumps(name: str) -> None:
    """Round a closed curve they are even in number, and on either side the curve bends as the sides say."""
    curve = near_a_break(name)
    run = curve.runs[0]
    bends, sense = inflections(curve, Density.of(curve, run.stretches, polygon_density), 1e-14)
    assert bends.size % 2 == 0
    assert bends.size > 2
    ends = np.concatenate([[run.low], bends, [run.high]])
    for low, high in pairwise(ends):
        looks = curve.sample(low + (high - low) * np.linspace(1e-3, 1.0 - 1e-3, 501)).turn
        assert (looks * sense > 0.0).all()
        sense = -sense
