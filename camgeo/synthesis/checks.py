"""Checks of the intent and of the exact curve, before any file: what would be wrong however well it were written."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.checks.declared import BREADTH, CLOSING, PRESSURE, RATIO, TRAVEL
from kin.judge.check import Check
from kin.law.feasibility import steepest
from kin.numeric.angles import degrees
from kin.numeric.distinct import distinct

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.synthesis.profile import Profile
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

LOOKS = 1440  # shaft angles at which smooth figures are looked at
STRETCH_LOOKS = 16  # and at so many of any stretch between breaks, however short
ZOOMS, ZOOM = 5, 32  # about the worst of these: so often, into so many parts
SAME_BREADTH = 1e-9  # of the size: a breadth that varies by less is constant
EXACT = 1e-9  # of the arm: to this the closing equation must hold


def breadth_of(lift: Lift) -> tuple[float, float, float]:
    """Mean breadth p(t) + p(t + pi) in mm, the greatest deviation from it, and where in radians."""
    t = _angles(np.mod(lift.breaks, math.pi), math.pi)
    p = lift.derivatives(np.concatenate([t, t + math.pi]), 0)[0]  # continuous: one side of a break will do
    breadth = p[: len(t)] + p[len(t) :]
    mean = 0.5 * float(breadth.max() + breadth.min())
    worst = int(np.argmax(np.abs(breadth - mean)))
    return mean, float(np.abs(breadth[worst] - mean)), float(t[worst])


def is_constant_breadth(lift: Lift) -> bool:
    """Whether a yoke of two parallel faces fits the cam; else it works a single flat face."""
    return is_constant(*breadth_of(lift)[:2])


def is_constant(mean: float, deviation: float) -> bool:
    """Whether a breadth that deviates from its mean by so much is constant."""
    return deviation <= SAME_BREADTH * abs(mean)


def flat_face_checks(lift: Lift, breadth: tuple[float, float, float] | None) -> list[Check]:
    """Constancy of the breadth (AS eq. 4, for a yoke) and the face's length: how far the contact travels along it.

    `breadth` is what `breadth_of` gives, None where a single face follows.
    """
    checks = []
    if breadth is not None:
        mean, deviation, at = breadth
        limit = SAME_BREADTH * abs(mean)
        checks.append(Check(BREADTH.name, deviation <= limit, deviation, limit, "mm", degrees(at)))
    t = _angles(lift.breaks, 2.0 * math.pi)
    low = _greatest(lambda u: -lift.derivatives(u, 1)[1], t)  # continuous too
    high = _greatest(lambda u: lift.derivatives(u, 1)[1], t)
    checks.append(Check(TRAVEL.name, True, low[0] + high[0], None, "mm", degrees(max(low, high)[1]), "at_least"))
    return checks


def transmission_checks(law: Transmission) -> list[Check]:
    """That the second arm's end runs on the same curve (W 4.6, 7.1), and how near the cam is to turning back.

    Both arms' ends are held against each other at the same polar angle, t = phi - (psi + alpha)/2 of the first and
    phi - (psi - alpha)/2 of the second: over it |psi'| < 2, while over the shaft angle psi may rise as steeply as it
    likes, and rounding with it.
    """
    tau = _angles(law.breaks, 2.0 * math.pi)
    phi, psi = law.at(tau, 0)
    image = law.at(law.polar_parameter(law.pitch(tau, 0)[1][0] + law.alpha), 0)[1][0]
    gap = law.arm * np.abs(image + psi[0])
    worst = int(np.argmax(gap))
    closing = Check(
        CLOSING.name,
        bool(gap[worst] <= EXACT * law.arm),
        float(gap[worst]),
        EXACT * law.arm,
        "mm",
        degrees(float(phi[0, worst])),
    )
    at, value = steepest(law)
    return [closing, Check(RATIO.name, value < 1.0, value, 1.0, "", degrees(float(law.at(at, 0)[0][0, 0])))]


def pressure_angle(profile: Profile, law: Transmission) -> Check:
    """Greatest angle between the contact normal and the direction in which a roller's arm lets it move, degrees.

    The same at both rollers, each of which runs once round the whole pitch curve. At 90 degrees the cam cannot drive.
    """

    def angle(t: Array) -> Array:
        at = profile.base.sample(t)
        phi = law.at(t, 0)[0][0]
        arm = at.point - law.arm * np.column_stack([np.cos(phi), np.sin(phi)])
        arm /= np.hypot(arm[:, 0], arm[:, 1])[:, None]
        normal = at.normal
        across = np.abs(arm[:, 0] * normal[:, 1] - arm[:, 1] * normal[:, 0])
        found: Array = np.degrees(np.arctan2(np.abs(np.sum(arm * normal, axis=1)), across))
        return found

    value, at = _greatest(angle, _angles(law.breaks, 2.0 * math.pi))
    return Check(PRESSURE.name, value < 90.0, value, 90.0, "deg", degrees(float(law.at(at, 0)[0][0, 0])))


def _greatest(of: Callable[[Array], Array], t: Array) -> tuple[float, float]:
    """Greatest value of a continuous function of period 2 pi, looked at at t (n,) and closely about the best; where."""
    seen = of(t)
    around = np.concatenate([t[-1:] - 2.0 * math.pi, t, t[:1] + 2.0 * math.pi])
    worst = int(np.argmax(seen))
    at, value = float(t[worst]), float(seen[worst])
    low, high = float(around[worst]), float(around[worst + 2])
    for _ in range(ZOOMS):
        t = np.linspace(low, high, ZOOM + 1)
        seen = of(t)
        worst = int(np.argmax(seen))
        if seen[worst] > value:
            at, value = float(t[worst]), float(seen[worst])
        low, high = max(low, t[worst] - (high - low) / ZOOM), min(high, t[worst] + (high - low) / ZOOM)
    return value, at


def _angles(breaks: Array, end: float) -> Array:
    """Evenly spread parameters in [0, end) with the breaks among them, and some between any two breaks."""
    inside = breaks[(breaks >= 0.0) & (breaks < end)]
    between = np.linspace(inside[:-1], inside[1:], STRETCH_LOOKS + 1)[:-1].ravel()
    return distinct(np.concatenate([np.linspace(0.0, end, LOOKS, endpoint=False), between, inside]))
