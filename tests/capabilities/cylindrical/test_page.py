"""The page of a cylindrical cam: what it draws is where brute force has it, and its script draws the same.

Holds: camgeo.capabilities.cylindrical.shells, camgeo.capabilities.cylindrical.turning,
camgeo.capabilities.cylindrical.charts.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import (
    CONE,
    GROOVE,
    RIB,
    RIB_ON_ARM,
    TOP,
    UNDERCUT,
    changed,
    design_of,
    shared_design,
)
from capabilities.cylindrical.positions import Lift, envelope
from capabilities.cylindrical.wound_drums import SCREW, SCREW_ROWS, SPIRAL, Pins
from support.browser import Browser, executable

import camgeo
from camgeo.capabilities.cylindrical.charts import development, pressure_map
from camgeo.capabilities.cylindrical.shells import near, shell
from camgeo.capabilities.cylindrical.turning import scene

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign

LIFT = Lift([("rise", 40, 120, "cycloidal"), ("dwell", 0, 60, ""), ("return", 40, 120, "polynomial-345")])
SMALL = Lift([("rise", 15, 60, "cycloidal"), ("dwell", 0, 120, ""), ("return", 15, 60, "cycloidal")])
CCW = changed(GROOVE, ("cam:\n", "rotation: ccw\ncam:\n"))


ON_ARM = Lift(
    [("rise", 30, 120, "cycloidal"), ("dwell", 0, 60, ""), ("return", 30, 120, "polynomial-345")],
    arm=(80.0, 78.0, 80.0 * math.sin(math.radians(15.0)), 1),
)


@pytest.mark.thin(2)
@pytest.mark.parametrize(("head", "sign"), [("", 1.0), ("rotation: ccw\n", -1.0)])
def test_rollers_of_an_arm_are_where_it_leads_them(head: str, sign: float) -> None:
    """Both of a rib, on one body; to the right of the viewer y counts, or -y of a drum that turns the other way."""
    bodies = {body.name: body for body in scene(design_of(head + RIB_ON_ARM)).bodies}
    for step in (0, 150, 500):
        theta = np.array([math.radians(0.5 * step)])
        for half, shape in zip((-18.0, 18.0), bodies["rollers"].shapes, strict=True):
            points = bodies["rollers"].placed(shape.rings[0].flattened(), step)
            y, z = ON_ARM.second(half).place(theta)
            wanted = sign * y[0], z[0] + 60.0 - 80.0 * math.sin(math.radians(15.0))
            np.testing.assert_allclose(0.5 * (points.min(axis=0) + points.max(axis=0)), wanted, atol=2e-3)
            np.testing.assert_allclose(np.ptp(points, axis=0), 20.0, atol=4e-3)


def edges(design: DrumDesign, radius: float, turn: float) -> tuple[np.ndarray, np.ndarray]:
    """Places to the right, and heights there, of the lower flank on a cylinder as it is seen."""
    outline = near(shell(design, radius), turn)[0]
    return tuple(outline[len(outline) // 2 :].T)


@pytest.mark.parametrize(("text", "sign"), [(GROOVE, 1.0), (CCW, -1.0)])
def test_the_drum_is_seen_turned(text: str, sign: float) -> None:
    """At a shaft angle of 75 degrees a place x to the right has the polar angle 75 degrees and asin(x/r)."""
    theta = math.radians(75.0)
    x, z = edges(design_of(text), 50.0, sign * theta)
    phi = theta + sign * np.arcsin(np.clip(x / 50.0, -1.0, 1.0))
    wanted = 20.0 + envelope(LIFT, -1, 10.0, np.full_like(x, 50.0), phi)[0]
    np.testing.assert_allclose(z, wanted, atol=0.02)
    assert np.ptp(z) > 30.0


@pytest.mark.costly("what is cut away of a drum is sought on many cylinders")
def test_a_drum_is_shown_without_what_is_cut_away() -> None:
    design = shared_design(UNDERCUT)
    x, z = edges(design, 22.0, 0.9)
    phi = 0.9 + np.arcsin(np.clip(x / 22.0, -1.0, 1.0))
    wanted = 25.0 + envelope(SMALL, -1, 12.0, np.full_like(x, 22.0), phi)[0]
    np.testing.assert_allclose(z, wanted, atol=0.03)
    assert 'class="line lost"' in development(design)
    assert "<title>undercut</title>" in pressure_map(design)


@pytest.mark.slow
def test_a_screw_is_shown_with_the_metal_between_its_tracks() -> None:
    """On the blank a place is metal where no pin has been; the development has all tracks, and a ring a crossing."""
    design = design_of(SCREW)
    pins, radius, turn = Pins(SCREW_ROWS, 5.0), 29.0, 0.7
    outlines = near(shell(design, radius), turn)
    psi = np.linspace(-1.4, 1.4, 57)
    for at, z in ((at, z) for at in psi.tolist() for z in np.linspace(1.0, design.recipe.height - 1.0, 60).tolist()):
        x, phi = radius * math.sin(at), at + turn
        place = np.array([[radius * math.cos(phi), radius * math.sin(phi), z]])
        away = float(pins.away(place, design.recipe.level).min())
        if abs(away) > 0.25:
            assert (away > 0.0) == any(encloses(outline, x, z) for outline in outlines), (at, z)
    drawn = development(design)
    assert drawn.count('class="crossing"') == 5
    assert drawn.count('class="line"') == 2 * 6


def encloses(outline: np.ndarray, x: float, z: float) -> bool:
    """Whether a place lies within a closed outline, by the edges to one side of it."""
    (x0, z0), (x1, z1) = outline.T, np.roll(outline, -1, axis=0).T
    over = (x0 <= x) != (x1 <= x)
    share = (x - x0[over]) / (x1[over] - x0[over])
    return bool(np.count_nonzero(z0[over] + share * (z1[over] - z0[over]) > z) % 2)


def numbers(path: str) -> np.ndarray:
    return np.array(re.findall(r"-?[\d.]+", path), dtype=float).reshape(-1, 2)


def test_places_of_the_development() -> None:
    """Px by hand: 364 px are the turn of 314.159 mm; at 30 degrees a cycloid has risen by 40 (1/4 - 1/(2 pi))."""
    drawn = development(design_of(GROOVE))
    (path,) = re.findall(r'class="line pitch" d="([^"]+)"', drawn)
    x, y = numbers(path)[30]
    scale = 364.0 / (100.0 * math.pi)
    z = 20.0 + 40.0 * (0.25 - 1.0 / (2.0 * math.pi))
    assert [x, y] == pytest.approx([46.0 + 364.0 / 12.0, 8.0 + scale * (80.0 - z)], abs=0.0501)
    assert "line lost" not in drawn


def test_cells_of_the_map() -> None:
    """By hand: at 40 degrees S' = 60/pi (1 - cos 120) = 28.65 mm, so 36.5 degrees at 38.7 and 30.7 at 48.3 mm."""
    drawn = pressure_map(design_of(GROOVE))
    shown = {}
    for path, title in re.findall(r'class="cell[^"]*" [^>]*d="([^"]+)"><title>([^<]+)', drawn):
        for run in re.findall(r"M([\d.]+) ([\d.]+)h([\d.]+)v", path):
            x, y, wide = map(float, run)
            shown.update(
                {
                    (round((x - 46.0) * 180 / 364) + k, round((y - 8.0) * 16 / 150)): title
                    for k in range(round(wide * 180 / 364))
                }
            )
    slope = 60.0 / math.pi
    for degrees, row in ((21, 8), (41, 15), (41, 0), (59, 15), (59, 2), (101, 5)):
        v = slope * (1.0 - math.cos(3.0 * math.radians(degrees)))
        angle = math.degrees(math.atan2(v, 49.0 - (row + 0.5) * 11.0 / 16.0))
        low = 10 * int(angle / 10.0)
        assert shown[degrees // 2, row] == f"{low}° to {low + 10}°"
    assert ">45.15°</text>" in drawn
    assert 'cx="106.7" cy="158.0"' in drawn  # at 60 degrees, 38 mm


def test_cells_above_a_limit() -> None:
    limited = changed(GROOVE, ("export:", "limits: {pressure-angle: {at_most: 46}}\nexport:"))
    assert "cell over" not in pressure_map(design_of(limited))
    assert "cell over" in pressure_map(design_of(limited.replace("at_most: 46", "at_most: 44")))


@pytest.mark.costly("a page with the drum on six cylinders")
def test_a_page_shows_drum_and_map_and_asks_for_nothing(tmp_path: Path) -> None:
    (tmp_path / "drum.yaml").write_text(changed(TOP, ("[stl]", "[html]")), encoding="utf-8")
    assert camgeo.export(tmp_path / "drum.yaml", tmp_path / "out").ok
    text = (tmp_path / "out" / "drum" / "drum.html").read_text("utf-8")
    steepest = math.degrees(math.atan(2 * 40 / math.radians(120) / 38))  # a cycloidal rise at the inner end
    assert f"{steepest:.2f}" in text
    assert '<section aria-labelledby="figures-head">' in text
    assert not re.search(r'(?:src|href)="(?!#|data:)[^"]*//', text)


@pytest.mark.slow
@pytest.mark.skipif(executable() is None, reason="no browser")
@pytest.mark.parametrize("text", [GROOVE, RIB, CCW, UNDERCUT, RIB_ON_ARM, CONE, SCREW, SPIRAL])
def test_the_script_draws_the_same(tmp_path: Path, text: str) -> None:
    """At an angle between the values that a page has, and at one of them."""
    text = text.replace("files: [stl]", "files: [html]")
    (tmp_path / "drum.yaml").write_text(text, encoding="utf-8")
    page = camgeo.export(tmp_path / "drum.yaml", tmp_path).files[-1].path
    turns = design_of(text).recipe.turns
    with Browser(tmp_path / "profile") as browser:
        for step in (0, 150, 301):
            browser.open(page.as_uri() + f"#deg={0.5 * step * turns}")
            ask = '[...document.querySelectorAll("#drawing .drum path")].map((p) => p.getAttribute("d"))'
            found = browser.ask(ask)
            bodies = scene(design_of(text), step).bodies
            arcs = [body.shapes[0].rings[0].points for body in bodies if body.kind == "contacts"]
            drawn = browser.ask(
                '[...document.querySelectorAll("#drawing .contacts path")].map((p) => p.getAttribute("d"))'
            )
            np.testing.assert_allclose(numbers("".join(drawn)), np.concatenate(arcs), atol=0.01)
            wanted = bodies[0].shapes
            for path, shape in zip(found, wanted, strict=True):
                outlines = np.concatenate([ring.points for ring in shape.rings])
                if shape.role != "fixed":
                    np.testing.assert_allclose(numbers(path), outlines, atol=0.01)
        assert not browser.problems
        assert not [each for each in browser.requests if not each.startswith("file:")]
