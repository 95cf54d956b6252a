"""What a follower moves beside itself: the mass and the spring of a valve, as the follower feels them.

The body's travel v is a function of the follower's lift s, mm, with R = dv/ds its ratio and R' = dR/ds. While the body
is off its seat, its mass m_v adds R^2 m_v to the follower's and a force m_v R R' s'^2, and a spring of force F(v) on it
pushes with R F(v): the power of the follower's force is that which goes into the energy of both masses and the spring.
On the seat, and in the lash before it, the seat carries the spring and the body does not move.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.measures.extension import MEASURES
from camgeo.measures.forces import PER_MM
from camgeo.measures.lobe import EventError, events_of, lift_pieces
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.dynamics.keys import Coil, Dynamics
    from camgeo.measures.extension import MovedBody
    from camgeo.measures.lobe import LobeEvent
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array, Mask


@dataclass(frozen=True, eq=False)
class MovedTrain:
    """Mass, kg, and spring of a body that a follower moves; `coil` is None where the body has no spring.

    `stretches` are those of the turn in which it is off its seat, `datum` the follower's lowest position, mm.
    """

    body: MovedBody
    mass: float
    coil: Coil | None
    stretches: tuple[LobeEvent, ...]
    datum: float

    @property
    def ends(self) -> tuple[float, ...]:
        """Shaft angles, rad, at which the body leaves its seat or meets it; of the next turn above a turn."""
        return tuple(angle for event in self.stretches for angle in (event.opening, event.closing))

    def is_open(self, shaft: Array) -> Mask:
        """Whether the body is off its seat at shaft angles (n,), rad."""
        is_open = np.zeros(len(shaft), dtype=np.bool_)
        for event in self.stretches:
            since = np.mod(shaft - event.opening, TURN)
            is_open |= (since > 0.0) & (since < event.closing - event.opening)
        return is_open

    def inertia(self, shaft: Array, rows: Array) -> Array:
        """Force on the follower along its lift by a mass at rad/s of 1, N (n,): m_v R (R s'' + R' s'^2).

        `rows` (3, n) are position, mm, and two derivatives by the shaft angle. 0 on the seat.
        """
        travel = self.body.travel(rows[0] - self.datum)
        force = PER_MM * self.mass * travel[1] * (travel[1] * rows[2] + travel[2] * rows[1] ** 2)
        return np.where(self.is_open(shaft), force, 0.0)

    def spring(self, shaft: Array, position: Array) -> Array:
        """Force of the spring on the follower against its lift, N (n,): R F(v); 0 on the seat and without a spring.

        `position` (n,) is the follower's, mm.
        """
        if self.coil is None:
            return np.zeros_like(position)
        travel = self.body.travel(position - self.datum)
        pressed = self.coil.preload + PER_MM * self.coil.rate * (travel[0] - self._lash)
        return np.where(self.is_open(shaft), travel[1] * pressed, 0.0)

    def ratio(self, position: Array) -> Array:
        """Ratio R and its derivative by the follower's lift, 1/mm, (2, n), at positions of the follower (n,), mm."""
        ratio: Array = self.body.travel(position - self.datum)[1:]
        return ratio

    @property
    def _lash(self) -> float:
        """Travel, mm, that only takes up the lash."""
        return float(self.body.travel(np.array([self.body.follower_lift(0.0)]))[0, 0])


def moved_body(recipe: Recipe, design: Design) -> MovedBody | None:
    """Body that the follower moves beside itself; None without one.

    Raises RecipeErrors for a body that does not fit the follower's lift, EventError for too rough a motion.
    """
    bodies = [MEASURES[name].moved(recipe, design) for name in recipe.uses]
    return next((body for body in bodies if body is not None), None)


def greatest_travel(body: MovedBody, lift: float) -> float:
    """Greatest travel of a body off its seat, mm, where its follower lifts up to `lift`, mm."""
    lifts = np.array([lift, body.follower_lift(0.0)])
    most, seated = body.travel(lifts)[0].tolist()
    return max(float(most - seated), 0.0)


def moved_train(recipe: Recipe, design: Design, train: Dynamics) -> MovedTrain | None:
    """Mass and spring of the body that the follower moves; None where the train has neither.

    Raises RecipeErrors for a body that is never off its seat or does not fit the follower's lift, and for too abrupt a
    motion.
    """
    coil = train.spring if train.spring is not None and train.spring.on_body else None
    if coil is None and not train.moved_mass:
        return None
    try:
        body = moved_body(recipe, design)
        if body is None:
            raise ValueError(f"{recipe.name}: the follower moves nothing beside itself")
        stretches = events_of(design.exact, body.follower_lift(0.0))
        datum, _ = lift_pieces(design.exact).least()
    except EventError as error:
        raise recipe.error("dynamics", str(error)) from error
    if not stretches:
        raise recipe.error("dynamics", f"the {body.name} never opens", None, f"give less lash in {body.name}")
    return MovedTrain(body, train.moved_mass, coil, stretches, datum)
