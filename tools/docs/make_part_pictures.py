"""Draw docs/pictures/parts.png from files of shipped recipes: `python tools/docs/make_part_pictures.py`."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import ezdxf
import matplotlib as mpl
import numpy as np
from ezdxf import path as drawn

from camgeo.output import pipeline
from camgeo.recipe.loading import load
from kin.read.mesh.stl import triangles_of

mpl.use("Agg")
import matplotlib.pyplot as plt  # the backend must be chosen first

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROOT = Path(__file__).parents[2]
INK, METAL = "#26323f", "#cfd8e3"
LIGHT = np.array([-0.5, -0.55, 0.9])
PIXELS = 900
COLOURS = {"CUT": INK, "BORE": "#1f5fa8", "HOLES": "#1d8a8a", "MARK": "#c8442c", "ENGRAVE": "#3c8a2e"}
NAMES = ("oscillating-yoke", "w-rosette", "hypocycloid")
TITLES = (
    "keyway by DIN 6885, hub, set screw,\nchamfer, engraved mark",
    "bolt circle, dowel hole,\nlightening holes",
    "D-flat, lightening holes, cut mark",
)


def main() -> None:
    """Export, read back, draw."""
    figure = plt.figure(figsize=(11, 6.6), constrained_layout=True)
    for column, (name, title) in enumerate(zip(NAMES, TITLES, strict=True)):
        recipe = load(ROOT / "recipes" / f"{name}.yaml")
        with tempfile.TemporaryDirectory() as folder:
            pipeline.export(recipe, Path(folder))
            made = Path(folder) / recipe.name
            flat = figure.add_subplot(2, 3, column + 1)
            draw_layers(flat, next(iter(sorted(made.glob("*.dxf")))))
            flat.set_title(title, color=INK, fontsize=10)
            draw_solid(figure.add_subplot(2, 3, column + 4), made / f"{name}.stl")
    figure.savefig(ROOT / "docs" / "pictures" / "parts.png", dpi=100)


def draw_layers(axis: Axes, path: Path) -> None:
    """What is cut and engraved, each layer in its colour."""
    for entity in ezdxf.readfile(path).modelspace():
        layer = entity.dxf.layer
        if layer not in COLOURS:
            continue
        points = np.array([(v.x, v.y) for v in drawn.make_path(entity).flattening(0.01)])
        face = METAL if layer == "CUT" else "none" if layer == "ENGRAVE" else "white"
        axis.fill(points[:, 0], points[:, 1], facecolor=face, edgecolor=COLOURS[layer], lw=1.3)
    axis.plot([0], [0], "+", color=INK, ms=7)
    axis.set_aspect("equal")
    axis.axis("off")


def draw_solid(axis: Axes, path: Path) -> None:
    """The solid as its triangles lie in the file, seen from above and in front, lit from the left."""
    corners = triangles_of(path.read_bytes(), path)[0].astype(float)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    shade = 0.42 + 0.58 * np.clip(normal @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0)
    turn, tilt = np.radians(-25.0), np.radians(48.0)
    c, s = np.cos(turn), np.sin(turn)
    seen = corners @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = np.cos(tilt), np.sin(tilt)
    seen = seen @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    picture = raster(seen, shade)[..., None] * np.array(mpl.colors.to_rgb(METAL)) * 1.12
    axis.imshow(np.where(np.isnan(picture), 1.0, np.clip(picture, 0.0, 1.0)), interpolation="lanczos")
    axis.axis("off")


def raster(corners: np.ndarray, shade: np.ndarray) -> np.ndarray:
    """Picture (h, w) of triangles (t, 3, 3) seen along -z: of each pixel the nearest one's shade (t,), nan of none."""
    low, high = corners.reshape(-1, 3).min(axis=0), corners.reshape(-1, 3).max(axis=0)
    scale = (PIXELS - 4) / float((high - low)[:2].max())
    place = (corners - low) * scale + 2.0
    width, height = (np.ceil((high - low)[:2] * scale) + 4).astype(int)
    depth, grey = np.full((height, width), -np.inf), np.full((height, width), np.nan)
    for (a, b, c), value in zip(place, shade, strict=True):
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area <= 1e-9:
            continue  # it faces away
        x0, y0 = np.floor(np.minimum(np.minimum(a, b), c)[:2]).astype(int)
        x1, y1 = np.ceil(np.maximum(np.maximum(a, b), c)[:2]).astype(int) + 1
        x, y = np.meshgrid(np.arange(x0, x1), np.arange(y0, y1))
        u = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) / area
        v = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) / area
        z = u * a[2] + v * b[2] + (1.0 - u - v) * c[2]
        near = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1.0 + 1e-9) & (z > depth[y0:y1, x0:x1])
        depth[y0:y1, x0:x1][near], grey[y0:y1, x0:x1][near] = z[near], value
    return grey[::-1]


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
