"""What each dimension of a budget does to the follower, or to a linkage's output, over the shaft angle.

The metal of the cam stays as it is: no dimension makes a new design. A contribution is what one made size does, alone
of all: two rollers of one drawing are two of them. Where a machine is set at one angle, all are counted from there; the
profile is another one at each angle, so that what it does at that angle stands beside what it does elsewhere.
"""

from __future__ import annotations

from operator import itemgetter
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from camgeo.capabilities.budget.words import BORE, PROFILE
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.capabilities.budget.keys import Budget
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.influence import Bearing
    from kin.law.contacts import Contact, Guide, Touch
    from kin.linkage.influence import FrameBearing
    from kin.numeric.arrays import Array, Complexes

Rows: TypeAlias = "list[Array]"  # (contacts, components, n) of each contribution
COMPONENTS = (1.0, 1j)  # of a displacement in any direction


@dataclass(frozen=True, eq=False)
class Contribution:
    """What one size does: `rows` (m, k, n) at m contacts, in mm or rad of the motion per mm or rad of the size.

    `tolerance` is plus and minus, or with k = 2 the radius about the two components; None where it is to be found.
    `constant` is that of the profile where the machine is set, which is the same at all angles.
    """

    name: str
    tolerance: float | None
    rows: Array
    constant: bool = False


@dataclass(frozen=True, eq=False)
class Output:
    """A figure of the motion that errors change: the position by one contact, their middle, or the play between them.

    `weights` (c, n) are what each contribution does to it, at most, per mm or rad of its tolerance.
    """

    name: str
    weights: Array


