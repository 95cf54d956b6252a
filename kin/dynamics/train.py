"""Dynamics of a follower train with one degree of freedom, driven through its contact by a cam that turns steadily.

    m x'' = N - F - k_p x      N = k (s - x) + c (s' - x'), or 0 where that would pull

m mass, k and c stiffness and damping of contact or train, F the preload spring's force at s = 0 and k_p its rate; s is
the position that the cam asks for, x the follower's. All in SI: kg, N s/m, N/m, N, m; or, for a follower that swings,
kg m^2, N m s/rad, N m/rad, N m, rad. In radians of shaft angle and with z = x - s, while there is contact,

    z'' + 2 a z' + r^2 z = -s'' - kappa s - f      N = -m W^2 (rho^2 z + 2 a z')

with W the shaft's speed in rad/s, a = c/(2 m W), r^2 = (k + k_p)/(m W^2), rho^2 = k/(m W^2), kappa = k_p/(m W^2) and
f = F/(m W^2). That is linear, and solved exactly (`kin.dynamics.response`); what happens where contact is lost is
found event by event (`kin.dynamics.impacts`).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.dynamics.oscillator import Oscillator
from kin.dynamics.peaks import PeaksOverTurn, ResponseFigure
from kin.dynamics.response import Forcing, Response, ResponsePlaces, response
from kin.numeric.angles import TURN
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.dynamics.drive import Drive
    from kin.numeric.arrays import Array, Complexes


_LEAST_DETUNING = 1e-9  # below, the amplitude at resonance is a matter of rounding
_MOST_NATURAL = 1e6  # times the shaft's, from which the phase of a free motion after a turn is a matter of rounding
_LEAST_NATURAL = 1e-9  # times the shaft's, below which a turn brings nothing back
MOST_SWUNG = 4_000_000  # places at which the free motion of a steady state is looked at: about two seconds
_SILENT_AFTER = 60.0  # in units of 1/fading and with room: by then a free motion counts no more (`Response.lasting`)
_STRETCHES = 500  # of a turn that a damping is advised for: a file has more than the intent
MOST_DAMPING = 10.0  # times critical: beyond, the damper is the drive and the mass hardly counts


class DynamicsError(CamgeoError, ValueError):
    """A figure that no follower train has, or a result that a train does not have at a speed; its text names it."""


@dataclass(frozen=True)
class Train:
    """A follower train, in SI; the figures of a follower that swings are about its pivot.

    mass       kg or kg m^2, above 0
    damping    of contact or train, N s/m or N m s/rad, at most MOST_DAMPING times critical
    stiffness  of contact or train, N/m or N m/rad, above 0
    preload    force of the preload spring at s = 0, N or N m
    rate       of the preload spring, N/m or N m/rad

    Raises DynamicsError for figures out of these bounds, below 0 or not finite.
    """

    mass: float
    damping: float
    stiffness: float
    preload: float = 0.0
    rate: float = 0.0

    def __post_init__(self) -> None:
        for name, least in (("mass", None), ("damping", 0.0), ("stiffness", None), ("preload", 0.0), ("rate", 0.0)):
            value = getattr(self, name)
            if not (math.isfinite(value) and (value > 0.0 if least is None else value >= least)):
                raise DynamicsError(f"{name} must be {'above 0' if least is None else '0 or above'}, not {value!r}")
        if self.damping_ratio > MOST_DAMPING:
            raise DynamicsError(
                f"the damping is {self.damping_ratio:.4g} times critical; beyond {MOST_DAMPING:g} times it is the "
                "damper that drives"
            )

    @property
    def natural(self) -> float:
        """Undamped natural frequency in contact, rad/s."""
        return math.sqrt((self.stiffness + self.rate) / self.mass)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio: the damping over the critical damping."""
        return 0.5 * self.damping / math.sqrt((self.stiffness + self.rate) * self.mass)

    def ratio(self, rpm: float) -> float:
        """Ratio of the undamped natural frequency to the shaft's at `rpm`: cycles per turn of the shaft."""
        return self.natural / speed(rpm)

    def at(self, rpm: float) -> Running:
        """The train at a shaft speed, revolutions a minute; DynamicsError for one that is not finite and above 0."""
        if not (math.isfinite(rpm) and rpm > 0.0):
            raise DynamicsError(f"the shaft speed must be above 0, not {rpm!r} rpm")
        return Running(self, rpm)


