"""Draw docs/figures/shu-wu-*.svg, the figures of Shu and Wu 2012: `python tools/docs/make_constant_breadth.py`."""

from __future__ import annotations

import argparse
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from drawing import (
    BLUE,
    CONSTRUCTION,
    CURVE,
    FIXED,
    FOLLOWER,
    INK,
    METAL,
    NORMAL,
    QUIET,
    RED,
    Axis,
    Look,
    Sheet,
    chart,
    keep,
    turned,
    unit,
)

import camgeo

if TYPE_CHECKING:
    from drawing import Array, Panel

    from camgeo.api.design import Design

ROOT = Path(__file__).parents[2]
RECIPE = ROOT / "recipes" / "shu-wu.yaml"
BASE, STROKE, RISE = 40.0, 20.0, 120.0  # mm, mm, degrees
BREADTH = 2.0 * BASE + STROKE  # SW 1
KNOTS = (0.0, 15.0, 105.0, 120.0, 180.0, 195.0, 285.0, 300.0, 360.0)  # degrees: pieces of the modified sine, dwells
SHOWN = 50.0  # degrees: the position of Figure 1


def rows(design: Design, degrees: Array) -> Array:
    """S, V, A and J over the shaft angle (4, n), mm by powers of radians."""
    return np.stack([design.motion(np.radians(degrees), derivative=k) for k in range(4)])


def contact(motion: Array, degrees: Array, side: int = 1) -> Array:
    """Contact A (SW 14), or with `side` -1 contact B (SW 17 with its sign put right), in the cam's axes (n, 2)."""
    theta = np.radians(degrees)
    along = motion[0] + BASE if side > 0 else motion[0] + BASE - BREADTH
    return motion[1][:, None] * unit(theta + 0.5 * np.pi) + along[:, None] * unit(theta)


def figure_1(design: Design) -> str:
    """The mechanism with its instant centres and the common normal of both contacts."""
    sheet = Sheet("Shu and Wu 2012, Figure 1: instant centres of a constant-breadth cam", 560, 496)
    panel = sheet.panel((10, 10, 540, 476), (-98, -68, 98, 104))
    lift, slope = rows(design, np.array([SHOWN]))[:2, 0].tolist()
    high, low = BASE + lift, BASE + lift - BREADTH
    turn = np.radians(90.0 - SHOWN)  # of the cam's X axis, as the face's normal points upward
    _follower(panel, high, low)
    degrees = np.linspace(0.0, 180.0, 181)
    halves = [contact(rows(design, degrees), degrees, side) for side in (1, -1)]
    panel.line(turned(np.concatenate(halves), turn), METAL, closed=True)
    panel.letter((0, 0), "2", (70, -80), 13.0)
    for angle, name in zip((0.0, RISE, 180.0, 180.0 + RISE), ("P_0", "P_1", "P_2", "P_3"), strict=True):
        direction = np.radians(angle) + turn
        radius = BASE + (STROKE if name in ("P_1", "P_2") else 0.0)
        panel.line([(0.0, 0.0), radius * unit(direction)], CONSTRUCTION)
        panel.dot(radius * unit(direction))
        panel.letter((radius + 7.0) * unit(direction), name, (14, -8) if name == "P_0" else (0, 0))
    for k, name in enumerate(("β_r", "β_h", "β_f", "β_l")):
        start = np.radians((0.0, RISE, 180.0, 180.0 + RISE)[k]) + turn
        panel.angle((0, 0), 40.0, (start, start + np.radians(RISE if k % 2 == 0 else 180.0 - RISE)), name, QUIET)
    panel.arrow((0, 0), 84.0 * unit(turn), QUIET)
    panel.letter(84.0 * unit(turn), "X", (10, 2))
    panel.arrow((0, 0), 78.0 * unit(turn + 0.5 * np.pi), QUIET)
    panel.letter(78.0 * unit(turn + 0.5 * np.pi), "Y", (-8, 8))
    panel.line([(0, 0), (0, high)], QUIET)
    panel.angle((0, 0), 66.0, (turn, 0.5 * np.pi), "θ")
    panel.arrow((-94, 0), (94, 0), CONSTRUCTION, both=True)
    panel.line([(-slope, high + 10), (-slope, low - 10)], NORMAL)
    for point, name, beside in (
        ((-slope, high), "A", (-12, -12)),
        ((-slope, low), "B", (-12, 12)),
        ((-slope, 0.0), "Q = I_23", (-38, 13)),
        ((0.0, 0.0), "O_2 = I_12", (42, -15)),
    ):
        panel.dot(point)
        panel.letter(point, name, beside)
    panel.letter((-84, 0), "to I_13", (-4, 12), 13.0)
    panel.letter((84, 0), "to I_13", (-4, -13), 13.0)
    panel.arrow((-slope, 0.0), (0.0, 0.0), RED, both=True)
    panel.letter((-0.5 * slope, 0.0), "q", (0, -11))
    panel.line([(0.0, 0.0), (56, 0.0)], QUIET)
    panel.arrow((50, 0.0), (50, high), INK, both=True)
    panel.letter((50, 0.55 * high), "L", (11, 0))
    panel.arrow((88, low), (88, high), INK, both=True)
    panel.letter((88, 0.5 * (high + low)), "d", (10, 30))
    return sheet.text()


