"""Influences of the dimensions of a budget on the follower, or on a linkage's output, over the shaft angle.

The metal of the cam stays as it is: no dimension makes a new design. A contribution is the effect of one made size
alone: two rollers made to one drawing are two contributions. Where the machine is set at one angle, errors count from
there. The profile's error is independent at each angle, so that its errors at an angle and at the setting both
contribute. An influence is the change of the motion, mm or rad, per mm or rad of a size. In shapes m is the number of
contacts, n that of shaft angles, c that of contributions; k is 1 for a size and 2 for the components of a displacement.
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
    from kin.budget.frame_influence import FrameBearing
    from kin.budget.influence import Bearing
    from kin.law.contacts import Contact, Guide, Touch
    from kin.numeric.arrays import Array, Complexes

COMPONENTS = (1.0, 1j)  # of a displacement in any direction


@dataclass(frozen=True, eq=False)
class Contribution:
    """Influence of one made size of the dimension `name`: `rows` (m, k, n).

    `tolerance` is plus and minus for a size, the radius of a circle for a displacement, mm or rad; None where it is to
    be found. `constant` marks the profile's error at the angle where the machine is set: the same at all angles.
    """

    name: str
    tolerance: float | None
    rows: Array
    constant: bool = False


@dataclass(frozen=True, eq=False)
class Output:
    """A figure of the motion: the position by one contact, the middle of two positions, or the play between them.

    `weights` (c, n) are the greatest changes of the figure by each contribution, not below 0, mm or rad of the motion
    per mm or rad of the tolerance. `contour` (n,) is the error of the figure by the contour alone, mm or rad, made less
    intended; 0 for an exact contour.
    """

    name: str
    weights: Array
    contour: Array


@dataclass(frozen=True, eq=False)
class Influence:
    """All contributions at the shaft angles `shaft` (n,), rad, and the names of the contacts.

    Of two contacts `upper` is the index of the contact that bounds the position from above, and `play` (n,) the play
    between both with all sizes as intended, mm or rad. Both are None for one contact; `play` is None for velocities.
    `contour` (m, n) are the errors of the positions by a contour that is not exact, mm or rad; None for an exact one.
    """

    shaft: Array
    contributions: tuple[Contribution, ...]
    contacts: tuple[str, ...]
    upper: int | None = None
    play: Array | None = None
    contour: Array | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Words of the dimensions, each once, in the order of the contributions."""
        return tuple(dict.fromkeys(contribution.name for contribution in self.contributions))

    def outputs(self) -> tuple[Output, ...]:
        """The position by each contact, in the order of `contacts`."""
        return tuple(self._output(name, itemgetter(i)) for i, name in enumerate(self.contacts))

    def middle(self) -> Output | None:
        """The middle between the positions by two contacts; None for a follower with one contact."""
        return None if self.upper is None else self._output("middle", lambda rows: rows.mean(axis=0))

    def play_between(self) -> Output | None:
        """The play between two contacts, by the sizes alone; None for a follower with one contact."""
        upper = self.upper
        if upper is None:
            return None
        return Output("play", self._weights(lambda rows: rows[upper] - rows[1 - upper]), np.zeros(len(self.shaft)))

    def _output(self, name: str, figure: Callable[[Array], Array]) -> Output:
        """A figure of the motion, which takes rows by the contacts, (m, n) or (m, k, n), to (n,) or (k, n)."""
        contour = np.zeros(len(self.shaft)) if self.contour is None else figure(self.contour)
        return Output(name, self._weights(figure), contour)

    def _weights(self, figure: Callable[[Array], Array]) -> Array:
        """Greatest changes (c, n) of a figure, which takes rows (m, k, n) to (k, n), by each contribution."""
        rows = (figure(contribution.rows) for contribution in self.contributions)
        # a displacement changes the figure most along the vector of its two components
        return np.stack([np.sqrt((row**2).sum(axis=0)) for row in rows])


class SizeInfluences(NamedTuple):
    """Influences of a cam's made sizes, by the words of its dimensions.

    `rows` takes the word of a dimension and gives the influence (m, k, n) of each of its made sizes. `contacts` has the
    names of the m contacts. Of two, `upper` is the index of the contact that bounds the position from above, and `play`
    (n,) the play between both with all sizes as intended, mm or rad; both are None for one contact.
    """

    rows: Callable[[str], list[Array]]
    contacts: tuple[str, ...]
    upper: int | None
    play: Array | None


class ContourErrors(NamedTuple):
    """Errors of a contour that is not exact, made less intended, with all sizes as intended.

    They are at n shaft angles, behind which the angle comes at which the machine is set, if any. `positions` (m, n) are
    those of the position by each contact, mm or rad. `breadths` (2, n) are those of the contour's breadth along and
    across a linkage's frame, mm; None for a follower.
    """

    positions: Array
    breadths: Array | None


