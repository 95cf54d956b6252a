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
from camgeo.capabilities.dynamics.load_table import MOST_LOAD, LoadTable
from camgeo.measures.hertz import bearable, line_pressure
from kin.numeric.angles import TURN, degrees
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from camgeo.capabilities.dynamics.keys import Dynamics, Width
    from camgeo.capabilities.dynamics.load_formula import FormulaLoad, Sampled
    from camgeo.capabilities.dynamics.moved_train import MovedTrain
    from camgeo.measures.forces import Turn
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.contact_lines import ContactLine
    from kin.numeric.arrays import Array


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
    def swings(self) -> bool:
        """Whether forces along the travel are moments."""

    @property
    @abstractmethod
    def turn(self) -> Turn:
        """Motion of the follower over the turn."""

    @abstractmethod
    def position(self, rows: Array) -> Array:
        """Position y, m or rad, and two derivatives by the shaft angle (3, n), from the turn's `rows`, mm or rad."""

    @abstractmethod
    def at(self, t: Array, more: float = 0.0) -> State:
        """State of motion and forces at parameters t of the turn (n,), with `more` load than the recipe's, N or N m.

        Raises RecipeErrors for a load without a finite value.
        """

    @abstractmethod
    def own_section(self) -> dict[str, object]:
        """Entries of the report's section in addition to the extremes and the speeds of loss, by name."""

    @property
    def moved(self) -> MovedTrain | None:
        """Mass and spring of what the follower moves beside itself; None without either."""
        return None

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
        """Shaft angles, rad, at which the load is not smooth, or is cut so that no narrow feature of it is missed.

        Raises RecipeErrors as `load` does.
        """
        return tuple(self._followed.corners.tolist())

    @property
    def doubts(self) -> tuple[float, ...]:
        """Loads beside the one computed, N or N m, between which the true one lies: 0 alone, unless it is sampled.

        Raises RecipeErrors as `load` does.
        """
        sampled = self.sampled
        return (0.0,) if sampled is None else (-sampled.within, 0.0, sampled.within)

    @property
    def sampled(self) -> Sampled | None:
        """Where a load is sampled, and by how much it may be off; None for a load of which all is proved.

        Raises RecipeErrors as `load` does.
        """
        return None if isinstance(self._followed, LoadTable) else self._followed.sampled

    @cached_property
    def lowest(self) -> float:
        """Least position y of the follower over the turn, m or rad; RoughError for too abrupt a motion."""
        ((least, _),) = self.turn.extremes(lambda t: self.position(self.turn.rows(t))[:1])
        return least.value

    @cached_property
    def _followed(self) -> LoadTable | FormulaLoad:
        """The load with its corners; raises RecipeErrors as `load` does."""
        from camgeo.capabilities.dynamics.load_formula import LoadError, followed
        from kin.law.formula.formula import FormulaDomainError

        load = self.train.load
        if not isinstance(load, str):
            return load
        try:
            return followed(load)
        except FormulaDomainError as error:
            raise self.recipe.error("dynamics.load", str(error)) from error
        except LoadError as error:
            place = f"{degrees(error.at):.6g} degrees"
            if error.size is None:
                why, remedy = f"it has no bound near {place}", "give a load that is finite"
                raise self.recipe.error("dynamics.load", why, f"'{load}'", remedy) from error
            unit = "N m" if self.swings else "N"
            why = f"it reaches {error.size:.4g} {unit} at {place}, above {MOST_LOAD:.0f}"
            raise self.recipe.error("dynamics.load", why, f"'{load}'", "give a smaller load") from error

    def load(self, phi: Array) -> Array:
        """The load at shaft angles (n,), rad: N or N m (n,), above 0 where it presses towards the cam.

        Raises RecipeErrors for a formula that somewhere has no value or no bound, or exceeds MOST_LOAD in magnitude.
        """
        from kin.law.formula.formula import FormulaDomainError

        try:
            return self._followed(phi)
        except FormulaDomainError as error:
            raise self.recipe.error("dynamics.load", str(error)) from error

    def rest(self, t: Array, y: Array, more: float = 0.0) -> Array:
        """Part of F without inertia and preload, N or N m (n,): k (y - least y) + load + `more`.

        `t` (n,) are parameters of the turn, `y` (n,) positions there, m or rad. Raises RecipeErrors for a load without
        a finite value, RoughError for too abrupt a motion.
        """
        load = self.load(self.turn.shaft(t)) + more
        rest: Array = self.train.rate * (y - self.lowest) + load if self.train.rate else load
        return rest

    def inertia(self, t: Array, rows: Array, speed: float) -> Array:  # noqa: ARG002 - where a seat bears a mass
        """Part of F that accelerates the mass, m Omega^2 y'', N or N m (n,), at the speed Omega, rad/s.

        It is above 0 where the follower accelerates in the direction in which y grows. `t` (n,) are parameters of the
        turn, `rows` (3, n) position and derivatives there, mm or rad.
        """
        force: Array = self.train.mass * speed**2 * self.position(rows)[2]
        return force

    @cached_property
    def preload(self) -> float:
        """Force of the spring at the lowest position, N or N m: as stated, or the least that keeps `least_force`.

        It keeps that with the least of the `doubts` too. 0 without a spring. Raises RecipeErrors for a load without a
        finite value, RoughError for too abrupt a motion.
        """
        if self.train.least_force is None:
            return self.train.preload or 0.0

        def without(t: Array) -> Array:
            rows = self.turn.rows(t)
            force: Array = self.inertia(t, rows, self.speed) + self.rest(t, self.position(rows)[0], self.doubts[0])
            return force[None]

        ((least, _),) = self.turn.extremes(without)
        return max(self.train.least_force - least.value, 0.0)

    @property
    def most_pressure(self) -> float | None:
        """The lower of the pressures that both materials bear, N/mm^2; None where the recipe states none."""
        return bearable(self.train.material, self.train.roller_material)

    @cached_property
    def width(self) -> Width | None:
        """Width of the contacts, mm, and what bounds it; None where neither the recipe nor the metal gives one."""
        part = self.recipe.part
        depth = min(
            (surface.depth for surface in self.design.exact.surfaces if surface.depth is not None), default=None
        )
        return contact_width(self.train.width, part.thickness, part.edge, depth)

    def hertz(self, normal: Array, curvature: Array) -> Array | None:
        """Greatest pressure of the contacts, N/mm^2 (m, n), by `line_pressure`; None without material or width.

        `normal` (m, n) is the force, N; `curvature` (m, n) the sum of both bodies' curvatures, 1/mm.
        """
        train = self.train
        if train.material is None or self.width is None:
            return None
        touching = train.roller_material or train.material
        return line_pressure(normal, curvature, self.width.length, train.material, touching)