def _follower(panel: Panel, high: float, low: float) -> None:
    """Draw the two faces in one frame, its stem in a guide."""
    thick, side = 6.0, 70.0
    for face, out in ((high, high + thick), (low, low - thick)):
        panel.line([(-side, face), (side, face), (side, out), (-side, out)], FOLLOWER, closed=True)
        panel.line([(side, face), (92, face)], QUIET)
    for x in (-side - thick, side):
        low_end, high_end = low - thick, high + thick
        bar = [(x, low_end), (x, high_end), (x + thick, high_end), (x + thick, low_end)]
        panel.line(bar, FOLLOWER, closed=True)
    panel.line([(-4, high + thick), (4, high + thick), (4, 102), (-4, 102)], FOLLOWER, closed=True)
    for sign in (-1.0, 1.0):
        panel.line([(sign * 4, 84), (sign * 12, 84), (sign * 12, 96), (sign * 4, 96)], FIXED, closed=True)
    panel.letter((16, 90), "1", (4, 0), 13.0)
    panel.letter((-side - 0.5 * thick, high + thick), "3", (-18, -6), 13.0)


def _curve(panel: Panel, design: Design, order: int, look: Look = CURVE) -> None:
    """Draw one derivative of the displacement, with its jumps upright."""
    points = []
    for begin, end in pairwise(KNOTS):
        degrees = np.linspace(begin, end, 24)
        inside = np.clip(degrees, begin + 1e-7, end - 1e-7)
        points.append(np.column_stack([degrees, rows(design, inside)[order]]))
    panel.line(np.concatenate(points), look)