def influence(
    recipe: Recipe, design: Design, budget: Budget, shaft: Array, contour: ContourErrors | None = None
) -> Influence:
    """Influences of the dimensions of a budget at shaft angles (n,), rad, on a `contour` with errors, or an exact one.

    Where the budget states the angle `zero` at which the machine is set, each influence is less its value there. The
    profile's errors there and at other angles are independent, so each of its influences gives two contributions, one
    of them constant. Raises PlaceError for a linkage that does not turn right round, ValueError for dyads.
    """
    zero = budget.zero
    # the angle at which the machine is set comes last
    places = shaft if zero is None else np.append(shaft, zero)
    if recipe.linkage:
        cam = _linkage_influences(design, places, contour)
    else:
        cam = _follower_influences(design, places, budget.guide or 0.0, contour)
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
    errors = None if contour is None else contour.positions
    if errors is not None and zero is not None:
        errors = errors[:, :-1] - errors[:, -1:]
    return Influence(shaft, tuple(contributions), cam.contacts, cam.upper, play, errors)


def velocities(influence: Influence, waves: int) -> Influence:
    """Influences on the velocity by the shaft angle, from those on the motion at even angles over a whole turn.

    `waves` is the number of periods per turn of the profile's error. The influences are mm or rad of the motion per rad
    of the shaft and per mm or rad of the size; the nominal play is left out. A size that is off by t changes the
    velocity by t dw/dphi, w its influence and phi the shaft angle. A profile that is off by t sin(j phi + phase), j the
    waves, changes it by at most t hypot(dw/dphi, j w); its rows are these two components.
    """
    step = float(influence.shaft[1] - influence.shaft[0])

    def slope_of(rows: Array) -> Array:
        """Derivative by the shaft angle, along the last axis: central differences, round the turn."""
        slope: Array = (np.roll(rows, -1, axis=-1) - np.roll(rows, 1, axis=-1)) / (2.0 * step)
        return slope

    contributions = []
    for contribution in influence.contributions:
        rows = contribution.rows
        slope = slope_of(rows)
        wavy = contribution.name == PROFILE and not contribution.constant
        rows = np.concatenate([slope, waves * rows], axis=1) if wavy else slope
        contributions.append(replace(contribution, rows=rows))
    contour = None if influence.contour is None else slope_of(influence.contour)
    return replace(influence, contributions=tuple(contributions), play=None, contour=contour)


