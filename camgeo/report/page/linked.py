"""Scene of a linkage: square frame, joints, links and dyads in the fixed frame, with what pushes on what.

As AS Figure 7 has it: shaft A at the origin, pivot B at (r1, 0), the shaft turning clockwise. The frame's axes are
u(theta_3) along the coupler and n across; the face of lift S has the normal n, that of S1 has -u.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import Ring, bar, box, disc
from camgeo.report.page.followers import SHAFT, contact
from camgeo.report.page.scene import Body, Label, Shape, arrow, block, pin, pivot, poses, still
from kin.linkage.dyad import RRP, RRR, coupler, output_link
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.linkage.transmission_angle import force, transmission
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from kin.linkage.chain import Solved
    from kin.linkage.dyad import Dyad, Link
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array
    from kin.numeric.elementary import Jet

QUARTER = 0.25 * TURN


@dataclass(frozen=True, eq=False)
class Driven:
    """A mechanism at equal steps of the shaft: relative angle, poses of all links; each (STEPS + 1,), mm and rad.

    `lifts` (4, 2, STEPS + 1) are lift and slope of the four faces, whose normals stand a quarter turn apart.
    """

    mechanism: Mechanism
    theta: Array
    solved: Solved
    lifts: Array

    @staticmethod
    def of(mechanism: Mechanism) -> Driven:
        """Solve a mechanism that turns."""
        from kin.numeric.elementary import Jet

        theta = mechanism.relative(SHAFT)
        lifts = np.stack([mechanism.lift.derivatives(theta + k * QUARTER, 1) for k in range(4)])
        solved = mechanism.chain.solve(Jet(lifts[0]), Jet(lifts[1]), mechanism.about)
        return Driven(mechanism, theta, solved, lifts)

    @property
    def frame(self) -> Array:
        """theta_3."""
        return value(self.solved.linkage.frame)

    @property
    def cam(self) -> Array:
        """Angle by which the cam's own axes are turned: less by the shaft angle than where it began."""
        turned: Array = self.frame + QUARTER - self.theta
        return turned

    @property
    def joint(self) -> tuple[Array, Array]:
        """Joint D."""
        x, y = self.solved.linkage.joint
        return value(x), value(y)

    def along(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Give the point x u + y n of the fixed frame."""
        c, s = np.cos(self.frame), np.sin(self.frame)
        return x * c - y * s, x * s + y * c

    @property
    def instant_centre(self) -> tuple[Array, Array]:
        """The point -S' u - S1' n in which the normals of the contacts meet."""
        return self.along(-self.lifts[0, 1], -self.lifts[1, 1])

    def angles(self) -> tuple[Array, Array]:
        """Transmission angle and force angle, rad, from 0 to a quarter turn."""
        linkage, at = self.mechanism.linkage, self.solved.linkage
        sine, cosine = transmission(linkage, at)
        pushed, held = force(linkage, at, self.lifts[0, 1], self.lifts[1, 1])
        return np.arctan2(np.abs(sine), np.abs(cosine)), np.arctan2(np.abs(pushed), np.abs(held))


def value(jet: Jet) -> Array:
    """Return the values (n,) of a jet."""
    values: Array = jet.c[0]
    return values


def linked(driven: Driven, size: float) -> list[Body]:
    """Return frame, links, pivots, contacts and forces, the hindmost first; `size` is that of a joint."""
    mechanism, at = driven.mechanism, driven.solved.linkage
    linkage, w = mechanism.linkage, mechanism.breadth
    bodies, pivots, tops = [], [], []
    dx, dy = driven.joint
    s, s1 = driven.lifts[0, 0], driven.lifts[1, 0]
    centre = driven.along(0.5 * w - s1, s - 0.5 * w)
    reach, low = 0.5 * w, 0.0
    if isinstance(linkage, InvertedSliderCrank):
        beyond = value(at.slide) - (0.5 * w - s1)
        low, reach = min(0.0, float(beyond.min()) - 3.5 * size), max(0.0, float(beyond.max()) + 3.5 * size)
    else:
        reach += linkage.coupler
    bodies.append(_frame(w, low, reach, size, poses(*centre, driven.frame)))
    if isinstance(linkage, SliderCrank):
        bodies.insert(0, _rail(dx, dy, 0.0, size))
        tops.append(Body("slide", "links", (block(4.2 * size, 2.6 * size, "slide"), pin(size)), poses(dx, dy, 0.0)))
        tops[-1] = _labelled(tops[-1], "D")
    else:
        pivots.append(pivot("pivot B", linkage.ground, 0.0, size, "B"))
        direction = 0.5 * TURN - value(at.output)
        if linkage.rocker > 0.0:
            rocker = Shape("rocker", (bar((0.0, 0.0), (linkage.rocker, 0.0), 1.5 * size),), "rocker")
            bodies.append(Body("rocker", "links", (rocker,), poses(linkage.ground, 0.0, direction)))
        if isinstance(linkage, FourBar):
            tops.append(_labelled(Body("joint D", "links", (pin(size),), poses(dx, dy, 0.0)), "D"))
        else:
            shapes = (block(4.2 * size, 2.8 * size, "block"), pin(size))
            tops.append(Body("block", "links", shapes, poses(dx, dy, driven.frame)))
    for number, dyad in enumerate(mechanism.dyads):
        under, over, fixed = _dyad(driven, number, dyad, size)
        bodies += under
        tops += over
        pivots += fixed
    return [*bodies, *pivots, *tops, *_contacts(driven, size), *_forces(driven, size)]


def _labelled(body: Body, text: str) -> Body:
    return Body(body.name, body.kind, body.shapes, body.pose, (Label(text, 0.0, 0.0),))


def _frame(w: float, low: float, reach: float, size: float, pose: Array) -> Body:
    """Return the square frame about its middle, with the coupler's bar along u from `low` to `reach`."""
    inner, outer = 0.5 * w, 0.5 * w + 1.8 * size
    square = Shape("follower", (box(-outer, -outer, outer, outer), box(-inner, -inner, inner, inner)), "square frame")
    bars = []
    if reach > outer:
        bars.append(Shape("follower", (bar((inner + 0.9 * size, 0.0), (reach, 0.0), 1.5 * size),), "coupler"))
    if low < -outer:
        bars.append(Shape("follower", (bar((-inner - 0.9 * size, 0.0), (low, 0.0), 1.5 * size),), "coupler"))
    return Body("frame", "follower", (square, *bars), pose)


def _rail(x: Array, y: Array, angle: float, size: float) -> Body:
    """Return the two sides of a straight guide along the places of a slide."""
    c, s = np.cos(angle), np.sin(angle)
    along, across = x * c + y * s, float(np.mean(y * c - x * s))
    first, last = float(along.min()) - 4.0 * size, float(along.max()) + 4.0 * size
    sides = tuple(
        Ring.through([(first, across + d), (last, across + d)], closed=False) for d in (-1.5 * size, 1.5 * size)
    )
    return Body("guide", "ground", (Shape("hatch", sides, "guide"),), still(0.0, 0.0, angle))


def _carrier(driven: Driven, number: int) -> Link:
    dyads, solved = driven.mechanism.dyads, driven.solved
    if dyads[number].on == "coupler":
        return coupler(solved.linkage)
    if dyads[number].on == "output":
        return output_link(solved.linkage)
    return dyads[number - 1].output_link(solved.dyads[number - 1])


def _pose(link: Link) -> Array:
    x, y = link.origin
    return poses(value(x), value(y), 0.0 if link.direction is None else value(link.direction))


def _dyad(driven: Driven, number: int, dyad: Dyad, size: float) -> tuple[list[Body], list[Body], list[Body]]:
    """Return a dyad's bodies under the joints, its joints, and its pivots."""
    reached = driven.solved.dyads[number]
    qx, qy = map(value, reached.joint)
    carrier = _carrier(driven, number)
    px, py = map(value, carrier.point(*dyad.point))
    thin = 1.3 * size
    # of an inverted slider-crank D slides along the frame, and the point with it: it belongs to the block
    own = dyad.on == "coupler" and not isinstance(driven.mechanism.linkage, InvertedSliderCrank)
    role = "follower" if own else "output" if dyad.on == "previous" else "rocker"
    stub = Shape(role, (bar((0.0, 0.0), dyad.point, thin),), "link")
    under = [Body(f"arm to dyad {number + 1}", "follower" if own else "links", (stub,), _pose(carrier))]
    over = [Body("joint", "links", (pin(size),), poses(px, py, 0.0))]
    if isinstance(dyad, RRR | RRP):
        length = dyad.links[0] if isinstance(dyad, RRR) else dyad.link
        rod = Shape("rod", (bar((0.0, 0.0), (length, 0.0), thin),), "connecting rod")
        towards = np.unwrap(np.arctan2(qy - py, qx - px))
        under.append(Body(f"rod of dyad {number + 1}", "links", (rod,), poses(px, py, towards)))
    if isinstance(dyad, RRP):
        under.insert(0, _rail(qx, qy, dyad.direction, size))
        over.append(
            Body(
                "slide",
                "links",
                (block(4.2 * size, 2.6 * size, "slide"), pin(size)),
                poses(qx, qy, dyad.direction),
            )
        )
        return under, over, []
    turned = value(reached.output)
    if isinstance(dyad, RRR):
        rocker = Shape("output", (bar((0.0, 0.0), (dyad.links[1], 0.0), 1.5 * size),), "output rocker")
        over.append(Body("joint", "links", (pin(size),), poses(qx, qy, 0.0)))
    else:
        slide = np.sqrt(np.maximum((px - dyad.ground[0]) ** 2 + (py - dyad.ground[1]) ** 2 - dyad.offset**2, 0.0))
        slot = bar((0.0, dyad.offset), (float(slide.max()) + 3.0 * size, dyad.offset), 1.2 * size)
        hub = bar((0.0, 0.0), (0.0, dyad.offset), 1.5 * size)
        rocker = Shape("output", (slot, hub) if dyad.offset else (slot,), "slotted rocker")
        over.insert(0, Body("block", "links", (block(3.6 * size, 2.4 * size, "block"),), poses(px, py, turned)))
    under.append(Body(f"output of dyad {number + 1}", "links", (rocker,), poses(*dyad.ground, turned)))
    return under, over, [pivot(f"pivot of dyad {number + 1}", *dyad.ground, size)]


def _contacts(driven: Driven, size: float) -> list[Body]:
    """Return the contacts on the four faces, each with its normal."""
    found = []
    for k in range(4):
        lift, slope = driven.lifts[k]
        direction = driven.frame + (k + 1) * QUARTER
        c, s = np.cos(direction), np.sin(direction)
        x, y = lift * c - slope * s, lift * s + slope * c
        found.append(contact(f"contact on face {k + 1}", x, y, direction, size))
    return found


def _forces(driven: Driven, size: float) -> list[Body]:
    """Return the force of the frame on the next link, and where the contacts' normals meet, through which it passes.

    It points to the side to which it has to push while that link moves against a load.
    """
    linkage = driven.mechanism.linkage
    px, py = driven.instant_centre
    dx, dy = driven.joint
    fx, fy = dx - px, dy - py
    if isinstance(linkage, InvertedSliderCrank):  # across the frame's line, where P stands along it
        c, s = np.cos(driven.frame), np.sin(driven.frame)
        back = fx * c + fy * s
        dx, dy, fx, fy = dx - back * c, dy - back * s, -s, c
    size_of = np.hypot(fx, fy)
    fx, fy = (np.divide(part, size_of, out=np.zeros_like(part), where=size_of > 0.0) for part in (fx, fy))
    # the output moves along its velocity: along the slide, or about B
    if isinstance(linkage, SliderCrank):
        vx, vy = np.ones_like(dx), np.zeros_like(dx)
        moving = driven.solved.linkage.output.c[1]
    else:
        vx, vy = -dy, dx - linkage.ground
        moving = -driven.solved.linkage.output.c[1]  # theta_4 is clockwise
    side = np.where((fx * vx + fy * vy) * moving < 0.0, -1.0, 1.0)
    direction = np.arctan2(side * fy, side * fx)
    shapes = arrow(8.0 * size, 1.2 * size, "load")
    centre = (Shape("load dot", (disc(0.0, 0.0, 0.5 * size),)),)
    return [
        Body("where the contact normals intersect", "forces", centre, poses(px, py, 0.0)),
        Body("force of the frame on the link it drives", "forces", shapes, poses(dx, dy, direction)),
    ]
