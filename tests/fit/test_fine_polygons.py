"""Polygons at tolerances near rounding: as few edges as theory has, in as few rounds as coarse ones."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from camgeo.fit.edges import look
from camgeo.fit.inflection import crossings
from camgeo.fit.polygon import fit_polygon, least_vertices
from camgeo.recipe.loading import load

if TYPE_CHECKING:
    from camgeo.curve.curve import Curve
    from camgeo.fit.edges import Placed, Sagittas
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

    def counted(curve: Curve, edges: Placed, sides: Array, tolerance: float) -> Sagittas:
        nonlocal rounds
        rounds += 1
        return look(curve, edges, sides, tolerance)

    monkeypatch.setattr("camgeo.fit.polygon.look", counted)
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

    monkeypatch.setattr("camgeo.fit.polygon._settled", stopped)
    for tolerance in (1e-3, 1e-5, 1e-7, 1e-8, 1e-9):
        with pytest.raises(InterruptedError):
            fit_polygon(curve, tolerance)
    assert len(reached) == 5
    assert all(reached)
