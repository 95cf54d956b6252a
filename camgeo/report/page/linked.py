"""Scene of a linkage: square frame, joints, links and dyads in the fixed frame, with contacts and forces.

Axes of AS Figure 7: shaft A at the origin, pivot B at (r1, 0), the shaft turning clockwise. The frame's axes are
u(theta_3) along the coupler and n across; the face of lift S has the normal n, the face of S1 has -u. Lengths are in
mm, angles in rad; `size` is the size of a joint, by which parts are scaled. Loop 0 of a chain is the linkage, loop k
the k-th dyad.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.curve.ring import Ring, bar, box, disc
from camgeo.report.page.followers import SHAFT, contact
from camgeo.report.page.scene import OVERLAYS, FilledShape, Letter, MovingBody, arrow, block, pin, pivot, poses, still
from kin.linkage.dyad import RPR, RRP, RRR
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.recipe.linkage import TracedPoint
    from kin.linkage.chain import Solved
    from kin.linkage.links import Joint, Link
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array
    from kin.numeric.elementary import Jet

QUARTER = 0.25 * TURN
TRACED = 3  # steps from one point of a path to the next, 1.5 degrees of the shaft


@dataclass(frozen=True, eq=False)
class SteppedMechanism:
    """A mechanism at equal steps of the shaft; values are (STEPS + 1,).

    `theta` is the relative angle between cam and frame, `solved` has the poses of all links. `lifts` (4, 2, STEPS + 1)
    are lift, mm, and slope, mm/rad, of the four faces, whose normals stand a quarter turn apart.
    """

    mechanism: Mechanism
    theta: Array
    solved: Solved
    lifts: Array

    @staticmethod
    def of(mechanism: Mechanism) -> SteppedMechanism:
        """Solve a mechanism that turns right round, at the page's steps of the shaft."""
        from kin.numeric.elementary import Jet

        theta = mechanism.relative(SHAFT)
        lifts = np.stack([mechanism.lift.derivatives(theta + k * QUARTER, 1) for k in range(4)])
        solved = mechanism.chain.solve(Jet(lifts[0]), Jet(lifts[1]), mechanism.about)
        return SteppedMechanism(mechanism, theta, solved, lifts)

    @property
    def frame(self) -> Array:
        """Angle theta_3 of the frame (STEPS + 1,), rad."""
        return value(self.solved.linkage.frame)

    @property
    def cam(self) -> Array:
        """Angle of the cam's own axes (STEPS + 1,), rad; it falls as the shaft turns clockwise."""
        turned: Array = self.frame + QUARTER - self.theta
        return turned

    @property
    def slopes(self) -> tuple[Array, Array]:
        """Slopes S' and S1' of the lifts of faces 1 and 2, mm/rad, (STEPS + 1,) each."""
        return self.lifts[0, 1], self.lifts[1, 1]

    def joints(self, loop: int) -> dict[str, Joint]:
        """Joints of a loop by their letters."""
        return self.mechanism.chain.joints(self.solved, loop)

    def output(self, loop: int) -> Array:
        """Poses (STEPS + 1, 3), x, y and angle, of the link that a loop drives."""
        return _pose(self.mechanism.chain.output(loop).pose(self.solved))

    def angles(self) -> tuple[Array, Array]:
        """Transmission angle and force angle, (STEPS + 1,) each, from 0 to a quarter turn."""
        linkage, state = self.mechanism.linkage, self.solved.linkage
        sine, cosine = linkage.transmission(state)
        pushed, resisted = linkage.force_angle(state, *self.slopes)
        return np.arctan2(np.abs(sine), np.abs(cosine)), np.arctan2(np.abs(pushed), np.abs(resisted))


def value(jet: Jet) -> Array:
    """Return the values (n,) of a jet."""
    values: Array = jet.c[0]
    return values


class Layers(NamedTuple):
    """Bodies of a loop in the order of drawing: links, pivots on the ground, joints on top."""

    links: list[MovingBody]
    pivots: list[MovingBody]
    joints: list[MovingBody]


def linkage_bodies(driven: SteppedMechanism, size: float) -> list[MovingBody]:
    """Return links with the frame, pivots, joints, contacts and forces, the hindmost first."""
    mechanism = driven.mechanism
    loops = [
        MAKERS[type(loop)](driven, number, loop, size)
        for number, loop in enumerate([mechanism.linkage, *mechanism.dyads])
    ]
    layers = [body for layer in zip(*loops, strict=True) for bodies in layer for body in bodies]
    return [*layers, *_contacts(driven, size), *_forces(driven, size)]


def _four_bar(driven: SteppedMechanism, number: int, linkage: FourBar, size: float) -> Layers:
    joints = driven.joints(number)
    frame = _frame(driven, 0.0, 0.5 * driven.mechanism.breadth + linkage.coupler, size)
    joint = _with_label(_joint("joint D", joints["D"], size), "D")
    return Layers([frame, *_rocker(driven, linkage.rocker, size)], [_pivot("pivot B", joints["B"], size, "B")], [joint])