def figure_2(design: Design) -> str:
    """Displacement, velocity, acceleration and jerk by the shaft angle."""
    sheet = Sheet("Shu and Wu 2012, Figure 2: motion of the follower", 820, 520)
    turn = Axis.of(0, 360, "θ, degrees", 0, 60, 120, 180, 240, 300, 360)
    axes = (
        ("(a)", Axis.of(-2, 24, "S, mm", 0, 5, 10, 15, 20)),
        ("(b)", Axis.of(-25, 25, "V = S′, mm/rad", -20, -10, 0, 10, 20)),
        ("(c)", Axis.of(-38, 38, "A = S″, mm/rad²", -30, -15, 0, 15, 30)),
        ("(d)", Axis.of(-205, 205, "J = S‴, mm/rad³", -150, -75, 0, 75, 150)),
    )
    marks = (
        ((150, 20, "20"),),
        ((60, 1, "16.803"), (240, -1, "−16.803")),
        ((15, 1, "25.204"), (105, -1, "−25.204"), (195, -1, ""), (285, 1, "")),
        ((0, 1, "151.23"), (60, -1, "−50.41"), (180, -1, "−151.23"), (240, 1, "50.41")),
    )
    for k, (head, up) in enumerate(axes):
        place = (60.0 + 410.0 * (k % 2), 34.0 + 260.0 * (k // 2), 330.0, 180.0)
        panel = chart(sheet, place, turn, up, head)
        _curve(panel, design, k)
        for angle, sense, text in marks[k]:
            value = rows(design, np.array([angle + 1e-7]))[k, 0]
            panel.dot((angle, value))
            panel.letter((angle, value), text, (24.0 if angle in (0, 15) else 0.0, 14.0 * sense if k else 12.0), 12.0)
    return sheet.text()


def figure_3(design: Design) -> str:
    """The profile: the half that belongs to A, and the half of B that comes with it."""
    sheet = Sheet("Shu and Wu 2012, Figure 3: profile of the cam", 480, 440)
    panel = sheet.panel((10, 10, 460, 420), (-72, -66, 72, 66))
    degrees = np.linspace(0.0, 180.0, 181)
    motion = rows(design, degrees)
    first, second = contact(motion, degrees), contact(motion, degrees, -1)
    panel.line(np.concatenate([first, second]), Look("metal"), closed=True)
    panel.arrow((-70, 0), (70, 0), QUIET)
    panel.arrow((0, -62), (0, 62), QUIET)
    panel.letter((70, 0), "X", (-4, 12))
    panel.letter((0, 62), "Y", (12, -2))
    panel.line(first, Look("", "follower-edge", 2.4))
    panel.line(second, Look("", "link-edge", 2.4))
    for angle, name in zip((0.0, RISE, 180.0, 180.0 + RISE), ("P_0", "P_1", "P_2", "P_3"), strict=True):
        radius = BASE + (STROKE if name in ("P_1", "P_2") else 0.0)
        point = radius * unit(np.radians(angle))
        panel.line([(0, 0), point], CONSTRUCTION)
        panel.dot(point)
        panel.letter(point * (1.0 + 7.0 / radius), name, (0, 12 if angle % 180 == 0 else 0))
    panel.letter(first[40] * 1.1, "A")
    panel.letter(second[40] * 1.12, "B")
    panel.letter((0, 0), "O_2", (14, -12))
    panel.dot((0, 0))
    return sheet.text()


def figure_4(design: Design) -> str:
    """Radius of curvature of both halves, which sum to the breadth."""
    sheet = Sheet("Shu and Wu 2012, Figure 4: radius of curvature", 560, 330)
    turn = Axis.of(0, 360, "θ, degrees", 0, 60, 120, 180, 240, 300, 360)
    panel = chart(sheet, (60, 34, 470, 240), turn, Axis.of(25, 75, "ρ, mm", 30, 40, 50, 60, 70))
    panel.line([(0, 50), (360, 50)], CONSTRUCTION)
    for half, look in ((0, BLUE), (1, RED)):
        points = []
        for begin, end in pairwise(KNOTS[4 * half : 4 * half + 5]):
            degrees = np.clip(np.linspace(begin, end, 32), begin + 1e-7, end - 1e-7)
            motion = rows(design, degrees)
            points.append(np.column_stack([degrees, BASE + motion[0] + motion[2]]))
        panel.line(np.concatenate(points), look)
    for angle, text, up in extremes(design):
        panel.dot((angle, radius(design, angle)))
        panel.letter((angle, radius(design, angle)), text, (0, 13 * up), 12.0)
    panel.letter((90, 50), "ρ_A", (0, 40))
    panel.letter((270, 50), "ρ_B", (0, -40))
    return sheet.text()


def radius(design: Design, degrees: float) -> float:
    """Radius of curvature at an angle, mm: SW 24, and SW 30 beyond half a turn."""
    motion = rows(design, np.array([degrees]))[:, 0]
    return float(BASE + motion[0] + motion[2])


def extremes(design: Design) -> list[tuple[float, str, int]]:
    """Where the radius is least and greatest in either half, degrees, with its figure, and to which side it lies."""
    found = []
    for begin in (0.0, 180.0):
        degrees = np.linspace(begin, begin + 180.0, 18_001)
        motion = rows(design, degrees)
        rho = BASE + motion[0] + motion[2]
        for place, up in ((rho.argmax(), 1), (rho.argmin(), -1)):
            found.append((float(degrees[place]), f"{rho[place]:.3f}", up))
    return found


def figures() -> dict[str, str]:
    """Each picture by its name."""
    design = camgeo.design(camgeo.load(RECIPE))
    drawn = (figure_1, figure_2, figure_3, figure_4)
    return {f"shu-wu-{k}": draw(design) for k, draw in enumerate(drawn, start=1)}


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    keep(ROOT / "docs" / "figures", figures(), "shu-wu-")
