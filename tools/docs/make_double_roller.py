"""Draw docs/figures/wunderlich-*.svg, the figures of Wunderlich 1984: `python tools/docs/make_double_roller.py`."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

import numpy as np
from arms import ROOT, Pair, centre, follower, polygon
from drawing import (
    BLUE,
    CONSTRUCTION,
    CURVE,
    FOLLOWER_LINE,
    INK,
    METAL,
    NORMAL,
    PITCH,
    QUIET,
    RED,
    ROLLER,
    VIOLET,
    Axis,
    Look,
    Sheet,
    chart,
    keep,
    unit,
)

if TYPE_CHECKING:
    from arms import Position
    from drawing import Array

THIN = Look("", "load", 1.2)
SHADE = Look("link", "link-edge", 1.2, opacity=0.45)
OTHER_SHADE = Look("follower", "follower-edge", 1.2, opacity=0.45)
# the flat pair of the second isoptic figure; the page shows it
TRIANGULAR = "name: three-faced\ncam: {kind: flat-pair, ratio: 3, arm: 30, delta: {cos: {1: 450}}}\n"


def figure_1(pair: Pair) -> str:
    """One arm and its roller: the contact's normal meets OP in the pole I."""
    sheet = Sheet("Wunderlich 1984, Figure 1: cam with oscillating follower", 560, 400)
    panel = sheet.panel((10, 10, 540, 380), (-56, -54, 84, 54))
    at = pair.at(np.radians(12.0))
    contour = pair.design.contour(720)
    touch = contour[np.hypot(*(contour - at.a).T).argmin()]
    pole = pole_of(pair, at)
    panel.line(contour, METAL, closed=True)
    panel.line(pair.pitch(), THIN)
    panel.line([pole * 1.25, at.p * 1.25], CONSTRUCTION)
    panel.line([at.a + 0.35 * (at.a - pole), pole], NORMAL)
    panel.line([at.p, at.a], Look("", "follower-edge", 4.0))
    panel.circle(at.a, pair.roller, ROLLER)
    panel.dot(touch)
    panel.dot(pole)
    panel.dot(at.a)
    panel.pin(at.p)
    for point, name, beside in (
        (at.p, "P", (6, -15)),
        (at.a, "A", (15, -4)),
        (touch, "T", (-12, 8)),
        (pole, "I", (-3, 15)),
        ((0.0, -38.0), "c", (0, 0)),
        (at.a + pair.roller * unit(-0.9), "p", (9, -6)),
        (pair.end(np.array([2.3]), -1)[0] * 1.08, "c̄", (0, 0)),
    ):
        panel.letter(point, name, beside)
    centre(panel, (-4, -15))
    panel.angle(at.p, 46.0, (np.arctan2(*(at.a - at.p)[::-1]) % (2 * np.pi), at.phi + np.pi), "")
    return sheet.text()


def pole_of(pair: Pair, at: Position) -> Array:
    """The relative pole I: where the normal of the contour at its point next to A meets the line OP."""
    fine = pair.design.contour(36_000)
    k = int(np.hypot(*(fine - at.a).T).argmin())
    tangent = fine[(k + 1) % len(fine)] - fine[k - 1]
    along = unit(at.phi)
    # I = s along with (I - A) . tangent = 0
    pole: Array = along * (at.a @ tangent) / (along @ tangent)
    return pole


