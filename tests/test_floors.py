"""Imports run strictly downward, in both packages, and heavy libraries are not imported at module level."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

# Each module may import only from floors below its own; modules on one line share a floor and do not import each other.
KIN = [
    ["check"],
    ["ball"],
    ["taylor"],
    ["jet"],
]
HEAVY = {"ezdxf", "shapely", "trimesh", "manifold3d", "scipy", "matplotlib", "networkx", "mpmath", "hypothesis"}


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
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module)
            names.update(f"{node.module}.{alias.name}" for alias in node.names)
    return names


def test_there_is_something_to_check() -> None:
    assert len(modules("kin")) >= 10
    assert len(modules("camgeo")) >= 15


def test_kin_never_imports_camgeo() -> None:
    offenders = {name for name, path in modules("kin").items() if any(n.split(".")[0] == "camgeo" for n in imported(path))}
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
def test_imports_have_no_cycle(package: str) -> None:
    known = modules(package)
    below = {name: {n for n in imported(path) if n in known and n != name} for name, path in known.items()}
    done: set[str] = set()
    while len(done) < len(known):
        ready = {name for name, needs in below.items() if name not in done and needs <= done}
        assert ready, f"these import each other in a circle: {sorted(set(known) - done)}"
        done |= ready
