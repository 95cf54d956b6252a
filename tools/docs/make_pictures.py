"""Draw docs/pictures/overview.png from the files of a shipped recipe: `python tools/docs/make_pictures.py`."""

from __future__ import annotations

import argparse
import contextlib
import io
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np

from camgeo.cli.main import main as camgeo
from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed
from kin.read.files import read_drawing

mpl.use("Agg")
import matplotlib.pyplot as plt  # the backend must be chosen first

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from camgeo.synthesis.design import Design
    from kin.read.drawing.drawing import Drawing

ROOT = Path(__file__).parents[2]
NAME = "disc-roller"
INK, METAL, ACCENT, PALE = "#26323f", "#cfd8e3", "#c8442c", "#f3d6cf"
PLACE = 1.2  # rad of the shaft angle at which the mechanism is drawn
TYPE = 15.5  # points of an inch at 100 dots: at 390 px, half the picture's width, text is 10 px high


def main() -> None:
    """Export, read back, draw: the cam with its follower, its motion, and the verdict."""
    recipe = load(ROOT / "recipes" / f"{NAME}.yaml")
    design = designed(recipe)
    words = io.StringIO()
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(words):
        camgeo(["export", str(ROOT / "recipes" / f"{NAME}.yaml"), "-v", "--out", folder])
        drawing = read_drawing(Path(folder) / NAME / f"{NAME}.dxf")
    plt.rcParams.update({"font.size": TYPE, "text.color": INK, "axes.labelcolor": INK})
    figure = plt.figure(figsize=(8, 5.4), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=[1.0, 1.35], height_ratios=[1.2, 1.0, 0.55])
    draw_mechanism(figure.add_subplot(grid[:2, 0]), drawing, design)
    phi = np.linspace(0.0, 2.0 * np.pi, 3601)
    follower = design.exact.gauge
    draw_motion(figure.add_subplot(grid[0, 1]), phi, follower.intended(phi) - follower.intended(np.zeros(1)))
    error = np.stack([one.rows(phi)[0] / follower.si for one in follower.resting(drawing.contour)]) - follower.intended(
        phi
    )
    lines = words.getvalue().splitlines()
    limit = next(float(line.split()[4]) for line in lines if line.startswith("motion"))
    draw_error(figure.add_subplot(grid[1, 1]), phi, error, limit)
    draw_verdict(figure.add_subplot(grid[2, :]), lines[-1])
    figure.savefig(ROOT / "docs" / "pictures" / "overview.png", dpi=100)


def draw_mechanism(axis: Axes, drawing: Drawing, design: Design) -> None:
    """The cam as it was read from its DXF, and the roller on its stem, the stem upright."""
    contact = design.follower.contacts[0]
    along = contact.datum + design.motion.travel(np.array([PLACE]), 0)[0].item()
    turned = np.exp(
        1j * (np.pi / 2 - PLACE)
    )  # the follower runs round the standing cam: turn all so that it is upright
    for contour, face in [(drawing.contour, METAL), *((hole, "white") for hole in drawing.holes)]:
        arcs = contour.as_arcs()[0]
        rows = [arcs.points(share * arcs.length) for share in np.linspace(0.0, 1.0, 33)]
        points = np.stack(rows, axis=1).reshape(-1, 2) @ np.array([1.0, 1j]) * turned
        axis.fill(points.real, points.imag, facecolor=face, edgecolor=INK, lw=1.1)
    axis.plot(0, 0, "+", color=INK, ms=7)
    radius, x = contact.touch.radius, -contact.guide.offset
    top = along + 6.0 * radius
    axis.plot([x, x], [along, top], color=ACCENT, lw=3.5, solid_capstyle="butt")
    for side in (-1, 1):
        axis.fill_between(
            [x + side * 2.2, x + side * 6.0], along + 3.4 * radius, along + 4.8 * radius, color=INK, alpha=0.35, lw=0
        )
    fine = np.linspace(0.0, 2.0 * np.pi, 201)
    axis.fill(x + radius * np.cos(fine), along + radius * np.sin(fine), facecolor=PALE, edgecolor=ACCENT, lw=1.4)
    axis.plot(x, along, "o", color=ACCENT, ms=3)
    axis.set_title("the cam in its DXF", fontsize=TYPE)
    axis.set_aspect("equal")
    axis.axis("off")


def draw_motion(axis: Axes, phi: np.ndarray, lift: np.ndarray) -> None:
    """The intended lift over a turn."""
    axis.plot(np.degrees(phi), lift.ravel(), color=INK, lw=1.6)
    axis.fill_between(np.degrees(phi), lift.ravel(), color=METAL, alpha=0.6)
    axis.tick_params(labelbottom=False)
    _framed(axis, "lift in the recipe, mm")


def draw_error(axis: Axes, phi: np.ndarray, error: np.ndarray, limit: float) -> None:
    """Motion error measured from the drawing, with its limit, micrometres."""
    for row in error:
        axis.plot(np.degrees(phi), 1e3 * row, color=INK, lw=0.6)
    for side in (-1, 1):
        axis.axhline(side * 1e3 * limit, color=ACCENT, lw=1, ls="--")
    axis.set_ylim(-1.4e3 * limit, 1.4e3 * limit)
    axis.set_yticks([-1, 0, 1])
    axis.set_xlabel("shaft angle, degrees")
    _framed(axis, "its error on the drawing, with limit, µm")


def _framed(axis: Axes, title: str) -> None:
    axis.set_title(title, fontsize=TYPE)
    axis.set_xlim(0, 360)
    axis.set_xticks([0, 90, 180, 270, 360])
    axis.tick_params(colors=INK)
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)


def draw_verdict(axis: Axes, verdict: str) -> None:
    """The command and its answer, in lines that end with a file."""
    first, stl = verdict.split(" stl")
    shown = f"$ camgeo export {NAME}.yaml", first, f"                stl{stl}"
    axis.axis("off")
    for row, line in enumerate(shown):
        axis.text(
            0.0,
            0.95 - 0.36 * row,
            line,
            family="monospace",
            color=INK if row else ACCENT,
            transform=axis.transAxes,
            va="top",
        )


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
