"""Rooms of the house: imports between them run strictly downward, and the core knows no wing.

The rooms stand here, not the modules. Within a room files import one another, but not in a circle, for the types alone
neither. A room that grows past `MOST` files is to be divided.
"""

from __future__ import annotations

import ast
from functools import cache
from typing import TYPE_CHECKING

import pytest
from support.places import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

MOST = 20  # files of one folder

# Top floor first. A room imports from floors below its own only; neighbours on one floor do not import each other.
FLOORS = {
    "kin": """
        judge
        dynamics
        follower
        read clearance linkage
        contour law
        numeric
    """,
    "camgeo": """
        __main__
        capabilities
        cli
        pytest_plugin testing
        api
        camshaft
        output
        report.page
        assembly machining report
        measures
        synthesis
        checks
        formats
        files
        curve.undercut fit
        recipe
        cams
        motions
        curve schema
        common version
    """,
}
WINGS = {"camgeo.assembly", "camgeo.machining", "camgeo.capabilities", "camgeo.camshaft"}
# Modules of core rooms that stand for a wing, imported only when a recipe or a command asks for it.
DOORS = {
    "camgeo.output.parts",
    "camgeo.output.mechanism",
    "camgeo.output.gcode",
    "camgeo.api.camshaft",
}
HEAVY = {
    *("ezdxf", "shapely", "trimesh", "manifold3d", "scipy", "matplotlib", "networkx", "mpmath", "hypothesis", "lib3mf"),
    *("pyarrow", "dask", "distributed", "OCP"),
}


def modules(package: str) -> dict[str, Path]:
    """Each module's dotted name, with its file."""
    found = {}
    for path in sorted((ROOT / package).rglob("*.py")):
        parts = list(path.relative_to(ROOT).with_suffix("").parts)
        if parts[-1] == "__init__":
            parts.pop()
        found[".".join(parts)] = path
    return found


def imported(path: Path, *, top_level_only: bool = False) -> set[str]:
    """Modules, and names of modules, that a file imports; at top level: as the file itself is imported."""
    return _imported(path)[top_level_only]


@cache
def _imported(path: Path) -> tuple[set[str], set[str]]:
    """All that a file imports, and that at top level."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return _names(ast.walk(tree), path), _names(tree.body, path)


def _names(nodes: Iterable[ast.AST], path: Path) -> set[str]:
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


def floors(package: str) -> dict[str, int]:
    """The floor of each room, the ground floor 1."""
    lines = [line.split() for line in FLOORS[package].strip().splitlines()]
    return {f"{package}.{room}": len(lines) - i for i, rooms in enumerate(lines) for room in rooms}


def room_of(module: str, rooms: dict[str, int]) -> str | None:
    """The innermost room that a module is in; None for the package itself."""
    parts = module.split(".")
    for n in range(len(parts), 1, -1):
        if ".".join(parts[:n]) in rooms:
            return ".".join(parts[:n])
    return None


def upward(imports: dict[str, set[str]], rooms: dict[str, int]) -> list[str]:
    """Each import that does not run downward, of modules to what they import."""
    found = []
    for module, others in imports.items():
        room = room_of(module, rooms)
        for other in others & set(imports):
            there = room_of(other, rooms)
            if room and there and there != room and rooms[there] >= rooms[room]:
                found.append(f"{module} imports {other}")
    return sorted(found)


def test_there_is_something_to_check() -> None:
    assert len(modules("kin")) >= 100
    assert len(modules("camgeo")) >= 150


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
def test_every_module_is_in_a_room(package: str) -> None:
    rooms = floors(package)
    known = modules(package)
    assert [m for m in known if room_of(m, rooms) is None] == [package]
    assert not [room for room in rooms if not any(room_of(m, rooms) == room for m in known)], "every room is there"


@pytest.mark.parametrize("package", ["kin", "camgeo"])
def test_imports_run_strictly_downward(package: str) -> None:
    assert not upward({name: imported(path) for name, path in modules(package).items()}, floors(package))


def test_an_upward_import_is_found() -> None:
    rooms = floors("kin")
    planted = {"kin.numeric.newton": {"kin.law.law"}, "kin.law.law": {"kin.numeric.newton"}}
    assert upward(planted, rooms) == ["kin.numeric.newton imports kin.law.law"]
    neighbours = {"kin.law.law": {"kin.contour.arcs"}, "kin.contour.arcs": set()}
    assert upward(neighbours, rooms) == ["kin.law.law imports kin.contour.arcs"]


def circles(imports: dict[str, set[str]]) -> set[str]:
    """Modules that import themselves through others."""
    found = set()
    for module, others in imports.items():
        seen, todo = set(), others & set(imports) - {module}
        while todo:
            seen |= todo
            todo = set().union(*(imports[one] for one in todo)) & set(imports) - seen
        if module in seen:
            found.add(module)
    return found


@pytest.mark.parametrize("package", ["kin", "camgeo"])
def test_no_files_import_one_another_in_a_circle(package: str) -> None:
    packages = {module.rpartition(".")[0] for module in modules(package)}  # importing a file does not import its room's
    assert not circles({module: imported(path) - packages for module, path in modules(package).items()})


def test_a_circle_of_files_is_found() -> None:
    planted = {"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": set(), "e": {"a"}}
    assert circles(planted) == {"b", "c"}, "neither what leads there nor what it leads to"
    assert circles({**planted, "c": {"d"}}) == set()
    source = ROOT / "kin" / "judge" / "verdict.py"  # what it imports for types alone counts
    assert "kin.judge.check" in imported(source) - imported(source, top_level_only=True)


def test_the_core_knows_no_wing() -> None:
    known = modules("camgeo")
    offenders = []
    for module, path in known.items():
        if ".".join(module.split(".")[:2]) in WINGS or module in DOORS or module == "camgeo":  # which imports on demand
            continue
        names = imported(path, top_level_only=module.startswith(("camgeo.output", "camgeo.cli")))
        offenders += [f"{module} imports {n}" for n in names if ".".join(n.split(".")[:2]) in WINGS]
        if module.startswith("camgeo.output"):
            doors = imported(path, top_level_only=True) & DOORS
            offenders += [f"{module} imports {n} before it is asked for" for n in doors]
    assert not offenders


def test_no_room_is_crowded() -> None:
    crowded = {}
    for package in FLOORS:
        for folder in {path.parent for path in modules(package).values()}:
            count = len([f for f in folder.glob("*.py") if f.name != "__init__.py"])
            if count > MOST:
                crowded[str(folder.relative_to(ROOT))] = count
    assert not crowded