def figure_3(pair: Pair) -> str:
    """Two adjacent positions and the next: mirror images, each chord seen under alpha."""
    sheet = Sheet("Wunderlich 1984, Figure 3: adjacent positions", 520, 620)
    panel = sheet.panel((10, 10, 500, 600), (-26, -66, 132, 124))
    one, two = pair.chain(np.radians(8.0), 2)
    panel.circle((0.0, 0.0), pair.arm, CONSTRUCTION)
    panel.circle((0.0, 0.0), 2.0 * pair.arm, CONSTRUCTION)
    for at, look in ((one, SHADE), (two, OTHER_SHADE)):
        panel.line([at.p, at.a, at.b], look, closed=True)
        panel.line([(0.0, 0.0), at.p], INK)
    for end in (one.a, one.b, two.b):
        panel.line([(0.0, 0.0), end], CONSTRUCTION)
    corner = 2.0 * pair.arm * unit(one.phi), 2.0 * pair.arm * unit(two.phi)
    for foot, ends in ((one.a, corner[:1]), (one.b, corner), (two.b, corner[1:])):
        far = [ends[0], 1.5 * foot - 0.5 * ends[0]] if len(ends) == 1 else list(ends)
        panel.line(far, THIN)
    bisector = one.p + 34.0 * unit(one.phi - one.psi)
    panel.line([one.p, bisector], QUIET)
    panel.line([one.p, corner[0]], CONSTRUCTION)
    panel.angle(one.p, 50.0, (one.phi - one.psi, one.phi), "ψ")
    directions = [np.arctan2(*end[::-1]) for end in (one.a, one.b, two.b)]
    panel.angle((0.0, 0.0), 40.0, (directions[0], directions[1]), "")
    panel.angle((0.0, 0.0), 46.0, (directions[1], directions[2]), "")
    panel.letter(13.0 * unit(directions[0] + 0.18), "α", (13, 0))
    panel.letter(14.0 * unit(directions[2] - 0.3), "α", (6, 7))
    for point in (one.a, one.b, two.b):
        panel.dot(point)
    for point in (one.p, two.p):
        panel.pin(point)
    for corner_point in corner:
        panel.dot(corner_point)
    for point, name, beside in (
        (one.p, "P", (4, -15)),
        (two.p, "P′", (-14, 8)),
        (one.a, "A", (-2, -16)),
        (one.b, "B = A′", (34, -4)),
        (two.b, "B′ = A″", (4, 15)),
        (0.5 * (one.a + corner[0]), "p", (12, -6)),
        (0.5 * (one.b + corner[0]), "p′", (12, 6)),
        (0.5 * (two.b + corner[1]), "p″", (6, 12)),
        (2.0 * pair.arm * unit(-0.42), "2l", (12, 0)),
        (pair.arm * unit(-0.75), "l", (10, -4)),
    ):
        panel.letter(point, name, beside)
    centre(panel)
    return sheet.text()


def figure_4(pair: Pair) -> str:
    """The overconstrained linkage: triangles, spokes, and the arcs that its joints describe."""
    sheet = Sheet("Wunderlich 1984, Figure 4: overconstrained linkage", 580, 560)
    panel = sheet.panel((10, 10, 560, 540), (-122, -122, 122, 114))
    chain = pair.chain(np.radians(12.0), 2 * pair.lam)
    for k, at in enumerate(chain):
        panel.line([at.p, at.a, at.b], OTHER_SHADE if k % 2 else SHADE, closed=True)
    panel.circle((0.0, 0.0), pair.arm, CONSTRUCTION)
    for k, at in enumerate(chain):
        panel.line([(0.0, 0.0), at.p], BLUE if k % 2 else RED)
    for k in range(2 * pair.lam):
        arc = pair.end(np.linspace(0.0, pair.delta, 61) + k * pair.delta + 0.5 * pair.alpha, -1)
        panel.line(arc, Look("", "load", 2.4) if k % 2 == 0 else Look("", "load", 1.6, "2 4"))
        panel.letter(1.1 * arc[18], f"c_{k + 1}")
    for k, at in enumerate(chain):
        panel.dot(at.a)
        panel.pin(at.p)
        panel.letter(at.p * 0.8, f"P_{k + 1}", (0, 0), 12.0)
        panel.letter(at.a * 0.92, f"A_{k + 1}", (0, 0), 12.0)
    middle = arc_centre(pair)
    panel.dot(middle)
    panel.letter(middle, "C_1", (14, -8), 12.0)
    centre(panel, (-13, -12))
    return sheet.text()


