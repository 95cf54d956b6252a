"""Bodies of a mechanism in the words of kin's collision, and what it finds over the whole turn as checks."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.checks import CLEARANCE, COLLISION
from camgeo.capabilities.mechanism.poses import Turning
from camgeo.fit.pieces import Polygon
from kin.clearance.clearance import Mover, Slab, clearances
from kin.clearance.pose import Sampled, Still
from kin.clearance.pose import Turning as Steady
from kin.clearance.sweep import swept_box
from kin.contour.contour import Contour
from kin.judge.check import Check
from kin.numeric.angles import TURN
from kin.numeric.lengths import UNIT, length_words, place_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from camgeo.capabilities.mechanism.assembly import Assembly, Place
    from camgeo.capabilities.mechanism.body import Plate
    from camgeo.fit.pieces import ArcSpline
    from kin.clearance.clearance import Clearance
    from kin.clearance.pose import PlaneMotion

STEPS = 720  # of a turn, at which the exact motion and its rates are taken
LOOKS = 24  # points of each line and arc of a hole from which its walls are looked at
AXIAL = 1e-6  # mm, by which rounding may make an axial gap less
COARSE = 0.25  # mm, within which the room is reported
ACCURACY = 0.05  # of the clearance, to which the least distance of two bodies is found


def collision_checks(assembly: Assembly) -> list[Check]:
    """Check that no two bodies meet at any angle, and tell the least running clearance that they are made with.

    One check for each pair that has something at common heights; bodies less than the axial gap apart in height count
    as that. What is pressed together, and what touches by design, is left out: the rollers and a single face are held
    against the file of the cam itself.
    """
    s, bodies = assembly.sizes, movers(assembly)
    found = clearances(bodies, exempt(assembly), axial=s.gap - AXIAL, accuracy=ACCURACY * s.clearance)
    return [clearance_check(assembly, bodies), *(_checked(pair) for pair in found)]


def clearance_check(assembly: Assembly, bodies: Sequence[Mover]) -> Check:
    """Tell all fits, what holds the cam on the shaft, the thinnest wall, and the room that all bodies sweep.

    The least clearance among those that run must be above 0.
    """
    running = [fit for fit in assembly.fits if not fit.pressed]
    least = min(fit.clearance for fit in running)
    told = [f"{fit.name} {'-' if fit.pressed else ''}{length_words(fit.clearance)}" for fit in assembly.fits]
    held = [
        f"{fit.name} drives: {length_words(fit.held, '.4g')} {UNIT} too wide to slip round"
        for fit in assembly.fits
        if fit.held is not None
    ]
    wall, where = thinnest(assembly)
    thin = f"thinnest wall {length_words(wall, '.3g')} {UNIT}: {where}"
    room = "takes up " + " by ".join(f"{length:.0f}" for length in swept_room(bodies)) + " mm as it turns"
    detail = "; ".join([f"{UNIT} wider by construction: {', '.join(told)}", *held, thin, room, *assembly.remarks])
    return Check(CLEARANCE.name, least > 0.0, least, 0.0, "mm", None, "at_least", detail=detail)


def thinnest(assembly: Assembly) -> tuple[float, str]:
    """Least thickness or wall of all bodies but the cam, mm, and where.

    A wall is looked for between the edges of one plate, from points along its holes. A retainer's or arm's thickness is
    as asked; the cam's walls are reported by its own check.
    """
    s = assembly.sizes
    found = [(s.link, "links"), (s.clip, "retainers")]
    for member in assembly.members[1:]:
        for plate in member.plates:
            edges = [_contour(plate.outline), *map(_contour, plate.holes)]
            for one, other in combinations(edges, 2):
                found.append((float(one.distance(other.sample(LOOKS)).min()), member.name))
    return min(found)


def exempt(assembly: Assembly) -> Iterable[frozenset[str]]:
    """Pairs that are not held against each other."""
    for one, other in combinations(assembly.members, 2):
        pair = frozenset({one.name, other.name})
        if one.group == other.group or pair in assembly.touching:
            yield pair


def swept_room(bodies: Sequence[Mover]) -> tuple[float, float, float]:
    """Length, width and height of the box that holds all bodies at every angle, mm; each side within COARSE."""
    boxes = np.array([swept_box(body, COARSE) for body in bodies])
    (left, bottom), (right, top) = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    heights = [height for body in bodies for slab in body.slabs for height in (slab.low, slab.high)]
    return float(right - left), float(top - bottom), max(heights) - min(heights)


def movers(assembly: Assembly) -> list[Mover]:
    """Bodies with their motions; those that share a place share the motion."""
    motions: dict[int, PlaneMotion] = {}
    found = []
    for member in assembly.members:
        key = id(member.place)
        if key not in motions:
            motions[key] = _motion(member.place)
        found.append(Mover(member.name, slabs(member.plates), motions[key]))
    return found


def _motion(place: Place | None) -> PlaneMotion:
    """What stands or turns steadily is that; any other motion is sampled with its rates, and cubic between."""
    if place is None:
        return Still()
    if isinstance(place, Turning):
        return Steady(-1.0, angle=place.start)
    rows = place(TURN * np.arange(STEPS + 1) / STEPS, 1)
    pose, rate = rows[:, 0].T.copy(), rows[:, 1].T.copy()
    pose[:, 2] = np.unwrap(pose[:, 2])
    return Sampled(pose, rate)


def slabs(plates: Sequence[Plate]) -> tuple[Slab, ...]:
    """Plates as slabs."""
    return tuple(Slab(_contour(p.outline), tuple(map(_contour, p.holes)), p.low, p.high) for p in plates)


def _contour(outline: ArcSpline | Polygon) -> Contour:
    if isinstance(outline, Polygon):
        return Contour.from_vertices(outline.vertices)
    return Contour.from_bulges(outline.points, outline.bulges)


def _checked(pair: Clearance) -> Check:
    x, y = pair.place
    least = min(pair.least, pair.proved) - pair.slack
    if pair.holds:
        detail = f"{pair.a} and {pair.b}"
    elif pair.collides:
        detail = f"{pair.a} and {pair.b} interfere, near {place_words(x, y, digits=4)} {UNIT}"
    else:
        detail = f"{pair.a} and {pair.b}: no clearance is proved, {length_words(pair.least, '.4g')} {UNIT} was found"
    return Check(COLLISION.name, pair.holds, least, 0.0, "mm", pair.at_deg, "at_least", detail=detail)
