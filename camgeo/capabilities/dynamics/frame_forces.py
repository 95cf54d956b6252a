"""Forces of a cam in a square frame that drives a linkage: its four faces, the shaft, the joint and the slide.

F is the force, N, or moment, N m, that inertia, spring and load demand at the output, above 0 where the output grows.
Face 1 is the face of lift S; the others follow a quarter turn apart in the sense in which the normals turn. V, across
the frame, is the force on face 1 less that on face 3; H, along it, the force on face 4 less that on face 2.
"""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.dynamics.running import LossSpeed, Pull, Running, State, lost
from camgeo.measures.forces import PER_MM, Turn
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.dynamics.keys import Dynamics
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from camgeo.synthesis.linkage import DesignedLinkage
    from kin.follower.contact_forces import Elastic
    from kin.linkage.mechanism import LinkageMotion, Mechanism
    from kin.linkage.statics import FrameForces
    from kin.numeric.arrays import Array
    from kin.numeric.monotone import MonotonePieces

QUARTER = 0.5 * math.pi
PAIRS = {"across": ("face 1", "face 3"), "along": ("face 4", "face 2")}  # first the face that bears V or H above 0

REACTIONS = {
    "across": "force across the frame",
    "along": "force along the frame",
    "joint": "force in joint D",
    "guide": "reaction of the slide's guide",
}


@dataclass(frozen=True, eq=False)
class FrameTurn(Turn):
    """A linkage's output over the turn; the parameter is the relative angle between cam and frame, rad."""

    mechanism: Mechanism
    corners: tuple[float, ...] = ()

    @property
    def swings(self) -> bool:
        """Whether the linkage's output swings."""
        return self.mechanism.unit == "deg"

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the faces, in the order of their forces."""
        return "face 1", "face 2", "face 3", "face 4"

    def rows(self, t: Array) -> Array:
        """Output, mm or rad, and two derivatives by the shaft angle, (3, n), at relative angles (n,), rad."""
        motion = self.mechanism.at(t, 2)
        return motion.over_shaft(motion.output)

    @cached_property
    def places(self) -> Array:
        """Relative angles, rad, rising over a whole turn: the breaks of the faces' lifts and both ends."""
        from kin.numeric.monotone import between

        return between(0.0, TURN, self.mechanism.breaks)

    def shaft(self, t: Array) -> Array:
        """Shaft angles (n,), rad, at relative angles (n,), rad."""
        shaft: Array = self.mechanism.at(t, 0).shaft[0]
        return shaft

    def parameter(self, phi: Array) -> Array:
        """Relative angles between cam and frame, rad, at shaft angles (n,)."""
        return self.mechanism.relative(phi)


