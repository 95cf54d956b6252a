"""Influences of the dimensions of a budget on the follower, or on a linkage's output, over the shaft angle.

The metal of the cam stays as it is: no dimension makes a new design. A contribution is the effect of one made size
alone: two rollers made to one drawing are two contributions. Where the machine is set at one angle, errors count from
there. The profile's error is independent at each angle, so that the error at an angle and the one at the setting both
contribute.
"""

from __future__ import annotations

from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.budget.dimensions import BORE, PROFILE
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

COMPONENTS = (1.0, 1j)  # of a displacement in any direction


@dataclass(frozen=True, eq=False)
class Contribution:
    """Influence of one made size: `rows` (m, k, n) at m contacts, in mm or rad of the motion per mm or rad of the size.

    With k = 1 the tolerance is plus and minus, with k = 2 it is the radius of a circle about the two components; it is
    None where it is to be found. `constant` marks the profile's error where the machine is set, which is one at all
    angles.
    """

    name: str
    tolerance: float | None
    rows: Array
    constant: bool = False


@dataclass(frozen=True, eq=False)
class Output:
    """A figure of the motion: the position by one contact, the middle of two positions, or the play between them.

    `weights` (c, n) are the greatest changes of the figure by each of c contributions at n shaft angles. They are at
    least 0, in mm or rad of the motion per mm or rad of the tolerance.
    """

    name: str
    weights: Array


