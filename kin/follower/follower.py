"""Followers made from contacts and an intended motion, to be judged on contours by contact."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kin.follower.flat import FlatFace, Yoke
from kin.law.contacts import Flat, Oscillating, Translating
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.law.support_function import Lift
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kin.follower.base import Follower
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.law.transmission_law import Transmission


def follower_of(
    contacts: Sequence[Contact[Guide, Touch]],
    law: Piecewise | Transmission,
    side: Side = 1,
    datum: Contact[Guide, Touch] | None = None,
) -> Follower:
    """Make the follower of contacts by its intended motion; the metal lies inside the contour (1) or outside (-1).

    `law` is the recipe's position over the shaft angle, mm or rad, and of two contacts on one arm the transmission. The
    follower's positions count from where the own position of `datum` is 0: of the first contact where that is None.
    Raises ValueError for contacts for which no follower is known, TypeError for a flat face on a line of travel
    together with a contact of another kind.
    """
    first, *others = contacts
    flat, arm = isinstance(first.touch, Flat), isinstance(first.guide, Oscillating)
    _demand(side > 0 or not (flat or others), "a ring is followed by one roller")
    # two contacts on one arm, which swings by a transmission
    if not isinstance(law, Piecewise):
        from kin.follower.faces_on_arm import FlatPair
        from kin.follower.roller import DoubleRoller

        _demand(arm and len(others) == 1 and _share_arm(first, others[0]), "a transmission has two contacts on one arm")
        if not flat:
            return DoubleRoller(tuple(contacts), side, law)
        _demand(
            all(contact.datum == 0.5 * math.pi for contact in contacts),
            "the faces of a pair count from across the line",
        )
        return FlatPair(tuple(replace(contact, datum=contact.apart) for contact in contacts), law)
    # contacts of a law: the follower's positions are counted from the datum's zero, the contacts' away from the metal
    alone = not others and side > 0 and not (flat and arm)
    pushes = first.sense == 1 and first.turned == 0.0
    _demand(alone or pushes, "contact 1 pushes the follower out, where the shaft stands")
    _demand(not (isinstance(first.touch, Flat) and arm and first.touch.tilt), "a face on an arm stands along it")
    if flat and not arm:
        first, *others = (_through_shaft(contact) for contact in contacts)
        datum = datum and _through_shaft(datum)
    zero = (datum or first).zero
    placed = tuple(contact.raised(zero).away_from(side) for contact in (first, *others))
    raised = law.raised(zero)
    # two opposite contacts in a frame, or one
    if others:
        _demand(len(others) == 1 and _opposite(first, others[0]), "two contacts on a line are opposite")
        if flat:
            return Yoke(placed, Lift(raised))
        from kin.follower.roller import RollerYoke

        return RollerYoke(placed, side, raised)
    if not flat:
        from kin.follower.roller import GuidedRoller

        return GuidedRoller(placed, side, raised)
    if arm:
        from kin.follower.faces_on_arm import SwingingFace

        return SwingingFace(placed, raised)
    return FlatFace(placed, Lift(raised))


def still_follower(contacts: Sequence[Contact[Guide, Touch]], side: Side = 1) -> Follower:
    """Make the follower of contacts for a contour without an intended motion: its intended position is constant.

    The metal lies inside the contour (side 1) or outside (-1). Raises ValueError for contacts for which no follower is
    known, TypeError for a flat face on a line of travel together with a contact of another kind.
    """
    return follower_of(contacts, Piecewise(np.array([0.0, TURN]), (Constant(0.0),), TURN), side)


def followers_of(
    contacts: Sequence[Contact[Guide, Touch]], law: Piecewise | Transmission, sides: Mapping[str, Side]
) -> dict[str, Follower]:
    """Followers by the name of the surface on which they run, one for each surface in `sides`.

    Each has the contacts that touch its surface, and the surface is judged by it. `law` is the follower's position over
    the shaft angle, mm or rad, or a transmission; `sides` gives for each surface whether the metal lies inside (1) or
    outside (-1). Raises ValueError for contacts for which no follower is known, for a contact on a surface that is not
    in `sides` and for a surface without a contact.
    """
    _demand(
        {contact.surface for contact in contacts} == set(sides), "each touches one of the surfaces, and each is touched"
    )
    first = contacts[0] if len(sides) > 1 else None
    return {
        name: follower_of([contact for contact in contacts if contact.surface == name], law, side, first)
        for name, side in sides.items()
    }


def _demand(holds: bool, rule: str) -> None:
    if not holds:
        raise ValueError(f"no follower is known for these contacts: {rule}")


def _share_arm(first: Contact[Guide, Touch], second: Contact[Guide, Touch]) -> bool:
    """Whether contacts trail and lead one pivot alike; the trailing one keeps the swing below."""
    guides = [replace(contact.guide, side=1) for contact in (first, second) if isinstance(contact.guide, Oscillating)]
    sides = [
        (contact.guide.side, contact.sense, contact.turned)
        for contact in (first, second)
        if isinstance(contact.guide, Oscillating)
    ]
    return guides[:1] == guides[1:] and first.touch == second.touch and sides == [(1, -1, 0.0), (-1, 1, 0.0)]


def _opposite(first: Contact[Guide, Touch], second: Contact[Guide, Touch]) -> bool:
    """Whether two contacts of a frame on a line through the shaft meet the cam half a turn apart."""
    through = first.guide == second.guide == Translating()
    across = not (isinstance(first.touch, Flat) and first.touch.tilt)
    return through and across and first.touch == second.touch and (second.sense, second.turned) == (-1, math.pi)


def _through_shaft(contact: Contact[Guide, Touch]) -> Contact[Guide, Touch]:
    """The contact of a face on a line of travel as one on the parallel through the shaft: the cam is the same."""
    guide, touch = contact.guide, contact.touch
    if isinstance(guide, Oscillating) or not isinstance(touch, Flat):
        raise TypeError("a face on a line of travel")
    _demand(touch.nearer == 0.0, "only a face on an arm stands nearer the shaft than its pivot's parallel")
    return replace(contact, datum=contact.datum + guide.offset * math.tan(touch.tilt))
