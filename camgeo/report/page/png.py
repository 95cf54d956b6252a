"""A scene as PNG, with matplotlib; the colours are those of the drawing's light style."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.report.page.looks import LOOKS, colours
from camgeo.report.page.svg import BESIDE, OTHER, SIDE
from kin.read.home import prepare_home

if TYPE_CHECKING:
    from camgeo.report.page.scene import FilledShape, MovingBody, Scene

DOTS = 2.0  # of the picture for each px of the drawing
INCH = 72.0  # px of the drawing in what matplotlib takes for an inch


def png(scene: Scene, step: int) -> bytes:
    """PNG file of a scene at a step of the turn, 0 to STEPS; raises ModuleNotFoundError without matplotlib."""
    prepare_home()
    import matplotlib as mpl
    from matplotlib.figure import Figure

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
                if OTHER not in shape.role:
                    axes.add_patch(_patch(body, shape, step, order))
            for label in body.labels:
                x, y = body.placed(np.array([[label.x, label.y]]), step)[0].tolist()
                text_place = (x + BESIDE * px, y + BESIDE * px)
                style: dict[str, Any] = {"family": "serif", "style": "italic", "weight": "bold", "size": 13.0}
                axes.text(
                    *text_place, label.text, color=colours()["ink"], ha="center", va="center", zorder=1000, **style
                )
        stream = io.BytesIO()
        figure.savefig(stream, format="png", dpi=DOTS * INCH, metadata={"Software": None})
    return stream.getvalue()


def _patch(body: MovingBody, shape: FilledShape, step: int, order: int) -> Any:  # noqa: ANN401 - a library without types
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    look = LOOKS[shape.role]
    rings = [body.placed(ring.flattened(), step) for ring in shape.rings]
    parts = []
    for number, ring in enumerate(rings):
        # matplotlib fills what rings of opposite senses leave
        sense = np.sum(ring[:-1, 0] * ring[1:, 1] - ring[:-1, 1] * ring[1:, 0])
        parts.append(Path(ring[::-1] if shape.rings[number].closed and (sense > 0.0) == (number > 0) else ring))
    return PathPatch(
        Path.make_compound_path(*parts),
        facecolor=(colours()[look.fill], look.opacity) if look.fill else "none",
        edgecolor=colours()[look.edge] if look.edge else "none",
        linewidth=look.width,
        joinstyle="round",
        capstyle="round",
        zorder=order + 1,
    )
