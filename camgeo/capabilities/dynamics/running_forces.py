"""Forces of a follower that runs at a speed, rigid or with both contacts under preload: contacts, shaft, guide, roller.

The shaft's torque is the moment of the normal forces about it, by exact derivatives of the motion; without friction it
is F y'. Arrays (m, n) are by contact and place of the turn.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.dynamics.frame_forces import frame_running
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.moved_train import moved_train
from camgeo.capabilities.dynamics.running import LossSpeed, Pull, Running, State, lost
from camgeo.measures.forces import PER_MM, FollowerTurn, elastic_contacts
from kin.follower.contact_forces import Guided
from kin.numeric.angles import TURN, degrees
from kin.numeric.distinct import distinct
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.cams.family import Preload
    from camgeo.capabilities.dynamics.moved_train import MovedTrain
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.contact_forces import Elastic
    from kin.follower.contact_lines import ContactLine
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array

LIFE = 10.0 / 3.0  # exponent of the rating life of needle and roller bearings (ISO 281)
PANELS, NODES = 48, 8  # of Gauss's rule between two neighbouring places where the motion or the bearing contact changes


@dataclass(frozen=True, eq=False)
class FollowerRunning(Running):
    """Forces of a follower without a linkage."""

    @property
    def swings(self) -> bool:
        """Whether forces along the travel are moments."""
        return self.design.follower.arrangement.unit == "deg"

    @cached_property
    def turn(self) -> FollowerTurn:
        """The follower over the turn."""
        return FollowerTurn(self.design, self.corners)

    @cached_property
    def sides(self) -> tuple[Side, ...]:
        """Side of its contour on which the metal lies, by contact: 1 inside, -1 outside."""
        sides = {surface.name: surface.side for surface in self.design.exact.surfaces}
        return tuple(sides[contact.surface] for contact in self.design.follower.contacts)

    @cached_property
    def senses(self) -> tuple[int, ...]:
        """Sign of the push of each contact on the follower: 1 towards greater positions, -1 towards smaller ones."""
        return tuple(
            side * contact.sense for side, contact in zip(self.sides, self.design.follower.contacts, strict=True)
        )

    @property
    def unit(self) -> float:
        """Metres, or radians, in one unit of the follower's position: 0.001 for mm, 1 for rad."""
        return 1.0 if self.swings else PER_MM

    def position(self, rows: Array) -> Array:
        """Position y, m or rad, and two derivatives by the shaft angle (3, n), above 0 as the first contact pushes.

        `rows` (3, n) are position and derivatives of the turn, mm or rad.
        """
        position: Array = self.senses[0] * self.unit * rows
        return position

    @cached_property
    def moved(self) -> MovedTrain | None:
        """Mass and spring of what the follower moves beside itself; None without either.

        Raises RecipeErrors for a valve that never opens or does not fit the follower's lift.
        """
        return moved_train(self.recipe, self.design, self.train)

    @property
    def corners(self) -> tuple[float, ...]:
        """Shaft angles, rad, of the load's corners, and where a valve is taken up or put down.

        Raises RecipeErrors as `load` and `moved` do.
        """
        ends = () if self.moved is None else tuple(angle % TURN for angle in self.moved.ends)
        return (*super().corners, *ends)

    def inertia(self, t: Array, rows: Array, speed: float) -> Array:
        """Part of F that accelerates the follower and what it moves, N or N m (n,), at the speed Omega, rad/s."""
        own = super().inertia(t, rows, speed)
        return own if self.moved is None else own + self.senses[0] * speed**2 * self.moved.inertia(t, rows)

    def rest(self, t: Array, y: Array, more: float = 0.0) -> Array:
        """Part of F without inertia and preload, N or N m (n,), with the force of a spring on a valve."""
        rest, sense = super().rest(t, y, more), self.senses[0]
        return rest if self.moved is None else rest + sense * self.moved.spring(t, sense * y / self.unit)

    def at(self, t: Array, more: float = 0.0) -> State:
        """State of motion and forces at shaft angles t (n,), rad, with `more` load than the recipe's, N or N m.

        Raises RecipeErrors for a load without a finite value.
        """
        return self.in_motion(t, self.turn.rows(t), more=more)

    def in_motion(self, t: Array, rows: Array, gap: Array | None = None, more: float = 0.0) -> State:
        """State of motion and forces at shaft angles t (n,), rad, for a given motion, with `more` load, N or N m.

        `rows` (3, n) are position, mm or rad, and two derivatives by the shaft angle. `gap` (n,), mm or rad along the
        travel, is how much less than intended two preloaded contacts overlap with made metal. Normal forces are nan
        where the stem jams. Raises RecipeErrors for a load without a finite value.
        """
        lines = self.turn.lines(rows)
        y = self.position(rows)
        force = self.inertia(t, rows, self.speed) + self.rest(t, y[0], more) + self.preload
        normal = self._normal(force, rows, lines, gap)
        shaft = np.array([side * line.shaft for side, line in zip(self.sides, lines, strict=True)])
        torque: Array = PER_MM * np.sum(normal * shaft, axis=0)
        pressure, speeds = self._pressure(normal, lines), self._roller_rpm(lines)
        return State(force, y, normal, torque, pressure, self._guide_forces(y, normal, lines), lines, speeds)

    def _normal(self, force: Array, rows: Array, lines: Sequence[ContactLine], gap: Array | None = None) -> Array:
        """Normal force of each contact, N (m, n); nan where the stem jams in its guide."""
        scale = PER_MM if self.swings else 1.0
        levers = scale * np.array([line.lever for line in lines])  # m about a pivot
        if self.held_by is not None:
            normal: Array = self._pressed(self.held_by, rows, lines, gap).split(force / scale) * scale / levers
            return normal
        if len(lines) > 1:
            force = np.array([np.maximum(force, 0.0), np.maximum(-force, 0.0)])
        if self.train.guide is not None:
            levers = self._free(lines, self.position(rows))  # a stem has a guide, an arm none: no scale
            levers = np.where(levers > 0.0, levers, np.nan)
        return force / levers

    @property
    def held_by(self) -> Preload | None:
        """Preload by interference; None without preload, and where the recipe gives no stiffness of the contacts."""
        preload = self.design.exact.preload
        return None if preload is None or preload.stiffness is None else preload

    def preload_force(self, rows: Array, gap: Array) -> Array | None:
        """Force of the preload along the travel (n,), N or N m; None without preload, or without its stiffness.

        `rows` (3, n) are position, mm or rad, and two derivatives by the shaft angle. `gap` (n,), mm or rad along the
        travel, is how much less than intended the contacts overlap with made metal.
        """
        if self.held_by is None:
            return None
        scale = PER_MM if self.swings else 1.0
        force: Array = scale * elastic_contacts(self.turn, self.held_by, rows).apart(gap).preload
        return force

    def _pressed(
        self, preload: Preload, rows: Array, lines: Sequence[ContactLine], gap: Array | None = None
    ) -> Elastic | Guided:
        """Both contacts under preload, with the friction of a guide: N and mm, about a pivot N mm and rad."""
        pair = elastic_contacts(self.turn, preload, rows)
        pair = pair if gap is None else pair.apart(gap)
        if self.train.guide is None:
            return pair
        y = self.position(rows)
        sides, levers = np.array(self.sides), np.array([line.lever for line in lines])
        ends = (sides[:, None] / levers)[:, None] * self._at_ends(lines, y)
        return Guided(pair, ends, self.train.guide.friction * np.sign(y[1]))

    def _free(self, lines: Sequence[ContactLine], y: Array) -> Array:
        """Force along the travel per normal force of each contact, less the friction in the guide (m, n)."""
        friction = 0.0 if self.train.guide is None else self.train.guide.friction
        rubbing = np.abs(self._at_ends(lines, y)).sum(axis=1)
        pushes = np.array(self.senses)[:, None] * self.senses[0]
        lever: Array = np.array([line.lever for line in lines]) - pushes * np.sign(y[1]) * friction * rubbing
        return lever

    def _at_ends(self, lines: Sequence[ContactLine], y: Array) -> Array:
        """Forces across the stem on the guide's near and far end per unit normal force of each contact, (m, 2, n).

        They hold the moment about the ends: of the force across the stem by its overhang, of the force along the stem
        by its distance from the axis. The axes of a contact beyond the shaft are turned by half a turn, whose cosine
        is -1. All are 0 without a guide.
        """
        guide, contacts = self.train.guide, self.design.follower.contacts
        if guide is None:
            return np.zeros((len(lines), 2, y.shape[1]))
        offset, risen = self.design.follower.offset, (y[0] - self.lowest) / self.unit
        forces = []
        for line, contact in zip(lines, contacts, strict=True):
            beyond = contacts[0].zero + contact.zero if contact.turned else 0.0
            ahead, way = guide.overhang + beyond - risen, math.cos(contact.turned)
            across, couple = way * line.normal[:, 1], line.normal[:, 0] * (line.centre[:, 1] - way * offset)
            forces.append([across * (ahead + guide.length) + couple, across * ahead + couple])
        return np.array(forces) / guide.length

    @cached_property
    def jam_deg(self) -> float | None:
        """Shaft angle in degrees at which a single contact jams the stem in its guide; None where none does.

        Raises RecipeErrors where no single contact does, but two preloaded contacts together wedge the stem, and
        RoughError for too abrupt a motion.
        """
        if self.train.guide is None:
            return None

        def free(phi: Array) -> Array:
            rows = self.turn.rows(phi)
            lines = self.turn.lines(rows)
            left = self._free(lines, self.position(rows))
            if self.held_by is None:
                return left
            return np.stack([*left, self._pressed(self.held_by, rows, lines).together])

        count = len(self.turn.names)
        lowest = [place for place, _ in self.turn.extremes(free)]
        least = min(lowest[:count], key=lambda place: place.value)
        if least.value <= 0.0:
            return least.at_deg
        for place in lowest[count:]:
            if place.value <= 0.0:
                why = f"the preloaded contacts wedge the stem in it at {place.at_deg:.6g} degrees"
                raise self.recipe.error("dynamics.guide", why, None, "give less friction, or a longer guide")
        return None

    def _guide_forces(self, y: Array, normal: Array, lines: Sequence[ContactLine]) -> dict[str, Array]:
        """Reactions at the guide's near and far end, `guide_a` and `guide_b`, N (n,); empty without a guide."""
        if self.train.guide is None:
            return {}
        pushed = np.array(self.sides)[:, None] * normal
        near, far = np.sum(pushed[:, None] * self._at_ends(lines, y), axis=0)
        return {"guide_a": near, "guide_b": far}

    def _pressure(self, normal: Array, lines: Sequence[ContactLine]) -> Array | None:
        """Hertz's pressure of each contact, N/mm^2 (m, n); None without material or width.

        The contour's radius is that of the path of the touch's centre less the touch's radius. The running part may
        have another radius, 0 for a flat face.
        """
        curvatures = []
        follower = self.design.follower
        for line, side, contact in zip(lines, self.sides, follower.contacts, strict=True):
            radius = follower.running(contact).radius
            curvatures.append(side / (line.bent - side * contact.touch.radius) + (1.0 / radius if radius else 0.0))
        return self.hertz(normal, np.array(curvatures))

    def _roller_rpm(self, lines: Sequence[ContactLine]) -> Array | None:
        """Speed of each contact's roller about its pin, turns a minute (m, n); None unless all contacts are rollers."""
        from kin.follower.contact_lines import roller_turns

        follower, sides = self.design.follower, self.sides
        each = zip(lines, sides, follower.contacts, strict=True)
        speeds = [roller_turns(line, follower.running(contact), side) for line, side, contact in each]
        turns = [contact for contact in speeds if contact is not None]
        return self.train.rpm * np.array(turns) if len(turns) == len(speeds) else None

    @cached_property
    def changes(self) -> Array:
        """Shaft angles (k,), rad, from 0 to below a turn, at which F changes sign.

        With clearance the other contact begins to bear there.

        Raises RecipeErrors for a load without a finite value, RoughError for too abrupt a motion.
        """
        (piece,) = self.turn.pieces(lambda phi: self.state(phi).force[None])
        return piece.crossings_round(0.0)

    def mean_force(self, index: int) -> tuple[float, float] | None:
        """Equivalent force, N, on the roller of contact `index`, and its turns per turn of the shaft.

        The force is the mean over the roller's own turns with the exponent LIFE of bearing life. A roller between two
        surfaces bears both forces, and turns as the greater force drives it. None without a roller. Raises RecipeErrors
        for a load without a finite value.
        """
        # Gauss's rule in panels that end where motion, load or bearing contact change
        places = np.unique(np.concatenate([self.turn.places, self.changes]))
        x, weight = np.polynomial.legendre.leggauss(NODES)
        edges = np.concatenate([np.linspace(a, b, PANELS + 1)[:-1] for a, b in pairwise(places)])
        edges = distinct(np.concatenate([edges, self.corners]))
        width = np.diff(np.append(edges, places[-1]))
        phi = (edges[:, None] + 0.5 * width[:, None] * (x + 1.0)).ravel()
        state, steps = self.state(phi), (0.5 * width[:, None] * weight).ravel()
        speeds = state.roller_rpm
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

    def own_section(self) -> dict[str, object]:
        """Report entries `rollers`, the mean force on each, and of two contacts `changes_at_deg`, where F changes sign.

        Raises RecipeErrors for a load without a finite value.
        """
        names = self.turn.names
        section: dict[str, object] = {}
        if len(names) > 1:
            section["changes_at_deg"] = [degrees(at) for at in self.changes]
        rollers = {"roller": 0} if self.shared_roller else {name: k for k, name in enumerate(names)}
        means = [(name, self.mean_force(index)) for name, index in rollers.items()]
        section["rollers"] = [
            {"roller": name, "mean_force": mean[0], "unit": "N", "turns": mean[1]}
            for name, mean in means
            if mean is not None
        ]
        return section

    def lost_rpm(self) -> list[LossSpeed]:
        """Lowest speed at which each contact that is preloaded by interference is lost somewhere in the turn.

        Empty without such a preload, and where the recipe gives no stiffness of it. Raises RecipeErrors for a load
        without a finite value, RoughError for too abrupt a motion.
        """
        preload = self.held_by
        if preload is None:
            return []
        scale = PER_MM if self.swings else 1.0

        def held(phi: Array, more: float) -> Pull:
            rows = self.turn.rows(phi)
            pair = self._pressed(preload, rows, self.turn.lines(rows))
            rest = self.rest(phi, self.position(rows)[0], more) + self.preload
            return Pull(self.inertia(phi, rows, 1.0), rest, scale * pair.loses_first, scale * pair.loses_second)

        return lost(self.turn, self.turn.names, held, self.doubts)


def running_of(recipe: Recipe, design: Design) -> Running | None:
    """Forces of the train, taken as rigid; None without dynamics, and for an elastic train without a material.

    An elastic train whose contacts have a material has the forces of a rigid follower under the same spring, for their
    pressure. Raises RecipeErrors for a single contact that nothing holds on the cam, and for a linkage that does not
    turn right round.
    """
    train = recipe.of(Dynamics)
    if train is None or (train.stiffness is not None and train.material is None):
        return None
    if design.driven is not None:
        return frame_running(recipe, design, design.driven, train)
    return follower_running(recipe, design, train)


def follower_running(recipe: Recipe, design: Design, train: Dynamics) -> FollowerRunning:
    """Forces of a follower without a linkage; RecipeErrors for a single contact that nothing holds on the cam."""
    held = train.preload is not None or train.least_force is not None or train.spring is not None
    if not held and len(design.follower.contacts) == 1:
        why = f"a single {design.follower.name} is held on the cam by a spring"
        raise recipe.error("dynamics", why, None, "give preload or least_force")
    return FollowerRunning(recipe, design, train)
