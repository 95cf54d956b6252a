"""What the scripts of docs draw with: plane figures to scale and curves over an angle, as SVG with literal colours.

The colours are those of the page and the gallery (`camgeo/report/page/looks.py`). A sheet is measured in px with y
downward, a panel in units of its own with y upward.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from camgeo.report.page.looks import colours

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Point = Sequence[float] | Array

LETTER = 15.0  # px
LINE = 1.5  # px
BESIDE = 11.0  # px: from an arc to its name
DASHED = "5 4"


@dataclass(frozen=True)
class Look:
    """Colours of fill and edge by their names in the style, empty without; width of the edge, px; its dashes."""

    fill: str = ""
    edge: str = ""
    width: float = LINE
    dashes: str = ""
    opacity: float = 1.0

    def __str__(self) -> str:
        """Return the look as attributes of SVG."""
        names = colours()
        fill = names[self.fill] if self.fill else "none"
        text = f'fill="{fill}"'
        if self.fill and self.opacity < 1.0:
            text += f' fill-opacity="{self.opacity:g}"'
        if self.edge:
            text += f' stroke="{names[self.edge]}" stroke-width="{self.width:g}"'
        return f'{text} stroke-dasharray="{self.dashes}"' if self.dashes else text


METAL = Look("metal", "metal-edge")
FOLLOWER = Look("follower", "follower-edge", opacity=0.75)
FOLLOWER_LINE = Look("", "follower-edge", 2.0)
LINK = Look("link", "link-edge", opacity=0.6)
ROLLER = Look("ground", "follower-edge", opacity=0.85)
PIN = Look("ground", "ink")
FIXED = Look("fixed", "ink")
INK = Look("", "ink", 1.0)
QUIET = Look("", "quiet", 1.0)
CONSTRUCTION = Look("", "quiet", 1.0, DASHED)
NORMAL = Look("", "contact", 1.3, DASHED)
CURVE = Look("", "metal-edge", 1.8)
PITCH = Look("", "load", 1.8)
POINT = Look("contact", "ground", 1.0)
BLUE = Look("", "follower-edge", 1.8)
RED = Look("", "link-edge", 1.8)
GREEN = Look("", "rod-edge", 1.8)
VIOLET = Look("", "output-edge", 1.8)


@dataclass
class Sheet:
    """A picture of so many px, with what has been drawn on it."""

    title: str
    width: float
    height: float
    parts: list[str] = field(default_factory=list)

    def add(self, element: str) -> None:
        """Draw on top of what is there."""
        self.parts.append(element)

    def write(self, x: float, y: float, text: str, *, size: float = LETTER, anchor: str = "middle") -> None:
        """Write a line about (x, y); `_` lowers the letters and digits after it."""
        face = "font-style='italic'" if re.fullmatch(r"[^\W\d]['′″]*(_\w+)?", text) else ""
        look = f'font-size="{size:g}" text-anchor="{anchor}" {face}'.strip().replace("'italic'", '"italic"')
        at = f'x="{x:.1f}" y="{y + 0.34 * size:.1f}" {look}'
        names, words = colours(), _lowered(text, size)
        self.add(f'<text {at} stroke="{names["ground"]}" stroke-width="3.5" stroke-linejoin="round">{words}</text>')
        self.add(f'<text {at} fill="{names["ink"]}">{words}</text>')

    def panel(self, place: tuple[float, float, float, float], box: tuple[float, float, float, float]) -> Panel:
        """Return a panel at (left, top, width, height), px, that shows (x0, y0, x1, y1) to one scale, in its middle."""
        left, top, width, height = place
        x0, y0, x1, y1 = box
        scale = min(width / (x1 - x0), height / (y1 - y0))
        origin = (left + 0.5 * (width - scale * (x0 + x1)), top + 0.5 * (height + scale * (y0 + y1)))
        return Panel(self, origin, (scale, scale))

    def text(self) -> str:
        """Return the file."""
        size = f'width="{self.width:.0f}" height="{self.height:.0f}" viewBox="0 0 {self.width:.0f} {self.height:.0f}"'
        ground = f'<rect width="{self.width:.0f}" height="{self.height:.0f}" fill="{colours()["ground"]}"/>'
        head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" font-family="Georgia, Times New Roman, serif">'
        )
        lines = [f"{head}<title>{escape(self.title)}</title>{ground}"]
        lines += ['<g stroke-linejoin="round" stroke-linecap="round">', *self.parts, "</g></svg>", ""]
        return "\n".join(lines)


def _lowered(text: str, size: float) -> str:
    """Return words with what follows a `_` set lower and smaller."""
    words = ""
    for k, part in enumerate(re.split(r"_(\w+)", text)):
        if k % 2:
            drop = 0.28 * size
            words += f'<tspan dy="{drop:.1f}" font-size="{0.72 * size:.1f}">{escape(part)}</tspan>'
            words += f'<tspan dy="{-drop:.1f}">&#8203;</tspan>'
        else:
            words += escape(part)
    return words


@dataclass
class Panel:
    """A part of a sheet with its own axes: (x, y) stands at origin + scale * (x, -y), px."""

    sheet: Sheet
    origin: tuple[float, float]
    scale: tuple[float, float]

    def px(self, points: ArrayLike) -> Array:
        """Return points (n, 2) in px."""
        turned: Array = np.asarray(points, dtype=np.float64).reshape(-1, 2) * (self.scale[0], -self.scale[1])
        return turned + self.origin

    def line(self, points: ArrayLike, look: Look = INK, *, closed: bool = False) -> None:
        """Draw straight lines through points (n, 2)."""
        places = [f"{_short(x)} {_short(y)}" for x, y in self.px(points).tolist()]
        self.sheet.add(f'<path {look} d="M{"L".join(places)}{"Z" if closed else ""}"/>')

    def circle(self, centre: Point, radius: float, look: Look = INK) -> None:
        """Draw a circle of a radius in the panel's unit."""
        self.disc(centre, radius * self.scale[0], look)

    def disc(self, centre: Point, radius: float, look: Look = POINT) -> None:
        """Draw a circle of a radius in px."""
        x, y = self.px(centre)[0].tolist()
        self.sheet.add(f'<circle {look} cx="{_short(x)}" cy="{_short(y)}" r="{_short(radius)}"/>')

    def pin(self, point: Point) -> None:
        """Draw a revolute joint."""
        self.disc(point, 4.5, PIN)

    def dot(self, point: Point) -> None:
        """Draw a marked point."""
        self.disc(point, 3.6, POINT)

    def arrow(self, start: Point, end: Point, look: Look = INK, *, both: bool = False) -> None:
        """Draw a line with a head at its end, or at both."""
        self.line([start, end], look)
        ends = [(start, end), (end, start)] if both else [(start, end)]
        for foot, tip in ends:
            a, b = self.px([foot, tip])
            along = (b - a) / np.hypot(*(b - a))
            across = np.array([-along[1], along[0]])
            corners = [b, b - 8.0 * along + 3.0 * across, b - 8.0 * along - 3.0 * across]
            places = "L".join(f"{_short(x)} {_short(y)}" for x, y in np.array(corners).tolist())
            self.sheet.add(f'<path fill="{colours()[look.edge]}" d="M{places}Z"/>')

    def letter(self, point: Point, text: str, beside: tuple[float, float] = (0.0, 0.0), size: float = LETTER) -> None:
        """Write a name at a point, moved by so many px to the right and upward."""
        x, y = self.px(point)[0].tolist()
        self.sheet.write(x + beside[0], y - beside[1], text, size=size)

    def angle(self, centre: Point, radius: float, span: tuple[float, float], text: str = "", look: Look = INK) -> None:
        """Draw an arc between two directions, rad, of a radius in px, its name outside of its middle."""
        middle = self.px(centre)[0]
        way = np.linspace(*span, 24)
        points = middle + radius * np.column_stack([np.cos(way), -np.sin(way)])
        places = "L".join(f"{_short(x)} {_short(y)}" for x, y in points.tolist())
        self.sheet.add(f'<path {look} d="M{places}"/>')
        if text:
            half = 0.5 * (span[0] + span[1])
            x, y = (middle + (radius + BESIDE) * np.array([np.cos(half), -np.sin(half)])).tolist()
            self.sheet.write(x, y, text, size=LETTER - 1.0)


