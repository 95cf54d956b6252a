"""AS equations 11 to 34 in plain numpy, the misprints put right. It imports nothing of the product.

Lengths in mm, angles in radians, theta the angle of the frame relative to the cam, as the paper plots it.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

PI = np.pi
FINE = np.linspace(0, 2 * PI, 36_001)
BREADTH = 50.0  # of every cam of the paper
CAMS = {
    "1": lambda t: 4 * np.cos(3 * t / 2) ** 2 + 23,
    "2a": lambda t: np.sin(3 * t) + 13 / 15 * np.sin(3 * t) * np.cos(2 * t) + 25,
    "2b": lambda t: 2 * np.cos(2 * t) ** 2 * np.sin(t) ** 3 + 25,
    "2c": lambda t: 2 * np.sin(PI * np.cos(t)) * np.cos(PI * np.sin(t)) + 25,
    "2d": lambda t: np.sin(2 * t) * np.cos(3 * t) + np.cos(3 * t) + 25,
}


def lift(cam, t, shaft, order=2):
    """s and its derivatives (order + 1, n), by the formula's Fourier series, which 256 values give to rounding."""
    grid = np.arange(256) * 2 * PI / 256
    c = np.fft.rfft(CAMS[cam](grid)) / 128
    c[0] /= 2
    k = np.flatnonzero(np.abs(c) > 1e-14)
    waves = np.exp(1j * np.outer(t, k))
    turned = [shaft[0] * np.cos(t + m * PI / 2) + shaft[1] * np.sin(t + m * PI / 2) for m in range(order + 1)]
    return np.array([(waves @ (c[k] * (1j * k) ** m)).real - turned[m] for m in range(order + 1)])


@dataclass(frozen=True)
class Loop:
    """theta; theta_3 and theta_4 with two derivatives over theta by rows; X and Y of the joint D in the frame."""

    theta: np.ndarray
    frame: np.ndarray
    output: np.ndarray
    x: np.ndarray
    y: np.ndarray

    @property
    def shaft(self):
        """Angle that the shaft has turned since theta = 0."""
        return self.theta - (self.frame[0] - self.frame[0, 0])

    @property
    def over_shaft(self):
        """theta_4 with velocity and acceleration over the shaft angle, by the chain rule."""
        rate, bend = 1 - self.frame[1], -self.frame[2]
        speed = self.output[1] / rate
        return np.array([self.output[0], speed, (self.output[2] - speed * bend) / rate**2])


def _solve(one, two, right):
    """Real p, q with one p + two q = right, all complex."""
    det = one.real * two.imag - two.real * one.imag
    p = (right.real * two.imag - two.real * right.imag) / det
    return p, (one.real * right.imag - right.real * one.imag) / det


def four_bar(cam, t, shaft, links):
    """AS 14 to 18 with atan2, theta_4 from both projections, and AS 11 and 12 differentiated as one complex equation.

    D = (X + i Y) exp(i theta_3) = r1 - r4 exp(-i theta_4). `t` rises from 0; the angles are followed round.
    """
    ground, coupler, rocker = links
    s, s1 = lift(cam, t, shaft), lift(cam, t + PI / 2, shaft)
    x, y = BREADTH + coupler - s1[0], s[0] - BREADTH / 2
    a, b = (ground + x) ** 2 + y**2 - rocker**2, 2 * ground * y
    c = (ground - x) ** 2 + y**2 - rocker**2
    theta_3 = 2 * np.arctan2(-b + np.sqrt(b * b - a * c), a)
    joint = (x + 1j * y) * np.exp(1j * theta_3)
    theta_4 = np.angle(ground - joint.conj())
    turn, crank = np.exp(1j * theta_3), 1j * rocker * np.exp(-1j * theta_4)
    first, second = -s1[1] + 1j * s[1], -s1[2] + 1j * s[2]
    w3, w4 = _solve(1j * joint, -crank, -first * turn)
    a3, a4 = _solve(1j * joint, -crank, -second * turn - 2j * first * turn * w3 + joint * w3**2 - 1j * crank * w4**2)
    return Loop(t, np.array([np.unwrap(theta_3), w3, a3]), np.array([np.unwrap(theta_4), w4, a4]), x, y)


def inverted(cam, t, shaft, ground, rocker):
    """AS 24 by its cosine, AS 29 and 31; theta_3 + theta_4 = 90 deg."""
    s = lift(cam, t, shaft)
    y = s[0] - BREADTH / 2
    angle = np.arccos((rocker - y) / ground)
    speed = s[1] / (ground * np.sin(angle))
    bend = (s[2] - ground * speed**2 * np.cos(angle)) / (ground * np.sin(angle))
    output = np.array([angle, speed, bend])
    return Loop(t, np.array([PI / 2 - angle, -speed, -bend]), output, ground * np.sin(angle), y)


def longest(x, f, band):
    """Start and length of the longest stretch of a period over which samples f(x) stay within `band`.

    x and f run over one period, both ends given; the stretch may run through the end. Two queues hold the extremes
    of the samples. Where an extremum lies inside, it sets the level at which the ends lie, between samples.
    """
    x = np.concatenate([x, x[1:] + x[-1] - x[0]])
    f = np.concatenate([f, f[1:]])
    top, low, first, best = deque(), deque(), 0, (0, 0)
    for i, value in enumerate(f):
        while top and f[top[-1]] <= value:
            top.pop()
        while low and f[low[-1]] >= value:
            low.pop()
        top.append(i)
        low.append(i)
        while f[top[0]] - f[low[0]] > band:
            first = min(top[0], low[0]) + 1
            while top and top[0] < first:
                top.popleft()
            while low and low[0] < first:
                low.popleft()
        if x[i] - x[first] > x[best[1]] - x[best[0]]:
            best = (first, i)
    begin, end = best
    inside = f[begin : end + 1]
    if inside.max() > max(f[begin], f[end]):
        level = inside.max() - band
    elif inside.min() < min(f[begin], f[end]):
        level = inside.min() + band
    else:
        raise ValueError("the stretch has no extremum inside")

    def crossing(i):
        return x[i] + (x[i + 1] - x[i]) * (level - f[i]) / (f[i + 1] - f[i])

    start = crossing(begin - 1)
    return start, crossing(end) - start


@dataclass(frozen=True)
class Figure:
    """A mechanism of the paper: which cam, the shaft in its axes, the links."""

    cam: str
    shaft: tuple[float, float]
    ground: float
    coupler: float | None
    rocker: float

    def loop(self, t):
        if self.coupler is None:
            return inverted(self.cam, t, self.shaft, self.ground, self.rocker)
        return four_bar(self.cam, t, self.shaft, (self.ground, self.coupler, self.rocker))


FIGURES = {
    "as-figure-8": Figure("1", (18.0, 10.0), 70.0, 65.0, 90.0),
    **{f"as-figure-9-{cam}": Figure(cam, (18.0, 8.5), 80.0, 70.0, 105.0) for cam in ("1", "2a", "2c", "2d")},
    "as-figure-12": Figure("1", (12.0, 12.0), 110.0, None, 70.0),
    **{f"as-figure-13-{cam}": Figure(cam, (18.5, 8.5), 130.0, None, 70.0) for cam in ("1", "2a", "2b", "2d")},
}


def apart(ours, theirs):
    """Greatest difference of two arrays; nan counts as different."""
    return np.abs(np.asarray(ours) - theirs).max()
