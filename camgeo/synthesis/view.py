"""A view of a design for drawing it: its follower's contacts by guide and touch, and its motion over the shaft angle.

Tables from arrangements to the functions that draw them are made of entries. Types are checked: a drawer for an arm
takes only views of arms.
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
        """Position from the zero of the contacts, mm or rad, and derivatives at shaft angles (n,): (order + 1, n)."""
        return self.design.motion.travel(shaft, order)

    def pressure(self, shaft: Array) -> Array:
        """Pressure angle of contact 1 at shaft angles (n,), rad, with the sign that `Surface.pressure` states.

        Not for two rollers on one arm, as the parameter of their contour is another angle than the shaft's.
        """
        return self.surface(self.contacts[0]).pressure(shaft)

    def surface(self, contact: Contact[G_co, T_co]) -> Surface:
        """Surface of the exact cam that a contact touches."""
        return next(surface for surface in self.design.exact.surfaces if surface.name == contact.surface)

    def place(self, shaft: Array) -> Array:
        """Place of contact 1 on a flat face at shaft angles (n,), rad: mm along the face, from stem axis or pivot.

        Raises TypeError where no flat face touches the cam.
        """
        place = self.surface(self.contacts[0]).place
        if place is None:
            raise TypeError("no flat face is touched")
        return place(shaft)

    def contact_points_fixed(self, shaft: Array) -> list[Array]:
        """Points of the contacts in the fixed frame at shaft angles (n,), rad: mm, as complex numbers (n,) each.

        Both contacts of a double-roller or a flat-pair; of any other follower contact 1 alone.
        """
        places = []
        # where no frame carries the follower, the cam's angle against it is the shaft's
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
    """View of a design with a follower of any guide and touch."""
    return View(recipe, design, design.follower.contacts)


Drawer: TypeAlias = "Callable[Concatenate[View[Guide, Touch], P], R]"


def entry(
    guide: type[G], touch: type[T], by: Callable[Concatenate[View[G, T], P], R], contacts: int = 1, discs: int = 1
) -> tuple[Arrangement, Drawer[P, R]]:
    """Entry of a table: the arrangement of guide, touch, number of contacts and discs, and a function of its views.

    `by` draws views of that guide and touch; the function raises TypeError for another view.
    """

    def draw(view: View[Guide, Touch], /, *args: P.args, **kwargs: P.kwargs) -> R:
        return by(view.of(guide, touch), *args, **kwargs)

    return Arrangement(guide, touch, contacts, discs), draw
