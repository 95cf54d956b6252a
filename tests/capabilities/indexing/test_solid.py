"""Indexing cams as solids, held against rollers at all angles by positions alone: every triangle lies where it should.

Holds: camgeo.capabilities.indexing.solid, camgeo.capabilities.indexing.sheet, camgeo.capabilities.indexing.band,
camgeo.capabilities.indexing.bends, camgeo.capabilities.indexing.forms, camgeo.fit.cells.
"""

from __future__ import annotations

import math
import random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from capabilities.indexing.made_indexers import changed, design_of, random_indexer, shared_design
from capabilities.indexing.rollers import TURN, Indexed, barrel_away, globoid_away, nearest
from support.heavy import manifold3d, trimesh

from camgeo.capabilities.indexing.band import filled
from camgeo.capabilities.indexing.solid import index_mesh
from camgeo.files.errors import RegionError
from camgeo.fit.nodes import ToleranceError
from camgeo.output.extension import numbers_of
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.files.mesh import Mesh

BARREL = """cam:
  kind: indexing
  barrel: {radius: 50, offset: 57}
  depth: 13
  turret: {stops: 6, radius: 60, roller: 9, clearance: 0.03}
  motion: [{rise: 60, over: 150, law: polynomial-345}, {dwell: 210}]
part: {length: 70, bore: 24}
"""
GLOBOID = """rotation: ccw
cam:
  kind: indexing
  globoid: {distance: 90, radius: 49}
  depth: 13
  turret: {stops: 8, roller: 8, preload: 0.01}
  motion: [{rise: 45, over: 120, law: cycloidal}, {dwell: 240}]
part: {length: 60, bore: 20}
"""
LAWS = {
    BARREL: Indexed([("rise", 60.0, 150.0, "polynomial-345"), ("dwell", 0.0, 210.0, "")], -30.0),
    GLOBOID: Indexed([("rise", 45.0, 120.0, "cycloidal"), ("dwell", 0.0, 240.0, "")], -22.5),
}
PLAY = {BARREL: 0.03, GLOBOID: -0.01}
SIZES = {BARREL: (9.0, 37.0, 50.0, 70.0, 12.0), GLOBOID: (8.0, 62.0, 49.0, 60.0, 10.0)}
"""Radius of a roller, layers of floor and blank, length, radius of the bore."""
AWAY = {BARREL: barrel_away(57.0, 60.0, 1, 35.0), GLOBOID: globoid_away(90.0, 30.0)}
SHARES = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4], [1, 1, 0], [0, 1, 1], [1, 0, 1]], dtype=float)
FEW = 1500  # places of a mesh that are held against all positions


def layer_of(text: str, points: np.ndarray) -> np.ndarray:
    """Distance of points from the cam's axis, or from the circle about it on which the turret's axis runs, mm."""
    r = np.hypot(points[:, 0], points[:, 1])
    return r if text == BARREL else np.hypot(90.0 - r, points[:, 2] - 30.0)


def strayed(text: str, mesh: Mesh, slack: float, rng: random.Random) -> float:
    """Greatest distance of places all over a mesh from the nearest surface of the intended cam, mm."""
    weights = SHARES / SHARES.sum(axis=1)[:, None]
    corners = mesh.points[mesh.triangles]
    points = np.concatenate([mesh.points, np.einsum("wc,tcx->twx", weights, corners).reshape(-1, 3)])
    points = points * np.array([1.0, -1.0, 1.0]) if "ccw" in text else points
    roller, floor, blank, length, bore = SIZES[text]
    w, z, r = layer_of(text, points), points[:, 2], np.hypot(points[:, 0], points[:, 1])
    off = np.min([abs(w - blank), abs(w - floor), abs(z), abs(z - length), abs(r - bore)], axis=0)
    low, high = sorted((floor, blank))
    sides = np.flatnonzero((off > slack) & (w > low - slack) & (w < high + slack))
    rest = np.setdiff1d(np.flatnonzero(off > slack), sides)
    assert rest.size == 0
    sides = np.array(rng.sample(sides.tolist(), min(FEW, sides.size)))
    near = nearest(AWAY[text], LAWS[text], points[sides], 3, 30)
    found = np.minimum(abs(near - roller), abs(near - roller - PLAY[text]))
    plain = np.delete(off, sides)
    return float(max(found.max(), plain[plain <= slack].max()))