def _slider_crank(driven: SteppedMechanism, number: int, linkage: SliderCrank, size: float) -> Layers:
    joint = driven.joints(number)["D"]
    frame = _frame(driven, 0.0, 0.5 * driven.mechanism.breadth + linkage.coupler, size)
    return Layers([_rail(joint, 0.0, size), frame], [], [_with_label(_joint("slide", joint, size), "D")])


def _inverted(driven: SteppedMechanism, number: int, linkage: InvertedSliderCrank, size: float) -> Layers:
    joints = driven.joints(number)
    beyond = value(driven.solved.linkage.slide) - (0.5 * driven.mechanism.breadth - driven.lifts[1, 0])
    low, reach = min(0.0, float(beyond.min()) - 3.5 * size), max(0.0, float(beyond.max()) + 3.5 * size)
    links = [_frame(driven, low, reach, size), *_rocker(driven, linkage.rocker, size)]
    return Layers(links, [_pivot("pivot B", joints["B"], size, "B")], [_joint("block", joints["D"], size)])


def _rocker(driven: SteppedMechanism, length: float, size: float) -> list[MovingBody]:
    """Return the linkage's rocker; none where its length is 0."""
    if length <= 0.0:
        return []
    rocker = FilledShape("rocker", (bar((0.0, 0.0), (length, 0.0), 1.5 * size),), "rocker")
    return [MovingBody("rocker", "links", (rocker,), driven.output(0))]


def _joint(name: str, joint: Joint, size: float) -> MovingBody:
    """Return a pin, with the block that it sits in if one slides."""
    shapes = {
        "pin": (),
        "slide": (block(4.2 * size, 2.6 * size, "slide"),),
        "slot": (block(4.2 * size, 2.8 * size, "block"),),
    }
    return MovingBody(name, "links", (*shapes[joint.kind], pin(size)), _pose(joint.place))


def _pivot(name: str, joint: Joint, size: float, letter: str = "") -> MovingBody:
    x, y = (float(value(place)[0]) for place in joint.place.origin)
    return pivot(name, x, y, size, letter)


def _with_label(body: MovingBody, text: str) -> MovingBody:
    return MovingBody(body.name, body.kind, body.shapes, body.pose, (Letter(text, 0.0, 0.0),))


def _frame(driven: SteppedMechanism, low: float, reach: float, size: float) -> MovingBody:
    """Return the square frame about its middle, with the coupler's bar along u from `low` to `reach`.

    Where the bar lies beyond the end of the frame's side, an arm in line with that side carries it.
    """
    w, middle = driven.mechanism.breadth, driven.mechanism.chain.frame(driven.solved)
    inner, outer = 0.5 * w, 0.5 * w + 1.8 * size
    square = FilledShape(
        "follower", (box(-outer, -outer, outer, outer), box(-inner, -inner, inner, inner)), "square frame"
    )
    bars, y, middle_of_side = [], driven.mechanism.linkage.joint_offset, inner + 0.9 * size
    for side, end, needed in ((1.0, reach, reach > (0.0 if abs(y) > inner else outer)), (-1.0, low, low < -outer)):
        if not needed:
            continue
        x = side * middle_of_side
        bars.append(FilledShape("follower", (bar((x, y), (end, y), 1.5 * size),), "coupler"))
        if abs(y) > inner:
            bars.append(FilledShape("follower", (bar((x, np.copysign(inner, y)), (x, y), 1.5 * size),), "coupler"))
    return MovingBody("frame", "follower", (square, *bars), _pose(middle))


def _rail(joint: Joint, angle: float, size: float) -> MovingBody:
    """Return the two sides of a straight guide along the places of a slide."""
    x, y = map(value, joint.place.origin)
    c, s = np.cos(angle), np.sin(angle)
    along, across = x * c + y * s, float(np.mean(y * c - x * s))
    first, last = float(along.min()) - 4.0 * size, float(along.max()) + 4.0 * size
    sides = tuple(
        Ring.through([(first, across + d), (last, across + d)], closed=False) for d in (-1.5 * size, 1.5 * size)
    )
    return MovingBody("guide", "ground", (FilledShape("hatch", sides, "guide"),), still(0.0, 0.0, angle))


def _pose(link: Link) -> Array:
    x, y = link.origin
    return poses(value(x), value(y), _direction(link))


def _direction(link: Link) -> Array | float:
    return 0.0 if link.direction is None else value(link.direction)


def _arm(driven: SteppedMechanism, number: int, size: float) -> MovingBody:
    """Return the arm to a dyad, on the link that carries it."""
    dyad, carrier = driven.mechanism.dyads[number - 1], driven.mechanism.chain.carrier(number - 1)
    on_frame = carrier.name == "frame"
    role = "follower" if on_frame else "output" if dyad.on == "previous" else "rocker"
    stub = FilledShape(role, (bar((0.0, 0.0), dyad.point, 1.3 * size),), "link")
    return MovingBody(
        f"arm to dyad {number}", "follower" if on_frame else "links", (stub,), _pose(carrier.pose(driven.solved))
    )


