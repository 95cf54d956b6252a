"""The follower as it stands on a disc where the motion begins, in phantom lines, with its sizes.

The figure is the recipe's own data of the contacts; no contour is solved for it. Lengths are mm; the disc lies as it is
drawn, the ray at 0 along x.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sheet.callouts import (
    APART,
    ColumnCallout,
    PlacedCallout,
    Room,
    draw_callouts,
    knees_about,
    place_callouts,
)
from camgeo.capabilities.sheet.lettering import PLAIN
from camgeo.capabilities.sheet.marks import THIN, CircleMark, LineMark, shifted
from camgeo.capabilities.sheet.options import SCALES
from camgeo.capabilities.sheet.part import number
from kin.law.contacts import Flat, KnifeEdge, Oscillating, Shoe, Translating
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Iterable

    from camgeo.capabilities.sheet.frame import Area
    from camgeo.capabilities.sheet.marks import Page, Pattern, Point
    from camgeo.capabilities.sheet.part import DrawnDisc
    from camgeo.synthesis.design import Design
    from kin.law.contacts import Contact, Guide, Touch
    from kin.numeric.arrays import Array

BAR = 0.6  # of a roller's radius: half the width of arm or stem
STEM, FACE = 0.6, 0.8  # of the disc's reach: length of a stem, half that of a face whose width is not stated
SLIM = 0.06  # of the disc's reach: half the width of a stem or an arm without a roller, radius of a pivot
SIDE = 12.0  # mm of paper between the figure and its callouts
DOTS = 3.0  # mm of paper between places of a line of travel that leaders keep clear of
TITLE = 9.0  # mm above the figure
NO_SIZE = 5e-5  # mm or degrees: what the sheet's numbers show as 0


@dataclass(eq=False)
class FollowerFigure:
    """Lines (n, 2) of a follower with their pattern, circles about points, and the sizes of its parts, mm."""

    lines: list[tuple[Array, Pattern]] = field(default_factory=list)
    circles: list[tuple[Point, float]] = field(default_factory=list)
    sizes: list[ColumnCallout] = field(default_factory=list)

    @property
    def points(self) -> Array:
        """Points (n, 2), mm, that enclose the figure."""
        corners = [np.array(centre) + radius * _CORNERS for centre, radius in self.circles]
        return np.concatenate([*(points for points, _ in self.lines), *corners])


_CORNERS = np.array([[-1.0, -1.0], [1.0, 1.0]])


class _Frame(NamedTuple):
    """Frame of a guide in the drawing: turned by an angle, rad, and mirrored where the shaft turns the other way."""

    turned: float
    mirrored: bool

    def placed(self, points: Iterable[Point]) -> Array:
        """Points (n, 2) of the guide's frame in the drawing, mm."""
        c, s = math.cos(self.turned), math.sin(self.turned)
        placed: Array = np.array(list(points)) @ np.array([[c, s], [-s, c]])
        return placed * np.array([1.0, -1.0]) if self.mirrored else placed


def follower_figure(design: Design, drawn: DrawnDisc) -> FollowerFigure:
    """The follower on a disc at shaft angle 0, by its contacts with the surfaces of the disc."""
    figure = FollowerFigure()
    position = float(design.motion.travel(np.zeros(1), 0)[0, 0])
    names = {surface.name for surface, _ in design.contours}
    seen = set[object]()
    for contact in design.follower.contacts:
        if contact.surface in names and contact.place not in seen:
            seen.add(contact.place)
            _add(figure, contact, float(contact.own(np.array([position]))[0]), drawn)
    figure.sizes[:] = _merged(figure.sizes)
    return figure


