"""A linkage with the dyads that hang on it: one chain, solved link by link from the two lifts that place the frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from kin.linkage.links import Link, bar
from kin.numeric.elementary import Jet, cos, sin
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.linkage.dyad import Dyad, Reached
    from kin.linkage.four_bar import Linkage, Positions
    from kin.linkage.links import Joint, Place
    from kin.numeric.arrays import Array

__all__ = ["Carrier", "Chain", "Solved"]


class Solved(NamedTuple):
    """Solved positions of the linkage and of each dyad for the lifts S and S1, all as jets."""

    lifts: tuple[Jet, Jet]
    linkage: Positions
    dyads: tuple[Reached, ...] = ()

    @property
    def joints(self) -> tuple[Place, ...]:
        """Joint D of the linkage, then the joint that each dyad's point drives; mm."""
        return (self.linkage.joint, *(reached.joint for reached in self.dyads))

    @property
    def outputs(self) -> tuple[Jet, ...]:
        """Output of the linkage, then of each dyad; rad or mm."""
        return (self.linkage.output, *(reached.output for reached in self.dyads))


class Carrier(NamedTuple):
    """A link on which a dyad can hang: its name, and its pose, in whose axes the dyad's `point` is given."""

    name: str
    pose: Callable[[Solved], Link]


@dataclass(frozen=True)
class Chain:
    """A linkage, the breadth of its frame, mm, and dyads in the order in which they are reached.

    Dyad k is `dyads[k]`, from 0; loop 0 is the linkage's, loop k + 1 that of dyad k. Raises ValueError if the first
    dyad hangs on a previous one.
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
        """Solve for lifts S and S1, mm, jets at n points; dyad k takes its directions within pi of `about[k]`, rad.

        Dyads beyond the length of `about` are left out. Raises BindingError where a loop does not close, or stands in a
        limit position and the jets have derivatives.
        """
        solved = Solved((s, s1), self.linkage.solve(s, s1, self.breadth))
        for k, direction in enumerate(about):
            reached = self.dyads[k].solve(*self.hung(solved, k), direction)
            solved = solved._replace(dyads=(*solved.dyads, reached))
        return solved

    def frame(self, solved: Solved) -> Link:
        """The square frame as a link: origin in its middle, x along u(theta_3)."""
        half = 0.5 * self.breadth
        s, s1 = solved.lifts
        angle = solved.linkage.frame
        x, y, c, n = half - s1, s - half, cos(angle), sin(angle)
        return Link((c * x - n * y, n * x + c * y), angle)

    def output(self, loop: int) -> Carrier:
        """Rocker or slide that a loop drives; in the name of a dyad's stands its number, from 1."""
        if loop == 0:
            return Carrier(self.linkage.driven, lambda solved: self.linkage.output_link(solved.linkage))
        dyad, k = self.dyads[loop - 1], loop - 1
        return Carrier(f"{dyad.driven}-{loop}", lambda solved: dyad.output_link(solved.dyads[k]))

    def carrier(self, k: int) -> Carrier:
        """Return the link on which `dyads[k]` hangs."""
        on = self.dyads[k].on
        return self.output(k) if on == "previous" else self.carrier_of(on)

    def carrier_of(self, on: str) -> Carrier:
        """Link of a name: the linkage's `coupler` or `output`, or `dyads[0]`, ... for the output link of a dyad.

        Raises ValueError for another name, IndexError for a dyad that the chain lacks.
        """
        if on == "coupler":
            return Carrier(self.linkage.joined, lambda solved: solved.linkage.coupler)
        return self.output(0 if on == "output" else 1 + int(on.removeprefix("dyads[").removesuffix("]")))

    def hung(self, solved: Solved, k: int) -> Place:
        """Return the point to which dyad k is attached, mm, from the links solved before it."""
        return self.carrier(k).pose(solved).point(*self.dyads[k].point)

    def rod(self, solved: Solved, k: int) -> Link:
        """Link from the point P to which `dyads[k]` is attached, its origin, towards the joint Q on its x axis."""
        return bar(self.hung(solved, k), solved.dyads[k].joint)

    def joints(self, solved: Solved, loop: int) -> dict[str, Joint]:
        """Return the joints of a loop by name: B and D of the linkage, P, Q and G of a dyad."""
        if loop == 0:
            return self.linkage.joints(solved.linkage)
        return self.dyads[loop - 1].joints(self.hung(solved, loop - 1), solved.dyads[loop - 1])

    def margins(self, loop: int, s: Array, s1: Array, about: Sequence[float]) -> Array:
        """Distances of a loop from its k limits, mm (k, n), below 0 where it binds.

        Each is smooth where the lifts S and S1 (n,), mm, are. Dyad k takes its directions within pi of `about[k]`, rad.
        Raises BindingError where an earlier loop binds.
        """
        if loop == 0:
            return self.linkage.margins(s, s1, self.breadth)
        x, y = self.hung(self.solve(Jet(s[None]), Jet(s1[None]), about[: loop - 1]), loop - 1)
        return self.dyads[loop - 1].margins(x.c[0], y.c[0])
