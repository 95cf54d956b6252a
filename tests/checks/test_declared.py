"""Checks are declared once: what is made is declared, what is declared is made, and no name is written again.

Holds: camgeo.checks.declaration.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest
from support.places import ROOT

from camgeo.checks.declared import CHECKS, LIMIT, OF_FEATURES, READABLE, declaration, declarations
from camgeo.output import pipeline
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.loading import load, load_text
from camgeo.registry import registry

if TYPE_CHECKING:
    from pathlib import Path

PACKAGE = ROOT / "camgeo"
MAKERS = {"Check", "at_most", "failed", "above_zero"}
DECLARED = [
    PACKAGE / "checks" / "declared.py",
    *(path for name in ("checks", "declared") for path in sorted(PACKAGE.glob(f"capabilities/*/{name}.py"))),
]
HOMES = {
    path.relative_to(PACKAGE).as_posix()
    for path in (
        *DECLARED,
        PACKAGE / "recipe" / "figures.py",
        *PACKAGE.glob("capabilities/*/figures.py"),
        *PACKAGE.glob("part/*.py"),
    )
}
# names that are no other word of a recipe, a program or a drawing
OWN = {name for name in CHECKS if "-" in name} | {"mobility", "reversal", "watertight", "readable"}


def modules() -> dict[str, ast.Module]:
    return {
        path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
        for path in sorted(PACKAGE.rglob("*.py"))
    }


def is_name(node: ast.expr) -> bool:
    """Whether an expression asks for the name of a check: `check.name`, `check["name"]`."""
    if isinstance(node, ast.Attribute):
        return node.attr == "name" and isinstance(node.value, ast.Name) and node.value.id in {"check", "one"}
    wanted = isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant) and node.slice.value == "name"
    return wanted and isinstance(node.value, ast.Name) and node.value.id in {"check", "one"}  # type: ignore[attr-defined]


def texts(node: ast.AST) -> list[str]:
    return [one.value for one in ast.walk(node) if isinstance(one, ast.Constant) and isinstance(one.value, str)]


def offences(tree: ast.Module) -> list[str]:
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and node.args:
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if called in MAKERS and isinstance(node.args[0], ast.Constant | ast.JoinedStr):
                found.append(f"line {node.lineno}: made by a name of its own")
        if isinstance(node, ast.Compare) and any(is_name(one) for one in (node.left, *node.comparators)):
            found += [f"line {node.lineno}: compared with {text!r}" for text in texts(node) if text in CHECKS]
        if isinstance(node, ast.Constant) and node.value in OWN:
            found.append(f"line {node.lineno}: {node.value!r}")
    return found


@pytest.mark.slow
def test_no_name_is_written_again() -> None:
    found = {path: here for path, tree in modules().items() if path not in HOMES and (here := offences(tree))}
    # a key of the report's sections, and kinds of cam
    kinds = ("'constant-breadth'", "'constant-diameter'")
    allowed = {path: [text for text in here if not text.endswith(kinds)] for path, here in found.items()}
    # remarks have names of their own, one of them that of a figure too
    remarks = allowed.get("measures/remarks.py", [])
    allowed["measures/remarks.py"] = [text for text in remarks if not text.endswith("'pressure-angle'")]
    # a follower names the checks of its motion; one that is no check's name could not be made
    found = {path: here for path, here in allowed.items() if here and not path.startswith("cams/")}
    assert found == {}


def test_the_search_for_names_finds_some() -> None:
    assert offences(ast.parse("Check('wall', ok)\nfailed(f'undercut-{kind}', why)"))
    assert offences(ast.parse("check['name'] in {'wall', 'bore'}"))
    assert offences(ast.parse("FIELDS = {'undercut-global': 1}"))
    assert not offences(ast.parse("part['bore']; Check(WALL.name, ok); path.name == 'wall'"))


def test_each_is_declared_once() -> None:
    text = (PACKAGE / "checks" / "declared.py").read_text(encoding="utf-8")
    assert len(re.findall(r"^[A-Z_]+ = Declared\(", text, re.MULTILINE)) + len(OF_FEATURES) == len(CHECKS.among(()))
    names = [one.name for one in declarations()]
    assert names == [*CHECKS, *(LIMIT + name for name in FIGURES)]
    assert all(declaration(name).name == name for name in names)


@cache
def made(path: Path) -> tuple[dict[str, Any], ...]:
    return tuple(pipeline.check(load(path)).report["checks"])


MORE = {
    "a wanted law": """\
