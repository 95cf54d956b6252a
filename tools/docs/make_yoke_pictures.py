"""Draw docs/figures/aygahoglu-*.svg, Figures 3 and 5 of AS 2023: `python tools/docs/make_yoke_pictures.py`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from drawing import CONSTRUCTION, FOLLOWER, INK, METAL, NORMAL, QUIET, RED, Sheet, keep, unit

import camgeo

if TYPE_CHECKING:
    from drawing import Array, Panel

    from camgeo.api.design import Design

ROOT = Path(__file__).parents[2]
RECIPE = ROOT / "recipes" / "as-figure-2a.yaml"
SHAFT = np.array([16.0, 7.5])  # A in the axes of p, mm
BREADTH = 50.0
SHOWN = np.radians(128.0)  # theta


def touches(design: Design, theta: float) -> tuple[Array, Array, float]:
    """Contacts of the face with the normal theta and of the opposite one, in the axes of p; its distance from A."""
    lift, slope = design.motion(theta), design.motion(theta, derivative=1)
    u, n = unit(theta), unit(theta + 0.5 * np.pi)
    return SHAFT + lift * u + slope * n, SHAFT + (lift - BREADTH) * u + slope * n, float(lift)


def figure_3(design: Design) -> str:
    """The cam held fast, the follower run round it: its lift s is AD."""
    sheet = Sheet("Aygahoglu and Saka 2023, Figure 3: translating flat-faced follower", 560, 520)
    panel = sheet.panel((10, 10, 540, 500), (-60, -56, 60, 56))
    touch, opposite, lift = touches(design, SHOWN)
    u, n = unit(SHOWN), unit(SHOWN + 0.5 * np.pi)
    foot = SHAFT + lift * u
    middle = -float(SHAFT @ n)  # of the frame, beside the line AD
    for face, out in ((foot, 4.0), (foot - BREADTH * u, -4.0)):
        ends = [face + (middle + side) * n for side in (-34.0, 34.0)]
        panel.line([*ends, ends[1] + out * u, ends[0] + out * u], FOLLOWER, closed=True)
    for side in (-38.0, 34.0):
        ends = [foot + 4.0 * u + (middle + side + more) * n for more in (0.0, 4.0)]
        panel.line([*ends, ends[1] - 58.0 * u, ends[0] - 58.0 * u], FOLLOWER, closed=True)
    stem = [foot + out * u + across * n for out, across in ((4, -2), (4, 2), (20, 2), (20, -2))]
    panel.line(stem, FOLLOWER, closed=True)
    panel.line(design.contour(360) + SHAFT, METAL, closed=True)
    _axes(panel)
    panel.line([SHAFT, SHAFT + np.array([26.0, 0.0])], CONSTRUCTION)
    panel.angle(SHAFT, 34.0, (0.0, SHOWN), "θ")
    panel.arrow(SHAFT, foot, RED, both=True)
    panel.letter(0.45 * SHAFT + 0.55 * foot, "s", (12, 8))
    panel.line([touch + 9.0 * u, touch - 14.0 * u], NORMAL)
    for point, name, beside in (
        (SHAFT, "A(x_n, y_n)", (14, -18)),
        (touch, "P(x_t, y_t)", (-26, -17)),
        (foot, "D", (14, 2)),
        (np.array([-10.0, -14.0]), "2", (0, 0)),
        (foot + (middle + 36.0) * n, "3", (-22, 4)),
    ):
        panel.letter(point, name, beside)
    panel.dot(touch)
    panel.dot(opposite)
    panel.dot(foot)
    panel.pin(SHAFT)
    return sheet.text()


def _axes(panel: Panel) -> None:
    """Draw the axes in which p is written, at the cam's centre."""
    panel.arrow((0, 0), (33, 0), QUIET)
    panel.arrow((0, 0), (0, 35), QUIET)
    panel.letter((33, 0), "x", (6, -10))
    panel.letter((0, 35), "y", (10, 4))
    panel.disc((0, 0), 2.5)


def figure_5(design: Design) -> str:
    """The cam between two parallel tangents: p(theta) and p(theta + pi) from the centre, w in all."""
    sheet = Sheet("Aygahoglu and Saka 2023, Figure 5: constant breadth cam and its tangents", 520, 520)
    panel = sheet.panel((10, 10, 500, 500), (-48, -48, 48, 48))
    theta = np.radians(52.0)
    touch, opposite, lift = touches(design, theta)
    u, n = unit(theta), unit(theta + 0.5 * np.pi)
    near = lift + float(SHAFT @ u)  # p(theta)
    panel.line(design.contour(360) + SHAFT, METAL, closed=True)
    _axes(panel)
    for along in (near, near - BREADTH):
        panel.line([along * u - 34.0 * n, along * u + 34.0 * n], INK)
    panel.arrow((0, 0), near * u, RED, both=True)
    panel.arrow((0, 0), (near - BREADTH) * u, RED, both=True)
    panel.angle((0.0, 0.0), 46.0, (0.0, theta), "θ")
    panel.arrow(30.0 * n + near * u, 30.0 * n + (near - BREADTH) * u, INK, both=True)
    foot = SHAFT + lift * u
    panel.line([SHAFT, foot], CONSTRUCTION)
    for point, name, beside in (
        (0.6 * near * u, "p(θ)", (-24, 8)),
        (0.6 * (near - BREADTH) * u, "p(θ + π)", (40, -6)),
        (30.0 * n + (near - 0.4 * BREADTH) * u, "w", (-12, 8)),
        (touch, "(x_t, y_t)", (16, 14)),
        (foot, "D", (10, 12)),
        (SHAFT, "A(x_n, y_n)", (36, -15)),
        (0.5 * (SHAFT + foot), "s", (12, -2)),
    ):
        panel.letter(point, name, beside)
    for point in (touch, opposite, foot):
        panel.dot(point)
    panel.pin(SHAFT)
    return sheet.text()


def figures() -> dict[str, str]:
    """Each picture by its name."""
    design = camgeo.design(camgeo.load(RECIPE))
    return {"aygahoglu-3": figure_3(design), "aygahoglu-5": figure_5(design)}


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    keep(ROOT / "docs" / "figures", figures(), "aygahoglu-")