def arc_centre(pair: Pair) -> Array:
    """Centre of the circular first arc, mm, from three of its points."""
    a, b, c = pair.end(0.5 * pair.alpha + pair.delta * np.array([0.1, 0.5, 0.9]), -1)
    matrix, right = 2.0 * np.array([b - a, c - a]), np.array([b @ b - a @ a, c @ c - a @ a])
    middle: Array = np.linalg.solve(matrix, right)
    return middle


def figure_5(pair: Pair) -> str:
    """The mechanism that follows from Figure 4: the pivot lies within the disc."""
    sheet = Sheet("Wunderlich 1984, Figure 5: single disc, oscillating double roller", 520, 520)
    panel = sheet.panel((10, 10, 500, 500), (-116, -116, 116, 116))
    panel.line(pair.design.contour(480), METAL, closed=True)
    panel.line(pair.pitch(481), THIN)
    chain = pair.chain(np.radians(12.0), 2 * pair.lam)
    polygon(panel, chain)
    panel.line([(0.0, 0.0), chain[0].p], INK)
    follower(panel, pair, chain[0])
    panel.letter(chain[0].p, "P", (-2, -15))
    panel.letter(chain[0].a, "A", (2, -20))
    panel.letter(chain[0].b, "B", (16, 12))
    panel.letter((0.0, -60.0), "c", (0, 0))
    panel.letter(pair.pitch()[200] * 1.06, "c̄")
    centre(panel)
    return sheet.text()


def figure_7(pair: Pair) -> str:
    """The auxiliary frame that turns with the bisector of the angle AOB."""
    sheet = Sheet("Wunderlich 1984, Figure 7: auxiliary frame", 480, 480)
    panel = sheet.panel((10, 10, 460, 460), (-24, -72, 126, 78))
    at = pair.at(np.radians(8.0))
    mean = 0.5 * (np.arctan2(*at.a[::-1]) + np.arctan2(*at.b[::-1]))
    x_axis, y_axis = unit(mean - 0.25 * np.pi), unit(mean + 0.25 * np.pi)
    panel.circle(at.p, pair.arm, CONSTRUCTION)
    panel.arrow((0, 0), 96.0 * x_axis, QUIET)
    panel.arrow((0, 0), 100.0 * y_axis, QUIET)
    panel.line([(0, 0), 118.0 * unit(mean)], CONSTRUCTION)
    for end in (at.a, at.b):
        panel.line([(0, 0), end], INK)
        panel.line([at.p, end], FOLLOWER_LINE)
    panel.line([(0, 0), at.p], FOLLOWER_LINE)
    along, up = at.p @ x_axis, at.p @ y_axis
    panel.line([along * x_axis, at.p, up * y_axis], CONSTRUCTION)
    directions = np.arctan2(*at.a[::-1]), np.arctan2(*at.b[::-1])
    panel.angle((0, 0), 92.0, (mean - 0.25 * np.pi, directions[0]), "σ")
    panel.angle((0, 0), 92.0, (directions[1], mean + 0.25 * np.pi), "σ")
    for point, name, beside in (
        (at.p, "P", (2, -15)),
        (at.a, "A", (14, -4)),
        (at.b, "B", (6, 14)),
        (96.0 * x_axis, "X", (8, -8)),
        (100.0 * y_axis, "Y", (-12, 4)),
        (0.56 * at.a, "r", (2, -12)),
        (0.6 * at.b, "r′", (-12, 8)),
        (118.0 * unit(mean), "X = Y", (-34, 10)),
    ):
        panel.letter(point, name, beside)
    panel.dot(at.a)
    panel.dot(at.b)
    panel.pin(at.p)
    centre(panel)
    return sheet.text()


