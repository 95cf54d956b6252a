"""Random drums as files, held against rollers at all angles by positions alone: every triangle lies where it should.

Holds: camgeo.capabilities.cylindrical.solid, camgeo.capabilities.cylindrical.sheet,
camgeo.capabilities.cylindrical.grid, camgeo.capabilities.cylindrical.bends, camgeo.capabilities.cylindrical.undercut.
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import LED, design_of, random_drum, recipe_of
from capabilities.cylindrical.positions import off_flank
from support.heavy import manifold3d, trimesh

from camgeo.capabilities.cylindrical.figures import volume
from camgeo.capabilities.cylindrical.solid import drum_mesh
from camgeo.capabilities.cylindrical.tracks import Groove, Rib
from camgeo.output.extension import numbers_of
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from capabilities.cylindrical.positions import Lift

    from camgeo.files.mesh import Mesh

TRACKS = ("groove", "rib", "top", "bottom")
SHARES = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4], [1, 1, 0], [0, 1, 1], [1, 0, 1]], dtype=float)


def rollers(recipe: Any, lift: Lift) -> list[tuple[Lift, int, float]]:
    """Motion, side and radius of the roller of each flank."""
    track, radius = recipe.track, recipe.roller.radius
    if isinstance(track, Groove):
        return [(lift, -1, radius), (lift, 1, radius + track.clearance)]
    if isinstance(track, Rib):
        half = 0.5 * track.distance
        return [(lift.second(half), -1, radius), (lift.second(-half), 1, radius)]
    return [(lift, -1, radius)] if track.facing == "top" else [(lift, 1, radius)]


def strayed(text: str, lift: Lift, mesh: Mesh) -> np.ndarray:
    """Distance (k,) of places all over a mesh from the nearest surface of the intended drum, mm."""
    recipe = recipe_of(text)
    weights = SHARES / SHARES.sum(axis=1)[:, None]
    corners = mesh.points[mesh.triangles]
    places, number = np.einsum("wc,tcx->twx", weights, corners), np.arange(len(corners))
    points = np.concatenate([places[:, 0], places[number, 1 + number % (len(SHARES) - 1)]])  # two of each triangle
    if recipe.rotation == "ccw":
        points = points * np.array([1.0, -1.0, 1.0])
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    bore = recipe.part.bore
    assert bore is not None
    off = np.min(
        [abs(r - recipe.radius), abs(r - recipe.floor), abs(r - 0.5 * bore), abs(z), abs(z - recipe.height)], axis=0
    )
    slack = recipe.export.tolerance
    near = (off > slack) & (r > recipe.floor - slack) & (r < recipe.radius + slack)
    found = [abs(off_flank(*roller, recipe.level, points[near])) for roller in rollers(recipe, lift)]
    off[near] = np.min([off[near], *found], axis=0)
    return off


def made(seed: int, led: str, *, undercut: bool) -> tuple[str, Lift, Any, Mesh, Any]:
    """A random drum as a mesh in the precision of an STL, with its text, motion and design."""
    rng = random.Random(seed)
    track = TRACKS[seed % 4]
    for _ in range(40):
        text, lift = random_drum(rng, track, inch=seed % 3 == 0, ccw=seed % 2 == 1, undercut=undercut, led=led)
        try:
            design = design_of(text)
        except RecipeErrors as error:  # drawn again where the drum is refused for a reason
            if "undercut" in str(error) or "motion is lost" in str(error):
                continue
            raise
        if undercut == any(design.tips.values()):
            recipe = design.recipe
            mesh, facts = drum_mesh(design, recipe.export.tolerance, numbers_of("stl", 1.0))
            return text, lift, design, mesh, facts
    raise AssertionError(f"seed {seed}: no drum is made")


def judged(seed: int, led: str = "carriage", *, undercut: bool = False) -> None:
    text, lift, design, mesh, facts = made(seed, led, undercut=undercut)
    tolerance = design.recipe.export.tolerance
    assert facts.bound.worst <= tolerance
    off = strayed(text, lift, mesh)
    assert off.max() <= tolerance * (1.0 + 1e-6), (text, off.max())
    body = trimesh.Trimesh(mesh.points, mesh.triangles, process=False)
    assert body.is_watertight
    assert body.is_winding_consistent
    solid = manifold3d.Manifold(manifold3d.Mesh64(mesh.points, mesh.triangles.astype(np.uint64)))
    assert solid.status() == manifold3d.Error.NoError
    assert solid.genus() == 1
    assert solid.volume() == pytest.approx(mesh.volume, rel=1e-12)
    # a surface that is everywhere near goes once round the drum, as it encloses as much
    assert abs(solid.volume() - volume(design)) <= tolerance * body.area


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_every_triangle_is_near_the_drum(seed: int) -> None:
    judged(seed)


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "led"), [(0, "trailing"), (1, "cone on an arm"), (2, "beside"), (3, "apex")])
def test_every_triangle_with_other_followers(seed: int, led: str) -> None:
    judged(seed, led)


@pytest.mark.slow
@pytest.mark.parametrize("led", LED[1:])
@pytest.mark.parametrize("seed", range(300, 301))
def test_every_triangle_of_many_with_other_followers(seed: int, led: str) -> None:
    judged(seed, led)


@pytest.mark.slow
@pytest.mark.parametrize("led", LED[1:])
def test_every_triangle_of_other_followers_that_are_cut_short(led: str) -> None:
    judged(400 + LED.index(led), led, undercut=True)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 105))
def test_every_triangle_of_many(seed: int) -> None:
    judged(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [202, 203, 208, 209])  # a drum of each track
def test_every_triangle_of_drums_that_are_cut_short(seed: int) -> None:
    judged(seed, undercut=True)