@dataclass(frozen=True, eq=False)
class FrameRunning(Running):
    """Forces of a linkage whose square frame holds the cam, with play however little, or preloaded on its faces."""

    mechanism: Mechanism

    @property
    def swings(self) -> bool:
        """Whether the linkage's output swings."""
        return self.mechanism.unit == "deg"

    @cached_property
    def turn(self) -> FrameTurn:
        """Motion of the linkage's output over the turn."""
        return FrameTurn(self.mechanism, self.corners)

    def position(self, rows: Array) -> Array:
        """Output y, m or rad, and two derivatives by the shaft angle, (3, n), from `rows` in mm or rad."""
        return rows if self.swings else PER_MM * rows

    def at(self, t: Array, more: float = 0.0) -> State:
        """State of motion and forces at relative angles t (n,), rad, with `more` load than the recipe's, N or N m.

        Raises RecipeErrors for a load without a finite value.
        """
        motion = self.mechanism.at(t, 2)
        rows = motion.over_shaft(motion.output)
        y = self.position(rows)
        force = self.inertia(t, rows, self.speed) + self.rest(t, y[0], more) + self.preload
        forces = self._given(motion, force, self.speed)
        (one, three), (two, four) = map(self._faces, forces.pairs)
        normal = np.array([one, two, three, four])
        reactions = {"across": forces.across, "along": forces.along} | self._joints(motion, forces.joint)
        return State(force, y, normal, PER_MM * forces.torque, self._pressure(t, normal), reactions)

    def _given(self, motion: LinkageMotion, force: Array, speed: float) -> FrameForces:
        """Forces of the cam on the frame, N and N mm, for `force` (n,), N or N m, at the output and a moving coupler.

        The coupler's inertia is that at the shaft's `speed`, rad/s.
        """
        from kin.linkage.statics import Coupler, frame_forces

        body = self.train.coupler
        coupler = None
        if body is not None:
            coupler = Coupler(body.centre, PER_MM * body.mass * speed**2, body.inertia * speed**2 / PER_MM)
        return frame_forces(self.mechanism, motion, force / PER_MM if self.swings else force, coupler)

    @cached_property
    def pressed(self) -> Elastic | None:
        """Preload of a pair of faces, N, and stiffness of its faces, N/mm, alike for both pairs.

        None with play, and where the recipe gives no stiffness.
        """
        from kin.follower.contact_forces import preloaded

        preload = self.design.exact.preload
        if preload is None or preload.stiffness is None:
            return None
        first, second = (PER_MM * stiffness for stiffness in preload.stiffness)
        return preloaded((np.ones(1), np.ones(1)), preload.overlaps, (first, second))

    def _faces(self, pair: Array) -> Array:
        """Forces on both faces of a pair, N (2, n), each at least 0, from their difference `pair`, N (n,).

        Without preload the first face bears where the difference is above 0, else the second.
        """
        return np.maximum([pair, -pair], 0.0) if self.pressed is None else self.pressed.split(pair)

    def lost_rpm(self) -> list[LossSpeed]:
        """Lowest speed at which each preloaded face loses contact somewhere in the turn, by the faces' names.

        Empty with play, and where the recipe gives no stiffness of the preload. Raises RecipeErrors for a load without
        a finite value, RoughError for too abrupt a motion.
        """
        pressed = self.pressed
        if pressed is None:
            return []

        # forces are linear in the demand and in the coupler's inertia
        def pull(t: Array, more: float, rank: int) -> Pull:
            motion = self.mechanism.at(t, 2)
            rows = motion.over_shaft(motion.output)
            moved = self._given(motion, self.inertia(t, rows, 1.0), 1.0).pairs[rank]
            still = self._given(motion, self.rest(t, self.position(rows)[0], more) + self.preload, 0.0).pairs[rank]
            return Pull(moved, still, pressed.loses_first, pressed.loses_second)

        names = self.turn.names
        first, second = (lost(self.turn, names[k::2], partial(pull, rank=k), self.doubts) for k in range(2))
        return sorted(first + second)

    def _joints(self, motion: LinkageMotion, force: Array) -> dict[str, Array]:
        """Size `joint` of the force in joint D, N (n,); of an output that slides also `guide`, its guide's reaction.

        `force` (2, n) is that of the frame on the output at D, in fixed axes, the slide's line along x; the guide's
        reaction balances its part across that line. Empty with dyads, or with a slot.
        """
        joint = self.mechanism.linkage.joints(motion.solved.linkage)["D"]
        if self.mechanism.dyads or joint.kind == "slot":
            return {}
        slide = {"guide": -force[1]} if joint.kind == "slide" else {}
        return {"joint": np.hypot(*force), **slide}

    def _pressure(self, t: Array, normal: Array) -> Array | None:
        """Hertz's pressure of each face, N/mm^2 (4, n), on a cam of curvature 1/(p + p''); None if unknown."""
        lifts = [self.mechanism.lift.derivatives(t + k * QUARTER, 2) for k in range(len(normal))]
        return self.hertz(normal, 1.0 / np.array([p[0] + p[2] for p in lifts]))

    def own_section(self) -> dict[str, object]:
        """Report entry `pairs`: of each pair the shaft angles, degrees, at which another face begins to bear."""
        pieces = self.turn.pieces(lambda t: np.array([self.at(t).reactions[name] for name in PAIRS]))
        return {"pairs": [self._changes(name, piece) for name, piece in zip(PAIRS, pieces, strict=True)]}

    def _changes(self, name: str, piece: MonotonePieces) -> dict[str, object]:
        both = piece.least()[0] < 0.0 < piece.greatest()[0]
        places = [self.turn.degrees(at) for at in piece.crossings_round(0.0)] if both else []
        return {"pair": name, "faces": PAIRS[name], "changes_at_deg": sorted(places)}


def frame_running(recipe: Recipe, design: Design, driven: DesignedLinkage, train: Dynamics) -> FrameRunning:
    """Forces of a linkage at its speed; raises RecipeErrors for a linkage that does not turn right round."""
    mobile = driven.mechanism.mobility()
    if not mobile.turns:
        why, at = "a loop of the linkage cannot be closed", mobile.margin_at
        if not mobile.binds and mobile.reverses:
            at = mobile.reverses[0][0]
            why = "the shaft would turn back and forces grow without bound"
        why = f"{why} from a relative angle of {math.degrees(at % TURN):.6g} degrees on"
        remedy = "leave dynamics out, or place the shaft nearer to the middle of the cam or lengthen the links"
        raise recipe.error("dynamics", why, None, remedy)
    return FrameRunning(recipe, design, train, driven.mechanism)
