"""The scripts of benchmarks and docs: each tells what it does without doing it, and names only what there is."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from pathlib import Path

import pytest
from support.places import ROOT

SCRIPTS = sorted([*(ROOT / "benchmarks").glob("*.py"), *(ROOT / "docs").glob("make_*.py"), ROOT / "web" / "build.py"])
NAMES = [str(path.relative_to(ROOT)) for path in SCRIPTS]
RUN = [name for name in NAMES if "__main__" in (ROOT / name).read_text(encoding="utf-8")]  # others are only imported


def test_there_are_scripts() -> None:
    assert {"benchmarks/speed.py", "docs/make_gallery.py"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_what_it_imports_is_there(name: str) -> None:
    """Names imported from this project, and those looked up in its modules, wherever they stand."""
    tree = ast.parse((ROOT / name).read_text(encoding="utf-8"))
    modules = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] in {"camgeo", "kin"}:
            source = importlib.import_module(node.module)
            for alias in node.names:
                if not hasattr(source, alias.name):
                    modules[alias.asname or alias.name] = importlib.import_module(f"{node.module}.{alias.name}")
                elif isinstance(getattr(source, alias.name), type(sys)):
                    modules[alias.asname or alias.name] = getattr(source, alias.name)
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            assert hasattr(modules[node.value.id], node.attr), f"{name}:{node.lineno}: {node.value.id}.{node.attr}"


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", ["benchmarks/speed.py", "docs/make_gallery.py", "benchmarks/peer.py"])
def test_help(name: str, tmp_path: Path) -> None:
    helped(name, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", RUN)
def test_help_of_all(name: str, tmp_path: Path) -> None:
    helped(name, tmp_path)


def helped(name: str, folder: Path) -> None:
    before = written()
    done = subprocess.run(
        [sys.executable, str(ROOT / name), "--help"], capture_output=True, text=True, check=False, cwd=folder
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(f"usage: {Path(name).name}")
    assert written() == before


def written() -> dict[Path, int]:
    """When each page and picture was written."""
    files = [path for path in (ROOT / "docs").rglob("*") if path.suffix in {".md", ".svg", ".png"}]
    return {path: path.stat().st_mtime_ns for path in files}


def test_no_extra_is_promised_from_an_index() -> None:
    """`pip install camgeo[...]` finds nothing: the package is installed from a clone."""
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "camgeo").rglob("*.py")]
    lines = [line for path in pages for line in path.read_text(encoding="utf-8").splitlines()]
    assert [line for line in lines if "install" in line and "camgeo[" in line] == []