@dataclass(frozen=True, eq=False)
class Influence:
    """All contributions at shaft angles (n,), rad; `contacts` names what the follower, or the frame, bears on.

    Of two contacts `upper` is the index of the one that bounds the position from above, and `play` (n,) the nominal
    play between them, mm or rad.
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
        """The middle between the positions by two contacts; None for a follower with one contact."""
        return None if self.upper is None else Output("middle", self._weights(lambda rows: rows.mean(axis=0)))

    def play_between(self) -> Output | None:
        """The play between two contacts; None for a follower with one contact."""
        upper = self.upper
        if upper is None:
            return None
        return Output("play", self._weights(lambda rows: rows[upper] - rows[1 - upper]))

    def _weights(self, figure: Callable[[Array], Array]) -> Array:
        rows = (figure(contribution.rows) for contribution in self.contributions)
        return np.stack([np.sqrt((row**2).sum(axis=0)) for row in rows])


class SizeInfluences(NamedTuple):
    """Influences of a cam's made sizes, by the words of its dimensions.

    `rows` gives, for each made size of a word, its influence (m, k, n) in mm or rad of the motion per mm or rad of the
    size: k = 1 for a size, 2 for the components of a displacement. `contacts` has the names of the m contacts. Of two,
    `upper` is the index of the one that bounds the position from above, and `play` (n,) the nominal play between them,
    mm or rad; both are None for one contact.
    """

    rows: Callable[[str], list[Array]]
    contacts: tuple[str, ...]
    upper: int | None
    play: Array | None


def influence(recipe: Recipe, design: Design, budget: Budget, shaft: Array) -> Influence:
    """Influences of the dimensions of a budget at shaft angles (n,), rad.

    With a zero each influence is less its value there. The profile's errors there and at other angles are independent,
    so each of its influences gives two contributions, one of them constant. Raises PlaceError for a linkage that does
    not turn right round.
    """
    zero = budget.zero
    places = shaft if zero is None else np.append(shaft, zero)
    if recipe.linkage:
        cam = _linkage_influences(design, places)
    else:
        cam = _follower_influences(design, places, budget.guide or 0.0)
    contributions = []
    for name, tolerance in budget.tolerances:
        for rows in cam.rows(name):
            at_zero = rows[:, :, -1:]
            if zero is None:
                contributions.append(Contribution(name, tolerance, rows))
            elif name == PROFILE:
                contributions.append(Contribution(name, tolerance, rows[:, :, :-1]))
                at_all = np.broadcast_to(at_zero, rows[:, :, :-1].shape)
                contributions.append(Contribution(name, tolerance, at_all, constant=True))
            else:
                contributions.append(Contribution(name, tolerance, rows[:, :, :-1] - at_zero))
    play = None if cam.play is None else cam.play[: len(shaft)]
    return Influence(shaft, tuple(contributions), cam.contacts, cam.upper, play)


def velocities(influence: Influence, waves: int) -> Influence:
    """Influences on the velocity by the shaft angle, from those on the motion at even angles over a whole turn.

    A size that is off by t changes the velocity by t dw/dphi. The profile's error t sin(n phi + any) of n `waves`
    changes it by at most t hypot(dw/dphi, n w): its two components.
    """
    step = float(influence.shaft[1] - influence.shaft[0])
    contributions = []
    for contribution in influence.contributions:
        rows = contribution.rows
        slope = (np.roll(rows, -1, axis=2) - np.roll(rows, 1, axis=2)) / (2.0 * step)
        wavy = contribution.name == PROFILE and not contribution.constant
        rows = np.concatenate([slope, waves * rows], axis=1) if wavy else slope
        contributions.append(replace(contribution, rows=rows))
    return replace(influence, contributions=tuple(contributions), play=None)


# --- a follower -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class HeldFollower:
    """The m contacts of a follower and where they bear at n shaft angles.

    `guide` is the distance, mm, from the middle of a stem's guide to the foot of the perpendicular from the shaft. The
    methods give the rows (m, k, n) of each made size. `change` tells how much the position by a contact changes, in mm
    or rad per mm or rad of the size.
    """

    contacts: tuple[Contact[Guide, Touch], ...]
    bearings: tuple[Bearing, ...]
    guide: float
    discs: int

    @property
    def axis(self) -> Complexes:
        """The x axis of the frame (n,): along the travel of the first contact, or from the shaft to the pivot."""
        return self.bearings[0].axis

    @property
    def middle(self) -> Complexes:
        """Middle of a stem's guide, in the cam's axes (n,)."""
        offset = (np.conj(self.axis) * self.bearings[0].anchor).imag
        return self.axis * (self.guide + 1j * offset)

    def shared(self, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influence of a dimension that all contacts share: one entry (m, 1, n), `change` at each contact."""
        return [np.stack([change(bearing)[None] for bearing in self.bearings])]

    def each(self, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influence of a size that each contact has for itself: m entries (m, 1, n), each 0 at the other contacts."""
        return [rows for i in range(len(self.bearings)) for rows in self.only(i, change)]

    def only(self, index: int, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influence of a size that the contact `index` alone has: one entry (m, 1, n), 0 at the other contacts."""
        return [self._alone(index, change(self.bearings[index])[None])]

    def first(self, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influence of a size of the first touch: one entry (m, 1, n). On a single disc all contacts have it."""
        return self.only(0, change) if self.discs > 1 else self.shared(change)

    def shifted(self, change: Callable[[Bearing, complex], Array]) -> list[Array]:
        """Influence of a displacement in any direction that acts at every contact: one entry (m, 2, n).

        `change` of a contact and a unit direction, complex, is the change (n,) of the position by that displacement.
        """
        return [np.stack([self._components(bearing, change) for bearing in self.bearings])]

    def bored(self, change: Callable[[Bearing, complex], Array]) -> list[Array]:
        """Influence of a displacement of each disc in any direction: an entry (m, 2, n) for each disc."""
        if self.discs == 1:
            return self.shifted(change)
        return [self._alone(i, self._components(bearing, change)) for i, bearing in enumerate(self.bearings)]

    def faced(self, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influence of a size of each face, entries (m, 1, n): one for each of two on an arm, else one for all."""
        on_one_arm = len(self.contacts) > 1 and self.contacts[0].apart != 0.0
        return (self.each if on_one_arm else self.shared)(change)

    def _components(self, bearing: Bearing, change: Callable[[Bearing, complex], Array]) -> Array:
        return np.stack([change(bearing, component) for component in COMPONENTS])

    def _alone(self, index: int, rows: Array) -> Array:
        whole = np.zeros((len(self.bearings), *rows.shape))
        whole[index] = rows
        return whole


def _follower_influences(design: Design, shaft: Array, guide: float) -> SizeInfluences:
    """Influences on a follower; `guide` is the distance of its guide's middle from the perpendicular's foot, mm."""
    from kin.follower.influence import bearing

    follower = design.follower
    position = design.motion.travel(shaft, 1)
    sides = {surface.name: surface.side for surface in design.exact.surfaces}
    bearings = tuple(bearing(contact, sides[contact.surface], shaft, position) for contact in follower.contacts)
    held = HeldFollower(follower.contacts, bearings, guide, follower.arrangement.discs)
    if len(bearings) == 1:
        return SizeInfluences(lambda name: FOLLOWER[name](held), ("follower",), None, None)
    names = tuple(contact.surface or f"contact {i}" for i, contact in enumerate(follower.contacts, 1))
    (upper,) = (i for i, bearing in enumerate(bearings) if bearing.upper)
    # a gauge as wide as its flank stands off the other flank by what it is wider
    wider = follower.contacts[upper].touch.radius - follower.running(follower.contacts[upper]).radius
    play = -wider * bearings[upper].grown
    if design.exact.preload is not None:
        overlaps = zip(bearings, design.exact.preload.overlaps, strict=True)
        play = play - np.sum([overlap * np.abs(bearing.grown) for bearing, overlap in overlaps], axis=0)
    return SizeInfluences(lambda name: FOLLOWER[name](held), names, upper, play)


def _datum(bearing: Bearing) -> Array:
    """Change of the position per mm or rad of a greater `datum` of the contact (`Contact`)."""
    return np.full(bearing.gain.shape, -float(bearing.sense))


FOLLOWER: Mapping[str, Callable[[HeldFollower], list[Array]]] = {
    PROFILE: lambda held: held.each(lambda b: b.grown),
    "angle": lambda held: held.shared(lambda b: b.metal_turned()),
    BORE: lambda held: held.bored(lambda b, v: b.metal(v)),
    "shaft": lambda held: held.shifted(lambda b, w: b.metal(w * held.axis)),
    "index": lambda held: held.only(1, lambda b: b.metal_turned()),
    "guide": lambda held: held.shared(lambda b: b.touch_turned(held.middle)),
    "face": lambda held: held.faced(lambda b: b.touch_turned(b.anchor)),
    "pivot": lambda held: held.shifted(lambda b, v: b.touch(v * held.axis)),
    "breadth": lambda held: held.only(1, _datum),
    "follower.radius": lambda held: held.first(lambda b: b.grown),
    "follower.offset": lambda held: held.shared(lambda b: b.touch(1j * held.axis)),
    "follower.tilt": lambda held: held.first(lambda b: b.touch_turned(b.anchor)),
    "follower.arm.length": lambda held: held.first(lambda b: b.touch(b.arm)),
    "follower.arm.pivot": lambda held: held.shared(lambda b: b.touch(held.axis)),
    "follower.arm.face": lambda held: held.first(lambda b: b.grown),
    "conjugate.radius": lambda held: held.only(1, lambda b: b.grown),
    "conjugate.distance": lambda held: held.only(1, _datum),
    "conjugate.length": lambda held: held.only(1, lambda b: b.touch(b.arm)),
    "conjugate.angle": lambda held: held.only(1, _datum),
    "roller_radius": lambda held: held.each(lambda b: b.grown),
    "arm": lambda held: held.each(lambda b: b.touch(b.arm)),
    "spread": lambda held: held.each(lambda b: b.touch_turned(b.anchor)),
}
"""Rows of each made size of a follower's dimension, by its word."""


# --- a linkage --------------------------------------------------------------------------------------------------------

FRAME_CONTACTS = ("+y and -x", "-y and +x")  # faces of a square frame in its axes; face 1 is at +y, face 2 at -x


def _linkage_influences(design: Design, shaft: Array) -> SizeInfluences:
    """Influences on the output of a linkage, whose frame bears with two faces, or with the two that are opposite.

    Either pair of opposite faces leaves play by itself. As errors are added by their size, those of the two contacts
    that are named tell what both pairs leave together.
    """
    from kin.linkage.influence import frame_bearing

    if design.driven is None:
        raise ValueError("there is no linkage")
    mechanism = design.driven.mechanism
    frame = frame_bearing(mechanism, mechanism.relative(shaft))
    overlap = 0.0 if design.exact.preload is None else design.exact.preload.overlaps[0]
    play = -2.0 * overlap * (np.abs(frame.output(along=1.0)) + np.abs(frame.output(across=1.0)))
    return SizeInfluences(lambda name: FRAME[name](frame), FRAME_CONTACTS, 0, play)


def _both(row: Array) -> Array:
    """Influence (2, k, n) of a dimension that moves both contacts alike: (n,), or (k, n) by its components."""
    return np.stack([np.atleast_2d(row)] * 2)


def _in_any_direction(change: Callable[[complex], Array]) -> Array:
    """Influence (2, 2, n) of a displacement in any direction that moves both contacts alike: its two components."""
    return _both(np.stack([change(component) for component in COMPONENTS]))


def _at_each(first: Array, second: Array) -> Array:
    """Influence (2, 1, n) of a dimension that moves the first contact by (n,), the second by (n,)."""
    return np.stack([first, second])[:, None]


def _faces(frame: FrameBearing) -> list[Array]:
    """Influences of the profile's error under each of the four faces of a frame: four entries (2, 1, n)."""
    y, x = frame.output(across=1.0), frame.output(along=1.0)
    return [_at_each(y, 0.0 * y), _at_each(-x, 0.0 * x), _at_each(0.0 * y, -y), _at_each(0.0 * x, x)]


def _breadths(frame: FrameBearing) -> list[Array]:
    """Influences of the frame's two breadths: +x of the x faces holds the joint; of the y faces their middle does."""
    x, half = frame.output(along=1.0), frame.output(across=0.5)
    return [_at_each(x, 0.0 * x), _at_each(-half, half)]


FRAME: Mapping[str, Callable[[FrameBearing], list[Array]]] = {
    PROFILE: _faces,
    "angle": lambda frame: [_both(frame.metal_turned())],
    BORE: lambda frame: [_in_any_direction(frame.metal)],
    "shaft": lambda frame: [_in_any_direction(frame.shaft)],
    "face": lambda frame: [_both(frame.squareness())],
    "pivot": lambda frame: [_in_any_direction(lambda v: frame.output(pivot=v))],
    "breadth": _breadths,
    "linkage.ground": lambda frame: [_both(frame.output(pivot=1.0))],
    "linkage.coupler": lambda frame: [_both(frame.output(along=1.0))],
    "linkage.rocker": lambda frame: [_both(frame.output(link=1.0))],
    "linkage.offset": lambda frame: [_both(frame.output(link=1.0))],
    "linkage.joint_offset": lambda frame: [_both(frame.output(across=1.0))],
    "joints": lambda frame: [
        _in_any_direction(lambda v: frame.output(joint=v)),
        _in_any_direction(lambda v: frame.output(pivot=v)),
    ],
}
"""Rows (2, k, n) of each made size of a linkage's dimension, by its word."""
