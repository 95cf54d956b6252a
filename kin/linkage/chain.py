"""A linkage with the dyads that hang on it: one chain, solved link by link from the two lifts that place the frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.linkage.dyad import coupler, output_link
from kin.numeric.elementary import Jet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.linkage.dyad import Dyad, Link, Reached
    from kin.linkage.four_bar import Linkage, Positions
    from kin.numeric.arrays import Array

__all__ = ["Chain", "Solved"]


class Solved(NamedTuple):
    """The linkage's positions, and what each dyad reaches, as jets."""

    linkage: Positions
    dyads: tuple[Reached, ...]

    @property
    def joints(self) -> tuple[tuple[Jet, Jet], ...]:
        """Joint D of the linkage, then the joint that each dyad's point drives; mm."""
        return (self.linkage.joint, *(reached.joint for reached in self.dyads))

    @property
    def outputs(self) -> tuple[Jet, ...]:
        """Output of the linkage, then of each dyad; rad or mm."""
        return (self.linkage.output, *(reached.output for reached in self.dyads))


@dataclass(frozen=True)
class Chain:
    """A linkage, the breadth of its frame, mm, and dyads in the order in which they are reached.

    Loop 0 is the linkage's, loop k that of the k-th dyad. ValueError if the first dyad hangs on a previous one.
    """

    linkage: Linkage
    breadth: float
    dyads: tuple[Dyad, ...] = ()

    def __post_init__(self) -> None:
        if self.dyads and self.dyads[0].on == "previous":
            raise ValueError("the first dyad has no previous one to be attached to")

    @property
    def unit(self) -> str:
        """Unit of the last output as reported, deg or mm."""
        return self.dyads[-1].unit if self.dyads else self.linkage.unit

    def solve(self, s: Jet, s1: Jet, about: Sequence[float]) -> Solved:
        """Solve for jets of the lifts S and S1, n points; dyad k takes its directions about `about[k]`.

        `about` may be shorter than the dyads: the rest of them are left out. Raises BindingError.
        """
        solved = Solved(self.linkage.solve(s, s1, self.breadth), ())
        for k, direction in enumerate(about):
            reached = self.dyads[k].solve(*self.hung(solved, k), direction)
            solved = Solved(solved.linkage, (*solved.dyads, reached))
        return solved

    def hung(self, solved: Solved, k: int) -> tuple[Jet, Jet]:
        """Return the point on which dyad k hangs, mm, from what is solved before it."""
        dyad = self.dyads[k]
        link: Link
        if dyad.on == "coupler":
            link = coupler(solved.linkage)
        elif dyad.on == "output":
            link = output_link(solved.linkage)
        else:
            link = self.dyads[k - 1].output_link(solved.dyads[k - 1])
        return link.point(*dyad.point)

    def margin(self, loop: int, s: Array, s1: Array, about: Sequence[float]) -> Array:
        """How far a loop is from binding, mm (n,), negative where it binds; BindingError where an earlier loop does."""
        if loop == 0:
            return np.broadcast_to(self.linkage.margin(s, s1, self.breadth), s.shape)
        x, y = self.hung(self.solve(Jet(s[None]), Jet(s1[None]), about[: loop - 1]), loop - 1)
        return np.broadcast_to(self.dyads[loop - 1].margin(x.c[0], y.c[0]), s.shape)
