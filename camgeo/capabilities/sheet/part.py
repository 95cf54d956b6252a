"""The disc that is drawn: its outlines as they lie in the drawing, its section, its sizes in words. mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.pieces import ArcSpline
from camgeo.part.feature import SheetView
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.files.layer_outline import LayerOutline
    from camgeo.part.body import Body
    from camgeo.part.part import Part
    from kin.numeric.arrays import Array

SAGITTA = 2e-3  # of an arc's radius: greatest height of an arc over its chords, far below the width of a line
MOST_CHORDS = 90  # of one arc


@dataclass(frozen=True, eq=False)
class Loop:
    """Closed outline: points (n, 2), mm, its DXF layer, whether it is cut through, and whether it is a cam contour."""

    points: Array
    layer: str
    through: bool = True
    surface: bool = False


@dataclass(frozen=True, eq=False)
class DrawnDisc:
    """Disc as it is drawn, in mm: its loops, its body and the recipe's part; with `ccw` directions are mirrored."""

    loops: tuple[Loop, ...]
    body: Body
    part: Part
    ccw: bool

    @property
    def reach(self) -> float:
        """Greatest distance of an outline, or of the boss, from the shaft, mm."""
        far = max(float(np.hypot(*loop.points.T).max()) for loop in self.loops)
        return far if self.body.boss is None else max(far, 0.5 * self.body.boss.diameter)

    @property
    def depth(self) -> float:
        """Length of the body along the shaft, mm."""
        return self.body.top - self.body.bottom

    @property
    def view(self) -> SheetView:
        """View by which features write their own sizes."""
        openings = {opening.name: opening for opening in self.body.openings}
        return SheetView(self.part, openings, number, self.degrees, self.direction)

    def direction(self, at: float) -> float:
        """Direction of a feature in the drawing, rad, from its direction `at` in the recipe, rad."""
        return -at if self.ccw else at

    def degrees(self, at: float) -> str:
        """Direction in the drawing of a feature at `at` in the recipe, rad, as text: 0 to below 360 with the sign °."""
        angle = math.degrees(self.direction(at)) % 360.0
        return f"{number(angle if angle < 359.99995 else 0.0)}°"


def number(value: float) -> str:
    """A size in mm or degrees with four decimals at most."""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in {"-0", ""} else text