def _add(figure: FollowerFigure, contact: Contact[Guide, Touch], own: float, drawn: DrawnDisc) -> None:
    """Add one contact at its own position, mm or rad, with its guide."""
    frame = _Frame(contact.turned, drawn.ccw)
    match contact.guide, contact.touch:
        case Translating(offset=offset), Flat() as face:
            _add_face(figure, frame, face, (own, offset), drawn)
        case Oscillating(pivot=pivot, side=side), Flat(nearer=nearer):
            away = (-math.cos(own), -side * math.sin(own))
            # the arm's own line runs through the pivot, its face beside it on the side of the shaft
            inward = (-away[1] * side, away[0] * side)
            inward = inward if inward[0] * pivot < 0.0 else (-inward[0], -inward[1])
            ends = [
                (pivot + t * away[0] + nearer * inward[0], t * away[1] + nearer * inward[1]) for t in (0.0, 1.5 * pivot)
            ]
            face_line = frame.placed(ends)
            figure.lines.append((face_line, "phantom"))
            middle = tuple(face_line.mean(axis=0).tolist())
            words = (f"{number(nearer)} beside the pivot",) if abs(nearer) > NO_SIZE else ()
            figure.sizes.append(ColumnCallout("flat face", words, points=(middle,)))
            _add_pivot(figure, frame, pivot, SLIM * drawn.reach)
        case Translating(offset=offset), touch:
            centre = (own, offset)
            half = BAR * touch.radius or SLIM * drawn.reach
            _add_round(figure, frame, touch, centre, drawn)
            end = own + max(STEM * drawn.reach, 2.0 * touch.radius)
            figure.lines.append((frame.placed([(0.0, offset), (end + half, offset)]), "chain"))
            for y in (offset - half, offset + half):
                figure.lines.append((frame.placed([(own, y), (end, y)]), "phantom"))
            if abs(offset) > NO_SIZE:
                on_line = tuple(frame.placed([(end, offset)])[0].tolist())
                figure.sizes.append(ColumnCallout(f"offset {number(abs(offset))}", points=(on_line,)))
        case Oscillating(pivot=pivot, side=side, length=length), touch:
            long = length or 0.0
            away = (-math.cos(own), -side * math.sin(own))
            centre = (pivot + long * away[0], long * away[1])
            half = BAR * touch.radius or SLIM * drawn.reach
            _add_round(figure, frame, touch, centre, drawn)
            for off in (-half, half):
                beside = [(x - off * away[1], y + off * away[0]) for x, y in ((pivot, 0.0), centre)]
                figure.lines.append((frame.placed(beside), "phantom"))
            middle = tuple(frame.placed([(0.5 * (pivot + centre[0]), 0.5 * centre[1])])[0].tolist())
            figure.sizes.append(ColumnCallout(f"arm {number(long)}", points=(middle,)))
            _add_pivot(figure, frame, pivot, half)


def _add_round(figure: FollowerFigure, frame: _Frame, touch: Touch, centre: Point, drawn: DrawnDisc) -> None:
    """Add a roller, a shoe or a knife edge about its centre in the guide's frame."""
    ((x, y),) = frame.placed([centre]).tolist()
    where = f"centre X{number(x)} Y{number(y)}"
    if isinstance(touch, KnifeEdge):
        size = 3.0 * SLIM * drawn.reach
        edge = [(centre[0] + size, centre[1] - 0.4 * size), centre, (centre[0] + size, centre[1] + 0.4 * size)]
        figure.lines.append((frame.placed(edge), "phantom"))
        figure.sizes.append(ColumnCallout("knife edge", (where.replace("centre", "at"),), points=((x, y),)))
        return
    figure.circles.append(((x, y), touch.radius))
    text = f"R{number(touch.radius)} shoe" if isinstance(touch, Shoe) else f"Ø{number(2.0 * touch.radius)} roller"
    figure.sizes.append(ColumnCallout(text, (where,), circles=(((x, y), touch.radius),)))


def _add_face(figure: FollowerFigure, frame: _Frame, face: Flat, middle: Point, drawn: DrawnDisc) -> None:
    """Add a flat face on a line of travel, its middle in the guide's frame, and the stem."""
    along = (-math.sin(face.tilt), math.cos(face.tilt))
    half = 0.5 * face.width if face.width is not None else FACE * drawn.reach
    x, y = middle
    line = frame.placed([(x + t * along[0], y + t * along[1]) for t in (-half, half)])
    figure.lines.append((line, "phantom"))
    slim, end = SLIM * drawn.reach, x + STEM * drawn.reach
    figure.lines.append((frame.placed([(0.0, y), (end + slim, y)]), "chain"))
    for side in (-slim, slim):
        foot = x - side * math.tan(face.tilt)
        figure.lines.append((frame.placed([(foot, y + side), (end, y + side)]), "phantom"))
    ((at_x, at_y),) = frame.placed([middle]).tolist()
    notes = [f"at X{number(at_x)} Y{number(at_y)}"]
    notes += [f"{number(face.width)} wide"] if face.width is not None else []
    notes += [f"tilted {number(abs(math.degrees(face.tilt)))}°"] if abs(math.degrees(face.tilt)) > NO_SIZE else []
    point = tuple((0.75 * line[0] + 0.25 * line[1]).tolist())
    other = tuple((0.25 * line[0] + 0.75 * line[1]).tolist())
    figure.sizes.append(ColumnCallout("flat face", tuple(notes), points=(point, other)))