def _rod(driven: SteppedMechanism, number: int, length: float, size: float) -> MovingBody:
    """Return the bar of a dyad from P to Q."""
    rod = FilledShape("rod", (bar((0.0, 0.0), (length, 0.0), 1.3 * size),), "connecting rod")
    link = driven.mechanism.chain.rod(driven.solved, number - 1)
    x, y = map(value, link.origin)
    return MovingBody(f"rod of dyad {number}", "links", (rod,), poses(x, y, np.unwrap(_direction(link))))


def _rrr(driven: SteppedMechanism, number: int, dyad: RRR, size: float) -> Layers:
    joints = driven.joints(number)
    rocker = FilledShape("output", (bar((0.0, 0.0), (dyad.links[1], 0.0), 1.5 * size),), "output rocker")
    output = MovingBody(f"output of dyad {number}", "links", (rocker,), driven.output(number))
    return Layers(
        [_arm(driven, number, size), _rod(driven, number, dyad.links[0], size), output],
        [_pivot(f"pivot of dyad {number}", joints["G"], size)],
        [_joint("joint", joints[name], size) for name in "PQ"],
    )


def _rrp(driven: SteppedMechanism, number: int, dyad: RRP, size: float) -> Layers:
    joints = driven.joints(number)
    return Layers(
        [
            _rail(joints["Q"], dyad.direction, size),
            _arm(driven, number, size),
            _rod(driven, number, dyad.link, size),
        ],
        [],
        [_joint("joint", joints["P"], size), _joint("slide", joints["Q"], size)],
    )


def _rpr(driven: SteppedMechanism, number: int, dyad: RPR, size: float) -> Layers:
    joints = driven.joints(number)
    px, py = map(value, joints["P"].place.origin)
    slide = np.sqrt(np.maximum((px - dyad.ground[0]) ** 2 + (py - dyad.ground[1]) ** 2 - dyad.offset**2, 0.0))
    slot = bar((0.0, dyad.offset), (float(slide.max()) + 3.0 * size, dyad.offset), 1.2 * size)
    hub = bar((0.0, 0.0), (0.0, dyad.offset), 1.5 * size)
    rocker = FilledShape("output", (slot, hub) if dyad.offset else (slot,), "slotted rocker")
    output = MovingBody(f"output of dyad {number}", "links", (rocker,), driven.output(number))
    inside = MovingBody("block", "links", (block(3.6 * size, 2.4 * size, "block"),), _pose(joints["P"].place))
    return Layers(
        [_arm(driven, number, size), output],
        [_pivot(f"pivot of dyad {number}", joints["G"], size)],
        [inside, MovingBody("joint", "links", (pin(size),), poses(px, py, 0.0))],
    )


# Function that draws each kind of loop: (mechanism, number of the loop, loop, size).
MAKERS: dict[type, Callable[..., Layers]] = {
    FourBar: _four_bar,
    InvertedSliderCrank: _inverted,
    SliderCrank: _slider_crank,
    RRR: _rrr,
    RRP: _rrp,
    RPR: _rpr,
}


def path_bodies(driven: SteppedMechanism, traces: Sequence[TracedPoint], mm: float, size: float) -> list[MovingBody]:
    """Return for each traced point of a moving link its path over the turn, and the point itself.

    `mm` is the length of the recipe's unit, in which names give the points.
    """
    bodies = []
    for trace in traces:
        x, y = map(value, driven.mechanism.chain.carrier_of(trace.on).pose(driven.solved).point(*trace.point))
        path = FilledShape("overlay", (Ring.through(np.column_stack([x, y])[::TRACED], closed=False),), trace.name(mm))
        dot = FilledShape("overlay dot", (disc(0.0, 0.0, 0.6 * size),), trace.name(mm))
        bodies += [
            MovingBody(trace.name(mm), OVERLAYS, (path,), still()),
            MovingBody(f"point of {trace.name(mm).removeprefix('path of ')}", OVERLAYS, (dot,), poses(x, y, 0.0)),
        ]
    return bodies


def _contacts(driven: SteppedMechanism, size: float) -> list[MovingBody]:
    """Return the contacts on the four faces, each with its normal."""
    contacts = []
    for k in range(4):
        lift, slope = driven.lifts[k]
        direction = driven.frame + (k + 1) * QUARTER
        c, s = np.cos(direction), np.sin(direction)
        x, y = lift * c - slope * s, lift * s + slope * c
        contacts.append(contact(f"contact on face {k + 1}", x, y, direction, size))
    return contacts


def _forces(driven: SteppedMechanism, size: float) -> list[MovingBody]:
    """Return the point where the contacts' normals meet, and the force of the frame on the next link, through it.

    The arrow points in the direction of the push while that link moves against a load.
    """
    state = driven.solved.linkage
    line = driven.mechanism.linkage.force_line(state, *driven.slopes)
    direction = np.arctan2(line.along_y, line.along_x)
    shapes = arrow(8.0 * size, 1.2 * size, "load")
    centre = (FilledShape("load dot", (disc(0.0, 0.0, 0.5 * size),)),)
    return [
        MovingBody(
            "where the contact normals intersect", "forces", centre, poses(*state.instant_centre(*driven.slopes), 0.0)
        ),
        MovingBody("force of the frame on the link it drives", "forces", shapes, poses(line.x, line.y, direction)),
    ]
