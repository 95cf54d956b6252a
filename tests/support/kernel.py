"""STEP files by Open CASCADE, where it is installed."""

import importlib.util
from pathlib import Path

import pytest

from camgeo.recipe.loading import read
from support.parts import CAM, files_of

kernel = pytest.mark.skipif(importlib.util.find_spec("OCP") is None, reason="needs Open CASCADE: pip install '.[step]'")


def step_recipe(part, files="step", more="", cam=CAM):
    export = f"export: {{tolerance: 0.001, files: [{files}]}}\nverify: {{angles: 36}}\n"
    return read(f"{cam}part: {part}\n{export}{more}".encode(), Path("part.yaml"))


def made(recipe, folder):
    design, files = files_of(recipe, folder)
    return design, files["step"][0]
