"""The cam whose square frame, sliding on a rocker, swings by a law over the shaft angle.

It inverts section 4 of Aygahoglu and Saka 2023 (AS). The rocker turns by psi from its mean direction, theta_4 = psi +
90 degrees, or psi - 90 where it is crossed, in the sense of the shaft: the swing of an oscillating yoke. The frame
turns with it, so the relative angle of cam and frame is theta = phi - (psi - psi_0), and the loop r1 cos theta_4 = r4 -
Y, theta_3 + theta_4 = 90 degrees (AS 24-27) gives

    Y = r4 + k r1 sin psi,   S = Y + w/2,   k = 1 open, -1 crossed, r4 less the offset of the slide's line.

Constant breadth, S(theta + 180) + S(theta) = w, is sin psi(theta + 180) + sin psi(theta) = -2 k r4/r1. So a law is free
over half a turn of theta. With h its net rise that is half a turn and h of the shaft, and the law maps onto itself by

    (phi, psi) -> (phi + 180 + psi* - psi, psi*),   sin psi* = -2 k r4/r1 - sin psi,

(phi + 180 - 2 psi, -psi) for an oscillating yoke with r4 = 0. It begins where psi_0 + h is the image of psi_0, and both
theta and phi rise with phi where psi' < 1 and psi' (1 + cos psi/cos psi*) < 1: psi' < 1/2 for that yoke.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.law.bounds import undecided
from kin.law.formula.expression import FormulaError
from kin.law.formula.formula import Formula
from kin.law.joints import ORDERS, DerivativeJump, joints_of
from kin.law.normalised import IntentError
from kin.law.segment import Alike, Constant, Series, Stretch
from kin.law.sources.motion import Motion, joined
from kin.numeric.angles import TURN
from kin.numeric.distinct import distinct
from kin.numeric.elementary import Ball, BallJet, DomainError, Jet, asin, cos, sin
from kin.numeric.inverse import Inverse
from kin.numeric.jet import derivatives_by
from kin.numeric.records import dataclass
from kin.numeric.taylor import compose, compose_balls

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

_SAME = 1e-9  # rad: greatest error of the angle that a law covers, as of segments
_JOIN = 1e-9  # relative difference of velocities that meet
_ULPS = 16.0  # first step of the search for an enclosure of a shaft angle
_DOUBLINGS = 60  # of that step: more than any stretch is long
_TABLE = 256  # steps of a stretch, of tables that inverses begin from
_QUARTER = 0.5 * math.pi
_LOOKS = 64  # shaft angles at which the size of a derivative is looked at


@dataclass(frozen=True, eq=False)
class FrameSwing:
    """psi - psi_0 over the shaft angle, rad, for half a turn of the relative angle; `ground` r1 and `rocker` r4, mm.

    The offset of the slide's line is taken off `rocker`, which may have either sign; `side` k is 1 open, -1 crossed.
    `frame_swing` makes it and refuses impossible laws.
    """

    motion: Motion
    ground: float
    rocker: float
    side: float

    @cached_property
    def rise(self) -> float:
        """Net rise h, rad."""
        return float(self.motion.at_end(0)[0])

    @cached_property
    def lean(self) -> float:
        """-2 k r4/r1: the sum of the sines of psi and of its image."""
        return -2.0 * self.side * self.rocker / self.ground

    @cached_property
    def start(self) -> float:
        """Swing psi_0, rad, at shaft angle 0: sin psi_0 + sin(psi_0 + h) is the lean."""
        return math.asin(0.5 * self.lean / math.cos(0.5 * self.rise)) - 0.5 * self.rise

    def output(self, phi: Array, order: int) -> Jet:
        """Output theta_4, rad, as a jet (order + 1, n) over shaft angles phi (n,), rad, any real numbers.

        Raises DomainError where a formula of the motion does not exist.
        """
        turns = np.floor(phi / TURN) * TURN
        phi, span = phi - turns, self.motion.total
        swing = np.empty((order + 1, len(phi)))
        early = phi <= span
        if early.any():
            swing[:, early] = self._swing(Jet.variable(phi[early], order)).c
        if not early.all():
            late = ~early
            swing[:, late] = self._later(phi[late], order)
        swing[0] += 0.5 * math.pi * self.side
        return Jet(swing)

    def _swing(self, phi: Jet) -> Jet:
        return self.motion.on(phi) + self.start

    def image(self, swing: Series) -> Series:
        """Swing psi* that follows after half a turn of the relative angle, from the swing psi; rad."""
        return asin(self.lean - sin(swing))

    def _later(self, phi: Array, order: int) -> Array:
        """Taylor coefficients (order + 1, n) of psi at shaft angles (n,) beyond the given law: of the law's image."""
        return self._before_image.series(self._image_over, phi, order)

    def _image_over(self, phi: Jet) -> tuple[Jet, Jet]:
        """Image psi* of psi at shaft angles phi of the given law, and the shaft angles at which it is taken."""
        swing = self._swing(phi)
        image = self.image(swing)
        return image, phi + math.pi + image - swing

    @cached_property
    def _before_image(self) -> Inverse:
        """Shaft angle of the given law over that of its image."""
        return Inverse(self._image_shaft, self._places)

    @cached_property
    def _places(self) -> Array:
        """Shaft angles of the given law at which tables of inverses stand: equal steps of each stretch."""
        steps = [np.linspace(*ends, _TABLE + 1) for ends in pairwise(self.motion.motion.knots.tolist())]
        return distinct(np.concatenate(steps))

    def _image_shaft(self, phi: Array) -> tuple[Array, Array]:
        """Shaft angle of the image of shaft angles phi (n,) of the given law, and its derivative, (n,) each."""
        _, shaft = self._image_over(Jet.variable(phi, 1))
        return shaft.c[0], shaft.c[1]

    @cached_property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Jumps of psi - psi_0 or its derivatives at shaft angles of the given law; at 0 the law follows its image."""
        looks = self.output(np.linspace(0.0, TURN, _LOOKS, endpoint=False), ORDERS).derivatives()
        before = Jet(self._later(np.array([TURN]), ORDERS)).derivatives()[:, 0]
        before[0] -= self.start
        size = np.abs(looks).max(axis=1)
        return (*joints_of([(0.0, before, self.motion.at_start(ORDERS))], size), *self.motion.joints)

    @cached_property
    def half_turn(self) -> Motion:
        """Lift S - S(0) over half a turn of the relative angle, mm."""
        knots, functions = self.motion.motion.knots, self.motion.motion.functions
        places = (knots - self.motion.derivatives(knots, 0)[0]).tolist()
        places[0], places[-1] = 0.0, math.pi
        made = [
            Constant(self.lift(function.value)) if isinstance(function, Constant) else _Lifted(self, index)
            for index, function in enumerate(functions)
        ]
        return joined(places, made, -1)

    def lift(self, moved: float) -> float:
        """Lift S - S(0), mm, of the frame where the swing is psi_0 + `moved`, rad."""
        return self.side * 2.0 * self.ground * math.cos(self.start + 0.5 * moved) * math.sin(0.5 * moved)

    @cached_property
    def shaft(self) -> Inverse:
        """Shaft angle of the given law over the relative angle."""
        return Inverse(self._relative, self._places)

    def _relative(self, phi: Array) -> tuple[Array, Array]:
        """Relative angle at shaft angles phi (n,), and its derivative, (n,) each; a method can be pickled."""
        at = Jet.variable(phi, 1)
        relative = at - self.motion.on(at)
        return relative.c[0], relative.c[1]


@dataclass(frozen=True, eq=False)
class _Lifted(Alike):
    """S - S(0) over the relative angle, on a stretch of the swing, in jet arithmetic: all stretches together."""

    law: FrameSwing
    index: int

    @property
    def kind(self) -> tuple[str, int]:
        """Key of the stretches of one law."""
        return "swing", id(self.law)

    @property
    def numbers(self) -> tuple[float, ...]:
        """Number of the stretch."""
        return (float(self.index),)

    def together(self, rows: Array) -> Stretch:
        """Give one function for n stretches, whose numbers are the row of `rows` (1, n)."""
        return _LiftedTogether(self.law, rows[0].astype(np.intp))

    def __call__(self, t: Series, /) -> Series:
        """Give the lift at the relative angle t."""
        count = (t.c if isinstance(t, Jet) else t.mid).shape[1]
        return self.together(np.full((1, count), self.numbers[0]))(t)


@dataclass(frozen=True, eq=False)
class _LiftedTogether:
    """S - S(0) over the relative angle, each point or interval on its stretch (n,) of the swing."""

    law: FrameSwing
    stretch: Indices

    def __call__(self, t: Series, /) -> Series:
        """Give the lift at the relative angle t: the series over the shaft angle, inverted."""
        if isinstance(t, BallJet):
            return BallJet.of(compose_balls(self._ball_rows(*t.rows[0].bounds(), t.order), t.rows))
        return Jet(compose(self.law.shaft.series(self._over_shaft, t.c[0], t.order, self._ends), t.c))

    @property
    def _ends(self) -> tuple[Array, Array]:
        """Shaft angles at which the stretches begin and end, (n,) each."""
        knots = self.law.motion.motion.knots
        return knots[self.stretch], knots[self.stretch + 1]

    def _over_shaft(self, at: Series) -> tuple[Series, Series]:
        """Lift and relative angle over the shaft angle; the latter is that angle less the swing, psi - psi_0."""
        moved = self.law.motion.motion.apply(at, self.stretch)
        half = moved * 0.5
        return cos(half + self.law.start) * sin(half) * (2.0 * self.law.side * self.law.ground), at - moved

    def _ball_rows(self, lower: Array, upper: Array, order: int) -> Ball:
        """Balls (order + 1, n) of the lift's Taylor coefficients by the relative angle, from `lower` to `upper`."""
        at = BallJet.variable(*self._shafts_beyond(lower, upper), order)
        rows = [row.rows[0] for row in derivatives_by(*self._over_shaft(at))]
        rows[1:] = [row * (1.0 / math.factorial(k)) for k, row in enumerate(rows[1:], 1)]
        return Ball(np.stack([row.mid for row in rows]), np.stack([row.rad for row in rows]))

    def _shafts_beyond(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """Shaft angles (n,) surely not above those of relative angles `lower` (n,), and not below those of `upper`."""
        theta, way = np.concatenate([lower, upper]), np.repeat([-1.0, 1.0], len(lower))
        (begin, close), stretch = np.tile(self._ends, 2), np.tile(self.stretch, 2)
        phi, end = self.law.shaft(theta), np.where(way < 0.0, begin, close)
        # steps outwards are doubled until the proved relative angle there is beyond theta, or the stretch ends
        step = _ULPS * np.spacing(np.maximum(np.abs(phi), 1.0))
        for _ in range(_DOUBLINGS):
            beyond = np.clip(phi + way * step, begin, close)
            at = BallJet.variable(beyond, beyond, 0)
            low, high = (at - self.law.motion.motion.apply(at, stretch)).rows[0].bounds()
            open_ = (beyond != end) & ~np.where(way < 0.0, high <= theta, low >= theta)
            if not open_.any():
                break
            step = np.where(open_, 2.0 * step, step)
        else:
            beyond = np.where(open_, end, beyond)
        return beyond[: len(lower)], beyond[len(lower) :]


def span_of(text: str, scale: float) -> float:
    """Shaft angle t, rad, that a swing `scale` times a formula in t covers: where the swing, rad, is t - pi.

    Raises FormulaError for a text that is no formula.
    """
    formula, low, high = Formula(text), 0.0, TURN
    while low < (middle := 0.5 * (low + high)) < high:
        try:
            beyond = scale * formula(middle) <= middle - math.pi
        except (FormulaError, DomainError):
            beyond = True
        low, high = (low, middle) if beyond else (middle, high)
    return high


def frame_swing(motion: Motion, ground: float, rocker: float, side: float, field: str = "swing") -> FrameSwing:
    """Make the swing that a motion prescribes, in rad from 0, over the shaft angle of half a relative turn.

    `ground` r1 and `rocker` r4, less the offset of the slide's line, are mm; `side` is 1 open, -1 crossed. Raises
    IntentError where the motion does not cover that shaft angle, half a turn and its net rise; where it jumps; where
    the loop does not close, or the shaft would have to turn back, for it or its image; where velocities at both ends do
    not meet.
    """
    law = FrameSwing(motion.demand_joined(field, "rad"), ground, rocker, side)
    rise = math.degrees(law.rise)
    # psi_0 and psi_0 + h, which are each other's image, within a quarter turn of 0
    if not (abs(law.rise) < math.pi and abs(0.5 * law.lean) < math.cos(0.5 * law.rise) ** 2):
        raise IntentError(_too_far(law), field)
    span, covered = math.degrees(math.pi + law.rise), math.degrees(motion.total)
    if abs(motion.total - (math.pi + law.rise)) > _SAME:
        raise IntentError(
            f"the motion covers {covered:.10g} degrees of the shaft; let it cover {span:.10g}, 180 and its net "
            f"rise of {rise:.9g}: half a turn of the cam against the frame, the other half is its image",
            field,
        )
    if not _possible(law):
        whole = motion.motion
        try:
            for function, begin, end in zip(whole.functions, whole.knots[:-1], whole.knots[1:], strict=True):
                _demand_possible(law, function, float(begin), float(end), field)
        except DomainError as error:
            raise IntentError(f"the swing is not defined: {error.operation}", field) from error
    _demand_meeting(law, field)
    return law


def _too_far(law: FrameSwing) -> str:
    """Words for a net rise that is too large, and for the changes that would allow it."""
    half, aside = 0.5 * law.rise, abs(law.rocker)
    most_share = math.cos(half) ** 2 if abs(law.rise) < math.pi else 0.0
    most = math.degrees(2.0 * math.acos(math.sqrt(min(1.0, aside / law.ground))))
    remedies = [f"swing by less than {most:.9g}"] if most else []
    if most_share:
        longer, nearer = aside / most_share, law.ground * most_share
        remedies.append(f"give a ground above {longer:.9g} mm or a rocker within {nearer:.9g} mm of the joint's offset")
    if not remedies:
        remedies = [f"swing by less than 180 with a ground above {aside:.9g} mm"]
    amount = f"by {math.degrees(law.rise):.9g} degrees " if most or not most_share else ""
    return f"the frame cannot swing {amount}on links of these lengths: {', or '.join(remedies)}"


def _courses(law: FrameSwing, function: Stretch) -> tuple[Stretch, Stretch]:
    """Swing psi over the shaft angle of a stretch, and the shaft angle of its image, rad."""

    def swing(t: Series) -> Series:
        return function(t) + law.start

    def later(t: Series) -> Series:
        at = swing(t)
        return t + law.image(at) - at

    return swing, later


def _possible(law: FrameSwing) -> bool:
    """Whether all that `_demand_possible` demands is proved of all stretches at once.

    Where the rate of the image's shaft angle is bounded, so is that of an arc sine: the image exists.
    """
    whole = law.motion.motion
    swing, later = _courses(law, whole.on)
    demanded = ((swing, {0: (-_QUARTER, _QUARTER), 1: (-math.inf, 1.0)}), (later, {1: (0.0, math.inf)}))
    return all(undecided(course, whole.knots[:-1], whole.knots[1:], limits) is None for course, limits in demanded)


def _demand_possible(law: FrameSwing, function: Stretch, begin: float, end: float, field: str) -> None:
    """Prove that the loop closes over a stretch and its image, and that the shaft turns on through both."""
    swing, later = _courses(law, function)

    def sine(t: Series) -> Series:
        return law.lean - sin(swing(t))

    # the loop closes where |psi| and |psi*| are below a quarter turn
    for course, limits in ((swing, {0: (-_QUARTER, _QUARTER)}), (sine, {0: (-1.0, 1.0)})):
        doubts = undecided(course, begin, end, limits)
        if doubts is not None:
            at = math.degrees(doubts[1])
            raise IntentError(
                f"the frame swings so far that its loop does not close, near a shaft angle of {at:.6g} degrees or half "
                "a turn of the cam on: swing less, or give a longer ground or a rocker nearer to the joint's offset",
                field,
                at,
            )
    # the shaft turns on where psi' < 1, and where the image's shaft angle rises with phi
    for course, limits in ((swing, {1: (-math.inf, 1.0)}), (later, {1: (0.0, math.inf)})):
        doubts = undecided(course, begin, end, limits)
        if doubts is None:
            continue
        phi = np.linspace(begin, end, 2049)
        jet = swing(Jet.variable(phi, 1))
        most = 1.0 / (1.0 + np.cos(jet.c[0]) / np.cos(law.image(jet).c[0]))
        worst = int(np.argmax(jet.c[1] / most))
        at = math.degrees(float(phi[worst]))
        raise IntentError(
            f"the frame swings on with the shaft at {jet.c[1, worst]:.6g} of its speed at {at:.6g} degrees; from "
            f"{most[worst]:.6g} on the shaft would have to turn back, there or half a turn of the cam on: spread the "
            "swing over a larger angle, or swing less",
            field,
            at,
        )


def _demand_meeting(law: FrameSwing, field: str) -> None:
    """Raise IntentError unless the velocities at both ends are each other's image."""
    (_, first), (_, last) = law.motion.at_start(1), law.motion.at_end(1)
    begin = law.start
    # over the relative angle the lift's slopes are opposite: k r1 cos psi psi'/(1 - psi')
    slope = -math.cos(begin) / math.cos(begin + law.rise) * first / (1.0 - first)
    wanted = slope / (1.0 + slope) + 0.0  # no -0 in a message
    if abs(last - wanted) > _JOIN * (1.0 + abs(first)):
        end = math.degrees(law.motion.total)
        raise IntentError(
            f"the swing's velocity is {first:.9g} of the shaft's at its beginning, so it must be {wanted:.9g} at its "
            f"end, {end:.6g} degrees, where it is {last:.9g}: else the contour would tear open; let it rest at both "
            "ends, or make them meet",
            field,
            end,
        )