def _add_pivot(figure: FollowerFigure, frame: _Frame, pivot: float, radius: float) -> None:
    """Add the pivot of an arm, on the ray of its guide's frame."""
    ((x, y),) = frame.placed([(pivot, 0.0)]).tolist()
    figure.circles.append(((x, y), radius))
    for u, v in ((radius + 1.0, 0.0), (0.0, radius + 1.0)):
        figure.lines.append((np.array([(x - u, y - v), (x + u, y + v)]), "chain"))
    text = f"pivot, {number(pivot)} from the shaft"
    figure.sizes.append(ColumnCallout(text, (f"X{number(x)} Y{number(y)}",), circles=(((x, y), radius),)))


def _merged(sizes: Iterable[ColumnCallout]) -> list[ColumnCallout]:
    """The callouts, those of the same words as one."""
    return list({(row.text, row.notes): row for row in sizes}.values())


# --- drawing it -------------------------------------------------------------------------------------------------------


class _Place(NamedTuple):
    """A figure's place on a page: its scale as a key of SCALES, the shaft, the middle of the figure, its callouts."""

    word: str
    shaft: Point
    middle: Point
    callouts: list[PlacedCallout]


def draw_follower(page: Page, figure: FollowerFigure, drawn: DrawnDisc, area: Area) -> None:
    """Draw a disc and its follower within an area of a page at the largest scale that fits, or say that none does."""
    place = next((found for word in SCALES if (found := _place(figure, drawn, area, word))), None)
    if place is None:
        page.text((area.left, area.high - PLAIN), "The follower is too large for this page.", PLAIN)
        return
    k, (x, y) = SCALES[place.word], place.shaft
    page.text((area.left, area.high - PLAIN), f"Follower where the motion begins, {place.word}", PLAIN)
    for loop in drawn.loops:
        page.marks.append(LineMark(shifted(loop.points, k, place.shaft), THIN, "VIEW", closed=True))
    for u, v in ((4.0, 0.0), (0.0, 4.0)):
        page.line((x - u, y - v), (x + u, y + v), layer="CENTRE")
    for points, pattern in figure.lines:
        page.marks.append(
            LineMark(shifted(points, k, place.shaft), THIN, "VIEW" if pattern == "phantom" else "CENTRE", pattern)
        )
    for (cx, cy), radius in figure.circles:
        page.marks.append(CircleMark((x + k * cx, y + k * cy), k * radius, THIN, "VIEW", "phantom"))
    draw_callouts(page, place.callouts, place.middle, k)


def _along(lines: Iterable[Array]) -> Array:
    """Circles (n, 3) along lines of travel, mm of paper: a leader beside one would be taken for it."""
    dots = [np.linspace(line[0], line[1], 2 + int(np.hypot(*(line[1] - line[0])) / DOTS)) for line in lines]
    points = np.concatenate([np.empty((0, 2)), *dots])
    return np.column_stack([points, np.full(len(points), THIN)])


def _place(figure: FollowerFigure, drawn: DrawnDisc, area: Area, word: str) -> _Place | None:
    """Place of the figure at a scale; None where it does not fit."""
    k = SCALES[word]
    points = k * np.concatenate([figure.points, *(loop.points for loop in drawn.loops)])
    low, high = points.min(axis=0), points.max(axis=0)
    wide, tall = (high - low).tolist()
    free_wide, free_tall = area.right - area.left, area.high - area.low - TITLE
    if tall > free_tall or wide + 2.0 * SIDE > free_wide:
        return None
    middle = 0.5 * (low + high)
    holes = np.array(drawn.holes).reshape(-1, 3)
    room = Room(
        left=-0.5 * wide - SIDE + APART,
        right=0.5 * wide + SIDE - APART,
        low=-0.5 * free_tall,
        high=0.5 * free_tall - 4.0,
        knees=knees_about(points - middle),
        openings=k * holes - np.array([*middle, 0.0]),
        texts=_along([k * points - middle for points, pattern in figure.lines if pattern == "chain"]),
        scale=k,
    )
    offset = middle / k
    rows = [row.moved(-offset) for row in figure.sizes]
    callouts = place_callouts(rows, room, both=True)
    if callouts is None:
        return None
    left, right = (max((each.row.wide for each in callouts if each.side == side), default=0.0) for side in (-1, 1))
    spare = free_wide - wide - 2.0 * SIDE - left - right
    if spare < 0.0:
        return None
    at = np.array([area.left + 0.5 * spare + left + SIDE + 0.5 * wide, 0.5 * (area.low + area.high - TITLE)])
    (x, y), (mx, my) = (at - middle).tolist(), at.tolist()
    return _Place(word, (x, y), (mx, my), callouts)