def figure_8(pair: Pair) -> str:
    """Booth's lemniscate with its movable rhombus, and the ellipse of which it is the pedal."""
    sheet = Sheet("Wunderlich 1984, Figure 8: Booth's lemniscate", 600, 480)
    panel = sheet.panel((10, 10, 580, 460), (-82, -64, 82, 64))
    chain = pair.chain(np.radians(28.0), 4)
    panel.line(pair.design.contour(360), METAL, closed=True)
    panel.line(pair.pitch(), PITCH)
    turn = np.linspace(0.0, 2.0 * np.pi, 241)
    half = float(np.hypot(*pair.pitch(4321).T).max()), float(np.hypot(*pair.pitch(4321).T).min())
    panel.line(np.column_stack([half[0] * np.cos(turn), half[1] * np.sin(turn)]), CONSTRUCTION)
    polygon(panel, chain, VIOLET)
    for at in chain[1:]:
        panel.line([(0, 0), at.p], CONSTRUCTION)
    panel.line([(0, 0), chain[0].p], INK)
    for at in chain[1:]:
        panel.dot(at.a)
    follower(panel, pair, chain[0])
    for at, name, beside in zip(chain, ("A", "A′", "A″", "A‴"), ((36, -12), (-38, 8), (-16, 8), (2, -16)), strict=True):
        panel.letter(at.a, name, beside)
    panel.letter(chain[0].p, "P", (14, 8))
    panel.letter(0.5 * (chain[2].a + chain[2].b), "2l", (-13, -9))
    centre(panel, (-12, -4))
    return sheet.text()


def figure_9(pair: Pair) -> str:
    """The right-angled follower with its star octagon, and its law."""
    sheet = Sheet("Wunderlich 1984, Figure 9: cam mechanism and transmission law", 860, 440)
    panel = sheet.panel((10, 10, 430, 420), (-56, -62, 68, 62))
    panel.line(pair.design.contour(480), METAL, closed=True)
    panel.line(pair.pitch(481), THIN)
    chain = pair.chain(np.radians(15.0), 2 * pair.lam)
    polygon(panel, chain)
    for at in chain[2:]:
        panel.disc(at.a, 2.6)
    follower(panel, pair, chain[0])
    panel.line([(0, 0), chain[0].p], INK)
    for point, name, beside in (
        (chain[0].p, "P", (14, 4)),
        (chain[0].a, "A", (4, -37)),
        (chain[0].b, "B", (30, 22)),
        ((-22.0, 4.0), "c", (0, 0)),
        (pair.end(np.array([3.9]), -1)[0] * 1.07, "c̄", (0, 0)),
    ):
        panel.letter(point, name, beside)
    centre(panel, (-4, -15))
    delta = np.degrees(pair.delta)
    turn = Axis(0.0, 360.0, "φ, degrees", {k * 90.0: f"{k * 90}" for k in range(5)})
    law = chart(sheet, (500, 70, 330, 250), turn, Axis.of(-12, 12, "ψ, degrees", -10, -5, 0, 5, 10))
    phi = np.linspace(0.0, 360.0, 721)
    law.line([(0, 0), (360, 0)], QUIET)
    law.line(np.column_stack([phi, np.degrees(pair.psi(np.radians(phi)))]), CURVE)
    law.arrow((90.0, -10.9), (90.0 + 2.0 * delta, -10.9), INK, both=True)
    law.letter((90.0 + delta, -10.9), "2δ", (0, 12), 13.0)
    return sheet.text()


