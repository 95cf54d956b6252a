"""A scene as PNG, with matplotlib; the colours are those of the drawing's light style."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.report.page.svg import BESIDE, SIDE
from kin.read.home import prepare_home

if TYPE_CHECKING:
    from camgeo.report.page.scene import Body, Scene, Shape

DOTS = 2.0  # of the picture for each px of the drawing
INCH = 72.0  # px of the drawing in what matplotlib takes for an inch
# fill and edge of each role, by the names of the style's colours, and the width of the edge, px
LOOKS: dict[str, tuple[str, str, float]] = {
    "metal": ("metal", "metal-edge", 1.5),
    "mark": ("", "metal-edge", 2.2),
    "follower": ("follower", "follower-edge", 1.5),
    "roller": ("ground", "follower-edge", 1.5),
    "rocker": ("link", "link-edge", 1.5),
    "block": ("link", "link-edge", 1.5),
    "rod": ("rod", "rod-edge", 1.5),
    "output": ("output", "output-edge", 1.5),
    "fixed": ("fixed", "ink", 1.2),
    "foot": ("fixed", "ink", 1.2),
    "hatch": ("", "quiet", 1.2),
    "pin": ("pin", "ink", 1.2),
    "force": ("", "contact", 1.8),
    "force tip": ("contact", "", 0.0),
    "force dot": ("contact", "", 0.0),
    "load": ("", "load", 2.6),
    "load tip": ("load", "", 0.0),
    "load dot": ("load", "", 0.0),
}


def png(scene: Scene, step: int) -> bytes:
    """Draw a scene at a step of the turn; raises ModuleNotFoundError without matplotlib."""
    prepare_home()
    import matplotlib as mpl
    from matplotlib.figure import Figure

    from camgeo.report.page.page import asset

    colours = dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{6})", asset("drawing.css").partition("@media")[0]))
    x0, y0, x1, y1 = scene.box
    px = max(x1 - x0, y1 - y0) / SIDE
    with mpl.rc_context():
        mpl.rcdefaults()
        figure = Figure(figsize=((x1 - x0) / px / INCH, (y1 - y0) / px / INCH))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_axis_off()
        axes.set_xlim(x0, x1)
        axes.set_ylim(y0, y1)
        for order, body in enumerate(scene.bodies):
            for shape in body.shapes:
                if shape.role in LOOKS:
                    axes.add_patch(_patch(body, shape, step, colours, order))
            for label in body.labels:
                x, y = body.placed(np.array([[label.x, label.y]]), step)[0].tolist()
                at = (x + BESIDE * px, y + BESIDE * px)
                style: dict[str, Any] = {"family": "serif", "style": "italic", "weight": "bold", "size": 13.0}
                axes.text(*at, label.text, color=colours["ink"], ha="center", va="center", zorder=1000, **style)
        stream = io.BytesIO()
        figure.savefig(stream, format="png", dpi=DOTS * INCH, metadata={"Software": None})
    return stream.getvalue()


def _patch(body: Body, shape: Shape, step: int, colours: dict[str, str], order: int) -> Any:  # noqa: ANN401 - a library without types
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    fill, edge, width = LOOKS[shape.role]
    rings = [body.placed(ring.flattened(), step) for ring in shape.rings]
    parts = []
    for number, ring in enumerate(rings):
        # matplotlib fills what rings of opposite senses leave
        sense = np.sum(ring[:-1, 0] * ring[1:, 1] - ring[:-1, 1] * ring[1:, 0])
        parts.append(Path(ring[::-1] if shape.rings[number].closed and (sense > 0.0) == (number > 0) else ring))
    return PathPatch(
        Path.make_compound_path(*parts),
        facecolor=colours[fill] if fill else "none",
        edgecolor=colours[edge] if edge else "none",
        linewidth=width,
        alpha=0.85 if shape.role == "follower" else 1.0,
        joinstyle="round",
        capstyle="round",
        zorder=order + 1,
    )
