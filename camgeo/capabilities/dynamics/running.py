"""Forces of a rigid train at a speed, and the interface by which they are obtained.

In SI: N and m, about a pivot N m and rad. F is the force of the cam along the travel, above 0 in the direction in which
the first contact pushes, or in which the output of a linkage grows. The position y is counted in that direction:
F = m Omega^2 y'' + k (y - least y) + F0 + load, with m the mass, Omega the shaft's speed, k rate and F0 preload of the
spring. The parameter t of a turn is the shaft angle; of a linkage the relative angle between cam and frame.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.dynamics.keys import contact_width
from camgeo.capabilities.dynamics.load_table import MOST_LOAD
from kin.numeric.angles import TURN, degrees
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from camgeo.capabilities.dynamics.keys import Dynamics, Width
    from camgeo.measures.forces import Turn
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.contact_lines import ContactLine
    from kin.law.formula.formula import Formula
    from kin.numeric.arrays import Array

STRETCHES, MOST_OPEN = 256, 64  # of a turn in which a load is enclosed; at most so many unsettled ones are halved
NARROW, LARGE = 1e-9, 1e6  # a load that exceeds LARGE times its usual size within NARROW, rad, has a pole there


class State(NamedTuple):
    """Motion and forces at n places of the turn, of m contacts.

    force       F along the travel, N or N m (n,)
    rows        position y, m or rad, and two derivatives by the shaft angle (3, n)
    normal      normal force of each contact, N (m, n)
    torque      of the shaft, N m (n,), above 0 where the shaft drives
    pressure    Hertz's, of each contact, N/mm^2 (m, n); None where width or material is not known
    reactions   further forces, N (n,), by the names of their columns
    lines       line of each contact's force; empty for a linkage
    roller_rpm  turns a minute of the roller about its pin as each contact turns it (m, n); None without rollers
    """

    force: Array
    rows: Array
    normal: Array
    torque: Array
    pressure: Array | None
    reactions: Mapping[str, Array]
    lines: tuple[ContactLine, ...] = ()
    roller_rpm: Array | None = None


class LossSpeed(NamedTuple):
    """Speed, turns a minute, from which a preloaded contact is lost, and the shaft angle there, degrees.

    The speed is 0 for a contact that is lost at rest. Both are None for a contact that is never lost.
    """

    contact: str
    rpm: float | None
    at_deg: float | None


@dataclass(frozen=True, eq=False)
class Running(ABC):
    """Forces of a design that runs at the speed and under the loads of its recipe's dynamics."""

    recipe: Recipe
    design: Design
    train: Dynamics

    @property
    @abstractmethod
    def turn(self) -> Turn:
        """Motion of the follower over the turn."""

    @abstractmethod
    def position(self, rows: Array) -> Array:
        """Position y, m or rad, and two derivatives by the shaft angle (3, n), from the turn's `rows`, mm or rad."""

    @abstractmethod
    def at(self, t: Array) -> State:
        """State of motion and forces at parameters t of the turn (n,); RecipeErrors for a load without finite value."""

    @abstractmethod
    def own_section(self) -> dict[str, object]:
        """Entries of the report's section in addition to the extremes and the speeds of loss, by name."""

    @property
    def jam_deg(self) -> float | None:
        """Shaft angle in degrees at which a stem jams in its guide, None where none does."""
        return None

    def mean_force(self, index: int) -> tuple[float, float] | None:  # noqa: ARG002 - the protocol's
        """Mean force, N, on the roller of contact `index` over its own turns, and its turns per turn of the shaft.

        None without a roller.
        """
        return None

    def lost_rpm(self) -> list[LossSpeed]:
        """Lowest speed at which each contact that is preloaded by interference is lost somewhere in the turn.

        Empty without such a preload, and where the recipe gives no stiffness of it; a spring does not count. Raises
        RecipeErrors for a load without a finite value, RoughError for too abrupt a motion.
        """
        return []

    def state(self, phi: Array) -> State:
        """State of motion and forces at shaft angles phi (n,), rad; RecipeErrors for a load without finite value."""
        return self.at(self.turn.parameter(phi))

    @property
    def speed(self) -> float:
        """Speed of the shaft, rad/s."""
        return self.train.rpm * TURN / 60.0

    @property
    def corners(self) -> tuple[float, ...]:
        """Shaft angles, rad, at which a load from a table changes its slope; empty for a formula."""
        load = self.train.load
        return () if isinstance(load, str) else tuple(load.corners.tolist())

    @cached_property
    def lowest(self) -> float:
        """Least position y of the follower over the turn, m or rad; RoughError for too abrupt a motion."""
        ((least, _),) = self.turn.extremes(lambda t: self.position(self.turn.rows(t))[:1])
        return least.value

    @cached_property
    def load(self) -> Callable[[Array], Array]:
        """The load as a function of shaft angles (n,), rad: N or N m (n,), above 0 where it presses towards the cam.

        Raises RecipeErrors for a formula that somewhere has no value or no bound, or exceeds MOST_LOAD in magnitude.
        """
        from kin.law.formula.formula import Formula, FormulaDomainError

        load = self.train.load
        if not isinstance(load, str):
            return load
        formula = Formula(load)
        try:
            at, beyond = unbounded(formula), place_beyond(formula, MOST_LOAD)
            formula(self.turn.shaft(self.turn.places))
        except FormulaDomainError as error:
            raise self.recipe.error("dynamics.load", str(error)) from error
        if at is not None:
            why = f"it has no bound near {degrees(at):.6g} degrees"
            raise self.recipe.error("dynamics.load", why, f"'{load}'", "give a load that is finite")
        if beyond is not None:
            value = abs(float(formula(np.array([beyond]))[0]))
            why = f"it reaches {value:.4g} {self.turn.unit} at {degrees(beyond):.6g} degrees, above {MOST_LOAD:.0f}"
            raise self.recipe.error("dynamics.load", why, f"'{load}'", "give a smaller load")
        return lambda phi: np.asarray(formula(np.asarray(phi, dtype=np.float64)))

    def rest(self, t: Array, y: Array) -> Array:
        """Part of F without inertia and preload, N or N m (n,): k (y - least y) + load.

        `t` (n,) are parameters of the turn, `y` (n,) positions there, m or rad. Raises RecipeErrors for a load without
        a finite value, RoughError for too abrupt a motion.
        """
        load = self.load(self.turn.shaft(t))
        rest: Array = self.train.rate * (y - self.lowest) + load if self.train.rate else load
        return rest

    def inertia(self, rows: Array, speed: float) -> Array:
        """Part of F that accelerates the mass, m Omega^2 y'', N or N m (n,), at the speed Omega, rad/s.

        It is above 0 where the follower accelerates in the direction in which y grows. `rows` (3, n) are position and
        derivatives of the turn, mm or rad.
        """
        force: Array = self.train.mass * speed**2 * self.position(rows)[2]
        return force

    @cached_property
    def preload(self) -> float:
        """Force of the spring at the lowest position, N or N m: as stated, or the least that keeps `least_force`.

        0 without a spring. Raises RecipeErrors for a load without a finite value, RoughError for too abrupt a motion.
        """
        if self.train.least_force is None:
            return self.train.preload or 0.0

        def without(t: Array) -> Array:
            rows = self.turn.rows(t)
            force: Array = self.inertia(rows, self.speed) + self.rest(t, self.position(rows)[0])
            return force[None]

        ((least, _),) = self.turn.extremes(without)
        return max(self.train.least_force - least.value, 0.0)

    @property
    def most_pressure(self) -> float | None:
        """The lower of the pressures that both materials bear, N/mm^2; None where the recipe states none."""
        bodies = (self.train.material, self.train.roller_material)
        return min((body.limit for body in bodies if body is not None and body.limit is not None), default=None)

    @cached_property
    def width(self) -> Width | None:
        """Width of the contacts, mm, and what bounds it; None where neither the recipe nor the metal gives one."""
        part = self.recipe.part
        depth = min(
            (surface.depth for surface in self.design.exact.surfaces if surface.depth is not None), default=None
        )
        return contact_width(self.train.width, part.thickness, part.edge, depth)

    def hertz(self, normal: Array, curvature: Array) -> Array | None:
        """Greatest pressure of line contacts, N/mm^2 (m, n), by Hertz: p = sqrt(N kappa/(pi B C)).

        `normal` (m, n) is the force N, N; `curvature` (m, n) is kappa, the sum of both bodies' curvatures, 1/mm, with
        pressure 0 where it is below 0. B is the width and C the sum of (1 - nu^2)/E of both. None without material or
        width.
        """
        train = self.train
        if train.material is None or self.width is None:
            return None
        bodies = [train.material, train.roller_material or train.material]
        compliance = sum((1.0 - body.poisson**2) / body.modulus for body in bodies)
        pressure: Array = np.sqrt(np.maximum(normal * curvature, 0.0) / (math.pi * self.width.length * compliance))
        return pressure