def isoptic(pairs: tuple[Pair, Pair]) -> str:
    """Two flat faces at a constant angle: their corner runs on a circle, the feet from O on the pedal."""
    sheet = Sheet("Wunderlich 1984, section 5: isoptic circle and pedal curve", 860, 440)
    for k, pair in enumerate(pairs):
        panel = sheet.panel((10 + 425 * k, 10, 415, 420), (-66, -66, 66, 66))
        at = pair.at(np.radians(24.0 - 52.0 * k))
        panel.line(pair.design.contour(300), METAL, closed=True)
        panel.circle((0, 0), 2.0 * pair.arm, CONSTRUCTION)
        panel.line(pair.pitch(), PITCH)
        corner = 2.0 * pair.arm * unit(at.phi)
        for foot in (at.a, at.b):
            along = (foot - corner) / np.hypot(*(foot - corner))
            panel.line([corner, corner + 78.0 * along], Look("", "follower-edge", 3.0))
            panel.line([(0, 0), foot], CONSTRUCTION)
            panel.dot(foot)
        panel.pin(corner)
        panel.letter(at.a, "A", (6, -15))
        panel.letter(at.b, "B", (-3, 15))
        panel.letter(0.5 * (at.a + corner), "p", (14, -6))
        panel.letter(0.5 * (at.b + corner), "p′", (14, 10))
        panel.letter(2.0 * pair.arm * unit(4.0), "2l", (-12, -8))
        panel.letter((-16.0, 0.0), "c*", (0, 0))
        panel.letter(pair.pitch()[150] * 1.08, "c̄")
        centre(panel)
    return sheet.text()


def rosette(pair: Pair) -> str:
    """The path of the third arm's tip, and the cam that one leaf of it gives."""
    sheet = Sheet("Wunderlich 1984, section 5: the rosette of the third arm", 860, 440)
    at = pair.at(np.radians(20.0))
    tip = tips(pair, np.array([at.phi]))[0]
    path = tips(pair, np.linspace(0.0, 2.0 * np.pi, 601))
    whole = sheet.panel((10, 10, 420, 420), (-92, -92, 92, 92))
    whole.line(pair.design.contour(480), METAL, closed=True)
    whole.line(pair.pitch(481), THIN)
    whole.circle((0, 0), pair.arm, CONSTRUCTION)
    whole.line(path, Look("", "link-edge", 1.0))
    whole.line([at.p, tip], Look("", "output-edge", 4.0))
    follower(whole, pair, at)
    whole.letter(at.p, "P", (14, 2))
    whole.letter(at.a, "A", (4, -20))
    whole.letter(at.b, "B", (4, 21))
    whole.letter(tip, "Q", (-10, 13))
    near = sheet.panel((450, 30, 400, 380), (-9.6, -9.6, 9.6, 9.6))
    near.line([(-9, 0), (9, 0)], QUIET)
    near.line([(0, -9), (0, 9)], QUIET)
    near.line(path, RED)
    # the leaf of the recipe: the first delta of shaft angle
    near.line(tips(pair, np.linspace(0.0, pair.delta, 61)), Look("", "output-edge", 3.0))
    near.line([tip + 0.16 * (at.p - tip), tip], Look("", "output-edge", 4.0))
    near.dot(tip)
    near.letter(tip, "Q", (-12, 10))
    near.pin((0, 0))
    near.letter((0, 0), "O", (-14, -10))
    near.letter(tips(pair, np.array([2.9]))[0] * 1.1, "q")
    return sheet.text()


def tips(pair: Pair, phi: Array) -> Array:
    """Tip Q of the third arm, of length l, on the bisector towards O, in the cam's axes (n, 2)."""
    return pair.arm * (unit(phi) - unit(phi - pair.psi(phi)))


def figures() -> dict[str, str]:
    """Each picture by its name."""
    five, nine = Pair.shipped("w-figure-5"), Pair.shipped("w-figure-9")
    return {
        "wunderlich-1": figure_1(nine),
        "wunderlich-3": figure_3(five),
        "wunderlich-4": figure_4(five),
        "wunderlich-5": figure_5(five),
        "wunderlich-7": figure_7(five),
        "wunderlich-8": figure_8(Pair.shipped("w-booth")),
        "wunderlich-9": figure_9(nine),
        "wunderlich-isoptic": isoptic((Pair.shipped("w-ellipse"), Pair.of(TRIANGULAR))),
        "wunderlich-rosette": rosette(Pair.shipped("w-rosette")),
    }


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    keep(ROOT / "docs" / "figures", figures(), "wunderlich-")
