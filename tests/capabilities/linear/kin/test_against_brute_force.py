"""Figures of linear cams against brute force that knows positions alone: the lowest underside of all rollers is the
flank, and the follower is lowered until it touches that. Places are found by grids, ever closer.

Holds: kin.linear.pitch.
"""

import math

import numpy as np
import pytest
from capabilities.linear.kin.contours import flank, wave
from support.programmes import Segment, law, programme

from kin.linear.follower import Arm, LinearFollower, Stem
from kin.linear.frame import frame
from kin.linear.parallels import motion_limits, parallel_lift, pressure_angles
from kin.linear.undercut import cuts

GRID = np.linspace(-1.0, 1.0, 65)
ROUNDS = 9


def rise_and_return(stroke):
    """Dwell 8, a rise over 45, dwell 12, a return over 55."""
    segments = [
        Segment("dwell", 8.0),
        Segment("rise", 45.0, stroke, law("polynomial-4567")),
        Segment("dwell", 12.0),
        Segment("return", 55.0, stroke, law("harmonic")),
    ]
    return programme(segments, 120.0).motion


def lift(u, stroke):
    """The same motion by its formulas."""
    x, y = np.clip((u - 8.0) / 45.0, 0.0, 1.0), np.clip((u - 65.0) / 55.0, 0.0, 1.0)
    return stroke * (x**4 * (35.0 - 84.0 * x + 70.0 * x**2 - 20.0 * x**3) - 0.5 * (1.0 - np.cos(np.pi * y)))


CAMS = {
    "leaning back": LinearFollower(Stem(math.radians(-25.0)), 7.0, 37.0, rise_and_return(15.0)),
    "leaning on": LinearFollower(Stem(math.radians(12.0)), 11.0, 50.0, rise_and_return(18.0)),
    "trailing": LinearFollower(Arm(48.0, 60.0, 1), 6.0, 40.0, rise_and_return(0.4)),
    "leading": LinearFollower(Arm(70.0, 45.0, -1), 9.0, 35.0, rise_and_return(0.3)),
}
STROKES = {"leaning back": 15.0, "leaning on": 18.0, "trailing": 0.4, "leading": 0.3}


class Brute:
    """Positions of a follower, and what they leave and allow."""

    def __init__(self, follower, motion, apart=0.0):
        """`apart` is an input between two branches of the flank that meet."""
        self.apart = apart
        self.guide, self.radius, self.level, self.motion = follower.guide, follower.radius, follower.level, motion

    def centre(self, u, own):
        if isinstance(self.guide, Stem):
            return u + own * math.sin(self.guide.gamma), self.level + own * math.cos(self.guide.gamma)
        psi = math.asin((self.level - self.guide.pivot) / self.guide.length) + own
        return u - self.guide.side * self.guide.length * np.cos(psi), self.guide.pivot + self.guide.length * np.sin(psi)

    def underside(self, x, more=0.0, side=-1):
        """Lowest underside, or highest top, of all rollers larger by `more` at x (n,), with the inputs."""
        radius = self.radius + more

        def height(u):
            cx, cy = self.centre(u, self.motion(u))
            below = radius**2 - (x[:, None] - cx) ** 2
            y = cy + side * np.sqrt(np.maximum(below, 0.0))
            return side * np.where(below >= 0.0, y, -side * np.inf)

        found = []
        for low, high in ((0.0, self.apart), (self.apart, 120.0)) if self.apart else ((0.0, 120.0),):
            count = math.ceil((high - low) / 0.1) + 1
            u = np.broadcast_to(np.linspace(low, high, count), (len(x), count))
            found.append(refined(height, u, (high - low) / (count - 1), (low, high)))
        return side * np.max(found, axis=0)

    def resting(self, u, x, y, side=1):
        """Lift with the roller on points (x, y), or under them, at one input; nan out of reach."""
        with np.errstate(invalid="ignore"):
            if isinstance(self.guide, Stem):
                sine, cosine = math.sin(self.guide.gamma), math.cos(self.guide.gamma)
                along = (x - u) * sine + (y - self.level) * cosine
                across = (x - u) * cosine - (y - self.level) * sine
                return along + side * np.sqrt(self.radius**2 - across**2)
            dx, dy = self.guide.side * (u - x), y - self.guide.pivot
            away = np.hypot(dx, dy)
            share = (away**2 + self.guide.length**2 - self.radius**2) / (2.0 * away * self.guide.length)
            rest = math.asin((self.level - self.guide.pivot) / self.guide.length)
            return np.arctan2(dy, dx) + side * np.arccos(share) - rest

    def set_down(self, u, more=0.0, side=1):
        """Lift of the follower lowered to the flank, or lifted to the upper one, at one input."""
        cx, _ = self.centre(u, self.motion(u))

        def rest(x):
            y = self.underside(x[0], more, -side)
            return side * np.nan_to_num(self.resting(u, x, y[None], side), nan=-np.inf * side)

        span = np.linspace(cx - self.radius, cx + self.radius, 101)[None]
        return float(side * refined(rest, span, 2.0 * self.radius / 100)[0])


