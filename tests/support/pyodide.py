"""Python as a browser has it, under node: where it is, and scripts that run in it."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from support.places import ROOT, script

INSTALLED = "node_modules/pyodide/pyodide.mjs"


def folder() -> Path:
    """Where `.ci/pyodide` has put it, or is to."""
    return Path(os.environ.get("CAMGEO_PYODIDE", ROOT / ".ci-pyodide"))


def why_not() -> str:
    """Say why nothing can be run in it; empty where something can."""
    if shutil.which("node") is None:
        return "no Python of a browser here: there is no node"
    if not (folder() / INSTALLED).is_file() or not list(folder().glob("numpy-*.whl")):
        return "no Python of a browser here: `.ci/pyodide .ci-pyodide` installs one, CAMGEO_PYODIDE names its folder"
    return ""


def gather(target: Path) -> None:
    """Copy the packages that camgeo needs, without their compiled parts."""
    script("build").gather(target)


def run(script: Path, packages: Path, *arguments: Path) -> subprocess.CompletedProcess[str]:
    """Run a script with camgeo and the packages of a folder; paths of the host begin with /host there."""
    call = ["node", ROOT / "tests/support/pyodide.mjs", folder().resolve(), script]
    paths = {"PYTHONPATH": f"/host{ROOT}:/host{packages}"}
    words = [*map(str, call), *(f"/host{path}" for path in arguments)]
    return subprocess.run(words, env={**os.environ, **paths}, capture_output=True, text=True, check=False)
