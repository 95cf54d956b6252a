"""The scripts of benchmarks and docs: each tells what it does without doing it, and names only what there is."""

from __future__ import annotations

import ast
import importlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from support.places import ROOT

SCRIPTS = sorted(
    [*(ROOT / "benchmarks").glob("*.py"), *(ROOT / "tools" / "docs").glob("make_*.py"), ROOT / "web" / "build.py"]
)
NAMES = [str(path.relative_to(ROOT)) for path in SCRIPTS]
RUN = [name for name in NAMES if "__main__" in (ROOT / name).read_text(encoding="utf-8")]  # others are only imported


def test_there_are_scripts() -> None:
    assert {"benchmarks/speed.py", "tools/docs/make_gallery.py"} <= set(NAMES)


@pytest.mark.slow
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
@pytest.mark.parametrize("name", ["benchmarks/speed.py", "tools/docs/make_gallery.py", "benchmarks/peer.py"])
def test_help(name: str, tmp_path: Path) -> None:
    helped(name, tmp_path)


HELP_OF_ALL = """
import contextlib, io, json, os, runpy, sys
begin, told = {*sys.modules}, {}
for name in sys.argv[1:]:
    for other in [other for other in sys.modules if other not in begin and not other.startswith(("camgeo", "kin"))]:
        path = getattr(sys.modules[other], "__file__", None) or ""
        if path.startswith(tuple(os.environ["NEIGHBOURS"].split(os.pathsep))):
            del sys.modules[other]  # a script's neighbour, of which another folder has a namesake
    sys.argv, sys.path[0] = [name, "--help"], os.path.dirname(name)
    out, err, status = io.StringIO(), io.StringIO(), None
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            runpy.run_path(name, run_name="__main__")
        except SystemExit as end:
            status = end.code or 0
    told[name] = status, err.getvalue(), out.getvalue()
print(json.dumps(told))
"""


@pytest.mark.slow
def test_help_of_all(tmp_path: Path) -> None:
    before = written()
    command = [sys.executable, "-c", HELP_OF_ALL, *(str(ROOT / name) for name in RUN)]
    # an environment may stand in the root: its packages are no neighbours
    folders = {str((ROOT / name).parent) + os.sep for name in RUN}
    surroundings = {**os.environ, "NEIGHBOURS": os.pathsep.join(sorted(folders))}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=surroundings)
    assert (done.returncode, done.stderr) == (0, "")
    told = json.loads(done.stdout)
    for name in RUN:
        status, errors, shown = told[str(ROOT / name)]
        assert (name, status, errors) == (name, 0, "")
        assert shown.startswith(f"usage: {Path(name).name}")
    assert written() == before


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
