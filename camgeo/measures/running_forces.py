"""Forces of a follower that runs at a speed, rigid or with both contacts under preload: contacts, shaft, guide, roller.

In SI: N and m, about a pivot N m and rad. F is what the cam must give along the travel, above 0 where the first contact
pushes: m Omega^2 y'' + k (y - least y) + F0 + load, y the position counted that way. The shaft's torque is that of the
normal forces' lines about it, by exact derivatives of the motion; without friction it is F y'.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.measures.forces import PER_MM, FollowerTurn, elastic
from kin.numeric.angles import TURN, degrees
from kin.numeric.distinct import distinct
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.recipe.dynamics import Dynamics
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.contact_lines import ContactLine
    from kin.law.contacts import Side
    from kin.law.formula.formula import Formula
    from kin.numeric.arrays import Array

LIFE = 10.0 / 3.0  # exponent of the rating life of needle and roller bearings (ISO 281)
STRETCHES, MOST_OPEN = 256, 64  # in which a load is enclosed, and of them looked at where it cannot be
NARROW, LARGE = 1e-9, 1e6  # rad; of its usual size: what it has there is a pole
PANELS, NODES = 48, 8  # of Gauss's rule between any two places of the mean


class State(NamedTuple):
    """At n shaft angles: F along the travel, position y, both SI; the normal force of each contact (m, n), N."""

    force: Array
    rows: Array
    lines: tuple[ContactLine, ...]
    normal: Array


@dataclass(frozen=True, eq=False)
class Running:
    """A design's follower at the speed and with the loads of its recipe's dynamics."""

    recipe: Recipe
    design: Design
    train: Dynamics

    @cached_property
    def turn(self) -> FollowerTurn:
        """The follower over the turn."""
        return FollowerTurn(self.design, self.corners)

    @property
    def corners(self) -> tuple[float, ...]:
        """Shaft angles, rad, at which a table of the load has corners."""
        load = self.train.load
        return () if isinstance(load, str) else tuple(load.corners.tolist())

    @cached_property
    def sides(self) -> tuple[Side, ...]:
        """On which side of its contour the metal lies that each contact touches."""
        sides = {surface.name: surface.side for surface in self.design.exact.surfaces}
        return tuple(sides[one.surface] for one in self.design.follower.contacts)

    @cached_property
    def senses(self) -> tuple[int, ...]:
        """Which way each contact pushes the follower: with its sense, from metal inside its contour."""
        return tuple(side * one.sense for side, one in zip(self.sides, self.design.follower.contacts, strict=True))

    @property
    def speed(self) -> float:
        """Rad/s."""
        return self.train.rpm * TURN / 60.0

    @property
    def unit(self) -> float:
        """Metres in one of position, or radians."""
        return 1.0 if self.turn.swings else PER_MM

    def position(self, rows: Array) -> Array:
        """Position y and two derivatives, SI (3, n), counted the way in which the first contact pushes."""
        found: Array = self.senses[0] * self.unit * rows
        return found

    @cached_property
    def lowest(self) -> float:
        """Least y."""
        ((least, _),) = self.turn.extremes(lambda phi: self.position(self.turn.rows(phi))[:1])
        return least.value

    @cached_property
    def load(self) -> Callable[[Array], Array]:
        """The load over shaft angles (n,), N or N m, above 0 towards the cam's first contact.

        Raises RecipeErrors where it has no value, or no bound.
        """
        from kin.law.formula.formula import Formula, FormulaDomainError

        given = self.train.load
        if not isinstance(given, str):
            return given
        formula = Formula(given)
        try:
            at = unbounded(formula)
            formula(self.turn.places)
        except FormulaDomainError as error:
            raise self.recipe.error("dynamics.load", str(error)) from error
        if at is not None:
            why = f"it has no bound near {degrees(at):.6g} degrees"
            raise self.recipe.error("dynamics.load", why, f"'{given}'", "give a load that is finite")
        return lambda phi: np.asarray(formula(np.asarray(phi, dtype=np.float64)))

    def _rest(self, phi: Array, y: Array) -> Array:
        """What the cam must give besides inertia and the spring's preload."""
        rest: Array = self.train.rate * (y - self.lowest) + self.load(phi) if self.train.rate else self.load(phi)
        return rest

    def inertia(self, rows: Array, speed: float) -> Array:
        """Inertia's share of F at a speed, rad/s."""
        force: Array = self.train.mass * speed**2 * self.position(rows)[2]
        return force

    @cached_property
    def preload(self) -> float:
        """Force of the spring at the lowest place: as given, or the least that leaves `least_force` all round."""
        if self.train.least_force is None:
            return self.train.preload or 0.0

        def without(phi: Array) -> Array:
            rows = self.turn.rows(phi)
            force: Array = self.inertia(rows, self.speed) + self._rest(phi, self.position(rows)[0])
            return force[None]

        ((least, _),) = self.turn.extremes(without)
        return max(self.train.least_force - least.value, 0.0)

    def state(self, phi: Array) -> State:
        """All of it at shaft angles (n,)."""
        rows = self.turn.rows(phi)
        lines = self.turn.lines(rows)
        y = self.position(rows)
        force = self.inertia(rows, self.speed) + self._rest(phi, y[0]) + self.preload
        levers = self._levers(lines, y)
        if len(lines) == 1:
            return State(force, y, lines, force / levers)
        given = self.design.exact.preload
        if given is not None and given.stiffness is not None:
            scale = PER_MM if self.turn.swings else 1.0
            pair = elastic(self.turn, given, rows).split(force / scale) * scale
        else:
            pair = np.array([np.maximum(force, 0.0), np.maximum(-force, 0.0)])
        return State(force, y, lines, pair / levers)

    def _levers(self, lines: Sequence[ContactLine], y: Array) -> Array:
        """Lever of each contact's normal force along the travel, 1 or m (m, n); on a stem less its guide's friction.

        Not a number where that leaves nothing: the stem jams.
        """
        levers = np.array([line.lever for line in lines]) * (PER_MM if self.turn.swings else 1.0)
        if self.train.guide is None:
            return levers
        levers = self._free(lines, y)
        return np.where(levers > 0.0, levers, np.nan)

    def _free(self, lines: Sequence[ContactLine], y: Array) -> Array:
        """What the friction of a guide leaves of each contact's lever, (m, n)."""
        friction = 0.0 if self.train.guide is None else self.train.guide.friction
        rubbing = np.abs(self._at_ends(lines, y)).sum(axis=1)
        pushes = np.array(self.senses)[:, None] * self.senses[0]
        found: Array = np.array([line.lever for line in lines]) - pushes * np.sign(y[1]) * friction * rubbing
        return found

    def _at_ends(self, lines: Sequence[ContactLine], y: Array) -> Array:
        """What each contact's normal force of 1 bears on the guide's near end and far one, across the stem: (m, 2, n).

        A force across the stem bears by its overhang, one along it by its distance from the stem's axis. The axes of a
        contact that is turned see the stem from beyond the shaft.
        """
        guide, contacts = self.train.guide, self.design.follower.contacts
        if guide is None:
            return np.zeros((len(lines), 2, y.shape[1]))
        offset, risen = self.design.follower.offset, (y[0] - self.lowest) / self.unit
        found = []
        for line, contact in zip(lines, contacts, strict=True):
            beyond = contacts[0].zero + contact.zero if contact.turned else 0.0
            ahead, way = guide.overhang + beyond - risen, math.cos(contact.turned)
            across, couple = way * line.normal[:, 1], line.normal[:, 0] * (line.centre[:, 1] - way * offset)
            found.append([across * (ahead + guide.length) + couple, across * ahead + couple])
        return np.array(found) / guide.length

    @cached_property
    def jam_deg(self) -> float | None:
        """Shaft angle in degrees at which the stem jams in its guide, None where it does not."""
        if self.train.guide is None:
            return None

        def free(phi: Array) -> Array:
            rows = self.turn.rows(phi)
            return self._free(self.turn.lines(rows), self.position(rows))

        least = min((one for one, _ in self.turn.extremes(free)), key=lambda one: one.value)
        return least.at_deg if least.value <= 0.0 else None

    def torque(self, state: State) -> Array:
        """Torque that the shaft gives, N m (n,), above 0 where it drives."""
        shaft = np.array([side * line.shaft for side, line in zip(self.sides, state.lines, strict=True)])
        torque: Array = PER_MM * np.sum(state.normal * shaft, axis=0)
        return torque

    def guide_forces(self, state: State) -> Array | None:
        """Reactions of the guide at its near end and its far one, N (2, n), across the stem; None without."""
        if self.train.guide is None:
            return None
        pushed = np.array(self.sides)[:, None] * state.normal
        forces: Array = np.sum(pushed[:, None] * self._at_ends(state.lines, state.rows), axis=0)
        return forces

    def pressure(self, state: State) -> Array | None:
        """Hertz's pressure of each contact, N/mm^2 (m, n); None where width, material or a radius is not known."""
        train, width = self.train, self.train.width or self.recipe.part.thickness
        if train.material is None or width is None:
            return None
        bodies = [train.material, train.roller_material or train.material]
        compliance = sum((1.0 - body.poisson**2) / body.modulus for body in bodies)
        found = []
        follower = self.design.follower
        for normal, line, side, one in zip(state.normal, state.lines, self.sides, follower.contacts, strict=True):
            radius = follower.running(one).radius
            curvature = side / (line.bent - side * one.touch.radius) + (1.0 / radius if radius else 0.0)
            found.append(np.sqrt(np.maximum(normal * curvature, 0.0) / (math.pi * width * compliance)))
        return np.array(found)

    @property
    def most_pressure(self) -> float | None:
        """Pressure that the weaker of both materials bears, N/mm^2, None where the recipe gives none."""
        bodies = (self.train.material, self.train.roller_material)
        return min((body.limit for body in bodies if body is not None and body.limit is not None), default=None)

    def roller_speeds(self, state: State) -> Array | None:
        """Speed of the roller about its pin as each contact turns it, turns a minute (m, n); None of other touches."""
        from kin.follower.contact_lines import roller_turns

        follower, sides = self.design.follower, self.sides
        each = zip(state.lines, sides, follower.contacts, strict=True)
        found = [roller_turns(line, follower.running(one), side) for line, side, one in each]
        turns = [one for one in found if one is not None]
        return self.train.rpm * np.array(turns) if len(turns) == len(found) else None

    @cached_property
    def changes(self) -> Array:
        """Shaft angles, rad, at which F changes its sign, and with clearance the contact that bears."""
        (piece,) = self.turn.pieces(lambda phi: self.state(phi).force[None])
        return piece.crossings(0.0)

    def mean_force(self, index: int) -> tuple[float, float] | None:
        """Mean force that the roller of a contact bears over its own turns, N, and its turns per turn of the shaft."""
        places = np.unique(np.concatenate([self.turn.places, self.changes]))
        x, weight = np.polynomial.legendre.leggauss(NODES)
        edges = np.concatenate([np.linspace(a, b, PANELS + 1)[:-1] for a, b in pairwise(places)])
        edges = distinct(np.concatenate([edges, self.corners]))
        width = np.diff(np.append(edges, places[-1]))
        phi = (edges[:, None] + 0.5 * width[:, None] * (x + 1.0)).ravel()
        state, steps = self.state(phi), (0.5 * width[:, None] * weight).ravel()
        speeds = self.roller_speeds(state)
        if speeds is None:
            return None
        shared = self.shared_roller
        normal = state.normal.sum(axis=0) if shared else state.normal[index]
        bearing = np.argmax(state.normal, axis=0) if shared else np.full(len(phi), index)
        turned = np.abs(speeds[bearing, np.arange(len(phi))]) / self.train.rpm * steps
        turns = float(turned.sum())
        mean = float((np.sum(np.maximum(normal, 0.0) ** LIFE * turned) / turns) ** (1.0 / LIFE))
        return mean, turns / TURN

    @property
    def shared_roller(self) -> bool:
        """Whether one roller touches two surfaces, as in a groove."""
        contacts = self.design.follower.contacts
        return len(contacts) > 1 and self.design.follower.arrangement.contacts == 1

    def lost_rpm(self) -> list[tuple[str, float | None, float | None]]:
        """Of contacts under preload: name, the speed from which each is lost over the turn, None for none, and where.

        F = m Omega^2 y'' + W reaches the force that takes a contact away first where y'' over what is left is greatest.
        """
        given = self.design.exact.preload
        if given is None or given.stiffness is None:
            return []
        scale = PER_MM if self.turn.swings else 1.0

        def shares(phi: Array) -> Array:
            rows = self.turn.rows(phi)
            held = elastic(self.turn, given, rows)
            rest = self._rest(phi, self.position(rows)[0]) + self.preload
            pull = self.inertia(rows, 1.0)
            upper, lower = scale * held.loses_second - rest, rest - scale * held.loses_first
            return np.array([-pull / lower, pull / upper, upper, lower])

        (_, first), (_, second), (upper, _), (lower, _) = self.turn.extremes(shares)
        found: list[tuple[str, float | None, float | None]] = []
        for name, share, left in zip(self.turn.names, (first, second), (lower, upper), strict=True):
            if left.value <= 0.0:  # at rest already
                found.append((name, 0.0, left.at_deg))
            elif share.value > 0.0:
                found.append((name, 60.0 / TURN / math.sqrt(share.value), share.at_deg))
            else:
                found.append((name, None, None))
        return found


