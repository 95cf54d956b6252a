"""Draw docs/pictures/overview.png from files of four shipped recipes: `python tools/docs/make_pictures.py`."""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np

from camgeo.output import pipeline
from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed
from kin.read.files import read_drawing

mpl.use("Agg")
import matplotlib.pyplot as plt  # the backend must be chosen first

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from camgeo.synthesis.design import Design
    from kin.follower.base import Follower
    from kin.read.drawing.drawing import Drawing

ROOT = Path(__file__).parents[2]
INK, METAL, ACCENT = "#26323f", "#cfd8e3", "#c8442c"
PLACES = (600, 300, 300, 300)  # tenths of a degree by which each cam is turned


def main() -> None:
    """Export, read back, draw."""
    figure, axes = plt.subplots(2, 4, figsize=(14, 5.4), height_ratios=[3, 1.1], constrained_layout=True)
    names = ("disc-roller", "as-figure-2a", "shu-wu", "w-figure-9")
    titles = ("disc cam, roller", "support function, yoke", "motion law, constant breadth", "oscillating double roller")
    for column, (name, title) in enumerate(zip(names, titles, strict=True)):
        recipe = load(ROOT / "recipes" / f"{name}.yaml")
        recipe = replace(recipe, export=replace(recipe.export, files=(recipe.export.files[0],)))
        design = designed(recipe)
        with tempfile.TemporaryDirectory() as folder:
            outcome = pipeline.export(recipe, Path(folder))
            path = Path(folder) / recipe.name / f"{recipe.name}.dxf"
            drawing = read_drawing(path)
        follower = design.exact.gauge
        phi = np.linspace(0.0, 2.0 * np.pi, 3601)
        error = np.stack([one.rows(phi)[0] / follower.si for one in follower.resting(drawing.contour)])
        error -= follower.intended(phi)
        draw_mechanism(axes[0, column], drawing, design, phi[PLACES[column]])
        axes[0, column].set_title(title, color=INK, fontsize=11)
        draw_error(axes[1, column], np.degrees(phi), error, outcome.report)
    figure.savefig(ROOT / "docs" / "pictures" / "overview.png", dpi=110)


def draw_mechanism(axis: Axes, drawing: Drawing, design: Design, phi: float) -> None:
    """The cam as read back, its holes and its follower at one shaft angle, in the cam frame."""
    follower: Follower = design.exact.gauge
    fine = np.linspace(0.0, 2.0 * np.pi, 2001)
    for contour, face in [(drawing.contour, METAL), *((hole, "white") for hole in drawing.holes)]:
        arcs = contour.as_arcs()[0]
        rows = [arcs.points(share * arcs.length) for share in np.linspace(0.0, 1.0, 33)]
        axis.fill(*np.stack(rows, axis=1).reshape(-1, 2).T, facecolor=face, edgecolor=INK, lw=1.1)
    axis.plot(0, 0, "+", color=INK, ms=7)
    if hasattr(follower, "breadth"):
        u, n = np.array([np.cos(phi), np.sin(phi)]), np.array([-np.sin(phi), np.cos(phi)])
        lift = float(follower.intended(np.array([phi]))[0])
        for distance in (lift, lift - follower.breadth):
            ends = distance * u + np.outer([-1, 1], n) * 0.62 * follower.breadth
            axis.plot(ends[:, 0], ends[:, 1], color=ACCENT, lw=2)
    elif not hasattr(follower, "transmission"):
        contact = design.follower.contacts[0]
        along = contact.datum + design.motion.travel(np.array([phi]), 0)[0].item()
        u, n = np.array([np.cos(phi), np.sin(phi)]), np.array([-np.sin(phi), np.cos(phi)])
        centre, end = (x * u + contact.guide.offset * n for x in (along, along + 3.2 * contact.touch.radius))
        axis.plot(*np.column_stack([centre, end]), color=ACCENT, lw=3)
        circle = centre + contact.touch.radius * np.column_stack([np.cos(fine), np.sin(fine)])
        axis.fill(circle[:, 0], circle[:, 1], facecolor="#f3d6cf", edgecolor=ACCENT, lw=1.2)
    else:
        law = follower.transmission
        psi = float(follower.intended(np.array([phi]))[0])
        pivot = law.arm * np.array([np.cos(phi), np.sin(phi)])
        for angle in (phi - psi - law.alpha, phi - psi + law.alpha):
            centre = pivot + law.arm * np.array([np.cos(angle), np.sin(angle)])
            axis.plot(*np.column_stack([pivot, centre]), color=ACCENT, lw=1.6)
            circle = centre + follower.radius * np.column_stack([np.cos(fine), np.sin(fine)])
            axis.fill(circle[:, 0], circle[:, 1], facecolor="#f3d6cf", edgecolor=ACCENT, lw=1.2)
        axis.plot(*pivot, "o", color=ACCENT, ms=5)
    axis.set_aspect("equal")
    axis.axis("off")


def draw_error(axis: Axes, degrees: np.ndarray, error: np.ndarray, report: dict) -> None:
    """Motion error measured from the file, with its limit."""
    check = next(c for c in report["checks"] if c["name"] == "motion")
    scale = 1e3 if check["unit"] == "mm" else np.degrees(1e3)
    unit = "µm" if check["unit"] == "mm" else "mdeg"
    for row in error:
        axis.plot(degrees, scale * row, color=INK, lw=0.6)
    for side in (-1, 1):
        axis.axhline(side * 1e3 * check["limit"], color=ACCENT, lw=1, ls="--")
    axis.set_xlim(0, 360)
    axis.set_xticks([0, 90, 180, 270, 360])
    axis.set_xlabel("shaft angle, degrees", fontsize=8, color=INK)
    axis.set_ylabel(f"motion error of the file, {unit}", fontsize=7, color=INK)
    axis.tick_params(labelsize=8, colors=INK)


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
