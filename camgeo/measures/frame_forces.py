"""Forces of a cam in a square frame that drives a linkage: its four faces, the shaft, the joint and the slide.

F is what the output is given the way it grows, N m or N, by what acts on it: its inertia, a spring and the load. Faces
are numbered from the one of lift S the way their normals turn, a quarter turn apart, so that those of V are 1 and 3,
those of H 4 and 2.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.measures.forces import PER_MM, Turn
from camgeo.measures.running import Running, State
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.dynamics import Dynamics
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from camgeo.synthesis.linkage import Driven
    from kin.linkage.mechanism import LinkageMotion, Mechanism
    from kin.linkage.statics import Coupler
    from kin.numeric.arrays import Array
    from kin.numeric.monotone import Pieces

QUARTER = 0.5 * math.pi
PAIRS = {"across": ("face 1", "face 3"), "along": ("face 4", "face 2")}  # the face that pushes where V or H is above 0

REACTIONS = {
    "across": "force across the frame",
    "along": "force along the frame",
    "joint": "force in joint D",
    "guide": "reaction of the slide's guide",
}


@dataclass(frozen=True, eq=False)
class FrameTurn(Turn):
    """A linkage's output over the turn, by the relative angle between cam and frame."""

    mechanism: Mechanism
    corners: tuple[float, ...] = ()

    @property
    def swings(self) -> bool:
        """Whether the output does."""
        return self.mechanism.unit == "deg"

    @property
    def names(self) -> tuple[str, ...]:
        """Those of the faces."""
        return "face 1", "face 2", "face 3", "face 4"

    def rows(self, t: Array) -> Array:
        """Output and two derivatives by the shaft angle."""
        motion = self.mechanism.at(t, 2)
        return motion.over_shaft(motion.output)

    @cached_property
    def places(self) -> Array:
        """Relative angles between the breaks of the faces' lifts."""
        from kin.numeric.monotone import between

        return between(0.0, TURN, self.mechanism.breaks)

    def shaft(self, t: Array) -> Array:
        """Shaft angles."""
        shaft: Array = self.mechanism.at(t, 0).shaft[0]
        return shaft

    def parameter(self, phi: Array) -> Array:
        """Relative angles."""
        return self.mechanism.relative(phi)


@dataclass(frozen=True, eq=False)
class FrameRunning(Running):
    """A linkage whose frame holds the cam, with play between the faces, however little."""

    mechanism: Mechanism

    @cached_property
    def turn(self) -> FrameTurn:
        """Its output over the turn."""
        return FrameTurn(self.mechanism, self.corners)

    def position(self, rows: Array) -> Array:
        """Output and two derivatives, SI."""
        return rows if self.turn.swings else PER_MM * rows

    def at(self, t: Array) -> State:
        """All of it at relative angles (n,)."""
        from kin.linkage.statics import frame_forces

        motion = self.mechanism.at(t, 2)
        rows = motion.over_shaft(motion.output)
        y = self.position(rows)
        force = self.inertia(rows, self.speed) + self.rest(t, y[0]) + self.preload
        given = frame_forces(self.mechanism, motion, force / PER_MM if self.turn.swings else force, self.coupler)
        normal = np.maximum([given.across, -given.along, -given.across, given.along], 0.0)
        reactions = {"across": given.across, "along": given.along} | self._joints(motion, given.joint)
        return State(force, y, normal, PER_MM * given.torque, self._pressure(t, normal), reactions)

    @cached_property
    def coupler(self) -> Coupler | None:
        """The body of the frame at this speed, None without mass."""
        from kin.linkage.statics import Coupler

        body = self.train.coupler
        if body is None:
            return None
        return Coupler(body.centre, PER_MM * body.mass * self.speed**2, body.inertia * self.speed**2 / PER_MM)

    def _joints(self, motion: LinkageMotion, force: Array) -> dict[str, Array]:
        """Size of the force in joint D, and what the slide gives its link across its line; none with dyads on it."""
        joint = self.mechanism.linkage.joints(motion.solved.linkage)["D"]
        if self.mechanism.dyads or joint.kind == "slot":
            return {}
        slide = {"guide": -force[1]} if joint.kind == "slide" else {}
        return {"joint": np.hypot(*force), **slide}

    def _pressure(self, t: Array, normal: Array) -> Array | None:
        lifts = [self.mechanism.lift.derivatives(t + k * QUARTER, 2) for k in range(len(normal))]
        return self.hertz(normal, 1.0 / np.array([p[0] + p[2] for p in lifts]))

    def own_section(self) -> dict[str, object]:
        """Where the pairs change their face."""
        pieces = self.turn.pieces(lambda t: np.array([self.at(t).reactions[name] for name in PAIRS]))
        return {"pairs": [self._changes(name, piece) for name, piece in zip(PAIRS, pieces, strict=True)]}

    def _changes(self, name: str, piece: Pieces) -> dict[str, object]:
        both = piece.least()[0] < 0.0 < piece.greatest()[0]
        places = {self.turn.degrees(at) for at in piece.crossings(0.0)} if both else set()
        return {"pair": name, "faces": PAIRS[name], "changes_at_deg": sorted(places)}


def frame_running(recipe: Recipe, design: Design, driven: Driven, train: Dynamics) -> FrameRunning:
    """A linkage as it runs. Raises RecipeErrors for one that does not turn right round."""
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