@dataclass(frozen=True, eq=False)
class Influence:
    """All contributions at shaft angles (n,), rad; `contacts` names what the follower, or the frame, bears on.

    `upper` is the index of the contact that bounds the position from above, of two; `play` the nominal one (n,).
    """

    shaft: Array
    contributions: tuple[Contribution, ...]
    contacts: tuple[str, ...]
    upper: int | None = None
    play: Array | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Words of the dimensions, each once."""
        return tuple(dict.fromkeys(contribution.name for contribution in self.contributions))

    def outputs(self) -> tuple[Output, ...]:
        """The position by each contact."""
        return tuple(Output(name, self._weights(itemgetter(i))) for i, name in enumerate(self.contacts))

    def middle(self) -> Output | None:
        """The middle of what two contacts leave, None of a follower with one."""
        return None if self.upper is None else Output("middle", self._weights(lambda rows: rows.mean(axis=0)))

    def play_between(self) -> Output | None:
        """The play between two contacts, None of a follower with one."""
        upper = self.upper
        if upper is None:
            return None
        return Output("play", self._weights(lambda rows: rows[upper] - rows[1 - upper]))

    def _weights(self, chosen: Callable[[Array], Array]) -> Array:
        rows = (chosen(contribution.rows) for contribution in self.contributions)
        return np.stack([np.sqrt((row**2).sum(axis=0)) for row in rows])


def influence(recipe: Recipe, design: Design, budget: Budget, shaft: Array) -> Influence:
    """What each dimension of a budget does at shaft angles (n,).

    Raises PlaceError of a linkage that does not turn.
    """
    zero = budget.zero
    places = shaft if zero is None else np.append(shaft, zero)
    rows_of, contacts, upper, play = (
        _of_linkage(design, places) if recipe.linkage else _of_follower(design, places, budget.guide or 0.0)
    )
    contributions = []
    for name, tolerance in budget.tolerances:
        for rows in rows_of(name):
            at_zero = rows[:, :, -1:]
            if zero is None:
                contributions.append(Contribution(name, tolerance, rows))
            elif name == PROFILE:
                contributions.append(Contribution(name, tolerance, rows[:, :, :-1]))
                at_all = np.broadcast_to(at_zero, rows[:, :, :-1].shape)
                contributions.append(Contribution(name, tolerance, at_all, constant=True))
            else:
                contributions.append(Contribution(name, tolerance, rows[:, :, :-1] - at_zero))
    nominal = None if play is None else play[: len(shaft)]
    return Influence(shaft, tuple(contributions), contacts, upper, nominal)


def velocities(influence: Influence, waves: int) -> Influence:
    """The same of the velocity by the shaft angle, from even angles over a whole turn.

    A size that is off by t changes the velocity by t dw/dphi. The profile's error t sin(n phi + any) of n `waves`
    changes it by at most t hypot(dw/dphi, n w): its two components.
    """
    step = float(influence.shaft[1] - influence.shaft[0])
    contributions = []
    for one in influence.contributions:
        slope = (np.roll(one.rows, -1, axis=2) - np.roll(one.rows, 1, axis=2)) / (2.0 * step)
        wavy = one.name == PROFILE and not one.constant
        rows = np.concatenate([slope, waves * one.rows], axis=1) if wavy else slope
        contributions.append(replace(one, rows=rows))
    return replace(influence, contributions=tuple(contributions), play=None)


def even(count: int) -> Array:
    """So many even shaft angles of one turn, from 0, rad."""
    angles: Array = np.linspace(0.0, TURN, count, endpoint=False)
    return angles


# --- a follower -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Held:
    """The contacts of a follower and where they bear at shaft angles (n,); `guide` as `Budget.guide`."""

    contacts: tuple[Contact[Guide, Touch], ...]
    bearings: tuple[Bearing, ...]
    shaft: Array
    guide: float
    discs: int

    @property
    def axis(self) -> Complexes:
        """The x axis of the frame: along the travel of the first contact, or from the shaft to the pivot."""
        return self.bearings[0].axis

    def all(self, change: Callable[[Bearing], Array]) -> Rows:
        """One size that every contact feels."""
        return [np.stack([change(bearing)[None] for bearing in self.bearings])]

    def each(self, change: Callable[[Bearing], Array]) -> Rows:
        """A size of each contact."""
        return [self._alone(i, change(bearing)[None]) for i, bearing in enumerate(self.bearings)]

    def only(self, index: int, change: Callable[[Bearing], Array]) -> Rows:
        """A size of one contact."""
        return [self._alone(index, change(self.bearings[index])[None])]

    def first(self, change: Callable[[Bearing], Array]) -> Rows:
        """A size of the first touch, which on the flanks of a groove is the second one too."""
        return self.only(0, change) if self.discs > 1 else self.all(change)

    def any(self, change: Callable[[Bearing, complex], Array]) -> Rows:
        """A displacement in any direction that every contact feels."""
        return [np.stack([self._components(bearing, change) for bearing in self.bearings])]

    def any_each(self, change: Callable[[Bearing, complex], Array]) -> Rows:
        """A displacement in any direction of each contact."""
        return [self._alone(i, self._components(bearing, change)) for i, bearing in enumerate(self.bearings)]

    def _components(self, bearing: Bearing, change: Callable[[Bearing, complex], Array]) -> Array:
        return np.stack([change(bearing, component) for component in COMPONENTS])

    def _alone(self, index: int, rows: Array) -> Array:
        whole = np.zeros((len(self.bearings), *rows.shape))
        whole[index] = rows
        return whole


def _of_follower(
    design: Design, shaft: Array, guide: float
) -> tuple[Callable[[str], Rows], tuple[str, ...], int | None, Array | None]:
    from kin.follower.influence import bearing

    contacts = design.follower.contacts
    position = design.motion.travel(shaft, 1)
    sides = {surface.name: surface.side for surface in design.exact.surfaces}
    bearings = tuple(bearing(contact, sides[contact.surface], shaft, position) for contact in contacts)
    held = Held(contacts, bearings, shaft, guide, design.follower.arrangement.discs)
    names = tuple(contact.surface or f"contact {i}" for i, contact in enumerate(contacts, 1))
    if len(contacts) == 1:
        return lambda name: FOLLOWER[name](held), ("follower",), None, None
    (upper,) = (i for i, one in enumerate(bearings) if one.upper)
    # a gauge as wide as its flank stands off the other flank by what it is wider
    wider = contacts[upper].touch.radius - design.follower.running(contacts[upper]).radius
    play = -wider * bearings[upper].grown
    return lambda name: FOLLOWER[name](held), names, upper, play


def _mounted(held: Held) -> Complexes:
    """Middle of a stem's guide, in the cam's axes (n,)."""
    offset = (np.conj(held.axis) * held.bearings[0].anchor).imag
    return held.axis * (held.guide + 1j * offset)


def _datum(bearing: Bearing) -> Array:
    """Change where the contact's own position counts from farther out, or the arm stands at a larger angle."""
    return np.full(bearing.gain.shape, -float(bearing.sense))


