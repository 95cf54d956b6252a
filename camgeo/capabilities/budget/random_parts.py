"""Made parts with random sizes within their limits, and the error of each part's follower or output, by contact.

Sizes are uniform within plus and minus; displacements have the full radius in a random direction. The profile's error
is independent at each angle, and the same all about the contact. The errors follow from no influences: these only
foresee their standard deviations, so that the two check each other.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from camgeo.capabilities.budget.contact import ContactPlace, LostError, Metal, SizeErrors, positions
from camgeo.capabilities.budget.dimensions import BORE, DIMENSIONS, PROFILE
from camgeo.capabilities.budget.exact_metal import MOST_STEPS, SETTLED, ExactMetal
from camgeo.capabilities.budget.file_metal import read_metal
from camgeo.capabilities.budget.influence import ContourErrors, influence
from camgeo.capabilities.budget.read_contours import trimmed_contours
from camgeo.capabilities.budget.sums import spread
from kin.budget.frame_influence import QUARTER
from kin.budget.influence import bearing
from kin.law.contacts import eased_contact
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from camgeo.capabilities.budget.influence import Influence
    from camgeo.capabilities.budget.keys import Budget
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array, Complexes

EVEN = 36  # even angles of a turn at which parts are simulated, besides the worst ones
STEP = 1e-5  # rad, by which the frame is turned to see how fast its loop opens
AT_ONCE = 2000  # parts simulated together, which bounds memory
ERRORS = 4.0  # standard errors by which a standard deviation may differ from the foreseen one


class Spread(NamedTuple):
    """Statistics of the parts' errors by one contact at the shaft angle `at`, rad; errors are mm or rad.

    `mean` is their mean, `deviation` their standard deviation, `greatest` the greatest absolute error. `foreseen` is
    the standard deviation by the influences, `error` the standard error of `deviation`.
    """

    contact: str
    at: float
    mean: float
    deviation: float
    foreseen: float
    error: float
    greatest: float

    @property
    def agrees(self) -> bool:
        """Whether the standard deviation is within four standard errors of the foreseen one."""
        return abs(self.deviation - self.foreseen) <= ERRORS * self.error


class Parts(NamedTuple):
    """Result of a simulation of `runs` parts with random numbers from `seed`.

    `spreads` has the statistics of the errors: all angles of the first contact, then of the next. `within` is the
    fraction of parts whose errors stay within the permitted one by every contact, at every simulated angle.
    """

    runs: int
    seed: int
    spreads: tuple[Spread, ...]
    within: float

    @property
    def worst(self) -> Spread:
        """The statistics with the greatest foreseen standard deviation."""
        return max(self.spreads, key=lambda spread: spread.foreseen)


def sample_angles(worst: Sequence[float]) -> Array:
    """Shaft angles (n,), rad, rising, at which parts are simulated: even ones of a turn, and the angles `worst`."""
    return np.unique(np.append(equal_steps(EVEN), worst))


def simulate(
    recipe: Recipe,
    design: Design,
    budget: Budget,
    shaft: Array,
    read: Mapping[str, Contour] | None = None,
    *,
    progress: Callable[[str], None] | None = None,
) -> Parts:
    """Simulate `budget.runs` (at least 1) parts of random sizes at shaft angles (n,), rad.

    The parts have the exact contours or, by the names of their surfaces, those `read` from files; trimmed contours are
    arcs. With an angle `zero` in the budget the errors count from there. `progress` is called with stages such as
    "2,000 of 10,000 parts". Raises LostError where a part has no contact near the intended place or its loop does not
    close, and for a contour that is missing or too long; PlaceError for a linkage that does not turn right round.
    """
    rng = np.random.default_rng(budget.seed)
    rows = influence(recipe, design, budget, shaft)
    errors_of = errors_by_contact(recipe, design, budget, shaft, read)
    moments, within = Moments(), 0
    for begin in range(0, budget.runs, AT_ONCE):
        count = min(AT_ONCE, budget.runs - begin)
        errors = errors_of(RandomSizes(rng, budget, count, len(angles_at(budget, shaft))))
        if budget.zero is not None:
            errors = errors[:, :, :-1] - errors[:, :, -1:]
        moments.add(errors)
        within += int((np.abs(errors) <= budget.permitted).all(axis=(0, 2)).sum())
        if progress is not None:
            progress(f"{moments.count:,} of {budget.runs:,} parts")
    return Parts(budget.runs, budget.seed, tuple(_spreads(rows, moments)), within / budget.runs)


def errors_by_contact(
    recipe: Recipe, design: Design, budget: Budget, shaft: Array, read: Mapping[str, Contour] | None = None
) -> Callable[[Sizes], Array]:
    """Function that gives the errors of the motion, (contacts, parts, n), mm or rad, from errors of the sizes.

    The n angles are `shaft`, rad, then the angle at which the machine is set, if any; the errors do not count from
    there. `read` has contours read from files, by the names of their surfaces; without it the contours are exact, or
    arcs where undercut is trimmed. The call raises LostError for a contour that is missing or too long, PlaceError for
    a linkage that does not turn right round. The function raises LostError where a made part has no contact near the
    intended place or its loop does not close.
    """
    if not design.contours:
        raise LostError("parts are not simulated, as no contour is made")
    if read is None and design.trimmed:
        read = trimmed_contours(design)
    errors_of = _linkage_errors if recipe.linkage else _follower_errors
    return errors_of(design, budget, angles_at(budget, shaft), read)


def contour_errors(
    recipe: Recipe, design: Design, budget: Budget, shaft: Array, read: Mapping[str, Contour] | None
) -> ContourErrors | None:
    """Errors of the contour alone at shaft angles (n,), rad, with all sizes as intended; None for an exact contour.

    The contours are those `read`, by the names of their surfaces; without them those of the design, trimmed ones as
    arcs. Raises LostError and PlaceError as `errors_by_contact` and its function do.
    """
    if read is None and design.trimmed:
        read = trimmed_contours(design)
    if read is None:
        return None
    positions = errors_by_contact(recipe, design, budget, shaft, read)(IntendedSizes())[:, 0]
    if design.driven is None:
        return ContourErrors(positions, None)
    support, mechanism = _support(design, read), design.driven.mechanism
    across = mechanism.relative(angles_at(budget, shaft))
    breadths = [support(way) + support(way + 2.0 * QUARTER) - mechanism.breadth for way in (across + QUARTER, across)]
    return ContourErrors(positions, np.stack(breadths))


def angles_at(budget: Budget, shaft: Array) -> Array:
    """The shaft angles (n,), rad, and behind them the angle at which the machine is set, if any."""
    return shaft if budget.zero is None else np.append(shaft, budget.zero)


class Moments:
    """Moments of the parts' errors (contacts, n), added block by block: no error of a part is kept.

    `count` is the number of parts so far. `greatest` (contacts, n) are their greatest absolute errors, mm or rad.
    """

    def __init__(self) -> None:
        """Prepare for the first block."""
        self.count = 0
        self.greatest: Array = np.zeros(1)
        self._origin: Array = np.zeros(1)
        self._sums: Array = np.zeros(4)

    def add(self, errors: Array) -> None:
        """Add the errors of a block of parts, (contacts, parts, n), mm or rad."""
        if not self.count:
            # powers are summed about the mean of the first block: about 0 they would cancel
            self._origin = errors.mean(axis=1)
            self.greatest, self._sums = np.zeros_like(self._origin), np.zeros((4, *self._origin.shape))
        self.count += errors.shape[1]
        self.greatest = np.maximum(self.greatest, np.abs(errors).max(axis=1))
        off = errors - self._origin[:, None]
        square = off * off
        self._sums += [power.sum(axis=1) for power in (off, square, square * off, square * square)]

    def central(self) -> tuple[Array, Array, Array]:
        """Mean, mm or rad, and the second and fourth central moment, (contacts, n) each."""
        first, second, third, fourth = self._sums / self.count
        square = np.maximum(second - first**2, 0.0)
        return self._origin + first, square, fourth - 4.0 * first * third + 6.0 * first**2 * second - 3.0 * first**4


def _spreads(rows: Influence, moments: Moments) -> list[Spread]:
    """Statistics of the errors of all parts: one Spread for each contact and shaft angle."""
    mean, square, fourth = moments.central()
    deviation = np.sqrt(square)
    # standard error of a standard deviation s of N values: sqrt((m4 - s^4)/(4 N))/s, m4 the fourth central moment
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.nan_to_num(np.sqrt(np.maximum(fourth - square**2, 0.0) / (4.0 * moments.count)) / deviation)
    spreads = []
    for contact, output in enumerate(rows.outputs()):
        foreseen = spread(rows, output)
        for place, at in enumerate(rows.shaft):
            values = (row[contact, place] for row in (mean, deviation, error, moments.greatest))
            own_mean, own_deviation, own_error, greatest = map(float, values)
            spreads.append(
                Spread(output.name, float(at), own_mean, own_deviation, float(foreseen[place]), own_error, greatest)
            )
    return spreads


class Sizes(Protocol):
    """Errors of the sizes of made parts, (parts, 1); of the profile (parts, angles).

    Each call gives the errors of another made size, even for the same word.
    """

    def size(self, name: str) -> Array:
        """Error of a size, mm or rad, by the word of its dimension."""

    def radius(self, name: str) -> Complexes:
        """Displacement, complex, mm, by the word of its dimension."""


class IntendedSizes:
    """Sizes of one part that are as intended: all errors are 0."""

    def size(self, _name: str) -> Array:
        """The error of any size, 0."""
        return np.zeros((1, 1))

    def radius(self, _name: str) -> Complexes:
        """Any displacement, 0."""
        return np.zeros((1, 1), dtype=complex)


class RandomSizes:
    """Random errors of the sizes of parts: each call of `size` or `radius` draws those of another made size."""

    def __init__(self, rng: np.random.Generator, budget: Budget, count: int, angles: int) -> None:
        """Prepare random errors for `count` parts, of the profile at each of `angles` shaft angles."""
        self._rng, self._count, self._angles = rng, count, angles
        self._tolerances = dict(budget.tolerances)

    def size(self, name: str) -> Array:
        """Error of a size, mm or rad, uniform within its tolerance, 0 for a size without one.

        The shape is (parts, 1), for the profile (parts, angles).
        """
        tolerance = self._tolerances.get(name) or 0.0
        shape = (self._count, self._angles if name == PROFILE else 1)
        return tolerance * self._rng.uniform(-1.0, 1.0, shape) if tolerance else np.zeros(shape)

    def radius(self, name: str) -> Complexes:
        """Displacement (parts, 1), complex, mm: the full radius in a random direction, 0 without a tolerance."""
        tolerance, shape = self._tolerances.get(name) or 0.0, (self._count, 1)
        turned = self._rng.uniform(0.0, TURN, shape) if tolerance else np.zeros(shape)
        displacement: Complexes = tolerance * np.exp(1j * turned)
        return displacement


# --- a follower -------------------------------------------------------------------------------------------------------


def _follower_errors(
    design: Design, budget: Budget, angles: Array, read: Mapping[str, Contour] | None
) -> Callable[[Sizes], Array]:
    """Function that gives the errors of a follower, (contacts, parts, n), mm or rad, at the angles (n,)."""
    places = contact_places(design, budget, angles, read)
    nominal = design.motion.travel(angles, 0)[0]
    count, discs = len(places), design.follower.arrangement.discs
    on_one_arm = count > 1 and places[0].contact.apart != 0.0

    def errors(sizes: Sizes) -> Array:
        by_contact = errors_at_contacts(sizes, count, discs, on_one_arm=on_one_arm)
        return np.stack([positions(place, off) - nominal for place, off in zip(places, by_contact, strict=True)])

    return errors


def errors_at_contacts(sizes: Sizes, count: int, discs: int, *, on_one_arm: bool) -> list[SizeErrors]:
    """Errors of the sizes at each of `count` contacts, in their order.

    An error that contacts share is drawn once: those of the shaft, the turn on it, the pivot, the guide and the stem's
    offset; where there is one disc (`discs`), the bore's and the first touch's; and the squareness of faces that are
    not `on_one_arm`.
    """
    size, radius = sizes.size, sizes.radius
    turned, shaft, pivot = size("angle"), radius("shaft"), radius("pivot") + size("follower.arm.pivot")
    offset, guide = size("follower.offset"), size("guide")
    first_radius, first_arm = size("follower.radius") + size("follower.arm.face"), size("follower.arm.length")
    tilted, squared = size("follower.tilt"), size("face")
    bore = radius(BORE)

    def at_contact(rank: int) -> SizeErrors:
        first = rank == 0 or discs == 1
        return SizeErrors(
            turned=turned + (size("index") if rank else 0.0),
            bore=radius(BORE) if discs > 1 else bore,
            shaft=shaft,
            pivot=pivot,
            grown=size(PROFILE) + size("roller_radius") + (first_radius if first else size("conjugate.radius")),
            offset=offset,
            guide=guide,
            face=(size("face") if on_one_arm else squared) + size("spread") + (tilted if first else 0.0),
            length=size("arm") + (first_arm if first else size("conjugate.length")),
            datum=size("breadth") + size("conjugate.distance") + size("conjugate.angle") if rank else 0.0 * turned,
        )

    return [at_contact(rank) for rank in range(count)]


def contact_places(
    design: Design, budget: Budget, shaft: Array, read: Mapping[str, Contour] | None
) -> list[ContactPlace]:
    """Each contact of a follower on its metal at shaft angles (n,), rad, in the order of the contacts.

    The metal is exact, or that of the contours `read`, by the names of their surfaces. Raises LostError where a read
    contour takes more than two million points.
    """
    contacts, preload = design.follower.contacts, design.exact.preload
    if preload is not None:  # touches reduced by their overlaps just fit the metal
        contacts = tuple(map(eased_contact, contacts, preload.overlaps))
    position = design.motion.travel(shaft, 1)
    parameters = list(design.motion.parameters(shaft, shaft).values())
    first = np.exp(1j * (shaft + contacts[0].turned))
    places = []
    for i, contact in enumerate(contacts):
        surface = next(surface for surface in design.exact.surfaces if surface.name == contact.surface)
        if read is not None:
            intended = bearing(contact, surface.side, shaft, position).point
            metal: Metal = read_metal(contact, surface.side, read[contact.surface], intended, _wander(budget, intended))
        elif i < len(parameters):
            metal = ExactMetal(surface.curve, surface.side, parameters[i])
        else:  # the angle of the guide on the first contact's surface, else the shaft angle
            turned = contact.turned if contact.surface == contacts[0].surface else 0.0
            metal = ExactMetal(surface.curve, surface.side, shaft + turned)
        own = contact.own(position[0])
        places.append(ContactPlace(contact, metal, shaft, own, first, design.follower.offset, budget.guide or 0.0))
    return places


def _wander(budget: Budget, intended: Complexes) -> float:
    """Estimate of how far a contact moves along the contour, mm: the sum of all tolerances of the budget.

    Tolerances of angles, rad, count times the greatest distance of an intended contact from the shaft.
    """
    size = float(np.abs(intended).max())
    return sum((tolerance or 0.0) * (size if DIMENSIONS[name].angle else 1.0) for name, tolerance in budget.tolerances)


# --- a linkage --------------------------------------------------------------------------------------------------------


def _linkage_errors(
    design: Design,
    budget: Budget,  # noqa: ARG001 - one call for followers and linkages
    angles: Array,
    read: Mapping[str, Contour] | None,
) -> Callable[[Sizes], Array]:
    """Function that gives the errors of a linkage's output, (2, parts, n), mm or rad, by either pair of faces.

    They follow from the support function of the metal, with the loop of each part closed anew. The function raises
    LostError where a loop does not close near its intended place.
    """
    if design.driven is None:
        raise ValueError("there is no linkage")
    mechanism = design.driven.mechanism
    loop, breadth, reach = mechanism.linkage, mechanism.breadth, _support(design, read)
    relative = mechanism.relative(angles)
    motion = mechanism.at(relative, 0)
    frame, nominal = motion.frame[0], motion.output[0]
    # r3 from the frame's face +x to the joint, which stands w + r3 - S1 along the frame: w breadth, S1 lift of face 2
    coupler = motion.solved.linkage.slide.c[0] - breadth + motion.faces[1][0]

    def errors(sizes: Sizes) -> Array:
        # errors of the sizes that both pairs of faces share
        size, radius = sizes.size, sizes.radius
        turned, bore, moved = size("angle"), radius(BORE), radius("shaft")
        wider, higher, squared = size("breadth"), size("breadth"), size("face")
        pivot = radius("pivot") + size("linkage.ground") + radius("joints")
        play, link = radius("joints"), size("linkage.rocker") + size("linkage.offset")
        longer, joint = size("linkage.coupler"), size("linkage.joint_offset")

        def support(direction: Array) -> Array:
            """Distance from the shaft, mm, of the made cam's tangent across `direction`, rad in the intended axes."""
            inner = direction - turned
            tangent: Array = reach(inner) + (np.conj(bore) * np.exp(1j * inner)).real
            return tangent

        def output(sense: int) -> Array:
            """Output where the frame bears with its faces +y and -x (`sense` 1), or with the opposite two (-1)."""
            y_profile, x_profile = size(PROFILE), size(PROFILE)  # the cam's errors under the faces that bear

            def off(change: Array) -> tuple[Array, Array]:
                """Distance by which the loop is open, mm, and output where the frame is turned by `change`, rad."""
                # place of the mid-line by the y face, then of the joint along it by the x face
                direction = relative + change
                y_face = support(direction + (1 - sense) * QUARTER) + y_profile
                middle = sense * (y_face - 0.5 * (breadth + higher))
                x_face = support(direction + sense * QUARTER + squared) + x_profile + sense * middle * np.sin(squared)
                along = coupler + longer - sense * x_face / np.cos(squared) + (breadth + wider if sense > 0 else 0.0)
                u = np.exp(1j * (frame + change))
                joint_at = u * (along + 1j * (middle + loop.joint_offset + joint))
                return loop.closure(moved + joint_at + play, u, pivot, link)

            return _closed(off, np.zeros((len(turned), len(angles))))

        changes: Array = np.stack([output(1), output(-1)]) - nominal
        if mechanism.unit == "deg":
            changes = np.remainder(changes + math.pi, TURN) - math.pi
        return changes

    return errors