@dataclass(frozen=True)
class Axis:
    """A range of an axis, its name, and its ticks by their values."""

    low: float
    high: float
    name: str
    ticks: Mapping[float, str]

    @staticmethod
    def of(low: float, high: float, name: str, *ticks: float) -> Axis:
        """Ticks that are named by their values."""
        return Axis(low, high, name, {tick: f"{tick:g}".replace("-", "−") for tick in ticks})


def chart(sheet: Sheet, place: tuple[float, float, float, float], across: Axis, up: Axis, head: str = "") -> Panel:
    """Draw a frame at (left, top, width, height), px, names and ticks outside of it; curves go on the panel."""
    left, top, width, height = place
    scale = width / (across.high - across.low), height / (up.high - up.low)
    panel = Panel(sheet, (left - scale[0] * across.low, top + height + scale[1] * up.low), scale)
    grid, frame = Look("", "fixed", 1.0), Look("", "quiet", 1.0)
    for tick, name in across.ticks.items():
        panel.line([(tick, up.low), (tick, up.high)], grid)
        sheet.write(panel.px((tick, 0.0))[0, 0], top + height + 11.0, name, size=12.0)
    for tick, name in up.ticks.items():
        panel.line([(across.low, tick), (across.high, tick)], grid)
        sheet.write(left - 6.0, panel.px((0.0, tick))[0, 1], name, size=12.0, anchor="end")
    corners = [(across.low, up.low), (across.high, up.low), (across.high, up.high), (across.low, up.high)]
    panel.line(corners, frame, closed=True)
    sheet.write(left + width, top + height + 27.0, across.name, size=13.0, anchor="end")
    sheet.write(left, top - 11.0, f"{head}  {up.name}".strip(), size=13.0, anchor="start")
    return panel


def _short(value: float) -> str:
    text = f"{value:.1f}".removesuffix(".0")
    return "0" if text == "-0" else text


def unit(angle: float | Array) -> Array:
    """Return the direction u of an angle: (2,), or (n, 2) of n angles."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def turned(points: ArrayLike, angle: float) -> Array:
    """Return points (n, 2) turned counter-clockwise about the origin."""
    c, s = np.cos(angle), np.sin(angle)
    rotated: Array = np.asarray(points, dtype=np.float64) @ np.array([[c, s], [-s, c]])
    return rotated


def keep(folder: Path, pictures: Mapping[str, str], stem: str = "") -> int:
    """Write SVG files by their names, and remove those that begin with `stem` and are drawn no more; bytes in all."""
    folder.mkdir(exist_ok=True)
    for name, text in pictures.items():
        path = folder / f"{name}.svg"
        path.write_text(text, encoding="utf-8")
        print(f"{path.name}: {path.stat().st_size} bytes")
    for old in folder.glob(f"{stem}*.svg"):
        if old.stem not in pictures:
            old.unlink()
    return sum((folder / f"{name}.svg").stat().st_size for name in pictures)