class Pull(NamedTuple):
    """Load of two preloaded contacts at n places, in one unit; (n,) each.

    At the speed Omega, rad/s, it is Omega^2 times `inertia` plus `rest`. From `loses_second` on upwards the second
    contact is lost, from `loses_first` on downwards the first.
    """

    inertia: Array
    rest: Array
    loses_first: Array
    loses_second: Array


def lost(turn: Turn, names: Sequence[str], pull: Callable[[Array], Pull]) -> list[LossSpeed]:
    """Speed from which each of two preloaded contacts is lost; `names` has their names, the first contact's first.

    `pull` gives the load at parameters of the turn (n,). With J its `inertia`, W its `rest` and L the load at which a
    contact is lost, that contact is lost from Omega^2 = (L - W)/J on; the least over the turn counts. Raises RoughError
    where the motion changes too abruptly, RecipeErrors where `pull` does.
    """

    def shares(t: Array) -> Array:
        pull_at = pull(t)
        upper, lower = pull_at.loses_second - pull_at.rest, pull_at.rest - pull_at.loses_first
        return np.array([-pull_at.inertia / lower, pull_at.inertia / upper, upper, lower])

    (_, first), (_, second), (upper, _), (lower, _) = turn.extremes(shares)
    losses = []
    for name, share, left in zip(names, (first, second), (lower, upper), strict=True):
        if left.value <= 0.0:  # the contact is lost at rest
            losses.append(LossSpeed(name, 0.0, left.at_deg))
        elif share.value > 0.0:
            losses.append(LossSpeed(name, 60.0 / TURN / math.sqrt(share.value), share.at_deg))
        else:
            losses.append(LossSpeed(name, None, None))
    return losses


