"""The disc that is drawn: its outlines as they lie in the drawing, its section, its sizes in words. mm."""

from __future__ import annotations

import math
from itertools import pairwise
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
    from camgeo.part.shapes import Opening
    from kin.numeric.arrays import Array

SAGITTA = 2e-3  # of an arc's radius: greatest height of an arc over its chords, far below the width of a line
MOST_CHORDS = 90  # of one arc
NO_LINE = 1e-3  # mm: what is shorter is not drawn
ENDS = 2  # round ones of a slot
MOST_BEYOND = 16  # circles that cover what of a bore is beyond the greatest circle within it
IN_PLANE = 1e-6  # rad: directions this near to the cutting plane lie in it


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
    def bore(self) -> Array:
        """Points (n, 2) of the bore's outline, mm; (0, 2) without a bore."""
        return next((loop.points for loop in self.loops if loop.layer == "BORE"), np.empty((0, 2)))

    @property
    def corners(self) -> list[tuple[float, float]]:
        """Corners (x, y) of a bore that is not round, mm."""
        bores = (opening for opening in self.body.openings if opening.layer == "BORE" and opening.circle is None)
        return [(x, y) for bore in bores for x, y in bore.outline.points.tolist()]

    @property
    def holes(self) -> list[tuple[float, float, float]]:
        """Circles, x, y and radius in mm, that together cover the openings: one, or along a slot several."""
        covers = []
        for opening in self.body.openings:
            if opening.layer == "BORE":
                covers += _about(self.bore)
            elif opening.circle is not None:
                (x, y), radius = opening.circle
                covers.append((x, y, radius))
            else:
                covers += _along(opening)
        return covers

    @property
    def hidden(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """Ends, mm, of the hidden edges of radial holes in the boss, as the face shows them."""
        boss, lines = self.body.boss, []
        for hole in self.body.cross_holes:
            if boss is not None:
                c, s, half = math.cos(hole.at), math.sin(hole.at), 0.5 * hole.diameter
                inner, outer = 0.5 * (self.part.bore or 0.0), 0.5 * boss.diameter
                for off in (-half, half):
                    ends = (math.sqrt(max(radius * radius - half * half, 0.0)) for radius in (inner, outer))
                    start, end = ((along * c - off * s, along * s + off * c) for along in ends)
                    lines.append((start, end))
        return lines

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


def deviation_words(low: float, high: float) -> str:
    """Lower and upper deviation of a size, mm, as text: +0.1/0, or ± where they are the same."""
    if low == -high:
        return f"±{number(high)}"
    return "/".join(f"{'+' if each > 0.0 else ''}{number(each)}".replace("-", "−") for each in (high, low))


def _along(opening: Opening) -> list[tuple[float, float, float]]:
    """Circles along a slot with round ends that cover it; round any other opening one circle."""
    outline = opening.outline
    caps = np.flatnonzero(np.abs(outline.bulges) == 1.0)
    if len(caps) != ENDS:
        return [(*opening.middle, opening.radius)]
    start, end = (outline.points + 0.5 * outline.chords)[caps]
    radius = 0.5 * float(np.hypot(*outline.chords[caps[0]]))
    count = max(2, math.ceil(2.0 * float(np.hypot(*(end - start))) / radius) + 1)
    return [(float(x), float(y), radius) for x, y in np.linspace(start, end, count)]


def _about(bore: Array) -> list[tuple[float, float, float]]:
    """Circles that cover a bore: the greatest about the shaft within it, and others along what is farther out."""
    middles = 0.5 * (bore + np.roll(bore, -1, axis=0))
    points = np.concatenate([bore, middles])
    radii = np.hypot(*points.T)
    inner, outer = float(radii.min()), float(radii.max())
    half = 0.5 * (outer - inner)
    beyond = points[radii > inner + half] if half > NO_LINE else points[:0]
    beyond = beyond[:: len(beyond) // MOST_BEYOND + 1]
    centres = beyond * ((inner + half) / np.hypot(*beyond.T))[:, None]
    return [(0.0, 0.0, inner), *((x, y, half) for x, y in centres.tolist())]


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


def hatching(rings: Sequence[Sequence[tuple[float, float]]], pitch: float) -> list[Array]:
    """Lines at 45 degrees within an odd number of closed rings of points, mm, each (2, 2), `pitch` mm apart."""
    root = math.sqrt(0.5)
    u, v, after_u, after_v = (np.concatenate(each) for each in zip(*(_ends(ring) for ring in rings), strict=True))
    lines = []
    for level in pitch * np.arange(math.ceil(float(v.min()) / pitch), math.floor(float(v.max()) / pitch) + 1):
        crossed = np.flatnonzero((v <= level) != (after_v <= level))
        places = np.sort(u[crossed] + (level - v[crossed]) / (after_v - v)[crossed] * (after_u - u)[crossed])
        for start, end in zip(places[::2], places[1::2], strict=True):
            if end - start > NO_LINE:
                ends = np.array([(start, level), (end, level)])
                lines.append(root * np.column_stack([ends[:, 0] - ends[:, 1], ends[:, 0] + ends[:, 1]]))
    return lines


def _ends(ring: Sequence[tuple[float, float]]) -> tuple[Array, Array, Array, Array]:
    """Ends of a ring's chords along and across the hatching, mm, (n,) each: both of the first, both of the next."""
    points, root = np.array(ring), math.sqrt(0.5)
    u, v = root * (points[:, 0] + points[:, 1]), root * (points[:, 1] - points[:, 0])
    return u, v, np.roll(u, -1), np.roll(v, -1)


# --- what is seen behind the cutting plane ----------------------------------------------------------------------------


def section_edges(
    drawn: DrawnDisc, sense: float
) -> tuple[list[list[tuple[float, float]]], list[list[tuple[float, float]]]]:
    """Outlines of the cut metal, and edges behind the plane seen along x in a sense, 1 or -1: chains of (z, y), mm.

    Behind gaps of the metal they are rims of openings and corners of the bore; beyond the cut the edges of the disc.
    """
    body, cut = drawn.body, sections(drawn)
    whole = [loop for loop in drawn.loops if loop.through]
    ground = whole if body.pocket is None else [loop for loop in whole if not loop.surface]
    edges = []
    for upper, loops in ((False, ground), (True, whole)):
        stretches = metal(loops)
        for below, above in pairwise(stretches):
            z = _face(drawn, 0.5 * (below.high + above.low), upper=upper)
            edges.append([(z, below.high), (z, above.low)])
    for x, y in drawn.corners:
        if sense * x > 0.0 and _in_sight(drawn, (x, y)):
            within = _face(drawn, y, upper=False), _face(drawn, y, upper=True)
            edges.append([(within[0], y), (within[1], y)])
    return cut, [*edges, *_beyond(drawn, sense, [height for chain in cut for _, height in chain])]


def _face(drawn: DrawnDisc, y: float, *, upper: bool) -> float:
    """Height z of the upper or the lower face of the body at a place y of the section, mm."""
    body = drawn.body
    on_boss = body.boss is not None and abs(y) < 0.5 * body.boss.diameter
    if upper:
        return body.top if on_boss else body.thickness or 0.0
    return body.bottom if on_boss else 0.0


def _in_sight(drawn: DrawnDisc, corner: tuple[float, float]) -> bool:
    """Whether nothing of the bore stands between the cutting plane and a corner of the bore."""
    x, y = corner
    points = drawn.bore
    after = np.roll(points, -1, axis=0)
    crossed = (points[:, 1] <= y) != (after[:, 1] <= y)
    share = (y - points[crossed, 1]) / (after[crossed, 1] - points[crossed, 1])
    places = points[crossed, 0] + share * (after[crossed, 0] - points[crossed, 0])
    between = (places * math.copysign(1.0, x) > 0.0) & (np.abs(places) < abs(x) - NO_LINE)
    low, high = points[:, 1].min(), points[:, 1].max()
    return not between.any() and bool(low + NO_LINE < y < high - NO_LINE)


def _beyond(drawn: DrawnDisc, sense: float, cut: Sequence[float]) -> list[list[tuple[float, float]]]:
    """Edges of the disc that reach beyond the heights y of the cut, with its chamfer."""
    thick, edges = drawn.body.thickness or 0.0, []
    outer = max((loop for loop in drawn.loops if loop.through), key=lambda loop: float(np.ptp(loop.points[:, 1])))
    beyond = outer.points[sense * outer.points[:, 0] >= 0.0, 1]
    edge = drawn.body.edge if outer.surface else 0.0
    for end, last in ((float(beyond.max()), max(cut)), (float(beyond.min()), min(cut))):
        if abs(end) > abs(last) + NO_LINE:
            face, near = end - math.copysign(edge, end), last - math.copysign(edge, end)
            edges.append([(0.0, near), (0.0, face), (edge, end), (thick - edge, end), (thick, face), (thick, near)])
            if edge:
                edges += [[(z, last), (z, end)] for z in (edge, thick - edge)]
    return edges


def screw_holes(drawn: DrawnDisc) -> list[list[tuple[float, float]]]:
    """Rectangles (z, y), mm, that radial holes in the cutting plane take from the boss."""
    boss, rings = drawn.body.boss, []
    for hole in drawn.body.cross_holes:
        if boss is not None and abs(math.cos(hole.at)) < IN_PLANE:
            side, half = math.copysign(1.0, math.sin(hole.at)), 0.5 * hole.diameter
            ends = [y for stretch in metal(drawn.loops) for y in (stretch.low, stretch.high) if side * y > 0.0]
            inner, outer = min(ends, key=abs), side * 0.5 * boss.diameter
            low, high = hole.z - half, hole.z + half
            rings.append([(low, inner), (high, inner), (high, outer), (low, outer)])
    return rings