class Pull(NamedTuple):
    """Load of two preloaded contacts at n places, in one unit; (n,) each.

    At the speed Omega, rad/s, it is Omega^2 times `inertia` plus `rest`. From `loses_second` on upwards the second
    contact is lost, from `loses_first` on downwards the first.
    """

    inertia: Array
    rest: Array
    loses_first: Array
    loses_second: Array


def lost(
    turn: Turn, names: Sequence[str], pull: Callable[[Array, float], Pull], doubts: Sequence[float]
) -> list[LossSpeed]:
    """Speed from which each of two preloaded contacts is lost; `names` has their names, the first contact's first.

    `pull` gives the load at parameters of the turn (n,), with more load than the recipe's, N or N m. With J its
    `inertia`, W its `rest` and L the load at which a contact is lost, that contact is lost from Omega^2 = (L - W)/J on;
    the least over the turn, and over the `doubts`, counts. Raises RoughError where the motion changes too abruptly,
    RecipeErrors where `pull` does.
    """
    losses = [_lost(turn, names, pull, more) for more in doubts]
    return [min(own, key=lambda loss: math.inf if loss.rpm is None else loss.rpm) for own in zip(*losses, strict=True)]


def _lost(turn: Turn, names: Sequence[str], pull: Callable[[Array, float], Pull], more: float) -> list[LossSpeed]:
    """The speeds of `lost` under `more` load than the recipe's, N or N m."""

    def left(pull_at: Pull) -> Array:
        return np.array([pull_at.rest - pull_at.loses_first, pull_at.loses_second - pull_at.rest])

    held = [least for least, _ in turn.extremes(lambda t: left(pull(t, more)))]
    holds = np.array([[least.value > 0.0] for least in held])

    def shares(t: Array) -> Array:
        pull_at = pull(t, more)
        share: Array = np.array([-pull_at.inertia, pull_at.inertia]) / np.where(holds, left(pull_at), 1.0)
        return share  # of a contact that is lost at rest it says nothing

    losses = []
    for name, least, (_, share) in zip(names, held, turn.extremes(shares), strict=True):
        if least.value <= 0.0:
            losses.append(LossSpeed(name, 0.0, least.at_deg))
        elif share.value > 0.0:
            losses.append(LossSpeed(name, 60.0 / TURN / math.sqrt(share.value), share.at_deg))
        else:
            losses.append(LossSpeed(name, None, None))
    return losses


def begins_at(rpm: float, asked: float) -> str:
    """Words for the speed, turns a minute, at which float begins, 0 for a contact that is lost at rest.

    They end in a semicolon, before what follows.
    """
    begins = f"float begins at {rpm:.6g} rpm of the shaft" if rpm else "contact is lost at rest too"
    return f"{begins}, and {asked:.6g} are asked for; "


def float_rpm(running: Running, stretches: Sequence[tuple[float, float]]) -> float:
    """Speed, turns a minute, from which a single contact is lost somewhere in stretches of the turn, rad.

    With J the force of inertia at a speed of 1 rad/s and W the rest, it is lost from Omega^2 = -W/J on; the least over
    the stretches and over the `doubts` counts. It is 0 for a contact that is lost at rest, and infinite for one that no
    speed loses. Raises RoughError where the motion changes too abruptly, RecipeErrors for a load without a finite
    value.
    """
    turn = running.turn

    def parts(t: Array, more: float) -> tuple[Array, Array]:
        rows = turn.rows(t)
        rest = running.rest(t, running.position(rows)[0], more) + running.preload
        return running.inertia(t, rows, 1.0), rest

    speeds = [math.inf]
    for more in running.doubts:

        def held(t: Array, more: float = more) -> Array:
            return parts(t, more)[1][None]

        def share(t: Array, more: float = more) -> Array:
            inertia, rest = parts(t, more)
            return (-inertia / rest)[None]

        for stretch in stretches:
            ((least, _),) = turn.extremes(held, stretch)
            if least.value <= 0.0:
                return 0.0
            ((_, most),) = turn.extremes(share, stretch)
            if most.value > 0.0:
                speeds.append(60.0 / TURN / math.sqrt(most.value))
    return min(speeds)
