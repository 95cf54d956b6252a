"""Checks that no bodies of a mechanism meet over the whole turn, and that their fits have clearance."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.checks import CLEARANCE, COLLISION
from camgeo.capabilities.mechanism.poses import Turning
from camgeo.fit.pieces import Polygon
from kin.contour.contour import Contour
from kin.mechanism.clearance import Mover, Slab, clearances
from kin.mechanism.pose import Sampled, Still
from kin.mechanism.pose import Turning as Steady
from kin.mechanism.sweep import swept_box
from kin.numeric.angles import TURN
from kin.numeric.check import Check
from kin.numeric.lengths import UNIT, length_words, place_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from camgeo.capabilities.mechanism.assembly import Assembly, Place, Plate
    from camgeo.fit.pieces import ArcSpline
    from kin.mechanism.clearance import Clearance
    from kin.mechanism.pose import PlaneMotion

STEPS = 720  # of a turn, at which the exact motion and its rates are sampled
POINTS = 24  # of each line and arc of a hole, from which walls are measured
AXIAL = 1e-6  # mm, allowed for rounding of an axial gap
COARSE = 0.25  # mm, within which the size of all bodies is reported
ACCURACY = 0.05  # of the clearance, to which the least distance of two bodies is found


def collision_checks(assembly: Assembly) -> list[Check]:
    """The check of the least running clearance, and for each pair of bodies that might meet a check of its distance.

    Pairs whose heights are at least the axial gap apart cannot meet. Bodies pressed together, and bodies that touch by
    design, are left out: rollers and a single face are judged against the file of the cam itself. Distances are in mm.
    """
    s, bodies = assembly.sizes, movers(assembly)
    pairs = clearances(bodies, exempt_pairs(assembly), axial=s.gap - AXIAL, accuracy=ACCURACY * s.clearance)
    return [clearance_check(assembly, bodies), *(_pair_check(pair) for pair in pairs)]


def clearance_check(assembly: Assembly, bodies: Sequence[Mover]) -> Check:
    """Check that the least running clearance, mm, is above 0.

    Its detail states all fits, the excess by which the shaft drives the cam, the thinnest wall, and the size of the box
    that all bodies sweep.
    """
    running = [fit for fit in assembly.fits if not fit.pressed]
    least = min(fit.clearance for fit in running)
    fits = [f"{fit.name} {'-' if fit.pressed else ''}{length_words(fit.clearance)}" for fit in assembly.fits]
    driving = [
        f"{fit.name} drives: {length_words(fit.excess, '.4g')} {UNIT} too wide to slip round"
        for fit in assembly.fits
        if fit.excess is not None
    ]
    wall, where = thinnest_wall(assembly)
    thin = f"thinnest wall {length_words(wall, '.3g')} {UNIT}: {where}"
    size = "takes up " + " by ".join(f"{length:.0f}" for length in swept_size(bodies)) + " mm as it turns"
    detail = "; ".join([f"{UNIT} wider by construction: {', '.join(fits)}", *driving, thin, size, *assembly.remarks])
    return Check(CLEARANCE.name, least > 0.0, least, 0.0, "mm", None, "at_least", detail=detail)


def thinnest_wall(assembly: Assembly) -> tuple[float, str]:
    """Least thickness or wall of all bodies but the cam, mm, and the name of the body.

    The name is `links` or `retainers` for the thickness that all of these share. Walls are measured between two edges
    of one plate, from points along the holes. The cam's walls have a check of their own.
    """
    s = assembly.sizes
    walls = [(s.link, "links"), (s.clip, "retainers")]
    for member in assembly.members[1:]:
        for plate in member.plates:
            edges = [_contour(plate.outline), *map(_contour, plate.holes)]
            for edge, hole in combinations(edges, 2):
                walls.append((float(edge.distance(hole.sample(POINTS)).min()), member.name))
    return min(walls)


def exempt_pairs(assembly: Assembly) -> Iterable[frozenset[str]]:
    """Pairs of names of bodies that may touch: pressed together, or in contact by design."""
    for first, second in combinations(assembly.members, 2):
        pair = frozenset({first.name, second.name})
        if first.group == second.group or pair in assembly.touching:
            yield pair


def swept_size(bodies: Sequence[Mover]) -> tuple[float, float, float]:
    """Length, width and height of the box that holds all bodies at every angle, mm.

    Each of its four upright sides may lie too far out by COARSE; the height is exact.
    """
    boxes = np.array([swept_box(body, COARSE) for body in bodies])
    (left, bottom), (right, top) = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    heights = [height for body in bodies for slab in body.slabs for height in (slab.low, slab.high)]
    return float(right - left), float(top - bottom), max(heights) - min(heights)


def movers(assembly: Assembly) -> list[Mover]:
    """Bodies with their motions, for `clearances`; bodies that share a place share the motion."""
    motions: dict[int, PlaneMotion] = {}
    bodies = []
    for member in assembly.members:
        key = id(member.place)
        if key not in motions:
            motions[key] = _motion(member.place)
        bodies.append(Mover(member.name, slabs(member.plates), motions[key]))
    return bodies


def _motion(place: Place | None) -> PlaneMotion:
    """Motion of a place, exact for a body at rest or turning steadily, else cubic between samples with rates."""
    if place is None:
        return Still()
    if isinstance(place, Turning):
        return Steady(-1.0, angle=place.start)
    rows = place(TURN * np.arange(STEPS + 1) / STEPS, 1)
    pose, rate = rows[:, 0].T.copy(), rows[:, 1].T.copy()
    pose[:, 2] = np.unwrap(pose[:, 2])
    return Sampled(pose, rate)


def slabs(plates: Sequence[Plate]) -> tuple[Slab, ...]:
    """Slabs with the outlines, holes and heights of plates, mm."""
    return tuple(Slab(_contour(p.outline), tuple(map(_contour, p.holes)), p.low, p.high) for p in plates)


def _contour(outline: ArcSpline | Polygon) -> Contour:
    if isinstance(outline, Polygon):
        return Contour.from_vertices(outline.vertices)
    return Contour.from_bulges(outline.points, outline.bulges)


def _pair_check(pair: Clearance) -> Check:
    """Check that two bodies keep apart: their least distance, mm, less what is not proved of it, above 0."""
    x, y = pair.place
    least = min(pair.least, pair.proved) - pair.slack
    if pair.holds:
        detail = f"{pair.a} and {pair.b}"
    elif pair.collides:
        detail = f"{pair.a} and {pair.b} interfere, near {place_words(x, y, digits=4)} {UNIT}"
    else:
        detail = f"{pair.a} and {pair.b}: no clearance is proved, {length_words(pair.least, '.4g')} {UNIT} was found"
    return Check(COLLISION.name, pair.holds, least, 0.0, "mm", pair.at_deg, "at_least", detail=detail)
