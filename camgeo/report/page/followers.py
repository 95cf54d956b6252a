"""Scenes of the followers that stand by themselves: yoke, double roller, flat pair.

The shaft turns clockwise and stands at the origin; the line from it to a follower's pivot, and the normal of face 1,
lie along +x. At step k of STEPS the shaft angle is k/STEPS of a turn. Lengths are in mm, angles in rad; `size` is the
size of a joint, by which parts are scaled, `reach` the cam's greatest radius.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import Ring, bar, box, disc
from camgeo.report.page.scene import CONTACTS, STEPS, FilledShape, Letter, MovingBody, arrow, pin, pivot, poses, still
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.synthesis.view import View
    from kin.law.contacts import Flat, Oscillating, Roller, Translating
    from kin.numeric.arrays import Array

SHAFT = TURN * np.arange(STEPS + 1) / STEPS


def cam(
    contours: list[tuple[str, tuple[Ring, ...]]],
    bore: float | None,
    size: float,
    turned: Array,
    *,
    on_it: Sequence[FilledShape] = (),
    name: str = "cam",
    role: str = "metal",
) -> MovingBody:
    """Return a disc of the cam with its contours, of which the first is shown at first, and the shapes `on_it`.

    `contours` are pairs of a name, such as a file's, and rings, the outline first; `bore` is a diameter, `turned`
    (STEPS + 1,) the angle of the disc. A thin dashed line along its own x axis shows the zero of the motion where the
    part has no timing mark: a full line would look like a mark to be made.
    """
    hole = 0.5 * bore if bore else 0.0
    shapes = [
        FilledShape(f"{role} other" if index else role, rings, file) for index, (file, rings) in enumerate(contours)
    ]
    edge = edge_ahead(contours[0][1][0])
    first = max(hole, 1.2 * size)
    if edge - first > size and not any(shape.role == "timing mark" for shape in on_it):
        shapes.append(FilledShape("zero", dashes(first, edge, size), "zero of the motion"))
    return MovingBody(name, "cam", (*shapes, *on_it), poses(0.0, 0.0, turned))


def dashes(start: float, end: float, size: float) -> tuple[Ring, ...]:
    """Return the dashes of a line along the x axis from `start` to `end`, with a dash at either end.

    Each is about as long as a joint, and the gaps are half of that.
    """
    count = max(1, round((end - start) / (1.5 * size)))
    period = (end - start) / (count - 1.0 / 3.0)  # a dash at either end
    begins = start + period * np.arange(count)
    return tuple(Ring.through([(x, 0.0), (x + period / 1.5, 0.0)], closed=False) for x in begins.tolist())


def edge_ahead(ring: Ring) -> float:
    """Return the x of the vertex with x > 0 that is nearest to the x axis; without one the greatest |x| or |y|."""
    beyond = ring.flattened()
    ahead = beyond[beyond[:, 0] > 0.0]
    return float(ahead[np.argmin(np.abs(ahead[:, 1])), 0]) if len(ahead) else float(np.abs(beyond).max())


def contact(name: str, x: Array, y: Array, direction: Array | float, size: float, *, within: float = 0.0) -> MovingBody:
    """Return a contact at (x, y), (n,) each, with an arrow in the direction of the push, rad, longer by `within`."""
    return MovingBody(name, CONTACTS, arrow(6.0 * size + within, size), poses(x, y, direction))


def flat(view: View[Translating, Flat], reach: float, size: float) -> list[MovingBody]:
    """Return the yoke of two parallel faces, its guide and both contacts."""
    p, slope = view.travel(SHAFT, 1)
    q, back = view.travel(SHAFT + 0.5 * TURN, 1)
    return [
        *faces(p, view.contacts[1].datum, reach, size),
        contact("contact on face 1", p, slope, 0.0, size),
        contact("contact on face 2", -q, -back, 0.5 * TURN, size),
    ]


def faces(p: Array, breadth: float, reach: float, size: float, y: float = 0.0) -> list[MovingBody]:
    """Return a frame of two faces, the first at x = p (n,), the second `breadth` behind it, and its guide.

    Its stem lies on a line at `y`.
    """
    thick, half_stem, gap = 2.2 * size, 1.3 * size, 1.0 * size
    run = 4.5 * size
    first_guide = float(p.max()) + thick + gap
    length = first_guide + run + 2.0 * size - float(p.min())
    stem = box(thick, y - half_stem, length, y + half_stem)
    tall = reach + 1.2 * size
    outer = box(-breadth - thick, -tall - thick, thick, tall + thick)
    frame = FilledShape("follower", (outer, box(-breadth, -tall, 0.0, tall)), "yoke")
    return [
        MovingBody("yoke", "follower", (frame, FilledShape("follower", (stem,))), poses(p, 0.0, 0.0)),
        guide(first_guide, run, half_stem, size, y),
    ]


def guide(start: float, length: float, half: float, size: float, y: float = 0.0) -> MovingBody:
    """Return a fixed guide from x = `start`: two blocks, `half` to either side of a line at y, the axis of the stem."""
    shapes = [
        FilledShape("fixed", (box(start, y + side * half, start + length, y + side * (half + 1.3 * size)),), "guide")
        for side in (-1.0, 1.0)
    ]
    return MovingBody("guide", "ground", tuple(shapes), still())


def double_roller(view: View[Oscillating, Roller], size: float) -> tuple[list[MovingBody], tuple[Array, Array]]:
    """Return the arm with its two rollers, pivot and contacts, and the pressure angles of rollers A and B.

    They are (STEPS + 1,) each, from 0 to a quarter turn.
    """
    psi, slope = view.travel(SHAFT, 1)
    arm, alpha, radius = view.guide.pivot, view.contacts[0].apart, view.touch.radius
    ends = [(arm * float(np.cos(s * alpha)), arm * float(np.sin(s * alpha))) for s in (-1.0, 1.0)]
    width = min(1.9 * size, 1.4 * radius)
    arms = tuple(bar((0.0, 0.0), end, width) for end in ends)
    rollers = tuple(
        FilledShape("roller", (disc(*end, radius),), name)
        for end, name in zip(ends, ("roller A", "roller B"), strict=True)
    )
    pins = tuple(pin(min(size, 0.8 * radius), *end) for end in ends)
    labels = tuple(Letter(text, *end) for text, end in zip("AB", ends, strict=True))
    # each arm a shape of its own: where they overlap about the pivot the even-odd rule would leave a hole
    shapes = (*(FilledShape("follower", (arm_ring,), "arm") for arm_ring in arms), *rollers, *pins)
    # the arm turns by psi, seen from the pivot, which is as far from the shaft as from the rollers
    bodies = [
        MovingBody("arm", "follower", shapes, poses(arm, 0.0, -psi), labels),
        pivot("pivot", arm, 0.0, size, "P", angle=0.0),
    ]
    angles = []
    for side, name in ((-1.0, "roller A"), (1.0, "roller B")):
        along = side * alpha - psi
        centre = np.column_stack([arm + arm * np.cos(along), arm * np.sin(along)])
        ray = np.column_stack([np.cos(along), np.sin(along)])
        # velocity of the roller against the cam, whose axes turn with -phi: the pitch curve's tangent
        tangent = np.column_stack([-arm * ray[:, 1] * (1.0 - slope), arm + arm * ray[:, 0] * (1.0 - slope)])
        tangent /= np.hypot(tangent[:, 0], tangent[:, 1])[:, None]
        normal = np.column_stack([tangent[:, 1], -tangent[:, 0]])
        point = centre - radius * normal
        direction = np.unwrap(np.arctan2(normal[:, 1], normal[:, 0]))
        bodies.append(contact(f"contact of {name}", point[:, 0], point[:, 1], direction, size, within=radius))
        # the roller moves square to the arm: its pressure angle is a quarter turn less the normal's angle to the arm
        across = np.abs(ray[:, 0] * normal[:, 1] - ray[:, 1] * normal[:, 0])
        angles.append(np.arctan2(np.abs(np.sum(ray * normal, axis=1)), across))
    return bodies, (angles[0], angles[1])


def flat_pair(view: View[Oscillating, Flat], size: float) -> tuple[list[MovingBody], tuple[Array, Array]]:
    """Return the pair of faces, its pivot and contacts, and the levers of the contacts on faces A and B.

    The levers, about the pivot, are (STEPS + 1,) each.
    """
    away, half, thick = view.guide.pivot, view.contacts[0].apart, 2.0 * size
    swing = view.travel(SHAFT)[0]
    bodies: list[MovingBody] = []
    contact_points = view.contact_points_fixed(SHAFT)
    levers = [np.abs(place - away) for place in contact_points]
    tall = max(float(lever.max()) for lever in levers) + 3.0 * size
    shapes = []
    for side in (-1.0, 1.0):
        c, s = np.cos(side * half), np.sin(side * half)
        normal, along = np.array([c, s]), side * np.array([-s, c])
        corners = [np.zeros(2), tall * along, tall * along + thick * normal, thick * normal]
        shapes.append(FilledShape("follower", (Ring.through(np.array(corners)),), "face A" if side < 0.0 else "face B"))
    hub = FilledShape("follower", (disc(0.0, 0.0, 1.9 * size),), "pair of faces")
    bodies.append(MovingBody("pair of faces", "follower", (*shapes, hub), poses(away, 0.0, -swing)))
    bodies.append(pivot("pivot", away, 0.0, size, "P", angle=0.0))
    for name, side, place in zip(("face A", "face B"), (-1.0, 1.0), contact_points, strict=True):
        bodies.append(contact(f"contact on {name}", place.real, place.imag, side * half - swing, size))
    return bodies, (levers[0], levers[1])
