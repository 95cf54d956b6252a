"""Imports run strictly downward, in both packages, and heavy libraries are not imported at module level."""

from __future__ import annotations

import ast
import tomllib
from typing import TYPE_CHECKING

import pytest
from support.places import ROOT

if TYPE_CHECKING:
    from pathlib import Path

# Top floor first. A module imports from floors below its own only; neighbours on one floor do not import each other.
FLOORS = {
    "kin": """
        printed verify
        part
        driven judge
        follower
        frame roller
        deviation flat layers resting
        envelope lift_formula mechanism motion_sources.programme
        lift motion_sources.whole transmission
        chain formula motion_sources.table_text possible read swept
        collision motion_sources.points motion_sources.table read_3mf read_step
        dyad encounter forces hole motion_sources.lobe motion_sources.ring read_dxf read_stl read_svg switches
        transmission_law
        drawing milled motion_sources.laws motion_sources.motion region svg_path
        floating motion_sources.peaks
        bearing bouncing bounding flaws holding law linkage nesting parallel roots routes step_face syntax
        contour dxf_entities dynamics expression frame_dwell loop motion_sources.functions motion_sources.spline
        piecewise poses step_curve
        stretch
        biarc dwell figures jet mobility peaks pieces shape tracking
        bezier contact flight monotone motion response series turn upright
        bernstein chaining drive extremes foot guide hull instants nearest part21 read_gcode taylor triangles
        arcs ball chebyshev distinct newton oscillator read_error
        check motion_sources
    """,
    "camgeo": """
        __main__
        cli pytest_plugin testing
        batch laws page.command study.command sweep.command
        study.document sweep.means sweep.refine sweep.search
        study.ladder study.margins sweep.outputs sweep.run
        sweep.engines sweep.recipes sweep.table
        sweep.ask sweep.job sweep.pictures
        sweep.gather sweep.store
        sweep.plan
        sweep.figures
        sweep.rebuilt
        sweep.cams
        sweep.ends sweep.linkages
        sweep.windows
        pipeline recipe
        checks.limits checks.remarks
        checks.measured
        making.left_out making.make
        making.mechanism
        making.drawing making.gcode making.parts making.step making.view making.table
        making.solid
        making.job
        bodies.build outlines
        page.png page.watch
        page.page
        page.content page.tables
        page.curves
        bodies.linked manufacture.meant page.linked page.outline
        manufacture.compensation manufacture.milling
        bodies.dyads bodies.roller bodies.yoke dynamics manufacture.cutter manufacture.inspection
        bodies.site bodies.guide design recipe.load files.step
        bodies.collide bodies.shaft files.brep files.meshes foreseen
        part.check part.files part.meant recipe.checks report.linkage
        study.least undercut
        figures files.solid fit.polygon linkage part.body recipe.build trim
        crossing files.curves files.prism files.glb files.stl files.svg files.three_mf fit.arcs fit.edges
        fit.inflection fit.spline motion part.lighten profile.build
        recipe.readers
        files.mesh part.wall recipe.build_part recipe.check_part recipe.read_part
        causes files.precision fit.exact fit.handles fit.free_arcs report.document report.failure
        bodies.places bodies.linked_places reach
        bodies.forms bodies.assembly fit.cubic fit.spans fit.trigonometric pairs recipe.check_sweep
        recipe.read_limits recipe.read_linkage recipe.read_list recipe.read_scalar recipe.read_sweep
        bodies.body files.dxf fit.deviation fit.nodes fit.parts fit.staircase offset profile.support profile.wunderlich
        radius turning
        checks.declared
        checks.remedies files.gcode part.shapes recipe.edit recipe.reader recipe.schema recipe.starter
        bodies.sizes manufacture.toolpath recipe.model recipe.scalars recipe.source recipe.tables
        recipe.model_dynamics recipe.model_manufacture recipe.model_mechanism recipe.model_sweep recipe.table_part
        recipe.table_cam recipe.table_dynamics recipe.table_linkage recipe.table_manufacture recipe.table_mechanism
        recipe.table_sweep
        recipe.table_figures
        checks curve files files.markup files.table files.triangulate fit fit.pieces profile progress recipe.errors
        recipe.spec report rounded status store
        page.followers page.pack page.svg
        page.scene
        bodies files.missing making manufacture page fit.rational part recipe.din6885 recipe.model_part study
        study.picture sweep
        fit.bound
    """,
}
HEAVY = {
    *("ezdxf", "shapely", "trimesh", "manifold3d", "scipy", "matplotlib", "networkx", "mpmath", "hypothesis", "lib3mf"),
    *("pyarrow", "numba", "dask", "distributed", "OCP"),
}


def modules(package: str) -> dict[str, Path]:
    folder = ROOT / package
    found = {}
    for path in sorted(folder.rglob("*.py")):
        parts = list(path.relative_to(ROOT).with_suffix("").parts)
        if parts[-1] == "__init__":
            parts.pop()
        found[".".join(parts)] = path
    return found


def imported(path: Path, *, top_level_only: bool = False) -> set[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = tree.body if top_level_only else list(ast.walk(tree))
    names: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute"
            assert node.module
            names.add(node.module)
            names.update(f"{node.module}.{alias.name}" for alias in node.names)
    return names


def test_there_is_something_to_check() -> None:
    assert len(modules("kin")) >= 10
    assert len(modules("camgeo")) >= 15


def test_every_package_is_installed() -> None:
    listed = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]["packages"]
    there = [
        ".".join(path.parent.relative_to(ROOT).parts) for top in FLOORS for path in ROOT.glob(f"{top}/**/__init__.py")
    ]
    assert sorted(listed) == sorted(there)


def test_kin_never_imports_camgeo() -> None:
    offenders = {
        name for name, path in modules("kin").items() if any(n.split(".")[0] == "camgeo" for n in imported(path))
    }
    assert not offenders


@pytest.mark.parametrize("package", ["kin", "camgeo"])
def test_heavy_libraries_are_imported_where_they_are_called(package: str) -> None:
    offenders = {
        name: heavy
        for name, path in modules(package).items()
        if (heavy := {n.split(".")[0] for n in imported(path, top_level_only=True)} & HEAVY)
    }
    assert not offenders


@pytest.mark.parametrize("package", ["kin", "camgeo"])
def test_imports_run_strictly_downward(package: str) -> None:
    floors = [line.split() for line in FLOORS[package].strip().splitlines()]
    floor = {f"{package}.{name}": len(floors) - i for i, names in enumerate(floors) for name in names} | {package: 0}
    known = modules(package)
    assert set(floor) == set(known), "every module has its floor, and every floor its modules"
    upward = [
        f"{name} imports {other}"
        for name, path in known.items()
        for other in imported(path)
        if other in known and other != name and floor[other] >= floor[name]
    ]
    assert not upward
