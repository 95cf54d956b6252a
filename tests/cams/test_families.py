"""What every family must have beside its file: the tables that hang on its arrangement, and its place in the docs."""

from __future__ import annotations

import pickle
import subprocess
import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.places import ROOT

from camgeo.cams.families import FAMILIES
from camgeo.capabilities.mechanism.making import BODIES  # needs: mechanism
from camgeo.checks.declared import CHECKS
from camgeo.recipe.cam import MADE as SAID
from camgeo.recipe.loading import load
from camgeo.report.page.content import DRAWN
from camgeo.synthesis.checks import MADE as CHECKED

if TYPE_CHECKING:
    from pathlib import Path

SHIPPED = sorted((ROOT / "recipes").glob("*.yaml"))


@pytest.mark.thin(3)
@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_follower_is_drawn_and_its_checks_are_made(path: Path) -> None:
    recipe = load(path)
    exact = recipe.cam.exact(framed=recipe.linkage is not None)
    follower = exact.follower
    assert follower.arrangement in DRAWN
    assert set(follower.checks) <= {*CHECKED, *exact.proofs} <= set(CHECKS)
    assert follower.closure in {"", *CHECKS}
    # sets of printed bodies round two discs are refused by name
    # needs: mechanism
    assert (follower.arrangement in BODIES) == (follower.arrangement.discs == 1)


@pytest.mark.parametrize("kind", FAMILIES)
def test_a_family_is_told_of(kind: str) -> None:
    assert FAMILIES[kind].kind == kind
    assert f"({kind}" in SAID or f", {kind})" in SAID
    assert f"`{kind}`" in (ROOT / "docs" / "which-cam.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_list_of_families_imports_none_of_them() -> None:
    code = (
        "import sys; from camgeo.cams.families import FAMILIES; from camgeo.recipe.cam import CAMS\n"
        "assert list(CAMS) == list(FAMILIES) and 'disc' in CAMS and 'groove' not in CAMS\n"
        "assert not {f'camgeo.cams.{kind}'.replace('-', '_') for kind in FAMILIES} & set(sys.modules)\n"
        "assert CAMS['disc'] is FAMILIES['disc'].table and CAMS.get('groove') is None\n"
        "print({f'camgeo.cams.{kind}'.replace('-', '_') for kind in FAMILIES} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "{'camgeo.cams.disc'}\n"


EACH = (
    "as-figure-1",
    "print-constant-diameter",  # needs: mechanism
    "disc-arm-flat",
    "disc-flat",
    "disc-ring",  # needs: milling
    "disc-roller",
    "w-ellipse",
    "w-booth",
    "shu-wu",
)


@pytest.mark.parametrize("name", EACH)
def test_an_exact_cam_goes_to_another_process(name: str) -> None:
    exact = load(ROOT / "recipes" / f"{name}.yaml").cam.exact()
    same = pickle.loads(pickle.dumps(exact))
    t = np.linspace(0.0, 1.0, 7)
    assert (same.surfaces[0].pressure(t) == exact.surfaces[0].pressure(t)).all()
    assert same.surfaces[0].curve.sample(t).point == pytest.approx(exact.surfaces[0].curve.sample(t).point, abs=0.0)
    assert same.follower == exact.follower
    assert pickle.dumps(exact.surfaces[0])