def _bored(held: Held) -> Rows:
    """Each disc has a bore of its own."""
    return held.any_each(lambda b, v: b.metal(v)) if held.discs > 1 else held.any(lambda b, v: b.metal(v))


FOLLOWER: Mapping[str, Callable[[Held], Rows]] = {
    PROFILE: lambda held: held.each(lambda b: b.grown),
    "angle": lambda held: held.all(lambda b: b.metal_turned()),
    BORE: _bored,
    "shaft": lambda held: held.any(lambda b, w: b.metal(w * held.axis)),
    "index": lambda held: held.only(1, lambda b: b.metal_turned()),
    "guide": lambda held: held.all(lambda b: b.touch_turned(_mounted(held))),
    "face": lambda held: (held.each if _on_one_arm(held) else held.all)(lambda b: b.touch_turned(b.anchor)),
    "pivot": lambda held: held.any(lambda b, v: b.touch(v * held.axis)),
    "breadth": lambda held: held.only(1, _datum),
    "follower.radius": lambda held: held.first(lambda b: b.grown),
    "follower.offset": lambda held: held.all(lambda b: b.touch(1j * held.axis)),
    "follower.tilt": lambda held: held.first(lambda b: b.touch_turned(b.anchor)),
    "follower.arm.length": lambda held: held.first(lambda b: b.touch(b.arm)),
    "follower.arm.pivot": lambda held: held.all(lambda b: b.touch(held.axis)),
    "follower.arm.face": lambda held: held.first(lambda b: b.grown),
    "conjugate.radius": lambda held: held.only(1, lambda b: b.grown),
    "conjugate.distance": lambda held: held.only(1, _datum),
    "conjugate.length": lambda held: held.only(1, lambda b: b.touch(b.arm)),
    "conjugate.angle": lambda held: held.only(1, _datum),
    "roller_radius": lambda held: held.each(lambda b: b.grown),
    "arm": lambda held: held.each(lambda b: b.touch(b.arm)),
    "spread": lambda held: held.each(lambda b: b.touch_turned(b.anchor)),
}
"""What a dimension does to each contact of a follower, by its word."""


def _on_one_arm(held: Held) -> bool:
    """Whether two contacts share a pivot on one disc, each with a face of its own."""
    return len(held.contacts) > 1 and held.contacts[0].apart != 0.0


# --- a linkage --------------------------------------------------------------------------------------------------------


def _of_linkage(
    design: Design, shaft: Array
) -> tuple[Callable[[str], Rows], tuple[str, ...], int | None, Array | None]:
    from kin.linkage.influence import frame_bearing

    if design.driven is None:
        raise ValueError("there is no linkage")
    mechanism = design.driven.mechanism
    bearing = frame_bearing(mechanism, mechanism.relative(shaft))
    return (
        lambda name: [row if row.ndim == 3 else row[None, None] for row in FRAME[name](bearing)],
        ("output",),
        None,
        None,
    )


def _in_any(change: Callable[[complex], Array]) -> Array:
    return np.stack([change(component) for component in COMPONENTS])[None]


FRAME: Mapping[str, Callable[[FrameBearing], Rows]] = {
    PROFILE: lambda frame: [frame.output(across=1.0), frame.output(along=-1.0)],
    "angle": lambda frame: [frame.metal_turned()],
    BORE: lambda frame: [_in_any(frame.metal)],
    "shaft": lambda frame: [_in_any(frame.shaft)],
    "face": lambda frame: [frame.squareness()],
    "pivot": lambda frame: [_in_any(lambda v: frame.output(pivot=v))],
    "breadth": lambda frame: [frame.output(along=1.0), frame.output(across=-0.5)],
    "linkage.ground": lambda frame: [frame.output(pivot=1.0)],
    "linkage.coupler": lambda frame: [frame.output(along=1.0)],
    "linkage.rocker": lambda frame: [frame.output(link=1.0)],
    "linkage.offset": lambda frame: [frame.output(link=1.0)],
    "linkage.joint_offset": lambda frame: [frame.output(across=1.0)],
    "joints": lambda frame: [_in_any(lambda v: frame.output(joint=v)), _in_any(lambda v: frame.output(pivot=v))],
}
"""What a dimension does to the output of a linkage, by its word."""
