"""The capability that CONTRIBUTING.md adds, as it stands there, in a copy of the packages."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.places import ROOT

if TYPE_CHECKING:
    from pathlib import Path

RECIPE = """\
cam: {kind: support, p: 25 + 2*cos(3*t)}
part: {thickness: 8, bore: 10, density: 7850}
export: {tolerance: 0.01, files: [dxf, csv]}
verify: {angles: 90}
"""
ROTOR = RECIPE + "rotor: {flywheel: 1000}\nlimits: {rotor-inertia: {at_least: 1000, at_most: 1100}}\n"


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    code = "import sys; from camgeo.cli.main import main; sys.exit(main(sys.argv[1:]))"
    return subprocess.run([sys.executable, "-c", code, *words], cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the packages, the example among them."""
    folder = tmp_path_factory.mktemp("copy")
    for package in ("camgeo", "kin"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    files = re.findall(r"^```python\n# (camgeo/\S+)\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert len(files) == 3
    for name, code in files:
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(code, encoding="utf-8")
    (folder / "plain.yaml").write_text(RECIPE)
    (folder / "cam.yaml").write_text(ROTOR)
    return folder


@pytest.mark.slow
def test_the_example_works_as_it_stands_there(copy: Path) -> None:
    done = run(copy, "export", "cam.yaml")
    assert done.returncode == 0, done.stderr
    report = json.loads((copy / "out" / "cam" / "report.json").read_text(encoding="utf-8"))
    disc = report["balance"][0]["inertia_kg_mm2"]
    assert report["rotor"] == {"inertia": pytest.approx(1000 + disc), "unit": "kg mm^2"}
    limits = [check for check in report["checks"] if check["name"] == "limit:rotor-inertia"]
    assert [check["limit"] for check in limits] == [1000, 1100]
    assert all(check["ok"] and check["value"] == pytest.approx(1000 + disc) for check in limits)
    assert run(copy, "export", "plain.yaml").returncode == 0
    report = json.loads((copy / "out" / "plain" / "report.json").read_text(encoding="utf-8"))
    assert {"what": "rotor", "why": "rotor is not given"} in report["skipped"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "told"),
    [
        (ROTOR.replace(", density: 7850", ""), "rotor: the inertia of the cam is not known; give part.density"),
        (ROTOR.replace("rotor:", "rotar:"), "rotar: unknown key; did you mean rotor?"),
        (ROTOR.replace("rotor-inertia", "roter-inertia"), "unknown figure; did you mean rotor-inertia?"),
        (ROTOR.replace("flywheel: 1000", "flywheel: 0"), "rotor.flywheel: not above 0"),
    ],
)
def test_its_faults_are_told_with_what_helps(copy: Path, text: str, told: str) -> None:
    (copy / "wrong.yaml").write_text(text)
    done = run(copy, "check", "wrong.yaml")
    assert done.returncode == 2
    assert told in done.stderr