def _support(design: Design, read: Mapping[str, Contour] | None) -> Callable[[Array], Array]:
    """Function that gives the distance from the shaft, mm, of the tangent across directions, rad in the cam's axes.

    The tangent is that of the exact contour under a linkage, or of the one `read`, without the overlap of a preload.
    """
    if design.driven is None:
        raise ValueError("there is no linkage")
    lift, contour = design.driven.mechanism.lift, None if read is None else read[""]
    # contours of files overlap the faces by the preload; the lift is that without it
    overlap = 0.0 if design.exact.preload is None else design.exact.preload.overlaps[0]

    def support(direction: Array) -> Array:
        flat = np.mod(direction, TURN).ravel()
        own = lift.derivatives(flat, 0)[0] if contour is None else contour.support(flat).q - overlap
        reach: Array = own.reshape(direction.shape)
        return reach

    return support


def _closed(off: Callable[[Array], tuple[Array, Array]], start: Array) -> Array:
    """Output of linkages (parts, angles), mm or rad, where their loops close.

    `off` gives the distance by which the loops are open, mm, and the output, for changes of the frame's angle, rad. The
    search begins at the changes `start`, with the slope there. Raises LostError where a loop does not close near there.
    """
    change = start
    slope = (off(change + STEP)[0] - off(change - STEP)[0]) / (2.0 * STEP)
    for _ in range(MOST_STEPS):
        open_by, output = off(change)
        if np.abs(open_by).max() < SETTLED:
            return output
        change = change - open_by / slope
    raise LostError("the loop of a made part does not close near where it is meant to be")
