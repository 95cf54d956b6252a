"""Checks of a camshaft that are listed before it is made: those that come, whatever its lobes and files are.

Holds: camgeo.capabilities.camshaft.starter.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.places import RECIPES

import camgeo
from camgeo.capabilities.camshaft.lobes import foresee
from camgeo.recipe.starter import starter
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from pathlib import Path

LOBE = "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 8}, motion: {formula: 5*(1 - cos(t))}}\n"
MORE = (
    "dynamics: {mass: 1, preload: 200, rpm: 300}\nlimits: {size: {at_most: 60}, contact-force-least: {at_least: 1}}\n"
)
ROW = "{recipe: lobe.yaml, at: %s, z: %s, length: 10}"
SHAFTS = {
    "journals": "shaft: {diameter: 22, to: 40, bore: 6}, journals: [{z: 30, length: 5, diameter: 30}], lobes: [%s]",
    "lobes from end to end": "shaft: {diameter: 22, from: 10, to: 20}, lobes: [%s]",
    "a plain shaft": "shaft: {diameter: 22, to: 40}, lobes: [%s]",
}


@pytest.mark.thin(2)
@pytest.mark.parametrize("shaft", SHAFTS)
@pytest.mark.parametrize(
    "more",
    [
        "",
        MORE,  # needs: dynamics
    ],
)
def test_the_checks_that_are_told_are_made(tmp_path: Path, shaft: str, more: str) -> None:
    (tmp_path / "lobe.yaml").write_text(LOBE + more)
    path = tmp_path / "shaft.yaml"
    export = "export: {tolerance: 0.01, files: [stl, glb, {csv: {as: events}}, svg]}\nverify: {angles: 90}\n"
    path.write_text(f"camshaft: {{{SHAFTS[shaft] % (ROW % (20, 10))}}}\n{export}")
    recipe = camgeo.load(path)
    report = camgeo.check(recipe)
    assert report.ok
    assert {tuple(one) for one in foresee(recipe)} == {(check.name, check.file) for check in report.checks}
    told = [remark.sentence for remark in report.remarks if remark.name == "lobe-checks"]
    left = "float of lobe.yaml is judged by its own export alone"
    assert told == ([left] if more else [])


def test_the_starter_lists_only_files_of_camshafts() -> None:
    (line,) = [line for line in starter("camshaft").splitlines() if line.startswith("  files:")]
    listed = line.partition("# ")[2].partition(", or ")[0].split(", ")
    assert listed == [
        *(name for name, record in FORMATS.items() if record.mesh or record.solid),
        "csv",
        "dmis",  # needs: made
        "svg",
        "html",
    ]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["four-cylinder", "packaging"])
def test_those_of_shipped_camshafts(name: str) -> None:
    recipe = camgeo.load(RECIPES / "camshafts" / f"{name}.yaml")
    made = {(check.name, check.file) for check in camgeo.check(recipe).checks}
    assert {tuple(one) for one in foresee(recipe)} == made
