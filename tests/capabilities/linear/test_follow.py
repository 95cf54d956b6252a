# needs: follow
"""The motion of a plate of unknown origin: `camgeo follow --linear`.

Holds: camgeo.capabilities.linear.follow, camgeo.capabilities.follow.extension.
"""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import ezdxf
import numpy as np
import pytest
from capabilities.linear.plates import MOTION, ON_ARM, PLATE, changed

import camgeo
from camgeo.cli.main import main

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def wedge(tmp_path: Path) -> str:
    """A wedge of a slope of 1/4 between two levels, 40 and 60 high: its lift is known by hand."""
    rows = [(0, 0), (160, 0), (160, 60), (120, 60), (40, 40), (0, 40)]
    drawing = ezdxf.new(units=4)
    drawing.modelspace().add_lwpolyline(rows, close=True)
    drawing.saveas(tmp_path / "wedge.dxf")
    return str(tmp_path / "wedge.dxf")


def test_a_knife_edge_reads_the_outline_off(wedge: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "wedge.csv"
    assert main(["follow", wedge, "--linear", "10,150", "--roller", "0", "--json", "--table", str(table)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["lift"], told["least"]["position"]) == (pytest.approx(20.0), pytest.approx(40.0))
    first, second = told["dwells"]
    assert [first["from"], first["to"], second["to"]] == pytest.approx([10.0, 40.0, 150.0], abs=0.5)
    rows = [row.split(",") for row in table.read_text("utf-8").splitlines()[1:]]
    at_80 = next(row for row in rows if abs(float(row[0]) - 80.0) < 0.1)
    assert float(at_80[1]) == pytest.approx(40.0 + (float(at_80[0]) - 40.0) / 4.0)
    assert float(at_80[2]) == pytest.approx(0.25)


def test_the_library_follows_a_plate(wedge: str) -> None:
    followed = camgeo.follow(wedge, linear=(10, 150), roller=0)
    assert followed.unit == "mm"
    assert [followed.position[0], followed.position[-1]] == pytest.approx([40.0, 60.0])
    with pytest.raises(camgeo.CallError, match="lean goes with linear: give both, or leave lean out"):
        camgeo.follow(wedge, roller=0, lean=5)
    with pytest.raises(TypeError, match="linear must be a tuple of numbers, not str"):
        camgeo.follow(wedge, linear="10,150", roller=0)
    with pytest.raises(camgeo.CallError, match="no page is made of a plate"):
        followed.page()


def test_a_plate_that_is_followed_as_a_disc_is_told_the_option(wedge: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["follow", wedge, "--roller", "0"]) == 2
    option = capsys.readouterr().err.rpartition("over its travel: ")[2].split()
    assert option == ["--linear", "0,120"]
    assert main(["follow", wedge, "--roller", "0", *option]) == 0


def test_an_arm_swings(wedge: str, capsys: pytest.CaptureFixture[str]) -> None:
    """On the level an arm of 30 about a pivot 55 high has its roller of 5 at 45: asin(-1/3)."""
    assert main(["follow", wedge, "--linear", "40,60", "--roller", "5", "--arm", "55,30"]) == 0
    assert "from -19.4712 at 40 mm" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--linear", "9"), "linear takes two inputs in mm"),
        (("--linear", "0,9"), "give --roller with a radius"),
        (("--linear", "0,9", "--roller", "3", "--width", "5"), "leave the other options out"),
        (("--linear", "0,9", "--roller", "3", "--page", "a.html"), "no page is made of a plate"),
        (("--linear", "0,9", "--roller", "3", "--lean", "89"), "a stem leans by up to 80 degrees"),
        (("--linear", "0,999", "--roller", "3"), "the follower touches nothing at input"),
        (("--linear", "9,50", "--roller", "3", "--at", "0,50", "--recipe", "a.yaml"), "give --at with a lower edge"),
        (("--linear", "0,9", "--roller", "3", "--arm", "9"), "height of its pivot and its length"),
    ],
)
def test_wrong_calls(wedge: str, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], told: str) -> None:
    assert main(["follow", wedge, *words]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("cam", "options"),
    [
        (PLATE, ("--roller", "8")),
        (changed(PLATE, ("radius: 8", "radius: 8, lean: 10")), ("--roller", "8", "--lean", "10")),
        (ON_ARM, ("--roller", "8", "--arm", "50,60")),
        (changed(PLATE, (MOTION, "{formula: 4*exp(-x/50) + x/12, over: 90}")), ("--roller", "8")),
    ],
)
def test_a_plates_recipe_makes_the_plate_again(cam: str, options: tuple[str, ...], tmp_path: Path) -> None:
    """The motion that a drawing gives a follower, as a recipe with a table: its plate is that of the drawing."""
    made = tmp_path / "plate.yaml"
    made.write_text(cam.partition("part:")[0] + "export: {tolerance: 0.0005, files: [dxf]}\n", "utf-8")
    assert camgeo.export(made, tmp_path / "out").ok
    first: Any = camgeo.design(camgeo.load(made))
    drawing, found = str(tmp_path / "out" / "plate" / "plate.dxf"), tmp_path / "found.yaml"
    begin = 40.0 * math.tan(first.recipe.follower.lean)  # the guide is followed from y = 0 on
    span = ("--linear", f"{begin:.12g},{begin + first.travel:.12g}")
    assert main(["follow", drawing, *span, *options, "--reading", "0.002", "--recipe", str(found)]) == 0
    again: Any = camgeo.design(camgeo.load(found))
    assert again.travel == pytest.approx(first.travel, rel=1e-9)
    u = np.linspace(0.0, first.travel, 199)
    lever = 60.0 if first.recipe.swings else 1.0
    assert lever * np.abs(again.motion(u) - first.motion(u)).max() < 0.004
    assert again.recipe.base == pytest.approx(first.recipe.base, abs=0.001)
    checks = {check.name: check.ok for check in camgeo.verify(found, drawing).checks}
    assert checks["motion"]
    # beyond ends that move the flank goes on along its tangent, which a reading leaves open
    assert (checks["contour"], checks["ends"]) == (True, True) or "formula" in cam
