"""Parts for tests: one contour, recipes of what is cut into it, and all that a run finds of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from camgeo.output.dispatch import make
from camgeo.output.job import Job
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.judge.intent import Limits
from kin.judge.verify import verify

CAM = "cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [3, 2]}\n"
EXPORT = "export: {{tolerance: 0.01, files: [{}]}}\nverify: {{angles: 36}}\n"


def recipe_of(part, *, cam=CAM, more="", files=None):
    files = files or ("dxf, stl" if "thickness" in part else "dxf")
    return read(f"{cam}part: {part}\n{EXPORT.format(files)}{more}".encode(), Path("part.yaml"))


def found(recipe):
    """Design of a recipe, and its checks by name."""
    design = designed(recipe)
    return design, {check.name: check for check in design.checks}


def files_of(recipe, folder, *, sound=True):
    """The design, and the path and the verdict's checks by name of each file, by kind."""
    design = designed(recipe)
    assert design.only_surface.contour is not None, [check for check in design.checks if not check.ok]
    made = {}
    for request in recipe.export.files:
        path = folder / request.filename(recipe.name, recipe.export.files)
        _, checks = make(Job.of(recipe, design), request, path)
        if sound:
            assert all(check.ok for check in checks), [check for check in checks if not check.ok]
        made[request.kind] = (path, {check.name: check for check in checks})
    return design, made


def failures(path, recipe, design, tolerance=0.01, **changes):
    """Names of the checks that a file fails; `changes` of the intent."""
    intent = replace(intended(recipe, design), **changes)
    return {check.name for check in verify(path, intent, 36, Limits(tolerance)).checks if not check.ok}


def member_of(assembly, name):
    """The body of an assembly with this name."""
    return next(member for member in assembly.members if member.name == name)
