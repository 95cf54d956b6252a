"""A design as whoever draws it asks: its follower's contacts by guide and touch, and what moves over the shaft angle.

A table from arrangement to what draws it is made of entries. Types are checked: a drawer for an arm takes the views of
arms alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Concatenate, Generic, ParamSpec, TypeAlias, TypeVar

import numpy as np

from kin.law.contacts import (
    Arrangement,
    Contact,
    Flat,
    G_co,
    Guide,
    KnifeEdge,
    Oscillating,
    Roller,
    Shoe,
    T_co,
    Touch,
    Translating,
)
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.surface import Surface
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

Round: TypeAlias = Roller | Shoe | KnifeEdge
G = TypeVar("G", Translating, Oscillating)
T = TypeVar("T", Roller, KnifeEdge, Shoe, Flat)
P = ParamSpec("P")
R = TypeVar("R")


@dataclass(frozen=True, eq=False)
class View(Generic[G_co, T_co]):
    """A recipe with its design, and the contacts of the follower."""

    recipe: Recipe
    design: Design
    contacts: tuple[Contact[G_co, T_co], ...]

    @property
    def guide(self) -> G_co:
        """Guide of contact 1."""
        return self.contacts[0].guide

    @property
    def touch(self) -> T_co:
        """Touch of contact 1: roller, shoe, knife edge or flat face."""
        return self.contacts[0].touch

    @property
    def datum(self) -> float:
        """Own position of contact 1 where the follower's is 0: foot or level, mm, or rest, rad."""
        return self.contacts[0].datum

    def travel(self, shaft: Array, order: int = 0) -> Array:
        """Position of the follower from the zero of its contacts, mm or rad, and derivatives, (order + 1, n)."""
        return self.design.motion.travel(shaft, order)

    def pressure(self, shaft: Array) -> Array:
        """Pressure angle, rad (n,), above 0 where the cam drives a rise."""
        return self.surface(self.contacts[0]).pressure(shaft)

    def surface(self, contact: Contact[G_co, T_co]) -> Surface:
        """Surface of the exact cam that a contact touches."""
        return next(surface for surface in self.design.exact.surfaces if surface.name == contact.surface)

    def place(self, shaft: Array) -> Array:
        """Place of contact on a flat face, mm along it (n,), from the axis of its stem or the pivot of its arm.

        Raises TypeError where no flat face is touched.
        """
        place = self.surface(self.contacts[0]).place
        if place is None:
            raise TypeError("no flat face is touched")
        return place(shaft)

    def contact_points_fixed(self, shaft: Array) -> list[Array]:
        """Point of contact of each contact in the fixed frame, mm, as complex numbers (n,)."""
        places = []
        parameters = self.design.motion.parameters(shaft, shaft).values()
        for contact, t in zip(self.contacts, parameters, strict=False):  # opposite contacts on a line have one
            point = self.surface(contact).curve.sample(np.mod(t, TURN)).point
            places.append((point[:, 0] + 1j * point[:, 1]) * np.exp(-1j * shaft))
        return places

    def of(self, guide: type[G], touch: type[T]) -> View[G, T]:
        """View of this recipe and design, typed for contacts of that guide and touch; raises TypeError for others."""
        contacts = []
        for contact in self.contacts:
            if not (isinstance(contact.guide, guide) and isinstance(contact.touch, touch)):
                raise TypeError(f"no {touch.__name__} on a guide {guide.__name__}: {contact}")
            contacts.append(
                Contact(
                    contact.guide,
                    contact.touch,
                    contact.datum,
                    contact.sense,
                    contact.apart,
                    contact.turned,
                    contact.surface,
                )
            )
        return View(self.recipe, self.design, tuple(contacts))


def view_of(recipe: Recipe, design: Design) -> View[Guide, Touch]:
    """View a design whatever its follower is."""
    return View(recipe, design, design.follower.contacts)


Drawer: TypeAlias = "Callable[Concatenate[View[Guide, Touch], P], R]"


def entry(
    guide: type[G], touch: type[T], by: Callable[Concatenate[View[G, T], P], R], contacts: int = 1, discs: int = 1
) -> tuple[Arrangement, Drawer[P, R]]:
    """Make the entry of a table: an arrangement, and what draws views of it."""

    def draw(view: View[Guide, Touch], /, *args: P.args, **kwargs: P.kwargs) -> R:
        return by(view.of(guide, touch), *args, **kwargs)

    return Arrangement(guide, touch, contacts, discs), draw