def speed(rpm: float) -> float:
    """Angular velocity, rad/s, of a speed in revolutions a minute."""
    return rpm * TURN / 60.0


@dataclass(frozen=True)
class Running:
    """A train at a shaft speed: its figures in radians of shaft angle."""

    train: Train
    rpm: float

    @property
    def speed(self) -> float:
        """Shaft speed W, rad/s."""
        return speed(self.rpm)

    @property
    def inertia(self) -> float:
        """Mass times W^2, N/m or N m/rad: it turns an acceleration by radian of shaft into a force."""
        return self.train.mass * self.speed**2

    @property
    def forcing(self) -> Forcing:
        """The spring's terms of the equation of motion in the module: kappa = k_p/(m W^2), f = F/(m W^2)."""
        return Forcing(self.train.rate / self.inertia, self.train.preload / self.inertia)

    @property
    def bound(self) -> Oscillator:
        """Oscillator of the train in contact: spring, contact stiffness and damping act."""
        square = (self.train.stiffness + self.train.rate) / self.inertia
        return Oscillator(0.5 * self.train.damping / (self.train.mass * self.speed), square)

    @property
    def loose(self) -> Oscillator:
        """Oscillator of the train out of contact: the preload spring alone acts, without damping."""
        return Oscillator(0.0, self.train.rate / self.inertia)

    def response(self, drive: Drive) -> Response:
        """Response z, m or rad, as if in contact all round, with a face that follows the drive.

        Raises StiffnessError for damping so strong that the response needs too many parts.
        """
        return response(self.bound, drive, self.forcing)

    def force(self, response: Response, side: int = 1) -> ResponseFigure:
        """Contact force, N or N m, of a response over the drive's face; `side` is -1 for a face that pushes down."""
        k, c = self.train.stiffness, self.train.damping * self.speed
        return ResponseFigure.of(response, -side * k, -side * c)

    def transfer(self, count: int) -> Complexes:
        """Contact force by the cam's position in contact, complex, N/m or N m/rad, for 0 to count // 2 waves a turn."""
        train, waves = self.train, self.speed * np.arange(count // 2 + 1)
        link = train.stiffness + 1j * train.damping * waves
        mass_and_spring = train.rate - train.mass * waves**2
        transfer: Complexes = link * mass_and_spring / (link + mass_and_spring)
        return transfer

    def static(self, position: float) -> float:
        """Static z = x - s, m or rad, of the train at rest on a face that stands still at s = `position`."""
        train = self.train
        return -(train.preload + train.rate * position) / (train.stiffness + train.rate)


class Residual(NamedTuple):
    """Vibration in a dwell of the drive: its shaft angles, rad, and the greatest |z - static z|, m or rad."""

    start: float
    end: float
    amplitude: float


@dataclass(frozen=True)
class Steady:
    """Steady state, which repeats every turn, on the assumption that contact holds; a force below 0 refutes that.

    force       extremes of the contact force, N or N m, with shaft angles, rad
    residual    vibration in each of the dwells given to `steady`, in their order
    state       z and z' at shaft angle 0, before any jump there
    response    z over the whole turn
    """

    force: PeaksOverTurn
    residual: tuple[Residual, ...]
    state: tuple[float, float]
    response: Response

    @property
    def holds(self) -> bool:
        """Whether the contact force is nowhere below 0."""
        return self.force.least >= 0.0

    @property
    def starts(self) -> Array:
        """States at the starts of all stretches of the response (2, m)."""
        return self.response.starts(np.array(self.state), 0, len(self.response))

    def force_at(self, running: Running, shaft: Array) -> Array:
        """Contact force (n,), N or N m, at shaft angles (n,), rad."""
        knots = self.response.drive.knots
        at = np.mod(shaft, TURN)
        stretch = np.minimum(np.searchsorted(knots, at, side="right") - 1, len(self.response) - 1)
        return running.force(self.response).at(self.starts, ResponsePlaces(stretch, at - knots[stretch]))


def steady(train: Train, drive: Drive, rpm: float, rests: Sequence[tuple[float, float]] = ()) -> Steady:
    """Find the steady state of a train in contact, exactly; `rests` are dwells (from, to), radians of shaft.

    The ends of rests should be knots of the drive (`drives(..., also=...)`). Raises DynamicsError for a speed `rpm`
    that is not above 0, at resonance without damping, where there is no steady state, and for a train so stiff, and
    damped so little, that its swings are too many to look at; StiffnessError for damping so strong that the response
    needs too many parts.
    """
    running = train.at(rpm)
    response = running.response(drive)
    state = periodic(running, response)
    starts = response.starts(state, 0, len(response))
    _demand_countable(running, response, starts)
    force = running.force(response).peaks(starts, np.arange(len(response)))
    residual = tuple(_residual(running, response, starts, begin, end) for begin, end in rests)
    return Steady(force, residual, (float(state[0]), float(state[1])), response)


def _demand_countable(running: Running, response: Response, starts: Array) -> None:
    """Raise DynamicsError for more swings than are looked at, with the damping that makes them few enough."""
    _, fine = response.swings(starts, np.arange(len(response)))
    if fine.sum() <= MOST_SWUNG:
        return
    fading = _SILENT_AFTER * max(int(np.count_nonzero(response.slow)), _STRETCHES) / (response.step * MOST_SWUNG)
    least = 2.0 * running.train.mass * running.speed * fading
    raise DynamicsError(
        f"the natural frequency is {running.train.ratio(running.rpm):.4g} times the shaft's and the damping is "
        f"{running.train.damping:.4g}: the swings of a turn are too many; a damping of {least:.3g} leaves few enough"
    )


def periodic(running: Running, response: Response) -> Array:
    """State (z, z') (2,) at shaft angle 0 that returns after a turn. Raises DynamicsError where there is none."""
    oscillator = response.oscillator
    if oscillator.detuning < _LEAST_DETUNING * max(1.0, 1e-6 * oscillator.natural):
        raise DynamicsError(_no_steady_state(running, oscillator.natural, oscillator.split))
    return response.periodic()


def _no_steady_state(running: Running, natural: float, damped: float) -> str:
    """Text of why no steady state is found: resonance, or a natural frequency too high or too low for doubles."""
    ratio, speed = f"the natural frequency is {damped:.9g} times the shaft's", f"{running.rpm:.9g} rpm"
    if natural > _MOST_NATURAL:
        return (
            f"no steady state is found: {ratio}, and rounding does not tell it from a whole multiple, which resonates; "
            f"{speed}; leave the stiffness out, as the train is as good as rigid, or give a higher rpm"
        )
    if natural < _LEAST_NATURAL:
        least = running.train.mass * (running.speed * _LEAST_NATURAL) ** 2
        return (
            f"no steady state: {ratio}, so that nothing holds the follower to the cam; {speed}; "
            f"give a stiffness above {1.01 * least:.3g}"
        )
    remedy = "give damping or another rpm"
    return f"no steady state: {ratio}, and without damping a whole multiple resonates; {speed}; {remedy}"


def _residual(running: Running, response: Response, starts: Array, begin: float, end: float) -> Residual:
    """Vibration in the drive's dwell from `begin` to `end`, rad; `starts` (2, m) are the states where stretches start.

    The static z is where both springs balance, -(F + k_p s)/(k + k_p).
    """
    drive, train = response.drive, running.train
    middle = 0.5 * (drive.knots[:-1] + drive.knots[1:])
    inside = np.flatnonzero(np.mod(middle - begin, TURN) < end - begin)
    compliance = 1.0 / (train.stiffness + train.rate)
    minus_static = compliance * train.rate * drive.position
    minus_static[:, 0] += compliance * train.preload
    peaks = ResponseFigure.of(response, 1.0, 0.0, minus_static).peaks(starts, inside)
    return Residual(begin, end, max(peaks.greatest, -peaks.least, 0.0))