def swept_volume(text: str) -> float:
    """Volume of the grooves by positions alone, mm^3: heights at which all rollers cut columns of points."""
    roller, floor, blank, length, _ = SIZES[text]
    knots, weights = np.polynomial.legendre.leggauss(4)
    total, turn = 0.0, (np.arange(96) + 0.5) * (TURN / 96)
    for knot, weight in zip(knots, weights, strict=True):
        w = 0.5 * (floor + blank) + 0.5 * (blank - floor) * knot
        if text == BARREL:
            low, high = 0.0, length

            def at(phi: np.ndarray, h: np.ndarray, w: float = w) -> np.ndarray:
                return np.stack([w * np.cos(phi), w * np.sin(phi), h], axis=-1)

            def share(h: np.ndarray, w: float = w) -> np.ndarray:
                return w * h
        else:
            low, high = math.asin(-30.0 / w), math.asin(30.0 / w)

            def at(phi: np.ndarray, h: np.ndarray, w: float = w) -> np.ndarray:
                r = 90.0 - w * np.cos(h)
                return np.stack([r * np.cos(phi), r * np.sin(phi), 30.0 + w * np.sin(h)], axis=-1)

            def share(h: np.ndarray, w: float = w) -> np.ndarray:
                return w * (90.0 * h - w * np.sin(h))

        height = np.linspace(low, high, 41)
        phi, h = np.repeat(turn[:, None], 41, axis=1), np.repeat(height[None], 96, axis=0)

        def deep(phi: np.ndarray, h: np.ndarray, at: Callable = at) -> np.ndarray:
            return nearest(AWAY[text], LAWS[text], at(phi.ravel(), h.ravel()), 3, 14).reshape(phi.shape) - roller

        gap = deep(phi, h)
        area = np.sum(np.where(gap[:, 1:] < 0.0, np.diff(share(h), axis=1), 0.0) * (gap[:, :-1] < 0.0))
        rows, cells = np.nonzero((gap[:, 1:] < 0.0) != (gap[:, :-1] < 0.0))
        one, two = h[rows, cells], h[rows, cells + 1]
        begins = gap[rows, cells] < 0.0
        for _ in range(14):
            middle = 0.5 * (one + two)
            same = (deep(turn[rows], middle) < 0.0) == begins
            one, two = np.where(same, middle, one), np.where(same, two, middle)
        inside = np.where(begins, share(one) - share(h[rows, cells]), share(h[rows, cells + 1]) - share(one))
        total += weight * 0.5 * abs(blank - floor) * float(area + inside.sum()) * (TURN / 96)
    return total


def whole(text: str) -> float:
    """Volume of the blank with its bore, mm^3."""
    _, _, blank, length, bore = SIZES[text]
    if text == BARREL:
        return math.pi * (blank**2 - bore**2) * length
    z, weights = np.polynomial.legendre.leggauss(60)
    r = 90.0 - np.sqrt(blank**2 - (30.0 * z) ** 2)
    return float(math.pi * 30.0 * np.sum(weights * (r**2 - bore**2)))


def checked(mesh: Mesh, tolerance: float, bound: float) -> None:
    """Demand a closed, oriented mesh within its own bound."""
    body = trimesh.Trimesh(mesh.points, mesh.triangles, process=False)
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.euler_number == 0
    assert body.body_count == 1
    assert body.volume == pytest.approx(mesh.volume, rel=1e-12)
    assert 0.3 * tolerance < bound <= tolerance


@pytest.mark.slow
@pytest.mark.parametrize("text", [BARREL, GLOBOID], ids=["barrel", "globoid"])
@pytest.mark.parametrize("tolerance", [0.1, 0.02])
def test_every_triangle_is_within_the_tolerance(text: str, tolerance: float) -> None:
    mesh, facts = index_mesh(shared_design(text), tolerance, numbers_of("stl", 1.0))
    checked(mesh, tolerance, facts.bound.worst)
    assert facts.vertices == len(mesh.points)
    assert strayed(text, mesh, tolerance, random.Random(1)) <= tolerance


@pytest.mark.slow
@pytest.mark.parametrize("text", [BARREL, GLOBOID], ids=["barrel", "globoid"])
def test_a_fine_solid_and_its_volume(text: str) -> None:
    plain = changed(text, (", clearance: 0.03", "")) if text == BARREL else changed(text, (", preload: 0.01", ""))
    mesh, facts = index_mesh(design_of(plain), 0.002, numbers_of("stl", 1.0))
    checked(mesh, 0.002, facts.bound.worst)
    body = manifold3d.Manifold(manifold3d.Mesh64(mesh.points, mesh.triangles.astype(np.uint64)))
    assert body.status() == manifold3d.Error.NoError
    # 96 angles of 4 layers are within some parts in 10^4 of the groove
    groove = swept_volume(text)
    assert body.volume() == pytest.approx(whole(text) - groove, abs=2e-3 * groove)


