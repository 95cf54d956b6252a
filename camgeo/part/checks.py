"""Every edge of a part against every other: the least wall, the pair that has it, and its place."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.rounding import downward, upward
from camgeo.curve.measures import farthest
from camgeo.part.bore import LEAST_SIZE
from camgeo.part.feature import WALL
from camgeo.part.features import FEATURES, with_records
from camgeo.part.walls import (
    NOWHERE,
    Gap,
    Looks,
    Pair,
    Possible,
    inside_gap,
    known,
    least_wall,
    outside_gap,
    to_surface,
)
from kin.numeric.check import Check

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from camgeo.part.body import Body
    from camgeo.part.shapes import Opening

MOST_NAMED = 6  # pairs named in a message
ROUND = {"bore": "part.bore", **dict(feature.round for feature in FEATURES if feature.round is not None)}
"""Beginnings of the names of round openings, and the fields that state their diameters."""
OPENING, OUTLINE = "opening", "outline"  # as edges: a surface, and the round outline about it
ROUNDING = 1e-9  # mm, by which a wall that just keeps its limit may lie below it


def bore_check(
    bore: float, surfaces: Sequence[Looks], least: float | None, shaft_deg: Callable[[float], float]
) -> Check:
    """Check the wall between a bore of this diameter, mm, and the contour, in a part without other edges.

    `least` is the recipe's least wall, mm; None where the wall only has to be above 0. `shaft_deg` gives the shaft
    angle, degrees, of a parameter of the contour.
    """
    wall, at = max(least_wall(looks, bore) for looks in surfaces)
    ok = wall > 0.0 if least is None else wall >= least
    detail = "" if ok else "bore and contour" if wall > -0.5 * bore else "the shaft lies outside the contour"
    return Check(WALL, ok, wall, least or 0.0, "mm", shaft_deg(at), "at_least", detail=detail)


def part_checks(
    body: Body, surfaces: Sequence[Looks], least: float | None, shaft_deg: Callable[[float], float]
) -> list[Check]:
    """Checks of a part: its least wall, what features check of the contour, and whether features found their places.

    `surfaces` are the contours of the disc. `least` is the recipe's least wall, mm; None where walls only have to be
    above 0. `shaft_deg` gives the shaft angle, degrees, of a parameter of the contour. A part without two edges has no
    check of walls.
    """
    checks = []
    limit = 0.0 if least is None else least
    pairs = thinnest(walls(body, surfaces), limit)
    if pairs:
        thin = [pair for pair in pairs if not _holds(pair.gap.wall, least)]
        detail = "; ".join(map(str, thin[:MOST_NAMED] or pairs[:1]))
        unnamed = len(thin) - MOST_NAMED
        ending = f"; and {unnamed} more {'pair' if unnamed == 1 else 'pairs'}" if unnamed > 0 else ""
        worst = pairs[0].gap
        at_deg = None if worst.parameter is None else shaft_deg(worst.parameter)
        detail += ending + _free_of_thin_walls(thin, body, limit)
        checks.append(Check(WALL, not thin, worst.wall, limit, "mm", at_deg, "at_least", detail=detail))
    for feature, value in with_records(body.features):
        if feature.contour is not None:
            each = ((looks.name, feature.contour(value, looks.contour, shaft_deg)) for looks in surfaces)
            checks += [replace(check, surface=name) for name, check in each]
    checks += body.checks
    return checks


def _free_of_thin_walls(thin: list[Pair], body: Body, limit: float) -> str:
    """Remedy in words: diameters of round openings, and of the outline of a ring, with which every wall is kept.

    Of two openings that of the later key is made smaller, and a hub that is too near the contour. Empty where another
    edge would have to move, where an opening would vanish, or the hub's wall round the bore.
    """
    across = {opening.name: 2.0 * opening.circle[1] for opening in body.openings if opening.circle is not None}
    boss = body.boss
    across |= {} if boss is None else {boss.name: boss.diameter}
    most: dict[str, float] = {}
    outer = 0.0
    for pair in thin:
        lack = 2.0 * (limit - pair.gap.wall)
        if pair.other == OUTLINE and pair.one.endswith(OPENING):
            outer = max(outer, lack)
            continue
        circles = [cut.circle for cut in body.openings if cut.circle is not None and cut.name in pair[:2]]
        if len(circles) == 2 and math.dist(*(centre for centre, _ in circles)) <= max(radius for _, radius in circles):
            return ""  # the middle of one lies within the other, and that of a smaller one still does
        if pair.gap.wall < 0.0 and any(cut.circle is None and cut.name in pair[:2] for cut in body.openings):
            return ""  # how far a hole and a shape with corners overlap is no diameter
        keys = {name: key for name in (pair.one, pair.other) for word, key in ROUND.items() if name.startswith(word)}
        if len(keys) > 1 and boss is not None:  # a wall between the hub and an opening, which is made smaller
            keys.pop(boss.name, None)
        own = sorted((list(ROUND.values()).index(key), key, name) for name, key in keys.items() if name in across)
        if not own:
            return ""
        _, key, name = own[-1]
        shared = len(own) == 2 and own[0][1] == key  # both are of one size
        most[key] = min(most.get(key, math.inf), across[name] - (0.5 * lack if shared else lack))
    # a hub keeps its wall round the bore
    least = 2.0 * (max((cut.radius for cut in body.openings if cut.name == "bore"), default=0.0) + LEAST_SIZE)
    if not most or min(most.values()) <= 0.0 or (boss is not None and most.get(ROUND[boss.name], math.inf) <= least):
        return ""
    remedies = [f"a {key} below {downward(size)} mm" for key, size in most.items()]
    if outer:
        remedies.append(f"a part.outer larger by more than {upward(outer)} mm")
    return f"; {' and '.join(remedies)} would do"


def _holds(wall: float, least: float | None) -> bool:
    return wall > 0.0 if least is None else wall >= least - ROUNDING


def thinnest(possible: Iterable[Possible], limit: float) -> list[Pair]:
    """Pair with the least wall and all pairs with walls up to a limit, mm, thinnest first.

    Walls whose lower bound is above both are not computed.
    """
    nearest: list[tuple[float, int, Pair]] = []
    least = math.inf
    for number, (at_least, pair) in sorted(enumerate(possible), key=lambda item: item[1].at_least):
        if at_least - ROUNDING > max(least, limit):
            break
        made = pair()
        nearest.append((made.gap.wall, number, made))
        least = min(least, made.gap.wall)
    nearest.sort()
    return [pair for wall, _, pair in nearest if wall <= max(least, limit)]


def walls(body: Body, surfaces: Sequence[Looks]) -> Iterator[Possible]:
    """Walls between all pairs of edges, not yet computed; pairs of openings that are far apart are left out."""
    yield from _outline_walls(body, surfaces)
    for opening in body.openings:
        yield to_surface(opening, body, surfaces)
    for i, first in enumerate(body.openings):
        for second in body.openings[:i]:
            apart = math.dist(first.middle, second.middle)
            if apart <= 2.0 * (first.reach + second.reach):
                yield Possible(apart - first.radius - second.radius, partial(_outside, second, first))
    for feature, value in with_records(body.features):
        if feature.walls is not None:
            yield from feature.walls(value, body, surfaces)
    if body.pocket is not None and body.thickness is not None:
        yield known("groove", "the lower face", Gap(body.thickness - body.pocket, NOWHERE))
    for opening in body.openings:
        if opening.depth is not None and body.thickness is not None:
            yield known(opening.name, "the lower face", Gap(body.thickness - opening.depth, NOWHERE))


def _outside(opening: Opening, other: Opening) -> Pair:
    return Pair(opening.name, other.name, outside_gap(other.chain, opening.chain))


def _outline_walls(body: Body, surfaces: Sequence[Looks]) -> Iterator[Possible]:
    """Walls between the round outline and the surfaces, then the openings; none for a disc without such an outline."""
    rim = body.rim
    if rim is None:
        return
    for looks in surfaces:
        far = farthest(looks.contour)
        x, y = looks.contour.sample(np.array([far.at])).point[0].tolist()
        gap = Gap(rim.radius - far.value - far.slack, (x, y), far.at)
        yield known(f"{looks.name} {OPENING}".strip(), OUTLINE, gap)
    for opening in body.openings:
        yield known(opening.name, OUTLINE, inside_gap(opening.chain, rim.chain))
