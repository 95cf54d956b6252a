# needs: dynamics
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

from kin.dynamics.train import DynamicsError, Train

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.follower.drive import Excitation

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
    faces: tuple[Excitation, Excitation | None],
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

    law = _Law(train, faces, rpm, most, bonded)
    running = law.running
    size = np.array([(train.preload / train.stiffness) or 1e-12, 0.0])
    size[0] = max(size[0], abs(start[0]), running.inertia / train.stiffness * 1e-3)
    size[1] = max(size[0] * running.bound.natural, 1e-300)
    y = np.array(start, dtype=float)
    found = np.full((2, len(places)), np.nan)
    steps = 0
    knots = _knots(faces, float(places[-1]))
    implicit = {"jac": law.jacobian} if bonded and method in ("Radau", "BDF") else {}
    for low, high in pairwise(knots.tolist()):
        law.stretch = low, high
        y[1] -= _leap(faces[0], low)
        inside = np.flatnonzero((places >= low) & (places <= high))
        wanted = np.append(places[inside][places[inside] < high], high)
        run = solve_ivp(
            law.slope, (low, high), y, method=method, t_eval=wanted, rtol=rtol, atol=rtol * size, **implicit
        )
        if run.status != 0:
            raise DynamicsError(f"{method}: {run.message}")
        found[:, inside] = run.y[:, : len(inside)]
        y = run.y[:, -1]
        steps += run.nfev
    force = []
    for place, state in zip(places.tolist(), found.T, strict=True):
        i = min(int(np.searchsorted(knots, place, side="right")) - 1, len(knots) - 2)
        law.stretch = float(knots[i]), float(knots[i + 1])
        force.append(running.inertia * law.push(place, float(state[0]), float(state[1]), law.rows(faces[0], place)))
    return Integrated(found, np.array(force), law.count, steps)


class _Law:
    """The law of motion z'' = push - kappa (z + s) - s'' - constant, over one stretch of the faces at a time.

    `count` is how often it was evaluated, which `most` bounds.
    """

    def __init__(
        self, train: Train, faces: tuple[Excitation, Excitation | None], rpm: float, most: int | None, bonded: bool
    ) -> None:
        self.running = train.at(rpm)
        self.k, self.c = train.stiffness / self.running.inertia, train.damping / (train.mass * self.running.speed)
        self.lower, self.upper = faces
        self.most, self.bonded = most, bonded
        self.stretch = 0.0, 0.0
        self.count = 0

    @property
    def jacobian(self) -> Array:
        """Derivatives of the slope by the state where the contact pulls as well."""
        return np.array([[0.0, 1.0], [-self.k - self.running.forcing.kappa, -self.c]])

    def rows(self, motion: Excitation, phi: float) -> Array:
        """A face's displacement and two derivatives (3,), on this stretch's side of its ends."""
        low, high = self.stretch
        room = _INSIDE * (high - low)
        at = min(max(phi, low + room), high - room)
        return motion.rows(np.array([math.fmod(at, TURN)]))[:, 0]

    def push(self, phi: float, z: float, v: float, s: Array) -> float:
        """Force of contact over the inertia; `s` (3,) are the lower face's rows."""
        found = -(self.k * z + self.c * v)
        if self.bonded:
            return found
        found = max(found, 0.0) if z < 0.0 else 0.0
        if self.upper is not None:
            above = self.rows(self.upper, phi)
            d, rate = z - (above[0] - s[0]), v - (above[1] - s[1])
            found -= max(self.k * d + self.c * rate, 0.0) if d > 0.0 else 0.0
        return found

    def slope(self, phi: float, y: Array) -> Array:
        """Derivatives of the state (2,)."""
        self.count += 1
        if self.most is not None and self.count > self.most:
            raise DynamicsError(f"more than {self.most} evaluations")
        s = self.rows(self.lower, phi)
        z, v = float(y[0]), float(y[1])
        forcing = self.running.forcing
        return np.array([v, self.push(phi, z, v, s) - forcing.kappa * (z + s[0]) - s[2] - forcing.constant])


def _knots(faces: Sequence[Excitation | None], end: float) -> Array:
    """0, `end`, and all breaks between them; a break within 1e-9 of 0 is the one at 0."""
    breaks = np.concatenate([np.mod(face.breaks, TURN) for face in faces if face is not None] + [[0.0]])
    turns = TURN * np.arange(math.ceil(end / TURN) + 1)
    every = np.unique(np.concatenate([(breaks + turns[:, None]).ravel(), [end]]))
    every = every[every <= end]
    apart: Array = every[np.append(np.diff(every) > 1e-9, True)]
    apart[0] = 0.0
    return apart


def _leap(motion: Excitation, phi: float) -> float:
    """Jump of the velocity at a corner of the motion, from values close to either side, corrected to first order."""
    breaks = np.mod(motion.breaks, TURN)
    apart = breaks - math.fmod(phi, TURN)
    if motion.smooth or not len(breaks) or np.abs(apart - TURN * np.round(apart / TURN)).min() > 1e-9:
        return 0.0
    step = 1e-7
    after, before = (motion.rows(np.array([np.mod(phi + side * step, TURN)]))[:, 0] for side in (1.0, -1.0))
    return float(after[1] - step * after[2] - before[1] - step * before[2])
