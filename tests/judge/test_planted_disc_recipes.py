"""Faults planted between a disc cam's recipe and its file, and the file judged as `camgeo verify` does."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.brute_disc import Touching, motion
from support.heavy import ezdxf

from camgeo.output import pipeline
from camgeo.recipe.loading import load

if TYPE_CHECKING:
    from pathlib import Path

BASE = 40.0
EXPORT = "export: {tolerance: 0.0001, files: [dxf]}\n"
ROWS = [(8.0, 110.0, "cycloidal"), (0.0, 50.0, ""), (-8.0, 120.0, "polynomial-345"), (0.0, 80.0, "")]
FOLLOWERS = {
    "roller": Touching("roller", 9.0, 6.0),
    "knife edge": Touching("knife-edge"),
    "shoe": Touching("shoe", 60.0),
    "flat": Touching("flat"),
    "flat, tilted": Touching("flat", tilt=math.radians(8.0)),
    "trailing arm": Touching("roller", 8.0, pivot=80.0, length=65.0, sense=1),
    "leading arm": Touching("roller", 8.0, pivot=80.0, length=65.0, sense=-1),
    "trailing face": Touching("flat", offset=10.0, pivot=90.0, sense=1),
    "ring": Touching("roller", 8.0, ring=True),
}


def written(folder: Path, touching: Touching, rows: list[tuple[float, float, str]] = ROWS) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "cam.yaml").write_text(touching.recipe(BASE, rows, EXPORT))
    return folder / "cam.yaml"


def exported(recipe: Path) -> Path:
    outcome = pipeline.export(load(recipe), recipe.parent / "out")
    assert outcome.ok
    return recipe.parent / "out" / "cam" / "cam.dxf"


def failures(recipe: Path, drawing: Path) -> set[str]:
    report = pipeline.judge_files(load(recipe), [drawing])
    return {check["name"] for check in report["checks"] if not check["ok"]}


@pytest.mark.thin(12)
@pytest.mark.parametrize("name", FOLLOWERS)
def test_a_drawing_turned_by_two_hundredths_of_a_degree(tmp_path: Path, name: str) -> None:
    recipe = written(tmp_path, FOLLOWERS[name])
    drawing = exported(recipe)
    assert failures(recipe, drawing) == set()
    document = ezdxf.readfile(drawing)
    for entity in document.modelspace():
        entity.rotate_z(math.radians(0.02))
    document.saveas(drawing)
    assert failures(recipe, drawing) == {"contour", "motion"}


@pytest.mark.slow
def test_a_table_of_cam_degrees_read_as_crank_degrees(tmp_path: Path) -> None:
    """The lift of two turns of the crank, and the cam of whoever took its angle for the cam's own."""
    once = np.arange(0.0, 360.0)
    lifts = motion(ROWS, once)
    (tmp_path / "cam.csv").write_text(
        "".join(f"{angle:g},{lift:.4f}\n" for angle, lift in zip(once, lifts, strict=True))
    )
    crank = 2.0 * once
    (tmp_path / "crank.csv").write_text(
        "".join(f"{angle:g},{lift:.4f}\n" for angle, lift in zip(crank, lifts, strict=True))
    )
    twice = motion(ROWS, 2.0 * once)
    (tmp_path / "mistaken.csv").write_text(
        "".join(f"{angle:g},{lift:.4f}\n" for angle, lift in zip(once, twice, strict=True))
    )
    tables = {
        "cam": "table: cam.csv",
        "crank": "table: crank.csv, angle: crank",
        "mistaken": "table: mistaken.csv",
    }
    for name, table in tables.items():
        text = f"cam: {{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 9}}, motion: {{{table}}}}}\n"
        (tmp_path / f"{name}.yaml").write_text(f"name: cam\n{text}{EXPORT}")
    meant = tmp_path / "crank.yaml"
    assert failures(meant, exported(tmp_path / "cam.yaml")) == set()
    assert failures(meant, exported(tmp_path / "mistaken.yaml")) == {"contour", "motion"}


@pytest.mark.slow
@pytest.mark.parametrize("name", FOLLOWERS)
def test_a_motion_of_crank_degrees_on_the_cam(tmp_path: Path, name: str) -> None:
    recipe = written(tmp_path / "meant", FOLLOWERS[name])
    by_crank = [(by / 4, over / 2, law) for by, over, law in ROWS]  # lower, so that none undercuts
    meant = written(tmp_path / "quarter", FOLLOWERS[name], [(by / 4, over, law) for by, over, law in ROWS])
    drawing = exported(written(tmp_path / "crank", FOLLOWERS[name], by_crank * 2))
    assert failures(meant, drawing) == {"contour", "motion"}
    assert failures(recipe, drawing) == {"contour", "motion"}