def refined(function, x, step, span=(-np.inf, np.inf)):
    """Greatest value (n,) of a function along rows x (n, m) at steps within a span, looked at again ever closer."""
    for _ in range(ROUNDS):
        value = function(x)
        best = np.argmax(value, axis=1)
        rows = np.arange(len(x))
        top, middle = value[rows, best], x[rows, best]
        x = np.clip(middle[:, None] + 1.5 * step * GRID, *span)
        step = 1.5 * step / 32.0
        if step < 1e-12:
            break
    return top


def brute(name):
    return Brute(CAMS[name], lambda u: lift(u, STROKES[name]))


@pytest.mark.parametrize("name", CAMS)
def test_the_flank_is_the_lowest_underside_of_all_rollers(name):
    points = flank(CAMS[name], np.array([14.0, 31.0, 52.5, 77.0, 92.0]))
    np.testing.assert_allclose(brute(name).underside(points[:, 0]), points[:, 1], rtol=0.0, atol=2e-11)
    upper = flank(CAMS[name], np.array([31.0, 90.0]), 1, 0.08)
    np.testing.assert_allclose(brute(name).underside(upper[:, 0], 0.08, 1), upper[:, 1], rtol=0.0, atol=2e-11)


@pytest.mark.parametrize("name", CAMS)
def test_the_play_of_a_groove_is_what_the_roller_can_be_lifted(name):
    wanted = brute(name).set_down(30.0, 0.08, -1) - lift(30.0, STROKES[name])
    play = parallel_lift(CAMS[name], 0.08, np.array([30.0])) - CAMS[name].law.derivatives(np.array([30.0]), 0)[0]
    np.testing.assert_allclose(play, [wanted], rtol=1e-9)
    (above,), (below,) = motion_limits(CAMS[name], [0.02]), motion_limits(CAMS[name], [1e-6])
    below *= 2e4
    assert above == pytest.approx(below, rel=0.02)


@pytest.mark.parametrize("name", CAMS)
def test_the_pressure_angle_is_that_of_the_normal_to_the_way_of_the_roller(name):
    follower, u = CAMS[name], np.linspace(1.0, 119.0, 4001)
    centre, contact = follower.centre(u, lift(u, STROKES[name])), flank(follower, u)
    if isinstance(follower.guide, Stem):
        way = np.array([math.sin(follower.guide.gamma), math.cos(follower.guide.gamma)])
    else:
        pivot = np.stack([u, np.full(len(u), follower.guide.pivot)], axis=-1)
        arm = (centre - pivot) / follower.guide.length
        way = np.stack([arm[:, 1], -arm[:, 0]], axis=-1) * follower.guide.side
    normal = (centre - contact) / follower.radius
    angle = np.arccos(np.clip((normal * way).sum(axis=-1), -1.0, 1.0))
    np.testing.assert_allclose(np.abs(np.arctan(frame(follower, u).tan)), angle, atol=1e-6)
    angles = pressure_angles(follower)
    found = np.arctan(frame(follower, u).tan)
    assert angles.greatest.value >= found.max()
    assert angles.least.value <= found.min()
    np.testing.assert_allclose([angles.greatest.value, angles.least.value], [found.max(), found.min()], atol=1e-5)


def test_steepest_places_have_closed_forms():
    sine, cosine = math.sin(math.radians(-25.0)), math.cos(math.radians(-25.0))
    angles = pressure_angles(CAMS["leaning back"])
    assert math.tan(angles.greatest.value) == pytest.approx((35.0 / 16.0 * 15.0 / 45.0 + sine) / cosine, rel=1e-12)
    assert math.tan(angles.least.value) == pytest.approx((-0.5 * math.pi * 15.0 / 55.0 + sine) / cosine, rel=1e-12)


UNDERCUT = {
    "stem": (LinearFollower(Stem(math.radians(-10.0)), 32.0, 60.0, rise_and_return(15.0)), 15.0),
    "arm": (LinearFollower(Arm(55.0, 75.0, 1), 35.0, 60.0, rise_and_return(0.35)), 0.35),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", UNDERCUT)
def test_the_motion_lost_is_what_the_follower_sinks_below_its_lift(name):
    follower, stroke = UNDERCUT[name]
    cut = cuts(follower)[0]
    own = Brute(follower, lambda u: lift(u, stroke), 0.5 * (cut.begin + cut.end))
    lost = [lift(u, stroke) - own.set_down(u) for u in (cut.lost_at - 0.4, cut.lost_at, cut.lost_at + 0.4)]
    assert cut.lost == pytest.approx(lost[1], rel=1e-10, abs=1e-11)
    assert lost[1] > max(lost[0], lost[2])
    assert cut.lost > 1e-3


def test_the_crest_of_a_wave_is_cut_evenly():
    """A crest all along whose sides the flank meets itself: its corner stands in the middle."""
    deep = LinearFollower(Stem(), 11.0, 26.0, wave(amplitude=5.0))
    (cut,) = cuts(deep)
    assert (cut.begin + cut.end) / 2.0 == pytest.approx(20.0, abs=1e-9)
    assert cut.corner[0] == pytest.approx(20.0, abs=1e-9)
    own = Brute(deep, lambda u: 5.0 * (1.0 - np.cos(2.0 * np.pi * u / 40.0)), 20.0)
    assert cut.lost == pytest.approx(10.0 - own.set_down(20.0), rel=1e-10)
