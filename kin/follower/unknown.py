"""Shaft angles at which a motion depends on a stretch of the contour of which nothing is known."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.across import notched, tented
from kin.follower.measured import positions
from kin.follower.motion_error import ContactError
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.across import Bridge
    from kin.contour.contour import Contour
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.numeric.arrays import Array, Mask

SAME = 1e-9  # of the position: positions that differ by more are of two contacts


def unknown_angles(contour: Contour, bridge: Bridge, contact: Contact[Guide, Touch], side: Side, phi: Array) -> Mask:
    """Whether the position at shaft angles phi (n,), rad, depends on the stretch that closes the contour: (n,).

    It does where the follower stands otherwise with a notch in place of the stretch than with the contour's tangents in
    place of it: on the stretch, or on one of its ends beyond the tangent there. Raises ContactError where the touch
    meets nothing on the contour with the tangents.
    """
    out = positions(tented(contour, bridge), contact, side, phi)
    deep = notched(contour, bridge)
    try:
        inward = positions(deep, contact, side, phi)
    except ContactError:  # a knife edge falls into it
        inward = np.array([_position(deep, contact, side, angle) for angle in phi.tolist()])
    differ: Mask = ~(np.abs(out - inward) <= SAME * np.maximum(1.0, np.abs(out)))
    return differ


def _position(contour: Contour, contact: Contact[Guide, Touch], side: Side, angle: float) -> float:
    try:
        return float(positions(contour, contact, side, np.array([angle]))[0])
    except ContactError:
        return math.nan


def stretches(phi: Array, which: Mask) -> list[tuple[float, float]]:
    """Stretches (begin, end), rad, end > begin, of equal steps phi (n,) round the turn that are marked in `which` (n,).

    They reach from the first angle that is marked to the last.
    """
    if which.all() or not which.any():
        return [(0.0, TURN)] if which.all() else []
    begins, ends = np.flatnonzero(which & ~np.roll(which, 1)), np.flatnonzero(which & ~np.roll(which, -1))
    ends = ends if ends[0] >= begins[0] else np.roll(ends, -1)
    pairs = zip(phi[begins].tolist(), phi[ends].tolist(), strict=True)
    return [(begin, end if end >= begin else end + TURN) for begin, end in pairs]


def across_words(bridge: Bridge, at: Sequence[tuple[float, float]]) -> str:
    """Sentence on a stretch that closes a contour, and the shaft angles at which the motion depends on it, degrees."""
    first, last = (math.degrees(angle) for angle in bridge.angles)
    spans = [f"{math.degrees(begin):.1f} to {math.degrees(end) % 360.0:.1f}" for begin, end in at]
    touched = (
        f"the motion depends on it at shaft angles from {' and '.join(spans)}"
        if at
        else "the motion does not depend on it"
    )
    return f"nothing is known of the contour from {first:.1f} to {last:.1f} degrees, where it is closed; {touched}"
