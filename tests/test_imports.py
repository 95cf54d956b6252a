"""Imports: the contracts of pyproject.toml catch what they are for."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.places import ROOT

from camgeo.registry import registry

if TYPE_CHECKING:
    from pathlib import Path

LINTED = importlib.util.find_spec("importlinter") is not None
PLANTED = {
    "the core knows no capability": ("camgeo/output/skipped.py", "from camgeo.capabilities.sweep import keys"),
    "kin judges without camgeo": ("kin/judge/verify.py", "from camgeo.version import __version__"),
    "Layers of kin": ("kin/numeric/angles.py", "from kin.law import contacts"),
    "in a circle": ("kin/judge/limits.py", "from kin.judge import closure"),
    "know no other": ("camgeo/capabilities/study/margins.py", "from camgeo.capabilities.sweep import keys"),
}


def test_the_core_names_no_capability_for_types_either() -> None:
    """Only the library's names are those of all."""
    paths = [path for path in (ROOT / "camgeo").rglob("*.py") if "capabilities" not in path.parts]
    named = {path.relative_to(ROOT) for path in paths if "from camgeo.capabilities" in path.read_text(encoding="utf-8")}
    assert {str(path) for path in named} <= {"camgeo/__init__.py"}


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, label in registry.labels().items() if label.kin])
def test_the_judging_half_of_a_capability_is_imported_by_it_alone(name: str) -> None:
    halves = registry.labels()[name].kin
    own = [ROOT / "camgeo" / "capabilities" / name, *(ROOT / "kin" / half for half in halves)]
    imports = re.compile(rf"^\s*(?:from|import) kin\.(?:{'|'.join(halves)})\b", re.MULTILINE)
    paths = [path for top in ("camgeo", "kin") for path in (ROOT / top).rglob("*.py")]
    importing = [path for path in paths if imports.search(path.read_text(encoding="utf-8"))]
    assert importing
    assert [str(path) for path in importing if not any(folder in path.parents for folder in own)] == []


def linted(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run import-linter over the packages in a folder; its words are plain and not wrapped, wherever this runs."""
    code = "from importlinter.cli import lint_imports_command as run; run(['--no-cache'])"
    environment = {
        **os.environ,
        "TERM": "dumb",
        "FORCE_COLOR": "",
        "TTY_COMPATIBLE": "0",
        "COLUMNS": "200",
        "PYTHONUTF8": "1",
    }
    return subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=environment, capture_output=True, encoding="utf-8", check=False
    )


@pytest.mark.slow
@pytest.mark.skipif(not LINTED, reason="needs import-linter, of the extra `dev`")
@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_import_breaks_its_contract(name: str, tmp_path: Path) -> None:
    for package in ("camgeo", "kin"):
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    done = linted(tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    path, line = PLANTED[name]
    with (tmp_path / path).open("a", encoding="utf-8") as stream:
        stream.write(f"\n{line}\n")
    done = linted(tmp_path)
    assert done.returncode == 1, done.stdout + done.stderr
    broken = [row for row in done.stdout.splitlines() if row.strip().endswith("BROKEN") or " BROKEN (" in row]
    assert any(name in row for row in broken), done.stdout