cam:
  kind: double-roller
  ratio: 2
  arm: 40
  roller_radius: 8
  delta:
    harmonics: 15
    law: [{rise: 8, over: 35, law: modified-sine}, {dwell: 15}, {return: 8, over: 40, law: cycloidal}]
export: {files: [csv]}
""",
    # needs: milling
    "a milled groove": """\
cam:
  kind: disc
  base_radius: 32
  follower: {kind: roller, radius: 8}
  track: {groove: {clearance: 0.03, depth: 8}}
  motion: [{rise: 10, over: 180, law: cycloidal}, {return: 10, over: 180, law: cycloidal}]
part: {thickness: 14, outer: 130, bore: 16}
manufacture: {cutter: 12, feed: 500, plunge: 100, spindle: 6000, depth_of_cut: 4, safe_height: 5}
export: {tolerance: 0.01, files: [gcode]}
verify: {angles: 90}
""",
    "a part with everything": """\
cam: {kind: support, p: 40 + 2*cos(3*t)}
part:
  thickness: 8
  bore: 10
  keyway: din6885
  hub: {diameter: 24, height: 9}
  set_screw: {diameter: 3}
  bolts: {count: 3, circle: 45, hole: 5}
  lightening: {largest: 2, wall: 3}
  chamfer: 0.5
  mark: {as: engrave}
export: {tolerance: 0.01, files: [dxf, stl]}
verify: {angles: 60}
""",
    "a ring": """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  track: internal
  motion: [{rise: 12, over: 110, law: modified-sine}, {dwell: 60}, {return: 12, over: 100, law: cycloidal}, {dwell: 90}]
part: {thickness: 5, outer: 130, bolts: {count: 3, circle: 118, hole: 5}}
export: {tolerance: 0.01, files: [dxf, stl]}
verify: {angles: 60}
""",
    # needs: milling
    "milled": """\
cam: {kind: support, p: 30 + 2*cos(2*t)}
part: {thickness: 5, bore: 10}
export: {tolerance: 0.01, files: [gcode]}
verify: {angles: 60}
manufacture: {cutter: 6, feed: 400, plunge: 100, spindle: 9000, depth_of_cut: 5, safe_height: 5, holes: true}
""",
    # needs: mechanism
    "bodies": """\
cam: {kind: support, p: 25 + 1.5*cos(3*t), shaft: [3, 2]}
part: {thickness: 8, bore: {hexagon: 10}}
export: {tolerance: 0.01, files: [{stl: {parts: all}}]}
verify: {angles: 60}
""",
    # needs: dynamics
    "with a spring": """\
cam: {kind: support, p: 30 + 2*cos(2*t)}
export: {files: [csv]}
dynamics: {mass: 0.4, damping: 20, stiffness: 2.0e5, preload: 150, rpm: 600}
""",
    # needs: dynamics
    "with play": """\
cam: {kind: support, p: 30 + 2*cos(3*t)}
export: {files: [csv]}
dynamics: {mass: 0.4, damping: 20, stiffness: 2.0e5, backlash: 0.05, rpm: 600}
""",
    "a double roller": """\
cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 300}}}
export: {tolerance: 0.01, files: [dxf]}
verify: {angles: 60}
""",
    "a roller yoke": """\
cam:
  kind: constant-diameter
  base_radius: 40
  roller_radius: 8
  motion: [{rise: 9, over: 120, law: cycloidal}, {dwell: 60}]
export: {tolerance: 0.01, files: [csv]}
""",
    # needs: dynamics
    "a stem": """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 8}
  motion: [{rise: 9, over: 120, law: cycloidal}, {return: 9, over: 160, law: cycloidal}, {dwell: 80}]
manufacture: {cutter: 6, wheel: 60}
export: {tolerance: 0.01, files: [csv]}
dynamics:
  {mass: 0.4, stiffness: 2.0e5, preload: 900, rpm: 100, guide: {overhang: 40, length: 60, friction: 0.2}}
