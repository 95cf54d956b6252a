"""The motion that the metal of points gives a follower, of which nothing is known but its contacts.

Each contact runs on its own surface, as an error of a follower that hardly moves. Where two hold the follower the
motion is midway between both, and their distance is play. The symmetry of a kind of cam over the turn is used: two
opposite contacts of a frame, S(phi + pi) = S(0) + S(pi) - S(phi) (Shu and Wu 2012); two rollers or faces on one arm,
psi changes its sign as phi - psi/2 grows by pi/lambda (Wunderlich 1984, 4.9), and faces swing psi/2. So the whole turn
shows the part of it by which a recipe gives the motion, and what is off that symmetry is form.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.made.metal import Metal
from kin.made.motion import contact_errors
from kin.made.points import SurfacePoints
from kin.made.smooth import fit
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.follower.base import Follower
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array

STEPS = 1440  # shaft angles of a turn
SECANT_STEPS = 20
ROUNDING = 1e-11  # mm or rad of a position, at which the secant search ends
BESIDE = 0.1  # of a section, by which it is looked at beyond its ends
FINER = 8  # times STEPS, at which rows are interpolated


class SurfaceRun(NamedTuple):
    """A follower `gauge` that hardly moves, and measured points (n, 2), mm, of a surface on which it runs.

    `side` is 1 for metal inside its contour, -1 outside. `directions` are measured normals (n, 2), None without.
    """

    gauge: Follower
    side: Side
    places: Array
    directions: Array | None


@dataclass(frozen=True, eq=False)
class PointMotion:
    """The motion that the metal of points gives a follower; mm or rad, angles rad.

    gauge         the follower on the first surface, on a circle: it hardly moves
    side          1 for metal inside its contour, -1 outside
    turn (n,)     position from its zero at equal shaft angles of a turn
    position (k,) the same at equal shaft angles of `span`; of sections their mean
    span          part of the turn, from angle 0 on, by which a recipe gives the motion
    last          position at the end of the span
    spans         number of spans of the smoothed curve in `span`, at least 1
    sd            standard deviation of the position, greatest over the turn
    outliers      number of points that were left out
    play          least, mean and greatest play of two contacts beyond the recipe's; None for one contact
    uneven        greatest distance from the symmetry by which the rest of the turn follows; 0 without any
    zero_ends     whether a part of a turn begins and ends at 0
    """

    gauge: Follower
    side: Side
    turn: Array
    position: Array
    span: float
    last: float
    spans: int
    sd: float
    outliers: int
    play: tuple[float, float, float] | None = None
    uneven: float = 0.0
    zero_ends: bool = False

    @property
    def closed(self) -> bool:
        """Whether the span is a whole turn."""
        return self.span == TURN

    @property
    def shaft(self) -> Array:
        """Shaft angles (k,) of `position`, rad."""
        shaft: Array = self.span / len(self.position) * np.arange(len(self.position), dtype=np.float64)
        return shaft

    def alike(self, most: int) -> tuple[int, ...]:
        """Numbers of waves a turn, up to `most` or the least that there is, that a motion and a form error share.

        Points alone cannot tell such a wave of the motion from one of the form.
        """
        if self.closed:
            return tuple(range(1, most + 1))
        # sections take turns in sign, so that odd multiples of `first` fit: five times is above 4, the most asked for
        first = round(0.5 * TURN / self.span)
        return tuple(k for k in (first, 3 * first) if k <= max(most, first))

    def lifted_circle(self, level: float) -> float:
        """Radius, mm, of the circle on which it stands at `level`, mm or rad, less that of the gauge's circle."""

        def stands(height: float) -> float:
            metal = Metal.of(self.gauge, self.side, lambda t: np.stack([np.full_like(t, height), np.zeros_like(t)]))
            return float(metal.positions(np.zeros(1))[0][0, 0] - self.gauge.intended(np.zeros(1))[0]) - level

        before, here = 0.0, 0.1 * self.side
        low, off = stands(before), stands(here)
        for _ in range(SECANT_STEPS):
            if abs(off) < ROUNDING or off == low:
                break
            before, here, low = here, here - off * (here - before) / (off - low), off
            off = stands(here)
        return self.side * here


