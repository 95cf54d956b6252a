"""Laws of a followed motion, against contours drawn by formulas of their own: what is found, and what stays a table.

Holds: camgeo.capabilities.follow.laws.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pytest
from support.drawn import polygon

import camgeo
from camgeo.cli.main import main

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from kin.numeric.arrays import Array

STEPS = 90
READING = 0.02
BASE, ROLLER = 40.0, 9.0


def cycloidal(u: Array) -> Array:
    return u - np.sin(2.0 * np.pi * u) / (2.0 * np.pi)


def polynomial(u: Array) -> Array:
    return 10.0 * u**3 - 15.0 * u**4 + 6.0 * u**5


def lift(degrees: Array, late: float = 0.0) -> Array:
    """Up by 12 over 110 degrees, 40 of rest, down over 130, 80 of rest; all of it later by some degrees."""
    at = np.mod(degrees - late, 360.0)
    up, down = np.clip(at / 110.0, 0.0, 1.0), np.clip((at - 150.0) / 130.0, 0.0, 1.0)
    lifted: Array = 12.0 * (cycloidal(up) - polynomial(down))
    return lifted


def outline(motion: Callable[[Array], Array], offset: float = 0.0, count: int = 720) -> Array:
    """Points of the cam of a roller on a stem, whose centre runs on the line that passes the shaft at an offset."""
    t = 2.0 * np.pi * np.arange(count) / count
    least = math.sqrt((BASE + ROLLER) ** 2 - offset**2)

    def centre(t: Array) -> Array:
        centres: Array = (least + motion(np.degrees(t)) + 1j * offset) * np.exp(1j * t)
        return centres

    step = 1e-5
    along = centre(t + step) - centre(t - step)
    metal = centre(t) + 1j * ROLLER * along / np.abs(along)
    return np.column_stack([metal.real, metal.imag])


def followed(folder: Path, motion: Callable[[Array], Array], **options: Any) -> camgeo.Followed:
    path = polygon(folder / "cam.dxf", outline(motion, options.get("offset", 0.0)))
    return camgeo.follow(path, roller=ROLLER, reading=READING, steps=STEPS, **options)


@pytest.mark.costly("all laws are tried on each stroke")
@pytest.mark.thin(2)
@pytest.mark.parametrize("offset", [8.0, 0.0])
def test_laws_that_were_drawn_are_found(tmp_path: Path, offset: float) -> None:
    found = followed(tmp_path, lift, offset=offset)
    assert found.laws.rows == [
        {"rise": 12.0, "over": 110.0, "law": "cycloidal"},
        {"dwell": 40.0},
        {"return": 12.0, "over": 130.0, "law": "polynomial-345"},
        {"dwell": 80.0},
    ]
    assert found.laws.base == BASE
    assert found.laws.off < READING
    (tmp_path / "found.yaml").write_text(found.recipe("found.csv", laws=True), encoding="utf-8")
    recipe = camgeo.load(tmp_path / "found.yaml")  # without its table, which a comment names
    angles = np.linspace(0.0, 2.0 * np.pi, 50)
    np.testing.assert_allclose(camgeo.design(recipe).motion(angles), lift(np.degrees(angles)), atol=1e-9)
    text, (*_, first, second, last) = found.told_recipe("found.csv")
    assert text == found.recipe("found.csv", laws=True)
    assert first.startswith("  stroke 1: 12 +- ")
    assert "cycloidal leaves" in first
    assert "polynomial-345 leaves" in second
    assert last.startswith("  the recipe has these laws, within ")
    assert last.endswith(" mm of the motion, and names the table found.csv beside them")
    assert 'motion: {table: "found.csv", angle: cam, reading: 0.02}' in found.recipe("found.csv", laws=True)
    assert "law" not in found.recipe("found.csv")


@pytest.mark.slow
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_a_turn_that_begins_in_a_stroke_is_told_where_to_begin(tmp_path: Path, rotation: Literal["cw", "ccw"]) -> None:
    """A contour that turns the other way is the mirrored one."""
    path = begins_in_a_stroke(tmp_path, rotation)
    first = camgeo.follow(path, roller=ROLLER, reading=READING, steps=STEPS, rotation=rotation)
    words, _, turn = first.laws.why.rpartition(" to begin elsewhere")[0].partition("; give --turn=")
    assert words == "the turn begins within a stroke"
    again = camgeo.follow(path, roller=ROLLER, reading=READING, steps=STEPS, rotation=rotation, turn=float(turn))
    assert again.laws.rows is not None
    assert [next(iter(row)) for row in again.laws.rows] == ["dwell", "return", "dwell", "rise", "dwell"]
    assert [row["law"] for row in again.laws.rows[1:4:2]] == ["polynomial-345", "cycloidal"]


def begins_in_a_stroke(folder: Path, rotation: str) -> Path:
    points = outline(lambda degrees: lift(degrees, -70.0))
    return polygon(folder / "cam.dxf", points if rotation == "cw" else points * [1.0, -1.0])


@pytest.mark.slow
def test_the_command_says_what_the_recipe_has(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = begins_in_a_stroke(tmp_path, "cw")
    asked = ["follow", str(path), "--roller", "9mm", "--reading", "0.02"]
    assert main([*asked, "--recipe", str(tmp_path / "first.yaml")]) == 0
    told = capsys.readouterr().out.splitlines()[-1]
    assert told.startswith("  the recipe has the motion as the table first.csv: the turn begins within a stroke; give ")
    assert "motion: {table:" in (tmp_path / "first.yaml").read_text(encoding="utf-8")
    turn = next(word for word in told.split() if word.startswith("--turn="))
    assert main([*asked, turn, "--recipe", str(tmp_path / "second.yaml")]) == 0
    *_, stroke, last = capsys.readouterr().out.splitlines()
    assert stroke.startswith("  stroke 2: ")
    assert last.startswith("  the recipe has these laws, within ")
    assert last.endswith(" mm of the motion, and names the table second.csv beside them")


def test_a_motion_of_no_law_stays_a_table(tmp_path: Path) -> None:
    """Two waves of which no stroke is a law's: heights and ends alone cannot make them one."""

    def waves(degrees: Array) -> Array:
        t = np.radians(degrees)
        lifted: Array = 6.0 - 5.0 * np.cos(t) - np.cos(2.0 * t)
        return lifted

    found = followed(tmp_path, waves)
    assert found.laws.rows is None
    assert found.laws.why.startswith("the laws that fit best leave ")
    assert found.recipe("found.csv", laws=True) == found.recipe("found.csv")


def test_a_follower_that_rests_and_one_in_a_yoke_have_no_laws(tmp_path: Path) -> None:
    assert followed(tmp_path, np.zeros_like).laws.why == "there are no strokes between dwells or turning points"
    path = polygon(tmp_path / "round.dxf", outline(np.zeros_like))
    yoke = camgeo.follow(path, flat=True, yoke=True, steps=STEPS)
    assert yoke.laws.why.startswith("a yoke has its motion over half a turn")