def chords(outline: ArcSpline) -> Array:
    """Points (n, 2) along arcs and lines, mm, for drawing: chords off an arc by less than SAGITTA of its radius."""
    starts, bulges = outline.points, outline.bulges
    ends = np.roll(starts, -1, axis=0)
    sweep = 4.0 * np.arctan(bulges)
    counts = np.clip(np.ceil(np.abs(sweep) / math.acos(1.0 - SAGITTA)), 1, MOST_CHORDS).astype(int)
    piece = np.repeat(np.arange(len(starts)), counts)
    share = (np.arange(len(piece)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[piece]
    # a chord's point seen along it and beside it, from the arc's half angle
    half = 0.5 * sweep[piece]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.where(half == 0.0, share, 0.5 + 0.5 * np.sin((2.0 * share - 1.0) * half) / np.sin(half))
        beside = np.where(half == 0.0, 0.0, -0.5 * (np.cos((2.0 * share - 1.0) * half) - np.cos(half)) / np.sin(half))
    chord = (ends - starts)[piece]
    left = np.column_stack([-chord[:, 1], chord[:, 0]])
    points: Array = starts[piece] + along[:, None] * chord + beside[:, None] * left
    return points


def disc_loops(outlines: Sequence[LayerOutline], body: Body, contours: int) -> tuple[Loop, ...]:
    """Loops of a disc's outlines: first `contours` contours, last its openings; raises TypeError for no arcs."""
    depths = [opening.depth for opening in body.openings]
    through = [True] * (len(outlines) - len(depths)) + [depth is None for depth in depths]
    loops = []
    for k, outline in enumerate(outlines):
        if not isinstance(outline.outline, ArcSpline):
            raise TypeError("a shop drawing is made of arcs")
        loops.append(Loop(chords(outline.outline), outline.layer, through[k], k < contours))
    return tuple(loops)


# --- the section through the shaft, across the axis at 0 --------------------------------------------------------------


@dataclass(frozen=True)
class SectionMetal:
    """Metal in the section from y `low` to `high`, mm, and whether these ends lie on a cam contour."""

    low: float
    high: float
    low_contour: bool
    high_contour: bool


def metal(loops: Sequence[Loop]) -> list[SectionMetal]:
    """Stretches of the y axis that are metal, by rising y: those within an odd number of loops."""
    ends = []
    for loop in loops:
        x, y = loop.points.T
        after_x, after_y = np.roll(x, -1), np.roll(y, -1)
        for k in np.flatnonzero((x <= 0.0) != (after_x <= 0.0)):
            t = x[k] / (x[k] - after_x[k])
            ends.append((float(y[k] + t * (after_y[k] - y[k])), loop.surface))
    ends.sort()
    pairs = zip(ends[::2], ends[1::2], strict=True)
    return [SectionMetal(low, high, at_low, at_high) for (low, at_low), (high, at_high) in pairs]


def sections(drawn: DrawnDisc) -> list[list[tuple[float, float]]]:
    """Outlines of the cut metal, as closed chains of points (z, y), mm, z from the lower face of the disc.

    A groove is as deep as its pocket. A chamfer is drawn as if the section met the contour at right angles.
    """
    body = drawn.body
    thick, boss = body.thickness or 0.0, body.boss
    whole = [loop for loop in drawn.loops if loop.through]
    floor = thick if body.pocket is None else thick - body.pocket
    reach = 0.0 if boss is None else 0.5 * boss.diameter
    ground = whole if body.pocket is None else [loop for loop in whole if not loop.surface]
    chains = []
    for base in metal(ground):
        above = (
            [base] if body.pocket is None else [other for other in metal(whole) if base.low <= other.low < base.high]
        )
        stretch = max(base.low, -reach), min(base.high, reach)
        low = _side(base, [base], (0.0, 0.0), (body.bottom, stretch), body.edge)
        high = _side(base, above, (floor, thick), (body.top, stretch), -body.edge)
        chains.append([*low, *reversed(high)])
    return chains


def _side(
    stretch: SectionMetal,
    raised: Sequence[SectionMetal],
    heights: tuple[float, float],
    boss: tuple[float, tuple[float, float]],
    chamfer: float,
) -> list[tuple[float, float]]:
    """Points (height, y), mm, of one face of a stretch in the section, by rising y: ground, raised metal, boss.

    `heights` are those of the ground and of the raised metal, `boss` is the height of the boss and its ends in y;
    `chamfer` is how far an edge lies behind the face, with a sign along z.
    """
    ground, face = heights
    far, (low, high) = boss
    cut, chain = abs(chamfer), list[tuple[float, float]]()
    if stretch.low < raised[0].low:
        chain.append((ground, stretch.low))
    for k, each in enumerate(raised):
        if k or stretch.low < each.low:
            chain.append((ground, each.low))
        chain += (
            [(face + chamfer, each.low), (face, each.low + cut)] if each.low_contour and cut else [(face, each.low)]
        )
        if far != face and each.low <= low < high <= each.high:
            chain += [(face, low), (far, low), (far, high), (face, high)]
        chain += (
            [(face, each.high - cut), (face + chamfer, each.high)] if each.high_contour and cut else [(face, each.high)]
        )
        if k + 1 < len(raised) or each.high < stretch.high:
            chain.append((ground, each.high))
    if raised[-1].high < stretch.high:
        chain.append((ground, stretch.high))
    return [point for k, point in enumerate(chain) if not k or point != chain[k - 1]]


def hatching(chains: Sequence[Sequence[tuple[float, float]]], pitch: float) -> list[Array]:
    """Lines at 45 degrees within closed chains of points, mm, each line (2, 2), `pitch` mm apart."""
    lines = []
    root = math.sqrt(0.5)
    for chain in chains:
        points = np.array(chain)
        u, v = root * (points[:, 0] + points[:, 1]), root * (points[:, 1] - points[:, 0])
        after_u, after_v = np.roll(u, -1), np.roll(v, -1)
        for level in pitch * np.arange(math.ceil(float(v.min()) / pitch), math.floor(float(v.max()) / pitch) + 1):
            crossed = np.flatnonzero((v <= level) != (after_v <= level))
            places = np.sort(u[crossed] + (level - v[crossed]) / (after_v - v)[crossed] * (after_u - u)[crossed])
            for start, end in zip(places[::2], places[1::2], strict=True):
                ends = np.array([(start, level), (end, level)])
                lines.append(root * np.column_stack([ends[:, 0] - ends[:, 1], ends[:, 0] + ends[:, 1]]))
    return lines
