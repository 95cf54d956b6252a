"""What every family must have beside its file: the tables that hang on its arrangement, and its place in the docs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.places import ROOT

from camgeo.assembly.build import BODIES
from camgeo.cams.families import FAMILIES
from camgeo.checks.declared import CHECKS
from camgeo.recipe.cam import MADE as SAID
from camgeo.recipe.loading import load
from camgeo.report.page.content import DRAWN
from camgeo.synthesis.checks import MADE as CHECKED

if TYPE_CHECKING:
    from pathlib import Path

SHIPPED = sorted((ROOT / "recipes").glob("*.yaml"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_follower_is_drawn_and_its_checks_are_made(path: Path) -> None:
    recipe = load(path)
    follower = recipe.cam.follower(recipe.cam.intent(), framed=recipe.linkage is not None)
    assert follower.arrangement in DRAWN
    assert set(follower.checks) <= set(CHECKED) <= set(CHECKS)
    assert follower.closure in {"", *CHECKS}
    assert follower.arrangement in BODIES


@pytest.mark.parametrize("kind", FAMILIES)
def test_a_family_is_told_of(kind: str) -> None:
    assert FAMILIES[kind].kind == kind
    assert f"({kind}" in SAID or f", {kind})" in SAID
    assert f"`{kind}`" in (ROOT / "docs" / "which-cam.md").read_text(encoding="utf-8")