def measured_motion(
    runs: Sequence[SurfaceRun],
    span: float = TURN,
    *,
    opposed: bool = False,
    lag: float = 0.5,
) -> PointMotion:
    """Motion of a follower on the metal of each of its surfaces, over a `span`, rad, from angle 0.

    Of `opposed` contacts the mean distance is not known beforehand, so that play is its variation alone. Where `span`
    is a section of the turn, the swing of each section is the negative of that before, over the shaft angle less `lag`
    times the swing; the motion is the mean of all, `uneven` the greatest distance of a section from it.

    Raises ContactError where a contact finds no metal, GapError for a gap of more than two spans, UnsettledError where
    the foot of a point is not found.
    """
    shaft = equal_steps(STEPS)
    curves, outliers = [], 0
    each: list[tuple[int, Array, Array]] = []  # sense, position, standard deviation
    for gauge, side, places, directions in runs:
        deviations = SurfacePoints(gauge, side, places, 0.0, directions).deviations
        smooth = fit(deviations.parameter, deviations.e)
        # position from its zero: the error, and the intended motion of the gauge, which hardly moves
        intended = gauge.intended(shaft) - gauge.intended(np.zeros(1))
        for contact, errors in zip(gauge.contacts, contact_errors(gauge, side, smooth.curve, shaft), strict=True):
            each.append((contact.sense, errors.rows[0] + intended, errors.sds[0]))
        curves.append(smooth.curve)
        outliers += int(smooth.outliers.sum())
    turn = np.mean([position for _, position, _ in each], axis=0)  # over the whole turn, midway between contacts
    sd = float(np.sqrt(sum(own**2 for _, _, own in each)).max()) / len(each)
    play, uneven = None, 0.0
    if len(each) > 1:
        gap = -np.sum([sense * position for sense, position, _ in each], axis=0)
        play = (float(gap.min()), float(gap.mean()), float(gap.max()))
        if opposed:
            turn = turn - 0.5 * play[1]
            play = (play[0] - play[1], 0.0, play[2] - play[1])
            uneven = 0.5 * max(-play[0], play[2])
    sections = span != TURN and not opposed
    if sections:
        (position, uneven), last = _sections(turn, span, lag), 0.0
    else:
        count = round(len(turn) * span / TURN)
        position, last = turn[:count], float(turn[count % len(turn)])
    # spans of the smoothed curve in the span of the motion
    own = max(round(min(curve.spans for curve in curves) * span / TURN), 1)
    return PointMotion(
        runs[0].gauge, runs[0].side, turn, position, span, last, own, sd, outliers, play, uneven, sections
    )


def _sections(swing: Array, span: float, lag: float) -> tuple[Array, float]:
    """Mean swing of equal sections, rad (n,), over shaft angles of the first, and the greatest distance from it.

    The swing of each is the negative of that before over the cam's own angle, the shaft's less `lag` times the swing.
    """
    phi = equal_steps(FINER * len(swing))
    fine = _finer(swing)
    count = round(TURN / span)
    u = np.linspace(-BESIDE * span, (1.0 + BESIDE) * span, len(phi) // count)
    each = np.stack([(-1) ** k * np.interp(u + k * span, phi - lag * fine, fine, period=TURN) for k in range(count)])
    mean = each.mean(axis=0)
    shaft = span / (len(swing) // 2) * np.arange(len(swing) // 2)
    first: Array = np.interp(shaft, u + lag * mean, mean)
    return first, float(np.abs(each - mean).max())


def _finer(rows: Array) -> Array:
    """Values of a period at FINER times as many places, by its harmonics."""
    n = len(rows)
    waves = np.fft.rfft(rows)
    return np.fft.irfft(waves, FINER * n) * FINER