def unbounded(formula: Formula) -> float | None:
    """A shaft angle, rad, near which a formula grows beyond all bounds, None where there is none.

    What intervals leave open is halved until it is as narrow as angles are told apart, and looked at there.
    """
    low: Array = TURN / STRETCHES * np.arange(STRETCHES, dtype=np.float64)
    high: Array = low + TURN / STRETCHES
    usual = float(np.median(np.abs(formula(0.5 * (low + high))))) + 1.0
    while True:
        found = formula.ball(low, high, 0)
        open_ = ~np.isfinite(found.rad[0])
        low, high = low[open_][:MOST_OPEN], high[open_][:MOST_OPEN]
        if not len(low) or float((high - low).max()) < NARROW:
            break
        middle = 0.5 * (low + high)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    for at in low:
        sides = np.array([at - NARROW, at + 2.0 * NARROW])
        if float(np.abs(formula(sides)).max()) > LARGE * usual:
            return float(at)
    return None


def running_of(recipe: Recipe, design: Design) -> Running | None:
    """The rigid follower as it runs, None without dynamics, with an elastic train or under a linkage.

    Raises RecipeErrors for one contact that nothing holds on the cam.
    """
    train = recipe.dynamics
    if train is None or recipe.linkage is not None or train.stiffness is not None:
        return None
    held = train.preload is not None or train.least_force is not None
    if not held and len(design.follower.contacts) == 1:
        why = f"a single {design.follower.name} is held on the cam by a spring"
        raise recipe.error("dynamics", why, None, "give preload or least_force")
    return Running(recipe, design, train)
