"""Forces of the cam on its square frame, and torque of the shaft, for a moment or force at the linkage's output.

The lifts S and S1 place the frame, and with it every link. The pair of faces across n presses on one line, with
V = N(+n) - N(-n), the pair along u on another, with H = N(+u) - N(-u). Virtual work in dS and in dS1, the shaft held,
gives

    V = Q_S + T d theta_3/dS,  -H = Q_S1 + T d theta_3/dS1,  T = S' V - S1' H,  so  T (1 - theta_3') = S' Q_S + S1' Q_S1

with T the torque of both lines about the shaft, above 0 where the shaft drives, and Q what the output and a coupler
demand: M dq + m a dr + I alpha d theta_3. 1 - theta_3' is the rate of the shaft: all forces grow without bound exactly
where it turns back. Sheet on forces, section 2; cases f06 to f09.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.elementary import Jet

if TYPE_CHECKING:
    from kin.linkage.mechanism import LinkageMotion, Mechanism
    from kin.numeric.arrays import Array

__all__ = ["Coupler", "FrameForces", "frame_forces"]


class Coupler(NamedTuple):
    """A body fixed in the frame, its centre in the frame's axes, from the frame's middle, mm.

    Accelerations are by the shaft angle: the mass is in N a mm/rad^2, the inertia about the centre in N mm a rad/rad^2.
    """

    centre: tuple[float, float]
    mass: float
    inertia: float


class FrameForces(NamedTuple):
    """Forces at n places: `across` V and `along` H, N; `torque` of the shaft, N mm; all (n,).

    `joint` is the force of the frame on the output link at D, N, in the fixed axes (2, n).
    """

    across: Array
    along: Array
    torque: Array
    joint: Array

    @property
    def pairs(self) -> tuple[Array, Array]:
        """Forces (n,) each, N, on faces 1 and 3 and on faces 2 and 4, above 0 where face 1 or face 2 pushes."""
        return self.across, 0.0 - self.along


def frame_forces(
    mechanism: Mechanism, motion: LinkageMotion, demand: Array, coupler: Coupler | None = None
) -> FrameForces:
    """Forces of the cam on the frame for a `demand` on the last output, N mm or N (n,), in the sense in which it grows.

    `motion` is of order 2. The force at `joint` holds for a linkage without dyads. Raises BindingError in a limit
    position of a loop.
    """
    # inertia of the coupler by the shaft angle; then Q_S and Q_S1 from the rates of the output by either lift
    still = np.zeros_like(motion.theta)
    inertia, spin = np.zeros((2, len(still))), still
    if coupler is not None:
        centre = mechanism.chain.frame(motion.solved).point(*coupler.centre)
        inertia = coupler.mass * np.array([motion.over_shaft(row.derivatives())[2] for row in centre])
        spin = coupler.inertia * motion.over_shaft(motion.frame)[2]
    needs, turned = [], []
    for moved in range(2):
        s, s1 = (Jet(np.array([lift, still + (k == moved)])) for k, lift in enumerate(motion.faces[:, 0]))
        solved = mechanism.chain.solve(s, s1, mechanism.about)
        turn = solved.linkage.frame.c[1]
        need = demand * solved.outputs[-1].c[1] + spin * turn
        if coupler is not None:
            x, y = mechanism.chain.frame(solved).point(*coupler.centre)
            need = need + inertia[0] * x.c[1] + inertia[1] * y.c[1]
        needs.append(need)
        turned.append(turn)
    # the torque first, from which V and H follow
    slope, slope1 = motion.faces[:, 1]
    torque = (slope * needs[0] + slope1 * needs[1]) / motion.shaft[1]
    across, along = needs[0] + turned[0] * torque, 0.0 - (needs[1] + turned[1] * torque)
    cos, sin = np.cos(motion.frame[0]), np.sin(motion.frame[0])
    joint = np.array([along * cos - across * sin, along * sin + across * cos]) - inertia
    return FrameForces(across, along, torque, joint)
