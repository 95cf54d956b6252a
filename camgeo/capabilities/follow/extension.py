"""What `camgeo follow` asks of cams that are no discs: the motion that a contour of theirs gives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Protocol

from camgeo.registry.slot import EMPTY, NO_CHECK, Slot
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Mapping

    from kin.numeric.arrays import Array


class FollowedOver(Protocol):
    """The motion that a file gives a follower, as the command prints and writes it."""

    @property
    def unit(self) -> Literal["mm", "rad"]:
        """Unit of the motion: mm along a line, rad of an arm."""
        ...

    @property
    def position(self) -> Array:
        """Positions of the follower (n,), mm or rad, at equal steps of the input."""
        ...

    def summary(self) -> str:
        """Text for a terminal."""
        ...

    def document(self) -> dict[str, Any]:
        """The same as plain data; lengths in mm, angles in degrees."""
        ...

    def table(self) -> str:
        """Motion over the input as CSV text."""
        ...

    def recipe(self, table: str) -> str:
        """Text of a recipe of a cam with this motion, whose lifts are in the file `table`; CallError where none is."""
        ...

    def told_recipe(self, table: str) -> tuple[str, list[str]]:
        """Text of the recipe that the command writes, and lines on what it has that the summary does not tell."""
        ...

    def lifts(self) -> str | None:
        """Lifts over the input as CSV text that the recipe reads; None where it needs none."""
        ...

    def page(self) -> str:
        """HTML of the page of that recipe, with the verdict on the file; raises CallError where none is made."""
        ...


@dataclass(frozen=True, kw_only=True)
class OtherInputs:
    """Answers of a capability whose cams are no discs.

    option         argument of `camgeo.follow` that asks for its motion; empty: it has none
    add_arguments  adds the options of its own to the parser of the command
    alone          options that go with that one alone: their arguments, and what these are where they are not given
    follow         the motion by all arguments of `camgeo.follow`, also those that are not given, in a namespace; raises
                   CallError where there is none, TypeError for an argument of its own of a wrong type
    solids         remedy for a solid that is no disc; empty where no such solid is followed
    drawings       remedy for a contour that goes round no shaft; empty where no such contour is followed
    """

    option: str = ""
    add_arguments: Callable[[argparse.ArgumentParser], None] = NO_CHECK
    follow: Callable[[argparse.Namespace], FollowedOver] | None = None
    solids: str = ""
    drawings: str = ""
    alone: Mapping[str, tuple[str, object]] = EMPTY


OTHER_INPUTS = Slot("follow", OtherInputs())
