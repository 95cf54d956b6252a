"""A scene as SVG: groups that a page moves, or a still picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from html import escape
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from camgeo.report.page.scene import Body, Label, Scene, Shape
    from kin.numeric.arrays import Array

NAMESPACE = "http://www.w3.org/2000/svg"
SIDE = 640.0  # px: the longer side of a drawing, in its own units
OTHER = "other"  # in the role of a contour that does not show
BESIDE = 13.0  # px from a joint's middle to that of its letter, along either axis


@dataclass(frozen=True)
class View:
    """Where a scene lies in its drawing: a length of 1 is `scale` px, the point (x, y) the upper left corner."""

    scale: float
    x: float
    y: float
    width: float
    height: float

    @staticmethod
    def of(scene: Scene) -> View:
        """Fit a scene into `SIDE`."""
        x0, y0, x1, y1 = scene.box
        scale = SIDE / max(x1 - x0, y1 - y0)
        return View(scale, x0, y1, scale * (x1 - x0), scale * (y1 - y0))


def moving(scene: Scene) -> str:
    """Return the drawing at shaft angle 0 as an `svg` element; the group of body k has the id `body-k`."""
    return _drawing(scene, 0, 'id="drawing" role="img" aria-label="the mechanism, to scale"', scene.digits)


def still(scene: Scene, step: int, style: str, title: str) -> str:
    """Return a picture at a step of the turn as an SVG file, with its `style` within it."""
    view = View.of(scene)
    size = f'style="--px:1.5" xmlns="{NAMESPACE}" width="{view.width:.0f}" height="{view.height:.0f}" role="img"'
    head = f"<title>{escape(title)}</title><style>{style}</style>"
    shown = [replace(body, shapes=tuple(s for s in body.shapes if OTHER not in s.role)) for body in scene.bodies]
    return _drawing(replace(scene, bodies=tuple(shown)), step, size, scene.digits - 1, head) + "\n"


def _drawing(scene: Scene, step: int, attributes: str, digits: int, head: str = "") -> str:
    view = View.of(scene)
    bodies = "".join(_body(body, index, step, digits) for index, body in enumerate(scene.bodies))
    letters = "".join(
        _letter(view, label, index, body.placed(np.array([[label.x, label.y]]), step)[0], digits)
        for index, body in enumerate(scene.bodies)
        for label in body.labels
    )
    place = f"scale({view.scale:.7g} {-view.scale:.7g}) translate({-view.x:.{digits}f} {-view.y:.{digits}f})"
    return (
        f'<svg {attributes} viewBox="0 0 {view.width:.2f} {view.height:.2f}" class="drawing">{head}'
        f'<g transform="{place}">{bodies}</g><g class="letters" aria-hidden="true">{letters}</g></svg>'
    )


def _body(body: Body, index: int, step: int, digits: int) -> str:
    x, y, angle = body.at(step)
    place = f"translate({x:.{digits}f} {y:.{digits}f}) rotate({math.degrees(angle):.4f})"
    shapes = "".join(_shape(shape, digits) for shape in body.shapes)
    name = escape(body.name)
    return f'<g id="body-{index}" class="body {body.kind}" transform="{place}"><title>{name}</title>{shapes}</g>'


def _shape(shape: Shape, digits: int) -> str:
    path = "".join(ring.path(digits) for ring in shape.rings)
    title = f"<title>{escape(shape.name)}</title>" if shape.name else ""
    return f'<path class="{shape.role}" d="{path}">{title}</path>'


def _letter(view: View, label: Label, index: int, place_of: Array, digits: int) -> str:
    x, y = place_of.tolist()
    at = f"{label.x:.{digits}f} {label.y:.{digits}f}"
    place = f'x="{view.scale * (x - view.x) + BESIDE:.1f}" y="{view.scale * (view.y - y) - BESIDE:.1f}"'
    return f'<text data-body="{index}" data-at="{at}" {place}>{escape(label.text)}</text>'
