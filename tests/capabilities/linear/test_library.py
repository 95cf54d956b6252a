"""The design of a linear cam as an object: its figures under a drive and a load, motion, flanks, remedies, pictures.

Holds: camgeo.capabilities.linear.library, camgeo.capabilities.linear.figures, camgeo.capabilities.linear.making,
camgeo.capabilities.linear.program.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from capabilities.linear.plates import GROOVE, PLATE, changed

import camgeo
from camgeo.testing import assert_recipe

if TYPE_CHECKING:
    from pathlib import Path

CRANKED = changed(PLATE, ("  ends:", "  drive: {crank: {radius: 60, rod: 180, rpm: 90}, load: 200}\n  ends:"))


def cam(folder: Path, text: str) -> Any:
    (folder / "plate.yaml").write_text(text, encoding="utf-8")
    return camgeo.design(folder / "plate.yaml")


def test_a_crank_moves_the_follower_as_differences_of_its_places_say(tmp_path: Path) -> None:
    """A turn of the crank in equal steps; the lift at each place, and its differences by time."""
    plate = cam(tmp_path, CRANKED)
    q, step = np.linspace(0.0, math.pi, 20_001, retstep=True)
    travel = 240.0 - (60.0 * np.cos(q) + np.sqrt(180.0**2 - (60.0 * np.sin(q)) ** 2))
    lift, rate = plate.motion(np.clip(travel, 0.0, 120.0)), 90.0 * 2.0 * math.pi / 60.0 / step
    velocity = np.abs(np.diff(lift)) * rate
    acceleration = np.abs(np.diff(lift, 2)) * rate**2
    assert plate.figures["velocity"].value == pytest.approx(velocity.max(), rel=1e-6)
    assert plate.figures["acceleration"].value == pytest.approx(acceleration.max(), rel=2e-3)
    assert travel[int(velocity.argmax())] == pytest.approx(plate.figures["velocity"].at, abs=0.05)


def test_forces_and_pressure_of_a_load(tmp_path: Path) -> None:
    text = changed(CRANKED, ("load: 200", "load: 200, material: steel"))
    plate = cam(tmp_path, text)
    steepest = math.atan(40.0 / 50.0), math.atan(1.875 * 20.0 / 40.0)  # cycloidal 2 h/L, 3-4-5 15/8 h/L
    assert plate.figures["contact-force"].value == pytest.approx(200.0 / math.cos(max(steepest)), rel=1e-9)
    assert plate.figures["drive-force"].value == pytest.approx(200.0 * math.tan(max(steepest)), rel=1e-9)
    # Hertz, two bodies of steel of one modulus: p = sqrt(F E* K/(pi b)), E* = E/(2 (1 - nu^2))
    x = np.linspace(10.0, 120.0, 200_001)
    slope, bend = (plate.motion(x, derivative=order) for order in (1, 2))
    speed = np.sqrt(1.0 + slope**2)
    pitch = -bend / speed**3  # curvature of the pitch curve, above 0 at a crest
    with np.errstate(divide="ignore"):
        flank = 1.0 / (1.0 / pitch - 8.0)
    squares = 200.0 * speed * (1.0 / 8.0 + flank)
    told = plate.figures["contact-pressure"].value
    modulus = told**2 * math.pi * 12.0 / squares.max()
    assert modulus == pytest.approx(0.5 * 206e3 / (1.0 - 0.3**2), rel=0.03)  # of any steel


def test_motion_and_flanks_of_a_groove(tmp_path: Path) -> None:
    plate = cam(tmp_path, GROOVE)
    assert plate.motion(np.array([35.0, 60.0])) == pytest.approx([10.0, 20.0])
    assert plate.flank([35.0])[0] == pytest.approx([39.9975603804, 43.7530495245], abs=1e-9)  # l01
    assert np.hypot(*(plate.flank([35.0], upper=True) - plate.flank([35.0]))[0]) == pytest.approx(16.05, abs=1e-9)
    assert plate.travel == 120.0
    for call, told in (
        (lambda: plate.motion(121.0), r"places of the travel are from 0 to 120 mm"),
        (lambda: plate.motion(1.0, derivative=7), r"a derivative is one of order 0 to 6, not 7"),
        (lambda: cam(tmp_path, PLATE).flank([1.0], upper=True), r"only a groove has an upper flank"),
    ):
        with pytest.raises(camgeo.CallError, match=told):
            call()


def test_places_of_figures_are_in_the_unit_of_the_recipe(tmp_path: Path) -> None:
    plate = cam(tmp_path, changed("units: inch\n" + PLATE, ("base: 32", "base: 1.25"), ("overrun: 6", "overrun: 0.25")))
    steepest = plate.figures["pressure-angle"]
    assert steepest.at_unit == "in"
    assert plate.travel == pytest.approx(120 * 25.4)
    assert abs(plate.motion(25.4 * steepest.at, derivative=1)) == pytest.approx(math.tan(math.radians(steepest.value)))


def test_it_shows_itself(tmp_path: Path) -> None:
    plate = cam(tmp_path, PLATE)
    assert str(plate) == "plate: ok"
    assert "'plate'" in repr(plate)
    assert plate._repr_svg_().startswith("<svg")
    assert "pressure-angle" in plate._repr_html_()


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("limit", "remedy"),
    [
        ("pressure-angle: {at_most: 30}", r"sizing: \{pressure-angle: \{at_most: 30\}\} under cam"),
        ("radius-of-curvature: {at_least: 12}", r"a follower\.radius smaller by 3\.7753\d* mm, or a longer motion"),
        ("radius-of-curvature: {at_least: 20}", r"remedy +a longer motion\n"),
        ("velocity: {at_most: 100}", r"a speed of [0-9.]+ percent"),
        ("acceleration: {at_most: 1000}", r"a speed of [0-9.]+ percent"),
        ("contact-force: {at_most: 220}", r"a load of [0-9.]+ percent"),
    ],
)
def test_a_limit_that_is_missed_has_a_remedy(tmp_path: Path, limit: str, remedy: str) -> None:
    plate = cam(tmp_path, f"{CRANKED}limits: {{{limit}}}\n")
    assert [check.ok for check in plate.checks].count(False) == 1
    with pytest.raises(AssertionError, match=remedy):
        assert_recipe(tmp_path / "plate.yaml")


@pytest.mark.costly("four files, each judged")
def test_every_mesh_and_a_program_of_a_groove(tmp_path: Path) -> None:
    text = changed(GROOVE, ("files: [dxf]", "files: [ply, 3mf, glb, gcode], tolerance: 0.02"))
    text += "manufacture: {cutter: 12, feed: 400, plunge: 99, spindle: 4e3, depth_of_cut: 3, safe_height: 5}\n"
    (tmp_path / "plate.yaml").write_text(text, encoding="utf-8")
    report = camgeo.export(tmp_path / "plate.yaml", tmp_path / "out")
    assert report.ok, str(report)
    assert sorted(file["path"].rpartition(".")[2] for file in report["files"]) == ["3mf", "glb", "ngc", "ply"]
