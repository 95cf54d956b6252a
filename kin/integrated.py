"""A second opinion on a follower train's motion: the same law of contact, integrated step by step by scipy.

It shares the train and the motion with the exact solution, and nothing else: no series, no closed form, no events. The
force is the law of contact itself, max(0, k d + c d') where the spring is compressed by d > 0. It integrates from break
to break of the motion, since a step across a jump of the acceleration is no step of high order. Needs scipy.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from kin.dynamics import DynamicsError, Train

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.drive import Motion

Array = NDArray[np.float64]
Method = Literal["Radau", "BDF", "LSODA", "RK45", "DOP853"]

TURN = 2.0 * math.pi
_INSIDE = 1e-13  # how far within its stretch a motion is asked for, as a part of it


@dataclass(frozen=True)
class Integrated:
    """States z and z' (2, n) over the lower face at the asked shaft angles, contact forces (n,), and what it took."""

    states: Array
    force: Array
    evaluations: int
    steps: int


def integrated(
    train: Train,
    faces: tuple[Motion, Motion | None],
    rpm: float,
    places: Array,
    start: tuple[float, float],
    *,
    method: Method = "Radau",
    rtol: float = 1e-9,
    most: int | None = None,
    bonded: bool = False,
) -> Integrated:
    """Integrate from shaft angle 0 and state `start` (z, z') to the rising `places` (n,), any number of turns.

    `bonded` lets the contact pull, which makes it linear. `most` bounds the evaluations; DynamicsError beyond, or where
    the method itself gives up.
    """
    from scipy.integrate import solve_ivp

    running = train.at(rpm)
    k, c, kappa = train.stiffness / running.inertia, train.damping / (train.mass * running.speed), running.forcing.kappa
    constant = running.forcing.constant
    lower, upper = faces
    count = 0
    ends = [0.0, 0.0]

    def rows(motion: Motion, phi: float) -> Array:
        room = _INSIDE * (ends[1] - ends[0])
        at = min(max(phi, ends[0] + room), ends[1] - room)
        return motion.rows(np.array([math.fmod(at, TURN)]))[:, 0]

    def push(phi: float, z: float, v: float, s: Array) -> float:
        found = -(k * z + c * v)
        if bonded:
            return found
        found = max(found, 0.0) if z < 0.0 else 0.0
        if upper is not None:
            above = rows(upper, phi)
            d, rate = z - (above[0] - s[0]), v - (above[1] - s[1])
            found -= max(k * d + c * rate, 0.0) if d > 0.0 else 0.0
        return found

    def slope(phi: float, y: Array) -> Array:
        nonlocal count
        count += 1
        if most is not None and count > most:
            raise DynamicsError(f"more than {most} evaluations")
        s = rows(lower, phi)
        z, v = float(y[0]), float(y[1])
        return np.array([v, push(phi, z, v, s) - kappa * (z + s[0]) - s[2] - constant])

    size = np.array([(train.preload / train.stiffness) or 1e-12, 0.0])
    size[0] = max(size[0], abs(start[0]), running.inertia / train.stiffness * 1e-3)
    size[1] = max(size[0] * running.bound.natural, 1e-300)
    y = np.array(start, dtype=float)
    found = np.empty((2, len(places)))
    steps = 0
    knots = _knots(faces, float(places[-1]))
    for low, high in pairwise(knots.tolist()):
        ends[:] = [low, high]
        y[1] -= _leap(lower, low)
        inside = np.flatnonzero((places >= low) & (places <= high))
        implicit = {"jac": _jacobian(k, c, kappa)} if bonded and method in ("Radau", "BDF") else {}
        wanted = np.append(places[inside][places[inside] < high], high)
        run = solve_ivp(slope, (low, high), y, method=method, t_eval=wanted, rtol=rtol, atol=rtol * size, **implicit)
        if run.status != 0:
            raise DynamicsError(f"{method}: {run.message}")
        found[:, inside] = run.y[:, : len(inside)]
        y = run.y[:, -1]
        steps += run.nfev
    force = []
    for place, state in zip(places, found.T, strict=True):
        i = min(int(np.searchsorted(knots, place, side="right")) - 1, len(knots) - 2)
        ends[:] = [knots[i], knots[i + 1]]
        force.append(running.inertia * push(float(place), float(state[0]), float(state[1]), rows(lower, float(place))))
    return Integrated(found, np.array(force), count, steps)


def _jacobian(k: float, c: float, kappa: float) -> Array:
    return np.array([[0.0, 1.0], [-k - kappa, -c]])


def _knots(faces: Sequence[Motion | None], end: float) -> Array:
    """0, `end`, and all breaks between them."""
    breaks = np.concatenate([np.mod(face.breaks, TURN) for face in faces if face is not None] + [[0.0]])
    turns = TURN * np.arange(math.ceil(end / TURN) + 1)
    every = np.unique(np.concatenate([(breaks + turns[:, None]).ravel(), [end]]))
    every = every[every <= end]
    apart: Array = every[np.append(np.diff(every) > 1e-9, True)]
    return apart


def _leap(motion: Motion, phi: float) -> float:
    """Jump of the velocity at a corner of the motion, from values close to either side, corrected to first order."""
    corners = np.mod(motion.corners, TURN)
    apart = corners - math.fmod(phi, TURN)
    if not len(corners) or np.abs(apart - TURN * np.round(apart / TURN)).min() > 1e-9:
        return 0.0
    step = 1e-7
    after, before = (motion.rows(np.array([np.mod(phi + side * step, TURN)]))[:, 0] for side in (1.0, -1.0))
    return float(after[1] - step * after[2] - before[1] - step * before[2])