def random_design(seed: int, form: str) -> IndexDesign:
    """A random cam that is sound."""
    rng = random.Random(seed)
    while True:
        try:
            return design_of(random_indexer(rng, form, inch=seed % 2 == 0, ccw=seed % 3 == 0))
        except RecipeErrors:
            continue


@pytest.mark.slow
@pytest.mark.parametrize("form", ["barrel", "globoid"])
@pytest.mark.parametrize("seed", range(3))
def test_random_cams(form: str, seed: int) -> None:
    design = random_design(seed, form)
    mesh, facts = index_mesh(design, 0.02, numbers_of("stl", 1.0))
    checked(mesh, 0.02, facts.bound.worst)
    body = manifold3d.Manifold(manifold3d.Mesh64(mesh.points, mesh.triangles.astype(np.uint64)))
    assert body.status() == manifold3d.Error.NoError
    assert body.volume() == pytest.approx(mesh.volume, rel=1e-9)


def test_a_tolerance_that_cannot_be_held() -> None:
    with pytest.raises(ToleranceError, match="at least"):
        index_mesh(shared_design(BARREL), 1e-9, numbers_of("stl", 1.0))


def test_an_end_that_is_met_twice_at_one_angle() -> None:
    """A short globoid, whose flank bulges where it meets the upper face."""
    rng = random.Random(10)
    design = design_of(random_indexer(rng, "globoid", inch=False, ccw=False))
    mesh, facts = index_mesh(design, 0.05, numbers_of("stl", 1.0))
    checked(mesh, 0.05, facts.bound.worst)


def line(phi: Any, h: Any) -> tuple[np.ndarray, np.ndarray]:
    return np.asarray(phi, dtype=float), np.asarray(h, dtype=float)


def area(phi: np.ndarray, h: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = triangles.T
    return 0.5 * ((phi[b] - phi[a]) * (h[c] - h[a]) - (phi[c] - phi[a]) * (h[b] - h[a]))


@pytest.mark.parametrize("wide", [(0.1, math.inf), (0.1, 0.07)])
def test_a_band_is_covered_once(wide: tuple[float, float]) -> None:
    below, above = np.linspace(0.0, 3.0, 61), np.linspace(0.0, 3.0, 47)
    low, high = 0.3 * np.sin(2.0 * below) - 0.4 * below * (3.0 - below), 0.5 * above * (3.0 - above)
    low[-1] = high[-1] = 0.3 * math.sin(6.0)
    high = high + 0.3 * math.sin(6.0) * above / 3.0
    high[-1] = low[-1]
    phi, h = np.concatenate([below, above[1:-1]]), np.concatenate([low, high[1:-1]])
    upper = np.concatenate([[0], np.arange(61, 61 + 45), [60]])
    found = filled((phi, h), np.arange(61), upper, (40.0, 40.0), wide)
    phi, h = np.concatenate([phi, found.phi]), np.concatenate([h, found.h])
    parts = area(phi, h, found.triangles)
    assert (parts > 0.0).all()
    assert parts.sum() == pytest.approx(np.trapezoid(high, above) - np.trapezoid(low, below), rel=1e-12)
    edges = np.sort(np.concatenate([found.triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    kinds, count = np.unique(edges, axis=0, return_counts=True)
    assert np.count_nonzero(count == 1) == 60 + 46
    assert count.max() == 2
    inner = kinds[count == 2]
    assert np.abs(np.diff(phi[inner], axis=1)).max() <= wide[0]
    assert np.abs(np.diff(h[inner], axis=1)).max() <= wide[1]
    # but for those beside the lines they are as large as may be
    own = (np.ptp(phi[found.triangles], axis=1) > 0.99 * wide[0]) & (
        np.ptp(h[found.triangles], axis=1) > 0.99 * wide[1]
    )
    assert math.isinf(wide[1]) or parts[own].sum() > 0.8 * parts.sum()


def test_lines_that_cross_are_refused() -> None:
    phi, h = line([0.0, 1.0, 2.0, 1.0], [0.0, 1.0, 0.0, -1.0])
    with pytest.raises(RegionError, match="cross"):
        filled((phi, h), np.arange(3), np.array([0, 3, 2]), (1.0, 1.0), (9.0, math.inf))
