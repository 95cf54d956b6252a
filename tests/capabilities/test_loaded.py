"""What a run imports of the capabilities: their labels, and all else only of those that its recipe uses."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.places import ROOT

from camgeo.registry import registry

if TYPE_CHECKING:
    from pathlib import Path

CAM = "cam: {kind: support, p: 25 + 2*cos(3*t)}\n"
RECIPES = {
    "stl": (CAM + "part: {thickness: 8, bore: 10}\nexport: {files: [stl]}\n", ()),
    "dxf": (CAM + "limits: {size: {at_most: 40}}\nexport: {files: [dxf]}\n", ()),
    # needs: dynamics
    "dynamics": (CAM + "export: {files: [dxf]}\ndynamics: {mass: 0.4, preload: 150, rpm: 300}\n", ("dynamics",)),
}


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", RECIPES)
def test_a_run_imports_the_capabilities_that_its_recipe_uses(name: str, tmp_path: Path) -> None:
    text, used = RECIPES[name]
    path = tmp_path / "cam.yaml"
    path.write_text(text, encoding="utf-8")
    words = ["export", str(path), "--out", str(tmp_path)]
    code = f"import sys; from camgeo.cli.main import main; assert main({words!r}) == 0; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    inside = {
        module.split(".")[2]
        for module in done.stdout.split()
        if module.startswith(f"{registry.PACKAGE}.") and module.count(".") > 2
    }
    assert inside == {*used}
