"""Parts of a camshaft's diagrams as SVG: literal colours, which every program reads, and classes for a page's own."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from camgeo.files.markup import one_line

if TYPE_CHECKING:
    from collections.abc import Sequence

COLOURS = {
    "ink": "#1d2733",
    "faint": "#c3cad3",
    "ground": "#ffffff",
    "intake": "#2f6fb2",
    "exhaust": "#c2562d",
    "other": "#4a7d3c",
}
WIDTH = 480.0  # px of a diagram, so that its letters are read on a screen 390 px wide
LETTER = 6.3  # greatest width of a letter of 11 px
FONT = 'font-family="DejaVu Sans, Arial, sans-serif"'
# on a page, dark or light: what is filled and what is drawn, by the same names
SHEET = """\
.diagrams { display: grid; gap: 16px; grid-template-columns: repeat(auto-fit, minmax(min(100%, 420px), 1fr)); }
.diagrams, .diagrams ~ section { grid-column: 1 / -1; }
.diagrams figure { margin: 0; }
.diagrams svg { display: block; width: 100%; max-width: 640px; height: auto; margin: auto; }
:root { --faint: #c3cad3; --intake: #2f6fb2; --exhaust: #c2562d; --other: #4a7d3c; }
@media (prefers-color-scheme: dark) {
  :root { --faint: #3a4550; --intake: #74b3ec; --exhaust: #f08a6e; --other: #8fcf7a; }
}
@media print { :root { --faint: #c3cad3; --intake: #2f6fb2; --exhaust: #c2562d; --other: #4a7d3c; } }
.diagrams .paper { fill: none; }
""" + "".join(
    f".diagrams .{name} {{ fill: var(--{name}); }} .diagrams .{name}-line {{ stroke: var(--{name}); }}\n"
    for name in COLOURS
)


def colour_of(valve: str) -> str:
    """Return the name of a lobe's colour: the valve that it opens, `other` for the empty text."""
    return valve or "other"


def filled(name: str) -> str:
    """Return the SVG attributes of a filled shape: class and colour by name."""
    return f'class="{name}" fill="{COLOURS[name]}"'


def stroked(name: str, width: float = 1.0, dashes: str = "") -> str:
    """Return the attributes of a line: class and colour by name, width, px, and lengths of dashes and gaps."""
    dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
    return f'class="{name}-line" fill="none" stroke="{COLOURS[name]}" stroke-width="{width:.4g}"{dashed}'


def edged(name: str, opacity: float, width: float = 1.0) -> str:
    """Return the attributes of a shape in a colour by name: filled at an opacity, 0 to 1, its edge `width` px wide."""
    edge = f'stroke="{COLOURS[name]}" stroke-width="{width:g}"'
    return f'class="{name} {name}-line" fill="{COLOURS[name]}" fill-opacity="{opacity:g}" {edge}'


def text(
    x: float,
    y: float,
    words: str,
    *,
    size: float = 12.0,
    anchor: str = "start",
    colour: str = "ink",
    turned: float = 0.0,
) -> str:
    """Return a line of words at (x, y), px, its letters `size` px, turned clockwise about (x, y) by degrees."""
    turn = f' transform="rotate({turned:g} {x:.2f} {y:.2f})"' if turned else ""
    return (
        f'<text x="{x:.2f}" y="{y:.2f}" font-size="{size:g}" text-anchor="{anchor}" {filled(colour)} {FONT}{turn}>'
        f"{one_line(words)}</text>"
    )


def line(name: str, x1: float, y1: float, x2: float, y2: float, *, width: float = 1.0, dashes: str = "") -> str:
    """Return a straight line, px, in the colour of a name."""
    return f'<line x1="{x1:.2f}" y1="{y1:.2f}" x2="{x2:.2f}" y2="{y2:.2f}" {stroked(name, width, dashes)}/>'


def on_wheel(middle: tuple[float, float], radius: float, degrees: float) -> tuple[float, float]:
    """Return the place (x, y), px, at a radius, px, about `middle`, and an angle, degrees clockwise from the top."""
    angle = math.radians(degrees)
    return middle[0] + radius * math.sin(angle), middle[1] - radius * math.cos(angle)


def arc(middle: tuple[float, float], radius: float, start: float, sweep: float, look: str) -> str:
    """Return an arc about a middle, from `start` over `sweep`, degrees clockwise from the top.

    `look` are its attributes; a sweep of a turn or more is a circle.
    """
    if sweep >= 360.0:
        return f'<circle cx="{middle[0]:.2f}" cy="{middle[1]:.2f}" r="{radius:.2f}" {look}/>'
    (x0, y0), (x1, y1) = (on_wheel(middle, radius, degrees) for degrees in (start, start + sweep))
    large = 1 if sweep > 180.0 else 0
    return f'<path d="M {x0:.2f} {y0:.2f} A {radius:.2f} {radius:.2f} 0 {large} 1 {x1:.2f} {y1:.2f}" {look}/>'


def sheet(height: float, title: str, parts: Sequence[str], width: float = WIDTH) -> str:
    """Return a diagram as an SVG text of `width` by `height` px, from its parts in SVG."""
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
        f'viewBox="0 0 {width:g} {height:g}" role="img"><title>{one_line(title)}</title>'
        f'<rect width="{width:g}" height="{height:g}" class="paper" fill="{COLOURS["ground"]}"/>'
    )
    return "\n".join([head, *parts, "</svg>"]) + "\n"


def stacked(sheets: Sequence[str]) -> str:
    """Return sheets, at least one, as one SVG text, below one another; all have the width WIDTH."""
    if len(sheets) == 1:
        return sheets[0]
    heights = [float(re.findall(r'height="([0-9.]+)"', words)[0]) for words in sheets]
    tops = [sum(heights[:rank]) for rank in range(len(sheets))]
    inner = [words.replace("<svg ", f'<svg y="{top:g}" ', 1) for words, top in zip(sheets, tops, strict=True)]
    return sheet(sum(heights), "diagrams", inner)
