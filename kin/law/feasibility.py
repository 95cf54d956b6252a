"""Which transmission laws a cam can have: ratio, swing, slope and joints, each proved or refused with its figure."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.bounds import highest, undecided
from kin.law.normalised import IntentError
from kin.law.segment import Constant
from kin.numeric.elementary import DomainError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.segment import Stretch
    from kin.law.transmission_law import Transmission
    from kin.numeric.arrays import Array


JOIN = 1e-11  # rad: a jump in psi that is a formula's rounding
_SLOPE_JOIN = 1e-9  # a jump in psi'(phi), likewise


def demand_ratio(lam: int, mu: int, arm: float) -> None:
    """Raise IntentError unless pi/alpha = lam/mu is above 1, in lowest terms and of odd mu, and the arm, mm, above 0.

    W. Wunderlich, 1984 (W), 2.2 and section 3.
    """
    if not (math.isfinite(arm) and arm > 0):
        raise IntentError(f"the arm must be above 0, not {arm:.6g} mm", "arm")
    if mu < 1 or lam <= mu:
        raise IntentError(f"pi/alpha = lam/mu must be above 1, not {lam}/{mu} (W 2.2)", "ratio")
    common = math.gcd(lam, mu)
    if common > 1:
        raise IntentError(f"{lam}/{mu} is not in lowest terms; write {lam // common}/{mu // common}", "ratio")
    if mu % 2 == 0:
        raise IntentError(f"the denominator of {lam}/{mu} is even: the pitch curve would cross itself (W 3)", "ratio")


def checked(
    law: Transmission, knots: Sequence[float], functions: Sequence[Stretch], field: str, *, corners: bool = False
) -> Transmission:
    """Return the law if psi exists, is possible and joins over its period; else raise IntentError at `field`.

    `functions` are psi over the first delta, stretch i between knots i and i + 1, rad. With `corners` the slope of psi
    need not join.
    """
    try:
        _demand_possible(law, knots, functions, field)
        _demand_joined(law, field, corners=corners)
    except DomainError as error:
        raise IntentError(f"the law is not defined: {error.operation}", field) from error
    return law


def _demand_possible(law: Transmission, knots: Sequence[float], functions: Sequence[Stretch], field: str) -> None:
    """Prove 0 < r < 2l and psi'(phi) < 1 over the whole period, or refuse with the angle and the figure.

    By W 4.9 the stretches over delta decide. |psi| must stay below alpha and pi - alpha. psi'(phi) < 1 is psi' < 1 by
    phi on a given stretch (w = 0; its image has -psi'/(1 - psi')), and |psi'| < 2 by t on a polar one (w = 1/2). Then
    phi rises with tau all round.
    """
    limit = min(law.alpha, math.pi - law.alpha)
    steep = (-2.0, 2.0) if law.lean[0] == 0.5 else (-math.inf, 1.0)
    for function, begin, end in zip(functions, knots[:-1], knots[1:], strict=True):
        if isinstance(function, Constant) and abs(function.value) < limit:
            continue
        doubts = undecided(function, begin, end, {0: (-limit, limit), 1: steep})
        if doubts is None:
            continue
        if doubts[0] == 1:
            raise too_steep(law, field)
        at, swing = highest(law.psi, [1.0] * len(law.lean), 0)
        raise too_wide(law, at, swing, field)


def too_wide(law: Transmission, angle: float, swing: float, field: str) -> IntentError:
    """Make the error for a law whose swing leads roller A's distance r from the shaft out of 0 < r < 2l, l the arm.

    The swing is `swing`, rad, at the law's parameter tau = `angle`, rad; `field` is that of the error.
    """
    limit = min(law.alpha, math.pi - law.alpha)
    end = "2l" if law.alpha < math.pi / 2 else "0"
    return IntentError(
        f"the follower would swing {math.degrees(swing):.6g} degrees to each side; below {math.degrees(limit):.6g} is "
        f"possible with lam/mu = {law.lam}/{law.mu}, there roller A's distance from the shaft reaches {end}",
        field,
        _shaft_deg(law, angle),
    )


def _shaft_deg(law: Transmission, tau: float) -> float:
    return math.degrees(float(law.at(tau, 0)[0][0, 0])) % 360


def steepest(law: Transmission) -> tuple[float, float]:
    """Parameter tau at which psi'(phi) is greatest, and that slope; sampled on every stretch, not proved."""
    weights = [1 - w for w in law.lean]
    weight = max(weights)  # 1/2 on every polar stretch; 1 on a given law, 0 on its image
    at, most = highest(law.psi, weights, 1)
    slope = most / weight
    return at, slope / (1 + (1 - weight) * slope)


def too_steep(law: Transmission, field: str) -> IntentError:
    """Make the error for a law whose slope psi'(phi) reaches 1, with its greatest value and the shaft angle there."""
    at, figure = steepest(law)
    degrees = _shaft_deg(law, at)
    return IntentError(
        f"psi'(phi) must stay below 1, else the cam cannot be turned through; it reaches {figure:.9g} at a shaft angle "
        f"of {degrees:.6g} degrees",
        field,
        degrees,
    )


def _demand_joined(law: Transmission, field: str, *, corners: bool) -> None:
    """Raise IntentError for a jump of psi, or without `corners` of its slope psi'(phi), between stretches."""
    knots = law.psi.knots[:-1]
    limits = law.at(np.tile(knots, 2), 1, np.repeat([1, -1], knots.size))
    (phi, phi_left), (psi, psi_left) = (np.hsplit(rows, 2) for rows in limits)
    slope, slope_left = psi[1] / phi[1] + 0.0, psi_left[1] / phi_left[1] + 0.0  # no -0 in a message
    for i in range(len(knots)):
        at = math.degrees(phi[0, i]) % 360
        if abs(psi[0, i] - psi_left[0, i]) > JOIN:
            before, after = math.degrees(psi_left[0, i]), math.degrees(psi[0, i])
            raise IntentError(f"psi jumps from {before:.9g} to {after:.9g} degrees at {at:.6g} degrees", field, at)
        if not corners and abs(slope[i] - slope_left[i]) > _SLOPE_JOIN * (1 + abs(slope[i])):
            raise IntentError(
                f"psi'(phi) jumps from {slope_left[i]:.9g} to {slope[i]:.9g} at a shaft angle of {at:.6g} degrees: the "
                "pitch curve would have a corner",
                field,
                at,
            )


def demand_leaf(x: Array, distance: Array, arm: float, most: float) -> None:
    """Raise IntentError unless |OQ| = `distance` (n,), mm, at places x (n,) of a leaf, 0 to 1, suits the `arm`, mm.

    It must be 0 at both ends, nowhere negative, and below `most`, mm, where an arm is fully stretched or meets the
    shaft.
    """
    field = "rosette.leaf"
    ends = np.flatnonzero(((x == 0) | (x == 1)) & (np.abs(distance) > JOIN * arm))
    low, high = int(np.argmin(distance)), int(np.argmax(distance))
    if len(ends):
        at, gap = x[ends[0]], distance[ends[0]]
        raise IntentError(f"the leaf must begin and end in the shaft; |OQ| is {gap:.9g} mm at x = {at:.6g}", field)
    if distance[low] < -JOIN * arm:
        raise IntentError(f"|OQ| is a distance; it is {distance[low]:.9g} mm at x = {x[low]:.6g}", field)
    if distance[high] >= most:
        raise IntentError(
            f"|OQ| must stay below {most:.9g} mm, where an arm would reach the shaft or be fully stretched; it is "
            f"{distance[high]:.9g} mm at x = {x[high]:.6g}",
            field,
        )