def unbounded(formula: Formula) -> float | None:
    """A shaft angle, rad, near which a formula grows beyond all bounds; None where none is found.

    Stretches of the turn over which intervals give no finite enclosure are halved down to NARROW; there the formula is
    evaluated on both sides. Of more than MOST_OPEN the rest is given up, so None is no proof. Raises FormulaDomainError
    where it has no value at a place that is evaluated.
    """
    low: Array = TURN / STRETCHES * np.arange(STRETCHES, dtype=np.float64)
    high: Array = low + TURN / STRETCHES
    usual = float(np.median(np.abs(formula(0.5 * (low + high))))) + 1.0
    while True:
        value = formula.ball(low, high, 0)
        open_ = ~np.isfinite(value.rad[0])
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


def place_beyond(formula: Formula, most: float) -> float | None:
    """A shaft angle, rad, at which the magnitude of a formula exceeds `most`; None where none is found.

    Stretches over which intervals do not prove the magnitude to be within `most` are halved down to NARROW, and their
    middles evaluated; of more than MOST_OPEN the rest is given up. None is no proof where any is left. Raises
    FormulaDomainError where the formula has no value at a place that is evaluated.
    """
    low: Array = TURN / STRETCHES * np.arange(STRETCHES, dtype=np.float64)
    high: Array = low + TURN / STRETCHES
    while len(low) and float((high - low).max()) > NARROW:
        middle = 0.5 * (low + high)
        beyond = np.abs(formula(middle)) > most
        if beyond.any():
            return float(middle[np.argmax(beyond)])
        enclosure = formula.ball(low, high, 0)
        within = np.abs(enclosure.mid[0]) + enclosure.rad[0] <= most
        low, middle, high = (row[~within][:MOST_OPEN] for row in (low, middle, high))
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return None
