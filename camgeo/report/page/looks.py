"""Colours and lines of the parts of a drawing by role: on a page in light or dark, in a picture in light colours."""

from __future__ import annotations

import re
from functools import cache
from typing import NamedTuple

from camgeo.report.page.asset import asset


class Look(NamedTuple):
    """Colours of fill and edge by name, empty for none; width of the edge in px, opacity of the fill, 0 to 1.

    A line with `round` ends is seen even where it has no length.
    """

    fill: str
    edge: str
    width: float = 0.0
    opacity: float = 1.0
    ends: str = ""


LOOKS = {
    "metal": Look("metal", "metal-edge", 1.5),
    "metal upper": Look("upper", "upper-edge", 1.5, 0.55),
    "wall": Look("quiet", ""),
    "hub": Look("", "quiet", 1.2),
    "zero": Look("", "quiet", 1.0),
    "timing mark": Look("", "metal-edge", 2.2),
    "follower": Look("follower", "follower-edge", 1.5, 0.75),
    "roller": Look("ground", "follower-edge", 1.5, 0.85),
    "rocker": Look("link", "link-edge", 1.5),
    "block": Look("link", "link-edge", 1.5),
    "rod": Look("rod", "rod-edge", 1.5),
    "output": Look("output", "output-edge", 1.5),
    "fixed": Look("fixed", "ink", 1.2),
    "foot": Look("fixed", "ink", 1.2),
    "hatch": Look("", "quiet", 1.2),
    "pin": Look("pin", "ink", 1.2),
    "overlay": Look("", "output-edge", 1.4),
    "overlay dot": Look("output-edge", "ground", 0.8),
    "construction": Look("", "rod-edge", 1.0),
    "force": Look("", "contact", 1.8),
    "force tip": Look("contact", ""),
    "force dot": Look("contact", ""),
    "contact line": Look("", "contact", 5.0, ends="round"),
    "load": Look("", "load", 2.6),
    "load tip": Look("load", ""),
    "load dot": Look("load", ""),
}


def rules() -> str:
    """Return rules of CSS, one for each role, a line each; colours are variables, which differ on a dark page."""
    return "".join(
        f".drawing .{role.replace(' ', '.')} {{ fill: {_variable(look.fill)}; fill-opacity: {look.opacity}; "
        f"stroke: {_variable(look.edge)}; stroke-width: {look.width}px;"
        f"{f' stroke-linecap: {look.ends};' if look.ends else ''} }}\n"
        for role, look in LOOKS.items()
    )


def _variable(name: str) -> str:
    return f"var(--{name})" if name else "none"


@cache
def colours() -> dict[str, str]:
    """Return the light colours of the style by their names, each as `#rrggbb`."""
    return dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{6})", asset("drawing.css").partition("@media")[0]))


def literal(role: str, px: float) -> str:
    """Return the look of a role as attributes of SVG; `px` is the length of a px in the drawing's unit."""
    look = LOOKS[role]
    fill, edge = (colours()[name] if name else "none" for name in look[:2])
    text = f'fill="{fill}" stroke="{edge}"'
    if look.edge:
        text += f' stroke-width="{look.width * px:.4g}"'
    if look.ends:
        text += f' stroke-linecap="{look.ends}"'
    return text if look.opacity == 1.0 or not look.fill else f'{text} fill-opacity="{look.opacity}"'
