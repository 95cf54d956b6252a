"""The starter of a whole toy makes every body of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.heavy import trimesh

import camgeo
from camgeo.recipe.starter import starter

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.slow
def test_a_toy_is_made_whole(tmp_path: Path) -> None:
    report = camgeo.export(camgeo.load(starter("toy-set")), tmp_path)
    assert report.ok
    (path,) = report.path.glob("*-parts.3mf")
    bodies = trimesh.load(path).geometry
    assert sorted(bodies) == ["base", "cam", "cap-right", "follower", "retainer-shaft", "shaft"]
    assert all(body.is_watertight for body in bodies.values())
