"""Overlays of a page that a recipe lists: constructions of the papers over the mechanism, turning with the shaft.

Instant centres and contact normals of a yoke (SW Figure 1); chord polygon, isoptic circle and pedal of two contacts on
one arm (W Figures 4, 5, 8, 9 and section 5); the evolute of any contour. At step k of STEPS the shaft angle is k/STEPS
of a turn.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import Ring, disc
from camgeo.report.page.followers import SHAFT
from camgeo.report.page.scene import OVERLAYS, FilledShape, Letter, MovingBody, poses, still
from camgeo.synthesis.view import Drawer, View, entry
from kin.law.contacts import Flat, Oscillating, Roller, Translating
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.cams.surface import Surface
    from kin.law.contacts import Arrangement, Guide, Touch
    from kin.numeric.arrays import Array

POINTS = 720  # of a curve on the cam
MOST_CHORDS = 100
LEAP = 0.1  # of the distance FAR: points of an evolute farther apart than this are not joined
SLIGHT = 0.06  # of the distance FAR: a piece of an evolute no longer than this is left out
FAR = 1.6  # of the cam's reach: an evolute is drawn up to this distance from the shaft
LINE, DOT, CURVE = "construction", "overlay dot", "overlay"


@dataclass(frozen=True, eq=False)
class Stage:
    """A design over a turn, as overlays need it.

    `turned` is the angle of the cam's axes, `relative` the angle between cam and frame, (STEPS + 1,) each, rad. `reach`
    is the cam's greatest radius, `size` the size of a joint, mm.
    """

    view: View[Guide, Touch]
    turned: Array
    relative: Array
    reach: float
    size: float

    def on_cam(self, name: str, rings: Sequence[Ring], role: str = CURVE) -> MovingBody:
        """Return curves that turn with the cam."""
        return MovingBody(name, OVERLAYS, (FilledShape(role, tuple(rings), name),), poses(0.0, 0.0, self.turned))

    def dot(self, name: str, places: Array, letter: str = "") -> MovingBody:
        """Return a dot at complex places (n,), mm, n of STEPS + 1 or 1."""
        labels = (Letter(letter, 0.0, 0.0),) if letter else ()
        shape = FilledShape(DOT, (disc(0.0, 0.0, 0.5 * self.size),), name)
        return MovingBody(name, OVERLAYS, (shape,), poses(places.real, places.imag, 0.0), labels)

    def line(self, name: str, places: Array, direction: Array, ends: tuple[float, float]) -> MovingBody:
        """Return a straight line through complex places (n,), mm, along complex directions (n,).

        It runs between two distances from its place, `ends`, mm.
        """
        angle = np.unwrap(np.angle(direction))
        shape = FilledShape(LINE, (_ring(np.array(ends)),), name)
        return MovingBody(name, OVERLAYS, (shape,), poses(places.real, places.imag, angle))


def overlay_bodies(names: Sequence[str], stage: Stage) -> list[MovingBody]:
    """Return the bodies of the overlays with these names; raises KeyError for an unknown name."""
    return [body for name in names for body in MADE[name](stage)]


def _evolute(stage: Stage) -> list[MovingBody]:
    """Evolute of each contour, and the centre of curvature at contact 1; a roller's pitch curve has the same evolute.

    Where derivatives of the law jump the evolute leaps along the normal; where the curve is straight it is far away.
    """
    exact, far = stage.view.design.exact, FAR * stage.reach
    places = np.unique(np.concatenate([[0.0, TURN], exact.breaks]))
    bodies = []
    for surface in exact.surfaces:
        rings = []
        # smooth stretches between breaks; the ends lie just inside, where derivatives are those of the stretch
        for low, high in pairwise(places.tolist()):
            t = np.linspace(low, high, max(3, math.ceil(POINTS * (high - low) / TURN)))
            t[[0, -1]] += 1e-9 * (high - low) * np.array([1.0, -1.0])
            centres = _centre(surface, t)
            leaps = np.diff(np.abs(centres) <= far) | (np.abs(np.diff(centres)) > LEAP * far)
            parts = np.split(centres, np.flatnonzero(leaps) + 1)
            long = [part for part in parts if max(np.ptp(part.real), np.ptp(part.imag)) > SLIGHT * far]
            rings += [_ring(part) for part in long if abs(part[0]) <= far]
        if rings:
            bodies.append(stage.on_cam(f"evolute, {surface.name}" if surface.name else "evolute", rings))
    # the centre of contact 1, in its place on the turning cam; where it is too far off, the dot stays on the contact
    surface, standing = stage.view.surface(stage.view.contacts[0]), np.exp(1j * stage.turned)
    t = np.mod(next(iter(exact.motion.parameters(SHAFT, stage.relative).values())), TURN)
    frame, centre = surface.curve.sample(t), _centre(surface, t) * standing
    contact = _complex(frame.point) * standing
    dot = np.where(np.abs(centre) > far, contact, centre)
    normal = stage.line("normal of the contact", contact, -_complex(frame.normal) * standing, (0.0, far))
    return [*bodies, normal, stage.dot("centre of curvature", dot)]


def _centre(surface: Surface, t: Array) -> Array:
    """Centres of curvature (n,) at parameters, complex; 1e9 times as far as the curve where that is straight."""
    frame = surface.base.sample(t)
    most = 1e9 * float(np.abs(frame.point).max())
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = np.clip(np.nan_to_num(frame.speed / frame.turn, nan=most), -most, most)
    return _complex(frame.point) - radius * _complex(frame.normal)


def _instant_centres(view: View[Translating, Flat], stage: Stage) -> list[MovingBody]:
    """SW Figure 1: frame 1, cam 2, follower 3. I12 is the shaft, I13 infinitely far across the follower's line.

    I23 = Q lies on the line of these two, S' from the shaft (SW 10), and on the contacts' normals.
    """
    slope, far = view.travel(SHAFT, 1)[1], 1.25 * stage.reach
    q = 1j * slope
    across = FilledShape(LINE, (Ring.through([(0.0, -far), (0.0, far)], closed=False),), "line of the instant centres")
    away = (Letter("I₁₃ → ∞", 0.0, 0.9 * far),)
    breadth = view.contacts[-1].datum if len(view.contacts) > 1 else 0.0
    ends = (-max(far, breadth), far)
    return [
        MovingBody("line of the instant centres", OVERLAYS, (across,), still(), away),
        stage.line("normals of the contacts", q, np.ones_like(q), ends),
        stage.dot("instant centre of cam and frame", np.zeros(1, dtype=complex), "I₁₂"),
        stage.dot("instant centre of cam and follower", q, "I₂₃ = Q"),
    ]


@dataclass(frozen=True, eq=False)
class Arms:
    """Two contacts on one arm (W 4.1): arms of length l, mm, with the angle 2 alpha between them.

    `psi` gives the swing, rad, at shaft angles (n,), rad.
    """

    length: float
    alpha: float
    psi: Callable[[Array], Array]

    def ends(self, shaft: Array) -> tuple[Array, Array]:
        """Ends A and B of the arms at shaft angles (n,), complex (n,), mm, the pivot on the x axis.

        Of two faces they are the feet of the perpendiculars from the shaft O.
        """
        turned = np.exp(-1j * self.psi(shaft))
        a, b = (self.length * (1.0 + turned * np.exp(1j * side * self.alpha)) for side in (-1.0, 1.0))
        return a, b


def _roller_arms(view: View[Oscillating, Roller]) -> Arms:
    return Arms(view.guide.pivot, view.contacts[0].apart, lambda shaft: view.travel(shaft)[0])


def _face_arms(view: View[Oscillating, Flat]) -> Arms:
    return Arms(0.5 * view.guide.pivot, 2.0 * view.contacts[0].apart, lambda shaft: 2.0 * view.travel(shaft)[0])


def _arms(stage: Stage) -> Arms:
    return ARMS[stage.view.design.follower.arrangement](stage.view)


def _chord_polygon(stage: Stage) -> list[MovingBody]:
    """Chords AB, 2 l sin alpha long, of successive positions of the arm, each with A where the last had B (W 4.6).

    They close after 2 lambda steps, or sooner. Each chord is a body, as the polygon changes its shape.
    """
    arms, shaft = _arms(stage), SHAFT.copy()
    chord = FilledShape(CURVE, (_ring(np.array([0.0, 2.0 * arms.length * math.sin(arms.alpha)])),), "chord")
    start = arms.ends(shaft)[0]
    bodies: list[MovingBody] = []
    while len(bodies) < MOST_CHORDS:
        a, b = (end * np.exp(1j * (shaft - SHAFT)) for end in arms.ends(shaft))
        if bodies and np.abs(a - start).max() < 1e-6 * arms.length:
            break
        angle = np.unwrap(np.angle(b - a))
        bodies.append(MovingBody(f"chord {len(bodies) + 1}", OVERLAYS, (chord,), poses(a.real, a.imag, angle)))
        shaft = shaft - arms.psi(shaft) + arms.alpha
    return bodies


def _isoptic(stage: Stage) -> list[MovingBody]:
    """Faces square to OA at A and to OB at B: their corner stays on the circle of radius 2 l (W section 5)."""
    arms = _arms(stage)
    corner = np.full(SHAFT.shape, 2.0 * arms.length, dtype=complex)
    circle = FilledShape(CURVE, (disc(0.0, 0.0, 2.0 * arms.length),), "isoptic circle, 2 l")
    bodies = [MovingBody("isoptic circle", OVERLAYS, (circle,), still())]
    surface = stage.view.surface(stage.view.contacts[0])
    if surface.radius:
        bodies.append(stage.on_cam("curve of the faces", [_ring(_face_envelope(surface), closed=True)]))
    ends = arms.ends(SHAFT)
    beyond = max(float(np.abs(corner - end).max()) for end in ends) + 0.4 * arms.length
    for name, end in zip("AB", ends, strict=True):
        bodies.append(stage.line(f"face through {name}", corner, end - corner, (-0.3 * arms.length, beyond)))
    return [*bodies, stage.dot("corner of the faces", corner[:1])]


def _pedal(stage: Stage) -> list[MovingBody]:
    """The feet A and B of the perpendiculars from O to the faces run on the pedal: the pitch curve (W section 5)."""
    arms, surface = _arms(stage), stage.view.surface(stage.view.contacts[0])
    frame = surface.base.sample(_GRID)
    point, normal = _complex(frame.point), _complex(frame.normal)
    curve = point if surface.radius else (point * normal.conj()).real * normal
    bodies = [stage.on_cam("pedal", [_ring(curve, closed=True)])]
    for name, end in zip("AB", arms.ends(SHAFT), strict=True):
        away = (0.0, float(np.abs(end).max()))
        bodies += [
            stage.line(f"perpendicular to the face through {name}", 0.0 * end, end, away),
            stage.dot(f"foot {name}", end),
        ]
    return bodies


def _face_envelope(surface: Surface) -> Array:
    """The curve c* (n,), complex, that faces square to the radii of a pitch curve at its points touch: r u + r' n."""
    frame = surface.base.sample(_GRID)
    point, along = _complex(frame.point), _complex(frame.tangent)
    ray = point / np.abs(point)
    rise = along * ray.conj()  # dr : r dtheta
    curve: Array = point + 1j * ray * np.abs(point) * rise.real / rise.imag
    return curve


_GRID = np.linspace(0.0, TURN, POINTS, endpoint=False)


def _complex(points: Array) -> Array:
    values: Array = points[:, 0] + 1j * points[:, 1]
    return values


def _ring(points: Array, *, closed: bool = False) -> Ring:
    """Ring through complex or real points (n,)."""
    return Ring.through(np.column_stack([points.real, points.imag]), closed=closed)


ARMS: dict[Arrangement, Drawer[[], Arms]] = dict(
    [entry(Oscillating, Roller, _roller_arms, 2), entry(Oscillating, Flat, _face_arms, 2)]
)
YOKE: dict[Arrangement, Drawer[[Stage], list[MovingBody]]] = dict(
    [entry(Translating, Flat, _instant_centres), entry(Translating, Flat, _instant_centres, 2)]
)
MADE: dict[str, Callable[[Stage], list[MovingBody]]] = {
    "instant-centres": lambda stage: YOKE[stage.view.design.follower.arrangement](stage.view, stage),
    "chord-polygon": _chord_polygon,
    "isoptic": _isoptic,
    "pedal": _pedal,
    "evolute": _evolute,
}
"""Function that makes each overlay of `camgeo.recipe.export.OVERLAYS`."""
