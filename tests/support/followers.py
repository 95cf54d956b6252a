"""Followers of kin as tests speak of them: each of the records of its contacts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.follower.follower import follower_of
from kin.follower.guide import Arm, Line
from kin.law.contacts import TRAILING, Contact, Flat, Oscillating, Roller, Translating, on_one_arm, opposite

if TYPE_CHECKING:
    from typing import Any

    from kin.contour.contour import Contour
    from kin.law.contacts import Side
    from kin.law.piecewise import Piecewise
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array


def resting(follower: Any, contour: Contour, phi: Array) -> Any:
    """Position, mm or radians, on a contour: (n,), or (2, n) with each of two contacts resting."""
    found = np.stack([one.rows(phi)[0] / follower.si for one in follower.resting(contour)])
    return found if len(found) > 1 else found[0]


def flat_face(lift: Lift, tilt: float = 0.0) -> Any:
    return follower_of([Contact(Translating(), Flat(tilt))], lift.law)


def yoke(lift: Lift, breadth: float) -> Any:
    return follower_of(opposite(Flat(), breadth), lift.law)


def roller(guide: Arm | Line, radius: float, law: Piecewise, side: Side = 1) -> Any:
    """One roller by the formulas of its guide; the law counts from the shaft."""
    record = Translating(guide.offset) if isinstance(guide, Line) else of_arm(guide)
    return follower_of([Contact(record, Roller(radius))], law, side)


def of_arm(arm: Arm) -> Oscillating:
    return Oscillating(arm.pivot, arm.side, arm.length)


def roller_yoke(radius: float, law: Piecewise, breadth: float) -> Any:
    return follower_of(opposite(Roller(radius), breadth), law)


def double_roller(law: Transmission, radius: float) -> Any:
    return follower_of(on_one_arm(law.arm, law.arm, Roller(radius), np.pi, law.alpha), law)


def flat_pair(law: Transmission) -> Any:
    return follower_of(on_one_arm(2.0 * law.arm, None, Flat(), 0.5 * np.pi, 0.5 * law.alpha), law)


def swinging_face(pivot: float, nearer: float, law: Piecewise, side: Side = TRAILING) -> Any:
    return follower_of([Contact(Oscillating(pivot, side), Flat(nearer=nearer))], law)
