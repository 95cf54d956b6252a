"""Meshes that other programs, which compute in single precision, read and save again: the same verdict.

The tolerance is the error that a mesh comes to by itself: no room is left but what is kept back.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.heavy import lib3mf, trimesh
from support.places import RECIPES

import camgeo
from camgeo.files.precision import DECIMALS, SINGLE

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.api.report import Report


def by_lib3mf(path: Path) -> Path:
    model = lib3mf.get_wrapper().CreateModel()
    model.QueryReader("3mf").ReadFromFile(str(path))
    again = path.with_name("again.3mf")
    model.QueryWriter("3mf").WriteToFile(str(again))
    return again


def by_trimesh(path: Path) -> Path:
    again = path.with_name("again.stl")
    trimesh.load(path, force="mesh").export(again)
    return again


def tightly(folder: Path, name: str, kind: str) -> tuple[Report, Path, float]:
    """Export a mesh within no more than the error that it comes to."""
    text = (RECIPES / f"{name}.yaml").read_text().partition("export:")[0]
    path, tolerance = folder / "cam.yaml", 0.002
    for _ in range(2):
        path.write_text(f"{text}export: {{tolerance: {tolerance!r}, files: [{kind}]}}\nverify: {{angles: 90}}\n")
        made = camgeo.export(camgeo.load(path), folder)
        (file,) = made.files
        tolerance, held = (file.geometry_error or 0.0) + 2e-9, tolerance
    return made, folder / "cam" / f"cam.{kind}", held


@pytest.mark.slow
@pytest.mark.parametrize("name", ["shu-wu", "disc-roller", "w-figure-9"])
@pytest.mark.parametrize(("kind", "saved"), [("3mf", by_lib3mf), ("3mf", by_trimesh), ("stl", by_trimesh)])
def test_a_mesh_that_is_saved_again_in_single_precision_passes(tmp_path, name, kind, saved):
    made, path, tolerance = tightly(tmp_path, name, kind)
    assert made.ok
    recipe = camgeo.load(tmp_path / "cam.yaml")
    again = camgeo.verify(recipe, saved(path), tolerance=tolerance, units="mm" if saved is by_trimesh else None)
    assert [(check.name, check.value, check.limit) for check in again.checks if not check.ok] == []


def test_what_is_kept_back_and_where_that_would_be_too_much():
    """All that single precision takes at that size; below five quarters of it the tolerance is the file's own."""
    more, moved = SINGLE.bound(50.002), DECIMALS.bound(50.002)
    assert DECIMALS.fit_tolerance(0.002, 50.0) == pytest.approx(0.002 - moved - more, abs=1e-15)
    least = 1.25 * SINGLE.bound(50.0) + DECIMALS.bound(50.0)
    assert DECIMALS.fit_tolerance(1.001 * least, 50.0) == pytest.approx(0.25 * SINGLE.bound(50.0), rel=0.01)
    assert DECIMALS.fit_tolerance(0.999 * least, 50.0) > SINGLE.bound(50.0)
    inch = DECIMALS.in_units(25.4)
    assert inch.again is not None
    assert inch.fit_tolerance(0.002, 50.0) == pytest.approx(0.002 - inch.bound(50.002) - inch.again.bound(50.002))
    assert SINGLE.again is None  # the numbers of an STL are single already
