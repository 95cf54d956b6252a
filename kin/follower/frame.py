"""The square frame of a linkage judged on a contour from a file: error of the output, play, dwell.

The contour drives the mechanism through contact with the frame's four faces (`kin.follower.frame_contact`). A real
part is never of exactly constant breadth, so the frame can rest in four ways, or float between; the worst counts.
Measured and intended output are compared at the same shaft angle, with the cam mounted as drawn. Intended is the motion
by the exact cam or, where the swing of the frame is prescribed, by the law of the swing: then the lift sets nothing but
the zero of the shaft angle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.contour.contour import apart
from kin.follower.frame_contact import CENTRED, RESOLUTION, WAYS, FrameError, driven, laid, resolution
from kin.follower.frame_dwell import Output, longest_dwells
from kin.follower.motion_error import MotionError, Play, motion_error, with_steps
from kin.follower.support import bearing_of
from kin.numeric.angles import TURN, degrees
from kin.numeric.distinct import distinct
from kin.numeric.elementary import Jet, cos
from kin.numeric.errors import UnsettledError
from kin.numeric.extrema import Extremes, extremes
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.contour.contour import Contour
    from kin.follower.frame_contact import Resting
    from kin.follower.support import FlatContacts
    from kin.law.contacts import Unit
    from kin.law.frame_swing import FrameSwing
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array, Indices

__all__ = ["DwellFound", "FrameError", "LinkageVerdict", "implied_limit", "judge_frame"]

Over = Literal["shaft", "relative"]
SHARE = 1e-6  # of the greatest error, to which it is resolved
FINE_STEP = 2e-4  # rad: within this a Taylor polynomial of third order is good to rounding
BESIDE = 1e-13  # rad: nearer to a break is rounding
LIMIT_STEPS = 720  # of a turn, from which the search for the limit's extremes starts
CORNERS = 4  # of a square of lifts that are off by 1, before the middles of its sides, opposite ones in turn
OFF = np.array([[1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 0.0, 0.0], [1.0, -1.0, 1.0, -1.0, 0.0, 0.0, 1.0, -1.0]])
ALIKE = 6  # decimals of degrees to which dwells are as long as one another: their ends are found to 1e-7


@dataclass(frozen=True)
class DwellFound:
    """Longest dwell of the output while the frame rests in the way named `rest`.

    `band`, degrees or mm, is the range that the output keeps; start and length are angles of the shaft, or relative
    ones, as `over` says.
    """

    over: Over
    band: float
    start_deg: float
    length_deg: float
    rest: str


@dataclass(frozen=True)
class LinkageVerdict:
    """Motion of the mechanism as a contour drives it; the output is in degrees or mm.

    error         of the output, measured less intended at the same shaft angle: the worst of the ways the frame can
                  rest and of the centred frame, rms over all; dwell_flatness over the longest intended dwell
    centred       error of the output with the frame midway between its contacts
    limit         greatest error that a contour within the tolerance can give; None where the mechanism binds within it
    play_across   between faces 1 and 3, mm; the places are shaft angles
    play_along    between faces 2 and 4
    least_rate    least rate of the shaft over the relative angle, 1 - theta_3', of all ways and of the centred frame
    dwells        longest dwell in each way of resting, the shortest of them first; empty without a band
    """

    error: MotionError
    centred: MotionError
    limit: float | None
    play_across: Play
    play_along: Play
    least_rate: float
    dwells: tuple[DwellFound, ...]


@dataclass(frozen=True)
class _Intended:
    """Intended motion of the mechanism, by the exact cam."""

    mechanism: Mechanism

    def alike(self, error: Array) -> Array:
        """Errors of the output (n,), without whole turns if it is an angle."""
        return error - TURN * np.round(error / TURN) if self.mechanism.unit == "deg" else error

    def output(self, shaft: Array) -> Array:
        """Intended output, rad or mm, at shaft angles (n,)."""
        return self.mechanism.output(shaft)

    def rows(self, theta: Array) -> Array:
        """Shaft angle and output at relative angles theta (n,), with three derivatives by theta: (2, 4, n)."""
        at = self.mechanism.at(theta, 3)
        return np.stack([at.shaft, at.output])

    def error(self, theta: Array, measured: Array, near: Array) -> Array:
        """Error of the output and its derivatives by theta (3, n), from the `measured` rows (2, 3, n) at theta (n,).

        `near` (2, 4, n) are the intended rows at theta. The intended output is taken at the relative angle t where the
        intended shaft angle equals the measured one: by Taylor polynomials about theta, or about t where t is far from
        theta or beyond a break.
        """
        (phi, phi_slope, phi_bend), output = measured
        step = _step(phi, near[0])
        far = np.flatnonzero(np.logical_or(np.abs(step) > FINE_STEP, self._break_between(theta, theta + step)))
        if len(far):
            near = near.copy()
            near[:, :, far] = self.rows(self.mechanism.relative(phi[far]))
            step[far] = _step(phi[far], near[0][:, far])
        shaft, wanted = (_taylor(rows, step) for rows in near)
        rate = phi_slope / shaft[1]
        bend = (phi_bend - shaft[2] * rate**2) / shaft[1]
        error = self.alike(output[0] - wanted[0])
        return np.stack([error, output[1] - wanted[1] * rate, output[2] - wanted[2] * rate**2 - wanted[1] * bend])

    def _break_between(self, a: Array, b: Array) -> NDArray[np.bool_]:
        breaks = self.mechanism.breaks
        ring = np.concatenate([breaks - TURN, breaks, breaks + TURN])
        # what is beside a break by rounding alone may have been taken on its other side
        before = np.searchsorted(ring, np.minimum(a, b) - BESIDE, side="left")
        return np.not_equal(before, np.searchsorted(ring, np.maximum(a, b) + BESIDE, side="right"))


@dataclass(frozen=True)
class _Prescribed(_Intended):
    """The mechanism whose frame swings by a law over the shaft angle: the output is solved from that alone."""

    swing: FrameSwing

    def output(self, shaft: Array) -> Array:
        """Output at shaft angles (n,)."""
        angles: Array = self._over_shaft(shaft, 0)[0]
        return angles

    def _over_shaft(self, shaft: Array, order: int) -> Array:
        """Output and its derivatives by the shaft angle (order + 1, n), rad or mm, at shaft angles (n,), rad.

        Without dyads it is theta_4, which the law prescribes. With dyads the chain is solved for the lift S that gives
        that theta_4: r1 cos theta_4 = r4 - Y, where Y = S - w/2 + e and the swing's `rocker` is r4 - e.
        """
        chain, theta_4 = self.mechanism.chain, self.swing.output(shaft, order)
        if not chain.dyads:
            return theta_4.derivatives()
        s = cos(theta_4) * -self.swing.ground + (self.swing.rocker + 0.5 * chain.breadth)
        # S1 only moves the frame along its own line, on which nothing hangs, so any constant serves
        return chain.solve(s, s.constant(0.5 * chain.breadth), self.mechanism.about).outputs[-1].derivatives()

    def rows(self, theta: Array) -> Array:
        """Rows of zeros: the law is evaluated at the measured shaft angle itself."""
        return np.broadcast_to(np.zeros(()), (2, 4, len(theta)))

    def error(self, theta: Array, measured: Array, near: Array) -> Array:  # noqa: ARG002 - one call for both
        """Error of the measured output and two derivatives (3, n) against the law at the measured shaft angle."""
        (phi, phi_slope, phi_bend), output = measured
        wanted, rate, bend = self._over_shaft(phi, 2)
        error = self.alike(output[0] - wanted)
        return np.stack([error, output[1] - rate * phi_slope, output[2] - bend * phi_slope**2 - rate * phi_bend])


def _step(phi: Array, shaft: Array) -> Array:
    """Step from where the shaft angle has the derivatives (4, n) to where it is phi (n,), by its Taylor polynomial."""
    step: Array = (phi - shaft[0]) / shaft[1]
    for _ in range(2):
        value, slope, _ = _taylor(shaft, step)
        step = np.where(np.abs(step) <= FINE_STEP, step + (phi - value) / slope, step)
    return step


def _taylor(rows: Array, step: Array) -> tuple[Array, Array, Array]:
    """Value and two derivatives (n,) each, a step (n,) on from where a function has the derivatives `rows` (4, n)."""
    a, b, c, d = rows
    value = a + step * (b + step * (c / 2.0 + step * d / 6.0))
    return value, b + step * (c + step * d / 2.0), c + step * d


def judge_frame(
    contour: Contour,
    mechanism: Mechanism,
    shaft: Array,
    tolerance: float,
    *,
    swing: FrameSwing | None = None,
    band: float | None = None,
    over: Over = "shaft",
    overlap: float = 0.0,
) -> LinkageVerdict:
    """Let a contour drive the mechanism: extremes over the whole turn, rms and increments from `shaft` angles (n,).

    `tolerance`, mm, is the contour's and sets the limit. `swing` is the law prescribed for the frame; without it the
    motion by the exact cam is intended. `band`, rad or mm, is the range that a dwell keeps, over the shaft or the
    relative angle; without it no dwells are looked for. `overlap`, mm, is the intended interference at each face,
    which yields. Raises FrameError where the contour does not drive the mechanism all round, or so suddenly that
    rounding hides the error, and BindingError where the intended cam does not drive it. Cost: a position of the
    linkage for each break of the contour at each face, in each way of resting.
    """
    intended = _Intended(mechanism) if swing is None else _Prescribed(mechanism, swing)
    try:
        return _judged(replace(bearing_of(contour), back=overlap), intended, shaft, tolerance, band=band, over=over)
    except UnsettledError as error:
        raise FrameError(f"the error of the output cannot be determined: {error}") from error


def _judged(
    bearing: FlatContacts, intended: _Intended, shaft: Array, tolerance: float, *, band: float | None, over: Over
) -> LinkageVerdict:
    """Verdict on a contour that bears on the frame; `shaft` (n,), rad, are the angles of rms and increments."""
    mechanism = intended.mechanism
    unit: Unit = "deg" if mechanism.unit == "deg" else "mm"
    every = laid(mechanism, bearing, (*WAYS, CENTRED))
    *ways, centred = every
    # many nodes are common to the ways: the intended rows are found at each once
    nodes = distinct(np.concatenate([way.nodes for way in every]))
    rows = intended.rows(nodes)
    *wanted, wanted_centred = (rows[:, :, np.searchsorted(nodes, way.nodes)] for way in every)
    worst, worst_centred = _worst(ways, intended, wanted), _worst([centred], intended, [wanted_centred])
    # errors at the given shaft angles, and the range of the output over the longest intended dwell
    angles = with_steps(shaft)
    intended_output = intended.output(angles)
    errors = [intended.alike(way.over_shaft(angles, 0)[0] - intended_output) for way in every]
    window = None if band is None else _intended_dwell(mechanism, band)
    flat = [] if window is None else [_extremes(way, mechanism, "shaft", *window).span for way in every]
    across, along = _plays(bearing, mechanism.breadth, centred)
    return LinkageVerdict(
        error=motion_error(max(worst, worst_centred), np.stack(errors), max(flat, default=None), unit),
        centred=motion_error(worst_centred, errors[-1], flat[-1] if flat else None, unit),
        limit=implied_limit(mechanism, tolerance),
        play_across=across,
        play_along=along,
        least_rate=min(way.least_rate[0] for way in every),
        dwells=() if band is None else _dwells(ways, mechanism, band, over),
    )


def _worst(ways: Sequence[Resting], intended: _Intended, rows: Sequence[Array]) -> tuple[float, float]:
    """Greatest absolute error of the output in any of the ways, and the shaft angle there.

    `rows` are the intended ones at the nodes of each way.
    """
    first = np.cumsum([0, *(len(way.nodes) - 1 for way in ways)])
    low, high = (np.concatenate([way.nodes[part] for way in ways]) for part in (slice(-1), slice(1, None)))
    measured = np.concatenate([*(way.low for way in ways), *(way.high for way in ways)], axis=2)
    near = np.concatenate([*(each[..., :-1] for each in rows), *(each[..., 1:] for each in rows)], axis=2)
    at_low, at_high = np.split(intended.error(np.concatenate([low, high]), measured, near), 2, axis=1)

    def error(theta: Array, interval: Indices) -> Array:
        measured, of = np.empty((2, 3, len(theta))), np.searchsorted(first, interval, side="right") - 1
        for k in np.flatnonzero(np.bincount(of)).tolist():
            own = of == k
            measured[..., own] = ways[k].rows(theta[own], interval[own] - first[k])
        return intended.error(theta, measured, intended.rows(theta))

    allowed = max(resolution(intended.mechanism, way.low[1, 0]) for way in ways)
    needed = max(allowed, SHARE * float(np.abs(at_low[0]).max()))
    found = extremes(low, high, at_low, at_high, error, resolution=needed)
    worst, at = found.worst
    way = ways[int(np.searchsorted(first, found.worst_index, side="right")) - 1]
    return worst, float(way.turned(np.array([at]), 0)[0, 0])


def implied_limit(mechanism: Mechanism, tolerance: float) -> float | None:
    """Greatest error of the output, degrees or mm, by a contour within `tolerance`, mm, of the exact one.

    Both lifts are off by the tolerance, in the four combinations of signs: to first order the error is the tolerance
    times the greatest |d output/dS| + |d output/dS1| at fixed shaft angle. Between these corners it can be greater by
    its curvature along either lift alone, which is added. None where the mechanism may bind within the tolerance, also
    where it binds between corners alone, as the point of a dyad can get to either side of its ground pivot. Raises
    UnsettledError where rounding hides the error.
    """
    intended = _Intended(mechanism)
    nodes = apart(np.concatenate([mechanism.breaks, np.arange(LIMIT_STEPS) * (TURN / LIMIT_STEPS)]))
    if _may_bind(mechanism, tolerance, nodes):
        return None
    nodes = np.append(nodes, nodes[0] + TURN)

    def meant(theta: Array) -> tuple[Array, Array]:
        at = mechanism.at(theta, 3)
        return np.stack([at.shaft, at.output]), at.faces[:, :3]

    def error(theta: Array, off: Array, rows: Array, lifts: Array) -> Array:
        """Errors (3, n) at theta (n,) with both lifts off by so many tolerances (2, n)."""
        lifts = lifts.copy()
        lifts[:, 0] += tolerance * off
        return intended.error(theta, driven(mechanism, theta, *lifts), rows)

    rows, lifts = meant(nodes)
    count, many = len(nodes), OFF.shape[1]
    try:
        off = np.repeat(OFF, count, axis=1)
        at = error(np.tile(nodes, many), off, np.tile(rows, many), np.tile(lifts, many)).reshape(3, many, count)
        ends = at[:, :CORNERS]
        worst, _ = extremes(
            np.tile(nodes[:-1], CORNERS),
            np.tile(nodes[1:], CORNERS),
            ends[..., :-1].reshape(3, -1),
            ends[..., 1:].reshape(3, -1),
            lambda theta, interval: error(theta, OFF[:, interval // (count - 1)], *meant(theta)),
            resolution=max(resolution(mechanism, rows[1, 0]), SHARE * float(np.abs(ends[0]).max())),
        ).worst
    except FrameError:
        return None
    # the last columns of OFF are one lift alone, to either side: half their sum is the curvature along that lift
    limit = worst + 0.5 * float(np.abs(at[0, CORNERS::2] + at[0, CORNERS + 1 :: 2]).sum(axis=0).max())
    return float(np.degrees(limit)) if mechanism.unit == "deg" else limit


def _may_bind(mechanism: Mechanism, tolerance: float, nodes: Array) -> bool:
    """Whether some loop is nearer to binding than both lifts, off by the tolerance, can move its point.

    Looked for at relative angles (n,) and where the margin of a loop is least. No margin changes faster than its point.
    """
    chain, about, mobile = mechanism.chain, mechanism.about, mechanism.mobility()
    if mobile.binds:
        return True
    for loop, nearest in enumerate(mobile.nearest):
        theta = np.concatenate([nodes, nearest])
        s, s1 = mechanism.lift.derivatives(np.concatenate([theta, theta + 0.5 * np.pi]), 0).reshape(2, -1)
        moved = np.full_like(theta, 2.0)
        if loop > 0:
            moved = np.zeros_like(theta)
            for off, off1 in ((1.0, 0.0), (0.0, 1.0)):
                s_jet, s1_jet = (Jet(np.stack([f, np.full_like(f, rate)])) for f, rate in ((s, off), (s1, off1)))
                x, y = chain.hung(chain.solve(s_jet, s1_jet, about[: loop - 1]), loop - 1)
                moved += np.hypot(x.c[1], y.c[1])
        if (chain.margins(loop, s, s1, about) <= tolerance * moved).any():
            return True
    return False


def _plays(bearing: FlatContacts, breadth: float, centred: Resting) -> tuple[Play, Play]:
    """Play across and along the frame, mm: the same figures of the contour, at places a quarter turn apart."""
    breadths = bearing.breadth_extremes(RESOLUTION * breadth)
    least, most = breadth - 2.0 * bearing.back - breadths.greatest, breadth - 2.0 * bearing.back - breadths.least

    def play(turned: float) -> Play:
        at = centred.turned(np.array([breadths.greatest_at, breadths.least_at]) - turned, 0)[0]
        return Play(least, degrees(at[0]), most, degrees(at[1]), "mm")

    return play(0.0), play(0.5 * np.pi)


def _extremes(way: Resting, mechanism: Mechanism, over: Over, begin: float, end: float) -> Extremes:
    """Extremes of the output, rad or mm, from one angle to another, rad, less than a turn on."""
    output = way.over_shaft if over == "shaft" else way.over_relative
    return output.extremes(begin, end, resolution(mechanism, output.low[0]))


def _intended_dwell(mechanism: Mechanism, band: float) -> Array:
    """Shaft angles (2,) between which the intended output dwells longest."""
    dwell = mechanism.dwells(band)[0]
    return dwell.start + np.array([0.0, min(dwell.length, TURN * (1.0 - 1e-12))])


def _dwells(ways: list[Resting], mechanism: Mechanism, band: float, over: Over) -> tuple[DwellFound, ...]:
    """Longest dwell of each way, the shortest of them first, equal ones in the order of the ways."""
    width = float(np.degrees(band)) if mechanism.unit == "deg" else band
    longest = longest_dwells([_output(way, mechanism, over) for way in ways], band)
    dwells = [
        DwellFound(over, width, degrees(dwell.start), float(np.degrees(dwell.length)), way.rest.name)
        for way, dwell in zip(ways, longest, strict=True)
    ]
    return tuple(sorted(dwells, key=lambda dwell: round(dwell.length_deg, ALIKE)))


def _output(way: Resting, mechanism: Mechanism, over: Over) -> Output:
    """Output of a way over the shaft angle or over the relative one."""
    function = way.over_shaft if over == "shaft" else way.over_relative

    def between(a: float, b: float) -> tuple[float, float]:
        ends = function.extremes(a, b, resolution(mechanism, function.low[0]))
        return ends.least, ends.greatest

    value = np.append(function.low[0], function.high[0, -1])
    return Output(
        lambda x: function(x, 0)[0], between, function.x, value, _slack(function.x, function.low[2], function.high[2])
    )


def _slack(x: Array, low: Array, high: Array) -> float:
    """How far a function strays from its range at the nodes x (m + 1,), by its second derivatives (m,), doubled."""
    slack: Array = 0.25 * np.diff(x) ** 2 * np.maximum(np.abs(low), np.abs(high))
    return float(slack.max())
