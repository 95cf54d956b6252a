"""The motion of a follower on a contour, by contact: what a drawing does, whatever it was meant to do."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.follower.follower import unled

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.numeric.arrays import Array

_LOOKS = 256  # places of a contour at which it is asked whether it goes round the shaft


def rolled(contact: Contact[Guide, Touch], contour: Contour, side: Side, phi: Array) -> Array:
    """Positions at shaft angles phi (n,), mm or rad, less the least of them; (n,).

    The shaft is at the origin, the contour as it stands at angle 0. ContactError where the follower finds no contact.
    """
    gauge = unled((contact,), side)
    rest, *_ = gauge.resting(contour)
    position: Array = rest.rows(phi)[0] / gauge.si
    return position - float(position.min())


def track(contours: list[Contour], side: Side) -> Contour | None:
    """The contour on which a follower runs: of those round the shaft the outermost, or in a ring the one inside it."""
    about = [contour for contour in contours if _goes_round(contour)]
    about.sort(key=lambda contour: -abs(contour.area))
    inner = about[1:] if side < 0 and len(about) > 1 else about
    return inner[0] if inner else None


def _goes_round(contour: Contour) -> bool:
    x, y = contour.sample(_LOOKS).T
    angle = np.unwrap(np.append(np.arctan2(y, x), math.atan2(y[0], x[0])))
    return bool(abs(angle[-1] - angle[0]) > math.pi)
