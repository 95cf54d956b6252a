"""The swing of a frame in a recipe: every source of a motion, and what is refused with its place."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

from camgeo.recipe.loading import load_text, read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from pathlib import Path

LINKAGE = "linkage: {kind: inverted-slider-crank, ground: 100, rocker: 0}\n"
ELSEWHERE = (
    "a.yaml:4:10: cam.swing: needs a linkage of kind inverted-slider-crank; "
    "give linkage: {kind: inverted-slider-crank, ground: 80, rocker: 0}, or motion in its place"
)
SHORT = (
    "a.yaml:4:10: cam.swing: the motion covers 180 degrees of the shaft; let it cover 200, 180 and its net rise of 20: "
    "half a turn of the cam against the frame, the other half is its image"
)


def cam(swing: str, linkage: str = LINKAGE) -> str:
    return f"cam:\n  kind: constant-breadth\n  base_radius: 60\n  swing: {swing}\n{linkage}"


def output(text: str, shaft_deg: list[float], folder: Path | None = None) -> np.ndarray:
    """Swing from where it began, degrees, of the mechanism that a recipe makes."""
    recipe = load_text(text, "a.yaml") if folder is None else read(text.encode(), folder / "a.yaml")
    design = designed(recipe)
    assert design.driven is not None
    mechanism = design.driven.mechanism
    at = mechanism.at(mechanism.relative(np.radians([0.0, *shaft_deg])), 0).output[0]
    return np.degrees(at[1:] - at[0])


def test_segments() -> None:
    swing = "[{rise: 20, over: 140, law: cycloidal}, {dwell: 60}]"
    # 20 (u - sin(2 pi u)/2 pi) at u = 1/2 and 1/4; the way back begins at 200
    found = output(cam(swing), [35.0, 70.0, 140.0, 170.0, 200.0, 360.0])
    assert found == pytest.approx([20 * (0.25 - 1 / (2 * math.pi)), 10.0, 20.0, 20.0, 20.0, 0.0], abs=1e-11)


@pytest.mark.slow
def test_the_way_back_is_the_image() -> None:
    """What stands at (phi, psi) is followed by -psi at phi + 180 - 2 psi, psi from the upright position."""
    swing = "[{rise: 20, over: 140, law: cycloidal}, {dwell: 60}]"
    (there,) = output(cam(swing), [50.0]) - 10.0
    (back,) = output(cam(swing), [50.0 + 180.0 - 2 * there]) - 10.0
    assert back == pytest.approx(-there, abs=1e-11)


def test_a_formula() -> None:
    found = output(cam("{formula: 4*sin(t)**3}"), [30.0, 90.0, 180.0])
    assert found == pytest.approx([0.5, 4.0, 0.0], abs=1e-11)
    # with a net rise: at rest where it begins and, 190 degrees on, where it ends
    rising = "{formula: 10*(t/w)**3*(10 - 15*t/w + 6*(t/w)**2)}".replace("w", "(19*pi/18)")
    assert output(cam(rising), [95.0, 190.0]) == pytest.approx([5.0, 10.0], abs=1e-10)


@pytest.mark.slow
def test_points_and_a_table(tmp_path: Path) -> None:
    points = "{points: [[0, 0], [50, 4], [100, 15], [150, 20], [200, 20]]}"
    assert output(cam(points), [50.0, 100.0, 150.0, 180.0]) == pytest.approx([4.0, 15.0, 20.0, 20.0], abs=1e-10)
    rows = [
        (a, 20 * (u - math.sin(2 * math.pi * u) / (2 * math.pi))) for a in range(0, 202, 2) for u in [min(a / 140, 1)]
    ]
    (tmp_path / "swing.csv").write_text("angle,swing\n" + "".join(f"{a},{s:.6f}\n" for a, s in rows), encoding="utf-8")
    assert output(cam("{table: swing.csv}"), [70.0, 170.0], tmp_path) == pytest.approx([10.0, 20.0], abs=1e-4)


@pytest.mark.slow
def test_a_lobe() -> None:
    lobe = "{lobe: {lift: 2, half: 80, powers: [2, 8, 14, 20, 26]}}"
    text = cam(lobe).replace("base_radius: 60", "base_radius: 200").replace("ground: 100", "ground: 300")
    assert output(text, [180.0, 270.0])[0] == pytest.approx(0.0, abs=1e-11)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (cam("[{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]"), SHORT),
        (cam("[{dwell: 180}]", ""), ELSEWHERE),
        (cam("[{dwell: 180}]", "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}\n"), ELSEWHERE),
        (
            cam("[{dwell: 180}]\n  motion: [{dwell: 180}]"),
            "a.yaml:4:10: cam.swing: cannot be combined with motion; give exactly one of motion or swing",
        ),
        (
            f"cam: {{kind: constant-breadth, base_radius: 60}}\n{LINKAGE}",
            "a.yaml:1:6: cam: needs motion or swing; give exactly one of them",
        ),
        (
            cam("{formula: 1 + t}"),
            "a.yaml:4:20: cam.swing.formula: the motion begins at 1; S(0) must be 0: make every displacement 1 less",
        ),
    ],
)
def test_what_is_refused(text: str, told: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        designed(load_text(text, "a.yaml"))
    assert str(caught.value) == told
