"""The frame of a chart over a turn of a cam, such as a development: SVG in px of its own, with its axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

WIDTH, LEFT, RIGHT, TOP, FOOT = 420.0, 46.0, 10.0, 8.0, 30.0  # px of a chart, and of its margins
FIELD = WIDTH - LEFT - RIGHT


def path(points: Array) -> str:
    """Return points (n, 2), px, as the data of an open path."""
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points.tolist())


def axes(tall: float, ends: tuple[float, float], along: str, upright: str, *, whole: float = 360.0) -> str:
    """Return the axes of a field `tall` px high: up to `whole` degrees along it, and numbers at both ends up it.

    `along` and `upright` name both axes.
    """
    foot = TOP + tall
    parts = []
    for k in range(5):
        x = LEFT + FIELD * k / 4.0
        parts.append(f'<line class="grid" x1="{x}" y1="{foot:.1f}" x2="{x}" y2="{foot + 4.0:.1f}"/>')
        parts.append(f'<text x="{x}" y="{foot + 14.0:.1f}" text-anchor="middle">{0.25 * whole * k:g}</text>')
    for value, y in zip(ends, (foot, TOP), strict=True):
        parts.append(f'<line class="grid" x1="{LEFT - 4.0}" y1="{y:.1f}" x2="{LEFT}" y2="{y:.1f}"/>')
        parts.append(f'<text x="{LEFT - 6.0}" y="{y + 3.5:.1f}" text-anchor="end">{value:.4g}</text>')
    parts.append(f'<text x="{LEFT + 0.5 * FIELD}" y="{foot + 26.0:.1f}" text-anchor="middle">{along}</text>')
    turned = f'transform="translate(9 {TOP + 0.5 * tall:.1f}) rotate(-90)"'
    return "".join([*parts, f'<text {turned} text-anchor="middle">{upright}</text>'])


def chart(name: str, tall: float, told: str, *parts: str, more: float = 0.0) -> str:
    """Return a chart as SVG by its id, with a field `tall` px high and `more` px below; `told` says what it shows."""
    box = f"0 0 {WIDTH:g} {TOP + tall + FOOT + more:.1f}"
    return f'<svg id="{name}" class="chart" role="img" aria-label="{told}" viewBox="{box}">{"".join(parts)}</svg>'


def field(tall: float) -> str:
    """Return the ground of a field `tall` px high."""
    return f'<rect class="field" x="{LEFT}" y="{TOP}" width="{FIELD}" height="{tall:.1f}"/>'


def clip(name: str, tall: float) -> str:
    """Return the clip path of a field `tall` px high, by its id."""
    return f'<clipPath id="{name}"><rect x="{LEFT}" y="{TOP}" width="{FIELD}" height="{tall:.1f}"/></clipPath>'
