"""Draw docs/figures/transmission-*.svg, laws of Wunderlich 1984: `python tools/docs/make_laws.py`."""

from __future__ import annotations

import argparse

import numpy as np
from arms import ROOT, Pair, swing
from drawing import BLUE, CURVE, QUIET, RED, Axis, Look, Sheet, chart, keep

WANTED = ROOT / "recipes" / "w-wanted-law.yaml"
HARMONICS = (7, 15)  # of the two charts of errors


def figure_6(pair: Pair) -> str:
    """Its transmission law, and the affinity (4.9) on a rectangle."""
    sheet = Sheet("Wunderlich 1984, Figure 6: transmission law", 620, 320)
    delta = np.degrees(pair.delta)
    names = {0.0: "0", delta: "δ", 2.0 * delta: "2δ", 3.0 * delta: "3δ", 4.0 * delta: "4δ"}
    turn = Axis(0.0, 4.0 * delta, "φ from a mean position, in δ = π/λ", names)
    panel = chart(sheet, (55, 34, 540, 230), turn, Axis.of(-20, 20, "ψ, degrees", -20, -10, 0, 10, 20))
    phi = np.linspace(0.0, 4.0 * delta, 481)
    start = 0.5 * pair.alpha + pair.delta  # from here psi grows
    most = np.degrees(swing(pair))
    panel.line(
        [(0, 0), (delta, 0), (delta, most), (0, most)], Look("follower", "follower-edge", 1.2, opacity=0.4), closed=True
    )
    image = [(delta, 0), (2 * delta, 0), (2 * delta - most, -most), (delta - most, -most)]
    panel.line(image, Look("link", "link-edge", 1.2, opacity=0.4), closed=True)
    panel.line(np.column_stack([phi, np.degrees(pair.psi(np.radians(phi) + start))]), CURVE)
    panel.line([(0, 0), (4 * delta, 0)], QUIET)
    panel.letter((0, most), "ε", (12, 10))
    panel.letter((delta - most, -most), "−ε", (-4, -13))
    return sheet.text()


def wanted_law(wanted: Pair) -> str:
    """A wanted law, and by how much the best series of two numbers of harmonics miss it: extremes of one size."""
    sheet = Sheet("Wunderlich 1984, 6.5: a wanted law and its nearest series", 860, 300)
    across = Axis.of(0, 180, "φ, degrees", 0, 45, 90, 135, 180)
    law = chart(sheet, (50, 34, 220, 210), across, Axis.of(-9, 9, "ψ, degrees", -8, -4, 0, 4, 8))
    phi = np.linspace(0.0, np.pi, 721)
    psi = np.degrees(wanted.psi(phi))
    law.line(np.column_stack([np.degrees(phi), psi]), CURVE)
    law.line([(0, 0), (180, 0)], QUIET)
    text = WANTED.read_text(encoding="utf-8").partition("limits:")[0]
    for left, most, step, harmonics, look in (
        (345, 0.078, 0.05, HARMONICS[0], BLUE),
        (635, 0.0092, 0.006, HARMONICS[1], RED),
    ):
        made = Pair.of(text.replace("harmonics: 15", f"harmonics: {harmonics}"))
        error = np.degrees(made.psi(phi)) - psi
        up = Axis(-most, most, "error, degrees", {-step: f"−{step:g}", 0.0: "0", step: f"{step:g}"})
        panel = chart(sheet, (left, 34, 215, 210), across, up, f"j to {harmonics}:")
        panel.line([(0, 0), (180, 0)], QUIET)
        for side in (-1.0, 1.0):
            panel.line(
                [(0, side * np.abs(error).max()), (180, side * np.abs(error).max())], Look("", "quiet", 0.8, "4 3")
            )
        panel.line(np.column_stack([np.degrees(phi), error]), look)
    return sheet.text()


def figures() -> dict[str, str]:
    """Each picture by its name."""
    return {
        "transmission-6": figure_6(Pair.shipped("w-figure-5")),
        "transmission-wanted": wanted_law(Pair.shipped("w-law")),
    }


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    keep(ROOT / "docs" / "figures", figures(), "transmission-")
