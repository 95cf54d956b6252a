# needs: mechanism
"""Draw docs/pictures/mechanism-*.png from 3MF files of printed sets: `python tools/docs/make_mechanism_pictures.py`."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import matplotlib as mpl
import numpy as np
from make_part_pictures import LIGHT, raster

from camgeo.output import pipeline
from camgeo.recipe.loading import load
from kin.read.mesh.threemf import read_placed

mpl.use("Agg")
import matplotlib.pyplot as plt  # the backend must be chosen first

ROOT = Path(__file__).parents[2]
INK = "#26323f"
NAMES = ("print-yoke", "print-double-roller", "print-four-bar", "print-roller", "print-arm", "print-constant-diameter")
NAMES += ("print-groove",)
COLOURS = {
    "cam": "#d08a3c",
    "shaft": "#5b6b7f",
    "base": "#c3ccd6",
    "cap": "#9fb0c2",
    "retainer": "#3a4756",
    "yoke": "#4f8f5f",
    "arm": "#4f8f5f",
    "frame": "#4f8f5f",
    "stem": "#4f8f5f",
    "roller": "#8a6fb0",
    "rocker": "#8a6fb0",
}
SPIN, TILT = np.radians(-20.0), np.radians(42.0)


def main(names: list[str]) -> None:
    """Export, read back, draw: laid out on the left, put together on the right."""
    for name in names:
        recipe = load(ROOT / "recipes" / f"{name}.yaml")
        figure, axes = plt.subplots(1, 2, figsize=(13, 6.2), constrained_layout=True)
        with tempfile.TemporaryDirectory() as folder:
            pipeline.export(recipe, Path(folder), only=("3mf",))
            for axis, which in zip(axes, ("parts", "assembly"), strict=True):
                axis.imshow(drawn(Path(folder) / recipe.name / f"{recipe.name}-{which}.3mf"), interpolation="lanczos")
                axis.axis("off")
        axes[0].set_title(f"{recipe.name}-parts.3mf: as it is printed", color=INK, fontsize=11)
        axes[1].set_title(f"{recipe.name}-assembly.3mf: put together", color=INK, fontsize=11)
        figure.savefig(ROOT / "docs" / "pictures" / f"mechanism-{name.removeprefix('print-')}.png", dpi=80)
        plt.close(figure)


def drawn(path: Path) -> np.ndarray:
    """Picture of all bodies of a file in their places, each in its colour."""
    corners, values, colours = [], [], []
    for number, one in enumerate(read_placed(path)):
        there = one.corners @ one.place[:3] + one.place[3]
        normal = np.cross(there[:, 1] - there[:, 0], there[:, 2] - there[:, 0])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        shade = 0.45 + 0.5 * np.clip(normal @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0)
        corners.append(seen(there))
        values.append(number + shade)
        colours.append(mpl.colors.to_rgb(COLOURS.get(one.name.partition("-")[0], "#b0566a")))
    value = raster(np.concatenate(corners), np.concatenate(values))
    number = np.nan_to_num(np.floor(value)).astype(int)
    picture = np.array(colours)[number] * (value - number)[..., None] * 1.25
    return np.where(np.isnan(value)[..., None], 1.0, np.clip(picture, 0.0, 1.0))


def seen(corners: np.ndarray) -> np.ndarray:
    """Triangles turned as they are looked at, from above and in front."""
    c, s = np.cos(SPIN), np.sin(SPIN)
    turned = corners @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = np.cos(TILT), np.sin(TILT)
    return turned @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipes", nargs="*", default=NAMES, metavar="RECIPE", help="name of a shipped recipe")
    main(parser.parse_args().recipes)