# --- a follower -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class HeldFollower:
    """The m contacts of a follower and where they bear at n shaft angles.

    `guide` is the distance, mm, from the middle of a stem's guide to the foot of the perpendicular from the shaft on
    the line of travel; `discs` is the number of discs. The methods return a list of influences (m, k, n), one for each
    made size. Their parameter `change` takes a bearing to the change (n,) of the position by that contact, in mm or rad
    per mm or rad of the size.
    """

    contacts: tuple[Contact[Guide, Touch], ...]
    bearings: tuple[Bearing, ...]
    guide: float
    discs: int

    @property
    def axis(self) -> Complexes:
        """Unit x axis (n,) of the frame, complex, in the cam's axes: along the first travel, or to the pivot."""
        return self.bearings[0].axis

    @property
    def middle(self) -> Complexes:
        """Middle of a stem's guide (n,), complex, in the cam's axes, mm."""
        offset = (np.conj(self.axis) * self.bearings[0].anchor).imag
        return self.axis * (self.guide + 1j * offset)

    def shared(self, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influence of a size that all contacts share: one entry (m, 1, n)."""
        return [np.stack([change(bearing)[None] for bearing in self.bearings])]

    def each(self, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influences of a size that each contact has for itself: m entries (m, 1, n), each 0 at the other contacts."""
        return [rows for i in range(len(self.bearings)) for rows in self.only(i, change)]

    def only(self, index: int, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influence of a size that the contact `index` alone has: one entry (m, 1, n), 0 at the other contacts."""
        return [self._alone(index, change(self.bearings[index])[None])]

    def first(self, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influence of a size of the first touch, which all contacts share on a single disc: one entry (m, 1, n)."""
        return self.only(0, change) if self.discs > 1 else self.shared(change)

    def shifted(self, change: Callable[[Bearing, complex], Array]) -> list[Array]:
        """Influence of a displacement in any direction that acts at every contact: one entry (m, 2, n).

        `change` takes a bearing and a unit direction, complex, to the change (n,) of the position per mm that way.
        """
        return [np.stack([self._components(bearing, change) for bearing in self.bearings])]

    def bored(self, change: Callable[[Bearing, complex], Array]) -> list[Array]:
        """Influences of a displacement of each disc in any direction: one entry (m, 2, n) for each disc."""
        if self.discs == 1:
            return self.shifted(change)
        return [self._alone(i, self._components(bearing, change)) for i, bearing in enumerate(self.bearings)]

    def faced(self, change: Callable[[Bearing], Array]) -> list[Array]:
        """Influences of a size of each face, (m, 1, n): two entries for two faces on one arm, else one for all."""
        on_one_arm = len(self.contacts) > 1 and self.contacts[0].apart != 0.0
        return (self.each if on_one_arm else self.shared)(change)

    def _components(self, bearing: Bearing, change: Callable[[Bearing, complex], Array]) -> Array:
        """Changes (2, n) of the position by a contact, for the two components of a displacement."""
        return np.stack([change(bearing, component) for component in COMPONENTS])

    def _alone(self, index: int, rows: Array) -> Array:
        """Influence (m, k, n) of a size with `rows` (k, n) at one contact, and 0 at the others."""
        whole = np.zeros((len(self.bearings), *rows.shape))
        whole[index] = rows
        return whole


def _follower_influences(design: Design, shaft: Array, guide: float, contour: ContourErrors | None) -> SizeInfluences:
    """Influences on a follower at shaft angles (n,) on a contour with errors; `guide` is that of `HeldFollower`."""
    from kin.budget.influence import bearing

    follower = design.follower
    position = design.motion.travel(shaft, 1)
    sides = {surface.name: surface.side for surface in design.exact.surfaces}
    bearings = tuple(bearing(contact, sides[contact.surface], shaft, position) for contact in follower.contacts)
    held = HeldFollower(follower.contacts, bearings, guide, follower.arrangement.discs)
    if len(bearings) == 1:
        return SizeInfluences(lambda name: FOLLOWER[name](held), ("follower",), None, None)
    names = tuple(contact.surface or f"contact {i}" for i, contact in enumerate(follower.contacts, 1))
    (upper,) = (i for i, bearing in enumerate(bearings) if bearing.upper)
    # the gauge of the upper flank is wider than the running roller by their play along the normal
    wider = follower.contacts[upper].touch.radius - follower.running(follower.contacts[upper]).radius
    play = -wider * bearings[upper].grown
    if design.exact.preload is not None:
        # a preload presses both contacts into the metal: a play below 0
        overlaps = zip(bearings, design.exact.preload.overlaps, strict=True)
        play = play - np.sum([overlap * np.abs(bearing.grown) for bearing, overlap in overlaps], axis=0)
    if contour is not None:
        play = play + contour.positions[upper] - contour.positions[1 - upper]
    return SizeInfluences(lambda name: FOLLOWER[name](held), names, upper, play)


def _datum(bearing: Bearing) -> Array:
    """Change (n,) of the position per mm or rad by which the contact's own position counts from a greater `datum`."""
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


def _linkage_influences(design: Design, shaft: Array, contour: ContourErrors | None) -> SizeInfluences:
    """Influences on the output of a linkage, whose frame bears with two faces, or with the two opposite to them.

    Each pair of opposite faces has its own play, less by what the contour is too broad there. As influences are added
    by their magnitudes, those of the two `FRAME_CONTACTS` give the play of both pairs together. Raises PlaceError for a
    linkage that does not turn right round, ValueError for dyads.
    """
    from kin.budget.frame_influence import frame_bearing

    if design.driven is None:
        raise ValueError("there is no linkage")
    mechanism = design.driven.mechanism
    frame = frame_bearing(mechanism, mechanism.relative(shaft))
    overlap = 0.0 if design.exact.preload is None else design.exact.preload.overlaps[0]
    wider = np.zeros((2, 1)) if contour is None or contour.breadths is None else contour.breadths
    along, across = wider + 2.0 * overlap
    play = -along * np.abs(frame.output(along=1.0)) - across * np.abs(frame.output(across=1.0))
    return SizeInfluences(lambda name: FRAME[name](frame), FRAME_CONTACTS, 0, play)


def _both(row: Array) -> Array:
    """Influence (2, k, n) of a size that moves both contacts alike, by `row` (n,), or (k, n) by its components."""
    return np.stack([np.atleast_2d(row)] * 2)


def _in_any_direction(change: Callable[[complex], Array]) -> Array:
    """Influence (2, 2, n) of a displacement in any direction that moves both contacts alike: its two components."""
    return _both(np.stack([change(component) for component in COMPONENTS]))


def _at_each(first: Array, second: Array) -> Array:
    """Influence (2, 1, n) of a size that moves the two contacts by `first` (n,) and `second` (n,)."""
    return np.stack([first, second])[:, None]


def _faces(frame: FrameBearing) -> list[Array]:
    """Influences of the profile's error under each of the four faces of a frame: four entries (2, 1, n)."""
    y, x = frame.output(across=1.0), frame.output(along=1.0)
    return [_at_each(y, 0.0 * y), _at_each(-x, 0.0 * x), _at_each(0.0 * y, -y), _at_each(0.0 * x, x)]


def _breadths(frame: FrameBearing) -> list[Array]:
    """Influences of the frame's two breadths, two entries (2, 1, n).

    The joint counts from the face +x, so that only contact at -x moves it; in y it counts from the middle of the faces.
    """
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
