"""A scene as SVG: groups that a page moves, or a still picture."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from camgeo.report.page.looks import colours, literal
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.report.page.scene import FilledShape, Letter, MovingBody, Scene
    from kin.numeric.arrays import Array

NAMESPACE = "http://www.w3.org/2000/svg"
SIDE = 640.0  # px: the longer side of a drawing, in its own units
OTHER = "other"  # in the role of a contour that does not show
LARGE = 1.5  # times a page's px: pictures are looked at small
LETTER, HALO = 13.0, 3.0  # px: the size of a letter, and of the ground's edge round it
DROP = 0.34  # of a letter's size, from its middle to its base line
LINES = ' fill-rule="evenodd" stroke-linejoin="round" stroke-linecap="round"'
FONT = (
    f'font-family="Georgia, Times New Roman, serif" font-style="italic" font-weight="600" '
    f'font-size="{LETTER * LARGE:g}" text-anchor="middle"'
)
BESIDE = 13.0  # px from a joint's middle to that of its letter, along either axis


@dataclass(frozen=True)
class Viewport:
    """Place of a scene in its drawing, `width` by `height` px.

    A length of 1 in the scene is `scale` px; (x, y) is the upper left corner, in the scene's axes.
    """

    scale: float
    x: float
    y: float
    width: float
    height: float

    @staticmethod
    def of(scene: Scene) -> Viewport:
        """View that fits a scene into a square of `SIDE` px."""
        x0, y0, x1, y1 = scene.box
        scale = SIDE / max(x1 - x0, y1 - y0)
        return Viewport(scale, x0, y1, scale * (x1 - x0), scale * (y1 - y0))


@dataclass(frozen=True)
class _Pen:
    """Decimal digits of a drawing, and a px in the scene's unit; None where a style sheet gives the looks."""

    digits: int
    px: float | None = None


def moving(scene: Scene) -> str:
    """Return the drawing at shaft angle 0 as an `svg` element; the group of body k has the id `body-k`."""
    return _drawing(scene, 0, 'id="drawing" role="img" aria-label="the mechanism, to scale"', _Pen(scene.digits))


def still(scene: Scene, step: int, title: str) -> str:
    """Return a picture at a step of the turn, 0 to STEPS, as the text of an SVG file, on a ground of its own.

    Colours and widths are literal attributes, and each letter is drawn twice: programs other than browsers know no
    variables of style sheets and no strokes that do not scale, and paint the edge of a letter over it.
    """
    view = Viewport.of(scene)
    size = f'xmlns="{NAMESPACE}" width="{view.width:.0f}" height="{view.height:.0f}" role="img"'
    over = (
        f'x="-1" y="-1" width="{view.width + 2.0:.0f}" height="{view.height + 2.0:.0f}"'  # the whole of px at the rim
    )
    ground = f'<rect {over} fill="{colours()["ground"]}"/>'
    head = f"<title>{escape(title)}</title>{ground}"
    visible = [replace(body, shapes=tuple(s for s in body.shapes if OTHER not in s.role)) for body in scene.bodies]
    scene = replace(scene, bodies=tuple(visible))
    return _drawing(scene, step, size, _Pen(scene.digits - 1, LARGE / view.scale), head) + "\n"


def _drawing(scene: Scene, step: int, attributes: str, pen: _Pen, head: str = "") -> str:
    digits = pen.digits
    view = Viewport.of(scene)
    bodies = "".join(_body(body, index, step, pen) for index, body in enumerate(scene.bodies))
    letters = "".join(
        _letter(view, label, index, body.placed(np.array([[label.x, label.y]]), step)[0], pen)
        for index, body in enumerate(scene.bodies)
        for label in body.labels
    )
    place = f"scale({view.scale:.7g} {-view.scale:.7g}) translate({-view.x:.{digits}f} {-view.y:.{digits}f})"
    kind, lines, font = (' class="drawing"', "", 'class="letters"') if pen.px is None else ("", LINES, FONT)
    return (
        f'<svg {attributes} viewBox="0 0 {view.width:.2f} {view.height:.2f}"{kind}>{head}'
        f'<g transform="{place}"{lines}>{bodies}</g><g {font} aria-hidden="true">{letters}</g></svg>'
    )


def _body(body: MovingBody, index: int, step: int, pen: _Pen) -> str:
    digits = pen.digits
    x, y, angle = body.at(step)
    place = f"translate({x:.{digits}f} {y:.{digits}f}) rotate({math.degrees(angle):.4f})"
    shapes = "".join(_shape(shape, pen) for shape in body.shapes)
    name = escape(body.name)
    return f'<g id="body-{index}" class="body {body.kind}" transform="{place}"><title>{name}</title>{shapes}</g>'


def _shape(shape: FilledShape, pen: _Pen) -> str:
    path = "".join(ring.path(pen.digits) for ring in shape.rings)
    title = f"<title>{escape(shape.name)}</title>" if shape.name else ""
    look = f'class="{shape.role}"' if pen.px is None else literal(shape.role, pen.px)
    return f'<path {look} d="{path}">{title}</path>'


def _letter(view: Viewport, label: Letter, index: int, place_of: Array, pen: _Pen) -> str:
    x, y = (place_of * (1.0, -1.0) * view.scale + (BESIDE - view.scale * view.x, view.scale * view.y - BESIDE)).tolist()
    text = escape(label.text)
    if pen.px is None:
        data_place = f"{label.x:.{pen.digits}f} {label.y:.{pen.digits}f}"
        return f'<text data-body="{index}" data-at="{data_place}" x="{x:.1f}" y="{y:.1f}">{text}</text>'
    place = f'x="{x:.1f}" y="{y + DROP * LETTER * LARGE:.1f}"'
    ground = colours()["ground"]
    halo = f'stroke="{ground}" stroke-width="{HALO * LARGE:.1f}" stroke-linejoin="round"'
    return f'<text {place} {halo}>{text}</text><text {place} fill="{colours()["ink"]}">{text}</text>'