""",
    "a face": """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: flat, width: 40}
  motion: [{rise: 9, over: 120, law: cycloidal}, {return: 9, over: 160, law: cycloidal}, {dwell: 80}]
export: {tolerance: 0.01, files: [csv]}
""",
    "a grinder": """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat, diameter: 33}
  motion: {lobe: {lift: 8.25, half: 66, powers: [2, 8, 14, 20, 26]}}
manufacture: {wheel: 80}
export: {tolerance: 0.02, files: [{csv: {as: grinding}}]}
""",
    "a linkage": """\
cam: {kind: support, p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t), shaft: [18, 8.5]}
linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}
dwell: {band: 0.1, at_least: 30}
export: {tolerance: 0.01, files: [dxf]}
verify: {angles: 60}
""",
}


@cache
def of_text(text: str) -> tuple[dict[str, Any], ...]:
    return tuple(pipeline.check(load_text(text, "cam.yaml")).report["checks"])


MORE["a table for a drive"] = """\
cam:
  kind: disc
  base_radius: 30
  follower: {kind: roller, radius: 8}
  motion: [{rise: 10, over: 180, law: polynomial-345}, {return: 10, over: 180, law: polynomial-345}]
export: {tolerance: 0.02, files: [{csv: {as: controller, for: codesys}}, {csv: {as: controller, for: sew}}]}
"""
OF_POINTS = {"made-profile", "made-motion", "made-output"}  # of measured points, which no recipe exports


@pytest.mark.slow
def test_what_is_declared_is_made_and_what_is_made_is_declared() -> None:
    checks = [check for text in MORE.values() for check in of_text(text)]
    checks += pipeline.check(load_text(MORE["a ring"], "cam.yaml").using(*registry.options())).report["checks"]
    assert {check["name"] for check in checks} == set(CHECKS) - {READABLE.name} - OF_POINTS
    for check in checks:
        assert check["unit"] in {*CHECKS[check["name"]].units, ""}, check


def test_a_file_that_cannot_be_read_fails_by_a_declared_name(tmp_path: Path) -> None:
    (tmp_path / "cam.stl").write_bytes(b"nothing")
    (tmp_path / "cam.dxf").write_text("nothing")
    recipe = load_text(MORE["a part with everything"], "cam.yaml")
    report = pipeline.judge_files(recipe, [tmp_path / "cam.stl", tmp_path / "cam.dxf"])
    assert READABLE.name in {check["name"] for check in report["checks"] if not check["ok"]}
    assert {check["name"] for check in report["checks"]} <= set(CHECKS)


@pytest.mark.slow
@pytest.mark.parametrize("path", sorted((ROOT / "recipes").glob("*.yaml"))[::2], ids=lambda path: path.stem)
def test_every_check_of_a_shipped_recipe_is_declared(path: Path) -> None:
    for check in made(path):
        declared = declaration(check["name"])
        assert declared is not None
        unforeseen = declared.of_file is None and declared.exact is None  # the outline of another body
        assert unforeseen or (declared.of_file if check.get("file") else declared.exact), check


def test_the_report_s_page_has_each_check() -> None:
    page = (ROOT / "docs" / "report.md").read_text(encoding="utf-8")
    table = page.partition("## A check")[2].partition("## Remarks")[0]
    named = set(
        re.findall(r"`([a-z3:<>-]+)`", "".join(line.split("|")[1] for line in table.splitlines() if "|" in line))
    )
    assert {*CHECKS.among(()), "limit:<figure>"} <= named


def test_fields_are_those_of_a_recipe() -> None:
    from camgeo.recipe.keys import recipe_table
    from camgeo.schema.fields import field_at

    for one in declarations():
        for path in filter(None, (one.field, one.own_field)):
            kinds = ("double-roller", "disc")
            known = any(field_at(recipe_table(), path, {"cam": kind, "linkage": "four-bar"}) for kind in kinds)
            assert known or one.name.startswith(LIMIT), path


def test_a_declaration_without_a_condition_is_of_files_alone() -> None:
    never = {one.name for one in CHECKS.among(()).values() if one.exact is None and one.of_file is None}
    assert never == {READABLE.name}
